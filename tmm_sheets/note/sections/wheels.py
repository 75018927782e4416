"""Wheels and cams: a gear pair, a planetary reducer, a train, a cam, the flywheel; sizes, tables and what is true of each."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from math import pi, radians
from typing import Any

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.equation import tree_of_step
from tmm_sheets.construction.step import Step
from tmm_sheets.note.document import Rows, ShownFormula, Text, lettered
from tmm_sheets.note.reader import Column, NoteQuantity, Reader, scale_text, symbol_of
from tmm_sheets.numbers import is_zero, number

# --- gear pair ----------------------------------------------------------------------------------------------------------------

BOTH = ("z", "x", "r", "rb", "rw", "ra", "rf", "s", "s_chord", "p_chord", "rho_a", "alpha_a", "sa", "tau", "phi_alpha")
"""Sizes of both wheels in the order of their table."""
ALIKE = 0.05
"""Share by which specific slidings differ at least, for one tooth to wear faster."""
SAME = 1.0
"""Difference of the contact ratios, per cent, that the accuracy of the drawing explains."""
THIN = 0.2
"""Least thickness of a tooth at its tip in modules."""


def gear_fields(r: Reader) -> dict[str, Any]:
    """What is true of the pair, the table of both wheels, overlap three ways, the sliding."""
    pair = r.project.gear
    pair.results()
    plan: Any = r.plan("gear-geometry")
    wheels = pair.wheels
    scale, rack = r.scale("gear-engagement"), pair.profile == "rack"
    return {
        "shifted": any(float(plan[n].value) for n in ("x1", "x2")),
        "thin": any(float(plan[n].value) < THIN for n in ("sa_m1", "sa_m2") if n in plan),
        "undercut": any(w.rack.undercut if rack else w.shift < w.least_shift - 5e-5 for w in wheels if not w.ring),
        "rack": rack,
        "radial": any(w.rf < w.rb for w in wheels),
        "pole": abs(wheels[1].rw + (-wheels[0].rw if pair.internal else wheels[0].rw) - pair.a_w) < 1e-9 * pair.a_w,
        "warnings": [{"warning": text} for text in pair.warnings],
        "wheels": _wheels(r, plan),
        "in_scale": (r.words["phrases"]["in_scale"], *scale) if scale is not None else "",
        "sheet": r.sheet("gear.engagement"),
        **_overlap(r),
        **_sliding(r),
    }


def _wheels(r: Reader, plan: Any) -> Rows:
    said = r.words["gear"]
    rows: list[tuple[Text, ...]] = [
        ((said["parameter"],), (said["letter"],), (said["wheel"].format(n=1),), (said["wheel"].format(n=2),))]
    for name in BOTH:
        if name in said["sizes"] and f"{name}1" in plan and f"{name}2" in plan:
            one, two = plan[f"{name}1"], plan[f"{name}2"]
            unit = r.unit_of(one)
            symbol = symbol_of(one).replace("_{1}", "").replace("_1", "").replace("1}", "}")  # without the number of the wheel
            cells = [r.angle(float(s.value), r.id(s)) if unit == "rad" else r.of(s, "") for s in (one, two)]
            named = said["sizes"][name] + (f", {r.unit(unit)}" if unit and unit != "rad" else "")
            rows.append(((named,), (lettered(symbol),), *((cell,) for cell in cells)))
    return tuple(rows)


def _overlap(r: Reader) -> dict[str, Any]:
    """Contact ratio by the line of action and by the angles of both wheels."""
    said = r.words["gear"]
    by_line: Any = r.step("gear-geometry/eps_alpha")
    first, worst = float(by_line.value), 0.0
    rows = [((said["way"],), r.head("ε_{α}"), (said["difference"],)), ((said["by_line"],), (r.of(by_line),), ("–",))]
    for i in (1, 2):
        step = r.step(f"gear-engagement/eps{i}")
        if step is not None:
            off = 100 * (float(step.value) - first) / first
            worst = max(worst, abs(off))
            rows.append(((said["by_angle"].format(n=i),), (r.of(step),), (r.number(off, "", r.id(step), digits=2, kind=100.0),)))
    return {"overlap": tuple(rows), "agree": worst < SAME, "overlaps": first > 1.0}


def _sliding(r: Reader) -> dict[str, Any]:
    """Specific sliding along the line of action, and the wheel whose tooth wears faster."""
    plan, worst = r.plan("gear-sliding"), r.plan("gear-greatest-sliding")
    if plan is None:
        return {"sliding": ()}
    shown = (("yV1", "y_{V1}", "mm"), ("yV2", "y_{V2}", "mm"), ("theta1", "θ_{1}", ""), ("theta2", "θ_{2}", ""))
    columns = [Column(r.head(letter, unit), plan[name].value, r.id(plan[name]), 1.0) for name, letter, unit in shown]
    found: dict[str, Any] = {"sliding": r.over_positions(enumerate(plan.labels), columns, r.words["gear"]["division"])}
    if worst is not None and "theta1" in worst and "theta2" in worst:
        one, two = (abs(float(worst[name].value)) for name in ("theta1", "theta2"))
        alike = abs(one - two) < ALIKE * max(one, two)
        found |= {"worse": "" if alike else "1" if one >= two else "2", "slides": True}
    return found



# --- planetary reducer --------------------------------------------------------------------------------------------------------

def reducer_fields(r: Reader) -> dict[str, Any]:
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



# --- gear train ---------------------------------------------------------------------------------------------------------------

def train_fields(r: Reader) -> dict[str, Any]:
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
        "closed": any(len(step.args) > 1 and tree_of_step(step) is None for step in plan),
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
    tree, made = step.rule.tree(len(step.args)), [a for a in step.args if isinstance(a, Step)]
    if made and isinstance(tree, expression.Argument):  # on the shaft of another wheel
        return r.written(r.letters_of(step), tree, [r.quantity(made[0])], r.quantity(step))
    found = r.formula(step) if made else None
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



# --- cam ----------------------------------------------------------------------------------------------------------------------

MINUTE = radians(1 / 60)
"""What an angle in degrees and minutes does not show, rad."""


def cam_fields(r: Reader) -> dict[str, Any]:
    """Sizes of the cam, what is true of it, the sentences of its plans, the table of the law."""
    cam: Any = r.project.cam
    table: Any = r.project.variant.cam
    results = cam.results()
    found: dict[str, Any] = {
        "plate": "flat" in table.follower or "plate" in table.follower,
        "law": r.words["cam"]["laws"].get(str(table.law), ""),
        "roller": "r_roller" in results,
        "geometric": table.closure != "force",
        "phases": list(_phases(r)),
        "motion_law": _motion_law(r),
        "sheet": r.sheet("cam.motion", "cam_profile.profile"),
        "mu_zone": r.scale("cam-zone"),
        "mu_profile": r.scale("cam-profile"),
        **_pressure(r),
    }
    if table.speed is not None:
        found["speed"] = r.of_turns("cam.speed", "n", NoteQuantity("ω", float(table.speed), "rad/s", step="cam.speed"))
    sizes: dict[str, float] = {}
    for name in ("r0", "e", "l0", "r_roller", "rho_min"):
        told = results.get(name)
        step: Any = getattr(told, "step", told)
        if hasattr(step, "rule"):
            sizes[name] = abs(float(np.real(step.value)))
            found[name] = r.number(sizes[name] * 1e3, "mm", r.id(step), kind=1.0)
    found["central"] = sizes.get("e", 1.0) < 1e-9
    if "r_roller" in sizes:
        found["round"] = sizes["r_roller"] < sizes["rho_min"]
        found["by_rule"] = all(sizes["r_roller"] <= rule.limits[1] * (1 + 1e-9) for rule in cam.roller_rules)
    zone, profile = r.plan("cam-zone"), r.plan("cam-profile")
    if zone is not None:
        found["zone_steps"] = r.sentences(zone)
    if profile is not None and len(profile.labels) > 2:
        found["profile_steps"] = r.sentences(profile)
    return found


def _phases(r: Reader) -> Iterator[dict[str, Any]]:
    """The phases that last, with their angles."""
    said = r.words["cam"]["phases"]
    for step in r.plan("cam-phases") or ():
        name = step.name.removeprefix("φ_")
        if name != step.name and name in said and step.value > 0:
            yield {"letter": lettered(symbol_of(step)), "value": r.angle(float(step.value), r.id(step)), "meaning": said[name]}


def _motion_law(r: Reader) -> Rows:
    """Way, its first and second derivative and the pressure angle at the numbered positions."""
    plan, alpha = r.plan("cam-ordinates"), r.step("cam-profile/α")
    if plan is None:
        return ()
    columns = []
    for name, step in plan.steps.items():
        if np.ndim(step.value) and name != "x":
            unit, factor = ("mm", 1e3) if name.startswith("S") else ("", 1.0)
            values = np.real(step.value) * factor
            columns.append(Column(r.head(name, unit), values, r.id(step), np.nanmax(np.abs(values))))
    if alpha is not None and np.shape(alpha.value) == np.shape(plan.labels):
        columns.append(Column(r.head("α", "deg"), np.degrees(alpha.value), r.id(alpha), decimals=1))
    return r.over_positions(enumerate(plan.labels), columns)


def _pressure(r: Reader) -> dict[str, Any]:
    """Greatest pressure angle of the phases on which it is limited, and of the whole turn, by many positions."""
    cam, step = r.project.cam, r.project.cam.dense.plan["α"]
    phi, alpha = np.asarray(cam.dense.at.phi.value), np.abs(np.asarray(step.value))
    both = cam.data.limit == "both"
    on = np.zeros(len(phi), dtype=bool)
    for phase in (cam.law.rise, cam.law.fall) if both else (cam.law.rise,):
        on |= (phi >= phase.start - 1e-12) & (phi <= phase.end + 1e-12)
    greatest, worst = float(alpha[on].max()), float(alpha.max())
    return {
        "pressure_limited": r.angle(greatest, r.id(step)),
        "pressure_allowed": r.angle(cam.alpha, "cam.pressure_angle"),
        "pressure_greatest": r.angle(worst, r.id(step)),
        "limit_both": both,
        "kept": greatest <= cam.alpha + MINUTE,
        "exceeds_elsewhere": worst > cam.alpha + MINUTE,
    }



# --- flywheel ----------------------------------------------------------------------------------------------------------------

CLOSE = 5.0
"""Difference from the limit, per cent, that engineers allow."""
EVEN = 0.05
"""Share of the square of the angular velocity below which an angular acceleration changes no inertia force noticeably."""
DRAWN = 0.05
"""What no drawing shows, mm."""
SAFE = 30.0
"""Speed up to which a rim of cast iron is safe, m/s (000, 5.7)."""


def flywheel_fields(r: Reader) -> dict[str, Any]:
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
        **_table_of_flywheel(r),
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


def _table_of_flywheel(r: Reader) -> dict[str, Any]:
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
