"""Numbers of positions at the axes of graphs stand clear of every line of the sheet.

A graph sets its numbers before it is known what else will run there: curves, ordinates, projecting lines, a line of the mean, lines
of other views. When all is drawn those that a line runs through are set again: on the other side of the axis, beside the ordinate,
or a little farther from the axis, numbers of one axis on one level where they can.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.canvas import SMALLEST, AxisNumber, Canvas
from tmm_sheets.drawing.ink_index import WORSE, InkIndex, distance, enters
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.drawing.owners import AT
from tmm_sheets.drawing.text_boxes import CLEAR

TOUCH = 0.1
"""Distance from the edge of a line below which a number is struck, mm; when it is set again it keeps ``CLEAR``."""
WORD, ROWS = 1.5, 0.6
"""Distance of other lettering on the level of a number, and above or below it, mm."""
OFF, CLOSER = np.arange(1.5, 10.0, 0.5), np.arange(1.2, 10.0, 0.1)
"""Distances from the axis that are tried, and those for a number between lines that leave it no more room than it needs, mm."""
BESIDE = 0.9
"""Distance of a number from the ordinate it stands beside, mm."""
ASIDE, ACROSS, ALIKE, SMALL, STRAY = 0.35, 2.5, 3.0, 4.0, 12.0
"""What it costs to stand a millimetre beside the ordinate, on the other side of the axis, on a level of one's own, in the smallest
letters, nearer to a neighbour's point than to one's own, all in millimetres of distance from the axis."""
RIGHT_AT, FOREIGN = 0.5, 0.9
"""Distance of a number from the line it names, and the least one of any other line, mm."""

Level = tuple[float, float]
"""Distance from the axis, negative under it, and height of the letters, mm."""


class _Place(NamedTuple):
    """A place for a number: lower left corner from its foot, level, cost, what it would be in."""

    corner: complex
    level: Level
    cost: float
    box: Box


class _NumbersOnSheet:
    """Numbers among what is drawn on a sheet."""

    def __init__(self, canvas: Canvas, ink: InkIndex) -> None:
        self.canvas, self.ink = canvas, ink

    def clear_places(self, places: Sequence[_Place], apart: float) -> list[_Place]:
        """Those of some places that no line comes nearer to than ``apart``."""
        struck = self.ink.count_near(np.array([place.box for place in places]), apart)
        return [places[k] for k in np.flatnonzero(struck == 0).tolist()]

    def is_crowded(self, number: AxisNumber, box: Box) -> bool:
        """Whether other lettering stands too near to a rectangle."""
        return any(self.ink.texts[row] != number.mark for row in self.ink.lettering_near(box, WORD, ROWS).tolist())

    def count_faults(self, number: AxisNumber, box: Box) -> int:
        """How much is wrong with a place."""
        return int(self.ink.count_near(np.array([box]), TOUCH)[0]) + WORSE * self.is_crowded(number, box)

    def stands_badly(self, number: AxisNumber) -> bool:
        """Whether a number had better stand elsewhere."""
        mark = self.canvas.marks[number.mark]
        return isinstance(mark, Text) and bool(self.count_faults(number, _figures_box(number, mark.at, mark.height)))

    def move(self, number: AxisNumber, place: _Place | None) -> None:
        """Set a number in a place, or where it was."""
        mark = self.canvas.marks[number.mark]
        if isinstance(mark, Text):
            if place is not None:
                mark = self.canvas.marks[number.mark] = mark._replace(at=number.foot + place.corner, height=place.level[1])
            self.ink.move_text(number.mark, mark)


def set_numbers(canvas: Canvas, ink: InkIndex) -> None:
    """Set those numbers again that lines run through, the numbers of each axis together; ``ink`` is all of the canvas."""
    sheet = _NumbersOnSheet(canvas, ink)
    rows: dict[tuple[int, float], list[AxisNumber]] = defaultdict(list)
    for number in canvas.numbers:
        if sheet.stands_badly(number):
            rows[number.part, round(number.foot.imag, 3)].append(number)
    for row in rows.values():
        _set_row(sheet, row)
    canvas.numbers.clear()


def _set_row(sheet: _NumbersOnSheet, row: Sequence[AxisNumber]) -> None:
    """Set the struck numbers of one axis again: the more of them a level suits the better it is."""
    for number in row:
        sheet.ink.move_text(number.mark, None)
    free = {number: _free_places(sheet, number) for number in row}
    suits: dict[Level, int] = defaultdict(int)
    for places in free.values():
        for level in {place.level for place in places}:
            suits[level] += 1
    before: Level | None = None
    for number in sorted(row, key=lambda number: number.foot.real):
        if not sheet.stands_badly(number):  # it was too near one that has gone
            sheet.move(number, None)
            continue
        cost = {place: place.cost - ALIKE * (suits[place.level] / len(row) + (place.level == before)) for place in free[number]}
        apart = (place for place in sorted(cost, key=lambda place: cost[place]) if not sheet.is_crowded(number, place.box))
        place = next(apart, None) or min(_places(number, OFF), key=lambda at: (sheet.count_faults(number, at.box), at.cost))
        sheet.move(number, place)
        before = place.level


class PointNumbers:
    """What is drawn about the points of an upright axis with lines to both sides: each has its number right at its lines."""

    def __init__(self, canvas: Canvas) -> None:
        self._ink = InkIndex(canvas.marks)
        self._set: list[Box] = []

    def place(self, pen: Canvas, points: Sequence[complex], text: str) -> bool:
        """Set the number of a point, or of some close together, over or under their lines, if it is nobody else's there."""
        top, low = (pick(points, key=lambda z: z.imag) for pick in (max, min))
        for height in (3.5, SMALLEST):
            wide = _width(text, height)
            for x in (BESIDE, -wide - BESIDE):
                for p in (top + complex(x, RIGHT_AT), low + complex(x, -height - RIGHT_AT)):
                    box = Box(p.real, p.imag, p.real + wide, p.imag + height)
                    if self._stands_clear(box, points) and all(_is_apart(box, other) for other in self._set):
                        pen.text(p, text, height)
                        self._set.append(box)
                        return True
        return False

    def _stands_clear(self, box: Box, points: Sequence[complex]) -> bool:
        """Whether no line but those through the points comes near a rectangle beside them, nor runs through it, nor lettering."""
        near = self._ink.near(box, 3.0)
        a, b = self._ink.a[near], self._ink.b[near]
        own = np.logical_or.reduce([distance(a, b, at) <= AT for at in points])
        away = self._ink.half[near] + np.where(own, TOUCH, FOREIGN)
        return not len(self._ink.lettering_near(box, ROWS, ROWS)) and not enters(
            a, b - a, box.x0 - away, box.y0 - away, box.x1 + away, box.y1 + away).any()


def _is_apart(box: Box, other: Box) -> bool:
    return other.x0 > box.x1 + WORD or other.x1 < box.x0 - WORD or other.y0 > box.y1 + ROWS or other.y1 < box.y0 - ROWS


def _free_places(sheet: _NumbersOnSheet, number: AxisNumber) -> list[_Place]:
    """Places of a number that no line comes near, or where there is none those that no line enters."""
    for off, apart in ((OFF, CLEAR), (CLOSER, TOUCH)):
        found = sheet.clear_places([*_places(number, off)], apart)
        if any(not sheet.is_crowded(number, place.box) for place in found):
            return found
    return found


def _places(number: AxisNumber, distances: npt.NDArray[np.float64]) -> Iterator[_Place]:
    """Places about the foot of a number on its axis."""
    for height in dict.fromkeys((number.height, SMALLEST)):
        wide = _figures_box(number, 0j, height).width
        shifts = [-wide / 2, BESIDE, -wide - BESIDE]
        for x in [*shifts, *(-wide - far for far in (1.5, 2.5, 4.0))] if number.first else shifts:
            stray = STRAY * (abs(x + wide / 2) >= number.pitch / 2 and not number.first)
            for off in map(float, distances):
                for side in (-1, 1):
                    corner = complex(x, off if side > 0 else -off - height)
                    cost = off - float(OFF[0]) + ASIDE * abs(x + wide / 2) + ACROSS * (side != number.side) + stray
                    yield _Place(corner, (side * off, height), cost + SMALL * (height < number.height),
                                 _figures_box(number, number.foot + corner, height))


def _figures_box(number: AxisNumber, at: complex, height: float) -> Box:
    """Rectangle of the figures of a number with that left end of its base line."""
    return Box(at.real, at.imag, at.real + _width(number.text, height), at.imag + height)


def _width(text: str, height: float) -> float:
    return letter(text, height).width + 0.15 * height
