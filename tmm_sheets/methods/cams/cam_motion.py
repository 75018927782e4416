"""Law of motion of the follower and its three diagrams by two graphical integrations.

Source: manual 000, section 7.1 (amplitudes, auxiliary circle of the law, poles, scale factors); manual 002, section
4.2.3 (each curved trapezoid replaced by a rectangle of equal area, so that the chord ends lie on the integral curve).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import degrees, radians
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import Scale, fit, handy
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.methods.cams.cam_laws import Phase, PositionFunction
from tmm_sheets.methods.integration import integrate, ordinates, smooth

Reals = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

_INSIDE = 1e-12
"""A share of a phase: how far inside a border one-sided limits are read."""
GAP = 6.0
"""Clear distance between the pole of S'' and the auxiliary circle, mm."""
BESIDE = GAP + 3.0 + 14.0
"""Width that axes need beyond the phases, the pole distance and the circle, mm."""
BARE = 8.0
"""Width that axes need beyond the phases and the pole distance where there is no circle, mm."""
LEAST_POLE = 7.0
"""Pole distance below which rays become too steep to draw well, mm."""

AMPLITUDE = Rule("amplitude by proportion", lambda a, phase, other: a * (phase / other) ** 2, ("length", "angle", "angle"),
                 "length", "Из пропорции a_1/a_2 = φ_с²/φ_у² найдём вторую амплитуду {name} = {value}.")
EQUAL_STROKE = Rule("amplitude for an equal stroke", lambda a: a, ("length",), "length",
                    "Из условия равенства ходов при разных законах найдём вторую амплитуду {name} = {value}.")
ORDINATE = Rule("lay off an ordinate", lambda x, y: x + 1j * y, ("ordinate", "ordinate"), "point",
                "На вертикали с абсциссой {0} отложим ординату закона {1}: точка {name}.",
                lambda a, v: (Helper("line", complex(a[0], 0), v),))
ACROSS = Rule("carry across", lambda p, x: x + 1j * np.imag(p), ("point", "ordinate"), "point",
              "Точку {0} перенесём горизонталью на вертикаль с абсциссой {1}: точка {name}.",
              lambda a, v: (Helper("line", a[0], v),))
EQUAL_AREA = Rule("rectangle of equal area", lambda area, width: area / width, ("number", "length"), "ordinate",
                  "Криволинейную трапецию площадью {0} мм² заменим прямоугольником той же площади и той же ширины {1}; "
                  "его высота {name} = {value}.")


@dataclass(frozen=True)
class MotionScales:
    """Scale factors of the three diagrams; the pole distances (mm) follow from them."""

    phi: Scale
    dds: Scale
    ds: Scale
    s: Scale

    @property
    def h1(self) -> float:
        """Pole distance of the integration of S'', mm (mu_S'' = mu_S'/(mu_phi H1))."""
        return self.ds.mu / (self.dds.mu * self.phi.mu)

    @property
    def h2(self) -> float:
        """Pole distance of the integration of S', mm (mu_S' = mu_S/(mu_phi H2))."""
        return self.s.mu / (self.ds.mu * self.phi.mu)


def motion_scales(law: PositionFunction, width: float, height: float, equal: bool = False) -> MotionScales:
    """Handy scale factors with which the three diagrams, one under another, fill ``width`` x ``height`` mm.

    The phases take at most 0.68 of the width; the auxiliary circle of the law, where it has one, and the pole share the
    rest on their left. S'' takes at most 0.3 of the height; of the pairs of scale factors of S' and S the one that uses most
    of the rest is taken. With ``equal`` all three diagrams have one scale factor: both pole distances are 1/mu_phi (manual
    000, 7 ex. 3).
    """
    shares = np.linspace(0, 1, 65)
    spans = float(np.abs(law.rise.ds(shares)).max() + np.abs(law.fall.ds(shares)).max()), law.stroke
    return (_equal_scales if equal else _own_scales)(law, spans, width, height)


def _finest(law: PositionFunction, width: float) -> float:
    """Finest scale of the angle axis, degrees per mm: the phases leave room for what stands on their left."""
    return handy(degrees(law.fall.end) / (0.68 * width))


def _left_of_axis(law: PositionFunction) -> tuple[float, float]:
    """What stands there: the room between axis and pole, mm, and the diameters of the auxiliary circle in amplitudes of S''."""
    return (BESIDE, 2.0) if has_circle(law) else (BARE, 0.0)


def _equal_scales(law: PositionFunction, spans: tuple[float, float], width: float, height: float) -> MotionScales:
    """One scale factor for all three diagrams."""
    amplitude = max(law.rise.amplitude, law.fall.amplitude)
    beside, circle = _left_of_axis(law)
    tall = 2 * amplitude + sum(spans)
    pairs = [(Scale("μ_φ", radians(deg), "рад/мм"), mu) for mu in _coarser(tall / height)
             for deg in _coarser(_finest(law, width))]

    def free(phi: Scale, mu: float) -> float:
        return width - float(phi.mm(law.fall.end)) - beside - circle * amplitude / mu - 1 / phi.mu

    phi, mu = min([p for p in pairs if free(*p) >= 0] or pairs[-1:], key=lambda p: p[0].mu ** 1.5 * p[1])
    return MotionScales(phi, *(Scale(f"μ_{law.symbol}{primes}", mu, "м/мм") for primes in ("''", "'", "")))


def _own_scales(law: PositionFunction, spans: tuple[float, float], width: float, height: float) -> MotionScales:
    """A scale factor for each diagram; ``spans``: what S' and S need, in their units."""
    finest = _finest(law, width)
    amplitude = max(law.rise.amplitude, law.fall.amplitude)
    beside, circle = _left_of_axis(law)
    unit, of = ("м/мм", "м/мм") if law.symbol == "S" else ("рад/мм", "1/мм")
    phi = Scale("μ_φ", radians(finest), "рад/мм")
    left = width - phi.mm(law.fall.end) - beside
    dds = fit(f"μ_{law.symbol}''", of, amplitude, min((left - LEAST_POLE - 5.0) / 2, 0.15 * height) if circle else 0.15 * height)
    room = height - 2 * dds.mm(amplitude)
    found = [(a, b) for a in _coarser(spans[0] / (0.55 * height)) for b in _coarser(spans[1] / (0.42 * height))
             if spans[0] / a + spans[1] / b <= room]
    poles = [(a / (dds.mu * phi.mu), b / (a * phi.mu)) for a, b in found]
    # Rays from a very near pole are hard to draw, though short phases need near ones; the pole of S'' stands beside the circle.
    nearest = min(LEAST_POLE, 0.12 * phi.mm(min(law.rise.angle, law.fall.angle)))
    fits = [p for p, (h1, h2) in zip(found, poles, strict=True) if h1 <= left - circle * dds.mm(amplitude) and h2 <= left - 6.0]
    good = [p for p, h in zip(found, poles, strict=True) if p in fits and min(h) >= nearest]

    def filling(pair: tuple[float, float]) -> tuple[int, float]:
        high, low = spans[0] / pair[0], spans[1] / pair[1]
        return round(high + low), -abs(high - low)

    ds, s = max(good or fits or found, key=filling)
    return MotionScales(phi, dds, Scale(f"μ_{law.symbol}'", ds, of), Scale(f"μ_{law.symbol}", s, unit))


def has_circle(law: PositionFunction) -> bool:
    """True when the law of a phase is constructed by an auxiliary circle."""
    return any(p.law.division is not None for p in (law.rise, law.fall))


def _coarser(least: float) -> list[float]:
    """The four smallest handy scale factors that are not less than ``least``."""
    series = [handy(least)]
    while len(series) < 4:
        series.append(handy(series[-1] * 1.001))
    return series


@dataclass(frozen=True)
class FollowerMotion:
    """The diagrams S'', S' and S on paper: points in mm, each diagram from its own origin.

    ``dds``, ``ds`` and ``s`` hold the steps of the numbered positions, ``circle`` those of the auxiliary circle by the
    number of the position, for the phases whose law has one.
    """

    law: PositionFunction
    scales: MotionScales
    plan: Plan
    circle: dict[int, Step]
    dds: list[Step]
    ds: list[Step]
    s: list[Step]

    def measured(self, steps: list[Step], scale: Scale) -> Reals:
        """Ordinates of a diagram at the numbered positions in SI."""
        return np.asarray(scale.real(ordinates(steps)))

    @property
    def names(self) -> tuple[str, str, str]:
        """Symbols of the second derivative, the first derivative and the displacement."""
        return f"{self.law.symbol}''", f"{self.law.symbol}'", self.law.symbol

    def curve_dds(self, parts: int = 64) -> Complex:
        """Smooth curve S'' from position 0 to 16 for display, mm; it starts and ends on the axis."""
        points = []
        for p in self.law.phases[:-1] if self.law.lower_dwell.angle else self.law.phases:
            for a, b in zip((0.0, *p.law.jumps), (*p.law.jumps, 1.0), strict=True):
                x = np.linspace(a + _INSIDE, b - _INSIDE, parts + 1)
                points.append(self._paper(p.phi(x), p.dds(x), self.scales.dds))
        return np.concatenate(([0j], *points, [complex(points[-1][-1].real)]))

    def curve_ds(self, parts: int = 64) -> Complex:
        """Smooth curve S' through the chord ends for display, mm."""
        return self._smooth(self.ds, Phase.dds, self.scales.dds, self.scales.h1, parts)

    def curve_s(self, parts: int = 64) -> Complex:
        """Smooth curve S through the chord ends for display, mm."""
        return self._smooth(self.s, Phase.ds, self.scales.ds, self.scales.h2, parts)

    def _paper(self, phi: Any, y: Any, scale: Scale) -> Complex:
        return np.asarray(self.scales.phi.mm(phi) + 1j * scale.mm(y))

    def _smooth(self, ends: list[Step], slope: Callable[[Phase, Any], Any], scale: Scale, pole: float, parts: int) -> Complex:
        points = []
        n, shares = self.law.parts, self.law.shares
        for p, steps in ((self.law.rise, ends[: n + 1]), (self.law.fall, ends[n + 1 :])):
            edges, x = self.scales.phi.mm(p.phi(shares)), np.linspace(0, 1, parts + 1)
            left, right = (scale.mm(slope(p, s)) / pole for s in (shares[:-1] + _INSIDE, shares[1:] - _INSIDE))
            at = np.clip(self.scales.phi.mm(p.phi(x)), edges[0], edges[-1])
            points.append(at + 1j * smooth(edges, ordinates(steps), left, right, at))
        return np.concatenate(points)


def motion(law: PositionFunction, scales: MotionScales) -> FollowerMotion:
    """Record the construction of the three diagrams: auxiliary circle, two integrations with rays and chords."""
    plan = Plan("cam-motion", "Графики движения толкателя" if law.symbol == "S" else "Графики движения коромысла", "mm")
    x = [float(v) for v in scales.phi.mm(law.positions)]
    circle, dds = _acceleration(plan, law, scales, x)
    # Where there is no upper dwell, 8 and 8' are one point and there is nothing to integrate between them.
    top = law.parts
    kept = [k for k in range(len(x)) if k != top + 1 or law.upper_dwell.angle > 0]
    borders = [x[k] for k in kept]
    names = [law.labels[k] for k in kept]
    ds = _integral(plan, f"{law.symbol}'", _growth(law, Phase.ds), scales.dds, scales.phi, borders, scales.h1, names)
    s = _integral(plan, law.symbol, _growth(law, Phase.s), scales.ds, scales.phi, borders, scales.h2, names)
    place = {k: i for i, k in enumerate(kept)}
    place.setdefault(top + 1, place[top])
    every = [place[k] for k in range(len(x))]
    return FollowerMotion(law, scales, plan, circle, dds, [ds[i] for i in every], [s[i] for i in every])


def _acceleration(plan: Plan, law: PositionFunction, scales: MotionScales, x: list[float]) -> tuple[dict[int, Step], list[Step]]:
    """Points of the auxiliary circle and of S'' in the numbered positions."""
    names = {law.rise: "a_1", law.fall: "a_2"}
    high, low = sorted(names, key=lambda p: p.amplitude, reverse=True)
    amplitude = {high: plan.add(names[high], rules.GIVEN_LENGTH, float(scales.dds.mm(high.amplitude)))}
    if high.law.peak == low.law.peak:
        amplitude[low] = plan.add(names[low], AMPLITUDE, amplitude[high], high.angle, low.angle)
    else:
        amplitude[low] = plan.add(names[low], EQUAL_STROKE, float(scales.dds.mm(low.amplitude)))
    circle, points = {}, []
    if has_circle(law):
        widest = max(p.amplitude for p in names if p.law.division is not None)
        centre = plan.add("M", rules.GIVEN, -(scales.h1 + GAP + float(scales.dds.mm(widest))) + 0j)
    for k, label in enumerate(law.labels):
        phase, share = (law.rise, law.shares[k]) if k <= law.parts else (law.fall, law.shares[k - law.parts - 1])
        name = f"{law.symbol}''_{label}"
        if phase.law.division is None:
            points.append(plan.add(name, ORDINATE, x[k], float(scales.dds.mm(phase.dds(share)))))
            continue
        angle = float(np.sign(phase.travel) * phase.law.division(share))
        circle[k] = plan.add(f"K_{label}", rules.LAY_OFF, centre, amplitude[phase], angle)
        points.append(plan.add(name, ACROSS, circle[k], x[k]))
    return circle, points


def _growth(law: PositionFunction, integral: Callable[[Phase, Any], Any]) -> Reals:
    """Growth of an integral of the law from border to border, m; nothing in the upper dwell."""
    dwell = [0.0] if law.upper_dwell.angle > 0 else []
    return np.concatenate((np.diff(integral(law.rise, law.shares)), dwell, np.diff(integral(law.fall, law.shares))))


def _integral(plan: Plan, symbol: str, growth: Reals, scale: Scale, phi: Scale, borders: list[float], pole: float,
              names: list[str]) -> list[Step]:
    """Integrate by the rectangles whose areas are the exact ones of the law."""
    areas = growth / (scale.mu * phi.mu)
    heights = [plan.add(f"h{symbol}_{name}", EQUAL_AREA, float(area), b - a)
               for name, area, (a, b) in zip(names[1:], areas, pairwise(borders), strict=True)]
    return integrate(plan, f"{symbol}_", borders, heights, pole, borders=names, intervals=names[1:])
