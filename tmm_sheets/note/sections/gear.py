"""Gear pair: sizes of the first wheel in words, of both in a table, the picture of the mesh, quality."""

from __future__ import annotations

from typing import Any

from tmm_sheets.construction.formula import letters
from tmm_sheets.construction.step import Step
from tmm_sheets.note.document import Symbol, Text
from tmm_sheets.note.phrases import Scope, words
from tmm_sheets.note.reader import Reader, symbol_of
from tmm_sheets.note.sections.forces import scale_text

BOTH = ("x", "r", "rb", "rw", "ra", "rf", "s", "s_chord", "p_chord", "rho_a", "alpha_a", "sa", "sa_m", "tau", "phi_alpha")


ALIKE = 0.05
"""Share by which specific slidings differ at least, for one tooth to wear faster."""
SAME = 1.0
"""Difference of the contact ratios, per cent, that the accuracy of the drawing explains."""
TALL = 300.0
"""Height of the graphs of sliding that a page takes, mm of the sheet: they go to infinity below."""


ENGAGED = ("gear-involute-1", "gear-involute-2", "gear-tooth-1", "gear-tooth-2", *(
    f"gear-engagement/{name}" for name in ("a1", "b1", "a2", "b2", "alpha_w", "N1", "N2", "B")))  # fmt: skip
"""What is to be seen where the picture of the engagement is too large to be read as a whole: the teeth that touch."""


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
    wheels = pair.wheels
    undercut = [w for w in wheels if not w.ring and (
        w.rack.undercut if pair.profile == "rack" else w.shift < w.least_shift - 5e-5)]
    found.fields |= {
        "shifted": bool(x1 or x2),
        "thin": min(float(plan[f"sa_m{i}"].value) if f"sa_m{i}" in plan else 1.0 for i in (1, 2)) < 0.2,
        "undercut": bool(undercut),
        "rack": pair.profile == "rack",
        "radial": any(w.rf < w.rb for w in wheels),
        "pole": abs(wheels[1].rw + (-wheels[0].rw if pair.internal else wheels[0].rw) - pair.a_w) < 1e-9 * pair.a_w,
        "warnings": [{"warning": text} for text in pair.warnings],
    }
    found.tables["wheels"] = _wheels(r, plan)
    _overlap(r, found)
    _sliding(r, found)
    scale = r.scales.get("gear-engagement")
    if scale is not None:
        found.fields["mu"] = scale_text(scale)
    found.fields["in_scale"] = (words(r.language)["phrases"]["in_scale"], *scale_text(scale)) if scale is not None else ""
    pictures = [("engagement", "gear.engagement", ENGAGED), ("mesh", "gear.mesh", ())]
    if pair.profile == "rack":  # of a pair with fillets the note speaks of no tool; the sheet shows it
        pictures.append(("rack", "rack.generating", ()))
    for name, picture, focus in pictures:
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
    worst = 0.0
    for i, name in ((1, "eps1"), (2, "eps2")):
        if drawn is not None and name in drawn:
            value = float(drawn[name].value)
            difference = 100 * (value - first) / first
            worst = max(worst, abs(difference))
            rows.append(
                (
                    (said["by_angle"].format(n=i),),
                    (r.of(drawn[name]),),
                    (r.number(difference, "", r.id(drawn[name]), digits=2, kind=100.0),),
                )
            )
    found.tables["overlap"] = tuple(rows)
    found.fields |= {"agree": worst < SAME, "overlaps": first > 1.0}


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
        sizes = {i: abs(float(worst[f"theta{i}"].value)) for i in (1, 2) if f"theta{i}" in worst}
        for i in sizes:
            found.fields[f"theta{i}_greatest"] = r.of(worst[f"theta{i}"])
        if len(sizes) == 2:
            more = max(sizes, key=lambda i: sizes[i])
            alike = abs(sizes[1] - sizes[2]) < ALIKE * sizes[more]
            found.fields |= {"worse": "" if alike else str(more), "slides": True}
