"""A few of many cases belong to ``make test``, all the others to ``make trials``."""

import pytest


def seldom(*case):
    """A case for ``parametrize`` that is tried by ``make trials`` alone."""
    return pytest.param(*case, marks=pytest.mark.trial)


def few(cases, *kept):
    """Cases for ``parametrize``: those ``kept`` as they are, each of the others a trial.

    Kept are the cases that differ in what the program does with them; a trial walks the same way once more.
    """
    cases = list(cases)
    gone = [case for case in kept if case not in cases]
    assert not gone, gone
    return [case if case in kept else seldom(*(case if isinstance(case, tuple) else (case,))) for case in cases]


def all_hold(check, cases):
    """A check of many cases that cost next to nothing each, as one test: it fails with a list of all cases that do not hold."""
    failed = {}
    for case in cases:
        try:
            check(*case if isinstance(case, tuple) else (case,))
        except Exception as e:
            failed[str(case)] = f"{type(e).__name__}: {e}"
    assert not failed, "\n".join(f"{case}: {said}" for case, said in failed.items())
