"""What is off in one place is told once, and what hides a sheet is no mistake."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.findings import called
from tmm_sheets.compare.photo import displacement, lost_ink, photo_report
from tmm_sheets.compare.photo.finding_clusters import places
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.profiles import SCALE
from tmm_sheets.compare.photo.sheet_map import PAPER, Map
from tmm_sheets.compare.photo.traces import ExtraInk, InkTrace
from tmm_sheets.compare.photo.tracing import trace
from tmm_sheets.drawing.marks import Provenance as By, Text
from tmm_sheets.drawing.text_layout import text_box

PLAN, OTHER = (ElementView(n, name, Box(0, 0, 841, 594)) for n, name in enumerate(("plan", "other"), 1))
AS_IT_IS = Map(0j, 1.0, np.array([[1.0, 0.0, 0.0], [0.0, -1.0, PAPER.y1], [0.0, 0.0, 1.0]]))


def line(number, a, b, by=0.0, view=PLAN, status="measured"):
    """A line whose end was found ``by`` mm off."""
    z = np.array([a, b], complex)
    e = Element(number, view, f"a{number}", "line", z, "main")
    return judge(InkTrace(e, status, shift=by / 2, deviation=abs(by), at=z + np.array([0, by])), 0.25, 0.15)


def ink(*points):
    z = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(points)])
    box = Box.around(z)
    return ExtraInk(box.centre, box.width, box.height, float(np.hypot(box.width, box.height)), z)


def arc(centre, radius, first, last):
    z = centre + radius * np.exp(1j * np.radians(np.linspace(first, last, 40)))
    return ExtraInk(complex(z.mean()), float(np.ptp(z.real)), float(np.ptp(z.imag)), 20.0, z)


def shares(*findings, extra=()):
    """How many findings and pieces of ink each place has."""
    return [(len(p.findings), len(p.own), len(p.ink)) for p in places(findings, extra)]


@pytest.mark.parametrize(("findings", "expected"), [
    ([], []),
    ([line(1, 0, 50)], []),  # nothing is off
    ([line(1, 0, 50, 3j)], [(1, 0, 0)]),
    ([line(1, 0, 50, 3j), line(2, 80 + 30j, 50, 3j)], [(2, 0, 0)]),  # the point in which they end
    ([line(1, 0, 50, 3j), line(2, 0, 56, 3j)], [(1, 0, 0), (1, 0, 0)]),
    ([line(1, 0, 50, 3j), line(2, 80 + 30j, 50, 3j, OTHER)], [(1, 0, 0), (1, 0, 0)]),
    ([line(1, 0, 50, 4j, status="beside"), line(2, 0, 50 + 8j, -4j, status="beside")], [(2, 0, 0)]),  # one stroke for both
    ([line(1, 0, 50, 4j, status="beside"), line(2, 0, 50 + 8j, -8j, status="beside")], [(1, 0, 0), (1, 0, 0)]),
    # the point of a line that shares the stroke of the worst, and the same of another view
    ([line(1, 0, 50, 4j, status="beside"), line(2, 0, 43, 3.44j, status="beside"), line(3, 43 + 40j, 43, 0.7j)], [(3, 0, 0)]),
    ([line(1, 0, 50, 4j, status="beside"), line(2, 0, 43, 3.44j, status="beside"), line(3, 43 + 40j, 43, 0.7j, OTHER)],
     [(2, 0, 0), (1, 0, 0)]),
])
def test_lines_that_are_off_at_one_point_or_claim_one_stroke_are_one_place(findings, expected):
    assert shares(*findings) == expected
    assert [p.number for p in places(findings, [])] == list(range(1, len(expected) + 1))


def test_the_worst_speaks_for_a_place_and_lettering_for_itself():
    off, worse = line(1, 0, 50, 0.6j), line(2, 80 + 30j, 50, 3j)
    text = Element(3, PLAN, "a", "text", np.array([48, 52, 52 + 5j, 48 + 5j]), "text")
    letter = judge(InkTrace(text, "absent lettering"), 0.25, 0.15)
    place, alone = places([off, worse, letter], [])
    assert (place.verdict, [f.element.number for f in place.findings]) == ("red", [2, 1])
    assert photo_report.said(place).endswith("; here also: line a1")
    assert alone.findings == (letter,)


def in_pieces(number, a, b, pieces=True):
    """A line that is seen in pieces, or not at all."""
    e = Element(number, PLAN, f"a{number}", "line", np.array([a, b], complex), "main")
    return judge(InkTrace(e, "missing", covered=0.5 if pieces else 0.0, pieces=pieces), 0.25, 0.15)


@pytest.mark.parametrize(("other", "expected"), [
    (in_pieces(2, 0, 50), [2]), (in_pieces(2, 80 + 30j, 50), [2]),  # its twin, and a line from the point that is off
    (in_pieces(2, 80 + 30j, 0), [1, 1]), (in_pieces(2, 80 + 30j, 50, pieces=False), [1, 1]),  # left out
])
def test_what_is_in_pieces_from_a_point_that_is_off_was_drawn_from_there(other, expected):
    assert [len(p.findings) for p in places([line(1, 0, 50, 8j), other], [])] == expected


def test_lines_between_which_nothing_decides_are_told_as_such():
    either = [line(1, 0, 50, 4j, status="beside"), line(2, 0, 50, 4j, status="beside"), line(3, 80 + 30j, 50, 3j)]
    (place,) = places(either, [])
    assert {f.element.number for f in place.findings} == {1, 2, 3}
    place = replace(place, findings=tuple(either))
    assert photo_report.said(place).endswith("; it may be instead: line a2; here also: line a3")


@pytest.mark.parametrize(("high", "beside", "rim"), [(0.5, 0.4, True), (0.5, 2.0, False), (1.0, 0.4, False)])
def test_a_strip_beside_what_was_wiped_out_is_its_rim(high, beside, rim):
    def rows(low, high):
        return slice(round((PAPER.y1 - 300 - high) * SCALE), round((PAPER.y1 - 300 - low) * SCALE))

    left, wiped = (np.zeros((round(PAPER.height * SCALE), round(PAPER.width * SCALE)), np.uint8) for _ in range(2))
    left[rows(0, high), 1200:1500], wiped[rows(high + beside - 0.3, high + beside + 1), 1000:1700] = 90, 255
    assert len(displacement.extra_ink(left, 18.0, np.zeros_like(left), wiped)) == (not rim)


@pytest.mark.parametrize(("extra", "expected"), [
    ([ink(10 + 0.5j, 40 + 2.5j)], [(1, 1, 0)]),  # by which it was found
    ([ink(10 - 3j, 40 - 3j)], [(1, 0, 1)]),
    ([ink(10 - 3j, 20 - 13j)], [(1, 0, 0), (0, 0, 1)]),  # runs away from it
    ([ink(20 - 5j, 20 + 5j)], [(1, 0, 0), (0, 0, 1)]),  # crosses it
    ([ink(200, 220), ink(230, 250)], [(1, 0, 0), (0, 0, 2)]),  # one stroke
    ([ink(200, 220), ink(230 + 9j, 250 + 9j)], [(1, 0, 0), (0, 0, 1), (0, 0, 1)]),
    ([ink(200, 220), ink(223 + 2j, 223 + 20j)], [(1, 0, 0), (0, 0, 2)]),  # side by side
])
def test_ink_of_what_is_off_is_told_with_it_and_pieces_together(extra, expected):
    assert shares(line(1, 0, 50, 3j), extra=extra) == expected


@pytest.mark.parametrize(("by", "size", "said"), [
    (0 + 9j, 6, "no lettering here; what stands 9.0 mm too far up may be it"), (0 + 20j, 6, "no lettering here"),
    (0 + 9j, 30, "no lettering here")])  # fmt: skip
def test_ink_as_large_as_lettering_that_is_not_there_is_told_with_it(by, size, said):
    text = Element(3, PLAN, "F3", "text", np.array([47, 53, 53 + 5j, 47 + 5j]), "text")
    off = judge(InkTrace(text, "absent lettering"), 0.25, 0.15)
    first, *rest = places([off], [ExtraInk(text.middle + by, size, 5.0, 8.0, text.middle + by + np.zeros(3))])
    assert photo_report.said(first) == said
    assert len(rest) == (said == "no lettering here")


def moved(number, at, by, view=PLAN):
    e = Element(number, view, "abc"[number - 1], "text", at + np.array([0, 3, 3 + 4j, 4j]), "text")
    return judge(InkTrace(e, "absent lettering", by, deviation=abs(by), at=None if by is None else e.points + by), 0.25, 0.15)


@pytest.mark.parametrize(("findings", "expected"), [
    ([moved(1, 100, 8j)], [1]), ([moved(1, 100, 8j), moved(2, 107, 7.5j), moved(3, 114, 1 + 7.2j)], [3]),
    ([moved(1, 100, 8j), moved(2, 107, -8j)], [1, 1]), ([moved(1, 100, 8j), moved(2, 160, 8j)], [1, 1]),
    ([moved(1, 100, 8j), moved(2, 107, 8j, OTHER)], [1, 1]),
])
def test_lettering_that_was_moved_together_is_one_place(findings, expected):
    told = places(findings, [])
    assert [len(p.findings) for p in told] == expected
    assert photo_report.said(told[0]).startswith("not in its place: what stands 8.0 mm too far up may be it")
    assert ("here also: text b, text c" in photo_report.said(told[0])) == (expected == [3])


def test_the_ink_of_lettering_that_was_moved_is_told_with_it():
    off = moved(1, 100, 8j)
    assert shares(off, extra=[ink(101 + 9j, 103 + 11j)]) == [(1, 0, 1)]
    assert shares(off, extra=[ink(101 - 9j, 103 - 7j)]) == [(1, 0, 0), (0, 0, 1)]


@pytest.mark.parametrize(("arcs", "by"), [([(0, 40), (90, 130), (200, 240)], 3.6), ([(0, 40), (90, 130), (200, 240)], -2.0),
                                          ([(0, 40), (90, 130)], None)])  # fmt: skip
def test_ink_on_a_circle_about_the_centre_of_another_is_told_as_a_circle(arcs, by):
    centre, t = 100 + 100j, np.linspace(0, 2 * np.pi, 200)
    e = Element(1, PLAN, "O–A", "circle", centre + 50 * np.exp(1j * t), "thin", centre, 50.0)
    found = judge(InkTrace(e, "measured", at=e.points), 0.25, 0.15)
    told = places([found], [arc(centre, 50 + (by or 3.6), a, b) for a, b in arcs])
    if by is None:
        assert all(not p.findings for p in told)
    else:
        (place,) = told
        assert place.findings[0].trace.growth == pytest.approx(by, abs=0.01)
        assert f"radius {abs(by):.1f} mm too {'large' if by > 0 else 'small'}" in photo_report.said(place)


def test_the_tree_has_all_ink_with_its_place():
    judged = photo_report.Judged([line(1, 0, 50, 3j)], [ink(10 + 0.5j, 40 + 2.5j), ink(200, 220)])
    records, start = photo_report.recorded(judged, {})
    assert [x["place"] for x in photo_report.unclaimed(judged)] == [1, 2]
    assert [r.beside["place"] for r in records] == [1]
    assert start == []
    assert photo_report.extra_ink(judged) == ["1 place with ink that is not on the sheet"]


@pytest.mark.parametrize(("shift", "degrees", "verdict"), [(0, 0, "green"), (0, 12, "green"), (0.5j, 0, "amber"), (0, 20, "amber"),
                                                           (1.0, 12, "red")])  # fmt: skip
def test_the_turn_of_a_slider_is_told_only_beyond_two_sides_of_a_pencil(shift, degrees, verdict):
    z = np.array([-3 - 2j, 3 - 2j, 3 + 2j, -3 + 2j, -3 - 2j])
    turn = np.radians(degrees)
    t = InkTrace(Element(1, PLAN, "B", "curve", z, "main"), "measured", shift, turn, deviation=abs(shift) + 3.6 * turn,
              at=z * np.exp(1j * turn) + shift)
    assert judge(t, 0.25, 0.15).verdict == verdict


def test_a_step_is_not_called_by_a_word_no_sheet_has():
    e = Element(1, PLAN, "points(7)", "line", np.array([0, 9 + 0j]), "main", by=By("vector", "graph/points", "7"))
    assert called(e) == "line 7"
    assert called(replace(e, name="B(7)", by=By("vector", "positions/B", "7"))) == "line B(7)"


@pytest.mark.parametrize("upright", [True, False])
def test_a_crease_is_wiped_out_and_what_crosses_it_stays(upright):
    sheet = np.zeros((round(PAPER.height * SCALE), round(PAPER.width * SCALE)), np.uint8)
    view = sheet if upright else sheet.T
    view[:, 1500:1503] = 15
    view[700:703, 1000:2000] = 90  # a line across it
    view[100:1500, 2500:2503] = 15  # paler than a line, but of no whole sheet
    left = displacement.without_creases(sheet, sheet, 18.0)
    shown = left if upright else left.T
    assert not shown[140:600, 1500:1503].any()  # inside the frame
    assert (shown[700:703, 1000:2000] == 90).all()
    assert (shown[100:1500, 2500:2503] == 15).all()
    assert np.array_equal(displacement.without_creases(left, left, 18.0), left)


@pytest.mark.parametrize(("legs", "flaps"), [((60, 50), 1), ((60, 12), 0), ((0, 0), 0)])
@pytest.mark.parametrize("way", [(1, 1), (-1, 1), (1, -1)])
def test_the_back_of_a_dog_ear_lies_where_its_corner_is_mirrored(legs, flaps, way):
    mask = np.zeros((594, 841), bool)
    a, b = legs
    row, column = np.mgrid[: max(a, 1), : max(b, 1)]
    corner = mask[:: way[0], :: way[1]]
    corner[: max(a, 1), : max(b, 1)] = row / max(a, 1) + column / max(b, 1) < (1 if a else 0)
    found = list(lost_ink.flaps(mask))
    assert len(found) == flaps
    if flaps:
        flap = found[0][:: way[0], :: way[1]]
        foot = np.array([a * b * b, a * a * b]) / (a * a + b * b)  # of the corner on the crease: row and column
        assert flap[tuple((1.9 * foot).astype(int))]
        assert not flap[tuple((0.9 * foot).astype(int))]
        assert not flap[tuple((2.1 * foot).astype(int))]


def test_what_is_hidden_is_told_where_it_is():
    grey = np.full((400, 843), 200, np.uint8)  # its lower third is outside the picture
    none = lost_ink.ProfileLines(np.zeros(0, complex), np.zeros(0, complex), np.zeros(0, np.int64))
    mask = lost_ink.hidden_places(grey, AS_IT_IS, np.zeros((594, 841), np.uint8), none, none, 18.0)
    rows = np.flatnonzero(mask.all(1))
    assert (rows[0], rows[-1]) == (pytest.approx(400 - lost_ink.MARGIN, abs=1), 593)
    assert not mask[: rows[0]].any()


@pytest.mark.parametrize(("away", "status"), [(8, "hidden"), (40, "absent lettering")])
def test_letters_that_are_not_seen_beside_what_is_hidden_are_hidden_too(away, status):
    mark = Text(100 + 100j, "A", 5.0)
    e = Element(1, PLAN, "A", "text", text_box(mark), "text", text="A", height=5.0, marks=(mark,))
    mask = np.zeros((594, 841), bool)
    mask[400:, 105 + away : 140 + away] = True
    (found,), _ = trace([e], np.zeros((round(594 * SCALE), round(841 * SCALE)), np.uint8), mask)
    assert found.status == status


@pytest.mark.parametrize(("extra", "said"), [
    ([], "missing"), ([ink(2 + 3j, 48 + 3j)], "not in its place; ink that is not on the sheet lies beside it"),
    ([ink(25 + 20j, 25 + 60j)], "missing")])
def test_what_is_not_in_its_place_and_may_lie_beside_is_not_called_missing(extra, said):
    first = places([line(1, 0, 50, status="missing")], extra)[0]
    assert first.verdict == "red"
    assert photo_report.said(first) == said


@pytest.mark.parametrize(("role", "covered", "verdict"), [("link", 0.5, "amber"), ("table", 0.5, "green"), ("table", 0.1, "amber")])
def test_a_line_of_which_half_is_seen_may_have_been_left_out_and_a_rule_of_the_form_is_there(role, covered, verdict):
    e = Element(1, PLAN, "a", "line", np.array([0, 50], complex), "main", by=By(role, "", ""))
    f = judge(InkTrace(e, "missing", covered=covered, pieces=True), 0.25, 0.15)
    assert (f.verdict, "left out" in f.what) == (verdict, verdict == "amber" and covered > 0.4)


STROKE = ink(10 + 1.6j, 49 + 7.84j)


def named(*others, stroke=STROKE):
    (place,) = (p for p in places(others, [stroke]) if not p.findings)
    return photo_report.said(place).partition("; ")[2]


@pytest.mark.parametrize(("others", "said"), [
    ([], ""), ([line(1, 0, 50)], ""),  # its own ink is in its place
    ([line(1, 0, 50, status="shared")], "it may be line a1, drawn elsewhere"),
    ([line(1, 0, 50), line(2, -30, 90)], "it may be line a1, drawn elsewhere"),  # under a longer one
    ([line(1, 0, 50), line(2, 30, 90)], ""),
    ([line(1, 0, 50, status="shared"), line(2, 0, 51 + 1j, status="dense")], "it may be line a1 or line a2, drawn elsewhere"),
    ([line(k, 0, 49 + k + 1j, status="dense") for k in range(3)], ""),
    ([line(1, 0, 80, status="shared")], ""), ([line(1, 0, 50j, status="shared")], ""),  # longer, another way
    ([line(1, 20j, 50 + 20j, status="shared")], ""),  # neither end stays
])
def test_ink_is_called_by_the_one_line_that_may_have_been_drawn_there(others, said):
    assert named(*others) == said


def test_ink_that_is_no_stroke_has_no_name():
    assert named(line(1, 0, 50, status="shared"), stroke=ink(10 + 2j, 30 + 9j, 49 + 8j)) == ""
