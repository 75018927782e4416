"""A program as the text of one JavaScript function of a single position: a line for each operation, primitives called by name.

The primitives are written by hand, see ``templates/living/primitives.js``: a point is a pair ``[x, y]`` there, a curve an object.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from math import isfinite, isnan
from typing import Any

import numpy as np

from tmm_sheets.construction.curve import Curve
from tmm_sheets.construction.program import GIVEN, NUMBER, Language, Program, ProgramValue, written

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
        return np.stack((array.real, array.imag), axis=-1).tolist() if np.isfinite(array).all() else _undefined(array)
    found = array.tolist()
    return found if array.dtype.kind != "f" or np.isfinite(array).all() else [None if x != x else x for x in found]


def _undefined(array: Any) -> Any:
    return [[None if x != x else x for x in (z.real, z.imag)] for z in np.atleast_1d(array).tolist()]
