"""The record of gears and reducers: every number is the value of a step, every step a formula of steps and given numbers."""

import json

import numpy as np
import pytest

from tests.methods.gears import reducer_cases as cases
from tests.methods.gears.test_gears import data
from tmm_sheets.construction import arithmetic, expression
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.construction.step import Given, GivenNumber, Plan, Reported, Step, value_of
from tmm_sheets.methods.gears import (
    gear_engagement,
    gear_formulas,
    gear_pair as pairs,
    planetary,
    rack,
    reducer as reducers,
    train_steps,
)
from tmm_sheets.methods.gears.gear_pair import gear_pair, settled
from tmm_sheets.methods.gears.reducer import reducer
from tmm_sheets.task.schema import GearTable

KNOWN = expression.primitives(arithmetic, gear_engagement, gear_formulas, pairs, planetary, rack, reducers,
                               train_steps)
CASES = ["fillet", "no shift", "rack", "undercut", "rule", "reduced", *cases.MACHINES, "two internal", "ring"]


def built(name):
    """A pair or a reducer with all its plans."""
    if name in cases.MACHINES:
        made = reducer(cases.column(name, 0))
    elif name == "two internal":
        made = reducer(cases.column("press", 0, scheme=name))
    elif name == "ring":
        made = reducer(cases.column("compressor", 0, driver="ring"))
    else:
        d = {
            "fillet": data(driver=2), "no shift": data((30, 30), (0.0, 0.0)), "rack": data((12, 30), (0.3, 0.0), profile="rack"),
            "undercut": data((9, 9), (0.2, 0.4), 0.01, profile="rack"), "rule": data((12, 20), "rule", profile="rack"),
            "reduced": settled(GearTable(teeth="reducer", pressure_angle="20 deg", shift="rule", profile="rack"),
                               reducer(cases.column("crusher", 0))),
        }[name]
        made = gear_pair(d)
        for w in made.wheels:
            made.involute(w), made.smooth_involute(w)
        _ = made.generating, made._teeth, made.smooth_sliding
    made.results()
    if name not in ("fillet", "no shift", "rack", "undercut", "rule", "reduced"):
        made.speeds(0.05)
    return made


def plans(made):
    """All of it: none among the attributes that ``plans`` does not name."""
    found = [x for value in vars(made).values() for x in (value.values() if isinstance(value, dict) else [value])]
    assert {id(p) for p in found if isinstance(p, Plan)} <= {id(p) for p in made.plans.values()}
    return list(made.plans.values())


@pytest.mark.parametrize("name", CASES)
def test_every_rule_is_a_formula(name):
    for plan in plans(built(name)):
        for step in plan:
            tree = step.rule.tree(len(step.args))
            assert tree is not None, (plan.name, step.name)
            again = expression.from_json(json.loads(json.dumps(expression.as_json(tree))), KNOWN)
            with np.errstate(invalid="ignore", divide="ignore"):
                found = expression.evaluate(again, [value_of(a) for a in step.args])
            assert np.array_equal(found, step.value, equal_nan=True), (plan.name, step.name)


@pytest.mark.parametrize("name", CASES)
def test_arguments_are_steps_or_given(name):
    """What stands in a step by itself is a side, a whole division or the origin; all else is a step or knows its origin."""
    made = plans(built(name))
    assert len({p.name for p in made}) == len(made)
    steps = {id(s) for p in made for s in p}
    for plan in made:
        for step in plan:
            for a in step.args:
                if isinstance(a, Step):
                    assert id(a) in steps or name == "reduced", (plan.name, step.name)
                elif isinstance(a, Given | GivenNumber):
                    assert a.name.startswith(("gear.", "reducer.")), (plan.name, step.name)
                else:
                    assert np.ndim(a) == 0, (plan.name, step.name)
                    assert a == round(a.real) + 1j * round(a.imag), (plan.name, step.name)


def leaves(tree, path=""):
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from leaves(value, f"{path}.{key}" if path else key)
    elif isinstance(tree, list):
        for i, value in enumerate(tree):
            yield from leaves(value, f"{path}[{i}]")
    else:
        yield path, tree


@pytest.mark.parametrize("name", CASES)
def test_every_result_is_a_step(name):
    found = dict(leaves(built(name).results()))
    assert len(found) > 25
    for path, leaf in found.items():
        assert isinstance(leaf, Reported), path
        assert np.all(np.isreal(leaf.value)), path


def test_teeth_of_the_gear_are_those_the_search_chose():
    """From the contact ratio back to the choice: candidates and criterion stand with every number of teeth that was found."""
    ratio = built("reduced").results()["eps_alpha"].step
    origins = {a.name: a for s in ratio.ancestors() for a in s.args if isinstance(a, Given | GivenNumber)}
    assert {"reducer.teeth.z5", "reducer.z6", "reducer.simple_module", "gear.pressure_angle"} <= set(origins)
    assert not origins["reducer.teeth.z5"].choice
    assert "наименьшая высота" in origins["reducer.z6"].choice
    assert "z1 = 15, z2 = 30" in origins["reducer.z6"].choice


def test_runners_up_are_choices():
    r = reducer(cases.column("crusher", 0))
    row = r.results()["runners_up"][0]["teeth"]["z1"].step
    assert row.args[0].name == "reducer.runners_up[0].z1"
    assert isinstance(row.value, int)


@pytest.mark.parametrize("name", CASES)
def test_plans_stand_in_the_order_of_construction(name):
    before = set()
    for plan in plans(built(name)):
        for step in plan:
            for a in step.args:
                assert not isinstance(a, Step) or id(a) in before or name == "reduced", (plan.name, step.name)
            before.add(id(step))


@pytest.mark.parametrize("name", CASES)
def test_protocol_says_every_plan(name):
    for plan in plans(built(name)):
        for k in {0, len(plan.labels) - 1}:
            said = list(sentences(plan, k, float))
            assert len(said) == len(plan.steps)
            for text in said:
                assert text.endswith("."), text
                assert not set("{}±∓") & set(text), text


def test_formulas_are_said_as_the_manual_writes_them():
    """Manual 002: z 10 and 20, m = 10, x = 0.5 and 0.5: the working pressure angle is 27.2 degrees, 27 degrees 12 minutes."""
    plan = gear_pair(data((10, 20), (0.5, 0.5), 0.01)).geometry
    said = dict(zip(plan.steps, sentences(plan, 0, float), strict=True))
    assert said["alpha_w"] == "По эвольвентному углу 0,03917 найдём угол зацепления α_w = 27°12′."
    assert said["r1"] == "Делительный радиус колеса 1: r_1 = m·z_1/2 = 10·10/2 = 50 мм."
    assert said["rf2"] == "Радиус впадин колеса 2: r_f2 = m·(z_2/2 − h_a* − c* + x_2) = 10·(20/2 − 1 − 0,25 + 0,5) = 92,5 мм."


def test_given_numbers_are_named_by_their_place():
    plan = gear_pair(data()).geometry
    assert {plan[k].args[0].name for k in ("z1", "z2", "m", "x1", "x2")} == {
        "gear.teeth[0]", "gear.teeth[1]", "gear.module", "gear.shift[0]", "gear.shift[1]"}
