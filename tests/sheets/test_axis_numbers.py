"""No line runs through a number at an axis of a graph: judged as :mod:`tests.axis_numbers` does, on sheets where many would."""

import pytest

from tests import axis_numbers
from tests.drawing.test_axis_numbers import struck
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed


@pytest.mark.parametrize(("name", "n", "least"), [("sixbar/8:3", 2, 120), ("lugansk/cam_rocker", 1, 40)])
def test_no_number_at_an_axis_is_struck(name, n, least):
    numbers = axis_numbers.of_sheet(composed(Project(read(name)), n))
    assert len(numbers) >= least
    assert [number.text for number in numbers if number.struck] == []


def test_the_judge_sees_a_struck_number():
    canvas = Canvas()
    canvas.text(0j, "12", 3.5)
    canvas.line(-5 + 1j, 20 + 1j)
    assert struck(canvas) == ["12"]
