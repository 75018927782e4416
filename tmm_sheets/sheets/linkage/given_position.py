"""View of the given position: speeds and accelerations of its points and links, inertia loads, technological loads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import size_in, widened
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import number, size
from tmm_sheets.sheets.linkage.link_marks import indexed, tell_signs
from tmm_sheets.words import tell, tr, tr_in

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Step
    from tmm_sheets.project import Project

ROW = 7.0
"""Highest row of the tables, mm."""


def values(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Tables of the values at the given position (manual 003, section 4, works 3-6)."""
    label = project.cycle.labels[project.force_index]
    tables = [
        (tr("Velocities and accelerations (position {label})").format(label=label), _points(project)),
        (tr("Links: angular quantities and inertia loads"), _links(project)),
    ]
    loads = _loads(project)
    if len(loads) > 1:
        tables.append((tr("Technological loads"), loads))
    title = 8.0
    row = min((box.height - title * len(tables)) / sum(len(rows) for _, rows in tables), ROW)
    if row < 4.0:
        raise CannotBuild(tell("the tables of the given position need more room: {row:.1f} mm for a row").format(row=row),
                          tell("make the place of given_position.values higher in templates/sheets"))
    height = size_in(row)
    tell_signs(project, canvas, box)
    y = box.y1
    for text, rows in tables:
        canvas.text(complex(box.centre.real, y - 5.5), text, 3.5, "centre")
        columns = len(rows[0])
        first = 0.12 if columns > 3 else 0.3
        widths = [first] + [(1 - first) / (columns - 1)] * (columns - 1)
        widths = widened([w * box.width for w in widths], rows, height)
        drawn = canvas.table(complex(box.x0, y - title), widths, rows, row, height)
        y = drawn.y0


def values_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the tables can do with, mm."""
    tables = [_points(project), _links(project), *(loads for loads in [_loads(project)] if len(loads) > 1)]
    rows = sum(map(len, tables))
    return [(width, 8.0 * len(tables) + row * rows) for width, row in ((176.0, 7.0), (160.0, 6.4), (150.0, 5.6), (140.0, 4.6))]


def _points(project: Project) -> list[list[str]]:
    """Moving points side by side: name, speed, acceleration."""
    study, m, k = project.study, project.mechanism, project.force_index
    names = [name for name in study.positions.points if name not in m.fixed and name in study.velocities.points]
    speed, acceleration = study.velocities.points, study.accelerations.points
    of_speed, of_acceleration = (size((step.value for step in of.values()), k) for of in (speed, acceleration))
    cells = [[indexed(name), _size(speed[name], k, of_speed), _size(acceleration[name], k, of_acceleration)] for name in names]
    half = (len(cells) + 1) // 2
    head = [tr("Point"), tr("V, m/s"), tr("a, m/s²")]
    return [head * 2, *([*left, *right] for left, right in zip(cells[:half], [*cells[half:], ["", "", ""]], strict=False))]


def _links(project: Project) -> list[list[str]]:
    """Angular velocity, angular acceleration, force and couple of inertia of each link."""
    study, m, k = project.study, project.mechanism, project.force_index
    loads, couples, _ = study.loads
    omega, epsilon, forces = study.velocities.omega, study.accelerations.epsilon, study.forces
    of_omega, of_epsilon = (size((step.value for step in of.values()), k) for of in (omega, epsilon))
    of_epsilon = max(of_epsilon, of_omega**2)  # where no link speeds up, what is left is the rounding of normal accelerations
    rows = [[tr("Link"), tr("ω, s^{−1}"), "ε, " + tr("s^{−2}"), tr("F_i, N"), tr("M_i, N·m")]]
    for name, link in m.links.items():
        inertia = next((load.vector for load in loads.get(name, ()) if load.role == "inertia"), None)
        couple = next((c for c in couples.get(name, ()) if link.inertia), None)
        sense = m.shown_sense(name)
        rows.append([name, _signed(omega.get(name), k, of_omega, sense), _signed(epsilon.get(name), k, of_epsilon, sense),
                     _size(inertia, k, forces.force_size(k)), _size(couple, k, forces.moment_size(k))])
    return rows


def _loads(project: Project) -> list[list[str]]:
    """Technological forces and moments with what is our own assumption among them."""
    turned = project.cycle.turned[project.force_index]
    written: dict[str, Any] = {load.name: load for load in project.variant.force}
    written |= {load.name: load for load in project.variant.moment}
    rows = [[tr("Load"), tr("Magnitude"), tr("Data")]]
    for load in project.applied:
        unit = tr("N") if load.point is not None else tr("N·m")
        data = tr_in("load", "taken") if written[load.name].accepted else tr_in("load", "given")
        value = float(np.ravel(load.magnitude(turned))[0])
        rows.append([indexed(load.name), f"{number(value)} {unit}", data])
    return rows


def _size(step: Step | None, k: int, kind: float) -> str:
    return "−" if step is None else number(float(abs(step.at(k))), kind=kind)


def _signed(step: Step | None, k: int, kind: float, sense: float) -> str:
    """A number with its sign."""
    return "−" if step is None else number(sense * float(np.real(step.at(k))), kind=kind)
