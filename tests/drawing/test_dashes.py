from math import pi

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tmm_sheets.drawing.ink import cut, strokes
from tmm_sheets.drawing.marks import Arc, Fill, Line, Polyline, Text, flat
from tmm_sheets.drawing.styles import line_types

PATTERNS = [t.pattern for t in line_types().values() if t.pattern]


@given(st.floats(0.01, 2000), st.sampled_from(PATTERNS))
def test_line_begins_and_ends_with_a_stroke_and_the_gaps_are_the_patterns(length, pattern):
    pieces = np.array(cut(length, pattern))
    assert pieces[0, 0] == 0
    assert pieces[-1, 1] == pytest.approx(length, rel=1e-12)
    drawn = pieces[:, 1] - pieces[:, 0]
    gaps = pieces[1:, 0] - pieces[:-1, 1]
    period = len(pattern) // 2
    n = len(gaps) // period
    assert len(gaps) == n * period
    assert gaps == pytest.approx([-g for g in pattern[1::2]] * n, abs=1e-9)
    long = drawn[::period]
    assert np.ptp(long) < 1e-9
    if n:
        assert long[0] >= max(0.32 * pattern[0], 2.0)
    assert long[0] < 2.2 * pattern[0] + 8  # never solid for long


@given(st.floats(60, 2000), st.sampled_from([p for p in PATTERNS if len(p) > 2]))
def test_middle_of_a_centre_line_lies_in_a_long_stroke(length, pattern):
    assert any(a < length / 2 < b and b - a > 5 for a, b in cut(length, pattern))


@given(st.floats(15, 400), st.sampled_from(PATTERNS))
def test_circle_crosses_its_axes_in_strokes(radius, pattern):
    pieces = list(strokes([Arc(1 + 2j, radius, 0.0, 2 * pi, next(s for s, t in line_types().items() if t.pattern == pattern))]))
    for quarter in range(4):
        t = quarter * pi / 2
        assert any(p.start - 1e-9 <= t + turn <= p.end + 1e-9 for p in pieces for turn in (0, 2 * pi))
    assert all(p.radius == radius and p.centre == 1 + 2j for p in pieces)


@given(st.floats(0.01, 2000), st.sampled_from(PATTERNS))
def test_first_and_last_stretch_of_a_closed_line_are_one_long_stroke(length, pattern):
    pieces = np.array(cut(length, pattern, closed=True))
    assert pieces[0, 0] == 0
    assert pieces[-1, 1] == length
    first, *others, last = (pieces[:, 1] - pieces[:, 0])[::len(pattern) // 2] if len(pieces) > 1 else (length / 2, length / 2)
    assert first == pytest.approx(last, abs=1e-9)
    assert others == pytest.approx([first + last] * len(others), abs=1e-9)


def test_polyline_keeps_its_corners_and_loses_only_gaps():
    points = np.array([0, 30, 30 + 40j, 90 + 40j])
    parts = list(strokes([Polyline(points, "centre")]))
    total = sum(float(np.abs(np.diff(p.points)).sum()) for p in parts)
    gap = -line_types()["centre"].pattern[1]
    assert total == pytest.approx(130 - (len(parts) - 1) * gap)
    assert parts[0].points[0] == 0
    assert parts[-1].points[-1] == 90 + 40j
    outline = flat(Polyline(points, "thin"))
    for p in np.concatenate([p.points for p in parts]):
        x, y = p.real, p.imag
        assert (y == 0 and x <= 30) or (x == 30 and y <= 40) or y == pytest.approx(outline[-1].imag)


def test_closed_polyline_is_dashed_round_to_its_beginning():
    square = np.array([0, 100, 100 + 100j, 100j])
    parts = list(strokes([Polyline(square, "hidden", closed=True)]))
    assert parts[0].points[0] == parts[-1].points[-1] == 0
    assert not any(p.closed for p in parts)


def test_other_marks_pass_unchanged():
    marks = [Line(0j, 9 + 0j, "main"), Text(1j, "А", 5.0), Fill(np.array([0, 1, 1j]), "hidden"), Arc(0j, 1.0, 0.0, 1.0, "thin")]
    assert list(strokes(marks)) == marks


@pytest.mark.parametrize("length", [0.0, float("nan"), float("inf")])
def test_what_is_no_length_is_left_to_the_writer(length):
    assert np.array_equal(cut(length, PATTERNS[0]), [(0.0, length)], equal_nan=True)
