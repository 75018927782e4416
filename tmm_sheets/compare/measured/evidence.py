"""Judged numbers as witnesses: what is left of them with the mistakes found so far, and what a further one would leave."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.codes import Remark
from tmm_sheets.compare.diagnosis.hypotheses import Change, Hypothesis, Kind, displaced, replay
from tmm_sheets.compare.elements import grouped
from tmm_sheets.compare.findings import Verdict, verdict
from tmm_sheets.compare.measured.measurable import Measurable, angle_apart
from tmm_sheets.compare.measured.measured_file import MeasuredLine
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.step import Step, ordered, value_at

Place = tuple[int, int]
"""A step and a position."""


@dataclass(frozen=True)
class Mistake:
    """A step drawn wrong at a position: its displacement, the covariance of that, how much it explains, the scale of its plan."""

    place: Place
    step: Step
    moved: npt.NDArray[np.float64]
    uncertain: npt.NDArray[np.float64]
    score: float
    mu: float


@dataclass(eq=False)
class JudgedValue:
    """A measured number with its judgement, in its own unit.

    ``follows`` is the number in which its chain of errors starts, itself not included; ``starts`` is True for such a number.
    ``noted`` is what is seen of it alone. ``wrong`` are the discrete mistakes that explain it, the first of them the one that is
    told, ``mistake`` a displaced step.
    ``tolerance`` is infinite where the construction has none to give, ``reading`` the part of it that reading and computing have.
    """

    line: MeasuredLine
    exact: float
    deviation: float
    tolerance: float
    rows: list[tuple[Step, int, complex]]
    follows: JudgedValue | None = None
    starts: bool = False
    mistake: Mistake | None = None
    wrong: tuple[Hypothesis, ...] = ()
    noted: Remark | None = None
    inconsistent: bool = False
    off_own: bool = False
    size: float = 1.0
    reading: float = 0.0
    order: int = 0

    @property
    def entry(self) -> Measurable:
        """What was measured."""
        return self.line.entry

    @property
    def row(self) -> str:
        """Its row as it is told: position and quantity."""
        return f"({self.entry.label}) {self.entry.quantity}" if self.entry.label else self.entry.quantity

    @property
    def remark(self) -> str:
        """What was noted of it, as the reader reads it."""
        return self.noted.said() if self.noted is not None else ""

    @property
    def verdict(self) -> Verdict:
        """Green, amber or red; not green where it does not follow from the student's own numbers."""
        if self.off_own:
            return "red"
        judged = verdict(self.deviation, self.tolerance)
        return "amber" if judged == "green" and self.inconsistent else judged

    @property
    def percent(self) -> float | None:
        """Deviation in per cent of the exact value; None where that is zero, and of angles, which begin at any axis."""
        of_size = self.entry.kind not in ("angle", "sense") and abs(self.exact) > 1e-9
        return 100 * self.deviation / abs(self.exact) if of_size else None

    def off(self, value: float) -> float:
        """How far the number is off if it is written so."""
        return self.entry.off(value, self.exact)

    def apart(self, x: float) -> float:
        """A difference of two of such numbers: of angles the short way round."""
        return angle_apart(x, 0.0, self.entry.signed) if self.entry.kind == "angle" else x

    @property
    def at(self) -> int:
        """Number of the position among those of the plans."""
        return self.entry.terms[-1][1] if self.entry.terms else 0

    def changed(self, value: Callable[[Step], Any]) -> float:
        """How much the number changes when the steps have other values."""
        e = self.entry
        was, now = ([complex(value_at(of(step), k)) for step, k, _ in e.terms] for of in (lambda step: step, value))
        if e.of is not None:
            with np.errstate(all="ignore"):
                return float(self.apart(e.of(*now) - e.of(*was))) * self.size
        change = sum((np.conj(g) * (b - a)).real for (_, _, g), a, b in zip(e.terms, was, now, strict=True))
        if len(e.terms) == 1 and not e.signed and e.kind != "angle":
            change = abs(e.value + change) - e.value
        return float(change) * self.size


Floats = npt.NDArray[np.float64]
CURVED = 0.05
"""Share of what a mistake explains that may be off: its displacement is not known better."""
REACH = 2.0
"""Tolerances beyond which a number is off, spoilt rather than scattered, and that a mistake may leave of it."""
CHANCES = 8
"""Drawings by chance that tell how uncertain a number has become."""
SEVERAL = 3
"""Numbers that must be off alike before that is no chance: a shifted column, two mistakes at once, the same at many positions."""
MOSTLY = 0.9
"""Share of what is best, or of the number it is looked for, that a mistake has to explain."""
LOADS = ("loads", "moments")
"""Plans that are seen in the polygons of forces."""
SENSES: frozenset[Kind] = frozenset({"mirror", "sense", "neighbour"})
"""Kinds of mistakes that leave the lengths of their plan as they are."""
SPOILT = 3.0
"""Tolerances by which a discrete mistake would spoil a number that it cannot have been made before when that is in order."""


@dataclass(frozen=True)
class Explanation:
    """What was done wrong and what it makes of the numbers.

    Attributes
    ----------
    changes : to be replayed
    shares, doubt : what it makes of each number, and how well that is known; in the unit of the number
    score : how much of all deviations it explains
    wrong : discrete mistakes that are equally good, the first of them is told
    mistake : a displaced step where it is none of these
    then : another discrete mistake, without which this one explains nothing; shares when this one is known
    spoils : numbers in order that it would spoil: it was not made, or another mistake made good what it does to them
    """

    changes: tuple[Change, ...]
    shares: Floats
    doubt: Floats
    score: float
    wrong: tuple[Hypothesis, ...] = ()
    mistake: Mistake | None = None
    then: Explanation | None = None
    spoils: tuple[int, ...] = ()


class Evidence:
    """All judged numbers together: what is left of their deviations, and which steps each depends on.

    ``labels`` are those of the positions of the linkage.
    """

    def __init__(self, judged: list[JudgedValue], errors: Errors, labels: Sequence[str]) -> None:
        self.judged = judged
        self.errors = errors
        self.labels = labels
        self.deviation = np.array([j.deviation for j in judged])
        self.left = self.deviation.copy()
        self.tolerance = np.array([j.tolerance for j in judged])
        self.changes: list[Change] = []
        self._made: dict[int, dict[Step, None]] = {}
        self.predicted = np.zeros(len(judged))
        self.heads = {place_of(j.entry.head, j.at) for j in judged if j.entry.head is not None}
        rows = [(i, place_of(step, k), step, g) for i, j in enumerate(judged) for step, k, g in j.rows if g and isfinite(abs(g))]
        self.steps = {place: step for _, place, step, _ in rows}
        self.by_place = {place: (np.array([i for i, *_ in some]), np.array([[g.real, g.imag] for *_, g in some]))
                         for place, some in grouped(rows, lambda row: row[1]).items()}
        self.places = [[place_of(step, k) for step, k, g in j.rows if g and isfinite(abs(g))] for j in judged]

    def accept(self, found: Explanation) -> None:
        """Go on with what is left when a mistake is known."""
        self.changes += found.changes
        if found.changes:
            self.predicted += np.where(np.isfinite(found.shares), found.shares, 0.0)
        else:
            self.deviation -= found.shares  # only written wrongly
        self.__dict__.pop("allowed", None)

    def reached(self, found: Explanation, i: int) -> bool:
        """Whether a number depends on what was done wrong, also where that happens to leave it as it is."""
        return bool(found.shares[i]) or any(change.step in self._steps_behind(i) for change in found.changes)

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
        return bool(self.allowed[i] > self.tolerance[i] and abs(left) <= REACH * self.allowed[i])

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
            value = self.with_changes([self._by_chance(s, rng) for s in drawn])
            off = [j.apart(j.changed(value) - float(self.predicted[i])) for i, j in enumerate(self.judged)]
            spread = np.fmax(spread, np.abs(off))
        return np.where(np.isfinite(spread) & (spread > REACH * self.tolerance), spread, self.tolerance)

    def _by_chance(self, step: Step, rng: np.random.Generator) -> Change:
        """A step with a pencil's error by chance; what is kept nineteen times of twenty is two standard deviations."""
        own = np.nan_to_num(self.errors.own(step))
        off = (own @ rng.normal(0, 0.5, (len(own), 2, 1)))[:, :, 0] @ (1, 1j)
        return Change(step, displaced(off if np.ndim(step.value) else off[0]))

    def _steps_behind(self, i: int) -> dict[Step, None]:
        """Steps of the linkage that a number goes back to."""
        if i not in self._made:
            made = self.made_of([step for step, _, _ in self.judged[i].entry.terms])
            self._made[i] = {s: None for s in made if s.rule.gives != "direction" and self.errors.own(s).any()}
        return self._made[i]

    def made_of(self, steps: Sequence[Step]) -> list[Step]:
        """Steps with all that they were made of on paper."""
        return list(ordered(steps, lambda step: [a for a in self.errors.arguments(step) if isinstance(a, Step)]))

    @cached_property
    def whole(self) -> list[Step]:
        """All steps that any number goes back to."""
        return self.made_of([step for j in self.judged for step, _, _ in j.entry.terms])

    def leaves_little(self, i: int, h: Hypothesis) -> bool:
        """Whether a number is nearly what it would be with a mistake, and would not be so without.

        A neighbour's number is hardly another one: it is seen where it was taken, farther on it would be a guess.
        """
        at = [step for step, _, _ in self.judged[i].entry.terms]
        if h.kind == "neighbour" and len(h.changes) == 1 and not any(h.step is s for step in at for s in (step, *step.args)):
            return False
        share = self.shares_of(h, [i])[0]
        left, allowed = self.after(share, [i])[0], np.hypot(self.allowed[i], CURVED * share)
        return bool(isfinite(share) and abs(share) > self.allowed[i] and abs(left) <= REACH * allowed)

    def replayed(self, h: Hypothesis) -> Explanation:
        """The construction with a mistake, held against all numbers."""
        shares = self.shares_of(h, range(len(self.judged)))
        doubt = CURVED * np.abs(shares)
        # With what cannot be drawn any more nothing is explained.
        known = np.isfinite(shares) & np.isfinite(self.allowed)
        with np.errstate(invalid="ignore"):
            left, after = self.left / self.allowed, self.after(shares) / np.hypot(self.allowed, doubt)
        gain = loss(left) - loss(after)
        # Results are computed from lengths, whatever their senses: what a wrong sense does not spoil in them proves nothing.
        proves = np.array([h.kind not in SENSES or self.proves(j, h) for j in self.judged])
        score = float(np.sum(np.where(proves, gain, np.maximum(gain, 0.0))[known]))
        # However much it explains besides: what is in order was not spoilt.
        spoilt = np.flatnonzero(known & proves & (np.abs(left) <= 1) & (np.abs(after) > SPOILT))
        return Explanation(h.changes, shares, np.where(np.isfinite(doubt), doubt, 0.0), 0.0 if len(spoilt) else score,
                           spoils=tuple(spoilt.tolist()))

    @staticmethod
    def proves(j: JudgedValue, h: Hypothesis) -> bool:
        """Whether a number that is in order proves that something was not done: it shows where that was done.

        Further on it may have been gone on with otherwise, by lengths without their senses.
        """
        # A neighbour's number may have been taken without its sense.
        taken = h.kind != "neighbour" or j.entry.kind != "sense"
        return done_in(h, j.entry.plan) or (taken and any(step is h.step for step, _, _ in j.entry.terms))

    def shares_of(self, h: Hypothesis, lines: Sequence[int]) -> Floats:
        """What a discrete mistake makes of some numbers."""
        value = self.with_changes(h.changes)
        return np.array([0.0 if j.entry.kind != "result" and j.entry.plan == h.on_paper else
                         j.changed(value) - self.predicted[i] for i, j in ((i, self.judged[i]) for i in lines)])

    def with_changes(self, changes: Sequence[Change]) -> Any:
        """The construction with the mistakes found so far and further ones."""
        return replay(self.errors, [*self.changes, *changes])


def done_in(h: Hypothesis, plan: str) -> bool:
    """Whether a mistake is made in a plan, or in the loads that its sides are."""
    return h.step.plan == plan or (h.step.plan in LOADS and plan.startswith("force-"))


def loss(r: Any) -> Any:
    """Huber's loss of what is beyond the tolerance: square, and straight for what is far off."""
    size = np.maximum(np.abs(r) - 1, 0)
    return np.where(size <= REACH, size**2, 2 * REACH * size - REACH**2)


def place_of(step: Step, k: int) -> Place:
    """A step at a position; what is the same at all of them has one place."""
    return id(step), k if np.size(step.value) > 1 else 0
