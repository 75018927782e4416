"""Lines that leave the stroke they share with others at so small an angle that the stroke looks right.

A helper line lies under its vector nearly all the way. Turned about one end, it is still found: the vector's ink is where its own
ought to be. Only where it goes on alone, beyond the tip, its place is bare, and beside the bare place there is ink that belongs to
nobody, on a line from the other end. Neither tells anything by itself: by hand a helper line ends anywhere, and ink may be a
letter's. Both together do, unless a place where that line shows beside the stroke has none.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.stations import STEP as ASIDE
from tmm_sheets.compare.photo.stations import expected_ink, smoothed
from tmm_sheets.compare.photo.traces import InkTrace, open_line
from tmm_sheets.drawing.marks import Points

STEP = 0.3  # mm between places along a line
FAR, LEAST = 6.0, 0.6
"""mm by which its end may be off, and from which on it is told from the blur of a stroke."""
AWAY = np.arange(-FAR - 1, FAR + 1 + ASIDE / 2, ASIDE)
ENDS = np.arange(LEAST, FAR, ASIDE)
PIVOTS = (0.0, 0.1, 0.2, 0.3)  # where it may cross its place, as shares of it
ASTRAY = 0.4  # mm by which a stroke is off from which on it may be between the lines, and says nothing of where they are
TAIL, MOST = 2.0, 0.6
"""Least mm of it that are bare at its end, and share of it that may be."""
BARE, INKED = 0.4, 0.5
"""Darkness as a share of that usual up to which a place is bare, and beyond which it has ink."""
CROSSED = 4  # places in a row that lines that cross may take of a bare end
CLOSE = 5  # steps to either side of others within which ink may be theirs
SEEN, MORE, ALL = 0.6, 2.4, 0.85
"""Least mm of ink beside its bare end, and on all of its way, and least share that has ink of all that shows of it."""
PAPER, RIDGE, CLEAR = 0.6, 10, 0.8
"""Darkness as a share of a line's below which there is paper, steps to both sides of it within which there is, and least share of
the ink beside its bare end that lies so."""


def diverging_line(t: InkTrace, ink: Any, words: Any, owners: Owners, usual: float) -> InkTrace | None:
    """The trace of a line that goes on beside its bare end, or None.

    Parameters
    ----------
    t
        The trace of a line that was found in its place.
    ink
        The rectified picture.
    words
        Where lettering belongs, 255 there.
    owners
        Who is drawn where.
    usual
        How dark lines of its width usually are.
    """
    e = t.element
    if t.at is None or e.kind != "line" or not open_line(e) or expected_ink(e) < 1:
        return None
    place = t.at if t.deviation <= ASTRAY else e.points
    for forward in (True, False):
        found = _beside(e.number, place if forward else place[::-1], ink, words, owners, usual)
        if found is None:
            continue
        there, covered = found
        there = there if forward else there[::-1]
        by, way = there - e.points, e.points[1] - e.points[0]
        turn = float(np.angle((there[1] - there[0]) / way))
        return InkTrace(e, "beside", complex(by.mean()), turn, deviation=float(np.abs(by).max()), covered=covered, at=there)
    return None


def _beside(number: int, place: Points, ink: Any, words: Any, owners: Owners, usual: float) -> tuple[Points, float] | None:
    """The line by which one goes on beside the bare end of its ``place``, and the share that has ink of what shows of it."""
    import cv2

    length = abs(place[1] - place[0])
    way = (place[1] - place[0]) / length
    run = np.linspace(0, 1, int(length / STEP) + 1)
    p = place[0] + run * length * way
    here = sample(ink, pixels(p[:, None] + 1j * way * np.array([-ASIDE, 0, ASIDE]))).max(1)
    first = len(run) - _bare_end(here < BARE * usual)
    if (len(run) - first) * STEP < TAIL or first < (1 - MOST) * len(run):
        return None
    places = p[:, None] + 1j * way * AWAY
    others = owners.others(number, places)
    profile = smoothed(sample(ink, pixels(places)), others)
    others[first:, np.abs(AWAY) < LEAST] = False  # nothing is there, whoever else is meant to be
    unknown = cv2.dilate(others.astype(np.uint8), np.ones((1, 2 * CLOSE + 1), np.uint8)) > 0
    unknown |= sample(words, pixels(places)) > 100

    row = np.arange(len(run))
    found: list[tuple[float, Points, float, Any]] = []
    for pivot, end in product(PIVOTS, (*ENDS, *-ENDS)):
        off = end * (run - pivot) / (1 - pivot)
        column = np.round((off - AWAY[0]) / ASIDE).astype(int)
        shows = ~unknown[row, column] & (np.abs(off) > LEAST / 2)
        dark = np.where(shows, profile[row, column], 0.0)
        hit = dark > INKED * usual
        shows[np.flatnonzero(hit).max(initial=-1) + 1 :] = False  # it may end there
        if hit[first:].sum() * STEP < SEEN or hit.sum() * STEP < MORE:
            continue
        covered = float(hit.sum() / shows.sum())
        if min(hit[first:].sum() / shows[first:].sum(), covered) >= ALL:
            alone = np.flatnonzero(hit[first:] & (here[first:] < BARE * usual)) + first
            found.append((float(dark[first:][hit[first:]].sum()), place + 1j * way * off[[0, -1]], covered, (alone, column[alone])))
    for _, line, covered, (rows, columns) in sorted(found, key=lambda f: -f[0]):
        if len(rows) and np.mean([_ridge(profile[r], k) for r, k in zip(rows, columns, strict=True)]) >= CLEAR:
            return line, covered
    return None


def _bare_end(bare: Any) -> int:
    """How many places at the end are bare, those that lines take that cross among them."""
    count = 0
    for k, free in enumerate(bare[::-1].tolist(), 1):
        if free:
            count = k
        elif k - count > CROSSED:
            break
    return count


def _ridge(across: Any, at: int) -> bool:
    """Whether there is paper to both sides of a line at a place across."""
    top = across[at - 1 : at + 2].max()
    return bool(max(across[at - RIDGE : at].min(), across[at : at + RIDGE + 1].min()) < PAPER * top)
