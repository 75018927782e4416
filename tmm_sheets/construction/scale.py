"""Scale factors mu: real quantity per millimetre of drawing (масштабный коэффициент)."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from functools import cache
from math import floor, isclose, log10
from typing import Any

from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import number
from tmm_sheets.words import tell, tr_in, tr_n

HANDY = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Mantissas that are handy for mental arithmetic, as manuals 000 and 003 ask: those of GOST 2.302 and the 3 and 6 of manual 000.

No two neighbours are more than a factor of 1.5 apart, so that a plan takes at least two thirds of its room.
"""

STANDARD = (
    (1000, 1), (800, 1), (500, 1), (400, 1), (200, 1), (100, 1), (75, 1), (50, 1), (40, 1), (25, 1), (20, 1), (15, 1),
    (10, 1), (5, 1), (4, 1), (5, 2), (2, 1), (1, 1),
    (1, 2), (2, 5), (1, 4), (1, 5), (1, 10), (1, 20), (1, 40), (1, 50), (1, 100),
)
"""GOST 2.302 scales as (real, drawn) from the largest reduction to the largest enlargement."""
ENLARGEMENTS = [drawn / real for real, drawn in STANDARD if drawn > real]
"""How many times the enlargements among them enlarge, rising."""


@dataclass(frozen=True)
class Scale:
    """Scale factor ``mu`` in ``unit`` (SI per millimetre): real = mu * millimetres."""

    symbol: str
    mu: float
    unit: str

    def mm(self, real: Any) -> Any:
        """Length on paper in millimetres of a real quantity (number or array, complex allowed)."""
        return real / self.mu

    def real(self, mm: Any) -> Any:
        """Real quantity of a length on paper."""
        return mm * self.mu

    def __str__(self) -> str:
        return f"{self.symbol} = {number(self.mu)} {self.unit}"


def fit(symbol: str, unit: str, span: float, mm: float) -> Scale:
    """Smallest handy scale factor with which the real ``span`` takes at most ``mm`` millimetres; CannotBuild for none.

    >>> fit("μ_l", "m/mm", 0.35, 150.0).mu
    0.0025
    """
    if not mm > 0:
        raise CannotBuild(
            tell("there is no room left for the diagram with the scale factor {symbol} beside what it belongs to").format(
                symbol=symbol
            ),
            tell("are all numbers of the project file as you mean them?"),
        )
    return Scale(symbol, handy(span / mm), unit)


def reach(symbol: str, unit: str, span: float, mm: float) -> Scale:
    """Largest handy scale factor with which the real ``span`` takes at least ``mm`` millimetres.

    >>> reach("μ_F", "N/mm", 2800.0, 40.0).mu
    60.0
    """
    return Scale(symbol, _largest(span / mm), unit)


def finer(mu: float) -> float:
    """The next smaller number of the series of scale factors.

    >>> finer(0.003), finer(1.0)
    (0.0025, 0.8)
    """
    return _largest(mu * (1 - 1e-6))


def coarser(mu: float) -> float:
    """The next greater number of the series of scale factors.

    >>> coarser(0.0025), coarser(8.0)
    (0.003, 10.0)
    """
    return handy(mu * (1 + 1e-6))


def fit_standard(span_mm: float, mm: float) -> tuple[int, int]:
    """Largest GOST 2.302 scale (real, drawn) with which ``span_mm`` millimetres of the object fit in ``mm``.

    Raises CannotBuild when they fit at none.

    >>> fit_standard(300.0, 160.0)
    (2, 1)
    """
    for real, drawn in reversed(STANDARD):
        if span_mm * drawn <= mm * real * (1 + 1e-9):
            return real, drawn
    raise CannotBuild(
        tell("{length:.6g} mm do not fit in {room:.6g} mm of the sheet at any scale of GOST 2.302, 1:1000 or larger").format(
            length=span_mm, room=mm
        ),
        tell("are all numbers of the project file in the units you mean?"),
    )


def fitting(spans_mm: Any, rooms: Any) -> Any:
    """Numbers in ``STANDARD`` of the largest scales at which figures fit: spans, shape (n, k), in rooms (k,), mm; -1 for none."""
    import numpy as np

    real, drawn = np.array(STANDARD).T
    return (np.asarray(spans_mm)[:, :, None] * drawn <= np.outer(rooms, real) * (1 + 1e-9)).all(axis=1).sum(axis=1) - 1


def times(ratio: float) -> str:
    """How many times something is enlarged, with the right form of the word: 2 раза, 5 раз, 2,5 раза."""
    whole = isclose(ratio, round(ratio))
    said = tr_n("{ratio} time", "{ratio} times", round(ratio)) if whole else tr_in("a number with a fraction", "{ratio} times")
    return said.format(ratio=number(ratio))


def plain(ratio: Any) -> Any:
    """Whether a ratio of scale factors (number or array) is reckoned with in one's head: so many times, half times, or inverse.

    >>> plain(4.0), plain(0.4), plain(10 / 3)
    (True, True, False)
    """
    twice = 2 * abs(ratio) ** (1 - 2 * (ratio < 1))
    return abs(twice % 1 - 0.5) > 0.5 - 1e-6


def handy(least: float) -> float:
    """Smallest number of the series ``HANDY`` * 10^k that is not less than ``least``.

    >>> handy(0.0026), handy(7.0)
    (0.003, 8.0)
    """
    if not least > 0:
        raise ValueError(f"a scale factor must be positive, not {least}")
    return _series(least)[bisect_left(_series(least), least * (1 - 1e-9))]


def _largest(most: float) -> float:
    """Largest number of the series that is not greater than ``most``."""
    return _series(most)[bisect_right(_series(most), most * (1 + 1e-9)) - 1]


def _series(about: float) -> tuple[float, ...]:
    """The series ``HANDY`` * 10^k over three decades about a number."""
    return _decades(floor(log10(about)))


@cache
def _decades(power: int) -> tuple[float, ...]:
    # Decimal literals instead of products: 2.5 * 10**-3 must be the number written 0.0025.
    return tuple([float(f"{mantissa}e{k}") for k in (power - 1, power, power + 1) for mantissa in HANDY])


# --- least sizes on paper --------------------------------------------------------------------------------------------------

# Least sizes, mm, at which a drawing is read from a metre away: what chooses a scale factor has to reach them. At that distance the
# eye parts lines 0.3 mm apart; what is told here is so high that its letters of 3.5 and 5 mm stand beside it and not over it.
CURVE = 40.0
"""Any curve: eight heights of its letters, so that rises, zeros and extremes are told apart."""
MAIN = 60.0
"""The curve of a main result, with tangents or extremes that are measured: 0.5 mm of a pencil are less than a hundredth of it."""
POLE = 12.0
"""Pole distance: its dimension has room for two arrowheads, its rays come out flatter than the lines of the ordinates."""
TOOTH = 30.0
"""Height of a tooth in the picture of the mesh: flank, involute and line of action are lettered within three pitches."""
