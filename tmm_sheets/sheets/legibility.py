"""What a sheet cannot show so large that it can be read: told by ``check`` and ``build``, found without drawing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tmm_sheets.construction.readable import CURVE, MAIN, POLE, TOOTH
from tmm_sheets.errors import CannotBuild
from tmm_sheets.remarks import Remark
from tmm_sheets.sheets.composition import arranged, placed_where
from tmm_sheets.sheets.floors import CRANK, LETTERED, VECTOR, risen
from tmm_sheets.sheets.frame import extent, fit_frame
from tmm_sheets.sheets.linkage import kinematic_frames, kinetic_frames
from tmm_sheets.sheets.linkage.linkage_sizes import LINKS
from tmm_sheets.sheets.views import function
from tmm_sheets.words import marked

if TYPE_CHECKING:
    from tmm_sheets.box import Box
    from tmm_sheets.construction.expression import Floats
    from tmm_sheets.methods.cams.cam_profile import RockerCam, TappetCam
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.arrangement import ViewPlace

APART = 3.0
"""Length of a group's links, or of the lever, that one force on it needs at least to be told from the next one, mm."""
POLES = tuple(Remark(marked("the pole distance {symbol}"), {"symbol": symbol}) for symbol in ("H_1", "H_2"))
"""What is too small of the motion of a cam."""
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
    def circle(project: Project, view: ViewPlace) -> float:
        frame = kinematic_frames.positions(project, _book(), view.box, view.options)
        return float(frame.scale.mm(2 * project.mechanism.crank.length))

    yield from below(project, n, view, Remark(CRANK.what), CRANK.least, circle, marked("leave out points far from the crank"))


def velocities(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The velocity plans are too small, the largest or the smallest: what is shown once more, enlarged, is but one of them."""
    def longest(project: Project, view: ViewPlace) -> float:
        layout = kinematic_frames.velocities(project, _book(), view.box, view.options)
        return layout.longest(project.study.velocities.plan)

    def smallest(project: Project, view: ViewPlace) -> float:
        layout = kinematic_frames.velocities(project, _book(), view.box, view.options)
        return min(layout.sizes(project.study.velocities.plan).values())

    yield from below(project, n, view, Remark(VECTOR.what), VECTOR.least, longest, marked("number fewer positions"))
    yield from below(project, n, view, Remark(LETTERED.what), LETTERED.least, smallest, marked("number fewer positions"))


def accelerations(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The acceleration plan is too small, or more of its letters than can be read stand together."""
    plan, k = project.study.accelerations.plan, project.force_index

    def longest(project: Project, view: ViewPlace) -> float:
        return float(kinematic_frames.accelerations(project, _book(), view.box).scale.mm(kinematic_frames.longest(plan, [k])))

    yield from below(project, n, view, Remark(VECTOR.what), VECTOR.least, longest, marked("take another force_position"))
    try:
        letters = kinematic_frames.crowd(plan, k, kinematic_frames.accelerations(project, _book(), view.box).scale.mu)
    except CannotBuild:
        return
    if letters > kinematic_frames.TOGETHER_READ:
        yield Remark(marked("sheet {n}: the acceleration plan cannot be read, {count} of its letters stand within "
                            "{about:.0f} mm of one of them: take another force_position"),
                     {"n": n, "count": letters, "about": kinematic_frames.ABOUT})


def flywheel(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """Graphs of the flywheel's column are too low beside each other; that of dE is shown once more, enlarged."""
    fw: Flywheel = project.flywheel
    shown = {"M": fw.scales.moment.mm(fw.at_samples.moment().value), "A": fw.work_curve(fw.samples),
             "J": fw.scales.inertia.mm(fw.inertia(fw.samples))}
    for quantity, ordinates in shown.items():
        def height(project: Project, view: ViewPlace, ordinates: Floats = ordinates) -> float:
            return risen(ordinates) or CURVE  # one that is level has none

        yield from below(project, n, view, Remark(marked("the graph of {quantity}"), {"quantity": quantity}), CURVE, height,
                         marked("take the other method of [flywheel]"))


Size = Callable[["Project", "ViewPlace"], float]
"""What is measured of a view in its place on a sheet of the project, mm; raises CannotBuild where it cannot be drawn there."""


def _book() -> Any:
    """A book of scale factors for one question: nothing is drawn."""
    return SimpleNamespace(scales={}, chosen=set())


def below(project: Project, n: int, view: ViewPlace, what: Remark, least: float, size: Size, hint: str) -> Iterator[Remark]:
    """``what`` of a view no place of sheet ``n`` shows at its floor ``least``, mm, and what to try."""
    try:
        here = size(project, view)
    except CannotBuild:  # the sheet itself tells why
        return
    if here >= least * (1 - 1e-6):
        return
    said = Remark(marked("sheet {n}: {what} is {size:.3g} mm large, it is read from {least:.0f} mm on: {hint}"),
                  {"n": n, "what": what, "size": here, "least": least, "hint": Remark(hint)})
    apart = _apart(project, n, view, size, least)
    yield said if apart is None else Remark(marked("{said}, or take a sheet more, sheets = [{names}]"),
                                            {"said": said, "names": apart})


def cam_motion(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """Pole distances or graphs of the motion of a cam are too small, to the millimetre."""
    scales, law = project.cam.motion.scales, project.cam.law
    for what, size, least in ((POLES[0], scales.h1, POLE), (POLES[1], scales.h2, POLE),
                              (_graph(law.symbol), scales.s.mm(law.stroke), MAIN)):
        yield from _in_place(project, n, view, what, size, least, marked("longer phases of rise and return"))


def zone(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The curve whose tangents bound the zone of a cam's axis is too low: it has one scale factor with the cam itself."""
    from tmm_sheets.sheets.cams import cam_zone

    cam, rays = project.cam, bool(view.options.get("rays"))
    if cam.law.symbol == "S":
        name, size = "S(S')", cam_zone.stroke_in(cast("TappetCam", cam), rays, view.box.width, view.box.height)
    else:
        rocker = cast("RockerCam", cam)
        name, size = "D(ψ)", float(np.ptp(rocker.zone.curve.value.imag)) / cam_zone.fitted_rocker(rocker, rays, view.box)[0]
    yield from _in_place(project, n, view, _graph(name), size, CURVE, marked("a larger pressure_angle makes the cam smaller"))


def spring(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The force of a cam's spring and that of inertia are too low."""
    from tmm_sheets.sheets.cams.cam import spring_diagram

    span, diagram = spring_diagram(project.cam, view.box)
    yield from _in_place(project, n, view, _graph("F, Q"), diagram.tall.mm(span), CURVE, marked("leave out a view of the sheet"))


def teeth(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The teeth of the mesh are too low."""
    from tmm_sheets.sheets.gears import gear_picture

    size = gear_picture.picture(project.gear, view.box.width, view.box.height)[0].mm(gear_picture.highest_tooth(project.gear))
    yield from _in_place(project, n, view, Remark(marked("the tooth of the mesh")), size, TOOTH,
                         marked("a smaller ratio of the tooth numbers"))


def _graph(quantity: str) -> Remark:
    return Remark(marked("the graph of {quantity}"), {"quantity": quantity})


def _in_place(project: Project, n: int, view: ViewPlace, what: Remark, size: float, least: float, hint: str) -> Iterator[Remark]:
    """The same of a size, mm, that was found already, to the millimetre."""
    yield from below(project, n, view, what, least, lambda _, __: float(round(size)), hint)


def _apart(project: Project, n: int, view: ViewPlace, size: Size, least: float) -> str | None:
    """Sheets of a project, as they stand in its file, with kinematics and forces on two in the place of sheet ``n``.

    None where that does not make the view as large as ``least``, mm, or would lose what else stands on the sheet.
    """
    shown = {view.needs for view in arranged(project, n).views if view.needs}
    if not shown <= {"positions", "forces"} or set(OF_THEIR_OWN) & set(project.sheets):
        return None
    names = [*project.sheets[:n - 1], *OF_THEIR_OWN, *project.sheets[n:]]
    other = project.on_sheets(names)
    try:
        sizes = [size(other, found) for at in (n, n + 1) for found in arranged(other, at).views
                 if found.draw == view.draw and found.options.get("group") == view.options.get("group")]
    except CannotBuild:
        return None
    return ", ".join(f'"{name}"' for name in names) if max(sizes, default=0.0) >= least * (1 - 1e-6) else None


def lever(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The lever is too small for its forces."""
    k = project.force_index
    shown = kinetic_frames.on_lever(project, k)
    around = kinetic_frames.lever_scheme(project, k, shown)
    points = extent([complex(step.at(k)) for step in project.study.lever.points.values()])
    yield from _crowded(project, n, view, Remark(marked("the lever")), max(points.width, points.height), len(shown), "lever",
                        lambda view: (around, view.box.inset(*kinetic_frames.LEVER)))


def group(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """A loaded group is too small for its forces."""
    if "places" not in view.options:
        return  # of no force, or in the box as it is written
    k, g = project.force_index, tuple(reversed(project.mechanism.groups))[int(view.options["group"]) - 1]

    def placed(view: ViewPlace) -> tuple[Around, Box]:
        place = view.options.get("places", [view.box])[0].inset(*kinetic_frames.SCHEME)
        return kinetic_frames.scheme(project, g, k, kinetic_frames.share_of_arrows(project, g, k, place)), place

    yield from _crowded(project, n, view, Remark(marked("group {name}"), {"name": g.lettered}),
                        *kinetic_frames.crowd(project, g, k), f"scheme-{'-'.join(g.links)}", placed)


Around = tuple[list[complex], list[complex]]
"""Points of a figure, in its unit, and what reaches from each on paper, mm."""


def _crowded(project: Project, n: int, view: ViewPlace, what: Remark, size: float, count: int, plan: str,
             placed: Callable[[ViewPlace], tuple[Around, Box]]) -> Iterator[Remark]:
    """A figure of such a size, in its unit, with so many forces that in its place they cannot be told apart.

    What is small beside its own forces and their arms, blocks in a slot or a lever in a dead position, is so at any scale factor.
    """
    whole = extent([np.asarray(placed(view)[0][0])])
    if size <= LINKS * max(whole.width, whole.height):
        return

    def large(project: Project, view: ViewPlace) -> float:
        around, place = placed(view)
        return float(fit_frame(project, _book(), plan, "", "", *around, place).scale.mm(size))

    here = large(project, view)
    if here < APART * count:
        said = Remark(marked("sheet {n}: {what} is {size:.0f} mm large and cannot be read (forces on it: {count})"),
                      {"n": n, "what": what, "size": here, "count": count})
        apart = _apart(project, n, view, large, APART * count)
        yield said if apart is None else Remark(marked("{said}: take a sheet more, sheets = [{names}]"),
                                                {"said": said, "names": apart})
