"""Main dimensions of a cam by the allowed zone of its axis; of a cam under a flat follower by the sum S + S''.

Source: manual 000, section 7, examples 1 to 3; manual 002, 4.3 (both phases limited); manual 003, sheet 2 (side on which
S' is laid off, given eccentricity).

Frame: origin in the start B of the follower's motion, y along that motion, x to the right. In every position the axis O
must lie in a cone: its tip D stands off from the follower's point B by the velocity analogue, at right angles to the
velocity of B, its axis points against that velocity and its half angle is the permitted pressure angle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise
from math import ceil, cos, degrees, pi, sin, tan
from typing import Any, Literal

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Complex, Directions, Floats, Points, Reals, Signs, primitive
from tmm_sheets.construction.step import Given, Helper, Plan, Reading, Rule, Step, StepTable, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams.cam_displacement import (
    ORDERS,
    SOURCE,
    Displacement,
    ExactMotion,
    names,
    of_orders,
)
from tmm_sheets.methods.cams.cam_laws import Phase, PositionFunction
from tmm_sheets.numbers import fixed
from tmm_sheets.words import marked, tell, tr

Limit = Literal["rise", "both"]
Centre = Literal["vertex", "least"]


# --- arithmetic of the cones ---------------------------------------------------------------------------------------------


def _rise_direction(psi: Any, turn: Any) -> Directions:
    """Direction of the velocity of B of a rocker in the rise; it lies horizontal at ``psi`` 0."""
    return 1j * np.exp(1j * turn * psi)


def _rocker_end(pivot: Points, psi: Any, turn: Any) -> Points:
    """Position of B of a rocker, m."""
    return pivot * (1 - np.exp(1j * turn * psi))


def _tip(b: Any, up: Any, right: Any, arm: Any, ds: Any) -> Points:
    """Tip D of the cone of B, m."""
    return b - 1j * up * right * arm * ds


def _ray_direction(up: Any, alpha: Reals, side: Signs) -> Directions:
    """Direction of a border of the cone."""
    return -up * (np.cos(alpha) - 1j * side * np.sin(alpha))


def pieces_of(phases: Iterable[Phase], inside: float) -> Iterator[tuple[Phase, float, float]]:
    """Smooth pieces of some phases, from share to share, each read a little ``inside`` its borders."""
    return ((p, a + inside, b - inside) for p in phases for a, b in pairwise((0.0, *p.law.jumps, 1.0)))


def extreme(f: Callable[[Any, Phase], Any], pieces: Iterable[tuple[Phase, float, float]]) -> tuple[float, float, Phase]:
    """Greatest value of a function of share and phase in some pieces, its share and phase.

    Of values that differ by rounding, as in the rise and the fall that mirrors it, the first counts.
    """
    places = [(ar.continuous_argmax(lambda x, p=p: f(x, p), np.linspace(a, b, 257)), p) for p, a, b in pieces]  # type: ignore[misc]
    return max(((float(f(x, p)), x, p) for x, p in places), key=lambda found: float(f"{found[0]:.11e}"))


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

    def ups(self, p: Phase, x: Reals) -> Directions:
        """Direction of the velocity of B in the rise, at shares ``x`` of a phase."""
        s = np.asarray(p.s(x))
        return _rise_direction(s, self.turn) if self.pivot is not None else 1j * np.ones(s.shape)

    def starts(self, p: Phase, x: Reals) -> Points:
        """Positions of B, m."""
        return 1j * np.asarray(p.s(x)) if self.pivot is None else _rocker_end(self.pivot, np.asarray(p.s(x)), self.turn)

    def tips(self, p: Phase, x: Reals) -> Points:
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
        outwards = complex(sin(self.alpha), side * self.right * cos(self.alpha))

        def beyond(x: Floats, p: Phase) -> Any:
            return ((o - self.tips(p, x)) * np.conjugate(self.ups(p, x) * outwards)).real

        found = [self._ray(p, ar.continuous_argmax(partial(beyond, p=p), np.linspace(0, 1, 129)), side) for p in self.phases]
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
    height, x, p = extreme(lambda x, p: side * p.ds(x) - p.s(x) * slope, ((p, 0.0, 1.0) for p in cones.phases))

    def growth(x: Any) -> Any:
        return side * p.dds(x) - p.ds(x) * slope

    if not height > 0:
        return cones.phases[0], 0.0
    lo, hi = max(x - 1 / 256, 0.0), min(x + 1 / 256, 1.0)
    return p, ar.root(growth, lo, hi) if growth(lo) > 0 > growth(hi) else x


@primitive("lower point")
def _lower(p: Any, q: Any) -> Points:
    return np.where(np.imag(p) <= np.imag(q), p, q)[()]


CURVE = Rule("curve of the analogues", lambda s, ds, right: right * ds + 1j * s, ("ordinate", "ordinate", "number"), "point",
             marked("Join the points with the ordinates S and the abscissae S' by the smooth curve {name}."), source=SOURCE)
ROCKER_CURVE = Rule("curve of the analogues of a rocker", lambda psi, dpsi, pivot, turn, right, arm: _tip(
    _rocker_end(pivot, psi, turn), _rise_direction(psi, turn), right, arm, dpsi),
    ("inclination", "number", "point", "number", "number", "length"),
    "point",
    marked("Join the ends of the segments AB·ψ' laid off on the lines of the rocker by the smooth curve {name}."), source=SOURCE)
TOUCH = Rule("tangent under an angle", lambda s, ds, right: right * ds + 1j * s, ("ordinate", "ordinate", "number"), "point",
             marked("At the permitted pressure angle to the axis S draw the tangent to the curve S(S'); point of contact "
                    "{name}."))
INCLINED = Rule("direction under the permitted angle", lambda alpha, side: side * np.sin(alpha) + 1j * np.cos(alpha),
                ("angle", "number"),
                "direction", marked("Draw the direction {name}."))
OUTERMOST = Rule("outermost ray", ROCKER_CURVE.compute, ROCKER_CURVE.takes, "point",
                 marked("The outermost of the rays that bound the zone on this side begins at point {name} of the curve D(ψ)."))
OUTERMOST_DIRECTION = Rule("direction of the outermost ray",
                           lambda psi, turn, alpha, side: _ray_direction(_rise_direction(psi, turn), alpha, side),
                           ("inclination", "number", "angle", "number"), "direction",
                           marked("Draw the outermost ray {name} at the permitted pressure angle to the velocity of B."))
TURNED = Rule("turn about the axis of the rocker", lambda a, b, angle, sense: a + (b - a) * np.exp(1j * sense * angle),
              ("point", "point", "angle", "number"), "point",
              marked("About {0} with the radius {0}{1} draw an arc and turn the line of the rocker by the angle {2}: point "
                     "{name}."),
              lambda a, v: (Helper("line", a[0], v),))
SUM = Rule("add ordinates", lambda a, b: a + b, ("ordinate", "ordinate"), "ordinate",
           marked("To the ordinate {0} of S add the ordinate {1} of S'': ordinate {name} = {value}."))
FIRST = of_orders("ordinates of the limited phases, {}",
                  *((rules.take, lambda s, own: (own, "number"), marked("Ordinate of the graph {name} = {value}."))
                    for _ in ORDERS[:2]))
ALONG_ROCKER = Rule("analogue on the rocker", lambda sign, arm, dpsi: sign * arm * dpsi, ("number", "length", "number"), "ordinate",
                    marked("Segment {name} = AB·ψ' = {value}."), source=SOURCE)
LOWEST_SUM = Rule("lowest sum", lambda s, dds: s + dds, ("ordinate", "ordinate"), "ordinate",
                  marked("Least (negative) ordinate of the graph: {formula}."))


@primitive("rounded up to a millimetre", "real")
def rounded_up(radius: Reals) -> Reals:
    """Radius, m, rounded up to a millimetre, a very small one to a tenth."""
    unit = 1e-3 if radius > 5e-3 else 1e-4
    return ceil(radius / unit * (1 - 1e-12)) * unit


ROUNDED = Rule("rounded radius", rounded_up, ("length",), "length", marked("Round to a whole millimetre: {name} = {value}."))
CHOSEN = Rule("given radius", lambda radius: radius, ("length",), "length", marked("Given by the task: {name} = {value}."))
LARGEST = Rule("largest ordinate", np.abs, ("ordinate",), "length",
               marked("The greatest ordinate of the graph S' gives the size of the flat face {name} = {value}."))

ZONE: StepTable = {
    "B": ("0", "", rules.GIVEN),
    "A": ("B up s", "", rules.OFFSET, marked("On the axis S lay off the displacement {2} from {0}: point {name}.")),
    "D": ("A right ds", "", rules.OFFSET,
          marked("From {0}, perpendicular to the axis S, lay off the first derivative {2}: point {name}.")),
    "t_1": ("alpha one", "", INCLINED),
    "t_2": ("alpha other", "", INCLINED),
    "V": ("K_1 t_1 K_2 t_2", "", rules.LINE_LINE, marked("The tangents {1} and {3} meet at the vertex {name} of the zone.")),
    "e_0": ("B right offset", "", rules.OFFSET,
            marked("On the perpendicular to the axis S lay off the eccentricity {2} from {0}: point {name}.")),
    "O": ("K_1 t_1 K_2 t_2", "", rules.LINE_LINE,
          marked("The tangents {1} and {3} meet at the vertex of the zone; take the centre of rotation {name} of the cam there.")),
    "C": ("O B up", "", rules.FOOT, marked("From {0} drop the perpendicular to the axis S: point {name}.")),
    "S_0": ("C B", "", rules.DISTANCE, marked("Measure the segment CB = S_0 = {value}.")),
    "e": ("O side", "", Rule("abscissa", lambda p, right: right * np.real(p), ("point", "number"), "ordinate",
            marked("Measure the segment {name} = {value}.")), marked("Measure the segment CO = e = {value}.")),
    "r_0": ("O B", "", rules.DISTANCE, marked("Measure the segment OB = r_0 = {value}.")),
}
"""The axis of the cam in the vertex of the zone of a translating follower."""
OF_GIVEN_RADIUS: StepTable = {
    "r": ("r0", "r_0", CHOSEN),
    "O": ("B r line up -1", "", rules.ARC_LINE,
          marked("About {0} with the given radius {1} strike an arc across the parallel to the axis S through {2}: take the "
                 "centre of rotation {name} there.")),
}
OF_GIVEN_OFFSET: StepTable = {
    "O_1": ("line up K_1 t_1", "", rules.LINE_LINE,
            marked("Through {0}, parallel to the axis S, draw a line up to the tangent {3} from {2}: point {name}.")),
    "O_2": ("line up K_2 t_2", "", rules.LINE_LINE,
            marked("Through {0}, parallel to the axis S, draw a line up to the tangent {3} from {2}: point {name}.")),
    "O": ("O_1 O_2", "", Rule("lower of two points", _lower, ("point", "point"), "point",
            marked("Of the points {0} and {1} the lower one is {name}: take the centre of rotation of the cam there."))),
}
ON_ONE_BORDER: StepTable = {
    "O": ("B touching border", "", rules.FOOT,
          marked("From {0} drop the perpendicular to the tangent {2}: take the centre of rotation {name} at its foot.")),
}
ROCKER_ZONE: StepTable = {
    "B_0": ("0", "", rules.GIVEN),
    "A": ("B_0 right arm", "", rules.ALONG, marked("At the distance AB = {2} from {0} mark the axis {name} of the rocker.")),
    "B": ("A B_0 psi turn", "", TURNED),
    "BA": ("B A", "", rules.RAY),
    "D": ("B BA x", "", rules.OFFSET, marked("From {0} on AB produced lay off x = AB·ψ' = {2}: point {name}.")),
    "r": ("r0", "r_0", CHOSEN),
    "l": ("l0", "l_0", CHOSEN, marked("Given distance of the axes {name} = {value}.")),
    "O": ("B_0 r A l turn", "", rules.ARC_ARC,
          marked("About {0} with the given radius {1} and about {2} with the distance of the axes {3} strike arcs: take the "
                 "centre of rotation {name} of the cam there.")),
    "r_0": ("O B_0", "", rules.DISTANCE, marked("Measure the segment OB_0 = r_0 = {value}.")),
    "l_0": ("O A", "", rules.DISTANCE, marked("Measure the segment OA = l_0 = {value}.")),
}
"""The axis of the cam of a rocker at given distances from B and from the rocker's axis."""
TOWARDS_AXIS: StepTable = {
    "D": ("B BA x", "", rules.OFFSET,
          marked("From {0} towards the axis A lay off x = AB·ψ' = {2}: point {name}.")),
}
AGAINST_VELOCITY: StepTable = {
    "O": ("B_0 down r", "", rules.ALONG,
          marked("Perpendicular to AB_0, against the velocity of B at the start, lay off the given radius {2} from {0}: take the "
                 "centre of rotation {name} of the cam there.")),
}
ON_ONE_RAY: StepTable = {
    "O": ("B_0 K_1 t_1", "", rules.FOOT,
          marked("From {0} drop the perpendicular to the ray {2}: take the centre of rotation {name} at its foot.")),
}
WHERE_RAYS_MEET: StepTable = {
    "O": ("K_1 t_1 K_2 t_2", "", rules.LINE_LINE,
          marked("The outermost rays {1} and {3} meet at the vertex of the zone; take the centre of rotation {name} of the cam "
                 "there.")),
}
PLATE: StepTable = {
    "r_min": ("lowest", "", Rule("lowest ordinate", lambda total: np.maximum(-total, 0.0), ("ordinate",), "length",
            marked("The least (negative) ordinate of the graph S + S'' gives r_min = {value}."))),
    "r_0″": ("lowest stroke", "",
        Rule("radius with a reserve", lambda total, stroke: np.maximum(1.1 * -total, 0.5 * stroke), ("ordinate", "length"),
            "length",
            marked("With a margin of a tenth of r_min, but not below half the stroke: {name} = {value}."), source=SOURCE)),
    "r_0′": ("r_0″", "", ROUNDED),
    "Δr": ("r_0′ r_min", "", Rule("reserve", lambda radius, least: radius - least, ("length", "length"), "length",
            "")),
    "r_0": ("r_min Δr", "", Rule("add a reserve", lambda least, reserve: least + reserve, ("length", "length"), "length",
            marked("To the radius {0} add the margin Δr = {1}: {name} = {value}."))),
    "ρ_min": ("r_0 lowest", "",
        Rule("least radius of curvature", lambda radius, total: radius + total, ("length", "ordinate"), "length",
            marked("Least radius of curvature of the profile: {formula}."), source=SOURCE)),
}
"""The cam under a flat follower by the least sum S + S''."""


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

    r0 = Reading("plan", "r_0")
    """Smallest radius of the centre profile, m."""
    s0 = Reading("plan", "S_0")
    """Height of the start of a translating follower's motion over the cam's axis, m."""
    e = Reading("plan", "e")
    """Offset of a translating follower, m; positive when it lessens the pressure angle of the rise."""
    l0 = Reading("plan", "l_0")
    """Distance between the axes of cam and rocker, m."""

    @cached_property
    def curve_plan(self) -> Plan:
        """Plan of the smooth curve of the tips."""
        x = np.linspace(0, 1, 129)
        phi = np.concatenate([p.phi(x) for p in self.cones.phases])
        return self._tips(self.exact.at("cam-zone-between", tr("Curve of S(S')"), phi, tr("nodes of a smooth curve")))

    @property
    def curve(self) -> Step:
        """Smooth curve of the tips, S(S'), m: a row of points."""
        return self.tips(self.curve_plan)

    @property
    def _curve_name(self) -> str:
        return "S(S')" if self.cones.pivot is None else "D(ψ)"

    def _tips(self, at: Displacement) -> Plan:
        """Record the tips of a motion."""
        at.plan.add(self._curve_name, CURVE if self.cones.pivot is None else ROCKER_CURVE, at.s, at.ds, *self.shape)
        return at.plan

    @cached_property
    def every(self) -> Plan:
        """Plan of the tips in all numbered positions, also those of a phase that does not limit the zone."""
        law = self.exact.law
        plan = Plan("cam-zone-every-between", tr("Points of the curve S(S') in all positions"), "m", law.labels)
        phi = Given(law.positions, "cam.parts", choice=tr("numbered positions in order"), unit="rad")
        return self._tips(self.exact.displacement(plan, phi))

    @cached_property
    def beyond(self) -> Plan | None:
        """Plan of the smooth curve of the tips in the fall where it does not limit the zone; None where it does."""
        fall = self.exact.law.fall
        if fall in self.cones.phases:
            return None
        return self._tips(self.exact.at("cam-zone-fall-between", tr("Curve of S(S') in the fall"), fall.phi(np.linspace(0, 1, 129)),
                                        tr("nodes of a smooth curve")))

    def tips(self, plan: Plan) -> Step:
        """Tips of one of the plans of the curve, m: a row of points."""
        return plan[self._curve_name]

    @property
    def shape(self) -> tuple[Any, ...]:
        """What the tips follow from beside the motion: side of the analogues; of a rocker its axis, sense, this side, its arm."""
        if self.cones.pivot is None:
            return (self.right,)
        return self.plan["A"], self.cones.turn, self.right, self.plan["A"].args[2]

    @cached_property
    def least(self) -> Plan | None:
        """Axis of the least cam of a rocker: the point O of the zone nearest to B, with r_0 and l_0; None where there is none."""
        found = self.cones.corner("least")
        if found is None:
            return None
        plan = Plan("cam-zone-least", tr("Least possible cam"), "m")
        _rocker_axis(plan, self, found[1])
        return plan


def _limited(law: PositionFunction, limit: Limit) -> tuple[Phase, ...]:
    return (law.rise,) if limit == "rise" else (law.rise, law.fall)


def _limited_ordinates(law: PositionFunction, s: Any, ds: Any, n: int) -> tuple[Plan, Step, Step]:
    """Ordinates of the limited phases only."""
    plan = Plan("cam-zone-ordinates", tr("Ordinates of the graphs for the construction of the zone"), "m", law.labels[:n])
    first = Given(np.arange(float(n)), "cam.limit", choice=tr("positions of the phases in which the pressure angle is limited"))
    zero, one, _ = names(law.symbol)
    rules_of = FIRST[law.symbol]
    return plan, plan.add(zero, rules_of[0], s, first), plan.add(one, rules_of[1], ds, first)


def zone(law: PositionFunction, alpha: float, limit: Limit, right: float, s: Any, ds: Any, e: float | None = None,
         centre: Centre = "vertex", exact: ExactMotion | None = None, r0: float | None = None) -> Zone:
    """Main dimensions of a translating roller follower; ``s`` and ``ds`` are the ordinates of the numbered positions, m.

    The axis is put in the apex of the zone; with a given eccentricity ``e`` (m) on the follower's line at that distance,
    as high as the zone allows; with ``centre`` = "least" in the point of the zone nearest to B. With a given radius ``r0`` (m) it
    stands at that distance from B on the follower's line, at the eccentricity or through B, whatever the zone allows.

    Raises
    ------
    CannotBuild
        when the given radius does not reach the follower's line.
    """
    if r0 is not None and not r0 > abs(e or 0.0):
        raise CannotBuild(tell("cam.base_radius: with {radius:g} mm the cam's axis cannot stand {offset:g} mm off the follower's "
                               "line").format(radius=r0 * 1e3, offset=abs(e or 0.0) * 1e3),
                          tell("take a radius larger than the eccentricity"))
    exact = exact or ExactMotion(law)
    limited = _limited(law, limit)
    cones = Cones(limited, alpha, right)
    n = len(limited) * (law.parts + 1)
    rows, s, ds = _limited_ordinates(law, s, ds, n)
    touch = Plan("cam-zone-touch", tr("Points of contact of the borders of the zone"), "m")
    plan = Plan("cam-zone", tr("Main dimensions of the cam"), "m", law.labels[:n])
    given: dict[str, Any] = {"0": 0j, "up": 1j, "right": complex(right), "side": right, "one": right * 1.0, "other": right * -1.0,
                             "-1": -1.0, "alpha": alpha, "s": s, "ds": ds, "offset": e, "r0": r0}
    record(plan, "B A D", ZONE, given=given)
    touching = []
    for name, side in (("K_1", 1.0), ("K_2", -1.0)):
        phase, x = _touched(cones, side)
        at = exact.found(touch, phase, x, name, tr("{ds} − S·tan[α] is greatest").format(ds="S'" if side > 0 else "−S'"), (0, 1))
        say = (tr("Join the points D by the smooth curve S(S'). At the angle {angle}° to the axis S draw the tangent to the "
                  "curve S(S'); point of contact {{name}}.") if side > 0 else
               tr("At the angle {angle}° to the axis S draw the tangent to the curve S(S'); point of contact {{name}}."))
        touching.append(plan.add(name, TOUCH, *at, right, say=say.format(angle=fixed(degrees(alpha), 1))))
    record(plan, "t_1 t_2", ZONE, given=given)
    if e is not None or r0 is not None or centre == "least":
        record(plan, "V", ZONE)
    given["line"] = plan["B"] if e is None else record(plan, "e_0", ZONE, given=given)
    if r0 is not None:
        record(plan, "r O", OF_GIVEN_RADIUS, given=given)
    elif e is not None:
        record(plan, "O_1 O_2 O", OF_GIVEN_OFFSET, given=given)
    elif centre == "least" and len(rays := (cones.corner("least") or (0j, ()))[1]) == 1:
        k = 1 if rays[0].direction.real * right < 0 else 2
        record(plan, "O", ON_ONE_BORDER, given={"touching": plan[f"K_{k}"], "border": plan[f"t_{k}"]})
    else:
        record(plan, "O", ZONE)
    record(plan, "C S_0 e r_0", ZONE, given=given)
    plans = {p.name: p for p in (rows, touch, plan)}
    return Zone(plan, plans, exact, cones, plan["A"], plan["D"], tuple(touching), (plan["t_1"], plan["t_2"]), plan["O"])


# --- rocker -----------------------------------------------------------------------------------------------------------


def rocker_zone(law: PositionFunction, arm: float, alpha: float, limit: Limit, right: float, same: bool, psi: Any,
                dpsi: Any, centre: Centre = "vertex", exact: ExactMotion | None = None, r0: float | None = None,
                l0: float | None = None) -> Zone:
    """Main dimensions of an oscillating roller follower; ``psi`` and ``dpsi`` are the ordinates of the positions, rad.

    ``same``: cam and rocker turn the same way in the rise, so the segments are laid off towards the axis A of the rocker.
    The rocker lies horizontal in position 0 and rises upwards. The vertex of the zone is not always its point nearest
    to B: the least cam is another one then, ``centre`` = "least". With a given radius ``r0`` (m) the axis stands at that distance
    from B against its first velocity, or at the distance ``l0`` (m) from A, whatever the zone allows.

    Raises
    ------
    CannotBuild
        when no point satisfies the limits of all positions; says from which permitted angle on there is one. When the given
        distances and the rocker make no triangle.
    """
    exact = exact or ExactMotion(law)
    limited = _limited(law, limit)
    side = right if same else -right
    cones = Cones(limited, alpha, right, complex(side * arm), -side)
    n = len(limited) * (law.parts + 1)
    rows, psi, dpsi = _limited_ordinates(law, psi, dpsi, n)
    x = rows.add("x", ALONG_ROCKER, 1.0 if same else -1.0, arm, dpsi)
    plan = Plan("cam-zone", tr("Main dimensions of the cam"), "m", law.labels[:n])
    given = {"0": 0j, "right": complex(side), "arm": arm, "psi": psi, "turn": -side, "x": x}
    record(plan, "B_0 A B BA D", *[TOWARDS_AXIS] * same, ROCKER_ZONE, given=given)
    found = cones.corner(centre)
    if found is None and r0 is None:
        raise CannotBuild(
            (tell("cam.pressure_angle: no axis of the cam keeps the pressure angle of the rocker within {angle:g} deg on the rise")
             if limit == "rise" else
             tell("cam.pressure_angle: no axis of the cam keeps the pressure angle of the rocker within {angle:g} deg on the rise "
                  "and the fall")).format(angle=degrees(alpha)), _hint_of_wider_angle(cones))
    touch = Plan("cam-zone-touch", tr("Points where the outermost rays of the zone begin"), "m")
    z = Zone(plan, {p.name: p for p in (rows, touch, plan)}, exact, cones, plan["B"], plan["D"], (), (), plan["B_0"])
    rays = found[1] if found else ()
    if r0 is None:
        touching, borders, apex = _rocker_axis(plan, z, rays, touch)
        return replace(z, touching=touching, borders=borders, apex=apex)
    touching, borders = _outermost(plan, z, rays, touch)
    return replace(z, touching=touching, borders=borders, apex=_given_axis(plan, z, r0, l0))


def _given_axis(plan: Plan, z: Zone, r0: float, l0: float | None) -> Step:
    """Record the axis O of the cam of a given radius, with r_0 and l_0."""
    _, turn, _, arm = z.shape
    given = {"r0": r0, "l0": l0, "turn": turn, "down": -1j}
    if l0 is None:
        record(plan, "r O", AGAINST_VELOCITY, ROCKER_ZONE, given=given)
    else:
        if not abs(r0 - arm) < l0 < r0 + arm:
            raise CannotBuild(tell("cam.centre_distance: {distance:g} mm, the radius {radius:g} mm and the rocker of {arm:g} mm "
                                   "make no triangle").format(distance=l0 * 1e3, radius=r0 * 1e3, arm=arm * 1e3),
                              tell("take a distance between {least:g} and {most:g} mm").format(
                                  least=abs(r0 - arm) * 1e3, most=(r0 + arm) * 1e3))
        record(plan, "r l O", ROCKER_ZONE, given=given)
    record(plan, "r_0 l_0", ROCKER_ZONE)
    return plan["O"]


def _rocker_axis(plan: Plan, z: Zone, rays: tuple[Ray, ...], touch: Plan | None = None) -> tuple[
        tuple[Step, ...], tuple[Step, ...], Step]:
    """Record the axis O of the cam on one or two outermost rays, with r_0 and l_0."""
    touching, borders = _outermost(plan, z, rays, touch or plan)
    record(plan, "O r_0 l_0", ON_ONE_RAY if len(touching) == 1 else WHERE_RAYS_MEET, ROCKER_ZONE, given=z.plan.steps)
    return touching, borders, plan["O"]


def _outermost(plan: Plan, z: Zone, rays: tuple[Ray, ...], touch: Plan) -> tuple[tuple[Step, ...], tuple[Step, ...]]:
    """Record the points where outermost rays begin, and their directions."""
    turn = z.cones.turn
    touching, borders = [], []
    for k, ray in enumerate(rays, 1):
        tag = f"K_{k}"
        psi, dpsi = z.exact.found(touch, ray.phase, ray.x, tag, tr(
            "the border ray cuts off the centre of rotation of the cam farther than all others"), (0, 1))
        say = tr("Join the points D by the smooth curve D(ψ). The outermost of the rays that bound the zone on this side begins "
                 "at point {name} of the curve D(ψ).") if k == 1 else None
        touching.append(plan.add(f"K_{k}", OUTERMOST, psi, dpsi, *z.shape, say=say))
        borders.append(plan.add(f"t_{k}", OUTERMOST_DIRECTION, psi, turn, z.cones.alpha, ray.side * z.right))
    return tuple(touching), tuple(borders)


# --- pressure angle ---------------------------------------------------------------------------------------------------

VELOCITY_OF_B = Rule("direction of the velocity of B", _rise_direction, ("inclination", "number"), "direction",
                     marked("Draw the direction {name} of the velocity of B."))
PRESSURE = Rule("pressure angle at a place", lambda tip, o, up, right: -right * np.angle((tip - o) / up),
                ("point", "point", "direction", "number"), "inclination",
                marked("The ray {1}{0} stands off from the velocity of B by the pressure angle {name} = {value}."), unit="rad",
                source=SOURCE)


def max_pressure_angles(z: Zone) -> Plan:
    """Greatest pressure angles ``α_1`` of the rise and ``α_2`` of the fall, rad, at the cam angles ``φ_α1`` and ``φ_α2``."""
    plan = Plan("cam-steepest", tr("Greatest pressure angles"), "m")
    law, apex = z.exact.law, complex(z.apex.value)
    for k, phase in enumerate((law.rise, law.fall), 1):

        def angle(x: Floats, p: Phase = phase) -> Any:
            return np.abs(np.angle((z.cones.tips(p, x) - apex) / z.cones.ups(p, x)))

        tag = f"α{k}"
        s, ds = z.exact.found(plan, phase, ar.continuous_argmax(angle, np.linspace(0, 1, 65)), tag,
                              tr("the pressure angle is greatest"), (0, 1))
        turning = z.cones.pivot is not None
        up = plan.add(f"u_{tag}", VELOCITY_OF_B, s, z.cones.turn) if turning else 1j
        tip = plan.add(f"K_{tag}", OUTERMOST if turning else TOUCH, s, ds, *z.shape, say=tr(
            "Point {name} of the curve D(ψ) there.") if turning else tr("Point {name} of the curve S(S') there."))
        plan.add(f"α_{k}", PRESSURE, tip, z.plan["O"], up, z.right, symbol=f"α_{k}")
    return plan


def _hint_of_wider_angle(cones: Cones) -> str:
    """Hint: the least permitted angle, in whole degrees, with which there is a zone."""
    low, high = ceil(degrees(cones.alpha)), 90
    while high - low > 1:
        middle = (low + high) // 2
        there = Cones(cones.phases, middle * pi / 180, cones.right, cones.pivot, cones.turn).corner("vertex") is not None
        low, high = (low, middle) if there else (middle, high)
    if high < 90:
        return tell("it can be had from {angle} deg on; or take longer phases, a smaller swing").format(angle=high)
    return tell("take longer phases or a smaller swing")


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
        at = self.exact.at("cam-plate-between", tr("Graph of S + S''"), self.exact.display(), tr("nodes of a smooth curve"))
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

    r0 = Reading("plan", "r_0")
    """Smallest radius of the cam, m."""
    r_min = Reading("plan", "r_min")
    """Radius below which the profile would not be convex, m."""
    l1 = Reading("plan", "l_1")
    """Reach of the plate to the side of the contact in the rise, m."""
    l2 = Reading("plan", "l_2")
    """Reach of the plate to the side of the contact in the fall, m."""


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
    place = Plan("cam-plate-places", tr("Least ordinate of S + S'' and greatest ones of S'"), "m")
    plan = Plan("cam-plate", tr("Main dimensions of the cam"), "m", law.labels)
    sums = plan.add("S+S''", SUM, s, dds)
    # Both values of S'' count where it jumps.
    _, x, phase = extreme(lambda x, p: -(p.s(x) + p.dds(x)), pieces_of(law.phases, 1e-14))
    lowest = place.add("(S+S'')_min", LOWEST_SUM, *exact.found(
        place, phase, x, "min", tr("the ordinate of S + S'' is least"), (0, 2)))
    given = {"lowest": lowest, "stroke": law.stroke}
    record(plan, "r_min", PLATE, given=given)
    radius = record(plan, "r_0″ r_0′", PLATE, given=given) if base_radius is None else plan.add("r_0′", CHOSEN, base_radius)
    r_min, chosen = -float(lowest.value), float(radius.value)
    if not chosen > r_min:
        raise CannotBuild(
            tell("cam.base_radius: with {radius:g} mm the profile has a cusp at {angle:.1f} deg: a flat follower needs more than "
                 "{least:.4g} mm here").format(radius=chosen * 1e3, angle=degrees(phase.phi(x)), least=r_min * 1e3),
            tell("take {radius} mm or leave cam.base_radius out").format(radius=ceil(1100 * r_min)))
    record(plan, "Δr r_0 ρ_min", PLATE, given=given)
    shares = np.linspace(0, 1, 2001)
    for name, p in (("l_1", law.rise), ("l_2", law.fall)):
        k = int(np.argmax(np.abs(p.ds(shares))))
        plan.add(name, LARGEST, *exact.found(place, p, float(shares[k]), name, tr("|S'| is greatest"), (1,)))
    return Plate(plan, place, exact, sums)
