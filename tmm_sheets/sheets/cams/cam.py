"""Views of the cam sheet: diagrams of the motion, pressure angle, spring, table; what all its views share."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, degrees, inf, pi, radians
from operator import mul
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.construction.equation import Quantity, of_step
from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.drawing.canvas import Canvas, hatch_polygon
from tmm_sheets.drawing.lettering import fitted, letter, size_for
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.drawing.text_layout import needs, wrapped
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.border_solver import BorderNode, Need, leaf
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.player import OVER, PlayerStage, placed, play, together
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan, Step
    from tmm_sheets.methods.cams.cam_inversion import Spring
    from tmm_sheets.methods.cams.cam_motion import FollowerMotion
    from tmm_sheets.methods.cams.cam_profile import Cam, RollerCam
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

HEADS = 66.0
"""Height the diagrams leave to headings, axes and dimensions, mm."""
HEAD = 22.0
"""Where the head of a diagram begins beside its axis, mm: the letter of the quantity stands before it."""
TITLE, FOOT = 8.0, 22.0
"""Height of a title of one line over a view, and of what stands under the lowest diagram, mm."""
ANGLE = "α"
"""Letter of the pressure angle; an arrangement may name another one as the option ``angle``."""
WIDEST = 36.0
"""Greatest distance of the diagrams of the motion from one another, mm: farther apart they are no longer compared."""
BEHIND = 13.0
"""So far the axis of the cam angle goes beyond the phases, mm."""
BEYOND = 2.0
"""So far the centre lines of the auxiliary circle go beyond it, mm."""


def axes(s: PlayerStage, step: Step | str, x: float, y: tuple[float, float], before: float = 3.0) -> None:
    """Axes of a diagram of a step, reaching to ``x`` and from ``y[0]`` to ``y[1]``, mm from its origin."""
    o = s.frame(0j)
    pen = s.pen(step, "axis")
    pen.arrow(o + 1j * (y[0] - before), o + 1j * y[1], "axis", 3.0)
    pen.arrow(o, o + x, "axis", 3.0)


def distinct(labels: tuple[str, ...], x: Points | NDArray[np.float64]) -> list[int]:
    """Positions to be numbered: where two fall together (no dwell between), the first."""
    return [k for k in range(len(labels)) if k == 0 or abs(x[k] - x[k - 1]) > 1e-9]


def lines_of_text(canvas: Canvas, box: Box, lines: Sequence[str], *, beside: bool = False) -> None:
    """Lines of results at the foot of a view's place, or ``beside`` its figure at the right."""
    if beside:
        canvas.lines(complex(box.x1 - text_width(lines) - 4.0, box.y1 - 34.0), lines, 8.0)
    else:
        at = complex(box.x0 + 6.0, box.y0 + 3.0 + 7.0 * (len(lines) - 1))
        canvas.lines(at, lines, 7.0, size_for(lines, box.width - 8.0, 3.5))


def text_width(lines: Sequence[str]) -> float:
    """Width of lines of results, mm."""
    return max(letter(line, 3.5).width for line in lines)


def raised(box: Box, room: Box, height: float) -> tuple[Box, Box]:
    """The place of a view and the room of its figure, so high in mm, without what they leave free under both.

    Title, figure and the lines that follow from it stand together; what is left of a high place is in one piece for others.
    """
    spare = max(room.height - height - 2 * OVER, 0.0)
    return box.inset(0, spare, 0, 0), room.inset(0, spare, 0, 0)


def centred(canvas: Canvas, box: Box, above: float, text: str) -> None:
    """A remark in the middle of a view's place, ``above`` mm over its foot."""
    lines = wrapped(text, 3.5, ceil(letter(text, 3.5).width / box.width))
    canvas.lines(complex(box.centre.real, box.y0 + above + 5.5 * (len(lines) - 1)), lines, 5.5, 3.5, "centre")


def in_mm(symbol: str) -> str:
    """A symbol with its unit, as it heads a row."""
    return tr("{symbol}, mm").format(symbol=symbol)


def in_degrees(symbol: str) -> str:
    """A symbol of an angle with its unit, as it heads a row."""
    return tr("{symbol}, deg").format(symbol=symbol)


# --- diagrams of the motion -----------------------------------------------------------------------------------------


def motion_place(project: Project, view: ViewPlace) -> BorderNode:
    """The diagrams are as large as their scale factors make them: what they leave is for others."""
    m, box = project.cam.motion, view.box
    left, right = _reach_of_motion(m)
    heads = HEAD + max(letter(head, 3.5).width for head in _heads(m)) + 4.0
    width = left + max(right, heads)
    return leaf(box, Need(least=(width, sum(m.heights) + TITLE + HEADS), most=(width, box.height), drawn=mul))


def _reach_of_motion(m: FollowerMotion) -> tuple[float, float]:
    """How far the diagrams reach to the left and to the right of their origins, mm."""
    return max(max(m.scales.h1, m.scales.h2) + 6.0, m.circle_end + BEYOND), float(m.scales.phi.mm(m.law.fall.end)) + BEHIND


def motion(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """S'', S' and S one under another over a common axis of the cam angle, with both graphical integrations."""
    cam: Cam = project.cam
    law = cam.law
    laws = ", ".join(dict.fromkeys(tr(p.law.title) for p in (law.rise, law.fall)))
    title = tr("Law of motion of the rocker ({laws})") if law.symbol == "ψ" else tr("Law of motion of the follower ({laws})")
    # The turned designation of the sheet stands in the upper left corner.
    area = canvas.title(Box(max(box.x0, 92.0), box.y0, box.x1, box.y1), title.format(laws=laws))
    m = cam.motion
    canvas.scales[m.plan.name] = Scale("μ", 1.0, tr("mm/mm"))  # it is constructed in millimetres of paper
    curves = [m.curve(order) for order in (2, 1, 0)]
    ups = [max(float(c.imag.max()), 0.0) for c in curves]
    downs = [max(float(-c.imag.min()), 0.0) for c in curves]
    left, right = _reach_of_motion(m)
    x0 = box.x0 + left + max(box.width - left - right, 0.0) / 2
    # Numbers and dimensions of the phases stand under the lowest diagram; what is left of a high place is in one piece under them.
    gap = min((area.height - FOOT - sum(ups) - sum(downs)) / 3, WIDEST)
    origins, y = [], area.y1
    for up, down in zip(ups, downs, strict=True):
        y -= gap + up
        origins.append(complex(x0, y))
        y -= down
    stages = [placed(canvas, m.plan, o, 1.0) for o in origins]
    course = placed(canvas, m.between_plan, origins[0], 1.0)
    _phase_borders(canvas, m, origins)
    texts = (tr("{symbol}, m"),) * 3 if law.symbol == "S" else ("{symbol}", "{symbol}", tr("{symbol}, rad"))
    symbols = [text.format(symbol=name) for text, name in zip(texts, m.names, strict=True)]
    steps = (m.dds, m.ds, m.s)
    smooth = (m.between, m.plan[m.names[1]], m.plan[m.names[2]])
    every = zip(stages, ups, downs, curves, steps, symbols, _heads(m), smooth, strict=True)
    for s, up, down, points, ordinates, symbol, head, step in every:
        o = s.frame(0j)
        axes(s, ordinates[0], right, (-down, up + 10.0), 3.0 if down else 0.0)
        canvas.text(o + complex(2.5, up + 6.0), symbol, 3.5)
        canvas.label(o + right - 5.0, tr("{symbol}, rad").format(symbol="φ"), 1j, 3.5, 1.5, leader=False)
        # Over the first diagram there is no pole distance: its left side is free, too, and wider beside short phases.
        _head(canvas, o + 1j * (up + 6.0), head, box, both=step is m.between)
        _ordinates(s, m, ordinates)
        (course if step is m.between else s).curve(step, o + points)
    if m.circle:
        _auxiliary_circle(stages[0], m)
    _integration(stages[0], stages[1], m, m.names[1], m.ds, "P_1", "H_1", downs[0])
    _integration(stages[1], stages[2], m, m.names[2], m.s, "P_2", "H_2", downs[1])
    _phase_angles(canvas, m, origins[2] - 7j)


def _phase_borders(canvas: Canvas, m: FollowerMotion, origins: list[complex]) -> None:
    """Lines through all diagrams where rise and fall begin and end; they yield to the headings."""
    n = m.law.parts
    s = placed(canvas, m.numbers, origins[0], 1.0)
    for k in (0, n, n + 1, 2 * n + 1):
        step = m.numbers[f"x_{m.law.labels[k]}"]
        x = origins[0].real + float(step.value)
        s.pen(step, "construction").line(complex(x, origins[0].imag), complex(x, origins[-1].imag), "construction")


def _phase_angles(canvas: Canvas, m: FollowerMotion, base: complex) -> None:
    """Dimensions of the phases in a row that begins at ``base``; what is wider than its phase stands below the row."""
    for p in (m.law.rise, m.law.upper_dwell, m.law.fall):
        if p.angle > 0:
            a, b = (base + float(m.scales.phi.mm(v)) for v in (p.start, p.end))
            full = f"{p.letters} = {number(degrees(p.angle))}°"
            canvas.dimension(a, b, -8.0, full, factor=degrees(m.scales.phi.mu),
                             apart=None if (letter(full, 3.5).width <= abs(b - a) - 2.0) else ((a + b) / 2 - 8j, -1j))


def _heads(m: FollowerMotion) -> tuple[str, str, str]:
    """Over each diagram its scale factor, how it follows from the others, and what the amplitudes follow from."""
    law = m.law
    equal = f"{law.fall.letters}^2/{law.rise.letters}^2 = " if law.rise.law.peak == law.fall.law.peak else ""
    first, second = (tr("{symbol} = {before}·μ_φ·H_{number} = {factor} {unit},  H_{number} = {distance} mm").format(
        symbol=scale.symbol, before=before.symbol, number=k, factor=number(scale.mu), unit=scale.unit, distance=number(distance))
        for k, scale, before, distance in ((1, m.scales.ds, m.scales.dds, m.scales.h1), (2, m.scales.s, m.scales.ds, m.scales.h2)))
    angle = tr("{scale}  ({degrees} deg/mm)").format(scale=m.scales.phi, degrees=number(degrees(m.scales.phi.mu)))
    return (f"{m.scales.dds},  {angle},  "
            f"a_1/a_2 = {equal}{number(abs(m.plan['a_1'].value))}/{number(abs(m.plan['a_2'].value))}", first, second)


def _head(canvas: Canvas, at: complex, text: str, box: Box, *, both: bool) -> None:
    """Scale factors over a diagram, beside the letter at its axis: at the right, or where that is free at its wider side."""
    right, left = box.x1 - at.real - HEAD, at.real - box.x0 - 4.0
    beside = both and right < min(left, letter(text, 3.5).width)
    laid = fitted(text, left if beside else right, 3.5)
    canvas.put(laid, at + (-4.0 - laid.width if beside else HEAD), 0.0, text)


def _ordinates(s: PlayerStage, m: FollowerMotion, steps: list[Step]) -> None:
    """Ordinates of the numbered positions, their numbers on the other side of the axis."""
    points = np.array([complex(step.value) for step in steps])
    kept = distinct(m.law.labels, points.real)
    pitch = float(min(np.diff(points.real[kept]), default=10.0))
    height = 2.5 if pitch < 6.0 else 3.5
    for k in kept:
        at = s.frame(points[k].real)
        s.line(steps[k], at, s.at(steps[k]), "thin")
        shift = -letter(m.law.labels[k], height).width / 2 + (-1j * (1.3 + height) if points[k].imag > -1e-6 else 1.3j)
        s.canvas.number(complex(at), complex(at + shift), m.law.labels[k], height, pitch, first=k == 0)


def _auxiliary_circle(s: PlayerStage, m: FollowerMotion) -> None:
    """Auxiliary circles of the law with their division points carried to the ordinates."""
    canvas, centre = s.canvas, s.at("M")
    half = m.law.parts + 1
    radii = {}
    phases = [(name, first) for name, first in (("a_1", 0), ("a_2", half)) if first in m.circle]
    largest = max(abs(s.at(m.circle[first]) - centre) for _, first in phases)
    for name, first in phases:
        at = np.array([s.at(m.circle[first + k]) for k in range(half)])
        radius = float(abs(at[0] - centre))
        radii[name] = radius
        s.pen(name, "construction").circle(centre, radius, "thin")
        said = {same[0]: ", ".join(m.law.labels[first + j] for j in same) for same in together(at, 0.5)}
        for k, p in enumerate(at):
            play(s, [m.dds[first + k]])
            if k in said:
                s.line(m.circle[first + k], centre, p)
                s.dot(m.circle[first + k], 0.5, "main", p)
                outwards = (p - centre) / radius
                canvas.label(p, said[k], -outwards if radius >= largest - 1e-9 else outwards, 2.5, 0.5, leader=False)
    reach = largest + BEYOND
    pen = s.pen("M", "axis")
    pen.line(centre - reach, centre + reach, "centre")
    pen.line(centre - 1j * reach, centre + 1j * reach, "centre")
    angle = 1.38  # beside the upright radius: the letters have the rest of the way to the next one
    for name, radius in radii.items():
        s.pen(name, "dimension").arrow(centre, centre + rect(radius, pi - angle), "thin", 2.5)
        canvas.label(centre + rect(0.75 * radius, pi - angle), name, 1j * rect(1, pi - angle), 3.5, 0.6, leader=False)


def _integration(upper: PlayerStage, lower: PlayerStage, m: FollowerMotion, symbol: str, ends: list[Step],
                 pole: str, distance: str, down: float) -> None:
    """Rays from the pole of the upper diagram, rectangles of equal area, chords of the lower diagram."""
    plan, canvas, origin = m.plan, upper.canvas, upper.frame(0j)
    at = upper.at(f"{symbol}_P")
    lowest = 0.0
    for first, last in pairwise(dict.fromkeys(s.name for s in ends)):
        label = last.removeprefix(f"{symbol}_")
        middle, carried = plan[f"{symbol}_m{label}"], plan[f"{symbol}_{label}′"]
        height = 1j * complex(middle.value).imag
        start, end = [upper.frame(complex(plan[name].value).real + height) for name in (first, last)]
        upper.line(middle, start, end, "thin")
        upper.line(carried, upper.at(carried), start)
        play(upper, [f"{symbol}_P{label}′"])
        play(lower, [last])
        lowest = min(lowest, complex(carried.value).imag)
    upper.dot(f"{symbol}_P", 0.6, "main", at)
    canvas.label(at, pole, -1 + 1j, 3.5, 0.8, leader=False)
    play(upper, [f"{symbol}_P"], "axis")
    canvas.dimension(at, complex(origin), min(lowest, -down) - 7.0, distance)


# --- diagrams over the cam angle ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class OverAngle:
    """Place of a diagram over the cam angle: scale factors and origin, mm, and how far it reaches from there, mm.

    ``unit`` is that of the ordinates' scale factor in the unit of the plan.
    """

    across: Scale
    tall: Scale
    unit: float
    o: complex
    length: float
    low: float
    high: float

    @classmethod
    def fitted(cls, room: Box, end: float, span: tuple[float, float], scale: tuple[str, str], above: float = 0.0,
               unit: float = 1.0) -> OverAngle:
        """In the middle of a room, of which the ordinates leave ``above`` mm free; ``scale`` is sign and unit of theirs."""
        low, high = (value / unit for value in span)
        across = Scale("μ_φ", handy(degrees(end) / room.width), tr("deg/mm"))
        tall = Scale(scale[0], handy((high - low) / (room.height - above)), scale[1])
        length, low, high = float(across.mm(degrees(end))), tall.mm(low), tall.mm(high)
        return cls(across, tall, unit,
            complex(room.x0 + (room.width - length) / 2, room.y0 - low + (room.height - (high - low)) / 2), length, low, high)

    def placed(self, canvas: Canvas, plan: Plan) -> PlayerStage:
        """A plan as this diagram: abscissae in radians, ordinates in its unit."""
        return placed(canvas, plan, self.o, (radians(self.across.mu), self.unit * self.tall.mu))

    def axes(self, s: PlayerStage, step: Step, beyond: tuple[float, float], text: str, above: float) -> None:
        """Axes of the diagram of a step, so far beyond it, mm, with the sign of its ordinates."""
        axes(s, step, self.length + beyond[0], (self.low, self.high + beyond[1]))
        s.canvas.text(self.o + complex(2.5, self.high + above), text, 3.5)

    def from_axis(self, points: Points) -> Points:
        """A curve that jumps from the axis at its beginning and back to it at its end."""
        return np.concatenate(([self.o], points, [self.o + self.length]))


# --- pressure angle -------------------------------------------------------------------------------------------------


NAMED = 6.0
"""Distance of a curve from a level, mm, from which on the name of the level stands clear of it."""
NUMBERED, ORDINATES = 5.0, 4.0
"""Distance of ordinates of the pressure angle from which on all of them are numbered, and on which they can be read, mm."""
PRESSURE = 10.0, 8.0, 18.0, 30.0
"""Room about the graph of the pressure angle at the left, below, at the right and above, mm."""


def ordinates_apart(cam: Cam, width: float) -> float:
    """How far the nearest two ordinates of the pressure angle stand apart in a place so wide, mm."""
    steps = np.diff(cam.law.positions)
    across = handy(degrees(cam.law.fall.end) / max(width - PRESSURE[0] - PRESSURE[2], 1.0))
    return degrees(float(steps[steps > 1e-9].min())) / across


def pressure_place(project: Project, view: ViewPlace) -> BorderNode:
    """A graph over the whole turn: beyond its width more height is of no use, and its ordinates are to stand apart."""
    def drawn(width: float, height: float) -> float:
        return 0.6 * width * min(height, width) * min(ordinates_apart(project.cam, width) / ORDINATES, 1.0)

    return leaf(view.box, Need(least=(120.0, 80.0), drawn=drawn))


def pressure(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Pressure angle over rise and fall, measured at the finished profile, with the permitted value; after them it rests."""
    cam = cast("RollerCam", project.cam)
    dense, inv, letter_of = cam.dense, cam.inversion, options.get("angle", ANGLE)
    found = dense.angles.value
    low, high = min(float(found.min()), -cam.alpha), max(float(found.max()), cam.alpha)
    room = box.inset(*PRESSURE)
    # Higher than wide it shows no more: what is left is in one piece under it.
    box, room = (place.inset(0, max(room.height - room.width, 0.0), 0, 0) for place in (box, room))
    d = OverAngle.fitted(room, cam.law.fall.end, (low, high), (f"μ_{letter_of}", tr("deg/mm")), 8.0,
                        radians(1.0))
    canvas.title(box, tr("Pressure angle"), f"{d.tall},  {d.across}")
    course, marked = d.placed(canvas, dense.plan), d.placed(canvas, inv.plan)
    d.axes(course, dense.angles, (9.0, 9.0), in_degrees(letter_of), 5.5)
    canvas.label(d.o + d.length + 5, in_degrees("φ"), -1j, 3.5, 1.5, leader=False)
    curve = course.frame((dense.phi + 1j * found)[dense.phi <= cam.law.fall.end + 1e-9])
    for side in (1, -1):
        level = course.frame(1j * side * cam.alpha)
        course.line((*cam.zone.borders, cam.zone.apex)[0], level, level + d.length, "hidden", "axis")
        name = f"[{letter_of}] = {number(degrees(cam.alpha))}°" if side > 0 else f"−[{letter_of}]"
        canvas.label(level + clear_of(curve, level, side, letter(name, 3.5).width), name, 1j * side, 3.5, 0.8, leader=False)
    course.curve(dense.angles, curve)
    _exceeded(d, canvas, cam, letter_of)
    at, values = course.frame(inv.phi), inv.angles.value
    for k in range(len(at)):
        marked.position(k).line(inv.angles, at[k], course.frame(inv.phi[k] + 1j * values[k]), "thin")
    n, kept = cam.law.parts, distinct(inv.plan.labels, at.real)
    some = kept if ordinates_apart(cam, box.width) >= NUMBERED else (0, n // 2, n, n + 1, n + 1 + n // 2, 2 * n + 1)
    for k in some:
        if k != n + 1 or abs(at[n + 1] - at[n]) > 4:
            canvas.label(complex(at[k]), inv.plan.labels[k], -1j if values[k] > 0 else 1j, 2.5, 0.6, leader=False)
    if cam.data.limit == "rise":
        centred(canvas, box, 3.0, tr("With force closure the angle is limited on the rise only"))


def clear_of(curve: Points, level: complex, side: int, wide: float) -> float:
    """Where along a level its name, so wide, stands clear of a curve and its ordinates, the farther to the right the better, mm."""
    inside = side * (level.imag - curve.imag)
    along, reach = curve.real - level.real, wide / 2 + 1.0

    def clear(x: float) -> float:  # a function with its types: mypy takes seconds to find those of a lambda here
        return min(float(inside[np.abs(along - x) <= reach].min()), NAMED)

    return float(max(np.arange(along[-1] - reach, reach, -2.0), key=clear, default=along[-1] / 2))


def _exceeded(d: OverAngle, canvas: Canvas, cam: RollerCam, letter_of: str) -> None:
    """Where the pressure angle of a given radius exceeds the permitted one, hatched; its greatest values."""
    if cam.steepest is None:
        return
    phi, found = cam.dense.phi, np.asarray(cam.dense.angles.value)
    course = d.placed(canvas, cam.steepest)
    for phase in cam.zone.cones.phases:
        x = np.linspace(phase.start, phase.end, 257)
        angle = np.interp(x, phi, found)
        over = np.flatnonzero(np.abs(angle) > cam.alpha)
        for run in np.split(over, np.flatnonzero(np.diff(over) > 1) + 1) if len(over) else []:
            side = np.sign(angle[run[0]])
            hatch_polygon(canvas, np.concatenate((course.frame(x[run] + 1j * angle[run]),
                                                         course.frame(x[run][::-1] + 1j * side * cam.alpha))), 2.0)
    for k in (1, 2):
        at, angle = (float(cam.steepest[name].value) for name in (f"φ_α{k}", f"α_{k}"))
        point = complex(course.frame(complex(at, angle)))
        canvas.tracing("symbol").dot(point, 0.7)
        name = f"{letter_of}_{{max{k}}} = {fixed(degrees(angle), 1)}°"
        canvas.label(point, name, 1j * np.sign(angle) + 0.3, 3.5, 1.0)


# --- table ----------------------------------------------------------------------------------------------------------


def table_place(project: Project, view: ViewPlace) -> BorderNode:
    """As high as it is written and no narrower: it takes what the diagrams leave beside them."""
    w, h = view.box.width, view.box.height
    return leaf(view.box, Need(least=(w, h), most=(inf, h), drawn=mul))


def table(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """S, S', S'' and the pressure angle in the numbered positions; without upper dwell 8 and 8' are one."""
    cam: Cam = project.cam
    # By the side it is taken from: both limits where it jumps.
    before, after = cam.exact.before.dds.value, cam.exact.after.dds.value
    second = {"": before} if np.allclose(before, after, rtol=0, atol=1e-9 * float(np.abs((before, after)).max())) else \
        {" (φ−0)": before, " (φ+0)": after}
    turned, values = np.degrees(cam.inversion.phi), [*_diagram_rows(cam.motion, second),
                                                     *_check_values(cam, second, options.get("angle", ANGLE))]
    for places in (2, 1):
        rows = [[tr("Position"), *cam.motion.law.labels], [in_degrees("φ"), *(fixed(v, places) for v in turned)], *values]
        if sum(needs(rows, 2.5)) <= box.width:
            break
    kept = [0, *(k + 1 for k in distinct(cam.motion.law.labels, turned))]
    listed.table(canvas, box, [[cells[k] for k in kept] for cells in rows], 8.0)


def _diagram_rows(m: FollowerMotion, second: Mapping[str, Any]) -> Iterator[list[str]]:
    """Two rows for each diagram: ordinates on paper, and what they mean."""
    straight = m.law.symbol == "S"
    for symbol, steps, scale in zip(reversed(m.names), (m.s, m.ds, m.dds), (m.scales.s, m.scales.ds, m.scales.dds), strict=True):
        rows = second if steps is m.dds and len(second) > 1 else {"": m.measured(steps, scale)}
        for side, values in rows.items():
            yield [in_mm(f"y_{{{symbol}}}{side}"), *(fixed(v, 1) for v in scale.mm(values))]
            text = tr("{symbol}·10^3, m") if straight else tr("{symbol}, rad") if symbol == "ψ" else "{symbol}"
            yield [text.format(symbol=symbol + side), *(fixed(v * 1e3, 2) if straight else fixed(v, 3) for v in values)]


def _check_values(cam: Cam, second: Mapping[str, Any], letter_of: str) -> Iterator[list[str]]:
    """What the dimensions of the cam rest upon: the pressure angle, under a flat follower S + S''."""
    if "roller" in cam.traits:
        yield [in_degrees(letter_of), *(fixed(v, 1) for v in np.degrees(cam.inversion.angles.value))]
        return
    before, after = cam.plate.sides  # type: ignore[attr-defined]
    for side, sums in zip(second, (before, after), strict=False):
        yield [tr("{symbol}·10^3, m").format(symbol=f"(S + S''){side}"), *(fixed(v * 1e3, 2) for v in sums.value)]


# --- spring ---------------------------------------------------------------------------------------------------------


GRAPH = 45.0
"""Height of a graph that can be read, mm."""


def spring_place(project: Project, view: ViewPlace) -> BorderNode:
    """A graph with its lines beside it or under it, where they leave it the height to be read."""
    def drawn(width: float, height: float) -> float:
        return 0.6 * width * height * min(max(spring_height(width, height) / GRAPH, 0.05), 1.0)

    return leaf(view.box, Need(least=(0.8 * view.box.width, 80.0), drawn=drawn))


def spring(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Force of the closing spring against the force of inertia over the cam angle, with the least ratio of both."""
    cam: Cam = project.cam
    spring, law = cam.spring, cam.law
    assert spring is not None
    steps = spring.course
    phi, force, inertia = (step.value for step in steps)
    d = spring_diagram(cam, box)
    canvas.title(box, tr("Closing spring"), f"{d.tall},  {d.across}")
    course, found = d.placed(canvas, spring.course_plan), d.placed(canvas, spring.plan)
    d.axes(course, steps[1], (10.0, 8.0), tr("F, Q, N"), 4.5)
    canvas.label(d.o + d.length + 7, in_degrees("φ"), 1j, 3.5, 1.5, leader=False)
    course.curve(steps[1], course.frame(phi + 1j * force))
    course.curve(steps[2], d.from_axis(course.frame(phi + 1j * inertia)), "main")
    x, forces = course.frame(law.positions), spring.at_positions
    for k in distinct(law.labels, x.real):
        pen = canvas.tracing("construction", forces.path, law.labels[k], found.number)
        pen.line(complex(x[k]), complex(course.frame(law.positions[k] + 1j * forces.value[k])), "thin")
        canvas.label(complex(x[k]), law.labels[k], -1j, 2.5, 0.6, leader=False)
    for name, values, peak, away in (("F", force, np.argmax(force), 1j), ("Q", inertia, np.argmin(inertia), 1 + 0j)):
        canvas.label(complex(course.frame(phi[peak] + 1j * values[peak])), name, away, 3.5, 1.0)
    worst = float(spring.force(law.s(spring.worst_phi)))
    for step, y in zip(steps[1:], (worst, worst / spring.worst), strict=True):
        course.dot(step, 0.8, "main", complex(course.frame(spring.worst_phi + 1j * y)))
    lines_of_text(canvas, box, spring_lines(spring, law.symbol == "S"), beside=_lines_beside(box.width, box.height))


def spring_diagram(cam: Cam, box: Box) -> OverAngle:
    """Where the forces of the spring and of inertia stand over the cam angle."""
    assert cam.spring is not None
    _, force, inertia = (step.value for step in cam.spring.course)
    lines = spring_lines(cam.spring, cam.law.symbol == "S")
    area = box.inset(14, 8, text_width(lines) + 28, 32) if _lines_beside(box.width, box.height) else \
        box.inset(14, 14 + 7.0 * len(lines), 20, 32)
    span = float(min(inertia.min(), 0.0)), float(max(force.max(), inertia.max()))
    return OverAngle.fitted(area, cam.law.fall.end, span, ("μ_F", tr("N/mm")))


def _lines_beside(width: float, height: float) -> bool:
    """Whether the lines about the spring stand beside its graph in such a place, not under it."""
    return width > 1.7 * height


def spring_height(width: float, height: float) -> float:
    """Height of the graph of the spring in a place of this size, mm."""
    return height - (40.0 if _lines_beside(width, height) else 46.0 + 7.0 * SPRING_LINES)


SPRING_LINES = 8
"""Number of the lines below: a sheet that is arranged asks for it hundreds of times."""


def spring_lines(spring: Spring, straight: bool) -> list[str]:
    """The spring in formulas and numbers; of a rocker the forces are those at the centre of the roller."""
    plan = spring.plan
    way = {id(plan["s"]): Quantity("S_{max}" if straight else "AB·ψ_{max}", spring.way)}
    held = tr("(F/Q)_{{min}} > 1: it stays on the cam") if spring.closed else tr(
        "(F/Q)_{{min}} ≤ 1: it leaves the cam! F_{{max}} ≥ {factor}·Q_{{max}} is needed")
    return [
        "Q = −m·ω^2·S''" if straight else tr("Q = −J/AB^2·ω^2·AB·ψ'' (at point B)"),
        f"{of_step(plan['m']) or f'm = {number(spring.mass)} ' + tr('kg')},  ω = {number(spring.speed)} {tr('rad/s')}",
        tr("Q_{{max}} = {force} N (lifts off where {symbol}'' < 0)").format(
            force=number(spring.largest_inertia), symbol="S" if straight else "ψ"),
        *(of_step(plan[name], own=way) for name in ("F_max", "F_0", "c")),
        tr("(F/Q)_{{min}} = {ratio} at φ = {angle}°").format(
            ratio=fixed(spring.worst, 3), angle=fixed(degrees(spring.worst_phi), 1)),
        held.format(factor=fixed(spring.needed_factor, 2)),
    ]
