"""Views for the room that a sheet has left, found on the ink of the others; in the order in which its arrangement offers them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas, Label, Part
from tmm_sheets.drawing.ink_index import Cells, dense, sum_area
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.sheets.views import VIEWS, ViewPlace, function

if TYPE_CHECKING:
    from tmm_sheets.project import Project

Taken = NDArray[Any]
"""Cells of the sheet, shape (nx, ny): which of them are taken."""
Counts = NDArray[np.int32]

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
CLOSE = (100.0, 190.0)
"""Distances of a view from the spot that it belongs to, mm: as near as is wanted, and as is allowed."""
LARGE = (160.0, 120.0), (150.0, 112.0), (216.0, 76.0)
"""An empty rectangle of these sides, upright or lying, is a gap, mm: the second where cells that its edges cut hide one, the third
a long one."""
FAR = np.int16(2**15 - 1)
"""More cells than a sheet has."""
APART = (12.0, 9.0, 6.0)
"""Distances from all else with which a place is looked for, mm: the widest first."""


def draw(project: Project, canvas: Canvas, offered: Sequence[ViewPlace], inside: Box, closed: Sequence[Box],
         known: Sequence[Box | None] = ()) -> None:
    """Draw those of the offered views that find room ``inside`` the sheet, away from boxes ``closed`` to them.

    A view tells its sizes, from what it wants down to what it can do with, and perhaps what it belongs to: it stands near that or
    nowhere, and those that do so choose first. The option ``left`` is the left edge that one would like best, mm. Where the places
    are ``known`` from an earlier time, in the same order, none is looked for.
    """
    views = _wanted(project, canvas, offered)
    found = ((view, box) for (view, *_), box in zip(views, known, strict=True)) if known else _placed(canvas, views, inside, closed)
    for view, box in found:
        canvas.offered.append(box)
        if box is not None:
            canvas.of = view.draw
            canvas.begin(box, "", view.draw)
            function(view.draw)(project, canvas, box, view.options)


def _wanted(project: Project, canvas: Canvas, offered: Sequence[ViewPlace]) -> Iterator[tuple[ViewPlace, Any, Any]]:
    """The views that have something to show, with their sizes and what they belong to; those first that belong to another."""
    for view in sorted(offered, key=lambda view: not view.kind.near):
        try:
            wanted = function(view.kind.sizes)(project, canvas, view.options)
        except CannotBuild:
            continue  # what it shows cannot be had; the views that need it have said so
        if wanted:
            yield view, wanted, view.kind.near and function(view.kind.near)(project, canvas, view.options)


def _placed(canvas: Canvas, views: Iterator[tuple[ViewPlace, Any, Any]], inside: Box,
            closed: Sequence[Box]) -> Iterator[tuple[ViewPlace, Box | None]]:
    """The views with the places there are for them; each is drawn before the next one is asked for."""
    taken = cells_closed(inside, closed)
    seen, forces = 0, _of_forces(canvas, inside)
    whole, drawn = (cells_between(canvas, inside, lettering) for lettering in (True, False))
    for view, wanted, near in views:
        for k in range(seen, len(canvas.parts)):
            taken |= part_cells(canvas, k, inside)
        seen = len(canvas.parts)
        if near:
            spot, own, others = near
            box = place_nearest(taken, wanted, inside, spot, [_ink_box(canvas, k, inside) for k in (own, *others)])
        else:
            at = view.options.get("left")
            # Nothing parts a loaded scheme from its force plans: kinematics stand among the forces, and equations of forces
            # elsewhere, only where there is no other room. Beside a plan that is all but one line there is much of it from the
            # title to the equation: no plan but a table may stand there.
            stands = view.kind.stands
            room = taken | (drawn if stands == "table" else whole)
            first = (room | ~empty_cells(canvas, inside, closed, sides) for sides in LARGE) \
                if stands in ("anywhere", "table") else \
                iter([room | forces] if view.needs == "positions" else [room | ~forces] if stands == "forces" else [])
            box = next((box for part in chain(first, [room])
                        if (box := place_farthest(part, wanted, inside, at)) is not None), None)
        yield view, box


def empty_cells(canvas: Canvas, inside: Box, closed: Sequence[Box], sides: tuple[float, float]) -> Taken:
    """Cells of empty rectangles of these sides, mm, lying or upright."""
    inked = cells_closed(inside, closed)
    inked |= inked_cells(canvas, range(len(canvas.parts)), inside)
    gaps = np.zeros(inked.shape, bool)
    table = sum_area(inked)
    for size in (sides, sides[::-1]):
        nx, ny = (int(np.ceil(length / CELL)) for length in size)
        begins = window_counts(table, nx, ny) == 0
        # How many of them have a corner here, with its sign: summed up, how many lie over a cell.
        count = np.zeros(np.add(inked.shape, 1), np.int32)
        for (i, j), sign in {(0, 0): 1, (nx, 0): -1, (0, ny): -1, (nx, ny): 1}.items():
            count[i:i + begins.shape[0], j:j + begins.shape[1]] += sign * begins
        gaps |= sum_area(count)[1:-1, 1:-1] > 0
    return gaps


def window_counts(table: Counts, nx: int, ny: int) -> Counts:
    """How many cells are taken of each rectangle of so many cells, by its lower left one; of their summed-area table."""
    return np.asarray(table[nx:, ny:] - table[:-nx, ny:] - table[nx:, :-ny] + table[:-nx, :-ny])


def _free(table: Counts, sizes: Sequence[tuple[float, float]]) -> Iterator[tuple[tuple[float, float], float, Taken]]:
    """The sizes with distances from all else, the widest first, and the lowest left cells of all places that have them."""
    steps = {((w, h), apart): (int(np.ceil((w + 2 * apart) / CELL)), int(np.ceil((h + 2 * apart) / CELL)))
             for w, h in sizes for apart in APART}
    steps = {key: (nx, ny) for key, (nx, ny) in steps.items() if nx < table.shape[0] and ny < table.shape[1]}
    if not steps:
        return
    # Where the least of all is not free nothing is: the whole sheet is looked at once, for each size only what is left of it.
    least = min([nx for nx, _ in steps.values()]), min([ny for _, ny in steps.values()])
    i, j = (window_counts(table, *least) == 0).nonzero()
    if not len(i):
        return
    flat, wide = table.ravel(), table.shape[1]
    for (size, apart), (nx, ny) in steps.items():
        inside = (i + nx < table.shape[0]) & (j + ny < wide)
        x, y = i[inside], j[inside]
        at = x * wide + y
        free = flat[at + (nx * wide + ny)] - flat[at + ny] == flat[at + nx * wide] - flat[at]
        if free.any():
            yield size, apart, np.array([x[free], y[free]]).T


def place_farthest(taken: Taken, sizes: Sequence[tuple[float, float]], inside: Box, left: float | None = None) -> Box | None:
    """The first of the sizes for which there is room beside the cells ``taken``, where it is farthest from all else.

    With the edge ``left``, mm, where there is room for any of them with it.
    """
    table = sum_area(taken)
    for edge in (None,) if left is None else (left, None):
        for (width, height), apart, free in _free(table, sizes):
            if edge is not None:
                free = free[free[:, 0] == round((edge - apart - inside.x0) / CELL)]
            if len(free):
                # In the middle of the room there is, if it is one; else at its beginning.
                i, j = free[np.argmin(np.abs(free - _middle(free)).sum(axis=1))]
                x, y = edge if edge is not None else inside.x0 + i * CELL + apart, inside.y0 + j * CELL + apart
                return Box(x, y, x + width, y + height)
    return None


def _middle(cells: Taken) -> NDArray[np.float64]:
    """Median of each coordinate; NumPy's own loads all of numpy.ma to ask whether there is a mask."""
    n, ordered = len(cells), np.sort(cells, axis=0)
    return np.asarray((ordered[(n - 1) // 2] + ordered[n // 2]) / 2)


def place_nearest(taken: Taken, sizes: Sequence[tuple[float, float]], inside: Box, spot: complex,
                  pictures: Sequence[Box]) -> Box | None:
    """The place nearest to a spot of the first picture, no nearer to the others, of the first size that has one in reach."""
    wanted, allowed = CLOSE
    second = None
    for (width, height), apart, free in _free(sum_area(taken), sizes):
        corners = complex(inside.x0 + apart, inside.y0 + apart) + CELL * (free[:, 0] + 1j * free[:, 1])
        middles = corners + complex(width, height) / 2
        near = (np.abs(middles - spot) <= (wanted if second is not None else allowed)).nonzero()[0]
        if not len(near):
            continue
        middles = middles[near]
        off = np.array([_distance_from_box(middles, picture) for picture in pictures])
        far = np.where(off[0] <= off.min(axis=0), np.abs(middles - spot), np.inf)
        k = int(np.argmin(far))
        if far[k] > allowed:
            continue
        at = complex(corners[near[k]])
        found = Box(at.real, at.imag, at.real + width, at.imag + height)
        if far[k] <= wanted:
            return found
        second = second or found
    return second


def _distance_from_box(z: Points, box: Box) -> NDArray[np.float64]:
    """Distances of points from a box."""
    x, y = [np.maximum(np.maximum(low - v, v - high), 0.0) for v, low, high in ((z.real, box.x0, box.x1), (z.imag, box.y0, box.y1))]
    return np.asarray(np.hypot(x, y))


def _ink_box(canvas: Canvas, k: int, inside: Box) -> Box:
    """What a part's ink takes."""
    i, j = np.nonzero(inked_cells(canvas, range(k, k + 1), inside))
    return Box(*[float(edge) for edge in (inside.x0 + CELL * i.min(), inside.y0 + CELL * j.min(),
                                          inside.x0 + CELL * (i.max() + 1), inside.y0 + CELL * (j.max() + 1))])


def cells_between(canvas: Canvas, inside: Box, lettering: bool = True) -> Taken:
    """Cells between the pictures of one view of forces: a loaded scheme and its force plans; ``lettering`` is part of them."""
    taken = cells_closed(inside, [])
    for begin, end in pairwise([*(k for k, part in enumerate(canvas.parts) if not part.title), len(canvas.parts)]):
        if _picture(canvas.parts[begin]) == "force plans":
            picture = inked_cells(canvas, range(begin, end), inside, lettering)
            taken |= _cells_between(picture, 0)[1] | _cells_between(picture, 1)[1]
    return taken


def _picture(part: Part) -> str:
    """What others have to respect of the picture of a part."""
    return VIEWS[part.draw].picture if part.draw in VIEWS else ""


def _of_forces(canvas: Canvas, inside: Box) -> Taken:
    """Cells of the views of forces, and between them."""
    boxes = [part.box for part in canvas.parts if _picture(part) == "force plans"]
    alone = [part.box for part in canvas.parts if _picture(part) == "forces"]
    hull = [Box(min(b.x0 for b in boxes), min(b.y0 for b in boxes), max(b.x1 for b in boxes), max(b.y1 for b in boxes))] \
        if boxes else []
    return cells_closed(inside, [*hull, *alone])


def cells_closed(inside: Box, closed: Sequence[Box]) -> NDArray[np.bool_]:
    """Cells of the sheet, those within boxes ``closed`` to views taken."""
    cells = Cells(inside, CELL)
    cells.add_boxes(np.reshape(closed, (-1, 4)))
    return cells.taken


def part_cells(canvas: Canvas, k: int, inside: Box) -> NDArray[np.bool_]:
    """Cells with ink of a part of a view, or between its ink: within its picture nothing else may stand."""
    part = canvas.parts[k]
    if part.draw == "title block":
        return cells_closed(inside, [])
    own = inked_cells(canvas, range(k, k + 1), inside)
    along, across = _cells_between(own, 0), _cells_between(own, 1)
    taken = along[0] | across[0] | along[1] & across[1]
    if _picture(part) == "wheels":
        taken |= across[1]
    if part.title and own.any():
        # A title is that of all parts up to the next one: plans of several positions.
        after = (n for n in range(k + 1, len(canvas.parts)) if canvas.parts[n].headed or canvas.parts[n].draw != part.draw)
        whole = range(k, next(after, len(canvas.parts))) if part.headed else range(k, k + 1)
        picture = _cells_between(inked_cells(canvas, whole, inside), 0)[1] if len(whole) > 1 else own
        taken |= _under_title(picture)
        if len(whole) > 1:
            taken |= _cells_between(picture, 1)[1]
    return taken


def inked_cells(canvas: Canvas, parts: range, inside: Box, lettering: bool = True) -> NDArray[np.bool_]:
    """Cells with ink of parts that follow each other, or under their labels not set yet; without ``lettering`` lines alone."""
    taken = np.zeros((int(inside.width / CELL), int(inside.height / CELL)), bool)
    for k in parts:
        span = canvas.span(k)
        labels = [label for label in canvas.labels if label.part == k] if lettering else []
        key = k, lettering, span, len(labels), inside
        known = canvas.inked.get(key)
        if known is None:
            marks = canvas.marks[span[0]:span[1]]
            z = np.concatenate((dense(marks, CELL), *map(_reach_points, labels))) if lettering \
                else dense([mark for mark in marks if mark.by is None or mark.by.role != "text"], CELL)
            cells = Cells(inside, CELL)
            cells.add_points(z)
            known = canvas.inked[key] = cells.taken
        taken |= known
    return taken


def _under_title(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells between the title of a part, as if it were as wide as the part, and what is drawn near under it."""
    columns, level = np.arange(cells.shape[1]), int(np.flatnonzero(cells.any(axis=0))[-1]) - int(TITLE / CELL)
    top = np.where(cells[:, :level], columns[:level], -1).max(axis=1, initial=-1)
    near = (top >= 0) & ((level - top) * CELL < UNDER)
    return np.asarray(near[:, None] & (columns > top[:, None]) & (columns <= level))


def _reach_points(label: Label) -> Points:
    """Points about a label's anchor as far away as its lettering may reach."""
    laid = letter(label.text, label.height)
    width, height = [size + label.gap + REACH for size in (laid.width, laid.ascent + laid.descent)]
    if not label.away:
        return label.anchor + np.array([width, -width, 1j * height, -1j * height])
    u = label.away / abs(label.away)
    return label.anchor + np.array([0j, complex(u.real * width, u.imag * height)])


def _cells_between(cells: NDArray[np.bool_], axis: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Cells between two inked ones of a line along an axis: those that are less than ``OPEN`` apart, and any."""
    close, between = np.zeros((2, *cells.shape), bool)
    if cells.any():
        # A part is small on the sheet: nothing lies between its ink beyond it.
        inked = (np.logical_or.reduce(cells, axis=1 - k).nonzero()[0] for k in (0, 1))
        reach = tuple([slice(n[0], n[-1] + 1) for n in inked])
        own, back = cells[reach], (slice(None, None, -1), slice(None))[::1 - 2 * axis]
        n = np.arange(own.shape[axis], dtype=np.int16).reshape((-1, 1) if axis == 0 else (1, -1))
        before = np.maximum.accumulate(np.where(own, n, np.int16(-1)), axis=axis)
        behind = np.minimum.accumulate(np.where(own, n, FAR)[back], axis=axis)[back]
        between[reach] = inside = (before >= 0) & (behind < FAR)
        close[reach] = inside & (behind - before < int(OPEN / CELL))
    return close, between
