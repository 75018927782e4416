"""Kind 4, PRP: two blocks on two guides, joined by a hinge."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import against, on_link
from tmm_sheets.mechanism.groups.hints import OuterReaction, Outline
from tmm_sheets.mechanism.groups.limits import TOUCH, AssemblyLimit, sine
from tmm_sheets.mechanism.model import GroupKind, Mechanism, Pair, StructuralGroup, sliding, turning
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.mechanism.model import Accelerations, Kinetostatics, Positions, Velocities


class PRPKind(GroupKind):
    """Kind 4: two blocks on two guides, joined by a hinge."""

    number, form, orders = 4, marked("PRP"), ("PRP",)

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        c, (i, j) = str(g.inner), g.links
        first, second = (m.guides[name].link for name in g.guides)
        return [sliding(c + "′", first, i), turning(c, i, j), sliding(c + "″", j, second)]

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        assert g.inner is not None
        a, b = g.guides
        pos.points[g.inner] = pos.plan.add(g.inner, rules.LINE_LINE, pos.guide_points[a], pos.guide_directions[a],
                                           pos.guide_points[b], pos.guide_directions[b])
        for link, guide in zip(g.links, g.guides, strict=True):
            pos.directions[link] = pos.guide_directions[guide]

    def velocity(self, vel: Velocities, g: StructuralGroup) -> None:
        pos, plan = vel.positions, vel.plan
        c = str(g.inner)
        (v1, k1), (v2, k2) = (vel.guide(name, c) for name in g.guides)
        u1, u2 = (pos.guide_directions[name] for name in g.guides)
        step = plan.add(vel.name(c), rules.LINE_LINE, v1, u1, v2, u2)
        vel.points[c] = step
        plan.vector(f"V̅_{c}", vel.pole, step)
        for v, k in ((v1, k1), (v2, k2)):
            if v is not vel.pole:
                plan.vector(f"V̅_{{{against(c, k)}}}", v, step)
        for link, k in zip(g.links, (k1, k2), strict=True):
            vel.turns_with(link, k)
            vel.coincident[on_link(c, link)] = step

    def acceleration(self, acc: Accelerations, g: StructuralGroup) -> None:
        plan, pos, vel = acc.plan, acc.positions, acc.velocities
        c = str(g.inner)
        (a1, v1, k1), (a2, v2, k2) = (acc.guide(name, c) for name in g.guides)
        u1, u2 = (pos.guide_directions[name] for name in g.guides)
        e1 = acc.coriolis(a1, k1, v1, vel.points[c], against(c, k1))
        e2 = acc.coriolis(a2, k2, v2, vel.points[c], against(c, k2))
        step = plan.add(acc.name(c), rules.LINE_LINE, e1, u1, e2, u2)
        acc.points[c] = step
        plan.vector(f"a̅_{c}", acc.pole, step)
        for a, e, k in ((a1, e1, k1), (a2, e2, k2)):
            if a is not acc.pole:
                plan.vector(f"a̅_{{{against(c, k)}}}^r", e, step)
        for link, k in zip(g.links, (k1, k2), strict=True):
            acc.turns_with(link, k)
            acc.coincident[on_link(c, link)] = step

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 4: both guides' reactions from the plan of the group, their arms from moments about the inner hinge."""
        pos, m = forces.positions, forces.positions.mechanism
        c = str(g.inner)
        bases = m.guides[g.guides[0]].link, m.guides[g.guides[1]].link
        u, v = (forces.normal(link, base, name, pos.guide_directions[name])
                for link, base, name in zip(g.links, bases, g.guides, strict=True))
        found = forces.group_polygon(g, None, None, u, v, bases)
        for link, base, force in zip(g.links, bases, found[:2], strict=True):
            couple = forces.sliding(link, base, force, pos.points[c])
            forces.react(link, base, pos.points[c], force, couple)

    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        a, b = g.guides
        return [AssemblyLimit(1.0, lambda pos: sine(pos.value(pos.guide_directions[a]), pos.value(pos.guide_directions[b])) - TOUCH,
                              lambda lack: tell("the guides {a} and {b} are parallel there").format(a=a, b=b),
                              lambda pos: tell("turn one of the guides so that they cross at every position"), measured=False)]

    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        a, b = (pos.guide_directions[name].value for name in g.guides)
        return 1 / sine(a, b)

    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        return [Outline(link, block=str(g.inner), along=pos.guide_directions[name]) for link, name in self.sliders(g)]

    def outer_reactions(self, g: StructuralGroup) -> list[OuterReaction]:
        return [OuterReaction(link, str(g.inner), name) for link, name in self.sliders(g)]

    def sliders(self, g: StructuralGroup) -> tuple[tuple[str, str], ...]:
        return tuple(zip(g.links, g.guides, strict=True))


PRP = PRPKind()
