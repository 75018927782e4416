"""What can be measured on the pictures of gears and cams, and their results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare.measured.measurable import (
    CALCULATED,
    RESULTS,
    Measurable,
    Measurables,
    length,
    measured_step,
    scalar,
)
from tmm_sheets.compare.measured.measured_units import DEGREES, MILLIMETRES, TURNS
from tmm_sheets.compare.measured.speed_pictures import speed_pictures
from tmm_sheets.construction import rules
from tmm_sheets.construction.protocol import spoken
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.methods.cams.cam_motion import ACROSS, ORDINATE
from tmm_sheets.methods.gears.rack import TAKEN
from tmm_sheets.methods.integration import CHORD
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.construction.plan import Plan
    from tmm_sheets.project import Project

GEAR_ANGLES = ("alpha_w", "tau1", "tau2", "phi_alpha1", "phi_alpha2")
GEAR_MAIN = ("z1", "z2", "x1", "x2", "a_w", "alpha_w", "eps_alpha")
GEAR_NUMBERS = ("z1", "z2", "x1", "x2", "y", "dy", "eps_alpha", "theta1_greatest", "theta2_greatest")


def others(project: Project, found: Measurables) -> None:
    """Dead positions and synthesis: points from those they were drawn from; the chord of a tooth."""
    for plan in (p for of_part in project.plans.values() for p in (of_part or {}).values()):
        if plan.name not in found.scales:
            continue
        if plan.name.startswith("gear-tooth"):
            found.plans.append((plan, plan.name))
            found.add(length(plan, found.scales, 0, plan["E"], plan["F"], "EF"))
        elif plan.name in ("dead-positions", "synthesis"):
            found.plans.append((plan, plan.name))
            _lengths(plan, found, plan.name)
            for head in (s for s in plan if s.rule.gives == "point" and np.ndim(s.value) == 0):
                for tail in dict.fromkeys(a for a in head.args if isinstance(a, Step) and a.name in plan and plan[a.name] is a):
                    if tail.rule.gives == "point" and "₀" not in tail.name:
                        found.add(length(plan, found.scales, 0, tail, head, f"{tail.name}{head.name}"))


def _lengths(plan: Plan, found: Measurables, key: str) -> None:
    """All lengths and angles of a plan that were measured or drawn as circles; not those taken from numbers."""
    taken = (rules.GIVEN_LENGTH, TAKEN)
    for step in plan:
        if step.rule.gives in ("length", "ordinate", "angle", "inclination") and step.rule not in taken and step.args:
            for k in range(np.size(step.value)):
                entry = measured_step(plan, found.scales, k, step, key=key)
                found.add(replace(entry, main=entry.kind == "length" or np.size(step.value) == 1))


def gear(project: Project, found: Measurables) -> None:
    """Lengths, angles and results of the gear pair, as far as the sheets show it."""
    pair = project.gear
    if "gear-engagement" in found.scales:
        plan = pair.engagement
        found.plans.append((plan, "gear-engagement"))
        _lengths(plan, found, "gear-engagement")
        for tail, head in (("O1", "O2"), ("N1", "N2"), ("A", "B"), ("A", "Pw"), ("Pw", "B")):
            if tail in plan and head in plan:
                found.add(length(plan, found.scales, 0, plan[tail], plan[head], tail + head))
    if "gear-sliding" in found.scales:
        _sliding(pair.sliding, found)
    for name, told in pair.results().items():
        value = told.value
        if name in GEAR_ANGLES:
            scalar(found, tell("Gear pair"), name, degrees(value), DEGREES, part="gear", main=name in GEAR_MAIN)
        else:
            scalar(found, tell("Gear pair"), name, value, "" if name in GEAR_NUMBERS else MILLIMETRES,
                   part="gear", main=name in GEAR_MAIN)


def _sliding(plan: Plan, found: Measurables) -> None:
    """Ordinates of the speeds, mm, and specific slidings at the manual's divisions of the line of action."""
    found.plans.append((plan, "gear-sliding"))
    for i, label in enumerate(plan.labels):
        for name in ("yV1", "yV2", "theta1", "theta2"):
            step = plan[name]
            value = float(np.real(value_at(step, i)))
            ordinate = name.startswith("y")
            sign = 1.0 if value >= 0 else -1.0
            found.add(Measurable(
                f"gear-sliding/{label}/{name}", plan.name, plan.title, label, spoken(name) if not ordinate else name,
                MILLIMETRES if ordinate else "", "length" if ordinate else "result", abs(value) if ordinate else value,
                ((step, i, complex(sign if ordinate else 1)),), "", 1.0 if ordinate else 0.0, main=False,
                calculated=0.0 if ordinate else CALCULATED, head=step, signed=not ordinate))


def reducer(project: Project, found: Measurables) -> None:
    """Results of the reducer."""
    results: Mapping[str, Any] = project.reducer.results()
    for group, unit in (("teeth", ""), ("diameters_w", MILLIMETRES), ("speeds_rpm", TURNS)):
        for name, told in results[group].items():
            scalar(found, tell("Reducer"), f"reducer-{name}", told.value, unit)
    speed_pictures("reducer", project.reducer.plans, found)
    for name in ("ratio", "ratio_planetary", "ratio_simple", "efficiency", "q"):
        if name in results:
            scalar(found, tell("Reducer"), f"reducer-{name}", results[name].value, "")


def train(project: Project, found: Measurables) -> None:
    """Results of the train of gears; tooth numbers and speeds that are given are none."""
    train = project.train
    results: Mapping[str, Any] = train.results()
    for name, told in results["distances"].items():
        scalar(found, tell("Train of gears"), f"train-{name}", told.value, MILLIMETRES)
    for m in train.meshes:
        scalar(found, tell("Train of gears"), f"train-d{m.central}-{m.planet}", float(train.pitch(m).value), MILLIMETRES)
    for name, told in results["speeds_rpm"].items():
        if name.removeprefix("n") not in train.given:
            scalar(found, tell("Train of gears"), f"train-{name}", told.value, TURNS)
    speed_pictures("train", train.plans, found)


def cam(project: Project, found: Measurables) -> None:
    """Lengths, angles and results of the cam."""
    cam = project.cam
    m = cam.motion
    if m.plan.name in found.scales:
        for name, scale in zip(m.names, (m.scales.dds, m.scales.ds, m.scales.s), strict=True):
            found.scales[f"cam-motion-{name}"] = scale
        found.plans.append((m.plan, m.plan.name))
        found.on_paper |= {f"cam-motion-{name}" for name in m.names}
        for step in m.plan:
            if step.rule in (CHORD, ORDINATE, ACROSS):
                key = f"cam-motion-{step.name.partition('_')[0]}"
                found.add(replace(measured_step(m.plan, found.scales, 0, step, key=key), main=not step.name.startswith("S''")))
    for part in ("zone", "inversion"):
        plan = getattr(getattr(cam, part, None), "plan", None)
        if plan is not None and plan.name in found.scales:
            found.plans.append((plan, plan.name))
            _lengths(plan, found, plan.name)
    for name, step in cam.results().items():
        if name in ("r0", "e", "s0", "l0", "r_roller", "rho_min"):
            # Read off the drawing where it is drawn; in mm, as the manuals write it.
            mu = found.scales[step.plan].mu if step.plan in found.scales else 0.0
            # A roller is chosen in whole half millimetres: no small error of what it is chosen by moves it.
            terms = [] if name == "r_roller" else [(step, 0, 1000 + 0j)]
            scalar(found, tell("Cam"), name, 1000 * float(step.value), MILLIMETRES, terms,
                   scale=step.plan if mu else "", reading=1000 * mu)
            if mu:
                found.check(f"{RESULTS}/{name}", [f"{step.plan}/{step.name}"], lambda x: 1000 * x)
