"""Labels find free places by themselves.

The sheet is rasterised once into two occupancy grids, lines that lettering must never touch (main lines, curves, axes,
fills, other lettering) and thin lines that it had better avoid. Summed-area tables make the ink under any rectangle a
matter of four look-ups, so all candidate places of a label are judged at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from itertools import chain
from math import pi
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import ink_index, owners
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.crowded import Crowded
from tmm_sheets.drawing.lettering import advance, letter
from tmm_sheets.drawing.marks import Box, Fill, Line, Mark, Points, Text, flat

TOGETHER = 64
"""So many labels have their places judged in one go."""
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
WORD = 0.6
"""Lettering on one level that stands nearer than this, in heights of its capitals, is read on as one word."""
RUN_ON = 5.0
"""Cost of such a place, in millimetres of distance."""
COVERING = 30.0
"""Cost of a place over the leader of another label, in millimetres of distance."""
CROSSING, OVER, MISREAD = 8.0, 300.0, 1e4
"""Cost of each thing a leader crosses or runs along, of lettering under it, of being read as another thing's letter, mm."""
OUTSIDE = 20.0
"""Cost of a place that leaves the place of the label's view, in millimetres of distance."""
AWAY, STRAYED = 8.0, 24.0
"""So far beyond that place, mm, a label has left it: as bad as a leader that meets three things."""
SEVERAL = 10
"""So many leaders met are as bad as a label that is read as another thing's."""
TURNING = 4.0
"""Cost of the direction opposite to the one asked for, in millimetres of distance."""
SHELF = 0.8
"""Clear distance, mm, of lettering from the shelf it stands on."""

Around = tuple[npt.NDArray[np.float64], Points]
"""Distances and directions, the first being the one asked for, in which places are tried."""
USUAL: Around = np.array([0.0, 0.6, 1.4, 2.5, 4.0, 6.0, 8.5, 11.0, 14.0, 18.0, 23.0]), np.exp(2j * pi * np.arange(24) / 24)
CLOSER: Around = np.concatenate(([0.0, 0.6, 1.4, 2.5], np.arange(4.0, 40.0))), np.exp(2j * pi * np.arange(96) / 96)
"""Many more, for the few labels whose leader meets something wherever it is led from the usual places."""
_MARGIN = CLEAR * np.array([-1.0, -1.0, 1.0, 1.0])[:, None]
_FIRST_BEYOND = np.array([0, 0, 1, 1])[:, None]
"""A rectangle's cells: from the one its lower left corner is in to the one after that of its upper right corner."""


def text_box(mark: Text) -> Points:
    """Corners of the rectangle round a run of text (slanted letters reach a little to the right of their advance)."""
    corners = _corners(mark.text, mark.height)
    return np.asarray(mark.at + (complex(np.cos(mark.angle), np.sin(mark.angle)) * corners if mark.angle else corners))


def text_boxes(marks: Sequence[Text]) -> npt.NDArray[np.complex128]:
    """The same of many, shape (n, 4)."""
    if not marks:
        return np.empty((0, 4), complex)
    found = np.array([mark.at for mark in marks])[:, None] + np.array([_corners(mark.text, mark.height) for mark in marks])
    for k in (k for k, mark in enumerate(marks) if mark.angle):
        found[k] = text_box(marks[k])
    return np.asarray(found)


def bounds_of(corners: npt.NDArray[np.complex128]) -> npt.NDArray[np.float64]:
    """Upright rectangles round corners of each row: x0, y0, x1, y1, shape (n, 4)."""
    x, y = corners.real, corners.imag
    return np.array([x.min(axis=1), y.min(axis=1), x.max(axis=1), y.max(axis=1)]).T


@lru_cache(maxsize=10_000)
def _corners(text: str, h: float) -> Points:
    """The same of lettering that lies along the x axis from the origin on."""
    w, drop = advance(text, h), -0.3 * h if any(c in "рудцщфgjpqyβγζημξρφχψς,;()" for c in text) else 0.0
    return np.array([complex(0, drop), complex(w, drop), complex(w + 0.15 * h, h), complex(0, h)])


def place(canvas: Canvas, area: Box) -> list[Crowded]:
    """Set every requested label of the canvas inside ``area``; returns those that found no free place."""
    return set_labels(canvas, Grid(area, canvas.marks))


def set_labels(canvas: Canvas, grid: Grid) -> list[Crowded]:
    """The same on a grid of what is drawn, to which they come.

    What meets a leader that was set after it gets another place when all the others have theirs.
    """
    first = len(canvas.marks)
    grid.expect(len(canvas.labels), [part.box for part in canvas.parts])
    ink = ink_index.Ink([m for n, m in enumerate(canvas.marks) if n not in canvas.windows])
    found = [*_first(grid, ink, canvas.labels)]
    for around in (USUAL, USUAL, CLOSER):
        for k in range(len(found)):
            if not grid.quiet(k) and _ill(grid, ink, found, (k,)):
                # One that has no better place gets it when the one it meets makes room, or changes places with it.
                ways = ((k,), *(pair for q in grid.met(k) for pair in ((k, q), (q, k))))
                done = any(_set_again(grid, ink, canvas.labels, found, some, around) for some in ways) or \
                    any(_exchanged(grid, ink, found, k, q) for q in grid.met(k))
                if around is CLOSER and not done:
                    any(_made_room(grid, ink, canvas.labels, found, *pair) for pair in ways[1:])
    for label, box, _ in found:
        _draw(canvas, label, box)
    grid.add(canvas.marks[first:])
    crowded = [Crowded(label.text, label.anchor) for label, (_, _, free) in zip(canvas.labels, found, strict=True) if not free]
    canvas.labels.clear()
    return crowded


class Grid:
    """Ink on the sheet as two summed-area tables; lettering (``written``), that of the labels (``boxes``) last, and their leaders.

    Places of labels that are not set are not numbers. ``views`` are the places of the parts that labels belong to.
    """

    def __init__(self, area: Box, marks: Sequence[Mark]) -> None:
        self.area = area
        shape = (int(area.height / CELL) + 3, int(area.width / CELL) + 3)
        self._heavy, self._light = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
        self._corner = np.array([area.x0, area.y0] * 2)[:, None]
        self.inside = np.array([area.x0 + 1, area.y0 + 1, area.x1 - 1, area.y1 - 1])[:, None]
        self._last = np.array([shape[1], shape[0]] * 2)[:, None]
        self.written = np.empty((0, 4))
        self.add(marks)
        self.expect()

    def expect(self, labels: int = 0, views: Sequence[Box] = ()) -> None:
        """So many labels are to come, to parts in these places."""
        self.views = views
        self.written = np.vstack((self.written, np.full((labels, 4), np.nan)))
        self.boxes = self.written[len(self.written) - labels:]
        self._led: dict[int, tuple[complex, complex]] = {}
        self._lead(None)

    def add(self, marks: Sequence[Mark]) -> None:
        """Something more is drawn."""
        runs: dict[bool, list[Sequence[complex] | Points]] = {True: [], False: []}
        filled = list[tuple[float, float, float, float]]()
        for mark in marks:
            if isinstance(mark, Line):
                runs[mark.style in HEAVY].append((mark.a, mark.b))
            elif not isinstance(mark, Text):
                points = flat(mark)
                if isinstance(mark, Fill):
                    x, y = points.real.tolist(), points.imag.tolist()  # a few numbers: quicker without arrays
                    filled.append((min(x), min(y), max(x), max(y)))
                runs[isinstance(mark, Fill) or mark.style in HEAVY].append(points)
        written = bounds_of(text_boxes([mark for mark in marks if isinstance(mark, Text)]))
        self._boxes(self._heavy, np.vstack((written, np.array(filled).reshape(-1, 4))))
        for kind, target in ((True, self._heavy), (False, self._light)):
            if runs[kind]:
                self._ink(target, _sampled(runs[kind]))
        self.written = np.vstack((self.written, written))
        for known in ("heavy", "light"):
            vars(self).pop(known, None)

    @cached_property
    def heavy(self) -> npt.NDArray[np.int32]:
        """What lettering must not touch."""
        heavy = self._heavy
        # Main lines are up to a millimetre wide: their neighbours count as inked too.
        wide = heavy.copy()
        wide[1:] |= heavy[:-1]
        wide[:-1] |= heavy[1:]
        wide[:, 1:] |= heavy[:, :-1]
        wide[:, :-1] |= heavy[:, 1:]
        return _summed(wide)

    @cached_property
    def light(self) -> npt.NDArray[np.int32]:
        """What it had better not."""
        return _summed(self._light)

    def put(self, ink: ink_index.Ink, k: int, label: Label, box: Box) -> None:
        """Label ``k`` is set; the shelf it may stand on is part of it."""
        self.boxes[k] = box._replace(y0=box.y0 - SHELF - CLEAR) if label.shelf else box
        before = self._led.pop(k, None)
        if _led(label, box):
            self._led[k] = _way(label, box)
        if before is not None or k in self._led:
            self._lead(ink)

    def lift(self, ink: ink_index.Ink, k: int) -> None:
        """Label ``k`` is taken off."""
        self.boxes[k] = np.nan
        if self._led.pop(k, None) is not None:
            self._lead(ink)

    def _lead(self, ink: ink_index.Ink | None) -> None:
        self._whose = np.array(list(self._led), int)
        self._ends = np.array(list(self._led.values()), complex).reshape(-1, 2)
        self._led_sides = ink_index.sides(*self._ends.T)
        self.leaders = _sampled(list(self._ends)) if len(self._ends) else np.empty(0, complex)
        if ink is not None:
            ink.lead(*self._ends.T)

    def quiet(self, k: int) -> bool:
        """Whether label ``k`` has no leader, and none is near it: nothing can be wrong with it that was not before."""
        return k not in self._led and not len(ink_index.within(self._led_sides, Box(*self.boxes[k]), NEAR + ink_index.ROUNDING))

    def ill(self, k: int) -> int:
        """How many other leaders and how much other lettering the leader of label ``k`` meets; how many leaders its lettering."""
        _, a, b = self._others(k)
        over = int(ink_index.enters(a, b - a, *self.boxes[k]).sum())
        if k not in self._led:
            return over
        written = np.delete(self.written, len(self.written) - len(self.boxes) + k, axis=0)
        return int(ink_index.crossing(a, b, *self._led[k]).sum()) + _over(written, *self._led[k]) + over

    def met(self, k: int) -> list[int]:
        """Labels whose leader or lettering the leader of label ``k`` meets, and those whose leader meets its lettering."""
        others, a, b = self._others(k)
        found = others[ink_index.enters(a, b - a, *self.boxes[k])].tolist()
        if k in self._led:
            start, end = self._led[k]
            found += others[ink_index.crossing(a, b, start, end)].tolist()
            found += [n for n in np.flatnonzero(ink_index.enters(start, end - start, *self.boxes.T)).tolist() if n != k]
        return list(dict.fromkeys(found))

    def _others(self, k: int) -> tuple[npt.NDArray[np.int_], Points, Points]:
        """Labels with leaders but for label ``k``, and where their leaders begin and end."""
        other = self._whose != k
        a, b = self._ends[other].T
        return self._whose[other], a, b

    def _ink(self, target: npt.NDArray[np.uint8], p: Points) -> None:
        i, j = ((p.imag - self.area.y0) / CELL).astype(int), ((p.real - self.area.x0) / CELL).astype(int)
        ok = (i >= 0) & (i < target.shape[0]) & (j >= 0) & (j < target.shape[1])
        target[i[ok], j[ok]] = 1

    def _boxes(self, target: npt.NDArray[np.uint8], sides: npt.NDArray[np.float64]) -> None:
        cells = ((sides - self._corner.T) / CELL).astype(int) + _FIRST_BEYOND.T
        for j0, i0, j1, i1 in np.maximum(cells, 0).tolist():
            target[i0:i1, j0:j1] = 1

    def free(self, box: Box) -> bool:
        """Whether a rectangle lies inside the sheet, clear of heavy lines, lettering and the labels that are set."""
        sides = np.array(box)[:, None]
        near = self.boxes[ink_index.within(self.boxes.T, box, CLEAR)]
        return bool(self.clear(sides)[0] and not _meeting(sides + _MARGIN, near)[0])

    def clear(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
        """Which rectangles lie inside the sheet, clear of heavy lines and lettering but for that of labels."""
        blocked = self.under(self.heavy, sides + _MARGIN) > 0
        blocked |= (sides[:2] < self.inside[:2]).any(axis=0) | (sides[2:] > self.inside[2:]).any(axis=0)
        return np.asarray(~blocked)

    def under(self, table: npt.NDArray[np.int32], sides: npt.NDArray[np.float64]) -> npt.NDArray[np.int32]:
        """Inked cells under rectangles; ``sides`` are their x0, y0, x1, y1, shape (4, n)."""
        cells = ((sides - self._corner) / CELL).astype(int) + _FIRST_BEYOND
        j0, i0, j1, i1 = np.minimum(np.maximum(cells, 0), self._last)
        return np.asarray(table[i1, j1] - table[i0, j1] - table[i1, j0] + table[i0, j0])

    def covered(self, x0: npt.NDArray[np.float64], y0: npt.NDArray[np.float64], x1: npt.NDArray[np.float64],
                y1: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
        """Which rectangles have ink under them, (m, n): columns from ``x0`` to ``x1``, (n,), rows from ``y0`` to ``y1``, (m,)."""
        j0, i0, j1, i1 = (
            np.minimum(np.maximum(((at - self._corner[k]) / CELL).astype(int) + _FIRST_BEYOND[k], 0), self._last[k])
            for k, at in enumerate((x0, y0, x1, y1)))
        begin, end = j0.min(), j1.max() + 1
        heavy, light = self.heavy[:, begin:end], self.light[:, begin:end]
        band = (heavy[i1] - heavy[i0]) + (light[i1] - light[i0])
        return np.asarray(band[:, j1 - begin] > band[:, j0 - begin])


def _summed(cells: npt.NDArray[np.uint8]) -> npt.NDArray[np.int32]:
    table = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1), np.int32)
    np.cumsum(cells, axis=1, dtype=np.int32, out=table[1:, 1:])
    for i in range(1, len(table)):  # row upon row: three times quicker than another cumsum, which walks down columns
        table[i] += table[i - 1]
    return table


def _sampled(lines: Sequence[Sequence[complex] | Points]) -> Points:
    """Points along polylines no further apart than half a cell, all lines in one go."""
    counts = np.array([len(p) for p in lines])
    p = np.fromiter(chain.from_iterable(lines), complex, int(counts.sum()))
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


class _Lattice(NamedTuple):
    """Places about a label's anchor before others are set: rectangles ``sides`` (x0, y0, x1, y1; shape (4, n)) and their ``cost``.

    ``beyond`` is how far they leave the place of the label's view, mm, None where it has none. ``clear`` are those inside the sheet
    and clear of heavy lines; all are within the box ``around`` them.
    """

    sides: npt.NDArray[np.float64]
    cost: npt.NDArray[np.float64]
    beyond: npt.NDArray[np.float64] | None
    clear: npt.NDArray[np.bool_]
    around: Box


def _lattices(grid: Grid, labels: Sequence[Label], around: Around = USUAL) -> Iterator[_Lattice]:
    """Places about the anchors of some labels, judged together."""
    away, directions = around
    turned = TURNING * np.abs(np.angle(directions)) / pi
    units = np.array([directions * (label.away / abs(label.away)) if label.away else directions for label in labels])
    w, h = np.array([_size(label) for label in labels]).T[:, :, None, None] / 2
    # The rectangle's support along the direction keeps its nearest corner or side at the asked distance.
    support = np.minimum(w / np.maximum(np.abs(units.real), 1e-9)[:, None], h / np.maximum(np.abs(units.imag), 1e-9)[:, None])
    distances = away[:, None] + np.array([label.gap for label in labels])[:, None, None]
    centres = np.array([label.anchor for label in labels])[:, None, None] + units[:, None] * (distances + support)
    sides = np.array([centres.real - w, centres.imag - h, centres.real + w, centres.imag + h]).reshape(4, len(labels), -1)
    flat_ = sides.reshape(4, -1)
    light = grid.under(grid.light, flat_).reshape(sides.shape[1:])
    clear = grid.clear(flat_).reshape(sides.shape[1:])
    edges = [*sides[:2].min(axis=2), *sides[2:].max(axis=2)]
    for k, label in enumerate(labels):
        # A label that should do without a leader line gets one only when nothing near is free.
        cost = distances[k] * 1.2 + (0.0 if label.leader else FAR * (away > NEAR)[:, None])
        cost = (cost + turned if label.away else np.repeat(cost, len(directions), axis=1)).ravel()
        beyond = None
        if 0 <= label.part < len(grid.views) and (view := grid.views[label.part]).contains(label.anchor):
            x0, y0, x1, y1 = sides[:, k] + _MARGIN
            beyond = np.maximum.reduce([view.x0 - x0, view.y0 - y0, x1 - view.x1, y1 - view.y1])
        yield _Lattice(sides[:, k], cost + label.thin * LIGHT * light[k], beyond, clear[k], Box(*(edge[k] for edge in edges)))


class _Places:
    """Where a label may stand about its anchor: rectangles ``sides`` (x0, y0, x1, y1; shape (4, n)), their ``cost``, and
    numbers of the ``free`` ones, the cheapest first.
    """

    def __init__(self, grid: Grid, label: Label, lattice: _Lattice) -> None:
        self.label, self._grid = label, grid
        self.sides, cost, beyond, clear, around = lattice
        free = np.flatnonzero(clear)
        near = grid.boxes[ink_index.within(grid.boxes.T, around, CLEAR)]
        if len(free) and len(near):
            free = free[~_meeting(self.sides[:, free] + _MARGIN, near)]
        some = free if len(free) else np.arange(len(cost))  # what the others would cost nobody asks
        there = self.sides[:, some]
        gap = WORD * label.height
        read_on = _beside(there, grid.written[ink_index.within(grid.written.T, around, gap)], gap)
        more = cost[some] + RUN_ON * read_on
        self._strayed = None
        if beyond is not None:
            more = more + OUTSIDE * (beyond[some] > 0)
            self._strayed = beyond > AWAY
        p = grid.leaders
        x0, y0, x1, y1 = around.inset(-CLEAR)
        p = p[(p.real > x0) & (p.real < x1) & (p.imag > y0) & (p.imag < y1)]
        if len(p):
            x0, y0, x1, y1 = (there + _MARGIN)[:, :, None]
            more += COVERING * ((p.real > x0) & (p.real < x1) & (p.imag > y0) & (p.imag < y1)).any(axis=1)
        self.cost = np.full(len(cost), np.inf)
        self.cost[some] = more
        self.run_on = np.zeros(len(cost), bool)
        self.run_on[some] = read_on
        self.free = free[np.argsort(self.cost[free], kind="stable")]

    def read(self, here: owners.Round, leaders: bool = True) -> int | None:
        """The cheapest free place where the label reads as what it names, or has a leader that meets nothing.

        Where there is none the best of the others: a leader had better cross a line than the label be read as another thing's, or
        the leader run over lettering. None without ``leaders``.
        """
        poor, least = None, np.inf
        for k in map(int, self.free):
            if not leaders and _led(self.label, self.box(k)):
                continue
            ill = self.ill(here, k)
            if not ill:
                return k
            if self.cost[k] + ill < least:
                poor, least = k, self.cost[k] + ill
        return poor if leaders else None

    def box(self, k: int) -> Box:
        """A place."""
        return Box(*self.sides[:, k].tolist())

    def ill(self, here: owners.Round, k: int) -> float:
        """Cost of what is wrong with the label at a place, 0 for nothing."""
        box = self.box(k)
        far = STRAYED * bool(self._strayed is not None and self._strayed[k])
        if not _led(self.label, box):
            return far + (MISREAD if here.reads(box) else 0.0)
        over = _over(self._grid.written, *_way(self.label, box))
        return far + (OVER * over if over else CROSSING * here.met(*_way(self.label, box)))

    def apart(self, here: owners.Round) -> Iterator[int]:
        """Free places whose leader runs over no lettering, the cheapest first, none near one before it."""
        centres = (self.sides[:2] + self.sides[2:]).T @ [0.5, 0.5j]
        left = self.free
        while len(left):
            k, left = int(left[0]), left[1:]
            if self.ill(here, k) < OVER:
                yield k
                left = left[np.abs(centres[left] - centres[k]) > NEAR]

    def least(self) -> int:
        """The cheapest place, or where none is free the one that is least inked."""
        if len(self.free):
            return int(self.free[0])
        return int(np.argmin(self.cost + 20.0 * self._grid.under(self._grid.heavy, self.sides)))


def _meeting(sides: npt.NDArray[np.float64], boxes: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """Which rectangles (x0, y0, x1, y1; shape (4, n)) overlap one of the ``boxes``, shape (m, 4)."""
    x0, y0, x1, y1 = sides[:, :, None]
    b = boxes.T
    return np.asarray(((x0 < b[2]) & (x1 > b[0]) & (y0 < b[3]) & (y1 > b[1])).any(axis=1))


def _beside(sides: npt.NDArray[np.float64], boxes: npt.NDArray[np.float64], gap: float) -> npt.NDArray[np.bool_]:
    """Which of them have one of the boxes on their level nearer than ``gap``."""
    x0, y0, x1, y1 = sides[:, :, None]
    b = boxes.T
    level = 0.4 * (y1 - y0)  # an index of the one beside the bar of the other is not yet a word
    return np.asarray(((x0 - gap < b[2]) & (x1 + gap > b[0]) & (y0 + level < b[3]) & (y1 - level > b[1])).any(axis=1))


def _size(label: Label) -> tuple[float, float]:
    laid = letter(label.text, label.height)
    return laid.width + 0.15 * label.height, laid.ascent + laid.descent


Found = tuple[Label, Box, bool]
"""A label, which may have moved, its place, whether there was room for it."""


def _first(grid: Grid, ink: ink_index.Ink, labels: Sequence[Label]) -> Iterator[Found]:
    """Set labels one after another."""
    for begin in range(0, len(labels), TOGETHER):
        some = labels[begin:begin + TOGETHER]
        for k, (label, lattice) in enumerate(zip(some, _lattices(grid, some), strict=True), begin):
            found = _placed(grid, ink, label, lattice, USUAL)
            grid.put(ink, k, *found[:2])
            yield found


def _found(grid: Grid, ink: ink_index.Ink, k: int, label: Label, around: Around) -> Found:
    (lattice,) = _lattices(grid, [label], around)
    found = _placed(grid, ink, label, lattice, around)
    grid.put(ink, k, *found[:2])
    return found


def _ill(grid: Grid, ink: ink_index.Ink, found: list[Found], some: tuple[int, ...]) -> int:
    """What is wrong with some labels where they stand, see :meth:`Grid.ill` and :func:`_misread`."""
    return sum(grid.ill(k) + _misread(grid, ink, *found[k][:2]) for k in some)


def _set_again(grid: Grid, ink: ink_index.Ink, labels: list[Label], found: list[Found], some: tuple[int, ...],
               around: Around) -> bool:
    """Take some labels off and set them again in this order; they stay where they were unless that makes it better."""
    before, ill = [found[k] for k in some], _ill(grid, ink, found, some)
    for k in some:
        grid.lift(ink, k)
    for k in some:
        found[k] = _found(grid, ink, k, labels[k], around)
    return _kept(grid, ink, found, some, before, ill)


def _made_room(grid: Grid, ink: ink_index.Ink, labels: list[Label], found: list[Found], k: int, q: int) -> bool:
    """Try the places of label ``k`` one after another until label ``q`` has a good one, too; else both stay where they were."""
    before, label = [found[k], found[q]], labels[k]
    for n in (k, q):
        grid.lift(ink, n)
    places = _Places(grid, label, *_lattices(grid, [label], CLOSER))
    for at in places.apart(owners.Round(ink, label, 2 * (NEAR + label.gap) + _size(label)[0])):
        found[k] = label, places.box(at), True
        grid.put(ink, k, *found[k][:2])
        found[q] = _found(grid, ink, q, labels[q], CLOSER)
        if not _ill(grid, ink, found, (k, q)):
            return True
        for n in (k, q):
            grid.lift(ink, n)
    for n, was in zip((k, q), before, strict=True):
        found[n] = was
        grid.put(ink, n, *was[:2])
    return False


def _exchanged(grid: Grid, ink: ink_index.Ink, found: list[Found], k: int, q: int) -> bool:
    """Let two labels change places, as leaders that cross ask for, if both have room there and that makes it better."""
    before, ill = [found[k], found[q]], _ill(grid, ink, found, (k, q))
    for n in (k, q):
        grid.lift(ink, n)
    for n, (label, own, _), to in ((k, before[0], before[1][1].centre), (q, before[1], before[0][1].centre)):
        half = complex(own.width, own.height) / 2
        box = Box((to - half).real, (to - half).imag, (to + half).real, (to + half).imag)
        found[n] = label, box, grid.free(box) and (_led(label, box) or not _reads(ink, label, box))
        grid.put(ink, n, label, box)
    return _kept(grid, ink, found, (k, q), before, ill if found[k][2] and found[q][2] else 0)


def _kept(grid: Grid, ink: ink_index.Ink, found: list[Found], some: tuple[int, ...], before: list[Found], ill: int) -> bool:
    """Whether labels stand better than ``ill`` now; else they go back to where they were before."""
    if _ill(grid, ink, found, some) < ill:
        return True
    for k, was in zip(some, before, strict=True):
        found[k] = was
        grid.put(ink, k, *was[:2])
    return False


def _draw(canvas: Canvas, label: Label, box: Box) -> None:
    laid = letter(label.text, label.height)
    canvas.of, first = label.of, len(canvas.marks)
    with canvas.traced("text", *(label.by[1:] if label.by is not None else ())):
        canvas.put(laid, complex(box.x0, box.y0 + laid.descent), 0.0, label.text)
        _leader(canvas, label, box)
    if len(canvas.marks) > first:
        # The leader line belongs to its label.
        canvas.groups[-1] = canvas.groups[-1]._replace(end=len(canvas.marks), part=label.part, anchor=label.anchor)
    if label.dimension >= 0:
        d = canvas.dimensions[label.dimension]
        canvas.dimensions[label.dimension] = d._replace(label=(first, len(canvas.marks)), middle=box.centre)


def _placed(grid: Grid, ink: ink_index.Ink, label: Label, lattice: _Lattice, around: Around) -> Found:
    """Place of a label, which may have moved along the vector it names rather than have a leader; whether there is room for it."""
    places, reach = _Places(grid, label, lattice), 2 * (NEAR + label.gap) + _size(label)[0]
    here = owners.Round(ink, label, reach)
    k = places.read(here)
    if k is None or places.run_on[k] or _led(label, Box(*places.sides[:, k])):
        # Lettering that keeps off thin lines had better have a leader than stand over some.
        most = np.inf if label.thin <= 1.0 or k is None else float(places.cost[k]) + places.ill(here, k)
        moves = [replace(label, anchor=anchor) for anchor in here.along()]
        for moved, other in zip(moves, _lattices(grid, moves, around) if moves else (), strict=True):
            others = _Places(grid, moved, other)
            there = others.read(owners.Round(ink, moved, reach), leaders=False)
            if there is not None and not others.run_on[there] and others.cost[there] < most:
                return moved, Box(*others.sides[:, there]), True
    return label, Box(*places.sides[:, places.least() if k is None else k]), bool(len(places.free))


def _misread(grid: Grid, ink: ink_index.Ink, label: Label, box: Box) -> int:
    """Whether a label without a leader is read as another's because of the leader of one: more than a crossing of two leaders."""
    p = grid.leaders
    near = (p.real > box.x0 - NEAR) & (p.real < box.x1 + NEAR) & (p.imag > box.y0 - NEAR) & (p.imag < box.y1 + NEAR)
    if _led(label, box) or not near.any():
        return 0
    return SEVERAL * bool(_reads(ink, label, box))


def _reads(ink: ink_index.Ink, label: Label, box: Box) -> str:
    """What is wrong with a label there that has no leader, see :meth:`owners.Round.reads`."""
    return owners.Round(ink, label, 2 * (NEAR + label.gap) + box.width).reads(box)


def _led(label: Label, box: Box) -> bool:
    """Whether lettering there stands too far to be read without a leader."""
    return bool(label.shelf) or abs(box.nearest(label.anchor) - label.anchor) > NEAR + label.gap


def _way(label: Label, box: Box) -> tuple[complex, complex]:
    """From the anchor to the nearest point of the lettering, or from the edge of what it names to its shelf."""
    if not label.shelf:
        return label.anchor, box.nearest(label.anchor)
    end = min(_shelf(box), key=lambda z: abs(z - label.anchor))
    return label.anchor + label.shelf * (end - label.anchor) / abs(end - label.anchor), end


def _shelf(box: Box) -> tuple[complex, complex]:
    """Ends of the shelf under lettering."""
    return complex(box.x0, box.y0 - SHELF), complex(box.x1, box.y0 - SHELF)


def _over(boxes: npt.NDArray[np.float64], a: complex, b: complex) -> int:
    """Over how much lettering a leader runs."""
    x0, y0, x1, y1 = boxes[(boxes[:, 2] > min(a.real, b.real)) & (boxes[:, 0] < max(a.real, b.real))].T
    return int(ink_index.enters(a, b - a, x0, y0, x1, y1).sum())


def _leader(canvas: Canvas, label: Label, box: Box) -> None:
    """Thin line from the anchor to the nearest point of lettering that stands too far to be read without one."""
    if label.shelf:
        canvas.line(*_way(label, box), "thin")
        canvas.line(*_shelf(box), "thin")
    elif _led(label, box):
        _, end = _way(label, box)
        u = (end - label.anchor) / abs(end - label.anchor)
        # A label that keeps off its anchor stands beside a symbol: the line ends at that symbol's edge, not inside it.
        canvas.line(label.anchor + max(label.gap - BESIDE, 0.0) * u, end - 0.6 * u, "thin")
