"""A disc cam with its follower: motion, main dimensions, roller, profile, closure and results.

Source: manual 000, section 7, examples 1 to 3; manual 002, 4.4 (radius of curvature by three points); manual 003, sheet 2
(radius of the roller, spring, second disc).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import pairwise
from math import floor, log10, pi
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Floats, Points, Reals, primitive
from tmm_sheets.construction.step import (
    Given,
    GivenNumber,
    Helper,
    Plan,
    Reading,
    Rule,
    Step,
    StepTable,
    asked_for,
    planned,
    record,
    value_of,
)
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams import cam_inversion, cam_zone
from tmm_sheets.methods.cams.cam_displacement import Displacement, ExactMotion
from tmm_sheets.methods.cams.cam_inversion import (
    CONTACT,
    DISTANCE,
    ROCKER_RADIUS,
    SPREAD,
    TAPPET_RADIUS,
    Inversion,
    Spring,
    rocker_curvature,
    second_disc,
    spring,
    tappet_curvature,
)
from tmm_sheets.methods.cams.cam_laws import LAWS, PHASES, Law, Phase, PositionFunction, ordinates_law, table_law
from tmm_sheets.methods.cams.cam_motion import FollowerMotion, MotionScales, motion, motion_scales
from tmm_sheets.methods.cams.cam_zone import Plate, Zone, extreme, pieces_of
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.task.schema import CamTable


DIAGRAMS = {"tappet": (327.0, 500.0), "rocker": (327.0, 288.0), "flat": (327.0, 500.0)}
"""Room on paper for the three diagrams when nobody asks for another one, mm: that of the sheet as shipped."""

SHARE_OF_R0 = (0.3, 0.4)
"""r_p <= (0.3 .. 0.4) r0 (manual 000, 7.3)."""
SHARE_OF_RHO = (0.7, 0.8)
"""r_p <= (0.7 .. 0.8) rho_min (manual 000, 7.3); manual 003 takes 0.5."""
ASKED = marked("cam angles asked for")
"""What tells cam angles that are not those of the program."""
DRAWN, OPENINGS = 0.05, (1.0, 0.5, 0.25, 0.125)
"""Error with which a radius of curvature by three points is taken; the distances of these that are tried, in parts of the usual."""
DENSE = 128
"""Least number of parts of each phase in curves and in tables of results; the numbered positions are among them."""


def _circle_centre(p: Points, q: Points, r: Any) -> Points:
    """Centre of the circle through three points: the perpendicular bisectors of two chords meet there."""
    return ar.line_line((p + q) / 2, 1j * ar.ray(p, q), (q + r) / 2, 1j * ar.ray(q, r))


GIVEN = {"rise": (PHASES["φ_у"], "rad"), "upper_dwell": (PHASES["φ_дс"], "rad"), "fall": (PHASES["φ_с"], "rad"),
         "stroke": ("S_{max}", "m"),
         "swing": ("ψ_{max}", "rad"), "arm": ("AB", "m"), "centre_distance": ("l_0", "m"), "eccentricity": ("e", "m"),
         "pressure_angle": ("[α]", "rad"),
         "base_radius": ("r_0", "m"), "roller": ("r_p", "m"), "curvature_share": ("", "1"), "speed": ("ω", "rad/s"),
         "follower_mass": ("m", "kg"), "follower_inertia": ("J", "kg*m2"), "spring_factor": ("", "1"), "preload": ("", "1")}
"""Symbol and unit of the numbers of a project file."""


def given(data: CamTable, key: str) -> GivenNumber | None:
    """A number of the project file that knows its place there; None where it is left out."""
    value = getattr(data, key)
    symbol, unit = GIVEN[key]
    letter = tr(symbol) if symbol in PHASES.values() else symbol  # as a text "m" is a unit
    return None if value is None else GivenNumber(value, f"cam.{data.place(key)}", letter, unit)


@dataclass(frozen=True)
class Sharpest:
    """Sharpest convex place of a centre profile: phase and share, and the step of its exact radius of curvature, m.

    ``start`` and ``end`` are the cam angles between which the curvature has no jump, ``parts`` those of a phase.
    """

    phase: Phase
    x: float
    radius: Step
    start: float
    end: float
    parts: int = 8

    @property
    def phi(self) -> float:
        """Cam angle, rad."""
        return float(self.phase.phi(self.x))

    @property
    def rho(self) -> float:
        """Radius of curvature, m."""
        return float(self.radius.value)

    def threes(self) -> Iterator[Floats]:
        """Cam angles of three points of that place, rad, the wide ones first.

        The middle one is the sharpest where there is room up to a jump; then also where there is none, for where curvature has no
        jump, as between a fall and a rise by the law of the sine, the circle is the better one.
        """
        usual = (self.end - self.start) / (4 * self.parts)
        for step in (usual * share for share in OPENINGS):
            yield min(max(self.phi, self.start + step), self.end - step) + step * np.arange(-1.0, 2.0)
            yield np.mod(self.phi + step * np.arange(-1.0, 2.0), 2 * pi)


@dataclass(frozen=True)
class RollerRule:
    """A rule r_p <= (0.3 .. 0.4) r0 or r_p <= (0.7 .. 0.8) rho_min: its two shares and the stricter and the milder limit."""

    symbol: str
    shares: tuple[float, float]
    steps: tuple[Step, Step]

    @property
    def limits(self) -> tuple[float, float]:
        """The stricter and the milder limit, m."""
        return float(self.steps[0].value), float(self.steps[1].value)


@primitive("rounded down to half a millimetre", "real")
def rounded_down(radius: Reals) -> Reals:
    """Radius of a roller, m, rounded down to 0.5 mm; a smaller one to one significant digit."""
    if radius >= 0.5e-3:
        return floor(radius * 2000 * (1 + 1e-12)) / 2000
    unit = 10.0 ** floor(log10(radius))
    return floor(radius / unit * (1 + 1e-12)) * unit


def _inscribed(centres: Any, normals: Any, i: Any, j: Any) -> Any:
    p, n = rules.take(centres, i), rules.take(normals, i)
    d = rules.take(centres, j) - p
    return (d.real**2 + d.imag**2) / (2 * (d.real * n.real + d.imag * n.imag))


INSCRIBED = Rule("circle that touches the centre profile from inside", _inscribed, ("point", "direction", "number", "number"),
                 "length",
                 marked("Circle that touches the pitch curve from inside and passes through another point of it: {name} = "
                        "{value}."))
LEAST = Rule("least length", lambda *of: reduce(np.minimum, of), ("length",) * 5, "length",
             marked("The least of these values: {name} = {value}."))
PART = Rule("part of a radius", lambda share, radius: share * radius, ("number", "length"), "length",
            marked("Limit of the radius of the roller {0}·{1} = {value}."), source="000, 7.3")
ROUNDED = Rule("rounded roller", rounded_down, ("length",), "length",
               marked("Round the radius of the roller down to 0.5 mm: {name} = {value}."))
CHOSEN = Rule("given roller", lambda radius: radius, ("length",), "length", marked("Given radius of the roller {name} = {value}."))
OF_THREE = Rule("point of the sharpest place", rules.take, ("point", "number"), "point",
                marked("At the sharpest place of the pitch curve mark point {name}."))
BY_THREE_POINTS: StepTable = {
    "E_ρ": ("near 0", "", OF_THREE),
    "D_ρ": ("near 1", "", OF_THREE),
    "G_ρ": ("near 2", "", OF_THREE),
    "M": ("E_ρ D_ρ G_ρ", "", Rule(
        "centre of a circle through three points", _circle_centre, ("point", "point", "point"), "point",
        marked("Through the middles of the chords {0}{1} and {1}{2} draw perpendiculars; they meet at the centre of curvature "
               "{name}."),
        lambda a, v: (Helper("line", (a[0] + a[1]) / 2, v), Helper("line", (a[1] + a[2]) / 2, v)))),
    "ρ_min": ("M D_ρ", "", rules.DISTANCE),
}
"""Radius of curvature of the sharpest place by the circle through three of its points."""


# --- the cam --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Cam(ABC):
    """A disc cam; every part is built when it is first asked for. The kinds of followers are its subclasses.

    A cam is no other of the same data: what is kept of one is its own.
    """

    data: CamTable
    law: PositionFunction

    @property
    def right(self) -> float:
        """+1 when the velocity of the rising follower, turned by 90 degrees with the cam, points to the right, else -1."""
        return GivenNumber(1.0 if self.data.sense == "clockwise" else -1.0, "cam.sense")

    @property
    def alpha(self) -> float:
        """Permitted pressure angle, rad."""
        return self.given("pressure_angle") or 0.0

    def given(self, key: str) -> GivenNumber | None:
        """A number of the project file that knows its place there; None where it is left out."""
        return given(self.data, key)

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
    def exact(self) -> ExactMotion:
        """What follows from the law alone."""
        return ExactMotion(self.law)

    @cached_property
    def motion(self) -> FollowerMotion:
        """Diagrams S'', S', S at the scale factors of the shipped sheet."""
        return motion(self.law, self._scales, self.exact)

    @cached_property
    def _scales(self) -> MotionScales:
        return motion_scales(self.law, *DIAGRAMS[self.kind], equal=self.kind == "flat")

    # --- profile

    @cached_property
    def inversion(self) -> Inversion:
        """Inversion in the numbered positions: the plan of the protocol."""
        return self._invert(Plan("cam-profile", tr("Cam profile"), "m", self.law.labels), self.motion.ordinates)

    @cached_property
    def dense(self) -> Inversion:
        """Inversion with the profile in many positions of a whole turn, for smooth curves and for results."""
        return self._contact(self._course)

    @cached_property
    def _course(self) -> Inversion:
        parts = self.law.parts
        return self._bare(self.law.divided(parts * -(-DENSE // parts)))

    def at(self, phi: Floats) -> Inversion:
        """Inversion with the profile at cam angles ``phi``, rad."""
        return self._contact(self._bare(phi, choice=tr(ASKED)))

    def _contact(self, inv: Inversion) -> Inversion:
        """Record the profile where the inversion alone does not give it."""
        return inv

    def _bare(self, phi: Floats, name: str = "between",
              choice: str = marked("the phases are divided into equal parts")) -> Inversion:
        at = self.exact.at(f"cam-law-{name}", tr("Law of motion between the positions"), phi, choice)
        return self._invert(Plan(f"cam-profile-{name}", tr("Cam profile between the positions"), "m", at.plan.labels), at)

    @abstractmethod
    def _invert(self, plan: Plan, at: Displacement) -> Inversion:
        """Record the inversion of the follower."""

    @property
    @abstractmethod
    def r0(self) -> float:
        """Smallest radius of the centre profile; of the profile itself under a flat follower, m."""

    def check(self) -> None:
        """Build what can fail: :class:`CannotBuild` says what and what to try."""
        self._dimensions()

    # --- closure

    @cached_property
    def spring(self) -> Spring | None:
        """Closing spring; None with geometric closure, or when speed or mass are not given."""
        d = self.data
        keys = ("follower_inertia", "arm") if d.follower_inertia is not None and d.arm is not None else ("follower_mass",)
        mass = tuple(m for key in keys if (m := self.given(key)) is not None)
        speed, factor, preload = (self.given(key) for key in ("speed", "spring_factor", "preload"))
        if d.closure != "force" or speed is None or not mass or factor is None or preload is None:
            return None
        return spring(self.exact, self.given("arm") or 1.0, mass, speed, factor, preload)

    # --- results

    def results(self, phi: Floats | None = None) -> dict[str, Any]:
        """Results in SI (m, rad) at the given cam angles, or over a whole turn, the numbered positions among them."""
        inv = self.dense if phi is None else self.at(np.asarray(phi, dtype=float))
        found: dict[str, Any] = {"phi": inv.at.phi, "s": inv.at.s, "ds": inv.at.ds, "dds": inv.at.dds, **self._dimensions()}
        found |= {"pressure_angle": inv.angles, "pitch_curve": inv.centres, "profile": inv.plan["F"]}
        if "F′" in inv.plan:
            found["second_disc"] = {"pitch_curve": inv.plan["B′"], "profile": inv.plan["F′"]}
        if self.spring is not None:
            found["spring"] = self.spring.results()
        return found

    @property
    def plans(self) -> dict[str, Plan]:
        """All plans in the order of construction."""
        exact, m = self.exact, self.motion
        return asked_for((exact.phases, exact.positions, exact.before, exact.after, m.numbers, m.areas, m, m.between_plan,
                          m.ordinates, self._dimension_plans(), self.inversion, self.dense.at, self.dense,
                          self.spring and (self.spring, self.spring.course_plan)))

    @abstractmethod
    def _dimension_plans(self) -> tuple[Any, ...]:
        """Plans of the main dimensions, or what has them, in the order of construction."""

    @abstractmethod
    def _dimensions(self) -> dict[str, Any]:
        """Main dimensions as results."""


@dataclass(frozen=True, eq=False)
class RollerCam(Cam):
    """A cam whose follower carries a roller.

    A kind of follower is data: ``DIMENSIONS`` are its steps in the zone by the keys of the results. ``APART`` is what keeps the
    rollers of two discs apart: its key, its step, the rule that makes it, and of which steps of the zone and of the stroke.
    ``BENT`` is the rule of its radius of curvature, the curvature itself, and of which steps of the zone they are made beside the
    motion; those of a rocker also of the sense of its rise. ``INVERTED`` records its inversion.
    """

    DIMENSIONS: ClassVar[dict[str, str]]
    APART: ClassVar[tuple[str, str, Rule, str]]
    BENT: ClassVar[tuple[Rule, Callable[..., Any], str]]
    INVERTED: ClassVar[Callable[[Plan, Zone, Displacement], Inversion]]

    @property
    @abstractmethod
    def zone(self) -> Zone:
        """Allowed zone and main dimensions from the ordinates of the diagrams."""

    @property
    def r0(self) -> float:
        """Smallest radius of the centre profile, m."""
        return self.zone.r0

    @property
    def least(self) -> Plan | None:
        """Least possible cam of a rocker; None where there is none."""
        return None if self.zone.cones.pivot is None else self.zone.least

    @cached_property
    def steepest(self) -> Plan | None:
        """Greatest pressure angles where the radius is given and they follow; None where the permitted one gives the radius."""
        return None if self.data.base_radius is None else cam_zone.max_pressure_angles(self.zone)

    def _dimensions(self) -> dict[str, Any]:
        z = self.zone
        _ = self.roller
        found: dict[str, Any] = {key: z.plan[name] for key, name in self.DIMENSIONS.items()}
        found |= {"r_roller": self.choice["r_p"], "rho_min": self.curvature["ρ_min"]}
        if self.least is not None:
            found["least"] = {key: self.least[name] for key, name in self.DIMENSIONS.items()}
        if self.steepest is not None:
            found["steepest"] = {phase: {"phi": self.steepest[f"φ_α{k}"], "pressure_angle": self.steepest[f"α_{k}"]}
                                 for k, phase in enumerate(("rise", "fall"), 1)}
        return found | ({self.APART[0]: self.apart} if self.apart else {})

    @property
    def apart(self) -> Step | None:
        """What keeps the rollers of two discs apart: their distance, m, or the angle between their arms, rad; None for one disc."""
        return None if self.discs is None else next(iter(self.discs))

    @cached_property
    def discs(self) -> Plan | None:
        """Plan of what keeps the rollers of two discs apart: that with which both discs have the same smallest radius."""
        if self.data.closure != "geometric":
            return None
        plan = Plan("cam-discs", tr("Two discs"), "m")
        _, name, rule, of = self.APART
        plan.add(name, rule, *(self.zone.plan[step] for step in of.split()), self.law.stroke)
        return plan

    def _invert(self, plan: Plan, at: Displacement) -> Inversion:
        inv = type(self).INVERTED(plan, self.zone, at)
        if self.apart is not None:
            second_disc(inv, self.apart, self.zone.cones)
        return inv

    def _dimension_plans(self) -> tuple[Any, ...]:
        z, near = self.zone, self.near
        return (z.plans, z.curve_plan, z.every, z.beyond, self.steepest, self.discs, self.curvature, near.at, near, self.choice,
                self.least)

    # --- curvature

    @cached_property
    def _curvature(self) -> tuple[Plan, list[Sharpest]]:
        plan = Plan("cam-curvature", tr("Least radius of curvature of the pitch curve"), "m")
        places = [self._sharpest(plan, second) for second in ((False, True) if self.discs else (False,))]
        plan.add("ρ_min", LEAST, *(found.radius for found in places), symbol="ρ_{min}")
        return plan, places

    @property
    def curvature(self) -> Plan:
        """Exact radii of curvature of the sharpest places."""
        return self._curvature[0]

    @property
    def sharpest(self) -> Sharpest:
        """Sharpest convex place of the centre profile."""
        return self._curvature[1][0]

    def _sharpest(self, plan: Plan, second: bool) -> Sharpest:
        rule, curvature, names = self.BENT
        z = self.zone
        of = (*(z.plan[name] for name in names.split()), *((z.cones.turn,) if z.cones.pivot is not None else ()), self.right,
              self.apart if second else 0.0)
        known = [value_of(a) for a in of]
        _, at, p = extreme(lambda x, p: curvature(p.s(x), p.ds(x), p.dds(x), *known), pieces_of(self.law.phases, 1e-12))
        a, b = next((a, b) for a, b in pairwise((0.0, *p.law.jumps, 1.0)) if a < at < b)
        tag = "ρ2" if second else "ρ"
        moving = self.exact.found(plan, p, at, tag, tr("the curvature of the convex part of the pitch curve is greatest"))
        radius = plan.add("ρ2_min" if second else "ρ_1", rule, *moving, *of)
        return Sharpest(p, at, radius, float(p.phi(a)), float(p.phi(b)), self.law.parts)

    rho_min = Reading("curvature", "ρ_min")
    """Smallest radius of curvature of the convex parts of the centre profile, or of both where there are two discs, m."""

    @cached_property
    def near(self) -> Inversion:
        """The inversion in three points of the sharpest place."""
        return self._bare(self.three, "curvature-between", tr("three points of the sharpest place of the pitch curve"))

    @cached_property
    def three(self) -> Floats:
        """Cam angles of three points of the sharpest place, rad: as far apart as the circle through them tells its radius.

        Curvature may rise and fall steeply there: between fall and rise of a cam without dwells 5.6 degrees gave 34 mm for 28 mm.
        """
        errors: list[tuple[float, Floats]] = []
        for three in self.sharpest.threes():
            e, d, g = self._bare(three).centres.value
            error = abs(abs(_circle_centre(e, d, g) - d) / self.sharpest.rho - 1.0)
            if error <= DRAWN:
                return three
            errors.append((float(error), three))
        _, least = min(errors, key=lambda found: found[0])
        return least

    # --- roller

    @planned("cam-roller", marked("Choice of the radius of the roller"), "m")
    def choice(self, plan: Plan) -> None:
        """Choice of the roller's radius by both rules.

        Where another part of the profile is in the way, it limits the roller as a radius of curvature does.
        """
        rho = self.curvature["ρ_min"]
        share = self.given("curvature_share")
        of_rho = SHARE_OF_RHO if share is None else (share, share)
        for name, radius, shares in (("r_0", self.zone.plan["r_0"], SHARE_OF_R0), ("ρ", rho, of_rho)):
            for i, part in enumerate(shares, 1):
                plan.add(f"{name}_{i}", PART, part, radius)
        most = plan.add("r_max", LEAST, rho, *self._inscribed(plan))
        chosen = self.given("roller")
        if chosen is not None:
            plan.add("r_p", CHOSEN, chosen, symbol="r_p")
            return
        limit = plan.add("r_max_2", PART, plan["ρ_2"].args[0], most)
        plan.add("r_p", ROUNDED, plan.add("r", LEAST, plan["r_0_2"], plan["ρ_2"], limit), symbol="r_p")

    def _inscribed(self, plan: Plan) -> list[Step]:
        """Record the least circle that touches a centre profile anywhere from inside and goes through another of its points.

        No centre of the roller may lie within it; the circle through q touching in p with the inner normal n has
        |q - p|^2 / (2 n (q - p)). None where no point lies on the inner side of another.
        """
        course = self._course
        found: tuple[float, Any, Any, int, int] | None = None
        for centres, normals in [("B", course.normals.name), *([("B′", "N′")] if self.discs else [])]:
            p, normal = (course.plan[name].value[::2] for name in (centres, normals))
            d = p[None, :] - p[:, None]
            depth = d.real * normal.real[:, None] + d.imag * normal.imag[:, None]
            square = d.real**2 + d.imag**2
            # Points that coincide (0 and 2 pi) say nothing.
            apart = (depth > 0) & (square > (1e-6 * self.zone.r0) ** 2)
            radius = np.divide(square, 2 * depth, out=np.full_like(square, np.inf), where=apart)
            i, j = np.unravel_index(int(np.argmin(radius)), radius.shape)
            if radius[i, j] < (found[0] if found else np.inf):
                found = float(radius[i, j]), course.plan[centres], course.plan[normals], 2 * int(i), 2 * int(j)
        if found is None:
            return []
        choice = tr("the pair of points of the pitch curve with the least inscribed circle")
        of, normals, *pair = found[1:]
        places = (Given(float(k), "cam-profile-between", choice=choice, over="none") for k in pair)
        return [plan.add("r_вп", INSCRIBED, of, normals, *places, symbol=tr("r_in"))]

    @property
    def roller_rules(self) -> tuple[RollerRule, RollerRule]:
        """The two rules for the radius of the roller."""
        plan, share = self.choice, self.data.curvature_share
        shares = SHARE_OF_RHO if share is None else (share, share)
        return (RollerRule("r_0", SHARE_OF_R0, (plan["r_0_1"], plan["r_0_2"])),
                RollerRule("ρ_{min}", shares, (plan["ρ_1"], plan["ρ_2"])))

    largest_roller = Reading("choice", "r_max")
    """Radius from which on the profile has a cusp or cuts itself, m."""

    @cached_property
    def roller(self) -> float:
        """Radius of the roller, m: the given one, or by both rules, rounded down to 0.5 mm.

        Raises
        ------
        CannotBuild
            when the given one is too large for the profile.
        """
        radius = float(self.choice["r_p"].value)
        if self.data.roller is not None and not radius < self.largest_roller:
            raise CannotBuild(
                tell("cam: a roller of radius {radius:g} mm makes a profile with a cusp or a loop: the centre profile allows less "
                     "than {most:.4g} mm").format(radius=radius * 1e3, most=self.largest_roller * 1e3),
                tell("take a roller of at most {radius:g} mm or leave cam.roller out").format(
                    radius=rounded_down(min(r.limits[1] for r in self.roller_rules)) * 1e3))
        return radius

    # --- profile

    @cached_property
    def inversion(self) -> Inversion:
        """Inversion in the numbered positions, with curvature, roller and profile: the plan of the protocol."""
        inv = super().inversion
        record(inv.plan, " ".join(BY_THREE_POINTS), BY_THREE_POINTS, given={"near": self.near.centres, "0": 0, "1": 1, "2": 2})
        return self._contact(inv)

    def _contact(self, inv: Inversion) -> Inversion:
        _ = self.roller
        inv.plan.add("F", CONTACT, inv.centres, inv.normals, self.choice["r_p"])
        if "B′" in inv.plan:
            inv.plan.add("F′", CONTACT, inv.plan["B′"], inv.plan["N′"], self.choice["r_p"])
        return inv


@dataclass(frozen=True, eq=False)
class TappetCam(RollerCam):
    """A cam with a translating roller follower (толкатель)."""

    DIMENSIONS, APART = {"r0": "r_0", "e": "e", "s0": "S_0"}, ("roller_distance", "L", DISTANCE, "S_0")
    BENT = TAPPET_RADIUS, tappet_curvature, "S_0 e"
    INVERTED = cam_inversion.translating

    @cached_property
    def zone(self) -> Zone:
        """Allowed zone and main dimensions from the ordinates of the diagrams."""
        at = self.motion.ordinates
        return cam_zone.zone(self.law, self.alpha, self.data.limit, self.right, at.s, at.ds, self.given("eccentricity"),
                             self.data.centre, self.exact, self.given("base_radius"))


@dataclass(frozen=True, eq=False)
class RockerCam(RollerCam):
    """A cam with an oscillating roller follower (коромысло)."""

    DIMENSIONS, APART = {"r0": "r_0", "l0": "l_0"}, ("arm_angle", "ψ_12", SPREAD, "A O")
    BENT = ROCKER_RADIUS, rocker_curvature, "A O"
    INVERTED = cam_inversion.rocker

    @cached_property
    def zone(self) -> Zone:
        """Allowed zone and main dimensions from the ordinates of the diagrams."""
        d, at = self.data, self.motion.ordinates
        return cam_zone.rocker_zone(self.law, self.arm, self.alpha, d.limit, self.right, d.rotation == "same", at.s, at.ds,
                                    d.centre, self.exact, self.given("base_radius"), self.given("centre_distance"))

    @property
    def arm(self) -> float:
        """Length of the rocker, m."""
        return self.given("arm") or 0.0

@dataclass(frozen=True, eq=False)
class FlatCam(Cam):
    """A cam under a flat follower (плоский толкатель)."""

    @cached_property
    def plate(self) -> Plate:
        """Main dimensions from the ordinates of the diagrams."""
        at = self.motion.ordinates
        return cam_zone.plate(self.law, at.s, at.dds, self.given("base_radius"), self.exact)

    @property
    def r0(self) -> float:
        """Smallest radius of the profile, m."""
        return self.plate.r0

    def _invert(self, plan: Plan, at: Displacement) -> Inversion:
        return cam_inversion.flat(plan, self.plate.plan["r_0"], self.right, at)

    @property
    def rho_min(self) -> float:
        """Smallest radius of curvature of the profile, m."""
        return float(self.plate.plan["ρ_min"].value)

    def _dimension_plans(self) -> tuple[Any, ...]:
        return (self.plate.plans,)

    def _dimensions(self) -> dict[str, Any]:
        names = {"r0": "r_0", "r_min": "r_min", "l1": "l_1", "l2": "l_2", "rho_min": "ρ_min"}
        return {key: self.plate.plan[name] for key, name in names.items()}


def cam(data: CamTable) -> Cam:
    """Synthesis of a disc cam.

    Raises
    ------
    CannotBuild
        when the diagram of a law allows no motion; for the axis and the roller when they are asked for.
    """
    follower, angular = FOLLOWERS[data.follower]
    key, symbol = ("swing", "ψ") if angular else ("stroke", "S")
    fall_law = None if data.fall_law is None else _law(data, data.fall_law, "fall_table")
    rise, dwell, fall, stroke = (given(data, name) or 0.0 for name in ("rise", "upper_dwell", "fall", key))
    law = PositionFunction.of(rise, dwell, fall, stroke, _law(data, data.law, "table"), fall_law, data.parts, symbol)
    return follower(data, law)


def _law(data: CamTable, name: str, table: str) -> Law:
    if name == "displacements":
        return ordinates_law(*data.ordinates(fall=table == "fall_table"))
    return table_law(*data.diagram(table), key=f"cam.{table}") if name == "table" else LAWS[name]


FOLLOWERS: dict[str, tuple[type[Cam], bool]] = {
    "translating roller": (TappetCam, False), "oscillating roller": (RockerCam, True), "flat": (FlatCam, False),
}
"""Kinds of followers by the name they have in project files, and whether their displacement is an angle."""
