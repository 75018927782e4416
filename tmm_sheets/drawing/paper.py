"""Paper: its formats and the frame (GOST 2.301), title block forms 1 and 2a and the turned designation (GOST 2.104); pages.

The forms are data: ``templates/title_blocks.json``. Pages for a small printer, to be glued together, have crop marks, overlap
lines, row and column.
"""

from __future__ import annotations

import json
import re
from cmath import phase
from collections.abc import Mapping, Sequence
from functools import cache
from itertools import product
from math import ceil, pi
from textwrap import shorten
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import Lettering, letter, plain
from tmm_sheets.drawing.marks import Box, Drawing, Form, FormField, Mark, Polyline, bounds
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.drawing.text_layout import NARROWEST
from tmm_sheets.resources import template
from tmm_sheets.words import tell, tr, tr_in

if TYPE_CHECKING:
    from tmm_sheets.drawing.canvas import Canvas

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


TURNS = {0.0: 1 + 0j, pi / 2: 1j, pi: -1 + 0j}
"""Exact directions of lettering by angle, rad."""
CAPTION = 2.5
DOTS, MOST = "...", 4
NARROWER = (0.95, 0.9, 0.85, 0.8, 0.75, NARROWEST)
"""Stretches of letters, tried in turn, if a text is too long for its cell at the least height, as CAD programs have."""
PITCH = 1.7  # between lines of type B lettering, in letter heights
SIDE, ENDS = 1.0, 1.25  # least distance of lettering to the lines at its sides, above and below, mm
BESIDE = 0.5  # least distance of the printed words at their sides, mm: their cells have the widths of the standard
NAME_SIDE = 0.7  # that of names, which are long for their cell, mm
NAME_WIDTH, NAME_HEIGHT = 23 - 2 * NAME_SIDE, 4.5
NAME_NARROWER = (*NARROWER, 0.65, 0.6, 0.55, 0.5)
"""Stretches of the letters of names: narrow letters are better than a name without initials."""

FIELDS = frozenset({
    "designation", "title", "project", "letter", "mass", "scale", "developed", "checked", "technical_control", "supervisor",
    "norm_control", "approved", "institution", "group",
})  # fmt: skip
"""Names of the fields of :func:`draw_frame`."""
ROLES = {
    "Drawn": "developed", "Checked": "checked", "T. contr.": "technical_control", "": "supervisor", "N. contr.": "norm_control",
    "Approved": "approved",
}  # fmt: skip
"""Field for the name (field 11) by the role printed in field 10; the department assigns the row without a role."""
WHO = frozenset({"2", "9", "11", "12", "13"})
"""Numbers of the fields with persons, institution and designation; the role in the department's row belongs to them."""


@cache
def _forms() -> dict[str, Any]:
    forms: dict[str, Any] = json.loads(template("title_blocks.json").read_text(encoding="utf-8"))
    return forms


def block(form: str, paper: Paper = A1) -> Box:
    """Box of a title block on the sheet.

    Raises
    ------
    ValueError
        When ``templates/title_blocks.json`` has no such form.
    """
    if form == "about" or form not in _forms():
        known = ", ".join(f for f in _forms() if f != "about")
        raise ValueError(f"title block form '{form}' is not in templates/title_blocks.json (it has {known})")
    w, h = _forms()[form]["size"]
    return Box(paper.frame.x1 - w, paper.frame.y0, paper.frame.x1, paper.frame.y0 + h)


def who_cells(forms: Sequence[Form], paper: Paper = A1) -> tuple[Box, ...]:
    """Cells of a sheet's forms with persons, institution and designation; empty if it has no title block."""
    names = {field.name for form in forms if form.name == "title_block" for field in form.fields}
    if not names:
        return ()
    code = "1" if "developed" in names else "2a"
    place = block(code, paper)
    cells = [cell for number, _, word, *cell in _forms()[code]["cells"] if number in WHO or (number, word) == ("10", "")]
    return (paper.designation, *(Box(place.x0 + x0, place.y0 + y0, place.x0 + x1, place.y0 + y1) for x0, y0, x1, y1 in cells))


def draw_frame(canvas: Canvas, fields: Mapping[str, str], form: str, sheet_number: int, sheet_count: int,
               paper: Paper = A1) -> tuple[Box, ...]:
    """Draw the sheet's outline, frame, title block and rotated designation.

    Parameters
    ----------
    fields
        Plain text by the names of :data:`FIELDS`; absent ones stay empty, mass and scale get a dash (a sheet of
        plans has no mass and as many scales as views).
    form
        "1" or "2a".
    sheet_number, sheet_count
        Fields 7 and 8; a single sheet has no number.

    Returns
    -------
    The boxes of the title block and of the rotated designation, which nothing else may enter.

    Raises
    ------
    ValueError
        when ``fields`` has an unknown name.
    """
    if unknown := sorted(set(fields) - FIELDS):
        raise ValueError(f"title block fields unknown: {', '.join(unknown)}; known are {', '.join(sorted(FIELDS))}")
    place, turned, frame = block(form, paper), paper.designation, paper.frame
    canvas.of = "title block"
    _rectangle(canvas, paper.outline.inset(line_type("thin").width / 2), "thin")  # inside the paper, or half of it is cut off
    _rectangle(canvas, frame, "main")
    first = len(canvas.marks)
    _rules(canvas, place, _forms()[form])
    found = _fill(canvas, place, _forms()[form]["cells"], fields, _values(fields, sheet_number, sheet_count))
    canvas.forms.append(Form("title_block", first, len(canvas.marks), tuple(found)))
    first = len(canvas.marks)
    _rectangle(canvas, turned, "main")
    found = _lines(canvas, turned, {"designation": fields.get("designation", "")}, (7.0, 5.0, 3.5), paper.turn)
    canvas.forms.append(Form("designation", first, len(canvas.marks), tuple(found)))
    said = tr_in("title block", "Format A{number}").format(number=paper.name[1:].replace("x", "×"))
    for x, text in ((frame.x1 - 110, tr_in("title block", "Copied by")), (frame.x1 - 40, said)):
        canvas.text(complex(x, frame.y0 - 3.7), text, CAPTION)
    canvas.of = ""
    return place, turned


def _rules(canvas: Canvas, place: Box, form: Mapping[str, Any]) -> None:
    """Draw the lines of a title block."""
    origin = complex(place.x0, place.y0)
    for style, rows in (("main", form["thick"]), ("thin", form["thin"])):
        for x0, y0, x1, y1 in rows:
            canvas.line(origin + complex(x0, y0), origin + complex(x1, y1), style)


def _fill(canvas: Canvas, place: Box, cells: list[Any], fields: Mapping[str, str],
          values: Mapping[str, tuple[dict[str, str], tuple[float, ...]]]) -> list[FormField]:
    """Letter the printed words of a title block and its fields; returns the fields."""
    names = _name_sizes(fields)
    role, found = "", list[FormField]()
    for number, kind, word, x0, y0, x1, y1 in cells:
        cell = Box(place.x0 + x0, place.y0 + y0, place.x0 + x1, place.y0 + y1)
        if kind == "caption":
            _lines(canvas, cell, {"": _word(word)}, (CAPTION,), side=BESIDE)
        elif number == "10":
            role = word
            _left(canvas, cell, _word(word or ("Head" if fields.get("supervisor") else "")))
        elif number == "11":
            name = fields.get(ROLES[role], "")
            found += _lines(canvas, cell, {ROLES[role]: (short := short_name(name))}, names, side=NAME_SIDE, narrower=NAME_NARROWER)
            if DOTS in short and short != name:  # part of the surname is left out
                canvas.shortened[name] = short
        elif number == "13":
            found += _lines(canvas, cell, {f"{ROLES[role]}_date": ""}, (CAPTION,))
        elif number in values:
            lines, sizes = values[number]
            found += _lines(canvas, cell.inset(_left(canvas, cell, _word(word)), 0, 0, 0), lines, sizes)
    return found


def _word(text: str) -> str:
    """Translation of a printed word of the form; empty if there is none."""
    return tr_in("title block", text) if text else ""


PATRONYMIC = re.compile(r"(ич|вна|чна)$")
"""Ending of a patronymic; a name with one begins with the surname."""


def short_name(name: str) -> str:
    """Shorten a name to the width of its cell in the smallest letters; initials always stay.

    Tried in turn: first names as initials without spaces, narrower letters, the narrowest permitted for names, and finally dots in
    the surname.
    """
    words = name.split()
    surname = words[0] if words and PATRONYMIC.search(words[-1]) else max(words, key=len, default="")
    lettered = (re.sub(r"^\W+", "", word) for word in words if word != surname)  # "Pat" is P.
    initials = "".join(word if word.endswith(".") else f"{word[0]}." for word in lettered if word)
    kept = (surname, *(f"{surname[:k]}{DOTS}" for k in range(len(surname) - 1, 0, -1)))
    shorter = [f"{part} {initials}".strip() if words[:1] == [surname] else f"{initials} {part}".strip() for part in kept]
    widest = NAME_WIDTH / NAME_NARROWER[-1]
    ways = (*[(way, room) for room in (NAME_WIDTH, NAME_WIDTH / NARROWEST, widest) for way in (name, shorter[0])],
            *((way, widest) for way in shorter))
    return next((way for way, room in ways if letter(plain(way), CAPTION).width <= room), shorter[-1])


def _name_sizes(fields: Mapping[str, str]) -> tuple[float, ...]:
    """Permitted heights of the names, mm; the larger only if all names fit in it."""
    names = [letter(plain(fields.get(role, "")), 3.5) for role in ROLES.values()]
    large = all(name.width <= NAME_WIDTH and 3.5 + 2 * _rise(name, 3.5) <= NAME_HEIGHT for name in names)
    return (3.5, 2.5) if large else (2.5,)


def _values(fields: Mapping[str, str], number: int, count: int) -> dict[str, tuple[dict[str, str], tuple[float, ...]]]:
    """Texts by name, and permitted letter heights, mm, by number of the field."""
    def given(*names: str, empty: str = "") -> dict[str, str]:
        return {name: fields.get(name, empty) for name in names}

    return {
        "1": (given("project", "title"), (5.0, 3.5, 2.5)),
        "2": (given("designation"), (7.0, 5.0, 3.5)),
        "4a": (given("letter"), (3.5,)),
        "5": (given("mass", empty="–"), (5.0, 3.5)),
        "6": (given("scale", empty="–"), (5.0, 3.5)),
        "7": ({"sheet": str(number) if count > 1 else ""}, (3.5, 2.5)),
        "8": ({"sheets": str(count)}, (3.5, 2.5)),
        "9": (given("institution", "group"), (5.0, 3.5, 2.5)),
    }


def _rectangle(canvas: Canvas, box: Box, style: str) -> None:
    canvas.polyline(box.corners, style, closed=True)


def _left(canvas: Canvas, cell: Box, text: str) -> float:
    """Letter a printed word at the left of its cell; returns the width it takes, mm."""
    if not text:
        return 0.0
    return canvas.text(complex(cell.x0 + SIDE, cell.centre.imag - CAPTION / 2), plain(text), CAPTION).width + SIDE


def _wrap(text: str, height: float, width: float) -> list[str]:
    """Break between words so that no line is wider than ``width``, unless a single word is."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and letter(plain(longer), height).width <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _rise(laid: Lettering, size: float) -> float:
    """Height of accents (Й, Ö) above the capitals, mm; round letters and brackets do not count."""
    return laid.ascent - size if laid.ascent > 1.1 * size + 1e-9 else 0.0


def _fitted(parts: Mapping[str, str], sizes: tuple[float, ...], width: float, height: float, narrower: tuple[float, ...]) -> tuple[
        float, float, dict[str, list[str]]]:
    """Letter height, stretch and lines of each part: the largest of ``sizes`` at which they fit, in up to four lines.

    A text too long for the smallest height gets ``narrower`` letters, and ends in dots if that is not enough; one of several lines
    has them rather than letters below 3.5 mm.
    """
    for size, wide in product(sizes, (1.0, *narrower)):
        room = int((height / size - 1) / PITCH + 1 + 1e-9)  # lines
        if wide < 1.0 and size > sizes[-1] and (room < 2 or size > 3.5):
            continue
        wrapped = {name: _wrap(part, size, width / wide) if room > 1 else [part] if part else [] for name, part in parts.items()}
        laid = [letter(plain(line), size) for lines in wrapped.values() for line in lines]
        if not laid:
            return size, wide, wrapped
        widest = max([line.width for line in laid])
        tall = size * (1 + PITCH * (len(laid) - 1)) + 2 * _rise(laid[0], size)
        # Three lines and more need some air between the rules of their cell.
        if widest * wide <= width and tall <= height - (1.0 if len(laid) > 2 else 0.0) and len(laid) <= MOST:
            return size, wide, wrapped
    return size, wide, _cut_to_room(wrapped, size, width / wide, min(max(room, len(parts)), MOST))


def _cut_to_room(wrapped: Mapping[str, list[str]], size: float, width: float, room: int) -> dict[str, list[str]]:
    """Cut parts down to ``room`` lines together, the longest first, and to ``width``; dots mark omissions."""
    count = {name: len(lines) for name, lines in wrapped.items()}
    while sum(count.values()) > room:
        count[max(count, key=lambda name: count[name])] -= 1
    return {name: [_cut(line, size, width, whole=k + 1 < count[name] or count[name] == len(lines))
                   for k, line in enumerate(lines[:count[name]])] for name, lines in wrapped.items()}


def _cut(line: str, size: float, width: float, whole: bool) -> str:
    """Cut a line to ``width`` mm, with dots if something of it or after it (not ``whole``) is omitted."""
    end = "" if whole else DOTS
    while line and letter(plain(line + end), size).width > width:
        line, end = line[:-1].rstrip(), DOTS
    return line + end


def _lines(canvas: Canvas, cell: Box, parts: Mapping[str, str], sizes: tuple[float, ...], angle: float = 0.0,
           side: float = SIDE, narrower: tuple[float, ...] = NARROWER) -> list[FormField]:
    """Letter ``parts``, texts by name that each begin a line, in the middle of a cell.

    Returns the lines as fields; a part without text has an empty one below the others.
    """
    along, across = (cell.height, cell.width) if angle == pi / 2 else (cell.width, cell.height)
    size, wide, wrapped = _fitted(parts, sizes, along - 2 * side, across - (2 * ENDS if across > 5 else 0.5), narrower)
    canvas.shortened |= {parts[name]: " ".join(lines) for name, lines in wrapped.items()
                         if " ".join(lines) != " ".join(parts[name].split())}
    up = 1j * TURNS[angle]
    found = []
    count = sum(map(len, wrapped.values()))
    y = size * (PITCH * (max(count, 1) - 1) - 1) / 2
    for name, lines in sorted(wrapped.items(), key=lambda item: not item[1]):
        for n, line in enumerate(lines or [""], 1):
            at, first = cell.centre + up * max(y, ENDS - across / 2), len(canvas.marks)
            if line:
                at = cell.centre + up * y
                canvas.text(at, plain(line), size, "centre", angle, wide)
            found.append(FormField(name if n == 1 else f"{name}_{n}", first, len(canvas.marks), at, size, angle))
            y -= PITCH * size
    return found
