"""Borders of the intervals of graphical integration: where a load begins, where it bends; the curve between their ends."""

import numpy as np
import pytest

from tests import project_files as files
from tmm_sheets.catalogue import read
from tmm_sheets.methods.linkage.loads import corners_of
from tmm_sheets.project import Project

PUSH = [[0, "0 N"], [0.5, "0 N"], [0.6, "3 kN"], [0.9, "10 kN"], [1, "0 N"]]
"""A press: the load begins in the middle of an interval and falls off steeply in the last one."""

BLOW = [[0, "0 N"], [0.88, "0 N"], [0.95, "10 kN"], [1, "0 N"]]


def driven(table):
    load = {"name": "F3", "link": "3", "point": "B", "direction": "against motion", "stroke": "working", "table": table}
    return files.project(files.SLIDER, files.WORKING, {"force": [load]}, files.MASS, files.MOMENT, files.FLYWHEEL).flywheel


@pytest.mark.parametrize(("x", "y", "corners"), [
    ([0, 1], [0, 5], ()),
    ([0, 0.5, 1], [0, 2.5, 5], ()),
    ([0, 0.5, 1], [0, 0, 5], (0.5,)),
    ([0, 0.5, 1], [5, 5, 0], (0.5,)),
    ([0, 0.2, 0.3, 0.9, 1], [0, 0, 6, 20, 0], (0.2, 0.3, 0.9)),
    ([0, 0.5, 0.5, 1], [0, 0, 4, 4], ()),
    (np.linspace(0, 1, 721), np.sin(np.linspace(0, np.pi, 721)), ()),
    ([0], [3], ()),
], ids=["none", "straight", "begins", "ends", "many", "a jump is none", "digitised", "one point"])  # fmt: skip
def test_corners_of_a_load_diagram(x, y, corners):
    assert corners_of((np.array(x, dtype=float), np.array(y, dtype=float))) == corners


def test_the_point_where_a_load_begins_is_a_border():
    flywheel = driven(PUSH)
    force = flywheel.reduced.forces[0].law
    begins = [b for b in flywheel.edges if force(b - 1e-3) == 0 != force(b + 1e-3) and abs(force(b)) < 1e-6]
    assert len(begins) == 1
    assert min(abs(begins[0] - flywheel.reduced.phi)) > 0.01, "between two positions"


def test_a_steep_load_between_few_positions_is_integrated_with_further_ordinates():
    """By six ordinates of the stroke alone its work would be told wrongly; what is left is told on the sheet."""
    flywheel = driven(BLOW)
    assert abs(float(flywheel.total_plan["δA"].value)) < 5
    y = np.asarray(flywheel.reduced.moment(np.asarray(flywheel.reduced.phi) + np.diff(flywheel.reduced.phi, append=2 * np.pi) / 2))
    coarse = float(y @ np.diff(flywheel.reduced.phi, append=2 * np.pi))
    exact = float(flywheel.area_plan["A_Σ"].value)
    assert abs(coarse / exact - 1) > 0.15, "the positions alone do not do"


@pytest.mark.parametrize("table", [
    PUSH, BLOW, [[0, "0 N"], [1, "9 kN"]], [[0, "9 kN"], [0.1, "0 N"], [1, "0 N"]], [[0, "5 kN"], [1, "5 kN"]],
], ids=["begins late", "blow", "grows", "ends early", "constant"])  # fmt: skip
def test_the_work_of_a_resistance_never_grows(table):
    """The smooth curve through the ends of the chords falls where the moment resists, and stands where there is none."""
    curve = driven(table).work_plan["A(φ)"].value
    for a, b in zip(curve.x[:-1], curve.x[1:], strict=True):
        inside = curve(np.linspace(a, b, 200))
        assert np.diff(inside).max() < 1e-9, f"between {a} and {b} mm"


def test_too_few_positions_for_the_work_are_told():
    """Nothing is said of the shaper and the engine, whose ordinates do; of works that nearly cancel the rest is told wrongly."""
    for name in ("lugansk/shaper", "lugansk/engine"):
        flywheel = Project(read(name)).flywheel
        assert flywheel.remarks == ()
        assert abs(flywheel.work_error) < 0.02
    (line,) = driven([[0, "3 kN"], [1, "-2.9 kN"]]).remarks
    assert "-14.5%" in line
    assert "more positions" in line


@pytest.mark.parametrize("load", [{"direction": "90 deg", "value": "100 N"}, {"direction": "180 deg", "value": "100 N"}],
                         ids=["across the motion", "the same both ways"])
def test_where_the_cycle_does_no_work_nothing_is_a_share_of_it(load):
    """What rounding leaves of a moment asks for no further ordinates, and tells no error of a work that is none."""
    force = {"force": [{"name": "F3", "link": "3", "point": "B", **load}]}
    flywheel = files.project(files.SLIDER, files.WORKING, force, files.MASS, files.MOMENT, files.FLYWHEEL).flywheel
    assert len(flywheel.edges) == 13
    assert flywheel.work_error == 0
    assert not any("work of the cycle" in line for line in flywheel.remarks)
