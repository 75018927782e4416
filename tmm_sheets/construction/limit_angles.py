"""Quantities a + b cos(x) that vanish at a limit angle of the crank, without loss of digits near it.

Near a dead position the crank pin is already rounded when the arcs are drawn: no arithmetic on points brings its digits back.
What does is the crank angle itself: a + b cos(x) = 2 b sin((x0 + x)/2) sin((x0 - x)/2) with the limit angle x0, once per
mechanism in many digits and kept as an unevaluated sum of two doubles. Relative error some 1e-16 down to 1e-15 rad from x0.

Where a = b the quantity touches zero at x = pi and is a square, (sqrt(2 b) sin((x - pi)/2))^2: its root goes on smoothly through
the change point with the other sign.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal, localcontext
from functools import lru_cache
from math import atan2
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import Reals, Signs

DIGITS = 60
SAME = Decimal(10) ** (10 - DIGITS)
"""Relative difference that is rounding of these digits: lengths of a change point are equal."""
PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459230781640628621")


def cos_sin(x: Decimal) -> tuple[Decimal, Decimal]:
    """Cosine and sine in the digits of the context: the series at x/2**12, then the angle doubled again."""
    halvings = 12
    y = x / 2**halvings
    term, versine, sin, n = y, Decimal(0), y, 1
    while abs(term) > Decimal(10) ** (-DIGITS - 10):
        n += 1
        term = term * y / n
        if n % 2:
            sin += term if n % 4 == 1 else -term
        else:
            versine += term if n % 4 == 2 else -term  # 1 - cos
    for _ in range(halvings):
        versine, sin = 2 * sin * sin, 2 * sin * (1 - versine)
    return 1 - versine, sin


def angle_of(x: Decimal, y: Decimal) -> Decimal:
    """Angle of a vector: the double, corrected by the sine of what is left."""
    if not x and not y:
        return Decimal(0)
    length = (x * x + y * y).sqrt()
    angle = Decimal(atan2(y / length, x / length))
    for _ in range(2):
        cos, sin = cos_sin(angle)
        left = (y * cos - x * sin) / length
        angle += left + left**3 / 6
    return angle


def direction(angle: float) -> tuple[Decimal, Decimal, Decimal]:
    """An angle as it is meant, its cosine and sine: multiples of 90 degrees are exact, as they are for guides."""
    quarter = angle / (np.pi / 2)
    if quarter != round(quarter):
        exact = Decimal(angle)
        return (exact, *cos_sin(exact))
    cos, sin = ((1, 0), (0, 1), (-1, 0), (0, -1))[round(quarter) % 4]
    return round(quarter) * PI / 2, Decimal(cos), Decimal(sin)


Pair = tuple[Any, Any]
"""An unevaluated sum of two doubles."""


def split(x: Decimal) -> tuple[float, float]:
    """A number as an unevaluated sum of two doubles."""
    with localcontext(prec=DIGITS):
        high = float(x)
        return high, float(x - Decimal(high))


def two_sum(a: Any, b: Any) -> Pair:
    """Sum of two doubles and its rounding error, exactly (D. E. Knuth)."""
    s = a + b
    v = s - a
    return s, (a - (s - v)) + (b - v)


def half(angle: Pair, other: tuple[float, float], sign: int) -> Pair:
    """Half of ``angle`` plus or minus ``other``."""
    s, e = two_sum(sign * angle[0], other[0])
    return s / 2, (e + sign * angle[1] + other[1]) / 2


def sine(angle: Pair) -> Any:
    """Sine of an unevaluated sum."""
    return np.sin(angle[0]) + angle[1] * np.cos(angle[0])


@dataclass(frozen=True)
class Cosine:
    """a + b cos(phi - start) with b > 0, to the last digits also where it vanishes."""

    a: Decimal
    b: Decimal
    start: Decimal

    def __call__(self, phi: Reals) -> Any:
        """Values at crank angles, rad."""
        form, start = _prepared(self)
        return form(_relative_angles(phi, start))

    @property
    def touches(self) -> bool:
        """True where it comes down to zero and no further: its root changes its sign there."""
        with localcontext(prec=DIGITS):
            return abs(self.a - self.b) < SAME * self.b

    def root(self, phi: Reals) -> Pair:
        """Smooth square root at crank angles, rad, and its derivative over them; with a sign, and so over two turns, if it touches.

        Next to a change point, where the crank angle is nothing but its rounding away from it, the root is zero.
        """
        if self.touches:
            with localcontext(prec=DIGITS):
                double, start, pi = float(2 * self.b), split(self.start), split(-PI)
            x = half(_relative_angles(phi, start), pi, 1)
            near = np.abs(np.sin(x[0])) * 2 <= at_rest(phi)
            scale = double**0.5
            return np.where(near, 0.0, scale * sine(x))[()], scale / 2 * np.cos(x[0])
        found = np.sqrt(self(phi))
        return found, self.slope(phi) / (2 * found)

    def slope(self, phi: Reals) -> Reals:
        """Derivative over the crank angle, rad."""
        s, e = _relative_angles(phi, _prepared(self)[1])
        return -float(self.b) * sine((s, e))


@dataclass(frozen=True)
class Gaps:
    """Two gaps ``p`` and ``q`` of a group, p + q the same all round; its half-chord is made of the root of their product.

    Where one of them touches zero both ways of assembly of the group pass through each other, a change point. There the root goes
    on smoothly with the other sign; it keeps to one way, which is the other side behind each change point.
    """

    p: Cosine
    q: Cosine

    @property
    def touching(self) -> tuple[Cosine, ...]:
        """Those that touch zero: each makes one change point a turn."""
        return tuple([c for c in (self.p, self.q) if c.touches])

    @property
    def angles(self) -> tuple[float, ...]:
        """Crank angles of the change points, rad."""
        with localcontext(prec=DIGITS):
            return tuple(float(c.start + PI) for c in self.touching)

    def root(self, phi: Reals) -> Any:
        """Root of the product, smooth through the change points."""
        return self.p.root(phi)[0] * self.q.root(phi)[0]

    def quotient(self, phi: Reals) -> Pair:
        """Derivative of ``q`` over the root of the product, and the derivative of that: finite where both vanish."""
        (p, dp), (q, dq) = self.p.root(phi), self.q.root(phi)
        if len(self.touching) == 2:
            found = np.sign(np.where(np.abs(p) > np.abs(q), dq * p, -dp * q))
            return found, np.zeros(np.shape(found))[()]
        if self.q.touches:
            return 2 * dq / p, -q / (2 * p) - 2 * dq * dp / p**2
        return -2 * dp / q, p / (2 * q) + 2 * dp * dq / q**2

    def branch(self, phi: Reals, side: Signs, at: float, cut: float, sense: float, follow: bool) -> Reals:
        """+1 or -1, by which the smooth root is multiplied so that it is the group's own at crank angles, rad.

        A group that follows is on ``side`` at the crank angle ``at``, or just behind it, and goes on smoothly from there both ways
        as far as ``cut``, a whole turn away. One that keeps its side is that all round; in a change point itself, where it turns
        back at once, it counts as following.
        """
        x = np.asarray(phi, dtype=float)
        start = self.root(at) or self.p.root(at)[1] * self.q.root(at)[0] + self.p.root(at)[0] * self.q.root(at)[1]
        turns = _turns(x, cut, sense) - _turns(at, cut, sense)
        smooth = side * np.sign(start) * (1 if self.root(at) else sense) * np.where(len(self.touching) * turns % 2, -1.0, 1.0)
        if follow:
            return smooth[()]
        root = self.root(x)
        return np.where(root == 0, smooth, side * np.sign(root))[()]


def _turns(phi: Reals, cut: float, sense: float) -> Reals:
    """Whole turns from ``cut`` to crank angles, in the sense of rotation."""
    return np.floor((sense * (np.asarray(phi) - cut) + at_rest(phi)) / (2 * np.pi))


def at_rest(phi: Reals) -> Reals:
    """Angle from a change point that is nothing but the rounding of the crank angle, rad."""
    return 1e-14 + 4 * np.spacing(np.abs(np.asarray(phi, dtype=float)))


def _relative_angles(phi: Reals, start: tuple[float, float]) -> Pair:
    """Crank angles from a start in two doubles."""
    s, e = two_sum(np.asarray(phi, dtype=float), -start[0])
    return s, e - start[1]


@lru_cache(maxsize=256)  # the same few numbers of a mechanism, asked for at one angle after another
def _prepared(c: Cosine) -> tuple[Callable[[Pair], Any], tuple[float, float]]:
    """The factored form over phi - start, and the start: everything that needs many digits."""
    a, b = c.a, c.b
    with localcontext(prec=DIGITS):
        least, most = (Decimal(0) if abs(x) < SAME * b else x for x in (a - b, a + b))
        twice, pi, start = float(2 * b), split(PI), split(c.start)
        if least >= 0:
            base = float(least)
            return lambda x: base + twice * sine(half(x, pi, -1)) ** 2, start
        if most <= 0:
            top = float(most)
            return lambda x: top - twice * sine((x[0] / 2, x[1] / 2)) ** 2, start
        cos = -a / b
        zero = split(angle_of(cos, (1 - cos * cos).sqrt()))
        return lambda x: twice * sine(half(x, zero, 1)) * sine(half(x, zero, -1)), start
