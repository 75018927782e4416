"""Views of the cam sheet: diagrams of the motion, pressure angle, spring, table; what all its views share."""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import wraps
from itertools import pairwise
from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.scale import Scale, fit_standard, handy
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.numbers import fixed, number

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Step
    from tmm_sheets.methods.cams.cam_closure import Spring
    from tmm_sheets.methods.cams.cam_laws import PositionFunction
    from tmm_sheets.methods.cams.cam_motion import FollowerMotion
    from tmm_sheets.methods.cams.cam_profile import Cam, RollerCam

HEADS = 66.0
"""Height the diagrams leave to headings, axes and dimensions, mm."""
PAPER = Scale("μ", 1.0, "мм/мм")
"""The diagrams of the motion are constructed in millimetres of paper."""

View = Callable[[Any, Canvas, Box, dict[str, Any]], None]


def for_cams(view: View) -> View:
    """A view that is drawn for the cams its arrangement means: ``when`` names traits they have, ``unless`` ones they have not.

    Traits: tappet, rocker, flat (kind of follower); roller, plate; force, geometric (closure); spring.
    """

    @wraps(view)
    def drawn(project: Any, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
        traits = project.cam.traits
        if traits.issuperset(options.get("when", ())) and traits.isdisjoint(options.get("unless", ())):
            view(project, canvas, box, options)

    return drawn


def distinct(labels: tuple[str, ...], x: Points) -> list[int]:
    """Positions to be numbered: where two fall together (no dwell between), the first."""
    return [k for k in range(len(labels)) if k == 0 or abs(x[k] - x[k - 1]) > 1e-9]


def standard(width: float, height: float, room_x: float, room_y: float) -> tuple[int, int, Scale]:
    """Largest standard scale (real, drawn) at which an object of ``width`` x ``height`` m fits its room, mm."""
    both = fit_standard(width * 1e3, room_x), fit_standard(height * 1e3, room_y)
    real, drawn = min(both, key=lambda s: s[1] / s[0])
    return real, drawn, Scale("μ_l", 1e-3 * real / drawn, "м/мм")


def lines_of_text(canvas: Canvas, box: Box, lines: Sequence[str]) -> None:
    """Lines of results at the foot of a view's place."""
    for i, line in enumerate(lines):
        canvas.text(complex(box.x0 + 6.0, box.y0 + 3.0 + 7.0 * (len(lines) - 1 - i)), line, 3.5)


# --- diagrams of the motion -----------------------------------------------------------------------------------------


@for_cams
def motion(project: Any, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """S'', S' and S one under another over a common axis of the cam angle, with both graphical integrations."""
    cam: Cam = project.cam
    law = cam.law
    names = dict.fromkeys(p.law.title for p in (law.rise, law.fall))
    whose = "коромысла" if law.symbol == "ψ" else "толкателя"
    # The turned designation of the sheet stands in the upper left corner.
    area = canvas.title(Box(max(box.x0, 92.0), box.y0, box.x1, box.y1), f"Закон движения {whose} ({', '.join(names)})")
    m = cam.motion_on(box.width, area.height - HEADS)
    canvas.scales[m.plan.name] = PAPER
    curves = (m.curve_dds(), m.curve_ds(), m.curve_s())
    ups = [max(float(c.imag.max()), 0.0) for c in curves]
    downs = [max(float(-c.imag.min()), 0.0) for c in curves]
    end = float(m.scales.phi.mm(law.fall.end))
    left = max(m.scales.h1, m.scales.h2) + 8.0
    if m.circle:
        centre = complex(m.plan["M"].value)
        left = max(left, max(abs(complex(s.value) - centre) for s in m.circle.values()) + 3.0 - centre.real)
    x0 = box.x0 + left + max(box.width - left - end - 14.0, 0.0) / 2
    foot = 22.0  # numbers and dimensions of the phases under the lowest diagram
    gap = (area.height - foot - sum(ups) - sum(downs)) / 3
    origins, y = [], area.y1
    for up, down in zip(ups, downs, strict=True):
        y -= gap + up
        origins.append(complex(x0, y))
        y -= down
    _phase_borders(canvas, m, origins, ups)
    heads = (
        f"{m.scales.dds}",
        f"{m.scales.ds},  H_1 = {number(m.scales.h1)} мм",
        f"{m.scales.s},  H_2 = {number(m.scales.h2)} мм",
    )
    units = ("м",) * 3 if law.symbol == "S" else ("", "", "рад")
    symbols = [", ".join(filter(None, pair)) for pair in zip(m.names, units, strict=True)]
    steps = (m.dds, m.ds, m.s)
    for o, up, down, curve, ordinates, symbol, head in zip(origins, ups, downs, curves, steps, symbols, heads, strict=True):
        _diagram(canvas, o, up, down, end, symbol, head)
        _ordinates(canvas, o, m, ordinates)
        canvas.polyline(o + curve, "curve")
    if m.circle:
        _auxiliary_circle(canvas, origins[0], m)
    _integration(canvas, origins[0], origins[1], m, m.names[1], m.ds, "P_1", "H_1", downs[0])
    _integration(canvas, origins[1], origins[2], m, m.names[2], m.s, "P_2", "H_2", downs[1])
    _phase_angles(canvas, m, origins[2] - 7j)
    _relations(canvas, m, complex(box.x0 + 2.0, origins[2].imag + ups[2]))


def _phase_borders(canvas: Canvas, m: FollowerMotion, origins: list[complex], ups: list[float]) -> None:
    """Lines through all diagrams where rise and fall begin and end, interrupted where the headings stand."""
    for p in (m.law.rise, m.law.fall):
        for at in (p.start, p.end):
            x = origins[0].real + float(m.scales.phi.mm(at))
            for upper, lower, up in zip(origins, origins[1:], ups[1:], strict=False):
                head = lower.imag + up
                canvas.line(complex(x, upper.imag), complex(x, head + 11.0), "construction")
                canvas.line(complex(x, head + 4.0), complex(x, lower.imag), "construction")


def _phase_angles(canvas: Canvas, m: FollowerMotion, base: complex) -> None:
    """Dimensions of the phases in a row that begins at ``base``; of narrow ones only the sign, below the row if need be."""
    for p in (m.law.rise, m.law.upper_dwell, m.law.fall):
        if p.angle > 0:
            a, b = (base + float(m.scales.phi.mm(v)) for v in (p.start, p.end))
            wide = abs(b - a)
            full = f"{p.symbol} = {number(degrees(p.angle))}°"
            canvas.dimension(a, b, -8.0, full if wide > 28.0 else p.symbol if wide > 9.0 else "")
            if wide <= 9.0:
                canvas.label((a + b) / 2 - 8j, p.symbol, -1j, 3.5, 1.5, leader=False)


def _relations(canvas: Canvas, m: FollowerMotion, at: complex) -> None:
    """Scale factor of the angle, and how the other scale factors and the heights of S'' follow from one another."""
    law = m.law
    canvas.text(at, f"{m.scales.phi}  ({number(degrees(m.scales.phi.mu))} град/мм)", 3.5)
    second, first, zero = (f"μ_{name}" for name in m.names)
    equal = "φ_с^2/φ_у^2 = " if law.rise.law.peak == law.fall.law.peak else ""
    lines = (
        f"a_1/a_2 = {equal}{number(abs(m.plan['a_1'].value))}/{number(abs(m.plan['a_2'].value))}",
        f"{first} = {second}·μ_φ·H_1",
        f"{zero} = {first}·μ_φ·H_2",
    )
    for i, line in enumerate(lines, 1):
        canvas.text(complex(at.real, at.imag - 8.0 * i), line, 3.5)


def _diagram(canvas: Canvas, o: complex, up: float, down: float, end: float, symbol: str, head: str) -> None:
    """Axes of one diagram with the letter of its quantity and its scale factor."""
    canvas.arrow(o - 1j * (down + 3.0 if down else 0.0), o + 1j * (up + 10.0), "axis", 3.0)
    canvas.arrow(o, o + end + 13.0, "axis", 3.0)
    canvas.text(o + complex(2.5, up + 6.0), symbol, 3.5)
    canvas.text(o + complex(22.0, up + 6.0), head, 3.5)
    canvas.label(o + end + 12.0, "φ, рад", 1j, 3.5, 1.5, leader=False)


def _ordinates(canvas: Canvas, o: complex, m: FollowerMotion, steps: list[Step]) -> None:
    """Ordinates of the numbered positions, their numbers on the other side of the axis."""
    points = np.array([complex(s.value) for s in steps])
    kept = distinct(m.law.labels, points.real)
    narrow = min(np.diff(points.real[kept]), default=10.0) < 6.0
    for k in kept:
        at = o + points[k].real
        canvas.line(at, o + points[k], "thin")
        side = -1j if points[k].imag > -1e-6 else 1j
        canvas.label(at, m.law.labels[k], side, 2.5 if narrow else 3.5, 0.7, leader=False)


def _auxiliary_circle(canvas: Canvas, o: complex, m: FollowerMotion) -> None:
    """Auxiliary circles of the law with their division points carried to the ordinates."""
    centre = o + complex(m.plan["M"].value)
    half = m.law.parts + 1
    radii = {}
    phases = [(name, first) for name, first in (("a_1", 0), ("a_2", half)) if first in m.circle]
    largest = max(abs(complex(m.circle[first].value) - complex(m.plan["M"].value)) for _, first in phases)
    for name, first in phases:
        at = np.array([o + complex(m.circle[first + k].value) for k in range(half)])
        radius = float(abs(at[0] - centre))
        radii[name] = radius
        canvas.circle(centre, radius, "thin")
        shown: list[complex] = []
        for k, p in enumerate(at):
            canvas.line(p, o + complex(m.dds[first + k].value), "construction")
            if any(abs(p - q) < 0.5 for q in shown):
                continue
            shown.append(p)
            canvas.line(centre, p, "construction")
            canvas.dot(p, 0.5)
            same = [m.law.labels[first + j] for j in range(half) if abs(at[j] - p) < 0.5]
            outwards = (p - centre) / radius
            canvas.label(p, ", ".join(same), -outwards if radius >= largest - 1e-9 else outwards, 2.5, 0.5, leader=False)
    reach = largest + 3.0
    canvas.line(centre - reach, centre + reach, "centre")
    canvas.line(centre - 1j * reach, centre + 1j * reach, "centre")
    angle = 1.15
    for name, radius in radii.items():
        tip = centre + rect(radius, pi - angle)
        canvas.arrow(centre, tip, "thin", 2.5)
        canvas.label(centre + rect(0.6 * radius, pi - angle), name, 1j * rect(1, pi - angle), 3.5, 0.6, leader=False)


def _integration(canvas: Canvas, upper: complex, lower: complex, m: FollowerMotion, symbol: str, ends: list[Step],
                 pole: str, distance: str, down: float) -> None:
    """Rays from the pole of the upper diagram, rectangles of equal area, chords of the lower diagram."""
    plan = m.plan
    at = upper + complex(plan[f"{symbol}_P"].value)
    lowest = 0.0
    for first, last in pairwise(dict.fromkeys(s.name for s in ends)):
        label = last.removeprefix(f"{symbol}_")
        middle, cut = complex(plan[f"{symbol}_m{label}"].value), complex(plan[f"{symbol}_{label}′"].value)
        start, end = complex(plan[first].value), complex(plan[last].value)
        canvas.line(upper + complex(start.real, middle.imag), upper + complex(end.real, middle.imag), "thin")
        canvas.line(upper + cut, upper + complex(start.real, middle.imag), "construction")
        canvas.line(at, upper + cut, "construction")
        canvas.line(lower + start, lower + end, "construction")
        lowest = min(lowest, cut.imag)
    canvas.dot(at, 0.6)
    canvas.label(at, pole, -1 + 1j, 3.5, 0.8, leader=False)
    canvas.line(at, upper, "axis")
    canvas.dimension(at, complex(upper), min(lowest, -down) - 7.0, distance)


# --- pressure angle -------------------------------------------------------------------------------------------------


@for_cams
def pressure(project: Any, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Pressure angle over a turn of the cam, measured at the finished profile, with the permitted value."""
    cam: RollerCam = project.cam
    dense, inv = cam.dense, cam.inversion
    y = np.degrees(dense.angles.value)
    allowed = degrees(cam.alpha)
    up, down = max(float(y.max()), allowed), max(float(-y.min()), allowed)
    area = Box(box.x0 + 10, box.y0 + 12, box.x1 - 8, box.y1 - 26)
    across = Scale("μ_φ", handy(360 / (area.width - 10)), "град/мм")
    tall = Scale("μ_α", handy((up + down) / (area.height - 8)), "град/мм")
    canvas.title(box, "Угол давления", f"{tall},  {across}")
    o = complex(area.x0 + (area.width - 10 - across.mm(360)) / 2, area.centre.imag - 4 + tall.mm(down - up) / 2)
    canvas.arrow(o - 1j * (tall.mm(down) + 3), o + 1j * (tall.mm(up) + 9), "axis", 3.0)
    canvas.arrow(o, o + across.mm(360) + 9, "axis", 3.0)
    canvas.text(o + complex(2.5, tall.mm(up) + 5.5), "α, град", 3.5)
    canvas.label(o + across.mm(360) + 5, "φ, град", -1j, 3.5, 1.5, leader=False)
    for limit, side in ((allowed, 1.0), (-allowed, -1.0)):
        level = o + 1j * tall.mm(limit)
        canvas.line(level, level + across.mm(360), "hidden")
        name = f"[α] = {number(limit)}°" if side > 0 else "−[α]"
        canvas.label(level + across.mm(300), name, 1j * side, 3.5, 0.8, leader=False)
    canvas.polyline(o + across.mm(np.degrees(dense.phi)) + 1j * tall.mm(y), "curve")
    at = o + across.mm(np.degrees(inv.phi))
    values = tall.mm(np.degrees(inv.angles.value))
    for k in range(len(at)):
        canvas.line(at[k], at[k] + 1j * values[k], "thin")
    n = cam.law.parts
    for k in (0, n // 2, n, n + 1, n + 1 + n // 2, 2 * n + 1):
        if k != n + 1 or abs(at[n + 1] - at[n]) > 4:
            canvas.label(complex(at[k]), inv.plan.labels[k], -1j if values[k] > 0 else 1j, 2.5, 0.6, leader=False)
    if cam.data.limit == "rise":
        canvas.text(complex(box.centre.real, box.y0 + 3), "При силовом замыкании угол ограничен только на удалении", 3.5, "centre")


# --- table ----------------------------------------------------------------------------------------------------------


@for_cams
def table(project: Any, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """S, S', S'' and the pressure angle in the numbered positions."""
    cam: Cam = project.cam
    second = _second_derivative(cam.motion.law)
    columns = [["Положение", *cam.motion.law.labels], ["φ, град", *(fixed(v, 2) for v in np.degrees(cam.inversion.phi))],
               *_diagram_rows(cam.motion, second), *_check_values(cam, second)]
    first = 32.0 if len(second) > 1 else 26.0
    width = (box.width - first) / (len(columns[0]) - 1)
    row = min(box.height / len(columns), 8.0)
    canvas.table(complex(box.x0, box.y1), [first, *[width] * (len(columns[0]) - 1)], columns, row, 2.5)


def _second_derivative(law: PositionFunction) -> dict[str, Any]:
    """The second derivative at the numbered positions by the side it is taken from: both limits where it jumps."""
    before, after = law.dds_beside
    if np.allclose(before, after, rtol=0, atol=1e-9 * float(np.abs((before, after)).max())):
        return {"": before}
    return {" (φ−0)": before, " (φ+0)": after}


def _diagram_rows(m: FollowerMotion, second: Mapping[str, Any]) -> Iterator[list[str]]:
    """Two rows for each diagram: ordinates on paper, and what they mean."""
    factor, unit = (1e3, "·10^3, м") if m.law.symbol == "S" else (1.0, "")
    for symbol, steps, scale in zip(reversed(m.names), (m.s, m.ds, m.dds), (m.scales.s, m.scales.ds, m.scales.dds), strict=True):
        rows = second if steps is m.dds and len(second) > 1 else {"": m.measured(steps, scale)}
        for side, values in rows.items():
            yield [f"y_{{{symbol}}}{side}, мм", *(fixed(v, 1) for v in scale.mm(values))]
            head = f"{symbol}{side}{unit}" + (", рад" if symbol == "ψ" else "")
            yield [head, *(fixed(v * factor, 2 if unit else 3) for v in values)]


def _check_values(cam: Cam, second: Mapping[str, Any]) -> Iterator[list[str]]:
    """What the dimensions of the cam rest upon: the pressure angle, under a flat follower S + S''."""
    if "roller" in cam.traits:
        yield ["α, град", *(fixed(v, 1) for v in np.degrees(cam.inversion.angles.value))]
        return
    s = cam.motion.law.at_positions(lambda p, x: p.s(x))
    for side, values in second.items():
        yield [f"(S + S''){side}·10^3, м", *(fixed(v * 1e3, 2) for v in s + values)]


# --- spring ---------------------------------------------------------------------------------------------------------


@for_cams
def spring(project: Any, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Force of the closing spring against the force of inertia over the cam angle, with the least ratio of both."""
    cam: Cam = project.cam
    spring, law = cam.spring, cam.law
    assert spring is not None
    pieces = []
    for p in law.phases[:-1] if law.lower_dwell.angle else law.phases:
        for a, b in zip((0.0, *p.law.jumps), (*p.law.jumps, 1.0), strict=True):
            x = np.linspace(a + 1e-12, b - 1e-12, 65)
            pieces.append((p.phi(x), spring.force(p.s(x)), spring.inertia(np.asarray(p.dds(x)))))
    phi, force, inertia = (np.concatenate([piece[i] for piece in pieces]) for i in range(3))
    top, low = float(max(force.max(), inertia.max())), float(min(inertia.min(), 0.0))
    lines = _spring_lines(spring, law.symbol == "S")
    text = max(letter(line, 3.5).width for line in lines) + 16.0
    beside = box.width > 1.7 * box.height
    area = box.inset(14, 8, text, 32) if beside else box.inset(14, 14 + 7.0 * len(lines), 8, 32)
    across = Scale("μ_φ", handy(degrees(law.fall.end) / (area.width - 12)), "град/мм")
    tall = Scale("μ_F", handy((top - low) / area.height), "Н/мм")
    canvas.title(box, "Замыкающая пружина", f"{tall},  {across}")
    end = float(across.mm(degrees(law.fall.end)))
    o = complex(area.x0 + (area.width - 12 - end) / 2, area.y0 - tall.mm(low) + (area.height - tall.mm(top - low)) / 2)

    def at(angle: Any, y: Any) -> Any:
        return o + across.mm(np.degrees(angle)) + 1j * tall.mm(y)

    canvas.arrow(o + 1j * (tall.mm(low) - 3), o + 1j * (tall.mm(top) + 8), "axis", 3.0)
    canvas.arrow(o, o + end + 10, "axis", 3.0)
    canvas.text(o + complex(2.5, tall.mm(top) + 4.5), "F, Q, Н", 3.5)
    canvas.label(o + end + 7, "φ, град", 1j, 3.5, 1.5, leader=False)
    canvas.polyline(at(phi, force), "curve")
    canvas.polyline(np.concatenate(([o], at(phi, inertia), [o + end])), "main")
    x = at(law.positions, 0.0)
    for k in distinct(law.labels, x.real):
        value = spring.force(float(law.at_positions(lambda p, x: p.s(x))[k]))
        canvas.line(complex(x[k]), complex(at(law.positions[k], value)), "thin")
        canvas.label(complex(x[k]), law.labels[k], -1j, 2.5, 0.6, leader=False)
    k = int(np.argmax(force))
    canvas.label(complex(at(phi[k], force[k])), "F", 1j, 3.5, 1.0)
    k = int(np.argmin(inertia))
    canvas.label(complex(at(phi[k], inertia[k])), "Q", 1.0 + 0j, 3.5, 1.0)
    worst = float(spring.force(law.s(spring.worst_phi)))
    for y in (worst, worst / spring.worst):
        canvas.dot(complex(at(spring.worst_phi, y)), 0.8)
    if not beside:
        lines_of_text(canvas, box, lines)
        return
    for i, line in enumerate(lines):
        canvas.text(complex(box.x1 - text + 12.0, box.y1 - 34.0 - 8.0 * i), line, 3.5)


def _spring_lines(spring: Spring, straight: bool) -> list[str]:
    """The spring in formulas and numbers; of a rocker the forces are those at the centre of the roller."""
    moved, way = ("m", "S") if straight else ("J/AB^2", "AB·ψ")
    held = "> 1: отрыва нет" if spring.closed else f"≤ 1: отрыв! Нужно F_{{max}} ≥ {fixed(spring.needed_factor, 2)}·Q_{{max}}"
    return [
        f"Q = −{moved}·ω^2·{way}''" + ("" if straight else " (в точке B)"),
        f"{moved} = {number(spring.mass)} кг,  ω = {number(spring.speed)} рад/с",
        f"Q_{{max}} = {number(spring.largest_inertia)} Н (отрывает при {'S' if straight else 'ψ'}'' < 0)",
        f"F_{{max}} = {number(spring.factor)}·Q_{{max}} = {number(spring.f_max)} Н",
        f"F_0 = {number(spring.preload)}·F_{{max}} = {number(spring.f_0)} Н",
        f"c = (F_{{max}} − F_0)/{'S' if straight else 'AB·ψ'}_{{max}} = {number(spring.rate * 1e-3)} Н/мм",
        f"(F/Q)_{{min}} = {fixed(spring.worst, 3)} при φ = {fixed(degrees(spring.worst_phi), 1)}°",
        f"(F/Q)_{{min}} {held}",
    ]
