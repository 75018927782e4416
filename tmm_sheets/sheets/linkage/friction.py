"""Views of the friction in the pairs: the mechanism with its reactions, each pair enlarged, and the table of all.

A turning pair shows the journal, the circle of friction and the reaction that touches it, a sliding one the normal and the reaction
that deviates from it by the angle of friction; both the motion of the one link on the other.
"""

from __future__ import annotations

from math import ceil, degrees, inf
from operator import mul
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.equation import Quantity, equation, of_step
from tmm_sheets.construction.formula import letters_of
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import clean, fixed, is_zero, number
from tmm_sheets.sheets.border_solver import BorderNode, Figure, leaf, stepped, table_node
from tmm_sheets.sheets.components import graphs, listed
from tmm_sheets.sheets.linkage import diagrams, link_marks
from tmm_sheets.sheets.linkage.kinetic_frames import balancing_sign
from tmm_sheets.sheets.player import PlanFrame, PlayerStage, play, ratio, stage, standard
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.construction.step import Step
    from tmm_sheets.methods.linkage.friction import Friction
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

ARROW = 24.0
"""Length of a reaction's arrow, mm."""
OUTSIDE, WORDS, LEAST = 22.0, 30.0, 8.0
"""Room round a journal for its arrows and signs, height of the words above and below, least radius of the largest journal, mm."""
NAME, APART = 10.0, 4.0
"""Height of the words above a pair, room between rows of pairs, mm."""
SLIDING = 24.0, 40.0
"""Half a length of a guide: at least, and at most where no journal stands beside it, mm."""
TITLE = 18.0
"""Height of the heading over the pairs, mm."""
AROUND = 4.0, 4.0, 4.0, 20.0
"""Room round the mechanism at the left, below, right and above, mm."""
ROWS = 9.0, 8.0
"""Highest rows of the table of pairs and of that over all positions, mm."""
SPEED, DRIVE = 14.0, 24.0
"""Radii of the arrows of the crank's angular velocity and of what drives it, mm."""


def _friction(project: Project) -> Friction:
    found = project.study.forces.friction
    if found is None:
        raise CannotBuild(tell("the project has no [{name}]").format(name="friction"),
                          tell("add the table [{name}] to the project file or leave its sheet out").format(name="friction"))
    return found


def _reactions(project: Project) -> list[tuple[str, Step, complex]]:
    """Pairs with friction: index, step of the reaction on the first link, and the reaction, N."""
    of, k, forces = _friction(project), project.force_index, project.study.forces
    steps = {index: forces.reactions[f"F{index}"] for index in of.pairs}
    return [(index, step, clean(complex(step.at(k)), forces.force_size(k))) for index, step in steps.items()]


def _hinge(of: Friction, index: str) -> str:
    return of.pairs[index].name.rstrip("′″")


def _line(project: Project, index: str) -> Step:
    """A point of the line of a reaction: where it touches the circle of friction, or the point of a sliding pair."""
    of = _friction(project)
    return of.touches.get(index) or project.study.positions.points[_hinge(of, index)]


def _scheme(project: Project) -> Figure:
    """The mechanism at the analysed position, and what sticks out of its points."""
    of, k, pos = _friction(project), project.force_index, project.study.positions
    shown = _reactions(project)
    points = [complex(step.at(k)) for step in pos.points.values()]
    ends = [complex(pos.points[_hinge(of, index)].at(k)) for index, *_ in shown]
    reach = [1.3 * ARROW * force / abs(force) if force else 0j for *_, force in shown]
    pivot = complex(pos.points[pos.mechanism.crank.pivot].at(k))
    beside = [*[12 + 12j] * len(points), *[-12 - 14j] * len(points), *reach, (1 + 1j) * DRIVE, (-1 - 1j) * DRIVE]
    return Figure("friction-scheme", "μ_l", tr("m/mm"), np.array([*points, *points, *ends, pivot, pivot]), np.array(beside), AROUND)


def mechanism(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The mechanism at the analysed position: circles of friction to scale, in each pair the reaction on its first link."""
    of, k, pos = _friction(project), project.force_index, project.study.positions
    frame = _scheme(project).frame(project, canvas, box)
    canvas.title(box, tr("Reactions with friction (position {label})").format(label=project.cycle.labels[k]), str(frame.scale))
    s = stage(canvas, pos.plan, k, frame)
    link_marks.draw_guides(s, pos)
    link_marks.draw(s, pos, "main")
    for name, step in pos.points.items():
        if name in of.radii or name in pos.mechanism.fixed:
            s.letters(step, link_marks.indexed(name), gap=3.0)
    link_marks.number_links(s, pos)
    _on_crank(project, s)
    for index, step, force in _reactions(project):
        _reaction(project, s, step, index, force, ARROW)


def _on_crank(project: Project, s: PlayerStage) -> None:
    """How the crank turns, and the moment that drives it."""
    k, study, c = project.force_index, project.study, project.mechanism.crank
    pivot, away = s.at(c.pivot), link_marks.clear_of_crank(s, study.positions)
    symbols.rotation_arrow(s.pen(study.velocities.omega[c.link], "symbol"), pivot, SPEED, away, c.omega, f"ω_{c.link}")
    moment = study.forces.balancing if study.driver is None else None
    if moment is not None and not is_zero(moment.at(k), study.forces.moment_size(k)):
        symbols.rotation_arrow(s.pen(moment, "symbol"), pivot, DRIVE, away, float(moment.at(k)), balancing_sign(project))


def _reaction(project: Project, s: PlayerStage, step: Step, index: str, force: complex, length: float) -> None:
    """Arrow of a reaction from the point of its line, the circle of friction that it touches."""
    line = _line(project, index)
    play(s, [line] if index in _friction(project).touches else (), "thin")
    if not force:
        return
    at, u = s.at(line), force / abs(force)
    s.pen(step, "vector").arrow(at, at + length * u, "vector")
    s.pen(step, "text").label(at + (length - 4.0) * u, f"F̅_{{{index}}}", 1j * u, 3.5, 1.5)


def grid(count: int, width: float, height: float) -> tuple[int, float]:
    """Columns in which so many pairs have the largest room for a journal, and the radius of that room, mm."""
    def room(columns: int) -> float:
        return min(width / columns, (height - TITLE) / ceil(count / columns) - WORDS) / 2 - OUTSIDE

    return max(((columns, max(room(columns), LEAST)) for columns in range(1, count + 1)), key=lambda found: (found[1], -found[0]))


def pairs_area(project: Project, width: float, height: float) -> float:
    """What the pairs fill of a place of this size, mm^2."""
    of = _friction(project)
    count = max(len(of.pairs), 1)
    half = OUTSIDE + _drawn(of, grid(count, width, height)[1])[1]
    return TITLE * width + count * 2 * half * (2 * half + WORDS)


def _drawn(of: Friction, room: float) -> tuple[Scale, float]:
    """Scale of the journals in a room of this radius, and the radius of the largest one or half a length of a guide, mm."""
    radii = [float(radius.args[1]) for radius in of.radii.values()]
    scale = standard((max(radii, default=0.02), room))
    return scale, max(scale.mm(max(radii)) if radii else min(room, SLIDING[1]), SLIDING[0])


def pairs(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Every pair with friction enlarged, side by side and in rows."""
    of, k = _friction(project), project.force_index
    shown = _reactions(project)
    if not shown:
        left = canvas.title(box, tr("Friction in the pairs"))
        canvas.text(left.centre, tr("No pair has friction"), 3.5, "centre")
        return
    columns, room = grid(len(shown), box.width, box.height)
    scale, half = _drawn(of, room)
    left = canvas.title(box, tr("Pairs with friction"), ratio(scale) if of.radii else "")
    rows = [shown[n:n + columns] for n in range(0, len(shown), columns)]
    reach = [np.max([_reach(of, index, force, k, scale, half) for index, _, force in row], axis=0) for row in rows]
    # A pair keeps its words near; what height is left is in one piece for others.
    shrunk = min(1.0, left.height / sum(float(up + down) + WORDS + APART for up, down in reach))
    y = left.y1
    for row, (up, down) in zip(rows, reach, strict=True):
        top, y = y, y - (float(up + down) + WORDS + APART) * shrunk
        for n, (index, step, force) in enumerate(row):
            place = Box(left.x0 + n * box.width / columns, y, left.x0 + (n + 1) * box.width / columns, top)
            at = complex(project.study.positions.points[_hinge(of, index)].at(k))
            frame = PlanFrame(scale, complex(place.centre.real, top - (NAME + float(up)) * shrunk) - scale.mm(at))
            s = stage(canvas, project.study.positions.plan, k, frame)
            canvas.text(complex(place.centre.real, place.y1 - 5.0), pair_name(of, index), 3.5, "centre")
            if index in of.moments:
                _turning(project, s, index, step, force)
            else:
                _sliding(project, s, index, step, force, half)
            lines = _pair_lines(project, of, index, force, k)
            foot = complex(place.centre.real, place.y0 + 3.0 + APART + 6.0 * (len(lines) - 1))
            canvas.lines(foot, lines, 6.0, size_for(lines, place.width - 4.0, 3.5), "centre")


def _reach(of: Friction, index: str, force: complex, k: int, scale: Scale, half: float) -> tuple[float, float]:
    """How far what is drawn of a pair reaches above and below its middle, mm; ``half`` a length of a guide."""
    u = force / abs(force) if force else 0j
    if index in of.moments:
        journal = scale.mm(float(of.radii[_hinge(of, index)].args[1]))
        ends = [1j * (journal + 4.0), -1j * (journal + 4.0), (journal + 14.0) * u]
    else:
        normal = u * complex(np.exp(-1j * float(of.deviations[index].at(k)))) if force else 1j
        corners = (a * half * 1j * normal + b * (half / 6 + 8.0) * normal for a in (1, -1) for b in (1, -1))
        ends = [*corners, (half + ARROW / 4) * u]
    return max(z.imag for z in ends), -min(z.imag for z in ends)


def _turning(project: Project, s: PlayerStage, index: str, step: Step, force: complex) -> None:
    """A journal, its circle of friction, the reaction that touches it, the relative turning."""
    of, k, hinge = _friction(project), project.force_index, _hinge(_friction(project), index)
    turn, centre, journal = of.turning[index], s.at(hinge), float(of.radii[hinge].args[1]) / s.frame.mu[1]
    symbol = s.canvas.as_role("symbol")
    symbol.circle(centre, journal, "main")
    for u in (1, 1j):
        symbol.line(centre - (journal + 4) * u, centre + (journal + 4) * u, "centre")
    _reaction(project, s, step, index, force, journal + 14.0)
    pen, way = s.pen(of.radii[hinge], "dimension"), -1j * force * (0.8 + 0.6j) / abs(force) if force else 1 + 0j
    pen.arrow(centre, centre + journal * way, "thin", 2.5)
    pen.label(centre + 0.7 * journal * way, f"r_{{{hinge}}}", 1j * way, 3.5, 0.8)
    pen.label(centre - float(of.radii[hinge].value) / s.frame.mu[1] * way, of.radii[hinge].symbol, -way, 3.5, 2.0)
    if not of.still(index, k):
        symbols.rotation_arrow(s.pen(of.moments[index], "symbol"), centre, 0.75 * journal, 1j * force if force else 1j,
                               float(np.real(of.moments[index].at(k))), letters_of(of.moments[index].symbol))
        symbols.rotation_arrow(s.pen(turn, "symbol"), centre, journal + 3.0, -force if force else 1 + 1j,
                               float(np.real(turn.at(k))), f"ω_{{{index}}}")


def _sliding(project: Project, s: PlayerStage, index: str, step: Step, force: complex, half: float) -> None:
    """A block on its guide of this half length, the normal, the reaction that deviates from it, the velocity of sliding."""
    of, k, canvas = _friction(project), project.force_index, s.canvas
    centre, v, turn = s.at(_hinge(of, index)), complex(of.sliding[index].at(k)), float(of.deviations[index].at(k))
    normal = force * complex(np.exp(-1j * turn)) / abs(force) if force else 1j * v / abs(v) if v else 1j
    along, thick = -1j * normal, half / 6
    for side in (thick, -thick):
        a, b = (centre + x * along + side * normal for x in (-half, half))
        symbols.fixed_guide(canvas, a, b, 1 if side > 0 else -1)
    symbols.block(canvas, centre, along, size=(4 * thick, 2 * thick))
    length = half + ARROW / 4
    _reaction(project, s, step, index, force, length)
    if force:
        s.pen(of.deviations[index], "axis").line(centre - half / 2 * normal, centre + length * normal, "axis")
        if turn:
            start, end = sorted((float(np.angle(normal)), float(np.angle(normal)) + turn))
            s.pen(of.deviations[index], "dimension").angle_mark(centre, start, end, 0.75 * half, "φ")
    if not of.still(index, k):
        u = v / abs(v)
        tail = centre - (thick + 5.0) * normal + 4.0 * u
        pen = s.pen(of.sliding[index], "symbol")
        pen.arrow(tail, tail + half / 2 * u, "vector")
        pen.label(tail + (half / 2 - 4.0) * u, f"V̅_{{{index}}}", -normal, 3.5, 1.5)


def pair_name(of: Friction, index: str) -> str:
    """What a pair is called: as in the structure of the mechanism."""
    return tr("Pair {hinge}, reaction F_{{{index}}}").format(hinge=link_marks.indexed(of.pairs[index].name), index=index)


def _pair_lines(project: Project, of: Friction, index: str, force: complex, k: int) -> list[str]:
    """Numbers of a pair beneath it."""
    reaction = f"F_{{{index}}} = {number(abs(force), 5, project.study.forces.force_size(k))} {tr('N')}"
    if of.still(index, k):
        return [reaction, tr("its links do not move: no friction")]
    if index in of.moments:
        hinge = _hinge(of, index)
        moment = Quantity(letters_of(of.moments[index].symbol), abs(float(np.real(of.moments[index].at(k)))), "N*m")
        rho = Quantity(of.radii[hinge].symbol, float(of.radii[hinge].value))
        return [f"{of_step(of.radii[hinge])};  {reaction}", equation(mul, (rho, Quantity(f"F_{{{index}}}", abs(force))), moment)]
    assert of.angle is not None
    return [of_step(of.angle), reaction]


def table(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """All pairs with friction: reaction, moment or deviation, relative velocity, power; their sum, and what the drive has."""
    of, k, study = _friction(project), project.force_index, project.study
    rows = [[tr("Pair"), tr("F, N"), tr("ρ, mm"), tr("M_f, N·m"), tr("ω, s^{−1}"), tr("φ, °"), tr("V, m/s"), tr("N_f, W")]]
    for index in of.pairs:
        name, force = link_marks.indexed(of.pairs[index].name), number(abs(complex(study.forces.reactions[f"F{index}"].at(k))), 5)
        power = number(float(of.powers[index].at(k)), 4, float(abs(of.total.at(k))) or 1.0)
        if index in of.moments:
            moment, turn = (number(float(np.real(step.at(k))), 4) for step in (of.moments[index], of.turning[index]))
            rho = number(1e3 * float(of.radii[_hinge(of, index)].value))
            rows.append([f"{name} ({index})", force, rho, moment, turn, "−", "−", power])
        else:
            rows.append([f"{name} ({index})", force, "−", "−", "−",
                         fixed(degrees(float(of.deviations[index].at(k))), 2),
                         number(abs(complex(of.sliding[index].at(k))), 4), power])
    left = canvas.title(box, tr("Friction in the pairs"))
    said = _balance(project, of, k)
    place = listed.table_in(canvas, left, rows, ROWS[0], under=7.0 * len(said))
    canvas.lines(complex(box.x0 + 2.0, place.y0 - 6.5), said, 7.0, size_for(said, box.width - 4.0, 3.5))


def _balance(project: Project, of: Friction, k: int) -> list[str]:
    """Number of approximations, power of friction, and what the drive gives: the part that friction takes of it."""
    lines = [tr("Approximations until the reactions stay: {count}").format(count=int(of.approximations)),
             tr("Power of friction N_{{f}} = {power} W; on the input link M_{{f}} = {moment} N·m").format(
                 power=number(-float(of.total.at(k)), 5), moment=number(abs(float(of.on_crank.at(k))), 4))]
    if project.study.driver is None:
        drive, free = (float(power.at(k)) for power in project.study.drive(of.total))
        lines.append(tr("Power of the drive N = {drive} W; without friction {free} W").format(
            drive=number(drive, 5), free=number(free, 5)))
    return lines


def _in_positions(project: Project, options: dict[str, Any]) -> tuple[str, listed.Rows]:
    """Sizes of the reactions with friction in all positions, what drives the crank, and the power of friction."""
    of, study = _friction(project), project.study
    n, forces = len(study.labels), study.forces
    sign, unit = balancing_sign(project), tr("N·m") if study.driver is None else tr("N")
    # A moment has the sign that it has in its graph; of a force in the mesh the size is told.
    drive = study.balance["M"].value if study.driver is None else np.abs(forces.balancing.value)
    columns = [(tr("F_{{{index}}}, N").format(index=index), np.abs(np.broadcast_to(forces.reactions[f"F{index}"].value, (n,))))
               for index in of.pairs]
    columns += [(f"{sign}, {unit}", np.broadcast_to(drive, (n,))), (tr("N_f, W"), np.broadcast_to(of.total.value, (n,)))]
    return tr("Reactions with friction in all positions"), graphs.rows(enumerate(study.labels), columns)


positions = listed.Upright(_in_positions)
"""The table of these sizes."""


def power_graph(project: Project) -> graphs.Column:
    """The graph of that power."""
    every, step, course = project.course.turned, _friction(project).total, project.course.forces.friction
    assert course is not None
    values = [np.broadcast_to(np.real(of.total.value), np.shape(at)) for of, at in
              ((course, every), (_friction(project), project.cycle.turned))]
    sign, unit = tr("N_f, W").split(", ")
    return (graphs.Quantity("graph-N", sign, unit, (graphs.Curve("", step.path, every, *values),)),)


power = graphs.CycleView(lambda project: tr("Power of friction in the pairs"),
                               lambda project, options: [power_graph(project)], 0.5, diagrams.GRAPH_SIZES)
"""Power of friction in all pairs over the whole cycle."""


def mechanism_place(project: Project, view: ViewPlace) -> BorderNode:
    """The mechanism with its reactions to scale."""
    return leaf(view.box, _scheme(project).need(view.box, (150.0, 90.0)))


def pairs_place(project: Project, view: ViewPlace) -> BorderNode:
    """A picture of each pair with friction."""
    return stepped(view, (200.0, 120.0), lambda width, height: pairs_area(project, width, height), 1.5)


def table_place(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each pair."""
    found = project.study.forces.friction
    return table_node(len(found.pairs) + 1 if found else 1, 34.0, (5.0, ROWS[0]), (0.7 * view.box.width, inf))


def positions_place(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each position."""
    return table_node(len(project.cycle.labels) + 1, 12.0, (4.6, ROWS[1]), (0.7 * view.box.width, inf))
