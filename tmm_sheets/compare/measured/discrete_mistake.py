"""Something done otherwise: the discrete mistake that explains a number best, with those that cannot be told from it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import get_args

import numpy as np

from tmm_sheets.compare.diagnosis.hypotheses import (
    MIRRORED,
    Hypothesis,
    Kind,
    computed_with,
    hypotheses,
    of_other_positions,
)
from tmm_sheets.compare.measured.evidence import Evidence, Explanation, loss
from tmm_sheets.compare.measured.exchanged_rows import wrong_rows
from tmm_sheets.compare.measured.plan_scales import drawn_to, is_scaled, times_as_long

ALONE = 0.9
"""Share of the number it is looked for that a mistake has to explain, besides most of another one."""
ENOUGH = 16.0
"""What a mistake has to explain at the least: there are some hundreds, and one of so many explains a little by chance."""
EQUAL = 0.98
"""Share of the best discrete explanation with which another cannot be told from it."""
APART = 0.05
"""Share by which a scale factor is another one."""
TOLD = 3
"""Mistakes that are told of those that cannot be told apart."""
_KINDS = get_args(Kind)


def done_otherwise(evidence: Evidence, i: int) -> Explanation | None:
    """The discrete mistake that explains a number, with those that cannot be told from it."""
    alone = float(loss(evidence.left[i] / evidence.allowed[i]))
    found = [(h, evidence.replayed(h)) for h in mistakes_before(evidence, i) if evidence.leaves_little(i, h)]
    found += wrong_rows(evidence, i)
    best = max((e.score for _, e in found), default=0.0)
    if best <= ALONE * alone or (best < ENOUGH and evidence.judged[i].entry.kind != "sense"):
        return None
    # Of equally good ones the more usual first.
    equal = [_as_often(evidence, h, e) for h, e in found if e.score >= EQUAL * best]
    best = max(e.score for _, e in equal)
    equal = [(h, e) for h, e in equal if e.score >= EQUAL * best]
    first = equal[0][1]
    return replace(first, wrong=tuple(h for h, _ in equal[:TOLD]))


def _as_often(evidence: Evidence, h: Hypothesis, once: Explanation) -> tuple[Hypothesis, Explanation]:
    """A mistake made at one position, or at all of them where numbers at the others tell that."""
    if (often := h.at_every_position()) is None:
        return h, once
    always = evidence.replayed(often)
    rest = [np.where(np.isfinite(e.shares), evidence.after(e.shares), evidence.left) / np.hypot(evidence.allowed, e.doubt)
            for e in (once, always)]
    more = float(np.sum(loss(rest[0]) - loss(rest[1])))
    return (often, always) if min(more, always.score - once.score) > (1 - EQUAL) * once.score else (h, once)


def mistakes_before(evidence: Evidence, i: int, others: Sequence[int] = ()) -> list[Hypothesis]:
    """Mistakes that may have been made before a number, or before others of its position; the more usual kinds first."""
    j = evidence.judged[i]
    if not evidence.labels:
        return []
    before = evidence.made_of([step for n in (i, *others) for step, _, _ in evidence.judged[n].entry.terms])
    k = evidence.labels.index(j.entry.label) if j.entry.label in evidence.labels else 0
    found = [*hypotheses(before, k, evidence.labels, evidence.whole), *_computed_with(evidence, i), *_drawn_to(evidence, i)]
    if j.entry.plan in MIRRORED:
        points = [s for s in evidence.whole if s.plan == j.entry.plan and s.rule.gives in ("point", "vector")]
        found += of_other_positions(points, k, evidence.labels)
    return sorted(found, key=lambda h: _KINDS.index(h.kind))


def _computed_with(evidence: Evidence, i: int) -> Iterator[Hypothesis]:
    """That a result, and all others of its plan, was computed with another scale factor."""
    j = evidence.judged[i]
    of_plan = [s for s in evidence.whole if s.plan == j.entry.scale]
    if j.entry.kind == "result" and j.entry.reading and j.exact + evidence.predicted[i] and of_plan:
        times = float(j.line.value / (j.exact + evidence.predicted[i]))
        if times > 0 and abs(times - 1) > APART:
            yield computed_with(of_plan, times)


def _drawn_to(evidence: Evidence, i: int) -> Iterator[Hypothesis]:
    """That the plan of a length was drawn with another scale factor than stated."""
    if is_scaled(evidence.judged[i]):
        scale = evidence.judged[i].entry.scale
        of_plan = [n for n, j in enumerate(evidence.judged) if is_scaled(j) and j.entry.scale == scale]
        measured = np.array([evidence.judged[n].line.value for n in of_plan])
        expected = measured - (evidence.deviation - evidence.predicted)[of_plan]
        if (found := times_as_long(measured, expected, evidence.allowed[of_plan])) is not None:
            yield drawn_to(found[0] * evidence.drawn.get(scale, 1.0), evidence.judged[i].entry.terms[-1][0], scale)
