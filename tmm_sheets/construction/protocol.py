"""The construction said in sentences: each step with its lengths in millimetres of the drawing."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from math import degrees
from typing import Any

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import fixed, number
from tmm_sheets.construction.step import Kind, Step, value_at


def sentences(plan: Plan, k: int, to_mm: Callable[[float], float], unit: str = "мм") -> Iterator[str]:
    """Sentences of the plan at position ``k``; ``to_mm`` turns a length of the plan into millimetres of paper.

    A plan that is not drawn has no millimetres: ``to_mm`` leaves its lengths as they are and ``unit`` names theirs.
    """
    for step in plan:
        said = sentence(step, k, to_mm, unit)
        segments = [f"|{name}{step.name}| = {_said(vector, 'vector', to_mm, unit)}" for name, vector in _segments(plan, step, k)]
        if segments:
            said += f" {'Отрезки' if len(segments) > 1 else 'Отрезок'} {', '.join(segments)}."
        yield said


def _segments(plan: Plan, step: Step, k: int) -> list[tuple[str, Any]]:
    """Segments of a velocity or acceleration plan that a step draws: where each begins, and its vector.

    A vector laid off from a point is measured from there; lines that meet give one segment each beside that from the pole.
    """
    if plan.pole is None or step.name == plan.pole or step.rule.gives not in ("point", "vector"):
        return []
    end = value_at(step, k)
    points = [a for a in step.args if isinstance(a, Step) and a.name in plan and a.rule.gives in ("point", "vector")]
    laid_off = step.rule.wording.startswith("От точки {0}") and points
    starts = points[:1] if laid_off else [plan[plan.pole], *(points if step.rule.name == "lines meet" else ())]
    return [(s.name, end - value_at(s, k)) for s in dict.fromkeys(starts)]


_GREEK = {"alpha": "α", "phi": "φ", "psi": "ψ", "eps": "ε", "theta": "θ", "rho": "ρ"}


def spoken(name: str) -> str:
    """Name of a step as it stands on the sheet: Greek letters instead of their names."""
    return re.sub(r"^(alpha|phi|psi|eps|theta|rho)(?=_|\d|$)", lambda m: _GREEK[m[1]], name)


def sentence(step: Step, k: int, to_mm: Callable[[float], float], unit: str = "мм") -> str:
    """One step as a sentence."""
    wording = step.say if step.say is not None else step.rule.wording
    shown = [_show(a, kind, k, to_mm, unit) for a, kind in zip(step.args, step.rule.takes, strict=False)]
    value = _said(value_at(step, k), step.rule.gives, to_mm, unit)
    said = wording.format(*shown, name=spoken(step.name), value=value)
    return said.replace("параллельно ⟂", "перпендикулярно ")


def _show(arg: Any, kind: Kind, k: int, to_mm: Callable[[float], float], unit: str) -> str:
    if isinstance(arg, Step) and kind in ("point", "direction", "force"):
        return spoken(arg.name)
    if isinstance(arg, Step) and kind == "vector":
        return f"{arg.name} ({_said(value_at(arg, k), kind, to_mm, unit)})"
    return _said(value_at(arg, k), kind, to_mm, unit)


def _said(value: Any, kind: Kind, to_mm: Callable[[float], float], unit: str) -> str:
    if np.ndim(value) or (isinstance(value, complex | np.complexfloating) and kind in ("point", "direction")):
        return ""
    if kind in ("length", "vector", "force", "angle", "inclination", "number") and not np.isfinite(value):
        return "∞" if np.isinf(value) else "—"
    if kind == "ordinate":
        return f"{fixed(to_mm(float(value)), 1)} мм" if unit == "мм" else f"{number(to_mm(float(value)))} {unit}"
    if kind in ("length", "vector"):
        return f"{fixed(to_mm(abs(value)), 1)} мм" if unit == "мм" else f"{number(to_mm(abs(value)))} {unit}"
    if kind == "force":
        return f"{fixed(abs(value), 1)} Н"
    if kind == "angle":
        return f"{fixed(degrees(value) % 360, 1)}°"
    if kind == "inclination":
        return f"{fixed(degrees(value), 1)}°"
    return number(float(np.real(value))) if kind == "number" else ""
