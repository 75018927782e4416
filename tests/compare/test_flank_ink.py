"""Ink beside a stroke in which several lines belong, within the room that is wiped out about them."""

import cv2
import numpy as np
import pytest

from tests.compare.test_tracing import VIEW, draw, line, paper, write
from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.flank_ink import flank_ink
from tmm_sheets.compare.photo.traces import ExtraInk, Trace
from tmm_sheets.compare.photo.tracing import trace
from tmm_sheets.drawing.marks import Text

A, B = 250 + 300j, 290 + 300j
KNOWN = [line(1, A, B, "construction"), line(2, A, B, "vector"), line(3, A, B, "vector")]
DARK = 180


def picture(known, drawn=(), dark=DARK):
    """Lines in their places, and others."""
    ink = paper()
    for e in known:
        if e.kind == "line":
            draw(ink, *e.points, e.style)
    for a, b, style in drawn:
        draw(ink, a, b, style, dark)
    return ink


def beside(known, ink, extra=(), hidden=()):
    """What is told where all that is known was found in its place."""
    covers = np.zeros_like(ink)
    for rows, columns in hidden:
        covers[rows, columns] = 255
    return flank_ink([Trace(e, "measured", at=e.points) for e in known], extra, ink, covers, np.zeros_like(ink), 20.0, DARK)


@pytest.mark.parametrize(("begin", "end", "seen"), [
    (0, 0, False), (0, 0.3, False), (0, 0.5, False), (0.4, 0.4, False), (0, 0.8, True), (0, 1.4, True),
    (0, -1.4, True), (1.3, 0, True),
    (-0.9, -0.9, True), (0, 2.5, True),
])  # fmt: skip
def test_a_line_that_leaves_its_stroke_at_a_small_angle_is_ink_beside_it(begin, end, seen):
    found = beside(KNOWN, picture(KNOWN, [(A + 1j * begin, B + 1j * end, "vector")]))
    assert len(found) == seen
    for x in found:
        share = (x.points - A).real / 40
        assert np.abs((x.points - A).imag - begin - share * (end - begin)).max() < 0.8  # half a line, and coarse pixels


def test_it_is_told_where_all_lines_of_the_stroke_seem_in_their_places():
    known = KNOWN[1:]  # as coarse as a photograph
    traces, extra = trace(known, cv2.GaussianBlur(picture(known, [(A, B + 0.9j, "vector")]), (0, 0), 1.0))
    assert [t.deviation < 0.3 for t in traces] == [True, True]
    assert len(extra) == 1


def test_in_a_black_and_white_picture_it_says_nothing():
    ink = np.where(picture(KNOWN, [(A, B + 0.9j, "vector")]) > DARK // 2, np.uint8(255), np.uint8(0))
    assert len(beside(KNOWN, ink)) == 1
    assert trace(KNOWN[1:], ink)[1] == []


def test_beside_lines_in_their_places_there_is_none():
    assert beside([], paper()) == []
    assert beside(KNOWN[1:2], picture(KNOWN[1:2])) == []


def test_ink_to_both_sides_is_two_strokes():
    found = beside(KNOWN, picture(KNOWN, [(A, B + 1.4j, "vector"), (A, B - 1.4j, "vector")]))
    assert sorted(np.sign(x.middle.imag - 300) for x in found) == [-1, 1]


def test_a_stroke_that_lines_cut_to_pieces_is_told():
    known = [*KNOWN, *(line(k, 250 + 5 * k + 290j, 250 + 5 * k + 310j, "vector") for k in (4, 5, 6, 7))]
    found = beside(known, picture(known, [(A, B + 1.5j, "vector")]))
    assert max(x.width for x in found) > 10  # the pieces are four millimetres long


def test_what_was_rubbed_out_is_no_ink_beside_a_stroke():
    assert beside(KNOWN, picture(KNOWN, [(A, B + 1.4j, "vector")], dark=60)) == []


@pytest.mark.parametrize("up", [0.2, 0.6, 1.0])
def test_letters_that_touch_a_stroke_are_no_ink_beside_it(up):
    corners = 262 + 303j + np.array([0, 16, 16 + 4j, 4j])
    known = [*KNOWN, Element(4, VIEW, "x", "text", corners, "text", text="WMWM", height=4.0, marks=(Text(corners[0], "x", 4.0),))]
    ink = picture(known)
    write(ink, "WMWM", 262 + 300j + 1j * up)
    assert beside(known, ink) == []


def test_what_meets_ink_that_is_told_is_not_told_again():
    ink = picture(KNOWN, [(A, B + 1.4j, "vector")])
    (found,) = beside(KNOWN, ink)
    for at, count in ((found.points, 0), (found.points + 3j, 1), (np.zeros(0, complex), 1)):
        assert len(beside(KNOWN, ink, [ExtraInk(found.middle, found.width, found.height, found.length, at)])) == count


def test_beside_what_is_hidden_there_is_none():
    hidden = (slice(6 * (594 - 305), 6 * (594 - 295)), slice(6 * 268, 6 * 300))
    assert beside(KNOWN, picture(KNOWN, [(A, B + 1.4j, "vector")]), hidden=[hidden]) == []
