"""Dead positions of the group on the crank pin by ruler and compass (manual 000, section 3.1), and angles named after them."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step, value_of
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.words import marked, tr


def dead_positions(m: Mechanism) -> tuple[Plan | None, tuple[Step, Step] | None]:
    """Dead positions as constructions of their own: their plan, m, and the two angles of the crank, rad.

    How they are constructed is known to the kind of the group on the crank pin; None where it has no such construction.
    """
    c = m.crank
    group = next((g for g in m.groups if c.pin in g.outer), None)
    if group is None:
        return None, None
    plan = Plan("dead-positions", tr("Dead positions"), "m")
    dead = group.kind.dead_positions(m, group, plan, plan.add(c.pivot, rules.GIVEN, m.fixed[c.pivot]))
    return (None, None) if dead is None else (plan, dead)


@primitive("angle turned to a point", "real")
def _turned(centre: Any, pin: Any, start: Any, sense: Any) -> Any:
    """Angle from a direction to that from a centre to a point, in the sense of rotation, 0 to 360 degrees."""
    v = pin - centre
    return np.mod(sense * (np.arctan2(v.imag, v.real) - start), 2 * np.pi)


TURNED = Rule("angle turned to a place of the crank pin", _turned, ("point", "point", "angle", "number"), "angle",
              marked("Angle turned from position 0 to {1} {name} = {value}."), unit="rad", source="001, (6)-(9)")


def named_angles(m: Mechanism, start: float, sense: float) -> Plan | None:
    """Crank angles φ_1k and φ_2k of the rocker on the crank pin (manual 001, formulas 6 to 9), turned from position 0, rad.

    Its dead positions if it swings; where it turns all round, the positions in which it is square to the line of the pivots.
    Steps ``A_1k``, ``A_2k`` and ``φ_1k``, ``φ_2k`` in the order in which they are reached; None without such a rocker.
    """
    c = m.crank
    group = next((g for g in m.groups if c.pin in g.outer and g.kind.rocker(g) is not None), None)
    pivot = group.outer[1] if group is not None and not group.offset and group.outer[1] in m.fixed else None
    if pivot is None or abs(m.fixed[pivot] - m.fixed[c.pivot]) in (0.0, c.length):
        return None
    plan = Plan("slot-angles", tr("Angles φ_1k and φ_2k of the crank"), "m")
    centre, far = (plan.add(name, rules.GIVEN, m.fixed[name]) for name in (c.pivot, pivot))
    if abs(far.value - centre.value) > c.length:
        rule: Rule = rules.TANGENT
        args: tuple[Any, ...] = (far, centre, c.length)
    else:
        across = plan.add(f"⟂{c.pivot}{pivot}", rules.PERPENDICULAR, centre, far)
        rule, args = rules.ARC_LINE, (centre, c.length, far, across)
    sides = sorted((1, -1), key=lambda side: float(_turned(centre.value, rule.compute(*map(value_of, args), side), start, sense)))
    for k, side in enumerate(sides, 1):
        pin = plan.add(f"{c.pin}_{k}k", rule, *args, side, symbol=f"{c.pin}_{{{k}k}}")
        plan.add(f"φ_{k}k", TURNED, centre, pin, start, sense, symbol=f"φ_{{{k}k}}")
    return plan
