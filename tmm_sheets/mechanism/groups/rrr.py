"""Kind 1, RRR: two rods joined by a hinge, hinged to what is before them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmm_sheets.construction import rules
from tmm_sheets.mechanism.groups.kind import GroupKind
from tmm_sheets.mechanism.model import Mechanism, Pair, StructuralGroup, turning

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.accelerations import Accelerations
    from tmm_sheets.methods.linkage.forces import Kinetostatics
    from tmm_sheets.methods.linkage.positions import Positions
    from tmm_sheets.methods.linkage.velocities import Velocities


class RRRKind(GroupKind):
    """Kind 1: two rods joined by a hinge, hinged to what is before them."""

    number, form, orders = 1, "ВВВ", ("RRR",)

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        (p, q), c, (i, j) = g.outer, str(g.inner), g.links
        return [turning(p, m.owner(p), i), turning(c, i, j), turning(q, j, m.owner(q))]

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        p, q = g.outer
        assert g.inner is not None
        pos.points[g.inner] = pos.plan.add(g.inner, rules.ARC_ARC, pos.points[p], g.lengths[0], pos.points[q], g.lengths[1], g.side,
                                           *pos.crossing(g))
        pos.directions[g.links[0]] = pos.direction(p, g.inner)
        pos.directions[g.links[1]] = pos.direction(q, g.inner)

    def velocity(self, vel: Velocities, g: StructuralGroup) -> None:
        plan = vel.plan
        (p, q), c = g.outer, str(g.inner)
        n1 = vel.perpendicular(p, c)
        n2 = vel.perpendicular(q, c)
        step = plan.add(vel.name(c), rules.LINE_LINE, vel.points[p], n1, vel.points[q], n2, *vel.positions.known_sine(g))
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
        step = plan.add(acc.name(c), rules.LINE_LINE, n1, acc.perpendicular(p, c), n2, acc.perpendicular(q, c),
                        *acc.positions.known_sine(g))
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


RRR = RRRKind()
