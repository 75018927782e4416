"""Main dimensions, inversion, roller and envelope of the cam against mpmath, brute force, closed forms and shapely."""

import csv
from dataclasses import FrozenInstanceError
from math import atan2, degrees, hypot, pi, radians, tan
from pathlib import Path

import mpmath
import numpy as np
import pytest
from hypothesis import given, strategies as st
from shapely import Polygon

from tests.methods.cams.cam_cases import cam_data, centre_profile, sine_motion, told
from tmm_sheets import catalogue
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.methods.cams.cam_profile import cam
from tmm_sheets.task import edited_text, variant

MANUAL = Path(__file__).parents[2] / "manuals" / "cam_example_1.csv"
VARIANTS = [{}, {"sense": "counter-clockwise"}, {"limit": "both"}, {"law": "cosine"}, {"law": "constant", "limit": "both"},
            {"upper_dwell": 0, "roller": None}, {"rise": 60, "fall": 150, "stroke": 25, "limit": "both", "roller": None}]


def polygon(points):
    return Polygon(np.column_stack((points.real, points.imag)) * 1e3)


def dense_angles(n=4001):
    return np.linspace(0, 2 * pi, n)


# --- main dimensions


def test_main_dimensions_of_the_example():
    z = cam(cam_data()).zone
    assert [1e3 * v for v in (z.e, z.s0, z.r0)] == pytest.approx([4.43232, 7.67701, 8.86465], abs=5e-6)


def test_main_dimensions_against_mpmath():
    """The touching point by 40 digits: S'' = S' tan(alpha) on the sine law."""
    mpmath.mp.dps = 40
    rise, stroke, slope = mpmath.radians(100), mpmath.mpf(10), mpmath.tan(mpmath.radians(30))
    t = mpmath.findroot(lambda t: 2 * mpmath.pi / rise * mpmath.sin(t) - slope * (1 - mpmath.cos(t)), 2.8)
    height = stroke / rise * (1 - mpmath.cos(t)) - slope * stroke * (t - mpmath.sin(t)) / (2 * mpmath.pi)
    e = height / 2
    s0 = e / slope
    z = cam(cam_data()).zone
    assert z.e * 1e3 == pytest.approx(float(e), rel=1e-13)
    assert z.s0 * 1e3 == pytest.approx(float(s0), rel=1e-13)
    assert z.r0 * 1e3 == pytest.approx(float(mpmath.hypot(e, s0)), rel=1e-13)


def test_right_triangle_of_the_manual():
    z = cam(cam_data()).zone
    assert z.e == pytest.approx(z.s0 * tan(radians(30)), rel=1e-14)
    assert hypot(z.e, z.s0) == pytest.approx(z.r0, rel=1e-14)


def highest(g, lo, hi):
    """Maximum by looking: a grid, then a finer one round its highest point, until doubles run out."""
    for _ in range(6):
        x = np.linspace(lo, hi, 2001)
        k = int(np.argmax(g(x)))
        lo, hi = x[max(k - 1, 0)], x[min(k + 1, 2000)]
    return float(g(x).max())


@pytest.mark.parametrize("changes", VARIANTS)
def test_apex_against_brute_force(changes):
    """The least cam: the limit is met in every position and reached on both sides."""
    data = cam_data(**changes)
    c = cam(data)
    down = data.rise + data.upper_dwell
    limited = [(0.0, data.rise)] + ([(down, down + data.fall)] if data.limit == "both" else [])
    slope = tan(data.pressure_angle)
    one, other = (max(highest(lambda p, side=side: side * c.law.ds(p) - c.law.s(p) * slope, *ends) for ends in limited)
                  for side in (1, -1))
    assert c.zone.e == pytest.approx((one - other) / 2, abs=1e-13 * data.stroke)
    assert c.zone.s0 == pytest.approx((one + other) / 2 / slope, rel=1e-13)


def test_side_of_the_offset():
    """Velocity of the rising follower turned by 90 degrees with the cam: to the right for a clockwise cam."""
    right, left = cam(cam_data()), cam(cam_data(sense="counter-clockwise"))
    assert complex(right.zone.apex.value).real > 0 > complex(left.zone.apex.value).real
    np.testing.assert_allclose(left.dense.plan["F"].value, -right.dense.plan["F"].value.conjugate(), atol=1e-17)
    np.testing.assert_allclose(left.dense.angles.value, right.dense.angles.value, atol=1e-14)


def test_printed_offset():
    with MANUAL.open(encoding="utf-8") as f:
        rows = {r["symbol"]: r for r in csv.DictReader(line for line in f if not line.startswith("#"))}
    c = cam(cam_data())
    measured = {"e": c.zone.e, "S0": c.zone.s0, "r0": c.zone.r0, "rho_min": c.rho_min, "r_p": c.roller}
    compared = [name for name in measured if rows[name]["tolerance"]]
    assert compared == ["e", "r_p"]
    for name in compared:
        assert measured[name] * 1e3 == pytest.approx(float(rows[name]["printed"]), abs=float(rows[name]["tolerance"]) + 1e-12)


# --- inversion


@pytest.mark.parametrize("sense", ["clockwise", "counter-clockwise"])
def test_inversion_against_the_closed_form(sense):
    data = cam_data(sense=sense)
    c = cam(data)
    phi = c.law.positions
    s, ds, _ = sine_motion(data, np.minimum(phi, data.rise + data.upper_dwell + data.fall))
    truth = centre_profile(phi, s, c.zone.s0, c.zone.e, c.right)
    np.testing.assert_allclose(c.inversion.centres.value, truth, atol=1e-14 * c.zone.r0 * 4)
    np.testing.assert_allclose(np.tan(c.inversion.angles.value), (ds - c.zone.e) / (c.zone.s0 + s), atol=1e-12)


def test_follower_lines_touch_the_circle_e():
    c = cam(cam_data())
    feet, lines = c.inversion.feet.value, c.inversion.lines.value
    np.testing.assert_allclose(np.abs(feet), c.zone.e, rtol=1e-14)
    np.testing.assert_allclose((feet.conj() * lines).real, 0, atol=1e-16)
    offsets = (c.inversion.centres.value.conj() * lines).imag
    np.testing.assert_allclose(np.abs(offsets), c.zone.e, rtol=1e-12)


def test_dwells_are_arcs_about_the_axis():
    c = cam(cam_data())
    radii = np.abs(c.dense.centres.value)
    at = c.dense.phi
    upper = (at >= c.data.rise) & (at <= c.data.rise + c.data.upper_dwell)
    np.testing.assert_allclose(radii[upper], hypot(c.zone.s0 + c.data.stroke, c.zone.e), rtol=1e-13)
    np.testing.assert_allclose(radii[at >= c.law.fall.end], c.zone.r0, rtol=1e-13)


# --- roller and profile


def numeric_curvature(c, phi, h=3e-5):
    """Curvature of the closed-form centre profile by differences of fourth order."""
    def at(p):
        return centre_profile(p, c.law.s(p), c.zone.s0, c.zone.e, c.right)

    d1 = (8 * (at(phi + h) - at(phi - h)) - (at(phi + 2 * h) - at(phi - 2 * h))) / (12 * h)
    d2 = (16 * (at(phi + h) + at(phi - h)) - (at(phi + 2 * h) + at(phi - 2 * h)) - 30 * at(phi)) / (12 * h**2)
    return c.right * (d1.conj() * d2).imag / np.abs(d1) ** 3


@pytest.mark.parametrize("changes", [{}, {"limit": "both"}, {"sense": "counter-clockwise"}, {"rise": 160, "fall": 140}])
def test_smallest_radius_of_curvature(changes):
    c = cam(cam_data(**changes))
    phi = np.linspace(0.01, 2 * pi - 0.01, 40001)
    # The differences reach over the ends of the phases, where the third derivative jumps.
    assert c.rho_min == pytest.approx(1 / numeric_curvature(c, phi).max(), rel=5e-6)
    # The circle through three points of that place, drawn, is a little larger: the neighbours are flatter. On a dwell it is the
    # same but for rounding: the points lie 1 degree apart, their perpendiculars cross at as much.
    assert c.rho_min * (1 - 1e-11) <= float(c.inversion.plan["ρ_min"].value) <= 1.02 * c.rho_min


def test_three_points_stand_closer_where_curvature_changes_steeply():
    """Fall and rise meet in the sharpest point: the usual three, 5.6 degrees apart and beside it, gave 33.7 for 27.7 mm."""
    c = cam(cam_data(rise=180, upper_dwell=0, fall=180, stroke=40, limit="both", roller=None))
    assert c.sharpest.phi == pytest.approx(0.0, abs=1e-9)
    assert np.degrees(c.three - np.pi) % 360 == pytest.approx([180 - 2.8125, 180.0, 180 + 2.8125])
    assert 1.0 < float(c.inversion.plan["ρ_min"].value) / c.rho_min < 1.05


def test_three_points_lie_on_their_circle():
    plan = cam(cam_data()).inversion.plan
    radii = [abs(plan[f"{n}_ρ"].value - plan["M"].value) for n in "EDG"]
    assert radii == pytest.approx([radii[0]] * 3, rel=1e-11)


@pytest.mark.parametrize("changes", VARIANTS)
def test_profile_keeps_the_distance_of_the_roller(changes):
    """Every point of the profile is at r_p from the nearest centre of the roller, over 20000 centres in closed form."""
    c = cam(cam_data(**changes))
    phi = dense_angles(20001)
    course = centre_profile(phi, c.law.s(phi), c.zone.s0, c.zone.e, c.right)
    for p in c.dense.plan["F"].value[::9]:
        nearest = np.abs(course - p).min()
        # Between two of the 20000 centres the distance differs by their squared spacing at most.
        assert c.roller * (1 - 1e-9) < nearest < c.roller + np.abs(np.diff(course)).max() ** 2 / c.roller


@pytest.mark.parametrize("changes", [{}, {"limit": "both", "sense": "counter-clockwise"}])
def test_profile_against_the_buffer_of_shapely(changes):
    c = cam(cam_data(**changes))
    fine = c.at(c.law.divided(1024))
    mine, truth = polygon(fine.plan["F"].value), polygon(fine.centres.value).buffer(-c.roller * 1e3, quad_segs=64)
    assert mine.is_valid
    # Floor of the buffer 1.5e-5 mm, and the sagitta of 4000 chords.
    assert mine.exterior.hausdorff_distance(truth.exterior) < 6e-5
    assert mine.area == pytest.approx(truth.area, abs=2e-3)


def lifted(profile, x, radius):
    """Height of the centre of a roller on the line ``x`` that rests on the profile from above, and where it touches."""
    reach = radius**2 - (profile.real - x) ** 2
    over = reach > 0
    height = profile.imag[over] + np.sqrt(reach[over])
    k = int(np.argmax(height))
    return height[k], profile[over][k]


def test_finished_profile_moves_the_follower_by_the_law():
    """Turn the finished profile under a roller: displacement and pressure angle come back."""
    c = cam(cam_data())
    fine = c.at(c.law.divided(8192)).plan["F"].value
    x = -c.right * c.zone.e
    for phi in np.linspace(0.05, 6.2, 40):
        height, contact = lifted(fine * np.exp(-1j * c.right * phi), x, c.roller)
        assert height - c.zone.s0 == pytest.approx(float(c.law.s(phi)), abs=1e-9)
        normal = complex(x, height) - contact
        angle = c.right * atan2(normal.real, normal.imag)
        assert angle == pytest.approx(float(c.at(np.array([phi])).angles.value[0]), abs=2e-3)


def test_pressure_angle_measured_from_the_profile():
    """Normal of the profile by differences along it, against the line of the follower: within 30 degrees on the rise."""
    c = cam(cam_data())
    h = 1e-5
    phi = np.linspace(h, c.data.rise - h, 2001)
    profile = [c.at(p).plan["F"].value for p in (phi - h, phi + h)]
    normal = -1j * c.right * (profile[1] - profile[0])
    line = 1j * np.exp(1j * c.right * phi)
    measured = c.right * np.angle(line / normal)
    s, ds, _ = sine_motion(c.data, phi)
    np.testing.assert_allclose(measured, np.arctan((ds - c.zone.e) / (c.zone.s0 + s)), atol=1e-7)
    assert np.degrees(np.abs(measured)).max() <= 30 + 1e-5
    assert np.degrees(measured).max() > 29.999


def test_pressure_angle_of_the_results():
    c = cam(cam_data())
    r = told(c)
    phi, angle = np.array(r["phi"]), np.array(r["pressure_angle"])
    rise = phi <= c.data.rise
    assert np.degrees(np.abs(angle[rise])).max() <= 30 * (1 + 1e-14)
    # Only the rise is limited: force closure carries the fall.
    assert np.degrees(angle).min() == pytest.approx(-60.8, abs=0.05)


def test_roller_by_both_rules():
    c = cam(cam_data(roller=None))
    rules = c.roller_rules
    assert rules[0].limits == pytest.approx((0.3 * c.zone.r0, 0.4 * c.zone.r0))
    assert rules[1].limits == pytest.approx((0.7 * c.rho_min, 0.8 * c.rho_min))
    assert c.roller * 1e3 == 3.5
    assert cam(cam_data(roller=None, stroke=1)).roller * 1e3 == pytest.approx(0.3)


def test_share_of_the_curvature_of_manual_003():
    c = cam(cam_data(roller=None, eccentricity=6, limit="both", curvature_share=0.5))
    assert c.roller_rules[1].limits == pytest.approx((0.5 * c.rho_min,) * 2)
    assert c.roller <= min(0.5 * c.rho_min, 0.4 * c.zone.r0)
    assert c.roller < cam(cam_data(roller=None, eccentricity=6, limit="both")).roller


def test_largest_roller_is_where_the_profile_breaks():
    c = cam(cam_data())
    below, above = (cam(cam_data(roller=c.largest_roller * 1e3 * f)) for f in (0.999, 1.02))
    assert polygon(below.dense.plan["F"].value).is_valid
    with pytest.raises(CannotBuild, match=r"roller of radius 7\.04\d* mm .* less than 6\.906 mm"):
        told(above)
    # The profile that is refused does cut itself.
    fine = c.at(c.law.divided(512))
    b, n = fine.centres.value, fine.normals.value
    assert not polygon(b + above.data.roller * n).is_valid


def test_roller_limited_by_another_part_of_the_profile():
    """A deep, narrow cam: the circle inside that touches two parts is smaller than every radius of curvature."""
    c = cam(cam_data(rise=30, upper_dwell=0, fall=30, stroke=40, pressure_angle=60, roller=None))
    assert c.largest_roller <= c.rho_min
    assert polygon(c.dense.plan["F"].value).is_valid


# --- results, protocol, bad input


def test_results_have_the_keys_of_the_interface():
    r = told(cam(cam_data()))
    assert list(r) == ["phi", "s", "ds", "dds", "r0", "e", "s0", "r_roller", "rho_min", "pressure_angle", "pitch_curve", "profile"]
    n = len(r["phi"])
    assert all(len(r[k]) == n for k in ("s", "ds", "dds", "pressure_angle", "pitch_curve", "profile"))
    few = told(cam(cam_data()), np.radians([0, 50, 170]))
    assert few["s"] == pytest.approx([0, 0.005, 0.005], abs=1e-15)
    for p, q in zip(few["pitch_curve"], few["profile"], strict=True):
        assert hypot(p[0] - q[0], p[1] - q[1]) == pytest.approx(0.0035, rel=1e-12)


def test_sections_come_one_by_one():
    c = cam(cam_data())
    assert c.zone.r0 > 0
    assert "inversion" not in vars(c)
    assert "_course" not in vars(c)
    with pytest.raises(FrozenInstanceError):
        c.law = None


def test_protocol_says_lengths_in_millimetres():
    c = cam(cam_data())
    said = list(sentences(c.zone.plan, 4, lambda m: m / 1e-4))
    assert any("S_0 = 76,8 мм" in s for s in said)
    assert any("угл" in s and "30,0°" in s for s in said)
    profile = list(sentences(c.inversion.plan, 4, lambda m: m / 1e-4))
    assert any("отложим угол 50,0°" in s for s in profile)
    assert not any("{" in s or "nan" in s for s in said + profile)
    assert (c.inversion.plan.name, c.dense.plan.name) == ("cam-profile", "cam-profile-between")
    assert c.zone.plan.check() is None
    assert c.inversion.plan.check() is None


@pytest.mark.parametrize(("key", "value", "said"), [
    ("pressure_angle", "0 deg", "between 0 and 90 deg"), ("pressure_angle", "90 deg", "between 0 and 90 deg"),
    ("rise", "0 deg", "greater than 0 deg"), ("fall", "-5 deg", "from 0 to 360"), ("upper_dwell", "-1 deg", "from 0 to 360"),
    ("rise", "260 deg", "360 deg together"), ("stroke", "0 mm", "greater than zero"), ("stroke", "nan mm", "expected a length"),
    ("roller", "0 mm", "greater than zero"), ("law", "wrong", '"sine"'), ("follower", "wrong", "translating roller"),
    ("stroke", None, "needs it"), ("rise", "nan deg", "expected an angle")])
def test_what_no_cam_can_have_the_reader_of_files_refuses(key, value, said):
    """The synthesis may rely on it: it looks at none of this again."""
    with pytest.raises(BadInput, match=said) as refused:
        variant.parse(edited_text.changed(catalogue.read("lugansk/shaper").text, {f"cam.{key}": value}), "own.toml")
    assert any(problem.field.partition(".")[0] == "cam" for problem in refused.value.problems)


@given(st.floats(25, 170), st.floats(0, 60), st.floats(25, 125), st.floats(2, 80), st.floats(15, 60),
       st.sampled_from(["rise", "both"]), st.sampled_from(["clockwise", "counter-clockwise"]),
       st.sampled_from(["sine", "cosine", "constant"]), st.one_of(st.none(), st.floats(1, 30)))
def test_any_cam_is_right_or_refused(rise, dwell, fall, stroke, angle, limit, sense, law, roller):
    data = cam_data(rise=rise, upper_dwell=dwell, fall=fall, stroke=stroke, pressure_angle=angle, limit=limit, sense=sense,
                    law=law, roller=roller)
    c = cam(data)
    phi = c.law.divided(64)
    slope = tan(data.pressure_angle)
    limited = phi < data.rise
    if limit == "both":
        limited |= (phi >= data.rise + data.upper_dwell) & (phi < data.rise + data.upper_dwell + data.fall)
    s, ds = c.law.s(phi[limited]), c.law.ds(phi[limited])
    assert (np.abs(ds - c.zone.e) <= slope * (c.zone.s0 + s) * (1 + 1e-12) + 1e-15).all()
    if data.roller is not None and data.roller >= c.largest_roller:
        with pytest.raises(CannotBuild, match=r"less than .* mm"):
            told(c)
        return
    profile = c.dense.plan["F"].value
    assert c.roller < c.largest_roller
    assert polygon(profile).is_valid
    np.testing.assert_allclose(np.abs(profile - c.dense.centres.value), c.roller, rtol=1e-9)
    assert degrees(abs(c.dense.angles.value[limited_index(c)]).max()) <= angle * (1 + 1e-9)


def limited_index(c):
    """Where the pressure angle of the dense inversion is limited."""
    at = c.dense.phi < c.data.rise
    if c.data.limit == "both":
        at |= (c.dense.phi >= c.law.fall.start) & (c.dense.phi < c.law.fall.end)
    return at
