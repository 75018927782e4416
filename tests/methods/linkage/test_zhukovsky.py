"""Zhukovsky's lever against powers, kinetostatics and the whole linear system."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests.methods.linkage import statics, truth
from tests.methods.linkage.mechanisms import mechanism, mechanisms, value
from tests.methods.linkage.test_forces import loaded
from tests.methods.settings import every_kind, tried
from tmm_sheets.mechanism.groups import RPR
from tmm_sheets.mechanism.model import Link, LinkPoint, StructuralGroup
from tmm_sheets.methods.linkage.forces import GearForce
from tmm_sheets.methods.linkage.numbering import even_cycle
from tmm_sheets.methods.linkage.study import Study


def test_lever_and_kinetostatics_agree_at_all_positions(shaper):
    lever, forces = shaper.study.lever, shaper.study.forces
    along = (forces.balancing.value * np.conj(lever.direction)).real
    np.testing.assert_allclose(lever.balancing.value, along, rtol=1e-10)
    assert f"{value(lever.balancing, 2).real:.3f}" == "7744.884"


def test_lever_and_kinetostatics_agree_anywhere(shaper):
    turned = np.random.default_rng(4).uniform(0, 2 * np.pi, 50)
    study = shaper.study_at(turned, tuple(map(str, range(50))))
    along = (study.forces.balancing.value * np.conj(study.lever.direction)).real
    np.testing.assert_allclose(study.lever.balancing.value, along, rtol=1e-10, atol=1e-10 * np.abs(along).max())


def test_tooth_force_acts_on_the_line_of_action(shaper):
    """Pinion above A, wheel turning clockwise: to the right and 20 degrees down, at the base circle's arm."""
    assert shaper.study.lever.direction == pytest.approx(np.exp(-1j * np.radians(20)), rel=1e-15)
    f1 = next(h for h in shaper.study.lever.hung if h.symbol == "F̅_{1}")
    # Arm on the lever: base radius times the crank's speed; 26.43 mm where |pb| is drawn as 45 mm.
    arm = abs(value(f1.arm, 2))
    assert arm == pytest.approx(0.05 * np.cos(np.radians(20)) * 2 * np.pi * 1.2, rel=1e-14)
    assert f"{arm / abs(value(shaper.study.velocities.points['B'], 2)) * 45:.2f}" == "26.43"


def test_every_force_hangs_at_its_point_with_its_power(shaper):
    """Force times arm on the turned plan is the power of the force, whatever its point."""
    study, k = shaper.study, 2
    motion = truth.motion(shaper.mechanism, study.positions.phi[k])
    power = {}
    for link in shaper.mechanism.links.values():
        v = np.conj(motion.v[link.centre])
        power[f"G̅_{link.name}"] = (-9.81j * link.mass * v).real
        power[f"F̅_{{и{link.name}}}"] = (-link.mass * motion.a[link.centre] * v).real
    power["F̅_{5}"] = (-2800 * motion.v["S5"]).real
    power["F̅_{Ми3}"] = shaper.mechanism.links["3"].inertia * -motion.epsilon["3"] * motion.omega["3"]
    hung = {h.symbol: h for h in study.lever.hung}
    # What stands still has no arm: the weight of the balanced crank.
    assert set(hung) == (set(power) | {"F̅_{1}"}) - {"G̅_1", "F̅_{и1}"}
    total = 0.0
    for symbol, h in hung.items():
        moment = abs(value(h.force, k)) * value(h.arm, k).real
        if symbol in power:
            # Turning the plan by +90 degrees turns the power into the moment with the sign changed.
            assert moment == pytest.approx(-power[symbol], rel=1e-12), symbol
        total += moment
    assert abs(total) < 1e-12 * 2800


def test_couple_is_hung_at_the_rocker_end_only(shaper):
    """The other force of the pair would hang at c, which is the pole (manual 000: 0.96 N at d)."""
    couples = [h for h in shaper.study.lever.hung if "М" in h.symbol]
    assert [h.symbol for h in couples] == ["F̅_{Ми3}"]
    assert couples[0].at is shaper.study.lever.points["d"]
    true = 0.1511 * truth.shaper_motion(shaper.study.positions.phi[2], -2 * np.pi * 1.2)[4] / 0.566
    assert abs(value(couples[0].force, 2)) == pytest.approx(abs(true), rel=1e-12)


@every_kind
def test_against_the_whole_system(kinds):
    @tried(kinds)
    @given(mechanisms(kinds), st.randoms(use_true_random=False), st.booleans())
    def check(drawn, random, by_gear):
        m, phi = drawn
        m = loaded(m, random)
        gravity = m.crank.speed**2 * m.crank.length
        driver = GearForce("F1", m.crank.length / 2, 0.35, random.uniform(-3, 3)) if by_gear else None
        study = Study(m, even_cycle(m, phi, 4), np.zeros(1), ("0",), gravity, tuple, driver)
        at = None
        if driver is not None:
            contact = m.fixed["A"] + driver.radius * np.exp(1j * driver.mate)
            # Drives in the sense of rotation, pressed away from the mate by the pressure angle.
            turn = m.crank.sense * (np.pi / 2 + driver.angle)
            at = contact, np.exp(1j * (driver.mate + turn))
        true = statics.solve(m, phi, gravity, driver=at, epsilon=m.crank.sense * m.crank.acceleration)
        largest = max(map(abs, true.reactions.values())) * (1 if by_gear else m.crank.length)
        assert abs(value(study.lever.balancing) - true.balancing) < 1e-10 * largest

    check()


def test_block_with_an_inertia_of_its_own():
    """A slider block turns with its rocker: its couple works too (it hangs at the rocker's points)."""
    m = mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C")), fixed={"C": -0.26j})
    m = replace(m, links=m.links | {"2": Link("2", inertia=0.5)})
    study = Study(m, even_cycle(m, 0.7, 4), np.zeros(1), ("0",), 0.0, tuple, None)
    motion = truth.motion(m, 0.7)
    needed = 0.5 * motion.epsilon["2"] * motion.omega["2"] / m.crank.omega
    assert value(study.lever.balancing).real == pytest.approx(needed, rel=1e-12)
    assert value(study.forces.balancing).real == pytest.approx(needed, rel=1e-12)


def test_names_that_look_like_other_names():
    """Mechanism points called P and F beside the lever's pole, contact point and its image."""
    m = mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C")), fixed={"C": -0.26j},
                  points=[LinkPoint("P", "1", "A", "B", 0.05), LinkPoint("F", "3", "C", "B", 0.1)])
    m = replace(m, links={name: Link(name, mass=1.0, centre=at) for name, at in zip(m.links, "PBF", strict=True)})
    driver = GearForce("F1", 0.05, 0.35, 1.0)
    study = Study(m, even_cycle(m, 0.7, 4), np.zeros(1), ("0",), 9.81, tuple, driver)
    true = statics.solve(m, 0.7, 9.81, driver=(0.05 * np.exp(1j), driver.direction(1)))
    assert value(study.lever.balancing).real == pytest.approx(true.balancing, rel=1e-12)
    assert (value(study.forces.balancing) / driver.direction(1)).real == pytest.approx(true.balancing, rel=1e-12)


@pytest.mark.parametrize(("points", "letter"), [("", "f"), ("F", "q"), ("FQ", "u")])
def test_the_point_of_the_gear_force_has_a_letter_of_its_own(points, letter):
    """f where the mechanism has no F, else the first letter that none of its points has."""
    m = mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C")), fixed={"C": -0.26j},
                  points=[LinkPoint(name, "3", "C", "B", 0.02 * n) for n, name in enumerate(points, 1)])
    study = Study(m, even_cycle(m, 0.7, 4), np.zeros(1), ("0",), 9.81, tuple, GearForce("F1", 0.05, 0.35, 1.0))
    assert study.lever.contact.name == f"{letter}′"
    assert len({step.name for step in study.lever.points.values()} | {study.lever.contact.name}) == len(study.lever.points) + 1
