"""Dead positions of a group on the crank, and half-chords of the crossings it makes, exact up to them.

The half-chord of two arcs, or of an arc and a line, vanishes in a dead position, and so does a tangent. Taken from the rounded
crank pin it loses as many digits as the gap is small; taken from the crank angle it loses none, and the sine of the angle under
which the lines of the velocity and acceleration plans cross follows from it. Only a group between the crank and the frame has
such a form.

Change points: a group is stretched or folded for a moment, and both of its ways of assembly pass through each other there.

Lines of the plans that tell its motion fall together in a change point, and what they would tell is nothing divided by nothing.
The crank angle tells it: the half-chord of the group is the smooth root of two gaps
(:class:`~tmm_sheets.construction.limit_angles.Gaps`) times +1 or -1, its branch, and so are the rates at which its links turn. At
every crank angle they are as exact as the lengths, also in the change point and next to it. Only a group between the crank and the
frame has such a form; those that hang on others are told of by :mod:`tmm_sheets.methods.linkage.positions`.
"""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, localcontext
from functools import lru_cache
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Directions, Points, Reals, Signs, primitive
from tmm_sheets.construction.limit_angles import DIGITS, PI, Cosine, Gaps, angle_of, direction
from tmm_sheets.construction.step import Plan, Rule, Step
from tmm_sheets.mechanism.groups.contexts import Turning
from tmm_sheets.mechanism.model import Guide, Mechanism, StructuralGroup
from tmm_sheets.words import marked

MEANT = Decimal("1e-15")
"""Share of the sizes by which two lengths differ that are written down as the same: decimals are rounded to doubles."""

def on_crank(m: Mechanism, point: str) -> tuple[float, float] | None:
    """Radius of a point on the crank, m, and its angle ahead of the crank, rad; None when the point is elsewhere."""
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
def gap_of_arcs(span: Span, plus: float, minus: float = 0.0) -> Cosine:
    """Square of a sum of lengths less the square of the distance d of the hinges.

    d^2 = l0^2 + l1^2 - 2 l0 l1 cos(phi - phi0).
    """
    with localcontext(prec=DIGITS):
        l1, ahead, length = Decimal(span[0]), direction(span[1])[0], Decimal(plus) + Decimal(minus)
        x, y = (Decimal(b) - Decimal(a) for a, b in ((span[2].real, span[3].real), (span[2].imag, span[3].imag)))
        square = x * x + y * y
        apart = square.sqrt()
        if minus:
            length = alike(abs(length), l1 + apart if minus > 0 else abs(l1 - apart),
                           l1 + apart + abs(Decimal(plus)) + abs(Decimal(minus)) + _manhattan(span[2]) + _manhattan(span[3]))
        return Cosine(-square - l1 * l1 + length * length, 2 * l1 * apart, angle_of(x, y) - ahead)


def alike(length: Decimal, other: Decimal, size: Decimal) -> Decimal:
    """The ``other`` length where both are the same up to the rounding of the numbers of that ``size``: a change point is meant."""
    return other if abs(length - other) <= MEANT * size else length


def _manhattan(point: complex) -> Decimal:
    return abs(Decimal(point.real)) + abs(Decimal(point.imag))


@lru_cache(maxsize=256)
def gaps_of_line(l1: float, ahead: float, length: float, pivot: complex, through: complex, guide: float) -> Gaps:
    """Length of a rod plus and minus the distance of its pin on the crank from a guide, e = e0 + l1 sin(phi - psi)."""
    with localcontext(prec=DIGITS):
        radius, rod = Decimal(l1), Decimal(length)
        e0, start = height(pivot, through, guide)[0], direction(guide)[0] - direction(ahead)[0]
        size = radius + rod + abs(e0) + _manhattan(pivot)
        below, above = (alike(rod + sign * e0, radius, size) for sign in (1, -1))
        return Gaps(Cosine(below, radius, start + PI / 2), Cosine(above, radius, start - PI / 2))


@lru_cache(maxsize=256)
def gaps_of_arcs(l1: float, ahead: float, pivot: complex, fixed: complex, l2: float, l3: float) -> Gaps:
    """(l2 + l3)^2 - d^2 and d^2 - (l2 - l3)^2, whose product is the square of twice the distance d times the half-chord."""
    p, q = (gap_of_arcs((l1, ahead, pivot, fixed), l2, other) for other in (l3, -l3))
    with localcontext(prec=DIGITS):
        return Gaps(p, Cosine(-q.a, q.b, q.start + PI))


@primitive("half-chord of two arcs", "real")
def half_of_arcs(phi: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float, l3: float) -> Reals:
    """sqrt(((l2 + l3)^2 - d^2) (d^2 - (l2 - l3)^2)) / 2d at crank angles, d as in :func:`pin_distance`."""
    span = (l1, ahead, pivot, fixed)
    gaps = gaps_of_arcs(*span, l2, l3)
    if meets(span, gaps, l2, l3):
        return np.abs(gaps.p.root(phi)[0]) / 2
    if gaps.touching:
        return np.abs(gaps.root(phi)) / pin_distance(phi, *span) / 2
    return np.sqrt(gap_of_arcs(span, l2, l3)(phi) * gap_of_arcs(span, l2, -l3)(phi) / gap_of_arcs(span, 0.0)(phi)) / 2


def meets(span: Span, gaps: Gaps, l2: float, l3: float) -> bool:
    """True where the crank's point passes through the fixed hinge, and rods of one length hang on them: d^2 is a gap itself."""
    return gaps.q.touches and abs(l2 - l3) <= float(MEANT) * (l2 + l3 + abs(span[2]) + abs(span[3]))


@primitive("distance from the crank's point", "real")
def pin_distance(phi: Reals, l1: float, ahead: float, pivot: complex, fixed: complex) -> Reals:
    """Distance d of a fixed hinge from a point on the crank, ``l1`` from its pivot and ``ahead`` of it."""
    return np.sqrt(-gap_of_arcs((l1, ahead, pivot, fixed), 0.0)(phi))


@primitive("tangent from the crank's point", "real")
def tangent_length(phi: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, radius: float) -> Reals:
    """sqrt(d^2 - radius^2): length of the tangent from a point on the crank to a circle about a fixed hinge."""
    return np.sqrt(-gap_of_arcs((l1, ahead, pivot, fixed), radius)(phi))


@primitive("half-chord of arc and line", "real")
def half_of_line(phi: Reals, l1: float, ahead: float, length: float, pivot: complex, through: complex, guide: float) -> Reals:
    """sqrt((length - e) (length + e)), e the distance of a point on the crank from a guide."""
    gaps = gaps_of_line(l1, ahead, length, pivot, through, guide)
    return np.abs(gaps.root(phi)) if gaps.touching else np.sqrt(gaps.p(phi) * gaps.q(phi))


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


AWAY = 4.0
"""So many times the mechanism's size away a guide's own point is not drawn."""


NEAREST = Rule("nearest point of a guide", foot_on_guide, ("point", "point", "angle"), "point", marked("Mark point {name}."))


def near_point(m: Mechanism, guide: Guide) -> tuple[Any, ...]:
    """A point of a fixed guide to draw it through: its own, or the one nearest to the crank's pivot when its own is far away.

    It is the rule that gives the point, and the numbers it takes.

    A direction is known to 1e-16 rad: about a point a thousand lengths away that shifts the guide by 1e-13 of a length, which the
    half-chords taken from the crank angle do not share. The nearest point comes from the numbers of the guide as they are given.
    """
    pivot = m.fixed[m.crank.pivot]
    from_foot = (guide.at - pivot) / ar.unit(guide.direction)
    fixed = max(abs(z - pivot) for z in m.fixed.values())
    size = m.crank.length + sum(sum(g.lengths) for g in m.groups) + fixed + abs(from_foot.imag)
    if abs(from_foot.real) <= AWAY * size:
        return rules.GIVEN, guide.through
    return NEAREST, pivot, guide.through, guide.direction


PIN_ANGLE = Rule("angle of a dead position", lambda centre, pin: np.arctan2((pin - centre).imag, (pin - centre).real),
                 ("point", "point"), "angle", marked("Angle of the crank in the dead position {1} {name} = {value}."), unit="rad",
                 exact=True)


def _in_line(centre: Points, end: Any, fold: Any, crank: Any) -> Any:
    v = fold * (end - centre) / np.abs(end - centre) * crank
    return np.arctan2(v.imag, v.real)


IN_LINE_ANGLE = Rule("angle of a crank in line with the rod", _in_line, ("point", "point", "number", "length"), "angle",
                     marked("The crank is in line with the coupler whose end is at {1}: angle {name} = {value}."), unit="rad",
                 exact=True)
REACH = Rule("reach of crank and rod in line", lambda rod, crank, sign: np.abs(rod + sign * crank), ("length", "length", "number"),
             "length", "{name} = {value}.")


def reaches(plan: Plan, rod: float, crank: float) -> tuple[tuple[str, Step], ...]:
    """How far from the crank pivot the rod ends, with crank and rod stretched and folded, with the prime of each."""
    return tuple((prime, plan.auxiliary(f"r{prime}", REACH, rod, crank, sign)) for prime, sign in (("′", 1.0), ("″", -1.0)))


def fold_and_stretch(m: Mechanism, plan: Plan, rod: float, centre: Step, ends: tuple[Step, Step]) -> tuple[Step, Step] | None:
    """Crank angles, rad, with crank and rod in line; ``ends`` are where the rod ends, rod + crank and |rod - crank| from the pivot.

    None where the rod's end cannot come there, or comes to the pivot itself.
    """
    far, near = (complex(e.value - centre.value) for e in ends)
    if np.isnan(far) or np.isnan(near) or not abs(far) or not abs(near):
        return None
    length = m.crank.length
    return (plan.auxiliary("φ′", IN_LINE_ANGLE, centre, ends[0], 1.0, length),
            plan.auxiliary("φ″", IN_LINE_ANGLE, centre, ends[1], -1.0 if rod > length else 1.0, length))


def _rule(name: str, compute: Any, unit: str = "1", *, beyond_paper: bool = True) -> Rule:
    return Rule(name, compute, ("angle",), "number", "{name} = {value}.", beyond_paper=beyond_paper, exact=not beyond_paper,
                unit=unit)


def _side(gaps: Gaps, phi: Reals, branch: Reals, alone: bool) -> Reals:
    root = gaps.p.root(phi)[0] if alone else gaps.root(phi)
    return branch * np.where(root < 0, -1.0, 1.0)[()]


# --- two arcs -----------------------------------------------------------------------------------------------------------


@primitive("branch of two arcs", "real")
def branch_of_arcs(phi: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float, l3: float, side: Signs,
                   at: float, cut: float, sense: float, follow: float) -> Reals:
    """+1 or -1 by which the smooth root of the gaps is multiplied; on ``side`` at the angle ``at``, all round if follow is 0."""
    return gaps_of_arcs(l1, ahead, pivot, fixed, l2, l3).branch(phi, side, at, cut, sense, bool(follow))


@primitive("side of a branch of two arcs", "real")
def side_of_arcs(phi: Reals, branch: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float, l3: float) -> Reals:
    """On which side of the line of centres the arcs cross, +1 left."""
    gaps = gaps_of_arcs(l1, ahead, pivot, fixed, l2, l3)
    return _side(gaps, phi, branch, meets((l1, ahead, pivot, fixed), gaps, l2, l3))


@primitive("signed distance from the crank's point", "real")
def signed_distance(phi: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float, l3: float) -> Reals:
    """Distance of a fixed hinge that the crank's point passes through, with another sign behind it."""
    return gaps_of_arcs(l1, ahead, pivot, fixed, l2, l3).q.root(phi)[0]


@primitive("line from the crank's point")
def line_of_centres(phi: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, sign: float) -> Directions:
    """Direction from a point on the crank to such a hinge, or from there (sign -1); it goes on smoothly through it."""
    return sign * 1j * np.exp(0.5j * (np.asarray(phi) + ahead + np.angle(fixed - pivot)))


@primitive("turning of a rod on two arcs", "real")
def turning_of_arcs(phi: Reals, branch: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float,
                    l3: float) -> Reals:
    """Angle that the first link turns by an angle of the crank, at crank angles, rad."""
    return _of_arcs(phi, branch, l1, ahead, pivot, fixed, l2, l3)[0]


@primitive("second turning of a rod on two arcs", "real")
def second_of_arcs(phi: Reals, branch: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float,
                   l3: float) -> Reals:
    """Derivative of :func:`turning_of_arcs` over the crank angle, 1/rad."""
    return _of_arcs(phi, branch, l1, ahead, pivot, fixed, l2, l3)[1]


def _of_arcs(phi: Reals, branch: Reals, l1: float, ahead: float, pivot: complex, fixed: complex, l2: float,
             l3: float) -> tuple[Any, Any]:
    """The line of centres turns by 1/2 + (l1^2 - l0^2) / 2d^2, and the rod against it by -(d^2)' / 2s (1 + (l3^2 - l2^2) / d^2).

    s is twice the distance d times the half-chord, with its sign.
    """
    gaps = gaps_of_arcs(l1, ahead, pivot, fixed, l2, l3)
    quotient, second = (branch * x for x in gaps.quotient(phi))
    if meets((l1, ahead, pivot, fixed), gaps, l2, l3):
        return 0.5 - quotient / 2, -second / 2
    # Differences of squares: crank and frame, rod and rod; nothing where both are meant to be the same.
    l0 = abs(fixed - pivot)
    one, two = (l1 - l0) * (l1 + l0), (l3 - l2) * (l3 + l2)
    square = gaps.q(phi) + (l2 - l3) ** 2
    slope = gaps.q.slope(phi) / square**2
    return (0.5 + one / (2 * square) - quotient / 2 * (1 + two / square),
            -one / 2 * slope - second / 2 * (1 + two / square) + quotient / 2 * two * slope)


# --- arc and line -------------------------------------------------------------------------------------------------------


@primitive("branch of arc and line", "real")
def branch_of_line(phi: Reals, l1: float, ahead: float, length: float, pivot: complex, through: complex, guide: float, side: Signs,
                   at: float, cut: float, sense: float, follow: float) -> Any:
    """What the branch of two arcs is, for a rod on a guide."""
    return gaps_of_line(l1, ahead, length, pivot, through, guide).branch(phi, side, at, cut, sense, bool(follow))


@primitive("side of a branch of arc and line", "real")
def side_of_line(phi: Reals, branch: Reals, l1: float, ahead: float, length: float, pivot: complex, through: complex,
                 guide: float) -> Reals:
    """Which of both crossings of arc and line it is, +1 further along the guide."""
    return _side(gaps_of_line(l1, ahead, length, pivot, through, guide), phi, branch, alone=False)


@primitive("turning of a rod on a guide", "real")
def turning_of_line(phi: Reals, branch: Reals, l1: float, ahead: float, length: float, pivot: complex, through: complex,
                    guide: float) -> Reals:
    """Angle that the rod turns by an angle of the crank, at crank angles, rad: -e' over the half-chord, e the pin's distance."""
    return branch * gaps_of_line(l1, ahead, length, pivot, through, guide).quotient(phi)[0]


@primitive("second turning of a rod on a guide", "real")
def second_of_line(phi: Reals, branch: Reals, l1: float, ahead: float, length: float, pivot: complex, through: complex,
                   guide: float) -> Reals:
    """Derivative of :func:`turning_of_line` over the crank angle, 1/rad."""
    return branch * gaps_of_line(l1, ahead, length, pivot, through, guide).quotient(phi)[1]


# --- steps --------------------------------------------------------------------------------------------------------------

SIGNED_DISTANCE = _rule("signed distance from the crank angle", signed_distance, "m")
LINE_OF_CENTRES = Rule("line of centres from the crank angle", line_of_centres, ("angle",), "direction", "{name} = {value}.",
                       beyond_paper=True, unit="1")
ARCS = tuple(_rule(name, compute, beyond_paper=beyond) for name, compute, beyond in (
    ("branch of two arcs from the crank angle", branch_of_arcs, False), ("side of the branch of two arcs", side_of_arcs, False),
    ("turning of a rod on two arcs from the crank angle", turning_of_arcs, True),
    ("second turning of a rod on two arcs from the crank angle", second_of_arcs, True)))
LINE = tuple(_rule(name, compute, beyond_paper=beyond) for name, compute, beyond in (
    ("branch of arc and line from the crank angle", branch_of_line, False),
    ("side of the branch of arc and line", side_of_line, False),
    ("turning of a rod on a guide from the crank angle", turning_of_line, True),
    ("second turning of a rod on a guide from the crank angle", second_of_line, True)))
"""Rules of the branch, its side, and the turning of the first link with its derivative."""


def passing(m: Mechanism, g: StructuralGroup, phi: Any, rules: tuple[Rule, ...], numbers: tuple[Any, ...], *,
            turned: bool = False) -> Turning:
    """Side and turning of a group with change points as steps on crank angles ``phi``, rad, shape (n,).

    The side of one that keeps it is the given one, but for that of a line of centres which turns over (``turned``).
    """
    branch_rule, side_rule, first, second = rules
    cut = g.at if g.cut is None else g.cut
    branch = Step(f"± {g.name}", branch_rule, (phi, *numbers, g.side, g.at, cut, m.crank.sense, float(g.follow)))
    one, two = (Step(f"{name} {g.name}", rule, (phi, branch, *numbers)) for name, rule in (("φ'", first), ("φ''", second)))
    if not g.follow and not turned:
        return Turning(g.side, one, two, (branch, one, two))
    side = Step(f"side {g.name}", side_rule, (phi, branch, *numbers))
    return Turning(side, one, two, (branch, side, one, two))


# --- groups that hang on others -----------------------------------------------------------------------------------------


@primitive("half-chord beside a change point of two arcs", "real")
def half_beside_arcs(root: Reals, p: Points, r1: Reals, q: Points, r2: Reals) -> Reals:
    """Half-chord of two arcs from the root of their gaps, from the points where it is NaN; not known if it is infinite."""
    d = np.abs(q - p)
    return np.where(np.isnan(root), ar.half_chord(d, r1, r2), np.where(np.isinf(root), np.nan, np.abs(root) / (2 * d)))


@primitive("half-chord beside a change point of arc and line", "real")
def half_beside_line(root: Reals, centre: Points, radius: Reals, p: Points, u: Directions) -> Reals:
    """Half-chord of arc and line by the same."""
    height = ar.cross(u, p - centre)
    return np.where(np.isnan(root), np.sqrt((radius - height) * (radius + height)), np.where(np.isinf(root), np.nan, np.abs(root)))


HALF_BESIDE_ARCS = Rule("half-chord of two arcs beside a change point", half_beside_arcs,
                        ("number", "point", "length", "point", "length"), "length", "{name} = {value}.", beyond_paper=True,
                        unit="m")
HALF_BESIDE_LINE = Rule("half-chord of arc and line beside a change point", half_beside_line,
                        ("number", "point", "length", "point", "direction"), "length", "{name} = {value}.", beyond_paper=True,
                        unit="m")
