"""Scheme of a train or a reducer: axial view, picture of velocities and end view on one main axis, and the plan of its speeds."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import cos, gcd, pi, sin
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.construction.step import Plan, Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.drawing.text_layout import spread
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.player import PlayerStage, extent, placed, play, ratio, standard
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
LED = 13.0
"""Least length of the shaft that leads out, beyond the web of a ring, mm."""
WALL = 6.0
"""Distance from a wheel that stands to the frame that holds it, mm."""
HUB = 2.0
"""Distance of a free wheel's hub from the line of its shaft, mm."""
OVER = 34.0
"""Room over and under the views with their title, mm."""
AXIS = 6.0
"""How far the line of zero velocity runs beyond the picture, mm."""
TITLE = 10.0
"""Height of the title of end views, mm."""
BESIDE = 12.0
"""Distance of end views of stages from each other, mm."""
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

    column, stub, face = COLUMN, STUB, FACE

    def __init__(self, train: Train) -> None:
        self.train = train
        self.edges, self.entered = columns_of(train)
        self.ends = {name: (side, sign) for name, side, sign in self.leading()}
        self.tips = {step.name: complex(step.value) for step in train.velocities if step.rule.gives == "point"}
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

    def leading(self) -> Iterator[tuple[str, int, str]]:
        """Links whose shafts lead in at the left (-1) and out at the right (1), with the signs of their speeds.

        Those of a train are what is given there and what ends there, with a wheel in a single mesh or a carrier.
        """
        train, signs = self.train, {-1: tr("n_{in}"), 1: tr("n_{out}")}
        turning = [name for name in train.names if name in train.axes and not train.stands(name)]
        ways = {-1: [name for name in turning if name in train.given], 1: [
            name for name in turning if name not in train.given and not any(name in shaft for shaft in train.data.shafts)
            and sum(name in (m.central, m.planet) for m in train.meshes) <= 1]}
        if train.entry or train.exit:
            ways = {-1: [train.entry] * bool(train.entry), 1: [train.exit] * bool(train.exit)}
        for side, edge in ((-1, self.edges[0]), (1, self.edges[-1])):
            there = {train.entry, train.exit, edge.carrier, *(name for m in edge.meshes for name in (m.central, m.planet))}
            # On one axis others turn about the shaft of the first.
            for name in {train.height(name): name for name in reversed(ways[side]) if name in there}.values():
                yield name, side, signs[side] if len(ways[side]) == 1 else f"n_{{{link_name(name)}}}"

    def turns(self, m: Mesh) -> list[float]:
        """Angles of the planets of a mesh from the first, as many as can be put in at equal angles, rad."""
        count = at_equal_angles(self.train, self.train.stage(m)) if m.carrier else 1
        # Planets of another shaft on the carrier stand between these.
        return [2 * pi * k / count + pi * self.shaft(m.planet) / count for k in range(count)]

    def shaft(self, planet: str) -> int:
        """Number of a planet's shaft among those of its carrier, 0 for the first."""
        own = next(m for m in self.train.meshes if m.planet == planet)
        return [s for s in self.train.stages if s[0].carrier == own.carrier].index(self.train.stage(own)) if own.carrier else 0

    def opposite(self, satellite: str) -> bool:
        """Whether more planets than one are on its carrier: another stands at the other side of the main axis."""
        return any(len(self.turns(m)) > 1 for m in self.train.meshes if m.carrier and m.planet == satellite)

    def sides(self, satellite: str) -> tuple[int, ...]:
        """Sides of the main axis at which a planet is drawn: over and under it; several shafts of a carrier in turn."""
        own = next(m for m in self.train.meshes if satellite == m.planet)
        if not own.carrier:
            return (1,)
        return ((1, -1)[self.shaft(satellite) % 2],) if sum(s[0].carrier == own.carrier for s in self.train.stages) > 1 else \
            (1, -1) if self.opposite(satellite) else (1,)

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
        reach, right = self.side / self.mu.mu, box.x1 - 6
        room = right - 2 * reach - box.x0
        self.stretch((room - self.pictured() - 2 * BETWEEN[0]) / self.width)
        between = max((room - self.width - self.pictured()) / 2, BETWEEN[0])
        if (spare := 2 * (between - BETWEEN[1])) > OFFERED:  # what is left at the right is of use to others
            right -= spare
            between = BETWEEN[1]
        left = box.x0 + self.width + between
        room, real = right - 2 * reach - between - left, extent([[*self.tips.values()]])
        self.speed = Scale("μ_V", handy(real.width / (min(room, self.pictured()) - 24.0)), tr("(m/s)/mm"))
        canvas.scales[self.train.velocities.name] = self.speed
        self.box = canvas.title(box, title, f"{ratio(self.mu)};  {self.speed}")
        spare = self.box.height - (self.top + self.bottom) / self.mu.mu
        self.axis = self.box.y0 + max(spare / 2, spare - UNDER) + self.bottom / self.mu.mu
        self.front = complex(right - reach, self.axis)
        self.zero = complex(left + room / 2 - self.speed.mm(real.centre.real), self.axis)

    def draw(self) -> None:
        """Draw the three views."""
        canvas = self.canvas
        self.canvas = canvas.as_role("symbol")
        self.axial()
        self.end_views()
        self.canvas = canvas
        self.velocities()

    def stretch(self, share: float) -> None:
        """Draw the axial view so many times wider, as far as that looks well."""
        share = min(max(share, 1.0), STRETCHED)
        self.width, self.column, self.stub, self.face = (share * length for length in (self.width, COLUMN, STUB, FACE))

    def pictured(self) -> float:
        """Width of use to the picture of velocities, mm: lines less steep than 45 degrees are hard to draw others parallel to."""
        return max(WIDEST, float(self.mu.mm(extent([[*self.tips.values()]]).height))) + 24.0

    def y(self, height: float) -> float:
        """Ordinate on the sheet of a height over the main axis."""
        return float(self.axis + height / self.mu.mu)

    def wheel(self, name: str, radius: float, x: float, height: float, label: int = 1, free: bool = False) -> None:
        """A wheel edge on: its disc with the rim at both ends; a ``free`` one turns on its shaft with a hub of its own."""
        c = self.canvas
        low, high = complex(x, self.y(height - radius)), complex(x, self.y(height + radius))
        ends = [low, *(complex(x, self.y(height) + side * HUB) for side in (-1, 1) if free), high]
        for a, b in zip(ends[::2], ends[1::2], strict=True):
            c.line(a, b, "main")
        for end in ends:
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
        for name, (side, sign) in self.ends.items():
            y, begin = self.y(self.train.height(name)), (max if side > 0 else min)(self.columns[name])
            end = max(self.box.x0 + self.width, begin + LED) if side > 0 else self.box.x0
            self.canvas.line(complex(end, y), complex(begin, y), "main")
            self.bearing(end - side * 6.0, y)
            self.canvas.label(complex(end, y), sign, away=complex(side, 1), height=5, gap=1.5)
        between = [name for name in self.train.given if name in self.columns.keys() - self.ends and not self.train.stands(name)]
        for name in between:
            at = complex(self.columns[name][0], self.y(self.train.height(name)))
            self.canvas.label(at, f"n_{{{link_name(name)}}}", away=1 - 1j, height=5, gap=self.face / 2 + 1.0)

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

    def end_views(self) -> None:
        """Pitch circles of all wheels; unlike stages beside each other, to the largest scale with room for all."""
        stages: dict[Any, list[Mesh]] = {}
        for carrier in dict.fromkeys(m.carrier for m in self.train.meshes):
            own = [m for m in self.train.meshes if m.carrier == carrier]
            look = frozenset((round(1e6 * abs(z)), round(1e6 * radius)) for z, radius, _ in self.circles(own)) if carrier else ""
            stages.setdefault(look, []).extend(own)
        if len(stages) - ("" in stages) < 2:
            self.end_view(self.train.meshes, self.front, self.mu)
            return
        views = sorted(stages.values(), key=self.reach, reverse=True)
        width, height = 2 * self.side / self.mu.mu, self.box.height - TITLE
        scales: dict[int, tuple[Scale, list[float], list[float]]] = {}
        for c in range(1, len(views) + 1):
            wide = [2 * max(map(self.reach, views[k::c])) for k in range(c)]
            high = [2 * max(map(self.reach, views[k:k + c])) for k in range(0, len(views), c)]
            scales[c] = standard((sum(wide), width - BESIDE * len(wide)), (sum(high), height - BESIDE * len(high))), wide, high
        count = min(scales, key=lambda c: scales[c][0].mu)
        mu, wide, high = scales[count]
        left, top = self.front.real - width / 2, self.box.y1 - TITLE
        self.canvas.text(complex(self.front.real, top + 3.0), tr("End views {scale}").format(scale=ratio(mu)), 5.0, "centre")
        for k, view in enumerate(views):
            row, column = divmod(k, count)
            x = left + mu.mm(sum(wide[:column]) + wide[column] / 2) + BESIDE * (column + 0.5)
            self.end_view(view, complex(x, top - mu.mm(sum(high[:row]) + high[row] / 2) - BESIDE * (row + 0.5)), mu)

    def reach(self, meshes: Sequence[Mesh]) -> float:
        """How far wheels reach from the main axis, m."""
        return max(abs(z) + radius for z, radius, _ in self.circles(meshes))

    def circles(self, meshes: Sequence[Mesh]) -> list[tuple[complex, float, list[str]]]:
        """Middles of pitch circles from the main axis, radii, m, and names; the planets of a carrier at equal angles.

        Wheels alike in one place have one circle.
        """
        found = list[tuple[complex, float, list[str]]]()
        for m in meshes:
            for name in (m.central, m.planet):
                radius = float(self.train.radius(name, m))
                for turn in self.turns(m) if m.carrier and name == m.planet else [0.0]:
                    at = rect(self.train.height(name), pi / 2 + turn)
                    alike = next((of for z, r, of in found if max(abs(z - at), abs(r - radius)) < 1e-9), None)
                    if alike is None:
                        found.append((at, radius, [name]))
                    elif name not in alike:
                        alike.append(name)
        return found

    def end_view(self, meshes: Sequence[Mesh], o: complex, mu: Scale) -> None:
        """Wheels of some meshes about the main axis at ``o``."""
        c, planets = self.canvas, {m.planet for m in meshes if m.carrier}
        circles = [(o + mu.mm(z), mu.mm(radius), names) for z, radius, names in self.circles(meshes)]
        reach = max(abs((z - o).real) + radius for z, radius, _ in circles) + 4
        low, high = (f(z.imag + side * radius for z, radius, _ in circles) for f, side in ((min, -1), (max, 1)))
        c.line(o - reach, o + reach, "centre")
        c.line(complex(o.real, low - 4), complex(o.real, high + 4), "centre")
        c.dot(o, 1.2)
        named: dict[str, tuple[complex, float]] = {}
        for at, radius, names in circles:
            if planets.intersection(names):
                c.line(o, at, "main")
            if abs(at - o) > 1e-6:
                c.dot(at, 1.0)
            c.circle(at, radius, "main" if any(map(self.train.stands, names)) else "axis")
            named[", ".join(names)] = at, radius
        count = max(len(self.turns(m)) for m in meshes)
        for k, (name, (at, radius)) in enumerate(named.items()):
            away = rect(1, pi / 2 - pi / count + 0.05 - 0.17 * k if abs(at - o) < 1e-6 else -0.4 - 0.5 * (k // 2))
            c.label(at + radius * away, name, away=away, height=3.5, gap=1.0)

    # --- picture of velocities ----------------------------------------------------------------------------------

    def velocities(self) -> None:
        """Lines of the links over the heights of their points."""
        low, high = (self.y(f(v.imag for v in self.tips.values())) for f in (min, max))
        s = placed(self.canvas, self.train.velocities, self.zero, (self.speed.mu, self.mu.mu))
        s.line("O", complex(self.zero.real, low - AXIS), complex(self.zero.real, high + AXIS), "axis", "axis")
        self.heights(s, [name for name in self.tips if name[0].isupper()])
        self.vectors(s, {name: value for name, value in self.tips.items() if name[0].islower()})
        self.lines(s)

    def vectors(self, s: PlayerStage, ends: Mapping[str, complex]) -> None:
        """Velocities of the points, from the line of zero velocity to their ends."""
        for name, value in ends.items():
            s.vector(name.upper(), name)
            self.canvas.label(s.at(name), name if len(name) == 1 else f"{name[0]}_{name[1:]}",
                              away=complex(1 if value.real > 0 else -1, 0.4), height=3.5, gap=1.2)

    def lines(self, s: PlayerStage) -> None:
        """Line of each link through the ends of the velocities of all its points."""
        plan = self.train.velocities
        points = [step for step in plan if step.rule.gives == "point"]
        for step in (step for step in plan if step.rule.gives == "direction"):
            on = sorted((complex(p.value) for p in (*step.args, *(p for p in points if step in p.args))), key=lambda z: z.imag)
            a, b = complex(s.frame(on[0])), complex(s.frame(on[-1]))
            s.pen(step, "axis").ray_line(a, b, "axis", over=5.0, before=0.0 if abs(on[0].real) < 1e-12 else 5.0)
            self.canvas.label(a + 0.62 * (b - a), link_name(step.name), away=1j * (b - a) * (-1 if (b - a).real > 0 else 1),
                              height=5, gap=1.2)

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
    mu = Scale("μ_n", handy(max((high - low) / room, 30 / pi * picture.mu / (heights.mu * tall))), tr("rpm/mm"))
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
    for k, ((end, link), wanted) in enumerate(zip(ends, spread([end.real for end, _ in ends], NAME), strict=True)):
        x = min(max(wanted, box.x0 + NAME * (k + 0.5)), box.x1 - NAME * (len(ends) - k - 0.5))
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
    ends = [(end.name.upper(), end.name, complex(end.value)) for end in moving_points(of)]
    return [[tr("Point"), tr("Distance from the axis, mm"), tr("Segment of the picture, mm"), tr("V, m/s")], *(
        [name, number(1e3 * abs(at.imag)), f"|{name}{end}| = {fixed(abs(mu.mm(at.real)), 1)}", number(at.real)]
        for name, end, at in ends)]


def moving_points(of: Train) -> list[Step]:
    """Ends of the velocities that the picture has."""
    plan = of.velocities
    return [end for end in plan if end.name.islower() and end.rule.gives == "point" and end.name.upper() in plan]


def rows_of_links(of: Train, canvas: Canvas) -> list[list[str]]:
    """Heading and a row for each link on the plan that the sheet has."""
    plan = of.plans[f"{of.data.part}-speeds"]
    mu = canvas.scales[plan.name]
    return [[tr("Link"), tr("Segment of the plan, mm"), tr("n, rpm")], *(
        [link_name(end.name), f"|0–{link_name(end.name)}| = {fixed(abs(mu.mm(complex(end.value).real)), 1)}",
         number(float(plan[f"n{end.name}"].value))] for end in ends_of_rays(plan))]
