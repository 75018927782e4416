"""Arithmetic of compass and ruler against exact fractions and 60-digit truth, up to tangency and near-parallel lines."""

from fractions import Fraction
from math import inf

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, strategies as st

from tmm_sheets.construction import arithmetic as ar

EPS = 2.0**-52
number = st.floats(1e-60, 1e60) | st.floats(-1e60, -1e-60)
coordinate = st.floats(1e-60, 1e3) | st.floats(-1e3, -1e-60) | st.just(0.0)
"""Not so small that what is made of it has fewer than 53 digits."""
point = st.builds(complex, coordinate, coordinate)
angle = st.floats(-np.pi, np.pi)
size = st.floats(-3, 3).map(lambda x: 10.0**x)
side = st.sampled_from((1, -1))


def exact(z):
    return mpmath.mpc(z.real, z.imag)


@pytest.fixture(autouse=True)
def _digits():
    with mpmath.workdps(60):
        yield


# --- error-free transformations --------------------------------------------------------------------------------------


@given(number, number)
def test_two_product_is_exact(a, b):
    p, e = ar.two_product(a, b)
    assert Fraction(p) + Fraction(e) == Fraction(a) * Fraction(b)
    assert p == a * b


@given(number, number, number, number)
def test_difference_of_products(a, b, c, d):
    true = Fraction(a) * Fraction(b) - Fraction(c) * Fraction(d)
    found = ar.difference_of_products(a, b, c, d)
    assert abs(Fraction(found) - true) <= 3 * Fraction(EPS) / 2 * abs(true)


@given(number, st.integers(-4, 4), st.integers(-4, 4))
def test_difference_of_products_that_nearly_cancel(a, i, j):
    """(a + i ulp)(a + j ulp) - a a: all digits of the plain difference are gone, here none."""
    u = np.spacing(abs(a))
    x, y = a + i * u, a + j * u
    true = Fraction(x) * Fraction(y) - Fraction(a) * Fraction(a)
    assert abs(Fraction(float(ar.difference_of_products(x, y, a, a))) - true) <= 2 * Fraction(EPS) * abs(true)


@given(point, point)
def test_cross_and_dot(u, v):
    cross = Fraction(u.real) * Fraction(v.imag) - Fraction(u.imag) * Fraction(v.real)
    dot = Fraction(u.real) * Fraction(v.real) + Fraction(u.imag) * Fraction(v.imag)
    # Products below the normal range keep what the format keeps.
    for found, true in ((ar.cross(u, v), cross), (ar.dot(u, v), dot)):
        assert abs(Fraction(float(found)) - true) <= 2 * Fraction(EPS) * abs(true) + Fraction(1e-300)


# --- two lines -------------------------------------------------------------------------------------------------------


def true_meeting(p, u, q, v):
    p, u, q, v = map(exact, (p, u, q, v))
    w = q - p
    return p + (w.real * v.imag - w.imag * v.real) / (u.real * v.imag - u.imag * v.real) * u


@given(point, angle, point, st.floats(0.1, 3.0))
def test_lines_meet(p, a, q, between):
    u, v = np.exp(1j * a), np.exp(1j * (a + between))
    true = true_meeting(p, u, q, v)
    assert abs(exact(complex(ar.line_line(p, u, q, v))) - true) <= 8 * EPS * (abs(true) + abs(p) + abs(q))


@given(angle, st.floats(-12, -1), size)
def test_nearly_parallel_lines_lose_nothing(a, power, far):
    """Seen from the point the line starts in, the distance to the intersection keeps all digits at every angle."""
    u, v = complex(np.exp(1j * a)), complex(np.exp(1j * (a + 10.0**power)))
    q = far * complex(np.exp(1j * (a + 1.3)))
    assume(u != v)
    true = true_meeting(0j, u, q, v)
    assert abs(exact(complex(ar.line_line(0j, u, q, v))) - true) <= 8 * EPS * abs(true)


@given(point, point, angle)
def test_parallel_lines_do_not_meet(p, q, a):
    u = np.exp(1j * a)
    assert np.isnan(ar.line_line(p, u, q, u))
    assert np.isnan(ar.line_line(p, u, q, -u))
    assert np.isnan(ar.line_line(p, u, q, 2 * u))


# --- two circles -----------------------------------------------------------------------------------------------------


def true_arcs(c1, r1, c2, r2, which):
    c1, c2, r1, r2 = exact(c1), exact(c2), mpmath.mpf(r1), mpmath.mpf(r2)
    e = c2 - c1
    d = abs(e)
    x = (d * d + r1 * r1 - r2 * r2) / (2 * d)
    y = mpmath.sqrt(r1 * r1 - x * x)
    return c1 + (x + 1j * which * y) * e / d


@given(point, size, angle, st.floats(0.3, 2.8), size, side)
def test_arcs_meet(c1, r1, a, open_angle, r2, which):
    # Two radii from the common point: the circles cut at the angle between them.
    meeting = c1 + r1 * np.exp(1j * a)
    c2 = complex(meeting + r2 * np.exp(1j * (a + which * open_angle)))
    assume(abs(c2 - c1) > 1e-3 * max(r1, r2))
    r2 = abs(meeting - c2)
    true = true_arcs(c1, r1, c2, r2, which)
    found = exact(complex(ar.arc_arc(c1, r1, c2, r2, which)))
    d = abs(c2 - c1)
    assert abs(found - true) <= 40 * EPS * (abs(c1) + abs(c2) + (r1 + r2) * max(1, max(r1, r2) / d))


@pytest.mark.parametrize("power", range(-15, -1))
@pytest.mark.parametrize("inside", [False, True])
def test_towards_tangency_no_more_is_lost_than_by_nature(power, inside):
    """Gap of 10**power: rounding of the distance alone moves the height by EPS / gap of it; that much and little more."""
    gap = 10.0**power
    r1, r2 = 0.75, 0.5
    d = abs(r1 - r2) * (1 + gap) if inside else (r1 + r2) * (1 - gap)
    found = ar.arc_arc(0j, r1, complex(d), r2, 1)
    true = true_arcs(0j, r1, complex(d), r2, 1)
    assert abs(found.imag - true.imag) <= 4 * EPS / max(gap, EPS) * abs(true.imag)
    assert abs(found.real - true.real) <= 4 * EPS


@given(st.integers(1, 2**20), st.integers(1, 2**20), side)
def test_touching_circles_have_their_point(m, n, which):
    """Whole lengths add up without rounding: the height is zero, not NaN: a dead position is found, not lost."""
    r1, r2 = float(m), float(n)
    for d in (r1 + r2, r1 - r2):
        if d:
            touching = ar.arc_arc(0j, r1, complex(d), r2, which)
            assert touching.imag == 0
            assert abs(touching.real - r1) <= 2 * EPS * (r1 + r2) * max(1, r2 / abs(d))


@given(size, size, st.floats(1.0001, 10))
def test_circles_apart_or_one_in_the_other(r1, r2, factor):
    with np.errstate(invalid="ignore"):
        assert np.isnan(ar.arc_arc(0j, r1, complex((r1 + r2) * factor), r2, 1))
        assume(abs(r1 - r2) > 1e-3 * r1)
        assert np.isnan(ar.arc_arc(0j, r1, complex(abs(r1 - r2) / factor), r2, 1))


@given(point, size, angle, st.floats(0.3, 2.8), size)
def test_sides_are_left_and_right(c1, r1, a, open_angle, r2):
    meeting = c1 + r1 * np.exp(1j * a)
    c2 = complex(meeting + r2 * np.exp(1j * (a + open_angle)))
    assume(abs(c2 - c1) > 1e-3 * max(r1, r2))
    left, right = (ar.arc_arc(c1, r1, c2, abs(meeting - c2), which) for which in (1, -1))
    assert ar.cross(c2 - c1, left - c1) > 0 > ar.cross(c2 - c1, right - c1)


# --- circle and line -------------------------------------------------------------------------------------------------


def true_arc_line(centre, radius, p, u, which):
    centre, p, u = exact(centre), exact(p), exact(u)
    w = p - centre
    along = w.real * u.real + w.imag * u.imag
    height = u.real * w.imag - u.imag * w.real
    return p - along * u + which * mpmath.sqrt(mpmath.mpf(radius) ** 2 - height**2) * u


@given(point, size, angle, st.floats(-0.95, 0.95), st.floats(-3, 3), side)
def test_arc_cuts_line(centre, radius, a, height, away, which):
    u = complex(np.exp(1j * a))
    p = complex(centre + radius * (1j * height + away) * u)
    found = exact(complex(ar.arc_line(centre, radius, p, u, which)))
    # The direction itself is a unit vector to rounding only: that moves the foot.
    assert abs(found - true_arc_line(centre, radius, p, u, which)) <= 30 * EPS * (abs(centre) + abs(p) + radius)
    assert abs(abs(found - exact(centre)) - radius) <= 30 * EPS * (abs(centre) + abs(p) + radius)


@given(size, angle, st.floats(1.0001, 10))
def test_line_past_the_circle(radius, a, factor):
    u = np.exp(1j * a)
    with np.errstate(invalid="ignore"):
        assert np.isnan(ar.arc_line(0j, radius, 1j * factor * radius * u, u, 1))


@pytest.mark.parametrize("which", [1, -1])
def test_side_of_a_line_is_further_along_it(which):
    assert ar.arc_line(1j, 2.0, 5 + 1j, 1 + 0j, which) == 2 * which + 1j
    assert ar.arc_line(1j, 2.0, 5 + 1j, -1 + 0j, which) == -2 * which + 1j
    assert ar.arc_line(0j, 2.0, 5 + 2j, 1 + 0j, which) == 2j


# --- tangents --------------------------------------------------------------------------------------------------------


@given(point, point, st.floats(0.01, 0.999), side)
def test_tangent(p, centre, share, which):
    d = abs(p - centre)
    assume(d > 1e-2)
    radius = share * d
    t = complex(ar.tangent_point(p, centre, radius, which))
    allowed = 8 * EPS * (abs(p) + abs(centre))
    assert abs(abs(t - centre) - radius) <= allowed
    # The radius to the point of contact is at right angles to the tangent.
    assert abs(ar.dot(t - centre, t - p)) <= allowed * d
    assert ar.cross(centre - p, t - p) * which > 0


def test_tangent_from_a_point_on_the_circle_and_inside():
    assert ar.tangent_point(2 + 0j, 0j, 2.0, 1) == 2
    with np.errstate(invalid="ignore"):
        assert np.isnan(ar.tangent_point(1 + 0j, 0j, 2.0, 1))


@pytest.mark.parametrize("power", range(-14, -1, 3))
def test_dead_tangent_of_a_pivot_close_to_the_crank_circle(power):
    """AC just longer than AB: the tangent shrinks to nothing, its length keeps the digits of the gap."""
    radius, d = 0.08, 0.08 * (1 + 10.0**power)
    t = ar.tangent_point(complex(0, -d), 0j, radius, 1)
    r, d = mpmath.mpf(radius), mpmath.mpf(d)
    assert abs(abs(t.real) - r * mpmath.sqrt((d - r) * (d + r)) / d) <= 4 * EPS * abs(t.real)


# --- lengths, feet, moments ------------------------------------------------------------------------------------------


@given(point, point)
def test_ray(p, q):
    assume(abs(q - p) > 1e-9)
    u = ar.ray(p, q)
    assert abs(abs(u) - 1) <= 2 * EPS
    assert abs(ar.cross(u, q - p)) <= 2 * EPS * abs(q - p)
    assert ar.along(p, u, abs(q - p)) == pytest.approx(q, rel=1e-14, abs=1e-12)


def test_no_ray_between_points_that_coincide():
    with np.errstate(invalid="ignore"):
        assert np.isnan(ar.ray(np.complex128(1 + 1j), np.complex128(1 + 1j)))


@given(point, point, angle)
def test_foot(p, q, a):
    u = complex(np.exp(1j * a))
    f = complex(ar.foot(p, q, u))
    allowed = 8 * EPS * (abs(p) + abs(q) + 1)
    assert abs(ar.cross(f - q, u)) <= allowed
    assert abs(ar.dot(p - f, u)) <= allowed


@given(point, point, point)
def test_moment_is_force_times_arm(about, at, force):
    assume(abs(force) > 1e-6)
    moment = (Fraction((at - about).real) * Fraction(force.imag) - Fraction((at - about).imag) * Fraction(force.real))
    found = ar.moment(about, at, force)
    assert abs(Fraction(float(found)) - moment) <= 3 * Fraction(EPS) * abs(moment) + Fraction(1e-300)
    assert ar.arm(about, at, force) * abs(force) == pytest.approx(found, rel=1e-14)


def test_counter_clockwise_is_positive():
    assert ar.moment(0j, 1 + 0j, 2j) == 2
    assert ar.arm(0j, 1 + 0j, 2j) == 1
    assert ar.turned(1 + 0j) == 1j
    assert ar.polar(1j, 2.0, np.pi / 2) == pytest.approx(3j)


# --- scalars and arrays ----------------------------------------------------------------------------------------------


def test_arrays_give_what_scalars_give():
    rng = np.random.default_rng(5)
    n = 50
    c1, c2, u, v = (rng.normal(size=n) + 1j * rng.normal(size=n) for _ in range(4))
    u, v = u / abs(u), v / abs(v)
    r1, r2 = rng.uniform(0.2, 2, (2, n))
    s = rng.choice((1, -1), n)
    calls = {
        ar.arc_arc: (c1, r1, c2, r2, s), ar.arc_line: (c1, r1, c2, u, s), ar.line_line: (c1, u, c2, v),
        ar.tangent_point: (c1, c2, r1, s), ar.foot: (c1, c2, u), ar.arm: (c1, c2, v), ar.polar: (c1, r1, r2), ar.ray: (c1, c2),
    }
    for function, args in calls.items():
        with np.errstate(invalid="ignore"):
            together = function(*args)
            alone = [function(*(a[k] for a in args)) for k in range(n)]
        np.testing.assert_allclose(together, alone, rtol=1e-14, err_msg=function.__name__)


def test_one_bad_position_leaves_the_others_alone():
    d = np.array([1.0, 5.0, 1.0])
    with np.errstate(invalid="ignore"):
        found = ar.arc_arc(0j, 1.0, d, 1.0, 1)
    assert np.isnan(found).tolist() == [False, True, False]
    assert found[0] == found[2] == ar.arc_arc(0j, 1.0, 1 + 0j, 1.0, 1)
    assert not np.isinf(ar.line_line(0j, np.array([1j, 1, 1j]), 1 + 0j, 1 + 0j)).any()
    assert inf not in np.abs(found)


# --- points far from the crossing ------------------------------------------------------------------------------------


@pytest.mark.parametrize("far", [1.0, 1e4, -1e8])
def test_a_guide_point_far_away_costs_nothing_but_its_direction(far):
    """Exact for a guide along an axis; along a slanted one only what rounding of its direction turns it by."""
    centre, radius = 0.3 + 0.1j, 0.7
    found = ar.arc_line(centre, radius, 0.2 + far * 1j, 1j, 1)
    assert abs(found - (0.2 + 1j * (0.1 + (0.49 - 0.01) ** 0.5))) < 2e-16
    u = complex(np.cos(0.7), np.sin(0.7))
    through = 0.05 + far * u
    lateral = mp_cross(u, through - 0j)
    found = ar.arc_line(centre, radius, through, u, 1)
    assert abs(abs(found - centre) - radius) < 3e-16
    assert abs(float(mp_cross(u, found) - lateral)) < 4e-16


@pytest.mark.parametrize("far", [1e4, -1e8])
def test_lines_with_points_far_away_cross_near_by(far):
    """The crossing is laid off from the nearer point, whichever of the two lines it is on."""
    p, u, v = 0.3 + 0.1j, np.exp(0.2j), np.exp(1.1j)
    q = 0.1 + far * v
    for found in (ar.line_line(p, u, q, v), ar.line_line(q, v, p, u)):
        assert abs(float(mp_cross(u, found - p))) < 2e-16
        assert abs(float(mp_cross(v, found) - mp_cross(v, q))) < 4e-16


def mp_cross(u, w):
    """Cross product in 50 digits of what the doubles are."""
    with mpmath.workdps(50):
        u, w = mpmath.mpmathify(complex(u)), mpmath.mpmathify(complex(w))
        return u.real * w.imag - u.imag * w.real


def test_a_sine_that_is_known_better_is_used():
    """The lines tell an angle of 2e-16; what they are taken from knows 1e-16."""
    u, v = 1 + 0j, complex(1, 2e-16)
    assert ar.line_line(0j, u, 1j, v).real == pytest.approx(-5e15)
    assert ar.line_line(0j, u, 1j, v, 1e-16).real == pytest.approx(-1e16)
