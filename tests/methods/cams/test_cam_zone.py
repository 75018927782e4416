"""Main dimensions against the formulas of the pressure angle, brute force with half-planes, and the manuals' values."""

import csv
from math import atan, cos, degrees, hypot, pi, radians, sin, tan
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st
from shapely import Point, Polygon, box, intersection as meet

from tests.few import few
from tests.methods.cams.cam_cases import cam_data, flat_data, rocker_data, told
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams.cam_profile import cam

MANUAL = Path(__file__).parents[2] / "manuals" / "cam_values.csv"
PRESS = {"rise": 60, "upper_dwell": 30, "fall": 60, "swing": 20, "arm": 100, "pressure_angle": 30, "roller": None, "parts": 6}


def values(case):
    with MANUAL.open(encoding="utf-8") as f:
        return {r["quantity"]: r for r in csv.DictReader(line for line in f if not line.startswith("#")) if r["case"] == case}


CASES = {
    "000 ex. 2": rocker_data(),
    "002 same rise": rocker_data(**PRESS),
    "002 opposite rise": rocker_data(**PRESS, rotation="opposite"),
    "002 same both": rocker_data(**PRESS, limit="both"),
}


@pytest.mark.parametrize("case", CASES)
def test_rockers_of_the_manuals(case):
    z, truth = cam(CASES[case]).zone, values(case)
    for name, value in (("r0", z.r0), ("l0", z.l0)):
        assert value * 1e3 == pytest.approx(float(truth[name]["exact"]), abs=0.6 * 10.0 ** -len(truth[name]["exact"].split(".")[1]))
        if truth[name]["tolerance"]:
            assert value * 1e3 == pytest.approx(float(truth[name]["printed"]), abs=float(truth[name]["tolerance"]))


def test_least_rocker_cam_is_not_in_the_vertex():
    truth = values("000 ex. 2")
    at_vertex = told(cam(rocker_data()), np.zeros(1))["least"]
    z = cam(rocker_data(centre="least")).zone
    for name, value, stated in (("r0", z.r0, at_vertex["r0"]), ("l0", z.l0, at_vertex["l0"])):
        assert value * 1e3 == pytest.approx(float(truth[f"{name} least"]["exact"]), abs=6e-5)
        assert stated == pytest.approx(value, rel=1e-9)
    # One border only: O is the foot of a perpendicular.
    assert len(z.touching) == 1
    assert cam(rocker_data(centre="least")).dense.angles.value.max() == pytest.approx(pi / 4, abs=2e-5)


def test_flat_follower_of_the_manual():
    p, truth = cam(flat_data()).plate, values("000 ex. 3")
    for name, value in (("r_min", p.r_min), ("l1", p.l1), ("l2", p.l2)):
        assert value * 1e3 == pytest.approx(float(truth[name]["exact"]), abs=6e-4)


def test_flat_follower_in_closed_form():
    """Constant acceleration: S + S'' is least in the middle of the fall, S' largest in the middles."""
    h, rise, fall = 0.055, radians(140), radians(120)
    p = cam(flat_data()).plate
    assert p.r_min == pytest.approx(4 * h / fall**2 - h / 2, rel=1e-11)
    assert (p.l1, p.l2) == pytest.approx((2 * h / rise, 2 * h / fall), rel=1e-14)
    assert p.r0 == 0.03


def test_radius_of_a_flat_follower_by_itself():
    p = cam(flat_data(base_radius=None, fall=80)).plate
    assert 0 <= p.r0 - 1.1 * p.r_min < 1e-3
    assert p.r0 == pytest.approx(round(p.r0, 3), abs=1e-15)
    # Long phases: every radius is convex.
    flat_one = cam(flat_data(base_radius=None, law="cosine", rise=180, upper_dwell=0, fall=180)).plate
    assert flat_one.r_min == pytest.approx(0.0, abs=1e-12)
    assert flat_one.r0 == pytest.approx(0.0275, abs=5.1e-4)


def tangent_of_pressure(data, law, phi, r0, l0):
    """Pressure angle of a rocker by its formula: rocker frame, A the origin, AB along x."""
    arm, same = data.arm, 1 if data.rotation == "same" else -1
    first = np.arccos((arm**2 + l0**2 - r0**2) / (2 * arm * l0))
    b = first + law.s(phi)
    return same * (l0 * np.cos(b) - arm * (1 - same * law.ds(phi))) / (l0 * np.sin(b))


ROCKERS = [{}, {"rotation": "opposite"}, {"limit": "both"}, {"sense": "counter-clockwise", "rotation": "opposite", "limit": "both"},
           {"law": "constant", "limit": "both"}, {"law": "trapezoid", "swing": 12, "arm": 60, "rise": 60, "pressure_angle": 35},
           {"law": "linearly decreasing", "rotation": "opposite", "swing": 45}]


@pytest.mark.parametrize("changes", ROCKERS)
def test_limits_of_a_rocker_are_kept_and_reached_on_both_sides(changes):
    data = rocker_data(limit="rise", roller=None, **changes) if "limit" not in changes else rocker_data(roller=None, **changes)
    c = cam(data)
    parts = [np.linspace(0, data.rise, 20001)]
    if data.limit == "both":
        down = data.rise + data.upper_dwell
        parts.append(np.linspace(down, down + data.fall, 20001))
    nu = np.degrees(np.arctan(tangent_of_pressure(data, c.law, np.concatenate(parts), c.zone.r0, c.zone.l0)))
    allowed = degrees(data.pressure_angle)
    assert np.abs(nu).max() <= allowed + 1e-9
    assert nu.max() == pytest.approx(allowed, abs=1e-4)
    assert nu.min() == pytest.approx(-allowed, abs=1e-4)


def brute_force(data, law, n=701):
    """Zone as the intersection of half-planes of sampled positions (shapely), rocker frame of position 0, mm."""
    reach = 3000.0
    shape = box(-reach, -reach, reach, reach)
    same = 1 if data.rotation == "same" else -1
    phases = [(0.0, data.rise)] + ([(data.rise + data.upper_dwell, data.fall)] if data.limit == "both" else [])
    for start, angle in phases:
        for phi in start + angle * np.linspace(0, 1, n):
            # The rocker rises clockwise about A = 0 from B0 = (arm, 0); the cam lies above.
            psi, dpsi = float(law.s(phi)), float(law.ds(phi))
            along, motion = np.exp(-1j * psi), -1j * np.exp(-1j * psi)
            tip = data.arm * 1e3 * (1 - same * dpsi) * along
            for side in (1, -1):
                out = -motion * np.exp(1j * side * data.pressure_angle)
                inward = -side * 1j * out
                corner = [tip + reach * 3 * out, tip - reach * 3 * out]
                far = [p + reach * 6 * inward for p in reversed(corner)]
                shape = meet(shape, Polygon([(p.real, p.imag) for p in corner + far]))
    return shape


@pytest.mark.parametrize("changes", few(ROCKERS[:5], ROCKERS[1], ROCKERS[4]))
def test_zone_against_half_planes(changes):
    data = rocker_data(limit="rise", roller=None, **changes) if "limit" not in changes else rocker_data(roller=None, **changes)
    c = cam(data)
    shape = brute_force(data, c.law)
    start = Point(data.arm * 1e3, 0)
    least = told(c, np.zeros(1))["least"]
    # 701 positions a phase miss the envelope by the square of their spacing.
    assert shape.distance(start) == pytest.approx(least["r0"] * 1e3, abs=2e-3)
    l0, r0 = c.zone.l0 * 1e3, c.zone.r0 * 1e3
    angle = np.arccos((data.arm**2 * 1e6 + l0**2 - r0**2) / (2 * data.arm * 1e3 * l0))
    vertex = Point(l0 * np.cos(angle), l0 * np.sin(angle))
    assert shape.exterior.distance(vertex) < 2e-3
    nearest = min(Point(p).distance(vertex) for p in shape.exterior.coords)
    assert nearest < 0.2


def test_hatched_region_is_the_zone():
    data = rocker_data(limit="both", roller=None)
    c = cam(data)
    z = c.zone
    apex, size = complex(z.apex.value), 0.06
    outline = [apex + complex(x, y) for x, y in ((-size, -size), (size, -size), (size, size), (-size, size))]
    region = Polygon([(p.real * 1e3, p.imag * 1e3) for p in z.cones.region(outline, 700)])
    # The rocker frame of the brute force, turned and moved into the frame of the zone.
    truth = brute_force(data, c.law)
    pivot = complex(z.plan["A"].value)
    turned = Polygon([((pivot - complex(x, y) / 1e3).real * 1e3, (pivot - complex(x, y) / 1e3).imag * 1e3)
                      for x, y in truth.exterior.coords])
    window = Polygon([(p.real * 1e3, p.imag * 1e3) for p in outline])
    assert region.symmetric_difference(meet(turned, window)).area < 1e-3 * region.area


# --- translating follower with a given eccentricity


@pytest.mark.parametrize("changes", [{"eccentricity": 2}, {"eccentricity": 6, "limit": "both"}, {"eccentricity": -3},
                                     {"eccentricity": 0, "law": "constant"}, {"eccentricity": 9, "sense": "counter-clockwise"}])
def test_given_eccentricity(changes):
    """S0 is the larger of two maxima (transport tasks): both limits kept, one of them reached."""
    data = cam_data(roller=None, **changes)
    c = cam(data)
    t, e = tan(data.pressure_angle), data.eccentricity
    phi = np.linspace(0, data.rise, 200001)
    if data.limit == "both":
        down = data.rise + data.upper_dwell
        phi = np.concatenate((phi, np.linspace(down, down + data.fall, 200001)))
    s, ds = c.law.s(phi), c.law.ds(phi)
    s0 = max(((ds - s * t).max() - e) / t, ((-ds - s * t).max() + e) / t)
    assert c.zone.s0 == pytest.approx(s0, rel=1e-9)
    assert c.zone.e == pytest.approx(e, abs=1e-17)
    assert c.zone.r0 == pytest.approx(hypot(e, s0), rel=1e-9)


def test_table_column_of_the_transport_tasks():
    """Column 0 of the cam table: r0 23.857, rho_min 13.32 mm."""
    c = cam(cam_data(law="constant", rise=60, upper_dwell=0, fall=60, eccentricity=6, pressure_angle=25, roller=None))
    assert c.zone.r0 * 1e3 == pytest.approx(23.857, abs=5e-4)
    assert c.rho_min * 1e3 == pytest.approx(13.32, abs=5e-3)
    b = cam(rocker_data(rise=70, upper_dwell=30, fall=70, swing=20, arm=110, pressure_angle=40, limit="both", roller=None))
    assert b.zone.r0 * 1e3 == pytest.approx(43.792, abs=5e-4)
    assert b.rho_min * 1e3 == pytest.approx(31.61, abs=5e-3)


def test_least_cam_of_a_tappet_with_a_wide_zone():
    """Beyond 45 degrees the apex is not the nearest point: the foot on a tangent is."""
    apex, least = (cam(cam_data(pressure_angle=60, roller=None, centre=c)).zone for c in ("vertex", "least"))
    assert least.r0 < apex.r0
    touch = complex(least.touching[0].value)
    # Distance of the start from the tangent through its touching point.
    across = complex(cos(radians(60)), -sin(radians(60)))
    assert least.r0 == pytest.approx(abs((touch * across.conjugate()).real), rel=1e-12)
    assert cam(cam_data(centre="least")).zone.r0 == pytest.approx(cam(cam_data()).zone.r0, rel=1e-12)


# --- refusals and protocol


def test_no_axis_is_said_with_the_angle_that_would_do():
    data = rocker_data(rise=40, fall=40, swing=60, arm=100, pressure_angle=5, limit="both", roller=None)
    with pytest.raises(CannotBuild, match=r"within 5 deg on the rise and the fall\n.* from (\d+) deg on") as refusal:
        _ = cam(data).zone
    needed = int(str(refusal.value).split("from ")[1].split(" deg")[0])
    assert cam(rocker_data(rise=40, fall=40, swing=60, arm=100, pressure_angle=needed, limit="both", roller=None)).zone.r0 > 0
    with pytest.raises(CannotBuild):
        _ = cam(rocker_data(rise=40, fall=40, swing=60, arm=100, pressure_angle=needed - 1, limit="both", roller=None)).zone


def test_pointed_profile_under_a_flat_follower_is_refused():
    with pytest.raises(CannotBuild, match=r"20 mm .* cusp at 220.0 deg.* more than 22\.65 mm") as refusal:
        _ = cam(flat_data(base_radius=20)).plate
    assert "take 25 mm" in str(refusal.value)


def test_protocol_of_the_zones():
    said = list(sentences(cam(rocker_data()).zone.plan, 4, lambda m: m / 1e-3))
    assert any("AB·ψ'" in s and "к оси A" in s for s in said)
    assert any("r_0 = 23,9 мм" in s for s in said)
    outwards = list(sentences(cam(rocker_data(rotation="opposite", roller=None)).zone.plan, 4, lambda m: m / 1e-3))
    assert any("на продолжении AB" in s for s in outwards)
    flat_said = list(sentences(cam(flat_data()).plate.plan, 4, lambda m: m / 1e-3))
    assert any("r_min = 22,7 мм" in s for s in flat_said)
    given_e = list(sentences(cam(cam_data(eccentricity=2)).zone.plan, 4, lambda m: m / 1e-3))
    assert any("эксцентриситет 2,0 мм" in s for s in given_e)
    assert not any("{" in s or "nan" in s for s in said + outwards + flat_said + given_e)


@given(st.floats(30, 170), st.floats(0, 40), st.floats(30, 120), st.floats(5, 80), st.floats(5, 70), st.booleans(), st.booleans(),
       st.sampled_from(["rise", "both"]), st.sampled_from(["vertex", "least"]))
def test_any_rocker_keeps_its_limits_or_is_refused(rise, dwell, fall, swing, angle, same, clockwise, limit, centre):
    data = rocker_data(rise=rise, upper_dwell=dwell, fall=fall, swing=swing, pressure_angle=angle, limit=limit, roller=None,
                       rotation="same" if same else "opposite", sense="clockwise" if clockwise else "counter-clockwise",
                       centre=centre)
    c = cam(data)
    try:
        z = c.zone
    except CannotBuild as refused:
        # An angle that is said to do does.
        if "from" in refused.hint:
            needed = int(refused.hint.split("from ")[1].split(" deg")[0])
            data.pressure_angle = radians(needed)
            assert cam(data).zone.r0 > 0
        return
    phi = np.linspace(0, data.rise, 401)
    if limit == "both":
        phi = np.concatenate((phi, np.linspace(data.rise + data.upper_dwell, data.rise + data.upper_dwell + data.fall, 401)))
    nu = np.arctan(tangent_of_pressure(data, c.law, phi, z.r0, z.l0))
    assert np.abs(nu).max() <= data.pressure_angle + 1e-7
    assert atan(tan(np.abs(nu).max())) == pytest.approx(data.pressure_angle, abs=0.02)
