"""Lines of which a picture shows pieces only, as a telephone's black-and-white mode does of thin ones.

A line left out has bare paper all along its place, while others as thin as it are whole. Where many of those are in pieces, one
that is gone altogether may be the picture's doing, and so may one of which half is there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_sheets.compare.photo.stations import expected_ink
from tmm_sheets.compare.photo.traces import InkTrace
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
