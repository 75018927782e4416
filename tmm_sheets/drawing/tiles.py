"""A sheet cut into pages for a small printer, to be glued together: crop marks, overlap lines, row and column."""

from __future__ import annotations

from cmath import phase
from math import ceil
from textwrap import shorten
from typing import NamedTuple

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import plain
from tmm_sheets.drawing.marks import Box, Drawing, Mark, Polyline, bounds
from tmm_sheets.words import tell, tr

PAPERS = {"a4": (210.0, 297.0), "a3": (297.0, 420.0)}
"""Width and height of pages, mm."""

MARGIN = 10.0  # mm round the picture on a page: printers cannot reach the edge
OVERLAP = 10.0  # mm
BAR = 100.0  # mm
EDGE = 0.5  # mm within which a line counts as the edge of the paper


class Tile(NamedTuple):
    """One page: its place in the grid, counted from 1 at the top left, the part of the sheet it shows, its own marks.

    ``shift`` takes a place on the sheet to its place on the page.
    """

    row: int
    column: int
    part: Box
    shift: complex
    page: Drawing


def tiles(drawing: Drawing, paper: str = "a4", overlap: float = OVERLAP, bar: bool = False) -> list[Tile]:
    """Pages of a drawing from left to right, row by row from the top; ``bar`` puts the control bar on each of them.

    Raises
    ------
    ValueError
        When the overlap leaves nothing of a page.
    """
    width, height = PAPERS[paper]
    area = Box(MARGIN, MARGIN, width - MARGIN, height - MARGIN)
    across, down = area.width - overlap, area.height - overlap
    if not 0 <= overlap <= 0.5 * (area.width):
        raise ValueError(
            tell("expected an overlap from 0 to {most:g} mm for {paper} pages, not {overlap:g}").format(
                most=0.5 * (area.width), paper=paper.upper(), overlap=overlap
            )
        )
    columns = max(ceil((drawing.width - overlap) / across - 1e-9), 1)
    rows = max(ceil((drawing.height - overlap) / down - 1e-9), 1)
    out = []
    for row in range(1, rows + 1):
        for column in range(1, columns + 1):
            corner = complex((column - 1) * across, drawing.height - (row - 1) * down)  # upper left, on the sheet
            part = Box(corner.real, corner.imag - (area.height), corner.real + area.width, corner.imag)
            canvas = Canvas(of="tile")
            _crop_marks(canvas, area)
            if column < columns:
                canvas.line(complex(area.x1 - overlap, area.y0), complex(area.x1 - overlap, area.y1), "twodot")
            if row < rows:
                canvas.line(complex(area.x0, area.y0 + overlap), complex(area.x1, area.y0 + overlap), "twodot")
            label = tr("Row {row} of {rows}, column {column} of {columns}").format(
                row=row, rows=rows, column=column, columns=columns)
            canvas.text(complex(area.x0 + 2, area.y1 + 3), plain(shorten(f"{label}. {drawing.title}", 90, placeholder=" ...")), 2.5)
            if bar:
                control_bar(canvas, complex(area.x0 + 5, 6.0))
            out.append(Tile(row, column, part, complex(area.x0, area.y1) - corner,
                            Drawing(width, height, drawing.title, tuple(canvas.marks), drawing.author)))  # fmt: skip
    return out


def control_bar(canvas: Canvas, at: complex, along: complex = 1) -> None:
    """Bar of 100 mm to be measured on the print: what it is shorter or longer by, the whole sheet is."""
    end = at + BAR * along
    canvas.line(at, end, "thin")
    for i in range(11):
        tick = 2.0 if i in (0, 10) else 1.0
        canvas.line(at + 10 * i * along - tick * 1j * along, at + 10 * i * along + tick * 1j * along, "thin")
    canvas.text(end + 3 * along - 1.25j * along, tr("100 mm"), 2.5, angle=phase(along))


def with_bar(drawing: Drawing) -> Drawing:
    """The drawing with the control bar in the left margin, outside the frame."""
    canvas = Canvas(of="control bar")
    control_bar(canvas, 10 + 300j, 1j)
    return _with(drawing, (*drawing.marks, *canvas.marks))


def without_outline(drawing: Drawing) -> Drawing:
    """The drawing without the lines along the edge of the paper, which no plotter reaches on paper of just that size."""
    return _with(drawing, tuple(m for m in drawing.marks if not _on_edge(m, drawing)))


def _with(drawing: Drawing, marks: tuple[Mark, ...]) -> Drawing:
    return Drawing(drawing.width, drawing.height, drawing.title, marks, drawing.author)


def _on_edge(mark: Mark, drawing: Drawing) -> bool:
    """Whether a mark is the rectangle round the whole paper."""
    if not isinstance(mark, Polyline):
        return False
    box = bounds([mark])
    return max(abs(box.x0), abs(box.y0), abs(drawing.width - box.x1), abs(drawing.height - box.y1)) < EDGE


def _crop_marks(canvas: Canvas, area: Box) -> None:
    for x, dx in ((area.x0, -1), (area.x1, 1)):
        for y, dy in ((area.y0, -1), (area.y1, 1)):
            canvas.line(complex(x + dx, y), complex(x + 5 * dx, y), "thin")
            canvas.line(complex(x, y + dy), complex(x, y + 5 * dy), "thin")
