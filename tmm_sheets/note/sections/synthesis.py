"""Lengths of the links: found from conditions, or given and checked by stroke and speeds of the strokes."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, pi
from typing import Any

from tmm_sheets.construction import expression
from tmm_sheets.note.document import lettered
from tmm_sheets.note.reader import NoteQuantity, Reader, symbol_of

NEAR = 1.0
"""Difference from what is asked, per cent, that a drawing does not show."""


def fields(r: Reader) -> dict[str, Any] | None:
    """Formulas of the synthesis, the table of lengths, what the dead positions give; None where all is given and nothing stops."""
    synthesis, strokes = r.project.variant.synthesis, r.project.cycle.strokes
    if synthesis is None and strokes is None:
        return None
    head = tuple((h,) for h in r.words["kinematics"]["sizes_head"])
    return {
        "found": synthesis is not None,
        "steps": list(_steps(r)) if synthesis is not None else [],
        "lengths": (head, *(((lettered(g.symbol),), (r.number(g.value, "", g.step),)) for g in r.lengths())),
        "strokes": strokes is not None,
        **(_strokes(r, strokes) if strokes is not None else {}),
    }


def _steps(r: Reader) -> Iterator[dict[str, Any]]:
    """Formulas of the lengths one after another, and what is taken instead of a number that came out."""
    _ = r.project.synthesis.lengths
    for step in r.project.synthesis.plan:
        said = r.formula(step)
        if said is not None and said.numbers is not None:
            yield {"formula": said}
        elif step.name.endswith("′") and isinstance(step.value, float):
            yield {"taken": lettered(symbol_of(step)), "value": r.of(step)}


def _strokes(r: Reader, strokes: Any) -> dict[str, Any]:
    """The stroke, and the ratio of the times of both strokes beside the one that is asked."""
    turn = (strokes.end - strokes.begin) % (2 * pi) if len(strokes.runs) else 0.0
    equal = abs(turn - pi) <= 1e-3
    found = {"stroke": r.number(strokes.length, "m", "cycle.strokes"), "output": lettered(strokes.output), "equal": equal}
    if equal or not 0 < turn < 2 * pi:
        return found
    ratio = turn / (2 * pi - turn)
    a = expression.Argument(0)
    found |= {
        "K": r.written(
            "K",
            expression.Operation("/", (a, expression.Operation("-", (expression.Constant(360.0), a)))),
            [NoteQuantity("φ_{рх}", degrees(turn), "deg", step="dead-positions")],
            NoteQuantity("", ratio, "", step="dead-positions"),
        ),
        "ratio": r.number(ratio, "", "dead-positions"),
        "faster": r.number(1 / ratio, "", "dead-positions") if ratio < 1 else None,
    }
    cycle = r.project.variant.cycle
    if cycle is not None and cycle.coefficient:
        asked = float(cycle.coefficient)
        off = 100 * abs(ratio - asked) / asked
        found |= {
            "asked": r.number(asked, "", "cycle.coefficient"),
            "off": r.number(off, "%", "dead-positions", digits=2),
            "near": off < NEAR,
            "theta": r.written(
                "θ",
                expression.Constant(180.0) * (a - 1) / (a + 1),
                [NoteQuantity("K", asked, "", step="cycle.coefficient")],
                NoteQuantity("", 180 * (asked - 1) / (asked + 1), "deg", step="cycle.coefficient"),
            ),
        }
    return found
