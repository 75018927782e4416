"""Graphical integration, excess work and both methods of the flywheel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property, partial
from math import tau
from typing import Any

import numpy as np
from mpmath import mp

from tmm_sheets import catalogue
from tmm_sheets.construction.arithmetic import continuous_argmax
from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.step import Plan
from tmm_sheets.lab.bench.records import DIGITS, Bench
from tmm_sheets.methods.flywheel.flywheel import Flywheel
from tmm_sheets.methods.flywheel.wheel_methods import Mertsalov, Wittenbauer
from tmm_sheets.methods.integration import Quadrature, integrate, ordinates, smooth
from tmm_sheets.project import Project

CHORDS = (6, 12, 24, 48, 96, 192, 384)
POSITIONS = (10, 20, 40, 80, 160, 320)


# --- integrands with their integrals in closed form -------------------------------------------------------------------


@dataclass(frozen=True)
class Integrand:
    """A function over one turn: ``f`` in doubles, its integral from 0 in mpmath, where it jumps or peaks."""

    name: str
    f: Callable[[Floats], Floats]
    integral: Callable[[Any], Any]
    borders: tuple[float, ...] = ()

    @cached_property
    def size(self) -> float:
        """Largest absolute value of the integral."""
        with mp.workdps(DIGITS):
            return max(float(abs(self.integral(mp.mpf(x)))) for x in (*np.linspace(0, tau, 721).tolist(), *self.borders))

    def chords(self, borders: tuple[float, ...], n: int) -> tuple[Floats, Floats]:
        """Ends of ``n`` chords and of those at borders, and the integral that is constructed there."""
        edges = _edges(n, borders)
        return edges, _chords(self.f, edges)

    def error(self, n: int, found: tuple[Floats, Floats]) -> float:
        """Largest error of what :meth:`chords` gives, as a share of the integral's size."""
        edges, values = (part.tolist() for part in found)
        with mp.workdps(DIGITS):
            return max(float(abs(v - self.integral(mp.mpf(x)))) for x, v in zip(edges, values, strict=True)) / self.size


ON, OFF, PEAK, WIDTH = 0.31, 3.44, 2.05, 0.4


def _cut_integral(x: Any) -> Any:
    x = min(max(x, mp.mpf(ON)), mp.mpf(OFF))
    return (x - ON) - (mp.cos(x) - mp.cos(mp.mpf(ON))) / 2


def _peak_integral(x: Any) -> Any:
    t = min(max((x - PEAK) / mp.mpf(WIDTH), mp.mpf(-1)), mp.mpf(1))
    return mp.mpf(WIDTH) * ((1 + t) ** 2 / 2 if t < 0 else 1 - (1 - t) ** 2 / 2)


SMOOTH = Integrand("smooth", lambda x: np.sin(x) ** 2, lambda x: x / 2 - mp.sin(2 * x) / 4)
JUMPS = Integrand("force with jumps", lambda x: np.where((x > ON) & (x < OFF), 1 + np.sin(x) / 2, 0.0), _cut_integral, (ON, OFF))
PEAKED = Integrand("diagram with a peak", lambda x: np.maximum(1 - np.abs(x - PEAK) / WIDTH, 0.0), _peak_integral,
                   (PEAK - WIDTH, PEAK, PEAK + WIDTH))


def _edges(n: int, borders: tuple[float, ...] = ()) -> Floats:
    return np.unique(np.concatenate((np.linspace(0, tau, n + 1), borders)))


def _chords(f: Callable[[Floats], Floats], edges: Floats) -> Floats:
    """Ordinates at the ends of the chords, by the recorded construction."""
    heights = f((edges[:-1] + edges[1:]) / 2)
    names = [str(k) for k in range(len(edges))]
    return ordinates(integrate(Plan("bench", "", "mm"), "", edges, heights, 1.0, borders=names))


def _integration(bench: Bench) -> None:
    ways = [(SMOOTH, "equal intervals", ()), (JUMPS, "equal intervals", ()), (JUMPS, "jumps as borders", JUMPS.borders),
            (PEAKED, "equal intervals", ()), (PEAKED, "peak as border", PEAKED.borders)]
    for g, way, borders in ways:
        bench.rows(("graphical integration", f"{g.name}, {way}", "chords"), CHORDS, 24, partial(g.chords, borders), g.error)


# --- excess work of the moment 1/2 - sin^2: the sine of twice the angle over 4, so the span is exactly 1/2 -------------


def _span(curve: Callable[[Floats], Floats], samples: Floats) -> float:
    high, low = (float(curve(np.array([continuous_argmax(lambda t, s=s: s * curve(t), samples)]))[0])  # type: ignore[misc]
                 for s in (1.0, -1.0))
    return high - low


def _excess(bench: Bench) -> None:
    def f(x: Floats) -> Floats:
        return np.asarray(0.5 - np.sin(x) ** 2)

    def on_curve(n: int) -> float:
        edges = _edges(n)
        ends = _chords(f, edges)
        return _span(lambda t: np.asarray(smooth(edges, ends, f(edges[:-1]), f(edges[1:]), t)), np.linspace(0, tau, 721))

    def converged(n: int) -> float:
        return _span(Quadrature(f, _edges(n), order=4), np.linspace(0, tau, 721))

    ways = (("extremes among the ends of the chords", lambda n: float(np.ptp(_chords(f, _edges(n))))),
            ("smooth curve, extremes between", on_curve), ("limit: 4 Gauss points for each interval", converged))
    for name, way in ways:
        bench.rows(("excess work", name, "chords"), CHORDS, 24, way, lambda n, found: abs(found - 0.5) / 0.5)


# --- flywheel of the shaper: constant force on the working stroke, everything in closed form --------------------------


@dataclass(frozen=True)
class ShaperEnergy:
    """The energy of the shaper over the angle turned, in mpmath, from the numbers of its project file."""

    project: Project

    def swing(self, beta: Any) -> tuple[Any, Any]:
        """Angle of the rocker from the vertical and its derivative by ``beta``, that of the crank, clockwise."""
        r, d = mp.mpf(self.project.variant.crank.length), abs(mp.mpf(self.project.mechanism.fixed["C"].imag))  # type: ignore[union-attr]
        x, y = r * mp.sin(beta), d + r * mp.cos(beta)
        return mp.atan2(x, y), r * (r + d * mp.cos(beta)) / (x * x + y * y)

    def inertia(self, beta: Any) -> Any:
        """Reduced moment of inertia of links 2 to 5, kg m2; the crank is balanced and has none."""
        m = self.project.mechanism
        cd, cs = (mp.mpf(p.distance) for p in m.points)
        angle, rate = self.swing(beta)
        links = m.links
        turning = links["3"].inertia + links["3"].mass * cs**2 + links["4"].mass * cd**2
        return links["2"].mass * mp.mpf(m.crank.length) ** 2 + (turning + links["5"].mass * (cd * mp.cos(angle)) ** 2) * rate**2

    def first(self, mertsalov: bool) -> Any:
        """Moment of inertia of all that turns with the crank, kg m2, in :data:`DIGITS` digits.

        Mertsalov takes the speed for constant in the kinetic energy of the links, Wittenbauer takes its extremes.
        """
        p = self.project
        with mp.workdps(DIGITS):
            cd = mp.mpf(p.mechanism.points[0].distance)
            start = mp.pi / 2 - mp.mpf(p.cycle.start)  # of the crank from the vertical
            start -= 2 * mp.pi * mp.nint(start / (2 * mp.pi))
            r, d = mp.mpf(p.mechanism.crank.length), abs(mp.mpf(p.mechanism.fixed["C"].imag))
            dead = mp.acos(-r / d)
            size, omega, delta = mp.mpf(_FORCE), mp.mpf(p.mechanism.crank.speed), mp.mpf(p.variant.flywheel.delta)  # type: ignore[union-attr]
            stroke = 2 * cd * r / d
            total = mp.mpf(0)
            for sign in (1, -1):
                half = (omega * (1 + (0 if mertsalov else sign * delta / 2))) ** 2 / 2

                def height(t: Any, sign: int = sign, half: Any = half) -> Any:
                    done = size * cd * (mp.sin(self.swing(min(max(start + t, -dead), dead))[0]) + r / d)
                    return sign * (size * stroke * t / (2 * mp.pi) - done - half * self.inertia(start + t))

                grid = sorted([2 * mp.pi * k / 360 for k in range(361)] + [-dead - start, dead - start])
                best = max((t for t in grid if t >= 0), key=height)
                if best not in (-dead - start, dead - start):
                    best = mp.findroot(lambda t, height=height: mp.diff(height, t), best)
                total += height(best)
            return total / (delta * omega**2)


_FORCE = 2800.0
"""The shaper's cutting force, N."""


@cache
def shaper_of(n: int) -> Project:
    """The shaper with that many positions, a multiple of five, three fifths of them on the working stroke."""
    shipped = catalogue.read("lugansk/shaper")
    assert shipped.cycle is not None
    cycle = shipped.cycle.model_copy(update={"working": n * 3 // 5, "idle": n * 2 // 5})
    return Project(shipped.model_copy(update={"cycle": cycle}))


def _inertia(method: type[Flywheel], name: str, n: int) -> float:
    """What a method comes to with that many positions: ``J_first``, or ``J_first_converged`` of its limit."""
    p = shaper_of(n)
    assert p.variant.flywheel is not None
    return float(getattr(method(p.reduced, p.variant.flywheel), name))


def _flywheel(bench: Bench) -> None:
    methods: tuple[tuple[str, type[Flywheel]], ...] = (("Wittenbauer", Wittenbauer), ("Mertsalov", Mertsalov))
    for name, method in methods:
        goal = ShaperEnergy(shaper_of(10)).first(name == "Mertsalov")

        def error(n: int, found: float, goal: Any = goal) -> float:
            return float(abs((found - goal) / goal))

        drawn, converged = (partial(_inertia, method, key) for key in ("J_first", "J_first_converged"))
        bench.rows(("flywheel", f"{name}, construction", "positions"), POSITIONS, 20, drawn, error)
        bench.rows(("flywheel", f"{name}, limit", "positions"), POSITIONS[:1], 20, converged, error)


def rows(bench: Bench) -> None:
    """Graphical integration, excess work, flywheel."""
    for measured in (_integration, _excess, _flywheel):
        measured(bench)
