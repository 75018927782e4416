"""Pictures without grey, as a telephone's document mode makes them: of few pixels they eat thin lines and small letters.

Where they are there in pieces all over the sheet, what is short, broken or gone of a thin line or of letters says nothing of the
drawing: it is told once of the picture. Where they are whole, their ends and parts of letters may be eaten still, unless there are
many pixels. What stands in a wrong place is a mistake always, and so is what is gone of thick lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from tmm_sheets.compare.photo.stations import expected_ink
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.styles import line_type

BLACK, WHITE, GREY = 64, 192, 0.25
"""Levels of black and white, and most pixels between them, as a share of the black ones; there are none but for compression."""
FINE = 7.0
"""Pixels per mm from which on thin lines are two pixels wide: those that are whole all over the sheet are not eaten anywhere."""
THIN = 0.3
"""mm; width of lines up to which they are eaten."""
LONG, BROKEN, MANY = 15.0, 0.9, 0.02
"""mm of a thin line, share of it with ink below which it is broken, and share of such lines that are: a pencil leaves gaps in one
of a hundred."""
SURE, LARGE, NOTHING = 0.85, 30.0, 0.1
"""Share of a thin line with ink from which on what lies elsewhere is it; mm of one that is not eaten whole, and its least rest."""
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
        return t.deviation > tolerance and (t.covered < SURE or t.deviation <= 2 * tolerance)
    return t.status == "covered"


def whole(t: InkTrace) -> InkTrace:
    """A trace without the ends by which a thin line is too short."""
    begin, end = (np.nan if by < 0 else by for by in t.ends)
    return replace(t, ends=(begin, end)) if _thin(t) else t


def _thin(t: InkTrace) -> bool:
    return t.element.kind != "text" and line_type(t.element.style).width <= THIN
