"""The five kinds of class II: two links joined by a hinge (RRR, RRP, PRP), or by a block in a slot (RPR, RPP).

Of 1, 2 and 4 each link has its outer pair, a hinge or a guide (a :class:`~tmm_sheets.mechanism.groups.contexts.Leg`), and holds
the middle hinge on an arc or on a line. So do its motions: by each leg it is known but for a part along a line, and both lines
meet. Of 3 and 5 a block is hinged to a pin and slides along the other link: the point of that link that coincides with the pin
moves along the slot against the pin, and as that link's own outer pair lets it.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.step import Helper, Plan, Rule, Step
from tmm_sheets.mechanism.groups.contexts import (
    TOUCH,
    AssemblyLimit,
    Crossing,
    Held,
    Outline,
    Turning,
    extremes,
    lacking,
    less,
    mm,
    more,
    rounding,
    sine,
    span,
    unrounded,
)
from tmm_sheets.mechanism.groups.dead_centres import (
    ARCS,
    DISTANCE,
    HALF_BESIDE_ARCS,
    HALF_BESIDE_LINE,
    HALF_OF_ARCS,
    HALF_OF_LINE,
    LINE,
    LINE_OF_CENTRES,
    PIN_ANGLE,
    SIGNED_DISTANCE,
    TANGENT,
    fold_and_stretch,
    gaps_of_arcs,
    gaps_of_line,
    meets,
    near_point,
    on_crank,
    passing,
    reaches,
    span_from_crank,
)
from tmm_sheets.mechanism.model import GroupKind, Leg, Mechanism, StructuralGroup
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.limit_angles import Gaps
    from tmm_sheets.mechanism.model import Kinetostatics, MotionPolygon, Positions

SINE_OF_LINKS = Rule("sine between links", lambda h, d, r1, r2, side: side * h * d / (r1 * r2), (), "number",
                     marked("Sine of the angle between the links {name} = {value}."), beyond_paper=True, unit="1")
SINE_TO_GUIDE = Rule("sine between rod and perpendicular to the guide", lambda h, r, side: -side * h / r, (), "number",
                     marked("Sine of the angle between the coupler and the perpendicular to the guide {name} = {value}."),
                     beyond_paper=True, unit="1")


class HingedKind(GroupKind):
    """Two links joined by a hinge; ``crosses`` is the rule that makes the hinge from both legs."""

    crosses: ClassVar[Rule]

    def held(self, pos: Positions, g: StructuralGroup) -> list[Any]:
        """What holds the hinge, leg by leg: a point and a length, or a point and the direction of a guide."""
        return [x for leg in self.legs(g) for x in ((pos.guide_points[leg.guide], pos.guide_directions[leg.guide]) if leg.guide else
                                                    (pos.points[leg.outer], leg.length))]

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        c, known = str(g.inner), pos.crossing(g)
        side = (pos.side(g),) if self.two_ways else ()
        pos.points[c] = pos.plan.add(c, self.crosses, *self.held(pos, g), *side, *known)
        for leg in self.legs(g):
            pos.directions[leg.link] = pos.guide_directions[leg.guide] if leg.guide else pos.direction(leg.outer, c)

    def motion(self, plan: MotionPolygon, g: StructuralGroup) -> None:
        c, legs = str(g.inner), self.legs(g)
        plan.points[c] = plan.meet(c, legs, plan.known(g))
        for leg in legs:
            plan.turns_on(leg, plan.points[c])

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Tangential parts from moments of each rod about the middle hinge; reactions of guides across them."""
        pos, legs, c = forces.positions, self.legs(g), str(g.inner)
        ends = []
        for leg in legs:
            carrier = pos.mechanism.carrier(leg)
            if leg.guide:
                ends.append(Held(leg.link, carrier, forces.normal(leg.link, carrier, leg.guide, pos.guide_directions[leg.guide])))
            else:
                total = forces.moment_sum(f"ΣM{leg.link}", pos.points[c], [leg.link])
                part = forces.tangential(leg.link, carrier, total, c, leg.outer)
                ends.append(Held(leg.link, carrier, pos.direction(leg.outer, c), part))
        known, (one, two) = pos.known_sine(g), ends
        if g.guides:
            # The lines of the velocities turned by 90 degrees, one of them the other way round; with friction other lines.
            known = () if forces.deviates(two.link, two.other) else tuple(forces.negative(s) for s in known)
        found = forces.group_polygon(g, one, two, known)
        # The inner reaction closes the forces of the first link: the same drawing, one more line.
        forces.opposite(two.link, one.link, forces.read(found.plan, one.link, two.link, found.split, found.closing))
        couples = {leg.link: forces.sliding(leg.link, end.other, found.reactions[leg.link], pos.points[c])
                   for leg, end in zip(legs, ends, strict=True) if leg.guide}
        for leg, end in zip(legs, ends, strict=True):
            forces.react(leg.link, end.other, pos.points[leg.outer or c], found.reactions[leg.link], couples.get(leg.link))

    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        c = str(g.inner)
        return [Outline(leg.link, block=c, along=pos.guide_directions[leg.guide], slotted=self.two_ways) if leg.guide else
                Outline(leg.link, (leg.outer, c)) for leg in self.legs(g)]

    def sliders(self, g: StructuralGroup) -> tuple[tuple[str, str], ...]:
        return tuple((leg.link, leg.guide) for leg in self.legs(g) if leg.guide)


class TwoWayKind(HingedKind):
    """Kinds whose two ways of assembly may pass into each other in change points.

    Between crank and frame all that tells of their crossing are the ``numbers`` of the mechanism: the two ``between`` of these are
    its gaps, ``half`` is the rule of the half-chord on crank angles, ``branches`` those of the branch, its side and the turning. Of
    a group that hangs on others ``beside`` is the rule of the half-chord next to a change point. ``crossed`` is the rule of the
    sine between its lines, from the half-chord, the distance of the centres if there is one, the lengths and the side.
    """

    two_ways = True
    between: ClassVar[Callable[..., Gaps]]
    half: ClassVar[Rule]
    branches: ClassVar[tuple[Rule, ...]]
    beside: ClassVar[Rule]
    crossed: ClassVar[Rule]

    @abstractmethod
    def numbers(self, m: Mechanism, g: StructuralGroup) -> tuple[Any, ...] | None:
        """What the crossing of a group follows from, one outer hinge on the crank, the rest fixed; None elsewhere."""

    def apart(self, m: Mechanism, g: StructuralGroup, phi: Any, numbers: tuple[Any, ...], gaps: Gaps) -> tuple[
            Step | None, Step | None]:
        """Distance of the centres on crank angles, and their line where they come to lie in one place; nothing of arc and line."""
        return None, None

    def gaps(self, m: Mechanism, g: StructuralGroup) -> Gaps | None:
        numbers = self.numbers(m, g)
        return None if numbers is None else type(self).between(*numbers)

    def crossing(self, m: Mechanism, g: StructuralGroup, phi: Any) -> Crossing | None:
        numbers, gaps = self.numbers(m, g), self.gaps(m, g)
        if numbers is None or gaps is None:
            return None
        distance, line = self.apart(m, g, phi, numbers, gaps)
        turning = passing(m, g, phi, self.branches, numbers, turned=line is not None) if gaps.touching else None
        return self._crossing(g, Step(f"h {g.name}", self.half, (phi, *numbers)), distance,
                              g.side if turning is None else turning.side, turning, line)

    def passage(self, pos: Positions, g: StructuralGroup, side: Any, root: Any) -> Crossing:
        distance = None if g.guides else Step(f"d {g.name}", rules.DISTANCE, tuple(pos.points[name] for name in g.outer))
        half = Step(f"h {g.name}", self.beside, (root, *self.held(pos, g)))
        return self._crossing(g, half, distance, side, Turning(side, None, None, (side,) if isinstance(side, Step) else ()))

    def _crossing(self, g: StructuralGroup, half: Step, distance: Step | None, side: Any, turning: Turning | None,
                  line: Step | None = None) -> Crossing:
        apart = () if distance is None else (distance,)
        return Crossing(half, distance, Step(f"sin {g.name}", self.crossed, (half, *apart, *g.lengths, side)), turning, line)


class RRRKind(TwoWayKind):
    """Kind 1: two rods joined by a hinge, hinged to what is before them.

    Half-chord h = sqrt(((l2 + l3)^2 - d^2) (d^2 - (l2 - l3)^2)) / 2d, d the distance of the outer hinges; the factors are the gaps.
    """

    number, form, orders, crosses = 1, marked("RRR"), ("RRR",), rules.ARC_ARC
    between, half, branches, beside, crossed = gaps_of_arcs, HALF_OF_ARCS, ARCS, HALF_BESIDE_ARCS, SINE_OF_LINKS

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

    def numbers(self, m: Mechanism, g: StructuralGroup) -> tuple[Any, ...] | None:
        span = span_from_crank(m, g)
        return None if span is None else (*span, *g.lengths)

    def gaps_at(self, pos: Positions, g: StructuralGroup) -> tuple[Any, Any, Any]:
        (p, q), (l1, l2) = (pos.points[name].value for name in g.outer), g.lengths
        d = np.abs(q - p)
        return (l1 + l2 - d) * (l1 + l2 + d), (d - l1 + l2) * (d + l1 - l2), (l1 + l2) * rounding(l1 + l2, p, q)

    def apart(self, m: Mechanism, g: StructuralGroup, phi: Any, numbers: tuple[Any, ...], gaps: Gaps) -> tuple[
            Step | None, Step | None]:
        span = numbers[:-len(g.lengths)]
        if not meets(span, gaps, *g.lengths):
            return Step(f"d {g.name}", DISTANCE, (phi, *span)), None
        return (Step(f"d {g.name}", SIGNED_DISTANCE, (phi, *span, *g.lengths)),
                Step(f"u {g.name}", LINE_OF_CENTRES, (phi, *span, 1.0 if on_crank(m, g.outer[0]) else -1.0)))

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


RRR = RRRKind()


class RRPKind(TwoWayKind):
    """Kind 2: a rod hinged to a slider on a guide.

    Half-chord h = sqrt((l - e) (l + e)) with the distance of its outer hinge from the guide, e = e0 + l1 sin(phi - psi).
    """

    number, form, orders, crosses = 2, marked("RRP"), ("RRP", "PRR"), rules.ARC_LINE
    between, half, branches, beside, crossed = gaps_of_line, HALF_OF_LINE, LINE, HALF_BESIDE_LINE, SINE_TO_GUIDE

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

    def numbers(self, m: Mechanism, g: StructuralGroup) -> tuple[Any, ...] | None:
        guide, pin = m.guides[g.guides[0]], on_crank(m, g.outer[0])
        if pin is None or isinstance(guide.through, str):
            return None
        return *pin, g.lengths[0], m.fixed[m.crank.pivot], guide.through, guide.direction

    def gaps_at(self, pos: Positions, g: StructuralGroup) -> tuple[Any, Any, Any]:
        p, guide, length = pos.points[g.outer[0]].value, g.guides[0], g.lengths[0]
        through = pos.guide_points[guide].value
        e = ar.cross(pos.guide_directions[guide].value, p - through)
        return length + e, length - e, rounding(length, p, through)

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


RRP = RRPKind()


class PRPKind(HingedKind):
    """Kind 4: two blocks on two guides, joined by a hinge."""

    number, form, orders = 4, marked("PRP"), ("PRP",)
    crosses = rules.LINE_LINE

    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        a, b = g.guides
        return [AssemblyLimit(1.0, lambda pos: sine(pos.value(pos.guide_directions[a]), pos.value(pos.guide_directions[b])) - TOUCH,
                              lambda lack: tell("the guides {a} and {b} are parallel there").format(a=a, b=b),
                              lambda pos: tell("turn one of the guides so that they cross at every position"), measured=False)]

    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        a, b = (pos.guide_directions[name].value for name in g.guides)
        return 1 / sine(a, b)


PRP = PRPKind()


# --- kinds 3 and 5: a block in a slot --------------------------------------------------------------------------------------

ALONG_TANGENT = Rule(
    "along a tangent", lambda foot, *given: ar.tangent_direction(*given),
    ("point", "point"), "direction", marked("Draw the line {0}{1}."), lambda a, v: (Helper("line", a[0], a[1]),),
)
OFFSET_OF_SLOT = Rule("offset of a slot", np.abs, ("ordinate",), "length", "{name} = {value}.")
SINE_OF_SLOT = Rule("sine between slot and perpendicular to the line of pivots", lambda h, d: h / d, (), "number",
            marked("Sine of the angle between the slot and the perpendicular to the line of pivots {name} = {value}."), unit="1")


class RPRKind(GroupKind):
    """Kind 3: a block hinged to a pin, sliding along a rocker that is hinged to a pivot."""

    number, form, orders, slotted = 3, marked("RPR"), ("RPR",), "rocker"

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        p, q = g.outer
        if g.offset:
            # The guide line passes the pivot at the offset: its foot is where the tangent from the pin touches that circle.
            given = pos.points[p], pos.points[q], pos.plan.auxiliary(f"e {g.name}", OFFSET_OF_SLOT, g.offset), g.side
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
        contact = forces.contact(j, i, pos.points[p], f_ji, forces.opposite_couple(j, i, inner))
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
        return Crossing(half, distance, Step(f"sin {g.name}", SINE_OF_SLOT, (half, distance)))

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
        forces.loads[i].insert(0, forces.contact(i, j, pos.points[p], forces.opposite(i, j, f_ji)))
        inner = forces.sliding(i, j, f_ji, pos.points[p])
        owner = m.owner(p)
        block = forces.plan_of(i, (i,))
        first = block.begin(1)
        loads = forces.loads[i]
        rest = [load for load in loads if load.role != "reaction"] + [load for load in loads[1:] if load.role == "reaction"]
        f_io = forces.close(block, i, owner, block.lay_loads(first, [loads[0], *rest]), first)
        # The guided link also carries the opposite of the inner couple.
        forces.loads[j].append(forces.contact(j, i, pos.points[p], f_ji, forces.opposite_couple(j, i, inner)))
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
