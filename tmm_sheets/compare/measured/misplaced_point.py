"""A step drawn off: the displacement, of which nothing is known beforehand, that explains most of a number and of the others."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.diagnosis.replay import Change, displaced
from tmm_sheets.compare.measured.evidence import CURVED, HUBER, Evidence, Explanation, Floats, loss, place_of
from tmm_sheets.compare.measured.judged import Mistake, Place
from tmm_sheets.construction.step import value_at

USUAL = 10.0
"""How far a misplaced point usually lies off, mm."""
ALONE = 0.9
"""Share of the number it is looked for that a mistake has to explain, besides most of another one."""
DRAWN = ("point", "vector", "length", "ordinate")
"""What is off by millimetres; numbers and forces are off by a share of themselves."""
NEAR = 0.01
"""Displacement for derivatives where a mistake has led to, as a share of the usual one."""
TRIED = 4
"""Steps that are tried by drawing again, of those that explain most by the Jacobian."""
WITNESSED = 0.1
"""Share of what a displacement explains of the number it is looked for that it has to explain of others."""
NEARLY = 0.9
"""Share of the best explanation with which another is as good."""


def displaced_step(evidence: Evidence, i: int) -> Explanation | None:
    """The displaced step behind a red number; None when it explains nothing else, or where the number is where it ought to be.

    A number within its tolerance may be red because it does not follow from the student's own: no step need be displaced for it.
    """
    if abs(evidence.judged[i].deviation) <= evidence.judged[i].tolerance:
        return None
    possible = (_mistake(evidence, place) for place in evidence.places[i] if _can_be_wrong(evidence, place))
    candidates = sorted(possible, key=lambda m: -m.score)
    candidates = [_mistake(evidence, m.place, exact=True) for m in candidates[:TRIED]]
    alone = float(loss(evidence.left[i] / evidence.allowed[i]))
    own = evidence.judged[i].entry.head
    good = [m for m in candidates if m.score > alone * ALONE and _helps(evidence, m, i)]
    if not good:
        return None
    best = max(m.score for m in good)
    near = [m for m in good if m.score >= NEARLY * best]
    head = None if own is None else place_of(own, evidence.judged[i].at)
    # Of steps that explain equally well the one that was measured here, else one that was measured at all.
    m = max(near, key=lambda m: (m.place == head, m.place in evidence.heads, m.score))
    lines, gradient = evidence.by_place[m.place]
    shares, doubt = np.zeros((2, len(evidence.judged)))
    shares[lines] = _shares(evidence, m.place, m.moved)
    doubt[lines] = np.hypot(np.sqrt(np.einsum("ni,ij,nj->n", gradient, m.uncertain, gradient)), CURVED * np.abs(shares[lines]))
    return Explanation((_change(evidence, m.place, m.moved),), shares, doubt, m.score, mistake=m)


def _mistake(evidence: Evidence, place: Place, exact: bool = False) -> Mistake:
    """The displacement of one step that explains most: least squares over all numbers that depend on it, green ones as well.

    Numbers that other mistakes have spoilt count as much less as they are off (P. J. Huber's weights). With ``exact`` the
    construction is drawn again with the displacement until that fits (Gauss and Newton's way), else the Jacobian will do. A
    point that nearly rests moves its speed alike to both sides: the search begins also with what its own plan alone tells. A
    vector that became longer than it is may point anywhere now: then it begins on all sides.
    """
    begins = [np.zeros(2)]
    if exact:
        begins += [*_by_own_plan(evidence, place), *_all_round(evidence, place)]
    return max((_descended(evidence, place, x, exact) for x in begins), key=lambda m: m.score)


def _by_own_plan(evidence: Evidence, place: Place) -> Iterator[Floats]:
    """The displacement that the numbers of the step's own plan tell, where there are others."""
    lines, gradient = evidence.by_place[place]
    here = np.array([evidence.judged[i].entry.plan == evidence.steps[place].plan for i in lines])
    if here.all() or not here.any():
        return
    rows, aims = (gradient / evidence.allowed[lines, None])[here], (evidence.left[lines] / evidence.allowed[lines])[here]
    usual = _usual(evidence, place)
    begin, *_ = np.linalg.lstsq(np.concatenate((rows, usual)), np.concatenate((aims, np.zeros(2))), rcond=None)
    yield begin


def _all_round(evidence: Evidence, place: Place) -> Iterator[Floats]:
    """Displacements to four sides, as long as a vector became that was shorter."""
    lines, gradient = evidence.by_place[place]
    longer = [float(evidence.left[i] / np.hypot(*g)) for i, g in zip(lines, gradient, strict=True)
              if (evidence.judged[i].entry.is_distance or evidence.judged[i].entry.is_size)
              and evidence.left[i] > max(abs(evidence.judged[i].exact), evidence.judged[i].tolerance)]
    if longer:
        yield from max(longer) * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])


def _usual(evidence: Evidence, place: Place) -> npt.NDArray[np.float64]:
    """Of what no number sees nothing is told: mistakes are some millimetres, a number is not wrong by more than itself."""
    of = evidence.steps[place]
    mu = evidence.errors.scale(of) if of.rule.gives in DRAWN else 0.0
    return np.eye(2) / (USUAL * mu if mu else max(abs(complex(value_at(of, place[1]))), 1e-9))


def _descended(evidence: Evidence, place: Place, x: npt.NDArray[np.float64], exact: bool) -> Mistake:
    """The best displacement that the search finds when it begins with ``x``."""
    lines, gradient = evidence.by_place[place]
    of, mu, usual = evidence.steps[place], evidence.errors.scale(evidence.steps[place]), _usual(evidence, place)
    rows, aims = gradient / evidence.allowed[lines, None], evidence.left[lines] / evidence.allowed[lines]
    best = Mistake(place, of, x, np.eye(2), 0.0, mu)
    for _ in range(6 if exact else 9):
        if exact and x.any():
            shares = _shares(evidence, place, x) / evidence.allowed[lines]
            near = np.linalg.inv(usual) * NEAR
            beside = [_shares(evidence, place, x + d) / evidence.allowed[lines] for d in near[:1 if not rows[:, 1].any() else 2]]
            rows = np.stack([(b - shares) / d[i] for i, (b, d) in enumerate(zip(beside, near, strict=False))], axis=-1)
            rows = rows if rows.shape[1] == 2 else np.concatenate((rows, 0 * rows), axis=1)
        else:
            shares = rows @ x
        if not (np.all(np.isfinite(shares)) and np.all(np.isfinite(rows))):
            break
        score = float(np.sum(loss(aims)) - np.sum(loss(aims - shares)) - np.sum((usual @ x) ** 2))
        if score > best.score:
            best = Mistake(place, of, x, covariance(rows, usual), score, mu)
        weights = 1 / np.sqrt(np.maximum(1, np.abs(aims - shares) / HUBER))
        step, *_ = np.linalg.lstsq(np.concatenate((rows * weights[:, None], usual)),
                                   np.concatenate(((aims - shares) * weights, -usual @ x)), rcond=None)
        if np.abs(rows @ step).max() < 0.01:
            break
        x = x + step
    return best


def _can_be_wrong(evidence: Evidence, place: Place) -> bool:
    """False for what follows from the project file alone and was not written down: nobody has seen it wrong."""
    error = evidence.errors.error(evidence.steps[place])
    return place in evidence.heads or bool(error[min(place[1], len(error) - 1)] > 0)


def _helps(evidence: Evidence, mistake: Mistake, i: int) -> bool:
    """True when a mistake explains most of the number it was looked for, and of another one that is not in order.

    A little of much that other mistakes have spoilt explains nothing, nor does a great displacement that only one number shows.
    Of what is off against the student's own numbers only there is nothing to explain.
    """
    if np.hypot(*mistake.moved) < 2 * evidence.errors.pencil * mistake.mu:
        return False  # that is the pencil
    shares = _shares(evidence, mistake.place, mistake.moved)
    mostly = {j for j, share in zip(evidence.by_place[mistake.place][0].tolist(), shares, strict=True)
              if evidence.judged[j].verdict != "green" and abs(evidence.left[j] - share) < 0.5 * abs(evidence.left[j])}
    if not mostly - {i} or not (i in mostly or abs(evidence.left[i]) <= evidence.allowed[i]):
        return False
    lines = evidence.by_place[mistake.place][0]
    gain = loss(evidence.left[lines] / evidence.allowed[lines]) - loss((evidence.left[lines] - shares) / evidence.allowed[lines])
    far = float(np.sum((_usual(evidence, mistake.place) @ mistake.moved) ** 2))
    return bool(gain[lines != i].sum() > max(far, WITNESSED * gain[lines == i].sum()))


def _shares(evidence: Evidence, place: Place, x: Floats) -> Floats:
    """What a displacement of a step makes of the numbers that depend on it, by drawing again."""
    value, lines = evidence.with_changes((_change(evidence, place, x),)), evidence.by_place[place][0]
    return np.asarray([evidence.changed(evidence.judged[i], value) for i in lines] - evidence.predicted[lines])


def _change(evidence: Evidence, place: Place, x: Floats) -> Change:
    step = evidence.steps[place]
    return Change(step, displaced(complex(*x)), place[1] if np.ndim(step.value) else None)


def covariance(rows: Floats, usual: Floats) -> Floats:
    """Covariance of a displacement that ``rows`` of tolerance one and what is ``usual`` tell; (2, 2).

    The square of a very sensitive row would have no inverse in floating point.
    """
    inverse = np.linalg.pinv(np.concatenate((rows, usual)))
    return np.asarray(inverse @ inverse.T)
