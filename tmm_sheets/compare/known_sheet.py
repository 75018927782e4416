"""A sheet of a project as it is compared: drawn, and put together to what a drawer sees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, elements
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.title_block import who_cells
from tmm_sheets.errors import BadInput
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.sheet import ask_again, composed
from tmm_sheets.words import tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan
    from tmm_sheets.project import Project


CLEAR = 0.3
"""mm off the lines of a cell that lettering in it stands."""


@dataclass(frozen=True)
class KnownSheet:
    """Sheet ``n`` (from 1) with its elements."""

    n: int
    sheet: Composed = field(repr=False)
    elements: tuple[Element, ...] = field(repr=False)

    @cached_property
    def who(self) -> tuple[Box, ...]:
        """Cells in which everybody has texts of their own, which are not compared."""
        return who_cells(self.sheet.drawing.forms)

    def tells_who(self, points: Sequence[complex] | Points) -> bool:
        """Whether all points lie in one of them, off the lines round it."""
        cell = next((cell for cell in self.who if cell.contains(points[0], -CLEAR)), None)
        return cell is not None and all(cell.contains(point, -CLEAR) for point in points)


def known_sheet(project: Project, n: int) -> KnownSheet:
    """Draw sheet ``n``, its elements called by the letters of the steps that left them."""
    sheet = composed(project, n)
    return KnownSheet(n, sheet, elements(sheet))


def plans_of(project: Project, known: KnownSheet) -> dict[str, Plan]:
    """The plans of a project that was asked for all that a sheet shows, by their names."""
    ask_again(project, known.n)
    return {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}


def sheet_numbers(project: Project, asked: int | None) -> range:
    """The sheet asked for, all of a project if none is.

    Raises
    ------
    BadInput
        If there is no such sheet.
    """
    count = len(project.variant.sheets)
    if asked is None:
        return range(1, count + 1)
    if not 1 <= asked <= count:
        said = tell_n("--sheet {asked}: {project} has {n} sheet", "--sheet {asked}: {project} has {n} sheets", count)
        hint = tell("--sheet 1 to --sheet {n}") if count > 1 else tell("give --sheet 1, or leave it out")
        raise BadInput(said.format(asked=asked, project=project.variant.called, n=count), hint.format(n=count))
    return range(asked, asked + 1)
