"""Views of the cam sheet: main dimensions by the allowed zone of the axis, or by S + S'' under a flat follower."""

from __future__ import annotations

from functools import lru_cache
from math import pi, tan
from operator import mul
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tmm_sheets.construction.equation import Quantity, digits_for, equation
from tmm_sheets.construction.scale import CURVE, Scale, handy
from tmm_sheets.drawing.canvas import KEPT_OFF, Canvas, hatch_polygon
from tmm_sheets.drawing.ink import segment_inside
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.symbols import bar, hinge
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.border_solver import BorderNode, Need, leaf, reached, stepped
from tmm_sheets.sheets.cams.cam import ANGLE, OverAngle, centred, distinct, lines_of_text, raised, text_width
from tmm_sheets.sheets.components import clear_dimensions
from tmm_sheets.sheets.player import PlayerStage, placed, play, ratio, standard
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.cams.cam_profile import FlatCam, RockerCam, TappetCam
    from tmm_sheets.methods.cams.cam_zone import Zone
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace


NORMAL = 6.0
"""Length of the strokes along the velocity of a rocker's roller, mm."""


TAPPET = 10.0, 27.0, 10.0, 34.0
"""Room round the zone of a tappet: at the left, below for the lines that follow, at the right, above for the title, mm."""


def _beyond_angle(z: Zone, rays: bool) -> Any:
    """What of S(S') lies beyond the permitted angle, m; none where no rays are drawn."""
    return z.tips(z.beyond).value if rays and z.beyond is not None else z.curve.value[:0]


def _touches(z: Zone) -> list[tuple[complex, float]]:
    """Points where the tangents touch S(S'), m, and the sides on which they do."""
    return [(complex(t.value), z.right * side) for t, side in zip(z.touching, (1.0, -1.0), strict=True)]


def _tangent_tops(z: Zone, apex: complex, stroke: float) -> list[complex]:
    """Upper ends of the tangents, m."""
    return [apex + (min(t.imag + 0.25 * stroke, 1.05 * stroke) - apex.imag) * complex(side * tan(z.alpha), 1.0)
            for t, side in _touches(z)]


def fitted_tappet(cam: TappetCam, rays: bool, width: float, height: float) -> tuple[float, Box]:
    """Scale factor of a tappet's zone in so much room, mm, and the rectangle round its ink, m.

    The finest scale factor counts, then the deepest zone.
    """
    mu, _, real = min([(handy(max(wide / width, high / height)), real.y0, real)
                       for wide, high, real in _zones_of_tappet(cam, rays)])
    return mu, real


@lru_cache(maxsize=4)
def _zones_of_tappet(cam: TappetCam, rays: bool) -> list[tuple[float, float, Box]]:
    """Width, height and rectangle of the ink of a tappet's zone, m, for each depth that is tried."""
    z, stroke, slope = cam.zone, cam.law.stroke, tan(cam.zone.alpha)
    axis, apex = complex(z.apex.value), complex(z.plan["V"].value if "V" in z.plan else z.apex.value)
    ink = np.concatenate((z.curve.value.real, _beyond_angle(z, rays).real, [t.real for t in _tangent_tops(z, apex, stroke)], [0.0]))
    left, right = float(ink.min()), float(ink.max())
    depths = [share * (stroke + z.s0) * min(1.0, 0.6 / slope) + max((apex - axis).imag, 0.0) for share in (0.3, 0.22, 0.15)]
    zones = [Box(min(left, apex.real - depth * slope), apex.imag - depth, max(right, apex.real + depth * slope), stroke)
             for depth in depths]
    return [(zone.width, zone.height, zone) for zone in zones]


def stroke_in(cam: TappetCam, rays: bool, width: float, height: float) -> float:
    """Height, mm, that the stroke has on the zone of a tappet in a place of so many mm."""
    left, below, right, above = TAPPET
    return cam.law.stroke / fitted_tappet(cam, rays, width - left - right, height - below - above)[0]


NUMBERED, CROWDED = CURVE, 30.0
"""Heights of a curve on which all positions are numbered, and below which their numbers stand on one another, mm."""


def tappet_place(project: Project, view: ViewPlace) -> BorderNode:
    """A curve S(S′) with the numbers of all positions on it, which must be so high that they can be read."""
    cam, rays = cast("TappetCam", project.cam), bool(view.options.get("rays"))  # others have no such view

    def drawn(width: int, height: int) -> float:
        stroke = stroke_in(cam, rays, width, height)
        return 0.6 * width * height * min(stroke / NUMBERED, 1.0) * reached(stroke, CROWDED)

    return stepped(view, (0.88 * view.box.width, 0.8 * view.box.height), drawn)


def wide(project: Project, view: ViewPlace) -> BorderNode:
    """Need of a view that takes what room there is, down to a part of its box below which it cannot be read."""
    w, h = view.box.width, view.box.height
    return leaf(view.box, Need(least=(0.9 * w, 0.8 * h), drawn=lambda w, h: 0.6 * w * h))


def of_tappet(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """S(S') with the tangents under the permitted pressure angle, the allowed zone and the main dimensions."""
    cam = cast("TappetCam", project.cam)
    z = cam.zone
    slope = tan(z.alpha)
    curve, axis, apex = z.curve.value, complex(z.apex.value), complex(z.plan["V"].value if "V" in z.plan else z.apex.value)
    stroke = cam.law.stroke
    letter_of, rays = options.get("angle", ANGLE), bool(options.get("rays"))
    beyond, touches, tops = _beyond_angle(z, rays), _touches(z), _tangent_tops(z, apex, stroke)
    room, first = box.inset(*TAPPET), len(canvas.marks)
    mu, real = fitted_tappet(cam, rays, room.width, room.height)
    low = complex(apex.real, real.y0)
    wide = (apex - low).imag * slope
    scale = Scale("μ_S", mu, tr("m/mm"))
    box, room = raised(box, room, scale.mm(real.height))
    canvas.scales[z.plan.name] = scale
    canvas.title(box, tr("Main dimensions of the cam"), tr("μ_S = μ_S' = {factor} m/mm").format(factor=number(scale.mu)))
    origin = room.centre - scale.mm(real.centre)
    stage, smooth = placed(canvas, z.plan, origin, mu), placed(canvas, z.curve_plan, origin, mu)
    at = stage.frame
    v, o, b, c = at(apex), stage.at("O"), stage.at("B"), stage.at("C")
    hatch_polygon(canvas, np.array([v, at(low - wide), at(low + wide)]), 4.0)
    for (touch, side), top, step, border in zip(touches, tops, z.touching, z.borders, strict=True):
        stage.line(border, at(top), at(low - wide * side), "axis")
        if abs(touch) > 0:
            stage.dot(step, 0.6, "main", at(touch))
        canvas.label(at(touch), step.name, side + 0j, 3.5, 1.0)
    course = np.concatenate((curve, beyond))
    reach = float(course.real[np.argmax(z.right * course.real)])
    pen = smooth.pen(z.curve, "axis")
    pen.arrow(c - 4j, at(1j * stroke) + 9j, "axis", 3.0)
    pen.text(at(1j * stroke) + complex(-2.0, 5.5), tr("{symbol}, m").format(symbol="S"), 3.5, "right")
    pen.arrow(b, at(complex(reach)) + 10 * z.right, "axis", 3.0)
    canvas.label(at(complex(reach)) + 8 * z.right, tr("{symbol}, m").format(symbol="S'"), -1j, 3.5, 1.5, leader=False)
    smooth.curve(z.curve)
    if rays:
        _rays(stage, z, letter_of, pi / 2)
    points, labels = np.asarray(z.points.value), z.plan.labels
    numbered = distinct(labels, points)
    for k in numbered:
        here = stage.position(k)
        here.line(z.points, at(1j * points[k].imag), at(points[k]), "thin")
        here.dot(z.points, 0.5, "main")
        same = [labels[j] for j in numbered if abs(points[j] - points[k]) < 1e-9]
        if same[0] == labels[k]:
            canvas.label(at(points[k]), ", ".join(same), complex(points[k] - 1j * stroke / 2), 3.5, 0.8)
    stage.line("r_0", o, b, "main")
    stage.line("C", c, o, "thin")
    stage.line("V" if "V" in z.plan else "O", v, v + 1j * scale.mm(0.75 * z.s0), "centre", "axis")
    if abs(v - o) > 1:
        stage.line("O", o - 4j, at(complex(axis.real, 0.0)), "centre", "axis")
    stage.dot("O", 0.9, "main")
    canvas.label(o, "O", -1j + z.right, 5.0, 1.5)
    canvas.label(b, "B", complex(-z.right, -1.0) if rays else -z.right + 0j, 3.5, 1.0)
    canvas.label(c, "C", -z.right - 1j, 3.5, 0.8)
    radius = 0.5 * scale.mm(z.s0)
    canvas.angle_mark(v, pi / 2, pi / 2 + z.alpha, radius, f"[{letter_of}]")
    canvas.angle_mark(v, pi / 2 - z.alpha, pi / 2, radius, f"[{letter_of}]")
    # Beside the lines that run along CB: the axis of the zone, r0 and the path of B.
    sides = ((side * z.right * off, (b + side * z.right * off * 1j * (b - c) / abs(b - c)).real)
             for off in np.arange(9.0, room.width, 1.5) for side in (1, -1))
    clear_dimensions.dimension(canvas, first, c, b, [off for off, x in sides if room.x0 <= x <= room.x1], "S_0",
                               1e3 * scale.mu)
    if abs(o - c) > 6:
        canvas.label((o + c) / 2, "e", -1j, 3.5, 0.8, thin=KEPT_OFF)
    canvas.label((o + b) / 2, "r_0", z.right * 1 + 0.6j, 3.5, 0.6)
    measured = [_measured(name, f"|{segment}|", abs(value), "μ_S", mu)
                for name, segment, value in (("S_0", "CB", z.s0), ("e", "CO", z.e), ("r_0", "OB", z.r0))]
    if cam.data.base_radius is not None:
        measured[2] = tr("r_0 = {length} mm (given)").format(length=number(z.r0 * 1e3))
    if cam.data.eccentricity is not None:
        measured[1] = tr("e = {length} mm (given)").format(length=number(z.e * 1e3))
    lines_of_text(canvas, box, measured)


def _rays(s: PlayerStage, z: Zone, letter_of: str, axis: float | None = None) -> None:
    """Rays from the cam's axis to the points of all positions, those of the fall with their part of the curve.

    They stand off from the velocities of B by the pressure angles: from ``axis``, rad, where the follower moves along a line (the
    greatest of the rise is marked), from short strokes at the points of a rocker.
    """
    canvas, at, o = s.canvas, s.frame, s.at("O")
    law, step = z.exact.law, z.tips(z.every)
    points, turn = np.asarray(step.value), placed(canvas, z.every, complex(at(0j)), s.frame.mu[0])
    if z.beyond is not None:
        placed(canvas, z.beyond, complex(at(0j)), s.frame.mu[0]).curve(z.tips(z.beyond), style="axis")
    middle = points.mean()
    for k in distinct(law.labels, law.positions.astype(complex)):
        here = turn.position(k)
        here.line(step, o, here.at(step))
        if axis is None:
            here.line(step, here.at(step),
                      here.at(step) - NORMAL * (1j * np.exp(1j * z.cones.turn * z.exact.law.s(law.positions[k]))), "axis")
        if z.beyond is not None and k > law.parts and min(abs(points[k] - points[[0, law.parts]])) * 1e9 > 1:
            here.dot(step, 0.5, "main")
            name, height = (law.labels[k], 3.5) if axis is not None else (f"{law.labels[k]}_D", 2.5)
            canvas.label(here.at(step), name, complex(points[k] - middle), height, 0.8, thin=CLEAR)
    if axis is not None:
        k = int(np.argmax(np.abs(np.angle(points[1:law.parts] - z.apex.value) - pi / 2))) + 1
        ray = float(np.angle(points[k] - z.apex.value))
        canvas.angle_mark(o, min(axis, ray), max(axis, ray), 0.8 * abs(turn.position(k).at(step) - o),
                          f"{letter_of}_{{{law.labels[k]}}}")


def _measured(name: str, segment: str, value: float, scale: str, mu: float) -> str:
    """A main dimension, m, from its segment on paper and the scale factor."""
    return equation(mul, (Quantity(segment, value / mu, "", digits_for(value / mu, 2), 2), Quantity(scale, mu)),
                    Quantity(name, value, "m"))


CLEAR = 4.0
"""So many times more than other lettering do letters among the rays of a rocker's zone keep off thin lines."""
DEEP = 0.9
"""Greatest depth to which the zone of a rocker is drawn, in lengths of its arm."""


def fitted_rocker(cam: RockerCam, rays: bool, box: Box) -> tuple[float, Box, Box, bool]:
    """Scale factor of a rocker's zone in its place, the rectangle round its ink, m, its room, whether lines are beside.

    The finest scale factor counts, then the deepest zone.
    """
    z, measured = cam.zone, _rocker_lines(cam)
    apex = complex(z.apex.value)
    ink = Box.around(np.array([complex(z.plan["A"].value), apex, 0j, *z.axis.value, *z.curve.value, *_beyond_angle(z, rays)]))
    rooms = box.inset(14, 8, text_width(measured) + 20, 30), box.inset(12, 10 + 7.0 * len(measured), 12, 30)

    def fitted(room: Box, share: float) -> tuple[float, float]:
        """Scale factor, and the depth (m, negative) to which the zone is drawn: below the axis a share of the arm."""
        low = apex.imag - share * cam.arm
        return handy(max(ink.width / room.width, (ink.y1 - low) / room.height)), low

    # What is measured stands beside the figure in a wide place, unless the figure becomes larger over it.
    at_side, over = (min(fitted(room, share) for share in (0.4, 0.3, 0.2, 0.12)) for room in rooms)
    beside = box.width > 1.3 * box.height and at_side[0] <= over[0]
    room, (mu, low) = (rooms[0], at_side) if beside else (rooms[1], over)
    low = min(low, max(ink.y1 - mu * room.height, apex.imag - DEEP * cam.arm))  # what height is left is zone
    return mu, ink._replace(y0=low), room, beside


def of_rocker(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Positions of the rocker with the segments AB psi', rays under the permitted pressure angle, allowed zone, r0 and l0."""
    cam = cast("RockerCam", project.cam)
    z = cam.zone
    rays, letter_of = bool(options.get("rays")), options.get("angle", ANGLE)
    mu, real, room, beside = fitted_rocker(cam, rays, box)
    scale = Scale("μ_l", mu, tr("m/mm"))
    canvas.scales[z.plan.name] = scale
    canvas.title(box, tr("Main dimensions of the cam"), f"{scale}")
    origin = complex(room.centre - scale.mm(real.centre))
    stage, smooth = placed(canvas, z.plan, origin, mu), placed(canvas, z.curve_plan, origin, mu)
    at = stage.frame
    picture = Box.around(at(real.corners)).inset(-6.0, 0.0, -6.0, -4.0)
    _permitted(stage, cam, picture, scale)
    _rocker_positions(stage, cam)
    smooth.curve(z.curve)
    if rays:
        _rays(stage, z, letter_of)
    _rocker_and_axis(stage, cam, picture, letter_of)
    lines_of_text(canvas, box, _rocker_lines(cam, scale), beside=beside)


def _permitted(s: PlayerStage, cam: RockerCam, picture: Box, scale: Scale) -> None:
    """The allowed zone, the rays under the permitted pressure angle and the borders that touch the curve, inside the picture."""
    z, canvas, at = cam.zone, s.canvas, s.frame
    region = z.cones.region([complex(scale.real(p - at(0j))) for p in picture.corners])
    if len(region) > 2:
        hatch_polygon(canvas, np.asarray(at(region)), 5.0)
    reach = picture.width + picture.height
    rays = z.cones.rays(cam.law.parts)
    for k, ray in enumerate(rays):
        shown = segment_inside(picture, complex(at(ray.tip)), complex(at(ray.tip)) + reach * ray.direction)
        if shown and (k < 2 or abs(ray.tip - rays[k - 2].tip) > 1e-9):
            s.position(k // 2).line(z.points, *shown)
    for touch, border in zip(z.touching, z.borders, strict=True):
        tip = s.at(touch)
        shown = segment_inside(picture, tip, tip + reach * complex(border.value))
        if shown:
            s.line(border, *shown, "axis")
        s.dot(touch, 0.7, "main", tip)


def _rocker_positions(s: PlayerStage, cam: RockerCam) -> None:
    """Path of the roller's axis, the rocker in the numbered positions of the rise, the segments in all of them."""
    z, labels, canvas, at = cam.zone, cam.zone.plan.labels, s.canvas, s.frame
    pivot, starts, tips = complex(z.plan["A"].value), np.asarray(z.axis.value), np.asarray(z.points.value)
    numbered = distinct(labels, starts)
    rising = [k for k in numbered if k <= cam.law.parts]
    for k in rising[1:]:
        play(s.position(k), [z.axis], "thin")
    s.curve(z.axis, np.array([complex(at(p)) for p in z.cones.starts(cam.law.rise, np.linspace(0, 1, 65))]), "thin")
    for here in map(s.position, numbered):
        here.line(z.points, here.at(z.axis), here.at(z.points), "thin")
        here.dot(z.points, 0.5, "main")
    for k in rising:
        s.position(k).dot(z.axis, 0.6, "main")
        canvas.label(complex(at(starts[k])), labels[k], complex(starts[k] - pivot), 3.5, 0.8)
    for k in numbered:
        if abs(at(tips[k]) - at(starts[k])) > 6:
            canvas.label(complex(at(tips[k])), f"{labels[k]}_D", complex(tips[k] - starts[k]), 2.5, 0.6, thin=CLEAR)


def _rocker_and_axis(s: PlayerStage, cam: RockerCam, picture: Box, letter_of: str) -> None:
    """The rocker, the cam's axis in the zone's apex, both main dimensions and the permitted angles at the roller."""
    z, canvas = cam.zone, s.canvas
    pivot = complex(z.plan["A"].value)
    a, o, b = (s.at(name) for name in ("A", "O", "B_0"))
    for p, name in ((a, "A"), (b, "B_0")):
        hinge(s.pen(name, "symbol"), p)
    for name, ends in (("r_0", (o, b)), ("B_0", (b, a)), ("l_0", (a, o))):
        bar(s.pen(name, "link" if name == "B_0" else "construction"), ends, (a, b))
    s.dot("O", 0.9, "main")
    canvas.label(o, "O", -1j, 5.0, 1.5)
    canvas.label(a, "A", pivot - 0.5j * abs(pivot), 3.5, 2.2)
    canvas.label(b, "B_0", -pivot - 0.6j * abs(pivot), 3.5, 2.2)
    canvas.label((o + b) / 2, "r_0", 1j * (o - b), 3.5, 0.8)
    canvas.label((o + a) / 2, "l_0", 1j * (o - a), 3.5, 0.8)
    radius = 0.45 * min(abs(o - b), picture.height / 2)
    s.line("B_0", b, b - 1.3j * radius, "centre", "axis")
    for lo, hi in ((-pi / 2, -pi / 2 + z.alpha), (-pi / 2 - z.alpha, -pi / 2)):
        canvas.angle_mark(b, lo, hi, radius, f"[{letter_of}]")


def _rocker_lines(cam: RockerCam, scale: Scale | None = None) -> list[str]:
    """Main dimensions in formulas and numbers, and the least cam where it is another one."""
    z, mu = cam.zone, 1e-3 if scale is None else scale.mu
    lines = [_measured("r_0", "|OB_0|", z.r0, "μ_l", mu), _measured("l_0", "|OA|", z.l0, "μ_l", mu),
             tr("x_i = AB·ψ'_i towards the axis A") if cam.data.rotation == "same" else tr("x_i = AB·ψ'_i on AB produced")]
    if cam.data.base_radius is not None:
        lines[0] = tr("r_0 = {length} mm (given)").format(length=number(z.r0 * 1e3))
    if z.least is not None and (r0 := float(z.least["r_0"].value)) < z.r0 * (1 - 1e-6):
        lines += [tr("Least possible r_0 = {radius} mm").format(radius=fixed(r0 * 1e3, 2)),
                  tr("with l_0 = {length} mm (not in the apex of the zone)").format(
                      length=fixed(float(z.least["l_0"].value) * 1e3, 2))]
    return lines


def sum_graph(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Graph of S + S'' over the cam angle with its lowest ordinate; radius r0 and sizes of the plate."""
    cam = cast("FlatCam", project.cam)
    law, plate = cam.law, cam.plate
    steps = plate.course
    phi, s, total = (step.value for step in steps)
    span = min(float(total.min()), 0.0), max(float(total.max()), law.stroke)
    d = OverAngle.fitted(box.inset(14, 44, 14, 34), law.fall.end, span, ("μ_S", tr("m/mm")), 10.0)
    o, scale = d.o, d.tall
    canvas.scales[plate.plan.name] = scale
    canvas.title(box, tr("Radius r_0 and sizes of the plate"), tr("μ_S = μ_S'' = {factor} m/mm").format(factor=number(scale.mu)))
    course, found = d.placed(canvas, plate.course_plan), d.placed(canvas, plate.plan)
    at = course.frame
    d.axes(course, steps[2], (9.0, 9.0), tr("{symbol}, m").format(symbol="S + S''"), 6.0)
    canvas.label(o + d.length + 6, tr("{symbol}, rad").format(symbol="φ"), 1j, 3.5, 1.5, leader=False)
    course.curve(steps[1], at(phi + 1j * s), "centre")
    for name, values, away in (("S", s, -1 + 1j), ("S + S''", total, 1 + 1j)):
        k = int(np.argmax(values))
        canvas.label(complex(at(phi[k] + 1j * values[k])), name, away, 3.5, 0.8)
    course.curve(steps[2], d.from_axis(at(phi + 1j * total)))
    sums, base = np.asarray(plate.sums.value), cam.exact.positions.s.value
    along = at(law.positions)
    sides = [(at(law.positions + 1j * step.value), step) for step in reversed(plate.sides)]
    for k in distinct(law.labels, along.real):
        here = found.position(k)
        for point, step in reversed({complex(np.round(points[k], 6)): step for points, step in sides}.items()):
            here.line(step, complex(along[k]), point, "thin")
            here.line(step, complex(at(law.positions[k] + 1j * base[k])), point)
            here.dot(step, 0.4, "main", point)
        canvas.label(complex(along[k]), law.labels[k], -1j if sums[k] > 0 else 1j, 2.5, 0.6, leader=False)
    lowest = int(np.argmin(total))
    if span[0] < 0:
        level = complex(at(phi[lowest] + 1j * total[lowest]))
        found.line("r_min", complex(o.real - 6.0, level.imag), level)
        canvas.dimension(complex(o.real, o.imag), complex(o.real, level.imag), -7.0, "a")
    r_min = max(plate.r_min, 0.0)
    enough = plate.r0 >= 1.1 * r_min * (1 - 1e-9)
    radius = tr("r_0 = r_{{min}} + Δr = {radius} mm,  Δr = {margin} mm ≥ 0.1 r_{{min}}") if enough else tr(
        "r_0 = {radius} mm, given (margin less than 0.1 r_{{min}})")
    lines_of_text(canvas, box, [
        _measured("r_{min}", "a", r_min, "μ_S", scale.mu),
        radius.format(radius=number(plate.r0 * 1e3), margin=fixed((plate.r0 - r_min) * 1e3, 2)),
        tr("l_1 = S'_{{max}} = {length} mm (rise)").format(length=fixed(plate.l1 * 1e3, 2)),
        tr("l_2 = |S'|_{{max}} = {length} mm (return)").format(length=fixed(plate.l2 * 1e3, 2)),
        tr("ρ_{{min}} = r_0 + (S + S'')_{{min}} = {radius} mm").format(radius=fixed(cam.rho_min * 1e3, 2)),
    ])


def plate(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The flat follower with the sizes of its plate, to scale."""
    cam = cast("FlatCam", project.cam)
    p = cam.plate
    room = box.inset(12, 26, 12, 34)
    scale = standard((p.l1 + p.l2, room.width), (0.3 * (p.l1 + p.l2), room.height - 24))
    canvas.title(box, tr("Plate of the follower"), ratio(scale))
    left, right = (p.l1, p.l2) if cam.right > 0 else (p.l2, p.l1)
    axis = _plate_symbol(canvas.as_role("symbol"), room, scale.mm(left), scale.mm(right))
    a, b = axis - scale.mm(left), axis + scale.mm(right)
    names = ("l_1", "l_2") if cam.right > 0 else ("l_2", "l_1")
    canvas.dimension(a, axis, -11.0, f"{names[0]} = {fixed(left * 1e3, 1)}", factor=1e3 * scale.mu)
    canvas.dimension(axis, b, -11.0, f"{names[1]} = {fixed(right * 1e3, 1)}", factor=1e3 * scale.mu)
    centred(canvas, box, 4.0, tr("The point of contact must not leave the plate"))


def _plate_symbol(canvas: Canvas, room: Box, left: float, right: float) -> complex:
    """The flat follower with its guide, reaching as far to both sides, mm; returns the middle of its face."""
    thick, high = 5.0, min(0.75 * room.height, 62.0)
    axis = complex(room.centre.real - (right - left) / 2, room.centre.imag - high / 2)
    a, b = axis - left, axis + right
    canvas.polyline(np.array([a, b, b + 1j * thick, a + 1j * thick]), "main", closed=True)
    rod = 4.0
    for side in (-rod, rod):
        canvas.line(axis + complex(side, thick), axis + complex(side, high), "main")
        canvas.line(axis + complex(1.25 * side, 0.45 * high), axis + complex(1.25 * side, 0.85 * high), "main")
        canvas.hatch(axis + complex(1.25 * side, 0.45 * high), axis + complex(1.25 * side, 0.85 * high), 1 if side < 0 else -1)
    canvas.line(axis + complex(-rod, high), axis + complex(rod, high), "thin")
    canvas.line(axis - 6j, axis + 1j * (high + 5.0), "centre")
    return axis
