"""Arithmetic of compass and ruler on complex points, for all positions at once.

Every function works on scalars and arrays alike and gives NaN where the construction does not exist. The forms are the
measured ones: factored gaps (Kahan's sorted Heron form) for two circles, the foot of the perpendicular for line and
circle, and compensated differences of products for two lines (W. Kahan; T. J. Dekker, Numer. Math. 18, 1971).

Beside each stands its plain form, as a textbook has it: where lines cross under no small angle it gives the same numbers to a
few units in the last place, at a tenth of the operations. Guards tell where that is, see
:class:`~tmm_sheets.construction.expression.Primitive`.

Curves as values of steps (кривая): points, slopes and the law between them.

A smooth curve is drawn through points that were constructed; what is then measured on it, its tangents and its extremes take the
curve as an argument, so an error of a point goes on through it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from tmm_sheets.construction.expression import Directions, Floats, Points, Reals, Signs, Vectors, primitive

_SPLIT = 134217729.0  # 2**27 + 1, Dekker's splitting constant for doubles


def ascending(values: Floats) -> Floats:
    """Numbers in ascending order, each once; ``np.unique`` would load numpy's masked arrays for that, which takes 10 ms."""
    found: Floats = np.sort(values)
    kept: Floats = found[np.append(found[:-1] != found[1:], True)[:len(found)]]
    return kept


def two_product(a: Reals, b: Reals) -> tuple[Any, Any]:
    """Product of two doubles as an unevaluated sum, exactly (Dekker 1971; no fused multiply-add in numpy)."""
    p = a * b
    ca, cb = _SPLIT * a, _SPLIT * b
    ah, bh = ca - (ca - a), cb - (cb - b)
    al, bl = a - ah, b - bh
    return p, al * bl - (((p - ah * bh) - al * bh) - ah * bl)


@primitive("difference of products", "real", plain=lambda a, b, c, d: a * b - c * d)
def difference_of_products(a: Reals, b: Reals, c: Reals, d: Reals) -> Reals:
    """``a*b - c*d`` to about two units in the last place, whatever cancels."""
    p, e = two_product(a, b)
    q, f = two_product(c, d)
    return (p - q) + (e - f)


def _plain_cross(u: Vectors, v: Vectors) -> Reals:
    """Cross product where it only decides or corrects, or nothing cancels."""
    return u.real * v.imag - u.imag * v.real


def _plain_dot(u: Vectors, v: Vectors) -> Reals:
    return u.real * v.real + u.imag * v.imag


@primitive("cross", "real", plain=_plain_cross)
def cross(u: Vectors, v: Vectors) -> Reals:
    """Cross product of two plane vectors: Re u Im v - Im u Re v.

    >>> float(cross(2 + 0j, 1 + 3j))
    6.0
    """
    return difference_of_products(u.real, v.imag, u.imag, v.real)


@primitive("dot", "real", plain=_plain_dot)
def dot(u: Vectors, v: Vectors) -> Reals:
    """Scalar product of two plane vectors."""
    return difference_of_products(u.real, v.real, -u.imag, v.imag)


@primitive("polar", formula=True)
def polar(centre: Points, radius: Reals, angle: Reals) -> Points:
    """Point at ``radius`` from ``centre`` under ``angle`` (rad, counter-clockwise from the x axis).

    >>> complex(polar(1 + 0j, 2.0, 0.0))
    (3+0j)
    """
    return centre + radius * (np.cos(angle) + 1j * np.sin(angle))


@primitive("ray", formula=True)
def ray(p: Points, q: Points) -> Directions:
    """Unit direction from ``p`` to ``q``; NaN when they coincide."""
    e = q - p
    return e / np.abs(e)


def along(p: Points, u: Directions, distance: Reals) -> Points:
    """Point at ``distance`` from ``p`` in the unit direction ``u``."""
    return p + distance * u


@primitive("unit", plain=lambda angle: np.cos(angle) + 1j * np.sin(angle))
def unit(angle: float) -> complex:
    """Unit vector; exact for multiples of 90 degrees, where cos(pi/2) would leave 6e-17."""
    quarter = angle / (np.pi / 2)
    if quarter == round(quarter):
        return (1 + 0j, 1j, -1 + 0j, -1j)[round(quarter) % 4]
    return complex(np.cos(angle), np.sin(angle))


def turned(u: Vectors) -> Vectors:
    """Vector turned by +90 degrees."""
    return 1j * u


@primitive("lines meet", plain=lambda p, u, q, v, det=None, way=None: p + _plain_cross(q - p, v) / _plain_cross(u, v) * u,
           guard=lambda p, u, q, v, det=None, way=None: _plain_cross(u, v) ** 2)
def line_line(p: Points, u: Directions, q: Points, v: Directions, det: Reals = None, way: Reals = None) -> Points:
    """Intersection of the line through ``p`` along ``u`` with the line through ``q`` along ``v``; NaN when parallel.

    Laid off from the nearer of the two points. ``det``, the cross product of the directions, may be known better than they
    can tell themselves (from the plan they were taken from); and so may be the whole ``way`` from ``p``, also where both lines are
    one. Where these are NaN they are not known.

    >>> complex(line_line(0j, 1 + 0j, 3 + 2j, 1j))
    (3+0j)
    >>> bool(np.isnan(line_line(0j, 1 + 0j, 3 + 2j, 1 + 0j)))
    True
    """
    if way is not None and not np.any(np.isnan(way)):
        return p + way * u
    start, along = p, u
    w, lost = difference(q, p)
    if det is None:
        det = cross(u, v)
    elif np.any(np.isnan(det)):
        det = np.where(np.isnan(det), cross(u, v), det)
    far = np.abs(_plain_cross(w, v)) > np.abs(_plain_cross(w, u))
    if np.any(far):
        p, u, v = np.where(far, q, p), np.where(far, v, u), np.where(far, u, v)
    t = (cross(w, v) + _plain_cross(lost, v)) / np.where(det == 0, np.nan, det)
    found = p + t * u
    return found if way is None else np.where(np.isnan(way), found, start + way * along)


def difference(q: Points, p: Points) -> tuple[Vectors, Vectors]:
    """``q - p`` and what rounding takes from it, exactly: points far from the crossing keep their digits."""
    w = q - p
    back = w - q
    return w, (q - (w - back)) - (p + back)


def _gaps(c1: Points, r1: Reals, c2: Points, r2: Reals) -> tuple[Vectors, Reals, Reals]:
    """Centre to centre, the square of that distance, and the square of four times the area of the triangle."""
    e = c2 - c1
    square = _plain_dot(e, e)
    return e, square, ((r1 + r2) ** 2 - square) * (square - (r1 - r2) ** 2)


def _plain_arcs(c1: Points, r1: Reals, c2: Points, r2: Reals, side: Signs, height: Reals = None, distance: Reals = None,
                line: Directions = None) -> Points:
    e, square, area = _gaps(c1, r1, c2, r2)
    share = 0.5 / square
    return c1 + (0.5 + (r1 - r2) * (r1 + r2) * share + 1j * (side * np.sqrt(area) * share)) * e


@primitive("arc cuts arc", plain=_plain_arcs, guard=lambda c1, r1, c2, r2, side, height=None, distance=None, line=None: (
    _gaps(c1, r1, c2, r2)[2] / (4 * (r1 * r2) ** 2)))
def arc_arc(c1: Points, r1: Reals, c2: Points, r2: Reals, side: Signs, height: Reals = None, distance: Reals = None,
            line: Directions = None) -> Points:
    """Intersection of two circles; ``side`` +1 is left of the line from ``c1`` to ``c2``, -1 right.

    The height over the line of centres comes from the sorted, factored Heron form: about ten times fewer digits are
    lost towards tangency than with ``sqrt(r**2 - a**2)``; or it is given, with the distance of the centres, where both are
    known better than from the points. The ``line`` from the first centre is given where both may lie in one place: the radii are
    one then, and the distance has a sign along the line.

    >>> arc_arc(0j, 5.0, 6 + 0j, 5.0, np.array([1, -1])).tolist()
    [(3+4j), (3-4j)]
    """
    if line is not None:
        return c1 + (distance / 2 + 1j * side * height) * line
    e = c2 - c1
    d = np.abs(e)
    u = e / d
    if height is None:
        height = half_chord(d, r1, r2)
    if distance is not None:
        d = distance
    foot = (d + (r1 - r2) * (r1 + r2) / d) / 2
    return c1 + (foot + 1j * side * height) * u


def half_chord(d: Reals, r1: Reals, r2: Reals) -> Reals:
    """Half of the chord that two circles have together, their centres ``d`` apart."""
    c, b, a = np.sort(np.stack(np.broadcast_arrays(r1, r2, d)), axis=0)
    four_area_squared = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return np.sqrt(four_area_squared) / (2 * d)


def _chord(centre: Points, radius: Reals, p: Points, u: Directions) -> tuple[Reals, Reals]:
    """Distance of the line from the centre, and the square of half of the chord."""
    height = _plain_cross(u, p - centre)
    return height, (radius - height) * (radius + height)


def _plain_arc_line(centre: Points, radius: Reals, p: Points, u: Directions, side: Signs, half: Reals = None) -> Points:
    height, square = _chord(centre, radius, p, u)
    return centre + (side * np.sqrt(square) + 1j * height) * u


@primitive("arc cuts line", plain=_plain_arc_line,
           guard=lambda centre, radius, p, u, side, half=None: _chord(centre, radius, p, u)[1] / radius**2)
def arc_line(centre: Points, radius: Reals, p: Points, u: Directions, side: Signs, half: Reals = None) -> Points:
    """Intersection of a circle with the line through ``p`` along ``u``; ``side`` +1 is the one further along ``u``.

    ``half``, half of the chord, is given where it is known better than from the points.

    >>> complex(arc_line(0j, 5.0, 0 + 3j, 1 + 0j, -1))
    (-4+3j)
    """
    w, lost = difference(p, centre)
    height = cross(u, w) + _plain_cross(u, lost)
    if half is None:
        half = np.sqrt((radius - height) * (radius + height))
    along = side * half - (dot(u, w) + np.real(u) * np.real(lost) + np.imag(u) * np.imag(lost))
    near = np.abs(along) <= radius
    if np.all(near):
        return p + along * u
    # From the nearer of the two points: the line's own point may be many lengths away.
    return np.where(near, p + along * u, centre + (side * half + 1j * height) * u)[()]


def _tangent(p: Points, centre: Points, radius: Reals) -> tuple[Vectors, Reals, Reals]:
    """Centre to point, the square of that distance, and that of the tangent's length."""
    e = p - centre
    square = _plain_dot(e, e)
    return e, square, square - radius**2


def _plain_tangent(p: Points, centre: Points, radius: Reals, side: Signs) -> Points:
    e, square, tangent = _tangent(p, centre, radius)
    return centre + (radius / square) * (radius - 1j * (side * np.sqrt(tangent))) * e


def _to_tangent(p: Points, centre: Points, radius: Reals, *others: Any) -> Reals:
    _, square, tangent = _tangent(p, centre, radius)
    return tangent / square


@primitive("tangent", plain=_plain_tangent, guard=_to_tangent)
def tangent_point(p: Points, centre: Points, radius: Reals, side: Signs) -> Points:
    """Point where the tangent from ``p`` touches a circle; ``side`` +1 is left of the line from ``p`` to the centre."""
    e = p - centre
    d = np.abs(e)
    cos = radius / d
    sin = np.sqrt((d - radius) * (d + radius)) / d
    return centre + radius * (cos - 1j * side * sin) * e / d


def _plain_tangent_direction(p: Points, centre: Points, radius: Reals, side: Signs, length: Reals = None,
                             distance: Reals = None) -> Directions:
    e, square, tangent = _tangent(p, centre, radius)
    return (np.sqrt(tangent) + 1j * (side * radius)) * e / square


@primitive("tangent direction", plain=_plain_tangent_direction, guard=_to_tangent)
def tangent_direction(p: Points, centre: Points, radius: Reals, side: Signs, length: Reals = None,
                      distance: Reals = None) -> Directions:
    """Direction from :func:`tangent_point` to ``p``, also where they fall together.

    ``length`` of the tangent and ``distance`` of ``p`` from the centre are given where they are known better than from the points.
    """
    e = p - centre
    d = np.abs(e)
    if length is None or distance is None:
        length, distance = np.sqrt((d - radius) * (d + radius)), d
    return (length + 1j * side * radius) / distance * (e / d)


@primitive("foot", formula=True)
def foot(p: Points, q: Points, u: Directions) -> Points:
    """Foot of the perpendicular from ``p`` on the line through ``q`` along the unit direction ``u``.

    >>> complex(foot(4 + 5j, 1 + 0j, 1 + 0j))
    (4+0j)
    """
    return q + dot(u, p - q) * u


def arm(about: Points, at: Points, force: Vectors) -> Reals:
    """Arm of a force about a point, signed: positive when the force turns counter-clockwise about it.

    >>> float(arm(0j, 2 + 0j, 10j)), float(arm(0j, 2 + 0j, -10j))
    (2.0, -2.0)
    """
    return cross(at - about, force) / np.abs(force)


def moment(about: Points, at: Points, force: Vectors) -> Reals:
    """Moment about a point of a force applied at ``at``; counter-clockwise positive."""
    return cross(at - about, force)


BY_PIECES = "by pieces"
"""Name of the primitive that is another formula in each piece of its range."""


@primitive(BY_PIECES, "real")
def by_pieces(x: Reals, *pieces: Reals) -> Reals:
    """The first of some values whose border ``x`` has not reached: value, border, value, border ... value."""
    borders, values = pieces[1::2], pieces[::2]
    return np.select([np.asarray(x) < b for b in borders], values[:-1], values[-1])


Law = Literal["cubic", "straight"]


@dataclass(frozen=True, eq=False)
class Curve:
    """Ordinates over ascending abscissae.

    Attributes
    ----------
    x, y
        n + 1 points, mm (or any unit); two equal abscissae make a jump.
    left, right
        slopes at the beginning and at the end of each of the n stretches (law "cubic"); a corner where they differ. Empty for
        "straight", chords between the points.
    """

    x: Floats
    y: Floats
    left: Floats
    right: Floats
    law: Law = "cubic"

    def __post_init__(self) -> None:
        if np.ndim(self.y) != 1:
            raise ValueError("one curve at a time")  # replays of many curves at once are told to go one by one

    def __call__(self, x: Reals) -> Reals:
        """Ordinates at ``x``, of any shape within the abscissae."""
        x = np.asarray(x, dtype=float)
        k = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)
        h = self.x[k + 1] - self.x[k]
        t = (x - self.x[k]) / h
        s = 1 - t
        if self.law == "straight":
            return s * self.y[k] + t * self.y[k + 1]
        return (s * s * (self.y[k] * (1 + 2 * t) + h * t * self.left[k])
                + t * t * (self.y[k + 1] * (1 + 2 * s) - h * s * self.right[k]))


def inner_slopes(h: Any, chord: Any) -> Any:
    """Slopes in the inner points of a curve that rises and falls only where its points do, from chords of the widths ``h``.

    Weighted harmonic means of the slopes of the neighbouring chords, zero where these differ in sign (F. N. Fritsch, J. Butland,
    SIAM J. Sci. Stat. Comput. 5, 1984, 300-304).
    """
    w1, w2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(chord[:-1] * chord[1:] > 0, (w1 + w2) / (w1 / chord[:-1] + w2 / chord[1:]), 0.0)


def halved(holds: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """The neighbouring doubles between which a condition that holds at ``low``, and not at ``high``, ceases to hold."""
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low, high


def root(f: Callable[[Floats], Floats], low: float, high: float) -> float:
    """Zero of a continuous function (shape (n,) to shape (n,)) between two arguments where its signs differ, to the last bit.

    Each step divides the interval into eight.
    """
    sign = float(np.sign(f(np.array([high]))[0]))
    for _ in range(20):
        x = np.linspace(low, high, 9)
        if not x[0] < x[1] < x[-1]:
            break
        values = sign * f(x)
        i = int(np.argmax(values > 0))
        low, high = float(x[max(i - 1, 0)]), float(x[i])
    return (low + high) / 2


def continuous_argmax(f: Callable[[Floats], Floats], samples: Floats) -> float:
    """Argument of the largest value of a continuous function between the first and the last of the ``samples``.

    The samples must separate the humps; corners of ``f`` (where a force begins or ends) must be samples. The bracket
    round the best sample is divided in 256 again and again until it is flat to rounding. The first and the last are
    one angle of a cycle: which of them is greater, rounding tells.
    """
    values, last = f(samples), len(samples) - 1
    k = int(np.argmax(values))
    found = [_refined_maximum(f, samples, i, float(values[i])) for i in ((0, last) if k in (0, last) else (k,))]
    return max(found, key=lambda one: one[1])[0]


def _refined_maximum(f: Callable[[Floats], Floats], samples: Floats, k: int, value: float) -> tuple[float, float]:
    """Argument of the largest value between the neighbours of a sample, and that value.

    What differs by rounding is no neighbour: a border of an interval beside an angle of the grid.
    """
    best, near = samples[k], 1e-9 * (samples[-1] - samples[0])
    before, behind = np.searchsorted(samples, best - near) - 1, np.searchsorted(samples, best + near, side="right")
    low, high = samples[max(before, 0)], samples[min(behind, len(samples) - 1)]
    while high - low > 1e-15 * (samples[-1] - samples[0]):
        t = np.linspace(low, high, 257)
        y = f(t)
        j = int(np.argmax(y))
        # A corner is met exactly by its sample only, so the best so far is kept.
        if y[j] > value:
            best, value = t[j], float(y[j])
        if value - min(y[max(j - 1, 0)], y[min(j + 1, 256)]) <= 4e-15 * abs(value):
            break
        step = (high - low) / 256
        low, high = max(best - step, low), min(best + step, high)
    return float(best), value
