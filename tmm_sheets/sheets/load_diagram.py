"""View of the technological loads over one turn of the crank: the law as it is given, with its ordinates at the positions."""

from __future__ import annotations

from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.scale import times
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.frame import pick

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SAMPLES = 361
"""Angles at which the curves are drawn, besides both sides of every jump."""
HAIR = 1e-9
"""How near to a jump the curve is drawn on either side, rad."""


def over_turn(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Magnitudes of the forces or of the moments that are not given as pressures, over the angle of the crank."""
    pressures = {f.name for f in project.variant.force if f.bore is not None}
    shown = [f for f in project.applied if f.name not in pressures]
    if not shown:
        return
    cycle = project.cycle
    jumps = [j + s * HAIR for f in shown for j in f.jumps for s in (-1, 1)]
    turned = np.unique(np.concatenate((np.linspace(0, cycle.period, SAMPLES), jumps)))
    turned = turned[(turned >= 0) & (turned <= cycle.period)]
    unit = "Н" if shown[0].point is not None else "Н·м"
    inside = box.inset(10.0, 8.0, 14.0, 24.0)
    top = max(float(np.max(f.magnitude(turned))) for f in shown)
    scale = pick(project, canvas, "loads", "μ_F" if shown[0].point is not None else "μ_M", f"{unit}/мм", top / inside.height)
    names = {f.name for f in shown}
    accepted = all((*(f.accepted for f in project.variant.force if f.name in names),
                    *(m.accepted for m in project.variant.moment if m.name in names)))
    canvas.title(box, f"Технологическая нагрузка{' (принято)' if accepted else ''}",
                 f"{scale}, μ_φ = {number(cycle.period / inside.width)} рад/мм")
    origin = complex(inside.x0, inside.y0)
    strokes = cycle.strokes
    if strokes is not None and len(strokes.runs) > 2 and any(f.motion is not None and f.point == strokes.output for f in shown):
        a, b = (fixed(degrees(x) % degrees(cycle.period), 1) for x in (strokes.begin, strokes.end))
        said = f"Точка {strokes.output} меняет направление {times(len(strokes.runs))} за оборот; рабочий ход φ = {a}°…{b}°"
        canvas.text(complex(box.centre.real, inside.y1 + 1.0), said, 3.5, "centre")

    def at(angle: Any, value: Any) -> Any:
        return origin + angle / cycle.period * inside.width + 1j * value / scale.mu

    canvas.arrow(origin, origin + 1j * (top / scale.mu + 8.0), "axis", 3.0)
    canvas.arrow(origin, origin + inside.width + 10.0, "axis", 3.0)
    signs = ", ".join(f"{f.name[0]}_{{{f.name[1:]}}}" for f in shown)
    canvas.label(origin + 1j * (top / scale.mu + 6.0), f"{signs}, {unit}", 1 + 0j, 3.5, 1.5)
    canvas.label(origin + inside.width + 8.0, "φ", 1j, 3.5, 1.5)
    for label, angle in (*zip(cycle.labels, cycle.turned, strict=True), (cycle.labels[0], cycle.period)):
        value = max(float(np.ravel(f.magnitude(angle, side))[0]) for f in shown for side in (-1, 1))
        if value > 0 and 0 < angle < cycle.period:
            canvas.line(at(angle, 0), at(angle, value), "thin")
        canvas.line(at(angle, 0) - 1j, at(angle, 0), "thin")
        canvas.text(at(angle, 0) - 5.0j, label, 2.5, "centre")
    for f in shown:
        values = f.magnitude(turned)
        canvas.polyline(at(turned, values), "curve")
        if len(shown) > 1:
            acting = turned[values >= 0.5 * values.max()]
            middle = float(acting[len(acting) // 2]) if len(acting) else pi
            canvas.label(at(middle, float(np.ravel(f.magnitude(middle))[0])), f"{f.name[0]}_{{{f.name[1:]}}}", 1j, 3.5, 1.5)
