"""Program of a construction: what its steps compute, as an ordered list of operations on named values; in no language.

The record's rules are data already: each is an expression, or a primitive by its name. A walk over the steps that lead to the
wanted ones puts the expressions together to one list without a branch or a loop: points and directions become pairs of real
numbers, what is computed once is not computed again, what follows from constants alone is a constant. Primitives that have a
plain formula are written out, the others are called by name. A :class:`Language` then writes each operation down
(:mod:`~tmm_sheets.construction.function`).

What a program is a function of: rows of numbers that differ from position to position (crank angles above all), and chosen givens
by their names in the project file (``crank.length``).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import Argument, Constant, Expression, Operation, Primitive, Type, trace
from tmm_sheets.construction.step import FoundNumber, Given, Step, ordered, parents, value_of
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import tell

GIVEN, NUMBER = "given", "number"
"""Values that are no operations: what the program is a function of, and constants."""
REAL = ("+", "-", "*", "/", "^", "negative", "abs", "sqrt", "sin", "cos", "tan", "atan", "atan2", "asin", "acos", "exp", "log",
        "cbrt", "hypot", "sign", "maximum", "minimum")
"""Operations on real numbers that every language has to write."""


@dataclass(frozen=True)
class ProgramValue:
    """A value of a program: given, a number, or what an operation ``does`` to values with smaller numbers.

    ``varies`` is False for what is the same at all positions. ``constant`` is a number's value, or of a given its place among
    the inputs. ``function`` is that of a primitive.
    """

    does: str
    of: tuple[int, ...] = ()
    gives: Type = "real"
    varies: bool = False
    constant: Any = None
    function: Callable[..., Any] | None = None


Parts = tuple[int, ...]
"""Numbers of the values that a step's value is made of: one, or the real and the imaginary part."""


@dataclass(frozen=True)
class Program:
    """Operations in their order, and what is asked of them.

    ``rows`` and ``chosen`` are the inputs, in this order: arguments of the steps, and names of givens with the values they have in
    the record; ``results`` the parts of each wanted value by its name; ``guards`` values that are small where the plain formulas
    lose digits (squares of sines).
    """

    values: tuple[ProgramValue, ...]
    rows: tuple[Any, ...]
    chosen: Mapping[str, Any]
    results: Mapping[str, Parts]
    guards: tuple[int, ...]

    @property
    def primitives(self) -> dict[str, Callable[..., Any]]:
        """Primitives that are called by name."""
        return {v.does: v.function for v in self.values if v.function is not None}


class Language(ABC):
    """How one operation is written; a program is written line by line, see :func:`written`."""

    @abstractmethod
    def name(self, number: int, value: ProgramValue) -> str:
        """Name of a value: of an operation's result, of an input or of a constant."""

    @abstractmethod
    def line(self, value: ProgramValue, result: str, operands: Sequence[str]) -> str:
        """The line that computes a value from others under their names."""


def written(program: Program, language: Language) -> tuple[list[str], list[str]]:
    """Names of all values of a program in a language, and a line for each operation."""
    names: list[str] = []
    lines: list[str] = []
    for number, value in enumerate(program.values):
        names.append(language.name(number, value))
        if value.does not in (GIVEN, NUMBER):
            lines.append(language.line(value, names[number], [names[i] for i in value.of]))
    return names, lines


def is_row(x: Any, positions: int) -> bool:
    """True for an argument of a step that has a number for each of so many positions, and no step to come from."""
    if isinstance(x, Given):
        return x.over == "positions" and np.ndim(x.value) == 1 and len(x.value) == positions
    return isinstance(x, np.ndarray) and x.ndim == 1 and len(x) == positions


def rows_of(steps: Iterable[Step], positions: int) -> list[Any]:
    """Rows over the positions that some steps are made of, each once."""
    return list({id(a): a for step in ordered(steps, parents) for a in step.args if is_row(a, positions)}.values())


def depending(steps: Iterable[Step], rows: Iterable[Any], chosen: Collection[str]) -> list[Step]:
    """What some steps are made of, themselves included, in order: those steps that depend on rows or chosen givens."""
    asked, found = {id(x) for x in rows}, dict[int, Step]()
    for step in ordered(steps, lambda step: [] if id(step) in asked else parents(step)):
        if id(step) in asked or any(id(a) in asked or id(_source_of(a)) in found or name_of(a) in chosen for a in step.args):
            found[id(step)] = step
    return list(found.values())


def name_of(x: Any) -> str | None:
    """Name of a given; None for a step and a bare number."""
    return None if isinstance(x, Step) else getattr(x, "name", None)


def _source_of(x: Any) -> Any:
    """The step of an argument that is one, or a number that was found by one."""
    return x.step if isinstance(x, FoundNumber) else x


def program(wanted: Mapping[str, Step], rows: Sequence[Any], chosen: Sequence[str] = (), exact: bool = False) -> Program:
    """The program that computes some steps.

    Parameters
    ----------
    wanted
        steps under the names of the results.
    rows
        arguments of the steps (rows over the positions) or steps, in whose place the program takes other values.
    chosen
        names of given numbers that may be others, too.
    exact
        True where primitives are called by name all of them: the program needs no guards, it is as exact as the steps.

    Raises
    ------
    CannotBuild
        when a rule has neither a formula nor a primitive, or nothing is made of a chosen given.
    """
    walk = _Walk(rows, chosen, exact)
    needed = walk.needed(wanted.values())
    for step in needed:
        walk.take(step)
    if unused := [name for name in chosen if name not in walk.used]:
        raise CannotBuild(tell("nothing is made of the given {name}").format(name=", ".join(unused)),
                          tell("choose one that the record names, such as crank.length"))
    results = {name: walk.parts(step) for name, step in wanted.items()}
    return _only_needed(Program(tuple(walk.list.values), tuple(rows), {name: walk.used[name] for name in chosen}, results,
                                tuple(walk.guards)))


def _only_needed(p: Program) -> Program:
    """Only values that results and guards are made of; inputs stay where they are asked for."""
    asked = {i for parts in p.results.values() for i in parts} | set(p.guards)
    for i in range(len(p.values) - 1, -1, -1):
        if i in asked:
            asked.update(p.values[i].of)
    place = {old: new for new, old in enumerate(sorted(asked))}
    values = tuple(ProgramValue(v.does, tuple(place[i] for i in v.of), v.gives, v.varies, v.constant, v.function)
                   for i, v in enumerate(p.values) if i in asked)
    return Program(values, p.rows, p.chosen, {name: tuple(place[i] for i in parts) for name, parts in p.results.items()},
                   tuple(dict.fromkeys(place[i] for i in p.guards)))


# --- the list of values ----------------------------------------------------------------------------------------------------


@dataclass
class _List:
    """Values so far; one that is there already is not made again, and nothing is done to constants alone."""

    values: list[ProgramValue] = field(default_factory=list)
    known: dict[Any, int] = field(default_factory=dict)

    def _enter(self, key: Any, value: ProgramValue) -> int:
        if key not in self.known:
            self.known[key] = len(self.values)
            self.values.append(value)
        return self.known[key]

    def given(self, place: int, gives: Type, varies: bool) -> int:
        """An input."""
        return self._enter((GIVEN, place), ProgramValue(GIVEN, (), gives, varies, place))

    def number(self, x: float) -> int:
        """A constant."""
        x = float(x) + 0.0  # -0.0 is 0.0
        return self._enter((NUMBER, x) if x == x else (NUMBER, "nan"), ProgramValue(NUMBER, (), "real", False, x))

    def thing(self, x: Any, gives: Type = "other") -> int:
        """A constant that is no real number: a point, a curve, a table."""
        return self._enter((gives, x if gives == "complex" else id(x)), ProgramValue(NUMBER, (), gives, False, x))

    def constant(self, i: int) -> float | None:
        """The number that a real value is always; None where it is not."""
        value = self.values[i]
        return value.constant if value.does == NUMBER and value.gives == "real" else None

    def done(self, does: str, *of: int, gives: Type = "real", function: Callable[..., Any] | None = None) -> int:
        """An operation, as it is."""
        key = (does, *(sorted(of) if does in "+*" else of))
        return self._enter(key, ProgramValue(does, of, gives, any(self.values[i].varies for i in of), None, function))

    def real(self, does: str, *of: int) -> int:
        """An operation on real numbers, or something simpler that gives the same."""
        numbers = [self.constant(i) for i in of]
        if any(self.values[i].gives != "real" for i in of):
            raise CannotBuild(tell("operation {name} on a table or a curve is not known here").format(name=does))
        if None not in numbers:
            with np.errstate(all="ignore"):
                return self.number(getattr(np, ufunc(does))(*map(np.float64, numbers)))
        return _SIMPLER[does](self, *of, *numbers) if does in _SIMPLER else self.done(does, *of)

    def _inside(self, i: int, does: str) -> Parts | None:
        """What a value is made of, if that is done to it."""
        return self.values[i].of if self.values[i].does == does else None

    # Signs and ones are carried no farther than they must be: a point's parts are often 0 or 1 times something.

    def _negative(self, a: int, _: float | None) -> int:
        if (inner := self._inside(a, "negative")) is not None:
            return inner[0]
        if (parts := self._inside(a, "-")) is not None:
            return self.done("-", parts[1], parts[0])
        return self.done("negative", a)

    def _plus(self, a: int, b: int, x: float | None, y: float | None) -> int:
        if x == 0:
            return b
        if y == 0:
            return a
        if (inner := self._inside(b, "negative")) is not None:
            return self.real("-", a, inner[0])
        if (inner := self._inside(a, "negative")) is not None:
            return self.real("-", b, inner[0])
        return self.done("+", a, b)

    def _minus(self, a: int, b: int, x: float | None, y: float | None) -> int:
        if y == 0:
            return a
        if x == 0:
            return self.real("negative", b)
        if a == b:
            return self.number(0.0)
        if (inner := self._inside(b, "negative")) is not None:
            return self.real("+", a, inner[0])
        if (inner := self._inside(a, "negative")) is not None:
            return self.real("negative", self.real("+", inner[0], b))
        return self.done("-", a, b)

    def _times(self, a: int, b: int, x: float | None, y: float | None) -> int:
        if x is not None:
            a, b, x, y = b, a, y, x
        if y == 0:
            return b
        if y == 1:
            return a
        if y == -1:
            return self.real("negative", a)
        one, other = self._inside(a, "negative"), self._inside(b, "negative")
        if one is not None or other is not None:
            product = self.real("*", a if one is None else one[0], b if other is None else other[0])
            return product if one is not None and other is not None else self.real("negative", product)
        if y is not None and (parts := self._inside(a, "*")) is not None:
            for inner, rest in (parts, parts[::-1]):
                if self.constant(inner) is not None:
                    return self.real("*", rest, self.real("*", inner, b))
        if a == b and (root := self._inside(a, "sqrt")) is not None:
            return root[0]
        return self.done("*", a, b)

    def _over(self, a: int, b: int, x: float | None, y: float | None) -> int:
        if x == 0:
            return a
        if y is not None and y != 0:
            return self.real("*", a, self.number(1 / y))
        if x == 1:
            return self.done("/", a, b)
        # One division for all that is divided by the same.
        return self.real("*", a, self.done("/", self.number(1.0), b))

    def _power(self, a: int, b: int, x: float | None, y: float | None) -> int:
        return self.real("*", a, a) if y == 2 else self.done("^", a, b)


_SIMPLER: dict[str, Callable[..., int]] = {
    "negative": _List._negative, "+": _List._plus, "-": _List._minus, "*": _List._times, "/": _List._over, "^": _List._power,
}
_NUMPY = {"+": "add", "-": "subtract", "*": "multiply", "/": "divide", "^": "power", "abs": "absolute", "atan2": "arctan2",
          "atan": "arctan", "asin": "arcsin", "acos": "arccos"}
"""Names of numpy's functions where they differ from those of the operations."""


def ufunc(does: str) -> str:
    """Name of numpy's function for an operation on real numbers."""
    return _NUMPY.get(does, does)


# --- the walk ----------------------------------------------------------------------------------------------------------------


@cache
def _arguments(compute: Callable[..., Any], count: int, exact: bool) -> frozenset[int] | None:
    """Numbers of the arguments that a rule's plain formula is made of; None for a rule without a formula."""
    tree = trace(compute, count)
    return None if tree is None else frozenset(_argument_numbers(tree, {}, exact))


def _argument_numbers(tree: Expression, known: dict[int, frozenset[int]], exact: bool) -> frozenset[int]:
    """Numbers of the arguments that a tree is made of, plain formulas written out."""
    if id(tree) not in known:
        if isinstance(tree, Operation):
            of = [_argument_numbers(part, known, exact) for part in tree.parts]
            plain = _plain(tree.function, exact)
            used = _arguments(plain, len(of), exact) if plain is not None else None
            if plain is not None and (guard := _guard(tree.function)) is not None:
                used = (used or frozenset()) | (_arguments(guard, len(of), exact) or frozenset())
            found = frozenset[int]().union(*(of if used is None else [of[i] for i in used]))
        else:
            found = frozenset({tree.index} if isinstance(tree, Argument) else ())
        known[id(tree)] = found
    return known[id(tree)]


def _primitive(function: Callable[..., Any] | None) -> Primitive | None:
    return getattr(function, "primitive", None)


def _plain(function: Callable[..., Any] | None, exact: bool) -> Callable[..., Any] | None:
    """The formula that is written out in place of a primitive; an ``exact`` program has only those that are their own."""
    found = _primitive(function)
    return None if found is None or (exact and found.plain is not function) else found.plain


def _guard(function: Callable[..., Any] | None) -> Callable[..., Any] | None:
    found = _primitive(function)
    return None if found is None else found.guard


class _Walk:
    """Steps one after another into the list of values."""

    def __init__(self, rows: Sequence[Any], chosen: Sequence[str], exact: bool) -> None:
        self.list = _List()
        self.exact = exact
        self.guards: list[int] = []
        self.rows = {id(x): n for n, x in enumerate(rows)}
        self.chosen = {name: n for n, name in enumerate(chosen, len(rows))}
        self.used: dict[str, Any] = {}
        self.inputs = rows
        self.known: dict[int, Parts] = {}

    def needed(self, wanted: Iterable[Step]) -> list[Step]:
        """Steps that depend on the inputs and that the plain formulas of the wanted ones are made of, in order."""
        wanted = list(wanted)
        found = depending(wanted, self.inputs, self.chosen)
        varying = {id(step) for step in found}
        asked = {id(step) for step in wanted}
        for step in reversed(found):
            if id(step) in asked and id(step) not in self.rows:
                used = _arguments(step.rule.compute, len(step.args), self.exact)
                if used is None:
                    raise CannotBuild(tell('rule "{rule}" has no formula').format(rule=step.rule.name))
                asked.update(id(_source_of(step.args[i])) for i in used)
        return [step for step in found if id(step) in asked & varying]

    def take(self, step: Step) -> None:
        """Put a step's arithmetic into the list."""
        if id(step) in self.rows:
            self.known[id(step)] = self._input(self.rows[id(step)], step)
            return
        used = _arguments(step.rule.compute, len(step.args), self.exact) or frozenset()
        tree = trace(step.rule.compute, len(step.args))
        assert tree is not None
        self.known[id(step)] = self._applied(tree, [self.parts(a) if i in used else () for i, a in enumerate(step.args)])

    def parts(self, x: Any) -> Parts:
        """A step, a given or a number as values."""
        if id(_source_of(x)) in self.known:
            return self.known[id(_source_of(x))]
        if id(x) in self.rows:
            return self._input(self.rows[id(x)], x)
        if (name := name_of(x)) in self.chosen:
            assert name is not None
            self.used[name] = value_of(x)
            return self._input(self.chosen[name], x)
        return self._constant(value_of(x))

    def _input(self, place: int, x: Any) -> Parts:
        value = value_of(x)
        kind = np.asarray(value).dtype.kind
        over = isinstance(x, Given) and x.over == "curve"
        varies = id(x) in self.rows
        if over or kind not in "biufc":
            return (self.list.given(place, "other", varies),)
        if kind == "c":
            return self._unpacked(self.list.given(place, "complex", varies))
        return (self.list.given(place, "real", varies),)

    def _constant(self, value: Any) -> Parts:
        if np.ndim(value) or np.asarray(value).dtype.kind not in "biufc":
            return (self.list.thing(value),)
        if np.asarray(value).dtype.kind == "c":
            return self.list.number(value.real), self.list.number(value.imag)
        return (self.list.number(value),)

    def _unpacked(self, i: int) -> Parts:
        return self.list.done("re", i), self.list.done("im", i)

    def _packed(self, parts: Parts) -> int:
        if len(parts) == 1:
            return parts[0]
        numbers = [self.list.constant(i) for i in parts]
        if None not in numbers:
            return self.list.thing(complex(*numbers), "complex")  # type: ignore[arg-type]
        return self.list.done("complex", *parts, gives="complex")

    def _applied(self, tree: Expression, args: Sequence[Parts], known: dict[int, Parts] | None = None) -> Parts:
        """A formula on some values."""
        known = {} if known is None else known
        if id(tree) not in known:
            if isinstance(tree, Argument):
                found = args[tree.index]
            elif isinstance(tree, Constant):
                found = self._constant(tree.value)
            else:
                assert isinstance(tree, Operation)
                found = self._operation(tree, args, known)
            known[id(tree)] = found
        return known[id(tree)]

    def _operation(self, tree: Operation, args: Sequence[Parts], known: dict[int, Parts]) -> Parts:
        count = len(tree.parts)
        if tree.function is None:
            return self._arithmetic(tree.name, [self._applied(part, args, known) for part in tree.parts])
        plain, guard = _plain(tree.function, self.exact), _guard(tree.function)
        used = None if plain is None else _arguments(plain, count, self.exact)
        if used is None or plain is None:
            return self._called(tree, [self._applied(part, args, known) for part in tree.parts])
        if guard is not None:
            used |= _arguments(guard, count, self.exact) or frozenset()
        of = [self._applied(part, args, known) if i in used else () for i, part in enumerate(tree.parts)]
        if all(self.list.constant(i) is not None for parts in of for i in parts) and all(of):
            return self._constant(tree.function(*map(self._number, of)))
        formula = trace(plain, count)
        assert formula is not None
        if guard is not None and (check := trace(guard, count)) is not None:
            self.guards += self._applied(check, of)
        return self._applied(formula, of)

    def _number(self, parts: Parts) -> Any:
        numbers = [self.list.values[i].constant for i in parts]
        return complex(*numbers) if len(numbers) == 2 else numbers[0]

    def _called(self, tree: Operation, of: list[Parts]) -> Parts:
        """A primitive that is called by its name, at once where all that it takes is constant."""
        values = [self.list.values[i] for parts in of for i in parts]
        if tree.function is not None and all(v.does == NUMBER for v in values):
            return self._constant(tree.function(*map(self._number, of)))
        found = _primitive(tree.function)
        gives: Type = "complex" if found is None else found.gives
        i = self.list.done(tree.name, *map(self._packed, of), gives=gives, function=tree.function)
        return self._unpacked(i) if gives == "complex" else (i,)

    # Complex arithmetic in real numbers; a number of one part is real.

    def _arithmetic(self, name: str, of: list[Parts]) -> Parts:
        real = self.list.real
        if name in ("+", "-") and len(of) == 2:
            a, b = of
            if len(a) == len(b) == 1:
                return (real(name, a[0], b[0]),)
            zero = self.list.number(0.0)
            return tuple(real(name, x, y) for x, y in zip((*a, zero)[:2], (*b, zero)[:2], strict=True))
        if name == "+":
            return of[0]
        if name == "-":
            return tuple(real("negative", i) for i in of[0])
        if name == "*":
            return self._product(*of)
        if name == "/":
            return self._quotient(*of)
        if name in ("re", "im", "conj", "abs"):
            return self._part(name, of[0])
        if name == "^" and len(of[0]) == 2 and self.list.constant(of[1][0]) == 2:
            return self._product(of[0], of[0])
        if name == "exp" and len(of[0]) == 2:
            x, y = of[0]
            size = real("exp", x)
            return real("*", size, real("cos", y)), real("*", size, real("sin", y))
        if any(len(parts) != 1 for parts in of):
            raise CannotBuild(tell("operation {name} on points is not known here").format(name=name))
        return (real(name, *(parts[0] for parts in of)),)

    def _part(self, name: str, of: Parts) -> Parts:
        x, y = (*of, self.list.number(0.0))[:2]
        if name == "re":
            return (x,)
        if name == "im":
            return (y,)
        if name == "conj":
            return (x, self.list.real("negative", y)) if len(of) == 2 else of
        return (self.list.real("sqrt", self._square(of)),) if len(of) == 2 else (self.list.real("abs", x),)

    def _square(self, of: Parts) -> int:
        x, y = of
        return self.list.real("+", self.list.real("*", x, x), self.list.real("*", y, y))

    def _product(self, a: Parts, b: Parts) -> Parts:
        real = self.list.real
        if len(a) == 1 or len(b) == 1:
            return tuple(real("*", i, k) for i in a for k in b)
        (x, y), (u, v) = a, b
        return real("-", real("*", x, u), real("*", y, v)), real("+", real("*", x, v), real("*", y, u))

    def _quotient(self, a: Parts, b: Parts) -> Parts:
        if len(b) == 1:
            return tuple(self.list.real("/", i, b[0]) for i in a)
        square = self._square(b)
        return tuple(self.list.real("/", i, square) for i in self._product(a, self._part("conj", b)))


