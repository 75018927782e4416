"""A picture without grey that eats thin lines: what that may be the reason of is no mistake of the drawing."""

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.lost_ink import eats, lost_to_threshold, without_grey
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Provenance as By, Text
from tmm_sheets.drawing.text_layout import text_box

pytestmark = pytest.mark.judging

VIEW = ElementView(0, "view", Box(0, 0, 841, 594))


def found(status, style="thin", length=60.0, covered=1.0, deviation=0.0, **more):
    e = Element(1, VIEW, "", "line", np.array([100, 100 + length], complex), style, by=By("link", "", ""))
    return InkTrace(e, status, 1j * deviation, deviation=deviation, covered=covered, at=e.points, **more)


def lettering(status, text, moved=0j):
    mark = Text(100 + 100j, text, 5.0)
    e = Element(1, VIEW, text, "text", text_box(mark), "text", text=text, height=5.0, marks=(mark,))
    return InkTrace(e, status, moved, deviation=abs(moved), at=e.points + moved if moved else None)


@pytest.mark.parametrize(("levels", "only"), [
    ({255: 90, 0: 10}, True), ({250: 90, 10: 9, 128: 1}, True),  # compression
    ({250: 85, 10: 5, 128: 10}, False), ({180: 90, 60: 10}, False), ({255: 100}, False), ({90: 100}, False)])  # fmt: skip
def test_a_picture_has_grey_or_has_not(levels, only):
    grey = np.repeat(np.array([*levels], np.uint8), [30 * n for n in levels.values()])
    assert without_grey(np.random.default_rng(1).permuted(np.tile(grey, (60, 1)), axis=1)) == only


@pytest.mark.parametrize(("traces", "does"), [
    ([], False), ([found("missing")], False), ([found("measured")] * 30, False),
    ([found("measured")] * 99 + [found("measured", covered=0.8)], False),  # a pencil's gap
    ([found("measured")] * 90 + [found("measured", covered=0.8)] * 10, True),
    ([found("measured")] * 90 + [found("measured", "main", covered=0.8)] * 10, False),
    ([found("measured")] * 90 + [found("measured", "centre", covered=0.8)] * 10, False),
    ([found("measured")] * 90 + [found("measured", length=10, covered=0.8)] * 10, False),
])
def test_thin_lines_are_in_pieces_all_over_the_sheet(traces, does):
    assert eats(traces) == does


@pytest.mark.parametrize(("trace", "seen", "eaten"), [
    (found("measured", ends=(0.0, -6.0)), "amber", "green"), (found("measured", ends=(0.0, 6.0)), "amber", "amber"),
    (found("measured", "main", ends=(0.0, -6.0)), "red", "red"),
    (found("missing", length=20, covered=0.5), "red", "green"), (found("missing", length=60, covered=0.5), "red", "green"),
    (found("missing", length=60, covered=0.02), "red", "red"), (found("missing", "main", length=20, covered=0.5), "red", "red"),
    (found("covered"), "amber", "green"), (found("covered", "vector"), "amber", "amber"),
    (found("measured", deviation=0.6), "amber", "green"), (found("measured", "main", deviation=0.6), "amber", "amber"),
    (found("measured", deviation=4.0), "red", "red"), (found("measured", deviation=4.0, covered=0.7), "red", "green"),
    (lettering("part of lettering", "F10"), "amber", "green"), (lettering("absent lettering", "7"), "amber", "green"),
    (lettering("absent lettering", "7", 6j), "amber", "green"), (lettering("absent lettering", "12", 6j), "amber", "amber"),
    (lettering("absent lettering", "12"), "amber", "green"), (lettering("part of lettering", "F10", 6j), "amber", "green"),
    (lettering("absent lettering", "F10"), "amber", "amber"),
])
def test_what_may_be_eaten_is_not_judged_and_what_is_clear_is(trace, seen, eaten):
    assert judge(trace, 0.25, 0.15).verdict == seen
    f = judge(trace, 0.25, 0.15, eats="lines")
    assert f.verdict == eaten
    assert not f.unknown


BLACK_ON_WHITE, PAPER = np.repeat(np.array([255, 0], np.uint8), [900, 100])[None].repeat(60, 0), np.full((60, 1000), 180, np.uint8)


@pytest.mark.parametrize(("grey", "broken", "scale", "some"), [
    (BLACK_ON_WHITE, 0, 3.5, "ends"), (BLACK_ON_WHITE, 10, 3.5, "lines"), (BLACK_ON_WHITE, 0, 11.8, "nothing"),  # a fine scan
    (BLACK_ON_WHITE, 10, 11.8, "lines"), (PAPER, 10, 3.5, "nothing")])  # fmt: skip
def test_what_a_picture_eats(grey, broken, scale, some):
    traces = [found("measured")] * 90 + [found("measured", covered=0.8)] * broken
    assert lost_to_threshold(grey, traces, scale) == some


@pytest.mark.parametrize(("trace", "judged"), [
    (found("measured", ends=(0.0, -6.0)), "green"), (found("measured", "main", ends=(0.0, -6.0)), "red"),
    (found("measured", deviation=0.6), "green"), (found("measured", deviation=4.0, covered=0.7), "red"),
    (found("missing", length=20, covered=0.2), "red"), (found("covered"), "amber"),
    (lettering("part of lettering", "F10"), "green"), (lettering("part of lettering", "F10", 6j), "amber"),
    (lettering("absent lettering", "7"), "amber")])  # fmt: skip
def test_where_lines_are_whole_only_ends_and_parts_of_letters_are_eaten(trace, judged):
    assert judge(trace, 0.25, 0.15, eats="ends").verdict == judged


def test_a_sound_line_stays_measured():
    assert judge(found("measured", covered=0.7), 0.25, 0.15, eats="lines").trace.status == "measured"
