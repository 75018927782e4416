"""Numbers measured on the picture of velocities of a train of gears and on its plan of speeds."""

from math import pi

import numpy as np
import pytest

from tests.compare.students import OWN, PENCIL, READING, Hand, Plant, opened
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.construction.step import value_of


@pytest.fixture(scope="module")
def hoist():
    return opened(str(OWN / "hoist.toml"))


def test_paper_has_the_lengths_of_speeds_and_velocities(hoist):
    """n = mu_n |0n|, and a velocity is pi n r / 30, whatever was drawn on the way."""
    mu_n, mu_v = (hoist.scales[f"train-{name}"].mu for name in ("speeds", "velocities"))
    for link, n in (("1", 960), ("3", 400), ("H", 320), ("4", 256), ("5", 297.142857)):
        assert mu_n * hoist.entries[f"train-speeds/0{link}"].value == pytest.approx(n)
    assert mu_v * hoist.entries["train-velocities/Bb"].value == pytest.approx(pi * 400 / 30 * 0.048)


def test_results_are_asked_for_but_not_what_is_given(hoist):
    assert {"results/train-n2", "results/train-d5-4", "results/train-a_H"} <= hoist.entries.keys()
    assert not {"results/train-n1", "results/train-n3"} & hoist.entries.keys()


def test_a_careful_hand_is_accused_of_nothing(hoist):
    for seed in range(5):
        judged = judge(Hand(hoist, np.random.default_rng(seed)).filled(), hoist, PENCIL, READING)
        assert not [j.entry.id for j in judged if j.starts]


def test_a_velocity_drawn_off_is_where_it_starts(hoist):
    """The line of the ring goes through it, and its speed is read off by that."""
    hand = Hand(hoist, np.random.default_rng(3), (Plant("train-velocities", "", "d", 10 + 0j),))
    judged = judge(hand.filled(), hoist, PENCIL, READING)
    start, = (j for j in judged if j.starts)
    assert start.entry.id == "train-velocities/Dd"
    assert [j.entry.id for j in judged if j.follows is start] == ["train-speeds/05"]


def test_steps_on_paper_are_those_of_the_plan(hoist):
    """A parallel to a line of the picture stays one where the axes have other units."""
    plans = {plan.name: plan for plan, _ in hoist.plans}
    for link in ("1", "H", "5"):
        u, end = (complex(value_of(plans[f"train-{name}"][link])) for name in ("velocities", "speeds"))
        ray = end - complex(value_of(plans["train-speeds"]["P"]))
        assert (ray * np.conj(u)).imag == pytest.approx(0, abs=1e-9)
