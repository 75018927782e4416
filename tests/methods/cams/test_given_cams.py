"""Cams of a given radius and laws through ordinates: analytic pressure angles, a spline by linear algebra, mpmath."""

from math import cos, degrees, pi, radians, sin

import mpmath
import numpy as np
import pytest

from tests.project_files import CAM, merged, project, read
from tmm_sheets.errors import BadInput, CannotBuild

GIVEN = merged(CAM, {"cam.base_radius": "30 mm", "cam.eccentricity": "4 mm", "cam.sense": "counter-clockwise"})
ROCKER = {"cam": {"follower": "oscillating roller", "law": "sine", "rise": "90 deg", "upper_dwell": "20 deg", "fall": "110 deg",
                  "arm": "80 mm", "swing": "24 deg", "base_radius": "40 mm", "centre_distance": "95 mm", "pressure_angle": "40 "
                                                                                                                           "deg"}}
ORDINATES = [("0 deg", 0), ("20 deg", 1.1), ("45 deg", 4.2), ("70 deg", 8.3), ("100 deg", 10), ("130 deg", 10), ("170 deg", 6.5),
             ("200 deg", 2.5), ("230 deg", 0), ("360 deg", 0)]


def told(cam):
    return {k: v["pressure_angle"].value for k, v in cam.results()["steepest"].items()}


def law(x):
    return x - np.sin(2 * pi * x) / (2 * pi), 1 - np.cos(2 * pi * x)


@pytest.mark.parametrize("e", ["0 mm", "4 mm", "-6 mm", "29 mm"])
def test_pressure_angle_of_a_given_radius(e):
    """tan α = (S' − e)/(S + √(r0² − e²)), greatest by a fine search; the permitted angle refuses nothing."""
    cam = project(GIVEN, {"cam.eccentricity": e, "cam.roller": "1 mm"}).cam
    offset = float(e.split()[0])
    x = np.linspace(0, 1, 200001)
    s, ds = law(x)
    for phase, angle, sign in (("rise", radians(100), 1), ("fall", radians(70), -1)):
        alpha = np.arctan((sign * 10 / angle * ds - offset) / (10 * (s if sign > 0 else 1 - s) + (30**2 - offset**2) ** 0.5))
        assert told(cam)[phase] == pytest.approx(alpha[np.argmax(abs(alpha))], rel=1e-9)
    assert float(cam.zone.plan["r_0"].value) == pytest.approx(0.03, rel=1e-12)
    assert cam.zone.e == pytest.approx(offset / 1e3, abs=1e-15)
    assert max(abs(told(cam)[k]) for k in told(cam)) == pytest.approx(np.abs(cam.dense.angles.value).max(), rel=1e-3)


@pytest.mark.parametrize(("rotation", "sense"), [("same", "clockwise"), ("opposite", "clockwise"), ("same", "counter-clockwise")])
def test_pressure_angle_of_a_rocker(rotation, sense):
    """The triangle O A B of every position: tan α = (l(1 ∓ ψ') − l0 cos ∠A)/(l0 sin ∠A)."""
    cam = project(ROCKER, {"cam.rotation": rotation, "cam.sense": sense}).cam
    arm, l0, r0 = 80, 95, 40
    first = np.arccos((arm**2 + l0**2 - r0**2) / (2 * arm * l0))
    x = np.linspace(0, 1, 100001)
    s, ds = law(x)
    for phase, angle, sign in (("rise", pi / 2, 1), ("fall", radians(110), -1)):
        at = first + radians(24) * (s if sign > 0 else 1 - s)
        slope = sign * radians(24) / angle * ds * (1 if rotation == "same" else -1)
        alpha = np.arctan((arm * (1 - slope) - l0 * np.cos(at)) / (l0 * np.sin(at)))
        assert abs(told(cam)[phase]) == pytest.approx(np.abs(alpha).max(), rel=1e-8)
    assert cam.zone.l0 == pytest.approx(0.095, rel=1e-12)
    square = project(ROCKER, {"cam.rotation": rotation, "cam.sense": sense, "cam.centre_distance": None}).cam
    assert square.zone.l0 == pytest.approx(np.hypot(0.08, 0.04), rel=1e-12)


def test_rocker_without_any_allowed_axis_is_drawn_with_a_given_radius():
    narrow = {"cam.pressure_angle": "5 deg", "cam.rise": "60 deg", "cam.fall": "60 deg", "cam.roller": "1 mm"}
    with pytest.raises(CannotBuild, match="no axis of the cam keeps the pressure angle"):
        _ = project(ROCKER, narrow, {"cam.base_radius": None, "cam.centre_distance": None}).cam.zone
    assert degrees(abs(told(project(ROCKER, narrow).cam)["rise"])) > 5


@pytest.mark.parametrize(("part", "changes", "message"), [
    (GIVEN, {"cam.base_radius": "4 mm"}, "cannot stand 4 mm off"), (GIVEN, {"cam.eccentricity": "-31 mm"}, "cannot stand 31 mm "
                                                                                                           "off"),
    (ROCKER, {"cam.centre_distance": "120 mm"}, "make no triangle"), (ROCKER, {"cam.centre_distance": "40 mm"}, "make no triangle"),
])
def test_radius_that_cannot_be(part, changes, message):
    with pytest.raises(CannotBuild, match=message):
        _ = project(part, changes).cam.zone


def by_table(rows, **cam):
    return {"cam": {"follower": "translating roller", "pressure_angle": "30 deg",
                    "displacements": [[phi, f"{s} mm"] for phi, s in rows]} | cam}


def clamped(x, y):
    """Coefficients of all cubics of a clamped spline, by rising power of x - x_k: one linear system of every condition."""
    n, h = len(x) - 1, np.diff(x)
    rows, right = [], []

    def condition(*terms, value=0.0):
        row = np.zeros(4 * n)
        for k, order, t, sign in terms:
            row[4 * k:4 * k + 4] += sign * np.array([[1, t, t**2, t**3], [0, 1, 2 * t, 3 * t**2], [0, 0, 2, 6 * t]][order])
        rows.append(row)
        right.append(value)

    for k in range(n):
        condition((k, 0, 0.0, 1), value=y[k])
        condition((k, 0, h[k], 1), value=y[k + 1])
        if k:
            for order in (1, 2):
                condition((k - 1, order, h[k - 1], 1), (k, order, 0.0, -1))
    condition((0, 1, 0.0, 1))
    condition((n - 1, 1, h[-1], 1))
    found = np.linalg.solve(np.array(rows), np.array(right)).reshape(n, 4)

    def value(at, order):
        k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, n - 1)
        return np.array([np.polynomial.Polynomial(found[i]).deriv(order)(t - x[i]) if order else
                         np.polynomial.Polynomial(found[i])(t - x[i]) for i, t in zip(k, at, strict=True)])

    return value


def test_law_through_ordinates():
    """A clamped spline for each phase, its cubics from one linear system; in the dwells the follower rests."""
    cam = project(by_table(ORDINATES)).cam
    phi = np.radians([float(p.split()[0]) for p, _ in ORDINATES])
    s = np.array([v for _, v in ORDINATES]) / 1e3
    assert (cam.law.rise.angle, cam.law.upper_dwell.angle, cam.law.fall.angle) == pytest.approx(np.radians([100, 30, 100]))
    assert cam.law.stroke == pytest.approx(0.01)
    rise, fall = (clamped(phi[a:b], s[a:b]) for a, b in ((0, 5), (5, 9)))
    at = np.r_[np.linspace(0, phi[4] - 1e-9, 41), np.linspace(phi[5] + 1e-9, phi[8] - 1e-9, 41)]
    found = cam.results(at)
    for name, order in (("s", 0), ("ds", 1), ("dds", 2)):
        truth = np.r_[rise(at[:41], order), fall(at[41:], order)]
        assert np.asarray(found[name].value) == pytest.approx(truth, rel=1e-9, abs=1e-12), name
    still = cam.results(np.radians([115, 300]))
    assert list(still["s"].value) == pytest.approx([0.01, 0])
    assert list(still["ds"].value) == [0, 0]


def test_single_interval_is_one_cubic():
    cam = project(by_table([("0 deg", 0), ("90 deg", 8), ("180 deg", 0), ("360 deg", 0)])).cam
    with mpmath.workdps(30):
        x = mpmath.mpf(1) / 3
        assert float(cam.results(np.array([pi / 6]))["s"].value[0]) == pytest.approx(float(8e-3 * x**2 * (3 - 2 * x)), rel=1e-12)
    assert cam.law.upper_dwell.angle == 0


def test_ordinates_of_a_rocker_are_angles():
    rows = [[phi, f"{2 * s} deg"] for phi, s in ORDINATES]
    cam = project({"cam": {"follower": "oscillating roller", "pressure_angle": "45 deg", "arm": "80 "
                                                                                                "mm", "displacements": rows}}).cam
    assert cam.law.stroke == pytest.approx(radians(20))
    assert sin(cam.law.stroke) < cos(cam.law.stroke)


def changed(k, row):
    return [*ORDINATES[:k], row, *ORDINATES[k + 1:]]


@pytest.mark.parametrize(("rows", "cam", "message"), [
    (ORDINATES, {"law": "sine"}, "tells law itself"), (ORDINATES, {"stroke": "10 mm", "rise": "90 deg"}, "tells rise, stroke "
                                                                                                         "itself"),
    (ORDINATES[:-1], {}, "angles from 0 to 360 deg"), (changed(9, ("360 deg", 1)), {}, "begins and ends at 0"),
    (changed(2, ("45 deg", 1.0)), {}, "turns back at 20 deg"), (changed(7, ("200 deg", 7.0)), {}, "turns back at 170 deg"),
    (changed(1, ("20 deg", 0)), {}, "it begins at 20 deg"), (changed(3, ("40 deg", 8.3)), {}, "arguments that rise"),
    (changed(3, ("70 mm", 8.3)), {}, "unit of"),
])
def test_bad_ordinates(rows, cam, message):
    with pytest.raises(BadInput, match=message):
        read(by_table(rows, **cam))


def test_spline_that_turns_back_is_refused():
    steep = [("0 deg", 0), ("40 deg", 0.1), ("42 deg", 9.9), ("100 deg", 10), ("200 deg", 0), ("360 deg", 0)]
    with pytest.raises(CannotBuild, match=r"cam\.displacements: the follower turns back inside the phase"):
        _ = project(by_table(steep)).cam


@pytest.mark.parametrize(("part", "changes", "message"), [
    (GIVEN, {"cam.centre": "least"}, "base_radius tells where the axis is"),
    (CAM, {"cam.law": "displacements"}, "needs the table displacements"),
    (merged(ROCKER, {"cam.base_radius": None}), {}, "goes with base_radius only"),
])
def test_keys_that_do_not_go_together(part, changes, message):
    with pytest.raises(BadInput, match=message):
        read(part, changes)
