"""Main dimensions of a cam by the allowed zone of its axis; of a cam under a flat follower by the sum S + S''.

Source: manual 000, section 7, examples 1 to 3; manual 002, 4.3 (both phases limited); manual 003, sheet 2 (side on which
S' is laid off, given eccentricity).

Frame: origin in the start B of the follower's motion, y along that motion, x to the right. In every position the axis O
must lie in a cone: its tip D stands off from the follower's point B by the velocity analogue, at right angles to the
velocity of B, its axis points against that velocity and its half angle is the permitted pressure angle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, cos, degrees, pi, sin, tan
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import rules
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams.cam_displacement import (
    AT_SHARE,
    KINDS,
    SOURCE,
    ExactMotion,
    Phases,
    in_phase,
    names,
)
from tmm_sheets.methods.cams.cam_laws import Phase, PositionFunction
from tmm_sheets.numbers import fixed

Reals = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
Limit = Literal["rise", "both"]
Centre = Literal["vertex", "least"]


# --- arithmetic of the cones ---------------------------------------------------------------------------------------------


def _up(psi: Any, turn: Any) -> Any:
    """Direction of the velocity of B of a rocker in the rise; it lies horizontal at ``psi`` 0."""
    return 1j * np.exp(1j * turn * psi)


def _swung(pivot: Any, psi: Any, turn: Any) -> Any:
    """Position of B of a rocker, m."""
    return pivot * (1 - np.exp(1j * turn * psi))


def _tip(b: Any, up: Any, right: Any, arm: Any, ds: Any) -> Any:
    """Tip D of the cone of B, m."""
    return b - 1j * up * right * arm * ds


def _ray_direction(up: Any, alpha: Any, side: Any) -> Any:
    """Direction of a border of the cone."""
    return -up * (np.cos(alpha) - 1j * side * np.sin(alpha))


# --- cones ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Ray:
    """One border of a cone: its tip, m, the direction into which it runs, and the outward normal of the half-plane.

    ``phase``, ``x`` and ``side`` tell which: that of a share of a phase, +1 limits positive pressure angles.
    """

    tip: complex
    direction: complex
    normal: complex
    phase: Phase
    x: float
    side: float

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
        return _up(s, self.turn) if self.pivot is not None else 1j * np.ones(s.shape)

    def starts(self, p: Phase, x: Any) -> Any:
        """Positions of B, m."""
        if self.pivot is None:
            return 1j * np.asarray(p.s(x))
        return _swung(self.pivot, np.asarray(p.s(x)), self.turn)

    def tips(self, p: Phase, x: Any) -> Any:
        """Tips D of the cones, m."""
        arm = 1.0 if self.pivot is None else abs(self.pivot)
        return _tip(self.starts(p, x), self.ups(p, x), self.right, arm, np.asarray(p.ds(x)))

    def _ray(self, p: Phase, x: float, side: float) -> Ray:
        up = complex(self.ups(p, x))
        outwards = complex(sin(self.alpha), side * self.right * cos(self.alpha))
        return Ray(complex(self.tips(p, x)), complex(_ray_direction(up, self.alpha, side * self.right)), up * outwards, p, x, side)

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
        x = np.linspace(0, 1, 33)
        return float(max(np.abs(self.tips(p, x)).max() for p in self.phases))

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
        last = None
        for _ in range(200):
            o, active = choose(corners)
            cuts = [ray for ray in (self.worst(o, 1.0), self.worst(o, -1.0)) if ray.beyond(o) > 2e-15 * self.size]
            if not cuts or o == last:  # where the borders cross flatly, the choice rests before the cuts become nothing
                return o, tuple(ray for ray in active if ray is not None)
            last = o
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


def _touched(cones: Cones, side: float) -> tuple[Phase, float]:
    """Phase and share where a line inclined by the permitted angle to the S axis touches the curve S(S').

    ``side`` +1 means the side to which the S' of the rise are laid off, -1 the other one. There S' - S tan(alpha), or
    its mirror image, is largest; the root of its derivative is found to the last bit. The start of the curve counts.
    """
    slope = tan(cones.alpha)
    best, value = (cones.phases[0], 0.0), 0.0
    for p in cones.phases:
        x = np.linspace(0.0, 1.0, 257)
        k = int(np.argmax(side * p.ds(x) - p.s(x) * slope))
        lo, hi = float(x[max(k - 1, 0)]), float(x[min(k + 1, len(x) - 1)])

        def growth(x: float, p: Phase = p) -> float:
            return float(side * p.dds(x) - p.ds(x) * slope)

        at = _root(growth, lo, hi) if growth(lo) > 0 > growth(hi) else float(x[k])
        if (height := float(side * p.ds(at) - p.s(at) * slope)) > value:
            best, value = (p, at), height
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


@primitive("lower point")
def _lower(p: Any, q: Any) -> Any:
    return np.where(np.imag(p) <= np.imag(q), p, q)[()]


CURVE = Rule("curve of the analogues", lambda s, ds, right: right * ds + 1j * s, ("ordinate", "ordinate", "number"), "point",
             "Точки с ординатами S и абсциссами S' соединим плавной кривой {name}.", source=SOURCE)
ROCKER_CURVE = Rule("curve of the analogues of a rocker", lambda psi, dpsi, pivot, turn, right, arm: _tip(
    _swung(pivot, psi, turn), _up(psi, turn), right, arm, dpsi), ("inclination", "number", "point", "number", "number", "length"),
    "point",
    "Концы отрезков AB·ψ', отложенных на линиях коромысла, соединим плавной кривой {name}.", source=SOURCE)
TOUCH = Rule("tangent under an angle", lambda s, ds, right: right * ds + 1j * s, ("ordinate", "ordinate", "number"), "point",
             "Под допустимым углом давления к оси S проведём касательную к кривой S(S'); точка касания {name}.")
INCLINED = Rule("direction under the permitted angle", lambda alpha, side: side * np.sin(alpha) + 1j * np.cos(alpha),
                ("angle", "number"),
                "direction", "Проведём направление {name}.")
OUTERMOST = Rule("outermost ray", ROCKER_CURVE.compute, ROCKER_CURVE.takes, "point",
                 "Крайний из лучей, ограничивающих зону с этой стороны, выходит из точки {name} кривой D(ψ).")
OUTERMOST_DIRECTION = Rule("direction of the outermost ray",
                           lambda psi, turn, alpha, side: _ray_direction(_up(psi, turn), alpha, side),
                           ("inclination", "number", "angle", "number"), "direction",
                           "Крайний луч {name} проведём под допустимым углом давления к скорости точки B.")
LOWER = Rule("lower of two points", _lower, ("point", "point"), "point",
             "Из точек {0} и {1} ниже лежит {name}: возьмём в ней центр вращения кулачка.")
SIGNED = Rule("abscissa", lambda p, right: right * np.real(p), ("point", "number"), "ordinate", "Измерим отрезок {name} = {value}.")
TURNED = Rule("turn about the axis of the rocker", lambda a, b, angle, sense: a + (b - a) * np.exp(1j * sense * angle),
              ("point", "point", "angle", "number"), "point",
              "Радиусом {0}{1} из точки {0} проведём дугу и повернём линию коромысла на угол {2}: точка {name}.",
              lambda a, v: (Helper("line", a[0], v),))
SUM = Rule("add ordinates", lambda a, b: a + b, ("ordinate", "ordinate"), "ordinate",
           "К ординате S {0} прибавим ординату S'' {1}: ордината {name} = {value}.")
FIRST = {symbol: tuple(
    Rule(f"ordinates of the limited phases, {('displacement', 'first derivative')[i]}{' of a rocker' if symbol == 'ψ' else ''}",
         rules.take, (kind, "number"), kind, "Ордината графика {name} = {value}.", unit="" if symbol == "S" else ("rad", "1")[i])
    for i, kind in enumerate(kinds[:2])) for symbol, kinds in KINDS.items()}
ALONG_ROCKER = Rule("analogue on the rocker", lambda sign, arm, dpsi: sign * arm * dpsi, ("number", "length", "number"), "ordinate",
                    "Отрезок {name} = AB·ψ' = {value}.", source=SOURCE)
LOWEST_SUM = Rule("lowest sum", lambda s, dds: s + dds, ("ordinate", "ordinate"), "ordinate",
                  "Наименьшая (отрицательная) ордината графика {name} = {0} + {1} = {value}.")
LOWEST = Rule("lowest ordinate", lambda total: np.maximum(-total, 0.0), ("ordinate",), "length",
              "Наименьшая (отрицательная) ордината графика S + S'' даёт r_min = {value}.")
NEEDED = Rule("radius with a reserve", lambda total, stroke: np.maximum(1.1 * -total, 0.5 * stroke), ("ordinate", "length"),
              "length",
              "С запасом в десятую долю r_min, но не меньше половины хода: {name} = {value}.", source=SOURCE)


@primitive("rounded up to a millimetre")
def rounded_up(radius: Any) -> Any:
    """Radius, m, rounded up to a millimetre, a very small one to a tenth."""
    unit = 1e-3 if radius > 5e-3 else 1e-4
    return ceil(radius / unit * (1 - 1e-12)) * unit


ROUNDED = Rule("rounded radius", rounded_up, ("length",), "length", "Округлим до целого миллиметра: {name} = {value}.")
CHOSEN = Rule("given radius", lambda radius: radius, ("length",), "length", "По заданию {name} = {value}.")
RESERVE = Rule("reserve", lambda radius, least: radius - least, ("length", "length"), "length",
               "Запас {name} = {0} − {1} = {value}.")
RESERVED = Rule("add a reserve", lambda least, reserve: least + reserve, ("length", "length"), "length",
                "К радиусу {0} прибавим запас Δr = {1}: {name} = {value}.")
LARGEST = Rule("largest ordinate", np.abs, ("ordinate",), "length",
               "Наибольшая ордината графика S' даёт размер тарелки {name} = {value}.")
SHARPEST = Rule("least radius of curvature", lambda radius, total: radius + total, ("length", "ordinate"), "length",
                "Наименьший радиус кривизны профиля {name} = r_0 + (S + S'')_min = {value}.", source=SOURCE)
CHOICE = Rule("share found", lambda x: x, ("number",), "number", "Место найдём перебором: доля фазы {name} = {value}.", unit="1")


def found_share(plan: Plan, at: Phases, phase: Phase, x: float, tag: str, choice: str) -> Step:
    """Record the share of a phase that a search found by the criterion ``choice``, and the cam angle there."""
    share = plan.add(f"x_{tag}", CHOICE, Given(x, f"x_{tag}", choice=choice, over="none", unit="1"), symbol=f"x_{{{tag}}}",
                     say=f"Перебором найдём место, где {choice}: доля фазы {{name}} = {{value}}.")
    start, angle, _, _ = at.of[phase.symbol]
    plan.add(f"φ_{tag}", AT_SHARE, start, angle, share, symbol=f"φ_{{{tag}}}")
    return share


# --- translating roller follower --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Zone:
    """Diagram S(S') with the allowed zone of the cam's axis; plan in m, origin in the start of the curve.

    ``points`` are the numbered points of the curve, one step for all of them; ``touching`` those on which the zone's
    borders rest: two, or one where the axis is the foot of a perpendicular. ``plans`` are all plans in the order of construction.
    """

    plan: Plan
    plans: dict[str, Plan]
    exact: ExactMotion
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

    @cached_property
    def curve_plan(self) -> Plan:
        """Plan of the smooth curve of the tips."""
        x = np.linspace(0, 1, 129)
        phi = np.concatenate([p.phi(x) for p in self.cones.phases])
        at = self.exact.at("cam-zone-between", "Кривая аналогов", phi, "узлы плавной кривой")
        if self.cones.pivot is None:
            at.plan.add("S(S')", CURVE, at.s, at.ds, self.right)
        else:
            at.plan.add("D(ψ)", ROCKER_CURVE, at.s, at.ds, *self.swing)
        return at.plan

    @property
    def curve(self) -> Step:
        """Smooth curve of the tips, S(S'), m: a row of points."""
        return self.curve_plan["S(S')" if self.cones.pivot is None else "D(ψ)"]

    @property
    def swing(self) -> tuple[Any, ...]:
        """Axis of the rocker, sense of its rise, side of its analogues and its arm."""
        return self.plan["A"], self.cones.turn, self.cones.right, self.plan["A"].args[2]

    @cached_property
    def least(self) -> Plan | None:
        """Axis of the least cam of a rocker: the point O of the zone nearest to B, with r_0 and l_0; None where there is none."""
        found = self.cones.corner("least")
        if found is None:
            return None
        plan = Plan("cam-zone-least", "Наименьший возможный кулачок", "m")
        _rocker_axis(plan, self, found[1])
        return plan


def _limited(law: PositionFunction, limit: Limit) -> tuple[Phase, ...]:
    return (law.rise,) if limit == "rise" else (law.rise, law.fall)


def _limited_ordinates(law: PositionFunction, s: Any, ds: Any, n: int) -> tuple[Plan, Step, Step]:
    """Ordinates of the limited phases only."""
    plan = Plan("cam-zone-ordinates", "Ординаты графиков для построения зоны", "m", law.labels[:n])
    first = Given(np.arange(float(n)), "cam.limit", choice="положения фаз, в которых ограничен угол давления")
    zero, one, _ = names(law.symbol)
    rules_of = FIRST[law.symbol]
    return plan, plan.add(zero, rules_of[0], s, first), plan.add(one, rules_of[1], ds, first)


def zone(law: PositionFunction, alpha: float, limit: Limit, right: float, s: Any, ds: Any, e: float | None = None,
         centre: Centre = "vertex", exact: ExactMotion | None = None) -> Zone:
    """Main dimensions of a translating roller follower; ``s`` and ``ds`` are the ordinates of the numbered positions, m.

    The axis is put in the apex of the zone; with a given eccentricity ``e`` (m) on the follower's line at that distance,
    as high as the zone allows; with ``centre`` = "least" in the point of the zone nearest to B.
    """
    exact = exact or ExactMotion(law)
    limited = _limited(law, limit)
    cones = Cones(limited, alpha, right)
    n = len(limited) * (law.parts + 1)
    rows, s, ds = _limited_ordinates(law, s, ds, n)
    touch = Plan("cam-zone-touch", "Точки касания границ зоны", "m")
    plan = Plan("cam-zone", "Определение основных размеров", "m", law.labels[:n])
    start = plan.add("B", rules.GIVEN, 0j)
    axis = plan.add("A", rules.OFFSET, start, 1j, s, say="На оси S от точки {0} отложим перемещение {2}: точка {name}.")
    points = plan.add("D", rules.OFFSET, axis, complex(right), ds,
                      say="Из точки {0} перпендикулярно к оси S отложим аналог скорости {2}: точка {name}.")
    touching = []
    for name, side in (("K_1", 1.0), ("K_2", -1.0)):
        phase, x = _touched(cones, side)
        share = found_share(touch, exact.phases, phase, x, name, ("S'" if side > 0 else "−S'") + " − S·tg[α] наибольшее")
        at = in_phase(touch, law, exact.phases, phase, share, name, (0, 1))
        drawn = "Соединим точки D плавной кривой S(S'). " if side > 0 else ""
        touching.append(plan.add(name, TOUCH, *at, right, say=f"{drawn}Под углом {fixed(degrees(alpha), 1)}° к оси S проведём "
                                 "касательную к кривой S(S'); точка касания {name}."))
    borders = [plan.add(f"t_{k}", INCLINED, alpha, right * side) for k, side in ((1, 1.0), (2, -1.0))]
    if e is not None or centre == "least":
        plan.add("V", rules.LINE_LINE, touching[0], borders[0], touching[1], borders[1],
                 say="Касательные {1} и {3} пересекаются в вершине зоны {name}.")
    if e is not None:
        line = plan.add("e_0", rules.OFFSET, start, complex(right), e,
                        say="На перпендикуляре к оси S от точки {0} отложим эксцентриситет {2}: точка {name}.")
        met = [plan.add(f"O_{k}", rules.LINE_LINE, line, 1j, touch_, border,
                        say="Через {0} параллельно оси S проведём прямую до касательной {3} из {2}: точка {name}.")
               for k, touch_, border in ((1, touching[0], borders[0]), (2, touching[1], borders[1]))]
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
    plans = {p.name: p for p in (rows, touch, plan)}
    return Zone(plan, plans, exact, cones, axis, points, tuple(touching), tuple(borders), apex)


# --- rocker -----------------------------------------------------------------------------------------------------------


def rocker_zone(law: PositionFunction, arm: float, alpha: float, limit: Limit, right: float, same: bool, psi: Any,
                dpsi: Any, centre: Centre = "vertex", exact: ExactMotion | None = None) -> Zone:
    """Main dimensions of an oscillating roller follower; ``psi`` and ``dpsi`` are the ordinates of the positions, rad.

    ``same``: cam and rocker turn the same way in the rise, so the segments are laid off towards the axis A of the rocker.
    The rocker lies horizontal in position 0 and rises upwards. The vertex of the zone is not always its point nearest
    to B: the least cam is another one then, ``centre`` = "least".

    Raises
    ------
    CannotBuild
        when no point satisfies the limits of all positions; says from which permitted angle on there is one.
    """
    exact = exact or ExactMotion(law)
    limited = _limited(law, limit)
    side = right if same else -right
    cones = Cones(limited, alpha, right, complex(side * arm), -side)
    n = len(limited) * (law.parts + 1)
    rows, psi, dpsi = _limited_ordinates(law, psi, dpsi, n)
    x = rows.add("x", ALONG_ROCKER, 1.0 if same else -1.0, arm, dpsi)
    plan = Plan("cam-zone", "Определение основных размеров", "m", law.labels[:n])
    start = plan.add("B_0", rules.GIVEN, 0j)
    pivot = plan.add("A", rules.ALONG, start, complex(side), arm,
                     say="На расстоянии AB = {2} от точки {0} отметим ось коромысла {name}.")
    axis = plan.add("B", TURNED, pivot, start, psi, -side)
    line = plan.add("BA", rules.RAY, axis, pivot)
    where = "к оси A" if same else "на продолжении AB"
    points = plan.add("D", rules.OFFSET, axis, line, x, say=f"От точки {{0}} {where} отложим x = AB·ψ' = {{2}}: точка {{name}}.")
    found = cones.corner(centre)
    if found is None:
        raise CannotBuild(
            f"cam.pressure_angle: no axis of the cam keeps the pressure angle of the rocker within {degrees(alpha):g} deg on "
            + ("the rise" if limit == "rise" else "the rise and the fall"), _wider(cones))
    touch = Plan("cam-zone-touch", "Точки, из которых выходят крайние лучи зоны", "m")
    z = Zone(plan, {p.name: p for p in (rows, touch, plan)}, exact, cones, axis, points, (), (), start)
    touching, borders, apex = _rocker_axis(plan, z, found[1], touch)
    return replace(z, touching=touching, borders=borders, apex=apex)


def _rocker_axis(plan: Plan, z: Zone, rays: tuple[Ray, ...], touch: Plan | None = None) -> tuple[
        tuple[Step, ...], tuple[Step, ...], Step]:
    """Record the axis O of the cam on one or two outermost rays, with r_0 and l_0."""
    touch = touch or plan
    start, (pivot, turn, right, arm) = z.plan["B_0"], z.swing
    touching, borders = [], []
    for k, ray in enumerate(rays, 1):
        tag = f"K_{k}"
        x = found_share(touch, z.exact.phases, ray.phase, ray.x, tag, "граничный луч дальше всех отсекает центр вращения кулачка")
        psi, dpsi = in_phase(touch, z.exact.law, z.exact.phases, ray.phase, x, tag, (0, 1))
        drawn = "Соединим точки D плавной кривой D(ψ). " if k == 1 else ""
        touching.append(plan.add(f"K_{k}", OUTERMOST, psi, dpsi, pivot, turn, right, arm, say=drawn + OUTERMOST.wording))
        borders.append(plan.add(f"t_{k}", OUTERMOST_DIRECTION, psi, turn, z.cones.alpha, ray.side * z.right))
    if len(touching) == 1:
        apex = plan.add("O", rules.FOOT, start, touching[0], borders[0],
                        say="Из точки {0} опустим перпендикуляр на луч {2}: в его основании возьмём центр вращения {name}.")
    else:
        apex = plan.add("O", rules.LINE_LINE, touching[0], borders[0], touching[1], borders[1],
                        say="Крайние лучи {1} и {3} пересекаются в вершине зоны; возьмём в ней центр вращения кулачка {name}.")
    plan.add("r_0", rules.DISTANCE, apex, start, say="Измерим отрезок OB_0 = r_0 = {value}.")
    plan.add("l_0", rules.DISTANCE, apex, pivot, say="Измерим отрезок OA = l_0 = {value}.")
    return tuple(touching), tuple(borders), apex


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
    """Dimensions of a cam under a flat follower and of its plate; plans in m, ``place`` that of the extremes of the law."""

    plan: Plan
    place: Plan
    exact: ExactMotion
    sums: Step

    @property
    def plans(self) -> dict[str, Plan]:
        """Its plans in the order of construction."""
        return {p.name: p for p in (self.place, self.plan, self.course_plan)}

    @cached_property
    def course_plan(self) -> Plan:
        """S and S + S'' over rise and fall, for smooth curves."""
        at = self.exact.at("cam-plate-between", "График S + S''", self.exact.display(), "узлы плавной кривой")
        at.plan.add("S+S''", SUM, at.s, at.dds)
        return at.plan

    @property
    def course(self) -> tuple[Step, Step, Step]:
        """Cam angle, S and S + S'' over rise and fall."""
        return self.course_plan["φ"], self.course_plan["S"], self.course_plan["S+S''"]

    @cached_property
    def sides(self) -> tuple[Step, Step]:
        """Limits of S + S'' at the numbered positions from below and from above."""
        before, after = (at.plan.add("S+S''", SUM, at.s, at.dds) for at in (self.exact.before, self.exact.after))
        return before, after

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


def lowest_sum(law: PositionFunction) -> tuple[float, Phase, float]:
    """Least S + S'' over a turn, m, with the phase and the share where it is; both values of S'' count where it jumps."""
    best = (float("inf"), law.rise, 0.0)
    for p in law.phases:
        for a, b in zip((0.0, *p.law.jumps), (*p.law.jumps, 1.0), strict=True):
            lo, hi = a + 1e-14, b - 1e-14
            for n in (257, 33, 33, 33, 33):
                x = np.linspace(lo, hi, n)
                total = p.s(x) + p.dds(x)
                k = int(np.argmin(total))
                lo, hi = float(x[max(k - 1, 0)]), float(x[min(k + 1, n - 1)])
            if total[k] < best[0]:
                best = (float(total[k]), p, float(x[k]))
    return best


def plate(law: PositionFunction, s: Any, dds: Any, base_radius: float | None, exact: ExactMotion | None = None) -> Plate:
    """Dimensions of the cam and the plate; ``s`` and ``dds`` are the ordinates of the numbered positions, m.

    Without a given radius the reserve is a tenth of r_min or more, and the radius not less than half the stroke, rounded
    up to a millimetre.

    Raises
    ------
    CannotBuild
        when the given radius makes the profile concave or pointed.
    """
    exact = exact or ExactMotion(law)
    place = Plan("cam-plate-places", "Наименьшая ордината S + S'' и наибольшие S'", "m")
    plan = Plan("cam-plate", "Определение основных размеров", "m", law.labels)
    sums = plan.add("S+S''", SUM, s, dds)
    _, phase, x = lowest_sum(law)
    at = found_share(place, exact.phases, phase, x, "min", "ордината S + S'' наименьшая")
    lowest = place.add("(S+S'')_min", LOWEST_SUM, *in_phase(place, law, exact.phases, phase, at, "min", (0, 2)))
    least = plan.add("r_min", LOWEST, lowest)
    if base_radius is None:
        radius = plan.add("r_0′", ROUNDED, plan.add("r_0″", NEEDED, lowest, law.stroke))
    else:
        radius = plan.add("r_0′", CHOSEN, base_radius)
    r_min, chosen = -float(lowest.value), float(radius.value)
    if not chosen > r_min:
        raise CannotBuild(
            f"cam.base_radius: with {chosen * 1e3:g} mm the profile has a cusp at {degrees(phase.phi(x)):.1f} deg: a flat follower "
            f"needs more than {r_min * 1e3:.4g} mm here", f"take {ceil(1100 * r_min)} mm or leave cam.base_radius out")
    base = plan.add("r_0", RESERVED, least, plan.add("Δr", RESERVE, radius, least))
    plan.add("ρ_min", SHARPEST, base, lowest)
    shares = np.linspace(0, 1, 2001)
    for name, p in (("l_1", law.rise), ("l_2", law.fall)):
        k = int(np.argmax(np.abs(p.ds(shares))))
        share = found_share(place, exact.phases, p, float(shares[k]), name, "|S'| наибольшее")
        plan.add(name, LARGEST, *in_phase(place, law, exact.phases, p, share, name, (1,)))
    return Plate(plan, place, exact, sums)
