"""The search for tooth numbers against trying everything, and over all columns of manual 003."""

from itertools import product
from math import pi

import numpy as np
import pytest

from tests.few import few
from tests.methods.gears import reducer_cases as cases
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears.planetary import (
    RUNNERS_UP,
    SCHEMES,
    assembles,
    inner_ratio,
    least_ring,
    neighbours_clear,
    search,
    stage_ratio,
)


def everything(d):
    """All permitted sets in the search's order, found by loops: (tier, height, deviation, teeth ...)."""
    scheme = SCHEMES[d.scheme]
    s1, s2 = scheme.signs
    driver = d.driver or scheme.drivers[0]
    teeth = range(d.least_teeth, d.most_teeth + 1)
    pinion = next(iter(d.teeth.values()))
    low, high = d.simple_ratio
    found = []
    for one, two, three in product(teeth, teeth, teeth):
        if (scheme.single and three != two) or (not scheme.single and three == two):
            continue
        z = (one, two, three, s2 * (one + s1 * two - three)) if s2 > 0 else (one, two, three, one + s1 * two + three)
        if z[3] < d.least_teeth or not assembles((s1, s2), z, d.satellites):
            continue
        if not neighbours_clear((s1, s2), z, d.satellites, d.addendum):
            continue
        inner = z[1] * z[3] / (z[0] * z[2]) * s1 * s2
        if inner == 1:
            continue
        i = abs({"sun": 1 - inner, "ring": 1 - 1 / inner, "carrier": 1 / (1 - inner)}[driver]) ** d.stages
        for big in range(pinion, 5 * pinion):
            if not low <= big / pinion <= high or big > d.most_teeth:
                continue
            ratio = i * big / pinion
            off = abs(ratio / d.ratio - 1)
            if off > d.tolerance:
                continue
            tier = 0 if off <= 0.01 else 1 if off <= 0.02 else 2
            stage = (one + s1 * two + max(two, three)) * d.module / 2
            r1, r2 = pinion * d.simple_module / 2, big * d.simple_module / 2
            near, far = (r1, r2) if d.simple == "after" else (r2, r1)  # on the main axis, beside it
            height = max(stage, near) + max(stage, near + 2 * far)
            found.append((tier, round(height, 9), round(off, 12), z, big))
    return sorted(found)


@pytest.mark.parametrize("d", [
    cases.data(ratio=6.0, simple="before", pinion=("z1", 12), satellites=4, most_teeth=60, simple_ratio=(1.0, 4.0)),
    cases.data(ratio=8.3, stages=2, pinion=("z7", 11), most_teeth=58, simple_ratio=(1.2, 4.0)),
    cases.data(ratio=9.0, stages=2, driver="ring", pinion=("z7", 13), most_teeth=58, simple_ratio=(1.2, 4.0)),
    cases.data("external-internal", ratio=13.5, pinion=("z5", 11), satellites=4, most_teeth=34, simple_ratio=(1.5, 4.0)),
    cases.data("two external", ratio=17.0, pinion=("z5", 10), most_teeth=34, addendum=0.8, simple_ratio=(1.5, 4.0)),
    cases.data("two internal", ratio=19.0, pinion=("z5", 14), satellites=2, most_teeth=52, simple_ratio=(1.5, 4.0)),
], ids=lambda d: d.scheme)
def test_chosen_and_runners_up_are_the_first_of_all(d):
    found, truth = search(d), everything(d)
    assert len(found) == min(RUNNERS_UP + 1, len(truth))
    for got, (_, height, off, z, big) in zip(found, truth, strict=False):
        assert got.height == pytest.approx(height, abs=1e-9)
        assert abs(got.deviation) == pytest.approx(off, abs=1e-11)
        assert (got.stage, got.wheel) == (z, big)


@pytest.mark.parametrize("machine", cases.MACHINES)
@pytest.mark.parametrize("c", range(10))
def test_all_ten_columns(machine, c):
    d = cases.column(machine, c)
    if (machine, c) == ("compressor", 9):
        with pytest.raises(CannotBuild, match=r"no tooth set within 5 % of the ratio 5\.8"):
            search(d)
        return
    asked = d.input_speed / d.output_speed
    scheme = SCHEMES[d.scheme]
    for t in search(d):
        one, two, three, four = t.stage
        s1, s2 = scheme.signs
        assert one + s1 * two == four + s2 * three
        assert min(t.stage) >= 15
        assert assembles(scheme.signs, t.stage, d.satellites)
        assert neighbours_clear(scheme.signs, t.stage, d.satellites, d.addendum)
        stage = abs(stage_ratio(inner_ratio(scheme.signs, t.stage), scheme.drivers[0]))
        assert t.ratio == pytest.approx(stage**d.stages * t.wheel / t.pinion, rel=1e-14)
        assert abs(t.ratio / asked - 1) <= 0.05 * (1 + 1e-9)
        assert t.deviation == pytest.approx(t.ratio / asked - 1, abs=1e-14)


def test_ratios_of_the_tables():
    def asked(machine):
        return [cases.column(machine, c).input_speed / cases.column(machine, c).output_speed for c in range(10)]

    assert asked("press") == pytest.approx(list(range(15, 25)), rel=1e-14)
    assert asked("crusher") == pytest.approx([15, 14, 13.5, 13, 12.5, 12, 11.5, 11, 10.5, 10], rel=1e-14)
    assert asked("compressor") == pytest.approx(
        [9.6667, 7.35, 6.1875, 8.3056, 7.8947, 8.8235, 7.1190, 9.28125, 6.6818, 5.8], abs=5e-5)


def failures(machine, letters, **over):
    """Codes of the machine that have no tooth set, of ``10 ** len(letters)``: letter -> keys of the table it chooses."""
    table, refused = cases.rows(machine), {}
    total = 0
    for digits in product(range(10), repeat=len(letters)):
        chosen = {key: table[key][digit] for digit, keys in zip(digits, letters, strict=True) for key in keys}
        case = (round(chosen["n_in"] / chosen["n_out"], 3), *(chosen.get(k) for k in ("q", "z1", "z5", "z7", "ha")))
        if case not in refused:
            values = {"input_speed": chosen["n_in"] * pi / 30, "output_speed": chosen["n_out"] * pi / 30,
                      "satellites": chosen["q"], "addendum": float(chosen.get("ha", 1))}
            pinion = cases.SCHEMES[machine][3]
            try:
                search(cases.column(machine, 0, **(values | {"pinion": (pinion, chosen[pinion])} | over)))
                refused[case] = False
            except CannotBuild:
                refused[case] = True
        total += refused[case]
    return total, {case[0] for case, failed in refused.items() if failed}


def test_diesel_cannot_have_the_two_least_ratios():
    """Letters а, г, в: 960 of 1000 codes; a ring much larger than its sun cannot go so slow."""
    assert failures("diesel", (("n_in",), ("n_out", "z1"), ("q",))) == (40, {2.0, 2.083})


def test_compressor_fails_with_the_least_ratio_and_eleven_teeth_only():
    """Letters а, г, д: 970 of 1000 codes with driving suns, all with driving rings."""
    letters = (("n_in", "n_out"), ("q",), ("z7",))
    assert failures("compressor", letters) == (30, {5.8})
    assert failures("compressor", letters, driver="ring") == (0, set())


@pytest.mark.parametrize("step", few((3, 9), 9))
def test_press_and_crusher_always_have_tooth_sets(step):
    """Letters а, г and в, б: every tenth code of the press, with both kinds of blocks, and of the crusher; or one in thirty."""
    some = slice(None, None, step)
    for machine, over in (("press", {}), ("press", {"scheme": "two internal"}), ("crusher", {})):
        table = cases.rows(machine)
        for c, z5, q, ha in product(range(10), sorted(set(table["z5"]))[some], (3, 4), (0.8, 1.0)):
            search(cases.column(machine, c, satellites=q, addendum=ha, pinion=("z5", z5), **over))


def test_strict_rings_mesh_without_interference():
    for d in (cases.data(ratio=4.5, simple="before", pinion=("z1", 12), strict_internal=True),
              cases.data("external-internal", ratio=13.0, pinion=("z5", 12), strict_internal=True, addendum=0.8),
              cases.data("two internal", ratio=18.0, pinion=("z5", 12), strict_internal=True, addendum=0.8)):
        signs = SCHEMES[d.scheme].signs
        for t in search(d):
            for satellite, ring, sign in ((t.stage[1], t.stage[0], signs[0]), (t.stage[2], t.stage[3], signs[1])):
                if sign < 0:
                    assert ring >= least_ring(satellite, d.addendum) > 0


def test_given_teeth_are_kept():
    d = cases.column("crusher", 0)
    d.teeth = {"z5": 12, "z6": 24, "z1": 18}
    for t in search(d):
        assert (t.stage[0], t.pinion, t.wheel) == (18, 12, 24)
    d.teeth = {"z5": 12, "z1": 15, "z2": 30, "z3": 15, "z4": 60, "z6": 20}
    assert [t.stage for t in search(d)] == [(15, 30, 15, 60)]


def test_refusals_say_what_is_wrong():
    d = cases.column("crusher", 0)
    d.teeth = {"z5": 12, "z1": 15, "z2": 30, "z3": 15, "z4": 60, "z6": 30}
    with pytest.raises(CannotBuild, match=r"the nearest, z1 = 15, .*z6 = 30, gives 22\.5 \(\+50\.0 %\)"):
        search(d)
    d.teeth = {"z5": 12, "z9": 3}
    with pytest.raises(CannotBuild, match=r"teeth has z9; here are z1, z2, z3, z4, z5, z6"):
        search(d)
    d.teeth = {"z1": 18}
    with pytest.raises(CannotBuild, match="teeth has no z5, the pinion of the simple stage"):
        search(d)
    d.teeth = {"z5": 12, "z1": 15, "z4": 16}
    with pytest.raises(CannotBuild, match="coaxiality, assembly and neighbourhood"):
        search(d)


def test_nearest_is_the_nearest():
    d = cases.data(ratio=2.0, simple="before", pinion=("z1", 12), most_teeth=40)
    best = min(
        (1 + (one + 2 * two) / one) * big / 12 for one, two, big in product(range(15, 41), range(15, 41), range(12, 41))
        if (2 * one + 2 * two) % 3 == 0 and neighbours_clear((1, -1), (one, two, two, one + 2 * two), 3, 1.0))
    with pytest.raises(CannotBuild, match=rf"gives {best:.4g} \(\+{(best / 2 - 1) * 100:.1f} %\)"):
        search(d)


def test_same_input_same_choice():
    d = cases.column("press", 4)
    assert search(d) == search(d)
    assert np.isfinite([t.height for t in search(d)]).all()
