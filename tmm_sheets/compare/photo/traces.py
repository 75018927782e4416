"""What is found of an element in a picture, and ink that belongs to none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.drawing.marks import Points

SHORTEST = 8.0  # mm of line from which on its ends are looked for
Status = Literal["measured", "shared", "missing", "dense", "lettering", "absent lettering", "small"]


def open_line(e: Element) -> bool:
    """Whether an element has ends that are looked for."""
    return e.kind in ("line", "arc", "curve") and e.length >= SHORTEST and abs(e.points[0] - e.points[-1]) > 1e-6


@dataclass(frozen=True)
class Trace:
    """What was found of an element.

    ``status`` is "measured" by itself, "shared": with others in one stroke, "missing", "dense": ink that cannot be told from
    others', "lettering" or "absent lettering", "small": not looked at.
    ``shift`` is that of its middle, mm; ``turn`` rad; ``growth`` mm at the radius or half length; ``deviation`` the largest
    distance between where its line is and ought to be, mm; ``ends`` how far the line runs beyond its beginning and end (negative:
    it stops short; nan: cannot be told), mm; ``covered`` the share of it that has ink; ``at`` its line as it was found.
    """

    element: Element
    status: Status
    shift: complex = 0j
    turn: float = 0.0
    growth: float = 0.0
    deviation: float = 0.0
    ends: tuple[float, float] = (np.nan, np.nan)
    covered: float = 0.0
    at: Points | None = None


class Extra(NamedTuple):
    """Ink where nothing is known: its box on the sheet's middle, its extent and how much line there is, mm."""

    middle: complex
    width: float
    height: float
    length: float
