"""Gear train: sizes, equations of Willis with numbers, the speeds of all links, picture and plan of the velocities."""

from __future__ import annotations

from math import pi

from tmm_sheets.construction import expression
from tmm_sheets.construction.formula import letters
from tmm_sheets.construction.step import Step
from tmm_sheets.note.document import Symbol, Text
from tmm_sheets.note.phrases import Scope, ShownFormula, words
from tmm_sheets.note.reader import Reader


def _formula(r: Reader, step: Step) -> ShownFormula | None:
    """Formula of a step with its numbers; None for what is given."""
    if step.rule.name == "given speed":
        return None
    if step.rule.name == "speed on the same shaft":
        return r.written(r.letters_of(step), expression.Argument(0), [r.quantity(step.args[0])], r.quantity(step))
    found = r.formula(step)
    return found if found is not None and found.numbers is not None else None


def scope(r: Reader) -> Scope:
    """Formulas of the train's kinematics in the order in which its speeds are found, its table and its figures."""
    train, plan = r.project.train, r.project.train.kinematics
    whole = [(step.rule.unit, formula) for step in plan if (formula := _formula(r, step)) is not None]
    driving = [train.link(name) for name in train.given if not train.stands(name)]
    planets = {train.link(m.planet) for m in train.meshes if m.carrier}
    found = Scope({
        "sizes": [{"formula": formula} for unit, formula in whole if unit == "mm"],
        "willis": [{"formula": formula} for unit, formula in whole if unit != "mm"],
        "carriers": any(m.carrier for m in train.meshes),
        "closed": any(step.rule.name == "speed by all equations of Willis" for step in plan),
        "mobility": r.number(len(driving), "", "train.speeds"),
        "sheet": str(r.pictures.sheet_of("train.scheme") or ""),
    })
    driven = [step for step in plan if step.name.startswith("n") and float(step.value)
              and train.link(step.name[1:]) not in (*driving, *planets)]
    if driven:
        found.fields |= {"output": Symbol(letters(r.letters_of(driven[-1]))), "output_speed": r.of(driven[-1], unit_="rpm")}
    if driven and len(driving) == 1:
        one, two = (r.quantity(step, unit_="rpm") for step in (plan[f"n{driving[0]}"], driven[-1]))
        ratio = expression.Operation("/", (expression.Argument(0), expression.Argument(1)))
        name = f"i_{{{driving[0]},{driven[-1].name[1:]}}}"
        found.formulas["ratio"] = r.written(name, ratio, [one, two], type(one)("", one.value / two.value, "", one.step))
        found.fields["ratio"] = r.number(one.value / two.value, "", one.step)
    told = words(r.language)["train"]
    rows: list[tuple[Text, ...]] = [((told["link"],), (told["teeth"],), r.head("n", "rpm"), r.head("ω", "rad/s"))]
    for name in train.names:
        speed = plan[f"n{name}"]
        teeth: Text = (r.of(plan[f"z{name}"], unit_=""),) if f"z{name}" in plan else ("–",)
        omega = r.number(float(speed.value) * pi / 30, "", r.id(speed))
        rows.append(((Symbol(letters(name)),), teeth, (r.of(speed, unit_=""),), (omega,)))
    found.tables["speeds"] = tuple(rows)
    found.figures |= {name: figure for name in ("scheme", "speeds") if (figure := r.pictures.figure(f"train.{name}")) is not None}
    return found
