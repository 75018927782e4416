"""The path of a slider enlarged, with the numbers of its positions, where these crowd on the position plans."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.sheets.frame import PlanFrame
from tmm_sheets.sheets.linkage import kinematics, link_marks
from tmm_sheets.sheets.player import stage
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

VIEW = "kinematics.position_plans"
TOGETHER = 4
"""So many marks that have no number of their own on the plans are a crowd."""
TIMES = (100.0, 50.0, 40.0, 20.0, 10.0, 5.0, 4.0, 2.5, 2.0)
"""Enlargements (GOST 2.302), the most welcome first."""
SHORTEST, LONGEST = 60.0, 260.0
"""Length of the path in the view, mm, below which its numbers crowd still, and beyond which it takes too much of a sheet."""
BEYOND, BESIDE, HEAD = 10.0, 9.0, 16.0
"""Room beyond the ends of the path, beside it for the numbers, over it for the title, mm."""


def enlarged_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the enlarged path can do with, mm; none where every mark has its number on the plans."""
    name = _crowded(project, canvas)
    if name is None:
        return []
    span, title = _span(project, canvas, name), letter(_title(name), 5.0).width
    return [(max(times * span + 2 * BEYOND, title + 4.0), HEAD + 2 * BESIDE + 2.0) for times in TIMES
            if SHORTEST <= times * span <= LONGEST]


def enlarged(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The marks of the path with all their numbers; on the plans only those at its ends keep theirs."""
    name = _crowded(project, canvas)
    assert name is not None
    pos, plain = project.study.positions, canvas.scales["positions"]
    span = _span(project, canvas, name)
    times = next(t for t in TIMES if t * span <= LONGEST and t * span + 2 * BEYOND <= box.width + 1e-6)
    scale = Scale(plain.symbol, float(f"{plain.mu / times:.6g}"), plain.unit)
    _thin_out(project, canvas, name)
    canvas.title(box, _title(name), str(scale))
    along = _along(project, name)
    z = scale.mm(np.asarray(pos.points[name].value)) / along
    middle = complex(z.real.min() + z.real.max(), z.imag.min() + z.imag.max()) / 2
    at = complex(box.centre.real, box.y0 + BESIDE + 1.0)
    s = stage(canvas, pos.plan, None, PlanFrame(scale, at - middle, turn=-float(np.angle(along))))
    half = float(np.ptp(z.real)) / 2 + BEYOND - 2.0
    s.pen(pos.points[name], "axis").line(at - half, at + half, "centre")
    kinematics.own_path(project, s, name, 1j)


def _title(name: str) -> str:
    return tr("Positions of point {point} on its path").format(point=link_marks.indexed(name))


def _along(project: Project, name: str) -> complex:
    """Unit vector along the path of a slider, to the right or, of an upright one, upwards."""
    pos = project.study.positions
    guide = kinematics.on_fixed_guides(pos.mechanism)[name]
    u = complex(pos.guide_directions[guide].at(0))
    return u if u.real > 1e-9 or (u.real > -1e-9 and u.imag > 0) else -u


def _span(project: Project, canvas: Canvas, name: str) -> float:
    """Length of a path on the plans, mm."""
    z = np.asarray(project.study.positions.points[name].value)
    mu: float = canvas.scales["positions"].mu
    return float(np.abs(z[:, None] - z).max()) / mu


def _crowded(project: Project, canvas: Canvas) -> str | None:
    """The slider, alone on its path, whose marks share most numbers on the plans of this sheet; None where hardly any do."""
    if "positions" not in canvas.scales or VIEW not in {part.draw for part in canvas.parts}:
        return None
    guides, drawn = kinematics.on_fixed_guides(project.mechanism), [i for i, _ in project.cycle.drawn]
    found: dict[str, int] = {}
    for name, guide in guides.items():
        z = np.asarray(project.study.positions.points[name].value) / canvas.scales["positions"].mu
        if list(guides.values()).count(guide) == 1 and z.ndim:
            crowds = (crowd for marks in kinematics.by_stroke(project, name, drawn) for crowd in kinematics.crowds(marks, z))
            found[name] = sum(len(crowd) - 1 for crowd in crowds)
    worst = max(found, key=lambda name: found[name], default=None)
    return worst if worst is not None and found[worst] >= TOGETHER else None


def _thin_out(project: Project, canvas: Canvas, name: str) -> None:
    """Take the numbers off the path on the plans, but for those nearest to its ends."""
    part = next(k for k, part in enumerate(canvas.parts) if part.draw == VIEW and part.title)
    path, numbers = project.study.positions.points[name].path, set(project.cycle.labels)
    asked = [label for label in canvas.labels if label.part == part and label.by is not None and label.by.step == path
             and label.text[0] in {number[0] for number in numbers}]
    along = _along(project, name)
    far = [(label.anchor / along).real for label in asked]
    ends = {asked[int(pick(far))] for pick in (np.argmin, np.argmax)} if asked else set()
    canvas.labels[:] = [label for label in canvas.labels if label not in asked or label in ends]
