"""A measured number with its judgement, and the mistake behind it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.measured.measurable import Measurable
from tmm_sheets.compare.measured.measured_file import MeasuredLine
from tmm_sheets.compare.report import Verdict, verdict
from tmm_sheets.construction.step import Step

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
class Judged:
    """A measured number with its judgement, in its own unit.

    ``follows`` is the number in which its chain of errors starts, itself not included; ``starts`` is True for such a number.
    ``tolerance`` is infinite where the construction has none to give.
    """

    line: MeasuredLine
    exact: float
    deviation: float
    tolerance: float
    rows: list[tuple[Step, int, complex]]
    follows: Judged | None = None
    starts: bool = False
    scale: str = ""
    mistake: Mistake | None = None
    remark: str = ""
    inconsistent: bool = False
    off_own: bool = False
    size: float = 1.0
    order: int = 0

    @property
    def entry(self) -> Measurable:
        """What was measured."""
        return self.line.entry

    @property
    def verdict(self) -> Verdict:
        """Green, amber or red; not green where it does not follow from the student's own numbers."""
        if self.off_own:
            return "red"
        judged = verdict(self.deviation, self.tolerance)
        return "amber" if judged == "green" and self.inconsistent else judged

    @property
    def percent(self) -> float | None:
        """Deviation in per cent of the exact value; None where that is zero."""
        return 100 * self.deviation / abs(self.exact) if abs(self.exact) > 1e-9 else None

    @property
    def at(self) -> int:
        """Number of the position among those of the plans."""
        return self.entry.terms[-1][1] if self.entry.terms else 0
