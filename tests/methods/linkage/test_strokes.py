"""Strokes and the senses of loads: outputs that turn back many times, stand still, or begin in an extreme.

What a load does is judged by its power: the technological force follows from the equilibrium of the slider (mass times
acceleration, weight, the two reactions that ``solve`` tells), its power from the velocity: nothing of what places the load.
"""

import random
from itertools import pairwise, product
from math import pi

import numpy as np
import pytest

from tests.few import few
from tests.methods.linkage.mechanisms import mechanism
from tests.project_files import CRANK, MOMENT, merged, project
from tmm_sheets import catalogue
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import RPR, RRR
from tmm_sheets.mechanism.model import LinkPoint, StructuralGroup
from tmm_sheets.methods.linkage.cycle import Run, in_strokes, over_cycle, runs_of, working_stroke
from tmm_sheets.methods.linkage.loads import OutputMotion, stroke_law, turning_motion
from tmm_sheets.methods.linkage.numbering import dead_cycle, even_cycle
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.project import Project
from tmm_sheets.task.assembly import by_run

TURN = np.linspace(0, 2 * pi, 360, endpoint=False)


def slider_load(p, turned, link="5", point="C", reactions=("F50", "F54")):
    """World vector of the technological force on a slider and its velocity: m a = weight + reactions + force."""
    study = p.study_at(turned, ("",) * len(turned))
    mass = next(x.mass for x in p.variant.link if x.name == link)
    n = np.ones(len(turned))
    held = sum(study.forces.reactions[name].value * n for name in reactions)
    force = mass * (study.accelerations.points[point].value * n + 9.81j) - held
    return force, study.velocities.points[point].value * n


# --- runs of a speed -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shift", [0.0, 0.1, 1e-9, pi / 720, pi / 360, 2.0, 2 * pi - 1e-9])
@pytest.mark.parametrize("n", [1, 2, 3, 5])
def test_runs_of_a_sine(shift, n):
    runs = runs_of(lambda t: np.sin(n * (t - shift)))
    assert len(runs) == 2 * n
    assert sum(r.end - r.begin for r in runs) == pytest.approx(2 * pi)
    for r in runs:
        assert abs(np.sin(n * (r.begin - shift))) < 1e-12
        assert r.sense == np.sign(np.sin(n * ((r.begin + r.end) / 2 - shift)))


def test_what_never_turns_back_has_one_run():
    assert runs_of(lambda t: 2 + np.sin(t)) == [Run(0.0, 2 * pi, 1)]
    assert runs_of(lambda t: -2 + np.sin(t)) == [Run(0.0, 2 * pi, -1)]
    assert runs_of(lambda t: 0 * t) == [Run(0.0, 2 * pi, 0)]
    assert runs_of(lambda t: np.where(t > 1, np.nan, 1.0)) == []


@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-5])
@pytest.mark.parametrize("at", [1.0, 1.2345, pi, 0.0, 2 * pi / 720 * 100.5, 2 * pi / 720 * 100 + 5e-6])
def test_two_reversals_between_two_angles_of_the_sweep(at, width):
    """1 - cos(t - at) less a little: negative within +-acos(1 - little), which the sweep itself may step over."""
    little = 1 - np.cos(width)
    runs = runs_of(lambda t: 2 * np.sin((t - at) / 2) ** 2 - little)
    assert [r.sense for r in sorted(runs, key=lambda r: r.end - r.begin)] == [-1, 1]
    back = min(runs, key=lambda r: r.end - r.begin)
    assert back.end - back.begin == pytest.approx(2 * width, rel=1e-4)
    assert np.exp(1j * (back.begin + back.end) / 2) == pytest.approx(np.exp(1j * at), abs=1e-8)


@pytest.mark.parametrize("at", [1.0, 1.2345, pi, 0.0])
def test_a_stop_without_a_reversal_is_none(at):
    assert [r.sense for r in runs_of(lambda t: 1 - np.cos(t - at))] == [1]


def dwelling(t, first=2.0, last=3.0):
    """Speed of an output that stands still between two angles and goes to and fro outside."""
    t = np.mod(t, 2 * pi)
    x = np.mod(t - last, 2 * pi) / (2 * pi - (last - first))
    return np.where(x < 1, np.sin(2 * pi * x), 0.0)


@pytest.mark.parametrize(("first", "last"), [(2.0, 3.0), (0.0, 1.0), (5.0, 7.0), (0.3, 0.35)])
def test_a_dwell_is_a_run_of_its_own(first, last):
    runs = runs_of(lambda t: dwelling(t, first, last))
    assert sorted(r.sense for r in runs) == [-1, 0, 1]
    still = next(r for r in runs if r.sense == 0)
    assert np.exp(1j * still.begin) == pytest.approx(np.exp(1j * first), abs=1e-9)
    assert still.end - still.begin == pytest.approx(last - first, abs=1e-9)


# --- strokes between the extremes ------------------------------------------------------------------------------------


def strokes(senses, ways):
    runs = [Run(float(k), float(k + 1), sense) for k, sense in enumerate(senses)]
    runs[-1] = Run(float(len(senses) - 1), 2 * pi, senses[-1])
    return {r.begin % (2 * pi): r.working for r in in_strokes(runs, ways)}


@pytest.mark.parametrize(("ways", "working"), [
    ((0, 1), {0}),
    ((1, 0), {1}),
    ((0, 1, 0.9, 1), {0}),                  # two equal upper extremes: the stroke ends at the first
    ((0, 1, 0, 0.5), {0}),                  # two equal lower ones, left for the last time before 1 ...
    ((0, 0.1, 0, 1), {2}),                  # ... which is the second here
    ((0, 0.7, 0.3, 1), {0, 1, 2}),          # back for a while inside the working stroke
    ((0, 1, 0.3, 0.7), {0}),                # inside the idle one
    ((0, 1, 0, 1), {0, 2}),                 # two whole strokes in a turn
    ((0.5, 0.2, 1, 0), {0, 1, 3}),          # over the end of the turn
    ((0, 1, 1 - 1e-12, 1), {0}),
])  # fmt: skip
def test_the_working_stroke_goes_from_one_true_extreme_to_the_other(ways, working):
    senses = [int(np.sign(b - a)) for a, b in zip(ways, (*ways[1:], ways[0]), strict=True)]
    found = strokes(senses, ways)
    assert {k for k in range(len(ways)) if found[float(k)]} == working


def test_a_dwell_belongs_to_the_working_stroke_only_between_the_extremes():
    assert strokes((1, 0, 1, -1), (0, 0.5, 0.5, 1)) == {0: True, 1: True, 2: True, 3: False}
    assert strokes((0, 1, 0, -1), (0, 0, 1, 1)) == {0: False, 1: True, 2: False, 3: False}


def test_strokes_are_numbered_over_two_turns_from_the_nearest():
    runs = in_strokes([Run(1.0, 3.0, 1), Run(3.0, 1.0 + 2 * pi, -1)], (0, 1))
    assert [r.stroke for r in over_cycle(runs, 4 * pi, 0.9)] == [0, 1, 2, 3]
    late = over_cycle(runs, 4 * pi, 3.2)
    assert (late[0].stroke, late[0].begin, late[0].working) == (0, 3.0, False)
    assert all(a.end == pytest.approx(b.begin) for a, b in pairwise(late))
    assert working_stroke(runs) == (1.0, 3.0)


def law_of(direction, stroke="both", within=(0.0, 1.0)):
    """A constant of 10 on an output with a dwell at the beginning of its way."""

    def way(t):
        x = np.mod(np.asarray(t) - 3.0, 2 * pi) / (2 * pi - 1)
        return np.where(x < 1, (1 - np.cos(2 * pi * x)) / 2, 0.0)

    runs = runs_of(dwelling)
    motion = OutputMotion(over_cycle(in_strokes(runs, way([r.begin for r in runs])), 2 * pi), way, 2 * pi).within(*within)
    laws, signs = by_run(motion, stroke, [([0.0], [10.0])], {"against": -1.0, "along": 1.0}.get(direction), "F")
    return stroke_law(motion, laws, signs)


def test_nothing_acts_against_a_motion_that_is_not_there():
    law, jumps = law_of("against")
    np.testing.assert_array_equal(law(TURN, 0), -10 * np.sign(dwelling(TURN)))
    assert jumps == pytest.approx((2.0, 3.0, 3.0 + (2 * pi - 1) / 2), abs=1e-9)
    np.testing.assert_array_equal(law(np.array(jumps), -1), [10, 0, -10])
    np.testing.assert_array_equal(law(np.array(jumps), 1), [0, -10, 10])


def test_a_fixed_direction_acts_in_a_dwell_too():
    law, _ = law_of("fixed")
    np.testing.assert_array_equal(law(np.append(TURN, (2.0, 3.0)), 0), 10)
    law, _ = law_of("fixed", "working")
    np.testing.assert_array_equal(law(TURN, 0), np.where(dwelling(TURN) > 0, 10, 0))


# --- the press of manual 003 -----------------------------------------------------------------------------------------


def ciphers(count):
    draw = random.Random(3)
    while count:
        code = f"{draw.randrange(100):02}-ЭПС-{draw.randrange(1000):03}"
        try:
            yield code, Project(catalogue.read(f"transport/press@{code}"))
        except CannotBuild:
            continue
        count -= 1


def test_the_load_of_30_presses_never_drives_the_slider():
    twice = 0
    for code, p in ciphers(30):
        force, speed = slider_load(p, TURN)
        power = (force * np.conj(speed)).real
        noise = 1e-9 * np.abs(force).max() * np.abs(speed).max()
        assert power.max() <= noise, code
        # It presses: the work of a turn is that of the diagram, 0.4 of the way up to 1 MN evenly.
        way = p.cycle.strokes.length
        assert -power.mean() * 2 * pi / p.mechanism.crank.speed == pytest.approx(0.5 * 0.4 * way * 1e6, rel=2e-2), code
        twice += len(p.cycle.strokes.runs) > 2
    assert 3 < twice < 12


@pytest.mark.parametrize("code", ["05-ЭПС-731", "07-ЭПС-718", "00-ЭПС-409"])
def test_a_toggle_beyond_its_straight_line(code):
    """The stroke ends where the toggle first is straight (D, B, C in line), not where the slider stands on its local top."""
    p = Project(catalogue.read(f"transport/press@{code}"))
    s = p.cycle.strokes
    at = position_plan(p.mechanism, p.cycle.world(np.array([s.begin, s.end]))).points
    d, b, c = p.mechanism.fixed["D"], at["B"].value, at["C"].value
    assert abs(b[1].real - d.real) < 1e-12
    assert b[0].real - d.real < -0.02
    assert s.length == pytest.approx(abs(c[1] - c[0]), rel=1e-12)
    y = position_plan(p.mechanism, p.cycle.world(np.linspace(0, 2 * pi, 20001))).points["C"].value.imag
    assert s.length == pytest.approx(np.ptp(y), rel=1e-6)
    assert len(s.runs) == 4


# --- other mechanisms ------------------------------------------------------------------------------------------------

TOGGLE = merged(CRANK, MOMENT, {
    "crank.sense": "clockwise",
    "guide": [{"name": "g", "through": "D", "direction": "-90 deg"}],
    "group": [{"kind": 1, "links": ["2", "3"], "outer": ["A", "D"], "inner": "B", "lengths": ["0.5 m", "0.35 m"], "side": 1},
              {"kind": 2, "links": ["4", "5"], "outer": ["B"], "inner": "C", "length": "0.4 m", "guide": "g"}],
    "link": [{"name": "5", "mass": "20 kg", "centre": "C"}],
})
"""A press whose toggle swings through its straight line; with x = 0.47 evenly, nearly: two strokes in a turn."""
EVEN = {"start": "90 deg", "positions": 12}


def toggle(*changes, cycle=EVEN, x=0.55, **load):
    """The press with D at -x and a force of 700 N against the motion of its slider, ``load`` about it otherwise."""
    force = {"name": "F5", "link": "5", "point": "C", "direction": "against motion", "value": "700 N", "sense": "-y"} | load
    return project(TOGGLE, {"points.D": [f"{-x!r} m", "0.3 m"], "cycle": cycle, "force": [force]}, *changes)


def working_angles(p, turned, axis):
    """True on the working stroke, from the ways alone: the last extreme passed is the lower one, the next the upper one."""
    t = np.linspace(-2 * pi, 4 * pi, 3 * 36000 + 1)
    way = (position_plan(p.mechanism, p.cycle.world(t)).points["C"].value * np.conj(axis)).real
    near = 1e-7 * np.ptp(way)
    mark = np.where(way < way.min() + near, -1, np.where(way > way.max() - near, 1, 0))
    k = np.arange(len(t))
    last = mark[np.maximum.accumulate(np.where(mark != 0, k, 0))]
    following = mark[np.minimum.accumulate(np.where(mark != 0, k, len(t) - 1)[::-1])[::-1]]
    at = np.searchsorted(t, turned)
    return (last[at] == -1) & (following[at] == 1)


DOWN = {"output": "C", "working_sense": "-y"}
CYCLES = {"even": EVEN, "dead": {"start": "dead", "working": 7, "idle": 5} | DOWN, "output": EVEN | DOWN}


@pytest.mark.parametrize(("x", "sense"), few(
    product((0.45, 0.52), ("clockwise", "counter-clockwise")), (0.52, "counter-clockwise")))
@pytest.mark.parametrize("stroke", ["working", "idle", "both"])
@pytest.mark.parametrize("working", few(["+y", "-y"], "-y"))
@pytest.mark.parametrize(("direction", "sign"), [("against motion", -1), ("along motion", 1)])
def test_own_toggles(x, sense, stroke, working, direction, sign):
    """Four reversals in a turn; the way ends at two places that are equally low, and its second top is lower than the first."""
    for cycle in CYCLES.values():
        p = toggle({"crank.sense": sense}, cycle=cycle, x=x, direction=direction, stroke=stroke, sense=working)
        turned = TURN + 0.0123
        force, speed = slider_load(p, turned)
        power = sign * (force * np.conj(speed)).real
        assert power.min() >= -1e-9 * np.abs(power).max()
        works = working_angles(p, turned, 1j if working == "+y" else -1j)
        assert 60 < works.sum() < 180
        acts = {"working": works, "idle": ~works, "both": works | True}[stroke]
        np.testing.assert_allclose(force, np.where(acts, sign * 700j * np.sign(speed.imag), 0), rtol=1e-9, atol=1e-6)


def test_an_output_that_begins_in_an_extreme():
    """Position 0 in each of the four reversals in turn: no force there, the right one a hair on either side."""
    for r in toggle().applied[0].motion.runs:
        start = np.degrees(toggle().cycle.world(r.begin))
        p = toggle({"cycle.start": f"{float(start)!r} deg"})
        assert p.applied[0].jumps[0] == pytest.approx(0, abs=1e-12)
        hair = np.array([-1e-6, 1e-6])
        force, speed = slider_load(p, hair)
        np.testing.assert_allclose(force, -700j * np.sign(speed.imag), rtol=1e-6)
        np.testing.assert_array_equal(p.applied[0].magnitude(np.array([0.0, 2 * pi])), 0)
        sides = [p.applied[0].vector(0.0, side) for side in (-1, 1)]
        np.testing.assert_array_equal(sides, -700j * np.sign(speed.imag))


def test_two_whole_strokes_in_a_turn():
    """Both tops are equally high where the toggle swings evenly: both ways down are working strokes."""
    low, high = 0.49, 0.50
    for _ in range(60):
        middle = (low + high) / 2
        p = toggle(x=middle)
        t = np.array([r.begin for r in p.applied[0].motion.runs])
        at = position_plan(p.mechanism, p.cycle.world(t)).points["B"].value.real + middle
        # The one dead position of the rocker is as far to the left as the other to the right.
        low, high = (middle, high) if at.min() + at.max() < 0 else (low, middle)
    p = toggle(x=low, stroke="working", cycle=CYCLES["dead"])
    assert [r.working for r in p.applied[0].motion.runs] == [True, False, True, False]
    force, speed = slider_load(p, TURN + 0.0123)
    np.testing.assert_allclose(force, np.where(speed.imag < 0, 700j, 0), atol=1e-6)


def test_an_output_that_does_not_move_its_way():
    with pytest.raises(CannotBuild, match="does not move to and fro that way"):
        _ = toggle(sense="+x").applied
    with pytest.raises(CannotBuild, match="never turns back"):
        _ = toggle(cycle=CYCLES["output"] | {"working_sense": "+x"}).cycle


# --- turning links ---------------------------------------------------------------------------------------------------


def slotted(ab, bd, d, distance, angle, f):
    """A four-bar whose coupler point E guides a slotted link 5 about F: E goes round F, or past it, to and fro."""
    return mechanism(StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (ab, bd)), StructuralGroup(RPR, ("4", "5"), ("E", "F")),
                     fixed={"D": d + 0j, "F": f}, points=(LinkPoint("E", "2", "B", "C", distance, np.radians(angle)),))


ROUND = (0.48, 0.49, 0.23, 0.46, 119.0, -0.35 - 0.09j)
"""Link 5 turns once round in a turn of the crank, but goes back twice."""
SWINGS = (0.24, 0.42, 0.28, 0.17, -163.0, -0.27 - 0.31j)
"""Link 5 swings with four reversals."""


def seen(m, turned):
    """Angle of E from F, unwrapped from position 0 on."""
    t = np.sort(np.append(np.linspace(0, 2 * pi, 36001), turned))
    u = np.unwrap(np.angle(position_plan(m, t).points["E"].value - m.fixed["F"]))
    return u[np.searchsorted(t, turned)] - u[0], u


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("shape", [ROUND, SWINGS])
def test_a_moment_against_a_link_with_many_reversals(sense, shape):
    m = slotted(*shape)
    cycle = even_cycle(m, 0.0, 12)
    turned = TURN + 0.00123
    motion = turning_motion(m, cycle, "5", sense)
    laws, signs = by_run(motion, "both", [([0.0], [10.0])], -1.0, "M")
    law, _ = stroke_law(motion, laws, signs)
    ahead, behind = (seen(m, turned + s * 1e-6)[0] for s in (1, -1))
    np.testing.assert_array_equal(sense * law(turned, 0), -10 * np.sign(ahead - behind))
    assert len(motion.runs) > 3
    assert motion.endless == (shape is ROUND)


@pytest.mark.parametrize("sense", [1, -1])
def test_the_way_of_a_link_that_turns_round_and_goes_back(sense):
    m = slotted(*ROUND)
    motion = turning_motion(m, even_cycle(m, 0.0, 12), "5", sense)
    angle, _ = seen(m, TURN)
    np.testing.assert_allclose(motion.fraction(TURN), np.mod(angle / (2 * pi) + 1e-13, 1), atol=1e-10)
    table = ([0.0, 0.3, 0.3, 1.0], [5.0, 5.0, 9.0, 9.0])
    law, jumps = stroke_law(motion, [table] * len(motion.runs), [1.0] * len(motion.runs))
    turned = TURN + 0.00123
    np.testing.assert_array_equal(law(turned, 0), np.where(np.mod(seen(m, turned)[0] / (2 * pi), 1) < 0.3, 5, 9))
    for j in jumps:
        assert sorted((float(law(j, -1)), float(law(j, 1)))) == [5, 9]


def test_the_way_of_a_link_that_swings_with_four_reversals():
    m = slotted(*SWINGS)
    motion = turning_motion(m, even_cycle(m, 0.0, 12), "5", 1)
    angle, all_round = seen(m, TURN)
    low = all_round.min() - all_round[0]
    np.testing.assert_allclose(motion.travelled(TURN), (angle - low) / np.ptp(all_round), atol=1e-7)
    begin, end = working_stroke(motion.runs)
    np.testing.assert_allclose(motion.travelled(np.array([begin, end])), (0, 1), atol=1e-12)


def test_limits_of_the_action_on_a_way_with_reversals():
    """From 0.9 to the end of the way: on the way down, on both sides of the second top as far as it is low enough."""
    p = toggle(x=0.4)
    motion = p.applied[0].motion.within(0.9, 1.0)
    t = TURN + 0.00123
    np.testing.assert_array_equal(motion.number(t) >= 0, motion.travelled(t) > 0.9)


def test_dead_positions_are_the_extremes_of_the_output():
    """The toggle's own dead positions are constructed, but the slider's lowest place is another."""
    p = toggle(cycle=CYCLES["dead"], x=0.45)
    y = position_plan(p.mechanism, p.cycle.world(np.linspace(0, 2 * pi, 36001))).points["C"].value.imag
    s = p.cycle.strokes
    at = position_plan(p.mechanism, p.cycle.world(np.array([s.begin, s.end]))).points["C"].value.imag
    np.testing.assert_allclose(at, (y.max(), y.min()), rtol=1e-8)
    assert p.cycle.plan is None
    assert dead_cycle(p.mechanism, "B", "+x", 6, 6, None).plan is not None
