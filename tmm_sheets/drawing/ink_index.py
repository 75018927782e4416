"""Where the ink of a sheet is: its lines as segments in arrays, asked for what is near a place, enters it or crosses a way."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.marks import Box, Line, Mark, Polyline, Provenance, Text, flat

ROUNDING = 1e-6
"""mm by which what is looked at may lie farther off."""
STRONG = frozenset({"main", "curve", "vector", "axis", "hidden"})
"""Line types that a leader or a number had better not meet."""

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]


class Ink:
    """Lines of a sheet as segments ``a`` .. ``b``, shape (n,), each with the number of its mark; lettering is none of them.

    Leaders have the number ``drawn``.
    """

    def __init__(self, marks: Iterable[Mark]) -> None:
        self.marks = list(marks)
        self.drawn = len(self.marks)
        self.lead(np.empty(0), np.empty(0))
        starts, ends, strokes = list[Any](), list[Any](), list[tuple[int, int, bool]]()
        for number, mark in enumerate(self.marks):
            if isinstance(mark, Text) or (isinstance(mark, Line) and mark.style == "text"):
                continue
            if isinstance(mark, Line):  # most are: quicker without an array for each
                starts.append((mark.a,))
                ends.append((mark.b,))
            else:
                points = flat(mark, 1.0)
                if isinstance(mark, Polyline):
                    points = _thinned(points)
                starts.append(points[:-1])
                ends.append(points[1:])
            strokes.append((number, len(starts[-1]), mark.style in STRONG))
        self.a, self.b = (np.fromiter(chain.from_iterable(of), complex) for of in (starts, ends))
        of, count, strong = (np.array(column) for column in zip(*strokes, strict=True)) if strokes else np.empty((3, 0), int)
        self.of, self.strong = np.repeat(of, count), np.repeat(strong.astype(bool), count)
        self._steps: dict[tuple[str | int, ...], list[int]] = {}
        for number, mark in enumerate(self.marks):
            if mark.by is not None and mark.by.step and mark.by.role != "text":
                for key in (mark.by[1:4], mark.by[1:]):
                    self._steps.setdefault(key, []).append(number)
        self.sides = sides(self.a, self.b)

    def lead(self, a: Any, b: Any) -> None:
        """The leaders there are now, from ``a`` to ``b``."""
        self._leaders = np.asarray(a, complex), np.asarray(b, complex)

    def round(self, p: complex, reach: float) -> tuple[Any, Any, Any, Any]:
        """Segments that may be within ``reach`` of a point: ``a``, ``b``, number of the mark, strength; those of leaders last."""
        here = self.near(Box(p.real, p.imag, p.real, p.imag), reach)
        a, b = self._leaders
        if not len(a):
            return self.a[here], self.b[here], self.of[here], self.strong[here]
        near = distance(a, b, p) <= reach
        n = int(near.sum())
        return (np.concatenate((self.a[here], a[near])), np.concatenate((self.b[here], b[near])),
                np.concatenate((self.of[here], np.full(n, self.drawn))), np.concatenate((self.strong[here], np.zeros(n, bool))))

    def of_step(self, by: Provenance) -> list[int]:
        """Numbers of the marks of the same step, position and frame; one arm among those of a sum has a name of its own."""
        return (by.name and self._steps.get(by[1:])) or self._steps.get(by[1:4], [])

    def near(self, box: Box, reach: float) -> npt.NDArray[np.intp]:
        """Numbers of the segments that may be within ``reach`` of a rectangle."""
        return within(self.sides, box, reach)


def sides(a: Any, b: Any) -> Floats:
    """Left, lower, right and upper edges of segments, (4, n)."""
    x, y = np.stack((a.real, b.real)), np.stack((a.imag, b.imag))
    return np.array([x.min(axis=0), y.min(axis=0), x.max(axis=0), y.max(axis=0)])


def within(edges: Floats, box: Box, reach: float) -> npt.NDArray[np.intp]:
    """Numbers of those of some edges, (4, n), that may be within ``reach`` of a rectangle."""
    x0, y0, x1, y1 = edges
    return np.flatnonzero((x0 <= box.x1 + reach) & (x1 >= box.x0 - reach) & (y0 <= box.y1 + reach) & (y1 >= box.y0 - reach))


def _thinned(points: Any) -> Any:
    """A curve of hundreds of points by fewer chords: no point but the last is nearer than a millimetre to the one before."""
    if len(points) < 50:
        return points
    way = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points)))))
    keep = np.flatnonzero(np.diff(np.floor(way), prepend=-1.0))
    return points[np.union1d(keep, [len(points) - 1])]


def distance(a: Any, b: Any, p: complex) -> Floats:
    """Distances of a point to segments."""
    d = b - a
    length2 = np.maximum(np.abs(d) ** 2, 1e-18)
    t = np.minimum(np.maximum(((p - a) * np.conj(d)).real / length2, 0.0), 1.0)
    return np.asarray(np.abs(a + t * d - p))


def enters(a: Any, d: Any, x0: Any, y0: Any, x1: Any, y1: Any) -> Flags:
    """Whether segments pass through rectangles: by their parameter's range between each pair of sides."""
    first, last = 0.0, 1.0
    for start, step, low, high in ((np.real(a), np.real(d), x0, x1), (np.imag(a), np.imag(d), y0, y1)):
        safe = np.where(np.abs(step) < 1e-12, 1e-12, step)  # along the sides: far off at both ends, or between them
        u, v = (low - start) / safe, (high - start) / safe
        first, last = np.maximum(first, np.minimum(u, v)), np.minimum(last, np.maximum(u, v))
    return np.asarray(first <= last)


def crossing(a: Any, b: Any, p: complex, q: complex) -> Flags:
    """Whether segments cross the way from ``p`` to ``q``; touching its ends does not count."""
    def side(u: Any, v: Any, w: Any) -> Any:
        return ((v - u) * np.conj(w - u)).imag

    return np.asarray((side(p, q, a) * side(p, q, b) < 0) & (side(a, b, p) * side(a, b, q) < 0))
