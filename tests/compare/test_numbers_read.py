"""Numbers read in a picture: what counts as another number, and, where the reader is installed, real lettering."""

from importlib.util import find_spec

import numpy as np
import pytest

from tests.compare.simulation import Text, letters
from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo import small_marks
from tmm_sheets.compare.photo.profiles import SCALE
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.errors import BadInput

VIEW = ElementView(1, "Table", Box(0, 0, 100, 100))


@pytest.mark.parametrize(("found", "wanted", "exact", "other"), [
    ("26,1", "16,1", False, True), ("16,1", "16,1", False, False), ("161", "16,1", False, False), ("16,1", "−16,1", False, False),
    ("−26,1", "−16,1", False, True), ("159", "16,1", False, False), ("261", "16,1", False, True), ("0,06", "0,05", False, False),
    ("0,09", "0,05", False, True), ("5", "4", True, True), ("5", "4", False, True), ("241", "240", False, False),
    ("241", "240", True, True), ("0", "0", False, False), ("8", "0", False, True), ("1000", "100", False, True)])
def test_what_is_another_number(found, wanted, exact, other):
    assert small_marks.differs(found, wanted, exact) == other


def lettering(text, at, angle=0.0):
    """An element with a text, and the text as strokes."""
    mark = Text(at, text, 3.5, angle)
    return Element(int(at.imag), VIEW, text, "text", text_box(mark), "text", text=text, height=3.5, angle=angle), mark


def test_numbers_are_shown_upright_and_once_more_where_they_differ():
    e, _ = lettering("16,1", 300 + 200j)
    shown = []

    def read(said):
        left = iter(said)

        def one(line):
            shown.append(line.shape[0])
            return next(left), 0.99
        return one

    ink = np.zeros((round(PAPER.height * SCALE), round(PAPER.width * SCALE)), np.float32)
    traces = [InkTrace(e, "lettering"), InkTrace(e, "hidden")]
    answers = (["16,1"], ["26,1", "26,1"], ["26,1", "16,1"], ["26,1", "36,1"])
    of = [small_marks.readings(traces, ink, read(said)) for said in answers]
    assert [(o.asked, o.unread, dict(o.otherwise)) for o in of] == [(1, 0, {}), (1, 0, {200: "26,1"}), (1, 0, {}), (1, 1, {})]
    assert shown == [small_marks.ROW] * 7


def test_without_the_reader_it_is_said(monkeypatch):
    monkeypatch.setattr(small_marks, "find_spec", lambda name: None)
    with pytest.raises(BadInput, match="rapidocr"):
        small_marks.number_reader()


@pytest.mark.skipif(find_spec("rapidocr") is None or find_spec("onnxruntime") is None, reason="the extra ocr is not installed")
def test_a_swapped_digit_is_read():
    import cv2

    wanted = ["16,1", "−338,4", "12", "0,2914", "7"]
    written = ["26,1", "−338,4", "12", "0,5914", "1"]
    ink = np.zeros((round(PAPER.height * SCALE), round(PAPER.width * SCALE)), np.uint8)
    traces = []
    for k, (ours, theirs) in enumerate(zip(wanted, written, strict=True)):
        at, angle = 200 + (100 + 60 * k) * 1j, 0.0 if k < 3 else np.pi / 2
        traces.append(InkTrace(lettering(ours, at, angle)[0], "lettering"))
        for p in letters(lettering(theirs, at, angle)[1]):
            xy = np.column_stack((p.real * SCALE - 0.5, (PAPER.y1 - p.imag) * SCALE - 0.5))
            cv2.polylines(ink, [np.round(xy * 16).astype(np.int32)], False, 255, 2, cv2.LINE_AA, 4)
    found = small_marks.readings(traces, ink, small_marks.number_reader())
    assert found.unread == 0
    assert found.otherwise == {100: "26,1", 280: "0,5914", 340: "1"}
