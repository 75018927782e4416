"""Types of the values in a project file: numbers with units, read into SI, with their ranges; names, directions, diagrams."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import GetCoreSchemaHandler, WrapValidator
from pydantic_core import CoreSchema, core_schema

from tmm_sheets import resources, spelling
from tmm_sheets.numbers import ROUNDING
from tmm_sheets.task import units
from tmm_sheets.task.letters import title_text
from tmm_sheets.words import marked, tell

LEAST, GREATEST = 1e-12, 1e12
"""Sizes of numbers in SI that any machine may have, zero besides: powers and products of what lies beyond are no numbers."""


def parsed(value: Any, quantity: units.Quantity) -> float:
    """A number with its unit in SI; zero for what rounding leaves of it, such as the 2.4e-15 mm of 40 mm cos 90 deg.

    Raises
    ------
    Refused
        when it is no such number, or larger than a machine has any.
    """
    found, written = units.read(value, quantity)
    if abs(found) > GREATEST:
        raise _out_of_range(value, quantity)
    return 0.0 if abs(found) < LEAST or abs(written) < ROUNDING else found


def _out_of_range(value: Any, quantity: units.Quantity) -> units.Refused:
    said = tell("{expected} of {least:g} to {greatest:g} in SI units, not {given!r}; is the unit right?")
    return units.Refused(said.format(expected=tell(quantity.expected), least=LEAST, greatest=GREATEST, given=value))


class Reads:
    """Reads what stands in a file: there is nothing left for pydantic to read, which would take long to find that out."""

    def __init__(self, func: Callable[[Any], Any]) -> None:
        self.func = func

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.func)


class Checks(Reads):
    """Looks at what was read, and may change it."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self.func, handler(source))


def si(quantity: units.Quantity) -> Reads:
    """Reads a quantity into SI."""
    return Reads(lambda value: parsed(value, quantity))


def si_or(quantity: units.Quantity, *words: str) -> Reads:
    """Reads a quantity into SI, or one of some words in its place."""
    return Reads(lambda value: value if value in words else parsed(value, quantity))


def or_word(word: str) -> WrapValidator:
    """Lets one word stand for the value."""
    return WrapValidator(lambda value, read: value if value == word else read(value))


def in_range(wording: str, holds: Callable[[float], bool]) -> Checks:
    """Refuses values for which ``holds`` is false; ``wording`` says what was expected, a text of the catalogues."""

    def check(value: float) -> float:
        if not holds(value):
            raise ValueError(tell(wording))
        return value

    return Checks(check)


MOST = 100_000
"""Greatest count: teeth, positions."""


MOST_PARTS = 720
"""Most parts of a turn."""


def whole(least: int, most: int = MOST, fewer: str = marked("expected a whole number of {most} or less")) -> Reads:
    """Takes whole numbers from ``least`` to ``most``; ``fewer`` says of more what was expected and why."""

    def check(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise ValueError(tell("expected a whole number, {least} or more").format(least=least))
        if value > most:
            raise ValueError(tell(fewer).format(most=most))
        return value

    return Reads(check)


def parts(least: int) -> Reads:
    """Takes parts of a turn."""
    return whole(least, MOST_PARTS, marked("expected {most} parts or fewer: half a degree of a turn, no protractor reads less"))


def _even_parts(parts: int) -> int:
    """Even, 12 at most."""
    if parts % 2 or parts > 12:
        raise ValueError(tell("expected an even number of parts, 12 at most"))
    return parts


def positive(quantity: units.Quantity, wording: str) -> Reads:
    """Reads a quantity into SI that must be greater than zero, and more than rounding leaves of it."""

    def check(value: Any) -> float:
        found = parsed(value, quantity)
        if not found and units.parse(value, quantity) > 0:
            raise _out_of_range(value, quantity)
        if not found > 0:
            raise ValueError(tell(wording))
        return found

    return Reads(check)


def not_negative(wording: str) -> Checks:
    """Refuses less than zero."""
    return in_range(wording, lambda x: x >= 0)


def from_to(low: float, high: float, wording: str) -> Checks:
    """Takes what lies between two limits, these included; what lies beyond by rounding is the limit."""

    def check(value: float) -> float:
        if not low - ROUNDING * abs(low) <= value <= high + ROUNDING * abs(high):
            raise ValueError(tell(wording))
        return min(max(value, low), high)

    return Checks(check)


_ACUTE = in_range(
    marked("expected an angle between 0 and 90 deg, both excluded"), lambda x: 0 < x < units.parse("90 deg", units.ANGLE)
)
_PHASE = from_to(0, units.parse("360 deg", units.ANGLE), marked("expected an angle from 0 to 360 deg"))
_FRACTION = from_to(0, 1, marked("expected a number from 0 to 1"))
_INNER_FRACTION = in_range(marked("expected a number between 0 and 1, both excluded"), lambda x: 0 < x < 1)

def _printed(value: Any) -> str:
    """Number with a known unit, or a fraction such as `"1/80"`."""
    if isinstance(value, bool) or not isinstance(value, str | int | float) or not units.split_printed(str(value))[0]:
        raise ValueError(tell('expected a number with its unit, or a fraction, for example "80 N" or "1/80"'))
    return str(value)


PrintedNumber = Annotated[str, Reads(_printed)]
Coordinate = Annotated[float, si(units.LENGTH)]
Length = Annotated[float, positive(units.LENGTH, marked("expected a length greater than zero"))]
Angle = Annotated[float, si(units.ANGLE)]
AcuteAngle = Annotated[float, si(units.ANGLE), _ACUTE]
PhaseAngle = Annotated[float, si(units.ANGLE), _PHASE]
Speed = Annotated[float, positive(units.ANGULAR_VELOCITY, marked("expected a speed of rotation greater than zero"))]
SignedSpeed = Annotated[float, si(units.ANGULAR_VELOCITY)]
CrankAcceleration = Annotated[float | Literal["flywheel"], si_or(units.ANGULAR_ACCELERATION, "flywheel")]
Start = Annotated[str | float, si_or(units.ANGLE, "dead", "input")]
InputSpeed = Annotated[float, positive(units.VELOCITY, marked("expected a velocity greater than zero"))]
InputAcceleration = Annotated[float, si(units.ACCELERATION)]
Gravity = Annotated[float, si(units.ACCELERATION), not_negative(marked("expected a gravity of zero or more"))]
Mass = Annotated[float, si(units.MASS), not_negative(marked("expected a mass of zero or more"))]
Inertia = Annotated[float, si(units.INERTIA), not_negative(marked("expected a moment of inertia of zero or more"))]
Newtons = Annotated[float, si(units.FORCE), not_negative(marked("expected a force of zero or more"))]
Density = Annotated[float, positive(units.DENSITY, marked("expected a density greater than zero"))]
Number = Annotated[float, si(units.NUMBER)]
PositiveNumber = Annotated[float, positive(units.NUMBER, marked("expected a number greater than zero"))]
Fraction = Annotated[float, si(units.NUMBER), _FRACTION]
InnerFraction = Annotated[float, si(units.NUMBER), _INNER_FRACTION]
Teeth = Annotated[int, whole(4)]
Count = Annotated[int, whole(1)]
Parts = Annotated[int, parts(1)]
TurnParts = Annotated[int, parts(4)]
Turns = Annotated[int, whole(1, 12)]
EvenParts = Annotated[int, whole(4), Checks(_even_parts)]
Side = Literal[1, -1]
CamLaw = Literal["constant", "cosine", "sine", "trapezoid", "linearly decreasing", "table", "displacements"]
Sense = Literal["clockwise", "counter-clockwise"]


LONGEST_NAME = 60
"""Characters of the longest name."""


def _name(value: Any) -> str:
    """Name in quotes."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError(tell('expected a name in quotes, for example "B"'))
    if len(value) > LONGEST_NAME:
        raise ValueError(tell("expected a name of {most} characters at most").format(most=LONGEST_NAME))
    return value


def _member(value: Any) -> str:
    """Name in quotes."""
    return _name(value).replace("'", "′")  # wheel 2′ of a block, as it can be typed


def _wheel(value: Any) -> str:
    """Number of a wheel in quotes."""
    if not re.fullmatch("[1-9][0-9]*′*", named := _member(value)):
        raise ValueError(tell('expected the number of a wheel in quotes, for example "1"'))
    return named


def _carrier(value: Any) -> str:
    """`"H"` or `"H1"`."""
    if not re.fullmatch("H[0-9]*", name := _name(value)):
        raise ValueError(tell('expected a carrier "H" or "H1"'))
    return name


def _direction(value: Any) -> float | str:
    """`"against motion"`, `"along motion"` or an angle."""
    if isinstance(value, str) and value in ("against motion", "along motion"):
        return value
    try:
        return parsed(value, units.ANGLE)
    except ValueError:
        raise ValueError(tell('expected "against motion", "along motion" or an angle, for example "30 deg"')) from None


def _point_or_coordinates(value: Any) -> str | tuple[float, float]:
    """Name of a point or its two coordinates."""
    if isinstance(value, str) and value.strip():
        return value
    if isinstance(value, list) and len(value) == 2:
        return parsed(value[0], units.LENGTH), parsed(value[1], units.LENGTH)
    raise ValueError(tell('expected the name of a point or two coordinates, for example ["0 m", "0.33 m"]'))


TitleText = Annotated[str, Checks(title_text)]
Name = Annotated[str, Reads(_name)]
MemberName = Annotated[str, Reads(_member)]
WheelName = Annotated[str, Reads(_wheel)]
CarrierName = Annotated[str, Reads(_carrier)]
ForceDirection = Annotated[str | float, Reads(_direction)]
GuidePoint = Annotated[str | tuple[float, float], Reads(_point_or_coordinates)]


def _diagram(value: Any) -> tuple[tuple[str | float, str | float], ...]:
    """List of pairs.

    They stay as written: their units follow from the table they stand in and are read there.
    """
    if not isinstance(value, list) or not all(isinstance(p, list) and len(p) == 2 for p in value):
        raise ValueError(tell('expected a list of pairs, for example [[0, "0 N"], [0.6, "0 N"], [1, "1000 kN"]]'))
    return tuple((p[0], p[1]) for p in value)


Diagram = Annotated[tuple[tuple[Any, Any], ...], Reads(_diagram)]
Torque = Annotated[float, si(units.MOMENT), not_negative(marked("expected a moment of zero or more"))]
Pressure = Annotated[float, si(units.PRESSURE)]


def levelled(numbers: list[float], size: float) -> list[float]:
    """Numbers that are the one before them but for rounding made equal to it; ``size`` is a usual size of them."""
    found: list[float] = []
    for x in numbers:
        found.append(found[-1] if found and abs(x - found[-1]) < ROUNDING * max(size, abs(x)) else x)
    return found


def diagram(pairs: Sequence[tuple[Any, Any]], argument: units.Quantity, value: units.Quantity) -> tuple[list[float], list[float]]:
    """Arguments and values of a diagram in SI, n numbers each.

    Raises
    ------
    ValueError
        when a unit is wrong or the arguments do not rise.
    """
    x = levelled([parsed(p[0], argument) for p in pairs], 1.0)
    y = [parsed(p[1], value) for p in pairs]
    if any(b < a for a, b in pairwise(x)):
        raise ValueError(tell("expected arguments that rise from pair to pair"))
    return x, y


def phase_diagram(pairs: Sequence[tuple[Any, Any]]) -> tuple[list[float], list[float]]:
    """Shares of the phase from 0 to 1 and numbers over them, n each.

    Raises
    ------
    Refused
        when the shares do not rise from 0 to 1.
    """
    x, y = diagram(pairs, units.NUMBER, units.NUMBER)
    x = [1.0 if abs(share - 1) < ROUNDING else share for share in x]
    if len(x) < 2 or x[0] != 0 or x[-1] != 1:
        raise units.Refused(
            tell("expected shares of the phase from 0 to 1, not from {first:g} to {last:g}").format(first=x[0], last=x[-1])
            if x
            else tell("expected shares of the phase from 0 to 1, not an empty table")
        )
    return x, y


def _shares(pairs: Sequence[tuple[Any, Any]]) -> Sequence[tuple[Any, Any]]:
    """Shares of the phase from 0 to 1."""
    phase_diagram(pairs)
    return pairs


CamDiagram = Annotated[tuple[tuple[Any, Any], ...], Reads(_diagram), Checks(_shares)]


def _arrangement(value: Any) -> str:
    """Name of an arrangement."""
    return _known(_name(value), [p.stem for p in resources.template("sheets").glob("*.toml")],
                  tell('unknown sheet, not in templates/sheets: "{name}"; {hint}'))


def _manual(name: str) -> str:
    """Name of a manual whose order the note may have."""
    path = resources.template("note/order.toml")
    try:
        order = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as e:
        raise units.Refused(f"{path}: {e}") from None
    return _known(name, order["manuals"], tell('unknown manual, not in templates/note/order.toml: "{name}"; {hint}'))


def _known(name: str, names: Iterable[str], message: str) -> str:
    """A name that is one of those there are."""
    known = sorted(names)
    if name not in known:
        near, listed = meant(name, known)
        raise units.Refused(message.format(name=name, hint=near or tell("known are {known}").format(known=listed)))
    return name


SheetName = Annotated[str, Reads(_arrangement)]
ManualName = Annotated[str, Checks(_manual)]


def meant(word: str, known: list[str]) -> tuple[str, str]:
    """A hint at the word that was meant, empty when none is near; all words that are known."""
    return spelling.hint(word, known, written='"{}"'), ", ".join(known)
