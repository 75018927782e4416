"""Views for the room that a sheet has left, found on the ink of the others; in the order in which its arrangement offers them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.evenness import dense
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.sheets.arrangement import View

if TYPE_CHECKING:
    from tmm_sheets.project import Project

CELL = 2.0
"""Side of the cells in which room is looked for, mm."""
TITLE = 3.0
"""Depth of the middle of a title under its upper edge, mm."""
UNDER = 80.0
"""What stands so near under a title belongs to it, and nothing else may stand between, mm."""
REACH = 2.0
"""How far a label may stand off beyond its gap, mm."""
OPEN = 100.0
"""What is open to one side of a view and wider than this is no part of its picture, mm."""
FAR = 10**6
"""More cells than a sheet has."""
APART = (12.0, 9.0, 6.0)
"""Distances from all else with which a place is looked for, mm: the widest first."""


def draw(project: Project, canvas: Canvas, offered: Sequence[View], inside: Box, closed: Sequence[Box]) -> None:
    """Draw those of the offered views that find room ``inside`` the sheet, away from boxes ``closed`` to them.

    A view ``module.function`` tells its sizes, from what it wants down to what it can do with, by ``module.function_sizes``; none
    where it has nothing to show. By ``module.function_left`` it may tell the left edge that it would like best, mm.
    """
    taken = _closed(inside, closed)
    seen = 0
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
        for k in range(seen, len(canvas.parts)):
            taken |= _of_part(canvas, k, inside, taken.shape)
        seen = len(canvas.parts)
        left: Callable[..., float] | None = getattr(room, f"{function}_left", None)
        box = _place(taken, wanted, inside, None if left is None else left(view.options))
        if box is not None:
            canvas.of = view.draw
            canvas.begin(box, "", view.draw)
            getattr(room, function)(project, canvas, box, view.options)


def _place(taken: NDArray[np.bool_], sizes: Sequence[tuple[float, float]], inside: Box, left: float | None = None) -> Box | None:
    """The first of the sizes for which there is room beside the cells ``taken``, where it is farthest from all else.

    With the edge ``left``, mm, where there is room for that size with it.
    """
    table = np.zeros((taken.shape[0] + 1, taken.shape[1] + 1), np.int64)
    table[1:, 1:] = taken.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
    for width, height in sizes:
        for apart in APART:
            nx, ny = (int(np.ceil((length + 2 * apart) / CELL)) for length in (width, height))
            if nx >= table.shape[0] or ny >= table.shape[1]:
                continue
            free = np.argwhere(table[nx:, ny:] - table[:-nx, ny:] - table[nx:, :-ny] + table[:-nx, :-ny] == 0)
            if len(free):
                if left is not None and len(aligned := free[free[:, 0] == round((left - apart - inside.x0) / CELL)]):
                    j = int(np.median(aligned[:, 1]))
                    return Box(left, inside.y0 + j * CELL + apart, left + width, inside.y0 + j * CELL + apart + height)
                # In the middle of the room there is, if it is one; else at its beginning.
                i, j = free[np.argmin(np.abs(free - np.median(free, axis=0)).sum(axis=1))]
                corner = complex(inside.x0 + i * CELL + apart, inside.y0 + j * CELL + apart)
                return Box(corner.real, corner.imag, corner.real + width, corner.imag + height)
    return None


def _closed(inside: Box, closed: Sequence[Box]) -> NDArray[np.bool_]:
    """Cells of the sheet, those within boxes ``closed`` to views taken."""
    taken = np.zeros([int(length / CELL) for length in (inside.width, inside.height)], bool)
    for box in closed:
        i0, i1 = (int((x - inside.x0) / CELL) for x in (box.x0, box.x1))
        j0, j1 = (int((y - inside.y0) / CELL) for y in (box.y0, box.y1))
        taken[max(i0, 0):i1 + 1, max(j0, 0):j1 + 1] = True
    return taken


def _of_part(canvas: Canvas, k: int, inside: Box, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Cells with ink of a part of a view, or between its ink: within its picture nothing else may stand."""
    part = canvas.parts[k]
    if part.draw == "title block":
        return np.zeros(shape, bool)
    own = _cells(canvas, range(k, k + 1), inside, shape)
    along, across = _between(own, 0), _between(own, 1)
    taken = along[0] | across[0] | along[1] & across[1]
    if part.title and own.any():
        # A title is that of all parts up to the next one: plans of several positions.
        after = (n for n in range(k + 1, len(canvas.parts)) if canvas.parts[n].headed or canvas.parts[n].draw != part.draw)
        whole = range(k, next(after, len(canvas.parts))) if part.headed else range(k, k + 1)
        picture = _between(_cells(canvas, whole, inside, shape), 0)[1] if len(whole) > 1 else own
        taken |= _under_title(picture)
        if len(whole) > 1:
            taken |= _between(picture, 1)[1]
    return taken


def _cells(canvas: Canvas, parts: range, inside: Box, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Cells with ink of parts that follow each other, or under their labels that are not set yet."""
    end = canvas.parts[parts.stop].first if parts.stop < len(canvas.parts) else len(canvas.marks)
    z = np.concatenate((dense(canvas.marks[canvas.parts[parts.start].first:end], CELL),
                        *(_about(label) for label in canvas.labels if label.part in parts)))  # fmt: skip
    own = np.zeros(shape, bool)
    i, j = ((z.real - inside.x0) / CELL).astype(int), ((z.imag - inside.y0) / CELL).astype(int)
    there = (i >= 0) & (i < shape[0]) & (j >= 0) & (j < shape[1])
    own[i[there], j[there]] = True
    return own


def _under_title(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells between the title of a part, as if it were as wide as the part, and what is drawn near under it."""
    columns, level = np.arange(cells.shape[1]), int(np.flatnonzero(cells.any(axis=0))[-1]) - int(TITLE / CELL)
    top = np.where(cells[:, :level], columns[:level], -1).max(axis=1, initial=-1)
    near = (top >= 0) & ((level - top) * CELL < UNDER)
    return np.asarray(near[:, None] & (columns > top[:, None]) & (columns <= level))


def _about(label: Label) -> Points:
    """Points about a label's anchor as far away as its lettering may reach."""
    laid = letter(label.text, label.height)
    width, height = (size + label.gap + REACH for size in (laid.width, laid.ascent + laid.descent))
    if not label.away:
        return label.anchor + np.array([width, -width, 1j * height, -1j * height])
    u = label.away / abs(label.away)
    return label.anchor + np.array([0j, complex(u.real * width, u.imag * height)])


def _between(cells: NDArray[np.bool_], axis: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Cells between two inked ones of a line along an axis: those that are less than ``OPEN`` apart, and any."""
    close, between = np.zeros((2, *cells.shape), bool)
    if cells.any():
        # A part is small on the sheet: nothing lies between its ink beyond it.
        reach = np.ix_(*(np.arange(n[0], n[-1] + 1) for n in (np.flatnonzero(cells.any(axis=1 - k)) for k in (0, 1))))
        own = cells[reach]
        n = np.arange(own.shape[axis]).reshape((-1, 1) if axis == 0 else (1, -1))
        before = np.maximum.accumulate(np.where(own, n, -1), axis=axis)
        behind = np.flip(np.minimum.accumulate(np.flip(np.where(own, n, FAR), axis), axis=axis), axis)
        between[reach] = inside = (before >= 0) & (behind < FAR)
        close[reach] = inside & ((behind - before) * CELL < OPEN)
    return close, between
