"""Closure of the higher pair: a spring checked over the whole motion, or a second disc at a constant distance of rollers.

Source: manual 003, sheet 2, items 12 and 13.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import rules
from tmm_sheets.methods.cams.cam_inversion import Inversion
from tmm_sheets.methods.cams.cam_laws import PositionFunction
from tmm_sheets.methods.cams.cam_zone import TURNED

Reals = npt.NDArray[np.float64]


# --- spring -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Spring:
    """Closing spring along the path of the follower (of a rocker: along the path of its roller); SI.

    ``largest_inertia`` is the largest force of inertia that tends to separate follower and cam (S'' < 0), ``f_max`` the
    spring force at the end of the rise, ``f_0`` its preload, ``rate`` the stiffness. ``worst`` is the least ratio of spring
    force and force of inertia where S'' < 0, ``worst_phi`` the cam angle where it occurs: the pair stays closed when it
    is greater than 1. Gravity and friction are left out, the safe side.
    """

    law: PositionFunction
    length: float
    mass: float
    speed: float
    factor: float
    preload: float
    largest_inertia: float
    worst: float
    worst_phi: float

    @property
    def f_max(self) -> float:
        """Largest force, N."""
        return self.factor * self.largest_inertia

    @property
    def f_0(self) -> float:
        """Force in the lowest position, N."""
        return self.preload * self.f_max

    @property
    def way(self) -> float:
        """Way of the spring, m."""
        return self.length * self.law.stroke

    @property
    def rate(self) -> float:
        """Stiffness, N/m."""
        return (self.f_max - self.f_0) / self.way

    @property
    def closed(self) -> bool:
        """True when the spring holds the pair together in every position."""
        return self.worst > 1

    @property
    def needed_factor(self) -> float:
        """Factor of the largest force from which on the pair stays closed, the share of the preload kept."""
        return self.factor / self.worst

    def force(self, s: Any) -> Any:
        """Force at displacements of the law (m, or rad of a rocker), N."""
        return self.f_0 + self.rate * self.length * s

    def inertia(self, dds: Any) -> Any:
        """Force of inertia away from the cam at second derivatives of the law, N; negative where it presses together."""
        return -self.mass * self.speed**2 * self.length * dds

    def results(self) -> dict[str, Any]:
        """Results in SI."""
        return {"largest_inertia": self.largest_inertia, "F_max": self.f_max, "F_0": self.f_0, "stiffness": self.rate,
                "way": self.way, "worst_ratio": self.worst, "worst_phi": self.worst_phi, "closed": self.closed}


def spring(law: PositionFunction, length: float, mass: float, speed: float, factor: float, preload: float) -> Spring:
    """Spring for force closure.

    Parameters
    ----------
    law
        law of motion; ``length`` turns its displacement into a way, m (1, or the arm of a rocker).
    mass
        mass moved along that way, kg (of a rocker J/arm^2).
    speed
        rad/s.
    factor, preload
        largest force by the largest separating force of inertia; force in the lowest position by the largest.
    """
    largest, worst, where = 0.0, float("inf"), 0.0
    pieces = [(p, a + 1e-12, b - 1e-12) for p in (law.rise, law.fall)
              for a, b in zip((0.0, *p.law.jumps), (*p.law.jumps, 1.0), strict=True)]
    for p, a, b in pieces:
        largest = max(largest, float(-_least(lambda x, p=p: p.dds(x), a, b)[0]))
    unit = mass * speed**2 * length
    largest *= unit
    for p, a, b in pieces:

        def ratio(x: Reals, p: Any = p) -> Reals:
            force = factor * largest * (preload + (1 - preload) * p.s(x) / law.stroke)
            inertia = -unit * p.dds(x)
            return np.asarray(np.divide(force, inertia, out=np.full_like(force, np.inf), where=inertia > 1e-12 * largest))

        value, x = _least(ratio, a, b)
        if value < worst:
            worst, where = value, float(p.phi(x))
    return Spring(law, length, mass, speed, factor, preload, largest, worst, where)


def _least(f: Any, lo: float, hi: float) -> tuple[float, float]:
    """Least value of a smooth function and its place: a grid, then finer ones round its lowest point."""
    for n in (513, 33, 33, 33, 33):
        x = np.linspace(lo, hi, n)
        y = f(x)
        k = int(np.argmin(y))
        lo, hi = float(x[max(k - 1, 0)]), float(x[min(k + 1, n - 1)])
    return float(y[k]), float(x[k])


# --- second disc ------------------------------------------------------------------------------------------------------


def second_disc_of_tappet(inv: Inversion, distance: float) -> None:
    """Record the centre profile B′ of the second disc and its normals N′: the rollers keep their ``distance`` (m)."""
    plan = inv.plan
    second = plan.add("B′", rules.ALONG, inv.centres, inv.lines, -distance,
                      say="От точки {0} по линии толкателя отложим постоянное расстояние между роликами {2}: точка {name}.")
    plan.add("N′", rules.RAY, second, plan["P"], say="Нормаль {name} второго диска проходит через ту же точку {1}.")


def second_disc_of_rocker(inv: Inversion, angle: float, arm: float) -> None:
    """Record the centre profile B′ of the second disc and its normals N′: the arms keep their ``angle`` (rad, signed)."""
    plan = inv.plan
    second = plan.add("B′", TURNED, inv.ends, inv.centres, abs(angle), float(np.sign(angle)),
                      say="Второе плечо коромысла повёрнуто вокруг {0} относительно первого на постоянный угол {2}: точка {name}.")
    line = plan.add("B′A", rules.RAY, second, inv.ends)
    tips = plan.add("D′", rules.OFFSET, second, line, plan["D"].args[2],
                    say="От точки {0} к оси коромысла отложим отрезок AB·ψ' = {2}: точка {name}.")
    plan.add("N′", rules.RAY, tips, inv.origin, say="Нормаль {name} второго диска параллельна прямой {0}{1}.")
