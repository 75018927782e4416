"""Places of the cam's views: the profile to the largest standard scale, graphs that can be read."""

from pathlib import Path

import numpy as np
import pytest

from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.sheets.cams import cam, cam_profile, cam_zone
from tmm_sheets.sheets.composition import arranged

RING = str(Path(__file__).parents[2] / "projects" / "ring.toml")


def places(name):
    """The project's cam with the places of its views."""
    project = Project(catalogue.read(name))
    n = 1 + next(k for k, sheet in enumerate(project.sheets) if sheet.startswith(("cam", "transport_2")))
    traits = project.cam.traits
    return project.cam, {view.draw: view.box for view in arranged(project, n).views
                         if traits.issuperset(view.options.get("when", ())) and traits.isdisjoint(view.options.get("unless", ()))}


@pytest.mark.parametrize(("name", "scale"), [
    (RING, 2.0), ("transport/compressor@11-В-145", 2.0), ("transport/crusher@04-СДМ-222", 4.0), ("lugansk/cam_flat", 2.5)])
def test_the_table_in_a_free_corner_asks_for_no_place_of_its_own(name, scale):
    """It was counted under the figure: rocker cams stood at 1:1 where 2:1 fits."""
    follower, boxes = places(name)
    box = boxes["cam_profile.profile"]
    assert 1e-3 / cam_profile.pictured(follower, box).scale.mu == pytest.approx(scale)


@pytest.mark.parametrize("name", ["lugansk/cam_rocker", "transport/press@06-ЭПС-411", "transport/crusher@11-СДМ-314"])
def test_ordinates_of_the_pressure_angle_stand_apart(name):
    """Drawn over the whole turn they were 2 to 4 mm apart, with half of the graph a level line."""
    follower, boxes = places(name)
    assert cam.ordinates_apart(follower, boxes["cam.pressure"].width) >= cam.NUMBERED


def test_the_graph_of_a_spring_keeps_a_height_that_can_be_read():
    follower, boxes = places("transport/crusher@11-СДМ-314")
    assert len(cam.spring_lines(follower.spring, True)) == cam.SPRING_LINES
    assert cam.spring_height(boxes["cam.spring"].width, boxes["cam.spring"].height) >= 40.0


def test_the_name_of_a_level_stands_where_the_curve_is_farther_off():
    x = np.linspace(0.0, 100.0, 101)
    curve = x + 1j * np.where(x > 60.0, -20.0, 0.0)  # dips below the level -10 beyond 60
    assert cam.clear_of(curve, -10j, -1, 8.0) < 56.0
    assert cam.clear_of(curve, 10j, 1, 8.0) > 90.0


def test_the_zone_of_a_tappet_is_as_high_as_its_numbers_need():
    """Seventeen numbers stood on a curve of 20 mm while the profile, at 1:1 in any case, left its place empty."""
    follower, boxes = places("transport/diesel@26-Т-804")
    box = boxes["cam_zone.of_tappet"]
    assert cam_zone.stroke_in(follower, True, box.width, box.height) == pytest.approx(100 / 3)
