"""Assembly over the whole turn: what is said, where, by how much, and that the advice helps."""

import re
from cmath import rect
from math import acos, asin, degrees, pi
from time import perf_counter

import numpy as np
import pytest
from hypothesis import given, strategies as st

from tests import project_files
from tests.methods.linkage.mechanisms import mechanism
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import PRP, RPP, RPR, RRP, RRR
from tmm_sheets.mechanism.model import Crank, Guide, LinkPoint, StructuralGroup
from tmm_sheets.methods.linkage.checks import check_assembly, check_turn
from tmm_sheets.methods.linkage.numbering import even_cycle
from tmm_sheets.methods.linkage.positions import position_plan

CLOCKWISE = Crank("1", "A", "B", 0.1, 10.0, -1)


def rrr(rod, rocker, d=0.3, **kw):
    return mechanism(StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (rod, rocker)), fixed={"D": d + 0j}, **kw)


def rrp(rod, e=0.05):
    return mechanism(StructuralGroup(RRP, ("2", "3"), ("B",), "C", (rod,), ("ram",)), guides=[Guide("ram", "0", 1j * e, 0.0)])


def rpr(pivot, offset=0.0):
    return mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C"), offset=offset), fixed={"C": pivot})


def said(m, start=0.0, positions=12):
    """Message and hint; empty when all is well."""
    try:
        check_assembly(m, even_cycle(m, start, positions))
    except CannotBuild as e:
        return str(e.args[0]), e.hint
    return "", ""


# --- what is right ---------------------------------------------------------------------------------------------------


def test_the_shaper_assembles(shaper):
    check_assembly(shaper.mechanism, shaper.cycle)
    check_turn(shaper.mechanism)


@pytest.mark.parametrize("m", [rrr(0.35, 0.25), rrr(0.2, 0.18, d=0.05), rrp(0.151), rpr(-0.14j), rpr(-0.05j), rpr(-0.14j, 0.039)])
def test_mechanisms_that_turn(m):
    assert said(m) == ("", "")


@pytest.mark.parametrize(("m", "angles"), [
    (rrr(0.3, 0.1), (0.0, 180.0)),  # a parallelogram: stretched, then folded
    (rrr(0.29999, 0.100012), (180.0,)),  # stretched but for 2 um, folded but for 22
    (rrr(0.3, 0.1001), ()),
    (rrr(0.35, 0.25), ()),
    (rrp(0.1, e=0.0), (90.0, 270.0)),  # crank and rod of one length
    (rrp(0.1001, e=0.0), ()),
    (rrp(0.150002, e=0.05), (270.0,)),
    (rpr(-0.14j), ()),
    (mechanism(), ()),
])  # fmt: skip
def test_a_group_that_passes_a_dead_position_is_told(m, angles):
    passed = check_assembly(m, even_cycle(m, 10.0, 12))
    assert [dead.group for dead in passed] == ["2-3"] * bool(angles)
    found = sorted(angle % 360 for dead in passed for angle in np.round(dead.angles, 3))
    assert found == pytest.approx(sorted(angles), abs=0.2)


@pytest.mark.parametrize(("start", "end", "told"), [(150, 210, True), (100, 180, False), (180, 260, False), (100, 170, False)])
def test_a_swing_that_ends_at_a_dead_position_does_not_pass_it(start, end, told):
    swing = {"cycle": {"start": f"{start} deg", "end": f"{end} deg", "positions": 5}}
    parallelogram = {"points.C": ["0.4 m", "0 m"], "group[1].lengths": ["0.4 m", "0.1 m"]}
    found = project_files.project(project_files.FOUR_BAR, parallelogram, swing).dead_positions
    assert [dead.group for dead in found] == ["2-3"] * told


def test_a_crank_alone_turns():
    assert said(mechanism()) == ("", "")


# --- the words -------------------------------------------------------------------------------------------------------


def test_rod_too_short_for_a_slider():
    # Position 9 is straight down, 0.15 m under the guide; 8 and 10 are 30 degrees beside it.
    reach = degrees(asin((0.12 - 0.05) / 0.1))
    assert said(rrp(0.12)) == (
        "group 2-3 does not assemble at positions 8, 9, 10: rod BC = 120 mm is 30 mm too short to reach the guide ram at worst "
        f"(position 9); reachable crank angles: {-reach:.1f}..{180 + reach:.1f} deg",
        "try BC >= 150.1 mm",
    )


def test_links_too_short_for_a_four_bar():
    # |BD|^2 = 0.1 - 0.06 cos(phi) reaches 0.35^2 at 112 degrees.
    limit = degrees(acos((0.1 - 0.35**2) / 0.06))
    assert said(rrr(0.15, 0.2)) == (
        "group 2-3 does not assemble at positions 4, 5, 6, 7, 8: BC = 150 mm and CD = 200 mm together are 50 mm too short at worst "
        f"(position 6); reachable crank angles: {-limit:.1f}..{limit:.1f} deg",
        "try BC from 200.1 mm to 399.9 mm",
    )


def test_rod_too_long_for_a_four_bar():
    limit = degrees(acos((0.1 - 0.3**2) / 0.06))
    assert said(rrr(0.4, 0.1)) == (
        "group 2-3 does not assemble at positions 0, 1, 2, 10, 11: BC = 400 mm is 100 mm too long beside CD = 100 mm at worst "
        f"(position 0); reachable crank angles: {limit:.1f}..{360 - limit:.1f} deg",
        "try CD from 200.1 mm to 599.9 mm",
    )


def test_nothing_assembles_anywhere():
    message, hint = said(rrr(0.05, 0.6))
    assert message == "group 2-3 does not assemble at any position: CD = 600 mm is 350 mm too long beside BC = 50 mm"
    assert hint == "try BC from 400.1 mm to 799.9 mm"


@pytest.mark.parametrize(("way", "far"), [({"positions": 12}, pi), ({"end": "120 deg", "positions": 5}, 2 * pi / 3)])
def test_advice_for_a_swing_asks_for_no_more_than_the_swing(way, far):
    short = {"group[1].lengths": ["0.15 m", "0.25 m"], "points.C": ["0.42 m", "0 m"], "cycle": {"start": "60 deg", **way}}
    with pytest.raises(CannotBuild) as told:
        _ = project_files.project(project_files.FOUR_BAR, short).dead_positions
    least = float(re.findall(r"[\d.]+", told.value.hint)[0]) / 1e3
    assert 0 < least - (abs(rect(0.1, far) - 0.42) - 0.25) < 1e-3


def test_offset_too_large():
    limit = degrees(asin((0.14**2 + 0.1**2 - 0.05**2) / (2 * 0.14 * 0.1)))
    message, hint = said(rpr(-0.14j, 0.05))
    assert message.startswith("group 2-3 does not assemble at position 9: B comes 10 mm too near to C for the offset of 50 mm")
    assert message.endswith(f"reachable crank angles: {-limit:.1f}..{180 + limit:.1f} deg")
    assert hint == "try an offset below 39.99 mm"


@pytest.mark.parametrize("angle", [270.0, 19.1, 200.123])
def test_pin_through_the_pivot_even_between_the_angles_of_the_sweep(angle):
    at = "position 9" if angle == 270 else f"crank angle {angle:.1f} deg"
    message, hint = said(rpr(0.1 * np.exp(1j * np.radians(angle))))
    assert message == f"group 2-3 does not assemble at {at}: B passes through C, so that the guide CB has no direction"
    assert hint == "move C off the path of B"


def test_guides_that_become_parallel():
    guides = [Guide("a", "0", 0.05j, 0.0), Guide("b", "1", "B", np.radians(65.7), "A")]
    message, _ = said(mechanism(StructuralGroup(PRP, ("2", "3"), (), "C", (), ("a", "b")), guides=guides))
    assert message == "group 2-3 does not assemble at crank angles 114.3, 294.3 deg: the guides a and b are parallel there"


def test_fixed_guides_that_are_parallel():
    guides = [Guide("a", "0", 0.05j, 0.0), Guide("b", "0", 0.2j, np.pi)]
    message, _ = said(mechanism(StructuralGroup(PRP, ("2", "3"), (), "C", (), ("a", "b")), guides=guides))
    assert message == "group 2-3 does not assemble at any position: the guides a and b are parallel there"


def test_slot_along_its_guide():
    m = mechanism(StructuralGroup(RPP, ("2", "3"), ("B",), "S", (), ("a",), slot=np.pi), guides=[Guide("a", "0", 0.05j, 0.0)])
    assert said(m) == ("group 2-3 does not assemble at any position: the slot of link 3 is parallel to its guide a",
                       'try slot = "90 deg"')


def test_between_the_numbered_positions_only():
    """Four positions miss a gap of some degrees; the crank cannot turn through it all the same."""
    message, _ = said(rrp(0.149), start=np.pi / 4, positions=4)
    limit = degrees(asin(0.99))
    gap = f"{180 + limit:.1f}..{360 - limit:.1f}"
    assert message.startswith(f"group 2-3 does not assemble at crank angles {gap} deg: rod BC = 149 mm is 1 mm too short")
    assert "(crank angle 270.0 deg)" in message


def test_a_gap_narrower_than_the_sweep():
    # 1e-7 m short: the gap is 0.16 degrees wide and lies between two angles of the sweep.
    m = rrp(0.15 - 1e-7)
    message, hint = said(m, start=0.2)
    assert re.search(r"at crank angles 269\.9\.\.270\.1 deg: rod BC = 150 mm is less than 0\.001 mm too short", message)
    assert hint == "try BC >= 150.1 mm"


def test_chain_names_each_group_that_fails_by_itself():
    """Group 4-5 is judged where group 2-3 assembles; the advice is for the first."""
    m = mechanism(
        StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.15, 0.2)),
        StructuralGroup(RRP, ("4", "5"), ("C",), "E", (0.2,), ("y",)),
        fixed={"D": 0.3 + 0j}, guides=[Guide("y", "0", 0.5 + 0j, np.pi / 2)],
    )
    message, hint = said(m)
    first, second = message.split("\n")
    assert first.startswith("group 2-3 does not assemble at positions 4, 5, 6, 7, 8")
    assert second.startswith("group 4-5 does not assemble at positions")
    assert not set("45678") & set(re.search("positions ([^:]*):", second)[1].split(", "))
    assert hint.startswith("try BC")


def test_what_lies_downstream_of_a_failing_group_is_not_blamed():
    m = mechanism(
        StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.15, 0.2)),
        StructuralGroup(RRP, ("4", "5"), ("C",), "E", (0.9,), ("y",)),
        fixed={"D": 0.3 + 0j}, guides=[Guide("y", "0", 0.5 + 0j, np.pi / 2)],
    )
    assert said(m)[0].count("\n") == 0
    assert "group 4-5" not in said(m)[0]


def test_points_that_cannot_be_constructed():
    """A line through two points that fall together in position 0: the pin and the point of the crank under it."""
    m = mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C")), fixed={"C": -0.2j},
                  points=[LinkPoint("E", "1", "A", "B", 0.1), LinkPoint("F", "1", "B", "E", 0.1)])
    with pytest.raises(CannotBuild, match="BE cannot be constructed at positions 0, 1, 2, 3"):
        check_assembly(m, even_cycle(m, 0.0, 4))


def test_clockwise_is_the_same_backwards():
    forward = said(rrr(0.15, 0.2), start=0.2, positions=8)[0]
    backward = said(rrr(0.15, 0.2, crank=CLOCKWISE), start=0.2, positions=8)[0]
    assert forward.rsplit(";")[1] == backward.rsplit(";")[1]


def test_before_the_positions_are_numbered():
    with pytest.raises(CannotBuild, match=r"does not assemble at crank angles 112\.0\.\.248\.0 deg: .* \(crank angle 180\.0 deg\)"):
        check_turn(rrr(0.15, 0.2))


# --- against brute force ---------------------------------------------------------------------------------------------


def advice(hint):
    return [float(x) / 1000 for x in re.findall(r"([\d.]+) mm", hint)]


@given(st.floats(0.01, 0.5), st.floats(0, 0.3))
def test_slider_agrees_with_geometry_and_the_advice_helps(rod, e):
    message, hint = said(rrp(rod, e))
    need = e + 0.1
    if rod > need:
        assert message == ""
    if rod < need * (1 - 1e-9):
        assert "too short" in message
        enough, = advice(hint)
        assert need < enough < need * 1.002
        assert said(rrp(enough, e)) == ("", "")


@given(st.floats(0.02, 0.6), st.floats(0.02, 0.6), st.floats(0.02, 0.5))
def test_four_bar_agrees_with_geometry_and_the_advice_helps(rod, rocker, d):
    message, hint = said(rrr(rod, rocker, d), start=0.1)
    near, far = abs(d - 0.1), d + 0.1
    turns = rod + rocker >= far and abs(rod - rocker) <= near
    sure = abs(rod + rocker - far) > 1e-9 and abs(abs(rod - rocker) - near) > 1e-9
    if sure:
        assert (message == "") == turns
    if not message:
        return
    lengths = {"BC": rod, "CD": rocker}
    name = re.match("try (BC|CD)", hint)[1]
    if " from " in hint:
        low, high = advice(hint)
        for length in (low, (low + high) / 2, high):
            changed = lengths | {name: length}
            assert said(rrr(changed["BC"], changed["CD"], d), start=0.1) == ("", "")


@given(st.floats(0.02, 0.6), st.floats(0.02, 0.6), st.floats(0.05, 0.5))
def test_positions_and_limits_agree_with_the_plan(rod, rocker, d):
    m = rrr(rod, rocker, d)
    message = said(m, start=0.1)[0]
    cycle = even_cycle(m, 0.1, 12)
    missing = np.flatnonzero(np.isnan(position_plan(m, cycle.phi).points["C"].value)).tolist()
    named = [int(label) for found in re.findall("at positions? ([^:]*):", message) for label in found.split(", ")]
    assert missing == (list(range(12)) if "any position" in message else sorted(named))
    for low, high in re.findall(r"reachable crank angles: (-?[\d.]+)\.\.(-?[\d.]+) deg", message)[-1:]:
        if float(high) - float(low) > 1:
            inside = np.radians(np.linspace(float(low) + 0.1, float(high) - 0.1, 50))
            outside = np.radians([float(low) - 0.1, float(high) + 0.1])
            if message.count("\n") == 0:
                assert not np.isnan(position_plan(m, inside).points["C"].value).any()
            assert np.isnan(position_plan(m, outside).points["C"].value).all()


def test_quick(shaper):
    check_assembly(shaper.mechanism, shaper.cycle)
    times = []
    for _ in range(5):
        start = perf_counter()
        check_assembly(shaper.mechanism, shaper.cycle)
        times.append(perf_counter() - start)
    assert min(times) < 0.005


def test_strokes_where_a_group_comes_to_its_dead_position():
    """"It never turns back", it said of a parallelogram, and advised an angle that was given."""
    parallelogram = {"points.C": ["0.4 m", "0 m"], "group[1].lengths": ["0.4 m", "0.1 m"],
                     "cycle": {"start": "30 deg", "positions": 12, "output": "B", "working_sense": "+x"}}
    with pytest.raises(CannotBuild, match=r"group 2-3 is stretched or folded at crank angles 0\.0, 180\.0 deg") as told:
        _ = project_files.project(project_files.FOUR_BAR, parallelogram).cycle
    assert "strokes of B" in told.value.hint
