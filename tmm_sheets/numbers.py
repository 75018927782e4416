"""How numbers are written and which of them are nothing: the one place for sheets, protocol, listings and reports.

Rounding leaves about 1e-16 of the terms of a difference. What is below ``NOISE`` of the greatest of its kind (of the plan, the
column, or the terms it is a difference of) is nothing but that, and is written 0.
"""

from __future__ import annotations

from collections.abc import Iterable
from decimal import ROUND_HALF_UP, Context, Decimal
from functools import lru_cache
from math import copysign, degrees, floor, isfinite, log10, radians
from typing import Any

from tmm_sheets.words import decimal_sign, reader

NOISE = 1e-9
"""Share of the size of its kind below which a number is zero, and two of them are the same."""
ROUNDING = 1e-12
"""Share of its size by which rounding changes a number: where a border is met exactly."""


class Sizes:
    """Size of a kind of quantities at each position: the greatest there, or what one of them exceeds at every fourth position.

    ``values`` are numbers or arrays over the positions, real or complex; what is undefined does not count. The greatest of all
    would not do: next to a dead point it is so large that everything else was nothing.
    """

    def __init__(self, values: Iterable[Any]) -> None:
        import numpy as np

        self._usual = 0.0
        self._greatest = np.empty(0)
        for value in values:
            sizes = np.abs(np.ravel(value))
            finite = np.isfinite(sizes)
            if not finite.any():
                continue
            there = np.sort(sizes[finite])
            self._usual = max(self._usual, float(there[int(0.75 * (there.size - 1))]))
            if sizes.size > self._greatest.size:
                self._greatest = np.append(self._greatest, np.zeros(sizes.size - self._greatest.size))
            np.maximum(self._greatest[:sizes.size], sizes, out=self._greatest[:sizes.size], where=finite)

    def at(self, k: int) -> float:
        """Size at position ``k``."""
        return max(self._usual, float(self._greatest[k])) if k < self._greatest.size else self._usual


def is_zero(x: Any, kind: float) -> bool:
    """True for a number, real or complex, that is nothing but rounding beside ``kind``, the size of its kind."""
    return bool(abs(x) <= NOISE * kind)


def clean(x: Any, kind: float) -> Any:
    """The number itself, or its zero when it is nothing but rounding beside ``kind``."""
    return x * 0.0 if is_zero(x, kind) else x


def number(x: float, digits: int = 4, kind: float = 0.0) -> str:
    """A number as it is written on paper: at most ``digits`` significant digits, no trailing zeros.

    ``kind`` is the size of its kind, in the same unit: what is nothing beside it is written 0.
    """
    return written(rounded(x, digits, kind))


def rounded(x: float, digits: int = 4, kind: float = 0.0) -> str:
    """A number as on paper, but with the signs of a computer's number, for :func:`told`."""
    if is_zero(x, kind):
        return "0"
    text = _half_up(float(x), max(digits - 1 - floor(log10(abs(x))), 0))
    return text.rstrip("0").rstrip(".") if "." in text else text


@lru_cache(4096)  # a number is written in many sentences
def _half_up(x: float, decimals: int) -> str:
    """Rounded as people round the number they read: a last 5 goes away from zero, where a computer goes to the even digit."""
    if not isfinite(x):
        return f"{x:.{decimals}f}"
    return f"{Decimal(repr(x)).quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_UP, _LONG):f}"


_LONG = Context(prec=400)


def fixed(x: float, decimals: int = 2) -> str:
    """A number as it is written on paper, with a fixed number of decimals; minus sign U+2212."""
    return written(decimal(x, decimals))


def decimals_for(values: Iterable[Any], least: int) -> int:
    """How many decimals numbers of a kind are written with: ``least``, or as many as give the greatest three digits."""
    greatest = max((abs(x) for x in values if isfinite(x)), default=0.0)
    return max(least, 2 - floor(log10(greatest))) if greatest else least


def enough(x: float, least: int, kind: float = 0.0) -> str:
    """A number as it is written on paper with ``least`` decimals, or as many as give it three digits; see :func:`number`."""
    x = clean(x, kind)
    return fixed(x, decimals_for([x], least))


def decimal(x: float, decimals: int = 2, sign: bool = False) -> str:
    """A number with a decimal point and a fixed number of decimals; never "-0". With ``sign`` positive ones have a plus."""
    text = _half_up(float(x), decimals)
    if isfinite(x) and float(text) == 0:
        return text.lstrip("-")
    return f"+{text}" if sign and x > 0 else text


def degrees_and_minutes(angle: float, places: int = 0) -> str:
    """An angle in rad as it is written: 27°12′, 20°.

    With ``places`` it has seconds too, and all but the first of the places behind the decimal sign: 27°12′35″, 27°12′35,2″.
    """
    units, of_minute = _of_angle(angle, places)
    sign = "−" if angle < 0 and units else ""
    minutes, rest = divmod(units, of_minute)
    second = of_minute // 60 or 1
    seconds = f"{rest // second:02d}" + (f".{rest % second:0{places - 1}d}".rstrip("0").rstrip(".") if places > 1 else "")
    minutes, whole = minutes % 60, minutes // 60
    return f"{sign}{whole}°" + (f"{minutes:02d}′" if minutes or rest else "") + (f"{written(seconds)}″" if rest else "")


def rounded_angle(angle: float, places: int = 0) -> float:
    """The angle that :func:`degrees_and_minutes` writes, rad."""
    units, of_minute = _of_angle(angle, places)
    return copysign(radians(units / (60 * of_minute)), angle)


def _of_angle(angle: float, places: int) -> tuple[int, int]:
    """Size of an angle in the least unit that is written, and how many of them make a minute."""
    of_minute = 60 * 10 ** (places - 1) if places else 1
    return round(abs(degrees(angle)) * 60 * of_minute), of_minute


def plain(x: float, digits: int = 6, kind: float = 0.0) -> str:
    """A number as computers write it, with ``digits`` significant digits; 0 when it is nothing beside ``kind``."""
    return f"{0.0 if is_zero(x, kind) else x:.{digits}g}"


def written(text: str, language: str = "") -> str:
    """A computer's number as a language writes it, that of the paper if none is told: true minus, decimal comma or point."""
    return text.replace(".", decimal_sign(language)).replace("-", "−")


def told(text: str) -> str:
    """A computer's number as the reader of messages and reports writes it."""
    return written(text, reader())


def of_reader(text: str) -> str:
    """A computer's number with the decimal sign of the reader and its own minus, to be copied from a terminal."""
    return text.replace(".", decimal_sign(reader()))


def listed(x: float, digits: int = 6) -> str:
    """A number of a listing in a terminal, see :func:`plain`."""
    return of_reader(plain(x, digits))


def in_a_row(texts: Iterable[str]) -> str:
    """Numbers of a message one behind the other: semicolons between them where commas are within."""
    return ("; " if decimal_sign(reader()) == "," else ", ").join(texts)
