"""Kind 3, RPR: a block hinged to a pin, sliding along a rocker that is hinged to a pivot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.plan import Plan, symbol
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.mechanism.groups.contexts import Crossing, OuterReaction, Outline
from tmm_sheets.mechanism.groups.dead_centres import DISTANCE, PIN_ANGLE, TANGENT, measured, span_from_crank
from tmm_sheets.mechanism.groups.limits import TOUCH, AssemblyLimit, extremes, lacking, less, mm, span
from tmm_sheets.mechanism.model import GroupKind, Mechanism, Pair, StructuralGroup, sliding, turning
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.mechanism.model import Accelerations, Kinetostatics, Positions, Velocities

ALONG_TANGENT = Rule(
    "along a tangent", lambda foot, *given: ar.tangent_direction(*given),
    ("point", "point"), "direction", marked("Draw the line {0}{1}."), lambda a, v: (Helper("line", a[0], a[1]),),
)
OFFSET = Rule("offset of a slot", np.abs, ("ordinate",), "length", "{name} = {value}.")
SINE = Rule("sine between slot and perpendicular to the line of pivots", lambda h, d: h / d, (), "number",
            marked("Sine of the angle between the slot and the perpendicular to the line of pivots {name} = {value}."), unit="1")


class RPRKind(GroupKind):
    """Kind 3: a block hinged to a pin, sliding along a rocker that is hinged to a pivot."""

    number, form, orders = 3, marked("RPR"), ("RPR",)

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        (p, q), (i, j) = g.outer, g.links
        return [turning(p, m.owner(p), i), sliding(p + "′", i, j), turning(q, j, m.owner(q))]

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        p, q = g.outer
        if g.offset:
            # The guide line passes the pivot at the offset: its foot is where the tangent from the pin touches that circle.
            given = pos.points[p], pos.points[q], pos.plan.auxiliary(f"e {g.name}", OFFSET, g.offset), g.side
            foot = pos.plan.add(pos.plan.free(f"{q}₁"), rules.TANGENT, *given)
            pos.points[foot.name] = foot
            pos.feet[g.links[1]] = foot.name
            u = pos.plan.add(pos.plan.free(foot.name + p), ALONG_TANGENT, foot, *given, *pos.crossing(g))
            pos.rays[foot.name, p] = u
        else:
            u = pos.direction(q, p)
        pos.directions[g.links[1]] = pos.directions[g.links[0]] = u

    def velocity(self, vel: Velocities, g: StructuralGroup) -> None:
        pos, plan = vel.positions, vel.plan
        (p, q), (i, j) = g.outer, g.links
        pj = on_link(p, j)
        n = vel.perpendicular(q, p)
        name = vel.name(pj)
        step = plan.add(name, rules.LINE_LINE, vel.points[p], pos.directions[j], vel.points[q], n, *pos.known_sine(g))
        plan.vector(f"V̅_{{{pj}}}", vel.pole, step)
        if vel.points[q] is not vel.pole:
            plan.vector(f"V̅_{{{pj}{q}}}", vel.points[q], step)
        plan.vector(f"V̅_{{{pj}{p}}}", vel.points[p], step)
        vel.coincident[pj] = step
        vel.turning(j, q, p, vel.points[q], step)
        vel.turns_with(i, j)
        if g.offset:
            foot = pos.feet[j]
            vel.points[foot] = vel.rotated(foot, vel.points[q], j, q, foot)

    def acceleration(self, acc: Accelerations, g: StructuralGroup) -> None:
        plan, pos, vel = acc.plan, acc.positions, acc.velocities
        (p, q), (i, j) = g.outer, g.links
        pj = on_link(p, j)
        k = acc.coriolis(acc.points[p], j, vel.points[p], vel.coincident[pj], f"{pj}{p}")
        n = acc.normal(acc.points[q], j, q, p, f"{pj}{q}")
        step = plan.add(acc.name(pj), rules.LINE_LINE, k, pos.directions[j], n, acc.perpendicular(q, p),
                        *pos.known_sine(g))
        plan.vector(f"a̅_{{{pj}{p}}}^r", k, step)
        plan.vector(f"a̅_{{{pj}{q}}}^τ", n, step)
        plan.vector(f"a̅_{{{pj}}}", acc.pole, step)
        acc.coincident[pj] = step
        acc.turning(j, q, p, acc.points[q], step)
        acc.turns_with(i, j)
        if g.offset:
            foot = pos.feet[j]
            acc.points[foot] = acc.rotated(foot, acc.points[q], j, q, foot)

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 3: tangential part from moments of the group about the pivot, then plans of block and rocker."""
        pos, m = forces.positions, forces.positions.mechanism
        (i, j), (p, q) = g.links, g.outer
        owner, base = m.owner(p), m.owner(q)
        io = pair_index(i, owner)
        total = forces.moment_sum(f"ΣM{i}–{j}", pos.points[q], [i, j])
        tangential = forces.tangential(i, owner, total, q, p)
        radial = pos.direction(q, p)
        across = (forces.normal(i, j, f"{q}{p}", pos.directions[j]) if radial is pos.directions[j]
                  else forces.normal(i, j, f"напр {j}", pos.directions[j], tr("⟂dir {link}").format(link=j)))
        block = forces.plan_of(i, (i,))
        start = block.plan.add("2", rules.GIVEN, 0j)
        after = block.plan.add("3", rules.SHIFT, start, tangential)
        pending, end = [], after
        for n, load in enumerate(forces.order(forces.loads[i], "weight"), 4):
            head = block.plan.add(str(n), rules.SHIFT, end, load.vector)
            pending.append((load.symbol, end, head))
            end = head
        one = block.plan.add("1", rules.LINE_LINE, start, radial, end, across,
                             *(() if forces.deviates(i, j) else pos.known_sine(g)))
        block.between(f"F{io}n", one, start)
        block.side(f"F̅_{{{io}}}^n", one, start, unknown=True)
        block.side(f"F̅_{{{io}}}^τ", start, after)
        for s, tail, head in pending:
            block.side(s, tail, head)
        f_ij = forces.close(block, i, j, end, one)
        f_io = forces.reaction(i, owner, block.between(f"F{io}", one, after))
        block.plan.vector(symbol(f"F{io}"), one, after)
        inner = forces.sliding(i, j, f_ij, pos.points[p])
        f_ji = forces.opposite(j, i, f_ij)
        rocker = forces.plan_of(j, (j,))
        first = rocker.plan.add("1", rules.GIVEN, 0j)
        on_j = forces.opposite_couple(j, i, inner)
        contact = forces.contact(j, i, pos.points[p], f_ji, on_j)
        tail = rocker.chain(1, first, [contact, *forces.order(forces.loads[j], "weight")])
        forces.loads[j].insert(0, contact)
        f_jb = forces.close(rocker, j, base, tail, first)
        forces.react(i, owner, pos.points[p], f_io)
        forces.react(j, base, pos.points[q], f_jb)

    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        p, q = g.outer
        offset = abs(g.offset)
        if not offset:
            return [
                AssemblyLimit(
                    m.crank.length,
                    lambda pos: span(pos, p, q) - TOUCH * m.crank.length,
                    lambda lack: tell("{p} passes through {q}, so that the guide {q}{p} has no direction").format(p=p, q=q),
                    lambda pos: tell("move {q} off the path of {p}").format(p=p, q=q),
                    measured=False,
                )
            ]
        return [AssemblyLimit(m.crank.length, lambda pos: span(pos, p, q) - offset - TOUCH * m.crank.length,
                              lambda lack: tell("{p} comes {lack} too near to {q} for the offset of {offset}").format(
                                  p=p, q=q, lack=lacking(lack), offset=mm(offset)),
                              lambda pos: tell("try an offset below {most}").format(most=less(extremes(span(pos, p, q))[0])))]

    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        r = pos.points[g.outer[0]].value - pos.points[g.outer[1]].value
        return size / np.abs(r) / np.abs(ar.dot(pos.directions[g.links[1]].value, r) / np.abs(r))

    def crossing(self, m: Mechanism, g: StructuralGroup, phi: Any) -> Crossing | None:
        """With an offset e the tangent's length sqrt(d^2 - e^2)."""
        span = span_from_crank(m, g) if g.offset else None
        if span is None:
            return None
        half, distance = measured(g, phi, (TANGENT, (*span, g.offset)), (DISTANCE, span))
        return Crossing(half, distance, Step(f"sin {g.name}", SINE, (half, distance)))

    def dead_positions(self, m: Mechanism, g: StructuralGroup, plan: Plan, centre: Step) -> tuple[Step, Step] | None:
        """Tangents from the rocker's pivot to the crank circle (manual 000, 3.1), for a rocker that swings, without an offset."""
        c, q = m.crank, g.outer[1]
        if g.offset or q not in m.fixed or _inside(m, q) >= 0:
            return None
        pivot = plan.add(q, rules.GIVEN, m.fixed[q])
        a, b = (plan.add(f"{c.pin}{prime}", rules.TANGENT, pivot, centre, c.length, side) for prime, side in (("′", 1), ("″", -1)))
        return plan.auxiliary("φ′", PIN_ANGLE, centre, a), plan.auxiliary("φ″", PIN_ANGLE, centre, b)

    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        (i, j), (p, q) = g.links, g.outer
        foot = pos.feet.get(j)
        # With an offset the slot passes the pivot: an arm to its foot, and the slot from there to the slider block.
        rocker = Outline(j, (q, p), p) if foot is None else Outline(j, (q,), p, ((q, foot), (foot, p)))
        return [Outline(i, block=p, along=pos.directions[j]), rocker]

    def outer_reactions(self, g: StructuralGroup) -> list[OuterReaction]:
        (i, j), (p, q) = g.links, g.outer
        return [OuterReaction(i, p), OuterReaction(j, q)]

    def force_plans(self, g: StructuralGroup) -> tuple[str, ...]:
        return g.links

    def about(self, g: StructuralGroup) -> str:
        return g.outer[1]

    def rocker(self, g: StructuralGroup) -> str | None:
        return g.links[1]


def _inside(m: Mechanism, pivot: str) -> float:
    """How far a fixed pivot lies inside the crank circle, m; negative outside."""
    return m.crank.length - abs(m.fixed[pivot] - m.fixed[m.crank.pivot])


RPR = RPRKind()
