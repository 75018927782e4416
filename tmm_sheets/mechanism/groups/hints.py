"""What a kind of group tells of one: how the crank angle knows its crossing, outlines of its links, reactions from outside."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_sheets.construction.step import Step


@dataclass(frozen=True)
class Crossing:
    """What the crank angle knows of the crossing of a group, as steps: half of the chord (or the tangent's length), the distance
    of the centres (none for a line), the sine between the group's lines in the plans of velocities.
    """

    half: Step
    distance: Step | None
    sine: Step

    @property
    def lengths(self) -> tuple[Step, ...]:
        """Further arguments of the rule that makes the crossing."""
        return (self.half,) if self.distance is None else (self.half, self.distance)


@dataclass(frozen=True)
class Outline:
    """A link as a bar through points, or as a block at a point along a direction.

    ``aim`` is a further point that the bar's line passes through, ``arms`` are further lines by the names of their ends;
    ``slot`` is the direction of the slot in a ram, ``slotted`` says that a block may carry the slot of another group's stone.
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
