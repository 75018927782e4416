"""Positions of one turn: dead positions in closed form, strokes, division, labels."""

from dataclasses import replace
from math import acos, asin, degrees, pi, radians, sqrt

import numpy as np
import pytest

from tests import project_files as files
from tests.methods.linkage.mechanisms import mechanism
from tmm_sheets import catalogue
from tmm_sheets.construction.arithmetic import root
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import RPR, RRP, RRR
from tmm_sheets.mechanism.model import Crank, Guide, LinkPoint, StructuralGroup
from tmm_sheets.methods.linkage.cycle import closed, dead_positions
from tmm_sheets.methods.linkage.numbering import dead_cycle, even_cycle
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.project import Project

DEAD = acos(0.08 / 0.26)
"""Angle between the line of the pivots and the crank in a dead position of the shaper."""


def test_dead_positions_of_the_shaper_are_tangents(shaper):
    plan, dead = dead_positions(shaper.mechanism)
    assert {step.value for step in dead} == {np.angle(plan[name].value) for name in ("B′", "B″")}
    for b, sign in zip(sorted((plan["B′"].value, plan["B″"].value), key=lambda z: z.real), (-1, 1), strict=True):
        true = 0.08 * np.exp(1j * (-pi / 2 + sign * DEAD))
        assert abs(b - true) < 1e-16
        # Crank and rocker are at right angles.
        assert abs((np.conj(b) * (b + 0.26j)).real) < 1e-17
    assert [step.rule.name for step in plan] == ["given point", "given point", "tangent", "tangent"]


def test_nominal_division_of_the_shaper(shaper):
    cycle = shaper.cycle
    assert cycle.labels == tuple("0123456789")
    np.testing.assert_allclose(np.degrees(cycle.turned), 36 * np.arange(10), atol=1e-13)
    # Position k at -108 + 36 k degrees from the upward vertical, clockwise.
    np.testing.assert_allclose(np.exp(1j * cycle.phi), np.exp(1j * np.radians(90 + 108 - 36 * np.arange(10))), atol=1e-15)
    s = cycle.strokes
    exact = 2 * pi - 2 * DEAD
    assert s.end - s.begin == pytest.approx(exact, abs=1e-15)
    assert degrees(exact) == pytest.approx(215.84, abs=5e-3)
    assert s.begin == pytest.approx((radians(216) - exact) / 2, abs=1e-15)
    assert s.length == pytest.approx(2 * 0.566 * 0.08 / 0.26, rel=1e-15)
    assert abs(s.path - 1) < 1e-15
    assert abs(s.origin - complex(-0.566 * 0.08 / 0.26, 0.33)) < 1e-15


def test_exact_division_starts_in_the_dead_position(shaper):
    cycle = dead_cycle(shaper.mechanism, "S5", "+x", 6, 4, None)
    assert cycle.strokes.begin == 0
    assert cycle.turned[6] == pytest.approx(cycle.strokes.end, abs=1e-15)
    out = position_plan(shaper.mechanism, cycle.phi).points["S5"].value.real
    assert out[0] == pytest.approx(-0.566 * 0.08 / 0.26, rel=1e-14)
    assert out[6] == pytest.approx(0.566 * 0.08 / 0.26, rel=1e-14)
    np.testing.assert_allclose(np.diff(cycle.turned[:7]), cycle.strokes.end / 6, rtol=1e-14)


def test_zeros_of_the_shipped_shaper_are_zeros():
    """Positions 0 and 6 are the tangents: rocker and ram stand still, all but to rounding; the ram moves between them only."""
    p = Project(catalogue.read("lugansk/shaper"))
    crank, v = p.mechanism.crank, p.study.velocities
    assert np.degrees(p.cycle.turned[6]) == pytest.approx(degrees(2 * pi - 2 * DEAD), abs=1e-12)
    for k in (0, 6):
        pin = p.study.positions.points["B"].value[k]
        assert abs((np.conj(pin) * (pin + 0.26j)).real) < 1e-16  # the crank stands square to the rocker
        assert abs(v.omega["3"].value[k]) < 1e-15 * crank.speed
        for point in (v.points["S5"], v.points["D"], v.points["S3"], v.coincident["B3"]):
            assert abs(point.value[k]) < 1e-15 * crank.speed * crank.length * 10
    ram = v.points["S5"].value.real
    assert np.all(ram[1:6] > 0.5)
    assert np.all(ram[7:] < -0.5)


@pytest.mark.parametrize("coefficient", [None, 1.5])
@pytest.mark.parametrize("turns", [1, 2, 3])
def test_strokes_are_divided_in_every_turn(shaper, turns, coefficient):
    once = dead_cycle(shaper.mechanism, "S5", "+x", 6, 4, coefficient)
    cycle = dead_cycle(shaper.mechanism, "S5", "+x", 6, 4, coefficient, turns)
    assert cycle.labels == tuple(str(n) for n in range(10 * turns))
    assert cycle.period == pytest.approx(2 * pi * turns)
    first = cycle.turned.reshape(turns, 10) - 2 * pi * np.arange(turns)[:, None]
    np.testing.assert_allclose(first, [once.turned] * turns, atol=1e-14)
    assert cycle.start == once.start
    assert [label for _, label in cycle.drawn] == [", ".join(str(n + 10 * t) for t in range(turns)) for n in range(10)]


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("working", ["+x", "-x"])
def test_working_stroke_is_the_slow_one_only_when_the_crank_turns_that_way(shaper, sense, working):
    m = replace(shaper.mechanism, crank=replace(shaper.mechanism.crank, sense=sense))
    cycle = dead_cycle(m, "S5", working, 6, 4, None)
    slow = (sense == -1) == (working == "+x")
    assert cycle.strokes.end == pytest.approx(2 * pi - 2 * DEAD if slow else 2 * DEAD, abs=1e-14)
    x = position_plan(m, cycle.phi).points["S5"].value.real
    forward = 1 if working == "+x" else -1
    assert (np.diff(x[:7]) * forward > 0).all()
    assert (np.diff(x[6:]) * forward < 0).all()


def test_side_decides_at_the_dead_positions(shaper):
    s = shaper.cycle.strokes
    angles = np.array([s.begin, s.end, s.begin + 2 * pi, (s.begin + s.end) / 2, s.end + 0.1])
    assert s.working(angles, +1).tolist() == [True, False, True, True, False]
    assert s.working(angles, -1).tolist() == [False, True, False, True, False]
    assert s.working(angles).tolist() == [False, False, False, True, False]


def test_even_cycle_wants_position_0_where_it_is_told(shaper):
    cycle = even_cycle(shaper.mechanism, 0.3, 12)
    assert cycle.labels == tuple(map(str, range(12)))
    np.testing.assert_allclose(cycle.phi, 0.3 - 2 * pi / 12 * np.arange(12), atol=1e-15)
    assert cycle.index("7") == 7
    with pytest.raises(CannotBuild, match="there is no position 12\n    the positions are 0, 1, 2"):
        cycle.index("12")


def test_further_positions_are_sorted_in_over_two_turns(shaper):
    cycle = even_cycle(shaper.mechanism, 0.0, 8, turns=2, extra={"1′": pi / 8, "13′": 13 * pi / 4 + pi / 8})
    assert cycle.period == pytest.approx(4 * pi)
    assert cycle.labels[:3] == ("0", "1′", "1")
    assert len(cycle.labels) == 18
    assert (np.diff(cycle.turned) > 0).all()
    with pytest.raises(CannotBuild, match=r"there is a position \d already"):
        even_cycle(shaper.mechanism, 0.0, 8, extra={"3": 0.1})


WHITWORTH = files.CRANK | {
    "crank.length": "200 mm", "points": {"O": ["0 mm", "0 mm"], "Q": ["0 mm", "-100 mm"]},
    "guide": [{"name": "ram", "through": ["0 mm", "-100 mm"]}],
    "group": [{"kind": 3, "links": ["2", "3"], "outer": ["A", "Q"]},
              {"kind": 2, "links": ["4", "5"], "outer": ["C"], "inner": "D", "length": "500 mm", "guide": "ram", "side": -1}],
    "point": [{"name": "C", "link": "3", "from": "Q", "towards": "A", "distance": "-150 mm"}],
    "cycle": {"start": "dead", "output": "D", "working_sense": "+x", "working": 6, "idle": 6}}
"""A rocker that goes round (its pivot is inside the crank circle) and drives a slider."""


@pytest.mark.parametrize("sense", ["clockwise", "counter-clockwise"])
def test_a_slider_behind_a_rocker_that_goes_round_turns_back(sense):
    """Its dead positions are those of rocker and rod in line: the crank pin on the guide, at -30 and 210 degrees."""
    p = files.project(WHITWORTH, {"crank.sense": sense})
    out, turned = p.study.positions.points["D"].value, 240.0 if sense == "counter-clockwise" else 120.0
    assert out[[0, 6]] == pytest.approx([-0.65 - 0.1j, -0.35 - 0.1j], abs=1e-15)
    assert np.exp(1j * p.cycle.phi[[0, 6]]) == pytest.approx(np.exp(1j * np.radians([-30, 210])), abs=1e-14)
    assert np.degrees(p.cycle.turned[6]) == pytest.approx(turned, abs=1e-12)
    assert np.abs(p.study.velocities.points["D"].value[[0, 6]]) == pytest.approx([0, 0], abs=1e-14)


@pytest.mark.parametrize(("output", "hinge"), [("A", "O"), ("C", "Q")])
def test_an_output_that_goes_round_has_no_dead_positions(output, hinge):
    with pytest.raises(CannotBuild, match=f"point {output} turns all the way round {hinge}: it has no dead positions"):
        _ = files.project(WHITWORTH, {"cycle.output": output}).cycle


@pytest.mark.parametrize(("sense", "far"), [("+x", "+x"), ("-x", "-x"), ("+y", "+y")])
def test_the_stroke_of_a_rocker_is_its_swing(sense, far):
    """A rocker that passes the vertical in its swing: its end is highest there, but turns back at the ends of the swing only."""
    p = files.project(files.CRANK, {"points": {"O": ["0 m", "0 m"], "E": ["0.4 m", "-0.2 m"]}, "crank.length": "0.1 m", "group": [
        {"kind": 1, "links": ["2", "3"], "outer": ["A", "E"], "inner": "B", "lengths": ["0.4 m", "0.25 m"]}], "cycle": {
            "start": "dead", "output": "B", "working_sense": sense, "working": 6, "idle": 6}})
    ring = position_plan(p.mechanism, np.linspace(0, 2 * pi, 20001)).points["B"].value
    swing = np.angle(ring - (0.4 - 0.2j))
    ends = ring[[np.argmin(swing), np.argmax(swing)]]
    found = p.study.positions.points["B"].value[[0, 6]]
    assert sorted(found, key=lambda z: z.real) == pytest.approx(sorted(ends, key=lambda z: z.real), abs=1e-7)
    axis = {"+x": 1, "-x": -1, "+y": 1j}[far]
    assert ((found[1] - found[0]) * np.conj(axis)).real > 0
    assert abs(p.study.velocities.omega["3"].value[0]) < 1e-9 * p.mechanism.crank.speed


def test_dead_positions_are_not_asked_of_what_does_not_assemble():
    m = mechanism(StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.15, 0.2)), fixed={"D": 0.3 + 0j})
    with pytest.raises(CannotBuild, match=r"group 2-3 does not assemble at crank angles 112\.0\.\.248\.0 deg"):
        dead_cycle(m, "C", "+x", 6, 6, None)


def test_output_that_never_turns_back(shaper):
    m = mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C")), fixed={"C": -0.05j})
    with pytest.raises(CannotBuild, match="point B turns all the way round A: it has no dead positions"):
        dead_cycle(m, "B", "+x", 6, 6, None)


# --- dead positions of other groups ----------------------------------------------------------------------------------


def slider(e, rod=0.3, crank=0.1, sense=1):
    return mechanism(StructuralGroup(RRP, ("2", "3"), ("B",), "C", (rod,), ("x",)), guides=[Guide("x", "0", 1j * e, 0.0)],
                     crank=Crank("1", "A", "B", crank, 10.0, sense))


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("e", [0.0, 0.05, -0.08])
def test_crank_slider(e, sense):
    cycle = dead_cycle(slider(e, sense=sense), "C", "+x", 6, 6, None)
    # Inner and outer dead position: crank and rod in one line.
    inner, outer = pi + asin(e / 0.2), asin(e / 0.4)
    assert np.exp(1j * cycle.start) == pytest.approx(np.exp(1j * inner), abs=1e-14)
    assert np.exp(1j * cycle.world(cycle.strokes.end)) == pytest.approx(np.exp(1j * outer), abs=1e-14)
    assert cycle.strokes.length == pytest.approx(sqrt(0.4**2 - e * e) - sqrt(0.2**2 - e * e), rel=1e-14)


def test_crank_rocker():
    rod, rocker, frame = 0.35, 0.25, 0.3
    m = mechanism(StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (rod, rocker)), fixed={"D": frame + 0j})
    cycle = dead_cycle(m, "C", "+x", 6, 6, None)

    def seen(distance):
        return acos((frame**2 + distance**2 - rocker**2) / (2 * frame * distance))

    ends = {round(float(np.mod(a, 2 * pi)), 12) for a in (seen(rod + 0.1), pi + seen(rod - 0.1))}
    found = {round(float(np.mod(cycle.world(t), 2 * pi)), 12) for t in (cycle.strokes.begin, cycle.strokes.end)}
    assert found == ends


def test_dead_positions_found_as_zeros_where_they_cannot_be_constructed():
    """The ram of a shaper with its rocker on an offset: no construction, but the strokes are there."""
    m = mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C"), offset=0.02), fixed={"C": -0.3j})
    m = replace(m, points=(LinkPoint("D", "3", "C", "B", 0.5),))
    cycle = dead_cycle(m, "D", "+x", 6, 4, None)
    # The slot touches the circle of the offset and the crank circle: its angle is extreme where crank and slot are normal.
    pos = position_plan(m, cycle.world(np.array([cycle.strokes.begin, cycle.strokes.end])))
    b, u = pos.points["B"].value, pos.directions["3"].value
    np.testing.assert_allclose((b * np.conj(u)).real, 0, atol=1e-12)
    assert cycle.plan is None


# --- zeros -----------------------------------------------------------------------------------------------------------


def test_root_to_the_last_bit():
    assert root(np.cos, 0.0, 3.0) == pytest.approx(pi / 2, abs=5e-16)
    assert root(lambda x: np.exp(x) - 5, -10, 10) == pytest.approx(np.log(5), abs=5e-16)


@pytest.mark.parametrize(("labels", "closing"), [
    (("0",), "0"), (("0", "1", "2"), "3"), (("12", *map(str, range(1, 12))), "12"), (("0", "1", "1a"), "0"), (("3", "1", "2"), "3"),
    (("4", "5", "3"), "4"),
], ids=["one", "from naught", "from the last", "no number", "turned", "taken"])  # fmt: skip
def test_number_that_closes_the_turn(labels, closing):
    assert closed(labels) == (*labels, closing)


@pytest.mark.parametrize(("cycle", "labels"), [
    ({"zero": "0"}, ("0", "1", "2", "3")), ({"zero": "4"}, ("4", "1", "2", "3")), ({"zero": "a"}, ("a", "1", "2", "3")),
    ({"zero": "4", "turns": 2}, ("8", *map(str, range(1, 8)))), ({"zero": "8", "turns": 2}, ("8", *map(str, range(1, 8)))),
    ({"zero": "3"}, None), ({"zero": "5", "turns": 2}, None), ({"zero": "4", "end": "90 deg"}, None),
], ids=["naught", "last", "letter", "last of a turn", "last of all",
        "a middle one", "of the second turn", "end of a swing"])  # fmt: skip
def test_the_first_position_is_none_of_the_others(cycle, labels):
    """One of the same name was dropped in silence, and its plans with it."""
    made = files.project(files.SLIDER, {"cycle": {"start": "0 deg", "positions": 4, **cycle}})
    if labels is None:
        with pytest.raises(CannotBuild, match=r"there is a position \d already"):
            _ = made.cycle
    else:
        assert made.cycle.labels == labels
