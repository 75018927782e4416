"""Acceleration plans against second derivatives; normal and Coriolis segments against their definitions."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests.methods.linkage import truth
from tests.methods.linkage.mechanisms import mechanisms, value
from tests.methods.settings import every_kind, tried
from tmm_sheets.catalogue import read
from tmm_sheets.methods.linkage.motion import RIGID_ACCELERATION, acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.project import Project

OMEGA = -2 * np.pi * 1.2
NAMES = ("B", "D", "S3", "S5")


def accelerations(m, phi, epsilon1=None):
    return acceleration_plan(velocity_plan(position_plan(m, np.atleast_1d(phi))), epsilon1)


def test_shaper_at_its_positions(shaper):
    acc = shaper.study.accelerations
    for k, phi in enumerate(acc.positions.phi):
        _, _, a, _, epsilon3 = truth.shaper_motion(phi, OMEGA)
        for name in NAMES:
            assert abs(value(acc.points[name], k) - a[name]) <= 1e-12 * abs(a[name]), (name, k)
        # In position 3 and 8 the rocker's acceleration is zero: measured by the square of the speed.
        assert abs(value(acc.epsilon["3"], k) - epsilon3) <= 1e-12 * max(abs(epsilon3), 1e-2 * OMEGA**2)
        assert value(acc.epsilon["2"], k) == value(acc.epsilon["3"], k)
        assert value(acc.epsilon["4"], k) == value(acc.epsilon["5"], k) == 0


def test_shaper_anywhere(shaper):
    phi = np.random.default_rng(3).uniform(-np.pi, np.pi, 40)
    acc = accelerations(shaper.mechanism, phi)
    for k, at in enumerate(phi):
        _, _, a, _, epsilon3 = truth.shaper_motion(at, OMEGA)
        for name in NAMES:
            assert abs(value(acc.points[name], k) - a[name]) <= 1e-12 * max(abs(a[name]), 0.1)
        assert abs(value(acc.epsilon["3"], k) - epsilon3) <= 1e-12 * max(abs(epsilon3), 0.1)


@pytest.mark.parametrize(
    ("symbol", "printed"),
    [("a_B", "4.54791"), ("a_k", "0.91408"), ("a_n", "0.86831"), ("a_t", "1.20421"), ("a_B3", "1.48462"), ("a_D", "2.56103"),
     ("a_D5", "2.27054"), ("a_S3", "1.28052"), ("eps3", "3.67017")],
)
def test_shaper_position_2(shaper, symbol, printed):
    acc, k = shaper.study.accelerations, 2
    n, b3 = value(acc.plan["n"], k), value(acc.coincident["B3"], k)
    found = {"a_B": value(acc.points["B"], k), "a_k": value(acc.plan["k"], k) - value(acc.points["B"], k), "a_n": n, "a_t": b3 - n,
             "a_B3": b3, "a_D": value(acc.points["D"], k), "a_D5": value(acc.points["S5"], k), "a_S3": value(acc.points["S3"], k),
             "eps3": value(acc.epsilon["3"], k)}[symbol]
    assert f"{abs(found):.5f}" == printed


def test_segments_of_position_2_have_their_directions(shaper):
    """Normal part to the pivot, Coriolis part is the sliding velocity turned with the rocker, the rest along and across."""
    acc, k = shaper.study.accelerations, 2
    pos, vel = acc.positions, acc.velocities
    arrows = {s.symbol: value(s.head, k) - value(s.tail, k) for s in acc.plan.segments}
    rocker = value(pos.directions["3"], k)
    omega3 = value(vel.omega["3"], k).real
    sliding = value(vel.coincident["B3"], k) - value(vel.points["B"], k)
    assert abs(arrows["a̅_{B3C}^n"] / rocker + abs(arrows["a̅_{B3C}^n"])) < 1e-15
    assert abs(arrows["a̅_{B3B}^к"] - 2j * omega3 * sliding) < 1e-15
    assert abs((arrows["a̅_{B3B}^r"] / rocker).imag) < 1e-15
    assert abs((arrows["a̅_{B3C}^τ"] / rocker).real) < 1e-15
    chain = arrows["a̅_B"] + arrows["a̅_{B3B}^к"] + arrows["a̅_{B3B}^r"]
    assert abs(chain - arrows["a̅_{B3C}^n"] - arrows["a̅_{B3C}^τ"]) < 1e-14


@every_kind
def test_against_second_derivatives(kinds):
    @tried(kinds)
    @given(mechanisms(kinds))
    def check(drawn):
        m, phi = drawn
        acc = accelerations(m, phi)
        true = truth.motion(m, phi, epsilon=m.crank.sense * m.crank.acceleration)
        size = max(m.crank.length * m.crank.speed**2, *map(abs, true.a.values()))
        for name, a in true.a.items():
            assert abs(value(acc.points[name]) - a) < 1e-12 * size
        spin = max(m.crank.speed**2, *map(abs, true.epsilon.values()))
        for link, e in true.epsilon.items():
            assert abs(value(acc.epsilon[link]) - e) < 1e-12 * spin

    check()


@given(st.floats(-np.pi, np.pi), st.floats(-100, 100))
def test_acceleration_of_the_crank_is_given_or_the_mechanisms_own(shaper, phi, epsilon):
    m = shaper.mechanism
    a = value(accelerations(m, phi, epsilon).points["B"])
    assert abs(a - 0.08 * np.exp(1j * phi) * (1j * epsilon - OMEGA**2)) < 1e-13 * (abs(epsilon) + OMEGA**2)
    assert abs(value(accelerations(m, phi).points["B"]) + 0.08 * np.exp(1j * phi) * OMEGA**2) < 1e-14


def test_fixed_guides_have_no_coriolis_segment(shaper):
    acc = shaper.study.accelerations
    assert [s.symbol for s in acc.plan.segments if "^к" in s.symbol] == ["a̅_{B3B}^к"]


@pytest.mark.parametrize("name", ["tests/projects/planer.toml", "tests/projects/feeder.toml", "sixbar/10:1"])
def test_points_that_turn_with_their_link_move_as_their_places_do(name):
    """On turning guides, beside slots that pass their pivots: differences of the positions are the truth, of the fourth order."""
    m, h = Project(read(name)).mechanism, 1e-3
    acc = accelerations(m, 0.7 + h * np.arange(-2, 3))
    assert any(step.rule is RIGID_ACCELERATION for step in acc.plan)
    size = max(abs(value(a, 2)) for a in acc.points.values())
    for point, a in acc.points.items():
        z = acc.positions.points[point].value
        if np.ndim(z):
            rate, second = z @ [1, -8, 0, 8, -1] / (12 * h), z @ [-1, 16, -30, 16, -1] / (12 * h * h)
            assert abs(value(a, 2) - second * m.crank.omega**2 - rate * m.crank.sense * float(m.crank.acceleration)) < 1e-7 * size
