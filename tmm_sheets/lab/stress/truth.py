"""A crank with one group in 60 digits of decimal arithmetic: coordinates, then two linear equations for velocity and acceleration.

Shares only cosine and sine of a number with the methods; where these are exact to a few units in the last place near a dead
position, this tells.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal, localcontext

from tmm_sheets.construction.limit_angles import PI, cos_sin, direction
from tmm_sheets.mechanism.groups import RRR
from tmm_sheets.mechanism.model import Mechanism

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
