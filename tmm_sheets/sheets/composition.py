"""Places of the views of a project's sheets, and what follows from them without drawing.

The arrangement has the order and the proportions, borders run where the views need them. What a sheet cannot show so large that it
can be read is told by ``check`` and ``build``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import CURVE, MAIN, POLE, TOOTH, Scale
from tmm_sheets.drawing.canvas import ScaleBook
from tmm_sheets.errors import CannotBuild
from tmm_sheets.sheets.border_solver import (
    CRANK,
    GAP,
    LETTERED,
    LINKS,
    VECTOR,
    BorderNode,
    Figure,
    Measured,
    cut,
    fixed,
    joined,
    risen,
    solve,
)
from tmm_sheets.sheets.composed import Answered, stored
from tmm_sheets.sheets.linkage import kinematic_frames, kinetic_frames
from tmm_sheets.sheets.views import Arrangement, ViewKind, ViewPlace, arrangement, function
from tmm_sheets.words import Remark, marked

if TYPE_CHECKING:
    from tmm_sheets.methods.cams.cam_profile import RockerCam, TappetCam
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.project import Project

TITLE_BLOCK = Box(648.0, 8.0, 832.0, 61.0)
"""Place of the title block among the views."""
DESIGNATION = Box(20.0, 573.0, 92.0, 589.0)
"""Place of the turned designation, over the views in the upper left corner (GOST 2.104)."""


def arranged(project: Project, n: int) -> Arrangement:
    """Arrangement of sheet ``n`` (from 1) with every view in the place the sheet has for it: found once, and kept.

    Of several ways to arrange the same views that in which they fill most of what they are meant to have.
    Raises :class:`CannotBuild` where the project has nothing for any of its views.
    """
    if n not in project.arranged:
        project.arranged[n] = _arranged(project, n)
    found: Arrangement = project.arranged[n]
    return found


def _arranged(project: Project, n: int) -> Arrangement:
    plan = _with_all_groups(project, arrangement(project.sheets[n - 1]).fitted(project.parts))
    before = Answered(project, n, "arrangement")
    if (views := before.read(tuple)) is not None:
        return replace(plan, views=views)
    if any(view.needs == "forces" for view in plan.views):
        project.check_forces()
    if any("axis" in view.options for view in plan.views):
        apart: Arrangement = function("enlarged.apart")(project, function("flywheel.apart")(project, plan))
        return apart
    # Whoever sets scale factors by hand has the boxes as they are written; an indicator diagram only makes its mechanism larger.
    as_written = replace(plan, views=tuple(view for view in plan.views if is_meant(project, view)))
    moving = any(view.needs in ("positions", "forces") for view in plan.views)
    too_many = moving and len(project.cycle.drawn) > kinematic_frames.MOST
    if too_many or project.variant.scales.keys() - {"indicator"} or not any(view.kind.place for view in plan.views):
        return as_written
    ways = _arrangements(project, as_written)
    for way in ways[1:]:
        way.means(ways[0])
    found = [solved for way in ways if (solved := way.solved()) is not None]
    if not found:
        return as_written
    taken = min(found, key=lambda solved: round(solved[0], 3))[1]
    taken = replace(taken, views=tuple(replace(view, others={}, known={}) for view in taken.views))
    before.keep(stored(taken.views))
    return taken


def _with_all_groups(project: Project, plan: Arrangement) -> Arrangement:
    """With every group of the mechanism, however many the arrangement is made for: they share the place of those it has."""
    some = [view for view in plan.views if view.kind.every]
    if not some or len(some) == len(project.mechanism.groups):
        return plan
    every = replace(some[0], draw=some[0].kind.every, box=_around([view.box for view in some]), options={}, others={})
    return replace(plan, views=tuple(every if view is some[0] else view for view in plan.views if view not in some[1:]))


def _arrangements(project: Project, plan: Arrangement) -> list[_Way]:
    """All ways to arrange the views of a sheet; what a view needs is asked once for all that have it in one box."""
    known = dict[tuple[int, Box], list[tuple[ViewPlace, BorderNode]]]()
    ways = [*replace(plan, views=tuple(replace(view, known={}) for view in plan.views)).ways()]
    for n, view in ((n, view) for way in ways for n, view in enumerate(way.views)):
        if (n, view.box) not in known:
            known[n, view.box] = _parts(project, view)
    return [_Way(way, [[(part, node.again()) for part, node in known[n, view.box]] for n, view in enumerate(way.views)
                       if known[n, view.box]]) for way in ways]


@dataclass(frozen=True)
class _Way:
    """One way to arrange the views of a sheet: each view, or a part of one, with its node."""

    plan: Arrangement
    parts: list[list[tuple[ViewPlace, BorderNode]]]

    def areas(self) -> dict[tuple[str, Any], float]:
        """Area that each view is meant to have, mm^2."""
        return {_name(view): sum([leaf.area for leaf in node.leaves()]) for parts in self.parts for view, node in parts}

    def means(self, other: _Way) -> None:
        """Take over what another way means each view to have: only so are their costs alike."""
        own, asked = self.areas(), other.areas()
        for view, node in (part for parts in self.parts for part in parts):
            share = asked.get(_name(view), own[_name(view)]) / own[_name(view)]
            for each in node.every() if share != 1.0 else ():
                each.area, each.tried = share * each.area, {}

    def solved(self) -> tuple[float, Arrangement] | None:
        """What its places cost and the arrangement with them; None where the boxes cannot be cut apart or what is fixed moves."""
        columns = [_in_columns(parts) for parts in self.parts]
        boxes = [_around([view.box for view, _ in parts]) for parts in self.parts]
        tree = cut([*boxes, TITLE_BLOCK], [*columns, fixed(TITLE_BLOCK)])
        if tree is None:
            return None
        whole = _around([view.box for view in arrangement(self.plan.name).views])
        room = Box(whole.x0, TITLE_BLOCK.y0, TITLE_BLOCK.x1, whole.y1)
        views = [part for parts in self.parts for part in parts]
        columns_kept = {(view.box.x0, view.box.x1) for view, _ in views if not view.kind.place}
        for view, node in views:
            # A table that asks for a wider column would move what is fixed there, and all borders would stay as written.
            if node.need is not None and (view.box.x0, view.box.x1) in columns_kept:
                node.need, node.tried = replace(node.need, most=(min(node.need.most[0], view.box.width), node.need.most[1])), {}
            if node.need is not None and view.kind.place and _designated(view.box):
                node.need, node.tried = replace(node.need, covered=max(room.y1 - DESIGNATION.y0, 0.0)), {}
        found = dict(zip(map(id, tree.leaves()), solve(tree, room), strict=True))
        # A view that tells no need has to be where its box is, up to rounding: then it stays just there.
        moved = (zip(view.box, found[id(node)], strict=True) for view, node in views if not view.kind.place)
        if any(abs(a - b) > 3.0 for sides in moved for a, b in sides):
            return None
        placed = replace(self.plan, views=tuple([_placed(view, node, found) for view, node in views]))
        return tree.cost(room.width, room.height), placed


def _in_columns(parts: list[tuple[ViewPlace, BorderNode]]) -> BorderNode:
    """The parts of a view one under another, in as many columns as their boxes begin at."""
    columns = [[node for view, node in parts if view.box.x0 == x] for x in dict.fromkeys([view.box.x0 for view, _ in parts])]
    return joined(0, [joined(1, nodes, [1.0] * len(nodes)) for nodes in columns], [1.0] * len(columns))


def _name(view: ViewPlace) -> tuple[str, Any]:
    """What tells a view of a sheet from the others."""
    return view.draw, view.options.get("group")


def _around(boxes: Iterable[Box]) -> Box:
    x0, y0, x1, y1 = zip(*boxes, strict=True)
    return Box(min(x0), min(y0), max(x1), max(y1))


def _designated(box: Box) -> bool:
    """Whether a box reaches up to the turned designation or under it."""
    return box.x0 < DESIGNATION.x1 and box.y1 > DESIGNATION.y0 - GAP


def _placed(view: ViewPlace, node: BorderNode, found: dict[int, Box]) -> ViewPlace:
    """A view in its new place; one of several parts with the places of these as its option ``places``."""
    if not view.kind.place:
        return view
    places = [found[id(leaf)] for leaf in node.leaves()]
    parts = [box._replace(y1=min(box.y1, DESIGNATION.y0)) if _designated(box) else box for box in places]
    return replace(view, box=_around(parts), options={**view.options, "places": parts} if len(parts) > 1 else view.options)


def _parts(project: Project, view: ViewPlace) -> list[tuple[ViewPlace, BorderNode]]:
    """Nodes of a view, which may stand for several one under another; none for one with nothing to draw."""
    if view.kind.parts:
        return [part for one in function(view.kind.parts)(project, view) for part in _parts(project, one)]
    if not view.kind.place:
        return [(view, fixed(view.box))]
    try:
        node = function(view.kind.place)(project, view)
        if node is not None and view.draw in DETAILED and view.options.get("only", "force") == "force":
            node = function("details.with_room")(project, view, node)
    except CannotBuild:
        node = fixed(view.box)  # drawing it will say why
    return [(view, node)] if node is not None else []


DETAILED = ("kinematics.acceleration_plan", "kinetics.crank", "kinetics.group", "kinetics.lever")
"""Views that have room for enlarged details beside their figures."""


def is_meant(project: Project, view: ViewPlace) -> bool:
    """Whether a view is meant for such a cam: one with all traits ``when`` it is, and none ``unless`` which it is.

    Traits: tappet, rocker, flat (kind of follower); roller, plate; force, geometric (closure); spring.
    """
    when, unless = view.options.get("when", ()), view.options.get("unless", ())
    traits = project.cam.traits if when or unless else frozenset()
    return bool(traits.issuperset(when) and traits.isdisjoint(unless))


# --- what follows from the places, without drawing ------------------------------------------------------------------------


def _views(project: Project, n: int) -> tuple[ViewPlace, ...]:
    """Views of sheet ``n`` (from 1) as its arrangement has them."""
    return arrangement(project.sheets[n - 1]).fitted(project.parts).views


def placed_where(project: Project, n: int, asked: Callable[[ViewKind], Any]) -> list[ViewPlace]:
    """Views of sheet ``n`` (from 1) of the kinds ``asked`` for, in their places; a sheet without them is not looked into."""
    if not any(asked(view.kind) for view in _views(project, n)):
        return []
    return [view for view in arranged(project, n).views if asked(view.kind)]


def check(project: Project) -> None:
    """Tell before anything is drawn that a sheet cannot be: :class:`CannotBuild` names what the project lacks for it."""
    for n in range(1, len(project.sheets) + 1):
        for view in _views(project, n):
            if view.kind.after:
                function(view.kind.after)(project)


def left_out(project: Project, sheets: Iterable[int]) -> Iterator[Remark]:
    """What the views of some sheets leave out, and why, for the command line."""
    for n in sheets:
        for view in placed_where(project, n, lambda kind: kind.left_out):
            yield from function(view.kind.left_out)(project, view)


def scales(project: Project, parts: set[str]) -> dict[str, tuple[Scale, int]]:
    """Scale factors of the kinematic plans of a project as its sheets have them, with the sheet's number; draws nothing.

    ``parts`` are the plans asked for: positions, velocities, accelerations.
    """
    found: dict[str, tuple[Scale, int]] = {}
    if len(project.cycle.drawn) > kinematic_frames.MOST:
        return found  # as many plans fit on no sheet
    for n in range(1, len(project.sheets) + 1):
        kept = ScaleBook()
        for view in placed_where(project, n, lambda kind: kind.scale):
            if view.kind.plan in parts:
                function(view.kind.scale)(project, kept, view.box, view.options)
        for scale in kept.scales.values():
            found.setdefault(scale.symbol.replace("μ", "mu"), (scale, n))
    return found


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
            for found in _read(project, n, view):
                if isinstance(found, Remark):
                    yield found
                elif found.size < found.least * (1 - 1e-6):
                    yield _too_small(project, n, view, found)


def _read(project: Project, n: int, view: ViewPlace) -> list[Measured | Remark]:
    """What is measured of a view in its place on a sheet; nothing where it cannot be drawn there, which the sheet itself tells."""
    try:
        return list(function(view.kind.read)(project, n, view))
    except CannotBuild:
        return []


def _too_small(project: Project, n: int, view: ViewPlace, found: Measured) -> Remark:
    """That something is too small on sheet ``n``, and what to try."""
    values = {"n": n, "what": found.what, "size": found.size}
    if found.forces:
        more = marked("{said}: take a sheet more, sheets = [{names}]")
        said = Remark(marked("sheet {n}: {what} is {size:.0f} mm large and cannot be read (forces on it: {count})"),
                      {**values, "count": found.forces})
    else:
        more = marked("{said}, or take a sheet more, sheets = [{names}]")
        said = Remark(marked("sheet {n}: {what} is {size:.3g} mm large, it is read from {least:.0f} mm on: {hint}"),
                      {**values, "least": found.least, "hint": Remark(found.hint)})
    names = _split_in_two(project, n, view, found)
    return said if names is None else Remark(more, {"said": said, "names": names})


def _split_in_two(project: Project, n: int, view: ViewPlace, small: Measured) -> str | None:
    """Sheets of a project, as they stand in its file, with kinematics and forces on two in the place of sheet ``n``.

    None where that does not make it as large as it is read, or would lose what else stands on the sheet.
    """
    shown = {view.needs for view in arranged(project, n).views if view.needs}
    if not shown <= {"positions", "forces"} or set(OF_THEIR_OWN) & set(project.sheets):
        return None
    names = [*project.sheets[:n - 1], *OF_THEIR_OWN, *project.sheets[n:]]
    other = project.on_sheets(names)
    try:
        sizes = [found.size for at in (n, n + 1) for there in arranged(other, at).views
                 if there.draw == view.draw and there.options.get("group") == view.options.get("group")
                 for found in _read(other, at, there) if isinstance(found, Measured) and found.what == small.what]
    except CannotBuild:
        return None
    return ", ".join(f'"{name}"' for name in names) if max(sizes, default=0.0) >= small.least * (1 - 1e-6) else None


def _graph(quantity: str) -> Remark:
    return Remark(marked("the graph of {quantity}"), {"quantity": quantity})


# --- what is measured of each view ----------------------------------------------------------------------------------------


def positions(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """The crank beside the other links."""
    frame = kinematic_frames.positions(project, ScaleBook(), view.box, view.options)
    yield Measured(Remark(CRANK.what), float(frame.scale.mm(2 * project.mechanism.crank.length)), CRANK.least,
                   marked("leave out points far from the crank"))


def velocities(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """The largest velocity plan and the smallest: what is shown once more, enlarged, is but one of them."""
    layout, plan = kinematic_frames.velocities(project, ScaleBook(), view.box, view.options), project.study.velocities.plan
    for floor, size in ((VECTOR, layout.longest(plan)), (LETTERED, min(layout.sizes(plan).values()))):
        yield Measured(Remark(floor.what), size, floor.least, marked("number fewer positions"))


def accelerations(project: Project, n: int, view: ViewPlace) -> Iterator[Measured | Remark]:
    """The acceleration plan, and how many of its letters stand together."""
    plan, k, scale = project.study.accelerations.plan, project.force_index, kinematic_frames.accelerations(
        project, ScaleBook(), view.box).scale
    yield Measured(Remark(VECTOR.what), float(scale.mm(kinematic_frames.longest(plan, [k]))), VECTOR.least,
                   marked("take another force_position"))
    letters = kinematic_frames.crowd(plan, k, scale.mu)
    if letters > kinematic_frames.TOGETHER_READ:
        yield Remark(marked("sheet {n}: the acceleration plan cannot be read, {count} of its letters stand within "
                            "{about:.0f} mm of one of them: take another force_position"),
                     {"n": n, "count": letters, "about": kinematic_frames.ABOUT})


def flywheel(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """Graphs of the flywheel's column, low beside each other; that of dE is shown once more, enlarged."""
    fw: Flywheel = project.flywheel
    shown = {"M": fw.scales.moment.mm(fw.at_samples.moment().value), "A": fw.work_curve(fw.samples),
             "J": fw.scales.inertia.mm(fw.inertia(fw.samples))}
    for quantity, ordinates in shown.items():  # one that is level has no height
        yield Measured(_graph(quantity), risen(ordinates) or CURVE, CURVE, marked("take the other method of [flywheel]"))


def cam_motion(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """Pole distances and graphs of the motion of a cam, to the millimetre."""
    scales, law = project.cam.motion.scales, project.cam.law
    poles = [(Remark(marked("the pole distance {symbol}"), {"symbol": f"H_{k}"}), distance, POLE)
             for k, distance in ((1, scales.h1), (2, scales.h2))]
    for what, size, least in (*poles, (_graph(law.symbol), scales.s.mm(law.stroke), MAIN)):
        yield Measured(what, round(size), least, marked("longer phases of rise and return"))


def zone(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """The curve whose tangents bound the zone of a cam's axis, which has one scale factor with the cam itself."""
    from tmm_sheets.sheets.cams import cam_zone

    cam, rays = project.cam, bool(view.options.get("rays"))
    if cam.law.symbol == "S":
        name, size = "S(S')", cam_zone.stroke_in(cast("TappetCam", cam), rays, view.box.width, view.box.height)
    else:
        rocker = cast("RockerCam", cam)
        name, size = "D(ψ)", float(np.ptp(rocker.zone.curve.value.imag)) / cam_zone.fitted_rocker(rocker, rays, view.box)[0]
    yield Measured(_graph(name), round(size), CURVE, marked("a larger pressure_angle makes the cam smaller"))


def spring(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """The force of a cam's spring and that of inertia."""
    diagram = function("cam.spring_diagram")(project.cam, view.box)
    yield Measured(_graph("F, Q"), round(diagram.high - diagram.low), CURVE, marked("leave out a view of the sheet"))


def teeth(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """The teeth of the mesh."""
    from tmm_sheets.sheets.gears import gear_picture

    size = gear_picture.picture(project.gear, view.box.width, view.box.height)[0].mm(gear_picture.highest_tooth(project.gear))
    yield Measured(Remark(marked("the tooth of the mesh")), round(size), TOOTH, marked("a smaller ratio of the tooth numbers"))


def lever(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """The lever among its forces."""
    place = view.options["places"][0] if "places" in view.options else view.box
    yield from _among_forces(project, Remark(marked("the lever")), kinetic_frames.lever_scheme(project, project.force_index), place)


def group(project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
    """A loaded group among its forces; none that has no force, or stands in the box as it is written."""
    if "places" in view.options:
        k, g = project.force_index, tuple(reversed(project.mechanism.groups))[int(view.options["group"]) - 1]
        place = view.options["places"][0]
        figure = kinetic_frames.scheme(project, g, k, kinetic_frames.share_of_arrows(project, g, k, place))
        yield from _among_forces(project, Remark(marked("group {name}"), {"name": g.lettered}), figure, place)


def _among_forces(project: Project, what: Remark, figure: Figure, place: Box) -> Iterator[Measured]:
    """A figure with its forces in a place.

    What is small beside its own forces and their arms, blocks in a slot or a lever in a dead position, is so at any scale factor.
    """
    if figure.size > LINKS * figure.whole:
        scale = figure.frame(project, ScaleBook(), place).scale
        yield Measured(what, float(scale.mm(figure.size)), APART * figure.forces, forces=figure.forces)
