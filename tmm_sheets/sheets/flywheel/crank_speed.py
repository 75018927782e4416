"""Angular velocity of the input link over its angle, read off the energy-mass diagram: a view for room that a sheet has left.

The option ``axis`` is the x of the ordinate axis of the other graphs, mm: beneath them its positions stand under theirs.
"""

from __future__ import annotations

from math import floor, log10
from typing import TYPE_CHECKING, Any

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import fit
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import number
from tmm_sheets.sheets.components import graphs
from tmm_sheets.sheets.flywheel import flywheel
from tmm_sheets.sheets.player import stage
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SIZES = ((260.0, 120.0), (220.0, 105.0), (180.0, 105.0), (150.0, 105.0))
LEFT, RIGHT, BELOW, ABOVE = 22.0, 14.0, 9.0, 14.0
"""Room beside the axes for their signs and the names of the extremes, mm."""


def graph_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> tuple[tuple[float, float], ...]:
    """Sizes from that of the sheet's other graphs down; none where no tangents are drawn or no flywheel is needed."""
    fw = project.flywheel
    if fw.method != "wittenbauer" or not fw.needed:
        return ()
    as_others = fw.scales.angle.mm(fw.reduced.period) + LEFT + RIGHT
    return (*((as_others, high) for high in (145.0, 120.0, 105.0)), *(size for size in SIZES if size[0] < as_others))


def graph_left(options: dict[str, Any]) -> float:
    """Left edge, mm, with which its axis stands under those of the other graphs."""
    return float(options["axis"]) - LEFT


def graph(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Differences from the mean angular velocity over the turn of the crank, with the bounds at the tangents."""
    fw = flywheel.with_tangents(project)
    if not fw.needed:
        raise CannotBuild(tell("no flywheel is needed: the energy-mass diagram does not tell how the crank runs"),
                          tell("leave the view crank_speed.graph out"))
    plan, mean = fw.speed_plan, fw.reduced.omega1
    highest, lowest = (float(plan[f"ω_{name}"].value) for name in ("max", "min"))
    x, wide = fw.scales.angle, box.width - LEFT - RIGHT
    if x.mm(fw.reduced.period) > wide + 1e-6:
        x = fit(x.symbol, x.unit, fw.reduced.period, wide)
    room = box.height - 18.0 - BELOW - ABOVE
    y = fit("μ_ω", tr("s^{−1}/mm"), highest - lowest, room)
    left = canvas.title(box, tr("Graph of the angular velocity ω_1(φ_1)"), f"{y}, {x}")
    high, low = y.mm(highest - mean), y.mm(lowest - mean)
    g = graphs.Graph(complex(left.x0 + LEFT, left.y1 - ABOVE - high))
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
