"""Kinematics and kinetostatics of one set of crank angles, every plan built when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step
from tmm_sheets.mechanism.groups.force_plan import Load
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.accelerations import Accelerations, acceleration_plan
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.methods.linkage.forces import GearForce, Kinetostatics, external_loads, kinetostatics
from tmm_sheets.methods.linkage.loads import Applied
from tmm_sheets.methods.linkage.positions import Positions, position_plan
from tmm_sheets.methods.linkage.velocities import Velocities, velocity_plan
from tmm_sheets.methods.linkage.zhukovsky import Lever, lever


class CrankMotion(Protocol):
    """What the forces need of a crank that does not turn evenly: the flywheel says it."""

    @property
    def J_running(self) -> float:
        """Moment of inertia of all that turns with the crank of the finished machine, kg m2."""
        ...

    def acceleration(self, phi: Any) -> Any:
        """Angular acceleration, rad/s2, positive in the sense of rotation, at angles turned from position 0."""
        ...


@dataclass(frozen=True)
class Study:
    """All linkage plans for the angles ``turned`` (rad from position 0, shape (n,)).

    ``technological`` gives the technological forces and moments; they are asked for when the first force is.
    ``running`` gives the uneven running of the crank and what it carries; None when the mechanism itself says both.
    """

    mechanism: Mechanism
    cycle: Cycle
    turned: Any
    labels: tuple[str, ...]
    gravity: float
    technological: Callable[[], tuple[Applied, ...]]
    driver: GearForce | None
    running: Callable[[], CrankMotion] | None = None

    @cached_property
    def applied(self) -> tuple[Applied, ...]:
        """Technological forces and moments."""
        return self.technological()

    @cached_property
    def positions(self) -> Positions:
        """Position plan."""
        return position_plan(self.mechanism, self.cycle.world(self.turned), self.labels)

    @cached_property
    def velocities(self) -> Velocities:
        """Velocity plans."""
        return velocity_plan(self.positions)

    @cached_property
    def accelerations(self) -> Accelerations:
        """Acceleration plans."""
        if self.running is None:
            return acceleration_plan(self.velocities)
        return acceleration_plan(self.velocities, self.mechanism.crank.sense * self.running().acceleration(self.turned))

    @cached_property
    def loads(self) -> tuple[dict[str, list[Load]], dict[str, list[Step]], Plan]:
        """External and inertia forces of every link, inertia couples, and their plan."""
        forces = [(f.name, f.link, f.point, f.vector(self.turned)) for f in self.applied if f.point is not None]
        moments = [(f.name, f.link, f.law(self.turned, 0)) for f in self.applied if f.point is None]
        carried = None if self.running is None else self.running().J_running
        return external_loads(self.positions, self.accelerations, self.gravity, forces, moments, carried)

    @cached_property
    def forces(self) -> Kinetostatics:
        """Force plans of all groups and the crank."""
        loads, couples, _ = self.loads
        return kinetostatics(self.positions, self.accelerations, loads, couples, self.driver)

    @cached_property
    def lever(self) -> Lever:
        """Zhukovsky's lever."""
        loads, couples, _ = self.loads
        every = [load for of_link in loads.values() for load in of_link]
        return lever(self.velocities, every, couples, self.driver)
