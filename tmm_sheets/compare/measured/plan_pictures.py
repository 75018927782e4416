"""A plan as it should be, as a student's own numbers make it, and as it is with what was done wrong: pictures for the report.

Measured lengths and directions fix the points of a plan one after another; all together they are adjusted by least squares, for a
hand draws and measures with errors. A point that too few numbers reach is left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy as np

from tmm_sheets.compare.diagnosis.replay import Change, displaced, replay
from tmm_sheets.compare.measured.judged import JudgedValue
from tmm_sheets.compare.measured.measurable import Measurables
from tmm_sheets.compare.story import StoryPicture
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.marks import Points

ROUNDS = 30
"""Rounds of the adjustment; it ends when nothing moves any more."""
AT_REST = 1e-6
"""Step of the adjustment below which nothing moves, mm."""
SHOWS = 1.0
"""How far a line is off for a mistake to show in it, mm."""
WIDEST = 3.0
"""A plan that becomes so many times as large as it should be is not shown: nobody has so much paper."""


@dataclass(frozen=True)
class _Tie:
    """A measured distance, mm, or direction, degrees, between two points, and its tolerance."""

    tail: Step
    head: Step
    value: float
    is_angle: bool
    tolerance: float


class PlanPictures:
    """Pictures of the plans behind the mistakes; ``errors`` are those the numbers were judged with."""

    def __init__(self, judged: Sequence[JudgedValue], found: Measurables, errors: Errors) -> None:
        self.judged, self.errors = judged, errors
        self.plans: Mapping[str, tuple[Plan, float]] = {
            plan.name: (plan, 1.0 if plan.unit == "mm" else found.scales[key].mu) for plan, key in found.plans}

    def picture(self, start: JudgedValue) -> StoryPicture | None:
        """The plan that a mistake shows in at its position; None where that is no plan of points."""
        plan, mu = self.plans.get(start.entry.plan, (None, 1.0))
        if plan is None or start.entry.kind not in ("length", "angle"):
            return None
        k = start.at
        lines = [(s.tail, s.head) for s in plan.segments] or [
            (s.args[0], s.args[1]) for s in plan if s.rule is rules.RAY and all(isinstance(a, Step) for a in s.args)]
        at = {s: _at(s.value, k) / mu for pair in lines for s in pair}
        if not at:
            return None
        changed = replay(self.errors, _changes(start))
        with np.errstate(all="ignore"):
            wrong = {s: _at(changed(s), k) / mu for s in at}
        size = np.ptp([z.real for z in at.values()]) + np.ptp([z.imag for z in at.values()])
        origin = next(iter(at.values()))
        if not all(np.isfinite(z) and abs(z - origin) < WIDEST * size for z in wrong.values()):
            wrong = at
        pole = plan[plan.pole] if plan.pole else next(iter(at))
        fixed = {s: at[s] for s in at if s is pole or (len(plan.labels) > 1 and not np.ndim(s.value))}
        drawn = laid_out(fixed, wrong, self._ties(start, at))
        off = [_line(wrong, pair) for pair in lines if np.abs(_line(wrong, pair) - _line(at, pair)).max() > SHOWS]
        head = start.entry.terms[-1][0]
        places = ((drawn.get(head, wrong[head]), 0.03 * float(size), letter_of(head)),) if head in at else ()
        return StoryPicture(tuple(_line(at, pair) for pair in lines),
                       tuple(_line(drawn, pair) for pair in lines if pair[0] in drawn and pair[1] in drawn), tuple(off), places)

    def _ties(self, start: JudgedValue, at: Mapping[Step, complex]) -> list[_Tie]:
        """Numbers of the plan at the position, as they are at our scale factor."""
        some = [j for j in self.judged if (j.entry.plan, j.entry.label) == (start.entry.plan, start.entry.label)
                and len(j.entry.terms) == 2 and (j.entry.is_distance or j.entry.is_way) and np.isfinite(j.tolerance)]
        return [_Tie(tail, head, j.line.value / j.size, j.entry.is_way, j.tolerance / j.size)
                for j in some for (tail, _, _), (head, _, _) in [j.entry.terms] if tail in at and head in at]


def _changes(start: JudgedValue) -> Iterable[Change]:
    """What was done wrong, to be drawn again."""
    if start.wrong:
        return start.wrong[0].changes
    m = start.mistake
    return () if m is None else (Change(m.step, displaced(complex(*m.moved)), m.place[1] if np.ndim(m.step.value) else None),)


def _line(at: Mapping[Step, complex], pair: tuple[Step, Step]) -> Points:
    return np.array([at[s] for s in pair])


def _at(value: Any, k: int) -> complex:
    """A value at a position, or at all."""
    made = np.asarray(value)
    return complex(made[k] if made.ndim else made)


def laid_out(fixed: Mapping[Step, complex], near: Mapping[Step, complex], ties: Sequence[_Tie]) -> dict[Step, complex]:
    """Where numbers put the points of a plan, beside ``near`` where they leave a choice; not those that too few of them reach."""
    known, grown = set(fixed), True
    while grown:
        reached: dict[Step, int] = {}
        for tie in ties:
            for here, there in ((tie.tail, tie.head), (tie.head, tie.tail)):
                if here in known and there not in known:
                    reached[there] = reached.get(there, 0) + 1
        found = {s for s, n in reached.items() if n > 1}
        known, grown = known | found, bool(found)
    free = [s for s in known if s not in fixed]
    used = [tie for tie in ties if tie.tail in known and tie.head in known]
    at = {**fixed, **{s: near[s] for s in free}}
    for _ in range(ROUNDS if free else 0):
        rows, off = np.zeros((len(used), 2 * len(free))), np.zeros(len(used))
        for n, tie in enumerate(used):
            off[n], gradient = _missed(tie, at)
            for s, sign in ((tie.tail, -1.0), (tie.head, 1.0)):
                if s not in fixed:
                    i = 2 * free.index(s)
                    rows[n, i:i + 2] += sign * np.array([gradient.real, gradient.imag])
        step: Any = np.linalg.lstsq(rows, off, rcond=1e-9)[0]
        for i, s in enumerate(free):
            at[s] += complex(step[2 * i], step[2 * i + 1])
        if np.abs(step).max() < AT_REST:
            break
    return at


def _missed(tie: _Tie, at: Mapping[Step, complex]) -> tuple[float, complex]:
    """By how many tolerances a number is missed, and how that grows with the head."""
    away = at[tie.head] - at[tie.tail] or 1e-9 + 0j
    if tie.is_angle:
        apart = (tie.value - np.degrees(np.angle(away)) + 180) % 360 - 180
        return apart / tie.tolerance, degrees(1) * 1j * away / abs(away) ** 2 / tie.tolerance
    return (tie.value - abs(away)) / tie.tolerance, away / abs(away) / tie.tolerance
