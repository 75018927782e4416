"""The analysed velocity plan is shown enlarged where all plans of its row are small, and nowhere else."""

from types import SimpleNamespace

import pytest

from tmm_sheets.catalogue import read
from tmm_sheets.drawing.marks import PlacedFrame
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import kinematics


@pytest.fixture(scope="module")
def visor():
    return Project(read("tests/projects/visor.toml"))


@pytest.mark.parametrize(("mu", "drawn", "places"), [(0.015, True, True), (0.002, True, False), (0.015, False, False)],
                         ids=["small", "large", "not drawn"])
def test_only_a_small_plan_that_is_drawn_asks_for_a_place(visor, mu, drawn, places):
    label = visor.cycle.labels[visor.force_index]
    frames = [PlacedFrame(0, "velocities", at, 0j, (mu, mu), 0.0, False) for at in visor.cycle.labels if drawn or at != label]
    assert bool(kinematics.enlarged_velocities_sizes(visor, SimpleNamespace(frames=frames), {})) == places
