"""Every vector of the vector equations that a plan solves is a vector of that plan, under a name of its own.

Truth: what a crossing of two lines starts from is reached from the pole by vectors, and the lines themselves are vectors; a special
point of a group of class III is the exception, where two unknown vectors of one direction are drawn as one line.
"""


import numpy as np
import pytest
from hypothesis import given

from tests.methods.linkage.mechanisms import mechanisms
from tests.methods.settings import every_kind, tried
from tests.project_files import known
from tmm_sheets.construction.rules import LINE_LINE
from tmm_sheets.methods.linkage.motion import CORIOLIS, acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.sheets.linkage.kinematics import hinges


@pytest.fixture(scope="module", params=["lugansk/shaper", "sixbar/3:5", "loom", "sieve.toml", "planer.toml", "conveyor.toml",
                                        "feeder.toml"])
def study(request):
    return known(request.param).study


def reached(plan):
    """Names of the points that vectors lead to from the pole."""
    found, last = {plan.pole}, None
    while found != last:
        last = found
        found = found | {s.head.name for s in plan.segments if s.tail.name in found}
    return found


def missing(motion):
    """Starts and lines of the crossings of a plan that are no vectors of it."""
    plan, there = motion.plan, reached(motion.plan)
    ends = {(s.tail.name, s.head.name) for s in plan.segments}
    for step in plan:
        if step.rule is LINE_LINE:
            yield from (f"to {x.name}" for x in (step.args[0], step.args[2]) if x.name not in there)
            if (plan.pole, step.name) not in ends:
                yield f"{plan.pole}–{step.name}"
            if step not in motion.special.values():
                starts = {step.args[0].name, step.args[2].name} - {plan.pole}
                yield from (f"{start}–{step.name}" for start in starts if (start, step.name) not in ends)


def doubled(names):
    return {name for name in names if names.count(name) > 1}


def test_vectors_of_projects(study):
    for motion in (study.velocities, study.accelerations):
        assert not list(missing(motion))
        assert not doubled([s.symbol for s in motion.plan.segments])
        assert not doubled([s.symbol or s.name for s in motion.plan])


@every_kind
def test_vectors_of_any_group(kinds):
    """Also of a rocker on a moving pivot and of guides on any link."""
    @tried(kinds)
    @given(mechanisms(kinds))
    def check(drawn):
        m, phi = drawn
        vel = velocity_plan(position_plan(m, np.atleast_1d(phi)))
        acc = acceleration_plan(vel)
        for motion in (vel, acc):
            assert not list(missing(motion))
            assert not doubled([s.symbol or s.name for s in motion.plan])

    check()


def test_a_slider_on_a_moving_guide_is_told_against_its_point(study):
    """a_B = a_B3 + a_BB3^k + a_BB3^r, and V_B = V_B3 + V_BB3: the index of all three names both points."""
    plan = study.accelerations.plan
    for s in plan.segments:
        if s.head.rule is CORIOLIS:
            index = s.symbol.partition("^")[0].removeprefix("a̅")
            assert f"a̅{index}^r" in {x.symbol for x in plan.segments} or study.accelerations.special
            assert f"V̅{index}" in {x.symbol for x in study.velocities.plan.segments} or study.velocities.special


@pytest.mark.parametrize(("name", "sliders"), [("planer.toml", {"E", "K"}), ("lugansk/shaper", set()), ("sixbar/3:5", set())])
def test_sliders_on_moving_guides_have_position_numbers(name, sliders):
    """Those of fixed guides have marks along the guide instead."""
    m = known(name).mechanism
    fixed = {p for g in m.groups for p, guide in g.kind.guided(g) if m.guides[guide].link == m.frame}
    inner = {g.inner for g in m.groups if g.inner}
    assert set(hinges(m, fixed)) & (inner | fixed) == sliders
