"""Cam: diagrams of motion, main dimensions, roller, profile, pressure angle, spring."""

from __future__ import annotations

from math import degrees, radians
from typing import Any

import numpy as np

from tmm_sheets.note.document import Text
from tmm_sheets.note.phrases import Scope, words
from tmm_sheets.note.reader import NoteQuantity, Reader
from tmm_sheets.note.sections.forces import scale_text

MINUTE = radians(1 / 60)
"""What an angle in degrees and minutes does not show, rad."""


def scope(r: Reader) -> Scope:
    """Formulas of the cam's plans by name, the table of the law, figures."""
    cam: Any = r.project.cam
    results = cam.results()
    table: Any = r.project.variant.cam
    found = Scope(
        {
            "plate": "flat" in table.follower or "plate" in table.follower,
            "law": words(r.language)["cam"]["laws"].get(str(table.law), ""),
            "roller": "r_roller" in results,
            "geometric": table.closure != "force",
        }
    )
    for name in (
        "cam-phases",
        "cam-scales",
        "cam-zone",
        "cam-plate",
        "cam-plate-places",
        "cam-roller",
        "cam-curvature",
        "cam-spring",
        "cam-profile",
        "cam-zone-touch",
    ):
        plan = r.plan(name)
        for step in plan or ():
            said = r.formula(step)
            if said is not None:
                found.formulas[f"{name.removeprefix('cam-')}/{step.name}"] = said
    if table.speed is not None:
        turning = r.of_turns("cam.speed", "n", NoteQuantity("ω", float(table.speed), "rad/s", "cam.speed"))
        if turning is not None:
            found.formulas["speed"] = turning
    sizes: dict[str, float] = {}
    for name in ("r0", "e", "l0", "r_roller", "rho_min"):
        told = results.get(name)
        behind: Any = getattr(told, "step", told)
        if behind is not None and hasattr(behind, "rule"):
            sizes[name] = abs(float(np.real(behind.value)))
            found.fields[name] = r.number(sizes[name] * 1e3, "mm", r.id(behind), kind=1.0)
    found.fields["central"] = sizes.get("e", 1.0) < 1e-9
    if "r_roller" in sizes:
        found.fields["round"] = sizes["r_roller"] < sizes["rho_min"]
        found.fields["by_rule"] = all(sizes["r_roller"] <= rule.limits[1] * (1 + 1e-9) for rule in cam.roller_rules)
    _pressure(r, found)
    for name in ("cam-zone", "cam-profile"):
        scale = r.scales.get(name)
        if scale is not None:
            found.fields[f"mu_{name.removeprefix('cam-')}"] = scale_text(scale)
        plan = r.plan(name)
        if plan is not None and (name != "cam-profile" or len(plan.labels) > 2):
            found.fields[f"{name.removeprefix('cam-')}_steps"] = r.sentences(plan)
    found.fields["phases"] = list(_phases(r))
    _law(r, found)
    found.fields["motion"] = [
        {"motion_part": f, "nth": str(i)} for i, f in enumerate(r.pictures.parts("cam.motion"), 1)
    ]
    profile = r.pictures.figure("cam_profile.profile", focus=("curve", "cam-profile/O"))
    found.fields["profiles"] = [{"profile_part": profile, "nth": "1"}] if profile is not None else []
    for name, picture in (
        ("zone", "cam_zone.of_tappet"),
        ("zone_rocker", "cam_zone.of_rocker"),
        ("plate", "cam_zone.plate"),
        ("sum", "cam_zone.sum_graph"),
        ("roller", "cam_profile.roller"),
        ("pressure", "cam.pressure"),
        ("spring", "cam.spring"),
    ):
        figure = r.pictures.figure(picture)
        if figure is not None:
            found.figures[name] = figure
    n = r.pictures.sheet_of("cam.motion") or r.pictures.sheet_of("cam_profile.profile")
    found.fields["sheet"] = str(n) if n is not None else ""
    return found


def _phases(r: Reader) -> Any:
    plan = r.plan("cam-phases")
    from tmm_sheets.construction.formula import letters
    from tmm_sheets.note.document import Symbol
    from tmm_sheets.note.reader import symbol_of

    for step in plan or ():
        if step.name.startswith("φ_") and step.name[2:] in ("у", "дс", "с", "бс") and step.value > 0:
            yield {
                "letter": Symbol(letters(symbol_of(step))),
                "value": r.angle(float(step.value), r.id(step)),
                "meaning": words(r.language)["cam"]["phases"][step.name[2:]],
            }


def _law(r: Reader, found: Scope) -> None:
    """Way, its first and second derivative and the pressure angle at the numbered positions."""
    plan = r.plan("cam-ordinates")
    if plan is None:
        return
    said = words(r.language)
    profile = r.plan("cam-profile")
    names = [n for n in plan.steps if np.ndim(plan[n].value) and n != "x"]
    rows: list[tuple[Text, ...]] = []
    head: list[Text] = [(said["position"],)]
    factors = []
    for name in names:
        unit = "mm" if plan[name].name.startswith("S") else ""
        factors.append(1e3 if unit else 1.0)
        head.append(r.head(name, unit))
    alpha = profile["α"] if profile is not None and "α" in profile and np.ndim(profile["α"].value) else None
    if alpha is not None and len(alpha.value) == len(plan.labels):
        head.append(r.head("α", "deg"))
    rows.append(tuple(head))
    for i, label in enumerate(plan.labels):
        cells: list[Text] = [(label,)]
        for name, factor in zip(names, factors, strict=True):
            values = np.real(plan[name].value) * factor
            cells.append((r.number(float(values[i]), "", r.id(plan[name]), label, kind=float(np.nanmax(np.abs(values)))),))
        if alpha is not None and len(alpha.value) == len(plan.labels):
            cells.append((r.fixed(degrees(float(alpha.value[i])), "", 1, r.id(alpha), label),))
        rows.append(tuple(cells))
    found.tables["law"] = tuple(rows)


def _pressure(r: Reader, found: Scope) -> None:
    """Greatest pressure angle of the phases on which it is limited, and of the whole turn, by many positions."""
    cam = r.project.cam
    inversion = cam.dense
    phi, alpha = np.asarray(inversion.at.phi.value), np.abs(np.asarray(inversion.plan["α"].value))
    limited = cam.data.limit
    on = np.zeros(len(phi), dtype=bool)
    for phase in [cam.law.rise, *([cam.law.fall] if limited == "both" else [])]:
        on |= (phi >= phase.start - 1e-12) & (phi <= phase.end + 1e-12)
    step = inversion.plan["α"]
    greatest, worst = float(alpha[on].max()), float(alpha.max())
    found.fields |= {
        "pressure_limited": r.angle(greatest, r.id(step)),
        "pressure_allowed": r.angle(cam.alpha, "cam.pressure_angle"),
        "pressure_greatest": r.angle(worst, r.id(step)),
        "limit_both": limited == "both",
        "kept": greatest <= cam.alpha + MINUTE,
        "exceeds_elsewhere": worst > cam.alpha + MINUTE,
    }
