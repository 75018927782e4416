"""What a sheet cannot show so large that it can be read: told by ``check`` and ``build``, found without drawing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from tmm_sheets.errors import CannotBuild
from tmm_sheets.remarks import Remark
from tmm_sheets.sheets.composition import arranged, placed_where
from tmm_sheets.sheets.floors import CRANK, VECTOR, Floor
from tmm_sheets.sheets.frame import extent, fit_frame
from tmm_sheets.sheets.linkage import kinematic_frames, kinetic_frames
from tmm_sheets.sheets.linkage.linkage_sizes import LINKS
from tmm_sheets.sheets.views import function
from tmm_sheets.words import marked

if TYPE_CHECKING:
    from tmm_sheets.box import Box
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.arrangement import ViewPlace

APART = 3.0
"""Length of a group's links, or of the lever, that one force on it needs at least to be told from the next one, mm."""
OF_THEIR_OWN = ("kinematics", "forces")
"""Arrangements that give kinematics and forces a sheet each."""


def crowded(project: Project, sheets: Iterable[int]) -> Iterator[Remark]:
    """What of some sheets (from 1) comes out too small for what stands on it, for the command line."""
    for n in sheets:
        try:
            views = placed_where(project, n, lambda kind: kind.read)
        except CannotBuild:  # the sheet itself tells why
            continue
        for view in views:
            yield from function(view.kind.read)(project, n, view)


def positions(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The crank is too small beside the other links."""
    try:
        scale = kinematic_frames.positions(project, SimpleNamespace(scales={}, chosen=set()), view.box, view.options).scale
    except CannotBuild:
        return
    yield from _below(project, n, CRANK, scale.mm(2 * project.mechanism.crank.length),
                      marked("leave out points far from the crank"))


def velocities(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The velocity plans are too small, and the analysed one is not shown once more, enlarged."""
    if any(offer.draw == "kinematics.enlarged_velocities" for offer in arranged(project, n).offers):
        return
    try:
        layout = kinematic_frames.velocities(project, SimpleNamespace(scales={}, chosen=set()), view.box, view.options)
    except CannotBuild:
        return
    longest = kinematic_frames.longest(project.study.velocities.plan, [i for i, _ in layout.shown])
    yield from _below(project, n, VECTOR, layout.scale.mm(longest), marked("number fewer positions"))


def accelerations(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The acceleration plan is too small, or more of its letters than can be read stand together."""
    try:
        scale = kinematic_frames.accelerations(project, SimpleNamespace(scales={}, chosen=set()), view.box).scale
    except CannotBuild:
        return
    longest = kinematic_frames.longest(project.study.accelerations.plan, [project.force_index])
    yield from _below(project, n, VECTOR, scale.mm(longest), marked("take another force_position"))
    letters = kinematic_frames.crowd(project.study.accelerations.plan, project.force_index, scale.mu)
    if letters > kinematic_frames.TOGETHER_READ:
        yield Remark(marked("sheet {n}: the acceleration plan cannot be read, {count} of its letters stand within "
                            "{about:.0f} mm of one of them: take another force_position"),
                     {"n": n, "count": letters, "about": kinematic_frames.ABOUT})


def _below(project: Project, n: int, floor: Floor, size: float, hint: str) -> Iterator[Remark]:
    """What no place of a sheet shows at its floor, and what to try."""
    if size >= floor.least * (1 - 1e-6):
        return
    said = Remark(marked("sheet {n}: {what} is {size:.0f} mm large, it is read from {least:.0f} mm on: {hint}"),
                  {"n": n, "what": Remark(floor.what), "size": size, "least": floor.least, "hint": Remark(hint)})
    yield said if OF_THEIR_OWN[0] in project.sheets else Remark(
        marked("{said}, or take a sheet more, sheets = [{names}]"),
        {"said": said, "names": ", ".join(f'"{name}"' for name in OF_THEIR_OWN)})


def lever(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The lever is too small for its forces."""
    k = project.force_index
    shown = kinetic_frames.on_lever(project, k)
    points = extent([complex(step.at(k)) for step in project.study.lever.points.values()])
    yield from _crowded(project, n, Remark(marked("the lever")), max(points.width, points.height), len(shown), "lever",
                        kinetic_frames.lever_scheme(project, k, shown), view.box.inset(*kinetic_frames.LEVER))


def group(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """A loaded group is too small for its forces."""
    if "places" not in view.options:
        return  # of no force, or in the box as it is written
    k, g = project.force_index, tuple(reversed(project.mechanism.groups))[int(view.options["group"]) - 1]
    place = view.options["places"][0].inset(*kinetic_frames.SCHEME)
    yield from _crowded(project, n, Remark(marked("group {name}"), {"name": g.name}), *kinetic_frames.crowd(project, g, k),
                        f"scheme-{'-'.join(g.links)}",
                        kinetic_frames.scheme(project, g, k, kinetic_frames.share_of_arrows(project, g, k, place)), place)


def _crowded(project: Project, n: int, what: Remark, size: float, count: int, plan: str,
             around: tuple[Any, Any], place: Box) -> Iterator[Remark]:
    """What ``around`` shows in a place has so many forces on a figure of such a size, m, that they cannot be told apart.

    What is small beside its own forces and their arms, blocks in a slot or a lever in a dead position, is so at any scale factor.
    """
    whole = extent([around[0]])
    if size <= LINKS * max(whole.width, whole.height):
        return
    large = fit_frame(project, SimpleNamespace(scales={}, chosen=set()), plan, "", "", *around, place).scale.mm(size)
    if large < APART * count:
        said = Remark(marked("sheet {n}: {what} is {size:.0f} mm large and cannot be read (forces on it: {count})"),
                      {"n": n, "what": what, "size": large, "count": count})
        yield said if OF_THEIR_OWN[1] in project.sheets else Remark(
            marked("{said}: take a sheet more, sheets = [{names}]"),
            {"said": said, "names": ", ".join(f'"{name}"' for name in OF_THEIR_OWN)})
