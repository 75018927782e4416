"""Speeds of a train of gears by the equations of Willis as steps of a plan.

Diameters and distances in millimetres, speeds in 1/min.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given, GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Kind, Rule, Step
from tmm_sheets.methods.gears import planetary
from tmm_sheets.methods.gears.gear_formulas import MODULE
from tmm_sheets.words import marked, tr

FRAME = ""
"""The carrier of a pair whose axes stand still."""

N: Kind = "number"
TEETH = Rule("number of teeth", lambda z: z, (N,), N, marked("Number of teeth {name} = {value}."), source="003, 2.1–2.4")
INNER_RATIO = Rule(
    "ratio with the carrier stopped", lambda s, z1, z2, z3, z4: planetary.inner_ratio((s, 1), (z1, z2, z3, z4)), (N,) * 5, N,
    marked("Ratio of the train with the carrier held ±z_2z_4/(z_1z_3): {name} = ±{2} × {4}/({1} × {3}) = {value}."),
    source="003, 2.1–2.4")
STANDS = Rule("a wheel that stands still", lambda: 0.0, (), N, marked("The wheel stands still: {name} = 0."), unit="1/min")
SAME_SHAFT = Rule("speed on the same shaft", lambda n: n, (N,), N, marked("On the same shaft: {name} = {value} rpm."), unit="1/min")
BLOCK = Rule("speed of the satellites", lambda h, s, n, z1, z2: h - s * (n - h) * z1 / z2, (N,) * 5, N,
             marked("Speed of rotation by the Willis formula n_H ∓ (n_1 − n_H)z_1/z_2: {name} = {0} ∓ ({2} − {0}) × {3}/{4} = "
                    "{value} rpm."), unit="1/min")
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
ACROSS = Rule("speed of a central wheel across its carrier", lambda h, two, i: h * (1 - i) + i * two, (N,) * 3, N,
              marked("Speed of rotation of the central wheel by the Willis formula n_H(1 − i) + i·n_2: {name} = {0} × (1 − {2}) + "
                     "{2} × {1} = {value} rpm."), unit="1/min")
DIAMETER = Rule("pitch diameter", lambda z, m: z * m, (N, N), N,
                marked("Pitch diameter (there are no shifts) d = mz: {name} = {1} × {0} = {value} mm."), unit="mm")
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


def said_with_sign(rule: Rule, sign: int) -> str:
    """The rule's sentence with the sign of its pairs."""
    return tr(rule.wording).replace("±", "+" if sign > 0 else "−").replace("∓", "−" if sign > 0 else "+")


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
            self.speed(found)

    def teeth(self, mesh: Mesh) -> tuple[Step, Step]:
        """Tooth numbers of central wheel and planet."""
        one, two = (self.data.known.get(f"z{name}") or self.plan[f"z{name}"] for name in (mesh.central, mesh.planet))
        return one, two

    def diameters(self) -> None:
        """Distances of the axes and pitch diameters: of both wheels, or with shifts of the central one in the mesh."""
        plan = self.plan
        plan.add("m", MODULE, GivenNumber(self.data.module, f"{self.data.part}.module", "m", "m"))
        for m in self.train.meshes:
            module = plan["m"] if m.module is None else plan.once("m_simple", MODULE, m.module, symbol=tr("m_{s}"))
            name = distance_of(self.train, m)
            if name not in plan:
                plan.add(name, DISTANCE, module, float(m.sign), *self.teeth(m), say=said_with_sign(DISTANCE, m.sign),
                         symbol=f"a_{{{name.removeprefix('a_')}}}")
            if self.train.teeth(m) != self.train.teeth(self.train.stage(m)[0]):
                plan.add(f"d{m.central}-{m.planet}", CENTRAL_PITCH, plan[name], float(m.sign), *self.teeth(m),
                         say=said_with_sign(CENTRAL_PITCH, m.sign), symbol=f"d_{{{m.central}}}")
                continue
            for wheel, z in zip((m.central, m.planet), self.teeth(m), strict=True):
                plan.once(f"d{wheel}", DIAMETER, z, module, symbol=f"d_{{{wheel}}}")

    def speed(self, found: Found) -> None:
        """Speed of a wheel or carrier as it is found."""
        name, plan, data = found.name, self.plan, self.data
        rule: Rule = SAME_SHAFT
        args: tuple[Any, ...] = (plan[f"n{found.shaft}"],) if found.shaft else ()
        say: str | None = None
        if name in data.speeds:
            given = data.speeds[name]
            rule, args = (STANDS, ()) if given is None else (GIVEN_SPEED, (given,))
        elif len(found.meshes) == 2:
            rule, args = self.across(name, *found.meshes)
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
        rule, args = (BLOCK, (plan[f"n{m.carrier}"],)) if m.carrier else (PAIR, ())
        return rule, (*args, float(m.sign), plan[f"n{other}"], *z), said_with_sign(rule, m.sign)

    def across(self, name: str, one: Mesh, two: Mesh) -> tuple[Rule, tuple[Any, ...]]:
        """Rule and arguments for a carrier between two central wheels, or for the first of these."""
        (z1, p1), (z2, p2), sign = self.teeth(one), self.teeth(two), one.sign * two.sign
        ratio = self.data.known.get(key := f"i{one.central},{two.central}") or self.plan.add(
            key, INNER_RATIO, float(sign), z1, p1, p2, z2, say=said_with_sign(INNER_RATIO, sign),
            symbol=f"i_{{{one.central},{two.central}}}^{{{one.carrier}}}")
        rule, other = (DIFFERENTIAL, one.central) if name == one.carrier else (ACROSS, one.carrier)
        return rule, (self.plan[f"n{other}"], self.plan[f"n{two.central}"], ratio)

    def all(self, name: str) -> tuple[Any, ...]:
        """What the speed of a link follows from by the equations of all meshes."""
        train, links = self.train, self.train.equations[0]
        place = {name: links.index(train.link(name)) for name in train.names} | {FRAME: -1}
        known = train.given
        row = [len(links), len(known), *(place[k] for k in known)]
        for m in train.meshes:
            row += [place[m.central], place[m.planet], place[m.carrier], m.sign]
        structure = Given(np.array(row, dtype=float), f"{self.data.part}.mesh", over="curve")
        return (float(place[name]), structure, *(z for m in train.meshes for z in self.teeth(m)),
                *(self.plan[f"n{k}"] for k in known))


TOGETHER = Rule("speed by all equations of Willis", together, (N, N), N,
                marked("The train is closed; the Willis equations of all its meshes together give {name} = {value} "
                       "rpm."), unit="1/min")
