"""What the sections of a note read: the steps of a project as numbers, formulas and sentences of the note."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from math import copysign, degrees, floor, isfinite, log10, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import digits, expression, protocol
from tmm_sheets.construction.digits import DIGITS, Digits, shown
from tmm_sheets.construction.formula import (
    Figures,
    FormulaRow,
    Node,
    Operand,
    Scripts,
    Sign,
    Words,
    arguments,
    can_be_written,
    letters,
    letters_of,
    of_tree,
    renumbered,
    simplified,
    with_numbers,
)
from tmm_sheets.construction.given import FoundNumber, Given, GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.errors import CannotBuild
from tmm_sheets.note import phrases
from tmm_sheets.note.document import Inline, NumberInText, Symbol, Text
from tmm_sheets.note.phrases import ShownFormula
from tmm_sheets.numbers import degrees_and_minutes, fixed, is_zero, number
from tmm_sheets.record.recording import book_of, unit
from tmm_sheets.task import units
from tmm_sheets.words import is_latin

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.note.pictures import Pictures
    from tmm_sheets.project import Project
    from tmm_sheets.record.step_index import StepIndex

FINEST = 6
"""Digits that the greatest of a kind would have with the decimals of the least of them."""


class Differs(CannotBuild):
    """A formula as people write it does not give what the record has: the note does not print it."""


@dataclass(frozen=True)
class NoteQuantity:
    """A letter with its number: what an operand of a formula is, ``unit`` as the record writes it."""

    symbol: str
    value: float
    unit: str = ""
    step: str = ""
    position: str = ""
    digits: int = DIGITS


@dataclass
class Reader:
    """A project, its record and its sheets, and how a note says them."""

    project: Project
    language: str
    pictures: Pictures
    scales: Mapping[str, Scale]
    problems: list[str] = field(default_factory=list)
    _book: Any = None

    @property
    def book(self) -> StepIndex:
        """Steps and plans as recorded so far."""
        if self._book is None:
            self._book = book_of(self.project)
        return self._book  # type: ignore[no-any-return]

    def forget(self) -> None:
        """Read the record anew: more has been computed since."""
        self._book = None

    def plan(self, name: str) -> Plan | None:
        """A plan of the project, None for one that was not made."""
        for of_part in self.project.plans.values():
            if of_part and name in of_part:
                return of_part[name]
        return None

    @property
    def k(self) -> int:
        """Number of the position that is told in words: that of the force analysis."""
        if self.project.variant.crank is None or self.project.variant.cycle is None:
            return 0
        if "forces" in self.project.parts or (self.project.variant.cycle is not None and self.project.variant.cycle.force_position):
            return self.project.force_index
        return min(2, len(self.project.cycle.labels) - 1)

    @property
    def label(self) -> str:
        """Label of that position; empty where nothing moves in numbered positions."""
        if self.project.variant.crank is None or self.project.variant.cycle is None:
            return ""
        return str(self.project.cycle.labels[self.k])

    def letters_of(self, step: Step) -> str:
        """Letters of a step in the note: those of ``[symbols]`` in words.toml, or its own."""
        return str(phrases.words(self.language).get("symbols", {}).get(step.name) or symbol_of(step))

    # --- numbers

    def unit(self, name: str) -> str:
        """A unit in words."""
        return phrases.unit(name, self.language)

    def number(
        self, value: float, unit: str = "", step: str = "", position: str = "", digits: int = DIGITS, kind: float = 0.0
    ) -> NumberInText:
        """A number as it is written; large and small ones as a product with a power of ten in words of the paper.

        Beside ``kind``, the size of its kind, it has no more decimals than a drawing could show of that: a table has no 5·10⁻⁶ in a
        column of fives.
        """
        value = float(np.real(value))
        if is_zero(value, kind):
            value = 0.0
        if kind and value and isfinite(value) and isfinite(kind):
            digits = min(digits, floor(log10(abs(value))) - floor(log10(kind)) + FINEST)
            value = value if digits > 0 else 0.0
        return NumberInText(shown(value, digits), step, value, position, digits, self.unit(unit))

    def of(
        self,
        step: Step,
        k: int | None = None,
        unit_: str | None = None,
        digits: int = DIGITS,
        kind: float = 0.0,
    ) -> NumberInText:
        """Value of a step at a position; of a vector its magnitude."""
        at = self.at(step, k)
        value = value_at(step, at)
        if isinstance(value, complex | np.complexfloating):
            value = abs(value)
        return self.number(
            float(value), self.unit_of(step) if unit_ is None else unit_, self.id(step), self.position(step, at), digits, kind
        )

    def fixed(self, value: float, unit: str, decimals: int, step: str = "", position: str = "") -> NumberInText:
        """A number with a fixed number of decimals: millimetres of a drawing, degrees."""
        value = float(value)
        return NumberInText(fixed(value, decimals), step, value, position, decimals, self.unit(unit))

    def angle(self, value: float, step: str = "", position: str = "") -> NumberInText:
        """An angle in degrees and minutes."""
        return NumberInText(degrees_and_minutes(float(value)), step, float(value), position)

    def at(self, step: Step, k: int | None) -> int:
        """Number of a position in the plan of a step: by its label when the plan has others."""
        k = self.k if k is None and self.project.variant.crank is not None else k or 0
        value = step.value
        if np.ndim(value) == 0:
            return 0
        plan = self.book.plans.get(self.book.plan(step)) if step in self.book else None
        if plan is not None and self.project.variant.crank is not None:
            label = self.project.cycle.labels[k] if k < len(self.project.cycle.labels) else ""
            if label in plan.labels:
                return plan.labels.index(label)
        return min(k, len(value) - 1)

    def position(self, step: Step, k: int) -> str:
        """Label of a position of the plan of a step."""
        if step not in self.book or np.ndim(step.value) == 0:
            return ""
        labels = self.book.plans[self.book.plan(step)].labels
        return labels[k] if k < len(labels) else ""

    def id(self, step: Step) -> str:
        """Id of a step: plan/name."""
        return self.book.id(step) if step in self.book else step.path

    def origin(self, value: Any, place: str) -> str:
        """Where a number comes from that the project file gives in that ``place``, or has found by synthesis: id of its step."""
        return self.id(value.step) if isinstance(value, FoundNumber) else place

    def unit_of(self, step: Step) -> str:
        """Unit of a step, as the record writes it."""
        plan = self.book.plans.get(self.book.plan(step)) if step in self.book else None
        return unit(step, plan) if plan is not None else step.rule.unit

    def quantity(self, step: Step, k: int | None = None, symbol: str = "", unit_: str | None = None) -> NoteQuantity:
        """A step as an operand."""
        n = self.of(step, k, unit_)
        return NoteQuantity(symbol or symbol_of(step), n.value, self.unit_of(step) if unit_ is None else unit_, n.step, n.position)

    def givens(self, unit: str = "") -> list[NoteQuantity]:
        """Given numbers that some step takes, each once, those of a unit or all."""
        found: dict[str, NoteQuantity] = {}
        for step in self.book.steps.values():
            for a in step.args:
                if isinstance(a, GivenNumber) and a.symbol and (not unit or a.unit == unit):
                    found.setdefault(a.symbol, NoteQuantity(a.symbol, float(a), a.unit, a.name))
        return list(found.values())

    def length(self, a: str, b: str) -> str:
        """Letters of the length between two points, as it is given or as they follow each other."""
        known = {q.symbol for q in self.givens("m")}
        return next((s for s in (f"l_{{{a}{b}}}", f"l_{{{b}{a}}}") if s in known), f"l_{{{a}{b}}}")

    # --- formulas

    def formula(
        self,
        step: Step,
        k: int | None = None,
        symbol: str = "",
        as_unit: str | None = None,
    ) -> ShownFormula | None:
        """The formula of a step by its own expression; None when it has none that can be written."""
        tree = step.rule.formula(len(step.args))
        if tree is None or isinstance(tree, expression.Argument) or not can_be_written(tree):
            return None
        quantities = []
        for a in step.args:
            q = self._operand(a, k)
            if q is None:
                return None
            quantities.append(q)
        plain = {
            i: float(a)
            for i, a in enumerate(step.args)
            if isinstance(a, int | float) and not isinstance(a, GivenNumber | FoundNumber)
        }
        firsts = [next(j for j, b in enumerate(step.args) if b is a) for a in step.args]
        tree = simplified(with_numbers(renumbered(tree, firsts), plain))
        head = symbol or self.letters_of(step)
        if isinstance(tree, expression.Argument | expression.Constant) or not all(
            _presentable(s) for s in (head, *(quantities[i].symbol for i in arguments(tree)))
        ):
            return None
        if _converts(tree) or head in [quantities[i].symbol for i in arguments(tree)]:
            return None  # the same quantity in another unit
        value = value_at(step, self.at(step, k))
        if np.ndim(value) or np.iscomplexobj(value) or not isinstance(value, int | float | np.number | np.ndarray):
            return None
        result = self.of(step, k)
        unit_ = self.unit_of(step) if as_unit is None else as_unit
        return self.written(head, tree, quantities, NoteQuantity("", result.value, unit_, result.step, result.position))

    def _operand(self, a: Any, k: int | None) -> NoteQuantity | None:
        if isinstance(a, Step):
            value = value_at(a, self.at(a, k))
            if np.ndim(value) or np.iscomplexobj(value) or not isinstance(value, int | float | np.number | np.ndarray):
                return None
            return NoteQuantity(self.letters_of(a), float(value), self.unit_of(a), self.id(a), self.position(a, self.at(a, k)))
        if isinstance(a, Given):
            value = a.value if np.ndim(a.value) == 0 else a.value[min(self.k if k is None else k, len(a.value) - 1)]
            if isinstance(value, str) or not isinstance(value, int | float | np.number):
                return None
            return NoteQuantity(self._given(a), float(value), a.unit, a.name)
        if isinstance(a, GivenNumber):
            return NoteQuantity(self._given(a), float(a), a.unit, a.name)
        if isinstance(a, int | float | np.number):
            return NoteQuantity(number(float(a), 6), float(a))
        return None

    def _given(self, a: Given | GivenNumber) -> str:
        return str(phrases.words(self.language).get("symbols", {}).get(a.name) or a.symbol or a.name)

    def written(self, symbol: str, tree: expression.Expression, quantities: Sequence[NoteQuantity],
                result: NoteQuantity | None) -> ShownFormula:
        """A formula from its expression and the quantities in the places of its arguments; without ``result`` letters only."""
        in_letters = [Operand(letters(q.symbol), None, bool(_SUM.search(q.symbol))) for q in quantities]
        head = letters(symbol)
        used = list(dict.fromkeys(arguments(simplified(tree))))
        explained = [(_of_magnitude(symbol), self.unit(result.unit) if result is not None else "")]
        explained += [
            (_of_magnitude(quantities[i].symbol), self.unit(quantities[i].unit))
            for i in used
            if not _plain(quantities[i].symbol) and not _TERM.search(quantities[i].symbol)
        ]
        formula = FormulaRow((head, Sign("="), *_items(of_tree(tree, in_letters))))
        if result is None:
            return ShownFormula(formula, None, tuple(explained))
        rounded, of_result = digits.chosen(
            tree,
            [q.value for q in quantities],
            [q.unit == "rad" for q in quantities],
            [q.digits for q in quantities],
            result.value,
            result.digits,
            result.unit == "rad",
        )
        in_numbers = [self._figures(q, of) for q, of in zip(quantities, rounded, strict=True)]
        gives = self.result(replace(result, digits=of_result))
        worked_out = () if isinstance(tree, expression.Argument) else (*_items(of_tree(tree, in_numbers)), Sign("="))
        return ShownFormula(formula, FormulaRow((*worked_out, *gives)), tuple(explained))

    def _figures(self, q: NoteQuantity, of: Digits) -> Operand:
        source = NumberInText(shown(q.value, of.number), q.step, q.value, q.position, of.number)
        node = figures(source) if q.step else Figures(source.text)
        as_angle = None
        if q.unit == "rad":
            text = degrees_and_minutes(q.value, of.angle)
            as_angle = Figures(text, NumberInText(text, q.step, q.value, q.position))
        return Operand(node, as_angle, q.value < 0 and source.text != "0")

    def result(self, q: NoteQuantity) -> tuple[Node, ...]:
        """A result with its unit; an angle in degrees and minutes too."""
        n = NumberInText(shown(q.value, q.digits), q.step, q.value, q.position, q.digits)
        unit_ = self.unit(q.unit)
        found: tuple[Node, ...] = (figures(n), *((Words("\u00a0" + unit_),) if unit_ else ()))
        if q.unit == "rad":
            text = degrees_and_minutes(q.value)
            found = (*found, Sign("="), Figures(text, NumberInText(text, q.step, q.value, q.position)))
        return found

    def of_turns(self, path: str, turns: str, omega: NoteQuantity) -> ShownFormula | None:
        """Formula of the angular velocity of a speed that the project file gives by its turns; None where it is given in rad/s."""
        value: Any = self.project.variant.data
        for key in path.split("."):
            value = value.get(key, {}) if isinstance(value, Mapping) else {}
        number_, name = units.split(value)
        tree: Any = {"1/s": 2 * pi * expression.Argument(0), "rpm": pi * expression.Argument(0) / 30}.get(units.common(name))
        if tree is None:
            return None
        return self.written(omega.symbol, tree, [NoteQuantity(turns, float(number_), name, path)], omega)

    def checked(
        self,
        symbol: str,
        build: Callable[..., Any],
        quantities: Sequence[NoteQuantity],
        step: Step,
        k: int | None = None,
        unit_: str | None = None,
    ) -> ShownFormula:
        """A formula in the words of the field for a step that the record computes with vectors: its value must be the step's.

        Raises
        ------
        Differs
            when the formula does not give what the record has.
        """
        tree = build(*(expression.Argument(i) for i in range(len(quantities))))
        value = float(np.real(expression.evaluate(tree, [q.value for q in quantities])))
        n = self.of(step, k)
        size = max(abs(n.value), 1e-9 * max((abs(q.value) for q in quantities), default=0.0), 1e-12)
        if isfinite(value) and abs(abs(value) - abs(n.value)) > 1e-6 * size:
            raise Differs(f"{symbol} of {n.step} is {n.value}, the note's formula gives {value}")
        given = self.unit_of(step) if unit_ is None else unit_
        return self.written(symbol, tree, quantities, NoteQuantity("", copysign(n.value, value), given, n.step, n.position))

    # --- sentences

    def sentences(self, plan: Plan, skip: Callable[[Step], bool] = lambda _: False) -> Text:
        """The steps of a plan in their words, one after another, for the position that is told."""
        scale = self.scales.get(plan.name)
        to_mm, name = (scale.mm, "mm") if scale is not None else (float, plan.unit)
        k = plan.labels.index(self.label) if self.label in plan.labels else min(2, len(plan.labels) - 1)
        position = plan.labels[k] if len(plan.labels) > 1 else ""
        names = {s.name for step in plan for s in (step, *step.args) if isinstance(s, Step | Given)}
        told: list[tuple[Step, str]] = []
        for step, sentence in zip(plan, protocol.sentences(plan, k, to_mm, name), strict=True):
            if skip(step) or _bare(sentence):
                continue
            together = self._together(told[-1][1], sentence) if told else ""
            if together:
                told[-1] = (told[-1][0], together)
            else:
                told.append((step, sentence))
        found: list[Inline] = []
        for step, sentence in told:
            found += [*marked(self.quoted(sentence), self.id(step), position, self.language, names), " "]
        return tuple(found)

    def _together(self, first: str, second: str) -> str:
        """Two sentences that end with different letters as one: draw the lines AB, CD; empty where they differ in more."""
        alike, _, letter = second.rpartition(" ")
        for one, many in phrases.words(self.language)["several"].items():
            for begun in (alike, alike[: len(alike) - len(one)] + many):
                if alike.endswith(one) and re.fullmatch(rf"{re.escape(begun)} [^ .:;]+(, [^ .:;]+)*\.", first):
                    return f"{alike[: len(alike) - len(one)]}{many}{first[len(begun):-1]}, {letter}"
        return ""

    def quoted(self, text: str) -> str:
        """A text in which names of guides that are words stand between quotation marks, in the language of the note."""
        said: dict[str, Any] = phrases.words(self.language)
        for guide in self.project.variant.guide:
            if re.search(r"[^\W\d_]{3}", guide.name):
                name = guide.name
                for russian, own in said["guides"].items():
                    name = name.replace(russian, own)
                for end in ("₀", ""):
                    quoted = said["quoted"].format(name=name + end)
                    text = re.sub(rf"(?<![«“\w]){guide.name + end}", quoted, text)
                for before, line in said["lines"].items():
                    text = text.replace(f"{before} {quoted}", f"{line} {quoted}")
        return text

    # --- tables

    def head(self, symbol: str, unit_: str = "") -> Text:
        """Head of a column: letters, unit."""
        node = letters(symbol)
        return (Symbol(node), *((f", {self.unit(unit_)}",) if unit_ else ()))


def _of_magnitude(symbol: str) -> str:
    """Letter whose magnitude stands between bars; a segment between two points is what it is."""
    return symbol if "–" in symbol else symbol.strip("|")


_SUM = re.compile(r"(?<!^)[+−](?![^{]*\})")
_TERM = re.compile(r"·|(?<!^)[+−](?![^{]*\})")


def _presentable(symbol: str) -> bool:
    """Whether letters are letters, and no name of the program."""
    return not re.search(r"[a-z]{4}|[a-z]\.[a-z]|[a-z]_[a-z]{3}|sign of", symbol)


def _converts(tree: expression.Expression) -> bool:
    """Whether a formula only turns metres into millimetres or back."""
    return isinstance(tree, expression.Operation) and any(
        isinstance(p, expression.Constant) and p.value in (1000.0, 1e6) for p in tree.parts
    )


def _plain(symbol: str) -> bool:
    return bool(re.fullmatch(r"[\d,.−-]+(·10\^\{.*\})?", symbol))


def _items(node: Node) -> tuple[Node, ...]:
    return node.items if isinstance(node, FormulaRow) else (node,)


def symbol_of(step: Step) -> str:
    """Letters of a step's value in lettering markup."""
    return step.symbol or letters_of(step.name)


_LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789−")


def figures(n: NumberInText) -> Node:
    """A number in a formula, its power of ten raised."""
    mantissa, _, power = n.text.partition("·10")
    if not power:
        return Figures(n.text, n)
    return FormulaRow((Figures(mantissa, n), Sign("·"), Scripts(Figures("10"), None, Figures(power.translate(_LOWERED)))))


# --- sentences of the record with letters set as letters -----------------------------------------------------------

_LETTER = r"A-Za-zα-ωΑ-Ωϕϑ"


@cache
def _marked(language: str) -> re.Pattern[str]:
    """Names between quotation marks, numbers with their units, and letters in the sentences of a language."""
    opened, closed = map(re.escape, phrases.words(language)["quoted"].split("{name}"))
    units = "|".join(sorted(map(re.escape, phrases.words(language)["units"].values()), key=len, reverse=True))
    return re.compile(
        rf"(?P<name>{opened}.*?{closed})|(?P<number>[−]?\d+(?:[,.]\d+)?(?:e[−-]?\d+)?(?![{_LETTER}\d_′″])(?: (?:{units})(?!\w))?°?)"
        rf"|(?P<word>[{_LETTER}∞](?:_\w+|[{_LETTER}\d_′″*'̅]|(?<=[FM])и(?=\d))*(?:\^\S)?)"
    )


def marked(sentence: str, step: str, position: str, language: str, names: Collection[str] = ()) -> Iterator[Inline]:
    """A sentence with its letters as symbols and its numbers as numbers of a step; ``names`` are those of its steps."""
    at = 0
    for m in _marked(language).finditer(sentence):
        before = sentence[m.start() - 1 : m.start()]
        if m["name"] or before.isalpha():
            continue
        if m["word"] and sentence[m.end() : m.end() + 1].isalpha() and _cyrillic(sentence[m.end()]):
            continue
        if m["word"] and is_latin(language) and not _lettered(m["word"], sentence[: m.start()], names):
            continue
        if m.start() > at:
            yield sentence[at : m.start()]
        at = m.end()
        if m["word"]:
            yield Symbol(letters(named(m["word"])))
        else:
            text, _, unit_ = m["number"].partition(" ")
            bare = text.rstrip("°").replace("−", "-").replace(",", ".")
            yield NumberInText(text, step, float(bare), position, 0, unit_)
    yield sentence[at:]


def _lettered(word: str, before: str, names: Collection[str]) -> bool:
    """Whether an English sentence means letters by a word: a name, points one after another, a segment between bars."""
    if word in ("a", "A"):
        return re.search(r"(\b(point|points|[Tt]hrough|[Ff]rom|and|centre)|\||:) ?$", before) is not None
    return word in names or bool(re.search(r"[\d_′″*'̅α-ωΑ-Ωϕϑ∞]|^([A-Z]\d?)+$", word)) or before.endswith("|")


def _cyrillic(c: str) -> bool:
    return "\u0400" <= c <= "\u04ff"


def named(word: str) -> str:
    """Markup of letters as sentences write them: pb3 is p and b with the index 3, F21τ a force with its mark."""
    base, power, exponent = word.partition("^")
    if power and "{" not in word:
        return f"{named(base)}^{exponent}"
    if "_" in word or "^" in word:
        return re.sub(r"_(\d+|[α-ωа-я]+|\w+)", r"_{\1}", word) if "{" not in word else word
    found = letters_of(word)
    if found != word:
        return found
    return re.sub(rf"([{_LETTER}])(\d+)", r"\1_{\2}", word)


def _bare(sentence: str) -> bool:
    """A sentence that only hands a number on: ω0 = 0."""
    return re.fullmatch(r"\S+ = [^ ]+( [^ ]+)?\.", sentence) is not None


def in_degrees(value: float) -> float:
    """Degrees of an angle in rad, 0 to 360."""
    return degrees(value) % 360
