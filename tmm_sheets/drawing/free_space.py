"""What a view has drawn already, and places that are clear of it and of each other."""

from __future__ import annotations

from cmath import rect
from collections.abc import Collection

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink_index import ROUNDING, Ink, crossing, enters, sides, within
from tmm_sheets.drawing.labels import text_boxes
from tmm_sheets.drawing.marks import Arc, Box, Text


class Drawn:
    """What a view has drawn since its ``first`` mark, but for circles about a point and some marks, by their numbers.

    Its lines, and the sides of its lettering.
    """

    def __init__(self, canvas: Canvas, first: int, about: complex | None = None, but: Collection[int] = ()) -> None:
        marks = [m for n, m in enumerate(canvas.marks) if n >= first and n not in but]
        self.ink = Ink(m for m in marks if about is None or not (isinstance(m, Arc) and abs(m.centre - about) < 1e-6))
        corners = text_boxes([m for m in marks if isinstance(m, Text)])
        self.written = np.stack((np.roll(corners, 1, axis=1), corners), axis=2).reshape(-1, 2)
        self._a, self._b = np.concatenate(((self.ink.a, self.ink.b), self.written.T), axis=1)
        self._counts = np.repeat((1, 10), (len(self.ink.a), len(self.written)))
        self._sides = sides(self._a, self._b)

    def meets(self, box: Box, origin: complex = 0j, direction: float = 0.0) -> bool:
        """Whether anything is in a rectangle of axes that are turned by an angle about a point, their origin."""
        return bool(len(self._met(box, origin, direction)))

    def count(self, box: Box, origin: complex, direction: float) -> int:
        """How many lines are in such a rectangle, lettering as much as ten."""
        return int(self._counts[self._met(box, origin, direction)].sum())

    def _met(self, box: Box, origin: complex, direction: float) -> npt.NDArray[np.intp]:
        """Numbers of what is in such a rectangle; only what may be near it is looked at."""
        way, p = rect(1, direction), box.centre
        middle = origin + p * way
        about = Box(middle.real, middle.imag, middle.real, middle.imag)
        near = within(self._sides, about, abs(complex(box.x0, box.y0) - p) + ROUNDING)
        a, b = ((z[near] - origin) * way.conjugate() for z in (self._a, self._b))
        return np.asarray(near[enters(a, b - a, *box)])

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
