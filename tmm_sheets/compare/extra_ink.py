"""Ink that belongs to nothing."""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np

from tmm_sheets.compare.profiles import SCALE, pixels
from tmm_sheets.compare.sheet_map import FRAME, PAPER
from tmm_sheets.compare.traces import Extra

EXTRA = 8.0  # mm of ink that belongs to nothing, from which on it is told


def extra_ink(left: Any, level: float) -> list[Extra]:
    """Regions of ink that belong to nothing, inside the frame."""
    import cv2

    dark = (left > level).astype(np.uint8)
    inset = round(2 * SCALE)
    x0, y0 = pixels(np.array([complex(FRAME.x0, FRAME.y1)]))[0].real, pixels(np.array([complex(FRAME.x0, FRAME.y1)]))[0].imag
    x1, y1 = pixels(np.array([complex(FRAME.x1, FRAME.y0)]))[0].real, pixels(np.array([complex(FRAME.x1, FRAME.y0)]))[0].imag
    mask = np.zeros_like(dark)
    mask[round(y0) + inset : round(y1) - inset, round(x0) + inset : round(x1) - inset] = 1
    dark &= mask
    # Pieces of one line, cut by what was wiped, come together again.
    joined = cv2.morphologyEx(dark, cv2.MORPH_CLOSE, np.ones((round(1.6 * SCALE), round(1.6 * SCALE)), np.uint8))
    _, labels, stats, middles = cv2.connectedComponentsWithStats(joined, connectivity=8)
    area = np.bincount(labels[dark > 0].ravel(), minlength=len(stats))
    out = []
    for i in range(1, len(stats)):
        w, h = stats[i, cv2.CC_STAT_WIDTH] / SCALE, stats[i, cv2.CC_STAT_HEIGHT] / SCALE
        if hypot(w, h) < EXTRA or area[i] < 0.15 * EXTRA * SCALE**2:
            continue
        x, y = middles[i]
        out.append(Extra(complex((x + 0.5) / SCALE, PAPER.y1 - (y + 0.5) / SCALE), w, h, hypot(w, h)))
    return sorted(out, key=lambda q: -q.length)
