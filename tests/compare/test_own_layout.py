"""A plain drawing with a layout of its own: its views are found, what it lacks is a remark, a plan built wrongly is named."""

import random
from collections import Counter
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.compare.cad_plants import Way, draw
from tests.compare.hypotheses import Slip
from tests.compare.own_layouts import Drawn, follows, is_there, taken
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_built, cad_drawing, cad_file, cad_report, cad_story, registration, titles, view_search
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.diagnosis.built_plan import StudentDrawing, built_otherwise, errors_of, possible
from tmm_sheets.compare.diagnosis.drawn_plan import between, drawn_plan, drawn_positions, rebuilt
from tmm_sheets.compare.diagnosis.replay import replay
from tmm_sheets.compare.known_sheet import known_sheet
from tmm_sheets.compare.placing import Placing, moved
from tmm_sheets.compare.report import Report
from tmm_sheets.compare.report_pages import page
from tmm_sheets.compare.story import listed
from tmm_sheets.construction.error import Errors
from tmm_sheets.drawing.marks import Line
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

SHAPER = Project(read("lugansk/shaper"))
PRESS = Project(read("press"))


def setup_module():
    """Composed when the first of these tests runs: every worker imports this file."""
    global KNOWN, VIEWS, ACCELERATIONS, FORCES, PLACES
    KNOWN = known_sheet(SHAPER, 1)
    composed(SHAPER, 1, steps=True)  # its plans, too
    VIEWS = {e.view.name: e.view for e in KNOWN.elements}
    ACCELERATIONS, positions = VIEWS["План ускорений (положение 2)"], VIEWS["Планы положений механизма"]
    FORCES = [VIEWS[f"План сил звена {n}"] for n in (1, 3)]
    PLACES = {ACCELERATIONS: Placing(0.5 + 0j, -40 + 300j), FORCES[0]: Placing(0.4 + 0j, 0j), FORCES[1]: Placing(0.4 + 0j, -700j),
              positions: Placing(1 + 0j, 300 - 50j),
              VIEWS["План скоростей, положение 3"]: Placing(2 + 0j, 400 + 100j),
              VIEWS["План скоростей, положение 7"]: Placing(1j, 1500 + 100j)}


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    """The Coriolis vector laid off backwards, all that follows from it drawn from there; the other views are right."""
    rng = random.Random(2)
    drawn = Drawn([e for v in PLACES for e in taken(KNOWN, v, rng, True)], PLACES)
    plans = {plan.name: plan for some in SHAPER.plans.values() for plan in (some or {}).values()}
    mu = {f.plan: f.mu[0] for f in KNOWN.sheet.frames if f.plan in plans}
    errors = Errors([(plans[name], mu[name]) for name in mu])
    found = SimpleNamespace(plans=[(plans[name], name) for name in mu], errors=lambda *_: errors,
                            scales={name: SimpleNamespace(mu=mu[name]) for name in mu})
    plan = plans["accelerations"]
    way = {plan["k"]: lambda a, made, k: a[0] - 2j * a[1] * (a[3] - a[2])}
    assert follows(found, KNOWN, drawn, Slip("coriolis", "k", plan.labels.index("2"), way))
    path = tmp_path_factory.mktemp("own") / "plain.dxf"
    path.write_bytes(draw([moved(e, PLACES[e.view]) for e in drawn.elements], Way(), rng))
    return path, cad_drawing.examine(SHAPER, 1, path, None, 0.25), drawn


def test_the_views_are_found_at_their_scales(compared):
    _, found, _ = compared
    for view, place in PLACES.items():
        points = view.box.corners
        assert is_there(place, found.places.moves[view], points, 1.0), view.name


@pytest.mark.parametrize(("declared", "unit", "at"), [
    (25.4, 1.0, 1), (25.4, 25.4, 1), (None, 1.0, 1), (1.0, 10.0, 1), (25.4, 1.0, 10), (1000.0, 1.0, 2), (1.0, 25.4, 1),
    (None, 1000.0, 1)])
def test_the_unit_a_file_declares_is_a_hint(compared, declared, unit, at):
    """AutoCAD declares inches for a drawing in millimetres: how high the letters are tells the size."""
    _, found, _ = compared
    drawn = found.laid.space.placed(Placing(complex(1 / unit / at)))
    sizes = registration._sizes(KNOWN, drawn, declared)
    assert sizes[0] == pytest.approx(unit * at)
    assert len(sizes) < 4


def test_in_a_wrong_unit_no_plan_has_a_scale_factor_somebody_takes(compared):
    _, found, _ = compared
    assert registration._handy(found.laid) > registration.SURELY_HANDY
    odd = {v: replace(one, placing=Placing(one.placing.turn / 1.27)) for v, one in found.laid.views.items()}
    assert registration._handy(replace(found.laid, views=odd)) < 0.2
    assert registration._handy(replace(found.laid, views={})) == 1


@pytest.mark.parametrize(("scale", "declared", "said"), [
    (2.0, 25.4, "in millimetres at scale 1:2 though the file declares inches"), (1.0, 25.4, "in millimetres though"),
    (12.7, 25.4, "at scale 2:1; it was scaled to 1:1"), (50.8, 1.0, "in inches at scale 1:2 though the file declares millimetres"),
    (2.0, None, "at scale 1:2; it"), (3.3, 25.4, "one unit of the drawing is 3.3 mm")])
def test_the_unit_that_was_taken_is_said(scale, declared, said):
    assert said in cad_drawing._scaled(scale, declared)


def test_a_layout_of_ones_own_in_a_frame_and_turned(compared, tmp_path):
    """The frame alone has four ways, also mirrored ones, that are alike; a user coordinate system turns everything."""
    _, found, drawn = compared
    right = [v for v in PLACES if v not in found.built]
    frame = [e for e in KNOWN.elements if not e.view.n and e.kind == "curve"]
    views = [moved(e, PLACES[e.view]) for e in drawn.elements if e.view in right]
    path = tmp_path / "framed.dxf"
    path.write_bytes(draw(frame + views, Way(np.exp(1j * np.pi / 6), 70 - 20j, 1), random.Random(3)))
    shaped = {e.view for e in KNOWN.elements if e.role in view_search.SHAPES}
    few = replace(KNOWN, elements=tuple(e for e in KNOWN.elements if e.view in right or e.view not in shaped))
    laid = registration.register([few], cad_file.read(path))
    assert not laid.placing.mirrored
    assert laid.placing.degrees == pytest.approx(-30, abs=0.01)
    assert laid.placing.scale == pytest.approx(1, abs=1e-4)
    for v in right[:2]:
        assert is_there(PLACES[v], laid.views[v].placing, v.box.corners, 1.0), v.name


def test_the_lettering_tells_how_a_drawing_is_turned_else_its_lines(compared):
    _, found, _ = compared
    space = found.laid.space
    assert registration._askew(space) == 0
    for degrees, said in ((30, 30), (45, 45), (117, 27), (0.3, 0), (-20, -20), (90, 0)):
        turned = space.placed(Placing(np.exp(1j * np.radians(degrees))))
        assert (np.degrees(registration._askew(turned)) - said + 45) % 90 == pytest.approx(45, abs=0.01)
    upright = replace(space, writings=(), strokes=tuple(s for s in space.strokes if abs(np.diff(s.points).imag).max() < 1e-6))
    assert registration._askew(upright) == 0
    assert np.degrees(registration._askew(upright.placed(Placing(np.exp(1j * np.pi / 6))))) == pytest.approx(30)
    assert registration._askew(replace(space, writings=(), strokes=())) == 0


def test_a_view_that_is_turned_is_told_so_once(compared):
    """It is neither missing nor wrong line by line; the others are not turned."""
    _, found, _ = compared
    turned = VIEWS["План скоростей, положение 7"]
    assert {v: told.said() for v, told in found.turned.items()} == {turned: "drawn turned by 90° counter-clockwise"}
    (told,) = (m for m in cad_story.mistakes(found, cad_report.gone(found.outcome)) if m.where == turned.name)
    assert (told.what, told.verdict, told.named) == (found.turned[turned].said(), "red", True)
    assert not [f for f in found.outcome.findings if f.element.view == turned and f.verdict == "red"]


@pytest.mark.parametrize(("move", "said"), [
    (Placing(2 + 0j), ""), (Placing(1 + 0.001j), ""), (Placing(-1j), "drawn turned by 90° clockwise"),
    (Placing(-1 + 0j), "drawn turned by 180°: every arrow points the other way"),
    (Placing(-2 + 0j, 0j, True), "drawn mirrored, left and right exchanged"),
    (Placing(1 + 0j, 0j, True), "drawn mirrored, top and bottom exchanged"), (Placing(1j, 0j, True), "drawn mirrored and turned")])
def test_how_a_view_is_turned(move, said):
    told = cad_report._turned(move)
    assert (told.said() if told else "") == said


@pytest.mark.parametrize("again", ["5", "8"])
def test_a_plan_drawn_twice_is_named(again):
    """In place of a plan that of another position is drawn."""
    plans, errors = errors_of(SHAPER, KNOWN)
    view = VIEWS["План скоростей, положение 7"]
    drawn = drawn_plan(KNOWN, plans, view)
    made = next(h for h in possible([drawn], errors) if h.words == "drawn twice" and h.other == again)
    now = [between(e, drawn.moved(replay(errors, made.changes))) for e in drawn.vectors]
    theirs = lines(now)

    def seen(view):
        return StudentDrawing(lambda line: cad_built._inked(theirs, Placing(), line), lambda z: z, [])

    other = [v for v in KNOWN.elements if v.view.n and v.view != view]
    (found, _), = built_otherwise(SHAPER, KNOWN, {view: list(drawn.vectors)}, seen, absent={e.view for e in other}).values()
    assert found.said() == f"here the plan of position {again} is drawn once more"


def test_the_note_counts_the_views_that_a_mistake_had_hidden(compared):
    """And tells of none of them where it was taken to be before."""
    _, found, _ = compared
    count = sum(v in found.places.moves for v in found.places.share if v.n)
    assert [note for note in found.notes if f" {count} found by shape" in note]
    assert count >= len(PLACES)
    assert not [note for note in found.notes if "compared there" in note]


def test_what_is_right_is_not_accused(compared):
    """Lines that are not drawn are a remark on their view; the exact plan tells what is right."""
    _, found, drawn = compared
    there = {e.number for e in drawn.elements}
    bad = [f for f in found.outcome.findings if f.verdict in ("red", "amber") and f.element.view in PLACES]
    assert {f.element.number for f in bad} == drawn.wrong.keys()
    left_out = {(x.view, x.kind) for x in found.outcome.absent}
    assert {(v, "construction") for v in PLACES.keys() - set(FORCES)} <= left_out  # a force polygon has none
    judged = [f for f in found.outcome.findings if f.element.view in PLACES and f.verdict is not None]
    assert {f.element.number for f in judged} <= there


def test_the_plan_is_compared_as_it_was_built(compared):
    _, found, drawn = compared
    assert found.built.keys() == {ACCELERATIONS, *FORCES}
    assert {built.mistake.kind for built in found.built.values()} == {"coriolis"}
    red = Counter(f.element.view for f in found.outcome.findings if f.verdict == "red" and f.element.kind == "line")
    assert all(built.explains == built.of == red[view] for view, built in found.built.items())
    wrong = [f for f in found.outcome.findings if f.element.number in drawn.wrong]
    assert {f.verdict for f in wrong} == {"red"}
    assert not any(f.missing for f in wrong)
    assert all("as follows from the mistake" in f.what for f in wrong)
    assert "laid off the other way" in listed(cad_story.mistakes(found, cad_report.gone(found.outcome)))[1]


def test_a_view_taken_for_ink_of_its_shape_speaks_against_nothing(compared):
    """A view that was found by its shape, of which nothing else is there, was not drawn; one built wrongly was."""
    _, found, _ = compared
    assert not cad_drawing._by_chance(found.outcome, found.places.share) & PLACES.keys()
    elsewhere = [replace(f, verdict="red", missing=True, absent="", follows=False) for f in found.outcome.findings
                 if f.element.view == FORCES[0]]
    nothing_else = replace(found.outcome, findings=tuple(elsewhere))
    assert cad_drawing._by_chance(nothing_else, {FORCES[0]: 0.97}) == {FORCES[0]}
    assert cad_drawing._by_chance(nothing_else, {FORCES[0]: 0.5}) == set()


@pytest.mark.parametrize("far", [1e20, np.inf, np.nan])
def test_a_plan_that_no_paper_holds_is_none(far):
    """Nearly parallel lines meet anywhere."""
    plans = {plan.name: plan for plan in SHAPER.plans["study"].values()}
    drawn = drawn_plan(KNOWN, plans, ACCELERATIONS)
    last = drawn.points[-1].step
    assert not drawn.moved(lambda step: far if step is last else step.value)
    assert drawn.moved(lambda step: step.value + 1 if step is last else step.value)


@pytest.mark.parametrize(("project", "words", "at"), [
    (SHAPER, "crank", None), (PRESS, "intersection", 3)], ids=["crank", "intersection"])
def test_positions_built_otherwise_are_named(project, words, at):
    """Links end at the circles of their hinges; one position that is wrong is little of all, and is told with its number."""
    known = known_sheet(project, 1)
    plans, errors = errors_of(project, known)
    (view,) = (v for v in dict.fromkeys(e.view for e in known.elements) if drawn_positions(known, plans, v))
    drawn = drawn_positions(known, plans, view)
    made = next(h for h in possible([drawn], errors) if h.words == words and h.at == at)
    now = [between(e, drawn.moved(replay(errors, made.changes))) for e in drawn.vectors]
    theirs = lines(now)
    wrong = {view: [e for e, z in zip(drawn.vectors, now, strict=True) if abs(z - e.points).max() > 1]}

    def seen(view):
        return StudentDrawing(lambda line: cad_built._inked(theirs, Placing(), line), lambda z: z, [])

    (found, points), = built_otherwise(project, known, wrong, seen, positions=True).values()
    assert (found.mistake.words, found.mistake.step) == (words, made.step)
    label = drawn.plan.labels[at] if at is not None else ""
    assert found.position == label
    assert found.said() == found.mistake.said() + (f" (position {label})" if label else "")
    symbols = {e.position for e in known.elements if e.view == view and e.role == "symbol"
               and np.abs(rebuilt(e, points).points - e.points).max() > 0.1}
    assert symbols
    assert symbols <= {p.label for p in points if abs(p.now - p.was) > 0.1}


@pytest.mark.parametrize("times", [0.5, 2.0])
def test_an_arrow_keeps_its_head_in_a_view_of_another_scale(times):
    """Its shaft ends as far from the tip as on the sheet."""
    e = max((e for e in KNOWN.elements if e.view == ACCELERATIONS and e.role == "vector" and e.arrow), key=lambda e: e.length)
    (shaft,), (now,) = ([m for m in some.marks if isinstance(m, Line)] for some in (e, moved(e, Placing(times + 0j, 7 + 3j))))
    head = e.length - abs(shaft.b - shaft.a)
    assert head > 1
    assert abs(now.b - now.a) == pytest.approx(times * e.length - head)


def test_a_short_arrow_in_a_small_view_has_no_shaft_beyond_its_tip():
    """Its shaft ended nearer to the tail than to the tip; where there is no room for the head the whole line is its shaft."""
    shortest = min((e for e in KNOWN.elements if e.role == "vector" and e.arrow and e.kind == "line" and len(e.fills) == 1
                    and e.length > 5), key=lambda e: e.length)
    for times in (0.2, 0.4, 0.6, 0.9, 2.0):
        small = moved(shortest, Placing(times + 0j, 7 + 3j))
        (shaft,) = (m for m in small.marks if isinstance(m, Line))
        along = (np.array([shaft.a, shaft.b]) - small.points[0]) / (small.points[-1] - small.points[0])
        assert along.real.min() > -1e-9
        assert along.real.max() < 1 + 1e-9


@pytest.mark.parametrize(("title", "other"), [("Положение 9", True), ("ПЛАН СКОРОСТЕЙ ПОЛ. 9", True), ("Положение 3", False),
                                              ("План сил звена 9", False)])
def test_a_title_of_another_position_may_be_the_position_alone(title, other):
    assert titles.namesakes(titles.DrawnTitle.of("План скоростей, положение 3"), titles.DrawnTitle.of(title)) == other


def test_the_picture_shows_the_exact_plan_and_what_was_built(compared):
    _, found, _ = compared
    picture = next(m.picture for m in cad_story.mistakes(found, cad_report.gone(found.outcome)) if m.where == ACCELERATIONS.name)
    vectors = [e for e in KNOWN.elements if e.view == ACCELERATIONS and e.role == "vector" and e.kind == "line"]
    for e in vectors:
        exact = found.places.moves[ACCELERATIONS](e.points)
        assert any(len(z) == 2 and np.allclose(z, exact) for z in picture.ours), e.name
    last = next(e for e in vectors if e.name == "π–d5")
    drawn = next(f for f in found.outcome.findings if f.element.number == last.number).element
    assert any(len(z) == 2 and np.allclose(z, drawn.points) for z in picture.wrong)


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


def test_what_was_said_of_a_view_before_is_not_said_again(compared):
    """A view that follows leads back to it; in the terminal all are in one line."""
    _, found, _ = compared
    told = cad_story.mistakes(found, cad_report.gone(found.outcome))
    one, *others = (m for m in told if m.named and m.what.startswith("the Cor"))
    assert not one.again
    assert others
    assert all(one.where in m.again and m.what == one.what for m in others)
    assert len(listed([one, *others])) == 3
