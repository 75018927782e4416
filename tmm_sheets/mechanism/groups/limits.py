"""Conditions of assembly: their form, and the words for lengths in them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, floor, log10
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.quantities import Directions, Reals
from tmm_sheets.mechanism.groups.contexts import PositionPlan
from tmm_sheets.words import tell

SWEEP = 720
"""Crank angles of the fine sweep; between them the narrowest places are searched for."""

TOUCH = 1e-6
"""Share of the crank length (sine of the angle between guides) below which a pin sits on a pivot (guides are parallel)."""


@dataclass(frozen=True)
class AssemblyLimit:
    """One condition of assembly of a group: it holds where ``margin`` (m, or the sine of an angle) is not negative.

    ``unit`` is what the margin is compared with: the crank length, or 1 for a sine. ``say`` words the greatest lack, whose
    place is named when it is ``measured``; ``hint`` words what would help, from the positions of the whole turn.
    """

    unit: float
    margin: Callable[[PositionPlan[Any, Any]], Any]
    say: Callable[[float], str]
    hint: Callable[[PositionPlan[Any, Any]], str]
    measured: bool = True


def mm(length: float) -> str:
    """A length, m, in words."""
    return tell("{length:.4g} mm").format(length=length * 1000)


def lacking(length: float) -> str:
    """A lack, m, in words."""
    return mm(length) if length >= 1e-6 else tell("less than 0.001 mm")


def more(length: float) -> str:
    """A length to four significant digits, surely greater than the given one, m."""
    return _rounded(length * (1 + 1e-6), ceil)


def less(length: float) -> str:
    """A length to four significant digits, surely less than the given one, m."""
    return _rounded(length * (1 - 1e-6), floor)


def _rounded(length: float, to: Callable[[float], int]) -> str:
    if length <= 0:
        return mm(0.0)
    unit = 10.0 ** (floor(log10(length * 1000)) - 3)
    return tell("{length:.6g} mm").format(length=to(length * 1000 / unit) * unit)


def span(pos: PositionPlan[Any, Any], p: str, q: str) -> Reals:
    """Distance of two points of the position plan, m, shape (n,)."""
    return np.abs(pos.value(pos.points[q]) - pos.value(pos.points[p]))


def rounding(length: float, *points: Any) -> Any:
    """What a difference of lengths may be by the rounding of a length and of some points alone, m, shape (n,)."""
    return 4e-15 * (length + sum(np.abs(p) for p in points))


def unrounded(margin: Reals, rounding: Reals) -> Reals:
    """A margin that is nothing where it is nothing but rounding, m: rods that just reach do reach."""
    return np.where(np.abs(margin) <= rounding, 0.0, margin)


def extremes(lengths: Reals) -> tuple[float, float]:
    """Least and greatest of ``lengths`` over the turn, m: a number, or shape (n,) that ends with the sweep.

    Between the angles of the sweep their squares, which are smooth, are taken as parabolas.
    """
    y = np.broadcast_to(lengths, max(np.size(lengths), SWEEP))[-SWEEP:] ** 2
    before, after = np.roll(y, 1), np.roll(y, -1)
    bend = before - 2 * y + after
    with np.errstate(invalid="ignore", divide="ignore"):
        vertex = np.where(np.abs(before - after) <= 2 * np.abs(bend), y - (after - before) ** 2 / (8 * bend), y)
    vertex = np.where(np.isfinite(vertex), vertex, y)
    return float(np.sqrt(max(np.nanmin(vertex), 0.0))), float(np.sqrt(np.nanmax(vertex)))


def sine(u: Directions, v: Directions) -> Reals:
    """Magnitude of the sine of the angle between two unit directions, shape (n,)."""
    return np.abs(ar.cross(u, v))
