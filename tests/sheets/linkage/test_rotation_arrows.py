"""Arrows of angular velocities and accelerations on the position plans."""

import numpy as np
import pytest

from tests import project_files as files
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.sheets.linkage import kinematics, link_marks
from tmm_sheets.sheets.player import PlanFrame, stage


@pytest.mark.parametrize("link", ["2", "3"])
def test_an_arrow_keeps_clear_of_what_stands_in_its_usual_place(link):
    """Of a coupler farther along it, of a rocker on a larger circle about its pivot."""
    project = files.project(files.FOUR_BAR, files.EVEN)
    pos = project.study.positions
    scale = kinematics.Scale("μ_l", 0.002, "m/mm")
    s = stage(Canvas(), pos.plan, 3, PlanFrame(scale, 100 + 100j))
    shape = next(shape for shape in link_marks.shapes(pos) if shape.link == link)
    usual = kinematics.free_arrows(shape, s, pos, np.array([-1e3 + 0j]))
    busy = np.concatenate([kinematics.along_arrow(arrow) for arrow in usual])
    found = kinematics.free_arrows(shape, s, pos, busy)
    at = np.concatenate([kinematics.along_arrow(arrow) for arrow in found])
    assert np.abs(at[:, None] - busy).min() >= kinematics.CLEAR
