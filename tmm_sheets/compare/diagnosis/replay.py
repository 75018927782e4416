"""A construction drawn again with steps done otherwise, and everything that follows from them.

A :class:`Change` says of one step, at one position or at all, how it was done instead of its rule; :func:`replay` draws the
construction with such changes and gives any step's value then. Nothing is linear and no method is written a second time: what
follows is done by the rules of the record from what was drawn. Used so::

    errors = Errors([(plan, mu), ...])                      # plans that are on paper, for lengths of links to be kept
    k = plan["k"]                                           # Coriolis' acceleration, a vector laid off from its first argument
    value = replay(errors, [Change(k, laid_off_backwards, at=2)])
    value(plan["d5"])[2]                                    # where d5 came to lie at position 2

Changes of several mistakes go into one replay, a point that was displaced as well (:func:`displaced`). Which changes are worth
trying, and in what words they are told, is in :mod:`~tmm_sheets.compare.diagnosis.hypotheses`::

    for h in hypotheses(plans):                             # plans in the order of drawing
        value = replay(errors, h.changes)

and ``h.said()`` is what is told of the one that explains the drawing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.step import Step

Again = Callable[..., Any]
"""The step's own rule on other values of its arguments."""
Done = Callable[[Again, Sequence[Any]], Any]
"""How a step was done instead: from its own rule and the values of its arguments as they were drawn, for all positions."""


@dataclass(frozen=True)
class Change:
    """A step done otherwise than its rule says, at position number ``at`` or, without, at all of them."""

    step: Step
    done: Done
    at: int | None = None

    def made(self, again: Again, values: Sequence[Any], usual: Any) -> Any:
        """The step's value with this change; ``usual`` is that without it."""
        other = np.asarray(self.done(again, values))
        if self.at is None or not np.ndim(usual):
            return np.broadcast_to(other, np.shape(usual))[()]
        found = np.array(usual, dtype=np.result_type(usual, other))
        found[self.at] = other[self.at] if other.ndim else other
        return found


def replay(errors: Errors, changes: Iterable[Change]) -> Callable[[Step], Any]:
    """The construction with steps done otherwise: a function that gives any step's value then; NaN where it cannot be drawn."""
    by_step: dict[Step, list[Change]] = {}
    for change in changes:
        by_step.setdefault(change.step, []).append(change)

    def otherwise(step: Step, of_step: Sequence[Change]) -> Callable[[list[Any]], Any]:
        def done(values: list[Any]) -> Any:
            def again(*now: Any) -> Any:
                return errors.replayed(step, list(now))

            made = again(*values)
            for change in of_step:
                made = change.made(lambda *now, made=made: made if _same(now, values) else again(*now), values, made)
            return made

        return done

    return errors.redrawn({step: otherwise(step, of_step) for step, of_step in by_step.items()})


def _same(now: Sequence[Any], values: Sequence[Any]) -> bool:
    """True when the rule is asked for what changes before this one have made of the same arguments."""
    return len(now) == len(values) and all(a is b for a, b in zip(now, values, strict=True))


# --- ways to do a step otherwise -------------------------------------------------------------------------------------------


def opposite(again: Again, values: Sequence[Any]) -> Any:
    """With the other sign."""
    return -again(*values)


def laid_off(times: float) -> Done:
    """A vector laid off so many times as long from the point it begins at."""
    return lambda again, values: values[0] + times * (again(*values) - values[0])


laid_off_backwards = laid_off(-1.0)
"""A vector laid off the other way."""


def argument(i: int, other: Callable[[Any], Any]) -> Done:
    """With another value of argument number ``i``."""
    return lambda again, values: again(*values[:i], other(values[i]), *values[i + 1:])


def displaced(by: complex) -> Done:
    """Drawn off by so much."""
    def done(again: Again, values: Sequence[Any]) -> Any:
        made = np.asarray(again(*values))
        return made + (by if made.dtype.kind == "c" else by.real)

    return done


def of_position(k: int) -> Done:
    """With what belongs to another position."""
    return lambda again, values: np.asarray(again(*values))[k]
