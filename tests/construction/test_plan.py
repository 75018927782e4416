"""Plans: names, order, vectors, and the laziness of a whole study."""

import numpy as np
import pytest

from tmm_sheets import catalogue
from tmm_sheets.construction import rules
from tmm_sheets.construction.step import Plan, symbol
from tmm_sheets.project import Project


def test_steps_keep_their_order_and_their_names():
    plan = Plan("p", "План", "m")
    b = plan.add("b", rules.GIVEN, 1j)
    a = plan.add("a", rules.SHIFT, b, 2 + 0j)
    assert list(plan) == [b, a]
    assert plan["a"] is a
    assert "b" in plan
    assert "c" not in plan
    assert not a.evaluated
    with pytest.raises(ValueError, match="has a step 'a' already"):
        plan.add("a", rules.GIVEN, 0j)


def test_free_names():
    plan = Plan("p", "План", "m")
    assert plan.free("A") == "A"
    plan.add("A", rules.GIVEN, 0j)
    plan.add(plan.free("A"), rules.GIVEN, 0j)
    assert plan.free("A") == "A′′"
    plan.reserved = frozenset({"B"})
    assert plan.free("B") == "B′"
    # The one it is kept for takes it.
    assert plan.add("B", rules.GIVEN, 0j).name == "B"


def test_check_names_the_first_step_that_fails():
    labels = ("0", "1", "2")
    plan = Plan("p", "План", "m", labels)
    d = plan.add("D", rules.GIVEN, np.array([1.0, 5.0, 1.0]) + 0j)
    assert plan.check() is None
    c = plan.add("C", rules.ARC_ARC, 0j, 1.0, d, 1.0, 1)
    plan.add("E", rules.SHIFT, c, 1 + 0j)
    assert plan.check() == ("C", ("1",))
    single = Plan("q", "План", "m", labels)
    single.add("F", rules.ARC_ARC, 0j, 1.0, 5 + 0j, 1.0, 1)
    assert single.check() == ("F", labels)


def test_vectors():
    plan = Plan("p", "План", "m/s")
    tail, head = plan.add("p", rules.GIVEN, 0j), plan.add("b", rules.GIVEN, 3 + 4j)
    plan.vector("V̅_B", tail, head)
    (segment,) = plan.segments
    assert (segment.symbol, segment.tail, segment.head) == ("V̅_B", tail, head)
    assert symbol("F54") == "F̅_{54}"
    assert symbol("F") == "F̅"


# --- laziness --------------------------------------------------------------------------------------------------------


@pytest.fixture
def study():
    project = Project(catalogue.read("lugansk/shaper"))
    # Another set of angles: what the cycle itself has looked at does not count.
    return project.study_at(project.cycle.turned + 0.01, project.cycle.labels, "")


def evaluated(plan):
    return {step.name for step in plan if step.evaluated}


def test_a_recorded_study_has_computed_nothing(study):
    pos, vel, acc = study.positions, study.velocities, study.accelerations
    for plan in (pos.plan, vel.plan, acc.plan):
        assert len(plan.steps) > 5
        assert evaluated(plan) == set()


def test_a_position_costs_no_velocity(study):
    vel, acc = study.velocities, study.accelerations
    study.positions.points["D"].value
    assert {"A", "B", "C", "CB", "D"} >= evaluated(study.positions.plan) >= {"B", "D"}
    assert evaluated(vel.plan) == evaluated(acc.plan) == set()
    assert "forces" not in study.__dict__
    assert "lever" not in study.__dict__


def test_the_rocker_costs_no_ram(study):
    study.accelerations.epsilon["3"].value
    assert "S5" not in evaluated(study.positions.plan)
    assert not {"d", "s3", "d5"} & (evaluated(study.velocities.plan) | evaluated(study.accelerations.plan))


def test_the_lever_costs_no_reaction(study):
    study.lever.balancing.value
    assert "forces" not in study.__dict__


def test_nothing_is_computed_twice(study):
    study.forces.balancing.value
    study.lever.balancing.value
    plans = [study.positions.plan, study.velocities.plan, study.accelerations.plan, study.forces.plan, study.lever.plan]
    plans += [p.plan for p in study.forces.plans.values()]
    assert {len(step.seconds) for plan in plans for step in plan} <= {0, 1}
    assert sum(len(step.seconds) for plan in plans for step in plan) > 40
