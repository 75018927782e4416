"""Error analysis against what is known otherwise: the angle of a crossing, sums of squares, drawing many times by chance."""

import numpy as np
import pytest

from tests.construction.gradients import gradient
from tests.methods.linkage.mechanisms import mechanism
from tmm_sheets import catalogue
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.step import Plan
from tmm_sheets.mechanism.groups import RRP
from tmm_sheets.mechanism.model import Crank, Guide, StructuralGroup
from tmm_sheets.methods.integration import integrate
from tmm_sheets.methods.linkage.motion import velocity_plan
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.project import Project

PENCIL, READING = 0.25, 0.5
MANY = 40_000
CHANCE = 0.02
"""Three times the relative scatter of a standard deviation over that many drawings, 1/sqrt(2 n), and a margin for curvature."""
ANGLES = [90.0, 60.0, 30.0, 10.0, 3.0]


def of_plan(errors, plan):
    """Error of each point and length of a plan, mm, by the names of the steps."""
    kinds = ("point", "vector", "length", "ordinate")
    return {step.name: errors.in_mm(step) for step in plan
            if step.rule.gives in kinds and np.asarray(step.value).dtype.kind in "fc"}


def turned(degrees):
    return complex(np.exp(1j * np.radians(degrees)))


def off(rng, *shape):
    """Errors of drawn points."""
    return rng.normal(0, PENCIL, (*shape, MANY)) + 1j * rng.normal(0, PENCIL, (*shape, MANY))


def spread(values):
    """Standard deviation in the direction in which it is greatest."""
    return float(np.sqrt(np.linalg.eigvalsh(np.cov(np.real(values), np.imag(values)))[-1]))


@pytest.mark.parametrize("degrees", ANGLES)
def test_crossing_of_lines(degrees):
    """1/sin of the angle, and its worst direction: lines off by d each cross d/sqrt(1 - cos) away."""
    plan = Plan("p", "", "mm")
    a, b = plan.add("A", rules.GIVEN, -40 + 0j), plan.add("B", rules.GIVEN, -50 * turned(degrees))
    c = plan.add("C", rules.LINE_LINE, a, 1 + 0j, b, turned(degrees))
    found = Errors([(plan, 1.0)], PENCIL)
    # The points that the lines go through are off as well: both errors together.
    assert found.in_mm(c) == pytest.approx(np.sqrt(2) * PENCIL / np.sqrt(1 - np.cos(np.radians(degrees))), rel=1e-9)


@pytest.mark.parametrize("degrees", ANGLES)
def test_crossing_of_arcs(degrees):
    """The angle between two arcs is that between their radii."""
    plan = Plan("p", "", "m")
    c1, c2 = plan.add("A", rules.GIVEN, 0.06 + 0j), plan.add("B", rules.GIVEN, 0.08 * turned(degrees))
    c = plan.add("C", rules.ARC_ARC, c1, 0.06, c2, 0.08, 1)
    assert abs(c.value) == pytest.approx(0, abs=1e-12)
    straight = np.sqrt(2) * PENCIL / np.sqrt(1 - np.cos(np.radians(degrees)))
    # At 3 degrees a quarter of a millimetre is no small displacement any more: these arcs bend away from each other.
    assert straight * 0.999 <= Errors([(plan, 0.001)], PENCIL).in_mm(c) <= straight * (1.001 if degrees > 5 else 1.1)


def test_errors_in_common_cancel():
    """Points laid off from one another are off together: only what is drawn between them counts."""
    plan = Plan("p", "", "m")
    a = plan.add("A", rules.GIVEN, 0j)
    b = plan.add("B", rules.LAY_OFF, a, 0.1, np.linspace(0, 6, 5))
    c = plan.add("C", rules.ALONG, b, 1 + 0j, 0.05)
    found = Errors([(plan, 0.002)], PENCIL)
    assert found.in_mm(a) == pytest.approx(PENCIL)
    assert found.in_mm(b) == pytest.approx(np.full(5, PENCIL * 2**0.5))
    assert found.in_mm(c) == pytest.approx(np.full(5, PENCIL * 3**0.5))
    assert found.between(b, c) / 0.002 == pytest.approx(np.full(5, PENCIL))
    assert found.between(a, c) / 0.002 == pytest.approx(np.full(5, PENCIL * 2**0.5))
    assert gradient(found, c, a) == pytest.approx(np.broadcast_to(np.eye(2), (5, 2, 2)), abs=1e-9)
    assert not gradient(found, a, c).any()


def slider_crank(phi):
    """Crank 30 mm, rod 100 mm, guide 10 mm above the pivot; drawn 1:1 and 1 (m/s)/mm."""
    m = mechanism(StructuralGroup(RRP, ("2", "3"), ("B",), "C", (0.1,), ("x",)), guides=[Guide("x", "0", 0.01j, 0.0)],
                  crank=Crank("1", "A", "B", 0.03, 1000.0, 1))
    pos = position_plan(m, phi)
    return pos, velocity_plan(pos)


def test_slider_crank_drawn_many_times():
    """The crank and its velocity plan, drawn with other means: by hand, 40,000 times, with errors by chance."""
    phi = np.radians([20.0, 75.0, 130.0, 250.0])
    pos, vel = slider_crank(phi)
    found = Errors([(pos.plan, 0.001), (vel.plan, 1.0)], PENCIL, READING)
    rng = np.random.default_rng(3)
    for k, angle in enumerate(phi):
        a, guide = off(rng), 10j + off(rng)
        b = a + 30 * np.exp(1j * angle) + off(rng)
        line = guide.imag + rng.normal(0, PENCIL, MANY)
        c = b.real + np.sqrt((100 + rng.normal(0, PENCIL, MANY)) ** 2 - (line - b.imag) ** 2) + 1j * line
        assert found.in_mm(pos.points["C"])[k] == pytest.approx(spread(c), rel=CHANCE)
        assert found.between(pos.points["A"], pos.points["C"])[k] * 1000 == pytest.approx(np.std(abs(c - a)), rel=CHANCE)
        # Velocities: the crank's length is known, its direction is taken from the drawing.
        vb = 30j * (b - a) / abs(b - a) + off(rng)
        across = 1j * (c - b) / abs(c - b)
        shifted = vb + 1j * across * rng.normal(0, PENCIL, MANY)
        level = rng.normal(0, PENCIL, MANY)
        vc = shifted + across * (level - shifted.imag) / across.imag
        assert found.in_mm(vel.points["C"])[k] == pytest.approx(spread(vc), rel=CHANCE)
        assert found.between(vel.points["B"], vel.points["C"])[k] == pytest.approx(np.std(abs(vc - vb)), rel=CHANCE)
        omega = (abs(vc - vb) + rng.normal(0, READING, MANY)) / 0.1
        assert found.error(vel.omega["2"])[k] == pytest.approx(np.std(omega), rel=CHANCE)


def test_drawn_with_a_mistake():
    """A pin 4 mm off: the rest is the construction from there, at that position only; the Jacobian is its limit."""
    phi = np.radians([20.0, 75.0])
    pos, vel = slider_crank(phi)
    found = Errors([(pos.plan, 0.001), (vel.plan, 1.0)])
    b, c = pos.points["B"], pos.points["C"]
    moved = complex(b.value[1]) + 0.004j
    value = found.displaced(b, 1, 0.004j)
    assert value(c)[0] == c.value[0]
    assert value(c)[1] == pytest.approx(moved.real + np.sqrt(0.01 - (0.01 - moved.imag) ** 2) + 0.01j, abs=1e-12)
    assert value(pos.points["A"]) is pos.points["A"].value
    # The crank keeps its length on the plan of velocities, whatever was drawn.
    assert abs(value(vel.points["B"])[1]) == pytest.approx(30.0)
    assert value(vel.points["B"])[1] == pytest.approx(30j * moved / abs(moved))
    small = found.displaced(b, 1, 1e-7)(vel.points["C"])[1] - vel.points["C"].value[1]
    assert small / 1e-7 == pytest.approx(complex(*gradient(found, vel.points["C"], b)[1, :, 0]), rel=1e-3)


def test_error_of_a_sum():
    """Along the segment for a distance; the gradient goes back to every point that was drawn."""
    plan = Plan("p", "", "mm")
    a, b = plan.add("A", rules.GIVEN, 0j), plan.add("B", rules.GIVEN, 40 + 0j)
    c = plan.add("C", rules.LINE_LINE, a, 1 + 0j, b, 1j)
    found = Errors([(plan, 1.0)], PENCIL)
    error, gradient = found.of_sum([(a, 0, -1 + 0j), (c, 0, 1 + 0j)])
    assert error == pytest.approx(PENCIL * 3**0.5)  # both ends, and the line that C is on
    assert [(s.name, g) for s, _, g in gradient] == [("A", pytest.approx(-1)), ("B", pytest.approx(1)), ("C", pytest.approx(1))]
    assert found.of_sum([]) == (0.0, [])


def test_what_only_spares_rounding_is_not_known_to_a_pencil():
    """The half-chord from the crank angle keeps digits; a drawing without it has the same errors."""
    phi = np.radians([20.0, 100.0])
    pos, vel = slider_crank(phi)
    c, v = pos.points["C"], vel.points["C"]
    assert len(c.args) > len(c.rule.takes)
    assert len(v.args) > len(v.rule.takes)
    plan, of_velocities = Plan("p", "", "m"), Plan("v", "", "m/s", pole="p")
    for name in ("A", "x₀"):
        plan.steps[name] = pos.plan[name]
    plan.steps["B"] = pos.plan["B"]
    bare = plan.add("C", rules.ARC_LINE, *c.args[:5])
    assert bare.value == pytest.approx(c.value, abs=1e-15)
    assert Errors([(plan, 0.001)]).in_mm(bare) == pytest.approx(Errors([(pos.plan, 0.001)]).in_mm(c), rel=1e-9)
    of_velocities.steps |= {s.name: s for s in vel.plan if s.name in ("p", "b")}
    bare = of_velocities.add("c", rules.LINE_LINE, *v.args[:4])
    found = Errors([(pos.plan, 0.001), (of_velocities, 1.0)]).in_mm(bare)
    assert Errors([(pos.plan, 0.001), (vel.plan, 1.0)]).in_mm(v) == pytest.approx(found, rel=1e-9)


def test_tangency():
    """Where an arc just touches a line the crossing moves as the root of the error; beyond, nothing can be drawn."""
    plan = Plan("p", "", "mm")
    centre = plan.add("O", rules.GIVEN, np.array([0, 0.2j, -0.5j, 3j, -20j]))
    p = plan.add("P", rules.GIVEN, 50j)
    c = plan.add("C", rules.ARC_LINE, centre, 50.0, p, 1 + 0j, 1)
    found = Errors([(plan, 1.0)], PENCIL)
    error, linear = found.in_mm(c), found.linear(c)
    assert np.isnan(error[2])
    assert np.isnan(error[4])
    assert list(linear[[0, 1, 3]]) == [False, False, True]
    rng = np.random.default_rng(5)
    for k in (0, 1, 3):
        height = 50 - centre.value[k].imag + np.hypot(2, 2) * PENCIL / 2**0.5 * rng.normal(0, 1, MANY)
        height = height[abs(height) < 50]
        x = np.sqrt(2500 - height**2)
        away = np.sqrt(np.mean((x - np.sqrt(max(2500 - (50 - centre.value[k].imag) ** 2, 0))) ** 2))
        # The roots of several errors add up to more than the root of their sum: near tangency the safe side, within a factor of 2.
        assert 0.97 * away <= error[k] <= (1.03 if linear[k] else 2) * away


def test_chords_add_up():
    """A horizontal integral: each chord adds its own error and those of its ray, all rays have the pole in common."""
    plan = Plan("work", "", "mm")
    n, width, pole = 12, 20.0, 40.0
    ends = integrate(plan, "", width * np.arange(n + 1), np.zeros(n), pole)
    found = of_plan(Errors([(plan, 1.0)], PENCIL), plan)
    ray = (width / pole) ** 2
    for k, end in enumerate(ends):
        assert found[end.name] == pytest.approx(PENCIL * np.sqrt(1 + k + 2 * k * ray + k**2 * ray), rel=1e-4)


def test_all_positions_at_once():
    """The same numbers as one position at a time."""
    project = Project(catalogue.read("sixbar/3:2"))
    every = project.study

    def found(study):
        plans = [(study.positions.plan, 0.002), (study.velocities.plan, 0.05), (study.accelerations.plan, 1.0)]
        return Errors(plans), study.accelerations.plan, study.velocities.omega["2"]

    together, plan, omega = found(every)
    errors_of = of_plan(together, plan)
    for k in (1, 5, 8):
        alone, one, omega_alone = found(project.study_at(every.turned[k:k + 1], ("k",)))
        for name, error in of_plan(alone, one).items():
            expected = np.broadcast_to(errors_of[name], (len(every.labels),))[k]
            assert error[0] == pytest.approx(expected, rel=1e-9, abs=1e-12), name
        assert alone.error(omega_alone)[0] == pytest.approx(together.error(omega)[k], rel=1e-9)


def test_every_step_of_a_project():
    """Forces, levers, gears and cams go through the same replay; what cannot be told is NaN or infinite, never an exception."""
    from tmm_sheets.results import assemble

    project = Project(catalogue.read("lugansk/shaper"))
    assemble(project, None)
    plans = [p for of_part in project.plans.values() for p in (of_part or {}).values() if not p.name.endswith("-between")]
    found = Errors([(p, 1.0 if p.unit == "mm" else 0.01) for p in plans])
    for plan in plans:
        for step in plan:
            error = found.error(step)
            assert error.shape in ((1,), (np.size(step.value),)), (plan.name, step)
            assert not (error < 0).any()
    drawn = [s for p in plans for s in p if s.rule.gives == "point" and s.name not in (p.pole, "S(S')")]
    assert len(drawn) > 200
    assert all((found.in_mm(s)[~np.isnan(found.in_mm(s))] > 0.2).all() for s in drawn)
