"""Planetary reducer: ratio, sizes and speeds, conditions of assembly."""

from __future__ import annotations

from typing import Any

from tmm_sheets.construction.formula import letters
from tmm_sheets.note.document import Symbol, Text
from tmm_sheets.note.phrases import Scope, words
from tmm_sheets.note.reader import NoteQuantity, Reader
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
            "tiers": ", ".join(number(100 * t) for t in r.project.reducer.tiers),
            "least_teeth": r.number(table.least_teeth, "", "reducer.least_teeth"),
            "within": abs(off) <= 100 * table.tolerance + 1e-9,
        }
    _speeds(r, found)
    found.tables["sets"] = _sets(r)
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


def _speeds(r: Reader, found: Scope) -> None:
    """Angular velocities of the shafts from the speeds that are given in turns."""
    symbols = words(r.language)["symbols"]
    table: Any = r.project.variant.reducer
    for key in ("input_speed", "output_speed"):
        value = getattr(table, key)
        if value is not None:
            omega = NoteQuantity(symbols[f"reducer.{key}"], float(value), "rad/s", f"reducer.{key}")
            said = r.of_turns(f"reducer.{key}", omega.symbol.replace("ω", "n"), omega)
            if said is not None:
                found.formulas[key] = said


def _sets(r: Reader) -> tuple[tuple[Text, ...], ...]:
    """The sets of tooth numbers that the search found best, the chosen one first: ratio, its deviation, height of the reducer."""
    reducer = r.project.reducer
    said = words(r.language)["reducer"]
    names = reducer.teeth_names
    head: list[Text] = [(said["set"],), *((Symbol(letters(f"z_{{{n[1:]}}}")),) for n in names), (Symbol(letters("u")),)]
    rows: list[tuple[Text, ...]] = [(*head, (Symbol(letters("Δu")), ", %"), (said["height"],))]
    for i, (plan, teeth) in enumerate(zip(reducer.sets, (reducer.chosen, *reducer.runners_up), strict=True), 1):
        cells: list[Text] = [(str(i),), *((r.of(plan[n], unit_=""),) for n in names), (r.of(plan["u"], unit_=""),)]
        cells.append((r.number(100 * float(plan["u_deviation"].value), "", r.id(plan["u_deviation"]), digits=2, kind=1.0),))
        cells.append((r.number(1e3 * teeth.height, "", r.id(plan["u"])),))
        rows.append(tuple(cells))
    return tuple(rows)
