"""Formats of paper (GOST 2.301), the frame on them, the corner of the turned designation (GOST 2.104); sheets cut into pages.

Pages for a small printer, to be glued together, have crop marks, overlap lines, row and column.
"""

from __future__ import annotations

from cmath import phase
from itertools import product
from math import ceil, pi
from textwrap import shorten
from typing import NamedTuple

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import plain
from tmm_sheets.drawing.marks import Drawing, Mark, Polyline, bounds
from tmm_sheets.words import tell, tr

MAIN = {"A0": (841.0, 1189.0), "A1": (594.0, 841.0), "A2": (420.0, 594.0), "A3": (297.0, 420.0)}
"""Short and long side of the main formats, mm."""
SIDES = MAIN | {"A1x3": (841.0, 1783.0), "A1x4": (841.0, 2378.0), "A2x3": (594.0, 1261.0), "A2x4": (594.0, 1682.0),
                "A2x5": (594.0, 2102.0), "A3x3": (420.0, 891.0), "A3x4": (420.0, 1189.0), "A3x5": (420.0, 1486.0),
                "A3x6": (420.0, 1783.0), "A3x7": (420.0, 2080.0)}  # fmt: skip
"""Short and long side of the main and the derived formats (main ones side by side), mm, as the standard rounds them."""
LONG, SHORT = 70.0, 14.0
"""Sides of field 26, the turned designation, mm."""


class Paper(NamedTuple):
    """A sheet of paper: name of its format, width and height in mm."""

    name: str
    width: float
    height: float

    @property
    def outline(self) -> Box:
        """Rectangle of the whole paper."""
        return Box(0.0, 0.0, self.width, self.height)

    @property
    def frame(self) -> Box:
        """Inside of the frame: 20 mm at the left for filing, 5 mm elsewhere."""
        return Box(20.0, 5.0, self.width - 5.0, self.height - 5.0)

    @property
    def designation(self) -> Box:
        """Box of field 26: in the upper left corner; on upright paper in the upper right one."""
        frame = self.frame
        if self.width < self.height:
            return Box(frame.x1 - SHORT, frame.y1 - LONG, frame.x1, frame.y1)
        return Box(frame.x0, frame.y1 - SHORT, frame.x0 + LONG, frame.y1)

    @property
    def turn(self) -> float:
        """Angle of the lettering in field 26, rad."""
        return pi / 2 if self.width < self.height else pi

    @property
    def other_way(self) -> Paper:
        """Paper of this format in the other orientation."""
        return Paper(self.name, self.height, self.width)


def paper(name: str, portrait: bool = False) -> Paper:
    """Paper of a format of :data:`SIDES`."""
    short, long = SIDES[name]
    return Paper(name, short, long) if portrait else Paper(name, long, short)


A1 = paper("A1")
"""Paper that sheets are composed for."""


PAPERS = {"a4": (210.0, 297.0), "a3": (297.0, 420.0)}
"""Width and height of pages, mm."""

MARGIN = 10.0  # mm round the picture on a page: printers cannot reach the edge
OVERLAP = 10.0  # mm
BAR = 100.0  # mm
EDGE = 0.5  # mm within which a line counts as the edge of the paper


class Tile(NamedTuple):
    """One page: its row and column, from 1 at the top left, the part of the sheet it shows, its own marks.

    ``shift`` leads from a point of the sheet to that of the page.
    """

    row: int
    column: int
    part: Box
    shift: complex
    page: Drawing


def tiles(drawing: Drawing, paper: str = "a4", overlap: float = OVERLAP, bar: bool = False) -> list[Tile]:
    """Cut a drawing into pages, from left to right, row by row from the top; ``bar`` adds the control bar to each.

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
    for row, column in product(range(1, rows + 1), range(1, columns + 1)):
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
    """Draw a bar of 100 mm: its error on the print is that of the whole sheet."""
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
    return _with_marks(drawing, (*drawing.marks, *canvas.marks))


def without_outline(drawing: Drawing) -> Drawing:
    """The drawing without the outline of the paper, which a plotter cannot reach on paper of that size."""
    return _with_marks(drawing, tuple(m for m in drawing.marks if not _on_edge(m, drawing)))


def _with_marks(drawing: Drawing, marks: tuple[Mark, ...]) -> Drawing:
    return Drawing(drawing.width, drawing.height, drawing.title, marks, drawing.author)


def _on_edge(mark: Mark, drawing: Drawing) -> bool:
    """True if a mark is the outline of the paper."""
    if not isinstance(mark, Polyline):
        return False
    box = bounds([mark])
    return max(abs(box.x0), abs(box.y0), abs(drawing.width - box.x1), abs(drawing.height - box.y1)) < EDGE


def _crop_marks(canvas: Canvas, area: Box) -> None:
    for (x, dx), (y, dy) in product(((area.x0, -1), (area.x1, 1)), ((area.y0, -1), (area.y1, 1))):
        canvas.line(complex(x + dx, y), complex(x + 5 * dx, y), "thin")
        canvas.line(complex(x, y + dy), complex(x, y + 5 * dy), "thin")
