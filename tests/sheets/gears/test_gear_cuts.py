"""Wheels at the edges of the engagement picture: the scale where both would be cut, and how circles without a radius are named."""

import pytest

from tests import project_files as files
from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.sheets.gears import gear_picture
from tmm_sheets.sheets.sheet import composed


def pair(teeth, module):
    return files.project({**files.GEAR, "gear.teeth": teeth, "gear.module": module}).gear


@pytest.mark.parametrize(("teeth", "module", "width", "height", "scale"), [
    ([12, 14], "6 mm", 393, 565, 2.5),  # both would be cut at 4:1, both are whole at 2.5:1 with teeth of 33 mm
    ([14, 28], "3.5 mm", 393, 565, 4.0),  # only wheel 2 is cut
    ([11, 11], "9 mm", 224, 428, 2.0),  # both are cut, but at 1:1 teeth would be 19 mm high
    ([12, 14], "3 mm", 200, 330, 5.0),  # at 2.5:1 16 mm
])
def test_the_scale_where_both_wheels_would_be_cut(teeth, module, width, height, scale):
    mu, broken = gear_picture.picture(pair(teeth, module), width, height)
    assert (1e-3 / mu.mu, broken) == (pytest.approx(scale), gear_picture.WHOLE)


@pytest.mark.parametrize(("teeth", "module", "size", "drawn"), [
    ([14, 60], "6 mm", (352, 379), (2.5, {1, 2})),  # at 1:1 teeth would be 13,5 mm high, the lettering of the mesh upon itself
    ([14, 39], "6 mm", (252, 379), (2.5, {1, 2})),  # with wheel 1 whole they would be 27 mm
    ([12, 40], "4 mm", (300, 459), (4.0, {2})),  # with wheel 1 whole 36
    ([41, 60], "12 mm", (376, 562), (1.0, {1, 2})),  # no room for the feet of the line of action at 2:1: 27 mm are the most
])
def test_low_teeth_break_the_greater_wheel_or_both(teeth, module, size, drawn):
    mu, broken = gear_picture.picture(pair(teeth, module), *size)
    assert (1e-3 / mu.mu, broken) == drawn


def test_the_place_is_made_wide_enough_for_larger_teeth():
    """The tables of the reducer asked for a wider column: what is fixed in it would have moved, and all boxes stayed as written."""
    own = files.project({**files.HEAD, "project.sheets": ["gear_reducer"], "gear": {
        "teeth": "reducer", "shift": "rule", "pressure_angle": "20 deg"}, "reducer": {
        "scheme": "single row", "simple": "after", "driver": "ring", "input_speed": "960 rpm", "ratio": 4, "teeth": {"z4": 14},
        "module": "4 mm", "simple_module": "6 mm", "satellites": 4, "least_teeth": 13}})
    sheet = composed(own, 1)
    assert 1e-3 / sheet.scales["gear-engagement"].mu == pytest.approx(2.5)
    assert (sheet.leaving, sheet.crowded) == ((), ())


def test_circles_are_named_with_their_values_inside_the_picture():
    """A wheel of 85 teeth broken between mesh and centre: its radii have no room, their circles have names and values."""
    own = files.project({**files.GEAR, "project.sheets": ["gear"], "gear.teeth": [10, 85], "gear.module": "2.5 mm",
                         "gear.shift": [0.45, 0.3]})
    sheet = composed(own, 1)
    named = {"r_{a2} = 109,40", "r_{w2} = 107,84", "r_2 = 106,25", "r_{b2} = 99,84", "r_{f2} = 103,88"}
    assert named <= {group.text for group in sheet.groups}
    assert sheet.leaving == ()


@pytest.mark.parametrize("cipher", ["09-ЭПС-695", "24-ЭПС-651"])
def test_names_with_values_keep_inside_the_picture_beside_its_edge(cipher):
    """Arcs cut by the left edge: a name as long as r_{a2} = 109,40 stood 20 mm beyond it."""
    sheet = composed(Project(catalogue.read(f"transport/press@{cipher}")), 3)
    assert (sheet.leaving, sheet.crowded) == ((), ())
