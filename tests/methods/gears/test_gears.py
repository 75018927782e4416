"""Gear pair against mpmath, the parametric involute, shapely, and the printed values of manual 000."""

import csv
from math import degrees, inf, radians
from pathlib import Path
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
from hypothesis import given, strategies as st
from shapely import LineString, Polygon

from tmm_sheets.construction.protocol import sentences
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears.gear_engagement import unrolled
from tmm_sheets.methods.gears.gear_formulas import FILLET, inverse_involute, involute
from tmm_sheets.methods.gears.gear_pair import gear_pair

MANUALS = Path(__file__).parents[2] / "manuals"


def data(teeth=(14, 28), shift=(3 / 17, 0.0), module=0.0035, driver=1, sense="clockwise", clearance=0.25, addendum=1.0,
         profile="fillet", mesh="external", centre_distance=None):
    return SimpleNamespace(teeth=teeth, shift=shift, module=module, pressure_angle=radians(20), addendum=addendum,
                           clearance=clearance, driver=driver, sense=sense, profile=profile, mesh=mesh,
                           centre_distance=centre_distance)


PAIRS = [
    data(),
    data((12, 20), (0.5, 0.5), 0.01),
    data((10, 20), (0.5, 0.5), 0.01, driver=2),
    data((60, 11), (-0.2, 0.5), 0.002, sense="counter-clockwise"),
    data((30, 30), (0.0, 0.0), 0.005, driver=2, sense="counter-clockwise"),
    data((17, 45), (0.8, -0.5), 0.003),
]


def rows(name):
    lines = (MANUALS / name).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def told(gear):
    """Results as numbers."""
    return {key: leaf.value for key, leaf in gear.results().items()}


def truth(d, digits=50):
    """GOST 16532 in ``digits`` digits, written from the standard's formulas alone; lengths in millimetres."""
    with mpmath.workdps(digits):
        m, alpha = mpmath.mpf(d.module) * 1000, mpmath.mpf(d.pressure_angle)
        z, x = [mpmath.mpf(v) for v in d.teeth], [mpmath.mpf(v) for v in d.shift]
        def inv(a):
            return mpmath.tan(a) - a
        target = inv(alpha) + 2 * sum(x) * mpmath.tan(alpha) / sum(z)
        aw = mpmath.findroot(lambda a: inv(a) - target, alpha)
        a_w = m * sum(z) / 2 * mpmath.cos(alpha) / mpmath.cos(aw)
        y = (a_w - m * sum(z) / 2) / m
        dy = sum(x) - y
        out = {"alpha_w": aw, "a_w": a_w, "y": y, "dy": dy, "p": mpmath.pi * m, "pb": mpmath.pi * m * mpmath.cos(alpha)}
        tangents = []
        for i in (0, 1):
            r = m * z[i] / 2
            ra = r + m * (d.addendum + x[i] - dy)
            s = m * (mpmath.pi / 2 + 2 * x[i] * mpmath.tan(alpha))
            alpha_a = mpmath.acos(r * mpmath.cos(alpha) / ra)
            tangents.append(mpmath.tan(alpha_a))
            values = {
                "r": r, "rb": r * mpmath.cos(alpha), "rw": a_w * z[i] / sum(z), "ra": ra,
                "rf": r - m * (d.addendum + d.clearance - x[i]), "s": s, "s_chord": 2 * r * mpmath.sin(s / (2 * r)),
                "p_chord": 2 * r * mpmath.sin(mpmath.pi / z[i]),
                "sa": 2 * ra * (s / (2 * r) + inv(alpha) - inv(alpha_a)), "tau": 2 * mpmath.pi / z[i],
            }
            out |= {f"{key}{i + 1}": v for key, v in values.items()}
        eps = sum(z[i] * tangents[i] for i in (0, 1)) - sum(z) * mpmath.tan(aw)
        out["eps_alpha"] = eps / (2 * mpmath.pi)
        for i in (0, 1):
            out[f"phi_alpha{i + 1}"] = out["eps_alpha"] * out[f"tau{i + 1}"]
            # lowest point in contact: the mate's tip on the line of action
            mate = z[1 - i] * tangents[1 - i] * m / 2 * mpmath.cos(alpha)
            out[f"r_low{i + 1}"] = mpmath.hypot(out[f"rb{i + 1}"], a_w * mpmath.sin(aw) - mate)
        return out


@pytest.mark.parametrize("d", PAIRS)
def test_values_of_gost_16532(d):
    exact, got = truth(d), told(gear_pair(d))
    scale = float(exact["a_w"])
    for key, value in exact.items():
        # differences of large lengths (y, dy) are known to rounding of the lengths they come from
        size = max(abs(float(value)), scale / (d.module * 1e3) if key in ("y", "dy") else 0.0)
        assert abs(got[key] - float(value)) <= 2e-14 * size, key


def test_textbook_pair_12_20():
    got = told(gear_pair(data((12, 20), (0.5, 0.5), 0.01)))
    assert got["a_w"] == pytest.approx(168.5322, abs=5e-5)
    assert degrees(got["alpha_w"]) == pytest.approx(26.8592, abs=5e-5)
    assert got["y"] == pytest.approx(0.8532, abs=5e-5)
    assert got["dy"] == pytest.approx(0.1468, abs=5e-5)
    assert (2 * got["ra1"], 2 * got["ra2"]) == pytest.approx((147.0644, 227.0644), abs=5e-5)
    assert (2 * got["rf1"], 2 * got["rf2"]) == pytest.approx((105, 185), abs=1e-12)
    assert got["eps_alpha"] == pytest.approx(1.1779, abs=5e-5)
    assert got["a_w"] - got["ra1"] - got["rf2"] == pytest.approx(2.5, abs=1e-12)


def test_printed_values_of_the_manual():
    got = told(gear_pair(data()))
    got["inv_w"] = involute(got["alpha_w"])
    compared = 0
    for row in rows("gear_values.csv"):
        if row["tolerance"]:
            value = degrees(got[row["symbol"]]) if row["unit"] == "deg" else got[row["symbol"]]
            # a last digit of five, rounded down by the manual, is not a binary fraction
            assert abs(value - float(row["printed"])) <= float(row["tolerance"]) + 1e-12, row["symbol"]
            compared += 1
    assert compared == 25


def test_printed_involute_table():
    """Appendix 5 holds to one unit of its last digit; the inverse recovers the angle from it."""
    compared = 0
    for row in rows("gear_involute_table.csv"):
        for degree in range(17, 31):
            if row[str(degree)]:
                angle = radians(degree + int(row["minute"]) / 60)
                assert abs(involute(angle) - float(row[str(degree)])) < 1e-6
                compared += 1
    assert compared == 60 * 14 - 9


@given(st.floats(min_value=1e-3, max_value=1.5))
def test_inverse_involute(angle):
    with mpmath.workdps(40):
        value = involute(angle)
        root = mpmath.findroot(lambda a: mpmath.tan(a) - a - mpmath.mpf(value), mpmath.mpf(angle))
    # the function itself is known to rounding of its angle: an error of one unit there is divided by tan^2
    assert abs(inverse_involute(value) - float(root)) <= 4e-16 * angle / np.tan(angle) ** 2 + 4e-16 * angle


def test_inverse_involute_at_its_ends():
    assert inverse_involute(0.0) == 0.0
    assert np.isnan(inverse_involute(-1e-9))


@pytest.mark.parametrize("d", PAIRS)
def test_line_of_action(d):
    """N1, A, P_w, B, N2 stand in one line in the order of the contact's way; radii and angles agree with the formulas."""
    gear = gear_pair(d)
    p = {name: complex(gear.engagement[name].value) for name in ("N1", "N2", "A", "B", "Pw", "O1", "O2")}
    one, two = gear.wheels
    u = (p["N2"] - p["N1"]) / abs(p["N2"] - p["N1"])
    tiny = 1e-15
    along = {name: (v * u.conjugate()).real for name, v in p.items()}
    for name in ("N1", "N2", "A", "B", "Pw"):
        assert abs((p[name] * u.conjugate()).imag) < tiny
    order = ["N1", "A", "Pw", "B", "N2"] if d.driver == 1 else ["N1", "B", "Pw", "A", "N2"]
    assert [along[k] for k in order] == sorted(along[k] for k in order)
    assert abs(p["A"] - p["B"]) == pytest.approx(gear.g_alpha, abs=tiny)
    tips = (abs(p["A"] - p["O2"]) - two.ra, abs(p["B"] - p["O1"]) - one.ra)
    if d.driver == 2:
        tips = (abs(p["A"] - p["O1"]) - one.ra, abs(p["B"] - p["O2"]) - two.ra)
    assert max(map(abs, tips)) < tiny
    assert gear.engagement["alpha_w"].value == pytest.approx(gear.alpha_w, abs=1e-14)
    for i, w in enumerate(gear.wheels, 1):
        assert gear.engagement[f"phi{i}"].value == pytest.approx(w.phi_alpha, abs=1e-13)
        assert gear.engagement[f"eps{i}"].value == pytest.approx(gear.eps_alpha, abs=1e-12)
    # the driver's flank pushes in the sense of its motion: contact moves with the pole's points
    motion = -1 if d.sense == "clockwise" else 1
    assert np.sign((p["B"] - p["A"]).real) == motion


def rolled_radius(wheel, centre, foot, length):
    """Direction of the base circle's radius to the rolling line and sense of rolling; the involute passes through the pole."""
    sense = np.sign((np.conj(foot - centre) * (-centre)).imag)
    start = np.angle(foot - centre) + sense * wheel.t_pole / wheel.rb
    return np.exp(1j * (start - sense * length / wheel.rb)), sense


def parametric(wheel, centre, foot, length):
    """Involute by its equation: radius and, at right angles to it, the length unrolled."""
    radius, sense = rolled_radius(wheel, centre, foot, length)
    return centre + radius * (wheel.rb + 1j * sense * length)


@pytest.mark.parametrize("d", PAIRS)
def test_unrolled_involute_is_the_parametric_one(d):
    gear = gear_pair(d)
    for w in gear.wheels:
        centre, foot = (complex(gear.engagement[f"{k}{w.number}"].value) for k in "ON")
        plan = gear.involute(w)
        parts = gear.parts(w)
        numbers = gear.divisions(w)
        lengths = np.array(numbers) * w.t_pole / parts
        points = np.array([plan[f"E{k}"].value for k in numbers])
        assert np.abs(points - parametric(w, centre, foot, lengths)).max() < 1e-15 + 1e-14 * w.ra
        assert abs(points[parts]) < 1e-16 + 1e-15 * w.ra
        # the smooth curve is made of the same steps
        fine = np.sqrt(np.linspace(0, w.t_tip**2, 40))
        assert np.abs(gear.smooth_involute(w)["Ek"].value - parametric(w, centre, foot, fine)).max() < 1e-15 + 1e-14 * w.ra
        # it reaches the tip, with two divisions beyond N at least
        assert lengths[-1] >= w.t_tip - 1e-15
        assert len(lengths) >= parts + 3
        # equal arcs on the base circle, tangents at right angles to the radii
        base = np.array([plan[f"{k}′"].value for k in numbers])
        assert np.abs(np.abs(base - centre) - w.rb).max() < 1e-15 + 1e-15 * w.ra
        string = points[1:] - base[1:]
        assert np.abs(np.real(string * np.conj(base[1:] - centre))).max() < 1e-15 * w.ra


def test_parts_are_15_to_25_mm_in_the_example():
    gear = gear_pair(data())
    assert gear.picture_scale().mu == 0.00025
    for w, parts in zip(gear.wheels, (2, 4), strict=True):
        assert gear.parts(w) == parts
        assert 15 <= w.t_pole * 4e3 / parts <= 25


@pytest.mark.parametrize("d", PAIRS)
def test_profiles_touch_along_the_active_line(d):
    """At a dozen of phases both flanks go through one point of AB and have one tangent there: 1e-9 mm."""
    gear = gear_pair(d)
    u = gear.engagement["N1N2"].value
    a, b = ((np.conj(u) * gear.engagement[k].value).real for k in "AB")
    for travel in np.linspace(a, b, 12):
        contact = travel * u
        tangents = []
        for w, way in zip(gear.wheels, (1, -1), strict=True):
            centre, foot = (complex(gear.engagement[f"{k}{w.number}"].value) for k in "ON")
            length = w.t_pole + way * travel
            assert abs(gear.rolled(w, parametric(w, centre, foot, length), travel) - contact) < 1e-12
            assert w.t_low - 1e-15 <= length <= w.t_tip + 1e-15
            radius, _ = rolled_radius(w, centre, foot, length)
            tangents.append(complex(gear.rolled(w, centre + radius, travel) - centre))
            # and the drawn flank is that involute
            assert abs(gear.rolled(w, unrolled(centre, foot, 0j, length), travel) - contact) < 1e-12
        assert abs((tangents[0] * np.conj(u)).real) < 1e-13
        assert abs((tangents[0] * np.conj(tangents[1])).imag) < 1e-13


def polygon(gear, wheel, points):
    closed = np.append(points, gear.engagement[f"O{wheel.number}"].value) * 1e3
    return Polygon(np.column_stack((closed.real, closed.imag)))


def meshing(gear, travel, step=5e-5):
    shapes = [gear.rolled(w, gear.shape(w).outline(-2, 2, step=step), travel) for w in gear.wheels]
    return [polygon(gear, w, s) for w, s in zip(gear.wheels, shapes, strict=True)]


def chord_error(gear, wheel):
    """Greatest distance of the drawn flank's chords from the involute, mm: exact curve at the middles of the chords."""
    centre, foot = (complex(gear.engagement[f"{k}{wheel.number}"].value) for k in "ON")
    t = np.sqrt(np.linspace(wheel.t_fillet**2, wheel.t_tip**2, 32))
    ends = unrolled(centre, foot, 0j, t)
    between = np.sqrt(t[:-1, None] ** 2 + np.linspace(0, 1, 9)[None, 1:-1] * (t[1:, None] ** 2 - t[:-1, None] ** 2))
    fine = unrolled(centre, foot, 0j, between)
    chord = np.diff(ends)[:, None]
    return float(np.abs(((fine - ends[:-1, None]) * np.conj(chord)).imag / np.abs(chord)).max()) * 1e3


@pytest.mark.parametrize("d", PAIRS)
def test_teeth_nowhere_overlap(d):
    """The drawn outlines of five teeth of each wheel share no area at any phase and touch within their chords' error."""
    gear = gear_pair(d)
    play = sum(chord_error(gear, w) for w in gear.wheels)
    assert play < 2e-3 * d.module * 1e3
    for travel in np.linspace(-gear.g_alpha, gear.g_alpha, 13):
        first, second = meshing(gear, travel)
        assert first.is_valid
        assert second.is_valid
        assert first.intersection(second).area < 1e-12
        assert first.distance(second) <= play
    # the test can fail: turned by a hundredth of a millimetre the teeth do overlap
    first, _ = meshing(gear, 1e-5)
    _, second = meshing(gear, 0.0)
    assert first.intersection(second).area > 1e-4


def assert_smooth_root(gear, w):
    """The fillet touches the root circle and the flank, radial below the base circle or the involute itself."""
    tooth = gear.tooth(w)
    centre = complex(gear.engagement[f"O{w.number}"].value)
    q, c, r = (complex(tooth[k].value) for k in "QCR")
    tiny = 1e-14 * w.ra
    assert abs(abs(c - q) - w.fillet) < tiny
    assert abs(abs(c - r) - w.fillet) < tiny
    assert abs(abs(r - centre) - w.rf) < tiny
    assert abs(abs(c - centre) - w.rf - w.fillet) < tiny
    if w.t_fillet > 0:
        foot = complex(gear.engagement[f"N{w.number}"].value)
        assert abs(parametric(w, centre, foot, w.t_fillet) - q) < tiny
        direction, _ = rolled_radius(w, centre, foot, w.t_fillet)  # an involute's tangent is parallel to that radius
    else:
        begin = complex(tooth["G"].value)
        assert abs(abs(begin - centre) - w.rb) < tiny
        assert abs(((q - centre) * np.conj(begin - centre)).imag) < tiny * w.rb
        assert abs(q - centre) <= w.rb + tiny
        direction = (begin - centre) / abs(begin - centre)
    assert abs(((c - q) * np.conj(direction)).real) < tiny


@pytest.mark.parametrize("d", PAIRS)
def test_fillets_are_tangent(d):
    gear = gear_pair(d)
    for w in gear.wheels:
        assert w.fillet == pytest.approx(FILLET * d.module, rel=1e-15)
        assert_smooth_root(gear, w)


@pytest.mark.parametrize("d", PAIRS)
def test_tooth_is_as_thick_as_the_standard_says(d):
    """Chord between the flanks on the pitch circle, width of the tip, symmetry about the axis."""
    gear = gear_pair(d)
    for w in gear.wheels:
        tooth, shape = gear.tooth(w), gear.shape(w)
        assert abs(tooth["E"].value - tooth["F"].value) == pytest.approx(w.s_chord, rel=1e-13)
        tip = np.angle((shape.flank[-1] - shape.centre) / shape.axis)
        assert 2 * abs(tip) * w.ra == pytest.approx(w.sa, rel=1e-11)
        assert np.abs(np.abs(shape.other_flank() - shape.centre) - np.abs(shape.flank - shape.centre)).max() < 1e-15
        nearest = np.abs(shape.other_flank() - tooth["F"].value).min()
        assert nearest < 0.1 * d.module


def test_sliding_table_of_the_manual():
    plan = gear_pair(data()).sliding
    reading = 0.5
    for k, row in enumerate(rows("gear_sliding.csv")):
        y = [float(plan[name].value[k]) for name in ("yV1", "yV2")]
        for value, name in zip(y, ("yV1", "yV2"), strict=True):
            assert abs(value - float(row[name])) <= reading + 1e-9
        for i, (own, other) in enumerate((y, y[::-1]), 1):
            if row[f"theta{i}"]:
                allowed = 0.005 + reading / own + reading * other / own**2
                assert abs(plan[f"theta{i}"].value[k] - float(row[f"theta{i}"])) <= allowed
    assert plan["yV1"].value[3] == plan["yV2"].value[3] == 25
    assert plan["theta1"].value[0] == -inf
    assert plan["theta2"].value[-1] == -inf
    assert plan["theta1"].value[3] == 0


@pytest.mark.parametrize("d", PAIRS)
def test_sliding_from_the_velocities(d):
    """Speeds along the profiles are omega times the distance from the feet; sliding from them, not from ordinates."""
    gear = gear_pair(d)
    share = np.linspace(-0.9, 0.9, 19)
    plan = gear.sliding_curve(share)
    one, two = gear.wheels
    at = np.where(share < 0, share * one.t_pole, share * two.t_pole)
    v1, v2 = (one.t_pole + at) / one.teeth, (two.t_pole - at) / two.teeth
    assert plan["theta1"].value == pytest.approx(1 - v2 / v1, rel=1e-12, abs=1e-12)
    assert plan["theta2"].value == pytest.approx(1 - v1 / v2, rel=1e-12, abs=1e-12)
    worst = [1 - (two.t_tip / two.teeth) / (one.t_low / one.teeth), 1 - (one.t_tip / one.teeth) / (two.t_low / two.teeth)]
    assert gear.greatest_sliding == pytest.approx(worst, rel=1e-10)


@pytest.mark.parametrize(("d", "said", "hint"), [
    (data((8, 20), (0, 0)), "z1 = 8 with x1 = 0 is undercut", "least shift is x1 = 0.53"),
    (data((12, 14), (0.3, 0)), "z2 = 14 with x2 = 0 is undercut", "least shift is x2 = 0.18"),
    (data((10, 20), (0.9, 0.0)), "wheel 1 (z1 = 10, x1 = 0.9) is pointed", "smaller x1"),
    (data((10, 40), (1.4, 0.0)), "impossible", "smaller x1"),
    (data((20, 20), (3, 3)), "contact ratio", "smaller shifts"),
    (data((20, 20), (-2.0, -2.0)), "inv alpha_w", "larger shifts"),
    (data((60, 60), (0, 0), addendum=6.0), "interference", "x1"),
])
def test_refusals(d, said, hint):
    with pytest.raises(CannotBuild) as refusal:
        gear_pair(d)
    assert said in str(refusal.value)
    assert hint in str(refusal.value)


def test_all_problems_are_told_at_once():
    with pytest.raises(CannotBuild, match=r"z1 = 8 .*; z2 = 9 "):
        gear_pair(data((8, 9), (0, 0)))


def test_least_shift_of_the_manual_is_accepted():
    """x = (17 - z)/17, exact or written with four decimals; a hundredth less is refused."""
    for z in range(10, 17):
        x = (17 - z) / 17
        assert gear_pair(data((z, 30), (x, 0))).wheels[0].least_shift == pytest.approx(x)
        gear_pair(data((z, 30), (round(x, 4), 0)))
        with pytest.raises(CannotBuild, match="undercut"):
            gear_pair(data((z, 30), (x - 0.01, 0)))


@given(
    z=st.tuples(st.integers(10, 60), st.integers(10, 60)),
    x=st.tuples(st.floats(-0.5, 1.0), st.floats(-0.5, 1.0)),
    driver=st.sampled_from((1, 2)),
    sense=st.sampled_from(("clockwise", "counter-clockwise")),
)
def test_builds_or_refuses(z, x, driver, sense):
    """Whatever the tooth numbers and shifts: a whole drawing or a refusal, never garbage."""
    try:
        gear = gear_pair(data(z, x, driver=driver, sense=sense))
    except CannotBuild:
        return
    assert gear.eps_alpha >= 1
    for w in gear.wheels:
        assert w.sa >= 0.2 * gear.m
        assert w.rf < w.r_low < w.ra
        # the mate's tip stays clear of the fillet
        assert w.t_fillet <= w.t_low
        assert_smooth_root(gear, w)
        outline = gear.shape(w).outline(-1, 1)
        assert LineString(np.column_stack((outline.real, outline.imag)) * 1e3).is_simple
    for travel in (-gear.g_alpha / 2, 0.0, gear.g_alpha / 3):
        first, second = meshing(gear, travel, step=2e-4)
        assert first.is_valid
        assert second.is_valid
        assert first.intersection(second).area < 1e-12
    assert gear.engagement.check() is None
    assert gear.sliding.check() is None


def test_nothing_is_computed_before_it_is_read():
    gear = gear_pair(data())
    assert not any(step.evaluated for step in gear.engagement)
    assert np.isfinite(gear.sliding["yV1"].value).all()
    assert gear.engagement["N1"].evaluated
    assert not gear.engagement["A"].evaluated
    assert not gear.engagement["phi1"].evaluated
    assert not gear.sliding["theta1"].evaluated


def test_protocol_says_every_step():
    gear = gear_pair(data())
    said = {}
    for plan in (gear.engagement, *map(gear.involute, gear.wheels), *map(gear.tooth, gear.wheels), gear.sliding):
        said[plan.name] = [list(sentences(plan, k, lambda metres: metres * 4e3)) for k in range(len(plan.labels))]
    assert list(said) == ["gear-engagement", "gear-involute-1", "gear-involute-2", "gear-tooth-1", "gear-tooth-2", "gear-sliding"]
    for positions in said.values():
        for texts in positions:
            assert all("{" not in text and text.endswith(".") for text in texts)
    assert any("296,4 мм" in text for text in said["gear-engagement"][0])


def test_results_hold_the_keys_of_the_contract():
    got = told(gear_pair(data()))
    pairs = ("z", "x", "r", "rb", "rw", "ra", "rf", "s", "sa", "theta")
    keys = {"m", "alpha_w", "a_w", "y", "dy", "p", "eps_alpha"} | {f"{key}{i}" for key in pairs for i in (1, 2)}
    assert keys <= set(got)
    assert np.isinf(got["theta1"][0])
    assert got["theta1_greatest"] == pytest.approx(-6.597, abs=5e-4)
    assert got["rb1"] < got["r_low1"] < got["ra1"]
