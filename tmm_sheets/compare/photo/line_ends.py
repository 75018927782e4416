"""Where a line begins and ends.

Along a line and beyond its end a place is bare, or its ink is surely the line's own, or it may be another's (a line that crosses
there, a letter). So the line reaches at least to the last ink that is surely its own and at most to the first bare place after
that. It is too long or too short by what both bounds agree on; if its proper end lies between them, nothing is wrong, and if they
are far apart, nothing is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element, interruptions
from tmm_sheets.compare.photo.displacement import FAR
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.judging import LOOSE_STYLES
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.traces import InkTrace, open_line
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

STEP = 0.2  # mm between places along the line
ASIDE = np.linspace(-0.3, 0.3, 5)  # mm to either side where its ink may be
BESIDE = np.linspace(-0.7, 0.7, 13)  # mm to either side where another's ink may come from; less than a pixel apart
GAP, PATTERN_GAP, BEYOND_GAP = 1.6, 3.5, 0.3
"""mm of bare paper a solid and a dashed line may have along their way, and any line beyond its end, where letters stand near."""
LIFTED, RESTS, DRAWN_TO = 2.6, 1.2, 1.8
"""mm of bare paper a lifted pencil may leave near an end, and least mm of ink, its own or another's, from there to the end; of a
line of a construction: nearer to its end there is the line or curve that it was to be drawn to."""
RESUMED = 4
"""Places in a row with its own ink by which a line goes on after a wider gap than is usual."""
CLEAR, CLEARER = 0.5, 0.6
"""Ink is a line's own if so many mm outside the line (first number) it is paler than this share of the middle's (second)."""
TORN = 0.4  # mm of bare paper beyond which ink that may be another's is another's
VAGUE = 1.2  # mm between the bounds from which on the end is unknown
SEEN, SHARE = 0.6, 0.4  # least mm, and least share, of its own ink beyond the end of a line that is too long
BLUR = 0.25  # mm beyond its end within which ink may be blur
PALER, MOST = 0.8, 0.8
"""Least mm, and least share, of pale ink that is nobody else's by which a line goes on to its end: under adhesive tape."""
CROWDED = np.arange(0.4, 2.3, 0.1)
"""mm to both sides of a thin line within which others crowd it: there, as in the hub of many positions of a crank, it fades."""
ROUND, TIP = 0.75, 0.55  # share of the pen's half width by which a line looks longer; mm by which an arrow looks shorter


class _Way(NamedTuple):
    """Places from inside a line out over its end, ``t`` mm beyond it."""

    element: Element
    tip: float | None
    """How far beyond the end of the line the tip of an arrow lies, mm; None without one."""
    t: Floats
    places: Points
    normals: Points
    lettered: Any
    """Whether the sheet itself interrupts the line there, behind lettering."""


def with_ends(traces: Sequence[InkTrace], ink: Any, owners: Owners, words: Any, level: float) -> list[InkTrace]:
    """Find the ends of lines.

    Parameters
    ----------
    traces
        Those of open lines; the others are left as they are.
    ink
        The rectified picture.
    owners
        Who is drawn where; displaced elements also where they were found.
    words
        A picture of the places of lettering, 255 there.
    level
        Darkness of ink.

    Returns
    -------
    The traces in the same order, with ``ends``.
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
    crowded = owners.others(numbers, p + n * CROWDED).any(1) & owners.others(numbers, p - n * CROWDED).any(1)
    parts = (np.split(part, cuts) for part in (across, hidden, crowded))
    ends = [_end(w, a, h, c, level) for w, a, h, c in zip(ways, *parts, strict=True)]
    for i, k in enumerate(chosen):
        out[k] = replace(traces[k], ends=(ends[2 * i], ends[2 * i + 1]))
    return out


def _ways(t: InkTrace) -> tuple[_Way, _Way]:
    """The ways over the beginning and over the end of a line that was found."""
    assert t.at is not None
    reach = min(FAR, 0.4 * t.element.length)
    begin, end = t.element.points[[0, -1]]
    gaps = interruptions(t.element)
    back = [(1 - b, 1 - a) for a, b in gaps]
    return (_way(t.element, t.at, reach, _tip(t.element, begin), gaps),
            _way(t.element, t.at[::-1], reach, _tip(t.element, end), back))


def _tip(e: Element, end: complex) -> float | None:
    """Distance from an end to the tip of the arrow there, mm: the line of a curved arrow stops within the head."""
    return min((d for f in e.fills if (d := float(abs(f[0] - end))) < FAR), default=None) if e.arrow else None


def _way(e: Element, z: Points, reach: float, tip: float | None, gaps: Sequence[tuple[float, float]]) -> _Way:
    """The way over the beginning of a line ``z``, straight on beyond it; ``gaps`` as shares of the line from there."""
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
    u = z[0] - z[min(int(np.searchsorted(run, 1.0)) + 1, len(z) - 1)]
    u /= max(abs(u), 1e-9)
    t = np.arange(-min(reach + 2.0, run[-1] / 2), reach + STEP / 2, STEP)
    p = np.where(t <= 0, np.interp(-t, run, z.real) + 1j * np.interp(-t, run, z.imag), z[0] + u * np.maximum(t, 0))
    along = np.gradient(p)
    lettered = np.zeros(len(t), bool)
    for a, b in gaps:
        lettered |= (-t >= a * run[-1] - STEP) & (-t <= b * run[-1] + STEP)
    return _Way(e, tip, t, p, 1j * along / np.maximum(np.abs(along), 1e-9), lettered)


def _end(way: _Way, across: Any, hidden: Any, crowded: Any, level: float) -> float:
    """How far the line runs beyond its end, mm; negative when it stops short, nan when others hide it."""
    t, tip = way.t, way.tip
    pen = 0.5 * line_type(way.element.style).width if tip is None else tip
    dark, own, pale = _ink_along(way, across, hidden | way.lettered, level)
    dark |= way.lettered
    if (extent := _extent(way, dark, own)) is None:
        return float("nan")
    least, most = (float(t[k]) for k in extent)
    # Ink goes on round a blunt end, and a tip is too thin to be seen to its point.
    shown = ROUND * pen if tip is None else tip - TIP
    if most < min(shown, 0.0):
        rest = slice(extent[1] + 1, int((t < min(shown, 0.0)).sum()))
        weak = own[extent[1] + 2 : int((t < 0).sum())]
        paler = pale[rest].sum() >= max(PALER / STEP, MOST * (~hidden[rest]).sum())
        faded = way.element.style in LOOSE_STYLES and crowded[rest].sum() > 0.5 * len(crowded[rest]) > 0
        lifted = _lifted(dark[rest], DRAWN_TO if way.element.role == "construction" else RESTS)
        return float("nan") if (len(weak) and weak.mean() > 0.3) or faded or paler or lifted else most - shown
    beyond = least - shown
    seen = own[(t > pen + BLUR) & (t <= least)]
    if beyond > 0 and len(seen) and seen.sum() * STEP >= min(SEEN, beyond) and seen.mean() > SHARE:
        return beyond
    return float("nan") if most - min(least, 0.0) > VAGUE else 0.0


def _lifted(rest: Any, least: float) -> bool:
    """Whether between where a line stops and its proper end there is one gap, as by a lifted pencil, and then ink all the way.

    There must be at ``least`` so many mm of that.
    """
    bare = int(np.argmax(rest)) if rest.any() else len(rest)
    return bool(bare * STEP <= LIFTED and (len(rest) - bare) * STEP >= least and rest[bare:].all())


def _ink_along(way: _Way, across: Any, hidden: Any, level: float) -> tuple[Any, Any, Any]:
    """Where along the way there is ink, where it is the line's own for sure, and where there may be a pale trace of that."""
    import cv2

    across = cv2.blur(across, (1, 3))
    depth, beside = across[:, : len(ASIDE)].max(1), across[:, len(ASIDE) :].max(1)
    hidden = cv2.morphologyEx(hidden.astype(np.uint8)[:, None], cv2.MORPH_CLOSE, np.ones((5, 1), np.uint8))[:, 0] > 0
    plain = (way.t < 0) & ~hidden
    # Other lines make it darker, if anything.
    usual = np.median(depth[plain]) if plain.sum() > 4 else np.percentile(depth[way.t < 0], 20)
    dark = depth > max(level, 0.5 * float(usual))
    clear = ~hidden & (beside < CLEARER * depth)
    return dark, dark & clear, (depth > level) & clear


def _extent(way: _Way, dark: Any, own: Any) -> tuple[int, int] | None:
    """Indices of the last ink that is surely the line's own, the first place if none is, and of the last ink before bare paper.

    None without ink.
    """
    patterned = bool(line_type(way.element.style).pattern)
    gap, torn = (PATTERN_GAP, PATTERN_GAP) if patterned else (GAP, TORN)
    low, last, inside = -1, 0, int((way.t <= 0.3).sum())
    for i in np.flatnonzero(dark).tolist():
        # A pencil that was lifted goes on with ink that is nobody else's.
        bare = BEYOND_GAP if i >= inside else PATTERN_GAP if own[i : i + RESUMED].all() else gap
        if (i - last) * STEP > bare + 1e-9:
            break
        last = i
        if own[i]:
            low = i
    if low < 0:  # others hide all of it, and may go on no farther than it does
        return (0, last) if dark[last] else None
    high = low
    for i in (np.flatnonzero(dark[low:]) + low).tolist():
        if (i - high) * STEP > torn + 1e-9:
            break
        high = i
    return low, high
