"""The tables beside the velocity plans: whoever measures the segments told finds all the speeds told."""

from functools import cache

import numpy as np
import pytest

from tests.few import seldom
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Line, Text
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets import composing
from tmm_sheets.sheets.linkage import given_position


@cache
def tables(name):
    """A project, titles and columns of the tables of its sheet 1, and its scale factor of velocities."""
    found, project = [], Project(read(name))
    original = given_position.table_over_positions

    def keeping(project, canvas, place, title, columns, decimals, **way):
        found.append((title, dict(columns)))
        original(project, canvas, place, title, columns, decimals, **way)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(given_position, "table_over_positions", keeping)
        _, canvas, _ = composing.viewed(project, 1)
    return project, found, canvas.scales["velocities"].mu


@pytest.mark.parametrize("name", [seldom("screen"), seldom("loom"), "lugansk/engine", seldom("tests/projects/conveyor.toml")])
def test_every_speed_has_its_segment(name):
    project, ((_, lengths), (_, speeds)), mu = tables(name)
    for sign, values in speeds.items():
        if sign.startswith("ω"):
            q, b = project.study.velocities.reference[sign.removeprefix("ω_")][:2]
            arm = abs(project.study.positions.points[b].at(0) - project.study.positions.points[q].at(0))
            values = np.abs(values) * arm
        assert any(np.allclose(values, length * mu, atol=1e-9) for length in lengths.values()), sign


def test_what_does_not_change_is_told_once():
    project, ((title, lengths), _), mu = tables("screen")
    speed = abs(project.study.velocities.points["B"].at(0))
    assert f"|pb| = {speed / mu:.1f}".replace(".", ",") in title
    assert "|pb|" not in lengths


def drawn(columns, place, lying):
    """Canvas with the table of some columns in a place, and the rectangles of its cells' texts by columns of lines."""
    project = Project(read("screen"))
    canvas = Canvas()
    canvas.begin(place, "", "kinematics.velocity_tables")
    values = np.linspace(-99.0, 99.0, len(project.cycle.labels))
    table = [(f"ω_{{{n}}}", values) for n in range(columns)]
    given_position.table_over_positions(project, canvas, place, "velocities", table, 3, lying=lying)
    return project, canvas


@pytest.mark.parametrize(("columns", "shown"), [(1, 1), (14, 14), (26, 26), (27, 27), (40, 27)])
def test_a_table_that_lies_down_has_all_its_numbers_in_their_cells_or_names_what_it_lacks(columns, shown):
    place = Box(100.0, 100.0, 300.0, 220.0)
    project, canvas = drawn(columns, place, lying=True)
    rules = sorted({mark.a.real for mark in canvas.marks if isinstance(mark, Line) and mark.a.real == mark.b.real})
    assert len(rules) == len(project.cycle.drawn) + 2
    for mark in canvas.marks:
        if isinstance(mark, Text) and mark.at.imag < place.y1 - 9.0:
            x = text_box(mark).real
            assert np.searchsorted(rules, x.min()) == np.searchsorted(rules, x.max()), mark.text
    assert len({mark.a.imag for mark in canvas.marks if isinstance(mark, Line) and mark.a.imag == mark.b.imag}) == shown + 2
    said = "".join(note.text for note in canvas.notes)
    assert [f"ω_{{{n}}}" in said for n in range(columns)] == [n >= shown for n in range(columns)]


@pytest.mark.parametrize("name", ["screen", seldom("lugansk/shaper")])
def test_angular_velocities_have_the_sign_that_they_have_elsewhere(name):
    project, (_, (_, speeds)), _ = tables(name)
    turning = {sign.removeprefix("ω_"): values for sign, values in speeds.items() if sign.startswith("ω_")}
    assert turning
    for link, values in turning.items():
        assert np.allclose(values, project.study.velocities.omega[link].value)
    assert any(np.min(values) < 0 < np.max(values) for values in turning.values())


@pytest.mark.parametrize(("height", "positions", "columns", "folds"), [
    (90.0, 12, (2, 2), 2), (90.0, 12, (7, 7), 1), (130.0, 12, (2, 2), 1), (90.0, 24, (3, 4), 2), (90.0, 4, (1, 0), 1)])
def test_rows_too_low_for_their_letters_go_on_beside_each_other(height, positions, columns, folds):
    assert given_position.table_folds(Box(20.0, 0.0, 430.0, height), positions, *columns) == folds


@pytest.mark.parametrize("folds", [1, 2])
def test_a_folded_table_has_every_position_once(folds):
    project, canvas = Project(read("screen")), Canvas()
    place = Box(100.0, 100.0, 300.0, 220.0)
    canvas.begin(place, "", "kinematics.velocity_tables")
    values = np.arange(100.0, 100.0 + len(project.cycle.labels))
    given_position.table_over_positions(project, canvas, place, "velocities", [("v", values)], 1, folds=folds)
    written = [mark.text for mark in canvas.marks if isinstance(mark, Text)]
    assert sorted(text for text in written if text.startswith("1") and "," in text) == [
        f"{values[i]:.1f}".replace(".", ",") for i, _ in project.cycle.drawn]
    assert written.count("№") == folds
