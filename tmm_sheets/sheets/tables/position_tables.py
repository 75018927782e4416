"""Tables over all positions for room that a sheet has left: accelerations of points and links, reactions in the pairs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import is_zero
from tmm_sheets.sheets.components import graphs, upright_tables
from tmm_sheets.sheets.linkage.link_marks import indexed, tell_signs
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

MOST = 14
"""Most columns that can be read at a glance."""

Columns = list[tuple[str, Any]]


def accelerations_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the table of accelerations can do with, mm."""
    return _sizes(project, *_accelerations(project))


def accelerations(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Accelerations of the moving points, m/s^2, and angular ones of the links, s^-2, at all positions."""
    title, columns = _accelerations(project)
    _table(project, canvas, box, title, columns)
    if any(name.startswith("ε") for name, _ in columns):
        tell_signs(project, canvas, box)


def reactions_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the table of reactions can do with, mm."""
    return _sizes(project, *_reactions(project))


def reactions(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Magnitudes of the reactions in all pairs, N, at all positions."""
    _table(project, canvas, box, *_reactions(project))


def _accelerations(project: Project) -> tuple[str, Columns]:
    acc = project.study.accelerations
    sizes = [(f"a_{{{name}}}", np.abs(step.value)) for name, step in acc.points.items() if np.ndim(step.value)]
    found: Columns = [(name, v) for name, v in sizes if not np.allclose(v, v[0])]  # that of the crank pin is the same everywhere
    # That of the crank stands in the table of its running, there positive in its sense.
    crank, speed = project.mechanism.crank.link, project.mechanism.crank.speed
    turning = [(f"ε_{link}", np.real(step.value)) for link, step in acc.epsilon.items() if np.ndim(step.value) and link != crank]
    size = max((float(np.nanmax(np.abs(v))) for _, v in turning), default=0.0) + speed**2  # where none but rounding turns them
    found += [(name, v) for name, v in turning if not is_zero(np.abs(v).max(), size)]
    return tr("Accelerations of the points, m/s², and of the links, s^{−2}"), found


def _reactions(project: Project) -> tuple[str, Columns]:
    pairs: dict[frozenset[str], tuple[str, Any]] = {}
    for name, step in project.study.forces.reactions.items():
        # A pair has one reaction and its opposite: the first that the force analysis finds stands for both.
        links = frozenset(name[1:].split(",") if "," in name else name[1:])
        pairs.setdefault(links, (indexed(name), np.abs(step.value)))
    return tr("Reactions in the pairs, N"), [pair for pair in pairs.values() if np.ndim(pair[1])]


def _cells(project: Project, columns: Columns, digits: int) -> list[list[str]]:
    numbers = [graphs.column(values, digits) for _, values in columns]
    return [[tr("No."), *(name for name, _ in columns)],
            *([label, *(column[i] for column in numbers)] for i, label in project.cycle.drawn)]


def _sizes(project: Project, title: str, columns: Columns) -> list[tuple[float, float]]:
    if not 0 < len(columns) <= MOST or not all(np.isfinite(values).all() for _, values in columns):
        return []
    return upright_tables.sizes(title, _cells(project, columns, 4))


def _table(project: Project, canvas: Canvas, box: Box, title: str, columns: Columns) -> None:
    upright_tables.draw(canvas, box, title, _cells(project, columns, 4))
