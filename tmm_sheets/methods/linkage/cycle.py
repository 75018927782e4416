"""A cycle: numbered positions of the crank, its dead positions, and the strokes of the output point among them.

Dead positions of the group on the crank pin are constructed by ruler and compass (manual 000, section 3.1).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby
from math import tau
from typing import Any

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.arithmetic import root
from tmm_sheets.construction.expression import Floats, Reals, primitive
from tmm_sheets.construction.step import Given, Plan, Rule, Step, value_of
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups.contexts import SWEEP
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.numbers import NOISE, ROUNDING
from tmm_sheets.words import marked, tell, tr


@dataclass(frozen=True)
class Strokes:
    """Working stroke of the output point between its dead positions.

    ``begin`` and ``end`` are crank angles turned from position 0 in the sense of rotation, rad; ``path`` is the unit
    vector of the working stroke, ``length`` its length, m; ``origin`` the output point at its beginning. ``runs`` are the
    stretches between the reversals of the whole turn, the working stroke first.
    """

    output: str
    begin: float
    end: float
    path: complex
    length: float
    origin: complex
    runs: tuple[Run, ...]

    def working(self, turned: Reals, side: int = 0) -> Any:
        """True on the working stroke, at angles ``turned`` from position 0, rad, of any shape.

        In a dead position ``side`` says which of the strokes that meet there counts: -1 the one before, +1 the one after, 0 none.
        """
        t = np.mod(np.asarray(turned, dtype=float) - self.begin, 2 * np.pi)
        width = np.mod(self.end - self.begin, 2 * np.pi)
        near = 1e-12
        t = np.where(2 * np.pi - t < near, 0.0, t)
        return np.asarray(((t > near) | (side > 0)) & (t <= width + near if side < 0 else t < width - near))


def closed(labels: tuple[str, ...]) -> tuple[str, ...]:
    """Numbers of the positions with the one that closes the cycle: the next number, or the first again that has it."""
    first, *others = labels
    last = str(int(others[-1]) + 1) if others and others[-1].isdigit() else first
    return (*labels, first if last in others else last)


@dataclass(frozen=True)
class Cycle:
    """Numbered positions: angles ``turned`` from position 0 in the sense of rotation, world angles ``phi``, rad, shape (n,).

    ``plan`` constructs the dead positions, ``numbering`` has the crank angles as steps. ``swings`` is True for a crank that does
    not turn round: ``period`` is then the angle of its swing, from the first position to the last.
    """

    labels: tuple[str, ...]
    turned: Floats
    start: float
    sense: float
    period: float
    strokes: Strokes | None
    plan: Plan | None
    numbering: Plan
    swings: bool = False

    @property
    def ends(self) -> tuple[str, ...]:
        """Numbers along an axis over the cycle: those of the positions and the one that closes a turn; a swing ends at its last."""
        return self.labels if self.swings else closed(self.labels)

    @property
    def plans(self) -> dict[str, Plan]:
        """Dead positions, where they are constructed, and the crank angles of the positions."""
        return {plan.name: plan for plan in (self.plan, self.numbering) if plan is not None}

    def angles(self, turned: Any) -> Any:
        """World angles of the crank for angles turned from position 0: a step for the numbered positions, a row for others."""
        return self.numbering["φ"] if turned is self.turned else Given(self.world(turned), "crank angles", "φ_1", "rad")

    def turned_row(self, turned: Any) -> Any:
        """Angles turned from position 0: a step for the numbered positions, a row for others."""
        return self.numbering["φ_п"] if turned is self.turned else Given(turned, "angles turned", "φ", "rad")

    @property
    def ring(self) -> Floats:
        """Angles turned at which paths are drawn, rad: all round the turn, or over the swing."""
        return np.linspace(0, self.period if self.swings else 2 * np.pi, 181)

    @property
    def phi(self) -> Floats:
        """World angles of the crank, rad counter-clockwise, shape (n,); a whole multiple of the turn away from (-pi, pi]."""
        return np.asarray(self.world(self.turned), dtype=np.float64)

    @cached_property
    def drawn(self) -> tuple[tuple[int, str], ...]:
        """Positions of the first turn, each with its labels: a later turn repeats the plans of the first ("1, 9")."""
        found = []
        for i, t in enumerate(self.turned):
            if t < 2 * np.pi - 1e-9:
                same = [self.labels[j] for j in np.flatnonzero(np.abs(np.exp(1j * self.turned) - np.exp(1j * t)) < 1e-9)]
                found.append((i, ", ".join(sorted(same, key=int) if all(map(str.isdecimal, same)) else same)))
        return tuple(found)

    def world(self, turned: Reals) -> Any:
        """World angles of the crank for angles turned from position 0, rad, of any shape."""
        return self.start + self.sense * np.asarray(turned)

    def index(self, label: str, asked: str = "") -> int:
        """Number of the position with this label; ``asked`` says where it was asked for.

        Raises
        ------
        CannotBuild
            when no position has it.
        """
        try:
            return self.labels.index(label)
        except ValueError:
            raise CannotBuild(asked + tell("there is no position {label}").format(label=label),
                              tell("the positions are {labels}").format(labels=", ".join(self.labels))) from None


def dead_positions(m: Mechanism) -> tuple[Plan | None, tuple[Step, Step] | None]:
    """Dead positions as constructions of their own: their plan, m, and the two angles of the crank, rad.

    How they are constructed is known to the kind of the group on the crank pin; None where it has no such construction.
    """
    c = m.crank
    group = next((g for g in m.groups if c.pin in g.outer), None)
    if group is None:
        return None, None
    plan = Plan("dead-positions", tr("Dead positions"), "m")
    dead = group.kind.dead_positions(m, group, plan, plan.add(c.pivot, rules.GIVEN, m.fixed[c.pivot]))
    return (None, None) if dead is None else (plan, dead)


@primitive("angle turned to a point", "real")
def turned_about(centre: Any, pin: Any, start: Any, sense: Any) -> Any:
    """Angle from a direction to that from a centre to a point, in the sense of rotation, 0 to 360 degrees."""
    v = pin - centre
    return np.mod(sense * (np.arctan2(v.imag, v.real) - start), 2 * np.pi)


TURNED = Rule("angle turned to a place of the crank pin", turned_about, ("point", "point", "angle", "number"), "angle",
              marked("Angle turned from position 0 to {1} {name} = {value}."), unit="rad", source="001, (6)-(9)")


def named_angles(m: Mechanism, start: float, sense: float) -> Plan | None:
    """Crank angles φ_1k and φ_2k of the rocker on the crank pin (manual 001, formulas 6 to 9), turned from position 0, rad.

    Its dead positions if it swings; where it turns all round, the positions in which it is square to the line of the pivots.
    Steps ``A_1k``, ``A_2k`` and ``φ_1k``, ``φ_2k`` in the order in which they are reached; None without such a rocker.
    """
    c = m.crank
    group = next((g for g in m.groups if c.pin in g.outer and g.kind.rocker(g) is not None), None)
    pivot = group.outer[1] if group is not None and not group.offset and group.outer[1] in m.fixed else None
    if pivot is None or abs(m.fixed[pivot] - m.fixed[c.pivot]) in (0.0, c.length):
        return None
    plan = Plan("slot-angles", tr("Angles φ_1k and φ_2k of the crank"), "m")
    centre, far = (plan.add(name, rules.GIVEN, m.fixed[name]) for name in (c.pivot, pivot))
    if abs(far.value - centre.value) > c.length:
        rule: Rule = rules.TANGENT
        args: tuple[Any, ...] = (far, centre, c.length)
    else:
        across = plan.add(f"⟂{c.pivot}{pivot}", rules.PERPENDICULAR, centre, far)
        rule, args = rules.ARC_LINE, (centre, c.length, far, across)
    sides = sorted((1, -1), key=lambda side: float(
        turned_about(centre.value, rule.compute(*map(value_of, args), side), start, sense)))
    for k, side in enumerate(sides, 1):
        pin = plan.add(f"{c.pin}_{k}k", rule, *args, side, symbol=f"{c.pin}_{{{k}k}}")
        plan.add(f"φ_{k}k", TURNED, centre, pin, start, sense, symbol=f"φ_{{{k}k}}")
    return plan



SHALLOW = 0.01
"""Share of the greatest speed below which a minimum between the angles of the sweep may hide two reversals."""


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
        """The run, turned on by an angle and a number of strokes."""
        return replace(self, begin=self.begin + angle, end=self.end + angle, stroke=self.stroke + strokes)


def runs_of(speed: Callable[[Floats], Any], turn: float = tau) -> list[Run]:
    """Runs of one turn from the sign of a speed, a periodic function of the angles turned, rad, shape (n,) to shape (n,).

    One run if the output never turns back, none where the speed is not defined all the way round.
    """
    t = np.linspace(0.0, turn, SWEEP, endpoint=False)
    v = np.asarray(speed(t))
    if np.isnan(v).any():
        return []
    still = ROUNDING * float(np.abs(v).max())
    t, v = _with_dips(speed, t, v, still, turn)
    signs = np.where(np.abs(v) <= still, 0, np.sign(v)).astype(int).tolist()
    moving = [i for i, sign in enumerate(signs) if sign]
    if not moving:
        return [Run(0.0, turn, 0)]
    pairs = zip(moving, [*moving[1:], moving[0]], strict=True)
    ends: list[tuple[float, int]] = []  # where a run begins, and its sense
    for i, j in [(i, j) for i, j in pairs if signs[i] != signs[j] or (j - i) % len(t) != 1]:
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
    near = NOISE * (high - low)
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
        result.append(replace(runs[i], stroke=number, working=working[i]).later(tau * turned))
    return result


def working_stroke(runs: Iterable[Run]) -> tuple[float, float]:
    """Begin and end of the working stroke, of several the longest; there must be one."""
    strokes = [list(of) for _, of in groupby((r for r in runs if r.working), key=lambda r: r.stroke)]
    return max([(of[0].begin, of[-1].end) for of in strokes], key=lambda s: s[1] - s[0])


def over_cycle(runs: Sequence[Run], period: float, first: float = 0.0) -> tuple[Run, ...]:
    """The runs of one turn over all turns of the cycle, numbered from the stroke that begins nearest to ``first``, rad."""
    turns = round(period / tau)
    per_turn = runs[-1].stroke + 1
    every = [r.later(tau * n, per_turn * n) for n in range(turns) for r in runs]
    begins = [i for i, r in enumerate(every) if i == 0 or r.stroke != every[i - 1].stroke]
    start = min(begins, key=lambda i: abs(np.angle(np.exp(1j * (every[i].begin - first) * tau / period))))
    shift, strokes = every[start].stroke, per_turn * turns
    ordered = every[start:] + [r.later(period) for r in every[:start]]
    return tuple(replace(r, stroke=(r.stroke - shift) % strokes) for r in ordered)
