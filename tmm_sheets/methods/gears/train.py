"""A train of gears with speeds given at any of its links: simple pairs, planetary stages, two moving inputs, Ferguson's paradox.

Every mesh gives an equation of Willis, z_c(n_c - n_H) ± z_p(n_p - n_H) = 0 with + for an external one; H is the frame for a pair
whose axes stand still. One unknown at a time is found from them, by formulas and graphically in the picture of velocities. Tooth
numbers are given; where the reference distances of a stage differ, its pitch points are the working ones of one common distance,
for which
shifts are needed. Diameters in millimetres, speeds in 1/min.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.step import GivenNumber, Plan, Reported, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears.train_steps import (
    DISTANCE,
    FRAME,
    Kinematics,
    Mesh,
    SpeedPicture,
    TrainData,
    distance_of,
    is_wheel,
    speeds_plan,
)
from tmm_sheets.numbers import number
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.task.seldom_tables import TrainTable

FARTHEST = 2.0
"""Teeth by which the sums of tooth numbers of one stage may differ: so much can shifts bridge."""


class Train:
    """A train of gears: its meshes, the speeds of all links, the picture of velocities.

    Plans: ``train-kinematics``, ``train-velocities``, ``train-speeds``, with another word where the train is another part.
    """

    entry = exit = ""
    """Links whose shafts lead in and out, where the part has one way through."""

    def __init__(self, data: TrainData) -> None:
        self.data = data
        self.meshes = data.meshes
        self.shafts = {name: shaft[0] for shaft in data.shafts for name in shaft}
        _check_speeds(self)
        _check_distances(self)
        self.axes = standing_axes(self)
        """Axes of all links but planets on carriers."""

    def link(self, name: str) -> str:
        """The link a wheel or carrier belongs to, by its first name."""
        return self.shafts.get(name, name)

    def stage(self, m: Mesh) -> tuple[Mesh, ...]:
        """Meshes at one distance of the axes: those of a carrier whose planets turn together, or a pair whose axes stand still."""
        return tuple([o for o in self.meshes if o is m or (m.carrier and o.carrier == m.carrier
                                                          and self.link(o.planet) == self.link(m.planet))])

    @property
    def stages(self) -> tuple[tuple[Mesh, ...], ...]:
        """All of them, each once."""
        return tuple(dict.fromkeys(map(self.stage, self.meshes)))

    def teeth(self, m: Mesh) -> int:
        """z_c ± z_p of a mesh: twice the distance of its axes in modules."""
        return int(self.data.teeth[m.central] + m.sign * self.data.teeth[m.planet])

    @property
    def names(self) -> tuple[str, ...]:
        """All wheels by number, then the carriers."""
        found = dict.fromkeys([name for m in self.meshes for name in (m.central, m.planet, m.carrier) if name])
        return tuple(sorted(found, key=lambda name: (not is_wheel(name), int(name.rstrip("′")) if is_wheel(name) else 0, name)))

    @property
    def wheels(self) -> tuple[str, ...]:
        """Wheels by number."""
        return tuple(filter(is_wheel, self.names))

    @cached_property
    def equations(self) -> tuple[list[str], npt.NDArray[np.float64]]:
        """Links, and the equations of Willis, one row for each mesh."""
        links = list(dict.fromkeys(map(self.link, self.names)))
        rows = np.zeros((len(self.meshes), len(links)))
        for row, m in zip(rows, self.meshes, strict=True):
            zc, zp = (self.data.teeth[name] for name in (m.central, m.planet))
            for name, share in ((m.central, zc), (m.planet, m.sign * zp), (m.carrier, -(zc + m.sign * zp))):
                if name:
                    row[links.index(self.link(name))] += share
        return links, rows

    @cached_property
    def kinematics(self) -> Plan:
        """Tooth numbers, distances, pitch diameters and the speeds ``n1`` .. of all wheels and carriers."""
        return Kinematics(self).plan

    @cached_property
    def velocities(self) -> Plan:
        """Picture of velocities: points ``A`` .. with their velocities ``a`` .., and a line named after each link."""
        return SpeedPicture(self).plan

    def speeds(self, distance: float) -> Plan:
        """Plan of the speeds of rotation with its pole ``distance`` m over the line on which they are read."""
        if distance not in self._speed_plans:
            self._speed_plans[distance] = speeds_plan(self.velocities, distance, self.data.part)
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
        """True for what is held in the frame; a planet on a carrier that does not turn moves along with it."""
        return self.link(name) in {self.link(k) for k, speed in self.data.speeds.items() if not speed} & self.axes.keys()

    def pitch(self, mesh: Mesh) -> Step:
        """Diameter of the central wheel's pitch circle in a mesh, mm."""
        working = f"d{mesh.central}-{mesh.planet}"
        return self.kinematics[working if working in self.kinematics else f"d{mesh.central}"]

    def radius(self, name: str, mesh: Mesh) -> float:
        """Pitch radius of a wheel in a mesh, m."""
        central = float(self.pitch(mesh).value) / 2e3
        return central if name == mesh.central else abs(self.distance(mesh) - central)

    def distance(self, mesh: Mesh) -> float:
        """Distance of the axes of a mesh, m."""
        return float(self.kinematics[distance_of(self, mesh)].value) / 1e3

    def height(self, name: str) -> float:
        """Height of the axis of a wheel or carrier over the main one, m; of a planet on a carrier that of one over it."""
        on = next((m for m in self.meshes if m.carrier and self.link(m.planet) == self.link(name)), None)
        return self.distance(on) if on else self.axes[self.link(name)].height

    @property
    def warnings(self) -> tuple[str, ...]:
        """Remarks for the sheet."""
        out = []
        for first, *others in self.stages:
            near = [self.teeth(m) for m in (first, *others) if not self.own_module(m)]
            if len(set(near)) > 1:
                out.append(tr("the stage with the carrier {carrier} needs shifts: its distances differ by {teeth} m").format(
                    carrier=first.carrier, teeth=number((max(near) - min(near)) / 2)))
            out += [tr("the pair {wheel}–{mate} has a module of its own, {module} mm, for the distance of {first}–{planet}").format(
                wheel=m.central, mate=m.planet, module=number(1e3 * module), first=first.central, planet=first.planet)
                for m in others if (module := self.own_module(m))]
        return tuple(out)

    def own_module(self, m: Mesh) -> float:
        """Module, m, with which a mesh comes to the distance of its stage where shifts cannot; 0 where they can."""
        first = self.teeth(self.stage(m)[0])
        return float(self.data.module * first / self.teeth(m)) if abs(self.teeth(m) - first) > FARTHEST else 0.0

    def results(self) -> dict[str, Any]:
        """The ``train`` section of ``solve --json``: speeds in 1/min, distances in millimetres."""
        plan = self.kinematics
        return {"teeth": {name: Reported(plan[f"z{name}"]) for name in self.wheels},
                "distances": {step.name: Reported(step) for step in plan if step.rule is DISTANCE},
                "speeds_rpm": {f"n{name}": Reported(plan[f"n{name}"]) for name in self.names}}


def _check_speeds(train: Train) -> None:
    """As many speeds must be given as the train has degrees of freedom, and of links that tell the others."""
    links, rows = train.equations
    free = len(links) - int(np.linalg.matrix_rank(rows))
    told = list(dict.fromkeys(map(train.link, train.given)))
    if free < 1:
        raise CannotBuild(tell("train: nothing can turn, the meshes lock one another"), tell("look at shafts and carriers"))
    if len(told) != free or len(train.given) != len(told):
        raise CannotBuild(tell("train: degrees of freedom: {free}; of so many links speeds are needed, given are {given}").format(
            free=free, given=len(train.given)), _what_to_try(train, len(told) < free))
    fixed = np.eye(len(links))[[links.index(name) for name in told]]
    if np.linalg.matrix_rank(np.vstack((rows, fixed))) < len(links):
        raise CannotBuild(tell("train: the speeds of {links} hang together and do not tell those of the others").format(
            links=", ".join(train.given)), tell("give the speed of another link"))


def _what_to_try(train: Train, few: bool) -> str:
    """What to try where too ``few`` speeds are given, or too many: links are held, or turn together though the file says it not."""
    if not few:
        return tell("leave out those that follow from the others")
    held = tell('a link that is held has the speed "0 rpm"')
    apart = _unconnected_parts(train)
    example = str(apart).replace("'", '"') if apart else '[["2", "3"]]'
    together = tell("wheels and carriers that turn as one stand together in shafts, for example shafts = {example}").format(
        example=example)
    return f"{held}; {together}"


def _unconnected_parts(train: Train) -> list[list[str]]:
    """Wheels and carriers that would join the parts of a train between which neither a mesh nor a shaft is, for example."""
    parts: list[tuple[set[str], Mesh, Mesh]] = []
    for m in train.meshes:
        links, first = {train.link(name) for name in (m.central, m.planet, m.carrier) if name}, m
        for part in [part for part in parts if part[0] & links]:
            parts.remove(part)
            links, first = links | part[0], part[1]
        parts.append((links, first, m))
    return [_joint(train, before[2], after[1]) for before, after in pairwise(parts)]


def _joint(train: Train, before: Mesh, after: Mesh) -> list[str]:
    """What may lead from one mesh to another: the shaft beside the main axis that two pairs have, else one on it."""
    if not before.carrier and not after.carrier:
        return [before.planet, after.planet]
    return [before.carrier or before.central, after.central if after.central not in train.given else after.carrier or after.planet]


def _check_distances(train: Train) -> None:
    for m in train.meshes:
        if m.sign < 0 and train.data.teeth[m.central] <= train.data.teeth[m.planet]:
            raise CannotBuild(tell("train: ring {ring} has no more teeth than planet "
                                   "{planet}").format(ring=m.central, planet=m.planet),
                              tell("a ring is the larger wheel"))
    for planet in dict.fromkeys(m.planet for m in train.meshes if m.carrier):
        # A wheel has one module: what meshes with it has the same.
        sums = [train.teeth(m) for m in train.meshes if m.planet == planet]
        if max(sums) - min(sums) > FARTHEST:
            raise CannotBuild(tell("train: the wheels that mesh with planet {planet} have no common axis: z_c ± z_p are "
                                   "{sums}").format(
                planet=planet, sums=", ".join(map(str, sums))), tell("shifts bridge two teeth at most"))


@dataclass(frozen=True)
class Axis:
    """An axis that stands still: its ``height`` over the main one, m, and the mesh and link from whose axis it was reached."""

    height: float
    mesh: Mesh | None = None
    base: str = ""


def standing_axes(train: Train) -> dict[str, Axis]:
    """Axes of all links but planets on carriers, as the train is unfolded into one plane.

    The main axis is that of the carriers and their central wheels, without any that of the first wheel. Pairs beside it stand over
    it where they lead in first, under it else; further ones lead back to it where their distance allows, else farther away.

    Raises
    ------
    CannotBuild
        when a pair hangs on no axis that is known, or its wheels stand at another distance than it needs.
    """
    on = [m for m in train.meshes if m.carrier]
    main = [train.link(name) for m in on for name in (m.central, m.carrier)] or [train.link(train.meshes[0].central)]
    found = dict.fromkeys(main, Axis(0.0))
    waiting = [m for m in train.meshes if not m.carrier]
    while waiting:
        m = next((m for m in waiting if {train.link(m.central), train.link(m.planet)} & set(found)), waiting[0])
        waiting.remove(m)
        known, other = (train.link(name) for name in (m.central, m.planet))
        if known not in found:
            known, other = other, known
        if known not in found:
            raise CannotBuild(tell("train: neither wheel of the pair {wheel}–{mate} is on an axis that is known").format(
                wheel=m.central, mate=m.planet), _to_main_axis(m))
        height, apart = found[known].height, train.distance(m)
        near = 1e-9 * apart
        if other in found:
            if abs(abs(found[other].height - height) - apart) > near:
                raise CannotBuild(tell("train: the axes of {wheel} and {mate} are {there} mm apart, but the pair needs {apart} "
                                       "mm").format(wheel=m.central, mate=m.planet, apart=number(1e3 * apart),
                                                    there=number(1e3 * abs(found[other].height - height))), _to_main_axis(m))
            continue
        back = height and abs(abs(height) - apart) < near
        away = (1.0 if m is train.meshes[0] else -1.0) if not height else (1.0 if height > 0 else -1.0)
        found[other] = Axis(0.0) if back else Axis(height + away * apart, m, known)
    return found


def _to_main_axis(m: Mesh) -> str:
    """What to try where neither wheel of a pair is known to be on the main axis."""
    return tell("write the wheel on the main axis as sun or ring, in the order of the train; where {wheel} or {mate} turns with a "
                "wheel or a carrier of another mesh, both stand together in shafts").format(wheel=m.central, mate=m.planet)


def train(data: TrainTable) -> Train:
    """Train of a project; raises :class:`CannotBuild` with what its speeds or tooth numbers lack."""
    meshes = tuple(Mesh(m.sun or m.ring or "", m.planet, m.carrier or FRAME, 1 if m.sun else -1) for m in data.mesh)
    speeds = {name: GivenNumber(speed, f"train.speeds.{name}", "ω", "rad/s") for name, speed in data.speeds.items()}
    return Train(TrainData("train", meshes, data.teeth, data.module, speeds, data.shafts, data.satellites))
