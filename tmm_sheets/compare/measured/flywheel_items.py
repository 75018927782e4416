"""What can be measured on the diagrams of a flywheel, and its results."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare.measured.measurable import RESULTS, Measurables, Term, measured_step, scalar, size
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.methods.integration import CHORD, smooth

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.project import Project

TITLE = "Маховик"
MOMENT, WORK, ENERGY, INERTIA = "moment", "work", "energy", "inertia"
"""Keys of the scale factors: diagrams of one quantity have one."""


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
        "total-work": (ENERGY, s.energy, {"ΔE": "y_ΔE"}),
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
        extra = _touching(f) if name in ("energy-mass", "first-energy") else ()
        for step_name, quantity in steps.items():
            step = plan[step_name]
            for k in range(len(plan.labels) if np.ndim(step.value) else 1):
                if quantity.startswith("y_") and k == len(plan.labels) - 1 and len(plan.labels) > 1:
                    continue  # the position that closes the cycle
                entry = measured_step(plan, found.scales, k, step, quantity, key)
                slope = (INERTIA, ENERGY) if entry.kind == "angle" else None
                found.add(replace(entry, terms=(*entry.terms, *(extra if step_name == "ab" else ())), slope=slope))
    _results(f, found, _touching(f))
    if "crank-speed" in plans:
        plan = plans["crank-speed"]
        found.plans.append((plan, ENERGY))
        for k, label in enumerate(plan.labels[:-1]):
            step = plan["ω1"]
            entry_id = f"{RESULTS}/{label}/omega_I"
            found.add(size("Угловая скорость начального звена", entry_id, label, "ω_I", "рад/с", k, step, by=step))


def _touching(f: Flywheel) -> tuple[Term, ...]:
    """What the segment ab has of the curve's error: of the energies where the tangents touch, which the ends of the chords bring.

    A tangent that shifts along a curve stays where it was to first order, so the points of contact are taken as they are.
    """
    ends = (*f.work_ends, f.driving_plan["K"])
    edges, _, before, after = f._work_curve
    ratio = f.scales.work.mu / f.scales.energy.mu

    def energy(phi: float) -> Step:
        x = f.scales.angle.mm(phi)

        def ordinate(*points: complex) -> Any:
            y = np.array([np.imag(p) for p in points[:-1]])
            if y.ndim > 1:
                raise ValueError("one construction at a time")
            return float((smooth(edges, y, before, after, x) + x * points[-1].imag / points[-1].real) * ratio)

        return Step("∂E", Rule("energy at a contact", ordinate, (), "number", ""), ends)

    if f.method == "mertsalov":
        high, low = (f.plans["first-energy"][name].value.real * f.scales.angle.mu for name in ("M_max", "M_min"))
    else:
        high, low = f.limit.phi_max, f.limit.phi_min
    return (energy(high), 0, 1 + 0j), (energy(low), 0, -1 + 0j)


def _results(f: Flywheel, found: Measurables, touching: tuple[Term, ...]) -> None:
    plan = f.plans["first-energy" if f.method == "mertsalov" else "energy-mass"]
    per_mm = f.scales.energy.mu / (f.data.delta * f.reduced.omega1**2)
    terms = tuple((step, k, g * per_mm) for step, k, g in ((plan["ab"], 0, 1 + 0j), *touching))
    scalar(found, TITLE, "M_const", f.M_constant, "Н·м", [(f.driving_plan["dK"], 0, 1j * f.scales.moment.mu)],
           scale=MOMENT, reading=f.scales.moment.mu, signed=False)
    for name, value in (("J_I", f.J_first), ("J_flywheel", f.J_flywheel)):
        scalar(found, TITLE, name, value, "кг·м²", terms, scale=ENERGY, reading=per_mm)
    wheel = f.wheel
    if wheel is None:
        return
    # D grows as the fifth root of J, the mass as J/D^2.
    lengths = {"D": wheel.diameter, "B": wheel.width, "H": wheel.thickness}
    for name, value in {**lengths, "m": wheel.mass}.items():
        unit, power = ("м", 0.2) if name in lengths else ("кг", 0.6)
        share = power * value / f.J_flywheel
        scalar(found, TITLE, name, value, unit, [(s, k, g * share) for s, k, g in terms], scale=ENERGY,
               reading=per_mm * share)
