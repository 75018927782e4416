"""Limits of the moments of forces in change points, where reactions of links in line grow beyond all bounds."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.given import Given
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.mechanism.groups.contexts import Load
from tmm_sheets.methods.linkage.accelerations import Accelerations
from tmm_sheets.methods.linkage.forces import TOTAL, GearForce, InputForce, kinetostatics
from tmm_sheets.methods.linkage.passages import CHOICE, Floats, PassagePlace, alone, beside
from tmm_sheets.methods.linkage.positions import SEARCHED, Positions, passages, position_plan

FORCE_ZONE = 1e-5
"""Angle, rad, next to a change point in which moments of forces that grow beyond all bounds are taken as a limit."""


def limits_of_forces(pos: Positions, acc: Accelerations, loads: dict[str, list[Load]], couples: dict[str, list[Step]],
                     driver: GearForce | InputForce | None) -> dict[str, Given]:
    """Limits of what force plans cannot tell next to change points, as rows over the positions, NaN elsewhere.

    Lines of a group's plan fall together there, and its reactions grow beyond all bounds unless nothing loads it; what they do to
    the crank has a limit. The loads stay as they are at the position: only the links move to both sides of it.
    """
    passing, phi = passages(pos.mechanism), np.atleast_1d(np.asarray(pos.phi, dtype=float))
    rows: dict[str, Floats] = {}
    for angle in passing.every():
        for place in passing.places(angle, phi, passing.together(angle), FORCE_ZONE):
            for k, x in zip(place.which.tolist(), place.x.tolist(), strict=True):
                for name, value in _limits_at(pos, acc, loads, couples, driver, place, k, x).items():
                    rows.setdefault(name, np.full(phi.shape, np.nan))[k] = value
    return {name: Given(row, f"limit: {name}", choice=CHOICE) for name, row in rows.items()}


def _limits_at(pos: Positions, acc: Accelerations, loads: dict[str, list[Load]], couples: dict[str, list[Step]],
               driver: GearForce | InputForce | None, place: PassagePlace, k: int, x: float) -> dict[str, float]:
    """Limits at position ``k``, ``x`` from the change point: of the moments on the crank, and of groups that have one."""
    m, names = pos.mechanism, {id(step): name for name, step in pos.points.items()}
    force = max((abs(value_at(load.vector, k)) for of in loads.values() for load in of), default=0.0)
    moment = force * m.crank.length + max((abs(value_at(c, k)) for of in couples.values() for c in of), default=0.0)
    if not moment > 0:
        return {}
    scales = {TOTAL: moment} | {name: moment / m.crank.length for name, _ in place.sides}

    def told(angles: Floats) -> dict[str, Any]:
        """What the force plans say with the links that far from the change point."""
        there = position_plan(alone(m, m.groups[-1], {name: side * np.sign(angles) for name, side in place.sides}),
                              place.angle + angles, purpose=SEARCHED)
        here = {link: [replace(load, at=there.points[names[id(load.at)]], vector=value_at(load.vector, k)) for load in of]
                for link, of in loads.items()}
        plans = kinetostatics(there, acc, here, {link: [value_at(c, k) for c in of] for link, of in couples.items()}, driver)
        ways = {TOTAL: np.broadcast_to(plans.plan[f"ΣM{m.crank.link}"].value, angles.shape)}
        for name, _ in place.sides:
            closing = plans.plans[name].plan["1"]
            start, u = closing.args[:2]
            ways[name] = ar.dot(u.value, closing.value - start.value)
        return {name: way / scales[name] for name, way in ways.items()}

    found = beside(told, TOTAL)
    return {} if found is None else {name: float(found.at(name, np.array(x))) * scales[name] for name in found.values}
