"""Dead positions of the group on the crank pin by ruler and compass (manual 000, section 3.1)."""

from __future__ import annotations

from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.words import tr


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


def check_dead_positions(m: Mechanism) -> None:
    """A cycle that begins at a dead position needs groups that have some.

    Raises
    ------
    CannotBuild
        when a group on the crank pin turns all the way round.
    """
    for group in m.groups:
        group.kind.check_dead_positions(m, group)
