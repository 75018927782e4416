"""Heads of arrows in ink that was put where it is known to be: at the tip, a little off it, at the other end, among others."""

import cv2
import numpy as np
import pytest

from tests.compare.test_tracing import COLUMNS, HIGH, ROWS, WIDE, arrow, draw, fill_head, line, paper
from tmm_sheets.compare.photo.arrow_heads import with_heads
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.line_ends import with_ends
from tmm_sheets.compare.photo.profiles import SCALE
from tmm_sheets.compare.photo.traces import InkTrace, Owners, Paper, fill

pytestmark = [pytest.mark.judging, pytest.mark.trial]

A, B = 130 + 440j, 160 + 460j
WAY = (B - A) / abs(B - A)
BACK = 160 + 460j, float(np.angle(WAY))
"""Where the head belongs, and which way it points."""
OTHER = A, float(np.angle(-WAY))
"""Where it is when the vector is drawn the other way."""


def heads(known, drawn, at=(), letters=(), blur=0.0, grey=True):
    """What is found of the heads of vectors that were found in their places, when lines are drawn and heads stand ``at`` places.

    The picture is blurred by so many mm, a standard deviation, and may be black and white.
    """
    ink, words, owners = paper(), np.zeros((ROWS, COLUMNS), np.uint8), Owners(ROWS, COLUMNS)
    for e in known:
        owners.add(e, e.points)
    for e in drawn:
        draw(ink, *e.points, e.style)
    for place, way in at:
        fill_head(ink, place, way)
    for corners in letters:
        fill(words, np.array(corners))
    if blur:
        ink = cv2.GaussianBlur(ink, (0, 0), blur * SCALE)
    if not grey:
        ink = np.where(ink > ink.max() / 4, np.uint8(255), np.uint8(0))
    traces = [InkTrace(e, "measured", at=e.points) for e in known]
    return with_heads(traces, Paper(ink, owners, words, np.zeros((HIGH, WIDE), bool), 40.0, 40.0))


def ray(number, angle, style="vector", length=30):
    """A line from where the vector begins."""
    return line(number, A, A + length * WAY * np.exp(1j * angle), style)


@pytest.mark.parametrize(("at", "head"), [([BACK], "there"), ([OTHER], "reversed"), ([], "absent")])
@pytest.mark.parametrize("angles", [(), (0.5,), (0.35, 0.7, -2.0), (0.4, -0.4)])
def test_a_head_at_a_pole_is_told_by_what_shows_of_it(at, head, angles):
    rays = [ray(k, angle) for k, angle in enumerate(angles, 2)]
    known = [arrow(1, A, B), *rays]
    found = heads(known, known, at)[0].head
    # Between two lines that part nothing of it shows: then it has none at its tip, and no more is said.
    assert found == head or (head == "reversed" and len(angles) == 2 and found == "absent")


@pytest.mark.parametrize("by", [-1.0, -0.6, 0.6, 1.0])
def test_a_head_a_little_off_its_place_is_there(by):
    """A picture is not flat everywhere."""
    e = arrow(1, A, B)
    assert heads([e], [e], [(B - by * WAY, BACK[1])])[0].head == "there"


@pytest.mark.parametrize("by", [2.5, 3.5])
def test_a_head_farther_back_is_not_missed(by):
    e = arrow(1, A, B)
    assert heads([e], [e], [(B - by * WAY, BACK[1])])[0].head in ("there", "unknown")


@pytest.mark.parametrize(("at", "head"), [([BACK], "there"), ([OTHER], "reversed"), ([], "absent")])
def test_a_letter_near_both_ends_does_not_hide_a_head(at, head):
    """Its place reaches over half of one side of a head."""
    e = arrow(1, A, B)
    letters = [[z, z + 6 * u, z + 6 * u + 6j * u, z + 6j * u] for z, u in ((B - 3 * WAY, WAY), (A + 3 * WAY, -WAY))]
    assert heads([e], [e], at, letters)[0].head == head


def test_a_line_that_stops_before_its_tip_has_lost_more_than_its_head():
    e = arrow(1, A, B)
    assert heads([e], [line(1, A, B - 4 * WAY, "vector")])[0].head == "unknown"


@pytest.mark.parametrize(("theirs", "head"), [(True, "absent"), (False, "reversed")])
def test_a_head_that_another_vector_on_the_same_line_has_there_is_not_taken_for_its_own(theirs, head):
    e = arrow(1, A, B)
    known = [e, arrow(2, B, A)] if theirs else [e]
    assert heads(known, [e], [OTHER])[0].head == head


@pytest.mark.parametrize("turn", [0.03, 0.06, 0.12])
def test_a_line_that_parts_from_another_is_no_head(turn):
    """It was drawn beside its place, and the tip of the vector is hidden among others."""
    e = arrow(1, A, B)
    known = [e, *(arrow(k, B - 20 * np.exp(1j * a), B) for k, a in enumerate((0.2, 0.9, 1.1), 2))]
    drawn = [*known, ray(5, turn)]
    assert heads(known, drawn, [(B, 0.2), (B, 0.9)])[0].head == "unknown"


@pytest.mark.parametrize(
    ("sides", "at", "head"),
    [
        ((), [], "absent"),
        ((1,), [], "absent"),  # another's stroke runs past: a head has two sides
        ((-1,), [], "absent"),
        ((1, -1), [], "unknown"),  # it may be a head drawn as an outline
        ((1,), [BACK], "there"),
        ((1,), [OTHER], "reversed"),
    ],
)
def test_ink_on_one_side_of_the_line_is_no_head(sides, at, head):
    e = arrow(1, A, B)
    past = [line(2, B + (-6 + 0.75j * k) * WAY, B + (3 + 0.75j * k) * WAY, "thin") for k in sides]
    assert heads([e], [e, *past], at)[0].head == head


@pytest.mark.parametrize(("at", "head"), [([OTHER], "reversed"), ([], "absent"), ([BACK], "there"), ([BACK, OTHER], "there")])
def test_lines_that_open_beyond_the_tip_are_no_head(at, head):
    e = arrow(1, A, B)
    beyond = [line(k, B, B + 5 * WAY * np.exp(1j * turn), "vector") for k, turn in enumerate((0.35, -0.35), 2)]
    assert heads([e], [e, *beyond], at)[0].head == head


def test_a_short_vector_is_not_looked_at():
    e = arrow(1, A, A + 8 * WAY)
    assert heads([e], [e])[0].head == "unknown"


@pytest.mark.parametrize(("others", "said"), [(3, "only a thin line here, and no arrow head"), (2, "no arrow head here")])
def test_of_a_vector_left_out_its_helper_line_is_seen(others, said):
    e, helper = arrow(1, A, B), line(2, A, B, "thin")
    sound = [arrow(k, A + 20j * k, B + 20j * k) for k in range(3, 3 + others)]
    found = heads([e, helper, *sound], [helper, *sound], [(s.points[1], BACK[1]) for s in sound])
    f = judge(found[0], 0.25, 0.15)
    assert (f.verdict, f.what) == ("amber", said)
    assert [t.head for t in found[2:]] == ["there"] * others


@pytest.mark.parametrize(("grey", "drawn", "head"), [
    (True, "thin", "left out"), (False, "thin", "left out"), (True, "vector", "there"), (False, "vector", "there")])  # fmt: skip
def test_in_black_and_white_a_helper_line_is_known_by_its_width_alone(grey, drawn, head):
    e, sound = arrow(1, A, B), [arrow(k, A + 20j * k, B + 20j * k) for k in range(3, 7)]
    stroke = line(2, A, B, drawn)
    standing = sound if drawn == "thin" else [e, *sound]
    found = heads([e, *sound], [stroke, *sound], [(s.points[1], BACK[1]) for s in standing], blur=0.12, grey=grey)
    assert [t.head for t in found] == [head, *["there"] * len(sound)]


@pytest.mark.parametrize(("positions", "short"), [(1, True), (24, False)])
def test_thin_lines_fade_in_the_hub_of_many_positions(positions, short):
    """Only where others are on both sides; a single one that stops short does so."""
    hub, lines, ink = 130 + 440j, [], paper()
    for k in range(positions):
        e = line(k + 1, hub, hub + 60 * np.exp(2j * np.pi * k / positions), "thin")
        lines.append(e)
        draw(ink, hub + (6 if k == 0 else 1) * (e.points[1] - hub) / 60, e.points[1], "thin")
    seen = Paper.of(lines, ink, np.zeros((HIGH, WIDE), bool))
    t = with_ends([InkTrace(lines[0], "measured", at=lines[0].points)], seen)[0]
    assert ("too short at its beginning" in judge(t, 0.25, 0.15).what) == short


@pytest.mark.parametrize(("at", "head"), [([OTHER], "reversed"), ([], "absent")])
@pytest.mark.parametrize("strokes", [(), ((2, 0.8, 4, 0.8),), ((2, 1.0, 4, 0.6), (4, 0.6, 2.5, 2)), ((3, 0.7, 3, 3),)])
def test_among_letters_only_a_whole_head_is_known(strokes, at, head):
    """Letters may stand all about the other end, and some stand close to the line."""
    e = arrow(1, A, B)
    drawn = [e, *(line(2, A + complex(a, b) * WAY, A + complex(c, d) * WAY, "thin") for a, b, c, d in strokes)]
    about = [A + 8 * z * WAY for z in (1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j)]
    found = heads([e], drawn, at, [about])[0].head
    assert found == head or (strokes and at and found == "absent")


@pytest.mark.parametrize(("dark", "head"), [(180, "there"), (100, "there"), (60, "unknown"), (0, "absent")])
def test_a_faint_head_is_not_missed(dark, head):
    e, ink = arrow(1, A, B), paper()
    fill_head(ink, *BACK)
    ink = (ink * (dark / 180)).astype(np.uint8)
    draw(ink, A, B, "vector")
    found = with_heads([InkTrace(e, "measured", at=e.points)], Paper.of([e], ink, np.zeros((HIGH, WIDE), bool)))
    assert found[0].head in (head, "unknown") if dark else found[0].head == head


def heads_of(known, at):
    """What is found of the vector's head when all is drawn that is known."""
    known = [arrow(1, A, B), *known]
    return heads(known, known, at)[0].head


@pytest.mark.parametrize(("at", "says"), [([OTHER], "reversed"), ([BACK], "there"), ([], "unknown")])
def test_a_head_at_the_other_end_is_told_though_little_is_seen_of_the_tip(at, says):
    """Another line crosses where the head would be, and others begin and end at both ends; the head there is seen as a whole."""
    across = line(2, B - 3.5 * WAY - 10j * WAY, B - 3.5 * WAY + 10j * WAY)
    known = [across, arrow(4, A + 30 * WAY * 1j, A), arrow(5, B, B + 20j * WAY)]
    assert heads_of(known, [*at, (A, BACK[1] - np.pi / 2)]) == says


@pytest.mark.parametrize(("at", "says"), [([OTHER], "reversed"), ([], "unknown")])
def test_a_line_with_a_gap_where_its_head_would_be_has_it_at_the_other_end(at, says):
    """Where it has none there either, the pencil may have been lifted, and nothing is told."""
    e = arrow(1, A, B)
    drawn = [line(1, A, B - 4.2 * WAY, "vector"), line(1, B - 2.8 * WAY, B, "vector")]
    assert heads([e, ray(2, 1.2, "main")], [*drawn, ray(2, 1.2, "main")], at)[0].head == says


@pytest.mark.parametrize("side", [-0.7, -1.0])
@pytest.mark.parametrize(("at", "said"), [([OTHER], True), ([], False)])
def test_one_side_of_a_head_is_enough_at_the_other_end(side, at, said):
    """A line runs close beside the vector at its beginning."""
    along = line(2, A - 8 * WAY + 1j * side * WAY, A + 12 * WAY + 1j * side * WAY, "vector")
    assert (heads_of([along], at) == "reversed") == said


@pytest.mark.parametrize("off", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("back", [-0.6, 0.0, 0.8])
def test_two_arrows_on_one_line_have_a_head_at_each_end(off, back):
    """A picture is not flat everywhere: both are a little off; of neither it is said that it points the other way."""
    known = [arrow(1, A, B), arrow(2, B, A)]
    by = 1j * off * WAY
    drawn = [line(1, A + by, B + by, "vector")]
    found = heads(known, drawn, [(B + by - back * WAY, BACK[1]), (A + by + back * WAY, OTHER[1])])
    assert all(t.head != "reversed" for t in found)


def test_a_head_seen_beside_its_line_is_not_missed():
    """The line was found beside where it is: all that is seen of its head stands to one side."""
    e = arrow(1, A, B)
    found = heads([e], [e], [(B + 0.45j * WAY, BACK[1])])
    assert found[0].head != "absent"


@pytest.mark.parametrize(
    ("at", "said"),
    [
        ([BACK], ["there", "there"]),
        ([BACK, OTHER], ["doubled", "doubled"]),  # either may be the one
        ([OTHER], ["reversed", "reversed"]),
        ([], ["absent", "absent"]),
    ],
)
@pytest.mark.parametrize("by", [0.0, 0.1])
def test_a_head_at_the_beginning_of_a_stroke_of_two_vectors_is_one_too_many(at, said, by):
    known = [arrow(1, A, B), arrow(2, A + by * WAY, B + by * WAY)]
    found = [t.head for t in heads(known, known, at)]
    # With nothing to be seen of its own tip no more is said of it.
    assert found == said or (at != [BACK, OTHER] and set(found) <= {*said, "unknown", "doubled" if at else "unknown"})


@pytest.mark.parametrize(
    ("at", "said"),
    [([BACK], "there"), ([BACK, OTHER], "doubled"), ([], "absent"), ([OTHER], "reversed")],
)
@pytest.mark.parametrize("blur", [0.0, 0.2, 0.3, 0.4])
def test_a_head_is_as_blurred_as_its_line(at, said, blur):
    """In a picture of three pixels a millimetre, where a head is broader, and darker than its line."""
    found = {t.head for t in heads([arrow(k, A, B) for k in (1, 2, 3)], [arrow(1, A, B)], at, blur=blur)}
    # In a sharp one what a hand has drawn too small and askew may tell nothing.
    assert found == {said} or (said != "doubled" and found <= {said, "doubled" if OTHER in at else said, "unknown"})


@pytest.mark.parametrize("blur", [0.3, 0.4])
@pytest.mark.parametrize(
    "beside", [[line(5, A + 1j * WAY, A + (5 + 1j) * WAY)], [line(5, A - 1j * WAY, A + (5 - 1j) * WAY, "thin")]]
)
def test_ink_on_one_side_of_a_blurred_line_is_no_head(beside, blur):
    known = [arrow(k, A, B) for k in (1, 2, 3)]
    assert {t.head for t in heads(known, [known[0], *beside], [BACK], blur=blur)} == {"there"}


@pytest.mark.parametrize("short", [12, 20])
def test_a_shorter_vector_of_the_stroke_that_has_its_head_is_not_asked(short):
    """Nor one beside which another is known to point the other way."""
    known = [arrow(1, A, B), arrow(2, A, B), arrow(3, A, A + short * WAY)]
    there = A + short * WAY, BACK[1]
    assert [t.head for t in heads(known, known, [BACK, OTHER, there])] == ["doubled", "doubled", "there"]
    assert [t.head for t in heads(known, known, [BACK, OTHER])] == ["unknown", "unknown", "reversed"]


@pytest.mark.parametrize("turn", [0.0, np.pi])
def test_a_head_that_belongs_at_the_beginning_is_none_too_many(turn):
    """Another vector ends there, on the stroke or on its other side."""
    known = [arrow(1, A, B), arrow(2, A, B), arrow(3, A + 20 * WAY * np.exp(1j * turn), A)]
    found = heads(known, known, [BACK, (A, float(np.angle(-WAY * np.exp(1j * turn))))])
    assert all(t.head in ("there", "unknown") for t in found)


@pytest.mark.parametrize(("at", "head"), [([BACK], "there"), ([], "absent"), ([OTHER], "reversed")])
def test_a_force_along_a_link_has_its_head_beyond_the_edges_of_the_link(at, head):
    link = line(2, A - 2 * WAY, B + 30 * WAY, "main")
    known = [arrow(1, A, B), link]
    assert heads(known, known, at)[0].head == head


@pytest.mark.parametrize(("wide", "head"), [(0, "absent"), (1.2, "unknown")])
def test_a_stroke_as_broad_as_a_head_hides_it(wide, head):
    e = arrow(1, A, B)
    beside = [line(2, A + 1j * off * WAY, B + 1j * off * WAY, "vector") for off in np.arange(-wide / 2, wide / 2 + 0.1, 0.3)]
    assert heads([e], [e, *beside], [])[0].head == head


@pytest.mark.parametrize(("deviation", "said"), [(0.0, "no arrow head here"), (3.0, "3.0 mm too far up")])
def test_of_a_vector_drawn_elsewhere_no_head_is_missed_in_its_place(deviation, said):
    e = arrow(1, 130 + 440j, 170 + 440j)
    t = InkTrace(e, "measured", shift=1j * deviation, deviation=deviation, at=e.points + 1j * deviation, head="absent")
    assert judge(t, 0.25, 0.15).what == said


SOUND = [arrow(k, A + 60 + 20j * (k - 12), B + 60 + 20j * (k - 12)) for k in (11, 12, 13)]
"""Vectors elsewhere, by which it is known how dark a vector is."""
THEIRS = [(e.points[1], BACK[1]) for e in SOUND]


@pytest.mark.parametrize("share", [0.0, 0.4, 0.6])
@pytest.mark.parametrize(("drawn", "head"), [((), "left out"), (("vector",), "there")])
def test_a_vector_left_out_is_known_though_a_shorter_one_covers_part_of_it(share, drawn, head):
    e, helper, shorter = arrow(1, A, B), line(2, A, B + 5 * WAY, "thin"), arrow(3, A, A + share * (B - A)) if share else SOUND[0]
    lines = [helper, shorter, *SOUND, *(line(1, A, B, style) for style in drawn)]
    at = [(shorter.points[1], BACK[1]), *THEIRS, *([BACK] if drawn else [])]
    assert heads([e, helper, shorter, *SOUND], lines, at)[0].head == head


@pytest.mark.parametrize(("by", "status"), [(0.3j, "measured"), (3j, "missing")])
def test_a_thin_line_elsewhere_is_not_the_vector_that_was_left_out(by, status):
    e, there = arrow(1, A, B), line(2, A + by * WAY, B + by * WAY, "thin")
    ink = paper()
    for k in (there, *SOUND):
        draw(ink, *k.points, k.style)
    for place, way in THEIRS:
        fill_head(ink, place, way)
    traces = [InkTrace(e, "measured", deviation=abs(by), at=there.points), *(InkTrace(k, "measured", at=k.points) for k in SOUND)]
    assert with_heads(traces, Paper.of((e, *SOUND), ink, np.zeros((HIGH, WIDE), bool)))[0].status == status


@pytest.mark.parametrize("aside", [1.1, 6.0])
@pytest.mark.parametrize(("off", "may_be"), [(None, ["absent"]), (0.0, ["there"]), (0.15, ["there"]), (0.3, ["there", "unknown"])])
def test_a_head_where_another_vector_hides_one_side(aside, off, may_be):
    """It may lie a little aside, on that side; where all of the other side is bare there is none."""
    e, other = arrow(1, A, B), arrow(2, B + aside * 1j * WAY, A + aside * 1j * WAY)
    at = [(other.points[1], BACK[1] + np.pi), *([] if off is None else [(BACK[0] + off * 1j * WAY, BACK[1])])]
    assert heads([e, other], [e, other], at)[0].head in may_be


def test_a_head_is_known_on_a_stroke_that_was_found_a_little_aside():
    """In a black-and-white picture all edges are upright, and as dark as the middle."""
    off = 0.3j * WAY
    e = arrow(1, A, B)
    assert heads([e], [arrow(1, A + off, B + off)], [(BACK[0] + off, BACK[1])])[0].head == "there"
    assert heads([e], [arrow(1, A + off, B + off)], [(OTHER[0] + off, OTHER[1])])[0].head == "reversed"


@pytest.mark.parametrize("off", [0.15, -0.15])
def test_a_force_found_aside_of_the_middle_of_its_link_is_missed(off):
    """Others whose heads are seen, thinner than the link, do not make its stroke a broad one."""
    link = line(2, A - 2 * WAY + off * 1j * WAY, B + 30 * WAY + off * 1j * WAY, "main")
    sound = [arrow(k, 190 + (420 + 10 * k) * 1j, 220 + (420 + 10 * k) * 1j) for k in (3, 4, 5)]
    known = [arrow(1, A, B), link, *sound]
    found = heads(known, known, [(complex(e.points[1]), 0.0) for e in sound])
    assert [t.head for t in found] == ["absent", "unknown", *["there"] * 3]


def test_a_head_is_missed_by_what_the_line_is_near_it():
    """A hand presses more here than there."""
    e = arrow(1, A, B)
    assert heads([e], [e, line(1, A + 0.6 * (B - A), B, "main")], [])[0].head == "absent"
