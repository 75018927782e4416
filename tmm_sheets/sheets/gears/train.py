"""Views of a train of gears: scheme with the picture of velocities, plan of speeds, table."""

from __future__ import annotations

from cmath import rect
from itertools import product
from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import fitted, size_for
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import number
from tmm_sheets.sheets.components.listed import LARGE, Lines, Table
from tmm_sheets.sheets.gears.gear_marks import ruled_table
from tmm_sheets.sheets.gears.planet_motion import at_equal_angles
from tmm_sheets.sheets.gears.reducer import (
    COLUMN,
    HUB,
    LINKS,
    POINTS,
    STUB,
    Edge,
    SchemeViews,
    plan_of_speeds,
    rows_of_links,
    rows_of_points,
)
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.train import Train
    from tmm_sheets.methods.gears.train_steps import Mesh
    from tmm_sheets.project import Project

SLEEVE = 6.0
"""Length of the sleeve of a wheel about the main axis, mm."""


def scheme(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Axial view, picture of velocities and end view side by side on one main axis, to one scale."""
    canvas.of = "train-velocities"
    views = SchemeOfTrain(project.train)
    views.place(canvas, box, "train-scheme", tr("Scheme of the train, picture of velocities and end view"))
    views.draw()


def speeds(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Plan of the speeds of rotation: rays through the pole parallel to the lines of the picture of velocities."""
    plan_of_speeds(project.train, canvas, box, "train")


def table(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Tooth numbers and speeds of all wheels and carriers, and what was given."""
    train = project.train
    plan = train.kinematics
    rows: list[tuple[str, ...]] = [(tr("Link"), "z", "n")]
    for name in train.names:
        teeth = str(int(plan[f"z{name}"].value)) if name in train.data.teeth else "–"
        n = number(float(plan[f"n{name}"].value))
        rows.append((f"{name} — {tr('given')}" if name in train.given else name, teeth, n))
    inner = canvas.title(box, tr("Wheels and speeds of rotation, rpm"))
    end = ruled_table(canvas, Box(box.x0, box.y0 + 7 * len(train.warnings), box.x1, inner.y1), rows, (30.0, 40.0), LARGE)
    for k, text in enumerate(train.warnings):
        said = f"{text[0].upper()}{text[1:]}."
        canvas.put(fitted(said, box.width, 3.5), complex(box.x0, end - 5.5 - 6 * k), 0.0, said)


def sizes(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Pitch diameters and distances of axes in letters and in numbers."""
    lines = dimensions(project)
    left = canvas.title(box, tr("Dimensions of the train, mm"))
    step = min(LARGE, left.height / len(lines))
    canvas.lines(complex(box.x0, left.y1 - 0.8 * step), lines, step, size_for(lines, box.width, 5.0 if step >= 9.0 else 3.5))


def dimensions(project: Project) -> list[str]:
    """Distance of the axes of every stage, half the sum or the difference of its diameters, and diameters of the wheels."""
    train = project.train
    plan = train.kinematics
    m, lines, shown = float(plan["m"].value), list[str](), set[Any]()
    for mesh in train.meshes:
        c, p, sign = mesh.central, mesh.planet, "+" if mesh.sign > 0 else "−"
        z = {name: int(plan[f"z{name}"].value) for name in (c, p)}
        diameter = plan[f"d{c}-{p}"]
        if (stage := train.stage(mesh)) not in shown:  # planets that turn together run at one distance
            shown.add(stage)
            lines.append(f"a_{{{c}–{p}}} = m·(z_{{{c}}} {sign} z_{{{p}}})/2 = {number(m)}·({z[c]} {sign} {z[p]})/2 = "
                         f"{number(1e3 * train.distance(mesh))}")
        # Where wheels of another sum of teeth run at the same distance they roll on other circles than those of the module.
        rolled = float(diameter.value)
        for name in (c, p):
            if abs(rolled - m * z[c]) < 1e-9 * rolled:
                line = f"d_{{{name}}} = m·z_{{{name}}} = {number(m)}·{z[name]} = {number(m * z[name])}"
            else:
                other = p if name == c else c
                twice = number(2e3 * train.distance(mesh))
                line = (f"d_{{w{name}–{other}}} = 2a·z_{{{name}}}/(z_{{{c}}} {sign} z_{{{p}}}) = "
                        f"{twice}·{z[name]}/({z[c]} {sign} {z[p]}) = {number(rolled * z[name] / z[c])}")
            lines += [line] if line not in lines else []
    return lines


def mobility_lines(train: Train) -> list[str]:
    """What stands is frame. Passive meshes are none of the formula's: with them it is left out. Planets have no ratio of use."""
    n = {name: float(step.value) for name, step in train.links.items() if not train.stands(name)}
    driving = [train.link(name) for name in train.given if not train.stands(name)]
    planets = {train.link(m.planet) for m in train.meshes if m.carrier}
    links, meshes, lines = len(n), len(train.meshes), list[str]()
    if links - meshes == len(driving):
        lines.append(f"W = 3n − 2p_5 − p_4 = 3·{links} − 2·{links} − {meshes} = {links - meshes}")
    if len(driving) == 1:
        one = driving[0]
        for name in (name for name in n if name != one and name not in planets and n[name]):
            both = f"{one},{name}" if len(one + name) > 2 else one + name
            lines.append(f"i_{{{both}}} = n_{{{one}}}/n_{{{name}}} = {number(n[one])}/{_signed(n[name])} = "
                         f"{number(n[one] / n[name])}")
    return lines + [f"ω_{{{name}}} = π·n_{{{name}}}/30 = {number(value * pi / 30, 5)} {tr('rad/s')}" for name, value in n.items()]


def willis(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The equation of Willis of every mesh, in letters and in numbers; multiplied out, for a planet may rest on its carrier."""
    train = project.train
    lines = [line for m in train.meshes for line in _equation(train, m)]
    left = canvas.title(box, tr("Willis equations of the meshes (n in rpm)"))
    step = min(left.height / len(lines), LARGE)
    height = size_for(lines, box.width, 5.0 if step >= 9.0 else 3.5)
    canvas.lines(complex(box.x0, left.y1 - step), lines, step, height)


def _equation(train: Train, m: Mesh) -> tuple[str, str]:
    """z_c(n_c - n_H) = -+z_p(n_p - n_H) of a mesh, outer or inner; without a carrier n_H is none."""
    plan = train.kinematics
    c, p, h = m.central, m.planet, m.carrier
    sign = "−" if m.sign > 0 else ""
    # In brackets a number in the equation is what its letter is: with its sign.
    turns = {name: _signed(float(plan[f"n{name}"].value)) for name in (c, p, h) if name}
    teeth = {name: str(int(plan[f"z{name}"].value)) for name in (c, p)}

    def side(z: dict[str, str], n: dict[str, str], name: str) -> str:
        return f"{z[name]}·({n[name]} − {n[h]})" if h else f"{z[name]}·{n[name]}"

    letters = {name: f"n_{{{name}}}" for name in (c, p, h) if name}
    signs = {name: f"z_{{{name}}}" for name in (c, p)}
    return (f"{c}–{p}:  {side(signs, letters, c)} = {sign}{side(signs, letters, p)}",
            f"{side(teeth, turns, c)} = {sign}{side(teeth, turns, p)}")


def _signed(value: float) -> str:
    text = number(value)
    return f"({text})" if value < 0 else text


class SchemeOfTrain(SchemeViews):
    """The views of a train: each mesh has a column of its own, wheels on one planet shaft are joined by a sleeve."""

    above = 8.0

    def __init__(self, train: Train) -> None:
        self.reducer = self.train = train
        ends = [(self.height(name) + side * train.radius(name, m)) for m in train.meshes
                for name in (m.central, m.planet) for side in (1, -1)]
        ends += [-self.height(m.planet) + side * train.radius(m.planet, m) for m in train.meshes
                 if m.carrier and self.opposite(m.planet) for side in (1, -1)]
        # In the end view the planets of a carrier stand all round.
        ends += [self.height(m.planet) * cos(turn) + side * train.radius(m.planet, m) for m in train.meshes if m.carrier
                 for turn in self.turns(m) for side in (1, -1)]
        self.top, self.bottom = max(ends), -min(ends)
        self.side = max(train.radius(name, m) for m in train.meshes for name in (m.central, m.planet))
        self.side = max(self.side, *(train.distance(m) * abs(sin(turn)) + train.radius(m.planet, m)
                                     for m in train.meshes if m.carrier for turn in self.turns(m)), 0.0)
        columns = len(train.meshes) + len({m.carrier for m in train.meshes if m.carrier})
        self.width = columns * COLUMN + 2 * STUB

    def height(self, name: str) -> float:
        """Height of a wheel's axis over the main one, m."""
        found = self.train.height(name)
        return float(found)

    def opposite(self, satellite: str) -> bool:
        """Whether more planets than one are on its carrier: another stands at the other side of the main axis."""
        return any(len(self.turns(m)) > 1 for m in self.train.meshes if m.carrier and m.planet == satellite)

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

    def sides(self, satellite: str) -> tuple[int, ...]:
        """Sides of the main axis at which a satellite is drawn; several shafts of a carrier in turn over and under it."""
        own = next(m for m in self.train.meshes if satellite == m.planet)
        several = sum(s[0].carrier == own.carrier for s in self.train.stages) > 1
        return ((1, -1)[self.shaft(satellite) % 2],) if own.carrier and several else super().sides(satellite)

    def draw(self) -> None:
        """Draw the three views."""
        with self.canvas.as_role("symbol"):
            self.axial()
            self.end_view()
        self.velocities()

    def axial(self) -> None:
        """Wheels, shafts and carriers edge on."""
        c, train = self.canvas, self.train
        c.line(complex(self.box.x0 + 1, self.axis), complex(self.box.x0 + self.width + 2, self.axis), "centre")
        x = self.box.x0 + self.stub
        self.columns: dict[str, list[float]] = {}
        for carrier in dict.fromkeys(m.carrier for m in train.meshes):
            of = [m for m in train.meshes if m.carrier == carrier]
            if carrier:
                self.arm(carrier, of, x)
                x += self.column
            first = x
            for m in of:
                self.central(m, x)
                self.planet(m, x)
                for name in (m.central, m.planet):
                    self.columns.setdefault(name, []).append(x)
                x += self.column
            for stage in dict.fromkeys(map(train.stage, of)) if carrier else ():
                last = first + of.index(stage[-1]) * self.column
                for side in self.sides(stage[0].planet):
                    height = self.y(side * train.distance(stage[0]))
                    c.line(complex(first - self.column, height), complex(last + self.face, height), "main")
        self.joined()

    def joined(self) -> None:
        """Shafts and sleeves of what turns together: on the main axis a shaft, planets on a carrier by a sleeve."""
        for shaft in (*self.train.data.shafts, *([m.planet] for m in self.train.meshes)):
            columns = [x for name in shaft for x in self.columns.get(name, ())]
            planets = [m.planet for m in self.train.meshes if m.carrier and m.planet in shaft]
            for edge in self.sides(planets[0]) if planets else (1,):
                height = self.y(edge * self.height(shaft[-1]))
                for side in (-1, 1) if planets else (0,):
                    if max(columns) > min(columns):
                        self.canvas.line(complex(min(columns), height + side * HUB), complex(max(columns), height + side * HUB),
                                         "main")
        for name, columns in self.columns.items():
            for m in self.train.meshes:
                if name == m.planet and len(columns) > 1:  # one wide wheel
                    for edge, side in product(self.sides(name), (-1, 1)):
                        rim = self.y(edge * self.height(name) + side * self.train.radius(name, m))
                        self.canvas.line(complex(columns[0], rim), complex(columns[-1], rim), "main")

    def on_shaft(self, name: str) -> bool:
        """True for a wheel that turns with another one or with a carrier."""
        return any(name in shaft for shaft in self.train.data.shafts)

    def planet(self, m: Mesh, x: float) -> None:
        """The planet of a mesh on its axis."""
        again = m.planet in self.columns
        diameter, up = 2 * self.train.radius(m.planet, m), self.height(m.planet)
        for side in self.sides(m.planet) if m.carrier else (1,):
            wheel = Edge("" if again or side < 0 else m.planet, diameter)
            self.wheel(wheel, x, side * up, label=1 if side * up >= 0 else -1, free=bool(m.carrier))
        if not m.carrier:
            self.canvas.line(complex(x - SLEEVE, self.y(up)), complex(x + SLEEVE, self.y(up)), "main")
            self.bearing(x - SLEEVE, self.y(up))

    def central(self, m: Mesh, x: float) -> None:
        """The wheel about the main axis with a sleeve or on its shaft, or held in the frame."""
        r, stands, free = self.train.radius(m.central, m), self.train.stands(m.central), not self.on_shaft(m.central)
        up = self.height(m.central)
        name = "" if m.central in self.columns else m.central  # in several meshes, as ring and as sun, it is named once
        if m.sign < 0:
            self.ring(name, r, x, stands, up)
            return
        self.wheel(Edge(name, 2 * r), x, up, label=-1 if self.height(m.planet) > up or m.carrier else 1, free=free)
        if stands:
            for side in (-1, 1):
                a, b = (complex(x + end * self.face / 2, self.y(up) + side * HUB) for end in (-1, 1))
                self.canvas.hatch(a, b, side, depth=2.0, step=2.0)

    def ring(self, name: str, r: float, x: float, stands: bool, up: float) -> None:
        """A ring: held in the frame where it meshes, or joined by a disc beside the planets to a sleeve about the main axis."""
        c, web = self.canvas, x + self.face + 3
        if stands:
            self.held(x, r, name)
            return
        for side in (1, -1):
            rim = complex(x, self.y(up + side * r))
            c.line(rim - self.face / 2, rim + self.face / 2, "main")
            hub = complex(web, self.y(up) + side * HUB)
            c.line(rim + self.face / 2, complex(web, rim.imag), "main")
            c.line(complex(web, rim.imag), hub, "main")
            c.line(hub - self.face / 2, hub + self.face / 2, "main")
        c.label(complex(x - self.face / 2, self.y(up - r)), name, away=-1 - 0.6j, height=5, gap=1.2)

    def arm(self, carrier: str, of: list[Mesh], x: float) -> None:
        """The carrier's arm from the main axis to the planets'."""
        self.columns[carrier] = [x]
        ends = [self.y(side * self.train.distance(m)) for m in of for side in self.sides(m.planet)]
        c, top, low = self.canvas, max(*ends, self.axis), min(*ends, self.axis)
        c.line(complex(x - self.stub, self.axis), complex(x, self.axis), "main")
        c.line(complex(x, low), complex(x, top), "main")
        self.bearing(x - self.stub / 2, self.axis)
        if self.train.stands(carrier):
            c.hatch(complex(x - self.stub, self.axis - 4), complex(x - self.stub, self.axis + 4), 1, depth=2.0, step=2.0)
        name = f"H_{carrier[1:]}" if len(carrier) > 1 else "H"
        c.label(complex(x, (self.axis + top) / 2), name, away=1, height=5, gap=1.2)

    def end_view(self) -> None:
        """Pitch circles of all wheels, the planets of a carrier at equal angles, as many as can be put in so."""
        c, o, mm, train = self.canvas, self.front, self.mu.mm, self.train
        reach = mm(self.side) + 4
        c.line(o - reach, o + reach, "centre")
        c.line(complex(o.real, self.y(-self.bottom) - 4), complex(o.real, self.y(self.top) + 4), "centre")
        c.dot(o, 1.2)
        named: list[tuple[complex, float, str]] = []
        for m in train.meshes:
            centre = o + 1j * mm(self.height(m.central))
            named.append((centre, mm(train.radius(m.central, m)), m.central))
            c.circle(centre, named[-1][1], "main" if train.stands(m.central) else "axis")
            up = mm(self.height(m.planet))
            for turn in self.turns(m):
                at = o + rect(up, pi / 2 + turn)
                if m.carrier:
                    c.line(o, at, "main")
                c.circle(at, mm(train.radius(m.planet, m)), "axis")
                c.dot(at, 1.0)
            named.append((at, mm(train.radius(m.planet, m)), m.planet))
        for k, (centre, radius, name) in enumerate({name: (centre, radius, name) for centre, radius, name in named}.values()):
            way = rect(1, pi / 2 - (0.55 + 0.35 * (k // 2)) if centre == o else -0.4 - 0.5 * (k // 2))
            c.label(centre + radius * way, name, away=way, height=3.5, gap=1.0)


points = Table(marked("Velocities of the points"), lambda project, canvas: rows_of_points(project.train, canvas), *POINTS)
"""Points of the picture of velocities: distance from the main axis, segment measured on the picture, velocity."""
links = Table(marked("Speeds of rotation by the plan"), lambda project, canvas: rows_of_links(project.train, canvas, "train"),
              LINKS)
"""Links on the plan of the speeds of rotation: segment measured on it, speed."""
mobility = Lines(marked("Mobility and speeds of the links"), lambda project, canvas: mobility_lines(project.train))
"""Degree of freedom by Chebyshev's formula, ratios to the driving link, angular velocities."""
