"""Lines that leave the stroke they share at a small angle, in a picture as coarse as a photograph."""

import cv2
import numpy as np
import pytest

from tests.compare.test_tracing import VIEW, draw, line, paper
from tests.few import seldom
from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.tracing import trace
from tmm_sheets.drawing.marks import Text

pytestmark = pytest.mark.judging

A, B = 80 + 440j, 120 + 440j
TIP = B - 5
"""A vector ends where its helper line goes on for five millimetres."""
OTHERS = [line(k, 80 + 1j * y, 120 + 1j * y, style) for k, (y, style) in enumerate(
    [(460, "construction"), (470, "construction"), (480, "vector"), (490, "vector")], 10)]  # they show what is usual


def verdicts(known, drawn):
    """What is said of the lines, drawn from one point to another in a style, in a blurred picture."""
    ink = paper()
    for e in OTHERS:
        draw(ink, *e.points, e.style)
    for a, b, style in drawn:
        draw(ink, a, b, style)
    here = (slice(6 * (594 - 500), 6 * (594 - 410)), slice(6 * 60, 6 * 140))
    ink[here] = cv2.GaussianBlur(ink[here], (0, 0), 2.0)
    found, _ = trace([*known, *OTHERS], ink)
    assert {judge(t, 0.25, 0.15).verdict for t in found[len(known):]} == {"green"}
    return found[: len(known)], [judge(t, 0.25, 0.15).verdict for t in found[: len(known)]]


@pytest.mark.parametrize("forward", [True, seldom(False)])
@pytest.mark.parametrize(("by", "verdict"), [(0, "green"), (0.3, "green"), (1.0, "amber"), (-1.0, "amber"), (3.0, "amber"),
                                             (-3.0, "amber")])
def test_a_helper_line_that_leaves_its_vector_is_told_by_its_end(by, verdict, forward):
    a, b, tip = (A, B, TIP) if forward else (B, A, A + 5)
    helper = line(1, A, B, "construction")
    found, told = verdicts([helper, line(2, a, tip, "vector")], [(a, b + 1j * by, "construction"), (a, tip, "vector")])
    assert told == [verdict, "green"]
    if verdict == "amber":
        assert found[0].at is not None
        end = found[0].at[1] if forward else found[0].at[0]
        assert (end - b).imag == pytest.approx(by, abs=0.35)


def test_all_helper_lines_of_a_stroke_are_told_when_none_is_in_its_place():
    known = [line(1, A, B, "construction"), line(2, A, B, "construction"), line(3, A, TIP, "vector")]
    _, told = verdicts(known, [(A, B + 1.4j, "construction"), (A, TIP, "vector")])
    assert told == ["amber", "amber", "green"]


@pytest.mark.parametrize("drawn", [
    [(A, B - 4, "construction")],  # a hand stopped early, beside is nothing
    [(A, B - 4, "construction"), (B + 1 - 3j, B - 1 + 3j, "thin")],  # and another line crosses
    [(A, B - 4, "construction"), (B - 3.6 + 1.2j, B + 1.2j, "text")],  # there is a stroke beside, and a gap before it
    [(A, B, "construction"), (A, B + 1.4j, "construction")],  # it is in its place, whatever is beside
])
def test_a_short_line_and_ink_beside_tell_nothing_by_themselves(drawn):
    known = [line(1, A, B, "construction"), line(2, A, TIP, "vector"),
             *(line(k, *d[:2], "thin") for k, d in enumerate(drawn, 3) if d[2] == "thin")]
    _, told = verdicts(known, [*drawn, (A, TIP, "vector")])
    assert set(told) == {"green"}


def test_ink_where_letters_belong_is_no_line():
    corners = B - 3.4 + 0.6j + np.array([0, 8, 8 + 4j, 4j])
    word = Element(3, VIEW, "x", "text", corners, "text", text="x", height=4.0,
                   marks=(Text(corners[0], "xx", 4.0),))
    _, told = verdicts([line(1, A, B, "construction"), line(2, A, TIP, "vector"), word],
                       [(A, B - 4, "construction"), (A, TIP, "vector"), (B - 3.2 + 1.2j, B + 1.4j, "text")])
    assert told[:2] == ["green", "green"]
