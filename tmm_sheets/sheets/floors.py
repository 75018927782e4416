"""The least sizes on paper at which what a view shows is read from a metre away: data, each with its reason.

A floor decides, it does not remark: what a view needs of its place (:mod:`.view_sizes`), which way a sheet is arranged and which
scale factor is taken come from it. What no place of the sheet can reach is told by :mod:`.legibility`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.words import marked


class Floor(NamedTuple):
    """``least`` size, mm, of ``what`` is measured."""

    what: str
    least: float


CRANK = Floor(marked("the crank circle"), 30.0)
"""Diameter: twelve positions are 8 mm apart on it, as their numbers of 2.5 mm need beside the lines that end there."""
VECTOR = Floor(marked("the longest vector"), 60.0)
"""Of velocity and acceleration plans: half a millimetre of the pencil is then less than 1 % of it."""
LETTERED = Floor(marked("a plan with letters"), 25.0)
"""Larger side of a velocity or acceleration plan: three to five letters of 3.5 mm stand about it; below it has none."""
SHARE = 0.5
"""Share of its place that a position plan takes at least, 0 .. 1: the mechanism is what the sheet is about."""
EMPTY = 160.0 * 120.0
"""Area of the largest rectangle without ink that no eye stops at, mm^2."""


LEVEL = 1e-9
"""Share of the largest ordinate up to which a curve rises by rounding."""


def risen(values: npt.NDArray[np.float64]) -> float:
    """What values extend over, in their unit; nothing where they are level but for rounding."""
    extent, largest = float(np.ptp(values)), float(np.abs(values).max())
    return extent if extent > LEVEL * largest else 0.0
