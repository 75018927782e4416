"""Spatial index of the ink of a sheet: what is near a point, in a rectangle or crossed by a line, and where there is room.

Evenness of a finished sheet, too: share of empty squares, and how much of their boxes the views fill.
"""

from __future__ import annotations

from cmath import rect
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.ink import ROUNDING as ROUNDING
from tmm_sheets.drawing.marks import Arc, Box, Drawing, Fill, Line, Mark, Points, Polyline, Provenance, Role, Text, flat, run
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.drawing.text_layout import bounds_of, text_box, text_boxes

STRONG = frozenset({"main", "curve", "vector", "axis", "hidden"})
"""Line types that leaders and lettering should not meet."""
CELL = 0.5
"""Side of the cells in which room for lettering is searched, mm."""
WIDEST = 2.0
"""Largest distance, mm, at which a line can come nearer to a rectangle than is asked."""
WORSE = 10
"""Weight of a side of lettering, or of a strong line, in thin lines."""
SHORT = 4.0
"""Length, mm, up to which a line is covered whole by a letter, so that it cannot be interrupted behind it."""
NOWHERE = Box(0.0, 0.0, 0.0, 0.0)
TOUCHING = 1e-9
"""Product of the areas, mm^4, on both sides of a line up to which a segment only touches it: above rounding of any processor."""
LEADER = -1
"""Mark number that stands for leaders of labels."""

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]
Numbers = npt.NDArray[np.intp]


class InkIndex:
    """Ink of a sheet: lines as segments ``a`` .. ``b``, complex (n,), lettering as bounding boxes ``written``, (t, 4).

    Each segment has the number of its mark (``of``), is ``strong`` or not, one of the ``parts`` or not that may separate a label
    from its object (no bars over letters, no windows), and has ``half`` the width of its line, mm. The boxes
    are x0, y0, x1, y1 of the marks numbered ``texts``; NaN where lettering was removed. ``area``: where room is searched;
    ``windows``: numbers of the circles of enlarged details.
    """

    def __init__(self, marks: Iterable[Mark] = (), area: Box = NOWHERE, windows: Collection[int] = ()) -> None:
        self.area, self._windows = area, windows
        self.marks = list[Mark]()
        self.a, self.b, self.of = np.empty(0, complex), np.empty(0, complex), np.empty(0, int)
        self.strong, self._heavy, self.parts = np.empty((3, 0), bool)
        self.half, self.sides = np.empty(0), np.empty((4, 0))
        self.written, self._corners, self.texts = np.empty((0, 4)), np.empty((0, 4), complex), list[int]()
        self._filled, self._steps = np.empty((0, 4)), defaultdict[tuple[str | int, ...], list[int]](list)
        self._lines = dict[tuple[str | int, ...], dict[int, tuple[tuple[complex, complex], Role]]]()
        self.set_leaders(np.empty(0), np.empty(0))
        self.add(marks)

    def add(self, marks: Iterable[Mark]) -> None:
        """Add marks."""
        first, starts, ends, lines = len(self.marks), list[Any](), list[Any](), list[tuple[int, bool, bool, bool, float]]()
        texts, filled, types = dict[int, Text](), list[Box](), line_types()
        before = len(self.a), len(self.written), len(self._filled)
        self.marks.extend(marks)
        for number, mark in enumerate(self.marks[first:], first):
            if mark.by is not None and mark.by.step and mark.by.role != "text":
                for key in (mark.by[1:4], mark.by[1:5]) if mark.by.name else (mark.by[1:4],):
                    self._steps[key].append(number)
            if isinstance(mark, Text):
                texts[number] = mark
                continue
            width = types[mark.style].width
            bar, strong = mark.style == "text", mark.style in STRONG
            heavy = strong or bar or _is_short(mark)
            match mark:
                case Line():  # most are: quicker without an array for each
                    starts.append((mark.a,))
                    ends.append((mark.b,))
                case _:
                    points = flat(mark, 1.0)
                    match mark:
                        case Polyline():
                            points = _thin(points)
                        case Fill():
                            filled.append(Box.around(points))
                            heavy, width = True, 0.0
                    starts.append(points[:-1])
                    ends.append(points[1:])
            lines.append((number, strong, heavy, not bar and number not in self._windows, width / 2))
        if lines:
            a, b = (np.fromiter(chain.from_iterable(of), complex) for of in (starts, ends))
            self.a, self.b, self.sides = np.append(self.a, a), np.append(self.b, b), np.hstack((self.sides, sides(a, b)))
            self.of, self.strong, self._heavy, self.parts, self.half = [
                np.append(known, np.repeat(column, [*map(len, starts)])) for known, column in zip(
                    (self.of, self.strong, self._heavy, self.parts, self.half), zip(*lines, strict=True), strict=True)]
        if texts:
            corners = text_boxes([*texts.values()])
            self.texts += texts
            self._corners, self.written = np.vstack((self._corners, corners)), np.vstack((self.written, bounds_of(corners)))
        if filled:
            self._filled = np.vstack((self._filled, filled))
        vars(self).pop("_outlines", None)
        self._lines.clear()
        self.surroundings, self.subjects = dict[Any, Any](), dict[Any, tuple[list[int], tuple[complex, complex] | None]]()
        for name, make in (("heavy", self._forbidden_cells), ("light", self._remaining_cells)):
            if name in vars(self):
                vars(self)[name].include(make(*before))

    def move_text(self, number: int, text: Text | None) -> None:
        """Move the lettering of a mark to where ``text`` stands, or remove it (None)."""
        row = self.texts.index(number)
        self._corners[row] = np.nan if text is None else text_boxes([text])[0]
        self.written[row] = np.nan if text is None else bounds_of(self._corners[[row]])[0]

    def set_leaders(self, a: Any, b: Any) -> None:
        """Replace the leaders by those from ``a`` to ``b``, complex (n,)."""
        self.leaders = np.asarray(a, complex), np.asarray(b, complex)

    def of_step(self, by: Provenance) -> list[int]:
        """Numbers of the marks with this step, position and frame, and with this name if any has it (an arm of a sum)."""
        return (by.name and self._steps.get(by[1:5])) or self._steps.get(by[1:4], [])

    def lines_of(self, by: Provenance) -> dict[int, tuple[tuple[complex, complex], Role]]:
        """Lines that came from a step, by the numbers of their marks: tail and tip, and role of each."""
        if (found := self._lines.get(by[1:5])) is None:
            marks = {n: self.marks[n] for n in self.of_step(by)}
            tips = {m.by: complex(m.points[0]) for m in marks.values() if isinstance(m, Fill)}
            found = {n: ((m.a, tips.get(m.by, m.b)), m.by.role) for n, m in marks.items() if isinstance(m, Line) and m.by}
            self._lines[by[1:5]] = found
        return found

    def near(self, box: Box, reach: float) -> Numbers:
        """Numbers of the segments whose bounding boxes are within ``reach`` mm of a rectangle."""
        return find_near(self.sides, box, reach)

    def bounds(self, *spans: tuple[int, int]) -> Box | None:
        """Bounding box of the marks numbered in ``spans`` (first, end); None if they have no ink."""
        edges = np.vstack((self.sides.T, self.written))
        of = np.append(self.of, self.texts)
        own = edges[np.any([(of >= first) & (of < end) for first, end in spans], axis=0)] if spans else edges[:0]
        return Box(*own[:, :2].min(axis=0).tolist(), *own[:, 2:].max(axis=0).tolist()) if len(own) else None

    def parting(self, p: complex, reach: float) -> Numbers:
        """Numbers of the segments within ``reach`` of a point that may separate a label from its object: no bars, no windows."""
        here = self.near(Box(p.real, p.imag, p.real, p.imag), reach)
        return np.asarray(here[self.parts[here]])

    def count_in(self, box: Box, origin: complex = 0j, direction: float = 0.0) -> int:
        """Weighted number of lines in a rectangle whose axes have ``direction``, rad, about ``origin``; see ``WORSE``."""
        along, p = rect(1, direction), box.centre
        middle = origin + p * along
        start, end, around, counts = self._outlines
        near = find_near(around, Box(*[middle.real, middle.imag] * 2), abs(complex(box.x0, box.y0) - p) + ROUNDING)
        a, b = [(z[near] - origin) / along for z in (start, end)]
        return int(counts[near[enters(a, b - a, *box)]].sum())

    def is_crossed(self, a: complex, b: complex) -> bool:
        """True if the segment a .. b crosses a strong line or lettering."""
        start, end, _, counts = self._outlines
        return bool(crosses(start[counts > 1], end[counts > 1], a, b).any())

    def count_near(self, boxes: Floats, apart: float) -> npt.NDArray[np.int_]:
        """Weighted number of lines nearer than ``apart`` mm to each of the rectangles, (m, 4) -> (m,); see ``WORSE``."""
        x0, y0, x1, y1 = boxes.T[:, :, None]
        near = self.near(Box(x0.min(), y0.min(), x1.max(), y1.max()), WIDEST)
        if not len(near):
            return np.zeros(len(boxes), int)
        a, b, away = self.a[near], self.b[near], apart + self.half[near]
        met = enters(a, b - a, x0 - away, y0 - away, x1 + away, y1 + away)
        first = np.flatnonzero(np.diff(self.of[near], prepend=-1))
        return np.asarray(np.logical_or.reduceat(met, first, axis=1) @ np.where(self.strong[near[first]], WORSE, 1))

    def lettering_near(self, box: Box, beside: float, above: float) -> Numbers:
        """Rows of the lettering nearer to a rectangle than ``beside`` mm horizontally and ``above`` mm vertically."""
        return find_near(self.written.T, box.inset(-beside, -above, -beside, -above), 0.0)

    @cached_property
    def _outlines(self) -> tuple[Points, Points, Floats, npt.NDArray[np.int_]]:
        """Lines and sides of lettering: ``a``, ``b``, bounding boxes (4, n), weights."""
        a, b = np.append(self.a, np.roll(self._corners, 1, axis=1)), np.append(self.b, self._corners)
        return a, b, sides(a, b), np.append(np.where(self.strong, WORSE, 1), np.full(self._corners.size, WORSE))

    @cached_property
    def heavy(self) -> Cells:
        """Cells that lettering must not touch: main lines, curves, axes, fills, other lettering, and their neighbours.

        Neighbours count as inked because main lines are up to a millimetre wide.
        """
        return self._forbidden_cells()

    @cached_property
    def light(self) -> Cells:
        """Cells of thin lines, which lettering should avoid."""
        return self._remaining_cells()

    def _forbidden_cells(self, lines: int = 0, texts: int = 0, fills: int = 0) -> Cells:
        """Forbidden cells of the segments, texts and fills from these numbers on."""
        cells = self._cells(self._heavy, lines)
        cells.add_boxes(np.vstack((self.written[texts:], self._filled[fills:])))
        cells.widen()
        return cells

    def _remaining_cells(self, lines: int = 0, *_: int) -> Cells:
        return self._cells(~self._heavy, lines)

    def _cells(self, which: Flags, first: int) -> Cells:
        cells = Cells(self.area, CELL)
        cells.add_points(sample(self.a[first:][which[first:]], self.b[first:][which[first:]], CELL / 2))
        return cells


def _is_short(mark: Mark) -> bool:
    """True if a letter would hide a mark of a symbol or hatching: a line or circle no longer than ``SHORT``."""
    return mark.by is not None and mark.by.role in ("symbol", "hatch") and (
        (isinstance(mark, Line) and abs(mark.b - mark.a) <= SHORT) or (isinstance(mark, Arc) and 2 * mark.radius <= SHORT))


def sample(a: Any, b: Any, step: float) -> Points:
    """Points along segments from ``a`` to ``b``, complex (n,), with their ends, at most ``step`` mm apart."""
    count = (np.abs(b - a) / step).astype(int) + 2
    share = (np.arange(count.sum()) - (count.cumsum() - count).repeat(count)) / (count - 1).repeat(count)
    return np.asarray(a.repeat(count) + share * (b - a).repeat(count))


def sides(a: Any, b: Any) -> Floats:
    """Bounding boxes of segments a .. b, complex (n,): left, lower, right and upper edges, (4, n)."""
    (ax, ay), (bx, by) = (a.real, a.imag), (b.real, b.imag)
    return np.array([np.minimum(ax, bx), np.minimum(ay, by), np.maximum(ax, bx), np.maximum(ay, by)])


def find_near(edges: Floats, box: Box, reach: float) -> npt.NDArray[np.intp]:
    """Indices of the bounding boxes, (4, n), within ``reach`` of a rectangle along both axes."""
    return are_near(edges, box, reach).nonzero()[0]  # np.flatnonzero costs five calls more, and this is asked thousands of times


def are_near(edges: Any, boxes: Any, reach: Any) -> Flags:
    """Mask: are bounding boxes within ``reach`` of rectangles along both axes? Arguments broadcast."""
    (e0, f0, e1, f1), (x0, y0, x1, y1) = edges, boxes
    found: Flags = (e0 <= x1 + reach) & (e1 >= x0 - reach) & (f0 <= y1 + reach) & (f1 >= y0 - reach)
    return found


def _thin(points: Any) -> Any:
    """Thin a polyline of 50 points or more, complex (n,) mm, to one point per millimetre of arc length; both ends stay."""
    if len(points) < 50:
        return points
    reached = np.floor(run(points))
    keep = np.append(True, reached[1:] != reached[:-1])
    keep[-1] = True
    return points[keep]


def distance(a: Any, b: Any, p: Any) -> Floats:
    """Distances of a point, or of a point each, complex (n,), to segments a .. b, complex (n,) -> (n,)."""
    d = b - a
    length2 = np.maximum(np.abs(d) ** 2, 1e-18)
    t = np.minimum(np.maximum(((p - a) * np.conj(d)).real / length2, 0.0), 1.0)
    found: Floats = np.abs(a + t * d - p)
    return found


def enters(a: Any, d: Any, x0: Any, y0: Any, x1: Any, y1: Any) -> Flags:
    """Mask: does a + t d, 0 <= t <= 1, meet the rectangle? Slab method; arguments broadcast."""
    first: Any = 0.0
    last: Any = 1.0
    for start, step, low, high in ((a.real, d.real, x0, x1), (a.imag, d.imag, y0, y1)):
        safe = np.where(np.abs(step) < 1e-12, 1e-12, step)  # along the sides: far off at both ends, or between them
        u, v = (low - start) / safe, (high - start) / safe
        first, last = np.maximum(first, np.minimum(u, v)), np.minimum(last, np.maximum(u, v))
    found: Flags = first <= last
    return found


def crosses(a: Any, b: Any, p: Any, q: Any) -> Flags:
    """Mask: do segments a .. b cross p .. q? Touching does not count; arguments broadcast."""
    d, e = b - a, q - p
    parted = (e * np.conj(a - p)).imag * (e * np.conj(b - p)).imag < -TOUCHING  # a and b by the line p .. q
    found: Flags = parted & ((d * np.conj(p - a)).imag * (d * np.conj(q - a)).imag < -TOUCHING)
    return found


_FIRST_BEYOND = np.array([0, 0, 1, 1])[:, None]
"""Added to the cells of two corners: a range of cells ends after that of the upper right one."""


class Cells:
    """Occupancy grid of an ``area`` with cells of ``side`` mm; ``taken``, bool (nx, ny): cells with ink."""

    def __init__(self, area: Box, side: float) -> None:
        self.side = side
        self.taken = np.zeros((int(area.width / side), int(area.height / side)), bool)
        self._corner = np.array([area.x0, area.y0] * 2)[:, None]
        self._last = np.array(self.taken.shape * 2)[:, None]

    def add_points(self, z: Points) -> None:
        """Take the cells of points, complex (n,)."""
        i, j = [((v - low) / self.side).astype(int) for v, low in zip((z.real, z.imag), self._corner[:2, 0], strict=True)]
        there = (i >= 0) & (i < self.taken.shape[0]) & (j >= 0) & (j < self.taken.shape[1])
        self.taken[i[there], j[there]] = True

    def add_boxes(self, boxes: npt.NDArray[np.float64]) -> None:
        """Take the cells of rectangles x0, y0, x1, y1, (n, 4)."""
        for i0, j0, i1, j1 in self._spans(boxes.T).T.tolist():
            self.taken[i0:i1, j0:j1] = True

    def widen(self) -> None:
        """Take the neighbours of the taken cells, too."""
        taken = self.taken.copy()
        self.taken[1:] |= taken[:-1]
        self.taken[:-1] |= taken[1:]
        self.taken[:, 1:] |= taken[:, :-1]
        self.taken[:, :-1] |= taken[:, 1:]

    @cached_property
    def table(self) -> npt.NDArray[np.int32]:
        """Summed-area table of the taken cells, (nx + 1, ny + 1)."""
        return sum_area(self.taken)

    def count_under(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.int32]:
        """Number of taken cells under rectangles; ``sides``: x0, y0, x1, y1, (4, n) -> (n,)."""
        i0, j0, i1, j1 = self._spans(sides)
        return np.asarray(self.table[i1, j1] - self.table[i0, j1] - self.table[i1, j0] + self.table[i0, j0])

    def count_lattice(self, x0: npt.NDArray[np.float64], y0: npt.NDArray[np.float64], width: float, height: float,
                ) -> npt.NDArray[np.int32]:
        """Number of taken cells, (n, m), under rectangles of one size; left edges ``x0``, (n,), lower edges ``y0``, (m,)."""
        i0, _, i1, _ = self._spans(np.array([x0, x0, x0 + width, x0]))
        _, j0, _, j1 = self._spans(np.array([y0, y0, y0, y0 + height]))
        i, j = i0.min(), j0.min()  # of the part they are in: it is asked once, and the whole sheet is many times as large
        table = sum_area(self.taken[i:i1.max(), j:j1.max()])
        band = table[i1 - i] - table[i0 - i]
        return np.asarray(band[:, j1 - j] - band[:, j0 - j])

    def include(self, others: Cells) -> None:
        """Take the cells that are taken in another grid of the same area."""
        self.taken |= others.taken
        vars(self).pop("table", None)

    def _spans(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.int_]:
        cells = ((sides - self._corner) / self.side).astype(int) + _FIRST_BEYOND
        return np.asarray(np.minimum(np.maximum(cells, 0), self._last))


def sum_area(taken: npt.NDArray[np.bool_] | npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
    """Summed-area table, (nx + 1, ny + 1), of a mask or of counts (nx, ny)."""
    table = np.zeros((taken.shape[0] + 1, taken.shape[1] + 1), np.int32)
    np.cumsum(taken, axis=1, dtype=np.int32, out=table[1:, 1:])
    for i in range(1, len(table)):  # row upon row: three times quicker than another cumsum, which walks down columns
        table[i] += table[i - 1]
    return table


FIELD = Box(20.0, 5.0, 836.0, 589.0)
"""Inside of the frame of an A1 sheet, mm."""
TAKEN = Box(651.0, 5.0, 836.0, 60.0), Box(20.0, 575.0, 90.0, 589.0)
"""Title block and turned designation."""
SQUARE = 50.0
"""Approximate side of the squares of which the empty ones are counted, mm."""
FRAME = "title block"


def empty_cells(drawing: Drawing) -> float:
    """Share of the squares of the field without ink, 0 .. 1."""
    nx, ny = round(FIELD.width / SQUARE), round(FIELD.height / SQUARE)
    inked = np.zeros((nx, ny), bool)
    z = np.concatenate((dense((mark for mark in drawing.marks if mark.of != FRAME), 4.0), *map(covering, TAKEN)))
    i = ((z.real - FIELD.x0) / FIELD.width * nx).astype(int)
    j = ((z.imag - FIELD.y0) / FIELD.height * ny).astype(int)
    there = (i >= 0) & (i < nx) & (j >= 0) & (j < ny)
    inked[i[there], j[there]] = True
    return float(1.0 - inked.mean())


def fills(drawing: Drawing) -> Iterator[tuple[str, float]]:
    """Name of each view and the share of its box that the bounding box of its ink takes, 0 .. 1.

    Ink beyond the box, such as projection lines to another graph, does not count. The circle of an enlarged detail is not a view.
    """
    for view in {view.box: view for view in reversed(drawing.views)}.values():
        marks = [mark for a, b in view.spans for mark in drawing.marks[a:b] if mark.of != FRAME]
        z = [text_box(mark) if isinstance(mark, Text) else flat(mark, 2.0) for mark in marks]
        if any(not isinstance(mark, Text) for mark in marks) and view.box.width * view.box.height > 0:
            ink, place = Box.around(np.concatenate(z)), view.box
            wide, high = min(ink.x1, place.x1) - max(ink.x0, place.x0), min(ink.y1, place.y1) - max(ink.y0, place.y0)
            yield view.name, max(wide, 0.0) * max(high, 0.0) / (place.width * place.height)


def dense(marks: Iterable[Mark], step: float) -> Points:
    """Points along marks, or round their lettering, complex (n,), at most ``step`` mm apart."""
    some = list(marks)
    a, b = np.array([(mark.a, mark.b) for mark in some if type(mark) is Line], complex).reshape(-1, 2).T
    corners = text_boxes([mark for mark in some if type(mark) is Text])
    others = [flat(mark, 2.0) for mark in some if type(mark) is not Line and type(mark) is not Text]
    return sample(np.concatenate((a, corners[:, :-1].ravel(), *[z[:-1] for z in others])),
                  np.concatenate((b, corners[:, 1:].ravel(), *[z[1:] for z in others])), step)


def covering(box: Box) -> Points:
    """Grid of points in a box, complex (n,), 4 mm apart: it counts as filled."""
    x, y = np.meshgrid(np.arange(box.x0, box.x1, 4.0), np.arange(box.y0, box.y1, 4.0))
    return np.asarray((x + 1j * y).ravel())
