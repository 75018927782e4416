"""Views that are data, for room that is left beside others: lines or a table under a title, and upright tables of positions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import broken, letter, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import CLEAR, GAP, LEADING, LEAST, TOGETHER, Heading, heading, needs, parted, size_in, widened
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

Sizes = list[tuple[float, float]]
"""Widths and heights of places, mm, the one most wanted first; none where there is nothing to show."""

ROW, LARGE, LETTERS = 12.0, 16.0, 5.0
"""Greatest height of a row of a table, mm; of one where there is room for letters as large as a title's, and these."""
HEIGHTS = ((5.0, 5.0, 12.0), (5.0, 3.5, 10.0), (5.0, 3.5, 7.0), (3.5, 3.5, 7.0))
"""Heights of the letters of a title and of the lines under it, and distances of these, that are tried, mm."""
APART = 14.0
"""Distance of formulas that stand side by side, mm."""
COLUMN = 12.5
"""Width of a column of numbers at all positions, mm, below which the tables lie down: a column for each position."""
PLACES = ((220.0, LARGE), (180.0, ROW), (150.0, 9.0), (120.0, 7.0))
"""Widths and heights of rows of a table that are tried, mm."""


def letters_in(row: float, widths: Sequence[float], rows: Sequence[Sequence[str]]) -> tuple[float, float]:
    """Height of the rows of a table that has room for rows so high, and of the letters in them, mm: the larger if they fit."""
    return (LARGE, LETTERS) if row >= LARGE and sum(needs(rows, LETTERS, LEAST + GAP)) <= sum(widths) else (min(row, ROW), 3.5)


@dataclass(frozen=True)
class Lines:
    """A view of ``lines`` under a ``title``, with the largest letters that have room; they may read the scales of the sheet."""

    title: str
    lines: Callable[[Project, Canvas], Iterable[str]]

    def sizes(self, project: Project, canvas: Canvas, options: dict[str, Any]) -> Sizes:
        """Places that it can do with. The title is as large as others are, if it can be."""
        lines, title = list(self.lines(project, canvas)), tr(self.title)
        return [(max(letter(title, head).width, *(letter(line, height).width for line in lines)) + 6.0, 14.0 + step * len(lines))
                for head, height, step in HEIGHTS] if lines else []

    def __call__(self, project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
        """Draw it."""
        draw_lines(canvas, box, tr(self.title), self.lines(project, canvas))


def draw_lines(canvas: Canvas, box: Box, title: str, said: Iterable[str]) -> None:
    """Lines under their title with the largest letters that have room in a place; those too long for it are broken."""
    lines = [part for line in said for part in broken(line, box.width - 3.0, 3.5)]
    left = canvas.title(box, title, spare=box.height - 14.0 - HEIGHTS[-1][2] * len(lines))
    room = (left.y1 - box.y0) / len(lines)
    height = size_for(lines, box.width - 3.0, 5.0 if room > HEIGHTS[-1][2] else 3.5)
    step = min(room, 12.0 if height > 3.5 else 10.0)
    canvas.lines(complex(box.x0 + 3.0, left.y1 - 0.8 * step), lines, step, height)


class Form(NamedTuple):
    """A form of a view of lines: its columns, height of the letters, least distance of the lines, room for the title, mm.

    It is ``least`` so wide, mm.
    """

    columns: Sequence[list[str]]
    height: float
    step: float
    head: float = 12.0
    least: float = 0.0

    @property
    def widths(self) -> list[float]:
        """Widths of the columns with what parts them, mm."""
        return [max([letter(line, self.height).width for line in lines]) + APART for lines in self.columns]

    @property
    def size(self) -> tuple[float, float]:
        """What it takes, mm."""
        return max(sum(self.widths) - APART, self.least) + 6.0, self.head + self.pitch * max(map(len, self.columns))

    def fits(self, box: Box) -> bool:
        """Whether a place has room for it."""
        return self.size[0] <= box.width + 1e-6 and self.size[1] <= box.height + 1e-6

    @property
    def pitch(self) -> float:
        """Distance of the lines, mm: no exponent stands in an index of the line above it."""
        laid = [[letter(line, self.height) for line in lines] for lines in self.columns]
        return max([self.step, *[one.descent + other.ascent + CLEAR for column in laid for one, other in pairwise(column)]])


@dataclass(frozen=True)
class Formulas:
    """A view of lines under a ``title`` in the first of its ``forms`` that a place has room for, the clearest first.

    Its marks are ``of`` a plan.
    """

    title: str
    of: str
    forms: Callable[[Project, Canvas], Iterable[Form]]

    def sizes(self, project: Project, canvas: Canvas, options: dict[str, Any]) -> Sizes:
        """Places that it can do with."""
        return [form.size for form in self.forms(project, canvas)]

    def __call__(self, project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
        """Draw it."""
        form = next(form for form in self.forms(project, canvas) if form.fits(box))
        canvas.of = self.of
        left = canvas.title(box, tr(self.title), spare=box.height - form.size[1])
        x = box.x0 + 3.0
        for lines, width in zip(form.columns, form.widths, strict=True):
            canvas.lines(complex(x, left.y1 - 0.8 * form.pitch), lines, form.pitch, form.height)
            x += width


@dataclass(frozen=True)
class Table:
    """A view of ``rows``, the first of them the heading, under a ``title``; columns have these ``shares`` of the width."""

    title: str | Callable[[Project, Canvas], str]
    rows: Callable[[Project, Canvas], list[list[str]]]
    shares: tuple[float, ...]
    places: tuple[tuple[float, float], ...] = PLACES

    def sizes(self, project: Project, canvas: Canvas, options: dict[str, Any]) -> Sizes:
        """Places that it can do with."""
        count = len(self.rows(project, canvas))
        return [(width, 11.0 + row * count) for width, row in self.places] if count > 1 else []

    def __call__(self, project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
        """Draw it."""
        rows, widths = self.rows(project, canvas), [share * box.width for share in self.shares]
        left = canvas.title(box, tr(self.title) if isinstance(self.title, str) else self.title(project, canvas),
                            spare=box.height - 11.0 - self.places[-1][1] * len(rows))
        row, height = letters_in(left.height / len(rows), widths, rows)
        canvas.table(complex(box.x0, left.y1), widened(widths, rows, height), rows, row, height)


Rows = Sequence[Sequence[str]]


def table(canvas: Canvas, left: Box, rows: list[list[str]], tallest: float = 11.0) -> None:
    """Table with the quantities in the first column, as large as its place lets it be, rows no higher than ``tallest``, mm.

    Where the numbers of all positions have no room in one row, there are more, one under the other, each with its numbers.
    """
    parts = parted(rows, left.width, left.height)
    first = max(letter(row[0], 3.5).width for row in rows) + 3.0
    high = min(left.height / sum(map(len, parts)), tallest)
    top = left.y1
    for part in parts:
        width = (left.width - first) / (len(parts[0][0]) - 1)
        height = size_in(high) if max([letter(cell, 3.5).width for line in part for cell in line[1:]]) <= width - 1 else 2.5
        canvas.table(complex(left.x0, top), widened([first, *[width] * (len(part[0]) - 1)], part, height), part, high, height)
        top -= high * len(part)


def table_in(canvas: Canvas, left: Box, rows: Sequence[Sequence[str]], tallest: float, widths: Sequence[float] = (),
             under: float = 0.0, header: int = 1) -> Box:
    """Table from the top of a place down, as high as it lets it be with ``under`` mm left free, rows no higher than ``tallest``.

    Columns are of equal widths unless told, but for the first of which there is told one; all are wide enough for their texts.
    """
    row = min((left.height - under) / len(rows), tallest)
    count, height = len(rows[0]), size_in(row)
    if len(widths) < count:
        widths = [*widths, *[(left.width - sum(widths)) / (count - len(widths))] * (count - len(widths))]
    return canvas.table(complex(left.x0, left.y1), widened(widths, rows, height), rows, row, height, header)


TRIED = (7.0, 3.5, 4.0), (6.4, 3.5, 2.0), (7.0, 2.5, 2.5), (5.6, 2.5, 2.0), (4.6, 2.5, 2.0)
"""Heights of rows and of their letters, and what a column is wider than its widest text, mm: the largest first."""
UNDER = 3.0
"""Distance of the last of them from the table, mm."""
LINES = 3
"""Most lines of a title: below them it is no longer read as one."""


def draw_upright(canvas: Canvas, box: Box, title: str, rows: Rows) -> None:
    """A table and its title, as large as the place lets them be; its first row are heads, units without a number may follow.

    Nothing without a column beside the first.
    """
    if len(rows[0]) < 2:
        return
    canvas.begin(box, title.replace(TOGETHER, " "))
    (lines, height, wide), head = _head(title, box.width)
    for k, line in enumerate(lines):
        canvas.text(complex(box.centre.real, box.y1 - 5.0 - LEADING * k), line, height, "centre", wide=wide)
    row = min((box.height - head) / len(rows), TRIED[0][0])
    letters = size_in(row) if sum(needs(rows, size_in(row))) <= box.width + 1e-6 else 2.5
    first = needs([[line[0]] for line in rows], letters)[0]
    widths = [first, *[(box.width - first) / (len(rows[0]) - 1)] * (len(rows[0]) - 1)]
    canvas.table(complex(box.x0, box.y1 - head), widened(widths, rows, letters), rows, row, letters, 1 if rows[1][0] else 2)


def folded(rows: Rows, count: int) -> list[list[str]]:
    """A table under its first row in so many parts side by side."""
    head, *body = rows
    each = -(-len(body) // count)
    body = [*body, *[[""] * len(head)] * (each * count - len(body))]
    return [[*head] * count, *[[cell for row in body[k::each] for cell in row] for k in range(each)]]


@dataclass(frozen=True)
class Upright:
    """A view of such a table: ``of`` gives its title and its cells.

    It is offered with a column of numbers at least, no wider than the option ``widest``, in one of so many ``folds``.
    """

    of: Callable[[Project, dict[str, Any]], tuple[str, Rows]]
    folds: tuple[int, ...] = (1,)

    def _forms(self, title: str, rows: Rows, options: dict[str, Any]) -> Iterator[tuple[tuple[float, float], Rows]]:
        """Places that it can do with, the largest first, each at least as wide as the longest word of the title, and its cells."""
        word = max(letter(word, 3.5).width for word in title.split(" "))
        cells = [folded(rows, count) for count in self.folds] if min(len(rows), len(rows[0])) > 1 else []
        for (row, height, gap), some in product(TRIED, cells):
            width = max(sum(needs(some, height, gap)), word)
            if width <= options.get("widest", inf):
                yield (width, _head(title, width)[1] + row * len(some)), some

    def sizes(self, project: Project, canvas: Canvas, options: dict[str, Any]) -> Sizes:
        """Places that it can do with."""
        return [size for size, _ in self._forms(*self.of(project, options), options)]

    def __call__(self, project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
        """Draw it."""
        title, rows = self.of(project, options)
        forms = self._forms(title, rows, options) if len(self.folds) > 1 else iter(())
        draw_upright(canvas, box, title, next((some for (width, height), some in forms
                                               if width <= box.width + 1e-6 and height <= box.height + 1e-6), rows))


def _head(title: str, width: float) -> tuple[Heading, float]:
    """A title over a table of a width, mm, and the room it takes."""
    found = heading(title, width, 5.0, LINES)
    return found, 5.0 + LEADING * (len(found.lines) - 1) + UNDER
