"""A planetary reducer with its simple stage (manual 003, sections 2.1-2.4): a train of the tooth numbers that a search finds.

Wheels 1 to 4 of the formulas are those of one planetary stage (a single row: 1, 2, 2, 4), see
:mod:`~tmm_sheets.methods.gears.planetary`. The names of the steps are those of ``solve --json``.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, partial
from itertools import pairwise
from math import gcd, pi
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.step import Given, GivenNumber, Plan, Reported, Rule, Step, StepTable, planned, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears import planetary
from tmm_sheets.methods.gears.planetary import (
    SCHEMES,
    TIERS,
    Driver,
    ToothSet,
    named_teeth,
    search,
    simple_numbers,
    stage_numbers,
)
from tmm_sheets.methods.gears.train import Train
from tmm_sheets.methods.gears.train_steps import FRAME, INNER_RATIO, TEETH, Mesh, N, TrainData
from tmm_sheets.numbers import number
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.task.seldom_tables import ReducerTable


SOURCE = "003, 2.1–2.4"


def _formula(name: str, compute: Any, count: int, wording: str, unit: str = "") -> Rule:
    return Rule(name, compute, (N,) * count, N, wording, unit=unit, source=SOURCE)


@primitive("greatest common divisor", "real")
def common_divisor(a: float, b: float) -> int:
    """Greatest common divisor (НОД) of two whole numbers."""
    return gcd(int(a), int(b))


ASKED = _formula("ratio asked for", lambda u: u, 1, marked("Ratio asked for {name} = {value}."))
ASKED_BY_SPEEDS = _formula("ratio of the speeds asked for", lambda one, two: one / two, 2,
                           marked("Ratio asked for ω_in/ω_out: {name} = {0}/{1} = {value}."))
STAGE_RATIO = {driver: _formula(f"ratio of a stage driven by the {driver}", partial(planetary.stage_ratio, driver=driver), 1, "")
               for driver in ("sun", "ring", "carrier")}
STAGE_EFFICIENCY = {case: _formula(f"efficiency of a stage driven by the {case}", compute, 2, "")
                    for case, compute in planetary.EFFICIENCY.items()}
SIDE_OF_COAXIALITY = _formula("side of the coaxiality condition", lambda s, z1, z2: z1 + s * z2, 3,
                              marked("One side of the condition of coaxiality, in teeth: {formula}."))
ASSEMBLY = _formula(
    "assembly", lambda s, q, z1, z2, z3, z4: (z1 * z3 - s * z2 * z4) / (q * common_divisor(z2, z3)), 6,
    marked("Condition of assembly, the quotient must be a whole number: {formula}."))
LEAST_RING = _formula("least ring without interference", planetary.least_ring, 2,
                      marked("Least number of teeth of a ring without interference with the planet z = {0} (0: there is none): "
                             "{name} = {value}."))


RATIOS: StepTable = {
    "u_simple": ("wheel pinion", lambda: tr("u_{s}"),
        _formula("ratio of the simple stage", lambda wheel, pinion: wheel / pinion, 2, "")),
    "u_planetary": ("u_stage stages", lambda: tr("u_{pl}"),
        _formula("ratio of the planetary stages", lambda u, stages: u**stages, 2,
            marked("Ratio of the planetary part with its sign (stages: {1}): {name} = {value}."))),
    "u": ("u_planetary u_simple", "",
        _formula("ratio of the reducer", lambda planetary, simple: np.abs(planetary) * simple, 2, "")),
    "u_deviation": ("u u_asked", "Δu", _formula("deviation of the ratio", lambda u, asked: u / asked - 1, 2, "")),
    "eta_pair": ("pair_efficiency", lambda: tr("η_{p}"),
        _formula("efficiency of a pair", lambda eta: eta, 1, marked("Efficiency of one pair of wheels {name} = {value}."))),
    "eta_0": ("eta_pair", "η_0", _formula("efficiency with the carrier stopped", lambda eta: eta**2, 1, "")),
    "eta_planetary": ("eta_stage stages", lambda: tr("η_{pl}"),
        _formula("efficiency of the planetary stages", lambda eta, stages: eta**stages, 2,
            marked("Efficiency of the planetary part (stages: {1}): {name} = {value}."))),
    "eta": ("eta_planetary eta_pair", "η", _formula("efficiency of the reducer", lambda planetary, pair: planetary * pair, 2, "")),
}
"""Ratio and efficiency of a reducer with a simple stage."""
WITHOUT_SIMPLE: StepTable = {
    "u": ("u_planetary", "", _formula("ratio without a simple stage", np.abs, 1,
            marked("There is no simple stage; ratio of the reducer without its sign: {name} = |{0}| = {value}."))),
    "eta": ("eta_planetary", "η", _formula("efficiency without a simple stage", lambda eta: eta, 1,
            marked("There is no simple stage; efficiency of the reducer: {name} = {0} = {value}."))),
}
CONDITIONS: StepTable = {
    "q": ("satellites", "", _formula("number of satellites", lambda q: q, 1, marked("Number of planets {name} = {value}."))),
    "ha": ("addendum", "h_a^{*}",
        _formula("addendum coefficient", lambda h: h, 1, marked("Addendum coefficient {name} = {value}."))),
    "coaxiality": ("coaxiality_left coaxiality_right", "", _formula("coaxiality", lambda left, right: left - right, 2,
            marked("Coaxiality is fulfilled if the sides are equal: {0} − {1} = {value}."))),
    "between": ("coaxiality_left q", "", _formula("distance between satellites", lambda axis, q: axis * np.sin(pi / q), 2,
            marked("Condition of neighbourhood; distance between the axes of neighbouring planets, in modules: {0} × "
                   "sin(180°/{1}) = {value}."))),
    "width": ("z_2 z_3 ha", "", _formula("width of the satellites", lambda z2, z3, h: np.maximum(z2, z3) + 2 * h, 3,
            marked("Tip diameter of the greater planet max(z_2; z_3) + 2h_a*, in modules: max({0}; {1}) + 2 × {2} = {value}."))),
    "neighbourhood": ("between width", "", _formula("neighbourhood", lambda between, width: between - width, 2,
            marked("The condition of neighbourhood is fulfilled if there is a positive margin; it is {0} − {1} = "
                   "{value} of a module."))),
}
"""Conditions of assembly."""


def ratio_plan(data: ReducerTable, teeth: ToothSet, k: int, criterion: str, chosen: Plan | None = None) -> Plan:
    """Tooth numbers of set ``k`` with their ratio, its deviation, and the efficiency.

    Set 0 is the ``chosen`` one, from which the others take what is the same.
    """
    scheme = SCHEMES[data.scheme]
    title = tr("Set of tooth numbers {number}").format(number=k + 1) if k else tr("Tooth numbers and ratio of the reducer")
    plan = Plan(f"reducer-set-{k + 1}" if k else "reducer-ratio", title, "")
    if chosen is not None:
        asked = chosen["u_asked"]
    elif data.ratio is not None:
        asked = plan.add("u_asked", ASKED, GivenNumber(data.ratio, "reducer.ratio"), symbol=tr("u_{a}"))
    else:
        speeds = [GivenNumber(v, f"reducer.{name}", unit="rad/s") for name in ("input_speed", "output_speed")
                  if (v := getattr(data, name)) is not None]
        asked = plan.add("u_asked", ASKED_BY_SPEEDS, speeds[0], speeds[-1], symbol=tr("u_{a}"))
    searched = False
    for name, z in named_teeth(data, teeth).items():
        say = tr("Number of teeth {name} = {value} is given.")
        if name in data.teeth:
            found = Given(z, f"reducer.teeth.{name}", over="none")
        else:
            found = Given(z, f"reducer.runners_up[{k - 1}].{name}" if k else f"reducer.{name}", over="none", choice=criterion)
            say = (tr("Number of teeth {name} = {value} found by the same search.") if searched or k else
                   tr("Number of teeth {{name}} = {{value}} found by search: {criterion}.").format(criterion=criterion))
            searched = True
        plan.add(name, TEETH, found, symbol=f"z_{{{name[1:]}}}", say=say)
    simple = [plan[f"z{n}"] for n in simple_numbers(data)]
    sign = scheme.signs[0] * scheme.signs[1]
    driver = data.driver or scheme.drivers[0]
    case = planetary.efficiency_case(float(planetary.inner_ratio(scheme.signs, teeth.stage)), driver)
    by_driver: StepTable = {"u_stage": ("i14", lambda: tr("u_{st}"), STAGE_RATIO[driver]),
                            "eta_stage": ("i14 eta_0", lambda: tr("η_{st}"), STAGE_EFFICIENCY[case])}
    given = {"u_asked": asked, "stages": Given(data.stages, "reducer.stages", over="none"),
             "pair_efficiency": GivenNumber(data.pair_efficiency, "reducer.pair_efficiency"),
             **dict(zip(("pinion", "wheel"), simple, strict=False)), **({} if chosen is None else chosen.steps)}

    def add(names: str) -> None:
        record(plan, names, by_driver, {} if simple else WITHOUT_SIMPLE, RATIOS, given=given)

    if simple:
        add("u_simple")
    plan.add("i14", INNER_RATIO, sign, *(plan[f"z{n}"] for n in stage_numbers(data, 0)), symbol="i_{14}^{H}")
    add("u_stage u_planetary u u_deviation")
    if chosen is None:
        add("eta_pair eta_0")
    add("eta_stage eta_planetary eta")
    return plan


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
        """Steps of the deviation of the ratio, as shares; the first that has any sets decides: none beyond what is permitted."""
        return *(t for t in TIERS if t < self.table.tolerance), self.table.tolerance

    @property
    def plans(self) -> dict[str, Plan]:
        """Plans by name in the order of construction; that of the speeds as far as it was drawn."""
        return {plan.name: plan for plan in (*self.sets, self.conditions)} | super().plans

    @cached_property
    def sets(self) -> tuple[Plan, ...]:
        """Tooth numbers, ratio and efficiency of the chosen set and of the runners-up."""
        tiers = ", ".join(number(100 * t) for t in self.tiers)
        told = "; ".join(", ".join(f"{name} = {z}" for name, z in named_teeth(self.table, t).items())
                         for t in (self.chosen, *self.runners_up))
        criterion = tr("among the sets that fulfil coaxiality, assembly and neighbourhood, the least height of the reducer in the "
                       "first of the steps {tiers} % of the deviation of the ratio that has any sets; the best sets in order: "
                       "{sets}").format(tiers=tiers, sets=told)
        chosen = ratio_plan(self.table, self.chosen, 0, criterion)
        return chosen, *(ratio_plan(self.table, t, k, criterion, chosen) for k, t in enumerate(self.runners_up, 1))

    @planned("reducer-conditions", marked("Conditions of coaxiality, assembly and neighbourhood"))
    def conditions(self, plan: Plan) -> None:
        """Coaxiality, assembly, neighbourhood, and the least rings of internal pairs."""
        data, s, numbers = self.table, self.scheme.signs, self.stage_wheels[0]
        z = [self.sets[0][f"z{n}"] for n in numbers]
        given = {"satellites": Given(data.satellites, "reducer.satellites", "q", over="none"),
                 "addendum": GivenNumber(data.addendum, "reducer.addendum"), "z_2": z[1], "z_3": z[2]}
        record(plan, "q ha", CONDITIONS, given=given)
        for i, (side, a, b) in enumerate((("left", 0, 1), ("right", 3, 2))):
            plan.add(f"coaxiality_{side}", SIDE_OF_COAXIALITY, s[i], z[a], z[b],
                     symbol=f"z_{{{numbers[a]}}} {'+' if s[i] > 0 else '−'} z_{{{numbers[b]}}}")
        record(plan, "coaxiality", CONDITIONS)
        plan.add("assembly", ASSEMBLY, s[0] * s[1], plan["q"], *z, symbol="E")
        record(plan, "between width neighbourhood", CONDITIONS, given=given)
        for satellite, ring in planetary.internal_pairs(s):
            plan.add(f"least_z{numbers[ring]}", LEAST_RING, z[satellite], plan["ha"], symbol=f"z_{{{numbers[ring]}min}}")

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
        for satellite, ring in planetary.internal_pairs(self.scheme.signs):
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
