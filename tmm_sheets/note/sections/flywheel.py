"""Flywheel: reduced moments, works, energy-mass diagram or Mertsalov's procedure, sizes of the wheel."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.construction.formula import letters, letters_of
from tmm_sheets.construction.step import value_at
from tmm_sheets.note.document import Symbol, Text
from tmm_sheets.note.phrases import Scope, words
from tmm_sheets.note.reader import NoteQuantity, Reader
from tmm_sheets.note.sections.forces import scale_text
from tmm_sheets.numbers import is_zero

CLOSE = 5.0
"""Difference from the limit, per cent, that engineers allow."""
EVEN = 0.05
"""Share of the square of the angular velocity below which an angular acceleration changes no inertia force noticeably."""
DRAWN = 0.05
"""What no drawing shows, mm."""
SAFE = 30.0
"""Speed up to which a rim of cast iron is safe, m/s (000, 5.7)."""
PLANS = (
    "reduced-moment",
    "driving-moment",
    "total-work",
    "reduced-inertia",
    "energy-mass",
    "first-energy",
    "flywheel-given",
    "flywheel-inertia",
    "flywheel-delta",
    "drive-power",
    "flywheel-limit",
    "flywheel-wheel",
    "crank-speed",
    "motor-check",
    "crank-acceleration",
    "work",
)


def scope(r: Reader) -> Scope:
    """Formulas, tables and figures of the flywheel."""
    fw = r.project.flywheel
    found = Scope(
        {
            "label": r.label,
            "mertsalov": fw.method == "mertsalov",
            "resisting": fw.reduced.resisting,
            "needed": fw.needed,
            "given": fw.given,
            "delta": r.of(fw.delta) if fw.given else r.number(fw.unevenness, "", "flywheel.delta"),
            "rim": r.project.variant.flywheel is not None and r.project.variant.flywheel.form == "rim",
        }
    )
    fw.results()
    for name in PLANS:
        plan = r.plan(name)
        for step in plan or ():
            said = r.formula(step, as_unit="rad/s2" if step.name == "ε1" else None)
            if said is not None:
                found.formulas[f"{name}/{step.name}"] = said
    _reduction(r, found)
    drawn = fw.driving_plan["M"]
    mu = fw.scales.moment
    constant = float(np.real(drawn.value))
    ordinate = NoteQuantity("y_{K}", constant / mu.mu, "mm", "driving-moment/dK")
    found.formulas["driving"] = r.checked(
        "M_{д}" if fw.reduced.resisting else "M_{с}",
        lambda y, m: y * m,
        [ordinate, NoteQuantity("μ_{M}", mu.mu, "N m/mm", "scales.mu_M")],
        drawn,
    )
    for name, scale in vars(fw.scales).items():
        if hasattr(scale, "mu"):
            found.fields[f"mu_{name}"] = scale_text(scale)
    found.fields["pole"] = r.fixed(fw.pole, "mm", 1, "work/P")
    _results(r, found)
    _tables(r, found)
    for name in ("force_graph", "moments", "works", "total_work", "inertia", "wheel"):
        figure = r.pictures.figure(f"flywheel.{name}")
        if figure is not None:
            found.figures[name] = figure
    diagram = r.pictures.figure(
        "energy-mass", focus=("curve", "energy-mass/points", "energy-mass/a", "energy-mass/b", "energy-mass/ab")
    )
    if diagram is not None:
        found.figures["energy_mass"] = diagram
    for i, figure in enumerate(r.pictures.parts("mertsalov.column")):
        found.fields.setdefault("column", []).append({"column_part": figure, "nth": str(i + 1)})
    n = r.pictures.sheet_of("flywheel.wheel") or r.pictures.sheet_of("mertsalov.results") or r.pictures.sheet_of("flywheel.results")
    found.fields["sheet"] = str(n) if n is not None else ""
    return found


def _reduction(r: Reader, found: Scope) -> None:
    """Reduced moment and reduced moment of inertia at the position that is told, in the words of the field."""
    fw = r.project.flywheel
    at = fw.reduced.numbered
    plan = at.plan
    omega = NoteQuantity("ω_{1}", fw.omega1, "rad/s", "crank.speed")
    terms: list[NoteQuantity] = []
    for name, step in at.terms.items():
        value = float(np.real(value_at(step, r.at(step, None))))
        terms.append(NoteQuantity(_term(name), value, "J", r.id(step), r.label))
    inertia = at.inertia
    if terms:

        def total(w: Any, *parts: Any) -> Any:
            out = parts[0]
            for p in parts[1:]:
                out = out + p
            return out / w**2

        said = r.checked("J_{пр}", total, [omega, *terms], inertia)
        found.formulas["J"] = replace(said, explained=(*said.explained, *(x for t in terms for x in _letters_of_term(r, t.symbol))))
    for name, step in plan.steps.items():
        own = name.startswith("N_") and not name.startswith("N_G") and "(" not in name
        if own and not is_zero(float(np.real(value_at(step, r.at(step, None)))), 1.0):
            found.fields.setdefault("powers", []).append(
                {"power": r.of(step), "symbol": Symbol(letters(letters_of(name[2:]))), "force": not name.startswith("N_M")}
            )
    moment = at.moment()
    n = r.of(moment)
    power = NoteQuantity("ΣN", n.value * fw.omega1, "W", r.id(moment), n.position)
    found.formulas["M"] = r.checked("M_{пр}", lambda p, w: p / w, [power, omega], moment)


def _term(name: str) -> str:
    """Markup of a term of the kinetic energy: m2V_B² is m with the index 2 times V with B squared."""
    text = re.sub(r"^m(\d+)V_?(\w+)²$", r"m_{\1}V_{\2}^{2}", name)
    text = re.sub(r"^J_?(\w+?)ω(\d+)²$", r"J_{\1}ω_{\2}^{2}", text)
    return text


def _letters_of_term(r: Reader, term: str) -> Iterator[tuple[str, str]]:
    """Letters of a term of the kinetic energy, each with its unit."""
    units = {"m": "kg", "J": "kg*m2", "V": "m/s", "ω": "rad/s"}
    for markup in re.findall(r"[mJVω]_\{\w+\}|[mJVω]_\w", term):
        yield markup, r.unit(units[markup[0]])


def _results(r: Reader, found: Scope) -> None:
    fw = r.project.flywheel
    for name, step in (("ab", fw.ab), ("M_constant", fw.driving_plan["M"]), ("J_flywheel", fw.first_plan["J_м"])):
        found.fields[name] = r.of(step)
    if not fw.given:
        found.fields["J_flywheel_limit"] = r.of(fw.limit_plan["J_м∞"])
    found.fields["difference"] = r.number(abs(fw.difference_percent), "%", "flywheel-limit/разность", digits=2)
    found.fields |= {"above": fw.difference_percent >= 0, "close": abs(fw.difference_percent) < CLOSE,
                     "share": r.number(100 * abs(fw.work_error), "%", "total-work/δA", digits=2),
                     "coarse": 100 * abs(fw.work_error) > CLOSE}
    if fw.method == "mertsalov":
        found.letters["ab"] = words(r.language)["flywheel"]["ab"]
    work = fw.work_plan
    for name in ("∫M", "ΔA"):
        if name in work:
            value = float(np.real(work[name].value))
            if name == "ΔA":
                found.fields["exact_area"] = abs(value) < DRAWN
            found.fields["closing" if name == "ΔA" else "area"] = r.fixed(abs(value), "mm", 1, r.id(work[name]))
    wheel = fw.wheel
    if wheel is not None:
        for name in ("D", "B", "H", "m", "V"):
            plan = r.plan("flywheel-wheel")
            if plan is not None and name in plan:
                found.fields[f"wheel_{name}"] = r.of(plan[name])
    found.fields["wheel"] = wheel is not None
    speed = found.fields.get("wheel_V")
    found.fields |= {"slow": speed is not None and speed.value < SAFE, "iron": fw.cast_iron,
                     "safe": r.number(SAFE, "m/s", "flywheel.safe", digits=2)}
    found.tables["comparison"] = (
        (
            (words(r.language)["flywheel"]["quantity"],),
            (words(r.language)["flywheel"]["drawn"],),
            (words(r.language)["flywheel"]["limit"],),
            (words(r.language)["flywheel"]["difference"],),
        ),
        (
            *(((*r.head("δ", ""),), (r.number(fw.unevenness, "", "flywheel-delta/δ"),),
               (r.number(float(fw.limit_plan["δ∞"].value), "", "flywheel-limit/δ∞"),)) if fw.given else
              ((*r.head("J_{м}", "kg*m2"),), (r.number(fw.J_flywheel, "", "flywheel-inertia/J_м"),),
               (r.number(fw.J_flywheel_converged, "", "flywheel-limit/J_м∞"),))),
            (r.number(fw.difference_percent, "", "flywheel-limit/разность", digits=2),),
        ),
    )


def _tables(r: Reader, found: Scope) -> None:
    """Reduced moment, works, energy and reduced moment of inertia at the positions."""
    fw = r.project.flywheel
    said = words(r.language)
    total = fw.total_plan
    labels = list(fw.labels)
    columns: list[tuple[str, str, Any, str]] = [
        ("M_{пр}", "N*m", fw.M_reduced, r.id(fw.moment_plan["M_пр"])),
        ("A", "J", fw.work, r.id(total["A"])),
        ("A_{K}", "J", total["A_K"].value, r.id(total["A_K"])),
        ("ΔE", "J", fw.delta_E, r.id(total["E"])),
        ("J_{пр}", "kg*m2", fw.J_reduced, r.id(fw.inertia_plan["J_пр"])),
    ]
    if "epsilon1" in fw.results():
        step = fw.position_acceleration["ε1"]
        values = np.real(np.atleast_1d(step.value))
        if len(values) >= len(labels):
            columns.append(("ε_{1}", "rad/s2", values, r.id(step)))
            ratio = float(np.nanmax(np.abs(values))) / fw.omega1**2
            found.fields |= {"unevenness": r.number(ratio, "", r.id(step), digits=2), "even": ratio < EVEN}
    n = min(len(labels), *(len(np.atleast_1d(v)) for _, _, v, _ in columns))
    rows: list[tuple[Text, ...]] = [((said["position"],), *(r.head(s, u) for s, u, _, _ in columns))]
    for i in range(n):
        cells: list[Text] = [(labels[i],)]
        for _, _, values, where in columns:
            cells.append((r.number(float(values[i]), "", where, labels[i], kind=float(np.nanmax(np.abs(values)))),))
        rows.append(tuple(cells))
    found.tables["works"] = tuple(rows)
    at = fw.reduced.numbered
    terms = {name: np.broadcast_to(np.real(step.value), (len(r.project.cycle.labels),)) for name, step in at.terms.items()}
    if len(terms) > 1:
        head: list[Text] = [(said["position"],), *(r.head(_term(name), "J") for name in terms)]
        rows = [tuple(head)]
        for i, label in r.project.cycle.drawn:
            rows.append(
                (
                    (label,),
                    *(
                        (r.number(float(v[i]), "", r.id(at.terms[name]), label, kind=float(np.max(np.abs(v)))),)
                        for name, v in terms.items()
                    ),
                )
            )
        found.tables["terms"] = tuple(rows)
