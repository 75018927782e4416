"""Views of sheet 2, the flywheel: graphs over the crank angle, energy-mass diagram, sketch of the wheel, results.

The three graphs of the left column and the graph of dE share the ordinate axis given by the option ``axis`` (x of the
axis, mm of the sheet), so their positions stand one under another. The energy-mass diagram stands at the level of the
graph of dE and under the turned graph of J: its options ``energy`` and ``inertia`` repeat the places of those views.
"""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import pairwise, product
from math import degrees, pi
from string import ascii_lowercase
from typing import TYPE_CHECKING, cast

import numpy as np

from tmm_sheets.construction.arithmetic import ascending
from tmm_sheets.construction.equation import Quantity, digits_for, of_step
from tmm_sheets.construction.scale import Scale, times
from tmm_sheets.drawing.canvas import Canvas, hatch_polygon, in_role
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.drawing.placing import PointNumbers
from tmm_sheets.drawing.text_layout import LEADING, TOGETHER, wrapped
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import decimals_for, enough, fixed, is_zero, number
from tmm_sheets.sheets.border_solver import GAP
from tmm_sheets.sheets.components import clear_dimensions, graphs, listed
from tmm_sheets.sheets.player import PlayerStage, play, ratio, stage, standard, together
from tmm_sheets.words import tell, tr, tr_in

if TYPE_CHECKING:
    from tmm_sheets.construction.expression import Floats
    from tmm_sheets.construction.step import Step
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.methods.flywheel.wheel import RimWheel
    from tmm_sheets.methods.flywheel.wheel_methods import Wittenbauer
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import Arrangement, ViewPlace

CLEAR = 14.0
"""How far the sign of a straight graph stands from the other curve, mm."""
CROWD = 4
"""So many intervals between two positions on an average are drawn, with their rays, as they are."""
ENLARGED = 52.0
"""What the enlarged diagram needs for its title, signs, numbers and distance from all else, mm."""
BESIDE_MASS = 10.0
"""Distance of what stands beside the graph of J from the end of its axis, mm."""
_BELOW = 7.0  # room of position numbers beside an axis
_UNDER = 8.0  # room of the letter b under the energy-mass diagram


Stacked = tuple[Callable[..., None], float, float]
"""A graph of a column: what draws it, the height of its ordinates and what it needs under them, mm."""


def column(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Forces, moments and works one under another."""
    stacked(project, canvas, box, options, "flywheel.column", _of_column(project.flywheel), apart=True)


def _of_column(fw: Flywheel) -> tuple[Stacked, ...]:
    lines = [line for name in fw.reduced.forces_at(fw.samples[:1]) for line in _acting(fw, name)]
    return (force_graph, float(np.ptp(np.concatenate([np.zeros(1), *(line.imag for line in lines)]))), _BELOW), *of_moments(fw)


def apart(project: Project, plan: Arrangement) -> Arrangement:
    """The arrangement with borders by what is drawn.

    That between the column and the graph of dE under it is where both have room to spare alike, that between the graph of J and
    what stands at its right where the graph ends.
    """
    fw, views = project.flywheel, {view.draw: view for view in plan.views}
    upper, lower = views.get("flywheel.column"), views.get("flywheel.total_work")
    if fw.method != "wittenbauer" or upper is None or lower is None:
        return plan
    parts = _of_column(fw)
    needs = sum(height + below for _, height, below in parts) + len(parts) * (graphs.OVER + graphs.HEAD)
    gap = upper.box.y0 - lower.box.y1
    spare = upper.box.y1 - lower.box.y0 - gap - needs - _of_energy(with_tangents(project))
    border = upper.box.y1 - needs - max(spare, 0.0) * (len(parts) - 1) / (len(parts) + 1)
    places = {upper.draw: upper.box._replace(y0=border), lower.draw: lower.box._replace(y1=border - gap)}
    mass = views.get("flywheel.inertia")
    highest = float(fw.scales.inertia.mm(fw.inertia(fw.samples)).max())
    free = max(mass.box.x1 - mass.options["axis"] - highest - graphs.OVER - BESIDE_MASS, 0.0) if mass else 0.0

    def placed(view: ViewPlace) -> ViewPlace:
        box = places.get(view.draw, view.box)
        if mass is not None:
            right, left = abs(box.x1 - mass.box.x1) < GAP, box.x0 > mass.box.x1 - GAP
            box = box._replace(x0=box.x0 - free * left, x1=box.x1 - free * right)
        repeated = {"energy": places[lower.draw]} | ({"inertia": mass.box._replace(x1=mass.box.x1 - free)} if mass else {})
        return replace(view, box=box,
                       options={**view.options, **{name: [*at] for name, at in repeated.items() if name in view.options}})

    return replace(plan, views=tuple(map(placed, plan.views)))


def _of_energy(fw: Wittenbauer) -> float:
    """Height of the graph of dE with the ends of ab, or of one to a scale of its own over the enlarged diagram, mm."""
    low, high = _energy_range(fw)
    height = _UNDER + high - low
    if fw.scales.excess is not None:
        own = fw.scales.energy.mu / fw.scales.excess.mu * float(np.ptp(np.append(fw.energy_curve(fw.samples), 0.0)))
        height = max(height, own + _UNDER + own + ENLARGED)
    return height + graphs.HEAD + graphs.OVER


def of_moments(fw: Flywheel) -> tuple[Stacked, Stacked]:
    """The graphs of moments and works as parts of a column."""
    moment = np.concatenate(([0.0, fw.M_constant], *(fw.at_samples.moment(side).value for side in (1, -1))))
    work = np.append(fw.work_curve(fw.samples), (0.0, fw.driving_plan["K"].value.imag))
    # The constant moment is lettered above its line.
    return (moments, float(np.ptp(fw.scales.moment.mm(moment))) + 6.0, 4.0), (works, float(np.ptp(work)), 4.0)


def stacked(project: Project, canvas: Canvas, box: Box, options: graphs.Options, name: str, views: Sequence[Stacked],
            apart: bool = False) -> None:
    """Graphs one under another, each as high as it is, the room left over between them; ``apart`` each is a view of its own."""
    over = graphs.OVER + graphs.HEAD
    spare = (box.height - sum(height + below + over for _, height, below in views)) / (len(views) - 1)
    fw: Flywheel = project.flywheel
    graphs.check_room(box, name, box.y1 - min(spare, 0.0) * (len(views) - 1),
                      options["axis"] + fw.scales.angle.mm(fw.reduced.period) + graphs.OVER)
    top = box.y1
    for view, height, below in views:
        low = top - height - below - over
        place = Box(box.x0, low, box.x1, top)
        if apart:
            canvas.of = f"flywheel.{view.__name__}"
            canvas.begin(place, "", canvas.of)
        view(project, canvas, place, options)
        top = low - spare


def force_graph(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Technological forces over the crank angle; where one begins or ends the moment graph is cut off."""
    fw = with_tangents(project)  # the first view of its sheets: what is said of another method comes before what lacks room
    s, r = fw.scales, fw.reduced
    names = list(r.forces_at(fw.samples[:1]))
    one, many, letter_of, unit = (
        (tr("Graph of the moment {shown}"), tr("Graphs of the moments {shown}"), "M", tr("N·m")) if r.forces_are_moments else
        (tr("Graph of the force {shown}"), tr("Graphs of the forces {shown}"), "F", tr("N")))
    title = one if len(names) == 1 else many
    beside = [*r.moments_beside, *([tr("the weights of the links")] if fw.data.weights else [])]
    if beside:  # no place among the ordinates of forces
        canvas.note(box, tr("The reduced moment of forces counts as well: {shown}").format(shown=", ".join(beside)))
    graphs.heading(canvas, box, options, title.format(shown=", ".join(f"{n}(φ_1)" for n in names)), f"{s.force}")
    acting = {name: _acting(fw, name) for name in names}
    low = min((float(line.imag.min()) for lines in acting.values() for line in lines), default=0.0)
    g = graphs.Graph(complex(options["axis"], box.y0 + _BELOW - min(low, 0.0)))
    top = 0.0
    of = stage(canvas, r.numbered.plan, None, g.place(s.angle.mu, s.force.mu))
    steps = dict(zip(names, r.force_steps, strict=True))
    for name in names:
        for line in acting[name]:
            of.curve(steps[name], g(_down_to_axis(line)))
            highest = line[int(np.argmax(line.imag))]
            top = max(top, float(highest.imag))
            if len(names) > 1 and (highest.imag > 4.0 or line is max(acting[name], key=lambda some: float(some.imag.max()))):
                canvas.label(g(highest), name, 1 + 0.3j, 3.5)
    graphs.check_room(box, "flywheel.force_graph", g.origin.imag + top)
    ordinate = f"{names[0] if len(names) == 1 else letter_of}, {unit}"
    axes(fw, of, r.force_steps[0], g, (min(low, 0.0), top), ordinate, np.ones(len(fw.labels)))
    for k, x in enumerate(s.angle.mm(r.phi)):
        if top and k:
            here, name = max(((graphs.one(values), name) for name, values in r.forces_at(r.phi[k]).items()),
                             key=lambda of: (abs(of[0]), of[1]))
            of.position(k % len(r.labels)).line(steps[name], g(x), g(x + 1j * s.force.mm(here)), "thin")


def _acting(fw: Flywheel, name: str) -> list[Points]:
    """Curves of one force where it acts, mm: each runs on through the kinks between its stretches."""
    s, r = fw.scales, fw.reduced
    runs: list[list[Points]] = []
    on = False
    for a, b in _stretches(fw):
        phi = _inside(fw, a, b)
        ends = (graphs.one(r.forces_at(a, side=1)[name]), graphs.one(r.forces_at(b, side=-1)[name]))
        y = s.force.mm(np.concatenate((ends[:1], r.forces_at(phi[1:-1])[name], ends[1:])))
        if y.any():
            runs = runs if on else [*runs, []]
            runs[-1].append(s.angle.mm(phi) + 1j * y)
        on = bool(y.any())
    return [np.concatenate(parts) for parts in runs]


def moments(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Reduced moments with the pole, the ordinates in the middles of the intervals, their rays and the constant moment."""
    fw: Flywheel = project.flywheel
    s, r, plan = fw.scales, fw.reduced, fw.work_plan
    varying, constant = indices(fw)
    # Of very many intervals (a digitised diagram) one between any two numbers stands for all.
    drawn = [n for n in fw.intervals if len(fw.intervals) <= CROWD * len(fw.labels) or n[-1:] not in ascii_lowercase]
    factors = tr("{moment}, {angle}, H = {pole} mm") if len(drawn) == len(fw.intervals) else \
        tr("{moment}, {angle}, H = {pole} mm; {shown} of {count} rays are shown")
    line = _moment_curve(fw)
    level = s.moment.mm(fw.M_constant)
    low = min(0.0, level, float(line.imag.min()))
    high = max(0.0, level, float(line.imag.max()))
    said = factors.format(moment=s.moment, angle=s.angle, pole=number(s.pole), shown=len(drawn), count=len(fw.intervals))
    heads = tr("Graphs of the reduced moments of forces"), said
    g = graphs.begin(canvas, box, options, heads, low, high, 4.0, "flywheel.moments")
    canvas.of = plan.name
    of, drive = (stage(canvas, p, None, g.place()) for p in (fw.moment_plan, fw.driving_plan))
    of.curve("M", g(_down_to_axis(line)))
    length = s.angle.mm(r.period)
    drive.line("dK", g(1j * level), g(length + 1j * level), "curve", "curve")
    points = fw.moment_plan["M"].value
    # Where the curve runs along the axis its numbers stand on the side the graph leaves free.
    body = line.imag[int(np.argmax(np.abs(line.imag)))]
    axes(fw, of, "M", g, (low, high), tr("M, N·m"), np.where(np.abs(points.imag) < 1.0, body, points.imag))
    uprights(of, "M")
    pole = plan["P"].value
    rays = stage(canvas, plan, None, g.place())
    _rays(rays, fw, drawn)
    drive.line("K′", g(pole), drive.at("K′"))
    drive.letters("K′", "K′", -1 + 0.6j if level > 0 else -1 - 0.6j)
    rays.dot("P", 0.6, "main")
    rays.letters("P", "P", -1 + 1j)
    canvas.dimension(g(pole.real + 1j * low), g(1j * low), -3.0 if low > -12 else 5.0, "H")
    size = np.abs(line.imag)
    peak = int(np.argmax(size))
    falling = line[peak + int(np.argmax(size[peak:] < 0.6 * size[peak]))]
    canvas.label(g(falling), tr("M_{index}^{{red}}").format(index=varying), 1 - 1j if falling.imag < 0 else 1 + 1j, height=5)
    canvas.label(g(place_of_sign(line, level, length)), tr("M_{index}^{{red}}").format(index=constant), -1j if level > 0 else 1j,
                 height=5)


def place_of_sign(line: Points, level: float, length: float) -> complex:
    """Place on the line of the constant moment for its sign, mm: far enough from the other curve, rather near the end."""
    share = np.linspace(0.2, 0.78, 12)
    away = np.abs(graphs.dense(line)[:, None] - (share * length + 1j * level)).min(axis=0)
    return complex(share[np.argmax(np.minimum(away, CLEAR) + share)] * length, level)


def axes(fw: Flywheel, of: PlayerStage, step: Step | str, g: graphs.Graph, span: tuple[float, float], ordinate: str, side: Floats,
         angle: Scale | None = None) -> None:
    """Axes of the graph of a step over the cycle, and the numbers of the positions beneath where ``side`` is positive.

    ``span`` are its lowest and highest ordinate, mm, ``side`` of shape (positions,); ``angle`` is the scale factor of the angle
    where it is not that of the construction.
    """
    x, r, pen = angle or fw.scales.angle, fw.reduced, of.pen(step, "axis")
    graphs.axes(pen, g, x.mm(r.period), *span, ordinate)
    graphs.numbers(pen, g, x.mm(r.phi), fw.labels, side)


def _down_to_axis(line: Points) -> Points:
    """A curve of the diagram with both its ends brought down to the abscissa."""
    return np.concatenate(([line[0].real + 0j], line, [line[-1].real + 0j]))


def uprights(s: PlayerStage, step: str) -> None:
    """Ordinates of the points of a graph, one for each position."""
    for k in range(len(s.plan.labels)):
        play(s.position(k), [step], "thin")


def _moment_curve(fw: Flywheel) -> Points:
    """The varying moment over the crank angle, mm, with both values where it jumps."""
    s, r, values = fw.scales, fw.reduced, fw.at_samples.moment().value
    stretches = []
    for a, b in _stretches(fw):
        p = _inside(fw, a, b)
        ends = [graphs.one(r.moment(p[0], side=1)), graphs.one(r.moment(p[-1], side=-1))]
        inside = values[(fw.samples > a) & (fw.samples < b)]
        stretches.append(s.angle.mm(p) + 1j * s.moment.mm(np.concatenate((ends[:1], inside, ends[1:]))))
    return np.concatenate(stretches)


def _rays(s: PlayerStage, fw: Flywheel, intervals: list[str]) -> None:
    """Ordinates in the middles of the intervals, carried over to the ordinate axis, and the rays from the pole to them."""
    plan = s.plan
    heights = {f"{name}{fw.mark}": float(plan[f"m{name}"].value.imag) for name in intervals}
    heights = {name: y for name, y in heights.items() if abs(y) > 0.05}
    for name in heights:
        play(s, [f"m{name.removesuffix(fw.mark)}", name])
    play(s, ["P"], "axis")
    every = list(heights)
    shown = [[every[i] for i in same] for same in together(list(heights.values()), 1e-6)]
    shown.sort(key=lambda names: -abs(heights[names[0]]))
    play(s, [f"P{names[0]}" for names in shown])
    numbers = PointNumbers(s.canvas)
    left = [names for names in shown if not numbers.place(s.pen(names[0], "text"), [s.at(names[0])], ", ".join(names))]
    # Points of the ordinate axis between which no number stands have one together.
    left.sort(key=lambda names: s.at(names[0]).imag)
    places = [s.at(names[0]) for names in left]
    ends = [i for i in range(1, len(left)) if (places[i] - places[i - 1]).imag > PARTED]
    for a, b in pairwise([0, *ends, len(left)] if left else []):
        points, named = places[a:b], {name for names in left[a:b] for name in names}
        said = graphs.in_ranges(every, [n for n, name in enumerate(every) if name in named])
        pen = s.pen(left[a][0], "text")
        if not numbers.place(pen, points, said):
            pen.label(points[len(points) // 2], said, -1 + 0j, 2.5, 1.0)


PARTED = 3.5
"""Distance of points of an axis from which on a number stands between them, mm."""


def works(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Work of the varying moment by chords parallel to the rays, and the straight line that balances the cycle."""
    fw: Flywheel = project.flywheel
    s = fw.scales
    varying, constant = indices(fw)
    ends = np.array([e.value for e in fw.work_ends])
    end = fw.driving_plan["K"].value
    curve = s.angle.mm(fw.samples) + 1j * fw.work_curve(fw.samples)
    low, high = min(0.0, end.imag, curve.imag.min()), max(0.0, end.imag, curve.imag.max())
    share = fixed(100 * fw.work_error, 2)
    # So many figures that both can be told apart.
    drawn, converged = graphs.column([float(fw.work[-1]), float(fw.work_converged[-1])], 4, least=1)
    # Nothing is a share of a work that is nothing: a weight that comes back to where it was.
    nothing = is_zero(float(fw.work_converged[-1]), float(np.abs(fw.work).max()))
    by_area = tr("by the area of the graph 0 J") if nothing else tr("by the area of the graph {work} J ({share} %)").format(
        work=converged, share=share if share.startswith("−") else f"+{share}")
    by_ordinates = tr("A_{index}({label}) = {work} J by the ordinates in the middles of the intervals,").format(
        index=varying, label=fw.labels[-1], work=drawn)
    heads = tr("Graphs of work"), f"{s.work}", f"{by_ordinates} {by_area}"
    g = graphs.begin(canvas, box, options, heads, low, high, 4.0, "flywheel.works")
    canvas.of = fw.work_plan.name
    of, drive = (stage(canvas, p, None, g.place()) for p in (fw.work_plan, fw.driving_plan))
    of.curve("A(φ)", g(curve))
    drive.line("K", g(0j), g(end), "curve", "curve")
    play(of, fw.borders[1:])
    for k, label in zip(fw.at_positions, fw.labels, strict=True):
        heights = 0.0, ends[k].imag, ends[k].real * end.imag / end.real
        low_end, high_end = (g(complex(ends[k].real, of_all(heights))) for of_all in (min, max))
        canvas.tracing("construction", fw.total_plan["ΣA"].path, label).line(low_end, high_end, "thin")
    axes(fw, of, "A(φ)", g, (low, high), tr("A, J"), np.zeros(len(fw.labels)))
    k = len(curve) // 2
    canvas.label(g(curve[k]), f"A_{varying}", -1 - 1j if curve[k].imag < 0 else -1 + 1j, height=5)
    canvas.label(g(end / 2), f"A_{constant}", -1 + 1j if end.imag > 0 else -1 - 1j, height=5)
    drive.letters("K", "K", 1j if end.imag > 0 else -1j)


def total_work(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Sum of the works, which is the change of kinetic energy, at the scale of the energy-mass diagram."""
    fw = with_tangents(project)
    s = fw.scales
    scale = s.excess or s.energy
    ratio = s.work.mu / scale.mu
    graphs.heading(canvas, box, options, tr("Graph of the total work A_Σ(φ_1) = ΔE(φ_1)"), f"{scale}",
                   _enlarged(ratio) if abs(ratio - 1) > 1e-9 else "")
    canvas.of = fw.total_plan.name
    ordinates = (s.energy.mu / scale.mu) * fw.energy_curve(fw.samples)
    low, high = min(0.0, float(ordinates.min())), max(0.0, float(ordinates.max()))
    g = _energy_graph(fw, box, options) if scale is s.energy else \
        graphs.Graph(complex(options["axis"], box.y1 - graphs.HEAD - graphs.OVER - high - 4.0))
    of = stage(canvas, fw.total_plan, None, g.place())
    of.curve("points", g(s.angle.mm(fw.samples) + 1j * ordinates))
    uprights(of, "points")
    axes(fw, of, "points", g, (low, high), tr("ΔE, J"), fw.total_plan["points"].value.imag)


def _enlarged(ratio: float) -> str:
    """What the ordinates are against those of the graph of works."""
    said = tr("Ordinates ΔE enlarged {times}") if ratio > 1 else tr("Ordinates ΔE reduced {times}")
    return said.format(times=times(max(ratio, 1 / ratio)))


def inertia(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Reduced moment of inertia, turned clockwise: its J axis runs as that of the energy-mass diagram, phi downwards."""
    fw: Flywheel = project.flywheel
    s = fw.scales
    angle, turn = fw.inertia_angle, fw.inertia_turn
    left = canvas.title(box.inset(0, 0, 0, 2), tr("Graph of the reduced moment of inertia J^red(φ_1)"), f"{s.inertia}, {angle}")
    canvas.of = fw.inertia_plan.name
    g = _inertia_graph(fw, box, options)
    length = angle.mm(turn)
    graphs.check_room(left, "flywheel.inertia", max(g.origin.imag + 3, left.y1 + length - g.origin.imag + box.y0))
    phi = fw.samples[fw.samples <= turn * (1 + 1e-12)]
    curve = angle.mm(phi) + 1j * s.inertia.mm(fw.inertia(fw.samples)[:len(phi)])
    of = stage(canvas, fw.inertia_plan, None, g.place())
    of.curve("points", g(curve))
    levels = fw.inertia_plan["points"].value.real
    for same in together(levels, 1e-6):
        x = levels[same[0]]
        play(of.position(same[0]), ["points"], "thin")
        # The first number stands above the axis of J, which begins to the left of the curve.
        canvas.text(g(x) - 2.0 + (-1.2j if x > 0 else 0.8j), ", ".join(fw.labels[k] for k in same), 3.5, "right")
    highest = float(curve.imag.max())
    reach = min(highest + graphs.OVER, max(box.x1 - g.origin.real, highest + 4.0))
    pen = of.pen("points", "axis")
    pen.arrow(g(-4), g(length + graphs.OVER), "axis", 3.0)
    pen.text(g(length + graphs.OVER) - 2, tr("{symbol}, rad").format(symbol="φ_1"), 3.5, "right")
    pen.arrow(g(-4j), g(1j * reach), "axis", 3.0)
    canvas.text(g(1j * reach) - 2 + 2j, tr("J^red, kg·m^2"), 3.5, "right")


def energy_mass(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Energy-mass curve by projection from the graphs of dE and J, its two tangents and the segment ab."""
    fw = with_tangents(project)
    s, plan = fw.scales, fw.energy_mass_plan
    scale, first = s.excess or s.energy, len(canvas.marks)
    canvas.of = plan.name
    energy = _energy_graph(fw, Box(*options["energy"]), {"axis": options["energy_axis"]})
    turned = _inertia_graph(fw, Box(*options["inertia"]), options)
    g = graphs.Graph(complex(options["axis"], energy.origin.imag))
    points = plan["points"].value
    # The title stands in the widest gap between the lines that come down from the graph of J; too wide for it, it interrupts them.
    cuts = ascending(np.append(g(points).real, (g.origin.real, box.x1)))
    widest = int(np.argmax(np.diff(cuts)))
    gap = _for_title(Box(float(cuts[widest]), box.y0, float(cuts[widest + 1]), box.y1), g.origin.real, box.x1)
    title = _write_beneath(canvas, canvas.title(gap, tr("Energy-mass diagram"), spare=LEADING), 5.0, s.energy, s.inertia)
    if scale is not s.energy:
        title = _write_beneath(canvas, title, 3.5, _enlarged(scale.mu / s.energy.mu))
    curve = fw.energy_mass_curve(fw.samples)
    of = stage(canvas, plan, None, g.place())
    of.curve("points", g(curve))
    middle = complex(np.mean(curve.real), np.mean(curve.imag))
    x, masses = s.angle.mm(fw.reduced.phi), fw.inertia_plan["points"].value
    for k, p in enumerate(points[:-1]):
        here = of.position(k)
        # Produced to the graphs that they come from; a graph of another scale stands elsewhere.
        if scale is s.energy:
            here.line("points", energy(complex(x[k], p.imag)), g(p))
        above, below = complex(turned(masses[k])), complex(g(p))
        if gap.x0 + 0.5 < below.real < gap.x1 - 0.5 and below.imag < title.y1:
            here.line("points", above, complex(above.real, gap.y1 + 1.0))
            above = complex(above.real, title.y1 + 1.5)
        here.line("points", above, below)
        here.dot("points", 0.7, "main")
    tangents = [(plan[end].value, plan[f"t_{name}"].value * way) for name, end, way in (("max", "a", -1j), ("min", "b", 1j))]
    for near in together(points[:-1], 1.0):
        # The number of a point beside a tangent stands on the other side: it would be that of the point of contact.
        at = points[near[0]]
        away = next((n for cut, n in tangents if abs(((at - cut) * np.conj(n)).real) < BESIDE), at - middle)
        of.position(near[0]).letters("points", ", ".join(fw.labels[k] for k in near), away / abs(away))
    reach = curve.real.max() + graphs.OVER
    low, high = _energy_range(fw)
    pen = of.pen("points", "axis")
    pen.arrow(g(-12.0), g(reach), "axis", 3.0)
    # Over or under the end of the axis, never beyond it: there the next column begins.
    sign = tr("J^red, kg·m^2")
    pen.label(g(reach - letter(sign, 3.5).width / 2 - 2.0), sign, 1j, 3.5, 1.5, leader=False)
    pen.arrow(g(1j * (low - 5)), g(1j * (high + graphs.OVER + 2)), "axis", 3.0)
    pen.label(g(1j * (high + graphs.OVER)), tr("ΔE, J"), 1, 3.5, 2.0, leader=False)
    beside = abs(fw.ab_mm) < 12.0
    for name, end in (("max", "a"), ("min", "b")):
        cut, u = plan[end].value, plan[f"t_{name}"].value
        room = (curve.real.max() - cut.real) / u.real
        for bound in (title.y1, box.y0 + 2):
            t = (bound - g.origin.imag - cut.imag) / u.imag
            room = min(room, t) if t > 0 else room
        canvas.tracing("construction", plan[end].path).line(g(cut - 6 * u), g(cut + room * u), "axis")
        # The angles of tangents close together are marked one above the other.
        vertex = cut + (0.7 if beside and name == "max" else 0.45) * room * u
        pen, angle = of.pen(f"ψ_{name}", "dimension"), float(plan[f"ψ_{name}"].value)
        pen.line(g(vertex), g(vertex + 45), "thin")
        pen.angle_mark(complex(g(vertex)), 0.0, angle, 40.0, f"ψ_{name} = {fixed(degrees(angle), 2)}°")
        of.letters(end, end, -1 + (1j if (end == "a") == (fw.ab_mm >= 0) else -1j), height=5)
    ends = sorted((plan["a"].value, plan["b"].value), key=lambda z: float(z.imag))
    length = _of_segment(fw)
    text = f"|ab| = {length}" if fw.ab_mm >= 0 else f"ab = {length}"
    lower, upper = (complex(g(end)) for end in ends)
    if abs(upper - lower) > letter(text, 3.5).width + 2:
        clear_dimensions.dimension(of.pen("ab", "dimension"), first, lower, upper, [AB], text)
    else:
        of.pen("ab", "dimension").dimension(lower, upper, AB, text, apart=((lower + upper) / 2 - AB, -1 + 0j))


def _of_segment(fw: Wittenbauer) -> str:
    """Length of ab, mm, as it stands at the diagram and in the formulas."""
    return fixed(fw.ab_mm, 2) if abs(fw.ab_mm) >= 10 else number(fw.ab_mm, 4)


def _for_title(gap: Box, low: float, high: float) -> Box:
    """A gap, widened inside of ``low`` .. ``high`` to what the title of the diagram needs."""
    lack = letter(tr("Energy-mass diagram"), 5.0).width + 2.0 - gap.width
    if lack <= 0 or high - low < gap.width + lack:
        return gap
    x0 = min(max(gap.x0 - lack / 2, low), high - gap.width - lack)
    return Box(x0, gap.y0, x0 + gap.width + lack, gap.y1)


def _write_beneath(canvas: Canvas, gap: Box, height: float, *said: object) -> Box:
    """Scale factors or words right under a title on as many lines as the gap asks for; returns what is left below."""
    room, text = gap.width - 2.0, ", ".join(str(one).replace(" ", TOGETHER) if len(said) > 1 else str(one) for one in said)
    tried = [wrapped(text, height, count) for count in range(1, 5)]
    lines = next((lines for lines in tried if size_for(lines, room, height) == height), tried[-1])
    height = size_for(lines, room, height)
    canvas.lines(complex(gap.centre.real, gap.y1 - height), lines, 1.6 * height, height, "centre")
    return Box(gap.x0, gap.y0, gap.x1, gap.y1 - len(lines) * 1.6 * height - 1.0)


def wheel(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Sketch of the wheel to a standard scale: front view and section through the axis, with dimensions in mm.

    Words in its place when no flywheel is needed, or of a given one nothing but its moment of inertia is known.
    """
    w = project.flywheel.wheel
    if w is not None:
        _sketch(w, canvas.as_role("symbol"), box)
        return
    title, lines = _without_sketch(project.flywheel)
    left = canvas.title(box, title)
    height = size_for(lines, left.width, 5.0)  # as large as their place allows: what is left under them is free for other views
    canvas.lines(complex(left.centre.real, left.y1 - 2.0 * height), lines, 2.0 * height, height, "centre")


LEFT, BETWEEN, RIGHT = 6.0, 17.0, 22.0
"""Least room at the left of a wheel's sketch, between its views and at the right, for axes and dimensions, mm."""


def _sketch(w: RimWheel, canvas: Canvas, box: Box) -> None:
    rim = w.form == "rim"
    d, b, h = 1000 * w.diameter, 1000 * w.width, 1000 * w.thickness if rim else 0.0
    outer = d + h
    scale = standard(((outer + b) * 1e-3, box.width - 56), (outer * 1e-3, box.height - 36))
    left = canvas.title(box, tr("Sketch of the flywheel"), ratio(scale))
    k = 1e-3 / scale.mu
    gap = (box.width - (outer + b) * k - LEFT - BETWEEN - RIGHT) / 3
    centre = complex(box.x0 + LEFT + gap + outer * k / 2, (left.y0 + left.y1) / 2 - 2)
    side = complex(box.x1 - RIGHT - gap - b * k / 2, centre.imag)
    hub, bore = 0.24 * d * k / 2, round(0.12 * d) * k / 2
    r = outer * k / 2
    for radius in ({r, r - h * k, hub, bore} if rim else {r, bore}):
        canvas.circle(centre, radius, "main")
    if rim:
        canvas.circle(centre, d * k / 2, "centre")
        wide, edge = 0.05 * d * k, r - h * k
        for i, sign in product(range(6), (1, -1)):
            u, start, end = rect(1, pi / 2 + i * pi / 3), sign * wide, sign * 0.75 * wide
            a, z = complex((hub**2 - start**2) ** 0.5, start), complex((edge**2 - end**2) ** 0.5, end)
            canvas.line(centre + u * a, centre + u * z, "main")
    half = b * k / 2
    for at, reach in ((centre, r + 4.0), (centre, 1j * (r + 4.0)), (side, half + 4.0)):
        canvas.line(at - reach, at + reach, "centre")
    for sign in (1, -1):
        low = r - h * k if rim else bore
        _cut(canvas, side, half, sign * low, sign * r)
        if rim:
            _cut(canvas, side, half, sign * bore, sign * hub)
            for x in (-1.0, 1.0):  # the edges of the rim behind the cutting plane, and the spokes
                canvas.line(side + x * half + 1j * sign * hub, side + x * half + 1j * sign * low, "main")
                canvas.line(side + x * 0.3 * half + 1j * sign * hub, side + x * 0.22 * half + 1j * sign * low, "main")
            middle = side + 1j * sign * d * k / 2
            canvas.line(middle - half - 3, middle + half + 3, "centre")
    for x in (-half, half):
        canvas.line(side + x - 1j * bore, side + x + 1j * bore, "main")
    at = (d if rim else 2 * r / k) * k / 2
    right = side + half
    canvas.dimension(right - 1j * at, right + 1j * at, -10.0, f"D = Ø{fixed(d, 0)}", factor=1 / k)
    if rim:
        canvas.dimension(right - 1j * r, right + 1j * r, -18.0, f"Ø{fixed(outer, 0)}", factor=1 / k)
    canvas.dimension(side - half - 1j * bore, side - half + 1j * bore, 7.0, f"Ø{fixed(2 * bore / k, 0)}", factor=1 / k)
    width = f"B = {fixed(b, 0)}"
    foot = side - half - 1j * r
    canvas.dimension(foot, foot + 2 * half, -9.0, width, factor=1 / k,
                     apart=None if (letter(width, 3.5).width <= 2 * half - 1) else (foot - 7.0 - 9.0j, -1 + 0j))
    if rim:
        top = side - half + 1j * r
        canvas.dimension(top - 1j * h * k, top, 7.0, f"H = {fixed(h, 0)}", factor=1 / k, apart=(top - 7.0 - 0.5j * h * k, -1 + 0j))


def _without_sketch(fw: Flywheel) -> tuple[str, list[str]]:
    """Title and lines in place of a sketch: of a given flywheel, or of one that is not needed."""
    if fw.given:
        return tr("The flywheel is given"), [tr("J_f = {J} kg·m^2").format(J=number(fw.J_flywheel)),
                                             tr("It leaves δ = {delta}").format(delta=number(fw.unevenness, 4))]
    delta = fw.running(fw.J_running).delta
    held = tr("J_{{cr}} + J_r·u^2 = {there} kg·m^2;  needed {needed} kg·m^2") if fw.J_rotor else \
        tr("J_{{cr}} = {there} kg·m^2;  needed {needed} kg·m^2")
    lines = [tr("J_f = {J} kg·m^2 ≤ 0").format(J=number(fw.J_flywheel, 4)),
             held.format(there=number(fw.turning, 4), needed=number(max(fw.J_first, 0.0), 4))]
    if not np.isnan(delta):
        lines.append(tr("Without a flywheel δ = {found} {sign} {permitted}").format(
            found=number(delta, 4), sign="≤" if delta <= fw.permitted else ">", permitted=number(fw.permitted)))
    return tr("No flywheel is needed"), lines


def disagreement(fw: Flywheel) -> list[str]:
    """Lines for the sheet where the drawn construction and the limit do not agree whether a flywheel is needed."""
    if fw.needed == (fw.J_flywheel_converged > 0):
        return []
    error = number(abs(fw.J_flywheel - fw.J_flywheel_converged), 2)
    return [tr("By the construction a flywheel is needed, in the limit n → ∞ it is not:") if fw.needed else
            tr("By the construction no flywheel is needed, in the limit n → ∞ it is:"),
            tr("|J_f| is less than the error of the construction {error} kg·m^2").format(error=error)]


def inertia_table(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Table of the terms of the reduced moment of inertia at the positions."""
    fw: Flywheel = project.flywheel
    # A square over an index; terms without a unit are doubled energies. The position that closes the cycle may be left out.
    terms = {name.replace("²", "^2"): values for name, values in fw.reduced.inertia_terms.items()}
    listed.table(canvas, canvas.title(box.inset(0, 0, 0, 2), tr("Reduced moment of inertia")), [
        [tr("Position"), *fw.labels],
        *(graphs.row(name if "," in name else tr("{quantity}, J").format(quantity=name), np.resize(values, len(fw.labels)))
          for name, values in terms.items()),
        graphs.row(tr("J^red, kg·m^2"), fw.J_reduced)])


def _works(project: Project, options: graphs.Options) -> tuple[str, listed.Rows]:
    """Moment, works and change of energy at the positions, the units under the names."""
    fw: Flywheel = project.flywheel
    varying, constant = indices(fw)
    title = tr("Works of the cycle, M_{index}^{{red}} = {moment} N·m").format(index=constant, moment=constant_moment(fw))
    quantities = [
        graphs.row(tr("M_{index}^{{red}}, N·m").format(index=varying), fw.M_reduced),
        graphs.row(tr("A_{index}, J").format(index=varying), fw.work),
        graphs.row(tr("A_{index}, J").format(index=constant), fw.total_plan["A_K"].value),
        graphs.row(tr("ΔE, J"), fw.delta_E),
    ]
    columns = [[*name.rsplit(", ", 1), *numbers] for name, *numbers in quantities]
    return title.replace(" = ", f"{TOGETHER}={TOGETHER}"), [*zip([tr("No."), "", *fw.labels], *columns, strict=True)]


work_table = listed.Upright(_works)
"""The table of these works."""


def results(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Formulas with their numbers: tangents, segment, moment of inertia drawn and in the limit, sizes, mass.

    With a given flywheel the coefficient of non-uniformity in place of the moment of inertia.
    """
    fw = with_tangents(project)
    psi = fw.psi
    slope = {name: float(fw.energy_mass_plan.auxiliaries[f"tg ψ_{name}"].value) for name in ("max", "min")}
    drawn = tr("|ab| = {length} mm") if fw.ab_mm >= 0 else tr("ab = {length} mm (a below b)")
    tangent = tr("tan ψ_{name} = μ_J/(2μ_E)·ω_1^2(1 {sign} δ/2)^2 = {slope};  ψ_{name} = {angle}°")
    digits = decimals_for([slope["max"] - slope["min"]], 4)
    listed.draw_lines(canvas, box, tr("Flywheel design"), [
        (tr("ω_1 = {omega} s^{{−1}};  J_f = {J} kg·m^2 (given)") if fw.given else
         tr("ω_1 = {omega} s^{{−1}};  δ = {delta}")).format(
            omega=fixed(fw.reduced.omega1, 3), delta=number(fw.unevenness), J=number(fw.J_flywheel)),
        *(tangent.format(name=name, sign=sign, slope=fixed(slope[name], digits), angle=fixed(degrees(a), 2))
          for name, sign, a in zip(("max", "min"), "+−", psi, strict=True)),
        drawn.format(length=_of_segment(fw)),
        *found(fw),
        converged(fw),
        *disagreement(fw),
        *motor(fw),
        *power(fw),
        *frictionless(project),
        *sizes(fw),
    ])


def found(fw: Flywheel) -> list[str]:
    """From the segment ab to the moment of inertia of the flywheel, or to δ that a given one leaves."""
    segment = f"|{fw.ab.name}|" if fw.ab_mm >= 0 else fw.ab.name
    own = {id(fw.ab): Quantity(segment, fw.ab_mm, "", digits_for(fw.ab_mm, 2) if abs(fw.ab_mm) >= 10 else 4, 2)}
    given = (*(fw.given_plan if fw.method == "mertsalov" or fw.J_rotor else ()), fw.delta_plan["δ"]) if fw.given else ()
    steps = given or tuple(step for step in fw.first_plan if step.name != "J_вр")
    if not given and fw.method == "wittenbauer" and not fw.J_rotor:  # what is added is the flywheel alone
        return [of_step(steps[0], symbol=steps[-1].symbol, own=own)]
    return [said for step in steps if (said := of_step(step, own=own))]


def power(fw: Flywheel) -> list[str]:
    """Mean power by the work of the cycle, where the efficiency of what lies between motor and crank is given."""
    return [] if fw.data.efficiency is None else \
        [";  ".join(of_step(fw.power_plan[name], own=constant(fw)) for name in ("P", "P_дв"))]


def motor(fw: Flywheel) -> list[str]:
    """Whether the motor is strong enough and remains a motor; nothing where none is given."""
    check, data = fw.motor, fw.data.motor
    if check is None or data is None:
        return []
    rated = f"{'≤' if check.strong else '>'} {number(check.rated_power)} {tr('W')} ({data.name})"
    steady = tr("{formula} ≥ δ: it never runs as a generator") if check.steady else \
        tr("{formula} < δ: the motor runs as a generator at times")
    rated = tr("{said};  η is taken").format(said=rated) if data.accepted else rated
    return [f"{of_step(check.plan['P'], own=constant(fw))} {rated}", steady.format(formula=of_step(check.plan["[δ]"]))]


def constant(fw: Flywheel) -> dict[int, Quantity]:
    """The constant moment as an operand of formulas, with the letters that the sheet has for it."""
    return {id(step := fw.driving_plan["M"]): Quantity(f"M_{{{indices(fw)[1]}}}", float(step.value), step.rule.unit)}


def frictionless(project: Project) -> list[str]:
    """That the moments of the flywheel leave out friction, where the force analysis has it."""
    return [] if project.variant.friction is None else \
        [tr("M_{index} is found without friction in the pairs").format(index=indices(project.flywheel)[1])]


def _alike(fw: Flywheel) -> list[str]:
    """What is asked by the drawn construction and in the limit with the same decimals."""
    return graphs.column([fw.unevenness, float(fw.limit_plan["δ∞"].value)], 4) if fw.given else \
        graphs.column([fw.J_flywheel, fw.J_flywheel_converged], 4)


def converged(fw: Flywheel) -> str:
    """The converged flywheel and how far the drawn one is from it: in percent, beside a small converged one in kg m2."""
    if fw.given:
        return tr("For n → ∞ positions: δ = {delta} (difference {difference} %)").format(
            delta=_alike(fw)[1], difference=fixed(fw.difference_percent, 2))
    said = tr("For n → ∞ positions: J_f = {J} kg·m^2 (difference {difference} %)") \
        if fw.needed and abs(fw.difference_percent) < 100 else \
        tr("For n → ∞ positions: J_f = {J} kg·m^2 (difference {apart} kg·m^2)")
    return said.format(J=_alike(fw)[1], difference=fixed(fw.difference_percent, 2),
                       apart=number(float(fw.limit_plan["ΔJ_м"].value), 3))


def sizes(fw: Flywheel) -> list[str]:
    """Sizes, mass and speed of the wheel as formulas, or that none is needed."""
    w, d = fw.wheel, fw.data
    if w is None or d.width_ratio is None or d.thickness_ratio is None or d.density is None:
        return [] if fw.given else [tr("J_f ≤ 0: no flywheel is needed")]
    form = (tr("Rim with spokes"), f";  c = H/D = {number(d.thickness_ratio)}") if w.form == "rim" else (tr("Disc"), "")
    density = tr("ρ = {density} kg/m^3").format(density=number(d.density))
    head = f"{form[0]}:  κ = B/D = {number(d.width_ratio)}{form[1]};  {density}"
    speed = "< 30" if w.speed < 30 else "≥ 30"
    too_fast = "" if w.speed < 30 else tr(": too fast for cast iron") if fw.cast_iron else tr(": the wheel is of steel")
    rows = [[step for step in w.plan if step.name in names] for names in (("J_об",), ("D",), ("B", "H"), ("m",), ("V",))]
    *said, last = (";  ".join(map(of_step, steps)) for steps in rows if steps)
    disc_for_rim = tr("A rim would have V = {speed} m/s ≥ 30 m/s: a disc is taken")
    return [head, *said, disc_for_rim.format(speed=fixed(float(w.plan["V_об"].value), 2)) if "V_об" in w.plan else
            f"{last} {speed} {tr('m/s')}{too_fast}"]


# --- parts shared by the views --------------------------------------------------------------------------


def by_method(project: Project, method: str, hint: str) -> Flywheel:
    """The project's flywheel, which a view must find by its own method."""
    fw: Flywheel = project.flywheel
    if fw.method != method:
        raise CannotBuild(tell('this view belongs to flywheel.method = "{wanted}", not "{found}"').format(
            wanted=method, found=fw.method), hint)
    return fw


def with_tangents(project: Project) -> Wittenbauer:
    """The flywheel by the energy-mass diagram; CannotBuild for one by another method."""
    hint = tell("take an arrangement with the views of mertsalov among the project's sheets: sixbar_2, or press_1")
    return cast("Wittenbauer", by_method(project, "wittenbauer", hint))


def constant_moment(fw: Flywheel) -> str:
    """The constant moment as it is written, N m: 0 where it is nothing but rounding beside the moments that vary."""
    return enough(fw.M_constant, 1, float(np.abs(fw.at_samples.moment().value).max()))


def omega_digits(omega: float, uneven: Iterable[float]) -> int:
    """Decimals that tell the greatest angular velocity from the least, rad/s."""
    return decimals_for((omega * delta for delta in uneven), 4)


def indices(fw: Flywheel) -> tuple[str, str]:
    """Indices of the varying moment and of the constant one: resistance and drive, for an engine exchanged."""
    resisting, driving = tr_in("index of moment and work", "r"), tr_in("index of moment and work", "d")
    return (resisting, driving) if fw.reduced.resisting else (driving, resisting)


def _stretches(fw: Flywheel) -> list[tuple[float, float]]:
    """Stretches of the cycle between the jumps of the force."""
    return list(pairwise([0.0, *(b for b in fw.reduced.breaks if 0 < b < fw.reduced.period), fw.reduced.period]))


def _inside(fw: Flywheel, a: float, b: float) -> Floats:
    """Angles for a curve from ``a`` to ``b``, both included."""
    return np.concatenate(([a], fw.samples[(fw.samples > a) & (fw.samples < b)], [b]))


def _energy_range(fw: Wittenbauer) -> tuple[float, float]:
    """Lowest and highest ordinate of the graph of dE, of the ends of ab and of the axis, mm."""
    ends = [fw.energy_mass_plan[end].value.imag for end in "ab"]
    curve = fw.energy_curve(fw.samples)
    return min(float(curve.min()), *ends, 0.0), max(float(curve.max()), *ends, 0.0)


def _energy_graph(fw: Wittenbauer, box: Box, options: graphs.Options) -> graphs.Graph:
    """Axes of the graph of dE, and the level of the energy-mass diagram: room for ``b`` below, for the tangent above."""
    low, high = _energy_range(fw)
    spare = box.height - (_UNDER + high - low + graphs.HEAD + graphs.OVER)
    graphs.check_room(box, "flywheel.total_work", box.y1 - spare)
    return graphs.Graph(complex(options["axis"], box.y0 + _UNDER - low + max(spare, 0.0) / 2))


def _inertia_graph(fw: Flywheel, box: Box, options: graphs.Options) -> graphs.Graph:
    return graphs.Graph(complex(options["axis"],
        box.y1 - 16 - max((box.height - 16 - fw.inertia_angle.mm(fw.inertia_turn) - graphs.OVER) / 2, 3.0)), -1j)


AB = 14.0
"""Distance of the dimension line of ab from the axis of the energy-mass diagram, mm."""
BESIDE = 10.0
"""How near to a tangent the number of a point could be taken for that of the point of contact, mm."""


@in_role("symbol")
def _cut(canvas: Canvas, at: complex, half: float, low: float, top: float) -> None:
    outline = at + np.array([complex(-half, low), complex(half, low), complex(half, top), complex(-half, top)])
    canvas.polyline(outline, "main", closed=True)
    hatch_polygon(canvas, outline)
