"""Formulas as trees of a few kinds of nodes, made from the expressions of the record; the writers walk them.

Letters come in lettering markup (``M_{с}^{пр}``, ``ω_1``, an overbar for a vector) or as names of steps (``Fи3``, ``F21τ``).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import isclose, pi
from typing import Any, TypeGuard, TypeVar

from tmm_sheets.construction import expression
from tmm_sheets.numbers import rounded, written


class Node:
    """A part of a formula."""

    def parts(self) -> tuple[Node, ...]:
        """The nodes it is made of."""
        return tuple(x for v in vars(self).values() for x in (v if isinstance(v, tuple) else (v,)) if isinstance(x, Node))

    def of_parts(self, change: Callable[[Node], Node]) -> Node:
        """A node of this kind with changed parts."""

        def changed(value: Any) -> Any:
            if isinstance(value, Node):
                return change(value)
            return tuple(map(changed, value)) if isinstance(value, tuple) else value

        return type(self)(*map(changed, vars(self).values()))

    def numbers(self) -> Iterator[Any]:
        """Numbers of the record in it, in order."""
        if isinstance(self, Figures) and self.source is not None:
            yield self.source
        for part in self.parts():
            yield from part.numbers()


@dataclass(frozen=True)
class Letters(Node):
    """One letter, or a word: Latin and Greek ones are set slanting, others upright."""

    text: str


@dataclass(frozen=True)
class Figures(Node):
    """A number; ``source`` is the number of the record it shows, None for one of the formula itself."""

    text: str
    source: Any = None


@dataclass(frozen=True)
class Sign(Node):
    """A sign between two parts, or a bracket."""

    text: str


@dataclass(frozen=True)
class Words(Node):
    """Upright text: a unit, a name of a function, a remark."""

    text: str


@dataclass(frozen=True)
class FormulaRow(Node):
    """Parts one after another."""

    items: tuple[Node, ...]


@dataclass(frozen=True)
class Scripts(Node):
    """A base with an index below, or a power or mark above."""

    base: Node
    below: Node | None = None
    above: Node | None = None


@dataclass(frozen=True)
class Fraction(Node):
    """Numerator over denominator."""

    over: Node
    under: Node


@dataclass(frozen=True)
class Root(Node):
    """Square root."""

    of: Node


@dataclass(frozen=True)
class Fenced(Node):
    """Between growing brackets."""

    left: str
    of: Node
    right: str


@dataclass(frozen=True)
class Barred(Node):
    """With a bar above: a vector, or a chord."""

    of: Node


@dataclass(frozen=True)
class Underlined(Node):
    """Underlined as often as ``times``: once when the direction is known, twice when the size is too."""

    of: Node
    times: int


T = TypeVar("T")
Alphabet = Mapping[type[Node], Callable[..., T]]
"""How each kind of node is written: from its fields, the nodes among them written already."""


def spelt(node: Node, alphabet: Alphabet[T]) -> T:
    """A formula in an alphabet."""

    def part(value: Any) -> Any:
        if isinstance(value, Node):
            return spelt(value, alphabet)
        return [spelt(x, alphabet) for x in value] if isinstance(value, tuple) else value

    return alphabet[type(node)](*map(part, vars(node).values()))


def items(node: Node) -> tuple[Node, ...]:
    """Parts of a row, or the node alone."""
    return node.items if isinstance(node, FormulaRow) else (node,)


def row(*nodes: Node) -> FormulaRow:
    """Nodes one after another, rows among them opened."""
    return FormulaRow(tuple(x for node in nodes for x in items(node)))


# --- letters ------------------------------------------------------------------------------------------------------

_NAME = re.compile(
    r"([FMGRVaωεφhJmzrψθ])(и?[\d–]+(?:,\d+)?)([τn]?)([′″]*)|([FMQ])(М?[а-я]+|[a-z]{1,2})(\d*)|([a-zπ])(\d+)([′″]*)|([A-Z])(\d+)([′″]*)"
)


_INDEX = re.compile(r"_([A-Z]+\d*|[a-zа-я]{2,}|K_\d)(?![}])")
"""An index of several letters without braces."""


def letters_of(name: str) -> str:
    """Lettering markup of a name of a step: Fи3 is F with the index и3, F21τ has its τ above."""
    if "_" in name or "^" in name:
        return name
    m = _NAME.fullmatch(name)
    if m is None:
        return name
    if m[1]:
        return f"{m[1]}_{{{m[2]}}}" + (f"^{{{m[3]}}}" if m[3] else "") + (m[4] or "")
    if m[5]:
        return f"{m[5]}_{{{m[6]}{m[7]}}}"
    head, index, primes = (m[8], m[9], m[10]) if m[8] else (m[11], m[12], m[13])
    return f"{head}_{{{index}}}{primes or ''}"


_TOKEN = re.compile(r"_\{((?:[^{}]|\{[^{}]*\})*)\}|_(.)|\^\{((?:[^{}]|\{[^{}]*\})*)\}|\^(.)|(.)", re.DOTALL)
_WORD = re.compile(r"max|min")
_SIGNS = "=+−-·/(),;:|≈<>≤≥°%×∥⟂→–…"
_PRIMES = "'′″"


@lru_cache(4096)  # asked again at each position
def letters(markup: str) -> Node:
    """Tree of lettering markup."""
    if _WORD.fullmatch(markup):
        return Words(markup)
    if markup.startswith("inv "):
        return FormulaRow((Words("inv "), letters(markup[4:])))
    if markup.startswith("|") and markup.endswith("|"):
        return Fenced("|", letters(markup[1:-1]), "|")
    found: list[Node] = []
    for m in _TOKEN.finditer(_INDEX.sub(r"_{\1}", markup.replace("²", "^2"))):
        below, above = (
            next((x for x in m.group(1, 2) if x is not None), None),
            next((x for x in m.group(3, 4) if x is not None), None),
        )
        if below is not None or above is not None:
            _attach(found, below, above)
        elif m[5] == "\u0305" and found:
            found.append(Barred(found.pop()))
        elif m[5] in _PRIMES and found:
            _attach(found, None, "′" if m[5] == "'" else m[5])
        elif m[5] != "\\":
            _append(found, m[5])
    return found[0] if len(found) == 1 else FormulaRow(tuple(found))


def reworded(node: Node, table: Mapping[str, str]) -> Node:
    """A formula in another language: ``table`` has functions, indices alone or with their letter (tg, пр, Jпр)."""
    if isinstance(node, Words):
        name = node.text.strip()
        return Words(node.text.replace(name, table[name])) if name in table else node
    if not isinstance(node, Scripts):
        return node.of_parts(lambda part: reworded(part, table))
    letter = node.base.text if isinstance(node.base, Letters) else ""

    def index(part: Node) -> Node:
        if isinstance(part, Words):
            said = table.get(letter + part.text, table.get(part.text, part.text))
            return Letters(said) if len(said) == 1 and said.isascii() else Words(said)
        return part.of_parts(index)

    below, above = (index(x) if x is not None else None for x in (node.below, node.above))
    return Scripts(reworded(node.base, table), below, above)


def _attach(found: list[Node], below: str | None, above: str | None) -> None:
    base = found.pop() if found else FormulaRow(())
    old = base if isinstance(base, Scripts) else Scripts(base)
    new_below = letters(below) if below is not None else None
    new_above = letters(above) if above is not None else None
    if new_below is not None and old.below is not None:
        old = Scripts(old)
    if new_above is not None and old.above is not None:
        new_above = Sign("″") if old.above == new_above == Sign("′") else FormulaRow((old.above, new_above))
    found.append(Scripts(old.base, new_below or old.below, new_above or old.above))


def _append(found: list[Node], c: str) -> None:
    last = found[-1] if found else None
    if c.isdigit() or (c in ".," and isinstance(last, Figures)):
        if isinstance(last, Figures):
            found[-1] = Figures(last.text + c)
        else:
            found.append(Figures(c))
    elif c in _SIGNS:
        found.append(Sign("−" if c == "-" else c))
    elif c == " ":
        found.append(Words(" "))
    elif _cyrillic(c) and isinstance(last, Words) and last.text != " ":
        found[-1] = Words(last.text + c)
    elif _cyrillic(c) or c in "∞":
        found.append(Words(c))
    elif c == "*" or c in _PRIMES:
        found.append(Sign("′" if c == "'" else c))
    else:
        found.append(Letters(c))


def _cyrillic(c: str) -> bool:
    return "\u0400" <= c <= "\u04ff"


# --- expressions --------------------------------------------------------------------------------------------------

ANGLES = ("sin", "cos", "tan")
"""Functions of angles: these stand in degrees inside them."""
_FUNCTIONS = {
    "tan": "tg",
    "atan": "arctg",
    "atan2": "arctg",
    "asin": "arcsin",
    "acos": "arccos",
    "minimum": "min",
    "maximum": "max",
    "inverse involute": "arcinv",
    "greatest common divisor": "НОД",
    "sign": "sign",
}


@dataclass(frozen=True)
class Operand:
    """What stands in the place of an argument: its node, and the one inside a trigonometric function (an angle in degrees)."""

    node: Node
    as_angle: Node | None = None
    negative: bool = False


def of_tree(tree: expression.Expression, operands: Sequence[Operand], least: int = 0) -> Node:
    """Formula of an expression with operands in the places of its arguments; in brackets if it binds less than ``least``."""
    return held(_walk(simplified(tree), operands, False), least)


@lru_cache(4096)
def simplified(tree: expression.Expression) -> expression.Expression:
    """An expression as a person writes it: no sums with zero, x·x as a square, a root of two squares spelt out."""
    if not isinstance(tree, expression.Operation):
        return tree
    parts = tuple(map(simplified, tree.parts))
    if tree.name == "+" and len(parts) > 1:
        kept = tuple([p for p in parts if not _is_constant(p, 0.0)])
        if len(kept) == 1:
            return kept[0]
        parts = kept or parts[:1]
    if tree.name == "-" and len(parts) == 2 and _is_constant(parts[0], 0.0):
        return expression.Operation("-", parts[1:])
    if tree.name == "-" and len(parts) == 2 and _negated(parts[1]):
        return expression.Operation("+", (parts[0], parts[1].parts[0]))
    if tree.name in ("*", "/", "+") and len(parts) == 2:
        return _tidied(tree.name, parts[0], parts[1])
    if tree.name in ("minimum", "maximum", "greatest common divisor") and len(parts) == 2 and same(*parts):
        return parts[0]
    if tree.name == "hypot":
        two = expression.Constant(2.0)
        squares = tuple(expression.Operation("^", (p, two)) for p in parts)
        return expression.Operation("sqrt", (expression.Operation("+", squares),))
    if tree.name == "atan2":
        return expression.Operation("atan", (expression.Operation("/", parts),))
    return expression.Operation(tree.name, parts, tree.function)


def _tidied(sign: str, a: expression.Expression, b: expression.Expression) -> expression.Expression:
    """Two parts with a sign between them: factors of one left out, minus signs in front, a square for two alike."""
    if isinstance(a, expression.Constant) and isinstance(b, expression.Constant) and sign == "*":
        return expression.Constant(a.value * b.value)
    if sign == "+":
        return expression.Operation("-", (a, b.parts[0])) if _negated(b) else expression.Operation("+", (a, b))
    if _is_constant(b, 1.0) or (sign == "*" and _is_constant(a, 1.0)):
        return a if _is_constant(b, 1.0) else b
    if sign == "*" and (_is_constant(a, -1.0) or _is_constant(b, -1.0)):
        return expression.Operation("-", (b if _is_constant(a, -1.0) else a,))
    if _negated(a):
        return expression.Operation("-", (_tidied(sign, a.parts[0], b),))
    if sign == "*" and same(a, b):
        return expression.Operation("^", (a, expression.Constant(2.0)))
    return expression.Operation(sign, (a, b))


def _negated(tree: expression.Expression) -> TypeGuard[expression.Operation]:
    return isinstance(tree, expression.Operation) and tree.name == "-" and len(tree.parts) == 1


def filled(tree: expression.Expression, arguments: Sequence[expression.Expression]) -> expression.Expression:
    """The tree with others in the places of its arguments."""
    found: expression.Expression = expression.fold(tree, arguments.__getitem__, expression.Constant,
                                                   lambda of, parts: expression.Operation(of.name, tuple(parts), of.function))
    return found


def _is_constant(tree: expression.Expression, value: float) -> bool:
    return isinstance(tree, expression.Constant) and tree.value == value


def same(a: expression.Expression, b: expression.Expression) -> bool:
    """Whether two trees are alike."""
    return bool(expression.as_json(a) == expression.as_json(b))


_WRITTEN = (
    "+",
    "-",
    "*",
    "/",
    "^",
    "sqrt",
    "abs",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "exp",
    "log",
    "hypot",
    "minimum",
    "maximum",
    "greatest common divisor",
)
"""Operations that stand in formulas."""


def can_be_written(tree: expression.Expression) -> bool:
    """Whether a tree holds nothing but what stands in formulas: no move of the construction, no part of a vector."""
    if not isinstance(tree, expression.Operation):
        return not (isinstance(tree, expression.Constant) and isinstance(tree.value, complex))
    return tree.name in _WRITTEN and all(map(can_be_written, tree.parts))


def arguments(tree: expression.Expression) -> tuple[int, ...]:
    """Numbers of the arguments in the order they stand in."""
    return tuple(expression.fold(tree, lambda i: (i,), lambda value: (), lambda of, parts: sum(parts, ())))


SUM, PRODUCT, POWER, ATOM = 1, 2, 3, 4


def _walk(tree: expression.Expression, operands: Sequence[Operand], angle: bool) -> tuple[Node, int]:
    """Node, and how tightly it binds."""
    if isinstance(tree, expression.Argument):
        operand = operands[tree.index]
        node = operand.as_angle if angle and operand.as_angle is not None else operand.node
        return node, SUM if operand.negative else ATOM
    if isinstance(tree, expression.Constant):
        return _constant(tree.value)
    assert isinstance(tree, expression.Operation)
    name = tree.name
    parts = [_walk(p, operands, angle or name in ANGLES) for p in tree.parts]
    return _ARITHMETIC[name](parts) if name in _ARITHMETIC else _function(name, parts)


Part = tuple[Node, int]


def _power(parts: Sequence[Part]) -> Part:
    base, power = parts[0][0], parts[1][0]
    if isinstance(base, FormulaRow) and isinstance(name := base.items[0], Words):  # sin²(πx)
        space = (Words(" "),) * name.text.endswith(" ")
        return FormulaRow((Scripts(Words(name.text.strip()), None, power), *space, *base.items[1:])), PRODUCT
    return Scripts(Fenced("(", base, ")") if isinstance(base, Fraction) else held(parts[0], ATOM), None, power), POWER


def _sum(parts: Sequence[Part]) -> Part:
    rest = [held(p, PRODUCT) if isinstance(p[0], FormulaRow) and p[0].items[:1] == (Sign("−"),) else _held_sum(p)
            for p in parts[1:]]
    return joined("+", [parts[0][0], *rest]), SUM


def _difference(parts: Sequence[Part]) -> Part:
    if len(parts) == 1:
        return FormulaRow((Sign("−"), held(parts[0], PRODUCT))), SUM
    return joined("−", [parts[0][0], *(held(p, PRODUCT) for p in parts[1:])]), SUM


_ARITHMETIC: dict[str, Callable[[Sequence[Part]], Part]] = {
    "/": lambda parts: (Fraction(parts[0][0], parts[1][0]), ATOM),
    "^": _power,
    "*": lambda parts: (joined("·", [held(p, PRODUCT) for p in parts]), PRODUCT),
    "+": _sum,
    "-": _difference,
    "cross": lambda parts: (joined("×", [held(p, PRODUCT) for p in parts]), PRODUCT),
    "sqrt": lambda parts: (Root(parts[0][0]), ATOM),
    "abs": lambda parts: (Fenced("|", parts[0][0], "|"), ATOM),
    "conj": lambda parts: (Barred(parts[0][0]), ATOM),
}


def _function(name: str, parts: Sequence[Part]) -> Part:
    """A named function: of a single letter or number without brackets."""
    shown = _FUNCTIONS.get(name, name)
    inside = joined(";", [p[0] for p in parts])
    single = len(parts) == 1 and parts[0][1] == ATOM and not isinstance(parts[0][0], Fraction)
    return FormulaRow((Words(f"{shown} "), inside) if single else (Words(shown), Fenced("(", inside, ")"))), PRODUCT


def _held_sum(part: tuple[Node, int]) -> Node:
    """A term of a sum: in brackets when it begins with a minus sign."""
    node = part[0]
    negative = isinstance(node, Figures) and node.text.startswith("−")
    return Fenced("(", node, ")") if negative else node


def held(part: tuple[Node, int], least: int) -> Node:
    """A part that binds less tightly stands in brackets."""
    return part[0] if part[1] >= least else Fenced("(", part[0], ")")


def joined(sign: str, nodes: Sequence[Node]) -> Node:
    """Nodes with a sign between them."""
    found: list[Node] = []
    for i, node in enumerate(nodes):
        if i and not (sign == "·" and found and isinstance(found[-1], Figures) and found[-1].source is None and _lettered(node)):
            found.append(Sign(sign))
        found += items(node)
    return FormulaRow(tuple(found))


def _lettered(node: Node) -> bool:
    """Whether a factor begins with a letter: no sign is needed between it and a number before it."""
    first = node.items[0] if isinstance(node, FormulaRow) and node.items else node
    first = first.base if isinstance(first, Scripts) else first
    return isinstance(first, Letters | Barred) or (isinstance(first, Fenced) and not any(True for _ in first.numbers()))


def _constant(value: float | complex) -> tuple[Node, int]:
    text = constant_text(value)
    if text:
        return Figures(written(text)), ATOM if text[0] != "-" else SUM
    if isinstance(value, complex):
        return Letters("i"), ATOM
    return next((node, binds) for of, node, binds in _NAMED if isclose(value, of))


_NAMED: tuple[tuple[float, Node, int], ...] = (
    (pi, Letters("π"), PRODUCT),
    (2 * pi, FormulaRow((Figures("2"), Letters("π"))), PRODUCT),
    (pi / 2, Fraction(Letters("π"), Figures("2")), ATOM),
    (pi**2 / 2, Fraction(Scripts(Letters("π"), None, Figures("2")), Figures("2")), ATOM),
    (0.2, FormulaRow((Figures("1"), Sign("/"), Figures("5"))), ATOM),
)
"""Numbers of formulas that are not written as such: of each the value, the node, and how tightly it binds."""


def constant_text(value: float | complex) -> str:
    """A number of the formula itself as a computer writes it; empty where it stands there as a letter or a fraction."""
    named = isinstance(value, complex) or any(isclose(value, of) for of, _, _ in _NAMED)
    return "" if named else rounded(value.real, 6)
