"""Steps of a gear train: distances, diameters, speeds by Willis' formula; pictures of velocities and speeds (manual 003, 4)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import chain, count
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.rules import GIVEN, RAY
from tmm_sheets.construction.step import Given, GivenNumber, Helper, Kind, Plan, Rule, Step
from tmm_sheets.methods.gears import planetary
from tmm_sheets.methods.gears.gear_formulas import MODULE
from tmm_sheets.words import marked, tr

FRAME = ""
"""The carrier of a pair whose axes stand still."""

N: Kind = "number"
BY_WILLIS = marked("Speed of rotation by the Willis formula: {formula}.")
TEETH = Rule("number of teeth", lambda z: z, (N,), N, marked("Number of teeth {name} = {value}."), source="003, 2.1–2.4")
INNER_RATIO = Rule(
    "ratio with the carrier stopped", lambda s, z1, z2, z3, z4: planetary.inner_ratio((s, 1), (z1, z2, z3, z4)), (N,) * 5, N, "",
    source="003, 2.1–2.4")
STANDS = Rule("a wheel that stands still", lambda: 0.0, (), N, marked("The wheel stands still: {name} = 0."), unit="1/min")
SAME_SHAFT = Rule("speed on the same shaft", lambda n: n, (N,), N, marked("On the same shaft: {name} = {value} rpm."), unit="1/min")
BLOCK = Rule("speed of the satellites", lambda h, s, n, z1, z2: h - s * (n - h) * z1 / z2, (N,) * 5, N,
             BY_WILLIS, unit="1/min")
GIVEN_SPEED = Rule("given speed", lambda w: w * 30 / pi, (N,), N, marked("Given speed of rotation {name} = {value} "
                                                                         "rpm."), unit="1/min")
PAIR = Rule("speed behind a pair", lambda s, n, z1, z2: -s * n * z1 / z2, (N,) * 4, N,
            marked("Speed of rotation of the mating wheel: {formula}."), unit="1/min")
CARRIER = Rule("speed of a carrier from its mesh", lambda s, nc, zc, np_, zp: (zc * nc + s * zp * np_) / (zc + s * zp), (N,) * 5, N,
               BY_WILLIS, unit="1/min")
DIFFERENTIAL = Rule("speed of a carrier between two central wheels", lambda one, two, i: (one - i * two) / (1 - i), (N,) * 3, N,
                    BY_WILLIS, unit="1/min")
ACROSS = Rule("speed of a central wheel across its carrier", lambda h, two, i: h * (1 - i) + i * two, (N,) * 3, N,
              BY_WILLIS, unit="1/min")
DIAMETER = Rule("pitch diameter", lambda z, m: m * z, (N, N), N,
                marked("Pitch diameter (there are no shifts): {formula}."), unit="mm")
DISTANCE = Rule("distance of a stage's axes", lambda m, s, zc, zp: m * (zc + s * zp) / 2, (N,) * 4, N,
                marked("Distance of the axes: {formula}."), unit="mm")
WORKING_PITCH = Rule("working pitch diameter", lambda a, z, s, zc, zp: 2 * a * z / (zc + s * zp), (N,) * 5, N,
                     marked("Pitch diameter at this distance: {formula}."), unit="mm")


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
    """Two wheels in mesh: a central one and a planet on a carrier (FRAME for none), ``sign`` -1 where the central one is a ring.

    ``module``: its own, m, where it is not that of the train.
    """

    central: str
    planet: str
    carrier: str
    sign: int
    module: GivenNumber | None = None


@dataclass(frozen=True)
class TrainData:
    """What a train is made of.

    ``part`` begins the names of its plans. ``speeds``: rad/s, None for what stands without being said. ``addendum``, ``clearance``:
    coefficients of the basic rack, unless given those of GOST 13755. ``known``: tooth numbers ``z1`` .. and ratios of stages
    ``i1,4`` .. that are steps of other plans.
    """

    part: str
    meshes: tuple[Mesh, ...]
    teeth: dict[str, int]
    module: float
    speeds: Mapping[str, GivenNumber | None]
    shafts: tuple[tuple[str, ...], ...]
    satellites: int
    addendum: float = 1.0
    clearance: float = 0.25
    known: Mapping[str, Step] = field(default_factory=dict)


# --- speeds ---------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Found:
    """How a speed was found: from ``meshes``: one, two of a carrier and two central wheels, none if given or by all together.

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
    for one in train.meshes:
        for two in train.meshes:
            unknown = [name for name in (one.central, one.carrier, two.central) if name not in known]
            if (one is not two and one.carrier and one.carrier == two.carrier and train.link(one.planet) == train.link(two.planet)
                    and not {one.planet, two.planet} & known and len(unknown) == 1 and unknown != [two.central]):
                return Found(unknown[0], (one, two))
    for m in train.meshes:
        unknown = [name for name in (m.central, m.planet, m.carrier) if name and name not in known]
        if len(unknown) == 1:
            return Found(unknown[0], (m,))
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
        self.train, self.data = train, train.data
        self.plan = Plan(f"{self.data.part}-kinematics", tr("Diameters of the wheels and speeds of rotation of the links"), "mm")
        for name in train.wheels:
            if f"z{name}" not in self.data.known:
                self.plan.add(f"z{name}", TEETH, Given(self.data.teeth[name], f"{self.data.part}.teeth.{name}", over="none"),
                              symbol=f"z_{{{name}}}")
        self.diameters()
        for found in order(train):
            rule, args = self.speed(found)
            self.plan.add(f"n{found.name}", rule, *args, symbol=f"n_{{{found.name}}}")

    def teeth(self, mesh: Mesh) -> tuple[Step, Step]:
        """Tooth numbers of central wheel and planet."""
        one, two = (self.data.known.get(f"z{name}") or self.plan[f"z{name}"] for name in (mesh.central, mesh.planet))
        return one, two

    def diameters(self) -> None:
        """Distances of the axes and pitch diameters: of both wheels, or with shifts of both in the mesh."""
        plan = self.plan
        plan.add("m", MODULE, GivenNumber(self.data.module, f"{self.data.part}.module", "m", "m"))
        for m in self.train.meshes:
            module = plan["m"] if m.module is None else plan.add_once("m_simple", MODULE, m.module, symbol=tr("m_{s}"))
            name = distance_of(self.train, m)
            if name not in plan:
                plan.add(name, DISTANCE, module, float(m.sign), *self.teeth(m),
                         symbol=f"a_{{{name.removeprefix('a_')}}}")
            shifted = self.train.teeth(m) != self.train.teeth(self.train.stage(m)[0])
            for wheel, mate, z in zip((m.central, m.planet), (m.planet, m.central), self.teeth(m), strict=True):
                if shifted:  # it rolls on another circle in each of its meshes
                    plan.add(f"d{wheel}-{mate}", WORKING_PITCH, plan[name], z, float(m.sign), *self.teeth(m),
                             symbol=f"d_{{w{wheel}–{mate}}}")
                else:
                    plan.add_once(f"d{wheel}", DIAMETER, z, module, symbol=f"d_{{{wheel}}}")

    def speed(self, found: Found) -> tuple[Rule, tuple[Any, ...]]:
        """Rule and arguments for the speed of a wheel or carrier as it is found."""
        name = found.name
        if name in self.data.speeds:
            given = self.data.speeds[name]
            return (STANDS, ()) if given is None else (GIVEN_SPEED, (given,))
        if found.shaft:
            return SAME_SHAFT, (self.plan[f"n{found.shaft}"],)
        if len(found.meshes) == 2:
            return self.across(name, *found.meshes)
        return self.willis(name, found.meshes[0]) if found.meshes else (TOGETHER, self.all(name))

    def willis(self, name: str, m: Mesh) -> tuple[Rule, tuple[Any, ...]]:
        """Rule and arguments for the one unknown of a mesh."""
        plan, (zc, zp) = self.plan, self.teeth(m)
        if name == m.carrier:
            return CARRIER, (float(m.sign), plan[f"n{m.central}"], zc, plan[f"n{m.planet}"], zp)
        other, z = (m.planet, (zp, zc)) if name == m.central else (m.central, (zc, zp))
        rule, args = (BLOCK, (plan[f"n{m.carrier}"],)) if m.carrier else (PAIR, ())
        return rule, (*args, float(m.sign), plan[f"n{other}"], *z)

    def across(self, name: str, one: Mesh, two: Mesh) -> tuple[Rule, tuple[Any, ...]]:
        """Rule and arguments for a carrier between two central wheels, or for the first of these."""
        (z1, p1), (z2, p2), sign = self.teeth(one), self.teeth(two), one.sign * two.sign
        ratio = self.data.known.get(key := f"i{one.central},{two.central}") or self.plan.add(
            key, INNER_RATIO, float(sign), z1, p1, p2, z2,
            symbol=f"i_{{{one.central},{two.central}}}^{{{one.carrier}}}")
        rule, other = (DIFFERENTIAL, one.central) if name == one.carrier else (ACROSS, one.carrier)
        return rule, (self.plan[f"n{other}"], self.plan[f"n{two.central}"], ratio)

    def all(self, name: str) -> tuple[Any, ...]:
        """What the speed of a link follows from by the equations of all meshes."""
        train, links = self.train, self.train.equations[0]
        place = {name: links.index(train.link(name)) for name in train.names} | {FRAME: -1}
        known = train.given
        meshes = (x for m in train.meshes for x in (place[m.central], place[m.planet], place[m.carrier], m.sign))
        row = [len(links), len(known), *(place[k] for k in known), *meshes]
        structure = Given(np.array(row, dtype=float), f"{self.data.part}.mesh", over="curve")
        return (float(place[name]), structure, *(z for m in train.meshes for z in self.teeth(m)),
                *(self.plan[f"n{k}"] for k in known))


TOGETHER = Rule("speed by all equations of Willis", together, (N, N), N,
                marked("The train is closed; the Willis equations of all its meshes together give {name} = {value} "
                       "rpm."), unit="1/min")


LETTERS = "ABCDEFGKLMNQRST"
"""Names of the points in the order of the power; O is the main axis, P the pole."""


VELOCITY_OF = Rule("velocity of a turning point", lambda n, p, o: n * pi / 30 * (np.imag(p) - np.imag(o)),
                   ("number", "point", "point"), "vector",
                   marked("Velocity of point {1} of the link that turns about {2} at {0} rpm, V = πn/30·{1}{2}: {name} = {value}."),
                   source="003, 4")
LAY_VELOCITY = Rule(
    "lay off a velocity", lambda p, v: p + v, ("point", "vector"), "point",
    marked("From {0} lay off its velocity {1}: end {name}."), lambda a, v: (Helper("line", a[0], v),), laid_off=True,
)
VELOCITY = Rule(
    "velocity from a link's line", lambda p, q, u: ar.line_line(p, 1 + 0j, q, u), ("point", "point", "direction"), "point",
    marked("The horizontal through {0} meets the line of link {2} at point {name}: the segment {0}{name} is the velocity of {0}."),
    lambda a, v: (Helper("line", a[0], v),),
)
PARALLEL = Rule(
    "ray parallel to a link's line", lambda pole, u, origin: ar.line_line(pole, u, origin, 1 + 0j),
    ("point", "direction", "point"), "point",
    marked("Through the pole {0}, parallel to the line of link {1}, draw a ray to the axis of the speeds of rotation: point "
           "{name}."),
    lambda a, v: (Helper("line", a[0], v),),
)
READ = Rule("measure a speed of rotation",
            lambda at, origin, pole: np.real(at - origin) / np.imag(origin - pole) * 30 / pi, ("point", "point", "point"), "number",
            marked("The segment {1}{0} gives the speed of rotation {name} = {value} rpm."), unit="1/min", source="003, 4")
LAID_BESIDE = Rule(
    "velocity of another point of a link", lambda end, n, p, q: end + (1j + n * pi / 30) * np.imag(q - p),
    ("point", "number", "point", "point"), "point",
    marked("At the height of {3} lay off from {0} the difference of the velocities πn/30·{2}{3} at {1} rpm: end {name}."))
FROM_AXIS = Rule("axis at a distance from another", lambda o, side, a: o + side * 1j * (a / 1e3), ("point", "number", "number"),
                 "point", marked("At the distance {2} mm from {0} mark the axis {name}."), unit="m")
ON_PITCH_CIRCLE = Rule("point on a pitch circle about an axis", lambda o, side, d: o + side * 1j * (d / 2e3),
                       ("point", "number", "number"), "point",
                       marked("At the pitch radius {2}/2 mm from {0} mark point {name}."), unit="m")


class SpeedPicture:
    """Adds the links in the order in which their speeds are found; each line goes through two velocities that are there.

    A link that stands has no line: the velocities of its points are the points themselves.
    """

    def __init__(self, train: Any) -> None:
        self.train, self.axes = train, train.axes
        self.plan = Plan(f"{train.data.part}-velocities", tr("Picture of velocities"), "m/s")
        self.axis = self.plan.add("O", GIVEN, 0j)
        self.letters = chain(LETTERS, (f"{letter}{n}" for n in count(1) for letter in LETTERS))
        self.points: dict[tuple[str, str], Step] = {}
        waiting = list(order(train))
        while waiting:
            ready = next(found for found in waiting if self.can(found))
            waiting.remove(ready)
            self.add(ready)

    def line(self, link: str, a: Step, b: Step) -> None:
        """Line of a link's velocities through two of them."""
        self.plan.add(link, RAY, a, b, say=tr("Line of the velocities of link {link}: the line {{0}}{{1}}.").format(link=link))

    def centre(self, link: str) -> Step:
        """Point of the axis a link turns about."""
        axis = self.axes[self.train.link(link)]
        if axis.mesh is None:
            return self.axis
        name = f"O{self.train.link(link)}"
        if name not in self.plan:
            side, distance = 1.0 if axis.height > 0 else -1.0, self.train.kinematics[distance_of(self.train, axis.mesh)]
            self.plan.add(name, FROM_AXIS, self.centre(axis.base), side, distance)
        return self.plan[name]

    def contact(self, m: Mesh) -> Step:
        """Pitch point of a mesh; that of a planet on a carrier over the main axis."""
        if (key := (m.central, m.planet)) not in self.points:
            side = 1 if m.carrier or self.train.height(m.planet) > self.train.height(m.central) else -1
            self.points[key] = self.plan.add(next(self.letters), ON_PITCH_CIRCLE, self.centre(m.central), side, self.train.pitch(m))
        return self.points[key]

    def planet_axis(self, m: Mesh) -> Step:
        """Point of the planet's axis, over the main one."""
        if (key := (distance_of(self.train, m), "")) not in self.points:
            self.points[key] = self.plan.add(next(self.letters), FROM_AXIS, self.axis, 1, self.train.kinematics[key[0]])
        return self.points[key]

    def velocity_of(self, point: Step, link: str) -> Step:
        """End of the velocity of a point of a link that stands or whose line is there."""
        if self.train.stands(link):
            return point
        if point.name.lower() in self.plan:
            return self.plan[point.name.lower()]
        line = self.plan[self.train.link(link)]
        return self.plan.add(point.name.lower(), VELOCITY, point, line.args[0], line)

    def mesh_of(self, name: str) -> Mesh:
        """A mesh that a wheel or carrier takes part in, one where it is no planet if there is one."""
        link = self.train.link
        of = [m for m in self.train.meshes if link(name) in (link(m.central), m.carrier and link(m.carrier), link(m.planet))]
        found: Mesh = min(of, key=lambda m: link(m.planet) == link(name))
        return found

    def known(self, link: str) -> bool:
        """True for a link that stands or whose line is there."""
        return self.train.link(link) in self.plan or self.train.stands(link)

    def beside(self, mesh: Mesh) -> tuple[Step, str, Step] | None:
        """A point of a planet with the link whose line has its velocity, and another point of it; None while there is no line."""
        for link, here, there in ((mesh.central, self.contact, self.planet_axis), (mesh.carrier, self.planet_axis, self.contact)):
            if self.known(link):
                return here(mesh), link, there(mesh)
        return None

    def can(self, found: Found) -> bool:
        """True when the velocities that a line needs are there."""
        mesh = self.mesh_of(found.name)
        # The line of a planet on a carrier whose speed is no result of its mesh needs a velocity of another link first.
        planet = not found.meshes and mesh.carrier and self.train.link(mesh.planet) == self.train.link(found.name)
        if self.known(found.name) or not planet:
            return all(self.known(name) for m in found.meshes for name in (m.central, m.planet, m.carrier)
                       if name and name != found.name and not (len(found.meshes) == 2 and name == m.planet))
        return self.beside(mesh) is not None

    def add(self, found: Found) -> None:
        """Line of a link, through two velocities that are there."""
        link = self.train.link(found.name)
        if self.known(found.name):
            return
        if not found.meshes:
            self.laid_off(link, found.name, self.mesh_of(found.name))
            return
        mesh = found.meshes[0]
        if len(found.meshes) == 2 and (planet := self.train.link(mesh.planet)) not in self.plan:
            points = [(self.contact(m), m.central) for m in found.meshes if m.central != found.name]
            if found.name != mesh.carrier:
                points.insert(0, (self.planet_axis(mesh), mesh.carrier))
            ends = [self.velocity_of(*point) for point in points]
            if self.train.stands(found.meshes[1].central):
                ends.reverse()  # from the centre of the velocities
            self.line(planet, *ends)
        if found.name == mesh.carrier:
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
        velocity = self.plan.add(f"V{point.name}", VELOCITY_OF, n, point, centre, symbol=f"V_{point.name}")
        self.line(link, centre, self.plan.add(point.name.lower(), LAY_VELOCITY, point, velocity))


def speeds_plan(velocities: Plan, distance: float, part: str) -> Plan:
    """Plan of the speeds of rotation, pole ``distance`` m under the line on which they are read.

    For each line of the picture the end of its ray, named like the link, and the speed ``n<link>`` in 1/min.
    """
    plan = Plan(f"{part}-speeds", tr("Plan of the speeds of rotation"), "m/s")
    given = Given(-1j * distance, f"{part}.speeds.pole", "H", "m", over="none",
                  choice=tr("with it the scale factor μ_n is handy for counting"))
    pole = plan.add("P", GIVEN, given, say=tr("Mark the pole {name}."))
    origin = plan.add("0", GIVEN, 0j, say=tr("Above the pole mark the origin {name} on the axis of the speeds of rotation."))
    for line in (step for step in velocities if step.rule is RAY):
        plan.add(f"n{line.name}", READ, plan.add(line.name, PARALLEL, pole, line, origin), origin, pole)
    return plan
