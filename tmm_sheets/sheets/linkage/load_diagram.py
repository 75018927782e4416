"""View of the technological loads over one turn of the crank: the law as it is given, with its ordinates at the positions."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.scale import times
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import fixed
from tmm_sheets.sheets.components import cycle_graphs
from tmm_sheets.sheets.components.cycle_graphs import Column, Curve, Quantity
from tmm_sheets.sheets.components.graphs import Floats
from tmm_sheets.sheets.linkage.link_marks import indexed
from tmm_sheets.sheets.view_sizes import leaf
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.loads import Applied
    from tmm_sheets.project import Project
    from tmm_sheets.remarks import Remark
    from tmm_sheets.sheets.arrangement import ViewPlace
    from tmm_sheets.sheets.border_solver import BorderNode

SAMPLES = 361
"""Angles at which the curves are drawn, besides both sides of every jump."""
HAIR = 1e-9
"""How near to a jump the curve is drawn on either side, rad."""


def over_turn(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Magnitudes of the forces or of the moments that are not given as pressures, over the angle of the crank."""
    if not (column := load_graph(project)):
        return
    title = tr("Technological load (taken)") if _accepted(project, _shown(project)) else tr("Technological load")
    cycle_graphs.draw(project, canvas, box, title, [column])
    if (said := _many_strokes(project, _shown(project))) is not None:
        canvas.note(box, said)


def place(project: Project, view: ViewPlace) -> BorderNode | None:
    """What the graph needs of its place."""
    column = load_graph(project)
    return leaf(view.box, cycle_graphs.need(project, [column])) if column else None


def low(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The graph on sheet ``n``, where it is too low."""
    return cycle_graphs.low(project, n, view, lambda project, _: [load_graph(project)])


def load_graph(project: Project) -> Column:
    """The graph of these loads; nothing where there are none."""
    shown, cycle = _shown(project), project.cycle
    if not shown:
        return ()
    turned = _angles(shown, cycle.period)
    letter, unit = ("F", tr("N")) if shown[0].point is not None else ("M", tr("N·m"))

    def at(f: Applied) -> Floats:
        """Of both sides of a jump the one with the greater magnitude."""
        sides = np.array([f.shown(cycle.turned, side) for side in (-1, 1)])
        return np.asarray(np.where(np.abs(sides[0]) > np.abs(sides[1]), *sides))

    curves = [Curve(indexed(f.name), f"loads/{f.name}", turned, f.shown(turned), at(f)) for f in shown]
    return (Quantity.of("loads", letter, unit, curves),)


def _shown(project: Project) -> list[Applied]:
    pressures = {f.name for f in project.variant.force if f.bore is not None}
    return [f for f in project.applied if f.name not in pressures]


def _angles(shown: list[Applied], period: float) -> Floats:
    """Angles at which the curves are drawn, both sides of every jump among them."""
    jumps = [j + s * HAIR for f in shown for j in f.jumps for s in (-1, 1)]
    turned = np.unique(np.concatenate((np.linspace(0, period, SAMPLES), jumps)))
    return turned[(turned >= 0) & (turned <= period)]


def _accepted(project: Project, shown: list[Applied]) -> bool:
    """Whether all loads shown were chosen by whoever wrote the project, not given by the task."""
    names = {f.name for f in shown}
    return all((*(f.accepted for f in project.variant.force if f.name in names),
                *(m.accepted for m in project.variant.moment if m.name in names)))


def _many_strokes(project: Project, shown: list[Applied]) -> str | None:
    """What is said of an output that turns back more than twice a turn: which of its strokes is the working one."""
    cycle = project.cycle
    strokes = cycle.strokes
    if strokes is None or len(strokes.runs) <= 2 or not any(f.motion is not None and f.point == strokes.output for f in shown):
        return None
    a, b = (fixed(degrees(x) % degrees(cycle.period), 1) for x in (strokes.begin, strokes.end))
    return tr("Point {point} turns back {times} a turn; working stroke φ = {begin}°…{end}°").format(
        point=strokes.output, times=times(len(strokes.runs)), begin=a, end=b)
