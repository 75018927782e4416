"""Stretches of two sets of lines that lie on one another, with the distance between them; arithmetic of such stretches."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.cad.line_fit import KnownLines, hanging_together, shapes

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

    def only(self, keep: npt.NDArray[np.bool_]) -> Overlaps:
        """The rows to keep."""
        ours, s0, s1, theirs, w0, w1, off0, off1 = self
        return Overlaps(ours[keep], s0[keep], s1[keep], theirs[keep], w0[keep], w1[keep], off0[keep], off1[keep])


def together(parts: Sequence[Overlaps]) -> Overlaps:
    """The rows of all."""
    ours, theirs = np.concatenate([p.ours for p in parts]), np.concatenate([p.theirs for p in parts])
    s0, s1, w0, w1, off0, off1 = (np.concatenate([p[k] for p in parts]).astype(float) for k in (1, 2, 4, 5, 6, 7))
    return Overlaps(ours, s0, s1, theirs, w0, w1, off0, off1)


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
    # Where the other line comes nearer than reach.
    k = rise / run
    level = np.abs(k) < 1e-12
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.sort(np.stack((c.real + (-reach - c.imag) / k, c.real + (reach - c.imag) / k)), axis=0)
    lo, hi = np.where(level, lo, np.maximum(lo, t[0])), np.where(level, hi, np.minimum(hi, t[1]))
    keep = (hi - lo > 1e-6) & (~level | (np.abs(c.imag) <= reach))
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


def left(theirs: KnownLines, claimed: Overlaps) -> list[Left]:
    """The stretches of their pieces, longer than LEAST, that no overlap claims."""
    found: list[Left] = []
    order = np.argsort(claimed.theirs, kind="stable")
    j, w0, w1 = claimed.theirs[order], claimed.w0[order].tolist(), claimed.w1[order].tolist()
    first = np.searchsorted(j, np.arange(len(theirs.a) + 1))
    length = theirs.length.tolist()
    for n, (p, q) in enumerate(zip(first.tolist(), first[1:].tolist(), strict=False)):
        if p == q:
            found.append(Left(n, 0.0, length[n]))
            continue
        parts = union(zip(w0[p:q], w1[p:q], strict=True), LEAST)
        found.extend(Left(n, a, b) for a, b in gaps(parts, length[n]) if b - a > LEAST)
    return found


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
    import shapely

    tree = shapely.STRtree(shapes(a, b))
    i, j = tree.query(shapes(a, b), predicate="dwithin", distance=gap)
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
