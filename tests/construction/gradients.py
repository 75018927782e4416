"""How much a step moves with an earlier one, from the causes of its error."""

import numpy as np


def gradient(errors, step, source, at=None):
    """Displacement of a step for a unit displacement of another, d(x, y)/d(x, y), shape (n, 2, 2); of a number the first row.

    ``at`` is the source's position where the step took a single one from another plan.
    """
    found = np.zeros((np.size(step.value), 2, 2))
    for k, of in enumerate(found):
        for row, unit in zip(of, (1.0 + 0j, 1j), strict=True):
            where, sources, by, _ = errors.causes([(step, k, unit)])
            there = sources == errors.source(source)
            row[:] = by[there if at is None else there & (where == at)].sum(axis=0)
    return found
