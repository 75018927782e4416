"""Where lines begin and end, and how large the circles of joints are.

Along a line and beyond its end a place is bare, or its ink is surely the line's own, or it may be another's (a line that crosses
there, a letter). So the line reaches at least to the last ink that is surely its own and at most to the first bare place after
that. It is too long or too short by what both bounds agree on; if its proper end lies between them, nothing is wrong, and if they
are far apart, nothing is known.

Lines that end at a joint fill its circle, and leave little of it alone: what is measured across its line is drawn to its place. But
outside a joint there is paper, and the edge of its ink is seen wherever no other line leaves.

"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element, interruptions, sampled
from tmm_sheets.compare.photo.profiles import HALF, LARGELY, MOSTLY, pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.traces import (
    ELSEWHERE,
    END_STEP,
    FARTHEST_OFF,
    LOOSE_STYLES,
    ONE_POINT,
    PALE,
    SAMPLING,
    STEP,
    InkTrace,
    Paper,
    open_line,
)
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

ASIDE = np.linspace(-0.3, 0.3, 5)  # mm to either side where its ink may be
BESIDE = np.linspace(-0.7, 0.7, 13)  # mm to either side where another's ink may come from; less than a pixel apart
GAP, PATTERN_GAP, BEYOND_GAP = 1.6, 3.5, 0.3
"""mm of bare paper a solid and a dashed line may have along their way, and any line beyond its end, where letters stand near."""
LIFTED, RESTS, DRAWN_TO = 2.6, 1.2, 1.8
"""mm of bare paper a lifted pencil may leave near an end, and least mm of ink, its own or another's, from there to the end; of a
line of a construction: nearer to its end there is the line or curve that it was to be drawn to."""
RESUMED = 4
"""Places in a row with its own ink by which a line goes on after a wider gap than is usual."""
CLEAR = 0.5  # mm outside a line within which its own ink pales
TORN = 0.4  # mm of bare paper beyond which ink that may be another's is another's
VAGUE = 1.2  # mm between the bounds from which on the end is unknown
SEEN, SHARE = 0.6, 0.4  # least mm, and least share, of its own ink beyond the end of a line that is too long
BLUR = 0.25  # mm beyond its end within which ink may be blur
PALER = 0.8  # least mm of pale ink that is nobody else's by which a line goes on to its end: under adhesive tape
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


def with_ends(traces: Sequence[InkTrace], paper: Paper) -> list[InkTrace]:
    """Find the ends of lines.

    Parameters
    ----------
    traces
        Those of open lines; the others are left as they are.
    paper
        What shows.

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
    across = paper.dark(np.hstack((p + n * ASIDE, p - n * aside, p + n * aside)))
    hidden = paper.owners.others(numbers, p + n * BESIDE).any(1) | (sample(paper.words, pixels(p[:, 0])) > 100)
    crowded = paper.owners.others(numbers, p + n * CROWDED).any(1) & paper.owners.others(numbers, p - n * CROWDED).any(1)
    parts = (np.split(part, cuts) for part in (across, hidden, crowded))
    ends = [_end(w, a, h, c, paper.level) for w, a, h, c in zip(ways, *parts, strict=True)]
    for i, k in enumerate(chosen):
        out[k] = replace(traces[k], ends=(ends[2 * i], ends[2 * i + 1]))
    return out


def _ways(t: InkTrace) -> tuple[_Way, _Way]:
    """The ways over the beginning and over the end of a line that was found."""
    assert t.at is not None
    reach = min(FARTHEST_OFF, 0.4 * t.element.length)
    begin, end = t.element.points[[0, -1]]
    gaps = interruptions(t.element)
    back = [(1 - b, 1 - a) for a, b in gaps]
    return (_way(t.element, t.at, reach, _tip(t.element, begin), gaps),
            _way(t.element, t.at[::-1], reach, _tip(t.element, end), back))


def _tip(e: Element, end: complex) -> float | None:
    """Distance from an end to the tip of the arrow there, mm: the line of a curved arrow stops within the head."""
    return min((d for f in e.fills if (d := float(abs(f[0] - end))) < FARTHEST_OFF), default=None) if e.arrow else None


def _way(e: Element, z: Points, reach: float, tip: float | None, gaps: Sequence[tuple[float, float]]) -> _Way:
    """The way over the beginning of a line ``z``, straight on beyond it; ``gaps`` as shares of the line from there."""
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
    u = z[0] - z[min(int(np.searchsorted(run, 1.0)) + 1, len(z) - 1)]
    u /= max(abs(u), 1e-9)
    t = np.arange(-min(reach + 2.0, run[-1] / 2), reach + END_STEP / 2, END_STEP)
    p = np.where(t <= 0, np.interp(-t, run, z.real) + 1j * np.interp(-t, run, z.imag), z[0] + u * np.maximum(t, 0))
    along = np.gradient(p)
    lettered = np.zeros(len(t), bool)
    for a, b in gaps:
        lettered |= (-t >= a * run[-1] - END_STEP) & (-t <= b * run[-1] + END_STEP)
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
        paler = pale[rest].sum() >= max(PALER / END_STEP, LARGELY * (~hidden[rest]).sum())
        faded = way.element.style in LOOSE_STYLES and crowded[rest].sum() > 0.5 * len(crowded[rest]) > 0
        lifted = _pencil_was_lifted(dark[rest], DRAWN_TO if way.element.role == "construction" else RESTS)
        return float("nan") if (len(weak) and weak.mean() > 0.3) or faded or paler or lifted else most - shown
    beyond = least - shown
    seen = own[(t > pen + BLUR) & (t <= least)]
    if beyond > 0 and len(seen) and seen.sum() * END_STEP >= min(SEEN, beyond) and seen.mean() > SHARE:
        return beyond
    return float("nan") if most - min(least, 0.0) > VAGUE else 0.0


def _pencil_was_lifted(rest: Any, least: float) -> bool:
    """Whether between where a line stops and its proper end there is one gap, as by a lifted pencil, and then ink all the way.

    There must be at ``least`` so many mm of that.
    """
    bare = int(np.argmax(rest)) if rest.any() else len(rest)
    return bool(bare * END_STEP <= LIFTED and (len(rest) - bare) * END_STEP >= least and rest[bare:].all())


def _ink_along(way: _Way, across: Any, hidden: Any, level: float) -> tuple[Any, Any, Any]:
    """Where along the way there is ink, where it is the line's own for sure, and where there may be a pale trace of that."""
    across = cv2.blur(across, (1, 3))
    depth, beside = across[:, : len(ASIDE)].max(1), across[:, len(ASIDE) :].max(1)
    hidden = cv2.morphologyEx(hidden.astype(np.uint8)[:, None], cv2.MORPH_CLOSE, np.ones((5, 1), np.uint8))[:, 0] > 0
    plain = (way.t < 0) & ~hidden
    # Other lines make it darker, if anything.
    usual = np.median(depth[plain]) if plain.sum() > 4 else np.percentile(depth[way.t < 0], 20)
    dark = depth > max(level, 0.5 * float(usual))
    clear = ~hidden & (beside < PALE * depth)
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
        if (i - last) * END_STEP > bare + 1e-9:
            break
        last = i
        if own[i]:
            low = i
    if low < 0:  # others hide all of it, and may go on no farther than it does
        return (0, last) if dark[last] else None
    high = low
    for i in (np.flatnonzero(dark[low:]) + low).tolist():
        if (i - high) * END_STEP > torn + 1e-9:
            break
        high = i
    return low, high


RADII = 1.0, 3.0
"""mm between which a circle's radius is that of a joint."""
RAYS = np.exp(2j * np.pi * np.arange(72) / 72)
INWARDS, OUTWARDS, BEYOND = 0.6, 1.3, 2.0
"""mm from the record's radius to where its stroke may begin and may be darkest; and how far is looked."""
ROOM = 5
"""Places and rays to which the ink of others spreads."""
WITHIN, AFTER = 0.2, 0.3
"""mm within the stroke that ends at an edge, beside half its width, and beyond the edge, where others' ink would move it."""
LEAST, EDGE_SPREAD = 6, 0.25
"""Least number of rays on which the edge is nobody else's, and most that half of them may differ by, mm."""
OFF = 0.2
"""mm by which the middle of a circle is usually aside."""
FEW = 3
"""Least number of other joints that tell how much wider a pencil is on this sheet."""


def joint(e: Element) -> bool:
    """Whether an element is the circle of a joint, which a step has left; those about designations none has."""
    return e.kind == "circle" and bool(e.step) and not e.fills and RADII[0] < e.radius < RADII[1]


def with_edges(traces: Sequence[InkTrace], paper: Paper) -> list[InkTrace]:
    """The traces, those of joints that were found in their places with the radius and the middle that their outer edges have."""
    some = [t for t in traces if joint(t.element) and t.status in ("measured", "dense", "shared")]
    seen = {t.element.number: edge for t in some if (edge := _edges(t.element, paper)) is not None}
    usual = max(float(np.median([growth for growth, _ in seen.values()])), 0.0) if len(seen) > FEW else 0.0
    return [_by_edge(t, seen[t.element.number], usual) if t.element.number in seen else t for t in traces]


def _by_edge(t: InkTrace, edge: tuple[float, complex], usual: float) -> InkTrace:
    """The trace of a joint by its ``edge``: how much too far out it is, mm, of which so much is ``usual``, and how far aside.

    Where its line was lost among others, it is known by its edge only if that is too far out.
    """
    e, growth, shift = t.element, edge[0] - usual, edge[1]
    if t.status != "measured" and growth <= t.deviation:
        return t
    at = np.asarray(e.points + shift + growth * (e.points - e.centre) / e.radius)
    return replace(t, status="measured", shift=shift, growth=growth, deviation=max(abs(growth), abs(shift)), at=at, free=1.0)


def _edges(e: Element, paper: Paper) -> tuple[float, complex] | None:
    """How much too far out the outer edge of a joint is, and how far aside its middle, mm; None where too little of it is seen, or
    no circle.
    """
    far = np.arange(0, e.radius + BEYOND, STEP)
    places = e.centre + RAYS[:, None] * far
    others = paper.foreign(e.number, places)
    near = cv2.dilate(np.vstack((others[-ROOM:], others, others[:ROOM])).astype(np.uint8), np.ones((ROOM, ROOM), np.uint8)) > 0
    dark = paper.dark(places).astype(np.float64)
    within = (far > e.radius - INWARDS) & (far < e.radius + OUTWARDS)
    edge, half = np.array([_edge(ray, within) for ray in dark]) * STEP, line_type(e.style).width / 2
    moved_by = (far > edge[:, None] - half - WITHIN) & (far < edge[:, None] + AFTER)
    free = ~(near[ROOM:-ROOM] & moved_by).any(1)
    return _circle(edge[free] - e.radius - half, RAYS[free]) if free.sum() >= LEAST else None


def _edge(ray: Floats, within: Any) -> float:
    """Where on a ray the stroke that is darkest ends, in steps."""
    first = int(np.flatnonzero(within)[0])
    top = first + int(ray[within].argmax())
    paler = np.flatnonzero(ray[top:] < HALF * ray[top])
    return top + int(paler[0]) - 0.5 if len(paler) else float(len(ray))


def _circle(edge: Floats, rays: Any) -> tuple[float, complex] | None:
    """What edges are too far out by on the whole, and how far aside the middle is; None where they are no circle's.

    Seen from one side, a circle may be aside as well as larger: it is off there either way.
    """
    base = np.stack((np.ones(len(edge)), rays.real, rays.imag), -1)
    prior = np.diag([0.0, 1.0, 1.0]) * (EDGE_SPREAD / OFF) ** 2
    growth, x, y = np.linalg.solve(base.T @ base + prior, base.T @ edge).tolist()
    if np.ptp(np.percentile(edge - base @ (growth, x, y), (25, 75))) > EDGE_SPREAD:
        return None
    return growth, complex(x, y)


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
    lines = [e for e in elements if e.kind == "line" and abs(e.points[-1] - e.points[0]) > ONE_POINT]
    ends = np.array([e.points[[0, -1]] for e in lines], complex).reshape(-1, 2)
    ways = (ends[:, 1] - ends[:, 0]) / np.maximum(np.abs(ends[:, 1] - ends[:, 0]), ONE_POINT)

    def right(z: Points, by: float) -> bool:
        """Whether a line whose end and next point are ``z`` may be so much too long there, mm, too short when negative."""
        if not 0 < abs(by) <= AT_JOINT:  # what is not known stays so
            return False
        if (np.abs(joints - z[0]) <= radii + ONE_POINT).any():
            return True
        if not 0 < by <= GATHERED:
            return False
        way = (z[1] - z[0]) / max(abs(z[1] - z[0]), 1e-9)
        here = (np.abs(ends - z[0]) <= ONE_POINT).any(1)
        return bool((np.abs(dots - z[0]) <= ONE_POINT).any() or (np.abs((ways[here] * np.conj(way)).imag) >= ANOTHER_WAY).any())

    out = []
    for t in traces:
        z = t.element.points
        begin, end = (0.0 if right(way, by) else by for way, by in zip((z[:2], z[:-3:-1]), t.ends, strict=True))
        out.append(replace(t, ends=(begin, end)))
    return out


ENDS, STAYS = 1.0, 0.2
"""By how much more than another line's the ends of one, or the better one of them, may be off for it to be the line as well, mm."""
ASTRAY = 2.0
"""mm; of a line that was drawn askew one end is no farther off."""


def resolve_overlaps(found: Sequence[InkTrace], paper: Paper) -> set[int]:
    """Numbers of the elements that were found by ink that is rather another's.

    Parameters
    ----------
    found
        Traces of lines by ink beside the strokes in which they belong.
    paper
        What shows.
    """
    groups: list[list[InkTrace]] = []
    for t in with_ends(found, paper):
        home = next((g for g in groups if any(one_line(t, other) for other in g)), None)
        if home is None:
            groups.append([t])
        else:
            home.append(t)
    return {t.element.number for g in groups for t in _less_likely(g)}


def _less_likely(some: Sequence[InkTrace]) -> list[InkTrace]:
    """Those of several lines found by one stroke that are less likely it than others of them."""
    ends = np.array([np.abs([by for by in t.ends if np.isfinite(by)]).max(initial=0.0) for t in some])
    stays = np.array([_nearer_end_error(t) for t in some])
    likely = ends <= ends.min() + ENDS
    likely &= stays <= min(stays[likely].min() + STAYS, ASTRAY)
    return [t for t, may in zip(some, likely, strict=True) if not may]


def _nearer_end_error(t: InkTrace) -> float:
    """How far the end of a line that is less off is from its place, mm."""
    assert t.at is not None
    return float(np.abs(t.at[[0, -1]] - t.element.points[[0, -1]]).min())


def one_line(t: InkTrace, other: InkTrace) -> bool:
    """Whether the lines that were found of two elements of a view are one."""
    if t.element.view is not other.element.view or t.at is None or other.at is None:
        return False
    a, b = sampled(t.at, SAMPLING)[0], sampled(other.at, SAMPLING)[0]
    near = np.abs(a[:, None] - b) <= ELSEWHERE
    return bool(max(near.any(1).mean(), near.any(0).mean()) >= MOSTLY)
