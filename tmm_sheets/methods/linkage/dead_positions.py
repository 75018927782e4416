"""Dead positions of the group on the crank pin by ruler and compass (manual 000, section 3.1)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.positions import near_point

PIN_ANGLE = Rule("angle of a dead position", lambda centre, pin: np.arctan2((pin - centre).imag, (pin - centre).real),
                 ("point", "point"), "angle", "Угол кривошипа в мёртвом положении {1} {name} = {value}.", unit="rad",
                 exact=True)


def _in_line(centre: Any, end: Any, fold: Any, crank: Any) -> Any:
    v = fold * (end - centre) / np.abs(end - centre) * crank
    return np.arctan2(v.imag, v.real)


IN_LINE_ANGLE = Rule("angle of a crank in line with the rod", _in_line, ("point", "point", "number", "length"), "angle",
                     "Кривошип на одной прямой с шатуном, конец которого в точке {1}: угол {name} = {value}.", unit="rad",
                     exact=True)


def dead_positions(m: Mechanism) -> tuple[Plan | None, tuple[Step, Step] | None]:
    """Dead positions as constructions of their own: the angles of the crank, rad.

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
        through = plan.add(plan.free(f"{guide.name}₀"), *near_point(m, guide))
        along = plan.add(plan.free(guide.name), rules.UNDER, guide.direction)
        radii = reaches(plan, group.lengths[0], c.length)
        ends = [plan.add(f"{group.inner}{prime}", rules.ARC_LINE, centre, radius, through, along, group.side)
                for prime, radius in radii]
    elif len(group.lengths) == 2 and group.outer[0] == c.pin and group.outer[1] in m.fixed:
        if not abs(m.fixed[group.outer[1]] - m.fixed[c.pivot]):
            return None, None  # rod and rocker turn about the crank's pivot with it
        pivot = plan.add(group.outer[1], rules.GIVEN, m.fixed[group.outer[1]])
        rod, rocker = group.lengths
        ends = [plan.add(f"{group.inner}{prime}", rules.ARC_ARC, centre, radius, pivot, rocker, group.side)
                for prime, radius in reaches(plan, rod, c.length)]
    else:
        return None, None
    far, near = (complex(e.value - centre.value) for e in ends)
    if np.isnan(far) or np.isnan(near) or not abs(far) or not abs(near):
        return None, None
    fold = -1.0 if group.lengths[0] > c.length else 1.0
    return plan, (plan.aside("φ′", IN_LINE_ANGLE, centre, ends[0], 1.0, c.length),
                  plan.aside("φ″", IN_LINE_ANGLE, centre, ends[1], fold, c.length))


REACH = Rule("reach of crank and rod in line", lambda rod, crank, sign: np.abs(rod + sign * crank), ("length", "length", "number"),
             "length", "{name} = {value}.")


def reaches(plan: Plan, rod: float, crank: float) -> tuple[tuple[str, Step], ...]:
    """How far from the crank pivot the rod ends, with crank and rod stretched and folded, with the prime of each."""
    return tuple((prime, plan.aside(f"r{prime}", REACH, rod, crank, sign)) for prime, sign in (("′", 1.0), ("″", -1.0)))


def _dead_rocker(m: Mechanism, plan: Plan, centre: Step, group: StructuralGroup) -> tuple[Step, Step]:
    c = m.crank
    pivot_name = group.outer[1]
    pivot = plan.add(pivot_name, rules.GIVEN, m.fixed[pivot_name])
    tangents = [plan.add(f"{c.pin}{name}", rules.TANGENT, pivot, centre, c.length, side) for name, side in (("′", 1), ("″", -1))]
    return plan.aside("φ′", PIN_ANGLE, centre, tangents[0]), plan.aside("φ″", PIN_ANGLE, centre, tangents[1])


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
