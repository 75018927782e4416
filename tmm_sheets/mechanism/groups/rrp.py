"""Kind 2, RRP: a rod hinged to a slider on a guide."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import against, on_link
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.groups.contexts import Crossing, OuterReaction, Outline, Turning
from tmm_sheets.mechanism.groups.dead_centres import (
    HALF_BESIDE_LINE,
    HALF_OF_LINE,
    LINE,
    fold_and_stretch,
    gaps_of_line,
    measured,
    near_point,
    on_crank,
    passing,
    reaches,
)
from tmm_sheets.mechanism.groups.limits import AssemblyLimit, extremes, lacking, mm, more, rounding, unrounded
from tmm_sheets.mechanism.model import GroupKind, Mechanism, Pair, StructuralGroup, sliding, turning
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.construction.limit_angles import Gaps
    from tmm_sheets.mechanism.model import Accelerations, Kinetostatics, Positions, Velocities

SINE = Rule("sine between rod and perpendicular to the guide", lambda h, r, side: -side * h / r, (), "number",
            marked("Sine of the angle between the coupler and the perpendicular to the guide {name} = {value}."), beyond_paper=True,
            unit="1")


class RRPKind(GroupKind):
    """Kind 2: a rod hinged to a slider on a guide."""

    number, form, orders = 2, marked("RRP"), ("RRP", "PRR")
    two_ways = True

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        p, c, (i, j) = g.outer[0], str(g.inner), g.links
        return [turning(p, m.owner(p), i), turning(c, i, j), sliding(c + "′", j, m.guides[g.guides[0]].link)]

    def carried(self, g: StructuralGroup) -> dict[str, str]:
        return {str(g.inner): g.links[1]}

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        assert g.inner is not None
        guide = g.guides[0]
        known = pos.crossing(g)
        pos.points[g.inner] = pos.plan.add(g.inner, rules.ARC_LINE, pos.points[g.outer[0]], g.lengths[0], pos.guide_points[guide],
                                           pos.guide_directions[guide], pos.side(g), *known)
        pos.directions[g.links[0]] = pos.direction(g.outer[0], g.inner)
        pos.directions[g.links[1]] = pos.guide_directions[guide]

    def velocity(self, vel: Velocities, g: StructuralGroup) -> None:
        pos, plan = vel.positions, vel.plan
        p, c, guide = g.outer[0], str(g.inner), g.guides[0]
        carrier, link = vel.guide(guide, c)
        n = vel.perpendicular(p, c)
        step = plan.add(vel.name(c), rules.LINE_LINE, vel.points[p], n, carrier, pos.guide_directions[guide], *vel.known(g))
        vel.points[c] = step
        plan.vector(f"V̅_{c}", vel.pole, step)
        plan.vector(f"V̅_{c}{p}", vel.points[p], step)
        if carrier is not vel.pole:
            plan.vector(f"V̅_{{{against(c, link)}}}", carrier, step)
        vel.turning(g.links[0], p, c, vel.points[p], step)
        vel.turns_with(g.links[1], link)
        vel.coincident[on_link(c, g.links[1])] = step

    def acceleration(self, acc: Accelerations, g: StructuralGroup) -> None:
        plan, pos, vel = acc.plan, acc.positions, acc.velocities
        p, c, guide = g.outer[0], str(g.inner), g.guides[0]
        carrier, v_carrier, link = acc.guide(guide, c)
        n = acc.normal(acc.points[p], g.links[0], p, c)
        k = acc.coriolis(carrier, link, v_carrier, vel.points[c], against(c, link))
        step = plan.add(acc.name(c), rules.LINE_LINE, n, acc.perpendicular(p, c), k, pos.guide_directions[guide], *acc.known(g))
        acc.points[c] = acc.coincident[on_link(c, g.links[1])] = step
        plan.vector(f"a̅_{{{c}{p}}}^τ", n, step)
        if carrier is not acc.pole:
            plan.vector(f"a̅_{{{against(c, link)}}}^r", k, step)
        plan.vector(f"a̅_{c}", acc.pole, step)
        acc.turning(g.links[0], p, c, acc.points[p], step)
        acc.turns_with(g.links[1], link)

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 2: tangential part from moments of the rod about the inner hinge; the guide's reaction across it."""
        pos, m = forces.positions, forces.positions.mechanism
        (i, j), p, c, guide = g.links, g.outer[0], str(g.inner), g.guides[0]
        a, base = m.owner(p), m.guides[guide].link
        total = forces.moment_sum(f"ΣM{i}", pos.points[c], [i])
        part = forces.tangential(i, a, total, c, p)
        across = forces.normal(j, base, guide, pos.guide_directions[guide])
        # The lines of the velocities turned by 90 degrees, one of them the other way round; with friction other lines.
        sine = () if forces.deviates(j, base) else tuple(forces.negative(s) for s in pos.known_sine(g))
        f_one, f_two, _ = forces.group_polygon(g, part, None, pos.direction(p, c), across, (a, base), sine)
        couple = forces.sliding(j, base, f_two, pos.points[c])
        forces.react(i, a, pos.points[p], f_one)
        forces.react(j, base, pos.points[c], f_two, couple)

    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        p, guide, length = g.outer[0], g.guides[0], g.lengths[0]
        rod = f"{p}{g.inner}"

        def away(pos: Positions) -> Any:
            return np.abs(ar.cross(pos.value(pos.guide_directions[guide]),
                                   pos.value(pos.guide_points[guide]) - pos.value(pos.points[p])))

        def margin(pos: Positions) -> Any:
            return unrounded(length - away(pos), rounding(length, pos.value(pos.points[p]), pos.value(pos.guide_points[guide])))

        return [AssemblyLimit(m.crank.length, margin,
                              lambda lack: tell(
                                  "rod {rod} = {length} is {lack} too short to reach the guide {guide}").format(
                                      rod=rod, length=mm(length), lack=lacking(lack), guide=guide),
                              lambda pos: tell("try {rod} >= {least}").format(rod=rod, least=more(extremes(away(pos))[1])))]

    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        rod = pos.points[str(g.inner)].value - pos.points[g.outer[0]].value
        return size / g.lengths[0] / np.abs(ar.dot(pos.guide_directions[g.guides[0]].value, rod) / np.abs(rod))

    @staticmethod
    def _numbers(m: Mechanism, g: StructuralGroup) -> tuple[Any, ...] | None:
        """What the crossing of a rod on the crank with a fixed guide follows from."""
        guide, pin = m.guides[g.guides[0]], on_crank(m, g.outer[0])
        if pin is None or isinstance(guide.through, str):
            return None
        return *pin, g.lengths[0], m.fixed[m.crank.pivot], guide.through, guide.direction

    def gaps(self, m: Mechanism, g: StructuralGroup) -> Gaps | None:
        """The rod's length plus and minus the distance of its outer hinge from the guide."""
        numbers = self._numbers(m, g)
        return None if numbers is None else gaps_of_line(*numbers)

    def gaps_at(self, pos: Positions, g: StructuralGroup) -> tuple[Any, Any, Any]:
        p, guide, length = pos.points[g.outer[0]].value, g.guides[0], g.lengths[0]
        through = pos.guide_points[guide].value
        e = ar.cross(pos.guide_directions[guide].value, p - through)
        return length + e, length - e, rounding(length, p, through)

    def crossing(self, m: Mechanism, g: StructuralGroup, phi: Any) -> Crossing | None:
        """Half-chord h = sqrt((l - e) (l + e)) with the pin's distance from the guide e = e0 + l1 sin(phi - psi)."""
        numbers, gaps = self._numbers(m, g), self.gaps(m, g)
        if numbers is None or gaps is None:
            return None
        half, _ = measured(g, phi, (HALF_OF_LINE, numbers))
        turning = passing(m, g, phi, LINE, numbers) if gaps.touching else None
        side = g.side if turning is None else turning.side
        return Crossing(half, None, Step(f"sin {g.name}", SINE, (half, g.lengths[0], side)), turning)

    def passage(self, pos: Positions, g: StructuralGroup, side: Any, root: Any) -> Crossing:
        guide, length = g.guides[0], g.lengths[0]
        half = Step(f"h {g.name}", HALF_BESIDE_LINE, (root, pos.points[g.outer[0]], length, pos.guide_points[guide],
                                                      pos.guide_directions[guide]))
        sine = Step(f"sin {g.name}", SINE, (half, length, side))
        return Crossing(half, None, sine, Turning(side, None, None, (side,) if isinstance(side, Step) else ()))

    def dead_positions(self, m: Mechanism, g: StructuralGroup, plan: Plan, centre: Step) -> tuple[Step, Step] | None:
        """Arcs about the crank pivot of radius rod plus crank and rod minus crank cross the guide."""
        guide, rod = m.guides[g.guides[0]], g.lengths[0]
        if guide.link != m.frame:
            return None
        through = plan.add(plan.free(f"{guide.name}₀"), *near_point(m, guide))
        along = plan.add(plan.free(guide.name), rules.UNDER, guide.direction)
        far, near = (plan.add(f"{g.inner}{prime}", rules.ARC_LINE, centre, reach, through, along, g.side)
                     for prime, reach in reaches(plan, rod, m.crank.length))
        return fold_and_stretch(m, plan, rod, centre, (far, near))

    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        (i, j), c = g.links, str(g.inner)
        return [Outline(i, (g.outer[0], c)), Outline(j, block=c, along=pos.guide_directions[g.guides[0]], slotted=True)]

    def outer_reactions(self, g: StructuralGroup) -> list[OuterReaction]:
        i, j = g.links
        return [OuterReaction(i, g.outer[0]), OuterReaction(j, str(g.inner), g.guides[0])]

    def sliders(self, g: StructuralGroup) -> tuple[tuple[str, str], ...]:
        return ((g.links[1], g.guides[0]),)


RRP = RRPKind()
