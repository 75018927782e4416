"""A family of tasks as data: a folder with ``family.toml``, schemes of project files, and tables of variants.

``family.toml`` says how a cipher is written and which machines there are; each has schemes, which are filled in with what the
cipher chooses in its tables and with what follows from that. docs/families.md shows a whole one.
"""

from __future__ import annotations

import itertools
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from functools import cached_property
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Any

from pydantic import Field, ValidationError

from tmm_sheets import spelling
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import family_tables, formulas, headings, toml_file
from tmm_sheets.task.family_tables import Choice, Row
from tmm_sheets.task.filling import filled
from tmm_sheets.task.messages import said
from tmm_sheets.task.misprint import Misprint
from tmm_sheets.task.schema import Table
from tmm_sheets.task.toml_lines import scan
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

FILE = "family.toml"
LARGEST = 1_000_000
"""Bytes of the largest such file, and of a scheme."""
MOST = 1000
"""Most ciphers of a machine that are tried."""


class DerivedTable(Table):
    """What follows from a machine's table."""

    is_: str = Field(alias="is", description=marked('a formula, for example is = "b - a"'))
    unit: str = ""
    digits: int = 6
    """significant digits"""


class MisprintTable(Table):
    """A number of a table that is probably printed wrong."""

    key: str = Field(description=marked("the quantity"))
    column: str = Field(description=marked("the column or the row of the table"))
    suggested: str | int | float = Field(description=marked("the number that is suggested instead"))
    reason: str = Field(description=marked("why"))


class MachineTable(Table):
    """``[machine.NAME]``."""

    title: str = ""
    """what `$title` stands for; the name of the machine unless told"""
    scheme: tuple[str, ...] = Field(min_length=1, description=marked('schemes one after another, for example ["pump.toml"]'))
    tables: tuple[str, ...] = Field(default=(), description=marked('tables of variants, for example ["pump.csv"]'))
    example: str = ""
    """the cipher that `list` shows"""
    derived: dict[str, DerivedTable] = Field(default={})
    misprint: tuple[MisprintTable, ...] = ()


class FamilyTable(Table):
    """A whole ``family.toml``."""

    cipher: str = Field(description=marked('how a cipher is written, for example "ab": small Latin letters are its digits'))
    example: str = Field(description=marked('a cipher, for example "27"'))
    source: str = ""
    machine: dict[str, MachineTable] = Field(min_length=1, description=marked("a table [machine.NAME] for each machine"))


@dataclass(frozen=True)
class Doubt(Misprint):
    """A misprint with the column where it stands."""

    column: str

    def warning(self) -> str:
        """One line about it."""
        text = (
            tell("{symbol}, {column}: {printed} {unit} is probably a misprint of {suggested} {unit} ({reason}); the suggested "
                 "value is used") if self.corrected else
            tell("{symbol}, {column}: {printed} {unit} is probably a misprint of {suggested} {unit} ({reason}); the printed value "
                 "is used, --corrected takes the other one"))
        return text.format(symbol=self.symbol, column=self.column, printed=self.printed, unit=self.unit, suggested=self.suggested,
                           reason=self.reason)


class FolderFamily:
    """The family of a folder, called after it.

    Raises
    ------
    BadInput
        with everything that is wrong in ``family.toml``.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.name = folder, folder.resolve().name
        file = str(folder / FILE)
        try:
            text, _ = toml_file.text_of(folder / FILE, LARGEST)
        except (FileNotFoundError, NotADirectoryError):
            raise BadInput(Problem(tell("no such file"), file,
                                   hint=tell("a family of tasks is a folder with family.toml"))) from None
        try:
            data = tomllib.loads(text)
        except tomllib.TOMLDecodeError as e:
            raise BadInput(toml_file.syntax(str(e), text, file)) from None
        lines = scan(text)
        try:
            self.rules = FamilyTable.model_validate(data)
        except ValidationError as e:
            raise BadInput(toml_file.problem(file, lines, *said(error, FamilyTable)) for error in e.errors()) from None

    # --- what families offer ----------------------------------------------------------------------------------------------

    def names(self) -> tuple[str, ...]:
        """Every machine with a cipher."""
        return tuple(f"{self.name}/{name}@{machine.example or self.rules.example}" for name, machine in self.rules.machine.items())

    def heading(self, name: str) -> dict[str, Any]:
        """Table ``[project]`` of one of these."""
        return tomllib.loads(headings.first(re.split(r"^\[project\]$", self.text(name)[0], maxsplit=1, flags=re.MULTILINE)[1]))

    def read(self, name: str, corrected: bool = False) -> Variant:
        """Project of a machine and a cipher.

        Raises
        ------
        BadInput
            when there is no such machine or cipher, or something is wrong in the folder.
        """
        from tmm_sheets.task import variant

        text, doubts = self.text(name, corrected)
        return variant.parse(text, name, tuple(doubt.warning() for doubt in doubts), doubts)

    # --- cipher -----------------------------------------------------------------------------------------------------------

    @cached_property
    def letters(self) -> str:
        """Letters of the digits that choose: those that the cipher has once."""
        small = re.findall("[a-z]", self.rules.cipher)
        return "".join(letter for letter in small if small.count(letter) == 1)

    def digits(self, cipher: str) -> dict[str, str]:
        """Digits of a cipher by their letters.

        Raises
        ------
        BadInput
            when it is written otherwise.
        """
        pattern = "".join((f"(?P<{sign}>[0-9])" if sign in self.letters else "[0-9]") if "a" <= sign <= "z" else re.escape(sign)
                          for sign in self.rules.cipher)
        match = re.fullmatch(pattern, cipher.strip())
        if match is None:
            raise BadInput(tell('not a cipher: "{text}"').format(text=cipher), hint=tell(
                "it is written {cipher}, small letters are digits: {example}").format(cipher=self.rules.cipher,
                                                                                     example=self.rules.example))
        return match.groupdict()

    def ciphers(self) -> Iterator[str]:
        """Ciphers of all digits, evenly spread where there are more than :data:`MOST`."""
        count = 10 ** len(self.letters)
        every = itertools.product("0123456789", repeat=len(self.letters))
        for figures in itertools.islice(every, 0, None, max(1, count // MOST)):
            own = dict(zip(self.letters, figures, strict=True))
            yield "".join(own.get(sign, "0") if "a" <= sign <= "z" else sign for sign in self.rules.cipher)

    # --- project files ----------------------------------------------------------------------------------------------------

    def text(self, name: str, corrected: bool = False) -> tuple[str, tuple[Doubt, ...]]:
        """The project file of a machine and a cipher, and the misprints in it.

        Raises
        ------
        BadInput
            when there is no such machine or cipher, or something is wrong in the folder.
        """
        called, at, cipher = name.partition("/")[2].partition("@")
        machine = self.rules.machine.get(called)
        if machine is None:
            near = spelling.near(called, self.rules.machine)
            raise BadInput(tell('{family} has no machine "{machine}"').format(family=self.name, machine=called),
                           hint=tell("did you mean {near}?").format(near=f"{self.name}/{near[0]}") if near else
                           tell("known are {known}").format(known=", ".join(self.rules.machine)))
        if not at:
            raise BadInput(tell("{machine} needs a cipher").format(machine=name),
                           hint=tell("write for example {name}").format(name=f"{name}@{machine.example or self.rules.example}"))
        digits = self.digits(cipher)
        rows = {row.key: row for table in machine.tables for row in self._table(table)}
        doubts = tuple(self._doubts(machine, rows, digits, corrected))
        instead = {doubt.symbol: str(doubt.suggested) for doubt in doubts if corrected}
        values = {key: row.chosen(digits, instead.get(key, "")) for key, row in rows.items()}
        if self.rules.source:
            values = {key: Choice(own.text, f"{self.rules.source}, {own.source}") for key, own in values.items()}
        about = {"name": f"{self.name}/{called}@{cipher}", "cipher": cipher, "title": machine.title or called,
                 "digits": "".join(digits.values())}
        values |= {key: Choice(text) for key, text in about.items()}
        values |= self._derived(called, machine, values)
        return "".join(self._filled(scheme, values) for scheme in machine.scheme), doubts

    def _table(self, name: str) -> list[Row]:
        return family_tables.read(self.folder / name, self.letters)

    def _doubts(self, machine: MachineTable, rows: Mapping[str, Row], digits: Mapping[str, str],
                corrected: bool) -> Iterator[Doubt]:
        for m in machine.misprint:
            if m.key not in rows:
                raise BadInput(Problem(tell("no table has it"), str(self.folder / FILE), None, f"misprint: {m.key}"))
            column, own = rows[m.key].cell(digits)
            if column == m.column:
                yield Doubt(m.key, rows[m.key].unit, _decimal(own), _decimal(str(m.suggested)), m.reason, corrected, column)

    def _derived(self, called: str, machine: MachineTable, values: Mapping[str, Choice]) -> dict[str, Choice]:
        """What follows from the tables, each from what stands before it; a number goes into a formula in its own unit."""
        numbers = {key: number for key, own in values.items() if (number := _number(own.text)) is not None}
        found = {}
        for key, rule in machine.derived.items():
            try:
                numbers[key] = formulas.value(rule.is_, numbers)
            except ValueError as e:
                said = tell("{formula} cannot be computed: {why}").format(formula=rule.is_, why=e)
                raise BadInput(Problem(said, str(self.folder / FILE), None, f"machine.{called}.derived.{key}")) from None
            found[key] = Choice(f"{numbers[key]:.{rule.digits}g} {rule.unit}".rstrip(), f"{key} = {rule.is_}")
        return found

    def _filled(self, scheme: str, values: Mapping[str, Choice]) -> str:
        path = self.folder / scheme
        try:
            text, _ = toml_file.text_of(path, LARGEST)
        except FileNotFoundError:
            raise BadInput(Problem(tell("no such file"), str(path))) from None
        try:
            return filled(text, values)
        except ValueError:
            line = next((n for n, one in enumerate(text.splitlines(), 1) if not Template(one).is_valid()), None)
            hint = tell("write {what}").format(what="$$")
            raise BadInput(Problem(tell("a $ before no name"), str(path), line, hint=hint)) from None
        except KeyError as e:
            key = str(e.args[0])
            line = next((n for n, one in enumerate(text.splitlines(), 1) if key in Template(one).get_identifiers()), None)
            near = spelling.near(key, values)
            known = tell("did you mean {near}?").format(near=near[0]) if near else tell("known are {known}").format(
                known=", ".join(values))
            raise BadInput(Problem(tell("nothing is called ${name}").format(name=key), str(path), line, hint=known)) from None


def _number(text: str) -> float | None:
    match = re.match(r"[+-]?[0-9]+(?:[.,][0-9]+)?(?:[eE][+-]?[0-9]+)?(?=\s|$)", text)
    return float(match[0].replace(",", ".")) if match else None


def _decimal(text: str) -> Decimal:
    try:
        return Decimal(text.replace(",", "."))
    except InvalidOperation:
        return Decimal("nan")
