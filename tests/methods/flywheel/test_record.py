"""The record of the flywheel: every number is a step, every rule can be told, and what is displaced before it moves it."""

from __future__ import annotations

import numpy as np
import pytest

from tests.construction.gradients import gradient
from tests.methods.linkage import shaper_truth
from tmm_sheets import catalogue
from tmm_sheets.construction import expression
from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.step import Given, Reported, Rule, Step, value_of
from tmm_sheets.project import Project
from tmm_sheets.task import variant

CRANK = {"lugansk/shaper": 'centre = "A"  ', "press": 'title = "кривошип"'}


def changed(name, *pairs):
    text = catalogue.read(name).text
    for old, new in pairs:
        assert text.count(old) == 1
        text = text.replace(old, new)
    return Project(variant.parse(text, name))


def heavy(name):
    """The project with a crank that makes a flywheel needless."""
    return changed(name, (CRANK[name], 'inertia = "600 kg m2"\n' + ('centre = "O"\n' if name == "press" else "") + CRANK[name]))


CASES = {
    "shaper": lambda: Project(catalogue.read("lugansk/shaper")),
    "engine, four strokes, a disc": lambda: Project(catalogue.read("lugansk/engine")),
    "press, Mertsalov, a motor": lambda: Project(catalogue.read("press")),
    "press, a rotor": lambda: changed("press", ("efficiency = 0.85", 'rotor_inertia = "0.1 kg m2"\nefficiency = 0.85')),
    "shaper, none needed": lambda: heavy("lugansk/shaper"),
    "press, none needed": lambda: heavy("press"),
    "engine, a rim that would run too fast": lambda: changed("lugansk/engine", ('form = "disc"', 'form = "rim"')),
}


@pytest.fixture(scope="module", params=CASES)
def project(request):
    return CASES[request.param]()


@pytest.fixture(scope="module")
def shaper():
    return CASES["shaper"]()


def same(a, b):
    if isinstance(a, Curve):
        return all(np.array_equal(getattr(a, of), getattr(b, of)) for of in ("x", "y", "left", "right"))
    return np.array_equal(a, b, equal_nan=True)


def test_every_rule_can_be_told_and_gives_the_value(project):
    count = 0
    for plan in project.flywheel.plans.values():
        for step in plan:
            tree = step.rule.tree(len(step.args))
            assert tree is not None, (plan.name, step)
            with np.errstate(all="ignore"):
                assert same(expression.evaluate(tree, [value_of(a) for a in step.args]), step.value), (plan.name, step)
            count += 1
    assert count > 300


def test_arguments_are_steps_and_given_numbers(project):
    """No rule takes a function or a bare row; a bare number is a constant of the construction (a side, a number of a position)."""
    for plan in project.flywheel.plans.values():
        for step in plan:
            for a in step.args:
                assert not callable(a)
                assert isinstance(a, Step | Given) or np.ndim(a) == 0 or plan.name.startswith("positions"), (plan.name, step)


def test_arguments_come_first_and_names_are_unique(project):
    plans, study = project.flywheel.plans, project.study
    earlier = (*project.cycle.plans.values(), *project.applied.plans.values(), study.positions.plan, study.velocities.plan)
    before = {id(s) for plan in earlier for s in (*plan.auxiliaries.values(), *plan)}

    def known(a, plan):
        """Whether it stands before, or is an aside, which is made of such only."""
        return not isinstance(a, Step) or id(a) in before or (
            any(of.auxiliaries.get(a.name) is a for name, of in plans.items()
            if of is plan or name.startswith("abscissae@")) and all(known(b, plan) for b in a.args))

    # Reductions stand before the diagrams, whatever of these their angles were chosen by.
    for plan in plans.values():
        assert {step.plan for step in plan} <= {plan.name}
        for step in plan:
            # What the linkage's plans know beside themselves is theirs.
            for a in () if plan.name.startswith(("positions@", "velocities@", "accelerations@")) else step.args:
                assert known(a, plan), (plan.name, step, a)
            before.add(id(step))


def test_every_number_of_the_results_is_a_step(project):
    fw = project.flywheel
    known = {id(step) for plan in fw.plans.values() for step in plan}
    leaves = []

    def walk(value, path):
        if isinstance(value, dict):
            for key, x in value.items():
                walk(x, f"{path}.{key}")
        elif isinstance(value, list):
            for x in value:
                walk(x, path)
        elif isinstance(value, Step | Reported):
            leaves.append(path)
            assert id(value.step if isinstance(value, Reported) else value) in known, path
        else:
            assert isinstance(value, str | bool | None), (path, value)

    walk(fw.results(), "flywheel")
    assert len(leaves) >= (19 if fw.needed else 15)


def test_a_plan_says_for_each_of_its_positions(project):
    for plan in project.flywheel.plans.values():
        for step in plan:
            if not isinstance(step.value, Curve):
                assert np.shape(step.value) in ((), (len(plan.labels),)), (plan.name, step)


# --- truths --------------------------------------------------------------------------------------------------------------------


def test_the_moments_are_virtual_power_on_the_plans_of_the_study(shaper):
    """F5 along the ram: M = -F5 dS5/dphi; J = sum of the closed forms; both from the very points of the study's velocity plan."""
    r, fw = shaper.reduced, shaper.flywheel
    beta = np.pi / 2 - shaper.cycle.phi
    rate = shaper_truth.ram_rate(beta)
    np.testing.assert_allclose(fw.M_reduced[:-1], np.where(rate > 1e-9, -2800 * rate, 0.0), rtol=1e-11, atol=1e-9)
    np.testing.assert_allclose(fw.J_reduced[:-1], shaper_truth.inertia(beta), rtol=1e-12)
    assert fw.M_reduced[-1] == fw.M_reduced[0]
    points = {id(s) for s in shaper.study.velocities.plan}
    assert any(id(s) in points for s in fw.moment_plan["M"].ancestors())
    assert any(id(s) in points for s in fw.inertia_plan["points"].ancestors())
    assert r.numbered.velocities is shaper.study.velocities


@pytest.mark.parametrize("k", [3, 8])
def test_a_displaced_point_of_the_velocity_plan_moves_the_ordinates(shaper, k):
    """d5 off by a tenth: y_J and y_M as computed anew from the velocity then, at that position only."""
    fw, vel = shaper.flywheel, shaper.study.velocities
    d5 = vel.points["S5"]
    v = complex(d5.value[k])
    value = Errors([(vel.plan, 0.02), (fw.moment_plan, 1.0), (fw.inertia_plan, 1.0)]).displaced(d5, k, 0.1 * v)
    omega, s = shaper_truth.OMEGA, fw.scales
    y_j = fw.inertia_plan["J"].value.copy()
    y_j[k] += shaper_truth.M5 * abs(v) ** 2 * (1.1**2 - 1) / omega**2 / s.inertia.mu
    np.testing.assert_allclose(value(fw.inertia_plan["J"]), y_j, rtol=1e-12)
    force = shaper.applied[0].vector(shaper.cycle.turned, 1)[k]
    y_m = fw.moment_plan["M"].value.imag.copy()
    y_m[k] += 0.1 * (force * np.conj(v)).real / omega / s.moment.mu
    np.testing.assert_allclose(value(fw.moment_plan["M"]).imag, y_m, rtol=1e-12, atol=1e-12)


def test_the_closing_position_is_the_first(shaper):
    fw, d5 = shaper.flywheel, shaper.study.velocities.points["S5"]
    moved = Errors([]).displaced(d5, 0, 0.5 + 0j)(fw.inertia_plan["J"]) - fw.inertia_plan["J"].value
    assert moved[0] == moved[-1] > 1
    assert not moved[1:-1].any()


def test_the_end_of_a_chord_moves_the_segment(shaper):
    """The whole chain after an end lies lower or higher by 1 mm: dE by ratio (1 - x/x_end) behind it, (-x/x_end) before it."""
    fw = shaper.flywheel
    assert fw.ab_mm > 0
    plan, ratio = fw.contacts_plan, fw.scales.work.mu / fw.scales.energy.mu
    upper, lower = (float(plan[f"x_{name}"].value) for name in ("max", "min"))
    length = fw.work_ends[-1].value.real
    for end, border in zip(fw.work_ends, fw.scales.angle.mm(fw.edges), strict=True):
        if any(abs(border - x) < 30 for x in (upper, lower)):
            continue  # the curve itself changes there
        found = Errors([]).displaced(end, 0, 1j)(fw.ab) - fw.ab_mm
        shares = [(border < x) - x / length for x in (upper, lower)]
        assert found == pytest.approx(ratio * (shares[0] - shares[1]), rel=1e-9)
    assert Errors([]).displaced(fw.driving_plan["K"], 0, 1j)(fw.ab) - fw.ab_mm == pytest.approx(ratio * (upper - lower) / length)


def test_the_contact_need_not_be_searched_again(shaper):
    """A tangent that shifts along the curve stays where it was to first order: the ram 1e-4 heavier, and everything drawn anew."""
    fw = shaper.flywheel
    before, linear = fw.ab_mm, 0.0
    for name in ("max", "min"):
        at = fw.reduced.kept[f"contact-{name}"]
        heavier = 1e-4 * 80 * abs(complex(at.velocities.points["S5"].value[0])) ** 2 / shaper_truth.OMEGA**2
        ordinate = fw.contacts_plan[f"J_{name}"]
        linear += float(Errors([]).displaced(ordinate, 0, heavier / fw.scales.inertia.mu)(fw.ab)) - before
    anew = changed("lugansk/shaper", ('mass = "80 kg"', 'mass = "80.008 kg"')).flywheel
    moved = anew.ab_mm * anew.scales.energy.mu / fw.scales.energy.mu - before
    assert abs(moved) > 1e-4
    assert moved == pytest.approx(linear, rel=1e-3)


def test_errors_reach_the_sizes(shaper):
    """Tolerances by the record: y_J at 8 is what the pencil does in the velocity plan; D has a fifth of J's share."""
    fw, study = shaper.flywheel, shaper.study
    plans = [(p, 1.0) for p in fw.plans.values() if p.unit == "mm" and "@" not in p.name]
    exact = Errors(plans)
    assert exact.error(fw.inertia_plan["J"])[8] == 0.25
    drawn = Errors([*plans, (study.positions.plan, 0.0025), (study.velocities.plan, 0.02)])
    # By hand: dJ = sum 2 m V dV/omega^2 + 2 J omega3 domega3/omega^2, each V read off a ruler, the ordinate laid off.
    vel, omega = study.velocities, shaper_truth.OMEGA
    moved, read = [], []
    for mass, name in ((2.8, "B"), (5.66, "S3"), (3.0, "D"), (80.0, "S5")):
        v = complex(np.broadcast_to(vel.points[name].value, (10,))[8])
        moved.append((vel.points[name], 8, 2 * mass * v / omega**2))
        read.append(2 * mass * abs(v) * 0.02 * 0.5 / omega**2)
    moved.append((vel.omega["3"], 8, complex(2 * 0.1511 * vel.omega["3"].value[8] / omega**2)))
    by_hand = np.hypot(drawn.of_sum(moved)[0], np.linalg.norm(read)) / fw.scales.inertia.mu
    assert by_hand == pytest.approx(6.9, abs=0.05)
    assert drawn.error(fw.inertia_plan["J"])[8] == pytest.approx(np.hypot(by_hand, 0.25), rel=1e-4)
    step = fw.first_plan["J_м"]
    share = drawn.error(step)[0] / fw.J_flywheel
    assert drawn.error(fw.wheel.plan["D"])[0] / fw.wheel.diameter == pytest.approx(share / 5, rel=0.01)
    assert drawn.error(fw.wheel.plan["m"])[0] / fw.wheel.mass == pytest.approx(3 * share / 5, rel=0.01)
    assert drawn.error(fw.ab)[0] / fw.ab_mm == pytest.approx(share, rel=1e-6)


def test_values_of_single_positions_have_errors_of_their_own():
    """Two ordinates taken from one row are drawn apart: their sum has the root of the squares, twice one of them twice."""
    from tmm_sheets.construction import rules
    from tmm_sheets.construction.step import Plan

    plan = Plan("row", "", "mm", ("0", "1", "2"))
    centre = plan.add("O", rules.GIVEN, 0j)
    row = plan.add("P", rules.LAY_OFF, centre, 10.0, Given(np.zeros(3), "angles"))
    reach = plan.add("x", Rule("abscissa", lambda p: p.real, ("point",), "number", ""), row)
    one = Plan("one", "", "mm")
    pick = rules.taken("pick", "mm", "")
    a, b = one.add("a", pick, reach, 0), one.add("b", pick, reach, 2)
    add = Rule("sum", lambda x, y: x + y, ("number", "number"), "number", "")
    errors = Errors([(plan, 1.0), (one, 1.0)], reading=0.0)
    origin, single = 0.25, errors.error(a)[0]  # all three lie on one circle about the same point
    apart = (single**2 - origin**2) ** 0.5
    assert errors.error(one.add("a+b", add, a, b))[0] == pytest.approx((4 * origin**2 + 2 * apart**2) ** 0.5)
    assert errors.error(one.add("a+a", add, a, a))[0] == pytest.approx(2 * single)
    assert gradient(errors, one["a+b"], row, 2)[0, 0, 0] == pytest.approx(1.0)
    assert not gradient(errors, one["a+b"], row, 1).any()
