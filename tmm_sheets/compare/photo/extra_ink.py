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


def extra_ink(left: Any, level: float) -> list[ExtraInk]:
    """Regions of leftover ink inside the frame, the longest first.

    Parameters
    ----------
    left
        The rectified picture with all that was found wiped out.
    level
        Darkness of ink.
    """
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
        x, y = middles[i]
        out.append(ExtraInk(complex((x + 0.5) / scale, PAPER.y1 - (y + 0.5) / scale), w, h, hypot(w, h)))
    return sorted(out, key=lambda q: -q.length)
