"""Technological forces and moments over the cycle: constants, tables over the stroke or the angle, signs by stroke.

The strokes are those of :mod:`~tmm_sheets.methods.linkage.strokes`: from one true extreme of the way to the other. The law of
a force switches in the dead points that were found, not where a computed velocity happens to be zero; inside a stroke a force
against (or along) the motion turns round with each reversal, and there is none while the output stands still.
Source: manual 000, sections 4 and 5; manual 001, section 3; manual 003, section 2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, floor
from typing import Any, NoReturn

import numpy as np

from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.checks import check_turn
from tmm_sheets.methods.linkage.cycle import Cycle, Strokes
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.methods.linkage.strokes import SWEEP, TURN, Floats, Run, in_strokes, over_cycle, root, runs_of
from tmm_sheets.methods.linkage.velocities import velocity_plan

STROKES = "strokes of forces"
NEAR = 1e-12
"""Angles closer than this are the same, rad."""


@dataclass(frozen=True)
class OutputMotion:
    """How a point moves along a line, or a link turns: its runs over the cycle, each a part of a stroke.

    ``travelled(turned)`` is the way from where the working strokes begin, as a fraction 0..1 of the whole way between the
    extremes. A link that turns all the way round is ``endless``: its way is its turns from position 0 on, counted on in the sense
    it goes round in, which is the working sense (``way`` +1) or not (-1); each turn of the crank is a stroke. A law that acts on
    a part of the way only has fewer and shorter runs, see :meth:`within`.
    """

    runs: tuple[Run, ...]
    travelled: Callable[[Any], Any]
    period: float
    endless: bool = False
    way: int = 1

    def number(self, turned: Any, side: int = 0) -> Any:
        """Index of the run at each angle; -1 where there is none, and at an end unless ``side`` tells from where it is seen."""
        t = np.asarray(turned, dtype=float)
        found = np.full(t.shape, -1)
        for i, r in enumerate(self.runs):
            into, width = np.mod(t - r.begin, self.period), r.end - r.begin
            if side < 0:
                into = np.where(into <= NEAR, into + self.period, into)
                inside = into < width + NEAR
            else:
                into = np.where(self.period - into < NEAR, 0.0, into)
                inside = into < width - NEAR if side > 0 else (into > NEAR) & (into < width - NEAR)
            found = np.where(inside, i, found)
        return found

    def crossings(self, run: Run, fraction: float) -> list[float]:
        """Angles inside a run where it passes a fraction of the way, an endless link in any of its turns."""
        sense = run.sense * self.way
        if not sense:
            return []
        ends = sorted(float(x) for x in self.travelled(np.array([run.begin, run.end])))
        turns = range(floor(ends[0] - fraction), ceil(ends[1] - fraction) + 1) if self.endless else (0,)
        levels = [fraction + k for k in turns if ends[0] + NEAR < fraction + k < ends[1] - NEAR]

        def ahead(level: float) -> Callable[[Floats], Floats]:
            return lambda t: np.asarray(sense * (self.travelled(t) - level))

        return sorted(root(ahead(level), run.begin, run.end) for level in levels)

    def within(self, begin: float, end: float) -> OutputMotion:
        """The same motion between two fractions of the way only."""
        runs = []
        for r in self.runs:
            cuts = sorted(c for fraction in (begin, end) if 0 < fraction < 1 for c in self.crossings(r, fraction))
            for a, b in pairwise((r.begin, *cuts, r.end)):
                if begin <= float(self.fraction((a + b) / 2)) <= end:
                    runs.append(replace(r, begin=a, end=b))
        return replace(self, runs=tuple(runs))

    def fraction(self, turned: Any) -> Any:
        """The way as a fraction of the whole, 0..1; the end of an endless link's turn is the beginning of the next."""
        x = np.asarray(self.travelled(np.asarray(turned, dtype=float)))
        if self.endless:
            x = np.mod(x, 1.0)
            x = np.where(x > 1 - NEAR, 0.0, x)
        return x

    def follows(self, i: int) -> bool:
        """True where a run begins at the end of the one before it."""
        return bool(abs(np.angle(np.exp(1j * (self.runs[i].begin - self.runs[i - 1].end) * 2 * np.pi / self.period))) < NEAR)


def distinct(angles: Iterable[float], period: float) -> tuple[float, ...]:
    """Angles in order, each once: two that differ by rounding are one, also across the end of the period."""
    kept: list[float] = []
    for t in sorted(0.0 if period - t < NEAR else t for t in angles):
        if not kept or t - kept[-1] > NEAR:
            kept.append(t)
    return tuple(kept)


def straight_motion(m: Mechanism, cycle: Cycle, point: str, sense: complex, known: Strokes | None = None,
                    first: float = 0.0) -> OutputMotion:
    """Strokes of a point that moves to and fro; working strokes go along the unit vector ``sense``.

    Raises :class:`CannotBuild` when the mechanism does not assemble all the way round or the point does not move that way.
    """

    def along(turned: Floats) -> Any:
        return (position_plan(m, cycle.world(turned), purpose=STROKES).points[point].value * np.conj(sense)).real

    def speed(turned: Floats) -> Any:
        v = velocity_plan(position_plan(m, cycle.world(turned), purpose=STROKES)).points[point].value
        return (np.broadcast_to(v, np.shape(turned)) * np.conj(sense)).real

    the_output = known is not None and known.output == point and abs(known.path - sense) < 1e-9
    runs = known.runs if known is not None and the_output else tuple(runs_of(speed))
    ways = along(np.array([r.begin for r in runs])) if runs else np.zeros(1)
    low, high = float(ways.min()), float(ways.max())
    if not high - low > 1e-9 * m.crank.length:
        _refuse(m, f"point {point} does not move to and fro that way: its force has no strokes",
                "give the sense of the working strokes along its path")
    return OutputMotion(over_cycle(in_strokes(runs, ways), cycle.period, first),
                  lambda t: np.clip((along(np.asarray(t)) - low) / (high - low), 0.0, 1.0), cycle.period)


def turning_motion(m: Mechanism, cycle: Cycle, link: str, sense: int, first: float = 0.0) -> OutputMotion:
    """Strokes of a link that swings, or of a link that turns all the way round, which may go back for a while as well."""

    def speed(turned: Floats) -> Any:
        w = velocity_plan(position_plan(m, cycle.world(turned), purpose=STROKES)).omega[link].value
        return np.broadcast_to(sense * w, np.shape(turned))

    def angle(turned: Any) -> Any:
        u = position_plan(m, cycle.world(turned), purpose=STROKES).directions[link].value
        return sense * np.angle(np.broadcast_to(u, np.shape(turned)))

    runs = runs_of(speed)
    if not runs:
        _refuse(m, f"link {link} does not turn all the time")
    # The angle from the whole turn: more than 180 degrees would not show in the angles of the reversals alone.
    turned = np.unique(np.append(np.linspace(0.0, TURN, SWEEP + 1), [r.begin for r in runs]))
    swept = np.unwrap(angle(turned))
    turns = round(float(swept[-1] - swept[0]) / TURN)
    if not turns and any(r.sense for r in runs):
        ways = np.interp([r.begin for r in runs], turned, swept)
        low, swing = float(ways.min()), float(np.ptp(ways))
        spare = np.pi - swing / 2

        def travelled(t: Any) -> Any:
            return np.clip((np.mod(angle(t) - low + spare, TURN) - spare) / swing, 0.0, 1.0)

        return OutputMotion(over_cycle(in_strokes(runs, ways), cycle.period, first), travelled, cycle.period)
    way = 1 if turns >= 0 else -1
    swept = way * (swept - swept[0]) / TURN

    def round_and_round(t: Any) -> Any:
        nth, into = np.divmod(np.asarray(t, dtype=float), TURN)
        part = way * (angle(into) - angle(np.zeros(1))[0]) / TURN
        return part + np.round(np.interp(into, turned, swept) - part) + nth * abs(turns)

    # Each turn begins with position 0, where the way does.
    cut = [p for r in runs for p in ((replace(r, end=TURN), Run(0.0, r.end - TURN, r.sense)) if r.end > TURN + NEAR else (r,))]
    whole = [replace(r, working=turns > 0) for r in sorted(cut, key=lambda r: r.begin)]
    return OutputMotion(over_cycle(whole, cycle.period, first), round_and_round, cycle.period, True, way)


def _refuse(m: Mechanism, message: str, hint: str = "") -> NoReturn:
    """Say why there are no strokes: first of all whether the mechanism assembles all the way round."""
    check_turn(m)
    raise CannotBuild(message, hint)


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
    motion: OutputMotion | None = None

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


def stroke_law(motion: OutputMotion, tables: Sequence[Table | None], signs: Sequence[float], smooth: bool = False,
               always: bool = False) -> tuple[Callable[[Any, int], Any], tuple[float, ...]]:
    """Law over the runs in their order, and the angles where it is not smooth.

    A table over the travelled fraction (None: no force) and a sign for each run. A resistance has no value at a dead point
    itself; a pressure acts ``always``, there with the stroke that begins.
    """
    runs = motion.runs
    curves = [None if table is None else curve_of(table, smooth) for table in tables]
    over_way = any(table is not None and len(table[0]) > 1 for table in tables)
    # Where the same goes on from one run to the next: an end that is no exception.
    same = np.zeros((len(runs), len(runs)), dtype=bool)
    for i in range(len(runs)):
        same[i - 1, i] = motion.follows(i) and tables[i] is tables[i - 1] and signs[i] == signs[i - 1]

    def law(turned: Any, side: int = 0) -> Any:
        t = np.asarray(turned, dtype=float)
        i = motion.number(t, 1 if always and not side else side)
        if runs and not side and (i < 0).any():
            before, after = motion.number(t, -1), motion.number(t, 1)
            i = np.where((i < 0) & (before >= 0) & (after >= 0) & same[before, after], after, i)
        x = motion.fraction(t) if over_way else np.zeros(t.shape)
        value = np.zeros(t.shape)
        for n, (run, curve) in enumerate(zip(runs, curves, strict=True)):
            if curve is not None:
                ahead = (side or 1) * run.sense * motion.way
                # The end of a turn is not the beginning of the next.
                at = np.where(x < NEAR, 1.0, x) if motion.endless and ahead < 0 else x
                value = np.where(i == n, signs[n] * curve(at, ahead), value)
        return value

    jumps = []
    for i, run in enumerate(runs):
        before = runs[i - 1]
        if not motion.follows(i):
            jumps += [before.end, run.begin]
        elif motion.endless:
            jumps += [run.begin] if law(run.begin, -1) != law(run.begin, 1) else []
        elif run.stroke != before.stroke or not same[i - 1, i]:
            jumps.append(run.begin)
        table = tables[i]
        if table is not None:
            fractions = (*jumps_of(table), *((0.0,) if motion.endless and table[1][0] != table[1][-1] else ()))
            jumps += [at for fraction in fractions for at in motion.crossings(run, fraction)]
    return law, distinct((float(np.mod(t, motion.period)) for t in jumps), motion.period)


def angle_law(table: Table, period: float, smooth: bool = False) -> tuple[Callable[[Any, int], Any], tuple[float, ...]]:
    """Law over the angle turned from position 0, periodic, and the angles of its points."""
    return curve_of(table, smooth, period), distinct((float(np.mod(t, period)) for t in table[0]), period)
