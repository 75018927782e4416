"""The balancing force of a gear has its sign on the sheet: where it holds the wheel back that is said."""

import pytest

from tests import project_files as files
from tmm_sheets import catalogue
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import kinetics
from tmm_sheets.sheets.sheet import composed


@pytest.mark.parametrize(("position", "value", "held"), [("2", "7744,9", False), ("6", "−40,0", True), ("9", "−3843,3", True)])
def test_a_gear_force_that_holds_back_is_negative(position, value, held):
    own = files.project(files.from_file("lugansk/shaper"), files.NOMINAL, {"cycle.force_position": position})
    canvas = Canvas()
    kinetics.results(own, canvas, Box(0, 0, 210, 60), {})
    said = {group.text for group in canvas.groups}
    assert sum(text.startswith(value[:-2]) for text in said) == 1
    assert any("удерживается" in note.text for note in canvas.notes) is held


@pytest.mark.parametrize(("name", "n", "title", "told"), [
    ("sixbar/8:3", 1, "Уравнения моментов", "Mур = 3402·0,09644 = 328,1 Н·м (против ω"),
    ("tests/projects/boom.toml", 2, "Начальное звено", "Mи1 = 0,23645 Н·м")])
def test_the_equation_stands_under_the_crank_or_the_values_where_it_has_none(name, n, title, told):
    """In the view of the crank, not of its force plan; a crank that a cylinder drives has no equation of its own."""
    sheet = composed(Project(catalogue.read(name)), n)
    assert sheet.leaving == ()
    lines = [mark for mark in sheet.drawing.marks if isinstance(mark, Text)]
    own = ["".join(mark.text for mark in lines if part.box.contains(mark.at)) for part in sheet.parts if part.title == title]
    assert [told in said for said in own].count(True) == 1
