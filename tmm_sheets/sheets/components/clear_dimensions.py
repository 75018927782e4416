"""Dimensions that stand where nothing that is drawn runs through their lettering."""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterable

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas, lettered
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.text_boxes import CLEAR

ALONG = 1.2
"""What is kept free at both sides of a dimension line, mm: no other line may seem to be it."""
SHARES = 0.5, 0.4, 0.6, 0.3, 0.7
"""Places of the lettering on its line that are tried."""


def around(text: str) -> Box:
    """What lettering of a dimension takes about the middle of its baseline, with some room, mm."""
    laid = letter(text, 3.5)
    return Box(-laid.width / 2, -laid.descent, laid.width / 2, laid.ascent).inset(-CLEAR)


def crossed(ink: InkIndex, a: complex, b: complex, offset: float, text: str, share: float = 0.5) -> int:
    """How many lines would run through the lettering of a dimension."""
    at, along = lettered(a, b, offset, text, share=share)
    return ink.count_in(around(text), at, phase(along))


def dimension(canvas: Canvas, first: int, a: complex, b: complex, offsets: Iterable[float], text: str,
              factor: float = 1.0) -> None:
    """A dimension at the first of the offsets with nothing in its lettering and little along its line.

    What is drawn is seen from the mark ``first`` on; it measures ``factor`` per mm.
    """
    if not abs(b - a) > 0:
        return
    ink, u = InkIndex(canvas.marks[first:]), (b - a) / abs(b - a)
    long = Box(2.0, -ALONG, abs(b - a) - 2.0, ALONG)

    def ill(place: tuple[float, float]) -> int:
        return 10 * crossed(ink, a, b, place[0], text, place[1]) + ink.count_in(long, a + place[0] * 1j * u, phase(u))

    offset, share = min(((offset, share) for offset in offsets for share in SHARES), key=ill)
    canvas.dimension(a, b, offset, text, share=share, factor=factor)
