"""What a drawing asks a kind of group for: outlines of its links, reactions from outside; names and steps, no ink."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_sheets.construction.step import Step


@dataclass(frozen=True)
class Outline:
    """A link as a bar through points, or as a block at a point along a direction.

    ``aim`` is a point the bar's line passes besides, ``arms`` are further lines by the names of their ends; ``slot`` is the
    direction of the slot in a ram, ``slotted`` says that a block may carry the slot of another group's stone.
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
    """Reaction on a link from outside its group: in the hinge at ``point``, or from ``guide``, balancing moments about ``point``.

    ``parts`` are the ends of its tangential part on the force plan, where the method splits it.
    """

    link: str
    point: str
    guide: str | None = None
    parts: tuple[Step, Step] | None = None
