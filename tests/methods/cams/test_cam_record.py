"""The record of a cam: every number follows from steps, every step from its arguments by an expression or a primitive."""

from math import pi

import numpy as np
import pytest

from tests.methods.cams.cam_cases import cam_data, flat_data, rocker_data
from tmm_sheets.construction import expression
from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.step import Given, Reported, Step, value_of
from tmm_sheets.methods.cams.cam_profile import cam

TABLE = [[0, 0], [0.25, 1], [0.5, 0.2], [0.5, -0.3], [0.75, -1], [1, 0]]
SPRUNG = {"speed": 300, "follower_mass": 0.5}
CASES = {
    "tappet": cam_data(),
    "tappet, spring": cam_data(law="constant", fall_law="cosine", roller=None, eccentricity=-2, **SPRUNG),
    "tappet, least": cam_data(pressure_angle=60, roller=None, centre="least", upper_dwell=0),
    "tappet, diagram": cam_data(law="table", table=TABLE, roller=None, limit="both", sense="counter-clockwise"),
    "tappet, two discs": cam_data(limit="both", closure="geometric", roller=None, law="trapezoid"),
    "full turn": cam_data(rise=200, upper_dwell=60, fall=100, roller=None, curvature_share=0.5),
    "rocker": rocker_data(speed=100, follower_inertia=0.05),
    "rocker, two discs": rocker_data(limit="both", closure="geometric", roller=None, rotation="opposite",
                                     law="linearly decreasing"),
    "flat": flat_data(),
    "flat, rounded": flat_data(base_radius=None, law="sine", upper_dwell=0, **SPRUNG),
}


@pytest.fixture(params=CASES, scope="module")
def made(request):
    return cam(CASES[request.param])


def every_step(c):
    """All steps of all plans and what they follow from, arguments first."""
    seen = {}
    for plan in c.plans.values():
        for step in plan:
            seen |= {id(s): s for s in step.ancestors()}
    return seen.values()


def leaves(tree):
    for value in tree.values():
        yield from leaves(value) if isinstance(value, dict) else [value]


def test_every_number_of_the_results_is_a_step(made):
    for results in (made.results(), made.results(np.array([0.0, 0.3, 2.5, 7.0, -1.0]))):
        assert all(isinstance(leaf, Step | Reported | bool) for leaf in leaves(results))


def test_plans_have_names_of_their_own_and_hold_every_step_of_the_results(made):
    assert all(name == plan.name for name, plan in made.plans.items())
    known = {id(step) for plan in made.plans.values() for step in plan}
    for leaf in leaves(made.results()):
        if not isinstance(leaf, bool):
            assert {s.name for s in leaf.ancestors() if id(s) not in known} == set()


def test_arguments_are_steps_rows_or_numbers(made):
    for step in every_step(made):
        for a in step.args:
            assert isinstance(a, Step | Given | int | float | complex), (step.name, a)
        assert step.args or step.rule.compute() == 0.0


def test_every_rule_is_an_expression_that_gives_the_value(made):
    for step in every_step(made):
        tree = step.rule.tree(len(step.args))
        assert tree is not None, step.rule.name
        again = expression.evaluate(tree, [value_of(a) for a in step.args])
        if isinstance(step.value, Curve):
            for part in ("x", "y", "left", "right"):
                np.testing.assert_array_equal(getattr(again, part), getattr(step.value, part))
        else:
            np.testing.assert_allclose(again, step.value, rtol=1e-15, atol=0, err_msg=f"{step.name}: {step.rule.name}")


def test_rules_have_names_of_their_own(made):
    rules = {}
    for step in every_step(made):
        assert rules.setdefault(step.rule.name, step.rule) is step.rule, step.rule.name


def test_searches_tell_their_criterion(made):
    found = [a for step in every_step(made) for a in step.args if isinstance(a, Given) and a.over == "none"]
    assert found
    assert all(a.choice for a in found)


def test_given_numbers_know_their_place_in_the_project_file():
    c = cam(CASES["tappet, spring"])
    named = {a.name for step in every_step(c) for a in step.args if hasattr(a, "name") and isinstance(a, float)}
    assert {"cam.rise", "cam.upper_dwell", "cam.fall", "cam.stroke", "cam.eccentricity", "cam.pressure_angle", "cam.speed",
            "cam.follower_mass", "cam.spring_factor", "cam.preload", "cam.sense"} <= named


def test_both_ordinates_of_a_jump_are_recorded():
    """Constant acceleration: at 4 the ordinate falls from +a to -a, at 0 and 8 from and to the axis (manual 000, 7 ex. 3)."""
    c = cam(flat_data())
    steps = c.motion.plan.steps
    a_1, a_2 = (float(c.motion.plan[name].value) for name in ("a_1", "a_2"))
    assert a_1 == pytest.approx(55e-3 * 4 / (140 * pi / 180) ** 2 / c.motion.scales.dds.mu, rel=1e-12)
    heights = {"0(φ−0)": 0.0, "4(φ−0)": a_1, "4": -a_1, "8(φ+0)": 0.0, "8'(φ−0)": 0.0, "12(φ−0)": -a_2, "12": a_2, "16(φ+0)": 0.0}
    for name, height in heights.items():
        assert steps[f"S''_{name}"].value.imag == pytest.approx(height, abs=1e-12)
    assert not [name for name in cam(cam_data()).motion.plan.steps if "φ" in name]  # a sine does not jump
