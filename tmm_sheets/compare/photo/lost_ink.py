"""What a picture loses of a drawing: what that may be the reason of is no mistake.

- Lines in pieces, as a telephone's black-and-white mode leaves thin ones. A line left out has bare paper all along its place, while
  others as thin as it are whole. Where many of those are in pieces, one that is gone altogether may be the picture's doing, and so
  may one of which half is there.
- Pictures without grey: of few pixels they eat thin lines and small letters. Where they are in pieces all over the sheet, what
  is short, broken or gone of a thin line or of letters says nothing of the drawing. Where they are whole, their ends and parts of
  letters may be eaten still, unless there are many pixels. What stands in a wrong place is a mistake always, and so is what is gone
  of thick lines.
- Paper that a flash has washed out, and the edges of deep shadows: letters are lost before lines. A line on paper that is washed
  out: see ``occlusion``.

"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import cv2
import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, sampled
from tmm_sheets.compare.photo.occlusion import GLARE, PAPER_GREY, Mask, at, ground_of
from tmm_sheets.compare.photo.sheet_map import PAPER, Map
from tmm_sheets.compare.photo.traces import NEARLY_ALL, InkTrace, expected_ink
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

FEW = 4
"""Least number of lines of a width that tell anything."""
WHOLE, SEVERAL = 0.9, 0.1
"""Share of a line that has ink below which it is in pieces, and share of a width's lines in pieces from which on it is torn."""
HALF, MOST = 0.4, 0.7
"""Share of a line with ink in its place from which on it was not left out, and by which one must be seen elsewhere to be there."""


def torn_widths(traces: Sequence[InkTrace]) -> set[float]:
    """Widths of the lines that a picture has torn."""
    found: dict[float, list[bool]] = {}
    for t in traces:
        if t.status == "measured" and t.darkness and expected_ink(t.element) == 1.0:  # by itself
            found.setdefault(line_type(t.element.style).width, []).append(t.covered < WHOLE)
    return {width for width, pieces in found.items() if len(pieces) >= FEW and np.mean(pieces) >= SEVERAL}


def in_pieces(t: InkTrace, torn: set[float]) -> bool:
    """Whether too little is seen for a line to be called missing, or elsewhere, where those of widths ``torn`` are in pieces."""
    tears = line_type(t.element.style).width in torn
    if t.status == "missing":
        return tears or t.covered >= HALF
    return t.status == "measured" and t.covered < (WHOLE if tears else MOST)


BLACK, WHITE, GREY = 64, 192, 0.25
"""Levels of black and white, and most pixels between them, as a share of the black ones; there are none but for compression."""
FINE = 7.0
"""Pixels per mm from which on thin lines are two pixels wide: those that are whole all over the sheet are not eaten anywhere."""
THIN = 0.3
"""mm; width of lines up to which they are eaten."""
LONG, BROKEN, MANY = 15.0, 0.9, 0.02
"""mm of a thin line, share of it with ink below which it is broken, and share of such lines that are: a pencil leaves gaps in one
of a hundred."""
LARGE, NOTHING = 30.0, 0.1
"""mm of a thin line that is not eaten whole, and its least rest."""
LETTERS = 3
"""Letters that are not eaten all; of lettering that stands elsewhere one less."""

LostToThreshold = Literal["nothing", "ends", "lines"]
"""What a picture eats of thin lines, and of letters with them."""


def without_grey(grey: Any) -> bool:
    """Whether a picture has black and white only."""
    few = grey[::3, ::3]
    black, white = float((few < BLACK).mean()), float((few > WHITE).mean())
    return black > 0 and 1 - black - white < GREY * black


def lost_to_threshold(grey: Any, traces: Sequence[InkTrace], scale: float) -> LostToThreshold:
    """What a picture of so many pixels per mm eats, by it and by what was found in it."""
    if not without_grey(grey):
        return "nothing"
    return "lines" if eats(traces) else "ends" if scale < FINE else "nothing"


def eats(traces: Sequence[InkTrace]) -> bool:
    """Whether thin lines are in pieces all over the sheet."""
    thin = [t.covered < BROKEN for t in traces if t.status == "measured" and t.element.length > LONG and _thin(t)
            and expected_ink(t.element) == 1.0]  # fmt: skip
    return bool(thin) and float(np.mean(thin)) > MANY


def may_be_lost(t: InkTrace, tolerance: float, some: LostToThreshold) -> bool:
    """Whether what was found of an element, other than its ends, may be the fault of a picture that eats ``some`` of thin lines."""
    if some == "ends":
        small = _thin(t) and t.status == "measured" and tolerance < t.deviation <= 2 * tolerance
        return small or (t.status == "part of lettering" and t.at is None)
    if some == "nothing":
        return False
    if t.status == "part of lettering":
        return True
    if t.status == "absent lettering":
        return sum(map(str.isalnum, t.element.text)) < LETTERS - (t.at is not None)
    if not _thin(t):
        return False
    if t.status == "missing":
        return t.element.length < LARGE or t.covered > NOTHING
    if t.status == "measured":
        return t.deviation > tolerance and (t.covered < NEARLY_ALL or t.deviation <= 2 * tolerance)
    return t.status == "covered"


def whole(t: InkTrace) -> InkTrace:
    """A trace without the ends by which a thin line is too short."""
    begin, end = (np.nan if by < 0 else by for by in t.ends)
    return replace(t, ends=(begin, end)) if _thin(t) else t


def _thin(t: InkTrace) -> bool:
    return t.element.kind != "text" and line_type(t.element.style).width <= THIN


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
