"""Lines that belong in one place, of which one was drawn elsewhere: it took the others with it.

One stroke is all of them. Its ink is found by one, and the others would be missing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element, sampled
from tmm_sheets.compare.photo.displacement import FAR
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.joints import joint
from tmm_sheets.compare.photo.line_ends import with_ends
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Points

SAME = 0.7
"""mm within which a line that lies along another is in its place."""
MOSTLY = 0.8
"""Least share of a line that lies along another one for it to be drawn with that."""
ELSEWHERE = 1.0
"""mm from its place beyond which a line was drawn elsewhere."""


def coincident_lines(traces: Sequence[InkTrace]) -> list[InkTrace]:
    """The traces; a straight line that is missing lies where one that belongs in its place was found."""
    moved = [t for t in traces if t.status == "measured" and t.element.kind == "line" and t.deviation > ELSEWHERE]
    return [next((with_it for g in moved if (with_it := _along(t, g)) is not None), t)
            if t.status == "missing" and t.element.kind == "line" else t for t in traces]


def _along(t: InkTrace, g: InkTrace) -> InkTrace | None:
    """A missing line as it lies along another that was found elsewhere, None where they do not belong in one place."""
    e, other = t.element, g.element
    if e.view is not other.view or g.at is None:
        return None
    begin, end = other.points[[0, -1]]
    way = end - begin
    place = (e.points - begin) / way
    together = min(place.real.max(), 1) - max(place.real.min(), 0)
    if np.abs(place.imag).max() * abs(way) > SAME or together < MOSTLY * np.ptp(place.real):
        return None
    at = g.at[0] + place.real * (g.at[-1] - g.at[0])
    off = at - e.points
    return InkTrace(e, "measured", complex(off.mean()), g.turn, 0.0, float(np.abs(off).max()), covered=g.covered, at=at)


MEETING_SAME = 0.7
"""mm within which ends are one point, and from the edge of a joint within which a line ends at it."""
AT_JOINT, GATHERED = 2.5, 1.5
"""mm by which a line may be too long or too short at a joint, and by which it may seem too long where others end."""
ANOTHER_WAY = 0.1
"""Sine of the angle from which on a line that ends there has a direction of its own."""


def ignore_junction_ends(traces: Sequence[InkTrace], elements: Sequence[Element]) -> list[InkTrace]:
    """The traces; an end that is off by no more than meeting others makes it is right.

    Parameters
    ----------
    traces
        Those of open lines, with ``ends``.
    elements
        All that is on the sheet.
    """
    rounds = [e for e in elements if joint(e)]
    joints, radii = np.array([e.centre for e in rounds], complex), np.array([e.radius for e in rounds])
    dots = np.array([e.centre for e in elements if e.kind == "circle" and e.fills], complex)
    lines = [e for e in elements if e.kind == "line" and abs(e.points[-1] - e.points[0]) > MEETING_SAME]
    ends = np.array([e.points[[0, -1]] for e in lines], complex).reshape(-1, 2)
    ways = (ends[:, 1] - ends[:, 0]) / np.maximum(np.abs(ends[:, 1] - ends[:, 0]), MEETING_SAME)

    def right(z: Points, by: float) -> bool:
        """Whether a line whose end and next point are ``z`` may be so much too long there, mm, too short when negative."""
        if not 0 < abs(by) <= AT_JOINT:  # what is not known stays so
            return False
        if (np.abs(joints - z[0]) <= radii + MEETING_SAME).any():
            return True
        if not 0 < by <= GATHERED:
            return False
        way = (z[1] - z[0]) / max(abs(z[1] - z[0]), 1e-9)
        here = (np.abs(ends - z[0]) <= MEETING_SAME).any(1)
        return bool((np.abs(dots - z[0]) <= MEETING_SAME).any() or (np.abs((ways[here] * np.conj(way)).imag) >= ANOTHER_WAY).any())

    out = []
    for t in traces:
        z = t.element.points
        begin, end = (0.0 if right(way, by) else by for way, by in zip((z[:2], z[:-3:-1]), t.ends, strict=True))
        out.append(replace(t, ends=(begin, end)))
    return out


STEP = 1.0
ON, OVERLAP_MOSTLY = 1.0, 0.6
"""mm within which lines that were found are one, and least share of the shorter one that lies so near the other."""
ENDS, STAYS = 1.0, 0.2
"""By how much more than another line's the ends of one, or the better one of them, may be off for it to be the line as well, mm."""
ASTRAY = 2.0
"""mm; of a line that was drawn askew one end is no farther off."""


def resolve_overlaps(found: Sequence[InkTrace], ink: Any, owners: Owners, words: Any, level: float) -> set[int]:
    """Numbers of the elements that were found by ink that is rather another's.

    Parameters
    ----------
    found
        Traces of lines by ink beside the strokes in which they belong.
    ink, owners, words, level
        As for :func:`~tmm_sheets.compare.photo.line_ends.with_ends`.
    """
    groups: list[list[InkTrace]] = []
    for t in with_ends(found, ink, owners, words, level):
        home = next((g for g in groups if any(_one_line(t, other) for other in g)), None)
        if home is None:
            groups.append([t])
        else:
            home.append(t)
    return {t.element.number for g in groups for t in _others(g)}


def _others(some: Sequence[InkTrace]) -> list[InkTrace]:
    """Those of several lines found by one stroke that are less likely it than others of them."""
    ends = np.array([np.abs([by for by in t.ends if np.isfinite(by)]).max(initial=0.0) for t in some])
    stays = np.array([_stays(t) for t in some])
    likely = ends <= ends.min() + ENDS
    likely &= stays <= min(stays[likely].min() + STAYS, ASTRAY)
    return [t for t, may in zip(some, likely, strict=True) if not may]


def _stays(t: InkTrace) -> float:
    """How far the end of a line that is less off is from its place, mm."""
    assert t.at is not None
    return float(np.abs(t.at[[0, -1]] - t.element.points[[0, -1]]).min())


def _one_line(t: InkTrace, other: InkTrace) -> bool:
    """Whether the lines that were found of two elements of a view are one."""
    if t.element.view is not other.element.view or t.at is None or other.at is None:
        return False
    a, b = sampled(t.at, STEP)[0], sampled(other.at, STEP)[0]
    near = np.abs(a[:, None] - b) <= ON
    return bool(max(near.any(1).mean(), near.any(0).mean()) >= OVERLAP_MOSTLY)


INK_SAME = 0.7
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
    return any((np.abs(((z - start) * np.conj(end - start)).imag) <= INK_SAME * abs(end - start)).all()
               and (_along_of_ink(z, start, end).max() > 0) and (_along_of_ink(z, start, end).min() < 1)
               for z, start, end in ((np.array([a, b]), c, d), (np.array([c, d]), a, b)))  # fmt: skip


def _along_of_ink(z: np.ndarray, start: complex, end: complex) -> np.ndarray:
    """Where places lie along a line, from 0 at its beginning to 1 at its end."""
    return np.asarray((z - start) / (end - start)).real


def _moved_end(t: InkTrace, f: InkTrace, moved: Sequence[InkTrace], always: bool = False) -> int | None:
    """The end of a line, 0 or 1, that has moved if the ink by which ``f`` was found is its own; None when it is not.

    Others that end there have moved to the same point of the ink, unless ``always``.
    """
    assert f.at is not None
    z, (a, b) = t.element.points, f.at
    away = ((z - a) * np.conj(b - a)).imag / abs(b - a)
    lie = np.clip(_along_of_ink(z, a, b), 0, 1)
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
    ends = np.abs(g.element.points - z) <= INK_SAME
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
