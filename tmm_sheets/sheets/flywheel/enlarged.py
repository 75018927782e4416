"""Graphs for room that a sheet of the flywheel has left: those of energy and inertia enlarged, and the crank's speed.

Where dE is little beside what belongs to it, the links' own energy, or the segment ab, sets the scale factor of the construction;
where J hardly varies, that of the links that always turn. What is too low or too narrow at it to be read is shown again, its
tangencies too, at a scale factor of its own: dE from the axis on, J from where it begins. With its
option ``left`` the axis of the graph of the angular velocity stands ``LEFT`` from there, under those of the other graphs.
"""

from __future__ import annotations

from dataclasses import replace
from math import floor, log10
from typing import TYPE_CHECKING, cast

import numpy as np

from tmm_sheets.construction.scale import MAIN, Scale, fit
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink import segment_inside
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import is_zero, number
from tmm_sheets.sheets.components import graphs
from tmm_sheets.sheets.flywheel import flywheel, mertsalov
from tmm_sheets.sheets.player import stage, together
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.wheel_methods import Wittenbauer
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import Arrangement

LEFT, RIGHT, BELOW, ABOVE = 22.0, 14.0, 9.0, 12.0
"""Room beside the axes for their signs and numbers, mm."""
TITLE = 18.0
"""Room of a title with the scale factors and what is said of them, mm."""
SHARES = (1.0, 0.75, 0.6, 0.45)
"""Shares of the abscissae's own scale that an enlarged graph can do with."""


def _x_scale(x: Scale, span: float, box: Box) -> Scale:
    """The scale factor of abscissae, or a coarser one with which their ``span`` finds room."""
    room = box.width - LEFT - RIGHT
    return x if x.mm(span) <= room + 1e-6 else fit(x.symbol, x.unit, span, room)


def _begun(canvas: Canvas, box: Box, title: str, scales: tuple[Scale, Scale], high: float) -> tuple[Box, graphs.Graph]:
    """The place under the title of a graph, and the axes there over which it is so high, mm; ``scales`` are those across and up."""
    left = canvas.title(box, title, f"{scales[1]}, {scales[0]}")
    return left, graphs.Graph(complex(left.x0 + LEFT, left.y1 - ABOVE - high))


def apart(project: Project, plan: Arrangement) -> Arrangement:
    """The arrangement with as much of the place over the enlarged graph of dE as it needs: all or nothing of its own."""
    own = next((view for view in plan.views if view.draw == "enlarged.change"), None)
    if own is None:
        return plan
    wanted = change_sizes(project, Canvas(), own.options)
    over = min((view for view in plan.views if view.box.x0 == own.box.x0 and view.box.y0 >= own.box.y1), key=lambda v: v.box.y0)
    top = own.box.y0 + wanted[0][1] if wanted else own.box.y0 - (over.box.y0 - own.box.y1)
    moved = {own.draw: replace(own, box=own.box._replace(y1=top)),
             over.draw: replace(over, box=over.box._replace(y0=top + over.box.y0 - own.box.y1))}
    return replace(plan, views=tuple(moved.get(view.draw, view) for view in plan.views if wanted or view is not own))


def change_sizes(project: Project, canvas: Canvas, options: graphs.Options) -> tuple[tuple[float, float], ...]:
    """Sizes of the graph of dE by Mertsalov's procedure, which shares its axis with the energies of the links, mm.

    None where that of the construction is high enough.
    """
    fw = project.flywheel
    if fw.method != "mertsalov":
        return ()
    span, across = float(np.ptp(np.append(fw.energy_curve(fw.samples), 0.0))), fw.scales.angle.mm(fw.reduced.period)
    high = span * fw.scales.energy.mu / fw.enlarged(fw.scales.energy, span).mu if 0 < span < MAIN else 0.0
    return tuple((share * across + LEFT + RIGHT, high + TITLE + ABOVE + BELOW) for share in SHARES) if high else ()


def change(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """The change of kinetic energy over the turn of the crank, alone and enlarged."""
    fw = mertsalov.procedure(project)
    name = tr(options.get("energies", mertsalov.ENERGIES)[0])
    curve = fw.energy_curve(fw.samples)
    y, x = fw.enlarged(fw.scales.energy, float(np.ptp(np.append(curve, 0.0)))), _x_scale(fw.scales.angle, fw.reduced.period, box)
    times, narrower = fw.scales.energy.mu / y.mu, fw.scales.angle.mu / x.mu
    low, high = min(0.0, times * float(curve.min())), max(0.0, times * float(curve.max()))
    _, g = _begun(canvas, box, tr("Graph of {change}(φ_1), enlarged").format(change=name), (x, y), high)
    canvas.of = fw.total_plan.name
    of = stage(canvas, fw.total_plan, None, g.place(1 / narrower, 1 / times))
    of.curve("points", g(x.mm(fw.samples) + 1j * times * curve))
    for k, p in enumerate(fw.total_plan["points"].value):
        at = narrower * p.real
        of.position(k).line("points", g(at), g(at + 1j * times * p.imag), "thin")
    flywheel.axes(fw, of, "points", g, (low, high), tr("{quantity}, J").format(quantity=name),
                  fw.total_plan["points"].value.imag, x)


def larger(fw: Wittenbauer) -> tuple[Scale, Scale, float]:
    """Scale factors of the enlarged energy-mass diagram across and up, and the inertia at which its axis begins.

    Both its own scale factors where it is large enough.
    """
    curve, x, y = fw.energy_mass_curve(fw.samples), fw.scales.inertia, fw.scales.energy
    high, wide, first = float(np.ptp(np.append(curve.imag, 0.0))), float(np.ptp(curve.real)), 0.0
    if 0 < high < MAIN:
        y = fw.enlarged(y, high)
    if wide < MAIN and not is_zero(wide, float(curve.real.max())):
        x = fw.enlarged(x, wide)
        first = 10 * x.mu * floor(fw.scales.inertia.real(float(curve.real.min())) / (10 * x.mu))
    return x, y, first


def energy_mass_sizes(project: Project, canvas: Canvas, options: graphs.Options) -> tuple[tuple[float, float], ...]:
    """Sizes of the energy-mass diagram beside which the segment ab is long or the inertia large, mm; none where neither is."""
    fw = project.flywheel
    if fw.method != "wittenbauer":
        return ()
    x, y, first = larger(cast("Wittenbauer", fw))
    if (x, y) == (fw.scales.inertia, fw.scales.energy):
        return ()
    across = x.mm(float(fw.inertia(fw.samples).max()) - first)
    high = y.mm(fw.scales.energy.real(float(np.ptp(np.append(fw.energy_curve(fw.samples), 0.0)))))
    return tuple((share * across + LEFT + RIGHT, high + TITLE + ABOVE + BELOW) for share in SHARES)


def energy_mass(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """The curve with its points and the tangents where they touch it; what they cut off is measured on the diagram itself."""
    fw = flywheel.with_tangents(project)
    plan, curve, (x, y, first) = fw.energy_mass_plan, fw.energy_mass_curve(fw.samples), larger(fw)
    widest = float(fw.inertia(fw.samples).max()) - first
    x = _x_scale(x, widest, box)
    times, narrower = fw.scales.energy.mu / y.mu, fw.scales.inertia.mu / x.mu

    def stretched(z: Points) -> Points:
        return narrower * np.real(z) + 1j * times * np.imag(z)

    low, high = min(0.0, times * float(curve.imag.min())), max(0.0, times * float(curve.imag.max()))
    left, g = _begun(canvas, box, tr("Energy-mass diagram, enlarged"), (x, y), high)
    canvas.of = plan.name
    whole = graphs.Graph(g.origin - x.mm(first))
    of = stage(canvas, plan, None, whole.place(1 / narrower, 1 / times))
    of.curve("points", whole(stretched(curve)))
    room = Box(g.origin.real, g.origin.imag + low - BELOW, left.x1, g.origin.imag + high + ABOVE)
    for name, end in (("max", "a"), ("min", "b")):
        u = complex(stretched(plan[f"t_{name}"].value))
        at, u = of.at(f"T_{name}"), u / abs(u)
        ends = segment_inside(room, at - 45.0 * u, at + 45.0 * u)
        if ends:
            canvas.tracing("construction", plan[end].path).line(*ends, "axis")
            canvas.label(ends[0], tr("to {point}").format(point=end), -u, 3.5, 1.0, leader=False)
        of.dot(f"T_{name}", 0.9, "main")
    points, middle = stretched(plan["points"].value), complex(stretched(curve).mean())
    for near in together(points[:-1], 1.0):
        of.position(near[0]).dot("points", 0.7, "main")
        away = points[near[0]] - middle
        of.position(near[0]).letters("points", ", ".join(fw.labels[k] for k in near), away / abs(away))
    pen = of.pen("points", "axis")
    graphs.axes(pen, g, x.mm(widest), low, high, tr("ΔE, J"), tr("J^red, kg·m^2"))
    if first:
        pen.label(complex(g(0j)), number(first), -1 + 0j, 3.5, 1.5, leader=False)


CRANK_SPEED = ((260.0, 120.0), (220.0, 105.0), (180.0, 105.0), (150.0, 105.0))


def graph_sizes(project: Project, canvas: Canvas, options: graphs.Options) -> tuple[tuple[float, float], ...]:
    """Sizes from that of the sheet's other graphs down; none where no tangents are drawn or no flywheel is needed."""
    fw = project.flywheel
    if fw.method != "wittenbauer" or not fw.needed:
        return ()
    as_others = fw.scales.angle.mm(fw.reduced.period) + LEFT + RIGHT
    return (*((as_others, high) for high in (145.0, 120.0, 105.0)), *(size for size in CRANK_SPEED if size[0] < as_others))


def graph(project: Project, canvas: Canvas, box: Box, options: graphs.Options) -> None:
    """Differences from the mean angular velocity over the turn of the crank, with the bounds at the tangents."""
    fw = flywheel.with_tangents(project)
    if not fw.needed:
        raise CannotBuild(tell("no flywheel is needed: the energy-mass diagram does not tell how the crank runs"),
                          tell("leave the view crank_speed.graph out"))
    plan, mean = fw.speed_plan, fw.reduced.omega1
    highest, lowest = (float(plan[f"ω_{name}"].value) for name in ("max", "min"))
    x = _x_scale(fw.scales.angle, fw.reduced.period, box)
    y = fit("μ_ω", tr("s^{−1}/mm"), highest - lowest, box.height - TITLE - BELOW - ABOVE)
    high, low = y.mm(highest - mean), y.mm(lowest - mean)
    _, g = _begun(canvas, box, tr("Graph of the angular velocity ω_1(φ_1)"), (x, y), high)
    # The axis stands at the mean: the zero of the angular velocities lies far below it.
    of = stage(canvas, plan, None, graphs.Graph(g.origin - 1j * y.mm(mean)).place(x.mu, y.mu))
    length = x.mm(fw.reduced.period)
    of.curve("ω1", g(x.mm(fw.samples) + 1j * y.mm(fw.speed_curve(fw.samples) - mean)))
    flywheel.axes(fw, of, "ω1", g, (low, high), tr("{symbol}, s^{{−1}}").format(symbol="ω_1"), plan["ω1"].value - mean, x)
    canvas.text(g(-2.0) + 1.0j, tr("ω_{1m}"), 3.5, "right")
    digits = max(4, 2 + floor(log10(mean / (highest - lowest))))  # the bounds differ in two digits at least
    for name, level in (("max", high), ("min", low)):
        pen = of.pen(f"ω_{name}", "axis")
        pen.line(g(1j * level), g(length + 1j * level), "thin")
        value = number(float(plan[f"ω_{name}"].value), digits)
        pen.text(g(length + 1j * level) + (1.3j if level > 0 else -5.0j), f"ω_{{{name}}} = {value}", 3.5, "right")
