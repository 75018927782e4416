"""Judging the fit of a map before the drawing is judged by it.

A drawing made badly has single lines in wrong places; a map fitted badly has whole regions of them. So the sheet is cut into
cells, and in each the level and the upright lines are asked apart whether most are where they belong (a map that took a line for
its neighbour is right along it). A region without ink where lines belong is hidden rather than astray. Whole patches that lie
elsewhere, beside others that lie elsewhere alike, are not put down to the drawing either.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.map_fit import SIZE, Seen, fit_map, patches
from tmm_sheets.compare.photo.profiles import HALF, LITTLE, MOSTLY, WHOLE, ProfileLines, inked, peaks, profiles
from tmm_sheets.compare.photo.sheet_map import FRAME, Floats, Map
from tmm_sheets.drawing.marks import Points

CELLS = (8, 6)
"""Cells along the sheet's width and height, some 100 mm each."""
LEAST_POINTS, LEAST_LINES = 15, 3
"""Least points, of so many lines, by which a cell can be judged."""
PART = 50.0
"""mm; lines in a square of this side are near each other."""
ASTRAY = 0.35
"""Share of a cell's points in place below which it is astray."""
LOCAL = 0.07
"""Largest share of cells astray that may be the student's doing: a view in a wrong place."""
STRIP, AT_SIDE, FEW = (100.0, 50.0, 25.0), 2.0, 6
"""Length and depths, mm, of the strips along a side that is not seen; how near to the side a line is the side itself; least number
of points by which a strip can be judged."""
HALVES = 1.5
"""Largest distance, mm, between where maps fitted to either half of the sheet have the line between them."""
MATCH = HALF
"""Least share of a sheet's lines that must be where they belong."""
IN_PLACE, SOUGHT, NEAR = 0.5, 0.8, 3.0
"""mm from its place within which a line is in place, is sought, or has ink near."""
SIDE = MOSTLY
"""Least share of a side's points that must have a line for the side to count as seen."""
SIDES, SIDES_OF_PLACED = 3, 2
"""Least number of sides that must be seen; and where nearly all lines are in place, all over the sheet."""
SHIFTED, ALIKE = 1.5, 0.8
"""mm from its place beyond which a patch is shifted, and by which neighbours that are shifted alike may differ."""
TOGETHER = 3
"""Least number of patches near each other, shifted alike."""
RUN = 8
"""Points of a side by which it is seen how far it is off there."""
OFFSETS = np.arange(-NEAR, NEAR + 0.05, 0.1)


@dataclass(frozen=True)
class FitCheck:
    """What is to be said of a fit.

    Attributes
    ----------
    match : share of the lines' points that have ink where the map has them
    astray : middles of the cells whose lines are elsewhere, mm
    lost : of those, the ones at a side of the frame that is not seen there either
    judged : how many cells could be judged
    halves : how far maps of either half disagree, mm
    together : how far lines near each other are off together, mm
    shifted : middles of the patches that lie elsewhere, each beside others that do so alike, mm
    shift : by how much they do, mm
    sides : share of each side of the frame that has a line where the map has it, bottom first
    rim : how far the frame is off in a part of a side, mm, the most
    """

    match: float
    astray: Points
    lost: Points
    judged: int
    halves: float
    together: float
    sides: Floats
    shifted: Points
    shift: float
    adrift: Points = field(default_factory=lambda: np.zeros(0, complex))
    rim: float = 0.0

    @property
    def acceptable(self) -> bool:
        """Whether the drawing may be judged by the map, if there is no better one."""
        return self.moored and not len(self.adrift)

    @property
    def moored(self) -> bool:
        """Whether all is right but what lies beside a side that is not seen."""
        return (self.match >= MATCH and len(self.astray) <= LOCAL * self.judged and not len(self.lost)
                and not len(self.shifted)
                and int((self.sides >= SIDE).sum()) >= (SIDES_OF_PLACED if self.match >= WHOLE and not len(self.astray) else SIDES))

    @property
    def framed(self) -> bool:
        """Whether all of the frame is seen and lies flat: what is in it and does not match is another drawing, not badly fitted."""
        return float(self.sides.min()) >= WHOLE and self.halves <= 2 * HALVES

    @property
    def sound(self) -> bool:
        """Whether no better map need be sought."""
        close = self.match >= WHOLE
        framed = float(np.sort(self.sides)[4 - SIDES if close else 0]) >= WHOLE  # no other frame brings a hidden side to light
        # Where all the frame is seen and nearly all lines are in place, no other map has those of a cell that are not.
        placed = not len(self.astray) or (close and float(self.sides.min()) >= WHOLE)
        return self.moored and placed and framed and (self.halves <= HALVES or close)


def check(m: Map, straight: Map, sides: Seen, ink: Any, lines: ProfileLines, level: float, scale: float) -> FitCheck:
    """Judge a map.

    Parameters
    ----------
    m
        The map.
    straight, ink, scale
        The picture of ``scale`` pixels per mm that another map straightened, and that map.
    sides
        Points of the frame, as :func:`~tmm_sheets.compare.photo.frame_search.fit_frame` has them.
    lines
        Where lines are on the sheet.
    level
        Darkness of a line.
    """
    at = straight.to_sheet(m.to_picture(lines.points))
    across = profiles(ink, lines, OFFSETS, at - lines.points, scale)
    o, strength = peaks(across, OFFSETS, 0.0, SOUGHT, 0.4)
    good = (strength > level) & (np.abs(o) < IN_PLACE)
    some = (across.max(1) > level) & in_picture(m, lines.points)
    seen = Seen(straight.to_picture(at + lines.normals * o), lines.points, lines.normals, good.astype(float))
    met = _on_sides(m, straight, sides, ink, level, scale)
    astray, judged = _displaced_cells(lines, good, some)
    shares = np.array([part.mean() for part in np.split(met, 4)])
    lost = np.array([z for z in astray if not _frame_is_seen(z, sides.sheet, met)], complex)
    found = FitCheck(float(good.mean()), astray, lost, judged, _between_halves(m, sides, seen), _drift(lines, o, good), shares,
                     np.zeros(0, complex), 0.0, strips_adrift(lines, good, some, shares), rim_error(m, sides))
    if not found.moored:  # refused without that
        return found
    shifted, by = patches_shifted(patches(m, straight, ink, lines, scale), m)
    return replace(found, shifted=shifted, shift=by)


def in_picture(m: Map, p: Points) -> Any:
    """Which points of the sheet are in the picture: beyond its edge the last pixels go on like lines."""
    q = m.to_picture(p) - m.middle
    return (np.abs(q.real) < m.middle.real) & (np.abs(q.imag) < m.middle.imag)


def patches_shifted(seen: Seen, m: Map) -> tuple[Points, float]:
    """The patches that lie elsewhere beside others that do so alike, and by how much, mm, the median."""
    count = len(seen.weight) // 2
    z = seen.sheet[:count]
    by = m.to_sheet(seen.picture[:count]) - z
    off = np.abs(by) > SHIFTED
    z, by = z[off], by[off]
    # Not side by side only: neighbours share lines.
    near = np.abs(z[:, None] - z[None]) < 2.3 * SIZE / 2
    alike = near & (np.abs(by[:, None] - by[None]) < ALIKE)
    some = alike.sum(1) >= TOGETHER
    return z[some], float(np.median(np.abs(by[some]))) if some.any() else 0.0


def _drift(lines: ProfileLines, o: Floats, good: Any) -> float:
    """How far lines near each other are off together, mm: the root mean square of the medians of parts of the sheet."""
    upright = np.abs(lines.normals.real) > np.sqrt(0.5)
    along = o * np.sign(np.where(upright, lines.normals.real, lines.normals.imag))  # to the right or up
    part = (lines.points.real // PART + 100 * (lines.points.imag // PART)) * 2 + upright
    off = [float(np.median(along[here])) for k in np.unique(part[good])
           if (here := good & (part == k)).sum() >= LEAST_POINTS and len(np.unique(lines.line[here])) >= LEAST_LINES]
    return float(np.sqrt(np.mean(np.square(off)))) if off else 0.0


def _on_sides(m: Map, straight: Map, sides: Seen, ink: Any, level: float, scale: float) -> Any:
    """Which points of the frame have a line where the map has them."""
    lines = ProfileLines(sides.sheet, sides.normals, np.zeros(len(sides.sheet), np.int64))
    o, use, _ = inked(ink, lines, SOUGHT, level, straight.to_sheet(m.to_picture(sides.sheet)) - sides.sheet, scale)
    return use & (np.abs(o) < IN_PLACE)


def _displaced_cells(lines: ProfileLines, good: Any, some: Any) -> tuple[Points, int]:
    """Middles of the cells whose lines are elsewhere, and how many cells could be judged."""
    columns, rows = CELLS
    i = np.clip(((lines.points.real - FRAME.x0) / FRAME.width * columns).astype(int), 0, columns - 1)
    j = np.clip(((lines.points.imag - FRAME.y0) / FRAME.height * rows).astype(int), 0, rows - 1)
    cell = j * columns + i
    upright = np.abs(lines.normals.real) > np.sqrt(0.5)
    out, judged = set(), 0
    for way in (upright, ~upright):
        for k in range(columns * rows):
            here = way & (cell == k)
            if here.sum() < LEAST_POINTS or len(np.unique(lines.line[here])) < LEAST_LINES:
                continue
            if some[here].mean() < LITTLE:
                continue
            judged += 1
            if good[here].mean() < ASTRAY:
                out.add(k)
    k_ = np.array(sorted(out), np.int64)
    x, y = (k_ % columns + 0.5) * FRAME.width / columns, (k_ // columns + 0.5) * FRAME.height / rows
    return np.asarray(complex(FRAME.x0, FRAME.y0) + x + 1j * y), judged


def strips_adrift(lines: ProfileLines, good: Any, some: Any, shares: Floats) -> Points:
    """Middles of the strips along unseen sides in which what shows is elsewhere.

    Nothing holds a map there: it may be right in the rest of a cell, and all the more wrong the nearer to the side. Lines along the
    side tell, be it a single one.
    """
    out: list[complex] = []
    p, n = lines.points, lines.normals
    for k in np.flatnonzero(shares < SIDE).tolist():
        across, along = (p.imag, p.real) if k % 2 == 0 else (p.real, p.imag)
        depth = np.abs(across - (FRAME.y0, FRAME.x1, FRAME.y1, FRAME.x0)[k])
        beside = (np.abs(n.imag if k % 2 == 0 else n.real) > np.sqrt(0.5)) & (depth > AT_SIDE)
        place = along // STRIP[0]
        for one in np.unique(place[beside & (depth < STRIP[1])]):
            for deep in STRIP[1:]:
                here = beside & (depth < deep) & (place == one)
                shown = here & some
                if shown.sum() >= FEW and some[here].mean() >= LITTLE and good[shown].mean() < ASTRAY:
                    out.append(complex(p[shown].mean()))
                    break
    return np.array(out, complex)


def rim_error(m: Map, sides: Seen) -> float:
    """How far the frame is off in a part of a side, mm: the largest median of neighbouring points of which most were seen."""
    off = np.real(np.conj(sides.normals) * (m.to_sheet(sides.picture) - sides.sheet)).reshape(-1, RUN)
    seen = (sides.weight > 0).reshape(-1, RUN)
    return max((abs(float(np.median(o[s]))) for o, s in zip(off, seen, strict=True) if s.sum() > RUN / 2), default=0.0)


def _frame_is_seen(z: complex, p: Points, met: Any) -> bool:
    """Whether the frame is seen beside a cell about ``z``; cells that are not at the frame have nothing to be seen."""
    reach = complex(FRAME.width / CELLS[0], FRAME.height / CELLS[1])
    d = p - z
    beside = (np.abs(d.real) < 0.75 * reach.real) & (np.abs(d.imag) < 0.75 * reach.imag)
    return not beside.any() or float(met[beside].mean()) >= HALF


def _between_halves(m: Map, sides: Seen, seen: Seen) -> float:
    """How far nearly flat maps fitted to the left and to the right half disagree along the line between them, mm.

    A map can only bend as paper does; one that is bent to suit a wrong side of the frame is not continued by the other half.
    """
    seam = np.full(9, FRAME.centre.real) + 1j * (FRAME.y0 + np.linspace(0.1, 0.9, 9) * FRAME.height)
    places = []
    for left in (True, False):
        one, other = (s._replace(weight=s.weight * ((s.sheet.real < FRAME.centre.real) == left)) for s in (sides, seen))
        if (other.weight > 0).sum() < 8 * LEAST_POINTS:
            return 0.0
        places.append(m.to_sheet(fit_map(m, one, other, 2, 0.4)[0].to_picture(seam)))
    return float(np.abs(places[0] - places[1]).max())
