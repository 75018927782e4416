"""Exact steady running (установившееся движение) of a machine with a given flywheel, from the energy integral.

What every method of the flywheel is measured against: E = J omega^2/2 grows by the work done, and nothing is left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.methods.flywheel.energy_mass import highest
from tmm_sheets.methods.integration import Floats, Quadrature

Curve = Callable[[Any], Any]


@dataclass(frozen=True)
class Running:
    """Steady running: the fastest and the slowest angular velocity, rad/s, and the angles where they are reached, rad."""

    fastest: float
    slowest: float
    phi_fastest: float
    phi_slowest: float

    @property
    def mean(self) -> float:
        """Mean of the fastest and the slowest, rad/s."""
        return (self.fastest + self.slowest) / 2

    @property
    def delta(self) -> float:
        """Coefficient of non-uniformity."""
        return (self.fastest - self.slowest) / self.mean


class Energy:
    """What the change of energy of a machine needs, whatever its flywheel.

    ``moment`` (without the constant one, N m) and ``inertia`` (without the flywheel, kg m2) are vectorised functions of the
    angle, smooth between the ``borders``; the constant moment balances the cycle.
    """

    def __init__(self, moment: Curve, inertia: Curve, borders: Floats) -> None:
        # Many narrow panels with few nodes: as exact as few wide ones here, and looked up at a third of the cost.
        self.work = Quadrature(moment, borders, 32, 6)
        self.mean = self.work.total / (borders[-1] - borders[0])
        self.inertia = inertia
        self.samples = np.unique(np.concatenate((np.linspace(borders[0], borders[-1], 721), borders)))
        self._known: dict[bytes, tuple[Floats, Floats]] = {}

    def __call__(self, phi: Floats) -> tuple[Floats, Floats]:
        """Excess of work since the first border, J, and moment of inertia, kg m2; shape of ``phi``."""
        # Extremes of one machine with several flywheels lie side by side: the same angles are asked for again and again.
        key = phi.tobytes()
        if key not in self._known:
            self._known[key] = (np.asarray(self.work(phi) - self.mean * (phi - self.samples[0])), np.asarray(self.inertia(phi)))
        return self._known[key]


def steady(energy: Energy, first: float, omega: float) -> Running:
    """Steady running whose extremes have the mean ``omega`` (rad/s), with the moment of inertia ``first`` (kg m2) on the crank.

    The level of the energy is found by Newton's method: a change of it moves both extremes alike, but for the small change of
    the inertia. NaN where the inertia is too small to carry the crank round at that mean: it would stop.
    """
    def square(phi: Floats, level: float) -> Floats:
        excess, mass = energy(phi)
        return np.asarray(2 * (level + excess) / (first + mass))

    samples = energy.samples
    excess, mass = energy(samples)
    lowest = -float(excess.min())
    if np.sqrt(square(samples, lowest).clip(0).max()) >= 2 * omega:
        return Running(np.nan, np.nan, np.nan, np.nan)
    level = max((first + float(np.mean(mass))) * omega**2 / 2, lowest * (1 + 1e-9))
    at = np.zeros(2)
    for _ in range(3):
        before = level
        at = np.array([highest(lambda phi, sign=sign, level=level: sign * square(phi, level), samples)  # type: ignore[misc]
                       for sign in (1, -1)])
        excess, mass = energy(at)
        mass = first + mass
        # The slowest may lie between the samples.
        lowest = max(lowest, -float(excess.min()))
        level = max(level, lowest * (1 + 1e-9))
        for _ in range(20):
            speeds = np.sqrt(2 * (level + excess) / mass)
            change = (omega - speeds.mean()) / float(np.mean(1 / (mass * speeds)))
            change = max(change, (lowest - level) / 2)
            level += change
            if abs(change) <= 1e-16 * abs(level):
                break
        if abs(level - before) <= 1e-15 * abs(level):
            break
    fastest, slowest = np.sqrt(square(at, level))
    return Running(float(fastest), float(slowest), float(at[0]), float(at[1]))
