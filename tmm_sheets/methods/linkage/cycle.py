"""A cycle: numbered positions of the crank, and the strokes of the output point among them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.construction.given import Given
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.quantities import Reals
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.linkage.strokes import Floats, Run
from tmm_sheets.words import tell


@dataclass(frozen=True)
class Strokes:
    """Working stroke of the output point between its dead positions.

    ``begin`` and ``end`` are crank angles turned from position 0 in the sense of rotation, rad; ``path`` is the unit
    vector of the working stroke, ``length`` its length, m; ``origin`` the output point at its beginning. ``runs`` are the
    stretches between the reversals of the whole turn, the working stroke first.
    """

    output: str
    begin: float
    end: float
    path: complex
    length: float
    origin: complex
    runs: tuple[Run, ...]

    def working(self, turned: Reals, side: int = 0) -> Any:
        """True on the working stroke, at angles ``turned`` from position 0, rad, of any shape.

        In a dead position ``side`` says which of the strokes that meet there counts: -1 the one before, +1 the one after, 0 none.
        """
        t = np.mod(np.asarray(turned, dtype=float) - self.begin, 2 * np.pi)
        width = np.mod(self.end - self.begin, 2 * np.pi)
        near = 1e-12
        t = np.where(2 * np.pi - t < near, 0.0, t)
        if side > 0:
            return np.asarray(t < width - near)
        if side < 0:
            return np.asarray((t > near) & (t <= width + near))
        return np.asarray((t > near) & (t < width - near))


def closed(labels: tuple[str, ...]) -> tuple[str, ...]:
    """Numbers of the positions with the one that closes the cycle: the next number, or the first again that has it."""
    first, *others = labels
    last = str(int(others[-1]) + 1) if others and others[-1].isdigit() else first
    return (*labels, first if last in others else last)


@dataclass(frozen=True)
class Cycle:
    """Numbered positions: angles ``turned`` from position 0 in the sense of rotation, world angles ``phi``, rad, shape (n,).

    ``plan`` constructs the dead positions, ``numbering`` has the crank angles as steps. ``swings`` is True for a crank that does
    not turn round: ``period`` is then the angle of its swing, from the first position to the last.
    """

    labels: tuple[str, ...]
    turned: Floats
    start: float
    sense: float
    period: float
    strokes: Strokes | None
    plan: Plan | None
    numbering: Plan | None = None
    swings: bool = False

    @property
    def ends(self) -> tuple[str, ...]:
        """Numbers along an axis over the cycle: those of the positions and the one that closes a turn; a swing ends at its last."""
        return self.labels if self.swings else closed(self.labels)

    @property
    def plans(self) -> dict[str, Plan]:
        """Dead positions, where they are constructed, and the crank angles of the positions."""
        return {plan.name: plan for plan in (self.plan, self.numbering) if plan is not None}

    def angles(self, turned: Any) -> Any:
        """World angles of the crank for angles turned from position 0: a step for the numbered positions, a row for others."""
        if turned is self.turned and self.numbering is not None:
            return self.numbering["φ"]
        return Given(self.world(turned), "crank angles", "φ_1", "rad")

    def turned_row(self, turned: Any) -> Any:
        """Angles turned from position 0: a step for the numbered positions, a row for others."""
        if turned is self.turned and self.numbering is not None:
            return self.numbering["φ_п"]
        return Given(turned, "angles turned", "φ", "rad")

    @property
    def ring(self) -> Floats:
        """Angles turned at which paths are drawn, rad: all round the turn, or over the swing."""
        return np.linspace(0, self.period if self.swings else 2 * np.pi, 181)

    @property
    def phi(self) -> Floats:
        """World angles of the crank, rad counter-clockwise, shape (n,); a whole multiple of the turn away from (-pi, pi]."""
        return np.asarray(self.world(self.turned), dtype=np.float64)

    @property
    def drawn(self) -> tuple[tuple[int, str], ...]:
        """Positions of the first turn, each with its labels: a later turn repeats the plans of the first ("1, 9")."""
        found = []
        for i, t in enumerate(self.turned):
            if t < 2 * np.pi - 1e-9:
                same = [self.labels[j] for j in np.flatnonzero(np.abs(np.exp(1j * self.turned) - np.exp(1j * t)) < 1e-9)]
                found.append((i, ", ".join(sorted(same, key=int) if all(map(str.isdecimal, same)) else same)))
        return tuple(found)

    def world(self, turned: Reals) -> Any:
        """World angles of the crank for angles turned from position 0, rad, of any shape."""
        return self.start + self.sense * np.asarray(turned)

    def index(self, label: str, asked: str = "") -> int:
        """Number of the position with this label; ``asked`` says where it was asked for.

        Raises
        ------
        CannotBuild
            when no position has it.
        """
        try:
            return self.labels.index(label)
        except ValueError:
            raise CannotBuild(asked + tell("there is no position {label}").format(label=label),
                              tell("the positions are {labels}").format(labels=", ".join(self.labels))) from None
