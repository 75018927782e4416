"""What a sheet cannot show so large that it can be read: told by ``check`` and ``build``, found without drawing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from types import SimpleNamespace
from typing import TYPE_CHECKING

from tmm_sheets.errors import CannotBuild
from tmm_sheets.remarks import Remark
from tmm_sheets.sheets import kinematic_frames, kinetic_frames
from tmm_sheets.sheets.arrangement import arrangement
from tmm_sheets.sheets.composition import LINKS, arranged
from tmm_sheets.sheets.frame import extent, fit_frame
from tmm_sheets.words import marked

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.arrangement import ViewPlace

APART = 3.0
"""Length of a group's links, or of the lever, that one force on it needs at least to be told from the next one, mm."""
OF_THEIR_OWN = ("kinematics", "forces")
"""Arrangements that give kinematics and forces a sheet each."""


def crowded(project: Project, sheets: Iterable[int]) -> Iterator[Remark]:
    """Loaded groups and levers of some sheets (from 1) that come out too small for the forces on them, for the command line.

    And plans of accelerations on which more letters stand together than can be read.
    """
    for n in sheets:
        views = _placed(project, n)
        for what, size, count in (found for view in views for found in _sizes(project, view)):
            if size < APART * count:
                said = Remark(marked("sheet {n}: {what} is {size:.0f} mm large and cannot be read (forces on it: {count})"),
                              {"n": n, "what": what, "size": size, "count": count})
                yield said if OF_THEIR_OWN[1] in project.sheets else Remark(
                    marked("{said}: take a sheet more, sheets = [{names}]"),
                    {"said": said, "names": ", ".join(f'"{name}"' for name in OF_THEIR_OWN)})
        for letters in (_letters(project, view) for view in views if view.draw == "kinematics.acceleration_plan"):
            if letters > kinematic_frames.TOGETHER_READ:
                yield Remark(marked("sheet {n}: the acceleration plan cannot be read, {count} of its letters stand within "
                                    "{about:.0f} mm of one of them: take another force_position"),
                             {"n": n, "count": letters, "about": kinematic_frames.ABOUT})


def _placed(project: Project, n: int) -> tuple[ViewPlace, ...]:
    """Views of a sheet in their places, where views are among them that may crowd."""
    try:
        plan = arrangement(project.sheets[n - 1]).fitted(project.parts)
        asked = any(view.draw.startswith("kinetics.") or view.draw == "kinematics.acceleration_plan" for view in plan.views)
        return arranged(project, n).views if asked else ()
    except CannotBuild:  # the sheet itself tells why
        return ()


def _letters(project: Project, view: ViewPlace) -> int:
    """How many letters of the acceleration plan stand together."""
    try:
        scale = kinematic_frames.accelerations(project, SimpleNamespace(scales={}, chosen=set()), view.box).scale
    except CannotBuild:
        return 0
    return kinematic_frames.crowd(project.study.accelerations.plan, project.force_index, scale.mu)


def _sizes(project: Project, view: ViewPlace) -> Iterator[tuple[Remark, float, int]]:
    """What a view shows, its size on the sheet, mm, and how many forces it has.

    What is small beside its own forces and their arms, blocks in a slot or a lever in a dead position, is so at any scale factor.
    """
    k, kept = project.force_index, SimpleNamespace(scales={}, chosen=set())
    if view.draw == "kinetics.lever":
        shown = kinetic_frames.on_lever(project, k)
        points = extent([complex(step.at(k)) for step in project.study.lever.points.values()])
        name, size, count = Remark(marked("the lever")), max(points.width, points.height), len(shown)
        place, plan, around = view.box.inset(*kinetic_frames.LEVER), "lever", kinetic_frames.lever_scheme(project, k, shown)
    elif view.draw == "kinetics.group" and "places" in view.options:
        g = tuple(reversed(project.mechanism.groups))[int(view.options["group"]) - 1]
        place, plan = view.options["places"][0].inset(*kinetic_frames.SCHEME), f"scheme-{'-'.join(g.links)}"
        name, (size, count) = Remark(marked("group {name}"), {"name": g.name}), kinetic_frames.crowd(project, g, k)
        around = kinetic_frames.scheme(project, g, k, kinetic_frames.share_of_arrows(project, g, k, place))
    else:
        return  # of no force, or in the box as it is written
    whole = extent([around[0]])
    if size > LINKS * max(whole.width, whole.height):
        yield name, fit_frame(project, kept, plan, "", "", *around, place).scale.mm(size), count
