"""Table of what is given, for room that a sheet has left: the task's quantities, or the file's lengths, masses and inertias."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import TYPE_CHECKING, Any

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import needs, size_in
from tmm_sheets.numbers import is_zero, number, written
from tmm_sheets.sheets.linkage.link_marks import drawn_points
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

ROWS = (7.0, 6.4, 5.6, 4.6)
"""Heights of the rows that are tried, mm."""
BESIDE = (1, 2, 3)
"""How many quantities may stand in one row."""
HEAD = 8.0
"""Height of the title over the table, mm."""
ROOMY = 8.0
"""What a column is wider than its widest text, mm."""

Rows = list[list[str]]

UNITS = {"deg": "°", **{unit.replace(" ", "").replace("·", "").replace("²", "2"): unit for unit in (
    marked("m"), marked("mm"), marked("cm"), marked("kg"), marked("kg·m²"), marked("N"), marked("kN"), marked("N·m"),
    marked("kN·m"), marked("rad/s"), marked("rpm"), marked("m/s"), marked("MPa"), marked("kW"))}}
"""How the units of a task are written on paper, by their common spelling; others stand as they are."""


def links_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the table can do with, mm; none where a mechanism has no length of its own."""
    return [size for size, _, _ in _forms(project)]


def links(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """What the task gives as it prints it.

    Where the file does not say: where the fixed hinges are, lengths in the order in which the links are put together, then masses
    and moments of inertia.
    """
    _, rows, row = next(form for form in _forms(project) if form[0][0] <= box.width + 1e-6 and form[0][1] <= box.height + 1e-6)
    height = size_in(row)
    widths = needs(rows, height, ROOMY)
    spare = max(box.width - sum(widths), 0.0) / len(widths)
    canvas.text(complex(box.centre.real, box.y1 - 5.5), _title(project), 3.5, "centre")
    canvas.table(complex(box.x0, box.y1 - HEAD), [w + spare for w in widths], rows, row, height)


def _title(project: Project) -> str:
    if project.given:
        return tr("Given data")
    return tr("Given sizes and masses") if any(link.mass for link in project.mechanism.links.values()) else tr("Given sizes")


def _forms(project: Project) -> Iterator[tuple[tuple[float, float], Rows, float]]:
    """Size on paper, rows and their height, of the forms of the table: the clearest first."""
    cells, title = [[symbol, value] for symbol, value in _quantities(project)], _title(project)
    if not cells:
        return
    for row, beside in product(ROWS, BESIDE):
        count = -(-len(cells) // beside)
        columns = [cells[n * count:(n + 1) * count] for n in range(beside)]
        lines = [[text for column in columns for text in (column[i] if i < len(column) else ["", ""])] for i in range(count)]
        rows = [[tr("Quantity"), tr("Value")] * beside, *lines]
        width = max(sum(needs(rows, size_in(row), ROOMY)), letter(title, 3.5).width + 4.0)
        yield (width, HEAD + row * len(rows)), rows, row


def _quantities(project: Project) -> Iterator[tuple[str, str]]:
    """Letters with unit, and number: as the task prints them, or of frame and links, where a synthesis may have found them.

    Of the latter nothing that is zero.
    """
    if project.given:
        for given in project.given:
            yield ", ".join(filter(None, (given.symbol, tr(UNITS.get(given.unit, given.unit))))), written(given.number)
        return
    m = project.mechanism
    lengths: list[Any] = [m.crank.length]
    for g in m.groups:
        lengths += [*g.lengths, g.offset, *getattr(g, "sides", ()), *(leg.length for leg in getattr(g, "legs", ()))]
    lengths += [p.distance for p in m.points]
    given_of_input: list[Any] = [] if m.drive is None else [*m.drive.place, m.drive.speed, m.drive.acceleration]
    for name, at in ((name, at) for name, at in m.fixed.items() if name in drawn_points(project.study.positions)):
        for axis, value in (("x", at.real), ("y", at.imag)):
            if not is_zero(value, float(m.crank.length)):
                yield f"{axis}_{{{name}}}, {tr('m')}", number(value)
    links = sorted(m.links.values(), key=lambda link: (len(link.name), link.name))
    of_links = [getattr(link, name) for name in ("mass", "inertia") for link in links]
    for unit, values in ((tr("m"), lengths), (None, given_of_input), (None, of_links)):
        for value in values:
            given = getattr(value, "step", value)  # one that a synthesis found has the letters of its step
            if value and getattr(given, "symbol", ""):
                units = {"kg": tr("kg"), "kg*m2": tr("kg·m²"), "m": tr("m"), "m/s": tr("m/s"), "m/s2": tr("m/s²")}
                # The other way along its line is no length.
                yield f"{given.symbol}, {unit or units[given.unit]}", number(abs(float(value)))
