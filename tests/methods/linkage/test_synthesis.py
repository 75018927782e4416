"""Lengths from conditions: closed forms in 40 digits, and the conditions measured back from the mechanism they give."""

import re
import tomllib
from math import pi
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from tests import project_files as files
from tmm_sheets import catalogue
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.methods.linkage.synthesis import Synthesis
from tmm_sheets.project import Project

ENGINE = files.from_file("lugansk/engine")


def conditions(**given):
    empty = dict.fromkeys(("coefficient", "stroke", "centre_distance", "mean_velocity", "rod_ratio", "centre_ratio", "round"))
    return SimpleNamespace(**{**empty, **given})


def quick_return(k, stroke, distance, **more):
    return Synthesis(conditions(kind="quick return", coefficient=k, stroke=stroke, centre_distance=distance, **more), 1.0)


def synthesised():
    """The shaper with the alternative of its own comment taken."""
    text = re.sub(r"(?m)^#(?=[\[a-z])", "", catalogue.read("lugansk/shaper").text)
    return files.merged(tomllib.loads(text), {
        "crank.length": "synthesis l_AB", "point[1].distance": "synthesis l_CD", "point[2].distance": "synthesis l_CS"})


def test_shaper_of_the_manual():
    s = quick_return(1.5, 0.35, 0.26, centre_ratio=0.5, round=0.001)
    assert s.lengths == {"l_AC": 0.26, "H": 0.35, "l_AB": 0.08, "l_CD": 0.566, "l_CS": 0.283}
    assert s.exact["l_AB"] == pytest.approx(0.080344, abs=5e-7)
    assert s.exact["l_CD"] == pytest.approx(0.566312, abs=5e-7)


def test_engine_of_the_manual():
    s = Synthesis(conditions(kind="engine", mean_velocity=8.64, rod_ratio=3.56, centre_ratio=0.28, round=0.001), 80 * pi)
    assert s.lengths == {"H": pytest.approx(0.108, rel=1e-15), "l_AB": 0.054, "l_BC": 0.192, "l_BS": 0.054}


@given(st.floats(1.02, 4), st.floats(0.01, 5), st.floats(0.01, 5))
def test_quick_return_against_closed_forms(k, stroke, distance):
    s = quick_return(k, stroke, distance)
    with mp.workdps(40):
        half = mp.pi * (mp.mpf(k) - 1) / (mp.mpf(k) + 1) / 2
        assert s.exact["l_AB"] == pytest.approx(float(distance * mp.sin(half)), rel=1e-13)
        assert s.exact["l_CD"] == pytest.approx(float(stroke / (2 * mp.sin(half))), rel=1e-13)
    assert s.lengths == s.exact


@settings(max_examples=15)
@given(st.floats(1.1, 2.5), st.floats(0.1, 0.6), st.floats(0.1, 0.6))
def test_the_mechanism_has_the_conditions(k, stroke, distance):
    """Without rounding: its dead positions give K, and the ram its stroke."""
    project = files.project(synthesised(), {
        "synthesis": {"coefficient": k, "stroke": f"{stroke!r} m", "centre_distance": f"{distance!r} m"}, "synthesis.round": None,
        "points.C": ["0 m", "-synthesis l_AC"], "cycle.division": "exact", "guide[1].through[2]": "2 m"})
    cycle = project.cycle
    working = cycle.turned[6]
    assert working / (2 * pi - working) == pytest.approx(k, rel=1e-9)
    assert cycle.strokes.length == pytest.approx(stroke, rel=1e-9)


def test_both_ways_of_the_shaper_are_one():
    given = Project(catalogue.read("lugansk/shaper"))
    found = files.project(synthesised())
    assert found.mechanism == given.mechanism
    assert np.array_equal(found.cycle.turned, given.cycle.turned)


def test_both_ways_of_the_engine_are_one():
    rods, centres = {"length": "0.192 m"}, {"distance": "0.05376 m"}
    given = files.project(ENGINE, {"synthesis": None, "crank.length": "0.054 m", "point[1].distance": "0.054 m", "group[1]": rods,
                                   "group[2]": rods, "point[2]": centres, "point[3]": centres})
    assert given.mechanism == Project(catalogue.read("lugansk/engine")).mechanism


def test_steps_speak():
    s = quick_return(1.5, 0.35, 0.26, round=0.001)
    told = " ".join(sentences(s.plan, 0, lambda x: x * 1000))
    assert "θ = 180°·(K − 1)/(K + 1) = 180°·(1,5 − 1)/(1,5 + 1) = 36°." in told
    assert "Округлим до 1,0 мм: l_AB′ = 80,0 мм." in told
    assert s.derivation[1] == "l_AB = l_AC·sin(θ/2) = 0,26·sin 18° = 0,080344 м;  принято 0,08 м"


def test_rounded_to_nothing():
    with pytest.raises(CannotBuild, match=r"l_AB = 80\.34 mm is rounded to nothing"):
        _ = quick_return(1.5, 0.35, 0.26, round=0.5).lengths


@pytest.mark.parametrize(("changes", "said"), [
    ({"group[1].length": "synthesis l_CD"}, 'unknown result "l_CD"'),
    ({"point[2].distance": "synthesis"}, "which length of the synthesis?"),
    ({"synthesis.rod_ratio": None}, "needs rod_ratio as well"),
    ({"synthesis.rod_ratio": 0.5}, "expected a ratio greater than 1"),
    ({"synthesis.coefficient": 2}, 'kind = "engine" has no coefficient'),
    ({"synthesis.round": "1 m"}, "l_AB = 54 mm is rounded to nothing"),
    ({"synthesis.mean_velocity": "8.64 mm"}, "'mm' is a unit of length"),
])  # fmt: skip
def test_wrong_conditions(changes, said):
    with pytest.raises(BadInput, match=said.replace("?", r"\?")):
        files.read(ENGINE, changes)


def test_no_conditions():
    with pytest.raises(BadInput, match=r"crank\.length: there is no \[synthesis\]"):
        files.read(files.from_file("lugansk/shaper"), {"crank.length": "synthesis l_AB"})


def test_natural_places_need_no_name():
    places = dict.fromkeys(("crank.length", "group[1].length", "group[2].length"), "synthesis")
    assert files.project(ENGINE, places).mechanism == Project(catalogue.read("lugansk/engine")).mechanism
