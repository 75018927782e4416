"""A disc cam with its follower: motion, main dimensions, roller, profile, closure and results.

Source: manual 000, section 7, examples 1 to 3; manual 002, 4.4 (radius of curvature by three points); manual 003, sheet 2
(radius of the roller, spring, second disc).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import degrees, floor, isfinite, log10, pi
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Rule
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams import cam_inversion, cam_zone
from tmm_sheets.methods.cams.cam_closure import Spring, second_disc_of_rocker, second_disc_of_tappet, spring
from tmm_sheets.methods.cams.cam_inversion import CONTACT, Inversion, curvature
from tmm_sheets.methods.cams.cam_laws import LAWS, Law, Phase, PositionFunction, table_law
from tmm_sheets.methods.cams.cam_motion import FollowerMotion, MotionScales, motion, motion_scales
from tmm_sheets.methods.cams.cam_zone import Plate, Zone

if TYPE_CHECKING:
    from tmm_sheets.task.schema import CamTable

Reals = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

DIAGRAMS = {"tappet": (325.0, 500.0), "rocker": (325.0, 288.0), "flat": (325.0, 500.0)}
"""Room on paper for the three diagrams when nobody asks for another one, mm: that of the sheet as shipped."""

SHARE_OF_R0 = (0.3, 0.4)
"""r_p <= (0.3 .. 0.4) r0 (manual 000, 7.3)."""
SHARE_OF_RHO = (0.7, 0.8)
"""r_p <= (0.7 .. 0.8) rho_min (manual 000, 7.3); manual 003 takes 0.5."""
DENSE = 128
"""Least number of parts of each phase in curves and in tables of results; the numbered positions are among them."""


def _peak(f: Callable[[float], Any], lo: float, hi: float) -> float:
    """Where a function with one maximum between ``lo`` and ``hi`` is largest, by the golden section."""
    ratio = (5**0.5 - 1) / 2
    a, b = hi - ratio * (hi - lo), lo + ratio * (hi - lo)
    fa, fb = f(a), f(b)
    for _ in range(50):
        if fa > fb:
            hi, b, fb = b, a, fa
            a = hi - ratio * (hi - lo)
            fa = f(a)
        else:
            lo, a, fa = a, b, fb
            b = lo + ratio * (hi - lo)
            fb = f(b)
    return (lo + hi) / 2


def _circle_centre(p: Any, q: Any, r: Any) -> Any:
    """Centre of the circle through three points: the perpendicular bisectors of two chords meet there."""
    return ar.line_line((p + q) / 2, 1j * ar.ray(p, q), (q + r) / 2, 1j * ar.ray(q, r))


THREE_POINT_CENTRE = Rule(
    "centre of a circle through three points", _circle_centre, ("point", "point", "point"), "point",
    "Через середины хорд {0}{1} и {1}{2} проведём перпендикуляры до пересечения в центре кривизны {name}.",
    lambda a, v: (Helper("line", (a[0] + a[1]) / 2, v), Helper("line", (a[1] + a[2]) / 2, v)),
)


@dataclass(frozen=True)
class Sharpest:
    """Sharpest convex place of the centre profile: cam angle, rad, exact radius of curvature, m.

    ``start`` and ``end`` are the cam angles between which the curvature has no jump, ``parts`` those of a phase.
    """

    phi: float
    rho: float
    start: float
    end: float
    parts: int = 8

    @property
    def three(self) -> Reals:
        """Cam angles of three points of that place, rad; the middle one is the sharpest where there is room."""
        step = (self.end - self.start) / (4 * self.parts)
        return min(max(self.phi, self.start + step), self.end - step) + step * np.arange(-1.0, 2.0)


@dataclass(frozen=True)
class RollerRule:
    """A rule r_p <= (0.3 .. 0.4) r0 or r_p <= (0.7 .. 0.8) rho_min: ``radius`` in m and its two shares."""

    symbol: str
    radius: float
    shares: tuple[float, float]

    @property
    def limits(self) -> tuple[float, float]:
        """The stricter and the milder limit, m."""
        return self.shares[0] * self.radius, self.shares[1] * self.radius


# --- the cam --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Cam:
    """A disc cam; every part is built when it is first asked for. The kinds of followers are its subclasses."""

    data: CamTable
    law: PositionFunction

    @property
    def right(self) -> float:
        """+1 when the velocity of the rising follower, turned by 90 degrees with the cam, points to the right, else -1."""
        return 1.0 if self.data.sense == "clockwise" else -1.0

    @property
    def alpha(self) -> float:
        """Permitted pressure angle, rad."""
        return float(self.data.pressure_angle or 0.0)

    @property
    def traits(self) -> frozenset[str]:
        """What tells sheets which views this cam has: follower, closure and spring."""
        shoe = "plate" if self.kind == "flat" else "roller"
        return frozenset({self.kind, self.data.closure, shoe, *(["spring"] if self.spring else [])})

    @property
    def kind(self) -> str:
        """Kind of the follower: "tappet", "rocker" or "flat"."""
        return {"translating roller": "tappet", "oscillating roller": "rocker", "flat": "flat"}[self.data.follower]

    # --- motion

    @cached_property
    def motion(self) -> FollowerMotion:
        """Diagrams S'', S', S at the scale factors of the shipped sheet."""
        return motion(self.law, self._scales)

    @cached_property
    def _scales(self) -> MotionScales:
        return self._scales_on(*DIAGRAMS[self.kind])

    def _scales_on(self, width: float, height: float) -> MotionScales:
        return motion_scales(self.law, width, height)

    def motion_on(self, width: float, height: float) -> FollowerMotion:
        """Diagrams S'', S', S at the scale factors that suit another place on paper, mm."""
        scales = self._scales_on(width, height)
        return self.motion if scales == self._scales else motion(self.law, scales)

    @cached_property
    def _ordinates(self) -> tuple[Reals, Reals]:
        m = self.motion
        return m.measured(m.s, m.scales.s), m.measured(m.ds, m.scales.ds)

    # --- profile

    @cached_property
    def inversion(self) -> Inversion:
        """Inversion in the numbered positions: the plan of the protocol."""
        return self._invert(Plan("cam-profile", "Профиль кулачка", "m", self.law.labels), self.law.positions, *self._ordinates)

    @cached_property
    def dense(self) -> Inversion:
        """The same inversion in many positions of a whole turn, for smooth curves and for results."""
        parts = self.law.parts
        return self.at(self.law.divided(parts * -(-DENSE // parts)))

    def at(self, phi: Reals) -> Inversion:
        """The same inversion at any cam angles, rad."""
        return self._bare(phi)

    def _bare(self, phi: Reals) -> Inversion:
        plan = Plan("cam-profile-between", "Профиль кулачка в промежуточных положениях", "m", tuple(map(str, range(len(phi)))))
        return self._invert(plan, phi, self.law.s(phi), self.law.ds(phi))

    def _invert(self, plan: Plan, phi: Reals, s: Reals, ds: Reals) -> Inversion:
        raise NotImplementedError

    @property
    def r0(self) -> float:
        """Smallest radius of the centre profile; of the profile itself under a flat follower, m."""
        raise NotImplementedError

    def check(self) -> None:
        """Build what can fail: :class:`CannotBuild` says what and what to try."""
        raise NotImplementedError

    # --- closure

    @cached_property
    def spring(self) -> Spring | None:
        """Closing spring; None with geometric closure, or when speed or mass are not given."""
        d = self.data
        mass = d.follower_mass
        if d.follower_inertia is not None and d.arm is not None:
            mass = d.follower_inertia / d.arm**2
        if d.closure != "force" or d.speed is None or mass is None:
            return None
        return spring(self.law, d.arm if d.arm is not None else 1.0, mass, d.speed, d.spring_factor, d.preload)

    # --- results

    def results(self, phi: Reals | None = None) -> dict[str, Any]:
        """Results in SI (m, rad) at the given cam angles, or over a whole turn, the numbered positions among them."""
        inv = self.dense if phi is None else self.at(np.asarray(phi, dtype=float))
        at = inv.phi
        found = {"phi": at.tolist(), "s": self.law.s(at).tolist(), "ds": self.law.ds(at).tolist(), "dds": self.law.dds(at).tolist()}
        found |= self._dimensions()
        found |= {
            "pressure_angle": inv.angles.value.tolist(),
            "pitch_curve": _pairs(inv.centres.value), "profile": _pairs(inv.plan["F"].value),
        }
        if "F′" in inv.plan:
            found["second_disc"] = {"pitch_curve": _pairs(inv.plan["B′"].value), "profile": _pairs(inv.plan["F′"].value)}
        if self.spring is not None:
            found["spring"] = self.spring.results()
        return found

    def _dimensions(self) -> dict[str, Any]:
        raise NotImplementedError


@dataclass(frozen=True)
class RollerCam(Cam):
    """A cam whose follower carries a roller."""

    @property
    def zone(self) -> Zone:
        """Allowed zone and main dimensions from the ordinates of the diagrams."""
        raise NotImplementedError

    @property
    def r0(self) -> float:
        """Smallest radius of the centre profile, m."""
        return self.zone.r0

    def _path(self, p: Phase, x: Any) -> tuple[Any, Any, Any]:
        """Path of the roller's centre before the standing cam, m, and its derivatives by the cam angle."""
        raise NotImplementedError

    def _path_of_second(self, p: Phase, x: Any) -> tuple[Any, Any, Any]:
        """The same of the roller of the second disc."""
        raise NotImplementedError

    def check(self) -> None:
        """Zone and roller."""
        _ = self.roller

    # --- roller

    @cached_property
    def sharpest(self) -> Sharpest:
        """Sharpest convex place of the centre profile."""
        return self._sharpest(self._path)

    def _sharpest(self, path: Callable[[Phase, Any], tuple[Any, Any, Any]]) -> Sharpest:
        best = Sharpest(0.0, float("inf"), 0.0, 0.0)
        for p in self.law.phases:

            def bend(x: Any, p: Phase = p) -> Any:
                return curvature(*path(p, x), self.right)

            for a, b in pairwise((0.0, *p.law.jumps, 1.0)):
                # Where the law jumps, the curvature is read from inside the piece.
                x = np.linspace(a + 1e-12, b - 1e-12, 257)
                k = int(np.argmax(bend(x)))
                at = _peak(bend, float(x[max(k - 1, 0)]), float(x[min(k + 1, 256)]))
                if float(bend(at)) * best.rho > 1 + 1e-12:
                    best = Sharpest(float(p.phi(at)), 1 / float(bend(at)), float(p.phi(a)), float(p.phi(b)), self.law.parts)
        return best

    @cached_property
    def rho_min(self) -> float:
        """Smallest radius of curvature of the convex parts of the centre profile, or of both where there are two discs, m."""
        second = self._sharpest(self._path_of_second).rho if self.data.closure == "geometric" else self.sharpest.rho
        return min(self.sharpest.rho, second)

    @property
    def roller_rules(self) -> tuple[RollerRule, RollerRule]:
        """The two rules for the radius of the roller."""
        given = self.data.curvature_share
        shares = SHARE_OF_RHO if given is None else (given, given)
        return RollerRule("r_0", self.zone.r0, SHARE_OF_R0), RollerRule("ρ_{min}", self.rho_min, shares)

    @cached_property
    def largest_roller(self) -> float:
        """Radius from which on the profile has a cusp or cuts itself, m.

        Besides the radii of curvature: no centre of the roller may lie within the circle that touches the centre profile
        anywhere from inside; the circle through q touching in p with the inner normal n has |q - p|^2 / (2 n (q - p)).
        """
        course = self._course
        pairs = [(course.centres.value, course.normals.value)]
        if "B′" in course.plan:
            pairs.append((course.plan["B′"].value, course.plan["N′"].value))
        least = self.rho_min
        for centres, normals in pairs:
            p, normal = centres[::2], normals[::2]
            d = p[None, :] - p[:, None]
            depth = d.real * normal.real[:, None] + d.imag * normal.imag[:, None]
            square = d.real**2 + d.imag**2
            # Points that coincide (0 and 2 pi) say nothing.
            apart = (depth > 0) & (square > (1e-6 * self.zone.r0) ** 2)
            radius = np.divide(square, 2 * depth, out=np.full_like(square, np.inf), where=apart)
            least = min(least, float(radius.min()))
        return least

    @cached_property
    def roller(self) -> float:
        """Radius of the roller, m: the given one, or by both rules, rounded down to 0.5 mm.

        Raises
        ------
        CannotBuild
            when the given one is too large for the profile.
        """
        given = self.data.roller
        if given is None:
            # Where another part of the profile is in the way, it limits the roller as a radius of curvature does.
            rules = self.roller_rules
            return _rounded_down(min(*(rule.limits[1] for rule in rules), rules[1].shares[1] * self.largest_roller))
        if not given < self.largest_roller:
            raise CannotBuild(
                f"cam: a roller of radius {given * 1e3:g} mm makes a profile with a cusp or a loop: "
                f"the centre profile allows less than {self.largest_roller * 1e3:.4g} mm",
                f"take a roller of at most {_rounded_down(min(r.limits[1] for r in self.roller_rules)) * 1e3:g} mm "
                "or leave cam.roller out")
        return given

    # --- profile

    @cached_property
    def inversion(self) -> Inversion:
        """Inversion in the numbered positions, with curvature, roller and profile: the plan of the protocol."""
        plan = Plan("cam-profile", "Профиль кулачка", "m", self.law.labels)
        inv = self._invert(plan, self.law.positions, *self._ordinates)
        near = self._bare(self.sharpest.three).centres.value
        say = "На самом крутом участке центрового профиля отметим точку {name}."
        e, d, g = (inv.plan.add(f"{name}_ρ", rules.GIVEN, complex(at), say=say) for name, at in zip("EDG", near, strict=True))
        centre = inv.plan.add("M", THREE_POINT_CENTRE, e, d, g)
        inv.plan.add("ρ_min", rules.DISTANCE, centre, d)
        return self._contact(inv)

    @cached_property
    def _course(self) -> Inversion:
        parts = self.law.parts
        return self._bare(self.law.divided(parts * -(-DENSE // parts)))

    @cached_property
    def dense(self) -> Inversion:
        """The same inversion in many positions of a whole turn, for smooth curves and for results."""
        return self._contact(self._course)

    def at(self, phi: Reals) -> Inversion:
        """The same inversion at any cam angles, rad."""
        return self._contact(self._bare(phi))

    def _contact(self, inv: Inversion) -> Inversion:
        inv.plan.add("F", CONTACT, inv.centres, inv.normals, self.roller)
        if "B′" in inv.plan:
            inv.plan.add("F′", CONTACT, inv.plan["B′"], inv.plan["N′"], self.roller)
        return inv


@dataclass(frozen=True)
class TappetCam(RollerCam):
    """A cam with a translating roller follower (толкатель)."""

    @cached_property
    def zone(self) -> Zone:
        """Allowed zone and main dimensions from the ordinates of the diagrams."""
        d = self.data
        return cam_zone.zone(self.law, self.alpha, d.limit, self.right, *self._ordinates, d.eccentricity, d.centre)

    @property
    def distance(self) -> float:
        """Distance of the rollers of the two discs, m: that with which both discs have the same smallest radius."""
        return 2 * self.zone.s0 + self.law.stroke

    def _invert(self, plan: Plan, phi: Reals, s: Reals, ds: Reals) -> Inversion:
        inv = cam_inversion.translating(plan, self.zone, phi, s, ds)
        if self.data.closure == "geometric":
            second_disc_of_tappet(inv, self.distance)
        return inv

    def _path(self, p: Phase, x: Any) -> tuple[Any, Any, Any]:
        return 1j * (self.zone.s0 + p.s(x)) - self.right * self.zone.e, 1j * p.ds(x), 1j * p.dds(x)

    def _path_of_second(self, p: Phase, x: Any) -> tuple[Any, Any, Any]:
        w, dw, ddw = self._path(p, x)
        return w - 1j * self.distance, dw, ddw

    def _dimensions(self) -> dict[str, Any]:
        z = self.zone
        found = {"r0": z.r0, "e": z.e, "s0": z.s0, "r_roller": self.roller, "rho_min": self.rho_min}
        return found | ({"roller_distance": self.distance} if self.data.closure == "geometric" else {})


@dataclass(frozen=True)
class RockerCam(RollerCam):
    """A cam with an oscillating roller follower (коромысло)."""

    @cached_property
    def zone(self) -> Zone:
        """Allowed zone and main dimensions from the ordinates of the diagrams."""
        d = self.data
        return cam_zone.rocker_zone(self.law, self.arm, self.alpha, d.limit, self.right, d.rotation == "same", *self._ordinates,
                                    d.centre)

    @property
    def arm(self) -> float:
        """Length of the rocker, m."""
        return float(self.data.arm or 0.0)

    @property
    def spread(self) -> float:
        """Angle between the arms of the two rollers, rad: that with which both discs have the same smallest radius."""
        pivot, apex = complex(self.zone.cones.pivot or 0j), complex(self.zone.apex.value)
        return 2 * abs(float(np.angle((apex - pivot) / -pivot))) + self.law.stroke

    def _invert(self, plan: Plan, phi: Reals, s: Reals, ds: Reals) -> Inversion:
        inv = cam_inversion.rocker(plan, self.zone, phi, s, ds)
        if self.data.closure == "geometric":
            second_disc_of_rocker(inv, -self.zone.cones.turn * self.spread, self.arm)
        return inv

    def _path(self, p: Phase, x: Any) -> tuple[Any, Any, Any]:
        return self._path_on(p, x, 1.0 + 0j)

    def _path_of_second(self, p: Phase, x: Any) -> tuple[Any, Any, Any]:
        return self._path_on(p, x, complex(np.exp(-1j * self.zone.cones.turn * self.spread)))

    def _path_on(self, p: Phase, x: Any, turned: complex) -> tuple[Any, Any, Any]:
        cones = self.zone.cones
        pivot, turn = complex(cones.pivot or 0j), 1j * cones.turn
        arm = -pivot * turned * np.exp(turn * p.s(x))
        first = turn * p.ds(x) * arm
        return pivot - complex(self.zone.apex.value) + arm, first, turn * p.dds(x) * arm + turn * p.ds(x) * first

    def _dimensions(self) -> dict[str, Any]:
        z = self.zone
        found: dict[str, Any] = {"r0": z.r0, "l0": z.l0, "r_roller": self.roller, "rho_min": self.rho_min}
        if (least := z.least()) is not None:
            found["least"] = {"r0": abs(least), "l0": abs(least - complex(z.cones.pivot or 0j))}
        return found | ({"arm_angle": self.spread} if self.data.closure == "geometric" else {})


@dataclass(frozen=True)
class FlatCam(Cam):
    """A cam under a flat follower (плоский толкатель)."""

    def _scales_on(self, width: float, height: float) -> MotionScales:
        return motion_scales(self.law, width, height, equal=True)

    @cached_property
    def plate(self) -> Plate:
        """Main dimensions from the ordinates of the diagrams."""
        m = self.motion
        return cam_zone.plate(self.law, *self._ordinates, m.measured(m.dds, m.scales.dds), self.data.base_radius)

    @property
    def r0(self) -> float:
        """Smallest radius of the profile, m."""
        return self.plate.r0

    def check(self) -> None:
        """Radius and plate."""
        _ = self.plate

    def _invert(self, plan: Plan, phi: Reals, s: Reals, ds: Reals) -> Inversion:
        return cam_inversion.flat(plan, self.r0, self.right, phi, s, ds)

    @property
    def rho_min(self) -> float:
        """Smallest radius of curvature of the profile, m."""
        return self.r0 + cam_zone.lowest_sum(self.law)[0]

    def _dimensions(self) -> dict[str, Any]:
        p = self.plate
        return {"r0": p.r0, "r_min": p.r_min, "l1": p.l1, "l2": p.l2, "rho_min": self.rho_min}


def _pairs(points: Complex) -> list[list[float]]:
    return [[p.real, p.imag] for p in points.tolist()]


def _rounded_down(radius: float) -> float:
    """Radius of a roller, m, rounded down to 0.5 mm; a smaller one to one significant digit."""
    if radius >= 0.5e-3:
        return floor(radius * 2000 * (1 + 1e-12)) / 2000
    unit = 10.0 ** floor(log10(radius))
    return floor(radius / unit * (1 + 1e-12)) * unit


def cam(data: CamTable) -> Cam:
    """Synthesis of a disc cam.

    Raises
    ------
    CannotBuild
        when the numbers allow no cam: at once for angles and lengths, for the axis and the roller when they are asked for.
    """
    if data.follower not in FOLLOWERS:
        raise CannotBuild(f"cam.follower: expected one of {', '.join(FOLLOWERS)}, not {data.follower!r}")
    follower, angular = FOLLOWERS[data.follower]
    _check_phases(data)
    _check_displacement(data, angular)
    if follower is not FlatCam and not 1e-6 < (data.pressure_angle or 0.0) < pi / 2 - 1e-6:
        raise CannotBuild("cam.pressure_angle: expected a permitted pressure angle greater than 0 and less than 90 deg, "
                          f"not {degrees(data.pressure_angle or 0.0):g} deg", "usual values are 30 deg for translating followers")
    if data.roller is not None and not data.roller > 0:
        raise CannotBuild(f"cam.roller: expected a radius greater than 0 mm, not {data.roller * 1e3:g} mm",
                          "leave it out to have it taken by both rules")
    stroke, symbol = (data.swing, "ψ") if angular else (data.stroke, "S")
    fall_law = None if data.fall_law is None else _law(data, data.fall_law, "fall_table")
    law = PositionFunction.of(data.rise, data.upper_dwell, data.fall, float(stroke or 0.0), _law(data, data.law, "table"), fall_law,
                              data.parts, symbol)
    return follower(data, law)


def _check_phases(data: CamTable) -> None:
    """The phase angles: a rise and a fall there must be, and a turn of the cam holds all three."""
    turn = data.rise + data.upper_dwell + data.fall
    for name, value in (("rise", data.rise), ("fall", data.fall)):
        if not value > 0:
            raise CannotBuild(f"cam.{name}: expected a phase angle greater than 0 deg, not {degrees(value):g} deg")
    if not data.upper_dwell >= 0:
        raise CannotBuild(f"cam.upper_dwell: expected a phase angle of 0 deg or more, not {degrees(data.upper_dwell):g} deg")
    if not turn <= 2 * pi * (1 + 1e-9):
        raise CannotBuild(f"cam: rise, upper_dwell and fall make {degrees(turn):g} deg together, more than a turn of the cam",
                          "shorten a phase: what is left of 360 deg is the lower dwell")


def _check_displacement(data: CamTable, angular: bool) -> None:
    """The stroke, or of a rocker arm and swing."""
    for name, length in (("arm", data.arm),) if angular else (("stroke", data.stroke),):
        if length is None or not (length > 0 and isfinite(length)):
            raise CannotBuild(f"cam.{name}: expected a length greater than 0 mm, not {(length or 0.0) * 1e3:g} mm")
    if angular and not 0 < (data.swing or 0.0) < pi / 2:
        raise CannotBuild("cam.swing: expected an angle greater than 0 and less than 90 deg, "
                          f"not {degrees(data.swing or 0.0):g} deg")


def _law(data: CamTable, name: str, table: str) -> Law:
    if name == "table":
        return table_law(*data.diagram(table), key=f"cam.{table}")
    if name not in LAWS:
        raise CannotBuild(f"cam.law: expected one of {', '.join(LAWS)} or table, not {name!r}")
    return LAWS[name]


FOLLOWERS: dict[str, tuple[type[Cam], bool]] = {
    "translating roller": (TappetCam, False), "oscillating roller": (RockerCam, True), "flat": (FlatCam, False),
}
"""Kinds of followers by the name they have in project files, and whether their displacement is an angle."""
