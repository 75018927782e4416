"""Scale factors: handy series, standard scales."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tmm_sheets.construction.scale import HANDY, STANDARD, Scale, fit, fit_standard, handy
from tmm_sheets.errors import CannotBuild


@given(st.floats(1e-12, 1e12))
def test_handy_is_the_next_number_of_the_series(least):
    found = handy(least)
    assert found >= least * (1 - 1e-9)
    # A mantissa of the series, as a decimal literal: 0.0025, not 0.0025000000000000001 of a product.
    mantissa = Decimal(repr(found)).normalize().as_tuple()
    assert "".join(map(str, mantissa.digits)) in {"1", "15", "2", "25", "3", "4", "5", "6", "8"}
    # The one before it would be too small.
    series = sorted(float(f"{m}e{k}") for m in HANDY for k in range(-14, 14))
    before = series[series.index(found) - 1]
    assert before < least


@pytest.mark.parametrize(
    ("least", "expected"), [(1.0, 1.0), (1.001, 1.5), (1.51, 2.0), (2.3, 2.5), (0.0045, 0.005), (5.1, 6.0), (6.01, 8.0),
                            (8.01, 10.0), (0.02, 0.02), (99.9, 100.0), (3 * 0.1 / 0.3, 1.0), (0.1 + 0.2, 0.3)],
)
def test_handy_examples(least, expected):
    assert handy(least) == expected


@pytest.mark.parametrize("least", [0.0, -1.0, float("nan")])
def test_no_scale_for_nothing(least):
    with pytest.raises(ValueError, match="must be positive"):
        handy(least)


@given(st.floats(1e-6, 1e6), st.floats(10, 800))
def test_fit_fills_the_place_without_leaving_it(span, mm):
    scale = fit("μ_l", "м/мм", span, mm)
    drawn = scale.mm(span)
    assert drawn <= mm * (1 + 1e-9)
    # The series' widest step is from 1 to 2: never less than half of the place.
    assert drawn > mm / 2 * (1 - 1e-9)


def test_there_and_back():
    scale = Scale("μ_V", 0.02, "м·с^{−1}/мм")
    assert scale.mm(0.6) == pytest.approx(30)
    assert scale.real(30) == pytest.approx(0.6)
    np.testing.assert_allclose(scale.mm(np.array([0.02j, 0.04])), [1j, 2])
    assert str(scale) == "μ_V = 0,02 м·с^{−1}/мм"


def test_standard_scales_are_those_of_the_standard():
    """GOST 2.302: reductions and enlargements, from small to large."""
    ratios = [Fraction(drawn, real) for real, drawn in STANDARD]
    assert ratios == sorted(ratios)
    assert {(2, 1), (5, 2), (4, 1), (5, 1), (10, 1), (20, 1), (40, 1), (50, 1), (100, 1)} <= {(r, d) for r, d in STANDARD if r > d}
    assert {(1, 2), (2, 5), (1, 4), (1, 5), (1, 10), (1, 20), (1, 40), (1, 50), (1, 100)} == {(r, d) for r, d in STANDARD if r < d}


@given(st.floats(0.01, 1e5), st.floats(10, 800))
def test_standard_fit_is_the_largest_that_fits(span, mm):
    ratios = [Fraction(drawn, real) for real, drawn in STANDARD]
    fitting = [x for x in ratios if span * float(x) <= mm * (1 + 1e-9)]
    if not fitting:
        with pytest.raises(CannotBuild, match="do not fit"):
            fit_standard(span, mm)
        return
    real, drawn = fit_standard(span, mm)
    assert Fraction(drawn, real) == max(fitting)


def test_too_large_for_any_standard_scale():
    with pytest.raises(CannotBuild, match=r"1e\+06 mm do not fit in 500 mm"):
        fit_standard(1000000, 500)
