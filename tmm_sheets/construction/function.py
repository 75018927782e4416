"""One function instead of many steps: the values of some steps for any crank angles, or for any chosen lengths.

The plain formulas of the steps' program run on a block of positions at a time. Where a guard says that they lose digits, lines
that cross under a small angle, and where something is not defined, the steps themselves are done again for those positions. So the
values are those of the steps to some 1e-14 of their size, and to the last digit where it is hard.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.construction.numpy_language import NumpySource
from tmm_sheets.construction.program import depending, is_row, program
from tmm_sheets.construction.replay import Replay
from tmm_sheets.construction.step import Step, ordered, parents, value_of

BLOCK = 2048
"""Positions computed at a time."""
NARROW = 1 / 2
"""Sine of the angle of a crossing below which the plain formulas are not relied on: 30 degrees, the surveyors' rule for crossings.

Errors grow with the square of its inverse in velocities, faster in accelerations.
"""


class Function:
    """The values of some steps as a function of rows, one number for each position, and of chosen givens.

    Parameters
    ----------
    wanted
        steps by the names of the results.
    rows
        what the function takes: rows that the steps are made of, or steps in whose place other values are given.
    chosen
        names of given numbers (``crank.length``) that it takes besides.

    Raises
    ------
    CannotBuild
        when a rule has no formula, or nothing is made of a chosen given.
    """

    def __init__(self, wanted: Mapping[str, Step], rows: Sequence[Any], chosen: Sequence[str] = ()) -> None:
        self.program = program(wanted, rows, chosen)
        self.source = NumpySource(self.program)
        self._steps = dict(wanted)
        self._run = self.source.function()
        self._points = [name for name, parts in self.program.results.items() if len(parts) == 2]
        self._numbers = [name for name, parts in self.program.results.items() if len(parts) == 1]

    @cached_property
    def _again(self) -> Replay:
        return Replay([self._steps[name] for name in (*self._points, *self._numbers)], self.program.rows, [*self.program.chosen])

    def __call__(self, *rows: Any, given: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Values of shape (n,) by name for rows of shape (n,); NaN where they are not defined.

        ``given`` are other values of chosen givens, one number or of shape (n,); those that are not told are as recorded.
        """
        inputs = [*map(np.asarray, rows), *(np.asarray((given or {}).get(name, own)) for name, own in self.program.chosen.items())]
        n = max((len(x) for x in inputs if x.ndim), default=1)
        points = np.empty((len(self._points), n), dtype=complex)
        numbers = np.empty((len(self._numbers), n))
        for begin in range(0, n, BLOCK):
            here = slice(begin, begin + BLOCK)
            self._block([x[here] if x.ndim else x for x in inputs], points[:, here], numbers[:, here])
        return {**dict(zip(self._points, points, strict=True)), **dict(zip(self._numbers, numbers, strict=True))}

    def _block(self, inputs: list[Any], points: Any, numbers: Any) -> None:
        work = np.empty((self.source.rows, points.shape[1]))
        with np.errstate(all="ignore"):
            self._run(inputs, self.source.constants, work)
        m = len(points)
        points.real, points.imag, numbers[:] = work[:m], work[m:2 * m], work[2 * m:self.source.results]
        if self.source.check >= 0 and not (check := work[self.source.check]).min(initial=np.inf) > NARROW**2:
            self._exactly(np.flatnonzero(~(check > NARROW**2)), inputs, points, numbers)

    def _exactly(self, at: Any, inputs: list[Any], points: Any, numbers: Any) -> None:
        """The steps themselves at some positions."""
        count = len(self.program.rows)
        several = any(x.ndim for x in inputs[count:])  # rules take chosen numbers one at a time
        for k in at[:, None] if several else (at,):
            found = self._again([*(x[k] if x.ndim else x for x in inputs[:count]),
                                 *((x[k[0]] if x.ndim else x).item() for x in inputs[count:])])
            for row, value in zip((*points, *numbers), found, strict=True):
                row[k] = value


def fill(steps: Iterable[Step], positions: int) -> None:
    """Compute the values of steps by one function, and let the steps have them as if each had computed its own.

    Raises
    ------
    CannotBuild
        when a rule has no formula.
    """
    asked = {id(step): step for step in steps if not step.evaluated}
    unknown = list(ordered(asked.values(), lambda step: [p for p in parents(step) if not p.evaluated]))
    # Values that are there already are taken as they are: all that hangs on one value hangs on the same digits of it.
    known = [p for step in unknown for p in parents(step) if p.evaluated and np.shape(p.value) == (positions,)]
    rows = [*{id(x): x for x in (*(a for step in unknown for a in step.args if is_row(a, positions)), *known)}.values()]
    wanted = {str(n): step for n, step in enumerate(depending(asked.values(), rows, ())) if id(step) in asked}
    if wanted:
        found = Function(wanted, rows)(*map(value_of, rows))
        for name, step in wanted.items():
            step.__dict__["value"] = found[name]
