"""Half-chords of the crossings that a group on the crank makes, exact up to its dead positions.

The half-chord of two arcs, or of an arc and a line, vanishes in a dead position, and so does a tangent. Taken from the rounded
crank pin it loses as many digits as the gap is small; taken from the crank angle it loses none, and the sine of the angle under
which the lines of the velocity and acceleration plans cross follows from it. Only a group between the crank and the frame has
such a form.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal, localcontext
from functools import lru_cache
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.limit_angles import DIGITS, PI, Cosine, angle_of, direction
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup

Numbers = tuple[Rule, tuple[Any, ...]]
"""A rule and the numbers of the mechanism it takes besides the crank angle."""


def measured(g: StructuralGroup, phi: Any, half: Numbers, distance: Numbers | None = None) -> tuple[Step, Step | None]:
    """Half-chord of a group's crossing and distance of its centres as steps, from the crank angle and numbers of the mechanism."""
    h = Step(f"h {g.name}", half[0], (phi, *half[1]))
    return h, None if distance is None else Step(f"d {g.name}", distance[0], (phi, *distance[1]))


@dataclass(frozen=True)
class Crossing:
    """What the crank angle knows of the crossing of a group, as steps: half of the chord (or the tangent's length), the distance
    of the centres (none for a line), the sine between the group's lines in the plans of velocities.
    """

    half: Step
    distance: Step | None
    sine: Step

    @property
    def lengths(self) -> tuple[Step, ...]:
        """Further arguments of the rule that makes the crossing."""
        return (self.half,) if self.distance is None else (self.half, self.distance)


def on_crank(m: Mechanism, point: str) -> tuple[float, float] | None:
    """Radius of a point on the crank, m, and its angle ahead of the crank, rad; None when it is elsewhere."""
    c = m.crank
    if point == c.pin:
        return c.length, 0.0
    for p in m.points:
        if p.name == point and p.link == c.link and p.start == c.pivot and p.towards == c.pin and p.distance > 0:
            return p.distance, p.angle
    return None


Span = tuple[float, float, complex, complex]
"""Radius of a point on the crank and its angle ahead of the crank, the crank's pivot, a fixed hinge: m and rad."""


def span_from_crank(m: Mechanism, g: StructuralGroup) -> Span | None:
    """What the distance of a group's outer hinges follows from, one of them on the crank, one fixed."""
    p, q = g.outer
    pin = on_crank(m, p) or on_crank(m, q)
    fixed, pivot = m.fixed.get(q if on_crank(m, p) else p), m.fixed[m.crank.pivot]
    if pin is None or fixed is None or fixed == pivot:
        return None  # a hinge on the crank's own pivot: nothing moves against the crank
    return *pin, pivot, fixed


@lru_cache(maxsize=256)
def _less(span: Span, plus: float, minus: float = 0.0) -> Cosine:
    """Square of a sum of lengths less the square of the distance d of the hinges.

    d^2 = l0^2 + l1^2 - 2 l0 l1 cos(phi - phi0).
    """
    with localcontext(prec=DIGITS):
        l1, ahead, length = Decimal(span[0]), direction(span[1])[0], Decimal(plus) + Decimal(minus)
        x, y = (Decimal(b) - Decimal(a) for a, b in ((span[2].real, span[3].real), (span[2].imag, span[3].imag)))
        square = x * x + y * y
        return Cosine(-square - l1 * l1 + length * length, 2 * l1 * square.sqrt(), angle_of(x, y) - ahead)


@lru_cache(maxsize=256)
def _beside(l1: float, ahead: float, length: float, pivot: complex, through: complex, guide: float) -> tuple[Cosine, Cosine]:
    """Length of a rod plus and minus the distance of its pin on the crank from a guide, e = e0 + l1 sin(phi - psi)."""
    with localcontext(prec=DIGITS):
        radius, rod = Decimal(l1), Decimal(length)
        e0, start = height(pivot, through, guide)[0], direction(guide)[0] - direction(ahead)[0]
        return Cosine(rod + e0, radius, start + PI / 2), Cosine(rod - e0, radius, start - PI / 2)


@primitive("half-chord of two arcs")
def half_of_arcs(phi: Any, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float, l3: float) -> Any:
    """sqrt(((l2 + l3)^2 - d^2) (d^2 - (l2 - l3)^2)) / 2d at crank angles, d as in :func:`pin_distance`."""
    span = (l1, ahead, pivot, fixed)
    return np.sqrt(_less(span, l2, l3)(phi) * _less(span, l2, -l3)(phi) / _less(span, 0.0)(phi)) / 2


@primitive("distance from the crank's point")
def pin_distance(phi: Any, l1: float, ahead: float, pivot: complex, fixed: complex) -> Any:
    """Distance d of a fixed hinge from a point on the crank, ``l1`` from its pivot and ``ahead`` of it."""
    return np.sqrt(-_less((l1, ahead, pivot, fixed), 0.0)(phi))


@primitive("tangent from the crank's point")
def tangent_length(phi: Any, l1: float, ahead: float, pivot: complex, fixed: complex, radius: float) -> Any:
    """sqrt(d^2 - radius^2): length of the tangent from a point on the crank to a circle about a fixed hinge."""
    return np.sqrt(-_less((l1, ahead, pivot, fixed), radius)(phi))


@primitive("half-chord of arc and line")
def half_of_line(phi: Any, l1: float, ahead: float, length: float, pivot: complex, through: complex, guide: float) -> Any:
    """sqrt((length - e) (length + e)), e the distance of a point on the crank from a guide."""
    below, above = _beside(l1, ahead, length, pivot, through, guide)
    return np.sqrt(below(phi) * above(phi))


def _of_angle(name: str, compute: Callable[..., Any]) -> Rule:
    return Rule(name, compute, (), "length", "{name} = {value}.", beyond_paper=True, unit="m")


HALF_OF_ARCS = _of_angle("half-chord of two arcs from the crank angle", half_of_arcs)
DISTANCE = _of_angle("distance from the crank angle", pin_distance)
TANGENT = _of_angle("tangent from the crank angle", tangent_length)
HALF_OF_LINE = _of_angle("half-chord of arc and line from the crank angle", half_of_line)


def height(at: complex, through: complex, guide: float) -> tuple[Decimal, Decimal, Decimal]:
    """Distance of a point from a fixed guide, positive on its left, and the guide's direction."""
    _, cos, sin = direction(guide)
    x, y = Decimal(at.real) - Decimal(through.real), Decimal(at.imag) - Decimal(through.imag)
    return cos * y - sin * x, cos, sin


@primitive("foot on a guide")
def foot_on_guide(at: complex, through: complex, guide: float) -> complex:
    """Foot of the perpendicular from a point on a fixed guide: the nearest double to it, however far away the guide's own point."""
    with localcontext(prec=DIGITS):
        above, cos, sin = height(at, through, guide)
        return complex(float(Decimal(at.real) + above * sin), float(Decimal(at.imag) - above * cos))
