"""Places where the light takes letters and thin lines away: paper that a flash has washed out, and the edges of deep shadows.

What is not seen there may have been drawn. A line on paper that is washed out: see ``occlusion``; letters are lost before lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, sampled
from tmm_sheets.compare.photo.occlusion import GLARE, PAPER_GREY, Mask, at, ground_of
from tmm_sheets.compare.photo.sheet_map import PAPER, Map
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Points

ABOUT, STEEP = 7, 0.9
"""mm within which a shadow begins, and brightness of its dark side as a share of the other up to which its edge is steep."""
STEP = 0.5
"""mm between places of an end."""
TAKEN = 0.3
"""Share of an element's place in such light from which on nothing is told of what is not seen of it."""
APART = 50.0
"""mm from which on two places are told of."""
CUT = 1.0
"""mm by which a line seems too short from which on it is asked whether the light has taken the rest."""
LETTERING = ("absent lettering", "part of lettering")


def uneven_places(grey: Any, m: Map) -> Mask:
    """Where the light takes letters away, a pixel for each square millimetre, the upper row first.

    ``grey`` is the picture and ``m`` its map.
    """
    import cv2

    ground, _ = ground_of(grey, m, (round(PAPER.height), round(PAPER.width)))
    about = np.ones((ABOUT, ABOUT), np.uint8)
    edges = cv2.erode(ground, about) < STEEP * cv2.dilate(ground, about)
    washed_out = (ground >= GLARE) & (np.median(ground) < PAPER_GREY)
    return np.asarray(edges | washed_out)


def mask_washed_out(traces: Sequence[InkTrace], uneven: Mask) -> list[InkTrace]:
    """The traces; what is not seen, or only in part, where the light takes it away is hidden, and so is the end of a line."""
    return [InkTrace(t.element, "hidden") if _doubtful(t) and at(_places(t.element), uneven).mean() >= TAKEN else
            _with_ends_shown(t, uneven) for t in traces]


def _with_ends_shown(t: InkTrace, uneven: Mask) -> InkTrace:
    """A trace; where the light has taken what a line is too short by, its end is unknown."""
    rests = [k for k, by in enumerate(t.ends) if by < -CUT and at(_rest(t, k), uneven).mean() >= TAKEN]
    begin, end = (np.nan if k in rests else by for k, by in enumerate(t.ends))
    return replace(t, ends=(begin, end)) if rests else t


def _rest(t: InkTrace, k: int) -> Points:
    """Places of a line that are not seen at its beginning or its end."""
    line, by = sampled(t.element.points if k == 0 else t.element.points[::-1], STEP)[0], -t.ends[k]
    return np.asarray(line[: max(round(by / STEP), 1)])


def taken(before: Sequence[InkTrace], after: Sequence[InkTrace]) -> list[complex]:
    """About where the light took something of the sheet, mm; nothing where it took nothing."""
    places: list[complex] = []
    for middle in (_where(s, t) for s, t in zip(before, after, strict=True) if s is not t):
        if all(abs(middle - z) > APART for z in places):
            places.append(middle)
    return places


def _where(before: InkTrace, after: InkTrace) -> complex:
    """About where the light took something of an element: all of it, or an end."""
    if after.status == "hidden":
        return after.element.middle
    return complex(after.element.points[0 if np.isfinite(before.ends[0]) and not np.isfinite(after.ends[0]) else -1])


def _doubtful(t: InkTrace) -> bool:
    """Whether of an element too little is seen, and that may be the light's doing."""
    return t.status in LETTERING or (t.status == "missing" and t.pieces)


def _places(e: Element) -> Points:
    """Places of a line, or of the box of lettering."""
    if e.kind != "text":
        return np.asarray(sampled(e.points, 1.0)[0])
    box = Box.around(e.points)
    x, y = np.meshgrid(np.arange(box.x0, box.x1 + 1), np.arange(box.y0, box.y1 + 1))
    return np.asarray((x + 1j * y).ravel())
