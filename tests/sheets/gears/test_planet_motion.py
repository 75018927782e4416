"""Room left beside trains and reducers: what stands there is true, and follows from teeth and speeds alone."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from tests.project_files import project
from tmm_sheets.catalogue import read
from tmm_sheets.methods.gears.train import Train
from tmm_sheets.methods.gears.train_steps import Mesh
from tmm_sheets.project import Project
from tmm_sheets.sheets.gears import train as train_views, train_scheme
from tmm_sheets.sheets.sheet import composed


def mesh(central, planet, sign, carrier="H"):
    return Mesh(central, planet, carrier, sign)


def train(meshes, teeth, speeds, satellites=3):
    plan = {f"n{name}": SimpleNamespace(value=n) for name, n in speeds.items()}
    made = Train.__new__(Train)
    together = {m.planet: meshes[0].planet for m in meshes if m.carrier}
    made.__dict__.update(meshes=tuple(meshes), data=SimpleNamespace(teeth=teeth, satellites=satellites, module=0.002, addendum=1.0),
                         shafts=together, kinematics=plan)
    return made


ROW = [mesh("1", "2", 1), mesh("3", "2", -1)]
TEETH = {"1": 24, "2": 45, "3": 114}


@pytest.mark.parametrize(("meshes", "teeth", "satellites", "said"), [
    ([mesh("1", "2", 1, "")], {"1": 20, "2": 40}, 3, []),  # no carrier
    (ROW[:1], TEETH, 3, ["69·sin(180°/3) = 59,76 > 47"]),  # one mesh
    (ROW, TEETH, 3, ["24 + 45 = 114 − 45 = 69", "(24 + 114)/3 = 46", "= 59,76 > 47"]),
    (ROW, TEETH, 1, ["24 + 45 = 114 − 45 = 69"]),  # one planet has no neighbour
    (ROW, TEETH, 5, ["= 69", "= 27,6 (не целое", "= 40,56 < 47"]),  # neither fit in nor clear
    ([ROW[0], mesh("3", "2", 1)], {"1": 24, "2": 45, "3": 25}, 3, ["≈", "(24 − 25)/3 = −0,3333 (не", "> 47"]),  # shifted
    ([ROW[0], mesh("4", "3", -1)], {"1": 24, "2": 45, "3": 20, "4": 89}, 3,  # a block of two planets
     ["24 + 45 = 89 − 20 = 69", "(24·20 + 45·89)/(3·НОД(45; 20)) = 299", "> 47"]),
])  # fmt: skip
def test_conditions_of_planets(meshes, teeth, satellites, said):
    made = train(meshes, teeth, {}, satellites)
    lines = list(train_views.checks_of(made, *made.stages))
    assert all(any(part in line for line in lines) for part in said), lines
    assert bool(lines) is bool(said)


@pytest.mark.parametrize(("meshes", "teeth", "wanted", "drawn"), [
    (ROW[:1], TEETH, 3, 3),  # one mesh asks for nothing
    (ROW, TEETH, 3, 3), (ROW, TEETH, 1, 1), (ROW, TEETH, 5, 3),  # 138 parts: 3, not 5 or 4
    ([ROW[0], mesh("3", "2", 1)], {"1": 100, "2": 20, "3": 101}, 3, 1),  # Ferguson's
])  # fmt: skip
def test_planets_are_drawn_where_they_can_be_put_in(meshes, teeth, wanted, drawn):
    made = train(meshes, teeth, {}, wanted)
    assert train_scheme.at_equal_angles(made, made.stages[0]) == drawn


@pytest.mark.parametrize(("meshes", "speeds", "count"), [
    (ROW[:1], {"1": 1000.0, "H": 0.0}, 0),  # no two central wheels
    (ROW, {"1": 1450.0, "3": 0.0, "H": 1450 * 24 / 138}, 2),
    (ROW, {"1": 950.0, "3": -200.0, "H": 0.0}, 2),  # the carrier stands
    (ROW, {"1": 500.0, "3": 500.0, "H": 500.0}, 0),  # all turn as one
    ([ROW[0], mesh("3", "2", -1, "H2")], {"1": 1.0, "3": 2.0, "H": 0.0, "H2": 0.0}, 0),  # on other carriers
])  # fmt: skip
def test_ratios_by_speeds_and_by_teeth_agree(meshes, speeds, count):
    lines = list(train_views.ratio_steps(train(meshes, TEETH, speeds)))
    assert len(lines) == count
    assert len({line.rsplit(" = ", 1)[1] for line in lines}) <= 1


@pytest.mark.parametrize("satellites", [1, 2, 3])
def test_planets_all_round_stay_in_their_place(satellites):
    """The planet opposite the first one reaches as far below the axis as the first above it."""
    own = project({"project.sheets": ["train"], "train": {
        "module": "2 mm", "teeth": {"1": 21, "2": 33, "3": 17, "4": 71}, "speeds": {"1": "900 rpm", "4": "0 rpm"},
        "shafts": [["2", "3"]], "satellites": satellites,
        "mesh": [{"sun": "1", "planet": "2", "carrier": "H"}, {"ring": "4", "planet": "3", "carrier": "H"}]}})
    assert composed(own, 1).leaving == ()


@pytest.mark.parametrize(("name", "rows"), [("tests/projects/ferguson.toml", 4), ("tests/projects/hoist.toml", 3),
                                            ("tests/projects/winder.toml", 3)])
def test_relative_speeds_are_as_the_teeth_demand(name, rows):
    """Who turns with the carrier sees an ordinary train: the speeds of two wheels in mesh are as their teeth, inverted."""
    project = Project(read(name))
    own = project.train if project.variant.train is not None else project.reducer
    found = {name: n - h for _, name, n, h in train_views.inverted_speeds(own)}
    assert len(found) == rows
    teeth = own.data.teeth
    for central, planet in [(m.central, m.planet) for m in own.meshes if m.carrier]:
        assert np.isclose(abs(found[central] * teeth[central]), abs(found[planet] * teeth[planet]), rtol=1e-9)
    for line in train_views.ratio_steps(own):
        assert re.search(r"= −?[\d,]+$", line)
