"""Friction in the pairs: its circles and angles (manual 000, 4), and the approximations until the reactions stay."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import reduce
from operator import add
from typing import Any

import numpy as np

from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.rules import GIVEN_NUMBER
from tmm_sheets.construction.step import Given, Helper, Plan, Rule, SearchCount, Step, StepTable, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups.contexts import OPPOSITE_COUPLE
from tmm_sheets.mechanism.model import Mechanism, Pair
from tmm_sheets.methods.linkage.forces import Kinetostatics
from tmm_sheets.methods.linkage.motion import Sliding, Velocities, ordered
from tmm_sheets.numbers import NOISE
from tmm_sheets.words import marked, tell, tr

_SOURCE = "000, 4"
OF_PAIR: StepTable = {
    "ρ#": ("f r", "ρ_{#}", Rule(
        "circle of friction", lambda f, r: f * r, ("number", "length"), "length", "", unit="m", source=_SOURCE, exact=True)),
    "φ": ("f", "", Rule("angle of friction", np.arctan, ("number",), "angle", "", unit="rad", source=_SOURCE, exact=True)),
    "ω#": ("ω_j ω_k", "ω_{#}", Rule(
        "relative angular velocity", lambda a, b: a - b, ("number", "number"), "number", "", unit="rad/s")),
    "Mтр#": ("ρ_hinge F ω# ω_1", lambda: tr("Mf{index}").format(index="#"), Rule(
        "moment of friction",
        lambda rho, force, w, omega: -(np.sign(np.maximum(np.abs(w) - NOISE * omega, 0.0)) * np.sign(w)) * rho * force,
        ("length", "number", "number", "number"), "number",
        marked("Moment of friction {name} = ρ·F = {0}·{1} = {value} N·m, against the relative turning."), unit="N*m",
        source=_SOURCE)),
    "φ#": ("φ side sliding l_1 ω_1", "φ_{#}", Rule(
        "deviation by the angle of friction",
        lambda phi, side, v, length, omega: np.sign(np.maximum(np.abs(v) - NOISE * length * omega, 0.0)) * side * phi,
        ("angle", "number", "vector", "length", "number"), "angle",
        marked("The reaction deviates from the normal by {name} = {value}, against the sliding."), unit="rad", source=_SOURCE)),
}
"""Friction in a pair; of its circle, and of the angle of all sliding pairs, there is one.

Links that move on each other by no more than :data:`NOISE` of the crank's own motion do not."""
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
    power_plan: Plan = field(init=False)
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
        return self.power_plan["N_тр"]

    @property
    def on_crank(self) -> Step:
        """All friction as a moment on the crank, N m."""
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
                of.radii[hinge] = record(plan, "ρ#", OF_PAIR, wheel=hinge, given={"f": given.turning, "r": given.radii[hinge]})
            force = Given(rows[index], f"reaction F{index}", f"F_{{{index}}}", "N", choice=criterion)
            moment = of.moments[index] = record(plan, "ω# Mтр#", OF_PAIR, wheel=index, given={
                "ω_j": vel.omega[j], "ω_k": vel.omega[k], "ρ_hinge": of.radii[hinge], "F": force, "ω_1": m.crank.speed})
            of.turning[index] = plan[f"ω{index}"]
            opposite = plan.add(f"Mтр{pair_index(k, j)}", OPPOSITE_COUPLE, moment,
                                symbol=tr("Mf{index}").format(index=pair_index(k, j)))
            for link, couple in ((j, moment), (k, opposite)):
                of.hinges[couple.name] = hinge
                if link != m.frame:
                    of.couples.setdefault(link, []).append(couple)
        elif pair.motion == "translation" and given.sliding:
            if of.angle is None:
                of.angle = record(plan, "φ", OF_PAIR, given={"f": given.sliding})
            of.sliding[index] = sliding.velocities[index]
            side = Given(rows[index], f"side of F{index}", choice=criterion)
            of.deviations[index] = of.deviations[pair_index(k, j)] = record(plan, "φ#", OF_PAIR, wheel=index, given={
                "side": side, "sliding": sliding.velocities[index], "l_1": m.crank.length, "ω_1": m.crank.speed})
        else:
            continue
        of.pairs[index] = pair
    return of


REACH = 6.0
"""Line of action of a reaction that touches a circle of friction, in radii of the circle."""


def _touch_lines(args: Any, value: Any) -> tuple[Helper, ...]:
    centre, force, _, radius = args
    circle = Helper("circle", centre, radius=radius)
    if not abs(force) > 0:
        return (circle,)
    return circle, Helper("line", centre, value), Helper("line", value, value - REACH * radius * force / abs(force))


OF_POWER: StepTable = {
    "T#": ("hinge F M ρ_hinge", "T_{#}", Rule(
        "reaction that touches the circle of friction",
        lambda centre, force, moment, radius: centre - 1j * force * moment / np.abs(force) ** 2,
        ("point", "force", "number", "length"), "point",
        marked("About {0} draw the circle of friction with the radius {3}; the line of the reaction {1} touches it at "
               "{name}."), _touch_lines, unit="m")),
    "N#": ("F sliding", "", Rule(
        "power of a reaction on sliding", lambda f, v: (f * np.conj(v)).real, ("force", "vector"), "number",
        marked("Power of friction {name} = F·V·cos(F̅, V̅) = {value} W."), unit="W")),
    "Mтр": ("N_тр ω_1", lambda: tr("Mf"), Rule(
        "moment of friction reduced to the crank", lambda power, omega: power / omega, ("number", "number"), "number",
        marked("Friction in all pairs, reduced to the input link by its power: {formula}."), unit="N*m")),
}
TURNING: StepTable = {
    "N#": ("M ω", "", Rule("power of a moment of friction", lambda m, w: m * w, ("number", "number"), "number", "", unit="W")),
}
ALL_POWER = Rule("power of all friction", lambda *powers: reduce(add, powers), ("number",), "number",
                 marked("Power of friction in all pairs {name} = {value} W."), unit="W")
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
        force = found.reactions[f"F{index}"]
        if index in of.moments:
            hinge = pair.name.rstrip("′″")
            of.powers[index] = record(plan, "T# N#", TURNING, OF_POWER, wheel=index, given={
                "hinge": vel.positions.points[hinge], "F": force, "M": of.moments[index], "ω": of.turning[index],
                "ρ_hinge": of.radii[hinge]})
            of.touches[index] = plan[f"T{index}"]
        else:
            of.powers[index] = record(plan, "N#", OF_POWER, wheel=index, given={"F": force, "sliding": of.sliding[index]})
    parts: list[Any] = list(of.powers.values()) or [Given(np.zeros(len(of.plan.labels)), "no friction", unit="W")]
    plan.add("N_тр", ALL_POWER, *parts, symbol=tr("N_f"))
    record(plan, "Mтр", OF_POWER, given={"ω_1": vel.omega[crank.link]})
