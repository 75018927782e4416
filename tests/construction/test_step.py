"""Steps: computed when first read, once, and only what is needed."""

import numpy as np
import pytest

from tmm_sheets.construction import rules
from tmm_sheets.construction.step import Helper, Rule, Step, value_at, value_of


@pytest.fixture
def counted():
    """A rule that notes each of its computations."""
    calls = []

    def compute(*values):
        calls.append(values)
        return sum(values)

    return Rule("sum", compute, (), "number", "{name}"), calls


def test_value_is_computed_when_first_read_and_once(counted):
    rule, calls = counted
    step = Step("s", rule, (1, 2))
    assert not step.evaluated
    assert calls == []
    assert step.value == 3
    assert step.evaluated
    assert step.value == 3
    assert calls == [(1, 2)]
    assert len(step.seconds) == 1


def test_only_what_a_step_depends_on_is_evaluated(counted):
    rule, calls = counted
    a, b = Step("a", rule, (1,)), Step("b", rule, (2,))
    c, d = Step("c", rule, (a, 10)), Step("d", rule, (a, b))
    assert c.value == 11
    assert [s.evaluated for s in (a, b, c, d)] == [True, False, True, False]
    assert len(calls) == 2
    assert d.value == 3
    assert len(calls) == 4


def test_ancestors_come_before_results_each_once(counted):
    rule, _ = counted
    a = Step("a", rule, (1,))
    b, c = Step("b", rule, (a,)), Step("c", rule, (a, 5))
    d = Step("d", rule, (b, c, a))
    assert [s.name for s in d.ancestors()] == ["a", "b", "c", "d"]
    assert [s.name for s in a.ancestors()] == ["a"]


def test_chains_longer_than_the_call_stack():
    step = Step("0", rules.GIVEN, (0j,))
    for i in range(20_000):
        step = Step(str(i + 1), rules.SHIFT, (step, 1 + 0j))
    assert step.value == 20_000
    assert sum(1 for _ in step.ancestors()) == 20_001


def test_shared_arguments_do_not_multiply(counted):
    """Sixty doublings of one step: computed sixty times, not 2**60 times."""
    rule, calls = counted
    step = Step("0", rule, (1,))
    for i in range(60):
        step = Step(str(i + 1), rule, (step, step))
    assert step.value == 2**60
    assert len(calls) == 61
    assert len(list(step.ancestors())) == 61
    assert repr(step) == "Step('60', sum)"


def test_what_cannot_be_built_is_nan_without_a_warning():
    step = Step("C", rules.ARC_ARC, (0j, 1.0, np.array([1.0, 5.0, 0.0]) + 0j, 1.0, 1))
    assert np.isnan(step.value).tolist() == [False, True, True]


def test_value_at_a_position():
    array = Step("p", rules.GIVEN, (np.array([1j, 2j]),))
    fixed = Step("q", rules.GIVEN, (3j,))
    assert array.at(1) == 2j
    assert fixed.at(1) == 3j
    assert value_of(7) == 7
    assert value_at(np.array([1, 2]), 0) == 1
    assert value_at(5, 3) == 5


def test_steps_differ_even_when_they_are_the_same_move():
    assert Step("p", rules.GIVEN, (1j,)) != Step("p", rules.GIVEN, (1j,))
    with pytest.raises(AttributeError):
        Step("p", rules.GIVEN, (1j,)).name = "q"


# --- helper lines of the common rules --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("rule", "args"),
    [
        (rules.LAY_OFF, (1 + 1j, 2.0, 0.5)),
        (rules.ALONG, (1 + 1j, 1j, -2.0)),
        (rules.ARC_ARC, (0j, 2.0, 3 + 0j, 2.0, 1)),
        (rules.ARC_LINE, (0j, 2.0, 1j, 1 + 0j, 1)),
        (rules.LINE_LINE, (0j, 1 + 1j, 2 + 0j, 1j)),
        (rules.TANGENT, (3 + 0j, 0j, 1.0, 1)),
        (rules.FOOT, (1 + 2j, 0j, 1 + 0j)),
        (rules.SHIFT, (1j, 2 + 0j)),
        (rules.RAY, (0j, 1 + 1j)),
    ],
    ids=lambda x: x.name.replace(" ", "-") if isinstance(x, Rule) else "",
)
def test_helper_lines_lead_to_the_result(rule, args):
    """Arcs have the opening of their compass and cut at the result; lines end in it."""
    result = Step("r", rule, args).value
    helpers = rule.helpers(args, result)
    assert helpers
    for helper in helpers:
        assert isinstance(helper, Helper)
        if helper.kind == "arc":
            assert abs(helper.a - helper.b) == pytest.approx(helper.radius)
            assert helper.b == result
        elif helper.kind == "circle":
            assert abs(result - helper.a) == pytest.approx(helper.radius)
        elif rule is not rules.RAY:
            assert result in (helper.a, helper.b)
