"""The position function as formula steps: phases of a turn, displacement and both derivatives at any cam angles.

Source: manual 000, section 7.1.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from tmm_sheets.construction.arithmetic import by_pieces
from tmm_sheets.construction.expression import Floats, Reals, primitive
from tmm_sheets.construction.step import Given, Kind, Plan, Rule, Step
from tmm_sheets.methods.cams.cam_laws import (
    Law,
    Phase,
    PositionFunction,
    displaced,
    first_derivative,
    second_derivative,
    share,
    within_turn,
)
from tmm_sheets.words import marked, tr

SOURCE = "000, 7.1"
INSIDE = 1e-12
"""A share of a phase, or rad: how far inside a border one-sided limits are read."""
KINDS: dict[str, tuple[Kind, Kind, Kind]] = {
    "S": ("ordinate", "ordinate", "ordinate"), "ψ": ("inclination", "number", "number"),
}  # fmt: skip
"""Kinds of the displacement and its derivatives, by its symbol: m, or rad."""

PHASE = Rule("phase angle", lambda x: x, ("angle",), "angle", marked("Given phase angle {name} = {value}."), unit="rad",
             source=SOURCE)
STROKE = Rule("stroke", lambda x: x, ("length",), "length", marked("Given stroke of the follower {name} = {value}."), source=SOURCE)
SWING = Rule("swing", lambda x: x, ("inclination",), "inclination", marked("Given angle of swing of the rocker {name} = {value}."),
             unit="rad",
             source=SOURCE)
BACK = Rule("travel of the fall", lambda x: -x, ("ordinate",), "ordinate",
            marked("On the return the displacement falls by the whole stroke: {name} = {value}."))
BACK_ANGLE = Rule("swing of the fall", lambda x: -x, ("inclination",), "inclination",
                  marked("On the return the angle of the rocker falls by the whole angle of swing: {name} = {value}."), unit="rad")
NEXT = Rule("end of a phase", lambda start, angle: start + angle, ("angle", "angle"), "angle",
            marked("The phase ends at the angle {name} = {0} + {1} = {value}."), unit="rad")
IDLE = Rule("lower dwell", lambda end: 2 * np.pi - end, ("angle",), "angle",
            marked("Left for the lower dwell: {name} = 360° − {0} = {value}."), unit="rad")

ANGLES = Rule("cam angles", lambda x: x, ("angle",), "angle", marked("Cam angle {name} = {value}."), unit="rad")
TURN = Rule("within a turn", within_turn, ("angle",), "angle", marked("Within a turn this angle is {name} = {value}."), unit="rad")
SHARE = Rule("share of a phase", share, ("angle", "angle", "angle"), "number",
             marked("Part of the phase passed, from 0 to 1: {name} = ({0} − {1})/{2} = {value}."),
             unit="1", source=SOURCE)
NUMBERED = Rule("share at numbered positions", lambda x: x, ("number",), "number",
                marked("Each phase is divided into equal parts; part passed {name} = {value}."), unit="1")
AT_SHARE = Rule("cam angle of a share", lambda start, angle, x: start + angle * x, ("angle", "angle", "number"), "angle",
                marked("This part of the phase corresponds to the cam angle {name} = {0} + {1}·{2} = {value}."), unit="rad")


@primitive("row", "real")
def row(*values: Any) -> Any:
    """Numbers as one row."""
    return np.array([np.real(v) for v in values], dtype=float) if values else np.zeros(0)


def _of_phase(symbol: str) -> tuple[Rule, Rule, Rule]:
    s, ds, dds = KINDS[symbol]
    travel: Kind = s
    angular = " of a rocker" if symbol == "ψ" else ""
    return (
        Rule(f"displacement in a phase{angular}", displaced, (s, travel, "number"), s,
             marked("Displacement in this phase {name} = {0} + {1}·{2} = {value}."), unit="rad" if angular else "", source=SOURCE),
        Rule(f"first derivative in a phase{angular}", first_derivative, (travel, "angle", "number"), ds,
             marked("First derivative: {formula}."),
             unit="1" if angular else "", source=SOURCE),
        Rule(f"second derivative in a phase{angular}", second_derivative, (travel, "angle", "number"), dds,
             marked("Second derivative: {formula}."), unit="1" if angular else "", source=SOURCE),
    )


def _of_turn(symbol: str) -> tuple[Rule, Rule, Rule]:
    said = (marked("Displacement by the phase in which the angle lies: {name} = {value}."),
            marked("First derivative by the phase in which the angle lies: {name} = {value}."),
            marked("Second derivative by the phase in which the angle lies: {name} = {value}."))
    angular = " of a rocker" if symbol == "ψ" else ""
    rules = (Rule(f"{('displacement', 'first derivative', 'second derivative')[i]}{angular}", by_pieces, ("angle", kind), kind,
                  said[i], unit=("rad", "1", "1")[i] if angular else "")
             for i, kind in enumerate(KINDS[symbol]))
    return next(rules), next(rules), next(rules)


IN_PHASE = {symbol: _of_phase(symbol) for symbol in KINDS}
IN_TURN = {symbol: _of_turn(symbol) for symbol in KINDS}


@cache
def _law_rule(law: Law, order: int) -> Rule:
    return Rule(f"{law.name} law, {('displacement', 'first derivative', 'second derivative')[order]}", law.forms[order],
                ("number",), "number", "{name} = {value}.", unit="1", source=SOURCE)


_LAW = (marked("Law of motion ({law}): relative displacement {{name}} = {{value}}."),
        marked("Law of motion ({law}): its derivative over the part of the phase {{name}} = {{value}}."),
        marked("Law of motion ({law}): second derivative over the part of the phase {{name}} = {{value}}."))


@dataclass(frozen=True)
class Phases:
    """The phases of a turn as steps, with start, angle, displacement at the start and travel of each by its symbol."""

    plan: Plan
    of: dict[str, tuple[Any, Any, Any, Any]]
    ends: dict[str, Step]


def phases(law: PositionFunction) -> Phases:
    """Record the phases of a position function."""
    plan = Plan("cam-phases", tr("Phases of the cam"), "m")
    straight = law.symbol == "S"
    rise, dwell, fall = (plan.add(p.symbol, PHASE, p.angle, symbol=p.letters) for p in (law.rise, law.upper_dwell, law.fall))
    travel = plan.add(f"{law.symbol}_max", STROKE if straight else SWING, law.stroke, symbol=f"{law.symbol}_{{max}}")
    back = plan.add(f"−{law.symbol}_max", BACK if straight else BACK_ANGLE, travel)
    down = plan.add("φ_2", NEXT, rise, dwell)
    end = plan.add("φ_3", NEXT, down, fall)
    idle = plan.add("φ_бс", IDLE, end, symbol=law.lower_dwell.letters)
    return Phases(plan, {"φ_у": (0.0, rise, 0.0, travel), "φ_дс": (rise, dwell, travel, 0.0), "φ_с": (down, fall, travel, back),
                         "φ_бс": (end, idle, 0.0, 0.0)}, {"φ_у": rise, "φ_дс": down, "φ_с": end})


_TRAVELLED = {"φ_у": marked("Displacement on the rise {name} = {0} + {1}·{2} = {value}."),
              "φ_с": marked("Displacement on the return {name} = {0} + {1}·{2} = {value}.")}


def names(symbol: str) -> tuple[str, str, str]:
    """Symbols of the displacement and its derivatives."""
    return symbol, f"{symbol}'", f"{symbol}''"


def in_phase(plan: Plan, law: PositionFunction, at: Phases, phase: Phase, x: Reals, tag: str,
             orders: Iterable[int] = (0, 1, 2)) -> list[Step]:
    """Record displacement and derivatives of a phase at the share ``x``, named with the index ``tag``."""
    _, angle, first, travel = at.of[phase.symbol]
    written = phase.index if tag == phase.tag else tag
    found = []
    for order in orders:
        symbol = names(law.symbol)[order]
        f = plan.add(f"{names('f')[order]}_{tag}", _law_rule(phase.law, order), x, *phase.law.nodes,
                     say=tr(_LAW[order]).format(law=tr(phase.law.title)), symbol=f"{names('f')[order]}_{{{written}}}")
        args = (first, travel, f) if order == 0 else (travel, angle, f)
        rule = IN_PHASE[law.symbol][order]
        say = tr(_TRAVELLED[phase.symbol]) if order == 0 and phase.symbol in _TRAVELLED else None
        found.append(plan.add(f"{symbol}_{tag}", rule, *args, say=say, symbol=f"{symbol}_{{{written}}}"))
    return found


@dataclass(frozen=True)
class Displacement:
    """Displacement of the follower (m, or rad of a rocker) and its derivatives at the cam angles ``phi``, exact for the law."""

    plan: Plan
    phi: Step
    s: Step
    ds: Step
    dds: Step


def displacement(plan: Plan, law: PositionFunction, at: Phases, phi: Reals) -> Displacement:
    """Record displacement and derivatives at cam angles, rad: in a jump of the second derivative that of the later phase."""
    told = turn = plan.add("φ", ANGLES, phi, symbol="φ")
    angles = np.asarray(phi.value)
    if ((angles < 0) | (angles > 2 * np.pi)).any():
        turn = plan.add("φ_1", TURN, told)
    moving = {}
    for p in (law.rise, law.fall):
        start, angle, _, _ = at.of[p.symbol]
        x = plan.add(f"x_{p.tag}", SHARE, turn, start, angle, symbol=f"x_{p.index}")
        moving[p.symbol] = in_phase(plan, law, at, p, x, p.tag)
    found = []
    for order in range(3):
        pieces: list[Any] = []
        for p in law.phases:
            still = at.of[p.symbol][2] if order == 0 else 0.0
            pieces += [moving[p.symbol][order] if p.symbol in moving else still, at.ends.get(p.symbol)]
        found.append(plan.add(names(law.symbol)[order], IN_TURN[law.symbol][order], turn, *pieces[:-1],
                              symbol=names(law.symbol)[order]))
    return Displacement(plan, told, *found)


def numbered(plan: Plan, law: PositionFunction, at: Phases) -> Displacement:
    """Record displacement and derivatives at the numbered positions: those of the phase that a position belongs to."""
    n = law.parts
    shares = Given(np.concatenate((law.shares, law.shares)), "cam.parts",
                   choice=tr("each phase is divided into {n} equal parts").format(n=n))
    place = Given(np.arange(2.0 * n + 2), "cam.parts", choice=tr("number of the position in order"))
    x = plan.add("x", NUMBERED, shares, symbol="x")
    both = [in_phase(plan, law, at, p, x, p.tag) for p in (law.rise, law.fall)]
    (a, b, _, _), (c, d, _, _) = at.of[law.rise.symbol], at.of[law.fall.symbol]
    up, down = plan.add("φ_1", AT_SHARE, a, b, x), plan.add("φ_2", AT_SHARE, c, d, x)
    phi = plan.add("φ", OF_POSITION, place, up, n + 0.5, down, symbol="φ")
    found = [plan.add(names(law.symbol)[order], IN_TURN[law.symbol][order], place, both[0][order], n + 0.5, both[1][order],
                      symbol=names(law.symbol)[order]) for order in range(3)]
    return Displacement(plan, phi, *found)



@dataclass(frozen=True)
class ExactMotion:
    """Everything that follows from the law alone; each part is recorded when it is first asked for."""

    law: PositionFunction

    @cached_property
    def phases(self) -> Phases:
        """The phases of a turn."""
        return phases(self.law)

    @cached_property
    def positions(self) -> Displacement:
        """Displacement and derivatives at the numbered positions."""
        title = tr("Law of motion of the follower") if self.law.symbol == "S" else tr("Law of motion of the rocker")
        return numbered(Plan("cam-law", title, "m", self.law.labels), self.law, self.phases)

    @cached_property
    def before(self) -> Displacement:
        """Limits from below at the numbered positions."""
        return self._beside(-1, "cam-law-left-between", tr("Limits from the left at the numbered positions"),
                            tr("numbered positions, limit from the left"))

    @cached_property
    def after(self) -> Displacement:
        """Limits from above at the numbered positions."""
        return self._beside(1, "cam-law-right-between", tr("Limits from the right at the numbered positions"),
                            tr("numbered positions, limit from the right"))

    def _beside(self, side: int, name: str, title: str, choice: str) -> Displacement:
        phi = Given(self.law.positions + side * INSIDE, "cam.parts", choice=choice, unit="rad")
        return displacement(Plan(name, title, "m", self.law.labels), self.law, self.phases, phi)

    def at(self, name: str, title: str, phi: Reals, choice: str) -> Displacement:
        """Displacement and derivatives at any cam angles, rad."""
        plan = Plan(name, title, "m", tuple(map(str, range(len(phi)))))
        return displacement(plan, self.law, self.phases, Given(phi, "cam.parts", choice=choice, over="curve", unit="rad"))

    def display(self, parts: int = 64) -> Floats:
        """Cam angles from the rise to the end of the fall for smooth curves, rad: jumps are met from both sides."""
        found = []
        for p in self.law.phases[:-1] if self.law.lower_dwell.angle else self.law.phases:
            for a, b in pairwise((0.0, *p.law.jumps, 1.0)):
                found.append(p.phi(np.linspace(a + INSIDE, b - INSIDE, parts + 1)))
        return np.concatenate(found)


OF_POSITION = Rule("cam angle of a position", by_pieces, ("number", "angle", "number", "angle"), "angle",
                   marked("Cam angle at this position {name} = {value}."), unit="rad")
