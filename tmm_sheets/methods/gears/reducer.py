"""A planetary reducer with its simple stage (manual 003, sections 2.1-2.4): wheels, speeds, conditions, plans."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import gcd, pi, sin
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.plan import Plan, asked_for
from tmm_sheets.methods.gears import reducer_speeds
from tmm_sheets.methods.gears.planetary import SCHEMES, Driver, inner_ratio, least_ring, stage_efficiency, stage_ratio
from tmm_sheets.methods.gears.reducer_stages import ReducerWheel, Stage
from tmm_sheets.methods.gears.tooth_search import (
    ToothSet,
    asked_ratio,
    named_teeth,
    search,
    simple_numbers,
    stage_numbers,
)
from tmm_sheets.numbers import number

if TYPE_CHECKING:
    from tmm_sheets.task.schema import ReducerTable


class Reducer:
    """A planetary reducer with its simple stage: the chosen tooth numbers, the runners-up, and what follows from them."""

    def __init__(self, data: ReducerTable, sets: Sequence[ToothSet]) -> None:
        self.data = data
        self.scheme = SCHEMES[data.scheme]
        self.driver: Driver = data.driver or self.scheme.drivers[0]
        self.asked = asked_ratio(data)
        self.chosen, *rest = sets
        self.runners_up = tuple(rest)

    @cached_property
    def stages(self) -> tuple[Stage, ...]:
        """Planetary stages in the order of the power."""
        speed = self.data.input_speed
        if self.data.simple == "before":
            speed = self.simple[1].speed
        out = []
        for k in range(self.data.stages):
            out.append(self._stage(k, speed))
            speed = out[-1].output_speed
        return tuple(out)

    def _stage(self, k: int, speed: float) -> Stage:
        z, s = self.chosen.stage, self.scheme.signs
        inner = inner_ratio(s, z)
        carrier = speed if self.driver == "carrier" else speed / stage_ratio(inner, self.driver)
        one = {"sun": speed, "ring": 0.0, "carrier": carrier * (1 - inner)}[self.driver]
        four = speed if self.driver == "ring" else 0.0
        block = carrier - s[0] * (one - carrier) * z[0] / z[1]
        numbers = stage_numbers(self.data, k)
        speeds = (one, block, block, four)
        wheels = [ReducerWheel(n, t, t * self.data.module, v) for n, t, v in zip(numbers, z, speeds, strict=True)]
        if self.scheme.single:
            wheels[2] = wheels[1]
        name = f"H{k + 1}" if self.data.stages > 1 else "H"
        return Stage(s, self.driver, (wheels[0], wheels[1], wheels[2], wheels[3]), name, carrier)

    @cached_property
    def simple(self) -> tuple[ReducerWheel, ReducerWheel]:
        """Pinion and wheel of the simple stage."""
        pinion, wheel = self.chosen.pinion, self.chosen.wheel
        m = self.data.simple_module
        speed = self.data.input_speed if self.data.simple == "before" else self.stages[-1].output_speed
        first, second = simple_numbers(self.data)
        return ReducerWheel(first, pinion, pinion * m, speed), ReducerWheel(second, wheel, wheel * m, -speed * pinion / wheel)

    @property
    def simple_pair(self) -> tuple[tuple[int, int], float, float, float]:
        """Tooth numbers, module, addendum and clearance of the simple stage."""
        d = self.data
        return (self.chosen.pinion, self.chosen.wheel), d.simple_module, d.addendum, d.clearance

    @property
    def output_speed(self) -> float:
        """Speed of the output, rad/s, negative when it turns against the input."""
        return self.stages[-1].output_speed if self.data.simple == "before" else self.simple[1].speed

    @cached_property
    def wheels(self) -> tuple[ReducerWheel, ...]:
        """All wheels by their numbers."""
        found = {w.number: w for w in (*self.simple, *(w for stage in self.stages for w in stage.wheels))}
        return tuple(found[str(n)] for n in range(1, len(found) + 1))

    @property
    def stage_ratio(self) -> float:
        """Ratio of one planetary stage without sign."""
        return abs(float(stage_ratio(inner_ratio(self.scheme.signs, self.chosen.stage), self.driver)))

    @property
    def planetary_ratio(self) -> float:
        """Ratio of all planetary stages without sign."""
        return self.stage_ratio**self.data.stages

    @property
    def simple_ratio(self) -> float:
        """Ratio of the simple stage without sign."""
        return self.chosen.wheel / self.chosen.pinion

    @property
    def stage_efficiency(self) -> float:
        """Efficiency of one planetary stage."""
        inner = inner_ratio(self.scheme.signs, self.chosen.stage)
        return float(stage_efficiency(inner, self.driver, self.data.pair_efficiency**2))

    @property
    def coaxiality(self) -> tuple[int, int]:
        """Both sides of the condition, sums or differences of teeth."""
        z, s = self.chosen.stage, self.scheme.signs
        return z[0] + s[0] * z[1], z[3] + s[1] * z[2]

    @property
    def assembly(self) -> float:
        """The quotient that must be a whole number."""
        z, s = self.chosen.stage, self.scheme.signs
        return (z[0] * z[2] - s[0] * s[1] * z[1] * z[3]) / (self.data.satellites * gcd(z[1], z[2]))

    @property
    def neighbourhood(self) -> tuple[float, float]:
        """Both sides of the condition in modules: the first must be the larger."""
        z = self.chosen.stage
        return self.coaxiality[0] * sin(pi / self.data.satellites), max(z[1], z[2]) + 2 * self.data.addendum

    def teeth_of(self, teeth: ToothSet) -> dict[str, int]:
        """Tooth numbers of a set by name, "z1" ..; equal stages are named once."""
        return named_teeth(self.data, teeth)

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans that were asked for."""
        return asked_for(vars(self).values())

    @cached_property
    def velocities(self) -> Plan:
        """Picture of velocities."""
        return reducer_speeds.picture(self.simple, self.stages, self.data.simple == "before")

    def speeds(self, distance: float) -> Plan:
        """Plan of the speeds of rotation with its pole ``distance`` m over the line on which they are read."""
        if distance not in self._speed_plans:
            self._speed_plans[distance] = reducer_speeds.speeds(self.velocities, distance)
        return self._speed_plans[distance]

    @cached_property
    def _speed_plans(self) -> dict[float, Plan]:
        return {}

    @property
    def links(self) -> dict[str, float]:
        """Every turning link's speed, rad/s: wheels by number, carriers by name; a satellite block by its first wheel."""
        out = {w.number: w.speed for w in self.wheels}
        return out | {stage.carrier: stage.carrier_speed for stage in self.stages}

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Remarks for the sheet (Russian)."""
        out = []
        if self.simple_ratio < self.scheme.least_simple:
            out.append(f"передаточное отношение простой ступени меньше {number(self.scheme.least_simple)}")
        z, s = self.chosen.stage, self.scheme.signs
        numbers = stage_numbers(self.data, 0)
        for satellite, ring, sign in ((1, 0, s[0]), (2, 3, s[1])):
            if sign < 0:
                least = least_ring(z[satellite], self.data.addendum)
                if not least or z[ring] < least:
                    needed = f"нужно z_{numbers[ring]} ≥ {least}" if least else "без смещения нет ни одного венца"
                    out.append(f"интерференция в паре {numbers[satellite]}–{numbers[ring]}: {needed}")
        return tuple(out)

    def results(self) -> dict[str, Any]:
        """The ``reducer`` section of ``solve --json``: lengths in millimetres, speeds in 1/min, positive as the input's.

        ``conditions``: difference of the sides of coaxiality, quotient of assembly, margin of neighbourhood in modules.
        """
        c, n = self.coaxiality, self.neighbourhood
        return {
            "ratio_asked": self.asked, "ratio": self.chosen.ratio, "deviation": self.chosen.deviation,
            "ratio_planetary": self.planetary_ratio, "ratio_simple": self.simple_ratio,
            "teeth": {f"z{w.number}": w.teeth for w in self.wheels}, "q": self.data.satellites,
            "efficiency": self.chosen.efficiency, "efficiency_planetary": self.stage_efficiency**self.data.stages,
            "diameters_w": {f"d{w.number}": w.diameter * 1e3 for w in self.wheels},
            "speeds_rpm": {f"n{link}": rpm(speed) for link, speed in self.links.items()},
            "conditions": {"coaxiality": c[0] - c[1], "assembly": self.assembly, "neighbourhood": n[0] - n[1]},
            "runners_up": [
                {"teeth": self.teeth_of(t), "ratio": t.ratio, "deviation": t.deviation, "efficiency": t.efficiency}
                for t in self.runners_up
            ],
        }


def rpm(speed: float) -> float:
    """Revolutions per minute of rad/s."""
    return speed * 30 / pi


def reducer(data: ReducerTable) -> Reducer:
    """Reducer of a project; raises :class:`CannotBuild` naming the nearest tooth set when none is within the tolerance."""
    return Reducer(data, search(data))
