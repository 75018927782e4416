"""Lines that part from a stroke of several so slowly that paper hardly shows between them.

A line turned by a millimetre or two about one end lies in its stroke for the greater part. Farther on there are two ridges of ink,
and between them it is paler, but in a picture of few pixels a millimetre not as pale as paper: ``displacement.beside`` asks for
paper, and the stroke, which others keep in its place, seems sound. What tells such a line from one uneven stroke is geometry: the
second ridge is straight, it leads back to the end about which the line was turned, and it ends where the line does. A ridge that
runs along the stroke is no such line.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.compare.photo.diverging_lines import CLOSE, INKED, PAPER, RIDGE, STEP
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.stations import LEAST, expected_ink, smoothed
from tmm_sheets.compare.photo.stations import STEP as ASIDE
from tmm_sheets.compare.photo.traces import InkTrace, open_line
from tmm_sheets.drawing.styles import line_type

NEAREST, FARTHEST = 0.9, 3.0
"""mm from the middle of a stroke at which a picture of 2.5 pixels a millimetre, the coarsest that is judged, shows a second ridge
(two pixels and the paper between them), and by which the end is off at most: what has gone farther is parted by paper."""
MOST = 120  # places along a line
AWAY = np.arange(-FARTHEST - 1.5, FARTHEST + 1.5 + ASIDE / 2, ASIDE)
ENDS = np.arange(NEAREST, FARTHEST + ASIDE / 2, ASIDE)
ABOUT = 2
"""Steps from where a ridge ought to be within which its top is: a hand draws a straight line to 0.2 mm."""
VALLEY, GRAIN = 0.8, 0.9
"""Darkness between both ridges, by the second one's, that half of the places have at most, and each of them: grain of paper and
pencil makes a tenth of it."""
ALL = 0.85
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
    run = np.linspace(0, 1, min(int(e.length / STEP), MOST) + 1)
    places = (e.points[0] + run * e.length * way)[:, None] + 1j * way * AWAY
    others = owners.others(e.number, places)
    profile = smoothed(sample(ink, pixels(places)), others).astype(np.float32)
    aside = others & (np.abs(AWAY) > 0.5 * line_type(e.style).width + CLOSE * ASIDE)  # the stroke itself is no other's
    unknown = _widened(aside, CLOSE) | (sample(words, pixels(places)) > 100)
    shown = ~_widened(unknown, ABOUT)
    for left in (True, False):
        ridge, depth = ridges(profile if left else profile[:, ::-1], INKED * usual)
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
    return any((ridges(p, INKED * dark)[0] & s[:, middle:]).any(1).mean() * length >= LEAST / 2 for p, s in sides)


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
    for end in ENDS:
        rows = np.flatnonzero(end * run >= NEAREST)
        columns = np.round(end * run[rows] / ASIDE).astype(int)
        here = shows[rows, columns]
        rows, columns = rows[here], columns[here]
        near = ridge[rows[:, None], columns[:, None] + np.arange(-ABOUT, ABOUT + 1)]
        seen = near.any(1)
        if seen.sum() * length / len(run) < LEAST / 2 or seen.mean() < ALL:
            continue
        rows, columns = rows[seen], columns[seen] + near[seen].argmax(1) - ABOUT
        slope, begin = np.polyfit(run[rows], ASIDE * columns, 1)
        last = float(begin + slope)
        parts = NEAREST <= last <= FARTHEST + ABOUT * ASIDE and abs(begin) <= BACK * last
        whole = (1 - run[rows].max()) * length <= TO_END and np.median(depth[rows, columns]) <= VALLEY
        if parts and whole and (best is None or len(rows) > best[0]):
            best = len(rows), np.array([begin, last])
    return None if best is None else best[1]
