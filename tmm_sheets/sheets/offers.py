"""Views for the room that a sheet has left, found on the ink of the others; in the order in which its arrangement offers them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.evenness import dense
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Mark, Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.sheets.arrangement import View

if TYPE_CHECKING:
    from tmm_sheets.project import Project

Cells = NDArray[np.bool_]
"""Of each cell of the sheet, by columns from the left and rows from below, whether it is taken."""
CELL = 2.0
"""Side of the cells in which room is looked for, mm."""
TITLE = 3.0
"""Depth of the middle of a title under its upper edge, mm."""
REACH = 2.0
"""How far a label may stand off beyond its gap, mm."""
APART = (12.0, 9.0, 6.0)
"""Distances from all else with which a place is looked for, mm: the widest first."""


def draw(project: Project, canvas: Canvas, offered: Sequence[View], inside: Box, closed: Sequence[Box]) -> None:
    """Draw those of the offered views that find room ``inside`` the sheet, away from boxes ``closed`` to them.

    A view ``module.function`` tells its sizes, from what it wants down to what it can do with, by ``module.function_sizes``; none
    where it has nothing to show.
    """
    taken, counted = _closed(inside, closed), 0
    for view in offered:
        module, _, function = view.draw.partition(".")
        room = import_module(f"tmm_sheets.sheets.{module}")
        sizes: Callable[..., Sequence[tuple[float, float]]] = getattr(room, f"{function}_sizes")
        try:
            wanted = sizes(project, canvas, view.options)
        except CannotBuild:
            continue  # what it shows cannot be had; the views that need it have said so
        if not wanted:
            continue
        taken |= _inked(canvas, inside, counted)
        counted = len(canvas.parts)  # what is drawn already stays as it is
        box = _place(taken, wanted, inside)
        if box is not None:
            canvas.of = view.draw
            canvas.begin(box, "", view.draw)
            getattr(room, function)(project, canvas, box, view.options)


def _place(taken: Cells, sizes: Sequence[tuple[float, float]], inside: Box) -> Box | None:
    """The first of the sizes for which there is room, where it is farthest from all else."""
    table = np.zeros((taken.shape[0] + 1, taken.shape[1] + 1), np.int64)
    table[1:, 1:] = taken.cumsum(axis=0).cumsum(axis=1)
    for width, height in sizes:
        for apart in APART:
            nx, ny = (int(np.ceil((length + 2 * apart) / CELL)) for length in (width, height))
            if nx >= table.shape[0] or ny >= table.shape[1]:
                continue
            free = np.argwhere(table[nx:, ny:] - table[:-nx, ny:] - table[nx:, :-ny] + table[:-nx, :-ny] == 0)
            if len(free):
                # In the middle of the room there is, if it is one; else at its beginning.
                i, j = free[np.argmin(np.abs(free - np.median(free, axis=0)).sum(axis=1))]
                corner = complex(inside.x0 + i * CELL + apart, inside.y0 + j * CELL + apart)
                return Box(corner.real, corner.imag, corner.real + width, corner.imag + height)
    return None


def _closed(inside: Box, closed: Sequence[Box]) -> Cells:
    """Cells of the sheet within some boxes."""
    taken = np.zeros(tuple(int(length / CELL) for length in (inside.width, inside.height)), bool)
    for box in closed:
        i0, i1 = (int((x - inside.x0) / CELL) for x in (box.x0, box.x1))
        j0, j1 = (int((y - inside.y0) / CELL) for y in (box.y0, box.y1))
        taken[max(i0, 0):i1 + 1, max(j0, 0):j1 + 1] = True
    return taken


def _inked(canvas: Canvas, inside: Box, first: int) -> Cells:
    """Cells of the sheet with ink of the parts from ``first`` on, or between the ink of one of them: within its picture nothing
    else may stand.
    """
    taken = _closed(inside, ())
    for marks, labels, titled in _parts(canvas, first):
        points = [*(dense(mark, CELL) for mark in marks), *map(_about, labels)]
        if not points:
            continue
        z = np.concatenate([*points, _over(points)] if titled else points)
        i, j = ((z.real - inside.x0) / CELL).astype(int), ((z.imag - inside.y0) / CELL).astype(int)
        there = (i >= 0) & (i < taken.shape[0]) & (j >= 0) & (j < taken.shape[1])
        if there.any():
            i, j = i[there], j[there]
            own = np.zeros((int(np.ptp(i)) + 1, int(np.ptp(j)) + 1), bool)
            own[i - i.min(), j - j.min()] = True
            taken[i.min():i.max() + 1, j.min():j.max() + 1] |= _between(own, 0) | _between(own, 1)
    return taken


def _parts(canvas: Canvas, start: int) -> Iterator[tuple[list[Mark], list[Label], bool]]:
    """Marks of each part of a view from one on, the labels that it has asked for, and whether it has a title."""
    ends = [*(part.first for part in canvas.parts), len(canvas.marks)]
    for k, (first, end) in enumerate(pairwise(ends)):
        if k >= start and canvas.parts[k].draw != "title block":
            yield canvas.marks[first:end], [label for label in canvas.labels if label.part == k], bool(canvas.parts[k].title)


def _over(points: Sequence[Points]) -> Points:
    """Points along the title of a part, as wide as the part is: between a title and its picture nothing else may stand."""
    z = np.concatenate(points)
    return np.array([complex(x, z.imag.max() - TITLE) for x in (z.real.min(), z.real.max())])


def _about(label: Label) -> Points:
    """Points about a label's anchor as far away as its lettering may reach."""
    laid = letter(label.text, label.height)
    width, height = (size + label.gap + REACH for size in (laid.width, laid.ascent + laid.descent))
    if not label.away:
        return label.anchor + np.array([width, -width, 1j * height, -1j * height])
    u = label.away / abs(label.away)
    return label.anchor + np.array([0j, complex(u.real * width, u.imag * height)])


def _between(cells: Cells, axis: int) -> Cells:
    """Cells between the first and the last inked one of every line along an axis."""
    before = np.maximum.accumulate(cells, axis=axis)
    behind = np.flip(np.maximum.accumulate(np.flip(cells, axis), axis=axis), axis)
    return np.asarray(before & behind)
