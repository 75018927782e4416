"""Straight pieces of many lines: stretches that lie on one another, and the placing that brings those of a drawing onto known ones.

A placing is found by laying long lines on each other, then refined on all of them by a robust fit, in which wrong lines hardly
count. Points are complex.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Points

CELL = 3.0
"""How far points may lie from lines, mm, and placings from each other, before they are refined."""
FEW, TRIED, DOUBTLESS = 60, 8, 0.8
"""Points that tell which placings are good, how many of these are refined, and the share of points on lines that is beyond
doubt.
"""
ONE_PLACE = 0.3
"""What lies as near as this, mm, is at one place, or along one line."""
AT_ONCE = 4096
"""Points whose nearest lines are looked for at once: what is about them stays in memory."""
HIT = 1.0
"""Distance, mm, within which a line must pass a point for :meth:`KnownLines.share` to count it."""


@dataclass(frozen=True, eq=False)
class KnownLines:
    """Straight pieces from ``a`` to ``b`` of many lines; ``owner`` is the number of the line each belongs to."""

    a: Points
    b: Points
    owner: npt.NDArray[np.int64]

    @cached_property
    def length(self) -> npt.NDArray[np.float64]:
        """Lengths of the pieces."""
        return np.asarray(np.abs(self.b - self.a))

    @cached_property
    def tree(self) -> Any:
        """The pieces in a spatial index (shapely)."""
        import shapely

        return shapely.STRtree(shapes(self.a, self.b))

    def points(self, step: float) -> Points:
        """Points along the lines about ``step`` apart, at least one on each piece longer than a tenth of that."""
        n = np.ceil(self.length / step).astype(int)
        n[self.length < 0.1 * step] = 0
        k = np.repeat(np.arange(len(n)), n)
        t = (np.arange(len(k)) - np.repeat(np.cumsum(n) - n, n) + 0.5) / n[k]
        return np.asarray(self.a[k] + t * (self.b - self.a)[k])

    def moved(self, placing: Placing) -> KnownLines:
        """The lines moved by a placing."""
        return KnownLines(placing(self.a), placing(self.b), self.owner)

    def only(self, keep: npt.NDArray[np.bool_]) -> KnownLines:
        """The pieces to keep."""
        return KnownLines(self.a[keep], self.b[keep], self.owner[keep])

    def share(self, points: Points, within: float = HIT) -> float:
        """Share of the points, 0 .. 1, that a line passes within a distance."""
        if not len(points) or not len(self.a):
            return 0.0
        return float(self.nearest(points, within)[2].mean())

    def nearest(self, points: Points, within: float) -> tuple[Points, Points, npt.NDArray[np.bool_]]:
        """For each point the nearest point on a line, the direction of that line (unit), and whether there is one near enough."""
        foot, unit, found = points.copy(), np.ones(len(points), complex), np.zeros(len(points), bool)
        for first in range(0, len(points) if len(self.a) else 0, AT_ONCE):
            z = points[first : first + AT_ONCE]
            # All pieces about a point: their distances in one array take a seventh of what the index needs for the nearest.
            i, j = self.tree.query(shapes(z - within * (1 + 1j), z + within * (1 + 1j)))
            if not len(i):
                continue
            a, d = self.a[j], (self.b - self.a)[j]
            size = np.maximum(np.abs(d), 1e-12)
            u = d / size
            from_a = (z[i] - a) * np.conj(u)
            t = np.clip(from_a.real, 0.0, size)
            off = np.abs(from_a - t)
            # Of each point the first piece that is as near as any.
            begin = _begins(i)
            least = np.repeat(np.minimum.reduceat(off, begin), np.diff(np.append(begin, len(i))))
            nearest = np.flatnonzero((off == least) & (least <= within))
            k = nearest[_begins(i[nearest])]
            at = first + i[k]
            foot[at], unit[at], found[at] = a[k] + t[k] * u[k], u[k], True
        return foot, unit, found


def _begins(values: npt.NDArray[np.int64]) -> npt.NDArray[np.intp]:
    """Where runs of equal values begin."""
    return np.flatnonzero(np.concatenate(([True], values[1:] != values[:-1]))[: len(values)])


def shapes(a: Points, b: Points) -> Any:
    """Straight pieces as shapely lines."""
    import shapely

    return shapely.linestrings(np.stack((np.column_stack((a.real, a.imag)), np.column_stack((b.real, b.imag))), axis=1))


def lines(strokes: Iterable[Points]) -> KnownLines:
    """Straight pieces of polylines, without those of zero length."""
    parts = list(strokes)
    if not parts:
        return KnownLines(np.zeros(0, complex), np.zeros(0, complex), np.zeros(0, np.int64))
    a, b = np.concatenate([p[:-1] for p in parts]), np.concatenate([p[1:] for p in parts])
    owner = np.repeat(np.arange(len(parts)), [len(p) - 1 for p in parts])
    keep = a != b
    return KnownLines(a[keep], b[keep], owner[keep])


def hanging_together(count: int, i: npt.NDArray[np.int64], j: npt.NDArray[np.int64]) -> list[npt.NDArray[np.intp]]:
    """Numbers below ``count`` in groups that pairs ``i``, ``j`` hold together."""
    least = np.arange(count)
    while True:
        new = least.copy()
        np.minimum.at(new, i, least[j])
        np.minimum.at(new, j, least[i])
        new = np.minimum(new, new[new])
        if (new == least).all():
            return [np.flatnonzero(least == k) for k in np.unique(least)]
        least = new


RATIOS = (1.0, 2.0, 0.5, 2.5, 0.4, 4.0, 0.25, 5.0, 0.2, 10.0, 0.1, 20.0, 50.0, 100.0)
"""Scales of GOST 2.302 and their reciprocals: mm of the sheet per mm drawn."""


class FoundPlacing(NamedTuple):
    """A placing with the share of our lines on which it puts lines of theirs."""

    placing: Placing
    share: float


def longest(some: KnownLines, most: int) -> KnownLines:
    """The longest pieces."""
    return some.only(np.isin(np.arange(len(some.a)), np.argsort(-some.length)[:most]))


def lay(ours: KnownLines, points: Points, long: KnownLines, theirs: KnownLines, mirrored: bool = False,
        to_scale: bool = False) -> FoundPlacing:
    """The placing that lays one of our lines on a long one of theirs, either way round, and most of our points on lines of theirs.

    A sheet is laid so on a drawing as a plan is on its strokes (:meth:`~tmm_sheets.compare.cad.plan_ink.Figure.places`).

    Parameters
    ----------
    ours, points : lines that may be found whole, and points along all that should be there, mm of the sheet
    long, theirs : those of their lines that ours are laid on, and all, drawing units
    mirrored : whether the drawing is a mirror image
    to_scale : whether their unit is the millimetre of the sheet
    """
    best = FoundPlacing(Placing(mirrored=mirrored), 0.0)
    long = long.moved(Placing(mirrored=mirrored))
    i, j = (x.ravel() for x in np.meshgrid(np.arange(len(ours.a)), np.arange(len(long.a)), indexing="ij"))
    if not len(i) or len(points) < 2:
        return best
    turn = (ours.b - ours.a)[i] / (long.b - long.a)[j]
    shift = np.concatenate((ours.a[i] - turn * long.a[j], ours.b[i] + turn * long.a[j]))
    turn = np.concatenate((turn, -turn))
    size = float(np.ptp(long.a.real) + np.ptp(long.a.imag)) / float(np.ptp(points.real) + np.ptp(points.imag))
    ok = (np.abs(turn) * size > 0.05) & (np.abs(turn) * size < 2.0)
    ok &= ~np.full(len(turn), to_scale) | (np.abs(np.abs(turn) - 1) < NEARLY)
    turn, shift = turn[ok], shift[ok]
    at = (turn * long.a.mean() + shift) / CELL
    alike = np.round(np.stack((300 * np.log(np.abs(turn)), 300 * np.angle(turn), at.real, at.imag)))
    turn, shift = (x[np.unique(alike, axis=1, return_index=True)[1]] for x in (turn, shift))
    found = [Placing(complex(t), complex(d), mirrored) for t, d in zip(turn, shift, strict=True)]
    few, many = points[:: max(len(points) // FEW, 1)], points[:: max(len(points) // 1500, 1)]
    found.sort(key=lambda placing: -theirs.share(placing.back(few), CELL / placing.scale))
    for placing in found[:TRIED]:
        best = max(best, refine(many, theirs, placing, (6.0, 3.0, 1.5), False, 1), key=lambda f: f.share)
        if best.share >= DOUBTLESS:
            break
    return best


def refine(ours: Points, theirs: KnownLines, start: Placing, reaches: Sequence[float] = (3.0, 1.5, 0.8, 0.4, 0.25),
           free: bool = True, rounds: int = 2) -> FoundPlacing:
    """Fit a placing so that our points lie on the nearest lines of theirs; wrong lines hardly count.

    Parameters
    ----------
    ours : points along our lines, mm of the sheet
    theirs : their lines, drawing units
    start : a placing good to the first of ``reaches``
    reaches : how far from a point to look for a line, in turn, mm
    free : whether scale and angle are fitted as well as the shift
    rounds : fits at each reach
    """
    placing = start
    scale = placing.scale
    for reach in reaches:
        for _ in range(rounds):
            # Our points are taken to their lines rather than the reverse, so that the spatial index is built once.
            z = placing.back(ours)
            foot, unit, found = theirs.nearest(z, reach / scale)
            if found.sum() < 8:
                return FoundPlacing(placing, 0.0)
            at, foot_mm = ours[found], placing(foot[found])
            direction = placing.turn / scale * (np.conj(unit[found]) if placing.mirrored else unit[found])
            n = 1j * direction
            off = ((foot_mm - at) * np.conj(n)).real
            # Least absolute deviations: if most lines are exact, the others have no influence.
            weight = 1 / np.maximum(np.abs(off), 0.01 * reach + 1e-4)
            middle = complex(at.mean())
            r = foot_mm - middle
            columns = [n.real, n.imag]
            if free:
                columns += [((1j * r) * np.conj(n)).real, (r * np.conj(n)).real]
            m = np.column_stack(columns)
            w = np.sqrt(weight)
            step = np.linalg.lstsq(m * w[:, None], -off * w, rcond=1e-9)[0]
            shift = complex(step[0], step[1])
            turn = 1 + complex(step[3], step[2]) if free else 1 + 0j
            # z' = middle + turn (z - middle) + shift
            placing = Placing(turn, middle - turn * middle + shift).after(placing)
            scale = placing.scale
    _, _, found = theirs.nearest(placing.back(ours), HIT / scale)
    return FoundPlacing(placing, float(found.mean()))


def snapped(ours: Points, theirs: KnownLines, fitted: Placing, unit: float | None) -> Placing:
    """A fitted placing with the round scale and angle it nearly has, and the shift fitted again."""
    angle = float(np.angle(fitted.turn))
    quarter = round(angle / (np.pi / 2))
    turn = 1j**quarter if abs(angle - quarter * np.pi / 2) < NEARLY else complex(np.exp(1j * angle))
    bases = dict.fromkeys((unit or 1.0, 1.0, 1000.0, 10.0, 25.4, 0.1, 0.001))
    near = (base * ratio for base in bases for ratio in RATIOS if abs(fitted.scale / (base * ratio) - 1) < NEARLY)
    scale = next(near, None)
    new = (scale or fitted.scale) * turn
    middle = complex(ours.mean())
    z = fitted.back(middle)
    snap = Placing(new, middle - new * (np.conj(z) if fitted.mirrored else z), fitted.mirrored)
    return snap if scale is None else refine(ours, theirs, snap, (0.5, 0.25, 0.1), False, 3).placing


NEARLY = 4e-4
"""Relative error of a scale, or error of an angle, rad, that is taken for rounding (0.3 mm over the sheet)."""


Numbers = npt.NDArray[np.float64]
Interval = tuple[float, float]

LEAST = 0.05
"""Shortest stretch of ink that counts, mm."""
MOST = 3000
"""Pieces that are put together to straight lines, the longest of a drawing."""
STEEP = 0.4
"""Greatest slope between short pieces of what may be one line (chords of a circle, divided in two ways)."""
FLAT = 0.03
"""The same between long ones."""


class Overlaps(NamedTuple):
    """Stretches that lie on one another, one row each; arrays of one length.

    Attributes
    ----------
    ours, theirs : numbers of the two pieces
    s0, s1 : where the stretch begins and ends along our piece, mm
    w0, w1 : the same along theirs, ascending
    off0, off1 : how far to the left of our piece theirs is at ``s0`` and ``s1``, mm
    """

    ours: npt.NDArray[np.int64]
    s0: Numbers
    s1: Numbers
    theirs: npt.NDArray[np.int64]
    w0: Numbers
    w1: Numbers
    off0: Numbers
    off1: Numbers

    @property
    def inked(self) -> list[tuple[int, float, float]]:
        """Their pieces, and from where to where along each."""
        return list(zip(self.theirs.tolist(), self.w0.tolist(), self.w1.tolist(), strict=True))

    def only(self, keep: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> Overlaps:
        """The rows to keep."""
        return Overlaps._make(x[keep] for x in self)


def overlaps(ours: KnownLines, theirs: KnownLines, reach: float, steep: float = STEEP, flat: float = FLAT) -> Overlaps:
    """Stretches of two sets of straight pieces that run within ``reach`` mm of each other in nearly the same direction."""
    i, j = theirs.tree.query(shapes(ours.a, ours.b), predicate="dwithin", distance=reach)
    size = ours.length[i]
    u = (ours.b - ours.a)[i] / size
    c, d = (theirs.a[j] - ours.a[i]) * np.conj(u), (theirs.b[j] - ours.a[i]) * np.conj(u)
    flip = d.real < c.real
    c, d = np.where(flip, d, c), np.where(flip, c, d)
    run, rise = d.real - c.real, d.imag - c.imag
    short = np.minimum(size, theirs.length[j])
    limit = np.clip(2 * reach / short, flat, steep)
    keep = (np.abs(rise) <= limit * run) & (run > 1e-9)
    i, j, c, run, rise, flip, size = (x[keep] for x in (i, j, c, run, rise, flip, size))
    lo, hi = np.maximum(c.real, 0.0), np.minimum(c.real + run, size)
    # Where the other line comes nearer than reach; of a parallel one all or nothing.
    k = rise / run
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.sort(np.stack((c.real + (-reach - c.imag) / k, c.real + (reach - c.imag) / k)), axis=0)
    lo, hi = np.maximum(lo, t[0]), np.minimum(hi, t[1])
    keep = hi - lo > 1e-6
    i, j, c, run, k, flip, lo, hi = (x[keep] for x in (i, j, c, run, k, flip, lo, hi))
    whole = theirs.length[j]
    w0, w1 = (lo - c.real) / run * whole, (hi - c.real) / run * whole
    w0, w1 = np.where(flip, whole - w1, w0), np.where(flip, whole - w0, w1)
    return Overlaps(i, lo, hi, j, w0, w1, c.imag + k * (lo - c.real), c.imag + k * (hi - c.real))


def union(parts: Iterable[Interval], gap: float = 0.0) -> list[Interval]:
    """The union of intervals, across gaps up to ``gap``."""
    merged: list[Interval] = []
    for a, b in sorted(parts):
        if merged and a <= merged[-1][1] + gap:
            if b > merged[-1][1]:
                merged[-1] = (merged[-1][0], b)
        else:
            merged.append((a, b))
    return merged


def gaps(parts: Sequence[Interval], whole: float) -> list[Interval]:
    """What disjoint ascending intervals leave of 0 .. ``whole``."""
    edges = [0.0, *(x for part in parts for x in part), whole]
    return [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b > a]


def extent(parts: Iterable[Interval]) -> float:
    """Length of intervals together."""
    return sum(b - a for a, b in parts)


def common(one: Iterable[Interval], other: Sequence[Interval]) -> list[Interval]:
    """Where both are."""
    found = [(max(a, c), min(b, d)) for a, b in one for c, d in other]
    return sorted((a, b) for a, b in found if b - a > 1e-6)


class Left(NamedTuple):
    """An unclaimed stretch of their lines: the number of the piece and the interval along it, mm."""

    piece: int
    a: float
    b: float


def left(theirs: KnownLines, claimed: Mapping[int, Sequence[Interval]]) -> list[Left]:
    """What claims, by the numbers of the pieces, leave of their pieces: whole ones, and stretches longer than LEAST."""
    return [Left(n, a, b) for n, size in enumerate(theirs.length.tolist()) for a, b in gaps(union(claimed.get(n, ()), LEAST), size)
            if b - a > LEAST or b - a == size]


def pieces(theirs: KnownLines, rest: Sequence[Left]) -> KnownLines:
    """Unclaimed stretches as lines; each has the number of its piece as owner."""
    n = np.array([r.piece for r in rest], dtype=np.int64)
    a, b = np.array([r.a for r in rest], dtype=float), np.array([r.b for r in rest], dtype=float)
    unit = (theirs.b - theirs.a)[n] / np.maximum(theirs.length[n], 1e-12)
    return KnownLines(theirs.a[n] + a * unit, theirs.a[n] + b * unit, n)


class OverlapRun(NamedTuple):
    """A straight line made of collinear pieces; ``parts`` are their numbers."""

    a: complex
    b: complex
    parts: tuple[int, ...]


def runs(rest: KnownLines, gap: float) -> list[OverlapRun]:
    """Straight lines made of collinear pieces with gaps up to ``gap`` mm, of the longest MOST pieces only."""
    n = np.flatnonzero(rest.length > 0.3)
    if len(n) > MOST:
        n = np.sort(n[np.argsort(-rest.length[n])[:MOST]])
    if not len(n):
        return []
    a, b = rest.a[n], rest.b[n]
    u = (b - a) / np.abs(b - a)
    i, j = KnownLines(a, b, n).tree.query(shapes(a, b), predicate="dwithin", distance=gap)
    both = i < j
    i, j = i[both], j[both]
    c, d = (a[j] - a[i]) * np.conj(u[i]), (b[j] - a[i]) * np.conj(u[i])
    size = np.minimum(np.abs(b - a)[i], np.abs(b - a)[j])
    near = np.maximum(np.abs(c.imag), np.abs(d.imag)) < 0.03 + 0.002 * np.maximum(np.abs(c), np.abs(d)) * (size < 50)
    near &= np.abs((u[j] * np.conj(u[i])).imag) < np.maximum(0.002, 0.02 / size)
    found = []
    for members in hanging_together(len(n), i[near], j[near]):
        longest = members[np.abs(b - a)[members].argmax()]
        ends = np.concatenate((a[members], b[members]))
        t = ((ends - a[longest]) * np.conj(u[longest])).real
        found.append(OverlapRun(complex(ends[t.argmin()]), complex(ends[t.argmax()]), tuple(n[members].tolist())))
    return found
