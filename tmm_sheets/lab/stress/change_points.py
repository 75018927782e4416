"""Mechanisms that pass change points, and the motion of their hinge by formulas that are smooth there, in 60 digits.

In a parallelogram the hinge is the crank's pin moved by the frame; in an antiparallelogram and in a kite it is a mirror image
about the line from the pin to the other pivot; on a guide through the crank's pivot a rod as long as the crank moves it by
2 r cos(phi), or not at all. None of these formulas has a root, or lines that could fall together.

A crank with one group in 60 digits of decimal arithmetic: coordinates, then two linear equations for velocity and acceleration.

Shares only cosine and sine of a number with the methods; where these are exact to a few units in the last place near a dead
position, this tells.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from decimal import Decimal, localcontext
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction.limit_angles import PI, at_rest, cos_sin, direction
from tmm_sheets.lab.stress.draw import crank_of, loaded
from tmm_sheets.lab.stress.invariants import Residual, State, by_plans_and_lever, cross, statics
from tmm_sheets.mechanism.groups import RRP, RRR
from tmm_sheets.mechanism.model import Guide, Link, Mechanism, StructuralGroup

DIGITS = 60


@dataclass(frozen=True)
class Vector:
    """A plane vector of decimals."""

    x: Decimal
    y: Decimal

    def __add__(self, o: Vector) -> Vector:
        return Vector(self.x + o.x, self.y + o.y)

    def __sub__(self, o: Vector) -> Vector:
        return Vector(self.x - o.x, self.y - o.y)

    def __mul__(self, k: Decimal) -> Vector:
        return Vector(self.x * k, self.y * k)

    def turned(self) -> Vector:
        """Turned by +90 degrees."""
        return Vector(-self.y, self.x)

    def dot(self, o: Vector) -> Decimal:
        """Scalar product."""
        return self.x * o.x + self.y * o.y

    def __complex__(self) -> complex:
        return complex(float(self.x), float(self.y))


def vector(z: complex) -> Vector:
    """The decimals a complex double is."""
    return Vector(Decimal(z.real), Decimal(z.imag))


@dataclass(frozen=True)
class MotionTruth:
    """The inner hinge of the group: position, velocity, acceleration; None where the group does not assemble."""

    z: complex
    v: complex
    a: complex


def motion(m: Mechanism, phi: float) -> MotionTruth | None:
    """Motion of the inner hinge of the first group (kind 1 or 2, between crank pin and frame); None where it does not assemble."""
    with localcontext(prec=DIGITS):
        c, g = m.crank, m.groups[0]
        cos, sin = cos_sin(Decimal(phi) % (2 * PI))
        arm = Vector(cos, sin) * Decimal(c.length)
        w, e = Decimal(c.omega), Decimal(c.sense * c.acceleration)
        b, vb = vector(m.fixed[c.pivot]) + arm, arm.turned() * w
        ab = arm.turned() * e - arm * (w * w)
        found = (_arcs if g.kind == RRR else _line)(m, b)
        if found is None:
            return None
        z, (r1, r2) = found
        v = _solved(r1, r2, r1.dot(vb), Decimal(0))
        relative = v - vb
        # On a line the second condition has no normal part.
        own = v.dot(v) if g.kind == RRR else Decimal(0)
        a = _solved(r1, r2, r1.dot(ab) - relative.dot(relative), -own)
        return MotionTruth(complex(z), complex(v), complex(a))


def _solved(r1: Vector, r2: Vector, a: Decimal, b: Decimal) -> Vector:
    """The vector with given scalar products."""
    det = r1.x * r2.y - r1.y * r2.x
    return Vector((a * r2.y - b * r1.y) / det, (r1.x * b - r2.x * a) / det)


def _arcs(m: Mechanism, b: Vector) -> tuple[Vector, tuple[Vector, Vector]] | None:
    g = m.groups[0]
    d = vector(m.fixed[g.outer[1]])
    l2, l3 = (Decimal(x) for x in g.lengths)
    e = d - b
    square = e.dot(e)
    along = (square + l2 * l2 - l3 * l3) / (2 * square)
    across = l2 * l2 / square - along * along
    if across < 0:
        return None
    z = b + e * along + e.turned() * (across.sqrt() * int(g.side))
    return z, (z - b, z - d)


def _line(m: Mechanism, b: Vector) -> tuple[Vector, tuple[Vector, Vector]] | None:
    g = m.groups[0]
    guide = m.guides[g.guides[0]]
    assert not isinstance(guide.through, str)
    _, cos, sin = direction(guide.direction)
    u, p = Vector(cos, sin), vector(guide.through)
    height = u.turned().dot(p - b)
    square = Decimal(g.lengths[0]) ** 2 - height * height
    if square < 0:
        return None
    z = b + u.turned() * height + u * (square.sqrt() * int(g.side))
    return z, (z - b, u.turned())


COUNT = 6
"""Crank angles about each change point."""
BORDER = 1e-15
"""How near an angle may be to where a change point ends, rad: the change point itself is known to its rounding."""
SIDEWAYS = (0.0, pi / 2, pi, -pi / 2)
ZERO = Vector(Decimal(0), Decimal(0))


@dataclass(frozen=True)
class Jet:
    """A complex function of the crank angle with its first and second derivative over it."""

    z: Vector
    first: Vector = ZERO
    second: Vector = ZERO

    def __add__(self, o: Jet) -> Jet:
        return Jet(self.z + o.z, self.first + o.first, self.second + o.second)

    def __sub__(self, o: Jet) -> Jet:
        return Jet(self.z - o.z, self.first - o.first, self.second - o.second)

    def __mul__(self, o: Jet) -> Jet:
        twice = _times(self.first, o.first) * Decimal(2)
        return Jet(_times(self.z, o.z), _times(self.first, o.z) + _times(self.z, o.first),
                   _times(self.second, o.z) + twice + _times(self.z, o.second))

    def conjugate(self) -> Jet:
        """Conjugate function of a real angle."""
        return Jet(*(Vector(v.x, -v.y) for v in (self.z, self.first, self.second)))

    def inverse(self) -> Jet:
        """1 over the function."""
        one = Vector(self.z.x, -self.z.y) * (1 / self.z.dot(self.z))
        square = _times(one, one)
        return Jet(one, _times(square, self.first) * Decimal(-1),
                   _times(square, _times(one, _times(self.first, self.first)) * Decimal(2) - self.second))


def _times(a: Vector, b: Vector) -> Vector:
    return Vector(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)


Make = Callable[[Mechanism, Any], State]
"""How the plans of a mechanism are evaluated."""
Way = Callable[[Jet, Vector], Jet]
"""The hinge by the crank's pin and the other pivot, or the direction of the guide."""


def _translated(b: Jet, d: Vector) -> Jet:
    return b + Jet(d)


def _mirrored(b: Jet, d: Vector, of: Jet) -> Jet:
    """A point ``of`` the plane, from the pin, mirrored about the line from the pin to the pivot."""
    e = Jet(d) - b
    return b + e * of.conjugate() * e.conjugate().inverse()


def _crossed(b: Jet, d: Vector) -> Jet:
    return _mirrored(b, d, Jet(d))


def _opposite(b: Jet, d: Vector) -> Jet:
    return _mirrored(b, d, Jet(ZERO) - b)


def _at_rest(b: Jet, d: Vector) -> Jet:
    return Jet(ZERO)


def _sliding(b: Jet, u: Vector) -> Jet:
    """Twice the projection of the pin on the guide."""
    return Jet(*(u * (2 * v.dot(u)) for v in (b.z, b.first, b.second)))


@dataclass(frozen=True)
class Passing:
    """A mechanism, the ways of its hinge on both sides behind its first change point, its crank angles there, rad."""

    m: Mechanism
    left: Way
    right: Way
    angles: tuple[float, ...]

    def hinge(self, phi: float, way: Way) -> Jet:
        """The hinge on one of both ways."""
        with localcontext(prec=DIGITS):
            cos, sin = cos_sin(Decimal(phi) % (2 * PI))
            arm = Vector(cos, sin) * Decimal(self.m.crank.length)
            g = self.m.groups[0]
            _, *along = direction(self.m.guides[g.guides[0]].direction) if g.guides else (0, ZERO.x, ZERO.y)
            return way(Jet(arm, arm.turned(), arm * Decimal(-1)), Vector(*along) if g.guides else vector(self.m.fixed["D"]))

    def side(self, phi: float, way: Way) -> float:
        """Side of the hinge on a way."""
        with localcontext(prec=DIGITS):
            b, c = self.hinge(phi, _translated_by_nothing).z, self.hinge(phi, way).z
            g = self.m.groups[0]
            if g.guides:
                _, cos, sin = direction(self.m.guides[g.guides[0]].direction)
                return float(np.sign(float((c - b).dot(Vector(cos, sin)))))
            e = vector(self.m.fixed["D"]) - b
            return float(np.sign(float(e.turned().dot(c - b))))

    def way(self, phi: float) -> Way:
        """The way that the group is on at a crank angle: the one that it follows, or that on its side."""
        g = self.m.groups[0]
        resting = any(abs(np.angle(np.exp(1j * (phi - a)))) <= at_rest(phi) for a in self.angles)
        at = g.at if g.follow or resting else phi
        return self.left if self.side(at, self.left) == g.side else self.right


def _translated_by_nothing(b: Jet, d: Vector) -> Jet:
    return b


def _decimal(rng: np.random.Generator, unit: int, low: int, high: int) -> float:
    """A length as it is written: three digits."""
    return float(Decimal(int(rng.integers(low, high))).scaleb(unit))


def _linkage(rng: np.random.Generator, kite: bool) -> Passing:
    """A parallelogram or a kite, its other pivot anywhere about the crank's."""
    unit = int(rng.integers(-5, 1))
    crank, frame = _decimal(rng, unit, 100, 400), _decimal(rng, unit, 500, 1000)
    if rng.random() < 0.5:
        crank, frame = frame, crank
    pivot, at = [(complex(frame), 0.0), (complex(-frame), pi), (complex(0.6 * frame, 0.8 * frame), float(np.arctan2(4, 3))),
                 (frame * np.exp(0.7j), 0.7)][int(rng.integers(4))]
    rods = (crank, frame) if kite else (frame, crank)
    g = StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", rods, (), int(rng.choice((1, -1))), follow=bool(rng.random() < 0.5),
                        at=at + float(rng.uniform(0.1, 3.0)) * float(rng.choice((1, -1))))
    m = Mechanism(replace(crank_of(rng, crank), length=crank), {"A": 0j, "D": complex(pivot)}, {}, (g,), (),
                  {n: Link(n) for n in "123"})
    ways: tuple[Way, Way] = (_opposite, _at_rest) if kite else (_translated, _crossed)
    return Passing(m, *ways, (at, at + pi))


def _slider(rng: np.random.Generator) -> Passing:
    """A rod as long as the crank, on a guide through its pivot."""
    length, turn = _decimal(rng, int(rng.integers(-5, 1)), 100, 1000), float(rng.choice((*SIDEWAYS, rng.uniform(-pi, pi))))
    g = StructuralGroup(RRP, ("2", "3"), ("B",), "C", (length,), ("x",), int(rng.choice((1, -1))), follow=bool(rng.random() < 0.5),
                        at=turn + float(rng.uniform(-1.5, 1.5)) + float(rng.choice((0.0, pi))))
    m = Mechanism(replace(crank_of(rng, length), length=length), {"A": 0j}, {"x": Guide("x", "0", 0j, turn)}, (g,), (),
                  {n: Link(n) for n in "123"})
    return Passing(m, _sliding, _at_rest, (turn + pi / 2, turn - pi / 2))


def about(rng: np.random.Generator, angles: tuple[float, ...]) -> Any:
    """Crank angles in change points, next to them, and anywhere; none whose last digit decides whether it is in a change point."""
    near = [a + x for a in angles for x in (0.0, *(10.0 ** rng.uniform(-16, 0, COUNT - 1) * rng.choice((1, -1), COUNT - 1)))]
    phi = np.concatenate((near, rng.uniform(-pi, pi, COUNT)))
    apart = np.abs(np.angle(np.exp(1j * np.subtract.outer(phi, angles))))
    return phi[(np.abs(apart - at_rest(phi)[:, None]) > BORDER).all(axis=1)]


def scene(name: str) -> Callable[[np.random.Generator, Make], Iterator[Residual]]:
    """A family of mechanisms in, next to and far from their change points."""

    def drawn(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
        of = _slider(rng) if name == "slider-crank" else _linkage(rng, name == "kite")
        if name in ("parallelogram", "antiparallelogram"):
            way = of.left if name == "parallelogram" else of.right
            g = of.m.groups[0]
            of = replace(of, m=replace(of.m, groups=(replace(g, side=of.side(g.at, way)),)))
        of = replace(of, m=loaded(rng, of.m, 0.3, 0.0))
        gravity = of.m.crank.speed**2 * of.m.crank.length * float(rng.uniform(0.0, 2.0))
        yield from _passed(of, make(of.m, about(rng, of.angles)), gravity)

    return drawn


def _passed(of: Passing, s: State, gravity: float) -> Iterator[Residual]:
    """Velocity and acceleration of the hinge, and the moment on the crank, against what the formulas give."""
    phi, c = s.phi, of.m.crank
    hinge = [of.hinge(x, of.way(x)) for x in phi.tolist()]
    first, second = (np.array([complex(getattr(h, name)) for h in hinge]) for name in ("first", "second"))
    w, e = c.omega, c.sense * c.acceleration
    v, a = w * first, w * w * second + e * first
    pin = c.speed * c.length
    yield from _compared(s, v, a)
    at = {"A": np.zeros(len(phi)), "B": s.v["B"], "C": v, "D": np.zeros(len(phi))}
    beside = {"A": np.zeros(len(phi)), "B": s.a["B"], "C": a, "D": np.zeros(len(phi))}
    power, total = np.zeros(len(phi)), np.zeros(len(phi))
    for link in of.m.links.values():
        p, q = {"1": ("A", "B"), "2": ("B", "C"), "3": ("D" if "D" in of.m.fixed else "C", "C")}[link.name]
        r = s.z[q] - s.z[p] if p != q else np.ones(len(phi))
        turning, growing = (cross(r, vectors[q] - vectors[p]) / np.abs(r) ** 2 for vectors in (at, beside))
        own = link.inertia * turning * growing
        if link.centre is not None:
            lifted = link.mass * gravity * at[link.centre].imag
            sped = link.mass * (at[link.centre] * np.conj(beside[link.centre])).real
            power, total = power + lifted + sped, total + np.abs(lifted) + np.abs(sped)
        power, total = power + own, total + np.abs(own)
    by_plans, by_lever = by_plans_and_lever(s, gravity)
    scale = total + link_scale(of.m, gravity) * pin
    yield "moment through a change point", _told(by_lever * w - power) / scale
    yield "moment through a change point", _told(by_plans * w - power) / scale
    yield from statics(s, gravity)


def _told(difference: Any) -> Any:
    """How far something is off; without bounds where it is not told at all."""
    return np.where(np.isnan(difference), np.inf, np.abs(difference))


def _compared(s: State, v: Any, a: Any) -> Iterator[Residual]:
    """Velocity and acceleration of the hinge against the true ones."""
    pin = s.m.crank.speed * s.m.crank.length
    yield "velocity through a change point", _told(s.v["C"] - v) / np.maximum(np.abs(v), pin)
    yield "acceleration through a change point", _told(s.a["C"] - a) / np.maximum(np.abs(a), pin * s.m.crank.speed)


def folding(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """A four-bar of any lengths that folds flat once a turn, next to there on its side, against 60 digits."""
    size = 2.0 ** int(rng.integers(-9, 10))
    crank, rod, frame = (size * float(rng.integers(low, high)) / 64 for low, high in ((8, 16), (24, 48), (50, 64)))
    g = StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (rod, crank + frame - rod), (), int(rng.choice((1, -1))))
    m = Mechanism(replace(crank_of(rng, crank), length=crank), {"A": 0j, "D": complex(frame)}, {}, (g,), (),
                  {n: Link(n) for n in "123"})
    phi = pi + 10.0 ** rng.uniform(-13, 0, 4 * COUNT) * rng.choice((1, -1), 4 * COUNT)
    true = [motion(m, x) for x in phi.tolist()]
    yield from _compared(make(m, phi), *(np.array([complex(getattr(t, name)) for t in true]) for name in "va"))


def link_scale(m: Mechanism, gravity: float) -> float:
    """Forces that the links have anyhow, N: weights and inertia in a motion like the crank's."""
    return sum(link.mass * (gravity + m.crank.speed**2 * m.crank.length) for link in m.links.values())


def in_a_row(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """Two parallelograms in a row, as wheels with coupling rods: all that hangs on the second moves as the crank's pin does."""
    unit = int(rng.integers(-5, 1))
    crank, one, two = (_decimal(rng, unit, low, 2 * low) for low in (100, 250, 250))
    sense, follow = float(rng.choice((1, -1))), True
    groups = tuple(StructuralGroup(RRR, links, outer, inner, (rod, crank), (), 1, follow=follow, at=1.0)
                   for links, outer, inner, rod in ((("2", "3"), ("B", "D"), "C", one), (("4", "5"), ("C", "F"), "E", two)))
    fixed = {"A": 0j, "D": complex(one), "F": complex(one + two)}
    m = Mechanism(replace(crank_of(rng, crank), length=crank, sense=sense), fixed, {}, groups, (), {n: Link(n) for n in "12345"})
    s = make(m, about(rng, (0.0, pi)))
    pin, speed = m.crank.speed * m.crank.length, m.crank.speed
    sharp = pin * (speed + abs(m.crank.acceleration) / speed)
    for name in ("C", "E"):
        yield "velocity through a change point in a row", _told(s.v[name] - s.v["B"]) / pin
        yield "acceleration through a change point in a row", _told(s.a[name] - s.a["B"]) / sharp
