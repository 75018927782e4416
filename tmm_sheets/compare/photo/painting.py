"""Known elements painted into a picture: to tell whose a place is, to mark places, to wipe ink out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element, grown
from tmm_sheets.compare.photo.profiles import SCALE, pixels, sample
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

THIN = 0.2  # mm, width of strokes of hatchings, bars and leaders
PIECE = 25.0  # mm of a line painted at once


class Owners:
    """A picture with the number of the element drawn at each place, negative where there are several.

    Of lettering it has only leaders and bars: letters are written where there is room.
    """

    def __init__(self, rows: int, columns: int) -> None:
        self.picture = np.zeros((rows, columns), np.int16)

    def add(self, e: Element, points: Points) -> None:
        """Enter an element, heads included, whose line runs along ``points``; it may be in other places already."""
        strokes = e.kind in ("hatch", "text")
        # At least two pixels wide, or a slanting profile could step over it.
        wide = max(round((THIN if strokes else line_type(e.style).width) * SCALE), 1)
        lines = e.pieces if strokes else () if e.kind == "fill" or (e.kind == "circle" and e.fills) else (points,)
        for line in lines:
            for piece in _pieces(line):
                at, corner, mask = _patch(piece, wide)
                cv2.polylines(mask, [at - corner], False, 1, wide, cv2.LINE_4, 4)  # LINE_8 leaves gaps at corners
                self._enter(e.number, corner, mask)
        for f in e.fills:
            at, corner, mask = _patch(f, 1)
            cv2.fillPoly(mask, [at - corner], 1, cv2.LINE_8, 4)
            self._enter(e.number, corner, mask)

    def _enter(self, number: int, corner: Any, mask: Any) -> None:
        x, y = (int(c) >> 4 for c in corner)
        rows, columns = self.picture.shape
        x0, y0, x1, y1 = max(x, 0), max(y, 0), min(x + mask.shape[1], columns), min(y + mask.shape[0], rows)
        if x0 >= x1 or y0 >= y1:
            return
        here = self.picture[y0:y1, x0:x1]
        on = mask[y0 - y : y1 - y, x0 - x : x1 - x] > 0
        before = here[on]
        here[on] = np.where(before == 0, number, np.where(np.abs(before) == number, before, -np.abs(before)))

    def others(self, numbers: Any, places: Any) -> Any:
        """Whether an element of another number is at places, mm; ``numbers`` is one number or an array that broadcasts."""
        found = sample(self.picture, pixels(places), nearest=True)
        return (found != 0) & (found != numbers)


def _pieces(points: Points) -> Iterator[Points]:
    """A line cut into pieces with small bounding boxes: the box of a long slanting line is mostly empty."""
    start = 0
    while start < len(points) - 1:
        far = np.abs(points[start + 1 :] - points[start])
        beyond = np.flatnonzero(far > PIECE)
        end = start + 1 + (int(beyond[0]) if len(beyond) else len(far) - 1)
        if end > start + 1 and len(beyond):
            end -= 1
        a, b = points[start], points[end]
        if end == start + 1 and abs(b - a) > PIECE:
            cuts = np.linspace(a, b, int(abs(b - a) / PIECE) + 2)
            yield from (cuts[k : k + 2] for k in range(len(cuts) - 1))
        else:
            yield points[start : end + 1]
        start = end


def _patch(points: Points, wide: int) -> tuple[Any, Any, Any]:
    """Points in sixteenths of pixels, the corner of a patch around them likewise, and the empty patch."""
    at = fixed(points)
    margin = wide // 2 + 2
    low = (at.min(0) >> 4) - margin
    size = (at.max(0) >> 4) + margin + 1 - low
    return at, low << 4, np.zeros((int(size[1]), int(size[0])), np.uint8)


WRITTEN = 0.9
"""Margin around lettering that is wiped out, mm: the edges of its letters in a row look like a stroke."""
ROOM, DENSE_ROOM = 1.4, 2.0
"""Margin around a line that is wiped out, mm; more for one among others, whose ink cannot be told from theirs."""


def fixed(p: Points, scale: float = SCALE) -> Any:
    """Points of the sheet in sixteenths of pixels, as cv2 draws them with a shift of 4."""
    q = np.ascontiguousarray(16 * pixels(p, scale))
    return np.rint(q.view(np.float64).reshape(-1, 2)).astype(np.int32)


def paint(picture: Any, e: Element, points: Points, margin: float, value: int = 255) -> None:
    """Draw an element along ``points``, heads included, ``margin`` mm wider; of lettering its bars and leaders."""
    if e.kind in ("hatch", "text"):
        for p in e.pieces:
            cv2.polylines(picture, [fixed(p)], False, value, max(round((0.2 + margin) * SCALE), 1), cv2.LINE_8, 4)
        return
    if e.kind != "fill" and not (e.kind == "circle" and e.fills):
        wide = max(round((line_type(e.style).width + margin) * SCALE), 1)
        cv2.polylines(picture, [fixed(points)], False, value, wide, cv2.LINE_8, 4)
    for f in e.fills:
        fill(picture, f, value)
        if margin:
            cv2.polylines(picture, [fixed(f)], True, value, round(2 * margin * SCALE), cv2.LINE_8, 4)


def fill(picture: Any, corners: Points, value: int = 255) -> None:
    """Paint a polygon."""
    cv2.fillPoly(picture, [fixed(corners)], value, cv2.LINE_8, 4)


def wipe_found(picture: Any, t: InkTrace, value: int = 255) -> None:
    """Paint a line where it was found, with room to spare."""
    if t.at is not None:
        paint(picture, t.element, t.at, ROOM if t.status == "measured" else DENSE_ROOM, value)


def wipe_small(wiped: Any, e: Element) -> None:
    """Wipe out what is not measured (lettering, hatching, dots, short strokes) where it belongs, generously."""
    if e.kind == "text":
        fill(wiped, grown(e.points, WRITTEN))
        for p in e.pieces:
            cv2.polylines(wiped, [fixed(p)], False, 255, round(1.5 * SCALE), cv2.LINE_8, 4)
    else:
        paint(wiped, e, e.points, 1.6)
