"""What a picture loses of a drawing: what that may be the reason of is no mistake.

- Lines in pieces, as a telephone's black-and-white mode leaves thin ones. A line left out has bare paper all along its place, while
  others as thin as it are whole. Where many of those are in pieces, one that is gone altogether may be the picture's doing, and so
  may one of which half is there.
- Pictures without grey: of few pixels they eat thin lines and small letters. Where they are in pieces all over the sheet, what
  is short, broken or gone of a thin line or of letters says nothing of the drawing. Where they are whole, their ends and parts of
  letters may be eaten still, unless there are many pixels. What stands in a wrong place is a mistake always, and so is what is gone
  of thick lines.
- Paper that a flash has washed out, and the edges of deep shadows: letters are lost before lines. Lines that are not
  seen on such paper are hidden.
- What is hidden: outside the picture, under a thumb or a dog-ear, behind the edge of something.

A place is hidden when its ground is not the paper's or the lines that belong there are not there, and that goes on to the frame:
what hides a sheet reaches into it from outside. A shadow is no such thing (the lines are there), nor is a line that was left out.
The back of a dog-ear is white paper too: it lies where the corner that is gone would be mirrored in the crease.
Where a flash or a lamp's reflection has washed out the paper, lines that are not seen are hidden too.
What covers the frame may be as white as the paper, and have an edge like a line: where the frame is not seen, nothing is up to the
first line that is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any, Literal

import cv2
import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import SAMPLED, Element, grouped, sampled
from tmm_sheets.compare.photo.profiles import (
    HALF,
    LITTLE,
    NEARLY_ALL,
    NOTHING,
    WHOLE,
    ProfileLines,
    fit_freely,
    peaks,
    profiles,
    runs,
)
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, Floats, Map
from tmm_sheets.compare.photo.traces import InkTrace, expected_ink
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

Mask = npt.NDArray[np.bool_]

WIDEST = 15
"""mm; lines and lettering are narrower than this."""
FOREIGN = 0.16
"""Change of the ground's brightness against that of the paper nearby, as a share, from which on it may be something else."""
CELL = 10
"""mm; side of the cells in which lines are counted."""
BARE, LEAST = 0.75, 5
"""Least share of the points of lines about a cell that must be bare for it to be hidden, and least number of them."""
GLARE, PAPER_GREY = 252, 240
"""Grey from which on the ground is washed out by a flash, where the paper as a whole is darker than the second number."""
GLOW = 0.08
"""Share by which a reflection makes the paper brighter than it is about there, from which on it may wash out lines."""
LOST = 0.12
"""Share of the points of lines under a reflection that must not be seen for it to hide all of them; of others 0.04 are not seen."""
MARGIN, EDGE = 5, 3
"""mm by which hidden places are widened, for edges cast shadows, and about the frame that what hides a sheet reaches; and by which
the back of a dog-ear is."""
INSIDE, LEG = 2, (20, 150)
"""mm inside an edge of the paper where it is seen how much of a corner is gone, and the least and most of that."""
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
    rim = cv2.rectangle(np.zeros(shape, np.uint8), low, high, 1, MARGIN) > 0
    covers = np.isin(np.arange(len(total)), labels[rim]) & (total >= LEAST) & (seen < HALF * total)
    out |= covers[labels] & (labels > 0)
    # What still shows of a reflection that took many lines is too uneven to be judged.
    labels, total, seen = counted(share > 1 + GLOW)
    lost = total - seen
    out |= ((lost >= LEAST) & (lost > LOST * total))[labels] & (labels > 0)
    if np.median(ground) < PAPER_GREY:
        single = ~there & (ground[row, column] >= GLARE)
        out[row[single], column[single]] = True
    out |= under_covers(ink, lines.points[there[: len(lines.points)]], level, shape)
    out = widened(out)
    for flap in flaps(out & ~outside):
        there_ = there[flap[row, column]]
        if there_.sum() <= HALF * len(there_):
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


def under_covers(ink: Any, seen: Points, level: float, shape: tuple[int, int]) -> Mask:
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
        where = seen - begin
        run, deep = (where * np.conj(along)).real, (where * np.conj(inwards)).real
        inside = (deep > OFFSETS[-1]) & (deep < DEEPEST)
        for k in chain.from_iterable(range(a, b) for a, b in runs(strength < bare) if b - a >= COVERED):
            near = deep[inside & (np.abs(run - k - 0.5) < ASIDE)]
            to = begin + along * (k + 0.5) + inwards * np.arange(-MARGIN_OUT, near.min(initial=DEEPEST))
            row, column = (PAPER.y1 - to.imag).astype(int), to.real.astype(int)
            valid = (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
            out[row[valid], column[valid]] = True
    return out


def flaps(hidden: Mask) -> Iterator[Mask]:
    """Where the backs of dog-ears may lie: a corner that is gone along a straight crease lies mirrored in it on the sheet."""
    for upside, mirrored in ((u, m) for u in (1, -1) for m in (1, -1)):
        corner = hidden[::upside, ::mirrored]
        # How far it is gone along both edges of the paper, a little inside.
        a, b = (int(edge.argmin()) if not edge.all() else 0 for edge in (corner[:, INSIDE], corner[INSIDE, :]))
        if not (LEG[0] <= min(a, b) and max(a, b) <= LEG[1]):
            continue
        row, column = np.mgrid[:a, :b]
        if corner[:a, :b][row / a + column / b < 1 - 2 * MARGIN / min(a, b)].mean() < WHOLE:
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


FEW = 4
"""Least number of lines of a width that tell anything."""
HALF_THERE, MOST = 0.4, 0.7
"""Share of a line with ink in its place from which on it was not left out, and by which one must be seen elsewhere to be there."""


def torn_widths(traces: Sequence[InkTrace]) -> set[float]:
    """Widths of the lines that a picture has torn."""
    alone = (t for t in traces if t.status == "measured" and t.darkness and expected_ink(t.element) == 1.0)
    return {width for width, some in grouped(alone, lambda t: line_type(t.element.style).width).items()
            if len(some) >= FEW and np.mean([t.covered < WHOLE for t in some]) >= NOTHING}


def in_pieces(t: InkTrace, torn: set[float]) -> bool:
    """Whether too little is seen for a line to be called missing, or elsewhere, where those of widths ``torn`` are in pieces."""
    tears = line_type(t.element.style).width in torn
    if t.status == "missing":
        return tears or t.covered >= HALF_THERE
    return t.status == "measured" and t.covered < (WHOLE if tears else MOST)


BLACK, WHITE, GREY = 64, 192, 0.25
"""Levels of black and white, and most pixels between them, as a share of the black ones; there are none but for compression."""
FINE = 7.0
"""Pixels per mm from which on thin lines are two pixels wide: those that are whole all over the sheet are not eaten anywhere."""
THIN = 0.3
"""mm; width of lines up to which they are eaten."""
LONG, MANY = 15.0, 0.02
"""mm of a thin line, and share of such lines that are in pieces: a pencil leaves gaps in one of a hundred."""
LARGE = 30.0  # mm of a thin line that is not eaten whole
LETTERS = 3
"""Letters that are not eaten all; of lettering that stands elsewhere one less."""

LostToThreshold = Literal["nothing", "ends", "lines"]
"""What a picture eats of thin lines, and of letters with them."""


def without_grey(grey: Any) -> bool:
    """Whether a picture has black and white only."""
    few = grey[::3, ::3]
    black, white = float((few < BLACK).mean()), float((few > WHITE).mean())
    return black > 0 and 1 - black - white < GREY * black


def lost_to_threshold(grey: Any, traces: Sequence[InkTrace], scale: float) -> LostToThreshold:
    """What a picture of so many pixels per mm eats, by it and by what was found in it."""
    if not without_grey(grey):
        return "nothing"
    return "lines" if eats(traces) else "ends" if scale < FINE else "nothing"


def eats(traces: Sequence[InkTrace]) -> bool:
    """Whether thin lines are in pieces all over the sheet."""
    thin = [t.covered < WHOLE for t in traces if t.status == "measured" and t.element.length > LONG and _thin(t)
            and expected_ink(t.element) == 1.0]  # fmt: skip
    return bool(thin) and float(np.mean(thin)) > MANY


def may_be_lost(t: InkTrace, tolerance: float, some: LostToThreshold) -> bool:
    """Whether what was found of an element, other than its ends, may be the fault of a picture that eats ``some`` of thin lines."""
    if some == "ends":
        small = _thin(t) and t.status == "measured" and tolerance < t.deviation <= 2 * tolerance
        return small or (t.status == "part of lettering" and t.at is None)
    if some == "nothing":
        return False
    if t.status == "part of lettering":
        return True
    if t.status == "absent lettering":
        return sum(map(str.isalnum, t.element.text)) < LETTERS - (t.at is not None)
    if not _thin(t):
        return False
    if t.status == "missing":
        return t.element.length < LARGE or t.covered > NOTHING
    if t.status == "measured":
        return t.deviation > tolerance and (t.covered < NEARLY_ALL or t.deviation <= 2 * tolerance)
    return t.status == "covered"


def whole(t: InkTrace) -> InkTrace:
    """A trace without the ends by which a thin line is too short."""
    begin, end = (np.nan if by < 0 else by for by in t.ends)
    return replace(t, ends=(begin, end)) if _thin(t) else t


def _thin(t: InkTrace) -> bool:
    return t.element.kind != "text" and line_type(t.element.style).width <= THIN


ABOUT = 7  # mm within which a shadow begins whose edge is steep
APART = 50.0
"""mm from which on two places are told of."""
CUT = 1.0
"""mm by which a line seems too short from which on it is asked whether the light has taken the rest."""
LETTERING = ("absent lettering", "part of lettering")


def uneven_places(grey: Any, m: Map) -> Mask:
    """Where the light takes letters away, a pixel for each square millimetre, the upper row first.

    ``grey`` is the picture and ``m`` its map.
    """
    ground, _ = ground_of(grey, m, (round(PAPER.height), round(PAPER.width)))
    about = np.ones((ABOUT, ABOUT), np.uint8)
    edges = cv2.erode(ground, about) < WHOLE * cv2.dilate(ground, about)
    washed_out = (ground >= GLARE) & (np.median(ground) < PAPER_GREY)
    return np.asarray(edges | washed_out)


def mask_washed_out(traces: Sequence[InkTrace], uneven: Mask) -> list[InkTrace]:
    """The traces; what is not seen, or only in part, where the light takes it away is hidden, and so is the end of a line."""
    return [InkTrace(t.element, "hidden") if _doubtful(t) and at(_places(t.element), uneven).mean() >= LITTLE else
            _with_ends_shown(t, uneven) for t in traces]


def _with_ends_shown(t: InkTrace, uneven: Mask) -> InkTrace:
    """A trace; where the light has taken what a line is too short by, its end is unknown."""
    rests = [k for k, by in enumerate(t.ends) if by < -CUT and at(_unseen_places(t, k), uneven).mean() >= LITTLE]
    begin, end = (np.nan if k in rests else by for k, by in enumerate(t.ends))
    return replace(t, ends=(begin, end)) if rests else t


def _unseen_places(t: InkTrace, k: int) -> Points:
    """Places of a line that are not seen at its beginning or its end."""
    line, by = sampled(t.element.points if k == 0 else t.element.points[::-1])[0], -t.ends[k]
    return np.asarray(line[: max(round(by / SAMPLED), 1)])


def taken(before: Sequence[InkTrace], after: Sequence[InkTrace]) -> list[complex]:
    """About where the light took something of the sheet, mm; nothing where it took nothing."""
    places: list[complex] = []
    for middle in (_place_of_loss(s, t) for s, t in zip(before, after, strict=True) if s is not t):
        if all(abs(middle - z) > APART for z in places):
            places.append(middle)
    return places


def _place_of_loss(before: InkTrace, after: InkTrace) -> complex:
    """About where the light took something of an element: all of it, or an end."""
    if after.status == "hidden":
        return after.element.middle
    return complex(after.element.points[0 if np.isfinite(before.ends[0]) and not np.isfinite(after.ends[0]) else -1])


def _doubtful(t: InkTrace) -> bool:
    """Whether of an element too little is seen, and that may be the light's doing."""
    return t.status in LETTERING or (t.status == "missing" and t.pieces)


def _places(e: Element) -> Points:
    """Places of a line, or of the box of lettering."""
    if e.kind != "text":
        return np.asarray(sampled(e.points, 1.0)[0])
    box = Box.around(e.points)
    x, y = np.meshgrid(np.arange(box.x0, box.x1 + 1), np.arange(box.y0, box.y1 + 1))
    return np.asarray((x + 1j * y).ravel())
