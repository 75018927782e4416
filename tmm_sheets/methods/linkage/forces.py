"""Kinetostatics: force plans of each Assur group, the farthest first, then of the crank.

Friction in the pairs, where there is some, is a part of the loads: :mod:`~tmm_sheets.methods.linkage.friction`.

``F_jk`` is the force on link j from link k. Forces are complex, N, shape (n,); couples N m, counter-clockwise positive.
Source: manual 000, section 4 and table 4.1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Floats, primitive
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.step import FoundNumber, Given, Plan, Rule, SearchCount, Step, symbol, value_at
from tmm_sheets.mechanism.groups.contexts import OPPOSITE_COUPLE, ForcePlan, Held, Load, Role, TangentialPart
from tmm_sheets.mechanism.groups.triad import BY_MOMENTS
from tmm_sheets.mechanism.model import Drive, StructuralGroup, lettered
from tmm_sheets.methods.linkage.motion import Accelerations
from tmm_sheets.methods.linkage.positions import CHOICE, SEARCHED, PassagePlace, Passages, Positions, alone, beside, position_plan
from tmm_sheets.numbers import Sizes
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.friction import Friction


WEIGHT = Rule("weight", lambda m, g: -1j * m * g, ("number", "number"), "force",
              marked("Weight {name} = m·g = {0}·{1} = {value}, downwards."))
INERTIA = Rule("inertia force", lambda m, a: -m * a, ("number", "point"), "force",
               marked("Force of inertia {name} = m·a = {0}·a_{1} = {value}, against the acceleration of {1}."))
COUPLE = Rule("inertia couple", lambda j, e: -j * e, ("number", "number"), "number",
              marked("Moment of the inertia forces {name} = −J·ε = {value} N·m, against ε."), unit="N*m")
BESIDE_MASS = Rule("what turns with the crank beside its mass", lambda j, m, s, o: j - m * np.abs(s - o) ** 2,
                   ("number", "number", "point", "point"), "number",
                   marked("The force of inertia of the input link itself stands for {1}·|{3}{2}|²: {name} = {0} − {1}·|{3}{2}|² = "
                          "{value} kg·m²."), unit="kg*m2")
OPPOSITE = Rule("reaction", lambda f: -f, ("force",), "force", "{name} = −{0}.", unit="N")
NEGATIVE = Rule("opposite number", lambda x: -x, ("number",), "number", "{name} = {value}.", beyond_paper=True, unit="1")
ARM = Rule("arm from moments", lambda m, f: m / np.abs(f), ("number", "force"), "length",
           marked("Arm {name} = {value} from the equation of moments."))


FORCE_ARM = Rule("arm of a force", ar.arm, ("point", "point", "force"), "ordinate",
                 marked("Arm of the force {2} about {0}: {value}."), unit="m")


def tangential_part(total: Any, centre: Any, at: Any) -> Any:
    """Force at a point, across its radius from the centre, that balances a sum of moments about it, N."""
    r = at - centre
    return -total / np.abs(r) * 1j * r / np.abs(r)


TANGENTIAL = Rule("component from moments", tangential_part, ("number", "point", "point"), "force",
                  marked("From the sum of moments about {1} find the component {name} = {value}, perpendicular to {1}{2}."),
                  unit="N")


MOMENTS = Rule("sum of moments", lambda about, *terms: sum((term for at, vector, couple in zip(
                   terms[::3], terms[1::3], terms[2::3], strict=True) for term in (ar.moment(about, at, vector), couple)), 0.0),
               ("point",), "number", marked("Sum of moments about {0}: {name} = {value} N·m."),
               lambda a, v: tuple(h for at, force in zip(a[1::3], a[2::3], strict=True) for h in rules.arm(a[0], at, force)),
               unit="N*m")


@dataclass
class Kinetostatics:
    """Force analysis of all groups and the crank.

    ``loads`` are all forces on each link, reactions included, as they were used; ``reactions`` by name ("F54", "F11,10");
    ``couples`` and ``arms`` of sliding pairs by name ("h50"); ``link_couples`` are inertia couples and applied
    moments of each link; ``from_moments`` are the parts of reactions that moment equations gave, in the order they were found;
    ``parts`` those known before the normal part, by the reaction's name, from moments or along a slot; ``limits`` are rows that are
    known next to change points (:func:`~tmm_sheets.methods.linkage.forces.limits_of_forces`).
    """

    positions: Positions
    accelerations: Accelerations
    loads: dict[str, list[Load]]
    plan: Plan
    link_couples: dict[str, list[Step]] = field(default_factory=dict)
    reactions: dict[str, Step] = field(default_factory=dict)
    couples: dict[str, Step] = field(default_factory=dict)
    arms: dict[str, Step] = field(default_factory=dict)
    plans: dict[str, ForcePlan] = field(default_factory=dict)
    from_moments: list[TangentialPart] = field(default_factory=list)
    parts: dict[str, Step] = field(default_factory=dict)
    balancing: Step = field(init=False)
    friction: Friction | None = None
    limits: dict[str, Given] = field(default_factory=dict)

    @property
    def external(self) -> list[Load]:
        """Weights, inertia forces and applied forces of all links, without reactions."""
        return [load for loads in self.loads.values() for load in loads if load.role != "reaction"]

    def bounded(self) -> Any:
        """True at the positions where every reaction is a number, shape (n,): not where links that carry it lie in one line."""
        n = len(self.positions.plan.labels)
        return np.all([np.isfinite(np.broadcast_to(step.value, (n,))) for step in self.reactions.values()], axis=0)

    @property
    def couple_points(self) -> dict[str, str]:
        """Points that the couples of sliding pairs' reactions refer to: the force is taken there."""
        return {name: couple.args[0].args[0].name for name, couple in self.couples.items()}

    def about_special(self, point: Step) -> Step | None:
        """The component that the moments of a whole group of class III about a special point give; None where they give none."""
        return next((step for step in self.plan if step.rule is BY_MOMENTS and step.args[1] is point), None)

    def sum_about(self, point: Step, force: Step) -> Step | None:
        """The sum of moments about a point that takes a force; None when there is none."""
        sums = (step for step in self.plan if step.rule is MOMENTS and step.args[0] is point)
        return next((step for step in sums if any(a is force for a in step.args)), None)

    def force_size(self, k: int) -> float:
        """Size of the forces at position ``k``, N: beside it a force is something or nothing."""
        return self._sizes.at(k)

    @cached_property
    def _sizes(self) -> Sizes:
        return Sizes(load.vector.value for loads in self.loads.values() for load in loads)

    def moment_size(self, k: int) -> float:
        """Moment of such a force across the whole mechanism, N m: beside it a moment is something or nothing."""
        return self._sizes.at(k) * self._reach.at(k)

    @cached_property
    def _reach(self) -> Sizes:
        points = list(self.positions.points.values())
        return Sizes(p.value - points[0].value for p in points)

    def reaction(self, j: str, k: str, vector: Step) -> Step:
        """Record F_jk under its name."""
        self.reactions[f"F{pair_index(j, k)}"] = vector
        return vector

    def opposite(self, j: str, k: str, vector: Step) -> Step:
        """Record F_jk, the opposite of F_kj."""
        return self.reaction(j, k, self.plan.add(f"F{pair_index(j, k)}", OPPOSITE, vector))

    def opposite_couple(self, j: str, k: str, couple: Step) -> Step:
        """The couple on link ``j`` opposite to that on link ``k``."""
        return self.plan.add(f"M{pair_index(j, k)}", OPPOSITE_COUPLE, couple)

    def negative(self, step: Step) -> Step:
        """A number with the other sign, which is not drawn."""
        return self.plan.auxiliary(f"−{step.name}", NEGATIVE, step)

    @staticmethod
    def contact(j: str, k: str, at: Step, vector: Step, couple: Step | None = None) -> Load:
        """Reaction on link ``j`` from link ``k`` as a load."""
        return Load(symbol(f"F{pair_index(j, k)}"), j, at, vector, "reaction", couple, k)

    @staticmethod
    def order(loads: list[Load], first: Role) -> list[Load]:
        """Loads in the order they are laid off: of one role first, then weights, inertia, applied forces, reactions."""
        rank = {"weight": 1, "inertia": 2, "applied": 3, "reaction": 4}
        rank[first] = 0
        return sorted(loads, key=lambda load: rank[load.role])

    def moment_sum(self, name: str, about: Step, links: Iterable[str], more: Iterable[tuple[Step, Any, Any]] = ()) -> Step:
        """Sum of moments of all recorded forces and couples of some links about a point, N m; ``more`` act besides."""
        terms: list[Any] = [about]
        for link in links:
            for load in self.loads[link]:
                terms += [load.at, load.vector, 0.0 if load.couple is None else load.couple]
            for couple in self.link_couples.get(link, ()):
                terms += [about, 0j, couple]
        for term in more:
            terms += term
        return self.plan.add(name, MOMENTS, *terms)

    def arm_about(self, about: Step, at: Step, vector: Step) -> Step:
        """Signed arm of a force about a point as it is read off a scheme, m; whoever asks first."""
        return self.plan.auxiliary(f"h({about.name}, {vector.name})", FORCE_ARM, about, at, vector)

    def tangential(self, j: str, k: str, total: Step, centre: str, at: str) -> Step:
        """Part of F_jk at a point across its line to the centre of the moments, from their sum."""
        z = self.positions.points
        step = self.plan.add(f"F{pair_index(j, k)}τ", TANGENTIAL, total, z[centre], z[at])
        self.from_moments.append(TangentialPart(j, k, at, centre, step))
        self.parts[f"F{pair_index(j, k)}"] = step
        return step

    def plan_of(self, name: str, links: tuple[str, ...]) -> ForcePlan:
        """New force plan of a link or of a whole group."""
        title = tr("Force polygon of link "
                   "{link}").format(link=links[0]) if len(links) == 1 else tr("Force polygon of group "
                                                                              "{links}").format(links=lettered(links))
        fp = ForcePlan(name, links, Plan(f"force-{name}", title, "N", self.positions.plan.labels, search=self.plan.search))
        self.plans[name] = fp
        return fp

    def read(self, fp: ForcePlan, j: str, other: str, tail: Step, head: Step, *, drawn: bool = True) -> Step:
        """The reaction on link ``j`` from link ``other`` as a segment of a polygon, ``drawn`` there unless it is a side of it."""
        name = f"F{pair_index(j, other)}"
        if drawn:
            fp.plan.vector(symbol(name), tail, head)
        return self.reaction(j, other, fp.between(name, tail, head))

    def close(self, fp: ForcePlan, j: str, other: str, tail: Step, head: Step) -> Step:
        """Close a polygon of what was laid off by the reaction on link ``j`` from link ``other``."""
        fp.record_laid()
        fp.side(symbol(f"F{pair_index(j, other)}"), tail, head, unknown=True)
        return self.read(fp, j, other, tail, head, drawn=False)

    def react(self, link: str, on: str, at: Step, vector: Step, couple: Step | None = None) -> Step:
        """The equal and opposite force on the neighbouring link ``on`` from ``link``."""
        step = self.opposite(on, link, vector)
        if on != self.positions.mechanism.frame:
            turned = None if couple is None else self.opposite_couple(on, link, couple)
            self.loads[on].append(self.contact(on, link, at, step, turned))
        return step

    def across(self, name: str, u: Step, symbol: str = "") -> Step:
        """Direction across another, drawn once."""
        return self.plan.add_once(f"⟂{name}", rules.TURN, u, symbol=symbol)

    def normal(self, j: str, other: str, name: str, u: Step, symbol: str = "") -> Step:
        """Direction of a sliding pair's reaction on link ``j``: across the guide, with friction deviated from there."""
        across = self.across(name, u, symbol)
        return across if self.friction is None else self.friction.deviated(j, other, across, self.plan)

    def deviates(self, j: str, other: str) -> bool:
        """True where friction deviates the reaction of a sliding pair from the normal."""
        return self.friction is not None and pair_index(j, other) in self.friction.deviations

    def sliding(self, j: str, other: str, force: Step, about: Step) -> Step:
        """Couple of a sliding pair's reaction on link ``j`` (its force taken at ``about``) and its arm, from moments about it."""
        couple = self.guide_couple(j, other, about)
        self.arm(j, other, couple, force)
        return couple

    def guide_couple(self, j: str, other: str, about: Step) -> Step:
        """Couple of a sliding pair's reaction on link ``j``, its force taken at ``about``, from moments about it."""
        name = pair_index(j, other)
        couple = self.plan.add(f"M{name}", OPPOSITE_COUPLE, self.moment_sum(f"ΣM{j}", about, [j]))
        self.couples[f"F{name}"] = couple
        return couple

    def arm(self, j: str, other: str, couple: Step, force: Step) -> None:
        """Arm of that reaction."""
        name = pair_index(j, other)
        self.arms[f"h{name}"] = self.plan.add(f"h{name}", ARM, couple, force)

    def group_polygon(self, g: StructuralGroup, one: Held, two: Held, known: tuple[Step, ...] = (),
                      between: Callable[[ForcePlan, Step], tuple[Step, Part]] | None = None) -> GroupPolygon:
        """Plan of a whole group: from the known part of one end over the loads of its links to that of the other.

        ``known`` is the sine of the angle between both lines, where the position plan knows it better than they do; ``between``
        lays off what lies between both ends, a third held link among it: its end, that link, and where its reaction lies.
        """
        fp = self.plan_of(g.name, g.links)
        after = fp.lay_part(fp.begin(), one)
        split = fp.lay_loads(after, self.order(self.loads[one.link], "weight"))
        middle, third = (split, None) if between is None else between(fp, split)
        before = fp.lay_loads(middle, self.order(self.loads[two.link], "weight"))
        limit = (self.limits[g.name],) if known and g.name in self.limits else ()
        closing = fp.meet(one, fp.lay_part(before, two), two, *known, *limit)
        reactions: list[Part] = [(one, closing, after), *([third] if third else []), (two, before, closing)]
        return GroupPolygon(fp, split, middle, closing, {held.link: self.read(
            fp, held.link, held.other, tail, head, drawn=held.part is not None) for held, tail, head in reactions})


Part = tuple[Held, Step, Step]
"""A reaction of a group's polygon, from its tail to its head."""


@dataclass(frozen=True)
class GroupPolygon:
    """A group's force plan: the ends of the first link's loads and of what lies behind them, the closing point, the outer
    ``reactions`` by link.
    """

    plan: ForcePlan
    split: Step
    middle: Step
    closing: Step
    reactions: dict[str, Step]


def _drive_plan() -> Plan:
    return Plan("drive", tr("Gear drive of the input link"), "m")


@dataclass(frozen=True)
class GearForce:
    """Force of a gear pair on the crank shaft's wheel: acts along the line of action.

    ``radius`` m of the wheel's pitch circle, ``angle`` the pressure angle, ``mate`` the direction to the mating wheel, rad.
    """

    name: str
    radius: float
    angle: float
    mate: float
    plan: Plan = field(default_factory=_drive_plan, compare=False, repr=False)

    @classmethod
    def of_gear(cls, name: str, module: float, teeth: float, angle: float, mate: float) -> GearForce:
        """Force on a wheel of so many teeth, ``module`` in m."""
        plan = _drive_plan()
        radius = plan.add("r", PITCH_RADIUS, module, teeth)
        return cls(name, FoundNumber(radius.value, radius), angle, mate, plan)

    @property
    def plans(self) -> dict[str, Plan]:
        """What follows from the numbers of the gear pair."""
        return {self.plan.name: self.plan}

    @property
    def wheel(self) -> tuple[float, float] | None:
        """Radius of its pitch circle, m, and direction to its mate, rad."""
        return self.radius, self.mate

    def line(self, sense: float) -> Step:
        """Unit vector of the force that drives the wheel in the sense of rotation and presses it from its mate."""
        return self.plan["u"] if "u" in self.plan else self.plan.add("u", LINE_OF_ACTION, sense, self.mate, self.angle)

    def direction(self, sense: float) -> complex:
        """Unit vector of the force as a number."""
        return complex(self.line(sense).value)


PITCH_RADIUS = Rule("radius of the pitch circle", lambda module, teeth: module * teeth / 2, ("length", "number"), "length",
                    marked("Radius of the reference circle: {formula}."))


def _line_of_action(sense: Any, mate: Any, angle: Any) -> Any:
    m = np.cos(mate) + 1j * np.sin(mate)
    return 1j * sense * m * np.cos(angle) - m * np.sin(angle)


LINE_OF_ACTION = Rule("line of action", _line_of_action, ("number", "angle", "angle"), "direction",
                      marked("At the working pressure angle {2} to the perpendicular to the line of centres draw the line of "
                             "action of the force {name}."))


@dataclass(frozen=True)
class InputForce:
    """Force on a slider along its guide, or of a cylinder along its axis, that moves the mechanism; positive as it moves.

    Of a cylinder it acts on the rod in the crank pin, and the opposite one on its other part. The lever gives it.
    """

    name: str
    drive: Drive

    @property
    def plans(self) -> dict[str, Plan]:
        """Nothing is constructed for it beforehand."""
        return {}

    @property
    def wheel(self) -> tuple[float, float] | None:
        """It acts on no wheel."""
        return None

    def loaded(self, pos: Positions, loads: dict[str, list[Load]], plan: Plan, force: Step) -> dict[str, list[Load]]:
        """Loads of all links with this ``force``, a step of ``plan``, N."""
        drive, found = self.drive, dict(loads)
        rod, body = drive.group.links
        link, at = (body, pos.points[drive.far]) if drive.slides else (rod, pos.points[pos.mechanism.crank.pin])
        found[link] = [*loads[link], Load(symbol(self.name), link, at, force, "applied")]
        if not drive.slides:
            back = plan.add(plan.named(f"{self.name}′"), OPPOSITE, force)
            found[body] = [*loads[body], Load(f"{symbol(self.name)}′", body, at, back, "applied")]
        return found

    def by_statics(self, k: Kinetostatics, by_lever: Step, line: Step) -> Step:
        """The force by the force plans: that of the lever, and what balances the moment that they leave on the crank."""
        omega = k.accelerations.velocities.omega[k.positions.mechanism.crank.link]
        return k.plan.add(k.plan.named(self.name), WITH_REST, by_lever, k.balancing, omega, self.drive.speed, line)


WITH_REST = Rule("force of an input by force plans", lambda force, moment, omega, v, u: (force + moment * omega / v) * u,
                 ("number", "number", "number", "number", "direction"), "force",
                 marked("With the moment {1} that the force plans leave on the crank: {name} = {0} + {1}·{2}/V = {value}."),
                 unit="N")


def contact_point(pos: Positions, driver: GearForce) -> Step:
    """Pitch point P of the wheel on the crank shaft and its mate, a point of the position plan."""
    if pos.contact is None:
        name = pos.plan.free("P")
        pos.contact = pos.plan.add(name, rules.LAY_OFF, pos.points[pos.mechanism.crank.pivot], driver.radius, driver.mate)
    return pos.contact


def external_loads(pos: Positions, acc: Accelerations, gravity: float,
                   applied: Iterable[tuple[str, str | None, Callable[[Plan], Step]]] = (), carried: Any = None) -> tuple[
                       dict[str, list[Load]], dict[str, list[Step]], Plan]:
    """Weights and inertia forces of every link, N, its couples, N m, and the plan of both; ``gravity`` in m/s2.

    ``applied`` are forces and moments (link, point or None, how they record themselves on the plan). ``carried`` is the moment of
    inertia of all that turns with the crank, kg m2, where it is more than the crank's own.
    """
    m = pos.mechanism
    plan = Plan("loads", tr("External forces and forces of inertia"), "N", pos.plan.labels, search=pos.plan.search)
    loads: dict[str, list[Load]] = {name: [] for name in m.links}
    couples: dict[str, list[Step]] = {}
    for link in m.links.values():
        if link.mass and link.centre is not None:
            at = pos.points[link.centre]
            if gravity:
                w = plan.add(f"G{link.name}", WEIGHT, link.mass, gravity)
                letter = f"G̅_{link.name}" if len(link.name) == 1 else symbol(f"G{link.name}")
                loads[link.name].append(Load(letter, link.name, at, w, "weight"))
            if link.centre not in m.fixed:
                fi = plan.add(f"Fи{link.name}", INERTIA, link.mass, acc.points[link.centre],
                              symbol=tr("Fi{link}").format(link=link.name))
                loads[link.name].append(Load(tr("F̅_{{i{link}}}").format(link=link.name), link.name, at, fi, "inertia"))
        inertia: Any = link.inertia
        if carried is not None and link.name == m.crank.link:
            # A mass off the axis is among what turns with the crank, and its force of inertia has a moment about the axis already.
            off = any(load.role == "inertia" for load in loads[link.name])
            inertia = plan.add(plan.named(f"J_{link.name}"), BESIDE_MASS, carried, link.mass, pos.points[str(link.centre)],
                               pos.points[m.crank.pivot]) if off else carried
        if inertia:
            couple = plan.add(f"Mи{link.name}", COUPLE, inertia, acc.epsilon[link.name],
                              symbol=tr("Mi{link}").format(link=link.name))
            couples.setdefault(link.name, []).append(couple)
    for name, point, record in applied:
        step = record(plan)
        if point is None:
            couples.setdefault(name, []).append(step)
        else:
            loads[name].append(Load(symbol(step.name), name, pos.points[point], step, "applied"))
    return loads, couples, plan


def kinetostatics(pos: Positions, acc: Accelerations, loads: dict[str, list[Load]], couples: dict[str, list[Step]],
                  driver: GearForce | InputForce | None, friction: Friction | None = None,
                  search: SearchCount | None = None, limits: dict[str, Given] | None = None) -> Kinetostatics:
    """Force plans of all groups from the farthest to the crank; ``driver`` None means a pure balancing moment.

    ``friction`` that acts besides; ``search`` counts plans that are only an approximation; ``limits`` are known next to change
    points.
    """
    sums = Plan("moments", tr("Sums of moments"), "m", pos.plan.labels, search=search or pos.plan.search)
    work = {name: list(of_link) for name, of_link in loads.items()}
    turning = {} if friction is None else friction.couples
    couples = {link: [*couples.get(link, ()), *turning.get(link, ())] for link in {**couples, **turning}}
    k = Kinetostatics(pos, acc, work, sums, couples, friction=friction, limits=limits or {})
    for g in reversed(pos.mechanism.groups):
        g.kind.force(k, g)
    _crank(k, driver)
    return k


def _crank(k: Kinetostatics, driver: GearForce | InputForce | None) -> None:
    """Initial link: the balancing force from moments about the crank pivot, then the force plan."""
    pos, m = k.positions, k.positions.mechanism
    c = m.crank
    pivot = pos.points[c.pivot]
    total = k.moment_sum(f"ΣM{c.link}", pivot, [c.link])
    plan = k.plan_of(c.link, (c.link,))
    first = plan.begin(1)
    reactions = [load for load in k.loads[c.link] if load.role == "reaction"]
    others = [load for load in k.loads[c.link] if load.role != "reaction"]
    tail = plan.lay_loads(first, reactions)
    known = (k.limits[TOTAL],) if TOTAL in k.limits else ()
    if not isinstance(driver, GearForce):
        k.balancing = k.plan.add("Mур", BALANCING if known else OPPOSITE_COUPLE, total, *known, symbol=tr("Mb"))
    else:
        at = contact_point(pos, driver)
        k.balancing = k.plan.add(k.plan.named(driver.name), DRIVING_FORCE, total, pivot, at, driver.line(c.sense), *known)
        load = Load(symbol(driver.name), c.link, at, k.balancing, "applied")
        k.loads[c.link].append(load)
        tail = plan.lay_loads(tail, [load])
    k.close(plan, c.link, m.frame, plan.lay_loads(tail, others), first)


TOTAL = "sum of moments on the crank"
"""Name of its limit."""


@primitive("value or its limit", "real")
def in_limit(value: Any, limit: Any) -> Any:
    """A value at each position, and its limit where that is known: next to a change point."""
    return np.where(np.isnan(limit), value, limit)


BALANCING = Rule("balancing moment", lambda total, limit: -in_limit(total, limit), ("number", "number"), "number",
                 OPPOSITE_COUPLE.wording, unit="N*m")


DRIVING_FORCE = Rule("balancing force", lambda total, centre, at, u, *limit: -(
                         in_limit(total, *limit) if limit else total) / ar.moment(centre, at, u) * u,
                     ("number", "point", "point", "direction"), "force",
                     marked("From the sum of moments about {1} find the balancing force {name} = {value}."),
                     lambda a, v: rules.arm(a[1], a[2], a[3]), unit="N")


FORCE_ZONE = 1e-5
"""Angle, rad, next to a change point in which moments of forces that grow beyond all bounds are taken as a limit."""


def limits_of_forces(pos: Positions, acc: Accelerations, loads: dict[str, list[Load]], couples: dict[str, list[Step]],
                     driver: GearForce | InputForce | None) -> dict[str, Given]:
    """Limits of what force plans cannot tell next to change points, as rows over the positions, NaN elsewhere.

    Lines of a group's plan fall together there, and its reactions grow beyond all bounds unless nothing loads it; what they do to
    the crank has a limit. The loads stay as they are at the position: only the links move to both sides of it.
    """
    passing, phi = Passages(pos.mechanism), np.atleast_1d(np.asarray(pos.phi, dtype=float))
    rows: dict[str, Floats] = {}
    for angle in passing.every():
        for place in passing.places(angle, phi, passing.together(angle), FORCE_ZONE):
            for k, x in zip(place.which.tolist(), place.x.tolist(), strict=True):
                for name, value in _limits_at(pos, acc, loads, couples, driver, place, k, x).items():
                    rows.setdefault(name, np.full(phi.shape, np.nan))[k] = value
    return {name: Given(row, f"limit: {name}", choice=CHOICE) for name, row in rows.items()}


def _limits_at(pos: Positions, acc: Accelerations, loads: dict[str, list[Load]], couples: dict[str, list[Step]],
               driver: GearForce | InputForce | None, place: PassagePlace, k: int, x: float) -> dict[str, float]:
    """Limits at position ``k``, ``x`` from the change point: of the moments on the crank, and of groups that have one."""
    m, names = pos.mechanism, {id(step): name for name, step in pos.points.items()}
    force = max((abs(value_at(load.vector, k)) for of in loads.values() for load in of), default=0.0)
    moment = force * m.crank.length + max((abs(value_at(c, k)) for of in couples.values() for c in of), default=0.0)
    if not moment > 0:
        return {}
    scales = {TOTAL: moment} | {name: moment / m.crank.length for name, _ in place.sides}

    def told(angles: Floats) -> dict[str, Any]:
        """What the force plans say with the links that far from the change point."""
        there = position_plan(alone(m, m.groups[-1], {name: side * np.sign(angles) for name, side in place.sides}),
                              place.angle + angles, purpose=SEARCHED)
        here = {link: [replace(load, at=there.points[names[id(load.at)]], vector=value_at(load.vector, k)) for load in of]
                for link, of in loads.items()}
        plans = kinetostatics(there, acc, here, {link: [value_at(c, k) for c in of] for link, of in couples.items()}, driver)
        ways = {TOTAL: np.broadcast_to(plans.plan[f"ΣM{m.crank.link}"].value, angles.shape)}
        for name, _ in place.sides:
            closing = plans.plans[name].plan["1"]
            start, u = closing.args[:2]
            ways[name] = ar.dot(u.value, closing.value - start.value)
        return {name: way / scales[name] for name, way in ways.items()}

    found = beside(told, TOTAL)
    return {} if found is None else {name: float(found.at(name, np.array(x))) * scales[name] for name in found.values}
