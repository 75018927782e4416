"""What is given: numbers that know where they come from, so that a record can be followed back to the project file.

A given number is a float (a given point a complex number) in all arithmetic; what is made of it by arithmetic is a bare number
again. Hence it is handed to the steps as it is, and what is computed of it is a step. Rows of numbers (angles of the positions,
load tables, nodes of a quadrature) are :class:`Given` rows; a step takes them like numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, Self

Over = Literal["none", "positions", "curve"]


class GivenNumber(float):
    """A given number.

    ``name`` is its path in the project file ("group[1].lengths[0]"), ``symbol`` its letter in lettering markup.
    """

    name: str
    symbol: str
    unit: str
    source: str

    def __new__(cls, value: float, name: str, symbol: str = "", unit: str = "", source: str = "") -> Self:
        """Attach the origin to a number."""
        found = super().__new__(cls, value)
        found.name, found.symbol, found.unit, found.source = name, symbol, unit, source
        return found

    def __reduce__(self) -> Any:
        """Pickled with its origin."""
        return type(self), (float(self), self.name, self.symbol, self.unit, self.source)


class GivenPoint(complex):
    """A given point, see :class:`GivenNumber`."""

    name: str
    symbol: str
    unit: str
    source: str

    def __new__(cls, value: complex, name: str, symbol: str = "", unit: str = "", source: str = "") -> Self:
        """Attach the origin to a point."""
        found = super().__new__(cls, value)
        found.name, found.symbol, found.unit, found.source = name, symbol, unit, source
        return found

    def __reduce__(self) -> Any:
        """Pickled with its origin."""
        return type(self), (complex(self), self.name, self.symbol, self.unit, self.source)


@dataclass(frozen=True, eq=False)
class Given:
    """A given row of numbers, or a number found by a search (``choice``: it is told by what it was chosen).

    ``over``: a number for each position, or a curve (nodes of a table, samples of a law).
    """

    value: Any
    name: str
    symbol: str = ""
    unit: str = ""
    source: str = ""
    over: Over = "positions"
    choice: str = ""


class FoundNumber(float):
    """A number that an earlier construction found and that then serves as a given one: a length by synthesis, a radius.

    ``step`` is where it comes from.
    """

    step: Any

    def __new__(cls, value: float, step: Any) -> Self:
        """Attach the step to its value."""
        found = super().__new__(cls, value)
        found.step = step
        return found

    def __reduce__(self) -> Any:
        """Pickled as a bare number: a construction stays where it was made."""
        return float, (float(self),)


def named(value: float, name: str, symbol: str = "", unit: str = "") -> float:
    """A number with its origin; one that knows it already stays as it is."""
    return value if isinstance(value, GivenNumber) else GivenNumber(value, name, symbol, unit)
