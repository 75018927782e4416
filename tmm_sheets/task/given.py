"""Quantities as a task prints them: table ``[given]``, which sheets show and nothing is computed from."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from tmm_sheets.task import units

_NAME = re.compile(r"([^\W\d_]+?)_?((?<=_)\w+|\d*)(′*)")


class Printed(NamedTuple):
    """A quantity: its name in the file, letters with markup, number and unit as they are written, and its value in SI."""

    name: str
    symbol: str
    number: str
    unit: str
    value: float


def printed(given: Mapping[str, str]) -> Iterator[Printed]:
    """The quantities of a table whose values :func:`split` takes."""
    for name, text in given.items():
        number, unit = split(text)
        yield Printed(name, symbol(name), number, units.common(unit), units.si(text))


def split(text: str) -> tuple[str, str]:
    """Number, which may be a fraction such as 1/80, and unit of a value; both empty where it is none."""
    number, unit = units.split(text)
    return (number, unit) if units.quantity_of(unit) else ("", "")


def symbol(name: str) -> str:
    """Lettering markup of a quantity as it is typed: l_OA, G2, theta, omega1; what is no letter with an index stands as it is."""
    found = _NAME.fullmatch(name)
    if found is None:
        return name
    letter, index, primes = found.groups()
    try:
        letter = unicodedata.lookup(f"GREEK SMALL LETTER {letter}")
    except KeyError:
        if len(letter) > 1:
            return name
    return f"{letter}{f'_{{{index}}}' if index else ''}{primes}"
