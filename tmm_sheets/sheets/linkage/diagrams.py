"""Diagrams over the crank angle: motion of the outputs, balancing moment, technological loads, hodograph of the bearing."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.arithmetic import ascending
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.scale import CURVE, MAIN, Scale, handy, times
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import NOISE, fixed, is_zero
from tmm_sheets.sheets.border_solver import BorderNode, Measured, table_node
from tmm_sheets.sheets.components import graphs, listed
from tmm_sheets.sheets.components.graphs import Column, Curve, Options, Quantity
from tmm_sheets.sheets.linkage.kinetic_frames import balancing_sign
from tmm_sheets.sheets.linkage.link_marks import SignedTable, indexed, shapes, tell_signs
from tmm_sheets.sheets.player import PlanFrame, PlayerStage, extent, once, pick, together
from tmm_sheets.words import Remark, both, marked, marked_n, tell, tr, tr_in

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from tmm_sheets.methods.linkage.loads import Applied
    from tmm_sheets.methods.linkage.study import Output
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

GRAPH_SIZES = (280.0, 110.0), (240.0, 96.0), (200.0, 84.0), (170.0, 76.0)
"""Sizes of a single graph over the cycle for room that a sheet has left, mm."""


OF_POINTS = (("graph-S", "S", marked("m"), MAIN), ("graph-V", "V", marked("m/s"), CURVE), ("graph-a", "a", marked("m/s^2"), CURVE))
OF_LINKS = (("graph-psi", "ψ", marked("rad"), MAIN), ("graph-omega", "ω", marked("s^{−1}"), CURVE),
            ("graph-epsilon", "ε", marked("s^{−2}"), CURVE))
"""Graphs of an output: key of the scale factor, letter, unit, height from which on they are read, mm."""


def motion_graphs(project: Project, options: Options) -> list[Column]:
    """What is drawn, points and links apart. Which: option ``of``, else those of the project; none for a bare crank."""
    named = options.get("of") or project.diagrams
    links = [name for name in named if name in project.mechanism.links]
    points = [name for name in named if name not in links]
    of_points = [project.motion.point(name) for name in points]
    of_links = [project.motion.link(name) for name in links]
    return [_quantities(project, outputs, units) for outputs, units in ((of_points, OF_POINTS), (of_links, OF_LINKS)) if outputs]


def motion(project: Project, canvas: Canvas, box: Box, options: Options) -> None:
    """Kinematic diagrams of the outputs, one graph under another, or beside each other where that is what there is room for.

    Points have S, V, a along their straight path, links psi, omega, epsilon; both count from position 0. Those of points are
    positive in the sense in which the motion begins there, those of links counter-clockwise, as in every table.
    """
    kinematic(project, canvas, box, options)
    if any(name in project.mechanism.links for name in options.get("of") or project.diagrams):
        tell_signs(project, canvas, box)


def _moving(project: Project, options: Options) -> list[Column]:
    """Kinematic diagrams of what moves; refused where nothing does: scale factors would be of nothing."""
    columns = motion_graphs(project, options)
    if columns and not _moves(columns):
        raise CannotBuild(str(project.variant.problem(
            str(_at_rest(project)), "cycle", "diagrams",
            hint=tell("name a point or link that moves, or leave the view diagrams.motion out of the arrangement"))))
    return columns


def _moves(columns: list[Column]) -> bool:
    return any(q.span for column in columns for q in column)


def _at_rest(project: Project) -> Remark:
    return Remark(marked_n("{names} does not turn or move over the whole cycle: its diagrams would be empty",
                           "{names} do not turn or move over the whole cycle: their diagrams would be empty"),
                  {"names": both(project.diagrams)}, len(project.diagrams))


kinematic = graphs.CycleView(lambda project: tr("Kinematic diagrams"), _moving, 0.5)
"""The graphs of these diagrams."""


def motion_low(project: Project, n: int, view: ViewPlace) -> Iterator[Measured | Remark]:
    """Those that are too low on sheet ``n``, or of nothing that moves."""
    columns = motion_graphs(project, view.options)
    if columns and not _moves(columns):
        yield _at_rest(project)
    else:
        yield from kinematic.low(project, n, view)


def _motion(project: Project, options: Options) -> tuple[str, list[list[str]]]:
    """The values of the kinematic diagrams at the positions, one row each; with ``links`` those of the bars before them.

    Positions of a later turn that repeat the first stand in its rows; the units have a row of their own where there are ``links``.
    """
    every = [(c.symbol, q.unit, c.at) for column in motion_graphs(project, options) for q in column for c in q.curves]
    # The same quantities of one output stand together.
    every.sort(key=lambda row: row[0][1:])
    beside = _of_bars(project, {symbol for symbol, _, _ in every}) if options.get("links") and every else []
    title = tr("Motion of the links") if beside else \
        tr("Motion of the output link") if len(every) == 3 else tr("Motion of the output links")
    names, units, values = [list(of) for of in zip(*beside, *every, strict=True)] or [[], [], []]
    columns, same = [graphs.column(v) for v in values], project.cycle.drawn
    heads = [[tr("No."), *names], ["", *units]] if beside else \
        [[tr("No."), *map("{}, {}".format, names, units)]]
    labels = same if len(same) < len(project.cycle.labels) else tuple(enumerate(project.cycle.labels))
    return title, [*heads, *([label, *(c[i] for c in columns)] for i, label in labels)]


def motion_table_place(project: Project, view: ViewPlace) -> BorderNode | None:
    """A row for each position, columns that their numbers fit in."""
    if not project.diagrams:
        return None
    bars = [shape.link for shape in shapes(project.study.positions)[1:] if shape.bar and view.options.get("links")]
    columns = 1 + 3 * len({*(view.options.get("of") or project.diagrams), *bars})
    count = len(project.cycle.labels) + (2 if view.options.get("links") else 1)
    return table_node(count, 9.0, (5.6 if count <= 26 else 5.0, 7.0), (max(100.0, listed.COLUMN * columns), 170.0))


motion_table = SignedTable(_motion)
"""The table of the motion of the outputs."""


def _of_bars(project: Project, known: Collection[str]) -> list[tuple[str, str, graphs.Floats]]:
    """Angle, angular velocity and acceleration of every bar but the crank at the positions, without those that are ``known``.

    A rocker's angle is counted from position 0, a rod's is its inclination to the guide of its other end (manual 001, table I)
    unless its diagrams are drawn: they have the other, and one angle needs no second name.
    """
    m, motion = project.mechanism, project.motion
    guides = {g.links[0]: g.guides[-1] for g in m.groups if g.kind.number == 2}
    found = []
    for shape in (shape for shape in shapes(project.study.positions)[1:] if shape.bar):
        angle, omega, epsilon = motion.link(shape.link).at_positions
        if shape.link in guides and angle.symbol not in known:
            angle = motion.inclination(shape.link, guides[shape.link])
        for step, unit in ((angle, tr("rad")), (omega, tr("s^{−1}")), (epsilon, tr("s^{−2}"))):
            if step.symbol not in known:
                found.append((step.symbol, unit, _row(step, project.study.turned)))
    return found


def balancing_graph(project: Project) -> Column:
    """The graph of the balancing moment, with the constant one; CannotBuild for a crank that is driven by a force."""
    if project.driver is not None:
        raise CannotBuild(tell("the diagram of the balancing moment needs a crank driven by a moment"),
                          tell('write kind = "moment" in [balancing]'))
    every, step, course = project.course.turned, project.study.balance["M"], project.course.balance["M"]
    # The flywheel's construction has the constant moment already, a little apart from the mean of this curve; without friction.
    rubbing = project.study.forces.friction is not None
    mean = project.flywheel.driving_plan["M"] if project.variant.flywheel is not None and not rubbing else \
        project.study.mean_driving(course, every)
    sign = balancing_sign(project)
    # Where the balancing moment is called as the driving one is, the constant one is its mean.
    known = project.variant.flywheel is not None and not project.reduced.resisting
    constant = f"M_{{{tr_in('index of moment and work', 'r')}}}" if known else tr("M_d")
    name = constant if indexed(constant.replace("_", "")) != sign and not rubbing else tr("M_{dm}")
    curve = Curve("", step.path, every, _row(course, every), _row(step, project.cycle.turned))
    return (Quantity("graph-M", sign, tr("N·m"), (curve,), level=(name, float(mean.value))),)


balancing = graphs.CycleView(lambda project: tr("Graph of the balancing moment"),
                                   lambda project, options: [balancing_graph(project)], wanted=GRAPH_SIZES)
"""Balancing moment over the whole cycle by kinetostatics, positive in the sense of rotation; its mean drives the machine."""


def _balancing(project: Project, options: Options) -> tuple[str, list[list[str]]]:
    """The balancing moment at the positions by kinetostatics and by Zhukovsky's lever; none for a crank driven by a force."""
    title, study = tr("Balancing moment, N·m"), project.study
    if project.driver is not None:
        return title, [[tr("No.")]]
    by_statics, by_lever = (_row(study.balance[name], study.turned) for name in ("M", "M_р"))
    largest = np.max(np.abs(by_statics))
    return title, [[tr("No."), tr("Force analysis"), tr("Lever")],
                   *([label, *graphs.column([a, b, largest])[:2]]
                     for label, a, b in zip(project.cycle.labels, by_statics, by_lever, strict=True))]


balancing_table = listed.Upright(_balancing)
"""The table of these moments."""


def _quantities(project: Project, outputs: list[Output], units: Iterable[tuple[str, str, str, float]]) -> Column:
    turned = project.motion.turned
    curves = [[Curve(here.symbol, here.path, turned, _row(between, turned), _row(here, project.study.turned))
               for here, between in zip(one.at_positions, one.between, strict=True)] for one in outputs]
    return tuple(Quantity.of(key, letter, tr(unit), row, floor)
                 for (key, letter, unit, floor), row in zip(units, zip(*curves, strict=True), strict=True))


def _row(step: Step, turned: graphs.Floats) -> graphs.Floats:
    """Values of a step at some angles, of one that is the same at all of them as well.

    An angle that is nothing beside a radian is nothing, and an angular acceleration beside all that the points of its link are
    accelerated by.
    """
    values = np.broadcast_to(step.value, np.shape(turned))
    if step.rule.gives == "angle":
        return np.where(np.abs(values) <= NOISE, 0.0, values)
    source = step.args[0] if step.args and isinstance(step.args[0], Step) else step
    if source.rule.unit != "rad/s2" or len(source.args) != 4:
        return values
    big_q, big_b, q, b = map(value_of, source.args)
    return np.where(np.abs(values) <= NOISE * np.max(np.abs(b - q) / np.abs(big_b - big_q)), 0.0, values)


AROUND = 12.0, 10.0, 12.0, 26.0
"""Room round the curve for numbers at the left, below, right and above (title and scale factor), mm."""
SIZES = 120.0, 100.0, 80.0, 60.0
"""Lengths of the longer side of the curve that are tried, mm."""
LOWEST = 25.0
"""Least length of its shorter side, mm: the numbers of a flatter curve have no room beside each other."""


def bearing_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the hodograph can do with, mm; none where there is no force, where it has no end or is too flat."""
    left, below, right, above = AROUND
    return [(max(size * width + left + right, 80.0), size * height + below + above) for width, height in _shape(project)
            for size in SIZES if size * min(width, height) >= LOWEST]


def _shape(project: Project) -> Iterator[tuple[float, float]]:
    """Width and height of the hodograph, shares of the greater of both; of nothing, and of what has no end, none."""
    course = frame_reaction(project)[2]
    if np.isfinite(course).all() and not is_zero(float(np.abs(course).max()), project.study.forces.force_size(project.force_index)):
        real = extent([course, np.zeros(1)])
        yield real.width / max(real.width, real.height), real.height / max(real.width, real.height)


def too_flat(project: Project) -> Iterator[Remark]:
    """That the hodograph is left out, where no size of it can be read."""
    with suppress(CannotBuild):  # without forces there is none
        for high in (SIZES[0] * min(shape) for shape in _shape(project) if SIZES[0] * min(shape) < LOWEST):
            yield Remark(marked("the hodograph of the reaction {force} is left out: {size} mm long it would be {high} mm wide, "
                                "its numbers need {least} mm"),
                         {"force": frame_reaction(project)[0], "size": f"{SIZES[0]:g}", "high": fixed(high, 1),
                          "least": f"{LOWEST:g}"})


def bearing(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Ends of the vectors of the reaction on the crank, laid off from one pole, at the positions and between them."""
    name, step, course = frame_reaction(project)
    at = np.broadcast_to(step.value, (len(project.cycle.labels),))
    real, inside = extent([course, np.zeros(1)]), box.inset(*AROUND)
    scale = Scale("μ_F", handy(max(real.width / inside.width, real.height / inside.height)), tr("N/mm"))
    canvas.of = "hodograph"
    canvas.title(box, tr("Hodograph of the reaction F_{{{index}}}").format(index=name[1:]), str(scale))
    frame = PlanFrame(scale, inside.centre - scale.mm(real.centre))
    placed = canvas.placed(step.plan, "", frame.origin, frame.mu)
    # Round a turn it is closed: a load that jumps where the cycle begins anew is drawn like one that jumps within.
    drawn, ends = frame(course if project.cycle.swings else np.append(course, course[:1])), frame(at)
    # In the plan itself the vectors stand elsewhere: here they begin at one point.
    canvas.tracing("curve", step.path, "", placed, name).polyline(drawn, "curve")
    axis = canvas.tracing("axis", step.path, "", placed, name)
    for a, b, u, sign in ((real.x0, real.x1, 1 + 0j, "x"), (real.y0, real.y1, 1j, "y")):
        end = complex(frame(b * u)) + 5.0 * u
        axis.arrow(complex(frame(a * u)) - 5.0 * u, end, "axis", 3.0)
        axis.label(end, sign, u * (1 - 1j), 3.5, 0.8, leader=False)
    pole, middle, labels = complex(frame(0j)), complex(np.mean(drawn)), project.cycle.labels
    canvas.dot(pole, 0.8)
    canvas.label(pole, "O", pole - middle, 3.5, 1.2)
    for same in together(ends, 1.0):  # in each turn the force is another one
        z, pen = complex(ends[same[0]]), canvas.tracing("point", step.path, labels[same[0]], placed, name)
        pen.dot(z, 0.5)
        pen.label(z, graphs.in_ranges(labels, same), z - middle, 2.5, 0.9)
    tip, pen = complex(ends[project.force_index]), canvas.tracing("vector", step.path, labels[project.force_index], placed, name)
    if abs(tip - pole) > 6.0:
        pen.arrow(pole, tip, "vector")
        pen.label(pole + 0.6 * (tip - pole), f"F̅_{{{name[1:]}}}", 1j * (tip - pole), 3.5, 1.0)


def frame_reaction(project: Project) -> tuple[str, Step, Points]:
    """Name of the reaction of the frame on the crank, its step at the positions, and its values over the cycle, N."""
    m = project.mechanism
    name = f"F{pair_index(m.crank.link, m.frame)}"
    course = project.course.forces.reactions[name]
    return name, project.study.forces.reactions[name], np.broadcast_to(course.value, np.shape(project.course.turned))


SAMPLES = 361
"""Angles at which the curves are drawn, besides both sides of every jump."""
HAIR = 1e-9
"""How near to a jump the curve is drawn on either side, rad."""


def over_turn(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Magnitudes of the forces or of the moments that are not given as pressures, over the angle of the crank."""
    loads(project, canvas, box, options)
    if (said := _working_stroke_hint(project, _diagrams_shown(project))) is not None:
        canvas.note(box, said)


def _of_loads(project: Project) -> str:
    """Title of the graph, which says if none of the loads is given by the task."""
    names = {f.name for f in _diagrams_shown(project)}
    taken = all((*(f.accepted for f in project.variant.force if f.name in names),
                 *(m.accepted for m in project.variant.moment if m.name in names)))
    return tr("Technological load (taken)") if taken else tr("Technological load")


@once
def load_graph(project: Project) -> Column:
    """The graph of these loads; nothing where there are none."""
    shown, cycle = _diagrams_shown(project), project.cycle
    if not shown:
        return ()
    jumps = [j + s * HAIR for f in shown for j in f.jumps for s in (-1, 1)]  # both sides of each are drawn
    turned = ascending(np.clip(np.concatenate((np.linspace(0, cycle.period, SAMPLES), jumps)), 0, cycle.period))
    letter, unit = ("F", tr("N")) if shown[0].point is not None else ("M", tr("N·m"))

    def at(f: Applied) -> graphs.Floats:
        """Of both sides of a jump the one with the greater magnitude."""
        sides = np.array([f.shown(cycle.turned, side) for side in (-1, 1)])
        return np.asarray(np.where(np.abs(sides[0]) > np.abs(sides[1]), *sides))

    return (Quantity.of("loads", letter, unit, [Curve(indexed(f.name), f"loads/{f.name}", turned, f.shown(turned),
                                                      at(f)) for f in shown]),)


loads = graphs.CycleView(_of_loads, lambda project, options: [column] if (column := load_graph(project)) else [])
"""The graph of these loads."""


def _diagrams_shown(project: Project) -> list[Applied]:
    pressures = {f.name for f in project.variant.force if f.bore is not None}
    return [f for f in project.applied if f.name not in pressures]


def _working_stroke_hint(project: Project, shown: list[Applied]) -> str | None:
    """What is said of an output that turns back more than twice a turn: which of its strokes is the working one."""
    cycle, strokes = project.cycle, project.cycle.strokes
    if strokes is None or len(strokes.runs) <= 2 or not any(f.motion is not None and f.point == strokes.output for f in shown):
        return None
    a, b = (fixed(degrees(x) % degrees(cycle.period), 1) for x in (strokes.begin, strokes.end))
    return tr("Point {point} turns back {times} a turn; working stroke φ = {begin}°…{end}°").format(
        point=strokes.output, times=times(len(strokes.runs)), begin=a, end=b)


GAP = 25.0
"""Distance of a diagram's abscissa from the path: room for position numbers, mm."""
HEIGHT, MOST = 40.0, 100.0
"""Greatest ordinate as we choose the scale factor, and by any the project asks for, mm."""


@dataclass(frozen=True)
class Indicator:
    """A diagram beside a path: its force, unit vectors of the path and of the ordinates, and what one unit of ordinate is.

    ``area`` m2 turns the force into a pressure; 1 where the ordinate is the force itself.
    """

    force: Applied
    along: complex
    side: complex
    area: float

    @property
    def text(self) -> str:
        """Sign of the ordinate in lettering markup, with its unit."""
        name = f"{'p' if self.area != 1 else self.force.name[0]}_{{{self.force.name[1:]}}}"
        said = tr("{quantity}, MPa") if self.area != 1 else tr("{quantity}, N")
        return said.format(quantity=name)

    def ordinate(self, turned: ArrayLike, side: int = 0) -> graphs.Floats:
        """Pressure, MPa, or force, N, at angles from position 0, rad, in their shape."""
        value = np.asarray(self.force.magnitude(turned, side)) / self.area
        return value * 1e-6 if self.area != 1 else value


def indicators(project: Project) -> list[Indicator]:
    """Diagrams of the forces on sliders of fixed guides that are given as pressures in a cylinder.

    The diagrams of one guide stand on its two sides in turn; a single one stands on the side away from the crank.
    """
    m = project.mechanism
    areas = {f.name: pi * f.bore**2 / 4 for f in project.variant.force if f.bore is not None}
    found, taken = list[Indicator](), list[str]()
    for force in project.applied:
        group = next((g for g in m.groups if g.inner == force.point and g.guides), None)
        if force.name not in areas or group is None:
            continue
        guide = m.guides[group.guides[-1]]
        if guide.link != m.frame or isinstance(guide.through, str):
            continue
        u = complex(np.cos(guide.direction), np.sin(guide.direction))
        lateral = ((guide.through - m.fixed[m.crank.pivot]) * np.conj(u)).imag
        n = 1j * u if lateral > 1e-9 or (abs(lateral) <= 1e-9 and u.imag < 0) else -1j * u
        found.append(Indicator(force, u, n * (-1) ** taken.count(guide.name), areas[force.name]))
        taken.append(guide.name)
    return found


def indicator_height(project: Project, shown: list[Indicator]) -> float:
    """Greatest ordinate, mm: by the scale factor that the project asks for, or as we choose it."""
    mu = project.variant.scales.get("indicator")
    return HEIGHT if mu is None else min(max(float(np.max(one.ordinate(_angles_of_turns(project)))) for one in shown) / mu, MOST)


def indicator_reach(project: Project) -> tuple[list[complex], list[complex]]:
    """Points of the paths and what the diagrams stick out of them on paper, mm: for the frame of the position plans."""
    z, d, shown = list[complex](), list[complex](), indicators(project)
    high = indicator_height(project, shown) if shown else 0.0
    for n, one in enumerate(shown):
        # Over the ordinate axis the scale factor is written, from side to side; that of another one within its length.
        beyond = 28.0 if n == 0 and abs(one.side.real) > 0.5 else 10.0
        at = np.ravel(project.study.positions.points[str(one.force.point)].value)
        for p in (at[np.argmin((at * np.conj(one.along)).real)], at[np.argmax((at * np.conj(one.along)).real)]):
            z.append(complex(p))
            d.append(one.side * (GAP + high + beyond))
    return z, d


def _angles_of_turns(project: Project) -> graphs.Floats:
    period = project.cycle.period
    return ascending(np.concatenate((np.linspace(0, period, round(period / (2 * pi)) * (SAMPLES - 1) + 1), project.cycle.turned)))


def draw_indicators(project: Project, s: PlayerStage) -> None:
    """The diagrams of a project beside the paths of its position plans."""
    shown = indicators(project)
    if not shown:
        return
    canvas, cycle = s.canvas, project.cycle
    turned = _angles_of_turns(project)
    top = max(float(np.max(one.ordinate(turned))) for one in shown)
    pressure = shown[0].area != 1
    symbol, unit = ("μ_p", tr("MPa/mm")) if pressure else ("μ_F", tr("N/mm"))
    tallest = MOST if "indicator" in project.variant.scales else HEIGHT
    scale = pick(project, canvas, "indicator", symbol, unit, top / tallest)
    pos = project.study_at(turned, tuple("" for _ in turned)).positions
    for one in shown:
        name, load = str(one.force.point), f"loads/{one.force.name}"
        path = s.frame(np.asarray(pos.points[name].value))
        canvas.of = f"indicator {one.force.name}"
        zero = path[0] - one.along * ((path[0] - s.frame(0j)) * np.conj(one.along)).real + one.side * GAP
        mu = (s.frame.mu[0], scale.mu * (1e6 * one.area if pressure else 1.0))  # of the force, which the plan has
        graph = canvas.placed("loads", "", zero, mu, float(np.angle(one.along)), (one.side / one.along).imag < 0)
        canvas.tracing("curve", load, "", graph).polyline(path + one.side * (GAP + one.ordinate(turned) / scale.mu), "curve")
        ways = (path * np.conj(one.along)).real
        low, high = path[int(np.argmin(ways))] + one.side * GAP, path[int(np.argmax(ways))] + one.side * GAP
        top = float(np.max(one.ordinate(turned))) / scale.mu
        outer = low if (low - s.frame(0j)).imag * one.along.imag < 0 else high
        axis = canvas.tracing("axis", load, "", graph)
        axis.line(low, high, "axis")
        axis.arrow(outer, outer + one.side * (top + 9.0), "axis", 3.0)
        away = one.along * (1 if outer == high else -1)
        canvas.label(outer + one.side * (top + 4.0), one.text, away, 3.5, 1.2, leader=False)
        out = top + 4.0 if one is shown[0] else 0.4 * top
        canvas.label(outer + one.side * out + 7.0 * away, str(scale), away, 3.5, 1.2)
        marks = s.frame(np.asarray(s.plan[name].value))
        for mark in ascending(np.round(marks, 6)):
            here = np.flatnonzero(np.abs(marks - mark) < 1e-5)
            y = max(float(one.ordinate(cycle.turned[i])) for i in here) / scale.mu
            s.position(int(here[0])).pen(name, "construction").line(mark, mark + one.side * (GAP + max(y, 0.0)), "thin")
