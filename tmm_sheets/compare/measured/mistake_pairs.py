"""Two mistakes that explain a number together and neither of them alone.

They are made in one plan, or one of them makes good what the other one would have spoilt: a sense that was turned round twice is
right, and proves of neither mistake that it was not made.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from math import isfinite

import numpy as np

from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.measured.discrete_mistake import ENOUGH, EQUAL, TOLD, mistakes_before
from tmm_sheets.compare.measured.evidence import CURVED, LEFT, LOADS, Evidence, Explanation, done_in
from tmm_sheets.compare.measured.judged import JudgedValue

RED, WITNESSES = 2.0, 3
"""Numbers of a plan and position, off by so many tolerances, without which two mistakes at once are not looked for."""


def two_mistakes(evidence: Evidence, i: int) -> Explanation | None:
    """The first of two discrete mistakes that explain a number together and neither of them alone.

    A displaced point cannot do that.
    """
    found = [(evidence.replayed(_both(first, second)), first, second)
             for pairs in (_in_one_plan, _made_good) for first, second in pairs(evidence, i)]
    best = max((e.score for e, _, _ in found), default=0.0)
    if best < 2 * ENOUGH:
        return None  # of so many pairs one explains more by chance
    equal = sorted((pair for pair in found if pair[0].score >= EQUAL * best), key=lambda pair: -pair[0].score)
    both, first, _ = equal[0]
    begun = evidence.replayed(first)
    # Those of other pairs, too: which two of them they were is not known then.
    seconds = tuple(dict.fromkeys(second for _, _, second in sorted(equal, key=lambda pair: pair[1] is not first)))
    then = replace(both, changes=seconds[0].changes, shares=both.shares - begun.shares, wrong=seconds[:TOLD])
    return replace(begun, score=best, wrong=tuple(dict.fromkeys(h for _, h, _ in equal))[:TOLD], then=then)


def _both(first: Hypothesis, second: Hypothesis) -> Hypothesis:
    return replace(first, changes=(*first.changes, *second.changes))


def _made_good(evidence: Evidence, i: int) -> Iterator[tuple[Hypothesis, Hypothesis]]:
    """Mistakes that explain a number but would spoil others, each with one that was made besides and leaves those as they are."""
    for first in mistakes_before(evidence, i):
        if not evidence.leaves_little(i, first):
            continue
        spoilt = sorted(evidence.replayed(first).spoils, key=lambda n: evidence.judged[n].order)
        if not spoilt:
            continue
        everywhere = len({evidence.judged[n].entry.label for n in spoilt}) > 1
        for h in mistakes_before(evidence, spoilt[0]):
            second = h.at_every_position() if everywhere else h
            if second is not None and second.kind not in (first.kind, "neighbour") and second.step is not first.step:
                both = _both(first, second)
                if _leaves_little_of(evidence, spoilt[:1], both) and _leaves_little_of(evidence, spoilt, both):
                    yield first, second


def _in_one_plan(evidence: Evidence, i: int) -> Iterator[tuple[Hypothesis, Hypothesis]]:
    """Two mistakes in one plan; little may be left of everything that they reach in it."""
    at = evidence.judged[i].entry
    plan = _seen_in(evidence.judged[i])
    here = [n for n, j in enumerate(evidence.judged) if j.entry.label == at.label and isfinite(j.tolerance)
            and (_seen_in(j) == plan or (plan in LOADS and j.entry.plan.startswith("force-")))]
    if sum(abs(evidence.left[n]) > RED * evidence.allowed[n] for n in here) < WITNESSES:
        return
    for first, second in _pairs(evidence, i, here):
        both = _both(first, second)
        if evidence.leaves_little(i, both) and _leaves_little_of(evidence, here, both) and not any(
                _leaves_little_of(evidence, here, h) for h in (first, second)):
            yield first, second


def _pairs(evidence: Evidence, i: int, here: Sequence[int]) -> Iterator[tuple[Hypothesis, Hypothesis]]:
    """Two mistakes in the plan of some numbers, in the order of drawing, of which one at least reaches number ``i``."""
    plans = {_seen_in(evidence.judged[n]) for n in (i, *here)}
    some = [h for h in mistakes_before(evidence, i, here) if h.kind != "neighbour" and any(done_in(h, plan) for plan in plans)]
    some.sort(key=lambda h: evidence.errors.order(h.step))
    before = set(evidence.made_of([step for step, _, _ in evidence.judged[i].entry.terms]))
    reaching = [any(change.step in before for change in h.changes) for h in some]
    alone = [reaches and evidence.leaves_little(i, h) for h, reaches in zip(some, reaching, strict=True)]
    for a, b in combinations(range(len(some)), 2):
        # Where one of them does not reach the number the other explains it alone.
        if ((reaching[a] and reaching[b]) or alone[a] or alone[b]) and some[a].step is not some[b].step and (
                some[a].kind != some[b].kind):
            yield some[a], some[b]


def _leaves_little_of(evidence: Evidence, lines: Sequence[int], h: Hypothesis) -> bool:
    """Whether all these numbers are nearly what they would be with a mistake."""
    shares = evidence.shares_of(h, lines)
    return all(isfinite(share) and abs(evidence.judged[n].apart(evidence.left[n] - share)) <= LEFT * np.hypot(
        evidence.allowed[n], CURVED * share) for n, share in zip(lines, shares, strict=True))


def _seen_in(j: JudgedValue) -> str:
    """The plan that a number was measured in, or where its step is when it was computed."""
    return j.entry.terms[-1][0].plan if j.entry.kind in ("result", "sense") and j.entry.terms else j.entry.plan
