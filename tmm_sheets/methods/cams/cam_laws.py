"""Laws of motion of a cam's follower: phases of a turn, displacement and both derivatives, exact.

Source: manual 000, section 7.1 (sine, cosine, constant acceleration); manual 003, table 2.9, figure 2.13 (trapezoid with
straight ramps of an eighth of the phase, linearly decreasing acceleration; both reconstructed).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction.arithmetic import ascending, by_pieces, inner_slopes
from tmm_sheets.construction.expression import Floats, Points, Reals, primitive
from tmm_sheets.construction.step import Given
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import marked, tell, tr

Function = Callable[..., Any]


@primitive("within a turn", "real")
def within_turn(phi: Reals) -> Reals:
    """Cam angle within a turn, 0 .. 2 pi, both included."""
    phi = np.asarray(phi, dtype=float)
    return np.where((phi >= 0) & (phi <= 2 * pi), phi, phi % (2 * pi))


def share(phi: Reals, start: Any, angle: Reals) -> Reals:
    """Share of a phase that is over at a cam angle, 0 .. 1."""
    return np.minimum(np.maximum((phi - start) / angle, 0.0), 1.0)


def displaced(first: Points, travel: Reals, s: Any) -> Reals:
    """Displacement in a phase, ``s`` that of the law for unit stroke, m."""
    return first + travel * s


def first_derivative(travel: Reals, angle: Reals, ds: Any) -> Reals:
    """First derivative of the displacement by the cam angle, m."""
    return travel / angle * ds


def second_derivative(travel: Reals, angle: Reals, dds: Any) -> Reals:
    """Second derivative of the displacement by the cam angle, m."""
    return travel / angle**2 * dds


class Motion(ABC):
    """A displacement over an argument, with its first and second derivative."""

    @abstractmethod
    def at(self, order: int, x: Reals) -> Reals:
        """Displacement, order 0, or one of its derivatives."""

    def s(self, x: Reals) -> Reals:
        """Displacement."""
        return self.at(0, x)

    def ds(self, x: Reals) -> Reals:
        """First derivative."""
        return self.at(1, x)

    def dds(self, x: Reals) -> Reals:
        """Second derivative."""
        return self.at(2, x)


@dataclass(frozen=True)
class Law(Motion):
    """Law of one phase for unit stroke and unit phase angle: ``s`` grows from 0 to 1 while ``x`` grows from 0 to 1.

    ``forms`` are ``s`` and its exact derivatives ``ds`` and ``dds``: functions of ``x`` and of the ``nodes`` of a given diagram,
    where the law is one. ``peak`` is the largest ``|dds|``. ``division``, where the law has an
    auxiliary circle, gives the angles, rad, at which the points of the circle of radius ``peak`` stand as high as ``dds``.
    ``jumps`` are the shares inside the phase where ``dds`` jumps. ``even`` means
    that the second half of the phase is the first one read backwards.
    """

    name: str
    title: str
    forms: tuple[Function, Function, Function]
    peak: float
    division: Function | None = None
    jumps: tuple[float, ...] = ()
    even: bool = True
    nodes: tuple[Given, ...] = ()

    def at(self, order: int, x: Reals) -> Reals:
        """Share of the travel passed, or a derivative, at shares ``x`` of the phase."""
        return self.forms[order](x, *[given.value for given in self.nodes])

    @property
    def reverse(self) -> Law:
        """The law of the mirror image: a fall that retraces the rise."""
        if self.even:
            return self
        s, ds, dds = self.forms
        return replace(self, name=f"{self.name}, backwards", jumps=tuple(1 - j for j in reversed(self.jumps)), forms=(
            lambda x, *nodes: 1 - s(1 - x, *nodes), lambda x, *nodes: ds(1 - x, *nodes), lambda x, *nodes: -dds(1 - x, *nodes)))


SINE = Law(
    "sine", marked("sine acceleration"),
    (lambda x: x - np.sin(2 * pi * x) / (2 * pi), lambda x: 2 * np.sin(pi * x) ** 2, lambda x: 2 * pi * np.sin(2 * pi * x)),
    peak=2 * pi,
    division=lambda x: 2 * pi * x,
)
COSINE = Law(
    "cosine", marked("cosine acceleration"),
    (lambda x: np.sin(pi * x / 2) ** 2, lambda x: pi / 2 * np.sin(pi * x), lambda x: pi**2 / 2 * np.cos(pi * x)),
    peak=pi**2 / 2,
    division=lambda x: pi / 2 - pi * x,
)
CONSTANT = Law(
    "constant", marked("constant acceleration"),
    (lambda x: by_pieces(x, 2 * x**2, 0.5, 1 - 2 * (1 - x) ** 2), lambda x: by_pieces(x, 4 * x, 0.5, 4 * (1 - x)),
     lambda x: by_pieces(x, 4.0, 0.5, -4.0)),
    peak=4.0,
    jumps=(0.5,),
)
LINEAR = Law(
    "linearly decreasing", marked("linearly decreasing acceleration"),
    (lambda x: x**2 * (3 - 2 * x), lambda x: 6 * x * (1 - x), lambda x: 6 * (1 - 2 * x)),
    peak=6.0,
)


# --- any diagram of the acceleration ----------------------------------------------------------------------------------


READING = 0.15
"""Share by which the areas above and below the axis may differ: diagrams are read from paper and joined smoothly."""


class _Pieces:
    """A displacement of polynomials that each begin at one of ``starts``; ``forms``: its coefficients, those of its derivatives."""

    starts: Floats
    forms: tuple[Floats, Floats, Floats]

    def at(self, order: int, x: Reals) -> Reals:
        """Displacement or a derivative at shares of the phase; at a border that of the later piece."""
        coefficients, x = self.forms[order], np.asarray(x, dtype=float)
        k = np.clip(np.searchsorted(self.starts, x, side="right") - 1, 0, len(self.starts) - 1)
        t, c = x - self.starts[k], coefficients[k]
        result = c[..., -1]
        for power in range(c.shape[-1] - 2, -1, -1):
            result = result * t + c[..., power]
        return result

    def check(self, key: str, hint: str) -> Floats:
        """See that the displacement never falls; returns the shares that were looked at.

        Raises
        ------
        CannotBuild
            when the follower would turn back inside the phase; ``key`` names what it is given by.
        """
        shares = ascending(np.append(np.linspace(0, 1, 4001), self.starts))
        velocity = self.at(1, shares)
        if velocity.min() < -1e-9 * velocity.max():
            raise CannotBuild(tell("{key}: the follower turns back inside the phase, at the share {share:.3f}").format(
                key=key, share=shares[velocity.argmin()]), hint)
        return shares


class _Accelerations(_Pieces):
    """A diagram of straight and smoothly curved pieces with its two integrals, all of them polynomials.

    Between two corners the points are joined by monotone cubics: no overshoot, straight lines stay straight. The diagram is
    multiplied by ``1 + slant (1/2 - x)``.
    """

    def __init__(self, x: Sequence[float], y: Sequence[float]) -> None:
        borders, values = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        pieces = []
        corners = [0, *(k + 1 for k in range(len(borders) - 1) if borders[k] == borders[k + 1]), len(borders)]
        for a, b in pairwise(corners):
            if b - a > 1:
                pieces.append((borders[a:b], values[a:b], _slopes(borders[a:b], values[a:b])))
        self.starts = np.concatenate([at[:-1] for at, _, _ in pieces])
        self.widths = np.concatenate([np.diff(at) for at, _, _ in pieces])
        cubic = np.concatenate([_cubics(*piece) for piece in pieces])
        self.jumps = tuple(float(q[0][0]) for p, q in pairwise(pieces) if p[1][-1] != q[1][0])
        # With t = x - start: the slant makes a quartic of the cubic.
        slanted = np.pad(cubic, ((0, 0), (0, 1)))
        self.forms = self._integrals(slanted)
        end, way = float(self.at(1, 1.0)), float(self.at(0, 1.0))
        self.unequal = end
        self.area = float(np.abs(np.diff(self.at(1, np.linspace(0, 1, 2001)))).sum()) / 2
        if self.area > 0 and way > 0 and abs(end) <= READING * self.area:
            slant = -end / (way - end / 2)
            slanted = slanted * (1 + slant * (0.5 - self.starts))[:, None]
            slanted[:, 1:] -= slant * cubic
            s, ds, dds = self.forms = self._integrals(slanted)
            scale = float(self.at(0, 1.0))
            self.forms = s / scale, ds / scale, dds / scale

    def _integrals(self, dds: Floats) -> tuple[Floats, Floats, Floats]:
        ds, s = _integral(dds), _integral(_integral(dds))
        ds[:, 0] = np.concatenate(([0.0], np.cumsum(_value(ds, self.widths))))[:-1]
        s = _integral(ds)
        s[:, 0] = np.concatenate(([0.0], np.cumsum(_value(s, self.widths))))[:-1]
        return s, ds, dds


def _slopes(x: Floats, y: Floats) -> Floats:
    """Slopes of the monotone cubics in the points of one smooth piece."""
    h, d = np.diff(x), np.diff(y) / np.diff(x)
    if len(d) == 1:
        return np.array([d[0], d[0]])
    slopes = np.zeros(len(x))
    slopes[1:-1] = inner_slopes(h, d)
    for end, (h0, h1), (d0, d1) in ((0, h[:2], d[:2]), (-1, h[:-3:-1], d[:-3:-1])):
        # The parabola through three points, kept monotone.
        slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1)
        slopes[end] = 0.0 if slope * d0 <= 0 else min(abs(slope), 3 * abs(d0)) * np.sign(d0) if d0 * d1 <= 0 else slope
    return slopes


def _cubics(x: Floats, y: Floats, slopes: Floats) -> Floats:
    """Coefficients by rising power of ``x - start``, shape (n - 1, 4)."""
    h, d = np.diff(x), np.diff(y) / np.diff(x)
    c2 = (3 * d - 2 * slopes[:-1] - slopes[1:]) / h
    c3 = (slopes[:-1] + slopes[1:] - 2 * d) / h**2
    return np.column_stack((y[:-1], slopes[:-1], c2, c3))


def _integral(c: Floats) -> Floats:
    return np.concatenate((np.zeros((len(c), 1)), c / np.arange(1, c.shape[1] + 1)), axis=1)


def _value(c: Floats, t: Floats) -> Floats:
    return np.asarray((c * t[:, None] ** np.arange(c.shape[1])).sum(axis=1))


@cache
def _pieces(kind: type[_Accelerations | _Spline], x: tuple[float, ...], y: tuple[float, ...]) -> Any:
    """The polynomials of a diagram, made once."""
    return kind(x, y)


def _of_nodes(name: str, title: str, form: Function, nodes: tuple[Given, ...], peak: float, jumps: tuple[float, ...] = ()) -> Law:
    """Law of a given diagram; ``form`` is its primitive, which takes the order of the derivative last."""
    s, ds, dds = (partial(form, order=float(order)) for order in range(3))
    return Law(name, title, (s, ds, dds), peak=peak, jumps=jumps, even=False, nodes=nodes)


def _nodes(key: str, x: Sequence[float], y: Sequence[float]) -> tuple[Given, ...]:
    """Both rows of a diagram as givens."""
    return tuple(Given(np.asarray(row, dtype=float), f"{key}[*][{i}]", over="curve") for i, row in enumerate((x, y)))


@primitive("law of a diagram", "real")
def diagram(x: Reals, shares: Reals, accelerations: Any, order: float) -> Reals:
    """The law whose acceleration is a given diagram (see :func:`table_law`), ``order`` 0, or its first or second derivative."""
    found: Reals = _pieces(_Accelerations, tuple(shares), tuple(accelerations)).at(int(order), x)
    return found


def table_law(x: Sequence[float], y: Sequence[float], name: str = "table", title: str = marked("by the given diagram"),
              key: str = "cam.table") -> Law:
    """Law from a diagram of the acceleration: shares ``x`` of the phase, 0 .. 1, and relative accelerations ``y``.

    Two points with one share make a corner, or a jump where their accelerations differ; the others are joined smoothly.
    The velocity must return to zero: areas above and below the axis that differ by up to 15 per cent are made equal by
    tilting the diagram, its zeros kept.

    Raises
    ------
    CannotBuild
        when the areas differ by more, or when the follower would turn back inside the phase; ``key`` names the diagram.
    """
    nodes = _nodes(key, x, y)
    p = _pieces(_Accelerations, *(tuple(given.value) for given in nodes))
    if not p.area > 0:
        raise CannotBuild(tell("{key}: the diagram of the acceleration is zero everywhere").format(key=key))
    if abs(p.unequal) > READING * p.area:
        share = 0.5 + p.unequal / p.area / 4
        raise CannotBuild(
            tell("{key}: the areas above and below the axis are {above:.2f} and {below:.2f} of the whole, the follower would not "
                 "come to rest").format(key=key, above=share, below=1 - share),
            tell("make both areas equal: what speeds up must slow down again"))
    shares = p.check(key, tell("speeding up comes first, slowing down after it"))
    values = np.concatenate((p.at(2, shares), p.at(2, np.append(p.starts[1:], 1.0) - 1e-12)))
    return _of_nodes(name, title, diagram, nodes, float(np.abs(values).max()), p.jumps)


class _Spline(_Pieces):
    """Cubic spline through the ordinates of one phase, level at both ends, with its two derivatives."""

    def __init__(self, x: Sequence[float], y: Sequence[float]) -> None:
        at, values = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        h, d = np.diff(at), np.diff(values) / np.diff(at)
        slopes, n = np.zeros(len(at)), len(at) - 2
        if n:
            # The second derivative is one on both sides of each inner ordinate.
            rows = np.diag(2 / h[:-1] + 2 / h[1:]) + np.diag(1 / h[1:-1], 1) + np.diag(1 / h[1:-1], -1)
            slopes[1:-1] = np.linalg.solve(rows, 3 * (d[:-1] / h[:-1] + d[1:] / h[1:]))
        self.starts = at[:-1]
        s = _cubics(at, values, slopes)
        ds = s[:, 1:] * np.arange(1, 4)
        self.forms = s, ds, ds[:, 1:] * np.arange(1, 3)


@primitive("spline of ordinates", "real")
def through_ordinates(x: Reals, shares: Reals, displacements: Any, order: float) -> Reals:
    """The law through given ordinates (see :func:`ordinates_law`), ``order`` 0, or its first or second derivative."""
    found: Reals = _pieces(_Spline, tuple(shares), tuple(displacements)).at(int(order), x)
    return found


def ordinates_law(x: Sequence[float], y: Sequence[float], key: str = "cam.displacements") -> Law:
    """Law through given ordinates: shares ``x`` of the phase and ``y`` of the travel, both from 0 to 1, by a clamped cubic spline.

    Raises
    ------
    CannotBuild
        when the spline turns back between two ordinates; ``key`` names the table.
    """
    nodes = _nodes(key, x, y)
    spline = _pieces(_Spline, *(tuple(given.value) for given in nodes))
    spline.check(key, tell("give ordinates there, or smoother ones"))
    peak = float(np.abs(spline.at(2, np.append(spline.starts, 1.0))).max())
    return _of_nodes("displacements", marked("by the given table of displacements"), through_ordinates, nodes, peak)


TRAPEZOID = replace(
    table_law((0, 1 / 8, 1 / 8, 3 / 8, 3 / 8, 5 / 8, 5 / 8, 7 / 8, 7 / 8, 1), (0, 1, 1, 1, 1, -1, -1, -1, -1, 0),
              "trapezoid", marked("trapezoidal acceleration"), "cam.law"), even=True)

LAWS = {law.name: law for law in (SINE, COSINE, CONSTANT, TRAPEZOID, LINEAR)}
"""Laws of motion by the name they have in project files."""


# --- phases of a turn -----------------------------------------------------------------------------------------------


PHASES = {"φ_у": marked("φ_r"), "φ_дс": marked("φ_ud"), "φ_с": marked("φ_f"), "φ_бс": marked("φ_ld")}
"""Symbols of the phases, by which they are found, and how they are written: rise, upper dwell, fall, lower dwell."""


@dataclass(frozen=True)
class Phase(Motion):
    """A phase of the motion: ``angle`` rad from ``start`` on, the displacement going from ``first`` by ``travel``, m.

    The functions take the share ``x`` of the phase, 0 .. 1, numbers or arrays.
    """

    symbol: str
    start: float
    angle: float
    first: float
    travel: float
    law: Law

    @property
    def letters(self) -> str:
        """The symbol as it is written on paper."""
        return tr(PHASES[self.symbol])

    @property
    def tag(self) -> str:
        """Index of the symbol, for names of steps."""
        return self.symbol.removeprefix("φ_")

    @property
    def index(self) -> str:
        """Index of the symbol as it is written on paper."""
        return self.letters.removeprefix("φ_")

    @property
    def end(self) -> float:
        """Cam angle at which the phase ends, rad."""
        return self.start + self.angle

    @property
    def amplitude(self) -> float:
        """Largest second derivative of the phase, m."""
        return abs(self.travel) * self.law.peak / self.angle**2

    def at(self, order: int, x: Reals) -> Reals:
        """Displacement, m or rad, or a derivative over the cam angle, at shares ``x`` of the phase."""
        of_law = self.law.at(order, x)
        if not order:
            return displaced(self.first, self.travel, of_law)
        return (first_derivative if order == 1 else second_derivative)(self.travel, self.angle, of_law)

    def phi(self, x: Reals) -> Reals:
        """Cam angle, rad."""
        return self.start + self.angle * x


@dataclass(frozen=True)
class PositionFunction(Motion):
    """Displacement of the follower over a turn of the cam, with both derivatives, exact for the law.

    Angles in rad, displacement in m (a rocker's in rad), numbers or arrays. Where the second derivative jumps, the value
    of the later phase counts; the phases themselves give the values of either side.
    """

    rise: Phase
    upper_dwell: Phase
    fall: Phase
    lower_dwell: Phase
    parts: int = 8
    symbol: str = "S"

    @classmethod
    def of(cls, rise: float, upper_dwell: float, fall: float, stroke: float, law: Law, fall_law: Law | None = None,
           parts: int = 8, symbol: str = "S") -> PositionFunction:
        """Law of motion from the phase angles (rad) and the stroke (m, or rad with the ``symbol`` of an angle).

        Without a law of its own the fall is the mirror image of the rise; a dwell below 1e-9 rad is none. ``parts`` are
        the equal parts of each phase.
        """
        upper_dwell = upper_dwell if upper_dwell > 1e-9 else 0.0
        down = rise + upper_dwell
        end = down + fall if 2 * pi - (down + fall) > 1e-9 else 2 * pi
        return cls(
            Phase("φ_у", 0.0, rise, 0.0, stroke, law),
            Phase("φ_дс", rise, upper_dwell, stroke, 0.0, law),
            Phase("φ_с", down, fall, stroke, -stroke, fall_law or law.reverse),
            Phase("φ_бс", end, 2 * pi - end, 0.0, 0.0, law),
            parts, symbol,
        )

    @property
    def phases(self) -> tuple[Phase, ...]:
        """The phases that take part of the turn, in order."""
        return tuple([p for p in (self.rise, self.upper_dwell, self.fall, self.lower_dwell) if p.angle > 0])

    @property
    def stroke(self) -> float:
        """Stroke of the follower, m."""
        return self.rise.travel

    def at(self, order: int, x: Reals) -> Reals:
        """Displacement, or a derivative, at any cam angles ``x``, rad."""
        turn = within_turn(x)
        values = [p.at(order, share(turn, p.start, p.angle)) for p in self.phases]
        return by_pieces(turn, *[v for p, value in zip(self.phases, values, strict=True) for v in (value, p.end)][:-1])

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Position numbers: 0 .. 8 of the rise, 8' .. 16 of the fall (with 8 parts)."""
        n = self.parts
        return (*map(str, range(n + 1)), f"{n}'", *map(str, range(n + 1, 2 * n + 1)))

    @cached_property
    def shares(self) -> Floats:
        """Shares of a phase at its numbered positions."""
        return np.arange(self.parts + 1) / self.parts

    @cached_property
    def positions(self) -> Floats:
        """Cam angles of the numbered positions, rad, shape (2 parts + 2,)."""
        return np.concatenate((self.rise.phi(self.shares), self.fall.phi(self.shares)))

    def divided(self, parts: int) -> Floats:
        """Cam angles of a whole turn, each phase in equal parts, 0 and 2 pi included, rad.

        The numbered positions are among them when ``parts`` is a multiple of theirs.
        """
        x = np.arange(parts) / parts
        return np.concatenate((*(p.phi(x) for p in self.phases), [2 * pi]))
