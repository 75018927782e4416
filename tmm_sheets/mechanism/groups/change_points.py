"""Change points: a group is stretched or folded for a moment, and both of its ways of assembly pass through each other there.

Lines of the plans that tell its motion fall together in a change point, and what they would tell is nothing divided by nothing.
The crank angle tells it: the half-chord of the group is the smooth root of two gaps
(:class:`~tmm_sheets.construction.limit_angles.Gaps`) times +1 or -1, its branch, and so are the rates at which its links turn. At
every crank angle they are as exact as the lengths, also in the change point and next to it. Only a group between the crank and the
frame has such a form; those that hang on others are told of by :mod:`tmm_sheets.methods.linkage.passages`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.limit_angles import Gaps
from tmm_sheets.construction.quantities import Directions, Points, Reals, Signs
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.groups.dead_centres import gaps_of_arcs, gaps_of_line, meets
from tmm_sheets.mechanism.groups.hints import Turning
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup


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


def _squares(l1: float, pivot: complex, fixed: complex, l2: float, l3: float) -> tuple[float, float]:
    """Differences of the squares of the lengths: crank and frame, rod and rod; nothing where both are meant to be the same."""
    l0 = abs(fixed - pivot)
    return (l1 - l0) * (l1 + l0), (l3 - l2) * (l3 + l2)


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
    one, two = _squares(l1, pivot, fixed, l2, l3)
    square = gaps.q(phi) + (l2 - l3) ** 2
    slope = gaps.q.slope(phi) / square**2
    return (0.5 + one / (2 * square) - quotient / 2 * (1 + two / square),
            -one / 2 * slope - second / 2 * (1 + two / square) + quotient / 2 * two * slope)


# --- arc and line -------------------------------------------------------------------------------------------------------


@primitive("branch of arc and line", "real")
def branch_of_line(phi: Reals, l1: float, ahead: float, length: float, pivot: complex, through: complex, guide: float, side: Signs,
                   at: float, cut: float, sense: float, follow: float) -> Any:
    """The same as of two arcs, for a rod on a guide."""
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
