"""One function instead of many steps: the values of some steps for any crank angles, or for any chosen lengths.

The plain formulas of the steps' program run on a block of positions at a time. Where a guard says that they lose digits, lines
that cross under a small angle, and where something is not defined, the steps themselves are done again for those positions. So the
values are those of the steps to some 1e-14 of their size, and to the last digit where it is hard.

A program as the text of one JavaScript function of a single position: a line for each operation, primitives called by name.

The primitives are written by hand, see ``templates/living/primitives.js``: a point is a pair ``[x, y]`` there, a curve an object.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, lru_cache
from math import isfinite, isnan
from time import perf_counter
from typing import Any

import numpy as np

from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.program import (
    GIVEN,
    NUMBER,
    REAL,
    Language,
    Program,
    ProgramValue,
    depending,
    is_row,
    name_of,
    program,
    ufunc,
    written,
)
from tmm_sheets.construction.step import FoundNumber, SearchCount, Step, ordered, parents, value_of

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
            return f"{result} = {_function_name(value.does)}({', '.join(of)})"
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


def _function_name(primitive: str) -> str:
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
        self.primitives = {_function_name(name): function for name, function in program.primitives.items()}

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


_INFIX = frozenset("+-*/")
_FUNCTIONS = {"^": "Math.pow", "maximum": "Math.max", "minimum": "Math.min"}
_PACKED = {"complex": "[{0}, {1}]", "re": "{0}[0]", "im": "{0}[1]", "negative": "-{0}"}


class JavaScript(Language):
    """Names and lines: ``x`` inputs, ``k`` constants that are no numbers, ``p`` primitives, ``v`` other values."""

    def __init__(self, program: Program) -> None:
        self.constants: list[Any] = []
        self.primitives = {name: f"p{n}" for n, name in enumerate(program.primitives)}

    def name(self, number: int, value: ProgramValue) -> str:
        """Name of a value; a number stands for itself."""
        if value.does == GIVEN:
            return f"x[{value.constant}]"
        if value.does != NUMBER:
            return f"v{number}"
        if value.gives == "real":
            return literal(value.constant)
        self.constants.append(value.constant)
        return f"k[{len(self.constants) - 1}]"

    def line(self, value: ProgramValue, result: str, operands: Sequence[str]) -> str:
        """The line of an operation."""
        if value.function is not None:
            found = f"{self.primitives[value.does]}({', '.join(operands)})"
        elif value.does in _INFIX:
            found = f" {value.does} ".join(operands)
        elif value.does in _PACKED:
            found = _PACKED[value.does].format(*(f"({o})" if o.startswith("-") else o for o in operands))
        else:
            found = f"{_FUNCTIONS.get(value.does, f'Math.{value.does}')}({', '.join(operands)})"
        return f"const {result} = {found};"


def literal(x: float) -> str:
    """A real number as JavaScript writes it."""
    return repr(float(x)) if isfinite(x) else "NaN" if isnan(x) else "Infinity" if x > 0 else "-Infinity"


class JavaScriptSource:
    """The text of a program as ``function (x, k, p)``: inputs, ``constants``, primitives by their names.

    It returns the parts of all results one after another: two numbers of a point, one of a number; ``results`` says which, by the
    names of the results: where the first part stands and how many there are.
    """

    def __init__(self, program: Program) -> None:
        language = JavaScript(program)
        names, lines = written(program, language)
        found = [f"const {short} = p[{json.dumps(name)}];" for name, short in language.primitives.items()]
        parts: list[str] = []
        self.results: dict[str, tuple[int, int]] = {}
        for name, of in program.results.items():
            self.results[name] = (len(parts), len(of))
            parts += [names[i] for i in of]
        self.text = "\n".join(["function (x, k, p) {", *found, *lines, f"return [{', '.join(parts)}];", "}"])
        self.constants = [told(c) for c in language.constants]
        self.primitives = tuple(language.primitives)


def told(value: Any) -> Any:
    """A constant for JSON: points as pairs, rows as lists, curves by their parts; null where nothing is defined."""
    if isinstance(value, Curve):
        return {"x": told(value.x), "y": told(value.y), "left": told(value.left), "right": told(value.right), "law": value.law}
    array = np.asarray(value)
    if array.dtype.kind == "c":
        pairs = [[None if x != x else x for x in (z.real, z.imag)] for z in np.atleast_1d(array).tolist()]
        return np.stack((array.real, array.imag), axis=-1).tolist() if np.isfinite(array).all() else pairs
    found = array.tolist()
    return found if array.dtype.kind != "f" or np.isfinite(array).all() else [None if x != x else x for x in found]


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

    def __call__(self, inputs: Sequence[Any], search: SearchCount | None = None) -> list[Any]:
        """Values of the wanted steps for the rows, and the chosen numbers, in their order; a ``search`` counts the moves."""
        values, begin = [*inputs], perf_counter()
        with np.errstate(all="ignore"):
            for compute, slots in self._moves:
                values.append(compute(*[values[i] if i >= 0 else x for i, x in slots]))
        if search is not None:
            search.again(len(self), perf_counter() - begin)
        return [values[i] if i >= 0 else x for i, x in self._wanted]
