"""Energy-mass diagram of F. Wittenbauer (диаграмма энергомасс): the flywheel's moment of inertia from two tangents.

The curve is the change of kinetic energy over the reduced moment of inertia, the angle eliminated. Its tangents under
``psi_max`` from above and ``psi_min`` from below cut the segment ``ab`` off the energy axis (manual 000, 5.5 and 5.6).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.rules import LINE_LINE
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.methods.integration import Floats, Quadrature

Curve = Callable[[Any], Any]


def highest(f: Callable[[Floats], Floats], samples: Floats) -> float:
    """Argument of the largest value of a continuous function between the first and the last of the ``samples``.

    The samples must separate the humps; corners of ``f`` (where a force begins or ends) must be samples. The bracket
    round the best sample is divided in 256 again and again until it is flat to rounding.
    """
    values = f(samples)
    k = int(np.argmax(values))
    low, best, high = samples[max(k - 1, 0)], samples[k], samples[min(k + 1, len(samples) - 1)]
    value = float(values[k])
    while high - low > 1e-15 * (samples[-1] - samples[0]):
        t = np.linspace(low, high, 257)
        y = f(t)
        j = int(np.argmax(y))
        # A corner is met exactly by its sample only, so the best so far is kept.
        if y[j] > value:
            best, value = t[j], float(y[j])
        if value - min(y[max(j - 1, 0)], y[min(j + 1, 256)]) <= 4e-15 * abs(value):
            break
        step = (high - low) / 256
        low, high = max(best - step, low), min(best + step, high)
    return float(best)


def _touch(angle: Any, side: Any, curve: Curve, samples: Floats) -> Any:
    slope = np.tan(angle)

    def height(t: Floats) -> Floats:
        p = curve(t)
        return np.asarray(side * (np.imag(p) - slope * np.real(p)))

    return complex(curve(np.array([highest(height, samples)]))[0])


SEGMENT = Rule("segment of the energy axis", lambda a, b: np.imag(a) - np.imag(b), ("point", "point"), "ordinate",
               "На оси ΔE измерим отрезок от {1} до {0}, вверх положительный: {name} = {value}.")
TANGENT_ANGLE = Rule(
    "angle of a tangent", lambda k, omega, delta: np.arctan(k * (omega * (1 + delta / 2)) ** 2), (), "angle",
    "Вычислим угол наклона касательной {name} = {value}.",
)
UNDER_ANGLE = Rule("direction under an angle", lambda angle: np.cos(angle) + 1j * np.sin(angle), ("angle",), "direction",
                   "Под углом {0} к оси приведённых моментов инерции возьмём направление {name}.")
PROJECT = Rule(
    "project from two graphs", lambda e, j: j + 1j * e, ("ordinate", "ordinate"), "point",
    "С графика ΔE(φ1) проведём горизонталь с ординатой {0}, с графика J(φ1) вертикаль с абсциссой {1}: "
    "на их пересечении точка кривой энергомасс.",
    lambda a, v: (Helper("line", complex(0, v.imag), v), Helper("line", complex(v.real, 0), v)),
)
TOUCH = Rule("touch a curve", _touch, ("angle",), "point",
             "Под углом {0} к оси приведённых моментов инерции проведём касательную к кривой: точка касания {name}.")


def energy_mass_plan(labels: tuple[str, ...], energy: Step, inertia: Step, curve: Curve, samples: Floats,
                     mu_j: float, mu_e: float, omega: float, delta: float) -> Plan:
    """Construction of the segment ``ab`` on paper, mm.

    Parameters
    ----------
    labels
        numbers of the positions.
    energy, inertia
        ordinates of the graphs dE(phi) and J(phi) at the positions, arrays, mm.
    curve
        the smooth closed curve through the points: angle -> complex, abscissa J, ordinate dE, mm.
    samples
        angles between which every hump of the curve is seen, corners among them.
    mu_j, mu_e
        scale factors, kg m2/mm and J/mm.
    omega, delta
        mean angular velocity, rad/s, and coefficient of non-uniformity.

    Returns
    -------
    Plan with ``points`` (one per position), ``ψ_max``, ``ψ_min`` (rad), ``T_max``, ``T_min`` (points of contact), ``a``,
    ``b`` (intercepts on the energy axis) and ``ab`` (from b up to a, mm: negative where the upper tangent cuts the axis below the
    lower one, so that no flywheel is needed).
    """
    plan = Plan("energy-mass", "Диаграмма энергомасс", "mm", labels)
    plan.add("points", PROJECT, energy, inertia)
    k = mu_j / (2 * mu_e)
    for name, sign, side, intercept in (("max", 1.0, 1, "a"), ("min", -1.0, -1, "b")):
        angle = plan.add(f"ψ_{name}", TANGENT_ANGLE, k, omega, sign * delta)
        direction = plan.add(f"t_{name}", UNDER_ANGLE, angle)
        contact = plan.add(f"T_{name}", TOUCH, angle, side, curve, samples)
        plan.add(intercept, LINE_LINE, contact, direction, 0j, 1j,
                 say="Касательная в точке {0} пересечёт ось ΔE в точке {name}.")
    plan.add("ab", SEGMENT, plan["a"], plan["b"])
    return plan


@dataclass(frozen=True)
class ConvergedWheel:
    """The limit of the construction for vanishing intervals.

    ``segment`` is ``ab mu_E``, J; ``inertia`` that of the flywheel, kg m2, both negative when none is needed; ``error`` the
    relative difference of the last two refinements; ``phi_max`` and ``phi_min`` the angles of the two contacts, rad.
    """

    segment: float
    inertia: float
    error: float
    phi_max: float
    phi_min: float


def limit(moment: Curve, inertia: Curve, borders: Floats, omega: float, delta: float, tolerance: float = 1e-13) -> ConvergedWheel:
    """Flywheel without chords: max(dE - J omega_max^2/2) - min(dE - J omega_min^2/2) = delta omega^2 J_flywheel.

    ``moment`` (without the constant one, N m) and ``inertia`` (without the flywheel, kg m2) are vectorised functions of
    the angle, smooth between the ``borders``. Work by Gauss-Legendre panels, the contacts found between the nodes; the
    panels are halved until two results agree to ``tolerance``.
    """
    samples = np.unique(np.concatenate((np.linspace(borders[0], borders[-1], 721), borders)))
    j = np.asarray(inertia(samples))
    result = None
    for panels in (1, 2, 4, 8, 16):
        work = Quadrature(moment, borders, panels)
        mean = work.total / (borders[-1] - borders[0])
        done = work(samples)
        segment, contact = 0.0, []
        for sign in (1.0, -1.0):
            half_square = (omega * (1 + sign * delta / 2)) ** 2 / 2

            def height(t: Floats, sign: float = sign, half_square: float = half_square, work: Quadrature = work,
                       mean: float = mean, done: Floats = done) -> Floats:
                at, spent = (j, done) if t is samples else (inertia(t), work(t))
                return np.asarray(sign * (spent - mean * (t - borders[0]) - half_square * at))

            contact.append(highest(height, samples))
            segment += float(height(np.array(contact[-1:]))[0])
        error = abs(segment - result.segment) / (abs(segment) or 1.0) if result else np.inf
        result = ConvergedWheel(segment, segment / (delta * omega**2), error, contact[0], contact[1])
        if error <= tolerance:
            break
    assert result is not None
    return result


def speed(moment: Curve, inertia: Curve, borders: Floats, flywheel: float, fastest: tuple[float, float],
          phi: Floats) -> Floats:
    """Angular velocity over the angle with that flywheel, from the energy integral, rad/s.

    ``fastest`` is an angle and the angular velocity there; the constant moment balances the cycle.
    """
    work = Quadrature(moment, borders, 8)
    mean = work.total / (borders[-1] - borders[0])
    at = np.concatenate(([fastest[0]], np.asarray(phi, dtype=float)))
    excess = work(at) - mean * (at - borders[0])
    mass = flywheel + np.asarray(inertia(at))
    energy = mass[0] * fastest[1] ** 2 / 2 + excess[1:] - excess[0]
    return np.asarray(np.sqrt(2 * energy / mass[1:]))

