"""What can be measured on the diagrams of a flywheel, and its results."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare.measured import measured_units as units
from tmm_sheets.compare.measured.measurable import RESULTS, Measurables, measured_step, scalar, size
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.scale import Scale
from tmm_sheets.methods.integration import CHORD
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.project import Project

TITLE = marked("Flywheel")
MOMENT, WORK, ENERGY, EXCESS, INERTIA = "moment", "work", "energy", "excess", "inertia"
"""Keys of the scale factors: diagrams of one quantity have one, but that of dE may have its own."""
NEAR = 1e-3
"""Millimetres by which the segment ab is moved to see what reading it does to the results."""


def collect(project: Project, found: Measurables) -> None:
    """Ordinates of all graphs at the numbered positions, segment ab, angles of the tangents, moments of inertia and sizes."""
    f = project.flywheel
    s = f.scales
    plans = f.plans
    work = {step.name: f"y_A({step.name})" for step in f.work_plan if step.rule is CHORD}
    diagrams: dict[str, tuple[str, Scale, dict[str, str]]] = {
        "reduced-moment": (MOMENT, s.moment, {"M": "y_M"}),
        "work": (WORK, s.work, work),
        "driving-moment": (WORK, s.work, {"K": "y_K"}),
        "total-work": (EXCESS, s.excess, {"ΔE": "y_ΔE"}) if s.excess is not None else (ENERGY, s.energy, {"ΔE": "y_ΔE"}),
        "reduced-inertia": (INERTIA, s.inertia, {"J": "y_J"}),
        "energy-mass": (ENERGY, s.energy, {"ab": "ab", "ψ_max": "ψ_max", "ψ_min": "ψ_min"}),
        "first-energy": (ENERGY, s.energy, {"T_II": "y_T2", "T_I": "y_T1", "ab": "ab"}),
    }
    for name, (key, scale, steps) in diagrams.items():
        if name not in plans:
            continue
        plan = plans[name]
        found.scales[key] = scale
        found.plans.append((plan, key))
        found.on_paper.add(key)
        for step_name, quantity in steps.items():
            step = plan[step_name]
            for k in range(len(plan.labels) if np.ndim(step.value) else 1):
                if quantity.startswith("y_") and k == len(plan.labels) - 1 and len(plan.labels) > 1:
                    continue  # the position that closes the cycle
                entry = measured_step(plan, found.scales, k, step, quantity, key)
                found.add(replace(entry, slope=(INERTIA, ENERGY) if entry.kind == "angle" else None, main=quantity != "y_T2"))
    _between_positions(f, found)
    _results(f, found)
    if "crank-speed" in plans:
        plan = plans["crank-speed"]
        found.plans.append((plan, ENERGY))
        for k, label in enumerate(plan.labels[:-1]):
            step = plan["ω1"]
            entry_id = f"{RESULTS}/{label}/omega_I"
            title = tell("Angular velocity of the driving link")
            found.add(replace(size(title, entry_id, label, "ω_I", units.ANGULAR_SPEED, k, step, by=step), main=False))


def _between_positions(f: Flywheel, found: Measurables) -> None:
    """What the diagrams have from between the numbered positions: ordinates at the contacts, and the velocities behind those in the
    middles and at the contacts, which are known no better than on the plans that are drawn.
    """
    found.plans.append((f.contacts_plan, ENERGY))
    for at in f.reduced.kept.values():
        found.plans += [(plan, key) for plan in at.plans for key in ("positions", "velocities")
                        if plan.name.startswith(f"{key}@") and key in found.scales]


def _results(f: Flywheel, found: Measurables) -> None:
    moment = f.driving_plan["M"]
    scalar(found, tell(TITLE), "M_const", float(moment.value), units.MOMENT, [(moment, 0, 1 + 0j)], scale=MOMENT, signed=False)
    steps = {"J_I": (f.first_plan["J_I"], units.INERTIA), "J_flywheel": (f.first_plan["J_м"], units.INERTIA)}
    if f.wheel is not None:
        sizes = f.wheel.plan
        steps |= {name: (sizes[name], units.MASS if name == "m" else units.METRES) for name in "DBHm" if name in sizes}
    read = Errors([]).displaced(f.ab, 0, NEAR)
    for name, (step, unit) in steps.items():
        value = float(step.value)
        scalar(found, tell(TITLE), name, value, unit, [(step, 0, 1 + 0j)], scale=ENERGY,
               reading=abs(float(read(step)) - value) / NEAR)
