from __future__ import annotations

import pytest

from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas


def bar(a, b, hinges):
    canvas = Canvas()
    symbols.bar(canvas, (a, b), hinges, "main", 1.0)
    return [(m.a, m.b) for m in canvas.marks]


@pytest.mark.parametrize("beyond", [[], [25 + 0j], [-25 + 0j], [12 + 0j, 25 + 0j], [10 + 3j]])
def test_a_bar_ends_at_its_own_hinges_whatever_lies_farther_on_its_line(beyond):
    assert bar(0j, 10 + 0j, [0j, 10 + 0j, *beyond]) == [(1 + 0j, 9 + 0j)]


def test_a_bar_without_a_hinge_at_its_end_goes_up_to_it():
    assert bar(0j, 10 + 0j, [0j, 25 + 0j]) == [(1 + 0j, 10 + 0j)]
    assert bar(0j, 10 + 0j, [4 + 0j]) == [(0j, 3 + 0j), (5 + 0j, 10 + 0j)]
    assert bar(0j, 10 + 0j, [10.5 + 0j]) == [(0j, 9.5 + 0j)]


@pytest.mark.parametrize(("u", "v", "marks"), [
    (7 + 0j, 3j, 1), (1 + 0j, -1 + 1j, 1), (1 + 0j, 2 + 0.1j, 0), (1 + 0j, -1 + 0j, 0), (1 + 0j, 5 + 0j, 0),
], ids=["right", "obtuse", "all but straight", "straight", "one on the other"])  # fmt: skip
def test_a_rigid_corner_is_marked_unless_its_sides_are_one_line(u, v, marks):
    canvas = Canvas()
    symbols.rigid_corner(canvas, 10 + 10j, u, v)
    assert len(canvas.marks) == marks
    for mark in canvas.marks:
        assert max(abs(mark.points - (10 + 10j))) == pytest.approx(symbols.CORNER)
