"""A plan as it should be, and as it is with what was done wrong: pictures for the report on measured numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from tmm_sheets.compare.diagnosis.replay import Change, displaced, replay
from tmm_sheets.compare.measured.judged import JudgedValue
from tmm_sheets.compare.measured.measurable import Measurables
from tmm_sheets.compare.story import StoryPicture
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Plan, Step

SHOWS = 1.0
"""How far a line is off for a mistake to show in it, mm."""
WIDEST = 3.0
"""A plan that becomes so many times as large as it should be is not shown: nobody has so much paper."""


class PlanPictures:
    """Pictures of the plans behind the mistakes; ``errors`` are those the numbers were judged with."""

    def __init__(self, found: Measurables, errors: Errors) -> None:
        self.errors = errors
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
        exact, drawn = ([np.array([of[tail], of[head]]) for tail, head in lines] for of in (at, wrong))
        off = [now for was, now in zip(exact, drawn, strict=True) if np.abs(now - was).max() > SHOWS]
        head = start.entry.terms[-1][0]
        places = ((wrong[head], 0.03 * float(size), letter_of(head)),) if head in at else ()
        return StoryPicture(tuple(exact), tuple(drawn) if off else (), tuple(off), places)


def _changes(start: JudgedValue) -> Iterable[Change]:
    """What was done wrong, to be drawn again."""
    if start.wrong:
        return start.wrong[0].changes
    m = start.mistake
    return () if m is None else (Change(m.step, displaced(complex(*m.moved)), m.place[1] if np.ndim(m.step.value) else None),)


def _at(value: Any, k: int) -> complex:
    """A value at a position, or at all."""
    made = np.asarray(value)
    return complex(made[k] if made.ndim else made)
