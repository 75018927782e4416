"""Force plans with friction by successive approximations: until the reactions bring the friction that they were found with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tmm_sheets.construction.given import Given
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.rules import GIVEN_NUMBER
from tmm_sheets.construction.search_count import SearchCount
from tmm_sheets.construction.step import Helper, Rule
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.linkage.accelerations import Sliding
from tmm_sheets.methods.linkage.forces import Kinetostatics
from tmm_sheets.methods.linkage.friction import Coefficients, Friction, Rows, friction, order
from tmm_sheets.methods.linkage.velocities import Velocities
from tmm_sheets.words import marked, tell, tr

REACH = 6.0
"""Line of action of a reaction that touches a circle of friction, in radii of the circle."""


def _touch(centre: Any, force: Any, moment: Any, radius: Any) -> Any:
    return centre - 1j * force * moment / np.abs(force) ** 2


def _touch_lines(args: Any, value: Any) -> tuple[Helper, ...]:
    centre, force, _, radius = args
    circle = Helper("circle", centre, radius=radius)
    if not abs(force) > 0:
        return (circle,)
    return circle, Helper("line", centre, value), Helper("line", value, value - REACH * radius * force / abs(force))


TOUCH = Rule("reaction that touches the circle of friction", _touch, ("point", "force", "number", "length"), "point",
             marked("About {0} draw the circle of friction with the radius {3}; the line of the reaction {1} touches it at "
                    "{name}."),
             _touch_lines, unit="m")
POWER_OF_MOMENT = Rule("power of a moment of friction", lambda m, w: m * w, ("number", "number"), "number",
                       "", unit="W")
POWER_OF_SLIDING = Rule("power of a reaction on sliding", lambda f, v: (f * np.conj(v)).real, ("force", "vector"), "number",
                        marked("Power of friction {name} = F·V·cos(F̅, V̅) = {value} W."), unit="W")


def _sum(*powers: Any) -> Any:
    total = powers[0]
    for power in powers[1:]:
        total = total + power
    return total


ALL_POWER = Rule("power of all friction", _sum, ("number",), "number", marked("Power of friction in all pairs {name} = {value} W."),
                 unit="W")
ON_CRANK = Rule("moment of friction reduced to the crank", lambda power, omega: power / omega, ("number", "number"), "number",
                marked("Friction in all pairs, reduced to the input link by its power: {formula}."),
                unit="N*m")
MOST, DAMPED = 400, 60
"""So many approximations at most; from the second number on by half steps."""
NEAR = 1e-13
"""Change of a reaction that is none, in parts of the largest force."""



def _rows(of: Friction, found: Kinetostatics) -> Rows:
    """What the reactions that were found are for the next approximation."""
    n = len(of.plan.labels)
    rows: Rows = {}
    for index in of.pairs:
        force = np.broadcast_to(found.reactions[f"F{index}"].value, (n,))
        if index in of.moments:
            rows[index] = np.abs(force)
        else:
            rows[index] = np.sign((np.conj(np.broadcast_to(of.sliding[index].value, (n,))) * force).imag)
    return rows


Statics = Callable[[Friction, SearchCount | None], Kinetostatics]


def with_friction(given: Coefficients, vel: Velocities, sliding: Sliding, statics: Statics) -> Kinetostatics:
    """Force plans with friction: approximations until every reaction stays, then the plans of the last.

    Parameters
    ----------
    given
        coefficients and radii.
    vel, sliding
        relative velocities.
    statics
        force plans with a given friction.

    Raises
    ------
    CannotBuild
        where no reactions lead back to themselves: the mechanism jams.
    """
    m = vel.positions.mechanism
    third = [pair for g in m.groups if g.kind.grade > 2 for pair in g.kind.pairs(m, g)]
    if given.sliding and any(pair.motion == "translation" for pair in third):
        raise CannotBuild(tell("friction in the sliding pairs of a group of class III is not built"),
                          tell("leave sliding out of [friction]; its turning pairs may have friction"))
    search, labels = m.search("friction"), vel.positions.plan.labels
    none = {pair_index(*order(m, pair)): np.zeros(len(labels)) for pair in m.pairs}
    rows, changed, n = none, np.ones(len(labels), dtype=bool), 0
    while changed.any() and n < MOST:
        of = friction(given, vel, sliding, rows, search)
        found = statics(of, search)
        further = _rows(of, found)
        size = np.max([np.abs(np.broadcast_to(f.value, (len(labels),))) for f in found.reactions.values()], axis=0)
        if n:
            changes = {index: np.nan_to_num(np.abs(further[index] - rows[index]) / (size if index in of.moments else 1.0))
                       for index in of.pairs}
            changed = np.any([change > NEAR for change in changes.values()] or [np.zeros(len(labels), dtype=bool)], axis=0)
        if n > DAMPED:
            further = {index: (row + rows[index]) / 2 if index in of.moments else row for index, row in further.items()}
        rows, n = further, n + 1
    if changed.any():
        worst = max(changes, key=lambda index: float(np.max(changes[index][changed])))
        raise CannotBuild(
            tell("friction: no reactions hold in position {positions}, first of all not F{index}: the mechanism jams there").format(
                positions=", ".join(label for label, c in zip(labels, changed, strict=True) if c), index=worst),
            tell("take smaller coefficients or radii in [friction]"))
    of = friction(given, vel, sliding, rows)
    of.approximations = n
    found = statics(of, None)
    _powers(of, vel, found)
    return found


def _powers(of: Friction, vel: Velocities, found: Kinetostatics) -> None:
    """Record where the reactions touch, the power of friction in each pair, in all, and as a moment on the crank."""
    crank, search = vel.positions.mechanism.crank, of.plan.search
    plan = of.power_plan = Plan("friction-power", tr("Reactions and power of friction"), "m", of.plan.labels, search=search)
    plan.add("n", GIVEN_NUMBER, Given(float(of.approximations), "approximations", over="none", choice="until the reactions stay"))
    for index, pair in of.pairs.items():
        if index in of.moments:
            hinge = pair.name.rstrip("′″")
            of.touches[index] = plan.add(f"T{index}", TOUCH, vel.positions.points[hinge], found.reactions[f"F{index}"],
                                         of.moments[index], of.radii[hinge], symbol=f"T_{{{index}}}")
        of.powers[index] = (plan.add(f"N{index}", POWER_OF_MOMENT, of.moments[index], of.turning[index]) if index in of.moments else
                            plan.add(f"N{index}", POWER_OF_SLIDING, found.reactions[f"F{index}"], of.sliding[index]))
    parts: list[Any] = list(of.powers.values()) or [Given(np.zeros(len(of.plan.labels)), "no friction", unit="W")]
    total = plan.add("N_тр", ALL_POWER, *parts, symbol=tr("N_f"))
    plan.add("Mтр", ON_CRANK, total, vel.omega[crank.link], symbol=tr("Mf"))
