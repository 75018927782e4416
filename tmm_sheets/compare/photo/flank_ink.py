"""Ink beside a stroke, so near that it lies within the room that is wiped out about what was found.

A line that was drawn askew leaves its stroke at a small angle, and where several belong in the stroke it still looks right: each of
them finds ink in its place. The ink beside it is looked for once more, with no more room than a hand and a camera need.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.extra_ink import straight_ink
from tmm_sheets.compare.photo.profiles import SCALE
from tmm_sheets.compare.photo.stations import LEAST, measurable
from tmm_sheets.compare.photo.traces import ExtraInk, Trace
from tmm_sheets.compare.photo.wiping import fixed, paint, wipe_small

ROOM = 0.45
"""mm to either side of a line that are its own: a hand is off by 0.25 and the map by 0.15 (``judging``, ``rectification``)."""
EDGE = 0.45
"""Darkness as a share of that usual for thick lines at the edge of a stroke: however blurred it is, half of it there."""
HEAD = 0.8
"""mm about a head that are its own: what is not measured is set by eye."""
PIXEL = 1 / SCALE
"""mm by which the place where a line was found must differ from its own for both to be painted."""
MEETS = 1.0
"""mm within which pieces of ink are of one stroke: less than two lines beside each other are apart."""


def flank_ink(
    traces: Iterable[Trace],
    extra: Sequence[ExtraInk],
    ink: Any,
    covers: Any,
    words: Any,
    level: float,
    usual: float,
) -> list[ExtraInk]:
    """Straight strokes beside lines.

    Parameters
    ----------
    traces
        Of all elements.
    extra
        Ink that was found to belong to none: what meets it is more of it.
    ink
        The rectified picture, without creases.
    covers
        Where it does not show the sheet, 255 there.
    words
        Where a hand may have written, 255 there.
    level, usual
        Darkness of ink, and of thick lines.
    """
    import cv2

    known = covers.copy()
    for t in traces:
        e = t.element
        if not measurable(e):
            wipe_small(known, e)
            continue
        paint(known, e, e.points, 2 * ROOM)
        if t.at is not None and t.deviation > PIXEL:
            paint(known, e, t.at, 2 * ROOM)
        for head in e.fills:
            cv2.polylines(known, [fixed(head)], True, 255, round(2 * HEAD * SCALE), cv2.LINE_8, 4)
    beside = straight_ink(np.where(known > 0, np.uint8(0), ink), max(level, EDGE * usual), words, known, LEAST)
    told = np.concatenate([x.points for x in extra]) if extra else np.zeros(0, complex)
    return [x for x in beside if np.abs(x.points[:, None] - told).min(initial=np.inf) > MEETS]
