"""What the views of friction need of their places."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import inf
from typing import TYPE_CHECKING

from tmm_sheets.sheets.border_solver import Need
from tmm_sheets.sheets.components import cycle_graphs
from tmm_sheets.sheets.linkage import friction
from tmm_sheets.sheets.view_sizes import leaf, reaching, rows

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.remarks import Remark
    from tmm_sheets.sheets.arrangement import ViewPlace
    from tmm_sheets.sheets.border_solver import BorderNode


def mechanism(project: Project, view: ViewPlace) -> BorderNode:
    """The mechanism with the forces of friction."""
    return leaf(view.box, reaching(view.box, *friction.scheme(project), friction.AROUND, (150.0, 90.0)))


def pairs(project: Project, view: ViewPlace) -> BorderNode:
    """A picture of each pair with friction."""
    @cache
    def in_place(width: int, height: int) -> float:
        return friction.pairs_area(project, width, height)

    return leaf(view.box, Need(least=(200.0, 120.0), drawn=lambda w, h: in_place(int(w), int(h))), 1.5)


def power(project: Project, view: ViewPlace) -> BorderNode:
    """The power lost over the turn."""
    return leaf(view.box, cycle_graphs.need(project, [friction.power_graph(project)]), 0.5)


def power_low(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The graph of that power on sheet ``n``, where it is too low."""
    return cycle_graphs.low(project, n, view, lambda project, _: [friction.power_graph(project)])


def table(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each pair."""
    found = project.study.forces.friction
    return rows(project, view, len(found.pairs) + 1 if found else 1, 34.0, (5.0, friction.ROWS[0]), (0.7 * view.box.width, inf))


def positions(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each position."""
    return rows(project, view, len(project.cycle.labels) + 1, 12.0, (4.6, friction.ROWS[1]), (0.7 * view.box.width, inf))
