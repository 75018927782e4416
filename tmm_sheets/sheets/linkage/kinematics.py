"""Views of the kinematic study: position plans, velocity plans, acceleration plan, tables."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from itertools import pairwise
from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.scale import ENLARGEMENTS, Scale, handy, times
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import SMALLEST, Align, Canvas, Label
from tmm_sheets.drawing.ink import segment_inside
from tmm_sheets.drawing.ink_index import distance
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.drawing.text_layout import TOGETHER
from tmm_sheets.numbers import is_zero, number
from tmm_sheets.sheets.border_solver import LETTERED, VECTOR
from tmm_sheets.sheets.components import flat_crossings, graphs
from tmm_sheets.sheets.linkage import diagrams, kinematic_frames, link_marks
from tmm_sheets.sheets.player import SHORTEST, PlanFrame, PlayerStage, joined, pick, play, stage, together
from tmm_sheets.words import tr, tr_in

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Step
    from tmm_sheets.mechanism.model import Mechanism
    from tmm_sheets.methods.linkage.cycle import Cycle, Strokes
    from tmm_sheets.methods.linkage.positions import Positions
    from tmm_sheets.project import Project

def position_plans(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Combined position plans with path marks and the force graph over the path."""
    cycle, k, pos = project.cycle, project.force_index, project.study.positions
    graph = kinematic_frames.graph_height(project, options)
    frame = kinematic_frames.positions(project, canvas, box, options)
    canvas.title(box, tr("Positions of the mechanism"), str(frame.scale))
    flat_crossings.warn(project, canvas, box, pos.plan, (i for i, _ in cycle.drawn))
    _swing(project, canvas, box)
    _nominal(project, canvas, box)
    canvas.scales["dead-positions"] = frame.scale
    every = stage(canvas, pos.plan, None, frame)
    _crank_circle(project, every)
    _paths(project, every, Box(box.x0 + 2.0, box.y0, box.x1 - 2.0, box.y1 - 18.0))
    of = canvas.of
    for i, label in cycle.drawn:
        if i != k:
            canvas.of = f"position plan {label}"
            link_marks.draw(every.position(i), pos, "thin")
    canvas.of = f"position plan {cycle.labels[k]}"
    s = every.position(k)
    link_marks.draw_guides(s, pos)
    link_marks.draw(s, pos, "main")
    canvas.of = of
    diagrams.draw_indicators(project, every)
    _position_numbers(project, s)
    _point_letters(project, s)
    link_marks.number_links(s, pos)
    _rotations(project, s)
    if cycle.strokes is not None and project.variant.cycle is not None and project.variant.cycle.working:
        _strokes(project, s, cycle.strokes)
    if options.get("angles"):
        _named_angles(project, s)
    if graph:
        below = kinematic_frames.graph_below(project)
        y = box.y0 if below else box.y1 - 20.0 - graph
        _force_graph(project, every, Box(box.x0, y, box.x1, y + graph), below)


def _swing(project: Project, canvas: Canvas, box: Box) -> None:
    """How far a crank that only swings could go, and the groups that end it."""
    limits = project.swing_limits
    if limits is None or None in limits.angles:
        return
    low, high = (number(round(float(angle or 0.0), 2)) for angle in limits.angles)
    canvas.note(box, tr("The crank could swing from {low}° (limit of group {first}) to {high}° (limit of group {last})").format(
        low=low, high=high, first=limits.groups[0], last=limits.groups[1]))


def _nominal(project: Project, canvas: Canvas, box: Box) -> None:
    """That the strokes were divided by K, and how far from the dead positions their ends are then."""
    cycle, strokes = project.variant.cycle, project.cycle.strokes
    if cycle is None or cycle.division != "nominal" or cycle.start != "dead" or cycle.working is None or strokes is None:
        return
    canvas.note(box, tr("The strokes are divided by K = {k}: positions {first} and {last} are {angle}° beside the dead positions")
                .format(k=number(float(cycle.coefficient or 0.0)), first=project.cycle.labels[0],
                        last=project.cycle.labels[cycle.working], angle=number(abs(degrees(strokes.begin)), 2)))


def _crank_circle(project: Project, s: PlayerStage) -> None:
    """The circle of the crank pin; of a crank that only swings the arc it goes through, and a little more."""
    cycle, c = project.cycle, project.mechanism.crank
    if not cycle.swings:
        play(s, [c.pin], "thin", only="circle")
        return
    radius = c.length / s.frame.mu[1]
    low, high = sorted(float(cycle.world(turned)) for turned in (0.0, cycle.period))
    low -= BEYOND_SWING / radius
    high = min(high + BEYOND_SWING / radius, low + 2 * pi)
    s.pen(c.pin, "construction", c.pivot, c.pin).arc(s.at(c.pivot), radius, low, high, "thin")


BEYOND_SWING = 5.0
"""How far the arc of a crank that swings is drawn beyond both of its ends, mm."""


def _paths(project: Project, s: PlayerStage, room: Box) -> None:
    """Paths of the hinges and of the centres of mass, thin, through many positions; of what groups bring along if it is free."""
    turned = project.cycle.ring
    pos = project.study_at(turned, tuple(map(str, range(len(turned))))).positions
    m = pos.mechanism
    free = (name for g in m.groups for name in g.kind.carried(g) if name not in [point for point, _ in g.kind.guided(g)])
    for name in (*(p.name for p in m.points), *free):
        if np.ndim(pos.points[name].value):
            s.pen(pos.points[name], "curve").polyline(s.frame(np.asarray(pos.points[name].value)), "thin")
    for name in dict.fromkeys(name for g in m.groups for _, name in g.kind.guided(g)):
        if m.guides[name].link == m.frame:
            _guide_line(project.study.positions, s, name, room)


def _guide_line(pos: Positions, s: PlayerStage, name: str, room: Box) -> None:
    """Centre line of a fixed guide over the path of its slider and beyond, as far as there is room: not into the title."""
    u, q = (complex(of[name].at(0)) for of in (pos.guide_directions, pos.guide_points))
    on = [point for g in pos.mechanism.groups for point, guide in g.kind.guided(g) if guide == name]
    t = ((np.concatenate([np.atleast_1d(pos.points[p].value) for p in on]) - q) * np.conj(u)).real
    inside = segment_inside(room, s.frame(q + u * np.nanmin(t)) - 24.0 * u, s.frame(q + u * np.nanmax(t)) + 24.0 * u)
    if inside is not None:
        s.pen(pos.guide_directions[name], "axis").line(*inside, "centre")


def _position_numbers(project: Project, s: PlayerStage) -> None:
    """Numbers at the crank pin and the hinges, and at marks on the paths of sliders; with letters where paths are close."""
    pos, m = project.study.positions, project.mechanism
    sliding, paths = on_fixed_guides(m), list[Points]()
    pivots = {shape.link: s.at(pos.points[name]) for shape in link_marks.shapes(pos) for name in shape.bar if name in m.fixed}
    for name in dict.fromkeys(hinges(m, sliding)):
        z = np.ravel(s.frame(pos.points[name].value))
        _hinge_numbers(project, s, name, pivots.get(m.owner(name), z.mean() - 40j), _close(z, paths))
        paths.append(z)
    on = list(sliding.values())
    for name, guide in sliding.items():
        n = _upper_side(complex(pos.guide_directions[guide].at(0)))
        if on.count(guide) > 1:
            _shared_path(project, s, name, n * (1 if name == next(p for p, g in sliding.items() if g == guide) else -1))
        else:
            z = np.ravel(s.frame(pos.points[name].value))[:, None]
            own_path(project, s, name, n, whose=bool(np.nanmin(np.abs(z - np.concatenate(paths))) < CLOSE))


def hinges(m: Mechanism, sliding: Container[str]) -> Iterator[str]:
    """Points of the hinges, and those that are there for their paths, which have their position numbers beside them."""
    yield m.crank.pin
    yield from (p.name for p in m.points if p.link != m.crank.link and any(p.name in g.outer for g in m.groups))
    for g in m.groups:
        yield from (name for name in g.kind.carried(g) if name not in sliding)
    for link in m.links:
        yield from link_marks.traced(m, link)


def _close(z: Points, paths: Sequence[Points]) -> bool:
    """Whether hinges of one point, shape (n,), stand so near to the path of another that their numbers may be read as its own."""
    return any(sum(distance(path, np.roll(path, -1), at).min() < CLOSE for at in z.tolist()) > 1 for path in paths)


CLOSE = 6.0
"""Distance of a point from another's path, or from its numbered hinges, mm, below which its numbers say whose they are."""


def _numbered(name: str, number: str) -> str:
    """Letter of a point with the number of its position."""
    return f"{link_marks.indexed(name)}({number})"


def _hinge_numbers(project: Project, s: PlayerStage, name: str, middle: complex, named: bool) -> None:
    """Small hinges at a point in all positions but the highlighted one, their numbers away from ``middle``, mm.

    With the letter of the point where it is to be ``named``.
    """
    blocks = [shape.block for shape in link_marks.shapes(project.study.positions)]
    gap = 2.4 if name in blocks else 0.9  # beside the block, too
    for i, _ in project.cycle.drawn:
        here = s.position(i)
        if i != s.k:
            symbols.hinge(here.pen(name, "symbol"), here.at(name), "thin", 0.7)
            label = project.cycle.labels[i]
            here.letters(name, _numbered(name, label) if named else label, here.at(name) - middle, 2.5, gap, leader=False)


def _upper_side(u: complex) -> complex:
    """Unit vector across a guide along ``u``, upwards, to the right of a vertical one."""
    n = 1j * u
    return n if n.imag > 1e-9 or (n.imag > -1e-9 and u.imag < 0) else -1j * u


def _path_mark(s: PlayerStage, name: str, n: complex) -> None:
    """Stroke across a path at a point."""
    s.pen(name, "point").line(s.at(name) - 2.0 * n, s.at(name) + 2.0 * n, "axis")


def on_fixed_guides(m: Mechanism) -> dict[str, str]:
    """Points that slide on fixed guides, with these: one that slides on a moving link has a path like any hinge."""
    return {point: guide for g in m.groups for point, guide in g.kind.guided(g) if m.guides[guide].link == m.frame}


def own_path(project: Project, s: PlayerStage, name: str, n: complex, *, whose: bool = False) -> None:
    """Marks of the only slider on a path: numbers of the working stroke on side ``n`` of it, of the idle one on the other.

    Where others stand close (``whose``) they have its letter, and only those at the ends: between others none can tell its mark.
    """
    cycle = project.cycle
    z = np.asarray(s.frame(project.study.positions.points[name].value))
    for i, _ in cycle.drawn:
        _path_mark(s.position(i), name, n)
    strokes = by_stroke(project, name, [i for i, _ in cycle.drawn if i != s.k])
    along = {i: (z[i] / n).imag for there in strokes for i in there}
    ends = {pick(along, key=along.__getitem__) for pick in (min, max)} if whose else along.keys()
    for side, there in zip((n, -n), strokes, strict=True):
        for crowd in (crowd for crowd in crowds(there, z) if not ends.isdisjoint(crowd)):
            at = complex(sum(z[i] for i in crowd)) / len(crowd)
            said = graphs.ranged([cycle.labels[i] for i in crowd])
            s.position(crowd[0]).letters(name, _numbered(name, said) if whose else said, side, 2.5, 0.6, at + 2.0 * side, False)


def by_stroke(project: Project, name: str, marks: list[int]) -> tuple[list[int], list[int]]:
    """Positions of a slider in which it goes the way of the working stroke, and the others."""
    cycle, pos = project.cycle, project.study.positions
    u = complex(pos.guide_directions[on_fixed_guides(pos.mechanism)[name]].at(0))
    velocity = np.broadcast_to(project.study.velocities.points[name].value, len(cycle.labels))  # an input has one for all
    speed = (velocity * np.conj(u)).real
    working = speed[np.argmax(np.abs(speed))] if cycle.strokes is None else (cycle.strokes.path * np.conj(u)).real
    ahead = speed * (np.sign(working) or 1.0) > -1e-9 * np.abs(speed).max()
    return [i for i in marks if ahead[i]], [i for i in marks if not ahead[i]]


def crowds(marks: list[int], z: Points) -> list[list[int]]:
    """Marks in turn along a path, those that stand too close for numbers of their own together."""
    found: list[list[int]] = []
    for i in marks:
        if found and abs(z[i] - z[found[-1][-1]]) < CROWDED:
            found[-1].append(i)
        else:
            found.append([i])
    return found


CROWDED = 2.8
"""Distance of two marks, mm, below which their numbers do not fit side by side."""


def _shared_path(project: Project, s: PlayerStage, name: str, n: complex) -> None:
    """Marks of one of several sliders on one path: all its numbers on its own side with its letter, those of one place together."""
    drawn = [i for i, _ in project.cycle.drawn]
    for same in together([s.position(i).at(name) for i in drawn], 1.0):
        place = [drawn[n] for n in same]
        here = s.position(place[0])
        _path_mark(here, name, n)
        text = _numbered(name, ", ".join(project.cycle.labels[i] for i in place))
        here.letters(name, text, n, 2.5, 0.6, here.at(name) + (2.0 if s.k not in place else 5.5) * n, False)


def _point_letters(project: Project, s: PlayerStage) -> None:
    """Letters of the points, those of moving ones with the number of the position, and symbols of the centres of mass."""
    m = project.mechanism
    masses = {link.centre for link in m.links.values() if link.mass}
    own = {p.name for p in m.points if not any(p.name in g.outer for g in m.groups)}
    for name, step in link_marks.drawn_points(project.study.positions).items():
        moving, letters = name not in m.fixed, link_marks.indexed(name)
        if name in masses and name in own:
            symbols.centre_of_mass(s.pen(step, "symbol"), s.at(step))
        text = _numbered(name, project.cycle.labels[project.force_index]) if moving and not name[1:] else letters
        s.letters(step, text, 0j if moving else 1 - 0.5j, 3.5, symbols.HINGE + 1.2)


def _rotations(project: Project, s: PlayerStage) -> None:
    """Arrows of angular velocity, and of angular acceleration, of the crank and of every bar that turns."""
    study, k, m = project.study, project.force_index, project.mechanism
    pos, c = study.positions, m.crank
    pivot = s.at(c.pivot)
    radius = max(0.5 * c.length / s.frame.mu[1], 7.0)
    if project.cycle.swings:
        radius = min(radius, kinematic_frames.SWING_ARROW)
    away, crank = link_marks.clear_of_crank(s, pos), study.velocities.omega[c.link]
    symbols.rotation_arrow(s.pen(crank, "symbol"), pivot, radius, away, c.omega, f"ω_{c.link}")
    shapes = link_marks.shapes(pos)
    bars = {shape.link: _along_bar(s, pos, shape) for shape in shapes}
    taken = [along_arrow((pivot, radius, away))]
    for shape in shapes:
        link = shape.link
        w, eps = (of[link] for of in (study.velocities.omega, study.accelerations.epsilon))
        if not shape.bar or link == c.link or abs(w.at(k)) < 1e-9 * c.speed:
            continue
        places = free_arrows(shape, s, pos, np.concatenate([*taken, *(bar for name, bar in bars.items() if name != link)]))
        for step, sign, place, least in ((w, "ω", places[0], 0.0), (eps, "ε", places[1], 1e-9 * c.speed**2)):
            if abs(step.at(k)) > least:
                symbols.rotation_arrow(s.pen(step, "symbol"), *place, float(step.at(k)), f"{sign}_{link}")
                taken.append(along_arrow(place))


_Arrow = tuple[complex, float, complex]
"""Arrow of a rotation: what it goes round, mm, its radius, mm, and the direction of its middle."""
CLEAR = 3.0
"""Distance of an arrow of rotation from other links and arrows that is enough, mm."""


def _along_bar(s: PlayerStage, pos: Positions, shape: link_marks.Shape) -> Points:
    """Points along the line of a link, a millimetre apart."""
    z = [s.at(pos.points[name]) for name in (link_marks.along_bar(s, pos, shape) if shape.bar else (str(shape.block),))]
    return np.concatenate([z, *(np.linspace(a, b, 2 + int(abs(b - a))) for a, b in pairwise(z))])


def along_arrow(arrow: _Arrow) -> Points:
    """Points along an arrow of rotation and under its sign."""
    about, radius, towards = arrow
    u = towards / abs(towards)
    half = symbols.half_arrow(radius)
    return about + u * np.append(radius * np.exp(1j * np.linspace(-half, half, 12)), radius + np.array([2.0, 4.0]))


def free_arrows(shape: link_marks.Shape, s: PlayerStage, pos: Positions, busy: Points) -> tuple[_Arrow, _Arrow]:
    """Arrows of velocity and acceleration of a bar: the first places clear of ``busy`` points, or the clearest.

    Those of a rocker go round its pivot, those of a link that moves stand on each side of it, outwards first.
    """
    base, tip = (s.at(pos.points[name]) for name in shape.ends)
    u = (tip - base) / abs(tip - base)
    if shape.bar[0] in pos.mechanism.fixed:
        longest = max(28.0, 0.9 * abs(tip - base))
        places = [((base, r, u), (base, r + 8.0, u)) for r in (20.0, 28.0, 36.0, 44.0, 52.0, 60.0) if r + 8.0 <= longest]
    else:
        n = 1j * u if (np.conj(1j * u) * (base - s.at(pos.mechanism.crank.pivot))).real > 0 else -1j * u
        middles = [base + t * (tip - base) for t in (0.38, 0.5, 0.28, 0.62, 0.72, 0.2)]
        places = [((middle, 6.0, n), (middle, 6.0, -n)) for middle in middles]

    def room(arrows: tuple[_Arrow, _Arrow]) -> float:
        return min(CLEAR, float(np.abs(np.concatenate([along_arrow(arrow) for arrow in arrows])[:, None] - busy).min()))

    return max(places, key=room)


def _strokes(project: Project, s: PlayerStage, strokes: Strokes) -> None:
    """Working and idle angles of the crank between its dead positions."""
    cycle, c = project.cycle, project.mechanism.crank
    radius = c.length / s.frame.mu[1] + 7.0
    count = project.variant.cycle.working if project.variant.cycle else None
    first = cycle.world(cycle.turned[0])
    last = cycle.world(cycle.turned[count] if count else strokes.end)
    working, idle = tr_in("angle of the crank", "φ_w"), tr_in("angle of the crank", "φ_i")
    pivot, end = s.at(c.pivot), first + cycle.sense * 2 * pi
    # The sign of the idle angle stands near its beginning: about its middle the links of many positions crowd.
    for sign, (a, b), at in zip((working, idle), ((first, last), (last, end)), (0.5, 0.2), strict=True):
        text = f"{sign} = {number(round(degrees(abs(b - a)), 6))}°"
        s.canvas.angle_mark(pivot, min(a, b), max(a, b), radius, text, 3.5, at if b > a else 1 - at)


def _named_angles(project: Project, s: PlayerStage) -> None:
    """Crank and slotted link in the positions that the angles φ_1k and φ_2k belong to, and these angles from position 0 on."""
    plan, cycle, c = project.motion.named_angles, project.cycle, project.mechanism.crank
    if plan is None:
        return
    here = stage(s.canvas, plan, 0, s.frame)
    _, far, *_ = (step.name for step in plan)
    pivot, start = here.at(c.pivot), float(cycle.world(cycle.turned[0]))
    angles = {k: float(plan[f"φ_{k}k"].value) for k in (1, 2)}
    shorter, longer = sorted(angles, key=lambda k: abs(angles[k]))
    for k, angle in angles.items():
        name = f"{c.pin}_{k}k"
        for end in (c.pivot, far):
            here.pen(name, "link", end, name).line(here.at(end), here.at(name), "hidden")
        here.dot(name, 0.8, "main")
        here.letters(name, f"{c.pin}_{{{k}k}}", here.at(name) - pivot, gap=1.5)
        # The shorter arc lies outside: each has a part with no other beyond it, and is named there.
        lo, hi = sorted((start, start + cycle.sense * angle))
        text = f"φ_{{{k}k}} = {number(round(degrees(angle), 2), 5)}°"
        radius = c.length / s.frame.mu[1] + (9.0 if k == longer else 14.0)
        beyond = (1 + angles[shorter] / angle) / 4 if k == longer else 0.2  # the link in the analysed position
        here.pen(f"φ_{k}k", "dimension").angle_mark(pivot, lo, hi, radius, text, share=0.5 + beyond * cycle.sense)


def _force_graph(project: Project, s: PlayerStage, box: Box, below: bool) -> None:
    """Force over the path: the path marks carried over onto the abscissa, ordinates over every mark.

    A stroke too short for that on the plans has an abscissa of its own, enlarged.
    """
    cycle, canvas = project.cycle, s.canvas
    strokes, force = cycle.strokes, kinematic_frames.graph_force(project)
    assert strokes is not None
    tried = [(turned, np.asarray(force.shown(turned, 0))) for turned in force.over_way()]
    diagrams = [(turned, values) for turned, values in tried if np.any(values)]
    top, low = (of(0.0, *(float(of(values)) for _, values in diagrams)) for of in (max, min))
    scale = pick(project, canvas, "force-graph", "μ_F", tr("N/mm"), (top - low) / (box.height - 18.0))
    y0 = box.y0 + 5.0 - low / scale.mu
    high = y0 + top / scale.mu
    a, b = (s.frame(strokes.origin + strokes.path * t).real for t in (0.0, strokes.length))
    way = link_marks.indexed(strokes.output) if strokes.output[0] == "S" else f"S_{{{strokes.output}}}"
    ways = tr("{quantity}, m").format(quantity=way)
    load, back = f"loads/{force.name}", a > b  # the way is counted from where the stroke begins
    u = -1 if back else 1
    inward, outward = _SIDES[::u]
    rear, edge = (box.x0, box.x1)[::u]
    room = edge - u * (1.5 + letter(ways, 3.5).width)
    # As many times as long as on the plans as it takes to be read (GOST 2.302).
    enlarged = next(t for t in (1.0, *ENLARGEMENTS[:-1]) if t * abs(b - a) >= READABLE or t == ENLARGEMENTS[-2])
    start = a if enlarged == 1 else _nearer(rear, (a + b - enlarged * (b - a)) / 2, room - 14.0 * u - enlarged * (b - a))

    def along(x: Any) -> Any:
        return start + enlarged * (x - a)

    tip = _nearer(start, along(b) + 14.0 * u, room)
    graph = canvas.placed("loads", "", complex(start, y0), (s.frame.mu[0] / enlarged, scale.mu), pi * back, back)
    pen = canvas.tracing("axis", load, "", graph)
    pen.arrow(complex(start, y0 + low / scale.mu), complex(start, high + 9.0), "axis", 3.5)
    pen.arrow(complex(start, y0), complex(tip, y0), "axis", 3.5)
    pen.text(complex(start - 2.0 * u, high + 5.0), tr("{quantity}, N").format(quantity=link_marks.indexed(force.name)), 3.5, inward)
    pen.text(complex(tip + 1.5 * u, y0 - 1.2), ways, 3.5, outward)
    # Beside the end of the graph, or above it where there is no room.
    said = [str(scale)] if enlarged == 1 else [str(scale), str(Scale("μ_S", s.frame.mu[0] / enlarged, tr("m/mm")))]
    beside, room = along(b) + 3.0 * u, edge - u * max(letter(text, 3.5).width for text in said)
    for n, text in enumerate(said):
        lower = 6.25 * n if (room - beside) * u >= 0 else 6.25 * (n - len(said) + 1) - 2.5
        canvas.text(complex(_nearer(start, beside, room), high - lower), text, 3.5, outward)
    drawn = [_force_over_path(project, s, strokes, along, diagram, y0, scale.mu) for diagram in diagrams]
    for (line, turned), (tried_at, values) in zip(drawn, diagrams, strict=True):
        canvas.tracing("curve", load, "", graph).polyline(line, "curve")
        later = [turned + turn for turn in np.arange(0, cycle.period, 2 * pi) if np.allclose(force.shown(tried_at + turn), values)]
        if len(drawn) > 1 and (held := ", ".join(filter(None, (_positions_within(cycle, of_turn) for of_turn in later)))):
            off = np.abs(line.imag - y0)
            level = np.flatnonzero(off > off.max() - 1e-6)
            highest = line[level[len(level) // 2]]
            canvas.label(complex(highest), held, 1j if highest.imag > y0 else -1j, 2.5, 1.5)
    count = project.variant.cycle.working if project.variant.cycle else None
    feet: list[tuple[float, str, str]] = []
    for i, label in cycle.drawn:
        here = s.position(i)
        z = here.at(strokes.output)
        acts = [float(np.ravel(force.shown(cycle.turned[i] + turn, side))[0]) for turn in np.arange(0, cycle.period, 2 * pi)
                for side in (-1, 1)]
        if not any(acts) and i not in (0, count):
            continue
        x = along(z.real)
        foot, head = complex(x, y0), complex(x, y0 + max(acts, key=abs) / scale.mu)
        if enlarged == 1:
            here.pen(strokes.output, "construction").line(z, foot if below or head.imag < y0 else head, "thin")
        if below or enlarged > 1 or head.imag < y0:
            canvas.tracing("curve", load, here.label, graph).line(foot, head, "thin")
        feet.append((x, label, cycle.labels[i]))
    for x, label, least in feet:
        pitch = min((abs(x - other) for other, *_ in feet if other != x), default=abs(b - a))
        # Of a position of several turns its first number where all have no room.
        text = label if letter(label, 2.5).width + 1.6 < pitch else least
        canvas.number(complex(x, y0), complex(x + 0.8, y0 + 1.0), text, 2.5, pitch)


def _force_over_path(project: Project, s: PlayerStage, strokes: Strokes, along: Any, diagram: tuple[Any, Any], y0: float,
                     mu: float) -> tuple[Any, Any]:
    """A diagram of a force over the path, from the axis and back to it, mm, and the angles where it acts, rad."""
    turned, values = diagram
    acting = np.flatnonzero(values)
    xs = along(np.real(s.frame(project.study_at(turned, tuple(["" for _ in turned])).positions.points[strokes.output].value)))
    curve = xs[acting] + 1j * (y0 + values[acting] / mu)
    return np.array([complex(curve[0].real, y0), *curve, complex(curve[-1].real, y0)]), turned[acting]


def _positions_within(cycle: Cycle, turned: Any) -> str:
    """First and last of the positions that lie within a stretch of angles, rad: "9…11"."""
    into = np.mod(np.asarray(cycle.turned) - turned[0], cycle.period)
    inside = sorted((float(t), label) for t, label in zip(into, cycle.labels, strict=True) if t <= turned[-1] - turned[0])
    return "…".join(dict.fromkeys(label for _, label in (*inside[:1], *inside[-1:])))


READABLE = 40.0
"""Length of a stroke on the plans, mm, below which its graph of forces has an abscissa of its own."""


_SIDES: tuple[Align, Align] = ("right", "left")
"""How lettering is aligned on the near side of the axis of forces, and beyond the end of the stroke."""


def _nearer(to: float, x: float, y: float) -> float:
    """The one of two numbers that is nearer."""
    return min(x, y, key=lambda z: abs(z - to))


def velocity_plans(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Velocity plans of all positions with one scale factor, packed into rows."""
    plan = project.study.velocities.plan
    layout = kinematic_frames.velocities(project, canvas, box, options)
    many = len(layout.shown) > 1
    canvas.title(box, tr("Velocity polygons") if many else tr("Velocity polygon"), str(layout.scale))
    others = layout.others()
    own = {i: others[mu] for (i, _), mu in zip(layout.shown, layout.mus, strict=True) if mu in others}
    flat_crossings.warn(project, canvas, box, plan, (i for i, _ in layout.shown), own)
    if layout.every > 1:
        canvas.note(box, tr("One velocity polygon of every {count} positions is drawn").format(count=layout.every))
    if small := [label for label, size in layout.sizes(plan).items() if size < LETTERED.least * (1 - 1e-6)]:
        said = tr("Velocity polygons smaller than {least:.0f}{space}mm: positions {labels}")
        canvas.note(box, said.format(least=LETTERED.least, space=TOGETHER, labels=", ".join(small)))
    canvas.scales |= {f"{plan.name}-{n}": scale for n, scale in enumerate(others.values(), 2)}
    tiny: dict[str, list[str]] = {}
    caption = tr("Position {label}")
    height = min(size_for([caption.format(label=label)], place.width, 3.5) for (_, label), _, place, _ in layout.places())
    for ((index, label), span, place, spare), mu in zip(layout.places(), layout.mus, strict=True):
        middle, scale = place.centre + 4.0j, others.get(mu, layout.scale)
        canvas.of = f"velocity plan {label}"
        if many:
            canvas.begin(place, tr("Velocity polygon, position {label}").format(label=label))
        for name in _draw_plan(stage(canvas, plan, index, PlanFrame(scale, middle - span.centre)), "p", symbols_at=not many):
            tiny.setdefault(name, []).append(label)
        foot = complex(middle.real, place.y0 + spare / 2 + 2.0)
        if mu in others:
            canvas.text(foot, str(scale), size_for([str(scale)], place.width, height), "centre")
            foot += 1j * kinematic_frames.FACTOR
        canvas.text(foot, caption.format(label=label), height, "centre")
    canvas.of = "kinematics.velocity_plans"
    if tiny:
        canvas.note(box, tr("Less than 1{space}mm, ≈{space}0: {vectors}").format(
            space=TOGETHER, vectors=_with_positions(tiny) if many else ", ".join(tiny)))


def _with_positions(tiny: dict[str, list[str]]) -> str:
    """Signs of vectors with the labels of the positions they are tiny at; those of the same positions together."""
    there: dict[tuple[str, ...], list[str]] = {}
    for name, labels in tiny.items():
        there.setdefault(tuple(labels), []).append(name)
    one, several = tr("{vectors} (position {at})"), tr("{vectors} (positions {at})")
    return "; ".join((several if len(at) > 1 else one).format(vectors=", ".join(names), at=", ".join(at))
                     for at, names in there.items())


def _draw_plan(s: PlayerStage, pole: str, symbols_at: bool = False) -> list[str]:
    """One velocity or acceleration plan: helper lines, vectors with arrow heads, letters of the points.

    Returns the signs of the vectors that are too short to be drawn; their ends have their letters at one point.
    """
    assert s.k is not None
    points = kinematic_frames.plan_points(s.plan, s.k)
    play(s, over=4.0)
    tiny = _vectors(s, max(abs(z) for z in points.values()), symbols_at)
    z = np.array(list(points.values()))
    centre, small = s.frame(np.mean(z)), max(np.ptp(z.real), np.ptp(z.imag)) / s.frame.mu[1] < LETTERED.least
    # A plan below its floor has smaller letters, and of these the ones that stand clear: the larger plans have them all.
    lettered, height = list[complex](), SMALLEST if small else 3.5
    places = joined({name: s.frame(z) for name, z in points.items()}, tiny)
    for names in sorted(places, key=lambda names: small and pole not in names):
        q = s.at(names[0])
        if small and any(abs(q - other) < CLEAR_LETTER for other in lettered):
            s.dot(names[0])
            continue
        lettered.append(q)
        shown = [link_marks.indexed(s.plan[n].symbol or n) for n in names if n != pole]
        s.dot(names[0])
        # A long row of letters leaves the pole's own to itself.
        rows = ([[pole], shown] if len(shown) > 2 else [[pole, *shown]]) if pole in names else [shown]
        for row in rows:
            s.letters(names[0], ", ".join(row), q - centre if abs(q - centre) > 1 else 0j, height)
    return list(dict.fromkeys(tiny.values()))


CLEAR_LETTER = 6.5
"""Distance of two points from which on their letters stand clear of each other, mm."""


def _vectors(s: PlayerStage, size: float, symbols_at: bool) -> dict[tuple[str, str], str]:
    """Vectors of a plan of some size, with their signs if asked; those too short to be drawn are told by their ends."""
    tiny = {}
    for seg in s.plan.segments:
        a, b = complex(s.value(seg.tail)), complex(s.value(seg.head))
        if is_zero(b - a, size):
            continue
        if abs(b - a) / s.frame.mu[1] < SHORTEST:
            tiny[seg.tail.name, seg.head.name] = seg.symbol
            continue
        s.vector(seg.tail, seg.head)
        if symbols_at:
            # No shorter vector from the same point covers the place of its sign.
            along = [(complex(s.value(other.head)) - a) / (b - a) for other in s.plan.segments if other.tail is seg.tail]
            covered = max((z.real for z in along if abs(z.imag) < 1e-6 and z.real < 0.95), default=0.0)
            at = s.frame(a + (1 + max(covered, 0.0)) / 2 * (b - a))
            s.letters(seg.head, seg.symbol, 1j * (b - a), at=at, on=(seg.tail, seg.head))
    return tiny


def acceleration_plan(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Acceleration plan of the chosen position with normal and Coriolis segments."""
    acc, k = project.study.accelerations, project.force_index
    frame = kinematic_frames.accelerations(project, canvas, box)
    canvas.title(box, kinematic_frames.title_of_accelerations(project, k), str(frame.scale))
    flat_crossings.warn(project, canvas, box, acc.plan)
    _signed_plan(canvas, box, stage(canvas, acc.plan, k, frame), "π")


def _signed_plan(canvas: Canvas, box: Box, s: PlayerStage, pole: str) -> None:
    """A plan with the signs of its vectors; those too short to be drawn are told beside it."""
    if tiny := _draw_plan(s, pole, symbols_at=True):
        canvas.note(box, tr("Less than 1{space}mm, ≈{space}0: {vectors}").format(space=TOGETHER, vectors=""), tiny)


def second_accelerations_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the second acceleration plan can do with, mm; none in which its vectors would be short or their signs crowd."""
    plan, i = project.study.accelerations.plan, kinematic_frames.other_stroke(project)
    real = kinematic_frames.plan_extent(plan, i)
    left, below, right, above = kinematic_frames.ACCELERATIONS
    longest = max(real.width, real.height)
    if not longest > 0:
        return []
    # Wide enough for a title as the other plans have it, if there is room.
    titled = letter(kinematic_frames.title_of_accelerations(project, i), 5.0).width + 0.1
    places = [(size * real.width / longest + left + right + 12.0, size * real.height / longest + below + above + 10.0)
              for size in (160.0, 120.0, 100.0, 80.0)
              if kinematic_frames.longest(plan, [i]) >= VECTOR.least * handy(longest / size) * (1 - 1e-6)
              and kinematic_frames.crowd(plan, i, handy(longest / size)) <= kinematic_frames.TOGETHER_READ]
    return [(max(wide, least), high) for least in (titled, 76.0) for wide, high in places]


def second_accelerations(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Acceleration plan of a position of the other stroke, with a scale factor of its own."""
    acc, k = project.study.accelerations, kinematic_frames.other_stroke(project)
    real = kinematic_frames.plan_extent(acc.plan, k)
    inside = box.inset(*kinematic_frames.ACCELERATIONS).inset(6.0, 5.0, 6.0, 5.0)
    scale = Scale("μ_a", handy(_need(real, inside)), tr("(m/s²)/mm"))
    canvas.title(box, kinematic_frames.title_of_accelerations(project, k), str(scale))
    _signed_plan(canvas, box, stage(canvas, acc.plan, k, PlanFrame(scale, inside.centre - scale.mm(real.centre))), "π")


SMALL = 30.0
"""Size of the analysed velocity plan among the others, mm, below which it is shown once more, enlarged."""
ENLARGED = [t for t in ENLARGEMENTS if t <= 10]
"""Enlargements that a plan has."""


def enlarged_velocities_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the analysed velocity plan, enlarged, can do with, mm; none where it can be read among the others.

    All plans have one scale factor, that of the largest; one next to a dead position leaves the others small.
    """
    plan, k = project.study.velocities.plan, project.force_index
    real = kinematic_frames.plan_extent(plan, k)
    drawn_with = kinematic_frames.factors_of(canvas.frames, plan)
    if (mu := drawn_with.get(k)) is None or (drawn := max(real.width, real.height) / mu) < SHORTEST:
        return []
    if drawn >= SMALL and max(kinematic_frames.longest(plan, [i]) / own for i, own in drawn_with.items()) >= VECTOR.least:
        return []
    around = kinematic_frames.MARGIN, kinematic_frames.HEAD + kinematic_frames.TITLE
    own = VECTOR.least / (kinematic_frames.longest(plan, [k]) / mu)
    longest, fit = max(real.width, real.height), [t for t in ENLARGED if own <= t <= kinematic_frames.LONGEST / drawn]
    return [(max(size * real.width / longest + around[0], 90.0), size * real.height / longest + around[1])
            for size in (t * drawn for t in reversed(fit or ENLARGED[:1]))]


def enlarged_velocities(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The velocity plan of the analysed position enlarged, with the signs of its vectors."""
    plan, k, plain = project.study.velocities.plan, project.force_index, canvas.scales["velocities"]
    real = kinematic_frames.plan_extent(plan, k)
    inside = box.inset(kinematic_frames.MARGIN / 2, kinematic_frames.HEAD / 2, kinematic_frames.MARGIN / 2,
                       kinematic_frames.TITLE + kinematic_frames.HEAD / 2)
    larger = max(t for t in ENLARGED if t * _need(real, inside) <= plain.mu * (1 + 1e-6))
    scale = Scale(plain.symbol, float(f"{plain.mu / larger:.6g}"), plain.unit)
    said = tr("{scale} (enlarged {times})").format(scale=scale, times=times(larger))
    canvas.title(box, tr("Velocity polygon, position {label}").format(label=project.cycle.labels[k]),
                 said if letter(said, 5.0).width <= box.width - 2.0 else str(scale))
    _signed_plan(canvas, box, stage(canvas, plan, k, PlanFrame(scale, inside.centre - scale.mm(real.centre))), "p")


def _need(real: Box, inside: Box) -> float:
    """Scale factor that a plan needs; one whose vectors all have one direction asks for no room across it, up to rounding."""
    nothing = 1e-9 * max(real.width, real.height)
    return max(asks / has for asks, has in ((real.width, inside.width), (real.height, inside.height)) if asks > nothing)


PLANS = "kinematics.position_plans"
SHARED = 4
"""So many marks that have no number of their own on the plans are a crowd."""
SHORTEST_PATH, LONGEST_PATH = 60.0, 260.0
"""Length of the path in the view, mm, below which its numbers crowd still, and beyond which it takes too much of a sheet."""
BEYOND_PATH, BESIDE_PATH, HEAD_PATH = 10.0, 9.0, 16.0
"""Room beyond the ends of the path, beside it for the numbers, over it for the title, mm."""


def enlarged_path_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the enlarged path can do with, mm; none where every mark has its number on the plans."""
    name = _crowded(project, canvas)
    if name is None:
        return []
    span, title = _span(project, canvas, name), letter(_title_of_path(name), 5.0).width
    return [(max(times * span + 2 * BEYOND_PATH, title + 4.0), HEAD_PATH + 2 * BESIDE_PATH + 2.0)
            for times in reversed(ENLARGEMENTS) if SHORTEST_PATH <= times * span <= LONGEST_PATH]


def enlarged_path(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The marks of the path with all their numbers; on the plans only those at its ends keep theirs."""
    name = _crowded(project, canvas)
    assert name is not None
    pos, plain = project.study.positions, canvas.scales["positions"]
    span = _span(project, canvas, name)
    times = next(t for t in reversed(ENLARGEMENTS) if t * span <= LONGEST_PATH and t * span + 2 * BEYOND_PATH <= box.width + 1e-6)
    scale = Scale(plain.symbol, float(f"{plain.mu / times:.6g}"), plain.unit)
    _thin_out(project, canvas, name)
    canvas.title(box, _title_of_path(name), str(scale))
    along = _path_direction(project, name)
    z = scale.mm(np.asarray(pos.points[name].value)) / along
    middle = complex(z.real.min() + z.real.max(), z.imag.min() + z.imag.max()) / 2
    at = complex(box.centre.real, box.y0 + BESIDE_PATH + 1.0)
    s = stage(canvas, pos.plan, None, PlanFrame(scale, at - middle, turn=-float(np.angle(along))))
    half = float(np.ptp(z.real)) / 2 + BEYOND_PATH - 2.0
    s.pen(pos.points[name], "axis").line(at - half, at + half, "centre")
    own_path(project, s, name, 1j)


def _title_of_path(name: str) -> str:
    return tr("Positions of point {point} on its path").format(point=link_marks.indexed(name))


def _path_direction(project: Project, name: str) -> complex:
    """Unit vector along the path of a slider, to the right or, of an upright one, upwards."""
    pos = project.study.positions
    u = complex(pos.guide_directions[on_fixed_guides(pos.mechanism)[name]].at(0))
    return u if u.real > 1e-9 or (u.real > -1e-9 and u.imag > 0) else -u


def _span(project: Project, canvas: Canvas, name: str) -> float:
    """Length of a path on the plans, mm."""
    z = np.asarray(project.study.positions.points[name].value)
    mu: float = canvas.scales["positions"].mu
    return float(np.abs(z[:, None] - z).max()) / mu


def _crowded(project: Project, canvas: Canvas) -> str | None:
    """The slider, alone on its path, whose marks share most numbers on the plans of this sheet; None where hardly any do."""
    if "positions" not in canvas.scales or PLANS not in {part.draw for part in canvas.parts}:
        return None
    guides, points = on_fixed_guides(project.mechanism), project.study.positions.points
    found = {name: len(project.cycle.drawn) - len(_numbers(canvas, points[name])) - 1 for name, guide in guides.items()
             if list(guides.values()).count(guide) == 1 and np.ndim(points[name].value)}
    worst = max(found, key=lambda name: found[name], default=None)
    return worst if worst is not None and found[worst] >= SHARED else None


def _numbers(canvas: Canvas, point: Step) -> list[Label]:
    """Numbers that a point has on the position plans; its own letter is larger."""
    part = next(k for k, part in enumerate(canvas.parts) if part.draw == PLANS and part.title)
    return [label for label in canvas.labels if label.part == part and label.by is not None and label.by.step == point.path
            and label.height < 3.5]


def _thin_out(project: Project, canvas: Canvas, name: str) -> None:
    """Take the numbers off the path on the plans, but for those nearest to its ends."""
    asked, along = _numbers(canvas, project.study.positions.points[name]), _path_direction(project, name)
    far = [(label.anchor / along).real for label in asked]
    ends = {asked[int(pick(far))] for pick in (np.argmin, np.argmax)} if asked else set()
    canvas.labels[:] = [label for label in canvas.labels if label not in asked or label in ends]
