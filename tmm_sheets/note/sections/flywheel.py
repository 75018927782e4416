"""Flywheel: reduced moments, works, energy-mass diagram or Mertsalov's procedure, sizes of the wheel."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.note.document import Rows, ShownFormula, lettered
from tmm_sheets.note.reader import Column, NoteQuantity, Reader, scale_text
from tmm_sheets.numbers import is_zero

CLOSE = 5.0
"""Difference from the limit, per cent, that engineers allow."""
EVEN = 0.05
"""Share of the square of the angular velocity below which an angular acceleration changes no inertia force noticeably."""
DRAWN = 0.05
"""What no drawing shows, mm."""
SAFE = 30.0
"""Speed up to which a rim of cast iron is safe, m/s (000, 5.7)."""


def fields(r: Reader) -> dict[str, Any]:
    """What the reduction, the integration and the wheel give, the tables over the positions, the comparison with the limit."""
    fw, table = r.project.flywheel, r.project.variant.flywheel
    fw.results()
    drawn, mu = fw.driving_plan["M"], fw.scales.moment
    ordinate = NoteQuantity("y_{K}", float(np.real(drawn.value)) / mu.mu, "mm", step="driving-moment/dK")
    speed = r.step("flywheel-wheel/V")
    return {
        "label": r.label,
        "mertsalov": fw.method == "mertsalov",
        "needed": fw.needed,
        "given": fw.given,
        "delta": r.of(fw.delta) if fw.given else r.number(fw.unevenness, "", "flywheel.delta"),
        "rim": table is not None and table.form == "rim",
        "driving": r.checked("M_{д}" if fw.reduced.resisting else "M_{с}", lambda y, m: y * m,
                             [ordinate, NoteQuantity("μ_{M}", mu.mu, "N m/mm", step="scales.mu_M")], drawn),
        **{f"mu_{name}": scale_text(scale) for name, scale in vars(fw.scales).items() if hasattr(scale, "mu")},
        "pole": r.fixed(fw.pole, "mm", 1, "work/P"),
        "ab": r.of(fw.ab),
        "J_flywheel": r.of(fw.first_plan["J_м"]),
        "J_flywheel_limit": None if fw.given else r.of(fw.limit_plan["J_м∞"]),
        "letters": {"ab": r.words["flywheel"]["ab"]} if fw.method == "mertsalov" else {},
        "wheel": fw.wheel is not None,
        "slow": speed is not None and r.of(speed).value < SAFE,
        "iron": fw.cast_iron,
        "safe": r.number(SAFE, "m/s", "flywheel.safe", digits=2),
        "sheet": r.sheet("flywheel.wheel", "mertsalov.results", "flywheel.results"),
        "terms": _terms(r),
        "comparison": _comparison(r),
        **_reduction(r),
        **_accuracy(r),
        **_over_positions(r),
    }  # fmt: skip


def _reduction(r: Reader) -> dict[str, Any]:
    """Reduced moment and reduced moment of inertia at the position that is told, in the words of the field."""
    fw = r.project.flywheel
    at = fw.reduced.numbered
    omega = NoteQuantity("ω_{1}", fw.omega1, "rad/s", step="crank.speed")
    terms = [r.measured(_term(name), float(np.real(r.value(step))), "J", step) for name, step in at.terms.items()]
    moment = at.moment()
    power = r.quantity(moment, "ΣN", "W")
    power = replace(power, value=power.value * fw.omega1)
    own = ((name[2:], step) for name, step in at.plan.steps.items()
           if name.startswith("N_") and not name.startswith("N_G") and "(" not in name)
    return {
        "M": r.checked("M_{пр}", lambda p, w: p / w, [power, omega], moment),
        "J": _inertia(r, omega, terms) if terms else None,
        "powers": [{"power": r.of(step), "symbol": lettered(name), "force": not name.startswith("M")} for name, step in own
                   if not is_zero(float(np.real(r.value(step))), 1.0)],
    }


def _inertia(r: Reader, omega: NoteQuantity, terms: list[NoteQuantity]) -> ShownFormula:
    """The reduced moment of inertia from the doubled energies; their letters are told too, each with its unit."""
    units = {"m": "kg", "J": "kg*m2", "V": "m/s", "ω": "rad/s"}

    def total(w: Any, first: Any, *parts: Any) -> Any:
        return sum(parts, first) / w**2

    said = r.checked("J_{пр}", total, [omega, *terms], r.project.flywheel.reduced.numbered.inertia)
    letters = (markup for t in terms for markup in re.findall(r"[mJVω]_\{\w+\}|[mJVω]_\w", t.symbol))
    return replace(said, explained=(*said.explained, *((markup, r.unit(units[markup[0]])) for markup in letters)))


def _term(name: str) -> str:
    """Markup of a term of the kinetic energy: m2V_B² is m with the index 2 times V with B squared."""
    text = re.sub(r"^m(\d+)V_?(\w+)²$", r"m_{\1}V_{\2}^{2}", name)
    return re.sub(r"^J_?(\w+?)ω(\d+)²$", r"J_{\1}ω_{\2}^{2}", text)


def _accuracy(r: Reader) -> dict[str, Any]:
    """How far the construction is from its limit, and the works from those by the area."""
    fw = r.project.flywheel
    share = 100 * abs(fw.work_error)
    found = {
        "difference": r.number(abs(fw.difference_percent), "%", "flywheel-limit/разность", digits=2),
        "above": fw.difference_percent >= 0,
        "close": abs(fw.difference_percent) < CLOSE,
        "share": r.number(share, "%", "total-work/δA", digits=2),
        "coarse": share > CLOSE,
    }
    for name, key in (("∫M", "area"), ("ΔA", "closing")):
        if name in fw.work_plan:
            step = fw.work_plan[name]
            value = abs(float(np.real(step.value)))
            found |= {key: r.fixed(value, "mm", 1, r.id(step)), "exact_area": value < DRAWN}  # ΔA comes last
    return found


def _comparison(r: Reader) -> Rows:
    """The result of the construction beside its limit."""
    fw, said = r.project.flywheel, r.words["flywheel"]
    if fw.given:
        told = r.head("δ"), fw.unevenness, "flywheel-delta/δ", float(fw.limit_plan["δ∞"].value), "flywheel-limit/δ∞"
    else:
        told = r.head("J_{м}", "kg*m2"), fw.J_flywheel, "flywheel-inertia/J_м", fw.J_flywheel_converged, "flywheel-limit/J_м∞"
    of, drawn, step, limit, step_of_limit = told
    difference = r.number(fw.difference_percent, "", "flywheel-limit/разность", digits=2)
    return (
        tuple((said[name],) for name in ("quantity", "drawn", "limit", "difference")),
        (of, (r.number(drawn, "", step),), (r.number(limit, "", step_of_limit),), (difference,)),
    )


def _over_positions(r: Reader) -> dict[str, Any]:
    """Reduced moment, works, energy and reduced moment of inertia at the positions, and what the angular acceleration does."""
    fw, total = r.project.flywheel, r.project.flywheel.total_plan
    columns = [
        ("M_{пр}", "N*m", fw.M_reduced, fw.moment_plan["M_пр"]),
        ("A", "J", fw.work, total["A"]),
        ("A_{K}", "J", total["A_K"].value, total["A_K"]),
        ("ΔE", "J", fw.delta_E, total["E"]),
        ("J_{пр}", "kg*m2", fw.J_reduced, fw.inertia_plan["J_пр"]),
    ]
    found: dict[str, Any] = {}
    if "epsilon1" in fw.results():
        step = fw.position_acceleration["ε1"]
        values = np.real(np.atleast_1d(step.value))
        if len(values) >= len(fw.labels):
            columns.append(("ε_{1}", "rad/s2", values, step))
            ratio = float(np.nanmax(np.abs(values))) / fw.omega1**2
            found = {"unevenness": r.number(ratio, "", r.id(step), digits=2), "even": ratio < EVEN}
    shown = [Column(r.head(letter, unit), np.atleast_1d(values), r.id(step), np.nanmax(np.abs(values)))
             for letter, unit, values, step in columns]
    n = min(len(fw.labels), *(len(c.values) for c in shown))
    return found | {"works": r.over_positions(enumerate(fw.labels[:n]), shown)}


def _terms(r: Reader) -> Rows:
    """Terms of the reduced moment of inertia at the drawn positions; a single one is the moment itself."""
    every = (len(r.project.cycle.labels),)
    terms = [Column(r.head(_term(name), "J"), np.broadcast_to(step.value, every).real, r.id(step), np.max(np.abs(step.value)))
             for name, step in r.project.flywheel.reduced.numbered.terms.items()]
    return r.over_positions(r.project.cycle.drawn, terms) if len(terms) > 1 else ()
