"""Lines that part from a stroke of several by a millimetre or two, in a picture as coarse as a photograph."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.compare.test_tracing import draw, line, paper
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.own_place import may_part, narrow_divergence
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.traces import InkTrace, Paper
from tmm_sheets.compare.photo.tracing import trace

pytestmark = pytest.mark.judging

A, B = 80 + 440j, 105 + 440j
STROKE = [(A, B, "axis"), (A, B, "vector")]
BLUR = 2.0
"""Pixels of blur (standard deviation), with that of the lines 0.4 mm: a picture of three pixels a millimetre."""


def picture(drawn):
    """Blurred lines, drawn from one point to another in a style."""
    ink = paper()
    for a, b, style in drawn:
        draw(ink, a, b, style)
    here = (slice(6 * (594 - 500), 6 * (594 - 410)), slice(6 * 60, 6 * 140))
    ink[here] = cv2.GaussianBlur(ink[here], (0, 0), BLUR)
    return ink


def parting(drawn, known=STROKE):
    """What is found beside the stroke of the first of the lines that are known."""
    ink = picture(drawn)
    elements = [line(k, *k_) for k, k_ in enumerate(known, 1)]
    usual = float(sample(ink, pixels(np.array([A + 5]))).max())
    t = InkTrace(elements[0], "measured", at=elements[0].points)
    return narrow_divergence(t, Paper.of(elements, ink, np.zeros((1, 1), bool)), usual)


@pytest.mark.parametrize("forward", [True, False])
@pytest.mark.parametrize("by", [1.6, -1.6, 2.0, -2.0, 2.9, -2.9])
def test_a_line_turned_about_one_end_is_told_from_its_stroke(by, forward):
    a, b = (A, B) if forward else (B, A)
    found = parting([(a, b + 1j * by, "axis"), (A, B, "vector")])
    assert found is not None
    begin, end = (found.at - found.element.points) if forward else (found.at - found.element.points)[::-1]
    assert end.imag == pytest.approx(by, abs=0.35)
    assert abs(begin) < 0.5


@pytest.mark.parametrize(
    "drawn",
    [
        [],  # no line was turned, two were drawn
        [(A, B + 0.5j, "axis")],  # within a pencil's reach of the stroke
        [(A + 1.6j, B + 1.6j, "axis")],  # it runs along, and leads to neither end
        [(A, A + 15 + 1.2j, "axis")],  # it ends long before the line does
        [(B - 2, B + 2.0j, "axis")],  # too short to be told from a stroke of a letter
        [(A + 12 - 3j, A + 15 + 3j, "thin"), (A + 18 - 3j, A + 21 + 3j, "thin")],  # others cross
    ],
)
def test_other_ink_beside_a_stroke_is_no_line_that_parts_from_it(drawn):
    assert parting([*STROKE, *drawn]) is None


def test_the_line_of_another_is_not_taken():
    other = (A, B + 2.0j, "thin")
    assert parting([*STROKE, other], [*STROKE, other]) is None


def test_where_letters_belong_nothing_is_seen():
    e = line(1, A, B, "axis")
    ink = picture([(A, B + 2.0j, "axis"), (A, B, "vector")])
    seen = replace(Paper.of((), ink, np.zeros((1, 1), bool)), words=np.full_like(ink, 255))
    assert narrow_divergence(InkTrace(e, "measured", at=e.points), seen, 80.0) is None


@pytest.mark.parametrize("dashed", [True, False])
def test_a_dashed_line_is_not_looked_for(dashed):
    style = "hidden" if dashed else "axis"
    found = parting([(A, B + 2.0j, "axis"), (A, B, "vector")], [(A, B, style), (A, B, "vector")])
    assert (found is None) == dashed


def test_ink_of_nobody_beside_a_stroke_is_seen_on_either_side():
    across = np.zeros((40, 61), np.uint8)
    across[:, 29:32] = 90
    others = np.zeros_like(across, bool)
    assert not may_part(across, others, 20.0, 90.0)
    for column in (18, 42):
        beside = across.copy()
        beside[20:, column - 1 : column + 2] = 60
        assert may_part(beside, others, 20.0, 90.0)
        assert not may_part(beside, others, 5.0, 90.0)  # 2.5 mm of it
        assert not may_part(beside, others, 20.0, 130.0)  # too pale to be like it
        others[:, column] = True
        assert not may_part(beside, others, 20.0, 90.0)
        others[:] = False


@pytest.mark.parametrize(("by", "verdict"), [(0.0, "green"), (1.8, "amber"), (-1.8, "amber")])
def test_a_line_that_was_measured_by_the_ink_of_others_is_told(by, verdict):
    """Two lines of one stroke each find its ink: the one that is elsewhere too, as if it were measured by itself."""
    usual = [(80 + 1j * y, 120 + 1j * y, style) for y, style in ((460, "axis"), (470, "axis"), (480, "vector"), (490, "vector"))]
    known = [line(k, *drawn) for k, drawn in enumerate([*STROKE, *usual], 1)]
    found, _ = trace(known, picture([(A, B + 1j * by, "axis"), (A, B, "vector"), *usual]))
    assert (found[0].status == "beside") == bool(by)
    assert judge(found[0], 0.25, 0.15).verdict == verdict
    assert {judge(t, 0.25, 0.15).verdict for t in found[2:]} == {"green"}
