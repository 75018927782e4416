"""Kind 1, RRR: two rods joined by a hinge, hinged to what is before them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.groups.contexts import Crossing, OuterReaction, Outline, Turning
from tmm_sheets.mechanism.groups.dead_centres import (
    ARCS,
    DISTANCE,
    HALF_BESIDE_ARCS,
    HALF_OF_ARCS,
    LINE_OF_CENTRES,
    SIGNED_DISTANCE,
    fold_and_stretch,
    gaps_of_arcs,
    measured,
    meets,
    on_crank,
    passing,
    reaches,
    span_from_crank,
)
from tmm_sheets.mechanism.groups.limits import AssemblyLimit, extremes, lacking, less, mm, more, rounding, sine, span, unrounded
from tmm_sheets.mechanism.model import GroupKind, Mechanism, Pair, StructuralGroup, turning
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.construction.limit_angles import Gaps
    from tmm_sheets.mechanism.model import Accelerations, Kinetostatics, Positions, Velocities

SINE = Rule("sine between links", lambda h, d, r1, r2, side: side * h * d / (r1 * r2), (), "number",
            marked("Sine of the angle between the links {name} = {value}."), beyond_paper=True, unit="1")


class RRRKind(GroupKind):
    """Kind 1: two rods joined by a hinge, hinged to what is before them."""

    number, form, orders = 1, marked("RRR"), ("RRR",)
    two_ways = True

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        (p, q), c, (i, j) = g.outer, str(g.inner), g.links
        return [turning(p, m.owner(p), i), turning(c, i, j), turning(q, j, m.owner(q))]

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        p, q = g.outer
        assert g.inner is not None
        known = pos.crossing(g)
        pos.points[g.inner] = pos.plan.add(g.inner, rules.ARC_ARC, pos.points[p], g.lengths[0], pos.points[q], g.lengths[1],
                                           pos.side(g), *known)
        pos.directions[g.links[0]] = pos.direction(p, g.inner)
        pos.directions[g.links[1]] = pos.direction(q, g.inner)

    def velocity(self, vel: Velocities, g: StructuralGroup) -> None:
        plan = vel.plan
        (p, q), c = g.outer, str(g.inner)
        n1 = vel.perpendicular(p, c)
        n2 = vel.perpendicular(q, c)
        step = plan.add(vel.name(c), rules.LINE_LINE, vel.points[p], n1, vel.points[q], n2, *vel.known(g))
        vel.points[c] = step
        plan.vector(f"V̅_{c}", vel.pole, step)
        plan.vector(f"V̅_{c}{p}", vel.points[p], step)
        if vel.points[q] is not vel.pole:
            plan.vector(f"V̅_{c}{q}", vel.points[q], step)
        vel.turning(g.links[0], p, c, vel.points[p], step)
        vel.turning(g.links[1], q, c, vel.points[q], step)

    def acceleration(self, acc: Accelerations, g: StructuralGroup) -> None:
        plan = acc.plan
        (p, q), c, (i, j) = g.outer, str(g.inner), g.links
        n1 = acc.normal(acc.points[p], i, p, c)
        n2 = acc.normal(acc.points[q], j, q, c)
        step = plan.add(acc.name(c), rules.LINE_LINE, n1, acc.perpendicular(p, c), n2, acc.perpendicular(q, c), *acc.known(g))
        acc.points[c] = step
        plan.vector(f"a̅_{{{c}{p}}}^τ", n1, step)
        plan.vector(f"a̅_{{{c}{q}}}^τ", n2, step)
        plan.vector(f"a̅_{c}", acc.pole, step)
        acc.turning(i, p, c, acc.points[p], step)
        acc.turning(j, q, c, acc.points[q], step)

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 1: tangential parts from moments of each link about the middle hinge, normal parts from the plan."""
        pos, m = forces.positions, forces.positions.mechanism
        (i, j), (p, q), c = g.links, g.outer, str(g.inner)
        a, b = m.owner(p), m.owner(q)
        parts = []
        for link, other, end in ((i, a, p), (j, b, q)):
            total = forces.moment_sum(f"ΣM{link}", pos.points[c], [link])
            parts.append(forces.tangential(link, other, total, c, end))
        f_one, f_two, _ = forces.group_polygon(g, parts[0], parts[1], pos.direction(p, c), pos.direction(q, c), (a, b),
                                               pos.known_sine(g))
        forces.react(i, a, pos.points[p], f_one)
        forces.react(j, b, pos.points[q], f_two)

    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        (p, q), (l1, l2) = g.outer, g.lengths
        first, second = f"{p}{g.inner}", f"{g.inner}{q}"
        (long, a), (short, b) = sorted(((first, l1), (second, l2)), key=lambda x: -x[1])

        def hint(pos: Positions) -> str:
            low, high = extremes(span(pos, p, q))
            for name, other in ((first, l2), (second, l1)):
                least, most = max(high - other, other - low), other + low
                if most > least * 1.001:
                    return tell("try {rod} from {least} to {most}").format(rod=name, least=more(least), most=less(most))
            return tell("try {first} = {second} = {least} or longer").format(first=first, second=second, least=more(high / 2))

        def around(pos: Positions) -> Any:
            return rounding(l1 + l2, pos.value(pos.points[p]), pos.value(pos.points[q]))

        return [
            AssemblyLimit(m.crank.length, lambda pos: unrounded(l1 + l2 - span(pos, p, q), around(pos)),
                          lambda lack: tell("{first} = {l1} and {second} = {l2} together are {lack} too short").format(
                              first=first, second=second, l1=mm(l1), l2=mm(l2), lack=lacking(lack)), hint),
            AssemblyLimit(m.crank.length, lambda pos: unrounded(span(pos, p, q) - (a - b), around(pos)),
                          lambda lack: tell("{long} = {a} is {lack} too long beside {short} = {b}").format(
                              long=long, short=short, a=mm(a), b=mm(b), lack=lacking(lack)), hint),
        ]

    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        (p, q), c = (pos.points[name].value for name in g.outer), pos.points[str(g.inner)].value
        return size / min(g.lengths) * size / np.abs(p - q) / sine(ar.ray(p, c), ar.ray(q, c))

    def gaps(self, m: Mechanism, g: StructuralGroup) -> Gaps | None:
        """(l2 + l3)^2 - d^2 and d^2 - (l2 - l3)^2, d the distance of the outer hinges."""
        span = span_from_crank(m, g)
        return None if span is None else gaps_of_arcs(*span, *g.lengths)

    def gaps_at(self, pos: Positions, g: StructuralGroup) -> tuple[Any, Any, Any]:
        (p, q), (l1, l2) = (pos.points[name].value for name in g.outer), g.lengths
        d = np.abs(q - p)
        return (l1 + l2 - d) * (l1 + l2 + d), (d - l1 + l2) * (d + l1 - l2), (l1 + l2) * rounding(l1 + l2, p, q)

    def crossing(self, m: Mechanism, g: StructuralGroup, phi: Any) -> Crossing | None:
        """Half-chord h = sqrt(((l2 + l3)^2 - d^2) (d^2 - (l2 - l3)^2)) / 2d."""
        span, gaps = span_from_crank(m, g), self.gaps(m, g)
        if span is None or gaps is None:
            return None
        numbers = (*span, *g.lengths)
        met = meets(span, gaps, *g.lengths)
        turning = passing(m, g, phi, ARCS, numbers, turned=met) if gaps.touching else None
        side, line = g.side if turning is None else turning.side, None
        if met:
            line = Step(f"u {g.name}", LINE_OF_CENTRES, (phi, *span, 1.0 if on_crank(m, g.outer[0]) else -1.0))
        half, distance = measured(g, phi, (HALF_OF_ARCS, numbers), (SIGNED_DISTANCE, numbers) if met else (DISTANCE, span))
        return Crossing(half, distance, Step(f"sin {g.name}", SINE, (half, distance, *g.lengths, side)), turning, line)

    def passage(self, pos: Positions, g: StructuralGroup, side: Any, root: Any) -> Crossing:
        p, q = (pos.points[name] for name in g.outer)
        half = Step(f"h {g.name}", HALF_BESIDE_ARCS, (root, p, g.lengths[0], q, g.lengths[1]))
        distance = Step(f"d {g.name}", rules.DISTANCE, (p, q))
        sine = Step(f"sin {g.name}", SINE, (half, distance, *g.lengths, side))
        return Crossing(half, distance, sine, Turning(side, None, None, (side,) if isinstance(side, Step) else ()))

    def dead_positions(self, m: Mechanism, g: StructuralGroup, plan: Plan, centre: Step) -> tuple[Step, Step] | None:
        """Arcs about the crank pivot of radius rod plus crank and rod minus crank cross the arc of the rocker."""
        c, q = m.crank, g.outer[1]
        # About the crank's own pivot rod and rocker turn with it.
        if g.outer[0] != c.pin or q not in m.fixed or m.fixed[q] == m.fixed[c.pivot]:
            return None
        pivot = plan.add(q, rules.GIVEN, m.fixed[q])
        rod, rocker = g.lengths
        far, near = (plan.add(f"{g.inner}{prime}", rules.ARC_ARC, centre, reach, pivot, rocker, g.side)
                     for prime, reach in reaches(plan, rod, c.length))
        return fold_and_stretch(m, plan, rod, centre, (far, near))

    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        return [Outline(link, (end, str(g.inner))) for link, end in zip(g.links, g.outer, strict=True)]

    def outer_reactions(self, g: StructuralGroup) -> list[OuterReaction]:
        return [OuterReaction(link, hinge) for link, hinge in zip(g.links, g.outer, strict=True)]


RRR = RRRKind()
