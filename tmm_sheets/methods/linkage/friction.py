"""Friction in the pairs (трение в кинематических парах) as a part of the force plans: circles and angles of friction.

In a turning pair the reaction touches the circle of friction of the radius ρ = f·r, which is a moment ρ·F against the turning of
the one link on the other; in a sliding pair it deviates from the normal by the angle of friction φ = arctan f, so that it has a
component against the sliding. Both depend on the reactions themselves: they are found by successive approximations, the first
without friction, until the reactions stay. A pair whose links do not move on each other in a position has no friction there.
Source: manual 000, section 4; I. I. Artobolevsky, Theory of mechanisms, 13 (friction in kinematic pairs).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_sheets.construction.given import Given
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.search_count import SearchCount
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.mechanism.groups.contexts import OPPOSITE_COUPLE
from tmm_sheets.mechanism.model import Mechanism, Pair
from tmm_sheets.methods.linkage.accelerations import Sliding, ordered
from tmm_sheets.methods.linkage.velocities import Velocities
from tmm_sheets.words import marked, tr

_SOURCE = "000, 4"
CIRCLE = Rule("circle of friction", lambda f, r: f * r, ("number", "length"), "length",
              "", unit="m", source=_SOURCE, exact=True)
ANGLE = Rule("angle of friction", np.arctan, ("number",), "angle", "",
             unit="rad", source=_SOURCE, exact=True)
RELATIVE_TURNING = Rule("relative angular velocity", lambda a, b: a - b, ("number", "number"), "number",
                        "", unit="rad/s")
STILL = 1e-9
"""Share of the crank's own motion below which the links of a pair do not move on each other."""


def _sense(w: Any, omega: Any) -> Any:
    return np.sign(np.maximum(np.abs(w) - STILL * omega, 0.0)) * np.sign(w)


MOMENT = Rule("moment of friction", lambda rho, force, w, omega: -_sense(w, omega) * rho * force, ("length", "number", "number",
                                                                                                 "number"), "number",
              marked("Moment of friction {name} = ρ·F = {0}·{1} = {value} N·m, against the relative turning."), unit="N*m",
              source=_SOURCE)
DEVIATION = Rule("deviation by the angle of friction",
                 lambda phi, side, v, length, omega: np.sign(np.maximum(np.abs(v) - STILL * length * omega, 0.0)) * side * phi,
                 ("angle", "number", "vector", "length", "number"), "angle",
                 marked("The reaction deviates from the normal by {name} = {value}, against the sliding."), unit="rad",
                 source=_SOURCE)
DEVIATED = Rule("normal with friction", lambda n, angle: n * (np.cos(angle) + 1j * np.sin(angle)), ("direction", "angle"),
                "direction", marked("At the angle {1} to the normal {0} draw the direction {name} of the reaction."))

@dataclass(frozen=True)
class Coefficients:
    """What is given: coefficients of friction of turning and sliding pairs, and radii of journals by their hinges, m."""

    turning: float
    sliding: float
    radii: Mapping[str, float]


Rows = dict[str, Any]
"""By pair, a number for each position: size of the reaction in a turning pair, N; its side of the sliding velocity (+1, -1)."""


@dataclass(eq=False)
class Friction:
    """Friction in the pairs that have some, from reactions that are assumed: ``rows``.

    ``pairs`` by index ("21": on link 2 from 1); ``moments`` N m on the first link of a turning pair, ``couples`` by link, both
    links of the pair; ``deviations`` of the normals of sliding pairs, rad, by both indices of a pair. When the reactions were
    found, ``touches`` (points where they touch the circles) and ``powers`` (W) of the ``power_plan``.
    """

    plan: Plan
    pairs: dict[str, Pair] = field(default_factory=dict)
    radii: dict[str, Step] = field(default_factory=dict)
    angle: Step | None = None
    turning: dict[str, Step] = field(default_factory=dict)
    sliding: dict[str, Step] = field(default_factory=dict)
    moments: dict[str, Step] = field(default_factory=dict)
    couples: dict[str, list[Step]] = field(default_factory=dict)
    deviations: dict[str, Step] = field(default_factory=dict)
    hinges: dict[str, str] = field(default_factory=dict)
    touches: dict[str, Step] = field(default_factory=dict)
    powers: dict[str, Step] = field(default_factory=dict)
    power_plan: Plan | None = None
    approximations: int = 0

    def deviated(self, j: str, k: str, across: Step, plan: Plan) -> Step:
        """Direction of the reaction in the sliding pair of two links, from the normal; the normal itself without friction."""
        turn = self.deviations.get(pair_index(j, k))
        return across if turn is None else plan.add(plan.free(f"{across.name} φ"), DEVIATED, across, turn)

    def still(self, index: str, position: int) -> bool:
        """True where the links of a pair do not move on each other."""
        if index in self.moments:
            return not float(np.real(self.moments[index].at(position)))
        return not float(self.deviations[index].at(position))

    @property
    def total(self) -> Step:
        """Power of all friction, W, not above zero."""
        assert self.power_plan is not None
        return self.power_plan["N_тр"]

    @property
    def on_crank(self) -> Step:
        """The same as a moment on the crank, N m."""
        assert self.power_plan is not None
        return self.power_plan["Mтр"]


def order(m: Mechanism, pair: Pair) -> tuple[str, str]:
    """Links of a pair: the one that moves on the other first."""
    if pair.motion == "translation":
        return ordered(m, pair)
    k, j = pair.links
    return (k, j) if j == m.frame else (j, k)


def friction(given: Coefficients, vel: Velocities, sliding: Sliding, rows: Rows, search: SearchCount | None = None) -> Friction:
    """Record the friction that assumed reactions bring."""
    m = vel.positions.mechanism
    plan = Plan("friction", tr("Friction in the pairs"), "m", vel.positions.plan.labels, search=search or vel.positions.plan.search)
    of = Friction(plan)
    criterion = "the reactions that friction of this size leads back to"
    for pair in m.pairs:
        hinge, (j, k) = pair.name.rstrip("′″"), order(m, pair)
        index = pair_index(j, k)
        if pair.motion == "rotation" and given.turning and given.radii.get(hinge):
            if hinge not in of.radii:
                of.radii[hinge] = plan.add(f"ρ{hinge}", CIRCLE, given.turning, given.radii[hinge], symbol=f"ρ_{{{hinge}}}")
            w = of.turning[index] = plan.add(f"ω{index}", RELATIVE_TURNING, vel.omega[j], vel.omega[k], symbol=f"ω_{{{index}}}")
            force = Given(rows[index], f"reaction F{index}", f"F_{{{index}}}", "N", choice=criterion)
            moment = plan.add(f"Mтр{index}", MOMENT, of.radii[hinge], force, w, m.crank.speed,
                              symbol=tr("Mf{index}").format(index=index))
            opposite = plan.add(f"Mтр{pair_index(k, j)}", OPPOSITE_COUPLE, moment,
                                symbol=tr("Mf{index}").format(index=pair_index(k, j)))
            of.moments[index] = moment
            for link, couple in ((j, moment), (k, opposite)):
                of.hinges[couple.name] = hinge
                if link != m.frame:
                    of.couples.setdefault(link, []).append(couple)
        elif pair.motion == "translation" and given.sliding:
            if of.angle is None:
                of.angle = plan.add("φ", ANGLE, given.sliding)
            of.sliding[index] = sliding.velocities[index]
            side = Given(rows[index], f"side of F{index}", choice=criterion)
            turn = plan.add(f"φ{index}", DEVIATION, of.angle, side, sliding.velocities[index], m.crank.length, m.crank.speed,
                            symbol=f"φ_{{{index}}}")
            of.deviations[index] = of.deviations[pair_index(k, j)] = turn
        else:
            continue
        of.pairs[index] = pair
    return of
