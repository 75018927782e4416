"""Gear pair: sizes of the first wheel in words, of both in a table, the picture of the mesh, quality."""

from __future__ import annotations

from typing import Any

from tmm_sheets.note.document import Rows, Text, lettered
from tmm_sheets.note.reader import Column, Reader, symbol_of

BOTH = ("z", "x", "r", "rb", "rw", "ra", "rf", "s", "s_chord", "p_chord", "rho_a", "alpha_a", "sa", "tau", "phi_alpha")
"""Sizes of both wheels in the order of their table."""
ALIKE = 0.05
"""Share by which specific slidings differ at least, for one tooth to wear faster."""
SAME = 1.0
"""Difference of the contact ratios, per cent, that the accuracy of the drawing explains."""
THIN = 0.2
"""Least thickness of a tooth at its tip in modules."""


def fields(r: Reader) -> dict[str, Any]:
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
