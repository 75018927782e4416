"""Speeds of a train of gears by the equations of Willis, and its picture of velocities, as steps of plans.

Diameters and distances in millimetres, speeds in 1/min.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given, GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Kind, Rule, Step
from tmm_sheets.methods.gears import reducer_speeds
from tmm_sheets.methods.gears.gear_formulas import MODULE
from tmm_sheets.methods.gears.reducer_formulas import BLOCK, INNER_RATIO, SAME_SHAFT, TEETH, said_with_sign
from tmm_sheets.methods.gears.reducer_speeds import SpeedPicture
from tmm_sheets.words import marked, tr

FRAME = ""
"""The carrier of a pair whose axes stand still."""

N: Kind = "number"
GIVEN_SPEED = Rule("given speed", lambda w: w * 30 / pi, (N,), N, marked("Given speed of rotation {name} = {value} "
                                                                         "rpm."), unit="1/min")
PAIR = Rule("speed behind a pair", lambda s, n, z1, z2: -s * n * z1 / z2, (N,) * 4, N,
            marked("Speed of rotation of the mating wheel: {name} = ∓{1} × {2}/{3} = {value} rpm."), unit="1/min")
CARRIER = Rule("speed of a carrier from its mesh", lambda s, nc, zc, np_, zp: (zc * nc + s * zp * np_) / (zc + s * zp), (N,) * 5, N,
               marked("Speed of rotation of the carrier by the Willis formula (z_cn_c ± z_pn_p)/(z_c ± z_p): {name} = ({2} × {1} "
                      "± {4} × {3})/({2} ± {4}) = {value} rpm."), unit="1/min")
DIFFERENTIAL = Rule("speed of a carrier between two central wheels", lambda one, two, i: (one - i * two) / (1 - i), (N,) * 3, N,
                    marked("Speed of rotation of the carrier by the Willis formula (n_1 − i·n_2)/(1 − i): {name} = ({0} − {2} × "
                           "{1})/(1 − {2}) = {value} rpm."), unit="1/min")
DISTANCE = Rule("distance of a stage's axes", lambda m, s, zc, zp: m * (zc + s * zp) / 2, (N,) * 4, N,
                marked("Distance of the axes m(z_c ± z_p)/2: {name} = {0} × ({2} ± {3})/2 = {value} mm."), unit="mm")
CENTRAL_PITCH = Rule("pitch diameter of a central wheel", lambda a, s, zc, zp: 2 * a * zc / (zc + s * zp), (N,) * 4, N,
                     marked("Pitch diameter at this distance 2az_c/(z_c ± z_p): {name} = 2 × {0} × {2}/({2} ± {3}) = {value} mm."),
                     unit="mm")


@primitive("equations of Willis together", "real")
def together(k: Any, structure: Any, *values: Any) -> Any:
    """Speed of link ``k`` from the equations of all meshes at once.

    ``structure``: number of links, number of known speeds, their links, then for each mesh its central wheel, planet, carrier (-1
    the
    frame) and sign; ``values``: tooth numbers of central wheel and planet of each mesh, then the known speeds.
    """
    links, known, *rest = (int(v) for v in structure)
    given, meshes = rest[:known], np.reshape(rest[known:], (-1, 4))
    rows = np.zeros((len(meshes) + known, links))
    for row, (c, p, h, s), (zc, zp) in zip(rows, meshes, np.reshape(values[:2 * len(meshes)], (-1, 2)), strict=False):
        for link, share in ((c, zc), (p, s * zp), (h, -(zc + s * zp))):
            if link >= 0:
                row[link] += share
    rows[np.arange(len(meshes), len(rows)), given] = 1.0
    right = np.concatenate((np.zeros(len(meshes)), values[2 * len(meshes):]))
    return float(np.linalg.lstsq(rows, right, rcond=None)[0][int(k)])


@dataclass(frozen=True)
class Mesh:
    """Two wheels in mesh: a central one and a planet on a carrier (FRAME for none), ``sign`` -1 where the central one is a ring."""

    central: str
    planet: str
    carrier: str
    sign: int


# --- speeds ---------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Found:
    """How a speed was found: from ``meshes``: one, two for a carrier between central wheels, none if given or by all together.

    ``shaft``: the wheel or carrier on the same shaft.
    """

    name: str
    meshes: tuple[Mesh, ...] = ()
    shaft: str = ""


def order(train: Any) -> Iterator[Found]:
    """Wheels and carriers in the order in which their speeds can be found."""
    known = set(train.given)
    yield from map(Found, train.given)
    while len(known) < len(train.names):
        found = _next(train, known)
        known.add(found.name)
        yield found


def _next(train: Any, known: set[str]) -> Found:
    for name in train.names:
        other = next((k for k in train.names if k in known and train.link(k) == train.link(name)), None)
        if name not in known and other is not None:
            return Found(name, shaft=other)
    for m in train.meshes:
        unknown = [name for name in (m.central, m.planet, m.carrier) if name and name not in known]
        if len(unknown) == 1:
            return Found(unknown[0], (m,))
    for one in train.meshes:
        for two in train.meshes:
            if (one is not two and one.carrier and one.carrier not in known and one.carrier == two.carrier
                    and train.link(one.planet) == train.link(two.planet) and {one.central, two.central} <= known):
                return Found(one.carrier, (one, two))
    return Found(next(name for name in train.names if name not in known))


def is_wheel(name: str) -> bool:
    """Wheels have numbers, with primes where several are one block (2, 2′); carriers have letters."""
    return name[0].isdigit()


def distance_of(train: Any, mesh: Mesh) -> str:
    """Name of the step with the distance of a mesh: one for all whose planets turn together, else one for each pair."""
    first = train.stage(mesh)[0]
    alone = mesh.carrier and all(train.stage(m)[0] is first for m in train.meshes if m.carrier == mesh.carrier)
    return f"a_{mesh.carrier}" if alone else f"a_{first.central}-{first.planet}"


class Kinematics:
    """Records the plan of a train's numbers."""

    def __init__(self, train: Any) -> None:
        self.train = train
        self.plan = Plan("train-kinematics", tr("Diameters of the wheels and speeds of rotation of the links"), "mm")
        for name in train.names:
            if is_wheel(name):
                self.plan.add(f"z{name}", TEETH, Given(train.data.teeth[name], f"train.teeth.{name}", over="none"),
                              symbol=f"z_{{{name}}}")
        self.diameters()
        for found in order(train):
            self.speed(found)

    def teeth(self, mesh: Mesh) -> tuple[Step, Step]:
        """Tooth numbers of central wheel and planet."""
        return self.plan[f"z{mesh.central}"], self.plan[f"z{mesh.planet}"]

    def diameters(self) -> None:
        """Distances of the axes and pitch diameters of the central wheels."""
        module = self.plan.add("m", MODULE, GivenNumber(self.train.data.module, "train.module", "m", "m"))
        for m in self.train.meshes:
            name = distance_of(self.train, m)
            if name not in self.plan:
                self.plan.add(name, DISTANCE, module, float(m.sign), *self.teeth(m), say=said_with_sign(DISTANCE, m.sign),
                              symbol=f"a_{{{name.removeprefix('a_')}}}")
            self.plan.add(f"d{m.central}-{m.planet}", CENTRAL_PITCH, self.plan[name], float(m.sign), *self.teeth(m),
                          say=said_with_sign(CENTRAL_PITCH, m.sign), symbol=f"d_{{{m.central}}}")

    def speed(self, found: Found) -> None:
        """Speed of a wheel or carrier as it is found."""
        name, plan = found.name, self.plan
        rule: Rule = SAME_SHAFT
        args: tuple[Any, ...] = (plan[f"n{found.shaft}"],) if found.shaft else ()
        say: str | None = None
        if name in self.train.data.speeds:
            given = GivenNumber(self.train.data.speeds[name], f"train.speeds.{name}", "ω", "rad/s")
            rule, args = GIVEN_SPEED, (given,)
        elif len(found.meshes) == 2:
            rule, args = DIFFERENTIAL, self.differential(*found.meshes)
        elif found.meshes:
            rule, args, say = self.willis(name, found.meshes[0])
        elif not found.shaft:
            rule, args = TOGETHER, self.all(name)
        plan.add(f"n{name}", rule, *args, symbol=f"n_{{{name}}}", say=say)

    def willis(self, name: str, m: Mesh) -> tuple[Rule, tuple[Any, ...], str]:
        """Rule, arguments and sentence for the one unknown of a mesh."""
        plan, (zc, zp) = self.plan, self.teeth(m)
        if name == m.carrier:
            return CARRIER, (float(m.sign), plan[f"n{m.central}"], zc, plan[f"n{m.planet}"], zp), said_with_sign(CARRIER, m.sign)
        other, z = (m.planet, (zp, zc)) if name == m.central else (m.central, (zc, zp))
        if m.carrier:
            return BLOCK, (plan[f"n{m.carrier}"], float(m.sign), plan[f"n{other}"], *z), tr(
                "Speed of rotation by the Willis formula n_H ∓ (n_1 − n_H)z_1/z_2: {name} = {0} ∓ ({2} − {0}) × {3}/{4} = {value} "
                "rpm."
                ).replace("∓", "−" if m.sign > 0 else "+")
        return PAIR, (float(m.sign), plan[f"n{other}"], *z), said_with_sign(PAIR, m.sign)

    def differential(self, one: Mesh, two: Mesh) -> tuple[Any, ...]:
        """What the speed of a carrier between two central wheels follows from."""
        (z1, p1), (z2, p2), sign = self.teeth(one), self.teeth(two), one.sign * two.sign
        name = f"i{one.central},{two.central}"
        ratio = self.plan.add(name, INNER_RATIO, float(sign), z1, p1, p2, z2, say=said_with_sign(INNER_RATIO, sign),
                              symbol=f"i_{{{one.central},{two.central}}}^{{{one.carrier}}}")
        return self.plan[f"n{one.central}"], self.plan[f"n{two.central}"], ratio

    def all(self, name: str) -> tuple[Any, ...]:
        """What the speed of a link follows from by the equations of all meshes."""
        train, links = self.train, self.train.equations[0]
        place = {name: links.index(train.link(name)) for name in train.names} | {FRAME: -1}
        known = train.given
        row = [len(links), len(known), *(place[k] for k in known)]
        for m in train.meshes:
            row += [place[m.central], place[m.planet], place[m.carrier], m.sign]
        structure = Given(np.array(row, dtype=float), "train.mesh", over="curve")
        return (float(place[name]), structure, *(z for m in train.meshes for z in self.teeth(m)),
                *(self.plan[f"n{k}"] for k in known))


LAID_BESIDE = Rule(
    "velocity of another point of a link", lambda end, n, p, q: end + (1j + n * pi / 30) * np.imag(q - p),
    ("point", "number", "point", "point"), "point",
    marked("At the height of {3} lay off from {0} the difference of the velocities πn/30·{2}{3} at {1} rpm: end {name}."))
FROM_AXIS = Rule("axis at a distance from another", lambda o, side, a: o + side * 1j * (a / 1e3), ("point", "number", "number"),
                 "point", marked("At the distance {2} mm from {0} mark the axis {name}."), unit="m")
ON_PITCH_CIRCLE = Rule("point on a pitch circle about an axis", lambda o, side, d: o + side * 1j * (d / 2e3),
                       ("point", "number", "number"), "point",
                       marked("At the pitch radius {2}/2 mm from {0} mark point {name}."), unit="m")
TOGETHER = Rule("speed by all equations of Willis", together, (N, N), N,
                marked("The train is closed; the Willis equations of all its meshes together give {name} = {value} "
                       "rpm."), unit="1/min")


# --- picture of velocities ------------------------------------------------------------------------------------------------


class TrainSpeedPicture(SpeedPicture):
    """Adds the links in the order in which their speeds are found; each line goes through two velocities that are there."""

    def __init__(self, train: Any) -> None:
        super().__init__("train")
        self.train = train
        self.axes = train.axes
        self.points: dict[tuple[str, str, str], Step] = {}
        self.ends: dict[str, Step] = {}
        waiting = list(order(train))
        while waiting:
            ready = next(found for found in waiting if self.can(found))
            waiting.remove(ready)
            self.add(ready)

    def centre(self, link: str) -> Step:
        """Point of the axis a link turns about."""
        axis = self.axes[self.train.link(link)]
        if axis.mesh is None:
            return self.axis
        name = f"O{self.train.link(link)}"
        if name not in self.plan:
            side, distance = 1.0 if axis.height > 0 else -1.0, self.train.kinematics[distance_of(self.train, axis.mesh)]
            if (base := self.centre(axis.base)) is self.axis:
                self.plan.add(name, reducer_speeds.AT_DISTANCE, side, distance)
            else:
                self.plan.add(name, FROM_AXIS, base, side, distance)
        return self.plan[name]

    def contact(self, m: Mesh) -> Step:
        """Pitch point of a mesh, over the main axis."""
        key = (m.central, m.planet, "contact")
        if key not in self.points:
            diameter, centre = self.train.kinematics[f"d{m.central}-{m.planet}"], self.centre(m.central)
            side = 1 if m.carrier or self.train.height(m.planet) > self.train.height(m.central) else -1
            self.points[key] = self.point(reducer_speeds.AT_RADIUS, diameter, side) if centre is self.axis else self.plan.add(
                next(self.letters), ON_PITCH_CIRCLE, centre, side, diameter)
        return self.points[key]

    def planet_axis(self, m: Mesh) -> Step:
        """Point of the planet's axis, over the main one."""
        key = (distance_of(self.train, m), "", "axis")
        if key not in self.points:
            self.points[key] = self.point(reducer_speeds.AT_DISTANCE, self.train.kinematics[distance_of(self.train, m)])
        return self.points[key]

    def velocity_of(self, point: Step, link: str) -> Step:
        """End of the velocity of a point of a link whose line is there."""
        if point.name.lower() in self.plan:
            return self.plan[point.name.lower()]
        line = self.plan[self.train.link(link)]
        return self.velocity(point, line.args[0], line)

    def mesh_of(self, name: str) -> Mesh:
        """A mesh that a wheel or carrier takes part in, one where it is no planet if there is one."""
        of = [m for m in self.train.meshes if self.train.link(name) in (self.train.link(m.central), m.carrier and self.train.link(
            m.carrier), self.train.link(m.planet))]
        found: Mesh = min(of, key=lambda m: self.train.link(m.planet) == self.train.link(name))
        return found

    def is_planet(self, found: Found) -> bool:
        """True for a planet on a carrier whose speed is no result of its mesh: its line needs a velocity of another link first."""
        mesh = self.mesh_of(found.name)
        return not found.meshes and bool(mesh.carrier) and self.train.link(mesh.planet) == self.train.link(found.name)

    def beside(self, mesh: Mesh) -> tuple[Step, str, Step] | None:
        """A point of a planet with the link whose line has its velocity, and another point of it; None while there is no line."""
        for link, here, there in ((mesh.central, self.contact, self.planet_axis), (mesh.carrier, self.planet_axis, self.contact)):
            if self.train.link(link) in self.plan:
                return here(mesh), link, there(mesh)
        return None

    def can(self, found: Found) -> bool:
        """True when the velocities that a line needs are there."""
        if self.train.link(found.name) in self.plan or not self.is_planet(found):
            return all(self.train.link(name) in self.plan for m in found.meshes for name in (m.central, m.planet, m.carrier)
                       if name and name != found.name and not (len(found.meshes) == 2 and name == m.planet))
        return self.beside(self.mesh_of(found.name)) is not None

    def add(self, found: Found) -> None:
        """Line of a link, through two velocities that are there."""
        link = self.train.link(found.name)
        if link in self.plan:
            return
        mesh = found.meshes[0] if found.meshes else self.mesh_of(found.name)
        if len(found.meshes) == 2:  # a planet's line through both pitch points carries its axis
            one, two = (self.velocity_of(self.contact(m), m.central) for m in found.meshes)
            planet = self.train.link(mesh.planet)
            if planet not in self.plan:
                self.line(planet, one, two)
            self.line(link, self.axis, self.velocity_of(self.planet_axis(mesh), planet))
        elif not found.meshes:
            self.laid_off(link, found.name, mesh)
        elif found.name == mesh.carrier:
            self.line(link, self.axis, self.velocity_of(self.planet_axis(mesh), mesh.planet))
        elif found.name == mesh.planet:
            end = self.velocity_of(self.contact(mesh), mesh.central)
            start = self.velocity_of(self.planet_axis(mesh), mesh.carrier) if mesh.carrier else self.centre(found.name)
            self.line(link, start, end)
        else:
            self.line(link, self.centre(found.name), self.velocity_of(self.contact(mesh), mesh.planet))

    def laid_off(self, link: str, name: str, mesh: Mesh) -> None:
        """Line of a link whose speed is known: through its axis, or of a planet on a carrier through a velocity of its own."""
        n = self.train.kinematics[f"n{name}"]
        beside = self.beside(mesh) if mesh.carrier and self.train.link(mesh.planet) == link else None
        if beside is not None:
            here, other, there = beside
            end = self.velocity_of(here, other)
            self.line(link, end, self.plan.add(f"{there.name.lower()}′", LAID_BESIDE, end, n, here, there))
            return
        point = self.planet_axis(mesh) if self.train.link(mesh.carrier or "-") == link else self.contact(mesh)
        centre = self.centre(name)
        self.line(link, centre, point if float(n.value) == 0 else self.laid(point, n, centre))
