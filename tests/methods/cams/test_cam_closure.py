"""Spring checked over the whole motion against closed forms and sampling; second disc at a constant distance."""

from math import pi, radians

import numpy as np
import pytest
from hypothesis import given, strategies as st
from shapely import Polygon

from tests.methods.cams.cam_cases import cam_data, flat_data, rocker_data, told
from tmm_sheets.methods.cams.cam_profile import cam


def sprung(**changes):
    return cam(cam_data(**{"law": "constant", "roller": None, "speed": 300, "follower_mass": 0.5} | changes))


@pytest.mark.parametrize(("factor", "preload", "worst", "closed"), [(1.75, 0.30, 1.1375, True), (1.5, 0.20, 0.90, False)])
def test_worst_ratio_of_constant_acceleration(factor, preload, worst, closed):
    """The peak acts at half lift already: 1.75 (0.30 + 0.35) and 1.5 (0.20 + 0.40)."""
    spring = sprung(spring_factor=factor, preload=preload).spring
    assert spring.worst == pytest.approx(worst, rel=1e-11)
    assert spring.closed is closed
    # In the middle of the fall, the steeper phase: that of the largest force.
    assert spring.worst_phi == pytest.approx(radians(170), abs=1e-9)
    assert sprung(spring_factor=spring.needed_factor, preload=preload).spring.worst == pytest.approx(1, rel=1e-11)


def test_spring_in_closed_form():
    spring = sprung().spring
    omega = 300 * pi / 30
    inertia = 0.5 * omega**2 * 4 * 0.01 / radians(70) ** 2
    assert spring.largest_inertia == pytest.approx(inertia, rel=1e-12)
    assert float(spring.plan["F_max"].value) == pytest.approx(1.75 * inertia, rel=1e-12)
    assert spring.f_0 == pytest.approx(0.3 * 1.75 * inertia, rel=1e-12)
    assert spring.rate == pytest.approx(0.7 * 1.75 * inertia / 0.01, rel=1e-12)
    assert spring.force(0.01) == pytest.approx(float(spring.plan["F_max"].value), rel=1e-12)


def test_spring_of_a_rocker_acts_at_its_roller():
    c = cam(rocker_data(speed=150, follower_inertia=0.06, rise=60, upper_dwell=30, fall=60, swing=20, arm=100, pressure_angle=30,
                        roller=None))
    omega = 150 * pi / 30
    largest = radians(20) / radians(60) ** 2 * pi**2 / 2
    assert c.spring.largest_inertia * 0.1 == pytest.approx(0.06 * omega**2 * largest, rel=1e-11)
    assert c.spring.way == pytest.approx(0.1 * radians(20), rel=1e-14)
    # Cosine: the peak is at the top, where the spring is strongest.
    assert c.spring.worst == pytest.approx(1.75, rel=1e-10)


@given(st.floats(40, 170), st.floats(40, 120), st.sampled_from(["sine", "cosine", "constant", "trapezoid", "linearly decreasing"]),
       st.floats(1, 3), st.floats(0.05, 0.9))
def test_worst_ratio_against_sampling(rise, fall, law, factor, preload):
    c = sprung(rise=rise, upper_dwell=20, fall=fall, law=law, spring_factor=factor, preload=preload)
    spring = c.spring
    phi = np.linspace(0, 2 * pi, 20011)
    dds = c.law.dds(phi)
    on = dds < -1e-6 * np.abs(dds).max()
    ratio = spring.force(c.law.s(phi[on])) / (0.5 * spring.speed**2 * -dds[on])
    assert spring.worst == pytest.approx(ratio.min(), rel=2e-3)
    assert spring.worst <= ratio.min() * (1 + 1e-9)
    at = float(c.law.s(spring.worst_phi))
    assert 0 <= at <= 0.01


@pytest.mark.parametrize("data", [
    cam_data(), cam_data(speed=300), cam_data(follower_mass=0.5), flat_data(),
    cam_data(speed=300, follower_mass=0.5, closure="geometric", limit="both", roller=None)])
def test_no_spring_without_its_numbers(data):
    c = cam(data)
    assert c.spring is None
    assert "spring" not in c.traits


def test_spring_of_a_flat_follower_in_the_results():
    r = told(cam(flat_data(speed=200, follower_mass=0.4)))
    assert set(r["spring"]) == {"largest_inertia", "F_max", "F_0", "stiffness", "way", "worst_ratio", "worst_phi", "closed"}
    assert r["spring"]["worst_ratio"] == pytest.approx(1.1375, rel=1e-11)


# --- second disc

TWO = {"limit": "both", "closure": "geometric", "roller": None}
DISCS = [cam_data(**TWO), cam_data(**TWO, eccentricity=6, sense="counter-clockwise", law="trapezoid"), rocker_data(**TWO),
         rocker_data(**TWO, rotation="opposite", sense="counter-clockwise", law="constant"),
         rocker_data(**TWO, rotation="opposite")]


def distance(p, closed):
    """Distance of every point from a closed polyline of points, by brute force over its segments."""
    a, b = closed[:-1], closed[1:]
    u = b - a
    ok = np.abs(u) > 0
    a, u = a[ok], u[ok]
    t = np.clip(((p[:, None] - a) * u.conjugate()).real / np.abs(u) ** 2, 0, 1)
    return np.abs(p[:, None] - a - t * u).min(axis=1)


@pytest.mark.parametrize("data", DISCS)
def test_rollers_keep_their_distance_and_touch_both_discs(data):
    c = cam(data)
    inv = c.dense
    first, second = inv.centres.value, inv.plan["B′"].value
    gap = np.abs(second - first)
    np.testing.assert_allclose(gap, gap[0], rtol=1e-12)
    # Each disc is touched by its roller in every position at once: one rigid follower, two finished profiles.
    some = np.arange(0, len(first), 13)
    for centres, profile in ((first, inv.plan["F"].value), (second, inv.plan["F′"].value)):
        np.testing.assert_allclose(distance(centres[some], profile), c.roller, rtol=2e-4)
        assert Polygon(np.column_stack((profile.real, profile.imag)) * 1e3).is_valid


@pytest.mark.parametrize("data", DISCS)
def test_both_discs_have_the_same_least_radius(data):
    c = cam(data)
    radii = [np.abs(c.dense.centres.value), np.abs(c.dense.plan["B′"].value)]
    # The second roller stands highest over O when the first is lowest.
    assert radii[1].min() == pytest.approx(radii[0].min(), rel=1e-9)
    assert radii[1].max() == pytest.approx(radii[0].max(), rel=1e-9)


@pytest.mark.parametrize("data", DISCS)
def test_second_disc_keeps_the_pressure_angle(data):
    """Even laws and both phases limited: what holds at S holds at S_max - S."""
    c = cam(data)
    inv = c.dense
    second, normals = inv.plan["B′"].value, inv.plan["N′"].value
    h = 1
    along = np.roll(second, -h) - np.roll(second, h)
    smooth = np.abs(along) > 1e-9
    across = (along * normals.conjugate()).real / np.maximum(np.abs(along), 1e-12)
    assert np.median(np.abs(across[smooth])) < 1e-3
    line = inv.lines.value if data.arm is None else None
    if line is not None:
        angle = np.arccos(np.clip((normals * line.conjugate()).real, -1, 1))
        limited = (inv.phi <= data.rise) | ((inv.phi >= c.law.fall.start) & (inv.phi <= c.law.fall.end))
        assert angle[limited].max() <= data.pressure_angle + 1e-9


def test_results_of_two_discs():
    c = cam(DISCS[0])
    r = told(c)
    assert set(r["second_disc"]) == {"pitch_curve", "profile"}
    assert r["roller_distance"] == pytest.approx(2 * c.zone.s0 + 0.01, rel=1e-14)
    assert "arm_angle" in told(cam(DISCS[2]))
