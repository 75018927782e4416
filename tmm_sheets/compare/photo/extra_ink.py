"""Ink that belongs to no known element."""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.profiles import SCALE, pixels
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER
from tmm_sheets.compare.photo.traces import ExtraInk

EXTRA = 8.0  # mm, least extent of ink that is reported
LEAST_WIDTH = 0.15  # mm: a line of that extent and width is the least amount of ink that is reported
INSET = 2.0  # mm inside the frame within which ink counts
COARSE = 3  # pixels to one of the coarse picture
JOIN = 3  # coarse pixels; smaller gaps within a region are closed


CREASE, PIECES, SPAN = 2.0, 4, 200.0
"""mm that a piece of a crease is wide, and off the others, at most; least number of pieces and least distance of the outermost."""
STRAIGHT = 0.4
"""mm; standard deviation across a stroke that is straight: no hand writes a letter as long as what is reported and as straight."""


def extra_ink(left: Any, level: float, words: Any) -> list[ExtraInk]:
    """Regions of leftover ink inside the frame, the longest first.

    Parameters
    ----------
    left
        The rectified picture with all that was found wiped out.
    level
        Darkness of ink.
    words
        Where a hand may have written, 255 there: only straight strokes count.
    """
    free = np.where(words > 0, np.uint8(0), left)
    out = _regions(free, level, straight=False)
    for x in _regions(left, level, straight=True):
        if all(max(abs(x.middle.real - y.middle.real) - (x.width + y.width) / 2,
                   abs(x.middle.imag - y.middle.imag) - (x.height + y.height) / 2) > 0 for y in out):
            out.append(x)
    return sorted(_without_creases(out), key=lambda q: -q.length)


def _without_creases(some: list[ExtraInk]) -> list[ExtraInk]:
    """Those that are not pieces of a crease: it runs upright or level all over the sheet, and shows where nothing is drawn."""
    out = some
    for upright in (True, False):
        thin = [x for x in out if (x.width if upright else x.height) <= CREASE]
        at = np.array([x.middle.real if upright else x.middle.imag for x in thin])
        along = np.array([x.middle.imag if upright else x.middle.real for x in thin])
        for k in range(len(thin)):
            one = np.abs(at - at[k]) <= CREASE
            if one.sum() >= PIECES and np.ptp(along[one]) > SPAN:
                out = [x for x in out if x is not thin[k]]
    return out


def _regions(left: Any, level: float, straight: bool) -> list[ExtraInk]:
    """Regions of ink, all that are large enough, or only straight strokes."""
    import cv2

    dark = (left > level).astype(np.uint8)
    corners = np.array([complex(FRAME.x0 + INSET, FRAME.y1 - INSET), complex(FRAME.x1 - INSET, FRAME.y0 + INSET)])
    low, high = pixels(corners)
    inside = np.zeros_like(dark)
    rows, columns = slice(round(low.imag), round(high.imag)), slice(round(low.real), round(high.real))
    inside[rows, columns] = dark[rows, columns]
    # A third of the resolution is enough for regions, if it keeps count of the ink.
    amount = cv2.resize(inside * np.uint8(COARSE**2), None, fx=1 / COARSE, fy=1 / COARSE, interpolation=cv2.INTER_AREA)
    scale = SCALE / COARSE
    # Rejoin pieces of a line that was cut by wiping.
    joined = cv2.morphologyEx((amount > 0).astype(np.uint8), cv2.MORPH_CLOSE, np.ones((JOIN, JOIN), np.uint8))
    _, labels, stats, middles = cv2.connectedComponentsWithStats(joined, connectivity=8)
    area = np.bincount(labels[amount > 0], weights=amount[amount > 0], minlength=len(stats))
    out = []
    for i in range(1, len(stats)):
        w, h = stats[i, cv2.CC_STAT_WIDTH] / scale, stats[i, cv2.CC_STAT_HEIGHT] / scale
        if hypot(w, h) < EXTRA or area[i] < LEAST_WIDTH * EXTRA * SCALE**2:
            continue
        if straight and _across(labels, stats[i], i) > STRAIGHT * scale:
            continue
        x, y = middles[i]
        out.append(ExtraInk(complex((x + 0.5) / scale, PAPER.y1 - (y + 0.5) / scale), w, h, hypot(w, h)))
    return out


def _across(labels: Any, box: Any, label: int) -> float:
    """Standard deviation of a region across its longer direction, coarse pixels."""
    x, y, w, h = (int(n) for n in box[:4])
    rows, columns = np.nonzero(labels[y : y + h, x : x + w] == label)
    return float(np.sqrt(max(np.linalg.eigvalsh(np.cov(rows, columns))[0], 0.0)))
