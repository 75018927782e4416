"""Helper lines of the rules that measure moments: arms stand at right angles on lines of action."""

from __future__ import annotations

import numpy as np
import pytest

from tmm_sheets.construction import rules
from tmm_sheets.methods.linkage.forces import DRIVING_FORCE, MOMENTS


@pytest.mark.parametrize(("about", "at", "force"), [
    (0j, 3 + 0j, 2j), (1 + 1j, -2 + 4j, 3 - 5j), (1 + 1j, 1 + 1j, 5 + 0j), (0j, 2 + 0j, -7 + 0j)])
def test_an_arm_is_the_moment_over_the_force(about, at, force):
    action, arm = rules.ARM.helpers((about, at, force), None)
    moment = (at - about).real * force.imag - (at - about).imag * force.real
    assert abs(arm.b - arm.a) == pytest.approx(abs(moment) / abs(force), abs=1e-12)
    assert (arm.a, action.a, action.b) == (about, at, arm.b)
    assert ((arm.b - arm.a) * np.conj(force)).real == pytest.approx(0, abs=1e-12)
    assert ((action.b - action.a) * np.conj(force)).imag == pytest.approx(0, abs=1e-12)


def test_no_force_has_no_arm():
    assert rules.ARM.helpers((0j, 1 + 0j, 0j), 0.0) == ()


def test_a_sum_of_moments_leaves_the_arms_of_its_forces_and_none_of_its_couples():
    lines = MOMENTS.helpers((1j, 2 + 0j, 3j, 0.0, 1j, 0j, 4.0, 5 + 1j, 1 + 0j, 0.0), 0.0)
    assert lines == (*rules.arm(1j, 2 + 0j, 3j), *rules.arm(1j, 5 + 1j, 1 + 0j))
    assert DRIVING_FORCE.helpers((4.0, 1j, 2 + 0j, 1j), 2j) == rules.arm(1j, 2 + 0j, 1j)
