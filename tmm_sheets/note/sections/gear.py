"""Gear pair: sizes of the first wheel in words, of both in a table, the picture of the mesh, quality."""

from __future__ import annotations

from typing import Any

from tmm_sheets.construction.step import Step
from tmm_sheets.note.document import Symbol, Text
from tmm_sheets.note.formula import letters
from tmm_sheets.note.phrases import Scope, words
from tmm_sheets.note.reader import Reader, symbol_of
from tmm_sheets.note.sections.forces import scale_text

BOTH = ("x", "r", "rb", "rw", "ra", "rf", "s", "s_chord", "p_chord", "rho_a", "alpha_a", "sa", "sa_m", "tau", "phi_alpha")


TALL = 300.0
"""Height of the graphs of sliding that a page takes, mm of the sheet: they go to infinity below."""


def scope(r: Reader) -> Scope:
    """Formulas by their steps' names, the table of both wheels, overlap three ways."""
    pair = r.project.gear
    pair.results()
    plan = r.plan("gear-geometry")
    found = Scope()
    for name in ("gear-geometry", "gear-engagement", "gear-greatest-sliding"):
        for step in r.plan(name) or ():
            said = r.formula(step)
            if said is not None:
                found.formulas[f"{name.removeprefix('gear-')}/{step.name}"] = said
    assert plan is not None
    for name in (
        "z1",
        "z2",
        "m",
        "x1",
        "x2",
        "a_w",
        "eps_alpha",
        "z_min",
        "alpha_w",
        "alpha",
        "ha",
        "c",
        "sa1",
        "sa2",
        "r1",
        "rw1",
    ):
        if name in plan:
            step = plan[name]
            found.fields[name] = r.angle(step.value, r.id(step)) if name.startswith("alpha") else r.of(step)
    x1, x2 = (float(plan[n].value) for n in ("x1", "x2"))
    found.fields |= {
        "shifted": bool(x1 or x2),
        "equal": x1 == -x2 and bool(x1),
        "thin": min(float(plan[f"sa_m{i}"].value) if f"sa_m{i}" in plan else 1.0 for i in (1, 2)) < 0.2,
        "from_reducer": str(getattr(r.project.variant.gear, "teeth", "")) == "reducer",
    }
    found.tables["wheels"] = _wheels(r, plan)
    _overlap(r, found)
    _sliding(r, found)
    scale = r.scales.get("gear-engagement")
    if scale is not None:
        found.fields["mu"] = scale_text(scale)
    found.fields["in_scale"] = (words(r.language)["phrases"]["in_scale"], *scale_text(scale)) if scale is not None else ""
    for name, picture, focus in (
        ("engagement", "gear.engagement", ("gear-involute-1", "gear-involute-2", "gear-engagement/N1N2")),
        ("mesh", "gear.mesh", ()),
        ("rack", "rack.generating", ()),
    ):
        figure = r.pictures.figure(picture, focus)
        if figure is not None:
            found.figures[name] = figure
    sliding = r.pictures.top("gear-sliding", TALL)
    if sliding is not None:
        found.figures["sliding"] = sliding
    n = r.pictures.sheet_of("gear.engagement")
    found.fields["sheet"] = str(n) if n is not None else ""
    return found


def _wheels(r: Reader, plan: Any) -> tuple[tuple[Text, ...], ...]:
    said = words(r.language)["gear"]
    rows: list[tuple[Text, ...]] = [
        ((said["parameter"],), (said["letter"],), (said["wheel"].format(n=1),), (said["wheel"].format(n=2),))
    ]
    for name in ("z", *BOTH):
        if f"{name}1" not in plan or f"{name}2" not in plan:
            continue
        one, two = plan[f"{name}1"], plan[f"{name}2"]
        meaning = said["sizes"].get(name, "")
        if not meaning:
            continue
        unit = r.unit_of(one)
        symbol = symbol_of(one)
        cells = tuple(_cell(r, s, unit) for s in (one, two))
        rows.append(
            (
                (meaning + (f", {r.unit(unit)}" if unit and unit != "rad" else ""),),
                (Symbol(letters(_without_digit(symbol))),),
                *cells,
            )
        )
    return tuple(rows)


def _cell(r: Reader, step: Step, unit: str) -> Text:
    return (r.angle(float(step.value), r.id(step)),) if unit == "rad" else (r.of(step, None, ""),)


def _without_digit(symbol: str) -> str:
    """The letter without the number of its wheel."""
    return symbol.replace("_{1}", "").replace("_1", "").replace("1}", "}")


def _overlap(r: Reader, found: Scope) -> None:
    """Coefficient of overlap by the line of action and by the angles of both wheels."""
    said = words(r.language)["gear"]
    geometry, drawn = r.plan("gear-geometry"), r.plan("gear-engagement")
    assert geometry is not None
    rows: list[tuple[Text, ...]] = [((said["way"],), r.head("ε_{α}"), (said["difference"],))]
    first = float(geometry["eps_alpha"].value)
    rows.append(((said["by_line"],), (r.of(geometry["eps_alpha"]),), ("–",)))
    for i, name in ((1, "eps1"), (2, "eps2")):
        if drawn is not None and name in drawn:
            value = float(drawn[name].value)
            difference = 100 * (value - first) / first
            rows.append(
                (
                    (said["by_angle"].format(n=i),),
                    (r.of(drawn[name]),),
                    (r.number(difference, "", r.id(drawn[name]), digits=2, kind=100.0),),
                )
            )
    found.tables["overlap"] = tuple(rows)


def _sliding(r: Reader, found: Scope) -> None:
    """Specific sliding along the line of action."""
    said = words(r.language)["gear"]
    plan = r.plan("gear-sliding")
    if plan is None:
        return
    rows: list[tuple[Text, ...]] = [
        ((said["division"],), r.head("y_{V1}", "mm"), r.head("y_{V2}", "mm"), r.head("θ_{1}"), r.head("θ_{2}"))
    ]
    for i, label in enumerate(plan.labels):
        cells: list[Text] = [(label,)]
        for name in ("yV1", "yV2", "theta1", "theta2"):
            value = float(plan[name].value[i])
            cells.append((r.number(value, "", r.id(plan[name]), label, kind=1.0),))
        rows.append(tuple(cells))
    found.tables["sliding"] = tuple(rows)
    worst = r.plan("gear-greatest-sliding")
    if worst is not None:
        for name in ("theta1", "theta2"):
            if name in worst:
                found.fields[f"{name}_greatest"] = r.of(worst[name])
