"""The CSV file of measured numbers: written as a template, read back as people fill it in.

Written with semicolons, decimal commas and a byte order mark: that is what a Russian Excel opens with a double click, columns,
letters and numbers in their places; LibreOffice asks and has them, too. Read is more: commas, tabs, decimal points, code page 1251,
UTF-16, a missing heading, units written into the cell. What is mended is said. Ids are ASCII, for no code page to spoil.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from math import degrees, isfinite
from pathlib import Path
from typing import Literal

from tmm_sheets import texts
from tmm_sheets.compare.measured.measurable import DEGREES, MILLIMETRES, Measurable, Measurables, plain
from tmm_sheets.construction.scale import Scale
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.numbers import written

Column = Literal["id", "plan", "position", "quantity", "steps", "unit", "measured", "factor"]
COLUMNS: Mapping[Column, str] = {
    "id": "обозначение", "plan": "план", "position": "положение", "quantity": "величина", "steps": "шаги", "unit": "единица",
    "measured": "измерено",
}
"""Headings as they are written."""
OTHER_NAMES: Mapping[str, Column] = {
    **{title: column for column, title in COLUMNS.items()},
    "id": "id", "ид": "id", "код": "id", "plan": "plan", "position": "position", "quantity": "quantity", "steps": "steps",
    "unit": "unit", "ед": "unit", "ед.": "unit", "единицы": "unit", "measured": "measured", "value": "measured",
    "значение": "measured", "измерено мм": "measured", "измерено, мм": "measured", "масштаб": "factor", "мю": "factor",
    "μ": "factor", "mu": "factor", "scale": "factor",
}
"""Headings as they may be written, in small letters."""
FACTOR = "mu"
"""In place of a plan's name in the id of a line that states a scale factor."""
LARGEST = 5_000_000
"""Bytes of the largest file that is read; a whole project has some 50,000."""
APART = 300.0
"""How many times as large or small as on the sheet a scale factor may be: metres for millimetres are more."""
ABSURD = 1e12
"""No number on a sheet is as large."""
SHOWN = 20
"""Problems told at once."""

_NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d{1,3})?")
_RADIAN = degrees(1)
_LENGTHS: Mapping[str, float] = {"мм": 1.0, "mm": 1.0, "см": 10.0, "cm": 10.0, "м": 1000.0, "m": 1000.0}
_ANGLES: Mapping[str, float] = {"°": 1.0, "град": 1.0, "град.": 1.0, "deg": 1.0, "рад": _RADIAN, "rad": _RADIAN}
_LATIN: Mapping[str, str] = {
    "м": "m", "с": "s", "рад": "rad", "Н": "N", "кг": "kg", "мм": "mm", "об": "rev", "мин": "min", "Дж": "J",
}


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
class Filled:
    """A file that was read: lines, scale factors by key, and what was mended."""

    lines: list[MeasuredLine] = field(default_factory=list)
    factors: dict[str, float] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    empty: int = 0


# --- writing ---------------------------------------------------------------------------------------------------------------


def template(project: str, found: Measurables) -> bytes:
    """The file to be filled in: scale factors as the sheets have them, then a line for each quantity; no exact values."""
    out = io.StringIO()
    rows = csv.writer(out, delimiter=";", lineterminator="\r\n")
    rows.writerow([f"# проект: {project}"])
    rows.writerow([f"# Заполните столбец «{COLUMNS['measured']}», чего не мерили – оставьте пустым. Длины – в мм чертежа."])
    rows.writerow([f"# Строки {FACTOR}/...: масштабные коэффициенты листов. Чертили в своём масштабе – впишите свои."])
    rows.writerow(COLUMNS.values())
    used = {e.scale for e in found.entries.values() if e.scale}
    for key, scale in found.scales.items():
        if key in used and scale.unit != "мм/мм":
            first = f"{FACTOR}/{plain(key)}"
            rows.writerow([first, "масштабные коэффициенты", "", scale.symbol, "", scale.unit, _written(scale.mu)])
    for e in found.entries.values():
        rows.writerow([e.id, e.title, e.label, e.quantity, e.steps, e.unit, ""])
    return b"\xef\xbb\xbf" + out.getvalue().encode()


def _written(x: float) -> str:
    return written(f"{x:.10g}")


# --- reading ---------------------------------------------------------------------------------------------------------------


def check(path: Path) -> None:
    """Refuse a file that cannot be read, before any work is done for it."""
    _bytes(path)


def read(path: Path, project: str, found: Measurables) -> Filled:
    """Read a filled file.

    Raises
    ------
    BadInput
        every problem found, each with file, line and column.
    """
    name = str(path)
    filled = Filled()
    text = _decoded(_bytes(path), name, filled.notes)
    _check_project(text, name, project)
    rows = _rows(text, name, filled.notes)
    problems: list[Problem] = []
    columns, start = _columns(rows, name, found, filled.notes)
    _read_rows(rows[start:], columns, name, found, filled, problems)
    if problems:
        unknown = [p for p in problems if p.message.startswith("unknown")]
        if len(unknown) > SHOWN and len(unknown) > 0.5 * len(rows):
            hint = f"is the file of another project? this is {project}; compare {project} --template writes one"
            raise BadInput(Problem(f"{len(unknown)} of {len(rows)} lines are about quantities this project does not have", name,
                                   unknown[0].line, COLUMNS["id"], hint))
        if len(problems) > SHOWN:
            problems[SHOWN:] = [Problem(f"and {len(problems) - SHOWN} problems more", name)]
        raise BadInput(problems)
    if not filled.lines:
        raise BadInput(Problem("nothing is filled in", name, field=COLUMNS["measured"],
                               hint="write what you measured into that column, then compare again"))
    return filled


def _bytes(path: Path) -> bytes:
    try:
        if path.is_dir():
            raise BadInput(Problem("expected a CSV file, this is a folder", str(path)))
        data = path.read_bytes() if path.stat().st_size <= LARGEST else b""
    except OSError as e:
        hint = "compare PROJECT --template writes a file to fill in" if isinstance(e, FileNotFoundError) else ""
        raise BadInput(Problem(f"cannot be read: {(e.strerror or str(e)).lower()}", str(path), hint=hint)) from None
    if not data.strip():
        large = path.stat().st_size > LARGEST
        what = f"larger than {LARGEST // 1_000_000} MB: not a file of numbers" if large else "the file is empty"
        raise BadInput(Problem(what, str(path), hint="compare PROJECT --template writes a file to fill in"))
    if data[:2] == b"PK" or data[:4] == b"\xd0\xcf\x11\xe0":
        raise BadInput(Problem("this is a workbook, not a CSV file", str(path), hint="save it as CSV (Файл – Сохранить как – CSV)"))
    return data


def _decoded(data: bytes, name: str, notes: list[str]) -> str:
    try:
        text, note = texts.decoded(data)
    except texts.NotText as e:
        raise BadInput(Problem(str(e), name, e.line, hint="save it as CSV, UTF-8")) from None
    if note:
        notes.append(f"{name}: {note}")
    return texts.cleaned(text)


def _check_project(text: str, name: str, project: str) -> None:
    for number, line in enumerate(text.splitlines()[:10], 1):
        match = re.match(r'\s*"?#\s*проект:\s*([^;,\t"]+)', line)
        if match and match[1].strip() != re.split(r'[;,\t"]', project)[0].strip():
            raise BadInput(Problem(f"the file is of the project {match[1].strip()}, not of {project}", name, number,
                                   hint=f"tmm-sheets compare {match[1].strip()} --measured {name}"))


Row = tuple[int, list[str]]


def _rows(text: str, name: str, notes: list[str]) -> list[Row]:
    """Lines with their numbers, split at the separator they use; no empty ones, no remarks."""
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1)
             if line.strip(" ;,\t\"") and not line.lstrip(' "\t').startswith("#")]
    if not lines:
        raise BadInput(Problem("no lines with numbers", name, hint="compare PROJECT --template writes a file to fill in"))
    head = lines[0][1]
    separator = max(";\t,", key=head.count)
    if head.count(separator) == 0:
        raise BadInput(Problem("no separator found: expected columns with ; or , or a tab between them", name, lines[0][0],
                               hint="save the table as CSV with semicolons"))
    if separator != ";":
        notes.append(f"{name}: columns separated by {'commas' if separator == ',' else 'tabs'}")
    found: list[Row] = []
    for i, line in lines:
        try:
            cells = next(csv.reader([line], delimiter=separator))
        except csv.Error as e:
            raise BadInput(Problem(f"cannot be read as CSV: {e}", name, i)) from None
        found.append((i, [c.strip().strip("\u00a0") for c in cells]))
    if separator == ",":
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
        notes.append(f"{name}: {len(mended)} decimal commas between separating commas put together, first in line {mended[0]}")


def _columns(rows: list[Row], name: str, found: Measurables, notes: list[str]) -> tuple[dict[Column, int], int]:
    """Which column is which, and the first row of numbers."""
    number, head = rows[0]
    columns: dict[Column, int] = {}
    for i, title in enumerate(head):
        column = OTHER_NAMES.get(title.lower().strip(" :"))
        if column is not None:
            columns.setdefault(column, i)
    if "id" in columns and "measured" in columns:
        return columns, 1
    if not columns and (_known(head[0], found) or plain(head[0]).startswith(f"{FACTOR}/")):
        notes.append(f"{name}: no heading: first column taken for {COLUMNS['id']}, last for {COLUMNS['measured']}")
        return {"id": 0, "measured": len(head) - 1}, 0
    wanted: tuple[Column, ...] = ("id", "measured")
    problems = []
    for wants in wanted:
        if wants not in columns:
            near = get_close_matches(COLUMNS[wants], [h.lower() for h in head], n=1, cutoff=0.6)
            there = f"there are {', '.join(filter(None, head))}"
            problems.append(Problem(f'the column "{COLUMNS[wants]}" is missing', name, number, COLUMNS[wants],
                                    f'did you mean "{near[0]}"? rename it' if near else there))
    raise BadInput(problems)


def _read_rows(rows: Iterable[Row], columns: Mapping[Column, int], name: str, found: Measurables, filled: Filled,
               problems: list[Problem]) -> None:
    seen: dict[str, MeasuredLine] = {}
    used = {key for key in found.scales if any(e.scale == key for e in found.entries.values())}
    points = commas = 0
    for number, cells in rows:
        def cell(column: Column, cells: list[str] = cells) -> str:
            at = columns.get(column)
            return cells[at] if at is not None and at < len(cells) else ""

        key, written = cell("id"), cell("measured")
        if not key:
            if written:
                problems.append(Problem(f"{written} stands beside no quantity", name, number, COLUMNS["id"]))
            continue
        if not written or written in ("-", "–", "—"):
            filled.empty += 1
            continue
        points, commas = points + ("." in written), commas + ("," in written)
        try:
            if plain(key).startswith(f"{FACTOR}/"):
                _factor(key, written, found, filled, used)
                continue
            entry = _entry(key, found, filled, name, number)
            value, half = _number(written, cell("unit"), entry, filled, f"{name}:{number}")
            own = cell("factor") if entry.scale else ""
            factor = _like(_positive(own), found.scales[entry.scale]) if own else None
        except ValueError as e:
            message, _, hint = str(e).partition("\n")
            where = COLUMNS["id"] if message.startswith("unknown") else COLUMNS["measured"]
            problems.append(Problem(message, name, number, where, hint))
            continue
        line = MeasuredLine(entry, value, half, number, factor)
        before = seen.get(entry.id)
        if before is not None:
            if before.value != value:
                twice = f"{entry.id} stands twice: {before.value:g} in line {before.line}, {value:g} here"
                problems.append(Problem(twice, name, number, COLUMNS["measured"], "leave one of them"))
            else:
                filled.notes.append(f"{name}:{number}: {entry.id} stands twice with the same number, counted once")
            continue
        seen[entry.id] = line
        filled.lines.append(line)
    if points and commas:
        filled.notes.append(f"{name}: decimal points in {points} lines, commas in {commas}: both are read as decimal marks")


def _factor(key: str, written: str, found: Measurables, filled: Filled, used: set[str]) -> None:
    known = {plain(scale): scale for scale in used}
    wanted = plain(key).partition("/")[2]
    if wanted not in known:
        near = get_close_matches(wanted, sorted(known), n=1)
        raise ValueError(f"unknown scale factor {key}" + (f"\ndid you mean {FACTOR}/{near[0]}?" if near else ""))
    filled.factors[known[wanted]] = _like(_positive(written), found.scales[known[wanted]])


def _positive(written: str) -> float:
    match = _NUMBER.fullmatch(_plain(written))
    value = float(match[0].replace(",", ".")) if match else 0.0
    if not (isfinite(value) and value > 0):
        raise ValueError(f"expected a scale factor, a positive number, not {written!r}")
    return value


def _like(factor: float, scale: Scale) -> float:
    """A scale factor that may be meant: not hundreds of times that of the sheet."""
    if not 1 / APART < factor / scale.mu < APART:
        raise ValueError(f"the scale factor {factor:g} is far from that of the sheet, {scale.mu:g} {scale.unit}\n"
                         f"is it in {scale.unit}?")
    return factor


def _plain(written: str) -> str:
    """A number without spaces between thousands, apostrophes of spreadsheets and typographic minus."""
    bare = written.strip().lstrip("'≈~= ").replace("−", "-").replace("–", "-")
    return re.sub(r"(?<=\d)[\s\u00a0\u202f'](?=\d{3}(?!\d))", "", bare)


def _known(key: str, found: Measurables) -> str:
    """The id of the entry that is meant, allowing for primes, dashes and letters that look alike; "" when there is none."""
    return next((k for k in (key, plain(key)) if k in found.entries), "")


def _entry(key: str, found: Measurables, filled: Filled, name: str, number: int) -> Measurable:
    known = _known(key, found)
    if not known:
        near = get_close_matches(key, list(found.entries), n=2, cutoff=0.6)
        raise ValueError(f"unknown quantity {key}" + (f"\ndid you mean {' or '.join(near)}?" if near else ""))
    if known != key:
        filled.notes.append(f"{name}:{number}: {key} read as {known}")
    return found.entries[known]


def _number(written: str, unit: str, entry: Measurable, filled: Filled, place: str) -> tuple[float, float]:
    """The number in the entry's unit, and half a unit of its last digit."""
    text = _plain(written)
    match = _NUMBER.match(text)
    if match is None:
        raise ValueError(f"expected a number, not {written!r}\nwrite for example 46,5; leave empty what was not measured")
    own = text[match.end():].strip()
    if own and not re.match(r"[A-Za-zА-Яа-я°%/(]", own):
        raise ValueError(f"expected one number, not {written!r}\nwrite for example 46,5")
    value = float(match[0].replace(",", "."))
    if not abs(value) < ABSURD:
        raise ValueError(f"expected a number that a sheet can have, not {written!r}")
    mantissa, _, exponent = match[0].lower().partition("e")
    decimals = len(mantissa.replace(",", ".").partition(".")[2])
    half = 0.5 * 10.0 ** (int(exponent or 0) - decimals) if value else 0.0  # nothing is nothing, however it is written
    times = _times(own or unit, entry)
    if times != 1.0:
        stated = written if own else f"{written} {unit}"
        filled.notes.append(f"{place}: {stated} taken as {value * times:g} {entry.unit}")
    return value * times, half * times


def _times(unit: str, entry: Measurable) -> float:
    """How many of the entry's units one of the stated units has."""
    stated = _unit(unit)
    if not stated or stated == _unit(entry.unit) or "?" in unit:  # a code page without superscripts writes м/с?
        return 1.0
    for table, own in ((_LENGTHS, MILLIMETRES), (_ANGLES, DEGREES)):
        if stated in table and (entry.unit == own or entry.unit in table):
            return table[stated] / table[entry.unit]
    if unit.strip().startswith(("к", "k")) and _unit(unit.strip()[1:]) == _unit(entry.unit):
        return 1000.0
    raise ValueError(f"expected {entry.unit or 'a pure number'}, not {unit}\nwrite the number in {entry.unit or 'no unit'}")


def _unit(unit: str) -> str:
    """One spelling of a unit: no spaces, dots and brackets; Russian names in Latin letters."""
    bare = re.sub(r"[\s·⋅*^()?]+", "", unit).replace("²", "2").replace("³", "3")
    if bare in _LENGTHS or bare in _ANGLES:
        return bare
    return re.sub(r"[а-яА-Я]+", lambda word: _LATIN.get(word[0], word[0]), bare)


def factor_of(line: MeasuredLine, scales: Mapping[str, Scale], factors: Mapping[str, float]) -> float:
    """The scale factor a length was drawn with."""
    return line.factor or factors.get(line.entry.scale, scales[line.entry.scale].mu)
