"""Teeth cut by a rack against the involute's equation, the trochoid in 50 digits, and cutting with shapely."""

from dataclasses import replace
from math import cos, pi, radians, sin, sqrt

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, strategies as st
from shapely import MultiPoint, Point, Polygon, difference, union_all

from tests.methods.gears.test_gears import data, polygon
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears.gear_engagement import unrolled
from tmm_sheets.methods.gears.gear_geometry import geometry_plan
from tmm_sheets.methods.gears.gear_pair import GearData, gear_pair, settled
from tmm_sheets.methods.gears.rack import Rack, flank

ALPHA = radians(20)


def rack(teeth, shift, addendum=1.0, clearance=0.25, module=0.01):
    return Rack(module, ALPHA, addendum, clearance, teeth, shift)


RACKS = [rack(14, 3 / 17), rack(14, 0.2), rack(14, 0.0), rack(10, 0.0), rack(20, 0.0), rack(20, 0.5), rack(12, 0.3, 0.8, 0.2),
         rack(10, 0.4151), rack(30, -0.3), rack(12, 0.6), rack(11, 0.1, 0.8, 0.25), rack(40, 0.0, 1.0, 0.2)]


def tip(r):
    return r.r + r.module * (r.addendum + r.shift)


def test_tip_radius_of_the_basic_racks():
    """0.38 m belongs to c* = 0.25, 0.304 m to 0.2."""
    assert rack(20, 0).tip_radius == pytest.approx(0.0038, abs=5e-7)
    assert rack(20, 0, 1.0, 0.2).tip_radius == pytest.approx(0.00304, abs=5e-7)


@pytest.mark.parametrize("r", RACKS)
def test_rack_is_smooth_and_as_wide_as_its_spaces(r):
    outline = r.tooth(r.addendum * r.module, chords=400)
    slopes = np.angle(np.diff(outline[: len(outline) // 2]))
    assert slopes[0] == pytest.approx(-pi / 2 - ALPHA, abs=1e-9)  # down along the flank
    assert np.abs(np.diff(slopes)).max() < 4e-3
    assert outline.imag.min() == pytest.approx(-r.depth, abs=1e-15)
    # on the reference line a tooth is half a pitch wide
    at = np.interp(0.0, outline.imag[:2][::-1], outline.real[:2][::-1])
    assert 2 * at == pytest.approx(pi * r.module / 2, rel=1e-12)
    assert r.tip_centre.real > 0


@pytest.mark.parametrize("r", RACKS)
def test_flank_is_the_involute_and_the_trochoid(r):
    """Every point lies on the one or the other to rounding; the two are joined without a gap."""
    got = flank(r, tip(r))
    start = max(r.involute_from(), 0.0)
    radius = np.abs(got)
    assert radius[0] == pytest.approx(r.r - r.depth + r.shift * r.module, abs=1e-16)
    assert radius[-1] == pytest.approx(tip(r), abs=1e-16)
    assert (np.diff(radius) > 0).all()
    begin = sqrt(r.rb**2 + start**2)
    on_involute = radius >= begin * (1 - 1e-13)
    with mpmath.workdps(30):
        half = (mpmath.pi / 2 + 2 * r.shift * mpmath.tan(ALPHA)) / r.teeth + mpmath.tan(ALPHA) - ALPHA
        for p in got[on_involute]:
            ratio = min(mpmath.mpf(r.rb) / abs(mpmath.mpc(p)), mpmath.mpf(1))
            a = mpmath.acos(ratio)
            off = float((mpmath.arg(mpmath.mpc(p)) - (half - mpmath.tan(a) + a)) * abs(p))
            # near the base circle the angle is known to the root of the rounding of the radius only, but times its sine
            assert abs(off) < 1e-15 + 3e-16 * r.r
        below = -mpmath.mpf(r.tip_centre.imag) - r.shift * mpmath.mpf(r.module)

        def trochoid(normal):
            """By its equation, with the normal as parameter."""
            roll = (below / mpmath.tan(normal) - mpmath.mpf(r.tip_centre.real)) / r.r
            string = (below / mpmath.sin(normal) + mpmath.mpf(r.tip_radius)) * mpmath.expj(-normal)
            return (1j * mpmath.mpf(r.r) + string) * mpmath.expj(roll) * mpmath.expj(mpmath.pi / r.teeth - mpmath.pi / 2)

        step = mpmath.mpf("1e-12")
        normals = np.linspace(pi / 2, r.last_normal(start), 400)
        near = np.array([complex(trochoid(mpmath.mpf(n))) for n in normals])
        for p in got[~on_involute]:
            # the nearest point of the trochoid: Newton on the parameter, from the nearest of many
            normal = mpmath.mpf(float(normals[np.abs(near - p).argmin()]))
            for _ in range(4):
                slope = (trochoid(normal + step) - trochoid(normal - step)) / (2 * step)
                normal += mpmath.re((mpmath.mpc(p) - trochoid(normal)) / slope)
            assert abs(mpmath.mpc(p) - trochoid(normal)) < 1e-15 + 1e-14 * r.r


@pytest.mark.parametrize("r", RACKS)
def test_chords_of_the_fillet_are_even_and_short(r):
    chords = np.abs(np.diff(flank(r, tip(r))))[:-31]  # the involute has 32 points
    fillet = chords[:-1] / r.module  # the last leads over to the involute
    assert fillet.min() > 0.03
    assert fillet.max() < 0.04
    assert fillet.max() / fillet.min() < 1.02
    assert chords[-1] < 0.04 * r.module * (1 + 1e-9)


def cut(r, positions, chords):
    """What positions of the rack leave of a blank, and the greatest distance of the flank from its edge, mm."""
    got = flank(r, tip(r)) * np.exp(1j * (pi / 2 - pi / r.teeth)) * 1e3
    first, last = r.rolls(tip(r))
    rolls = np.linspace(first - 0.03, last + 0.03, positions)
    top = 1.1 * tip(r) * 1e3
    angles = np.linspace(pi / 2 - pi / r.teeth, pi / 2 + 0.1, 50)
    blank = Polygon([(0, 0), *zip(top * np.cos(angles), top * np.sin(angles), strict=True)])
    placed = (r.placed(r.tooth(4 * r.module, chords), roll) * 1e3 for roll in rolls)
    left = difference(blank, union_all([Polygon(np.column_stack((p.real, p.imag))) for p in placed]))
    return max(left.exterior.distance(Point(p.real, p.imag)) for p in got), left, got


@pytest.mark.parametrize("r", [RACKS[2], RACKS[4], RACKS[6]])
def test_positions_of_the_rack_cut_that_flank(r):
    """The rest between the positions goes as 1/N^2; undercut or not."""
    coarse, fine = (cut(r, n, 40 * n // 50)[0] for n in (50, 200))
    assert fine < 3e-3 * r.module * 1e3
    assert 8 < coarse / fine < 40


@pytest.mark.parametrize("r", RACKS)
def test_rack_never_cuts_into_the_flank(r):
    _, left, got = cut(r, 60, 30)
    inside = MultiPoint(np.column_stack((got.real, got.imag)))
    assert inside.difference(left.buffer(2e-4 * r.module * 1e3)).is_empty


@pytest.mark.parametrize("r", RACKS)
def test_undercut_where_the_shift_is_too_small(r):
    limit = r.r * sin(ALPHA) - (r.addendum - r.shift) * r.module / sin(ALPHA)
    assert r.rho_limit == pytest.approx(limit, abs=1e-15)
    z_min = 2 * r.addendum / sin(ALPHA) ** 2
    assert r.least_shift == pytest.approx(r.addendum * (z_min - r.teeth) / z_min, abs=1e-14)
    assert r.undercut == (r.shift < r.least_shift)
    if r.undercut:
        # with a ten-thousandth of a module too little the undercut is below rounding
        assert (r.involute_from() > 0) == (r.shift < r.least_shift - 1e-4)
    else:
        assert r.involute_from() == r.rho_limit


def test_undercut_of_the_manuals_rule():
    """z = 14, x = 3/17: the involute begins 1.2e-5 mm above the base circle, nothing a drawing could show."""
    r = rack(14, 3 / 17, module=0.0035)
    start = r.involute_from()
    above = (sqrt(r.rb**2 + start**2) - r.rb) * 1e3
    assert above == pytest.approx(1.2e-5, abs=5e-7)


def shift_without_undercut(teeth, addendum, alpha):
    d = data((teeth, 20), "rule", addendum=addendum)
    d.pressure_angle = alpha
    return geometry_plan(d)["x1"].value


def test_generalised_rule():
    assert shift_without_undercut(14, 1.0, ALPHA) == pytest.approx(0.18116, abs=5e-6)
    assert shift_without_undercut(17, 1.0, ALPHA) == pytest.approx(1 - 17 / 17.0973, abs=5e-6)
    assert shift_without_undercut(18, 1.0, ALPHA) == 0
    assert shift_without_undercut(12, 0.8, ALPHA) == pytest.approx(0.8 * (13.6778 - 12) / 13.6778, abs=5e-6)


class _Section:
    def __init__(self, **over):
        self.__dict__ |= {"teeth": (12, 30), "module": 0.005, "shift": "rule", "pressure_angle": ALPHA, "addendum": None,
                          "addenda": None, "clearance": None, "driver": 1, "sense": "clockwise", "profile": "rack",
                          "mesh": "external", "centre_distance": None} | over


class _Reducer:
    simple_pair = (11, 33), 0.012, 0.8, 0.2


def test_settled_data():
    assert settled(_Section()) == GearData((12, 30), 0.005, "rule", ALPHA, 1.0, 0.25, 1, "clockwise", "rack")
    got = settled(_Section(teeth="reducer", module=None, shift=(0.3, -0.1)), _Reducer())
    assert got == GearData((11, 33), 0.012, (0.3, -0.1), ALPHA, 0.8, 0.2, 1, "clockwise", "rack")


def test_rack_teeth_stand_where_the_others_do():
    """Both profiles have the same involute: the flanks of the pair agree above both fillets."""
    for driver, sense in ((1, "clockwise"), (1, "counter-clockwise"), (2, "clockwise")):
        one, two = (gear_pair(data((14, 28), (0.2, 0.0), profile=p, driver=driver, sense=sense)) for p in ("fillet", "rack"))
        for a, b in zip(one.wheels, two.wheels, strict=True):
            centre, foot = (complex(one.engagement[f"{name}{a.number}"].value) for name in "ON")
            points = two.shape(b).flank[-32:]
            string = np.sqrt(np.maximum(abs(points - centre) ** 2 - a.rb**2, 0))
            assert abs(string[0] - b.t_fillet) < 1e-9
            assert np.abs(points - unrolled(centre, foot, 0j, np.append(b.t_fillet, string[1:]))).max() < 1e-15 + 1e-14 * a.ra


def fine(gear, w):
    """The tooth with ten times as many points on its fillet: the drawn chords of a hollow fillet lie on the side of the metal,
    and where the mate's tip touches next to it they alone would share some 1e-5 mm2 with it."""
    shape = gear.shape(w)
    points = flank(w.rack, w.ra, chord=0.004)
    return replace(shape, flank=shape.centre + shape.axis * (np.conj(points) if shape.side < 0 else points))


@given(
    z=st.tuples(st.integers(8, 60), st.integers(8, 60)),
    x=st.tuples(st.floats(-0.5, 1.0), st.floats(-0.5, 1.0)),
    basic=st.sampled_from(((1.0, 0.25), (1.0, 0.2), (0.8, 0.2), (0.8, 0.25))),
)
@example(z=(21, 22), x=(-0.25, -0.25), basic=(1.0, 0.25))
def test_builds_or_refuses(z, x, basic):
    """Whatever the tooth numbers and shifts: teeth that mesh without sharing area, or a refusal."""
    try:
        gear = gear_pair(data(z, x, 0.005, addendum=basic[0], clearance=basic[1], profile="rack"))
    except CannotBuild:
        return
    for w in gear.wheels:
        assert w.t_fillet <= w.t_low + 1e-9 * gear.m
        shape = gear.shape(w)
        radius = np.abs(shape.flank - shape.centre)
        assert (np.diff(radius) > 0).all()
        assert radius[0] == pytest.approx(w.rf, abs=1e-12)
        assert radius[-1] == pytest.approx(w.ra, abs=1e-12)
    for travel in (-gear.g_alpha / 2, 0.0, gear.g_alpha / 3):
        first, second = (polygon(gear, w, gear.rolled(w, fine(gear, w).outline(-2, 2, step=2e-4), travel)) for w in gear.wheels)
        assert first.is_valid
        assert second.is_valid
        assert first.intersection(second).area < 1e-12
    assert gear.generating.check() is None or gear.generating.check()[0] == "E"  # where the flank does not reach


def test_positions_that_are_drawn_touch_the_tooth():
    """Feet of the perpendiculars lie on the flank where the straight flank reaches; the first on the tip circle."""
    gear = gear_pair(data((12, 30), (0.3, 0.0), 0.01, profile="rack"))
    plan, w = gear.generating, gear.pinion
    touched = plan["E"].value
    on = ~np.isnan(touched)
    assert on.all()
    end = w.rack.tip_centre + w.rack.tip_radius * np.exp(-1j * ALPHA)  # of the straight flank
    assert abs(w.rack.placed(end, w.rack.rolls(w.ra)[1]) - touched[-1]) < 1e-15
    assert abs(touched[0]) == pytest.approx(w.ra, rel=1e-13)
    p = touched[on] * np.exp(-1j * (pi / 2 - pi / w.teeth))
    a = np.arccos(w.rb / np.abs(p))
    assert np.abs(np.angle(p) - (w.rack.tooth_half - np.tan(a) + a)).max() < 1e-13
    # the rolling line rolls: its contact has gone as far on the circle as on the line
    arc = np.angle(plan["W"].value / 1j) * w.r
    assert arc == pytest.approx(plan["s"].value, abs=1e-14)
    # and the reference line keeps its shift
    along = plan["OW"].value
    assert np.real((plan["M"].value - plan["W"].value) * np.conj(along)) == pytest.approx(0.3 * 0.01, abs=1e-15)
    assert cos(ALPHA) == pytest.approx(np.real(plan["flank"].value * np.conj(along))[0], abs=1e-14)


def test_undercut_is_told_and_a_lost_contact_refused():
    gear = gear_pair(data((9, 9), (0.2, 0.4), 0.01, profile="rack"))
    assert gear.wheels[0].rack.undercut
    assert gear.warnings[0] == "зуб колеса 1 подрезан: смещение меньше 0,47"
    with pytest.raises(CannotBuild, match=r"the tip of wheel 2 reaches .* mm below the involute of wheel 1 into its undercut"):
        gear_pair(data((9, 10), (0.2, 0.4), 0.01, profile="rack"))
    with pytest.raises(CannotBuild, match="undercut"):
        gear_pair(data((9, 9), (0.2, 0.4), 0.01, profile="fillet"))


def test_protocol_says_every_position():
    gear = gear_pair(data((12, 30), (0.3, 0.0), 0.01, profile="rack"))
    for k in range(len(gear.generating.labels)):
        said = list(sentences(gear.generating, k, lambda metres: metres * 4e3))
        assert all("{" not in text and text.endswith(".") for text in said)
