"""Kind 6, a group of class III, order 3: a triangle on three legs.

Each leg is hinged to a corner of the triangle and turns about an outer hinge or slides along an outer guide; the second may be a
slider block that is hinged outside and slides in a slot of the triangle. Positions by the method of false positions (метод ложных
положений): without its third leg the group moves by itself, the third corner draws its locus, which the circle or the guide of the
third leg cuts. Velocities and accelerations by Assur's special point (особая точка Ассура), where the normals of two legs meet:
seen as a point of the triangle its velocity follows from both legs at once. Forces by the moments of the whole group about it.

Source: I. I. Artobolevsky, Теория механизмов и машин, 1988, § 22, 24 and 61; L. V. Assur.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.indices import on_link, pair_index
from tmm_sheets.construction.step import Given, Helper, Plan, Rule, Step, value_of
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import three_legs
from tmm_sheets.mechanism.groups.contexts import AssemblyLimit, ForcePlan, Held, Outline, SpecialPoint, lacking
from tmm_sheets.mechanism.model import GroupKind, Leg, Mechanism, Pair, StructuralGroup, sliding, turning
from tmm_sheets.numbers import in_a_row, of_reader
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.mechanism.groups.three_legs import Course
    from tmm_sheets.mechanism.model import Kinetostatics, MotionPolygon, Positions

FALSE = (-3, -2, -1, 1, 2, 3)
"""False positions, counted from the true one."""
APART = 0.15
"""Way of the third corner between false positions, in the least of its leg's and the triangle's lengths."""


@dataclass(frozen=True)
class TriadGroup(StructuralGroup):
    """A group of class III, order 3; ``links`` are the triangle and its three legs.

    ``sides`` are the distances of the second and third corner from the first, m, ``angle`` that between them, rad. ``near`` is
    about the direction from the first corner to the second, rad, in the way of assembly that is meant, at the crank angle ``when``.
    """

    legs: tuple[Leg, ...] = ()
    sides: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0
    near: float = 0.0
    when: float = 0.0

    @property
    def form(self) -> str:
        """Pairs of its legs."""
        return "–".join(leg.form for leg in self.legs)

    def false_points(self, plan: Plan) -> list[tuple[Step, ...]]:
        """Steps of its false positions: the corners, and the slot's direction instead of the second of a slider block's."""
        return [tuple(plan[f"{leg.corner}{sign(n)}"] for leg in self.legs) for n in FALSE]


CORNER = Rule("corner of a triangle",
              lambda length, angle: length * (np.cos(angle) + 1j * np.sin(angle)),
              ("length", "angle"), "vector", "{name} = {value}.", unit="m", exact=True)
NEAR_PLACE = Rule("place near by", three_legs.on_course, ("angle",), "point", "{name} = {value}.", unit="m", exact=True)
NEAR_DIRECTION = Rule("direction near by", three_legs.on_course, ("angle",), "direction", "{name} = {value}.", unit="1", exact=True)


def _cut(a: tuple[Any, ...], v: Any) -> tuple[Helper, ...]:
    """Arc of the third leg across the locus."""
    does, centre, _, radius, _ = a[12:17]
    return (Helper("arc", centre, v, radius),) if does == three_legs.CIRCLE else ()


LOCUS = Rule(
    "locus cut", three_legs.corner_on_legs, ("point", "direction"), "point",
    marked("Where the locus cuts the circle or the guide of the third leg lies point {name}."), _cut,
    sine=lambda z, k, u, *legs: three_legs.locus_sine(k, u, *legs),
)
ON_LOCUS = Rule("direction on the locus", three_legs.direction_on_legs, ("point", "direction"), "direction",
                marked("Put the triangle there: direction {name}."))


FROM_THIRD = Rule("corner from another",
                  lambda third, u, own, corner: third + (corner - own) * u, ("point", "direction", "number", "number"), "point",
                  marked("From {0} with the side of the triangle mark point {name} on its circle or guide."),
                  lambda a, v: (Helper("line", a[0], v),))
FALSE_CORNER = Rule("false position of the first leg", three_legs.false_place, ("point", "direction"), "point",
                    marked("Let the first leg take a false position: point {name}."))
FALSE_SIDE = Rule("side of a false position", three_legs.false_side, ("point", "direction"), "number", "{name} = {value}.",
                  unit="1", exact=True)


TRANSFER = Rule("triangle on its side",
                lambda first, second, two, three: first + three / two * (second - first),
                ("point", "point", "length", "number"), "point",
                marked("On {0}{1} put up the triangle: point {name} of the locus."),
                lambda a, v: (Helper("line", a[0], a[1]), Helper("line", a[0], v), Helper("line", a[1], v)))


IN_SLOT = Rule("triangle by its slot",
               lambda first, u, three, slot: first + three * u * np.exp(-1j * slot),
               ("point", "direction", "number", "angle"), "point",
               marked("From {0} along its slot put up the triangle: point {name} of the locus."),
               lambda a, v: (Helper("line", a[0], v),))


def _slot_direction(first: Any, pivot: Any, two: Any, slot: Any, side: Any) -> Any:
    e = pivot - first
    d = np.abs(e)
    across = (two * np.exp(-1j * slot)).imag
    # The slot passes the first corner at a distance: the pivot lies so far beside its direction.
    return e / (side * np.sqrt((d - across) * (d + across)) + 1j * across)


SLOT_DIRECTION = Rule("slot through a pivot", _slot_direction, ("point", "point", "length", "angle", "number"), "direction",
                      marked("Draw the slot through {1}: direction {name}."), lambda a, v: (Helper("line", a[0], a[1]),))


BY_MOMENTS = Rule("component along a normal from moments",
                  lambda total, about, at, u: -total / ar.moment(about, at, u) * u,
                  ("number", "point", "point", "direction"), "force",
                  marked("From the sum of moments about the special point {1} find the component {name} = {value}."),
                  lambda a, v: rules.arm(a[1], a[2], a[3]), unit="N")


ALONG_SLOT = Rule("component along a slot", lambda u, *forces: -(sum(forces, 0j) * np.conj(u)).real * u, ("direction",), "force",
                  marked("From the sum of projections on the slot find the component {name} = {value}."), unit="N")


def _moving(leg: Leg, triangle: str) -> str:
    """Point of the triangle whose motion a leg leaves free along one line: its corner, or the point in the slot."""
    return leg.corner if leg.slot is None else on_link(leg.outer, triangle)


def _as_triad(g: StructuralGroup) -> TriadGroup:
    assert isinstance(g, TriadGroup)
    return g


class TriadKind(GroupKind):
    """Kind 6: a triangle on three legs."""

    number, form, orders = 6, marked("class III"), ()
    grade, order = 3, 3

    def legs(self, g: StructuralGroup) -> tuple[Leg, ...]:
        return _as_triad(g).legs

    def pairs(self, m: Mechanism, g: StructuralGroup) -> list[Pair]:
        found = []
        for leg in _as_triad(g).legs:
            if leg.guide:
                found.append(sliding(leg.corner + "′", m.guides[leg.guide].link, leg.link))
            else:
                found.append(turning(leg.outer, m.owner(leg.outer), leg.link))
            found.append(turning(leg.corner, leg.link, g.links[0]) if leg.slot is None
                         else sliding(leg.outer + "′", leg.link, g.links[0]))
        return found

    def carried(self, g: StructuralGroup) -> dict[str, str]:
        return {leg.corner: g.links[0] for leg in _as_triad(g).legs}

    def guided(self, g: StructuralGroup) -> tuple[tuple[str, str], ...]:
        return tuple((leg.corner, leg.guide) for leg in _as_triad(g).legs if leg.guide)

    # --- positions ------------------------------------------------------------------------------------------------

    def position(self, pos: Positions, g: StructuralGroup) -> None:
        """Construct the corners, the special point and the false positions.

        Raises
        ------
        CannotBuild
            when no way of assembly is near the direction told, or two of them, or a turn of the crank leads to another one.
        """
        triad, plan = _as_triad(g), pos.plan
        a, b, c = triad.legs
        way = pos.course(g)
        _check(triad, way)
        angles, k, u = (Given(value, f"{what} of group {g.name}", over="curve",
                              choice=f"way of assembly whose triangle is nearest to {np.degrees(triad.near):g} deg at crank angle "
                                     f"{np.degrees(triad.when):g} deg, followed round the turn")
                        for what, value in (("crank angles", way.angles), ("place", way.k), ("direction", way.u)))
        near = (plan.auxiliary(f"k {g.name}", NEAR_PLACE, pos.angle, angles, k),
                plan.auxiliary(f"u {g.name}", NEAR_DIRECTION, pos.angle, angles, u))
        held = self._held(pos, triad)
        if plan.search is None:
            self._false_positions(pos, triad, near, held)
        third = plan.add(c.corner, LOCUS, *near, *held, say=(
            tr("The locus of {locus} cuts the guide of slider {leg}: point {{name}}.") if c.guide else
            tr("The locus of {locus} cuts the circle of leg {leg}: point {{name}}.")).format(locus=c.corner, leg=c.link))
        along = plan.add(plan.free(a.corner + b.corner), ON_LOCUS, *near, *held)
        pos.points[c.corner], pos.rays[a.corner, b.corner], pos.directions[g.links[0]] = third, along, along
        own = held[14]
        for leg, corner in ((a, held[4]), (b, held[9])):
            pos.points[leg.corner] = plan.add(leg.corner, FROM_THIRD, third, along, own, corner)
        for leg in triad.legs:
            pos.directions[leg.link] = (
                pos.guide_directions[leg.guide] if leg.guide else pos.direction(leg.outer, leg.corner) if leg.slot is None
                else along if not leg.slot else plan.add(plan.free(f"dir {leg.link}"), rules.TURNED_BY, along, leg.slot))
        self._special_point(pos, triad)

    @staticmethod
    def _held(pos: Positions, g: TriadGroup) -> tuple[Any, ...]:
        """What holds the triangle, leg by leg, see :data:`three_legs.Legs`."""
        third = pos.plan.auxiliary(f"c {g.name}", CORNER, g.sides[1], g.angle)
        found: list[Any] = []
        for leg, corner in zip(g.legs, (0.0, g.sides[0], third), strict=True):
            if leg.guide:
                found += [three_legs.LINE, pos.guide_points[leg.guide], pos.guide_directions[leg.guide], 0.0, corner]
            elif leg.slot is None:
                found += [three_legs.CIRCLE, pos.points[leg.outer], 1.0, leg.length, corner]
            else:
                found += [three_legs.SLOT, pos.points[leg.outer], 1.0, leg.slot, corner]
        return tuple(found)

    def before(self, pos: Positions, g: StructuralGroup) -> tuple[Any, ...]:
        """What holds the triangle, in numbers, on a plan that ends before the group."""
        return tuple(value_of(x) for x in self._held(pos, _as_triad(g)))

    @staticmethod
    def _false_positions(pos: Positions, g: TriadGroup, near: tuple[Step, Step], held: tuple[Any, ...]) -> None:
        """Without the third leg: some places of the first, of the second by compasses, of the third corner by the triangle."""
        a, b, c = g.legs
        title = tr("False positions of group {name}").format(name=g.lettered)
        plan = pos.false[g.name] = Plan(f"false-positions-{g.name}{pos.where}", title, "m", pos.plan.labels)
        size = APART * min(x for x in (c.length, g.sides[0], g.sides[1]) if x > 0)
        two, three = held[9], held[14]
        for n in FALSE:
            at = sign(n)
            first = plan.add(f"{a.corner}{at}", FALSE_CORNER, *near, n * size, *held, say=tr(
                "Leg {leg} takes a false position: point {{name}}.").format(leg=a.link))
            side = plan.auxiliary(f"side {first.name}", FALSE_SIDE, *near, n * size, *held)
            name = f"{b.corner}{at}"
            if a.form == "RR":
                plan.add(f"{a.outer}{first.name}", rules.RAY, held[1], first)
            if b.slot is None:
                second = (plan.add(name, rules.ARC_LINE, first, two, held[6], held[7], side) if b.guide else
                          plan.add(name, rules.ARC_ARC, first, two, held[6], held[8], side))
                if b.form == "RR":
                    plan.add(f"{b.outer}{name}", rules.RAY, held[6], second)
                plan.add(f"{c.corner}{at}", TRANSFER, first, second, two, three)
            else:
                u = plan.add(name, SLOT_DIRECTION, first, held[6], two, b.slot, side)
                plan.add(f"{c.corner}{at}", IN_SLOT, first, u, three, b.slot)

    def _special_point(self, pos: Positions, g: TriadGroup) -> None:
        """Where the normals of two legs meet, of those two that meet best at the angles of the plan."""
        plan, way = pos.plan, pos.course(g)
        with np.errstate(invalid="ignore"):
            n = [three_legs.on_course(value_of(pos.angle), way.angles, row) for row in way.normals]
            sines = [np.abs(ar.cross(n[i], n[j])) for i, j in PAIRS]
            least = [float(np.nanmin(s)) if not np.all(np.isnan(s)) else 0.0 for s in sines]
        i, j = PAIRS[int(np.argmax(least))]
        first, second = g.legs[i], g.legs[j]
        third = next(leg for leg in g.legs if leg not in (first, second))
        name = special_name(g.links[0])
        step = plan.add(name, rules.LINE_LINE, pos.points[first.at], self._normal(pos, first), pos.points[second.at],
                        self._normal(pos, second), say=tr(
                            "The normals of legs {first} and {second} meet at Assur's special point {{name}} of link {link}."
                        ).format(first=first.link, second=second.link, link=g.links[0]))
        pos.special[name] = SpecialPoint(name, step, (first, second), third)

    @staticmethod
    def _normal(pos: Positions, leg: Leg) -> Step:
        """Direction along which a leg holds the triangle: its own, or across its guide or slot; drawn once."""
        u = pos.directions[leg.link]
        return u if leg.form == "RR" else pos.plan.add_once(f"⟂{leg.guide or 'dir ' + leg.link}", rules.TURN, u)

    # --- velocities and accelerations -------------------------------------------------------------------------------

    def motion(self, plan: MotionPolygon, g: StructuralGroup) -> None:
        pos, tri = plan.positions, g.links[0]
        s = pos.special[special_name(tri)]
        (a, b), c = s.pair, s.third
        lines = []
        for leg in (a, b):
            end, u = plan.end(leg, _moving(leg, tri), tri), plan.rest(leg)
            lines += [plan.normal(end, tri, leg.at, s.name), u]
        w = plan.special[s.name] = plan.plan.add(plan.name(s.name), rules.LINE_LINE, *lines)
        plan.plan.vector(f"{plan.VECTOR}_{s.name}", plan.pole, w)
        moving = _moving(c, tri)
        letters = moving if c.slot is None else f"{{{moving}}}"
        n = plan.normal(w, tri, s.name, c.at, f"{letters}{s.name}")
        end, u = plan.end(c, moving, tri), plan.rest(c)
        step = plan.plan.add(plan.name(moving), rules.LINE_LINE, n, plan.perpendicular(s.name, c.at), end, u)
        plan.plan.vector(f"{plan.VECTOR}_{letters}", plan.pole, step)
        plan.plan.vector(f"{plan.VECTOR}_{{{letters}{s.name}}}{plan.MARKS['RR']}", n, step)
        if end is not plan.pole:
            plan.plan.vector(f"{plan.VECTOR}_{{{moving}{plan.against(c)}}}{plan.MARKS[c.form]}", end, step)
        # The other points of the triangle by similarity, from the special point and the third leg's.
        (plan.points if c.slot is None else plan.coincident)[moving] = step
        for leg in g.kind.legs(g):
            if leg.corner not in plan.points:
                found = plan.points[leg.corner] = plan.similar(leg.corner, w, step, s.name, c.at)
                plan.plan.vector(f"{plan.VECTOR}_{leg.corner}", plan.pole, found)
            if leg.slot is not None and (here := on_link(leg.outer, tri)) not in plan.coincident:
                plan.coincident[here] = plan.similar(leg.outer, w, step, s.name, c.at, here)
        plan.turning(tri, a.corner, b.corner, plan.points[a.corner], plan.points[b.corner])
        for leg in g.kind.legs(g):
            if leg.slot is None:
                plan.turns_on(leg, plan.points[leg.corner])
            else:
                plan.turns_with(leg.link, tri)

    # --- forces -------------------------------------------------------------------------------------------------------

    def force(self, forces: Kinetostatics, g: StructuralGroup) -> None:
        """Kind 6: tangential parts from moments of each leg, a normal one from those of the group about the special point."""
        pos, m, triad, tri = forces.positions, forces.positions.mechanism, _as_triad(g), g.links[0]
        s = pos.special[special_name(tri)]
        (a, b), c = s.pair, s.third
        ends: dict[Leg, Held] = {}
        couple: dict[Leg, Step] = {}
        more: list[tuple[Step, Any, Any]] = []
        for leg in triad.legs:
            part, owner = None, m.carrier(leg)
            if leg.guide:
                couple[leg] = forces.guide_couple(leg.link, owner, pos.points[leg.corner])
                more.append((pos.points[leg.corner], 0j, couple[leg]))
            elif leg.slot is None:
                total = forces.moment_sum(f"ΣM{leg.link}", pos.points[leg.corner], [leg.link])
                part = forces.tangential(leg.link, owner, total, leg.corner, leg.outer)
            else:
                own = [load.vector for load in forces.loads[leg.link]]
                name = f"F{pair_index(leg.link, owner)}"
                part = forces.parts[name] = forces.plan.add(f"{name}τ", ALONG_SLOT, pos.directions[leg.link], *own)
            if part is not None:
                more.append((pos.points[leg.outer], part, 0.0))
            ends[leg] = Held(leg.link, owner, self._normal(pos, leg), part)
        total = forces.moment_sum(f"ΣM{s.name}", s.step, g.links, more)
        third = ends[c]
        normal = forces.plan.add(f"F{pair_index(c.link, third.other)}n", BY_MOMENTS, total, s.step, pos.points[c.at], third.line)

        def between(fp: ForcePlan, tail: Step) -> tuple[Step, tuple[Held, Step, Step]]:
            """The loads of the triangle, the reaction of the third leg and its loads."""
            triangle = fp.lay_loads(tail, forces.order(forces.loads[tri], "weight"))
            after = fp.lay(fp.lay_part(triangle, third), third.rest, normal)
            return fp.lay_loads(after, forces.order(forces.loads[c.link], "weight")), (third, triangle, after)

        whole = forces.group_polygon(g, ends[a], ends[b], between=between)
        apart = whole.reactions[c.link].args[0]
        # What closes the polygon of each leg alone: the same drawing, one line more.
        for leg, tail, head in ((a, whole.split, whole.closing), (c, whole.middle, apart), (b, whole.closing, whole.middle)):
            forces.opposite(tri, leg.link, forces.read(whole.plan, leg.link, tri, tail, head))
        for leg in triad.legs:
            owner, force = ends[leg].other, whole.reactions[leg.link]
            if leg.guide:
                forces.arm(leg.link, owner, couple[leg], force)
                forces.react(leg.link, owner, pos.points[leg.corner], force, couple[leg])
                continue
            if leg.slot is not None:
                forces.sliding(leg.link, tri, forces.reactions[f"F{pair_index(leg.link, tri)}"], pos.points[leg.outer])
            forces.react(leg.link, owner, pos.points[leg.outer], force)

    # --- limits -------------------------------------------------------------------------------------------------------

    def limits(self, m: Mechanism, g: StructuralGroup) -> list[AssemblyLimit]:
        triad = _as_triad(g)
        leg = triad.legs[2]

        def say(lack: float) -> str:
            said = (tell("the locus of {corner} does not come to the guide {guide} of slider {leg}: {lack} are missing")
                    if leg.guide else tell("the locus of {corner} does not come to the circle of leg {leg}: {lack} are missing"))
            return said.format(corner=leg.corner, guide=leg.guide, leg=leg.link, lack=lacking(lack))

        return [AssemblyLimit(m.crank.length, partial(self._margin, triad), say, partial(_hint, triad))]

    def _margin(self, g: TriadGroup, pos: Positions) -> Any:
        """Positive where the triangle stands on its legs; elsewhere what the third leg lacks, m."""
        held, way = self.before(pos, g), pos.course(g)
        z = pos.points[g.legs[2].corner].value
        found = np.where(np.isnan(z), np.nan, pos.mechanism.crank.length) + 0.0 * np.abs(sum(np.abs(x) for x in held[1::5]))
        reached = np.flatnonzero(~np.isnan(way.k))
        phi = np.broadcast_to(value_of(pos.angle), (np.size(found),))
        for i in np.flatnonzero(np.isnan(z)):
            legs = tuple(x[i] if np.ndim(x) else x for x in held)
            if np.isnan(np.array(legs, dtype=complex)).any():
                continue
            lack = np.nan
            if len(reached):
                near = reached[np.argmin(np.abs(np.angle(np.exp(1j * (way.angles[reached] - phi[i])))))]
                lack = three_legs.gap(complex(way.k[near]), complex(way.u[near]), legs)[0]
            if np.isnan(lack):
                lack = three_legs.nearest(legs)[0]
            found[i] = -max(abs(lack), 1e-12) if np.isfinite(lack) else -three_legs.extent(legs)
        return found

    def condition(self, pos: Positions, g: StructuralGroup, size: Any) -> Any:
        triad = _as_triad(g)
        held = tuple(value_of(x) for x in self._held(pos, triad))
        k, u = pos.points[triad.legs[0].corner].value, pos.directions[g.links[0]].value
        _, normals, points = three_legs.conditions(k, u, held)
        own = max(triad.sides)
        shortest = min(x for x in (*triad.sides, *(leg.length for leg in triad.legs)) if x > 0)
        return size / shortest * own / np.abs(three_legs.determinant(k, normals, points))

    # --- looks --------------------------------------------------------------------------------------------------------

    def outlines(self, pos: Positions, g: StructuralGroup) -> list[Outline]:
        triad = _as_triad(g)
        arms = tuple((leg.corner, leg.outer) for leg in triad.legs if leg.slot is not None)
        found = [Outline(g.links[0], tuple(leg.corner for leg in triad.legs), arms=arms)]
        for leg in triad.legs:
            if leg.form == "RR":
                found.append(Outline(leg.link, (leg.outer, leg.corner)))
            else:
                found.append(Outline(leg.link, block=leg.at, along=pos.directions[leg.link], slotted=bool(leg.guide)))
        return found

    def about(self, g: StructuralGroup) -> str:
        return special_name(g.links[0])

    def sliders(self, g: StructuralGroup) -> tuple[tuple[str, str], ...]:
        return tuple((leg.link, leg.guide) for leg in _as_triad(g).legs if leg.guide)


    def told(self, g: StructuralGroup) -> str:
        return "–".join(tr(FORMS[leg.form]) for leg in _as_triad(g).legs)

    def joints(self, g: StructuralGroup) -> tuple[str, ...]:
        return (*(leg.corner for leg in _as_triad(g).legs), *g.outer)

    def block(self, g: StructuralGroup, link: str) -> str:
        return next(leg.at for leg in _as_triad(g).legs if leg.link == link)


def sign(n: int) -> str:
    """Number of a false position behind a name."""
    return f"({n:+d})"


FORMS = {"RR": marked("RR"), "PR": marked("PR"), "RP": marked("RP")}
"""Pairs of a leg, outer and inner."""
PAIRS = ((0, 1), (0, 2), (1, 2))


def special_name(triangle: str) -> str:
    """Name of the special point of a triangle."""
    return f"W{triangle}"


SURELY = np.radians(45.0)
"""Beyond it the told direction belongs to no way of assembly."""


ALIKE = np.radians(0.01)
"""Within it two ways of assembly cannot be told apart by the direction."""


def _assemblies(g: TriadGroup, way: Course) -> dict[str, Any]:
    """Ways of assembly for a message."""
    return {"group": "-".join(g.links), "side": g.legs[0].corner + g.legs[1].corner, "angle": np.degrees(g.when),
            "told": np.degrees(g.near), "ways": in_a_row(of_reader(f"{np.degrees(np.angle(u)) % 360:.1f}") for _, u in way.found)}


def _check(g: TriadGroup, way: Course) -> None:
    """Refuse a direction near which the group has no way of assembly, and one that is another after a turn of the crank.

    Raises
    ------
    CannotBuild
        with the ways of assembly at the crank angle where the direction is told.
    """
    if way.taken < 0:
        return  # the limits tell by how much
    if abs(np.angle(way.found[way.taken][1] * np.exp(-1j * g.near))) > SURELY:
        message = tell("group {group}: no way of assembly at crank angle {angle:g} deg has {side} near {told:g} deg")
        raise CannotBuild(message.format(**_assemblies(g, way)), tell("take one of {ways} deg").format(**_assemblies(g, way)))
    others = [abs(np.angle(u / way.found[way.taken][1])) for n, (_, u) in enumerate(way.found) if n != way.taken]
    if min(others, default=np.pi) < ALIKE:
        message = tell("group {group}: two ways of assembly have {side} in the same direction at crank angle {angle:g} deg")
        raise CannotBuild(message.format(**_assemblies(g, way)),
                          tell("tell the direction at another crank angle, with at = \"30 deg\""))
    if not way.back:
        message = tell("group {group}: after a turn of the crank it stands in another way of assembly")
        hint = tell("make the crank shorter; ways of assembly at crank angle {angle:g} deg have {side} at {ways} deg")
        raise CannotBuild(message.format(**_assemblies(g, way)), hint.format(**_assemblies(g, way)))


def _hint(g: TriadGroup, pos: Positions) -> str:
    way = pos.course(g)
    if not way.found:
        return tell("no way of assembly at crank angle {angle:g} deg: lengthen a leg or bring the pivots nearer").format(
            angle=np.degrees(g.when))
    return tell("make the crank shorter, or the legs longer; ways of assembly at crank angle {angle:g} deg have {side} at "
                "{ways} deg").format(**_assemblies(g, way))


TRIAD = TriadKind()
