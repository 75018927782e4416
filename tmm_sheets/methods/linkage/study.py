"""Kinematics and kinetostatics of one set of crank angles, every plan built when it is first asked for.

And the motion of the outputs over the cycle: way, velocity and acceleration along a straight path; angle of a link and its rates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import tau
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.expression import Reals
from tmm_sheets.construction.rules import take
from tmm_sheets.construction.step import Given, Plan, Rule, SearchCount, Step, StepTable, asked_for, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups.contexts import Load
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.integration import weighted
from tmm_sheets.methods.linkage.cycle import Cycle, named_angles
from tmm_sheets.methods.linkage.forces import GearForce, InputForce, Kinetostatics, external_loads, kinetostatics, limits_of_forces
from tmm_sheets.methods.linkage.loads import Applied
from tmm_sheets.methods.linkage.motion import Accelerations, Sliding, Velocities, acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.positions import Positions, position_plan
from tmm_sheets.methods.linkage.zhukovsky import Lever, lever
from tmm_sheets.numbers import NOISE
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.methods.linkage.friction import Coefficients, Friction


@dataclass(frozen=True)
class Study:
    """All linkage plans for the angles ``turned`` (rad from position 0, shape (n,)).

    ``technological`` gives the technological forces and moments; they are asked for when the first force is.
    ``running`` gives the uneven running of the crank and what it carries; None when the mechanism itself says both. ``purpose`` is
    what the plans search for; empty when they are drawn or told. ``friction`` in the pairs; None without.
    """

    mechanism: Mechanism
    cycle: Cycle
    turned: Any
    labels: tuple[str, ...]
    gravity: float
    technological: Callable[[], tuple[Applied, ...]]
    driver: GearForce | InputForce | None
    running: Callable[[], Flywheel] | None = None
    purpose: str = ""
    friction: Coefficients | None = None

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans that were asked for, in the order of construction."""
        made = vars(self)
        positions, forces, sliding = (made.get(name) for name in ("positions", "forces", "sliding"))
        friction = forces and forces.friction
        return asked_for((
            positions, made.get("velocities"), positions and positions.false, sliding if sliding and sliding.plan.steps else None,
            made.get("uneven"), made.get("accelerations"), made.get("loads", ())[2:], friction, forces, forces and forces.plans,
            friction and friction.power_plan, made.get("lever"), made.get("balance")))

    @cached_property
    def applied(self) -> tuple[Applied, ...]:
        """Technological forces and moments."""
        return self.technological()

    @cached_property
    def positions(self) -> Positions:
        """Position plan."""
        return position_plan(self.mechanism, self.cycle.angles(self.turned), self.labels, purpose=self.purpose)

    @property
    def place_of_input(self) -> Step:
        """Place of the slider or cylinder that drives the mechanism, m."""
        from tmm_sheets.methods.linkage.drive import place_of_input

        return place_of_input(self.positions)

    @cached_property
    def velocities(self) -> Velocities:
        """Velocity plans."""
        return velocity_plan(self.positions)

    @cached_property
    def sliding(self) -> Sliding:
        """Velocities of sliding and the Coriolis accelerations they bring."""
        return Sliding(self.velocities)

    @cached_property
    def accelerations(self) -> Accelerations:
        """Acceleration plans."""
        if self.running is None:
            return acceleration_plan(self.velocities)
        return acceleration_plan(self.velocities, self.uneven["ε1"])

    @cached_property
    def uneven(self) -> Plan:
        """Angular acceleration of a crank that does not turn evenly."""
        assert self.running is not None
        return self.running().acceleration_plan(self.turned, self.labels)

    @cached_property
    def loads(self) -> tuple[dict[str, list[Load]], dict[str, list[Step]], Plan]:
        """External and inertia forces of every link, inertia couples, and their plan."""
        turned = self.cycle.turned_row(self.turned)
        applied = [(f.link, f.point, lambda plan, f=f: f.record(plan, self.positions, turned)) for f in self.applied]
        carried = None if self.running is None else self.running().first_plan["J_вр"]
        return external_loads(self.positions, self.accelerations, self.gravity, applied, carried)

    @cached_property
    def forces(self) -> Kinetostatics:
        """Force plans of all groups and the crank."""
        loads, couples, _ = self.loads
        if isinstance(self.driver, InputForce):
            by_lever = self.lever
            assert by_lever.force is not None
            assert by_lever.line is not None
            loads = self.driver.loaded(self.positions, loads, by_lever.plan, by_lever.force)
            found = kinetostatics(self.positions, self.accelerations, loads, couples, self.driver)
            found.balancing = self.driver.by_statics(found, by_lever.balancing, by_lever.line)
            return found

        def statics(friction: Friction | None = None, search: SearchCount | None = None) -> Kinetostatics:
            return kinetostatics(self.positions, self.accelerations, loads, couples, self.driver, friction=friction, search=search)

        if self.friction is None:
            limits = limits_of_forces(self.positions, self.accelerations, loads, couples, self.driver)
            return kinetostatics(self.positions, self.accelerations, loads, couples, self.driver, limits=limits)
        from tmm_sheets.methods.linkage.friction import with_friction

        return with_friction(self.friction, self.velocities, self.sliding, statics)

    @cached_property
    def lever(self) -> Lever:
        """Zhukovsky's lever; friction in the pairs hangs on it as a moment on the crank."""
        loads, couples, _ = self.loads
        friction, crank = self.forces.friction if self.friction is not None else None, self.mechanism.crank.link
        if friction is not None and friction.powers:
            couples = {**couples, crank: [*couples.get(crank, ()), friction.on_crank]}
        return lever(self.velocities, [load for of_link in loads.values() for load in of_link], couples, self.driver)

    @cached_property
    def balance(self) -> Plan:
        """Comparison of what drives the crank: ``Δ``, per cent.

        ``along`` is the force's signed size on its line, N; a moment's are ``M`` and ``M_р`` (by the lever), N m, positive in the
        sense of rotation.
        """
        line, by_statics = self.lever.line, self.forces.balancing
        given = {"by_statics": by_statics, "by_lever": self.lever.balancing, "line": line, "sense": self.mechanism.crank.sense}
        plan = Plan("balance", tr("Comparison of the balancing quantities"), "N", self.labels, search=self.positions.plan.search)
        # The force plan gives a vector along the line of action, the lever its signed size there.
        found = record(plan, "M M_р" if line is None else "along", BALANCE, given=given)
        record(plan, "Δ", BALANCE, given=given | {"size": by_statics if line is None else found})
        return plan

    def drive(self, loss: Step) -> tuple[Step, Step]:
        """Power of the drive over the positions, W: ``N``, and ``N_0`` without the power ``loss`` of friction, not above zero."""
        power = self.balance.auxiliary("N", POWER_OF_DRIVE, self.balance["M"], self.mechanism.crank.speed)
        return power, self.balance.auxiliary("N_0", WITHOUT_FRICTION, power, loss)

    def mean_driving(self, course: Step, turned: Any) -> Step:
        """Mean moment of the crank over the cycle, N m: step ``M_д``, by trapezia from its values at angles ``turned``, rad."""
        width = np.diff(turned, prepend=turned[0], append=turned[-1])
        weights = Given((width[1:] + width[:-1]) / 2 / self.cycle.period, "weights of the trapezia", over="curve")
        return self.balance.auxiliary("M_д", MEAN, course, weights)


POWER_OF_DRIVE = Rule("power of the drive", lambda m, omega: m * omega, ("number", "number"), "number",
                      "", unit="W")
WITHOUT_FRICTION = Rule("power of the drive without friction", lambda power, loss: power + loss, ("number", "number"), "number",
                        "", unit="W")
MEAN = Rule("mean moment", weighted, ("number", "number"), "number",
            marked("Mean moment over the cycle {name} = {value} N·m."), unit="N*m")
IN_SENSE = Rule("in the sense of rotation", lambda moment, sense: sense * moment, ("number", "number"), "number",
                marked("In the sense of rotation of the input link {name} = {value} N·m."), unit="N*m")
BALANCE: StepTable = {
    "along": ("by_statics line", "", Rule(
        "size along a line", lambda force, u: (force * np.conjugate(u)).real, ("force", "direction"), "number",
        marked("Projection of the force {0} on the line of action: {value} N."), unit="N")),
    "M": ("by_statics sense", "", IN_SENSE),
    "M_р": ("by_lever sense", lambda: tr("M_l"), IN_SENSE),
    "Δ": ("size by_lever", "", Rule(
        "difference per cent", lambda a, b: 100 * np.abs(a - b) / np.abs(a), ("number", "number"), "number",
        marked("Difference {name} = |{0} − {1}|/|{0}|·100 % = {value} %."), unit="%")),
}


# --- motion of the outputs over the cycle ------------------------------------------------------------------------------

SAMPLES = 15
"""Points of a curve between two positions."""

INCLINATION = Rule("inclination of a rod", lambda u, along: np.arctan((u * np.conj(along)).imag / (u * np.conj(along)).real),
                   ("direction", "direction"), "angle",
                   marked("Inclination of the rod {0} to the guide {1}: {name} = {value}."), unit="rad", source="001, (10)")
BEGINNING = Rule("beginning of the way", take, ("point", "number"), "point", marked("Measure the way from point {name}."), unit="m")
FIRST = Rule("first direction of a link", take, ("direction", "number"), "direction",
             marked("Measure the angle from the direction {name}."))
OF_POINT: StepTable = {
    "S_#": ("moved start path", "S_{#}", Rule(
        "way along a path", lambda p, start, u: ((p - start) * np.conj(u)).real, ("point", "point", "direction"), "number",
        marked("Way from {1}: {name} = {value} m."), unit="m")),
    "V_#": ("velocity path", "V_{#}", Rule(
        "velocity along a path", lambda v, u: (v * np.conj(u)).real, ("point", "direction"), "number",
        marked("Projection of {0} on the direction of the way: {name} = {value} m/s."), unit="m/s")),
    "a_#": ("acceleration path", "a_{#}", Rule(
        "acceleration along a path", lambda a, u: (a * np.conj(u)).real, ("point", "direction"), "number",
        marked("Projection of {0} on the direction of the way: {name} = {value} m/s²."), unit="m/s2")),
}
OF_LINK: StepTable = {
    "ψ_#": ("moved start turns", "ψ_{#}", Rule(
        "angle turned from the beginning",
        lambda u, start, turns: np.arctan2(u.imag, u.real) + tau * turns - np.arctan2(start.imag, start.real),
        ("direction", "direction", "number"), "angle", marked("Angle turned by the link {name} = {value}."))),
    "ω_#": ("omega", "ω_{#}", Rule("angular velocity of a link", lambda w: w, ("number",), "number",
        marked("{name} = {value} s⁻¹."), unit="rad/s")),
    "ε_#": ("epsilon", "ε_{#}", Rule("angular acceleration of a link", lambda e: e, ("number",), "number",
        marked("{name} = {value} s⁻²."), unit="rad/s2")),
}

Three = tuple[Step, Step, Step]


@dataclass(frozen=True)
class Output:
    """Motion of one output: its three quantities at the positions, and between them for their curves."""

    at_positions: Three
    between: Three


class Motion:
    """Motion of points and links over the cycle; each is recorded when it is asked for.

    Parameters
    ----------
    study
        at the numbered positions.
    study_at
        the same at any angles turned from position 0, rad.
    """

    def __init__(self, study: Study, study_at: Callable[[Any, tuple[str, ...]], Study]) -> None:
        self.study = study
        self._study_at = study_at
        self._points: dict[str, Output] = {}
        self._links: dict[str, Output] = {}
        self.plan = Plan("motion", tr("Kinematic diagrams"), "m", study.labels)

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans of what was asked for."""
        named = vars(self).get("named_angles")
        return {plan.name: plan for plan in (self.plan, named) if plan is not None and plan.steps}

    @cached_property
    def named_angles(self) -> Plan | None:
        """Crank angles φ_1k and φ_2k of the rocker on the crank pin; None without one."""
        return named_angles(self.study.mechanism, self.study.cycle.start, self.study.cycle.sense)

    def inclination(self, link: str, guide: str) -> Step:
        """Inclination of a rod to the guide of its other end, rad, positive counter-clockwise, at the positions."""
        u, along = self.study.positions.directions[link], self.study.positions.guide_directions[guide]
        return self.plan.add_once(f"θ_{link}", INCLINATION, u, along, symbol=f"θ_{{{link}}}")

    @cached_property
    def turned(self) -> Reals:
        """Angles of the curves' points, rad: position 0 and its return are the ends."""
        return np.linspace(0.0, self.study.cycle.period, SAMPLES * len(self.study.labels) + 1)

    @cached_property
    def between(self) -> Study:
        """The linkage at these angles."""
        return self._study_at(self.turned, tuple(["" for _ in self.turned]))

    @cached_property
    def _tried(self) -> Plan:
        return Plan("motion", self.plan.title, self.plan.unit, self.between.labels, search=self.between.positions.plan.search)

    def point(self, name: str) -> Output:
        """S, V and a of a point that moves along a straight line, positive in the sense in which the motion begins.

        Raises
        ------
        CannotBuild
            when the path is not straight.
        """
        if name not in self._points:
            p = np.asarray(self.between.positions.points[name].value)
            u = Given(_path(name, p - p[0]), f"path of {name}", "u", over="none",
                      choice="from position 0 to the farthest point, in the sense in which the motion begins")
            self._points[name] = Output(*(_motion_along(plan, study, name, u) for plan, study in self._both()))
        return self._points[name]

    def link(self, name: str) -> Output:
        """Angle of a link from position 0 on, its angular velocity and acceleration, positive counter-clockwise."""
        if name not in self._links:
            angle = np.angle(np.broadcast_to(self.between.positions.directions[name].value, self.turned.shape))
            swept = np.unwrap(angle)
            at = self.study.turned
            here = np.angle(np.broadcast_to(self.study.positions.directions[name].value, at.shape))
            turns = (np.interp(at, self.turned, swept) - here, swept - angle)
            self._links[name] = Output(*(_turning(plan, study, name, np.round(k / tau))
                                         for (plan, study), k in zip(self._both(), turns, strict=True)))
        return self._links[name]

    def _both(self) -> tuple[tuple[Plan, Study], tuple[Plan, Study]]:
        return (self.plan, self.study), (self._tried, self.between)


def _motion_along(plan: Plan, study: Study, name: str, u: Given) -> Three:
    p, v, a = (of.points[name] for of in (study.positions, study.velocities, study.accelerations))
    return _three(plan, BEGINNING, p, OF_POINT, name, {"velocity": v, "acceleration": a, "path": u})


def _turning(plan: Plan, study: Study, name: str, turns: Reals) -> Three:
    return _three(plan, FIRST, study.positions.directions[name], OF_LINK, name, {
        "omega": study.velocities.omega[name],
        "epsilon": study.accelerations.epsilon[name],
        "turns": Given(turns, f"turns of link {name}", choice="whole turns, counted on from position 0")})


def _three(plan: Plan, beginning: Rule, moved: Step, table: StepTable, name: str, given: dict[str, Any]) -> Three:
    """The three quantities of an output, from where its motion begins."""
    start = plan.add(plan.named(f"{name}₀"), beginning, moved, 0)
    record(plan, " ".join(table), table, wheel=name, given=given | {"moved": moved, "start": start})
    way, rate, second = (plan[key.replace("#", name)] for key in table)
    return way, rate, second


def _path(name: str, way: Reals) -> complex:
    """Unit vector of a straight path, in the sense in which the motion begins."""
    far = complex(way[np.argmax(np.abs(way))])
    size = abs(far)
    u = far / size if size else 1 + 0j
    if np.max(np.abs((way * np.conj(u)).imag)) > NOISE * size:
        raise CannotBuild(tell("point {name} does not move along a straight line: it has no diagram S(φ)").format(name=name),
                          tell("name a point of a slider on a fixed guide in cycle.diagrams, or the number of a link for its "
                               "angle"))
    return u * _begins((way * np.conj(u)).real)


def _begins(way: Reals) -> float:
    """Sign of the first movement away from position 0."""
    moved = way[np.abs(way) > 1e-6 * np.max(np.abs(way))]
    return float(np.sign(moved[0])) if len(moved) else 1.0
