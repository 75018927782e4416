"""Lengths of the links: found from conditions, or given and checked by stroke and speeds of the strokes."""

from __future__ import annotations

from math import pi
from typing import Any

from tmm_sheets.construction import expression
from tmm_sheets.construction.formula import letters, letters_of
from tmm_sheets.note.document import Symbol, Text
from tmm_sheets.note.phrases import Scope, words
from tmm_sheets.note.reader import NoteQuantity, Reader, symbol_of

NEAR = 1.0
"""Difference from what is asked, per cent, that a drawing does not show."""


def scope(r: Reader) -> Scope | None:
    """Formulas of the synthesis, the table of lengths, what the dead positions give; None where all is given and nothing stops."""
    variant = r.project.variant
    if variant.synthesis is None and r.project.cycle.strokes is None:
        return None
    found = Scope({"found": variant.synthesis is not None})
    items: list[dict[str, Any]] = []
    if variant.synthesis is not None:
        _ = r.project.synthesis.lengths
        plan = r.project.synthesis.plan
        for step in plan:
            said = r.formula(step)
            if said is not None and said.numbers is not None:
                items.append({"formula": said})
            elif step.name.endswith("′") and isinstance(step.value, float):
                items.append({"taken": Symbol(letters(symbol_of(step))), "value": r.of(step)})
        figure = r.pictures.figure("synthesis.sizes")
        if figure is not None:
            found.figures["sizes"] = figure
    found.fields["steps"] = items
    found.tables["lengths"] = _lengths(r)
    cycle = r.project.cycle
    if cycle.strokes is not None:
        s = cycle.strokes
        found.fields |= {
            "stroke": r.number(s.length, "m", "cycle.strokes"),
            "output": Symbol(letters(letters_of(s.output))),
            "strokes": True,
        }
        turn = (s.end - s.begin) % (2 * pi) if len(s.runs) else 0.0
        found.fields["equal"] = abs(turn - pi) <= 1e-3
        if 0 < turn < 2 * pi and abs(turn - pi) > 1e-3:
            a = expression.Argument(0)
            tree = expression.Operation("/", (a, expression.Operation("-", (expression.Constant(360.0), a))))
            degrees = turn * 180 / pi
            ratio = turn / (2 * pi - turn)
            found.formulas["ratio"] = r.written(
                "K", tree, [NoteQuantity("φ_{рх}", degrees, "deg", "dead-positions")], NoteQuantity("", ratio, "", "dead-positions")
            )
            found.fields["ratio"] = r.number(ratio, "", "dead-positions")
            found.fields["faster"] = r.number(1 / ratio, "", "dead-positions") if ratio < 1 else None
            asked = variant.cycle.coefficient if variant.cycle is not None else None
            if asked:
                found.fields["asked"] = r.number(float(asked), "", "cycle.coefficient")
                off = 100 * abs(ratio - float(asked)) / float(asked)
                found.fields |= {"off": r.number(off, "%", "dead-positions", digits=2), "near": off < NEAR}
                theta = expression.Constant(180.0) * (a - 1) / (a + 1)
                found.formulas["theta"] = r.written(
                    "θ",
                    theta,
                    [NoteQuantity("K", float(asked), "", "cycle.coefficient")],
                    NoteQuantity("", 180 * (float(asked) - 1) / (float(asked) + 1), "deg", "cycle.coefficient"),
                )
    return found


def _lengths(r: Reader) -> tuple[tuple[Text, ...], ...]:
    said = words(r.language)["kinematics"]
    rows: list[tuple[Text, ...]] = [tuple((h,) for h in said["sizes_head"])]
    for g in r.givens("m"):
        if g.symbol.startswith("l") and g.value:
            rows.append(((Symbol(letters(g.symbol)),), (r.number(g.value, "", g.step),)))
    return tuple(rows)
