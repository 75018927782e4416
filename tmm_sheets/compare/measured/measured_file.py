"""The CSV file of measured numbers: written as a template, read back as people fill it in.

Written with a byte order mark, and with semicolons and decimal commas: that is what a Russian or Ukrainian Excel opens with a
double click, columns, letters and numbers in their places; for English with commas and points. LibreOffice asks and has them, too.
Read is more: tabs, code page 1251, UTF-16, a missing heading, headings of any language, units written into the cell. What is mended
is said. Ids are ASCII, for no code page to spoil.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from tmm_sheets import csv_tables, encodings, files, quoting, spelling
from tmm_sheets.compare.elements import grouped
from tmm_sheets.compare.measured import measurable as units
from tmm_sheets.compare.measured.measurable import Measurable, Measurables, plain
from tmm_sheets.construction.scale import Scale
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.numbers import told
from tmm_sheets.words import decimal_sign, every, marked, reader, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.project import Project

Column = Literal["id", "plan", "position", "quantity", "steps", "unit", "measured", "factor"]
COLUMNS: Mapping[Column, str] = {
    "id": marked("id"), "plan": marked("plan"), "position": marked("position"), "quantity": marked("quantity"),
    "steps": marked("steps of the plan"), "unit": marked("unit"), "measured": marked("measured"),
}
"""Headings as they are written."""
OTHER_NAMES: Mapping[str, Column] = {
    "ид": "id", "код": "id", "steps": "steps", "ед": "unit", "ед.": "unit", "единицы": "unit", "од": "unit", "од.": "unit",
    "value": "measured", "значение": "measured", "значення": "measured", "измерено мм": "measured", "измерено, мм": "measured",
    "виміряно, мм": "measured", "measured, mm": "measured", "масштаб": "factor", "мю": "factor", "μ": "factor", "mu": "factor",
    "scale": "factor",
}
"""Headings as they may be written besides, in small letters."""
OF_PROJECT = marked("project: {project}")
"""The remark that says which project a file is of."""
NOT_MEASURED = marked("not measured")
"""What may stand in place of a number, besides dashes and nothing."""
FACTOR = "mu"
"""In place of a plan's name in the id of a line that states a scale factor."""
APART = 300.0
"""How many times as large or small as on the sheet a scale factor may be: metres for millimetres are more."""
ABSURD = 1e12
"""No number on a sheet is as large."""
ROUGHEST = 0.05
"""Share of the greatest number of a row of results that rounding may be: "1" for 0.64 m is no rounding."""
SHOWN = 20
"""Problems told at once."""

_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d{1,3})?")


@dataclass(frozen=True)
class MeasuredLine:
    """One filled line: the number in the unit of its entry, how exactly it was written, and where.

    ``factor`` is the scale factor of this line alone, where it states one.
    """

    entry: Measurable
    value: float
    half_digit: float
    line: int
    factor: float | None = None


@dataclass
class FilledTable:
    """A file that was read: lines, scale factors by key, and what was mended."""

    lines: list[MeasuredLine] = field(default_factory=list)
    factors: dict[str, float] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    empty: int = 0


# --- writing ---------------------------------------------------------------------------------------------------------------


def template(project: str, found: Measurables, everything: bool = False) -> bytes:
    """The file to be filled in: scale factors as the sheets have them, then a line for each quantity; no exact values.

    Only the main ones, unless ``everything`` is asked for, plan by plan and position by position. Cells are separated by
    semicolons, as where the comma is in numbers; where that is a point, by commas.
    """
    asked = asked_for(found, everything)
    rows = [
        [f"# {tell(OF_PROJECT).format(project=project)}"],
        [tell("# Fill in the column “{column}”; leave empty what you have not measured. Lengths are mm of the drawing.")
         .format(column=tell(COLUMNS["measured"]))],
        [tell("# Angles of vectors are counted counter-clockwise from the x axis, 0° to 360°: ∠pb is that of the arrow "
              "from p to b.")],
        [tell("# Lines {lines}: scale factors of the sheets. If you drew to others, write yours.").format(lines=f"{FACTOR}/...")],
        [tell(heading) for heading in COLUMNS.values()]]
    used = {e.scale for e in asked if e.scale}
    for key, scale in found.scales.items():
        if key in used and len(set(scale.unit.split("/"))) > 1:  # else in millimetres of paper
            rows.append([f"{FACTOR}/{plain(key)}", tell("scale factors"), "", scale.symbol, "", scale.unit,
                         told(f"{scale.mu:.10g}")])
    for (title, label), entries in grouped(asked, lambda e: (e.title, e.label)).items():
        rows.append([f"# {title}, {tell('position {label}').format(label=label)}" if label else f"# {title}"])
        rows += [[e.id, e.title, e.label, e.quantity, e.steps, tell(e.unit), ""] for e in entries]
    return csv_tables.written(rows, ";" if decimal_sign(reader()) == "," else ",")


def asked_for(found: Measurables, everything: bool = False) -> list[Measurable]:
    """What is asked for in the file: plan by plan, and there position by position."""
    asked = (e for e in found.entries.values() if everything or e.main)
    return [e for some in grouped(asked, lambda e: (e.title, e.label)).values() for e in some]


# --- reading ---------------------------------------------------------------------------------------------------------------


class _Refused(Exception):
    """What is wrong with a line: in which column, and what to try."""

    def __init__(self, message: str, hint: str = "", column: Column = "measured") -> None:
        super().__init__(message)
        self.message, self.hint, self.column = message, hint, column


def read(path: Path, project: Project, found: Measurables) -> FilledTable:
    """Read a filled file of a project.

    Raises
    ------
    BadInput
        every problem found, each with file, line and column.
    """
    name = str(path)
    filled = FilledTable()
    text, note = text_of(path, project)
    filled.notes += [f"{name}: {note}"] if note else []
    _check_project(text, name, project)
    rows = _rows(text, name, filled.notes, project)
    table = _Table(name, found, filled, *_columns(rows, name, found, filled.notes))
    for row in rows[table.start:]:
        table.read(*row)
    table.refuse(len(rows), project)
    if not filled.lines:
        raise BadInput(Problem(tell("nothing is filled in"), name, field=table.title("measured"),
                               hint=tell("write what you measured into that column, then compare again")))
    return filled


def _writes(project: Project) -> str:
    return tell("{command} writes a file to fill in").format(command=project.variant.command("compare", "--template"))


def text_of(path: Path, project: Project) -> encodings.DecodedText:
    """What is in a file, if it may be one of numbers."""
    read = csv_tables.text_of(path, _writes(project))
    if not read.text.strip():
        raise BadInput(Problem(tell("the file is empty"), str(path), hint=_writes(project)))
    return read


def _check_project(text: str, name: str, project: Project) -> None:
    """Refuse the numbers of another project than the one they are compared with: right ones would be judged wrong."""
    called = project.variant.called
    said = "|".join(re.escape(heading.partition("{")[0].strip()) for heading in every(OF_PROJECT))
    for number, line in enumerate(text.splitlines()[:10], 1):
        match = re.match(rf'\s*"?#\s*(?:{said})\s*([^;,\t"]+)', line)
        other = match[1].strip() if match else ""
        mine = re.split(r'[;,\t"]', called)[0].strip()
        # Files are where they are, seen from one folder or another.
        same = other == mine or (other.endswith(".toml") and re.split(r"[/\\]", other)[-1] == re.split(r"[/\\]", mine)[-1])
        if other and not same:
            said = tell("the file is of the project {other}, not of {project}").format(other=other, project=called)
            own = tell('write "{heading}" there, if its numbers are of that project').format(
                heading=f"# {tell(OF_PROJECT).format(project=called)}")
            from tmm_sheets import catalogue

            known = catalogue.is_shipped(other)
            with suppress(BadInput):
                known = known or files.named(other).is_file()
            hints = ([quoting.command("compare", other, "--measured", name)] if known else []) + [own]
            raise BadInput(Problem(said, name, number, hint="\n    ".join(hints)))


Row = tuple[int, list[str]]


def _rows(text: str, name: str, notes: list[str], project: Project) -> list[Row]:
    """Lines with their numbers, split at the separator they use; no empty ones, no remarks."""
    found = [*csv_tables.rows(text, name, "#")]
    if not found:
        raise BadInput(Problem(tell("no lines with numbers"), name, hint=_writes(project)))
    if len(found[0][1]) == 1:
        raise BadInput(Problem(tell("no separator found: expected columns with ; or , or a tab between them"), name, found[0][0],
                               hint=tell("save the table as CSV with semicolons")))
    separator = csv_tables.separator(text, "#")
    if separator == "\t":
        notes.append(tell("{file}: columns separated by tabs").format(file=name))
    elif separator == ",":
        _mend_commas(found, name, notes)
    return found


def _mend_commas(rows: list[Row], name: str, notes: list[str]) -> None:
    """A decimal comma between commas as separators: two last cells that are one number."""
    width = len(rows[0][1])
    mended = []
    for i, cells in rows[1:]:
        if len(cells) == width + 1 and re.fullmatch(r"-?\d+", cells[-2]) and re.fullmatch(r"\d+", cells[-1]):
            cells[-2:] = [f"{cells[-2]},{cells[-1]}"]
            mended.append(i)
    if mended:
        said = tell_n("{file}: {n} decimal comma between separating commas put together, first in line {line}",
                      "{file}: {n} decimal commas between separating commas put together, first in line {line}", len(mended))
        notes.append(said.format(file=name, n=len(mended), line=mended[0]))


def _columns(rows: list[Row], name: str, found: Measurables, notes: list[str]) -> tuple[dict[Column, int], list[str], int]:
    """Which column is which, what stands above them, and the first row of numbers."""
    number, head = rows[0]
    written: dict[str, Column] = {said.lower(): column for column, heading in COLUMNS.items() for said in every(heading)}
    own: dict[str, Column] = {column: column for column in COLUMNS}
    known = {**OTHER_NAMES, **own, **written}
    columns = {known[title]: i for i, title in reversed([*enumerate(h.lower().strip(" :") for h in head)]) if title in known}
    if "id" in columns and "measured" in columns:
        return columns, head, 1
    if not columns and (plain(head[0]) in found.entries or plain(head[0]).startswith(f"{FACTOR}/")):
        notes.append(tell("{file}: no heading: first column taken for {first}, last for {last}").format(
            file=name, first=tell(COLUMNS["id"]), last=tell(COLUMNS["measured"])))
        return {"id": 0, "measured": len(head) - 1}, [], 0
    wanted: tuple[Column, ...] = ("id", "measured")
    raise BadInput([_missing(COLUMNS[wants], head, name, number) for wants in wanted if wants not in columns])


def _missing(heading: str, head: Sequence[str], name: str, number: int) -> Problem:
    """That a column is missing; it may be called nearly so, in any language."""
    near = [other for one in every(heading) for other in spelling.near(one, [h.lower() for h in head])]
    hint = tell('did you mean "{near}"? rename it').format(near=near[0]) if near else tell("there are {headings}").format(
        headings=", ".join(filter(None, head)))
    return Problem(tell('the column "{heading}" is missing').format(heading=tell(heading)), name, number, tell(heading), hint)


@dataclass
class _Table:
    """A file while it is read line by line, with what is wrong with it.

    Attributes
    ----------
    name, found, filled : its name, what may be measured, and what was read
    columns, head, start : the columns by what they hold, their headings if they have any, the first row of numbers
    """

    name: str
    found: Measurables
    filled: FilledTable
    columns: Mapping[Column, int]
    head: Sequence[str]
    start: int

    def __post_init__(self) -> None:
        self.problems: list[Problem] = []
        self.unknown: list[Problem] = []
        self.seen: dict[str, MeasuredLine] = {}
        self.used = {e.scale for e in self.found.entries.values() if e.scale in self.found.scales}
        self.points = self.commas = 0
        self.nothing = {"-", "–", "—", *(said.lower() for said in every(NOT_MEASURED))}

    def title(self, column: Column) -> str:
        """What stands above a column."""
        return self.head[self.columns[column]] if self.head else tell(COLUMNS[column])

    def read(self, number: int, cells: Sequence[str]) -> None:
        """Read one line."""
        def cell(column: Column) -> str:
            at = self.columns.get(column)
            return cells[at] if at is not None and at < len(cells) else ""

        key, written = cell("id"), cell("measured")
        if not key:
            if written:
                self.problems.append(Problem(tell("{number} stands beside no quantity").format(number=written), self.name, number,
                                             self.title("id")))
            return
        if not written or written.lower() in self.nothing:
            self.filled.empty += 1
            return
        self.points, self.commas = self.points + ("." in written), self.commas + ("," in written)
        try:
            if plain(key).startswith(f"{FACTOR}/"):
                _factor(key, written, self.found, self.filled, self.used)
                return
            entry = _entry(key, self.found, self.filled, self.name, number)
            value, half = _number(written, cell("unit"), entry, self.filled, f"{self.name}:{number}")
            if entry.kind == "result":
                half = min(half, ROUGHEST * max(abs(e.value) for e in self.found.entries.values()
                                                if (e.plan, e.quantity) == (entry.plan, entry.quantity)))
            own = cell("factor") if entry.scale else ""
            factor = _scale_factor(own, self.found.scales[entry.scale]) if own else None
        except _Refused as e:
            problem = Problem(e.message, self.name, number, self.title(e.column), e.hint)
            self.problems.append(problem)
            self.unknown += [problem] if e.column == "id" else []
            return
        self._take(MeasuredLine(entry, value, half, number, factor))

    def _take(self, line: MeasuredLine) -> None:
        """Take a line in, unless its quantity was there before."""
        before = self.seen.setdefault(line.entry.id, line)
        if before is line:
            self.filled.lines.append(line)
        elif before.value == line.value:
            self.filled.notes.append(tell("{place}: {id} stands twice with the same number, counted once").format(
                place=f"{self.name}:{line.line}", id=line.entry.id))
        else:
            twice = tell("{id} stands twice: {before} in line {line}, {here} here").format(
                id=line.entry.id, before=told(f"{before.value:g}"), line=before.line, here=told(f"{line.value:g}"))
            self.problems.append(Problem(twice, self.name, line.line, self.title("measured"), tell("leave one of them")))

    def refuse(self, rows: int, project: Project) -> None:
        """Tell what is wrong with the whole, and what is remarkable.

        Raises
        ------
        BadInput
            if anything is wrong.
        """
        if self.points and self.commas:
            self.filled.notes.append(tell("{file}: decimal points in {points} lines, commas in {commas}: both are read as "
                                          "decimal marks")
                                     .format(file=self.name, points=self.points, commas=self.commas))
        if len(self.unknown) > SHOWN and len(self.unknown) > 0.5 * rows:
            hint = tell("is the file of another project? this is {project}; {command} writes one").format(
                project=project.variant.called, command=project.variant.command("compare", "--template"))
            said = tell("{n} of {rows} lines are about quantities this project does not have")
            said = said.format(n=len(self.unknown), rows=rows)
            raise BadInput(Problem(said, self.name, self.unknown[0].line, self.title("id"), hint))
        if len(self.problems) > SHOWN:
            more = len(self.problems) - SHOWN
            said = tell_n("and {n} problem more", "and {n} problems more", more).format(n=more)
            self.problems[SHOWN:] = [Problem(said, self.name)]
        if self.problems:
            raise BadInput(self.problems)


def _factor(key: str, written: str, found: Measurables, filled: FilledTable, used: set[str]) -> None:
    known = {plain(scale): scale for scale in used}
    wanted = plain(key).partition("/")[2]
    if wanted not in known:
        raise _Refused(tell("unknown scale factor {key}").format(key=key),
                       spelling.hint(wanted, sorted(known), written=f"{FACTOR}/{{}}"), "id")
    filled.factors[known[wanted]] = _scale_factor(written, found.scales[known[wanted]])


def _scale_factor(written: str, scale: Scale) -> float:
    """A scale factor that may be meant: not hundreds of times that of the sheet."""
    match = _NUMBER.fullmatch(_plain(written))
    factor = float(match[0].replace(",", ".")) if match else 0.0
    if not (isfinite(factor) and factor > 0):
        raise _Refused(tell("expected a scale factor, a positive number, not {written}").format(written=repr(written)))
    if not 1 / APART < factor / scale.mu < APART:
        said = tell("the scale factor {factor} is far from that of the sheet, {mu} {unit}")
        raise _Refused(said.format(factor=told(f"{factor:g}"), mu=told(f"{scale.mu:g}"), unit=scale.unit),
                       tell("is it in {unit}?").format(unit=scale.unit))
    return factor


def _plain(written: str) -> str:
    """A number without spaces between thousands, apostrophes of spreadsheets and typographic minus."""
    bare = written.strip().lstrip("'≈~= ").replace("−", "-").replace("–", "-")
    return re.sub(r"(?<=\d)[\s\u00a0\u202f'](?=\d{3}(?!\d))", "", bare)


def _entry(key: str, found: Measurables, filled: FilledTable, name: str, number: int) -> Measurable:
    known = plain(key)  # allowing for primes, dashes and letters that look alike
    if known not in found.entries:
        raise _Refused(tell("unknown quantity {key}").format(key=key), spelling.hint(key, found.entries, 2), "id")
    if known != key:
        filled.notes.append(tell("{place}: {key} read as {known}").format(place=f"{name}:{number}", key=key, known=known))
    return found.entries[known]


def _number(written: str, unit: str, entry: Measurable, filled: FilledTable, place: str) -> tuple[float, float]:
    """The number in the entry's unit, and half a unit of its last digit."""
    text = _plain(written)
    match = _NUMBER.match(text)
    example = told("46.5")
    if match is None:
        raise _Refused(tell("expected a number, not {written}").format(written=repr(written)),
                       tell("write for example {example}; leave empty what was not measured").format(example=example))
    own = text[match.end():].strip()
    if own and not re.match(r"[A-Za-zА-Яа-я°%/(]", own):
        raise _Refused(tell("expected one number, not {written}").format(written=repr(written)),
                       tell("write for example {example}").format(example=example))
    value = float(match[0].replace(",", "."))
    if not abs(value) < ABSURD:
        raise _Refused(tell("expected a number that a sheet can have, not {written}").format(written=repr(written)))
    mantissa, _, exponent = match[0].lower().partition("e")
    decimals = len(mantissa.replace(",", ".").partition(".")[2])
    half = 0.5 * 10.0 ** (int(exponent or 0) - decimals) if value else 0.0  # nothing is nothing, however it is written
    times = _times(own or unit, entry)
    if times != 1.0:
        taken = f"{told(f'{value * times:g}')} {tell(entry.unit)}"
        filled.notes.append(tell("{place}: {written} taken as {taken}").format(
            place=place, written=written if own else f"{written} {unit}", taken=taken))
    return value * times, half * times


def _times(unit: str, entry: Measurable) -> float:
    """How many of the entry's units one of the stated units has."""
    try:
        return units.unit_times(unit, entry.unit)
    except ValueError:
        if not entry.unit:
            said = tell("expected a pure number, not {unit}").format(unit=unit)
            raise _Refused(said, tell("write the number in no unit")) from None
        own = tell(entry.unit)
        raise _Refused(tell("expected {own}, not {unit}").format(own=own, unit=unit),
                       tell("write the number in {own}").format(own=own)) from None


def factor_of(line: MeasuredLine, scales: Mapping[str, Scale], factors: Mapping[str, float]) -> float:
    """The scale factor a length was drawn with."""
    return line.factor or factors.get(line.entry.scale, scales[line.entry.scale].mu)
