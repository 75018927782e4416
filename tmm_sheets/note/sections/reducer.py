"""Planetary reducer: ratio, sizes and speeds, conditions of assembly."""

from __future__ import annotations

from typing import Any

from tmm_sheets.note.phrases import Scope
from tmm_sheets.note.reader import Reader
from tmm_sheets.numbers import number


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
    conditions = r.plan("reducer-conditions")
    if conditions is not None:
        coaxial, assembly, beside = (float(conditions[n].value) for n in ("coaxiality", "assembly", "neighbourhood"))
        whole = abs(assembly - round(assembly)) < 1e-9
        found.fields |= {"coaxial": abs(coaxial) < 1e-9, "assembles": whole, "apart": beside > 0}
        found.fields["met"] = all(found.fields[n] for n in ("coaxial", "assembles", "apart"))
        found.fields["quotient"] = r.of(conditions["assembly"])
    ratio, table = r.plan("reducer-ratio"), r.project.variant.reducer
    if table is not None and ratio is not None and "u_deviation" in ratio:
        off = 100 * float(ratio["u_deviation"].value)
        found.fields |= {
            "deviation": r.number(abs(off), "%", r.id(ratio["u_deviation"]), digits=2),
            "tolerance": r.number(100 * table.tolerance, "%", "reducer.tolerance", digits=2),
            "within": abs(off) <= 100 * table.tolerance + 1e-9,
        }
    reducer = r.project.reducer
    found.fields |= {"small_ratio": reducer.small_ratio, "least_ratio": number(reducer.scheme.least_simple)}
    found.fields["interferences"] = [
        {"planet": of.planet, "ring": of.ring, "teeth": of.teeth, "least": of.least, "avoidable": bool(of.least)}
        for of in reducer.interferences
    ]
    found.fields["interferes"] = bool(reducer.interferences)
    for name in ("scheme", "speeds"):
        figure = r.pictures.figure(f"reducer.{name}")
        if figure is not None:
            found.figures[name] = figure
    n = r.pictures.sheet_of("reducer.scheme")
    found.fields["sheet"] = str(n) if n is not None else ""
    return found
