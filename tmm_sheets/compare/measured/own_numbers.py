"""What a student's earlier numbers let expect of the later ones.

Whoever has drawn a point 5 mm off draws on from there: later numbers are right when they follow from the earlier ones, and wrong
when they do not, however near they are to the exact value. All errors of drawing, reading and computing together make the
deviations of the numbers of a file a random vector whose covariance the record knows. Its Cholesky factor, in the order of
drawing, tells of each number what the earlier ones let expect, and how far it may be from that: T. Kailath, An innovations
approach to least-squares estimation, IEEE Trans. Automatic Control 13 (1968) 646.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.measured.student_recompute import OwnSteps

if TYPE_CHECKING:
    from tmm_sheets.compare.measured.judged import JudgedValue
    from tmm_sheets.construction.error import Errors

Floats = npt.NDArray[np.float64]


class OwnNumbers:
    """Expected deviations of the numbers of a file, by those before them; ``judged`` are the numbers in the order of drawing."""

    def __init__(self, judged: Sequence[JudgedValue], errors: Errors) -> None:
        # What is measured on a step comes before what is computed from it.
        self.judged = [judged[i] for i in sorted(range(len(judged)),
                                                 key=lambda i: (judged[i].order, judged[i].entry.kind == "result", i))]
        self.steps = OwnSteps(self.judged, errors)
        self._rank = {id(j): r for r, j in enumerate(self.judged)}
        self._tolerances = np.array([j.tolerance if _informative(j) else np.inf for j in self.judged])
        self._units = np.where(np.isfinite(self._tolerances), self._tolerances, 1.0)
        self._deviations = np.where(np.isfinite(self._tolerances), [j.deviation for j in self.judged], 0.0) / self._units
        self._root = np.linalg.cholesky(_covariance(self.judged, errors, self._tolerances))
        self._independent = _solved(self._root, self._deviations)

    def expected(self, j: JudgedValue) -> tuple[float, float]:
        """Deviation from the exact value that the earlier numbers let expect, and how far it may be from that; own unit."""
        r = self._rank[id(j)]
        own, unit = float(self._root[r, r]), float(self._units[r])
        expected = float(self._deviations[r] - self._independent[r] * own)
        return expected * unit, own * unit if np.isfinite(self._tolerances[r]) else float("inf")

    def reasons(self, j: JudgedValue) -> list[tuple[JudgedValue, float]]:
        """Earlier numbers with the greatest influence on what is expected of a number, the greatest first.

        With each, what it contributes to the expected deviation.
        """
        r = self._rank[id(j)]
        if r == 0:
            return []
        weights = _solved(self._root[:r, :r].T[::-1, ::-1], self._root[r, :r][::-1])[::-1]
        parts, unit = weights * self._deviations[:r], float(self._units[r])
        return [(self.judged[k], float(parts[k]) * unit) for k in np.argsort(-np.abs(weights))]


def _solved(lower: Any, right: Any) -> Floats:
    """Solution of a lower triangular system."""
    return np.asarray(np.linalg.solve(lower, right))


SQUARE = 0.3
"""Share of itself that an energy may be off by for its error to be told by its gradient."""


def _informative(j: JudgedValue) -> bool:
    """Whether a number tells something of others: it has a tolerance, is no mere sense, no energy of what nearly rests."""
    nearly_rests = j.entry.squares and j.tolerance > SQUARE * abs(j.exact)
    return bool(np.isfinite(j.tolerance)) and j.entry.kind != "sense" and not nearly_rests


def _covariance(judged: Sequence[JudgedValue], errors: Errors, tolerances: Floats) -> Floats:
    """Covariance of the deviations in units of the tolerances, one row and column for each number.

    A result that was written down is what is gone on with: the error of computing it belongs to its step, and only rounding
    the written number is its own. A length is taken off the drawing again, so the error of reading it is its own.
    """
    causes = [errors.causes((s, k, g * j.size) for s, k, g in j.entry.terms) for j in judged]
    rows = np.repeat(np.arange(len(judged)), [len(c[0]) for c in causes])
    at, sources, by, share = (np.concatenate([c[i] for c in causes]) for i in range(4))
    places = at.max(initial=0) + 1
    columns, which = np.unique(sources * places + at, return_inverse=True)
    shares, gradients = np.zeros((2, len(judged), len(columns), 2))
    np.add.at(shares, (rows, which), np.nan_to_num(share, posinf=0.0, neginf=0.0))
    np.add.at(gradients, (rows, which), np.nan_to_num(by, posinf=0.0, neginf=0.0))
    free = ~np.isfinite(tolerances)
    unit = np.where(free, 1.0, tolerances)
    shares = np.where(free[:, None], 0.0, shares.reshape(len(judged), -1) / unit[:, None])
    own = np.maximum(1.0 - np.sum(shares**2, axis=1), 0.0)
    computed = np.array([j.entry.kind == "result" and len(j.entry.terms) == 1 for j in judged]) & ~free
    further = np.zeros((len(judged), int(computed.sum())))
    for column, i in enumerate(np.flatnonzero(computed).tolist()):
        # The error of computing this number goes on to whatever is made of its step.
        step, k, g = judged[i].entry.terms[0]
        key = errors.source(step) * places + (k if np.size(step.value) > 1 else 0)
        c = int(np.searchsorted(columns, key))
        if c < len(columns) and columns[c] == key:
            further[i:, column] = gradients[i:, c] @ np.array([g.real, g.imag]) / abs(g) ** 2 * np.sqrt(own[i]) * unit[i] / unit[i:]
            further[free, column] = 0.0
        further[i, column] = np.sqrt(own[i])
    rounding = (np.array([j.line.half_digit for j in judged]) / unit) ** 2
    own = np.where(computed, np.minimum(rounding, 1.0), own) + 1e-4
    return np.asarray(shares @ shares.T + further @ further.T + np.diag(np.where(free, 1.0, own)))
