"""The tables beside the velocity plans: whoever measures the segments told finds all the speeds told."""

import numpy as np
import pytest

from tmm_sheets.catalogue import read
from tmm_sheets.project import Project
from tmm_sheets.sheets import kinematics
from tmm_sheets.sheets.sheet import composed


def tables(project, monkeypatch):
    """Titles and columns of the tables of sheet 1, and its scale factor of velocities."""
    found = []
    original = kinematics._table_over_positions

    def keeping(project, canvas, place, title, columns, decimals):
        found.append((title, dict(columns)))
        original(project, canvas, place, title, columns, decimals)

    monkeypatch.setattr(kinematics, "_table_over_positions", keeping)
    scales = composed(project, 1).scales
    return found, scales["velocities"].mu


@pytest.mark.parametrize("name", ["screen", "loom", "lugansk/engine", "tests/projects/conveyor.toml"])
def test_every_speed_has_its_segment(name, monkeypatch):
    project = Project(read(name))
    ((_, lengths), (_, speeds)), mu = tables(project, monkeypatch)
    for sign, values in speeds.items():
        if sign.startswith("ω"):
            q, b = project.study.velocities.reference[sign.removeprefix("ω_")][:2]
            arm = abs(project.study.positions.points[b].at(0) - project.study.positions.points[q].at(0))
            values = np.abs(values) * arm
        assert any(np.allclose(values, length * mu, atol=1e-9) for length in lengths.values()), sign


def test_what_does_not_change_is_told_once(monkeypatch):
    project = Project(read("screen"))
    ((title, lengths), _), mu = tables(project, monkeypatch)
    speed = abs(project.study.velocities.points["B"].at(0))
    assert f"|pb| = {speed / mu:.1f}".replace(".", ",") in title
    assert "|pb|" not in lengths


def test_a_narrow_place_has_some_columns_only(monkeypatch):
    ((_, lengths), (_, speeds)), _ = tables(Project(read("lugansk/shaper")), monkeypatch)
    assert len(lengths) >= kinematics.COLUMNS
    assert len(lengths) <= kinematics.COLUMNS or (len(lengths) + len(speeds)) * kinematics.COLUMN <= 377


@pytest.mark.parametrize("name", ["screen", "lugansk/shaper"])
def test_angular_velocities_have_the_sign_that_they_have_elsewhere(name, monkeypatch):
    project = Project(read(name))
    (_, (_, speeds)), _ = tables(project, monkeypatch)
    turning = {sign.removeprefix("ω_"): values for sign, values in speeds.items() if sign.startswith("ω_")}
    assert turning
    for link, values in turning.items():
        assert np.allclose(values, project.study.velocities.omega[link].value)
    assert any(np.min(values) < 0 < np.max(values) for values in turning.values())
