"""Ink beside a stroke is the line's that lacks its own; lines that belong in one place move together."""

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo.shared_ink import coincident_lines, reassign_ink
from tmm_sheets.compare.photo.traces import InkTrace

pytestmark = pytest.mark.judging

PLAN, OTHER = (ElementView(k, "plan", Box(0, 0, 841, 594)) for k in (1, 2))


def found(number, name, a, b, moved=None, status="measured", head="unknown", view=PLAN):
    """A line from ``a`` to ``b``, and where it was found, if not there."""
    z = np.array([a, b], complex)
    at = z if moved is None else np.array(moved, complex)
    off = at - z
    return InkTrace(Element(number, view, name, "line", z, "thin"), status, complex(off.mean()), deviation=float(np.abs(off).max()),
                 at=None if status == "missing" else at, head=head, turn=float(np.angle((at[1] - at[0]) / (z[1] - z[0]))))


INK = (100 + 300j, 160 + 304j)
SOUND = found(1, "p–a", 100 + 300j, 160 + 300j, INK, "beside")
HEAD = found(2, "p–a", 100 + 300j, 156 + 300j, head="there")
LACKS = found(3, "p–b", 100 + 300j, 150 + 300.5j, status="shared")
CARRIES = found(4, "a–b", 150 + 340j, 150 + 300.5j, (150 + 340j, 151.5 + 303.3j))  # b was drawn elsewhere
HEADLESS = found(5, "p–c", 100 + 300j, 150 + 300.5j, head="left out")


@pytest.mark.parametrize(("others", "owner"), [
    ([], 1), ([LACKS], 1),  # nothing tells
    ([found(4, "a–b", 150 + 340j, 150 + 300.5j, (150 + 340j, 153 + 300.5j)), LACKS], 3),
    ([found(4, "a–b", 150 + 340j, 150 + 300.5j, (150 + 340j, 150.4 + 300.5j)), LACKS], 1),  # b is in its place
    ([found(4, "a–b", 150 + 340j, 150 + 300.5j, (150 + 340j, 153 + 300.5j), view=OTHER), LACKS], 1),
    ([HEAD, HEADLESS], 5), ([HEADLESS], 1),  # its own head may be absent as well
    ([HEAD, found(5, "p–c", 100 + 300j, 150 + 330j, head="left out")], 1),  # in another direction
    ([HEAD, HEADLESS, found(6, "p–d", 100 + 300j, 140 + 299j, head="absent")], 1),  # either of two
    ([found(7, "a–c", 160 + 340j, 160 + 300j, (160 + 340j, 163 + 300j)), HEAD, HEADLESS], 1),  # a itself was drawn elsewhere
])
def test_ink_beside_a_stroke_is_the_line_that_lacks_its_own(others, owner):
    before = {1: found(1, "p–a", 100 + 300j, 160 + 300j, status="shared")}
    after = {t.element.number: t for t in reassign_ink([SOUND, *others], before)}
    assert [number for number, t in after.items() if t.status == "beside"] == [owner]
    if owner != 1:
        assert (after[1].status, after[1].deviation) == ("shared", 0.0)
        assert after[owner].at[0] == pytest.approx(100 + 300j, abs=0.1)
        assert after[owner].deviation == pytest.approx(2.8, abs=0.2)


def test_what_is_not_beside_a_stroke_stays():
    some = [HEAD, LACKS, CARRIES]
    assert reassign_ink(some, {}) == some
    assert reassign_ink([], {}) == []


MOVED = found(1, "S'16", 100 + 300j, 200 + 300j, (100 + 300j, 200 + 305j))


@pytest.mark.parametrize(("other", "by"), [
    (found(2, "S'13", 100 + 300j, 180 + 300j, status="missing"), 4.0),
    (found(2, "h", 200 + 300j, 100 + 300.5j, status="missing"), 5.0),
    (found(2, "S'13", 100 + 300j, 180 + 300j, status="missing", view=OTHER), None),
    (found(2, "a", 100 + 302j, 180 + 302j, status="missing"), None),
    (found(2, "a", 220 + 300j, 300 + 300j, status="missing"), None),
    (found(2, "a", 100 + 300j, 300 + 300j, status="missing"), None),
    (found(2, "a", 100 + 300j, 180 + 300j, status="dense"), None),
])
def test_a_line_lies_where_the_one_was_drawn_that_belongs_in_its_place(other, by):
    first, second = coincident_lines([MOVED, other])
    assert first is MOVED
    assert (second is other) == (by is None)
    if by is not None:
        assert (second.status, second.deviation) == ("measured", pytest.approx(by, abs=0.6))


@pytest.mark.parametrize("moved", [[], [found(1, "S'16", 100 + 300j, 200 + 300j)]])
def test_a_line_whose_place_is_empty_is_missing(moved):
    other = found(2, "S'13", 100 + 300j, 180 + 300j, status="missing")
    assert coincident_lines([*moved, other])[-1] is other
