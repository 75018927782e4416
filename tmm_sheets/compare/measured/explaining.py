"""What explains a number that is not in order: something done otherwise, or a step drawn off, with all numbers as witnesses.

Discrete mistakes come first: each is drawn again (:mod:`~tmm_sheets.compare.diagnosis`), and of those that leave little of the
number's deviation the one that explains most of all numbers wins. A displaced point is told only where its displacement, of which
nothing is known beforehand, explains more than any of them.
"""

from __future__ import annotations

import numpy as np

from tmm_sheets.compare.measured.discrete_mistake import ENOUGH, done_otherwise
from tmm_sheets.compare.measured.evidence import Evidence, Explanation, loss
from tmm_sheets.compare.measured.misplaced_point import NEARLY, displaced_step
from tmm_sheets.compare.measured.mistake_pairs import two_mistakes


def explanation(evidence: Evidence, i: int) -> Explanation | None:
    """What explains a number best; None when nothing does: a slip in reading or computing this one."""
    done = done_otherwise(evidence, i)
    if done is not None:
        reached = np.abs(done.shares) > evidence.allowed
        alike = reached.copy()  # with all that a step drawn off may explain
        for place in evidence.places[i]:
            alike[evidence.by_place[place][0]] = True
        if reached.sum() > 1 and done.score > NEARLY * float(np.sum(loss((evidence.left / evidence.allowed)[alike]))):
            return done  # nothing can explain much more
    off = displaced_step(evidence, i)
    best = off if done is None or (off is not None and off.score * NEARLY > done.score) else done
    both = two_mistakes(evidence, i)
    if best is None or both is None:
        return best or both
    # A displacement that may be anything explains much of two mistakes; what it leaves is told by chance no more than one mistake.
    enough = max(NEARLY * both.score, both.score - ENOUGH if best is off else 0.0)
    return best if best.score > enough else both
