"""The record of a project as one JSON document; what it says is told in docs/record.md."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets import results, words
from tmm_sheets.construction import protocol
from tmm_sheets.construction.curve import Curve
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Step, value_at, value_of
from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.record import formulas, sheets, values
from tmm_sheets.record.results_map import leaves
from tmm_sheets.record.step_index import StepIndex

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.project import Project

_encoded = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode
MOST = 72
"""Most positions that are told in words: as many as a sheet shows."""
SCHEMA = 1
"""Version of the record; it may grow under it."""


def record(project: Project, numbers: Iterable[int] = ()) -> tuple[dict[str, Any], CannotBuild | None]:
    """The record of a project with some of its sheets, all unless told, and what could not be built of it.

    Raises
    ------
    CannotBuild
        when nothing of the project can be computed.
    """
    from tmm_sheets.sheets import sheet

    asked = list(numbers) or list(range(1, len(project.sheets) + 1))
    refused: dict[str, CannotBuild] = {}
    tree = results.told(project, None, refused=refused)
    attempt = sheet.attempt(project, asked, steps=True)
    scales: dict[str, Scale] = {}
    for composed in attempt.drawn.values():
        scales |= composed.scales
    behind = dict(leaves(tree))
    for told in behind.values():
        _ = getattr(told, "value", None)  # a plan that results come from is recorded, whether or not a sheet shows it
    book = book_of(project)
    lost = refused | attempt.refused
    found = {
        "schema": SCHEMA, "project": project.variant.project.name, "variant": project.variant.project.variant,
        "lang": words.paper(),
        "plans": [_plan(project, book, name) for name in book.plans],
        "rules": book.rules,
        "steps": _steps(book, scales),
        "results": dict(_results(behind, book)),
        "searches": [{"purpose": s.purpose, "plans": s.plans, "steps": s.steps} for s in project.searches],
        "sheets": [sheets.sheet(n, composed, book.steps) for n, composed in attempt.drawn.items()],
        **({"not_computed": {name: str(reason) for name, reason in lost.items()}} if lost else {}),
    }  # fmt: skip
    return found, together(lost, "recorded", others=True) if lost else None


def as_json(found: dict[str, Any]) -> str:
    """The document, a line for each plan, rule, step, result, frame and mark."""
    return _lines(found, 0)


def _lines(value: Any, level: int) -> str:
    if value and level < 2 and isinstance(value, dict):
        inner = (f"{_encoded(k)}: {_lines(v, level + 1)}" for k, v in value.items())
        return "{\n" + ",\n".join(inner) + "\n}"
    if value and level < 4 and isinstance(value, list) and isinstance(value[0], dict):
        return "[\n" + ",\n".join(_sheet(v, level) for v in value) + "\n]"
    return _encoded(value)


def _sheet(value: dict[str, Any], level: int) -> str:
    return _lines(value, level) if "marks" in value else _lines(value, 4)


def book_of(project: Project) -> StepIndex:
    """The plans of a project that are drawn or told, all their steps with them."""
    return StepIndex(plan for of_part in project.plans.values() for plan in (of_part or {}).values()
                if any(step.evaluated for step in (*plan, *plan.auxiliaries.values())))


def _plan(project: Project, book: StepIndex, name: str) -> dict[str, Any]:
    plan = book.plans[name]
    labels = plan.labels if len(plan.labels) > 1 else ()
    cycle = project.cycle if labels and project.variant.cycle is not None else None
    found: dict[str, Any] = {"id": name, "title": plan.title, "unit": plan.unit}
    if plan.pole is not None:
        found["pole"] = book.id(plan[plan.pole])
    found["positions"] = list(labels)
    if cycle is not None and labels == cycle.labels:
        found |= {"phi": values.written(cycle.phi), "closes": labels[0]}
    return found | {"steps": book.of[name]}


def _steps(book: StepIndex, scales: dict[str, Scale]) -> dict[str, Any]:
    said = {name: _Telling(plan, scales.get(plan.name)) for name, plan in book.plans.items()}
    return {key: _step(book, said[book.plan(step)], key, step) for key, step in book.steps.items()}


def _step(book: StepIndex, telling: _Telling, key: str, step: Step) -> dict[str, Any]:
    plan, value = telling.plan, step.value
    n = len(plan.labels)
    found: dict[str, Any] = {
        "plan": book.plan(step), "name": step.name, **({"symbol": step.symbol} if step.symbol else {}), "rule": book.rule(step),
        "kind": step.rule.gives, "unit": unit(step, plan), **values.shape(value, n),
        "args": [_argument(book, a, n) for a in step.args], "value": values.written(value),
    }  # fmt: skip
    return found | telling.told(step)


def _argument(book: StepIndex, a: Any, n: int) -> dict[str, Any]:
    step: Step | None = a if isinstance(a, Step) else getattr(a, "step", None)
    return values.given(a, n) if step is None else {"step": book.id(step)}


def unit(step: Step, plan: Plan) -> str:
    """Unit of a step: that of its rule, of its kind, or of its plan; empty for a direction and a bare ratio."""
    kind = step.rule.gives
    if step.rule.unit:
        return "" if step.rule.unit == "1" else step.rule.unit
    return {"angle": "rad", "inclination": "rad", "direction": "", "number": ""}.get(kind, plan.unit)


class _Telling:
    """Sentences, formulas and helper lines of the steps of a plan."""

    def __init__(self, plan: Plan, scale: Scale | None) -> None:
        self.plan = plan
        self.to_mm: Any = float if scale is None else scale.mm
        self.unit = plan.unit if scale is None else "mm"
        self.sizes = protocol.sizes_of(plan)

    def told(self, step: Step) -> dict[str, Any]:
        """What is said of a step, by the labels of the positions.

        Of one made of rows that are not over the positions it is said once, without a label; of more positions than any sheet shows
        and of nodes, which have no labels, only the first is told.
        """
        labels = self.plan.labels
        if len(labels) > MOST or not any(labels):
            labels = labels[:1]
        lengths = {np.shape(value_of(a))[0] for a in (*step.args, step) if _is_row(value_of(a))}
        if lengths - {len(self.plan.labels)}:
            labels = ("",)
        tree = formulas.tree_of(step)
        sentence, shown, lines = {}, {}, {}
        with np.errstate(invalid="ignore", divide="ignore"):
            for k, label in enumerate(labels):
                sentence[label] = protocol.sentence(step, k, self.to_mm, self.unit, self.sizes)
                if tree is not None and (text := formulas.numbers(step, tree, k)):
                    shown[label] = text
                if found := _helpers(step, k):
                    lines[label] = found
        told: dict[str, Any] = {"sentence": sentence}
        if tree is not None:
            told["formula"] = {"symbols": formulas.symbols(step, tree), "numbers": shown}
        return told | ({"helpers": lines} if lines else {})


def _is_row(value: Any) -> bool:
    return not isinstance(value, str | Curve) and np.ndim(value) > 0


def _helpers(step: Step, k: int) -> list[dict[str, Any]]:
    if step.rule.helpers is None:
        return []
    value = step.at(k)
    if step.rule.gives != "curve" and (np.ndim(value) or np.isnan(value)):
        return []
    return [_helper(h) for h in step.rule.helpers(tuple(value_at(a, k) for a in step.args), value)]


def _helper(h: Helper) -> dict[str, Any]:
    found = {"kind": h.kind, "a": values.written(complex(h.a))}
    if h.kind != "circle":
        found["b"] = values.written(complex(h.b))
    return found if h.kind == "line" else found | {"radius": values.written(float(h.radius))}


def _results(behind: Mapping[str, Any], book: StepIndex) -> Iterable[tuple[str, dict[str, Any]]]:
    for path, told in behind.items():
        if hasattr(told, "step") and told.step in book:
            part = {"part": told.part} if told.part else {}
            yield path, {"step": book.id(told.step), **part, **({"at": list(told.at)} if told.at else {})}
