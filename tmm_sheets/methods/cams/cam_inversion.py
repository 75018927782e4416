"""Profile of a cam by inverted motion, and what holds the follower to it: a spring, or a second disc."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Floats, Points, Reals, Signs, primitive
from tmm_sheets.construction.step import Helper, Plan, Reading, Rule, Step, StepTable, record
from tmm_sheets.methods.cams.cam_displacement import Displacement, ExactMotion
from tmm_sheets.methods.cams.cam_zone import ALONG_ROCKER, TURNED, Cones, Zone, extreme, pieces_of
from tmm_sheets.words import marked, tr

LAY_OFF_FROM = Rule(
    "lay off an angle from a line", lambda o, b, r, angle, sense: o + r * ar.ray(o, b) * np.exp(1j * sense * angle),
    ("point", "point", "length", "angle", "number"), "point",
    marked("From the line {0}{1}, against the rotation of the cam, lay off the angle {3}; on the circle with the radius {2} mark "
           "point {name}."),
    lambda a, v: (Helper("line", a[0], v),),
)
ACROSS_LINE = Rule("perpendicular to a direction", lambda u, side: 1j * side * u, ("direction", "number"), "direction",
                   marked("Draw the perpendicular {name} to the line {0}."))
CONTACT = Rule("contact on the normal", lambda b, n, r: b + r * n, ("point", "direction", "length"), "point",
               marked("About {0} with the radius of the roller {2} draw a circle; point {name} of the profile lies on the normal "
                      "{1}."),
               lambda a, v: (Helper("circle", a[0], radius=a[2]),))
FROM_AXIS = Rule("point from the axis of the cam", lambda p, o: p - o, ("point", "point"), "point", marked("Mark point {name}."))


@primitive("tangent to the circle e")
def _touching(p: Points, centre: Points, e: Any, side: Signs) -> Points:
    return ar.tangent_point(p, centre, np.abs(e), side)


BETWEEN = Rule("angle between two lines", lambda n, u, right: np.arctan2(right * ar.cross(n, -u), ar.dot(n, -u)),
               ("direction", "direction", "number"), "inclination",
               marked("Measure the pressure angle between the normal {0} and the direction {1} of the follower's velocity: "
                      "{value}."))


@dataclass(frozen=True)
class Inversion:
    """Positions of a follower about the standing cam.

    ``axis`` are the marks of the follower's path in position 0, ``ends`` the points from which its inverted positions are
    drawn (the ends of its lines on the circle r0, the axes of the rocker on the circle l0), ``feet`` the points of contact
    of the lines with the circle e (None where there are none), ``lines`` the directions of the follower's velocity in the
    rise, ``centres`` the points of the centre profile (under a flat follower the middles of the plate), ``normals`` the
    directions of the common normal into the cam, ``angles`` the pressure angles.
    """

    plan: Plan
    at: Displacement
    origin: Step
    axis: Step
    ends: Step
    feet: Step | None
    lines: Step
    centres: Step
    normals: Step
    angles: Step

    @property
    def phi(self) -> Floats:
        """Cam angles, rad."""
        return np.asarray(self.at.phi.value)


DISPLACED = marked("On the line of the follower lay off the displacement {2} from {0}: point {name}.")
TAPPET: StepTable = {
    "O": ("origin", "", rules.GIVEN),
    "T_0": ("right e", "", Rule("foot on the follower's line", lambda right, e: -(right * e) + 0j, ("number", "ordinate"), "point",
                                marked("At the distance e = {1} from O mark the foot {name} of the line of the follower."))),
    "B_0": ("T_0 up S_0", "", rules.ALONG, marked("From the legs e and S_0 = {2} draw a right triangle; its vertex {name}.")),
    "A": ("B_0 up s", "", rules.OFFSET, DISPLACED),
    "N": ("O B_0 r_0 φ right", "", LAY_OFF_FROM),
    "T": ("N O e side", "", Rule("tangent to the circle e", _touching, ("point", "point", "ordinate", "number"), "point",
                                 rules.TANGENT.wording, rules.TANGENT.helpers)),
    "TN": ("T N", "", rules.RAY),
    "OA": ("O A", "", rules.DISTANCE),
    "B": ("O OA N TN ahead", "", rules.ARC_LINE),
    "⊥TN": ("TN right", "", ACROSS_LINE),
    "P": ("O ⊥TN ds", "", Rule(
        "centre of relative rotation", lambda o, u, ds: o + u * ds, ("point", "direction", "ordinate"), "point",
        marked("Through {0}, perpendicular to the line of the follower, lay off the first derivative {2}: point {name} on the "
               "normal to the profile."), lambda a, v: (Helper("line", a[0], v),))),
    "BP": ("B P", "", rules.RAY),
    "α": ("BP TN right", "", BETWEEN),
}
"""Inversion of a translating roller follower."""
ROCKER: StepTable = {
    "O": ("origin", "", rules.GIVEN),
    "A_0": ("pivot apex", "", FROM_AXIS, marked("At the distance l_0 from O mark the axis {name} of the rocker.")),
    "B_0": ("start apex", "", FROM_AXIS, marked("From the sides r_0, l_0 and AB draw the triangle OA_0B_0; its vertex {name}.")),
    "C": ("A_0 B_0 s turn", "", TURNED),
    "A": ("O A_0 l_0 φ right", "", LAY_OFF_FROM),
    "OC": ("O C", "", rules.DISTANCE),
    "B": ("O OC A arm side", "", rules.ARC_ARC),
    "BA": ("B A", "", rules.RAY),
    "D": ("B BA x", "", rules.OFFSET, marked("On the line of the rocker lay off the segment AB·ψ' = {2} from {0}: point {name}.")),
    "DO": ("D O", "", rules.RAY, marked("Draw the line {0}{1}: the normal to the profile at B is parallel to it.")),
    "⊥BA": ("BA back", "", ACROSS_LINE),
    "α": ("DO ⊥BA right", "", BETWEEN),
}
"""Inversion of an oscillating roller follower."""
FLAT: StepTable = {
    "O": ("origin", "", rules.GIVEN),
    "B_0": ("O up r_0", "", rules.ALONG, marked("On the line of the follower lay off the radius r_0 = {2}: point {name}.")),
    "A": ("B_0 up s", "", rules.OFFSET, DISPLACED),
    "N": ("O B_0 r_0 φ right", "", LAY_OFF_FROM),
    "ON": ("O N", "", rules.RAY),
    "OA": ("O A", "", rules.DISTANCE),
    "B": ("O OA O ON ahead", "", rules.ARC_LINE),
    "⊥ON": ("ON right", "", ACROSS_LINE, marked("Through B draw the perpendicular {name} to {0}: the plane of the flat face.")),
    "F": ("B ⊥ON ds", "", rules.OFFSET,
          marked("On the flat face lay off the first derivative {2} from {0}: point {name} of contact with the profile.")),
    "−ON": ("B O", "", rules.RAY, marked("The normal {name} to the profile is parallel to the line of the follower.")),
    "α": ("−ON ON right", "", BETWEEN),
}
"""Inversion of a flat follower; the plate is perpendicular to its motion."""


def inverted(plan: Plan, at: Displacement, table: StepTable, roles: str, given: dict[str, Any]) -> Inversion:
    """Record the inversion of a follower by its table; ``roles`` are its axis, ends, lines, centres and normals."""
    motion = {"φ": at.phi, "s": at.s, "ds": at.ds}
    angles = record(plan, " ".join(table), table, given={"origin": 0j, "up": 1j, "ahead": 1.0, **motion, **given})
    axis, ends, lines, centres, normals = (plan[name] for name in roles.split())
    return Inversion(plan, at, plan["O"], axis, ends, plan.steps.get("T"), lines, centres, normals, angles)


def translating(plan: Plan, dimensions: Zone, at: Displacement) -> Inversion:
    """Record the inversion of a translating roller follower."""
    # The cam turns by -right * phi, so the follower goes round the standing cam by right * phi.
    right = dimensions.right
    sizes = {name: dimensions.plan[name] for name in ("e", "S_0", "r_0")}
    return inverted(plan, at, TAPPET, "A N TN B BP", {"right": right, "side": -right if dimensions.e >= 0 else right, **sizes})


def rocker(plan: Plan, dimensions: Zone, at: Displacement) -> Inversion:
    """Record the inversion of an oscillating roller follower."""
    right, turn, arm = dimensions.right, dimensions.cones.turn, dimensions.shape[-1]
    pivot, apex, start, l0 = (dimensions.plan[name] for name in ("A", "O", "B_0", "l_0"))
    side = float(np.sign(ar.cross(pivot.value - apex.value, start.value - apex.value)))
    x = at.plan.add("x", ALONG_ROCKER, 1.0 if turn * right < 0 else -1.0, arm, at.ds)
    return inverted(plan, at, ROCKER, "C A ⊥BA B DO", {
        "pivot": pivot, "apex": apex, "start": start, "l_0": l0, "right": right, "turn": turn, "back": -turn, "arm": arm,
        "side": side, "x": x})


def flat(plan: Plan, r0: Step, right: float, at: Displacement) -> Inversion:
    """Record the inversion of a flat follower."""
    return inverted(plan, at, FLAT, "A N ON B −ON", {"r_0": r0, "right": right})


# --- curvature --------------------------------------------------------------------------------------------------------


def curvature(w: Any, dw: Any, ddw: Any, right: float) -> Any:
    """Curvature of the path ``w(phi) exp(i right phi)`` in the cam, 1/m, positive where it is convex.

    ``w`` is the point in the standing frame, ``dw`` and ``ddw`` its derivatives by the cam angle.
    """
    first, second = 1j * right * w + dw, -w + 2j * right * dw + ddw
    return right * (np.conjugate(first) * second).imag / np.abs(first) ** 3


def tappet_curvature(s: Any, ds: Any, dds: Any, s0: Any, e: Any, right: Any, distance: Reals) -> Reals:
    """Curvature of the centre profile of a translating follower, 1/m; ``distance`` of the second disc's roller, 0 for the first."""
    return curvature(1j * (s0 + s) - right * e - 1j * distance, 1j * ds, 1j * dds, right)


def rocker_curvature(psi: Any, dpsi: Any, ddpsi: Any, pivot: Points, apex: Any, turn: Any, right: Any, spread: Any) -> Reals:
    """Curvature of the centre profile of a rocker, 1/m; ``spread`` turns the arm of the second disc back, rad, 0 for the first."""
    arm = -pivot * np.exp(-1j * turn * spread) * np.exp(1j * turn * psi)
    first = 1j * turn * dpsi * arm
    return curvature(pivot - apex + arm, first, 1j * turn * ddpsi * arm + 1j * turn * dpsi * first, right)


TAPPET_RADIUS = Rule("radius of curvature", lambda *of: 1 / tappet_curvature(*of), ("ordinate",) * 5 + ("number", "length"),
                     "length",
                     marked("Radius of curvature of the pitch curve at this place {name} = {value}."), source="002, 4.4")
ROCKER_RADIUS = Rule("radius of curvature, rocker", lambda *of: 1 / rocker_curvature(*of),
                     ("inclination", "number", "number", "point", "point", "number", "number", "inclination"), "length",
                     marked("Radius of curvature of the pitch curve at this place {name} = {value}."), source="002, 4.4")


SOURCE = marked("003, sheet 2")


# --- spring -----------------------------------------------------------------------------------------------------------


def _inertia(dds: Any, mass: Reals, speed: Reals, length: Reals) -> Reals:
    """Force of inertia away from the cam, N; negative where it presses together."""
    return -dds * (mass * speed**2 * length)


def _force(s: Any, preload: Any, rate: Any, length: Reals) -> Reals:
    """Force of the spring at a displacement, N."""
    return preload + rate * length * s


INERTIA = Rule("force of inertia", _inertia, ("ordinate", "number", "number", "number"), "number",
               marked("Force of inertia that lifts the follower off the cam: {name} = {value} N."), unit="N", source=SOURCE)
FORCE = Rule("force of the spring", _force, ("ordinate", "number", "number", "number"), "number",
             marked("Force of the spring at this position {name} = {value} N."), unit="N", source=SOURCE)
PRODUCT = Rule("force by a factor", lambda factor, force: factor * force, ("number", "number"), "number", "", unit="N",
               source=SOURCE)
SPRING: StepTable = {
    "m": ("mass", "", Rule("moved mass", lambda mass: mass, ("number",), "number",
                           marked("Given mass of the follower {name} = {value} kg."), unit="kg")),
    "l": ("length", "", Rule("arm of the way", lambda length: length, ("number",), "number",
                             marked("The displacement of the law is multiplied by {name} = {value}."), unit="m")),
    "ω": ("speed", "", Rule("speed of the cam", lambda speed: speed, ("number",), "number",
                            marked("Given angular velocity of the cam {name} = {value} rad/s."), unit="rad/s")),
    "Q_max": ("dds m ω l", "", Rule(
        "largest force of inertia", lambda *of: np.maximum(_inertia(*of), 0.0), INERTIA.takes, "number",
        marked("Greatest force of inertia that lifts the follower off the cam: {name} = {value} N."), unit="N", source=SOURCE)),
    "F_max": ("factor Q_max", "", PRODUCT),
    "F_0": ("preload F_max", "", PRODUCT),
    "s": ("l stroke", "", Rule("way of the spring", lambda length, stroke: length * stroke, ("number", "length"), "number",
                               marked("Travel of the spring {name} = {value} m."), unit="m", source=SOURCE)),
    "c": ("F_max F_0 s", "", Rule("stiffness", lambda most, first, way: (most - first) / way, ("number",) * 3, "number", "",
                                  unit="N/m", source=SOURCE)),
    "k_min": ("displacement dds stroke Q_max factor preload m ω l", "", Rule(
        "force by force of inertia", lambda s, dds, stroke, largest, factor, preload, mass, speed, length: factor * largest * (
            preload + (1 - preload) * s / stroke) / _inertia(dds, mass, speed, length),
        ("ordinate", "ordinate", "length") + ("number",) * 6, "number",
        marked("Least ratio of the force of the spring to the force of inertia {name} = {value}."), unit="1", source=SOURCE)),
    "k_F": ("factor k_min", "", Rule(
        "factor of the spring needed", lambda factor, least: factor / least, ("number", "number"), "number",
        marked("Least factor of the greatest force with which the pair stays closed: {formula}."), unit="1", source=SOURCE)),
}
OF_ROCKER: StepTable = {
    "m": ("mass arm", "", Rule("mass reduced to the roller", lambda inertia, arm: inertia / arm**2, ("number", "length"), "number",
                               "", unit="kg", source=SOURCE)),
}
"""What takes the place of the mass where a moment of inertia is given with its arm."""


@dataclass(frozen=True)
class Spring:
    """Closing spring along the path of the follower (of a rocker: along the path of its roller); SI.

    ``plan`` holds Q_max, the largest force of inertia that tends to separate follower and cam (S'' < 0), F_max, the
    spring force at the end of the rise, its preload F_0 and its stiffness c; the least ratio of spring
    force and force of inertia where S'' < 0 and the cam angle where it occurs: the pair stays closed when it
    is greater than 1. Gravity and friction are left out, the safe side.
    """

    exact: ExactMotion
    plan: Plan
    speed: float

    mass = Reading("plan", "m")
    """Moved mass, kg."""
    length = Reading("plan", "l")
    """What turns a displacement of the law into a way: 1, or the arm of a rocker, m."""
    largest_inertia = Reading("plan", "Q_max")
    """Largest force of inertia that separates follower and cam, N."""
    f_0 = Reading("plan", "F_0")
    """Force in the lowest position, N."""
    way = Reading("plan", "s")
    """Way of the spring, m."""
    rate = Reading("plan", "c")
    """Stiffness, N/m."""
    worst = Reading("plan", "k_min")
    """Least ratio of spring force and force of inertia."""
    worst_phi = Reading("plan", "φ_k")
    """Cam angle where it occurs, rad."""
    needed_factor = Reading("plan", "k_F")
    """Factor of the largest force from which on the pair stays closed, share of the preload kept."""

    @property
    def closed(self) -> bool:
        """True when the spring holds the pair together in every position."""
        return bool(self.worst > 1)

    def force(self, s: Any) -> Any:
        """Force at displacements of the law (m, or rad of a rocker), N."""
        return _force(s, self.f_0, self.rate, self.length)

    @cached_property
    def course_plan(self) -> Plan:
        """Force and force of inertia over rise and fall, for smooth curves."""
        at = self.exact.at("cam-spring-between", tr("Forces of the spring and of inertia"), self.exact.display(),
                           tr("nodes of a smooth curve"))
        numbers = self.plan
        at.plan.add("F", FORCE, at.s, numbers["F_0"], numbers["c"], numbers["l"])
        at.plan.add("Q", INERTIA, at.dds, numbers["m"], numbers["ω"], numbers["l"])
        return at.plan

    @property
    def course(self) -> tuple[Step, Step, Step]:
        """Cam angle, force and force of inertia over rise and fall."""
        return self.course_plan["φ"], self.course_plan["F"], self.course_plan["Q"]

    @cached_property
    def at_positions(self) -> Step:
        """Force at the numbered positions, N."""
        at = self.exact.positions
        return at.plan.add("F", FORCE, at.s, self.plan["F_0"], self.plan["c"], self.plan["l"])

    def results(self) -> dict[str, Any]:
        """Results in SI: steps, and whether the pair stays closed."""
        return {"largest_inertia": self.plan["Q_max"], "F_max": self.plan["F_max"], "F_0": self.plan["F_0"],
                "stiffness": self.plan["c"], "way": self.plan["s"], "worst_ratio": self.plan["k_min"],
                "worst_phi": self.plan["φ_k"], "closed": self.closed}


def spring(exact: ExactMotion, length: float, mass: tuple[float, ...], speed: float, factor: float, preload: float) -> Spring:
    """Spring for force closure.

    Parameters
    ----------
    exact
        law of motion; ``length`` turns its displacement into a way, m (1, or the arm of a rocker).
    mass
        mass moved along that way, kg; of a rocker its moment of inertia, kg m^2, and its arm, m.
    speed
        rad/s.
    factor, preload
        largest force by the largest separating force of inertia; force in the lowest position by the largest.
    """
    law = exact.law
    plan = Plan("cam-spring", tr("Closing spring"), "m")
    given = {"mass": mass[0], "arm": mass[-1], "length": length, "speed": speed, "factor": factor, "preload": preload,
             "stroke": law.stroke}
    record(plan, "m l ω", {} if len(mass) == 1 else OF_ROCKER, SPRING, given=given)
    pieces = [*pieces_of((law.rise, law.fall), 1e-12)]
    _, x, p = extreme(lambda x, p: -p.dds(x), pieces)
    (dds,) = exact.found(plan, p, x, "Q", tr("{symbol}'' is least").format(symbol=law.symbol), (2,))
    record(plan, "Q_max F_max F_0 s c", SPRING, given={**given, "dds": dds})
    # Greatest is force of inertia over force of the spring, which is nowhere nothing.
    _, x, p = extreme(lambda x, p: -p.dds(x) / (preload + (1 - preload) * p.s(x) / law.stroke), pieces)
    s, dds = exact.found(plan, p, x, "k", tr("the ratio F/Q where {symbol}'' < 0 is least").format(symbol=law.symbol), (0, 2))
    record(plan, "k_min k_F", SPRING, given={**given, "displacement": s, "dds": dds})
    return Spring(exact, plan, speed)


# --- second disc ------------------------------------------------------------------------------------------------------


BACK = Rule("lay off backwards", lambda b, u, distance: b + u * -distance, ("point", "direction", "length"), "point",
            marked("From {0} along the line of the follower lay off the constant distance {2} between the rollers: point {name}."),
            lambda a, v: (Helper("line", a[0], v),))
DISTANCE = Rule("distance of the rollers", lambda s0, stroke: 2 * s0 + stroke, ("length", "length"), "length",
                marked("Distance between the rollers: {formula}."), source=SOURCE)


def _spread(pivot: Points, apex: Any, swing: Any) -> Any:
    turned = (apex - pivot) / -pivot
    return 2 * np.abs(np.arctan2(turned.imag, turned.real)) + swing


SPREAD = Rule("angle between the arms", _spread, ("point", "point", "inclination"), "inclination",
              marked("Angle between the arms of the rocker {name} = 2·∠B_0AO + ψ_max = {value}."), unit="rad", source=SOURCE)


TAPPET_DISC: StepTable = {
    "B′": ("B TN apart", "", BACK),
    "N′": ("B′ P", "", rules.RAY, marked("The normal {name} of the second disc passes through the same point {1}.")),
}
ROCKER_DISC: StepTable = {
    "B′": ("A B apart back", "", TURNED,
           marked("The second arm of the rocker is turned about {0} from the first by the constant angle {2}: point {name}.")),
    "B′A": ("B′ A", "", rules.RAY),
    "D′": ("B′ B′A x", "", rules.OFFSET,
           marked("From {0} towards the axis of the rocker lay off the segment AB·ψ' = {2}: point {name}.")),
    "N′": ("D′ O", "", rules.RAY, marked("The normal {name} of the second disc is parallel to the line {0}{1}.")),
}


def second_disc(inv: Inversion, apart: Step, cones: Cones) -> None:
    """Record the centre profile B′ of the second disc and its normals N′: rollers, or arms, keep what is ``apart``, m or rad."""
    table = TAPPET_DISC if cones.pivot is None else ROCKER_DISC
    record(inv.plan, " ".join(table), table, given={"apart": apart, "back": -cones.turn, "x": inv.at.plan.steps.get("x")})
