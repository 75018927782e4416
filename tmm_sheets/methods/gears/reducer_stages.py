"""Wheels and planetary stages of a reducer, with their speeds."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from tmm_sheets.construction.step import Step
from tmm_sheets.methods.gears.planetary import Driver


@dataclass(frozen=True, eq=False)
class ReducerWheel:
    """A wheel of the reducer: its number, teeth, and the steps of its pitch circle's diameter (mm) and speed (1/min)."""

    number: str
    teeth: int
    d: Step
    n: Step

    @property
    def diameter(self) -> float:
        """Of the pitch circle, m."""
        return float(self.d.value) / 1e3

    @property
    def speed(self) -> float:
        """Positive as the input's, rad/s."""
        return float(self.n.value) * pi / 30


@dataclass(frozen=True, eq=False)
class Stage:
    """One planetary stage: its wheels in the order 1, 2, 3, 4 of the formulas (a single row: 1, 2, 2, 4) and its carrier.

    ``a_H`` is the step of the distance of the satellites' axes from the main one (mm), ``n_H`` that of the carrier's speed (1/min).
    """

    signs: tuple[int, int]
    driver: Driver
    wheels: tuple[ReducerWheel, ReducerWheel, ReducerWheel, ReducerWheel]
    carrier: str
    a_H: Step
    n_H: Step

    @property
    def single(self) -> bool:
        """True when one wheel meshes with both central wheels."""
        return self.wheels[1] is self.wheels[2]

    @property
    def axis(self) -> float:
        """Distance of the satellites' axes from the main one, m."""
        return float(self.a_H.value) / 1e3

    @property
    def fixed(self) -> ReducerWheel:
        """The central wheel that stands still."""
        return self.wheels[0] if self.driver == "ring" else self.wheels[3]

    @property
    def entry(self) -> Step:
        """Speed of the driving link, 1/min."""
        return {"sun": self.wheels[0].n, "ring": self.wheels[3].n, "carrier": self.n_H}[self.driver]
