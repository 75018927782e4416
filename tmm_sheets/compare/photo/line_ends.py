"""Where a line begins and ends.

Along the line and on beyond its end every place is bare, or has ink that is the line's own for sure, or ink that may be another's
(one that crosses there, a letter). So a line reaches at least to the last ink that is surely its own and at most to the first bare
place after that. It is too long or too short by what both say; when its right end lies between the two, nothing is wrong, and
when they are far apart, nothing is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.displacement import FAR
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.traces import Trace, open_line
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

STEP = 0.2  # mm along the line
ASIDE = np.linspace(-0.3, 0.3, 5)  # mm to either side where its ink may be
BESIDE = np.linspace(-0.7, 0.7, 13)  # mm to either side where another's ink may come from; less than a pixel apart
GAP, PATTERN_GAP, BEYOND_GAP = 1.6, 3.5, 0.3
"""Bare stretches a line may have where it ought to be: a solid one, a dashed one; and beyond its end: letters stand near."""
CLEAR, CLEARER = 0.5, 0.6
"""mm beyond its pen at either side at which ink must be paler than this share of the middle's for the ink to be a line's own."""
TORN = 0.4  # mm of bare paper after which ink that may be another's is another's
VAGUE = 1.2  # mm between least and most from which on the end counts as unknown
SEEN, SHARE = 0.6, 0.4  # mm of its own ink beyond its end that make it too long, and how much of all that must be its own
BLUR = 0.25  # mm beyond its end where ink may be its blur
ROUND, TIP = 0.75, 0.55  # share of the pen's half width by which a line looks longer; mm by which an arrow looks shorter


class _Way(NamedTuple):
    """The way from inside a line out over its end: ``t`` mm, negative inside."""

    element: Element
    tip: float | None
    """How far beyond its end an arrow's tip lies, mm; None when there is none."""
    t: Floats
    places: Points
    normals: Points


def with_ends(traces: Sequence[Trace], ink: Any, owners: Owners, words: Any, level: float) -> list[Trace]:
    """Traces with their ends.

    Parameters
    ----------
    traces
        Of open lines, with ``at``.
    ink
        The rectified picture.
    owners
        Who is where, the displaced where they were found too.
    words
        Picture of the places of lettering.
    level
        Darkness of ink.
    """
    chosen = [k for k, t in enumerate(traces) if t.at is not None and open_line(t.element)]
    ways = [w for k in chosen for w in _ways(traces[k])]
    out = list(traces)
    if not ways:
        return out
    cuts = np.cumsum([len(w.t) for w in ways])[:-1]
    p, n = np.concatenate([w.places for w in ways])[:, None], np.concatenate([w.normals for w in ways])[:, None]
    numbers = np.concatenate([np.full(len(w.t), w.element.number) for w in ways])[:, None]
    aside = np.concatenate([np.full(len(w.t), 0.5 * line_type(w.element.style).width + CLEAR) for w in ways])[:, None]
    across = sample(ink, pixels(np.hstack((p + n * ASIDE, p - n * aside, p + n * aside))))
    hidden = owners.others(numbers, p + n * BESIDE).any(1) | (sample(words, pixels(p[:, 0])) > 100)
    ends = [_end(w, a, h, level) for w, a, h in zip(ways, np.split(across, cuts), np.split(hidden, cuts), strict=True)]
    for i, k in enumerate(chosen):
        out[k] = replace(traces[k], ends=(ends[2 * i], ends[2 * i + 1]))
    return out


def _ways(t: Trace) -> tuple[_Way, _Way]:
    assert t.at is not None
    reach = min(FAR, 0.4 * t.element.length)
    begin, end = t.element.points[[0, -1]]
    return _way(t.element, t.at, reach, _tip(t.element, begin)), _way(t.element, t.at[::-1], reach, _tip(t.element, end))


def _tip(e: Element, end: complex) -> float | None:
    """The line of a curved arrow stops within its head."""
    return min((d for f in e.fills if (d := float(abs(f[0] - end))) < FAR), default=None) if e.arrow else None


def _way(e: Element, z: Points, reach: float, tip: float | None) -> _Way:
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
    u = z[0] - z[min(int(np.searchsorted(run, 1.0)) + 1, len(z) - 1)]
    u /= max(abs(u), 1e-9)
    t = np.arange(-min(reach + 2.0, run[-1] / 2), reach + STEP / 2, STEP)
    p = np.where(t <= 0, np.interp(-t, run, z.real) + 1j * np.interp(-t, run, z.imag), z[0] + u * np.maximum(t, 0))
    along = np.gradient(p)
    return _Way(e, tip, t, p, 1j * along / np.maximum(np.abs(along), 1e-9))


def _end(way: _Way, across: Any, hidden: Any, level: float) -> float:
    """How far the line runs beyond its end, negative when it stops short, nan when others hide it, mm."""
    import cv2

    kind = line_type(way.element.style)
    t, pen = way.t, 0.5 * kind.width if way.tip is None else way.tip
    gap, torn = (PATTERN_GAP, PATTERN_GAP) if kind.pattern else (GAP, TORN)
    across = cv2.blur(across, (1, 3))
    depth, beside = across[:, : len(ASIDE)].max(1), across[:, len(ASIDE) :].max(1)
    hidden = cv2.morphologyEx(hidden.astype(np.uint8)[:, None], cv2.MORPH_CLOSE, np.ones((5, 1), np.uint8))[:, 0] > 0
    plain = (t < 0) & ~hidden
    usual = np.median(depth[plain]) if plain.sum() > 4 else np.percentile(depth[t < 0], 20)  # others make it darker, if anything
    dark = depth > max(level, 0.5 * float(usual))
    own = dark & ~hidden & (beside < CLEARER * depth)
    low, last, inside = -1, 0, int((t <= 0.3).sum())
    for i in np.flatnonzero(dark).tolist():
        if (i - last) * STEP > (gap if i < inside else BEYOND_GAP) + 1e-9:
            break
        last = i
        if own[i]:
            low = i
    if low < 0:
        return float("nan")
    high = low
    for i in (np.flatnonzero(dark[low:]) + low).tolist():
        if (i - high) * STEP > torn + 1e-9:
            break
        high = i
    # Ink goes on round a blunt end, and a tip is too thin to be seen to its point.
    shown = ROUND * pen if way.tip is None else way.tip - TIP
    if t[high] < min(shown, 0.0):
        weak = own[(np.arange(len(t)) > high + 1) & (t < 0)]
        return float("nan") if len(weak) and weak.mean() > 0.3 else float(t[high]) - shown
    least = float(t[low]) - shown
    seen = own[(t > pen + BLUR) & (t <= t[low])]
    if least > 0 and len(seen) and seen.sum() * STEP >= min(SEEN, least) and seen.mean() > SHARE:
        return least
    return float("nan") if t[high] - min(t[low], 0.0) > VAGUE else 0.0
