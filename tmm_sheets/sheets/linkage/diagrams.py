"""Diagrams over the crank angle: motion of the output (S, V, a or psi, omega, epsilon), balancing moment over the cycle."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.readable import CURVE, MAIN
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import LEAST, needs, size_in, widened
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import NOISE
from tmm_sheets.remarks import Remark
from tmm_sheets.sheets.components import cycle_graphs, graphs, upright_tables
from tmm_sheets.sheets.components.cycle_graphs import Column, Curve, Quantity
from tmm_sheets.sheets.components.graphs import Floats
from tmm_sheets.sheets.linkage.kinetic_frames import balancing_sign
from tmm_sheets.sheets.linkage.link_marks import indexed, shapes, tell_signs
from tmm_sheets.sheets.view_sizes import leaf
from tmm_sheets.words import both, marked, marked_n, tell, tr, tr_in

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.motion import Output
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.arrangement import ViewPlace
    from tmm_sheets.sheets.border_solver import BorderNode

Options = dict[str, Any]
GRAPH_SIZES = (280.0, 110.0), (240.0, 96.0), (200.0, 84.0), (170.0, 76.0)
"""Sizes of a single graph over the cycle for room that a sheet has left, mm."""


def motion_graphs(project: Project, options: Options) -> list[Column]:
    """What is drawn, points and links apart. Which: option ``of``, else those of the project; none for a bare crank."""
    named = options.get("of") or project.diagrams
    links = [name for name in named if name in project.mechanism.links]
    points = [name for name in named if name not in links]
    return [of(project, some) for of, some in ((_of_points, points), (_of_links, links)) if some]


def motion(project: Project, canvas: Canvas, box: Box, options: Options) -> None:
    """Kinematic diagrams of the outputs, one graph under another, or beside each other where that is what there is room for.

    Points have S, V, a along their straight path, links psi, omega, epsilon; both count from position 0. Those of points are
    positive in the sense in which the motion begins there, those of links counter-clockwise, as in every table.
    """
    if columns := _moving(project, options):
        cycle_graphs.draw(project, canvas, box, tr("Kinematic diagrams"), columns)
        if any(name in project.mechanism.links for name in options.get("of") or project.diagrams):
            tell_signs(project, canvas, box)


def _moving(project: Project, options: Options) -> list[Column]:
    """The same, refused where nothing of it moves: its scale factors would be of nothing."""
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


def motion_place(project: Project, view: ViewPlace) -> BorderNode | None:
    """What they need of their place."""
    columns = _moving(project, view.options)
    return leaf(view.box, cycle_graphs.need(project, columns), 0.5) if columns else None


def motion_low(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """Those that are too low on sheet ``n``, or of nothing that moves."""
    columns = motion_graphs(project, view.options)
    if columns and not _moves(columns):
        yield _at_rest(project)
    yield from cycle_graphs.low(project, n, view, lambda project, view: motion_graphs(project, view.options))


ROW = 5.6
"""Height of the rows of a table of motion from which on its title rather has two lines than narrow letters, mm."""


def motion_table(project: Project, canvas: Canvas, box: Box, options: Options) -> None:
    """The values of the kinematic diagrams at the positions, one row each; with ``links`` those of the bars before them."""
    every = [(c.symbol, q.unit, c.at) for column in motion_graphs(project, options) for q in column for c in q.curves]
    if not every:
        return
    # The same quantities of one output stand together.
    every.sort(key=lambda row: row[0][1:])
    beside = _of_bars(project, {symbol for symbol, _, _ in every}) if options.get("links") else []
    title = tr("Motion of the links") if beside else _of_outputs(len(every))
    every = [*beside, *every]
    if any(symbol[0] == "ω" for symbol, _, _ in every):
        tell_signs(project, canvas, box)
    left = canvas.title(box, title, spare=box.height - 11.0 - ROW * (len(_rows_of(project)) + 1 + bool(beside)))
    for digits in (4, 3):
        rows = _motion_rows(_rows_of(project), every, digits, two=bool(beside))
        if sum(needs(rows, 2.5, LEAST)) <= left.width:
            break
    row = min(left.height / len(rows), 7.0)
    height = size_in(row) if sum(needs(rows, 3.5, LEAST)) <= left.width else 2.5
    first = min(12.0, 0.06 * left.width + needs([[line[0]] for line in rows], height)[0])
    width = (left.width - first) / len(every)
    widths = widened([first, *[width] * len(every)], rows, height)
    canvas.table(complex(box.x0, left.y1), widths, rows, row, height, header=2 if beside else 1)


def _of_outputs(columns: int) -> str:
    """Title of the table of the outputs with so many columns."""
    return tr("Motion of the output link") if columns == 3 else tr("Motion of the output links")


def motion_table_sizes(project: Project, canvas: Canvas, options: Options) -> list[tuple[float, float]]:
    """Places that the table can do with, mm: rows of 7 mm to 4.6 mm, columns of 26 mm to 16 mm."""
    if not motion_graphs(project, options):
        return []
    rows, columns = len(_rows_of(project)) + 1, 3 * len(project.diagrams)
    sizes = ((26.0, 7.0), (22.0, 7.0), (20.0, ROW), (16.0, 4.6))
    # As wide as its title is in letters of the height that the others have, if there is room.
    titled = [letter(_of_outputs(columns), height).width + 2.0 for height in (5.0, 3.5)]
    return [(max(12.0 + wide * columns, least), 11.0 + row * rows) for wide, row in sizes for least in titled]


def _rows_of(project: Project) -> tuple[tuple[int, str], ...]:
    """Positions of the table of motion: those of a later turn that repeat the first stand in its rows."""
    same = project.cycle.drawn
    return same if len(same) < len(project.cycle.labels) else tuple(enumerate(project.cycle.labels))


def _motion_rows(labels: Iterable[tuple[int, str]], every: list[tuple[str, str, Floats]], digits: int, *,
                 two: bool) -> list[list[str]]:
    """Rows of the table of motion with so many digits; the units stand in a row of their own if there are ``two`` of headings."""
    heads = [[tr("No."), *(symbol for symbol, _, _ in every)], ["", *(unit for _, unit, _ in every)]] if two else \
        [[tr("No."), *(f"{symbol}, {unit}" for symbol, unit, _ in every)]]
    columns = [graphs.column(values, digits) for _, _, values in every]
    return [*heads, *([label, *(c[i] for c in columns)] for i, label in labels)]


def _of_bars(project: Project, known: Collection[str]) -> list[tuple[str, str, Floats]]:
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


def balancing(project: Project, canvas: Canvas, box: Box, options: Options) -> None:
    """Balancing moment over the whole cycle by kinetostatics, positive in the sense of rotation; its mean drives the machine."""
    if project.driver is not None:
        raise CannotBuild(*map(tell, _NO_MOMENT))
    cycle_graphs.draw(project, canvas, box, tr("Graph of the balancing moment"), [balancing_graph(project)])


def balancing_low(project: Project, n: int, view: ViewPlace) -> Iterator[Remark]:
    """The graph on sheet ``n``, where it is too low; an offered one has a size in which it is not."""
    return cycle_graphs.low(project, n, view, lambda project, _: [] if project.driver is not None else [balancing_graph(project)])


def balancing_graph(project: Project) -> Column:
    """The graph of the balancing moment, with the constant one."""
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


def balancing_sizes(project: Project, canvas: Canvas, options: Options) -> tuple[tuple[float, float], ...]:
    """Sizes that the graph can do with, mm; none for a crank that is driven by a force."""
    return cycle_graphs.sizes(project, balancing_graph(project), GRAPH_SIZES) if project.driver is None else ()


def balancing_table_sizes(project: Project, canvas: Canvas, options: Options) -> list[tuple[float, float]]:
    """Places that the table can do with, mm; none for a crank that is driven by a force."""
    if project.driver is not None:
        return []
    rows = (len(project.cycle.labels) + 1) // 2 + 1
    upright = upright_tables.sizes(tr(BALANCING), _balancing(project), options["widest"]) if "widest" in options else []
    return [*upright, *((width, 11.0 + row * rows) for width, row in ((170.0, 7.5), (150.0, 6.0), (130.0, 5.0)))]


def balancing_table(project: Project, canvas: Canvas, box: Box, options: Options) -> None:
    """The balancing moment at the positions by kinetostatics and by Zhukovsky's lever, in columns side by side.

    In one below the other in a place that is higher than wide.
    """
    if project.driver is not None:
        raise CannotBuild(*map(tell, _NO_MOMENT))
    heads, *cells = _balancing(project)
    if box.height > box.width:
        upright_tables.draw(canvas, box, tr(BALANCING), [heads, *cells])
        return
    left = canvas.title(box, tr(BALANCING))
    half = (len(cells) + 1) // 2
    cells += [["", "", ""]] * (2 * half - len(cells))
    rows = [heads + heads, *(cells[i] + cells[half + i] for i in range(half))]
    row = min(left.height / len(rows), 7.5)
    width = box.width / 2 - 10.0
    widths = [10.0, 0.58 * width, 0.42 * width]
    height = size_in(row)
    canvas.table(complex(box.x0, left.y1), widened(widths * 2, rows, height), rows, row, height)


def _balancing(project: Project) -> list[list[str]]:
    """Heads and cells of the table of the balancing moment: a row for each position."""
    study = project.study
    by_statics, by_lever = (_row(study.balance[name], study.turned) for name in ("M", "M_р"))
    largest = np.max(np.abs(by_statics))
    return [[tr("No."), tr("Force analysis"), tr("Lever")],
            *([label, *graphs.column([a, b, largest])[:2]]
              for label, a, b in zip(project.cycle.labels, by_statics, by_lever, strict=True))]


BALANCING = marked("Balancing moment, N·m")
_NO_MOMENT = (marked("the diagram of the balancing moment needs a crank driven by a moment"),
              marked('write kind = "moment" in [balancing]'))


def _of_points(project: Project, names: list[str]) -> Column:
    units = (("graph-S", "S", tr("m"), MAIN), ("graph-V", "V", tr("m/s"), CURVE), ("graph-a", "a", tr("m/s^2"), CURVE))
    return _quantities(project, [project.motion.point(name) for name in names], units)


def _of_links(project: Project, names: list[str]) -> Column:
    units = (("graph-psi", "ψ", tr("rad"), MAIN), ("graph-omega", "ω", tr("s^{−1}"), CURVE),
             ("graph-epsilon", "ε", tr("s^{−2}"), CURVE))
    return _quantities(project, [project.motion.link(name) for name in names], units)


def _quantities(project: Project, outputs: list[Output], units: Iterable[tuple[str, str, str, float]]) -> Column:
    turned = project.motion.turned
    curves = [[Curve(here.symbol, here.path, turned, _row(between, turned), _row(here, project.study.turned))
               for here, between in zip(one.at_positions, one.between, strict=True)] for one in outputs]
    return tuple(Quantity.of(key, letter, unit, row, floor)
                 for (key, letter, unit, floor), row in zip(units, zip(*curves, strict=True), strict=True))


def _row(step: Step, turned: Floats) -> Floats:
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
