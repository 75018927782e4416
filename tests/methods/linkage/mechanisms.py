"""Mechanisms to try the methods on: put together by hand, or drawn at random around a position where they assemble.

For the random ones the points are chosen first and the lengths measured from them: every mechanism assembles at its crank
angle, on the side it was drawn on, and no group is near a dead position (sine of the deciding angle at least ``SURE``).
"""

from __future__ import annotations

from cmath import rect
from dataclasses import dataclass, field
from math import cos, pi, sin

from hypothesis import assume, strategies as st

from tmm_sheets.mechanism.groups import PRP, RPP, RPR, RRP, RRR
from tmm_sheets.mechanism.model import Crank, Guide, Link, LinkPoint, Mechanism, StructuralGroup

SURE = 0.25


def mechanism(*groups, fixed=None, guides=(), points=(), crank=None):
    """A mechanism on a crank of 0.1 m about A at the origin, put together by hand."""
    crank = crank or Crank("1", "A", "B", 0.1, 10.0, 1)
    links = {name: Link(name) for name in (crank.link, *(n for g in groups for n in g.links))}
    return Mechanism(crank, {"A": 0j} | (fixed or {}), {g.name: g for g in guides}, groups, tuple(points), links)


def value(step, k=0):
    """Value of a step at one position, as a complex number."""
    return complex(step.at(k))


@dataclass
class Drawn:
    """A mechanism in the making, with its points as they stand at the crank angle ``phi``."""

    draw: object
    size: float
    phi: float
    crank: Crank
    at: dict[str, complex] = field(default_factory=dict)
    on: dict[str, list[str]] = field(default_factory=dict)
    fixed: dict[str, complex] = field(default_factory=dict)
    guides: dict[str, Guide] = field(default_factory=dict)
    groups: list[StructuralGroup] = field(default_factory=list)
    points: list[LinkPoint] = field(default_factory=list)
    slots: dict[str, complex] = field(default_factory=dict)

    def between(self, low, high):
        return self.draw(st.floats(low, high))

    def angle(self):
        return self.between(-pi, pi)

    def length(self):
        return self.size * self.between(0.5, 2.0)

    def side(self):
        return self.draw(st.sampled_from((1, -1)))

    def new(self, letter):
        return f"{letter}{sum(name[0] == letter for name in self.at)}"

    def moving(self, besides=()):
        """A point of a moving link that is on none of the links ``besides``, and its links."""
        links = {p: tuple(link for link, names in self.on.items() if p in names) for p in self.at if p not in self.fixed}
        pairs = [(p, of) for p, of in links.items() if of and not set(of) & set(besides)]
        assume(pairs)
        return self.draw(st.sampled_from(pairs))

    def pivot(self, z):
        name = self.new("O")
        self.fixed[name] = self.at[name] = z
        return name

    def base(self, link, start, towards):
        if link in self.slots and towards not in self.on[link]:
            return self.slots[link]
        e = self.at[towards] - self.at[start]
        return e / abs(e)

    def further(self, link, start, towards):
        """Another point on a link, anywhere."""
        name, distance, angle = self.new("E"), self.length(), self.angle()
        self.points.append(LinkPoint(name, link, start, towards, distance, angle))
        self.at[name] = self.at[start] + distance * self.base(link, start, towards) * rect(1, angle)
        self.on[link].append(name)

    def guide(self, near, besides=(), moving=None):
        """A guide (fixed or moving) somewhere near a point: its name, point, direction and link."""
        name = f"g{len(self.guides)}"
        lines = [(link, a, b) for link, a, b in self.lines() if link not in besides]
        if moving is None:
            moving = self.draw(st.booleans())
        if not moving or not lines:
            u = self.draw(st.sampled_from((0.0, pi / 2, pi, -pi / 2)) | st.floats(-pi, pi))
            through = near + rect(self.length(), u) * self.side()
            self.guides[name] = Guide(name, "0", through, u)
            return name, through, rect(1, u), "0"
        link, a, b = self.draw(st.sampled_from(lines))
        turn = self.draw(st.just(0.0) | st.floats(-pi, pi))
        self.guides[name] = Guide(name, link, a, turn, b)
        return name, self.at[a], self.base(link, a, b) * rect(1, turn), link

    def lines(self):
        """Lines on moving links: link, point, another point (or the pin in its slot)."""
        found = [(link, names[0], names[1]) for link, names in self.on.items() if len(names) > 1]
        return found + [(link, self.groups_of(link).outer[1], self.groups_of(link).outer[0]) for link in self.slots]

    def groups_of(self, link):
        return next(g for g in self.groups if link in g.links)

    def group(self, kind, **chosen):
        n = len(self.on) + 1
        links = (str(n), str(n + 1))
        BUILD[kind](self, links, **chosen)

    def mechanism(self):
        links = {name: Link(name) for name in self.on}
        return Mechanism(self.crank, self.fixed, self.guides, tuple(self.groups), tuple(self.points), links)


def crossing(u, v):
    """Sine of the angle between two directions."""
    return abs((u.conjugate() * v).imag) / abs(u) / abs(v)


def rrr(d, links):
    p, owner = d.moving()
    if len(d.on) > 1 and d.draw(st.booleans()):
        q, _ = d.moving(besides=owner)
        c = d.at[p] + rect(d.length(), d.angle())
    else:
        u = d.angle()
        c = d.at[p] + rect(d.length(), u)
        q = d.pivot(c + rect(d.length(), u + d.side() * d.between(0.3, pi - 0.3)))
    to_p, to_q = d.at[p] - c, d.at[q] - c
    assume(abs(to_p) > d.size / 4 and abs(to_q) > d.size / 4 and crossing(to_p, to_q) > SURE)
    assume(abs(d.at[p] - d.at[q]) > d.size / 4)
    side = 1 if ((d.at[q] - d.at[p]).conjugate() * (c - d.at[p])).imag > 0 else -1
    name = d.new("C")
    d.groups.append(StructuralGroup(RRR, links, (p, q), name, (abs(to_p), abs(to_q)), (), side))
    d.at[name] = c
    d.on[links[0]], d.on[links[1]] = [p, name], [q, name]


def rrp(d, links):
    p, owner = d.moving()
    guide, through, u, _ = d.guide(d.at[p], besides=owner)
    c = through + u * d.size * d.between(-2, 2)
    rod = c - d.at[p]
    assume(d.size / 4 < abs(rod) and crossing(rod, 1j * u) > SURE)
    side = 1 if (rod / u).real > 0 else -1
    name = d.new("C")
    d.groups.append(StructuralGroup(RRP, links, (p,), name, (abs(rod),), (guide,), side))
    d.at[name] = c
    d.on[links[0]], d.on[links[1]] = [p, name], [name]


def rpr(d, links, offset=None):
    p, owner = d.moving()
    if len(d.on) > 1 and d.draw(st.booleans()):
        q, _ = d.moving(besides=owner)
    else:
        q = d.pivot(d.at[p] + rect(d.length(), d.angle()))
    e = d.at[p] - d.at[q]
    assume(abs(e) > d.size / 4)
    share = d.draw(st.just(0.0) | st.floats(0.05, 0.8)) if offset is None else offset
    side = d.side()
    d.groups.append(StructuralGroup(RPR, links, (p, q), None, (), (), side, share * abs(e)))
    turn = side * complex((1 - share**2) ** 0.5, share).imag
    d.slots[links[1]] = e / abs(e) * complex((1 - share**2) ** 0.5, turn)
    d.on[links[0]], d.on[links[1]] = [p], [q]


def prp(d, links):
    # The first guide moves; the second is on another link.
    one, a, u, owner = d.guide(0j, moving=True)
    two, b, v, _ = d.guide(a, besides=(owner,))
    assume(crossing(u, v) > SURE)
    c = a + u * (((b - a).conjugate() * v).imag / (u.conjugate() * v).imag)
    assume(abs(c - a) < 5 * d.size)
    name = d.new("C")
    d.groups.append(StructuralGroup(PRP, links, (), name, (), (one, two)))
    d.at[name] = c
    d.on[links[0]], d.on[links[1]] = [name], [name]


def rpp(d, links):
    p, owner = d.moving()
    guide, through, u, _ = d.guide(d.at[p], besides=owner)
    slot = d.side() * d.draw(st.just(pi / 2) | st.floats(0.3, pi - 0.3))
    v = u * complex(cos(slot), sin(slot))
    c = through + u * (((d.at[p] - through).conjugate() * v).imag / (u.conjugate() * v).imag)
    assume(abs(c - d.at[p]) < 5 * d.size)
    name = d.new("C")
    d.groups.append(StructuralGroup(RPP, links, (p,), name, (), (guide,), 1, 0.0, slot))
    d.at[name] = c
    d.on[links[0]], d.on[links[1]] = [], [name]


BUILD = {1: rrr, 2: rrp, 3: rpr, 4: prp, 5: rpp}


@st.composite
def mechanisms(draw, kinds, **first):
    """A mechanism with groups of the given kinds, and a crank angle where it assembles."""
    size = 10 ** draw(st.floats(-3, 3))
    phi = draw(st.floats(-pi, pi))
    length = size * draw(st.floats(0.5, 2))
    speed = 10 ** draw(st.floats(-1, 3))
    crank = Crank("1", "A", "B", length, speed, draw(st.sampled_from((1, -1))), speed**2 * draw(st.floats(-2, 2)))
    centre = rect(size * draw(st.floats(0, 2)), draw(st.floats(-pi, pi)))
    d = Drawn(draw, size, phi, crank)
    d.fixed["A"] = d.at["A"] = centre
    d.at["B"] = centre + rect(length, phi)
    d.on["1"] = ["A", "B"]
    if draw(st.booleans()):
        d.further("1", "A", "B")
    for i, kind in enumerate(kinds):
        d.group(kind, **(first if i == 0 else {}))
        if i + 1 < len(kinds):
            for link, a, b in d.lines():
                if link in d.groups[-1].links:
                    d.further(link, a, b)
    return d.mechanism(), phi


