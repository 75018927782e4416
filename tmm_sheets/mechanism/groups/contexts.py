"""What kinds of groups and the plans they are in hand one another.

A kind is handed the plans it constructs itself on, as far as it uses them, and force plans with their loads; it tells how the crank
angle knows its crossing, how its links look, which reactions come from outside. The plans are those of
:mod:`tmm_sheets.methods.linkage`, which fit these protocols; the kinds know nothing of that room. ``M`` is the mechanism and ``G``
a group, left open here because a group has a kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeVar

from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import against, on_link
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.words import marked

if TYPE_CHECKING:
    from tmm_sheets.mechanism.groups.three_legs import Course


@dataclass(frozen=True)
class Turning:
    """How a group with change points goes on, as steps or rows: the ``side`` on which it is; the angle that its first link turns by
    an angle of the crank, ``first``, and the derivative of that, ``second``; both None of a group that hangs on others: the plans
    of its motion find them. ``steps`` are those of them that belong to the plan of positions, arguments first.
    """

    side: Any
    first: Any
    second: Any
    steps: tuple[Step, ...]


@dataclass(frozen=True)
class Crossing:
    """What the crank angle knows of the crossing of a group, as steps: half of the chord (or the tangent's length), the distance
    of the centres (none for a line), the sine between the group's lines in the plans of velocities.

    ``turning`` of a group that has change points; ``line`` of the centres where they come to lie in one place.
    """

    half: Step
    distance: Step | None
    sine: Step
    turning: Turning | None = None
    line: Step | None = None

    @property
    def known(self) -> tuple[Step, ...]:
        """Further arguments of the rule that makes the crossing."""
        return tuple(step for step in (self.half, self.distance, self.line) if step is not None)

    @property
    def steps(self) -> tuple[Step, ...]:
        """All of them, arguments first."""
        t = self.turning
        return (*(() if t is None else t.steps), *self.known, self.sine)


@dataclass(frozen=True)
class Outline:
    """A link as a bar through points, or as a block at a point along a direction.

    ``aim`` is a further point that the bar's line passes through, ``arms`` are further lines by the names of their ends;
    ``slot`` is the direction of the slot in a ram, ``slotted`` says that a block may carry the slot of another group's block.
    """

    link: str
    bar: tuple[str, ...] = ()
    aim: str | None = None
    arms: tuple[tuple[str, str], ...] = ()
    block: str | None = None
    along: Step | None = None
    slot: Step | None = None
    slotted: bool = False


@dataclass(frozen=True)
class OuterReaction:
    """Reaction on a link from outside its group: in the hinge ``point``, or from ``guide``, balancing moments about ``point``."""

    link: str
    point: str
    guide: str | None = None


@dataclass(frozen=True)
class Leg:
    """A leg: its link and the ``corner`` of the triangle it belongs to.

    ``outer`` is its outer hinge, ``length`` m from there to the corner; or ``guide`` the outer guide it slides along; or, with
    ``outer`` and ``slot``, it is a block in a slot of the triangle through the corner, turned by ``slot``, rad, from the line of
    the first corner to the second.
    """

    link: str
    corner: str
    outer: str = ""
    guide: str = ""
    length: float = 0.0
    slot: float | None = None

    @property
    def form(self) -> str:
        """Its outer and its inner pair: R turning, P sliding."""
        return "PR" if self.guide else "RR" if self.slot is None else "RP"

    @property
    def at(self) -> str:
        """Point of the triangle where it is held: its normal passes there."""
        return self.corner if self.slot is None else self.outer

    def index(self, triangle: str, carrier: str) -> str:
        """Index of the motion that it leaves the triangle: against its outer hinge, its block, or the ``carrier`` of its guide."""
        if self.guide:
            return against(self.corner, carrier)
        return f"{self.corner if self.slot is None else on_link(self.outer, triangle)}{self.outer}"


@dataclass(frozen=True)
class SpecialPoint:
    """Where the normals of the legs of a ``pair`` meet; the ``third`` leg is the other one."""

    name: str
    step: Step
    pair: tuple[Leg, Leg]
    third: Leg


Role = Literal["weight", "inertia", "applied", "reaction"]

CLOSE = Rule("close a polygon", lambda tail, head: head - tail, ("point", "point"), "force",
             marked("Close the polygon: {name} = |{0}–{1}|·μ_F = {value}."), lambda a, v: (Helper("line", a[0], a[1]),))
OPPOSITE_COUPLE = Rule("opposite couple", lambda m: -m, ("number",), "number", marked("{name} = {value} N·m."), unit="N*m")


@dataclass(frozen=True)
class Load:
    """A force on a link: symbol in sheet markup, the link, its point, the vector (N), and a couple carried with it (N m).

    ``source`` is the link a reaction comes from.
    """

    symbol: str
    link: str
    at: Step
    vector: Step
    role: Role
    couple: Step | None = None
    source: str | None = None


@dataclass(frozen=True)
class TangentialPart:
    """Part of the reaction on ``link`` from ``source`` in the hinge ``at``, N, that the moments about ``centre`` gave."""

    link: str
    source: str
    at: str
    centre: str
    vector: Step


@dataclass
class ForcePlan:
    """Force plan of one link or of a whole group: polygon 1-2-...-1 of ``plan`` with its forces in order."""

    name: str
    links: tuple[str, ...]
    plan: Plan
    sides: list[tuple[str, Step, Step, bool]] = field(default_factory=list)

    def side(self, symbol: str, tail: Step, head: Step, unknown: bool = False) -> None:
        """Record a side of the polygon; ``unknown`` sides are found by closing it."""
        self.sides.append((symbol, tail, head, unknown))
        self.plan.vector(symbol, tail, head)

    def chain(self, start: int, tail: Step, loads: Iterable[Load]) -> Step:
        """Lay the loads off one after another; returns the end of the chain."""
        for n, load in enumerate(loads, start + 1):
            head = self.plan.add(str(n), rules.SHIFT, tail, load.vector)
            self.side(load.symbol, tail, head)
            tail = head
        return tail

    def between(self, name: str, tail: Step, head: Step) -> Step:
        """The force that closes the polygon from ``tail`` to ``head``."""
        return self.plan.add(name, CLOSE, tail, head)


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
