"""A group of class III in one position: false positions, the locus that the third leg cuts, Assur's special point."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tmm_sheets.construction.step import Step
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.sheets.frame import fit_frame
from tmm_sheets.sheets.linkage import link_marks
from tmm_sheets.sheets.player import PlayerStage, play, stage
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.mechanism.groups.contexts import SpecialPoint
    from tmm_sheets.mechanism.groups.triad import TriadGroup
    from tmm_sheets.methods.linkage.positions import Positions
    from tmm_sheets.project import Project

AROUND = (6.0, 10.0, 6.0, 24.0)
"""Room round the group at its left, below, right and above (title and scale factor), mm."""
NEAR = 1.6
"""A special point so many sizes of the group away from its middle is not drawn, but told."""


def triads(project: Project) -> list[TriadGroup]:
    """Groups of class III, in order of attachment."""
    return [cast("TriadGroup", g) for g in project.mechanism.groups if g.kind.grade == 3]


def group(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """False positions of a group of class III at the position of the force analysis; ``group`` counts those of class III from 1."""
    found = triads(project)
    nth = int(options.get("group", 1))
    if nth > len(found):
        return
    g, pos, k = found[nth - 1], project.study.positions, project.force_index
    special = pos.special[g.kind.about(g)]
    frame = fit_frame(project, canvas, f"false-positions-{g.name}", "μ_l", tr("m/mm"), *reach(project, g), box.inset(*AROUND))
    canvas.title(box, tr("False positions of group {name} (position {label})").format(
        name=g.name, label=project.cycle.labels[k]), str(frame.scale))
    s = stage(canvas, pos.plan, k, frame)
    there = [steps for steps in g.false_points(pos.false[g.name]) if not any(np.isnan(step.at(k)) for step in steps)]
    false = stage(canvas, pos.false[g.name], k, frame)
    play(false, cut=2.0)
    for n, steps in enumerate(there, 1):
        false.dot(steps[2], 0.5, "thin")
        for step in (steps[0], steps[2]):  # where leg 1 is put, and the point of the locus that follows
            false.letters(step, str(n), false.at(step) - s.at(special.step), 2.5, 0.8)
    third = g.legs[2]
    play(s, [pos.points[third.corner]], "thin", cut=16.0)
    _locus(false, there, pos.points[third.corner])
    link_marks.draw_guides(s, pos, g.links)
    link_marks.draw(s, pos, "main", g.links)
    if np.abs(special.step.at(k) - _middle(pos, g, k)) < NEAR * _size(pos, g, k):
        _normals(s, pos, special)
    else:
        at = s.value(special.step)
        canvas.note(box, tr("{point} lies off the sheet").format(point=link_marks.indexed(special.name)) if np.isfinite(at) else "")
    drawn = [shape for shape in link_marks.shapes(pos) if shape.link in g.links]
    for name in dict.fromkeys(n for shape in drawn for n in (*shape.bar, shape.block or "") if n):
        s.letters(name, link_marks.indexed(name), 1 - 0.5j if name in pos.mechanism.fixed else 0j, gap=symbols.HINGE + 1.2)
    for shape in drawn:
        ends = link_marks.along_bar(s, pos, shape) if shape.bar else (str(shape.block),)
        a, b = s.at(pos.points[ends[0]]), s.at(pos.points[ends[-1]])
        s.letters(pos.directions[shape.link], shape.link, 1j * (b - a) if shape.bar else 1 + 1j, 5.0, 1.4 if shape.bar else 6.0,
                  a + 0.4 * (b - a))


def _locus(s: PlayerStage, there: list[tuple[Step, ...]], found: Step) -> None:
    """Smooth curve through the points of the locus, the true one among them."""
    half = len(there) // 2
    z = [s.at(steps[2]) for steps in there]
    if len(z) != 6:
        return
    nodes = np.array([-3, -2, -1, 0, 1, 2, 3], dtype=float)
    values = np.array([*z[:half], s.at(found), *z[half:]])
    t = np.linspace(-3, 3, 97)
    weights = [np.prod([(t - m) / (n - m) for m in nodes if m != n], axis=0) for n in nodes]
    s.curve(there[-1][2], sum(w * v for w, v in zip(weights, values, strict=True)))


def _normals(s: PlayerStage, pos: Positions, special: SpecialPoint) -> None:
    """Normals of two legs produced to the special point."""
    w = special.step
    for leg in special.pair:
        s.line(w, s.at(pos.points[leg.at]), s.at(w), "thin")
    s.dot(w, 0.9, "main")
    s.letters(w, link_marks.indexed(special.name), gap=1.5)


def _points(pos: Positions, g: TriadGroup) -> Iterator[Step]:
    yield from (pos.points[leg.corner] for leg in g.legs)
    yield from (pos.points[name] for name in g.outer)


def _middle(pos: Positions, g: TriadGroup, k: int) -> complex:
    return complex(np.mean([step.at(k) for step in _points(pos, g)]))


def _size(pos: Positions, g: TriadGroup, k: int) -> float:
    z = np.array([step.at(k) for step in _points(pos, g)])
    return float(np.abs(z - z.mean()).max())


def reach(project: Project, g: TriadGroup) -> tuple[Points, Points]:
    """Points of the view, m, and what sticks out of them on paper, mm."""
    pos, k = project.study.positions, project.force_index
    special = pos.special[g.kind.about(g)].step
    z = [complex(step.at(k)) for step in _points(pos, g)]
    if abs(complex(special.at(k)) - _middle(pos, g, k)) < NEAR * _size(pos, g, k):
        z.append(complex(special.at(k)))
    z += [complex(step.at(k)) for steps in g.false_points(pos.false[g.name]) for step in steps if step.rule.gives == "point"]
    around = (10.0, -10.0, 8.0j, -10.0j)
    return np.repeat(z, len(around)), np.tile(around, len(z))
