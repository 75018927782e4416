"""Ink that comes later: the cells and their counts are those of an index made of everything at once."""

import numpy as np
import pytest

from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.marks import Box, Fill, Line, Text
from tmm_sheets.sheets.border_solver import JUST, Need

AREA = Box(0.0, 0.0, 120.0, 80.0)
MARKS = [Line(3 + 4j, 90 + 70j, "main"), Line(-10 + 40j, 130 + 41j, "thin"), Text(30 + 30j, "F_1", 3.5),
         Line(50 + 0j, 50 + 80j, "thin"), Fill(np.array([100 + 5j, 110 + 5j, 105 + 15j]), "main"), Text(118 + 78j, "beyond", 5.0),
         Line(0j, 120 + 0j, "curve")]  # fmt: skip


@pytest.mark.parametrize("pieces", [[7], [0, 7], [3, 4], [1] * 7, [2, 0, 5]])
def test_cells_that_grow_are_those_of_all_marks(pieces):
    index, first = InkIndex([], AREA), 0
    for count in pieces:
        index.add(MARKS[first:first + count])
        first += count
        assert index.heavy is index.heavy
        assert index.light.taken.shape == (240, 160)
    whole = InkIndex(MARKS, AREA)
    assert whole.heavy.taken.any()
    assert (index.heavy.taken == whole.heavy.taken).all()
    assert (index.light.taken == whole.light.taken).all()
    assert (index.heavy.table == whole.heavy.table).all()


def test_counts_in_a_part_are_those_in_the_whole():
    """Also of rectangles at the edges, beyond them, and of no size."""
    cells = InkIndex(MARKS, AREA).heavy
    x, y = np.array([-30.0, 0.0, 40.2, 99.9, 119.8, 150.0]), np.array([-9.0, 0.0, 33.3, 79.9])
    for width, height in ((20.0, 10.0), (0.0, 0.0), (200.0, 200.0)):
        corners = np.array([(a, b, a + width, b + height) for a in x for b in y]).T
        assert (cells.count_lattice(x, y, width, height).ravel() == cells.count_under(corners)).all()
    assert cells.count_under(np.array([[0.0, 0.0, 120.0, 80.0]]).T)[0] == cells.taken.sum()


def test_a_place_just_too_small_is_too_small():
    need = Need(least=(100.0, 50.0), covered=10.0)
    assert need.short(100.0, 60.0) == 0.0
    assert need.short(99.0, 60.0) == pytest.approx(0.01 + JUST)
    assert need.short(99.0, 55.0) == pytest.approx(0.01 + 0.1 + JUST)
