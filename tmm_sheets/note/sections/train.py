"""Gear train: sizes, equations of Willis with numbers, the speeds of all links, picture and plan of the velocities."""

from __future__ import annotations

from math import pi
from typing import Any

from tmm_sheets.construction import expression
from tmm_sheets.construction.step import Step
from tmm_sheets.note.document import Rows, ShownFormula, lettered
from tmm_sheets.note.reader import NoteQuantity, Reader


def fields(r: Reader) -> dict[str, Any]:
    """Formulas of the train's kinematics in the order in which its speeds are found, and its table."""
    train, plan = r.project.train, r.project.train.kinematics
    whole = [(step.rule.unit, formula) for step in plan if (formula := _formula(r, step)) is not None]
    driving = [train.link(name) for name in train.given if not train.stands(name)]
    planets = {train.link(m.planet) for m in train.meshes if m.carrier}
    driven = [step for step in plan if step.name.startswith("n") and float(step.value)
              and train.link(step.name[1:]) not in (*driving, *planets)]
    found: dict[str, Any] = {
        "sizes": [{"formula": formula} for unit, formula in whole if unit == "mm"],
        "willis": [{"formula": formula} for unit, formula in whole if unit != "mm"],
        "carriers": any(m.carrier for m in train.meshes),
        "closed": any(step.rule.name == "speed by all equations of Willis" for step in plan),
        "mobility": r.number(len(driving), "", "train.speeds"),
        "sheet": r.sheet("train.scheme"),
        "speeds": _speeds(r),
    }
    if driven:
        found |= {"output": lettered(r.letters_of(driven[-1])), "output_speed": r.of(driven[-1], "rpm")}
    if driven and len(driving) == 1:
        one, two = (r.quantity(step, unit="rpm") for step in (plan[f"n{driving[0]}"], driven[-1]))
        ratio = expression.Operation("/", (expression.Argument(0), expression.Argument(1)))
        name = f"i_{{{driving[0]},{driven[-1].name[1:]}}}"
        found["ratio"] = r.written(name, ratio, [one, two], NoteQuantity("", one.value / two.value, "", step=one.step))
    return found


def _formula(r: Reader, step: Step) -> ShownFormula | None:
    """Formula of a step with its numbers; None for what is given."""
    if step.rule.name == "given speed":
        return None
    if step.rule.name == "speed on the same shaft":
        return r.written(r.letters_of(step), expression.Argument(0), [r.quantity(step.args[0])], r.quantity(step))
    found = r.formula(step)
    return found if found is not None and found.numbers is not None else None


def _speeds(r: Reader) -> Rows:
    """Teeth and speeds of the links."""
    train, plan, told = r.project.train, r.project.train.kinematics, r.words["train"]
    rows = [((told["link"],), (told["teeth"],), r.head("n", "rpm"), r.head("ω", "rad/s"))]
    for name in train.names:
        speed = plan[f"n{name}"]
        teeth = r.of(plan[f"z{name}"], "") if f"z{name}" in plan else "–"
        rows.append(((lettered(name),), (teeth,), (r.of(speed, ""),), (r.number(float(speed.value) * pi / 30, "", r.id(speed)),)))
    return tuple(rows)
