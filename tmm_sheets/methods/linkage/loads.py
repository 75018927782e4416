"""Technological forces and moments over the cycle: constants, tables over the stroke or the angle, signs by stroke.

A stroke begins and ends where the point (or link) it belongs to stands still; the law of a force switches there, not where
a computed velocity happens to be zero. Source: manual 000, sections 4 and 5; manual 001, section 3; manual 003, section 2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NoReturn

import numpy as np

from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.checks import check_turn
from tmm_sheets.methods.linkage.cycle import SWEEP, Cycle, Floats, Stroke, Strokes, root, strokes_of
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.methods.linkage.velocities import velocity_plan

NEAR = 1e-12
"""Angles closer than this are the same, rad."""


@dataclass(frozen=True)
class Motion:
    """Strokes of a point along a line, or of a turning link.

    ``travelled(turned)`` is the way from where the working strokes begin, as a fraction 0..1 of the whole way; of a link that
    turns all the way round, the part of its turn from position 0 on. A law that acts on a part of the way only has shorter
    strokes, see :meth:`within`.
    """

    strokes: tuple[Stroke, ...]
    travelled: Callable[[Floats], Any]
    period: float

    @property
    def endless(self) -> bool:
        """True of a link that never turns back."""
        return self.strokes[0].end - self.strokes[0].begin >= 2 * np.pi - NEAR

    @property
    def ends(self) -> tuple[float, ...]:
        """Angles within one period where a stroke begins or ends: the dead points and the limits of the action."""
        every = [s.begin for s in self.strokes] + [s.end for s in self.strokes]
        return () if self.endless else distinct((float(np.mod(t, self.period)) for t in every), self.period)

    def number(self, turned: Any, side: int = 0) -> Any:
        """Index of the stroke at each angle; -1 between strokes, and at an end unless ``side`` tells from where it is seen."""
        t = np.asarray(turned, dtype=float)
        if self.endless:
            into = np.mod(t - self.strokes[0].begin, self.period)
            nth = (into + (NEAR if side >= 0 else -NEAR)) // (2 * np.pi)
            return np.asarray(np.mod(nth, len(self.strokes)), dtype=int)
        found = np.full(t.shape, -1)
        for i, s in enumerate(self.strokes):
            into = np.mod(t - s.begin, self.period)
            into = np.where(self.period - into < NEAR, 0.0, into)
            width = s.end - s.begin
            lower = into > NEAR if side <= 0 else into > -NEAR
            upper = into < width + NEAR if side < 0 else into < width - NEAR
            found = np.where(lower & upper, i, found)
        return found

    def crossings(self, fraction: float) -> tuple[float | None, ...]:
        """Angle where each stroke passes a fraction of the way; None where it does not."""
        return tuple(self._crossing(s, fraction) for s in self.strokes)

    def _crossing(self, s: Stroke, fraction: float) -> float | None:
        sense = 1 if s.working or self.endless else -1
        end = s.end - (1e-9 if self.endless else 0.0)  # a whole turn ends where it begins

        def ahead(t: Floats) -> Floats:
            return np.asarray(sense * (self.travelled(t) - fraction))

        first, last = ahead(np.array([s.begin, end]))
        return root(ahead, s.begin, end) if first < -NEAR and last > NEAR else None

    def within(self, begin: float, end: float) -> Motion:
        """The same strokes between two fractions of the way only; what lies outside altogether has no length."""
        low, high = (c if 0 < fraction < 1 else (None,) * len(self.strokes)
                     for fraction, c in ((f, self.crossings(f)) for f in (begin, end)))
        strokes = []
        for s, a, b in zip(self.strokes, low, high, strict=True):
            first, last = (a, b) if s.working else (b, a)
            from_, to = s.begin if first is None else first, s.end if last is None else last
            middle = float(self.travelled(np.array([(from_ + to) / 2]))[0])
            strokes.append(Stroke(from_, to if begin < middle < end else from_, s.working))
        return Motion(tuple(strokes), self.travelled, self.period)


def distinct(angles: Iterable[float], period: float) -> tuple[float, ...]:
    """Angles in order, each once: two that differ by rounding are one, also across the end of the period."""
    kept: list[float] = []
    for t in sorted(0.0 if period - t < NEAR else t for t in angles):
        if not kept or t - kept[-1] > NEAR:
            kept.append(t)
    return tuple(kept)


def straight_motion(m: Mechanism, cycle: Cycle, point: str, sense: complex, known: Strokes | None = None,
                    first: float = 0.0) -> Motion:
    """Strokes of a point that moves to and fro; working strokes go along the unit vector ``sense``.

    Raises :class:`CannotBuild` when the mechanism does not assemble all the way round or the point does not move that way.
    """

    def along(turned: Floats) -> Any:
        return (position_plan(m, cycle.world(turned)).points[point].value * np.conj(sense)).real

    def speed(turned: Floats) -> Any:
        v = velocity_plan(position_plan(m, cycle.world(turned))).points[point].value
        return (np.broadcast_to(v, np.shape(turned)) * np.conj(sense)).real

    if known is not None and known.output == point and abs(known.path - sense) < 1e-9:
        dead = [known.begin, known.end]
        strokes = [Stroke(known.begin, known.end, True), Stroke(known.end, known.begin + 2 * np.pi, False)]
    else:
        dead, strokes = strokes_of(speed)
    ways = along(np.asarray(dead, dtype=float)) if dead else np.zeros(1)
    low, high = float(ways.min()), float(ways.max())
    if not high - low > 1e-9 * m.crank.length:
        _refuse(m, f"point {point} does not move to and fro that way: its force has no strokes",
                "give the sense of the working strokes along its path")
    return Motion(tuple(_repeated(strokes, cycle.period, first)), lambda t: np.clip((along(t) - low) / (high - low), 0.0, 1.0),
                  cycle.period)


def turning_motion(m: Mechanism, cycle: Cycle, link: str, sense: int, first: float = 0.0) -> Motion:
    """Strokes of a link that swings, or one endless stroke of a link that turns all the way round."""

    def speed(turned: Floats) -> Any:
        w = velocity_plan(position_plan(m, cycle.world(turned))).omega[link].value
        return np.broadcast_to(sense * w, np.shape(turned))

    def angle(turned: Floats) -> Any:
        u = position_plan(m, cycle.world(turned)).directions[link].value
        return sense * np.angle(np.broadcast_to(u, np.shape(turned)))

    dead, strokes = strokes_of(speed)
    if not strokes:
        _refuse(m, f"link {link} does not turn all the time")
    strokes = _repeated(strokes, cycle.period, first)
    if not dead:
        way = 1 if strokes[0].working else -1
        base = float(angle(np.zeros(1))[0])

        def turn(t: Floats) -> Any:
            part = np.mod(way * (angle(np.asarray(t)) - base) / (2 * np.pi), 1.0)
            return np.where(part > 1 - NEAR, 0.0, part)

        return Motion(tuple(strokes), turn, cycle.period)
    # The swing from the whole turn: more than 180 degrees would not show in the angles of the dead points alone.
    swept = np.unwrap(angle(np.sort(np.append(np.linspace(0.0, 2 * np.pi, SWEEP + 1), dead))))
    low, swing = float(swept.min()), float(np.ptp(swept))
    spare = np.pi - swing / 2

    def travelled(t: Floats) -> Any:
        return np.clip((np.mod(angle(t) - low + spare, 2 * np.pi) - spare) / swing, 0.0, 1.0)

    return Motion(tuple(strokes), travelled, cycle.period)


def _refuse(m: Mechanism, message: str, hint: str = "") -> NoReturn:
    """Say why there are no strokes: first of all whether the mechanism assembles all the way round."""
    check_turn(m)
    raise CannotBuild(message, hint)


def _repeated(strokes: list[Stroke], period: float, first: float) -> list[Stroke]:
    """The strokes of one turn over the whole period, beginning with the one that begins nearest to ``first``."""
    turns = round(period / (2 * np.pi))
    every = [Stroke(s.begin + 2 * np.pi * n, s.end + 2 * np.pi * n, s.working) for n in range(turns) for s in strokes]
    distance = [abs(np.angle(np.exp(1j * (s.begin - first) * 2 * np.pi / period))) for s in every]
    start = int(np.argmin(distance))
    return every[start:] + every[:start]


@dataclass(frozen=True)
class Applied:
    """A technological force (N, along the unit vector ``toward`` at ``point``) or, without a point, a moment (N m).

    ``law(turned, side)`` is its signed value; moments count counter-clockwise. ``jumps`` are the angles where it is not smooth.
    """

    name: str
    link: str
    point: str | None
    toward: complex
    law: Callable[[Any, int], Any]
    jumps: tuple[float, ...]
    motion: Motion | None = None

    def vector(self, turned: Any, side: int = 0) -> Any:
        """Force vector, N, complex."""
        return self.law(turned, side) * self.toward

    def magnitude(self, turned: Any, side: int = 0) -> Any:
        """Absolute value, N or N m."""
        return np.abs(self.law(turned, side))


Table = tuple[Sequence[float], Sequence[float]]
"""Arguments and values of a diagram, straight lines between them."""


Curve = Callable[[Any, int], Any]
"""Ordinates of a diagram; at a jump ``side`` -1 tells the value before it, otherwise the one after it."""


def curve_of(table: Table, smooth: bool = False, period: float | None = None) -> Curve:
    """Curve through the points of a diagram, constant beyond its ends or periodic; arguments given twice are jumps.

    Straight lines, or a cubic in every interval: the slope in a point is the weighted harmonic mean of its neighbours', and zero
    where they differ in sign, so the curve rises and falls only where the points do (F. N. Fritsch, J. Butland, SIAM J. Sci.
    Stat. Comput. 5, 1984). At the ends and at jumps the slope is that of the only neighbour.
    """
    x, y = (np.asarray(v, dtype=float) for v in table)
    if period is not None and x[-1] - x[0] < period - NEAR:
        x, y = np.append(x, x[0] + period), np.append(y, y[0])
    if len(x) < 2:
        x, y = np.repeat(x, 2), np.repeat(y, 2)
    h, rise = np.diff(x), np.diff(y)
    left, right = _slopes(x, y, period is not None and y[0] == y[-1])
    corners = x[:-1][h == 0]

    def curve(t: Any, side: int = 0) -> Any:
        t = np.asarray(t, dtype=float)
        if period is not None:
            t = np.mod(t - x[0], period) + x[0]
            t = np.where(t - x[0] < NEAR, x[-1], t) if side < 0 else np.where(x[-1] - t < NEAR, x[0], t)
        for corner in corners:  # what misses a jump by rounding stands on it
            t = np.where(np.abs(t - corner) < NEAR, corner, t)
        k = np.clip(np.searchsorted(x, t, side="left" if side < 0 else "right") - 1, 0, len(h) - 1)
        s = np.clip((t - x[k]) / np.where(h[k] > 0, h[k], 1.0), 0.0, 1.0)
        if smooth:
            r = 1 - s
            found = r * r * (y[k] * (1 + 2 * s) + h[k] * s * left[k]) + s * s * (y[k + 1] * (1 + 2 * r) - h[k] * r * right[k])
        else:
            found = y[k] + s * rise[k]
        after, before = (t >= x[-1], t < x[0]) if side >= 0 else (t > x[-1], t <= x[0])
        return np.where(after, y[-1], np.where(before, y[0], found))

    return curve


def _slopes(x: Any, y: Any, closed: bool) -> tuple[Any, Any]:
    """Slopes at the beginning and at the end of every interval of a smooth diagram; ``closed``: it goes on as it began."""
    if closed:
        period = x[-1] - x[0]
        x, y = np.concatenate((x[-2:-1] - period, x, x[1:2] + period)), np.concatenate((y[-2:-1], y, y[1:2]))
    h = np.diff(x)
    with np.errstate(divide="ignore", invalid="ignore"):
        chord = np.diff(y) / h
        w1, w2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
        inner = np.where(chord[:-1] * chord[1:] > 0, (w1 + w2) / (w1 / chord[:-1] + w2 / chord[1:]), 0.0)
    left, right = np.append(chord[:1], inner), np.append(inner, chord[-1:])
    left[1:] = np.where(h[:-1] > 0, left[1:], chord[1:])
    right[:-1] = np.where(h[1:] > 0, right[:-1], chord[:-1])
    return (left[1:-1], right[1:-1]) if closed else (left, right)


def jumps_of(table: Table) -> tuple[float, ...]:
    """Arguments where a diagram jumps: given twice with different values."""
    return tuple(a for (a, p), (b, q) in pairwise(zip(*table, strict=True)) if a == b and p != q)


def stroke_law(motion: Motion, tables: Sequence[Table | None], signs: Sequence[float], smooth: bool = False,
               always: bool = False) -> tuple[Callable[[Any, int], Any], tuple[float, ...]]:
    """Law over the strokes in their order, and the angles where it is not smooth.

    A table over the travelled fraction and a sign for each stroke in turn (None: no force). A resistance has no value at a
    dead point itself; a pressure acts ``always``, there with the stroke that begins.
    """
    curves = [None if table is None else curve_of(table, smooth) for table in tables]

    def law(turned: Any, side: int = 0) -> Any:
        t = np.asarray(turned, dtype=float)
        i = motion.number(t, 1 if always and not side else side)
        x = motion.travelled(t) if any(table is not None and len(table[0]) > 1 for table in tables) else np.zeros(t.shape)
        if motion.endless and side < 0:
            x = np.where(x < NEAR, 1.0, x)  # the end of a turn, not the beginning of the next
        value = np.zeros(t.shape)
        for n, s in enumerate(motion.strokes):
            curve, sign = curves[n % len(curves)], signs[n % len(signs)]
            if curve is not None:
                value = np.where(i == n, sign * curve(x, (side or 1) * (1 if s.working or motion.endless else -1)), value)
        return value

    jumps = list(motion.ends)
    for n, s in enumerate(motion.strokes):
        before, table = (tables[k % len(motion.strokes) % len(tables)] for k in (n - 1, n))
        if motion.endless and (before[1][-1] if before else 0.0) != (table[1][0] if table else 0.0):
            jumps.append(float(np.mod(s.begin, motion.period)))
        for fraction in jumps_of(table) if table else ():
            at = motion.crossings(fraction)[n]
            jumps += [] if at is None else [float(np.mod(at, motion.period))]
    return law, distinct(jumps, motion.period)


def angle_law(table: Table, period: float, smooth: bool = False) -> tuple[Callable[[Any, int], Any], tuple[float, ...]]:
    """Law over the angle turned from position 0, periodic, and the angles of its points."""
    return curve_of(table, smooth, period), distinct((float(np.mod(t, period)) for t in table[0]), period)
