"""What the sections of a note read: the steps of a project as numbers, formulas and sentences of the note."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from math import copysign, floor, isfinite, log10, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import expression, protocol
from tmm_sheets.construction.equation import DIGITS, Digits, Quantity, in_numbers, shown, tree_of_step
from tmm_sheets.construction.formula import (
    Figures,
    FormulaRow,
    Node,
    Operand,
    Scripts,
    Sign,
    Words,
    arguments,
    filled,
    letters,
    letters_of,
    of_tree,
    row,
    simplified,
)
from tmm_sheets.construction.step import FoundNumber, Given, GivenNumber, Plan, Step, value_at
from tmm_sheets.errors import CannotBuild
from tmm_sheets.meanings import words
from tmm_sheets.note.document import Inline, NumberInText, Rows, ShownFormula, Symbol, Text
from tmm_sheets.numbers import degrees_and_minutes, fixed, is_zero, number
from tmm_sheets.record.recording import unit
from tmm_sheets.record.step_index import StepIndex
from tmm_sheets.task import units
from tmm_sheets.words import is_latin

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.note.pictures import Pictures
    from tmm_sheets.project import Project

FINEST = 6
"""Digits that the greatest of a kind would have with the decimals of the least of them."""


class Differs(CannotBuild):
    """A formula as people write it does not give what the record has: the note does not print it."""


@dataclass(frozen=True)
class NoteQuantity(Quantity):
    """A letter with its number, and the step and the position that it is read from."""

    step: str = ""
    position: str = ""

    def operand(self, of: Digits) -> Operand:
        """What stands for it in a formula with numbers; they know their step."""
        node = _figures(self, of.number) if self.step else Figures(shown(self.value, of.number))
        degrees = _degrees(self, of.angle) if self.unit == "rad" else None
        return Operand(node, degrees, self.value < 0 and shown(self.value, of.number) != "0")


@dataclass(frozen=True)
class Column:
    """Numbers of a table over positions; ``kind`` is the size of their kind, one or one a position, see :meth:`Reader.number`.

    With ``decimals`` all have so many.
    """

    head: Text
    values: Any
    step: str
    kind: Any = 0.0
    decimals: int | None = None


@dataclass
class Reader:
    """A project, its record and its sheets, and how a note says them."""

    project: Project
    language: str
    pictures: Pictures
    scales: Mapping[str, Scale]
    problems: list[str] = field(default_factory=list)
    _formulas: dict[str, ShownFormula | None] = field(default_factory=dict)

    @cached_property
    def book(self) -> StepIndex:
        """All steps of the plans that results come from, whether or not a sheet shows them."""
        return StepIndex(plan for of_part in self.project.plans.values() for plan in (of_part or {}).values())

    @property
    def words(self) -> dict[str, Any]:
        """Single words of the language."""
        return words(self.language)

    # --- what templates find by its path

    def plan(self, name: str) -> Plan | None:
        """A plan of the project, None for one that was not made."""
        return next((of_part[name] for of_part in self.project.plans.values() if of_part and name in of_part), None)

    def step(self, path: str) -> Step | None:
        """The step "plan/name", None for one that was not made."""
        name, _, own = path.partition("/")
        plan = self.plan(name) if own else None
        return plan[own] if plan is not None and own in plan else None

    def formula_of(self, path: str) -> ShownFormula | None:
        """The formula of the step "plan/name", see :meth:`formula`."""
        if path not in self._formulas:
            step = self.step(path)
            self._formulas[path] = self.formula(step) if step is not None else None
        return self._formulas[path]

    def number_of(self, path: str) -> NumberInText | None:
        """The value of the step "plan/name", an angle in degrees and minutes; None for one that was not made."""
        step = self.step(path)
        if step is None:
            return None
        return self.angle(float(self.value(step)), self.id(step)) if self.unit_of(step) == "rad" else self.of(step)

    def scale(self, plan: str) -> Text | None:
        """The scale factor of a plan as it is written: letter = number unit; None for a plan that is not drawn."""
        return scale_text(self.scales[plan]) if plan in self.scales else None

    def sheet(self, *views: str) -> str:
        """Number of the sheet that shows a view, the first of them that any shows; empty for none."""
        return next((str(n) for name in views if (n := self.pictures.sheet_of(name)) is not None), "")

    # --- the position that is told in words

    @cached_property
    def k(self) -> int:
        """Number of the position that is told in words: that of the force analysis."""
        variant = self.project.variant
        if variant.crank is None or variant.cycle is None:
            return 0
        if "forces" in self.project.parts or variant.cycle.force_position:
            return self.project.force_index
        return min(2, len(self.project.cycle.labels) - 1)

    @cached_property
    def label(self) -> str:
        """Label of that position; empty where nothing moves in numbered positions."""
        variant = self.project.variant
        return "" if variant.crank is None or variant.cycle is None else str(self.project.cycle.labels[self.k])

    def at(self, step: Step) -> int:
        """Number of that position in the plan of a step: by its label when the plan has others."""
        if np.ndim(step.value) == 0:
            return 0
        labels = self.labels(step)
        return labels.index(self.label) if self.label in labels else min(self.k, len(step.value) - 1)

    def value(self, step: Any) -> Any:
        """Value of a step there."""
        return value_at(step, self.at(step)) if isinstance(step, Step) else value_at(step, self.k)

    def labels(self, step: Step) -> Sequence[str]:
        """Labels of the positions of the plan of a step."""
        return self.book.plans[self.book.plan(step)].labels if step in self.book else ()

    def position(self, step: Step) -> str:
        """Label of the position that is told of a step; empty for one that has no positions."""
        k, labels = self.at(step), self.labels(step)
        return labels[k] if np.ndim(step.value) and k < len(labels) else ""

    # --- numbers

    def unit(self, name: str) -> str:
        """A unit in words."""
        return unit_words(name, self.language)

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

    def of(self, step: Step, unit: str | None = None) -> NumberInText:
        """Value of a step at the position that is told; of a vector its magnitude."""
        value: Any = self.value(step)
        value = abs(value) if isinstance(value, complex | np.complexfloating) else float(value)
        return self.number(value, self.unit_of(step) if unit is None else unit, self.id(step), self.position(step))

    def size(self, step: Step, unit: str | None = None) -> NumberInText:
        """Value of a step at the position that is told, without its sign."""
        found = self.of(step, unit)
        return replace(found, text=found.text.removeprefix("−"), value=abs(found.value))

    def fixed(self, value: float, unit: str, decimals: int, step: str = "", position: str = "") -> NumberInText:
        """A number with a fixed number of decimals: millimetres of a drawing, degrees."""
        value = float(value)
        return NumberInText(fixed(value, decimals), step, value, position, decimals, self.unit(unit))

    def angle(self, value: float, step: str = "") -> NumberInText:
        """An angle in degrees and minutes."""
        return NumberInText(degrees_and_minutes(float(value)), step, float(value))

    def id(self, step: Step) -> str:
        """Id of a step: plan/name."""
        return self.book.id(step) if step in self.book else step.path

    def origin(self, value: Any, place: str) -> str:
        """Where a number comes from that the project file gives in that ``place``, or has found by synthesis: id of its step."""
        return self.id(value.step) if isinstance(value, FoundNumber) else place

    def unit_of(self, step: Step) -> str:
        """Unit of a step, as the record writes it."""
        return unit(step, self.book.plans[self.book.plan(step)]) if step in self.book else step.rule.unit

    def letters_of(self, x: Any) -> str:
        """Letters of a step or a given number in the note: those of ``[symbols]`` in words.toml, or its own."""
        return str(self.words["symbols"].get(x.name) or (symbol_of(x) if isinstance(x, Step) else x.symbol or x.name))

    def quantity(self, step: Step, symbol: str = "", unit: str | None = None) -> NoteQuantity:
        """A step as an operand."""
        n, unit = self.of(step, unit), self.unit_of(step) if unit is None else unit
        return NoteQuantity(symbol or symbol_of(step), n.value, unit, step=n.step, position=n.position)

    def measured(self, symbol: str, value: float, unit: str, step: Step) -> NoteQuantity:
        """An operand that a step gives at the position that is told."""
        return NoteQuantity(symbol, value, unit, step=self.id(step), position=self.label)

    @cached_property
    def givens(self) -> list[NoteQuantity]:
        """Given numbers with letters that some step takes, each letter once."""
        found: dict[str, NoteQuantity] = {}
        for a in (a for step in self.book.steps.values() for a in step.args):
            if isinstance(a, GivenNumber) and a.symbol:
                found.setdefault(a.symbol, NoteQuantity(a.symbol, float(a), a.unit, step=a.name))
        return list(found.values())

    @property
    def crank_length(self) -> NoteQuantity:
        """Length of the crank."""
        crank = self.project.mechanism.crank
        place = self.origin(crank.length, "crank.length")
        return NoteQuantity(f"l_{{{crank.pivot}{crank.pin}}}", float(crank.length), "m", step=place)

    def lengths(self) -> list[NoteQuantity]:
        """Lengths of the links among them."""
        return [q for q in self.givens if q.unit == "m" and q.symbol.startswith("l") and q.value]

    def length(self, a: str, b: str) -> str:
        """Letters of the length between two points, as it is given or as they follow each other."""
        known = {q.symbol for q in self.givens if q.unit == "m"}
        return next((s for s in (f"l_{{{a}{b}}}", f"l_{{{b}{a}}}") if s in known), f"l_{{{a}{b}}}")

    # --- formulas

    def formula(self, step: Step) -> ShownFormula | None:
        """The formula of a step by its own expression; None when it has none that can be written."""
        tree = tree_of_step(step)
        quantities = [self._operand(a) for a in step.args]
        value = self.value(step)
        if tree is None or None in quantities or not _is_number(value):
            return None
        told = [q for q in quantities if q is not None]
        firsts = (next(j for j, b in enumerate(step.args) if b is a) for a in step.args)
        tree = simplified(filled(tree, [*map(expression.Argument, firsts)]))
        head, used = self.letters_of(step), [told[i].symbol for i in arguments(tree)]
        if not isinstance(tree, expression.Operation) or any(map(_OF_PROGRAM.search, (head, *used))):
            return None
        if any(isinstance(p, expression.Constant) and p.value in (1000.0, 1e6) for p in tree.parts) or head in used:
            return None  # the same quantity in another unit, metres as millimetres
        return self.written(head, tree, told, self.quantity(step, head))

    def formulas(self, plan: str) -> list[ShownFormula]:
        """Formulas of the steps of a plan that have numbers, in their order."""
        found = (self.formula_of(f"{plan}/{step.name}") for step in self.plan(plan) or ())
        return [said for said in found if said is not None and said.numbers is not None]

    def _operand(self, a: Any) -> NoteQuantity | None:
        if isinstance(a, Step):
            value, unit, step, position = self.value(a), self.unit_of(a), self.id(a), self.position(a)
        elif isinstance(a, Given | GivenNumber):
            of: Any = a.value if isinstance(a, Given) else a
            value, unit, step, position = of[min(self.k, len(of) - 1)] if np.ndim(of) else of, a.unit, a.name, ""
        else:
            return NoteQuantity(number(float(a), 6), float(a)) if isinstance(a, int | float | np.number) else None
        return NoteQuantity(self.letters_of(a), float(value), unit, step=step, position=position) if _is_number(value) else None

    def written(self, symbol: str, tree: expression.Expression, quantities: Sequence[NoteQuantity],
                result: NoteQuantity) -> ShownFormula:
        """A formula from its expression and the quantities in the places of its arguments."""
        in_letters = [Operand(letters(q.symbol), None, bool(_SUM.search(q.symbol))) for q in quantities]
        used = [quantities[i] for i in dict.fromkeys(arguments(simplified(tree)))]
        told = [q for q in used if not _PLAIN.fullmatch(q.symbol) and not _TERM.search(q.symbol)]
        # A letter whose magnitude stands between bars; a segment between two points is what it is.
        explained = [(q.symbol if "–" in q.symbol else q.symbol.strip("|"), self.unit(q.unit))
                     for q in (replace(result, symbol=symbol), *told)]
        numbers, of_result = in_numbers(tree, quantities, result)
        gives = self._result(replace(result, digits=of_result))
        worked_out = () if isinstance(tree, expression.Argument) else (of_tree(tree, numbers), Sign("="))
        return ShownFormula(row(letters(symbol), Sign("="), of_tree(tree, in_letters)), row(*worked_out, *gives), tuple(explained))

    def by_segment(self, symbol: str, segment: str, scale: Scale, mu: NoteQuantity, size: NoteQuantity, step: Step) -> ShownFormula:
        """Formula of the ``size`` of a vector from the segment that is drawn for it and the scale factor ``mu``."""
        tree: Any = expression.Argument(0) * expression.Argument(1)
        return self.written(symbol, tree, [self.measured(segment, float(scale.mm(size.value)), "mm", step), mu], size)

    def _result(self, q: NoteQuantity) -> Iterator[Node]:
        """A result with its unit; an angle in degrees and minutes too."""
        yield _figures(q, q.digits)
        if self.unit(q.unit):
            yield Words("\u00a0" + self.unit(q.unit))
        if q.unit == "rad":
            yield from (Sign("="), _degrees(q))

    def of_turns(self, path: str, turns: str, omega: NoteQuantity) -> ShownFormula | None:
        """Formula of the angular velocity of a speed that the project file gives by its turns; None where it is given in rad/s."""
        value: Any = self.project.variant.data
        for key in path.split("."):
            value = value.get(key, {}) if isinstance(value, Mapping) else {}
        number_, name = units.split(value)
        tree: Any = {"1/s": 2 * pi * expression.Argument(0), "rpm": pi * expression.Argument(0) / 30}.get(units.common(name))
        given = NoteQuantity(turns, float(number_), name, step=path)
        return None if tree is None else self.written(omega.symbol, tree, [given], omega)

    def agreed(self, symbol: str, tree: expression.Expression, quantities: Sequence[NoteQuantity],
               result: NoteQuantity) -> ShownFormula:
        """A formula in the words of the field for what the record computes otherwise: it must give the ``result`` or its opposite.

        Raises
        ------
        Differs
            when the formula does not give what the record has.
        """
        value = float(np.real(expression.evaluate(tree, [q.value for q in quantities])))
        size = max(abs(result.value), 1e-9 * max((abs(q.value) for q in quantities), default=0.0), 1e-12)
        if isfinite(value) and abs(abs(value) - abs(result.value)) > 1e-6 * size:
            raise Differs(f"{symbol} of {result.step} is {result.value}, the note's formula gives {value}")
        return self.written(symbol, tree, quantities, replace(result, value=copysign(result.value, value)))

    def checked(self, symbol: str, build: Callable[..., Any], quantities: Sequence[NoteQuantity], step: Step) -> ShownFormula:
        """A formula checked against the value of a step, from a function of as many numbers as there are ``quantities``."""
        tree = build(*map(expression.Argument, range(len(quantities))))
        return self.agreed(symbol, tree, quantities, self.quantity(step, symbol))

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
            if skip(step) or _BARE.fullmatch(sentence):
                continue
            together = self._joined_sentences(told[-1][1], sentence) if told else ""
            if together:
                told[-1] = (told[-1][0], together)
            else:
                told.append((step, sentence))
        return tuple(piece for step, sentence in told
                     for piece in (*marked(self.quoted(sentence), self.id(step), position, self.language, names), " "))

    def _joined_sentences(self, first: str, second: str) -> str:
        """Two sentences that end with different letters as one: draw the lines AB, CD; empty where they differ in more."""
        alike, _, letter = second.rpartition(" ")
        for one, many in self.words["several"].items():
            for begun in (alike, alike[: len(alike) - len(one)] + many):
                if alike.endswith(one) and re.fullmatch(rf"{re.escape(begun)} [^ .:;]+(, [^ .:;]+)*\.", first):
                    return f"{alike[: len(alike) - len(one)]}{many}{first[len(begun):-1]}, {letter}"
        return ""

    def quoted(self, text: str) -> str:
        """A text in which names of guides that are words stand between quotation marks, in the language of the note."""
        said: dict[str, Any] = self.words
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

    def head(self, symbol: str, unit: str = "") -> Text:
        """Head of a column: letters, unit."""
        return (Symbol(letters(symbol)), *((f", {self.unit(unit)}",) if unit else ()))

    def over_positions(self, positions: Iterable[tuple[int, str]], columns: Sequence[Column], first: str = "") -> Rows:
        """A table with a row for each position, its number and its label: the label, then a number in each column."""
        if not columns:
            return ()
        rows = [((first or self.words["position"],), *(c.head for c in columns))]
        rows += [((label,), *((self._in_column(c, i, label),) for c in columns)) for i, label in positions]
        return tuple(rows)

    def _in_column(self, c: Column, i: int, label: str) -> NumberInText:
        value = float(c.values[i])
        if c.decimals is not None:
            return self.fixed(value, "", c.decimals, c.step, label)
        return self.number(value, "", c.step, label, kind=float(np.broadcast_to(c.kind, np.shape(c.values))[i]))


@cache
def unit_words(name: str, language: str) -> str:
    """A unit of the record or of a project file in words; one that the language has no word for as it stands."""
    return "" if name == "1" else _units(language).get(units.common(name), name)


@cache
def _units(language: str) -> dict[str, str]:
    """Words for units by their common spelling."""
    return {units.common(name): said for name, said in words(language)["units"].items()}


def scale_text(scale: Any) -> Text:
    """A scale factor as it is written."""
    head, _, rest = str(scale).partition(" = ")
    return (Symbol(FormulaRow((letters(head), Sign("="), Words(rest)))),)


def listed(said: Sequence[str], last: str) -> str:
    """A list in words."""
    return last.join(filter(None, (", ".join(said[:-1]), *said[-1:])))


def _is_number(value: Any) -> bool:
    """Whether a value is one real number."""
    return isinstance(value, int | float | np.number | np.ndarray) and not np.ndim(value) and not np.iscomplexobj(value)


_SUM = re.compile(r"(?<!^)[+−](?![^{]*\})")
_TERM = re.compile(r"·|(?<!^)[+−](?![^{]*\})")


_PLAIN = re.compile(r"[\d,.−-]+(·10\^\{.*\})?")
"""A number where a letter may stand."""
_OF_PROGRAM = re.compile(r"[a-z]{4}|[a-z]\.[a-z]|[a-z]_[a-z]{3}|sign of")
"""In what is no letter but a name of the program."""


def symbol_of(step: Step) -> str:
    """Letters of a step's value in lettering markup."""
    return step.symbol or letters_of(step.name)


_LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789−")


def _figures(q: NoteQuantity, digits: int) -> Node:
    """A number in a formula, its power of ten raised."""
    n = NumberInText(shown(q.value, digits), q.step, q.value, q.position, digits)
    mantissa, _, power = n.text.partition("·10")
    if not power:
        return Figures(n.text, n)
    return FormulaRow((Figures(mantissa, n), Sign("·"), Scripts(Figures("10"), None, Figures(power.translate(_LOWERED)))))


def _degrees(q: NoteQuantity, places: int = 0) -> Figures:
    """An angle in degrees and minutes in a formula."""
    text = degrees_and_minutes(q.value, places)
    return Figures(text, NumberInText(text, q.step, q.value, q.position))



# --- sentences of the record with letters set as letters -----------------------------------------------------------

_LETTER = r"A-Za-zα-ωΑ-Ωϕϑ"


@cache
def _marked(language: str) -> re.Pattern[str]:
    """Names between quotation marks, numbers with their units, and letters in the sentences of a language."""
    opened, closed = map(re.escape, words(language)["quoted"].split("{name}"))
    units = "|".join(sorted(map(re.escape, words(language)["units"].values()), key=len, reverse=True))
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
        if m["word"] and "\u0400" <= sentence[m.end() : m.end() + 1] <= "\u04ff" and sentence[m.end()].isalpha():
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


_BARE = re.compile(r"\S+ = [^ ]+( [^ ]+)?\.")
"""A sentence that only hands a number on: ω0 = 0."""
