"""What a comparison tells who reads it on paper or in a browser, before it is set: mistakes, tables, what was not judged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell


@dataclass(frozen=True)
class Photo:
    """A rectangle of a photographed sheet, mm, seen from straight above, as PNG."""

    box: Box
    png: bytes


@dataclass(frozen=True)
class StoryPicture:
    """A part of a sheet, mm, y up: our lines, theirs, those that are wrong, and places with their numbers.

    ``photo`` shows theirs where they are no lines.
    """

    ours: tuple[Points, ...]
    theirs: tuple[Points, ...]
    wrong: tuple[Points, ...] = ()
    places: tuple[tuple[complex, float, str], ...] = ()
    photo: Photo | None = None

    @property
    def box(self) -> Box:
        """What it shows."""
        some = [*self.ours, *self.wrong, *(np.array([at + r * (1 + 1j), at - r * (1 + 1j)]) for at, r, _ in self.places)]
        some = some or list(self.theirs)
        return Box.around(np.concatenate(some), 6.0) if some else Box(0.0, 0.0, 100.0, 60.0)


@dataclass(frozen=True)
class ToldMistake:
    """Something done wrong: in which view, what, in how many words it needs, how bad ("red", "amber"), and what it looks like.

    ``named`` where ``what`` is what was done, not how many lines are off; ``again`` is said instead where a view before has that.
    """

    where: str
    what: str
    verdict: str
    details: tuple[str, ...] = ()
    picture: StoryPicture | None = None
    named: bool = False
    again: str = ""


@dataclass(frozen=True)
class StoryTable:
    """A table with a heading; columns are as wide as their texts need. ``verdicts`` of its rows, if they have any, colour them.

    ``pages`` are those that the second cells of its rows lead to, from the folder of the reports; "" for none.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    verdicts: tuple[str, ...] = ()
    pages: tuple[str, ...] = ()


@dataclass(frozen=True)
class Story:
    """A report to be read: what it is of, how it ended, and its three parts."""

    title: str
    about: tuple[str, ...]
    mistakes: tuple[ToldMistake, ...] = ()
    tables: tuple[StoryTable, ...] = ()
    unjudged: tuple[str, ...] = field(default_factory=tuple)


def listed(mistakes: Sequence[ToldMistake]) -> list[str]:
    """Mistakes for the terminal, a line each; what was done is told once, with all views where it shows."""
    where: dict[tuple[str, str], list[str]] = {}
    for m in mistakes:
        where.setdefault((m.what, "" if m.named else m.where), []).append(m.where)
    lines = [f"  {k}. {'; '.join(views)}: {what}" for k, ((what, _), views) in enumerate(where.items(), 1)]
    return [tell("What is wrong") + ":", *lines, ""] if lines else []


def clipped(lines: Sequence[Points], box: Box) -> tuple[Points, ...]:
    """The lines that have something in a box, whole."""
    return tuple(z for z in lines if len(z) and z.real.max() >= box.x0 and z.real.min() <= box.x1
                 and z.imag.max() >= box.y0 and z.imag.min() <= box.y1)
