"""View of the technological loads over one turn of the crank: the law as it is given, with its ordinates at the positions."""

from __future__ import annotations

from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.scale import times
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import fixed
from tmm_sheets.sheets.components import graphs
from tmm_sheets.sheets.frame import PlanFrame, pick
from tmm_sheets.sheets.linkage.link_marks import indexed
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.loads import Applied
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
    turned = _angles(shown, cycle.period)
    kind, unit = ("F", tr("N")) if shown[0].point is not None else ("M", tr("N·m"))
    inside = box.inset(10.0, 8.0, 14.0, 24.0)
    top = max(0.0, *(float(np.max(f.shown(turned))) for f in shown))
    low = min(0.0, *(float(np.min(f.shown(turned))) for f in shown))
    scale = pick(project, canvas, "loads", f"μ_{kind}", tr("{unit}/mm").format(unit=unit), (top - low) / inside.height)
    angle, start = graphs.angle_axis(project, box)
    length = angle.mm(cycle.period)
    title = tr("Technological load (taken)") if _accepted(project, shown) else tr("Technological load")
    canvas.title(box, title, f"{scale}, {angle}")
    at = PlanFrame(scale, complex(start, inside.y0 - low / scale.mu), angle)
    if (said := _many_strokes(project, shown)) is not None:
        canvas.text(complex(box.centre.real, inside.y1 + 1.0), said, size_for([said], box.width, 3.5), "centre")
    frame, o = canvas.placed("loads", "", at.origin, at.mu), at.origin
    with canvas.traced("axis", f"loads/{shown[0].name}", "", frame):
        canvas.arrow(o + 1j * low / scale.mu, o + 1j * (top / scale.mu + 8.0), "axis", 3.0)
        canvas.arrow(o, o + length + 10.0, "axis", 3.0)
        canvas.label(o + 1j * (top / scale.mu + 6.0), f"{', '.join(indexed(f.name) for f in shown)}, {unit}", 1 + 0j, 3.5, 1.5)
        graphs.turned_angle(canvas, o + length + 10.0)
    _positions(project, canvas, shown, at, frame)
    for f in shown:
        with canvas.traced("curve", f"loads/{f.name}", "", frame):
            canvas.polyline(at(turned + 1j * f.shown(turned)), "curve")
            if len(shown) > 1:
                _sign(canvas, f, turned, at)


def _angles(shown: list[Applied], period: float) -> Any:
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


def _sign(canvas: Canvas, f: Applied, turned: Any, at: PlanFrame) -> None:
    """Sign of one of several loads over the middle of where it is at least half its greatest."""
    acting = turned[f.magnitude(turned) >= 0.5 * f.magnitude(turned).max()]
    middle = float(acting[len(acting) // 2]) if len(acting) else pi
    canvas.label(complex(at(complex(middle, np.ravel(f.shown(middle))[0]))), indexed(f.name), 1j, 3.5, 1.5)


def _size(of: tuple[float, str]) -> tuple[float, str]:
    """By magnitude, then by name."""
    return abs(of[0]), of[1]


def _positions(project: Project, canvas: Canvas, shown: list[Applied], at: PlanFrame, frame: int) -> None:
    """Numbers of the positions under the axis, and ordinates of the largest load over those inside the turn."""
    cycle = project.cycle
    pitch = abs(complex(at(cycle.period) - at(0.0))) / len(cycle.labels)
    for k, (number, angle) in enumerate(zip(cycle.ends, (*cycle.turned, cycle.period), strict=False)):
        label = cycle.labels[k % len(cycle.labels)]
        value, largest = max(((float(np.ravel(f.shown(angle, side))[0]), f.name) for f in shown for side in (-1, 1)), key=_size)
        foot = complex(at(angle))
        with canvas.traced("curve", f"loads/{largest}", label, frame):
            if value and 0 < angle < cycle.period:
                canvas.line(foot, complex(at(angle + 1j * value)), "thin")
        with canvas.traced("axis", f"loads/{largest}", label, frame):
            canvas.line(foot - 1j, foot, "thin")
            canvas.number(foot, foot - letter(number, 2.5).width / 2 - 5.0j, number, 2.5, pitch, first=angle == 0)
