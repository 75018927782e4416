"""The balancing force of a gear has its sign on the sheet: where it holds the wheel back that is said."""

import pytest

from tests import project_files as files
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.sheets.linkage import kinetics


@pytest.mark.parametrize(("position", "value", "held"), [("2", "7744,9", False), ("6", "−40,0", True), ("9", "−3843,3", True)])
def test_a_gear_force_that_holds_back_is_negative(position, value, held):
    own = files.project(files.from_file("lugansk/shaper"), files.NOMINAL, {"cycle.force_position": position})
    canvas = Canvas()
    kinetics.results(own, canvas, Box(0, 0, 210, 60), {})
    said = {group.text for group in canvas.groups}
    assert sum(text.startswith(value[:-2]) for text in said) == 1
    assert any("удерживается" in note.text for note in canvas.notes) is held
