"""Main dimensions of a cam by the allowed zone of its axis; of a cam under a flat follower by the sum S + S''.

Source: manual 000, section 7, examples 1 to 3; manual 002, 4.3 (both phases limited); manual 003, sheet 2 (side on which
S' is laid off, given eccentricity).

Frame: origin in the start B of the follower's motion, y along that motion, x to the right. In every position the axis O
must lie in a cone: its tip D stands off from the follower's point B by the velocity analogue, at right angles to the
velocity of B, its axis points against that velocity and its half angle is the permitted pressure angle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, degrees, pi, sin, tan
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams.cam_laws import Phase, PositionFunction

Reals = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
Limit = Literal["rise", "both"]
Centre = Literal["vertex", "least"]


# --- cones ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Ray:
    """One border of a cone: its tip, m, the direction into which it runs, and the outward normal of the half-plane."""

    tip: complex
    direction: complex
    normal: complex

    def beyond(self, o: complex) -> float:
        """Distance of ``o`` outside the half-plane, m; negative inside."""
        return float(((o - self.tip) * self.normal.conjugate()).real)


@dataclass(frozen=True)
class Cones:
    """The cones of all positions of some phases.

    ``right`` is +1 where the S' of the rise are laid off to the right, -1 to the left. ``pivot`` and ``turn`` are those of
    a rocker: its axis A, m, and +1 when it rises counter-clockwise, -1 clockwise; a translating follower has none.
    """

    phases: tuple[Phase, ...]
    alpha: float
    right: float
    pivot: complex | None = None
    turn: float = 0.0

    def ups(self, p: Phase, x: Any) -> Any:
        """Direction of the velocity of B in the rise, at shares ``x`` of a phase."""
        s = np.asarray(p.s(x))
        return 1j * np.exp(1j * self.turn * s) if self.pivot is not None else 1j * np.ones(s.shape)

    def starts(self, p: Phase, x: Any) -> Any:
        """Positions of B, m."""
        if self.pivot is None:
            return 1j * np.asarray(p.s(x))
        return self.pivot * (1 - np.exp(1j * self.turn * np.asarray(p.s(x))))

    def tips(self, p: Phase, x: Any) -> Any:
        """Tips D of the cones, m."""
        arm = 1.0 if self.pivot is None else abs(self.pivot)
        return self.starts(p, x) - 1j * self.ups(p, x) * self.right * arm * np.asarray(p.ds(x))

    def curve(self, parts: int = 128) -> Complex:
        """The curve of the tips D, S(S'), for display, m."""
        x = np.linspace(0, 1, parts + 1)
        return np.concatenate([self.tips(p, x) for p in self.phases])

    def _ray(self, p: Phase, x: float, side: float) -> Ray:
        up = complex(self.ups(p, x))
        outwards = complex(sin(self.alpha), side * self.right * cos(self.alpha))
        return Ray(complex(self.tips(p, x)), -up * complex(cos(self.alpha), -side * self.right * sin(self.alpha)), up * outwards)

    def rays(self, parts: int) -> list[Ray]:
        """Borders of the cones in equal parts of every phase."""
        return [self._ray(p, k / parts, side) for p in self.phases for k in range(parts + 1) for side in (1.0, -1.0)]

    def worst(self, o: complex, side: float) -> Ray:
        """The border on one side (+1 limits positive pressure angles) that leaves ``o`` outside furthest."""
        found = []
        for p in self.phases:
            outwards = complex(sin(self.alpha), side * self.right * cos(self.alpha))

            def beyond(x: Reals, p: Phase = p, outwards: complex = outwards) -> Reals:
                return np.asarray(((o - self.tips(p, x)) * np.conjugate(self.ups(p, x) * outwards)).real)

            lo, hi, at = 0.0, 1.0, 0.0
            for n in (129, 33, 33, 33, 33, 33):
                x = np.linspace(lo, hi, n)
                k = int(np.argmax(beyond(x)))
                lo, hi, at = float(x[max(k - 1, 0)]), float(x[min(k + 1, n - 1)]), float(x[k])
            found.append(self._ray(p, at, side))
        return max(found, key=lambda ray: ray.beyond(o))

    @cached_property
    def size(self) -> float:
        """A length typical of the motion, m."""
        return float(np.abs(self.curve(32)).max())

    def _highest(self, corners: list[tuple[complex, Ray | None]]) -> tuple[complex, tuple[Ray | None, ...]]:
        up = 1j * np.exp(0.5j * self.turn * abs(self.phases[0].travel))
        k = max(range(len(corners)), key=lambda k: (corners[k][0] * np.conjugate(up)).real)
        return corners[k][0], (corners[k - 1][1], corners[k][1])

    def _nearest(self, corners: list[tuple[complex, Ray | None]]) -> tuple[complex, tuple[Ray | None, ...]]:
        ends = [(a, corners[(k + 1) % len(corners)][0]) for k, (a, _) in enumerate(corners)]
        if all((a.conjugate() * b).imag > 0 for a, b in ends):
            return 0j, ()
        best: complex = corners[0][0]
        active: tuple[Ray | None, ...] = (corners[-1][1], corners[0][1])
        for k, (a, b) in enumerate(ends):
            ray = corners[k][1]
            along = (-a * (b - a).conjugate()).real / abs(b - a) ** 2 if a != b else 0.0
            if 0 < along < 1 and abs(a + along * (b - a)) < abs(best):
                best, active = a + along * (b - a), (ray, None)
            if abs(a) < abs(best):
                best, active = a, (corners[k - 1][1], ray)
        return best, active

    def corner(self, centre: Centre) -> tuple[complex, tuple[Ray, ...]] | None:
        """A chosen point of the zone common to all cones, with the one or two borders it lies on; None when there is no zone.

        "vertex" is the point of the zone that lies furthest up in the middle of the swing, "least" the one nearest to B.
        Cutting planes: the borders that leave the present choice outside furthest are cut off until none does.
        """
        reach = 20 * self.size / sin(self.alpha)
        corners: list[tuple[complex, Ray | None]] = [(reach * c, None) for c in (-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j)]
        choose = self._highest if centre == "vertex" else self._nearest
        for _ in range(200):
            o, active = choose(corners)
            cuts = [ray for ray in (self.worst(o, 1.0), self.worst(o, -1.0)) if ray.beyond(o) > 2e-15 * self.size]
            if not cuts:
                return o, tuple(ray for ray in active if ray is not None)
            for ray in cuts:
                corners = _clipped(corners, ray)
            if len(corners) < 3:
                return None
        return o, tuple(ray for ray in active if ray is not None)

    def region(self, outline: list[complex], parts: int = 48) -> Complex:
        """What the zone leaves of a polygon (corners counter-clockwise), m, for display."""
        corners: list[tuple[complex, Ray | None]] = [(c, None) for c in outline]
        for ray in self.rays(parts):
            corners = _clipped(corners, ray)
        return np.array([c for c, _ in corners])


def _clipped(corners: list[tuple[complex, Ray | None]], ray: Ray) -> list[tuple[complex, Ray | None]]:
    """A convex polygon cut by a half-plane; each corner carries the border that begins in it."""
    out = [ray.beyond(c) for c, _ in corners]
    kept: list[tuple[complex, Ray | None]] = []
    for k, (a, border) in enumerate(corners):
        b, next_out = corners[(k + 1) % len(corners)][0], out[(k + 1) % len(corners)]
        if out[k] <= 0:
            kept.append((a, border))
        if (out[k] <= 0) != (next_out <= 0):
            cut = a + (b - a) * (out[k] / (out[k] - next_out))
            kept.append((cut, ray if out[k] <= 0 else border))
    return kept


# --- moves of their own -----------------------------------------------------------------------------------------------


def _touched(cones: Cones, side: float, alpha: float) -> complex:
    """Point where a line inclined by ``alpha`` to the S axis touches the curve S(S'), m.

    ``side`` +1 means the side to which the S' of the rise are laid off, -1 the other one. There S' - S tan(alpha), or
    its mirror image, is largest; the root of its derivative is found to the last bit. The start of the curve counts.
    """
    slope = tan(alpha)
    best, value = 0j, 0.0
    for p in cones.phases:
        x = np.linspace(0.0, 1.0, 257)
        k = int(np.argmax(side * p.ds(x) - p.s(x) * slope))
        lo, hi = float(x[max(k - 1, 0)]), float(x[min(k + 1, len(x) - 1)])

        def growth(x: float, p: Phase = p) -> float:
            return float(side * p.dds(x) - p.ds(x) * slope)

        at = _root(growth, lo, hi) if growth(lo) > 0 > growth(hi) else float(x[k])
        if (height := float(side * p.ds(at) - p.s(at) * slope)) > value:
            best, value = complex(cones.right * p.ds(at), p.s(at)), height
    return best


def _root(f: Callable[[float], float], lo: float, hi: float) -> float:
    """Where a falling function crosses zero: bisection until no double lies between."""
    while True:
        middle = (lo + hi) / 2
        if not lo < middle < hi:
            return lo
        if f(middle) > 0:
            lo = middle
        else:
            hi = middle


CURVE = Rule("smooth curve", lambda points, curve: curve, ("point", "point"), "point", "Соединим точки {0} плавной кривой {name}.")
TOUCH = Rule("tangent under an angle", _touched, ("point", "number", "angle"), "point",
             "Под углом {2} к оси S проведём касательную к кривой {0}; точка касания {name}.")
OUTERMOST = Rule("outermost ray", lambda curve, ray: ray.tip, ("point", "direction"), "point",
                 "Крайний из лучей, ограничивающих зону с этой стороны, выходит из точки {name} кривой {0}.")
OUTERMOST_DIRECTION = Rule("direction of the outermost ray", lambda ray: ray.direction, ("direction",), "direction",
                           "Крайний луч {name} проведём под допустимым углом давления к скорости точки B.")
LOWER = Rule("lower of two points", lambda p, q: p if np.imag(p) <= np.imag(q) else q, ("point", "point"), "point",
             "Из точек {0} и {1} ниже лежит {name}: возьмём в ней центр вращения кулачка.")
SIGNED = Rule("abscissa", lambda p, right: right * np.real(p), ("point", "number"), "ordinate", "Измерим отрезок {name} = {value}.")
TURNED = Rule("turn about the axis of the rocker", lambda a, b, angle, sense: a + (b - a) * np.exp(1j * sense * angle),
              ("point", "point", "angle", "number"), "point",
              "Радиусом {0}{1} из точки {0} проведём дугу и повернём линию коромысла на угол {2}: точка {name}.",
              lambda a, v: (Helper("line", a[0], v),))
SUM = Rule("add ordinates", lambda a, b: a + b, ("ordinate", "ordinate"), "ordinate",
           "К ординате S {0} прибавим ординату S'' {1}: ордината {name} = {value}.")
LOWEST = Rule("lowest ordinate", lambda points, law: max(-lowest_sum(law)[0], 0.0), ("length", "direction"), "length",
              "Наименьшая (отрицательная) ордината графика S + S'' даёт r_min = {value}.")
RESERVE = Rule("add a reserve", lambda least, reserve: least + reserve, ("length", "length"), "length",
               "К радиусу {0} прибавим запас Δr = {1}: {name} = {value}.")
LARGEST = Rule("largest ordinate", lambda points, value: value, ("length", "length"), "length",
               "Наибольшая ордината графика S' даёт размер тарелки {name} = {value}.")


# --- translating roller follower --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Zone:
    """Diagram S(S') with the allowed zone of the cam's axis; plan in m, origin in the start of the curve.

    ``points`` are the numbered points of the curve, one step for all of them; ``touching`` those on which the zone's
    borders rest: two, or one where the axis is the foot of a perpendicular.
    """

    plan: Plan
    cones: Cones
    axis: Step
    points: Step
    touching: tuple[Step, ...]
    borders: tuple[Step, ...]
    apex: Step

    @property
    def right(self) -> float:
        """+1 where the S' of the rise are laid off to the right, -1 to the left."""
        return self.cones.right

    @property
    def alpha(self) -> float:
        """Permitted pressure angle, rad."""
        return self.cones.alpha

    @property
    def r0(self) -> float:
        """Smallest radius of the centre profile, m."""
        return float(self.plan["r_0"].value)

    @property
    def s0(self) -> float:
        """Height of the start of a translating follower's motion over the cam's axis, m."""
        return float(self.plan["S_0"].value)

    @property
    def e(self) -> float:
        """Offset of a translating follower, m; positive when it lessens the pressure angle of the rise."""
        return float(self.plan["e"].value)

    @property
    def l0(self) -> float:
        """Distance between the axes of cam and rocker, m."""
        return float(self.plan["l_0"].value)

    def curve(self, parts: int = 128) -> Complex:
        """Smooth curve of the tips, S(S'), m."""
        return self.cones.curve(parts)

    def least(self) -> complex | None:
        """Axis of the least cam: the point of the zone nearest to B, m."""
        found = self.cones.corner("least")
        return None if found is None else found[0]


def _limited(law: PositionFunction, limit: Limit) -> tuple[Phase, ...]:
    return (law.rise,) if limit == "rise" else (law.rise, law.fall)


def zone(law: PositionFunction, alpha: float, limit: Limit, right: float, s: Reals, ds: Reals, e: float | None = None,
         centre: Centre = "vertex") -> Zone:
    """Main dimensions of a translating roller follower; ``s`` and ``ds`` are the ordinates of the numbered positions, m.

    The axis is put in the apex of the zone; with a given eccentricity ``e`` (m) on the follower's line at that distance,
    as high as the zone allows; with ``centre`` = "least" in the point of the zone nearest to B.
    """
    limited = _limited(law, limit)
    cones = Cones(limited, alpha, right)
    n = len(limited) * (law.parts + 1)
    plan = Plan("cam-zone", "Определение основных размеров", "m", law.labels[:n])
    start = plan.add("B", rules.GIVEN, 0j)
    axis = plan.add("A", rules.OFFSET, start, 1j, s[:n], say="На оси S от точки {0} отложим перемещение {2}: точка {name}.")
    points = plan.add("D", rules.OFFSET, axis, complex(right), ds[:n],
                      say="Из точки {0} перпендикулярно к оси S отложим аналог скорости {2}: точка {name}.")
    curve = plan.add("S(S')", CURVE, points, cones)
    touching = [plan.add(name, TOUCH, curve, side, alpha) for name, side in (("K_1", 1.0), ("K_2", -1.0))]
    borders = [plan.add(f"t_{k}", rules.GIVEN_DIRECTION, complex(right * side * sin(alpha), cos(alpha)))
               for k, side in ((1, 1.0), (2, -1.0))]
    if e is not None or centre == "least":
        plan.add("V", rules.LINE_LINE, touching[0], borders[0], touching[1], borders[1],
                 say="Касательные {1} и {3} пересекаются в вершине зоны {name}.")
    if e is not None:
        line = plan.add("e_0", rules.OFFSET, start, complex(right), e,
                        say="На перпендикуляре к оси S от точки {0} отложим эксцентриситет {2}: точка {name}.")
        met = [plan.add(f"O_{k}", rules.LINE_LINE, line, 1j, touch, border,
                        say="Через {0} параллельно оси S проведём прямую до касательной {3} из {2}: точка {name}.")
               for k, touch, border in ((1, touching[0], borders[0]), (2, touching[1], borders[1]))]
        apex = plan.add("O", LOWER, *met)
    elif centre == "least" and len(rays := (cones.corner("least") or (0j, ()))[1]) == 1:
        side = 0 if rays[0].direction.real * right < 0 else 1
        apex = plan.add("O", rules.FOOT, start, touching[side], borders[side],
                        say="Из точки {0} опустим перпендикуляр на касательную {2}: в его основании возьмём центр вращения {name}.")
    else:
        apex = plan.add("O", rules.LINE_LINE, touching[0], borders[0], touching[1], borders[1],
                        say="Касательные {1} и {3} пересекаются в вершине зоны; возьмём в ней центр вращения кулачка {name}.")
    foot = plan.add("C", rules.FOOT, apex, start, 1j, say="Из точки {0} опустим перпендикуляр на ось S: точка {name}.")
    plan.add("S_0", rules.DISTANCE, foot, start, say="Измерим отрезок CB = S_0 = {value}.")
    plan.add("e", SIGNED, apex, right, say="Измерим отрезок CO = e = {value}.")
    plan.add("r_0", rules.DISTANCE, apex, start, say="Измерим отрезок OB = r_0 = {value}.")
    return Zone(plan, cones, axis, points, tuple(touching), tuple(borders), apex)


# --- rocker -----------------------------------------------------------------------------------------------------------


def rocker_zone(law: PositionFunction, arm: float, alpha: float, limit: Limit, right: float, same: bool, psi: Reals,
                dpsi: Reals, centre: Centre = "vertex") -> Zone:
    """Main dimensions of an oscillating roller follower; ``psi`` and ``dpsi`` are the ordinates of the positions, rad.

    ``same``: cam and rocker turn the same way in the rise, so the segments are laid off towards the axis A of the rocker.
    The rocker lies horizontal in position 0 and rises upwards. The vertex of the zone is not always its point nearest
    to B: the least cam is another one then, ``centre`` = "least".

    Raises
    ------
    CannotBuild
        when no point satisfies the limits of all positions; says from which permitted angle on there is one.
    """
    limited = _limited(law, limit)
    side = right if same else -right
    cones = Cones(limited, alpha, right, complex(side * arm), -side)
    n = len(limited) * (law.parts + 1)
    plan = Plan("cam-zone", "Определение основных размеров", "m", law.labels[:n])
    start = plan.add("B_0", rules.GIVEN, 0j)
    pivot = plan.add("A", rules.ALONG, start, complex(side), arm,
                     say="На расстоянии AB = {2} от точки {0} отметим ось коромысла {name}.")
    axis = plan.add("B", TURNED, pivot, start, psi[:n], -side)
    line = plan.add("BA", rules.RAY, axis, pivot)
    where = "к оси A" if same else "на продолжении AB"
    points = plan.add("D", rules.OFFSET, axis, line, (1.0 if same else -1.0) * arm * dpsi[:n],
                      say=f"От точки {{0}} {where} отложим x = AB·ψ' = {{2}}: точка {{name}}.")
    curve = plan.add("D(ψ)", CURVE, points, cones)
    found = cones.corner(centre)
    if found is None:
        raise CannotBuild(
            f"cam.pressure_angle: no axis of the cam keeps the pressure angle of the rocker within {degrees(alpha):g} deg on "
            + ("the rise" if limit == "rise" else "the rise and the fall"), _wider(cones))
    touching, borders = [], []
    for k, ray in enumerate(found[1], 1):
        touching.append(plan.add(f"K_{k}", OUTERMOST, curve, ray))
        borders.append(plan.add(f"t_{k}", OUTERMOST_DIRECTION, ray))
    if len(touching) == 1:
        apex = plan.add("O", rules.FOOT, start, touching[0], borders[0],
                        say="Из точки {0} опустим перпендикуляр на луч {2}: в его основании возьмём центр вращения {name}.")
    else:
        apex = plan.add("O", rules.LINE_LINE, touching[0], borders[0], touching[1], borders[1],
                        say="Крайние лучи {1} и {3} пересекаются в вершине зоны; возьмём в ней центр вращения кулачка {name}.")
    plan.add("r_0", rules.DISTANCE, apex, start, say="Измерим отрезок OB_0 = r_0 = {value}.")
    plan.add("l_0", rules.DISTANCE, apex, pivot, say="Измерим отрезок OA = l_0 = {value}.")
    return Zone(plan, cones, axis, points, tuple(touching), tuple(borders), apex)


def _wider(cones: Cones) -> str:
    """Hint: the least permitted angle, in whole degrees, with which there is a zone."""
    low, high = ceil(degrees(cones.alpha)), 90
    while high - low > 1:
        middle = (low + high) // 2
        there = Cones(cones.phases, middle * pi / 180, cones.right, cones.pivot, cones.turn).corner("vertex") is not None
        low, high = (low, middle) if there else (middle, high)
    if high < 90:
        return f"it can be had from {high} deg on; or take longer phases, a smaller swing"
    return "take longer phases or a smaller swing"


# --- flat follower ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Plate:
    """Dimensions of a cam under a flat follower and of its plate; plan in m."""

    plan: Plan
    sums: Step

    @property
    def r0(self) -> float:
        """Smallest radius of the cam, m."""
        return float(self.plan["r_0"].value)

    @property
    def r_min(self) -> float:
        """Radius below which the profile would not be convex, m."""
        return float(self.plan["r_min"].value)

    @property
    def l1(self) -> float:
        """Reach of the plate to the side of the contact in the rise, m."""
        return float(self.plan["l_1"].value)

    @property
    def l2(self) -> float:
        """Reach of the plate to the side of the contact in the fall, m."""
        return float(self.plan["l_2"].value)


def lowest_sum(law: PositionFunction) -> tuple[float, float]:
    """Least S + S'' over a turn, m, with the cam angle, rad; both values of S'' count where it jumps."""
    best = (float("inf"), 0.0)
    for p in law.phases:
        for a, b in zip((0.0, *p.law.jumps), (*p.law.jumps, 1.0), strict=True):
            lo, hi = a + 1e-14, b - 1e-14
            for n in (257, 33, 33, 33, 33):
                x = np.linspace(lo, hi, n)
                total = p.s(x) + p.dds(x)
                k = int(np.argmin(total))
                lo, hi = float(x[max(k - 1, 0)]), float(x[min(k + 1, n - 1)])
            best = min(best, (float(total[k]), float(p.phi(x[k]))))
    return best


def plate(law: PositionFunction, s: Reals, ds: Reals, dds: Reals, base_radius: float | None) -> Plate:
    """Dimensions of the cam and the plate; ``s``, ``ds`` and ``dds`` are the ordinates of the numbered positions, m.

    Without a given radius the reserve is a tenth of r_min or more, and the radius not less than half the stroke, rounded
    up to a millimetre.

    Raises
    ------
    CannotBuild
        when the given radius makes the profile concave or pointed.
    """
    plan = Plan("cam-plate", "Определение основных размеров", "m", law.labels)
    sums = plan.add("S+S''", SUM, s, dds)
    least = plan.add("r_min", LOWEST, sums, law)
    r_min, at = -lowest_sum(law)[0], lowest_sum(law)[1]
    if base_radius is None:
        radius = max(1.1 * r_min, 0.5 * law.stroke)
        unit = 1e-3 if radius > 5e-3 else 1e-4
        base_radius = ceil(radius / unit * (1 - 1e-12)) * unit
    if not base_radius > r_min:
        raise CannotBuild(
            f"cam.base_radius: with {base_radius * 1e3:g} mm the profile has a cusp at {degrees(at):.1f} deg: a flat follower "
            f"needs more than {r_min * 1e3:.4g} mm here", f"take {ceil(1100 * r_min)} mm or leave cam.base_radius out")
    plan.add("r_0", RESERVE, least, base_radius - max(r_min, 0.0))
    x = np.linspace(0, 1, 2001)
    plan.add("l_1", LARGEST, np.maximum(ds, 0), float(law.rise.ds(x).max()))
    plan.add("l_2", LARGEST, np.maximum(-ds, 0), float(-law.fall.ds(x).min()))
    return Plate(plan, sums)
