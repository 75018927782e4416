"""Lines of which a picture shows pieces only are never called wrong; what covers the frame hides what is beside it."""

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo import frame_search, lost_ink, own_place
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.lost_ink import in_pieces, torn_widths
from tmm_sheets.compare.photo.profiles import SCALE
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, Map, homography
from tmm_sheets.compare.photo.traces import InkTrace, Paper

pytestmark = pytest.mark.judging

VIEW = ElementView(1, "plan", Box(0, 0, 841, 594))
THIN, THICK = "thin", "main"


def found(style, covered, status="measured", **more):
    e = Element(1, VIEW, "a", "line", np.array([100, 150 + 0j]), style)
    return InkTrace(e, status, covered=covered, darkness=40.0 if status == "measured" else 0.0, at=e.points, **more)


@pytest.mark.parametrize(("covered", "torn"), [
    ([], False), ([0.3], False),  # too few to tell
    ([1.0] * 20, False),
    ([1.0] * 19 + [0.5], False),  # one of many is the student's
    ([1.0] * 18 + [0.5] * 2, True),
    ([0.89] * 4, True), ([0.91] * 4, False),
])
def test_a_picture_tears_lines_when_several_as_thin_are_in_pieces(covered, torn):
    traces = [found(THIN, c) for c in covered] + [found(THICK, 1.0)] * 5
    assert len(torn_widths(traces)) == torn


@pytest.mark.parametrize(("trace", "torn", "verdict"), [
    (found(THIN, 0.1, "missing"), False, "red"),
    (found(THIN, 0.1, "missing"), True, "amber"),
    (found(THIN, 0.5, "missing"), False, "amber"),  # half of it is there
    (found(THICK, 0.1, "missing"), True, "red"),  # thick ones are whole
    (found(THIN, 1.0, shift=3j, deviation=3.0), True, "red"),
    (found(THIN, 0.8, shift=3j, deviation=3.0), False, "red"),
    (found(THIN, 0.8, shift=3j, deviation=3.0), True, "amber"),
    (found(THICK, 0.65, shift=3j, deviation=3.0), False, "amber"),
    (found(THIN, 0.65, shift=0.1j, deviation=0.1), True, "green"),
])
def test_what_may_be_the_pictures_doing_is_at_most_a_remark(trace, torn, verdict):
    widths = torn_widths([found(THIN, 0.5)] * 4) if torn else set()
    pieces = in_pieces(trace, widths)
    assert judge(InkTrace(**{**vars(trace), "pieces": pieces}), 0.25, 0.15).verdict == verdict


def framed(*gaps):
    """A sheet with nothing but its frame, which is not seen between places of its lower side, mm."""
    ink = np.zeros((594 * 6, 841 * 6), np.uint8)
    x0, y0, x1, y1 = (round(v * SCALE) for v in (FRAME.x0, PAPER.y1 - FRAME.y1, FRAME.x1, PAPER.y1 - FRAME.y0))
    for rows, columns in ((slice(y0 - 3, y0 + 3), slice(x0, x1)), (slice(y1 - 3, y1 + 3), slice(x0, x1)),
                          (slice(y0, y1), slice(x0 - 3, x0 + 3)), (slice(y0, y1), slice(x1 - 3, x1 + 3))):
        ink[rows, columns] = 120
    for a, b in gaps:
        ink[y1 - 6 : y1 + 6, round(a * SCALE) : round(b * SCALE)] = 0
    return ink


@pytest.mark.parametrize(("gaps", "seen", "deep"), [
    ((), (), 0), (((300, 304),), (), 0),  # a lifted pencil
    (((300, 330),), (), 30),  # nothing tells how far it reaches
    (((300, 330),), (310 + 17j, 312 + 40j), 12), (((300, 330),), (400 + 17j,), 30),
    (((300, 330), (500, 520)), (310 + 17j, 510 + 17j), 12),
])
def test_what_covers_the_frame_hides_the_sheet_as_far_as_the_first_line_that_is_seen(gaps, seen, deep):
    mask = lost_ink.under_covers(framed(*gaps), np.array(seen, complex), 18.0, (594, 841))
    assert mask.any() == bool(deep)
    for a, b in gaps if deep else ():
        column = mask[:, (a + b) // 2]
        assert 594 - np.flatnonzero(column)[0] == pytest.approx(5 + deep, abs=1)
        assert mask[590, :].sum() == pytest.approx(sum(b - a for a, b in gaps), abs=2 * len(gaps))


def test_a_sheet_without_a_frame_hides_nothing():
    assert not lost_ink.under_covers(np.zeros((594 * 6, 841 * 6), np.uint8), np.zeros(0, complex), 18.0, (594, 841)).any()


@pytest.mark.parametrize("gone", [0, 5, 50])
def test_stations_that_are_hidden_are_not_measured(gone):
    e = Element(1, VIEW, "a", "line", np.array([100 + 300j, 150 + 300j]), THICK)
    ink, mask = np.zeros((594 * 6, 841 * 6), np.uint8), np.zeros((594, 841), bool)
    mask[:, 150 - gone : 150] = True
    strip = own_place.strip_of(e, Paper.of((), ink, mask))
    shown = strip.stations.points
    assert len(shown) == len(strip.profile) == len(strip.stations.raw)
    assert shown.real.max() < (150 if gone in (0, 50) else 146)  # all of them where none is left


@pytest.mark.parametrize("cut", [0.0, 3.0, 5.5])
def test_the_frame_is_followed_up_to_the_pictures_edge(cut):
    """``cut`` mm of the lower margin are outside: the line itself is seen while it is in the picture."""
    wide, high, scale = 841, 594, 3
    grey = np.full((round((high - cut) * scale), wide * scale), 200, np.uint8)
    for y in (5, 589):
        grey[round((high - y) * scale) - 1 : round((high - y) * scale) + 2, 60:-15] = 90
    for x in (20, 836):
        grey[15:-3, round(x * scale) - 1 : round(x * scale) + 2] = 90
    middle, reach = complex(grey.shape[1], grey.shape[0]) / 2, 0.5 * abs(complex(grey.shape[1], grey.shape[0]))
    corners = PAPER.corners
    q = (corners.real + 1j * (high - corners.imag)) * scale
    m = Map(middle, reach, homography((q - middle) / reach, corners))
    seen = frame_search.sides_near(grey, m, 1.5)
    shares = seen.weight.reshape(4, -1).mean(1)
    assert (shares[1:] > 0.95).all()
    assert shares[0] == pytest.approx(0.0 if cut > 5 else 1.0, abs=0.05)
