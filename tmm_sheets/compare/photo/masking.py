"""Painting known elements into a picture, to mark their places or to wipe them out."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element, grown
from tmm_sheets.compare.photo.profiles import SCALE, pixels
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

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
    import cv2

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
    import cv2

    cv2.fillPoly(picture, [fixed(corners)], value, cv2.LINE_8, 4)


def wipe_found(picture: Any, t: InkTrace, value: int = 255) -> None:
    """Paint a line where it was found, with room to spare."""
    if t.at is not None:
        paint(picture, t.element, t.at, ROOM if t.status == "measured" else DENSE_ROOM, value)


def wipe_small(wiped: Any, e: Element) -> None:
    """Wipe out what is not measured (lettering, hatching, dots, short strokes) where it belongs, generously."""
    import cv2

    if e.kind == "text":
        fill(wiped, grown(e.points, WRITTEN))
        for p in e.pieces:
            cv2.polylines(wiped, [fixed(p)], False, 255, round(1.5 * SCALE), cv2.LINE_8, 4)
    else:
        paint(wiped, e, e.points, 1.6)
