"""A triangle on three legs in numbers: where it can stand, and how one way of assembly goes on as the crank turns.

A leg keeps a corner of the triangle on a circle (hinged at both ends) or on a line (a slider), or a line of the triangle through a
point (a block in a slot). The triangle stands by its first corner k, m, and the unit direction u from there to its second. A method
of false positions finds the same on paper: two legs and the triangle move by themselves, the third corner draws its locus, and
where the locus crosses the circle or the guide of the third leg the group is put together. Here the crossing is refined by Newton's
method on the three conditions themselves, so that it is as exact as the lengths. The ways of assembly are up to six; which one is
meant is told at one crank angle and followed from there: each step must be so small that Newton's corrections shrink at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import Complex, Directions, Floats, Points, Reals, primitive
from tmm_sheets.mechanism.groups.contexts import SWEEP

CIRCLE, LINE, SLOT = 0.0, 1.0, 2.0
"""What a leg does: its corner on a circle, on a line; a line of the triangle through a point."""
Legs = tuple[Any, ...]
"""Three legs of five values each, shape (n,) or one number: what it does; a point, m, the centre, on the guide, or in the slot;
direction of the guide; length, m, or angle of the slot, rad, to the line from the first corner to the second; the corner in the
triangle's own frame, m."""
Pose = tuple[complex, complex]
"""First corner of the triangle, m, and its direction."""

FINEST = 7
"""How many times a step is divided by eight before the way is said to end."""
SHRINKING = 0.25
"""The second of Newton's corrections beside the first, at most, for the step to stay on its way."""
FAR = 0.05
"""Way, in sizes of the group, beyond which another place is not the one that was looked for."""
SCAN = 1440
"""Directions of the triangle in which ways of assembly are looked for."""


def _spread(k: Any, u: Directions, legs: Legs) -> tuple[Any, Any, Legs]:
    """Place, direction and legs of one shape (n,); what a leg does stays one number."""
    k, u, *many = (np.atleast_1d(x) for x in np.broadcast_arrays(k, u, *legs))
    return k, u, tuple(float(np.ravel(legs[i])[0]) if i % 5 == 0 else x for i, x in enumerate(many))


def conditions(k: Any, u: Directions, legs: Legs) -> tuple[Any, Any, Any]:
    """By how much each leg misses, m; its normal, along which it holds the triangle; the normal's point on the triangle."""
    missed, normals, points = [], [], []
    for does, p, d, size, corner in zip(*(legs[i::5] for i in range(5)), strict=True):
        at = k + corner * u
        if does == CIRCLE:
            r = at - p
            length = np.abs(r)
            missed.append(length - size)
            normals.append(r / length)
            points.append(at)
        elif does == LINE:
            n = 1j * d
            missed.append((np.conj(n) * (at - p)).real)
            normals.append(n + 0 * at)
            points.append(at)
        else:
            n = 1j * u * np.exp(1j * size)
            missed.append((np.conj(n) * (at - p)).real)
            normals.append(n)
            points.append(p + 0 * at)
    return np.array(missed), np.array(normals), np.array(points)


def moments(k: Any, normals: Any, points: Points) -> Reals:
    """Moment of each normal about the first corner, m: with the normals the rows of the conditions' Jacobian."""
    return (np.conj(points - k) * normals).imag


def determinant(k: Any, normals: Any, points: Points) -> Reals:
    """Of the three normals as forces, m: zero where they meet in one point, or are parallel."""
    m = moments(k, normals, points)
    x, y = normals.real, normals.imag
    return (m[0] * (x[1] * y[2] - x[2] * y[1]) - m[1] * (x[0] * y[2] - x[2] * y[0]) + m[2] * (x[0] * y[1] - x[1] * y[0]))


def _correction(k: Any, u: Directions, legs: Legs) -> tuple[Any, Any]:
    """Newton's correction of the first corner, m, and of the direction, rad."""
    f, normals, points = conditions(k, u, legs)
    x, y, m = normals.real, normals.imag, moments(k, normals, points)
    det = determinant(k, normals, points)
    minors = [(y[1] * m[2] - y[2] * m[1], y[2] * m[0] - y[0] * m[2], y[0] * m[1] - y[1] * m[0]),
              (m[1] * x[2] - m[2] * x[1], m[2] * x[0] - m[0] * x[2], m[0] * x[1] - m[1] * x[0]),
              (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])]
    dx, dy, turn = (-sum(a * b for a, b in zip(row, f, strict=True)) / np.where(det == 0, np.nan, det) for row in minors)
    return dx + 1j * dy, turn


def extent(legs: Legs) -> Any:
    """Size of the group, m: what its rounding is a share of."""
    reach = sum(np.abs(corner) for corner in legs[4::5])
    sizes = sum(np.abs(size) for does, size in zip(legs[0::5], legs[3::5], strict=True) if does == CIRCLE)
    return reach + sizes + max(np.max(np.abs(p), initial=0.0) for p in legs[1::5])


def solved(k: Any, u: Directions, legs: Legs) -> tuple[Complex, Complex]:
    """First corner, m, and direction of the triangle on its legs, next to where it is supposed; NaN where it has no place there."""
    k, u, many = _spread(k, u / np.abs(u), legs)
    size, start, turned = extent(many), k, u
    with np.errstate(all="ignore"):
        for _ in range(40):
            dk, turn = _correction(k, u, many)
            k, u = k + dk, u * np.exp(1j * turn)
            u = u / np.abs(u)
            moved = np.abs(dk) + np.abs(turn) * size
            if not np.any(moved > 4e-16 * size):
                break
        far = np.abs(k - start) + size * np.abs(u - turned) > FAR * size
        lost = ~(np.max(np.abs(conditions(k, u, many)[0]), axis=0) < 1e-11 * size) | far
    return np.where(lost, np.nan, k), np.where(lost, np.nan, u)


@primitive("corner of a triangle on three legs")
def corner_on_legs(k: Any, u: Directions, *legs: Any) -> Points:
    """The third leg's corner, m, of the triangle on three legs: where its locus crosses the circle or the guide of that leg.

    ``k``, ``u`` are the place of the first corner, m, and the direction of the triangle it is looked for next to.
    """
    first, along = solved(k, u, legs)
    return _as_given(first + along * legs[14], k)


@primitive("direction of a triangle on three legs")
def direction_on_legs(k: Any, u: Directions, *legs: Any) -> Directions:
    """Direction from the first corner to the second of the triangle on three legs."""
    return _as_given(solved(k, u, legs)[1], k)


def _as_given(found: Any, like: Any) -> Any:
    return found if np.ndim(like) else found[0]


@primitive("value on a followed course")
def on_course(phi: Reals, angles: Reals, values: Any) -> Reals:
    """Value at a crank angle between the angles of one turn, rad, at which it is known; NaN where it is not, nor next to it."""
    x = angles[0] + np.mod(np.asarray(phi) - angles[0], 2 * np.pi)
    i = np.clip(np.searchsorted(angles, x, side="right") - 1, 0, len(angles) - 2)
    share = (x - angles[i]) / (angles[i + 1] - angles[i])
    a, b = values[i], values[i + 1]
    return np.where(np.isnan(a), np.where(share > 0.5, b, np.nan), np.where(np.isnan(b), np.where(share <= 0.5, a, np.nan),
                                                                           a + share * (b - a)))[()]


@primitive("false position")
def false_place(k: Any, u: Directions, amount: Any, *legs: Any) -> Points:
    """First corner, m, of the triangle on the first two legs alone, moved so far, m, from where it stands."""
    return _as_given(_moved(k, u, amount, legs)[0], k)


@primitive("side of a false position", "real")
def false_side(k: Any, u: Directions, amount: Any, *legs: Any) -> Reals:
    """On which side the second corner then lies: of the line to the second leg's pivot, or further along its guide; +1 or -1."""
    k, u = _moved(k, u, amount, legs)
    does, p, d, size, corner = legs[5:10]
    if does == CIRCLE:
        return np.where((np.conj(p - k) * corner * u).imag >= 0, 1.0, -1.0)
    if does == LINE:
        return np.where((np.conj(d) * corner * u).real >= 0, 1.0, -1.0)
    return np.where((np.conj(p - k) * u * np.exp(1j * size)).real >= 0, 1.0, -1.0)


def locus_sine(k: Any, u: Directions, *legs: Any) -> Reals:
    """Sine of the angle at which the locus of the third corner crosses the circle or the guide of its leg."""
    k, u = solved(k, u, legs)
    _, normals, _ = conditions(k, u, legs)
    ahead, turned = _free_step(k, u, legs, 1.0, legs[14])
    along = ahead - k + legs[14] * u * np.angle(turned / u) * 1j
    return (np.conj(normals[2]) * along).real / np.abs(along)


def _moved(k: Any, u: Any, amount: Any, legs: Legs) -> tuple[Any, Any]:
    """The triangle and two legs moved on by themselves: the third corner goes so far along its locus, m, in small steps."""
    k, u, many = _spread(k, u, legs)
    corner = many[14]
    with np.errstate(all="ignore"):
        for _ in range(MOVES):
            k, u = _free_step(k, u, many, amount / MOVES, corner)
            for _ in range(3):
                k, u = _back(k, u, many)
    return k, u


MOVES = 6


def _free_step(k: Any, u: Any, legs: Legs, way: Any, corner: Any) -> tuple[Any, Any]:
    """A step along the freedom that two legs leave: across both their conditions."""
    _, normals, points = conditions(k, u, legs)
    x, y, m = normals.real, normals.imag, moments(k, normals, points)
    dx, dy, turn = y[0] * m[1] - y[1] * m[0], m[0] * x[1] - m[1] * x[0], x[0] * y[1] - x[1] * y[0]
    dk = dx + 1j * dy
    scale = way / np.maximum(np.abs(dk + 1j * corner * u * turn), 0.2 * (np.abs(dk) + np.abs(corner * turn)))
    return k + scale * dk, u * np.exp(1j * scale * turn)


def _back(k: Any, u: Directions, legs: Legs) -> tuple[Any, Any]:
    """Onto the first two legs again by the shortest way."""
    f, normals, points = conditions(k, u, legs)
    size = np.max(np.abs(np.array(legs[4::5], dtype=complex)))
    rows = np.array([normals.real[:2], normals.imag[:2], moments(k, normals, points)[:2] / size])
    a, b, c = (rows[:, 0] ** 2).sum(axis=0), (rows[:, 0] * rows[:, 1]).sum(axis=0), (rows[:, 1] ** 2).sum(axis=0)
    det = a * c - b * b
    first, second = (c * f[0] - b * f[1]) / det, (a * f[1] - b * f[0]) / det
    dx, dy, turn = -(rows[:, 0] * first + rows[:, 1] * second)
    return k + dx + 1j * dy, u * np.exp(1j * turn / size)


# --- ways of assembly -------------------------------------------------------------------------------------------------


def places(u: Directions, i: int, j: int, legs: Legs) -> list[Any]:
    """First corners, m, of triangles of directions ``u`` whose legs ``i`` and ``j`` hold: two for each, or one."""
    loci = []
    for n in (i, j):
        does, p, d, size, corner = legs[5 * n: 5 * n + 5]
        loci.append((does == CIRCLE, p - corner * u, u * np.exp(1j * size) if does == SLOT else d, size))
    (round_one, p, v, r), (round_two, q, w, s) = loci
    if round_one and round_two:
        e = q - p
        d = np.abs(e)
        along = (d * d + (r - s) * (r + s)) / (2 * d)
        across = np.sqrt((r - along) * (r + along))
        return [p + (along + 1j * side * across) * e / d for side in (1, -1)]
    if round_one or round_two:
        centre, radius, through, u2 = (p, r, q, w) if round_one else (q, s, p, v)
        foot = through + u2 * (np.conj(u2) * (centre - through)).real
        half = np.sqrt(radius**2 - np.abs(foot - centre) ** 2)
        return [foot + side * half * u2 for side in (1, -1)]
    return [p + v * (np.conj(q - p) * w).imag / (np.conj(v) * w).imag]


def modes(legs: Legs) -> list[Pose]:
    """Every way of assembly at one crank angle, sorted by the direction's angle from 0 to 360 degrees."""
    theta = 2 * np.pi / SCAN * (np.arange(SCAN + 1) + 0.371)
    u = np.exp(1j * theta)
    size = float(extent(legs))
    found: list[Pose] = []
    with np.errstate(all="ignore"):
        for third in range(3):
            i, j = (n for n in range(3) if n != third)
            for k in places(u, i, j, legs):
                f = conditions(k, u, legs)[0][third]
                signs = np.flatnonzero(np.sign(f[1:]) * np.sign(f[:-1]) < 0)
                size_f = np.abs(f)
                dips = 1 + np.flatnonzero((size_f[1:-1] < size_f[:-2]) & (size_f[1:-1] < size_f[2:]) & (size_f[1:-1] < 0.05 * size))
                ends = np.flatnonzero(np.isnan(f[1:]) != np.isnan(f[:-1]))
                starts = np.unique(np.concatenate((signs, signs + 1, dips, ends, ends + 1)))
                starts = starts[~np.isnan(f[starts])]
                if len(starts):
                    many = tuple(np.full(len(starts), x) for x in legs)
                    found += zip(*(z.tolist() for z in solved(k[starts], u[starts], many)), strict=True)
    unique: list[Pose] = []
    for k, u in found:
        if not np.isnan(k) and all(abs(k - a) + size * abs(u - b) > 1e-7 * size for a, b in unique):
            unique.append((k, u))
    return sorted(unique, key=lambda pose: np.angle(pose[1]) % (2 * np.pi))


@dataclass(frozen=True)
class Course:
    """One way of assembly round the turn: crank angles from the one it was told at, rad, ascending over one turn; first corner, m,
    and direction of the triangle there, NaN where the group does not reach.

    ``normals`` are those of the three legs, in order. ``back`` is False when after the turn it is another way. ``found`` are all
    ways of assembly at the first angle, ``taken`` is the number of the one followed, from 0; -1 for none.
    """

    angles: Floats
    k: Complex
    u: Complex
    normals: Complex
    back: bool
    found: tuple[Pose, ...]
    taken: int


def course(before: Callable[[Floats], Legs], at: float, near: float) -> Course:
    """Follow the way of assembly whose direction at the crank angle ``at`` is nearest to ``near``, rad.

    ``before`` gives the legs at crank angles, shape (n,).
    """
    start = before(np.array([at]))
    one = tuple(x if i % 5 == 0 else np.ravel(x)[0] for i, x in enumerate(start))
    found = tuple(modes(one))
    grid: Floats = np.asarray(at + 2 * np.pi / SWEEP * np.arange(SWEEP + 1), dtype=np.float64)
    grid[-1] = at + 2 * np.pi
    if not found:
        nothing = np.full(len(grid), np.nan, dtype=complex)
        return Course(grid, nothing, nothing, np.full((3, len(grid)), np.nan, dtype=complex), True, found, -1)
    taken = min(range(len(found)), key=lambda i: abs(np.angle(found[i][1] * np.exp(-1j * near))))
    way = _Way(before, grid)
    angles, k, u = way.follow(found[taken])
    ends = np.isnan(k)
    back = bool(abs(k[-1] - k[0]) < 1e-6 * float(extent(one)) and abs(u[-1] - u[0]) < 1e-6)
    if ends.any():
        # The other way round from the same place; between both ends the group does not reach.
        first = int(np.argmax(ends)) + 1
        others = way.follow(found[taken], backwards=True)
        last = int(np.argmax(np.isnan(others[1]))) + 1
        others = tuple(z[:last] for z in others)  # type: ignore[assignment]
        beyond = others[0] > angles[first - 1]
        angles, k, u = (np.concatenate((z[:first], w[beyond][::-1])) for z, w in zip((angles, k, u), others, strict=True))
        back = True
    legs = before(angles)
    with np.errstate(all="ignore"):
        normals = conditions(k, u, legs)[1]
    return Course(angles, k, u, normals, back, found, taken)


class _Way:
    """Steps from one crank angle to the next, divided where they are too long."""

    def __init__(self, before: Callable[[Floats], Legs], grid: Floats) -> None:
        self.before = before
        self.grid = grid
        self.legs = before(grid)

    def follow(self, pose: Pose, backwards: bool = False) -> tuple[Floats, Complex, Complex]:
        """Angles from the first one on (or from the last one back), and where the triangle stands; NaN behind its end."""
        order = range(len(self.grid) - 1, -1, -1) if backwards else range(len(self.grid))
        found: list[tuple[float, Pose | None]] = []
        here: Pose | None = pose
        for i in order:
            angle = float(self.grid[i])
            to = None if here is None else self._step(here, self._at(self.legs, i))
            if to is None and here is not None and found:
                divided = self._divided(here, found[-1][0], angle, FINEST)
                to = divided[-1][1]
                found += divided[:-1] if divided[-1][0] == angle else divided
            found.append((angle, to))
            here = to
        k, u = (np.array([np.nan if p is None else p[n] for _, p in found], dtype=complex) for n in (0, 1))
        return np.array([angle for angle, _ in found]), k, u

    def _divided(self, pose: Pose, a: float, b: float, deep: int) -> list[tuple[float, Pose | None]]:
        """The way from angle ``a`` to ``b`` in eight steps, each divided again where it is too long; None last where it ends."""
        inner = np.linspace(a, b, 9)[1:]
        inner[-1] = b
        legs, last = self.before(inner), a
        found: list[tuple[float, Pose | None]] = []
        for n, angle in enumerate(inner.tolist()):
            to = self._step(pose, self._at(legs, n))
            if to is not None or not deep:
                found.append((angle, to))
            else:
                found += self._divided(pose, last, angle, deep - 1)
            if (here := found[-1][1]) is None:
                return found
            pose, last = here, angle
        return found

    @staticmethod
    def _at(legs: Legs, i: int) -> Legs:
        return tuple(x[i] if np.ndim(x) else x for x in legs)

    @staticmethod
    def _step(pose: Pose, legs: Legs) -> Pose | None:
        """The triangle on other legs, if Newton's corrections shrink at once; else None."""
        (k, u), size = pose, float(extent(legs))
        moved: list[float] = []
        with np.errstate(all="ignore"):
            sign = np.sign(determinant(k, *conditions(k, u, legs)[1:]))
            for _ in range(12):
                dk, turn = _correction(k, u, legs)
                k, u = k + dk, u * np.exp(1j * turn)
                moved.append(float(abs(dk) + abs(turn) * size))
                if moved[-1] < 1e-13 * size:
                    break
                if not moved[-1] < 0.2 * size or (len(moved) > 1 and moved[-1] > SHRINKING * moved[-2] > 1e-11 * size):
                    return None
            f, normals, points = conditions(k, u, legs)
            if not np.max(np.abs(f)) < 1e-10 * size or np.sign(determinant(k, normals, points)) != sign:
                return None
        return complex(k), complex(u / abs(u))


def gap(k: complex, u: complex, legs: Legs) -> tuple[float, complex, complex]:
    """By how much the third leg misses, m, where its corner's locus comes nearest to its circle or guide, and the place.

    It is looked for next to a place of the triangle: there the first two legs hold and the third condition has its extreme.
    """
    size = float(extent(legs))
    with np.errstate(all="ignore"):
        for _ in range(60):
            f, normals, points = conditions(k, u, legs)
            h = 1e-6 * size
            rows = [[n.real, n.imag, float((np.conj(p - k) * n).imag)] for n, p in zip(normals[:2], points[:2], strict=True)]
            here = float(determinant(k, normals, points))
            slopes = [(float(determinant(a, *conditions(a, b, legs)[1:])) - here) / step
                      for a, b, step in ((k + h, u, h), (k + 1j * h, u, h), (k, u * np.exp(1e-6j), 1e-6))]
            try:
                dx, dy, turn = np.linalg.solve(np.array([*rows, slopes]), -np.array([f[0], f[1], here]))
            except np.linalg.LinAlgError:
                break
            short = min(1.0, 0.05 * size / (abs(dx) + abs(dy) + size * abs(turn) + 1e-300))
            k, u = k + short * complex(dx, dy), u * np.exp(1j * short * turn)
            if abs(dx) + abs(dy) + size * abs(turn) < 1e-12 * size:
                break
        f = conditions(k, u, legs)[0]
    return (float(f[2]) if np.max(np.abs(f[:2])) < 1e-8 * size else np.nan), k, u


def nearest(legs: Legs) -> tuple[float, int]:
    """By how much a group that cannot be put together misses, m, and the number of the leg that misses; inf when two miss."""
    u = np.exp(2j * np.pi / SCAN * np.arange(SCAN))
    best, leg = np.inf, 2
    with np.errstate(all="ignore"):
        for third in (2, 1, 0):
            i, j = (n for n in range(3) if n != third)
            for k in places(u, i, j, legs):
                f = conditions(k, u, legs)[0][third]
                if not np.isnan(f).all():
                    n = int(np.nanargmin(np.abs(f)))
                    if abs(f[n]) < abs(best):
                        best, leg = float(f[n]), third
    return best, leg
