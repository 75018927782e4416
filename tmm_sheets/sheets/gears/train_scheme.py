"""Scheme of a train or a reducer: axial view, picture of velocities and end view on one main axis, and the plan of its speeds."""

from __future__ import annotations

from cmath import rect
from collections.abc import Mapping, Sequence
from itertools import product
from math import cos, gcd, pi, sin
from typing import TYPE_CHECKING, NamedTuple

from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.construction.step import Plan, Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import fitted, letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import spread
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.player import PlayerStage, placed, play, ratio, standard
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.methods.gears.train_steps import Mesh

COLUMN = 19.0
"""Distance of two columns of wheels of the axial view, mm."""
SLEEVE = 6.0
"""Length of the sleeve of a wheel about a standing axis, mm."""
FACE = 7.0
"""Width of a wheel's rim in the axial view, mm."""
STUB = 15.0
"""Length of the shafts that lead in and out, mm."""
WALL = 6.0
"""Distance from a wheel that stands to the frame that holds it, mm."""
HUB = 2.0
"""Distance of a free wheel's hub from the line of its shaft, mm."""
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


def link_name(name: str) -> str:
    """A link's name as it is written: carriers with an index."""
    return f"H_{name[1:]}" if name.startswith("H") and len(name) > 1 else name


def draw_scheme(train: Train, canvas: Canvas, box: Box, title: str) -> None:
    """Axial view, picture of velocities and end view side by side on one main axis, to one scale."""
    canvas.of = train.velocities.name
    views = TrainScheme(train)
    views.place(canvas, box, f"{train.data.part}-scheme", title)
    views.draw()


def at_equal_angles(train: Train, stage: tuple[Mesh, ...]) -> int:
    """So many planets of a stage can be put in at equal angles, no more than the task has."""
    one, *others = stage
    wanted: int = train.data.satellites
    return next(q for q in range(wanted, 0, -1) if all(whole_number(train.data.teeth, one, m) % q == 0 for m in others))


def whole_number(teeth: dict[str, int], one: Mesh, other: Mesh) -> int:
    """What the number of planets at equal angles has to divide, of two central wheels of one carrier."""
    (a, b), (c, d), sign = (one.central, one.planet), (other.central, other.planet), -1 if one.sign * other.sign > 0 else 1
    return teeth[a] + sign * teeth[c] if b == d else (teeth[a] * teeth[d] + sign * teeth[b] * teeth[c]) // gcd(teeth[b], teeth[d])


class Edge(NamedTuple):
    """What one column of the axial view has: a carrier's arm, or meshes, that of a sun and a ring about one planet together."""

    carrier: str
    meshes: list[Mesh]


def columns_of(train: Train) -> tuple[list[Edge], set[str]]:
    """Columns of the axial view from the input on, and the wheels and carriers that are entered from the left.

    The arm of a carrier stands where its shaft leads to, what is held in the frame beside it.
    """
    turning = {train.link(name) for name in train.given if not train.stands(name)}
    found, entered = list[Edge](), set[str]()
    for m in train.meshes:
        if m.carrier and any(m.carrier == edge.carrier for edge in found):
            continue
        group = [o for o in train.meshes if o is m or (m.carrier and o.carrier == m.carrier)]
        names = {name for o in group for name in (o.central, o.planet, o.carrier) if name}
        entered |= (driving := {name for name in names if train.link(name) in turning})
        edges = list[Edge]()
        for stage in dict.fromkeys(map(train.stage, group)):
            for o in sorted(stage, key=lambda o: train.stands(o.central) is (m.carrier not in driving)):
                if edges and len(of := edges[-1].meshes) == 1 and of[0].planet == o.planet and of[0].sign != o.sign:
                    of.append(o)
                else:
                    edges.append(Edge("", [o]))
        arm = [Edge(m.carrier, [])] if m.carrier else []
        found += [*arm, *edges] if m.carrier in driving else [*edges, *arm]
        turning |= set(map(train.link, names))
    return found, entered


class TrainScheme:
    """Axial view, picture of velocities and end view of a train; heights in metres over the main axis become millimetres.

    They reach to ``top``, ``bottom`` and ``side`` (m), the axial view is ``width`` wide (mm). Of it ``column``, ``stub`` and
    ``face`` are the distance of wheels, the length of the shafts that lead in and out and the width of a rim, mm; it is stretched
    along the axis where there is room. Planets stand at both sides of the axis, turned into its plane (GOST 2.703), so that each
    edge of a ring meshes with one; wheels on one planet shaft are joined by a sleeve.
    """

    canvas: Canvas
    mu: Scale
    box: Box
    axis: float
    picture: Box
    front: complex
    column, stub, face = COLUMN, STUB, FACE

    def __init__(self, train: Train) -> None:
        self.train = train
        self.edges, self.entered = columns_of(train)
        self.ends = {name for name in (train.entry, train.exit) if name}
        above, beside = list[float](), list[float]()
        for m in train.meshes:
            above += [train.height(m.central) + side * train.radius(m.central, m) for side in (1, -1)]
            beside.append(train.radius(m.central, m))
            # In the end view the planets of a carrier stand all round, in the axial one at both sides.
            for turn in {*self.turns(m), *((0.0, pi) if m.carrier and self.opposite(m.planet) else ())}:
                above += [train.height(m.planet) * cos(turn) + side * train.radius(m.planet, m) for side in (1, -1)]
                beside.append(train.height(m.planet) * abs(sin(turn)) + train.radius(m.planet, m))
        self.top, self.bottom, self.side = max(above), -min(above), max(beside)
        self.width = (len(self.edges) - 1) * COLUMN + 2 * STUB

    def turns(self, m: Mesh) -> list[float]:
        """Angles of the planets of a mesh from the first, as many as can be put in at equal angles, rad."""
        count = at_equal_angles(self.train, self.train.stage(m)) if m.carrier else 1
        # Planets of another shaft on the carrier stand between these.
        return [2 * pi * k / count + pi * self.shaft(m.planet) / count for k in range(count)]

    def shaft(self, planet: str) -> int:
        """Number of a planet's shaft among those of its carrier, 0 for the first."""
        own = next(m for m in self.train.meshes if m.planet == planet)
        of = [s for s in self.train.stages if s[0].carrier == own.carrier]
        return of.index(self.train.stage(own)) if own.carrier else 0

    def opposite(self, satellite: str) -> bool:
        """Whether more planets than one are on its carrier: another stands at the other side of the main axis."""
        return any(len(self.turns(m)) > 1 for m in self.train.meshes if m.carrier and m.planet == satellite)

    def sides(self, satellite: str) -> tuple[int, ...]:
        """Sides of the main axis at which a planet is drawn: over and under it; several shafts of a carrier in turn."""
        own = next(m for m in self.train.meshes if satellite == m.planet)
        if not own.carrier:
            return (1,)
        if sum(s[0].carrier == own.carrier for s in self.train.stages) > 1:
            return ((1, -1)[self.shaft(satellite) % 2],)
        return (1, -1) if self.opposite(satellite) else (1,)

    def draw(self) -> None:
        """Draw the three views."""
        with self.canvas.as_role("symbol"):
            self.axial()
            self.end_view()
        self.velocities()

    def fitted(self, width: float, height: float) -> Scale:
        """The scale with which they fit a place with their title."""
        return standard((self.top + self.bottom, height - OVER), (2 * self.side, width - self.beside(NARROWEST)))

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
        self.picture = Box(left, self.box.y0, self.front.real - self.side / self.mu.mu - between, self.box.y1)

    def stretch(self, share: float) -> None:
        """Draw the axial view so many times wider, as far as that looks well."""
        share = min(max(share, 1.0), STRETCHED)
        self.width, self.column, self.stub, self.face = (share * length for length in (self.width, COLUMN, STUB, FACE))

    def pictured(self) -> float:
        """Width of use to the picture of velocities, mm: lines less steep than 45 degrees are hard to draw others parallel to."""
        heights = [complex(step.value).imag for step in self.train.velocities if step.rule.gives == "point"]
        return max(WIDEST, float(self.mu.mm(max(heights) - min(heights)))) + 24.0

    def y(self, height: float) -> float:
        """Ordinate on the sheet of a height over the main axis."""
        return float(self.axis + height / self.mu.mu)

    def wheel(self, name: str, radius: float, x: float, height: float, label: int = 1, free: bool = False) -> None:
        """A wheel edge on: its disc with the rim at both ends; a ``free`` one turns on its shaft with a hub of its own."""
        c = self.canvas
        low, high = complex(x, self.y(height - radius)), complex(x, self.y(height + radius))
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
        c.label(at + self.face / 2, name, away=complex(1, label), height=5, gap=1.2)

    def held(self, x: float, radius: float, name: str) -> None:
        """The edges of a ring that stands still, each held in the frame."""
        c = self.canvas
        for side in (1, -1):
            rim = complex(x, self.y(side * radius))
            out = rim + 1j * WALL * side
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

    # --- axial view ---------------------------------------------------------------------------------------------

    def axial(self) -> None:
        """Wheels, shafts and carriers edge on."""
        c, train, x0 = self.canvas, self.train, self.box.x0
        c.line(complex(x0 + 1, self.axis), complex(x0 + self.width + 2, self.axis), "centre")
        self.columns: dict[str, list[float]] = {}
        places = [x0 + self.stub + k * self.column for k in range(len(self.edges))]
        arms = {edge.carrier: x for edge, x in zip(self.edges, places, strict=True) if edge.carrier}
        axles: dict[tuple[Mesh, ...], list[float]] = {}
        for edge, x in zip(self.edges, places, strict=True):
            if edge.carrier:
                self.arm(edge.carrier, x)
            for m in edge.meshes:
                self.central(m, x, 1 if arms.get(m.carrier, x0) > x else -1)
                self.planet(m, x)
                for name in dict.fromkeys((m.central, m.planet)):
                    self.columns.setdefault(name, []).append(x)
                if m.carrier:
                    axles.setdefault(train.stage(m), [arms[m.carrier]]).append(x)
        for stage, along in axles.items():
            for side in self.sides(stage[0].planet):
                height = self.y(side * train.distance(stage[0]))
                ends = min(along), max(along)
                a, b = (x + out * (x != along[0]) for x, out in zip(ends, (-self.face, self.face), strict=True))
                c.line(complex(a, height), complex(b, height), "main")
        self.joined()
        self.led_out()

    def led_out(self) -> None:
        """Shafts of the driving and the driven link, with their bearings and the names of their speeds."""
        for name, side, text in ((self.train.entry, -1, tr("n_{in}")), (self.train.exit, 1, tr("n_{out}"))):
            if name:
                y = self.y(self.train.height(name))
                end = self.box.x0 + (self.width if side > 0 else 0.0)
                self.canvas.line(complex(end, y), complex((max if side > 0 else min)(self.columns[name]), y), "main")
                self.bearing(end - side * 6.0, y)
                self.canvas.label(complex(end, y), text, away=complex(side, 1), height=5, gap=1.5)

    def joined(self) -> None:
        """Shafts and sleeves of what turns together: about a standing axis a shaft, planets on a carrier by a sleeve."""
        for shaft in (*self.train.data.shafts, *([m.planet] for m in self.train.meshes)):
            columns = sorted({x for name in shaft for x in self.columns.get(name, ())})
            if len(columns) < 2:
                continue
            planets = [m.planet for m in self.train.meshes if m.carrier and m.planet in shaft]
            for edge in self.sides(planets[0]) if planets else (1,):
                y = self.y(edge * self.train.height(shaft[-1]))
                for side in (-1, 1) if planets else (0,):
                    self.canvas.line(complex(columns[0], y + side * HUB), complex(columns[-1], y + side * HUB), "main")
            if not planets and columns[-1] - columns[-2] > self.column / 2:
                self.bearing((columns[-2] + columns[-1]) / 2, y)
        for name, columns in self.columns.items():
            for m in self.train.meshes:
                if name == m.planet and len(columns) > 1:  # one wide wheel
                    for edge, side in product(self.sides(name), (-1, 1)):
                        rim = self.y(edge * self.train.height(name) + side * self.train.radius(name, m))
                        self.canvas.line(complex(columns[0], rim), complex(columns[-1], rim), "main")

    def on_shaft(self, name: str) -> bool:
        """True for a wheel or carrier that turns with another one, or whose shaft leads in or out."""
        return name in self.ends or any(name in shaft for shaft in self.train.data.shafts)

    def planet(self, m: Mesh, x: float) -> None:
        """The planet of a mesh on its axis."""
        radius, up = self.train.radius(m.planet, m), self.train.height(m.planet)
        if x in self.columns.get(m.planet, ()):
            return
        for side in self.sides(m.planet):
            name = "" if m.planet in self.columns or side < 0 else m.planet
            self.wheel(name, radius, x, side * up, label=1 if side * up >= 0 else -1, free=bool(m.carrier))
        if not m.carrier and m.planet not in self.ends:
            self.canvas.line(complex(x - SLEEVE, self.y(up)), complex(x + SLEEVE, self.y(up)), "main")
            self.bearing(x - SLEEVE, self.y(up))

    def central(self, m: Mesh, x: float, towards: int) -> None:
        """The wheel about the main axis on its shaft or with a sleeve, or held in the frame at the side of the carrier's arm."""
        r, stands = self.train.radius(m.central, m), self.train.stands(m.central)
        up = self.train.height(m.central)
        name = "" if m.central in self.columns else m.central  # in several meshes, as ring and as sun, it is named once
        if m.sign < 0:
            self.ring(m.central, r, x, up)
            return
        label = -1 if self.train.height(m.planet) > up or m.carrier else 1
        self.wheel(name, r, x, up, label, free=not stands and not self.on_shaft(m.central))
        if stands:
            wall = complex(x + towards * WALL, self.y(up))
            self.canvas.line(complex(x, self.y(up)), wall, "main")
            self.canvas.line(wall - 5j, wall + 5j, "main")
            self.canvas.hatch(wall - 5j, wall + 5j, -towards)

    def ring(self, name: str, r: float, x: float, up: float) -> None:
        """A ring: held in the frame where it meshes, or joined by a disc to its shaft, or to a sleeve about the main axis."""
        c, side = self.canvas, -1 if name in self.entered else 1
        if self.train.stands(name):
            self.held(x, r, name)
            return
        web = x + side * (self.face + 3)
        for end in (1, -1):
            rim = complex(x, self.y(up + end * r))
            c.line(rim - side * self.face / 2, complex(web, rim.imag), "main")
            hub = complex(web, self.y(up) + (0.0 if self.on_shaft(name) else end * HUB))
            c.line(complex(web, rim.imag), hub, "main")
            if not self.on_shaft(name):
                c.line(hub - self.face / 2, hub + self.face / 2, "main")
        if name not in self.columns:
            c.label(complex(x - self.face / 2, self.y(up - r)), name, away=-1 - 0.6j, height=5, gap=1.2)
        self.columns.setdefault(name, []).append(web)

    def arm(self, carrier: str, x: float) -> None:
        """The carrier's arm from the main axis to the planets'."""
        self.columns[carrier] = [x]
        of = [m for m in self.train.meshes if m.carrier == carrier]
        ends = [self.y(side * self.train.distance(m)) for m in of for side in self.sides(m.planet)]
        c, top, low = self.canvas, max(*ends, self.axis), min(*ends, self.axis)
        c.line(complex(x, low), complex(x, top), "main")
        if not self.on_shaft(carrier):
            end = complex(x + (-1 if carrier in self.entered else 1) * self.stub, self.axis)
            c.line(end, complex(x, self.axis), "main")
            self.bearing((end.real + x) / 2, self.axis)
            if self.train.stands(carrier):
                c.hatch(end - 4j, end + 4j, 1, depth=2.0, step=2.0)
        c.label(complex(x, (self.axis + top) / 2), link_name(carrier), away=1, height=5, gap=1.2)

    # --- view along the axis ------------------------------------------------------------------------------------

    def end_view(self) -> None:
        """Pitch circles of all wheels, the planets of a carrier at equal angles; wheels alike in one place have one circle."""
        c, o, mm, train = self.canvas, self.front, self.mu.mm, self.train
        reach = mm(self.side) + 4
        c.line(o - reach, o + reach, "centre")
        c.line(complex(o.real, self.y(-self.bottom) - 4), complex(o.real, self.y(self.top) + 4), "centre")
        c.dot(o, 1.2)
        circles = list[tuple[complex, float, list[str]]]()
        for m in train.meshes:
            for name in (m.central, m.planet):
                planet = bool(m.carrier) and name == m.planet
                radius = float(mm(train.radius(name, m)))
                for turn in self.turns(m) if planet else [0.0]:
                    at = o + rect(mm(train.height(name)), pi / 2 + turn)
                    if planet:
                        c.line(o, at, "main")
                    if abs(at - o) > 1e-6:
                        c.dot(at, 1.0)
                    alike = next((of for z, r, of in circles if abs(z - at) < 1e-6 and abs(r - radius) < 1e-6), None)
                    if alike is None:
                        circles.append((at, radius, [name]))
                    elif name not in alike:
                        alike.append(name)
        count = max(len(self.turns(m)) for m in train.meshes)
        named: dict[str, tuple[complex, float]] = {}
        for at, radius, names in circles:
            c.circle(at, radius, "main" if any(map(train.stands, names)) else "axis")
            named[", ".join(names)] = at, radius
        for k, (name, (at, radius)) in enumerate(named.items()):
            away = rect(1, pi / 2 - pi / count + 0.05 - 0.17 * k if abs(at - o) < 1e-6 else -0.4 - 0.5 * (k // 2))
            c.label(at + radius * away, name, away=away, height=3.5, gap=1.0)

    # --- picture of velocities ----------------------------------------------------------------------------------

    def velocities(self) -> None:
        """Lines of the links over the heights of their points."""
        c, plan = self.canvas, self.train.velocities
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
        plan = self.train.velocities
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


NAME = 30.0
"""Room for a link's speed of rotation on its plan, mm."""
POINTS = (0.16, 0.28, 0.28, 0.28), ((180.0, 8.0), (150.0, 7.0), (120.0, 7.0))
"""Shares of the columns of a table of points; widths and heights of rows that are tried, mm."""
LINKS = (0.24, 0.4, 0.36)
"""Shares of the columns of a table of links."""


def plan_of_speeds(train: Train, canvas: Canvas, box: Box) -> None:
    """Plan of the speeds of rotation: rays through the pole parallel to the lines of the picture of velocities."""
    part = train.data.part
    canvas.of = f"{part}-speeds"
    picture: Scale = canvas.scales[f"{part}-velocities"]
    heights: Scale = canvas.scales[f"{part}-scheme"]
    values = [float(n.value) for n in train.links.values()]
    low, high = min(0.0, *values), max(0.0, *values)
    room, tall = box.width - 30, box.height - 44
    # A speed n takes n/mu_n mm, and with the picture's scale factors H = 30 mu_V/(pi mu_l mu_n).
    least = max((high - low) / room, 30 / pi * picture.mu / (heights.mu * tall))
    mu = Scale("μ_n", handy(least), tr("rpm/mm"))
    distance = 30 / pi * picture.mu / (heights.mu * mu.mu)
    inner = canvas.title(box, tr("Plan of the speeds of rotation"), tr("{scale};  H = {distance} mm").format(
        scale=mu, distance=fixed(distance, 1)))
    canvas.scales[f"{part}-speeds"] = picture
    plan = train.speeds(distance * heights.mu)
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


def rows_of_points(of: Train, canvas: Canvas) -> list[list[str]]:
    """Heading and a row for each point whose velocity the picture has."""
    mu = canvas.scales[of.velocities.name]
    rows = [[tr("Point"), tr("Distance from the axis, mm"), tr("Segment of the picture, mm"), tr("V, m/s")]]
    for end in moving_points(of):
        name, at = end.name.upper(), complex(end.value)
        measured = f"|{name}{end.name}| = {fixed(abs(mu.mm(at.real)), 1)}"
        rows.append([name, number(1e3 * abs(at.imag)), measured, number(at.real)])
    return rows


def moving_points(of: Train) -> list[Step]:
    """Ends of the velocities that the picture has."""
    plan = of.velocities
    return [end for end in plan if end.name.islower() and end.rule.gives == "point" and end.name.upper() in plan]


def rows_of_links(of: Train, canvas: Canvas) -> list[list[str]]:
    """Heading and a row for each link on the plan that the sheet has."""
    plan = of.plans[f"{of.data.part}-speeds"]
    mu = canvas.scales[plan.name]
    rows = [[tr("Link"), tr("Segment of the plan, mm"), tr("n, rpm")]]
    for end in ends_of_rays(plan):
        name = link_name(end.name)
        measured = f"|0–{name}| = {fixed(abs(mu.mm(complex(end.value).real)), 1)}"
        rows.append([name, measured, number(float(plan[f"n{end.name}"].value))])
    return rows
