"""What explains a number that is not in order: something done otherwise, or a step drawn off, with all numbers as witnesses.

Discrete mistakes come first: each is drawn again (:mod:`~tmm_sheets.compare.diagnosis`), and of those that leave little of the
number's deviation the one that explains most of all numbers wins, two together where neither does alone. A displaced point is told
only where its displacement, of which nothing is known beforehand, explains more than any of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, groupby, pairwise
from math import isfinite
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.codes import Own
from tmm_sheets.compare.diagnosis.hypotheses import (
    KINDS,
    MIRRORED,
    TOLD,
    Change,
    Hypothesis,
    computed_with,
    displaced,
    hypotheses,
    of_other_positions,
)
from tmm_sheets.compare.measured.evidence import (
    CURVED,
    LOADS,
    MOSTLY,
    REACH,
    SEVERAL,
    Evidence,
    Explanation,
    Floats,
    JudgedValue,
    Mistake,
    Place,
    done_in,
    loss,
    place_of,
)
from tmm_sheets.construction.step import Step, value_at

T = TypeVar("T")


def wrong_rows(evidence: Evidence, i: int) -> Iterator[tuple[Hypothesis, Explanation]]:
    """What a number is off by when rows near it have the numbers of others; the smallest mistakes first."""
    judged = evidence.judged
    e = judged[i].entry
    if not e.terms:
        return
    alike = [n for n, j in enumerate(judged) if (j.entry.plan, j.entry.title, j.entry.kind, j.entry.unit) == (
        e.plan, e.title, e.kind, e.unit)]
    beside = [n for n in alike if judged[n].entry.label == e.label]
    along = [n for n in alike if judged[n].entry.quantity == e.quantity]
    for n in (*_next(beside, i), *_next(along, i)):
        yield from _written(evidence, i, {i: n, n: i}, "row", judged[n].row)
    labels = list(dict.fromkeys(judged[n].entry.label for n in alike))
    by_place = {(j.entry.label, j.entry.quantity): n for n, j in enumerate(judged)
                if (j.entry.plan, j.entry.title) == (e.plan, e.title)}
    for label in _next(labels, e.label):
        pairs = [(n, by_place[label, q]) for (at, q), n in by_place.items() if at == e.label and (label, q) in by_place]
        if len(pairs) > 1:
            yield from _written(evidence, i, {x: y for a, b in pairs for x, y in ((a, b), (b, a))}, "positions",
                                ", ".join(sorted((e.label, label), key=labels.index)))
    down, lengths = (sorted(some, key=lambda n: judged[n].line.line) for some in (range(len(judged)), alike))
    for rows, words in ((along, "position"), (lengths, "row"), (down, "row")):
        for of, which in ((dict(pairwise(rows[::-1])), "before"), (dict(pairwise(rows)), "after")):
            yield from _shifted(evidence, i, rows, of, f"{words} {which}")


def _next(some: Sequence[T], one: T) -> list[T]:
    """The neighbours of one of some."""
    at = some.index(one)
    return [*some[max(at - 1, 0):at], *some[at + 1:at + 2]]


def _shifted(evidence: Evidence, i: int, rows: Sequence[int], of: Mapping[int, int], words: str) -> Iterator[tuple[
        Hypothesis, Explanation]]:
    """That the rows round a number have, as far as that goes, the numbers of those before or after them."""
    for fits, block in groupby(rows, lambda n: n in of and _fits(evidence, n, of[n])):
        run = [*block]
        off = [k for k, n in enumerate(run) if _is_off(evidence, n)]
        # What is right where it stands has not been shifted.
        if fits and i in run and len(off) >= SEVERAL and off[0] <= run.index(i) <= off[-1]:
            run = run[off[0]:off[-1] + 1]
            # Where the column was cut the number of a row that is not there came in.
            (cut,) = {of[n] for n in run} - {*run}
            for h, found in _written(evidence, i, {n: of[n] for n in run}, words,
                                     f"{evidence.judged[run[0]].row} … {evidence.judged[run[-1]].row}"):
                found.shares[cut] = evidence.left[cut] if _is_off(evidence, cut) else found.shares[cut]
                yield h, found


def _written(evidence: Evidence, i: int, of: Mapping[int, int], words: str, other: str) -> Iterator[tuple[
        Hypothesis, Explanation]]:
    """That rows have the numbers of others; nothing where that leaves much of one of them, or the number was hardly off."""
    off = [n for n in of if _is_off(evidence, n)]
    if i in off and len(off) >= min(len(of), 2) and all(_fits(evidence, n, m) for n, m in of.items()):
        shares, doubt = np.zeros((2, len(evidence.judged)))
        for n, m in of.items():
            shares[n], doubt[n] = _meant(evidence, m) - _meant(evidence, n), evidence.allowed[m]
        score = sum(float(loss(evidence.left[n] / evidence.allowed[n]) - loss(_row_distance(evidence, n, m) / evidence.allowed[m]))
                    for n, m in of.items())
        h = Hypothesis("neighbour", words, evidence.judged[i].entry.terms[-1][0], (), other=Own(other))
        yield h, Explanation((), shares, doubt, score)


def _meant(evidence: Evidence, n: int) -> float:
    """The number that a row ought to have, with the mistakes found so far."""
    return evidence.judged[n].exact + evidence.judged[n].deviation - float(evidence.left[n])


def _row_distance(evidence: Evidence, n: int, m: int) -> float:
    """How far the number of a row is from that of another."""
    return evidence.judged[m].entry.off(evidence.judged[n].line.value, _meant(evidence, m))


def _is_off(evidence: Evidence, n: int) -> bool:
    return bool(abs(evidence.left[n]) > REACH * evidence.allowed[n])


def _fits(evidence: Evidence, n: int, m: int) -> bool:
    """Whether a row may well have the number of another."""
    return bool(np.isfinite(evidence.allowed[[n, m]]).all() and abs(_row_distance(evidence, n, m)) <= REACH * evidence.allowed[m])


ENOUGH = 16.0
"""What a mistake has to explain at the least: there are some hundreds, and one of so many explains a little by chance."""
EQUAL = 0.98
"""Share of the best discrete explanation with which another cannot be told from it."""
APART = 0.05
"""Share by which a scale factor is another one."""


def done_otherwise(evidence: Evidence, i: int) -> Explanation | None:
    """The discrete mistake that explains a number, with those that cannot be told from it."""
    alone = float(loss(evidence.left[i] / evidence.allowed[i]))
    found = [(h, evidence.replayed(h)) for h in mistakes_before(evidence, i) if evidence.leaves_little(i, h)]
    found += wrong_rows(evidence, i)
    best = max((e.score for _, e in found), default=0.0)
    if best <= MOSTLY * alone or (best < ENOUGH and evidence.judged[i].entry.kind != "sense"):
        return None
    # Of equally good ones the more usual first.
    equal = [_once_or_everywhere(evidence, h, e) for h, e in found if e.score >= EQUAL * best]
    best = max(e.score for _, e in equal)
    equal = [(h, e) for h, e in equal if e.score >= EQUAL * best]
    first = equal[0][1]
    return replace(first, wrong=tuple(h for h, _ in equal[:TOLD]))


def _once_or_everywhere(evidence: Evidence, h: Hypothesis, once: Explanation) -> tuple[Hypothesis, Explanation]:
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
    found = [*hypotheses(before, k, evidence.labels, evidence.whole), *_computed_with(evidence, i)]
    if j.entry.plan in MIRRORED:
        points = [s for s in evidence.whole if s.plan == j.entry.plan and s.rule.gives in ("point", "vector")]
        found += of_other_positions(points, k, evidence.labels)
    return sorted(found, key=lambda h: KINDS.index(h.kind))


def _computed_with(evidence: Evidence, i: int) -> Iterator[Hypothesis]:
    """That a result, and all others of its plan, was computed with another scale factor."""
    j = evidence.judged[i]
    of_plan = [s for s in evidence.whole if s.plan == j.entry.scale]
    if j.entry.kind == "result" and j.entry.reading and j.exact + evidence.predicted[i] and of_plan:
        times = float(j.line.value / (j.exact + evidence.predicted[i]))
        if times > 0 and abs(times - 1) > APART:
            yield computed_with(of_plan, times)


USUAL = 10.0
"""How far a misplaced point usually lies off, mm."""
DRAWN = ("point", "vector", "length", "ordinate")
"""What is off by millimetres; numbers and forces are off by a share of themselves."""
NEAR = 0.01
"""Displacement for derivatives where a mistake has led to, as a share of the usual one."""
TRIED = 4
"""Steps that are tried by drawing again, of those that explain most by the Jacobian."""
WITNESSED = 0.1
"""Share of what a displacement explains of the number it is looked for that it has to explain of others."""


def displaced_step(evidence: Evidence, i: int, most_is_wrong: bool = False) -> Explanation | None:
    """The displaced step behind a red number; None when it explains nothing else, or where the number is where it ought to be.

    A number within its tolerance may be red because it does not follow from the student's own: no step need be displaced for it.
    Where ``most_is_wrong`` only a step that explains half of all that is off is drawn again: of another variant there is none.
    """
    if abs(evidence.judged[i].deviation) <= evidence.judged[i].tolerance:
        return None
    possible = (_mistake(evidence, place) for place in evidence.places[i] if _can_be_wrong(evidence, place))
    least = float(np.sum(loss(evidence.left / evidence.allowed))) / 2 if most_is_wrong else 0.0
    candidates = sorted((m for m in possible if m.score >= least), key=lambda m: -m.score)
    candidates = [_mistake(evidence, m.place, exact=True) for m in candidates[:TRIED]]
    alone = float(loss(evidence.left[i] / evidence.allowed[i]))
    own = evidence.judged[i].entry.head
    good = [m for m in candidates if m.score > alone * MOSTLY and _explains_two(evidence, m, i)]
    if not good:
        return None
    best = max(m.score for m in good)
    near = [m for m in good if m.score >= MOSTLY * best]
    head = None if own is None else place_of(own, evidence.judged[i].at)
    # Of steps that explain equally well the one that was measured here, else one that was measured at all.
    m = max(near, key=lambda m: (m.place == head, m.place in evidence.heads, m.score))
    lines, gradient = evidence.by_place[m.place]
    shares, doubt = np.zeros((2, len(evidence.judged)))
    shares[lines] = _shares(evidence, m.place, m.moved)
    doubt[lines] = np.hypot(np.sqrt(np.einsum("ni,ij,nj->n", gradient, m.uncertain, gradient)), CURVED * np.abs(shares[lines]))
    return Explanation((moved(m.step, m.place, m.moved),), shares, doubt, m.score, mistake=m)


def _usual_size(evidence: Evidence, place: Place) -> npt.NDArray[np.float64]:
    """Of what no number sees nothing is told: mistakes are some millimetres, a number is not wrong by more than itself."""
    of = evidence.steps[place]
    mu = evidence.errors.scale(of) if of.rule.gives in DRAWN else 0.0
    return np.eye(2) / (USUAL * mu if mu else max(abs(complex(value_at(of, place[1]))), 1e-9))


def _mistake(evidence: Evidence, place: Place, exact: bool = False) -> Mistake:
    """The displacement of one step that explains most: least squares over all numbers that depend on it, green ones as well.

    Numbers that other mistakes have spoilt count as much less as they are off (P. J. Huber's weights). With ``exact`` the
    construction is drawn again with the displacement until that fits (Gauss and Newton's way), else the Jacobian will do.
    """
    x = np.zeros(2)
    lines, gradient = evidence.by_place[place]
    of, mu, usual = evidence.steps[place], evidence.errors.scale(evidence.steps[place]), _usual_size(evidence, place)
    rows, aims = gradient / evidence.allowed[lines, None], evidence.left[lines] / evidence.allowed[lines]
    best = Mistake(place, of, x, np.eye(2), 0.0, mu)
    for _ in range(6 if exact else 9):
        if exact and x.any():
            shares = _shares(evidence, place, x) / evidence.allowed[lines]
            near = np.linalg.inv(usual) * NEAR
            beside = [_shares(evidence, place, x + d) / evidence.allowed[lines] for d in near[:1 if not rows[:, 1].any() else 2]]
            rows = np.stack([(b - shares) / d[i] for i, (b, d) in enumerate(zip(beside, near, strict=False))], axis=-1)
            rows = rows if rows.shape[1] == 2 else np.concatenate((rows, 0 * rows), axis=1)
        else:
            shares = rows @ x
        if not (np.all(np.isfinite(shares)) and np.all(np.isfinite(rows))):
            break
        score = float(np.sum(loss(aims)) - np.sum(loss(aims - shares)) - np.sum((usual @ x) ** 2))
        if score > best.score:
            best = Mistake(place, of, x, covariance(rows, usual), score, mu)
        weights = 1 / np.sqrt(np.maximum(1, np.abs(aims - shares) / REACH))
        step, *_ = np.linalg.lstsq(np.concatenate((rows * weights[:, None], usual)),
                                   np.concatenate(((aims - shares) * weights, -usual @ x)), rcond=None)
        if np.abs(rows @ step).max() < 0.01:
            break
        x = x + step
    return best


def _can_be_wrong(evidence: Evidence, place: Place) -> bool:
    """False for what follows from the project file alone and was not written down: nobody has seen it wrong."""
    return place in evidence.heads or evidence.errors.error_at(evidence.steps[place], place[1]) > 0


def _explains_two(evidence: Evidence, mistake: Mistake, i: int) -> bool:
    """True when a mistake explains most of the number it was looked for, and of another one that is not in order.

    A little of much that other mistakes have spoilt explains nothing, nor does a great displacement that only one number shows.
    Of what is off against the student's own numbers only there is nothing to explain.
    """
    if np.hypot(*mistake.moved) < 2 * evidence.errors.pencil * mistake.mu:
        return False  # that is the pencil
    shares = _shares(evidence, mistake.place, mistake.moved)
    mostly = {j for j, share in zip(evidence.by_place[mistake.place][0].tolist(), shares, strict=True)
              if evidence.judged[j].verdict != "green" and abs(evidence.left[j] - share) < 0.5 * abs(evidence.left[j])}
    if not mostly - {i} or not (i in mostly or abs(evidence.left[i]) <= evidence.allowed[i]):
        return False
    lines = evidence.by_place[mistake.place][0]
    gain = loss(evidence.left[lines] / evidence.allowed[lines]) - loss(
        (evidence.left[lines] - shares) / evidence.allowed[lines])
    far = float(np.sum((_usual_size(evidence, mistake.place) @ mistake.moved) ** 2))
    return bool(gain[lines != i].sum() > max(far, WITNESSED * gain[lines == i].sum()))


def _shares(evidence: Evidence, place: Place, x: Floats) -> Floats:
    """What a displacement of a step makes of the numbers that depend on it, by drawing again."""
    value, lines = evidence.with_changes((moved(evidence.steps[place], place, x),)), evidence.by_place[place][0]
    return np.asarray([evidence.judged[i].changed(value) for i in lines] - evidence.predicted[lines])


def moved(step: Step, place: Place, x: Floats) -> Change:
    """A step at a position that is displaced."""
    return Change(step, displaced(complex(*x)), place[1] if np.ndim(step.value) else None)


def covariance(rows: Floats, usual: Floats) -> Floats:
    """Covariance of a displacement that ``rows`` of tolerance one and what is ``usual`` tell; (2, 2).

    The square of a very sensitive row would have no inverse in floating point.
    """
    inverse = np.linalg.pinv(np.concatenate((rows, usual)))
    return np.asarray(inverse @ inverse.T)


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
                if _explains_all(evidence, spoilt[:1], both) and _explains_all(evidence, spoilt, both):
                    yield first, second


def _in_one_plan(evidence: Evidence, i: int) -> Iterator[tuple[Hypothesis, Hypothesis]]:
    """Two mistakes in one plan; little may be left of everything that they reach in it."""
    at = evidence.judged[i].entry
    plan = _seen_in(evidence.judged[i])
    here = [n for n, j in enumerate(evidence.judged) if j.entry.label == at.label and isfinite(j.tolerance)
            and (_seen_in(j) == plan or (plan in LOADS and j.entry.plan.startswith("force-")))]
    if sum(_is_off(evidence, n) for n in here) < SEVERAL:
        return
    for first, second in _pairs(evidence, i, here):
        both = _both(first, second)
        if evidence.leaves_little(i, both) and _explains_all(evidence, here, both) and not any(
                _explains_all(evidence, here, h) for h in (first, second)):
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


def _explains_all(evidence: Evidence, lines: Sequence[int], h: Hypothesis) -> bool:
    """Whether all these numbers are nearly what they would be with a mistake."""
    shares = evidence.shares_of(h, lines)
    return all(isfinite(share) and abs(evidence.judged[n].apart(evidence.left[n] - share)) <= REACH * np.hypot(
        evidence.allowed[n], CURVED * share) for n, share in zip(lines, shares, strict=True))


def _seen_in(j: JudgedValue) -> str:
    """The plan that a number was measured in, or where its step is when it was computed."""
    return j.entry.terms[-1][0].plan if j.entry.kind in ("result", "sense") and j.entry.terms else j.entry.plan


def explanation(evidence: Evidence, i: int, most_is_wrong: bool = False) -> Explanation | None:
    """What explains a number best; None when nothing does: a slip in reading or computing this one."""
    done = done_otherwise(evidence, i)
    if done is not None:
        reached = np.abs(done.shares) > evidence.allowed
        alike = reached.copy()  # with all that a step drawn off may explain
        for place in evidence.places[i]:
            alike[evidence.by_place[place][0]] = True
        if reached.sum() > 1 and done.score > MOSTLY * float(np.sum(loss((evidence.left / evidence.allowed)[alike]))):
            return done  # nothing can explain much more
    off = displaced_step(evidence, i, most_is_wrong)
    best = off if done is None or (off is not None and off.score * MOSTLY > done.score) else done
    both = two_mistakes(evidence, i)
    if best is None or both is None:
        return best or both
    # A displacement that may be anything explains much of two mistakes; what it leaves is told by chance no more than one mistake.
    enough = max(MOSTLY * both.score, both.score - ENOUGH if best is off else 0.0)
    return best if best.score > enough else both
