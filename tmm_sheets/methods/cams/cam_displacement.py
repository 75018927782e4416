"""The position function as formula steps: phases of a turn, displacement and both derivatives at any cam angles.

Source: manual 000, section 7.1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np

from tmm_sheets.construction.arithmetic import by_pieces
from tmm_sheets.construction.expression import Floats, Reals, primitive
from tmm_sheets.construction.step import Given, Kind, Plan, Rule, Step, StepTable, record
from tmm_sheets.methods.cams.cam_laws import (
    PHASES,
    Law,
    Phase,
    PositionFunction,
    displaced,
    first_derivative,
    second_derivative,
    share,
    within_turn,
)
from tmm_sheets.numbers import ROUNDING
from tmm_sheets.words import marked, tr

SOURCE = "000, 7.1"
KINDS: dict[str, tuple[Kind, Kind, Kind]] = {
    "S": ("ordinate", "ordinate", "ordinate"), "ψ": ("inclination", "number", "number"),
}  # fmt: skip
"""Kinds of the displacement and its derivatives, by its symbol: m, or rad."""

PHASE = Rule("phase angle", lambda x: x, ("angle",), "angle", marked("Given phase angle {name} = {value}."), unit="rad",
             source=SOURCE)
NEXT = Rule("end of a phase", lambda start, angle: start + angle, ("angle", "angle"), "angle",
            marked("The phase ends at the angle {name} = {0} + {1} = {value}."), unit="rad")
OF_TURN: StepTable = {
    "φ_у": ("rise", partial(tr, PHASES["φ_у"]), PHASE),
    "φ_дс": ("dwell", partial(tr, PHASES["φ_дс"]), PHASE),
    "φ_с": ("fall", partial(tr, PHASES["φ_с"]), PHASE),
    "S_max": ("stroke", "S_{max}", Rule("stroke", lambda x: x, ("length",), "length",
            marked("Given stroke of the follower {name} = {value}."), source=SOURCE)),
    "ψ_max": ("stroke", "ψ_{max}", Rule("swing", lambda x: x, ("inclination",), "inclination",
            marked("Given angle of swing of the rocker {name} = {value}."), unit="rad", source=SOURCE)),
    "−S_max": ("S_max", "", Rule("travel of the fall", lambda x: -x, ("ordinate",), "ordinate",
            marked("On the return the displacement falls by the whole stroke: {name} = {value}."))),
    "−ψ_max": ("ψ_max", "", Rule("swing of the fall", lambda x: -x, ("inclination",), "inclination",
            marked("On the return the angle of the rocker falls by the whole angle of swing: {name} = {value}."), unit="rad")),
    "φ_2": ("φ_у φ_дс", "", NEXT),
    "φ_3": ("φ_2 φ_с", "", NEXT),
    "φ_бс": ("φ_3", partial(tr, PHASES["φ_бс"]), Rule("lower dwell", lambda end: 2 * np.pi - end, ("angle",), "angle",
            marked("Left for the lower dwell: {name} = 360° − {0} = {value}."), unit="rad")),
}
"""The phases of a turn with the stroke, or the angle of swing of a rocker."""

ANGLES = Rule("cam angles", lambda x: x, ("angle",), "angle", marked("Cam angle {name} = {value}."), unit="rad")
TURN = Rule("within a turn", within_turn, ("angle",), "angle", marked("Within a turn this angle is {name} = {value}."), unit="rad")
SHARE = Rule("share of a phase", share, ("angle", "angle", "angle"), "number",
             marked("Part of the phase passed, from 0 to 1: {name} = ({0} − {1})/{2} = {value}."),
             unit="1", source=SOURCE)
NUMBERED = Rule("share at numbered positions", lambda x: x, ("number",), "number",
                marked("Each phase is divided into equal parts; part passed {name} = {value}."), unit="1")
AT_SHARE = Rule("cam angle of a share", lambda start, angle, x: start + angle * x, ("angle", "angle", "number"), "angle",
                marked("This part of the phase corresponds to the cam angle {name} = {0} + {1}·{2} = {value}."), unit="rad")
OF_POSITION = Rule("cam angle of a position", by_pieces, ("number", "angle", "number", "angle"), "angle",
                   marked("Cam angle at this position {name} = {value}."), unit="rad")
CHOICE = Rule("share found", lambda x: x, ("number",), "number",
              marked("Find the place by search: part of the phase {name} = {value}."), unit="1")


@primitive("row", "real")
def row(*values: Any) -> Any:
    """Numbers as one row."""
    return np.array([np.real(v) for v in values], dtype=float) if values else np.zeros(0)


ORDERS = ("displacement", "first derivative", "second derivative")


def of_orders(name: str, *of: tuple[Callable[..., Any], Callable[[Kind, Kind], tuple[Kind, ...]], str],
              source: str = "") -> dict[str, tuple[Rule, ...]]:
    """A rule for the displacement and for each derivative, by the symbol of the displacement.

    ``of``: what each computes, takes, and says; what it takes depends on the kinds of the displacement and of its own result.
    """
    return {symbol: tuple(
        Rule(name.format(order) + (" of a rocker" if symbol == "ψ" else ""), compute, takes(kinds[0], kind), kind, said,
             unit=unit if symbol == "ψ" else "", source=source)
        for order, kind, unit, (compute, takes, said) in zip(ORDERS, kinds, ("rad", "1", "1"), of, strict=False))
        for symbol, kinds in KINDS.items()}


IN_PHASE = of_orders(
    "{} in a phase",
    (displaced, lambda s, own: (s, s, "number"), marked("Displacement in this phase {name} = {0} + {1}·{2} = {value}.")),
    (first_derivative, lambda s, own: (s, "angle", "number"), marked("First derivative: {formula}.")),
    (second_derivative, lambda s, own: (s, "angle", "number"), marked("Second derivative: {formula}.")), source=SOURCE)
IN_TURN = of_orders("{}", *((by_pieces, lambda s, own: ("angle", own), said) for said in (
    marked("Displacement by the phase in which the angle lies: {name} = {value}."),
    marked("First derivative by the phase in which the angle lies: {name} = {value}."),
    marked("Second derivative by the phase in which the angle lies: {name} = {value}."))))


@cache
def _law_rule(law: Law, order: int) -> Rule:
    return Rule(f"{law.name} law, {ORDERS[order]}", law.forms[order],
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


_TRAVELLED = {"φ_у": marked("Displacement on the rise {name} = {0} + {1}·{2} = {value}."),
              "φ_с": marked("Displacement on the return {name} = {0} + {1}·{2} = {value}.")}


def names(symbol: str) -> tuple[str, str, str]:
    """Symbols of the displacement and its derivatives."""
    return symbol, f"{symbol}'", f"{symbol}''"


@dataclass(frozen=True)
class Displacement:
    """Displacement of the follower (m, or rad of a rocker) and its derivatives at the cam angles ``phi``, exact for the law."""

    plan: Plan
    phi: Step
    s: Step
    ds: Step
    dds: Step


@dataclass(frozen=True)
class ExactMotion:
    """Everything that follows from the law alone; each part is recorded when it is first asked for."""

    law: PositionFunction

    @cached_property
    def phases(self) -> Phases:
        """The phases of a turn."""
        law, plan = self.law, Plan("cam-phases", tr("Phases of the cam"), "m")
        record(plan, f"φ_у φ_дс φ_с {law.symbol}_max −{law.symbol}_max φ_2 φ_3 φ_бс", OF_TURN, given={
            "rise": law.rise.angle, "dwell": law.upper_dwell.angle, "fall": law.fall.angle, "stroke": law.stroke})
        rise, dwell, fall, travel, back, down, end, idle = plan
        return Phases(plan, {"φ_у": (0.0, rise, 0.0, travel), "φ_дс": (rise, dwell, travel, 0.0), "φ_с": (down, fall, travel, back),
                             "φ_бс": (end, idle, 0.0, 0.0)}, {"φ_у": rise, "φ_дс": down, "φ_с": end})

    def in_phase(self, plan: Plan, phase: Phase, x: Reals, tag: str, orders: Iterable[int] = (0, 1, 2)) -> list[Step]:
        """Record displacement and derivatives of a phase at the share ``x``, named with the index ``tag``."""
        _, angle, first, travel = self.phases.of[phase.symbol]
        written = phase.index if tag == phase.tag else tag
        found = []
        for order in orders:
            symbol = names(self.law.symbol)[order]
            f = plan.add(f"{names('f')[order]}_{tag}", _law_rule(phase.law, order), x, *phase.law.nodes,
                         say=tr(_LAW[order]).format(law=tr(phase.law.title)), symbol=f"{names('f')[order]}_{{{written}}}")
            args = (first, travel, f) if order == 0 else (travel, angle, f)
            say = tr(_TRAVELLED[phase.symbol]) if order == 0 and phase.symbol in _TRAVELLED else None
            found.append(plan.add(f"{symbol}_{tag}", IN_PHASE[self.law.symbol][order], *args, say=say,
                                  symbol=f"{symbol}_{{{written}}}"))
        return found

    def found(self, plan: Plan, phase: Phase, x: float, tag: str, choice: str, orders: Iterable[int] = (0, 1, 2)) -> list[Step]:
        """Record the same at the share that a search found by the criterion ``choice``, with the share and the cam angle there."""
        share = plan.add(f"x_{tag}", CHOICE, Given(x, f"x_{tag}", choice=choice, over="none", unit="1"), symbol=f"x_{{{tag}}}",
                         say=tr("By search find the place where {choice}: part of the phase {{name}} = "
                                "{{value}}.").format(choice=choice))
        start, angle, _, _ = self.phases.of[phase.symbol]
        plan.add(f"φ_{tag}", AT_SHARE, start, angle, share, symbol=f"φ_{{{tag}}}")
        return self.in_phase(plan, phase, share, tag, orders)

    def displacement(self, plan: Plan, phi: Reals) -> Displacement:
        """Record displacement and derivatives at cam angles, rad: in a jump of the second derivative that of the later phase."""
        told = turn = plan.add("φ", ANGLES, phi, symbol="φ")
        angles = np.asarray(phi.value)
        if ((angles < 0) | (angles > 2 * np.pi)).any():
            turn = plan.add("φ_1", TURN, told)
        law, at, moving = self.law, self.phases, {}
        for p in (law.rise, law.fall):
            start, angle, _, _ = at.of[p.symbol]
            x = plan.add(f"x_{p.tag}", SHARE, turn, start, angle, symbol=f"x_{p.index}")
            moving[p.symbol] = self.in_phase(plan, p, x, p.tag)
        found = []
        for order, name in enumerate(names(law.symbol)):
            pieces: list[Any] = []
            for p in law.phases:
                still = at.of[p.symbol][2] if order == 0 else 0.0
                pieces += [moving[p.symbol][order] if p.symbol in moving else still, at.ends.get(p.symbol)]
            found.append(plan.add(name, IN_TURN[law.symbol][order], turn, *pieces[:-1], symbol=name))
        return Displacement(plan, told, *found)

    @cached_property
    def positions(self) -> Displacement:
        """Displacement and derivatives at the numbered positions: those of the phase that a position belongs to."""
        law, n = self.law, self.law.parts
        plan = Plan("cam-law", tr("Law of motion of the follower") if law.symbol == "S" else tr("Law of motion of the rocker"), "m",
                    law.labels)
        shares = Given(np.concatenate((law.shares, law.shares)), "cam.parts",
                       choice=tr("each phase is divided into {n} equal parts").format(n=n))
        place = Given(np.arange(2.0 * n + 2), "cam.parts", choice=tr("number of the position in order"))
        x = plan.add("x", NUMBERED, shares, symbol="x")
        both = [self.in_phase(plan, p, x, p.tag) for p in (law.rise, law.fall)]
        up, down = (plan.add(f"φ_{k}", AT_SHARE, *self.phases.of[p.symbol][:2], x) for k, p in enumerate((law.rise, law.fall), 1))
        phi = plan.add("φ", OF_POSITION, place, up, n + 0.5, down, symbol="φ")
        return Displacement(plan, phi, *(
            plan.add(name, IN_TURN[law.symbol][order], place, both[0][order], n + 0.5, both[1][order], symbol=name)
            for order, name in enumerate(names(law.symbol))))

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
        phi = Given(self.law.positions + side * ROUNDING, "cam.parts", choice=choice, unit="rad")
        return self.displacement(Plan(name, title, "m", self.law.labels), phi)

    def at(self, name: str, title: str, phi: Reals, choice: str) -> Displacement:
        """Displacement and derivatives at any cam angles, rad."""
        plan = Plan(name, title, "m", tuple(map(str, range(len(phi)))))
        return self.displacement(plan, Given(phi, "cam.parts", choice=choice, over="curve", unit="rad"))

    def display(self, parts: int = 64) -> Floats:
        """Cam angles from the rise to the end of the fall for smooth curves, rad: jumps are met from both sides."""
        phases = self.law.phases[:-1] if self.law.lower_dwell.angle else self.law.phases
        return np.concatenate([p.phi(np.linspace(a + ROUNDING, b - ROUNDING, parts + 1))
                               for p in phases for a, b in pairwise((0.0, *p.law.jumps, 1.0))])
