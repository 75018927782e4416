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
import numpy.typing as npt

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Kind, Rule, Step
from tmm_sheets.methods.cams.cam_laws import (
    Law,
    Phase,
    PositionFunction,
    by_pieces,
    displaced,
    first_derivative,
    second_derivative,
    share,
    within_turn,
)

Reals = npt.NDArray[np.float64]

SOURCE = "000, 7.1"
INSIDE = 1e-12
"""A share of a phase, or rad: how far inside a border one-sided limits are read."""
KINDS: dict[str, tuple[Kind, Kind, Kind]] = {
    "S": ("ordinate", "ordinate", "ordinate"), "ψ": ("inclination", "number", "number"),
}  # fmt: skip
"""Kinds of the displacement and its derivatives, by its symbol: m, or rad."""

PHASE = Rule("phase angle", lambda x: x, ("angle",), "angle", "По заданию фазовый угол {name} = {value}.", unit="rad",
             source=SOURCE)
STROKE = Rule("stroke", lambda x: x, ("length",), "length", "По заданию ход толкателя {name} = {value}.", source=SOURCE)
SWING = Rule("swing", lambda x: x, ("inclination",), "inclination", "По заданию угол качания коромысла {name} = {value}.",
             unit="rad",
             source=SOURCE)
BACK = Rule("travel of the fall", lambda x: -x, ("ordinate",), "ordinate",
            "На возвращении перемещение убывает на весь ход: {name} = {value}.")
BACK_ANGLE = Rule("swing of the fall", lambda x: -x, ("inclination",), "inclination",
                  "На возвращении угол коромысла убывает на весь угол качания: {name} = {value}.", unit="rad")
NEXT = Rule("end of a phase", lambda start, angle: start + angle, ("angle", "angle"), "angle",
            "Фаза кончается при угле {name} = {0} + {1} = {value}.", unit="rad")
IDLE = Rule("lower dwell", lambda end: 2 * np.pi - end, ("angle",), "angle",
            "На ближнее стояние остаётся {name} = 360° − {0} = {value}.", unit="rad")

ANGLES = Rule("cam angles", lambda x: x, ("angle",), "angle", "Угол поворота кулачка {name} = {value}.", unit="rad")
TURN = Rule("within a turn", within_turn, ("angle",), "angle", "В пределах оборота этот угол {name} = {value}.", unit="rad")
SHARE = Rule("share of a phase", share, ("angle", "angle", "angle"), "number",
             "Пройденная доля фазы, от 0 до 1: {name} = ({0} − {1})/{2} = {value}.",
             unit="1", source=SOURCE)
NUMBERED = Rule("share at numbered positions", lambda x: x, ("number",), "number",
                "Каждая фаза разделена на равные части; пройденная доля {name} = {value}.", unit="1")
AT_SHARE = Rule("cam angle of a share", lambda start, angle, x: start + angle * x, ("angle", "angle", "number"), "angle",
                "Этой доле соответствует угол поворота кулачка {name} = {0} + {1}·{2} = {value}.", unit="rad")


@primitive("row")
def row(*values: Any) -> Any:
    """Numbers as one row."""
    return np.array([np.real(v) for v in values], dtype=float) if values else np.zeros(0)


def _of_phase(symbol: str) -> tuple[Rule, Rule, Rule]:
    s, ds, dds = KINDS[symbol]
    travel: Kind = s
    angular = " of a rocker" if symbol == "ψ" else ""
    return (
        Rule(f"displacement in a phase{angular}", displaced, (s, travel, "number"), s,
             "Перемещение на этой фазе {name} = {0} + {1}·{2} = {value}.", unit="rad" if angular else "", source=SOURCE),
        Rule(f"first derivative in a phase{angular}", first_derivative, (travel, "angle", "number"), ds,
             "Аналог скорости {name} = h/φ·f', где h – ход этой фазы со знаком, φ – её угол в радианах: {value}.",
             unit="1" if angular else "", source=SOURCE),
        Rule(f"second derivative in a phase{angular}", second_derivative, (travel, "angle", "number"), dds,
             "Аналог ускорения {name} = h/φ²·f'' = {value}.", unit="1" if angular else "", source=SOURCE),
    )


def _of_turn(symbol: str) -> tuple[Rule, Rule, Rule]:
    names = ("Перемещение", "Аналог скорости", "Аналог ускорения")
    angular = " of a rocker" if symbol == "ψ" else ""
    rules = (Rule(f"{('displacement', 'first derivative', 'second derivative')[i]}{angular}", by_pieces, ("angle", kind), kind,
                  f"{names[i]} по фазе, в которой лежит угол: {{name}} = {{value}}.", unit=("rad", "1", "1")[i] if angular else "")
             for i, kind in enumerate(KINDS[symbol]))
    return next(rules), next(rules), next(rules)


IN_PHASE = {symbol: _of_phase(symbol) for symbol in KINDS}
IN_TURN = {symbol: _of_turn(symbol) for symbol in KINDS}


@cache
def _law_rule(law: Law, order: int) -> Rule:
    whose = ("относительное перемещение", "его производная по доле фазы", "вторая производная по доле фазы")[order]
    return Rule(f"{law.name} law, {('displacement', 'first derivative', 'second derivative')[order]}", law.forms[order],
                ("number",), "number", f"Закон {law.title}: {whose} {{name}} = {{value}}.", unit="1", source=SOURCE)


@dataclass(frozen=True)
class Phases:
    """The phases of a turn as steps, with start, angle, displacement at the start and travel of each by its symbol."""

    plan: Plan
    of: dict[str, tuple[Any, Any, Any, Any]]
    ends: dict[str, Step]


def phases(law: PositionFunction) -> Phases:
    """Record the phases of a position function."""
    plan = Plan("cam-phases", "Фазы поворота кулачка", "m")
    straight = law.symbol == "S"
    rise, dwell, fall = (plan.add(p.symbol, PHASE, p.angle, symbol=p.symbol) for p in (law.rise, law.upper_dwell, law.fall))
    travel = plan.add(f"{law.symbol}_max", STROKE if straight else SWING, law.stroke, symbol=f"{law.symbol}_{{max}}")
    back = plan.add(f"−{law.symbol}_max", BACK if straight else BACK_ANGLE, travel)
    down = plan.add("φ_2", NEXT, rise, dwell)
    end = plan.add("φ_3", NEXT, down, fall)
    idle = plan.add("φ_бс", IDLE, end, symbol="φ_бс")
    return Phases(plan, {"φ_у": (0.0, rise, 0.0, travel), "φ_дс": (rise, dwell, travel, 0.0), "φ_с": (down, fall, travel, back),
                         "φ_бс": (end, idle, 0.0, 0.0)}, {"φ_у": rise, "φ_дс": down, "φ_с": end})


_WHERE = {"φ_у": "на удалении", "φ_с": "на возвращении"}


def names(symbol: str) -> tuple[str, str, str]:
    """Symbols of the displacement and its derivatives."""
    return symbol, f"{symbol}'", f"{symbol}''"


def in_phase(plan: Plan, law: PositionFunction, at: Phases, phase: Phase, x: Any, tag: str,
             orders: Iterable[int] = (0, 1, 2)) -> list[Step]:
    """Record displacement and derivatives of a phase at the share ``x``, named with the index ``tag``."""
    _, angle, first, travel = at.of[phase.symbol]
    found = []
    for order in orders:
        symbol = names(law.symbol)[order]
        f = plan.add(f"{names('f')[order]}_{tag}", _law_rule(phase.law, order), x, *phase.law.nodes,
                     symbol=f"{names('f')[order]}_{{{tag}}}")
        args = (first, travel, f) if order == 0 else (travel, angle, f)
        rule = IN_PHASE[law.symbol][order]
        say = rule.wording.replace("на этой фазе", _WHERE.get(phase.symbol, "на этой фазе"))
        found.append(plan.add(f"{symbol}_{tag}", rule, *args, say=say, symbol=f"{symbol}_{{{tag}}}"))
    return found


@dataclass(frozen=True)
class Displacement:
    """Displacement of the follower (m, or rad of a rocker) and its derivatives at the cam angles ``phi``, exact for the law."""

    plan: Plan
    phi: Step
    s: Step
    ds: Step
    dds: Step


def displacement(plan: Plan, law: PositionFunction, at: Phases, phi: Any) -> Displacement:
    """Record displacement and derivatives at cam angles, rad: in a jump of the second derivative that of the later phase."""
    told = turn = plan.add("φ", ANGLES, phi, symbol="φ")
    angles = np.asarray(phi.value)
    if ((angles < 0) | (angles > 2 * np.pi)).any():
        turn = plan.add("φ_1", TURN, told)
    moving = {}
    for p in (law.rise, law.fall):
        start, angle, _, _ = at.of[p.symbol]
        tag = p.symbol.removeprefix("φ_")
        x = plan.add(f"x_{tag}", SHARE, turn, start, angle, symbol=f"x_{tag}")
        moving[p.symbol] = in_phase(plan, law, at, p, x, tag)
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
    shares = Given(np.concatenate((law.shares, law.shares)), "cam.parts", choice=f"каждая фаза делится на {n} равных частей")
    place = Given(np.arange(2.0 * n + 2), "cam.parts", choice="номер положения по порядку")
    x = plan.add("x", NUMBERED, shares, symbol="x")
    both = [in_phase(plan, law, at, p, x, p.symbol.removeprefix("φ_")) for p in (law.rise, law.fall)]
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
        whose = "толкателя" if self.law.symbol == "S" else "коромысла"
        return numbered(Plan("cam-law", f"Закон движения {whose}", "m", self.law.labels), self.law, self.phases)

    @cached_property
    def before(self) -> Displacement:
        """Limits from below at the numbered positions."""
        return self._beside(-1, "cam-law-left-between", "слева")

    @cached_property
    def after(self) -> Displacement:
        """Limits from above at the numbered positions."""
        return self._beside(1, "cam-law-right-between", "справа")

    def _beside(self, side: int, name: str, where: str) -> Displacement:
        phi = Given(self.law.positions + side * INSIDE, "cam.parts", choice=f"нумерованные положения, предел {where}", unit="rad")
        return displacement(Plan(name, f"Пределы {where} в нумерованных положениях", "m", self.law.labels), self.law, self.phases,
                            phi)

    def at(self, name: str, title: str, phi: Any, choice: str) -> Displacement:
        """Displacement and derivatives at any cam angles, rad."""
        plan = Plan(name, title, "m", tuple(map(str, range(len(phi)))))
        return displacement(plan, self.law, self.phases, Given(phi, "cam.parts", choice=choice, over="curve", unit="rad"))

    def display(self, parts: int = 64) -> Reals:
        """Cam angles from the rise to the end of the fall for smooth curves, rad: jumps are met from both sides."""
        found = []
        for p in self.law.phases[:-1] if self.law.lower_dwell.angle else self.law.phases:
            for a, b in pairwise((0.0, *p.law.jumps, 1.0)):
                found.append(p.phi(np.linspace(a + INSIDE, b - INSIDE, parts + 1)))
        return np.concatenate(found)


OF_POSITION = Rule("cam angle of a position", by_pieces, ("number", "angle", "number", "angle"), "angle",
                   "Угол поворота кулачка в этом положении {name} = {value}.", unit="rad")
