"""Formats of paper (GOST 2.301), the frame on them, and the corner of the turned designation (GOST 2.104)."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

from tmm_sheets.box import Box

MAIN = {"A0": (841.0, 1189.0), "A1": (594.0, 841.0), "A2": (420.0, 594.0), "A3": (297.0, 420.0)}
"""Short and long side of the main formats, mm."""
SIDES = MAIN | {"A1x3": (841.0, 1783.0), "A1x4": (841.0, 2378.0), "A2x3": (594.0, 1261.0), "A2x4": (594.0, 1682.0),
                "A2x5": (594.0, 2102.0), "A3x3": (420.0, 891.0), "A3x4": (420.0, 1189.0), "A3x5": (420.0, 1486.0),
                "A3x6": (420.0, 1783.0), "A3x7": (420.0, 2080.0)}  # fmt: skip
"""The same of these and of the derived ones, short sides of a main one side by side, as the standard has rounded them."""
LONG, SHORT = 70.0, 14.0
"""Sides of field 26, the turned designation, mm."""


class Paper(NamedTuple):
    """A sheet of paper, mm; ``name`` is that of its format."""

    name: str
    width: float
    height: float

    @property
    def outline(self) -> Box:
        """The whole of it."""
        return Box(0.0, 0.0, self.width, self.height)

    @property
    def frame(self) -> Box:
        """Inside of the frame: 20 mm at the left for filing, 5 mm elsewhere."""
        return Box(20.0, 5.0, self.width - 5.0, self.height - 5.0)

    @property
    def designation(self) -> Box:
        """Place of field 26: the upper left corner, over a title block along the short side the upper right one."""
        frame = self.frame
        if self.width < self.height:
            return Box(frame.x1 - SHORT, frame.y1 - LONG, frame.x1, frame.y1)
        return Box(frame.x0, frame.y1 - SHORT, frame.x0 + LONG, frame.y1)

    @property
    def turn(self) -> float:
        """Angle of the lettering in field 26, rad."""
        return pi / 2 if self.width < self.height else pi

    @property
    def other_way(self) -> Paper:
        """The same paper, upright if it lies."""
        return Paper(self.name, self.height, self.width)


def paper(name: str, portrait: bool = False) -> Paper:
    """Paper of a format of :data:`SIDES`."""
    short, long = SIDES[name]
    return Paper(name, short, long) if portrait else Paper(name, long, short)


A1 = paper("A1")
"""What sheets are composed for."""
