"""Dots that stand beside their places.

A dot is too small to be measured among lines, but one in a wrong place is a round spot that belongs to nothing, and its own place
has none: about it the picture is taken for lines and a dot, each as dark as fits best. A spot alone is no displaced dot where the
dot is seen in its place; where lines cross, a small one shows no more than they do, and the spot is taken for it. A large dot is
known even upon a letter: it is wider than any stroke. Of several dots that may be meant it is the one whose line leads to the spot.
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
from tmm_sheets.drawing.marks import Points

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
ALONE, ROOM = 0.9, 2.5
"""mm about a spot without other ink; mm beyond the farthest spot that are looked at."""
FAINT, DARK, SMALL_DARK, SMALL = 0.3, 0.6, 0.35, 0.45
"""Darkness from which on a place belongs to a spot, and least darkness of a spot and of a dot in its place, as shares of the
lines'; the same of dots of less than the radius, mm, which blur makes pale."""
TOUCHED = 9
"""Pixels about the middle of a small spot that nothing else may take, unless it lies beside a line."""
FALLS = 0.75
"""Share of its darkness below which ink falls on all sides of a spot within :data:`ALONE` mm."""
PAST, WIDE = 1.8, 1.2
"""mm about a spot within which a line that runs past takes an angle, rad, as none does that ends there."""
COVERED = 0.3
"""Share of a small dot under lines from which on its place, where they cross, is dark with it or without."""
TELLS = 0.15
"""Least share of a dot that lines do not show as well for anything to be told of its place."""
LARGE, THICK, RIM, CORE = 0.65, 0.6, 0.1, 1.05
"""Radius, mm, from which on a dot is wider than where strokes of a letter meet; its least darkness all over, as a share of the
lines', mm about its edge that are paler, and darkness of its middle: blur makes lines paler than it, and letters that run together.
"""
LEADS, TOWARDS = 0.95, 0.4
"""Least share with ink of what a line has to a spot, and share of its way from which on that is no other's than its own."""
RAYS = np.exp(2j * np.pi * np.arange(16) / 16) * np.linspace(0, ALONE, 6)[:, None]  # places about a spot, mm


def displaced_dots(
    some: Sequence[Element], rods: Sequence[Points], lines: Any, taken: Any, ink: Any, words: Any, hidden: Mask, usual: float,
) -> list[Trace]:
    """Traces of dots that stand beside their places.

    Parameters
    ----------
    some
        The dots.
    rods
        Both ends of the straight lines that belong on the sheet.
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
    found: list[tuple[Element, complex, bool, bool | None]] = []
    begins, ends = np.array([(z, w) for a, b in rods for z, w in ((a, b), (b, a))], complex).reshape(-1, 2).T
    for e in some:
        least = usual * (SMALL_DARK if e.radius < SMALL else DARK)
        spots = _spots(e, lines, taken, ink, words, FAINT * usual, least)
        # Where letters stand in its own place, it may be among them.
        if e.radius >= LARGE and not len(spots) and not sample(words, pixels(e.points)).any():
            spots = _thick(e, taken, ink, usual)
        spots = spots[~at(spots, hidden)]
        if len(spots) and not (there := _in_place(e, lines, ink, words, least)):
            spot = complex(spots[np.abs(spots - e.centre).argmin()])
            its = begins[np.abs(ends - e.centre) <= ASIDE]
            found.append((e, spot, any(_leads(z, spot, e.radius, ink, FAINT * usual) for z in its), there))
    out: dict[complex, Trace] = {}
    # A spot is one dot's: first of one whose line leads there, then of those that are surely not in their places, of the nearest.
    for e, spot, _, _ in sorted(found, key=lambda f: (not f[2], f[3] is None, abs(f[1] - f[0].centre))):
        by = spot - e.centre
        out.setdefault(spot, Trace(e, "beside", by, deviation=abs(by), at=np.asarray(e.points + by)))
    return list(out.values())


def _spots(e: Element, lines: Any, taken: Any, ink: Any, words: Any, faint: float, least: float) -> Points:
    """Middles of spots about a dot's place that may be this dot: from ``faint`` on they are seen, ``least`` dark in the middle."""
    import cv2

    middle, half = complex(pixels(np.array([e.centre]))[0]), round((FAR + ROOM) * SCALE)
    top, left = max(round(middle.imag) - half, 0), max(round(middle.real) - half, 0)
    here = (slice(top, round(middle.imag) + half), slice(left, round(middle.real) + half))
    free = (np.maximum(taken[here], words[here]) == 0).astype(np.uint8)
    seen = (ink[here] > faint).astype(np.uint8) & free
    # The end of a line that was drawn over is no small dot.
    clear = cv2.erode(free, np.ones((TOUCHED, TOUCHED), np.uint8)) > 0
    _, labels, stats, middles = cv2.connectedComponentsWithStats(seen, connectivity=8)
    size, out = np.pi * e.radius**2 * SCALE**2, []
    for k in range(1, len(stats)):
        w, h, area = (int(n) for n in stats[k, 2:])
        z = complex((left + middles[k, 0] + 0.5) / SCALE, PAPER.y1 - (top + middles[k, 1] + 0.5) / SCALE)
        round_ = max(w, h) <= min(ROUND * min(w, h), (2 * e.radius + WIDER) * SCALE) and area > FULL * w * h
        if (round_ and SIZES[0] * size < area < SIZES[1] * size and max(LEAST, e.radius + ASIDE) < abs(z - e.centre) < FAR
                and int(ink[here][labels == k].max()) > least and _alone(seen, stats[k])
                and (e.radius >= SMALL or clear[round(middles[k, 1]), round(middles[k, 0])] or _aside(z, lines, ink))):  # fmt: skip
            out.append(z)
    return np.array(out, complex)


def _thick(e: Element, taken: Any, ink: Any, usual: float) -> Points:
    """The middle of the darkest place about a large dot's that is as wide as it is, on paper or on letters; none where none is."""
    import cv2

    middle, half = complex(pixels(np.array([e.centre]))[0]), round((FAR + ROOM) * SCALE)
    top, left = max(round(middle.imag) - half, 0), max(round(middle.real) - half, 0)
    here = (slice(top, round(middle.imag) + half), slice(left, round(middle.real) + half))
    side = np.arange(-int(e.radius * SCALE), int(e.radius * SCALE) + 1)
    disc = (np.hypot(side, side[:, None]) <= (e.radius - RIM) * SCALE).astype(np.uint8)
    all_over = np.where(taken[here] == 0, cv2.erode(ink[here], disc), 0)
    row, column = np.mgrid[: all_over.shape[0], : all_over.shape[1]]
    z = (left + column + 0.5) / SCALE + 1j * (PAPER.y1 - (top + row + 0.5) / SCALE)
    away = np.abs(z - e.centre)
    all_over[(away <= max(LEAST, e.radius + ASIDE)) | (away >= FAR)] = 0
    there = all_over > max(THICK * usual, 0.9 * float(all_over.max()))
    found = np.array([z[there].mean()] if there.any() else [], complex)
    return np.asarray(found[sample(ink, pixels(found)) > CORE * usual])


def _leads(begin: complex, spot: complex, radius: float, ink: Any, faint: float) -> bool:
    """Whether there is ink all the way from the beginning of a line to a spot, where that is not the way to its own end."""
    length = abs(spot - begin)
    share = np.arange(TOWARDS * length, length - radius, 1 / SCALE) / max(length, radius)
    across = 1j * (spot - begin) / max(length, radius) * np.array([-0.2, 0.0, 0.2])
    dark = sample(ink, pixels(begin + share[:, None] * (spot - begin) + across)).max(1) > faint
    return bool(len(dark) and dark.mean() >= LEADS)


def _aside(z: complex, lines: Any, ink: Any) -> bool:
    """Whether a spot lies beside a line, no end of one drawn over: ink is paler on all its sides, and the line runs past it."""
    around = sample(ink, pixels(z + RAYS))
    side = np.arange(-PAST, PAST + 0.5 / SCALE, 1 / SCALE)
    about = (side - 1j * side[:, None])[np.hypot(side, side[:, None]) <= PAST]
    near = about[sample(lines, pixels(z + about), nearest=True) > 127]
    angle = np.ptp(np.angle(near / near.mean())) if len(near) else 0.0
    return bool((around.min(0) < FALLS * around[:2].max()).all() and angle > WIDE)


def _alone(seen: Any, box: Any) -> bool:
    """Whether there is no other ink about a spot: a letter has more strokes than one."""
    x, y, w, h, area = (int(n) for n in box)
    by = round(ALONE * SCALE)
    return int(seen[max(y - by, 0) : y + h + by, max(x - by, 0) : x + w + by].sum()) <= 1.1 * area


def _in_place(e: Element, lines: Any, ink: Any, words: Any, least: float) -> bool | None:
    """Whether a dot is clearly seen in its place, or a little beside; None of a small one where lines would show as much."""
    grid = np.arange(-REACH, REACH + 0.5 / SCALE, 1 / SCALE)
    places = e.centre + grid - 1j * grid[:, None]
    p = pixels(places)
    drawn, y, seen = _soft(sample(lines, p)), sample(ink, p).astype(np.float64), sample(words, p) == 0
    plain = np.stack((drawn[seen], np.ones(seen.sum())), -1)
    line = sample(lines, p) > 127
    if e.radius < SMALL and line[np.abs(places - e.centre) <= e.radius].mean() > COVERED:
        return None
    told = e.radius >= SMALL
    for by in (grid + 1j * grid[:, None])[np.hypot(grid, grid[:, None]) <= ASIDE]:
        disc = 255.0 * (np.abs(places - e.centre - by) <= e.radius)
        dot = _soft(np.where(line, 0.0, disc))[seen]
        rest = dot - plain @ np.linalg.lstsq(plain, dot, rcond=None)[0]
        if rest @ rest > TELLS * float((_soft(disc) ** 2).sum()):
            told = True
            if float(rest @ y[seen] / (rest @ rest)) > least:
                return True
    return False if told else None


def _soft(picture: Any) -> Floats:
    import cv2

    return np.asarray(cv2.GaussianBlur(picture.astype(np.float32) / np.float32(255), (0, 0), BLUR * SCALE), np.float64)
