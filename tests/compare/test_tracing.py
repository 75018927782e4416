"""Elements measured in ink that was put where it is known to be: ends, strokes in common, displacements, ink too much."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import cv2
import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo import arrow_heads, displacement, tracing
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.line_ends import with_edges
from tmm_sheets.compare.photo.own_place import in_place, strip_of
from tmm_sheets.compare.photo.profiles import SCALE
from tmm_sheets.compare.photo.small_marks import displaced_dots
from tmm_sheets.compare.photo.traces import InkTrace, Owners, Paper, fill
from tmm_sheets.compare.photo.tracing import trace
from tmm_sheets.drawing.marks import Provenance as By, Text
from tmm_sheets.drawing.styles import line_type

pytestmark = pytest.mark.judging

HIGH, WIDE = 264, 290
"""Of the sheet so much from the top and from the left, in mm: all that is drawn here lies there."""
ROWS, COLUMNS = 6 * HIGH, 6 * WIDE
VIEW = ElementView(0, "view", Box(0, 0, 841, 594))


def line(number, a, b, style="main", role="link"):
    return Element(number, VIEW, "", "line", np.array([a, b]), style, by=By(role, "", ""))


@cache
def bare():
    return np.random.default_rng(1).integers(0, 5, (ROWS, COLUMNS)).astype(np.uint8)


def paper():
    """Bare paper with some grain."""
    return bare().copy()


def draw(ink, a, b, style="main", dark=180):
    """A line with round ends, its edges as smooth as a camera makes them."""
    margin = 3.0
    x0, x1 = (round((t + s * margin) * SCALE) for t, s in ((min(a.real, b.real), -1), (max(a.real, b.real), 1)))
    y0, y1 = (round((594 - t + s * margin) * SCALE) for t, s in ((max(a.imag, b.imag), -1), (min(a.imag, b.imag), 1)))
    z = (np.arange(x0, x1) + 0.5) / SCALE + 1j * (594 - (np.arange(y0, y1)[:, None] + 0.5) / SCALE)
    t = np.clip(((z - a) * np.conj(b - a)).real / abs(b - a) ** 2, 0, 1)
    share = np.clip((0.5 * line_type(style).width - np.abs(z - a - t * (b - a))) * SCALE + 0.5, 0, 1)
    here = (slice(y0, y1), slice(x0, x1))
    ink[here] = np.maximum(ink[here], cv2.GaussianBlur((dark * share).astype(np.uint8), (0, 0), 1.2))


def traced(known, drawn):
    ink = paper()
    for a, b, style in drawn:
        draw(ink, a, b, style)
    return trace(known, ink)


CORNER = 130 + 440j
"""Where a line ends on another that crosses there."""


@pytest.mark.parametrize("off", [-3.0, -1.5, 1.5, 3.0])
def test_a_line_that_ends_at_another_is_measured_at_both_sides_of_it(off):
    known = [line(1, 70 + 440j, CORNER), line(2, 130 + 390j, 130 + 490j)]
    found, extra = traced(known, [(70 + 440j, CORNER + off, "main"), (130 + 390j, 130 + 490j, "main")])
    assert found[0].ends[1] == pytest.approx(off, abs=0.5)
    assert found[0].ends[0] == pytest.approx(0, abs=0.3)
    f = judge(found[0], 0.25, 0.15)
    assert f.verdict == ("red" if abs(off) > 2 else "amber")
    assert ("too long at its end" if off > 0 else "too short at its end") in f.what
    assert judge(found[1], 0.25, 0.15).verdict == "green"
    assert extra == []


def test_a_line_that_goes_on_after_a_gap_is_not_short():
    known = [line(1, 70 + 440j, CORNER), line(2, 130 + 390j, 130 + 490j)]
    pieces = [(70 + 440j, CORNER - 5, "main"), (CORNER - 2, CORNER, "main"), (130 + 390j, 130 + 490j, "main")]
    found, _ = traced(known, pieces)
    assert found[0].ends[1] == pytest.approx(0, abs=0.3)
    assert judge(found[0], 0.25, 0.15).verdict == "green"


def test_an_end_where_another_line_goes_on_is_not_known():
    known = [line(1, 70 + 440j, CORNER), line(2, CORNER, 190 + 440j, "vector")]
    for end in (CORNER, CORNER + 3):
        found, _ = traced(known, [(70 + 440j, end, "main"), (CORNER, 190 + 440j, "vector")])
        assert np.isnan(found[0].ends[1])
        f = judge(found[0], 0.25, 0.15)
        assert (f.verdict, f.hidden_ends) == ("green", 1)


def test_a_slanting_line_hides_as_well_as_a_level_one():
    """A thin line at 45 degrees is a row of pixels that touch at their corners."""
    known = [line(1, 90 + 400j, CORNER, "thin"), line(2, 80 + 390j, 180 + 490j, "thin")]
    owners = Owners(ROWS, COLUMNS)
    for e in known:
        owners.add(e, e.points)
    across = CORNER + 20 * np.exp(0.25j * np.pi) + 1j * np.exp(0.25j * np.pi) * np.linspace(-0.7, 0.7, 13)
    for slide in np.linspace(0, 0.5, 9):
        assert owners.others(1, across + slide * np.exp(0.25j * np.pi)).any()
    assert owners.others(1, known[0].points[1:] - 10 - 10j).all()  # both are there
    assert not owners.others(2, known[1].points[1:] - 10 - 10j).any()


@pytest.mark.parametrize("off", [0.0, 0.3, 0.9])
def test_lines_in_one_stroke_are_measured_together(off):
    """A construction line under a vector: what they share can be in place or off, which of them is off cannot be told."""
    a, b = 80 + 440j, 160 + 480j
    u = (b - a) / abs(b - a)
    known = [line(1, a, b, "construction"), line(2, a + 0.3j * u, b + 0.3j * u, "vector")]
    found, _ = traced(known, [(e.points[0] + 1j * off * u, e.points[1] + 1j * off * u, e.style) for e in known])
    for t in found:
        f = judge(t, 0.25, 0.15)
        assert (f.verdict == "green" and not f.unknown) == (off < 0.4)
        if t.status != "dense":
            assert t.deviation == pytest.approx(off, abs=0.15)


@pytest.mark.parametrize(("by", "verdict"), [(0.0, "green"), (2.5, "amber"), (-4.0, "amber")])
def test_a_line_that_left_its_stroke_is_seen_beside_it(by, verdict):
    """A helper line turned about its beginning, from under a vector that is right, across another line."""
    a, b = 80 + 440j, 110 + 440j
    known = [line(1, a, b, "construction"), line(2, a, b, "vector"), line(3, 98 + 420j, 98 + 460j)]
    found, _ = traced(known, [(a, b + 1j * by, "construction"), *((*e.points, e.style) for e in known[1:])])
    assert judge(found[0], 0.25, 0.15).verdict == verdict
    assert judge(found[2], 0.25, 0.15).verdict == "green"
    if by:
        assert found[0].turn * 30 == pytest.approx(by, abs=0.4)


def test_a_line_among_others_that_has_ink_at_its_own_place_is_not_called_displaced():
    """A fan of lines a millimetre apart, blurred until the gaps are grey."""
    known = [line(k + 1, 130 + 1j * (440 + 0.9 * k), 210 + 1j * (440 + 0.9 * k), "thin") for k in range(8)]
    ink = paper()
    for e in known:
        draw(ink, *e.points, "thin")
    ink = cv2.GaussianBlur(ink, (0, 0), 2.5)
    found, extra = trace(known, ink)
    assert {judge(t, 0.25, 0.15).verdict for t in found} == {"green"}
    assert extra == []


def test_missing_and_displaced_lines_and_ink_too_much():
    known = [line(1, 30 + 440j, 90 + 440j), line(2, 30 + 460j, 90 + 460j), line(3, 30 + 480j, 90 + 480j, "thin")]
    drawn = [(30 + 444j, 90 + 444j, "main"), (30 + 481.5j, 90 + 481.5j, "thin"), (230 + 340j, 260 + 360j, "thin")]
    found, extra = traced(known, drawn)
    assert [t.status for t in found] == ["measured", "missing", "measured"]
    assert found[0].shift == pytest.approx(4j, abs=0.2)
    assert found[2].shift == pytest.approx(1.5j, abs=0.2)
    (one,) = extra
    assert one.middle == pytest.approx(245 + 350j, abs=1.0)
    assert (one.width, one.height) == pytest.approx((30, 20), abs=1.5)


def test_thin_lines_drawn_over_are_a_remark_and_none_in_a_soft_picture():
    known = [line(1, 70 + 440j, CORNER, "thin")]
    for over, verdict in ((2.0, "green"), (4.0, "amber"), (5.8, "amber")):
        found, _ = traced(known, [(70 + 440j, CORNER + over, "thin")])
        assert judge(found[0], 0.25, 0.15).verdict == verdict
        assert judge(found[0], 0.25, 0.15, soft=True).verdict == "green"


@pytest.mark.parametrize(("role", "style", "off", "verdict"), [
    ("link", "main", -1.3, "amber"), ("vector", "vector", -1.3, "amber"), ("link", "main", -4.0, "red"),
    ("symbol", "main", -1.3, "green"), ("symbol", "main", 1.3, "green"), ("symbol", "main", -4.0, "amber"),
    ("curve", "curve", -1.7, "green"), ("curve", "curve", -4.0, "amber"),
    ("axis", "centre", -3.5, "green"), ("axis", "centre", 3.5, "amber"), ("axis", "centre", -7.0, "green"),
    ("axis", "centre", 7.0, "amber"),
    ("axis", "thin", -3.5, "amber"), ("axis", "hidden", -3.5, "green"), ("axis", "hidden", -8.5, "amber"),
    ("construction", "thin", -1.6, "green"), ("construction", "thin", -1.9, "amber"), ("construction", "thin", 2.4, "green"),
    ("construction", "thin", 2.7, "amber"), ("construction", "hidden", -3.0, "green"), ("construction", "hidden", -8.5, "amber"),
])
def test_how_far_a_line_may_end_from_its_end(role, style, off, verdict):
    """Guides, supports and curves end where the hand stopped, dashed lines a dash before; links and vectors end in points."""
    e = line(1, 70 + 440j, 130 + 440j, style, role)
    assert judge(InkTrace(e, "measured", ends=(0.0, off), at=e.points), 0.25, 0.15).verdict == verdict


@pytest.mark.parametrize(("off", "end", "what"), [
    (0.0, -3.0, "3.0 mm too short at its end"), (0.6, -3.0, "3.0 mm too short at its end"),
    (0.0, 3.0, "3.0 mm too long at its end"),
    (0.6, 0.0, "a little aside, no more than its kind may be"), (0.6, np.nan, "a little aside, no more than its kind may be"),
])
def test_a_short_line_may_be_turned_a_little_but_not_end_elsewhere(off, end, what):
    e = line(1, 120 + 440j, 130 + 440j, "thin", "construction")
    assert judge(InkTrace(e, "measured", turn=off / 5, deviation=off, ends=(0.0, end), at=e.points), 0.25, 0.15).what == what


@pytest.mark.parametrize(("gap", "short"), [(1.6, True), (0.0, False)])
def test_an_ordinate_that_stops_before_its_curve_is_short(gap, short):
    """What is at its end is the curve."""
    end, slope = 130 + 440j, 9 * np.exp(0.75j)
    known = [line(1, end - 40j, end, "thin", "construction"), line(2, end - slope, end + slope, "curve", "curve")]
    ink = paper()
    draw(ink, end - 40j, end - (1.4 + gap) * 1j if gap else end, "thin")
    draw(ink, end - slope, end + slope, "curve")
    f = judge(trace(known, ink)[0][0], 0.25, 0.15)
    assert ("too short at its end" in f.what) == short


SLIDER = np.array([-3 - 2j, 3 - 2j, 3 + 2j, -3 + 2j, -3 - 2j]) + 130 + 440j


@pytest.mark.parametrize(("kind", "free", "off", "verdict"), [
    ("line", 1.0, 0.6, "amber"), ("line", 0.4, 0.6, "green"), ("line", 0.4, 0.3, "green"), ("line", 0.4, 1.2, "red"),
    ("curve", 1.0, 0.6, "amber"), ("curve", 0.4, 0.6, "green"), ("curve", 0.4, 1.2, "green"), ("curve", 1.0, 1.2, "amber"),
    ("circle", 0.4, 0.6, "amber"),
])
def test_what_is_a_little_off_among_others_is_not_judged(kind, free, off, verdict):
    """Its ink cannot be told from the edge of theirs; what is far off can, but for a small outline, which any ink is near.

    A large circle is seen between them.
    """
    z = SLIDER if kind == "curve" else 130 + 440j + np.array([0, 40])
    e = Element(1, VIEW, "", kind, z, "thin", radius=20.0)
    f = judge(InkTrace(e, "measured", 1j * off, deviation=off, at=z + 1j * off, free=free), 0.25, 0.15)
    assert f.verdict == verdict
    assert f.unknown == (verdict == "green" and off > 0.4)


def test_an_end_that_is_short_is_told_though_others_run_along():
    e = line(1, 70 + 440j, 130 + 440j)
    f = judge(InkTrace(e, "measured", 0.6j, deviation=0.6, at=e.points + 0.6j, free=0.4, ends=(0.0, -4.0)), 0.25, 0.15)
    assert (f.verdict, f.what) == ("red", "4.0 mm too short at its end")


def test_the_edge_of_another_line_is_no_displaced_one():
    """A line that is not there, beside two thick ones whose edges are as near as it could be drawn."""
    known = [line(1, 70 + 440j, 130 + 440j, "thin"), line(2, 70 + 440.9j, 130 + 440.9j), line(3, 70 + 439.1j, 130 + 439.1j)]
    found, _ = traced(known, [(*e.points, "main") for e in known[1:]])
    assert judge(found[0], 0.25, 0.15).verdict == "green"


def test_a_soft_picture_has_a_wider_tolerance():
    known = [line(1, 70 + 440j, CORNER)]
    found, _ = traced(known, [(70 + 440.5j, CORNER + 0.5j, "main")])
    assert found[0].deviation == pytest.approx(0.5, abs=0.05)
    assert judge(found[0], 0.25, 0.15).verdict == "amber"
    assert judge(found[0], 0.25, 0.15, soft=True).verdict == "green"


def arrow(number, a, b):
    """A vector, its head 5 mm long and 1.8 mm wide."""
    u = (b - a) / abs(b - a)
    head = b - 5 * u + 0.9j * u, b - 5 * u - 0.9j * u
    return Element(number, VIEW, "", "line", np.array([a, b]), "vector", fills=(np.array([b, *head]),))


def fill_head(ink, at, way):
    """A head drawn by hand at a place: somewhat smaller and not quite straight."""
    u = np.exp(1j * (way + 0.05))
    corners = at + np.array([0, -3.6 * u + 0.6j * u, -3.6 * u - 0.65j * u])
    pixels = np.rint(16 * np.stack((corners.real * SCALE - 0.5, (594 - corners.imag) * SCALE - 0.5), 1)).astype(np.int32)
    cv2.fillPoly(ink, [pixels], 180, cv2.LINE_AA, 4)


@pytest.mark.parametrize(("head", "verdict", "said"), [
    ("there", "green", "within a pencil's reach"), ("absent", "amber", "no arrow head here"),
    ("reversed", "red", "the arrow points the other way"),
])
def test_the_head_of_an_arrow_is_looked_for_at_both_ends(head, verdict, said):
    a, b = 130 + 440j, 160 + 460j
    helper = line(2, 2 * a - b, b, "thin")  # a line under it does not matter
    ink = paper()
    known = [arrow(1, a, b), helper]
    for e in known:
        draw(ink, *e.points, e.style)
    way = float(np.angle(b - a))
    if head == "reversed":
        fill_head(ink, a, way + np.pi)
    elif head == "there":
        fill_head(ink, b, way)
    found, _ = trace(known, ink)
    f = judge(found[0], 0.25, 0.15)
    assert (found[0].head, f.verdict) == (head, verdict)
    assert said in f.what


@pytest.mark.parametrize(("head", "wide"), [("there", 1.0), ("there", 0.8), ("absent", 1.0), ("absent", 0.5)])
def test_heads_are_known_in_black_and_white_too(head, wide):
    """There lines are wider than they were drawn, and heads are no more than half as wide again."""
    a, b = 130 + 440j, 160 + 460j
    u = (b - a) / abs(b - a)
    ink = np.zeros((ROWS, COLUMNS), np.uint8)
    lines = [(a + wide / 2 * 1j * u, a - wide / 2 * 1j * u, b - wide / 2 * 1j * u, b + wide / 2 * 1j * u)]
    if head == "there":
        side = 0.35 + wide / 2
        lines.append((b + 0.3 * u, b - 4.5 * u + side * 1j * u, b - 4.5 * u - side * 1j * u))
    for corners in lines:
        z = np.array(corners)
        cv2.fillPoly(ink, [np.rint(np.stack((z.real * SCALE - 0.5, (594 - z.imag) * SCALE - 0.5), 1)).astype(np.int32)], 200)
    assert trace([arrow(1, a, b)], ink)[0][0].head == head


@pytest.mark.parametrize("theirs", [False, True])
def test_a_head_at_the_other_end_tells_though_the_tip_is_hidden(theirs):
    """Lines beside the tip hide it; where another arrow has its head at the other end, nothing is told."""
    a, b = 130 + 440j, 160 + 440j
    known = [arrow(1, a, b), line(2, b - 5 + 0.5j, b + 3 + 0.5j), line(3, b - 5 - 0.5j, b + 3 - 0.5j)]
    if theirs:
        known.append(arrow(4, b, a))
    ink = paper()
    for e in known:
        draw(ink, *e.points, e.style)
    fill_head(ink, a, np.pi)
    found, _ = trace(known, ink)
    assert (found[0].head == "reversed") == (not theirs)


@pytest.mark.parametrize(("turn", "beside"), [(0.08, True), (-0.15, True), (1.2, False), (np.pi / 2, False), (np.pi, False)])
def test_a_line_from_the_same_pole_is_told_beside_a_vector(turn, beside):
    """At a small angle it looks like the edge of a head, from the other end of a vector whose tip is hidden."""
    a, b = 130 + 440j, 160 + 460j
    known = [arrow(1, a, b), line(2, a, a + 20 * np.exp(1j * turn) * (b - a) / abs(b - a))]
    sheet = arrow_heads.Arrows(Paper.of(known, paper(), np.zeros((HIGH, WIDE), bool)), [])
    assert sheet.accompanied(known[0], a, (b - a) / abs(b - a)) is beside


def test_a_vector_left_out_over_a_helper_has_no_head_though_there_is_a_dot():
    a, b = 130 + 440j, 160 + 460j
    dot = Element(3, VIEW, "", "circle", b + 0.65 * np.exp(1j * np.linspace(0, 2 * np.pi, 40)), "thin", centre=b, radius=0.65,
                  fills=(b + 0.65 * np.exp(1j * np.linspace(0, 2 * np.pi, 40)),))
    known = [arrow(1, a, b), line(2, 2 * a - b, b, "thin"), dot]
    ink = paper()
    draw(ink, 2 * a - b, b, "thin")
    corners = np.rint(16 * np.stack((dot.points.real * SCALE - 0.5, (594 - dot.points.imag) * SCALE - 0.5), 1)).astype(np.int32)
    cv2.fillPoly(ink, [corners], 180, cv2.LINE_AA, 4)
    found, _ = trace(known, ink)
    assert (found[0].head, judge(found[0], 0.25, 0.15).what) == ("absent", "no arrow head here")


@pytest.mark.parametrize(("by", "left_out"), [(-1.0, 1), (1.0, 2), (1.0, None)])
def test_a_line_seen_only_where_another_covers_it_is_a_place_to_look_at(by, left_out):
    """Two vectors that part at so small an angle that they are one stroke for most of their way; another shows what is usual."""
    ends = (160 + 440j, 160 + (440 + by) * 1j, 160 + 490j)
    known = [line(k, 80 + 440j, end, "vector") for k, end in enumerate(ends, 1)]
    found, _ = traced(known, [(*e.points, "vector") for e in known if e.number != left_out])
    assert [judge(t, 0.25, 0.15).verdict for t in found] == ["amber" if e.number == left_out else "green" for e in known]
    assert [t.element.number for t in found if t.status == "covered"] == [left_out] * (left_out is not None)


def word(*runs, bar=False):
    """Lettering of W, M and V, its letters 4 mm high and about as wide, in runs; with a bar over it."""
    at, text = 130 + 440j, "".join(runs)
    marks = [Text(at + 4 * len("".join(runs[:k])), run, 4.0) for k, run in enumerate(runs)]
    pieces = (np.array([at + 4.3j, at + 4 * len(text) + 4.3j]),) if bar else ()
    corners = at + np.array([0, 4 * len(text), 4 * len(text) + 4j, 4j])
    return Element(1, VIEW, text, "text", corners, "text", text=text, height=4.0, pieces=pieces, marks=tuple(marks))


@pytest.mark.parametrize(("runs", "letters", "bar", "status"), [
    (("WMW",), "WMW", False, "lettering"), (("WMW",), "W", False, "part of lettering"), (("WMW",), "", False, "absent lettering"),
    (("WM", "M"), "WMM", True, "lettering"), (("WM", "M"), "WM", True, "part of lettering"),
    (("W", "M"), "", True, "absent lettering"),
])
def test_part_of_lettering_is_missed(runs, letters, bar, status):
    """A run of letters is looked for by itself, and the bar over letters that stand elsewhere is no lettering."""
    ink = paper()
    write(ink, letters, 130 + 440j)
    known = word(*runs, bar=bar)
    for a, b in known.pieces:
        draw(ink, a, b, "thin")
    found, _ = trace([known], ink)
    assert found[0].status == status


def test_the_words_of_the_form_outside_the_frame_are_not_looked_for():
    known = word("WMW")
    outside = replace(known, number=2, points=known.points - 128, marks=tuple(m._replace(at=m.at - 128) for m in known.marks))
    assert [t.status for t in trace([known, outside], paper())[0]] == ["absent lettering", "small"]


def write(ink, letters, at):
    """Zigzags, 4 mm each."""
    for k in range(len(letters)):
        x = at + 0.3 + 4 * k
        for one, other in ((0, 1 + 4j), (1 + 4j, 2), (2, 3 + 4j)):
            draw(ink, x + one, x + other, "thin")


@pytest.mark.parametrize(("letters", "by", "where"), [
    ("WMW", 9j, 9j), ("WMW", 10 - 8j, 10 - 8j), ("WMW", -6 + 0j, -6 + 0j), ("W", 9j, None), ("WMWMW", 9j, None),
    ("WMW", 18j, None), ("", 9j, None), ("WMW", -8 + 0j, -8 + 0j),
])
def test_lettering_is_looked_for_beside_its_place(letters, by, where):
    """By ink of its size, as a whole even where it lies partly in its old place."""
    ink, known = paper(), word("WMW")
    write(ink, letters, 130 + 440j + by)
    (found,), _ = trace([known], ink)
    assert found.status in ("absent lettering", "part of lettering")
    assert (found.at is None) == (where is None)
    assert found.shift == pytest.approx(where or 0, abs=0.7)


@pytest.mark.parametrize("by", [8 + 0j, 11 + 1j])
def test_lettering_is_seen_elsewhere_though_some_ink_is_in_its_place(by):
    """Its old place is not quite empty where it was moved by less than its length."""
    ink, known = paper(), word("WMWWMW")
    write(ink, "WMWWMW", 130 + 440j + by)
    (found,), _ = trace([known], ink)
    assert (found.status, found.shift) == ("part of lettering", pytest.approx(by, abs=0.7))


def test_neither_other_lettering_nor_what_lies_on_a_line_is_taken_for_it():
    ink, known = paper(), word("WMW")
    other = replace(known, number=2, points=known.points + 9j, marks=tuple(m._replace(at=m.at + 9j) for m in known.marks))
    write(ink, "WMW", 130 + 449j)
    (found, there), _ = trace([known, other], ink)
    assert (found.status, found.at, there.status) == ("absent lettering", None, "lettering")


@pytest.mark.parametrize(("dark", "deviation"), [(60, 3.0), (170, 0.0)])
def test_a_pale_trace_in_its_place_is_not_the_line_when_a_dark_one_lies_beside(dark, deviation):
    known = [line(k + 1, 130 + 1j * (440 + 10 * k), 170 + 1j * (440 + 10 * k)) for k in range(4)]
    ink = paper()
    for e in known[1:]:
        draw(ink, *e.points)
    draw(ink, *known[0].points, dark=dark)  # rubbed out, or as dark as the others
    draw(ink, *(known[0].points - 3j))
    found, _ = trace(known, ink)
    assert found[0].deviation == pytest.approx(deviation, abs=0.1)


def test_a_straight_stroke_beside_lettering_is_extra_and_a_letter_is_not():
    ink = paper()
    for one, other in ((0, 1 + 5j), (1 + 5j, 2), (2, 3 + 5j)):  # the letter, 4 mm too low
        draw(ink, 130.5 + 436j + one, 130.5 + 436j + other, "thin")
    draw(ink, 128 + 448j, 140 + 446.5j, "thin")
    _, extra = trace([word("W")], ink)
    assert [x.length for x in extra] == pytest.approx([12.1 + 1.0], abs=0.6)  # its blur, and coarse pixels


def test_what_shows_of_a_hidden_line_is_not_extra():
    ink = paper()
    draw(ink, 130 + 440j, 160 + 440j)
    hidden = np.zeros((HIGH, WIDE), bool)
    hidden[140:170, 156:175] = True
    known = [line(1, 130 + 440j, 170 + 440j)]
    traces, extra = trace(known, ink, hidden)
    assert (traces[0].status, extra) == ("hidden", [])


@pytest.mark.parametrize("by", [0.0, 2.1, -1.8])
def test_a_circle_crossed_by_many_lines_is_not_seen_in_their_ink(by):
    """Radii 3 mm apart along the circle: smeared along it they would be a grey band, and the circle in it anywhere."""
    centre, radius = 130 + 440j, 30.0
    turn = np.linspace(0, 2 * np.pi, 200)
    ring = Element(1, VIEW, "", "circle", centre + radius * np.exp(1j * turn), "thin", centre, radius, 0.0, 2 * np.pi)
    way = np.exp(2j * np.pi * np.arange(60) / 60)
    radii = [line(k + 2, centre + 20 * u, centre + 40 * u, "thin") for k, u in enumerate(way)]
    drawn = centre + (radius + by) * np.exp(1j * turn)
    chords = [(a, b, "thin") for a, b in pairwise(drawn)]
    found, _ = traced([ring, *radii], [*chords, *((*e.points, e.style) for e in radii)])
    assert found[0].growth == pytest.approx(by, abs=0.3)
    assert judge(found[0], 0.25, 0.15).verdict == ("red" if by else "green")


def dot(number, at, radius=0.6):
    outline = at + radius * np.exp(1j * np.linspace(0, 2 * np.pi, 24))
    return Element(number, VIEW, "", "circle", outline, "main", at, radius, 0.0, 2 * np.pi, fills=(outline,))


@pytest.mark.parametrize(
    ("places", "says"),
    [
        ([0j], ""),
        ([0.3 + 0.2j], ""),  # a hand's reach
        ([3j], "a dot like it stands beside, and none is seen here: 3.0 mm too far up"),
        ([2.5 - 2.5j], "a dot like it stands beside, and none is seen here: 3.5 mm too far down and right"),
        ([0j, 3j], ""),  # a spot, but the dot is there, too
        ([], ""),  # none at all: lines may have rubbed it out
        ([9j], ""),  # too far to be this one
    ],
)
def test_a_dot_that_stands_beside_its_place(places, says):
    known = [line(1, 100 + 440j, 160 + 440j, "thin"), dot(2, CORNER)]
    ink = paper()
    draw(ink, *known[0].points, "thin")
    for by in places:
        draw(ink, CORNER + by, CORNER + by + 1e-6, "main", 180)
        draw(ink, CORNER + by - 0.2, CORNER + by + 0.2, "main", 180)
    found, _ = trace(known, ink)
    f = judge(found[1], 0.25, 0.15)
    assert (f.verdict, f.what if f.verdict != "green" else "") == ("amber" if says else "green", says)


@pytest.mark.parametrize(
    ("places", "verdicts"),
    [
        ([2.6 + 2.6j], ["amber", "green"]),  # one spot is one dot's, the nearer one's
        ([-1.4 - 1.8j], ["amber", "green"]),  # near its own place
        ([], ["green", "green"]),  # where lines cross it is dark with a dot or without
        ([9 + 9j], ["green", "green"]),
        ([-2.5 + 1j], ["amber", "green"]),  # beside a line
        ([-2.5 - 1j], ["amber", "green"]),
        ([-2.5 + 0.5j], ["green", "green"]),  # in its stroke
    ],
)
def test_a_small_dot_where_lines_cross_is_taken_for_a_spot_beside(places, verdicts):
    lines = [line(1, 100 + 440j, 160 + 440j, "thin"), *(line(k, x + 410j, x + 470j, "thin") for k, x in ((2, 130), (3, 136)))]
    ink = paper()
    for e in lines:
        draw(ink, *e.points, "thin")
    draw(ink, CORNER - 0.2, CORNER + 0.2, "main", 230)  # strokes that cross are darker
    for by in places:
        draw(ink, CORNER + by - 0.1, CORNER + by + 0.1, "thin", 230)
    found, _ = trace([*lines, dot(4, CORNER, 0.35), dot(5, CORNER + 6, 0.35)], ink)
    assert [judge(t, 0.25, 0.15).verdict for t in found[3:]] == verdicts


def stands(some, rods, ink, words, usual=180):
    """Where dots stand that are not in their places, by number."""
    nothing = np.zeros_like(ink)
    found = displaced_dots(some, rods, nothing, nothing, ink, words, np.zeros((1, 1), bool), usual)
    return {t.element.number: complex(np.round(t.shift, 0)) for t in found}


@pytest.mark.parametrize(("usual", "wide", "found"), [
    (180, 0.9, {1: 3j}), (180, 1.22, {}), (255, 1.22, {1: 3j}), (255, 1.6, {})])  # fmt: skip
def test_a_dot_in_a_black_and_white_picture_may_be_swollen(usual, wide, found):
    ink = paper()
    corners = CORNER + 3j + wide / 2 * np.exp(2j * np.pi * np.arange(40) / 40)
    fill(ink, corners, usual)
    assert stands([dot(1, CORNER, 0.35)], [], ink, np.zeros_like(ink), usual) == found


def on_a_line(places, radius=0.6, heads=(), usual=180):
    """Dots of that radius upon a thin line through CORNER and a thick one beside, where they are found, by number."""
    ink, lines = paper(), np.zeros((ROWS, COLUMNS), np.uint8)
    for a, b, style in ((100 + 440j, 160 + 440j, "thin"), (100 + 444j, 160 + 444j, "main")):
        draw(ink, a, b, style)
        ends = ((round(z.real * SCALE), round((594 - z.imag) * SCALE)) for z in (a, b))
        cv2.line(lines, *ends, 255, round(SCALE * line_type(style).width))
    for by in places:
        for k in range(8):
            draw(ink, CORNER + by, CORNER + by + (radius - 0.2) * np.exp(1j * k), "main")
    for tip in heads:
        fill_head(ink, CORNER + tip, 1)
    words = np.zeros((ROWS, COLUMNS), np.uint8)
    found = displaced_dots([dot(1, CORNER, radius)], [], lines, lines, ink, words, np.zeros((1, 1), bool), usual)
    return {t.element.number: complex(np.round(t.shift, 0)) for t in found}


@pytest.mark.parametrize(
    ("places", "radius", "found"),
    [
        ([3 + 0j], 0.6, {1: 3 + 0j}),  # a bump on its line
        ([-3 + 0j], 0.6, {1: -3 + 0j}),
        ([-2 + 0.5j], 0.6, {1: -2 + 0j}),  # half upon it
        ([], 0.6, {}),
        ([0j], 0.6, {}),
        ([0.3 + 0j, 3 + 0j], 0.6, {}),  # one too many, but this is in its place
        ([1.1 + 0j], 0.6, {}),  # nearly in its place
        ([1 + 4j], 0.5, {}),  # in the thick line: no wider than a pencil makes that
        ([1 + 4.5j], 0.6, {1: 1 + 5j}),  # at its edge
        ([7 + 0j], 0.6, {}),
    ],
)
def test_a_dot_upon_a_line_is_a_bump(places, radius, found):
    assert on_a_line(places, radius) == found


def test_a_head_upon_a_line_and_black_lines_are_no_bumps():
    assert on_a_line([], heads=[2 + 0j]) == {}
    assert on_a_line([3 + 0j], usual=250) == {}  # a picture without grey


@pytest.mark.parametrize("barred", [True, False])
def test_a_bar_over_a_letter_is_no_dot(barred):
    """As wide as it is long it is, blurred; its letter is known to have one."""
    ink, nothing = paper(), np.zeros((ROWS, COLUMNS), np.uint8)
    draw(ink, CORNER + 3.7 + 3j, CORNER + 4.3 + 3j, "main", 230)
    corners = CORNER + 3 - 2j + np.array([0, 2, 2 + 4j, 4j])
    letter = Element(2, VIEW, "G", "text", corners, "text", text="G", height=4.0, marks=(Text(corners[0], "G", 4.0),),
                     pieces=(CORNER + np.array([3.5 + 3j, 4.5 + 3j]),) if barred else ())  # fmt: skip
    bars = tracing.bars([letter], ink)
    found = displaced_dots([dot(1, CORNER)], [], nothing, bars, ink, nothing, np.zeros((1, 1), bool), 180, bars=bars)
    assert bool(found) != barred


@pytest.mark.parametrize(("astray", "meant"), [((), {1}), ((1,), {1}), ((2,), {2}), ((1, 2), {1}), ((3,), {1})])
def test_of_two_dots_the_one_is_meant_whose_line_is_not_in_its_place(astray, meant):
    rods = [np.array([CORNER - 25 + k * 2j, CORNER + k * 2j]) for k in range(3)]
    ink, nothing = paper(), np.zeros((ROWS, COLUMNS), np.uint8)
    draw(ink, CORNER - 2.2j, CORNER - 1.8j, "main", 230)
    some, lost = [dot(1, CORNER, 0.5), dot(2, CORNER + 2j, 0.5)], [rods[k - 1] for k in astray]
    found = displaced_dots(some, rods, nothing, nothing, ink, nothing, np.zeros((1, 1), bool), 180, lost)
    assert {t.element.number for t in found} == meant


@pytest.mark.parametrize("over", [0.5, 1.2, 2.0])
def test_the_end_of_a_line_that_was_drawn_over_is_no_dot(over):
    """Nor where it is dark as a spot, behind a paler place, as grains of a sensor make it."""
    upright, level = line(1, CORNER, CORNER + 40j, "thin"), line(2, CORNER - 30, CORNER + 30, "thin")
    ink = paper()
    draw(ink, *level.points, "thin")
    draw(ink, CORNER - 1j * over, CORNER + 40j, "thin", 110)
    draw(ink, CORNER - 1j * over - 0.1j, CORNER - 1j * over + 0.1j, "thin", 230)
    found, _ = trace([upright, level, dot(3, CORNER, 0.35)], ink)
    assert judge(found[2], 0.25, 0.15).verdict == "green"


@pytest.mark.parametrize(("by", "verdict"), [(1.2, "amber"), (1.84, "amber"), (4.0, "amber"), (0.5, "green"), (0.0, "green")])
def test_a_line_that_parts_from_its_stroke_only_near_its_end_is_seen(by, verdict):
    """Of a helper line under a vector that was turned about the pole, as little as a third lies on bare paper."""
    a, b = 80 + 440j, 131 + 440j
    known = [line(1, a, b, "construction"), line(2, a, b - 4)]
    found, _ = traced(known, [(a, b + 1j * by, "construction"), (a, b - 4, "main")])
    assert [judge(t, 0.25, 0.15).verdict for t in found] == [verdict, "green"]


@pytest.mark.parametrize(("gap", "rest", "short"), [(2.0, 2.5, False), (2.0, 0.6, True), (4.5, 1.5, True)])
def test_a_gap_near_an_end_is_a_lifted_pencil_when_ink_follows(gap, rest, short):
    """The head of another arrow covers the end: the rest may be its ink or the line's own."""
    end = 130 + 440j
    other = arrow(2, end + 30, end - rest)
    known = [line(1, end - 60, end), other]
    ink = paper()
    draw(ink, end - 60, end - gap - rest)
    draw(ink, end - rest, end + 30)
    fill_head(ink, end - rest, -1)
    f = judge(trace(known, ink)[0][0], 0.25, 0.15)
    assert ("too short at its end" in f.what) == short


@pytest.mark.parametrize(("dark", "to", "short"), [(45, 0.0, False), (0, 0.0, True), (45, -2.0, True)])
def test_an_end_that_goes_on_paler_is_under_adhesive_tape(dark, to, short):
    """Where the pale rest stops as well, the line is too short all the same."""
    end = 130 + 440j
    known = [line(1, end - 60, end), line(2, end - 40j, end + 40j)]
    ink = paper()
    draw(ink, end - 40j, end + 40j)
    draw(ink, end - 60, end - 3.5)
    if dark:
        draw(ink, end - 60, end + to, dark=dark)
    f = judge(trace(known, ink)[0][0], 0.25, 0.15)
    assert ("too short at its end" in f.what) == short


def joint(step="positions/A"):
    """The circle of a joint of 1.6 mm, and the directions of its points."""
    circle = np.exp(2j * np.pi * np.arange(61) / 60)
    e = Element(9, VIEW, "", "circle", CORNER + 1.6 * circle, "main", CORNER, 1.6, 0.0, 2 * np.pi, by=By("symbol", step, "1"))
    return e, circle


@pytest.mark.parametrize(
    ("radius", "aside", "verdict", "said"),
    [
        (1.6, 0, "green", ""),
        (1.6, 0.25, "green", ""),  # a hand's reach
        (1.75, 0, "green", ""),
        (2.3, 0, "amber", "0.7"),
        (2.3, 0.2j, "amber", "0.7"),
        (1.3, 0, "green", ""),
        (None, 0, "green", ""),  # none is seen among the lines
    ],
)
def test_the_circle_of_a_joint_is_told_by_its_outer_edge(radius, aside, verdict, said):
    """Within it lines end and a dot stands; three of its sides are left free by them."""
    ways = 12 * np.exp(1j * np.array([0.2, 1.4, 1.6, 3.3]))
    e, circle = joint()
    ink = paper()
    for w in ways:
        draw(ink, CORNER, CORNER + w)
    for a, b in pairwise(CORNER + aside + (radius or 0) * circle) if radius else ():
        draw(ink, a, b)
    found, _ = trace([*(line(k, CORNER, CORNER + w) for k, w in enumerate(ways)), e], ink)
    f = judge(found[-1], 0.25, 0.15)
    assert f.verdict == verdict
    assert not said or f"radius {said}" in f.what


@pytest.mark.parametrize(
    ("radius", "aside", "growth"), [(1.6, 0, 0), (1.6, 0.25j, 0), (2.3, 0, 0.7), (2.3, 0.1, 0.7), (1.4, 0, -0.2)]
)
@pytest.mark.parametrize("free", [0, 4])  # sides that no line leaves to
def test_the_edge_of_a_joint_is_seen_between_lines_that_leave_it_closely(free, radius, aside, growth):
    """What its line among theirs was measured to be is no matter then."""
    e, circle = joint()
    ways = 8 * np.exp(2j * np.pi * (np.arange(8 - free) + 0.3) / 8)
    ink, owners = paper(), Owners(ROWS, COLUMNS)
    for k, w in enumerate(ways):
        draw(ink, CORNER, CORNER + w, "thin")
        owners.add(line(k + 1, CORNER, CORNER + w, "thin"), np.array([CORNER, CORNER + w]))
    for a, b in pairwise(CORNER + aside + radius * circle):
        draw(ink, a, b)
    t = InkTrace(e, "measured", shift=0.45j, deviation=0.45, at=e.points, free=0.3)
    (found,) = with_edges([t], Paper(ink, owners, np.zeros_like(ink), np.zeros((1, 1), bool), 10.0, 10.0))
    assert (found.growth, abs(found.shift - aside)) == (pytest.approx(growth, abs=0.1), pytest.approx(0, abs=0.1))
    f = judge(found, 0.25, 0.15)
    assert (f.verdict, "radius 0.7" in f.what) == (("amber", True) if growth > 0.4 else ("green", False))


@pytest.mark.parametrize(
    ("step", "free", "said"), [("positions/A", 1.0, "amber"), ("positions/A", 0.5, "green"), ("", 1.0, "green")]
)
def test_a_small_circle_a_little_off_is_told_where_no_others_are_and_a_construction_hangs_on_it(step, free, said):
    e, _ = joint(step)
    for off, verdict in ((0.5, said), (0.9, "red")):
        t = InkTrace(e, "measured", shift=off + 0j, deviation=off, at=e.points + off, free=free)
        assert judge(t, 0.25, 0.15).verdict == verdict


@pytest.mark.parametrize(
    ("end", "dotted", "usual", "status"),
    [
        (CORNER, True, 100, "measured"),
        (CORNER - 1.5, True, 100, "measured"),  # it stops short, but hardly
        (CORNER - 7, True, 100, "covered"),
        (CORNER + 5j, True, 100, "covered"),
        (CORNER - 7, False, 100, "measured"),  # a helper line ends anywhere
        (CORNER - 7, True, 250, "measured"),  # black and white eats thin lines
    ],
)
def test_a_line_that_others_cover_must_be_seen_to_the_dot_where_it_ends(end, dotted, usual, status):
    """Another line runs along most of it, and was taken for it."""
    begin = CORNER - 18
    e, along = line(1, begin, CORNER, "construction"), line(2, begin - 5, CORNER - 5 + 0.2j, "construction")
    ink = paper()
    for one, to in ((e, end), (along, along.points[1])):
        draw(ink, one.points[0], to, one.style)
    seen = Paper.of([e, along], ink, np.zeros((1, 1), bool))
    strip = strip_of(e, seen)
    alone = tracing.alone_on(strip, np.array([CORNER] if dotted else [], complex))
    traces = [InkTrace(one, "measured", at=one.points, darkness=usual, covered=1.0) for one in (e, along)]
    nothing = np.zeros_like(ink)
    found = tracing.doubted(traces, {} if alone is None else {1: alone}, nothing, nothing, seen)
    assert [t.status for t in found] == [status, "measured"]


@pytest.mark.parametrize(("here", "status"), [(140, "dense"), (40, "measured")])
def test_a_line_whose_own_place_has_ink_too_is_not_off(here, status):
    """It lies on the flank of a broader stroke, or a millimetre off in bare paper."""
    e = line(1, CORNER - 20, CORNER + 20, "thin")
    strip = strip_of(e, Paper.of([e], paper(), np.zeros((1, 1), bool)))
    across = np.interp(strip.offsets, (-0.5, 0, 0.9, 1.1, 1.4), (0, here, 150, 150, 0))
    strip.profile = np.tile(across.astype(np.float32), (len(strip.stations.points), 1))
    assert in_place(strip).status == status


@pytest.mark.parametrize(("dark", "status"), [(20, "covered"), (60, "measured")])
def test_a_line_whose_place_is_far_paler_than_its_kind_is_not_there(dark, status):
    """Ends of a hatching stand in its place."""
    known = [line(k, 30 + 440j + 10j * k, 90 + 440j + 10j * k) for k in range(3)]
    traces = [InkTrace(e, "measured", at=e.points, darkness=d, covered=1.0) for e, d in zip(known, (dark, 100, 100), strict=True)]
    nothing = np.zeros((ROWS, COLUMNS), np.uint8)
    found = tracing.doubted(traces, {}, nothing, nothing, Paper.of((), nothing, np.zeros((1, 1), bool)))
    assert [t.status for t in found] == [status, "measured", "measured"]


@pytest.mark.parametrize(("by", "verdict"), [(0, "green"), (2.8, "amber")])
def test_a_vector_that_was_drawn_into_the_stroke_beside_is_not_seen_in_its_place(by, verdict):
    """From where they are near each other the edge of that stroke is in its place."""
    pole, tip, other = 30 + 340j, 51 + 348j, 62 + 349j
    known = [line(1, pole, other, "vector"), line(2, pole, tip, "vector")]
    way = (tip - pole) / abs(tip - pole)
    found, _ = traced(known, [(pole, other, "vector"), (pole, tip - by * 1j * way, "vector")])
    assert [judge(t, 0.25, 0.15).verdict for t in found] == ["green", verdict]


@pytest.mark.parametrize(("short", "said"), [(0.0, ""), (3.0, "too short at its end")])
def test_a_line_that_others_hide_up_to_bare_paper_before_its_end_is_short(short, said):
    known = [
        line(1, CORNER - 40, CORNER, "construction", "construction"),
        line(2, CORNER - 16 - 0.5j, CORNER - 3.5 + 0.3j, "construction"),
        line(3, CORNER - 5j, CORNER + 5j, "construction"),
    ]
    drawn = [(e.points[0], e.points[1] - (short if e.number == 1 else 0), e.style) for e in known]
    found, _ = traced(known, drawn)
    f = judge(found[0], 0.25, 0.15)
    assert f.verdict == ("amber" if said else "green")
    assert said in f.what


@pytest.mark.parametrize(("begin", "end", "covered", "swung"), [
    (0.3, 4j, 1.0, True),
    (3j, 4j, 1.0, False),  # no end stays
    (0, 1j, 1.0, False),  # hardly turned
    (0.3, 4j, 0.9, False),
])  # fmt: skip
def test_a_line_of_which_little_is_seen_was_turned_about_an_end_that_stays(begin, end, covered, swung):
    e = line(1, CORNER, CORNER + 40)
    assert displacement.swung(InkTrace(e, "measured", covered=covered, at=e.points + np.array([begin, end]))) is swung
