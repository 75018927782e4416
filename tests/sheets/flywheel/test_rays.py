"""Every ray of the graphical integration has its name, alone or in a range, however close they are."""

import re

import pytest

from tests.few import seldom
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.flywheel import flywheel


@pytest.mark.parametrize("name", ["sixbar/9:1", "loom", seldom("press"), seldom("lugansk/engine")])
def test_every_ray_is_named(name):
    project, canvas, box = Project(read(name)), Canvas(), Box(0.0, 0.0, 500.0, 250.0)
    canvas.begin(box, "", "flywheel.moments")
    flywheel.moments(project, canvas, box, {"axis": 100.0})
    fw = project.flywheel
    every = [f"{n}{fw.mark}" for n in fw.intervals]
    said = [mark.text for mark in canvas.marks if isinstance(mark, Text)] + [label.text for label in canvas.labels]
    named = set()
    for text in (text for text in said if fw.mark in text):
        for first, last in re.findall(rf"(\w+{fw.mark})(?:–(\w+{fw.mark}))?", text):
            if first in every:
                named |= set(every[every.index(first):every.index(last or first) + 1])
    drawn = {n for n in every if abs(fw.work_plan[f"m{n.removesuffix(fw.mark)}"].value.imag) > 0.05}
    assert named >= drawn
