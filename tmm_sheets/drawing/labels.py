"""Labels find free places by themselves: off lines that lettering must never touch, rather off thin ones, near what they name.

All candidate places of a label are judged at once on the cells of the :mod:`~tmm_sheets.drawing.ink_index`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import pi
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import ink_index, owners
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.crowded import Crowded
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.drawing.text_boxes import size

TOGETHER = 64
"""So many labels have their places judged in one go."""
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


def set_labels(canvas: Canvas, ink: InkIndex) -> list[Crowded]:
    """Set every requested label of a canvas on its ``ink``, to which they come; returns those that found no free place.

    What meets a leader that was set after it gets another place when all the others have theirs.
    """
    first = len(canvas.marks)
    grid = Grid(ink, len(canvas.labels), [part.box for part in canvas.parts])
    found = [*_first(grid, canvas.labels)]
    for around in (USUAL, USUAL, CLOSER):
        for k in range(len(found)):
            if not grid.quiet(k) and _ill(grid, found, (k,)):
                # One that has no better place gets it when the one it meets makes room, or changes places with it.
                ways = ((k,), *(pair for q in grid.met(k) for pair in ((k, q), (q, k))))
                done = any(_set_again(grid, canvas.labels, found, some, around) for some in ways) or \
                    any(_exchanged(grid, found, k, q) for q in grid.met(k))
                if around is CLOSER and not done:
                    any(_made_room(grid, canvas.labels, found, *pair) for pair in ways[1:])
    for label, box, _ in found:
        _draw(canvas, label, box)
    ink.add(canvas.marks[first:])
    crowded = [Crowded(label.text, label.anchor) for label, (_, _, free) in zip(canvas.labels, found, strict=True) if not free]
    canvas.labels.clear()
    return crowded


class Grid:
    """Labels of a canvas on its ``ink``: lettering (``written``), theirs (``boxes``) last, and their leaders.

    Places of labels that are not set are not numbers. ``views`` are the places of the parts that labels belong to.
    """

    def __init__(self, ink: InkIndex, labels: int, views: Sequence[Box] = ()) -> None:
        """So many ``labels`` are to come, to parts in the places ``views``."""
        self.ink, self.views = ink, views
        self.inside = np.array([ink.area.x0 + 1, ink.area.y0 + 1, ink.area.x1 - 1, ink.area.y1 - 1])[:, None]
        self.written = np.vstack((ink.written, np.full((labels, 4), np.nan)))
        self.boxes = self.written[len(ink.written):]
        self._led: dict[int, tuple[complex, complex]] = {}
        self._lead()

    def put(self, k: int, label: Label, box: Box) -> None:
        """Label ``k`` is set; the shelf it may stand on is part of it."""
        self.boxes[k] = box._replace(y0=box.y0 - SHELF - CLEAR) if label.shelf else box
        before = self._led.pop(k, None)
        if _led(label, box):
            self._led[k] = _way(label, box)
        if before is not None or k in self._led:
            self._lead()

    def lift(self, k: int) -> None:
        """Label ``k`` is taken off."""
        self.boxes[k] = np.nan
        if self._led.pop(k, None) is not None:
            self._lead()

    def _lead(self) -> None:
        self._whose = np.array(list(self._led), int)
        self._ends = np.array(list(self._led.values()), complex).reshape(-1, 2)
        self._led_sides = ink_index.sides(*self._ends.T)
        self.leaders = ink_index.sampled(self._ends[:, 0], self._ends[:, 1], ink_index.CELL / 2)
        self.ink.lead(*self._ends.T)

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

    def free(self, box: Box) -> bool:
        """Whether a rectangle lies inside the sheet, clear of heavy lines, lettering and the labels that are set."""
        sides = np.array(box)[:, None]
        near = self.boxes[ink_index.within(self.boxes.T, box, CLEAR)]
        return bool(self.clear(sides)[0] and not _meeting(sides + _MARGIN, near)[0])

    def clear(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
        """Which rectangles lie inside the sheet, clear of heavy lines and lettering but for that of labels."""
        blocked = self.ink.heavy.under(sides + _MARGIN) > 0
        blocked |= (sides[:2] < self.inside[:2]).any(axis=0) | (sides[2:] > self.inside[2:]).any(axis=0)
        return np.asarray(~blocked)


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
    w, h = np.array([size(label.text, label.height) for label in labels]).T[:, :, None, None] / 2
    # The rectangle's support along the direction keeps its nearest corner or side at the asked distance.
    support = np.minimum(w / np.maximum(np.abs(units.real), 1e-9)[:, None], h / np.maximum(np.abs(units.imag), 1e-9)[:, None])
    distances = away[:, None] + np.array([label.gap for label in labels])[:, None, None]
    centres = np.array([label.anchor for label in labels])[:, None, None] + units[:, None] * (distances + support)
    sides = np.array([centres.real - w, centres.imag - h, centres.real + w, centres.imag + h]).reshape(4, len(labels), -1)
    flat_ = sides.reshape(4, -1)
    light = grid.ink.light.under(flat_).reshape(sides.shape[1:])
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
        return int(np.argmin(self.cost + 20.0 * self._grid.ink.heavy.under(self.sides)))


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


Found = tuple[Label, Box, bool]
"""A label, which may have moved, its place, whether there was room for it."""


def _first(grid: Grid, labels: Sequence[Label]) -> Iterator[Found]:
    """Set labels one after another."""
    for begin in range(0, len(labels), TOGETHER):
        some = labels[begin:begin + TOGETHER]
        for k, (label, lattice) in enumerate(zip(some, _lattices(grid, some), strict=True), begin):
            found = _placed(grid, label, lattice, USUAL)
            grid.put(k, *found[:2])
            yield found


def _found(grid: Grid, k: int, label: Label, around: Around) -> Found:
    (lattice,) = _lattices(grid, [label], around)
    found = _placed(grid, label, lattice, around)
    grid.put(k, *found[:2])
    return found


def _ill(grid: Grid, found: list[Found], some: tuple[int, ...]) -> int:
    """What is wrong with some labels where they stand, see :meth:`Grid.ill` and :func:`_misread`."""
    return sum(grid.ill(k) + _misread(grid, *found[k][:2]) for k in some)


def _set_again(grid: Grid, labels: list[Label], found: list[Found], some: tuple[int, ...],
               around: Around) -> bool:
    """Take some labels off and set them again in this order; they stay where they were unless that makes it better."""
    before, ill = [found[k] for k in some], _ill(grid, found, some)
    for k in some:
        grid.lift(k)
    for k in some:
        found[k] = _found(grid, k, labels[k], around)
    return _kept(grid, found, some, before, ill)


def _made_room(grid: Grid, labels: list[Label], found: list[Found], k: int, q: int) -> bool:
    """Try the places of label ``k`` one after another until label ``q`` has a good one, too; else both stay where they were."""
    before, label = [found[k], found[q]], labels[k]
    for n in (k, q):
        grid.lift(n)
    places = _Places(grid, label, *_lattices(grid, [label], CLOSER))
    for at in places.apart(owners.Round(grid.ink, label, 2 * (NEAR + label.gap) + size(label.text, label.height)[0])):
        found[k] = label, places.box(at), True
        grid.put(k, *found[k][:2])
        found[q] = _found(grid, q, labels[q], CLOSER)
        if not _ill(grid, found, (k, q)):
            return True
        for n in (k, q):
            grid.lift(n)
    for n, was in zip((k, q), before, strict=True):
        found[n] = was
        grid.put(n, *was[:2])
    return False


def _exchanged(grid: Grid, found: list[Found], k: int, q: int) -> bool:
    """Let two labels change places, as leaders that cross ask for, if both have room there and that makes it better."""
    before, ill = [found[k], found[q]], _ill(grid, found, (k, q))
    for n in (k, q):
        grid.lift(n)
    for n, (label, own, _), to in ((k, before[0], before[1][1].centre), (q, before[1], before[0][1].centre)):
        half = complex(own.width, own.height) / 2
        box = Box((to - half).real, (to - half).imag, (to + half).real, (to + half).imag)
        found[n] = label, box, grid.free(box) and (_led(label, box) or not _reads(grid.ink, label, box))
        grid.put(n, label, box)
    return _kept(grid, found, (k, q), before, ill if found[k][2] and found[q][2] else 0)


def _kept(grid: Grid, found: list[Found], some: tuple[int, ...], before: list[Found], ill: int) -> bool:
    """Whether labels stand better than ``ill`` now; else they go back to where they were before."""
    if _ill(grid, found, some) < ill:
        return True
    for k, was in zip(some, before, strict=True):
        found[k] = was
        grid.put(k, *was[:2])
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


def _placed(grid: Grid, label: Label, lattice: _Lattice, around: Around) -> Found:
    """Place of a label, which may have moved along the vector it names rather than have a leader; whether there is room for it."""
    places, reach = _Places(grid, label, lattice), 2 * (NEAR + label.gap) + size(label.text, label.height)[0]
    here = owners.Round(grid.ink, label, reach)
    k = places.read(here)
    if k is None or places.run_on[k] or _led(label, Box(*places.sides[:, k])):
        # Lettering that keeps off thin lines had better have a leader than stand over some.
        most = np.inf if label.thin <= 1.0 or k is None else float(places.cost[k]) + places.ill(here, k)
        moves = [replace(label, anchor=anchor) for anchor in here.along()]
        for moved, other in zip(moves, _lattices(grid, moves, around) if moves else (), strict=True):
            others = _Places(grid, moved, other)
            there = others.read(owners.Round(grid.ink, moved, reach), leaders=False)
            if there is not None and not others.run_on[there] and others.cost[there] < most:
                return moved, Box(*others.sides[:, there]), True
    return label, Box(*places.sides[:, places.least() if k is None else k]), bool(len(places.free))


def _misread(grid: Grid, label: Label, box: Box) -> int:
    """Whether a label without a leader is read as another's because of the leader of one: more than a crossing of two leaders."""
    p = grid.leaders
    near = (p.real > box.x0 - NEAR) & (p.real < box.x1 + NEAR) & (p.imag > box.y0 - NEAR) & (p.imag < box.y1 + NEAR)
    if _led(label, box) or not near.any():
        return 0
    return SEVERAL * bool(_reads(grid.ink, label, box))


def _reads(ink: InkIndex, label: Label, box: Box) -> str:
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
