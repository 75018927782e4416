"""Which parts of a photographed sheet are hidden: outside the picture, under a thumb or a dog-ear, behind the edge of something.

A place is hidden when its ground is not the paper's or the lines that belong there are not there, and that goes on to the frame:
what hides a sheet reaches into it from outside. A shadow is no such thing (the lines are there), nor is a line that was left out.
The back of a dog-ear is white paper too: it lies where the corner that is gone would be mirrored in the crease.
Where a flash or a lamp's reflection has washed out the paper, lines that are not seen are hidden too.
What covers the frame may be as white as the paper, and have an edge like a line: where the frame is not seen, nothing is up to the
first line that is.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.elements import Element, sampled
from tmm_sheets.compare.photo.profiles import ProfileLines, fit_freely, peaks, profiles
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, Floats, Map
from tmm_sheets.drawing.marks import Points

Mask = npt.NDArray[np.bool_]

WIDEST = 15
"""mm; lines and lettering are narrower than this."""
FOREIGN = 0.16
"""Change of the ground's brightness against that of the paper nearby, as a share, from which on it may be something else."""
CELL = 10
"""mm; side of the cells in which lines are counted."""
BARE, LEAST = 0.75, 5
"""Least share of the points of lines about a cell that must be bare for it to be hidden, and least number of them."""
SEEN = 0.5
"""Share of points of lines in place from which on a darker or lighter ground hides nothing."""
GLARE, PAPER_GREY = 252, 240
"""Grey from which on the ground is washed out by a flash, where the paper as a whole is darker than the second number."""
GLOW = 0.08
"""Share by which a reflection makes the paper brighter than it is about there, from which on it may wash out lines."""
LOST = 0.12
"""Share of the points of lines under a reflection that must not be seen for it to hide all of them; of others 0.04 are not seen."""
RIM = 5  # mm about the frame that what hides a sheet reaches
MARGIN, EDGE = 5, 3
"""mm by which hidden places are widened, for edges cast shadows; and by which the back of a dog-ear is."""
INSIDE, LEG, GONE = 2, (20, 150), 0.9
"""mm inside an edge of the paper where it is seen how much of a corner is gone, the least and most of that, and least share of the
corner that is gone with it."""
PALE, COVERED = 0.4, 6
"""Darkness of the frame, as a share of the usual, below which it is not seen, and mm in a row of that by which it is covered."""
ASIDE, DEEPEST, MARGIN_OUT = 8.0, 30.0, 20.0
"""How near beside a place of a covered frame a line tells that the cover ends there, how far a cover is believed to reach inwards
at most where none tells, and how far out the paper goes on, mm."""
OFFSETS = np.arange(-1.5, 1.55, 0.1)


def hidden_places(grey: Any, m: Map, ink: Any, lines: ProfileLines, sides: ProfileLines, level: float) -> Mask:
    """Where the sheet is hidden, a pixel for each square millimetre, the upper row first.

    Parameters
    ----------
    grey, m
        The picture and its map.
    ink, level
        The rectified sheet and the darkness of a line.
    lines, sides
        Points of the drawing's lines and of the frame.
    """
    shape = (round(PAPER.height), round(PAPER.width))
    p, n = np.concatenate((lines.points, sides.points)), np.concatenate((lines.normals, sides.normals))
    all_lines = ProfileLines(p, n, np.zeros(len(p), np.int64))
    o, strength = peaks(profiles(ink, all_lines, OFFSETS), OFFSETS, 0.0, 1.0, 0.4)
    there = (strength > level) & (np.abs(o) < 0.7)
    row = np.clip((PAPER.y1 - all_lines.points.imag).astype(int), 0, shape[0] - 1)
    column = np.clip(all_lines.points.real.astype(int), 0, shape[1] - 1)
    ground, outside = ground_of(grey, m, shape)
    share = _brightness(ground, ~outside)
    foreign = (np.abs(share - 1) > FOREIGN) & ~outside
    absent = _absent(row, column, there, shape)
    out = outside.copy()

    def counted(mask: Mask) -> tuple[Any, Any, Any]:
        """Labels of connected regions, and how many points of lines each has, and how many are there."""
        count, labels = cv2.connectedComponents(mask.astype(np.uint8), connectivity=8)
        label = labels[row, column]
        return labels, np.bincount(label, minlength=count), np.bincount(label, there, minlength=count)

    # The margin outside the frame is often in the shade of its own edge: only what reaches inside matters.
    labels, total, seen = counted((foreign | absent) & ~outside)
    low, high = ((round(z.real), round(PAPER.y1 - z.imag)) for z in FRAME.corners[[0, 2]].tolist())
    rim = cv2.rectangle(np.zeros(shape, np.uint8), low, high, 1, RIM) > 0
    covers = np.isin(np.arange(len(total)), labels[rim]) & (total >= LEAST) & (seen < SEEN * total)
    out |= covers[labels] & (labels > 0)
    # What still shows of a reflection that took many lines is too uneven to be judged.
    labels, total, seen = counted(share > 1 + GLOW)
    lost = total - seen
    out |= ((lost >= LEAST) & (lost > LOST * total))[labels] & (labels > 0)
    if np.median(ground) < PAPER_GREY:
        single = ~there & (ground[row, column] >= GLARE)
        out[row[single], column[single]] = True
    out |= _under_covers(ink, lines.points[there[: len(lines.points)]], level, shape)
    if not out.any():
        return out
    out = widened(out)
    for flap in _flaps(out & ~outside):
        there_ = there[flap[row, column]]
        if there_.sum() <= SEEN * len(there_):
            out |= widened(flap, EDGE)
    return out


def widened(hidden: Mask, by: int = MARGIN) -> Mask:
    """Hidden places with what is so near them, mm, that it may be hidden too."""
    return cv2.dilate(hidden.astype(np.uint8), np.ones((2 * by + 1, 2 * by + 1), np.uint8)) > 0


def share_hidden(e: Element, hidden: Mask) -> float:
    """Share of an element that is hidden."""
    p = e.points if e.kind == "text" or len(e.points) < 2 else sampled(e.points, 1.0)[0]
    if e.kind == "text":
        p = np.append(p, p.mean())
    return float(at(p, hidden).mean())


def at(p: Any, hidden: Mask) -> Any:
    """Whether points of the sheet, mm, are hidden."""
    rows, columns = hidden.shape
    i = np.clip((PAPER.y1 - np.imag(p)).astype(int), 0, rows - 1)
    return hidden[i, np.clip(np.real(p).astype(int), 0, columns - 1)]


def _under_covers(ink: Any, seen: Points, level: float, shape: tuple[int, int]) -> Mask:
    """Where the frame is not seen, from the edge of the paper as far as the first line that is: what covers it may be paper too.

    ``seen`` are points of the lines inside that are in their places.
    """
    out = np.zeros(shape, bool)
    # The same way round for every side: along it, inwards.
    ways = [(FRAME.x0 + FRAME.y0 * 1j, 1 + 0j, 1j, FRAME.width), (FRAME.x1 + FRAME.y0 * 1j, 1j, -1 + 0j, FRAME.height),
            (FRAME.x0 + FRAME.y1 * 1j, 1 + 0j, -1j, FRAME.width), (FRAME.x0 + FRAME.y0 * 1j, 1j, 1 + 0j, FRAME.height)]
    places = [np.asarray(begin + along * (np.arange(int(length)) + 0.5), np.complex128) for begin, along, _, length in ways]
    dark = [profiles(ink, ProfileLines(p, np.full(len(p), inwards), np.zeros(0, np.int64)), OFFSETS).max(1)
            for p, (_, _, inwards, _) in zip(places, ways, strict=True)]
    inked = np.concatenate(dark)
    if (inked > level).mean() < 0.5:  # a sheet without a frame
        return out
    bare = max(level, PALE * float(np.median(inked[inked > level])))
    for strength, (begin, along, inwards, _) in zip(dark, ways, strict=True):
        unseen = _long(strength < bare)
        if not unseen.any():
            continue
        where = seen - begin
        run, deep = (where * np.conj(along)).real, (where * np.conj(inwards)).real
        inside = (deep > OFFSETS[-1]) & (deep < DEEPEST)
        for k in np.flatnonzero(unseen):
            near = deep[inside & (np.abs(run - k - 0.5) < ASIDE)]
            to = begin + along * (k + 0.5) + inwards * np.arange(-MARGIN_OUT, near.min(initial=DEEPEST))
            row, column = (PAPER.y1 - to.imag).astype(int), to.real.astype(int)
            valid = (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
            out[row[valid], column[valid]] = True
    return out


def _long(some: Any) -> Any:
    """Those in runs of at least :data:`COVERED`."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], some.astype(np.int8), [0]))))
    out = np.zeros(len(some), bool)
    for a, b in zip(edges[::2], edges[1::2], strict=True):
        out[a:b] = b - a >= COVERED
    return out


def _flaps(hidden: Mask) -> Iterator[Mask]:
    """Where the backs of dog-ears may lie: a corner that is gone along a straight crease lies mirrored in it on the sheet."""
    for upside, mirrored in ((u, m) for u in (1, -1) for m in (1, -1)):
        corner = hidden[::upside, ::mirrored]
        # How far it is gone along both edges of the paper, a little inside.
        a, b = (int(edge.argmin()) if not edge.all() else 0 for edge in (corner[:, INSIDE], corner[INSIDE, :]))
        if not (LEG[0] <= min(a, b) and max(a, b) <= LEG[1]):
            continue
        row, column = np.mgrid[:a, :b]
        if corner[:a, :b][row / a + column / b < 1 - 2 * MARGIN / min(a, b)].mean() < GONE:
            continue
        tip = (2 * a * a * b / (a * a + b * b), 2 * a * b * b / (a * a + b * b))
        flap = np.zeros(hidden.shape, np.uint8)
        cv2.fillPoly(flap, [np.rint([(0, a), (b, 0), tip]).astype(np.int32)], 1)
        yield flap[::upside, ::mirrored] > 0


def ground_of(grey: Any, m: Map, shape: tuple[int, int]) -> tuple[Any, Mask]:
    """Brightness of what lies under the lines, and what is outside the picture."""
    # Every eighth place and one more on all sides: between these the resizing has its pixels.
    step = 8
    rows, columns = (step * (np.arange(-1, -(-n // step) + 1) + 0.5) for n in shape)
    x, y = np.meshgrid(columns, PAPER.y1 - rows)
    q = m.to_picture(x + 1j * y)
    u, v = (cv2.resize(part.astype(np.float32), (q.shape[1] * step, q.shape[0] * step), interpolation=cv2.INTER_LINEAR)
            [step : step + shape[0], step : step + shape[1]] for part in (q.real, q.imag))  # fmt: skip
    scale = abs(complex(q[len(q) // 2, -1] - q[len(q) // 2, 0])) / (columns[-1] - columns[0])
    f = float(min(1.0 / max(scale, 1e-6), 1.0))
    small = cv2.resize(grey, None, fx=f, fy=f, interpolation=cv2.INTER_AREA)
    seen = cv2.remap(small, u * f, v * f, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    outside = (u < 0) | (v < 0) | (u > grey.shape[1] - 1) | (v > grey.shape[0] - 1)
    return cv2.morphologyEx(cv2.medianBlur(seen, 3), cv2.MORPH_CLOSE, np.ones((WIDEST, WIDEST), np.uint8)), outside


def _brightness(ground: Any, valid: Mask) -> Floats:
    """Brightness of the ground as a share of the paper's about there, a polynomial fitted robustly at a sixth of the resolution."""
    small = cv2.resize(ground, None, fx=1 / 6, fy=1 / 6, interpolation=cv2.INTER_AREA)
    use = cv2.resize(valid.astype(np.float64), small.shape[::-1], interpolation=cv2.INTER_AREA).ravel()
    y, x = (t.ravel() for t in np.mgrid[-1 : 1 : small.shape[0] * 1j, -1 : 1 : small.shape[1] * 1j])
    base = np.stack([x**i * y**j for i in range(5) for j in range(5 - i)], -1)
    log = np.log(np.maximum(small.astype(np.float64), 1)).ravel()
    paper = np.exp(base @ fit_freely(base, log, use, 0.08)).reshape(small.shape).astype(np.float32)
    return np.asarray(ground / cv2.resize(paper, ground.shape[::-1], interpolation=cv2.INTER_LINEAR))


def _absent(row: Any, column: Any, there: Any, shape: tuple[int, int]) -> Mask:
    """Where lines are not, though several belong there."""
    rows, columns = -(-shape[0] // CELL), -(-shape[1] // CELL)
    cell = row // CELL * columns + column // CELL
    total, seen = (np.bincount(cell, some, minlength=rows * columns).reshape(rows, columns).astype(np.float32)
                   for some in (np.ones(len(cell)), there))  # fmt: skip
    about, met = (9 * cv2.blur(part, (3, 3), borderType=cv2.BORDER_CONSTANT) for part in (total, seen))
    bare = (about >= LEAST) & (met <= (1 - BARE) * about)
    return np.asarray(np.kron(bare, np.ones((CELL, CELL), bool))[: shape[0], : shape[1]])
