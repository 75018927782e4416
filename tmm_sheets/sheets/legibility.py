"""What a sheet cannot show so large that it can be read: told by ``check`` and ``build``, found without drawing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from types import SimpleNamespace
from typing import TYPE_CHECKING

from tmm_sheets.errors import CannotBuild
from tmm_sheets.sheets import kinetic_frames
from tmm_sheets.sheets.arrangement import arrangement
from tmm_sheets.sheets.composition import LINKS, arranged
from tmm_sheets.sheets.frame import extent, fit_frame
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.arrangement import View

APART = 3.0
"""Length of a group's links, or of the lever, that one force on it needs at least to be told from the next one, mm."""
OF_THEIR_OWN = ("kinematics", "forces")
"""Arrangements that give kinematics and forces a sheet each."""


def crowded(project: Project, sheets: Iterable[int]) -> Iterator[str]:
    """Loaded groups and levers of some sheets (from 1) that come out too small for the forces on them, for the command line."""
    for n in sheets:
        for what, size, count in (found for view in _forces(project, n) for found in _sizes(project, view)):
            if size < APART * count:
                said = tell("sheet {n}: {what} is {size:.0f} mm large and cannot be read (forces on it: {count})").format(
                    n=n, what=what, size=size, count=count)
                yield said if OF_THEIR_OWN[1] in project.sheets else tell('{said}: take a sheet more, sheets = [{names}]').format(
                    said=said, names=", ".join(f'"{name}"' for name in OF_THEIR_OWN))


def _forces(project: Project, n: int) -> tuple[View, ...]:
    """Views of forces in the places that a sheet has for them."""
    try:
        plan = arrangement(project.sheets[n - 1]).fitted(project.parts)
        views = arranged(project, n).views if any(view.draw.startswith("kinetics.") for view in plan.views) else ()
    except CannotBuild:  # the sheet itself tells why
        return ()
    return tuple(view for view in views if view.draw in ("kinetics.group", "kinetics.lever"))


def _sizes(project: Project, view: View) -> Iterator[tuple[str, float, int]]:
    """What a view shows, its size on the sheet, mm, and how many forces it has.

    What is small beside its own forces and their arms, stones in a slot or a lever in a dead position, is so at any scale factor.
    """
    k, kept = project.force_index, SimpleNamespace(scales={}, chosen=set())
    if view.draw == "kinetics.lever":
        shown = kinetic_frames.on_lever(project, k)
        points = extent([complex(step.at(k)) for step in project.study.lever.points.values()])
        name, size, count = tell("the lever"), max(points.width, points.height), len(shown)
        place, plan, around = view.box.inset(*kinetic_frames.LEVER), "lever", kinetic_frames.lever_scheme(project, k, shown)
    elif "places" in view.options:
        g = tuple(reversed(project.mechanism.groups))[int(view.options["group"]) - 1]
        place, plan = view.options["places"][0].inset(*kinetic_frames.SCHEME), f"scheme-{'-'.join(g.links)}"
        name, (size, count) = tell("group {name}").format(name=g.name), kinetic_frames.crowd(project, g, k)
        around = kinetic_frames.scheme(project, g, k, kinetic_frames.share_of_arrows(project, g, k, place))
    else:
        return
    whole = extent([around[0]])
    if size > LINKS * max(whole.width, whole.height):
        yield name, fit_frame(project, kept, plan, "", "", *around, place).scale.mm(size), count
