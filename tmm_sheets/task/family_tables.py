"""Tables of a family's variants, CSV or TOML, as a manual prints them, and what a cipher chooses in them.

A table with a column ``key`` has a row for each quantity, and a column for each figure of a digit of the cipher (``0`` .. ``9``, or
``0..4``); which digit stands in the column ``digit``; ``symbol``, ``table`` and ``note`` are for the source. Any other table has a
row for each variant: its first column is called after the digits that choose the row, the others after the quantities; a row that
begins with ``unit`` has their units. A TOML table has ``digit``, ``[unit]`` and ``[values]``, lists by the figure of the digit.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from string import Template

from tmm_sheets import csv_tables
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import toml_file
from tmm_sheets.words import tell

ABOUT = ("table", "symbol")
"""Columns of what a quantity is called in the manual."""
LARGEST = 10_000_000
"""Bytes of the largest table that is read."""


@dataclass(frozen=True)
class Choice:
    """A value of a project: as it is written there, and where it comes from."""

    text: str
    source: str = ""


@dataclass(frozen=True)
class Row:
    """A quantity with its value for each figure of the digits that choose it; ``line`` of the file is that of the quantity.

    Without a digit the first value is everybody's. ``about`` has the table's other columns, ``note`` follows the source.
    """

    key: str
    unit: str
    digit: str
    cells: Mapping[str, str]
    file: str
    line: int
    about: Mapping[str, str] = field(default_factory=dict)
    note: str = ""

    @property
    def symbol(self) -> str:
        """Its name in the manual."""
        return self.about.get("symbol") or self.key

    def cell(self, digits: Mapping[str, str]) -> tuple[str, str]:
        """The column that a cipher chooses, and what stands there.

        Raises
        ------
        BadInput
            when there is none, or nothing stands there.
        """
        figure = "".join(digits[letter] for letter in self.digit)
        column = next((head for head in self.cells if not self.digit or _holds(head, figure)), None)
        if column is None or not self.cells[column]:
            raise BadInput(Problem(tell("nothing for {digit} = {figure}").format(digit=self.digit, figure=figure), self.file,
                                   self.line, self.key))
        return column, self.cells[column]

    def source(self, form: str, column: str, **more: str) -> str:
        """Where a value comes from: ``form`` filled in, then the note; of a value that no digit chooses, the note alone."""
        if not self.digit:
            return self.note
        said = Template(form).safe_substitute({
            **more, **self.about, "file": Path(self.file).name, "key": self.key, "symbol": self.symbol, "digit": self.digit,
            "column": column})  # fmt: skip
        return f"{said}{'' if self.note[:1] in ',;:' else ' '}{self.note}"

    def written(self, value: str) -> str:
        """A value with its unit."""
        return f"{value} {self.unit}".rstrip()


def _holds(head: str, figure: str) -> bool:
    """Whether a column, or a row, is that of a figure."""
    low, dots, high = head.partition("..")
    if not dots:
        return head == figure or (head.isdigit() and figure.isdigit() and int(head) == int(figure))
    return low.strip().isdigit() and high.strip().isdigit() and int(low) <= int(figure) <= int(high)


def read(path: Path, digits: str) -> list[Row]:
    """The rows of a table; ``digits`` are the letters of the cipher's.

    Raises
    ------
    BadInput
        with what is wrong in it.
    """
    return list(_read(path, digits, path.stat().st_mtime_ns if path.is_file() else 0))


@lru_cache(64)
def _read(path: Path, digits: str, changed: int) -> tuple[Row, ...]:
    try:
        text, _ = toml_file.text_of(path, LARGEST)
    except FileNotFoundError:
        raise BadInput(Problem(tell("no such file"), str(path))) from None
    rows = [*(_of_toml(text, str(path)) if path.suffix == ".toml" else _of_csv(text, str(path)))]
    for row in rows:
        if unknown := [letter for letter in row.digit if letter not in digits]:
            raise BadInput(Problem(tell("the cipher has no digit {digit}").format(digit=unknown[0]), row.file, row.line, row.key,
                                   tell("its digits are {digits}").format(digits=", ".join(digits) or "–")))
    return tuple(rows)


def _of_csv(text: str, file: str) -> Iterator[Row]:
    rows = [*csv_tables.rows(text, file, "#")]
    if not rows:
        raise BadInput(Problem(tell("the table is empty"), file))
    (first, head), *rows = rows
    if "key" in head:
        columns = [k for k, name in enumerate(head) if name and name not in ("key", "unit", "digit", "note", *ABOUT)]
        for line, cells in rows:
            found = dict(zip(head, [*cells, *[""] * len(head)], strict=False))
            yield Row(found["key"], found.get("unit", ""), found.get("digit", ""), {head[k]: found[head[k]] for k in columns},
                      file, line, {name: found[name] for name in ABOUT if name in found}, found.get("note", ""))
        return
    units = next((cells for _, cells in rows if cells[0] == "unit"), [])
    variants = [(line, cells) for line, cells in rows if cells[0] != "unit"]
    for k, name in enumerate(head[1:], 1):
        if name:
            values = {own[0]: own[k] if k < len(own) else "" for _, own in variants}
            yield Row(name, units[k] if k < len(units) else "", head[0], values, file, first)


def _of_toml(text: str, file: str) -> Iterator[Row]:
    data, _ = toml_file.parsed(text, file)
    values = data.get("values", {})
    lines = text.splitlines()
    for key, cells in values.items() if isinstance(values, dict) else ():
        line = next((n for n, one in enumerate(lines, 1) if one.partition("=")[0].strip() == key and "[" in one), 1)
        if not isinstance(cells, list):
            raise BadInput(Problem(tell("expected a list, a value for each figure of the digit"), file, line, f"values.{key}"))
        digit = data.get("digit", "")
        yield Row(key, str(data.get("unit", {}).get(key, "")), str(digit.get(key, "") if isinstance(digit, dict) else digit),
                  {str(n): str(cell) for n, cell in enumerate(cells)}, file, line)
