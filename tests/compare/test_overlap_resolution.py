"""Of the lines that belong in one stroke, that one is told to be elsewhere whose ends the ink has."""

import cv2
import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo.line_ends import resolve_overlaps
from tmm_sheets.compare.photo.profiles import SCALE, pixels
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import InkTrace, Paper

pytestmark = pytest.mark.judging

VIEWS = [ElementView(k, "plan", Box(0, 0, 841, 594)) for k in (1, 2)]
ROWS, COLUMNS = round(PAPER.height * SCALE), round(PAPER.width * SCALE)


def beside(number, length, begin, end, view=0):
    """A line of the stroke, and that it was found between two points."""
    e = Element(number, VIEWS[view], str(number), "line", 100 + 300j + np.array([0, length]), "thin")
    return InkTrace(e, "beside", at=np.array([begin, end]))


def others(found, *inked):
    ink = np.zeros((ROWS, COLUMNS), np.uint8)
    for a, b in inked:
        p, q = (tuple(round(v) for v in (z.real, z.imag)) for z in pixels(np.array([a, b])))
        cv2.line(ink, p, q, 120, 2)
    return resolve_overlaps(found, Paper.of([t.element for t in found], ink, np.zeros((1, 1), bool)))


TURNED = (100 + 300j, 200 + 305j)


@pytest.mark.parametrize(("found", "wrong"), [
    ([], set()), ([beside(1, 100, *TURNED)], set()),
    ([beside(1, 100, *TURNED), beside(2, 60, 100 + 300j, 160 + 303j)], {2}),  # the ink goes on beyond its end
    ([beside(1, 100, *TURNED), beside(2, 100, *TURNED)], set()),  # truly open
    ([beside(1, 100, *TURNED), beside(2, 100, 100 + 300.8j, 200 + 304.2j)], {2}),  # no end of it stays
    ([beside(1, 100, *TURNED), beside(2, 60, 100 + 300j, 160 + 303j, view=1)], set()),  # another view
    ([beside(1, 100, 100 + 303j, 200 + 308j)], {1}),  # neither end is near its own
    ([beside(1, 100, *TURNED), beside(2, 60, 100 + 300j, 160 + 293j)], set()),  # other ink
])
def test_ink_beside_a_stroke_is_the_line_whose_ends_it_has(found, wrong):
    assert others(found, TURNED) == wrong
