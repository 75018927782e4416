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
from typing import Any

import numpy as np

from tmm_sheets.construction.limit_angles import DIGITS, PI, Cosine, angle_of, direction
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.model import Guide, Mechanism, StructuralGroup

OF_ANGLE = Rule("length from the crank angle", lambda f, phi: f(phi), (), "length", "{name} = {value}.", beyond_paper=True)
SINE_ARCS = Rule("sine between links", lambda h, d, r1, r2, side: side * h * d / (r1 * r2), (), "number",
                 "Синус угла между звеньями {name} = {value}.")
SINE_LINE = Rule("sine between rod and perpendicular to the guide", lambda h, r, side: -side * h / r, (), "number",
                 "Синус угла между шатуном и перпендикуляром к направляющей {name} = {value}.")
SINE_SLOT = Rule("sine between slot and perpendicular to the line of pivots", lambda h, d: h / d, (), "number",
                 "Синус угла между пазом и перпендикуляром к линии шарниров {name} = {value}.")

Length = Callable[[Any], Any]
"""A length of the mechanism at crank angles, rad."""


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


def crossing(m: Mechanism, g: StructuralGroup, phi: Any) -> Crossing | None:
    """Crossing of a group of kind 1, 2 or 3 between crank and frame; None where no such form exists."""
    with localcontext(prec=DIGITS):
        found = LENGTHS[g.kind.number](m, g)
    if found is None:
        return None
    half, distance = (None if f is None else Step(name, OF_ANGLE, (f, phi))
                      for name, f in zip((f"h {g.name}", f"d {g.name}"), found, strict=True))
    assert half is not None
    name = f"sin {g.name}"
    if g.kind.number == 1:
        return Crossing(half, distance, Step(name, SINE_ARCS, (half, distance, *g.lengths, g.side)))
    if g.kind.number == 2:
        return Crossing(half, None, Step(name, SINE_LINE, (half, g.lengths[0], g.side)))
    return Crossing(half, distance, Step(name, SINE_SLOT, (half, distance)))


def _on_crank(m: Mechanism, point: str) -> tuple[Decimal, Decimal] | None:
    """Radius of a point on the crank and its angle ahead of the crank; None when it is elsewhere."""
    c = m.crank
    if point == c.pin:
        return Decimal(c.length), Decimal(0)
    for p in m.points:
        if p.name == point and p.link == c.link and p.start == c.pivot and p.towards == c.pin and p.distance > 0:
            return Decimal(p.distance), direction(p.angle)[0]
    return None


def _span(m: Mechanism, g: StructuralGroup) -> Callable[[Decimal], Cosine] | None:
    """Square of a length less the square of the distance between the group's outer hinges, one of them on the crank, one fixed.

    d^2 = l0^2 + l1^2 - 2 l0 l1 cos(phi - phi0).
    """
    p, q = g.outer
    pin = _on_crank(m, p) or _on_crank(m, q)
    fixed = m.fixed.get(q if _on_crank(m, p) else p)
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


def _arcs(m: Mechanism, g: StructuralGroup) -> tuple[Length, Length] | None:
    """RRR: h = sqrt(((l2 + l3)^2 - d^2) (d^2 - (l2 - l3)^2)) / 2d."""
    span = _span(m, g)
    if span is None:
        return None
    l2, l3 = (Decimal(x) for x in g.lengths)
    outer, inner, none = span(l2 + l3), span(l2 - l3), span(Decimal(0))
    return lambda phi: np.sqrt(outer(phi) * inner(phi) / none(phi)) / 2, lambda phi: np.sqrt(-none(phi))


def _slot(m: Mechanism, g: StructuralGroup) -> tuple[Length, Length] | None:
    """RPR with an offset e: tangent's length sqrt(d^2 - e^2)."""
    span = _span(m, g) if g.offset else None
    if span is None:
        return None
    tangent, none = span(Decimal(g.offset)), span(Decimal(0))
    return lambda phi: np.sqrt(-tangent(phi)), lambda phi: np.sqrt(-none(phi))


def _line(m: Mechanism, g: StructuralGroup) -> tuple[Length, None] | None:
    """RRP: h = sqrt((l - e) (l + e)) with the pin's distance from the guide e = e0 + l1 sin(phi - psi)."""
    guide, pin = m.guides[g.guides[0]], _on_crank(m, g.outer[0])
    if pin is None or isinstance(guide.through, str):
        return None
    (l1, ahead), length = pin, Decimal(g.lengths[0])
    e0 = _height(m.fixed[m.crank.pivot], guide)[0]
    start = direction(guide.direction)[0] - ahead
    below, above = Cosine(length + e0, l1, start + PI / 2), Cosine(length - e0, l1, start - PI / 2)
    return lambda phi: np.sqrt(below(phi) * above(phi)), None


def _height(at: complex, guide: Guide) -> tuple[Decimal, Decimal, Decimal]:
    """Distance of a point from a fixed guide, positive on its left, and the guide's direction."""
    assert not isinstance(guide.through, str)
    _, cos, sin = direction(guide.direction)
    x, y = Decimal(at.real) - Decimal(guide.through.real), Decimal(at.imag) - Decimal(guide.through.imag)
    return cos * y - sin * x, cos, sin


def foot_on_guide(at: complex, guide: Guide) -> complex:
    """Foot of the perpendicular from a point on a fixed guide: the nearest double to it, however far away the guide's own point."""
    with localcontext(prec=DIGITS):
        height, cos, sin = _height(at, guide)
        return complex(float(Decimal(at.real) + height * sin), float(Decimal(at.imag) - height * cos))


LENGTHS: dict[int, Callable[[Mechanism, StructuralGroup], tuple[Length, Length | None] | None]] = {1: _arcs, 2: _line, 3: _slot}
"""Half-chord and distance of the centres for each kind of group that has them."""
