"""Views of the force study: loaded groups with their force plans, the crank, Zhukovsky's lever, the comparison."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.scale import Scale, times
from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import ARROW, KEPT_OFF, Canvas
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import TOGETHER, wrapped
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import clean, decimals_for, fixed, is_zero, number
from tmm_sheets.sheets import border_solver
from tmm_sheets.sheets.border_solver import BorderNode, Figure, Need, leaf
from tmm_sheets.sheets.components import flat_crossings, listed
from tmm_sheets.sheets.linkage import link_marks, moments
from tmm_sheets.sheets.linkage.kinetic_frames import (
    AROUND,
    BAR,
    Couple,
    Shown,
    acting_sides,
    arm_sign,
    arrows,
    balancing_sign,
    clear,
    couple_radius,
    couples_of,
    crank_scheme,
    finest,
    flat,
    hinge_of,
    lever_scheme,
    loaded_plans,
    on_crank,
    on_lever,
    outer_forces,
    polygon,
    scheme,
    scheme_points,
    share_of_arrows,
    terms,
    turned_vectors,
    with_arms,
)
from tmm_sheets.sheets.player import SHORTEST, PlanFrame, PlayerStage, fit_frame, joined, play, stage, together
from tmm_sheets.sheets.views import ViewPlace
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Segment, Step
    from tmm_sheets.mechanism.groups.contexts import ForcePlan
    from tmm_sheets.mechanism.model import StructuralGroup
    from tmm_sheets.methods.linkage.forces import Kinetostatics
    from tmm_sheets.project import Project

ALONG, SAME = 0.05, 0.01
"""Sine of the angle at which two sides of a polygon lie along each other; distance at which they meet, mm."""
ROOM = 6.0
"""Room for labels between a force polygon and its equation, mm."""
UP = 3.0
"""What a force polygon may take of the room under its scale factor where its equation needs it, mm."""
LINE, LINES = 6.25, 3
"""Distance of the lines of that equation and of the values under it, mm, and how many there is always room for."""


OF_FORCE, ON_LEVER = 6.0, 5.0
"""Length of a group's links, and of Zhukovsky's lever, that each force on it needs, mm: those of the lever stand all round."""
OF_VALUE = 24.0
"""Room of one force with its value in the line under a force plan, mm, about."""


def each_group(project: Project, view: ViewPlace) -> list[ViewPlace]:
    """Every group of the mechanism in an equal part of a place, the farthest first: down each of the ``columns`` in turn."""
    box, count, columns = view.box, len(project.mechanism.groups), int(view.options.get("columns", 1))
    rows = -(-count // max(columns, 1))
    wide, high = box.width / columns, box.height / max(rows, 1)
    return [ViewPlace("kinetics.group", Box(x, y - high, x + wide, y), {"scheme": 0.45, "group": i})
            for i, (x, y) in enumerate([(box.x0 + (i // rows) * wide, box.y1 - (i % rows) * high) for i in range(count)], 1)]


def group_place(project: Project, view: ViewPlace) -> BorderNode:
    """Loaded scheme and force plans: side by side, or the plans one under another, or the scheme over them: what fills most."""
    nth = int(view.options.get("group", 1))
    if not 1 <= nth <= len(project.mechanism.groups):
        return border_solver.fixed(view.box)
    g = tuple(reversed(project.mechanism.groups))[nth - 1]
    return _place(project, view, scheme(project, g, project.force_index), (92.0, 64.0), (moments.of_group, g),
                  g.kind.force_plans(g), float(view.options.get("scheme", 0.45)), OF_FORCE)


def crank_place(project: Project, view: ViewPlace) -> BorderNode:
    """The crank with its force plan."""
    return _place(project, view, crank_scheme(project, project.force_index), (76.0, 73.0), (moments.of_crank,),
                  [project.mechanism.crank.link], float(view.options.get("scheme", 0.5)))


def lever_place(project: Project, view: ViewPlace) -> BorderNode:
    """Zhukovsky's lever: every force and its arm hangs on it, no view has more labels."""
    return _place(project, view, lever_scheme(project, project.force_index), (112.0, 100.0), (moments.of_lever,), each=ON_LEVER,
                  weight=3.0)


def results_place(project: Project, view: ViewPlace) -> BorderNode:
    """Four lines."""
    return border_solver.table_node(4, 0.0, (7.0, 9.0), (128.0, 170.0))


def _place(project: Project, view: ViewPlace, figure: Figure, least: tuple[float, float], texts: Sequence[Any],
           plans: Iterable[str] = (), share: float = 1.0, each: float = 0.0, weight: float = 1.0) -> BorderNode:
    """A figure with its equations under it and its plans beside it or under both, as costs least.

    ``texts`` are the function of the equations and what it asks for, ``each`` the room of a force along its links.
    """
    under, box, k = moments.room(project, *texts), view.box, project.force_index
    left = box._replace(y0=min(box.y0 + under[0].height, box.centre.imag)) if under else box  # half of it at least
    own = border_solver.over(leaf(box, figure.need(left, least, each), share * weight), under)
    needs = [_force_plan_need(fp, k) for fp in loaded_plans(project, plans)]
    if not needs:
        return own
    of_plans = [leaf(box, need, (1.0 - share) / len(needs)) for need in needs]
    found = [border_solver.joined(axis, [own, border_solver.joined(inner, of_plans, [1.0] * len(needs), 4.0)], [share, 1.0 - share],
                                  4.0)
             for axis, inner in ((0, 1), (0, 0), (1, 0))[::3 - min(len(needs), 2)]]
    for tree in found:
        for _ in range(2):
            tree.settle(box.width, box.height, (16.0, 8.0, 4.0))
    return min(found, key=lambda tree: round(tree.cost(box.width, box.height), 3))


def _force_plan_need(fp: ForcePlan, k: int) -> Need:
    real = polygon(fp, k)[1]
    left, below, right, above = AROUND
    parts = terms(fp.sides)
    half = " + ".join(parts[:(len(parts) + 1) // 2]) + " +"
    asked = sum(side[3] for side in fp.sides) + sum(not any(seg.symbol == side[0] for side in fp.sides) for seg in fp.plan.segments)
    wide = max(78.0, letter(half, 2.5).width + 8.0, OF_VALUE * asked + 6.0)
    return Need((real.width, real.height), (left + right, below + above), (wide, 56.0), finest=finest(fp, k))


def groups(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """All Assur groups of a mechanism, the farthest on top, in equal parts of a place that is as it is written."""
    for view in each_group(project, ViewPlace("kinetics.groups", box, options)):
        group(project, canvas, view.box, view.options)


def group(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Loaded scheme of one Assur group beside the force plans of its links; ``group`` counts from the farthest."""
    k, m = project.force_index, project.mechanism
    nth = int(options.get("group", 1))
    if not 1 <= nth <= len(m.groups):
        raise CannotBuild(tell("the mechanism has no group {nth} to draw, it has {count}").format(nth=nth, count=len(m.groups)),
                          tell("take an arrangement with the view kinetics.groups, or leave kinetics.group out of it"))
    g = tuple(reversed(m.groups))[nth - 1]
    plans = loaded_plans(project, g.kind.force_plans(g))
    left, *places = options.get("places") or group_place(project, ViewPlace("kinetics.group", box, options)).places(box)
    _scheme(project, canvas, left, places.pop(0) if moments.of_group(project, g) else None, g, k)
    for line in (*jumps(project, g.links), *([] if plans else [tr("There are no forces in this position")])):
        canvas.note(left, line)
    for fp, place in zip(plans, places, strict=True):
        force_plan_drawn(project, canvas, place, fp, k)


def jumps(project: Project, links: Collection[str]) -> Iterator[str]:
    """What loads of some links do that jump at the position of the force analysis, and which of their values counts."""
    k = project.force_index
    for load in project.applied:
        found = load.jump(float(project.cycle.turned[k])) if load.link in links else None
        if found is not None:
            unit = tr("N") if load.point is not None else tr("N·m")
            before, after, here = (f"{number(value)}{TOGETHER}{unit}" for value in found)
            yield tr("At position {label} {load} jumps from {before} to {after}; {here} are taken").format(
                label=project.cycle.labels[k], load=link_marks.indexed(load.name), before=before, after=after, here=here)


def _scheme(project: Project, canvas: Canvas, box: Box, under: Box | None, g: StructuralGroup, k: int) -> None:
    """Loaded scheme of a group: its links, all forces and couples on it, the arms of its equations, which stand ``under`` it."""
    pos = project.study.positions
    shown, couples = outer_forces(project, g, k)
    drawn = [shape for shape in link_marks.shapes(pos) if shape.link in g.links]
    hinges, centres = scheme_points(project, g, drawn)
    points = [pos.points[name] for name in (*hinges, *dict.fromkeys(centres))]
    about = complex(pos.place(g.kind.about(g)).at(k))
    share = share_of_arrows(project, g, k, box)
    figure = scheme(project, g, k, share)
    frame = figure.frame(project, canvas, box)
    canvas.of = f"group {g.name}"
    title = tr("Assur group {name} (kind {number})") if g.kind.grade == 2 else tr("Assur group {name} (class III, order 3)")
    canvas.title(box, title.format(name=g.lettered, number=g.kind.number), str(frame.scale))
    s = stage(canvas, pos.plan, k, frame)
    if g.kind.ram(g) is None:
        link_marks.draw_guides(s, pos, g.links)
    link_marks.draw(s, pos, "main", g.links)
    for point in points:
        s.letters(point, link_marks.indexed(point.name), 1 - 0.5j if point.name in pos.mechanism.fixed else 0j, gap=2.8)
    link_marks.number_links(s, pos, g.links, 0.3)  # the middles of bars are left to forces and arms
    for name in centres:
        symbols.centre_of_mass(s.pen(name, "symbol"), s.at(name))
    draw_arms(s, about, with_arms(project, g, shown))
    if g.kind.about(g) in pos.special:
        point = pos.special[g.kind.about(g)].step
        s.dot(point, 0.9, "main")
        s.letters(point, link_marks.indexed(point.name), gap=1.5)
    draw_forces(s, shown, share)
    for c in couples:
        _turning(s, frame(c.at), 10.0, -1 - 0.4j, c)
    _link_couples(project, s, drawn)
    moments.draw(canvas, figure.taken(frame, box), under, moments.of_group(project, g))


def _link_couples(project: Project, s: PlayerStage, drawn: Iterable[link_marks.Shape]) -> None:
    """Couples of the links round their centres of mass, or their first points; moments of friction round their hinges.

    Those round one point stand on its sides by turns: a leader through several arcs would not tell which is named.
    """
    around = Counter[str]()
    for shape in drawn:
        centre = project.mechanism.links[shape.link].centre or shape.block or shape.bar[0]
        for _, c in couples_of(project, shape.link):
            point = hinge_of(project, c) or centre
            n = around[point]
            _turning(s, s.at(point), 7.0 + 4.0 * n, (-1 + 0.2j) * 1j ** (2 * n + n // 2), c)
            around[point] += 1


def _turning(s: PlayerStage, at: complex, radius: float, towards: complex, couple: Couple) -> None:
    """Arrow of a couple."""
    symbols.rotation_arrow(s.pen(couple.step, "symbol"), at, radius, towards, couple.value, couple.symbol)


def draw_forces(s: PlayerStage, shown: Iterable[Shown], share: float = 1.0) -> None:
    """Arrows with their tails at the points they act at, a ``share`` of their usual length."""
    for force, arrow in arrows(shown, share):
        tail, u = s.frame(force.at), force.along
        pen = s.pen(force.step, "vector", *force.on, along=force.step,
                    name=f"{force.step.name}n" if force.symbol.endswith("^n") else "")
        pen.arrow(tail, tail + arrow, "vector")
        pen.label(tail + arrow - 2.0 * u, force.symbol, u + 0.35j * u, 3.5, 2.0)


def draw_arms(s: PlayerStage, about: complex, shown: Sequence[Shown], points: Iterable[complex] = ()) -> None:
    """Perpendiculars from a point to the lines of action; equal arms once. Their signs keep clear of ``points``, mm."""
    seen, centre = list[complex](), s.frame(about)
    feet = [s.frame(force.foot(about)) for force in shown]
    busy = [centre, *points, *(s.frame(force.at) for force in shown), *feet]
    for force in sorted(shown, key=lambda force: -abs(force.vector)):  # forces on one line share the arm of the largest
        tail, foot = s.frame(force.at), s.frame(force.foot(about))
        if abs(foot - centre) < 1.5 or any(abs(foot - f) < 0.6 for f in seen):
            continue
        seen.append(foot)
        same = [arm_sign(other.symbol) for other, f in zip(shown, feet, strict=True) if abs(foot - f) < 0.6]
        pen = s.pen(force.arm, "construction", name=f"h{flat(force.symbol)}")
        if abs(foot - tail) > 0.5:
            pen.ray_line(tail, foot, "thin", 2.0)
        pen.line(centre, foot, "thin")
        pen.dot(foot, 0.35, "thin")
        # On an arm that runs on over a shorter one its letter stands beyond the end of that.
        first = centre + covered_arm(foot - centre, [f - centre for f in feet]) * (foot - centre)
        places = first + np.array((0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)) * (foot - first)
        at = complex(places[np.abs(places[:, None] - np.array(busy)).min(axis=1).clip(max=6.0).argmax()])
        pen.label(at, " = ".join(dict.fromkeys([arm_sign(force.symbol), *same])), 1j * (foot - centre), 2.5, 0.8, thin=KEPT_OFF)
        busy.append(at)


def covered_arm(arm: complex, others: Iterable[complex]) -> float:
    """The part of an arm that shorter ones on its line take, as far as enough for a letter is left of it."""
    along = [(other / arm).real for other in others if abs((other / arm).imag) * abs(arm) < 0.6]
    return max((t for t in along if t > 0 and t * abs(arm) < abs(arm) - 3.0), default=0.0)


def force_plan_drawn(project: Project, canvas: Canvas, box: Box, fp: ForcePlan, k: int) -> None:
    """Force polygon with numbered vertices, its equation and the values found."""
    points, _ = polygon(fp, k)
    canvas.of = fp.plan.name
    inside = box.inset(*AROUND)
    size = project.study.forces.force_size(k)
    sides = acting_sides(fp, k, size)
    extra = [seg for seg in fp.plan.segments if not any(seg.symbol == side[0] for side in fp.sides)]
    asked = [side[:3] for side in sides if side[3]] + [(seg.symbol, seg.tail, seg.head) for seg in extra]
    found = [tr("{quantity} = {value} N").format(quantity=sign.replace(BAR, ""),
                                                 value=newtons(clean(fp.plan.length(tail, head).at(k), size)))
             for sign, tail, head in asked]
    # A force that is nothing has its two numbers like any other, at one point.
    found += [f"{side[0].replace(BAR, '')} = 0" for side in fp.sides if side not in sides]
    frame, lines, height = _over_equation(project, canvas, box, fp, (terms(fp.sides), found))
    tiny = {(tail.name, head.name): tr("{quantity} = {value} N").format(
                quantity=sign, value=newtons(fp.plan.length(tail, head).at(k))).replace(" ", TOGETHER)
            for sign, tail, head, _ in sides if abs(frame(head.at(k)) - frame(tail.at(k))) < SHORTEST}
    small = tr("Less than 1{space}mm: {vectors}").format(space=TOGETHER, vectors=", ".join(tiny.values())) if tiny else ""
    ends = [complex(frame(z)).imag for z in points.values()]
    above, under = inside.y1 + UP - max(ends), min(ends) - box.y0 - ROOM
    if small and letter(small, height).width <= box.width - 4.0 and LINE * (len(lines) + 1) <= under + above + 1e-9:
        lines, small = [*lines, small.replace(TOGETHER, " ")], ""
    # The letters of the lowest side have room over the equation, if the polygon can go up.
    frame = replace(frame, origin=frame.origin + 1j * min(max(LINE * len(lines) - under, 0.0), max(above, 0.0)))
    canvas.title(box, fp.plan.title, str(frame.scale))
    flat_crossings.warn(project, canvas, box, fp.plan)
    s = stage(canvas, fp.plan, k, frame)
    _draw_sides(s, sides, inside.centre)
    for seg in extra:
        s.vector(seg.tail, seg.head)
        s.letters(seg.head, seg.symbol, at=(s.at(seg.tail) + s.at(seg.head)) / 2, on=(seg.tail, seg.head))
    for names in joined({name: frame(z) for name, z in points.items()}, tiny, 0.5):
        s.letters(names[0], ", ".join(sorted(names, key=int)), s.at(names[0]) - inside.centre, 2.5, 0.8)
    if small:
        canvas.note(box, small)
    # Equation and values close under a polygon that does not fill the height of its place.
    low = max(box.y0, min(frame(z).imag for z in points.values()) - ROOM - max(AROUND[1], LINE * len(lines)))
    for k, line in enumerate(reversed(lines)):
        canvas.text(complex(box.centre.real, low + 3.0 + LINE * k), line, height, "centre")


def _over_equation(project: Project, canvas: Canvas, box: Box, fp: ForcePlan,
                   texts: tuple[list[str], list[str]]) -> tuple[PlanFrame, list[str], float]:
    """A force polygon's frame, the lines of its equation and values, and their height.

    Where there is room over the polygon it goes up rather than that they stand in smaller letters than those of its neighbours;
    where there is none it comes out a little smaller.
    """
    k, points, name = project.force_index, list(polygon(fp, project.force_index)[0].values()), fp.plan.name

    def placed(lines: int) -> tuple[PlanFrame, list[str], float]:
        left, below, right, above = AROUND
        inside = box.inset(left, below + LINE * (lines - LINES), right, above)
        frame = fit_frame(project, canvas, name, "μ_F", tr("N/mm"), points, [0j] * len(points), inside, finest(fp, k))
        ends = [complex(frame(z)).imag for z in points]
        lifts = 0.0, max(inside.y1 - max(ends), 0.0)
        least, most = (max(LINES, int((min(ends) + lift - ROOM - box.y0) / LINE)) for lift in lifts)
        found, height = equation(*texts, box.width - 4.0, least)
        higher, larger = equation(*texts, box.width - 4.0, most)
        if larger <= height:
            return frame, found, height
        lift = ROOM + LINE * len(higher) - (min(ends) - box.y0)
        return replace(frame, origin=frame.origin + 1j * max(lift, 0.0)), higher, larger

    first = placed(LINES)
    lines, large = equation(*texts, box.width - 4.0, 2 * LINES)
    if large > first[2] and name not in project.variant.scales:
        smaller = placed(len(lines) + 1)
        if smaller[2] == large and smaller[0].scale.mu < SMALLER * first[0].scale.mu:
            return smaller
        canvas.scales[name] = first[0].scale
    return first


SMALLER = 1.6
"""So many times the scale factor of a force plan may be that its equation stands in letters as high as the others."""


def heads_apart(sides: Sequence[tuple[complex, complex]]) -> list[float | None]:
    """Sizes of arrow heads, mm, where a short side folds back along the one before: both heads have to be seen on its length."""
    sizes: list[float | None] = [None] * len(sides)
    for n, ((a, b), (c, d)) in enumerate(zip(sides, [*sides[1:], *sides[:1]], strict=True)):
        first, second = b - a, d - c
        turned = np.conj(first) * second
        back = abs(b - c) < SAME and turned.real < 0 and abs(turned.imag) < ALONG * abs(turned)
        if back and SHORTEST <= abs(second) < min(abs(first), 2 * ARROW[0]):
            sizes[n] = sizes[(n + 1) % len(sides)] = 0.42 * abs(second)
    return sizes


def _draw_sides(s: PlayerStage, sides: Sequence[tuple[str, Step, Step, bool]], centre: complex) -> None:
    """Sides of a force polygon with their signs outside it, but for those too short to be drawn."""
    heads = heads_apart([(s.at(tail), s.at(head)) for _, tail, head, _ in sides])
    for (sign, tail, head, _), size in zip(sides, heads, strict=True):
        a, b = s.at(tail), s.at(head)
        if abs(b - a) < SHORTEST:
            continue
        s.vector(tail, head, size=size)
        middle, n = (a + b) / 2, 1j * (b - a)
        s.letters(head, sign, -n if (np.conj(n) * (middle - centre)).real < 0 else n, at=middle, on=(tail, head))


def newtons(force: float) -> str:
    """A force for the sheet: tenths of a newton, whole ones from 10 kN on, small forces with four figures."""
    return fixed(force, 0 if force >= 1e4 else 1) if force >= 10 else number(force, 4)


def equation(terms: list[str], values: list[str], width: float, most: int) -> tuple[list[str], float]:
    """Vector equation of a force plan and the values found, on ``most`` lines at most, and the height of their letters, mm.

    Rather on more lines than in smaller letters: all equations of a sheet are to be read alike.
    """
    # A line ends after a sign; a value is not parted from its unit.
    texts = [f"{TOGETHER}+ ".join(terms) + f"{TOGETHER}={TOGETHER}0", "; ".join(value.replace(" ", TOGETHER) for value in values)]
    for height in (3.5, 2.5):
        broken = [_broken(text, height, width, most) for text in texts if text]
        if all(broken) and sum(map(len, broken)) <= most:
            return [line for lines in broken for line in lines], height
    lines = [line for text, count in zip(texts, (2, 1), strict=True) if text for line in wrapped(text, 2.5, count)]
    return lines, size_for(lines, width, 2.5)


def _broken(text: str, height: float, width: float, most: int) -> list[str]:
    """A text on as few lines as it needs; none where so many are not enough."""
    found = (wrapped(text, height, count) for count in range(1, most + 1))
    return next((lines for lines in found if max([letter(line, height).width for line in lines]) <= width), [])


def crank(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The initial link with its forces and arms beside its force plan."""
    k, study, c, driver = project.force_index, project.study, project.mechanism.crank, project.driver
    forces, pos = study.forces, study.positions
    plans = loaded_plans(project, [c.link])
    left, *places = options.get("places") or crank_place(project, ViewPlace("kinetics.crank", box, options)).places(box)
    texts = moments.of_crank(project)
    under = places.pop(0) if texts else None
    centre, pins = pos.points[c.pivot], [pos.points[name] for name in link_marks.crank_pins(pos)]
    pivot, ends = complex(centre.at(k)), [complex(pin.at(k)) for pin in pins]
    shown = on_crank(project, k)
    away = clear(pivot, ends, shown)
    figure = crank_scheme(project, k)
    frame = figure.frame(project, canvas, left)
    canvas.title(left, tr("Input link"), str(frame.scale))
    s = stage(canvas, pos.plan, k, frame)
    # Pitch circle of the wheel on the shaft, and its pitch point.
    if driver is not None and driver.wheel is not None and pos.contact is not None:
        play(s, [pos.contact], "centre", only="circle")
        s.dot(pos.contact, 0.6, "thin")
        s.letters(pos.contact, "P", 1j * complex(np.exp(1j * driver.wheel[1])), gap=1.5)
    link_marks.draw(s, pos, "main", [c.link])
    for point in (centre, *pins):
        s.letters(point, link_marks.indexed(point.name), gap=2.8)
    draw_arms(s, pivot, [force for force in shown if force.at != pivot])
    draw_forces(s, shown)
    symbols.rotation_arrow(s.pen(study.velocities.omega[c.link], "symbol"), s.at(centre), 14.0, away, c.omega, f"ω_{c.link}")
    moment = None if driver is not None else forces.balancing
    if moment is not None and not is_zero(moment.at(k), forces.moment_size(k)):
        _turning(s, s.at(centre), 24.0, away, Couple(balancing_sign(project), 0j, float(moment.at(k)), moment))
    couples = list(_crank_couples(project, s, s.at(centre), away))
    moments.draw(canvas, figure.taken(frame, left), under, texts)
    for line in (*jumps(project, [c.link]), *([] if texts else couples),
                 *([] if plans else [tr("There are no forces in this position")])):
        canvas.note(left, line)
    for fp, place in zip(plans, places, strict=True):
        force_plan_drawn(project, canvas, place, fp, k)


def _crank_couples(project: Project, s: PlayerStage, at: complex, away: complex) -> Iterator[str]:
    """Couples on the crank, its inertia couple among them, as arrows; gives their values."""
    for n, couple in couples_of(project, project.mechanism.crank.link):
        hinge = hinge_of(project, couple)
        if hinge is None:
            _turning(s, at, couple_radius(n), away, couple)
        else:
            _turning(s, s.at(hinge), 6.0, -away if s.at(hinge) == at else away, couple)
        yield tr("{quantity} = {value} N·m").format(quantity=couple.symbol, value=number(abs(couple.value), 5))


def lever(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Zhukovsky's lever: the velocity plan turned by 90 degrees with every force and its arm."""
    k, lv = project.force_index, project.study.lever
    shown = on_lever(project, k)
    box, *under = options.get("places") or lever_place(project, ViewPlace("kinetics.lever", box, options)).places(box)
    figure = lever_scheme(project, k)
    frame = figure.frame(project, canvas, box)
    plain: Scale | None = canvas.scales.get("velocities")
    text = str(frame.scale)
    ratio = plain.mu / frame.scale.mu if plain is not None else 1.0
    if ratio > 1.01 and abs(100 * ratio - round(100 * ratio)) < 1e-6:  # 2,667 times tells nothing
        said = tr("{scale} (enlarged {times})").format(scale=text, times=times(ratio))
        # In a narrow place by its sign: all scale factors of a sheet have letters of one height.
        text = said if letter(said, 5.0).width <= box.width - 2.0 else f"{text} (×{number(ratio)})"
    canvas.title(box, tr("Zhukovsky lever (position {label})").format(label=project.cycle.labels[k]), text)
    turned = stage(canvas, lv.velocities.plan, k, replace(frame, turn=pi / 2))
    vectors = turned_vectors(lv)
    for seg in vectors:
        turned.pen(seg.head, "vector", seg.tail, seg.head).line(turned.at(seg.tail), turned.at(seg.head), "axis")
    s = stage(canvas, lv.plan, k, frame)
    s.dot("p", 0.9)
    s.letters("p", "p", gap=1.2)
    _turned_letters(s, turned, lv.points, vectors)
    if project.driver is not None and lv.contact not in lv.points.values():
        play(s, [lv.contact], "axis")
        s.letters(lv.contact, lv.contact.name, gap=1.2)
    draw_arms(s, 0j, shown, points=[complex(s.at(step)) for step in lv.points.values()])
    draw_forces(s, shown)
    moments.draw(canvas, figure.taken(frame, box), next(iter(under), None), moments.at_scale(project, frame.scale),
                 "moments of the lever")


def _turned_letters(s: PlayerStage, turned: PlayerStage, points: Mapping[str, Step], vectors: list[Segment]) -> None:
    """Dots of the turned plan's points and their letters with a prime; those of one place together.

    ``points`` are those that forces hang on; the other vertices are those of the velocity plan itself, which is ``turned``.
    """
    vertices = [step for seg in vectors for step in (seg.tail, seg.head) if step.name != turned.plan.pole]
    every = {name: (s, step) for name, step in points.items()}
    every |= {step.name: (turned, step) for step in vertices if step.name not in points}
    names = list(every)
    for same in together([on.at(step) for on, step in every.values()], 0.5):
        here, first = every[names[same[0]]]
        at = here.at(first)
        here.dot(first)
        here.letters(first, ", ".join(f"{link_marks.indexed(names[i])}′" for i in same), at - s.frame(0j), gap=1.2)


def results(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The balancing force by both methods and their difference; moments are positive in the sense of rotation."""
    k, study = project.force_index, project.study
    forces: Kinetostatics = study.forces
    force, sign = project.driver is not None, balancing_sign(project)
    kind = forces.force_size(k) if force else forces.moment_size(k)
    # A force is signed along the line that drives the crank.
    kinetic, hung = (clean(float(step.at(k)), kind) for step in (
        (study.balance["along"], study.lever.balancing) if force else (study.balance["M"], study.balance["M_р"])))
    unit = tr("N") if force else tr("N·m")
    difference = float(study.balance["Δ"].at(k)) if kinetic else 0.0
    heading = tr("Balancing force") if force else tr("Balancing moment (“+”: in the sense of ω_1)")
    decimals = decimals_for((kinetic, hung), 2)
    rows = [[heading, tr("Value")],
            [tr("Force analysis: {quantity}, {unit}").format(quantity=sign, unit=unit), fixed(kinetic, decimals)],
            [tr("Zhukovsky lever: {quantity}, {unit}").format(quantity=sign, unit=unit), fixed(hung, decimals)],
            [tr("Difference, %"), number(difference, 2, 100.0)]]
    width = min(box.width, 210.0)
    listed.table_in(canvas, box, rows, 9.0, [width * 0.66, width * 0.34])
    if force and kinetic < 0:
        said = tr("{quantity} < 0: it holds the input back") if project.mechanism.drive is not None else \
            tr("{quantity} < 0: the mate holds the wheel back, in truth by the other flanks of its teeth")
        canvas.note(box, said.format(quantity=sign))
