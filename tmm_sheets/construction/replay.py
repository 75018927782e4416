"""Steps done again by their own rules for other rows: other crank angles, or some of those they were recorded for.

Nothing is recorded anew, and no step's own value changes: one construction serves a whole search.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tmm_sheets.construction.given import FoundNumber
from tmm_sheets.construction.program import depending, name_of
from tmm_sheets.construction.step import Step, value_of


class Replay:
    """The moves that lead to some steps.

    Parameters
    ----------
    wanted
        steps whose values are asked for.
    rows
        arguments of the steps, or steps, in whose place others come.
    chosen
        names of given numbers in whose place others come.
    """

    def __init__(self, wanted: Sequence[Step], rows: Sequence[Any], chosen: Sequence[str] = ()) -> None:
        place = {id(x): n for n, x in enumerate(rows)}
        names = {name: n for n, name in enumerate(chosen, len(rows))}
        self._size = len(rows) + len(chosen)
        self._moves: list[tuple[Callable[..., Any], list[tuple[int, Any]]]] = []

        def slot(x: Any) -> tuple[int, Any]:
            """Number of a value among those computed, or -1 and the value itself."""
            x = x.step if isinstance(x, FoundNumber) and id(x.step) in place else x
            if id(x) in place:
                return place[id(x)], None
            if (name := name_of(x)) is not None and name in names:
                return names[name], None
            return -1, value_of(x)

        with np.errstate(all="ignore"):
            for step in depending(wanted, rows, chosen):
                if id(step) not in place:
                    place[id(step)] = self._size + len(self._moves)
                    self._moves.append((step.rule.compute, [slot(a) for a in step.args]))
            self._wanted = [slot(step) for step in wanted]

    def __len__(self) -> int:
        return len(self._moves)

    def __call__(self, inputs: Sequence[Any]) -> list[Any]:
        """Values of the wanted steps for the rows, and the chosen numbers, in their order."""
        values = [*inputs]
        with np.errstate(all="ignore"):
            for compute, slots in self._moves:
                values.append(compute(*(values[i] if i >= 0 else x for i, x in slots)))
        return [values[i] if i >= 0 else x for i, x in self._wanted]
