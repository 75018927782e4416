"""What was found of an element in a picture, and ink that belongs to none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.drawing.marks import Points

SHORTEST = 8.0  # mm of line whose ends are looked for
Status = Literal["measured", "shared", "beside", "covered", "missing", "dense", "lettering", "part of lettering",
                 "absent lettering", "small", "hidden", "eaten"]  # fmt: skip

Head = Literal["unknown", "there", "absent", "left out", "reversed", "doubled"]


def open_line(e: Element) -> bool:
    """Whether an element has ends to look for."""
    return e.kind in ("line", "arc", "curve") and e.length >= SHORTEST and abs(e.points[0] - e.points[-1]) > 1e-6


@dataclass(frozen=True)
class InkTrace:
    """What was found of an element.

    Attributes
    ----------
    status : "measured" by itself; "shared": in one stroke with others; "beside": so, but a line like it
        lies beside; "covered": there is ink only where others are drawn; "missing"; "dense": its ink cannot be told from others';
        "lettering", "part of lettering" or "absent lettering"; "small": not looked at; "hidden": it does not show in the picture;
        "eaten": the picture is black and white and has too little of it left
    shift : of its middle, mm
    turn : rad, counter-clockwise
    growth : of the radius or half length, mm
    deviation : largest distance between its line and where it ought to be, mm
    ends : how far the line runs beyond its beginning and its end, mm; negative when it stops short, nan when unknown
    covered : share of it that has ink
    at : its line as it was found, mm
    darkness : of its line where it was found in its place; 0 where that is not known
    pieces : whether so little of it is seen, or of others as thin, that its absence may be the picture's doing
    head : of an arrow: "there", "absent", "left out": absent, and its line is a thin one, "reversed": at its other end,
        "doubled": one is there, and others hide whether one is at its tip; "unknown" also when it has none or several
    free : share of it near which no other line is drawn, where it was measured in its place
    parts : whether the ink by which it was measured in its place may be that of others in one stroke with it, and some of nobody's
        runs beside: it may be that
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
    darkness: float = 0.0
    head: Head = "unknown"
    pieces: bool = False
    free: float = 1.0
    parts: bool = False


class ExtraInk(NamedTuple):
    """Ink where no element is known: middle, extent and diagonal of its bounding box, mm, and some points of it."""

    middle: complex
    width: float
    height: float
    length: float
    points: Points = np.zeros(0, complex)
