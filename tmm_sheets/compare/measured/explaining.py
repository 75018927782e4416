"""What explains a number that is not in order: something done otherwise, or a step drawn off, with all numbers as witnesses.

Discrete mistakes come first: each is drawn again (:mod:`~tmm_sheets.compare.diagnosis`), and of those that leave little of the
number's deviation the one that explains most of all numbers wins. A displaced point is told only where its displacement, of which
nothing is known beforehand, explains more than any of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from math import isfinite
from typing import Any, get_args

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis, Kind, computed_with, hypotheses
from tmm_sheets.compare.diagnosis.replay import Again, Change, displaced, replay
from tmm_sheets.compare.measured.judged import Judged, Mistake, Place
from tmm_sheets.compare.measured.plan_scales import drawn_to, is_scaled, times_as_long
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.step import Step, ordered, value_at
from tmm_sheets.numbers import told

Floats = npt.NDArray[np.float64]
CURVED = 0.05
"""Share of what a mistake explains that may be off: its displacement is not known better."""
USUAL = 10.0
"""How far a misplaced point usually lies off, mm."""
HUBER = 2.0
"""Deviation in tolerances beyond which a number counts as spoilt rather than as scattered."""
ALONE = 0.9
"""Share of the number it is looked for that a mistake has to explain, besides most of another one."""
DRAWN = ("point", "vector", "length", "ordinate")
"""What is off by millimetres; numbers and forces are off by a share of themselves."""
NEAR = 0.01
"""Displacement for derivatives where a mistake has led to, as a share of the usual one."""
TRIED = 4
"""Steps that are tried by drawing again, of those that explain most by the Jacobian."""
NEARLY = 0.9
"""Share of the best explanation with which another is as good."""
EQUAL = 0.98
"""Share of the best discrete explanation with which another cannot be told from it."""
LEFT = 2.0
"""Tolerances that a discrete mistake may leave of the number it is looked for."""
CHANCES = 8
"""Drawings by chance that tell how uncertain a number has become."""
LOADS = ("loads", "moments")
"""Plans that are seen in the polygons of forces."""
RED, WITNESSES = 2.0, 3
"""Numbers of a plan and position, off by so many tolerances, without which two mistakes at once are not looked for."""
SPOILT = 3.0
"""Tolerances by which a discrete mistake would spoil a number that it cannot have been made before when that is in order."""
APART = 0.05
"""Share by which a scale factor is another one."""
TOLD = 3
"""Mistakes that are told of those that cannot be told apart."""


_KINDS = get_args(Kind)


@dataclass(frozen=True)
class Explanation:
    """What was done wrong and what it makes of the numbers.

    Attributes
    ----------
    changes : to be replayed
    drawn : plans that are so many times as large, by their scale factors
    shares, doubt : what it makes of each number, and how well that is known; in the unit of the number
    score : how much of all deviations it explains
    wrong : discrete mistakes that are equally good, the first of them is told
    mistake : a displaced step where it is none of these
    then : another discrete mistake in the same plan, without which this one explains nothing; shares when this one is known
    """

    changes: tuple[Change, ...]
    shares: Floats
    doubt: Floats
    score: float
    wrong: tuple[Hypothesis, ...] = ()
    mistake: Mistake | None = None
    then: Explanation | None = None
    drawn: tuple[tuple[str, float], ...] = ()


class Sheet:
    """All judged numbers together: what is left of their deviations, and which steps each depends on.

    ``labels`` are those of the positions of the linkage.
    """

    def __init__(self, judged: list[Judged], errors: Errors, labels: Sequence[str]) -> None:
        self.judged = judged
        self.errors = errors
        self.labels = labels
        self.deviation = np.array([j.deviation for j in judged])
        self.left = self.deviation.copy()
        self.tolerance = np.array([j.tolerance for j in judged])
        self.changes: list[Change] = []
        self.drawn: dict[str, float] = {}
        self._made: dict[int, dict[Step, None]] = {}
        self.predicted = np.zeros(len(judged))
        self.steps: dict[Place, Step] = {}
        self.heads: set[Place] = set()
        gradients: dict[Place, dict[int, complex]] = {}
        for i, j in enumerate(judged):
            if j.entry.head is not None:
                self.heads.add(_place(j.entry.head, j.at))
            for step, k, g in j.rows:
                if g and isfinite(abs(g)):
                    place = _place(step, k)
                    self.steps[place] = step
                    gradients.setdefault(place, {})[i] = g
        self.by_place = {place: (np.array(list(of)), np.array([[g.real, g.imag] for g in of.values()]))
                         for place, of in gradients.items()}
        self.places = [[_place(step, k) for step, k, g in j.rows if g and isfinite(abs(g))] for j in judged]

    def explanation(self, i: int) -> Explanation | None:
        """What explains a number best; None when nothing does: a slip in reading or computing this one."""
        done = self._otherwise(i)
        if done is not None:
            reached = np.abs(done.shares) > self.allowed
            alike = reached.copy()  # with all that a step drawn off may explain
            for place in self.places[i]:
                alike[self.by_place[place][0]] = True
            if reached.sum() > 1 and done.score > NEARLY * float(np.sum(_loss((self.left / self.allowed)[alike]))):
                return done  # nothing can explain much more
        off = self._displaced(i)
        best = off if done is None or (off is not None and off.score * NEARLY > done.score) else done
        both = self._together(i)
        return best if both is None or (best is not None and best.score > NEARLY * both.score) else both

    def accept(self, found: Explanation) -> None:
        """Go on with what is left when a mistake is known."""
        self.changes += found.changes
        self.drawn |= dict(found.drawn)
        if found.changes or found.drawn:
            self.predicted += np.where(np.isfinite(found.shares), found.shares, 0.0)
        else:
            self.deviation -= found.shares  # only written wrongly
        self.__dict__.pop("allowed", None)

    def reached(self, found: Explanation, i: int) -> bool:
        """Whether a number depends on what was done wrong, also where that happens to leave it as it is."""
        return bool(found.shares[i]) or any(change.step in self._before(i) for change in found.changes)

    def after(self, shares: Floats, lines: Sequence[int] | None = None) -> Floats:
        """What is left of all numbers, or of some, when a further mistake makes ``shares`` of them.

        A number that the mistakes before did not reach, because it was gone on with otherwise, may follow from all together.
        """
        of = range(len(self.judged)) if lines is None else lines
        left, whole = (np.array([self.judged[i].apart(float(x)) for i, x in zip(of, differences[of] - shares, strict=True)])
                       for differences in (self.left, self.deviation - self.predicted))
        return np.where(np.abs(whole) < np.abs(left), whole, left)

    def uncertain(self, i: int, left: float) -> bool:
        """Whether a number may be anything with the mistakes found so far: the direction of a vector that has become short."""
        return bool(self.allowed[i] > self.tolerance[i] and abs(left) <= LEFT * self.allowed[i])

    @cached_property
    def allowed(self) -> Floats:
        """Tolerances with the mistakes found so far.

        A tolerance holds for what is drawn rightly; here the drawing with the mistakes is made several times by chance.
        """
        if not self.changes:
            return self.tolerance
        drawn = [s for s in self.whole if s.rule.gives != "direction" and self.errors.own(s).any()]
        spread = np.zeros(len(self.judged))
        for chance in range(CHANCES):
            rng = np.random.default_rng(chance)
            value = self._with([self._by_chance(s, rng) for s in drawn])
            off = [j.apart(self._changed(j, value) - float(self.predicted[i])) for i, j in enumerate(self.judged)]
            spread = np.fmax(spread, np.abs(off))
        return np.where(np.isfinite(spread) & (spread > LEFT * self.tolerance), spread, self.tolerance)

    def _by_chance(self, step: Step, rng: np.random.Generator) -> Change:
        """A step with a pencil's error by chance; what is kept nineteen times of twenty is two standard deviations."""
        own = np.nan_to_num(self.errors.own(step))
        off = (own @ rng.normal(0, 0.5, (len(own), 2, 1)))[:, :, 0]

        def done(again: Again, values: Sequence[Any]) -> Any:
            made = np.asarray(again(*values))
            by = off[:, 0] + 1j * off[:, 1] if made.dtype.kind == "c" else off[:, 0]
            return made + (by if made.ndim else by[0])

        return Change(step, done)

    def _before(self, i: int) -> dict[Step, None]:
        """Steps of the linkage that a number goes back to."""
        if i not in self._made:
            made = self._made_of([step for step, _, _ in self.judged[i].entry.terms])
            self._made[i] = {s: None for s in made if s.rule.gives != "direction" and self.errors.own(s).any()}
        return self._made[i]

    # --- something done otherwise -----------------------------------------------------------------------------------------
    def _otherwise(self, i: int) -> Explanation | None:
        """The discrete mistake that explains a number, with those that cannot be told from it."""
        alone = float(_loss(self.left[i] / self.allowed[i]))
        found = [(h, self._drawn(h)) for h in self._hypotheses(i) if self._leaves_little(i, h)]
        found += self._exchanged(i)
        best = max((e.score for _, e in found), default=0.0)
        if best <= ALONE * alone:
            return None
        # Of equally good ones the more usual first.
        equal = [self._as_often(h, e) for h, e in found if e.score >= EQUAL * best]
        best = max(e.score for _, e in equal)
        equal = [(h, e) for h, e in equal if e.score >= EQUAL * best]
        first = equal[0][1]
        return replace(first, wrong=tuple(h for h, _ in equal[:TOLD]))

    def _as_often(self, h: Hypothesis, once: Explanation) -> tuple[Hypothesis, Explanation]:
        """A mistake made at one position, or at all of them where numbers at the others tell that."""
        if (often := h.at_every_position()) is None:
            return h, once
        always = self._drawn(often)
        rest = [np.where(np.isfinite(e.shares), self.after(e.shares), self.left) / np.hypot(self.allowed, e.doubt)
                for e in (once, always)]
        more = float(np.sum(_loss(rest[0]) - _loss(rest[1])))
        return (often, always) if min(more, always.score - once.score) > (1 - EQUAL) * once.score else (h, once)

    def _exchanged(self, i: int) -> Iterator[tuple[Hypothesis, Explanation]]:
        """That a number and that in the next row were written into each other's rows."""
        e = self.judged[i].entry
        alike = [n for n, j in enumerate(self.judged) if (j.entry.plan, j.entry.label, j.entry.kind, j.entry.unit) == (
            e.plan, e.label, e.kind, e.unit)]
        at = alike.index(i)
        for n in alike[max(at - 1, 0):at] + alike[at + 1:at + 2]:
            between = self.judged[i].line.value - self.left[i] - self.judged[n].line.value + self.left[n]
            shares = np.zeros(len(self.judged))
            shares[[i, n]] = -between, between
            before = self.left[[i, n]] / self.allowed[[i, n]]
            after = [self.judged[m].apart(self.left[m] - shares[m]) for m in (i, n)] / self.allowed[[n, i]]
            if e.terms and np.all(np.abs(before) > LEFT) and np.all(np.abs(after) <= LEFT):
                other = self.judged[n].entry
                place = f"({other.label}) " if other.label else ""
                h = Hypothesis("neighbour", "row", e.terms[-1][0], (), other=f"{place}{other.quantity}")
                yield h, Explanation((), shares, np.zeros(len(shares)), float(np.sum(_loss(before) - _loss(after))))

    def _together(self, i: int) -> Explanation | None:
        """The first of two discrete mistakes in one plan that explain a number together and neither of them alone.

        Little may be left of everything they reach in that plan; a displaced point cannot do that.
        """
        at = self.judged[i].entry
        plan = _seen_in(self.judged[i])
        here = [n for n, j in enumerate(self.judged) if j.entry.label == at.label and isfinite(j.tolerance)
                and (_seen_in(j) == plan or (plan in LOADS and j.entry.plan.startswith("force-")))]
        if sum(abs(self.left[n]) > RED * self.allowed[n] for n in here) < WITNESSES:
            return None
        found = []
        for first, second in self._pairs(i, here):
            both = replace(first, changes=(*first.changes, *second.changes))
            if self._leaves_little(i, both) and self._leaves_little_of(here, both) and not any(
                    self._leaves_little_of(here, h) for h in (first, second)):
                found.append((self._drawn(both), first, second))
        best = max((e.score for e, _, _ in found), default=0.0)
        if best <= 0:
            return None
        equal = sorted((pair for pair in found if pair[0].score >= EQUAL * best), key=lambda pair: -pair[0].score)
        both_, first, _ = equal[0]
        begun = self._drawn(first)
        # Those of other pairs, too: which two of them they were is not known then.
        seconds = tuple(dict.fromkeys(second for _, _, second in sorted(equal, key=lambda pair: pair[1] is not first)))
        then = replace(both_, changes=seconds[0].changes, shares=both_.shares - begun.shares, wrong=seconds[:TOLD])
        return replace(begun, score=best, wrong=tuple(dict.fromkeys(h for _, h, _ in equal))[:TOLD], then=then)

    def _pairs(self, i: int, here: Sequence[int]) -> Iterator[tuple[Hypothesis, Hypothesis]]:
        """Two mistakes in the plan of some numbers, in the order of drawing, of which one at least reaches number ``i``."""
        plans = {_seen_in(self.judged[n]) for n in (i, *here)}
        some = [h for h in self._hypotheses(i, here) if h.kind != "neighbour" and any(_done_in(h, plan) for plan in plans)]
        some.sort(key=lambda h: self.errors.order(h.step))
        before = set(self._made_of([step for step, _, _ in self.judged[i].entry.terms]))
        reaching = [any(change.step in before for change in h.changes) for h in some]
        alone = [reaches and self._leaves_little(i, h) for h, reaches in zip(some, reaching, strict=True)]
        for a, b in combinations(range(len(some)), 2):
            # Where one of them does not reach the number the other explains it alone.
            if ((reaching[a] and reaching[b]) or alone[a] or alone[b]) and some[a].step is not some[b].step and (
                    some[a].kind != some[b].kind):
                yield some[a], some[b]

    def _leaves_little_of(self, lines: Sequence[int], h: Hypothesis) -> bool:
        """Whether all these numbers are nearly what they would be with a mistake."""
        shares = self._shares(h, lines)
        return all(isfinite(share) and abs(self.judged[n].apart(self.left[n] - share)) <= LEFT * np.hypot(
            self.allowed[n], CURVED * share) for n, share in zip(lines, shares, strict=True))

    def _hypotheses(self, i: int, others: Sequence[int] = ()) -> list[Hypothesis]:
        """Mistakes that may have been made before a number, or before others of its position; the more usual kinds first."""
        j = self.judged[i]
        if not self.labels:
            return []
        before = self._made_of([step for n in (i, *others) for step, _, _ in self.judged[n].entry.terms])
        k = self.labels.index(j.entry.label) if j.entry.label in self.labels else 0
        found = [*hypotheses(before, k, self.labels, self.whole), *self._computed_with(i), *self._drawn_to(i)]
        return sorted(found, key=lambda h: _KINDS.index(h.kind))

    def _made_of(self, steps: Sequence[Step]) -> list[Step]:
        """Steps with all that they were made of on paper."""
        return list(ordered(steps, lambda step: [a for a in self.errors.arguments(step) if isinstance(a, Step)]))

    @cached_property
    def whole(self) -> list[Step]:
        """All steps that any number goes back to."""
        return self._made_of([step for j in self.judged for step, _, _ in j.entry.terms])

    def _computed_with(self, i: int) -> Iterator[Hypothesis]:
        """That a result, and all others of its plan, was computed with another scale factor."""
        j = self.judged[i]
        of_plan = [s for s in self.whole if s.plan == j.entry.scale]
        if j.entry.kind == "result" and j.entry.reading and j.exact + self.predicted[i] and of_plan:
            times = float(j.line.value / (j.exact + self.predicted[i]))
            if times > 0 and abs(times - 1) > APART:
                yield computed_with(of_plan, times, told(f"{times:.3g}"))

    def _drawn_to(self, i: int) -> Iterator[Hypothesis]:
        """That the plan of a length was drawn with another scale factor than stated."""
        if is_scaled(self.judged[i]):
            scale = self.judged[i].entry.scale
            of_plan = [n for n, j in enumerate(self.judged) if is_scaled(j) and j.entry.scale == scale]
            measured = np.array([self.judged[n].line.value for n in of_plan])
            expected = measured - (self.deviation - self.predicted)[of_plan]
            if (found := times_as_long(measured, expected, self.allowed[of_plan])) is not None:
                yield drawn_to(found[0] * self.drawn.get(scale, 1.0), self.judged[i].entry.terms[-1][0], scale)

    def _leaves_little(self, i: int, h: Hypothesis) -> bool:
        """Whether a number is nearly what it would be with a mistake, and would not be so without.

        A neighbour's number is hardly another one: it is seen where it was taken, farther on it would be a guess.
        """
        at = [step for step, _, _ in self.judged[i].entry.terms]
        if h.kind == "neighbour" and not any(h.step is s for step in at for s in (step, *step.args)):
            return False
        share = self._shares(h, [i])[0]
        left, allowed = self.after(share, [i])[0], np.hypot(self.allowed[i], CURVED * share)
        return bool(isfinite(share) and abs(share) > self.allowed[i] and abs(left) <= LEFT * allowed)

    def _drawn(self, h: Hypothesis) -> Explanation:
        """The construction with a mistake, held against all numbers."""
        shares = self._shares(h, range(len(self.judged)))
        doubt = CURVED * np.abs(shares)
        # With what cannot be drawn any more nothing is explained.
        known = np.isfinite(shares) & np.isfinite(self.allowed)
        left = self.left[known] / self.allowed[known]
        after = self.after(shares)[known] / np.hypot(self.allowed, doubt)[known]
        gain = _loss(left) - _loss(after)
        # Results are computed from lengths, whatever their senses: what is not spoilt in them proves nothing.
        proves = np.array([self.proves(j, h) for j in self.judged])[known]
        score = float(np.sum(np.where(proves, gain, np.maximum(gain, 0.0))))
        # However much it explains besides: what is in order was not spoilt.
        if np.any(proves & (np.abs(left) <= 1) & (np.abs(after) > SPOILT)):
            score = 0.0
        return Explanation(h.changes, shares, np.where(np.isfinite(doubt), doubt, 0.0), score, drawn=h.drawn)

    @staticmethod
    def proves(j: Judged, h: Hypothesis) -> bool:
        """Whether a number that is in order proves that something was not done: it shows where that was done.

        Further on it may have been gone on with otherwise, by lengths without their senses.
        """
        if _done_in(h, j.entry.plan):
            return True
        # A neighbour's number may have been taken without its sense.
        return any(step is h.step for step, _, _ in j.entry.terms) and not (h.kind == "neighbour" and j.entry.kind == "sense")

    def _shares(self, h: Hypothesis, lines: Sequence[int]) -> Floats:
        """What a discrete mistake makes of some numbers."""
        value = self._with(h.changes)
        return np.array([0.0 if j.entry.kind != "result" and j.entry.plan == h.on_paper else
                         self._changed(j, value, h.drawn) - self.predicted[i] for i, j in ((i, self.judged[i]) for i in lines)])

    def _changed(self, j: Judged, value: Callable[[Step], Any], drawn: Sequence[tuple[str, float]] = ()) -> float:
        """How much a number changes in a drawing, and by the scale factors of its plan that were found so far or are given."""
        times = dict(drawn).get(j.entry.scale, self.drawn.get(j.entry.scale, 1.0)) if is_scaled(j) else 1.0
        return times * (j.exact + j.changed(value)) - j.exact

    def _with(self, changes: Sequence[Change]) -> Any:
        """The construction with the mistakes found so far and further ones."""
        return replay(self.errors, [*self.changes, *changes])

    # --- a step drawn off -------------------------------------------------------------------------------------------------
    def _displaced(self, i: int) -> Explanation | None:
        """The displaced step behind a red number; None when it explains nothing else."""
        candidates = sorted((self.mistake(place) for place in self.places[i] if self.can_be_wrong(place)), key=lambda m: -m.score)
        candidates = [self.mistake(m.place, exact=True) for m in candidates[:TRIED]]
        alone = float(_loss(self.left[i] / self.allowed[i]))
        own = self.judged[i].entry.head
        good = [m for m in candidates if m.score > alone * ALONE and self.helps(m, i)]
        if not good:
            return None
        best = max(m.score for m in good)
        near = [m for m in good if m.score >= NEARLY * best]
        head = None if own is None else _place(own, self.judged[i].at)
        # Of steps that explain equally well the one that was measured here, else one that was measured at all.
        m = max(near, key=lambda m: (m.place == head, m.place in self.heads, m.score))
        lines, gradient = self.by_place[m.place]
        shares, doubt = np.zeros((2, len(self.judged)))
        shares[lines] = self.shares(m.place, m.moved)
        doubt[lines] = np.hypot(np.sqrt(np.einsum("ni,ij,nj->n", gradient, m.uncertain, gradient)), CURVED * np.abs(shares[lines]))
        return Explanation((self._change(m.place, m.moved),), shares, doubt, m.score, mistake=m)

    def mistake(self, place: Place, exact: bool = False) -> Mistake:
        """The displacement of one step that explains most: least squares over all numbers that depend on it, green ones as well.

        Numbers that other mistakes have spoilt count as much less as they are off (P. J. Huber's weights). With ``exact`` the
        construction is drawn again with the displacement until that fits (Gauss and Newton's way), else the Jacobian will do. A
        point that nearly rests moves its speed alike to both sides: the search begins also with what its own plan alone tells. A
        vector that became longer than it is may point anywhere now: then it begins on all sides.
        """
        begins = [np.zeros(2)]
        if exact:
            begins += [*self._by_own_plan(place), *self._all_round(place)]
        return max((self._descended(place, x, exact) for x in begins), key=lambda m: m.score)

    def _by_own_plan(self, place: Place) -> Iterator[Floats]:
        """The displacement that the numbers of the step's own plan tell, where there are others."""
        lines, gradient = self.by_place[place]
        here = np.array([self.judged[i].entry.plan == self.steps[place].plan for i in lines])
        if here.all() or not here.any():
            return
        rows, aims = (gradient / self.allowed[lines, None])[here], (self.left[lines] / self.allowed[lines])[here]
        usual = self._usual(place)
        begin, *_ = np.linalg.lstsq(np.concatenate((rows, usual)), np.concatenate((aims, np.zeros(2))), rcond=None)
        yield begin

    def _all_round(self, place: Place) -> Iterator[Floats]:
        """Displacements to four sides, as long as a vector became that was shorter."""
        lines, gradient = self.by_place[place]
        longer = [float(self.left[i] / np.hypot(*g)) for i, g in zip(lines, gradient, strict=True)
                  if (self.judged[i].entry.is_distance or self.judged[i].entry.is_size)
                  and self.left[i] > max(abs(self.judged[i].exact), self.judged[i].tolerance)]
        if longer:
            yield from max(longer) * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])

    def _usual(self, place: Place) -> npt.NDArray[np.float64]:
        """Of what no number sees nothing is told: mistakes are some millimetres, a number is not wrong by more than itself."""
        of = self.steps[place]
        mu = self.errors.scale(of) if of.rule.gives in DRAWN else 0.0
        return np.eye(2) / (USUAL * mu if mu else max(abs(complex(value_at(of, place[1]))), 1e-9))

    def _descended(self, place: Place, x: npt.NDArray[np.float64], exact: bool) -> Mistake:
        """The best displacement that the search finds when it begins with ``x``."""
        lines, gradient = self.by_place[place]
        of, mu, usual = self.steps[place], self.errors.scale(self.steps[place]), self._usual(place)
        rows, aims = gradient / self.allowed[lines, None], self.left[lines] / self.allowed[lines]
        best = Mistake(place, of, x, np.eye(2), 0.0, mu)
        for _ in range(6 if exact else 9):
            if exact and x.any():
                shares = self.shares(place, x) / self.allowed[lines]
                near = np.linalg.inv(usual) * NEAR
                beside = [self.shares(place, x + d) / self.allowed[lines] for d in near[:1 if not rows[:, 1].any() else 2]]
                rows = np.stack([(b - shares) / d[i] for i, (b, d) in enumerate(zip(beside, near, strict=False))], axis=-1)
                rows = rows if rows.shape[1] == 2 else np.concatenate((rows, 0 * rows), axis=1)
            else:
                shares = rows @ x
            if not (np.all(np.isfinite(shares)) and np.all(np.isfinite(rows))):
                break
            score = float(np.sum(_loss(aims)) - np.sum(_loss(aims - shares)) - np.sum((usual @ x) ** 2))
            if score > best.score:
                best = Mistake(place, of, x, covariance(rows, usual), score, mu)
            weights = 1 / np.sqrt(np.maximum(1, np.abs(aims - shares) / HUBER))
            step, *_ = np.linalg.lstsq(np.concatenate((rows * weights[:, None], usual)),
                                       np.concatenate(((aims - shares) * weights, -usual @ x)), rcond=None)
            if np.abs(rows @ step).max() < 0.01:
                break
            x = x + step
        return best

    def can_be_wrong(self, place: Place) -> bool:
        """False for what follows from the project file alone and was not written down: nobody has seen it wrong."""
        error = self.errors.error(self.steps[place])
        return place in self.heads or bool(error[min(place[1], len(error) - 1)] > 0)

    def helps(self, mistake: Mistake, i: int) -> bool:
        """True when a mistake explains most of the number it was looked for, and of another one that is not in order.

        A little of much that other mistakes have spoilt explains nothing. Of what is off against the student's own numbers only
        there is nothing to explain.
        """
        if np.hypot(*mistake.moved) < 2 * self.errors.pencil * mistake.mu:
            return False  # that is the pencil
        shares = self.shares(mistake.place, mistake.moved)
        mostly = {j for j, share in zip(self.by_place[mistake.place][0].tolist(), shares, strict=True)
                  if self.judged[j].verdict != "green" and abs(self.left[j] - share) < 0.5 * abs(self.left[j])}
        return bool(mostly - {i}) and (i in mostly or abs(self.left[i]) <= self.allowed[i])

    def shares(self, place: Place, x: Floats) -> Floats:
        """What a displacement of a step makes of the numbers that depend on it, by drawing again."""
        value, lines = self._with((self._change(place, x),)), self.by_place[place][0]
        return np.asarray([self._changed(self.judged[i], value) for i in lines] - self.predicted[lines])

    def _change(self, place: Place, x: Floats) -> Change:
        step = self.steps[place]
        return Change(step, displaced(complex(*x)), place[1] if np.ndim(step.value) else None)


def _done_in(h: Hypothesis, plan: str) -> bool:
    """Whether a mistake is made in a plan, or in the loads that its sides are."""
    return h.step.plan == plan or (h.step.plan in LOADS and plan.startswith("force-"))


def _seen_in(j: Judged) -> str:
    """The plan that a number was measured in, or where its step is when it was computed."""
    return j.entry.terms[-1][0].plan if j.entry.kind in ("result", "sense") and j.entry.terms else j.entry.plan


def covariance(rows: Floats, usual: Floats) -> Floats:
    """Covariance of a displacement that ``rows`` of tolerance one and what is ``usual`` tell; (2, 2).

    The square of a very sensitive row would have no inverse in floating point.
    """
    inverse = np.linalg.pinv(np.concatenate((rows, usual)))
    return np.asarray(inverse @ inverse.T)


def _loss(r: Any) -> Any:
    """Huber's loss of what is beyond the tolerance: square, and straight for what is far off."""
    size = np.maximum(np.abs(r) - 1, 0)
    return np.where(size <= HUBER, size**2, 2 * HUBER * size - HUBER**2)


def _place(step: Step, k: int) -> Place:
    return id(step), k if np.size(step.value) > 1 else 0
