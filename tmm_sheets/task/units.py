"""Numbers with their units, as people write them: ``"0.26 m"``, ``"260 мм"``, ``"72 rpm"``, ``"0,15 kg m2"``.

A field fixes the quantity, so a unit is looked up among the few of that quantity; the result is always SI (m, rad,
s, kg, N, N m, Pa ...). Conversion is exact up to the last rounding: factors are quotients of decimals. Quantities
as a task prints them (table ``[given]``) keep number and unit as they are written.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Context, Decimal
from types import MappingProxyType
from typing import Any, NamedTuple

from tmm_sheets import spelling
from tmm_sheets.words import marked, tell

_NOT_THAT = marked("{expected}, not {given}; write for example {example}")
_NOT_FINITE = marked("{expected}, not {given}; the number must be finite")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+/0*[1-9][0-9]*(?=\s*$)|(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)(?:[eE][+-]?[0-9]{1,3}(?![0-9]))?)")
_LONGEST = 60  # characters; no person writes a longer number
_EXACT = Context(prec=2 * _LONGEST)  # products are exact, a quotient is a last rounding away from the double next to it


class Refused(ValueError):
    """A value that is refused, in words that name the value itself."""


class Factor(NamedTuple):
    """SI value of one unit: ``over`` / ``under``, times pi when ``pi`` is set."""

    over: Decimal
    under: Decimal
    pi: bool = False

    def si(self, number: str) -> float:
        """SI value of a decimal number, or a fraction such as 1/20, written in this unit."""
        whole, _, parts = number.partition("/")
        value = float(_EXACT.divide(_EXACT.multiply(Decimal(whole), self.over), _EXACT.multiply(Decimal(parts or 1), self.under)))
        return value * math.pi if self.pi else value


@dataclass(frozen=True)
class Quantity:
    """A kind of quantity: its name in messages, their beginning, an example, and the units it may be written in."""

    name: str
    expected: str
    example: str
    units: MappingProxyType[str, Factor]


def _quantity(name: str, expected: str, example: str, units: dict[str, str | tuple[str, str]]) -> Quantity:
    table = {}
    for names, factor in units.items():
        (over, _, under), pi = (factor if isinstance(factor, str) else factor[0]).partition("/"), not isinstance(factor, str)
        for unit in names.split(" | "):
            table[_plain(unit)] = Factor(Decimal(over), Decimal(under or 1), pi)
    return Quantity(name, expected, example, MappingProxyType(table))


def _plain(unit: str) -> str:
    """One spelling for ``kg m2``, ``kg*m^2``, ``kg·m²``, ``кг⋅м2``: no signs of product and power, no spaces."""
    unit = unit.replace("²", "2").replace("³", "3").replace("⁻¹", "-1")
    return re.sub(r"[\s*·⋅×^]+", "", unit)


NUMBER = _quantity(marked("number"), marked("expected a number"), "0.025", {"": "1", "%": "1/100"})
LENGTH = _quantity(marked("length"), marked("expected a length"), "0.26 m", {"m | м": "1", "mm | мм": "1/1000", "cm | см": "1/100"})
ANGLE = _quantity(marked("angle"), marked("expected an angle"), "30 deg", {"deg | ° | град": ("1/180", "pi"), "rad | рад": "1"})
ANGULAR_VELOCITY = _quantity(
    marked("speed of rotation"),
    marked("expected a speed of rotation"),
    "72 rpm",
    {
        "rad/s | рад/с": "1",
        # A frequency of rotation is in 1/s (revolutions), an angular velocity in rad/s; GOST 8.417.
        "1/s | s-1 | rev/s | об/с | 1/с | с-1": ("2", "pi"),
        "rpm | rev/min | 1/min | min-1 | об/мин | 1/мин | мин-1": ("2/60", "pi"),
    },
)
VELOCITY = _quantity(marked("velocity"), marked("expected a velocity"), "8.64 m/s", {"m/s | м/с": "1"})
ANGULAR_ACCELERATION = _quantity(
    marked("angular acceleration"), marked("expected an angular acceleration"), "1.7 rad/s2", {"rad/s2 | рад/с2": "1"}
)
ACCELERATION = _quantity(marked("acceleration"), marked("expected an acceleration"), "9.81 m/s2", {"m/s2 | м/с2": "1"})
MASS = _quantity(marked("mass"), marked("expected a mass"), "5.66 kg", {"kg | кг": "1", "g | г": "1/1000", "t | т": "1000"})
INERTIA = _quantity(
    marked("moment of inertia"),
    marked("expected a moment of inertia"),
    "0.15 kg m2",
    {"kg m2 | кг м2": "1", "g m2 | г м2": "1/1000"},
)
FORCE = _quantity(marked("force"), marked("expected a force"), "2800 N", {"N | Н": "1", "kN | кН": "1000"})
MOMENT = _quantity(
    marked("moment"),
    marked("expected a moment"),
    "612 N m",
    {"N m | Nm | Н м": "1", "kN m | кН м": "1000", "N mm | Н мм": "1/1000"},
)
POWER = _quantity(marked("power"), marked("expected a power"), "15 kW", {"W | Вт": "1", "kW | кВт": "1000"})
PRESSURE = _quantity(
    marked("pressure"),
    marked("expected a pressure"),
    "6 MPa",
    {"Pa | Па": "1", "kPa | кПа": "1000", "MPa | МПа | N/mm2": "1000000"},
)
DENSITY = _quantity(marked("density"), marked("expected a density"), "7300 kg/m3", {"kg/m3 | кг/м3": "1", "g/cm3 | г/см3": "1000"})
STIFFNESS = _quantity(marked("spring rate"), marked("expected a spring rate"), "12 N/mm", {"N/m | Н/м": "1", "N/mm | Н/мм": "1000"})
QUANTITIES = (
    NUMBER, LENGTH, ANGLE, ANGULAR_VELOCITY, ANGULAR_ACCELERATION, ACCELERATION, MASS, INERTIA, FORCE, MOMENT, PRESSURE,
    DENSITY, STIFFNESS, POWER, VELOCITY,
)  # fmt: skip


def split(value: Any) -> tuple[str, str]:
    """Number, which may be a fraction such as 1/80, and unit of a value as it is written; both empty where there is no number."""
    text = str(value).strip().replace("−", "-")
    match = None if isinstance(value, bool) else _NUMBER.match(text)
    return (match.group().replace(",", "."), text[match.end() :].strip()) if match and match.end() <= _LONGEST else ("", "")


def common(unit: str) -> str:
    """One spelling for every way to write a unit, that of the program: rpm for об/мин, Nm for N*m."""
    plain = _plain(unit)
    for quantity in QUANTITIES:
        if plain in quantity.units:
            return next(name for name, factor in quantity.units.items() if factor == quantity.units[plain])
    return plain


def quantity_of(unit: str) -> str:
    """Name of the quantity that a unit is one of; empty for an unknown one."""
    return next((q.name for q in QUANTITIES if _plain(unit) in q.units), "")


def si(value: Any) -> float:
    """A value as it is written, in SI, whatever its quantity is; 0 for what is no number or has an unknown unit."""
    number, unit = split(value)
    factor = next((q.units[_plain(unit)] for q in QUANTITIES if _plain(unit) in q.units), None)
    return factor.si(number) if number and factor is not None else 0.0


def parse(value: Any, quantity: Quantity) -> float:
    """SI value of a number written with its unit; see :func:`read`."""
    return read(value, quantity)[0]


def read(value: Any, quantity: Quantity) -> tuple[float, float]:
    """SI value of a number written with its unit, and the number as it stands before the unit.

    Parameters
    ----------
    value
        string of a number and a unit; for a pure number also a TOML number.
    quantity
        what the number must be.

    Raises
    ------
    Refused
        what was expected and what to write instead; also for NaN and infinity.
    """
    expected = tell(quantity.expected)
    example = _quoted(quantity)
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise Refused(tell(_NOT_THAT).format(expected=expected, given=shown(value), example=example))
    if not isinstance(value, str):
        if not math.isfinite(value):
            raise Refused(tell(_NOT_FINITE).format(expected=expected, given=value))
        if quantity is not NUMBER:
            raise Refused(tell("{expected} with its unit, not the bare number {given}; write for example {example}").format(
                expected=expected, given=value, example=example))
        return float(value), float(value)
    text = value.strip().replace("−", "-")
    match = _NUMBER.match(text)
    if match is None or len(text) > _LONGEST:
        raise Refused(tell(_NOT_THAT).format(expected=expected, given=repr(value), example=example))
    unit = _plain(text[match.end() :])
    factor = quantity.units.get(unit)
    if factor is None:
        about = _about_unit(unit, text[match.end() :].strip(), quantity)
        raise Refused(tell("{expected}, not {given}; {about_unit}").format(expected=expected, given=repr(value), about_unit=about))
    number = match.group().replace(",", ".")
    result = factor.si(number)
    if not math.isfinite(result):
        raise Refused(tell(_NOT_FINITE).format(expected=expected, given=repr(value)))
    return result, NUMBER.units[""].si(number)


def _about_unit(plain: str, written: str, quantity: Quantity) -> str:
    if not plain:
        return tell("the unit is missing, write for example {example}").format(example=_quoted(quantity))
    if quantity is NUMBER:
        return tell("a pure number has no unit")
    others = [q.name for q in QUANTITIES if plain in q.units]
    if others:
        return tell("{unit} is a unit of {other}; write for example {example}").format(
            unit=repr(written), other=tell(others[0]), example=_quoted(quantity))
    as_long = [name for name in quantity.units if len(name) == len(plain)]  # half of it may be of another alphabet: мm, rad/с
    near = spelling.hint(plain, as_long, alike=0.5, written="'{}'") or spelling.hint(plain, quantity.units, written="'{}'")
    if near:
        return tell("unknown unit {unit}, {did_you_mean}").format(unit=repr(written), did_you_mean=near)
    known = ", ".join(u for u in quantity.units if u.isascii())
    return tell("unknown unit {unit}, known are {known}").format(unit=repr(written), known=known)


def _quoted(quantity: Quantity) -> str:
    return quantity.example if quantity is NUMBER else f'"{quantity.example}"'


def shown(value: Any) -> str:
    """A value that is no number, as it is told."""
    names = {bool: marked("true or false"), list: marked("a list"), dict: marked("a table")}
    return tell(names[type(value)]) if type(value) in names else repr(value)


# --- quantities as a task prints them ----------------------------------------------------------------------------------


_NAME = r"([^\W\d_]+?)_?((?<=_)\w+|\d*)(′*)"


class Printed(NamedTuple):
    """A quantity: its name in the file, letters with markup, number and unit as they are written, and its value in SI."""

    name: str
    symbol: str
    number: str
    unit: str
    value: float


def printed(given: Mapping[str, str]) -> Iterator[Printed]:
    """The quantities of a table whose values :func:`split_printed` takes."""
    for name, text in given.items():
        number, unit = split_printed(text)
        yield Printed(name, symbol(name), number, common(unit), si(text))


def split_printed(text: str) -> tuple[str, str]:
    """Number, which may be a fraction such as 1/80, and unit of a value; both empty where it is none."""
    number, unit = split(text)
    return (number, unit) if quantity_of(unit) else ("", "")


def symbol(name: str) -> str:
    """Lettering markup of a quantity as it is typed: l_OA, G2, theta, omega1; what is no letter with an index stands as it is."""
    found = re.fullmatch(_NAME, name)
    if found is None:
        return name
    letter, index, primes = found.groups()
    try:
        letter = unicodedata.lookup(f"GREEK SMALL LETTER {letter}")
    except KeyError:
        if len(letter) > 1:
            return name
    return f"{letter}{f'_{{{index}}}' if index else ''}{primes}"
