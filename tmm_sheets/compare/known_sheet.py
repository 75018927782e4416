"""A sheet of a project as it is compared: drawn, and put together to what a drawer sees."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tmm_sheets.compare.elements import Element, elements
from tmm_sheets.errors import BadInput
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.sheet import ask_again, composed
from tmm_sheets.words import tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.construction.plan import Plan
    from tmm_sheets.project import Project


@dataclass(frozen=True)
class KnownSheet:
    """Sheet ``n`` (from 1) with its elements."""

    n: int
    sheet: Composed = field(repr=False)
    elements: tuple[Element, ...] = field(repr=False)


def known_sheet(project: Project, n: int) -> KnownSheet:
    """Draw sheet ``n``, its elements called by the letters of the steps that left them."""
    sheet = composed(project, n)
    return KnownSheet(n, sheet, elements(sheet))


def plans_of(project: Project, known: KnownSheet) -> dict[str, Plan]:
    """The plans of a project that was asked for all that a sheet shows, by their names."""
    ask_again(project, known.n, known.sheet)
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
