"""Phrase templates: the words of a note as data, ``templates/note/<language>/*.txt``; what they may hold is told in docs/note.md.

A template is lines of text with fields in braces, letters between dollar signs and a few commands at the beginning of a line. It
holds no number: numbers come from the record through the fields. A field, formula or figure is one that the section has worked out,
or is found in the record by its path.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

from tmm_sheets.construction.formula import (
    Fenced,
    FormulaRow,
    Fraction,
    Node,
    Sign,
    items,
    letters,
    letters_of,
    row,
)
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.meanings import bare, folder, meaning_of, words
from tmm_sheets.note.alphabets import characters
from tmm_sheets.note.document import (
    Block,
    Contents,
    Explained,
    Formula,
    Heading,
    Inline,
    NewPage,
    NumberedTable,
    NumberInText,
    Paragraph,
    Reference,
    ShownFormula,
    Symbol,
    Text,
    Where,
)
from tmm_sheets.note.reader import Reader
from tmm_sheets.words import plural_form, tell

Lines = list[tuple[int, str]]
"""Lines of a template with their numbers."""


def text_of(language: str, name: str) -> str:
    """A template as it stands in its file."""
    return (folder(language) / f"{name}.txt").read_text(encoding="utf-8")


def names(language: str) -> list[str]:
    """Names of the templates of a language."""
    return sorted(p.stem for p in folder(language).glob("*.txt"))


@dataclass(frozen=True)
class Scope:
    """What a template may name: ``fields`` of its section, where ``letters`` says what letters mean only there, and the record."""

    fields: Mapping[str, Any]
    reader: Reader | None = None

    def within(self, fields: Mapping[str, Any]) -> Scope:
        """The scope with some fields more, among them meanings of letters."""
        letters = {**self.fields.get("letters", {}), **fields.get("letters", {})}
        return Scope({**self.fields, **fields, "letters": letters}, self.reader)

    def own(self, name: str) -> Any:
        """A field of the section, with dots one of another section; None for none."""
        value: Any = self.fields
        for part in name.split("."):
            value = value.get(part) if isinstance(value, Mapping) else None
        return value

    def found(self, name: str, kind: str = "number") -> Any:
        """A field of the section, or what the record has under that path: number or formula of a step, figures of a view."""
        value = self.own(name)
        if value is not None or self.reader is None:
            return value
        if kind == "formula":
            return self.reader.formula_of(name)
        return self.reader.pictures.figures(name) if kind == "figure" else self.reader.number_of(name)

    def label(self, name: str) -> str:
        """Label of a figure, table or formula: in a list that of its item, where the items are counted."""
        return f"{name}-{self.fields['nth']}" if "nth" in self.fields else name

    def known(self) -> str:
        """Names of the fields, for a message."""
        return ", ".join(sorted(self.fields)) or "–"


class Numbering:
    """Numbers of sections, formulas, figures and tables, and of the sources in order of citation."""

    def __init__(self, literature: Mapping[str, str]) -> None:
        self.section = 0
        self.part = 0
        self.last = 0
        """number of the last section that has one"""
        self.counts: dict[tuple[int, str], int] = {}
        self.labels: dict[str, str] = {}
        self.literature = literature
        self.cited: list[str] = []

    def heading(self, level: int) -> str:
        """Number of the next section of that level."""
        if level == 1:
            self.last += 1
            self.section, self.part = self.last, 0
            return str(self.section)
        self.part += 1
        return f"{self.section}.{self.part}"

    def next(self, kind: str, label: str) -> str:
        """Number of the next formula, figure or table of the section."""
        n = self.counts[self.section, kind] = self.counts.get((self.section, kind), 0) + 1
        found = self.labels[f"{kind}:{label}"] = f"{self.section}.{n}" if self.section else str(n)
        return found

    def cite(self, key: str) -> str:
        """Number of a source; KeyError for one that the literature does not have."""
        _ = self.literature[key]
        if key not in self.cited:
            self.cited.append(key)
        return str(self.cited.index(key) + 1)


_FIELD = re.compile(r"\{([^{}]*)\}|\$([^$]*)\$")
_OPTIONAL = re.compile(r"\[\[(.*?)\]\]")
_NAMED = re.compile(r"\{([^{}]*)\}")
_COMMAND = re.compile(r"%(\w+\??)\s*(.*)")


class Writer:
    """Turns templates into blocks, one after another, so that numbers run on and no letter is explained twice."""

    def __init__(self, language: str, numbering: Numbering) -> None:
        self.language = language
        self.numbering = numbering
        self.known: set[tuple[str, str, str]] = set()
        self.template = ""
        self.running: list[Inline] = []
        """the paragraph that is being written: it ends with an empty line or with what is no text"""

    def blocks(self, name: str, scope: Scope) -> list[Block]:
        """The blocks of a template.

        Raises
        ------
        BadInput
            with file and line of what the template asks for and the section does not have.
        """
        self.template = name
        text = text_of(self.language, name)
        lines = list(enumerate(text.splitlines(), 1))
        self._number_ahead(lines, scope, {to for to in _NAMED.findall(text) if to.startswith("@") and not to.startswith("@cite:")})
        try:
            return [*self._made(lines, scope), *self._paragraph()]
        except _Wrong as e:
            path = str(folder(self.language) / f"{name}.txt")
            raise BadInput(Problem(e.what, path, e.line)) from None

    def _number_ahead(self, lines: Lines, scope: Scope, asked: set[str]) -> None:
        """Numbers of what a template refers to before it comes: they are those of a first reading."""
        numbering, known = self.numbering, self.known
        self.numbering, self.known = deepcopy(numbering), set(known)
        self.numbering.labels = {to[1:]: "" for to in asked} | numbering.labels
        with suppress(_Wrong):  # told by the reading that counts
            list(self._made(lines, scope))
        foreseen = {k: v for k, v in self.numbering.labels.items() if v}
        self.numbering, self.known = numbering, known
        self.running.clear()
        numbering.labels |= foreseen

    def _made(self, lines: Lines, scope: Scope) -> Iterator[Block]:
        i = 0
        while i < len(lines):
            n, line = lines[i]
            i += 1
            if line.startswith("#"):
                continue
            command = _COMMAND.fullmatch(line)
            if command and command[1] in ("if", "each"):
                inner, other, i = _split(lines, i, n)
                yield from self._conditional(command[1], command[2], inner, other, scope)
            elif command or line.startswith(("=", "- ")) or not line.strip():
                yield from self._paragraph()
                if command:
                    yield from self._command(command[1], command[2], n, scope)
                elif line.startswith("="):
                    yield self._heading(line, n, scope)
                elif line.strip():
                    yield Paragraph(self.text("– " + line[2:], n, scope), "item")
            else:
                self.running += [*self.text(line.strip(), n, scope), " "]

    def _paragraph(self) -> Iterator[Block]:
        """The paragraph that the lines so far make."""
        text = _tidied(self.running)
        self.running.clear()
        if text:
            yield Paragraph(text)

    def _heading(self, line: str, n: int, scope: Scope) -> Heading:
        level = len(line) - len(line.lstrip("="))
        text = line[level:].strip()
        if text.startswith("!"):  # what stands under all that have no number is counted through
            self.numbering.section = 0
        number = "" if text.startswith("!") else self.numbering.heading(level)
        return Heading(level, number, self._plain(text.lstrip("! "), n, scope))

    def _conditional(self, word: str, what: str, inner: Lines, other: Lines, scope: Scope) -> Iterator[Block]:
        if word == "if":
            name = what.removeprefix("not ").strip()
            there = any(scope.found(name, kind) for kind in ("number", "figure"))
            yield from self._made(inner if there != what.startswith("not ") else other, scope)
            return
        made = [block for item in scope.own(what) or () for block in self._made(inner, scope.within(item))]
        yield from [*made[:-1], *map(_closed, made[-1:])]

    def _command(self, word: str, what: str, n: int, scope: Scope) -> Iterator[Block]:
        commands: dict[str, Callable[[], Iterable[Block]]] = {
            "page": lambda: [NewPage()],
            "contents": lambda: [Contents(what)],
            "centre": lambda: [Paragraph(self.text(what, n, scope), "centre")],
            "right": lambda: [Paragraph(self.text(what, n, scope), "right")],
            "formula": lambda: self._formula(what, n, scope),
            "formula?": lambda: self._formula(what, 0, scope),
            "formulas": lambda: self._formulas(what, scope),
            "table": lambda: self._table(what, n, scope),
            "figure": lambda: self._figures(what, n, scope),
        }
        if word not in commands:
            raise _Wrong(tell('"%{word}" is no command of a template').format(word=word), n)
        yield from commands[word]()

    def _table(self, what: str, n: int, scope: Scope) -> Iterator[Block]:
        name, title = map(str.strip, what.split("|"))
        rows = scope.own(name)
        if rows is None:
            raise _Wrong(tell('there is no table "{name}" here; there are {known}').format(name=name, known=scope.known()), n)
        if len(rows) > 1:
            yield NumberedTable(self.numbering.next("table", scope.label(name)), self._plain(title, n, scope), rows)

    def _figures(self, what: str, n: int, scope: Scope) -> Iterator[Block]:
        name, title = map(str.strip, what.split("|"))
        parts = scope.found(name, "figure") or ()
        number = self.numbering.next("figure", scope.label(name)) if parts else ""
        yield from (replace(part, number=number, title=self._plain(title, n, scope)) for part in parts)

    def _formulas(self, plan: str, scope: Scope) -> Iterator[Block]:
        for said in scope.reader.formulas(plan) if scope.reader is not None else ():
            yield from self._shown(plan, said, scope)

    def _formula(self, name: str, n: int, scope: Scope) -> Iterator[Block]:
        """A formula; one that must be there has the number ``n`` of its line."""
        said = scope.found(name, "formula")
        if said is not None:
            yield from self._shown(scope.label(name), said, scope)
        elif n:
            raise _Wrong(tell('there is no formula "{name}" here; there are {known}').format(name=name, known=scope.known()), n)

    def _shown(self, name: str, said: ShownFormula, scope: Scope) -> Iterator[Block]:
        number = self.numbering.next("formula", name)
        rows = tuple(self._explained(said, scope.fields.get("letters", {})))
        together = said.numbers is not None and characters(said.letters) + characters(said.numbers) < LONGEST
        if said.numbers is not None and together:
            yield Formula((row(said.letters, Sign("="), said.numbers),), f"({number})")
        else:
            yield Formula(broken(said.letters), f"({number})")
        if rows:
            yield Where(words(self.language)["where"], rows)
        if said.numbers is not None and not together:
            left = items(said.letters)
            yield Formula(broken(row(*left[:left.index(Sign("="))], Sign("="), said.numbers)))

    def _explained(self, said: ShownFormula, own: Mapping[str, str]) -> Iterator[Explained]:
        for markup, unit in said.explained:
            meaning = own.get(bare(markup)) or meaning_of(markup, self.language, self.template)
            # Its index may have two spellings; an arm on a plan is not that of the mechanism.
            once = ("" if meaning.endswith(_OF_INDEX) else bare(markup)[:1], meaning, unit)
            if meaning and once not in self.known:
                self.known.add(once)
                yield Explained(letters(markup), tuple(set_text(meaning.removesuffix(_OF_INDEX).rstrip())), unit)

    def text(self, line: str, n: int, scope: Scope) -> Text:
        """A line with its fields filled in."""
        found: list[Inline] = []
        at = 0
        line = _OPTIONAL.sub(lambda m: m[1] if self._is_complete(m[1], scope) else "", line)
        for m in _FIELD.finditer(line):
            before = line[at : m.start()]
            if (m[1] or "").startswith("@"):
                before = re.sub(" $", "\u00a0", before)  # a number stays with its word
            found.append(before)
            at = m.end()
            found += [Symbol(letters(m[2]))] if m[2] is not None else self._field(m[1], n, scope)
        found.append(line[at:])
        return tuple(x for x in found if x != "")

    def _plain(self, line: str, n: int, scope: Scope) -> str:
        return "".join(map(str, self.text(line, n, scope)))

    def _is_complete(self, text: str, scope: Scope) -> bool:
        """Whether everything that some words refer to is in the note, and every field they name."""
        return all(scope.found(name) is not None if not name.startswith(("@", "#")) else
                   name.startswith(("#", "@cite:")) or self._label(name[1:], scope) is not None
                   for name in _NAMED.findall(text))

    def _label(self, to: str, scope: Scope) -> str | None:
        """Number of what a reference leads to, in a list that of its item; None for what is not in the note."""
        kind, _, name = to.partition(":")
        return self.numbering.labels.get(f"{kind}:{scope.label(name)}", self.numbering.labels.get(to))

    def _field(self, name: str, n: int, scope: Scope) -> Text:
        if name.startswith("@"):
            return (self._reference(name[1:], n, scope),)
        if name.startswith("#"):
            key, _, forms = name[1:].partition(" ")
            return (plural_form(forms.split("|"), int(_count(scope.found(key))), self.language),)
        value = scope.found(name)
        if value is None:
            raise _Wrong(tell('there is no field "{name}" here; there are {known}').format(name=name, known=scope.known()), n)
        return (str(value),) if isinstance(value, int) else value if isinstance(value, tuple) else (value,)

    def _reference(self, to: str, n: int, scope: Scope) -> Reference:
        kind, _, name = to.partition(":")
        if kind == "cite":
            key, _, place = name.partition(" ")
            try:
                return Reference(f"[{self.numbering.cite(key)}{', ' + place if place else ''}]")
            except KeyError:
                raise _Wrong(tell('there is no source "{key}" in literature.toml').format(key=key), n) from None
        found = self._label(to, scope)
        if found is None:
            raise _Wrong(tell('nothing has the label "{to}"').format(to=to), n)
        return Reference(f"({found})" if kind == "formula" else found, f"{kind}:{found}")


def set_text(meaning: str) -> Iterator[Inline]:
    """A meaning with the points in it, between dollar signs, set as letters."""
    for i, part in enumerate(meaning.split("$")):
        if part:
            yield Symbol(letters(letters_of(part))) if i % 2 else part


_OF_INDEX = "…"
"""How a meaning ends that holds for every letter of its kind: it is told once."""
LONGEST = 58
"""Width of letters and numbers of a formula, in characters, up to which they stand on one line."""
WIDEST = 72
"""Width of a line, in characters, beyond which a sum goes on in the next."""


def broken(node: Node) -> tuple[Node, ...]:
    """A formula in lines: a long sum is broken at its signs, which are repeated; a long numerator becomes a bracket."""
    if characters(node) <= WIDEST:
        return (node,)
    flat: list[Node] = []
    for x in items(node):
        if isinstance(x, Fraction) and characters(x.over) > WIDEST // 2:
            under = x.under if not isinstance(x.under, FormulaRow) or len(x.under.items) == 1 else Fenced("(", x.under, ")")
            flat += [Sign("("), *items(x.over), Sign(")"), Sign("/"), *items(under)]
        else:
            flat.append(x)
    lines: list[list[Node]] = [[]]
    for i, x in enumerate(flat):
        rest = next((j for j in range(i + 1, len(flat)) if flat[j] in _BREAKS), len(flat))
        if x in _BREAKS and lines[-1] and characters(FormulaRow((*lines[-1], *flat[i:rest]))) > WIDEST:
            lines[-1].append(x)
            lines.append([])
        lines[-1].append(x)
    return tuple(FormulaRow(tuple(line)) for line in lines)


_BREAKS = (Sign("+"), Sign("−"), Sign("="))


def _count(value: Any) -> float:
    return value.value if isinstance(value, NumberInText) else len(value) if isinstance(value, list | tuple) else float(str(value))


def _tidied(text: Iterable[Inline]) -> Text:
    """A text with one space between words and none at the ends."""
    found: list[Inline] = []
    for is_words, run in groupby(text, lambda x: isinstance(x, str)):
        parts = list(run)
        found += [re.sub(" +", " ", "".join(map(str, parts)))] if is_words else parts
    if found and isinstance(found[0], str):
        found[0] = found[0].lstrip(" ")
    if found and isinstance(found[-1], str):
        found[-1] = found[-1].rstrip(" ")
    return tuple(x for x in found if x != "")


def _closed(block: Block) -> Block:
    """The last item of a list ends with a full stop."""
    if isinstance(block, Paragraph) and block.look == "item" and isinstance(block.text[-1], str) and block.text[-1].endswith(";"):
        return Paragraph((*block.text[:-1], block.text[-1][:-1] + "."), "item")
    return block


class _Wrong(Exception):
    def __init__(self, what: str, line: int) -> None:
        super().__init__(what)
        self.what, self.line = what, line


def _split(lines: Lines, i: int, n: int) -> tuple[Lines, Lines, int]:
    """What is inside a command up to its %end, what after its %else, and where it goes on."""
    depth, other = 0, -1
    for j in range(i, len(lines)):
        word = m[1] if (m := _COMMAND.fullmatch(lines[j][1])) else ""
        if word in ("if", "each"):
            depth += 1
        elif word == "end" and depth:
            depth -= 1
        elif word == "else" and not depth:
            other = j
        elif word == "end":
            end = other if other >= 0 else j
            return lines[i:end], lines[end + 1 : j] if other >= 0 else [], j + 1
    raise _Wrong(tell("this command has no %end"), n)
