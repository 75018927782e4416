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

if TYPE_CHECKING:
    from tmm_sheets.compare.measured.judged import Judged
    from tmm_sheets.construction.error import Errors

Floats = npt.NDArray[np.float64]


class OwnNumbers:
    """Expected deviations of the numbers of a file.

    Attributes
    ----------
    expected
        deviation from the exact value that the earlier numbers let expect, in the number's own unit; shape (n,).
    tolerance
        how far the number may be from that; shape (n,), infinite where there is no tolerance.
    """

    def __init__(self, judged: Sequence[Judged], errors: Errors) -> None:
        self.order = sorted(range(len(judged)), key=lambda i: (judged[i].order, i))
        self.rank = {i: r for r, i in enumerate(self.order)}
        some = [judged[i] for i in self.order]
        self.deviations = np.array([j.deviation for j in some])
        self._root = np.linalg.cholesky(_covariance(some, errors))
        own = np.diag(self._root)
        independent = _solved(self._root, self.deviations)
        back = [self.rank[i] for i in range(len(judged))]
        self.expected = (self.deviations - independent * own)[back]
        self.tolerance = np.where([np.isfinite(j.tolerance) for j in some], own, np.inf)[back]

    def reasons(self, i: int) -> list[tuple[int, float]]:
        """Earlier numbers and what each contributes to the expected deviation of number ``i``, the greatest first."""
        r = self.rank[i]
        if r == 0:
            return []
        weights = _solved(self._root[:r, :r].T[::-1, ::-1], self._root[r, :r][::-1])[::-1]
        parts = weights * self.deviations[:r]
        return [(self.order[k], float(parts[k])) for k in np.argsort(-np.abs(parts))]


def _solved(lower: Any, right: Any) -> Floats:
    """Solution of a lower triangular system."""
    return np.asarray(np.linalg.solve(lower, right))


def _covariance(judged: Sequence[Judged], errors: Errors) -> Floats:
    """Covariance of the deviations, one row and column for each number.

    A result that was written down is what is gone on with: the error of computing it belongs to its step, and only rounding
    the written number is its own. A length is taken off the drawing again, so the error of reading it is its own.
    """
    causes = [errors.causes((s, k, g * j.size) for s, k, g in j.entry.terms) for j in judged]
    rows = np.repeat(np.arange(len(judged)), [len(c[0]) for c in causes])
    at, sources, by, share = (np.concatenate([c[i] for c in causes]) for i in range(4))
    columns, which = np.unique(sources * (at.max(initial=0) + 1) + at, return_inverse=True)
    shares, gradients = np.zeros((2, len(judged), len(columns), 2))
    np.add.at(shares, (rows, which), np.nan_to_num(share))
    np.add.at(gradients, (rows, which), np.nan_to_num(by))
    shares = shares.reshape(len(judged), -1)
    tolerance = np.array([j.tolerance for j in judged])
    free = ~np.isfinite(tolerance)
    scale = np.where(free, 1.0, tolerance) ** 2
    own = np.maximum(scale - np.sum(shares**2, axis=1), 0.0)
    computed = np.array([j.entry.kind == "result" and len(j.entry.terms) == 1 for j in judged])
    further = np.zeros((len(judged), int(computed.sum())))
    for column, i in enumerate(np.flatnonzero(computed).tolist()):
        # The error of computing this number goes on to whatever is made of its step.
        step, k, g = judged[i].entry.terms[0]
        key = errors.source(step) * (at.max(initial=0) + 1) + (k if np.size(step.value) > 1 else 0)
        c = int(np.searchsorted(columns, key))
        further[i, column] = np.sqrt(own[i])
        if c < len(columns) and columns[c] == key:
            further[i:, column] = gradients[i:, c] @ np.array([g.real, g.imag]) / abs(g) ** 2 * np.sqrt(own[i])
    rounding = np.array([j.line.half_digit for j in judged]) ** 2
    own = np.where(computed, rounding, own) + 1e-6 * scale
    found = shares @ shares.T + further @ further.T + np.diag(own)
    found[free], found[:, free] = 0.0, 0.0
    found[free, free] = 1.0
    return np.asarray(found)
