"""Expressions (формулы): the arithmetic of a rule as a tree, read off the rule's own function.

A rule's ``compute`` is called once with symbols instead of numbers; every operation that numpy knows as a ufunc notes itself. So
there is one definition of each formula: what is computed is what is typeset, told in the record and differentiated. A function
that branches, loops until something converges or compares values cannot be read off: it is a :func:`primitive` of the construction.

The tree is ``Argument`` (by its number), ``Constant`` or ``Operation`` (name and operands); :func:`evaluate` computes it,
:func:`as_json` and :func:`from_json` carry it; :func:`lettered` writes it in one line with any texts in the places of the
arguments.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, reduce, wraps
from types import ModuleType
from typing import Any, Literal, TypeAlias, TypeVar, cast

import numpy as np
import numpy.typing as npt

# --- quantities ---------------------------------------------------------------------------------------------------------

# What the functions of constructions take and give, by name: quantities of one position, or of many at once. The plane is that of
# the complex numbers, lengths are metres and angles radians unless a function says otherwise. Each is a number, or an array with
# one at each position, shape (positions,), or of any other shapes that NumPy broadcasts: a function gives what its arguments
# broadcast to, and NaN where its construction does not exist. For the type checker they are anything: a function is also traced
# with symbols.
Points: TypeAlias = Any
"""Points x + iy, m."""
Vectors: TypeAlias = Any
"""Plane vectors x + iy: forces, N, velocities, m/s ..."""
Directions: TypeAlias = Any
"""Vectors of length 1 without unit."""
Reals: TypeAlias = Any
"""Lengths, m, angles, rad, and other real numbers."""
Signs: TypeAlias = Any
"""+1 or -1: one or the other of two solutions, as the function says."""
Floats: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]

# --- trees --------------------------------------------------------------------------------------------------------------

_SIGNS = {"add": "+", "subtract": "-", "multiply": "*", "divide": "/", "power": "^", "negative": "-", "positive": "+",
          "absolute": "abs", "conjugate": "conj", "arctan2": "atan2", "arctan": "atan", "arcsin": "asin",
          "arccos": "acos"}
"""Names in the record of numpy's functions, where they differ."""
_UFUNCS = {sign: name for name, sign in _SIGNS.items() if sign not in ("-", "+")}
_KNOWN = {*_SIGNS, "sqrt", "square", "cbrt", "reciprocal", "sin", "cos", "tan", "exp", "log", "hypot", "sign", "maximum", "minimum"}


Type = Literal["real", "complex", "other"]
"""A number, a point or direction, or something that no arithmetic takes: a curve, a table."""
Function = TypeVar("Function", bound=Callable[..., Any])


@dataclass(frozen=True)
class Primitive:
    """What a primitive is besides its name.

    ``plain`` is its formula as a textbook has it: the same numbers where the construction is well conditioned, without a branch;
    None where there is none. ``guard`` tells where: the square of the sine of the angle under which the lines cross; None for a
    formula that loses nothing. Both take the primitive's arguments. ``gives`` is the type of its value.
    """

    name: str
    gives: Type
    plain: Callable[..., Any] | None = None
    guard: Callable[..., Any] | None = None


def primitive(name: str, gives: Type = "complex", plain: Callable[..., Any] | None = None,
              guard: Callable[..., Any] | None = None, formula: bool = False) -> Callable[[Function], Function]:
    """Decorator: the function stands in a tree as one operation of that name, its inside is not looked into.

    See :class:`Primitive`; a ``formula`` is its own plain one.
    """
    def made(function: Function) -> Function:
        @wraps(function)
        def called(*operands: Any, **known: Any) -> Any:
            for x in operands:
                if isinstance(x, Expression):
                    return Operation(name, tuple(map(_node, (*operands, *known.values()))), function)
            return function(*operands, **known)

        called.__dict__["primitive"] = function.__dict__["primitive"] = Primitive(
            name, gives, function if formula else plain, guard)
        return cast("Function", called)

    return made


def primitives(*modules: ModuleType) -> dict[str, Callable[..., Any]]:
    """The primitives that some modules define, by their names in the record."""
    return {f.primitive.name: f for m in modules for f in vars(m).values()
            if callable(f) and hasattr(f, "primitive") and f.__module__ == m.__name__}


class Expression(np.lib.mixins.NDArrayOperatorsMixin):
    """A node of the tree; takes part in arithmetic as a number would."""

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any, **options: Any) -> Any:
        """Note the operation instead of carrying it out."""
        if method != "__call__" or options or ufunc.__name__ not in _KNOWN:
            return NotImplemented
        parts = tuple(map(_node, operands))
        if ufunc.__name__ == "square":
            return Operation("^", (parts[0], Constant(2.0)))
        if ufunc.__name__ == "reciprocal":
            return Operation("/", (Constant(1.0), parts[0]))
        return Operation(_SIGNS.get(ufunc.__name__, ufunc.__name__), parts)

    @property
    def real(self) -> Expression:
        """Real part."""
        return Operation("re", (self,))

    @property
    def imag(self) -> Expression:
        """Imaginary part."""
        return Operation("im", (self,))

    def conjugate(self) -> Expression:
        """Conjugate number."""
        return Operation("conj", (self,))

    def __bool__(self) -> bool:
        """Symbols have no truth: a function that branches is no formula."""
        raise TypeError("an expression is neither true nor false")

    __hash__ = object.__hash__


@dataclass(frozen=True, eq=False)
class Argument(Expression):
    """The argument with that number."""

    index: int


@dataclass(frozen=True, eq=False)
class Constant(Expression):
    """A number of the formula itself: 2, pi, the imaginary unit."""

    value: float | complex


@dataclass(frozen=True, eq=False)
class Operation(Expression):
    """A named operation on parts: + - * / ^ abs conj re im sqrt sin ..., or a primitive with its function."""

    name: str
    parts: tuple[Expression, ...]
    function: Callable[..., Any] | None = None


def _node(x: Any) -> Expression:
    if isinstance(x, Expression):
        return x
    if isinstance(x, int | float | np.number | complex):
        return Constant(complex(x) if isinstance(x, complex | np.complexfloating) else float(x))
    raise TypeError(f"{x!r} is no part of a formula")


@cache
def trace(compute: Callable[..., Any], count: int) -> Expression | None:
    """Tree of a function of ``count`` numbers; None for one that is no formula (a primitive of the construction).

    >>> as_json(trace(lambda m, v: m * v**2 / 2, 2))
    {'/': [{'*': [{'arg': 0}, {'^': [{'arg': 1}, 2.0]}]}, 2.0]}
    """
    try:
        return _node(compute(*[Argument(i) for i in range(count)]))
    except (TypeError, AttributeError, ValueError, IndexError):
        return None


def fold(tree: Expression, argument: Callable[[int], Any], constant: Callable[[Any], Any],
         operation: Callable[[Operation, list[Any]], Any]) -> Any:
    """What comes of a tree from its leaves up: of an argument's number, a constant's value, an operation and its parts' values."""
    if isinstance(tree, Operation):
        return operation(tree, [fold(part, argument, constant, operation) for part in tree.parts])
    return argument(tree.index) if isinstance(tree, Argument) else constant(tree.value)  # type: ignore[attr-defined]


def evaluate(tree: Expression, arguments: Sequence[Any]) -> Any:
    """Value of a tree at some values of its arguments."""
    return fold(tree, arguments.__getitem__, lambda value: value, _operated)


def _operated(tree: Operation, values: list[Any]) -> Any:
    if tree.name in ("re", "im"):
        return np.real(values[0]) if tree.name == "re" else np.imag(values[0])
    if tree.function is not None:
        return tree.function(*values)
    if tree.name in "+-":
        if len(values) == 1:
            return values[0] if tree.name == "+" else np.negative(values[0])
        return reduce(np.add if tree.name == "+" else np.subtract, values)
    return getattr(np, _UFUNCS.get(tree.name, tree.name))(*values)


def as_json(tree: Expression) -> Any:
    """The tree as JSON: a number, ``{"arg": number}`` or ``{operation: operands}``.

    >>> as_json(2.0 * (1.0 - Argument(0)))
    {'*': [2.0, {'-': [1.0, {'arg': 0}]}]}
    """
    return fold(tree, lambda i: {"arg": i}, lambda x: {"complex": [x.real, x.imag]} if isinstance(x, complex) else x,
                lambda operation, parts: {operation.name: parts})


def from_json(data: Any, known: Mapping[str, Callable[..., Any]]) -> Expression:
    """The tree that :func:`as_json` wrote, with the ``known`` primitives."""
    if isinstance(data, int | float):
        return Constant(float(data))
    ((name, of),) = data.items()
    if name == "arg":
        return Argument(of)
    return Constant(complex(*of)) if name == "complex" else Operation(name, tuple(from_json(x, known) for x in of), known.get(name))
