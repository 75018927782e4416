"""What is wished of results, read: ``max |pressure angle|``, ``range(positions.points.S5.x) >= 0,34 m``.

Names are those of the results, or as much of their ends as leaves no doubt. A point is a vector: ``|..|`` is its length, ``.x`` and
``.y`` are its projections. Of what is told of many positions ``max``, ``min``, ``mean`` or ``range`` (greatest less least) makes
one number.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

import numpy as np

from tmm_sheets import spelling
from tmm_sheets.errors import BadInput
from tmm_sheets.task import units
from tmm_sheets.words import either, tell

LONGEST = 100
"""Names, numbers and signs of the longest wish: each bracket is read within the one before it."""
Values = Mapping[str, Any]
"""Numbers, arrays and words by the names of the results; points are complex."""
Reader = Callable[[Values], Any]

IN_MILLIMETRES = ("gear", "reducer", "train")
"""Parts whose lengths are told in mm."""
_TOKEN = re.compile(r"\s*(?:(?P<number>(?:\d+(?:[.,]\d+)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*(?P<unit>[^\W\d_][\w/²³·*]*|[°%])?"
                    r"|(?P<name>[^\W\d][\w.′″]*(?:\[\d+\][\w.′″]*)*(?:\s+(?!\|)[^\W\d][\w.′″]*)*)|(?P<sign><=|>=|≤|≥|[-−+*/()|,<>]))")
_OVER: dict[str, Callable[[Any], Any]] = {"max": np.max, "min": np.min, "mean": np.mean, "range": np.ptp, "abs": np.abs}
_SIGNS: dict[str, Callable[[Any, Any], Any]] = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide}


@dataclass(frozen=True)
class Wish:
    """A number made of results, and the results that it is made of."""

    text: str
    names: tuple[str, ...]
    read: Reader = field(repr=False)

    def __call__(self, values: Values) -> float:
        """Its value.

        Raises
        ------
        BadInput
            when it is no single number.
        """
        try:
            found = np.asarray(self.read(values))
            if found.ndim == 0 and found.dtype.kind in "fiu":
                return float(found)
        except (TypeError, ValueError):
            pass
        raise BadInput(tell("“{wish}” is no single real number").format(wish=self.text),
                       tell("write max, min, mean or range before what has many positions, |..|, .x or .y of a vector"))


@dataclass(frozen=True)
class Bound:
    """What a wish has to keep to: ``left`` at most ``right``."""

    text: str
    left: Wish
    right: Wish

    def missed(self, values: Values) -> float:
        """By how much it is not kept, as a share of the greater side; 0 where it is."""
        left, right = self.left(values), self.right(values)
        return max(left - right, 0.0) / (max(abs(left), abs(right)) or 1.0) if np.isfinite(left - right) else float("inf")


def wish(text: str, known: Collection[str]) -> Wish:
    """Read a wish.

    Raises
    ------
    BadInput
        for what cannot be read, or a name that none or several of the ``known`` results have.
    """
    reader = _Reader(text, known)
    found = reader.sum()
    reader.end()
    return Wish(text.strip(), tuple(reader.names), found)


def bound(text: str, known: Collection[str]) -> Bound:
    """Read a wish that holds for ``a <= b`` or ``a >= b``.

    Raises
    ------
    BadInput
        as :func:`wish`.
    """
    reader = _Reader(text, known)
    one = reader.sum()
    sign = reader.sign()
    if sign not in ("<", ">", "<=", ">=", "≤", "≥"):
        raise reader.wrong(tell("expected <= or >="))
    other = reader.sum()
    reader.end()
    left, right = (Wish(text.strip(), tuple(reader.names), side) for side in ((one, other) if sign[0] in "<≤" else (other, one)))
    return Bound(text.strip(), left, right)


class _Reader:
    """The text, read from left to right: sums of products of numbers, names, functions and what stands in brackets."""

    def __init__(self, text: str, known: Collection[str]) -> None:
        self.text, self.known = text, known
        self.names: dict[str, None] = {}
        self.tokens = [*islice(self._tokens(), LONGEST + 1)]
        self.at = 0
        if len(self.tokens) > LONGEST:
            raise BadInput(tell("expected a wish of {most} names, numbers and signs at most").format(most=LONGEST))

    def _tokens(self) -> Iterator[re.Match[str]]:
        at, text = 0, self.text.rstrip()
        while at < len(text):
            match = _TOKEN.match(text, at)
            if match is None:
                raise self.wrong(tell("{sign} has no meaning here").format(sign=text[at:].split()[0]))
            yield match
            at = match.end()

    def wrong(self, said: str) -> BadInput:
        return BadInput(f"“{self.text.strip()}”: {said}", tell("for example {wish}").format(wish="max |cam.pressure_angle|"))

    def _next(self) -> re.Match[str] | None:
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def sign(self, *signs: str) -> str:
        """The next sign, passed over, if it is one of some, or any."""
        match = self._next()
        found = match["sign"] if match is not None else None
        if found is None or (signs and found not in signs):
            return ""
        self.at += 1
        return found.replace("−", "-")

    def end(self) -> None:
        if (match := self._next()) is not None:
            raise self.wrong(tell("{sign} has no meaning here").format(sign=match[0].strip()))

    def sum(self) -> Reader:
        return self._chain(self._product, "+", "-", "−")

    def _product(self) -> Reader:
        return self._chain(self._factor, "*", "/")

    def _chain(self, of: Callable[[], Reader], *signs: str) -> Reader:
        found = of()
        while sign := self.sign(*signs):
            found = _both(_SIGNS[sign], found, of())
        return found

    def _factor(self) -> Reader:
        if self.sign("-", "−"):
            return _composed(np.negative, self._factor())
        if self.sign("("):
            found = self.sum()
            self._closed(")")
            return found
        if self.sign("|"):
            found = self.sum()
            self._closed("|")
            return _composed(np.abs, found)
        match = self._next()
        if match is None or match["sign"]:
            raise self.wrong(tell("expected a name of a result or a number"))
        if match["number"]:
            self.at += 1
            return self._number(match["number"].replace(",", "."), match["unit"] or "")
        name = match["name"]
        first, _, rest = name.partition(" ")
        if first not in _OVER:
            self.at += 1
            return self._result(name)
        if rest:  # max pressure angle
            self.at += 1
            return _composed(_OVER[first], self._result(rest))
        self.at += 1
        return self._function(first)

    def _function(self, name: str) -> Reader:
        if not self.sign("("):
            return _composed(_OVER[name], self._factor())
        found = [self.sum()]
        while self.sign(","):
            found.append(self.sum())
        self._closed(")")
        if len(found) == 1:
            return _composed(_OVER[name], found[0])
        between = {"max": np.maximum, "min": np.minimum}.get(name)
        if between is None:
            raise self.wrong(tell("{name} takes one").format(name=name))
        whole = found[0]
        for other in found[1:]:
            whole = _both(between, whole, other)
        return whole

    def _closed(self, sign: str) -> None:
        if not self.sign(sign):
            raise self.wrong(tell("{sign} is missing").format(sign=sign))

    def _number(self, number: str, unit: str) -> Reader:
        if not unit:
            x = float(number)
            return lambda values: x
        if not (quantity := units.quantity_of(unit)):
            raise self.wrong(tell("unknown unit {unit}").format(unit=unit))
        try:
            x = units.si(f"{number} {unit}")
        except ValueError as e:
            raise self.wrong(str(e)) from None
        # Where lengths are told in mm so they are compared.
        return lambda values: 1000 * x if quantity == units.LENGTH.name and {
            name.partition(".")[0] in IN_MILLIMETRES for name in self.names} == {True} else x

    def _result(self, written: str) -> Reader:
        name = re.sub(r"\s+", "_", written)
        for end, part in ((".x", np.real), (".y", np.imag)):
            if name.endswith(end) and (found := self._named(name.removesuffix(end))):
                self.names[found] = None
                return _composed(part, lambda values: values[found])
        found = self._named(name)
        if not found:
            raise BadInput(tell('there is no result "{result}"').format(result=written), spelling.hint(name, self.known, 6, 0.5))
        self.names[found] = None
        return lambda values: values[found]

    def _named(self, name: str) -> str:
        if name in self.known:
            return name
        ends = [path for path in self.known if path.endswith(f".{name}")]
        if len(ends) > 1:
            raise BadInput(tell('"{result}" may be {names}').format(result=name, names=either(ends)))
        return ends[0] if ends else ""


def _composed(does: Callable[[Any], Any], of: Reader) -> Reader:
    return lambda values: does(of(values))


def _both(does: Callable[[Any, Any], Any], one: Reader, other: Reader) -> Reader:
    return lambda values: does(one(values), other(values))
