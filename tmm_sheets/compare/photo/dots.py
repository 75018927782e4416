"""Dots that stand beside their places.

A dot is too small to be measured among lines, but one in a wrong place is a round spot that belongs to nothing, and its own place
has none: about it the picture is taken for lines and a dot, each as dark as fits best. A spot alone is no displaced dot.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.hidden import Mask, at
from tmm_sheets.compare.photo.profiles import SCALE, pixels, sample
from tmm_sheets.compare.photo.sheet_map import PAPER, Floats
from tmm_sheets.compare.photo.traces import Trace

REACH, FAR = 1.7, 6.0
"""mm about the place of a dot that are looked at, and within which a spot may be this dot."""
ASIDE, LEAST = 0.45, 1.3
"""mm by which a dot in its place may stand aside, and beyond which it stands elsewhere."""
BLUR = 0.22
"""Standard deviation of a photograph's blur, mm."""
SIZES = 0.45, 2.8
"""Area of a spot as a share of that of the dot."""
WIDER, ROUND, FULL = 1.0, 2.0, 0.6
"""mm by which a spot may be wider than the dot, how much longer than wide, and the least share of its rectangle that it fills."""
ALONE = 0.9
"""mm about a spot without other ink."""
FAINT, DARK, SMALL_DARK, SMALL = 0.3, 0.6, 0.35, 0.45
"""Darkness from which on a place belongs to a spot, and least darkness of a spot and of a dot in its place, as shares of the
lines'; the same of dots of less than the radius, mm, which blur makes pale."""
TOUCHED = 9
"""Pixels about the middle of a small spot that nothing else may take."""
TELLS = 0.15
"""Least share of a dot that lines do not show as well for anything to be told of its place."""


def displaced_dots(
    some: Sequence[Element], lines: Any, taken: Any, ink: Any, words: Any, hidden: Mask, usual: float,
) -> list[Trace]:
    """Traces of dots that stand beside their places.

    Parameters
    ----------
    some
        The dots.
    lines
        A picture of all other lines where they were found, 255 there.
    taken
        The same with the dots, with room to spare.
    ink
        The rectified picture.
    words
        A picture of the places of lettering, 255 there.
    hidden
        Where the sheet does not show.
    usual
        How dark lines usually are.
    """
    import cv2

    free = np.maximum(taken, words) == 0
    seen = ((ink > FAINT * usual) & free).astype(np.uint8)
    _, _, stats, middles = cv2.connectedComponentsWithStats(seen, connectivity=8)
    w, h, area = (stats[:, k].astype(np.float64) for k in (cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT, cv2.CC_STAT_AREA))
    spots = np.flatnonzero((np.maximum(w, h) <= ROUND * np.minimum(w, h)) & (area > FULL * w * h) & (area < (4 * SCALE) ** 2))
    spots = spots[np.array([_alone(seen, stats[k]) for k in spots], bool)]
    w, h, area, middles = w[spots], h[spots], area[spots], middles[spots]
    z = (middles[:, 0] + 0.5) / SCALE + 1j * (PAPER.y1 - (middles[:, 1] + 0.5) / SCALE)
    touched = cv2.boxFilter(free.astype(np.float32), -1, (TOUCHED, TOUCHED))
    clear = np.array([touched[round(y), round(x)] > 0.999 for x, y in middles], bool)
    dark = sample(cv2.dilate(ink, np.ones((3, 3), np.uint8)), pixels(z))
    out = []
    for e in some:
        size, far = np.pi * e.radius**2 * SCALE**2, np.abs(z - e.centre)
        least = usual * (SMALL_DARK if e.radius < SMALL else DARK)
        sized = (area > SIZES[0] * size) & (area < SIZES[1] * size) & (np.maximum(w, h) < (2 * e.radius + WIDER) * SCALE)
        like = sized & (far < FAR) & (far > max(LEAST, e.radius + ASIDE)) & (dark > least) & ~at(z, hidden)
        if e.radius < SMALL:  # or it may be the end of a line that was drawn over
            like &= clear
        if like.any() and not _in_place(e, lines, ink, words, least):
            by = complex(z[like][far[like].argmin()]) - e.centre
            out.append(Trace(e, "beside", by, deviation=abs(by), at=np.asarray(e.points + by)))
    return out


def _alone(seen: Any, box: Any) -> bool:
    """Whether there is no other ink about a spot: a letter has more strokes than one."""
    x, y, w, h, area = (int(n) for n in box)
    by = round(ALONE * SCALE)
    return int(seen[max(y - by, 0) : y + h + by, max(x - by, 0) : x + w + by].sum()) <= 1.1 * area


def _in_place(e: Element, lines: Any, ink: Any, words: Any, least: float) -> bool:
    """Whether a dot is clearly seen in its place, or a little beside; a small one also where lines would show as much."""
    grid = np.arange(-REACH, REACH + 0.5 / SCALE, 1 / SCALE)
    places = e.centre + grid - 1j * grid[:, None]
    p = pixels(places)
    drawn, y, seen = _soft(sample(lines, p)), sample(ink, p).astype(np.float64), sample(words, p) == 0
    plain = np.stack((drawn[seen], np.ones(seen.sum())), -1)
    line, told = sample(lines, p) > 127, e.radius >= SMALL
    for by in (grid + 1j * grid[:, None])[np.hypot(grid, grid[:, None]) <= ASIDE]:
        disc = 255.0 * (np.abs(places - e.centre - by) <= e.radius)
        dot = _soft(np.where(line, 0.0, disc))[seen]
        rest = dot - plain @ np.linalg.lstsq(plain, dot, rcond=None)[0]
        if rest @ rest > TELLS * float((_soft(disc) ** 2).sum()):
            told = True
            if float(rest @ y[seen] / (rest @ rest)) > least:
                return True
    return not told


def _soft(picture: Any) -> Floats:
    import cv2

    return np.asarray(cv2.GaussianBlur(picture.astype(np.float32) / np.float32(255), (0, 0), BLUR * SCALE), np.float64)
