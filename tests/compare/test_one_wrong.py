"""Single elements of a CAD drawing done wrongly: each is told once, by its own name."""

import random

import pytest

from tests.compare.cad_plants import Way, compared, draw
from tests.compare.one_wrong import done, shows, sort_of
from tmm_sheets.catalogue import read
from tmm_sheets.compare.elements import elements
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

SHEET = composed(Project(read("lugansk/shaper")), 4)
EXACT = list(elements(SHEET))
SORTS = ("line", "arrow", "arc", "circle", "dot", "curve")


@pytest.mark.parametrize("way", ["shifted", "left out", "twice"])
@pytest.mark.parametrize("sort", SORTS)
def test_one_accusation(sort, way):
    for e in (e for e in EXACT if e.view.n and sort_of(e) == sort and (sort == "dot" or e.length > 8)):
        made = done(e, way, random.Random(1))
        if shows(e, made, EXACT):
            break
    drawn = [one for other in EXACT for one in (made if other is e else [other])]
    outcome = compared(draw(drawn, Way(), random.Random(2)), SHEET, EXACT)
    bad = [f.element.number for f in outcome.findings if f.verdict in ("red", "amber")]
    assert (bad, len(outcome.extras)) == (([], 1) if way == "twice" else ([e.number], 0))


def test_an_arc_goes_with_its_head():
    e = next(e for e in EXACT if e.kind == "arc" and len(e.fills) == 1)
    made = done(e, "shifted", random.Random(1))
    outcome = compared(draw([*(other for other in EXACT if other is not e), *made], Way(), random.Random(2)), SHEET, EXACT)
    (wrong,) = (f for f in outcome.findings if f.verdict in ("red", "amber"))
    assert wrong.element is e
    assert "arrow head" not in wrong.what
    assert outcome.extras == ()


def test_a_hatching_is_missing_though_other_lines_slant_in_its_place():
    """Its neighbour, hatched the other way, and lines that were drawn for something else are no hatching of its own."""
    sheet = composed(Project(read("lugansk/engine")), 4)
    exact = list(elements(sheet))
    e = max((e for e in exact if e.kind == "hatch" and not e.name), key=lambda e: e.length)
    outcome = compared(draw([other for other in exact if other is not e], Way(), random.Random(2)), sheet, exact)
    assert [f.element.number for f in outcome.findings if f.verdict in ("red", "amber")] == [e.number]
