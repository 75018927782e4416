"""Dead positions of a group on the crank, and half-chords of the crossings it makes, exact up to them.

The half-chord of two arcs, or of an arc and a line, vanishes in a dead position, and so does a tangent. Taken from the rounded
crank pin it loses as many digits as the gap is small; taken from the crank angle it loses none, and the sine of the angle under
which the lines of the velocity and acceleration plans cross follows from it. Only a group between the crank and the frame has
such a form.
"""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, localcontext
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.limit_angles import DIGITS, Cosine, angle_of, direction
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.model import Guide, Mechanism, StructuralGroup

Length = Callable[[Any], Any]
"""A length of the mechanism at crank angles, rad."""

OF_ANGLE = Rule("length from the crank angle", lambda f, phi: f(phi), (), "length", "{name} = {value}.", beyond_paper=True)


def measured(g: StructuralGroup, phi: Any, half: Length, distance: Length | None = None) -> tuple[Step, Step | None]:
    """Half-chord of a group's crossing and distance of its centres, m, as steps at crank angles ``phi``, rad, shape (n,)."""
    h = Step(f"h {g.name}", OF_ANGLE, (half, phi))
    return h, None if distance is None else Step(f"d {g.name}", OF_ANGLE, (distance, phi))


def on_crank(m: Mechanism, point: str) -> tuple[Decimal, Decimal] | None:
    """Radius of a point on the crank, m, and its angle ahead of the crank, rad; None when the point is elsewhere."""
    c = m.crank
    if point == c.pin:
        return Decimal(c.length), Decimal(0)
    for p in m.points:
        if p.name == point and p.link == c.link and p.start == c.pivot and p.towards == c.pin and p.distance > 0:
            return Decimal(p.distance), direction(p.angle)[0]
    return None


def span_from_crank(m: Mechanism, g: StructuralGroup) -> Callable[[Decimal], Cosine] | None:
    """Square of a length less that of the distance of the group's outer hinges, one of them on the crank, one fixed; m2.

    d^2 = l0^2 + l1^2 - 2 l0 l1 cos(phi - phi0).
    """
    p, q = g.outer
    pin = on_crank(m, p) or on_crank(m, q)
    fixed = m.fixed.get(q if on_crank(m, p) else p)
    if pin is None or fixed is None:
        return None
    l1, ahead = pin
    pivot = m.fixed[m.crank.pivot]
    x, y = Decimal(fixed.real) - Decimal(pivot.real), Decimal(fixed.imag) - Decimal(pivot.imag)
    square = x * x + y * y
    if not square:
        return None  # a hinge on the crank's own pivot: nothing moves against the crank
    start, b = angle_of(x, y) - ahead, 2 * l1 * square.sqrt()
    base = -square - l1 * l1
    return lambda length: Cosine(base + length * length, b, start)


def height(at: complex, guide: Guide) -> tuple[Decimal, Decimal, Decimal]:
    """Distance of a point from a fixed guide, m, positive on its left, and cosine and sine of the guide's direction."""
    assert not isinstance(guide.through, str)
    _, cos, sin = direction(guide.direction)
    x, y = Decimal(at.real) - Decimal(guide.through.real), Decimal(at.imag) - Decimal(guide.through.imag)
    return cos * y - sin * x, cos, sin


def foot_on_guide(at: complex, guide: Guide) -> complex:
    """Foot of the perpendicular from a point on a fixed guide: the double nearest to it, however far the guide's own point."""
    with localcontext(prec=DIGITS):
        above, cos, sin = height(at, guide)
        return complex(float(Decimal(at.real) + above * sin), float(Decimal(at.imag) - above * cos))


AWAY = 4.0
"""So many times the mechanism's size away a guide's own point is not drawn."""


def near_point(m: Mechanism, guide: Guide) -> complex:
    """A point of a fixed guide to draw it through: its own, or the one nearest to the crank's pivot when its own is far away.

    A direction is known to 1e-16 rad: about a point a thousand lengths away that shifts the guide by 1e-13 of a length, which the
    half-chords taken from the crank angle do not share. The nearest point comes from the numbers of the guide as they are given.
    """
    assert not isinstance(guide.through, str)
    pivot = m.fixed[m.crank.pivot]
    from_foot = (guide.through - pivot) / ar.unit(guide.direction)
    fixed = max(abs(z - pivot) for z in m.fixed.values())
    size = m.crank.length + sum(sum(g.lengths) for g in m.groups) + fixed + abs(from_foot.imag)
    return guide.through if abs(from_foot.real) <= AWAY * size else foot_on_guide(pivot, guide)


def fold_and_stretch(m: Mechanism, rod: float, centre: Step, ends: tuple[Step, Step]) -> tuple[complex, complex] | None:
    """Crank vectors, m, with crank and rod in line; ``ends`` are where the rod ends, rod + crank and |rod - crank| from the pivot.

    None where the rod's end cannot come there, or comes to the pivot itself.
    """
    far, near = (complex(e.value - centre.value) for e in ends)
    if np.isnan(far) or np.isnan(near) or not abs(far) or not abs(near):
        return None
    length = m.crank.length
    fold = -1 if rod > length else 1
    return far / abs(far) * length, fold * near / abs(near) * length
