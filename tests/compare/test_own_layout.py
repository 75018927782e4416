"""A plain drawing with a layout of its own: its views are found, what it lacks is a remark, a plan built wrongly is named."""

import random

import pytest

from tests.compare.cad_plants import Way, draw
from tests.compare.own_layouts import Drawn, _rebuilt, is_there, replayed, taken
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_drawing, cad_report, cad_story
from tmm_sheets.compare.known_sheet import known_sheet
from tmm_sheets.compare.placing import Placing, moved
from tmm_sheets.compare.report import Report
from tmm_sheets.compare.report_pages import page
from tmm_sheets.project import Project

SHAPER = Project(read("lugansk/shaper"))
KNOWN = known_sheet(SHAPER, 1)
VIEWS = {e.view.name: e.view for e in KNOWN.elements}
ACCELERATIONS, POSITIONS = VIEWS["План ускорений (положение 2)"], VIEWS["Планы положений механизма"]
PLACES = {ACCELERATIONS: Placing(0.5 + 0j, -40 + 300j), POSITIONS: Placing(1 + 0j, 300 - 50j),
          VIEWS["План скоростей, положение 3"]: Placing(2 + 0j, 400 + 100j)}


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    """The Coriolis vector laid off backwards, all that follows from it drawn from there; the other views are right."""
    rng = random.Random(2)
    drawn = Drawn([e for v in PLACES for e in taken(KNOWN, v, rng, True)], PLACES)
    plan = SHAPER.plans["study"]["accelerations"]
    frame = next(f for f in KNOWN.sheet.frames if f.plan == "accelerations")
    new = {complex(frame(z)): complex(frame(w)) for z, w in replayed(plan, plan["k"], plan.labels.index("2"), -1)}
    _rebuilt(drawn, ACCELERATIONS, new)
    path = tmp_path_factory.mktemp("own") / "plain.dxf"
    path.write_bytes(draw([moved(e, PLACES[e.view]) for e in drawn.elements], Way(), rng))
    return path, cad_drawing.examine(SHAPER, 1, path, None, 0.25), drawn


def test_the_views_are_found_at_their_scales(compared):
    _, found, _ = compared
    for view, place in PLACES.items():
        points = view.box.corners
        assert is_there(place, found.places.moves[view], points, 1.0), view.name


def test_what_is_right_is_not_accused(compared):
    """Lines that are not drawn are a remark on their view; the exact plan tells what is right."""
    _, found, drawn = compared
    there = {e.number for e in drawn.elements}
    bad = [f for f in found.outcome.findings if f.verdict in ("red", "amber") and f.element.view in PLACES]
    assert {f.element.number for f in bad} == drawn.wrong.keys()
    left_out = {(x.view, x.kind) for x in found.outcome.absent}
    assert {(v, "construction") for v in PLACES} <= left_out
    judged = [f for f in found.outcome.findings if f.element.view in PLACES and f.verdict is not None]
    assert {f.element.number for f in judged} <= there


def test_the_plan_is_compared_as_it_was_built(compared):
    _, found, drawn = compared
    (built,) = found.built.values()
    assert list(found.built) == [ACCELERATIONS]
    assert built.mistake.kind == "coriolis"
    assert built.explains == built.of
    wrong = [f for f in found.outcome.findings if f.element.number in drawn.wrong]
    assert {f.verdict for f in wrong} == {"red"}
    assert not any(f.missing for f in wrong)
    assert all("as follows from the mistake" in f.what for f in wrong)
    assert "laid off the other way" in cad_story.lines(found, cad_report.gone(found.outcome))[1]


def test_the_report_as_a_page(compared):
    path, found, _ = compared
    story = cad_story.story("shaper", path, found, 0.25)
    assert "Coriolis" in story.mistakes[0].what
    report = Report("", {}, story=story)
    text = page(report, ".html", "").decode()
    assert text.index("Coriolis") < text.index("<table>") < text.index("not drawn:")
    assert "<script" not in text
    assert "http" not in text.replace("http-equiv", "")
    assert page(report, ".pdf", "").startswith(b"%PDF")
