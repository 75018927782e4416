"""Structure of a mechanism: links, kinematic pairs, Assur groups and what a kind of them has to know; no coordinates."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import takewhile
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from tmm_sheets.construction.step import Plan, SearchCount, Step
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.construction.limit_angles import Gaps
    from tmm_sheets.mechanism.groups.contexts import AssemblyLimit, Crossing, Outline

    # The plans that a kind constructs itself on; at run time it knows nothing of their room.
    from tmm_sheets.methods.linkage.forces import Kinetostatics as Kinetostatics
    from tmm_sheets.methods.linkage.motion import MotionPolygon as MotionPolygon
    from tmm_sheets.methods.linkage.positions import Positions as Positions

Motion = Literal["rotation", "translation"]


@dataclass(frozen=True)
class Link:
    """A link; ``mass`` kg at point ``centre``, ``inertia`` kg m2 about it; None where the task gives none.

    ``pivot_inertia`` kg m2 about the link's fixed pivot, where the task gives it for the energy beside ``inertia``.
    """

    name: str
    title: str = ""
    mass: float = 0.0
    centre: str | None = None
    inertia: float = 0.0
    pivot_inertia: float | None = None


@dataclass(frozen=True)
class Pair:
    """A kinematic pair of class 5 between two links, named after its point; translations carry a prime."""

    name: str
    links: tuple[str, str]
    motion: Motion


def turning(name: str, a: str, b: str) -> Pair:
    """A turning pair of two links."""
    return Pair(name, (a, b), "rotation")


def sliding(name: str, a: str, b: str) -> Pair:
    """A sliding pair of two links."""
    return Pair(name, (a, b), "translation")


@dataclass(frozen=True)
class Guide:
    """A straight guide: on the frame through a fixed point, or on a moving link through one of its points.

    ``direction`` (rad) is a world angle for a fixed guide, the angle from ``from_point`` .. ``towards`` else.
    """

    name: str
    link: str
    through: complex | str
    direction: float
    towards: str | None = None

    @property
    def at(self) -> complex:
        """The point of a fixed guide that is given, m."""
        assert not isinstance(self.through, str)
        return self.through


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


class GroupKind(ABC):
    """A kind of group (вид группы Ассура; manual 000, table 3.1); a kind has no state of its own.

    ``number`` is the manual's, ``grade`` and ``order`` are its class and order; ``form`` is its pairs, outer, inner,
    outer, R turning, P sliding, looked up when it is said. ``orders`` are the same pairs as R and P, in every order the links can
    be met in. Those of ``two_ways`` of assembly may come to change points, where one passes into the other. ``slotted``
    tells what the second link is to the block of the first.
    """

    number: ClassVar[int]
    form: ClassVar[str]
    orders: ClassVar[tuple[str, ...]]
    grade: ClassVar[int] = 2
    order: ClassVar[int] = 2
    two_ways: ClassVar[bool] = False
    slotted: ClassVar[Literal["", "ram", "rocker"]] = ""

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other)

    def __hash__(self) -> int:
        return hash(type(self))

    def __repr__(self) -> str:
        return type(self).__name__

    def legs(self, g: StructuralGroup) -> tuple[Leg, ...]:
        """Each link of the group with its outer pair; a guide holds the middle hinge, or the pin in a slot."""
        (first, middle, last), hinges, guides = tuple(self.orders[0]), iter(g.outer), iter(g.guides)
        corner, lengths = str(g.inner) if middle == "R" else g.outer[0], (*g.lengths, 0.0, 0.0)
        return tuple([Leg(link, corner, next(hinges), length=length) if pair == "R" else Leg(link, corner, guide=next(guides))
                     for link, pair, length in zip(g.links, (first, last), lengths, strict=False)])

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        """Outer, inner and outer kinematic pair of a group in a mechanism."""
        (i, j), (one, two), primes = g.links, self.legs(g), iter("′″")
        return [turning(hinge, a, b) if form == "R" else sliding(one.corner + next(primes), a, b)
                for form, hinge, a, b in zip(self.orders[0], (one.outer, str(g.inner), two.outer), (m.carrier(one), i, j),
                                             (i, j, m.carrier(two)), strict=True)]

    def carried(self, g: StructuralGroup) -> dict[str, str]:
        """Points the group brings along, each with the link it is fixed on: of a single slider the point on its guide."""
        return {g.inner: g.links[len(g.guides) == 1]} if g.inner else {}

    def guided(self, g: StructuralGroup) -> tuple[tuple[str, str], ...]:
        """Points the group brings along a guide, each with the guide."""
        return tuple((g.inner, guide) for guide in g.guides) if g.inner else ()

    @abstractmethod
    def position(self, pos: Positions, g: StructuralGroup) -> None:
        """Construct the inner point and the directions of both links in the position plan."""

    @abstractmethod
    def motion(self, plan: MotionPolygon, g: StructuralGroup) -> None:
        """Solve the vector equations of velocities or of accelerations by two lines (manual 000, tables 3.1 and 3.6)."""

    @abstractmethod
    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Reactions in the group's pairs from force plans and moment equations (manual 000, table 4.1)."""

    @abstractmethod
    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        """Conditions of assembly."""

    @abstractmethod
    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        """By how much errors of what comes before the group may grow in it, shape (n,), one number a position.

        It is 1 over the sine of the angle under which the group's lines cross, times ``size`` of the mechanism, m, over the
        shortest length that they are measured on.
        """

    def crossing(self, m: Mechanism, g: StructuralGroup, phi: Any) -> Crossing | None:
        """Crossing of a group between crank and frame from the crank angles ``phi``, rad, shape (n,); None without such a form."""
        return None

    def gaps(self, m: Mechanism, g: StructuralGroup) -> Gaps | None:
        """Both gaps of a group between crank and frame over the crank angle; None elsewhere, and of a kind that has but one way."""
        return None

    def gaps_at(self, pos: Positions, g: StructuralGroup) -> tuple[Any, Any, Any]:
        """Both gaps of a group from the points of a plan, shape (n,), and what is rounding beside them.

        Raises
        ------
        NotImplementedError
            of a kind that has but one way.
        """
        raise NotImplementedError

    def passage(self, pos: Positions, g: StructuralGroup, side: Any, root: Any) -> Crossing:
        """Crossing of a group that hangs on others and has change points, by its ``side`` and a row that is known next to them.

        It is the ``root`` of the product of the gaps, with a sign; NaN where it is not known, minus infinity where nothing is.

        Raises
        ------
        NotImplementedError
            of a kind that has but one way.
        """
        raise NotImplementedError

    def dead_positions(self, m: Mechanism, g: StructuralGroup, plan: Plan, centre: Step) -> tuple[Step, Step] | None:
        """Crank vectors (m, from the crank pivot ``centre``) of the dead positions of a group on the crank pin, on ``plan``.

        None where this kind knows no construction of them, or none for this mechanism.
        """
        return None

    @abstractmethod
    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        """How both links look."""

    def outer_reactions(self, g: StructuralGroup) -> list[OuterReaction]:
        """Reactions from outside, in order of the links."""
        return [OuterReaction(leg.link, leg.corner, leg.guide) if leg.guide else OuterReaction(leg.link, leg.outer)
                for leg in self.legs(g)]

    def force_plans(self, g: StructuralGroup) -> tuple[str, ...]:
        """Names of the force plans, in the order they are drawn: that of the whole group, or one of each link."""
        return (g.name,)

    def about(self, g: StructuralGroup) -> str:
        """Point of the moment equations: the middle hinge, unless a kind says otherwise."""
        return str(g.inner)

    def sliders(self, g: StructuralGroup) -> tuple[tuple[str, str], ...]:
        """Links that are blocks on guides, each with its guide."""
        return ()

    @property
    def roman(self) -> str:
        """Its class as it is written."""
        return {2: "II", 3: "III"}[self.grade]

    def told(self, g: StructuralGroup) -> str:
        """Number and pairs as they stand on a sheet."""
        return f"{self.number} ({tr(g.form)})"

    def joints(self, g: StructuralGroup) -> tuple[str, ...]:
        """Names of the pairs of a group that was found by its structure: outer, inner, outer."""
        first, last = g.outer
        return first, str(g.inner), last

    def block(self, g: StructuralGroup, link: str) -> str:
        """The point of a link that is a block: the inner one, unless a kind says otherwise."""
        return str(g.inner)

    def ram(self, g: StructuralGroup) -> str | None:
        """The guided link with a slot for the other's slider block."""
        return g.links[1] if self.slotted == "ram" else None

    def rocker(self, g: StructuralGroup) -> str | None:
        """The link that turns about the second outer hinge and guides the other's slider block."""
        return g.links[1] if self.slotted == "rocker" else None


def lettered(links: Iterable[str]) -> str:
    """Links of a group as the manuals write them, by their numbers: 4–5.

    >>> lettered(["11", "5a", "10"])
    '5a–10–11'
    """
    return "–".join(sorted(links, key=lambda link: (int("0" + "".join(takewhile(str.isdecimal, link))), link)))


@dataclass(frozen=True)
class StructuralGroup:
    """An Assur group (группа Ассура): of class II, order 2, unless it is a kind of its own.

    ``outer`` are the points of its outer turning pairs, ``inner`` the point of its inner turning pair (or, for RPP,
    of the guided link on the guide), ``side`` the assembly side, ``guides`` the guides of its outer sliding pairs.
    A group that comes to change points keeps its side all round, or, where it is to ``follow``, goes on smoothly through them:
    it is on its side at the crank angle ``at``, rad, and from there both ways as far as the angle ``cut``, where a turn begins
    (``at`` unless told).
    """

    kind: GroupKind
    links: tuple[str, ...]
    outer: tuple[str, ...]
    inner: str | None = None
    lengths: tuple[float, ...] = ()
    guides: tuple[str, ...] = ()
    side: float = 1
    offset: float = 0.0
    slot: float = 0.0
    follow: bool = False
    at: float = 0.0
    cut: float | None = None

    @property
    def name(self) -> str:
        """Link names joined in the order of the scheme, in which the record has them: 5–4."""
        return "–".join(self.links)

    @property
    def lettered(self) -> str:
        """Link names as the pair is lettered, the lower number first: 4–5."""
        return lettered(self.links)

    @property
    def form(self) -> str:
        """Its pairs, outer, inner, outer: R turning, P sliding; looked up when it is said."""
        return self.kind.form


@dataclass(frozen=True)
class LinkPoint:
    """A further point fixed on a link: at ``distance`` (m) from ``start`` under ``angle`` (rad) to ``start`` .. ``towards``."""

    name: str
    link: str
    start: str
    towards: str
    distance: float
    angle: float = 0.0


@dataclass(frozen=True)
class Crank:
    """The initial link; ``sense`` is +1 counter-clockwise, ``speed`` (rad/s) and ``acceleration`` (rad/s2) count that way."""

    link: str
    pivot: str
    pin: str
    length: float
    speed: float
    sense: float
    acceleration: float = 0.0

    @property
    def omega(self) -> float:
        """Angular velocity with its sign, rad/s."""
        return self.sense * self.speed


@dataclass(frozen=True)
class Drive:
    """What moves the crank where its turning is not given: a slider or a cylinder of the group on its pin.

    ``place`` of it at the beginning and at the end of the stroke, m: of a slider along its guide from the point that is given of
    it, of a cylinder the length between its hinges. ``sense`` is +1 where that grows; ``speed``, m/s, and ``acceleration``, m/s2,
    count that way. ``side`` +1: the crank pin is left of the line from the far hinge, of slider or cylinder, to the pivot.
    """

    link: str
    group: StructuralGroup
    place: tuple[float, float]
    speed: float
    acceleration: float = 0.0
    side: float = 1

    @property
    def sense(self) -> float:
        """+1 where the place grows, -1 where it becomes less."""
        return 1.0 if self.place[1] > self.place[0] else -1.0

    @property
    def slides(self) -> bool:
        """True for a slider on a fixed guide, False for a cylinder."""
        return bool(self.group.guides)

    @property
    def far(self) -> str:
        """Hinge at the other end of the rod, or of the cylinder, whose one end is the crank pin."""
        return str(self.group.inner) if self.slides else self.group.outer[1]


@dataclass(frozen=True)
class Mechanism:
    """A mechanism of class II or III: crank and groups in order of attachment, with the points and links they carry.

    Lengths in m, angles in rad, speeds in rad/s; the axes x right and y up.

    Examples
    --------
    A slider-crank: crank 1 about A, rod 2 from its pin B to C, which slider 3 carries along a horizontal guide.

    >>> from tmm_sheets.mechanism.groups import RRP
    >>> rod = StructuralGroup(RRP, ("2", "3"), ("B",), "C", lengths=(0.3,), guides=("rail",))
    >>> guide = Guide("rail", "0", 0j, 0.0)
    >>> m = Mechanism(Crank("1", "A", "B", 0.1, 10.0, sense=1), {"A": 0j}, {"rail": guide}, (rod,), (), {n: Link(n) for n in "123"})
    >>> m.mobility, m.structure, m.grade
    (1, 'I(0,1) → II(2,3)', 2)
    >>> [(pair.name, pair.links, pair.motion) for pair in m.pairs]  # doctest: +NORMALIZE_WHITESPACE
    [('A', ('0', '1'), 'rotation'), ('B', ('1', '2'), 'rotation'), ('C', ('2', '3'), 'rotation'),
     ('C′', ('3', '0'), 'translation')]

    Its positions, and the velocities of the slider's pin, at as many crank angles as are asked for:

    >>> import numpy as np
    >>> from tmm_sheets.methods.linkage.positions import position_plan
    >>> from tmm_sheets.methods.linkage.motion import velocity_plan
    >>> positions = position_plan(m, np.array([0.0, np.pi / 2, np.pi]))
    >>> positions.points["C"].value.real.round(6).tolist()
    [0.4, 0.282843, 0.2]
    >>> velocity_plan(positions).points["C"].value[1].real.round(6).item()
    -1.0
    """

    crank: Crank
    fixed: dict[str, complex]
    guides: dict[str, Guide]
    groups: tuple[StructuralGroup, ...]
    points: tuple[LinkPoint, ...]
    links: dict[str, Link]
    frame: str = "0"
    drive: Drive | None = None
    """what moves the crank where its turning is not given: its speed is then the mean one"""
    searches: dict[str, SearchCount] = field(default_factory=dict, compare=False, repr=False)
    """what has been looked for with plans of this mechanism, by purpose"""
    courses: dict[str, Any] = field(default_factory=dict, init=False, compare=False, repr=False)
    """ways of assembly of its groups of class III round the turn, by the groups' names"""
    recorded: dict[str, Any] = field(default_factory=dict, init=False, compare=False, repr=False)
    """plans that all searches share, which do them again at other crank angles"""

    def shown_sense(self, link: str) -> float:
        """Sign that the turning of a link has on sheets and in notes beside its own, which is counter-clockwise positive.

        A crank whose turning is given is told in its sense of rotation, as its angle, its running and the moment on it are.
        """
        return self.crank.sense if link == self.crank.link and self.drive is None else 1.0

    def search(self, purpose: str) -> SearchCount | None:
        """Count of the plans that search for something; None without a purpose, for a plan to be drawn or told."""
        return self.searches.setdefault(purpose, SearchCount(purpose)) if purpose else None

    @property
    def pairs(self) -> tuple[Pair, ...]:
        """All kinematic pairs, in order of attachment, named as in the manuals (A, B, B', C, D, D', D'')."""
        c = self.crank
        return (Pair(c.pivot, (self.frame, c.link), "rotation"), *(pair for g in self.groups for pair in g.kind.pairs(self, g)))

    def owner(self, point: str) -> str:
        """Link on which a point is fixed; the frame for fixed points, the first to carry it for hinges, the slider for its pin.

        Raises
        ------
        KeyError
            when no link has a point of this name.
        """
        if point in self.fixed:
            return self.frame
        if point == self.crank.pin:
            return self.crank.link
        for p in self.points:
            if p.name == point:
                return p.link
        for g in self.groups:
            if point in (carried := g.kind.carried(g)):
                return carried[point]
        raise KeyError(point)

    def carrier(self, leg: Leg) -> str:
        """Link outside a group that a leg of it is paired with."""
        return self.guides[leg.guide].link if leg.guide else self.owner(leg.outer)

    @property
    def mobility(self) -> int:
        """Degree of freedom by Chebyshev: W = 3n - 2 p5 - p4 (no pairs of class 4)."""
        moving = {name for pair in self.pairs for name in pair.links} - {self.frame}
        return 3 * len(moving) - 2 * len(self.pairs)

    @property
    def structure(self) -> str:
        """Formula of structure in Russian, from the initial mechanism outwards."""
        parts = [f"I(0,{self.crank.link})"]
        parts += [f"{g.kind.roman}({','.join(g.links)})" for g in self.groups]
        return " → ".join(parts)

    @property
    def grade(self) -> int:
        """Class of the mechanism: the highest class among its groups."""
        return max((g.kind.grade for g in self.groups), default=1)

    def link_points(self, link: str) -> tuple[str, ...]:
        """Names of the points fixed on a link: its pairs first, then its further points."""
        names = [p.name.rstrip("′″") for p in self.pairs if link in p.links]
        names += [p.name for p in self.points if p.link == link]
        for g in self.groups:
            if g.inner and link == g.links[1]:
                names.append(g.inner)
        return tuple(dict.fromkeys(names))
