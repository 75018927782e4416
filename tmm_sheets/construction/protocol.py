"""The construction said in sentences: each step with its lengths in millimetres of the drawing."""

from __future__ import annotations

import re
from cmath import isfinite
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from math import degrees
from typing import Any

import numpy as np

from tmm_sheets.construction.equation import POWERS, UNITS, Quantity, digits_for, of_step
from tmm_sheets.construction.formula import letters_of
from tmm_sheets.construction.rules import LINE_LINE, take
from tmm_sheets.construction.step import Kind, Plan, Step, value_at, value_of
from tmm_sheets.errors import CannotBuild
from tmm_sheets.meanings import meaning_of
from tmm_sheets.numbers import NOISE, Sizes, clean, degrees_and_minutes, fixed, number, rounded_angle
from tmm_sheets.words import marked, paper, tr, tr_n

_PERPENDICULAR = {
    (1,): marked("Through {0} perpendicular to {1} and through {2} parallel to {3} draw lines; they meet at point {name}."),
    (3,): marked("Through {0} parallel to {1} and through {2} perpendicular to {3} draw lines; they meet at point {name}."),
    (1, 3): marked("Through {0} perpendicular to {1} and through {2} perpendicular to {3} draw lines; they meet at point {name}."),
}
"""Sentences of lines that meet where these of their directions are said as perpendiculars: by what they are perpendicular to."""


def sentences(plan: Plan, k: int, to_mm: Callable[[float], float], unit: str = "mm") -> Iterator[str]:
    """Sentences of the plan at position ``k``; ``to_mm`` turns a length of the plan into millimetres of paper.

    A plan that is not drawn has no millimetres: ``to_mm`` leaves its lengths as they are and ``unit`` names theirs.
    """
    sizes = SortSizes(plan)
    for step in plan:
        said = sentence(step, k, to_mm, unit, sizes)
        drawn: list[tuple[str, str]] = []
        nothing: list[tuple[str, str]] = []
        for name, vector in _segments(plan, step, k):
            size = _said(vector, "vector", to_mm, unit, sizes.at(step, k))
            (drawn if any(c in "123456789∞—" for c in size) else nothing).append((name, size))
        if drawn:
            segments = ", ".join(f"|{name}{letter_of(step)}| = {size}" for name, size in drawn)
            told = tr_n("Segment {segments}.", "Segments {segments}.", len(drawn)).format(segments=segments)
            said = f"{said} {told}"
        for name, _ in nothing:
            told = tr("On the drawing {point} falls on {other}.").format(point=letter_of(step), other=name)
            said = f"{said} {told}"
        yield said


class SortSizes:
    """Sizes of the sorts of quantities among some steps, beside which a number is something or nothing."""

    def __init__(self, steps: Iterable[Step]) -> None:
        values: dict[str, list[Any]] = {}
        for step in steps:
            if np.asarray(step.value).dtype.kind in "ifc":
                values.setdefault(_comparison_class(step), []).append(step.value)
        self._of = {sort: Sizes(found) for sort, found in values.items()}
        self._own: dict[int, Sizes] = {}

    def at(self, step: Step, k: int) -> float:
        """Size of the sort of a step at position ``k``."""
        of_sort = self._of.get(_comparison_class(step))
        return of_sort.at(k) if of_sort else 0.0

    def of_argument(self, arg: Any, k: int) -> float:
        """Size of the sort of a step or given number that may stand in none of these plans: its own size counts too."""
        if id(arg) not in self._own:
            own = value_of(arg)
            self._own[id(arg)] = Sizes([own] if np.asarray(own).dtype.kind in "ifc" else ())
        own_size = self._own[id(arg)].at(k)
        return max(own_size, self.at(arg, k)) if isinstance(arg, Step) else own_size


def sizes_of(plan: Plan) -> SortSizes:
    """Sizes of the sorts of quantities of a plan, for :func:`sentence`."""
    return SortSizes((*plan, *plan.auxiliaries.values()))


def _comparison_class(step: Step) -> str:
    """What steps of a plan are compared with: numbers with those of their letter (ω2 and ω3, ΣM4 and M50), of F with forces too."""
    gives = step.rule.gives
    if gives == "number":
        return step.name.lstrip("Σ")[:1]
    return {"force": "F", "vector": "point", "ordinate": "length"}.get(gives, gives)


def _segments(plan: Plan, step: Step, k: int) -> list[tuple[str, Any]]:
    """Segments of a velocity or acceleration plan that a step draws: where each begins, and its vector.

    A vector laid off from a point is measured from there; lines that meet give one segment each beside that from the pole.
    """
    if plan.pole is None or step.name == plan.pole or step.rule.gives not in ("point", "vector"):
        return []
    end = value_at(step, k)
    points = [a for a in step.args if isinstance(a, Step) and a.name in plan and a.rule.gives in ("point", "vector")]
    laid_off = step.rule.laid_off and points
    starts = points[:1] if laid_off else [plan[plan.pole], *(points if step.rule is LINE_LINE else ())]
    return [(letter_of(s), end - value_at(s, k)) for s in dict.fromkeys(starts)]


_GREEK = {"alpha": "α", "phi": "φ", "psi": "ψ", "eps": "ε", "theta": "θ", "rho": "ρ"}


def letter_of(step: Step) -> str:
    """How a step is called in a sentence: its letter on the sheet without markup, or its name."""
    return _unmarked(step.symbol) if step.symbol else spoken(step.name)


@lru_cache(4096)  # said again at each position
def _unmarked(symbol: str) -> str:
    return re.sub(r"\^(?=\{\*)|[{}]", "", symbol)


@lru_cache(4096)
def spoken(name: str) -> str:
    """Name of a step as it stands on the sheet: Greek letters instead of their names."""
    return re.sub(r"^(alpha|phi|psi|eps|theta|rho)(?=_|\d|$)", lambda m: _GREEK[m[1]], name)


_MEASURED = frozenset(("length", "ordinate", "vector", "force", "angle", "inclination", "number"))
"""Kinds of which a value is said; a point or a direction is where it is drawn."""
_OPERAND = re.compile(r"(?<=[·/×+−])( ?)(\{\d\})|(\{\d\})(?=²)")
"""An argument behind an arithmetic sign or squared: a negative one stands in parentheses there."""


def sentence(step: Step, k: int, to_mm: Callable[[float], float], unit: str = "mm", sizes: SortSizes | None = None) -> str:
    """One step as a sentence; ``sizes`` are those of each sort in its plan."""
    if sizes is None:
        sizes = SortSizes([step])
    told = step.rule.wording if step.say is None else step.say
    if not told:
        meaning = _meaning(step.symbol or letters_of(step.name), paper(), step.plan.partition("-")[0])
        return f"{meaning[:1].upper()}{meaning[1:]}{': ' if meaning else ''}{_of_formula(step, k, to_mm, unit, sizes)}."
    formula = _of_formula(step, k, to_mm, unit, sizes) if "{formula}" in told else ""
    # What is taken from another plan has other positions there. A protractor knows no minutes: they are said in formulas, not
    # where an angle is laid off.
    args, drawn = () if step.rule.compute is take else step.args, step.rule.gives in ("point", "direction")
    shown = [_show(a, kind, k, to_mm, unit, sizes, drawn) for a, kind in zip(args, step.rule.takes, strict=False)]
    value = _exact_angle(step, k)
    if value and args:
        value = _with_seconds(step, k, shown)
    if not value and step.rule.gives in _MEASURED:
        of_sort = 100.0 if step.rule.unit == "%" else sizes.at(step, k)
        value = _said(value_at(step, k), step.rule.gives, to_mm, unit, of_sort)

    def operand(m: re.Match[str]) -> str:
        space, field = m[1] or "", m[2] or m[3]
        return f"{space}({field})" if shown[int(field[1:-1])].startswith("−") else m[0]

    wording = _wording(step, shown)
    if any(said.startswith("−") for said in shown):
        wording = _OPERAND.sub(operand, wording)
    return wording.format(*shown, name=letter_of(step), value=value, formula=formula)


def sentence_of_any_angle(step: Step) -> str:
    """A step as a sentence without numbers: "{value}" where its own stands; empty where it is told by a formula alone."""
    shown = [letter_of(arg) if isinstance(arg, Step) else "" for arg in step.args]
    return _wording(step, shown).format(*shown, name=letter_of(step), value="{value}", formula="")


_SECTIONS = {"rack": "gear",
             **dict.fromkeys(("drive", "rotor", "motor", "crank", "energy", "reduction"), "flywheel")}
"""Parts of the note whose letters those of other plans are, by the first word of a plan's name."""


def _of_formula(step: Step, k: int, to_mm: Callable[[float], float], unit: str, sizes: SortSizes) -> str:
    """The formula of a step in letters and in numbers, with what it gives."""
    kinds = {id(a): kind for a, kind in zip((*step.args, step), (*step.rule.takes, step.rule.gives), strict=False)}

    def quantity(symbol: str, value: float, of_unit: str, of: Any) -> Quantity:
        value = clean(value, sizes.of_argument(of, k))
        kind = kinds[id(of)]
        if kind in ("length", "ordinate"):
            value, of_unit = to_mm(value), unit
            if unit == "mm":
                return Quantity(symbol, value, unit, digits_for(value, 1), 1)
        return Quantity(symbol, value, "rad" if kind in ("angle", "inclination") else of_unit)

    said = of_step(step, k, quantity=quantity)
    if not said:
        value = number(float(np.real(value_at(step, k))), kind=sizes.at(step, k))
        said = f"{letter_of(step)} = {value} {tr(UNITS.get(step.rule.unit, step.rule.unit))}".rstrip()
    for name in {a.name for a in (*step.args, step) if isinstance(a, Step) and not a.symbol}:
        said = said.replace(letters_of(name), spoken(name))  # without markup as everywhere
    said = re.sub(r"\^\{(−?\d+)\}", lambda m: m[1].translate(POWERS), said)
    said = re.sub(r"\^\{([^{}*]+/[^{}]+)\}", r"^(\1)", said)
    return _unmarked(said)


@lru_cache(4096)
def _meaning(letters: str, language: str, section: str) -> str:
    """What letters mean; nothing in a language that has no words for them."""
    try:
        said = meaning_of(letters.replace("∞", ""), language, _SECTIONS.get(section, section))
    except CannotBuild:
        return ""
    return re.sub(r"\$([^$]*)\$", lambda m: _unmarked(m[1]), said).replace("…", "")


def _wording(step: Step, shown: list[str]) -> str:
    """The sentence before its arguments are put in; of lines drawn as perpendiculars the sign is taken off the arguments."""
    if step.say is not None:
        return step.say
    if step.rule is LINE_LINE and (across := tuple(i for i in (1, 3) if shown[i].startswith("⟂"))):
        for i in across:
            shown[i] = shown[i].removeprefix("⟂")
        return tr(_PERPENDICULAR[across])
    return tr(step.rule.wording)


def _show(arg: Any, kind: Kind, k: int, to_mm: Callable[[float], float], unit: str, sizes: SortSizes,
          drawn: bool) -> str:
    if isinstance(arg, Step) and kind in ("point", "direction", "force"):
        return letter_of(arg)
    if not drawn and (exact := _exact_angle(arg, k)):
        return exact
    # Millimetres have their one decimal, whatever is beside them.
    of_sort = sizes.of_argument(arg, k) if kind == "number" or unit != "mm" else 0.0
    said = _said(value_at(arg, k), kind, to_mm, unit, of_sort)
    return f"{letter_of(arg)} ({said})" if isinstance(arg, Step) and kind == "vector" else said


def _exact_angle(arg: Any, k: int) -> str:
    """Degrees and minutes of an angle that a formula gives; empty for anything else, also for what is measured on the drawing."""
    if isinstance(arg, Step) and arg.rule.gives in ("angle", "inclination") and arg.rule.unit == "rad":
        value = float(value_at(arg, k))
        return degrees_and_minutes(value) if np.isfinite(value) else ""
    return ""


def _with_seconds(step: Step, k: int, shown: list[str]) -> str:
    """An angle that a formula gives, in degrees and minutes, and so the angles it is found from, which are ``shown`` with it.

    Where minutes do not add up, all have seconds with which they do. What is no sum, an arc cosine, stays in minutes.
    """
    value = float(value_at(step, k))
    kinds = zip(step.rule.takes, shown, strict=False)
    angles = [i for i, (kind, text) in enumerate(kinds) if kind in ("angle", "inclination") and text.endswith(("°", "′"))]

    def adds_up(places: int) -> bool:
        values = [rounded_angle(float(value_at(a, k)), places) if i in angles else value_at(a, k) for i, a in enumerate(step.args)]
        found = step.rule.compute(*values)
        return bool(np.ndim(found)) or abs(float(found) - rounded_angle(value, places)) <= NOISE

    places = next(filter(adds_up, range(MOST_PLACES + 1)), 0) if angles else 0
    for i in angles:
        shown[i] = degrees_and_minutes(float(value_at(step.args[i], k)), places)
    return degrees_and_minutes(value, places)


MOST_PLACES = 3
"""Places of an angle behind the minutes: two of seconds, one behind the decimal sign."""


def _said(value: Any, kind: Kind, to_mm: Callable[[float], float], unit: str, of_sort: float) -> str:
    """A value with its unit; ``of_sort`` is the size of its sort, in the unit of the plan."""
    if kind not in _MEASURED or getattr(value, "ndim", False):
        return ""
    if not isfinite(value):
        return "—" if np.isnan(value) else "−∞" if np.real(value) < 0 else "∞"
    if kind in ("length", "ordinate", "vector"):
        real = to_mm(float(value) if kind == "ordinate" else abs(value))
        return f"{fixed(real, 1) if unit == 'mm' else number(real, kind=to_mm(of_sort))} {tr(UNITS.get(unit, unit))}"
    if kind == "force":
        return f"{fixed(abs(value), 1)} {tr('N')}"
    if kind == "angle":
        return f"{fixed(degrees(value) % 360, 1)}°"
    return f"{fixed(degrees(value), 1)}°" if kind == "inclination" else number(float(np.real(value)), kind=of_sort)
