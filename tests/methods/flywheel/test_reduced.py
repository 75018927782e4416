"""Reduced moment and reduced moment of inertia against closed forms; limits of cutting; loads over the strokes."""

from dataclasses import replace
from math import asin

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests.methods.linkage import shaper_truth, truth
from tests.methods.linkage.mechanisms import mechanism, mechanisms
from tests.methods.linkage.test_forces import loaded
from tests.methods.settings import kinds_alone, tried
from tests.project_files import NOMINAL, from_file, project
from tmm_sheets.mechanism.model import Link
from tmm_sheets.methods.flywheel.reduced import Reduced
from tmm_sheets.methods.linkage.numbering import even_cycle

TURN = np.linspace(0, 2 * np.pi, 101)[:-1] + 0.003
BETA = TURN + shaper_truth.START
"""Crank angle of the shaper from the upward vertical, clockwise."""


def cutting(begin, end):
    """The shaper that cuts on a part of its working stroke only."""
    return project(from_file("lugansk/shaper"), NOMINAL, {"force[1].from": begin, "force[1].to": end})


def test_inertia_of_the_shaper(shaper):
    np.testing.assert_allclose(shaper.reduced.inertia(TURN), shaper_truth.inertia(BETA), rtol=1e-13)


def test_terms_of_the_inertia(shaper):
    true = shaper_truth.inertia_terms(shaper.cycle.turned + shaper_truth.START)
    terms = shaper.reduced.inertia_terms
    names = {"m_2·V_{B}²": "m2", "m_3·V_{S3}²": "m3", "J_{S3}·ω_3²": "J3", "m_4·V_{D}²": "m4", "m_5·V_{S5}²": "m5"}
    assert set(terms) == set(names)
    for name, x in terms.items():
        np.testing.assert_allclose(x / shaper_truth.OMEGA**2, true[names[name]], rtol=1e-12, atol=1e-13)


def test_moment_of_the_shaper(shaper):
    true = np.where(shaper_truth.ram_rate(BETA) > 0, -2800 * shaper_truth.ram_rate(BETA), 0.0)
    np.testing.assert_allclose(shaper.reduced.moment(TURN), true, rtol=1e-12, atol=1e-11)


def test_moment_of_position_2(shaper):
    """From V_D5 of worked position 2; the manual's -342.1 comes from its measured 0.92 m/s."""
    assert shaper.reduced.moment(shaper.cycle.turned[2:3])[0] == pytest.approx(-2800 * 0.91125 / (2 * np.pi * 1.2), rel=1e-5)


def test_both_limits_at_the_dead_positions(shaper):
    r, s = shaper.reduced, shaper.cycle.strokes
    assert r.breaks == pytest.approx((s.begin, s.end), abs=1e-12)
    at = np.array([s.begin, s.end])
    np.testing.assert_array_equal(r.forces_at(at, -1)["F_{5}"], [0, 2800])
    np.testing.assert_array_equal(r.forces_at(at, +1)["F_{5}"], [2800, 0])
    assert np.abs(r.moment(at, 1)).max() < 1e-12


@pytest.mark.parametrize(("begin", "end"), [(0.05, 0.95), (0.0, 0.5), (0.3, 1.0), (0.001, 0.999)])
def test_limits_of_cutting_are_where_the_ram_stands_there(begin, end):
    """x(fraction) = CD sin(swing): the crank angle of a fraction of the stroke in closed form."""
    p = cutting(begin, end)
    r, s = p.reduced, p.cycle.strokes
    reach = float(truth.AB / truth.AC)

    def turned(fraction):
        # Sine rule in the triangle A, B, C: sin(angle at B) = sin(swing) AC/AB, obtuse before the middle of B's way.
        swing = asin(reach * (2 * fraction - 1))
        at_b = asin(np.clip(np.sin(swing) * 0.26 / 0.08, -1, 1))
        return swing + at_b - shaper_truth.START

    expected = [s.begin if begin == 0 else turned(begin), s.end if end == 1 else turned(end)]
    inside = np.linspace(expected[0] + 1e-6, expected[1] - 1e-6, 7)
    outside = np.array([expected[0] - 1e-6, expected[1] + 1e-6, s.end + 0.5, 2 * np.pi - 0.1])
    np.testing.assert_array_equal(r.forces_at(inside)["F_{5}"], 2800)
    np.testing.assert_array_equal(r.forces_at(outside)["F_{5}"], 0)
    # Where the force is cut off within the stroke the two limits differ.
    for fraction, angle in ((begin, expected[0]), (end, expected[1])):
        if 0 < fraction < 1:
            jump = min(r.breaks, key=lambda b: abs(b - angle))
            assert jump == pytest.approx(angle, abs=1e-9)
            assert sorted(np.array([r.forces_at(jump, -1)["F_{5}"], r.forces_at(jump, 1)["F_{5}"]]).tolist()) == [0, 2800]


def test_work_of_one_turn_is_force_times_stroke(shaper):
    """Exact quadrature of the reduced moment between its jumps."""
    r = shaper.reduced
    x, w = np.polynomial.legendre.leggauss(60)
    a, b = r.breaks
    work = (r.moment((a + b) / 2 + (b - a) / 2 * x) * w).sum() * (b - a) / 2
    assert work == pytest.approx(-2800 * 2 * 0.566 * 0.08 / 0.26, rel=1e-12)


def test_one_angle_or_a_million(shaper):
    many = shaper.reduced.inertia(TURN)
    for k in (0, 17):
        assert shaper.reduced.inertia(TURN[k]) == pytest.approx(many[k], rel=1e-14)
        assert shaper.reduced.moment(TURN[k]) == pytest.approx(shaper.reduced.moment(TURN)[k], rel=1e-13, abs=1e-12)


@kinds_alone
def test_inertia_is_twice_the_energy(kinds):
    @tried(kinds)
    @given(mechanisms(kinds), st.randoms(use_true_random=False))
    def check(drawn, random):
        m, phi = drawn
        m = loaded(m, random)
        motion = truth.motion(m, phi)
        energy = sum(link.mass * abs(motion.v[link.centre]) ** 2 + link.inertia * motion.omega[link.name] ** 2
                     for link in m.links.values())
        reduced = Reduced(m, even_cycle(m, phi, 4), ())
        assert reduced.inertia(np.zeros(1))[0] == pytest.approx(energy / m.crank.speed**2, rel=1e-12)

    check()


@kinds_alone
def test_weights_reduce_to_the_slope_of_their_energy(kinds):
    @tried(kinds)
    @given(mechanisms(kinds), st.randoms(use_true_random=False))
    def check(drawn, random):
        m, phi = drawn
        m = loaded(m, random)
        motion = truth.motion(m, phi)
        power = -sum(9.81 * link.mass * motion.v[link.centre].imag for link in m.links.values())
        fastest = max(m.crank.speed * m.crank.length, *map(abs, motion.v.values()))
        size = sum(9.81 * link.mass for link in m.links.values()) * fastest
        found = Reduced(m, even_cycle(m, phi, 4), (), gravity=9.81).moment(np.zeros(1))[0]
        assert abs(found - power / m.crank.speed) <= 1e-12 * size / m.crank.speed

    check()


def test_links_that_turn_evenly_or_not_at_all_have_a_term_at_every_position():
    m = replace(mechanism(), links={"1": Link("1", inertia=2.0)})
    r = Reduced(m, even_cycle(m, 0.0, 8), ())
    np.testing.assert_array_equal(r.inertia(TURN), np.full(TURN.shape, 2.0))
    assert [x.shape for x in r.inertia_terms.values()] == [(8,)]


def test_inertia_about_a_fixed_pivot_replaces_mass_and_central_inertia(shaper):
    m = shaper.mechanism
    about_c = 0.1511 + 5.66 * 0.283**2
    swapped = replace(m, links=m.links | {"3": replace(m.links["3"], pivot_inertia=about_c)})
    np.testing.assert_allclose(Reduced(swapped, shaper.cycle, ()).inertia(TURN), shaper.reduced.inertia(TURN), rtol=1e-13)
