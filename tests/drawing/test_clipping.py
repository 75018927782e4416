"""Clipping against shapely."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st
from shapely import LineString, box

from tmm_sheets.drawing.ink import arcs_inside, polyline_inside, segment_inside
from tmm_sheets.drawing.marks import Box

PLACE = Box(-3.0, -2.0, 4.0, 5.0)
coordinate = st.floats(-10, 10).map(lambda v: round(v, 3) + 0.0004)
point = st.builds(complex, coordinate, coordinate)


def length_inside(points):
    return LineString(np.column_stack((np.real(points), np.imag(points)))).intersection(box(*PLACE)).length


@given(point, st.floats(0.1, 12))
def test_arcs(centre, radius):
    t = np.linspace(0, 2 * np.pi, 20001)
    found = arcs_inside(PLACE, centre, radius)
    assert sum(end - start for start, end in found) * radius == pytest.approx(
        length_inside(centre + radius * np.exp(1j * t)), abs=1e-2 * radius)
    for start, end in found:
        middle = centre + radius * np.exp(0.5j * (start + end))
        assert PLACE.contains(middle, 1e-9)


def test_whole_circle_and_none():
    assert arcs_inside(PLACE, 0j, 1.0) == [(0.0, 2 * np.pi)]
    assert arcs_inside(PLACE, 0j, 20.0) == []
    assert arcs_inside(PLACE, 30j, 1.0) == []


@given(point, point)
def test_segment(a, b):
    part = segment_inside(PLACE, a, b)
    if part is None:
        assert length_inside([a, b]) < 1e-9
    else:
        assert abs(part[1] - part[0]) == pytest.approx(length_inside([a, b]), abs=1e-9)


@given(st.lists(point, min_size=2, max_size=8, unique=True))
def test_polyline(points):
    parts = polyline_inside(PLACE, np.array(points))
    inside = [length_inside(pair) for pair in pairwise(points)]
    assert sum(np.abs(np.diff(p)).sum() for p in parts) == pytest.approx(sum(inside), abs=1e-9)


def test_a_curve_inside_stays_in_one_piece():
    curve = np.array([0, 1 + 1j, 2 + 0.5j, 1 - 1j])
    (whole,) = polyline_inside(PLACE, curve)
    assert np.array_equal(whole, curve)
