"""Hodograph of the reaction in the bearing of the crank over the cycle: a view for room that a sheet has left."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.numbers import is_zero
from tmm_sheets.sheets.components import graphs
from tmm_sheets.sheets.frame import PlanFrame, extent
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Step
    from tmm_sheets.project import Project

AROUND = 12.0, 10.0, 12.0, 26.0
"""Room round the curve for numbers at the left, below, right and above (title and scale factor), mm."""
SIZES = 120.0, 100.0, 80.0, 60.0
"""Lengths of the longer side of the curve that are tried, mm."""


def bearing_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the hodograph can do with, mm; none where there is no force, or where it has no end."""
    _, _, course = _reaction(project)
    if not np.isfinite(course).all() or is_zero(float(np.abs(course).max()), project.study.forces.force_size(project.force_index)):
        return []
    real = extent([course, np.zeros(1)])
    left, below, right, above = AROUND
    longest = max(real.width, real.height)
    return [(max(size * real.width / longest + left + right, 80.0), size * real.height / longest + below + above) for size in SIZES]


def bearing(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Ends of the vectors of the reaction on the crank, laid off from one pole, at the positions and between them."""
    name, step, course = _reaction(project)
    at = np.broadcast_to(step.value, (len(project.cycle.labels),))
    real, inside = extent([course, np.zeros(1)]), box.inset(*AROUND)
    scale = Scale("μ_F", handy(max(real.width / inside.width, real.height / inside.height)), tr("N/mm"))
    canvas.of = "hodograph"
    canvas.title(box, tr("Hodograph of the reaction F_{{{index}}}").format(index=name[1:]), str(scale))
    frame = PlanFrame(scale, inside.centre - scale.mm(real.centre))
    placed = canvas.placed(step.plan, "", frame.origin, frame.mu)
    # Round a turn it is closed: a load that jumps where the cycle begins anew is drawn like one that jumps within.
    drawn, ends = frame(course if project.cycle.swings else np.append(course, course[:1])), frame(at)
    # In the plan itself the vectors stand elsewhere: here they begin at one point.
    with canvas.traced("curve", step.path, "", placed, name):
        canvas.polyline(drawn, "curve")
    with canvas.traced("axis", step.path, "", placed, name):
        for a, b in ((real.x0 + 0j, real.x1 + 0j), (1j * real.y0, 1j * real.y1)):
            u = (b - a) / abs(b - a) if b != a else 0j
            canvas.line(complex(frame(a)) - 5.0 * u, complex(frame(b)) + 5.0 * u, "centre")
    pole, middle = complex(frame(0j)), complex(np.mean(drawn))
    canvas.dot(pole, 0.8)
    _numbers(project, canvas, ends, middle, (step, placed, name))
    here = project.cycle.labels[project.force_index]
    with canvas.traced("vector", step.path, here, placed, name):
        tip = complex(ends[project.force_index])
        if abs(tip - pole) > 6.0:
            canvas.arrow(pole, tip, "vector")
            canvas.label(pole + 0.6 * (tip - pole), f"F̅_{{{name[1:]}}}", 1j * (tip - pole), 3.5, 1.0)


def _numbers(project: Project, canvas: Canvas, ends: Points, middle: complex, traced: tuple[Step, int, str]) -> None:
    """Dots at the positions with their numbers, those of one place together: in each turn the force is another one."""
    step, placed, name = traced
    there: dict[complex, list[int]] = {}
    for n, z in enumerate(map(complex, ends)):
        same = next((other for other in there if abs(other - z) < 1.0), z)
        there.setdefault(same, []).append(n)
    labels = project.cycle.labels
    for z, numbers in there.items():
        with canvas.traced("point", step.path, labels[numbers[0]], placed, name):
            canvas.dot(z, 0.5)
            canvas.label(z, graphs.in_ranges(labels, numbers), z - middle, 2.5, 0.9)


def _reaction(project: Project) -> tuple[str, Step, Points]:
    """Name of the reaction of the frame on the crank, its step at the positions, and its values over the cycle, N."""
    m = project.mechanism
    name = f"F{pair_index(m.crank.link, m.frame)}"
    course = project.course.forces.reactions[name]
    return name, project.study.forces.reactions[name], np.broadcast_to(course.value, np.shape(project.course.turned))
