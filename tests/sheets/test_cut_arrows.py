"""Arrows of a loaded scheme are cut where they would leave the group nothing of its place, and nowhere else."""

from types import SimpleNamespace

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.catalogue import read
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import kinetic_frames


@pytest.fixture(scope="module")
def conveyor():
    return Project(read("tests/projects/conveyor.toml"))


@pytest.mark.parametrize(("wide", "high", "share"), [
    (300.0, 300.0, 1.0),  # as much room as is of use
    (300.0, 55.0, kinetic_frames.CUT),  # a low place
    (55.0, 300.0, kinetic_frames.CUT),  # a narrow one
    (300.0, 80.0, 1.0),  # whole ones leave it enough
    (20.0, 20.0, 1.0),  # the cut ones have no room either
])  # fmt: skip
def test_arrows_are_cut_where_that_makes_the_group_larger(conveyor, wide, high, share):
    g, k = conveyor.mechanism.groups[0], conveyor.force_index
    left, below, right, above = kinetic_frames.SCHEME
    place = Box(0.0, 0.0, wide + left + right, high + below + above)
    assert kinetic_frames.share_of_arrows(conveyor, g, k, place) == share


def test_cut_arrows_keep_their_directions_and_their_order(conveyor):
    shown, _ = kinetic_frames.outer_forces(conveyor, conveyor.mechanism.groups[0], conveyor.force_index)
    whole, cut = (kinetic_frames.arrows(shown, share) for share in (1.0, kinetic_frames.CUT))
    for (one, a), (other, b) in zip(whole, cut, strict=True):
        assert one == other
        assert np.angle(b / a) == pytest.approx(0, abs=1e-9)
        assert abs(b) < abs(a)


def test_arrows_are_shortened_for_the_next_finer_scale_factor_of_a_small_group():
    """Whole ones need 0.01026 m/mm of the crusher's place, and the series goes on with 0.015: links of 47 mm instead of 70."""
    project = Project(read("transport/crusher@31-СДМ-246"))
    group, k, place = project.mechanism.groups[0], project.force_index, Box(0.0, 0.0, 111.0, 134.0)
    found = kinetic_frames.share_of_arrows(project, group, k, place)
    assert found == kinetic_frames.SHORTER
    book = SimpleNamespace(scales={}, chosen=set())
    scales = [kinetic_frames.scheme(project, group, k, share).frame(project, book, place).scale.mu for share in (1.0, found)]
    assert scales == [0.015, 0.01]
    assert kinetic_frames.share_of_arrows(project, group, k, Box(0.0, 0.0, 111.0, 174.0)) == 1.0  # nothing is won
    assert kinetic_frames.share_of_arrows(project, group, k, Box(0.0, 0.0, 400.0, 400.0)) == 1.0  # it is large
