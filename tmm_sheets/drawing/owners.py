"""What a reader takes a label for: the line or point nearest to it, if nothing lies between.

A label names what it was asked for. Read without knowing that, it names what stands nearest; so its own line or point must be
nearer than any other, and the shortest way there must cross none. Where there is no such place a leader line says it.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf
from typing import Any

import numpy as np

from tmm_sheets.drawing.canvas import Label
from tmm_sheets.drawing.ink_index import LEADER, ROUNDING, Flags, Floats, InkIndex, crosses, distance, enters, find_near, sides
from tmm_sheets.drawing.marks import Box, Line, flat
from tmm_sheets.drawing.text_boxes import run_corners

AT = 0.3
"""Lines that pass this near the anchor meet there: a letter at a point is nearer to all of them than to any other, mm."""
SLACK = 0.1
"""By so much another line may be nearer before anybody takes the label for its letter, mm."""

CLEARLY, SEEN = 1.0, 6.0
"""By so much its own vector is nearer to a letter that nobody takes for another's, of all that is within so many mm."""
SYMBOL = 0.6
"""By so much a symbol about the anchor may reach beyond the distance its letter keeps, mm."""

PARALLEL, BESIDE = 0.15, 1.5
"""A leader runs along a line when it turns from it by less than this (sine of the angle) and is nearer than so many mm."""
LED = 10
"""Crossing another leader, which GOST 2.316 forbids, is as bad as crossing so many strong lines."""
SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)
LONG = 12.0
"""Places along a vector where its letter may stand, when it is longer than so many mm."""


class Surroundings:
    """Segments about a label's anchor, and which of them are its own."""

    def __init__(self, ink: InkIndex, label: Label, reach: float) -> None:
        p = label.anchor
        self.anchor = p
        self.a, self.b, self.of, self.strong = ink.parting(p, reach)
        self.sides = sides(self.a, self.b)
        self.leaders = self.of == LEADER
        self.own = _own(ink, self, label)
        self._vector = _vector(ink, self, label)
        if self._vector is not None:
            self._runs = np.array([Box.around(run) for run in run_corners(label.text, label.height)]).T
            # What lies on the vector is named together with it.
            self.own |= np.maximum(_to_line(self.a, *self._vector), _to_line(self.b, *self._vector)) <= AT

    def misreading(self, box: Box) -> str:
        """What is wrong with lettering in a rectangle: "crossed", "nearer", or "" for nothing."""
        margin = self.margin(box)
        return "crossed" if margin == -inf else "nearer" if margin < -SLACK else ""

    def is_vague(self, box: Box) -> bool:
        """Whether the letter of a vector has its ink there about as near to another strong line as to its own."""
        if self._vector is None:
            return False
        near = find_near(self.sides, box, SEEN)
        near = near[self.own[near] | self.strong[near]]
        own = self.own[near]
        if own.all() or not own.any():
            return False
        count = self._runs.shape[1]  # each segment and each run, all at once
        runs = np.repeat(self._runs + np.array([box.x0, box.y0] * 2)[:, None], len(near), axis=1)
        gaps = _to_box(np.tile(self.a[near], count), np.tile(self.b[near], count), runs)[0]
        own = np.tile(own, count)
        return bool(gaps[~own].min() < gaps[own].min() + CLEARLY)

    def margin(self, box: Box) -> float:
        """How much nearer to lettering in a rectangle its own line or point is than any other, mm; -inf where a line is between."""
        start, end = box.nearest(self.anchor), self.anchor
        near = find_near(self.sides, box, abs(start - end) + ROUNDING)  # nothing beyond the anchor is nearer
        if not len(near):
            return inf
        a, b, own = self.a[near], self.b[near], self.own[near]
        gaps, starts, ends = _to_box(a, b, box)
        if own.any():
            k = int(np.argmin(np.where(own, gaps, np.inf)))
            if gaps[k] < abs(start - end):
                start, end = complex(starts[k]), complex(ends[k])
        gap = abs(start - end)
        if own.all():
            return inf
        between = ~own & (gaps <= gap)
        if gap > SLACK and between.any() and crosses(a[between], b[between], start, end).any():
            return -inf
        return float(gaps[~own].min() - gap)

    def count_crossed(self, start: complex, end: complex) -> int:
        """How many strong lines but its own a leader from the anchor crosses, and lines it runs along; other leaders count more."""
        near = find_near(self.sides, Box(*sides(np.array([start]), np.array([end]))[:, 0]), BESIDE + ROUNDING)
        if not len(near):
            return 0
        a, b, along = self.a[near], self.b[near], end - start
        d = b - a
        parallel = np.abs((d * np.conj(along)).imag) < PARALLEL * np.abs(d) * abs(along)
        apart = np.minimum(_to_line(a, start, end), _to_line(b, start, end))
        beside = np.minimum(apart, np.minimum(distance(a, b, start + 0.5 * along), distance(a, b, end)))
        foreign = near[(self.strong[near] | self.leaders[near]) & ~self.own[near]]
        crossed = crosses(self.a[foreign], self.b[foreign], start, end)
        return int((parallel & (beside < BESIDE)).sum() + crossed.sum() + (LED - 1) * (crossed & self.leaders[foreign]).sum())

    def places_along(self) -> list[complex]:
        """Other places on the vector that the label names, the nearer the middle the sooner; none where it names no vector."""
        if self._vector is None:
            return []
        a, b = self._vector
        return [a + share * (b - a) for share in SHARES if abs(a + share * (b - a) - self.anchor) > SYMBOL]


def _vector(ink: InkIndex, here: Surroundings, label: Label) -> tuple[complex, complex] | None:
    """Ends of the vector, or of the construction line or line of a detail named by its own letter, beside which a label stands."""
    if label.by is None or not label.by.step:
        return None
    roles = {"vector"} | {"construction", "symbol"} & {label.by.role}
    for number in ink.of_step(label.by):
        mark = ink.marks[number]
        if (isinstance(mark, Line) and mark.by is not None and mark.by.role in roles and abs(mark.b - mark.a) > LONG
                and min(abs(mark.a - label.anchor), abs(mark.b - label.anchor)) > 2 * AT
                and distance(np.array([mark.a]), np.array([mark.b]), label.anchor)[0] <= 2 * AT):
            return mark.a, mark.b
    return None


def _own(ink: InkIndex, here: Surroundings, label: Label) -> Flags:
    """Which segments a label may stand for: those of the step it names, and what meets or lies about its anchor.

    The letter of a vector or a curve stands beside it: there lines that only pass by the anchor are foreign.
    """
    found = np.zeros(len(here.of), bool)
    if label.by is not None and label.by.step:
        for number in ink.of_step(label.by):
            found |= here.of == number
    if found.any() and not _at_end(ink, here, found, label.anchor):
        return found
    about = np.maximum(np.abs(here.a - label.anchor), np.abs(here.b - label.anchor)) <= label.gap + SYMBOL
    # The leader of another label names nothing by itself, even if it comes from the same point.
    return np.asarray((found | about | (distance(here.a, here.b, label.anchor) <= AT)) & (here.of != LEADER))


def _at_end(ink: InkIndex, here: Surroundings, lines: Flags, anchor: complex) -> bool:
    """Whether the anchor is where one of these lines ends, or on none of them."""
    on = lines & (distance(here.a, here.b, anchor) <= 2 * AT)
    ends = [flat(ink.marks[number])[[0, -1]] for number in np.unique(here.of[on])]
    return not ends or bool(np.abs(np.array(ends) - anchor).min() <= 2 * AT)


def _to_line(p: Any, a: complex, b: complex) -> Floats:
    """Distances of points to one segment."""
    t = np.minimum(np.maximum(((p - a) * np.conj(b - a)).real / abs(b - a) ** 2, 0.0), 1.0)
    return np.asarray(np.abs(a + t * (b - a) - p))


def _to_box(a: Any, b: Any, box: Iterable[Any]) -> tuple[Floats, Any, Any]:
    """Distances of segments to a rectangle, or each to its own (x0, y0, x1, y1, shape (n,) then), 0 where they meet;
    the nearest points on the rectangle and on the segment.
    """
    x0, y0, x1, y1 = box
    corners = np.array([x0 + 1j * y0, x1 + 1j * y0, x1 + 1j * y1, x0 + 1j * y1]).reshape(4, -1)
    d = b - a
    length2 = np.maximum(d.real**2 + d.imag**2, 1e-18)
    t = np.minimum(np.maximum(((corners - a) * np.conj(d)).real / length2, 0.0), 1.0)
    on = np.concatenate((a + t * d, [a, b]))
    at = np.minimum(np.maximum(on.real, x0), x1) + 1j * np.minimum(np.maximum(on.imag, y0), y1)
    gaps = np.abs(on - at)
    best = np.argmin(gaps, axis=0)
    k = np.arange(len(a))
    gap = gaps[best, k]
    gap[enters(a, d, x0, y0, x1, y1)] = 0.0
    return gap, at[best, k], on[best, k]
