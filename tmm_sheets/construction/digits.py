"""Digits of a formula: as many as are needed for what stands there to give what stands there.

A result is rounded as everywhere in the note. Its formula is worked out from its numbers as they are printed; where that misses the
result by more than half a unit of its last digit, the number whose rounding matters most gets a digit more, until it does not.
Where no operand has another digit (a result beside the middle of two roundings), the result is rounded elsewhere.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import floor, isfinite, log10, radians

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.formula import ANGLES, constant_text, simplified
from tmm_sheets.numbers import degrees_and_minutes, rounded, rounded_angle, written

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
    return written(mantissa) + (f"·10{written(str(exponent)).translate(_RAISED)}" if exponent else "")


_RAISED = str.maketrans("0123456789−", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


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

    @property
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
    parts = tuple(_laid_out(p, values, angles, own, places, inside or tree.name in ANGLES) for p in tree.parts)
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
