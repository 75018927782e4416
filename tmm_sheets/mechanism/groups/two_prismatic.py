"""Kinds 4 and 5, PRP and RPP: groups with two sliding pairs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import against, on_link
from tmm_sheets.mechanism.groups.contexts import OuterReaction, Outline
from tmm_sheets.mechanism.groups.limits import TOUCH, AssemblyLimit, sine
from tmm_sheets.mechanism.model import GroupKind, Mechanism, Pair, StructuralGroup, sliding, turning
from tmm_sheets.words import marked, tell, tr

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


class RPPKind(GroupKind):
    """Kind 5: a block hinged to a pin in the slot of a link that slides along a guide."""

    number, form, orders = 5, marked("RPP"), ("RPP", "PPR")

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        p, (i, j) = g.outer[0], g.links
        return [turning(p, m.owner(p), i), sliding(p + "′", i, j), sliding(p + "″", j, m.guides[g.guides[0]].link)]

    def carried(self, g: StructuralGroup) -> dict[str, str]:
        return {str(g.inner): g.links[1]}

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        assert g.inner is not None
        guide = g.guides[0]
        u = pos.guide_directions[guide]
        slot = pos.plan.add(f"n{g.links[1]}–n{g.links[1]}", rules.TURNED_BY, u, g.slot,
                            say=tr("Slot of link {link}: take the direction {{name}} at the angle {{1}} to "
                                   "{{0}}.").format(link=g.links[1]))
        pos.points[g.inner] = pos.plan.add(g.inner, rules.LINE_LINE, pos.points[g.outer[0]], slot, pos.guide_points[guide], u,
                                           say=tr("Through {0} parallel to {1} draw a line; it meets {3} at point {name}."))
        pos.directions[g.links[0]] = slot
        pos.directions[g.links[1]] = u

    def velocity(self, vel: Velocities, g: StructuralGroup) -> None:
        pos, plan = vel.positions, vel.plan
        p, s, guide, (i, j) = g.outer[0], str(g.inner), g.guides[0], g.links
        pj = on_link(p, j)
        link = pos.mechanism.guides[guide].link
        along, slot = pos.guide_directions[guide], pos.directions[i]
        # Link j does not turn against the guide: its point at the pin and its point on the guide move alike on a fixed
        # guide; on a turning one the point at the pin is taken first.
        if link == pos.mechanism.frame:
            step = plan.add(vel.name(pj), rules.LINE_LINE, vel.points[p], slot, vel.pole, along)
            plan.vector(f"V̅_{{{pj}}}", vel.pole, step)
            plan.vector(f"V̅_{{{pj}{p}}}", vel.points[p], step)
            vel.points[s] = step
        else:
            at_pin = vel.on(link, str(pos.mechanism.guides[guide].through), p)
            step = plan.add(vel.name(pj), rules.LINE_LINE, vel.points[p], slot, at_pin, along)
            plan.vector(f"V̅_{{{pj}}}", vel.pole, step)
            plan.vector(f"V̅_{{{pj}{p}}}", vel.points[p], step)
            plan.vector(f"V̅_{{{pj}{on_link(p, link)}}}", at_pin, step)
            vel.points[s] = vel.rotated(s, step, link, p, s)
            plan.vector(f"V̅_{s}", vel.pole, vel.points[s])
            plan.vector(f"V̅_{{{s}{pj}}}", step, vel.points[s])
        vel.coincident[pj] = step
        vel.coincident[on_link(s, j)] = vel.points[s]
        for k in g.links:
            vel.turns_with(k, link)

    def acceleration(self, acc: Accelerations, g: StructuralGroup) -> None:
        plan, pos, vel = acc.plan, acc.positions, acc.velocities
        p, s, guide, (i, j) = g.outer[0], str(g.inner), g.guides[0], g.links
        pj = on_link(p, j)
        link = pos.mechanism.guides[guide].link
        v_pin = vel.coincident[pj]
        k1 = acc.coriolis(acc.points[p], link, vel.points[p], v_pin, f"{pj}{p}")
        if link == pos.mechanism.frame:
            k2 = acc.pole
        else:
            through = str(pos.mechanism.guides[guide].through)
            k2 = acc.coriolis(acc.on(link, through, p), link, vel.on(link, through, p), v_pin, f"{pj}{on_link(p, link)}")
        step = plan.add(acc.name(pj), rules.LINE_LINE, k1, pos.directions[i], k2, pos.guide_directions[guide])
        plan.vector(f"a̅_{{{pj}{p}}}^r", k1, step)
        if link != pos.mechanism.frame:
            plan.vector(f"a̅_{{{pj}{on_link(p, link)}}}^r", k2, step)
        plan.vector(f"a̅_{{{pj}}}", acc.pole, step)
        acc.coincident[pj] = step
        for k in g.links:
            acc.turns_with(k, link)
        if link == pos.mechanism.frame:
            acc.points[s] = step
        else:
            acc.points[s] = acc.rotated(s, step, link, p, s)
            plan.vector(f"a̅_{s}", acc.pole, acc.points[s])
            plan.vector(f"a̅_{{{s}{pj}}}", step, acc.points[s])
        acc.coincident[on_link(s, j)] = acc.points[s]

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 5: the plan of the guided link first, then of the block; arms from moments (manual 000, 4 ex. 1)."""
        pos, m = forces.positions, forces.positions.mechanism
        (i, j), p, guide = g.links, g.outer[0], g.guides[0]
        base = m.guides[guide].link
        across_slot = forces.normal(i, j, pos.directions[i].name, pos.directions[i])
        across_guide = forces.normal(j, base, guide, pos.guide_directions[guide])
        fp = forces.plan_of(j, (j,))
        start = fp.plan.add("2", rules.GIVEN, 0j)
        loads = forces.order(forces.loads[j], "inertia")
        end = start
        pending = []  # sides are recorded in the manual's order, the first unknown one before them
        for n, load in enumerate(loads, 3):
            head = fp.plan.add(str(n), rules.SHIFT, end, load.vector)
            pending.append((load.symbol, end, head))
            end = head
        one = fp.plan.add("1", rules.LINE_LINE, start, across_slot, end, across_guide)
        f_ji = forces.close(fp, j, i, one, start)
        for s, tail, head in pending:
            fp.side(s, tail, head)
        f_jb = forces.close(fp, j, base, end, one)
        # Block: F_ij, its loads, closing force from the link that carries the pin.
        f_ij = forces.opposite(i, j, f_ji)
        forces.loads[i].insert(0, forces.contact(i, j, pos.points[p], f_ij))
        inner = forces.sliding(i, j, f_ji, pos.points[p])
        owner = m.owner(p)
        block = forces.plan_of(i, (i,))
        first = block.plan.add("1", rules.GIVEN, 0j)
        loads = forces.loads[i]
        rest = [load for load in loads if load.role != "reaction"] + [load for load in loads[1:] if load.role == "reaction"]
        tail = block.chain(1, first, [loads[0], *rest])
        f_io = forces.close(block, i, owner, tail, first)
        # The guided link also carries the opposite of the inner couple.
        on_j = forces.opposite_couple(j, i, inner)
        forces.loads[j].append(forces.contact(j, i, pos.points[p], f_ji, on_j))
        outer = forces.sliding(j, base, f_jb, pos.points[p])
        forces.react(i, owner, pos.points[p], f_io)
        forces.react(j, base, pos.points[p], f_jb, outer)

    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        i, j = g.links
        return [AssemblyLimit(1.0, lambda pos: sine(pos.value(pos.directions[i]), pos.value(pos.directions[j])) - TOUCH,
                              lambda lack: tell("the slot of link {link} is parallel to its guide {guide}").format(
                                  link=j, guide=g.guides[0]),
                              lambda pos: tell('try slot = "90 deg"'), measured=False)]

    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        return 1 / sine(pos.guide_directions[g.guides[0]].value, pos.directions[g.links[0]].value)

    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        (i, j), slot = g.links, pos.directions[g.links[0]]
        return [Outline(i, block=g.outer[0], along=slot),
                Outline(j, block=str(g.inner), along=pos.guide_directions[g.guides[0]], slot=slot)]

    def outer_reactions(self, g: StructuralGroup) -> list[OuterReaction]:
        (i, j), p = g.links, g.outer[0]
        return [OuterReaction(i, p), OuterReaction(j, p, g.guides[0])]

    def force_plans(self, g: StructuralGroup) -> tuple[str, ...]:
        i, j = g.links
        return j, i

    def about(self, g: StructuralGroup) -> str:
        return g.outer[0]

    def ram(self, g: StructuralGroup) -> str | None:
        return g.links[1]


RPP = RPPKind()
