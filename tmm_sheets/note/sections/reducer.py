"""Planetary reducer: ratio, sizes and speeds, conditions of assembly."""

from __future__ import annotations

from typing import Any

from tmm_sheets.note.document import Rows, ShownFormula, lettered
from tmm_sheets.note.reader import NoteQuantity, Reader
from tmm_sheets.numbers import number


def fields(r: Reader) -> dict[str, Any]:
    """Whether the conditions are met, what the search allowed and found, what interferes."""
    reducer, table = r.project.reducer, r.project.variant.reducer
    reducer.results()
    found: dict[str, Any] = {key: _speed(r, key) for key in ("input_speed", "output_speed")} | {
        "sets": _sets(r),
        "small_ratio": reducer.small_ratio,
        "least_ratio": number(reducer.scheme.least_simple),
        "interferences": [
            {"planet": of.planet, "ring": of.ring, "teeth": of.teeth, "least": of.least, "avoidable": bool(of.least)}
            for of in reducer.interferences
        ],
        "interferes": bool(reducer.interferences),
        "sheet": r.sheet("reducer.scheme"),
    }
    conditions = r.plan("reducer-conditions")
    if conditions is not None:
        coaxial, assembly, beside = (float(conditions[n].value) for n in ("coaxiality", "assembly", "neighbourhood"))
        found |= {"coaxial": abs(coaxial) < 1e-9, "assembles": abs(assembly - round(assembly)) < 1e-9, "apart": beside > 0}
        found["met"] = found["coaxial"] and found["assembles"] and found["apart"]
        found["quotient"] = r.of(conditions["assembly"])
    deviation = r.step("reducer-ratio/u_deviation")
    if table is not None and deviation is not None:
        off = 100 * float(deviation.value)
        found |= {
            "deviation": r.number(abs(off), "%", r.id(deviation), digits=2),
            "tolerance": r.number(100 * table.tolerance, "%", "reducer.tolerance", digits=2),
            "tiers": ", ".join(number(100 * t) for t in reducer.tiers),
            "least_teeth": r.number(table.least_teeth, "", "reducer.least_teeth"),
            "within": abs(off) <= 100 * table.tolerance + 1e-9,
        }
    return found


def _speed(r: Reader, key: str) -> ShownFormula | None:
    """Angular velocity of a shaft from its speed, where that is given in turns."""
    value = getattr(r.project.variant.reducer, key)
    if value is None:
        return None
    path = f"reducer.{key}"
    letter = r.words["symbols"][path]
    return r.of_turns(path, letter.replace("ω", "n"), NoteQuantity(letter, float(value), "rad/s", step=path))


def _sets(r: Reader) -> Rows:
    """The sets of tooth numbers that the search found best, the chosen one first: ratio, its deviation, height of the reducer."""
    reducer, said = r.project.reducer, r.words["reducer"]
    names = reducer.teeth_names
    rows = [((said["set"],), *((lettered(f"z_{{{n[1:]}}}"),) for n in names), (lettered("u"),), (lettered("Δu"), ", %"),
             (said["height"],))]  # fmt: skip
    for i, (plan, teeth) in enumerate(zip(reducer.sets, (reducer.chosen, *reducer.runners_up), strict=True), 1):
        off = plan["u_deviation"]
        rows.append(((str(i),), *((r.of(plan[n], ""),) for n in (*names, "u")),
                     (r.number(100 * float(off.value), "", r.id(off), digits=2, kind=1.0),),
                     (r.number(1e3 * teeth.height, "", r.id(plan["u"])),)))  # fmt: skip
    return tuple(rows)
