"""All lettering that looks for its place: numbers at axes first, then labels, notes in what is left; thin lines yield to it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import product
from math import inf, sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import labels
from tmm_sheets.drawing.canvas import SMALLEST, AxisNumber, Canvas, PlacedNote
from tmm_sheets.drawing.ink_index import WORSE, InkIndex, are_near, distance, enters
from tmm_sheets.drawing.lettering import PEN, extents, letter
from tmm_sheets.drawing.marks import Arc, Box, Line, Mark, Points, Polyline, Text, flat, run
from tmm_sheets.drawing.owners import AT
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.drawing.text_layout import CLEAR, Crowded, bounds_of, wrapped

THIN = 0.4
"""Width of the widest lines that yield, mm: axes; contours and vectors do not, labels keep off them."""
SHOWN = 0.8
"""A piece shorter than this between letters or at an end is left out, mm."""
KEPT = 0.3
"""Share of a line that must remain: a tick or a short vector under a letter stays as it is."""
SAGITTA = 0.01
"""Sagitta of the chords by which arcs are held against lettering, mm."""
STAYS = ("text", "frame", "table")
"""Roles of marks that do not yield: strokes of lettering itself, leaders, rules of tables."""

Stretch = tuple[float, float]
"""A part of a line, mm from its beginning."""


class _Letters(NamedTuple):
    """Ink of runs of letters with what is left free round it: origin, direction, corners in that direction, bounds on the sheet."""

    at: Points
    u: Points
    low: Points
    high: Points
    bounds: npt.NDArray[np.float64]


def interrupt(canvas: Canvas) -> None:
    """Interrupt the thin lines of a canvas behind its lettering."""
    letters = _letters([mark for mark in canvas.marks if type(mark) is Text])
    if letters is None:
        return
    yields = [(k, mark) for k, mark in enumerate(canvas.marks) if isinstance(mark, Line | Arc | Polyline)
              and line_type(mark.style).width <= THIN and not (mark.by is not None and mark.by.role in STAYS)]
    if not yields:
        return
    lines = [_chords(mark) for _, mark in yields]
    z, begin = np.concatenate(lines), np.cumsum([0, *map(len, lines)])[:-1]
    edges = np.array([end.reduceat(v, begin) for end in (np.minimum, np.maximum) for v in (z.real, z.imag)])
    near = are_near(edges[:, :, None], letters.bounds, 0.0)
    for i in np.flatnonzero(near.any(axis=1)):
        k, mark = yields[i]
        gaps = _gaps(lines[i], letters, np.flatnonzero(near[i]))
        if gaps:
            canvas.marks[k] = mark._replace(gaps=gaps)


def _gaps(line: Points, letters: _Letters, near: npt.NDArray[np.intp]) -> tuple[Stretch, ...]:
    """Where a line of chords is interrupted, in shares of its length; nowhere if too little of it would be left."""
    along = run(line)
    hidden = sorted(_parts_under(line, along, letters, near))
    gaps, reached, length = list[Stretch](), 0.0, float(along[-1])
    for a, b in hidden:
        if gaps and a - reached < SHOWN:
            gaps[-1] = gaps[-1][0], max(reached, b)
        else:
            gaps.append((0.0 if a < SHOWN else a, b))
        reached = max(reached, b)
    if gaps and length - reached < SHOWN:
        gaps[-1] = gaps[-1][0], length
    left = length - sum([b - a for a, b in gaps])
    return tuple([(a / length, b / length) for a, b in gaps]) if left >= KEPT * length > 0 else ()


def _chords(mark: Mark) -> Points:
    """A line as points, an arc in chords; one that is no arc at all as its centre: the writers say what is wrong with it."""
    if isinstance(mark, Arc):
        return flat(mark, sqrt(8 * mark.radius * SAGITTA)) if 0 < mark.radius < inf else np.array([mark.centre, mark.centre])
    return flat(mark)


@lru_cache(maxsize=4096)
def _ink(text: str, height: float, wide: float) -> tuple[complex, complex] | None:
    """Corners of the ink of a run of letters from its beginning."""
    left, bottom, right, top = extents(text)
    low, high = [height * complex(wide * x, y) for x, y in ((left + PEN / 2, bottom + PEN / 2), (right - PEN / 2, top - PEN / 2))]
    return (low - complex(CLEAR, CLEAR), high + complex(CLEAR, CLEAR)) if left <= right else None


def _letters(texts: Sequence[Text]) -> _Letters | None:
    shown = [(mark, ink) for mark in texts if (ink := _ink(mark.text, mark.height, mark.wide)) is not None]
    if not shown:
        return None
    at, angle = np.array([m.at for m, _ in shown]), np.array([m.angle for m, _ in shown])
    low, high = np.array([ink for _, ink in shown]).T
    u = np.cos(angle) + 1j * np.sin(angle)
    corners = at + u * np.array([low, high.real + 1j * low.imag, high, low.real + 1j * high.imag])
    return _Letters(at, u, low, high, bounds_of(corners.T).T)


def _parts_under(line: Points, along: npt.NDArray[np.float64], letters: _Letters, near: npt.NDArray[np.intp]) -> Iterator[Stretch]:
    """Stretches of a line of chords that lie under some runs of letters."""
    z = (line - letters.at[near, None]) * letters.u[near, None].conj()
    low, high = letters.low[near, None], letters.high[near, None]
    enter: npt.NDArray[np.float64] = np.zeros((len(near), len(line) - 1))
    leave = enter + 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        for v, least, most in ((z.real, low.real, high.real), (z.imag, low.imag, high.imag)):
            begin, d = v[:, :-1], np.diff(v)
            a, b = (least - begin) / d, (most - begin) / d
            # A chord along a side of the letters is within it all the way, or nowhere.
            within = (begin >= least) & (begin <= most)
            enter = np.maximum(enter, np.where(d == 0, np.where(within, 0.0, 1.0), np.minimum(a, b)))
            leave = np.minimum(leave, np.where(d == 0, np.where(within, 1.0, 0.0), np.maximum(a, b)))
    length = np.diff(along)
    for j, i in np.argwhere(leave > enter):
        yield float(along[i] + enter[j, i] * length[i]), float(along[i] + leave[j, i] * length[i])


def even(canvas: Canvas, numbers: Sequence[AxisNumber]) -> None:
    """Make the numbers of each axis as high as its lowest one: each within the place it has, at the side of its point."""
    axes: dict[tuple[int, float], dict[AxisNumber, Text]] = defaultdict(dict)
    for number in numbers:
        mark = canvas.marks[number.mark]
        if isinstance(mark, Text):
            axes[number.part, round(number.foot.imag, 3)][number] = mark
    for marks in axes.values():
        least = min([mark.height for mark in marks.values()])
        for number, mark in marks.items():
            if mark.height > least:
                wide, narrow = (letter(number.text, height).width for height in (mark.height, least))
                left = mark.at.real - number.foot.real
                aside = 0.0 if left > 0 else 1.0 if left + wide < 0 else 0.5
                down = (mark.height - least) * (mark.at.imag < number.foot.imag)
                canvas.marks[number.mark] = mark._replace(at=mark.at + complex(aside * (wide - narrow), down), height=least)


def place(canvas: Canvas, area: Box, final: bool = True) -> list[Crowded]:
    """Set all that a canvas asks for inside ``area``, as a part of its own; returns what found no free place.

    Unless this is ``final`` no label makes room for another.
    """
    ink = InkIndex(canvas.marks, area, canvas.windows)
    numbers = list(canvas.numbers)
    set_numbers(canvas, ink)
    even(canvas, numbers)
    canvas.begin(area, "", "labels")
    crowded = labels.set_labels(canvas, ink, final)
    if canvas.notes:
        crowded += set_notes(canvas, ink)
    interrupt(canvas)
    return crowded


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
        self._set_note: list[Box] = []

    def place(self, pen: Canvas, points: Sequence[complex], text: str) -> bool:
        """Set the number of a point, or of some close together, over or under their lines, if it is nobody else's there."""
        top, low = (pick(points, key=lambda z: z.imag) for pick in (max, min))
        for height in (3.5, SMALLEST):
            wide = _width(text, height)
            for x in (BESIDE, -wide - BESIDE):
                for p in (top + complex(x, RIGHT_AT), low + complex(x, -height - RIGHT_AT)):
                    box = Box(p.real, p.imag, p.real + wide, p.imag + height)
                    near = Box(box.x0 - WORD, box.y0 - ROWS, box.x1 + WORD, box.y1 + ROWS)
                    if self._stands_clear(box, points) and all(other.x0 > near.x1 or other.x1 < near.x0 or other.y0 > near.y1
                                                               or other.y1 < near.y0 for other in self._set_note):
                        pen.text(p, text, height)
                        self._set_note.append(box)
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
                    at = number.foot + corner
                    cost = off - float(OFF[0]) + ASIDE * abs(x + wide / 2) + ACROSS * (side != number.side) + stray
                    yield _Place(corner, (side * off, height), cost + SMALL * (height < number.height),
                                 Box(at.real, at.imag, at.real + wide, at.imag + height))


def _figures_box(number: AxisNumber, at: complex, height: float) -> Box:
    """Rectangle of the figures of a number with that left end of its base line."""
    return Box(at.real, at.imag, at.real + _width(number.text, height), at.imag + height)


def _width(text: str, height: float) -> float:
    return letter(text, height).width + 0.15 * height


HEIGHTS = (3.5, 2.5)
"""Heights of lettering, mm, the second where the first finds no place in the view, or on the whole sheet (GOST 2.304)."""
LEADING = 1.6
"""Distance of the lines of a note, in heights of its capitals."""
LINES = (1, 2, 3, 4, 5)
"""Numbers of lines a note may have, the most welcome first."""
COLUMN = 2.0
"""Width of a note, in heights, below which it is no lines of text but a column: rather than that it stands elsewhere."""
NOTE_CLEARANCE_MM, APART = 1.5, 6.0
"""Margins kept above and below a note, and at its sides, where other lettering would be read on as one line, mm."""
STEP = 1.0
"""Distance of the places tried, mm."""
OUTSIDE = 4.0
"""What a millimetre of distance from the view's ink costs, in millimetres from its lower edge."""
FAR = 250.0
"""Cost from which on a place is too far from the view, or too narrow, to keep clear of its pictures."""
TITLE, BESIDE_TITLE = 17.0, 40.0
"""Height of a title with its scale factor, mm, and what it costs to stand beside it: that would be read as part of it."""


def set_notes(canvas: Canvas, ink: InkIndex) -> list[Crowded]:
    """Set every note of a canvas on its ``ink``, to which they come; returns those that found no free place, which are left out."""
    crowded, area = [], ink.area
    for note in canvas.notes:
        pictures, own = _taken_boxes(canvas, ink, note)
        # Best between no picture of the view and its caption, if that is not far from the view.
        for apart, region, height in product((pictures, []), (note.box, area), HEIGHTS):
            found = [choice for n in LINES if (choice := _choice(ink, region, own, note, height, n, apart)) is not None
                     and (choice[0] < FAR or apart is not pictures)]
            if found:
                _, corner, lines = min(found, key=lambda choice: choice[0])
                first = len(canvas.marks)
                _set_note(canvas, note, corner, lines, height)
                ink.add(canvas.marks[first:])
                break
        else:
            crowded.append(Crowded(note.said, note.box.centre))
    canvas.notes.clear()
    return crowded


def _taken_boxes(canvas: Canvas, ink: InkIndex, note: PlacedNote) -> tuple[list[Box], Box]:
    """Rectangles round the pictures that the view of a note has several of, each with its caption; round all that it has drawn.

    No pictures, and its place, where there is nothing, or nobody said what belongs to it.
    """
    own_place = note.box.inset(-0.1)
    parts = [k for k, part in enumerate(canvas.parts) if note.part >= 0 and all(map(own_place.contains, part.box.corners))]
    pictures = (ink.bounds(canvas.span(k)) for k in parts if canvas.parts[k].title and canvas.parts[k].box != note.box)
    own = ink.bounds(*(canvas.span(k) for k in parts if canvas.parts[k].draw == canvas.parts[note.part].draw))
    return [box for box in pictures if box is not None], note.box if own is None else own


def _choice(ink: InkIndex, region: Box, own: Box, note: PlacedNote, height: float, count: int,
            apart: list[Box]) -> tuple[float, complex, list[str]] | None:
    """The best free place in ``region``, ``apart`` from some boxes, for a note of so many lines: cost, corner, lines.

    Best is near the lower edge of the ``own`` ink of its view: a view may leave most of its place to others.
    """
    lines = wrapped(note.said, height, count)
    laid = [letter(line, height) for line in lines]
    w = max(line.width for line in laid) + 0.15 * height
    h = (len(laid) - 1) * LEADING * height + laid[0].ascent + laid[-1].descent
    left = np.arange(region.x0 + NOTE_CLEARANCE_MM, region.x1 - w - NOTE_CLEARANCE_MM, STEP)
    below = np.arange(region.y0 + NOTE_CLEARANCE_MM, region.y1 - h - NOTE_CLEARANCE_MM, STEP)
    if not left.size or not below.size:
        return None
    size = w + 2 * APART, h + 2 * NOTE_CLEARANCE_MM
    heavy, light = (cells.count_lattice(left - APART, below - NOTE_CLEARANCE_MM, *size) for cells in (ink.heavy, ink.light))
    covered = heavy + light > 0
    for b in apart:
        covered |= ((left < b.x1) & (left + w > b.x0))[:, None] & ((below < b.y1) & (below + h > b.y0))
    i, j = np.nonzero(~covered)
    if not len(j):
        return None
    x, y = left[i], below[j]
    outside = np.maximum.reduce([own.x0 - (x + w), own.y0 - (y + h), x - own.x1, y - own.y1, np.zeros(x.size)])
    cost = OUTSIDE * outside + np.abs(y - own.y0) + 0.2 * np.abs(x + w / 2 - own.centre.real)
    cost += BESIDE_TITLE * (y + h > note.box.y1 - TITLE)
    cost += height * LINES.index(count) + FAR * (w < COLUMN * h)
    best = int(np.argmin(cost))
    return float(cost[best]), complex(x[best], y[best]), lines


def _set_note(canvas: Canvas, note: PlacedNote, corner: complex, lines: list[str], height: float) -> None:
    canvas.of = note.of
    baseline = corner + 1j * letter(lines[-1], height).descent
    for k, line in enumerate(lines, 1):
        canvas.put(letter(line, height), baseline + 1j * (len(lines) - k) * LEADING * height, 0.0, line)
        canvas.groups[-1] = canvas.groups[-1]._replace(part=note.part)
