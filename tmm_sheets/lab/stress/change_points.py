"""Mechanisms that pass change points, and the motion of their hinge by formulas that are smooth there, in 90 digits.

In a parallelogram the hinge is the crank's pin moved by the frame; in an antiparallelogram and in a kite it is a mirror image
about the line from the pin to the other pivot; on a guide through the crank's pivot a rod as long as the crank moves it by
2 r cos(phi), or not at all. None of these formulas has a root, or lines that could fall together.

A crank with one group in 90 digits of decimal arithmetic: coordinates, differentiated by their differences.

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
from tmm_sheets.lab.stress.draw import crank_of, loaded, with_rocker, with_slider
from tmm_sheets.lab.stress.invariants import Residual, State, by_plans_and_lever, cross, statics
from tmm_sheets.mechanism.groups import RRR
from tmm_sheets.mechanism.model import Link, Mechanism, StructuralGroup

DIGITS, STEP = 90, Decimal("1e-24")
"""Digits of the coordinates, and the angle to both sides over which they are differentiated, rad: far less than any angle is from
where a group ceases to assemble, and far more than what is rounding of the cosines, 1e-70."""


@dataclass(frozen=True)
class Exact:
    """A complex number of decimals."""

    x: Decimal
    y: Decimal = Decimal(0)

    def __add__(self, o: Exact) -> Exact:
        return Exact(self.x + o.x, self.y + o.y)

    def __sub__(self, o: Exact) -> Exact:
        return Exact(self.x - o.x, self.y - o.y)

    def __mul__(self, o: Exact) -> Exact:
        return Exact(self.x * o.x - self.y * o.y, self.x * o.y + self.y * o.x)

    def __truediv__(self, o: Exact) -> Exact:
        size = o.x * o.x + o.y * o.y
        return self * Exact(o.x / size, -o.y / size)

    def conjugate(self) -> Exact:
        """The picture in the real axis."""
        return Exact(self.x, -self.y)

    def __complex__(self) -> complex:
        return complex(float(self.x), float(self.y))


def exact(z: complex) -> Exact:
    """The decimals that a number is."""
    return Exact(Decimal(z.real), Decimal(z.imag))


Three = tuple[Exact, Exact, Exact]
"""Value of a function of the crank angle, and its first and second derivative over it."""


def differentiated(f: Callable[[Decimal], Exact | None], phi: float) -> Three | None:
    """A function at a crank angle, rad, with both derivatives by central differences; None where it has no value."""
    with localcontext(prec=DIGITS):
        low, here, high = (f(Decimal(phi) + k * STEP) for k in (-1, 0, 1))
        if low is None or here is None or high is None:
            return None
        return here, (high - low) * Exact(1 / (2 * STEP)), (high - here - here + low) * Exact(1 / STEP**2)


def arm(m: Mechanism, phi: Decimal) -> Exact:
    """The crank's pin as seen from its pivot."""
    return Exact(*cos_sin(phi % (2 * PI))) * Exact(Decimal(m.crank.length))


@dataclass(frozen=True)
class MotionTruth:
    """The inner hinge of the group: position, velocity, acceleration; None where the group does not assemble."""

    z: complex
    v: complex
    a: complex


def motion(m: Mechanism, phi: float) -> MotionTruth | None:
    """Motion of the inner hinge of the first group (kind 1 or 2, between crank pin and frame); None where it does not assemble."""
    c, hinge = m.crank, _arcs if m.groups[0].kind == RRR else _line
    found = differentiated(lambda x: hinge(m, exact(m.fixed[c.pivot]) + arm(m, x)), phi)
    if found is None:
        return None
    z, first, second = found
    w, e = Exact(Decimal(c.omega)), Exact(Decimal(c.sense * c.acceleration))
    return MotionTruth(complex(z), complex(first * w), complex(second * w * w + first * e))


def _arcs(m: Mechanism, b: Exact) -> Exact | None:
    """Where two arcs meet, about the pin and about the other pivot."""
    g = m.groups[0]
    l2, l3 = (Exact(Decimal(x) ** 2) for x in g.lengths)
    e = exact(m.fixed[g.outer[1]]) - b
    square = e * e.conjugate()
    along = (square + l2 - l3) / (square + square)
    across = l2 / square - along * along
    return None if across.x < 0 else b + e * (along + exact(1j * g.side) * Exact(across.x.sqrt()))


def _line(m: Mechanism, b: Exact) -> Exact | None:
    """Where an arc about the pin meets a guide."""
    g = m.groups[0]
    guide = m.guides[g.guides[0]]
    u, p = Exact(*direction(guide.direction)[1:]), exact(guide.at)
    seen = (b - p) * u.conjugate()
    square = Decimal(g.lengths[0]) ** 2 - seen.y * seen.y
    return None if square < 0 else p + u * Exact(seen.x + Decimal(g.side) * square.sqrt())


COUNT = 6
"""Crank angles about each change point."""
BORDER = 1e-15
"""How near an angle may be to where a change point ends, rad: the change point itself is known to its rounding."""
SIDEWAYS = (0.0, pi / 2, pi, -pi / 2)
Make = Callable[..., State]
"""How the plans of a mechanism are evaluated."""
Way = Callable[[Exact, Exact], Exact]
"""The hinge by the crank's pin and the other pivot, or the direction of the guide."""


def _mirrored(b: Exact, d: Exact, of: Exact) -> Exact:
    """A point ``of`` the plane, from the pin, mirrored about the line from the pin to the pivot."""
    e = d - b
    return b + e * of.conjugate() / e.conjugate()


def _at_rest(b: Exact, d: Exact) -> Exact:
    return exact(0)


def _sliding(b: Exact, u: Exact) -> Exact:
    """Twice the projection of the pin on the guide."""
    return b + u * u * b.conjugate()


@dataclass(frozen=True)
class Passing:
    """A mechanism, the ways of its hinge on both sides behind its first change point, its crank angles there, rad."""

    m: Mechanism
    left: Way
    right: Way
    angles: tuple[float, ...]

    @property
    def beside(self) -> Exact:
        """The other pivot, or the direction of the guide."""
        g = self.m.groups[0]
        return Exact(*direction(self.m.guides[g.guides[0]].direction)[1:]) if g.guides else exact(self.m.fixed["D"])

    def hinge(self, phi: float) -> Three:
        """The hinge on its way, with both derivatives over the crank angle."""
        way, beside = self.way(phi), self.beside
        found = differentiated(lambda x: way(arm(self.m, x), beside), phi)
        assert found is not None
        return found

    def side(self, phi: float, way: Way) -> float:
        """Side of the hinge on a way."""
        with localcontext(prec=DIGITS):
            b = arm(self.m, Decimal(phi))
            c = way(b, self.beside)
            if self.m.groups[0].guides:
                return float(np.sign(float((self.beside.conjugate() * (c - b)).x)))
            return float(np.sign(float(((self.beside - b).conjugate() * (c - b)).y)))

    def way(self, phi: float) -> Way:
        """The way that the group is on at a crank angle: the one that it follows, or that on its side."""
        g = self.m.groups[0]
        resting = any(abs(np.angle(np.exp(1j * (phi - a)))) <= at_rest(phi) for a in self.angles)
        return self.left if self.side(g.at if g.follow or resting else phi, self.left) == g.side else self.right


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
    m = with_rocker(pivot, rods, side=rng.choice((1, -1)), follow=bool(rng.random() < 0.5),
                    at=at + float(rng.uniform(0.1, 3.0)) * float(rng.choice((1, -1))),
                    crank=replace(crank_of(rng, crank), length=crank))
    ways: tuple[Way, Way] = (
        (lambda b, d: _mirrored(b, d, exact(0) - b), _at_rest) if kite else (Exact.__add__, lambda b, d: _mirrored(b, d, d)))
    return Passing(m, *ways, (at, at + pi))


def _slider(rng: np.random.Generator) -> Passing:
    """A rod as long as the crank, on a guide through its pivot."""
    length, turn = _decimal(rng, int(rng.integers(-5, 1)), 100, 1000), float(rng.choice((*SIDEWAYS, rng.uniform(-pi, pi))))
    m = with_slider(0j, turn, length, side=rng.choice((1, -1)), follow=bool(rng.random() < 0.5),
                    at=turn + float(rng.uniform(-1.5, 1.5)) + float(rng.choice((0.0, pi))),
                    crank=replace(crank_of(rng, length), length=length))
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
        yield from _passed(of, make(of.m, about(rng, of.angles), gravity))

    return drawn


def _passed(of: Passing, s: State) -> Iterator[Residual]:
    """Velocity and acceleration of the hinge, and the moment on the crank, against what the formulas give."""
    phi, c = s.phi, of.m.crank
    first, second = np.array([[complex(x) for x in of.hinge(angle)[1:]] for angle in phi.tolist()]).T
    w, e = c.omega, c.sense * c.acceleration
    v, a = w * first, w * w * second + e * first
    pin = c.speed * c.length
    yield from hinge_errors(s, v, a, THROUGH, _told)
    at = {"A": np.zeros(len(phi)), "B": s.v["B"], "C": v, "D": np.zeros(len(phi))}
    beside = {"A": np.zeros(len(phi)), "B": s.a["B"], "C": a, "D": np.zeros(len(phi))}
    power, total = np.zeros(len(phi)), np.zeros(len(phi))
    for link in of.m.links.values():
        p, q = {"1": ("A", "B"), "2": ("B", "C"), "3": ("D" if "D" in of.m.fixed else "C", "C")}[link.name]
        r = s.z[q] - s.z[p] if p != q else np.ones(len(phi))
        turning, growing = (cross(r, vectors[q] - vectors[p]) / np.abs(r) ** 2 for vectors in (at, beside))
        own = link.inertia * turning * growing
        if link.centre is not None:
            lifted = link.mass * s.gravity * at[link.centre].imag
            sped = link.mass * (at[link.centre] * np.conj(beside[link.centre])).real
            power, total = power + lifted + sped, total + np.abs(lifted) + np.abs(sped)
        power, total = power + own, total + np.abs(own)
    by_plans, by_lever = by_plans_and_lever(s)
    # Weights and inertia that the links have anyhow, in a motion like the crank's.
    scale = total + pin * sum(link.mass * (s.gravity + c.speed**2 * c.length) for link in of.m.links.values())
    yield "moment through a change point", _told(by_lever * w - power) / scale
    yield "moment through a change point", _told(by_plans * w - power) / scale
    yield from statics(s)


def _told(difference: Any) -> Any:
    """How far something is off; without bounds where it is not told at all."""
    return np.where(np.isnan(difference), np.inf, np.abs(difference))


THROUGH = "through a change point"


def hinge_errors(s: State, v: Any, a: Any, where: str, told: Callable[[Any], Any] = np.abs) -> Iterator[Residual]:
    """Velocity and acceleration of the hinge at the first positions of a state against the true ones."""
    pin = s.m.crank.speed * s.m.crank.length
    yield f"velocity {where}", told(s.v["C"][:len(v)] - v) / np.maximum(np.abs(v), pin)
    yield f"acceleration {where}", told(s.a["C"][:len(a)] - a) / np.maximum(np.abs(a), pin * s.m.crank.speed)


def folding(rng: np.random.Generator, make: Make) -> Iterator[Residual]:
    """A four-bar of any lengths that folds flat once a turn, next to there on its side, against 90 digits."""
    size = 2.0 ** int(rng.integers(-9, 10))
    crank, rod, frame = (size * float(rng.integers(low, high)) / 64 for low, high in ((8, 16), (24, 48), (50, 64)))
    m = with_rocker(frame, (rod, crank + frame - rod), side=rng.choice((1, -1)), crank=replace(crank_of(rng, crank), length=crank))
    phi = pi + 10.0 ** rng.uniform(-13, 0, 4 * COUNT) * rng.choice((1, -1), 4 * COUNT)
    true = [motion(m, x) for x in phi.tolist()]
    v, a = (np.array([complex(getattr(t, name)) for t in true]) for name in "va")
    yield from hinge_errors(make(m, phi), v, a, THROUGH, _told)


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
