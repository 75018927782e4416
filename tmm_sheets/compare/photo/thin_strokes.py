"""Vectors of which only the helper line under them is there.

A vector that was left out leaves the thin line of its construction in its place, and that is found for it. What tells them apart is
ink: a thin line is narrower and, blurred as it is in a picture, paler, than the vectors about it, all along where no other thick
line lies in its stroke. Letters and lines that cross may add ink there, and take none away.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.ink_levels import NO_GREY
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.occlusion import Mask, at
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.styles import line_type

THICK = 0.35
"""mm of width from which on a line hides whether a vector in one stroke with it was drawn."""
STEP = 0.3  # mm between places along a line
ASIDE = np.arange(-9, 10) * 0.1
"""mm to its sides within which there must be no other thick line."""
OWN = np.abs(ASIDE) <= 0.75
"""Those within which its ink is."""
SPARED, LEAST, PIECE = 1.5, 2.4, 5
"""mm at its ends that dots hide, least mm of it that must be seen by itself, and places that are taken together."""
NARROW, PALE = 0.62, 0.7
"""Ink across it, and its darkness, as shares of those usual for the vectors about it, up to which it is a thin line; in a black and
white picture all that is left of a line is black, and its width alone counts."""
UNIFORM, MOSTLY = 0.75, 0.85
"""Ink across it up to which a piece of it is no vector's, and least share of it where that is so."""
ENOUGH, NEAREST = 3, 9
"""Least number of vectors that tell what is usual, and of how many about one the middle one is taken."""


class _Stroke(NamedTuple):
    """Ink of a vector where no other thick line is near: across it in pieces of it, and its darkness."""

    element: Element
    across: Any
    dark: float

    @property
    def usual(self) -> float:
        return float(np.median(self.across))


def construction_only(traces: Sequence[InkTrace], ink: Any, hidden: Mask) -> set[int]:
    """Numbers of the vectors in whose places there is no more than a thin line.

    Parameters
    ----------
    traces
        All lines that were found.
    ink
        The rectified picture.
    hidden
        Where the sheet does not show.
    """
    thick = Owners(*ink.shape)
    for t in traces:
        if line_type(t.element.style).width >= THICK:
            thick.add(t.element, t.element.points)
    strokes = [s for t in traces if vector(t) and (s := _stroke(t, ink, thick, hidden)) is not None]
    return {s.element.number for s in strokes if _thin(s, [o for o in strokes if o is not s])}


def vector(t: InkTrace) -> bool:
    """Whether it is a straight vector that was found."""
    e, found = t.element, t.status in ("measured", "shared") and t.at is not None
    return found and e.style == "vector" and e.kind == "line" and len(e.fills) == 1


def _stroke(t: InkTrace, ink: Any, thick: Owners, hidden: Mask) -> _Stroke | None:
    assert t.at is not None
    length = abs(t.at[-1] - t.at[0])
    way = (t.at[-1] - t.at[0]) / length
    p = t.at[0] + way * np.arange(SPARED, length - SPARED, STEP)
    places = p[:, None] + 1j * way * ASIDE
    free = ~thick.others(t.element.number, places).any(1) & ~at(p, hidden)
    if free.sum() * STEP < LEAST:
        return None
    profile = sample(ink, pixels(places[free])).astype(np.float64)[:, OWN]
    pieces = [np.median(part, 0) for part in np.array_split(profile, max(len(profile) // PIECE, 1))]
    across = np.array([(part - part.min()).sum() for part in pieces])
    return _Stroke(t.element, across, float(np.median(profile.max(1))))


def _thin(s: _Stroke, others: Sequence[_Stroke]) -> bool:
    if len(others) < ENOUGH:
        return False
    about = sorted(others, key=lambda o: abs(o.element.middle - s.element.middle))[:NEAREST]
    usual, dark = float(np.median([o.usual for o in about])), float(np.median([o.dark for o in about]))
    uniform = (s.across <= UNIFORM * usual).mean() >= MOSTLY
    pale = s.dark <= PALE * dark or dark >= NO_GREY
    return bool(s.usual <= NARROW * usual and pale and uniform)
