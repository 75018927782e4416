"""Single elements of a CAD drawing done wrongly: each is told once, by its own name."""

import random
from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest

from tests.compare.cad_plants import Way, compared, draw
from tests.compare.one_wrong import APART, done, shows, sort_of
from tests.few import seldom
from tmm_sheets.catalogue import read
from tmm_sheets.compare.elements import elements
from tmm_sheets.drawing.ink import letters
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

SORTS = ("line", "arrow", "arc", "circle", "dot", "curve")
WAYS = ("shifted", "left out", "twice")


def setup_module():
    """Composed when the first of these tests runs: every worker imports this file."""
    global SHEET, EXACT
    SHEET = composed(Project(read("lugansk/shaper")), 4)
    EXACT = list(elements(SHEET))


@pytest.mark.parametrize("wrong", [
    tuple(zip(SORTS, 2 * WAYS, strict=True)), *(seldom((one,)) for one in product(SORTS, WAYS))], ids=str)
def test_one_accusation(wrong):
    """Of each element that is done wrongly, in one drawing."""
    made = {}
    for sort, way in wrong:
        for e in (e for e in EXACT if e.view.n and sort_of(e) == sort and (sort == "dot" or e.length > 8)):
            if all(abs(e.middle - other.middle) > APART for other, _ in made.values()) and shows(
                    e, ink := done(e, way, random.Random(1)), EXACT):
                made[sort] = e, ink
                break
    instead = {e.number: ink for e, ink in made.values()}
    drawn = [one for e in EXACT for one in instead.get(e.number, [e])]
    outcome = compared(draw(drawn, Way(), random.Random(2)), SHEET, EXACT)
    bad = {f.element.number for f in outcome.findings if f.verdict in ("red", "amber")}
    assert bad == {made[sort][0].number for sort, way in wrong if way != "twice"}
    assert len(outcome.extras) == sum(way == "twice" for _, way in wrong)


@pytest.mark.trial
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


@pytest.mark.trial
def test_lines_through_the_place_of_a_text_are_no_other_letters():
    """Half of the strokes of the digits lie on them."""
    e = next(e for e in EXACT if e.kind == "text" and e.text == "14")
    strokes = sorted((np.array(ends) for mark in e.marks for stroke in letters(mark) for ends in pairwise(stroke)),
                     key=lambda z: -abs(z[1] - z[0]))[:3]
    line = next(e for e in EXACT if e.kind == "line" and not e.fills)
    through = [replace(line, points=z.mean() + 10 * (z - z.mean())) for z in strokes]
    outcome = compared(draw([*(other for other in EXACT if other is not e), *through], Way(), random.Random(2)), SHEET, EXACT)
    wrong = next(f for f in outcome.findings if f.element is e)
    assert wrong.missing
    assert f'text "{e.text}" missing' == wrong.what
