"""Kinetostatics: force plans of each Assur group, the farthest first, then of the crank; no friction.

``F_jk`` is the force on link j from link k. Forces are complex, N, shape (n,); couples N m, counter-clockwise positive.
Source: manual 000, section 4 and table 4.1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.plan import Plan, symbol
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.accelerations import Accelerations
from tmm_sheets.methods.linkage.positions import Positions
from tmm_sheets.numbers import size

Role = Literal["weight", "inertia", "applied", "reaction"]

WEIGHT = Rule("weight", lambda m, g: -1j * m * g, ("number", "number"), "force", "Вес {name} = m·g = {0}·{1} = {value}, вниз.")
INERTIA = Rule("inertia force", lambda m, a: -m * a, ("number", "point"), "force",
               "Сила инерции {name} = m·a = {0}·a_{1} = {value}, против ускорения {1}.")
COUPLE = Rule("inertia couple", lambda j, e: -j * e, ("number", "number"), "number",
              "Момент инерции {name} = −J·ε = {value} Н·м, против ε.")
GIVEN_MOMENT = Rule("given moment", lambda m: m, ("number",), "number", "Момент {name} = {value} Н·м.")
GIVEN_FORCE = Rule("given force", lambda f: f, ("force",), "force", "Сила {name} = {value}.")
OPPOSITE = Rule("reaction", lambda f: -f, ("force",), "force", "{name} = −{0}.")
CLOSE = Rule("close a polygon", lambda tail, head: head - tail, ("point", "point"), "force",
             "Замкнём план: {name} = |{0}–{1}|·μ_F = {value}.")
ARM = Rule("arm from moments", lambda m, f: m / np.abs(f), ("number", "force"), "length",
           "Плечо {name} = {value} из уравнения моментов.")


def _tangential(total: Any, centre: Any, at: Any) -> Any:
    r = at - centre
    return -total / np.abs(r) * 1j * r / np.abs(r)


TANGENTIAL = Rule("component from moments", _tangential, ("number", "point", "point"), "force",
                  "Из суммы моментов относительно точки {1} найдём составляющую {name} = {value}, перпендикулярную {1}{2}.")


@dataclass(frozen=True)
class Load:
    """A force on a link: symbol in sheet markup, the link, its point, the vector, and a couple carried with it (N m)."""

    symbol: str
    link: str
    at: Step
    vector: Step
    role: Role
    couple: Step | None = None


@dataclass
class ForcePlan:
    """Force plan of one link or of a whole group: polygon 1-2-...-1 of ``plan`` with its forces in order."""

    name: str
    links: tuple[str, ...]
    plan: Plan
    sides: list[tuple[str, Step, Step, bool]] = field(default_factory=list)

    def side(self, symbol: str, tail: Step, head: Step, unknown: bool = False) -> None:
        """Record a side of the polygon; ``unknown`` sides are found by closing it."""
        self.sides.append((symbol, tail, head, unknown))
        self.plan.vector(symbol, tail, head)


@dataclass
class Kinetostatics:
    """Force analysis of all groups and the crank.

    ``loads`` are all forces on each link, reactions included, as they were used; ``reactions`` by name ("F54", "F11,10");
    ``couples`` and ``arms`` of sliding pairs by name ("h50"); ``link_couples`` are inertia couples and applied
    moments of each link.
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
    balancing: Step | None = None

    @property
    def external(self) -> list[Load]:
        """Weights, inertia forces and applied forces of all links, without reactions."""
        return [load for loads in self.loads.values() for load in loads if load.role != "reaction"]

    @property
    def tangential(self) -> list[Step]:
        """Parts of outer reactions that the moment equations gave, across their links, in the order they were found."""
        return [step for step in self.plan if step.rule is TANGENTIAL]

    def force_size(self, k: int) -> float:
        """Size of the forces at position ``k``, N: beside it a force is something or nothing."""
        return size((load.vector.value for loads in self.loads.values() for load in loads), k)

    def moment_size(self, k: int) -> float:
        """Moment of such a force across the whole mechanism, N m: beside it a moment is something or nothing."""
        points = list(self.positions.points.values())
        return self.force_size(k) * size((p.value - points[0].value for p in points), k)

    def reaction(self, j: str, k: str, vector: Step) -> Step:
        """Record F_jk under its name."""
        self.reactions[f"F{pair_index(j, k)}"] = vector
        return vector


@dataclass(frozen=True)
class GearForce:
    """Force of a gear pair on the crank shaft's wheel: acts along the line of action.

    ``radius`` m of the wheel's pitch circle, ``angle`` the pressure angle, ``mate`` the direction to the mating wheel, rad.
    """

    name: str
    radius: float
    angle: float
    mate: float

    def direction(self, sense: int) -> complex:
        """Unit vector of the force that drives the wheel in the sense of rotation and presses it from its mate."""
        m = complex(np.cos(self.mate), np.sin(self.mate))
        return complex(1j * sense * m * np.cos(self.angle) - m * np.sin(self.angle))


def contact_point(pos: Positions, driver: GearForce) -> Step:
    """Pitch point P of the wheel on the crank shaft and its mate, a point of the position plan."""
    if pos.contact is None:
        name = pos.plan.free("P")
        pos.contact = pos.plan.add(name, rules.LAY_OFF, pos.points[pos.mechanism.crank.pivot], driver.radius, driver.mate)
    return pos.contact


def external_loads(pos: Positions, acc: Accelerations, gravity: float, applied: Iterable[tuple[str, str, str, Any]],
                   moments: Iterable[tuple[str, str, Any]] = (), carried: float | None = None) -> tuple[
                       dict[str, list[Load]], dict[str, list[Step]], Plan]:
    """Weights, inertia forces and couples of every link, applied forces (name, link, point, vectors) and moments.

    ``carried`` is the moment of inertia of all that turns with the crank, kg m2, where it is more than the crank's own.
    """
    m = pos.mechanism
    plan = Plan("loads", "Внешние силы и силы инерции", "N", pos.plan.labels)
    loads: dict[str, list[Load]] = {name: [] for name in m.links}
    couples: dict[str, list[Step]] = {}
    for link in m.links.values():
        if link.mass and link.centre is not None:
            at = pos.points[link.centre]
            if gravity:
                w = plan.add(f"G{link.name}", WEIGHT, link.mass, gravity)
                loads[link.name].append(Load(f"G̅_{link.name}", link.name, at, w, "weight"))
            if link.centre not in m.fixed:
                fi = plan.add(f"Fи{link.name}", INERTIA, link.mass, acc.points[link.centre])
                loads[link.name].append(Load(f"F̅_{{и{link.name}}}", link.name, at, fi, "inertia"))
        inertia = link.inertia if carried is None or link.name != m.crank.link else carried
        if inertia:
            couples.setdefault(link.name, []).append(plan.add(f"Mи{link.name}", COUPLE, inertia, acc.epsilon[link.name]))
    for name, link_name, point, vector in applied:
        f = plan.add(name, GIVEN_FORCE, vector)
        loads[link_name].append(Load(symbol(name), link_name, pos.points[point], f, "applied"))
    for name, link_name, value in moments:
        couples.setdefault(link_name, []).append(plan.add(name, GIVEN_MOMENT, value))
    return loads, couples, plan


def kinetostatics(pos: Positions, acc: Accelerations, loads: dict[str, list[Load]], couples: dict[str, list[Step]],
                  driver: GearForce | None, plan: Plan | None = None) -> Kinetostatics:
    """Force plans of all groups from the farthest to the crank; ``driver`` None means a pure balancing moment."""
    sums = plan or Plan("moments", "Суммы моментов", "m", pos.plan.labels)
    work = {name: list(of_link) for name, of_link in loads.items()}
    k = Kinetostatics(pos, acc, work, sums, couples)
    for g in reversed(pos.mechanism.groups):
        GROUPS[g.kind](k, g)
    _crank(k, driver)
    return k


def moment_sum(k: Kinetostatics, name: str, about: Step, links: Iterable[str]) -> Step:
    """Sum of moments of all recorded forces and couples of some links about a point, N m."""
    terms: list[Any] = [about]
    for link in links:
        for load in k.loads[link]:
            terms += [load.at, load.vector, 0.0 if load.couple is None else load.couple]
        for couple in k.link_couples.get(link, ()):
            terms += [about, 0j, couple]
    return k.plan.add(name, MOMENTS, *terms)


def _moments(about: Any, *terms: Any) -> Any:
    total = 0.0
    for at, vector, couple in zip(terms[::3], terms[1::3], terms[2::3], strict=True):
        total = total + ar.moment(about, at, vector) + couple
    return total


MOMENTS = Rule("sum of moments", _moments, ("point",), "number", "Сумма моментов относительно точки {0}: {name} = {value} Н·м.")


def _owner(m: Mechanism, point: str) -> str:
    return m.owner(point)


def _force_plan(k: Kinetostatics, name: str, links: tuple[str, ...]) -> ForcePlan:
    title = f"План сил звена {links[0]}" if len(links) == 1 else f"План сил группы {'–'.join(links)}"
    fp = ForcePlan(name, links, Plan(f"force-{name}", title, "N", k.positions.plan.labels))
    k.plans[name] = fp
    return fp


def _chain(fp: ForcePlan, start: int, tail: Step, loads: Iterable[Load]) -> Step:
    """Lay the loads off one after another; returns the end of the chain."""
    for n, load in enumerate(loads, start + 1):
        head = fp.plan.add(str(n), rules.SHIFT, tail, load.vector)
        fp.side(load.symbol, tail, head)
        tail = head
    return tail


def _close(k: Kinetostatics, fp: ForcePlan, j: str, other: str, tail: Step, head: Step) -> Step:
    """Close a polygon by the reaction on link ``j`` from link ``other``."""
    name = f"F{pair_index(j, other)}"
    step = fp.plan.add(name, CLOSE, tail, head)
    fp.side(symbol(name), tail, head, unknown=True)
    return k.reaction(j, other, step)


def _react(k: Kinetostatics, link: str, on: str, at: Step, vector: Step, couple: Step | None = None) -> Step:
    """The equal and opposite force on the neighbouring link ``on`` from ``link``."""
    pair = pair_index(on, link)
    name = f"F{pair}"
    step = k.plan.add(name, OPPOSITE, vector)
    k.reaction(on, link, step)
    if on != k.positions.mechanism.frame:
        turned = None if couple is None else k.plan.add(f"M{pair}", OPPOSITE_COUPLE, couple)
        k.loads[on].append(Load(symbol(name), on, at, step, "reaction", turned))
    return step


OPPOSITE_COUPLE = Rule("opposite couple", lambda m: -m, ("number",), "number", "{name} = {value} Н·м.")


def _order(loads: list[Load], first: Role) -> list[Load]:
    rank = {"weight": 1, "inertia": 2, "applied": 3, "reaction": 4}
    rank[first] = 0
    return sorted(loads, key=lambda load: rank[load.role])


def _perpendicular(k: Kinetostatics, name: str, u: Step) -> Step:
    label = f"⟂{name}"
    return k.plan.steps[label] if label in k.plan else k.plan.add(label, rules.TURN, u)


def _sliding(k: Kinetostatics, j: str, other: str, force: Step, about: Step) -> Step:
    """Couple of a sliding pair's reaction on link ``j`` (its force taken at ``about``) and its arm, from moments about it."""
    name = pair_index(j, other)
    total = moment_sum(k, f"ΣM{j}", about, [j])
    couple = k.plan.add(f"M{name}", OPPOSITE_COUPLE, total)
    k.couples[f"F{name}"] = couple
    k.arms[f"h{name}"] = k.plan.add(f"h{name}", ARM, couple, force)
    return couple


def _rpp(k: Kinetostatics, g: StructuralGroup) -> None:
    """Kind 5: the plan of the guided link first, then of the block; arms from moments (manual 000, 4 ex. 1)."""
    pos, m = k.positions, k.positions.mechanism
    (i, j), p, guide = g.links, g.outer[0], g.guides[0]
    base = m.guides[guide].link
    ij, ji = pair_index(i, j), pair_index(j, i)
    across_slot = _perpendicular(k, pos.directions[i].name, pos.directions[i])
    across_guide = _perpendicular(k, guide, pos.guide_directions[guide])
    fp = _force_plan(k, j, (j,))
    start = fp.plan.add("2", rules.GIVEN, 0j)
    loads = _order(k.loads[j], "inertia")
    end = start
    pending = []  # sides are recorded in the manual's order, the first unknown one before them
    for n, load in enumerate(loads, 3):
        head = fp.plan.add(str(n), rules.SHIFT, end, load.vector)
        pending.append((load.symbol, end, head))
        end = head
    one = fp.plan.add("1", rules.LINE_LINE, start, across_slot, end, across_guide)
    f_ji = _close(k, fp, j, i, one, start)
    for s, tail, head in pending:
        fp.side(s, tail, head)
    f_jb = _close(k, fp, j, base, end, one)
    # Block: F_ij, its loads, closing force from the link that carries the pin.
    f_ij = k.reaction(i, j, k.plan.add(f"F{ij}", OPPOSITE, f_ji))
    k.loads[i].insert(0, Load(symbol(f"F{ij}"), i, pos.points[p], f_ij, "reaction"))
    inner = _sliding(k, i, j, f_ji, pos.points[p])
    owner = _owner(m, p)
    block = _force_plan(k, i, (i,))
    first = block.plan.add("1", rules.GIVEN, 0j)
    rest = [load for load in k.loads[i] if load.role != "reaction"] + [load for load in k.loads[i][1:] if load.role == "reaction"]
    tail = _chain(block, 1, first, [k.loads[i][0], *rest])
    f_io = _close(k, block, i, owner, tail, first)
    # The guided link also carries the opposite of the inner couple.
    on_j = k.plan.add(f"M{ji}", OPPOSITE_COUPLE, inner)
    k.loads[j].append(Load(symbol(f"F{ji}"), j, pos.points[p], f_ji, "reaction", on_j))
    outer = _sliding(k, j, base, f_jb, pos.points[p])
    _react(k, i, owner, pos.points[p], f_io)
    _react(k, j, base, pos.points[p], f_jb, outer)


def _rpr(k: Kinetostatics, g: StructuralGroup) -> None:
    """Kind 3: tangential part from moments of the group about the pivot, then plans of block and rocker."""
    pos, m = k.positions, k.positions.mechanism
    (i, j), (p, q) = g.links, g.outer
    owner, base = _owner(m, p), _owner(m, q)
    ji, io = pair_index(j, i), pair_index(i, owner)
    total = moment_sum(k, f"ΣM{i}–{j}", pos.points[q], [i, j])
    tangential = k.plan.add(f"F{io}τ", TANGENTIAL, total, pos.points[q], pos.points[p])
    radial = pos.direction(q, p)
    across = _perpendicular(k, f"{q}{p}" if radial is pos.directions[j] else f"напр {j}", pos.directions[j])
    block = _force_plan(k, i, (i,))
    start = block.plan.add("2", rules.GIVEN, 0j)
    after = block.plan.add("3", rules.SHIFT, start, tangential)
    pending, end = [], after
    for n, load in enumerate(_order(k.loads[i], "weight"), 4):
        head = block.plan.add(str(n), rules.SHIFT, end, load.vector)
        pending.append((load.symbol, end, head))
        end = head
    one = block.plan.add("1", rules.LINE_LINE, start, radial, end, across, *pos.known_sine(g))
    block.plan.add(f"F{io}n", CLOSE, one, start)
    block.side(f"F̅_{{{io}}}^n", one, start, unknown=True)
    block.side(f"F̅_{{{io}}}^τ", start, after)
    for s, tail, head in pending:
        block.side(s, tail, head)
    f_ij = _close(k, block, i, j, end, one)
    f_io = k.reaction(i, owner, block.plan.add(f"F{io}", CLOSE, one, after))
    block.plan.vector(symbol(f"F{io}"), one, after)
    inner = _sliding(k, i, j, f_ij, pos.points[p])
    f_ji = k.reaction(j, i, k.plan.add(f"F{ji}", OPPOSITE, f_ij))
    rocker = _force_plan(k, j, (j,))
    first = rocker.plan.add("1", rules.GIVEN, 0j)
    on_j = k.plan.add(f"M{ji}", OPPOSITE_COUPLE, inner)
    contact = Load(symbol(f"F{ji}"), j, pos.points[p], f_ji, "reaction", on_j)
    tail = _chain(rocker, 1, first, [contact, *_order(k.loads[j], "weight")])
    k.loads[j].insert(0, contact)
    f_jb = _close(k, rocker, j, base, tail, first)
    _react(k, i, owner, pos.points[p], f_io)
    _react(k, j, base, pos.points[q], f_jb)


def _group_polygon(k: Kinetostatics, g: StructuralGroup, first: Step | None, last: Step | None, u: Step, v: Step,
                   carriers: tuple[str, str], sine: tuple[Step, ...] = ()) -> tuple[Step, Step, ForcePlan]:
    """Plan of a whole group closed by two unknown forces: ``first`` .. ``last`` known parts, lines along ``u`` and ``v``.

    ``sine`` of the angle between these lines, where the position plan knows it better than they do.

    ``carriers`` are the links outside that the two links lean on; returns the total forces from them.
    """
    i, j = g.links
    fp = _force_plan(k, g.name, g.links)
    start = fp.plan.add("2", rules.GIVEN, 0j)
    n, tail = 2, start
    pending = []

    def lay(sign: str, vector: Step) -> None:
        nonlocal n, tail
        n += 1
        head = fp.plan.add(str(n), rules.SHIFT, tail, vector)
        pending.append((sign, tail, head))
        tail = head

    one, two = (f"F{pair_index(link, carrier)}" for link, carrier in zip(g.links, carriers, strict=True))
    if first is not None:
        lay(f"F̅_{{{one[1:]}}}^τ", first)
    after_first = tail
    for link in (i, j):
        for load in _order(k.loads[link], "weight"):
            lay(load.symbol, load.vector)
    before_last = tail
    if last is not None:
        lay(f"F̅_{{{two[1:]}}}^τ", last)
    closing = fp.plan.add("1", rules.LINE_LINE, start, u, tail, v, *sine)
    fp.side(f"F̅_{{{one[1:]}}}" + ("^n" if first is not None else ""), closing, start, unknown=True)
    for sign, a, b in pending:
        fp.side(sign, a, b)
    fp.side(f"F̅_{{{two[1:]}}}" + ("^n" if last is not None else ""), tail, closing, unknown=True)
    f_one = k.reaction(i, carriers[0], fp.plan.add(one, CLOSE, closing, after_first))
    f_two = k.reaction(j, carriers[1], fp.plan.add(two, CLOSE, before_last, closing))
    if first is not None:
        fp.plan.vector(symbol(one), closing, after_first)
    if last is not None:
        fp.plan.vector(symbol(two), before_last, closing)
    # The inner reaction closes the forces of the first link: the same drawing, one more line.
    split = pending[(first is not None) + len(k.loads[i]) - 1][2] if len(k.loads[i]) + (first is not None) else start
    name = f"F{pair_index(i, j)}"
    inner = k.reaction(i, j, fp.plan.add(name, CLOSE, split, closing))
    fp.plan.vector(symbol(name), split, closing)
    k.reaction(j, i, k.plan.add(f"F{pair_index(j, i)}", OPPOSITE, inner))
    return f_one, f_two, fp


def _rrr(k: Kinetostatics, g: StructuralGroup) -> None:
    """Kind 1: tangential parts from moments of each link about the middle hinge, normal parts from the plan."""
    pos, m = k.positions, k.positions.mechanism
    (i, j), (p, q), c = g.links, g.outer, str(g.inner)
    a, b = _owner(m, p), _owner(m, q)
    parts = []
    for link, other, end in ((i, a, p), (j, b, q)):
        total = moment_sum(k, f"ΣM{link}", pos.points[c], [link])
        parts.append(k.plan.add(f"F{pair_index(link, other)}τ", TANGENTIAL, total, pos.points[c], pos.points[end]))
    f_one, f_two, _ = _group_polygon(k, g, parts[0], parts[1], pos.direction(p, c), pos.direction(q, c), (a, b),
                                     pos.known_sine(g))
    _react(k, i, a, pos.points[p], f_one)
    _react(k, j, b, pos.points[q], f_two)


def _rrp(k: Kinetostatics, g: StructuralGroup) -> None:
    """Kind 2: tangential part from moments of the rod about the inner hinge; the guide's reaction across it."""
    pos, m = k.positions, k.positions.mechanism
    (i, j), p, c, guide = g.links, g.outer[0], str(g.inner), g.guides[0]
    a, base = _owner(m, p), m.guides[guide].link
    total = moment_sum(k, f"ΣM{i}", pos.points[c], [i])
    part = k.plan.add(f"F{pair_index(i, a)}τ", TANGENTIAL, total, pos.points[c], pos.points[p])
    across = _perpendicular(k, guide, pos.guide_directions[guide])
    # The lines of the velocities turned by 90 degrees, one of them the other way round.
    sine = tuple(Step(f"−{s.name}", OPPOSITE, (s,)) for s in pos.known_sine(g))
    f_one, f_two, _ = _group_polygon(k, g, part, None, pos.direction(p, c), across, (a, base), sine)
    couple = _sliding(k, j, base, f_two, pos.points[c])
    _react(k, i, a, pos.points[p], f_one)
    _react(k, j, base, pos.points[c], f_two, couple)


def _prp(k: Kinetostatics, g: StructuralGroup) -> None:
    """Kind 4: both guides' reactions from the plan of the group, their arms from moments about the inner hinge."""
    pos, m = k.positions, k.positions.mechanism
    c = str(g.inner)
    bases = m.guides[g.guides[0]].link, m.guides[g.guides[1]].link
    u, v = (_perpendicular(k, name, pos.guide_directions[name]) for name in g.guides)
    forces = _group_polygon(k, g, None, None, u, v, bases)
    for link, base, force in zip(g.links, bases, forces[:2], strict=True):
        couple = _sliding(k, link, base, force, pos.points[c])
        _react(k, link, base, pos.points[c], force, couple)


GROUPS: dict[int, Callable[[Kinetostatics, StructuralGroup], None]] = {1: _rrr, 2: _rrp, 3: _rpr, 4: _prp, 5: _rpp}
"""Force analysis of each kind of group (manual 000, table 4.1)."""


def _crank(k: Kinetostatics, driver: GearForce | None) -> None:
    """Initial link: the balancing force from moments about the crank pivot, then the force plan."""
    pos, m = k.positions, k.positions.mechanism
    c = m.crank
    pivot = pos.points[c.pivot]
    total = moment_sum(k, f"ΣM{c.link}", pivot, [c.link])
    plan = _force_plan(k, c.link, (c.link,))
    first = plan.plan.add("1", rules.GIVEN, 0j)
    reactions = [load for load in k.loads[c.link] if load.role == "reaction"]
    others = [load for load in k.loads[c.link] if load.role != "reaction"]
    tail = _chain(plan, 1, first, reactions)
    n = 1 + len(reactions)
    if driver is None:
        k.balancing = k.plan.add("Mур", OPPOSITE_COUPLE, total)
    else:
        at = contact_point(pos, driver)
        k.balancing = k.plan.add(driver.name, DRIVING_FORCE, total, pivot, at, driver.direction(c.sense))
        load = Load(symbol(driver.name), c.link, at, k.balancing, "applied")
        k.loads[c.link].append(load)
        tail = _chain(plan, n, tail, [load])
        n += 1
    tail = _chain(plan, n, tail, others)
    _close(k, plan, c.link, m.frame, tail, first)


def _driving(total: Any, centre: Any, at: Any, u: Any) -> Any:
    return -total / ar.moment(centre, at, u) * u


DRIVING_FORCE = Rule("balancing force", _driving, ("number", "point", "point", "direction"), "force",
                     "Из суммы моментов относительно точки {1} найдём уравновешивающую силу {name} = {value}.")
