"""Paths of pens: compared with unit steps drawn one by one, and with counts that graph theory gives."""

from collections import Counter
from itertools import pairwise, permutations
from math import gcd

import numpy as np
import shapely
from hypothesis import example, given, settings, strategies as st

from tmm_sheets.drawing.pen_paths import drop_retraced, fill_passes, join_segments, line_passes, ordered, raised_travel

place = st.tuples(st.integers(0, 6), st.integers(0, 6))
path = st.lists(place, min_size=1, max_size=6).map(lambda p: (p[0], *(b for a, b in pairwise(p) if a != b)))
paths = st.lists(path, max_size=12)
corner = st.tuples(st.integers(0, 60), st.integers(0, 60))


def inked(passes, pen):
    """Area of ink, piece by piece: the buffer of a whole line may be invalid (GEOS 3.14)."""
    pieces = [shapely.LineString([(a.real, a.imag), (b.real, b.imag)]) for p in passes for a, b in pairwise(p)]
    return shapely.union_all(shapely.buffer(pieces, pen / 2), grid_size=1e-6)


def smallest(some):
    """The pieces between neighbouring points of the grid that lie on paths: each piece once for each time it is drawn."""
    for path in some:
        for (x0, y0), (x1, y1) in pairwise(path):
            n = gcd(x1 - x0, y1 - y0)
            u, v = (x1 - x0) // n, (y1 - y0) // n
            for i in range(n):
                yield tuple(sorted(((x0 + i * u, y0 + i * v), (x0 + i * u + u, y0 + i * v + v))))


@given(paths)
def test_without_doubles_draws_all_of_it_once(some):
    got = list(smallest(drop_retraced(some)))
    assert len(got) == len(set(got))
    assert set(got) == set(smallest(some))


@given(paths)
def test_joined_paths_begin_and_end_only_where_they_must(some):
    """An open path begins and ends where an odd number of lines meet, one at each such place (Euler); the rest is closed."""
    single = list(drop_retraced(some))
    got = join_segments(single)
    assert sorted(smallest(got)) == sorted(smallest(single))
    degree = Counter(p for piece in single if len(piece) == 2 for p in piece)
    ends = Counter(p for path in got if path[0] != path[-1] for p in (path[0], path[-1]))
    assert ends == {p: 1 for p, n in degree.items() if n % 2}


def test_a_curve_goes_straight_on_where_it_crosses_another():
    cross = [((0, 0), (5, 5)), ((5, 5), (10, 10)), ((0, 10), (5, 5)), ((5, 5), (10, 0))]
    assert sorted(map(sorted, join_segments(cross))) == [[(0, 0), (5, 5), (10, 10)], [(0, 10), (5, 5), (10, 0)]]


def test_a_closed_curve_is_one_path():
    ring = [((0, 0), (9, 0)), ((9, 9), (9, 0)), ((0, 9), (9, 9)), ((0, 0), (0, 9))]
    (path,) = join_segments(ring)
    assert path[0] == path[-1]
    assert len(path) == 5


def test_overlapping_and_touching_lines_become_one():
    lines = [((0, 0), (10, 0)), ((20, 0), (5, 0)), ((20, 0), (30, 0)), ((40, 0), (31, 0)), ((0, 1), (10, 1)), ((3, 1), (7, 1))]
    assert sorted(drop_retraced(lines)) == [((0, 0), (30, 0)), ((0, 1), (10, 1)), ((31, 0), (40, 0))]


def test_order_keeps_every_path_and_saves_most_of_the_travel():
    """Best tours through random points are 0.71 sqrt(n A) long (Beardwood, Halton, Hammersley 1959); ends count as points."""
    rng = np.random.default_rng(5)
    some = [tuple(map(tuple, p)) for p in (rng.integers(0, 30000, (1500, 1, 2)) + rng.integers(-40, 41, (1500, 2, 2))).tolist()]
    got = ordered(some)
    assert sorted(map(sorted, got)) == sorted(map(sorted, some))
    assert raised_travel(got, (0, 0)) < 1.15 * 0.7124 * np.sqrt(1500) * 30000


def test_order_of_a_few_is_near_the_best():
    rng = np.random.default_rng(7)
    for _ in range(20):
        some = [tuple(map(tuple, rng.integers(0, 1000, (2, 2)).tolist())) for _ in range(4)]
        best = min(raised_travel([p[::-1] if turn >> i & 1 else p for i, p in enumerate(order)], (0, 0))
                   for order in permutations(some) for turn in range(16))  # fmt: skip
        assert best - 1e-9 <= raised_travel(ordered(some), (0, 0)) <= 1.6 * best


@given(st.lists(corner, min_size=3, max_size=5, unique=True), st.sampled_from([0.2, 0.3, 0.5]))
@example([(22, 28), (21, 26), (27, 40), (16, 15)], 0.2)  # what one stroke leaves of a spot is seen
@settings(max_examples=20)
def test_passes_cover_a_thick_bent_line(corners, pen):
    points = np.array(corners) @ [1, 1j]
    band = inked([points], 1.0)
    ink = inked(line_passes(points, 1.0, pen), pen)
    assert ink.difference(band.buffer(0.01)).area == 0
    assert band.buffer(-0.01).difference(ink.buffer(0.05)).area == 0


def test_areas_that_are_alike_are_filled_once():
    from tmm_sheets.drawing import pen_paths

    pen_paths.filled_paths.cache_clear()
    head = np.array([0, -4 + 0.7j, -4 - 0.7j])
    first = list(fill_passes(head, 0.2))
    for place, turn in ((30 + 20j, 1j), (7 - 3j, np.exp(0.3j)), (0, -1)):
        found = list(fill_passes(place + turn * head, 0.2))
        assert len(found) == len(first) > 2
        for way, own in zip(found, first, strict=True):
            np.testing.assert_allclose(way, place + turn * own, atol=1e-5)
    assert pen_paths.filled_paths.cache_info().misses == 1


def test_passes_fill_an_area_but_for_its_acute_tips():
    arrow = np.array([0, -6 + 1j, -6 - 1j])
    area = shapely.Polygon(np.column_stack((arrow.real, arrow.imag)))
    ink = inked(fill_passes(arrow, 0.2), 0.2)
    assert area.difference(ink.buffer(0.05)).area == 0
    assert ink.difference(area.buffer(0.1)).area < 1e-12
    assert ink.difference(area.buffer(0.05)).bounds[0] > -1.2  # only at the tip is the pen too thick


def test_an_area_narrower_than_the_pen_is_one_stroke():
    (stroke,) = fill_passes(np.array([0, 5, 5 + 0.1j, 0.1j]), 0.3)
    assert abs(stroke[1] - stroke[0]) == abs(5 + 0.1j) - 0.3
