"""Planetary reducer: ratio, sizes and speeds, conditions of assembly."""

from __future__ import annotations

from typing import Any

from tmm_sheets.note.phrases import Scope
from tmm_sheets.note.reader import Reader


def scope(r: Reader) -> Scope:
    """Formulas of the reducer's plans in their order, and its figures."""
    r.project.reducer.results()
    found = Scope()
    for name in ("reducer-ratio", "reducer-kinematics", "reducer-conditions"):
        items: list[dict[str, Any]] = []
        plan = r.plan(name)
        for step in plan or ():
            said = r.formula(step)
            if said is not None and said.numbers is not None:
                items.append({"formula": said, "name": step.name})
                found.formulas[f"{name.removeprefix('reducer-')}/{step.name}"] = said
            value = step.value
            if isinstance(value, int | float):
                found.fields[step.name] = r.of(step)
        found.fields[name.removeprefix("reducer-")] = items
    for name in ("scheme", "speeds"):
        figure = r.pictures.figure(f"reducer.{name}")
        if figure is not None:
            found.figures[name] = figure
    n = r.pictures.sheet_of("reducer.scheme")
    found.fields["sheet"] = str(n) if n is not None else ""
    return found
