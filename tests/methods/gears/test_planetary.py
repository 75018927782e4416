"""One planetary stage against velocities of pitch points, against power balances, and against placing satellites one by one."""

from fractions import Fraction
from itertools import product
from math import gcd

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tmm_sheets.methods.gears.planetary import (
    EFFICIENCY,
    SCHEMES,
    assembles,
    efficiency_case,
    inner_ratio,
    least_ring,
    neighbours_clear,
    stage_ratio,
)

SIGNS = {name: s.signs for name, s in SCHEMES.items()}


def stages(name, least=15, most=60):
    """Tooth numbers z1 .. z4 that are coaxial."""
    s1, s2 = SIGNS[name]

    def complete(z):
        one, two, three = (z[0], z[1], z[1]) if SCHEMES[name].single else z
        return one, two, three, (one + s1 * two - three) if s2 > 0 else (one + s1 * two + three)

    teeth = st.integers(least, most)
    return st.tuples(teeth, teeth, teeth).map(complete).filter(lambda z: z[3] > 3 and z[0] + s1 * z[1] > 0)


def wheels_with(name):
    return st.tuples(st.just(name), stages(name))


ANY = st.sampled_from(sorted(SIGNS)).flatmap(wheels_with)


def solved(name, z, driver):
    """Speeds of wheel 1, block, wheel 4 and carrier for an input of 1: equal velocities in the points of contact."""
    s1, s2 = SIGNS[name]
    r = [v / 2 for v in z]
    axis = r[0] + s1 * r[1]
    # in a pitch point: omega_central * radius = omega_H * axis + omega_block * (radius - axis)
    rows = [[r[0], -(r[0] - axis), 0, -axis], [0, -(r[3] - axis), r[3], -axis]]
    given = {"sun": ([1, 0, 0, 0], [0, 0, 1, 0]), "ring": ([0, 0, 1, 0], [1, 0, 0, 0]), "carrier": ([0, 0, 0, 1], [0, 0, 1, 0])}
    speeds = np.linalg.solve(np.array([*rows, *given[driver]], float), [0, 0, 1, 0])
    assert abs(r[3] + s2 * r[2] - axis) < 1e-12
    return speeds


@given(ANY)
def test_ratio_is_that_of_the_velocities(case):
    name, z = case
    inner = inner_ratio(SIGNS[name], z)
    for driver in SCHEMES[name].drivers:
        if abs(inner - 1) < 1e-12:
            continue
        speeds = solved(name, z, driver)
        output = speeds[0] if driver == "carrier" else speeds[3]
        assert stage_ratio(inner, driver) == pytest.approx(1 / output, rel=1e-9)


def balanced(inner, driver, eta0):
    """Efficiency from the balance of moments: the losses arise in the power that flows with the carrier stopped."""
    one, four, carrier = {"sun": (1.0, 0.0, 1 / (1 - inner)), "ring": (0.0, 1.0, 1 / (1 - 1 / inner)),
                          "carrier": (1 - inner, 0.0, 1.0)}[driver]
    for way in (1, -1):
        torque_one = 1.0
        # moments on the stage's shafts: the moment on 4 balances that on 1 through the ratio, less or more the losses
        torque_four = -torque_one * inner * eta0**way
        torque_h = -(torque_one + torque_four)
        power = {"sun": torque_one * one, "ring": torque_four * four, "carrier": torque_h * carrier}
        out = torque_one * one if driver == "carrier" else torque_h * carrier
        relative = torque_one * (one - carrier)
        put_in = power[driver]
        # way +1 holds when the power relative to the carrier flows from 1 to 4 while the driver puts power in
        if np.sign(relative) * np.sign(put_in) == way and out * put_in < 0:
            return -out / put_in
    raise AssertionError("no direction of the power is consistent")


@given(ANY, st.floats(0.9, 0.999))
def test_efficiency_is_that_of_the_power_balance(case, eta0):
    name, z = case
    inner = inner_ratio(SIGNS[name], z)
    if abs(inner - 1) < 1e-6:
        return
    for driver in SCHEMES[name].drivers:
        got = float(EFFICIENCY[efficiency_case(inner, driver)](inner, eta0))
        assert got == pytest.approx(balanced(inner, driver, eta0), rel=1e-9)
        assert 0 < got < 1


def fits_by_placing(signs, z, count):
    """Whether ``count`` equal blocks mesh at equal angles: every pair of teeth is tried, with rational numbers.

    A block at angle ``p`` (in turns) of the carrier meets the fixed wheel 4 in some of the turns b/z3 and wheel 1 in some of
    the turns a/z2; the first block defines where both wheels stand.
    """
    one, two, three, four = z
    s1, s2 = signs
    for k in range(1, count):
        p = Fraction(k, count)
        on_four = {(p * (1 + s2 * Fraction(four, three)) + Fraction(b, three)) % 1 for b in range(three)}
        on_one = {(p * (1 + s1 * Fraction(one, two)) + Fraction(a, two)) % 1 for a in range(two)}
        if not on_four & on_one:
            return False
    return True


@given(st.sampled_from(sorted(SIGNS)).flatmap(lambda name: st.tuples(st.just(name), stages(name, 8, 26))), st.integers(2, 6))
def test_assembly_is_necessary_and_sufficient(case, count):
    name, z = case
    assert bool(assembles(SIGNS[name], z, count)) == fits_by_placing(SIGNS[name], z, count)


def test_assembly_of_a_single_row_is_the_textbook_one():
    for one, two, count in product(range(15, 40), range(15, 30), (2, 3, 4, 5)):
        ring = one + 2 * two
        assert bool(assembles((1, -1), (one, two, two, ring), count)) == ((one + ring) % count == 0)


def test_textbook_form_implies_the_exact_one():
    """z1 i1H (1 + k p)/k whole for some p: stricter, never the other way round."""
    stricter = 0
    for one, two, three, count in product(range(15, 24), range(15, 30), range(15, 30), (3, 4)):
        z = (one, two, three, one + two + three)
        ratio = 1 + Fraction(z[1] * z[3], z[0] * z[2])
        textbook = any((one * ratio * (1 + count * p) / count).denominator == 1 for p in range(51))
        exact = bool(assembles((1, -1), z, count))
        assert exact or not textbook
        stricter += exact and not textbook
    assert stricter > 100


def test_neighbours_are_clear_when_their_tip_circles_are():
    for name, count, ha in product(SIGNS, (2, 3, 4, 5, 6), (0.8, 1.0)):
        for z in ((40, 17, 18, 41), (60, 20, 17, 63), (33, 18, 16, 30)):
            axis = (z[0] + SIGNS[name][0] * z[1]) / 2
            at = axis * np.exp(2j * np.pi * np.arange(count) / count)
            apart = min(abs(at[i] - at[j]) for i in range(count) for j in range(i))
            assert bool(neighbours_clear(SIGNS[name], z, count, ha)) == (apart > max(z[1], z[2]) + 2 * ha)


def test_least_rings():
    """Printed in no manual: computed independently for this task; none for fewer teeth, then z + 9 and z + 8."""
    full = {18: 161, 19: 86, 20: 64, 21: 53, 22: 46, 23: 42, 24: 40, 25: 38, 26: 37, 27: 36}
    stub = {14: 271, 15: 77, 16: 51, 17: 41, 18: 35, 19: 32, 20: 30, 21: 29}
    assert {z: least_ring(z, 1.0) for z in full} == full
    assert {z: least_ring(z, 0.8) for z in stub} == stub
    assert [least_ring(z, 1.0) for z in (15, 16, 17)] == [0, 0, 0]
    assert [least_ring(z, 1.0) - z for z in (28, 30, 40)] == [9, 9, 9]


def test_schemes_of_the_manual():
    """Ratios and conditions as the tables' schemes are usually written."""
    z = (21, 15, 16, 20)
    assert 1 / (1 - Fraction(z[1] * z[3], z[0] * z[2])) == Fraction(28, 3)
    assert stage_ratio(inner_ratio((1, 1), z), "carrier") == pytest.approx(28 / 3, rel=1e-14)
    assert stage_ratio(inner_ratio((1, -1), (15, 15, 15, 45)), "sun") == 4
    assert stage_ratio(inner_ratio((1, -1), (49, 15, 15, 79)), "ring") == pytest.approx(1 + 49 / 79, rel=1e-14)
    assert stage_ratio(inner_ratio((1, -1), (15, 30, 15, 60)), "sun") == 9
    assert gcd(30, 15) == 15
    eta0 = 0.98**2
    assert EFFICIENCY[efficiency_case(-8.0, "sun")](-8.0, eta0) == pytest.approx((1 + eta0 * 8) / 9, rel=1e-14)
    assert EFFICIENCY[efficiency_case(0.9, "carrier")](0.9, eta0) == pytest.approx(0.1 / (1 - 0.9 * eta0), rel=1e-12)
    assert EFFICIENCY[efficiency_case(1.1, "carrier")](1.1, eta0) == pytest.approx(eta0 * 0.1 / (1.1 - eta0), rel=1e-12)
