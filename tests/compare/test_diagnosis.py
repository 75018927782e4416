"""Plans drawn again with a mistake: against vector equations solved here, and told by the numbers of who made it.

Hundreds of such students: ``python -m tests.compare.hypotheses``.
"""

import numpy as np
import pytest

from tests.compare.hypotheses import Slip, Slipping, student
from tests.compare.students import PENCIL, READING, opened
from tests.few import seldom
from tmm_sheets.compare.diagnosis.hypotheses import Change, displaced, hypotheses, replay
from tmm_sheets.compare.measured.chain import judge


@pytest.fixture(scope="module")
def shaper():
    return opened("lugansk/shaper")


def of(found, plan_name, kind, k=2):
    """Values of a plan's steps at position ``k`` with the only mistake of a kind, and without."""
    plans = {plan.name: plan for plan, _ in found.plans}
    plan = plans[plan_name]
    one, = (h for h in hypotheses(plan, k, plan.labels) if h.kind == kind)
    value = replay(found.errors({}, 0.25, 0.5), one.changes)
    return {s.name: np.asarray(value(s)) for s in plan}, plans


def test_coriolis_the_other_way(shaper):
    """a_B3 = a_B - a_k + a_r = a_n + a_t: two unknowns along and across the rocker, solved as a linear system."""
    drawn, plans = of(shaper, "accelerations", "coriolis")
    exact = {s.name: np.asarray(s.value) for s in plans["accelerations"]}
    velocities = {s.name: np.asarray(s.value) for s in plans["velocities"]}
    positions = {s.name: s.value for s in plans["positions"]}
    k = 2
    along = (positions["B"][k] - positions["C"]) / abs(positions["B"][k] - positions["C"])
    coriolis = 2j * velocities["ω3"][k] * (velocities["b3"][k] - velocities["b"][k])
    start, end = exact["b"][k] - coriolis, exact["n"][k]
    u, v = along, 1j * along
    r, _ = np.linalg.solve([[u.real, -v.real], [u.imag, -v.imag]], [(end - start).real, (end - start).imag])
    assert drawn["k"][k] == pytest.approx(start, rel=1e-12)
    assert drawn["b3"][k] == pytest.approx(start + r * u, rel=1e-9)
    assert drawn["d"][k] == pytest.approx((start + r * u) * 0.566 / abs(positions["B"][k] - positions["C"]), rel=1e-9)
    assert drawn["b3"][3] == exact["b3"][3]


def test_two_changes_in_one_replay(shaper):
    """A point off by 3 mm and Coriolis the other way: both, whichever is named first."""
    plans = {plan.name: plan for plan, _ in shaper.plans}
    acc, errors = plans["accelerations"], shaper.errors({}, 0.25, 0.5)
    one, = (h for h in hypotheses(acc, 2, acc.labels) if h.kind == "coriolis")
    off = Change(acc["n"], displaced(0.15j), 2)
    both = [replay(errors, some)(acc["b3"]) for some in ((*one.changes, off), (off, *one.changes))]
    alone = replay(errors, one.changes)(acc["b3"])
    u = plans["positions"]["CB"].value
    assert np.array_equal(*both)
    # The line from k along the rocker stays, that across it from n goes with n: b3 moves along the rocker.
    moved = both[0] - alone
    assert moved[2] == pytest.approx((0.15j * np.conj(u[2])).real * u[2], rel=1e-9)
    assert not moved[[0, 1, 3, 4]].any()


@pytest.mark.parametrize(("number", "kinds"), [
    (1, ()),
    seldom(8, ("coriolis", "normal")),  # both in one plan: neither of them explains it alone
    seldom(20, ("crank", "scale")),  # a plan of velocities larger than its scale factor says, of a crank that turns the other way
    seldom(11, ("mirror", "neighbour"))])  # a plan mirrored at every position, and two of its rows exchanged
def test_students_are_told_what_they_did(number, kinds):
    """What was done wrong is worked out by the trial's own vector equations; nothing but that is told."""
    one = student("lugansk/shaper", number, 11, kinds)
    assert one is not None
    assert all(one.told(slip) for slip in one.slips), str(one)
    assert sum(j.starts for j in one.judged) == len(kinds), str(one)


def test_a_vector_without_length_tells_no_way_to_what_follows():
    """At a dead position |pd5| is read as 1 mm for 0: which way it points, and the sign of M_пр, nobody can tell."""
    one = student("lugansk/shaper", 3, 31, ())
    assert one is not None
    assert not any(j.starts for j in one.judged), str(one)


@pytest.mark.parametrize("wrong", [("intersection",), seldom(("sense",)), seldom(("intersection", "sense"))])
def test_what_two_mistakes_leave_right_proves_of_neither_that_it_was_not_made(wrong):
    """The other intersection turns ε2 round; turned round once more it is right."""
    found = opened("press")
    plans = {plan.name: plan for plan, _ in found.plans}
    b, turning = plans["positions"]["B"], plans["accelerations"]["ε2"]
    k = plans["positions"].labels.index("7")
    slips = {
        "intersection": Slip("intersection", "B", k, {b: lambda a, made, k: 2 * (a[2] + ((a[0] - a[2]) * np.conj(a[3])).real * a[3])
                                                      - made[k]}),
        "sense": Slip("sense", "ε2", k, {turning: lambda a, made, k: -made[k]}),
    }
    asked = {name: e for name, e in found.entries.items() if e.main and e.label == "7" and e.plan not in ("reduced", "lever")}
    hand = Slipping(found, np.random.default_rng(1), tuple(slips[kind] for kind in wrong))
    judged = judge(hand.filled(asked), found, PENCIL, READING)
    told = [j.wrong[0] for j in judged if j.starts and j.wrong]
    assert [(h.kind, h.step) for h in told] == [(kind, next(iter(slips[kind].ways))) for kind in wrong]
    (sense,) = (j for j in judged if j.entry.id == "results/7/sense-epsilon2")
    assert sense.verdict == ("green" if len(wrong) == 2 else "red")


@pytest.mark.parametrize(("number", "words"), [seldom(1, "row"), (0, "positions"), (10, "row after"), seldom(2, "position after")])
def test_numbers_in_wrong_rows_are_one_mistake(number, words):
    """Of two positions, one or all of them exchanged; a column shifted by a row or by a position."""
    one = student("lugansk/shaper", number, 7, ("rows",))
    (start,) = (j for j in one.judged if j.starts)
    assert start.wrong[0].words == words, str(one)
    wrong = {j.entry.id for j in one.judged if j.verdict == "red"}
    assert wrong <= one.slips[0].rows.keys()
    assert all(j.follows is start for j in one.judged if j.verdict == "red" and j is not start)
