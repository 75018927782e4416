"""Random mechanisms, put together around a position where they assemble: points first, lengths measured from them.

Everything comes from one generator of random numbers, so that a case is known by its seed and number.
"""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.mechanism.groups import KINDS, PRP, RPP, RPR, RRP, RRR, TRIAD
from tmm_sheets.mechanism.groups.triad import TriadGroup
from tmm_sheets.mechanism.model import Crank, Guide, Leg, Link, LinkPoint, Mechanism, StructuralGroup

SURE = 0.25
"""Least sine of the deciding angle of a group that is not meant to be near its limit."""


class Unlucky(Exception):
    """What was drawn does not assemble as asked for: draw again."""


def want(holds: bool) -> None:
    """Draw again where this does not hold.

    Raises
    ------
    Unlucky
        when it does not hold.
    """
    if not holds:
        raise Unlucky


def sine(u: complex, v: complex) -> float:
    """Sine of the angle between two directions, positive."""
    return abs((u.conjugate() * v).imag) / abs(u) / abs(v)


@dataclass
class Draft:
    """A mechanism in the making, with its points as they stand at the crank angle ``phi``; ``hard`` is what is made difficult."""

    rng: np.random.Generator
    size: float
    phi: float
    crank: Crank
    hard: str = ""
    at: dict[str, complex] = field(default_factory=dict)
    on: dict[str, list[str]] = field(default_factory=dict)
    fixed: dict[str, complex] = field(default_factory=dict)
    guides: dict[str, Guide] = field(default_factory=dict)
    groups: list[StructuralGroup] = field(default_factory=list)
    points: list[LinkPoint] = field(default_factory=list)
    slots: dict[str, complex] = field(default_factory=dict)

    def between(self, low: float, high: float) -> float:
        """A number between two others."""
        return float(self.rng.uniform(low, high))

    def angle(self) -> float:
        """Any angle."""
        return self.between(-pi, pi)

    def length(self) -> float:
        """A length of the mechanism's size."""
        return self.size * self.between(0.5, 2.0)

    def side(self) -> int:
        """One or the other assembly side."""
        return int(self.rng.choice((1, -1)))

    def coin(self) -> bool:
        """Yes or no."""
        return bool(self.rng.random() < 0.5)

    def new(self, letter: str) -> str:
        """A name that is free."""
        return f"{letter}{sum(name[0] == letter for name in self.at)}"

    def moving(self, besides: tuple[str, ...] = ()) -> tuple[str, tuple[str, ...]]:
        """A point of a moving link that is on none of the links ``besides``, and its links."""
        links = {p: tuple(link for link, names in self.on.items() if p in names) for p in self.at if p not in self.fixed}
        pairs = [(p, of) for p, of in links.items() if of and not set(of) & set(besides)]
        want(bool(pairs))
        return pairs[int(self.rng.integers(len(pairs)))]

    def pivot(self, z: complex) -> str:
        """A new fixed point."""
        name = self.new("O")
        self.fixed[name] = self.at[name] = z
        return name

    def base(self, link: str, start: str, towards: str) -> complex:
        """Direction fixed on a link, as the position plan takes it."""
        if link in self.slots and towards not in self.on[link]:
            return self.slots[link]
        e = self.at[towards] - self.at[start]
        return e / abs(e)

    def further(self, link: str, start: str, towards: str) -> None:
        """Another point on a link, anywhere."""
        name, distance, angle = self.new("E"), self.length(), self.angle()
        self.points.append(LinkPoint(name, link, start, towards, distance, angle))
        self.at[name] = self.at[start] + distance * self.base(link, start, towards) * rect(1, angle)
        self.on[link].append(name)

    def guide(self, near: complex, besides: tuple[str, ...] = (), moving: bool | None = None) -> tuple[str, complex, complex, str]:
        """A fixed or moving guide somewhere near a point: its name, point, direction and link."""
        lines = [(link, a, b) for link, a, b in self.lines() if link not in besides]
        if (self.coin() if moving is None else moving) and lines:
            return self.moving_guide(*lines[int(self.rng.integers(len(lines)))])
        return self.fixed_guide(near)

    def moving_guide(self, link: str, a: str, b: str) -> tuple[str, complex, complex, str]:
        """A guide on a link, through its point ``a``: along the line to ``b``, or anyhow to it."""
        name = f"g{len(self.guides)}"
        turn = 0.0 if self.coin() else self.angle()
        self.guides[name] = Guide(name, link, a, turn, b)
        return name, self.at[a], self.base(link, a, b) * rect(1, turn), link

    def fixed_guide(self, near: complex) -> tuple[str, complex, complex, str]:
        """A guide in the frame, as the case wants it."""
        name = f"g{len(self.guides)}"
        u = float(self.rng.choice((0.0, pi / 2, pi, -pi / 2))) if self.coin() or self.hard == "square" else self.angle()
        through = near + rect(self.length(), self.angle())
        if self.hard in ("square", "coincident"):
            through = self.at["A"] + (0j if self.coin() else rect(self.size / 4, u + pi / 2))
        if self.hard == "coincident":
            fixed = [g for g in self.guides.values() if isinstance(g.through, complex)]
            if fixed:
                u = fixed[0].direction + (0.0 if self.coin() else pi)
                through = complex(fixed[0].through)
        if self.hard == "guide":
            u = pi / 2 + np.radians(0.05) * self.side()
        if self.hard == "far":
            through += rect(1e4 * self.size, u) * self.side()
        self.guides[name] = Guide(name, "0", through, u)
        return name, through, rect(1, u), "0"

    def add(self, group: StructuralGroup, at: complex | None, *on: list[str]) -> None:
        """A group, the place of the point that it adds, if any, and the points on its links."""
        self.groups.append(group)
        if at is not None:
            self.at[str(group.inner)] = at
        self.on |= dict(zip(group.links, on, strict=True))

    def lines(self) -> list[tuple[str, str, str]]:
        """Lines on moving links: link, point, another point (or the pin in its slot)."""
        found = [(link, names[0], names[1]) for link, names in self.on.items() if len(names) > 1]
        slots = [next(g for g in self.groups if link in g.links) for link in self.slots]
        return found + [(g.links[1], g.outer[1], g.outer[0]) for g in slots]

    def least(self) -> float:
        """Sine of the deciding angle of the next group: ordinary, or as small as the case wants it."""
        return 10.0 ** self.between(-12, -1) if self.hard == "narrow" else SURE

    def near_limit(self, u: complex, least: float) -> complex:
        """A direction that makes a small angle with ``u``, as near as asked for."""
        return u * rect(1, least * self.side()) * self.side()

    def mechanism(self) -> Mechanism:
        """The finished mechanism, without masses."""
        links = {name: Link(name) for name in self.on}
        return Mechanism(self.crank, self.fixed, self.guides, tuple(self.groups), tuple(self.points), links)


def rrr(d: Draft, links: tuple[str, str]) -> None:
    """Two links with three hinges; nearly in line where it is meant to be hard."""
    p, owner = d.moving()
    least = d.least()
    if d.hard not in ("narrow", "collinear") and len(d.on) > 1 and d.coin():
        q, _ = d.moving(besides=owner)
        c = d.at[p] + rect(d.length(), d.angle())
    else:
        u = rect(1, d.angle())
        c = d.at[p] + d.length() * u
        v = u * rect(1, d.side() * d.between(0.3, pi - 0.3))
        if d.hard in ("narrow", "collinear"):
            v = u * d.side() if d.hard == "collinear" else d.near_limit(u, least)
        q = "A" if d.hard == "coincident" and p != "B" and d.coin() else d.pivot(c + d.length() * v)
    to_p, to_q = d.at[p] - c, d.at[q] - c
    want(abs(to_p) > d.size / 4 and abs(to_q) > d.size / 4 and abs(d.at[p] - d.at[q]) > d.size / 4)
    want(d.hard in ("narrow", "collinear") or sine(to_p, to_q) > SURE)
    side = 1 if ((d.at[q] - d.at[p]).conjugate() * (c - d.at[p])).imag > 0 else -1
    name = d.new("C")
    d.add(StructuralGroup(RRR, links, (p, q), name, (abs(to_p), abs(to_q)), (), side), c, [p, name], [q, name])
def rrp(d: Draft, links: tuple[str, str]) -> None:
    """A rod and a slider; the rod nearly across the guide where it is meant to be hard."""
    p, owner = d.moving()
    guide, through, u, link = d.guide(d.at[p], owner, moving=False if d.hard in ("narrow", "collinear") else None)
    foot = through + u * (u.conjugate() * (d.at[p] - through)).real
    c = foot + u * d.size * d.between(0.3, 2) * d.side()
    if d.hard in ("narrow", "collinear"):
        want(link == "0" and abs(d.at[p] - foot) > d.size / 4)
        c = foot + u * abs(d.at[p] - foot) * (d.least() if d.hard == "narrow" else 0.0) * d.side()
    rod = c - d.at[p]
    want(abs(rod) > d.size / 4 and (d.hard in ("narrow", "collinear") or sine(rod, 1j * u) > SURE))
    name = d.new("C")
    d.add(StructuralGroup(RRP, links, (p,), name, (abs(rod),), (guide,), 1 if (rod / u).real > 0 else -1), c, [p, name], [name])
def rpr(d: Draft, links: tuple[str, str]) -> None:
    """A block and its rocker, often with an offset; the slot nearly across the line of the pivots where it is meant to be hard."""
    p, owner = d.moving()
    way = rect(d.length(), d.angle())
    if d.hard == "pin by the pivot":
        way *= 10.0 ** d.between(-9, -1)
    fixed = d.hard in ("pin by the pivot", "coincident") or len(d.on) == 1 or d.coin()
    q = d.moving(besides=owner)[0] if not fixed else "A" if d.hard == "coincident" and d.coin() else d.pivot(d.at[p] + way)
    e = d.at[p] - d.at[q]
    want(abs(e) > d.size / 4 or (d.hard == "pin by the pivot" and abs(e) > 0))
    share = 0.0 if d.coin() else d.between(0.05, 0.8)
    if d.hard == "narrow":
        share = (1 - d.least() ** 2) ** 0.5
    if d.hard == "offset":
        share = float(d.rng.choice((0.0, 1e-300, 1e-17, 1e-12, 1e-6)))
    side = d.side()
    d.add(StructuralGroup(RPR, links, (p, q), None, (), (), side, share * abs(e)), None, [p], [q])
    d.slots[links[1]] = e / abs(e) * complex((1 - share**2) ** 0.5, side * share)
def prp(d: Draft, links: tuple[str, str]) -> None:
    """Two sliders on a hinge; the first guide moves. Guides nearly parallel where it is meant to be hard."""
    one, a, u, owner = d.guide(0j, moving=True)
    want(owner != "0")
    if d.hard == "narrow":
        v = d.near_limit(u, d.least())
        two = f"g{len(d.guides)}"
        d.guides[two] = Guide(two, "0", d.at[next(iter(d.at))] + rect(d.length(), d.angle()), float(np.angle(v)))
        b = d.guides[two].through
        assert not isinstance(b, str)
    else:
        two, b, v, _ = d.guide(a, (owner,))
        want(sine(u, v) > SURE)
    c = a + u * (((b - a).conjugate() * v).imag / (u.conjugate() * v).imag)
    want(d.hard == "narrow" or abs(c - a) < 5 * d.size)
    name = d.new("C")
    d.add(StructuralGroup(PRP, links, (), name, (), (one, two)), c, [name], [name])
def rpp(d: Draft, links: tuple[str, str]) -> None:
    """A slider block in a slot of a slider; the slot nearly along the guide where it is meant to be hard."""
    p, owner = d.moving()
    guide, through, u, _ = d.guide(d.at[p], owner)
    slot = d.side() * (pi / 2 if d.coin() else d.between(0.3, pi - 0.3))
    if d.hard == "narrow":
        slot = d.least() * d.side()
    v = u * rect(1, slot)
    c = through + u * (((d.at[p] - through).conjugate() * v).imag / (u.conjugate() * v).imag)
    want(d.hard == "narrow" or abs(c - d.at[p]) < 5 * d.size)
    name = d.new("C")
    d.add(StructuralGroup(RPP, links, (p,), name, (), (guide,), 1, 0.0, slot), c, [], [name])
def triad(d: Draft, links: tuple[str, ...]) -> None:
    """A triangle on three legs, the first on a moving point, the others on anything; the second now and then a block in a slot."""
    triangle, first, second, third = links
    p, owner = d.moving()
    theta, sides, angle = d.angle(), (d.length(), d.length()), d.side() * d.between(0.0, 2.5)
    k = d.at[p] + rect(d.length(), d.angle())
    u = rect(1, theta)
    corners = (k, k + sides[0] * u, k + sides[1] * u * rect(1, angle))
    names = [d.new("K"), d.new("L"), d.new("M")]
    legs = [Leg(first, names[0], p, length=abs(k - d.at[p]))]
    normals = [(k - d.at[p], k)]
    guides: list[str] = []
    outer = [p]
    for link, name, at in ((second, names[1], corners[1]), (third, names[2], corners[2])):
        choice = int(d.rng.integers(3))
        if choice == 1:
            guide, through, v, _ = d.guide(at, owner)
            if d.guides[guide].link == "0":
                through = at - v * d.length()
                d.guides[guide] = replace(d.guides[guide], through=through)
            want(abs(((at - through) * v.conjugate()).imag) < 1e-15 * d.size)  # a moving guide hardly passes there
            legs.append(Leg(link, name, guide=guide))
            normals.append((1j * v, at))
            guides.append(guide)
            continue
        if choice == 2 and link == second:
            turn = d.angle()
            v = u * rect(1, turn)
            q = d.pivot(at + d.length() * v)
            legs.append(Leg(link, name, q, slot=turn))
            normals.append((1j * v, d.at[q]))
        else:
            q = d.moving(besides=owner)[0] if len(d.on) > 1 and d.coin() and d.coin() else d.pivot(at + rect(d.length(), d.angle()))
            want(abs(d.at[q] - at) > d.size / 4)
            legs.append(Leg(link, name, q, length=abs(at - d.at[q])))
            normals.append((at - d.at[q], at))
        outer.append(q)
    n = [v / abs(v) for v, _ in normals]
    m = [((at - k).conjugate() * v).imag / max(sides) for v, (_, at) in zip(n, normals, strict=True)]
    det = sum(m[a] * (n[b].conjugate() * n[c]).imag for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
    want(abs(det) > SURE)
    d.groups.append(TriadGroup(TRIAD, links, tuple(outer), None, (), tuple(guides), legs=tuple(legs), sides=sides, angle=angle,
                               near=theta, when=d.phi))
    for name, at in zip(names, corners, strict=True):
        d.at[name] = at
    d.on[triangle] = names
    for leg in legs:
        d.on[leg.link] = [leg.outer, leg.corner] if leg.form == "RR" else [leg.at]


BUILD: dict[int, Callable[[Draft, Any], None]] = {1: rrr, 2: rrp, 3: rpr, 4: prp, 5: rpp, TRIAD.number: triad}
"""How a group of each kind is added to a draft."""


EVERYWHERE = ("guide", "far", "square", "coincident", "offset")
"""What befalls all groups of a mechanism, not only the last."""


def crank_of(rng: np.random.Generator, size: float) -> Crank:
    """A crank of about that size: any speed, either sense, even or uneven."""
    speed = 10.0 ** float(rng.uniform(-1, 3))
    uneven = speed**2 * float(rng.uniform(-2, 2)) if rng.random() < 0.5 else 0.0
    return Crank("1", "A", "B", size * float(rng.uniform(0.5, 2)), speed, int(rng.choice((1, -1))), uneven)


def with_rocker(pivot: complex, lengths: tuple[float, float], side: float, crank: Crank, **group: Any) -> Mechanism:
    """A crank about the origin with rod and rocker of these lengths, the rocker about another pivot."""
    g = StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", lengths, (), int(side), **group)
    return Mechanism(crank, {"A": 0j, "D": complex(pivot)}, {}, (g,), (), {n: Link(n) for n in "123"})


def with_slider(through: complex, direction: float, length: float, side: float, crank: Crank, **group: Any) -> Mechanism:
    """A crank about the origin with a rod and a slider on a guide."""
    g = StructuralGroup(RRP, ("2", "3"), ("B",), "C", (length,), ("x",), int(side), **group)
    guide = Guide("x", "0", complex(through), direction)
    return Mechanism(crank, {"A": 0j}, {"x": guide}, (g,), (), {n: Link(n) for n in "123"})


def chain(rng: np.random.Generator, hard: str = "", kinds: tuple[int, ...] | None = None) -> tuple[Mechanism, float]:
    """A mechanism of one to three groups of any kinds and a crank angle where it assembles; ``hard`` befalls the last group.

    Raises
    ------
    AssertionError
        when no mechanism of these kinds is found.
    """
    for _ in range(1000):
        chosen = kinds or tuple(int(k) for k in rng.integers(1, 6, int(rng.integers(1, 4))))
        try:
            return _chain(rng, hard, chosen)
        except Unlucky:
            continue
    raise AssertionError("no mechanism of these kinds found")


def _chain(rng: np.random.Generator, hard: str, kinds: tuple[int, ...]) -> tuple[Mechanism, float]:
    size, phi = 10.0 ** float(rng.uniform(-3, 3)), float(rng.uniform(-pi, pi))
    crank = crank_of(rng, size)
    centre = rect(size * (1e4 if hard == "away" else float(rng.uniform(0, 2))), float(rng.uniform(-pi, pi)))
    if hard == "tiny crank":
        crank, centre = replace(crank, length=1e-6 * crank.length), 0j
    if hard == "square":
        phi = float(rng.choice((0.0, pi / 2, pi, -pi / 2)))
    d = Draft(rng, size, phi, crank)
    d.fixed["A"] = d.at["A"] = centre
    d.at["B"] = centre + rect(crank.length, phi)
    d.on["1"] = ["A", "B"]
    if d.coin():
        d.further("1", "A", "B")
    for i, kind in enumerate(kinds):
        d.hard = hard if i + 1 == len(kinds) or hard in EVERYWHERE else ""
        n = len(d.on) + 1
        # Two links of order 2, four of order 3.
        BUILD[kind](d, tuple(str(n + i) for i in range(2 * (KINDS[kind].order - 1))))
        if i + 1 < len(kinds):
            for link, a, b in d.lines():
                if link in d.groups[-1].links:
                    d.further(link, a, b)
    return d.mechanism(), phi


def loaded(rng: np.random.Generator, m: Mechanism, spread: float = 0.3, empty: float = 0.2) -> Mechanism:
    """The mechanism with masses and inertias, some of them zero; ``spread`` is that of their decimal logarithm."""
    links: dict[str, Any] = {}
    for name in m.links:
        own = [p.name for p in m.pairs if name in p.links and p.motion == "rotation"]
        own += [p.name for p in m.points if p.link == name]
        own += [str(g.inner) for g in m.groups if g.kind.ram(g) == name]
        mass, inertia = (0.0 if rng.random() < empty else 10.0 ** float(rng.normal(0, spread)) for _ in range(2))
        links[name] = Link(name, "", mass, own[int(rng.integers(len(own)))], inertia * m.crank.length**2)
    return replace(m, links=links)
