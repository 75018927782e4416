"""Regions of ink that belong to no known element."""

from __future__ import annotations

from math import hypot
from typing import Any

import cv2
import numpy as np

from tmm_sheets.compare.photo.profiles import SCALE, pixels, regions, sample, window
from tmm_sheets.compare.photo.sheet_map import FRAME
from tmm_sheets.compare.photo.traces import ExtraInk
from tmm_sheets.drawing.marks import Points

EXTRA = 8.0  # mm, least extent of ink that is reported
LEAST_WIDTH = 0.15  # mm: a line of that extent and width is the least amount of ink that is reported
INSIDE = window(FRAME.centre, complex(FRAME.width, FRAME.height) / 2 - (2 + 2j))
"""Rows and columns 2 mm inside the frame, where ink counts."""
COARSE = 3  # pixels to one of the coarse picture
JOIN = 3  # coarse pixels; smaller gaps within a region are closed
POINTS = 300  # most points of a region that are told
STRAIGHT = 0.4
"""mm; standard deviation across a stroke that is straight: no hand writes a letter as long as what is reported and as straight."""
FOLD, FAINTER, EVERY = 0.25, 3.0, 8
"""Least darkness of a crease, as a share of ink's, on three quarters of its length, how much darker than that ink on it is, and the
distance of the pixels that are looked at."""
RIM, ALL = 0.8, 0.8
"""mm to a side within which something was wiped out along a strip one coarse pixel wide, and the least share of the strip, for it
to be the rim of that: a line is wider."""


def extra_ink(left: Any, level: float, words: Any, wiped: Any) -> list[ExtraInk]:
    """Regions of leftover ink inside the frame, the longest first.

    Parameters
    ----------
    left
        The rectified picture with all that was found wiped out.
    level
        Darkness of ink.
    words
        Where a hand may have written, 255 there: only straight strokes count.
    wiped
        Where it was wiped out, 255 there.
    """
    out = _regions(np.where(words > 0, np.uint8(0), left), level, straight=False)
    out += [x for x in _regions(left, level, straight=True) if not any(_overlap(x, y) for y in out)]
    return sorted((x for x in out if not _rim(x, wiped)), key=lambda x: -x.length)


def without_creases(left: Any, ink: Any, level: float) -> Any:
    """What is left of a rectified sheet without creases that run upright or level from side to side of it.

    They are as wide as a pencil's line and paler, and unlike any line of a drawing they show over the whole of the sheet.
    """
    out = left.copy()
    for part, sheet in ((out[INSIDE], ink[INSIDE]), (out[INSIDE].T, ink[INSIDE].T)):
        usual = np.percentile(sheet[::EVERY], 25, axis=0)
        at = np.flatnonzero(usual > FOLD * level)
        part[:, at] = np.where(part[:, at] < FAINTER * usual[at], 0, part[:, at])
    return out


def _rim(x: ExtraInk, wiped: Any) -> bool:
    """Whether ink is no more than the rim of a level or upright line that was wiped out beside it."""
    if min(x.width, x.height) > COARSE / SCALE + 1e-9:
        return False
    aside = RIM * (1j if x.height < x.width else 1)
    beside = [sample(wiped, pixels(x.points + by), nearest=True) > 0 for by in (aside / 2, aside, -aside / 2, -aside)]
    return bool(np.maximum(np.logical_or(*beside[:2]).mean(), np.logical_or(*beside[2:]).mean()) >= ALL)


def _overlap(x: ExtraInk, y: ExtraInk) -> bool:
    """Whether the boxes of two regions have something in common."""
    apart = x.middle - y.middle
    return abs(apart.real) < (x.width + y.width) / 2 and abs(apart.imag) < (x.height + y.height) / 2


def _regions(left: Any, level: float, straight: bool) -> list[ExtraInk]:
    """Regions of ink, all that are large enough, or only straight strokes."""
    dark = (left > level).astype(np.uint8)
    inside = np.zeros_like(dark)
    inside[INSIDE] = dark[INSIDE]
    # A third of the resolution is enough for regions, if it keeps count of the ink.
    amount = cv2.resize(inside * np.uint8(COARSE**2), None, fx=1 / COARSE, fy=1 / COARSE, interpolation=cv2.INTER_AREA)
    scale = SCALE / COARSE
    # Rejoin pieces of a line that was cut by wiping.
    joined = cv2.morphologyEx((amount > 0).astype(np.uint8), cv2.MORPH_CLOSE, np.ones((JOIN, JOIN), np.uint8))
    labels, found = regions(joined, scale=scale)
    area = np.bincount(labels[amount > 0], weights=amount[amount > 0], minlength=len(found) + 1)
    out = []
    for r in found:
        w, h, mine = r.box.width, r.box.height, labels[r.here] == r.label
        if hypot(w, h) < EXTRA or area[r.label] < LEAST_WIDTH * EXTRA * SCALE**2:
            continue
        if not straight or _across(r.points(mine, scale)) <= STRAIGHT:
            points = r.points(mine & (amount[r.here] > 0), scale)
            out.append(ExtraInk(r.middle, w, h, hypot(w, h), points[:: len(points) // POINTS + 1]))
    return out


def _across(z: Points) -> float:
    """Standard deviation of points across their longer direction, mm."""
    return float(np.sqrt(max(np.linalg.eigvalsh(np.cov(z.real, z.imag))[0], 0.0)))
