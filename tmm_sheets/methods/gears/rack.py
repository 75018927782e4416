"""Generating engagement (станочное зацепление): the tooth of a wheel as the envelope of the positions of a rack.

Basic rack of GOST 13755: straight flanks down to ``addendum`` modules below the reference line, then a tip radius
c* m/(1 - sin alpha) that ends in the tip line. Manual 003, section 4, sheet 3.

The wheel stands still, its centre in the origin; a tooth of the rack lies in the space over the centre, and the rack's
rolling line rolls on the pitch circle. Where the perpendicular from the point of contact of line and circle meets the
flank, flank and tooth touch. A complex point ``u + iy`` of the rack is ``u`` along its reference line from the middle of a
tooth, ``y`` away from the wheel. Lengths in metres, angles in radians.
"""

from __future__ import annotations

from cmath import phase, rect
from dataclasses import dataclass
from math import acos, ceil, cos, pi, sin, sqrt, tan
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.expression import Complex, Directions, Points, Reals, primitive
from tmm_sheets.construction.rules import ALONG, GIVEN, GIVEN_LENGTH, OFFSET
from tmm_sheets.construction.step import Given, Helper, Plan, Rule, Step, StepTable, record
from tmm_sheets.words import marked, tr


@dataclass(frozen=True)
class Rack:
    """A rack with its reference line ``shift`` modules outside the pitch circle of a wheel of ``teeth`` teeth."""

    module: float
    alpha: float
    addendum: float
    clearance: float
    teeth: int
    shift: float

    @property
    def r(self) -> float:
        """Radius of the wheel's pitch circle."""
        return self.module * self.teeth / 2

    @property
    def rb(self) -> float:
        """Radius of the base circle."""
        return self.r * cos(self.alpha)

    @property
    def tip_radius(self) -> float:
        """Radius between flank and tip line, c* m/(1 - sin alpha): 0.38 m for c* = 0.25, 0.304 m for 0.2."""
        return self.clearance * self.module / (1 - sin(self.alpha))

    @property
    def half_width(self) -> float:
        """Half of a tooth on the reference line."""
        return pi * self.module / 4

    @property
    def depth(self) -> float:
        """From the reference line to the tip line."""
        return (self.addendum + self.clearance) * self.module

    @property
    def tip_centre(self) -> complex:
        """Centre of the tip radius at the side of positive ``u``."""
        u = self.half_width - self.addendum * self.module * tan(self.alpha) - self.tip_radius * cos(self.alpha)
        return complex(u, self.tip_radius - self.depth)

    @property
    def rho_limit(self) -> float:
        """Radius of curvature of the involute where the flank's end cuts it; negative when the tooth is undercut."""
        return (self.shift - self.least_shift) * self.module / sin(self.alpha)

    @property
    def least_shift(self) -> float:
        """Shift at which the flank's end just touches the involute at the base circle: ha* - z sin^2 alpha/2."""
        return self.addendum - self.teeth * sin(self.alpha) ** 2 / 2

    @property
    def undercut(self) -> bool:
        """True when the rack's tip cuts into the involute."""
        return self.rho_limit < 0

    @property
    def tooth_half(self) -> float:
        """Half of the wheel's tooth at the base circle as an angle."""
        return (pi / 2 + 2 * self.shift * tan(self.alpha)) / self.teeth + tan(self.alpha) - self.alpha

    def roll_of_flank(self, tangent: Any) -> Reals:
        """Angle of rolling at which the involute is touched where its radius of curvature is ``tangent``."""
        along = (self.r + self.shift * self.module) * tan(self.alpha) - tangent / cos(self.alpha)
        return (along - self.half_width) / self.r

    def roll_of_tip(self, normal: Any) -> Reals:
        """Angle of rolling at which the tip radius cuts with its point under ``normal`` below the reference line."""
        below = -self.tip_centre.imag - self.shift * self.module
        return (below / np.tan(normal) - self.tip_centre.real) / self.r

    def rolls(self, tip: float) -> tuple[float, float]:
        """First and last angle of rolling at which the rack touches a flank that ends at the radius ``tip``."""
        first = self.roll_of_flank(sqrt((tip - self.rb) * (tip + self.rb)))
        return float(first), float(max(self.roll_of_tip(self.alpha), self.roll_of_tip(pi / 2)))

    def tooth(self, top: float, chords: int = 8) -> Complex:
        """One tooth from ``top`` over the reference line down and up again, its tip radii cut into ``chords``."""
        end = self.tip_centre
        turn = np.linspace(-self.alpha, -pi / 2, chords + 1)
        half = np.concatenate([[complex(self.half_width + top * tan(self.alpha), top)], end + self.tip_radius * np.exp(1j * turn)])
        return np.concatenate([half, -np.conj(half[::-1])])

    def outline(self, first: int, last: int, top: float) -> Complex:
        """Teeth ``first`` .. ``last`` one beside the other, right to left, with the bottoms of their spaces at ``top``."""
        pitch = pi * self.module
        return np.concatenate([self.tooth(top) + k * pitch for k in range(last, first - 1, -1)])

    def placed(self, points: Points, roll: Reals) -> Any:
        """Points of the rack on the wheel when it has rolled through ``roll``."""
        return (np.asarray(points) + self.r * roll + 1j * (self.r + self.shift * self.module)) * np.exp(1j * np.asarray(roll))

    def _tip_cut(self, normal: float) -> complex:
        """Point the tip radius cuts, seen from the axis of the tooth on the right."""
        roll = float(self.roll_of_tip(normal))
        point = complex(self.placed(self.tip_centre + rect(self.tip_radius, -normal), roll))
        return point / rect(1, pi / 2 - pi / self.teeth)

    def involute_from(self) -> float:
        """Radius of curvature at which the tooth's involute really begins, above the undercut where there is one."""
        if not self.undercut:
            return self.rho_limit

        def outside(normal: float) -> float:
            """How far the cut lies beyond the involute, as an angle away from the tooth."""
            point = self._tip_cut(normal)
            ratio = min(self.rb / abs(point), 1.0)
            return phase(point) - (self.tooth_half - tan(acos(ratio)) + acos(ratio))

        # The cut begins outside the involute and goes down to the base circle: it crosses the involute between.
        _, at_base = ar.halved(lambda normal: self.rb < abs(self._tip_cut(normal)), self.alpha, pi / 2)
        if outside(at_base) >= 0:
            return 0.0
        crossing = abs(self._tip_cut(ar.halved(lambda normal: outside(normal) > 0, self.alpha, at_base)[1]))
        return sqrt((crossing - self.rb) * (crossing + self.rb))

    def last_normal(self, start: float) -> float:
        """Normal of the tip radius' last cut, where the involute begins at ``start``; alpha unless there is undercut."""
        if not self.undercut:
            return self.alpha
        radius = sqrt(self.rb**2 + start**2)
        return ar.halved(lambda normal: radius < abs(self._tip_cut(normal)), self.alpha, pi / 2)[1]


@primitive("point within limits")
def _beyond_least(point: Any, start: Any, u: Directions, least: Any) -> Any:
    return np.where(ar.dot(point - start, u) >= least * (1 + 1e-12), point, np.nan)


FLANK = Rule("flank of the rack", lambda u, angle: u * np.exp(-1j * angle), ("direction", "angle"), "direction",
             marked("At the profile angle {1} to the axis of the rack tooth draw its flank."))
TAKEN = Rule("length in millimetres", lambda mm: mm / 1e3, ("number",), "length", marked("Take the segment {name} = {value}."),
             unit="m")
TAKEN_ORDINATE = Rule("ordinate in millimetres", lambda mm: mm / 1e3, ("number",), "ordinate",
                      marked("Take the segment {name} = {value}."),
                      unit="m")
ROLLS = Rule("angle of rolling", lambda roll: roll, ("inclination",), "inclination",
             marked("Angle of rolling of the rack {name} = {value}."),
             unit="rad")
DRAWN: StepTable = {
    "φ": ("phi_first phi_last number parts", "", Rule(
        "even share", lambda first, last, k, parts: first + (last - first) * k / parts,
        ("inclination", "inclination", "number", "number"), "inclination",
        marked("Divide the angle of rolling of the rack from {0} to {1} into equal parts ({3} of them): {name} = {value}."),
        unit="rad")),
    "r": ("radius", "", TAKEN),
    "xm": ("xm", "", TAKEN_ORDINATE, marked("Take the shift of the rack {name} = {value}.")),
    "a": ("a", "", TAKEN_ORDINATE, marked("Take half the thickness of the rack tooth {name} = {value}.")),
    "u": ("u", "", TAKEN_ORDINATE,
          marked("Take the distance of the centre of the rack's fillet from the axis of its tooth {name} = {value}.")),
    "y": ("y", "", TAKEN_ORDINATE,
          marked("Take the distance of the centre of the fillet from the reference line {name} = {value}.")),
    "h": ("h", "", TAKEN_ORDINATE,
          marked("Take the length of the straight part of the flank below the reference line {name} = {value}.")),
}
"""Angles of rolling and sizes of a rack on the sheet."""
POSITIONS: StepTable = {
    "O": ("origin", "", GIVEN),
    "W": ("O r φ", "", Rule(
        "roll on the pitch circle", lambda o, r, roll: o + 1j * r * np.exp(1j * roll), ("point", "length", "angle"), "point",
        marked("On the reference circle with the centre {0} and the radius {1} lay off an arc equal to the travel of the rack: "
               "point {name}."), lambda a, v: (Helper("line", a[0], v),))),
    "OW": ("O W", "", Rule("outward radius", ar.ray, ("point", "point"), "direction", marked("Draw the radius {0}{1}."),
                           lambda a, v: (Helper("line", a[0], a[1]),))),
    "WT": ("OW", "", Rule("rolling line", lambda u: -1j * u, ("direction",), "direction",
                          marked("Perpendicular to the radius draw the pitch line {name} of the rack."))),
    "s": ("r φ", "", Rule("travel of the rack", lambda r, roll: r * roll, ("length", "inclination"), "ordinate",
                          marked("Move the rack {value} from its middle position (the radius times the angle of rolling)."))),
    "T": ("W WT s", "", OFFSET),
    "M": ("T OW xm", "", Rule("shifted reference line", ar.along, ("point", "direction", "ordinate"), "point",
                              marked("From the pitch line lay off the shift {2}: point {name} of the reference line of the "
                                     "rack."))),
    "F": ("M WT a", "", OFFSET),
    "flank": ("OW alpha", "", FLANK),
    "D": ("M WT u", "", OFFSET),
    "C": ("D OW y", "", OFFSET),
}
"""Points and directions of the rack in its positions."""
CONTACT: StepTable = {
    "K": ("W F flank", "", Rule(
        "perpendicular on the flank", lambda p, q, u: ar.foot(p, q, u), ("point", "point", "direction"), "point",
        marked("From {0} drop the perpendicular to the flank of the rack tooth through {1}: point of contact {name}."),
        lambda a, v: (Helper("line", a[0], v),))),
    "E": ("K F flank bottom", "", Rule(
        "point within the straight flank", _beyond_least, ("point", "point", "direction", "ordinate"), "point",
        marked("Point {0} belongs to the tooth profile if it lies within the straight part of the rack: point {name}."))),
}
"""Where flank and tooth touch."""


def generating_plan(rack: Rack, rolls: Any) -> Plan:
    """Positions of the rack at the angles of rolling ``rolls`` and what each of them touches of the tooth.

    Steps: ``O`` centre, ``W`` point of contact of rolling line and pitch circle, ``M`` middle of the rack's tooth on the
    reference line, ``F`` flank there, ``K`` foot of the perpendicular, ``E`` the same where the straight flank reaches
    (NaN beyond), ``C`` centre of the tip radius.
    """
    plan = _positions("gear-rack-between", rack, rolls)
    record(plan, "K E", CONTACT, given={"bottom": -rack.addendum * rack.module / cos(rack.alpha)})
    return plan


def drawn_positions(sizes: Plan, radius: Step, alpha: Step, parts: int) -> Plan:
    """``parts`` + 1 positions of the rack, from the first to the last that touches.

    ``sizes`` of the rack, ``radius`` of the pitch circle and profile angle are steps.
    """
    plan = Plan("gear-rack", tr("Generation by the rack"), "m", tuple(str(k) for k in range(parts + 1)))
    record(plan, " ".join(DRAWN), DRAWN, given=sizes.steps | {
        "radius": radius, "number": Given(np.arange(parts + 1.0), "gear.rack.positions"), "parts": Given(
            parts, "gear.rack.parts", over="none", choice=tr("as many positions of the rack are shown on the sheet"))})
    _place(plan, alpha)
    record(plan, "K E", CONTACT, given={"bottom": plan["h"]})
    return plan


def _positions(name: str, rack: Rack, rolls: Any) -> Plan:
    """Positions of a rack that is known by numbers, for curves."""
    rolls = np.atleast_1d(np.asarray(rolls, dtype=float))
    plan = Plan(name, tr("Generation by the rack"), "m", tuple([str(k) for k in range(len(rolls))]))
    plan.add("φ", ROLLS, rolls)
    end = rack.tip_centre
    for size, value in (("r", rack.r), ("xm", rack.shift * rack.module), ("a", rack.half_width), ("u", end.real), ("y", end.imag)):
        plan.add(size, GIVEN_LENGTH, value)
    _place(plan, rack.alpha)
    return plan


def _place(plan: Plan, alpha: Reals) -> None:
    """Points and directions of the rack in its positions."""
    record(plan, " ".join(POSITIONS), POSITIONS, given={"origin": 0j, "alpha": alpha})


def fillet_steps(rack: Rack, normals: Any) -> Step:
    """Points of the fillet that the tip radius cuts with the points under ``normals`` below the rolling line."""
    normals = np.atleast_1d(np.asarray(normals, dtype=float))
    plan = _positions("gear-rack-fillet-between", rack, rack.roll_of_tip(normals))
    normal = plan.add("WC", FLANK, plan["WT"], normals, say=tr("Through {0} and the centre of the rack's fillet draw a line."))
    return plan.add("G", ALONG, plan["C"], normal, rack.tip_radius)


def _even_normals(rack: Rack, low: float, chord: float) -> npt.NDArray[np.float64]:
    """Normals from a right angle to ``low`` whose cuts stand equally far apart, at most ``chord`` modules."""
    trial = np.linspace(pi / 2, low, 257)
    along = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(np.asarray(fillet_steps(rack, trial).value))))))
    n = max(ceil(1.01 * along[-1] / (chord * rack.module)), 1)  # the trial's chords are not quite even
    return np.interp(np.linspace(0.0, along[-1], n + 1), along, trial)


def flank(rack: Rack, tip: float, involute: int = 32, chord: float = 0.04) -> Complex:
    """Flank of the tooth on the right from the root circle to the tip circle (radius ``tip``), relative to its axis.

    Its involute has ``involute`` points, the chords of its fillet are equal and at most ``chord`` modules long. The axis of
    the tooth is the real one and the flank lies on the side of positive angles; by the same steps as the positions that are
    drawn, taken at as many more as the curve needs.
    """
    start = rack.involute_from()
    lengths = np.sqrt(np.linspace(max(start, 0.0) ** 2, (tip - rack.rb) * (tip + rack.rb), involute))
    touched = np.asarray(generating_plan(rack, rack.roll_of_flank(lengths))["K"].value)
    low = rack.last_normal(max(start, 0.0))
    cut = np.asarray(fillet_steps(rack, _even_normals(rack, low, chord)).value)
    joined = cut[:-1] if abs(cut[-1] - touched[0]) < 1e-6 * rack.module else cut  # else the involute is cut off at its base
    return np.asarray(np.concatenate([joined, touched]) * rect(1, pi / rack.teeth - pi / 2))
