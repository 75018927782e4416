"""Printed formulas read as a person reads them: from the equations of the finished file, with a pocket calculator.

Nothing here knows the program's trees or values. An equation of Word is read into a line of signs, cut at its signs of equality;
each part that holds no letter is worked out and must give the next, a single number, to half a unit of its last digit.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass

_M = "{http://schemas.openxmlformats.org/officeDocument/2006/math}"
_BRACKETS = {"(": "(", "|": "abs(", "[": "("}


def line_of(equation: str) -> str:
    """An equation of Word as one line: fractions, roots and powers with brackets, a unit between ``⟦`` and ``⟧``."""
    return _line(ET.fromstring(equation))


def _line(x: ET.Element) -> str:
    tag = x.tag.removeprefix(_M)
    if tag == "r":
        text = "".join(t.text or "" for t in x.iter(f"{_M}t"))
        return f"⟦{text.strip()}⟧" if text.startswith("\u00a0") else text

    def part(name: str) -> str:
        return "".join(_line(y) for y in x.iterfind(f"{_M}{name}"))

    if tag == "f":
        return f"(({part('num')})/({part('den')}))"
    if tag == "rad":
        return f"√({part('e')})"
    if tag in ("sSub", "sSup", "sSubSup"):
        below, above = part("sub"), part("sup")
        index = f"_{{{below}}}" if below else ""
        power = (above if above in ("′", "″") else f"^({above})") if above else ""
        return part("e") + index + power
    if tag == "bar":
        return f"{part('e')}̅"
    if tag == "d":
        begin = x.find(f"{_M}dPr/{_M}begChr")
        return f"{_BRACKETS[begin.get(f'{_M}val')]}{part('e')})"
    return "".join(_line(y) for y in x)


def chunks(line: str) -> list[str]:
    """What stands between the signs of equality."""
    return [c.strip() for c in line.split("=")]


_NUMBER = re.compile(r"\d+(?:[.,]\d+)?")
_ANGLE = re.compile(r"(\d+(?:[.,]\d+)?)°(?:(\d+(?:[.,]\d+)?)′)?(?:(\d+(?:[.,]\d+)?)″)?")
_RESULT = re.compile(r"\s*(−?)(?:\((−?)\))?(\d+(?:[.,]\d+)?)(?:·10\^\((−?\d+)\))?\s*(?:⟦([^⟧]*)⟧)?\s*")
_ANGULAR = re.compile(rf"\s*(−?)({_ANGLE.pattern})\s*")
_FUNCTIONS = {
    "sin": math.sin, "cos": math.cos, "tg": math.tan, "tan": math.tan, "arctg": math.atan, "arcsin": math.asin, "arccos": math.acos,
    "arctan": math.atan, "√": math.sqrt, "abs": abs, "exp": math.exp, "ln": math.log, "log": math.log, "min": min, "max": max,
    "НОД": lambda a, b: math.gcd(round(a), round(b)), "НСД": lambda a, b: math.gcd(round(a), round(b)),
    "gcd": lambda a, b: math.gcd(round(a), round(b)), "ctg": lambda a: 1 / math.tan(a),
}  # fmt: skip


class Unread(Exception):
    """A formula that holds what no formula of numbers holds."""


class _Reader:
    """Recursive descent over one line."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0

    def _skip(self) -> None:
        while self.at < len(self.text) and self.text[self.at] in " \u00a0":
            self.at += 1

    def taken(self, sign: str) -> bool:
        """Whether the next sign is that one; it is then left behind."""
        self._skip()
        if self.text.startswith(sign, self.at):
            self.at += len(sign)
            return True
        return False

    def sum(self) -> float:
        """Terms with plus and minus between them."""
        value = -self.product() if self.taken("−") else self.product()
        while True:
            if self.taken("+"):
                value += self.product()
            elif self.taken("−"):
                value -= self.product()
            else:
                return value

    def product(self) -> float:
        """Factors with a dot, a stroke or nothing between them."""
        value = self.power()
        while True:
            self._skip()
            if self.taken("·"):
                value *= self.power()
            elif self.taken("/"):
                value /= self.power()
            elif self.at < len(self.text) and (self.text[self.at] in "(√π" or self.text[self.at].isalpha()):
                value *= self.power()
            else:
                return value

    def power(self) -> float:
        """A base, and what it is raised to."""
        base = self.atom()
        return base ** self._bracket()[0] if self.taken("^") else base

    def _bracket(self) -> list[float]:
        if not self.taken("("):
            raise Unread(f"no bracket at {self.at} of {self.text!r}")
        found = [self.sum()]
        while self.taken(";"):
            found.append(self.sum())
        if not self.taken(")"):
            raise Unread(f"no closing bracket at {self.at} of {self.text!r}")
        return found

    def atom(self) -> float:
        """A number, an angle, a bracket or a function."""
        self._skip()
        rest = self.text[self.at :]
        if m := _ANGLE.match(rest):
            self.at += m.end()
            return angle(m)
        if m := _NUMBER.match(rest):
            self.at += m.end()
            return read(m[0])
        if self.taken("−"):
            return -self.atom()
        if self.taken("π"):
            return math.pi
        for name in sorted(_FUNCTIONS, key=len, reverse=True):
            if self.taken(name):
                self._skip()
                of = self._bracket() if self.text[self.at : self.at + 1] == "(" else [self.power()]
                return float(_FUNCTIONS[name](*of))
        if rest.startswith("("):
            return self._bracket()[0]
        raise Unread(f"{rest[:20]!r} in {self.text!r}")


def read(number: str) -> float:
    """A number as printed."""
    return float(number.replace(",", ".").replace("−", "-"))


def angle(m: re.Match[str]) -> float:
    """An angle in degrees, minutes and seconds, rad."""
    degrees, minutes, seconds = (read(x) if x else 0.0 for x in m.groups()[-3:])
    return math.radians(degrees + minutes / 60 + seconds / 3600)


def worked_out(text: str) -> float:
    """The value of a part of a formula.

    Raises
    ------
    Unread
        for a part with letters.
    """
    reader = _Reader(text)
    value = reader.sum()
    reader._skip()
    if reader.at < len(text):
        raise Unread(f"{text[reader.at:][:20]!r} left of {text!r}")
    return value


def result(text: str) -> tuple[float, float, str] | None:
    """A single number: its value, half a unit of its last digit, its unit; None for anything else."""
    if m := _ANGULAR.fullmatch(text):
        sign = -1.0 if m[1] else 1.0
        size = angle(_ANGLE.match(m[2]))
        parts = [x for x in _ANGLE.match(m[2]).groups() if x]
        unit = math.radians(1.0) / 60 ** (len(parts) - 1) if len(parts) > 1 else math.radians(1 / 60)
        fraction = parts[-1].replace(",", ".").partition(".")[2]
        return sign * size, 0.5 * unit * 10.0 ** -len(fraction), "°"
    if m := _RESULT.fullmatch(text):
        value = read(m[3]) * (-1.0 if m[1] or m[2] else 1.0)
        fraction = m[3].replace(",", ".").partition(".")[2]
        raised = 10.0 ** int((m[4] or "0").replace("−", "-"))
        return value * raised, 0.5 * 10.0 ** -len(fraction) * raised, m[5] or ""
    return None


@dataclass(frozen=True)
class Equality:
    """One equality of a formula: a part that was worked out, the number it is said to give."""

    left: str
    right: str
    value: float
    said: float
    half: float

    @property
    def units(self) -> float:
        """By how many units of the last digit both differ."""
        return abs(self.value - self.said) / (2 * self.half)

    @property
    def holds(self) -> bool:
        """Whether the left side gives the right to half a unit of its last digit."""
        return self.units <= 0.5 + 1e-9 + 1e-12 * abs(self.said) / self.half


def _of_letters(text: str) -> bool:
    """Whether a part says what is to be done in letters: there is one that is no function."""
    for name in sorted(_FUNCTIONS, key=len, reverse=True):
        text = text.replace(name, "")
    return any(c.isalpha() and c != "π" for c in re.sub(r"⟦[^⟧]*⟧", "", text))


def equalities(line: str) -> tuple[list[Equality], list[str]]:
    """The equalities between numbers in a formula, and the parts that hold no letter and still could not be read."""
    found: list[Equality] = []
    unread: list[str] = []
    last: tuple[str, float] | None = None
    for text in chunks(line):
        said = result(text)
        if said is not None:
            if last is not None:
                found.append(Equality(last[0], text, last[1], said[0], said[1]))
            last = (text, said[0])
            continue
        try:
            last = (text, worked_out(text))
        except Unread as e:
            last = None
            if not _of_letters(text):
                unread.append(str(e))
    return found, unread
