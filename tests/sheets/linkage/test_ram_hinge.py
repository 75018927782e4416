"""A rod that hangs on the ram of a group of kind 5 hangs on a hinge, and the hinge is drawn; a ram without a rod has none."""

import pytest

from tests import project_files as files
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.marks import Arc
from tmm_sheets.project import Project
from tmm_sheets.sheets import composing
from tmm_sheets.sheets.linkage import kinematic_frames, link_marks
from tmm_sheets.sheets.sheet import composed

YOKE = """
schema = 1

[project]
name = "yoke"
title = "Кулисный механизм"
sheets = ["kinematics_forces_wide"]

[crank]
link = "1"
pivot = "O"
pin = "A"
length = "60 mm"
speed = "120 rpm"
sense = "clockwise"

[points]
O = ["0 mm", "0 mm"]
H = ["360 mm", "-120 mm"]

[[guide]]
name = "bed"
through = ["0 mm", "-20 mm"]

[[group]]
kind = 5
links = ["2", "3"]
outer = ["A"]
guide = "bed"
slot = "75 deg"
inner = "B"
{rod}
[[link]]
name = "3"
mass = "7 kg"
centre = "B"

[cycle]
start = "30 deg"
positions = 12
force_position = "7"

[[force]]
name = "F3"
link = "3"
point = "B"
direction = "180 deg"
value = "100 N"

[balancing]
kind = "moment"
name = "Mд"
"""
ROD = """
[[group]]
kind = 1
links = ["4", "5"]
outer = ["B", "H"]
inner = "E"
lengths = ["330 mm", "200 mm"]
"""


@pytest.mark.parametrize(("rod", "hinged"), [(ROD, True), ("", False)])
def test_a_ram_has_a_hinge_where_a_rod_hangs_on_it(tmp_path, rod, hinged):
    path = tmp_path / "yoke.toml"
    path.write_text(YOKE.replace("{rod}", rod), encoding="utf-8")
    project = Project(read(str(path)))
    step = project.study.positions.points["B"]
    circles = [m for m in composing.viewed(project, 1)[1].marks
               if isinstance(m, Arc) and m.style == "main" and m.by is not None and m.by.step == step.path]
    assert bool(circles) is hinged


def test_a_ram_on_an_upright_guide_has_room_for_its_body():
    """In its lowest position it stood over the title of the view below."""
    project = files.project(files.from_file("sixbar/10:3"), {"cycle.force_position": "12", "project.sheets": ["sixbar_1"]})
    points, offsets = kinematic_frames.positions_reach(project)
    ram = complex(project.study.positions.points["B5"].at(project.force_index))
    assert min(d.imag for z, d in zip(points, offsets, strict=True) if abs(z.imag - ram.imag) < 1e-9) <= -link_marks.RAM
    assert not composed(project, 1).leaving
