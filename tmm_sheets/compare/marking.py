"""Marks by a scheme of the teacher's: what each kind of fault costs, in a TOML file.

::

    full = 100                # of a work without faults

    [costs]
    mistake = 10              # each mistake named: something done otherwise, or a step drawn wrong with what follows from it
    red = 2                   # each line or number beyond twice the tolerance that no such mistake explains
    amber = 0.5               # each up to twice the tolerance
    missing_view = 8          # each view that is not there
    missing_table = 1         # each table, text or detail that is not found as it is on the sheet
    unjudged = 0              # each file that could not be judged
    unfilled = 0.5            # each percent of the numbers asked for that is left empty
    missing_sheet = 20        # each sheet that nothing handed in shows, where no numbers were measured either

    [at_most]                 # may be left out: the most that all faults of a kind cost together
    amber = 5

    [[grade]]                 # may be left out: the grades by marks, in any order
    from = 90
    name = "5"
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

from tmm_sheets import spelling
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.numbers import told
from tmm_sheets.task import toml_file
from tmm_sheets.words import tell

KINDS = ("mistake", "red", "amber", "missing_view", "missing_table", "unjudged", "unfilled", "missing_sheet")
"""Kinds of faults a scheme gives costs for."""


@dataclass(frozen=True)
class MarkingScheme:
    """A scheme of marks: those of a faultless work, what each fault costs, caps by kind, and grades, the highest first."""

    full: float
    costs: Mapping[str, float]
    at_most: Mapping[str, float] = field(default_factory=dict)
    grades: tuple[tuple[float, str], ...] = ()

    def mark(self, faults: Mapping[str, int]) -> float:
        """The mark of a work with so many faults of each kind, none below 0."""
        return max(self.full - sum(self.lost(kind, n) for kind, n in faults.items()), 0.0)

    def lost(self, kind: str, n: int) -> float:
        """What so many faults of a kind cost."""
        return min(self.costs.get(kind, 0.0) * n, self.at_most.get(kind, float("inf")))

    def counted(self, kind: str, n: int) -> str:
        """How that comes about, in words."""
        each, lost = self.costs.get(kind, 0.0), self.lost(kind, n)
        said = tell("−{lost}") if n == 1 else tell("−{lost} ({n} × {each})")
        said = tell("−{lost} (at most, not {n} × {each})") if lost < each * n else said
        return said.format(lost=told(f"{lost:g}"), n=n, each=told(f"{each:g}")) if lost else "–"

    def grade(self, mark: float) -> str:
        """The name of the grade of a mark; empty without grades."""
        return next((name for least, name in self.grades if mark >= least), self.grades[-1][1] if self.grades else "")


def read(path: Path) -> MarkingScheme:
    """Read a scheme.

    Raises
    ------
    BadInput
        If it cannot be read, or something in it is unknown, missing or no number; every problem with its line and field.
    """
    text, data, _ = toml_file.read(path)
    reading = _Reading(str(path), text.splitlines(), [])
    scheme = reading.scheme(data)
    if reading.problems:
        raise BadInput(reading.problems)
    return scheme


@dataclass(frozen=True)
class _Reading:
    path: str
    lines: list[str]
    problems: list[Problem]

    def scheme(self, data: dict[str, Any]) -> MarkingScheme:
        self._known(data, ("full", "costs", "at_most", "grade"), "")
        full = self._number(data, "full", "")
        if full is None and "full" not in data:
            self._wrong("full", tell("is missing"), tell("the mark of a work without faults, such as full = 100"))
        costs = self._numbers(data.get("costs", {}), "costs")
        if "costs" not in data:
            hint = tell("a table of what each fault costs: {kinds}").format(kinds=", ".join(KINDS))
            self._wrong("costs", tell("is missing"), hint)
        return MarkingScheme(full or 0.0, costs, self._numbers(data.get("at_most", {}), "at_most"),
                             self._grades(data.get("grade", [])))

    def _numbers(self, table: Any, name: str) -> dict[str, float]:
        if not isinstance(table, dict):
            self._wrong(name, tell("expected a table"))
            return {}
        self._known(table, KINDS, f"{name}.")
        found = {key: self._number(table, key, f"{name}.") for key in table if key in KINDS}
        return {key: value for key, value in found.items() if value is not None}

    def _grades(self, rows: Any) -> tuple[tuple[float, str], ...]:
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            self._wrong("grade", tell("expected tables [[grade]] with from and name"))
            return ()
        out = []
        for k, row in enumerate(rows, 1):
            where = f"grade[{k}]."
            self._known(row, ("from", "name"), where)
            least, name = self._number(row, "from", where), row.get("name")
            if "from" not in row:
                self._wrong(f"{where}from", tell("is missing"))
            if not isinstance(name, str) or not name.strip():
                self._wrong(f"{where}name", tell("expected a text"))
            elif least is not None:
                out.append((least, name))
        return tuple(sorted(out, key=lambda grade: -grade[0]))

    def _known(self, table: Mapping[str, Any], keys: tuple[str, ...], where: str) -> None:
        for key in table.keys() - set(keys):
            hint = spelling.hint(key, keys, written='"{}"') or tell("known are {keys}").format(keys=", ".join(keys))
            self._wrong(f"{where}{key}", tell("is not known here"), hint)

    def _number(self, table: Mapping[str, Any], key: str, where: str) -> float | None:
        value = table.get(key)
        if key not in table:
            return None
        if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value) or value < 0:
            self._wrong(f"{where}{key}", tell("expected a number not below 0, not {value}").format(value=repr(value)))
            return None
        return float(value)

    def _wrong(self, field_: str, message: str, hint: str = "") -> None:
        self.problems.append(Problem(message, self.path, self._line(field_), field_, hint))

    def _line(self, field_: str) -> int | None:
        """The line of a field: the first in its table that begins with its key."""
        *tables, key = field_.split(".")
        inside, count = not tables, 0
        wanted, _, number = (tables[0] if tables else "").partition("[")
        for n, line in enumerate(self.lines, 1):
            told = line.strip()
            if told.startswith("["):
                here = told.strip("[] ").split("]")[0].strip()
                count += here == wanted
                inside = bool(tables) and here == wanted and (not number or count == int(number.rstrip("]")))
                if not tables and here == key:
                    return n
            elif inside and told.partition("=")[0].strip().strip('"') == key:
                return n
        return None
