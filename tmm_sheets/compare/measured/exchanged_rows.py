"""Numbers that were written into the rows of others: exchanged with a neighbour, or a whole column shifted by one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from tmm_sheets.compare.codes import Own
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.measured.evidence import LEFT, Evidence, Explanation, loss

T = TypeVar("T")
LEAST = 3
"""Numbers that must be off before a column is said to be shifted."""


def wrong_rows(evidence: Evidence, i: int) -> Iterator[tuple[Hypothesis, Explanation]]:
    """What a number is off by when rows near it have the numbers of others; the smallest mistakes first."""
    judged = evidence.judged
    e = judged[i].entry
    if not e.terms:
        return
    alike = [n for n, j in enumerate(judged) if (j.entry.plan, j.entry.title, j.entry.kind, j.entry.unit) == (
        e.plan, e.title, e.kind, e.unit)]
    beside = [n for n in alike if judged[n].entry.label == e.label]
    along = [n for n in alike if judged[n].entry.quantity == e.quantity]
    for n in (*_next(beside, i), *_next(along, i)):
        yield from _written(evidence, i, {i: n, n: i}, "row", judged[n].row)
    labels = list(dict.fromkeys(judged[n].entry.label for n in alike))
    by_place = {(j.entry.label, j.entry.quantity): n for n, j in enumerate(judged)
                if (j.entry.plan, j.entry.title) == (e.plan, e.title)}
    for label in _next(labels, e.label):
        pairs = [(n, by_place[label, q]) for (at, q), n in by_place.items() if at == e.label and (label, q) in by_place]
        if len(pairs) > 1:
            both = ", ".join(sorted((e.label, label), key=labels.index))
            yield from _written(evidence, i, {x: y for a, b in pairs for x, y in ((a, b), (b, a))}, "positions", both)
    down, lengths = (sorted(some, key=lambda n: judged[n].line.line) for some in (range(len(judged)), alike))
    for rows, words in ((along, "position"), (lengths, "row"), (down, "row")):
        for by, which in ((-1, "before"), (1, "after")):
            yield from _shifted(evidence, i, rows, by, f"{words} {which}")


def _next(some: Sequence[T], one: T) -> list[T]:
    """The neighbours of one of some."""
    at = some.index(one)
    return [*some[max(at - 1, 0):at], *some[at + 1:at + 2]]


def _shifted(evidence: Evidence, i: int, rows: Sequence[int], by: int, words: str) -> Iterator[tuple[Hypothesis, Explanation]]:
    """That the rows round a number have, as far as that goes, the numbers of those before them (-1) or after them (1)."""
    of = {n: rows[k + by] for k, n in enumerate(rows) if 0 <= k + by < len(rows)}
    at = rows.index(i)
    run = [i] if i in of and _fits(evidence, i, of[i]) else []
    for step in (-1, 1):
        k = at + step
        while run and 0 <= k < len(rows) and rows[k] in of and _fits(evidence, rows[k], of[rows[k]]):
            run.append(rows[k])
            k += step
    run = sorted(run, key=rows.index)
    # What is right where it stands has not been shifted.
    while run and not _off(evidence, run[0]):
        run.pop(0)
    while run and not _off(evidence, run[-1]):
        run.pop()
    if i in run and sum(_off(evidence, n) for n in run) >= LEAST:
        judged = evidence.judged
        said = f"{judged[run[0]].row} … {judged[run[-1]].row}"
        for h, found in _written(evidence, i, {n: of[n] for n in run}, words, said):
            # Where the column was cut the number of a row that is not there came in.
            k = rows.index(run[0 if by < 0 else -1]) + by
            if _off(evidence, rows[k]):
                shares = found.shares.copy()
                shares[rows[k]] = evidence.left[rows[k]]
                found = replace(found, shares=shares)
            yield h, found


def _written(evidence: Evidence, i: int, of: Mapping[int, int], words: str, other: str) -> Iterator[tuple[
        Hypothesis, Explanation]]:
    """That rows have the numbers of others; nothing where that leaves much of one of them, or the number was hardly off."""
    off = [n for n in of if _off(evidence, n)]
    if i in off and len(off) >= min(len(of), 2) and all(_fits(evidence, n, m) for n, m in of.items()):
        shares, doubt = np.zeros((2, len(evidence.judged)))
        before = after = 0.0
        for n, m in of.items():
            shares[n] = _meant(evidence, m) - _meant(evidence, n)
            doubt[n] = evidence.allowed[m]
            before += float(loss(evidence.left[n] / evidence.allowed[n]))
            after += float(loss(_apart(evidence, n, m) / evidence.allowed[m]))
        h = Hypothesis("neighbour", words, evidence.judged[i].entry.terms[-1][0], (), other=Own(other))
        yield h, Explanation((), shares, doubt, before - after)


def _meant(evidence: Evidence, n: int) -> float:
    """The number that a row ought to have, with the mistakes found so far."""
    j = evidence.judged[n]
    return j.exact + j.deviation - float(evidence.left[n])


def _apart(evidence: Evidence, n: int, m: int) -> float:
    """How far the number of a row is from that of another."""
    j = evidence.judged[m]
    value = evidence.judged[n].line.value
    return j.apart((value if j.entry.signed or j.entry.kind == "angle" else abs(value)) - _meant(evidence, m))


def _off(evidence: Evidence, n: int) -> bool:
    return bool(abs(evidence.left[n]) > LEFT * evidence.allowed[n])


def _fits(evidence: Evidence, n: int, m: int) -> bool:
    """Whether a row may well have the number of another."""
    return bool(np.isfinite(evidence.allowed[[n, m]]).all() and abs(_apart(evidence, n, m)) <= LEFT * evidence.allowed[m])
