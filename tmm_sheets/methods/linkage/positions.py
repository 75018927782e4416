"""Position plan by intersecting arcs (метод засечек), group by group in order of attachment.

Source: manual 000, section 3.1; manual 002, section 1.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.mechanism.groups.contexts import Crossing, SpecialPoint, Turning
from tmm_sheets.mechanism.groups.dead_centres import near_point
from tmm_sheets.mechanism.groups.three_legs import Course, course
from tmm_sheets.mechanism.groups.triad import TRIAD, TriadGroup
from tmm_sheets.mechanism.model import Guide, Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.passages import SIDE, Passages
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
            known[group.name] = course(lambda phi: TRIAD.before(_before(self.mechanism, group, phi), group), group.when, group.near)
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
        passing = passages(self.mechanism)
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


def passages(m: Mechanism) -> Passages:
    """Change points of a mechanism."""
    return Passages(m, lambda of, phi, until: position_plan(of, phi, purpose=SEARCHED, until=until))


FOLLOWED = "ways of assembly"


def _before(mechanism: Mechanism, group: StructuralGroup, phi: Any) -> Positions:
    """Positions of all that comes before a group, and of its guides."""
    return position_plan(mechanism, phi, purpose=FOLLOWED, until=group)


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
