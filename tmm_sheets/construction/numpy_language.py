"""A program as the source of one straight-line NumPy function: an array operation a line, into rows that are used again.

What is the same at all positions is computed first, in plain numbers; what varies goes through the rows of a work array, each
taken over as soon as nobody needs what stands in it: a block of positions stays in the processor's cache, and no array is made on
the way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from tmm_sheets.construction.program import GIVEN, NUMBER, REAL, Language, Program, ProgramValue, ufunc, written

_OTHERS = {"complex": "packed({0}, {1})", "re": "{0}.real", "im": "{0}.imag"}


class NumPy(Language):
    """Names and lines: ``x`` inputs, ``k`` constants, ``h`` what does not vary, ``r`` rows of the work array, ``z`` other values.

    ``row`` says which row for which value. Results have the first ``results`` rows to themselves: the real parts of points, their
    imaginary parts, real numbers; ``copied`` are those that stand elsewhere, too, by row and value.
    """

    def __init__(self, program: Program) -> None:
        self.values = program.values
        self.constants: list[Any] = []
        many = list(program.results.values())
        results = [*(p[0] for p in many if len(p) == 2), *(p[1] for p in many if len(p) == 2), *(p[0] for p in many if len(p) == 1)]
        self.row: dict[int, int] = {}
        self.copied: list[tuple[int, int]] = []
        for row, i in enumerate(results):
            if i in self.row or not _in_row(self.values[i]):
                self.copied.append((row, i))
            else:
                self.row[i] = row
        self.rows = self.results = len(results)
        self.guards = program.guards
        self._take_rows()

    def _take_rows(self) -> None:
        """Rows of all other values, freed when they have been used for the last time; guards are looked at in the end."""
        last = {i: n for n, value in enumerate(self.values) for i in value.of} | dict.fromkeys(self.guards, len(self.values))
        kept, free = set(self.row), list[int]()
        for n, value in enumerate(self.values):
            free += [self.row[i] for i in set(value.of) if last[i] == n and i in self.row and i not in kept]
            if _in_row(value) and n not in kept:
                if not free:
                    free.append(self.rows)
                    self.rows += 1
                self.row[n] = free.pop()

    def name(self, number: int, value: ProgramValue) -> str:
        """Name of a value."""
        if value.does == NUMBER:
            self.constants.append(value.constant)
            return f"k{len(self.constants) - 1}"
        if value.does == GIVEN:
            return f"x{value.constant}"
        return f"r{self.row[number]}" if number in self.row else f"z{number}" if value.varies else f"h{number}"

    def line(self, value: ProgramValue, result: str, operands: Sequence[str]) -> str:
        """The line of an operation."""
        if value.function is not None:
            of = [name if self._whole(i) else f"single({name})" for i, name in zip(value.of, operands, strict=True)]
            return f"{result} = {_called(value.does)}({', '.join(of)})"
        if value.does in _OTHERS:
            return f"{result} = {_OTHERS[value.does].format(*operands)}"
        if _in_row(value):
            place = f"out={result}" if value.does in ("maximum", "minimum") else result  # as numpy wants it
            return f"{ufunc(value.does)}({', '.join(operands)}, {place})"
        return f"{result} = asarray({ufunc(value.does)}({', '.join(operands)}))"

    def _whole(self, i: int) -> bool:
        """Whether a primitive takes a value as it stands: numbers that do not vary it takes as numbers of their own."""
        value = self.values[i]
        return value.varies or value.gives != "real"


def _in_row(value: ProgramValue) -> bool:
    return value.varies and value.does in REAL and value.function is None


def _called(primitive: str) -> str:
    """Name of a primitive's function in the source."""
    return "_" + "".join(c if c.isalnum() else "_" for c in primitive)


def packed(x: Any, y: Any) -> Any:
    """A point from its coordinates."""
    found = np.empty(np.broadcast_shapes(np.shape(x), np.shape(y)), dtype=complex)
    found.real, found.imag = x, y
    return found if found.ndim else complex(found)


def single(x: Any) -> Any:
    """A number of its own instead of an array of one."""
    return x if x.ndim else x.item()


class NumpySource:
    """The text of a program's function ``f(x, k, r)``: inputs, ``constants``, ``rows`` of the work array, the first ``results`` of
    which are filled; the least guard of each position is left in row ``check``, -1 for none.
    """

    def __init__(self, program: Program) -> None:
        language = NumPy(program)
        names, body = written(program, language)
        body += [f"r{row}[:] = {names[i]}" for row, i in language.copied]
        self.rows, self.results, self.check = language.rows, language.results, -1
        if language.guards:
            self.check = self.rows
            self.rows += 1
            first, *others = [names[i] for i in language.guards]
            body += [f"r{self.check}[:] = {first}", *(f"minimum(r{self.check}, {g}, out=r{self.check})" for g in others)]
        head = ["def f(x, k, r):"]
        for letter, many in (("x", len(program.rows) + len(program.chosen)), ("k", len(language.constants)), ("r", self.rows)):
            if many:
                head.append(f"    {''.join(f'{letter}{i}, ' for i in range(many))}= {letter}")
        self.text = "\n".join([*head, *(f"    {line}" for line in body), ""])
        self.constants = tuple(np.asarray(c) if isinstance(c, float) else c for c in language.constants)
        self.primitives = {_called(name): function for name, function in program.primitives.items()}

    def function(self) -> Callable[..., None]:
        """The compiled function; the same text is compiled once."""
        known: dict[str, Any] = {"asarray": np.asarray, "packed": packed, "single": single, **_UFUNCS, **self.primitives}
        exec(_code(self.text), known)
        return known["f"]  # type: ignore[no-any-return]


_UFUNCS = {name: getattr(np, name) for name in map(ufunc, REAL)}


@lru_cache(maxsize=64)
def _code(text: str) -> Any:
    """Compiled text: mechanisms that differ in their numbers alone have the same."""
    return compile(text, "<program of a plan>", "exec")
