"""Phrase templates: the words of a note as data, ``templates/note/<language>/*.txt``; what they may hold is told in docs/note.md.

A template is lines of text with fields in braces, letters between dollar signs and a few commands at the beginning of a line. It
holds no number: numbers come from the record through the fields.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

from tmm_sheets.construction.formula import Fenced, FormulaRow, Fraction, Node, Sign, letters, letters_of
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.meanings import bare as bare
from tmm_sheets.meanings import folder as folder
from tmm_sheets.meanings import meaning_of as meaning_of
from tmm_sheets.meanings import words as words
from tmm_sheets.note.alphabets import characters
from tmm_sheets.note.document import (
    Block,
    Contents,
    Explained,
    Figure,
    Formula,
    Heading,
    Inline,
    NewPage,
    NumberedTable,
    NumberInText,
    Paragraph,
    Reference,
    Symbol,
    Text,
    Where,
)
from tmm_sheets.task import units
from tmm_sheets.words import plural_form, tell


def text_of(language: str, name: str) -> str:
    """A template as it stands in its file."""
    return (folder(language) / f"{name}.txt").read_text(encoding="utf-8")


def names(language: str) -> list[str]:
    """Names of the templates of a language."""
    return sorted(p.stem for p in folder(language).glob("*.txt"))


@dataclass(frozen=True)
class ShownFormula:
    """A formula as a section offers it to its template: what is shown, and the letters that are to be explained."""

    letters: Node
    numbers: Node | None = None
    explained: tuple[tuple[str, str], ...] = ()
    """letters in markup, each with its unit in words."""


@dataclass
class Scope:
    """What a template may name: fields, formulas, tables, figures, lists for %each."""

    fields: dict[str, Any] = field(default_factory=dict)
    formulas: dict[str, ShownFormula | list[ShownFormula]] = field(default_factory=dict)
    tables: dict[str, tuple[tuple[Text, ...], ...]] = field(default_factory=dict)
    figures: dict[str, Figure] = field(default_factory=dict)
    letters: dict[str, str] = field(default_factory=dict)
    """what letters mean here and nowhere else, by the letters without markup"""

    def within(self, fields: Mapping[str, Any]) -> Scope:
        """The same with some fields more."""
        own = {k: v for k, v in fields.items() if not isinstance(v, ShownFormula | Figure)}
        return Scope(
            self.fields | own,
            self.formulas | {k: v for k, v in fields.items() if isinstance(v, ShownFormula)},
            self.tables,
            self.figures | {k: v for k, v in fields.items() if isinstance(v, Figure)},
            self.letters,
        )


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
        self.total: dict[str, int] = {}

    def heading(self, level: int) -> str:
        """Number of the next section of that level."""
        if level == 1:
            self.last += 1
            self.section, self.part = self.last, 0
            return str(self.section)
        self.part += 1
        return f"{self.section}.{self.part}"

    def unnumbered(self) -> str:
        """A heading without a number begins: what stands under all of these is counted through."""
        self.section = 0
        return ""

    def next(self, kind: str, label: str) -> str:
        """Number of the next formula, figure or table of the section."""
        self.counts[self.section, kind] = self.counts.get((self.section, kind), 0) + 1
        self.total[kind] = self.total.get(kind, 0) + 1
        found = self.again(kind)
        self.labels[f"{kind}:{label}"] = found
        return found

    def again(self, kind: str) -> str:
        """Number of the last formula, figure or table."""
        n = self.counts[self.section, kind]
        return f"{self.section}.{n}" if self.section else str(n)

    def cite(self, key: str) -> str:
        """Number of a source."""
        if key not in self.literature:
            raise KeyError(key)
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
        self.pending: set[str] = set()
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
        self.pending = set(re.findall(r"\{@(\w+:[\w-]+)\}", text_of(self.language, name)))
        self._foresee(name, scope)
        lines = list(enumerate(text_of(self.language, name).splitlines(), 1))
        try:
            return [*self._made(lines, scope), *self._paragraph()]
        except _Wrong as e:
            path = str(folder(self.language) / f"{name}.txt")
            raise BadInput(Problem(e.what, path, e.line)) from None

    def _foresee(self, name: str, scope: Scope) -> None:
        """Numbers of what a template refers to before it comes: they are those of a first reading."""
        numbering, known = self.numbering, self.known
        trial = Numbering(numbering.literature)
        trial.section, trial.labels = numbering.section, dict.fromkeys(self.pending, "0") | numbering.labels
        trial.last, trial.part, trial.counts = numbering.last, numbering.part, dict(numbering.counts)
        self.numbering, self.known = trial, set(known)
        try:
            lines = list(enumerate(text_of(self.language, name).splitlines(), 1))
            for _ in self._made(lines, scope):
                pass
        except _Wrong:
            pass  # told by the reading that counts
        finally:
            self.numbering, self.known = numbering, known
            self.running.clear()
        numbering.labels |= {k: v for k, v in trial.labels.items() if v != "0"}

    def _made(self, lines: list[tuple[int, str]], scope: Scope) -> Iterator[Block]:
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
        text = tuple(_tidied(self.running))
        self.running.clear()
        if text:
            yield Paragraph(text)

    def _heading(self, line: str, n: int, scope: Scope) -> Heading:
        level = len(line) - len(line.lstrip("="))
        text = line[level:].strip()
        number = self.numbering.unnumbered() if text.startswith("!") else self.numbering.heading(level)
        return Heading(level, number, "".join(map(str, self.text(text.lstrip("! "), n, scope))))

    def _conditional(
        self, word: str, what: str, inner: list[tuple[int, str]], other: list[tuple[int, str]], scope: Scope
    ) -> Iterator[Block]:
        if word == "if":
            negated = what.startswith("not ")
            name = what.removeprefix("not ").strip()
            yield from self._made(inner if bool(_found(scope, name)) != negated else other, scope)
            return
        made = [block for item in _found(scope, what) or () for block in self._made(inner, scope.within(item))]
        yield from [*made[:-1], *map(_closed, made[-1:])]

    def _command(self, word: str, what: str, n: int, scope: Scope) -> Iterator[Block]:
        name, _, title = (part.strip() for part in what.partition("|"))
        if word == "page":
            yield NewPage()
        elif word == "contents":
            yield Contents(what)
        elif word in ("centre", "right"):
            yield Paragraph(self.text(what, n, scope), "centre" if word == "centre" else "right")
        elif word in ("formula", "formula?"):
            if name not in scope.formulas and word.endswith("?"):
                return
            if name not in scope.formulas:
                raise _Wrong(tell('there is no formula "{name}" here; there are {known}').format(
                    name=name, known=", ".join(scope.formulas) or "–"), n)
            yield from self._formula(label(scope, name), scope.formulas[name], scope.letters)
        elif word == "table":
            if name not in scope.tables:
                raise _Wrong(tell('there is no table "{name}" here; there are {known}').format(
                    name=name, known=", ".join(scope.tables) or "–"), n)
            rows = scope.tables[name]
            if len(rows) > 1:
                yield NumberedTable(self.numbering.next("table", label(scope, name)), "".join(map(str, self.text(title, n, scope))),
                                rows)
        elif word == "figure":
            figure = scope.figures.get(name)
            if figure is not None:
                number = self.numbering.again("figure") if figure.further else self.numbering.next("figure", label(scope, name))
                yield replace(figure, number=number, title="".join(map(str, self.text(title, n, scope))))
        else:
            raise _Wrong(tell('"%{word}" is no command of a template').format(word=word), n)

    def _formula(self, name: str, said: ShownFormula | list[ShownFormula], own: Mapping[str, str]) -> Iterator[Block]:
        for i, one in enumerate(said if isinstance(said, list) else [said]):
            number = self.numbering.next("formula", name if not i else f"{name}-{i}")
            rows = tuple(self._explained(one, own))
            together = one.numbers is not None and characters(one.letters) + characters(one.numbers) < LONGEST
            if one.numbers is not None and together:
                yield Formula((FormulaRow((*items(one.letters), Sign("="), *items(one.numbers))),), f"({number})")
            else:
                yield Formula(broken(one.letters), f"({number})")
            if rows:
                yield Where(words(self.language)["where"], rows)
            if one.numbers is not None and not together:
                yield Formula(broken(FormulaRow((*items(_left(one.letters) or FormulaRow(())), Sign("="), *items(one.numbers)))))

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
        line = _OPTIONAL.sub(lambda m: m[1] if self._all_there(m[1], scope) else "", line)
        for m in _FIELD.finditer(line):
            before = line[at : m.start()]
            if (m[1] or "").startswith("@"):
                before = re.sub(" $", "\u00a0", before)  # a number stays with its word
            found.append(before)
            at = m.end()
            found += [Symbol(letters(m[2]))] if m[2] is not None else self._field(m[1], n, scope)
        found.append(line[at:])
        return tuple(x for x in found if x != "")

    def _all_there(self, text: str, scope: Scope) -> bool:
        """Whether everything that some words refer to is in the note, and every field they name."""
        for name in _NAMED.findall(text):
            if name.startswith("@") and not name.startswith("@cite:"):
                kind, _, own = name[1:].partition(":")
                if f"{kind}:{label(scope, own)}" not in self.numbering.labels and name[1:] not in self.numbering.labels:
                    return False
            elif not name.startswith(("@", "#")) and _found(scope, name) is None:
                return False
        return True

    def _field(self, name: str, n: int, scope: Scope) -> list[Inline]:
        if name.startswith("@"):
            return [self._reference(name[1:], n, scope)]
        if name.startswith("#"):
            key, _, forms = name[1:].partition(" ")
            return [plural_form(forms.split("|"), int(_count(_found(scope, key))), self.language)]
        value = _found(scope, name)
        if value is None:
            raise _Wrong(tell('there is no field "{name}" here; there are {known}').format(
                    name=name, known=", ".join(sorted(scope.fields))), n)
        if isinstance(value, str | NumberInText | Symbol):
            return [value]
        if isinstance(value, int):
            return [str(value)]
        if isinstance(value, Node):
            return [Symbol(value)]
        return list(value)

    def _reference(self, to: str, n: int, scope: Scope) -> Reference:
        kind, _, name = to.partition(":")
        if kind == "cite":
            key, _, place = name.partition(" ")
            try:
                return Reference(f"[{self.numbering.cite(key)}{', ' + place if place else ''}]")
            except KeyError:
                raise _Wrong(tell('there is no source "{key}" in literature.toml').format(key=key), n) from None
        labels = self.numbering.labels
        found = labels.get(f"{kind}:{label(scope, name)}", labels.get(to))
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


def items(node: Node) -> tuple[Node, ...]:
    """Parts of a row, or the node alone."""
    return node.items if isinstance(node, FormulaRow) else (node,)


def label(scope: Scope, name: str) -> str:
    """Label of a figure, table or formula: in a list that of its item, where the items are counted."""
    return f"{name}-{scope.fields['nth']}" if "nth" in scope.fields else name


def _left(node: Node) -> Node | None:
    """What stands before the first sign of equality."""
    if isinstance(node, FormulaRow):
        for i, x in enumerate(node.items):
            if x == Sign("="):
                return FormulaRow(node.items[:i])
    return None


def _count(value: Any) -> float:
    return value.value if isinstance(value, NumberInText) else len(value) if isinstance(value, list | tuple) else float(str(value))


@cache
def unit(name: str, language: str) -> str:
    """A unit of the record or of a project file in words; one that the language has no word for as it stands."""
    return "" if name == "1" else _units(language).get(units.common(name), name)


@cache
def _units(language: str) -> dict[str, str]:
    """Words for units by their common spelling."""
    return {units.common(name): said for name, said in words(language)["units"].items()}


def _tidied(text: Iterable[Inline]) -> Iterator[Inline]:
    """The same with one space between words and none at the ends."""
    joined: list[Inline] = []
    for x in text:
        if isinstance(x, str) and joined and isinstance(joined[-1], str):
            joined[-1] += x
        else:
            joined.append(x)
    for i, x in enumerate(joined):
        if isinstance(x, str):
            x = re.sub(" +", " ", x)
            x = x.lstrip(" ") if not i else x
            x = x.rstrip(" ") if i == len(joined) - 1 else x
        if x != "":
            yield x


def _closed(block: Block) -> Block:
    """The last item of a list ends with a full stop."""
    if isinstance(block, Paragraph) and block.look == "item" and isinstance(block.text[-1], str) and block.text[-1].endswith(";"):
        return Paragraph((*block.text[:-1], block.text[-1][:-1] + "."), "item")
    return block


class _Wrong(Exception):
    def __init__(self, what: str, line: int) -> None:
        super().__init__(what)
        self.what, self.line = what, line


def _found(scope: Scope, name: str) -> Any:
    value: Any = scope.fields
    for part in name.split("."):
        value = value.get(part) if isinstance(value, Mapping) else getattr(value, part, None)
        if value is None:
            break
    if value is None:
        return name in scope.formulas or name in scope.figures or len(scope.tables.get(name, ())) > 1 or None
    return value


def _split(lines: list[tuple[int, str]], i: int, n: int) -> tuple[list[tuple[int, str]], list[tuple[int, str]], int]:
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


def plain_text(text: Iterable[Inline]) -> str:
    """Text without its marks."""
    return "".join(str(x) if not isinstance(x, Symbol) else "" for x in text)


def listed(items: Sequence[str], last: str) -> str:
    """A list in words."""
    return last.join(filter(None, (", ".join(items[:-1]), *items[-1:])))
