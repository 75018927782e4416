"""Rocker and flat follower going round the cam: closed forms, finished profiles measured back, envelopes against shapely."""

from math import pi

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st
from shapely import Polygon, intersection as meet

from tests.methods.cams.cam_cases import flat_data, rocker_data, told
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams.cam_profile import cam

ROCKERS = [{}, {"rotation": "opposite"}, {"limit": "both", "sense": "counter-clockwise"},
           {"limit": "both", "law": "trapezoid", "rotation": "opposite", "sense": "counter-clockwise", "parts": 6}]
FLATS = [{}, {"sense": "counter-clockwise"}, {"law": "sine", "base_radius": None, "rise": 90, "fall": 100, "stroke": 20},
         {"law": "linearly decreasing", "fall_law": "trapezoid", "base_radius": None}]


def polygon(points):
    return Polygon(np.column_stack((points.real, points.imag)) * 1e3)


def rocker(**changes):
    return cam(rocker_data(roller=None, **changes))


def closed_form(c, phi):
    """Centre profile z = (l0 + l e^{i(pi + s b)}) e^{-i phi}, A on the x axis, counter-clockwise cam; turned into our frame."""
    data, z = c.data, c.zone
    same = 1 if data.rotation == "same" else -1
    first = np.arccos((data.arm**2 + z.l0**2 - z.r0**2) / (2 * data.arm * z.l0))
    course = (z.l0 + data.arm * np.exp(1j * (pi + same * (first + c.law.s(phi))))) * np.exp(-1j * phi)
    if data.sense == "clockwise":
        course = course.conjugate()
    pivot = complex(z.plan["A"].value) - complex(z.apex.value)
    return course * pivot / abs(pivot)


@pytest.mark.parametrize("changes", ROCKERS)
def test_rocker_against_the_closed_form(changes):
    c = rocker(**changes)
    np.testing.assert_allclose(c.dense.centres.value, closed_form(c, c.dense.phi), rtol=0, atol=1e-13)
    inv = c.inversion
    np.testing.assert_allclose(inv.centres.value, closed_form(c, inv.phi), rtol=0, atol=1e-12)
    np.testing.assert_allclose(np.abs(inv.centres.value - inv.ends.value), c.data.arm, rtol=1e-12)
    np.testing.assert_allclose(np.abs(inv.ends.value), c.zone.l0, rtol=1e-12)


@pytest.mark.parametrize("changes", ROCKERS)
def test_normals_are_normals_of_the_centre_profile(changes):
    c = rocker(**changes)
    inv = c.at(np.linspace(0.01, 6.27, 313))
    h = 1e-6
    along = (closed_form(c, inv.phi + h) - closed_form(c, inv.phi - h)) / (2 * h)
    across = (along * inv.normals.value.conjugate()).real / np.abs(along)
    # Where the third derivative jumps the difference is off by its step.
    assert np.abs(across).max() < 2e-6


@pytest.mark.parametrize("changes", ROCKERS)
def test_curvature_against_differences(changes):
    c = rocker(**changes)
    h = 1e-4
    least = np.inf
    for p in c.law.phases:
        phi = np.linspace(p.start + 2 * h, p.end - 2 * h, 3001)
        jumps = [p.phi(j) for j in p.law.jumps]
        phi = phi[[all(abs(v - j) > 2 * h for j in jumps) for v in phi]]
        a, b, d = (closed_form(c, phi + k * h) for k in (-1, 0, 1))
        first, second = (d - a) / (2 * h), (a - 2 * b + d) / h**2
        bend = c.right * (first.conjugate() * second).imag / np.abs(first) ** 3
        least = min(least, 1 / bend.max())
    assert c.rho_min == pytest.approx(least, rel=2e-3)
    assert c.rho_min <= least * (1 + 1e-5)


@pytest.mark.parametrize("changes", ROCKERS[:3])
def test_finished_profile_swings_the_rocker_by_the_law(changes):
    """Turn the finished profile under the rocker: the roller that touches it gives the angle and the pressure angle back."""
    c = rocker(**changes)
    fine = c.at(c.law.divided(4096))
    profile = fine.plan["F"].value
    turn, arm, r = c.zone.cones.turn, c.data.arm, c.roller
    pivot = complex(c.zone.plan["A"].value) - complex(c.zone.apex.value)
    for phi in np.linspace(0.07, 6.2, 23):
        turned = profile * np.exp(-1j * c.right * phi)
        # Angles at which the roller's centre is at r from some point of the profile: the largest swing rests on it.
        away = turned - pivot
        d = np.abs(away)
        reach = np.abs(d - arm) < r
        half = np.arccos((arm**2 + d[reach] ** 2 - r**2) / (2 * arm * d[reach]))
        start = complex(-complex(c.zone.plan["A"].value))
        swings = turn * np.angle(away[reach] / start) + half
        k = int(np.argmax(swings))
        assert swings[k] == pytest.approx(float(c.law.s(phi)), abs=2e-7)
        centre = pivot + start * np.exp(1j * turn * swings[k])
        normal = turned[reach][k] - centre
        motion = 1j * turn * (centre - pivot)
        angle = c.right * np.angle(-motion / normal)
        assert angle == pytest.approx(float(c.at(np.array([phi])).angles.value[0]), abs=6e-3)


@pytest.mark.parametrize("changes", ROCKERS)
def test_profile_of_a_rocker_cam_against_the_buffer_of_shapely(changes):
    c = rocker(**changes)
    fine = c.at(c.law.divided(1024))
    mine, truth = polygon(fine.plan["F"].value), polygon(fine.centres.value).buffer(-c.roller * 1e3, quad_segs=64)
    assert mine.is_valid
    assert mine.exterior.hausdorff_distance(truth.exterior) < 5e-4
    assert mine.area == pytest.approx(truth.area, rel=1e-5)


def half_planes(c, n):
    """What all plates of sampled positions leave of the plane (shapely), mm, n positions a phase."""
    reach = 1000.0
    shape = Polygon([(-reach, -reach), (reach, -reach), (reach, reach), (-reach, reach)])
    phi = c.law.divided(n)
    for angle, s in zip(phi, np.asarray(c.law.s(phi)), strict=True):
        line = 1j * np.exp(1j * c.right * angle)
        foot, along = (c.r0 + s) * 1e3 * line, 1j * line
        far = 4 * reach
        corners = (foot + far * along, foot - far * along, foot - far * (along + line), foot + far * (along - line))
        shape = meet(shape, Polygon([(p.real, p.imag) for p in corners]))
    return shape


@pytest.mark.parametrize("changes", FLATS)
def test_flat_follower_touches_the_envelope_of_its_plates(changes):
    c = cam(flat_data(**changes))
    mine, truth = polygon(c.dense.plan["F"].value), half_planes(c, 128)
    assert mine.is_valid
    assert mine.is_simple
    # The plates are tangents: their polygon is circumscribed, ours inscribed; both differ by the sagitta of 2 pi/128.
    assert truth.buffer(1e-9).contains(mine)
    assert mine.exterior.hausdorff_distance(truth.exterior) < 0.05
    assert mine.area == pytest.approx(truth.area, rel=2e-3)
    # Convex: no point in the hull but its own.
    assert mine.convex_hull.area == pytest.approx(mine.area, rel=1e-9)


@pytest.mark.parametrize("changes", FLATS)
def test_finished_profile_lifts_the_flat_follower_by_the_law(changes):
    c = cam(flat_data(**changes))
    fine = c.at(c.law.divided(2048)).plan["F"].value
    for phi in np.linspace(0.05, 6.25, 41):
        turned = fine * np.exp(-1j * c.right * phi)
        k = int(np.argmax(turned.imag))
        assert turned[k].imag - c.r0 == pytest.approx(float(c.law.s(phi)), abs=3e-8)
        # The contact stands off by S'; flat there: a sample of the profile is near it only.
        assert turned[k].real == pytest.approx(-c.right * float(c.law.ds(phi)), abs=6e-4)
    reach = fine * np.exp(-1j * c.right * c.law.divided(2048))
    sides = sorted((-c.right * reach.real.max(), -c.right * reach.real.min()))
    assert (max(sides), -min(sides)) == pytest.approx((c.plate.l1, c.plate.l2), rel=1e-6)


def test_flat_follower_has_no_pressure_angle():
    c = cam(flat_data())
    assert np.abs(c.dense.angles.value).max() < 1e-13
    r = told(c)
    assert {"r0", "r_min", "l1", "l2", "rho_min"} < set(r)
    assert "r_roller" not in r
    np.testing.assert_allclose(np.hypot(*np.array(r["pitch_curve"]).T), c.r0 + np.array(r["s"]), rtol=1e-12)


def test_results_of_a_rocker():
    r = told(cam(rocker_data()))
    assert {"r0", "l0", "least", "r_roller", "rho_min"} < set(r)
    assert "e" not in r
    assert r["pressure_angle"][0] == pytest.approx(-pi / 4, abs=1e-12)


def test_protocol_of_the_inversions():
    said = list(sentences(cam(rocker_data()).inversion.plan, 3, lambda m: m / 1e-3))
    assert any("обратную вращению кулачка" in s and "30,0°" in s for s in said)
    flat_said = list(sentences(cam(flat_data()).inversion.plan, 3, lambda m: m / 1e-3))
    assert any("плоскость тарелки" in s for s in flat_said)
    assert not any("{" in s or "nan" in s for s in said + flat_said)
    assert cam(rocker_data()).inversion.plan.check() is None


@given(st.floats(40, 170), st.floats(0, 40), st.floats(40, 120), st.floats(5, 50), st.floats(25, 60), st.booleans(), st.booleans(),
       st.sampled_from(["rise", "both"]), st.sampled_from(["sine", "cosine", "constant", "trapezoid", "linearly decreasing"]),
       st.one_of(st.none(), st.floats(1, 40)))
def test_any_rocker_cam_is_right_or_refused(rise, dwell, fall, swing, angle, same, clockwise, limit, law, roller):
    data = rocker_data(rise=rise, upper_dwell=dwell, fall=fall, swing=swing, pressure_angle=angle, limit=limit, law=law,
                       roller=roller, rotation="same" if same else "opposite",
                       sense="clockwise" if clockwise else "counter-clockwise")
    c = cam(data)
    try:
        zone = c.zone
    except CannotBuild:
        return
    if data.roller is not None and data.roller >= c.largest_roller:
        with pytest.raises(CannotBuild, match=r"less than .* mm"):
            told(c)
        return
    assert zone.r0 > 0
    assert polygon(c.dense.plan["F"].value).is_valid
    np.testing.assert_allclose(c.dense.centres.value, closed_form(c, c.dense.phi), rtol=0, atol=1e-9 * zone.l0)


@given(st.floats(30, 170), st.floats(0, 40), st.floats(30, 120), st.floats(2, 80), st.booleans(),
       st.sampled_from(["sine", "cosine", "constant", "trapezoid", "linearly decreasing"]), st.one_of(st.none(), st.floats(5, 300)))
def test_any_flat_cam_is_convex_or_refused(rise, dwell, fall, stroke, clockwise, law, radius):
    data = flat_data(rise=rise, upper_dwell=dwell, fall=fall, stroke=stroke, law=law, base_radius=radius,
                     sense="clockwise" if clockwise else "counter-clockwise")
    c = cam(data)
    least = -min(float((q.s(x) + q.dds(x)).min()) for q in c.law.phases for x in [np.linspace(1e-12, 1 - 1e-12, 4001)])
    if radius is not None and data.base_radius <= least:
        with pytest.raises(CannotBuild, match="cusp"):
            _ = c.plate
        return
    assume(radius is None or data.base_radius > least * (1 + 1e-5))
    p = c.plate
    assert c.rho_min > 0
    assert p.r0 > p.r_min
    shape = polygon(c.dense.plan["F"].value)
    assert shape.is_valid
    assert shape.convex_hull.area == pytest.approx(shape.area, rel=1e-9)
