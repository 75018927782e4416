"""What holds for every mechanism, each as a residual that rounding alone keeps from being zero.

A residual is divided by what it is a small difference of, and, where errors of the data grow on the way, by the condition of
the position: the product of 1/sine of the angle under which the lines of each group cross, and of size over the shortest length
they are measured on. What is left is some units of 1.1e-16 whatever the mechanism.

Two lengths are told apart: the size, how far the mechanism's points are from the crank's pivot, and the reach, how far they are
from the origin. Coordinates are rounded to a share of the reach: half a unit in the last place of a pin's moves every point that
hangs on it by as much times the condition, and its velocity by as much times the angular velocity, whatever is done to it
afterwards. So the condition is that of the size, and what it multiplies is a share of the reach.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.construction.function import Replay, fill
from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.step import Plan, Step
from tmm_sheets.mechanism.groups import PRP, RPP, RPR, RRP, RRR, TRIAD, GroupKind
from tmm_sheets.mechanism.groups.contexts import Load
from tmm_sheets.mechanism.groups.triad import TriadGroup
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.forces import external_loads, kinetostatics, limits_of_forces
from tmm_sheets.methods.linkage.motion import Accelerations, Velocities, acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.positions import Positions, position_plan
from tmm_sheets.methods.linkage.zhukovsky import lever

Residual = tuple[str, Any]
"""Name of the invariant and its residuals, one a position; NaN where there is nothing to say."""

STENCIL = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))
"""Central difference of order 8: steps and weights."""


def cross(u: Any, v: Any) -> Any:
    """Cross product, in the plainest way."""
    return (np.conj(u) * v).imag


def dot(u: Any, v: Any) -> Any:
    """Scalar product, in the plainest way."""
    return (np.conj(u) * v).real


class State:
    """Plans of a mechanism at some crank angles as plain arrays, with their scales; ``gravity`` m/s2."""

    def __init__(self, m: Mechanism, phi: Any, gravity: float = 0.0) -> None:
        self.m, self.gravity = m, gravity
        self.phi = np.asarray(phi, dtype=float)
        self.positions: Positions = position_plan(m, self.phi)
        self.velocities: Velocities = velocity_plan(self.positions)
        self.evaluate(self.positions.plan, self.velocities.plan)
        self.z = {name: self.spread(step) for name, step in self.positions.points.items()}
        self.v = {name: self.spread(step) for name, step in self.velocities.points.items()}
        self.u = {name: self.spread(step) for name, step in self.positions.directions.items()}
        self.omega = {name: self.spread(step) for name, step in self.velocities.omega.items()}
        pivot = m.fixed[m.crank.pivot]
        self.size = self.largest({name: z - pivot for name, z in self.z.items()}) + m.crank.length
        self.reach = self.size + abs(pivot)
        self.built = ~np.isnan(sum(self.z.values()))

    def evaluate(self, *plans: Plan) -> None:
        """Whatever makes values of the steps of plans before they are read: nothing, each step makes its own."""

    def others(self, phi: Any) -> State:
        """The state of the mechanism at other crank angles, evaluated in this way."""
        return type(self)(self.m, phi, self.gravity)

    # Nobody asks for accelerations where only positions and velocities are differentiated.

    @cached_property
    def accelerations(self) -> Accelerations:
        """The acceleration plan."""
        found = acceleration_plan(self.velocities)
        self.evaluate(found.plan)
        return found

    @cached_property
    def loads(self) -> tuple[dict[str, list[Load]], dict[str, list[Step]], Plan]:
        """Weights and forces of inertia of every link, its couples, and their plan."""
        return external_loads(self.positions, self.accelerations, self.gravity)

    @cached_property
    def a(self) -> dict[str, Any]:
        """Accelerations of the points, m/s2."""
        return {name: self.spread(step) for name, step in self.accelerations.points.items()}

    @cached_property
    def epsilon(self) -> dict[str, Any]:
        """Angular accelerations of the links, rad/s2."""
        return {name: self.spread(step) for name, step in self.accelerations.epsilon.items()}

    def spread(self, step: Any) -> Any:
        """Values of a step, one a position."""
        return self.full(step.value)

    def full(self, value: Any) -> Any:
        """A value, one a position."""
        return value if np.shape(value) == self.phi.shape else np.broadcast_to(value, self.phi.shape)

    def largest(self, values: dict[str, Any]) -> Any:
        """Largest magnitude a position, of what there is."""
        return np.nanmax(np.abs(np.array([np.zeros(self.phi.shape), *values.values()])), axis=0)

    @property
    def fastest(self) -> Any:
        """Scale of the velocities: points, and points carried with links."""
        return self.largest(self.v) + self.m.crank.speed * self.m.crank.length + self.largest(self.omega) * self.reach

    @property
    def sharpest(self) -> Any:
        """Scale of the accelerations."""
        turning = (self.largest(self.omega) ** 2 + self.largest(self.epsilon)) * self.reach
        return self.largest(self.a) + self.m.crank.speed**2 * self.m.crank.length + turning

    def guide(self, name: str) -> tuple[Any, Any]:
        """Point and direction of a guide."""
        return self.spread(self.positions.guide_points[name]), self.spread(self.positions.guide_directions[name])

    @property
    def condition(self) -> Any:
        """By how much errors of the data may have grown at each position."""
        total: Any = np.ones(self.phi.shape)
        for g in self.m.groups:
            total = total * np.maximum(1.0, self._condition(g))
        return total

    def _condition(self, g: StructuralGroup) -> Any:
        with np.errstate(divide="ignore", invalid="ignore"):
            found: Any = g.kind.condition(self.positions, g, self.size)
            for name in g.guides:
                found = found * self.size / self._base(name)
            return found

    def _base(self, name: str) -> Any:
        """Distance of the points that tell the direction of a guide; the size for one that is given by its angle."""
        guide = self.m.guides[name]
        if isinstance(guide.through, complex):
            return self.size
        towards = str(guide.towards)
        return np.abs(self.z[towards] - self.z[guide.through]) if towards in self.z else self._base(towards)


class OneFunction(State):
    """A state evaluated by one function for each plan instead of step by step, see :mod:`~tmm_sheets.construction.function`."""

    def evaluate(self, *plans: Plan) -> None:
        """Values of all steps at once."""
        fill((step for plan in plans for step in (*plan, *plan.auxiliaries.values())), self.phi.size)

    def by_steps(self, steps: Iterable[Step]) -> list[Any]:
        """Values that the steps themselves come to."""
        return [self.full(value) for value in Replay([*steps], [self.phi])([self.phi])]


@dataclass(frozen=True)
class Loop:
    """What a kind of group is by its definition: ``residuals``, and by what ``margin`` it assembles, m, beside what reach, m.

    Said here again, in the plainest way, and not asked of the kind: its own construction and conditions of assembly are on trial.
    """

    residuals: Callable[[State, StructuralGroup], Iterator[Residual]]
    margin: Callable[[State, StructuralGroup], tuple[Any, Any]] | None = None


def _two_rods(s: State, g: StructuralGroup) -> Iterator[Residual]:
    (p, q), c = (s.z[name] for name in g.outer), s.z[str(g.inner)]
    for at, length in zip((p, q), g.lengths, strict=True):
        yield "link lengths", np.abs(np.abs(c - at) - length) / s.reach
    yield "assembly side", np.maximum(0, -g.side * cross(q - p, c - p)) / s.size / s.reach


def _two_rods_reach(s: State, g: StructuralGroup) -> tuple[Any, Any]:
    d = np.abs(s.z[g.outer[1]] - s.z[g.outer[0]])
    return np.minimum(sum(g.lengths) - d, d - abs(g.lengths[0] - g.lengths[1])), s.reach + sum(g.lengths)


def _rod_on_guide(s: State, g: StructuralGroup) -> Iterator[Residual]:
    (through, u), p, c = s.guide(g.guides[0]), s.z[g.outer[0]], s.z[str(g.inner)]
    # The direction of a guide is rounded: a turn of 1e-16 about a point far away.
    yield "link lengths", np.abs(np.abs(c - p) - g.lengths[0]) / (s.reach + np.abs(through - c))
    yield "assembly side", np.maximum(0, -g.side * dot(u, c - p)) / s.reach


def _rod_reach(s: State, g: StructuralGroup) -> tuple[Any, Any]:
    (through, u), p = s.guide(g.guides[0]), s.z[g.outer[0]]
    return g.lengths[0] - np.abs(cross(u, through - p)), s.reach + np.abs(through - p) + g.lengths[0]


def _block_on_rocker(s: State, g: StructuralGroup) -> Iterator[Residual]:
    u, r = s.u[g.links[1]], s.z[g.outer[0]] - s.z[g.outer[1]]
    yield "closure on guides", np.abs(cross(u, r) + g.side * g.offset) / s.reach
    # The slider block stays on its side of the rocker's pivot.
    yield "assembly side", np.maximum(0, -dot(u, r)) / s.reach


def _block_in_slot(s: State, g: StructuralGroup) -> Iterator[Residual]:
    yield "closure on guides", np.abs(cross(s.u[g.links[0]], s.z[str(g.inner)] - s.z[g.outer[0]])) / s.reach


def _triangle(s: State, g: StructuralGroup) -> Iterator[Residual]:
    """The sides of the triangle and the three legs, from the points alone."""
    assert isinstance(g, TriadGroup)
    first, second, third = (s.z[leg.corner] for leg in g.legs)
    # The law of cosines by the sine of half the angle: of sides nearly alike and an angle of next to nothing it keeps all digits.
    across = np.hypot(g.sides[0] - g.sides[1], 2 * (g.sides[0] * g.sides[1]) ** 0.5 * np.sin(g.angle / 2))
    for side, length in ((second - first, g.sides[0]), (third - first, g.sides[1]), (third - second, across)):
        yield "link lengths", np.abs(np.abs(side) - length) / s.reach
    for leg in g.legs:
        at = s.z[leg.corner]
        if leg.slot is not None:
            u = (second - first) / g.sides[0] * np.exp(1j * leg.slot)
            yield "closure on guides", np.abs(cross(u, s.z[leg.outer] - at)) / s.reach
        elif not leg.guide:
            yield "link lengths", np.abs(np.abs(at - s.z[leg.outer]) - leg.length) / s.reach


LOOPS: dict[GroupKind, Loop] = {
    RRR: Loop(_two_rods, _two_rods_reach),
    RRP: Loop(_rod_on_guide, _rod_reach),
    RPR: Loop(_block_on_rocker, lambda s, g: (np.abs(s.z[g.outer[1]] - s.z[g.outer[0]]) - g.offset, s.reach + g.offset)),
    PRP: Loop(lambda s, g: iter(())),
    RPP: Loop(_block_in_slot),
    TRIAD: Loop(_triangle),
}


def geometry(s: State) -> Iterator[Residual]:
    """Lengths of links, closures on guides, sides of assembly, points fixed on links."""
    for g in s.m.groups:
        yield from LOOPS[g.kind].residuals(s, g)
        for at, name in g.kind.guided(g):
            p, u = s.guide(name)
            reach = s.reach + np.abs(s.z[at] - p)
            yield "closure on guides", np.abs(cross(u, s.z[at] - p)) / reach
        for link in g.links:
            yield "link lengths", np.abs(np.abs(s.u[link]) - 1)
    for point in s.m.points:
        yield "link lengths", np.abs(np.abs(s.z[point.name] - s.z[point.start]) - abs(point.distance)) / s.reach


def alike(s: State) -> Iterator[Residual]:
    """What one function makes of the plans against what their steps make of them.

    They round differently, and a bad condition makes more of that in velocities and accelerations.
    """
    if not isinstance(s, OneFunction):
        return
    name = "one function = its steps"
    for steps, found, scale in ((s.positions.points, s.z, s.reach), (s.velocities.points, s.v, s.fastest),
                                (s.accelerations.points, s.a, s.sharpest)):
        for own, value in zip(s.by_steps(steps.values()), found.values(), strict=True):
            yield name, np.where(np.isnan(own) == np.isnan(value), np.abs(value - own) / (scale * s.condition), 1.0)


def rigidity(s: State) -> Iterator[Residual]:
    """Velocities and accelerations of points on one link, and of points that slide on another.

    A link turns as two of its points tell: half a unit in the last place of either's velocity turns it by that over their
    distance, and moves a point as many times farther away by as many times more.
    """
    fastest, sharpest = s.fastest, s.sharpest
    for link in s.m.links:
        names = [p.name for p in s.m.pairs if link in p.links and p.motion == "rotation"]
        names += [p.name for p in s.m.points if p.link == link]
        w, e = s.omega[link], s.epsilon[link]
        told = s.velocities.reference.get(link)
        base = s.size if told is None else np.abs(s.z[told[1]] - s.z[told[0]])
        for p in names[1:]:
            r = s.z[p] - s.z[names[0]]
            far = np.maximum(1.0, np.abs(r) / base)
            yield "velocity closure", np.abs(s.v[p] - s.v[names[0]] - 1j * w * r) / (fastest * far)
            yield "acceleration closure", np.abs(s.a[p] - s.a[names[0]] - (1j * e - w * w) * r) / (sharpest * far)
    for g in s.m.groups:
        for link, name in g.kind.sliders(g):
            guide, point = s.m.guides[name], g.kind.block(g, link)
            at, (through, u) = s.z[point], s.guide(name)
            carried: Any = 0j if guide.link == s.m.frame else s.velocities.coincident.get(
                on_link(point, guide.link), s.velocities.points[str(guide.through)])
            if guide.link != s.m.frame:
                start = str(guide.through)
                base = s.velocities.coincident.get(on_link(start, guide.link), s.velocities.points[start])
                carried = s.spread(base) + 1j * s.omega[guide.link] * (at - through)
            yield "velocity closure", np.abs(cross(u, s.v[point] - carried)) / fastest


def assembled(s: State) -> Iterator[Residual]:
    """NaN exactly where a group cannot assemble: how far from its limit it is where the plan says otherwise."""
    for g in s.m.groups:
        loop = LOOPS[g.kind]
        if loop.margin is None:
            continue
        margin, reach = loop.margin(s, g)
        there = ~np.isnan(margin)
        built = ~np.isnan(s.z[g.inner] if g.inner else s.u[g.links[1]])
        yield "NaN exactly where it cannot assemble", np.where(there & (built != (margin >= 0)), np.abs(margin) / reach, 0.0)
    # Nor may a velocity or acceleration be missing where the lines cross.
    missing = np.isnan(sum(s.v.values()) + sum(s.a.values()))
    yield "NaN exactly where it cannot assemble", np.where(s.built & missing & (s.condition < CROSSING), 1.0, 0.0)


CROSSING = 1e8
"""Condition up to which lines surely cross, in doubles."""

TELLING = 100.0
"""Condition up to which differences of positions can tell anything about velocities."""


def slopes(s: State, k: Any, h: Any) -> tuple[State, Callable[[Any], Any]]:
    """The mechanism beside positions ``k``, by steps ``h``, rad, and how to differentiate its values over the crank angle."""
    around = s.phi[k] + np.multiply.outer([n * sign for n, _ in STENCIL for sign in (1, -1)], h + 0 * s.phi[k])
    step = (around[0::2] - around[1::2]) / (2 * np.array([[n] for n, _ in STENCIL]))  # as it is after rounding

    def slope(values: Any) -> Any:
        values = values.reshape(around.shape)
        return sum(weight * (values[2 * i] - values[2 * i + 1]) / step[i] for i, (_, weight) in enumerate(STENCIL))

    return s.others(around.ravel()), slope


def derivatives(s: State) -> Iterator[Residual]:
    """Differences of positions against velocities, of velocities against accelerations, of energy against the crank's power."""
    condition = np.where(s.built, s.condition, np.inf)
    k = np.flatnonzero(condition < TELLING)
    if not len(k):
        return
    # Lines that cross under a sine are parallel about so far away, links in line its square: the steps stay well within.
    h = 0.02 / condition[k] * np.minimum(1.0, s.m.crank.speed / np.sqrt((s.largest(s.omega) ** 2 + s.largest(s.epsilon))[k]))
    other, slope = slopes(s, k, h)
    w = s.m.crank.omega
    e = s.m.crank.sense * s.m.crank.acceleration
    for name in s.z:
        yield "derivative of position = velocity", np.abs(slope(other.z[name]) * w - s.v[name][k]) / s.fastest[k]
        # The plan's velocities belong to one speed of the crank.
        rate = slope(other.v[name]) * w + s.v[name][k] * e / w
        yield "derivative of velocity = acceleration", np.abs(rate - s.a[name][k]) / s.sharpest[k]
    beside = energy(other)
    change = slope(sum(beside)) * w + 2 * energy(s)[0][k] * e / w
    # The kinetic energy beside the position: in it everything may stand still. Heights are rounded to a share of the reach.
    kinetic = beside[0].reshape(-1, len(k)).max(axis=0)
    weight = s.gravity * sum(link.mass for link in s.m.links.values())
    rate = (s.largest(s.omega) + np.sqrt(s.largest(s.epsilon)))[k]
    scale = (kinetic * rate + powers(s)[k]) * (s.reach / s.size)[k] + weight * s.reach[k] * rate
    yield "power = change of energy", np.where(scale > 0, np.abs(balancing(s)[k] * w - change) / scale, 0.0)


def energy(s: State) -> tuple[Any, Any]:
    """Kinetic energy of all links, J, and potential energy about the crank pivot."""
    kinetic, potential = np.zeros(s.phi.shape), np.zeros(s.phi.shape)
    for link in s.m.links.values():
        kinetic = kinetic + link.inertia * s.omega[link.name] ** 2 / 2
        if link.centre is not None:
            kinetic = kinetic + link.mass * np.abs(s.v[link.centre]) ** 2 / 2
            potential = potential + link.mass * s.gravity * (s.z[link.centre] - s.m.fixed[s.m.crank.pivot]).imag
    return kinetic, potential


def powers(s: State) -> Any:
    """Sum of the magnitudes of all powers, W."""
    total = np.zeros(s.phi.shape)
    for link in s.m.links.values():
        total = total + link.inertia * np.abs(s.omega[link.name] * s.epsilon[link.name])
        if link.centre is not None:
            total = total + link.mass * (s.gravity + np.abs(s.a[link.centre])) * np.abs(s.v[link.centre])
    return total


def by_plans_and_lever(s: State) -> tuple[Any, Any]:
    """Balancing moment from the force plans, with its limits in change points, and from the lever, N m."""
    loads, couples, _ = s.loads
    limits = limits_of_forces(s.positions, s.accelerations, loads, couples, None)
    return s.spread(kinetostatics(s.positions, s.accelerations, loads, couples, None, limits=limits).balancing), balancing(s)


def statics(s: State) -> Iterator[Residual]:
    """Forces of every polygon, forces and moments on every link; balancing moment from the reactions and from the lever."""
    m = s.m
    loads, link_couples, _ = s.loads
    forces = kinetostatics(s.positions, s.accelerations, loads, link_couples, None)
    on_lever = lever(s.velocities, forces.external, link_couples, None)
    s.evaluate(forces.plan, *(fp.plan for fp in forces.plans.values()), on_lever.plan)
    balance = on_lever.balancing
    reactions = {name: s.spread(step) for name, step in forces.reactions.items()}
    outer = [s.spread(load.vector) for load in forces.external]
    strongest = s.largest({str(i): f for i, f in enumerate([*reactions.values(), *outer])})
    couples = {str(i): s.spread(c) for i, c in enumerate(c for of in forces.link_couples.values() for c in of)}
    couples |= {name: s.spread(c) for name, c in forces.couples.items()}
    # Far from the origin the pin's own coordinates are that much worse than the crank.
    total = strongest * s.reach + s.largest(couples) * s.reach / m.crank.length

    def from_outside(links: tuple[str, ...]) -> Any:
        """Sum of the reactions on some links from all others."""
        names = (f"F{pair_index(a, b)}" for a in links for b in (m.frame, *m.links) if b not in links)
        return sum((reactions[name] for name in names if name in reactions), np.zeros(s.phi.shape, dtype=complex))

    with np.errstate(divide="ignore", invalid="ignore"):
        for link in m.links:
            pull: Any = sum((s.spread(load.vector) for load in loads[link]), from_outside((link,)))
            yield "equilibrium of every link", np.where(strongest > 0, np.abs(pull) / strongest, 0.0)
        for plan in forces.plans.values():
            pull = from_outside(plan.links)
            for link in plan.links:
                pull = sum((s.spread(load.vector) for load in loads[link]), pull)
            yield "polygon closure", np.where(strongest > 0, np.abs(pull) / strongest, 0.0)
        assert balance is not None
        for turn in _moments(s, loads, link_couples, forces, reactions).values():
            yield "moments on every link", np.where(total > 0, np.abs(turn) / total, 0.0)
        by_statics, by_lever = s.spread(forces.balancing), s.spread(balance)
        scale = (total + strongest * s.fastest / m.crank.speed) * s.condition
        yield "lever = kinetostatics", np.where(total > 0, np.abs(by_statics - by_lever) / scale, 0.0)


def _moments(s: State, loads: Any, link_couples: Any, forces: Any, reactions: dict[str, Any]) -> dict[str, Any]:
    """Sum of moments about the crank pivot of everything that acts on each link, from the pairs alone, N m."""
    pivot = s.z[s.m.crank.pivot]
    turn: dict[str, Any] = {link: np.zeros(s.phi.shape) for link in s.m.links}
    for link, total in turn.items():
        for load in loads[link]:
            total += cross(s.spread(load.at) - pivot, s.spread(load.vector))
        for couple in link_couples.get(link, ()):
            total += s.spread(couple)
    turn[s.m.crank.link] += s.spread(forces.balancing)
    for pair in s.m.pairs:
        at = s.z[pair.name.rstrip("′″")]
        for me, other in (pair.links, pair.links[::-1]):
            if me in turn:
                turn[me] += cross(at - pivot, reactions[f"F{pair_index(me, other)}"])
                if pair.motion == "translation":
                    mine = forces.couples.get(f"F{pair_index(me, other)}")
                    turn[me] += s.spread(mine) if mine is not None else -s.spread(forces.couples[f"F{pair_index(other, me)}"])
    return turn


def balancing(s: State) -> Any:
    """Balancing moment of the lever, N m."""
    loads, couples, _ = s.loads
    on_lever = lever(s.velocities, [load for of_link in loads.values() for load in of_link], couples, None)
    s.evaluate(on_lever.plan)
    return s.spread(on_lever.balancing)
