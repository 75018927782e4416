"""Angles φ1k and φ2k, inclinations and lengths of slotted links against manual 001's formulas."""

from math import asin, pi

import numpy as np
import pytest

from tmm_sheets.catalogue import entries, read
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import link_marks


def project(name):
    return Project(read(name))


@pytest.mark.parametrize("name", ["sixbar/1:1", "sixbar/3:2", "sixbar/5:5", "sixbar/6:1", "sixbar/10:2"])
def test_named_angles_are_those_of_the_formulas(name):
    """001, (6)-(9): pi/2 + arcsin of the smaller of r/a and a/r, and its mirror image."""
    p = project(name)
    m = p.mechanism
    a, r = abs(m.fixed["O3"] - m.fixed["O1"]), m.crank.length
    first = pi / 2 + asin(min(r / a, a / r))
    plan = p.motion.named_angles
    assert [float(plan[f"φ_{k}k"].value) for k in (1, 2)] == pytest.approx([first, 2 * pi - first], abs=1e-12)


@pytest.mark.parametrize("name", ["sixbar/7:1", "sixbar/8:3", "press"])
def test_without_a_slotted_link_on_the_crank_there_are_none(name):
    assert project(name).motion.named_angles is None


def test_inclination_of_rods():
    """Task 7 (001): sin θ2 = r/l2·cos φ, sin θ4 = r/l4·sin φ, φ from the upper vertical; θ4 grows counter-clockwise."""
    p = project("sixbar/7:2")
    r, phi = p.mechanism.crank.length, p.cycle.turned
    two, four = (float(g.lengths[0]) for g in p.mechanism.groups)
    assert np.allclose(np.abs(np.sin(p.motion.inclination("2", "x–x").value)), np.abs(r / two * np.cos(phi)), atol=1e-12)
    guide = p.mechanism.groups[1].guides[-1]
    assert np.allclose(np.sin(p.motion.inclination("4", guide).value), r / four * np.sin(phi), atol=1e-12)


@pytest.mark.parametrize(("name", "link", "pivot", "length"), [
    ("sixbar/3:2", "3", "O3", 2 * 0.316), ("sixbar/8:3", "5", "O5", None), ("sixbar/5:5", "3", "O3", None)])
def test_slotted_links_keep_their_length(name, link, pivot, length):
    """One length all round the turn, beyond every place of the slider block; a bar from its pivot on is twice l_OS long."""
    p = project(name)
    pos = p.study.positions
    end = link_marks.free_ends(pos)[link][-1].at
    far = np.abs(end - pos.mechanism.fixed[pivot])
    assert np.ptp(far) < 1e-12
    blocks = [np.abs(pos.points[str(g.outer[0])].value - pos.mechanism.fixed[pivot]).max()
              for g in pos.mechanism.groups if link in g.links]
    assert far[0] > max(blocks)
    centre = abs(pos.points[pos.mechanism.links[link].centre].at(0) - pos.mechanism.fixed[pivot])
    other = 0.0 if name != "sixbar/5:5" else abs(pos.points["B"].at(0) - pos.mechanism.fixed[pivot])
    assert far[0] == pytest.approx(2 * centre + other, abs=1e-12)
    assert length is None or far[0] == pytest.approx(length, abs=1e-12)


def test_every_designation_belongs_to_one_project():
    found = [read(entry.name).title_block.designation for entry in entries() if not entry.name.startswith("transport/")]
    assert len(set(found)) == len(found)
