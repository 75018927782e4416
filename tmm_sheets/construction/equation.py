"""Formulas of sheets and sentences, in one line: each written from an expression, with the digits with which it comes out.

The expression is that of a rule, or of a sum that a sheet makes up; the same nodes are set by the writers of the note.

Digits of a formula: as many as are needed for what stands there to give what stands there.

A result is rounded as everywhere in the note. Its formula is worked out from its numbers as they are printed; where that misses the
result by more than half a unit of its last digit, the number whose rounding matters most gets a digit more, until it does not.
Where no operand has another digit (a result beside the middle of two roundings), the result is rounded elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import product
from math import floor, isfinite, log10, radians
from types import MappingProxyType
from typing import Any

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.expression import Argument, Constant, Expression, Operation, trace
from tmm_sheets.construction.formula import (
    ANGLES,
    Barred,
    Fenced,
    Figures,
    FormulaRow,
    Fraction,
    Letters,
    Node,
    Operand,
    Root,
    Scripts,
    Sign,
    Words,
    can_be_written,
    constant_text,
    filled,
    letters,
    letters_of,
    of_tree,
    simplified,
)
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.numbers import degrees_and_minutes, number, rounded, rounded_angle, written
from tmm_sheets.words import decimal_sign, marked, paper, tr

DIGITS = 4
"""Significant digits of a number in the note, as a drawing gives them."""
MORE = 5
"""Digits that an operand may have beside these."""
OTHERS = (0, 1, -1, 2)
"""Digits that a result may have beside its own, in the order in which they are tried."""
PLAIN = range(-4, 6)
"""Powers of ten of numbers that are written without one."""


@dataclass(frozen=True)
class Digits:
    """How a number is written: significant digits; of an angle the places behind the minutes, the first is that of the seconds."""

    number: int = DIGITS
    angle: int = 0


@lru_cache(4096)
def _split(value: float, digits: int) -> tuple[str, int]:
    """A number as a computer writes it, and the power of ten behind it."""
    exponent = floor(log10(abs(value)))
    if exponent in PLAIN:
        return rounded(value, digits), 0
    mantissa = rounded(value / 10.0**exponent, digits)
    return (rounded(value / 10.0 ** (exponent + 1), digits), exponent + 1) if abs(float(mantissa)) >= 10 else (mantissa, exponent)


def shown(value: float, digits: int = DIGITS) -> str:
    """A number with at most so many significant digits; very large and small ones with a power of ten."""
    if not isfinite(value):
        return "∞" if value > 0 else "−∞" if value < 0 else "–"
    if value == 0:
        return "0"
    mantissa, exponent = _split(value, digits)
    return written(mantissa) + (f"·10{written(str(exponent)).translate(POWERS)}" if exponent else "")


POWERS = str.maketrans("0123456789−", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def read(value: float, digits: int) -> tuple[float, float]:
    """A number as :func:`shown` prints it, and half a unit of its last digit."""
    if not isfinite(value) or value == 0:
        return value, 0.5
    mantissa, exponent = _split(value, digits)
    return float(f"{mantissa}e{exponent}"), 0.5 * 10.0 ** (exponent - len(mantissa.partition(".")[2]))


PLACES = 4
"""Places of an angle that is found behind its minutes, those of seconds among them, and none."""


@dataclass(frozen=True)
class _Place:
    """Where a number stands in a formula: the same argument in degrees inside a function, as a number outside."""

    index: int
    value: float
    angle: bool
    digits: int

    @cached_property
    def printed(self) -> float:
        return rounded_angle(self.value, self.digits) if self.angle else read(self.value, self.digits)[0]

    @property
    def exact(self) -> bool:
        return self.printed == self.value


def chosen(
    tree: expression.Expression, values: Sequence[float], angles: Sequence[bool], own: Sequence[int], result: float, of_result: int,
    in_degrees: bool, filled: int = 0, held: Collection[int] = (),
) -> tuple[list[Digits], int]:  # fmt: skip
    """Digits of every operand of a formula and of its result.

    Parameters
    ----------
    values, angles, own
        of the arguments of ``tree``: their numbers, which of them are angles (degrees inside of functions), and the digits that
        each has at least.
    result, of_result
        what the formula gives, and the digits it has everywhere.
    in_degrees
        whether the result is told in degrees and minutes, too, which must be those of the number as printed; with ``of_result`` 0
        it is told in degrees alone: found are the places behind the minutes.
    filled
        decimals to which the result is filled up with zeros where it has all its digits.
    held
        numbers of the arguments that are written as they are measured, if another digit elsewhere can do it.
    """
    places: list[_Place] = []
    laid_out = _laid_out(simplified(tree), values, angles, own, places, False)
    others = range(PLACES) if in_degrees and not of_result else OTHERS
    for fixed, more in product((held, ()) if held else ((),), others):
        digits = max(of_result + more, 1) if of_result else more
        said, half = read(result, digits) if of_result else (
            rounded_angle(result, digits), radians(0.5 / (60 if not digits else 3600 * 10 ** (digits - 1))))
        half = min(half, 0.5 * 10.0**-filled) if filled and more >= 0 else half
        if in_degrees and of_result and degrees_and_minutes(said) != degrees_and_minutes(result):
            continue
        found = _sufficient(laid_out, places, said, half, fixed)
        if found is not None:
            return _by_argument(found, own), digits
    return _by_argument(places, own), of_result


def _laid_out(
    tree: expression.Expression, values: Sequence[float], angles: Sequence[bool], own: Sequence[int], places: list[_Place],
    inside: bool,
) -> expression.Expression:  # fmt: skip
    """The tree with its arguments numbered by their ``places``, which are filled in, and its constants as they are printed."""
    if isinstance(tree, expression.Argument):
        i = tree.index
        angle = inside and angles[i]
        place = next((n for n, p in enumerate(places) if (p.index, p.angle) == (i, angle)), None)
        if place is None:
            place = len(places)
            places.append(_Place(i, values[i], angle, 0 if angle else own[i]))
        return expression.Argument(place)
    if isinstance(tree, expression.Constant):
        text = constant_text(tree.value)
        return expression.Constant(float(text)) if text else tree
    assert isinstance(tree, expression.Operation)
    parts = tuple([_laid_out(p, values, angles, own, places, inside or tree.name in ANGLES) for p in tree.parts])
    return expression.Operation(tree.name, parts, tree.function)


def _sufficient(tree: expression.Expression, places: Sequence[_Place], said: float, half: float,
                held: Collection[int]) -> list[_Place] | None:
    """The places with as few digits more as make the formula give what is said; None when nothing does.

    Arguments that are ``held`` get none.
    """

    def gives(at: Sequence[_Place]) -> bool:
        return abs(_worked_out(tree, [p.printed for p in at]) - said) <= half * (1 - SAFE)

    least = {(p.index, p.angle): p.digits for p in places}
    at = list(places)
    while not gives(at):
        short = [i for i, p in enumerate(at) if p.digits < least[p.index, p.angle] + MORE and not p.exact and p.index not in held]
        if not short:
            return None
        given = _worked_out(tree, [p.printed for p in at])
        effects = {i: abs(_worked_out(tree, [p.value if j == i else p.printed for j, p in enumerate(at)]) - given) for i in short}
        worst = max(short, key=lambda i: effects[i] if isfinite(effects[i]) else np.inf)
        at[worst] = replace(at[worst], digits=at[worst].digits + 1)
    for i, p in enumerate(at):  # what another digit elsewhere has made needless
        while at[i].digits > least[p.index, p.angle]:
            fewer = [replace(q, digits=q.digits - 1) if j == i else q for j, q in enumerate(at)]
            if not gives(fewer):
                break
            at = fewer
    return at


SAFE = 1e-6
"""Share of half a unit that is kept clear of, since who works it out again rounds otherwise."""


def _worked_out(tree: expression.Expression, values: Sequence[float]) -> float:
    with np.errstate(all="ignore"):
        return float(np.real(expression.evaluate(tree, [np.float64(v) for v in values])))


def _by_argument(places: Sequence[_Place], own: Sequence[int]) -> list[Digits]:
    found = [Digits(n) for n in own]
    for p in places:
        found[p.index] = replace(found[p.index], **({"angle": p.digits} if p.angle else {"number": p.digits}))
    return found


# --- formulas ------------------------------------------------------------------------------------------------------------

UNITS = {
    "mm": marked("mm"), "m": marked("m"), "m/s": marked("m/s"), "m/s2": marked("m/s²"), "N": marked("N"), "rad": marked("rad"),
    "N*m": marked("N·m"), "kg*m2": marked("kg·m²"), "rad/s": marked("rad/s"), "1/min": marked("rpm"), "W": marked("W"),
    "kg": marked("kg"), "J": marked("J"), "N/m": marked("N/m"), "rad/s2": marked("rad/s²"), "s": marked("s"),
    "rad/s/mm": marked("rad/(s·mm)"), "J/mm": marked("J/mm"),
}  # fmt: skip
"""Units of the record as they are said."""


@dataclass(frozen=True)
class Quantity:
    """An operand of a formula, or what it gives: lettering markup, value, unit of the record.

    It has ``digits`` significant digits at least; one that is measured is filled up with zeros to ``decimals`` and gets no more, if
    that can be. ``of`` is the step or given number.
    """

    symbol: str
    value: float
    unit: str = ""
    digits: int = DIGITS
    decimals: int = 0
    of: Any = None

    def written(self, of: Digits) -> str:
        """The number with its digits."""
        text, point = shown(self.value, of.number), decimal_sign()
        whole, _, fraction = text.partition(point)
        full = self.decimals and of.number >= self.digits and "·" not in text
        return f"{whole}{point}{fraction:0<{self.decimals}}" if full else text

    def operand(self, of: Digits) -> Operand:
        """What stands for it in a formula with numbers."""
        text = self.written(of)
        angle = Figures(degrees_and_minutes(self.value, of.angle)) if self.unit == "rad" else None
        return Operand(Figures(text, self), angle, text.startswith("−"))


def equation(of: Expression | Callable[..., Any], quantities: Sequence[Quantity], result: Quantity, in_letters: bool = True,
             unit: str = "") -> str:
    """A formula in letters and in numbers with what it gives, as lettering markup: ``p = πm = π·3,5 = 11 mm``.

    ``of`` is the expression, or a function of as many numbers as there are ``quantities``; ``unit`` is said instead of that of
    the result.
    """
    tree = simplified(of if isinstance(of, Expression) else _traced(of, len(quantities)))
    angle = result.unit == "rad"
    numbers, of_result = in_numbers(tree, quantities, replace(result, digits=0) if angle else result)
    turned = angle and isinstance(tree, Operation) and tree.name in "*/"  # of a quotient that is an angle, π is half a turn

    def line(text: str) -> str:
        return text.replace("2π", "360°").replace("π", "180°") if turned else text

    said = tr(UNITS[result.unit]) if not unit and result.unit in UNITS and not angle else unit
    value = degrees_and_minutes(result.value, of_result) if angle else result.written(Digits(of_result))
    parts = [result.symbol] if result.symbol else []
    if in_letters:
        form = line(_in_letters(tree, tuple([q.symbol for q in quantities]), paper()))
        parts += [form] if form != result.symbol else []
    if not isinstance(tree, Argument):
        parts.append(line(lettered(of_tree(tree, numbers))))
    return " = ".join([*parts, f"{_raised(value)} {said}".rstrip()])


@lru_cache(1024)
def _in_letters(tree: Expression, symbols: Sequence[str], language: str) -> str:
    """A formula in letters, with the functions of the paper's ``language``: it is the same at each position."""
    return lettered(of_tree(tree, [Operand(letters(symbol), None, _is_sum(symbol)) for symbol in symbols]))


def _traced(function: Callable[..., Any], count: int) -> Expression:
    tree = trace(function, count)
    assert tree is not None
    return tree


def _is_sum(symbol: str) -> bool:
    return " + " in symbol or " − " in symbol or symbol.startswith("−")


def in_numbers(tree: Expression, quantities: Sequence[Quantity], result: Quantity) -> tuple[list[Operand], int]:
    """Operands of a formula with the digits with which it comes out, and the digits of its result.

    A result in radians that has no digits of its own is told in degrees alone: found are the places behind the minutes.
    """
    found, of_result = chosen(
        tree, [q.value for q in quantities], [q.unit == "rad" for q in quantities], [q.digits for q in quantities], result.value,
        result.digits, result.unit == "rad", result.decimals, [i for i, q in enumerate(quantities) if q.decimals])  # fmt: skip
    return [q.operand(d) for q, d in zip(quantities, found, strict=True)], of_result


def digits_for(value: float, decimals: int) -> int:
    """Significant digits of a number that has so many decimals."""
    return max(decimals + 1 + (floor(log10(abs(value))) if value else 0), 1)


def of_step(step: Step, k: int = 0, symbol: str = "", own: Mapping[int, Quantity] = MappingProxyType({}), in_letters: bool = True,
            quantity: Callable[..., Quantity] = Quantity) -> str:
    """The formula of a step at a position, see :func:`equation`; empty where its rule is none, or only tells a given number in the
    unit of the plan.

    ``symbol`` stands instead of its letters. Operands are ``own`` ones by their id(), or made by ``quantity`` from letters, value,
    unit and the step or given number itself.
    """
    tree = tree_of_step(step)
    if tree is None:
        return ""

    def made(x: Any) -> Quantity:
        name = getattr(x, "symbol", "") or getattr(x, "name", "")
        unit = x.rule.unit if isinstance(x, Step) else getattr(x, "unit", "")
        value = float(value_at(x, k))
        symbol = letters_of(name) if isinstance(x, Step) or x.symbol else number(value, 6)
        return own.get(id(x)) or quantity(symbol, value, unit, of=x)

    result, operands = made(step), [Quantity("", float(a)) if _is_bare(a) else made(a) for a in step.args]
    if [one.symbol for one in operands] == [result.symbol]:
        return ""
    return equation(tree, operands, replace(result, symbol=symbol or result.symbol), in_letters)


@lru_cache(256)
def tree_of_step(step: Step) -> Expression | None:
    """The expression of a step as a formula shows it, with its bare numbers as constants; None where its rule is no formula."""
    tree = step.rule.formula(len(step.args))
    if tree is None or isinstance(tree, Argument | Constant) or not can_be_written(tree):
        return None
    return with_bare_numbers(tree, step)


def with_bare_numbers(tree: Expression, step: Step) -> Expression:
    """An expression of the arguments of a step with those that have no letter as constants."""
    if not any(map(_is_bare, step.args)):
        return tree
    return filled(tree, [Constant(float(a)) if _is_bare(a) else Argument(i) for i, a in enumerate(step.args)])


def _is_bare(a: Any) -> bool:
    """Whether an argument is a bare number, of the program itself or found before: it has no letter."""
    return isinstance(a, int | float) and not getattr(a, "name", "")


# --- one line -----------------------------------------------------------------------------------------------------


def lettered(node: Node) -> str:
    """A formula as lettering markup: fractions by strokes, roots with brackets."""
    return "".join(_pieces(node)).strip()


_FUNCTIONS = {"tg": marked("tan"), "arctg": marked("arctan"), "НОД": marked("gcd")}
_WIDE = "=+−<>≈≥≤"


def _pieces(node: Node) -> Iterator[str]:
    if isinstance(node, Words):
        yield node.text.replace(name := node.text.strip(), tr(_FUNCTIONS[name]) if name in _FUNCTIONS else name)
    elif isinstance(node, Letters):
        yield node.text
    elif isinstance(node, Figures):
        yield _raised(node.text)
    elif isinstance(node, Sign):
        yield node.text + " " * (node.text == ";")
    elif isinstance(node, FormulaRow):
        for i, part in enumerate(node.items):
            before = node.items[i - 1] if i else None
            if isinstance(before, Figures) and decimal_sign() in before.text and isinstance(part, Letters | Scripts | Barred):
                yield "·"  # a fraction and a letter would be read as one
            binary = i and isinstance(part, Sign) and part.text in _WIDE
            yield f" {part.text} " if binary else "".join(_pieces(part))  # type: ignore[attr-defined]
    elif isinstance(node, Scripts):
        base = lettered(node.base)
        yield f"({base})" if "·10^" in base and isinstance(node.base, Figures) else base
        if node.below is not None:
            yield f"_{{{lettered(node.below)}}}"
        if node.above is not None:
            above = lettered(node.above)
            yield above if above in ("′", "″") else f"^{{{above}}}"
    elif isinstance(node, Fraction):
        over, under = lettered(node.over), lettered(node.under)
        yield f"{_bracketed(over, node.over, '+−')}/{_bracketed(under, node.under, '+−·/')}"
    elif isinstance(node, Root):
        yield f"√({lettered(node.of)})"
    elif isinstance(node, Fenced):
        yield node.left + lettered(node.of) + node.right
    elif isinstance(node, Barred):
        yield f"{lettered(node.of)}\u0305"


def _bracketed(text: str, node: Node, signs: str) -> str:
    """A part of a fraction in brackets where its own signs would part it."""
    if isinstance(node, Fraction):
        return f"({text})" if "/" in signs else text
    if text[0] == text[-1] == "|" and text.count("|") == 2:
        return text
    if "/" in signs and (text[0] == "−" or "·10^" in text):
        return f"({text})"
    items = node.items if isinstance(node, FormulaRow) else ()
    parted = any((isinstance(x, Sign) and x.text in signs) or (isinstance(x, Fraction) and "/" in signs) for x in items)
    return f"({text})" if parted or (len(items) > 1 and "·" in signs and not isinstance(items[0], Words)) else text


_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789−")


def _raised(text: str) -> str:
    """A power of ten as markup."""
    head, ten, power = text.partition("·10")
    return f"{head}·10^{{{power.translate(_RAISED)}}}" if ten else text
