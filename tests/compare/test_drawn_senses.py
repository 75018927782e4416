"""Arrows of forces, couples and rotation at the mechanism tell mistakes apart that give the same plans."""

import numpy as np
import pytest

from tests.few import seldom
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.diagnosis.built_plan import StudentDrawing, built_otherwise, errors_of, possible
from tmm_sheets.compare.diagnosis.drawn_plan import between, drawn_plan
from tmm_sheets.compare.diagnosis.drawn_senses import acting
from tmm_sheets.compare.diagnosis.replay import replay
from tmm_sheets.compare.known_sheet import known_sheet
from tmm_sheets.project import Project

PRESS = Project(read("press"))


def setup_module():
    """Composed when the first of these tests runs: every worker imports this file."""
    global KNOWN, VIEWS, POLYGON, SCHEME, PLANS, ERRORS, ARROWS
    KNOWN = known_sheet(PRESS, 2)
    VIEWS = {e.view.name: e.view for e in KNOWN.elements}
    POLYGON, SCHEME = VIEWS["План сил группы 2–3"], VIEWS["Группа Ассура 2–3 (2-й вид)"]
    PLANS, ERRORS = errors_of(PRESS, KNOWN)
    ARROWS = {view: acting(KNOWN, PLANS, view) for view in VIEWS.values()}


def inked(theirs, line):
    """Share of a line that others cover."""
    return theirs.share(line[0] + (line[1] - line[0]) * np.linspace(0.02, 0.98, 40), 0.4)


def test_which_arrows_there_are():
    """Whole forces and what turns; a part of a reaction is no force of its own, a vector of a plan not at the mechanism."""
    names = {a.element.name for a in ARROWS[SCHEME]}
    assert {"Fи2", "Fи3", "F21τ", "Mи2"} <= names
    assert "F21n" not in names
    assert {a.element.name.partition("(")[0] for a in ARROWS[VIEWS["Планы положений механизма"]]} == {"ω1", "ω2", "ε2"}
    assert not ARROWS[POLYGON]


@pytest.mark.parametrize("times", [1, -1, 2, 0, np.nan])
def test_an_arrow_as_it_was_taken(times):
    """A force turns about its point and keeps its length; what turns the other way has its head at the other end of the arc."""
    for a in ARROWS[SCHEME]:
        e, now = a.element, a.taken(lambda step: step.value * times)
        if e.kind == "arc":
            tip, other = e.fills[0][0], now.fills[0][0]
            assert (abs(tip - other) > 3) == (np.real(times) < 0)
            assert abs(other - e.centre) == pytest.approx(abs(tip - e.centre))
            assert np.allclose(sorted(now.points[[0, -1]], key=abs), sorted(e.points[[0, -1]], key=abs))
        else:
            turn = times / abs(times) if times and np.isfinite(times) else 1
            assert np.allclose(now.points - e.points[0], turn * (e.points - e.points[0]))
            assert abs(now.fills[0][0] - now.points[-1]) == pytest.approx(abs(e.fills[0][0] - e.points[-1]))


def named(made, arrows):
    """What is told of a polygon drawn with a mistake, where these arrows are drawn."""
    drawn = drawn_plan(KNOWN, PLANS, POLYGON)
    now = [between(e, drawn.moved(replay(ERRORS, made.changes))) for e in drawn.vectors]
    theirs = lines([*now, *(a.points[[0, -1]] for a in arrows if a.kind == "line")])
    heads = [a.fills[0][0] for a in arrows]

    def seen(view):
        return StudentDrawing(lambda line: inked(theirs, line), lambda z: z, [],
                       headed=lambda arrow: any(abs(arrow.fills[0][0] - head) < 1 for head in heads))

    absent = set(VIEWS.values()) - {POLYGON, SCHEME, VIEWS["Планы положений механизма"]}
    (found, _), = built_otherwise(PRESS, KNOWN, {POLYGON: list(drawn.vectors)}, seen, absent=absent).values()
    return [(h.words, h.step.name) for h in (found.mistake, *found.alike)]


def of_polygon(words, step):
    return next(h for h in possible([drawn_plan(KNOWN, PLANS, POLYGON)], ERRORS) if (h.words, h.step.name) == (words, step))


@pytest.mark.parametrize("mistake", [("laid off", "7"), seldom(("turning", "ε2"))])
def test_the_arrows_tell_how_a_force_was_taken(mistake):
    made = of_polygon(*mistake)
    value = replay(ERRORS, made.changes)
    assert named(made, [a.taken(value) for some in ARROWS.values() for a in some])[0] == mistake


def test_without_arrows_nothing_tells_it():
    assert set(named(of_polygon("laid off", "7"), [])) == {("inertia", "Fи3"), ("laid off", "7")}
