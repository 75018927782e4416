"""Laws of motion against quadrature of their second derivative; diagrams given as tables against laws in closed form."""

from itertools import pairwise
from math import pi, radians

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st

from tests.methods.cams.cam_cases import cam_data, sine_motion
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams.cam_displacement import ExactMotion
from tmm_sheets.methods.cams.cam_laws import CONSTANT, LAWS, LINEAR, SINE, TRAPEZOID, PositionFunction, table_law

KINKS = {"constant": (0.5,), "trapezoid": (1 / 8, 3 / 8, 5 / 8, 7 / 8)}
X = np.linspace(0, 1, 1001)


def integral(f, upto, borders):
    """Gauss-Legendre with 40 nodes on every smooth piece of 0 .. upto."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    ends = [0.0, *(j for j in borders if j < upto), upto]
    return sum((b - a) / 2 * float(weights @ f((a + b) / 2 + (b - a) / 2 * nodes)) for a, b in pairwise(ends))


@pytest.mark.parametrize("name", LAWS)
def test_law_is_the_integral_of_its_second_derivative(name):
    law, kinks = LAWS[name], KINKS.get(name, ())
    for x in (0.1, 0.25, 0.5, 0.61, 0.875, 1.0):
        # The sum of 40 terms of up to 2 pi rounds in the 14th digit.
        assert law.ds(x) == pytest.approx(integral(law.dds, x, kinks), abs=5e-14)
        assert law.s(x) == pytest.approx(integral(law.ds, x, kinks), abs=5e-14)
    assert law.s(1.0) == pytest.approx(1.0, abs=1e-15)
    assert np.abs(law.dds(X)).max() == pytest.approx(law.peak, rel=1e-12)


@pytest.mark.parametrize("name", [law.name for law in LAWS.values() if law.division])
def test_auxiliary_circle_carries_the_ordinates_of_the_law(name):
    law = LAWS[name]
    x = np.linspace(0, 1, 33)
    np.testing.assert_allclose(law.peak * np.sin(law.division(x)), law.dds(x), atol=1e-13 * law.peak)


def test_trapezoid_in_closed_form():
    """Ramps of an eighth, peak 16/3, written out for the first half; the second is its image."""
    a = 16 / 3

    def s(x):
        first = a * 8 * x**3 / 6
        flat = a * (8 / 6 / 512 + (x - 1 / 8) / 16 + (x - 1 / 8) ** 2 / 2)
        v, w, t = 1 / 16 + 1 / 4, 8 / 6 / 512 + 1 / 64 + 1 / 32, x - 3 / 8
        falling = a * (w + v * t + t**2 / 2 - 8 * t**3 / 6)
        return np.where(x < 1 / 8, first, np.where(x < 3 / 8, flat, falling))

    half = X[X <= 0.5]
    np.testing.assert_allclose(TRAPEZOID.s(half), s(half), rtol=0, atol=1e-15)
    np.testing.assert_allclose(TRAPEZOID.s(1 - half), 1 - s(half), rtol=0, atol=1e-15)
    assert TRAPEZOID.peak == pytest.approx(16 / 3, rel=1e-15)


@pytest.mark.parametrize("name", LAWS)
def test_second_half_is_the_first_read_backwards(name):
    law = LAWS[name]
    np.testing.assert_allclose(law.s(X), 1 - law.s(1 - X), rtol=0, atol=1e-15)


def test_a_law_that_is_not_even_is_read_backwards_whole():
    """The return that retraces the rise: its derivatives are those of its own travel, its jumps the others' images."""
    law = table_law([0, 0.2, 0.2, 0.7, 1], [9, 9, -1, -3, -2])
    back = law.reverse
    assert not law.even
    assert back.jumps == pytest.approx([0.8])
    for x in (0.15, 0.5, 0.79, 1.0):
        assert back.s(x) == pytest.approx(1 - law.s(1 - x), abs=1e-15)
        assert back.s(x) == pytest.approx(integral(back.ds, x, (0.3, 0.8)), abs=5e-14)
        assert back.ds(x) == pytest.approx(integral(back.dds, x, (0.3, 0.8)), abs=5e-14)


def test_tables_of_straight_lines_are_exact():
    linear = table_law([0, 1], [3, -3])
    np.testing.assert_allclose(linear.s(X), LINEAR.s(X), rtol=0, atol=1e-15)
    np.testing.assert_allclose(linear.dds(X), LINEAR.dds(X), rtol=0, atol=1e-14)
    constant = table_law([0, 0.5, 0.5, 1], [7, 7, -7, -7])
    assert constant.jumps == (0.5,)
    np.testing.assert_allclose(constant.s(X), CONSTANT.s(X), rtol=0, atol=1e-15)
    np.testing.assert_array_equal(constant.dds(X), CONSTANT.dds(X))


def test_table_of_a_sine_is_a_sine_nearly():
    x = np.linspace(0, 1, 33)
    law = table_law(x, np.sin(2 * pi * x))
    np.testing.assert_allclose(law.s(X), SINE.s(X), rtol=0, atol=1e-4)
    # The cubics keep to the points and are flat in their peaks.
    np.testing.assert_allclose(law.dds(x), SINE.dds(x), rtol=0, atol=0.02)


@given(st.lists(st.floats(0.05, 1), min_size=1, max_size=5), st.lists(st.floats(0.05, 1), min_size=1, max_size=5),
       st.floats(0.2, 0.8))
def test_any_table_makes_a_whole_stroke_or_is_refused(up, down, middle):
    x = [*np.linspace(0, middle, len(up) + 2), *np.linspace(middle, 1, len(down) + 2)[1:]]
    y = [0.0, *up, 0.0, *(-v for v in down), 0.0]
    # Areas of the straight lines made equal: those of the smooth curve are nearly so.
    areas = [(b - a) * (p + q) / 2 for (a, b), (p, q) in zip(pairwise(x), pairwise(y), strict=True)]
    above, below = sum(v for v in areas if v > 0), -sum(v for v in areas if v < 0)
    y = [v if v > 0 else v * above / below for v in y]
    try:
        law = table_law(x, y)
    except CannotBuild:
        # Few points: joined smoothly, the areas differ after all.
        assume(False)
    assert law.s(0.0) == 0
    assert law.s(1.0) == pytest.approx(1.0, abs=1e-13)
    assert law.ds(1.0) == pytest.approx(0.0, abs=1e-12)
    # No overshoot between the points, the zeros kept; derivatives belong together.
    assert (law.dds(np.linspace(0, middle, 200)) >= -1e-12 * law.peak).all()
    assert (law.dds(np.linspace(middle, 1, 200)) <= 1e-12 * law.peak).all()
    h = 1e-6
    inner = np.linspace(0.01, 0.99, 99)
    np.testing.assert_allclose((law.s(inner + h) - law.s(inner - h)) / (2 * h), law.ds(inner), atol=1e-8 * law.peak)
    reverse = law.reverse
    np.testing.assert_allclose(reverse.s(X), 1 - law.s(1 - X), rtol=0, atol=1e-15)


@pytest.mark.parametrize(("x", "y", "said"), [
    ([0, 1], [1, 1], "1.00 and 0.00 of the whole"), ([0, 1], [-1, 1], "turns back"), ([0, 1], [0, 0], "zero everywhere"),
    ([0, 0.5, 0.5, 1], [1, 1, -0.5, -0.5], "0.67 and 0.33 of the whole")])
def test_what_is_no_law_is_said(x, y, said):
    with pytest.raises(CannotBuild, match=said):
        table_law(x, y)


def law_of(data, **more):
    return PositionFunction.of(data.rise, data.upper_dwell, data.fall, data.stroke, LAWS[data.law], **more)


def test_position_function_against_the_written_out_sine():
    data = cam_data()
    law = law_of(data)
    phi = np.linspace(0, 2 * pi, 1500)
    for mine, truth in zip((law.s(phi), law.ds(phi), law.dds(phi)), sine_motion(data, phi), strict=True):
        np.testing.assert_allclose(mine, truth, rtol=0, atol=1e-15 * 50)
    assert law.s(phi[700] + 2 * pi) == pytest.approx(float(law.s(phi[700])), abs=1e-15)


def test_fall_mirrors_the_rise_or_has_its_own_law():
    skew = table_law([0, 0.2, 0.4, 0.7, 1], [0, 1.5, 0, -1, 0])
    mirrored = PositionFunction.of(1.0, 0.5, 2.0, 0.01, skew)
    x = np.linspace(0.001, 0.999, 77)
    np.testing.assert_allclose(mirrored.s(3.5 - 2 * x), mirrored.s(x), atol=1e-16)
    own = PositionFunction.of(1.0, 0.5, 2.0, 0.01, skew, SINE)
    np.testing.assert_allclose(own.s(1.5 + 2 * x), 0.01 * (1 - SINE.s(x)), atol=1e-16)


def test_full_turn_without_lower_dwell():
    law = law_of(cam_data(rise=120, upper_dwell=120, fall=120))
    assert law.lower_dwell.angle < 1e-12
    assert law.s(2 * pi) == pytest.approx(0, abs=1e-15)


def test_labels_and_shares():
    law = law_of(cam_data())
    assert law.labels == (*"012345678", "8'", *map(str, range(9, 17)))
    assert law.positions[1] == pytest.approx(radians(100 / 8))
    assert law.positions[-1] == pytest.approx(radians(205))
    np.testing.assert_allclose(law.divided(8)[:9], law.positions[:9], atol=1e-15)
    assert law_of(cam_data(), parts=6).labels == (*"0123456", "6'", *map(str, range(7, 13)))


# --- limits from either side ------------------------------------------------------------------------------------------


def limits(rise, dwell, fall):
    """Limits of S'' of constant acceleration at positions 0 .. 16 by hand: +-4 h/angle^2 inside, nothing in a dwell."""
    up, down = 4 / rise**2, 4 / fall**2
    before = [0.0, *[up] * 4, *[-up] * 4, 0.0 if dwell else -up, *[-down] * 4, *[down] * 4]
    after = [*[up] * 4, *[-up] * 4, 0.0 if dwell else -down, *[-down] * 4, *[down] * 4, 0.0]
    return np.array(before), np.array(after)


@pytest.mark.parametrize("dwell", [radians(20), 0.0])
def test_both_limits_where_the_second_derivative_jumps(dwell):
    law = PositionFunction.of(radians(140), dwell, radians(120), 0.055, CONSTANT)
    before, after = limits(radians(140), dwell, radians(120))
    exact = ExactMotion(law)
    np.testing.assert_allclose(exact.before.dds.value, 0.055 * before, atol=1e-15)
    np.testing.assert_allclose(exact.after.dds.value, 0.055 * after, atol=1e-15)


def test_limits_of_a_law_that_fills_the_turn():
    """Without a lower dwell the fall goes over into the rise: the limits at 0 and 16 are those of the other phase."""
    law = PositionFunction.of(pi, 0.0, pi, 0.02, LAWS["cosine"])
    before, after = (side.dds.value for side in (ExactMotion(law).before, ExactMotion(law).after))
    peak = 0.02 * pi**2 / 2 / pi**2
    assert before[[0, 8, 9, 17]] == pytest.approx([peak, -peak, -peak, peak])
    assert after[[0, 8, 9, 17]] == pytest.approx([peak, -peak, -peak, peak])


@pytest.mark.parametrize("law", [SINE, TRAPEZOID])
def test_a_law_without_jumps_has_one_limit(law):
    exact = ExactMotion(PositionFunction.of(1.0, 0.3, 1.5, 0.02, law))
    np.testing.assert_allclose(exact.before.dds.value, exact.after.dds.value, atol=1e-9 * 0.02 * 2 * pi)
