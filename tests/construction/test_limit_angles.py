"""Quantities that vanish at a limit angle, and what stands on them, against 60 digits."""

from decimal import Decimal, localcontext

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, strategies as st

from tmm_sheets.construction.limit_angles import PI, Cosine, angle_of, cos_sin, direction, split, two_sum

EPS = 2.0**-53


@pytest.fixture(autouse=True)
def sixty_digits():
    with mpmath.workdps(60), localcontext(prec=60):
        yield


def mp(x):
    return mpmath.mpf(str(x))


@pytest.mark.parametrize("x", [0.0, 1e-20, 0.3, 3.141592653589793, -7.1, 1000.0])
def test_cosine_and_sine(x):
    cos, sin = cos_sin(Decimal(x))
    assert abs(mp(cos) - mpmath.cos(x)) < mpmath.mpf(10) ** -50
    assert abs(mp(sin) - mpmath.sin(x)) < mpmath.mpf(10) ** -50


def test_pi_and_angles():
    assert abs(mp(PI) - mpmath.pi) < mpmath.mpf(10) ** -58
    for x, y in ((1.0, 0.0), (-1.0, 1e-30), (-0.3, -0.4), (1e-9, 2.0), (0.0, -1.0)):
        assert abs(mp(angle_of(Decimal(x), Decimal(y))) - mpmath.atan2(y, x)) < mpmath.mpf(10) ** -50
    assert angle_of(Decimal(0), Decimal(0)) == 0


def test_right_angles_are_meant_exactly():
    for k in (-3, -1, 0, 1, 2, 5):
        angle, cos, sin = direction(k * np.pi / 2)
        assert abs(mp(angle) - k * mpmath.pi / 2) < mpmath.mpf(10) ** -55
        assert complex(float(cos), float(sin)) == 1j**k
    assert float(direction(0.3)[0]) == 0.3


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_sums_lose_nothing(a, b):
    s, e = two_sum(a, b)
    assert Decimal(s) + Decimal(e) == Decimal(a) + Decimal(b)


def test_two_doubles_keep_thirty_digits():
    high, low = split(PI)
    assert high == np.pi
    assert abs(Decimal(high) + Decimal(low) - PI) < Decimal("1e-32")


@given(st.floats(-3, 3), st.floats(0.1, 3), st.floats(-4, 4), st.floats(-16, 0), st.sampled_from((1, -1)),
       st.sampled_from((0, 1, -1000, 1000000)))
@example(-1.0200042000707956, 1.1645350508926529, 0.0, -9.25, 1, 1000000)
def test_relative_error_at_any_gap(a, b, start, exponent, side, turns):
    with mpmath.workdps(60), localcontext(prec=60):
        base = float(mpmath.acos(max(-1, min(1, -mpmath.mpf(a) / b))))
        phi = start + side * (base + 10**exponent) + 2 * np.pi * turns
        true = mpmath.mpf(a) + mpmath.mpf(b) * mpmath.cos(mpmath.mpf(phi) - start)
        found = float(Cosine(Decimal(a), Decimal(b), Decimal(start))(phi))
        # Two doubles hold the angle to EPS**2 of itself; after many turns that is what limits the nearest gaps. There the angle is
        # rounded by more than the gap that was asked for: what it is counts, to the next zero of the cosine's sum.
        zero = mpmath.acos(max(-1, min(1, -mpmath.mpf(a) / b)))
        turned = mpmath.mpf(phi) - start - 2 * mpmath.pi * turns
        gap = min(abs(turned - zero), abs(turned + zero))
        bound = 8 * EPS + 8 * abs(phi) * EPS**2 / gap if gap else 1
        assert abs(found - true) <= bound * abs(true) + 1e-45


@pytest.mark.parametrize(("a", "b"), [(1.7, 1.7), (-1.7, 1.7), (1.7 + 2e-15, 1.7), (1.7 - 2e-15, 1.7)])
def test_change_points_and_their_neighbours(a, b):
    """A gap that vanishes without changing its sign, one that just does not vanish, one that just does."""
    c = Cosine(Decimal(a), Decimal(b), Decimal(0))
    for e in (1e-1, 1e-4, 1e-7, 3e-8, 1e-9, 1e-12):
        phi = (np.pi if a > 0 else 0.0) + e
        true = mpmath.mpf(a) + mpmath.mpf(b) * mpmath.cos(mpmath.mpf(phi))
        assert abs(float(c(phi)) - true) <= 1e-14 * abs(true)
