"""Lines that belong in one place, of which one was drawn elsewhere: it took the others with it.

One stroke is all of them. Its ink is found by one, and the others would be missing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_sheets.compare.photo.traces import InkTrace

SAME = 0.7
"""mm within which a line that lies along another is in its place."""
MOSTLY = 0.8
"""Least share of a line that lies along another one for it to be drawn with that."""
ELSEWHERE = 1.0
"""mm from its place beyond which a line was drawn elsewhere."""


def coincident_lines(traces: Sequence[InkTrace]) -> list[InkTrace]:
    """The traces; a straight line that is missing lies where one that belongs in its place was found."""
    moved = [t for t in traces if t.status == "measured" and t.element.kind == "line" and t.deviation > ELSEWHERE]
    return [next((with_it for g in moved if (with_it := _along(t, g)) is not None), t)
            if t.status == "missing" and t.element.kind == "line" else t for t in traces]


def _along(t: InkTrace, g: InkTrace) -> InkTrace | None:
    """A missing line as it lies along another that was found elsewhere, None where they do not belong in one place."""
    e, other = t.element, g.element
    if e.view is not other.view or g.at is None:
        return None
    begin, end = other.points[[0, -1]]
    way = end - begin
    place = (e.points - begin) / way
    together = min(place.real.max(), 1) - max(place.real.min(), 0)
    if np.abs(place.imag).max() * abs(way) > SAME or together < MOSTLY * np.ptp(place.real):
        return None
    at = g.at[0] + place.real * (g.at[-1] - g.at[0])
    off = at - e.points
    return InkTrace(e, "measured", complex(off.mean()), g.turn, 0.0, float(np.abs(off).max()), covered=g.covered, at=at)
