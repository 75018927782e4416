"""Kinematics and kinetostatics of one set of crank angles, every plan built when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.step import Given, Plan, Rule, SearchCount, Step
from tmm_sheets.mechanism.groups.contexts import Load
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.integration import weighted
from tmm_sheets.methods.linkage.accelerations import Accelerations, Sliding, acceleration_plan
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.methods.linkage.forces import GearForce, InputForce, Kinetostatics, external_loads, kinetostatics, limits_of_forces
from tmm_sheets.methods.linkage.loads import Applied
from tmm_sheets.methods.linkage.positions import Positions, position_plan
from tmm_sheets.methods.linkage.velocities import Velocities, velocity_plan
from tmm_sheets.methods.linkage.zhukovsky import Lever, lever
from tmm_sheets.words import marked, tr

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
        found = [made[name].plan for name in ("positions", "velocities") if name in made]
        found += made["positions"].false.values() if "positions" in made else ()
        found += [made["sliding"].plan] if "sliding" in made and made["sliding"].plan.steps else []
        found += [made["uneven"]] if "uneven" in made else []
        found += [made["accelerations"].plan] if "accelerations" in made else []
        if "loads" in made:
            found.append(made["loads"][2])
        if "forces" in made:
            friction = made["forces"].friction
            found += [friction.plan] if friction else []
            found += [made["forces"].plan, *(fp.plan for fp in made["forces"].plans.values())]
            found += [friction.power_plan] if friction and friction.power_plan else []
        if "lever" in made:
            found.append(made["lever"].plan)
        found += [made["balance"]] if "balance" in made else []
        return {plan.name: plan for plan in found}

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
        recorded = [(f.link, f.point, lambda plan, f=f: f.record(plan, self.positions, turned)) for f in self.applied]
        carried = None if self.running is None else self.running().first_plan["J_вр"]
        return external_loads(self.positions, self.accelerations, self.gravity, (), carried, recorded)

    @cached_property
    def forces(self) -> Kinetostatics:
        """Force plans of all groups and the crank."""
        loads, couples, _ = self.loads
        if isinstance(self.driver, InputForce):
            by_lever = self.lever
            assert by_lever.force is not None
            assert by_lever.balancing is not None
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
        every = [load for of_link in loads.values() for load in of_link]
        return lever(self.velocities, every, couples, self.driver)

    @cached_property
    def balance(self) -> Plan:
        """Comparison of what drives the crank: ``Δ``, per cent.

        ``along`` is the force's signed size on its line, N; a moment's are ``M`` and ``M_р`` (by the lever), N m, positive in the
        sense of rotation.
        """
        by_statics, by_lever, line = self.forces.balancing, self.lever.balancing, self.lever.line
        plan = Plan("balance", tr("Comparison of the balancing quantities"), "N", self.labels, search=self.positions.plan.search)
        if line is not None:
            # The force plan gives a vector along the line of action, the lever its signed size there.
            by_statics = plan.add("along", ALONG_LINE, by_statics, line)
        else:
            plan.add("M", IN_SENSE, by_statics, self.mechanism.crank.sense)
            plan.add("M_р", IN_SENSE, by_lever, self.mechanism.crank.sense, symbol=tr("M_l"))
        plan.add("Δ", DIFFERENCE, by_statics, by_lever)
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


ALONG_LINE = Rule("size along a line", lambda force, u: (force * np.conjugate(u)).real, ("force", "direction"), "number",
                  marked("Projection of the force {0} on the line of action: {value} N."), unit="N")
POWER_OF_DRIVE = Rule("power of the drive", lambda m, omega: m * omega, ("number", "number"), "number",
                      "", unit="W")
WITHOUT_FRICTION = Rule("power of the drive without friction", lambda power, loss: power + loss, ("number", "number"), "number",
                        "", unit="W")
MEAN = Rule("mean moment", weighted, ("number", "number"), "number",
            marked("Mean moment over the cycle {name} = {value} N·m."), unit="N*m")
IN_SENSE = Rule("in the sense of rotation", lambda moment, sense: sense * moment, ("number", "number"), "number",
                marked("In the sense of rotation of the input link {name} = {value} N·m."), unit="N*m")
DIFFERENCE = Rule("difference per cent", lambda a, b: 100 * np.abs(a - b) / np.abs(a), ("number", "number"), "number",
                  marked("Difference {name} = |{0} − {1}|/|{0}|·100 % = {value} %."), unit="%")
