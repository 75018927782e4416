"""Ink that belongs to no known element.

Regions of it, and strokes of which the lines that cross them have left pieces in a row.
"""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.profiles import SCALE, pixels, sample
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER
from tmm_sheets.compare.photo.traces import ExtraInk

EXTRA = 8.0  # mm, least extent of ink that is reported
LEAST_WIDTH = 0.15  # mm: a line of that extent and width is the least amount of ink that is reported
INSET = 2.0  # mm inside the frame within which ink counts
COARSE = 3  # pixels to one of the coarse picture
JOIN = 3  # coarse pixels; smaller gaps within a region are closed
POINTS, ALONG = 300, 12  # most points of a region, and points of each piece of a stroke, that are told


CREASE, PIECES, SPAN = 2.0, 3, 200.0
"""mm that a piece of a crease is wide, and off the others, at most; least number of pieces and least distance of the outermost."""
STRAIGHT = 0.4
"""mm; standard deviation across a stroke that is straight: no hand writes a letter as long as what is reported and as straight."""


FOLD, FAINTER, EVERY = 0.25, 3.0, 8
"""Least darkness of a crease, as a share of ink's, on three quarters of its length, how much darker than that ink on it is, and the
distance of the pixels that are looked at."""


RIM, ALL = 0.8, 0.8
"""mm to a side within which something was wiped out along a strip one coarse pixel wide, and the least share of the strip, for it
to be the rim of that: a line is wider."""


SHORT, WIDE = 2.0, 0.9
"""Least length and largest width of a piece of a stroke, mm."""
RAGGED = 0.4
"""mm by which a piece may end before the line that crosses."""
IN_ROW, FARTHEST, CROSSED, INK = 0.5, 8.0, 0.8, 5.0
"""mm that pieces of a stroke may be out of line, mm from one to the next, least share of that way that was wiped out, and least
length of all pieces together, mm."""


def extra_ink(left: Any, level: float, words: Any, wiped: Any = None, dark: float = 0.0) -> list[ExtraInk]:
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
        Where it was wiped out, 255 there; without it no strokes are put together.
    dark
        Least darkness of such a stroke: what was rubbed out is paler.
    """
    free = np.where(words > 0, np.uint8(0), left)
    out = _regions(free, level, straight=False)
    for x in _regions(left, level, straight=True):
        if all(not _in_common(x, y) for y in out):
            out.append(x)
    smooth = _without_creases(out)
    creases = [x for x in out if x not in smooth]
    if wiped is not None:
        smooth = [x for x in smooth if not _rim(x, wiped)]
    for x in [] if wiped is None else _strokes(left, wiped, words, max(level, dark)):
        crease = min(x.width, x.height) <= CREASE and (x.length > SPAN or any(_in_common(x, y) for y in creases))
        if not crease and all(_in_common(x, y) <= 0.5 * x.length for y in smooth):
            smooth.append(x)
    return sorted(smooth, key=lambda q: -q.length)


def without_creases(left: Any, ink: Any, level: float) -> Any:
    """What is left of a rectified sheet without creases that run upright or level from side to side of it.

    They are as wide as a pencil's line and paler, and unlike any line of a drawing they show over the whole of the sheet.
    """
    out = left
    corners = np.array([complex(FRAME.x0 + INSET, FRAME.y1 - INSET), complex(FRAME.x1 - INSET, FRAME.y0 + INSET)])
    (x0, y0), (x1, y1) = ((round(z.real), round(z.imag)) for z in pixels(corners))
    for upright in (True, False):
        sheet = ink[y0:y1:EVERY] if upright else ink[:, x0:x1:EVERY]
        usual = np.percentile(sheet, 25, axis=0 if upright else 1)
        first, end = (x0, x1) if upright else (y0, y1)
        at = first + np.flatnonzero(usual[first:end] > FOLD * level)
        if len(at):
            out = left.copy() if out is left else out
            strip = out[:, at] if upright else out[at].T
            strip = np.where(strip < FAINTER * usual[at], 0, strip)
            if upright:
                out[:, at] = strip
            else:
                out[at] = strip.T
    return out


def _rim(x: ExtraInk, wiped: Any) -> bool:
    """Whether ink is no more than the rim of a level or upright line that was wiped out beside it."""
    if min(x.width, x.height) > COARSE / SCALE + 1e-9:
        return False
    aside = RIM * (1j if x.height < x.width else 1)
    beside = [sample(wiped, pixels(x.points + by), nearest=True) > 0 for by in (aside / 2, aside, -aside / 2, -aside)]
    return bool(np.maximum(np.logical_or(*beside[:2]).mean(), np.logical_or(*beside[2:]).mean()) >= ALL)


def _in_common(x: ExtraInk, y: ExtraInk) -> float:
    """Diagonal of the rectangle that two regions have in common, mm."""
    w = (x.width + y.width) / 2 - abs(x.middle.real - y.middle.real)
    h = (x.height + y.height) / 2 - abs(x.middle.imag - y.middle.imag)
    return hypot(min(w, x.width, y.width), min(h, x.height, y.height)) if min(w, h) > 0 else 0.0


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
        middle = complex((middles[i][0] + 0.5) / scale, PAPER.y1 - (middles[i][1] + 0.5) / scale)
        left, top, wide, high = (int(n) for n in stats[i, :4])
        box = slice(top, top + high), slice(left, left + wide)
        row, column = np.nonzero((labels[box] == i) & (amount[box] > 0))
        points = (column + left + 0.5) / scale + 1j * (PAPER.y1 - (row + top + 0.5) / scale)
        out.append(ExtraInk(middle, w, h, hypot(w, h), points[:: len(points) // POINTS + 1]))
    return out


def _strokes(left: Any, wiped: Any, words: Any, level: float) -> list[ExtraInk]:
    """Strokes in pieces, each shorter than a region that is reported, that are not all edges of letters."""
    import cv2

    scale = SCALE / COARSE
    dark = cv2.resize((left > level).astype(np.uint8) * np.uint8(COARSE**2), None, fx=1 / COARSE, fy=1 / COARSE,
                      interpolation=cv2.INTER_AREA)  # fmt: skip
    _, labels, stats, _ = cv2.connectedComponentsWithStats((dark > COARSE).astype(np.uint8), connectivity=8)
    ends = []
    for i in range(1, len(stats)):
        x, y, w, h = (int(n) for n in stats[i, :4])
        if not SHORT * scale <= hypot(w, h) < 3 * EXTRA * scale:
            continue
        row, column = np.nonzero(labels[y : y + h, x : x + w] == i)
        z = (column + x + 0.5) / scale + 1j * (PAPER.y1 - (row + y + 0.5) / scale)
        middle = z.mean()
        _, way = np.linalg.eigh(np.cov((z - middle).real, (z - middle).imag))
        u = complex(way[0, 1], way[1, 1])
        along, across = ((z - middle) * np.conj(u)).real, ((z - middle) * np.conj(u)).imag
        if np.ptp(along) >= SHORT and np.ptp(across) <= WIDE and _inside(middle):
            ends.append((middle + along.min() * u, middle + along.max() * u))
    groups = _in_rows(np.array(ends, complex).reshape(-1, 2), wiped)
    out = []
    for z in groups:
        width, height = np.ptp(z.real), np.ptp(z.imag)
        free = sample(words, pixels((z[::2] + z[1::2]) / 2), nearest=True) == 0
        if hypot(width, height) >= EXTRA and np.abs(z[1::2] - z[::2]).sum() >= INK and free.any():
            middle = complex((z.real.min() + z.real.max()) / 2, (z.imag.min() + z.imag.max()) / 2)
            points = np.concatenate([np.linspace(a, b, ALONG) for a, b in z.reshape(-1, 2)])
            out.append(ExtraInk(middle, float(width), float(height), hypot(width, height), points))
    return out


def _inside(z: complex) -> bool:
    return FRAME.x0 + INSET < z.real < FRAME.x1 - INSET and FRAME.y0 + INSET < z.imag < FRAME.y1 - INSET


def _in_rows(ends: Any, wiped: Any) -> list[Any]:
    """The ends of pieces that follow one another in a straight row, where only what was wiped out parts them; two or more each."""
    row = list(range(len(ends)))

    def first(k: int) -> int:
        while row[k] != k:
            k = row[k]
        return k

    near = np.abs(ends.mean(1)[:, None] - ends.mean(1)) < 2 * EXTRA
    for i, j in np.argwhere(np.triu(near, 1)):
        both = np.concatenate((ends[i], ends[j]))
        u = both[np.abs(both - both[0]).argmax()] - both[0]
        u = u / abs(u)
        along, across = ((both - both[0]) * np.conj(u)).real, ((both - both[0]) * np.conj(u)).imag
        if np.ptp(across) > IN_ROW:
            continue
        order = np.argsort(along)
        a, b = both[order[1]], both[order[2]]
        if {int(k) // 2 for k in order[:2]} not in ({0}, {1}) or abs(b - a) > FARTHEST:
            continue
        way = (b - a) / max(abs(b - a), 1e-9)
        between = np.linspace(a + RAGGED * way, b - RAGGED * way, 25)
        if abs(b - a) <= 2 * RAGGED or (sample(wiped, pixels(between), nearest=True) > 0).mean() >= CROSSED:
            row[first(int(j))] = first(int(i))
    groups: dict[int, list[Any]] = {}
    for k in range(len(ends)):
        groups.setdefault(first(k), []).append(ends[k])
    return [np.concatenate(g) for g in groups.values() if len(g) > 1]


def _across(labels: Any, box: Any, label: int) -> float:
    """Standard deviation of a region across its longer direction, coarse pixels."""
    x, y, w, h = (int(n) for n in box[:4])
    rows, columns = np.nonzero(labels[y : y + h, x : x + w] == label)
    return float(np.sqrt(max(np.linalg.eigvalsh(np.cov(rows, columns))[0], 0.0)))
