"""Wheels and planetary stages of a reducer, with their speeds."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_sheets.methods.gears.planetary import Driver


@dataclass(frozen=True)
class ReducerWheel:
    """A wheel of the reducer: ``name`` "z3" .. with its number, teeth, diameter of the pitch circle (m), speed (rad/s)."""

    number: str
    teeth: int
    diameter: float
    speed: float


@dataclass(frozen=True)
class Stage:
    """One planetary stage: its wheels in the order 1, 2, 3, 4 of the formulas (a single row: 1, 2, 2, 4) and its carrier."""

    signs: tuple[int, int]
    driver: Driver
    wheels: tuple[ReducerWheel, ReducerWheel, ReducerWheel, ReducerWheel]
    carrier: str
    carrier_speed: float

    @property
    def single(self) -> bool:
        """True when one wheel meshes with both central wheels."""
        return self.wheels[1] is self.wheels[2]

    @property
    def axis(self) -> float:
        """Distance of the satellites' axes from the main one, m."""
        return (self.wheels[0].diameter + self.signs[0] * self.wheels[1].diameter) / 2

    @property
    def fixed(self) -> ReducerWheel:
        """The central wheel that stands still."""
        return self.wheels[0] if self.driver == "ring" else self.wheels[3]

    @property
    def input_speed(self) -> float:
        """Speed of the driving link, rad/s."""
        return {"sun": self.wheels[0].speed, "ring": self.wheels[3].speed, "carrier": self.carrier_speed}[self.driver]

    @property
    def output_speed(self) -> float:
        """Speed of the driven link, rad/s."""
        return self.wheels[0].speed if self.driver == "carrier" else self.carrier_speed
