"""A train of gears with speeds given at any of its links: simple pairs, planetary stages, two moving inputs, Ferguson's paradox.

Every mesh gives an equation of Willis, z_c(n_c - n_H) ± z_p(n_p - n_H) = 0 with + for an external one; H is the frame for a pair
whose
axes stand still. One unknown at a time is found from them, graphically in the picture of velocities and by formulas. Tooth numbers
are given; where the reference distances of a stage differ, its pitch points are the working ones of one common distance, for which
shifts are needed. Diameters in millimetres, speeds in 1/min.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given, GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Kind, Rule, Step, Told
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears import reducer_speeds
from tmm_sheets.methods.gears.gear_formulas import MODULE
from tmm_sheets.methods.gears.reducer_formulas import BLOCK, INNER_RATIO, SAME_SHAFT, TEETH, said_with_sign
from tmm_sheets.methods.gears.reducer_speeds import SpeedPicture
from tmm_sheets.numbers import number
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.task.schema import TrainTable

FRAME = ""
"""The carrier of a pair whose axes stand still."""
FARTHEST = 2.0
"""Teeth by which the sums of tooth numbers of one stage may differ: so much can shifts bridge."""

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


@primitive("equations of Willis together")
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


class Train:
    """A train of gears: its meshes, the speeds of all links, the picture of velocities.

    Plans: ``train-kinematics``, ``train-velocities``, ``train-speeds``.
    """

    def __init__(self, data: TrainTable) -> None:
        self.data = data
        self.meshes = tuple(Mesh(m.sun or m.ring or "", m.planet, m.carrier or FRAME, 1 if m.sun else -1) for m in data.mesh)
        self.shafts = {name: shaft[0] for shaft in data.shafts for name in shaft}
        _check_speeds(self)
        _check_distances(self)
        self.axes = dict(heights(self))
        """Heights of the axes of all links over the main one, m."""

    def link(self, name: str) -> str:
        """The link a wheel or carrier belongs to, by its first name."""
        return self.shafts.get(name, name)

    @property
    def names(self) -> tuple[str, ...]:
        """All wheels by number, then the carriers."""
        found = dict.fromkeys(name for m in self.meshes for name in (m.central, m.planet, m.carrier) if name)
        return tuple(sorted(found, key=lambda name: (not name.isdigit(), int(name) if name.isdigit() else 0, name)))

    @cached_property
    def kinematics(self) -> Plan:
        """Tooth numbers, distances, pitch diameters and the speeds ``n1`` .. of all wheels and carriers."""
        return _Kinematics(self).plan

    @cached_property
    def velocities(self) -> Plan:
        """Picture of velocities: points ``A`` .. with their velocities ``a`` .., and a line named after each link."""
        return _Picture(self).plan

    def speeds(self, distance: float) -> Plan:
        """Plan of the speeds of rotation with its pole ``distance`` m over the line on which they are read."""
        if distance not in self._speed_plans:
            self._speed_plans[distance] = reducer_speeds.speeds(self.velocities, distance, "train")
        return self._speed_plans[distance]

    @cached_property
    def _speed_plans(self) -> dict[float, Plan]:
        return {}

    @property
    def plans(self) -> dict[str, Plan]:
        """Plans by name in the order of construction; that of the speeds as far as it was drawn."""
        return {plan.name: plan for plan in (self.kinematics, self.velocities, *self._speed_plans.values())}

    @property
    def links(self) -> dict[str, Step]:
        """Speed of every turning link, 1/min, by its first name."""
        return {name: self.kinematics[f"n{name}"] for name in self.names if self.link(name) == name}

    @property
    def given(self) -> tuple[str, ...]:
        """Wheels and carriers whose speeds are given."""
        return tuple(self.data.speeds)

    def stands(self, name: str) -> bool:
        """True for what is held in the frame."""
        return float(self.kinematics[f"n{name}"].value) == 0 and self.link(name) in map(self.link, self.given)

    def radius(self, name: str, mesh: Mesh) -> float:
        """Pitch radius of a wheel in a mesh, m."""
        central = float(self.kinematics[f"d{mesh.central}-{mesh.planet}"].value) / 2e3
        return central if name == mesh.central else abs(self.distance(mesh) - central)

    def distance(self, mesh: Mesh) -> float:
        """Distance of the axes of a mesh, m."""
        return float(self.kinematics[distance_of(self, mesh)].value) / 1e3

    def height(self, name: str) -> float:
        """Height of the axis of a wheel or carrier over the main one, m; of a planet on a carrier that of one over it."""
        on = next((m for m in self.meshes if m.carrier and self.link(m.planet) == self.link(name)), None)
        return self.distance(on) if on else self.axes[self.link(name)]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Remarks for the sheet."""
        out = []
        for carrier, sums in _sums(self).items():
            if carrier and len(set(sums)) > 1:
                out.append(tr("the stage with the carrier {carrier} needs shifts: its distances differ by {teeth} m").format(
                    carrier=carrier, teeth=number((max(sums) - min(sums)) / 2)))
        return tuple(out)

    def results(self) -> dict[str, Any]:
        """The ``train`` section of ``solve --json``: speeds in 1/min, distances in millimetres."""
        plan = self.kinematics
        return {"teeth": {name: Told(plan[f"z{name}"]) for name in self.names if name.isdigit()},
                "distances": {step.name: Told(step) for step in plan if step.rule is DISTANCE},
                "speeds_rpm": {f"n{name}": Told(plan[f"n{name}"]) for name in self.names}}


# --- what can be solved ---------------------------------------------------------------------------------------------------


def _equations(train: Train) -> tuple[list[str], npt.NDArray[np.float64]]:
    """Links, and the equations of Willis, one row for each mesh."""
    links = list(dict.fromkeys(map(train.link, train.names)))
    rows = np.zeros((len(train.meshes), len(links)))
    for row, m in zip(rows, train.meshes, strict=True):
        zc, zp = (train.data.teeth[name] for name in (m.central, m.planet))
        for name, share in ((m.central, zc), (m.planet, m.sign * zp), (m.carrier, -(zc + m.sign * zp))):
            if name:
                row[links.index(train.link(name))] += share
    return links, rows


def _check_speeds(train: Train) -> None:
    """As many speeds must be given as the train has degrees of freedom, and of links that tell the others."""
    links, rows = _equations(train)
    free = len(links) - int(np.linalg.matrix_rank(rows))
    told = list(dict.fromkeys(map(train.link, train.given)))
    if free < 1:
        raise CannotBuild(tell("train: nothing can turn, the meshes lock one another"), tell("look at shafts and carriers"))
    if len(told) != free or len(train.given) != len(told):
        raise CannotBuild(tell("train: degrees of freedom: {free}; of so many links speeds are needed, given are {given}").format(
            free=free, given=len(train.given)), tell('a link that is held has the speed "0 rpm"'))
    fixed = np.eye(len(links))[[links.index(name) for name in told]]
    if np.linalg.matrix_rank(np.vstack((rows, fixed))) < len(links):
        raise CannotBuild(tell("train: the speeds of {links} hang together and do not tell those of the others").format(
            links=", ".join(train.given)), tell("give the speed of another link"))


def _sums(train: Train) -> dict[str, list[int]]:
    """z_c ± z_p of the meshes of each carrier."""
    found: dict[str, list[int]] = {}
    for m in train.meshes:
        found.setdefault(m.carrier, []).append(train.data.teeth[m.central] + m.sign * train.data.teeth[m.planet])
    return found


def _check_distances(train: Train) -> None:
    for m in train.meshes:
        if m.sign < 0 and train.data.teeth[m.central] <= train.data.teeth[m.planet]:
            raise CannotBuild(tell("train: ring {ring} has no more teeth than planet "
                                   "{planet}").format(ring=m.central, planet=m.planet),
                              tell("a ring is the larger wheel"))
    for carrier, sums in _sums(train).items():
        if carrier and max(sums) - min(sums) > FARTHEST:
            raise CannotBuild(tell("train: the central wheels of carrier {carrier} have no common axis: z_c ± z_p are "
                                   "{sums}").format(
                carrier=carrier, sums=", ".join(map(str, sums))), tell("shifts bridge two teeth at most"))


# --- speeds ---------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Found:
    """How a speed was found: from ``meshes``: one, two for a carrier between central wheels, none if given or by all together.

    ``shaft``: the wheel or carrier on the same shaft.
    """

    name: str
    meshes: tuple[Mesh, ...] = ()
    shaft: str = ""


def order(train: Train) -> Iterator[Found]:
    """Wheels and carriers in the order in which their speeds can be found."""
    known = set(train.given)
    yield from map(Found, train.given)
    while len(known) < len(train.names):
        found = _next(train, known)
        known.add(found.name)
        yield found


def _next(train: Train, known: set[str]) -> Found:
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


def distance_of(train: Train, mesh: Mesh) -> str:
    """Name of the step with the distance of a mesh: one for all of a carrier, else one for each pair."""
    return f"a_{mesh.carrier}" if mesh.carrier else f"a_{mesh.central}-{mesh.planet}"


class _Kinematics:
    """Records the plan of a train's numbers."""

    def __init__(self, train: Train) -> None:
        self.train = train
        self.plan = Plan("train-kinematics", tr("Diameters of the wheels and speeds of rotation of the links"), "mm")
        for name in train.names:
            if name.isdigit():
                self.plan.add(f"z{name}", TEETH, Given(train.data.teeth[name], f"train.teeth.{name}", over="none"),
                              symbol=f"z_{{{name}}}")
        self.diameters()
        for found in order(train):
            self.speed(found)

    def teeth(self, mesh: Mesh) -> tuple[Step, Step]:
        return self.plan[f"z{mesh.central}"], self.plan[f"z{mesh.planet}"]

    def diameters(self) -> None:
        module = self.plan.add("m", MODULE, GivenNumber(self.train.data.module, "train.module", "m", "m"))
        for m in self.train.meshes:
            name = distance_of(self.train, m)
            if name not in self.plan:
                self.plan.add(name, DISTANCE, module, float(m.sign), *self.teeth(m), say=said_with_sign(DISTANCE, m.sign),
                              symbol=f"a_{{{name.removeprefix('a_')}}}")
            self.plan.add(f"d{m.central}-{m.planet}", CENTRAL_PITCH, self.plan[name], float(m.sign), *self.teeth(m),
                          say=said_with_sign(CENTRAL_PITCH, m.sign), symbol=f"d_{{{m.central}}}")

    def speed(self, found: Found) -> None:
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
        (z1, p1), (z2, p2), sign = self.teeth(one), self.teeth(two), one.sign * two.sign
        name = f"i{one.central},{two.central}"
        ratio = self.plan.add(name, INNER_RATIO, float(sign), z1, p1, p2, z2, say=said_with_sign(INNER_RATIO, sign),
                              symbol=f"i_{{{one.central},{two.central}}}^{{{one.carrier}}}")
        return self.plan[f"n{one.central}"], self.plan[f"n{two.central}"], ratio

    def all(self, name: str) -> tuple[Any, ...]:
        train, links = self.train, _equations(self.train)[0]
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
TOGETHER = Rule("speed by all equations of Willis", together, (N, N), N,
                marked("The train is closed; the Willis equations of all its meshes together give {name} = {value} "
                       "rpm."), unit="1/min")


# --- picture of velocities ------------------------------------------------------------------------------------------------


class _Picture(SpeedPicture):
    """Adds the links in the order in which their speeds are found; each line goes through two velocities that are there."""

    def __init__(self, train: Train) -> None:
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
        height = self.axes[self.train.link(link)]
        if height == 0:
            return self.axis
        name = f"O{self.train.link(link)}"
        if name not in self.plan:
            mesh = next(m for m in self.train.meshes if not m.carrier and self.train.link(link) in (
                self.train.link(m.planet), self.train.link(m.central)))
            self.plan.add(name, reducer_speeds.AT_DISTANCE, 1.0 if height > 0 else -1.0,
                          self.train.kinematics[distance_of(self.train, mesh)])
        return self.plan[name]

    def contact(self, m: Mesh) -> Step:
        """Pitch point of a mesh, over the main axis."""
        key = (m.central, m.planet, "contact")
        if key not in self.points:
            side = 1 if m.carrier or self.axes[self.train.link(m.planet)] > 0 else -1
            self.points[key] = self.point(reducer_speeds.AT_RADIUS, self.train.kinematics[f"d{m.central}-{m.planet}"], side)
        return self.points[key]

    def planet_axis(self, m: Mesh) -> Step:
        """Point of the planet's axis, over the main one."""
        key = (m.carrier, "", "axis")
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
        return min(of, key=lambda m: self.train.link(m.planet) == self.train.link(name))

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


def heights(train: Train) -> Iterator[tuple[str, float]]:
    """Heights of the axes of all links over the main one, m; planets on carriers are left out.

    The main axis is that of the carriers and their central wheels, without any that of the first wheel. Pairs beside it stand over
    it where they lead in first, under it else.

    Raises
    ------
    CannotBuild
        when a pair has no wheel on the main axis.
    """
    on = [m for m in train.meshes if m.carrier]
    found = {train.link(name): 0.0 for m in on for name in (m.central, m.carrier)} or {train.link(train.meshes[0].central): 0.0}
    for m in (m for m in train.meshes if not m.carrier):
        central, planet, apart = train.link(m.central), train.link(m.planet), train.distance(m)
        if central not in found and abs(abs(found.get(planet, 0.0)) - apart) < 1e-9 * apart:
            found[central] = 0.0
        if found.get(central) != 0.0 or found.get(planet) == 0.0:
            raise CannotBuild(tell("train: wheel {wheel} of the pair {wheel}–{mate} is not on the main axis").format(
                wheel=m.central, mate=m.planet), tell("write the wheel on the main axis as sun or ring, in the order of the train"))
        found.setdefault(planet, apart * (1 if m is train.meshes[0] else -1))
    yield from found.items()


def train(data: TrainTable) -> Train:
    """Train of a project; raises :class:`CannotBuild` with what its speeds or tooth numbers lack."""
    return Train(data)
