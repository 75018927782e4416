"""Curves as values of steps (кривая): points, slopes and the law between them.

A smooth curve is drawn through points that were constructed; what is then measured on it, its tangents and its extremes take the
curve as an argument, so an error of a point goes on through it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.quantities import Reals

Floats = npt.NDArray[np.float64]
Law = Literal["cubic", "straight"]


@dataclass(frozen=True, eq=False)
class Curve:
    """Ordinates over ascending abscissae.

    Attributes
    ----------
    x, y
        n + 1 points, mm (or any unit); two equal abscissae make a jump.
    left, right
        slopes at the beginning and at the end of each of the n stretches (law "cubic"); a corner where they differ. Empty for
        "straight", chords between the points.
    """

    x: Floats
    y: Floats
    left: Floats
    right: Floats
    law: Law = "cubic"

    def __post_init__(self) -> None:
        if np.ndim(self.y) != 1:
            raise ValueError("one curve at a time")  # replays of many curves at once are told to go one by one

    def __call__(self, x: Reals) -> Reals:
        """Ordinates at ``x``, of any shape within the abscissae."""
        x = np.asarray(x, dtype=float)
        k = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)
        h = self.x[k + 1] - self.x[k]
        t = (x - self.x[k]) / h
        s = 1 - t
        if self.law == "straight":
            return s * self.y[k] + t * self.y[k + 1]
        return (s * s * (self.y[k] * (1 + 2 * t) + h * t * self.left[k])
                + t * t * (self.y[k + 1] * (1 + 2 * s) - h * s * self.right[k]))


def inner_slopes(h: Any, chord: Any) -> Any:
    """Slopes in the inner points of a curve that rises and falls only where its points do, from chords of the widths ``h``.

    Weighted harmonic means of the slopes of the neighbouring chords, zero where these differ in sign (F. N. Fritsch, J. Butland,
    SIAM J. Sci. Stat. Comput. 5, 1984, 300-304).
    """
    w1, w2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(chord[:-1] * chord[1:] > 0, (w1 + w2) / (w1 / chord[:-1] + w2 / chord[1:]), 0.0)
