"""Graphical integration against exact integrals."""

from __future__ import annotations

from math import pi

import mpmath
import numpy as np
import pytest
from hypothesis import given, strategies as st

from tmm_sheets.construction.protocol import sentences
from tmm_sheets.construction.step import Plan
from tmm_sheets.methods.integration import Quadrature, differentiate, integrate, ordinates, smooth


def chords(f, edges, pole=1.0):
    """Integral at the borders by chords of ordinates in the middle."""
    edges = np.asarray(edges, dtype=float)
    plan = Plan("integral", "Интеграл", "mm")
    ends = integrate(plan, "", edges, f((edges[:-1] + edges[1:]) / 2), pole)
    return ordinates(ends) * pole


def test_equal_area_heights_are_exact():
    edges = np.array([0.0, 1.0, 2.5, 3.0, 6.0])
    exact = edges**4 / 4
    heights = np.diff(exact) / np.diff(edges)
    plan = Plan("integral", "Интеграл", "mm")
    ends = integrate(plan, "", edges, heights, 12.5)
    np.testing.assert_allclose(ordinates(ends) * 12.5, exact, rtol=1e-14)
    np.testing.assert_array_equal([s.value.real for s in ends], edges)


def test_every_chord_is_parallel_to_its_ray():
    plan = Plan("integral", "Интеграл", "mm")
    ends = integrate(plan, "", [0, 10, 25, 30], [7.0, -3.0, 0.0], 16)
    for k in (1, 2, 3):
        chord = ends[k].value - ends[k - 1].value
        ray = plan[f"{k}′"].value - plan["P"].value
        assert abs((np.conj(chord) * ray).imag) < 1e-13 * abs(chord) * abs(ray)
        assert plan[f"m{k}"].value.imag == plan[f"{k}′"].value.imag
    assert plan["P"].value == -16


@pytest.mark.parametrize("n", [12, 24, 60])
def test_known_error_of_sine_squared(n):
    """Measured once with another program: 3.3e-3, 9.2e-4, 1.4e-4 of the largest ordinate (midpoint chords)."""
    edges = np.linspace(0, 2 * pi, n + 1)
    exact = edges / 2 - np.sin(2 * edges) / 4
    error = np.abs(chords(lambda x: np.sin(x) ** 2, edges) - exact).max() / exact.max()
    measured, half_digit = {12: (3.3e-3, 5e-5), 24: (9.2e-4, 5e-6), 60: (1.4e-4, 5e-6)}[n]
    assert error == pytest.approx(measured, abs=half_digit)


def test_second_order_with_borders_at_the_jumps_first_order_without():
    def step(x):
        return np.where((x > 1.1) & (x < 4.3), 1 + np.sin(x), 0.0)

    def exact(x):
        x = np.clip(x, 1.1, 4.3)
        return x - 1.1 - np.cos(x) + np.cos(1.1)

    def error(n, borders):
        edges = np.unique(np.concatenate((np.linspace(0, 2 * pi, n + 1), borders)))
        return np.abs(chords(step, edges) - exact(edges)).max()

    with_borders = [error(n, [1.1, 4.3]) for n in (25, 50, 100, 200)]
    assert np.log2(with_borders[0] / with_borders[-1]) / 3 == pytest.approx(2, abs=0.05)
    # Without, the error depends on where the jump falls in its interval: the worst of a few numbers of intervals.
    without = [max(error(n, []) for n in range(m, m + 12)) for m in (50, 100, 200)]
    assert np.log2(without[0] / without[-1]) / 2 == pytest.approx(1, abs=0.2)
    assert without[-1] > 50 * with_borders[-1]


@given(st.lists(st.tuples(st.floats(0.1, 50), st.floats(-100, 100)), min_size=1, max_size=20), st.floats(5, 100))
def test_pole_distance_only_scales_and_differentiation_undoes_integration(parts, pole):
    edges = np.concatenate(([0.0], np.cumsum([w for w, _ in parts])))
    heights = np.array([h for _, h in parts])
    plan = Plan("there and back", "Туда и обратно", "mm")
    ends = integrate(plan, "∫", edges, heights, pole)
    areas = np.concatenate(([0.0], np.cumsum(np.diff(edges) * heights)))
    scale = np.abs(np.diff(edges) * heights).sum() + 1e-9
    np.testing.assert_allclose(ordinates(ends) * pole, areas, atol=1e-13 * scale)
    back = differentiate(plan, "d", ends, pole)
    # A chord's slope loses what the ends lose: an ulp of the ordinate over the width of the interval.
    loss = 1e-14 * (np.abs(ordinates(ends)).max() + 1) * pole / np.diff(edges).min() + 1e-12 * np.abs(heights).max()
    np.testing.assert_allclose(ordinates(back), heights, atol=loss + 1e-12)
    np.testing.assert_allclose([s.value.real for s in back], (edges[:-1] + edges[1:]) / 2, rtol=1e-12)


def test_a_straight_line_has_one_ray():
    plan = Plan("line", "Прямая", "mm")
    (slope,) = differentiate(plan, "", [0j, 240 + 60j], 40)
    assert slope.value == pytest.approx(120 + 10j, rel=1e-15)


def test_quadrature_against_forty_digits_with_a_jump():
    def f(x):
        return np.where(x < 2, np.exp(np.sin(x)), x**2)

    q = Quadrature(f, np.array([0.0, 2.0, 3.0]), panels=2)
    with mpmath.workdps(40):
        first = mpmath.quad(lambda x: mpmath.exp(mpmath.sin(x)), [0, 1, mpmath.mpf("1.7")])
        whole = mpmath.quad(lambda x: mpmath.exp(mpmath.sin(x)), [0, 1, 2]) + mpmath.mpf(19) / 3
    assert float(q(1.7)) == pytest.approx(float(first), rel=2e-15)
    assert q.total == pytest.approx(float(whole), rel=2e-15)
    assert q(np.array([[0.0, 3.0]])).shape == (1, 2)


def test_smooth_curve_passes_through_the_ends_with_the_integrand_as_slope():
    edges = np.array([0.0, 1.0, 3.0])
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 0.25])
    slope = cubic.deriv()(edges)
    x = np.linspace(0, 3, 31)
    np.testing.assert_allclose(smooth(edges, cubic(edges), slope[:-1], slope[1:], x), cubic(x), atol=1e-14)


def test_wrong_numbers_are_named():
    plan = Plan("x", "x", "mm")
    with pytest.raises(ValueError, match="3 borders need 2 ordinates, not 3"):
        integrate(plan, "", [0, 1, 2], [1, 2, 3], 10)
    with pytest.raises(ValueError, match="pole distance"):
        integrate(plan, "", [0, 1], [1], 0)
    with pytest.raises(ValueError, match="pole distance"):
        differentiate(plan, "", [0, 1], -1)


def test_protocol_says_every_move_in_millimetres():
    plan = Plan("work", "Работа", "mm")
    ends = integrate(plan, "", [0, 12.5, 25], [20.0, -8.0], 40)
    said = list(sentences(plan, 0, lambda mm: mm))
    assert len(said) == 2 + 4 * 2
    assert "40,0 мм" in said[0]
    assert "12,5 мм" in said[2]
    assert "20,0 мм" in said[2]
    assert said[5] == "Из точки 0 параллельно лучу P1′ проведём хорду до ординаты с абсциссой 12,5 мм: точка 1."
    assert ends[1].name == "1"
