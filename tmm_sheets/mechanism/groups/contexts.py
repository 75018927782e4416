"""What kinds of groups tell of themselves: how the crank angle knows their crossing, how their links look, which reactions come
from outside, the loads and plans of their forces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Directions, Reals
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.step import Helper, Plan, Rule, Step, symbol
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.mechanism.model import Leg, Positions


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


@dataclass(frozen=True)
class Held:
    """How a link of a group is held from outside, by the link ``other``: the ``line`` of the unknown reaction, and a ``part`` of it
    across that line that moments, or projections on a slot, have given.
    """

    link: str
    other: str
    line: Step
    part: Step | None = None

    @property
    def symbol(self) -> str:
        """Symbol of the reaction."""
        return symbol(f"F{pair_index(self.link, self.other)}")

    @property
    def rest(self) -> str:
        """Symbol of what is not known: the normal part where there is another."""
        return self.symbol if self.part is None else f"{self.symbol}^n"


@dataclass
class ForcePlan:
    """Force plan of one link or of a whole group: polygon 1-2-...-1 of ``plan`` with its forces in order.

    Point 1 closes it: where two unknown forces do, the known ones are laid off from point 2 on before it is found, and their sides
    recorded between both; where one does, from point 1 itself.
    """

    name: str
    links: tuple[str, ...]
    plan: Plan
    sides: list[tuple[str, Step, Step, bool]] = field(default_factory=list)
    laid: list[tuple[str, Step, Step]] = field(default_factory=list)

    def side(self, symbol: str, tail: Step, head: Step, unknown: bool = False) -> None:
        """Record a side of the polygon; ``unknown`` sides are found by closing it."""
        self.sides.append((symbol, tail, head, unknown))
        self.plan.vector(symbol, tail, head)

    def begin(self, number: int = 2) -> Step:
        """The first point, from which the known forces are laid off: 2, or 1 where one unknown force leads back to it."""
        return self.plan.add(str(number), rules.GIVEN, 0j)

    def lay(self, tail: Step, symbol: str, vector: Step) -> Step:
        """Lay a known force off from ``tail``; returns its head."""
        head = self.plan.add(str(int(next(iter(self.plan)).name) + len(self.laid) + 1), rules.SHIFT, tail, vector)
        self.laid.append((symbol, tail, head))
        return head

    def lay_loads(self, tail: Step, loads: Iterable[Load]) -> Step:
        """Lay loads off one after another; returns the end of the chain."""
        for load in loads:
            tail = self.lay(tail, load.symbol, load.vector)
        return tail

    def lay_part(self, tail: Step, held: Held) -> Step:
        """Lay off the known part of a reaction, if there is one."""
        return tail if held.part is None else self.lay(tail, f"{held.symbol}^τ", held.part)

    def meet(self, one: Held, tail: Step, two: Held, *known: Any) -> Step:
        """Close by two unknown forces: that of ``one`` ends in point 2, that of ``two`` begins at the ``tail`` of the known ones.

        ``known`` is what else is known of the crossing of both lines.
        """
        start = self.plan["2"]
        closing = self.plan.add("1", rules.LINE_LINE, start, one.line, tail, two.line, *known)
        self.side(one.rest, closing, start, unknown=True)
        self.record_laid()
        self.side(two.rest, tail, closing, unknown=True)
        return closing

    def record_laid(self) -> None:
        """Record the sides of what was laid off."""
        for side in self.laid:
            self.side(*side)

    def between(self, name: str, tail: Step, head: Step) -> Step:
        """The force that closes the polygon from ``tail`` to ``head``."""
        return self.plan.add(name, CLOSE, tail, head)


SWEEP = 720
"""Crank angles of the fine sweep; between them the narrowest places are searched for."""

TOUCH = 1e-6
"""Share of the crank length (sine of the angle between guides) below which a pin sits on a pivot (guides are parallel)."""


@dataclass(frozen=True)
class AssemblyLimit:
    """One condition of assembly of a group: it holds where ``margin`` (m, or the sine of an angle) is not negative.

    ``unit`` is what the margin is compared with: the crank length, or 1 for a sine. ``say`` words the greatest lack, whose
    place is named when it is ``measured``; ``hint`` words what would help, from the positions of the whole turn.
    """

    unit: float
    margin: Callable[[Positions], Any]
    say: Callable[[float], str]
    hint: Callable[[Positions], str]
    measured: bool = True


def mm(length: float) -> str:
    """A length, m, in words."""
    return tell("{length:.4g} mm").format(length=length * 1000)


def lacking(length: float) -> str:
    """A lack, m, in words."""
    return mm(length) if length >= 1e-6 else tell("less than 0.001 mm")


def more(length: float) -> str:
    """A length to four significant digits, surely greater than the given one, m."""
    return _rounded(length * (1 + 1e-6), ceil)


def less(length: float) -> str:
    """A length to four significant digits, surely less than the given one, m."""
    return _rounded(length * (1 - 1e-6), floor)


def _rounded(length: float, to: Callable[[float], int]) -> str:
    if length <= 0:
        return mm(0.0)
    unit = 10.0 ** (floor(log10(length * 1000)) - 3)
    return tell("{length:.6g} mm").format(length=to(length * 1000 / unit) * unit)


def span(pos: Positions, p: str, q: str) -> Reals:
    """Distance of two points of the position plan, m, shape (n,)."""
    return np.abs(pos.value(pos.points[q]) - pos.value(pos.points[p]))


def rounding(length: float, *points: Any) -> Any:
    """What a difference of lengths may be by the rounding of a length and of some points alone, m, shape (n,)."""
    return 4e-15 * (length + sum(np.abs(p) for p in points))


def unrounded(margin: Reals, rounding: Reals) -> Reals:
    """A margin that is nothing where it is nothing but rounding, m: rods that just reach do reach."""
    return np.where(np.abs(margin) <= rounding, 0.0, margin)


def extremes(lengths: Reals) -> tuple[float, float]:
    """Least and greatest of ``lengths`` over the turn, m: a number, or shape (n,) that ends with the sweep.

    Between the angles of the sweep their squares, which are smooth, are taken as parabolas.
    """
    y = np.broadcast_to(lengths, max(np.size(lengths), SWEEP))[-SWEEP:] ** 2
    before, after = np.roll(y, 1), np.roll(y, -1)
    bend = before - 2 * y + after
    with np.errstate(invalid="ignore", divide="ignore"):
        vertex = np.where(np.abs(before - after) <= 2 * np.abs(bend), y - (after - before) ** 2 / (8 * bend), y)
    vertex = np.where(np.isfinite(vertex), vertex, y)
    return float(np.sqrt(max(np.nanmin(vertex), 0.0))), float(np.sqrt(np.nanmax(vertex)))


def sine(u: Directions, v: Directions) -> Reals:
    """Magnitude of the sine of the angle between two unit directions, shape (n,)."""
    return np.abs(ar.cross(u, v))
