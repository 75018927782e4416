"""Position plan by intersecting arcs (метод засечек), group by group in order of attachment.

Source: manual 000, section 3.1; manual 002, section 1.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from math import inf, pi
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import rules
from tmm_sheets.construction.expression import Floats, Points, Reals, primitive
from tmm_sheets.construction.limit_angles import at_rest
from tmm_sheets.construction.step import Given, Plan, Rule, Step, value_of
from tmm_sheets.mechanism.groups.contexts import SWEEP, Crossing, SpecialPoint, Turning
from tmm_sheets.mechanism.groups.dead_centres import near_point
from tmm_sheets.mechanism.groups.three_legs import Course, course
from tmm_sheets.mechanism.groups.triad import TRIAD, TriadGroup
from tmm_sheets.mechanism.model import Guide, Mechanism, StructuralGroup
from tmm_sheets.numbers import NOISE
from tmm_sheets.words import tr


@dataclass
class Positions:
    """Position plan of a mechanism: points complex, m, shape (n,); NaN where a group does not assemble.

    ``directions`` are unit vectors of the links, from the first named point of each to its next; ``feet`` name, for rockers
    with an offset, the foot of the perpendicular from the pivot on the slot. ``sines`` are, by the first link of a group next to
    the crank, those of the angle between its lines in the plans of velocities, where they are known better than the lines;
    ``turnings`` tell how it turns, by the same, where it has change points.
    ``value`` reads that of a step: of a plan recorded for a search also what it is at other angles than its own.
    ``special`` are Assur's special points of groups of class III by their names, ``false`` the plans of their false positions by
    the groups' names.
    """

    mechanism: Mechanism
    plan: Plan
    angle: Any
    where: str = ""
    points: dict[str, Step] = field(default_factory=dict)
    directions: dict[str, Step] = field(default_factory=dict)
    guide_points: dict[str, Step] = field(default_factory=dict)
    guide_directions: dict[str, Step] = field(default_factory=dict)
    contact: Step | None = None
    rays: dict[tuple[str, str], Step] = field(default_factory=dict)
    feet: dict[str, str] = field(default_factory=dict)
    sines: dict[str, Step] = field(default_factory=dict)
    turnings: dict[str, Turning] = field(default_factory=dict)
    special: dict[str, SpecialPoint] = field(default_factory=dict)
    false: dict[str, Plan] = field(default_factory=dict)
    value: Callable[[Step], Any] = value_of

    @property
    def phi(self) -> Any:
        """World angles of the crank, rad; ``angle`` is the step or the row they come from."""
        return value_of(self.angle)

    def known_sine(self, group: StructuralGroup) -> tuple[Step, ...]:
        """The sine between a group's lines as a further argument of the rule that crosses them, where it is known."""
        sine = self.sines.get(group.links[0])
        return () if sine is None else (sine,)

    def direction(self, p: str, q: str) -> Step:
        """Step of the direction from point ``p`` to ``q``, drawn once."""
        if (p, q) not in self.rays:
            self.rays[p, q] = self.plan.add(self.plan.free(p + q), rules.RAY, self.place(p), self.place(q))
        return self.rays[p, q]

    def place(self, name: str) -> Step:
        """A point of the mechanism or a special point by its name."""
        return self.special[name].step if name in self.special else self.points[name]

    def course(self, group: StructuralGroup) -> Course:
        """Way of assembly of a group of class III round the turn, followed once for a mechanism."""
        assert isinstance(group, TriadGroup)
        known = self.mechanism.courses
        if group.name not in known:
            known[group.name] = course(lambda phi: TRIAD.before(
                position_plan(self.mechanism, phi, purpose=FOLLOWED, until=group), group), group.when, group.near)
        return cast("Course", known[group.name])

    @property
    def chosen(self) -> bool:
        """True where something is chosen by the very crank angles: special points, change points of groups that hang on others."""
        return bool(self.special) or any(turning.first is None for turning in self.turnings.values())

    def side(self, group: StructuralGroup) -> Any:
        """On which side a group is put together, +1 or -1: a step where it changes in change points."""
        turning = self.turnings.get(group.links[0])
        return group.side if turning is None else turning.side

    def crossing(self, group: StructuralGroup) -> tuple[Step, ...]:
        """Further arguments of the rule that makes a group's crossing, where the crank angle knows better than the points."""
        found = group.kind.crossing(self.mechanism, group, self.angle) or self._passage(group)
        if found is None:
            return ()
        self.sines[group.links[0]] = found.sine
        for step in found.steps:
            self.plan.add_existing(step)
        if found.turning is not None:
            self.turnings[group.links[0]] = found.turning
        return found.known

    def _passage(self, group: StructuralGroup) -> Crossing | None:
        """Crossing of a group that hangs on others and has change points."""
        passing = Passages(self.mechanism)
        angles = passing.angles(group)
        if not angles:
            return None
        side: Any = group.side
        if group.follow:
            cut = group.at if group.cut is None else group.cut
            side = Step(f"side {group.name}", SIDE, (self.angle, side, group.at, cut, self.mechanism.crank.sense, *angles))
        return group.kind.passage(self, group, side, passing.row(group, self.phi, ROOT, _root, zero=True))


ROOT = "root of the gaps"


def _root(m: Mechanism, phi: Any) -> Any:
    """Root of the product of the gaps of the last group, which changes its sides with its sign."""
    group = m.groups[-1]
    p, q, _ = group.kind.gaps_at(position_plan(m, phi, purpose=SEARCHED), group)
    with np.errstate(invalid="ignore"):
        return np.sqrt(p * q) * group.side


SEARCHED = "change points"


FOLLOWED = "ways of assembly"


def position_plan(mechanism: Mechanism, phi: Any, labels: tuple[str, ...] = ("",), where: str = "", purpose: str = "",
                  until: StructuralGroup | None = None) -> Positions:
    """Record the position plan for crank angles ``phi`` (rad, world frame, counter-clockwise), shape (n,).

    They may be numbers, a row or a step. ``where`` stands behind the names of this plan and of those made on it: "@middles" for
    angles between the positions. ``purpose`` is what the plan searches for, when it is neither drawn nor told: it is counted then.
    ``until`` is the group before which the plan ends; none of them unless told.
    """
    plan = Plan(f"positions{where}", tr("Positions of the mechanism"), "m", labels, search=mechanism.search(purpose))
    inner = {name for g in mechanism.groups for name in g.kind.carried(g)}
    plan.reserved = frozenset({*mechanism.fixed, mechanism.crank.pin, *inner, *(p.name for p in mechanism.points)})
    pos = Positions(mechanism, plan, phi, where)
    for name, at in mechanism.fixed.items():
        pos.points[name] = plan.add(name, rules.GIVEN, at)
    for guide in mechanism.guides.values():
        if guide.link == mechanism.frame:
            _fixed_guide(pos, guide)
    crank = mechanism.crank
    pos.points[crank.pin] = plan.add(crank.pin, rules.LAY_OFF, pos.points[crank.pivot], crank.length, phi)
    pos.directions[crank.link] = pos.direction(crank.pivot, crank.pin)
    _further_points(pos, crank.link)
    for group in mechanism.groups:
        for name in group.guides:
            if name not in pos.guide_points:
                _moving_guide(pos, mechanism.guides[name])
        if group is until:
            break
        group.kind.position(pos, group)
        for link in group.links:
            _further_points(pos, link)
    return pos


def _fixed_guide(pos: Positions, guide: Guide) -> None:
    at = near_point(pos.mechanism, guide)
    point = pos.plan.add(pos.plan.free(f"{guide.name}₀"), *at, say=tr("Mark point {name} of the guide."))
    pos.guide_points[guide.name] = point
    pos.guide_directions[guide.name] = pos.plan.add(pos.plan.named(guide.name), rules.UNDER, guide.direction,
                                                    say=tr("Through {point} draw the guide {{name}}.").format(point=point.name))


def _moving_guide(pos: Positions, guide: Guide) -> None:
    assert isinstance(guide.through, str)
    assert guide.towards is not None
    pos.guide_points[guide.name] = pos.points[guide.through]
    u = _line_on(pos, guide.link, guide.through, guide.towards)
    pos.guide_directions[guide.name] = _turned_by(pos, guide.name, u, guide.direction)


def _line_on(pos: Positions, link: str, start: str, towards: str) -> Step:
    """Direction fixed on a link, from ``start`` ``towards`` another of its points.

    Towards the pin that slides along the link it is the slot's direction: with an offset the line to the pin itself turns
    on the link. Towards the guide the link slides along it is the guide's direction.
    """
    if towards in pos.guide_directions and towards not in pos.points:
        return pos.guide_directions[towards]
    for g in pos.mechanism.groups:
        if g.kind.rocker(g) and g.offset and link in g.links and towards == g.outer[0]:
            return pos.directions[link]
    return pos.direction(start, towards)


def _turned_by(pos: Positions, name: str, u: Step, angle: float) -> Step:
    return u if angle == 0 else pos.plan.add(pos.plan.named(name), rules.TURNED_BY, u, angle)


def _further_points(pos: Positions, link: str) -> None:
    for p in pos.mechanism.points:
        if p.link == link and p.name not in pos.points:
            u = _turned_by(pos, f"{p.start}{p.name}", _line_on(pos, link, p.start, p.towards), p.angle)
            pos.points[p.name] = pos.plan.add(p.name, rules.ALONG, pos.points[p.start], u, p.distance)


PURPOSE = "change points"
CHOICE = "next to a change point, on the smooth way that it is on"
COUNT = 16
"""Angles on both sides of a change point through which a polynomial is laid."""
WIDEST, LEAST = 0.1, 1e-3
"""How far they reach, rad: so far unless functions bend too much there; less than the least tells nothing."""
ZONE = 0.09
"""Share of that within which the polynomial is taken: farther out the lines cross well enough."""
BLIND = 1e-4
"""Angle, rad, next to a change point in which nothing is told of a group where no polynomial is."""
CLOSE = 1e-3
"""Share of a gap's greatest value below which its least value may be a change point."""


def _sides(phi: Reals, angles: tuple[float, ...], side: float, at: float, cut: float, sense: float) -> Any:
    """Side of a group that goes on smoothly through its change points at some crank angles, rad."""

    def passed(x: Reals) -> Any:
        """How many change points lie between the cut and an angle, in the sense of rotation."""
        turned = np.mod(sense * (np.asarray(x, dtype=float) - cut) + at_rest(x), 2 * pi)
        return sum(np.where(turned > np.mod(sense * (a - cut), 2 * pi), 1, 0) for a in angles)

    return side * np.where((passed(phi) - passed(at)) % 2, -1.0, 1.0)


@primitive("side through change points", "real")
def side_through(phi: Reals, side: float, at: float, cut: float, sense: float, *angles: float) -> Reals:
    """+1 or -1, the side of a group that is on ``side`` at the crank angle ``at`` and changes it in each of its change points."""
    return _sides(phi, angles, side, at, cut, sense)[()]


SIDE = Rule("side of a group through change points", side_through, ("angle",), "number", "{name} = {value}.", unit="1", exact=True)


NODES: Floats = np.cos((2 * np.arange(COUNT) + 1) * pi / (2 * COUNT))
"""Where a polynomial is told, as shares of how far they reach: Chebyshev's points, none of them in the middle."""
WEIGHTS: Floats = np.where(np.arange(COUNT) % 2, -1.0, 1.0) * np.sin((2 * np.arange(COUNT) + 1) * pi / (2 * COUNT))


def between(at: Points, x: Floats, values: Any) -> Any:
    """Polynomial through values at Chebyshev's points ``x``, shape (COUNT,), by the barycentric formula."""
    share = WEIGHTS / (np.asarray(at)[..., None] - x)
    return (share * values).sum(axis=-1) / share.sum(axis=-1)


@dataclass(frozen=True)
class Beside:
    """What is known on one smooth way through a change point: values at its angles ``x`` from there, by names, shape (COUNT,)."""

    x: Floats
    values: dict[str, Any]

    def at(self, name: str, x: Reals) -> Any:
        """A value at angles from the change point, rad."""
        return between(x, self.x, self.values[name])

    @property
    def zone(self) -> float:
        """How far the polynomial is taken, rad."""
        return ZONE * float(self.x[0])


def beside(told: Callable[[Floats], dict[str, Any]], needed: str) -> Beside | None:
    """Polynomials through what is told at angles from a change point, of the size of 1, as far as they meet it between them.

    They reach as far as that of what is ``needed`` holds; None where it holds nowhere. What grows beyond all bounds has none.
    """
    reach = WIDEST
    while reach >= LEAST:
        found, test = Beside(reach * NODES, told(reach * NODES)), reach * np.array([-0.6, -0.25, 0.25, 0.6])
        true = told(test)
        holding = {name: values for name, values in found.values.items()
                   if np.max(np.abs(found.at(name, test) - true[name])) <= NOISE * (1.0 + np.max(np.abs(values)))}
        if needed in holding:
            return Beside(found.x, holding)
        reach /= 4
    return None


@dataclass(frozen=True)
class PassagePlace:
    """Positions next to one change point that are on one smooth way through it.

    ``which`` are their numbers, ``x`` their angles from the change point, rad, ``sides`` the sides of the groups that pass it, by
    their names, behind it (at greater crank angles); before it they are on the other ones.
    """

    angle: float
    which: npt.NDArray[np.intp]
    x: Floats
    sides: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Passages:
    """Change points of a mechanism; what is found is kept with it."""

    m: Mechanism

    def angles(self, g: StructuralGroup) -> tuple[float, ...]:
        """Crank angles of the change points of a group, rad; found once."""
        known, key = self.m.courses, f"{PURPOSE} {g.name}"
        if key not in known:
            gaps = g.kind.gaps(self.m, g)
            known[key] = gaps.angles if gaps is not None else self._merged_angles(g, self._searched(g)) if g.kind.two_ways else ()
        return tuple(known[key])

    def _merged_angles(self, g: StructuralGroup, found: tuple[float, ...]) -> tuple[float, ...]:
        """Angles found, but where a group before it has its change point that very angle: what is one has one angle.

        Between two that differ by the rounding of the search each group would be on another side of what both pass at once.
        """
        before = [a for x in self.m.groups[: self.m.groups.index(g)] for a in self.angles(x)]
        return tuple(next((a for a in before if abs(np.angle(np.exp(1j * (a - x)))) < NOISE), x) for x in found)

    def _searched(self, g: StructuralGroup) -> tuple[float, ...]:
        """Angles at which a gap of a group that hangs on others touches zero."""
        smooth = (replace(x, follow=True) if x.kind.gaps(self.m, x) else x for x in self.m.groups)
        until = alone(replace(self.m, groups=tuple(smooth)), g)

        def gap(i: int, phi: Reals) -> tuple[Any, Any]:
            """One of both gaps and what is rounding beside it, shape (n,)."""
            with np.errstate(all="ignore"):  # beyond a guide that lies along another one points are anywhere
                both = g.kind.gaps_at(position_plan(until, phi, purpose=SEARCHED, until=until.groups[-1]), g)
            return np.broadcast_to(both[i], np.shape(phi)), np.broadcast_to(both[2], np.shape(phi))

        sweep = 2 * pi / SWEEP * np.arange(SWEEP)
        found: list[float] = []
        for i in (0, 1):
            values = gap(i, sweep)[0]
            with np.errstate(invalid="ignore"):
                low = (values < CLOSE * np.nanmax(values, initial=0.0)) & (np.ptp(values) > 0)
                low &= (values <= np.roll(values, 1)) & (values <= np.roll(values, -1))
            touching = (_touching_angle(partial(gap, i), float(near)) for near in sweep[low])
            found += [angle for angle in touching if angle is not None]
        return tuple(sorted(found))

    def every(self) -> tuple[float, ...]:
        """Crank angles at which some group has a change point, rad, each once."""
        found: list[float] = []
        for angle in (a for g in self.m.groups for a in self.angles(g)):
            if all(abs(np.angle(np.exp(1j * (a - angle)))) >= NOISE for a in found):
                found.append(angle)
        return tuple(found)

    def within(self, phi: Reals) -> npt.NDArray[np.bool_]:
        """True at the crank angles, rad, shape (n,), at which some group is in a change point."""
        phi, angles = np.asarray(phi, dtype=float), np.array(self.every())
        return np.asarray((np.abs(np.angle(np.exp(1j * (phi[:, None] - angles)))) < NOISE).any(axis=1))

    def together(self, angle: float) -> tuple[StructuralGroup, ...]:
        """Groups that have a change point at a crank angle, rad."""
        return tuple(g for g in self.m.groups if any(abs(np.angle(np.exp(1j * (a - angle)))) < NOISE for a in self.angles(g)))

    def turning_back(self, point: str) -> bool:
        """True where a point hangs on a group that keeps its side in a change point: its links turn back at once there."""
        links, done = [self.m.owner(point)], set[str]()
        while links:
            link = links.pop()
            for g in (g for g in self.m.groups if link in g.links and g.name not in done):
                done.add(g.name)
                if not g.follow and self.angles(g):
                    return True
                links += [other for pair in g.kind.pairs(self.m, g) for other in pair.links if other not in g.links]
        return False

    def followed(self, g: StructuralGroup, phi: Reals) -> Any:
        """Side of a group at crank angles, rad, shape (n,), if it goes on smoothly through its change points."""
        gaps, cut = g.kind.gaps(self.m, g), g.at if g.cut is None else g.cut
        if gaps is None:
            return _sides(phi, self.angles(g), g.side, g.at, cut, self.m.crank.sense)
        return gaps.branch(phi, g.side, g.at, cut, self.m.crank.sense, follow=True) * np.sign(gaps.root(phi))

    def places(self, angle: float, phi: Reals, groups: tuple[StructuralGroup, ...], reach: float) -> list[PassagePlace]:
        """Positions within ``reach``, rad, of a change point at an ``angle`` that ``groups`` pass, by the ways they are on."""
        phi = np.atleast_1d(np.asarray(phi, dtype=float))
        x = np.angle(np.exp(1j * (phi - angle)))
        near = np.flatnonzero(np.abs(x) <= reach)
        x = np.where(np.abs(x) <= at_rest(phi), 0.0, x)
        rows = []
        for g in groups:
            there = self.followed(g, phi) if g.follow else np.broadcast_to(g.side, x.shape)
            rows.append(np.where(x == 0, self.followed(g, np.array([angle + 1e-6])), np.sign(x) * there))
        ways: dict[tuple[float, ...], list[int]] = {}
        for k in near:
            ways.setdefault(tuple(float(row[k]) for row in rows), []).append(int(k))
        names = [g.name for g in groups]
        return [PassagePlace(angle, np.array(which), x[which], tuple(zip(names, way, strict=True))) for way, which in ways.items()]

    def row(self, g: StructuralGroup, phi: Reals, what: str, told: Callable[[Mechanism, Any], Any], *, zero: bool = False) -> Given:
        """What is ``told`` of a mechanism at angles, at those of ``phi``, rad, next to change points of a group; NaN elsewhere.

        The mechanism that is asked about ends with the group, turns at 1 rad/s, and has the sides of its groups at each angle.
        Minus infinity stands where no polynomial tells anything, next to the change point. ``what`` is told is kept by that name;
        ``zero`` is true of what goes through zero there.
        """
        phi = np.atleast_1d(np.asarray(phi, dtype=float))
        row = np.full(phi.shape, np.nan)
        upstream = {x.name for x in self.m.groups[: self.m.groups.index(g) + 1]}
        for angle in self.angles(g):
            groups = tuple(x for x in self.together(angle) if x.name in upstream)
            for place in self.places(angle, phi, groups, ZONE * WIDEST):
                key = f"{PURPOSE} {what} {g.name} {place.angle} {place.sides}"
                if key not in self.m.courses:
                    self.m.courses[key] = beside(partial(self._told, g, place, what, told, zero), what)
                found = self.m.courses[key]
                inside = np.abs(place.x) <= (BLIND if found is None else found.zone)
                x = place.x[inside]
                row[place.which[inside]] = -np.inf if found is None else found.at(what, x) * (x if zero else 1.0)
        return Given(row, f"{what} of group {g.name}", choice=CHOICE)

    def _told(self, g: StructuralGroup, place: PassagePlace, what: str, told: Callable[[Mechanism, Any], Any], zero: bool,
              x: Floats) -> dict[str, Any]:
        m = replace(self.m, drive=None, crank=replace(self.m.crank, speed=1.0, sense=1.0, acceleration=0.0))
        at = told(alone(m, g, {name: side * np.sign(x) for name, side in place.sides}), place.angle + x)
        return {what: np.broadcast_to(at, x.shape) / (x if zero else 1.0)}


def alone(m: Mechanism, g: StructuralGroup, sides: dict[str, Any] | None = None) -> Mechanism:
    """A mechanism as far as a group, with other ``sides`` of some groups; no change points are looked for in it."""
    groups = m.groups[: [x.name for x in m.groups].index(g.name) + 1]
    if sides:
        groups = tuple(replace(x, side=sides[x.name], follow=False) if x.name in sides else x for x in groups)
    found = replace(m, groups=groups)
    found.courses.update({f"{PURPOSE} {x.name}": () for x in groups} if sides else m.courses | {f"{PURPOSE} {g.name}": ()})
    return found


def _touching_angle(gap: Callable[[Any], tuple[Any, Any]], near: float) -> float | None:
    """The angle next to a small value where a gap touches zero, rad; None where it does not.

    The root of the gap crosses zero there, with the sign that it has on either side.
    """
    for step in (2 * pi / SWEEP, 1e-4):
        a, b, c = gap(near + step * np.array([-1.0, 0.0, 1.0]))[0]
        bend = a - 2 * b + c
        if not 0 < bend < inf:
            return None
        near += float(np.clip(step * (a - c) / (2 * bend), -step, step))
    least, rounding = gap(np.array([near]))
    if not least[0] <= 1e-6 * np.max(gap(near + np.array([-0.1, 0.1]))[0]):
        return None
    x = 0.02 * NODES
    with np.errstate(invalid="ignore"):
        root = np.sign(x) * np.sqrt(gap(near + x)[0])
    for _ in range(3):
        h = 1e-4
        here, slope = float(between(0.0, x, root)), float(between(h, x, root) - between(-h, x, root)) / (2 * h)
        if np.isnan(here) or abs(here / slope) > 1e-6:
            return None
        near -= here / slope
        with np.errstate(invalid="ignore"):
            root = np.sign(x) * np.sqrt(gap(near + x)[0])
    least, rounding = gap(np.array([near]))
    return near if np.abs(least[0]) <= rounding[0] else None
