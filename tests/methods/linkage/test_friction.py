"""Friction in the pairs: all reactions against Newton's method over the equilibrium of every link, Coulomb's law in it; power."""

from functools import cache

import numpy as np
import pytest

from tests import project_files as files
from tests.methods.linkage import statics
from tests.methods.linkage.mechanisms import value
from tmm_sheets.errors import BadInput, CannotBuild

F1 = np.exp(-1j * np.radians(20))
CASES = {
    "tests/projects/pump.toml": ("A", "B", "C"),  # RRP
    "tests/projects/feeder.toml": ("A", "B", "C", "D", "E"),  # RRR, PRP
    "lugansk/shaper": ("A", "B", "C", "D"),  # RPR, RPP, driven by a gear
}


@cache
def rubbing(name, turning=0.1, sliding=0.12, radius=0.02):
    """A project with friction in all its pairs, or in none."""
    given = {"turning": turning, "sliding": sliding, "radii": dict.fromkeys(CASES[name], f"{radius} m")} if turning else {}
    return files.project({**files.from_file(name), "friction": given})


def true(project, k, friction):
    """Reactions of all links at a position by one system of equations."""
    study, m = project.study, project.mechanism
    applied = [(f.link, f.point, complex(f.vector(study.turned[k:k + 1])[0])) for f in project.applied]
    driver = None if project.driver is None else (project.driver.radius * np.exp(1j * project.driver.mate),
                                                   project.driver.direction(m.crank.sense))
    return statics.solve(m, float(study.positions.phi[k]), float(project.gravity), applied, driver=driver, friction=friction)


@pytest.mark.parametrize("name", CASES)
def test_all_reactions(name):
    project = rubbing(name)
    forces, (turning, sliding, radius) = project.study.forces, (0.1, 0.12, 0.02)
    for k in (1, 2, 5):
        t = true(project, k, (turning, sliding, dict.fromkeys(CASES[name], radius)))
        largest = max(map(abs, t.reactions.values()))
        for pair, step in forces.reactions.items():
            assert abs(value(step, k) - t.reactions[pair]) < 1e-9 * largest, (k, pair)
        assert abs(abs(value(forces.balancing, k)) - abs(t.balancing)) < 1e-9 * largest
        for pair, step in forces.couples.items():
            assert abs(value(step, k) - t.couples[pair]) < 1e-9 * largest, (k, pair)
        assert float(forces.friction.total.at(k)) == pytest.approx(t.friction, rel=1e-8)
        assert t.friction < 0


@pytest.mark.parametrize("name", CASES)
def test_power_balance(name):
    """What the drive gives more than without friction is what friction takes; the lever says the same."""
    project = rubbing(name)
    free = rubbing(name, 0)
    crank = project.mechanism.crank
    if project.driver is None:
        more = (project.study.forces.balancing.value - free.study.forces.balancing.value) * crank.omega
        np.testing.assert_allclose(more, -project.study.forces.friction.total.value, rtol=1e-9)
    assert np.nanmax(project.study.balance["Δ"].value) < 1e-8
    assert (project.study.forces.friction.total.value <= 0).all()


def test_nothing_of_no_friction():
    """Coefficients of zero and hinges without journals: today's numbers to the last digit."""
    name = "tests/projects/pump.toml"
    free, none = (files.project({**files.from_file(name), "friction": f}) for f in ({}, {"turning": 0, "sliding": 0}))
    for pair, step in free.study.forces.reactions.items():
        np.testing.assert_array_equal(step.value, none.study.forces.reactions[pair].value)
    assert not none.study.forces.friction.pairs


def test_no_friction_where_nothing_moves():
    """At its dead points the piston stands: the guide's reaction is normal there, and behind it inclined against the sliding."""
    forces = rubbing("tests/projects/pump.toml").study.forces
    f = forces.reactions["F30"].value
    assert [forces.friction.still("30", k) for k in (0, 3, 1)] == [True, True, False]
    assert f[0].real == f[3].real == 0
    angle = np.arctan2(np.abs(f.real), np.abs(f.imag))
    np.testing.assert_allclose(angle[[1, 2, 4, 5]], np.arctan(0.12), rtol=1e-12)
    v = forces.friction.sliding["30"].value
    assert (f.real * v.real <= 0).all()


def test_the_reaction_touches_the_circle_of_friction():
    forces = rubbing("tests/projects/pump.toml").study.forces
    for index, moment in forces.friction.moments.items():
        arm = np.abs(moment.value) / np.abs(forces.reactions[f"F{index}"].value)
        np.testing.assert_allclose(arm[[1, 2, 4]], 0.1 * 0.02, rtol=1e-11)


@pytest.mark.parametrize("jams", [False, True])
def test_self_braking_of_a_slider(jams):
    """Without masses: the rod's force is F/(cos b - f sin b), its angle b to the guide; as long as f tan b < 1."""
    sine = 0.1 / 0.105
    tangent = sine / np.sqrt(1 - sine**2)
    f = (1.01 if jams else 0.99) / tangent
    project = files.project(files.HEAD, files.SLIDER, {"group[1].length": "0.105 m"}, files.EVEN, files.FORCE, files.MOMENT,
                            {"friction": {"sliding": f}})
    if jams:
        with pytest.raises(CannotBuild, match=r"position 3, .*F30: .* jams"):
            _ = project.study.forces
        return
    expected = 100 / (np.sqrt(1 - sine**2) - f * sine)
    assert abs(value(project.study.forces.reactions["F23"], 3)) == pytest.approx(expected, rel=1e-9)


def test_journals_too_thick():
    with pytest.raises(CannotBuild, match="jams"):
        _ = rubbing("tests/projects/pump.toml", 1, 0.12, 0.3).study.forces


@pytest.mark.parametrize(("friction", "said"), [
    ({"turning": 0.1}, "radii of the journals"), ({"radii": {"A": "20 mm"}}, "radii need turning"),
    ({"turning": 0.1, "radii": {"S2": "20 mm"}}, "no turning pair"), ({"sliding": -0.1}, "sliding"), ({"sliding": 1.2}, "sliding"),
    ({"turning": 0.1, "radii": {"A": "-2 mm"}}, "radii"),
])
def test_what_cannot_be_given(friction, said):
    with pytest.raises(BadInput, match=said):
        files.project({**files.from_file("tests/projects/pump.toml"), "friction": friction})


def test_class_three():
    """Journals of a group of class III may have friction, its sliding pairs may not."""
    sieve = files.from_file("tests/projects/sieve.toml")
    free, rubbed = (p.study_at(p.cycle.turned[[1, 5]], ("1", "5")) for p in (files.project(sieve, {"friction": f}) for f in ({}, {
        "turning": 0.1, "radii": dict.fromkeys("ABCEGHL", "10 mm")})))
    more = (rubbed.forces.balancing.value - free.forces.balancing.value) * rubbed.mechanism.crank.omega
    np.testing.assert_allclose(more, -rubbed.forces.friction.total.value, rtol=1e-8)
    p = files.project(sieve, {"friction": {"sliding": 0.1}})
    with pytest.raises(CannotBuild, match="class III"):
        _ = p.study_at(p.cycle.turned[:1], ("0",)).forces
