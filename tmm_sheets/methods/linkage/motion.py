"""Plans of velocities and accelerations (планы скоростей и ускорений): the vector equations of each group solved by two lines.

Every value is a vector from the pole, complex, m/s or m/s2; those of accelerations have normal and Coriolis segments. Of sliding
pairs the velocity of one link on the other, and the Coriolis acceleration it brings, are taken at the pair's own point, for link j
on link k: the slider block on its rocker, the slider on what carries its guide.
Source: manual 000, sections 3.3 and 3.4, tables 3.1 and 3.6.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import count
from typing import Any, ClassVar, cast

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.function import Replay
from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.step import Given, Helper, Plan, Rule, Step, StepTable, record, value_of
from tmm_sheets.mechanism.groups.contexts import Turning
from tmm_sheets.mechanism.model import Drive, Leg, Mechanism, Pair, StructuralGroup
from tmm_sheets.methods.linkage.positions import SEARCHED, Passages, Positions, position_plan
from tmm_sheets.words import marked, tr

POLE = Rule("pole", lambda z: z, ("point",), "point", marked("Choose the pole {name}."))
CRANK_VELOCITY = Rule(
    "velocity of the crank pin", lambda a, b, w: 1j * w * (b - a), ("point", "point", "number"), "vector",
    marked("From the pole p, perpendicular to {0}{1} in the sense of ω1, lay off the velocity of {1}: point {name}."),
    lambda a, v: (Helper("line", 0j, v),),
)
SIMILAR = Rule(
    "similarity", lambda q, b, big_q, big_b, big_d: q + (b - q) * (big_d - big_q) / (big_b - big_q),
    ("point", "point", "point", "point", "point"), "point",
    marked("By similarity find point {name}: |{0}{name}| : |{0}{1}| = {2}{4} : {2}{3}."),
    lambda a, v: (Helper("line", a[0], v),),
)
RIGID = Rule(
    "velocity on a turning link", lambda q, w, big_q, big_m: q + 1j * w * (big_m - big_q),
    ("point", "number", "point", "point"), "point",
    marked("From {0}, perpendicular to {2}{3}, lay off the velocity of rotation: point {name}."),
    lambda a, v: (Helper("line", a[0], v),), laid_off=True,
)


def turning(big_q: Any, big_b: Any, q: Any, b: Any) -> Any:
    """Angular velocity, or acceleration, of a link from the vectors ``q`` and ``b`` of two of its points."""
    r = big_b - big_q
    return ar.cross(r, b - q) / np.abs(r) ** 2


ANGULAR_VELOCITY = Rule(
    "angular velocity", turning, ("point", "point", "point", "point"), "number",
    marked("Angular velocity |{name}| = |{2}{3}|·μ_V / {0}{1}, with its sign {name} = {value} rad/s."), unit="rad/s",
)
OF_CRANK = Rule("angular velocity of the crank", lambda sense, w: sense * w, ("number", "number"), "number",
                marked("In its sense of rotation {name} = {1} rad/s."), unit="rad/s")
SAME = Rule("the same", lambda w: w, ("number",), "number", "{name} = {value}.", unit="rad/s")


WAY = Rule("velocity about the other end", lambda turning, w, length: turning * w * length, ("number", "number", "length"),
           "number", "{name} = {value}.", beyond_paper=True, unit="m/s")


@dataclass
class MotionPolygon(ABC):
    """What velocity and acceleration polygons have in common: vectors of points from the pole, rates of turning of links.

    ``reference`` holds two points of a link and their vectors, ``coincident`` the points of guides under those of the sliders,
    ``carried`` those of them that were found by the turning of their link, ``special`` the singular points of groups of class III.
    """

    POLE: ClassVar[str]
    VECTOR: ClassVar[str]
    RATE: ClassVar[str]
    TURNING: ClassVar[Rule]
    SAME: ClassVar[Rule]
    MARKS: ClassVar[dict[str, str]]
    ABSOLUTE: ClassVar[int]

    positions: Positions
    plan: Plan
    points: dict[str, Step] = field(default_factory=dict)
    rates: dict[str, Step] = field(default_factory=dict)
    reference: dict[str, tuple[str, str, Step, Step]] = field(default_factory=dict)
    coincident: dict[str, Step] = field(default_factory=dict)
    carried: list[Step] = field(default_factory=list)
    special: dict[str, Step] = field(default_factory=dict)

    @property
    def pole(self) -> Step:
        """The pole."""
        return self.plan[self.POLE]

    def name(self, point: str) -> str:
        """Free name on the plan for a point: the small letter of the mechanism's, with a prime where the plan has that already."""
        return self.plan.named(point.lower())

    def on(self, link: str, through: str, at: str) -> Step:
        """Vector of the point of a link that coincides with ``at``, from the link's point ``through``; drawn once."""
        here = on_link(at, link)
        if here not in self.coincident:
            start = self.coincident.get(on_link(through, link), self.points[through])
            if through == at:
                return start
            found = self.coincident[here] = self.rotated(here, start, link, through, at)
            self.plan.vector(f"{self.VECTOR}_{{{here}}}", self.pole, found)
            self.carried.append(found)
        return self.coincident[here]

    def guide(self, guide: str, at: str) -> Step:
        """Motion of the guide's point that coincides with ``at``; the pole for a fixed guide."""
        g, m = self.positions.mechanism.guides[guide], self.positions.mechanism
        return self.pole if g.link == m.frame else self.on(g.link, str(g.through), at)

    def start(self, leg: Leg) -> Step:
        """Motion of what a leg is paired with outside, where it is paired."""
        return self.guide(leg.guide, leg.corner) if leg.guide else self.points[leg.outer]

    def against(self, leg: Leg) -> str:
        """Letters of that point."""
        return leg.outer or on_link(leg.corner, self.positions.mechanism.guides[leg.guide].link)

    def end(self, leg: Leg, point: str, slotted_in: str) -> Step:
        """End of what is known by a leg of the motion of a point; ``slotted_in`` is the link whose slot its block slides in."""
        return self.start(leg)

    def rest(self, leg: Leg) -> Step:
        """Direction of what is not known of it: across a rod, along a guide or a slot."""
        if leg.guide:
            return self.positions.guide_directions[leg.guide]
        return self.perpendicular(leg.outer, leg.corner) if leg.slot is None else self.positions.directions[leg.link]

    def normal(self, a: Step, link: str, big_q: str, big_b: str, letters: str = "") -> Step:
        """End of what is known of the motion of ``big_b`` round ``big_q``, laid off from ``a``: of a velocity nothing."""
        return a

    def meet(self, point: str, legs: tuple[Leg, ...], known: tuple[Step, ...], slotted_in: str = "") -> Step:
        """Motion of a point held by two legs: lines along what is not known by each meet there. With its vectors.

        ``slotted_in``, with a slider block among the legs, is the link that turns its slot.
        """
        ends = [self.end(leg, point, slotted_in) for leg in legs]
        lines = [x for leg, end in zip(legs, ends, strict=True) for x in (end, self.rest(leg))]
        step = self.plan.add(self.name(point), rules.LINE_LINE, *lines, *known)
        vectors = []
        for leg, end in zip(legs, ends, strict=True):
            if end is not self.pole:
                letters, mark = point + self.against(leg), self.MARKS[leg.form]
                vectors.append((letters if leg.form == "RR" and not (mark or slotted_in) else f"{{{letters}}}{mark}", end))
        vectors.insert(self.ABSOLUTE * len(vectors), (f"{{{point}}}" if slotted_in else point, self.pole))
        for letters, tail in vectors:
            self.plan.vector(f"{self.VECTOR}_{letters}", tail, step)
        return step

    def turns_on(self, leg: Leg, step: Step) -> None:
        """How the link of a leg turns whose inner hinge moves by ``step``."""
        if leg.guide:
            self.turns_with(leg.link, self.positions.mechanism.guides[leg.guide].link)
            self.coincident[on_link(leg.corner, leg.link)] = step
        else:
            self.turning(leg.link, leg.outer, leg.corner, self.points[leg.outer], step)

    @abstractmethod
    def rotated(self, point: str, start: Step, link: str, q: str, b: str) -> Step:
        """Vector of a point of a turning link at ``b``, from that at ``q``; named after ``point``."""

    def similar(self, point: str, q: Step, b: Step, big_q: str, big_b: str, name: str = "") -> Step:
        """Vector of a point of a link by similarity, from those of two of its points; named after it, or otherwise."""
        at = self.positions.place
        return self.plan.add(self.name(name or point), SIMILAR, q, b, at(big_q), at(big_b), at(point))

    def perpendicular(self, p: str, q: str) -> Step:
        """Direction across the line of two points, drawn once."""
        ray = self.positions.direction(p, q)
        return self.plan.add_once(f"⟂{ray.name}", rules.TURN, ray)

    def known(self, group: StructuralGroup) -> tuple[Step, ...]:
        """What is known of the crossing of a group's lines better than they tell: their sine, the way along the first."""
        turning = self.positions.turnings.get(group.links[0])
        if turning is None:
            return self.positions.known_sine(group)
        way = self.plan.auxiliary(f"{self.RATE}l {group.name}", *self.way(turning, group), group.lengths[0])
        return (*self.positions.known_sine(group), way)

    @abstractmethod
    def way(self, turning: Turning, group: StructuralGroup) -> tuple[Any, ...]:
        """Rule and arguments that tell how far a point is laid off across its link, one metre from the other end."""

    def turning(self, link: str, big_q: str, big_b: str, q: Step, b: Step) -> None:
        """Rate of turning of a link from the vectors ``q`` and ``b`` of two of its points."""
        z = self.positions.points
        self.rates[link] = self.plan.add(f"{self.RATE}{link}", self.TURNING, z[big_q], z[big_b], q, b)
        self.reference[link] = (big_q, big_b, q, b)

    def turns_with(self, link: str, other: str) -> None:
        """Rate of turning of a link that does not turn against another: nobody reads of it in a search."""
        same = self.rates[other]
        self.rates[link] = same if self.plan.search is not None else self.plan.add(f"{self.RATE}{link}", self.SAME, same)

    def fill(self, initial: Callable[[], None], driven: Callable[[Any, Drive], None]) -> None:
        """Construct the motion of the frame, of the initial link (or of the group that drives it) and of all groups in turn."""
        m, pole = self.positions.mechanism, self.plan.add(self.POLE, POLE, 0j)
        self.points.update(dict.fromkeys(m.fixed, pole))
        self.rates[m.frame] = self.plan.add(f"{self.RATE}0", self.SAME, 0.0)
        if m.drive is None:
            initial()
        else:
            driven(self, m.drive)
        self.further_points(m.crank.link)
        for g in m.groups:
            if m.drive is None or g.name != m.drive.group.name:
                g.kind.motion(self, g)
            for link in g.links:
                self.further_points(link)

    def further_points(self, link: str) -> None:
        """Vectors of the points of a link that its group did not need: by similarity, or by turning round one of them."""
        for p in self.positions.mechanism.points:
            if p.link != link or p.name in self.points:
                continue
            if link in self.reference:
                big_q, big_b, q, b = self.reference[link]
                found = self.similar(p.name, q, b, big_q, big_b)
            else:
                start = self.coincident.get(on_link(p.start, link), self.points[p.start])
                found = self.rotated(p.name, start, link, p.start, p.name)
            self.plan.vector(f"{self.VECTOR}_{p.name}", self.pole, found)
            self.points[p.name] = found


class Velocities(MotionPolygon):
    """Velocity plan: ``points`` m/s from the pole for every point of the mechanism, ``omega`` rad/s of every link."""

    POLE, VECTOR, RATE, TURNING, SAME = "p", "V̅", "ω", ANGULAR_VELOCITY, SAME
    MARKS, ABSOLUTE = dict.fromkeys(("RR", "PR", "RP"), ""), 0

    def first(self, turning: Turning, group: StructuralGroup) -> Any:
        """Angle that the first link of a group with change points turns by an angle of the crank; NaN where it is not known."""
        if turning.first is not None:
            return turning.first
        return Passages(self.positions.mechanism).row(group, self.positions.phi, "turning",
        lambda m, phi: velocity_plan(position_plan(m, phi, purpose=SEARCHED)).omega[m.groups[-1].links[0]].value)

    @property
    def omega(self) -> dict[str, Step]:
        """Angular velocity of every link, rad/s."""
        return self.rates

    def way(self, turning: Turning, group: StructuralGroup) -> tuple[Any, ...]:
        """Rule and arguments that tell the velocity of a point about the other end of its link."""
        return WAY, self.first(turning, group), self.omega[self.positions.mechanism.crank.link]

    def rotated(self, point: str, start: Step, link: str, q: str, b: str) -> Step:
        """Velocity of a point of a turning link at ``b``, from that at ``q``; named after ``point``."""
        z = self.positions.points
        return self.plan.add(self.name(point), RIGID, start, self.omega[link], z[q], z[b])


def velocity_plan(pos: Positions) -> Velocities:
    """Record the velocity plans of all positions of ``pos``."""
    from tmm_sheets.methods.linkage.drive import drive_velocities

    c = pos.mechanism.crank
    plan = Plan(f"velocities{pos.where}", tr("Velocity polygons"), "m/s", pos.plan.labels, "p", pos.plan.search)
    vel = Velocities(pos, plan)

    def initial() -> None:
        vel.omega[c.link] = plan.add(f"ω{c.link}", OF_CRANK, c.sense, c.speed)
        b = plan.add(vel.name(c.pin), CRANK_VELOCITY, pos.points[c.pivot], pos.points[c.pin], vel.omega[c.link])
        plan.vector(f"V̅_{c.pin}", vel.pole, b)
        vel.points[c.pin] = b
        vel.reference[c.link] = (c.pivot, c.pin, vel.pole, b)

    vel.fill(initial, drive_velocities)
    return vel


# --- accelerations ---------------------------------------------------------------------------------------------------------

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
CRANK_ACCELERATION = Rule("angular acceleration of the crank", lambda sense, e: sense * e, ("number", "number"), "number",
                marked("In its sense of rotation {name} = {1} rad/s²."), unit="rad/s2")
SAME_ACCELERATION = Rule("the same acceleration", lambda e: e, ("number",), "number", "{name} = {value}.", unit="rad/s2")
RIGID_ACCELERATION = Rule(
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

TANGENTIAL_WAY = Rule("tangential acceleration about the other end",
           lambda turning, second, w, e, length: (turning * e + second * w * w) * length,
           ("number", "number", "number", "number", "length"), "number", "{name} = {value}.", beyond_paper=True, unit="m/s2")


@dataclass
class Accelerations(MotionPolygon):
    """Acceleration plan: ``points`` m/s2 from the pole for every point, ``epsilon`` rad/s2 of every link."""

    POLE, VECTOR, RATE, TURNING, SAME = "π", "a̅", "ε", ANGULAR_ACCELERATION, SAME_ACCELERATION
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
            second = Passages(pos.mechanism).row(group, pos.phi, "second turning", lambda m, phi: acceleration_plan(
                velocity_plan(position_plan(m, phi, purpose=SEARCHED))).epsilon[m.groups[-1].links[0]].value)
        return TANGENTIAL_WAY, self.velocities.first(turning, group), second, self.velocities.omega[crank], self.epsilon[crank]

    def rotated(self, point: str, start: Step, link: str, q: str, b: str) -> Step:
        """Acceleration of a point of a turning link at ``b``, from that at ``q``; named after ``point``."""
        z = self.positions.points
        return self.plan.add(self.name(point), RIGID_ACCELERATION, start, self.velocities.omega[link], self.epsilon[link],
                             z[q], z[b])

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
    acc.epsilon[c.link] = (plan.add(name, CRANK_ACCELERATION, c.sense, c.acceleration) if epsilon1 is None
                           else plan.add(name, CRANK_ACCELERATION, c.sense, epsilon1) if isinstance(epsilon1, Step)
                           else plan.add(name, SAME_ACCELERATION, epsilon1))
    centre, pin = pos.points[c.pivot], pos.points[c.pin]
    b_name = acc.name(c.pin)
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
    """Number the ends of the normal and Coriolis segments where there are several, around other names.

    A single one is numbered beside a point of its letter, which has this to itself: a point K is k, as in the velocity polygon.
    """
    plan, points = acc.plan, tuple(acc.points.values())
    for letter, rule in (("n", NORMAL), ("k", CORIOLIS)):
        alike = [step for step in plan if step.rule is rule and step.name.startswith(letter) and step not in points]
        others = {step.symbol or step.name for step in plan if step not in alike}
        free = (name for i in count(1) if (name := f"{letter}{i}") not in others)
        own = [step for step in points if step.name == f"{letter}′"]
        if len(alike) > 1 or own:
            for step, name in (*zip(alike, free, strict=False), *((step, letter) for step in own)):
                plan.lettered(step, name)


def _free(plan: Plan, letter: str) -> str:
    """The letter itself, or with the first free number when the plan has it already."""
    return letter if letter not in plan else next(f"{letter}{i}" for i in range(2, 100) if f"{letter}{i}" not in plan)


SLIDING: StepTable = {
    "V#": ("slides there", "V_{#}", Rule(
        "sliding velocity", lambda a, b: a - b, ("point", "point"), "vector",
        marked("Velocity of sliding {name} = {value}, the vector {1}{0} of the velocity polygon."), unit="m/s")),
    "a#к": ("ω V#", lambda: tr("a_{{{points}}}^c").format(points="#"), Rule(
        "Coriolis acceleration of sliding", lambda w, v: 2j * w * v, ("number", "vector"), "vector",
        marked("Coriolis acceleration {name} = 2ω·V = {value}: the sliding velocity turned by 90° in the sense of ω."),
        unit="m/s2")),
}


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
        self.coriolis[index] = record(self.plan, "V# a#к", SLIDING, wheel=index, given={
            "slides": motion_at(vel, j, at), "there": motion_at(vel, k, at), "ω": vel.omega[k]})
        self.velocities[index] = self.plan[f"V{index}"]


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
    return vel.pole if link == vel.positions.mechanism.frame else vel.coincident.get(on_link(at, link), vel.points[at])


# --- what searches ask at other angles ----------------------------------------------------------------------------------------

OfAngles = Callable[[Any], Any]
"""Values at crank angles, rad in the world frame, in the shape of these."""
REMEMBERED = 32
"""Sets of angles whose values are remembered: loads are asked for at the positions of the sheets again and again."""
RECORDED = "watched"
"""Under which a mechanism keeps them."""


class Watched:
    """What a search for ``purpose`` asks of a mechanism, each as a function of the crank angle; see :class:`Replay`."""

    def __init__(self, mechanism: Mechanism, purpose: str) -> None:
        self.mechanism = mechanism
        self.purpose = purpose

    def point(self, name: str) -> OfAngles:
        """Place of a point, m."""
        return self._of(lambda plans: plans.positions.points[name])

    def direction(self, link: str) -> OfAngles:
        """Direction of a link."""
        return self._of(lambda plans: plans.positions.directions[link])

    def velocity(self, name: str) -> OfAngles:
        """Velocity of a point, m/s."""
        return self._of(lambda plans: plans.velocities.points[name])

    def omega(self, link: str) -> OfAngles:
        """Angular velocity of a link, rad/s."""
        return self._of(lambda plans: plans.velocities.omega[link])

    def positions(self, phi: Any) -> Positions:
        """Position plan whose values are those at crank angles."""
        plans = self._plans(phi)
        if plans.positions.chosen:
            return plans.positions
        steps = list(plans.positions.plan)
        done = dict(zip(map(id, steps), Replay(steps, [plans.row])([phi], self.mechanism.search(self.purpose)), strict=True))
        return replace(plans.positions, angle=phi, value=lambda step: done[id(step)])

    def _of(self, pick: Callable[[_Plans], Step]) -> OfAngles:
        replay: Replay | None = None
        known = dict[tuple[Any, ...], Any]()

        def values(phi: Any) -> Any:
            nonlocal replay
            asked = np.shape(phi), np.asarray(phi, dtype=float).tobytes()
            if asked in known:
                return known[asked]
            if replay is None:
                plans = self._plans(phi)
                found = Replay([pick(plans)], [plans.row])
                replay = None if plans.positions.chosen else found  # those are chosen by the angles they are recorded for
            else:
                found = replay
            (value,) = found([phi], self.mechanism.search(self.purpose))
            if len(known) == REMEMBERED:
                known.clear()
            known[asked] = np.broadcast_to(value, np.shape(phi))
            return known[asked]

        return values

    def _plans(self, phi: Any) -> _Plans:
        """The plans of all searches, or others for these angles where something is chosen by them."""
        known = self.mechanism.recorded
        if RECORDED not in known or known[RECORDED].positions.chosen:
            known[RECORDED] = _Plans(self.mechanism, self.purpose, phi)
        return cast("_Plans", known[RECORDED])


class _Plans:
    """Plans recorded for some crank angles."""

    def __init__(self, mechanism: Mechanism, purpose: str, phi: Any) -> None:
        self.row = Given(phi, "crank angles", "φ_1", "rad")
        self.positions: Positions = position_plan(mechanism, self.row, purpose=purpose)

    @cached_property
    def velocities(self) -> Velocities:
        """Velocity plans."""
        return velocity_plan(self.positions)
