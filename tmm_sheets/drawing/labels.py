"""Labels find free places by themselves: off lines that lettering must never touch, rather off thin ones, near what they name.

All candidate places of a label are judged at once on the cells of the :mod:`~tmm_sheets.drawing.ink_index`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import islice
from math import pi
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import ink_index, owners
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.drawing.text_layout import CLEAR, SHELF, Crowded, size

TOGETHER = 64
"""So many labels have their places judged in one go."""
NEAR = 5.0
"""Clear distance, mm, up to which a label is read without a leader line."""
LIGHT = 0.9
"""Cost of a cell of thin line under lettering, in millimetres of distance."""

FAR = 1e3
"""Cost of a place that needs a leader line, for labels that should have none."""

BESIDE = 1.2
"""Clear distance, mm, between a symbol, such as a hinge, and its letter."""
WORD = 0.6
"""Lettering on one level that stands nearer than this, in heights of its capitals, is read on as one word."""
RUN_ON = 10.0
"""Cost of such a place, in millimetres of distance."""
COVERING = 30.0
"""Cost of a place over the leader of another label, in millimetres of distance."""
CROSSING, OVER, MISREAD = 8.0, 300.0, 1e4
"""Cost of each thing a leader crosses or runs along, of lettering under it, of being read as another thing's letter, mm."""
VAGUE = 6.0
"""Cost of a place about as near to another line as to the vector that is named, in millimetres of distance."""
IN_HEAD = 3 * VAGUE * owners.SPOT
"""Cost of a leader to a head where vectors run together: a name right beside its vector is better, mm."""
OUTSIDE = 20.0
"""Cost of a place that leaves the place of the label's view, in millimetres of distance."""
AWAY, STRAYED = 8.0, 24.0
"""So far beyond that place, mm, a label has left it: as bad as a leader that meets three things."""
SEVERAL = 10
"""So many leaders met are as bad as a label that is read as another thing's."""
TURNING = 4.0
"""Cost of the direction opposite to the one asked for, in millimetres of distance."""

Around = tuple[npt.NDArray[np.float64], Points]
"""Distances and directions, the first being the one asked for, in which places are tried."""
USUAL: Around = np.array([0.0, 0.6, 1.4, 2.5, 4.0, 6.0, 8.5, 11.0, 14.0, 18.0, 23.0]), np.exp(2j * pi * np.arange(24) / 24)
CLOSER: Around = np.concatenate(([0.0, 0.6, 1.4, 2.5], np.arange(4.0, 40.0))), np.exp(2j * pi * np.arange(96) / 96)
"""Many more, for the few labels whose leader meets something wherever it is led from the usual places."""
MANY = 96
"""So many places of a label that does not stand well at its first one are judged in one go."""
ROOMS = 8
"""So many places of a label are tried to make room for the one it meets."""
EVERYWHERE = Box(-np.inf, -np.inf, np.inf, np.inf)
"""Place of a view without a place."""
_MARGIN = CLEAR * np.array([-1.0, -1.0, 1.0, 1.0])[:, None]


class Placement(NamedTuple):
    """A label, which may have moved along its vector, its place, whether there was room for it.

    ``unsure``: it stands where another line is one with its vector, which is seen apart elsewhere.
    """

    label: Label
    box: Box
    free: bool
    unsure: bool = False



def set_labels(canvas: Canvas, ink: InkIndex, final: bool = True) -> list[Crowded]:
    """Set every requested label of a canvas on its ``ink``, to which they come; returns those that found no free place.

    What meets a leader that was set after it gets another place when all the others have theirs, unless this is not ``final``.
    """
    first = len(canvas.marks)
    placed = PlacedLabels(ink, canvas.labels, [part.box for part in canvas.parts])
    placed.place_all()
    for around in (USUAL, CLOSER) if final else ():
        if placed.improve_all(around):  # what makes way may let others stand better
            placed.improve_all(around)
    for label, box, *_ in placed.at:
        draw_label(canvas, label, box)
    ink.add(canvas.marks[first:])
    crowded = [Crowded(label.text, label.anchor) for label, at in zip(canvas.labels, placed.at, strict=True) if not at.free]
    canvas.labels.clear()
    return crowded


class PlacedLabels:
    """Labels where they stand (``at``) on the ``ink`` of a canvas, with their leaders.

    Lettering of the canvas (``written``) ends with theirs (``boxes``): x0, y0, x1, y1, mm, not numbers where one is not set.
    ``views`` are the places of the parts that labels belong to. What is farther off than where labels were ``looked`` for does not
    change what is found.
    """

    def __init__(self, ink: InkIndex, labels: Sequence[Label], views: Sequence[Box] = ()) -> None:
        self.ink, self.labels, self.views = ink, labels, views
        self.at = list[Placement]()
        self.inside = np.array(ink.area.inset(1))[:, None]
        self.written = np.vstack((ink.written, np.full((len(labels), 4), np.nan)))
        self.boxes = self.written[len(ink.written):]
        self._led: dict[int, tuple[complex, complex]] = {}
        self._unsure = dict[tuple[Label, complex, complex], int]()
        self.looked = list[tuple[Label, Box]]()
        self._in_vain = dict[tuple[int, bool], npt.NDArray[np.float64]]()
        self._update_leaders()

    def put(self, k: int, placement: Placement) -> None:
        """Label ``k`` is set."""
        vars(self).pop("_disturbed", None)
        self.at[k:k + 1] = [placement]
        label, box, *_ = placement
        self.boxes[k] = box
        self.looked.append((label, box))
        before, led = self._led.pop(k, None), leader_to(label, box)
        if led is not None:
            self._led[k] = led
        if before is not None or led is not None:
            self._update_leaders()

    def lift(self, k: int) -> None:
        """Label ``k`` is taken off."""
        self.boxes[k] = np.nan
        if self._led.pop(k, None) is not None:
            self._update_leaders()

    def _update_leaders(self) -> None:
        self._whose = np.array(list(self._led), int)
        self._ends = np.array(list(self._led.values()), complex).reshape(-1, 2)
        self._led_sides = ink_index.sides(*self._ends.T)
        points = ink_index.sample(self._ends[:, 0], self._ends[:, 1], ink_index.CELL / 2)
        self.leaders = np.array([points.real, points.imag, points.real, points.imag]).T
        self.ink.set_leaders(*self._ends.T)

    @cached_property
    def _disturbed(self) -> set[int]:
        """Labels that have a leader, or one near them, or are unsure: nothing can be wrong with others that was not before."""
        pairs = ink_index.are_near(self._led_sides, self.boxes.T[:, :, None], NEAR + ink_index.ROUNDING)
        near = np.logical_or.reduce(pairs, axis=1)
        return {*near.nonzero()[0].tolist(), *self._led, *(k for k, at in enumerate(self.at) if at.unsure)}

    def count_faults(self, *some: int) -> int:
        """How many things are wrong with some labels where they stand; to be read as another thing's is worse than the others."""
        return sum([self._count_met(k) + SEVERAL * self._is_misread(k) for k in some])

    def _count_met(self, k: int) -> int:
        """How many other leaders and how much other lettering the leader of label ``k`` meets; how many leaders its lettering;
        which lines but its own it might be led to.
        """
        _, a, b = self._other_leaders(k)
        over = int(ink_index.enters(a, b - a, *self.boxes[k]).sum())
        if k not in self._led:
            return over
        led = label, start, end = self.at[k].label, *self._led[k]
        if led not in self._unsure:
            here = surroundings(self.ink, label)
            self._unsure[led] = int(here.count_unsure(here.first_met(np.array([start]), np.array([end])))[0])
        written = ink_index.enters(start, end - start, *self.written.T)
        written[len(written) - len(self.boxes) + k] = False
        return over + int(owners.meet(a, b, start, end).sum() + written.sum()) + self._unsure[led]

    def _is_misread(self, k: int) -> bool:
        """Whether label ``k`` has no leader and is read as another's, because of one or where its vector is one with another."""
        label, box, _, unsure = self.at[k]
        return k not in self._led and (unsure or (len(ink_index.find_near(self.leaders.T, box, NEAR)) > 0
                                                  and bool(surroundings(self.ink, label).misreading(box))))

    def in_conflict(self, k: int) -> list[int]:
        """Labels whose leader or lettering the leader of label ``k`` meets, and those whose leader meets its lettering."""
        others, a, b = self._other_leaders(k)
        found = others[ink_index.enters(a, b - a, *self.boxes[k])].tolist()
        if k in self._led:
            start, end = self._led[k]
            found += others[owners.meet(a, b, start, end)].tolist()
            found += [n for n in np.flatnonzero(ink_index.enters(start, end - start, *self.boxes.T)).tolist() if n != k]
        return list(dict.fromkeys(found))

    def _other_leaders(self, k: int) -> tuple[npt.NDArray[np.int_], Points, Points]:
        """Labels with leaders but for label ``k``, and where their leaders begin and end."""
        other = self._whose != k
        a, b = self._ends[other].T
        return self._whose[other], a, b

    def are_clear(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
        """Which rectangles lie inside the sheet, clear of heavy lines and lettering but for that of labels."""
        blocked = self.ink.heavy.count_under(sides + _MARGIN) > 0
        blocked |= (sides[:2] < self.inside[:2]).any(axis=0) | (sides[2:] > self.inside[2:]).any(axis=0)
        return np.asarray(~blocked)

    def place_all(self) -> None:
        """Set labels one after another."""
        for begin in range(0, len(self.labels), TOGETHER):
            some = self.labels[begin:begin + TOGETHER]
            tried = candidate_places(self, some)
            first = _first_places(self, some, tried)
            for k, (label, candidates, box) in enumerate(zip(some, tried, first, strict=True), begin):
                if box is not None and self._is_left_alone(box, label, begin, k):
                    self.put(k, Placement(label, box, True))
                else:
                    self.put(k, _place(self, label, candidates, USUAL))

    def _is_left_alone(self, box: Box, label: Label, begin: int, end: int) -> bool:
        """Whether no label from one number up to another, and no leader, is near enough to change what was found of a place.

        What is set only makes places dearer or takes them: one that is not touched stays the cheapest.
        """
        since = self.boxes[begin:end].T, max(CLEAR, WORD * label.height)
        leaders = self._led_sides, abs(box.nearest(label.anchor) - label.anchor) + CLEAR
        return not any(len(ink_index.find_near(sides, box, reach)) for sides, reach in (since, leaders))

    def improve_all(self, around: Around) -> bool:
        """Give labels with which something is wrong better places, one after another; whether any has got one."""
        return sum([self.improve(k, around) for k in range(len(self.at)) if k in self._disturbed]) > 0

    def improve(self, k: int, around: Around) -> bool:
        """Give label ``k`` a better place if something is wrong with it, and what it meets another one if need be.

        Where that was in vain it is not tried again before something has moved where it was looked for.
        """
        if (k, around is CLOSER) in self._in_vain or not self.count_faults(k):
            return False
        self.looked.clear()
        # One that has no better place gets it when the one it meets makes room, or else all that stand where it had better be.
        ways = ((k,), *(pair for q in self.in_conflict(k) for pair in ((k, q), (q, k))))
        found = any(self.set_again(some, around) for some in ways) or (
            around is CLOSER and (self.set_alone(k) or any(self.make_room(*pair) for pair in ways[1:])))
        if not found:
            self._in_vain[k, around is CLOSER] = np.array([_extent(*each).inset(-_reach(each[0])) for each in self.looked]).T
        return found

    def _place_again(self, k: int, around: Around) -> None:
        (candidates,) = candidate_places(self, [self.labels[k]], around)
        self.put(k, _place(self, self.labels[k], candidates, around))

    def set_again(self, some: tuple[int, ...], around: Around, first: Placement | None = None, well: bool = False) -> bool:
        """Take some labels off and set them again in this order, the first one where it is told if it is.

        They stay where they were unless that makes it better, or leaves nothing wrong (``well``).
        """
        before, faults = [self.at[k] for k in some], 1 if well else self.count_faults(*some)
        for k in some:
            self.lift(k)
        for k in some:
            if first is not None and k == some[0]:
                self.put(k, first)
            else:
                self._place_again(k, around)
        if self.count_faults(*some) < faults and all(self.at[k].free >= was.free for k, was in zip(some, before, strict=True)):
            moved = [_extent(*placement[:2]) for placement in (*before, *(self.at[k] for k in some))]
            self._in_vain = {key: looked for key, looked in self._in_vain.items()
                             if not any(len(ink_index.find_near(looked, box, 0.0)) for box in moved)}
            return True
        self._put_back(some, before)
        return False

    def _put_back(self, some: Sequence[int], before: Sequence[Placement]) -> None:
        for k, was in zip(some, before, strict=True):
            self.put(k, was)

    def set_alone(self, k: int) -> bool:
        """Set label ``k`` where it would stand if there were no others, and those it meets there anew, if that makes it better."""
        alone, was = PlacedLabels(self.ink, self.labels[k:k + 1], self.views), self.at[k]
        alone._place_again(0, CLOSER)
        (there,) = alone.at
        self.put(k, there)
        near = ink_index.find_near(self.boxes.T, there.box, CLEAR).tolist()
        some = tuple(dict.fromkeys((k, *near, *self.in_conflict(k))))
        self.put(k, was)
        return self.set_again(some, CLOSER, there)

    def make_room(self, k: int, q: int) -> bool:
        """Try some places of label ``k`` in turn until label ``q`` has a good one, too; else both stay where they were."""
        before, label = [self.at[k], self.at[q]], self.labels[k]
        for n in (k, q):
            self.lift(n)
        (candidates,) = candidate_places(self, [label], CLOSER)
        places = Places(self, label, candidates)
        rooms = [*islice(places.well_apart(surroundings(self.ink, label)), ROOMS)]
        self._put_back((k, q), before)
        return any(self.set_again((k, q), CLOSER, Placement(label, places.box(at), True), well=True) for at in rooms)


class _Candidates(NamedTuple):
    """Places about a label's anchor before others are set: rectangles ``sides`` (x0, y0, x1, y1; shape (4, n)) and their ``cost``.

    Those that have ``strayed`` leave the place of the label's view too far. ``clear`` are those inside the sheet and clear of heavy
    lines; all are within the box ``around`` them.
    """

    sides: npt.NDArray[np.float64]
    cost: npt.NDArray[np.float64]
    strayed: npt.NDArray[np.bool_]
    clear: npt.NDArray[np.bool_]
    around: Box


def candidate_places(placed: PlacedLabels, labels: Sequence[Label], around: Around = USUAL) -> list[_Candidates]:
    """Places about the anchors of some labels, judged together."""
    if not labels:
        return []
    away, directions = around
    turned = TURNING * np.abs(np.angle(directions)) / pi
    units = np.array([directions * (label.away / abs(label.away)) if label.away else directions for label in labels])
    w, h = np.array([size(label.text, label.height) for label in labels]).T[:, :, None, None] / 2
    h = h + SHELF / 2 * np.array([bool(label.shelf) for label in labels])[:, None, None]
    # The rectangle's support along the direction keeps its nearest corner or side at the asked distance.
    support = np.minimum(w / np.maximum(np.abs(units.real), 1e-9)[:, None], h / np.maximum(np.abs(units.imag), 1e-9)[:, None])
    distances = away[:, None] + np.array([label.gap for label in labels])[:, None, None]
    centres = np.array([label.anchor for label in labels])[:, None, None] + units[:, None] * (distances + support)
    sides = np.array([centres.real - w, centres.imag - h, centres.real + w, centres.imag + h]).reshape(4, len(labels), -1)
    flat_ = sides.reshape(4, -1)
    light = placed.ink.light.count_under(flat_).reshape(sides.shape[1:])
    clear = placed.are_clear(flat_).reshape(sides.shape[1:])
    edges = [*sides[:2].min(axis=2), *sides[2:].max(axis=2)]
    found = list[_Candidates]()
    for k, label in enumerate(labels):
        # A label that should do without a leader line gets one only when nothing near is free.
        cost = distances[k] * 1.2 + (0.0 if label.leader else FAR * (away > NEAR)[:, None])
        cost = (cost + turned if label.away else np.repeat(cost, len(directions), axis=1)).ravel()
        own = placed.views[label.part] if 0 <= label.part < len(placed.views) else EVERYWHERE
        view = own if own.contains(label.anchor) else EVERYWHERE
        x0, y0, x1, y1 = sides[:, k] + _MARGIN
        beyond = np.maximum.reduce([view.x0 - x0, view.y0 - y0, x1 - view.x1, y1 - view.y1])
        cost += label.thin * LIGHT * light[k] + OUTSIDE * (beyond > 0)
        found.append(_Candidates(sides[:, k], cost, beyond > AWAY, clear[k], Box(*[edge[k] for edge in edges])))
    return found


def _first_places(placed: PlacedLabels, labels: Sequence[Label], tried: Sequence[_Candidates]) -> list[Box | None]:
    """The cheapest place of each label if nothing is wrong with it, leaders aside, judged together; None where it needs thought."""
    found: list[Box | None] = [None] * len(labels)
    cost = np.array([np.where(each.clear, each.cost, np.inf) for each in tried])
    best = np.argmin(cost, axis=1)
    there = np.array([each.sides[:, k] for each, k in zip(tried, best.tolist(), strict=True)]).T
    p, gap, heights = [np.array(v) for v in zip(*[(label.anchor, label.gap, label.height) for label in labels], strict=True)]
    x0, y0, x1, y1 = there
    way = np.abs(owners.nearest(p, there) - p)
    sure = np.isfinite(cost[np.arange(len(labels)), best]) & (way <= NEAR + gap) & np.array([not label.shelf for label in labels])
    sure &= np.array([not each.strayed[k] for each, k in zip(tried, best.tolist(), strict=True)])
    apart = np.maximum(CLEAR, WORD * heights)
    sure &= ~_overlap(np.array([x0 - apart, y0 - CLEAR, x1 + apart, y1 + CLEAR]), placed.written)
    some = sure.nonzero()[0]
    if len(some):
        right = owners.read_well(placed.ink, [labels[k] for k in some.tolist()], there[:, some])
        for k in some[right].tolist():
            found[k] = Box(*there[:, k].tolist())
    return found


class Places:
    """Where a label may stand about its anchor: rectangles ``sides`` (x0, y0, x1, y1; shape (4, n)), their ``cost``, and
    numbers of the ``free`` ones, the cheapest first.
    """

    def __init__(self, placed: PlacedLabels, label: Label, candidates: _Candidates) -> None:
        self.label, self._placed = label, placed
        self.sides, cost, self._strayed, clear, around = candidates
        placed.looked.append((label, around))
        free = clear.nonzero()[0]
        near = placed.boxes[ink_index.find_near(placed.boxes.T, around, CLEAR)]
        free = free[~_overlap(self.sides[:, free] + _MARGIN, near)]
        some = free if len(free) else np.arange(len(cost))  # what the others would cost nobody asks
        there = self.sides[:, some]
        gap = WORD * label.height
        read_on = reads_on(there, placed.written[ink_index.find_near(placed.written.T, around, gap)], gap)
        leaders = placed.leaders[ink_index.find_near(placed.leaders.T, around, CLEAR)]
        self.cost = np.zeros(len(cost)) + np.inf
        self.cost[some] = cost[some] + RUN_ON * read_on + COVERING * _overlap(there + _MARGIN, leaders)
        self.run_on = np.zeros(len(cost), bool)
        self.run_on[some] = read_on
        self.free = free[self.cost[free].argsort(kind="stable")]
        self.led = (np.abs(owners.nearest(label.anchor, self.sides) - label.anchor) > NEAR + label.gap) | bool(label.shelf)

    def choose(self, here: owners.Surroundings, leaders: bool = True, least: float = np.inf) -> tuple[int | None, float]:
        """The cheapest free place where the label reads as what it names, or has a leader that meets nothing; cost of its fault.

        Where there is none the best of the others: a leader had better cross a line than the label be read as another thing's, or
        the leader run over lettering. Without ``leaders`` none of those but such as are only vague; none with a fault that costs
        ``least`` or more.
        """
        best, worst, enough = None, np.inf, np.inf
        found = dict[int, float]()
        # What is wrong with the spot that is named is wrong with every place: one with nothing else is as good as any.
        spot = here.unsure * np.where(self.led, CROSSING * owners.LED if here.head is None else IN_HEAD, VAGUE * owners.SPOT) \
            if here.unsure else None
        asked = self.free if leaders else self.free[~self.led[self.free]]
        if spot is not None:
            asked = asked[self.cost[asked] + spot[asked] < least]
        for rank, k in enumerate(asked.tolist()):
            if self.cost[k] >= enough:
                break
            if spot is not None and self.cost[k] + spot[k] >= least:
                continue
            if k not in found:
                some = asked[rank:rank + max(MANY, rank)].tolist()
                found |= zip(some, self.faults(here, some), strict=True)
            fault = found[k]
            if not fault or (spot is not None and fault <= spot[k]):
                return k, fault
            if self.cost[k] + fault < least and (leaders or fault <= VAGUE):
                best, least, worst = k, self.cost[k] + fault, fault
            if fault <= VAGUE:
                enough = min(enough, self.cost[k] + fault)
        return best, worst

    def box(self, k: int) -> Box:
        """A place."""
        return Box(*self.sides[:, k].tolist())

    def faults(self, here: owners.Surroundings, some: Sequence[int]) -> list[float]:
        """Costs of what is wrong with the label at some places, 0 for nothing."""
        label, sides = self.label, self.sides[:, some]
        found = np.zeros(len(some)) + STRAYED * self._strayed[some]
        led, alone = self.led[some].nonzero()[0], (~self.led[some]).nonzero()[0]
        if len(alone):
            bad, vague = here.judge(sides[:, alone])
            found[alone] += np.where(bad, MISREAD, VAGUE * vague)
        if len(led):
            if label.shelf:
                p, q = np.array([leader_to(label, self.box(some[k])) for k in led.tolist()]).T
            else:
                p, q = np.full(len(led), label.anchor), owners.nearest(label.anchor, sides[:, led])
            written = self._placed.written
            wx0, wy0, wx1, wy1 = written[ink_index.find_near(written.T, Box.around(np.concatenate((p, q))), 0.0)].T
            over = ink_index.enters(p[:, None], (q - p)[:, None], wx0, wy0, wx1, wy1).sum(axis=1)
            found[led] += OVER * over + CROSSING * here.count_crossed(p, q)
            if here.head is not None:
                found[led] += IN_HEAD * here.unsure
        costs: list[float] = found.tolist()
        return costs

    def well_apart(self, here: owners.Surroundings) -> Iterator[int]:
        """Free places whose leader runs over no lettering, the cheapest first, none near one before it."""
        centres = (self.sides[:2] + self.sides[2:]).T @ [0.5, 0.5j]
        left = self.free
        while len(left):
            k, left = int(left[0]), left[1:]
            if self.faults(here, [k])[0] < OVER:
                yield k
                left = left[np.abs(centres[left] - centres[k]) > NEAR]

    def cheapest(self) -> int:
        """The cheapest place, or where none is free the one that is least inked."""
        if len(self.free):
            return int(self.free[0])
        return int(np.argmin(self.cost + 20.0 * self._placed.ink.heavy.count_under(self.sides)))


def _overlap(sides: npt.NDArray[np.float64], boxes: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """Which rectangles (x0, y0, x1, y1; shape (4, n)) overlap one of the ``boxes``, shape (m, 4)."""
    x0, y0, x1, y1 = sides[:, :, None]
    b = boxes.T
    return np.asarray(((x0 < b[2]) & (x1 > b[0]) & (y0 < b[3]) & (y1 > b[1])).any(axis=1))


def reads_on(sides: npt.NDArray[np.float64], boxes: npt.NDArray[np.float64], gap: float) -> npt.NDArray[np.bool_]:
    """Which of them have one of the boxes on their level nearer than ``gap``."""
    x0, y0, x1, y1 = sides
    level = 0.4 * (y1 - y0)  # an index of the one beside the bar of the other is not yet a word
    return _overlap(np.array([x0 - gap, y0 + level, x1 + gap, y1 - level]), boxes)


def draw_label(canvas: Canvas, label: Label, box: Box) -> None:
    """Draw a label where it stands, with its leader."""
    laid, shelf = letter(label.text, label.height), SHELF * bool(label.shelf)
    canvas.of, first = label.of, len(canvas.marks)
    pen = canvas.tracing("text", *(label.by[1:] if label.by is not None else ()))
    pen.put(laid, complex(box.x0, box.y0 + shelf + laid.descent), 0.0, label.text)
    _draw_leader(pen, label, box)
    if len(canvas.marks) > first:
        # The leader line belongs to its label.
        canvas.groups[-1] = canvas.groups[-1]._replace(end=len(canvas.marks), part=label.part, anchor=label.anchor)
    if label.dimension >= 0:
        d = canvas.dimensions[label.dimension]
        canvas.dimensions[label.dimension] = d._replace(label=(first, len(canvas.marks)), middle=box.centre)


def _place(placed: PlacedLabels, label: Label, candidates: _Candidates, around: Around) -> Placement:
    """Place of a label, which may have moved along the vector it names rather than have a leader; whether there is room for it."""
    places, here = Places(placed, label, candidates), surroundings(placed.ink, label)
    k, fault = places.choose(here)
    found = Placement(label, places.box(places.cheapest() if k is None else k), bool(len(places.free)))
    vague, sure = 0 < fault <= VAGUE, not here.unsure
    cost = fault if k is None else float(places.cost[k]) + fault
    unread = k is None or fault > VAGUE
    if unread or places.run_on[k] or vague or leader_to(*found[:2]) is not None:
        along = [label._replace(anchor=anchor) for anchor in here.places_along()]
        for moved, tried in zip(along, candidate_places(placed, along, around), strict=True):
            beside = surroundings(placed.ink, moved)
            of_vector = beside.vector is not None  # so near to its end a leader would name the point
            sure = sure or (of_vector and not beside.unsure)
            if beside.unsure and not (unread and of_vector):
                continue
            others = Places(placed, moved, tried)
            there, fault = others.choose(beside, unread and of_vector, cost)
            # Lettering that keeps off thin lines had better have a leader than stand over some.
            if there is not None and not others.run_on[there] and (
                    others.cost[there] + fault < cost or not (fault or vague or label.thin > 1.0)):
                found, cost, here = Placement(moved, others.box(there), True), others.cost[there] + fault, beside
                if not fault:
                    break
    return found._replace(unsure=sure and here.runs_together())


def surroundings(ink: InkIndex, label: Label) -> owners.Surroundings:
    """What is near the anchor of a label, as far as it may stand from there; of lines on the ink it is looked for once."""
    found: owners.Surroundings | None = ink.surroundings.get(label)
    if found is None:
        found = ink.surroundings[label] = owners.Surroundings(ink, label, _reach(label))
    found.meet_leaders()
    return found


def _reach(label: Label) -> float:
    """How far from the anchor of a label that is read without a leader anything matters, mm."""
    return 2 * (NEAR + label.gap) + size(label.text, label.height)[0]


def _extent(label: Label, box: Box) -> Box:
    """The rectangle round a label's lettering and what it names, with the leader between them."""
    return Box.around(np.append(box.corners, label.anchor))


def leader_to(label: Label, box: Box) -> tuple[complex, complex] | None:
    """From the anchor to the nearest point of lettering that stands too far to be read without a leader; None if it does not.

    Or from the edge of what is named to its shelf.
    """
    if not label.shelf:
        end = box.nearest(label.anchor)
        return (label.anchor, end) if abs(end - label.anchor) > NEAR + label.gap else None
    left, right = _shelf_ends(box)
    end = right if abs(right - label.anchor) < abs(left - label.anchor) else left
    return label.anchor + label.shelf * (end - label.anchor) / abs(end - label.anchor), end


def _shelf_ends(box: Box) -> tuple[complex, complex]:
    """Ends of the shelf that lettering stands on."""
    return complex(box.x0, box.y0), complex(box.x1, box.y0)


def _draw_leader(canvas: Canvas, label: Label, box: Box) -> None:
    """Thin line to lettering that needs a leader, and the shelf under it."""
    if (led := leader_to(label, box)) is None:
        return
    start, end = led
    if label.shelf:
        canvas.line(start, end, "thin")
        canvas.line(*_shelf_ends(box), "thin")
    else:
        u = (end - start) / abs(end - start)
        # A label that keeps off its anchor stands beside a symbol: the line ends at that symbol's edge, not inside it.
        canvas.line(start + max(label.gap - BESIDE, 0.0) * u, end - 0.6 * u, "thin")
