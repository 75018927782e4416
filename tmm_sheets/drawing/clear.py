"""What a view has drawn already, and places that are clear of it and of each other."""

from __future__ import annotations

from cmath import rect
from collections.abc import Collection

import numpy as np

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.labels import text_box
from tmm_sheets.drawing.marks import Arc, Box, Text
from tmm_sheets.drawing.owners import Ink, crossing, enters


class Drawn:
    """What a view has drawn since its ``first`` mark, but for circles about a point and some marks, by their numbers.

    Its lines, and the sides of its lettering.
    """

    def __init__(self, canvas: Canvas, first: int, about: complex | None = None, but: Collection[int] = ()) -> None:
        marks = [m for n, m in enumerate(canvas.marks) if n >= first and n not in but]
        self.ink = Ink(m for m in marks if about is None or not (isinstance(m, Arc) and abs(m.centre - about) < 1e-6))
        corners = [text_box(m) for m in marks if isinstance(m, Text)]
        self.written = np.array([(z[k - 1], z[k]) for z in corners for k in range(len(z))]).reshape(-1, 2)

    def meets(self, box: Box, origin: complex = 0j, direction: float = 0.0) -> bool:
        """Whether anything is in a rectangle of axes that are turned by an angle about a point, their origin."""
        back = rect(1, -direction)
        return any(bool(enters((a - origin) * back, (b - a) * back, *box).any())
                   for a, b in ((self.ink.a, self.ink.b), self.written.T))

    def count(self, box: Box, origin: complex, direction: float) -> int:
        """How many lines are in such a rectangle, lettering as much as ten."""
        back = rect(1, -direction)
        lines, written = (int(enters((a - origin) * back, (b - a) * back, *box).sum())
                          for a, b in ((self.ink.a, self.ink.b), self.written.T))
        return lines + 10 * written

    def strong(self, a: complex, b: complex) -> bool:
        """Whether a line would cross the outlines of teeth or others as strong."""
        return bool(crossing(self.ink.a[self.ink.strong], self.ink.b[self.ink.strong], a, b).any())

    def over(self, a: complex, b: complex) -> bool:
        """Whether a line would run over lettering."""
        return bool(crossing(self.written[:, 0], self.written[:, 1], a, b).any())


def spread(heights: list[float], least: float) -> list[float]:
    """Sorted heights moved apart to the least distance, as little as needed and about the same middle."""
    out = list(heights)
    for _ in range(200):
        moved = False
        for i in range(len(out) - 1):
            short = least - (out[i + 1] - out[i])
            if short > 1e-3:
                out[i] -= short / 2
                out[i + 1] += short / 2
                moved = True
        if not moved:
            break
    return out
