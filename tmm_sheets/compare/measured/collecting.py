"""Everything that can be measured on the sheets of a project."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from tmm_sheets.compare.measured import diagram_items, flywheel_items, linkage_items, machine_items
from tmm_sheets.compare.measured.measurable import Measurables
from tmm_sheets.errors import CannotBuild

if TYPE_CHECKING:
    from tmm_sheets.project import Project


def measurables(project: Project, say: Callable[[str], None]) -> Measurables:
    """Everything on the sheets of a project that can be measured, and its results.

    The sheets are drawn for it: they decide on the scale factors and on the positions that are shown.
    """
    from tmm_sheets.sheets import sheet
    from tmm_sheets.sheets.linkage import kinematics

    found = Measurables()
    shown: set[str] = set()
    attempt = sheet.every(project, say, steps=True)
    problem = attempt.problem()
    if problem is not None:
        found.notes.append(str(problem))
    for composed in attempt.drawn.values():
        for key, scale in composed.scales.items():
            found.scales.setdefault(key, scale)
        shown |= {str(mark.of) for mark in composed.drawing.marks}
        if "velocities" in composed.scales:  # what has a factor of its own is not asked for: errors are reckoned with one
            own = kinematics.factors_of(composed.frames, project.study.velocities.plan).items()
            shown -= {f"velocity plan {project.cycle.labels[i]}" for i, mu in own if mu != composed.scales["velocities"].mu}
    there = project.parts
    if "positions" in there:
        linkage_items.collect(project, found, shown)
        diagram_items.collect(project, found)
    for part, collect in (("flywheel", flywheel_items.collect), ("gear", machine_items.gear), ("reducer", machine_items.reducer),
                          ("train", machine_items.train), ("cam", machine_items.cam)):
        if part in there:
            with suppress(CannotBuild):  # its sheet has said why
                collect(project, found)
    machine_items.others(project, found)
    titles = list(dict.fromkeys(e.title for e in found.entries.values()))
    found.entries = dict(sorted(found.entries.items(), key=lambda pair: titles.index(pair[1].title)))
    return found
