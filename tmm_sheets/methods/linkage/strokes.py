"""Strokes (ходы) of an output over one turn of the crank: where it turns back or stands still, working and idle strokes.

An output may turn back any number of times in one turn. Each *run* is a stretch in which it keeps its sense, or stands still.
A *working stroke* goes from one true extreme of the way to the other in the working sense: it begins where the output leaves the
lower extreme for the last time before the upper one, and ends where it first reaches the upper one. All the rest is idle, also a
smaller movement to and fro beside an extreme, or between two places of equal extreme way (a toggle that passes its straight
line), and a dwell in an extreme. Inside a stroke the output may go back for a while: what acts against the motion follows
the sense of each run, not that of the stroke.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

TURN = 2 * np.pi
SWEEP = 720
"""Angles per turn at which an output is looked at before its reversals are found exactly."""
STILL = 1e-12
"""Share of the greatest speed below which an output stands still: what is left of zero by rounding."""
SHALLOW = 0.01
"""Share of the greatest speed below which a minimum between the angles of the sweep may hide two reversals."""
EQUAL = 1e-9
"""Share of the way by which two extremes may differ and be the same one."""


@dataclass(frozen=True)
class Run:
    """From ``begin`` to ``end`` (rad turned from position 0, ``end`` > ``begin``) the output keeps its ``sense``.

    ``sense`` is +1 in the working sense, -1 against it, 0 while the output stands still; ``stroke`` the number of the stroke it
    is a part of, which is a ``working`` or an idle one.
    """

    begin: float
    end: float
    sense: int
    stroke: int = 0
    working: bool = False

    def later(self, angle: float, strokes: int = 0) -> Run:
        """The same run turned on by an angle and a number of strokes."""
        return replace(self, begin=self.begin + angle, end=self.end + angle, stroke=self.stroke + strokes)


def runs_of(speed: Callable[[Floats], Any], turn: float = TURN) -> list[Run]:
    """Runs of one turn from the sign of a speed, a periodic function of the angles turned, rad, shape (n,) to shape (n,).

    One run if the output never turns back, none where the speed is not defined all the way round.
    """
    t = np.linspace(0.0, turn, SWEEP, endpoint=False)
    v = np.asarray(speed(t))
    if np.isnan(v).any():
        return []
    still = STILL * float(np.abs(v).max())
    t, v = _with_dips(speed, t, v, still, turn)
    signs = np.where(np.abs(v) <= still, 0, np.sign(v)).astype(int).tolist()
    moving = [i for i, sign in enumerate(signs) if sign]
    if not moving:
        return [Run(0.0, turn, 0)]
    ends: list[tuple[float, int]] = []  # where a run begins, and its sense
    for i, j in zip(moving, [*moving[1:], moving[0]], strict=True):
        zeros = (j - i - 1) % len(t)
        after = [float(t[(i + k) % len(t)]) + turn * ((i + k) // len(t)) for k in range(zeros + 2)]
        if zeros > 1:
            ends.append((root(lambda x: still - np.abs(speed(x)), after[0], after[1]), 0))
            ends.append((root(lambda x: np.abs(speed(x)) - still, after[-2], after[-1]), signs[j]))
        elif signs[i] != signs[j]:
            ends.append((after[1] if zeros else root(speed, after[0], after[1]), signs[j]))
    if not ends:
        return [Run(0.0, turn, signs[moving[0]])]
    ends = sorted((float(np.mod(angle, turn)), sense) for angle, sense in ends)
    follow = [*(angle for angle, _ in ends[1:]), ends[0][0] + turn]
    return [Run(angle, end, sense) for (angle, sense), end in zip(ends, follow, strict=True)]


def _with_dips(speed: Callable[[Floats], Any], t: Floats, v: Floats, still: float, turn: float) -> tuple[Floats, Floats]:
    """The sweep with the angles added where the speed changes its sign twice between two of its angles."""
    size, before, after = np.abs(v), np.roll(v, 1), np.roll(v, -1)
    low = (size < SHALLOW * size.max()) & (size <= np.abs(before)) & (size <= np.abs(after))
    low &= (np.minimum(np.abs(before), np.abs(after)) > still) & (np.sign(before) == np.sign(after))
    extra: list[float] = []
    for i in np.flatnonzero(low):
        sign, best, step = np.sign(before[i]), float(t[i]), turn / len(t)
        for _ in range(4):
            x = best + step * np.linspace(-1, 1, 65)
            y = sign * np.asarray(speed(x))
            best, step = float(x[np.argmin(y)]), step / 16
            if y.min() < -still:
                extra.append(float(np.mod(best, turn)))
                break
    t = np.sort(np.append(t, extra))
    return (t, np.asarray(speed(t))) if extra else (t, v)


def in_strokes(runs: Sequence[Run], ways: Sequence[float] | Floats) -> list[Run]:
    """The runs of one turn with their strokes; ``ways``, one a run, m or rad, tell how far the output is where it begins.

    They are counted in the working sense.
    Runs without a way from one extreme to another are one idle stroke.
    """
    low, high = float(np.min(ways)), float(np.max(ways))
    near = EQUAL * (high - low)
    # The extremes in their order: each is the begin of a run.
    marks = [(k, +1 if way >= high - near else -1) for k, way in enumerate(ways) if way >= high - near or way <= low + near]
    working = [False] * len(runs)
    for (k, at), (n, to) in zip(marks, [*marks[1:], marks[0]], strict=True):
        if (at, to) == (-1, +1) and high > low:
            for i in range(k, n if n > k else n + len(runs)):
                working[i % len(runs)] = True
    # Begin with the run that begins a stroke, so that no stroke is cut in two.
    first = next((k for k in range(len(runs)) if working[k] != working[k - 1]), 0)
    order = [(i % len(runs), i // len(runs)) for i in range(first, first + len(runs))]
    result: list[Run] = []
    last: int | None = None
    number = -1
    for i, turned in order:
        number += last is None or working[i] != working[last]
        last = i
        result.append(replace(runs[i], stroke=number, working=working[i]).later(TURN * turned))
    return result


def working_stroke(runs: Iterable[Run]) -> tuple[float, float]:
    """Begin and end of the working stroke, of several the longest; there must be one."""
    strokes = [list(of) for _, of in groupby((r for r in runs if r.working), key=lambda r: r.stroke)]
    spans = [(of[0].begin, of[-1].end) for of in strokes]
    return max(spans, key=lambda s: s[1] - s[0])


def over_cycle(runs: Sequence[Run], period: float, first: float = 0.0) -> tuple[Run, ...]:
    """The runs of one turn over all turns of the cycle, numbered from the stroke that begins nearest to ``first``, rad."""
    turns = round(period / TURN)
    per_turn = runs[-1].stroke + 1
    every = [r.later(TURN * n, per_turn * n) for n in range(turns) for r in runs]
    begins = [i for i, r in enumerate(every) if i == 0 or r.stroke != every[i - 1].stroke]
    start = min(begins, key=lambda i: abs(np.angle(np.exp(1j * (every[i].begin - first) * TURN / period))))
    shift, strokes = every[start].stroke, per_turn * turns
    ordered = every[start:] + [r.later(period) for r in every[:start]]
    return tuple(replace(r, stroke=(r.stroke - shift) % strokes) for r in ordered)


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
