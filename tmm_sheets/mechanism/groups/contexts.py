"""What a kind of group is handed: the plans it constructs itself on, as far as it uses them.

The plans are those of :mod:`tmm_sheets.methods.linkage`, which fit these protocols; the kinds know nothing of that room. ``M`` is
the mechanism and ``G`` a group, left open here because a group has a kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

if TYPE_CHECKING:
    from tmm_sheets.construction.plan import Plan
    from tmm_sheets.construction.step import Step
    from tmm_sheets.mechanism.groups.force_plan import ForcePlan, Load, Role
    from tmm_sheets.mechanism.groups.hints import SpecialPoint
    from tmm_sheets.mechanism.groups.three_legs import Course

M = TypeVar("M", covariant=True)
G = TypeVar("G", contravariant=True)


class PositionPlan(Protocol[M, G]):
    """Points, m, unit directions of links and guides, by their names."""

    plan: Plan
    points: dict[str, Step]
    directions: dict[str, Step]
    guide_points: dict[str, Step]
    guide_directions: dict[str, Step]
    rays: dict[tuple[str, str], Step]
    feet: dict[str, str]
    special: dict[str, SpecialPoint]
    false: dict[str, Plan]
    angle: Any
    where: str

    @property
    def value(self) -> Callable[[Step], Any]:
        """Value of a step at the crank's angles."""

    @property
    def mechanism(self) -> M:
        """The mechanism that is drawn."""

    def direction(self, p: str, q: str) -> Step:
        """Direction from one point to another, drawn once."""

    def crossing(self, group: G) -> tuple[Step, ...]:
        """Further arguments of the rule that makes a group's crossing, where the crank angle knows better than the points."""

    def side(self, group: G) -> Any:
        """On which side a group is put together, +1 or -1: a step where it changes in change points."""

    def place(self, name: str) -> Step:
        """A point of the mechanism or a special point by its name."""

    def course(self, group: G) -> Course:
        """Way of assembly of a group of class III round the turn, followed once."""

    def known_sine(self, group: G) -> tuple[Step, ...]:
        """The sine between a group's lines, where it is known better than they tell."""


class MotionPlan(Protocol[M, G]):
    """What plans of velocities and of accelerations have alike: vectors from the pole, by the points' names."""

    plan: Plan
    points: dict[str, Step]
    coincident: dict[str, Step]
    special: dict[str, Step]

    @property
    def positions(self) -> PositionPlan[M, G]:
        """The positions they belong to."""

    @property
    def pole(self) -> Step:
        """The pole of the plan."""

    def name(self, point: str) -> str:
        """Free name on the plan for a point of the mechanism."""

    def on(self, link: str, through: str, at: str) -> Step:
        """Motion of the point of a link that coincides with ``at``, from the link's point ``through``; drawn once."""

    def rotated(self, point: str, start: Step, link: str, q: str, b: str) -> Step:
        """Motion of a point of a turning link at ``b``, from that at ``q``; named after ``point``."""

    def similar(self, point: str, q: Step, b: Step, big_q: str, big_b: str, name: str = "") -> Step:
        """Motion of a point of a link by similarity, from the motions of two of its points; named after it, or otherwise."""

    def perpendicular(self, p: str, q: str) -> Step:
        """Direction across the line of two points, drawn once."""

    def known(self, group: G) -> tuple[Step, ...]:
        """What is known of the crossing of a group's lines better than they tell: their sine, the way along the first."""

    def turning(self, link: str, big_q: str, big_b: str, q: Step, b: Step) -> None:
        """How a link turns, from the motions ``q`` and ``b`` of two of its points."""

    def turns_with(self, link: str, other: str) -> None:
        """A link does not turn against another."""


class VelocityPlan(MotionPlan[M, G], Protocol[M, G]):
    """Velocities, m/s."""

    def guide(self, guide: str, at: str) -> tuple[Step, str]:
        """Velocity of the guide's point that coincides with ``at``, and the guide's link; the pole for a fixed guide."""


class AccelerationPlan(MotionPlan[M, G], Protocol[M, G]):
    """Accelerations, m/s2."""

    @property
    def velocities(self) -> VelocityPlan[M, G]:
        """The velocities they belong to."""

    def guide(self, guide: str, at: str) -> tuple[Step, Step, str]:
        """Acceleration and velocity of the guide's point coinciding with ``at``, and the guide's link."""

    def coriolis(self, a: Step, link: str, v_from: Step, v_to: Step, symbol: str) -> Step:
        """End of the Coriolis segment; the point itself where the carrier does not turn."""

    def normal(self, a: Step, link: str, big_q: str, big_b: str, letters: str = "") -> Step:
        """End of the normal acceleration of ``big_b`` round ``big_q``, laid off from ``a``."""


class ForcePlans(Protocol[M, G]):
    """Loads of the links, N and N m, and the force plans made of them; ``F_jk`` acts on link j from link k."""

    loads: dict[str, list[Load]]
    plan: Plan
    reactions: dict[str, Step]
    parts: dict[str, Step]

    @property
    def positions(self) -> PositionPlan[M, G]:
        """Where the forces act."""

    def plan_of(self, name: str, links: tuple[str, ...]) -> ForcePlan:
        """New force plan of a link or of a whole group."""

    def order(self, loads: list[Load], first: Role) -> list[Load]:
        """Loads in the order they are laid off, of one role first."""

    def moment_sum(self, name: str, about: Step, links: Iterable[str], more: Iterable[tuple[Step, Any, Any]] = ()) -> Step:
        """Sum of moments of all that acts on some links so far about a point, N m; ``more`` are further points, forces, couples."""

    def tangential(self, j: str, k: str, total: Step, centre: str, at: str) -> Step:
        """Part of F_jk at a point across its line to the centre of the moments, from their sum."""

    def normal(self, j: str, other: str, name: str, u: Step, symbol: str = "") -> Step:
        """Direction of a sliding pair's reaction on link ``j``: across the guide, with friction deviated from there."""

    def deviates(self, j: str, other: str) -> bool:
        """True where friction deviates the reaction of a sliding pair from the normal."""

    def close(self, fp: ForcePlan, j: str, other: str, tail: Step, head: Step) -> Step:
        """Close a polygon by the reaction on link ``j`` from link ``other``."""

    def reaction(self, j: str, k: str, vector: Step) -> Step:
        """Record F_jk under its name."""

    def opposite(self, j: str, k: str, vector: Step) -> Step:
        """Record F_jk, the opposite of F_kj."""

    def opposite_couple(self, j: str, k: str, couple: Step) -> Step:
        """The couple on link ``j`` opposite to that on link ``k``."""

    def negative(self, step: Step) -> Step:
        """A number with the other sign, no step of any plan."""

    def contact(self, j: str, k: str, at: Step, vector: Step, couple: Step | None = None) -> Load:
        """Reaction on link ``j`` from link ``k`` as a load."""

    def react(self, link: str, on: str, at: Step, vector: Step, couple: Step | None = None) -> Step:
        """The equal and opposite force on the neighbouring link ``on`` from ``link``."""

    def sliding(self, j: str, other: str, force: Step, about: Step) -> Step:
        """Couple of a sliding pair's reaction on link ``j``, its force taken at ``about``, and its arm."""

    def guide_couple(self, j: str, other: str, about: Step) -> Step:
        """Couple of a sliding pair's reaction on link ``j``, its force taken at ``about``."""

    def arm(self, j: str, other: str, couple: Step, force: Step) -> None:
        """Arm of that reaction."""

    def group_polygon(self, g: G, first: Step | None, last: Step | None, u: Step, v: Step, carriers: tuple[str, str],
                      sine: tuple[Step, ...] = ()) -> tuple[Step, Step, ForcePlan]:
        """Plan of a whole group closed by two unknown forces along ``u`` and ``v``, and these forces."""
