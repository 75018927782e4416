"""Tables: values in the given position, what the task gives, structure, velocities and forces at all positions."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.construction.indices import on_link
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import needs, size_in, widened
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import decompose
from tmm_sheets.numbers import Sizes, decimals_for, fixed, is_zero, number, written
from tmm_sheets.sheets.border_solver import BorderNode, table_node
from tmm_sheets.sheets.components import graphs, listed
from tmm_sheets.sheets.linkage import kinematic_frames, link_marks
from tmm_sheets.sheets.player import once
from tmm_sheets.words import marked, tell, tr, tr_in

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Segment, Step
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

ROW, HEAD = 7.0, 8.0
"""Highest row of the tables, and height of the title over one, mm."""
Rows = list[list[str]]


@once
def _tables(project: Project) -> list[tuple[str, Rows]]:
    """Titles and rows of the tables of the values at the given position (manual 003, section 4, works 3-6)."""
    label = project.cycle.labels[project.force_index]
    found = [(tr("Velocities and accelerations (position {label})").format(label=label), _points(project)),
             (tr("Links: angular quantities and inertia loads"), _links(project)), (tr("Technological loads"), _loads(project))]
    return [(title, rows) for title, rows in found if len(rows) > 1]


def _extent(project: Project) -> tuple[int, float]:
    """Rows that the tables have together, and the height of their titles, mm."""
    return sum(len(rows) for _, rows in _tables(project)), HEAD * len(_tables(project))


def values_place(project: Project, view: ViewPlace) -> BorderNode:
    """Tables of points, links and loads."""
    return table_node(*_extent(project), (5.0, 7.0), (140.0, 200.0))


def values(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """These tables, one under another."""
    count, heads = _extent(project)
    row = min((box.height - heads) / count, ROW)
    if row < 4.0:
        raise CannotBuild(tell("the tables of the given position need more room: {row:.1f} mm for a row").format(row=row),
                          tell("make the place of given_position.values higher in templates/sheets"))
    link_marks.tell_signs(project, canvas, box)
    y = box.y1
    for text, rows in _tables(project):
        canvas.text(complex(box.centre.real, y - 5.5), text, 3.5, "centre")
        first = (0.12 if len(rows[0]) > 3 else 0.3) * box.width
        y = listed.table_in(canvas, Box(box.x0, y - HEAD - row * len(rows), box.x1, y - HEAD), rows, row, [first]).y0


def values_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the tables can do with, mm."""
    count, heads = _extent(project)
    return [(width, heads + row * count) for row in (7.0, 6.4, 5.6, 4.6) for width in (176.0, 140.0)]


def _points(project: Project) -> Rows:
    """Moving points side by side: name, speed, acceleration."""
    study, m, k = project.study, project.mechanism, project.force_index
    names = [name for name in study.positions.points if name not in m.fixed and name in study.velocities.points]
    speed, acceleration = study.velocities.points, study.accelerations.points
    of_speed, of_acceleration = (Sizes(step.value for step in of.values()).at(k) for of in (speed, acceleration))
    cells = [[link_marks.indexed(name), _size(speed[name], k, of_speed), _size(acceleration[name], k, of_acceleration)]
             for name in names]
    half = (len(cells) + 1) // 2
    head = [tr("Point"), tr("V, m/s"), tr("a, m/s²")]
    return [head * 2, *([*left, *right] for left, right in zip(cells[:half], [*cells[half:], ["", "", ""]], strict=False))]


def _links(project: Project) -> Rows:
    """Angular velocity, angular acceleration, force and couple of inertia of each link."""
    study, m, k = project.study, project.mechanism, project.force_index
    loads, couples, _ = study.loads
    omega, epsilon, forces = study.velocities.omega, study.accelerations.epsilon, study.forces
    of_omega, of_epsilon = (Sizes(step.value for step in of.values()).at(k) for of in (omega, epsilon))
    of_epsilon = max(of_epsilon, of_omega**2)  # where no link speeds up, what is left is the rounding of normal accelerations
    rows = [[tr("Link"), tr("ω, s^{−1}"), "ε, " + tr("s^{−2}"), tr("F_i, N"), tr("M_i, N·m")]]
    for name, link in m.links.items():
        inertia = next((load.vector for load in loads.get(name, ()) if load.role == "inertia"), None)
        couple = next((c for c in couples.get(name, ()) if link.inertia), None)
        sense = m.shown_sense(name)
        rows.append([name, _signed(omega.get(name), k, of_omega, sense), _signed(epsilon.get(name), k, of_epsilon, sense),
                     _size(inertia, k, forces.force_size(k)), _size(couple, k, forces.moment_size(k))])
    return rows


def _loads(project: Project) -> Rows:
    """Technological forces and moments with what is our own assumption among them."""
    turned = project.cycle.turned[project.force_index]
    accepted = {f.name: f.accepted for f in project.variant.force} | {m.name: m.accepted for m in project.variant.moment}
    rows = [[tr("Load"), tr("Magnitude"), tr("Data")]]
    for load in project.applied:
        unit = tr("N") if load.point is not None else tr("N·m")
        data = tr_in("load", "taken") if accepted[load.name] else tr_in("load", "given")
        rows.append([link_marks.indexed(load.name), f"{number(float(np.ravel(load.magnitude(turned))[0]))} {unit}", data])
    return rows


def _size(step: Step | None, k: int, kind: float) -> str:
    return "−" if step is None else number(float(abs(step.at(k))), kind=kind)


def _signed(step: Step | None, k: int, kind: float, sense: float) -> str:
    """A number with its sign."""
    return "−" if step is None else number(sense * float(np.real(step.at(k))), kind=kind)


UNITS = {"deg": "°", "rad/s2": marked("s^{−2}"), **{unit.replace(" ", "").replace("·", "").replace("²", "2"): unit for unit in (
    marked("m"), marked("mm"), marked("cm"), marked("kg"), marked("kg·m²"), marked("N"), marked("kN"), marked("N·m"),
    marked("kN·m"), marked("rad/s"), marked("rpm"), marked("m/s"), marked("m/s²"), marked("MPa"), marked("kW"))}}
"""How the units of a task are written on paper, by their common spelling; others stand as they are."""


@once
def _given(project: Project) -> tuple[str, Rows]:
    """What the task gives as it prints it; nothing where a mechanism has no length of its own.

    Where the file does not say: where the fixed hinges are, lengths in the order in which the links are put together, then masses
    and moments of inertia.
    """
    heavy = any(link.mass for link in project.mechanism.links.values())
    title = tr("Given data") if project.given else tr("Given sizes and masses") if heavy else tr("Given sizes")
    return title, [[tr("Quantity"), tr("Value")], *map(list, given_quantities(project))]


links = listed.Upright(lambda project, options: _given(project), folds=(1, 2, 3))
"""The table of what the task gives."""


def given_quantities(project: Project) -> Iterator[tuple[str, str]]:
    """Letters with unit, and number: as the task prints them, or of frame and links, where a synthesis may have found them.

    Of the latter nothing that is zero.
    """
    if project.given:
        yield from ((", ".join(filter(None, (given.symbol, tr(UNITS.get(given.unit, given.unit))))), written(given.number))
                    for given in project.given)
        return
    m = project.mechanism
    of_groups = [(*g.lengths, g.offset, *getattr(g, "sides", ()), *(leg.length for leg in getattr(g, "legs", ())))
                 for g in m.groups]
    lengths: list[Any] = [m.crank.length, *chain(*of_groups), *(p.distance for p in m.points)]
    driving = m.drive or m.crank
    given_of_input: list[Any] = [*getattr(driving, "place", ()), driving.speed, driving.acceleration]
    # Of a cylinder it is a segment of the plans that no two points of the mechanism tell.
    drawn = {"m/s": " = |pr|·μ_V"} if m.drive is not None and not m.drive.slides else {}
    for name, at in ((name, at) for name, at in m.fixed.items() if name in link_marks.drawn_points(project.study.positions)):
        for axis, value in (("x", at.real), ("y", at.imag)):
            if not is_zero(value, float(m.crank.length)):
                yield f"{axis}_{{{name}}}, {tr('m')}", number(value)
    links = sorted(m.links.values(), key=lambda link: (len(link.name), link.name))
    of_links = [getattr(link, name) for name in ("mass", "inertia") for link in links]
    for n, value in enumerate((*lengths, *given_of_input, *of_links)):
        given = getattr(value, "step", value)  # one that a synthesis found has the letters of its step
        if value and getattr(given, "symbol", ""):
            # The other way along its line is no length.
            unit = "m" if n < len(lengths) else given.unit.replace("*", "")
            yield f"{given.symbol}{drawn.get(unit, '')}, {tr(UNITS[unit])}", number(abs(float(value)))


MOST = 14
"""Most columns that can be read at a glance."""

Columns = list[tuple[str, Any]]


def of_points_and_links(project: Project) -> Columns:
    """Accelerations of the moving points, m/s^2, and angular ones of the links, s^-2, at all positions; nothing without points."""
    acc = project.study.accelerations
    sizes = [(f"a_{{{name}}}", np.abs(step.value)) for name, step in acc.points.items() if np.ndim(step.value)]
    found: Columns = [(name, v) for name, v in sizes if not np.allclose(v, v[0])]  # that of the crank pin is the same everywhere
    # That of the crank stands in the table of its running, there positive in its sense.
    crank, speed = project.mechanism.crank.link, project.mechanism.crank.speed
    turning = [(f"ε_{link}", np.real(step.value)) for link, step in acc.epsilon.items() if np.ndim(step.value) and link != crank]
    size = max((float(np.nanmax(np.abs(v))) for _, v in turning), default=0.0) + speed**2  # where none but rounding turns them
    return found + [(name, v) for name, v in turning if not is_zero(np.abs(v).max(), size)] if found else []


def of_pairs(project: Project) -> Columns:
    """Magnitudes of the reactions in all pairs, N, at all positions."""
    pairs: dict[frozenset[str], tuple[str, Any]] = {}
    for name, step in project.study.forces.reactions.items():
        # A pair has one reaction and its opposite: the first that the force analysis finds stands for both.
        links = frozenset(name[1:].split(",") if "," in name else name[1:])
        pairs.setdefault(links, (link_marks.indexed(name), np.abs(step.value)))
    return [pair for pair in pairs.values() if np.ndim(pair[1])]


def _cells(project: Project, columns: Columns) -> Rows:
    """Heads, and a row for each drawn position; no column of too many, or of such that have no number somewhere."""
    told = columns if len(columns) <= MOST and all(np.isfinite(values).all() for _, values in columns) else []
    return graphs.rows(project.cycle.drawn, told)


reactions = listed.Upright(lambda project, options: (tr("Reactions in the pairs, N"), _cells(project, of_pairs(project))))
accelerations = link_marks.SignedTable(lambda project, options: (
    tr("Accelerations of the points, m/s², and of the links, s^{−2}"), _cells(project, of_points_and_links(project))))
"""Tables of reactions and of accelerations at all positions."""


COLUMNS = 7
"""So many columns the table of lengths has in about half of the place; with more it shares the width with that of speeds."""
WIDE = 19.0
"""Width of a column of the table of lengths, mm: that of a number in letters of 3.5 mm."""
LOWEST = 3.9
"""Height of a row, mm, below which letters of 2.5 mm touch its lines."""


def velocity_tables_place(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each drawn position."""
    over = 2 if view.options.get("stacked") else 1
    wide = 30.0 + listed.COLUMN * kinematic_frames.columns(project) / over
    return table_node(over * (len(project.cycle.drawn) + 2), 10.0 * over, (5.0, 7.5),
                       (max(min(wide, 320.0), 0.8 * view.box.width), inf))


def velocity_tables(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Tables of measured segments and of velocities over all positions (manual 000, tables 3.2 and 3.3)."""
    vel, cycle = project.study.velocities, project.cycle
    varying: list[tuple[Segment, Any]] = []
    constant: list[tuple[Segment, Any]] = []
    for seg in vel.plan.segments:
        value = np.broadcast_to(vel.plan.length(seg.tail, seg.head).value, (len(cycle.labels),))
        (constant if np.allclose(value, value[0]) else varying).append((seg, value))
    linear: dict[str, Any] = {}
    for seg, value in varying:
        linear.setdefault(seg.symbol.replace("\u0305", ""), value)
    m = project.mechanism
    turning = [(f"ω_{link}", m.shown_sense(link) * w.value) for link, w in vel.omega.items()
               if np.ndim(w.value) and link in vel.reference]
    speeds = [*linear.items(), *turning]
    stacked = bool(options.get("stacked"))
    mu = _factors(project, canvas)
    if np.ptp(mu):  # what is constant is not so on paper
        varying, constant = [*constant, *varying], []
    lengths = _measured_lengths(project, canvas, varying, [link.removeprefix("ω_") for link, _ in turning])
    width = box.width - 30.0
    lying = listed.COLUMN * (max(len(lengths), len(speeds)) if stacked else len(lengths) + len(speeds)) > width
    folds = 1 if lying or stacked else table_folds(box, len(cycle.drawn), len(lengths), len(speeds))
    # Tables that lie down have the same columns.
    left, right = _table_places(box, len(speeds) if lying and lengths else len(lengths), len(speeds), stacked=stacked, folds=folds)
    if lengths:
        said = [f"{_segment(seg.tail, seg.head)} = {fixed(float(value[0] / mu[0]), 1)}" for seg, value in constant]
        title = "; ".join([tr("Lengths of the segments, mm"), *said])
        table_over_positions(project, canvas, left, title, lengths, 1, lying=lying, folds=folds)
    if speeds:
        title = tr("Linear, m/s, and angular, rad/s, velocities") if turning else tr("Linear velocities, m/s")
        if turning:
            link_marks.tell_signs(project, canvas, box)
        table_over_positions(project, canvas, right, title, speeds, 3, lying=lying, folds=folds)


def _measured_lengths(project: Project, canvas: Canvas, varying: list[tuple[Segment, Any]],
                      turning: list[str]) -> list[tuple[str, Any]]:
    """Captions and lengths, mm, of the segments to be measured.

    They are what the speeds come from: the vectors of the plans, and the segments that the links ``turning`` have there.
    """
    lengths = _lengths_on_rockers(project, canvas)
    mu, vel = _factors(project, canvas), project.study.velocities
    drawn = {_segment(seg.tail, seg.head): value / mu for seg, value in varying}
    for q, b in (vel.reference[link][2:] for link in turning):
        if _segment(q, b) not in drawn and _segment(b, q) not in drawn:
            drawn[_segment(q, b)] = np.abs(np.asarray(b.value) - np.asarray(q.value)) / mu
    lengths += [(name, v) for name, v in drawn.items() if not any(np.allclose(v, w) for _, w in lengths)]
    return lengths


def _factors(project: Project, canvas: Canvas) -> NDArray[np.float64]:
    """Scale factor of the velocity plan of each position of the cycle."""
    drawn = kinematic_frames.factors_of(canvas.frames, project.study.velocities.plan)
    return np.array([drawn.get(i, canvas.scales["velocities"].mu) for i in range(len(project.cycle.labels))])


def _segment(tail: Step, head: Step) -> str:
    return f"|{link_marks.indexed(tail.name)}{link_marks.indexed(head.name)}|"


def _lengths_on_rockers(project: Project, canvas: Canvas) -> list[tuple[str, Any]]:
    """Segments of rockers with a slot: the coincident point's velocity, the way to the block, velocities of carried hinges."""
    vel = project.study.velocities
    pos = vel.positions
    mu_v, mu_l = _factors(project, canvas), canvas.scales["positions"]
    pole = vel.plan[str(vel.plan.pole)]
    lengths: list[tuple[str, Any]] = []
    hinges = {name for g in pos.mechanism.groups for name in g.outer}
    for g in pos.mechanism.groups:
        if (j := g.kind.rocker(g)) is not None:
            p, q = g.outer
            coincident = vel.plan.length(pole, vel.coincident[on_link(p, j)])
            lengths.append((f"|p{link_marks.indexed(on_link(p.lower(), j))}|", coincident.value / mu_v))
            lengths.append((f"{q}{p}", pos.plan.length(pos.points[q], pos.points[p]).value / mu_l.mu))
            carried = [x.name for x in pos.mechanism.points if x.link == j and x.name in hinges]
            lengths += [(f"|{q.lower()}{link_marks.indexed(x.lower())}|", vel.plan.length(pole, vel.points[x]).value / mu_v)
                        for x in carried]
    return lengths


def table_folds(box: Box, positions: int, *columns: int) -> int:
    """Parts of the tables side by side: two, where so many rows are too low for the usual letters and the columns leave room."""
    wide = sum(2 * (10.0 + WIDE * count) for count in columns) + 10.0
    return 2 if size_in(_row(box, positions)) < 3.5 and wide <= box.width else 1


def _row(place: Box, positions: int) -> float:
    return min((place.height - 15.0) / (positions + 2), 7.5)


def _table_places(box: Box, columns: int, speeds: int, *, stacked: bool, folds: int) -> tuple[Box, Box]:
    """Places of the tables of lengths and of speeds with so many columns; the second has all of it without any of the first."""
    if not columns:
        return box, box
    if stacked:
        middle = (box.y0 + box.y1) / 2
        return Box(box.x0, middle + 2.0, box.x1, box.y1), Box(box.x0, box.y0, box.x1, middle - 2.0)
    few = (0.45 * box.width - 10.0) / columns if columns <= COLUMNS else 0.0
    one = min(WIDE, max(few, (box.width - 30.0) / (columns + speeds)))
    left = Box(box.x0, box.y0, box.x0 + folds * (10.0 + one * columns), box.y1)
    return left, Box(left.x1 + 10.0, box.y0, box.x1, box.y1)


NOTHING = 1e-4
"""Share of the greatest number of a table below which a column shows that it is nothing."""


def table_over_positions(project: Project, canvas: Canvas, place: Box, title: str, columns: list[tuple[str, Any]],
                          decimals: int, *, lying: bool = False, folds: int = 1) -> None:
    """A column for each quantity, a row for each position that is drawn; the other way round ``lying``; a dash for no number.

    In so many ``folds`` side by side.

    ``decimals`` unless a column's numbers are too small for them, but for those that are nothing beside the others. What has no
    room at all is named in a remark.
    """
    greatest = {name: float(np.nanmax(np.abs(v), initial=0.0)) for name, v in columns}
    places = {name: decimals_for([size], decimals) if size > NOTHING * max(greatest.values()) else decimals
              for name, size in greatest.items()}
    cells = [[tr("No."), *(name for name, _ in columns)],
             *([label, *(fixed(float(v[i]), places[name]) for name, v in columns)] for i, label in project.cycle.drawn)]
    if lying:
        cells = [list(row) for row in zip(*cells, strict=True)]
        room = max(int((place.height - 9.0) / LOWEST), 2)
        if len(cells) > room:
            canvas.note(place, tr("The table has no room for {names}").format(names=", ".join(row[0] for row in cells[room:])))
            cells = cells[:room]
    cells = listed.folded(cells, folds)
    row = min((place.height - 9.0) / len(cells), 7.5) if lying else _row(place, len(cells) - 1)
    # A head that is too long goes on in a second line: beside a larger one nobody reads it.
    head = [title] if letter(title, 3.5).width <= place.width else [part for part in title.partition("; ")[::2] if part]
    begin = complex(place.centre.real, place.y1 - (5.0 if len(head) == 1 else 2.2))
    canvas.lines(begin, head, 5.0, size_for(head, place.width, 3.5), "centre")
    height, count = size_in(row), len(cells[0]) // folds - 1
    if sum(needs(cells, height)) > place.width:
        height = 2.5  # numbers that touch the lines cannot be read
    widths = widened([10.0, *[(place.width / folds - 10.0) / count] * count] * folds, cells, height)
    canvas.table(complex(place.x0, place.y1 - 9.0), widths, cells, row, height)


STRUCTURE = 200.0
"""Width beyond which the table of groups, of five short columns, is not drawn apart, mm: a row is to be read as one."""


def structure_place(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each group."""
    return table_node(len(project.mechanism.groups) + 1, 26.0, (7.0, 7.0), (122.0, 170.0))


def structure(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Structure of the mechanism: mobility by Chebyshev, formula of structure, Assur groups."""
    m = project.mechanism
    moving, pairs = len(m.links), len(m.pairs)
    spare = max(0.0, box.width - STRUCTURE) / 2
    box = box.inset(spare, 0.0, spare, 0.0)
    inside = canvas.title(box, tr("Structure of the mechanism"))
    lines = (f"W = 3n − 2p_5 − p_4 = 3·{moving} − 2·{pairs} − 0 = {m.mobility}", m.structure)
    canvas.lines(complex(box.x0 + 2.0, inside.y1 - 6.0), lines, 7.0)
    if not m.groups:
        return
    rows = [[tr("Group"), tr("Class"), tr("Order"), tr("Kind"), tr("Pairs")],
            *([g.lettered, g.kind.roman, str(g.kind.order), found.kind.told(found), ", ".join(found.kind.joints(found))]
              for g, found in zip(reversed(m.groups), decompose(m), strict=True))]
    widths = [0.17, 0.15, 0.2, 0.22, 0.26]
    canvas.table(complex(box.x0, inside.y1 - 16.5), widened([w * box.width for w in widths], rows, 3.5), rows, 7.0, 3.5)
