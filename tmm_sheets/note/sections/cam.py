"""Cam: diagrams of motion, main dimensions, roller, profile, pressure angle, spring."""

from __future__ import annotations

from math import degrees
from typing import Any

import numpy as np

from tmm_sheets.note.document import Text
from tmm_sheets.note.phrases import Scope, words
from tmm_sheets.note.reader import Reader
from tmm_sheets.note.sections.forces import scale_text


def scope(r: Reader) -> Scope:
    """Formulas of the cam's plans by name, the table of the law, figures."""
    cam = r.project.cam
    results = cam.results()
    table: Any = r.project.variant.cam
    found = Scope(
        {
            "translating": table.follower.startswith("translating"),
            "rocker": "rocker" in table.follower or "oscillating" in table.follower,
            "plate": "flat" in table.follower or "plate" in table.follower,
            "law": words(r.language)["cam"]["laws"].get(str(table.law), ""),
            "roller": "r_roller" in results,
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
            value = step.value
            if isinstance(value, float | int | np.floating) and not isinstance(value, bool):
                unit = r.unit_of(step)
                key = f"{name.removeprefix('cam-')}-{step.name}"
                found.fields[key] = r.angle(float(value), r.id(step)) if unit == "rad" else r.of(step)
    for name in ("r0", "e", "l0", "r_roller", "rho_min"):
        told = results.get(name)
        behind: Any = getattr(told, "step", told)
        if behind is not None and hasattr(behind, "rule"):
            found.fields[name] = r.number(abs(float(np.real(behind.value))) * 1e3, "mm", r.id(behind))
    for name in ("cam-zone", "cam-profile"):
        scale = r.scales.get(name)
        if scale is not None:
            found.fields[f"mu_{name.removeprefix('cam-')}"] = scale_text(scale)
        plan = r.plan(name)
        if plan is not None and (name != "cam-profile" or len(plan.labels) > 2):
            found.fields[f"{name.removeprefix('cam-')}_steps"] = r.sentences(plan)
    found.fields["phases"] = list(_phases(r))
    _law(r, found)
    found.fields["motion"] = [{"part": f} for f in r.pictures.parts("cam.motion")]
    profile = r.pictures.figure("cam_profile.profile", focus=("curve", "cam-profile/O"))
    found.fields["profiles"] = [{"part": profile}] if profile is not None else []
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
    from tmm_sheets.note.document import Symbol
    from tmm_sheets.note.formula import letters
    from tmm_sheets.note.reader import symbol_of

    for step in plan or ():
        if step.name.startswith("φ_") and step.name[2:] in ("у", "дс", "с", "бс"):
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
    if alpha is not None:
        worst = float(np.nanmax(np.abs(alpha.value)))
        found.fields["pressure_greatest"] = r.angle(worst, r.id(alpha))
