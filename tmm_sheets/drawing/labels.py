"""Labels find free places by themselves.

The sheet is rasterised once into two occupancy grids, lines that lettering must never touch (main lines, curves, axes,
fills, other lettering) and thin lines that it had better avoid. Summed-area tables make the ink under any rectangle a
matter of four look-ups, so all candidate places of a label are judged at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.lettering import advance, letter
from tmm_sheets.drawing.marks import Box, Fill, Line, Mark, Points, Text, flat

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

_DISTANCES = (0.0, 0.6, 1.4, 2.5, 4.0, 6.0, 8.5, 11.0, 14.0, 18.0, 23.0)
_DIRECTIONS = np.exp(1j * np.linspace(0, 2 * pi, 24, endpoint=False))


@dataclass(frozen=True)
class Crowded:
    """A label that found no free place; the sheet reports it."""

    text: str
    at: complex


def text_box(mark: Text) -> Points:
    """Corners of the rectangle round a run of text (slanted letters reach a little to the right of their advance)."""
    u = complex(np.cos(mark.angle), np.sin(mark.angle))
    w, h = advance(mark.text, mark.height), mark.height
    drop = -0.3 * h if any(c in "рудцщфgjpqyβγζημξρφχψς,;()" for c in mark.text) else 0.0
    return mark.at + u * np.array([complex(0, drop), complex(w, drop), complex(w + 0.15 * h, h), complex(0, h)])


def place(canvas: Canvas, area: Box) -> list[Crowded]:
    """Set every requested label of the canvas inside ``area``; returns those that found no free place."""
    grid = _Grid(area, canvas.marks)
    crowded = []
    for label in canvas.labels:
        if not _set(canvas, grid, label):
            crowded.append(Crowded(label.text, label.anchor))
    canvas.labels.clear()
    return crowded


class _Grid:
    """Ink on the sheet as two summed-area tables, and the labels set so far."""

    def __init__(self, area: Box, marks: list[Mark]) -> None:
        self.area = area
        shape = (int(area.height / CELL) + 3, int(area.width / CELL) + 3)
        heavy, light = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
        runs: dict[bool, list[Points]] = {True: [], False: []}
        for mark in marks:
            if isinstance(mark, Text):
                self._box(heavy, text_box(mark))
                continue
            if isinstance(mark, Fill):
                points = flat(mark)
                runs[True].append(_sampled(points))
                self._box(heavy, points)
                continue
            runs[mark.style in HEAVY].append(
                _sampled(np.array([mark.a, mark.b])) if isinstance(mark, Line) else _sampled(flat(mark)))
        for kind, target in ((True, heavy), (False, light)):
            if runs[kind]:
                self._ink(target, np.concatenate(runs[kind]))
        # Main lines are up to a millimetre wide: their neighbours count as inked too.
        wide = heavy.copy()
        wide[1:] |= heavy[:-1]
        wide[:-1] |= heavy[1:]
        wide[:, 1:] |= heavy[:, :-1]
        wide[:, :-1] |= heavy[:, 1:]
        self.heavy, self.light = _summed(wide), _summed(light)
        self.boxes: npt.NDArray[np.float64] = np.empty((0, 4))

    def _cells(self, p: Points) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        return ((p.imag - self.area.y0) / CELL).astype(int), ((p.real - self.area.x0) / CELL).astype(int)

    def _ink(self, target: npt.NDArray[np.uint8], p: Points) -> None:
        i, j = self._cells(p)
        ok = (i >= 0) & (i < target.shape[0]) & (j >= 0) & (j < target.shape[1])
        target[i[ok], j[ok]] = 1

    def _box(self, target: npt.NDArray[np.uint8], corners: Points) -> None:
        i0, j0 = (max(int(v), 0) for v in ((corners.imag.min() - self.area.y0) / CELL, (corners.real.min() - self.area.x0) / CELL))
        i1, j1 = (int(v) + 1 for v in ((corners.imag.max() - self.area.y0) / CELL, (corners.real.max() - self.area.x0) / CELL))
        target[i0:max(i1, 0), j0:max(j1, 0)] = 1

    def under(self, table: npt.NDArray[np.int32], x0: Points, y0: Points, x1: Points, y1: Points) -> npt.NDArray[np.int32]:
        """Inked cells under each rectangle."""
        n, m = table.shape
        i0 = np.clip(((y0 - self.area.y0) / CELL).astype(int), 0, n - 1)
        i1 = np.clip(((y1 - self.area.y0) / CELL).astype(int) + 1, 0, n - 1)
        j0 = np.clip(((x0 - self.area.x0) / CELL).astype(int), 0, m - 1)
        j1 = np.clip(((x1 - self.area.x0) / CELL).astype(int) + 1, 0, m - 1)
        return np.asarray(table[i1, j1] - table[i0, j1] - table[i1, j0] + table[i0, j0])


def _summed(cells: npt.NDArray[np.uint8]) -> npt.NDArray[np.int32]:
    # Along rows first: that way both passes run through memory in order (2 million cells a sheet).
    table = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1), np.int32)
    inner = table[1:, 1:]
    np.cumsum(cells, axis=1, dtype=np.int32, out=inner)
    np.cumsum(inner, axis=0, out=inner)
    return table


def _sampled(p: Points) -> Points:
    """Points along a polyline no further apart than half a cell."""
    lengths = np.abs(np.diff(p))
    total = float(lengths.sum())
    if not total > 0:
        return p
    n = int(total / (CELL / 2)) + 2
    along = np.concatenate(([0.0], np.cumsum(lengths)))
    t = np.linspace(0, total, n)
    return np.asarray(np.interp(t, along, p.real) + 1j * np.interp(t, along, p.imag))


def _set(canvas: Canvas, grid: _Grid, label: Label) -> bool:
    laid = letter(label.text, label.height)
    w, h = laid.width + 0.15 * label.height, laid.ascent + laid.descent
    units = _DIRECTIONS if not label.away else _DIRECTIONS * (label.away / abs(label.away))
    turn = np.abs(np.angle(units / units[0])) / pi if label.away else np.zeros(len(units))
    distances = np.array(_DISTANCES) + label.gap
    # The rectangle's support along the direction keeps its nearest corner or side at the asked distance.
    support = np.minimum(w / 2 / np.maximum(np.abs(units.real), 1e-9), h / 2 / np.maximum(np.abs(units.imag), 1e-9))
    centres = (label.anchor + units[None, :] * (distances[:, None] + support[None, :])).ravel()
    # A label that should do without a leader line gets one only when nothing near is free.
    far = 0.0 if label.leader else FAR * (distances - label.gap > NEAR)
    cost = ((distances * 1.2 + far)[:, None] + 4.0 * turn[None, :]).ravel()
    x0, x1 = centres.real - w / 2, centres.real + w / 2
    y0, y1 = centres.imag - h / 2, centres.imag + h / 2
    cost = cost + LIGHT * grid.under(grid.light, x0, y0, x1, y1)
    m = CLEAR
    blocked = grid.under(grid.heavy, x0 - m, y0 - m, x1 + m, y1 + m) > 0
    blocked |= (x0 < grid.area.x0 + 1) | (y0 < grid.area.y0 + 1) | (x1 > grid.area.x1 - 1) | (y1 > grid.area.y1 - 1)
    b = grid.boxes
    if len(b):
        beside = (x0[:, None] - m < b[:, 2]) & (x1[:, None] + m > b[:, 0])
        hit = beside & (y0[:, None] - m < b[:, 3]) & (y1[:, None] + m > b[:, 1])
        blocked |= hit.any(axis=1)
    free = ~blocked
    choice = int(np.argmin(np.where(free, cost, cost + 1e6)))
    centre, found = centres[choice], bool(free[choice])
    if not found:
        return_cost = cost + 20.0 * grid.under(grid.heavy, x0, y0, x1, y1)
        centre = centres[int(np.argmin(return_cost))]
    lower_left = centre - complex(w / 2, h / 2)
    canvas.put(laid, lower_left + 1j * laid.descent)
    grid.boxes = np.vstack((grid.boxes, (lower_left.real, lower_left.imag, lower_left.real + w, lower_left.imag + h)))
    _leader(canvas, label, lower_left, w, h)
    return found


def _leader(canvas: Canvas, label: Label, corner: complex, w: float, h: float) -> None:
    """Thin line from the anchor to the nearest point of lettering that stands too far to be read without one."""
    x = min(max(label.anchor.real, corner.real), corner.real + w)
    y = min(max(label.anchor.imag, corner.imag), corner.imag + h)
    distance = hypot(x - label.anchor.real, y - label.anchor.imag)
    if distance > NEAR + label.gap:
        u = (complex(x, y) - label.anchor) / distance
        # A label that keeps off its anchor stands beside a symbol: the line ends at that symbol's edge, not inside it.
        canvas.line(label.anchor + max(label.gap - BESIDE, 0.0) * u, complex(x, y) - 0.6 * u, "thin")
