"""Graphical integration and differentiation by rays from a pole (графическое интегрирование и дифференцирование).

The construction lives on paper: abscissae and ordinates are millimetres. With the scale factors of the abscissa ``mu_x``
and of the integrand ``mu_y``, the integral has ``mu_x * mu_y * H`` (manual 000, 5.2; manual 002, 1.6), ``H`` the pole
distance. Any other unit will do as long as the pole distance has the unit of the abscissa.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.expression import Floats, Reals, primitive
from tmm_sheets.construction.rules import LINE_LINE, RAY
from tmm_sheets.construction.step import Helper, Plan, Rule, Step, value_of
from tmm_sheets.words import marked, tr


@primitive("smooth curve", "other")
def smooth_curve(*of: Any) -> Curve:
    """Smooth curve through n + 1 points, then its slopes at the beginnings of the n intervals, then those at their ends.

    The slopes one by one or as rows.
    """
    points = np.array([p for p in of if np.iscomplexobj(p)])
    left, right = np.split(np.hstack([x for x in of if not np.iscomplexobj(x)]).astype(float), 2)
    return Curve(points.real, points.imag, left, right)


@primitive("ordinate of a curve", "real")
def ordinate_of(curve: Any, x: Reals) -> Reals:
    """Ordinate of a curve at an abscissa."""
    return curve(x)[()]


@primitive("weighted sum", "real")
def weighted(row: Reals, weights: Reals) -> Reals:
    """Sum of a row's numbers, each times its weight: the integral over the nodes of a quadrature."""
    return float(row @ weights)


@primitive("running integral", "real")
def running(row: Reals, halves: Reals, weights: Reals, ends: Reals) -> Reals:
    """Integral from the first border to those with the numbers ``ends``.

    ``row`` is the integrand at the nodes of all panels one after another, ``halves`` are half the widths of the panels, ``weights``
    those of the nodes of one panel.
    """
    parts = halves * (np.reshape(row, (len(halves), -1)) @ weights)
    return np.concatenate(([0.0], np.cumsum(parts)))[np.asarray(ends, dtype=int)]


SMOOTH = Rule("smooth curve through the ends of chords", smooth_curve, (), "curve",
              marked("Through the ends of the chords draw the smooth curve {name} with a French curve; its tangents at the "
                     "borders of the intervals are parallel to the rays to the ordinates of the integrand."))
ON_CURVE = Rule("ordinate of a curve", ordinate_of, ("curve", "length"), "ordinate",
                marked("At the abscissa {1} measure the ordinate of the curve {name} = {value}."))
AREA = Rule("area under a graph", running, ("number",) * 4, "number",
            marked("Area under the curve (Gauss–Legendre quadrature): {name} = {value}."), beyond_paper=True)
POLE = Rule(
    "pole", lambda distance: -distance + 0j, ("length",), "point",
    marked("On the axis of abscissae produced to the left of the origin lay off the pole distance {0}: pole {name}."),
    lambda a, v: (Helper("line", v, 0j),),
)
ORIGIN = Rule("origin of the integral", lambda y: 1j * y, ("ordinate",), "point",
              marked("On the axis of ordinates of the lower graph mark the starting point {name}."))
MID_ORDINATE = Rule(
    "ordinate in the middle of an interval",
    lambda x0, x1, y: (x0 + x1) / 2 + 1j * y, ("ordinate", "ordinate", "ordinate"), "point",
    marked("In the middle of the interval between the abscissae {0} and {1} draw the ordinate {2} up to the curve: point {name}."),
    lambda a, v: (Helper("line", complex(v.real, 0), v),),
)
CARRY = Rule(
    "carry to the ordinate axis", lambda p: 1j * np.imag(p), ("point",), "point",
    marked("Carry {0} horizontally over to the axis of ordinates: point {name}."),
    lambda a, v: (Helper("line", a[0], v),),
)
CHORD = Rule(
    "chord parallel to a ray",
    lambda start, direction, x: x + 1j * (np.imag(start) + (x - np.real(start)) * np.imag(direction) / np.real(direction)),
    ("point", "direction", "ordinate"), "point",
    marked("From {0}, parallel to the ray {1}, draw the chord up to the ordinate at the abscissa {2}: point {name}."),
    lambda a, v: (Helper("line", a[0], v),),
)
CHORD_OF_CURVE = Rule(
    "chord of a curve", lambda p, q: (q - p) / np.abs(q - p), ("point", "point"), "direction",
    marked("Draw the chord {0}{1} of the arc of the curve."), lambda a, v: (Helper("line", a[0], a[1]),),
)
CARRY_BETWEEN = Rule(
    "carry to the middle of an interval",
    lambda p, q, ordinate: (np.real(p) + np.real(q)) / 2 + 1j * np.imag(ordinate), ("point", "point", "point"), "point",
    marked("Carry {2} horizontally over to the middle of the interval between {0} and {1}: point {name}."),
    lambda a, v: (Helper("line", a[2], v),),
)


def integrate(plan: Plan, prefix: str, edges: Sequence[Any] | Floats, heights: Sequence[Any] | Floats,
              pole_distance: Any, start: float = 0.0, borders: Sequence[str] | None = None,
              intervals: Sequence[str] | None = None, mark: str = "′") -> list[Step]:
    """Integrate a graph by chords parallel to the rays from a pole (метод хорд).

    Jumps and peaks of the graph must be borders of intervals, otherwise the error falls as 1/N only instead of 1/N^2.

    Parameters
    ----------
    plan
        receives, for the interval named ``i``, the steps ``{prefix}m{i}`` (ordinate in the middle of the interval),
        ``{prefix}{i}′`` (carried to the ordinate axis), ``{prefix}P{i}′`` (ray, a direction) and, named after the border,
        ``{prefix}{border}`` (end of the chord), and before them ``{prefix}P`` (pole) and the origin of the lower graph.
    edges
        abscissae of the borders, ascending, n + 1 numbers or steps, mm; the first is the ordinate axis, 0.
    heights
        ordinate taken in each interval, n numbers or steps, mm: the ordinate in the middle, or the height of the
        rectangle of equal area, which makes the chord ends exact.
    pole_distance
        H > 0, a number or a step, mm.
    start
        ordinate of the integral at the first border, mm.
    borders, intervals
        names of the n + 1 borders and of the n intervals; "0" .. "n" and "1" .. "n" when left out.
    mark
        what the carried points have behind the interval's name: ″ where positions are named 1′ themselves.

    Returns
    -------
    n + 1 steps: the origin and the ends of the chords, points of the lower graph, mm.

    Raises
    ------
    ValueError
        when there are not as many ordinates as intervals, or the pole distance is not positive.

    Source: manual 002, 1.6 (ordinates in the middle) and 4.2.3 (equal areas).
    """
    if len(edges) != len(heights) + 1:
        raise ValueError(f"{len(edges)} borders need {len(edges) - 1} ordinates, not {len(heights)}")
    if not value_of(pole_distance) > 0:
        raise ValueError(f"the pole distance must be positive, not {value_of(pole_distance)}")
    pole = plan.add(f"{prefix}P", POLE, pole_distance)
    borders = borders or [str(k) for k in range(len(edges))]
    intervals = intervals or [str(k) for k in range(1, len(edges))]
    ends = [plan.add(f"{prefix}{borders[0]}", ORIGIN, start)]
    for i, border, (x0, x1), height in zip(intervals, borders[1:], pairwise(edges), heights, strict=True):
        carried = plan.add(f"{prefix}{i}{mark}", CARRY, plan.add(f"{prefix}m{i}", MID_ORDINATE, x0, x1, height))
        ray = plan.add(f"{prefix}P{i}{mark}", RAY, pole, carried)
        ends.append(plan.add(f"{prefix}{border}", CHORD, ends[-1], ray, x1))
    return ends


def differentiate(plan: Plan, prefix: str, points: Sequence[Any], pole_distance: float,
                  intervals: Sequence[str] | None = None) -> list[Step]:
    """Differentiate a graph: rays from the pole parallel to its chords cut the derivative off the ordinate axis.

    Parameters
    ----------
    plan
        receives ``{prefix}P`` (pole) and for the interval named ``i`` ``{prefix}c{i}`` (chord, a direction),
        ``{prefix}{i}′`` (its ray's intercept on the ordinate axis) and ``{prefix}d{i}`` (carried to its middle).
    points
        n + 1 points of the curve with ascending abscissae, complex or steps, mm.
    pole_distance
        H > 0, mm.
    intervals
        names of the n intervals; "1" .. "n" when left out.

    Returns
    -------
    n steps: points of the derivative in the middles of the intervals (manual 000, 5.2), mm.

    Raises
    ------
    ValueError
        when the pole distance is not positive.
    """
    if not pole_distance > 0:
        raise ValueError(f"the pole distance must be positive, not {pole_distance}")
    pole = plan.add(f"{prefix}P", POLE, pole_distance)
    intervals = intervals or [str(k) for k in range(1, len(points))]
    result = []
    for i, (p, q) in zip(intervals, pairwise(points), strict=True):
        chord = plan.add(f"{prefix}c{i}", CHORD_OF_CURVE, p, q)
        cut = plan.add(
            f"{prefix}{i}′", LINE_LINE, pole, chord, 0j, 1j,
            say=tr("From the pole {0} draw the ray parallel to the chord {1}; it cuts off point {name} on the axis of ordinates."))
        result.append(plan.add(f"{prefix}d{i}", CARRY_BETWEEN, p, q, cut))
    return result


def ordinates(steps: Sequence[Step]) -> Floats:
    """Ordinates of a row of points, in order (reading them in order keeps the chain of chords shallow)."""
    return np.array([float(np.imag(s.value)) for s in steps])


def smooth(edges: Floats, values: Floats, left: Floats, right: Floats, x: Reals) -> Reals:
    """Ordinates at ``x`` of the smooth curve with these ordinates and slopes, see :class:`Curve`."""
    return Curve(edges, values, left, right)(x)


class Quadrature:
    """The limit of the chords for vanishing intervals: Gauss-Legendre antiderivative with panels between the borders.

    Parameters
    ----------
    f
        vectorised integrand, smooth between the ``edges``; it is never read at the edges themselves.
    edges
        n + 1 ascending abscissae, jumps and kinks among them.
    panels
        equal panels per interval.
    order
        Gauss points per panel.
    whole
        the same integrand where all nodes are asked at once (its values may be kept); ``f`` unless told.
    """

    def __init__(self, f: Callable[[Floats], Floats], edges: Floats, panels: int = 1, order: int = 16,
                 whole: Callable[[Floats], Floats] | None = None) -> None:
        self.f = f
        self.whole = whole or f
        self.nodes, self.weights = np.polynomial.legendre.leggauss(order)
        part = np.arange(panels) / panels
        starts = (edges[:-1, None] + np.diff(edges)[:, None] * part).ravel()
        self.panels = panels
        self.borders = np.append(starts, edges[-1])

    @cached_property
    def sums(self) -> Floats:
        """Integrals from the first border to each border of a panel."""
        rows = self.whole(self.at).reshape(-1, len(self.nodes))
        return np.concatenate(([0.0], np.cumsum(self.halves * (rows @ self.weights))))

    def _over(self, a: Floats, b: Floats) -> Floats:
        x = self._nodes(a, b)
        return np.asarray((b - a) / 2 * (self.f(x.ravel()).reshape(x.shape) @ self.weights))

    def _nodes(self, a: Floats, b: Floats) -> Floats:
        return np.asarray((a + b)[..., None] / 2 + ((b - a) / 2)[..., None] * self.nodes)

    @property
    def at(self) -> Floats:
        """Nodes of all panels, one after another."""
        return self._nodes(self.borders[:-1], self.borders[1:]).ravel()

    @property
    def halves(self) -> Floats:
        """Half the width of each panel."""
        return np.asarray(np.diff(self.borders) / 2)

    def excess_weights(self, x: Floats) -> tuple[Floats, list[tuple[Floats, Floats]]]:
        """Weights of the integral from the first border to each of the ``x`` less the mean's, which is the change of energy.

        The nodes of the panels that are not full there, and for each of the ``x`` the weights of :attr:`at` and of these nodes.
        """
        k = np.clip(np.searchsorted(self.borders, x, side="right") - 1, 0, len(self.borders) - 2)
        parts, each = self._nodes(self.borders[k], x), self.halves[:, None] * self.weights
        found = []
        for i, (panel, end) in enumerate(zip(k, x, strict=True)):
            further = np.zeros(parts.shape)
            further[i] = (end - self.borders[panel]) / 2 * self.weights
            share = (end - self.borders[0]) / (self.borders[-1] - self.borders[0])
            found.append(((each * ((np.arange(len(each)) < panel)[:, None] - share)).ravel(), further.ravel()))
        return parts.ravel(), found

    @property
    def total(self) -> float:
        """Integral over all intervals."""
        return float(self.sums[-1])

    def __call__(self, x: Reals) -> Floats:
        """Integral from the first border to ``x`` (any shape within the borders)."""
        x = np.asarray(x, dtype=float)
        k = np.clip(np.searchsorted(self.borders, x, side="right") - 1, 0, len(self.borders) - 2)
        return np.asarray(self.sums[k] + self._over(self.borders[k], x))
