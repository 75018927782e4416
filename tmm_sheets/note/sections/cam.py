"""Cam: diagrams of motion, main dimensions, roller, profile, pressure angle, spring."""

from __future__ import annotations

from collections.abc import Iterator
from math import radians
from typing import Any

import numpy as np

from tmm_sheets.note.document import Rows, lettered
from tmm_sheets.note.reader import Column, NoteQuantity, Reader, symbol_of

MINUTE = radians(1 / 60)
"""What an angle in degrees and minutes does not show, rad."""


def fields(r: Reader) -> dict[str, Any]:
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
