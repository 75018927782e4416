"""What a sheet cannot show at a readable size is told; many Assur groups have a sheet of their own."""

from types import SimpleNamespace

import pytest

from tests import project_files
from tests.evenness import MOST
from tmm_sheets import api
from tmm_sheets.catalogue import read
from tmm_sheets.drawing import ink_index
from tmm_sheets.drawing.marks import Box
from tmm_sheets.output import with_room
from tmm_sheets.project import Project
from tmm_sheets.sheets import composition
from tmm_sheets.sheets.composition import arranged
from tmm_sheets.sheets.linkage.kinetics import each_group
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import ViewPlace

CHAIN = "tests/sheets/chain.toml"


def on_sheets(*names):
    return project_files.project(project_files.from_file(CHAIN), {"project.sheets": list(names)})


def test_four_groups_beside_the_kinematics_are_told_to_be_too_small(monkeypatch):
    project = on_sheets("kinematics_forces_wide", "flywheel")
    letters, vectors = map(str, composition.crowded(project, [1]))
    assert "14 of its letters" in letters
    assert "60 mm" in vectors
    assert 'sheets = ["kinematics", "forces", "flywheel"]' in vectors
    monkeypatch.setattr(composition, "APART", 3 * composition.APART)  # a reader who asks for more room round each force
    assert [said for said in map(str, composition.crowded(project, [1])) if "group 2–3" in said and "forces on it: 9" in said]


def test_a_sheet_more_is_advised_only_where_it_helps():
    (said,) = map(str, composition.crowded(Project(read("lugansk/engine")), [1]))
    assert "the longest vector is 33.9 mm" in said
    assert "sheets =" not in said


def test_four_groups_call_for_a_sheet_of_their_own_and_can_be_read_there():
    project = Project(read(CHAIN))
    assert project.sheets == ("kinematics", "forces", "flywheel")
    assert not list(composition.crowded(project, [2, 3]))
    sheet = composed(project, 2)
    assert not sheet.leaving
    assert not sheet.crowded
    assert ink_index.empty_cells(sheet.drawing) < MOST
    lefts = {view.box.x0 for view in arranged(project, 2).views if view.draw == "kinetics.group"}
    assert len(lefts) == 2


def test_an_acceleration_plan_with_too_many_letters_together_is_told():
    (said,) = map(str, composition.crowded(Project(read(CHAIN)), [1]))
    assert "14" in said
    assert "force_position" in said


ROCKER = {"follower": "oscillating roller", "arm": "200 mm", "swing": "8 deg", "upper_dwell": "180 deg", "rotation": "opposite",
          "pressure_angle": "45 deg", "closure": "geometric"}  # fmt: skip
GEAR = {"module": "2 mm", "pressure_angle": "20 deg", "shift": "rule"}


@pytest.mark.parametrize(("tables", "told"), [
    ({"cam": {**ROCKER, "swing": "30 deg", "law": "sine", "rise": "80 deg", "fall": "70 deg"}}, ()),
    ({"cam": {**ROCKER, "law": "linearly decreasing", "rise": "30 deg", "fall": "25 deg", "parts": 6}},
     ("the graph of ψ is 56 mm", "the graph of D(ψ) is 3")),
    ({"gear": {**GEAR, "teeth": [20, 40]}}, ()),
    ({"gear": {**GEAR, "teeth": [17, 150]}}, ("the tooth of the mesh",)),
])
def test_sheets_without_a_mechanism_tell_what_is_too_low_on_them(tables, told):
    said = api.new(**tables).check()
    assert len(said) == len(told)
    assert all(part in line for line, part in zip(said, told, strict=True))


def test_fewer_groups_stay_beside_the_kinematics_if_their_plans_have_room():
    three = project_files.project(project_files.from_file("tests/projects/planer.toml"), {"project.sheets": None})
    assert three.sheets[0] == "kinematics_forces_wide"
    told = list(composition.crowded(three, [1]))
    assert all("names" in remark.values for remark in told)  # nothing but what another sheet helps
    apart = Project(with_room(three.variant))
    assert apart.sheets[:2] == (("kinematics", "forces") if told else three.sheets[:2])
    assert not list(composition.crowded(apart, [1, 2]))


@pytest.mark.parametrize(("count", "columns", "corners"), [
    (0, 2, []),
    (1, 1, [(0, 60)]),
    (2, 1, [(0, 60), (0, 30)]),
    (3, 2, [(0, 60), (0, 30), (50, 60)]),
    (4, 2, [(0, 60), (0, 30), (50, 60), (50, 30)]),
])  # fmt: skip
def test_groups_stand_down_each_column_in_turn(count, columns, corners):
    project = SimpleNamespace(mechanism=SimpleNamespace(groups=range(count)))
    places = [view.box for view in each_group(project, ViewPlace("kinetics.groups", Box(0, 0, 100, 60), {"columns": columns}))]
    assert [(place.x0, place.y1) for place in places] == corners
    assert all(Box(0, 0, 100, 60).contains(complex(place.x1, place.y0)) for place in places)
