"""The construction said in sentences: each step with its lengths in millimetres of the drawing."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from math import degrees
from typing import Any

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.rules import LINE_LINE, take
from tmm_sheets.construction.step import Kind, Step, value_at, value_of
from tmm_sheets.numbers import degrees_and_minutes, fixed, number, size
from tmm_sheets.words import marked, tr, tr_n

UNITS = {"mm": marked("mm"), "m": marked("m"), "m/s": marked("m/s"), "m/s2": marked("m/s²"), "N": marked("N"), "rad": marked("rad")}
"""Units of plans as they are said."""

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
    sizes = _sizes(plan, k)
    for step in plan:
        said = sentence(step, k, to_mm, unit, sizes)
        segments = [f"|{name}{letter_of(step)}| = {_said(vector, 'vector', to_mm, unit, sizes[_sort(step)])}"
                    for name, vector in _segments(plan, step, k)]
        if segments:
            told = tr_n("Segment {segments}.", "Segments {segments}.", len(segments)).format(segments=", ".join(segments))
            said = f"{said} {told}"
        yield said


def _sizes(steps: Iterable[Step], k: int) -> dict[str, float]:
    """Size of each sort among some steps, at position ``k``."""
    values: dict[str, list[Any]] = {}
    for step in steps:
        if np.asarray(step.value).dtype.kind in "ifc":
            values.setdefault(_sort(step), []).append(step.value)
    return {sort: size(found, k) for sort, found in values.items()}


def sizes_of(plan: Plan, k: int) -> dict[str, float]:
    """Size of each sort of quantities of a plan at position ``k``, for :func:`sentence`."""
    return _sizes((*plan, *plan.asides.values()), k)


def _sort(step: Step) -> str:
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
    return re.sub(r"\^(?=\{\*)|[{}]", "", step.symbol) if step.symbol else spoken(step.name)


def spoken(name: str) -> str:
    """Name of a step as it stands on the sheet: Greek letters instead of their names."""
    return re.sub(r"^(alpha|phi|psi|eps|theta|rho)(?=_|\d|$)", lambda m: _GREEK[m[1]], name)


_OPERAND = re.compile(r"(?<=[·/×+−])( ?)(\{\d\})|(\{\d\})(?=²)")
"""An argument behind an arithmetic sign or squared: a negative one stands in parentheses there."""


def sentence(step: Step, k: int, to_mm: Callable[[float], float], unit: str = "mm",
             sizes: Mapping[str, float] | None = None) -> str:
    """One step as a sentence; ``sizes`` are those of each sort in its plan."""
    if sizes is None:
        sizes = _sizes([step], k)
    # What is taken from another plan has other positions there. A protractor knows no minutes: they are said in formulas, not
    # where an angle is laid off.
    args, drawn = () if step.rule.compute is take else step.args, step.rule.gives in ("point", "direction")
    shown = [_show(a, kind, k, to_mm, unit, sizes, drawn) for a, kind in zip(args, step.rule.takes, strict=False)]
    exact = _exact_angle(step, k)
    of_sort = 100.0 if step.rule.unit == "%" else sizes.get(_sort(step), 0.0)
    value = exact or _said(value_at(step, k), step.rule.gives, to_mm, unit, of_sort)

    def operand(m: re.Match[str]) -> str:
        space, field = m[1] or "", m[2] or m[3]
        return f"{space}({field})" if shown[int(field[1:-1])].startswith("−") else m[0]

    return _OPERAND.sub(operand, _wording(step, shown)).format(*shown, name=letter_of(step), value=value)


def _wording(step: Step, shown: list[str]) -> str:
    """The sentence before its arguments are put in; of lines drawn as perpendiculars the sign is taken off the arguments."""
    if step.say is not None:
        return step.say
    if step.rule is LINE_LINE and (across := tuple(i for i in (1, 3) if shown[i].startswith("⟂"))):
        for i in across:
            shown[i] = shown[i].removeprefix("⟂")
        return tr(_PERPENDICULAR[across])
    return tr(step.rule.wording)


def _show(arg: Any, kind: Kind, k: int, to_mm: Callable[[float], float], unit: str, sizes: Mapping[str, float],
          drawn: bool) -> str:
    if isinstance(arg, Step) and kind in ("point", "direction", "force"):
        return letter_of(arg)
    if not drawn and (exact := _exact_angle(arg, k)):
        return exact
    own = value_of(arg)
    of_sort = size([own], k) if np.asarray(own).dtype.kind in "ifc" else 0.0
    if isinstance(arg, Step):
        of_sort = max(of_sort, sizes.get(_sort(arg), 0.0))
    said = _said(value_at(arg, k), kind, to_mm, unit, of_sort)
    return f"{letter_of(arg)} ({said})" if isinstance(arg, Step) and kind == "vector" else said


def _exact_angle(arg: Any, k: int) -> str:
    """Degrees and minutes of an angle that a formula gives; empty for anything else, also for what is measured on the drawing."""
    if isinstance(arg, Step) and arg.rule.gives in ("angle", "inclination") and arg.rule.unit == "rad":
        value = float(value_at(arg, k))
        return degrees_and_minutes(value) if np.isfinite(value) else ""
    return ""


def _said(value: Any, kind: Kind, to_mm: Callable[[float], float], unit: str, of_sort: float) -> str:
    """A value with its unit; ``of_sort`` is the size of its sort, in the unit of the plan."""
    if np.ndim(value) or (isinstance(value, complex | np.complexfloating) and kind in ("point", "direction")):
        return ""
    if kind in ("length", "ordinate", "vector", "force", "angle", "inclination", "number") and not np.isfinite(value):
        return "—" if np.isnan(value) else "−∞" if np.real(value) < 0 else "∞"
    if kind in ("length", "ordinate", "vector"):
        real = to_mm(float(value) if kind == "ordinate" else abs(value))
        return f"{fixed(real, 1) if unit == 'mm' else number(real, kind=to_mm(of_sort))} {tr(UNITS.get(unit, unit))}"
    if kind == "force":
        return f"{fixed(abs(value), 1)} {tr('N')}"
    if kind == "angle":
        return f"{fixed(degrees(value) % 360, 1)}°"
    if kind == "inclination":
        return f"{fixed(degrees(value), 1)}°"
    return number(float(np.real(value)), kind=of_sort) if kind == "number" else ""
