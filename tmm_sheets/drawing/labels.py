"""Labels find free places by themselves.

The sheet is rasterised once into two occupancy grids, lines that lettering must never touch (main lines, curves, axes,
fills, other lettering) and thin lines that it had better avoid. Summed-area tables make the ink under any rectangle a
matter of four look-ups, so all candidate places of a label are judged at once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import owners
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.lettering import advance, letter
from tmm_sheets.drawing.marks import Box, Fill, Line, Mark, Points, Text, flat
from tmm_sheets.words import tell

CELL = 0.5
"""Size of a grid cell, mm."""
HEAVY = {"main", "curve", "vector", "axis", "hidden", "text"}
"""Line types that lettering must not cross."""
NEAR = 5.0
"""Clear distance, mm, up to which a label is read without a leader line."""
CLEAR = 0.4
"""Clear margin kept round lettering, mm."""
LIGHT = 0.9
"""Cost of a grid cell of thin line under lettering, in millimetres of distance."""

FAR = 1e3
"""Cost of a place that needs a leader line, for labels that should have none."""

BESIDE = 1.2
"""Clear distance, mm, between a symbol, such as a hinge, and its letter."""

_DISTANCES = np.array([0.0, 0.6, 1.4, 2.5, 4.0, 6.0, 8.5, 11.0, 14.0, 18.0, 23.0])
_DIRECTIONS = np.exp(1j * np.linspace(0, 2 * pi, 24, endpoint=False))
_TURNING = 4.0 * np.abs(np.angle(_DIRECTIONS)) / pi
"""Cost of each direction, the first being the one asked for."""
_MARGIN = CLEAR * np.array([-1.0, -1.0, 1.0, 1.0])[:, None]
_ALONG = np.linspace(0, 1, 24)[:, None]
_FIRST_BEYOND = np.array([0, 0, 1, 1])[:, None]
"""A rectangle's cells: from the one its lower left corner is in to the one after that of its upper right corner."""


@dataclass(frozen=True)
class Crowded:
    """A label that found no free place; the sheet reports it."""

    text: str
    at: complex

    def __str__(self) -> str:
        return tell('no free place for "{text}" at ({x:.0f}, {y:.0f}): it stands over lines').format(
            text=self.text, x=self.at.real, y=self.at.imag
        )


@dataclass(frozen=True)
class Shortened(Crowded):
    """A text of the title block that was too long for its cell."""

    def __str__(self) -> str:
        return tell('the title block has no room for all of "{text}": shorten it').format(text=self.text)


def text_box(mark: Text) -> Points:
    """Corners of the rectangle round a run of text (slanted letters reach a little to the right of their advance)."""
    u = complex(np.cos(mark.angle), np.sin(mark.angle))
    w, h = advance(mark.text, mark.height), mark.height
    drop = -0.3 * h if any(c in "рудцщфgjpqyβγζημξρφχψς,;()" for c in mark.text) else 0.0
    return mark.at + u * np.array([complex(0, drop), complex(w, drop), complex(w + 0.15 * h, h), complex(0, h)])


def place(canvas: Canvas, area: Box) -> list[Crowded]:
    """Set every requested label of the canvas inside ``area``; returns those that found no free place."""
    grid, ink = Grid(area, canvas.marks), owners.Ink(canvas.marks)
    crowded = []
    for label in canvas.labels:
        if not _set(canvas, grid, ink, label):
            crowded.append(Crowded(label.text, label.anchor))
    canvas.labels.clear()
    return crowded


class Grid:
    """Ink on the sheet as two summed-area tables, and the labels set so far."""

    def __init__(self, area: Box, marks: list[Mark]) -> None:
        self.area = area
        shape = (int(area.height / CELL) + 3, int(area.width / CELL) + 3)
        heavy, light = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
        runs: dict[bool, list[Points]] = {True: [], False: []}
        for mark in marks:
            if isinstance(mark, Text):
                self._box(heavy, text_box(mark))
            elif isinstance(mark, Line):
                runs[mark.style in HEAVY].append(np.array([mark.a, mark.b]))
            else:
                points = flat(mark)
                if isinstance(mark, Fill):
                    self._box(heavy, points)
                runs[isinstance(mark, Fill) or mark.style in HEAVY].append(points)
        for kind, target in ((True, heavy), (False, light)):
            if runs[kind]:
                self._ink(target, _sampled(runs[kind]))
        # Main lines are up to a millimetre wide: their neighbours count as inked too.
        wide = heavy.copy()
        wide[1:] |= heavy[:-1]
        wide[:-1] |= heavy[1:]
        wide[:, 1:] |= heavy[:, :-1]
        wide[:, :-1] |= heavy[:, 1:]
        self.heavy, self.light = _summed(wide), _summed(light)
        self._corner = np.array([area.x0, area.y0] * 2)[:, None]
        self.inside = np.array([area.x0 + 1, area.y0 + 1, area.x1 - 1, area.y1 - 1])[:, None]
        self._last = np.array([shape[1], shape[0]] * 2)[:, None]
        self.boxes: npt.NDArray[np.float64] = np.empty((0, 4))

    def _ink(self, target: npt.NDArray[np.uint8], p: Points) -> None:
        i, j = ((p.imag - self.area.y0) / CELL).astype(int), ((p.real - self.area.x0) / CELL).astype(int)
        ok = (i >= 0) & (i < target.shape[0]) & (j >= 0) & (j < target.shape[1])
        target[i[ok], j[ok]] = 1

    def _box(self, target: npt.NDArray[np.uint8], corners: Points) -> None:
        x, y = corners.real.tolist(), corners.imag.tolist()  # four numbers: quicker without arrays
        i0, j0 = max(int((min(y) - self.area.y0) / CELL), 0), max(int((min(x) - self.area.x0) / CELL), 0)
        i1, j1 = int((max(y) - self.area.y0) / CELL) + 1, int((max(x) - self.area.x0) / CELL) + 1
        target[i0:max(i1, 0), j0:max(j1, 0)] = 1

    def under(self, table: npt.NDArray[np.int32], sides: npt.NDArray[np.float64]) -> npt.NDArray[np.int32]:
        """Inked cells under rectangles; ``sides`` are their x0, y0, x1, y1, shape (4, n)."""
        cells = ((sides - self._corner) / CELL).astype(int) + _FIRST_BEYOND
        j0, i0, j1, i1 = np.minimum(np.maximum(cells, 0), self._last)
        return np.asarray(table[i1, j1] - table[i0, j1] - table[i1, j0] + table[i0, j0])


def _summed(cells: npt.NDArray[np.uint8]) -> npt.NDArray[np.int32]:
    table = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1), np.int32)
    np.cumsum(cells, axis=1, dtype=np.int32, out=table[1:, 1:])
    for i in range(1, len(table)):  # row upon row: three times quicker than another cumsum, which walks down columns
        table[i] += table[i - 1]
    return table


def _sampled(lines: list[Points]) -> Points:
    """Points along polylines no further apart than half a cell, all lines in one go."""
    counts = np.array([len(p) for p in lines])
    p = np.concatenate(lines)
    first = np.cumsum(counts) - counts
    steps = np.abs(np.diff(p, prepend=p[:1]))
    steps[first] = 1.0  # a gap between one line and the next: only their own points are looked up
    along = np.cumsum(steps)
    start, total = along[first], along[first + counts - 1] - along[first]
    n = (total / (CELL / 2)).astype(int) + 2
    line = np.repeat(np.arange(len(lines)), n)
    k = np.arange(n.sum()) - np.repeat(np.cumsum(n) - n, n)
    t = start[line] + total[line] * (k / (n - 1)[line])
    return np.asarray(np.interp(t, along, p.real) + 1j * np.interp(t, along, p.imag))


class _Places:
    """Where a label may stand about its anchor: rectangles ``sides`` (x0, y0, x1, y1; shape (4, n)), their ``cost``, and
    numbers of the ``free`` ones, the cheapest first.
    """

    def __init__(self, grid: Grid, label: Label, w: float, h: float) -> None:
        self.label, self._grid = label, grid
        units = _DIRECTIONS if not label.away else _DIRECTIONS * (label.away / abs(label.away))
        distances = _DISTANCES + label.gap
        # The rectangle's support along the direction keeps its nearest corner or side at the asked distance.
        support = np.minimum(w / 2 / np.maximum(np.abs(units.real), 1e-9), h / 2 / np.maximum(np.abs(units.imag), 1e-9))
        centres = (label.anchor + units[None, :] * (distances[:, None] + support[None, :])).ravel()
        # A label that should do without a leader line gets one only when nothing near is free.
        far = 0.0 if label.leader else FAR * (_DISTANCES > NEAR)
        cost = (distances * 1.2 + far)[:, None]
        cost = (cost + _TURNING if label.away else np.repeat(cost, len(units), axis=1)).ravel()
        sides = np.array([centres.real - w / 2, centres.imag - h / 2, centres.real + w / 2, centres.imag + h / 2])
        clear = x0, y0, x1, y1 = sides + _MARGIN
        blocked = grid.under(grid.heavy, clear) > 0
        blocked |= (sides[:2] < grid.inside[:2]).any(axis=0) | (sides[2:] > grid.inside[2:]).any(axis=0)
        b = grid.boxes
        b = b[(b[:, 2] > x0.min()) & (b[:, 0] < x1.max()) & (b[:, 3] > y0.min()) & (b[:, 1] < y1.max())]  # few are so near
        if len(b):
            beside = (x0[:, None] < b[:, 2]) & (x1[:, None] > b[:, 0])
            blocked |= (beside & (y0[:, None] < b[:, 3]) & (y1[:, None] > b[:, 1])).any(axis=1)
        self.sides, self.cost = sides, cost + LIGHT * grid.under(grid.light, sides)
        free = np.flatnonzero(~blocked)
        self.free = free[np.argsort(self.cost[free], kind="stable")]

    def read(self, here: owners.Round, leaders: bool = True) -> int | None:
        """The cheapest free place where the label reads as what it names, or has a leader that meets no lettering.

        A leader that crosses a strong line, or runs along any, is taken only where there is no other way.
        """
        poor = None
        for k in map(int, self.free):
            box = Box(*self.sides[:, k].tolist())
            if not _led(self.label, box):
                if not here.reads(box):
                    return k
            elif leaders and not _over_lettering(self._grid, *_way(self.label, box)):
                if here.leads(*_way(self.label, box)):
                    return k
                poor = k if poor is None else poor
        return poor

    def least(self) -> int:
        """The cheapest place, or where none is free the one that is least inked."""
        if len(self.free):
            return int(self.free[0])
        return int(np.argmin(self.cost + 20.0 * self._grid.under(self._grid.heavy, self.sides)))


def _set(canvas: Canvas, grid: Grid, ink: owners.Ink, label: Label) -> bool:
    laid = letter(label.text, label.height)
    w, h = laid.width + 0.15 * label.height, laid.ascent + laid.descent
    label, box, found = _placed(grid, ink, label, w, h)
    canvas.of, first = label.of, len(canvas.marks)
    with canvas.traced("text", *(label.by[1:] if label.by is not None else ())):
        canvas.put(laid, complex(box.x0, box.y0 + laid.descent), 0.0, label.text)
        grid.boxes = np.vstack((grid.boxes, box))
        _leader(canvas, label, box)
    ink.add([m for m in canvas.marks[first:] if isinstance(m, Line) and m.style != "text"])
    if len(canvas.marks) > first:
        # The leader line belongs to its label.
        canvas.groups[-1] = canvas.groups[-1]._replace(end=len(canvas.marks), part=label.part, anchor=label.anchor)
    return found


def _placed(grid: Grid, ink: owners.Ink, label: Label, w: float, h: float) -> tuple[Label, Box, bool]:
    """Place of a label, which may have moved along the vector it names rather than have a leader; whether there is room for it."""
    places = _Places(grid, label, w, h)
    here = owners.Round(ink, label, 2 * (NEAR + label.gap) + w)
    k = places.read(here)
    if k is None or _led(label, Box(*places.sides[:, k])):
        for anchor in here.along():
            moved = replace(label, anchor=anchor)
            others = _Places(grid, moved, w, h)
            there = others.read(owners.Round(ink, moved, 2 * (NEAR + label.gap) + w), leaders=False)
            if there is not None:
                return moved, Box(*others.sides[:, there]), True
    return label, Box(*places.sides[:, places.least() if k is None else k]), bool(len(places.free))


def _led(label: Label, box: Box) -> bool:
    """Whether lettering there stands too far to be read without a leader."""
    a, b = _way(label, box)
    return abs(b - a) > NEAR + label.gap


def _way(label: Label, box: Box) -> tuple[complex, complex]:
    """From the anchor to the nearest point of the lettering."""
    return label.anchor, box.nearest(label.anchor)


def _over_lettering(grid: Grid, a: complex, b: complex) -> bool:
    x0, y0, x1, y1 = grid.boxes.T
    if not len(x0):
        return False
    p = a + _ALONG * (b - a)
    return bool(((p.real > x0) & (p.real < x1) & (p.imag > y0) & (p.imag < y1)).any())


def _leader(canvas: Canvas, label: Label, box: Box) -> None:
    """Thin line from the anchor to the nearest point of lettering that stands too far to be read without one."""
    if _led(label, box):
        _, end = _way(label, box)
        u = (end - label.anchor) / abs(end - label.anchor)
        # A label that keeps off its anchor stands beside a symbol: the line ends at that symbol's edge, not inside it.
        canvas.line(label.anchor + max(label.gap - BESIDE, 0.0) * u, end - 0.6 * u, "thin")
