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
from functools import cached_property
from math import inf, isfinite
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Field

from tmm_sheets.numbers import told
from tmm_sheets.task import messages
from tmm_sheets.task.schema import Table
from tmm_sheets.words import marked, tell

FaultKind = Literal["mistake", "red", "amber", "missing_view", "missing_table", "unjudged", "unfilled", "missing_sheet"]
KINDS: tuple[FaultKind, ...] = get_args(FaultKind)
"""Kinds of faults a scheme gives costs for."""


def _not_below_zero(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value) or value < 0:
        raise ValueError(tell("expected a number not below 0"))
    return float(value)


Amount = Annotated[float, BeforeValidator(_not_below_zero)]


class GradeTable(Table):
    """``[[grade]]``: the name of the grade from a mark on."""

    from_: Amount = Field(alias="from", description=marked("the least mark of the grade"))
    name: Annotated[str, Field(min_length=1)] = Field(description=marked("the name of the grade"))


class MarkingScheme(Table):
    """A scheme of marks: those of a faultless work, what each fault costs, caps by kind, and grades."""

    full: Amount = Field(description=marked("the mark of a work without faults, such as full = 100"))
    costs: dict[FaultKind, Amount] = Field(description=marked("a table of what each fault costs"))
    at_most: dict[FaultKind, Amount] = Field(default={})
    grade_: tuple[GradeTable, ...] = Field(default=(), alias="grade", description=marked("tables [[grade]] with from and name"))

    @cached_property
    def grades(self) -> tuple[tuple[float, str], ...]:
        """Least marks and names of the grades, the highest first."""
        return tuple(sorted(((g.from_, g.name) for g in self.grade_), key=lambda grade: -grade[0]))

    def mark(self, faults: Mapping[FaultKind, int]) -> float:
        """The mark of a work with so many faults of each kind, none below 0."""
        return max(self.full - sum(self.lost(kind, n) for kind, n in faults.items()), 0.0)

    def lost(self, kind: FaultKind, n: int) -> float:
        """What so many faults of a kind cost."""
        return min(self.costs.get(kind, 0.0) * n, self.at_most.get(kind, inf))

    def counted(self, kind: FaultKind, n: int) -> str:
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
    return messages.read(MarkingScheme, path)[0]
