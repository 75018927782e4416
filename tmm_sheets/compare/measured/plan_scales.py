"""Plans that were drawn with another scale factor than stated: all lengths are as many times as long as they should be."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.codes import Number
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.measured.judged import JudgedValue
from tmm_sheets.construction.step import Step

Floats = npt.NDArray[np.float64]
SCALED = 4
"""Lengths of a plan from which a wrong scale factor is recognised."""
SIMILAR_SCALES = 0.15
"""Difference of two scale factors, as a share, below which all lengths must tell of it."""


def is_scaled(j: JudgedValue) -> bool:
    """Whether a number is a length that a plan's scale factor makes longer, as it was stated."""
    return bool(j.entry.kind == "length" and j.entry.scale and j.line.factor is None)


def times_as_long(measured: Floats, expected: Floats, tolerance: Floats) -> tuple[float, npt.NDArray[np.bool_]] | None:
    """How many times as long as expected (mm) the lengths of a plan are, and which of them that explains; None when it does not."""
    long = np.abs(expected) > 5 * tolerance
    off = long & (np.abs(measured - expected) > 2 * tolerance)
    if long.sum() < SCALED or off.sum() < 0.6 * long.sum():
        return None

    def explained(times: float) -> npt.NDArray[np.bool_]:
        left = 2.0 if abs(times - 1) > SIMILAR_SCALES else 1.0
        return np.asarray(np.abs(measured - times * expected) <= left * tolerance * max(times, 1.0))

    # The lengths are not equally exact: of what each tells the best, then all that agree with it together.
    agree = max((explained(float(times)) for times in measured[long] / expected[long]), key=np.sum)
    if not agree.any():
        return None
    weighted = np.where(agree, expected / tolerance**2, 0.0)
    times = float(weighted @ measured / (weighted @ expected))
    # A long side drawn a little wrong makes a plan a little smaller, too, but not all of it.
    needed = 0.8 * len(measured) if abs(times - 1) > SIMILAR_SCALES else len(measured)
    told_so = explained(times)
    return None if times <= 0 or abs(times - 1) < 0.01 or told_so.sum() < needed else (times, told_so)


def drawn_to(times: float, step: Step, scale: str) -> Hypothesis:
    """The mistake: the plan of a step, by its scale factor, drawn so many times as large, what is taken from it being right."""
    return Hypothesis("scale", "plan scale", step, (), other=Number(f"{times:.3g}"), drawn=((scale, times),))
