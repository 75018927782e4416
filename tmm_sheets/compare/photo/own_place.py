"""Looking for an element in its own place, and for one that parts from the stroke it shares with others at a small angle.

A helper line lies under its vector nearly all the way. Turned about one end, it is still found: the vector's ink is where its own
ought to be. Where it leaves the stroke there is a second ridge beside it that belongs to nobody else.

"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.lost_ink import at
from tmm_sheets.compare.photo.profiles import HALF, LARGELY, MOSTLY, NEARLY_ALL, WHOLE, fit, peaks, pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.traces import (
    LEAST,
    PALE,
    STEP,
    InkTrace,
    Paper,
    Strip,
    expected_ink,
    measured,
    open_line,
    smoothed,
    stations,
)
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

NEAR = 2.0  # mm from its own place within which an element is sought
OFFSETS = np.arange(-NEAR - 1, NEAR + 1 + STEP / 2, STEP)
APART = 4  # steps of bare paper that separate two lines to the eye
BROAD = 18  # steps; a wider stroke is not measured as one
OFF = 0.6  # mm; a line farther off its place is measured a second time
FREE = 0.25  # least share of a line free of others for it to be measured by itself
ASIDE = 1.4  # mm from its edge to the next line's from which on a piece of a curve is surely not drawn towards that
BRANCHES = 4.0  # mm from one branch of a curve to the next within which neither is surely seen by itself
LEAST_END = 3.0  # mm of a quarter of a line by which its end is judged
SHARED = 0.4  # least share of a line free or in one stroke with others for it to be measured with them
CLEAR = 0.3
"""mm between the edges of a line and of the next beyond which ink is nobody else's, and mm beside its place where it may be."""


def strip_of(e: Element, paper: Paper) -> Strip:
    """An element with the ink about its place, without the stations that are hidden."""
    # A curve in its place is off here and there rather than too large.
    s = stations(e, e.kind in ("circle", "arc"))
    here = ~at(s.points, paper.hidden)
    if 0 < here.sum() < len(here):  # what is seen there is the edge of what hides the others
        s = s._replace(points=s.points[here], normals=s.normals[here], raw=s.raw[here])
    return Strip(e, s, OFFSETS, paper)


def in_place(strip: Strip) -> InkTrace | None:
    """The trace of an element in its own place, or None when it is not there."""
    e, s, profile, others, level = strip.element, strip.stations, strip.profile, strip.others, strip.paper.level
    width = line_type(e.style).width
    # Distance of the next known line, and how far to look; where another line runs along, nothing can be told.
    own = np.abs(OFFSETS) <= width / 2 + 0.25
    away = np.where(others & ~own, np.abs(OFFSETS), NEAR + 0.5).min(1)
    reach = np.clip(0.5 * away, 0.3, NEAR)
    free = away > width / 2 + 0.6
    o, strength = _peaks_within(profile, reach, max(width / 2 + 0.1, 0.25), level)
    there = strength > level
    expected = expected_ink(e)
    use = there & free
    if free.sum() < max(4, FREE * len(free)):
        # Others lie beside or on it nearly everywhere: whether it is there can be told, but hardly where.
        inked = (np.where(np.abs(OFFSETS) <= reach[:, None], profile, 0).max(1) > level).mean()
        if inked > 0.75 * expected:
            return _shared(strip, o, use) or InkTrace(e, "dense", covered=float(inked), at=e.points)
        return None
    if use.sum() < 3 or use.sum() < 0.45 * expected * free.sum():
        return None
    base = s.base(use)
    x = fit(base, o, use, 0.3)
    r = np.abs(o - base @ x)
    good = use & (r < 0.45)
    share = good.sum() / free.sum()
    # Both halves must be there, and the ends of a straight line, or it may be another line crossing at a small angle.
    half, quarter = len(free) // 2, len(free) // 4
    parts = [slice(0, half), slice(half, None)]
    if e.kind == "line" and quarter * e.length / len(free) > LEAST_END:
        parts += [slice(0, quarter), slice(-quarter, None)]
    halves = [good[k].sum() / max(free[k].sum(), 1) for k in parts if free[k].sum() > 3]
    if share < MOSTLY * expected or min(halves, default=1.0) < 0.4 * expected:
        return None
    if (np.abs(base @ x)[free] > OFF).mean() > 0.1:
        # Off its place: measured once more around where it is, even beyond the half way to the next line.
        o, strength = peaks(profile, OFFSETS, base @ x, 0.7, 0.5)
        use = (strength > level) & free
        x = fit(base, o, use, 0.3)
        away, here = np.abs(base @ x) > OFF, np.where(np.abs(OFFSETS) < 1.5 * STEP, profile, 0).max(1)
        if away.any() and (here > PALE * strength)[away].mean() > LARGELY:  # its own place has ink too: another line, or blur
            return InkTrace(e, "dense", covered=float(there.mean()), at=e.points)
    t = replace(measured(e, s, base @ x, free, float(share / expected)), darkness=float(np.median(strength[use])),
                free=float(free.mean()))
    if e.kind == "line" and t.deviation <= OFF and (others & own)[free].any(1).mean() >= MOSTLY:
        t = replace(t, parts=may_part(profile, others, e.length, t.darkness))
    if e.kind == "curve":
        step = e.length / len(o)
        clear = use & (away > width / 2 + ASIDE) & ~_by_itself(s.points, step)
        t = replace(t, deviation=max(t.deviation, _local(o, clear, step)))
    return t


def uncovered(strip: Strip) -> Any:
    """How dark an element's place is at each of its stations, nan where its head or another line covers it or one runs along."""
    width = line_type(strip.element.style).width
    clear = np.where(strip.others, np.abs(OFFSETS), NEAR).min(1) > CLEAR + width / 2
    for head in strip.element.fills:
        clear &= np.abs(strip.stations.points - head.mean()) > np.abs(head - head.mean()).max()
    return np.where(clear, np.where(np.abs(OFFSETS) <= CLEAR, strip.profile, 0).max(1), np.nan)


def _shared(strip: Strip, o: Floats, use: Any) -> InkTrace | None:
    """The trace of an element in one stroke with others: the stroke against where all of them together ought to be."""
    e, s, profile, others = strip.element, strip.stations, strip.profile, strip.others
    width = line_type(e.style).width
    meant = others | (np.abs(OFFSETS) <= width / 2)
    closed = cv2.morphologyEx(meant.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((1, APART + 1), np.uint8)) > 0
    middle = len(OFFSETS) // 2
    below, above = (np.where(side.all(1), side.shape[1], side.argmin(1)) for side in (closed[:, middle::-1], closed[:, middle:]))
    column = np.arange(len(OFFSETS))
    low, high = (middle - below + 1)[:, None], (middle + above - 1)[:, None]
    inside = (column >= low) & (column <= high)
    stroke = (low[:, 0] > 4) & (high[:, 0] < len(OFFSETS) - 5) & (high - low <= BROAD)[:, 0]
    about = (column >= low - APART) & (column <= high + APART)
    dark = np.where(about, profile, 0).astype(np.float64)
    top = dark.max(1)
    weight = np.clip(dark - 0.25 * top[:, None], 0, None)
    seen = (weight * OFFSETS).sum(1) / np.maximum(weight.sum(1), 1e-9)
    ought = (inside & meant) @ OFFSETS / np.maximum((inside & meant).sum(1), 1)
    able = stroke & (top > strip.paper.level)
    offsets = np.where(use, o, seen - ought)
    able |= use
    if able.sum() < max(4, SHARED * len(able)):
        return None
    base = s.base(able)
    x = fit(base, offsets, able, 0.3)
    good = able & (np.abs(offsets - base @ x) < 0.45)
    t = measured(e, s, base @ x, able, float(good.sum() / able.sum()))
    return replace(t, status="shared")


def _by_itself(points: Points, step: float) -> Any:
    """Places of a curve, ``step`` mm apart, near which it comes by once more: the ink is that of both its branches."""
    k = np.arange(len(points))
    return ((np.abs(points[:, None] - points) < BRANCHES) & (np.abs(k[:, None] - k) * step > 2 * BRANCHES)).any(1)


def _local(o: Floats, use: Any, step: float) -> float:
    """Largest offset that ten millimetres of line agree on; ``step`` is the distance of the stations, mm."""
    size = max(round(10 / step), 5)
    worst = 0.0
    for i in range(0, len(o) - size + 1, max(size // 2, 1)):
        some = o[i : i + size][use[i : i + size]]
        if len(some) > 0.7 * size and np.ptp(np.percentile(some, (20, 80))) < 0.5:
            worst = max(worst, abs(float(np.median(some))))
    return worst


def _peaks_within(profile: Any, reach: Floats, half: float, level: float) -> tuple[Floats, Floats]:
    """The line of each profile within its own reach, preferring a near one to a blacker one farther off, but no line's flank."""
    p = np.where(np.abs(OFFSETS)[None, :] <= reach[:, None] + 1e-9, profile, 0)
    top = profile == cv2.dilate(profile, np.ones((1, 5), np.uint8))
    likely = np.where(top, np.minimum(p, 2 * level), 0) * (1 - 0.5 * np.abs(OFFSETS) / NEAR)
    centre = OFFSETS[likely.argmax(1)]
    return peaks(p, OFFSETS, centre, 0.4, half)


ALONG_STEP = 0.3  # mm between places along a line
CLOSE = 5  # steps to either side of others within which ink may be theirs


NEAREST, FARTHEST = 0.9, 3.0
"""mm from the middle of a stroke at which a picture of 2.5 pixels a millimetre, the coarsest that is judged, shows a second ridge
(two pixels and the paper between them), and by which the end is off at most: what has gone farther is parted by paper."""
MOST_PLACES = 120  # places along a line
AWAY = np.arange(-FARTHEST - 1.5, FARTHEST + 1.5 + STEP / 2, STEP)
END_OFFSETS = np.arange(NEAREST, FARTHEST + STEP / 2, STEP)
RIDGE = 10  # steps beyond a ridge within which there is paper
ABOUT = 2
"""Steps from where a ridge ought to be within which its top is: a hand draws a straight line to 0.2 mm."""
TO_END = 2.0  # mm before the end of the line up to which the ridge must be seen
BACK = 0.35
"""Offset of the ridge where the line was turned, as a share of that of its other end, up to which it leads there: a quarter of the
line is all that shows of it, and its direction is known by that only."""


def narrow_divergence(t: InkTrace, paper: Paper, usual: float) -> InkTrace | None:
    """The trace of a straight line that parts from its stroke about one end, or None.

    Parameters
    ----------
    t, paper
        The trace of a line in one stroke with others, and what shows.
    usual
        How dark lines of its width usually are.
    """
    e = t.element
    if not open_line(e) or len(e.points) != 2 or expected_ink(e) < 1:
        return None
    way = (e.points[1] - e.points[0]) / e.length
    run = np.linspace(0, 1, min(int(e.length / ALONG_STEP), MOST_PLACES) + 1)
    places = (e.points[0] + run * e.length * way)[:, None] + 1j * way * AWAY
    others = paper.owners.others(e.number, places)
    profile = smoothed(paper.dark(places), others).astype(np.float32)
    aside = others & (np.abs(AWAY) > 0.5 * line_type(e.style).width + CLOSE * STEP)  # the stroke itself is no other's
    unknown = _widened(aside, CLOSE) | (sample(paper.words, pixels(places)) > 100)
    shown = ~_widened(unknown, ABOUT)
    for left in (True, False):
        ridge, depth = ridges(profile if left else profile[:, ::-1], HALF * usual)
        if ridge.any(1).mean() * e.length < LEAST / 2:
            continue
        shows = (shown if left else shown[:, ::-1])[:, len(AWAY) // 2 :]
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
    outwards = np.ascontiguousarray(profile[:, profile.shape[1] // 2 :], np.float32)
    beyond = cv2.erode(outwards, np.ones((1, RIDGE + 1), np.uint8), anchor=(0, 0), borderType=cv2.BORDER_REPLICATE)
    valley = np.minimum.accumulate(outwards, 1)
    top = outwards >= cv2.dilate(outwards, np.ones((1, 2 * ABOUT + 1), np.uint8))
    ridge = top & (outwards > least) & (valley < WHOLE * outwards) & (beyond < PALE * outwards)
    return ridge, valley / np.maximum(outwards, 1)


def may_part(profile: Any, others: Any, length: float, dark: float) -> bool:
    """Whether a second ridge that is no other's shows beside a line of a ``length`` in mm, so much of it that it may be one.

    ``others`` is where others are drawn in its ``profile``, ``dark`` how dark it is itself.
    """
    shows = ~_widened(others, CLOSE)
    middle = profile.shape[1] // 2
    sides = ((profile, shows), (profile[:, ::-1], shows[:, ::-1]))
    return any((ridges(p, HALF * dark)[0] & s[:, middle:]).any(1).mean() * length >= LEAST / 2 for p, s in sides)


def _widened(places: Any, steps: int) -> Any:
    """Places with those so many steps to either side of them."""
    return cv2.dilate(places.astype(np.uint8), np.ones((1, 2 * steps + 1), np.uint8)) > 0


def _parting(run: Floats, length: float, ridge: Any, shows: Any, depth: Any) -> Floats | None:
    """How far the beginning and the end of the line are off that parts from a stroke at its beginning, mm; None without one.

    Of each place along the stroke and each step outwards it is given whether a ridge is there, whether that shows, and how dark
    the valley before it is by it.
    """
    best: tuple[int, Floats] | None = None
    for end in END_OFFSETS:
        rows = np.flatnonzero(end * run >= NEAREST)
        columns = np.round(end * run[rows] / STEP).astype(int)
        here = shows[rows, columns]
        rows, columns = rows[here], columns[here]
        near = ridge[rows[:, None], columns[:, None] + np.arange(-ABOUT, ABOUT + 1)]
        seen = near.any(1)
        if seen.sum() * length / len(run) < LEAST / 2 or seen.mean() < NEARLY_ALL:
            continue
        rows, columns = rows[seen], columns[seen] + near[seen].argmax(1) - ABOUT
        slope, begin = np.polyfit(run[rows], STEP * columns, 1)
        last = float(begin + slope)
        parts = NEAREST <= last <= FARTHEST + ABOUT * STEP and abs(begin) <= BACK * last
        whole = (1 - run[rows].max()) * length <= TO_END and np.median(depth[rows, columns]) <= LARGELY
        if parts and whole and (best is None or len(rows) > best[0]):
            best = len(rows), np.array([begin, last])
    return None if best is None else best[1]
