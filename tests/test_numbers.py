"""Numbers as they are written, and which of them are nothing."""

from decimal import Decimal
from math import inf, nan

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tmm_sheets.numbers import NOISE, Sizes, clean, decimal, fixed, is_zero, number, plain


@pytest.mark.parametrize(
    ("x", "text"),
    [(0, "0"), (0.0025, "0,0025"), (2.5, "2,5"), (100.0, "100"), (-3.14159, "−3,142"), (12345.678, "12346"), (1e-7, "0,0000001"),
     (0.1 + 0.2, "0,3"), (99999.0, "99999"), (7744.8836, "7745"), (-0.02, "−0,02"), (1234567.0, "1234567"), (-0.0, "0"),
     (1.0625, "1,063"),
     (10001.5, "10002"), (10002.5, "10003")],
)
def test_number(x, text):
    assert number(x) == text


@pytest.mark.parametrize(
    ("x", "kind", "text"),
    [(-3.441e-18, 0.11, "0"), (6.978e-16, 2.4, "0"), (1e-14, 100, "0"), (2e-3, 1.0, "0,002"), (1e-8, 1.0, "0,00000001"),
     (9e-10, 1.0, "0"), (-9e-10, 1.0, "0"), (5.0, 5.0, "5")],
)
def test_number_beside_those_of_its_kind(x, kind, text):
    assert number(x, kind=kind) == text


@pytest.mark.parametrize(
    ("x", "decimals", "text"),
    [(51.432, 2, "51,43"), (-0.001, 2, "0,00"), (-1.5, 1, "−1,5"), (2.0, 0, "2"), (30.0, 1, "30,0"), (-0.0, 1, "0,0"),
     (40.625, 2, "40,63"), (-40.625, 2, "−40,63"), (0.285, 2, "0,29"), (2.5, 0, "3"), (40.62499, 2, "40,62"),
     (1e30, 0, f"1{30 * '0'}")],
)
def test_fixed(x, decimals, text):
    assert fixed(x, decimals) == text


@pytest.mark.parametrize(
    ("x", "sign", "text"),
    [(-0.001, True, "0.00"), (0.0, True, "0.00"), (0.3, True, "+0.30"), (-0.3, True, "-0.30"), (0.3, False, "0.30"),
     (nan, True, "nan")],
)
def test_decimal(x, sign, text):
    assert decimal(x, 2, sign) == text


def test_plain():
    found = [plain(x, kind=k) for x, k in ((-0.0, 0.0), (1e-14, 1.0), (1e-14, 0.0), (1234567.0, 0.0))]
    assert found == ["0", "0", "1e-14", "1.23457e+06"]


@given(st.floats(-1e9, 1e9))
def test_numbers_read_back(x):
    for text, allowed in ((number(x), max(abs(x) * 5e-4, 0)), (fixed(x, 3), 5.0001e-4)):
        assert "." not in text
        assert "-" not in text
        assert abs(float(text.replace(",", ".").replace("−", "-")) - x) <= allowed + abs(x) * 1e-12


@given(st.floats(1e-6, 1e6), st.floats(-1e6, 1e6))
def test_a_difference_of_equals_is_nothing(a, b):
    """What rounding leaves of (a + b) - b - a is zero beside a and b."""
    left = (a + b) - b - a
    assert abs(Decimal(left)) <= Decimal("2.3e-16") * (Decimal(a) + abs(Decimal(b)))
    assert is_zero(left, max(a, abs(b)))
    assert number(left, kind=max(a, abs(b))) == "0"
    assert clean(a, a) == a


def test_size_does_not_follow_a_dead_point():
    """One position in twelve is a million times as large: the others keep their size, it has its own."""
    speeds = np.array([1e9, *np.linspace(1.0, 3.0, 11)])
    assert Sizes([speeds]).at(0) == 1e9
    assert 2.0 <= Sizes([speeds]).at(5) <= 3.0
    assert not is_zero(0.5, Sizes([speeds]).at(5))


def test_size_knows_noise_at_one_position_by_the_others():
    """A force that vanishes at one position is noise there, though it is the greatest it has there."""
    forces = np.array([1e-13, 20.0, 30.0, 25.0 + 1j])
    assert is_zero(forces[0], Sizes([forces]).at(0))
    assert Sizes([forces, 7e3]).at(0) == 7e3


def test_size_without_anything():
    assert Sizes([]).at(0) == 0.0
    assert Sizes([np.array([nan, inf])]).at(0) == 0.0
    assert Sizes([np.array([nan, 2.0])]).at(0) == 2.0
    assert NOISE == 1e-9
