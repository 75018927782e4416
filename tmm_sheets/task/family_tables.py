"""Tables of a family's variants, CSV or TOML, as a manual prints them, and what a cipher chooses in them; filling in a scheme.

A table with a column ``key`` has a row for each quantity, and a column for each figure of a digit of the cipher (``0`` .. ``9``, or
``0..4``); which digit stands in the column ``digit``; ``symbol``, ``table`` and ``note`` are for the source. Any other table has a
row for each variant: its first column is called after the digits that choose the row, the others after the quantities; a row that
begins with ``unit`` has their units. A TOML table has ``digit``, ``[unit]`` and ``[values]``, lists by the figure of the digit.
"""

from __future__ import annotations

import ast
import math
import operator
import random
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from string import Template

from pydantic import Field, field_validator

from tmm_sheets import csv_tables, toml_file
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.spelling import latin
from tmm_sheets.task.schema import RuledTable
from tmm_sheets.words import marked, tell

ABOUT = ("table", "symbol")
"""Columns of what a quantity is called in the manual."""
@dataclass(frozen=True)
class Choice:
    """A value of a project: as it is written there, and where it comes from."""

    text: str
    source: str = ""


@dataclass(frozen=True)
class Row:
    """A quantity with its value for each figure of the digits that choose it; ``line`` of the file is that of the quantity.

    Without a digit the first value is everybody's. ``about`` has the table's other columns, ``note`` follows the source.
    """

    key: str
    unit: str
    digit: str
    cells: Mapping[str, str]
    file: str
    line: int
    about: Mapping[str, str] = field(default_factory=dict)
    note: str = ""

    @property
    def symbol(self) -> str:
        """Its name in the manual."""
        return self.about.get("symbol") or self.key

    def cell(self, digits: Mapping[str, str]) -> tuple[str, str]:
        """The column that a cipher chooses, and what stands there.

        Raises
        ------
        BadInput
            when there is none, or nothing stands there.
        """
        figure = "".join(digits[letter] for letter in self.digit)
        column = next((head for head in self.cells if not self.digit or holds_figure(head, figure)), None)
        if column is None or not self.cells[column]:
            raise BadInput(Problem(tell("nothing for {digit} = {figure}").format(digit=self.digit, figure=figure), self.file,
                                   self.line, self.key))
        return column, self.cells[column]

    def source(self, form: str, column: str, **more: str) -> str:
        """Where a value comes from: ``form`` filled in, then the note; of a value that no digit chooses, the note alone."""
        if not self.digit:
            return self.note
        said = Template(form).safe_substitute({
            **more, **self.about, "file": Path(self.file).name, "key": self.key, "symbol": self.symbol, "digit": self.digit,
            "column": column})  # fmt: skip
        return f"{said}{'' if self.note[:1] in ',;:' else ' '}{self.note}"

    def written(self, value: str) -> str:
        """A value with its unit."""
        return f"{value} {self.unit}".rstrip()


def holds_figure(head: str, figure: str) -> bool:
    """Whether a column, or a row, is that of a figure."""
    low, dots, high = [part.strip() for part in head.partition("..")]
    ends = (low, figure, high if dots else low)
    return head == figure or (all(end.isdecimal() and len(end) <= LONGEST for end in ends)
                              and int(ends[0]) <= int(figure) <= int(ends[2]))


def read(path: Path, digits: str) -> list[Row]:
    """The rows of a table; ``digits`` are the letters of the cipher's.

    Raises
    ------
    BadInput
        with what is wrong in it.
    """
    return list(_read(path, digits, path.stat().st_mtime_ns if path.is_file() else 0))


@lru_cache(64)
def _read(path: Path, digits: str, changed: int) -> tuple[Row, ...]:
    text, _ = toml_file.text_of(path, most=csv_tables.LARGEST)
    rows = [*(_of_toml(text, str(path)) if path.suffix == ".toml" else _of_csv(text, str(path)))]
    for row in rows:
        if unknown := [letter for letter in row.digit if letter not in digits]:
            raise BadInput(Problem(tell("the cipher has no digit {digit}").format(digit=unknown[0]), row.file, row.line, row.key,
                                   tell("its digits are {digits}").format(digits=", ".join(digits) or "–")))
    return tuple(rows)


def _of_csv(text: str, file: str) -> Iterator[Row]:
    rows = [*csv_tables.rows(text, file, "#")]
    if not rows:
        raise BadInput(Problem(tell("the table is empty"), file))
    (first, head), *rows = rows
    if "key" in head:
        columns = [k for k, name in enumerate(head) if name and name not in ("key", "unit", "digit", "note", *ABOUT)]
        for line, cells in rows:
            found = dict(zip(head, [*cells, *[""] * len(head)], strict=False))
            yield Row(found["key"], found.get("unit", ""), found.get("digit", ""), {head[k]: found[head[k]] for k in columns},
                      file, line, {name: found[name] for name in ABOUT if name in found}, found.get("note", ""))
        return
    units = next((cells for _, cells in rows if cells[0] == "unit"), [])
    variants = [(line, cells) for line, cells in rows if cells[0] != "unit"]
    for k, name in enumerate(head[1:], 1):
        if name:
            values = {own[0]: own[k] if k < len(own) else "" for _, own in variants}
            yield Row(name, units[k] if k < len(units) else "", head[0], values, file, first)


def _of_toml(text: str, file: str) -> Iterator[Row]:
    data, _ = toml_file.parsed(text, file)
    values = data.get("values", {})
    lines = text.splitlines()
    for key, cells in values.items() if isinstance(values, dict) else ():
        line = next((n for n, one in enumerate(lines, 1) if one.partition("=")[0].strip() == key and "[" in one), 1)
        if not isinstance(cells, list):
            raise BadInput(Problem(tell("expected a list, a value for each figure of the digit"), file, line, f"values.{key}"))
        digit = data.get("digit", "")
        yield Row(key, str(data.get("unit", {}).get(key, "")), str(digit.get(key, "") if isinstance(digit, dict) else digit),
                  {str(n): str(cell) for n, cell in enumerate(cells)}, file, line)


# --- schemes and formulas ---------------------------------------------------------------------------------------------


def filled(scheme: str, values: Mapping[str, Choice]) -> str:
    """A scheme with its values; behind each line what the numbers on it come from, unless the line says it, as in ``$l_source``.

    Raises
    ------
    KeyError
        for a name that is none of the values.
    ValueError
        for a sign $ that stands before no name.
    """
    lines = []
    for line in scheme.splitlines():
        keys = Template(line).get_identifiers()
        line = Template(line).substitute({key: values[key].text for key in keys})
        told = any(key.endswith(SOURCE) for key in keys)
        sources = [part for part in dict.fromkeys([values[key].source for key in keys]) if part and not told]
        if sources:
            written, _, comment = line.partition("#")
            line = f"{written.rstrip()}  # {'; '.join(filter(None, (comment.strip(), *sources)))}".lstrip()
        lines.append(line)
    return "\n".join(lines) + "\n"


_TWO: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow}
_OF_DEGREES: dict[str, Callable[[float], float]] = {
    "sin": lambda x: math.sin(math.radians(x)), "cos": lambda x: math.cos(math.radians(x)),
    "tan": lambda x: math.tan(math.radians(x)), "asin": lambda x: math.degrees(math.asin(x)),
    "acos": lambda x: math.degrees(math.acos(x)), "atan": lambda x: math.degrees(math.atan(x))}
KNOWN: dict[str, Callable[[float], float]] = {**_OF_DEGREES, "sqrt": math.sqrt, "abs": abs, "round": round}
"""Functions of one number; angles are degrees."""


def formula_value(text: str, numbers: Mapping[str, float]) -> float:
    """The number that a formula gives; of a comparison, 1 where it holds.

    Raises
    ------
    ValueError
        for what is no formula, a name that is no number, or a number that there is not.
    """
    try:
        return float(_value(ast.parse(text.strip().replace("^", "**"), mode="eval").body, numbers))
    except (SyntaxError, ZeroDivisionError, OverflowError, TypeError, RecursionError) as e:
        raise ValueError(str(e)) from None


def _value(node: ast.expr, numbers: Mapping[str, float]) -> float:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return float(node.value)  # type: ignore[arg-type]
    if isinstance(node, ast.Name) and (node.id in numbers or node.id == "pi"):
        return numbers.get(node.id, math.pi)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_value(node.operand, numbers)
    if isinstance(node, ast.BinOp) and type(node.op) in _TWO:
        return _TWO[type(node.op)](_value(node.left, numbers), _value(node.right, numbers))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in KNOWN and len(node.args) == 1:
        return KNOWN[node.func.id](_value(node.args[0], numbers))
    if isinstance(node, ast.Compare) and [type(sign) for sign in node.ops] in ([ast.Lt], [ast.Gt]):
        left, right = _value(node.left, numbers), _value(node.comparators[0], numbers)
        return float(left < right if isinstance(node.ops[0], ast.Lt) else left > right)
    raise ValueError(ast.unparse(node))


# --- ciphers -----------------------------------------------------------------------------------------------------------


MOST_CIPHERS = 1000
"""Most ciphers that are gone through."""


LONGEST, CHOICES = 100, 12
"""Signs of the longest cipher, and most alternatives, and parts that may be missing, of a form: each may double the time."""
_OF_FORM = re.compile(r"""
    \\. | \[\^?\]?(?:\\.|[^\]\\])*\]            # a letter as it is, a class of letters
    | (?P<look>\(\?)                              # what looks elsewhere, or remembers
    | (?P<repeated>(?:[*+]|\{\d*,?\d*\})(?![?+]))
    | (?P<told>[*+}?][?+])                        # a repetition that is told to take less, or more
    | (?P<choice>[|?])
    """, re.DOTALL | re.VERBOSE)


@lru_cache(64)
def compiled(form: str) -> re.Pattern[str]:
    """A form as it is matched: what is repeated takes as much as it can and gives nothing back, so that no text takes long.

    Raises
    ------
    re.error
        for what is no regular expression, or more than a form may have.
    """
    choices = 0

    def possessive(match: re.Match[str]) -> str:
        nonlocal choices
        if match["look"] or match["told"]:
            raise re.error(tell("a form has no {what}").format(what=match[0]))
        choices += match["choice"] is not None
        return f"{match[0]}+" if match["repeated"] else match[0]

    ways = _OF_FORM.sub(possessive, form.replace("(?P<", "(\0").replace("(?:", "(\1"))
    if choices > CHOICES:
        raise re.error(tell("a form has {most} alternatives at most").format(most=CHOICES))
    return re.compile(ways.replace("(\0", "(?P<").replace("(\1", "(?:"))


class CipherTable(RuledTable):
    """``[cipher]``, where digits at fixed places do not say it."""

    form: str = Field(
        description=marked('a regular expression with named parts, for example "(?P<year>[0-9]+)-(?P<number>[0-9]+)"'))
    written: str = ""
    """how it is printed, `$year-$number`; as it was typed unless told"""
    letters: str = Field(description=marked('a letter for each digit that chooses, for example "abc"'))
    digits: tuple[tuple[str, int], ...] = Field(
        description=marked('the last digits of parts, for example [["year", 1], ["number", 2]]'))
    padding: str = "0"
    """what fills a part with too few digits, at its end"""
    spelling: dict[str, str] = Field(default={})
    """words in another alphabet"""

    @field_validator("form")
    @classmethod
    def _compiles(cls, form: str) -> str:
        try:
            compiled(form)
        except (re.error, RecursionError, OverflowError) as e:
            raise ValueError(str(e)) from None
        return form

    rules = (
        (marked("expected digits of the parts of form, as many as there are letters"),
         lambda cipher: not {name for name, _ in cipher.digits} <= {*compiled(cipher.form).groupindex}
         or sum(n for _, n in cipher.digits) != len(cipher.letters) or any(n < 1 for _, n in cipher.digits)),
        (marked("expected one sign as padding"), lambda cipher: len(cipher.padding) != 1),
        (marked("expected written to be made of the parts of form, such as $year-$number"),
         lambda cipher: not Template(cipher.written).is_valid()
         or not {*Template(cipher.written).get_identifiers()} <= {*compiled(cipher.form).groupindex}),
    )


def of_signs(signs: str) -> CipherTable:
    """A cipher such as ``yy-Т-ab``: small Latin letters are digits; those that it has once choose."""
    parts = [f"p{k}" if "a" <= sign <= "z" else "" for k, sign in enumerate(signs)]
    # A letter of a cipher is written in either alphabet.
    form = "".join(f"(?P<{part}>[0-9])" if part else f"[{sign}{latin(sign)}]" if latin(sign) != sign else re.escape(sign)
                   for part, sign in zip(parts, signs, strict=True))
    chosen = [(part, sign) for part, sign in zip(parts, signs, strict=True) if part and signs.count(sign) == 1]
    written = "".join(f"${{{part}}}" if part else sign.replace("$", "$$") for part, sign in zip(parts, signs, strict=True))
    return CipherTable(form=form, written=written, letters="".join(sign for _, sign in chosen),
                       digits=tuple((part, 1) for part, _ in chosen))


@dataclass(frozen=True)
class Cipher:
    """A student's cipher as it is printed, its parts by name, its digits by letter."""

    text: str
    parts: Mapping[str, str]
    digits: Mapping[str, str]


class CipherForm:
    """Reads ciphers, and goes through them."""

    def __init__(self, table: CipherTable) -> None:
        self.table = table
        self.letters = table.letters

    @cached_property
    def _words(self) -> dict[str, str]:
        spelling = self.table.spelling
        return {latin(word.upper()): own for own in spelling.values() for word in (own, *spelling)
                if spelling.get(word, own) == own}

    def read(self, text: str) -> Cipher | None:
        """The cipher of a text; None when it is written otherwise."""
        match = compiled(self.table.form).fullmatch(text.strip()) if len(text) <= LONGEST else None
        return None if match is None else self._of(text.strip(), match.groupdict(default=""))

    def _of(self, text: str, found: Mapping[str, str]) -> Cipher:
        parts = {name: self._words.get(latin(part.upper()), part) for name, part in found.items()}
        figures = "".join(parts[name][-n:].ljust(n, self.table.padding) for name, n in self.table.digits)
        written = Template(self.table.written).substitute(parts) if self.table.written else text
        return Cipher(written, parts, dict(zip(self.letters, figures, strict=True)))

    def every(self, example: str) -> Iterator[str]:
        """Ciphers of all digits in the places of the example's; where there are more than :data:`MOST_CIPHERS`, so many of them.

        They are drawn by lot, always the same ones: any even step would leave some digit at one figure.
        """
        like = self.read(example)
        parts = dict.fromkeys(compiled(self.table.form).groupindex, "0") if like is None else like.parts
        counts = {name: max(n for other, n in self.table.digits if other == name) for name, _ in self.table.digits}
        total = sum(counts.values())
        lot = random.Random(0)
        numbers = (range(10**total) if 10**total <= MOST_CIPHERS else
                   sorted(lot.randrange(10**total) for _ in range(MOST_CIPHERS)))
        for number in numbers:
            left = f"{number:0{total}}"
            own = dict(parts)
            for name, n in counts.items():
                own[name], left = left[:n], left[n:]
            text = Template(self.table.written or "".join(f"${{{name}}}" for name in own)).substitute(own)
            if self.read(text) is not None:
                yield text


SOURCE = "_source"
"""What the name of a quantity's source ends with."""
