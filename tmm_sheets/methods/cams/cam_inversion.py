"""Profile of a cam by inversion: the cam stands still, the follower goes round it (метод обращенного движения).

Source: manual 000, section 7.3 and examples 1 to 3; manual 002, 4.4.

Frame: that of the cam, origin in its axis O, in position 0 y along the motion of the follower and x to the right.
Every step holds one value per cam angle; plans are in m.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.quantities import Points, Reals, Signs
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.methods.cams.cam_displacement import Displacement
from tmm_sheets.methods.cams.cam_zone import ALONG_ROCKER, TURNED, Zone
from tmm_sheets.words import marked, tr

Floats = npt.NDArray[np.float64]

LAY_OFF_FROM = Rule(
    "lay off an angle from a line", lambda o, b, r, angle, sense: o + r * ar.ray(o, b) * np.exp(1j * sense * angle),
    ("point", "point", "length", "angle", "number"), "point",
    marked("From the line {0}{1}, against the rotation of the cam, lay off the angle {3}; on the circle with the radius {2} mark "
           "point {name}."),
    lambda a, v: (Helper("line", a[0], v),),
)
PITCH_POINT = Rule(
    "centre of relative rotation", lambda o, u, ds: o + u * ds, ("point", "direction", "ordinate"), "point",
    marked("Through {0}, perpendicular to the line of the follower, lay off the first derivative {2}: point {name} on the normal "
           "to the profile."),
    lambda a, v: (Helper("line", a[0], v),),
)
ACROSS_LINE = Rule("perpendicular to a direction", lambda u, side: 1j * side * u, ("direction", "number"), "direction",
                   marked("Draw the perpendicular {name} to the line {0}."))
CONTACT = Rule("contact on the normal", lambda b, n, r: b + r * n, ("point", "direction", "length"), "point",
               marked("About {0} with the radius of the roller {2} draw a circle; point {name} of the profile lies on the normal "
                      "{1}."),
               lambda a, v: (Helper("circle", a[0], radius=a[2]),))
FOOT_OF_LINE = Rule("foot on the follower's line", lambda right, e: -(right * e) + 0j, ("number", "ordinate"), "point",
                    marked("At the distance e = {1} from O mark the foot {name} of the line of the follower."))
FROM_AXIS = Rule("point from the axis of the cam", lambda p, o: p - o, ("point", "point"), "point", marked("Mark point {name}."))


@primitive("tangent to the circle e")
def _touching(p: Points, centre: Points, e: Any, side: Signs) -> Points:
    return ar.tangent_point(p, centre, np.abs(e), side)


TANGENT_E = Rule("tangent to the circle e", _touching, ("point", "point", "ordinate", "number"), "point",
                 rules.TANGENT.wording, rules.TANGENT.helpers)
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


def translating(plan: Plan, dimensions: Zone, at: Displacement) -> Inversion:
    """Record the inversion of a translating roller follower."""
    right, e, s0, r0 = dimensions.right, *(dimensions.plan[name] for name in ("e", "S_0", "r_0"))
    o = plan.add("O", rules.GIVEN, 0j)
    foot = plan.add("T_0", FOOT_OF_LINE, right, e)
    start = plan.add("B_0", rules.ALONG, foot, 1j, s0,
                     say=tr("From the legs e and S_0 = {2} draw a right triangle; its vertex {name}."))
    axis = plan.add("A", rules.OFFSET, start, 1j, at.s,
                    say=tr("On the line of the follower lay off the displacement {2} from {0}: point {name}."))
    # The cam turns by -right * phi, so the follower goes round the standing cam by right * phi.
    ends = plan.add("N", LAY_OFF_FROM, o, start, r0, at.phi, right)
    feet = plan.add("T", TANGENT_E, ends, o, e, -right if dimensions.e >= 0 else right)
    lines = plan.add("TN", rules.RAY, feet, ends)
    radius = plan.add("OA", rules.DISTANCE, o, axis)
    centres = plan.add("B", rules.ARC_LINE, o, radius, ends, lines, 1.0)
    side = plan.add("⊥TN", ACROSS_LINE, lines, right)
    poles = plan.add("P", PITCH_POINT, o, side, at.ds)
    normals = plan.add("BP", rules.RAY, centres, poles)
    angles = plan.add("α", BETWEEN, normals, lines, right)
    return Inversion(plan, at, o, axis, ends, feet, lines, centres, normals, angles)


def rocker(plan: Plan, dimensions: Zone, at: Displacement) -> Inversion:
    """Record the inversion of an oscillating roller follower."""
    cones = dimensions.cones
    right, turn = cones.right, cones.turn
    zone, arm = dimensions.plan, dimensions.swing[3]
    o = plan.add("O", rules.GIVEN, 0j)
    a0 = plan.add("A_0", FROM_AXIS, zone["A"], zone["O"], say=tr("At the distance l_0 from O mark the axis {name} of the rocker."))
    b0 = plan.add("B_0", FROM_AXIS, zone["B_0"], zone["O"],
                  say=tr("From the sides r_0, l_0 and AB draw the triangle OA_0B_0; its vertex {name}."))
    axis = plan.add("C", TURNED, a0, b0, at.s, turn)
    ends = plan.add("A", LAY_OFF_FROM, o, a0, zone["l_0"], at.phi, right)
    radius = plan.add("OC", rules.DISTANCE, o, axis)
    side = float(np.sign(ar.cross(a0.value, b0.value)))
    centres = plan.add("B", rules.ARC_ARC, o, radius, ends, arm, side)
    line = plan.add("BA", rules.RAY, centres, ends)
    x = at.plan.add("x", ALONG_ROCKER, 1.0 if turn * right < 0 else -1.0, arm, at.ds)
    tips = plan.add("D", rules.OFFSET, centres, line, x,
                    say=tr("On the line of the rocker lay off the segment AB·ψ' = {2} from {0}: point {name}."))
    normals = plan.add("DO", rules.RAY, tips, o,
                       say=tr("Draw the line {0}{1}: the normal to the profile at B is parallel to it."))
    lines = plan.add("⊥BA", ACROSS_LINE, line, -turn)
    angles = plan.add("α", BETWEEN, normals, lines, right)
    return Inversion(plan, at, o, axis, ends, None, lines, centres, normals, angles)


def flat(plan: Plan, r0: Step, right: float, at: Displacement) -> Inversion:
    """Record the inversion of a flat follower; the plate is perpendicular to its motion."""
    o = plan.add("O", rules.GIVEN, 0j)
    start = plan.add("B_0", rules.ALONG, o, 1j, r0,
                     say=tr("On the line of the follower lay off the radius r_0 = {2}: point {name}."))
    axis = plan.add("A", rules.OFFSET, start, 1j, at.s,
                    say=tr("On the line of the follower lay off the displacement {2} from {0}: point {name}."))
    ends = plan.add("N", LAY_OFF_FROM, o, start, r0, at.phi, right)
    lines = plan.add("ON", rules.RAY, o, ends)
    radius = plan.add("OA", rules.DISTANCE, o, axis)
    centres = plan.add("B", rules.ARC_LINE, o, radius, o, lines, 1.0)
    plates = plan.add("⊥ON", ACROSS_LINE, lines, right,
                      say=tr("Through B draw the perpendicular {name} to {0}: the plane of the flat face."))
    plan.add("F", rules.OFFSET, centres, plates, at.ds,
             say=tr("On the flat face lay off the first derivative {2} from {0}: point {name} of contact with the profile."))
    normals = plan.add("−ON", rules.RAY, centres, o,
                       say=tr("The normal {name} to the profile is parallel to the line of the follower."))
    angles = plan.add("α", BETWEEN, normals, lines, right)
    return Inversion(plan, at, o, axis, ends, None, lines, centres, normals, angles)


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
