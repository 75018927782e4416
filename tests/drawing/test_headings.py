"""Titles: several lines before narrow letters, these before smaller ones."""

import numpy as np
import pytest

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.drawing.text_layout import LEADING, heading, text_box

TEXT = "Кинематика выходного звена"
WIDE = letter(TEXT, 5.0).width


@pytest.mark.parametrize(("width", "most", "lines", "height", "narrow"), [
    (1.01 * WIDE, 3, 1, 5.0, False), (0.9 * WIDE, 3, 2, 5.0, False), (0.9 * WIDE, 1, 1, 5.0, True), (0.71 * WIDE, 1, 1, 5.0, True),
    (0.69 * WIDE, 1, 1, 3.5, True), (0.69 * WIDE, 2, 2, 5.0, False), (0.45 * WIDE, 3, 3, 5.0, False),
    (0.35 * WIDE, 3, 3, 5.0, True),
])
def test_what_yields_first(width, most, lines, height, narrow):
    found = heading(TEXT, width, 5.0, most)
    assert (len(found.lines), found.height, found.wide < 1) == (lines, height, narrow)
    assert all(found.wide * letter(line, height).width <= width + 1e-9 for line in found.lines)
    assert " ".join(found.lines) == TEXT


def test_nothing_is_narrower_than_cad_has_it():
    assert heading(TEXT, 10.0, 5.0).wide == 0.7


@pytest.mark.parametrize("spare", [0.0, LEADING])
def test_a_title_stays_in_its_place_and_leaves_what_is_below_it(spare):
    canvas = Canvas()
    left = canvas.title(Box(0.0, 0.0, 0.8 * WIDE, 50.0), TEXT, "", spare=spare)
    boxes = [text_box(mark) for mark in canvas.marks if isinstance(mark, Text)]
    assert len(boxes) == 1 + (spare > 0)
    for box in boxes:
        assert box.real.min() >= -1e-9
        assert box.real.max() <= 0.8 * WIDE + 5.0 * np.tan(np.radians(15))  # letters slant
        assert box.imag.min() > left.y1
