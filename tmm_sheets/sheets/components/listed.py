"""Views that are data: lines or a table under a title, for room that is left beside other views."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import GAP, LEAST, needs, widened
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

Sizes = list[tuple[float, float]]
"""Widths and heights of places, mm, the one most wanted first; none where there is nothing to show."""

ROW, LARGE, LETTERS = 12.0, 16.0, 5.0
"""Greatest height of a row of a table, mm; of one where there is room for letters as large as a title's, and these."""
HEIGHTS = ((5.0, 5.0, 12.0), (5.0, 3.5, 10.0), (5.0, 3.5, 7.0), (3.5, 3.5, 7.0))
"""Heights of the letters of a title and of the lines under it, and distances of these, that are tried, mm."""
PLACES = ((220.0, LARGE), (180.0, ROW), (150.0, 9.0), (120.0, 7.0))
"""Widths and heights of rows of a table that are tried, mm."""


def letters_in(row: float, widths: Sequence[float], rows: Sequence[Sequence[str]]) -> tuple[float, float]:
    """Height of the rows of a table that has room for rows so high, and of the letters in them, mm: the larger if they fit."""
    wide = sum(needs(rows, LETTERS, LEAST + GAP))
    return (LARGE, LETTERS) if row >= LARGE and wide <= sum(widths) else (min(row, ROW), 3.5)


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
        lines = list(self.lines(project, canvas))
        left = canvas.title(box, tr(self.title), spare=box.height - 14.0 - HEIGHTS[-1][2] * len(lines))
        height = size_for(lines, box.width - 3.0, 5.0)
        step = min((left.y1 - box.y0) / len(lines), 12.0 if height > 3.5 else 10.0)
        canvas.lines(complex(box.x0 + 3.0, left.y1 - 0.8 * step), lines, step, height)


@dataclass(frozen=True)
class Table:
    """A view of ``rows``, the first of them the heading, under a ``title``; columns have these ``shares`` of the width."""

    title: str | Callable[[Project], str]
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
        title = tr(self.title) if isinstance(self.title, str) else self.title(project)
        left = canvas.title(box, title, spare=box.height - 11.0 - self.places[-1][1] * len(rows))
        row, height = letters_in(left.height / len(rows), widths, rows)
        canvas.table(complex(box.x0, left.y1), widened(widths, rows, height), rows, row, height)
