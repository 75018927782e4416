"""Condition numbers of crossings against the angle at which the lines were made to cross."""

import numpy as np
import pytest

from tmm_sheets.construction import condition, rules
from tmm_sheets.construction.step import Plan

ANGLES = np.array([90.0, 60.0, 30.0, 10.0, 3.0, -45.0])
TRUE = 1 / np.abs(np.sin(np.radians(ANGLES)))
TURNED = np.exp(1j * np.radians(ANGLES))


def of(rule, *args):
    """The condition number of a crossing at all angles."""
    plan = Plan("p", "", "m")
    plan.add("C", rule, *args)
    return condition.steps(plan)["C"].value


def test_lines():
    assert of(rules.LINE_LINE, -40 + 0j, 1 + 0j, -50 * TURNED, TURNED) == pytest.approx(TRUE, rel=1e-12)


def test_arcs_cross_under_the_angle_of_their_radii():
    right = np.where(ANGLES < 0, -1, 1)
    assert of(rules.ARC_ARC, 0.06 + 0j, 0.06, 0.08 * TURNED, 0.08, right) == pytest.approx(TRUE, rel=1e-9)


def test_an_arc_and_a_line_cross_square_where_the_line_is_a_radius():
    """The line leaves the arc about 0 at the point 1: its angle with the arc is 90 degrees less its angle with the radius."""
    assert of(rules.ARC_LINE, 0j, 1.0, 1 - 0.1j * TURNED, 1j * TURNED, 1) == pytest.approx(
        1 / np.abs(np.cos(np.radians(ANGLES + 90))), rel=1e-9)


def test_where_nothing_crosses_there_is_none():
    found = of(rules.ARC_ARC, 0j, 1.0, np.array([1 + 0j, 5 + 0j]), 1.0, 1)
    assert found[0] == pytest.approx(2 / np.sqrt(3))
    assert np.isnan(found[1])


def test_the_least_is_one():
    """Whatever rounding makes of a sine."""
    assert of(rules.LINE_LINE, np.exp(1j * np.linspace(0, 6, 400)), 1 + 1e-9j, 0j, 1j - 1e-9).min() >= 1
