"""Tangents of the energy-mass curve, and its limit, against closed forms."""

from __future__ import annotations

from math import cos, pi, tan

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests.methods.flywheel.running import speed
from tmm_sheets.construction.arithmetic import continuous_argmax
from tmm_sheets.construction.step import Plan
from tmm_sheets.methods.flywheel.energy_mass import energy_mass_plan, limit, touched
from tmm_sheets.methods.flywheel.works import LAY_DOWN


@given(st.floats(0.3, 6.0), st.floats(0.2, 5.0))
def test_highest_finds_a_smooth_hump(peak, width):
    found = continuous_argmax(lambda t: -(((t - peak) / width) ** 2), np.linspace(0, 2 * pi, 41))
    assert found == pytest.approx(peak, abs=2e-8 * width)


def test_highest_finds_a_corner_that_is_a_sample_and_an_end():
    corner = 1.2345678901234567
    samples = np.unique(np.append(np.linspace(0, 5, 21), corner))
    assert continuous_argmax(lambda t: -np.abs(t - corner), samples) == corner
    assert continuous_argmax(lambda t: t, samples) == 5.0
    assert continuous_argmax(lambda t: -t, samples) == 0.0


@given(st.floats(30, 200), st.floats(-150, 150), st.floats(1, 80), st.floats(0.01, 0.2))
def test_tangents_of_a_circle(x, y, r, delta):
    """For a circle the intercepts are y - x tan psi +- r/cos psi."""
    labels = ("0", "1", "2")
    given_ = Plan("given", "Дано", "mm")
    phi = np.linspace(0, 2 * pi, 3)
    energy = given_.add("ΔE", LAY_DOWN, y + r * np.sin(phi))
    inertia = given_.add("J", LAY_DOWN, x + r * np.cos(phi))

    def circle(t):
        return x + r * np.cos(t) + 1j * (y + r * np.sin(t))

    def contact(name, angle):
        at = circle(touched(circle, angle, 1 if name == "max" else -1, np.linspace(0, 2 * pi, 101)))
        return given_.add(f"E_{name}", LAY_DOWN, at.imag), given_.add(f"J_{name}", LAY_DOWN, at.real)

    plan = energy_mass_plan(labels, energy, inertia, contact, 0.1, 10.0, 8.0, delta)
    angles = [np.arctan(0.1 / 20 * (8.0 * (1 + s * delta / 2)) ** 2) for s in (1, -1)]
    assert [plan["ψ_max"].value, plan["ψ_min"].value] == pytest.approx(angles, rel=1e-15)
    upper = y - x * tan(angles[0]) + r / cos(angles[0])
    lower = y - x * tan(angles[1]) - r / cos(angles[1])
    size = abs(x) + abs(y) + r
    assert plan["a"].value == pytest.approx(1j * upper, abs=1e-13 * size)
    assert plan["b"].value == pytest.approx(1j * lower, abs=1e-13 * size)
    assert plan["ab"].value == pytest.approx(upper - lower, abs=1e-13 * size)
    np.testing.assert_allclose(plan["points"].value, inertia.value + 1j * energy.value)


def harmonic(n=1, torque=100.0):
    """Moment -torque (1 + cos n phi): the change of energy is -torque sin(n phi)/n."""
    return lambda phi: -torque * (1 + np.cos(n * phi))


@pytest.mark.parametrize("n", [1, 2, 5])
def test_limit_without_moving_masses_is_the_excess_of_energy(n):
    found = limit(harmonic(n), lambda phi: np.zeros_like(phi), np.array([0, 2 * pi]), 10.0, 0.04)
    assert found.segment == pytest.approx(200.0 / n, rel=1e-14)
    assert found.inertia == pytest.approx(200.0 / n / (0.04 * 100), rel=1e-14)
    assert found.error <= 1e-13


def test_limit_with_a_force_that_jumps():
    """Constant moment -12 on a third of the turn: the excess is 12 * (2 pi/3) * (2/3)."""
    third = 2 * pi / 3
    found = limit(lambda phi: np.where(phi < third, -12.0, 0.0), lambda phi: 0 * phi, np.array([0, third, 2 * pi]), 5.0, 0.1)
    assert found.segment == pytest.approx(12 * third * 2 / 3, rel=1e-14)
    assert found.phi_min == pytest.approx(third, abs=1e-12)


def test_speed_obeys_the_equation_of_motion():
    """Runge-Kutta on (J + J_f) w w' + J' w^2/2 = M + M_d, from the same start."""
    inertia, slope = (lambda phi: 2 + 0.5 * np.cos(2 * phi)), (lambda phi: -np.sin(2 * phi))
    moment, drive, flywheel = harmonic(), 100.0, 30.0

    def rate(phi, w):
        return (moment(phi) + drive - slope(phi) * w * w / 2) / ((inertia(phi) + flywheel) * w)

    phi, w, h = 0.0, 10.0, 2 * pi / 2000
    for _ in range(1000):
        k1 = rate(phi, w)
        k2 = rate(phi + h / 2, w + h / 2 * k1)
        k3 = rate(phi + h / 2, w + h / 2 * k2)
        k4 = rate(phi + h, w + h * k3)
        phi, w = phi + h, w + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    (found,) = speed(moment, inertia, np.array([0, 2 * pi]), flywheel, (0.0, 10.0), np.array([pi]))
    assert found == pytest.approx(w, rel=1e-12)


@pytest.mark.parametrize("top", [-0.003, 0.003])
@pytest.mark.parametrize("extra", [[], [1e-15]], ids=["at the ends of a cycle", "beside a doubled sample"])
def test_a_hump_beside_the_best_sample_is_found(top, extra):
    """Before the end of a cycle, whose last sample is as great as the first; behind one that stands twice up to rounding."""
    middle = np.pi if extra else 0.0
    samples = np.unique(np.concatenate((np.linspace(0, 2 * np.pi, 721), middle + np.array(extra))))
    found = continuous_argmax(lambda t: np.cos(t - middle - top), samples)
    assert np.cos(found - middle - top) == pytest.approx(1, abs=1e-14)
