"""Letters of what belongs together have one height."""

import pytest

from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed


def lettering(name, n):
    """Texts of a sheet and the heights of their capitals."""
    sheet = composed(Project(read(name)), n)
    runs = [[m for m in sheet.drawing.marks[g.first:g.end] if isinstance(m, Text)] for g in sheet.groups if g.kind == "lettering"]
    return [("".join(m.text for m in of), max(m.height for m in of), of[0].of) for of in runs if of]


@pytest.mark.parametrize(("name", "n"), [("transport/compressor@09-В-5", 1), ("lugansk/shaper", 1), ("screen", 2)])
def test_the_equation_of_a_force_plan_and_its_values_are_of_one_height(name, n):
    found = {}
    for text, height, of in lettering(name, n):
        if of.startswith("force-") and (text.endswith(" = 0") or (text.startswith("F") and text.endswith(" Н"))):
            found.setdefault(of, set()).add(height)
    assert len(found) > 1
    assert all(len(heights) == 1 for heights in found.values()), found


def test_the_captions_of_the_velocity_plans_are_of_one_height():
    """Two of the pump's plans are upright lines, their places narrow."""
    heights = {height for text, height, _ in lettering("tests/projects/pump.toml", 1) if text.startswith("Положение ")}
    assert len(heights) == 1


@pytest.mark.parametrize("width", [200.0, 50.0, 36.0, 20.0])
def test_a_scale_factor_is_no_larger_than_its_title(width):
    canvas = Canvas()
    canvas.title(Box(0.0, 0.0, width, 100.0), "Acceleration polygon (position 8)", "μ_a = 2 mm")
    title, *_, factor = (m for m in canvas.marks if isinstance(m, Text) and m.height >= 2.5)
    assert factor.height <= title.height
