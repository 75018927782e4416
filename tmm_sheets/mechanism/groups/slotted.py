"""Kinds 3 and 5 of class II, with a block that is hinged to a pin and slides along the other link: RPR and RPP.

The point of the other link that coincides with the pin moves along the slot against the pin, and as that link's own
outer pair lets it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.step import Helper, Plan, Rule, Step
from tmm_sheets.mechanism.groups.contexts import (
    TOUCH,
    AssemblyLimit,
    Crossing,
    Held,
    Outline,
    extremes,
    lacking,
    less,
    mm,
    sine,
    span,
)
from tmm_sheets.mechanism.groups.dead_centres import DISTANCE, PIN_ANGLE, TANGENT, span_from_crank
from tmm_sheets.mechanism.model import GroupKind, Leg, Mechanism, StructuralGroup
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.mechanism.model import Kinetostatics, MotionPolygon, Positions

ALONG_TANGENT = Rule(
    "along a tangent", lambda foot, *given: ar.tangent_direction(*given),
    ("point", "point"), "direction", marked("Draw the line {0}{1}."), lambda a, v: (Helper("line", a[0], a[1]),),
)
OFFSET = Rule("offset of a slot", np.abs, ("ordinate",), "length", "{name} = {value}.")
SINE = Rule("sine between slot and perpendicular to the line of pivots", lambda h, d: h / d, (), "number",
            marked("Sine of the angle between the slot and the perpendicular to the line of pivots {name} = {value}."), unit="1")


class RPRKind(GroupKind):
    """Kind 3: a block hinged to a pin, sliding along a rocker that is hinged to a pivot."""

    number, form, orders, slotted = 3, marked("RPR"), ("RPR",), "rocker"

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

    def motion(self, plan: MotionPolygon, g: StructuralGroup) -> None:
        (p, q), (i, j) = g.outer, g.links
        pj = on_link(p, j)
        step = plan.coincident[pj] = plan.meet(pj, (Leg(i, p, p, slot=0.0), Leg(j, p, q)), plan.known(g), j)
        plan.turning(j, q, p, plan.points[q], step)
        plan.turns_with(i, j)
        if g.offset:
            foot = plan.positions.feet[j]
            plan.points[foot] = plan.rotated(foot, plan.points[q], j, q, foot)

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 3: tangential part from moments of the group about the pivot, then plans of block and rocker."""
        pos, m = forces.positions, forces.positions.mechanism
        (i, j), (p, q) = g.links, g.outer
        owner, base = m.owner(p), m.owner(q)
        total = forces.moment_sum(f"ΣM{i}–{j}", pos.points[q], [i, j])
        tangential, radial = forces.tangential(i, owner, total, q, p), pos.direction(q, p)
        across = (forces.normal(i, j, f"{q}{p}", pos.directions[j]) if radial is pos.directions[j]
                  else forces.normal(i, j, f"напр {j}", pos.directions[j], tr("⟂dir {link}").format(link=j)))
        pin, block = Held(i, owner, radial, tangential), forces.plan_of(i, (i,))
        start = block.begin()
        after = block.lay_part(start, pin)
        end = block.lay_loads(after, forces.order(forces.loads[i], "weight"))
        one = block.meet(pin, end, Held(i, j, across), *(() if forces.deviates(i, j) else pos.known_sine(g)))
        block.between(f"F{pair_index(i, owner)}n", one, start)
        f_ij = forces.read(block, i, j, end, one, drawn=False)
        f_io = forces.read(block, i, owner, one, after)
        inner = forces.sliding(i, j, f_ij, pos.points[p])
        f_ji = forces.opposite(j, i, f_ij)
        rocker = forces.plan_of(j, (j,))
        first = rocker.begin(1)
        on_j = forces.opposite_couple(j, i, inner)
        contact = forces.contact(j, i, pos.points[p], f_ji, on_j)
        tail = rocker.lay_loads(first, [contact, *forces.order(forces.loads[j], "weight")])
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
        half, distance = Step(f"h {g.name}", TANGENT, (phi, *span, g.offset)), Step(f"d {g.name}", DISTANCE, (phi, *span))
        return Crossing(half, distance, Step(f"sin {g.name}", SINE, (half, distance)))

    def dead_positions(self, m: Mechanism, g: StructuralGroup, plan: Plan, centre: Step) -> tuple[Step, Step] | None:
        """Tangents from the rocker's pivot to the crank circle (manual 000, 3.1), for a rocker that swings, without an offset."""
        c, q = m.crank, g.outer[1]
        if g.offset or q not in m.fixed or abs(m.fixed[q] - m.fixed[c.pivot]) <= c.length:
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

    def force_plans(self, g: StructuralGroup) -> tuple[str, ...]:
        return g.links

    def about(self, g: StructuralGroup) -> str:
        return g.outer[1]


RPR = RPRKind()


class RPPKind(GroupKind):
    """Kind 5: a block hinged to a pin in the slot of a link that slides along a guide."""

    number, form, orders, slotted = 5, marked("RPP"), ("RPP", "PPR"), "ram"

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

    def motion(self, plan: MotionPolygon, g: StructuralGroup) -> None:
        p, s, guide, (i, j) = g.outer[0], str(g.inner), g.guides[0], g.links
        m, pj = plan.positions.mechanism, on_link(p, j)
        link = m.guides[guide].link
        step = plan.coincident[pj] = plan.meet(pj, (Leg(i, p, p, slot=0.0), Leg(j, p, guide=guide)), plan.known(g), link)
        for k in g.links:
            plan.turns_with(k, link)
        # Link j does not turn against the guide: its point at the pin and its point on the guide move alike on a fixed
        # guide; on a turning one the point at the pin is taken first.
        if link == m.frame:
            plan.points[s] = step
        else:
            plan.points[s] = plan.rotated(s, step, link, p, s)
            plan.plan.vector(f"{plan.VECTOR}_{s}", plan.pole, plan.points[s])
            plan.plan.vector(f"{plan.VECTOR}_{{{s}{pj}}}", step, plan.points[s])
        plan.coincident[on_link(s, j)] = plan.points[s]

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 5: the plan of the guided link first, then of the block; arms from moments (manual 000, 4 ex. 1)."""
        pos, m = forces.positions, forces.positions.mechanism
        (i, j), p, guide = g.links, g.outer[0], g.guides[0]
        base = m.guides[guide].link
        slot = Held(j, i, forces.normal(i, j, pos.directions[i].name, pos.directions[i]))
        rail = Held(j, base, forces.normal(j, base, guide, pos.guide_directions[guide]))
        fp = forces.plan_of(j, (j,))
        start = fp.begin()
        end = fp.lay_loads(start, forces.order(forces.loads[j], "inertia"))
        one = fp.meet(slot, end, rail)
        f_ji = forces.read(fp, j, i, one, start, drawn=False)
        f_jb = forces.read(fp, j, base, end, one, drawn=False)
        # Block: F_ij, its loads, closing force from the link that carries the pin.
        f_ij = forces.opposite(i, j, f_ji)
        forces.loads[i].insert(0, forces.contact(i, j, pos.points[p], f_ij))
        inner = forces.sliding(i, j, f_ji, pos.points[p])
        owner = m.owner(p)
        block = forces.plan_of(i, (i,))
        first = block.begin(1)
        loads = forces.loads[i]
        rest = [load for load in loads if load.role != "reaction"] + [load for load in loads[1:] if load.role == "reaction"]
        tail = block.lay_loads(first, [loads[0], *rest])
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

    def force_plans(self, g: StructuralGroup) -> tuple[str, ...]:
        i, j = g.links
        return j, i

    def about(self, g: StructuralGroup) -> str:
        return g.outer[0]


RPP = RPPKind()
