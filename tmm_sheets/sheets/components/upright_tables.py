"""Tables with a row for each position, for places that are higher than wide: under their titles, as wide as their numbers ask."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import LEADING, TOGETHER, Heading, heading, needs, size_in, widened

Rows = Sequence[Sequence[str]]

TRIED = (7.0, 3.5, 4.0), (6.4, 3.5, 2.0), (7.0, 2.5, 2.5), (5.6, 2.5, 2.0), (4.6, 2.5, 2.0)
"""Heights of rows and of their letters, and what a column is wider than its widest text, mm: the largest first."""
UNDER = 3.0
"""Distance of the last of them from the table, mm."""
LINES = 3
"""Most lines of a title: below them it is no longer read as one."""


def sizes(title: str, rows: Rows, widest: float = float("inf")) -> list[tuple[float, float]]:
    """Widths and heights that a table with these cells, heads included, can do with, mm, the largest first.

    None is wider than ``widest``; each is at least as wide as the longest word of the title.
    """
    word = max(letter(word, 3.5).width for word in title.split(" "))
    found = [(max(sum(needs(rows, height, gap)), word), row) for row, height, gap in TRIED]
    return [(width, _head(title, width)[1] + row * len(rows)) for width, row in found if width <= widest]


def draw(canvas: Canvas, box: Box, title: str, rows: Rows, header: int = 1) -> None:
    """A table and its title, as large as the place lets them be; the first ``header`` of its rows are heads."""
    canvas.begin(box, title.replace(TOGETHER, " "))
    (lines, height, wide), head = _head(title, box.width)
    for k, line in enumerate(lines):
        canvas.text(complex(box.centre.real, box.y1 - LEADING * (k + 1) + 1.0), line, height, "centre", wide=wide)
    row = min((box.height - head) / len(rows), TRIED[0][0])
    letters = size_in(row) if sum(needs(rows, size_in(row))) <= box.width + 1e-6 else 2.5
    first = needs([[line[0]] for line in rows], letters)[0]
    widths = [first, *[(box.width - first) / (len(rows[0]) - 1)] * (len(rows[0]) - 1)]
    canvas.table(complex(box.x0, box.y1 - head), widened(widths, rows, letters), rows, row, letters, header)


def left_edge(options: dict[str, Any]) -> float | None:
    """Where such a table would like to begin, mm, if its arrangement says so: at the edge of the sheet, beside an ordinate axis."""
    found: float | None = options.get("left")
    return found


def _head(title: str, width: float) -> tuple[Heading, float]:
    """A title over a table of a width, mm, and the room it takes."""
    found = heading(title, width, 5.0, LINES)
    return found, LEADING * len(found.lines) + UNDER - 1.0
