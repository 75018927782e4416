"""A measured number with its judgement, and the mistake behind it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.codes import Remark
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.measured.measurable import Measurable, angle_apart
from tmm_sheets.compare.measured.measured_file import MeasuredLine
from tmm_sheets.compare.report import Verdict, verdict
from tmm_sheets.construction.step import Step, value_at

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

        def moved(step: Step, k: int) -> complex:
            now, was = (np.asarray(x) for x in (value(step), step.value))
            return complex(now[k] - was[k] if now.ndim else now - was)

        if e.is_distance:
            (tail, k, _), (head, _, g) = e.terms
            away = complex(value_at(head, k) - value_at(tail, k))
            change = (abs(away + moved(head, k) - moved(tail, k)) - abs(away)) * abs(g)
        elif e.is_size:
            (step, k, _), = e.terms
            change = abs(complex(value_at(step, k)) + moved(step, k)) - e.value
        elif e.kind == "sense":
            (step, k, _), = e.terms
            change = float(np.sign(float(value_at(step, k)) + moved(step, k).real)) - e.value
        elif e.kind == "angle" and np.iscomplexobj(e.terms[-1][0].value):
            foot, tip = (0j, *(complex(value_at(step, k)) for step, k, _ in e.terms))[-2:]
            from_foot, to_tip = (0j, *(moved(step, k) for step, k, _ in e.terms))[-2:]
            with np.errstate(all="ignore"):
                change = self.apart(degrees(np.angle((tip + to_tip - foot - from_foot) / (tip - foot))))
        else:
            change = sum((np.conj(g) * moved(step, k)).real for step, k, g in e.terms)
            if len(e.terms) == 1 and not e.signed and e.kind != "angle":
                change = abs(e.value + change) - e.value
        return float(change) * self.size
