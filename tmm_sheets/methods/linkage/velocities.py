"""Velocity plans (планы скоростей): the vector equations of each group solved by two lines.

Every value is a vector from the pole, complex, m/s. Source: manual 000, section 3.3 and table 3.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import on_link
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.mechanism.model import StructuralGroup
from tmm_sheets.methods.linkage.positions import Positions

POLE = Rule("pole", lambda z: z, ("point",), "point", "Выберем полюс {name}.")
CRANK_VELOCITY = Rule(
    "velocity of the crank pin", lambda a, b, w: 1j * w * (b - a), ("point", "point", "number"), "vector",
    "От полюса p перпендикулярно {0}{1} в сторону ω1 отложим скорость точки {1}: точка {name}.",
    lambda a, v: (Helper("line", 0j, v),),
)
SIMILAR = Rule(
    "similarity", lambda q, b, big_q, big_b, big_d: q + (b - q) * (big_d - big_q) / (big_b - big_q),
    ("point", "point", "point", "point", "point"), "point",
    "По теореме подобия найдём точку {name}: |{0}{name}| : |{0}{1}| = {2}{4} : {2}{3}.",
    lambda a, v: (Helper("line", a[0], v),),
)
RIGID = Rule(
    "velocity on a turning link", lambda q, w, big_q, big_m: q + 1j * w * (big_m - big_q),
    ("point", "number", "point", "point"), "point",
    "От точки {0} перпендикулярно {2}{3} отложим вращательную скорость, получим {name}.",
    lambda a, v: (Helper("line", a[0], v),),
)


def _angular(big_q: Any, big_b: Any, q: Any, b: Any) -> Any:
    r = big_b - big_q
    return ar.cross(r, b - q) / np.abs(r) ** 2


ANGULAR_VELOCITY = Rule(
    "angular velocity", _angular, ("point", "point", "point", "point"), "number",
    "Угловая скорость |{name}| = |{2}{3}|·μ_V / {0}{1}, со знаком {name} = {value} рад/с.",
)
SAME = Rule("the same", lambda w: w, ("number",), "number", "{name} = {value}.")


@dataclass
class Velocities:
    """Velocity plan: ``points`` m/s from the pole for every point of the mechanism, ``omega`` rad/s of every link.

    ``relative`` holds, for each group with a sliding pair, the coincident points on both sides of it.
    """

    positions: Positions
    plan: Plan
    points: dict[str, Step] = field(default_factory=dict)
    omega: dict[str, Step] = field(default_factory=dict)
    reference: dict[str, tuple[str, str, Step, Step]] = field(default_factory=dict)
    coincident: dict[str, Step] = field(default_factory=dict)

    @property
    def pole(self) -> Step:
        """The pole p."""
        return self.plan["p"]


def plan_name(plan: Plan, point: str) -> str:
    """Name of a point on a plan: the small letter of the mechanism's, with a prime where the plan has that name already."""
    return plan.free(point.lower())


def velocity_plan(pos: Positions) -> Velocities:
    """Record the velocity plans of all positions of ``pos``."""
    m = pos.mechanism
    plan = Plan("velocities", "Планы скоростей", "m/s", pos.plan.labels, "p")
    vel = Velocities(pos, plan)
    pole = plan.add("p", POLE, 0j)
    for name in m.fixed:
        vel.points[name] = pole
    vel.omega[m.frame] = plan.add("ω0", SAME, 0.0)
    c = m.crank
    vel.omega[c.link] = plan.add(f"ω{c.link}", SAME, c.omega)
    b = plan.add(plan_name(plan, c.pin), CRANK_VELOCITY, pos.points[c.pivot], pos.points[c.pin], c.omega)
    plan.vector(f"V̅_{c.pin}", pole, b)
    vel.points[c.pin] = b
    vel.reference[c.link] = (c.pivot, c.pin, pole, b)
    _further_points(vel, c.link)
    for g in m.groups:
        GROUPS[g.kind](vel, g)
        for link in g.links:
            _further_points(vel, link)
    return vel


def _further_points(vel: Velocities, link: str) -> None:
    pos = vel.positions
    for p in pos.mechanism.points:
        if p.link != link or p.name in vel.points:
            continue
        if link in vel.reference:
            big_q, big_b, q, b = vel.reference[link]
            v = vel.plan.add(plan_name(vel.plan, p.name), SIMILAR, q, b, pos.points[big_q], pos.points[big_b], pos.points[p.name])
        else:
            start = vel.coincident.get(on_link(p.start, link), vel.points[p.start])
            v = vel.plan.add(plan_name(vel.plan, p.name), RIGID, start, vel.omega[link], pos.points[p.start], pos.points[p.name])
        vel.plan.vector(f"V̅_{p.name}", vel.pole, v)
        vel.points[p.name] = v


def guide_velocity(vel: Velocities, guide: str, at: str) -> tuple[Step, str]:
    """Velocity of the guide's point that coincides with ``at``, and the guide's link; the pole for a fixed guide."""
    pos = vel.positions
    g = pos.mechanism.guides[guide]
    if g.link == pos.mechanism.frame:
        return vel.pole, g.link
    assert isinstance(g.through, str)
    return velocity_on(vel, g.link, g.through, at), g.link


def velocity_on(vel: Velocities, link: str, through: str, at: str) -> Step:
    """Velocity of the point of a link that coincides with ``at``, from the link's point ``through``; drawn once."""
    pos = vel.positions
    here = on_link(at, link)
    if here not in vel.coincident:
        start = vel.coincident.get(on_link(through, link), vel.points[through])
        if through == at:
            return start
        name = plan_name(vel.plan, here)
        vel.coincident[here] = vel.plan.add(name, RIGID, start, vel.omega[link], pos.points[through], pos.points[at])
    return vel.coincident[here]


def _perpendicular(vel: Velocities, p: str, q: str) -> Step:
    ray = vel.positions.direction(p, q)
    name = f"⟂{ray.name}"
    return vel.plan[name] if name in vel.plan else vel.plan.add(name, rules.TURN, ray)


def _omega(vel: Velocities, link: str, big_q: str, big_b: str, q: Step, b: Step) -> None:
    pos = vel.positions
    vel.omega[link] = vel.plan.add(f"ω{link}", ANGULAR_VELOCITY, pos.points[big_q], pos.points[big_b], q, b)
    vel.reference[link] = (big_q, big_b, q, b)


def _rrr(vel: Velocities, g: StructuralGroup) -> None:
    plan = vel.plan
    (p, q), c = g.outer, str(g.inner)
    n1 = _perpendicular(vel, p, c)
    n2 = _perpendicular(vel, q, c)
    step = plan.add(plan_name(plan, c), rules.LINE_LINE, vel.points[p], n1, vel.points[q], n2, *vel.positions.known_sine(g))
    vel.points[c] = step
    plan.vector(f"V̅_{c}", vel.pole, step)
    plan.vector(f"V̅_{c}{p}", vel.points[p], step)
    if vel.points[q] is not vel.pole:
        plan.vector(f"V̅_{c}{q}", vel.points[q], step)
    _omega(vel, g.links[0], p, c, vel.points[p], step)
    _omega(vel, g.links[1], q, c, vel.points[q], step)


def _rrp(vel: Velocities, g: StructuralGroup) -> None:
    pos, plan = vel.positions, vel.plan
    p, c, guide = g.outer[0], str(g.inner), g.guides[0]
    carrier, link = guide_velocity(vel, guide, c)
    n = _perpendicular(vel, p, c)
    step = plan.add(plan_name(plan, c), rules.LINE_LINE, vel.points[p], n, carrier, pos.guide_directions[guide], *pos.known_sine(g))
    vel.points[c] = step
    plan.vector(f"V̅_{c}", vel.pole, step)
    plan.vector(f"V̅_{c}{p}", vel.points[p], step)
    if carrier is not vel.pole:
        plan.vector(f"V̅_{{{c}{carrier.name.upper()}}}", carrier, step)
    _omega(vel, g.links[0], p, c, vel.points[p], step)
    vel.omega[g.links[1]] = plan.add(f"ω{g.links[1]}", SAME, vel.omega[link])
    vel.coincident[on_link(c, g.links[1])] = step


def _rpr(vel: Velocities, g: StructuralGroup) -> None:
    pos, plan = vel.positions, vel.plan
    (p, q), (i, j) = g.outer, g.links
    pj = on_link(p, j)
    n = _perpendicular(vel, q, p)
    name = plan_name(plan, pj)
    step = plan.add(name, rules.LINE_LINE, vel.points[p], pos.directions[j], vel.points[q], n, *pos.known_sine(g))
    plan.vector(f"V̅_{{{pj}}}", vel.points[q], step)
    plan.vector(f"V̅_{{{pj}{p}}}", vel.points[p], step)
    vel.coincident[pj] = step
    _omega(vel, j, q, p, vel.points[q], step)
    vel.omega[i] = plan.add(f"ω{i}", SAME, vel.omega[j])
    if g.offset:
        foot = pos.feet[j]
        vel.points[foot] = plan.add(plan_name(plan, foot), RIGID, vel.points[q], vel.omega[j], pos.points[q], pos.points[foot])


def _prp(vel: Velocities, g: StructuralGroup) -> None:
    pos, plan = vel.positions, vel.plan
    c = str(g.inner)
    (v1, k1), (v2, k2) = (guide_velocity(vel, name, c) for name in g.guides)
    u1, u2 = (pos.guide_directions[name] for name in g.guides)
    step = plan.add(plan_name(plan, c), rules.LINE_LINE, v1, u1, v2, u2)
    vel.points[c] = step
    plan.vector(f"V̅_{c}", vel.pole, step)
    for v in (v1, v2):
        if v is not vel.pole:
            plan.vector(f"V̅_{{{c}{v.name.upper()}}}", v, step)
    for link, k in zip(g.links, (k1, k2), strict=True):
        vel.omega[link] = plan.add(f"ω{link}", SAME, vel.omega[k])
        vel.coincident[on_link(c, link)] = step


def _rpp(vel: Velocities, g: StructuralGroup) -> None:
    pos, plan = vel.positions, vel.plan
    p, s, guide, (i, j) = g.outer[0], str(g.inner), g.guides[0], g.links
    pj = on_link(p, j)
    carrier, link = guide_velocity(vel, guide, s)
    along, slot = pos.guide_directions[guide], pos.directions[i]
    # Link j does not turn against the guide: its point at the pin and its point on the guide move alike on a fixed
    # guide; on a turning one the point at the pin is taken first.
    if carrier is vel.pole:
        step = plan.add(plan_name(plan, pj), rules.LINE_LINE, vel.points[p], slot, carrier, along)
        plan.vector(f"V̅_{{{pj}}}", vel.pole, step)
        plan.vector(f"V̅_{{{pj}{p}}}", vel.points[p], step)
        vel.points[s] = step
    else:
        at_pin = velocity_on(vel, link, str(pos.mechanism.guides[guide].through), p)
        step = plan.add(plan_name(plan, pj), rules.LINE_LINE, vel.points[p], slot, at_pin, along)
        plan.vector(f"V̅_{{{pj}}}", vel.pole, step)
        vel.points[s] = plan.add(plan_name(plan, s), RIGID, step, vel.omega[link], pos.points[p], pos.points[s])
    vel.coincident[pj] = step
    vel.coincident[on_link(s, j)] = vel.points[s]
    for k in g.links:
        vel.omega[k] = plan.add(f"ω{k}", SAME, vel.omega[link])


GROUPS: dict[int, Callable[[Velocities, StructuralGroup], None]] = {1: _rrr, 2: _rrp, 3: _rpr, 4: _prp, 5: _rpp}
"""Velocity equations of each kind of group (manual 000, table 3.1)."""
