"""Shaper of manual 000, example 1, in closed form: the truth for tests of methods that need only its reduced quantities.

The rocker's angle from the vertical is atan2(AB sin b, AC + AB cos b), b the crank's angle from the upward vertical,
clockwise; everything else is its derivative. Works with numpy arrays and with mpmath numbers.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import acos, pi, radians

import numpy as np

from tests.methods.flywheel.as_steps import AsSteps

AB, AC, CD, CS3 = 0.08, 0.26, 0.566, 0.283
M2, M3, M4, M5, J_S3 = 2.8, 5.66, 3.0, 80.0, 0.15110
F5 = 2800.0
OMEGA = 2 * pi * 1.2
START = radians(-108)


def rocker(beta, lib=np):
    """Sine and cosine of the rocker's angle from the vertical, and its derivative over the crank angle."""
    x, y = AB * lib.sin(beta), AC + AB * lib.cos(beta)
    square = x * x + y * y
    r = lib.sqrt(square)
    return x / r, y / r, AB * (AB + AC * lib.cos(beta)) / square


def ram_rate(beta, lib=np):
    """dS5/dphi, m: positive on the working stroke."""
    _, cos, rate = rocker(beta, lib)
    return CD * cos * rate


def inertia_terms(beta, lib=np):
    """Terms of the reduced moment of inertia, kg m2."""
    _, cos, rate = rocker(beta, lib)
    return {"m2": M2 * AB**2 + 0 * rate, "J3": J_S3 * rate**2, "m3": M3 * (CS3 * rate) ** 2, "m4": M4 * (CD * rate) ** 2,
            "m5": M5 * (CD * cos * rate) ** 2}


def inertia(beta, lib=np):
    """Reduced moment of inertia of the links, kg m2."""
    return sum(inertia_terms(beta, lib).values())


DEAD = acos(-AB / AC)
"""Crank angle of the dead positions from the upward vertical: crank and rocker at right angles."""


def ram_stroke():
    """Length of the stroke, m."""
    return 2 * CD * AB / AC


@dataclass(frozen=True)
class Shaper(AsSteps):
    """The reduced quantities a flywheel is designed from."""

    positions: int = 10
    labels: tuple[str, ...] = field(init=False)
    phi: np.ndarray = field(init=False)
    period: float = 2 * pi
    breaks: tuple[float, ...] = (-DEAD - START, DEAD - START)
    omega1: float = OMEGA
    resisting: bool = True
    forces_are_moments: bool = False
    moments_beside: tuple[str, ...] = ()

    def __post_init__(self):
        object.__setattr__(self, "labels", tuple(str(k) for k in range(self.positions)))
        object.__setattr__(self, "phi", np.linspace(0, 2 * pi, self.positions + 1))

    def works(self, phi, side=1):
        """True where the force acts; ``side`` decides at the ends."""
        first, last = self.breaks
        phi = np.asarray(phi, dtype=float)
        return ((phi > first) & (phi < last)) | ((phi == first) & (side > 0)) | ((phi == last) & (side < 0))

    def moment(self, phi, side=1):
        return np.where(self.works(phi, side), -F5 * np.abs(ram_rate(np.asarray(phi) + START)), 0.0)

    def forces_at(self, phi, side=1):
        return {"F_5": np.where(self.works(phi, side), F5, 0.0)}

    crank_inertia: float = 0.0

    def inertia(self, phi):
        return inertia(np.asarray(phi) + START)

    @property
    def inertia_terms(self):
        beta = self.phi + START
        _, cos, rate = rocker(beta)
        w3 = np.abs(rate) * OMEGA
        vs = {"V_S2": AB * OMEGA + 0 * w3, "V_S3": CS3 * w3, "V_S4": CD * w3, "V_S5": CD * cos * w3}
        return {
            "V_S2, м/с": vs["V_S2"], "m_2·V_S2^2, Дж": M2 * vs["V_S2"] ** 2,
            "ω_3, с^{−1}": w3, "J_S3·ω_3^2, Дж": J_S3 * w3**2,
            "V_S3, м/с": vs["V_S3"], "m_3·V_S3^2, Дж": M3 * vs["V_S3"] ** 2,
            "V_S4, м/с": vs["V_S4"], "m_4·V_S4^2, Дж": M4 * vs["V_S4"] ** 2,
            "V_S5, м/с": vs["V_S5"], "m_5·V_S5^2, Дж": M5 * vs["V_S5"] ** 2,
        }
