"""A family of tasks as data: a folder with ``family.toml``, schemes of project files, and tables of variants.

``family.toml`` says how a cipher is written and which machines there are; each has schemes, which are filled in with what the
cipher chooses in its tables and with what follows from that. docs/families.md shows a whole one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from decimal import Decimal, InvalidOperation
from functools import cached_property
from pathlib import Path
from string import Template
from typing import Annotated

from pydantic import Field

from tmm_sheets import files, spelling, toml_file
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import family_tables, messages
from tmm_sheets.task.family_tables import SOURCE, Choice, Cipher, CipherForm, CipherTable, Row, filled, of_signs
from tmm_sheets.task.schema import Table
from tmm_sheets.task.values import whole
from tmm_sheets.task.variant import Misprint, Variant, parse
from tmm_sheets.words import marked, tell

FILE = "family.toml"
class DerivedTable(Table):
    """What follows from a machine's table."""

    is_: str = Field(alias="is", description=marked('a formula, for example is = "b - a"'))
    unit: str = ""
    digits: Annotated[int, whole(0, 17)] = 6
    """significant digits; 0: as many as the number has"""
    source: str | None = None
    """where it comes from, with `$b` and `$b_source`; the formula unless told"""


class MisprintTable(Table):
    """A number of a table that is probably printed wrong."""

    key: str = Field(description=marked("the quantity"))
    column: str = Field(description=marked("the column or the row of the table"))
    suggested: str | int | float = Field(description=marked("the number that is suggested instead"))
    reason: str = Field(description=marked("why"))
    certainty: str = ""
    """how sure it is, for the source"""


class MisprintNotes(Table):
    """``[misprints]``: what stands behind the source of such a number, with ``$printed``, ``$suggested`` and ``$certainty``."""

    printed: str = ""
    corrected: str = "; printed $printed, suspected misprint"


class RemarkTable(Table):
    """``[[machine.NAME.remark]]``: what is told of a project where a comparison of its numbers holds."""

    when: str = Field(description=marked('a comparison, for example when = "l_AD + l_BD < l_AB"'))
    say: str = Field(description=marked("what is told"))


class MachineTable(Table):
    """``[machine.NAME]``."""

    title: str = ""
    """what `$title` stands for; the name of the machine unless told"""
    scheme: tuple[str, ...] = Field(min_length=1, description=marked('schemes one after another, for example ["pump.toml"]'))
    tables: tuple[str, ...] = Field(default=(), description=marked('tables of variants, for example ["pump.csv"]'))
    example: str = ""
    """the cipher that `list` shows"""
    parts: dict[str, str] = Field(default={})
    """parts of the ciphers that have this machine; others are told"""
    derived: dict[str, DerivedTable] = Field(default={})
    misprint: tuple[MisprintTable, ...] = ()
    remark: tuple[RemarkTable, ...] = ()
    given: tuple[str, ...] = ()
    """quantities of the table "Given data" of the sheets, in order: they become `[given]` of the project file"""


class FamilyTable(Table):
    """A whole ``family.toml``."""

    cipher: str | CipherTable = Field(
        description=marked('how a cipher is written, for example "ab": small Latin letters are its digits'))
    example: str = Field(description=marked('a cipher, for example "27"'))
    separator: str = "@"
    """what stands before the cipher in the names of projects"""
    shown: tuple[str, ...] = ()
    """ciphers that `list` shows of each machine, instead of one"""
    source: str = ""
    """where numbers come from, with `$file`, `$table`, `$key`, `$symbol`, `$digit`, `$column` and `$machine`; a text without these
    stands before file, quantity, digit and column"""
    misprints: MisprintNotes = MisprintNotes()
    machine: dict[str, MachineTable] = Field(min_length=1, description=marked("a table [machine.NAME] for each machine"))


@dataclass(frozen=True)
class Doubt(Misprint):
    """A misprint with its quantity, the column where it stands, how sure it is."""

    key: str
    column: str
    certainty: str

    def warning(self) -> str:
        """One line about it."""
        text = (
            tell("{symbol}, {column}: {printed} {unit} is probably a misprint of {suggested} {unit} ({reason}); the suggested "
                 "value is used") if self.corrected else
            tell("{symbol}, {column}: {printed} {unit} is probably a misprint of {suggested} {unit} ({reason}); the printed value "
                 "is used, --corrected takes the other one"))
        return text.format(symbol=self.symbol, column=self.column, printed=self.printed, unit=self.unit, suggested=self.suggested,
                           reason=tell(self.reason))


class FolderFamily:
    """The family of a folder, called after it.

    Raises
    ------
    BadInput
        with everything that is wrong in ``family.toml``.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.name = folder, folder.resolve().name
        self.rules, _ = messages.read(FamilyTable, folder / FILE, tell("a family of tasks is a folder with family.toml"))

    # --- what families offer ----------------------------------------------------------------------------------------------

    def every(self, machine: str) -> Iterator[str]:
        """Names of a machine with all ciphers, evenly spread where there are too many."""
        return (self._named(machine, cipher) for cipher in self.form.every(self._example(machine)))

    def _named(self, machine: str, cipher: str) -> str:
        return f"{self.name}/{machine}{self.rules.separator}{cipher}"

    def _example(self, machine: str) -> str:
        return self.rules.machine[machine].example or self.rules.example

    def read(self, name: str, corrected: bool = False) -> Variant:
        """Project of a machine and a cipher.

        Raises
        ------
        BadInput
            when there is no such machine or cipher, or something is wrong in the folder.
        """
        pieces, doubts, remarks = self._filled_in(name, corrected)
        told = (*remarks, *(doubt.warning() for doubt in doubts))
        try:
            return parse("".join(text for _, text in pieces), name, told, doubts)
        except BadInput as e:
            raise BadInput(_of_scheme(problem, pieces) for problem in e.problems) from None

    @cached_property
    def form(self) -> CipherForm:
        """How the ciphers are written."""
        cipher = self.rules.cipher
        return CipherForm(of_signs(cipher) if isinstance(cipher, str) else cipher)

    def _parts(self, name: str) -> tuple[str, Cipher]:
        """The machine and the cipher of a name."""
        called, at, text = name.partition("/")[2].partition(self.rules.separator)
        if called not in self.rules.machine:
            hint = spelling.hint(called, self.rules.machine, written=f"{self.name}/{{}}")
            raise BadInput(tell('{family} has no machine "{machine}"').format(family=self.name, machine=called),
                           hint or tell("known are {known}").format(known=", ".join(self.rules.machine)))
        if not at:
            raise BadInput(tell("{machine} needs a cipher").format(machine=name), hint=tell("write for example {name}").format(
                name=self._named(called, self._example(called))))
        cipher = self.form.read(text)
        if cipher is None:
            known = ", ".join(self.rules.shown)
            raise BadInput(tell('not a cipher: "{text}"').format(text=text), hint=(
                tell("known are {known}").format(known=known) if known else
                tell("write for example {name}").format(name=self._example(called))))
        return called, cipher

    # --- project files ----------------------------------------------------------------------------------------------------

    def _filled_in(self, name: str, corrected: bool) -> tuple[list[tuple[str, str]], tuple[Doubt, ...], tuple[str, ...]]:
        """The project file of a machine and a cipher in pieces, each with the file whose lines it has; misprints and remarks."""
        called, cipher = self._parts(name)
        machine = self.rules.machine[called]
        rows = {row.key: row for table in machine.tables for row in family_tables.read(self._file(table), self.form.letters)}
        doubts = tuple(self._doubts(machine, rows, cipher, corrected))
        doubtful = {doubt.key: doubt for doubt in doubts}
        values = {key: self._choice(called, row, cipher, doubtful.get(key)) for key, row in rows.items()}
        about = {"name": self._named(called, cipher.text), "cipher": cipher.text, "machine": called,
                 "title": machine.title or called, "digits": "".join(cipher.digits.values())}
        values |= {key: Choice(text) for key, text in about.items()}
        values |= self._derived(called, machine, values)
        remarks = tuple(self._remarks(called, machine, cipher, values))
        values |= {f"{key}{SOURCE}": Choice(own.source) for key, own in values.items()}
        schemes = (Template(scheme).safe_substitute({key: own.text for key, own in values.items()}) for scheme in machine.scheme)
        pieces = [*((str(self.folder / scheme), self._filled(scheme, values)) for scheme in schemes),
                  (self._named(called, cipher.text), "".join(self._given(called, machine, values)))]
        return pieces, doubts, remarks

    def _given(self, called: str, machine: MachineTable, values: Mapping[str, Choice]) -> Iterator[str]:
        """``[given]`` as text; what is 0, a dash of the manual, is not given."""
        if unknown := [key for key in machine.given if key not in values]:
            raise BadInput(Problem(tell("no table has it"), str(self.folder / FILE), None, f"machine.{called}.given: {unknown[0]}"))
        if machine.given:
            yield "\n[given]\n"
        for key in machine.given:
            if _number(values[key].text) != 0:
                name = key if re.fullmatch(r"[\w-]+", key, re.ASCII) else f'"{key}"'
                yield f'{name} = "{values[key].text}"{f"  # {values[key].source}" if values[key].source else ""}\n'

    def _choice(self, called: str, row: Row, cipher: Cipher, doubt: Doubt | None) -> Choice:
        column, own = row.cell(cipher.digits)
        prefix = f"{self.rules.source}, " if self.rules.source else ""
        form = self.rules.source if "$" in prefix else f"{prefix}$file: $key, $digit = $column"
        source = row.source(form, column, machine=called)
        if doubt is not None:
            note = self.rules.misprints.corrected if doubt.corrected else self.rules.misprints.printed
            source += Template(note).safe_substitute(printed=doubt.printed, suggested=doubt.suggested, certainty=doubt.certainty)
        return Choice(row.written(str(doubt.suggested) if doubt is not None and doubt.corrected else own), source)

    def _doubts(self, machine: MachineTable, rows: Mapping[str, Row], cipher: Cipher, corrected: bool) -> Iterator[Doubt]:
        for m in machine.misprint:
            if m.key not in rows:
                raise BadInput(Problem(tell("no table has it"), str(self.folder / FILE), None, f"misprint: {m.key}"))
            row = rows[m.key]
            column, own = row.cell(cipher.digits)
            if column == m.column:
                yield Doubt(row.symbol, row.unit, _decimal(own), _decimal(str(m.suggested)), m.reason, corrected, m.key, column,
                            m.certainty)

    def _remarks(self, called: str, machine: MachineTable, cipher: Cipher, values: Mapping[str, Choice]) -> Iterator[str]:
        for part, own in machine.parts.items():
            if (given := cipher.parts.get(part, own)) != own:
                yield tell("{machine} is for ciphers with {own}, not with {given}").format(
                    machine=f"{self.name}/{called}", own=own, given=given)
        numbers = _numbers(values)
        for remark in machine.remark:
            if self._value(remark.when, numbers, f"machine.{called}.remark"):
                yield tell(remark.say)

    def _derived(self, called: str, machine: MachineTable, values: Mapping[str, Choice]) -> dict[str, Choice]:
        """What follows from the tables, each from what stands before it; a number goes into a formula in its own unit."""
        numbers = _numbers(values)
        found: dict[str, Choice] = {}
        for key, rule in machine.derived.items():
            number = numbers[key] = self._value(rule.is_, numbers, f"machine.{called}.derived.{key}")
            names = {f"{name}{end}": text for name, own in (*values.items(), *found.items())
                     for end, text in (("", own.text), (SOURCE, own.source))} if rule.source else {}
            source = f"{key} = {rule.is_}" if rule.source is None else Template(rule.source).safe_substitute(names)
            written = f"{number:.{rule.digits}g}" if rule.digits else repr(number)
            found[key] = Choice(f"{written} {rule.unit}".rstrip(), source)
        return found

    def _value(self, formula: str, numbers: Mapping[str, float], field: str) -> float:
        try:
            return family_tables.formula_value(formula, numbers)
        except ValueError as e:
            why = tell("{formula} cannot be computed: {why}").format(formula=formula, why=e)
            raise BadInput(Problem(why, str(self.folder / FILE), None, field)) from None

    def _file(self, name: str) -> Path:
        return files.named(name, self.folder, self.folder)

    def _filled(self, scheme: str, values: Mapping[str, Choice]) -> str:
        path = self._file(scheme)
        text, _ = toml_file.text_of(path)
        try:
            return filled(text, values)
        except ValueError:
            line = next((n for n, one in enumerate(text.splitlines(), 1) if not Template(one).is_valid()), None)
            hint = tell("write {what}").format(what="$$")
            raise BadInput(Problem(tell("a $ before no name"), str(path), line, hint=hint)) from None
        except KeyError as e:
            key = str(e.args[0])
            line = next((n for n, one in enumerate(text.splitlines(), 1) if key in Template(one).get_identifiers()), None)
            known = spelling.hint(key, values) or tell("known are {known}").format(known=", ".join(values))
            raise BadInput(Problem(tell("nothing is called ${name}").format(name=key), str(path), line, hint=known)) from None


def _of_scheme(problem: Problem, pieces: Iterable[tuple[str, str]]) -> Problem:
    """What is wrong in a project file, told of the scheme whose line it is: each fills one line in."""
    line = problem.line or 0
    for file, piece in pieces:
        lines = piece.count("\n")
        if 0 < line <= lines:
            return replace(problem, file=file, line=line)
        line -= lines
    return problem


def _numbers(values: Mapping[str, Choice]) -> dict[str, float]:
    return {key: number for key, own in values.items() if (number := _number(own.text)) is not None}


def _number(text: str) -> float | None:
    match = re.match(r"[+-]?[0-9]+(?:[.,][0-9]+)?(?:[eE][+-]?[0-9]+)?(?=\s|$)", text)
    return float(match[0].replace(",", ".")) if match else None


def _decimal(text: str) -> Decimal:
    try:
        return Decimal(text.replace(",", "."))
    except InvalidOperation:
        return Decimal("nan")
