"""A planetary reducer with its simple stage (manual 003, sections 2.1-2.4): wheels, speeds, conditions, plans."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets.construction.given import GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Reported, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears import reducer_speeds
from tmm_sheets.methods.gears.planetary import SCHEMES, Driver
from tmm_sheets.methods.gears.reducer_formulas import carrier_of, conditions_plan, internal_pairs, kinematics_plan, ratio_plan
from tmm_sheets.methods.gears.reducer_stages import ReducerWheel, Stage
from tmm_sheets.methods.gears.tooth_search import (
    TIERS,
    ToothSet,
    named_teeth,
    search,
    simple_numbers,
    stage_numbers,
)
from tmm_sheets.numbers import number
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.task.schema import ReducerTable


def tiers_of(data: ReducerTable) -> tuple[float, ...]:
    """Steps of the deviation of the ratio, the first that has any sets decides: none beyond what is permitted."""
    return *(t for t in TIERS if t < data.tolerance), data.tolerance


def criterion_of(data: ReducerTable, sets: Sequence[ToothSet]) -> str:
    """By what the tooth numbers were chosen, and the sets that came next."""
    tiers = ", ".join(number(100 * t) for t in tiers_of(data))
    told = "; ".join(", ".join(f"{name} = {z}" for name, z in named_teeth(data, t).items()) for t in sets)
    return tr("among the sets that fulfil coaxiality, assembly and neighbourhood, the least height of the reducer in the first of "
              "the steps {tiers} % of the deviation of the ratio that has any sets; the best sets in order: {sets}"
              ).format(tiers=tiers, sets=told)


class Interference(NamedTuple):
    """An internal pair that interferes without shifts: numbers of its wheels, teeth of the planet, and the least tooth number of
    the ring that would not, 0 when none will do.
    """

    planet: str
    ring: str
    teeth: int
    least: int


class Reducer:
    """A planetary reducer with its simple stage: the chosen tooth numbers, the runners-up, and what follows from them.

    Plans: ``reducer-ratio`` and ``reducer-set-2`` .. of the runners-up, ``reducer-kinematics``, ``reducer-conditions``,
    ``reducer-velocities``, ``reducer-speeds``.
    """

    def __init__(self, data: ReducerTable, sets: Sequence[ToothSet]) -> None:
        self.data = data
        self.scheme = SCHEMES[data.scheme]
        self.driver: Driver = data.driver or self.scheme.drivers[0]
        self.chosen, *rest = sets
        self.runners_up = tuple(rest)

    @property
    def tiers(self) -> tuple[float, ...]:
        """Steps of the deviation of the ratio by which the tooth numbers were chosen, as shares."""
        return tiers_of(self.data)

    @property
    def plans(self) -> dict[str, Plan]:
        """Plans by name in the order of construction; that of the speeds as far as it was drawn."""
        found = (*self.sets, self.kinematics, self.conditions, self.velocities, *self._speed_plans.values())
        return {plan.name: plan for plan in found}

    @cached_property
    def sets(self) -> tuple[Plan, ...]:
        """Tooth numbers, ratio and efficiency of the chosen set and of the runners-up."""
        criterion = criterion_of(self.data, (self.chosen, *self.runners_up))
        chosen = ratio_plan(self.data, self.chosen, 0, criterion)
        return chosen, *(ratio_plan(self.data, t, k, criterion, chosen) for k, t in enumerate(self.runners_up, 1))

    @cached_property
    def kinematics(self) -> Plan:
        """Diameters and speeds by the formulas."""
        return kinematics_plan(self.data, self.sets[0])

    @cached_property
    def conditions(self) -> Plan:
        """Coaxiality, assembly, neighbourhood."""
        return conditions_plan(self.data, self.sets[0])

    def told(self, name: str) -> float:
        """A number of the chosen set: its ratios ``u`` .., efficiencies ``eta`` .."""
        return float(self.sets[0][name].value)

    @cached_property
    def stages(self) -> tuple[Stage, ...]:
        """Planetary stages in the order of the power."""
        return tuple(self._stage(k) for k in range(self.data.stages))

    def _stage(self, k: int) -> Stage:
        numbers = stage_numbers(self.data, k)
        wheels = [self._wheel(n, z) for n, z in zip(numbers, self.chosen.stage, strict=True)]
        if self.scheme.single:
            wheels[2] = wheels[1]
        name = carrier_of(self.data, k)
        return Stage(self.scheme.signs, self.driver, (wheels[0], wheels[1], wheels[2], wheels[3]), name, self.kinematics["a_H"],
                     self.kinematics[f"n{name}"])

    def _wheel(self, number: str, teeth: int) -> ReducerWheel:
        return ReducerWheel(number, teeth, self.kinematics[f"d{number}"], self.kinematics[f"n{number}"])

    @cached_property
    def simple(self) -> tuple[ReducerWheel, ...]:
        """Pinion and wheel of the simple stage; none without one."""
        teeth = self.chosen.pinion, self.chosen.wheel
        return tuple(self._wheel(n, z) for n, z in zip(simple_numbers(self.data), teeth, strict=False))

    @property
    def simple_pair(self) -> tuple[tuple[Step, Step], GivenNumber, GivenNumber, GivenNumber]:
        """Tooth numbers, module, addendum and clearance of the simple stage.

        Raises
        ------
        CannotBuild
            when there is none.
        """
        d, names = self.data, simple_numbers(self.data)
        if d.simple_module is None:
            raise CannotBuild(tell('gear.teeth: the reducer has no simple stage, "reducer" means its wheels'),
                              tell("give tooth numbers and a module in [gear]"))
        return ((self.sets[0][f"z{names[0]}"], self.sets[0][f"z{names[1]}"]),
                GivenNumber(d.simple_module, "reducer.simple_module", "m", "m"),
                GivenNumber(d.addendum, "reducer.addendum", "h_a^{*}"), GivenNumber(d.clearance, "reducer.clearance", "c^{*}"))

    @cached_property
    def wheels(self) -> tuple[ReducerWheel, ...]:
        """All wheels by their numbers."""
        found = {w.number: w for w in (*self.simple, *(w for stage in self.stages for w in stage.wheels))}
        return tuple(found[str(n)] for n in range(1, len(found) + 1))

    @property
    def teeth_names(self) -> tuple[str, ...]:
        """Names of the tooth numbers, "z1" ..; equal stages are named once."""
        return tuple(named_teeth(self.data, self.chosen))

    @cached_property
    def velocities(self) -> Plan:
        """Picture of velocities."""
        apart = self.kinematics["a_simple"] if self.simple else None
        return reducer_speeds.picture(self.simple, self.stages, apart, self.data.simple == "before")

    def speeds(self, distance: float) -> Plan:
        """Plan of the speeds of rotation with its pole ``distance`` m over the line on which they are read."""
        if distance not in self._speed_plans:
            self._speed_plans[distance] = reducer_speeds.speeds(self.velocities, distance)
        return self._speed_plans[distance]

    @cached_property
    def _speed_plans(self) -> dict[float, Plan]:
        return {}

    @property
    def links(self) -> dict[str, Step]:
        """Speed of every turning link, 1/min: wheels by number, carriers by name."""
        return {w.number: w.n for w in self.wheels} | {stage.carrier: stage.n_H for stage in self.stages}

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Remarks for the sheet."""
        out = []
        if self.small_ratio:
            out.append(tr("the ratio of the simple stage is less than {least}").format(least=number(self.scheme.least_simple)))
        for of in self.interferences:
            said = (tr("interference in the pair {planet}–{ring}: z_{ring} ≥ {least} is needed") if of.least
                    else tr("interference in the pair {planet}–{ring}: without shift no ring will do"))
            out.append(said.format(planet=of.planet, ring=of.ring, least=of.least))
        return tuple(out)

    @property
    def small_ratio(self) -> bool:
        """Whether the ratio of the simple stage is less than is recommended for it."""
        return bool(self.simple) and self.told("u_simple") < self.scheme.least_simple

    @cached_property
    def interferences(self) -> tuple[Interference, ...]:
        """The internal pairs of the first stage that interfere without shifts."""
        z, numbers = self.chosen.stage, stage_numbers(self.data, 0)
        found = []
        for satellite, ring, sign in internal_pairs(self.scheme.signs):
            if sign < 0:
                least = int(self.conditions[f"least_z{numbers[ring]}"].value)
                if not least or z[ring] < least:
                    found.append(Interference(numbers[satellite], numbers[ring], z[satellite], least))
        return tuple(found)

    def results(self) -> dict[str, Any]:
        """The ``reducer`` section of ``solve --json``: lengths in millimetres, speeds in 1/min, positive as the input's.

        ``ratio_planetary`` has a sign, minus where the planetary part reverses; the ratios of the simple stage and of the whole,
        asked for and found, have none.
        ``conditions``: difference of the sides of coaxiality, quotient of assembly, margin of neighbourhood in modules.
        """
        chosen, conditions = self.sets[0], self.conditions
        first = {n: of for k in range(self.data.stages)
                 for n, of in zip(stage_numbers(self.data, k), stage_numbers(self.data, 0), strict=True)}
        return {
            "ratio_asked": Reported(chosen["u_asked"]), "ratio": Reported(chosen["u"]),
            "deviation": Reported(chosen["u_deviation"]),
            "ratio_planetary": Reported(chosen["u_planetary"]),
            **({"ratio_simple": Reported(chosen["u_simple"])} if self.simple else {}),
            "teeth": {f"z{w.number}": Reported(chosen[f"z{first.get(w.number, w.number)}"]) for w in self.wheels},
            "q": Reported(conditions["q"]),
            "efficiency": Reported(chosen["eta"]), "efficiency_planetary": Reported(chosen["eta_planetary"]),
            "diameters_w": {f"d{w.number}": Reported(w.d) for w in self.wheels},
            "speeds_rpm": {f"n{link}": Reported(n) for link, n in self.links.items()},
            "conditions": {name: Reported(conditions[name]) for name in ("coaxiality", "assembly", "neighbourhood")},
            "runners_up": [
                {"teeth": {name: Reported(plan[name]) for name in self.teeth_names}, "ratio": Reported(plan["u"]),
                 "deviation": Reported(plan["u_deviation"]), "efficiency": Reported(plan["eta"])}
                for plan in self.sets[1:]
            ],
        }


def reducer(data: ReducerTable) -> Reducer:
    """Reducer of a project; raises :class:`CannotBuild` naming the nearest tooth set when none is within the tolerance."""
    return Reducer(data, search(data))
