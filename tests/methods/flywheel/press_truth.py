"""Press automaton of manual 002 in closed form, with numpy or mpmath: the truth for Mertsalov's procedure.

``t`` is the crank angle turned clockwise from the outer dead position (position 12), rad. The work of the force is a square of the
way, that of the weights a height, so nothing needs to be integrated.
"""

from __future__ import annotations

import mpmath
import numpy as np

R, L, G, M2, M3, J2 = 0.12, 0.68, 9.8, 800 / 9.8, 300 / 9.8, 4.0
FMAX, STROKE = 40000.0, 0.24
OMEGA = 5 * np.pi
DELTA = 0.04


def slider(t, lib=np):
    """Way of the slider from the crank pivot and its first derivative, m."""
    s, c = lib.sin(t), lib.cos(t)
    root = lib.sqrt(L * L - R * R * s * s)
    return R * c + root, -R * s - R * R * s * c / root


def work(t, lib=np):
    """Work of the resistance and of the weight of the rod from position 12 on, J."""
    x, _ = slider(t, lib)
    way = x - (L - R)
    resisted = -FMAX / STROKE * way**2 / 2 if t > lib.pi else 0
    return resisted + M2 * G * R / 2 * lib.sin(t)


def moment(t, lib=np):
    """Reduced moment of the same, N m, for one angle."""
    x, dx = slider(t, lib)
    resisted = -FMAX * (x - (L - R)) / STROKE * dx if lib.pi < t < 2 * lib.pi else 0
    return resisted + M2 * G * R / 2 * lib.cos(t)


def inertia(t, lib=np):
    """Reduced moment of inertia of rod and slider, kg m2."""
    _, dx = slider(t, lib)
    # Clockwise from the x axis: A = (R cos t, -R sin t), B on the axis, S2 half way.
    ds2 = ((-R * lib.sin(t) + dx) / 2, -R * lib.cos(t) / 2)
    turn = R * lib.cos(t) / lib.sqrt(L * L - R * R * lib.sin(t) ** 2)
    return M2 * (ds2[0] ** 2 + ds2[1] ** 2) + J2 * turn**2 + M3 * dx**2


def total():
    """Work of the driving moment in a turn, J."""
    return FMAX * STROKE / 2


def first_energy(t, lib=np, factor=1):
    """T_I = dE - J_II (factor omega)^2/2, J."""
    return total() * t / (2 * lib.pi) + work(t, lib) - inertia(t, lib) * (factor * 5 * lib.pi) ** 2 / 2


def extreme(sign, factor=1):
    """Angle and value of the largest (sign 1) or the smallest (-1) of ``sign`` times T_I, to 30 digits."""
    with mpmath.workdps(30):
        grid = [2 * mpmath.pi * k / 720 for k in range(721)]
        k = max(range(721), key=lambda i: sign * first_energy(grid[i], mpmath, factor))
        best = mpmath.findroot(lambda t: mpmath.diff(lambda u: first_energy(u, mpmath, factor), t), grid[k])
        return best, first_energy(best, mpmath, factor)


def mertsalov(delta=DELTA):
    """Moment of inertia of the first group by Mertsalov for vanishing intervals, kg m2."""
    return float((extreme(1)[1] - extreme(-1)[1]) / (delta * (5 * mpmath.pi) ** 2))


def exact(delta=DELTA):
    """The exact one, and the angles of the fastest and the slowest running."""
    high, low = extreme(1, 1 + delta / 2), extreme(-1, 1 - delta / 2)
    return float((high[1] - low[1]) / (delta * (5 * mpmath.pi) ** 2)), float(high[0]), float(low[0])
