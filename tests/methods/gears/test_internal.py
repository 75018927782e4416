"""Given centre distances, unequal addenda and internal pairs against mpmath, shapely, and the tips followed through a turn."""

from dataclasses import replace
from math import cos, pi, radians, sin, tan

import mpmath
import numpy as np
import pytest
from shapely import Polygon

from tests.methods.gears.test_gears import data, told
from tests.project_files import GEAR, read
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.methods.gears.gear_pair import GearData, gear_pair

ALPHA = radians(20)


def distance(a_w, teeth=(14, 28), shift="rule", **over):
    return data(teeth, shift, centre_distance=a_w, **over)


def ring(teeth=(20, 52), shift=(0.0, 0.25), **over):
    return data(teeth, shift, 0.004, mesh="internal", **over)


def inv(a):
    return mpmath.tan(a) - a


def sum_of_shifts(a_w, teeth, module=0.0035, sign=1):
    """What the involute equation leaves for the shifts, in 40 digits; ``sign`` -1: of an internal pair."""
    with mpmath.workdps(40):
        z = teeth[1] + sign * teeth[0]
        alpha = mpmath.mpf(ALPHA)
        angle = mpmath.acos(mpmath.mpf(module) * z / 2 * mpmath.cos(alpha) / mpmath.mpf(a_w))
        return float(z * (inv(angle) - inv(alpha)) / (2 * mpmath.tan(alpha))), float(angle)


@pytest.mark.parametrize("a_w", [0.075, 0.0735, 0.0745])
def test_shifts_of_a_centre_distance(a_w):
    got = told(gear_pair(distance(a_w)))
    total, angle = sum_of_shifts(a_w, (14, 28))
    assert (got["x_sum"], got["alpha_w"]) == pytest.approx((total, angle), rel=1e-12, abs=1e-14)
    assert got["a_w"] == pytest.approx(a_w * 1e3, rel=1e-15)
    # inversely as the teeth, but z1 = 14 needs 3/17
    assert got["x1"] == pytest.approx(max(total * 28 / 42, 3 / 17), rel=1e-12)
    assert got["x1"] + got["x2"] == pytest.approx(total, rel=1e-12, abs=1e-14)
    again = told(gear_pair(data((14, 28), (got["x1"], got["x2"]))))
    assert again["a_w"] == pytest.approx(a_w * 1e3, rel=1e-12)
    assert again["ra1"] == pytest.approx(got["ra1"], rel=1e-12)


def test_reference_distance_needs_no_shift():
    """Coincident circles: the shifts cancel, and the pressure angle is that of the rack to the last digit."""
    got = told(gear_pair(distance(0.0735)))
    assert got["alpha_w"] == ALPHA
    assert (got["x_sum"], got["x1"] + got["x2"]) == (0, 0)


def test_first_shift_is_kept():
    got = told(gear_pair(distance(0.075, shift=(0.3, None))))
    assert got["x1"] == 0.3
    assert got["x2"] == pytest.approx(sum_of_shifts(0.075, (14, 28))[0] - 0.3, rel=1e-12)


@pytest.mark.parametrize(("a_w", "message"), [
    (0.05, "no pressure angle: a·cos α = 69.07 mm"), (0.0735 * cos(ALPHA) * (1 - 1e-9), "no pressure angle"),
    (0.0715, "undercut"), (0.08, "contact ratio"),
])
def test_distance_that_cannot_be(a_w, message):
    with pytest.raises(CannotBuild, match=message):
        gear_pair(distance(a_w))


def test_unequal_addenda():
    """Each tip clears its mate's root by c*m, and the deeper cut needs the larger shift."""
    gear = gear_pair(data((24, 40), (0.1, 0.1), 0.004, addendum=(1.2, 0.8)))
    one, two = gear.wheels
    a, m, c = gear.a_w, 0.004, 0.25
    assert one.ra + two.rf == pytest.approx(a - c * m, rel=1e-12)
    assert two.ra + one.rf == pytest.approx(a - c * m, rel=1e-12)
    assert (one.ra - one.r) / m - (two.ra - two.r) / m == pytest.approx(0.4, rel=1e-12)
    # wheel 2 is cut as deep as the tall teeth of wheel 1: 2·1.2/sin² 20° = 20.5 teeth at least
    assert (one.rack.addendum, two.rack.addendum) == (0.8, 1.2)
    with pytest.raises(CannotBuild, match="z2 = 18 with x2 = 0 is undercut"):
        gear_pair(data((40, 18), (0.0, 0.0), 0.004, addendum=(1.2, 0.8)))
    gear_pair(data((18, 40), (0.0, 0.0), 0.004, addendum=(1.2, 0.8)))
    shape = gear.shape(one).outline(-1, 1)
    assert np.abs(shape - gear.shape(one).centre).max() == pytest.approx(one.ra, rel=1e-9)


def truth(d, digits=30):
    """GOST 19274 written from the standard's formulas, mm and rad."""
    with mpmath.workdps(digits):
        (z1, z2), (x1, x2), m, alpha = d.teeth, d.shift, mpmath.mpf(d.module) * 1000, mpmath.mpf(d.pressure_angle)
        target = inv(alpha) + 2 * (mpmath.mpf(x2) - x1) * mpmath.tan(alpha) / (z2 - z1)
        w = mpmath.findroot(lambda a: inv(a) - target, alpha)
        a, a_w = m * (z2 - z1) / 2, m * (z2 - z1) / 2 * mpmath.cos(alpha) / mpmath.cos(w)
        y = (a_w - a) / m
        dy = x2 - x1 - y
        h, c = mpmath.mpf(1), mpmath.mpf("0.25")
        ra1, ra2 = m * (z1 / mpmath.mpf(2) + h + x1 + dy), m * (z2 / mpmath.mpf(2) - h + x2 - dy)
        t1, t2 = (mpmath.tan(mpmath.acos(m * z * mpmath.cos(alpha) / 2 / ra)) for z, ra in ((z1, ra1), (z2, ra2)))
        s2 = m * (mpmath.pi / 2 - 2 * mpmath.mpf(x2) * mpmath.tan(alpha))
        return {"alpha_w": w, "a_w": a_w, "y": y, "dy": dy, "ra1": ra1, "ra2": ra2, "rf1": m * (z1 / mpmath.mpf(2) - h - c + x1),
                "rf2": m * (z2 / mpmath.mpf(2) + h + c + x2), "s2": s2, "rw2": a_w * z2 / (z2 - z1),
                "sa2": 2 * ra2 * (s2 / (m * z2) - inv(alpha) + inv(mpmath.atan(t2))),
                "eps_alpha": (z1 * t1 - z2 * t2 + (z2 - z1) * mpmath.tan(w)) / (2 * mpmath.pi)}


RINGS = [ring(), ring((24, 60), (0.0, 0.0)), ring((18, 70), (0.3, -0.1), driver=2),
         ring((40, 90), (-0.2, 0.4), sense="counter-clockwise")]


@pytest.mark.parametrize("d", RINGS)
def test_internal_pair_in_30_digits(d):
    gear = gear_pair(d)
    got = told(gear)
    for name, value in truth(d).items():
        assert got[name] == pytest.approx(float(value), rel=1e-11, abs=1e-12), name
    one, two = gear.wheels
    # clearances between tip and root, and the contact ratio read off the drawing
    assert two.rf - gear.a_w - one.ra == pytest.approx(0.001, rel=1e-9)
    assert two.ra - gear.a_w - one.rf == pytest.approx(0.001, rel=1e-9)
    assert [float(gear.engagement[f"eps{i}"].value) for i in (1, 2)] == pytest.approx([got["eps_alpha"]] * 2, rel=1e-9)
    # sliding where the contact ends, by the speeds along the profiles: ρ1 ω1 and ρ2 ω2
    u, line = d.teeth[0] / d.teeth[1], gear.a_w * sin(gear.alpha_w)
    for theta, rho in zip(gear.greatest_sliding, (one.t_low, one.t_tip), strict=True):
        v1, v2 = rho, (rho + line) * u
        own, other = (v1, v2) if rho == one.t_low else (v2, v1)
        assert theta == pytest.approx((own - other) / own, rel=1e-9)


def polygon(points):
    return Polygon(np.column_stack((np.real(points), np.imag(points))))


@pytest.mark.parametrize("d", RINGS[:3])
def test_teeth_touch_and_never_overlap(d):
    """The pinion's teeth, rolled through a pitch, stay in the ring's spaces and touch them."""
    gear = gear_pair(d)
    one, two = gear.wheels
    pinion, rim = gear.shape(one), gear.shape(two)
    spaces = rim.outline(-2, 2, step=2e-5)
    body = polygon(np.r_[spaces, rim.centre + (spaces[::-1] - rim.centre) * 1.2])
    for share in np.linspace(-0.5, 0.5, 5):
        teeth = np.r_[pinion.outline(-1, 1, step=2e-5), pinion.centre]
        turned = pinion.centre + (teeth - pinion.centre) * np.exp(1j * share * one.tau)
        rolled = polygon(rim.centre + (turned - rim.centre) * np.exp(-1j * share * two.tau))
        assert rolled.is_valid
        assert rolled.intersection(body).area < 2e-4 * d.module**2
        assert rolled.distance(body) < 2e-3 * d.module


def wheel_of(z, half, inner, outer):
    """Outline of an external wheel of module 1 between two radii: involutes by their equation, ``half`` of a tooth at the base."""
    base = z / 2 * cos(ALPHA)
    r = np.linspace(max(inner, base), outer, 12)
    t = np.sqrt((r / base) ** 2 - 1)
    flank = r * np.exp(1j * (half - t + np.arctan(t)))
    side = np.r_[inner * np.exp(1j * half), flank]
    tooth = np.r_[np.conj(side), side[::-1]]
    return np.concatenate([tooth * np.exp(2j * pi * k / z) for k in range(z)])


def overlap(z1, z2):
    """Greatest area, module 1, in which an unshifted pinion and ring would overlap while they turn through a pitch."""
    inv20 = tan(ALPHA) - ALPHA
    pinion = wheel_of(z1, pi / 2 / z1 + inv20, z1 / 2 - 1.25, z1 / 2 + 1)
    space = polygon(wheel_of(z2, pi / 2 / z2 + inv20, z2 / 2 - 1, z2 / 2 + 1.25))
    return max(polygon((z2 - z1) / 2 + pinion * np.exp(2j * pi * t / z1)).difference(
        polygon(space.exterior.coords @ np.array([1, 1j]) * np.exp(2j * pi * t / z2))).area for t in (0.0, 0.25, 0.5, 0.75))


@pytest.mark.parametrize("teeth", [(40, 50), (40, 47), (60, 70), (60, 66), (30, 37)])
def test_tips_beside_the_mesh(teeth):
    """Tips that would meet are refused, and only these: decided by turning whole wheels."""
    d = ring(teeth, (0.0, 0.0))
    if overlap(*teeth) < 1e-3:
        assert told(gear_pair(d))["tips_clear"] > 0
    else:
        with pytest.raises(CannotBuild, match="tips of pinion and ring meet"):
            gear_pair(d)


@pytest.mark.parametrize(("d", "message"), [
    (ring((20, 30), (0.0, 0.0)), "wheel 2 has no tooth: its tip circle lies inside its base circle"),
    (ring((20, 52), (0.0, 0.0)), "wheel 2 touches wheel 1 below its base circle"), (ring((20, 24), (0.9, 0.0)), "x2 - x1 = -0.9"),
    (ring((20, 52), (0.0, 2.0)), "wheel 2 has no space between its teeth"),
])
def test_ring_that_cannot_be(d, message):
    with pytest.raises(CannotBuild, match=message):
        gear_pair(d)


def test_ring_from_a_centre_distance():
    got = told(gear_pair(ring(shift="rule", centre_distance=0.065)))
    total, angle = sum_of_shifts(0.065, (20, 52), 0.004, -1)
    assert (got["x1"], got["x2"], got["alpha_w"]) == pytest.approx((0, total, angle), rel=1e-12)
    by_rule = told(gear_pair(ring((24, 60), "rule")))
    assert (by_rule["x1"], by_rule["x2"], by_rule["a_w"]) == (0, 0, pytest.approx(72))


@pytest.mark.parametrize(("changes", "message"), [
    ({"gear.centre_distance": "75 mm"}, "either shift or centre_distance"),
    ({"gear.first_shift": 0.2}, "first_shift goes with centre_distance"),
    ({"gear.addendum": 1, "gear.addenda": [1, 1]}, "either addendum or addenda"),
    ({"gear.mesh": "internal", "gear.teeth": [28, 28]}, "the ring is wheel 2"),
    ({"gear.mesh": "internal", "gear.profile": "rack"}, "no rack cuts a ring"),
])
def test_bad_tables(changes, message):
    with pytest.raises(BadInput, match=message):
        read(GEAR, changes)


def test_ways_to_say_it_are_one():
    """Equal addenda of each wheel are one addendum; pi keeps the pitch."""
    one, two = (told(gear_pair(d)) for d in (data((20, 30), (0.1, 0.0)), data((20, 30), (0.1, 0.0), addendum=(1.0, 1.0))))
    assert one.keys() == two.keys()
    assert all(np.array_equal(one[name], two[name], equal_nan=True) for name in one)
    assert one["p"] == pytest.approx(3.5 * pi)
    assert replace(GearData((1, 2), 1, (0, 0), 1, 1, 1, 1, "", "")).mesh == "external"
