"""Acceleration plans (планы ускорений) with normal and Coriolis segments.

Every value is a vector from the pole, complex, m/s2. Source: manual 000, section 3.4 and table 3.6.

Sliding pairs: velocity of one link on the other, and the Coriolis acceleration it brings.
Both are taken at the pair's own point, for link j on link k: the slider block on its rocker, the slider on what carries its guide.
Source: manual 000, sections 3.3 and 3.4.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np

from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.step import Helper, Plan, Rule, Step, value_of
from tmm_sheets.mechanism.groups.contexts import Turning
from tmm_sheets.mechanism.model import Leg, Mechanism, Pair, StructuralGroup
from tmm_sheets.methods.linkage.positions import SEARCHED, passages, position_plan
from tmm_sheets.methods.linkage.velocities import MotionPolygon, Velocities, plan_name, turning, velocity_plan
from tmm_sheets.words import marked, tr

NORMAL = Rule(
    "normal acceleration", lambda a, w, big_q, big_b: a - w * w * (big_b - big_q),
    ("point", "number", "point", "point"), "point",
    marked("From {0}, parallel to {3}{2} towards the centre {2}, lay off the normal acceleration ω²·l: point {name}."),
    lambda a, v: (Helper("line", a[0], v),), laid_off=True,
)
TANGENTIAL = Rule(
    "tangential acceleration", lambda a, e, big_q, big_b: a + 1j * e * (big_b - big_q),
    ("point", "number", "point", "point"), "point",
    marked("From {0}, perpendicular to {2}{3} in the sense of ε, lay off the tangential acceleration ε·l: point {name}."),
    lambda a, v: (Helper("line", a[0], v),), laid_off=True,
)
CORIOLIS = Rule(
    "Coriolis acceleration", lambda a, w, v_from, v_to: a + 2j * w * (v_to - v_from),
    ("point", "number", "point", "point"), "point",
    marked("From {0} lay off the Coriolis acceleration 2ω·V, the vector {2}{3} of the velocity polygon turned by 90° in the sense "
           "of ω: point {name}."),
    lambda a, v: (Helper("line", a[0], v),), laid_off=True,
)
OF_CRANK = Rule("angular acceleration of the crank", lambda sense, e: sense * e, ("number", "number"), "number",
                marked("In its sense of rotation {name} = {1} rad/s²."), unit="rad/s2")
SAME = Rule("the same acceleration", lambda e: e, ("number",), "number", "{name} = {value}.", unit="rad/s2")
RIGID = Rule(
    "acceleration on a turning link", lambda a, w, e, big_q, big_m: a + (1j * e - w * w) * (big_m - big_q),
    ("point", "number", "number", "point", "point"), "point",
    marked("From {0} lay off the normal and tangential acceleration of the point of the link that coincides with {4}: point "
           "{name}."),
    lambda a, v: (Helper("line", a[0], v),), laid_off=True,
)

ANGULAR_ACCELERATION = Rule(
    "angular acceleration", turning, ("point", "point", "point", "point"), "number",
    marked("Angular acceleration |{name}| = a^τ / {0}{1}, with its sign {name} = {value} rad/s²."), unit="rad/s2",
)

WAY = Rule("tangential acceleration about the other end",
           lambda turning, second, w, e, length: (turning * e + second * w * w) * length,
           ("number", "number", "number", "number", "length"), "number", "{name} = {value}.", beyond_paper=True, unit="m/s2")


@dataclass
class Accelerations(MotionPolygon):
    """Acceleration plan: ``points`` m/s2 from the pole for every point, ``epsilon`` rad/s2 of every link."""

    POLE, VECTOR, RATE, TURNING, SAME = "π", "a̅", "ε", ANGULAR_ACCELERATION, SAME
    MARKS, ABSOLUTE = {"RR": "^τ", "PR": "^r", "RP": "^r"}, 1

    velocities: Velocities = field(kw_only=True)

    @property
    def epsilon(self) -> dict[str, Step]:
        """Angular acceleration of every link, rad/s2."""
        return self.rates

    @property
    def of_coriolis(self) -> set[str]:
        """Symbols of the Coriolis segments."""
        return {s.symbol for s in self.plan.segments if s.head.rule is CORIOLIS}

    def end(self, leg: Leg, point: str, slotted_in: str) -> Step:
        """With the normal acceleration about the outer hinge, or the Coriolis acceleration on the guide or in the slot."""
        start, letters, vel = self.start(leg), point + self.against(leg), self.velocities
        if leg.form == "RR":
            return self.normal(start, leg.link, leg.outer, leg.corner, letters)
        link = self.positions.mechanism.guides[leg.guide].link if leg.guide else slotted_in
        moved = vel.coincident[point] if point in vel.coincident and slotted_in else vel.points[point]
        return self.coriolis(start, link, vel.start(leg), moved, letters)

    def way(self, turning: Turning, group: StructuralGroup) -> tuple[Any, ...]:
        """Rule and arguments that tell the tangential acceleration of a point about the other end of its link."""
        pos, crank = self.positions, self.positions.mechanism.crank.link
        second = turning.second
        if second is None:
            second = passages(pos.mechanism).row(group, pos.phi, "second turning", lambda m, phi: acceleration_plan(
                velocity_plan(position_plan(m, phi, purpose=SEARCHED))).epsilon[m.groups[-1].links[0]].value)
        return WAY, self.velocities.first(turning, group), second, self.velocities.omega[crank], self.epsilon[crank]

    def rotated(self, point: str, start: Step, link: str, q: str, b: str) -> Step:
        """Acceleration of a point of a turning link at ``b``, from that at ``q``; named after ``point``."""
        z = self.positions.points
        return self.plan.add(self.name(point), RIGID, start, self.velocities.omega[link], self.epsilon[link], z[q], z[b])

    def coriolis(self, a: Step, link: str, v_from: Step, v_to: Step, symbol: str) -> Step:
        """End of the Coriolis segment; the point itself where the carrier does not turn (a fixed guide: a^k = 0)."""
        if link == self.positions.mechanism.frame:
            return a
        k = self.plan.add(_free(self.plan, "k"), CORIOLIS, a, self.velocities.omega[link], v_from, v_to)
        self.plan.vector(tr("a̅_{{{points}}}^c").format(points=symbol), a, k)
        return k

    def normal(self, a: Step, link: str, big_q: str, big_b: str, letters: str = "") -> Step:
        """End of the normal acceleration of ``big_b`` round ``big_q``, laid off from ``a``."""
        at = self.positions.place
        n = self.plan.add(_free(self.plan, "n"), NORMAL, a, self.velocities.omega[link], at(big_q), at(big_b))
        self.plan.vector(f"a̅_{{{letters or big_b + big_q}}}^n", a, n)
        return n


def acceleration_plan(vel: Velocities, epsilon1: Any = None, where: str = "") -> Accelerations:
    """Record the acceleration plans of all positions.

    ``epsilon1`` is the angular acceleration of the crank, rad/s2: a number or of shape (n,), signed, or a step, positive in the
    sense of rotation; that of the mechanism unless told. ``where`` stands behind the plan's name.
    """
    from tmm_sheets.methods.linkage.drive import drive_accelerations

    pos = vel.positions
    plan = Plan(f"accelerations{pos.where}{where}", tr("Acceleration polygon"), "m/s2", pos.plan.labels, "π", pos.plan.search)
    acc = Accelerations(pos, plan, velocities=vel)
    acc.fill(lambda: _of_crank(acc, epsilon1), drive_accelerations)
    _number_alike(acc)
    return acc


def _of_crank(acc: Accelerations, epsilon1: Any) -> None:
    """Acceleration of the pin of a crank whose turning is given."""
    plan, pos, vel, pole, c = acc.plan, acc.positions, acc.velocities, acc.pole, acc.positions.mechanism.crank
    name = f"ε{c.link}"
    acc.epsilon[c.link] = (plan.add(name, OF_CRANK, c.sense, c.acceleration) if epsilon1 is None
                           else plan.add(name, OF_CRANK, c.sense, epsilon1) if isinstance(epsilon1, Step)
                           else plan.add(name, SAME, epsilon1))
    centre, pin = pos.points[c.pivot], pos.points[c.pin]
    b_name = plan_name(plan, c.pin)
    if np.any(np.asarray(value_of(c.acceleration if epsilon1 is None else epsilon1)) != 0):
        n = plan.add("n1" if b_name != "n1" else plan.free("n1′"), NORMAL, pole, vel.omega[c.link], centre, pin)
        b = plan.add(b_name, TANGENTIAL, n, acc.epsilon[c.link], centre, pin)
        plan.vector(f"a̅_{c.pin}^n", pole, n)
        plan.vector(f"a̅_{c.pin}^τ", n, b)
    else:
        b = plan.add(b_name, NORMAL, pole, vel.omega[c.link], centre, pin)
    plan.vector(f"a̅_{c.pin}", pole, b)
    acc.points[c.pin] = b
    acc.reference[c.link] = (c.pivot, c.pin, pole, b)


def _number_alike(acc: Accelerations) -> None:
    """Ends of the normal and of the Coriolis segments are numbered in their order where there are several, around other names."""
    plan, points = acc.plan, tuple(acc.points.values())
    for letter, rule in (("n", NORMAL), ("k", CORIOLIS)):
        alike = [step for step in plan if step.rule is rule and step.name.startswith(letter) and step not in points]
        others = {step.symbol or step.name for step in plan if step not in alike}
        free = (name for i in count(1) if (name := f"{letter}{i}") not in others)
        if len(alike) > 1:
            for step, name in zip(alike, free, strict=False):
                plan.lettered(step, name)


def _free(plan: Plan, letter: str) -> str:
    """The letter itself, or with the first free number when the plan has it already."""
    if letter not in plan:
        return letter
    return next(f"{letter}{i}" for i in range(2, 100) if f"{letter}{i}" not in plan)


RELATIVE = Rule("sliding velocity", lambda a, b: a - b, ("point", "point"), "vector",
                marked("Velocity of sliding {name} = {value}, the vector {1}{0} of the velocity polygon."), unit="m/s")
SLIDING_CORIOLIS = Rule("Coriolis acceleration of sliding", lambda w, v: 2j * w * v, ("number", "vector"), "vector",
                marked("Coriolis acceleration {name} = 2ω·V = {value}: the sliding velocity turned by 90° in the sense of ω."),
                unit="m/s2")


class Sliding:
    """Velocities of sliding, m/s, and Coriolis accelerations, m/s2, by the links of the pair: "23" is link 2 on link 3."""

    def __init__(self, vel: Velocities) -> None:
        pos = vel.positions
        self.plan = Plan(f"sliding{pos.where}", tr("Sliding velocities and Coriolis accelerations"), "m/s", pos.plan.labels,
                         search=pos.plan.search)
        self.velocities: dict[str, Step] = {}
        self.coriolis: dict[str, Step] = {}
        for pair in pos.mechanism.pairs:
            if pair.motion == "translation":
                self._of(vel, pair)

    def _of(self, vel: Velocities, pair: Pair) -> None:
        j, k = ordered(vel.positions.mechanism, pair)
        at, index = pair.name.rstrip("′″"), pair_index(j, k)
        v = self.plan.add(f"V{index}", RELATIVE, motion_at(vel, j, at), motion_at(vel, k, at), symbol=f"V_{{{index}}}")
        self.velocities[index] = v
        letters = tr("a_{{{points}}}^c").format(points=index)
        self.coriolis[index] = self.plan.add(f"a{index}к", SLIDING_CORIOLIS, vel.omega[k], v, symbol=letters)


def ordered(m: Mechanism, pair: Pair) -> tuple[str, str]:
    """The link of a sliding pair that slides and the one it slides on: what was there before, or the rocker of a slider block."""
    a, b = pair.links
    placed = [m.frame, m.crank.link]
    for g in m.groups:
        if a in placed and b in g.links:
            return b, a
        placed += g.links
    return a, b


def motion_at(vel: Velocities, link: str, at: str) -> Step:
    """Velocity of the point of a link that coincides with a point of the mechanism."""
    if link == vel.positions.mechanism.frame:
        return vel.pole
    return vel.coincident.get(on_link(at, link), vel.points[at])
