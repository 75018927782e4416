"""[reducer] and what it gives to [gear]: good files are read and built, bad ones answered with line and field."""

import pytest

from tests.project_files import REDUCER, merged, project, read
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.results import assemble
from tmm_sheets.sheets.sheet import composed

FILE = merged(REDUCER, {"gear": {"teeth": "reducer", "shift": "rule", "pressure_angle": "20 deg", "profile": "rack"}})


def test_file_is_read_and_built():
    p = project(FILE)
    assert p.parts == ("gear", "reducer")
    tree = assemble(p, None)
    assert tree["reducer"]["teeth"] == {"z1": 15, "z2": 30, "z3": 15, "z4": 60, "z5": 12, "z6": 20}
    assert (tree["gear"]["z1"], tree["gear"]["z2"], tree["gear"]["m"]) == (12, 20, 12.0)
    assert tree["gear"]["x1"] == pytest.approx(0.29813, abs=5e-6)
    assert tree["reducer"]["speeds_rpm"]["nH"] == pytest.approx(3000 / 9, rel=1e-13)
    assert composed(p, 1).crowded == ()
    p.check()


def test_ratio_instead_of_the_output_speed():
    assert project(FILE, {"reducer.output_speed": None, "reducer.ratio": 15}).reducer.chosen == project(FILE).reducer.chosen


@pytest.mark.parametrize(("changes", "field", "message"), [
    ({"reducer.scheme": "two extrenal"}, "reducer.scheme", "expected"),
    ({"reducer.simple": None}, "reducer.simple", "missing"),
    ({"reducer.stages": 2}, "reducer", "stages = 2 goes with"),
    ({"reducer.driver": "ring"}, "reducer", "is driven by the sun"),
    ({"reducer.satellites": 1}, "reducer.satellites", "expected a whole number, 2 or more"),
    ({"reducer.ratio": 5}, "reducer", "expected either ratio or output_speed"),
    ({"reducer.simple_ratio": [4, 1.5]}, "reducer", "simple_ratio that rises"),
    ({"reducer.output_speed": "200 mm"}, "reducer.output_speed", "unit of length"),
    ({"reducer.teeth.z5": 2}, "reducer.teeth.z5", "expected a whole number, 4 or more, not 2"),
    ({"reducer.module": "-6 mm"}, "reducer.module", "greater than zero"),
    ({"gear.shift": "role"}, "gear.shift", "expected shifts"),
    ({"gear.teeth": "reducers"}, "gear.teeth", "expected tooth numbers"),
    ({"gear.teeth": [12, 20]}, "gear", 'expected "module" too'),
    ({"gear.module": "5 mm"}, "gear", "takes module from [reducer]"),
])
def test_bad_sections_are_answered(changes, field, message):
    with pytest.raises(BadInput) as e:
        read(FILE, changes)
    assert any(p.field == field and message in p.message for p in e.value.problems), str(e.value)
    assert all(p.line for p in e.value.problems)


def test_teeth_from_a_reducer_that_is_not_there():
    with pytest.raises(CannotBuild, match=r"the project has no \[reducer\]"):
        _ = project({"gear": FILE["gear"]}).gear


def test_unknown_wheel_is_named():
    with pytest.raises(CannotBuild, match="teeth has z7; here are z1, z2, z3, z4, z5, z6"):
        _ = project(FILE, {"reducer.teeth.z7": 20}).reducer


ALONE = {"reducer": {"scheme": "single row", "simple": "none", "input_speed": "1450 rpm", "output_speed": "250 rpm", "module": "3 "
                                                                                                                               "mm",
                     "satellites": 3}}


@pytest.mark.parametrize(("changes", "ratio"), [
    ({}, 1450 / 250), ({"reducer.driver": "ring", "reducer.output_speed": "1000 rpm"}, 1.45)])
def test_reducer_without_a_simple_stage(changes, ratio):
    """The least of all rows within 1 %: by trying every sun and satellite, with the conditions of manual 003 written out."""
    made = project(ALONE, changes).reducer
    ring = "reducer.driver" in changes
    sets = [(z1 + 2 * z2, z1, z2) for z1 in range(15, 91) for z2 in range(15, 91)
            if abs((1 + (z1 / (z1 + 2 * z2) if ring else (z1 + 2 * z2) / z1)) / ratio - 1) <= 0.01 and (2 * z1 + 2 * z2) % 3 == 0
            and (z1 + z2) * 3**0.5 / 2 > z2 + 2]
    least = min(sets)[0]
    one, two, _, four = made.chosen.stage
    assert (four, one, two) in sets
    assert four == least
    tree = made.results()
    assert "ratio_simple" not in tree
    assert tree["speeds_rpm"]["nH"].value == pytest.approx(1450 / tree["ratio"].value, rel=1e-12)
    assert made.names == ("1", "2", "3", "H")
    assert made.speeds(0.05)["nH"].value == pytest.approx(tree["speeds_rpm"]["nH"].value, rel=1e-9)


@pytest.mark.parametrize(("changes", "message"), [
    ({"reducer.simple_module": "5 mm"}, 'simple = "none" has no simple_module'),
    ({"reducer.simple": "after"}, 'expected "simple_module" too'),
])
def test_keys_of_the_simple_stage(changes, message):
    with pytest.raises(BadInput, match=message):
        read(ALONE, changes)


@pytest.mark.parametrize(("changes", "message"), [
    ({"reducer.output_speed": "1400 rpm"}, "no tooth set|no tooth set meets"), ({"reducer.teeth": {"z4": 20}}, "teeth has z4; "
                                                                                                               "here are z1, z2, "
                                                                                                               "z3"),
    ({"gear": {"teeth": "reducer", "pressure_angle": "20 deg"}}, "the reducer has no simple stage"),
])
def test_reducer_without_a_simple_stage_that_cannot_be(changes, message):
    p = project(ALONE, changes)
    with pytest.raises(CannotBuild, match=message):
        _ = p.gear if "gear" in changes else p.reducer
