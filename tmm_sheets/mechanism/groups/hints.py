"""What a kind of group tells of one: how the crank angle knows its crossing, how its links look, reactions from outside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tmm_sheets.construction.indices import against, on_link
from tmm_sheets.construction.step import Step


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
