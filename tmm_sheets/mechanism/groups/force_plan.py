"""Loads on a link and the polygon they are laid off in."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal

from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.words import marked

Role = Literal["weight", "inertia", "applied", "reaction"]

CLOSE = Rule("close a polygon", lambda tail, head: head - tail, ("point", "point"), "force",
             marked("Close the polygon: {name} = |{0}–{1}|·μ_F = {value}."), lambda a, v: (Helper("line", a[0], a[1]),))
OPPOSITE_COUPLE = Rule("opposite couple", lambda m: -m, ("number",), "number", marked("{name} = {value} N·m."), unit="N*m")


@dataclass(frozen=True)
class Load:
    """A force on a link: symbol in sheet markup, the link, its point, the vector (N), and a couple carried with it (N m).

    ``source`` is the link a reaction comes from.
    """

    symbol: str
    link: str
    at: Step
    vector: Step
    role: Role
    couple: Step | None = None
    source: str | None = None


@dataclass(frozen=True)
class TangentialPart:
    """Part of the reaction on ``link`` from ``source`` in the hinge ``at``, N, that the moments about ``centre`` gave."""

    link: str
    source: str
    at: str
    centre: str
    vector: Step


@dataclass
class ForcePlan:
    """Force plan of one link or of a whole group: polygon 1-2-...-1 of ``plan`` with its forces in order."""

    name: str
    links: tuple[str, ...]
    plan: Plan
    sides: list[tuple[str, Step, Step, bool]] = field(default_factory=list)

    def side(self, symbol: str, tail: Step, head: Step, unknown: bool = False) -> None:
        """Record a side of the polygon; ``unknown`` sides are found by closing it."""
        self.sides.append((symbol, tail, head, unknown))
        self.plan.vector(symbol, tail, head)

    def chain(self, start: int, tail: Step, loads: Iterable[Load]) -> Step:
        """Lay the loads off one after another; returns the end of the chain."""
        for n, load in enumerate(loads, start + 1):
            head = self.plan.add(str(n), rules.SHIFT, tail, load.vector)
            self.side(load.symbol, tail, head)
            tail = head
        return tail

    def between(self, name: str, tail: Step, head: Step) -> Step:
        """The force that closes the polygon from ``tail`` to ``head``."""
        return self.plan.add(name, CLOSE, tail, head)
