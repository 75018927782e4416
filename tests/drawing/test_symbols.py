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
