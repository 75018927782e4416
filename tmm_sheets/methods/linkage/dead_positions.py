"""Dead positions of the group on the crank pin by ruler and compass (manual 000, section 3.1)."""

from __future__ import annotations

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.positions import near_point


def dead_positions(m: Mechanism) -> tuple[Plan | None, tuple[complex, complex] | None]:
    """Dead positions as constructions of their own: the two crank vectors (from the crank pivot).

    Rocker with a sliding block: tangents from the rocker's pivot to the crank circle (manual 000, 3.1). Rod with a slider
    or a rocker: arcs about the crank pivot of radius rod plus crank and rod minus crank. None for other kinds.
    """
    c = m.crank
    plan = Plan("dead-positions", "Мёртвые положения", "m")
    centre = plan.add(c.pivot, rules.GIVEN, m.fixed[c.pivot])
    group = next((g for g in m.groups if c.pin in g.outer), None)
    if group is None:
        return None, None
    if group.kind.rocker(group) and not group.offset and group.outer[1] in m.fixed:
        if _lack(m, group) >= 0:
            return None, None  # the rocker turns all the way round
        return plan, _dead_rocker(m, plan, centre, group)
    if len(group.kind.sliders(group)) == 1 and m.guides[group.guides[0]].link == m.frame:
        guide = m.guides[group.guides[0]]
        through = plan.add(plan.free(f"{guide.name}₀"), rules.GIVEN, near_point(m, guide))
        along = plan.add(plan.free(guide.name), rules.GIVEN_DIRECTION, ar.unit(guide.direction))
        ends = [plan.add(f"{group.inner}{prime}", rules.ARC_LINE, centre, abs(group.lengths[0] + sign * c.length), through, along,
                         group.side) for prime, sign in (("′", 1), ("″", -1))]
    elif len(group.lengths) == 2 and group.outer[0] == c.pin and group.outer[1] in m.fixed:
        if not abs(m.fixed[group.outer[1]] - m.fixed[c.pivot]):
            return None, None  # rod and rocker turn about the crank's pivot with it
        pivot = plan.add(group.outer[1], rules.GIVEN, m.fixed[group.outer[1]])
        rod, rocker = group.lengths
        ends = [plan.add(f"{group.inner}{prime}", rules.ARC_ARC, centre, abs(rod + sign * c.length), pivot, rocker, group.side)
                for prime, sign in (("′", 1), ("″", -1))]
    else:
        return None, None
    far, near = (complex(e.value - centre.value) for e in ends)
    if np.isnan(far) or np.isnan(near) or not abs(far) or not abs(near):
        return None, None
    fold = -1 if group.lengths[0] > c.length else 1
    return plan, (far / abs(far) * c.length, fold * near / abs(near) * c.length)


def _dead_rocker(m: Mechanism, plan: Plan, centre: Step, group: StructuralGroup) -> tuple[complex, complex]:
    c = m.crank
    pivot_name = group.outer[1]
    pivot = plan.add(pivot_name, rules.GIVEN, m.fixed[pivot_name])
    tangents = [plan.add(f"{c.pin}{name}", rules.TANGENT, pivot, centre, c.length, side) for name, side in (("′", 1), ("″", -1))]
    a, b = (complex(t.value - centre.value) for t in tangents)
    return a, b


def _lack(m: Mechanism, group: StructuralGroup) -> float:
    """How far the pivot of a kind 3 group on the crank pin lies inside the crank circle, m; negative outside."""
    return m.crank.length - abs(m.fixed[group.outer[1]] - m.fixed[m.crank.pivot])


def refuse_turning_rocker(m: Mechanism) -> None:
    """A cycle that begins at a dead position needs a rocker that swings."""
    c = m.crank
    for group in m.groups:
        if group.kind.rocker(group) and c.pin in group.outer and group.outer[1] in m.fixed and _lack(m, group) >= 0:
            pivot, lack = group.outer[1], _lack(m, group)
            raise CannotBuild(
                f"pivot {pivot} of rocker {group.links[1]} lies {_mm(lack)} inside the crank circle: "
                f"{c.pivot}{pivot} = {_mm(c.length - lack)}, {c.pivot}{c.pin} = {_mm(c.length)}; the rocker has no dead positions",
                f"make {c.pivot}{pivot} longer than the crank, or give the crank angle of position 0 instead of start = \"dead\"")


def _mm(length: float) -> str:
    return f"{length * 1000:.4g} mm"
