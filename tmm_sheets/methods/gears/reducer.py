"""A planetary reducer with its simple stage (manual 003, sections 2.1-2.4): wheels, speeds, conditions, plans."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets.construction.given import GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Reported, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears.planetary import SCHEMES, Driver
from tmm_sheets.methods.gears.reducer_formulas import conditions_plan, internal_pairs, ratio_plan
from tmm_sheets.methods.gears.tooth_search import (
    TIERS,
    ToothSet,
    named_teeth,
    search,
    simple_numbers,
    stage_numbers,
)
from tmm_sheets.methods.gears.train import Train
from tmm_sheets.methods.gears.train_steps import FRAME, Mesh, TrainData
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


class Reducer(Train):
    """A planetary reducer with its simple stage: a train of the tooth numbers that were chosen, and the runners-up.

    Plans: ``reducer-ratio`` and ``reducer-set-2`` .. of the runners-up, ``reducer-conditions``, and those of a train.
    """

    def __init__(self, table: ReducerTable, sets: Sequence[ToothSet]) -> None:
        self.table = table
        self.scheme = SCHEMES[table.scheme]
        self.driver: Driver = table.driver or self.scheme.drivers[0]
        self.chosen, *rest = sets
        self.runners_up = tuple(rest)
        self.stage_wheels = [stage_numbers(table, k) for k in range(table.stages)]
        self.simple = simple_numbers(table)
        super().__init__(self._train())

    def _train(self) -> TrainData:
        """The stages one behind the other: the link that leaves one turns with that which enters the next."""
        table, signs = self.table, self.scheme.signs
        links: list[tuple[str, str]] = []
        meshes, shafts, held, known = list[Mesh](), list[tuple[str, ...]](), list[str](), dict[str, Step]()
        first = self.stage_wheels[0]
        for k, wheels in enumerate(self.stage_wheels):
            one, two, three, four = wheels
            carrier = f"H{k + 1}" if table.stages > 1 else "H"
            pair = Mesh(one, two, carrier, signs[0]), Mesh(four, three, carrier, signs[1])
            # the driving wheel comes first
            meshes += pair[::-1] if self.driver == "ring" else pair
            shafts += [(two, three)] if two != three else []
            entry, fixed, leaves = {
                "sun": (one, four, carrier), "ring": (four, one, carrier), "carrier": (carrier, four, one)}[self.driver]
            links.append((entry, leaves))
            held.append(fixed)
            known |= {f"z{n}": self.sets[0][f"z{of}"] for n, of in zip(wheels, first, strict=True)}
            known[f"i{one},{four}"] = self.sets[0]["i14"]
        if table.simple_module is not None:
            pinion, wheel = self.simple
            known |= {name: self.sets[0][name] for name in (f"z{pinion}", f"z{wheel}")}
            module = GivenNumber(table.simple_module, "reducer.simple_module", "m", "m")
            before = table.simple == "before"
            links.insert(0 if before else len(links), (pinion, wheel))
            meshes.insert(0 if before else len(meshes), Mesh(*((wheel, pinion) if before else (pinion, wheel)), FRAME, 1, module))
        shafts += [(one[1], two[0]) for one, two in pairwise(links)]
        self.entry, self.exit = links[0][0], links[-1][1]
        speeds = {self.entry: GivenNumber(table.input_speed, "reducer.input_speed", "ω", "rad/s")} | dict.fromkeys(held)
        teeth = {name.removeprefix("z"): int(step.value) for name, step in known.items() if name.startswith("z")}
        return TrainData("reducer", tuple(meshes), teeth, table.module, speeds, tuple(shafts), table.satellites,
                         table.addendum, table.clearance, known)

    @property
    def tiers(self) -> tuple[float, ...]:
        """Steps of the deviation of the ratio by which the tooth numbers were chosen, as shares."""
        return tiers_of(self.table)

    @property
    def plans(self) -> dict[str, Plan]:
        """Plans by name in the order of construction; that of the speeds as far as it was drawn."""
        return {plan.name: plan for plan in (*self.sets, self.conditions)} | super().plans

    @cached_property
    def sets(self) -> tuple[Plan, ...]:
        """Tooth numbers, ratio and efficiency of the chosen set and of the runners-up."""
        criterion = criterion_of(self.table, (self.chosen, *self.runners_up))
        chosen = ratio_plan(self.table, self.chosen, 0, criterion)
        return chosen, *(ratio_plan(self.table, t, k, criterion, chosen) for k, t in enumerate(self.runners_up, 1))

    @cached_property
    def conditions(self) -> Plan:
        """Coaxiality, assembly, neighbourhood."""
        return conditions_plan(self.table, self.sets[0])

    def told(self, name: str) -> float:
        """A number of the chosen set: its ratios ``u`` .., efficiencies ``eta`` .."""
        return float(self.sets[0][name].value)

    @property
    def simple_pair(self) -> tuple[tuple[Step, Step], GivenNumber, GivenNumber, GivenNumber]:
        """Tooth numbers, module, addendum and clearance of the simple stage.

        Raises
        ------
        CannotBuild
            when there is none.
        """
        d, names = self.table, self.simple
        if d.simple_module is None:
            raise CannotBuild(tell('gear.teeth: the reducer has no simple stage, "reducer" means its wheels'),
                              tell("give tooth numbers and a module in [gear]"))
        return ((self.sets[0][f"z{names[0]}"], self.sets[0][f"z{names[1]}"]),
                GivenNumber(d.simple_module, "reducer.simple_module", "m", "m"),
                GivenNumber(d.addendum, "reducer.addendum", "h_a^{*}"), GivenNumber(d.clearance, "reducer.clearance", "c^{*}"))

    @property
    def teeth_names(self) -> tuple[str, ...]:
        """Names of the tooth numbers, "z1" ..; equal stages are named once."""
        return tuple(named_teeth(self.table, self.chosen))

    @property
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
        z, numbers = self.chosen.stage, self.stage_wheels[0]
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
        return {
            "ratio_asked": Reported(chosen["u_asked"]), "ratio": Reported(chosen["u"]),
            "deviation": Reported(chosen["u_deviation"]),
            "ratio_planetary": Reported(chosen["u_planetary"]),
            **({"ratio_simple": Reported(chosen["u_simple"])} if "u_simple" in chosen else {}),
            "teeth": {f"z{n}": Reported(self.data.known[f"z{n}"]) for n in self.wheels},
            "q": Reported(conditions["q"]),
            "efficiency": Reported(chosen["eta"]), "efficiency_planetary": Reported(chosen["eta_planetary"]),
            "diameters_w": {f"d{n}": Reported(self.kinematics[f"d{n}"]) for n in self.wheels},
            "speeds_rpm": {f"n{n}": Reported(self.kinematics[f"n{n}"]) for n in self.names},
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
