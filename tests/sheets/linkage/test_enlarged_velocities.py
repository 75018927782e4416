"""The analysed velocity plan is shown enlarged where the plan of a position near a dead one leaves it small, and nowhere else."""

from types import SimpleNamespace

import pytest

from tmm_sheets.catalogue import read
from tmm_sheets.construction.scale import Scale
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import kinematic_frames, kinematics
from tmm_sheets.sheets.sheet import composed

VIEW = "kinematics.enlarged_velocities"


@pytest.fixture(scope="module")
def visor():
    return Project(read("tests/projects/visor.toml"))


def test_the_small_plan_of_the_visor_is_enlarged(visor):
    sheet = composed(visor, 2)
    assert VIEW in {part.draw for part in sheet.parts}
    assert not sheet.leaving
    mu = [frame.mu[1] for frame in sheet.frames if frame.plan == visor.study.velocities.plan.name
          and frame.position == visor.cycle.labels[visor.force_index]]
    plain, larger = max(mu), min(mu)
    assert plain / larger in kinematics.ENLARGED
    real = kinematic_frames.plan_extent(visor.study.velocities.plan, visor.force_index)
    size = max(real.width, real.height)
    assert size / plain < kinematics.SMALL
    assert 2 * kinematics.SMALL <= size / larger <= kinematic_frames.LONGEST


@pytest.mark.parametrize(("mu", "drawn", "places"), [(0.015, True, True), (0.002, True, False), (0.015, False, False)],
                         ids=["small", "large", "not drawn"])
def test_only_a_small_plan_that_is_drawn_asks_for_a_place(visor, mu, drawn, places):
    label = visor.cycle.labels[visor.force_index]
    canvas = SimpleNamespace(scales={"velocities": Scale("μ_V", mu, "")},
                             marks=[SimpleNamespace(of=f"velocity plan {label}")] if drawn else [])
    assert bool(kinematics.enlarged_velocities_sizes(visor, canvas, {})) == places
