"""Arrows of a CAD drawing that were spoiled in different ways: what is said of each is what was done to it."""

import random
from dataclasses import replace

import numpy as np
import pytest

from tests.compare.cad_plants import Way, compared, draw
from tmm_sheets.catalogue import read
from tmm_sheets.compare.elements import elements
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed


def setup_module():
    """Composed when the first of these tests runs: every worker imports this file."""
    global SHEET, EXACT, MOVED, SHORT, TURNED, GONE, LONG, REVERSED
    SHEET = composed(Project(read("lugansk/shaper")), 1)
    EXACT = elements(SHEET)
    MOVED, SHORT = arrow("План скоростей, положение 1", "p–b"), arrow("План ускорений", "π–s3")
    TURNED, GONE, LONG = (arrow(f"План скоростей, положение {k}", "p–d") for k in (2, 4, 9))
    REVERSED = arrow("План скоростей, положение 7", "p–d")


def arrow(view, name):
    """A vector with one head, on which a thinner line of the construction lies: its place is never empty."""
    return next(e for e in EXACT if e.view.name.startswith(view) and e.name == name and e.role == "vector")


def unit(e):
    return (e.points[1] - e.points[0]) / abs(e.points[1] - e.points[0])


def ending(e, tail, tip):
    """The arrow from ``tail`` to ``tip``."""
    turn = (tip - tail) / abs(tip - tail) / unit(e)
    return replace(e, points=np.array([tail, tip]), fills=tuple(tip + (f - e.points[1]) * turn for f in e.fills))


@pytest.fixture(scope="module")
def said():
    made = {}
    for e, tail, tip in (
        (MOVED, 3j * unit(MOVED), 3j * unit(MOVED)), (SHORT, 0, -8 * unit(SHORT)), (LONG, 0, 4 * unit(LONG)),
        (TURNED, 0, 4j * unit(TURNED)), (REVERSED, *(REVERSED.points[::-1] - REVERSED.points)),
    ):
        made[e.number] = ending(e, e.points[0] + tail, e.points[1] + tip)
    drawn = [made.get(e.number, e) for e in EXACT if e is not GONE]
    return {f.element.number: f for f in compared(draw(drawn, Way(), random.Random(1)), SHEET, EXACT).findings}


@pytest.mark.parametrize(("done", "what"), [
    ("MOVED", "3.0 mm too far"), ("SHORT", "the tip is 8.00 mm off"), ("LONG", "the tip is 4.00 mm off"), ("TURNED", "turned by"),
    ("GONE", "no arrow head"), ("REVERSED", "points the other way"),
])  # fmt: skip
def test_an_arrow_is_accused_of_what_was_done_to_it(said, done, what):
    e = globals()[done]
    assert said[e.number].verdict in ("red", "amber")
    assert what in said[e.number].what


def test_no_other_arrow_is_said_to_point_the_other_way(said):
    assert [n for n, f in said.items() if "other way" in f.what] == [REVERSED.number]


def test_heads_outside_a_short_dimension_are_its_own():
    known = elements(composed(Project(read("lugansk/shaper")), 4))
    outside = [e for e in known if e.role == "dimension" and len(e.fills) == 2 and _between_heads(e) < e.length - 6]
    assert outside
    some = [e for e in known if e.role in ("dimension", "frame")]
    found = compared(draw(some, Way(), random.Random(1)), None, some).findings
    assert {f.verdict for f in found} == {"green"}


def _between_heads(e):
    """Distance of the tips of a dimension's heads."""
    return abs(e.fills[0][0] - e.fills[1][0])
