"""Whose the ink is that was found beside a stroke: a line whose own ink stands in its place owns no other.

A point that was drawn elsewhere takes all its lines with it, and so does a head that is not at its tip. Sound lines that end in the
same point, or near it, find the ink of such a line beside their strokes. It is given to the line that lacks its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tmm_sheets.compare.photo.displacement import FAR
from tmm_sheets.compare.photo.overlap_resolution import ASTRAY
from tmm_sheets.compare.photo.traces import InkTrace

SAME = 0.7
"""mm within which ends of lines are one point, and lines one stroke."""
MOVED, MORE = 1.0, 2.0
"""mm from its place beyond which an end has moved, and by how many times more than the other, which stays (see ``ASTRAY``)."""
ASKEW = 0.5
"""Sine of the angle by which a line that was drawn with one end elsewhere is askew at most."""
ACROSS = 0.2
"""Sine of the angle at which two lines cross in a point that may be told by that."""
OVERLAP = 0.5
"""Least share of the shorter one by which a line lies along ink that is its own."""


def reassign_ink(traces: Sequence[InkTrace], before: Mapping[int, InkTrace]) -> list[InkTrace]:
    """The traces, with heads, in their order; ink beside a stroke is that line's which lacks its own, if there is one such.

    ``before`` has the traces of the same elements without what was found beside strokes, by number.
    """
    lines = [t for t in traces if t.element.kind == "line" and len(t.element.points) == 2 and t.status != "hidden"]
    moved = [t for t in lines if t.status == "measured" and t.deviation > MOVED and t.at is not None]
    out = {t.element.number: t for t in traces}
    for f in lines:
        if f.status != "beside" or f.at is None:
            continue
        near = [t for t in lines if t.element.view is f.element.view]
        own = [t for t in near if t.element.name == f.element.name and _one_stroke(t, f)]  # a vector and its helper line
        if any(_headless(t) or _moved_end(t, f, moved) is not None for t in own):
            continue
        sound = any(t.head == "there" for t in own)
        owners = [(t, end) for t in near if t not in own
                  and (end := _moved_end(t, f, moved, always=sound and _headless(t))) is not None]
        if not owners or not all(_one_stroke(t, owners[0][0]) for t, _ in owners):
            continue
        out[f.element.number] = replace(before[f.element.number], head=f.head)
        for t, end in owners:
            if t.status not in ("beside", "measured") or (t.status == "measured" and t.deviation <= MOVED):
                out[t.element.number] = _with_end(t, end, f)
    return [out[t.element.number] for t in traces]


def _headless(t: InkTrace) -> bool:
    return t.head in ("absent", "left out")


def _one_stroke(t: InkTrace, f: InkTrace) -> bool:
    """Whether two straight lines belong in one stroke: both ends of one lie along the other."""
    (a, b), (c, d) = t.element.points, f.element.points
    return any((np.abs(((z - start) * np.conj(end - start)).imag) <= SAME * abs(end - start)).all()
               and (_along(z, start, end).max() > 0) and (_along(z, start, end).min() < 1)
               for z, start, end in ((np.array([a, b]), c, d), (np.array([c, d]), a, b)))  # fmt: skip


def _along(z: np.ndarray, start: complex, end: complex) -> np.ndarray:
    """Where places lie along a line, from 0 at its beginning to 1 at its end."""
    return np.asarray((z - start) / (end - start)).real


def _moved_end(t: InkTrace, f: InkTrace, moved: Sequence[InkTrace], always: bool = False) -> int | None:
    """The end of a line, 0 or 1, that has moved if the ink by which ``f`` was found is its own; None when it is not.

    Others that end there have moved to the same point of the ink, unless ``always``.
    """
    assert f.at is not None
    z, (a, b) = t.element.points, f.at
    away = ((z - a) * np.conj(b - a)).imag / abs(b - a)
    lie = np.clip(_along(z, a, b), 0, 1)
    if np.ptp(lie) * abs(b - a) < OVERLAP * min(t.element.length, abs(b - a)):
        return None
    for end in (0, 1):
        off = abs(float(away[end]))
        stays = abs(float(away[1 - end]))
        likely = stays <= min(ASTRAY, off / MORE) and MOVED < off <= min(FAR, ASKEW * t.element.length)
        some = [g for g in moved if g.element.view is t.element.view] if likely else []
        if likely and (always or any(_to_ink(g, complex(z[end]), a, b) for g in some)):
            return end
    return None


def _to_ink(g: InkTrace, z: complex, a: complex, b: complex) -> bool:
    """Whether a line that was found elsewhere ends at the point ``z``, and meets the ink from ``a`` to ``b`` not far from there."""
    assert g.at is not None
    ends = np.abs(g.element.points - z) <= SAME
    if not ends.any() or np.abs(g.at - g.element.points)[ends].max() <= MOVED:
        return False
    u, v = (b - a) / abs(b - a), (g.at[-1] - g.at[0]) / abs(g.at[-1] - g.at[0])
    sine = float((np.conj(u) * v).imag)
    if abs(sine) < ACROSS:
        return False
    point = g.at[0] - v * float((np.conj(u) * (g.at[0] - a)).imag) / sine
    return bool(MOVED < abs(point - z) <= FAR)


def _with_end(t: InkTrace, end: int, f: InkTrace) -> InkTrace:
    """A line with one end in its place and along the ink by which another was found."""
    assert f.at is not None
    z, (a, b) = t.element.points, f.at
    way = (b - a) / abs(b - a)
    way = way if (np.conj(way) * (z[end] - z[1 - end])).real > 0 else -way
    at = z.copy()
    at[1 - end] = a + (np.conj(way) * (z[1 - end] - a)).real * way
    at[end] = at[1 - end] + t.element.length * way
    off = at - z
    turn = float(np.angle((at[1] - at[0]) / (z[1] - z[0])))
    return replace(t, status="beside", shift=complex(off.mean()), turn=turn, growth=0.0, deviation=float(np.abs(off).max()), at=at,
                   ends=(np.nan, np.nan))  # fmt: skip
