"""Straight pieces of many lines, and the placing that brings those of a drawing onto the known ones.

A placing is found by correlating pictures of both (fast Fourier transform) for each plausible scale and quarter turn, then refined
on the lines themselves by a robust fit, in which wrong lines hardly count. Points are complex.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Points

CELL = 3.0
"""Cell size of the pictures that are correlated, mm."""
CELLS = 540
"""Cells along each side of such a picture: drawings larger than 1.6 m are out of the question."""
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


def candidates(theirs: KnownLines, unit: float | None, width: float, sides: Sequence[float]) -> list[float]:
    """Plausible scales, mm per unit of the drawing, the likely ones first.

    Parameters
    ----------
    theirs : the drawing, in its units
    unit : the declared unit, mm, None if there is none
    width : width of the known lines, mm
    sides : lengths of the longest known lines (frame, edge of the paper), mm
    """
    found = [s / x for x in _longest(theirs) for s in sides]
    base = unit or 1.0
    found += [base * k for k in RATIOS]
    found += [k for k in (1.0, 25.4, 1000.0, 10.0, 0.1, 0.001, *RATIOS) if k != base]
    z = np.concatenate((theirs.a, theirs.b))
    for span in (np.ptp(z.real), np.ptp(z.imag)):
        found += [width / float(span)] if span > 0 else []
    size = max(float(high - low) for low, high in (np.quantile(part, (0.02, 0.98)) for part in (z.real, z.imag)))
    good: list[float] = []
    for s in found:
        if 0.15 * width < s * size < 1.7 * width and all(abs(s - g) > 2e-4 * g for g in good):
            good.append(s)
    return good


def _longest(theirs: KnownLines, most: int = 4) -> list[float]:
    """The greatest lengths, each once."""
    found: list[float] = []
    for x in np.sort(theirs.length)[::-1][:40].tolist():
        if all(abs(x - y) > 1e-3 * x for y in found):
            found.append(x)
    return found[:most]


RATIOS = (1.0, 2.0, 0.5, 2.5, 0.4, 4.0, 0.25, 5.0, 0.2, 10.0, 0.1, 20.0, 50.0, 100.0)
"""Scales of GOST 2.302 and their reciprocals: mm of the sheet per mm drawn."""


class FoundPlacing(NamedTuple):
    """A placing with the share of our lines on which it puts lines of theirs."""

    placing: Placing
    share: float


def search(ours: Points, theirs: KnownLines, scales: Sequence[float], turns: Sequence[int] = (0, 1, 3, 2), mirrored: bool = False,
           enough: float = 0.8, tries: int = 8) -> FoundPlacing:
    """The placing, among scales and quarter turns, with which most of our lines lie on theirs.

    Parameters
    ----------
    ours : points along our lines, mm of the sheet
    theirs : their lines, drawing units
    scales, turns : what to try, mm per unit and quarter turns counter-clockwise
    mirrored : whether the drawing is a mirror image
    enough : share at which to stop
    tries : how many of the placings that look best in the pictures to refine
    """
    if not len(ours):
        return FoundPlacing(Placing(mirrored=mirrored), 0.0)
    low = complex(ours.real.min(), ours.imag.min())
    mine = np.fft.rfft2(_grown(_picture(ours, low)))
    picked = ours[:: max(len(ours) // 1500, 1)]
    good: list[tuple[float, Placing]] = []
    best = FoundPlacing(Placing(mirrored=mirrored), 0.0)
    for scale in scales:
        here: list[tuple[float, Placing]] = []
        for quarter in turns:
            placing = Placing(scale * 1j**quarter, 0j, mirrored)
            z = theirs.moved(placing).points(CELL)
            if len(z):
                here += _peaks(mine, z, low, placing)
        good += here
        here.sort(key=lambda peak: -peak[0])
        if here and here[0][0] > 0.5 * enough * len(_cells(ours)):
            trial = refine(picked, theirs, here[0][1], (6.0, 3.0, 1.5), False, 1)
            best = max(best, trial, key=lambda f: f.share)
            if best.share >= enough:
                return best
    good.sort(key=lambda peak: -peak[0])
    for _, placing in good[:tries]:
        best = max(best, refine(picked, theirs, placing, (6.0, 3.0, 1.5), False, 1), key=lambda f: f.share)
        if best.share >= enough:
            break
    return best


def _peaks(mine: npt.NDArray[np.complex128], z: Points, low: complex, placing: Placing,
           most: int = 2) -> list[tuple[float, Placing]]:
    """The best shifts at one scale and turn, each with the number of cells that meet beyond chance."""
    corner = complex(np.quantile(z.real, 0.001), np.quantile(z.imag, 0.001))
    picture = _picture(z, corner)
    product = np.fft.irfft2(mine * np.conj(np.fft.rfft2(picture)), s=(CELLS, CELLS))
    # As many of our cells meet theirs by chance as theirs fill of the ground.
    rows, columns = (max(int(np.ptp(part) / CELL), 1) for part in (z.imag, z.real))
    chance = min(float(picture.sum()) / (rows * columns), 1.0) * float(mine[0, 0].real)
    found = []
    for _ in range(most):
        k = int(product.argmax())
        i, j = divmod(k, CELLS)
        peak = float(product[i, j]) - chance
        r, c = np.arange(i - 2, i + 3) % CELLS, np.arange(j - 2, j + 3) % CELLS
        product[np.ix_(r, c)] = 0.0
        i, j = (i - CELLS if i > CELLS // 2 else i), (j - CELLS if j > CELLS // 2 else j)
        found.append((peak, placing._replace(shift=low - corner + CELL * complex(j, i))))
    return found


def _cells(z: Points) -> npt.NDArray[np.int64]:
    """The cells with points in them, each once."""
    return np.unique((z.imag // CELL).astype(np.int64) * 100_000 + (z.real // CELL).astype(np.int64))


def _picture(z: Points, corner: complex) -> npt.NDArray[np.float64]:
    """1 in the cells with points, 0 elsewhere; the first cell begins at the corner."""
    i, j = ((z.imag - corner.imag) / CELL).astype(int), ((z.real - corner.real) / CELL).astype(int)
    inside = (i >= 0) & (i < CELLS) & (j >= 0) & (j < CELLS)
    cells = np.zeros((CELLS, CELLS))
    cells[i[inside], j[inside]] = 1.0
    return cells


def _grown(cells: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """A picture with at least 0.5 in the neighbours of filled cells."""
    wide = cells.copy()
    for axis in (0, 1):
        for way in (1, -1):
            wide = np.maximum(wide, 0.5 * np.roll(cells, way, axis))
    return wide


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
