"""Acceleration plans (планы ускорений) with normal and Coriolis segments.

Every value is a vector from the pole, complex, m/s2. Source: manual 000, section 3.4 and table 3.6.
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
from tmm_sheets.methods.linkage.velocities import POLE, SAME, SIMILAR, Velocities, plan_name, velocity_on

NORMAL = Rule(
    "normal acceleration", lambda a, w, big_q, big_b: a - w * w * (big_b - big_q),
    ("point", "number", "point", "point"), "point",
    "От точки {0} параллельно {3}{2} к центру {2} отложим нормальное ускорение ω²·l: точка {name}.",
    lambda a, v: (Helper("line", a[0], v),),
)
TANGENTIAL = Rule(
    "tangential acceleration", lambda a, e, big_q, big_b: a + 1j * e * (big_b - big_q),
    ("point", "number", "point", "point"), "point",
    "От точки {0} перпендикулярно {2}{3} в сторону ε отложим касательное ускорение ε·l: точка {name}.",
    lambda a, v: (Helper("line", a[0], v),),
)
CORIOLIS = Rule(
    "Coriolis acceleration", lambda a, w, v_from, v_to: a + 2j * w * (v_to - v_from),
    ("point", "number", "point", "point"), "point",
    "От точки {0} отложим поворотное (кориолисово) ускорение 2ω·V: вектор {2}{3} плана скоростей, повёрнутый на 90° "
    "в сторону ω: точка {name}.",
    lambda a, v: (Helper("line", a[0], v),),
)
RIGID = Rule(
    "acceleration on a turning link", lambda a, w, e, big_q, big_m: a + (1j * e - w * w) * (big_m - big_q),
    ("point", "number", "number", "point", "point"), "point",
    "От точки {0} отложим нормальное и касательное ускорения точки звена, совпадающей с {4}: точка {name}.",
    lambda a, v: (Helper("line", a[0], v),),
)


def _angular(big_q: Any, big_b: Any, q: Any, b: Any) -> Any:
    r = big_b - big_q
    return ar.cross(r, b - q) / np.abs(r) ** 2


ANGULAR_ACCELERATION = Rule(
    "angular acceleration", _angular, ("point", "point", "point", "point"), "number",
    "Угловое ускорение |{name}| = a^τ / {0}{1}, со знаком {name} = {value} рад/с².",
)


@dataclass
class Accelerations:
    """Acceleration plan: ``points`` m/s2 from the pole for every point, ``epsilon`` rad/s2 of every link."""

    positions: Positions
    velocities: Velocities
    plan: Plan
    points: dict[str, Step] = field(default_factory=dict)
    epsilon: dict[str, Step] = field(default_factory=dict)
    reference: dict[str, tuple[str, str, Step, Step]] = field(default_factory=dict)
    coincident: dict[str, Step] = field(default_factory=dict)

    @property
    def pole(self) -> Step:
        """The pole π."""
        return self.plan["π"]


def acceleration_plan(vel: Velocities, epsilon1: Any = None) -> Accelerations:
    """Record the acceleration plans of all positions; ``epsilon1`` (rad/s2, signed) defaults to the mechanism's."""
    pos = vel.positions
    m = pos.mechanism
    plan = Plan("accelerations", "План ускорений", "m/s2", pos.plan.labels, "π")
    acc = Accelerations(pos, vel, plan)
    pole = plan.add("π", POLE, 0j)
    for name in m.fixed:
        acc.points[name] = pole
    acc.epsilon[m.frame] = plan.add("ε0", SAME, 0.0)
    c = m.crank
    eps = c.sense * c.acceleration if epsilon1 is None else epsilon1
    acc.epsilon[c.link] = plan.add(f"ε{c.link}", SAME, eps)
    centre, pin = pos.points[c.pivot], pos.points[c.pin]
    b_name = plan_name(plan, c.pin)
    if np.any(np.asarray(eps) != 0):
        n = plan.add("n1" if b_name != "n1" else plan.free("n1′"), NORMAL, pole, vel.omega[c.link], centre, pin)
        b = plan.add(b_name, TANGENTIAL, n, acc.epsilon[c.link], centre, pin)
        plan.vector(f"a̅_{c.pin}^n", pole, n)
        plan.vector(f"a̅_{c.pin}^τ", n, b)
    else:
        b = plan.add(b_name, NORMAL, pole, vel.omega[c.link], centre, pin)
    plan.vector(f"a̅_{c.pin}", pole, b)
    acc.points[c.pin] = b
    acc.reference[c.link] = (c.pivot, c.pin, pole, b)
    _further_points(acc, c.link)
    for g in m.groups:
        GROUPS[g.kind](acc, g)
        for link in g.links:
            _further_points(acc, link)
    return acc


def _free(plan: Plan, letter: str) -> str:
    """The letter itself, or with the first free number when the plan has it already."""
    if letter not in plan:
        return letter
    return next(f"{letter}{i}" for i in range(2, 100) if f"{letter}{i}" not in plan)


def _further_points(acc: Accelerations, link: str) -> None:
    pos = acc.positions
    for p in pos.mechanism.points:
        if p.link != link or p.name in acc.points:
            continue
        if link in acc.reference:
            big_q, big_b, q, b = acc.reference[link]
            a = acc.plan.add(plan_name(acc.plan, p.name), SIMILAR, q, b, pos.points[big_q], pos.points[big_b], pos.points[p.name])
        else:
            start = acc.coincident.get(on_link(p.start, link), acc.points[p.start])
            a = acc.plan.add(plan_name(acc.plan, p.name), RIGID, start, acc.velocities.omega[link], acc.epsilon[link],
                             pos.points[p.start], pos.points[p.name])
        acc.plan.vector(f"a̅_{p.name}", acc.pole, a)
        acc.points[p.name] = a


def _carrier(acc: Accelerations, guide: str, at: str) -> tuple[Step, Step, str]:
    """Acceleration and velocity of the guide's point coinciding with ``at``, and the guide's link."""
    pos, vel = acc.positions, acc.velocities
    g = pos.mechanism.guides[guide]
    if g.link == pos.mechanism.frame:
        return acc.pole, vel.pole, g.link
    assert isinstance(g.through, str)
    return _on(acc, g.link, g.through, at), velocity_on(vel, g.link, g.through, at), g.link


def _on(acc: Accelerations, link: str, through: str, at: str) -> Step:
    """Acceleration of the point of a link that coincides with ``at``, from the link's point ``through``; drawn once."""
    pos, vel = acc.positions, acc.velocities
    here = on_link(at, link)
    if here not in acc.coincident:
        start = acc.coincident.get(on_link(through, link), acc.points[through])
        if through == at:
            return start
        name = plan_name(acc.plan, here)
        acc.coincident[here] = acc.plan.add(name, RIGID, start, vel.omega[link], acc.epsilon[link],
                                            pos.points[through], pos.points[at])
    return acc.coincident[here]


def _coriolis(acc: Accelerations, a: Step, link: str, v_from: Step, v_to: Step, symbol: str) -> Step:
    """End of the Coriolis segment; the point itself where the carrier does not turn (a fixed guide: a^k = 0)."""
    if link == acc.positions.mechanism.frame:
        return a
    k = acc.plan.add(_free(acc.plan, "k"), CORIOLIS, a, acc.velocities.omega[link], v_from, v_to)
    acc.plan.vector(f"a̅_{{{symbol}}}^к", a, k)
    return k


def _normal(acc: Accelerations, a: Step, link: str, big_q: str, big_b: str, letters: str = "") -> Step:
    pos = acc.positions
    n = acc.plan.add(_free(acc.plan, "n"), NORMAL, a, acc.velocities.omega[link], pos.points[big_q], pos.points[big_b])
    acc.plan.vector(f"a̅_{{{letters or big_b + big_q}}}^n", a, n)
    return n


def _perpendicular(acc: Accelerations, p: str, q: str) -> Step:
    ray = acc.positions.direction(p, q)
    name = f"⟂{ray.name}"
    return acc.plan[name] if name in acc.plan else acc.plan.add(name, rules.TURN, ray)


def _epsilon(acc: Accelerations, link: str, big_q: str, big_b: str, q: Step, b: Step) -> None:
    pos = acc.positions
    acc.epsilon[link] = acc.plan.add(f"ε{link}", ANGULAR_ACCELERATION, pos.points[big_q], pos.points[big_b], q, b)
    acc.reference[link] = (big_q, big_b, q, b)


def _rrr(acc: Accelerations, g: StructuralGroup) -> None:
    plan = acc.plan
    (p, q), c, (i, j) = g.outer, str(g.inner), g.links
    n1 = _normal(acc, acc.points[p], i, p, c)
    n2 = _normal(acc, acc.points[q], j, q, c)
    step = plan.add(plan_name(plan, c), rules.LINE_LINE, n1, _perpendicular(acc, p, c), n2, _perpendicular(acc, q, c),
                    *acc.positions.known_sine(g))
    acc.points[c] = step
    plan.vector(f"a̅_{{{c}{p}}}^τ", n1, step)
    plan.vector(f"a̅_{{{c}{q}}}^τ", n2, step)
    plan.vector(f"a̅_{c}", acc.pole, step)
    _epsilon(acc, i, p, c, acc.points[p], step)
    _epsilon(acc, j, q, c, acc.points[q], step)


def _rrp(acc: Accelerations, g: StructuralGroup) -> None:
    plan, pos, vel = acc.plan, acc.positions, acc.velocities
    p, c, guide = g.outer[0], str(g.inner), g.guides[0]
    carrier, v_carrier, link = _carrier(acc, guide, c)
    n = _normal(acc, acc.points[p], g.links[0], p, c)
    k = _coriolis(acc, carrier, link, v_carrier, vel.points[c], on_link(c, link))
    step = plan.add(plan_name(plan, c), rules.LINE_LINE, n, _perpendicular(acc, p, c), k, pos.guide_directions[guide],
                    *pos.known_sine(g))
    acc.points[c] = acc.coincident[on_link(c, g.links[1])] = step
    plan.vector(f"a̅_{{{c}{p}}}^τ", n, step)
    plan.vector(f"a̅_{c}", acc.pole, step)
    _epsilon(acc, g.links[0], p, c, acc.points[p], step)
    acc.epsilon[g.links[1]] = plan.add(f"ε{g.links[1]}", SAME, acc.epsilon[link])


def _rpr(acc: Accelerations, g: StructuralGroup) -> None:
    plan, pos, vel = acc.plan, acc.positions, acc.velocities
    (p, q), (i, j) = g.outer, g.links
    pj = on_link(p, j)
    k = _coriolis(acc, acc.points[p], j, vel.points[p], vel.coincident[pj], f"{pj}{p}")
    n = _normal(acc, acc.points[q], j, q, p, f"{pj}{q}")
    step = plan.add(plan_name(plan, pj), rules.LINE_LINE, k, pos.directions[j], n, _perpendicular(acc, q, p),
                    *pos.known_sine(g))
    plan.vector(f"a̅_{{{pj}{p}}}^r", k, step)
    plan.vector(f"a̅_{{{pj}{q}}}^τ", n, step)
    plan.vector(f"a̅_{{{pj}}}", acc.points[q], step)
    acc.coincident[pj] = step
    _epsilon(acc, j, q, p, acc.points[q], step)
    acc.epsilon[i] = plan.add(f"ε{i}", SAME, acc.epsilon[j])
    if g.offset:
        foot = pos.feet[j]
        acc.points[foot] = plan.add(plan_name(plan, foot), RIGID, acc.points[q], vel.omega[j], acc.epsilon[j],
                                    pos.points[q], pos.points[foot])


def _prp(acc: Accelerations, g: StructuralGroup) -> None:
    plan, pos, vel = acc.plan, acc.positions, acc.velocities
    c = str(g.inner)
    (a1, v1, k1), (a2, v2, k2) = (_carrier(acc, name, c) for name in g.guides)
    u1, u2 = (pos.guide_directions[name] for name in g.guides)
    e1 = _coriolis(acc, a1, k1, v1, vel.points[c], on_link(c, k1))
    e2 = _coriolis(acc, a2, k2, v2, vel.points[c], on_link(c, k2))
    step = plan.add(plan_name(plan, c), rules.LINE_LINE, e1, u1, e2, u2)
    acc.points[c] = step
    plan.vector(f"a̅_{c}", acc.pole, step)
    for link, k in zip(g.links, (k1, k2), strict=True):
        acc.epsilon[link] = plan.add(f"ε{link}", SAME, acc.epsilon[k])
        acc.coincident[on_link(c, link)] = step


def _rpp(acc: Accelerations, g: StructuralGroup) -> None:
    plan, pos, vel = acc.plan, acc.positions, acc.velocities
    p, s, guide, (i, j) = g.outer[0], str(g.inner), g.guides[0], g.links
    pj = on_link(p, j)
    carrier, _, link = _carrier(acc, guide, s)
    v_pin = vel.coincident[pj]
    k1 = _coriolis(acc, acc.points[p], link, vel.points[p], v_pin, f"{pj}{p}")
    if link == pos.mechanism.frame:
        k2 = carrier
    else:
        through = str(pos.mechanism.guides[guide].through)
        k2 = _coriolis(acc, _on(acc, link, through, p), link, velocity_on(vel, link, through, p), v_pin, on_link(pj, link))
    step = plan.add(plan_name(plan, pj), rules.LINE_LINE, k1, pos.directions[i], k2, pos.guide_directions[guide])
    plan.vector(f"a̅_{{{pj}{p}}}^r", k1, step)
    plan.vector(f"a̅_{{{pj}}}", acc.pole, step)
    acc.coincident[pj] = step
    for k in g.links:
        acc.epsilon[k] = plan.add(f"ε{k}", SAME, acc.epsilon[link])
    if link == pos.mechanism.frame:
        acc.points[s] = step
    else:
        acc.points[s] = plan.add(plan_name(plan, s), RIGID, step, vel.omega[link], acc.epsilon[link], pos.points[p], pos.points[s])
    acc.coincident[on_link(s, j)] = acc.points[s]


GROUPS: dict[int, Callable[[Accelerations, StructuralGroup], None]] = {1: _rrr, 2: _rrp, 3: _rpr, 4: _prp, 5: _rpp}
"""Acceleration equations of each kind of group (manual 000, table 3.6)."""
