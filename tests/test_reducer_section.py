"""[reducer] and what it gives to [gear]: good files are read and built, bad ones answered with line and field."""

import pytest

from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.results import assemble
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task import variant

FILE = """\
schema = 1
[project]
name = "own/reducer"
title = "Редуктор"
sheets = ["gear_reducer"]
[gear]
teeth = "reducer"
shift = "rule"
pressure_angle = "20 deg"
profile = "rack"
[reducer]
scheme = "external-internal"
simple = "after"
input_speed = "3000 rpm"
output_speed = "200 rpm"
teeth = { z5 = 12 }
module = "6 mm"
simple_module = "12 mm"
satellites = 3
"""


def read(old="", new=""):
    assert old in FILE
    return variant.parse(FILE.replace(old, new), "own.toml")


def test_file_is_read_and_built():
    project = Project(read())
    assert project.parts == ("gear", "reducer")
    tree = assemble(project, None)
    assert tree["reducer"]["teeth"] == {"z1": 15, "z2": 30, "z3": 15, "z4": 60, "z5": 12, "z6": 20}
    assert (tree["gear"]["z1"], tree["gear"]["z2"], tree["gear"]["m"]) == (12, 20, 12.0)
    assert tree["gear"]["x1"] == pytest.approx(0.29813, abs=5e-6)
    assert tree["reducer"]["speeds_rpm"]["nH"] == pytest.approx(3000 / 9, rel=1e-13)
    assert composed(project, 1).crowded == ()
    project.check()


def test_ratio_instead_of_the_output_speed():
    assert Project(read('output_speed = "200 rpm"', "ratio = 15")).reducer.chosen == Project(read()).reducer.chosen


@pytest.mark.parametrize(("old", "new", "field", "message"), [
    ('scheme = "external-internal"', 'scheme = "two extrenal"', "reducer.scheme", "expected"),
    ('simple = "after"', "", "reducer.simple", "missing"),
    ('simple = "after"', 'simple = "after"\nstages = 2', "reducer", "stages = 2 goes with"),
    ('simple = "after"', 'simple = "after"\ndriver = "ring"', "reducer", "is driven by the sun"),
    ("satellites = 3", "satellites = 1", "reducer.satellites", "expected a whole number, 2 or more"),
    ("satellites = 3", "satellites = 3\nratio = 5", "reducer", "expected either ratio or output_speed"),
    ("satellites = 3", "satellites = 3\nsimple_ratio = [4, 1.5]", "reducer", "simple_ratio that rises"),
    ('output_speed = "200 rpm"', 'output_speed = "200 mm"', "reducer.output_speed", "unit of length"),
    ("z5 = 12", "z5 = 2", "reducer.teeth.z5", "expected a whole number, 4 or more, not 2"),
    ('module = "6 mm"', 'module = "-6 mm"', "reducer.module", "greater than zero"),
    ('shift = "rule"', 'shift = "role"', "gear.shift", "expected shifts"),
    ('teeth = "reducer"', 'teeth = "reducers"', "gear.teeth", "expected tooth numbers"),
    ('teeth = "reducer"', "teeth = [12, 20]", "gear", 'expected "module" too'),
    ('teeth = "reducer"', 'teeth = "reducer"\nmodule = "5 mm"', "gear", "takes module from [reducer]"),
])
def test_bad_sections_are_answered(old, new, field, message):
    with pytest.raises(BadInput) as e:
        read(old, new)
    assert any(p.field == field and message in p.message for p in e.value.problems), str(e.value)
    assert all(p.line for p in e.value.problems)


def test_teeth_from_a_reducer_that_is_not_there():
    text = FILE[: FILE.index("[reducer]")]
    with pytest.raises(CannotBuild, match=r"the project has no \[reducer\]"):
        _ = Project(variant.parse(text, "own.toml")).gear


def test_unknown_wheel_is_named():
    with pytest.raises(CannotBuild, match="teeth has z7; here are z1, z2, z3, z4, z5, z6"):
        _ = Project(read("{ z5 = 12 }", "{ z5 = 12, z7 = 20 }")).reducer
