"""A rule's arithmetic is read off its function: the same numbers come out of the tree, through JSON too."""

import json
import pickle

import numpy as np
import pytest

from tests.construction.gradients import gradient
from tmm_sheets.construction import arithmetic as ar, expression, rules
from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.equation import lettered
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.expression import Argument
from tmm_sheets.construction.formula import Letters, Operand, of_tree
from tmm_sheets.construction.step import Given, GivenNumber, GivenPoint, Plan, Reported, Rule, Step
from tmm_sheets.methods.flywheel.flywheel import ACCELERATION
from tmm_sheets.methods.flywheel.works import PLOT
from tmm_sheets.methods.linkage.motion import ANGULAR_VELOCITY, RIGID, SIMILAR

KNOWN = expression.primitives(ar)
RNG = np.random.default_rng(7)


def points(n):
    return RNG.normal(size=n) + 1j * RNG.normal(size=n)


@pytest.mark.parametrize("rule", [rules.ARC_ARC, rules.LINE_LINE, rules.FOOT, rules.ARM, rules.RAY, rules.TURNED_BY, RIGID, SIMILAR,
                                  ANGULAR_VELOCITY, ACCELERATION["ε1"][2], PLOT], ids=lambda r: r.name)
def test_tree_gives_the_numbers_of_the_function(rule):
    values = [points(5) if kind in ("point", "force", "direction") else RNG.uniform(1, 2, 5) for kind in rule.takes]
    if rule is rules.TURNED_BY:
        values[1] = 0.3
    tree = rule.tree(len(values))
    again = expression.from_json(json.loads(json.dumps(expression.as_json(tree))), KNOWN)
    with np.errstate(invalid="ignore"):
        assert np.array_equal(expression.evaluate(again, values), rule.compute(*values), equal_nan=True)


def test_a_function_that_branches_is_no_formula():
    assert expression.trace(lambda x: x if x > 0 else -x, 1) is None
    assert expression.trace(lambda f, x: f(x), 2) is None


def test_a_primitive_is_one_operation():
    tree = rules.ARC_ARC.tree(5)
    assert isinstance(tree, expression.Operation)
    assert tree.name == "arc cuts arc"
    assert [p.index for p in tree.parts] == [0, 1, 2, 3, 4]


def test_given_numbers_are_numbers_and_know_their_place():
    length = GivenNumber(0.08, "crank.length", "l_{AB}", "m")
    assert length == 0.08
    assert (np.array([1.0, 2.0]) * length).tolist() == [0.08, 0.16]
    assert pickle.loads(pickle.dumps(length)).name == "crank.length"
    assert GivenPoint(1 + 2j, "frame.points.D").name == "frame.points.D"
    step = Step("x", Rule("sum", lambda a, b: a + b, ("number", "number"), "number", ""), (Given(np.ones(3), "cycle.phi"), length))
    assert step.value.tolist() == [1.08, 1.08, 1.08]
    assert Reported(Step("z", rules.GIVEN, (3 + 4j,)), "abs").value == 5.0


SMOOTH = Rule("smooth curve", lambda *y: Curve(np.arange(len(y), dtype=float), np.array([np.imag(p) for p in y]),
                                               np.zeros(len(y) - 1), np.zeros(len(y) - 1)), (), "curve", "")
READ = Rule("ordinate of a curve", lambda x, curve: x + 1j * float(curve(x)), ("ordinate", "curve"), "point", "")


def test_an_error_goes_on_through_a_curve():
    """Half way between two points a flat cubic has half of each one's error; the point drawn there has its own besides."""
    plan = Plan("curve", "", "mm")
    ends = [plan.add(f"p{k}", rules.LAY_OFF, complex(k), 1.0, np.pi / 2) for k in range(3)]
    middle = plan.add("middle", READ, 0.5, plan.add("curve", SMOOTH, *ends))
    errors = Errors([(plan, 1.0)])
    assert gradient(errors, middle, ends[0])[0, 1, 1] == pytest.approx(0.5, rel=1e-6)
    assert gradient(errors, middle, ends[1])[0, 1, 1] == pytest.approx(0.5, rel=1e-6)
    assert not gradient(errors, middle, ends[2]).any()
    moved = errors.displaced(ends[1], 0, 2j)
    assert moved(middle) == pytest.approx(0.5 + 2j)


X, Y = Argument(0), Argument(1)


@pytest.mark.parametrize(("tree", "line"), [
    (2 * np.pi * X, "2π·x"), (X / 2 * Y, "x/2·y"), (2 * (X - Y), "2(x − y)"), (X - (Y - 1), "x − (y − 1)"),
    (-(X + Y), "−(x + y)"), (X**2 * (3 - 2 * X), "x^{2}·(3 − 2x)"), (np.sin(2 * X) ** 2, "sin^{2}(2x)"),
    (np.sin(X) ** 2, "sin^{2} x"), ((X + Y) ** 12, "(x + y)^{12}"), (X / (Y / 3), "x/(y/3)"), (0.5 * X, "0,5·x"),
    (X * -1.5, "x·(−1,5)"), (np.sqrt(X * Y), "√(x·y)"), (np.pi**2 / 2 * np.cos(np.pi * X), "π^{2}/2·cos(π·x)"),
])  # fmt: skip
def test_a_formula_in_one_line(tree, line):
    assert lettered(of_tree(tree, [Operand(Letters("x")), Operand(Letters("y"))])) == line
