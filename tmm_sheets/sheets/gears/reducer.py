"""Views of the reducer: scheme in two views with the picture of velocities, plan of speeds, tables of the choice."""

from __future__ import annotations

from cmath import rect
from collections.abc import Mapping, Sequence
from math import ceil, pi, sin
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import fitted, letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.tables import widened
from tmm_sheets.drawing.text_boxes import spread
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.components.listed import LARGE, Table, letters_in
from tmm_sheets.sheets.frame import ratio, standard
from tmm_sheets.sheets.gears.gear_marks import ruled_table
from tmm_sheets.sheets.gears.reducer_equations import unsigned
from tmm_sheets.sheets.player import PlayerStage, placed, play
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.reducer import Reducer
    from tmm_sheets.methods.gears.reducer_stages import ReducerWheel, Stage
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.project import Project

COLUMN = 19.0
"""Distance of two columns of wheels of the axial view, mm."""
FACE = 7.0
"""Width of a wheel's rim in the axial view, mm."""
STUB = 15.0
"""Length of the shafts that lead in and out, mm."""
HUB = 2.0
"""Distance of a free wheel's hub from the line of its shaft, mm."""
NAME = 30.0
"""Room for a link's speed of rotation on its plan, mm."""
OVER = 34.0
"""Room over and under the views with their title, mm."""
AXIS, CLEAR, APART = 6.0, 1.2, 8.0
"""How far the line of zero velocity runs beyond the picture, distances of the scale factor over it and from the other one, mm."""
STRETCHED = 1.8
"""So many times wider the axial view may be drawn where there is room: only its heights are to scale."""
BETWEEN = 12.0, 34.0
"""Distance of the views of a scheme from the picture of velocities between them: least and greatest, mm."""
UNDER = 14.0
"""The wheels stand no farther under their title, mm: what is left of a high place is in one piece under them."""
OFFERED = 90.0
"""Width from which room beside them is of use to other views, mm."""
NARROWEST, WIDEST = 75.0, 100.0
"""Least width left for the picture of velocities and what its velocities may always take, mm."""


def scheme(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Axial view, picture of velocities and front view side by side on one main axis, to one scale."""
    canvas.of = "reducer-velocities"
    views = SchemeOfReducer(project.reducer)
    views.place(canvas, box, "reducer-scheme", tr("Scheme of the reducer, picture of velocities and end view"))
    views.draw()


class Edge(NamedTuple):
    """A wheel as it is drawn edge on: its number, its pitch diameter, m."""

    number: str
    diameter: float


class SchemeViews:
    """Views on one main axis and the picture of velocities; heights in metres over the axis become millimetres of the sheet.

    They reach to ``top``, ``bottom`` and ``side`` (m), the axial view is ``width`` wide (mm); ``above`` is what else stands over
    the picture, mm. Of the axial view ``column``, ``stub`` and ``face`` are the distance of wheels, the length of the shafts that
    lead in and out and the width of a rim, mm; it is stretched along the axis where there is room. Satellites stand at both sides
    of the axis, turned into its plane (GOST 2.703), so that each edge of a ring meshes with one.
    """

    reducer: Reducer | Train
    canvas: Canvas
    mu: Scale
    box: Box
    axis: float
    picture: Box
    front: complex
    top: float
    bottom: float
    side: float
    width: float
    above = 0.0
    column, stub, face = COLUMN, STUB, FACE

    def fitted(self, width: float, height: float) -> Scale:
        """The scale with which they fit a place with their title."""
        return standard((self.top + self.bottom, height - OVER - self.above), (2 * self.side, width - self.beside(NARROWEST)))

    def beside(self, picture: float) -> float:
        """Width of what comes to the end view with a picture of velocities of this width, mm."""
        return self.width + picture + 24.0

    def place(self, canvas: Canvas, box: Box, key: str, title: str) -> None:
        """Find the scale and the places of the axial view, the picture of velocities beside it and the end view at the right."""
        self.canvas = canvas
        self.mu = canvas.scales[key] = self.fitted(box.width, box.height)
        self.box = self.canvas.title(box, title, ratio(self.mu))
        spare = self.box.height - (self.top + self.bottom) / self.mu.mu
        self.axis = self.box.y0 + max(spare / 2, spare - UNDER) + self.bottom / self.mu.mu
        self.front = complex(self.box.x1 - 6 - self.side / self.mu.mu, self.axis)
        room = self.front.real - self.side / self.mu.mu - self.box.x0
        self.stretch((room - self.pictured() - 2 * BETWEEN[0]) / self.width)
        between = max((room - self.width - self.pictured()) / 2, BETWEEN[0])
        if (spare := 2 * (between - BETWEEN[1])) > OFFERED:  # what is left at the right is of use to others
            self.front -= spare
            between = BETWEEN[1]
        left = self.box.x0 + self.width + between
        self.picture = Box(left, self.box.y0, self.front.real - self.side / self.mu.mu - between, self.box.y1 - self.above)

    def stretch(self, share: float) -> None:
        """Draw the axial view so many times wider, as far as that looks well."""
        share = min(max(share, 1.0), STRETCHED)
        self.width, self.column, self.stub, self.face = (share * length for length in (self.width, COLUMN, STUB, FACE))

    def pictured(self) -> float:
        """Width of use to the picture of velocities, mm: lines less steep than 45 degrees are hard to draw others parallel to."""
        heights = [complex(step.value).imag for step in self.reducer.velocities if step.rule.gives == "point"]
        return max(WIDEST, float(self.mu.mm(max(heights) - min(heights)))) + 24.0

    def y(self, height: float) -> float:
        """Ordinate on the sheet of a height over the main axis."""
        return float(self.axis + height / self.mu.mu)

    def arrow(self, at: complex, text: str, side: int) -> None:
        """Name of a shaft's speed at its free end."""
        self.canvas.label(at, text, away=complex(side, 1), height=5, gap=1.5)

    def wheel(self, wheel: Edge | ReducerWheel, x: float, height: float, label: int = 1, free: bool = False) -> None:
        """A wheel edge on: its disc with the rim at both ends; a ``free`` one turns on its shaft with a hub of its own."""
        c, r = self.canvas, wheel.diameter / 2
        low, high = complex(x, self.y(height - r)), complex(x, self.y(height + r))
        if free:
            hub = [complex(x, self.y(height) + side * HUB) for side in (-1, 1)]
            c.line(low, hub[0], "main")
            c.line(hub[1], high, "main")
            for end in hub:
                c.line(end - self.face / 2, end + self.face / 2, "main")
        else:
            c.line(low, high, "main")
        for end in (low, high):
            c.line(end - self.face / 2, end + self.face / 2, "main")
        at = high if label > 0 else low
        c.label(at + self.face / 2, wheel.number, away=complex(1, label), height=5, gap=1.2)

    def satellite(self, wheel: ReducerWheel, x: float, height: float, label: int = 1) -> None:
        """A wheel on a carrier, and the one at the other side of the main axis."""
        self.wheel(wheel, x, height, label, free=True)
        if self.opposite(wheel.number):
            self.wheel(Edge("", wheel.diameter), x, -height, -label, free=True)

    def opposite(self, satellite: str) -> bool:
        """Whether a carrier has more satellites than one, so that another stands at the other side of the main axis."""
        return True

    def sides(self, satellite: str) -> tuple[int, ...]:
        """Sides of the main axis at which a satellite is drawn: over it, under it."""
        return (1, -1) if self.opposite(satellite) else (1,)

    def held(self, x: float, radius: float, name: str) -> None:
        """The edges of a ring that stands still, each held in the frame."""
        c = self.canvas
        for side in (1, -1):
            rim = complex(x, self.y(side * radius))
            out = rim + 6j * side
            c.line(rim - self.face / 2, rim + self.face / 2, "main")
            c.line(rim, out, "main")
            c.line(out - 5, out + 5, "main")
            c.hatch(out - 5, out + 5, side)
        c.label(complex(x - self.face / 2, self.y(radius)), name, away=-1 + 0.3j, height=5, gap=1.2)

    def bearing(self, x: float, y: float) -> None:
        """A shaft's bearing in the frame: a hatched stroke on each side of it."""
        for side in (-1, 1):
            a, b = complex(x - 3, y + side * HUB), complex(x + 3, y + side * HUB)
            self.canvas.line(a, b, "main")
            self.canvas.hatch(a, b, side, depth=2.0, step=2.0)

    # --- picture of velocities ----------------------------------------------------------------------------------

    def velocities(self) -> None:
        """Lines of the links over the heights of their points."""
        c, plan = self.canvas, self.reducer.velocities
        ends = {step.name: complex(step.value) for step in plan if step.rule.gives == "point"}
        low, high = (f([v.real for v in ends.values()]) for f in (min, max))
        mu = Scale("μ_V", handy((high - low) / (min(self.picture.width, self.pictured()) - 24.0)), tr("(m/s)/mm"))
        c.scales[plan.name] = mu
        whole = mu.mm(high - low)
        zero = self.picture.x0 + (self.picture.width - whole) / 2 - mu.mm(low)
        # As large as the title, if the picture's part of the place is wide enough.
        laid = fitted(str(mu), self.picture.width, 5.0)
        bottom, top = (f([v.imag for v in ends.values()]) for f in (min, max))
        # Over the picture, and clear of the scale factor under the title of the views.
        level = max(min(self.picture.y1 - 8.0, self.y(top) + 12.0), self.y(top) + AXIS + CLEAR + laid.descent)
        x = (self.picture.x0 + self.picture.x1 - laid.width) / 2
        if level + laid.ascent > self.box.y1:  # on the level of that one: beside it
            half = letter(ratio(self.mu), 5.0).width / 2 + APART
            x = min(x, self.box.centre.real - half - laid.width) if x + laid.width / 2 < self.box.centre.real else \
                max(x, self.box.centre.real + half)
        c.put(laid, complex(x, level), 0.0, str(mu))

        s = placed(c, plan, complex(zero, self.axis), (mu.mu, self.mu.mu))
        s.line("O", complex(zero, self.y(bottom) - AXIS), complex(zero, self.y(top) + AXIS), "axis", "axis")
        self.heights(s, [name for name in ends if name[0].isupper()])
        self.vectors(s, {name: value for name, value in ends.items() if name[0].islower()})
        self.lines(s)

    def vectors(self, s: PlayerStage, ends: Mapping[str, complex]) -> None:
        """Velocities of the points, from the line of zero velocity to their ends."""
        for name, value in ends.items():
            s.vector(name.upper(), name)
            way = 1 if value.real > 0 else -1
            letters = name if len(name) == 1 else f"{name[0]}_{name[1:]}"
            self.canvas.label(s.at(name), letters, away=complex(way, 0.4), height=3.5, gap=1.2)

    def lines(self, s: PlayerStage) -> None:
        """Line of each link through the ends of the velocities of all its points."""
        plan = self.reducer.velocities
        points = [step for step in plan if step.rule.gives == "point"]
        for step in (step for step in plan if step.rule.gives == "direction"):
            on = sorted((complex(p.value) for p in (*step.args, *(p for p in points if step in p.args))), key=lambda z: z.imag)
            a, b = complex(s.frame(on[0])), complex(s.frame(on[-1]))
            s.pen(step, "axis").ray_line(a, b, "axis", over=5.0, before=0.0 if abs(on[0].real) < 1e-12 else 5.0)
            away = 1j * (b - a) * (-1 if (b - a).real > 0 else 1)
            self.canvas.label(a + 0.62 * (b - a), link_name(step.name), away=away, height=5, gap=1.2)

    def heights(self, s: PlayerStage, points: Sequence[str]) -> None:
        """Points of the scheme carried over to the line of zero velocity; those of one height have one line."""
        names: dict[float, list[str]] = {}
        for name in points:
            names.setdefault(round(s.at(name).imag, 1), []).append(name)
        for group in names.values():
            end = s.at(group[0])
            s.line(group[0], complex(self.box.x0 + self.stub, end.imag), end, "construction", "axis")
            s.dot(group[0], 0.7, "main")
            letters = (name if len(name) == 1 else f"{name[0]}_{name[1:]}" for name in group)
            self.canvas.label(end, ", ".join(letters), away=-1 + 0.6j, height=3.5, gap=1.2)


class SchemeOfReducer(SchemeViews):
    """The three views of a reducer."""

    def __init__(self, reducer: Reducer) -> None:
        self.reducer = reducer
        self.stages, self.pair = reducer.stages, reducer.simple
        self.before = reducer.data.simple == "before"
        stage = self.stages[0]
        self.reach = stage.axis + max(stage.wheels[1].diameter, stage.wheels[2].diameter) / 2
        one, two = (w.diameter / 2 for w in self.pair) if self.pair else (0.0, 0.0)
        self.offset = (one + two) * (1 if self.before else -1)
        self.top = max(self.reach, two + 2 * one if self.before else one)
        self.bottom = max(self.reach, two if self.before else one + 2 * two)
        # Satellites stand all round, the first of them over the axis.
        count = reducer.data.satellites
        beside = stage.axis * max(abs(sin(2 * pi * k / count)) for k in range(count))
        self.side = max(one, two, *(w.diameter / 2 for w in (stage.wheels[0], stage.wheels[3])),
                        *(beside + w.diameter / 2 for w in stage.wheels[1:3]))
        self.width = self.columns() * COLUMN + 2 * STUB

    def columns(self) -> int:
        """Columns of the axial view between the shafts that lead in and out."""
        each = 2 if self.stages[0].single else 3
        return len(self.stages) * each

    def draw(self) -> None:
        """Draw the three views."""
        with self.canvas.as_role("symbol"):
            self.axial()
            self.end_view()
        self.velocities()

    # --- axial view ---------------------------------------------------------------------------------------------

    def axial(self) -> None:
        """Wheels, shafts and carriers edge on."""
        c = self.canvas
        x = self.box.x0 + 3.0
        end = self.box.x0 + self.width
        c.line(complex(x - 2, self.axis), complex(end + 2, self.axis), "centre")
        other = self.y(self.offset)
        if self.before:
            one, two = self.pair
            at = x + self.stub
            c.line(complex(x, other), complex(at + self.face, other), "main")
            self.wheel(one, at, self.offset)
            self.wheel(two, at, 0.0, label=-1)
            self.bearing(x + 6, other)
            self.arrow(complex(x, other), tr("n_{in}"), -1)
            c.line(complex(at - 11, self.axis), complex(at, self.axis), "main")
            self.bearing(at - 8, self.axis)
            x = at
        else:
            c.line(complex(x, self.axis), complex(x + self.stub, self.axis), "main")
            self.bearing(x + 6, self.axis)
            self.arrow(complex(x, self.axis), tr("n_{in}"), -1)
            x += self.stub
        for k, stage in enumerate(self.stages):
            x = self.stage(stage, x, first=k == 0)
        if self.before or not self.pair:
            c.line(complex(x, self.axis), complex(x + self.stub, self.axis), "main")
            self.bearing(x + self.stub - 6, self.axis)
            self.arrow(complex(x + self.stub, self.axis), tr("n_{out}"), 1)
            return
        one, two = self.pair
        at = x + self.column * 0.6
        c.line(complex(x, self.axis), complex(at + self.stub, self.axis), "main")
        self.bearing(at + self.stub - 5, self.axis)
        self.wheel(one, at, 0.0)
        self.wheel(two, at, self.offset, label=-1)
        c.line(complex(at - self.face, other), complex(at + self.stub, other), "main")
        self.bearing(at + self.stub - 5, other)
        self.arrow(complex(at + self.stub, other), tr("n_{out}"), 1)

    def ring(self, wheel: ReducerWheel, x: float) -> None:
        """A ring that stands still: both its edges are held in the frame."""
        self.held(x, wheel.diameter / 2, wheel.number)

    def bell(self, wheel: ReducerWheel, x: float, web: float) -> None:
        """A ring that turns: its rims joined by a disc at ``web``."""
        c, r = self.canvas, wheel.diameter / 2
        for side in (1, -1):
            rim = complex(x, self.y(side * r))
            c.line(rim + self.face / 2 * np.sign(x - web), complex(web, rim.imag), "main")
        c.line(complex(web, self.y(-r)), complex(web, self.y(r)), "main")
        c.label(complex(x, self.y(r)), wheel.number, away=1j, height=5, gap=1.2)

    def ground(self, x: float, towards: int) -> None:
        """The hub of a sun that stands still, held in the frame beside it."""
        c = self.canvas
        at = complex(x + 6 * towards, self.axis)
        c.line(complex(x, self.axis), at, "main")
        a, b = at - 5j, at + 5j
        c.line(a, b, "main")
        c.hatch(a, b, -towards)

    def stage(self, stage: Stage, x: float, first: bool) -> float:
        """One planetary stage beginning at ``x``, where the driving shaft ends; gives the end of its output shaft."""
        c = self.canvas
        one, two, three, four = stage.wheels
        if stage.driver == "carrier":
            self.arm(stage, x)
            inner, outer = x + self.column, x + 2 * self.column  # the fixed pair 3-4 stands next to the carrier
            self.axis_of_satellites(stage, x, outer + self.face)
            self.block(three, inner, two, outer, stage.axis)
            if stage.signs[1] > 0:
                self.wheel(four, inner, 0.0, label=-1)
                self.ground(inner, -1)
            else:
                self.ring(four, inner)
            if stage.signs[0] > 0:
                self.wheel(one, outer, 0.0, label=-1)
                out = outer
            else:
                out = outer + self.face + 3
                self.bell(one, outer, out)
            c.line(complex(out, self.axis), complex(outer + self.column, self.axis), "main")
            return outer + self.column
        at = x if first and not self.before else x + self.column
        if at > x:
            c.line(complex(x, self.axis), complex(at, self.axis), "main")
        if stage.single:
            self.satellite(two, at, stage.axis)
            last = at
        else:
            last = at + self.column
            self.block(two, at, three, last, stage.axis)
        if stage.driver == "sun":
            self.wheel(one, at, 0.0, label=-1)
            self.ring(four, last)
        else:
            self.wheel(one, at, 0.0, label=-1)
            self.ground(at, 1)
            self.bell(four, at, at - self.face - 1)
        out = last + self.column * (1.0 if stage.driver == "ring" else 0.75)
        self.axis_of_satellites(stage, at - self.face, out)
        self.arm(stage, out)
        return out

    def axis_of_satellites(self, stage: Stage, x0: float, x1: float) -> None:
        """The axle of the satellites, at both sides of the main axis."""
        for side in (1, -1):
            self.canvas.line(complex(x0, self.y(side * stage.axis)), complex(x1, self.y(side * stage.axis)), "main")

    def block(self, first: ReducerWheel, x: float, second: ReducerWheel, end: float, height: float) -> None:
        """Two satellites joined by a sleeve."""
        self.satellite(first, x, height)
        self.satellite(second, end, height)
        for edge in (height, -height):
            for side in (-1, 1):
                y = self.y(edge) + side * HUB
                self.canvas.line(complex(x, y), complex(end, y), "main")

    def arm(self, stage: Stage, x: float) -> None:
        """The carrier's arms from the main axis to those of the satellites."""
        self.canvas.line(complex(x, self.y(-stage.axis)), complex(x, self.y(stage.axis)), "main")
        name = f"H_{stage.carrier[1:]}" if len(stage.carrier) > 1 else "H"
        self.canvas.label(complex(x, self.y(stage.axis / 2)), name, away=1, height=5, gap=1.2)

    # --- view along the axis ------------------------------------------------------------------------------------

    def end_view(self) -> None:
        """Pitch circles of one stage and of the simple one, the carrier with its satellites."""
        c, o = self.canvas, self.front
        stage = self.stages[0]
        one, two, three, four = stage.wheels
        mm = self.mu.mm
        reach = mm(self.side) + 4
        c.line(o - reach, o + reach, "centre")
        c.line(complex(o.real, self.y(-self.bottom) - 4), complex(o.real, self.y(self.top) + 4), "centre")
        if self.pair:
            other = complex(o.real, self.y(self.offset))
            arm = mm(max(w.diameter for w in self.pair)) / 2 * 0.35
            c.line(other - arm, other + arm, "centre")
        for wheel in (one, four):
            c.circle(o, mm(wheel.diameter / 2), "main" if wheel is stage.fixed else "axis")
        satellites = (two,) if stage.single else (two, three)
        count = self.reducer.data.satellites
        spokes = [rect(mm(stage.axis), pi / 2 + 2 * pi * k / count) for k in range(count)]
        for spoke in spokes:
            c.line(o, o + spoke, "main")
            for wheel in satellites:
                c.circle(o + spoke, mm(wheel.diameter / 2), "axis")
            c.dot(o + spoke, 1.0)
        c.dot(o, 1.2)
        simple = self.simple_end_view() if self.pair else []
        side = spokes[-1] / abs(spokes[-1])
        gap = pi / 2 - pi / count  # between two satellites
        named = [(o, one, rect(1, gap + 0.05)), (o, four, rect(1, gap - 0.12)), *simple]
        named += [(o + spokes[-1], wheel, side * rect(1, 0.6 + 0.9 * k)) for k, wheel in enumerate(satellites)]
        for centre, wheel, way in named:
            c.label(centre + mm(wheel.diameter / 2) * way, self.numbers(wheel), away=way, height=3.5, gap=1.0)

    def simple_end_view(self) -> list[tuple[complex, Any, complex]]:
        """Pitch circles of the simple stage; centres, wheels and directions of their numbers."""
        c, o, mm = self.canvas, self.front, self.mu.mm
        other = complex(o.real, self.y(self.offset))
        c.dot(other, 1.2)
        near, far = reversed(self.pair) if self.before else self.pair
        c.circle(o, mm(near.diameter / 2), "thin")
        c.circle(other, mm(far.diameter / 2), "axis")
        return [(o, near, rect(1, -0.45)), (other, far, rect(1, 0.5 if self.before else -0.5))]

    def numbers(self, wheel: ReducerWheel) -> str:
        """Numbers of a wheel of the first stage and of those in its place in the next ones, which are like it."""
        first = self.stages[0].wheels
        if wheel not in first:
            return str(wheel.number)
        return ", ".join(s.wheels[first.index(wheel)].number for s in self.stages)

def link_name(name: str) -> str:
    """A link's name as it is written: carriers with an index, blocks of satellites with a dash."""
    return f"H_{name[1:]}" if name.startswith("H") and len(name) > 1 else name.replace("-", "–")


def speeds(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Plan of the speeds of rotation: rays through the pole parallel to the lines of the picture of velocities."""
    plan_of_speeds(project.reducer, canvas, box, "reducer")


def plan_of_speeds(reducer: Reducer | Train, canvas: Canvas, box: Box, part: str) -> None:
    """The same of the reducer or the train whose scheme is drawn."""
    canvas.of = f"{part}-speeds"
    picture: Scale = canvas.scales[f"{part}-velocities"]
    heights: Scale = canvas.scales[f"{part}-scheme"]
    values = [float(n.value) for n in reducer.links.values()]
    low, high = min(0.0, *values), max(0.0, *values)
    room, tall = box.width - 30, box.height - 44
    # A speed n takes n/mu_n mm, and with the picture's scale factors H = 30 mu_V/(pi mu_l mu_n).
    least = max((high - low) / room, 30 / pi * picture.mu / (heights.mu * tall))
    mu = Scale("μ_n", handy(least), tr("rpm/mm"))
    distance = 30 / pi * picture.mu / (heights.mu * mu.mu)
    inner = canvas.title(box, tr("Plan of the speeds of rotation"), tr("{scale};  H = {distance} mm").format(
        scale=mu, distance=fixed(distance, 1)))
    canvas.scales[f"{part}-speeds"] = picture
    plan = reducer.speeds(distance * heights.mu)
    spare = room - mu.mm(high - low)
    # In the middle, or at the left where what is left at the right is then of use to others.
    zero = inner.x0 + 15.0 + (spare / 2 if spare < OFFERED else 10.0) - mu.mm(low)
    y = inner.y1 - max(14.0, (inner.height - distance) * 0.5)
    s = placed(canvas, plan, complex(zero, y), (picture.mu, heights.mu))
    origin, pole = s.at("0"), s.at("P")
    pen = s.pen("0", "axis")
    pen.line(complex(zero + mu.mm(low) - 10, y), complex(zero + mu.mm(high) + 10, y), "axis")
    pen.arrow_head(complex(zero + mu.mm(high) + 12, y), 1)
    pen.line(origin, pole, "thin")
    canvas.label(complex(zero + mu.mm(high) + 12, y), tr("n, rpm"), away=-1j, height=3.5, gap=1.5)
    for name, size, away, height in (("P", 0.9, -1j, 5.0), ("0", 0.8, -1 + 1j, 3.5)):
        s.dot(name, size, "main")
        canvas.label(s.at(name), name, away=away, height=height)
    ends = [(s.at(step), step.name) for step in ends_of_rays(plan)]
    ends.sort(key=lambda pair: pair[0].real)
    places = spread([end.real for end, _ in ends], NAME)
    for i in range(len(places)):
        places[i] = max(places[i], box.x0 + NAME * (i + 0.5))
    for i in range(len(places)):
        places[-1 - i] = min(places[-1 - i], box.x1 - NAME * (i + 0.5))
    for (end, link), x in zip(ends, places, strict=True):
        play(s, [link], "main")
        s.dot(link, 0.8, "main")
        s.line(link, end, complex(x, y + 7), "thin", "text")
        canvas.text(complex(x, y + 9), f"n_{{{link_name(link)}}} = {number(float(plan[f'n{link}'].value))}", 3.5, "centre")


def ends_of_rays(plan: Plan) -> list[Step]:
    """Points of the plan of speeds that rays from its pole lead to, one for each link."""
    return [step for step in plan if step.name not in ("P", "0") and step.rule.gives == "point"]


def rows_of_points(of: Reducer | Train, canvas: Canvas) -> list[list[str]]:
    """Heading and a row for each point whose velocity the picture has."""
    mu = canvas.scales[of.velocities.name]
    rows = [[tr("Point"), tr("Distance from the axis, mm"), tr("Segment of the picture, mm"), tr("V, m/s")]]
    for end in moving_points(of):
        name, at = end.name.upper(), complex(end.value)
        measured = f"|{name}{end.name}| = {fixed(abs(mu.mm(at.real)), 1)}"
        rows.append([name, number(1e3 * abs(at.imag)), measured, number(at.real)])
    return rows


def moving_points(of: Reducer | Train) -> list[Step]:
    """Ends of the velocities that the picture has."""
    plan = of.velocities
    return [end for end in plan if end.name.islower() and end.rule.gives == "point" and end.name.upper() in plan]


def rows_of_links(of: Reducer | Train, canvas: Canvas, part: str) -> list[list[str]]:
    """Heading and a row for each link on the plan that the sheet has."""
    plan = of.plans[f"{part}-speeds"]
    mu = canvas.scales[plan.name]
    rows = [[tr("Link"), tr("Segment of the plan, mm"), tr("n, rpm")]]
    for end in ends_of_rays(plan):
        name = link_name(end.name)
        measured = f"|0–{f'({name})' if '–' in name else name}| = {fixed(abs(mu.mm(complex(end.value).real)), 1)}"
        rows.append([name, measured, number(float(plan[f"n{end.name}"].value))])
    return rows


def choice(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Table of the chosen tooth set and the runners-up."""
    reducer = project.reducer
    names = reducer.teeth_names
    head = [tr("No."), *(f"z_{n[1:]}" for n in names), "u", "Δu, %", "η"]
    rows = [head]
    for i, found in enumerate(reducer.sets):
        rows.append([str(i + 1), *(str(found[z].value) for z in names), fixed(found["u"].value, 3),
                     fixed(found["u_deviation"].value * 100, 2), fixed(found["eta"].value, 3)])
    inner = canvas.title(box, tr("Choice of the tooth numbers (1 is taken)"))
    if len(reducer.sets) > 1:
        by = tr("Chosen by: deviation |Δu| within {tiers} %, then the least height").format(
            tiers=" / ".join(number(100 * t) for t in reducer.tiers))
        laid = fitted(by, box.width, 3.5)
        canvas.put(laid, complex(box.centre.real - laid.width / 2, inner.y1 - 3.5), 0.0, by)
        inner = Box(inner.x0, inner.y0, inner.x1, inner.y1 - 6.0)
    wide = [8.0, *([12.0] * len(names)), 20.0, 20.0, 18.0]
    widths = [w * box.width / sum(wide) for w in wide]
    row, height = letters_in(inner.height / len(rows), widths, rows)
    canvas.table(complex(box.x0, inner.y1), widened(widths, rows, height), rows, row, height)


def conditions(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Split of the ratio, conditions, efficiency, speeds."""
    r = project.reducer
    chosen, held = ({step.name: step.value for step in plan} for plan in (r.sets[0], r.conditions))
    rows: list[tuple[str, ...]] = [
        (tr("Quantity"), tr("Value")),
        (tr("Ratio asked for"), fixed(chosen["u_asked"], 3)),
        *([(tr("Simple stage × planetary part"), f"{fixed(chosen['u_simple'], 3)} × {unsigned(chosen['u_planetary'])}")]
          if r.simple else []),
        (tr("Ratio found; deviation"), f"{fixed(chosen['u'], 3)}; {fixed(chosen['u_deviation'] * 100, 2)} %"),
        (tr("Coaxiality, teeth"), f"{held['coaxiality_left']} = {held['coaxiality_right']}"),
        (tr("Assembly with q = {planets} (whole)").format(planets=held["q"]), number(held["assembly"], 6)),
        (tr("Neighbourhood, modules"), f"{fixed(held['between'], 2)} > {fixed(held['width'], 2)}"),
        (tr("Efficiency: pair; planetary part; whole"), f"{number(chosen['eta_pair'])}; {fixed(chosen['eta_planetary'], 3)}; "
         f"{fixed(chosen['eta'], 3)}"),
    ]
    pair = project.variant.gear
    if r.simple and pair is not None and pair.teeth in ("reducer", tuple(int(wheel.teeth) for wheel in r.simple)):
        first, second = r.simple
        rows += [(tr("Wheels 1 and 2 of the gear meshing"),
                  tr("{one} (z = {teeth}) and {two} (z = {teeth2})").format(
                      one=first.number, teeth=first.teeth, two=second.number, teeth2=second.teeth))]
    each = ceil(len(r.wheels) / ceil(len(r.wheels) / 4))
    for some in (r.wheels[i:i + each] for i in range(0, len(r.wheels), each)):
        names = "; ".join(f"d_{{{w.number}}}" for w in some)
        rows.append((tr("Pitch diameters {names}, mm").format(names=names), "; ".join(number(float(w.d.value)) for w in some)))
    inner = canvas.title(box, tr("Conditions and results of the reducer"))
    end = ruled_table(canvas, Box(box.x0, box.y0 + 7 * len(r.warnings), box.x1, inner.y1), rows, (84.0,), LARGE)
    for k, text in enumerate(r.warnings):
        said = f"{text[0].upper()}{text[1:]}."
        canvas.put(fitted(said, box.width, 3.5), complex(box.x0, end - 5.5 - 6 * k), 0.0, said)


POINTS = (0.16, 0.28, 0.28, 0.28), ((180.0, 8.0), (150.0, 7.0), (120.0, 7.0))
"""Shares of the columns of a table of points; widths and heights of rows that are tried, mm."""
LINKS = (0.24, 0.4, 0.36)
"""Shares of the columns of a table of links."""
points = Table(marked("Velocities of the points"), lambda project, canvas: rows_of_points(project.reducer, canvas), *POINTS)
"""Points of the picture of velocities: distance from the main axis, segment measured on the picture, velocity."""
links = Table(marked("Speeds of rotation by the plan"), lambda project, canvas: rows_of_links(project.reducer, canvas, "reducer"),
              LINKS)
"""Links on the plan of the speeds of rotation: segment measured on it, speed."""
