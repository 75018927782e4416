"""The plan, theirs and ours, from measured numbers: where the points lie, and which are left out."""

import numpy as np
import pytest

from tests.compare.hypotheses import KINDS, Slipping
from tests.compare.students import PENCIL, READING, opened
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.plan_pictures import PlanPictures, _Tie, laid_out

A, B, C, D = "abcd"  # steps are only told apart


def tie(tail, head, value, is_angle=False):
    return _Tie(tail, head, value, is_angle, 0.5)


@pytest.mark.parametrize("near", [3 + 5j, 3 - 5j])
def test_two_lengths_fix_a_point_on_the_side_it_was_expected(near):
    found = laid_out({A: 0j, B: 6 + 0j}, {C: near}, [tie(A, C, 5.0), tie(B, C, 5.0)])
    assert found[C] == pytest.approx(3 + 4j * np.sign(near.imag))


def test_a_length_and_a_direction_fix_a_point_and_others_from_there():
    ties = [tie(A, C, 10.0), tie(A, C, 90.0, True), tie(C, D, 5.0), tie(A, D, np.hypot(10, 5))]
    found = laid_out({A: 0j}, {C: 1 + 9j, D: 4 + 9j}, ties)
    assert found[C] == pytest.approx(10j)
    assert found[D] == pytest.approx(5 + 10j)


def test_a_point_that_one_number_reaches_is_left_out():
    assert laid_out({A: 0j}, {C: 1j}, [tie(A, C, 5.0)]) == {A: 0j}
    assert laid_out({A: 0j}, {}, []) == {A: 0j}


def test_numbers_that_do_not_meet_are_adjusted():
    """Arcs that miss each other by 2 mm: between them, on the line of centres, nearly."""
    found = laid_out({A: 0j, B: 10 + 0j}, {C: 5 + 1j}, [tie(A, C, 4.0), tie(B, C, 4.0)])
    assert found[C].real == pytest.approx(5)
    assert abs(found[C].imag) < 1.5


def test_a_reversed_vector_is_shown_as_it_was_drawn():
    """Theirs lies on what the mistake makes, not on the exact plan."""
    found, rng = opened("lugansk/shaper"), np.random.default_rng([7, 3])
    slip = KINDS["coriolis"](found, rng)
    some = {name: e for name, e in found.entries.items() if e.main}
    judged = judge(Slipping(found, rng, (slip,)).filled(some), found, PENCIL, READING)
    start = next(j for j in judged if j.starts)
    pictures = PlanPictures(judged, found, found.errors({}, PENCIL, READING))
    picture = pictures.picture(start)

    def far(lines, others):
        return max(min(np.abs(z - w).max() for w in others) for z in lines)

    assert len(picture.theirs) > 5
    assert far(picture.theirs, (*picture.wrong, *picture.ours)) < 6
    assert far(picture.theirs, picture.ours) > 50
    alone = PlanPictures([start], found, found.errors({}, PENCIL, READING)).picture(start)
    assert len(alone.wrong) == len(picture.wrong)
    assert not alone.theirs  # one number fixes no point
    result = next(j for j in judged if j.entry.kind == "result")
    assert pictures.picture(result) is None
