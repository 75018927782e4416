"""Labels find free places by themselves.

The sheet is rasterised once into two occupancy grids, lines that lettering must never touch (main lines, curves, axes,
fills, other lettering) and thin lines that it had better avoid. Summed-area tables make the ink under any rectangle a
matter of four look-ups, so all candidate places of a label are judged at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import pi

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import owners
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.crowded import Crowded
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
    u = complex(np.cos(mark.angle), np.sin(mark.angle))
    w, h = advance(mark.text, mark.height), mark.height
    drop = -0.3 * h if any(c in "рудцщфgjpqyβγζημξρφχψς,;()" for c in mark.text) else 0.0
    return mark.at + u * np.array([complex(0, drop), complex(w, drop), complex(w + 0.15 * h, h), complex(0, h)])


def place(canvas: Canvas, area: Box) -> list[Crowded]:
    """Set every requested label of the canvas inside ``area``; returns those that found no free place.

    What meets a leader that was set after it gets another place when all the others have theirs.
    """
    grid = Grid(area, canvas.marks, len(canvas.labels), [part.box for part in canvas.parts])
    ink = owners.Ink([m for n, m in enumerate(canvas.marks) if n not in canvas.windows])
    found = [_found(grid, ink, k, label) for k, label in enumerate(canvas.labels)]
    for around in (USUAL, USUAL, CLOSER):
        for k in range(len(found)):
            if _ill(grid, ink, found, (k,)):
                # One that has no better place gets it when the one it meets makes room, or changes places with it.
                ways = ((k,), *(pair for q in grid.met(k) for pair in ((k, q), (q, k))))
                done = any(_set_again(grid, ink, canvas.labels, found, some, around) for some in ways) or \
                    any(_exchanged(grid, ink, found, k, q) for q in grid.met(k))
                if around is CLOSER and not done:
                    any(_made_room(grid, ink, canvas.labels, found, *pair) for pair in ways[1:])
    for label, box, _ in found:
        _draw(canvas, label, box)
    crowded = [Crowded(label.text, label.anchor) for label, (_, _, free) in zip(canvas.labels, found, strict=True) if not free]
    canvas.labels.clear()
    return crowded


class Grid:
    """Ink on the sheet as two summed-area tables; lettering (``written``), that of the labels (``boxes``) last, and their leaders.

    Places of labels that are not set are not numbers. ``views`` are the places of the parts that labels belong to.
    """

    def __init__(self, area: Box, marks: list[Mark], labels: int = 0, views: Sequence[Box] = ()) -> None:
        self.area = area
        self.views = views
        shape = (int(area.height / CELL) + 3, int(area.width / CELL) + 3)
        heavy, light = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
        runs: dict[bool, list[Points]] = {True: [], False: []}
        written: list[tuple[float, float, float, float]] = []
        for mark in marks:
            if isinstance(mark, Text):
                corners = text_box(mark)
                self._box(heavy, corners)
                written.append((corners.real.min(), corners.imag.min(), corners.real.max(), corners.imag.max()))
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
        self.written = np.vstack((np.array(written).reshape(-1, 4), np.full((labels, 4), np.nan)))
        self.boxes = self.written[len(written):]
        self._led: dict[int, tuple[complex, complex]] = {}
        self._lead(None)

    def put(self, ink: owners.Ink, k: int, label: Label, box: Box) -> None:
        """Label ``k`` is set; the shelf it may stand on is part of it."""
        self.boxes[k] = box._replace(y0=box.y0 - SHELF - CLEAR) if label.shelf else box
        self._led.pop(k, None)
        if _led(label, box):
            self._led[k] = _way(label, box)
        self._lead(ink)

    def lift(self, ink: owners.Ink, k: int) -> None:
        """Label ``k`` is taken off."""
        self.boxes[k] = np.nan
        self._led.pop(k, None)
        self._lead(ink)

    def _lead(self, ink: owners.Ink | None) -> None:
        self._whose = np.array(list(self._led), int)
        self._ends = np.array(list(self._led.values()), complex).reshape(-1, 2)
        self.leaders = _sampled(list(self._ends)) if len(self._ends) else np.empty(0, complex)
        if ink is not None:
            ink.lead(*self._ends.T)

    def ill(self, k: int) -> int:
        """How many other leaders and how much other lettering the leader of label ``k`` meets; how many leaders its lettering."""
        _, a, b = self._others(k)
        over = int(owners.enters(a, b - a, *self.boxes[k]).sum())
        if k not in self._led:
            return over
        written = np.delete(self.written, len(self.written) - len(self.boxes) + k, axis=0)
        return int(owners.crossing(a, b, *self._led[k]).sum()) + _over(written, *self._led[k]) + over

    def met(self, k: int) -> list[int]:
        """Labels whose leader or lettering the leader of label ``k`` meets, and those whose leader meets its lettering."""
        others, a, b = self._others(k)
        found = others[owners.enters(a, b - a, *self.boxes[k])].tolist()
        if k in self._led:
            start, end = self._led[k]
            found += others[owners.crossing(a, b, start, end)].tolist()
            found += [n for n in np.flatnonzero(owners.enters(start, end - start, *self.boxes.T)).tolist() if n != k]
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

    def _box(self, target: npt.NDArray[np.uint8], corners: Points) -> None:
        x, y = corners.real.tolist(), corners.imag.tolist()  # four numbers: quicker without arrays
        i0, j0 = max(int((min(y) - self.area.y0) / CELL), 0), max(int((min(x) - self.area.x0) / CELL), 0)
        i1, j1 = int((max(y) - self.area.y0) / CELL) + 1, int((max(x) - self.area.x0) / CELL) + 1
        target[i0:max(i1, 0), j0:max(j1, 0)] = 1

    def free(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
        """Which rectangles lie inside the sheet, clear of heavy lines, lettering and the labels that are set."""
        clear = x0, y0, x1, y1 = sides + _MARGIN
        blocked = self.under(self.heavy, clear) > 0
        blocked |= (sides[:2] < self.inside[:2]).any(axis=0) | (sides[2:] > self.inside[2:]).any(axis=0)
        b = self.boxes
        b = b[(b[:, 2] > x0.min()) & (b[:, 0] < x1.max()) & (b[:, 3] > y0.min()) & (b[:, 1] < y1.max())]  # few are so near
        if len(b):
            beside = (x0[:, None] < b[:, 2]) & (x1[:, None] > b[:, 0])
            blocked |= (beside & (y0[:, None] < b[:, 3]) & (y1[:, None] > b[:, 1])).any(axis=1)
        return np.asarray(~blocked)

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

    def __init__(self, grid: Grid, label: Label, w: float, h: float, around: Around = USUAL) -> None:
        self.label, self._grid = label, grid
        away, directions = around
        units = directions if not label.away else directions * (label.away / abs(label.away))
        distances = away + label.gap
        # The rectangle's support along the direction keeps its nearest corner or side at the asked distance.
        support = np.minimum(w / 2 / np.maximum(np.abs(units.real), 1e-9), h / 2 / np.maximum(np.abs(units.imag), 1e-9))
        centres = (label.anchor + units[None, :] * (distances[:, None] + support[None, :])).ravel()
        # A label that should do without a leader line gets one only when nothing near is free.
        far = 0.0 if label.leader else FAR * (away > NEAR)
        cost = (distances * 1.2 + far)[:, None]
        cost = (cost + TURNING * np.abs(np.angle(directions)) / pi if label.away else np.repeat(cost, len(units), axis=1)).ravel()
        sides = np.array([centres.real - w / 2, centres.imag - h / 2, centres.real + w / 2, centres.imag + h / 2])
        x0, y0, x1, y1 = sides + _MARGIN
        self.run_on = _beside(sides, grid.written, WORD * label.height)
        cost = cost + label.thin * LIGHT * grid.under(grid.light, sides) + RUN_ON * self.run_on
        self._strayed = np.zeros(len(cost), bool)
        if 0 <= label.part < len(grid.views) and (view := grid.views[label.part]).contains(label.anchor):
            beyond = np.maximum.reduce([view.x0 - x0, view.y0 - y0, x1 - view.x1, y1 - view.y1])
            cost = cost + OUTSIDE * (beyond > 0)
            self._strayed = beyond > AWAY
        free = np.flatnonzero(grid.free(sides))
        if len(p := grid.leaders):
            some = free if len(free) else np.arange(len(cost))  # what the others would cost nobody asks
            x0, y0, x1, y1 = (side[some] for side in (x0, y0, x1, y1))
            p = p[(p.real > x0.min()) & (p.real < x1.max()) & (p.imag > y0.min()) & (p.imag < y1.max())]
            over = (p.real > x0[:, None]) & (p.real < x1[:, None]) & (p.imag > y0[:, None]) & (p.imag < y1[:, None])
            cost[some] += COVERING * over.any(axis=1)
        self.sides, self.cost = sides, cost
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
        far = STRAYED * bool(self._strayed[k])
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


def _beside(sides: npt.NDArray[np.float64], boxes: npt.NDArray[np.float64], gap: float) -> npt.NDArray[np.bool_]:
    """Which rectangles (x0, y0, x1, y1; shape (4, n)) have one of the ``boxes`` on their level nearer than ``gap``."""
    x0, y0, x1, y1 = sides
    b = boxes[(boxes[:, 2] > x0.min() - gap) & (boxes[:, 0] < x1.max() + gap) & (boxes[:, 3] > y0.min()) & (boxes[:, 1] < y1.max())]
    level = 0.4 * (y1 - y0)[:, None]  # an index of the one beside the bar of the other is not yet a word
    near = (x0[:, None] - gap < b[:, 2]) & (x1[:, None] + gap > b[:, 0])
    return np.asarray((near & (y0[:, None] + level < b[:, 3]) & (y1[:, None] - level > b[:, 1])).any(axis=1))


def _size(label: Label) -> tuple[float, float]:
    laid = letter(label.text, label.height)
    return laid.width + 0.15 * label.height, laid.ascent + laid.descent


Found = tuple[Label, Box, bool]
"""A label, which may have moved, its place, whether there was room for it."""


def _found(grid: Grid, ink: owners.Ink, k: int, label: Label, around: Around = USUAL) -> Found:
    found = _placed(grid, ink, label, *_size(label), around)
    grid.put(ink, k, *found[:2])
    return found


def _ill(grid: Grid, ink: owners.Ink, found: list[Found], some: tuple[int, ...]) -> int:
    """What is wrong with some labels where they stand, see :meth:`Grid.ill` and :func:`_misread`."""
    return sum(grid.ill(k) + _misread(grid, ink, *found[k][:2]) for k in some)


def _set_again(grid: Grid, ink: owners.Ink, labels: list[Label], found: list[Found], some: tuple[int, ...],
               around: Around) -> bool:
    """Take some labels off and set them again in this order; they stay where they were unless that makes it better."""
    before, ill = [found[k] for k in some], _ill(grid, ink, found, some)
    for k in some:
        grid.lift(ink, k)
    for k in some:
        found[k] = _found(grid, ink, k, labels[k], around)
    return _kept(grid, ink, found, some, before, ill)


def _made_room(grid: Grid, ink: owners.Ink, labels: list[Label], found: list[Found], k: int, q: int) -> bool:
    """Try the places of label ``k`` one after another until label ``q`` has a good one, too; else both stay where they were."""
    before, label, (w, h) = [found[k], found[q]], labels[k], _size(labels[k])
    for n in (k, q):
        grid.lift(ink, n)
    places = _Places(grid, label, w, h, CLOSER)
    for at in places.apart(owners.Round(ink, label, 2 * (NEAR + label.gap) + w)):
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


def _exchanged(grid: Grid, ink: owners.Ink, found: list[Found], k: int, q: int) -> bool:
    """Let two labels change places, as leaders that cross ask for, if both have room there and that makes it better."""
    before, ill = [found[k], found[q]], _ill(grid, ink, found, (k, q))
    for n in (k, q):
        grid.lift(ink, n)
    for n, (label, own, _), to in ((k, before[0], before[1][1].centre), (q, before[1], before[0][1].centre)):
        half = complex(own.width, own.height) / 2
        box = Box((to - half).real, (to - half).imag, (to + half).real, (to + half).imag)
        clear = bool(grid.free(np.array(box)[:, None])[0])
        found[n] = label, box, clear and (_led(label, box) or not _reads(ink, label, box))
        grid.put(ink, n, label, box)
    return _kept(grid, ink, found, (k, q), before, ill if found[k][2] and found[q][2] else 0)


def _kept(grid: Grid, ink: owners.Ink, found: list[Found], some: tuple[int, ...], before: list[Found], ill: int) -> bool:
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


def _placed(grid: Grid, ink: owners.Ink, label: Label, w: float, h: float, around: Around) -> tuple[Label, Box, bool]:
    """Place of a label, which may have moved along the vector it names rather than have a leader; whether there is room for it."""
    places = _Places(grid, label, w, h, around)
    here = owners.Round(ink, label, 2 * (NEAR + label.gap) + w)
    k = places.read(here)
    if k is None or places.run_on[k] or _led(label, Box(*places.sides[:, k])):
        # Lettering that keeps off thin lines had better have a leader than stand over some.
        most = np.inf if label.thin <= 1.0 or k is None else float(places.cost[k]) + places.ill(here, k)
        for anchor in here.along():
            moved = replace(label, anchor=anchor)
            others = _Places(grid, moved, w, h, around)
            there = others.read(owners.Round(ink, moved, 2 * (NEAR + label.gap) + w), leaders=False)
            if there is not None and not others.run_on[there] and others.cost[there] < most:
                return moved, Box(*others.sides[:, there]), True
    return label, Box(*places.sides[:, places.least() if k is None else k]), bool(len(places.free))


def _misread(grid: Grid, ink: owners.Ink, label: Label, box: Box) -> int:
    """Whether a label without a leader is read as another's because of the leader of one: more than a crossing of two leaders."""
    p = grid.leaders
    near = (p.real > box.x0 - NEAR) & (p.real < box.x1 + NEAR) & (p.imag > box.y0 - NEAR) & (p.imag < box.y1 + NEAR)
    if _led(label, box) or not near.any():
        return 0
    return SEVERAL * bool(_reads(ink, label, box))


def _reads(ink: owners.Ink, label: Label, box: Box) -> str:
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
    return int(owners.enters(a, b - a, x0, y0, x1, y1).sum())


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
