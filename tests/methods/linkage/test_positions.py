"""Position plans of all kinds of groups against trigonometry in 50 digits; lengths, sides, NaN where nothing assembles."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests.methods.linkage import truth
from tests.methods.linkage.mechanisms import mechanism, mechanisms, value
from tests.methods.settings import every_kind, kinds_alone, tried
from tmm_sheets.mechanism.groups import RPR, RRP, RRR
from tmm_sheets.mechanism.model import Guide, LinkPoint, StructuralGroup
from tmm_sheets.methods.linkage.positions import position_plan

TURN = np.linspace(-np.pi, np.pi, 721)


# --- the shaper ------------------------------------------------------------------------------------------------------


def test_shaper_at_its_positions(shaper):
    pos = shaper.study.positions
    for k, phi in enumerate(pos.phi):
        for name, z in truth.shaper_motion(phi, 1.0)[0].items():
            assert abs(value(pos.points[name], k) - z) < 2e-16 * truth.CD


def test_shaper_anywhere(shaper):
    phi = np.random.default_rng(1).uniform(-10, 10, 40)
    pos = position_plan(shaper.mechanism, phi)
    for k, at in enumerate(phi):
        for name, z in truth.shaper_motion(at, 1.0)[0].items():
            assert abs(value(pos.points[name], k) - z) < 1e-15


def test_position_3_is_straight_up_and_8_straight_down(shaper):
    b = shaper.study.positions.points["B"]
    assert abs(value(b, 3) - 0.08j) < 1e-16
    assert abs(value(b, 8) + 0.08j) < 1e-16
    # Position 2 leans left: clockwise, working stroke from left to right.
    assert value(b, 2).real < 0


# --- all kinds of groups ---------------------------------------------------------------------------------------------


@every_kind
def test_against_trigonometry(kinds):
    @tried(kinds)
    @given(mechanisms(kinds))
    def check(drawn):
        m, phi = drawn
        pos = position_plan(m, np.array([phi]))
        with mpmath.workdps(truth.DIGITS):
            true = truth.state(m, mpmath.mpf(phi))
        size = max(m.crank.length, *(abs(complex(z)) for z in true.points.values()))
        for name, z in true.points.items():
            assert abs(value(pos.points[name]) - complex(z)) < 1e-14 * size
        for g in m.groups:
            for link in g.links:
                assert abs(abs(value(pos.directions[link])) - 1) < 1e-15

    check()


@kinds_alone
def test_links_keep_their_lengths_and_sides(kinds):
    @tried(kinds)
    @given(mechanisms(kinds), st.integers(0, 3))
    def check(drawn, quarter):
        m, phi = drawn
        # Angles all round: where a group does not assemble, nothing is asked of it.
        pos = position_plan(m, phi + quarter * np.pi / 2 + np.linspace(0, 0.5, 6))
        p = {name: np.broadcast_to(step.value, 6) for name, step in pos.points.items()}
        size = m.crank.length + np.nanmax([abs(z) for z in p.values()])

        def same(x, y):
            assert (abs(x - y)[~np.isnan(x)] <= 1e-13 * size).all()

        for g in m.groups:
            at = [p[name] for name in g.outer]
            if g.kind.number == 1:
                c = p[g.inner]
                same(abs(c - at[0]), g.lengths[0])
                same(abs(c - at[1]), g.lengths[1])
                left = (np.conj(at[1] - at[0]) * (c - at[0])).imag
                # On the line of the pivots itself (a dead position) the side is lost to rounding.
                assert not (left * g.side < -1e-13 * size**2).any()
            elif g.kind.number == 2:
                c, u = p[g.inner], pos.guide_directions[g.guides[0]].value
                same(abs(c - at[0]), g.lengths[0])
                assert not ((np.conj(u) * (c - at[0])).real * g.side < -1e-13 * size).any()
            elif g.kind.number == 3:
                u = pos.directions[g.links[1]].value
                across = (np.conj(u) * (at[0] - at[1])).imag
                same(across, -g.side * g.offset)
            for name, guide in ((n, pos.guide_points[n].value) for n in g.guides if g.inner):
                u = pos.guide_directions[name].value
                same((np.conj(u) * (p[g.inner] - guide)).imag, 0.0)

    check()


@kinds_alone
def test_one_angle_or_many_in_any_order(kinds):
    @tried(kinds)
    @given(mechanisms(kinds), st.randoms(use_true_random=False))
    def check(drawn, random):
        m, phi = drawn
        angles = phi + np.array([0.0, 0.3, -0.4, 2.0, 2.5, -3.0])
        order = random.sample(range(6), 6)
        together, shuffled = position_plan(m, angles), position_plan(m, angles[order])
        for name, step in together.points.items():
            all_at_once = np.broadcast_to(step.value, 6)
            np.testing.assert_array_equal(np.broadcast_to(shuffled.points[name].value, 6), all_at_once[order])
        for k in (0, 3):
            alone = position_plan(m, angles[k])
            for name, step in together.points.items():
                np.testing.assert_allclose(alone.points[name].value, np.broadcast_to(step.value, 6)[k], rtol=1e-13)

    check()


# --- what does not assemble ------------------------------------------------------------------------------------------


def rrr(rod, rocker):
    return mechanism(StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (rod, rocker)), fixed={"D": 0.3 + 0j})


def rrp(rod):
    return mechanism(StructuralGroup(RRP, ("2", "3"), ("B",), "C", (rod,), ("x",)), guides=[Guide("x", "0", 0.05j, 0.0)])


def rpr(offset):
    return mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C"), offset=offset), fixed={"C": -0.14j})


@pytest.mark.parametrize(
    ("m", "assembles", "point"),
    [
        (rrr(0.15, 0.2), lambda d: d < 0.35, "C"),
        (rrr(0.4, 0.1), lambda d: d > 0.3, "C"),
        (rrp(0.12), lambda y: abs(y - 0.05) < 0.12, "C"),
        (rpr(0.07), lambda d: d > 0.07, "C₁"),
    ],
    ids=["rod too short", "rod too long", "rod short of the guide", "offset too large"],
)
def test_nan_exactly_where_it_does_not_assemble(m, assembles, point):
    b = 0.1 * np.exp(1j * TURN)
    reach = b.imag if "x" in m.guides else abs(b - next(z for n, z in m.fixed.items() if n != "A"))
    expected = assembles(reach)
    assert 0 < expected.sum() < len(TURN)
    built = ~np.isnan(position_plan(m, TURN).points[point].value)
    np.testing.assert_array_equal(built, expected)
    # The other positions are what they are without the bad ones beside them.
    alone = position_plan(m, TURN[expected]).points[point].value
    np.testing.assert_array_equal(alone, position_plan(m, TURN).points[point].value[expected])


def test_what_hangs_on_an_unbuilt_group_is_nan_and_the_rest_is_not():
    m = rrr(0.15, 0.2)
    m = replace(m, points=(LinkPoint("E", "3", "D", "C", 0.1), LinkPoint("F", "1", "A", "B", 0.1)))
    points = position_plan(m, TURN).points
    np.testing.assert_array_equal(np.isnan(points["E"].value), np.isnan(points["C"].value))
    assert not np.isnan(points["F"].value).any()


def test_check_names_the_step_and_the_positions():
    labels = tuple(str(k) for k in range(4))
    plan = position_plan(rrr(0.15, 0.2), np.arange(4) * np.pi / 2, labels).plan
    assert plan.check() == ("C", ("2",))
    assert position_plan(rrr(0.35, 0.25), np.arange(4) * np.pi / 2, labels).plan.check() is None


# --- names -----------------------------------------------------------------------------------------------------------


def test_names_that_look_like_other_names():
    """A guide named like a point, a point named like a line: nothing is mixed up."""
    m = mechanism(
        StructuralGroup(RRP, ("2", "3"), ("B",), "C", (0.3,), ("B",)),
        guides=[Guide("B", "0", 0.05j, 0.0)],
        points=[LinkPoint("AB", "1", "A", "B", 0.05, 1.0), LinkPoint("BC", "2", "B", "C", 0.05, 1.0)],
    )
    pos = position_plan(m, np.array([0.7]))
    assert abs(value(pos.points["AB"]) - 0.05 * np.exp(1.7j)) < 1e-17
    assert abs(value(pos.points["C"]) - value(pos.points["B"])) == pytest.approx(0.3)
    assert abs(value(pos.points["BC"]) - value(pos.points["B"])) == pytest.approx(0.05)


def test_points_of_a_rocker_with_an_offset_turn_with_it():
    m = rpr(0.03)
    m = replace(m, points=(LinkPoint("D", "3", "C", "B", 0.2, 0.5),))
    pos = position_plan(m, TURN)
    d, c, u = (x.value for x in (pos.points["D"], pos.points["C"], pos.directions["3"]))
    np.testing.assert_allclose((d - c) / u, 0.2 * np.exp(0.5j), rtol=1e-14)
