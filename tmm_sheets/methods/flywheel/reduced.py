"""Reduced moment of forces and reduced moment of inertia over the crank angle, as steps on velocity plans.

At the numbered positions the velocity plans are those of the study; at other angles (middles of intervals, borders, contacts,
nodes of a quadrature) plans of their own are drawn, so the flywheel may ask for ten positions or a million.
Source: manual 000, section 5.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property, reduce
from operator import add
from typing import Any

import numpy as np

from tmm_sheets.construction.function import Replay
from tmm_sheets.construction.rules import GIVEN_INERTIA, taken
from tmm_sheets.construction.step import Given, Plan, Rule, Step, named, value_of
from tmm_sheets.mechanism.model import Link, Mechanism
from tmm_sheets.methods.flywheel.flywheel import WITHOUT_CRANK
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.methods.linkage.loads import Applied, distinct
from tmm_sheets.methods.linkage.motion import Accelerations, Velocities, acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.positions import Passages, Positions, position_plan
from tmm_sheets.words import marked, tr

_SOURCE = "000, 5"

POWER = Rule("power of a force", lambda f, v: (f * np.conj(v)).real, ("force", "point"), "number",
             marked("Power of the force {0} by the velocity polygon, segment p{1}: {name} = F·V·cos(F̅, V̅) = {value} W."),
             unit="W", source=_SOURCE)
MOMENT_POWER = Rule("power of a moment", lambda m, w: m * w, ("number", "number"), "number",
                    marked("Power of the moment: {formula}."), unit="W", source=_SOURCE)
WEIGHT_POWER = Rule("power of a weight", lambda m, g, v: -(m * g * np.imag(v)), ("number", "number", "point"), "number",
                    marked("Power of the weight {0}·{1} N by the velocity polygon, segment p{2}: {name} = {value} W."), unit="W",
                    source="002, 1.5")
REDUCED_MOMENT = Rule("reduced moment", lambda omega, *powers: reduce(add, powers) / omega, ("number",) * 9, "number",
                      marked("Reduced moment of forces {name} = ΣN/ω1 = {value} N·m."), unit="N*m", source=_SOURCE)
TRANSLATION = Rule("twice the energy of a centre of mass", lambda m, v: m * (v * np.conj(v)).real, ("number", "point"), "number",
                   marked("{name} = {0}·V² = {value} J, V from the segment p{1}."), unit="J", source=_SOURCE)
ROTATION = Rule("twice the energy of rotation", lambda j, w: j * w * w, ("number", "number"), "number",
                marked("{formula}."), unit="J", source=_SOURCE, textbook=lambda j, w: j * w**2)
REDUCED_INERTIA = Rule("reduced moment of inertia", lambda omega, *terms: reduce(add, terms) / omega**2, ("number",) * 20, "number",
                       marked("Reduced moment of inertia {name} = Σ/ω1² = {value} kg·m²."), unit="kg*m2", source=_SOURCE)
TURNING_SLOPE = Rule("power of the inertia of rotation", lambda j, w, e: j * w * e, ("number",) * 3, "number",
                     marked("For the derivative: {formula}."), unit="W")
MOVING_SLOPE = Rule("power of the inertia of a centre of mass", lambda m, a, v: m * (a * np.conj(v)).real,
                    ("number", "point", "point"), "number",
                    marked("For the derivative, from the segments π{1} and p{2}: {name} = {0}·a·V·cos(a̅, V̅) = {value} W."),
                    unit="W")
INERTIA_SLOPE = Rule("slope of the reduced moment of inertia", lambda omega, *parts: 2 * reduce(add, parts) / omega**3,
                     ("number",) * 20, "number", marked("{name} = 2Σ/ω1³ = {value} kg·m²."), unit="kg*m2", source="002, 1.12")
CRANK_INERTIA = Rule("moment of inertia about the pivot", lambda j, m, s, o: j + m * np.abs(s - o) ** 2,
                     ("number", "number", "point", "point"), "number", marked("{name} = {0} + {1}·|{3}{2}|² = {value} kg·m²."),
                     unit="kg*m2")
AT_START = taken("moment of inertia of the crank", "kg*m2", marked("At any position {name} = {value} kg·m²."))
EVERYWHERE = Rule("the same at all positions", lambda x, phi: x + 0 * phi, ("number", "number"), "number",
                  marked("{name} = {0} at all positions."))


TRIED = "@search"
"""Behind the names of plans that nobody keeps: they are counted."""
PURPOSE = "reduced quantities"
"""What they are made for."""
MOMENT = "moment"
"""The quantity that loads are chosen for."""


class Reduction:
    """Reduced quantities at some angles; steps are recorded when they are asked for, nothing is computed before it is read.

    Parameters
    ----------
    reduced
        of the mechanism.
    where
        what the angles are, behind the names of the plans: "@middles"; nothing for the numbered positions.
    phi
        angles turned from position 0, rad, of any shape.
    labels
        their names.
    drawn
        the velocity plans where there are some already.
    """

    def __init__(self, reduced: Reduced, where: str, phi: Any, labels: tuple[str, ...] = ("",),
                 drawn: Callable[[], Velocities] | None = None) -> None:
        self.reduced = reduced
        self.where = where
        self.phi = phi
        self.labels = labels
        self._drawn = drawn
        self.purpose = PURPOSE if where == TRIED else ""
        search = reduced.mechanism.search(self.purpose)
        self.plan = Plan(f"reduction{where}", tr("Reduction of forces and masses"), "", labels, search=search)
        self.slope_plan = Plan(f"inertia-slope{where}", tr("Derivative of the reduced moment of inertia"), "", labels,
                               search=search)
        self.loads: dict[str, Step] = {}
        self.over = Given(phi, "cycle", "φ_1", "rad")
        self.turned = reduced.cycle.turned_row(phi)
        self.angles = reduced.cycle.angles(phi) if drawn is None else None
        self.chosen: list[Given] = []

    @cached_property
    def velocities(self) -> Velocities:
        """Velocity plans at the angles."""
        if self._drawn is not None:
            return self._drawn()
        return velocity_plan(position_plan(self.reduced.mechanism, self.angles, self.labels, self.where, self.purpose))

    @cached_property
    def accelerations(self) -> Accelerations:
        """Acceleration plans of the evenly turning crank at the angles."""
        return acceleration_plan(self.velocities, 0.0, "" if self.where else "@even")

    @property
    def plans(self) -> tuple[Plan, ...]:
        """The plans that were drawn for these angles, in order."""
        own = vars(self).get("velocities") if self._drawn is None else None
        further = vars(self).get("accelerations")
        return (*((own.positions.plan, own.plan) if own else ()), *((further.plan,) if further else ()), self.plan,
                *((self.slope_plan,) if self.slope_plan.steps else ()))

    def moment(self, side: int = 1) -> Step:
        """Reduced moment of the technological forces, and of the weights where they count, N m; ``side`` picks the limit at a jump.

        Step ``M``; before a jump ``M(−)``, between two jumps that fall together ``M(0)``.
        """
        mark = {1: "", 0: "(0)", -1: "(−)"}[side]
        if f"M{mark}" in self.plan:
            return self.plan[f"M{mark}"]
        vel, r, plan = self.velocities, self.reduced, self.plan
        powers: list[Any] = []
        for f in r.forces:
            chosen = f.chosen(self.phi, side)
            load = self.loads[f"{f.name}{mark}"] = f.record(plan, vel.positions, self.turned, side, mark, chosen)
            self.chosen += chosen
            powers.append(plan.add(f"N_{load.name}", MOMENT_POWER, load, vel.omega[f.link]) if f.point is None else
                          plan.add(f"N_{load.name}", POWER, load, vel.points[f.point]))
        if r.gravity:
            for link in r.mechanism.links.values():
                if link.mass and link.centre is not None:
                    powers.append(plan.add(f"N_G{link.name}{mark}", WEIGHT_POWER, link.mass,
                                           named(r.gravity, "forces.gravity", "g", "m/s2"), vel.points[link.centre]))
        nothing = () if powers else (Given(np.zeros(np.shape(self.phi)), "force", unit="W"),)
        return plan.add(f"M{mark}", REDUCED_MOMENT, r.omega, *powers, *nothing)

    @cached_property
    def terms(self) -> Mapping[str, Step]:
        """Twice the kinetic energy of each link, term by term, kg m2/s2, by names in lettering markup."""
        found: dict[str, Step] = {}
        vel, r = self.velocities, self.reduced
        for link in r.mechanism.links.values():
            n = link.name
            if link.pivot_inertia is not None:
                found[f"J_{{{n}}}·ω_{n}²"] = self.plan.add(f"J{n}ω{n}²", ROTATION, turning(link), vel.omega[n])
                continue
            if r.moves(link):
                assert link.centre is not None
                found[f"m_{n}·V_{{{link.centre}}}²"] = self.plan.add(
                    f"m{n}V_{link.centre}²", TRANSLATION, link.mass, vel.points[link.centre])
            if link.inertia:
                found[f"J_{{S{n}}}·ω_{n}²"] = self.plan.add(f"J_S{n}ω{n}²", ROTATION, turning(link), vel.omega[n])
        return found

    @cached_property
    def inertia(self) -> Step:
        """Reduced moment of inertia of the moving links without the flywheel, kg m2: step ``J``."""
        return self._sum(self.plan, "J", REDUCED_INERTIA, list(self.terms.values()))

    @property
    def crank_alone(self) -> bool:
        """True where nothing but the crank has inertia: the others' is nothing then, not what rounding leaves."""
        return set(self.terms) <= self.reduced.crank_terms

    @cached_property
    def others(self) -> Step:
        """Reduced moment of inertia without the crank's part: step ``J_II``."""
        if self.crank_alone:
            return self.plan.add("J_II", EVERYWHERE, 0.0, self.over)
        return self.plan.add("J_II", WITHOUT_CRANK, self.inertia, self.reduced.crank)

    @cached_property
    def slope(self) -> Step:
        """Derivative of the reduced moment of inertia over the crank angle, kg m2/rad: step ``dJ/dφ``.

        From the acceleration plan of the evenly turning crank: half the derivative of each term of twice the energy is force
        of inertia times velocity.
        """
        vel, acc, r = self.velocities, self.accelerations, self.reduced
        parts: list[Step] = []
        for link in () if self.crank_alone else r.mechanism.links.values():
            n = link.name
            if turning(link):
                parts.append(self.slope_plan.add(f"J{n}ω{n}ε{n}", TURNING_SLOPE, turning(link), vel.omega[n], acc.epsilon[n]))
            if link.pivot_inertia is None and r.moves(link):
                assert link.centre is not None
                parts.append(self.slope_plan.add(f"m{n}a_{link.centre}V_{link.centre}", MOVING_SLOPE, link.mass,
                                           acc.points[link.centre], vel.points[link.centre]))
        return self._sum(self.slope_plan, "dJ/dφ", INERTIA_SLOPE, parts)

    def _sum(self, plan: Plan, name: str, rule: Rule, parts: list[Step]) -> Step:
        """Sum of terms by a rule, a number at every angle also where no term changes."""
        if not parts:
            parts = [plan.add(f"{name}0", EVERYWHERE, 0.0, self.over)]
        elif np.shape(self.phi) and all(self.reduced.even(step) for step in parts):
            parts = [plan.add(f"{step.name}′", EVERYWHERE, step, self.over) for step in parts]
        return plan.add(name, rule, self.reduced.omega, *parts)


def turning(link: Link) -> float:
    """Moment of inertia of a link that counts for its energy of rotation, kg m2."""
    return link.inertia if link.pivot_inertia is None else link.pivot_inertia


def turning_back(m: Mechanism, cycle: Cycle) -> list[float]:
    """Angles turned, rad, at which links turn back at once: change points of groups that keep their side."""
    changes = [a for g in m.groups if not g.follow for a in Passages(m).angles(g)]
    once = [float(np.mod(cycle.sense * (a - cycle.start), 2 * np.pi)) for a in changes]
    return [x + 2 * np.pi * n for x in once for n in range(round(cycle.period / (2 * np.pi)))]


class Reduced:
    """Reduced quantities of a mechanism over one period (see the flywheel's methods for how they are used).

    ``labels``, ``phi`` (n+1 angles turned from position 0, rad, the last one ``period``), ``omega1`` rad/s unsigned.
    ``drawn`` gives the velocity plans of the numbered positions; they are drawn when none are given.
    """

    def __init__(self, mechanism: Mechanism, cycle: Cycle, forces: tuple[Applied, ...], gravity: float = 0.0,
                 drawn: Callable[[], Velocities] | None = None) -> None:
        self.mechanism = mechanism
        self.cycle = cycle
        self.forces = forces
        self.gravity = gravity
        self.labels = cycle.labels
        self.phi = np.append(cycle.turned, cycle.period)
        self.period = cycle.period
        self.omega1 = mechanism.crank.speed
        self.omega = named(self.omega1, "crank.speed", "ω_1", "rad/s")
        self.breaks = tuple(x for x in distinct((*(x for f in forces for x in f.jumps), *turning_back(mechanism, cycle)),
                                                cycle.period) if x > 0)
        self.numbered = Reduction(self, "" if drawn else "@positions", cycle.turned, cycle.labels, drawn)
        self.kept: dict[str, Reduction] = {}
        self._replays: dict[tuple[str, int], Replay] = {}

    def at(self, where: str, phi: Any, labels: tuple[str, ...] | None = None) -> Reduction:
        """Reduced quantities at some angles with plans that are kept under the name ``@where``."""
        found = self.kept.get(where)
        if found is None or not np.array_equal(found.phi, phi):
            if found is not None:
                self._count(found)
            found = self.kept[where] = Reduction(self, f"@{where}", phi, labels or ("",) * np.size(phi))
        return found

    def _count(self, tried: Reduction) -> None:
        """Plans that finer ones replace were a search."""
        tally = self.mechanism.search("quadrature")
        assert tally is not None
        for plan in tried.plans:
            tally.plans += 1
            for step in (*plan, *plan.auxiliaries.values()):
                if step.evaluated:
                    tally.append(sum(step.seconds))

    def _tried(self, phi: Any, what: str, pick: Callable[[Reduction], Step], side: int = 0) -> Any:
        """A quantity at angles that are only tried: its plans are recorded once, done again at other angles, and kept by nobody."""
        if (replay := self._replays.get((what, side))) is None:
            at = Reduction(self, TRIED, phi)
            step = pick(at)
            found = Replay([step], [at.angles, at.turned, at.over, *at.chosen])
            # Without any load the moment hangs on no angle: it is nothing in the shape of those it was recorded for.
            if np.ndim(phi) and len(found) and not at.velocities.positions.chosen:
                self._replays[what, side] = found
            return step.value
        chosen = (row.value for f in self.forces for row in f.chosen(phi, side)) if what == MOMENT else ()
        (value,) = replay([value_of(self.cycle.angles(phi)), phi, phi, *chosen], self.mechanism.search(PURPOSE))
        return value

    @cached_property
    def resisting(self) -> bool:
        """True for a working machine, False for an engine: its forces do work over the cycle."""
        middles = (np.arange(360) + 0.5) * self.period / 360
        return float(np.sum(self.moment(middles))) <= 0

    def moment(self, phi: Any, side: int = 0) -> Any:
        """Reduced moment of the technological forces, and of the weights where ``gravity`` is not zero, N m.

        Resistances are negative; ``side`` picks the limit at a jump.
        """
        return self._tried(phi, MOMENT, lambda at: at.moment(side), side)

    @property
    def forces_are_moments(self) -> bool:
        """True where the task has technological moments only."""
        return bool(self.forces) and all(f.point is None for f in self.forces)

    def forces_at(self, phi: Any, side: int = 0) -> dict[str, Any]:
        """Technological forces as graphs show them, N, by their signs in lettering markup; moments, N m, if there are none."""
        shown = [f for f in self.forces if f.point is not None] or self.forces
        return {_sign(f): np.asarray(f.shown(phi, side)) for f in shown}

    @property
    def moments_beside(self) -> tuple[str, ...]:
        """Signs of technological moments beside forces: :meth:`forces_at` tells nothing of them."""
        return () if self.forces_are_moments else tuple(_sign(f) for f in self.forces if f.point is None)

    @property
    def force_steps(self) -> tuple[Step, ...]:
        """Steps of the forces that :meth:`forces_at` tells, in its order, at the numbered positions."""
        _ = self.numbered.moment()
        shown = [f for f in self.forces if f.point is not None] or self.forces
        return tuple(self.numbered.loads[f.name] for f in shown)

    def inertia(self, phi: Any) -> Any:
        """Reduced moment of inertia of the moving links without the flywheel, kg m2."""
        return self._tried(phi, "inertia", lambda at: at.inertia)

    @property
    def crank_inertia(self) -> float:
        """The crank's own part of the reduced moment of inertia, constant, kg m2."""
        return float(self.crank.value)

    @cached_property
    def crank(self) -> Step:
        """The crank's own part as a step: ``J_кр`` of the plan "crank-inertia"."""
        m, plan = self.mechanism, self.crank_plan
        crank = m.links[m.crank.link]
        if crank.pivot_inertia is not None or not self.moves(crank):
            return plan.add("J_кр", GIVEN_INERTIA, turning(crank), symbol=tr("J_cr"))
        assert crank.centre is not None
        pos = self._at_start
        at_start = plan.add("J_1", CRANK_INERTIA, turning(crank), crank.mass, pos.points[crank.centre],
                            pos.points[m.crank.pivot])
        return plan.add("J_кр", AT_START, at_start, 0, symbol=tr("J_cr"))

    @cached_property
    def crank_plan(self) -> Plan:
        """Plan of the crank's own moment of inertia."""
        return Plan("crank-inertia", tr("Moment of inertia of the input link"), "")

    @cached_property
    def _at_start(self) -> Positions:
        return position_plan(self.mechanism, np.array([self.cycle.start]), where="@start")

    @property
    def crank_plans(self) -> tuple[Plan, ...]:
        """Plans behind :attr:`crank`."""
        _ = self.crank
        start = vars(self).get("_at_start")
        return (*((start.plan,) if start else ()), self.crank_plan)

    def moves(self, link: Link) -> bool:
        """True for a link whose centre of mass has a velocity to be counted."""
        return bool(link.mass) and link.centre is not None and link.centre not in self.mechanism.fixed

    def even(self, step: Step) -> bool:
        """True for a term that is one number for all angles: of a link that turns evenly or not at all."""
        return not any(np.ndim(a.value) for a in step.args if isinstance(a, Step))

    def parts(self, at: Reduction) -> dict[str, Any]:
        """The terms of the reduced moment of inertia without the crank's, kg m2, by the names of :attr:`inertia_terms`."""
        return {name: np.broadcast_to(term.value / self.omega1**2, np.shape(at.phi))
                for name, term in at.terms.items() if name not in self.crank_terms}

    @property
    def crank_terms(self) -> frozenset[str]:
        """Names of the crank's own terms."""
        n = self.mechanism.crank.link
        return frozenset((f"J_{{{n}}}·ω_{n}²", f"J_{{S{n}}}·ω_{n}²", f"m_{n}·V_{{{self.mechanism.links[n].centre}}}²"))

    @property
    def inertia_terms(self) -> dict[str, Any]:
        """Twice the kinetic energy of each link, term by term, at the numbered positions, kg m2/s2."""
        return {name: np.broadcast_to(term.value, np.shape(self.numbered.phi)) for name, term in self.numbered.terms.items()}


def _sign(load: Any) -> str:
    """Sign of a load in lettering markup."""
    return f"{load.name[0]}_{{{load.name[1:]}}}"
