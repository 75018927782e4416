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
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.stations import LEAST as LEAST_SEEN
from tmm_sheets.compare.photo.stations import STEP as ASIDE
from tmm_sheets.compare.photo.stations import expected_ink, smoothed
from tmm_sheets.compare.photo.traces import InkTrace, open_line
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

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


NEAREST, FARTHEST = 0.9, 3.0
"""mm from the middle of a stroke at which a picture of 2.5 pixels a millimetre, the coarsest that is judged, shows a second ridge
(two pixels and the paper between them), and by which the end is off at most: what has gone farther is parted by paper."""
NARROW_MOST = 120  # places along a line
NARROW_AWAY = np.arange(-FARTHEST - 1.5, FARTHEST + 1.5 + ASIDE / 2, ASIDE)
NARROW_ENDS = np.arange(NEAREST, FARTHEST + ASIDE / 2, ASIDE)
ABOUT = 2
"""Steps from where a ridge ought to be within which its top is: a hand draws a straight line to 0.2 mm."""
VALLEY, GRAIN = 0.8, 0.9
"""Darkness between both ridges, by the second one's, that half of the places have at most, and each of them: grain of paper and
pencil makes a tenth of it."""
NARROW_ALL = 0.85
"""Least share of the places that show where the second ridge is."""
TO_END = 2.0  # mm before the end of the line up to which the ridge must be seen
BACK = 0.35
"""Offset of the ridge where the line was turned, as a share of that of its other end, up to which it leads there: a quarter of the
line is all that shows of it, and its direction is known by that only."""


def narrow_divergence(t: InkTrace, ink: Any, words: Any, owners: Owners, usual: float) -> InkTrace | None:
    """The trace of a straight line that parts from its stroke about one end, or None.

    Parameters
    ----------
    t
        The trace of a line in one stroke with others.
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
    if not open_line(e) or len(e.points) != 2 or expected_ink(e) < 1:
        return None
    way = (e.points[1] - e.points[0]) / e.length
    run = np.linspace(0, 1, min(int(e.length / STEP), NARROW_MOST) + 1)
    places = (e.points[0] + run * e.length * way)[:, None] + 1j * way * NARROW_AWAY
    others = owners.others(e.number, places)
    profile = smoothed(sample(ink, pixels(places)), others).astype(np.float32)
    aside = others & (np.abs(NARROW_AWAY) > 0.5 * line_type(e.style).width + CLOSE * ASIDE)  # the stroke itself is no other's
    unknown = _widened(aside, CLOSE) | (sample(words, pixels(places)) > 100)
    shown = ~_widened(unknown, ABOUT)
    for left in (True, False):
        ridge, depth = ridges(profile if left else profile[:, ::-1], INKED * usual)
        if ridge.any(1).mean() * e.length < LEAST_SEEN / 2:
            continue
        shows = (shown if left else shown[:, ::-1])[:, len(NARROW_AWAY) // 2 :]
        for along in (1, -1):
            off = _parting(run, e.length, ridge[::along], shows[::along], depth[::along])
            if off is None:
                continue
            by = 1j * way * off[::along] * (1 if left else -1)
            there = e.points + by
            turn = float(np.angle((there[1] - there[0]) / way))
            return InkTrace(e, "beside", complex(by.mean()), turn, deviation=float(np.abs(by).max()), covered=1.0, at=there)
    return None


def ridges(profile: Any, least: float) -> tuple[Any, Any]:
    """Where there is a second ridge above the middle of a stroke, and how dark it is between both by its darkness.

    ``profile`` is how dark it is at places along a stroke and at steps across it, whose middle is in the middle column, ``least``
    how dark a ridge is at least; both that are returned begin in the middle.
    """
    import cv2

    outwards = np.ascontiguousarray(profile[:, profile.shape[1] // 2 :], np.float32)
    beyond = cv2.erode(outwards, np.ones((1, RIDGE + 1), np.uint8), anchor=(0, 0), borderType=cv2.BORDER_REPLICATE)
    valley = np.minimum.accumulate(outwards, 1)
    top = outwards >= cv2.dilate(outwards, np.ones((1, 2 * ABOUT + 1), np.uint8))
    ridge = top & (outwards > least) & (valley < GRAIN * outwards) & (beyond < PAPER * outwards)
    return ridge, valley / np.maximum(outwards, 1)


def may_part(profile: Any, others: Any, length: float, dark: float) -> bool:
    """Whether a second ridge that is no other's shows beside a line of a ``length`` in mm, so much of it that it may be one.

    ``others`` is where others are drawn in its ``profile``, ``dark`` how dark it is itself.
    """
    shows = ~_widened(others, CLOSE)
    middle = profile.shape[1] // 2
    sides = ((profile, shows), (profile[:, ::-1], shows[:, ::-1]))
    return any((ridges(p, INKED * dark)[0] & s[:, middle:]).any(1).mean() * length >= LEAST_SEEN / 2 for p, s in sides)


def _widened(places: Any, steps: int) -> Any:
    """Places with those so many steps to either side of them."""
    import cv2

    return cv2.dilate(places.astype(np.uint8), np.ones((1, 2 * steps + 1), np.uint8)) > 0


def _parting(run: Floats, length: float, ridge: Any, shows: Any, depth: Any) -> Floats | None:
    """How far the beginning and the end of the line are off that parts from a stroke at its beginning, mm; None without one.

    Of each place along the stroke and each step outwards it is given whether a ridge is there, whether that shows, and how dark
    the valley before it is by it.
    """
    best: tuple[int, Floats] | None = None
    for end in NARROW_ENDS:
        rows = np.flatnonzero(end * run >= NEAREST)
        columns = np.round(end * run[rows] / ASIDE).astype(int)
        here = shows[rows, columns]
        rows, columns = rows[here], columns[here]
        near = ridge[rows[:, None], columns[:, None] + np.arange(-ABOUT, ABOUT + 1)]
        seen = near.any(1)
        if seen.sum() * length / len(run) < LEAST_SEEN / 2 or seen.mean() < NARROW_ALL:
            continue
        rows, columns = rows[seen], columns[seen] + near[seen].argmax(1) - ABOUT
        slope, begin = np.polyfit(run[rows], ASIDE * columns, 1)
        last = float(begin + slope)
        parts = NEAREST <= last <= FARTHEST + ABOUT * ASIDE and abs(begin) <= BACK * last
        whole = (1 - run[rows].max()) * length <= TO_END and np.median(depth[rows, columns]) <= VALLEY
        if parts and whole and (best is None or len(rows) > best[0]):
            best = len(rows), np.array([begin, last])
    return None if best is None else best[1]
