"""Where lettering stands that is not in its place.

What it says is not read, so ink of its size that belongs to nothing, within some millimetres, is taken for it: letters on paper of
their own, neither of other lettering nor on lines.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, grown
from tmm_sheets.compare.photo.masking import fill, paint
from tmm_sheets.compare.photo.profiles import SCALE, pixels
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import InkTrace, Status
from tmm_sheets.drawing.marks import Points

MOVED, LEAST = 15.0, 2.5
"""mm from its place within which lettering is looked for, and from which on it is not in its place."""
LIKE, MORE = (0.55, 1.35), (-0.4, 0.8)
"""Its extent there as shares of that of its box, and mm that it may have beside: letters fill their boxes more or less."""
WRITTEN = 0.06
"""Least share of its box with ink, there as in its place."""
ASIDE, EDGE = 0.9, 0.5
"""mm about lines and about other lettering whose ink is theirs."""
APART, WORDS = 0.5, 0.8
"""Paper between the letters of a word, and between words, as a share of their height."""
LONG = 30.0
"""mm of lettering up to which ink beside its middle is not a part of it."""
TOGETHER, ALIKE = 25.0, 1.5
"""mm between lettering that may have been moved together, and mm by which it was not moved quite alike."""


def with_places(traces: Sequence[InkTrace], lines: Iterable[InkTrace], small: Sequence[Element], ink: Any, hidden: Any,
                level: float) -> list[InkTrace]:
    """Traces of lettering, those of what is not in its place with the place where it may stand.

    Parameters
    ----------
    traces
        Of lettering of which not all is surely in its place.
    lines
        What was found of lines.
    small
        All that is not measured, other lettering among it.
    ink
        The rectified picture.
    hidden
        Where the sheet does not show, 255 there, in a picture of the same size.
    level
        Darkness of ink.
    """
    if not traces:
        return []
    taken = hidden.copy()
    for t in lines:
        if t.at is not None:
            paint(taken, t.element, t.at, ASIDE)
    words = [e for e in small if e.kind == "text"]
    for e in small:
        paint(taken, e, e.points, ASIDE)
    lost = {t.element.number for t in traces if t.status == "absent lettering"}
    for e in words:
        if e.number not in lost:
            fill(taken, grown(e.points, EDGE))
    return list(_with_others(traces, [_candidates(t, taken, words, ink, level) for t in traces]))


def _candidates(t: InkTrace, taken: Any, words: Sequence[Element], ink: Any, level: float) -> Points:
    """Where ink of the size of lettering stands near it, the most like it first: how far from its place, mm."""
    import cv2

    e = t.element
    box = Box.around(e.points)
    if t.status == "lettering" and max(box.width, box.height) > LONG:
        return np.zeros(0, complex)
    corner = pixels(np.array([complex(box.x0 - MOVED, box.y1 + MOVED), complex(box.x1 + MOVED, box.y0 - MOVED)]))
    rows, columns = (slice(max(round(a), 0), max(round(b), 0)) for a, b in (corner.imag, corner.real))
    here = ink[rows, columns]
    if not here.size:
        return np.zeros(0, complex)
    free = taken[rows, columns] == 0
    if t.status != "absent lettering":
        own = np.zeros_like(here)
        _fill(own, grown(e.points, EDGE), columns.start, rows.start)
        for other in words:
            if other is not e and abs(other.middle - e.middle) < 2 * MOVED + box.width:
                _fill(own, grown(other.points, EDGE), columns.start, rows.start, 0)
        free |= own > 0
    dark = ((here > level) & free).astype(np.uint8)
    apart = round((WORDS if " " in e.text else APART) * e.height * SCALE) | 1
    joined = cv2.morphologyEx(dark, cv2.MORPH_CLOSE, np.ones((apart, apart), np.uint8))
    _, labels, stats, _ = cv2.connectedComponentsWithStats(joined, connectivity=8)
    area = np.bincount(labels[dark > 0], minlength=len(stats))
    found: list[tuple[float, complex]] = []
    for k in range(1, len(stats)):
        x, y, w, h = (int(n) for n in stats[k, :4])
        size = (w / SCALE, h / SCALE)
        by = complex((columns.start + x + w / 2) / SCALE, PAPER.y1 - (rows.start + y + h / 2) / SCALE) - e.middle
        rest = abs(by.real) + size[0] / 2 <= box.width / 2 + EDGE and abs(by.imag) + size[1] / 2 <= box.height / 2 + EDGE
        if (area[k] >= WRITTEN * box.width * box.height * SCALE**2 and _alike(size, box) and abs(by) <= MOVED
                and not rest):  # what is left of it in its place
            found.append((abs(size[0] - box.width) + abs(size[1] - box.height) + 0.1 * abs(by), by))
    if t.status == "lettering" and any(abs(by) < LEAST for _, by in found):
        return np.zeros(0, complex)
    return np.array([by for _, by in sorted(found, key=lambda f: f[0]) if abs(by) >= LEAST], complex)


def _with_others(few: Sequence[InkTrace], by: Sequence[Points]) -> Iterator[InkTrace]:
    """The traces with their places: of several candidates that by which most of the lettering near it was moved as well."""
    middles = np.array([t.element.middle for t in few])
    for t, own in zip(few, by, strict=True):
        near = [other for z, other in zip(middles, by, strict=True) if abs(z - t.element.middle) < TOGETHER and other is not own]
        votes = [sum(bool((np.abs(other - z) < ALIKE).any()) for other in near) for z in own]
        if not votes:
            yield t
            continue
        z = complex(own[int(np.argmax(votes))])
        status: Status = "absent lettering" if t.status == "absent lettering" else "part of lettering"
        yield replace(t, status=status, shift=z, deviation=abs(z), at=t.element.points + z)


def _alike(size: tuple[float, float], box: Box) -> bool:
    """Whether ink has the size of what fills a box."""
    least, most = ([share * ought + by for ought in (box.width, box.height)] for share, by in zip(LIKE, MORE, strict=True))
    return all(a <= x <= b for a, x, b in zip(least, size, most, strict=True))


def _fill(picture: Any, corners: Any, left: int, top: int, value: int = 255) -> None:
    """Paint a polygon into a part of a picture that begins at a column and a row."""
    import cv2

    q = pixels(corners) - complex(left, top)
    cv2.fillPoly(picture, [np.rint(np.stack((q.real, q.imag), -1)).astype(np.int32)], value)
