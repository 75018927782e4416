"""Formulas of a planetary reducer with its simple stage as steps of plans (manual 003, sections 2.1-2.4).

Wheels 1 to 4 of the formulas are those of one planetary stage (a single row: 1, 2, 2, 4), see
:mod:`~tmm_sheets.methods.gears.planetary`. Diameters in millimetres, speeds in 1/min, positive as the input's; the names of the
steps are those of ``solve --json``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import gcd, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given, GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Kind, Rule
from tmm_sheets.methods.gears import planetary
from tmm_sheets.methods.gears.tooth_search import ToothSet, named_teeth, simple_numbers, stage_numbers
from tmm_sheets.methods.gears.train_steps import INNER_RATIO, TEETH, said_with_sign
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.task.schema import ReducerTable

NUMBER: tuple[Kind] = ("number",)
SOURCE = "003, 2.1–2.4"


def _formula(name: str, compute: Any, count: int, wording: str, unit: str = "") -> Rule:
    return Rule(name, compute, NUMBER * count, "number", wording, unit=unit, source=SOURCE)


@primitive("greatest common divisor", "real")
def common_divisor(a: float, b: float) -> int:
    """Greatest common divisor (НОД) of two whole numbers."""
    return gcd(int(a), int(b))


ASKED = _formula("ratio asked for", lambda u: u, 1, marked("Ratio asked for {name} = {value}."))
ASKED_BY_SPEEDS = _formula("ratio of the speeds asked for", lambda one, two: one / two, 2,
                           marked("Ratio asked for ω_in/ω_out: {name} = {0}/{1} = {value}."))
SIMPLE_RATIO = _formula("ratio of the simple stage", lambda wheel, pinion: wheel / pinion, 2,
                        marked("Ratio of the simple stage: {name} = {0}/{1} = {value}."))
STAGE_RATIO = {
    "sun": _formula("ratio of a stage driven by the sun", lambda i: planetary.stage_ratio(i, "sun"), 1,
                    marked("Ratio from the sun to the carrier, 1 − i: {name} = 1 − {0} = {value}.")),
    "ring": _formula("ratio of a stage driven by the ring", lambda i: planetary.stage_ratio(i, "ring"), 1,
                     marked("Ratio from the ring to the carrier, 1 − 1/i: {name} = 1 − 1/{0} = {value}.")),
    "carrier": _formula("ratio of a stage driven by the carrier", lambda i: planetary.stage_ratio(i, "carrier"), 1,
                        marked("Ratio from the carrier to the central wheel, 1/(1 − i): {name} = 1/(1 − {0}) = {value}.")),
}
PLANETARY_RATIO = _formula("ratio of the planetary stages", lambda u, stages: u**stages, 2,
                           marked("Ratio of the planetary part with its sign (stages: {1}): {name} = {value}."))
RATIO = _formula("ratio of the reducer", lambda planetary, simple: np.abs(planetary) * simple, 2,
                 marked("Ratio of the reducer without its sign: {name} = |{0}| × {1} = {value}."))
SAME_RATIO = _formula("ratio without a simple stage", np.abs, 1,
                      marked("There is no simple stage; ratio of the reducer without its sign: {name} = |{0}| = {value}."))
DEVIATION = _formula("deviation of the ratio", lambda u, asked: u / asked - 1, 2,
                     marked("Relative deviation from the ratio asked for: {name} = {0}/{1} − 1 = {value}."))
PAIR_EFFICIENCY = _formula("efficiency of a pair", lambda eta: eta, 1, marked("Efficiency of one pair of wheels {name} = {value}."))
INNER_EFFICIENCY = _formula("efficiency with the carrier stopped", lambda eta: eta**2, 1,
                            marked("Efficiency of both pairs of the train with the carrier held: {name} = {0}² = {value}."))
STAGE_EFFICIENCY: dict[Callable[[Any, Any], Any], Rule] = {
    planetary.efficiency_from_sun: _formula(
        "efficiency of a stage driven by the sun", planetary.efficiency_from_sun, 2,
        marked("Efficiency of a stage (1 + η_0|i|)/(1 + |i|), i = {0}, η_0 = {1}: {name} = {value}.")),
    planetary.efficiency_from_ring: _formula(
        "efficiency of a stage driven by the ring", planetary.efficiency_from_ring, 2,
        marked("Efficiency of a stage (1 + η_0/|i|)/(1 + 1/|i|), i = {0}, η_0 = {1}: {name} = {value}.")),
    planetary.efficiency_from_carrier_below: _formula(
        "efficiency of a stage driven by the carrier, i < 1", planetary.efficiency_from_carrier_below, 2,
        marked("Efficiency of a stage (1 − i)/(1 − iη_0) for i < 1, i = {0}, η_0 = {1}: {name} = {value}.")),
    planetary.efficiency_from_carrier_above: _formula(
        "efficiency of a stage driven by the carrier, i > 1", planetary.efficiency_from_carrier_above, 2,
        marked("Efficiency of a stage η_0(i − 1)/(i − η_0) for i > 1, i = {0}, η_0 = {1}: {name} = {value}.")),
}
PLANETARY_EFFICIENCY = _formula("efficiency of the planetary stages", lambda eta, stages: eta**stages, 2,
                                marked("Efficiency of the planetary part (stages: {1}): {name} = {value}."))
EFFICIENCY = _formula("efficiency of the reducer", lambda planetary, pair: planetary * pair, 2,
                      marked("Efficiency of the reducer: {name} = {0} × {1} = {value}."))
SAME_EFFICIENCY = _formula("efficiency without a simple stage", lambda eta: eta, 1,
                           marked("There is no simple stage; efficiency of the reducer: {name} = {0} = {value}."))
SATELLITES = _formula("number of satellites", lambda q: q, 1, marked("Number of planets {name} = {value}."))
ADDENDUM = _formula("addendum coefficient", lambda h: h, 1, marked("Addendum coefficient {name} = {value}."))
SIDE_OF_COAXIALITY = _formula("side of the coaxiality condition", lambda s, z1, z2: z1 + s * z2, 3,
                              marked("One side of the condition of coaxiality, in teeth: {name} = {1} ± {2} = {value}."))
COAXIALITY = _formula("coaxiality", lambda left, right: left - right, 2,
                      marked("Coaxiality is fulfilled if the sides are equal: {0} − {1} = {value}."))
ASSEMBLY = _formula(
    "assembly", lambda s, q, z1, z2, z3, z4: (z1 * z3 - s * z2 * z4) / (q * common_divisor(z2, z3)), 6,
    marked("Condition of assembly: the quotient (z_1z_3 ∓ z_2z_4)/(q·gcd(z_2, z_3)) must be a whole number: ({2} × {4} ∓ {3} × "
           "{5})/({1} × gcd({3}; {4})) = {value}."))
BETWEEN_AXES = _formula("distance between satellites", lambda axis, q: axis * np.sin(pi / q), 2,
                        marked("Condition of neighbourhood; distance between the axes of neighbouring planets, in modules: {0} × "
                               "sin(180°/{1}) = {value}."))
WIDTH = _formula("width of the satellites", lambda z2, z3, h: np.maximum(z2, z3) + 2 * h, 3,
                 marked("Tip diameter of the greater planet max(z_2; z_3) + 2h_a*, in modules: max({0}; {1}) + 2 × {2} = {value}."))
NEIGHBOURHOOD = _formula("neighbourhood", lambda between, width: between - width, 2,
                         marked("The condition of neighbourhood is fulfilled if there is a positive margin; it is {0} − {1} = "
                                "{value} of a module."))
LEAST_RING = _formula("least ring without interference", planetary.least_ring, 2,
                      marked("Least number of teeth of a ring without interference with the planet z = {0} (0: there is none): "
                             "{name} = {value}."))


class SpeedNames:
    """Names of the teeth's steps: wheels 1 to 4 of a stage, and pinion and wheel of the simple one."""

    def __init__(self, data: ReducerTable) -> None:
        self.stage = tuple(f"z{n}" for n in stage_numbers(data, 0))
        self.simple = tuple(f"z{n}" for n in simple_numbers(data))


def ratio_plan(data: ReducerTable, teeth: ToothSet, k: int, criterion: str, chosen: Plan | None = None) -> Plan:
    """Tooth numbers of set ``k`` with their ratio, its deviation, and the efficiency.

    Set 0 is the ``chosen`` one, from which the others take what is the same.
    """
    scheme = planetary.SCHEMES[data.scheme]
    title = tr("Set of tooth numbers {number}").format(number=k + 1) if k else tr("Tooth numbers and ratio of the reducer")
    plan = Plan(f"reducer-set-{k + 1}" if k else "reducer-ratio", title, "")
    if chosen is not None:
        asked = chosen["u_asked"]
    elif data.ratio is not None:
        asked = plan.add("u_asked", ASKED, GivenNumber(data.ratio, "reducer.ratio"), symbol="u")
    else:
        speeds = [GivenNumber(v, f"reducer.{name}", unit="rad/s") for name in ("input_speed", "output_speed")
                  if (v := getattr(data, name)) is not None]
        asked = plan.add("u_asked", ASKED_BY_SPEEDS, speeds[0], speeds[-1], symbol="u")
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
    names = SpeedNames(data)
    stages = Given(data.stages, "reducer.stages", over="none")
    sign = scheme.signs[0] * scheme.signs[1]
    if names.simple:
        pinion, wheel = (plan[name] for name in names.simple)
        plan.add("u_simple", SIMPLE_RATIO, wheel, pinion, symbol=tr("u_{s}"))
    inner = plan.add("i14", INNER_RATIO, sign, *(plan[z] for z in names.stage), symbol="i_{14}^{H}",
                     say=said_with_sign(INNER_RATIO, sign))
    driver = data.driver or scheme.drivers[0]
    stage = plan.add("u_stage", STAGE_RATIO[driver], inner, symbol=tr("u_{st}"))
    whole = plan.add("u_planetary", PLANETARY_RATIO, stage, stages, symbol=tr("u_{pl}"))
    ratio = plan.add("u", *((RATIO, whole, plan["u_simple"]) if names.simple else (SAME_RATIO, whole)))
    plan.add("u_deviation", DEVIATION, ratio, asked, symbol="Δu")
    if chosen is None:
        pair = plan.add("eta_pair", PAIR_EFFICIENCY, GivenNumber(data.pair_efficiency, "reducer.pair_efficiency"),
                        symbol=tr("η_{p}"))
        both = plan.add("eta_0", INNER_EFFICIENCY, pair, symbol="η_0")
    else:
        pair, both = chosen["eta_pair"], chosen["eta_0"]
    formula = planetary.efficiency_formula(planetary.inner_ratio(scheme.signs, teeth.stage), driver)
    one = plan.add("eta_stage", STAGE_EFFICIENCY[formula], inner, both, symbol=tr("η_{st}"))
    part = plan.add("eta_planetary", PLANETARY_EFFICIENCY, one, stages, symbol=tr("η_{pl}"))
    plan.add("eta", *((EFFICIENCY, part, pair) if names.simple else (SAME_EFFICIENCY, part)), symbol="η")
    return plan


def conditions_plan(data: ReducerTable, ratio: Plan) -> Plan:
    """Coaxiality, assembly, neighbourhood, and the least rings of internal pairs."""
    plan = Plan("reducer-conditions", tr("Conditions of coaxiality, assembly and neighbourhood"), "")
    scheme = planetary.SCHEMES[data.scheme]
    s, z = scheme.signs, [ratio[name] for name in SpeedNames(data).stage]
    q = plan.add("q", SATELLITES, Given(data.satellites, "reducer.satellites", "q", over="none"))
    h = plan.add("ha", ADDENDUM, GivenNumber(data.addendum, "reducer.addendum"), symbol="h_a^{*}")
    left, right = (plan.add(f"coaxiality_{side}", SIDE_OF_COAXIALITY, s[i], z[a], z[b],
                            say=said_with_sign(SIDE_OF_COAXIALITY, s[i]), symbol=f"z_{a + 1} {'+' if s[i] > 0 else '−'} z_{b + 1}")
                   for i, (side, a, b) in enumerate((("left", 0, 1), ("right", 3, 2))))
    plan.add("coaxiality", COAXIALITY, left, right)
    plan.add("assembly", ASSEMBLY, s[0] * s[1], q, *z, say=said_with_sign(ASSEMBLY, s[0] * s[1]))
    between = plan.add("between", BETWEEN_AXES, left, q)
    width = plan.add("width", WIDTH, z[1], z[2], h)
    plan.add("neighbourhood", NEIGHBOURHOOD, between, width)
    for satellite, ring, sign in internal_pairs(s):
        if sign < 0:
            name = SpeedNames(data).stage[ring]
            plan.add(f"least_{name}", LEAST_RING, z[satellite], h, symbol=f"{name[0]}_{{{name[1:]}min}}")
    return plan


def internal_pairs(signs: Sequence[int]) -> tuple[tuple[int, int, int], ...]:
    """Satellite, its central wheel (numbers from 0) and the sign of both pairs of a stage."""
    return (1, 0, signs[0]), (2, 3, signs[1])
