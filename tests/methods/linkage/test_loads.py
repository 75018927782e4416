"""Technological loads against the slider-crank in closed form: the way, the strokes, the diagrams, the sides of jumps.

The crank (0.1 m, counter-clockwise from the x axis) and the rod (0.35 m) lie in line at 0 and at pi; the slider goes to and fro
between 0.25 m and 0.45 m. Everything that is asked of a load follows from that: no plans, no strokes found from velocities.
"""

from math import acos, asin, cos, pi, radians, sin

import numpy as np
import pytest

from tests.project_files import EVEN, FORCE, SLIDER, merged, project, write
from tmm_sheets.__main__ import run
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.linkage.loads import curve_of, distinct, swing_done

R, ROD = 0.1, 0.35

BASE = merged(SLIDER, EVEN, {"group[1].length": f"{ROD} m", "points.D": ["0.3 m", "0 m"]})
CLOCKWISE = {"crank.sense": "clockwise"}
SHORT = {"group[1].length": "0.08 m"}
TWO_TURNS = {"cycle.turns": 2}


def forced(*changes, **law):
    return project(BASE, {"force": [{"name": "F3", "link": "3", "point": "B", "direction": "against motion"} | law]}, *changes)


def force(*changes, **law):
    return forced(*changes, **law).applied[0]


def moment(link, *changes, **law):
    return project(BASE, {"moment": [{"name": "M", "link": link, "direction": "against motion"} | law]}, *changes).applied[0]


def outward(phi):
    """The slider's way from its inner dead point, as a fraction."""
    phi = np.asarray(phi)
    return (R * np.cos(phi) + np.sqrt(ROD**2 - (R * np.sin(phi)) ** 2) - (ROD - R)) / (2 * R)


def angle_of(fraction):
    """Crank angle in (0, pi) where the slider is at that fraction: law of cosines in the triangle O, A, B."""
    x = ROD - R + 2 * R * fraction
    return acos((R**2 + x**2 - ROD**2) / (2 * R * x))


TURN = np.linspace(0, 2 * pi, 97) + 0.01
IN = np.sin(TURN) > 0
"""The slider goes inwards (against +x) while the crank is above."""


# --- strokes and signs -----------------------------------------------------------------------------------------------


def test_constant_on_the_working_stroke():
    f = force(stroke="working", sense="+x", value="500 N")
    assert f.toward == 1
    np.testing.assert_array_equal(f.vector(TURN), np.where(IN, 0, -500))
    np.testing.assert_array_equal(f.magnitude(TURN), np.where(IN, 0, 500))
    assert f.jumps == pytest.approx((0, pi), abs=1e-13)


@pytest.mark.parametrize("sense", ["+x", "-x"])
@pytest.mark.parametrize("stroke", ["working", "idle", "both"])
@pytest.mark.parametrize(("direction", "sign"), [("against motion", -1), ("along motion", 1)])
def test_signs_follow_the_motion(sense, stroke, direction, sign):
    f = force(stroke=stroke, sense=sense, value="500 N", direction=direction)
    working = ~IN if sense == "+x" else IN
    acts = {"working": working, "idle": ~working, "both": working | True}[stroke]
    np.testing.assert_array_equal(f.vector(TURN), np.where(acts, sign * 500 * np.where(IN, -1, 1), 0))


@pytest.mark.parametrize(("sense", "way"), [("+x", 30), ("-x", 210), ("+y", 30), ("-y", 210)])
def test_on_an_inclined_guide_the_force_is_along_the_guide(sense, way):
    """The axis only tells which way is meant: along x it would do cos 30 deg of the work of the stroke."""
    f = force({"guide[1].direction": "30 deg"}, stroke="working", sense=sense, value="500 N")
    assert f.toward == pytest.approx(complex(cos(radians(way)), sin(radians(way))), abs=1e-15)


def test_across_its_guide_a_point_has_no_strokes():
    with pytest.raises(CannotBuild, match="does not move to and fro that way"):
        force(sense="+y", value="500 N")


def test_off_a_guide_the_force_is_along_the_axis():
    """A point of the rod moves along a curve: of its direction the axis is all that is told."""
    f = force(link="2", point="A", sense="+y", value="500 N")
    assert f.toward == 1j


def test_fixed_direction_whatever_the_motion():
    f = force(stroke="both", sense="+x", value="500 N", direction="-90 deg")
    np.testing.assert_array_equal(f.vector(TURN), -500j)


def test_clockwise_and_another_beginning():
    f = force(CLOCKWISE, {"cycle.start": "30 deg"}, stroke="working", sense="+x", value="500 N")
    # Turned clockwise from 30 degrees: the crank is below from 30 to 210 degrees turned, the slider goes inwards then.
    below = np.sin(pi / 6 - TURN) < 0
    np.testing.assert_array_equal(f.magnitude(TURN), np.where(below, 0, 500))
    assert f.jumps == pytest.approx((pi / 6, pi * 7 / 6), abs=1e-13)


@pytest.mark.parametrize("swing", [0.5, pi, 5.2])
@pytest.mark.parametrize("sense", [1, -1])
def test_the_part_of_a_swing_that_is_done(swing, sense):
    """From its end anywhere, a hair beyond either end, and of more than two thirds of a turn."""
    done = np.array([-1e-12, 0.0, 0.25, 0.5, 0.9, 1.0, 1.0 + 1e-12])
    for low in (-3.0, 0.0, 3.0):
        found = swing_done(np.exp(1j * sense * (low + done * swing)), sense, low, swing)
        assert found == pytest.approx(np.clip(done, 0, 1), abs=1e-11)


def test_sides_of_a_dead_point():
    """A resistance has no value in a dead point itself, and its value before or after it when asked from a side."""
    f = force(stroke="working", sense="+x", value="500 N")
    at = np.array([0, pi, 2 * pi, 3 * pi])
    np.testing.assert_array_equal(f.magnitude(at), 0)
    np.testing.assert_array_equal(f.magnitude(at, -1), [500, 0, 500, 0])
    np.testing.assert_array_equal(f.magnitude(at, 1), [0, 500, 0, 500])


@pytest.mark.parametrize(("law", "at", "jump"), [
    ({"stroke": "working", "sense": "+x"}, 1.0, None), ({"stroke": "working", "sense": "+x"}, pi, (0.0, 500.0, 0.0)),
    ({"stroke": "working", "sense": "+x"}, 0.0, (500.0, 0.0, 0.0)), ({"sense": "+x"}, pi, (500.0, -500.0, 0.0)),
    ({"sense": "+x"}, pi + 0.01, None),
    ({"direction": "0 deg"}, pi, None)], ids=["on a stroke", "begins", "ends", "turns over", "beside", "steady"])
def test_a_load_that_jumps_where_forces_are_asked_for_tells_it(law, at, jump):
    assert force(value="500 N", **law).jump(at) == jump


def test_sense_along_a_guide_and_unknown_sense():
    np.testing.assert_array_equal(force(stroke="working", sense="-x", value="1 N").vector(TURN),
                                  force(stroke="idle", sense="+x", value="1 N").vector(TURN))
    with pytest.raises(CannotBuild, match='unknown sense "\\+z"'):
        force(sense="+z", value="1 N")
    with pytest.raises(CannotBuild, match="which way are its working strokes"):
        force(value="1 N")


def test_a_force_across_the_path_has_no_strokes():
    with pytest.raises(CannotBuild, match="B does not move to and fro that way"):
        force(sense="+y", value="1 N")


def test_a_mechanism_that_does_not_assemble_is_named():
    for law in ({"value": "1 N"}, {"stroke": "idle", "table": [[0, "0 N"], [1, "1 N"]]}):
        with pytest.raises(CannotBuild, match="rod AB = 80 mm is 20 mm too short"):
            force(SHORT, sense="+x", **law)
    with pytest.raises(CannotBuild, match="rod AB = 80 mm is 20 mm too short"):
        moment("2", SHORT, value="1 N m")


def test_positions_of_a_mechanism_that_does_not_assemble_need_no_loads(tmp_path, capsys):
    """Asked angle by angle, what cannot be built is null; the forces that cannot be known are not asked for."""
    file = write(tmp_path, BASE, FORCE, CLOCKWISE, SHORT)
    assert run(["solve", file, "--phi", "0,90", "--part", "positions", "--json", "-"]) == 0
    assert '"B": [[0.18, 0.0], [null, null]]' in capsys.readouterr().out


# --- diagrams over the way -------------------------------------------------------------------------------------------


def test_straight_diagram_over_the_way():
    f = force(stroke="working", sense="+x", table=[[0, "0 N"], [0.25, "100 N"], [1, "1000 N"]])
    expected = np.where(IN, 0, np.interp(outward(TURN), [0, 0.25, 1], [0, 100, 1000]))
    np.testing.assert_allclose(f.magnitude(TURN), expected, rtol=1e-12, atol=1e-9)


def test_the_way_is_counted_from_where_the_working_strokes_begin():
    f = force(sense="-x", table=[[0, "0 N"], [1, "1000 N"]])
    np.testing.assert_allclose(f.magnitude(TURN), 1000 * (1 - outward(TURN)), rtol=1e-12, atol=1e-9)


def test_work_of_a_diagram_is_the_area_under_it():
    """Over the working stroke of 0.2 m: 1000 N * 0.2 m * (0.25 * 0.1 / 2 + 0.75 * 1.1 / 2)."""
    p = forced(stroke="working", sense="+x", table=[[0, "0 N"], [0.25, "100 N"], [1, "1000 N"]])
    x, w = np.polynomial.legendre.leggauss(40)
    corner = 2 * pi - angle_of(0.25)
    work = sum((p.reduced.moment((a + b) / 2 + (b - a) / 2 * x) * w).sum() * (b - a) / 2
               for a, b in ((0, pi), (pi, corner), (corner, 2 * pi)))
    assert work == pytest.approx(-1000 * 0.2 * (0.25 * 0.1 / 2 + 0.75 * 1.1 / 2), rel=1e-12)


def test_a_jump_of_the_diagram_has_two_sides_on_each_stroke():
    f = force(sense="+x", table=[[0, "100 N"], [0.3, "100 N"], [0.3, "700 N"], [1, "700 N"]])
    back, forth = angle_of(0.3), 2 * pi - angle_of(0.3)
    assert f.jumps == pytest.approx((0, back, pi, forth), abs=1e-13)
    at = np.array([back, forth])
    np.testing.assert_array_equal(f.magnitude(at, -1), [700, 100])
    np.testing.assert_array_equal(f.magnitude(at, 1), [100, 700])
    np.testing.assert_array_equal(f.magnitude(at + 1e-9), [100, 700])
    np.testing.assert_array_equal(f.magnitude(at - 1e-9), [700, 100])


def test_smooth_diagram_over_the_way():
    """Through its points, between its neighbours, without a corner."""
    x, y = [0, 0.2, 0.5, 1], [0, 100, 700, 1000]
    f = force(stroke="working", sense="+x", curve="smooth", table=[[a, f"{b} N"] for a, b in zip(x, y, strict=True)])
    at = np.array([2 * pi - angle_of(a) for a in (0.2, 0.5)])
    np.testing.assert_allclose(f.magnitude(at), [100, 700], rtol=1e-12)
    h = 1e-5
    left, right = (f.magnitude(at) - f.magnitude(at - h)) / h, (f.magnitude(at + h) - f.magnitude(at)) / h
    np.testing.assert_allclose(left, right, rtol=1e-3)
    rising = f.magnitude(np.linspace(pi, 2 * pi, 400)[1:-1])
    assert (np.diff(rising) > 0).all()


def test_a_smooth_diagram_is_that_of_the_docs():
    """Chords of slopes 400 and 800 over 1/4 and 3/4 of the way: 3/(1.75/400 + 1.25/800) = 9600/19 in the middle point."""
    f = force(stroke="working", sense="+x", curve="smooth", table=[[0, "0 N"], [0.25, "100 N"], [1, "700 N"]])
    at = np.array([2 * pi - angle_of(x) for x in (0.125, 0.625)])
    m = 9600 / 19
    np.testing.assert_allclose(f.magnitude(at), [50 + (400 - m) * 0.25 / 8, 400 + (m - 800) * 0.75 / 8], rtol=1e-12)


# --- limits of the action --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("begin", "end"), [(0.2, 0.9), (0.0, 0.4), (0.6, 1.0), (0.001, 0.999), (0.0, 1.0)])
def test_limits_of_the_action(begin, end):
    f = force({"force[1].from": begin, "force[1].to": end}, sense="+x", value="500 N")
    # Inwards (0 to pi) the way is passed backwards.
    inwards = [0 if end == 1 else angle_of(end), pi if begin == 0 else angle_of(begin)]
    outwards = [2 * pi - t for t in reversed(inwards)]
    for (a, b), sign in ((inwards, 1), (outwards, -1)):
        near = 1e-10  # as near to the ends as one likes, also at a dead point, where the way stands still
        np.testing.assert_array_equal(f.vector(np.linspace(a + near, b - near, 9)), 500 * sign)
        np.testing.assert_array_equal(f.vector(np.array([a]), 1), 500 * sign)
        np.testing.assert_array_equal(f.vector(np.array([b]), -1), 500 * sign)
    where = {0.0, *inwards, *outwards} - {2 * pi} if (end == 1) else {*inwards, *outwards}
    assert f.jumps == pytest.approx(sorted(where), abs=1e-13)
    outside = np.setdiff1d(np.round(TURN, 6), [])
    acts = (outward(outside) > begin) & (outward(outside) < end)
    np.testing.assert_array_equal(f.magnitude(outside), np.where(acts, 500, 0))


def test_limits_and_a_diagram():
    """The diagram goes on counting from the beginning of the stroke, not from where the action begins."""
    f = force({"force[1].from": 0.5}, stroke="working", sense="+x", table=[[0, "0 N"], [1, "1000 N"]])
    x = outward(TURN)
    np.testing.assert_allclose(f.magnitude(TURN), np.where(~IN & (x > 0.5), 1000 * x, 0), rtol=1e-12)
    start = 2 * pi - angle_of(0.5)
    np.testing.assert_allclose([f.magnitude(start, -1), f.magnitude(start, 1)], [0, 500], atol=1e-9)


# --- one diagram for each stroke -------------------------------------------------------------------------------------

STROKES = {"sense": "-x", "bore": "0.1 m", "ambient": "0.1 MPa", "direction": "180 deg",
           "tables": [[[0, "4 MPa"], [1, "0.5 MPa"]], [[0, "0.15 MPa"], [1, "0.15 MPa"]], [],
                      [[0, "1.5 MPa"], [0.5, "0.3 MPa"], [1, "0.1 MPa"]]]}


def pressures(turned, first=0.0):
    """Excess pressure on the piston of a four-stroke engine; the first stroke begins at ``first``."""
    x = 1 - outward(turned)
    number = np.floor(np.mod(turned - first, 4 * pi) / pi).astype(int)
    mpa = np.choose(number, [4 - 3.5 * x, 0.15 + 0 * x, 0.1 + 0 * x, np.interp(x, [0, 0.5, 1], [1.5, 0.3, 0.1])])
    return (mpa - 0.1) * 1e6 * pi * 0.1**2 / 4


@pytest.mark.parametrize("first", [0, 360])
def test_one_diagram_for_each_stroke_of_two_turns(first):
    f = force(TWO_TURNS, **STROKES, first=f"{first} deg")
    turned = np.linspace(0, 4 * pi, 183) + 0.01
    np.testing.assert_allclose(f.law(turned, 0), pressures(turned, np.radians(first)), rtol=1e-11, atol=1e-8)
    assert f.toward == -1
    *dead, corner = sorted(f.jumps, key=lambda t: abs(np.sin(t)) > 1e-9)
    assert dead == pytest.approx([0, pi, 2 * pi, 3 * pi], abs=1e-12)
    assert 1 - outward(corner) == pytest.approx(0.5, abs=1e-12), "the corner of the last stroke's diagram"


def test_pressures_act_in_dead_points_too():
    f = force(TWO_TURNS, **STROKES)
    at = np.arange(5) * pi
    area = pi * 0.1**2 / 4 * 1e6
    np.testing.assert_allclose(f.law(at, 0), area * np.array([3.9, 0.05, 0, 0, 3.9]), rtol=1e-11, atol=1e-8)
    np.testing.assert_allclose(f.law(at, 1), f.law(at, 0), rtol=1e-11)
    np.testing.assert_allclose(f.law(at, -1), area * np.array([1.4, 0.4, 0.05, 0, 1.4]), rtol=1e-11, atol=1e-8)


def test_the_stroke_nearest_to_first_is_the_first_one():
    near = force(TWO_TURNS, **STROKES, first="-20 deg")
    late = force(TWO_TURNS, **STROKES, first="350 deg")
    turned = np.linspace(0, 4 * pi, 50) + 0.01
    np.testing.assert_array_equal(near.law(turned, 0), force(TWO_TURNS, **STROKES).law(turned, 0))
    np.testing.assert_allclose(late.law(turned, 0), near.law(turned + 2 * pi, 0), rtol=1e-12, atol=1e-9)


# --- diagrams over the angle -----------------------------------------------------------------------------------------


def test_diagram_over_the_angle_is_periodic():
    f = force(TWO_TURNS, over="angle", table=[["30 deg", "100 N"], ["90 deg", "700 N"], ["300 deg", "40 N"]], direction="180 deg")
    x, y = np.radians([-60 - 360, 30, 90, 300, 30 + 720]), [40, 100, 700, 40, 100]
    turned = np.linspace(0.6, 4 * pi, 100)
    np.testing.assert_allclose(f.magnitude(turned), np.interp(turned, x, y), rtol=1e-13)
    np.testing.assert_allclose(f.magnitude(turned + 4 * pi), f.magnitude(turned), rtol=1e-12)
    # From the last point over the end of the cycle to the first: 40 N to 100 N in 450 degrees.
    assert f.magnitude(0.0) == pytest.approx(40 + 60 * 420 / 450, rel=1e-13)
    assert f.jumps == pytest.approx(np.radians([30, 90, 300]), abs=1e-13)


SAW = {"over": "angle", "table": [["0 deg", "100 N"], ["180 deg", "40 N"], ["180 deg", "70 N"], ["360 deg", "10 N"]]}


@pytest.mark.parametrize("curve", ["straight", "smooth"])
def test_jumps_over_the_angle_have_sides(curve):
    f = force(**SAW, curve=curve, direction="0 deg")
    at = np.array([0, pi, 2 * pi])
    np.testing.assert_array_equal(f.magnitude(at, 1), [100, 70, 100])
    np.testing.assert_array_equal(f.magnitude(at, -1), [10, 40, 10])
    np.testing.assert_array_equal(f.magnitude(at), [100, 70, 100])
    # Two straight pieces: a smooth curve is the same lines.
    np.testing.assert_allclose(f.magnitude(np.array([0.25, 0.75]) * 2 * pi), [70, 40], rtol=1e-13)
    np.testing.assert_allclose(f.magnitude(2 * pi - 1e-9), 10, rtol=1e-6)
    assert f.jumps == pytest.approx((0, pi), abs=1e-15)


def test_points_before_position_0_count_from_the_end():
    f = force(over="angle", table=[["-90 deg", "100 N"], ["0 deg", "0 N"], ["90 deg", "0 N"]], direction="0 deg")
    np.testing.assert_allclose(f.magnitude(np.radians([270, 315, 0, 45, 180])), [100, 50, 0, 0, 50], rtol=1e-13, atol=1e-13)
    assert f.jumps == pytest.approx((0, pi / 2, 3 * pi / 2), abs=1e-15)


def test_over_the_angle_needs_a_fixed_direction():
    with pytest.raises(CannotBuild, match="needs a fixed direction"):
        force(**SAW)
    with pytest.raises(CannotBuild, match="needs a fixed direction"):
        moment("2", over="angle", table=[["0 deg", "1 N m"]])


def test_smooth_curves_keep_to_their_points():
    """Between two points nothing is higher or lower than they are; on straight pieces the curve is straight."""
    rng = np.random.default_rng(0)
    for _ in range(50):
        x, y = np.sort(rng.uniform(0, 6, 6)), rng.uniform(-1, 1, 6)
        for period in (None, 7.0):
            curve = curve_of((x, y), True, period)
            np.testing.assert_allclose(curve(x), y, atol=1e-13)
            for k in range(5):
                t = np.linspace(x[k], x[k + 1], 20)
                low, high = sorted((y[k], y[k + 1]))
                assert ((curve(t) >= low - 1e-13) & (curve(t) <= high + 1e-13)).all()
    np.testing.assert_allclose(curve_of(([0, 1, 4], [0, 1, 4]), True)(np.linspace(0, 4, 9)), np.linspace(0, 4, 9), rtol=1e-14)


def test_smooth_curves_have_no_corner_at_the_end_of_the_period():
    curve = curve_of(([0, 1, 3, 5], [0, 2, 1, -1]), True, 6.0)
    h = 1e-6
    assert (curve(h) - curve(0.0)) / h == pytest.approx((curve(6.0) - curve(6.0 - h)) / h, rel=1e-4)


def test_curves_beyond_their_ends_and_at_double_ends():
    curve = curve_of(([1, 1, 2, 2], [5, 3, 4, 8]))
    np.testing.assert_array_equal(curve(np.array([0, 1, 2, 3])), [5, 3, 8, 8])
    np.testing.assert_array_equal(curve(np.array([0, 1, 2, 3]), -1), [5, 5, 4, 8])
    assert curve_of(([0.5], [7]))(np.array([0, 1])).tolist() == [7, 7]
    assert curve_of(([0.5], [7]), True, 1.0)(np.array([0, 0.7])).tolist() == [7, 7]


def test_angles_that_differ_by_rounding_are_one():
    assert distinct([3.0, 1.0, 1.0 + 1e-15, 2 * pi - 1e-15, 0.0], 2 * pi) == (0.0, 1.0, 3.0)


# --- moments ---------------------------------------------------------------------------------------------------------

ROCKER = {"group": [{"kind": 3, "links": ["4", "5"], "outer": ["A", "D"]}]}
"""A slider block on the crank pin and a rocker about D, 0.3 m from O: it swings by asin(0.1 / 0.3) to both sides."""


def swing(phi):
    """Angle of the rocker D..A from the direction D..O, and its dead points."""
    return np.angle((R * np.exp(1j * np.asarray(phi)) - 0.3) / -0.3)


DEAD = acos(R / 0.3)


@pytest.mark.parametrize("sense", ["clockwise", "counter-clockwise"])
def test_moment_on_a_swinging_link(sense):
    m = moment("5", ROCKER, stroke="working", sense=sense, value="20 N m")
    assert m.point is None
    turning = np.sign(np.gradient(swing(TURN), TURN))
    works = turning == (1 if sense == "counter-clockwise" else -1)
    near = np.abs(np.cos(TURN) - R / 0.3) < 0.05
    np.testing.assert_array_equal(m.law(TURN, 0)[~near], np.where(works, -20 * turning, 0)[~near])
    assert m.jumps == pytest.approx((DEAD, 2 * pi - DEAD), abs=1e-12)


@pytest.mark.parametrize(("sense", "sign"), [("clockwise", -1), ("counter-clockwise", 1)])
def test_diagram_over_the_swing(sense, sign):
    m = moment("5", ROCKER, sense=sense, direction="clockwise",
               table=[[0, "0 N m"], [0.4, "0 N m"], [0.4, "30 N m"], [1, "60 N m"]])
    reach = asin(R / 0.3)
    x = (sign * swing(TURN) + reach) / (2 * reach)
    np.testing.assert_allclose(m.law(TURN, 0), -np.where(x < 0.4, 0, 30 + (x - 0.4) * 50), rtol=1e-11, atol=1e-9)
    # Where the rocker stands at two fifths of its swing: sine rule in the triangle O, A, D.
    to = sign * (0.4 * 2 * reach - reach)
    corner = asin(np.sin(to) * 0.3 / R)
    expected = sorted(np.mod(t, 2 * pi) for t in (to - corner, to + pi + corner))
    inner = sorted(set(m.jumps) - {j for j in m.jumps if abs(np.cos(j) - R / 0.3) < 1e-9})
    assert inner == pytest.approx(expected, abs=1e-12)
    for j in inner:
        assert sorted([float(m.magnitude(j, -1)), float(m.magnitude(j, 1))]) == pytest.approx([0, 30], abs=1e-9)


def test_a_swing_across_the_negative_x_axis():
    """The rocker D..A lies about 180 degrees: the cut of the arc tangent must not be seen."""
    m = moment("5", ROCKER, sense="counter-clockwise", table=[[0, "0 N m"], [1, "60 N m"]], direction="counter-clockwise")
    turned = np.linspace(0, 2 * pi, 2000)
    values = m.law(turned, 0)[1:-1]
    assert np.abs(np.diff(values)).max() < 1
    assert values.max() == pytest.approx(60, abs=1e-3)
    assert values.min() == pytest.approx(0, abs=1e-3)


TURNING = ROCKER | {"points.D": ["0.04 m", "0 m"]}
"""About D inside the crank circle it turns all the way round."""


def test_moment_on_a_link_that_turns_all_the_way_round():
    """One endless stroke: no dead points, the moment never lets go."""
    m = moment("5", TURNING, sense="counter-clockwise", value="20 N m")
    np.testing.assert_array_equal(m.law(np.append(TURN, [0, pi, 2 * pi]), 0), -20)
    assert m.jumps == ()
    other = moment("5", TURNING, sense="clockwise", stroke="working", value="20 N m")
    np.testing.assert_array_equal(other.law(TURN, 0), 0)
    clockwise = moment("5", TURNING, CLOCKWISE, sense="clockwise", stroke="working", value="20 N m")
    np.testing.assert_array_equal(clockwise.law(TURN, 0), 20)


@pytest.mark.parametrize("sense", ["clockwise", "counter-clockwise"])
@pytest.mark.parametrize("turns", [1, 2])
def test_diagram_over_the_turn_of_a_link(turns, sense):
    """The way of a turning link is its own turn from position 0 on, whichever sense is the working one."""
    m = moment("5", TURNING, {"cycle.turns": turns}, sense=sense, direction="clockwise",
               table=[[0, "10 N m"], [0.5, "10 N m"], [0.5, "50 N m"], [1, "60 N m"]])
    way = np.mod(np.angle(R * np.exp(1j * TURN) - 0.04), 2 * pi) / (2 * pi)
    np.testing.assert_allclose(m.law(TURN, 0), -np.where(way < 0.5, 10, 40 + 20 * way), rtol=1e-12)
    # It lies along the x axis where the crank does.
    assert m.jumps == pytest.approx(np.arange(2 * turns) * pi, abs=1e-12)
    np.testing.assert_allclose(m.magnitude(np.array(m.jumps), 1), [10, 50] * turns, rtol=1e-12)
    np.testing.assert_allclose(m.magnitude(np.array(m.jumps), -1), [60, 10] * turns, rtol=1e-12)


def test_diagrams_of_two_turns_of_the_crank():
    m = moment("1", TWO_TURNS, sense="counter-clockwise", tables=[[[0, "10 N m"]], [[0, "70 N m"]]], direction="clockwise")
    np.testing.assert_array_equal(m.law(np.array([0.1, 3, 6.2, 6.4, 12.5, 12.6]), 0), [-10, -10, -10, -70, -70, -10])
    np.testing.assert_array_equal(m.law(np.array([0, 2 * pi, 4 * pi]), -1), [-70, -10, -70])
    np.testing.assert_array_equal(m.law(np.array([0, 2 * pi, 4 * pi]), 1), [-10, -70, -10])
    assert m.jumps == pytest.approx((0, 2 * pi), abs=1e-12)


def test_a_diagram_for_a_stroke_that_never_comes():
    """One turn of a link that turns all the way round is one stroke: the second diagram would wait for a second turn."""
    tables = [[[0, "10 N m"]], [[0, "70 N m"]], [[0, "5 N m"]]]
    with pytest.raises(CannotBuild, match="3 tables for 2 strokes of a cycle") as e:
        moment("1", TWO_TURNS, sense="counter-clockwise", tables=tables, direction="clockwise")
    assert "turns = 2" in str(e.value) + e.value.hint


def test_diagrams_that_do_not_come_out_even():
    """Three for four strokes would begin again in the middle: which was meant for which stroke nobody can tell."""
    tables = [[[0, f"{n} N m"]] for n in (10, 20, 30)]
    with pytest.raises(CannotBuild, match="3 tables for 4 strokes of a cycle"):
        moment("1", {"cycle.turns": 4}, sense="counter-clockwise", tables=tables, direction="clockwise")


def test_moment_over_the_angle():
    m = moment("1", over="angle", direction="clockwise",
               table=[["0 deg", "10 N m"], ["180 deg", "30 N m"], ["180 deg", "0 N m"], ["360 deg", "0 N m"]])
    np.testing.assert_allclose(m.law(np.radians([90, 270]), 0), [-20, 0], rtol=1e-13)
    np.testing.assert_array_equal([m.law(pi, -1), m.law(pi, 1), m.law(0.0, -1), m.law(0.0, 1)], [-30, 0, 0, -10])
