"""A label reads as what stands nearest: the judge on drawings of known answers, the placing on sheets."""

import numpy as np
import pytest

from tests import labels as trial
from tests.few import seldom
from tmm_sheets import catalogue
from tmm_sheets.drawing import ink_index, labels, owners
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.marks import Box, Line, Provenance, Text
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import size, text_box
from tmm_sheets.project import Project

A, B = Provenance("vector", "plan/a", "1", 0), Provenance("vector", "plan/b", "1", 0)
"""Two vectors: 10 mm apart, level."""
LINES = [Line(0j, 60 + 0j, "vector", by=A), Line(10j, 60 + 10j, "vector", by=B)]


def placing(area, marks, *placements):
    """Labels in their places on a sheet of some marks."""
    placed = labels.PlacedLabels(ink_index.InkIndex(marks, area), [label for label, _, _ in placements])
    for k, placement in enumerate(placements):
        placed.put(k, labels.Placement(*placement))
    return placed


def reads(box, marks=LINES, anchor=30 + 0j, by=A):
    label = Label(anchor, "x", 3.5, by=by)
    return owners.Surroundings(ink_index.InkIndex(marks), label, 60.0).misreading(Box(*box))


@pytest.mark.parametrize(("box", "said"), [
    ((28, 1, 32, 4), ""),            # beside its own vector
    ((28, 4.6, 32, 8.6), "nearer"),  # between both, nearer to the other one
    ((28, 3.0, 32, 7.0), ""),        # half way: a tie is no fault
    ((28, 11, 32, 14), "crossed"),   # beyond the other one
    ((2, 1, 6, 4), ""),              # anywhere along it
    ((28, -9, 32, -6), ""),          # far, but nothing else is nearer
    ((61, -2, 65, 2), ""),           # beyond its end
])  # fmt: skip
def test_the_nearest_line_is_the_one_named(box, said):
    assert reads(box) == said


def test_a_letter_at_a_point_belongs_to_all_lines_that_meet_there():
    star = [Line(0j, z, "main") for z in (40 + 0j, 40j, -40 + 0j, -40j)]
    assert reads((2, 2, 6, 5), star, 0j, None) == ""
    assert reads((2, 2, 6, 5), [*star, Line(-5 + 1.5j, 30 + 1.5j, "thin")], 0j, None) == "crossed"


def test_a_symbol_about_the_anchor_is_its_own():
    canvas = Canvas()
    canvas.circle(0j, 1.5, "main")
    canvas.line(3j - 30, 3j + 30)
    label = Label(0j, "A", 5.0, gap=2.5)
    here = owners.Surroundings(ink_index.InkIndex(canvas.marks), label, 60.0)
    assert here.misreading(Box(2.2, -3, 6, 2)) == ""
    assert here.misreading(Box(-2, 4, 2, 8)) == "crossed"


def test_the_leader_of_another_label_from_the_same_point_is_foreign():
    """A second letter beside the leader of the first is read as its letter, not the point's."""
    ink, label = ink_index.InkIndex([Line(0j, 40 + 0j, "main")]), Label(0j, "D", 5.0)
    beside = Box(-9.0, -9.0, -5.5, -5.0)
    assert owners.Surroundings(ink, label, 60.0).misreading(beside) == ""
    ink.set_leaders([0j], [-10 - 10j])
    assert owners.Surroundings(ink, label, 60.0).misreading(beside) == "nearer"


def test_ink_half_way_between_two_vectors_is_vague_however_near_a_corner_of_its_box_is():
    """The upper right corner of a name with an index is empty: the index stands lower."""
    here = owners.Surroundings(ink_index.InkIndex(LINES), Label(30 + 0j, "F_{21}", 3.5, by=A), 60.0)
    wide, high = size("F_{21}", 3.5)
    for low, vague in ((0.6, False), (5.0 - high / 2, True), (9.4 - high, True), (-0.6 - high, False)):
        assert (here.judge(np.array([[28.0], [low], [28.0 + wide], [low + high]]))[1][0] > 0) == vague


def test_names_of_two_vectors_that_cross_stand_at_their_own():
    canvas, ends = Canvas(), ((0j, 60j), (12 + 0j, -8 + 60j))
    for (a, b), by in zip(ends, (A, B), strict=True):
        canvas.marks.append(Line(a, b, "vector", by=by))
        canvas.tracing(*by).label((a + b) / 2, "F_{21}", 1.0)
    assert place(canvas, Box(-100, -100, 100, 100)) == []
    a, b = np.array(ends).T
    for own, name in enumerate(m for m in canvas.marks if isinstance(m, Text) and m.text == "F"):
        corners = text_box(name)
        off = np.array([ink_index.distance(a, b, z) for z in corners]).min(axis=0)
        assert off[own] + 0.5 < off[1 - own]


def test_vectors_on_one_line_are_named_together():
    both = [Line(0j, 60 + 0j, "vector", by=A), Line(50 + 0.1j, 10 + 0.1j, "vector", by=B)]
    assert reads((28, 1, 32, 4), both) == ""
    assert reads((28, -4, 32, -1), both) == ""


def test_a_leader_that_ends_where_two_vectors_run_together_might_name_either():
    both = [Line(0j, 60 + 0j, "vector", by=A), Line(0.1j, 30 + 0.1j, "vector", by=B), Line(0.5j, 10 + 0.5j, "thin")]
    here = owners.Surroundings(ink_index.InkIndex(both), Label(20 + 0j, "x", 3.5, by=A), 60.0)
    assert here.count_unsure(np.array([5 + 0j, 20 + 0j, 40 + 0j])).tolist() == [1, 1, 0]


@pytest.mark.parametrize("length", [2.0, 8.0, 60.0])
def test_a_vector_has_its_name_anywhere_along_it_to_the_tip_of_its_own_head(length):
    canvas = Canvas()
    for name, tail in (("p–b", 0j), ("a–b", length + 40j)):
        canvas.tracing("vector", "plan/b", "1", 0, name).arrow(tail, length + 0j, "vector")
    label = Label(length / 2 + 0j, "x", 3.5, by=Provenance("text", "plan/b", "1", 0))
    here = owners.Surroundings(ink_index.InkIndex(canvas.marks), label, 60.0)
    places = np.array([label.anchor, *here.places_along()])
    assert (places.real.min(), places.real.max()) == pytest.approx((0.05 * length, 0.95 * length))
    assert {canvas.marks[n].by.name for n in here.of[here.own]} == {"p–b"}


def test_no_lines_at_all_and_a_leader_that_is_added():
    assert reads((28, 1, 32, 4), []) == ""
    ink = ink_index.InkIndex(LINES)
    ink.set_leaders([30 + 5j], [30 + 1.2j])
    here = owners.Surroundings(ink, Label(40 + 0j, "x", 3.5, by=A), 60.0)
    assert here.misreading(Box(31, 1.3, 35, 4.3)) == "nearer"


def test_a_leader_runs_along_no_line_and_crosses_no_strong_one():
    here = owners.Surroundings(ink_index.InkIndex(LINES), Label(30 + 0j, "x", 3.5, by=A), 60.0)
    assert here.count_crossed(np.array([30 + 0j]), np.array([34 - 8j]))[0] == 0
    assert here.count_crossed(np.array([30 + 0j]), np.array([40 + 0.5j]))[0] == 1
    assert here.count_crossed(np.array([30 + 0j]), np.array([32 + 12j]))[0] == 1


def test_a_leader_crosses_no_other_leader():
    ink = ink_index.InkIndex(LINES)
    ink.set_leaders([28 - 3j, 28 + 3j], [36 - 3j, 26 + 3j])
    here = owners.Surroundings(ink, Label(30 + 0j, "x", 3.5, by=A), 60.0)
    assert here.count_crossed(np.array([30 + 0j]), np.array([34 - 8j]))[0] == owners.LED
    assert here.count_crossed(np.array([30 + 0j]), np.array([24 - 8j]))[0] == 0


def hemmed(texts):
    """A point in a thicket, with only one way out to either side, and lettering about it; label, leader."""
    canvas = Canvas()
    for k in range(-12, 13):
        canvas.line(complex(150 + k, 90), complex(150 + k, 98), "main")
        canvas.line(complex(150 + k, 102), complex(150 + k, 110), "main")
    for at, text in texts:
        canvas.text(at, text, 2.5)
    canvas.label(150 + 100j, "s", 1, 3.5)
    first = len(canvas.marks)
    assert place(canvas, Box(0, 0, 300, 200)) == []
    return canvas.marks[first:]


def test_a_leader_runs_over_no_lettering():
    free, *leader = hemmed([])
    assert free.at.real > 160
    assert leader
    other, *leader = hemmed([(156 + 99j, "m")])
    assert leader
    assert other.at.real < 145


@pytest.mark.parametrize(("a", "b", "over"), [
    (0j, 40 + 40j, 1),                   # through the corner, by 0.1 mm
    (0.3 + 0j, 40.3 + 40j, 0),           # past it
    (10 + 19.95j, 10 + 19.95j, 1),       # a point inside
    (20 + 10j, 20 + 30j, 0),             # beside
    (0j, 5 + 5j, 0),                     # ends before it
])  # fmt: skip
def test_lettering_under_a_leader_is_seen_however_little(a, b, over):
    boxes = labels.np.array([(8.0, 19.9, 19.95, 30.0), (float("nan"),) * 4])
    assert ink_index.enters(a, b - a, *boxes.T).sum() == over


@pytest.mark.parametrize(("by", "moves"), [("construction", True), ("text", False)])
def test_the_letter_of_an_arm_moves_along_it_and_that_of_a_point_does_not(by, moves):
    """Lettering of a construction line's own role names the line; other lettering names the point it was asked for."""
    canvas = Canvas()
    canvas.tracing("construction", "plan/h", "1", 0).line(100 + 100j, 180 + 100j)
    ink, label = ink_index.InkIndex(canvas.marks), Label(140 + 100j, "h", 2.5, by=Provenance(by, "plan/h", "1", 0))
    assert bool(owners.Surroundings(ink, label, 60.0).places_along()) is moves


@pytest.mark.parametrize("room", [True, False])
def test_a_label_takes_another_place_that_leaves_room_for_the_other(room):
    canvas = Canvas()
    canvas.label(100 + 100j, "1", 1j, 3.5)
    canvas.label(104 + 100j, "1000", 1j, 3.5)
    marks = [] if room else [Line(complex(60, y), complex(150, y), "main") for y in range(60, 160, 2)]
    boxes = Box(119, 120, 121, 123.5), Box(78, 120, 87, 123.5)
    placed = placing(Box(0, 0, 300, 200), marks, *((label, box, True) for label, box in zip(canvas.labels, boxes, strict=True)))
    before = list(placed.at)
    assert placed.count_faults(0) == 1
    assert placed.set_alone(0) is room
    assert (placed.at == before) is not room
    assert placed.count_faults(0) == (0 if room else 1)


def test_letters_of_two_things_are_not_read_as_one_word():
    """Beside 12 a point has its letter on the other side, or under it: 127 would be another thing."""
    canvas = Canvas()
    canvas.text(99 + 98.8j, "12", 3.5, "right")
    canvas.label(100 + 100j, "7", 0.2, 3.5, 0.5)
    canvas.label(100 + 100j, "8", -1, 3.5, 0.5)
    first = len(canvas.marks)
    assert place(canvas, Box(0, 0, 300, 200)) == []
    boxes = [text_box(mark) for mark in canvas.marks[first:]]
    for z, other in ((boxes[0], boxes[1]), (boxes[1], boxes[0])):
        level = z.imag.min() < other.imag.max() and other.imag.min() < z.imag.max()
        assert not level or abs(z.real.mean() - other.real.mean()) > 3.5
    assert not (boxes[1].real.min() < 101 and 97 < boxes[1].imag.mean() < 103)


@pytest.mark.parametrize("lines", [[], [Line(150 + 100j, 190 + 140j, "vector")]])
def test_a_label_with_a_shelf_stands_on_it_and_is_led_from_the_edge_of_what_it_names(lines):
    canvas = Canvas()
    canvas.marks += lines
    canvas.label(150 + 100j, "I", 1 + 1j, 5.0, 5.0, shelf=3.0)
    first = len(canvas.marks)
    assert place(canvas, Box(0, 0, 300, 200)) == []
    text, leader, shelf = canvas.marks[first:]
    assert abs(leader.a - (150 + 100j)) == pytest.approx(3.0)
    assert leader.b in (shelf.a, shelf.b)
    assert shelf.a.imag == shelf.b.imag == pytest.approx(text.at.imag - labels.SHELF)


def test_the_letter_moves_along_its_vector_before_it_gets_a_leader():
    canvas = Canvas()
    canvas.tracing("vector", "plan/a", "1", 0).line(100 + 100j, 180 + 100j, "vector")
    for k in range(9):  # a comb of lines about its middle
        canvas.line(complex(132 + 2 * k, 80), complex(132 + 2 * k, 99.5))
        canvas.line(complex(132 + 2 * k, 100.5), complex(132 + 2 * k, 120))
    canvas.tracing("text", "plan/a", "1", 0).label(140 + 100j, "a", 1j)
    first = len(canvas.marks)
    assert place(canvas, Box(0, 0, 300, 200)) == []
    (text,) = canvas.marks[first:]
    assert isinstance(text, Text)
    assert abs(text.at.imag - 100) < 8
    assert not 128 < text.at.real < 152


@pytest.mark.parametrize("name", ["lugansk/shaper", seldom("sixbar/6:3"), seldom("transport/press@07-ЭПС-7")])
def test_labels_of_sheets_read_rightly(name):
    project = Project(catalogue.read(name))
    for n in range(1, len(project.sheets) + 1):
        faults, count, *_ = trial.judged(project, n)
        assert count > 10
        assert not faults


def test_leaders_that_cross_change_places():
    """Of two labels that stand each beyond the other's point one gets the place it would have alone, the other what is left."""
    canvas = Canvas()
    for x in (100, 104):
        canvas.label(complex(x, 100), "12", 1j, 3.5)
    left, right = Box(80, 120, 86, 123.5), Box(118, 120, 124, 123.5)
    placed = placing(Box(0, 0, 300, 200), [], (canvas.labels[0], right, True), (canvas.labels[1], left, True))
    assert placed.count_faults(0) == placed.count_faults(1) == 1
    assert placed.in_conflict(0) == [1]
    assert placed.set_alone(0)
    assert placed.count_faults(0) == placed.count_faults(1) == 0
    # Once they stand well they are left alone.
    before = list(placed.at)
    assert not placed.set_alone(0)
    assert placed.at == before


def test_labels_change_places_only_where_both_have_room():
    canvas = Canvas()
    canvas.label(100 + 100j, "1", 1j, 3.5)
    canvas.label(104 + 100j, "1000", 1j, 3.5)
    canvas.line(123 + 110j, 123 + 130j, "main")  # beside the short one: the long one has no room there
    boxes = Box(119, 120, 121, 123.5), Box(78, 120, 87, 123.5)
    pairs = zip(canvas.labels, boxes, strict=True)
    placed = placing(Box(0, 0, 300, 200), canvas.marks, *((label, box, True) for label, box in pairs))
    assert placed.set_alone(0)
    assert placed.at[1].box != boxes[0]
    for each in placed.at:
        assert each.free
        assert placed.are_clear(np.array(each.box)[:, None])[0]


def fan_of(lines):
    """Vectors with their heads, of the plan's steps 0, 1 .., on a canvas."""
    canvas = Canvas()
    for k, (a, b) in enumerate(lines):
        canvas.tracing("vector", f"plan/{k}", "1", 0).arrow(a, b, "vector")
    return canvas


@pytest.mark.parametrize("beside", [0.25, 0.45, 5.0])
@pytest.mark.parametrize("side", [1, -1])
def test_a_leader_to_lines_that_are_nearly_one_ends_in_the_head_of_its_own(beside, side):
    """Where letters have no room beside the vector an eye that comes along the leader meets its head before the other line."""
    canvas = fan_of([(100 + 100j, 112 + 100j), (100 + 100j, complex(150, 100 + side * beside * 50 / 12))])
    for y in (98.5, 101.5):
        canvas.line(complex(96, y), complex(118, y), "thin")
    canvas.tracing("text", "plan/0", "1", 0).label(106 + 100j, "F", -1j * side)
    ink = ink_index.InkIndex(canvas.marks, Box(0, 0, 300, 200))
    placed = labels.PlacedLabels(ink, canvas.labels)
    placed.place_all()
    assert placed.count_faults(0) == 0
    (at,) = placed.at
    here = labels.surroundings(ink, at.label)
    if beside > 1.0:  # far enough apart: it has its name beside it
        assert not here.unsure
        return
    assert labels.leader_to(at.label, at.box) is not None
    assert here.unsure
    assert here.head is not None
    other, *_ = (m for m in canvas.marks if isinstance(m, Line) and m.by is not None and m.by.step == "plan/1")
    met = here.first_met(np.array([at.label.anchor]), np.array([at.box.nearest(at.label.anchor)]))
    assert ink_index.distance(np.array([other.a]), np.array([other.b]), met)[0] >= owners.UNSURE - 1e-9


@pytest.mark.parametrize("angle", [8.0, 14.0, 40.0])
@pytest.mark.parametrize("side", [1, -1])
def test_the_proof_finds_names_exchanged_though_heads_at_one_point_overlap(angle, side):
    """Two vectors end at one point, so that one's head may lie over the other's; each name stands at the other or at its own."""
    turns = 0.0, np.radians(side * angle)
    canvas = fan_of([(130 - 30 * np.exp(1j * turn) + 100j, 130 + 100j) for turn in turns])
    ink, (wide, high) = ink_index.InkIndex(canvas.marks), size("F", 3.5)
    for own, turn in enumerate(turns):
        for at, outward in ((0, side), (1, -side)):
            along = np.exp(1j * turns[at])
            corner = 130 + 100j - 9 * along + outward * (2.5 + high / 2) * 1j * along - complex(wide, high) / 2
            anchor = 130 + 100j - 9 * np.exp(1j * turn)
            label = Label(anchor, "F", 3.5, of="", by=Provenance("text", f"plan/{own}", "1", 0))
            box = Box(corner.real, corner.imag, corner.real + wide, corner.imag + high)
            assert bool(trial._of_another(trial.Placed(label, box, []), ink)) is (at != own)


@pytest.mark.parametrize(("ends", "alone"), [
    ([(40, 0), (36, 0.05)], 0.95),          # beyond the end of one that runs along it
    ([(40, 0), (40, 2)], 0.85),             # at the wide end of a fan, before the head of the other
    ([(2, 0), (1.2, 3), (0.8, 3)], 0.5),    # between two at the ends of a short one
])  # fmt: skip
@pytest.mark.parametrize("turn", [1, 1j, -1])
def test_a_name_may_stand_where_its_vector_is_most_alone(ends, alone, turn):
    tails = [0, 0, 2]
    canvas = fan_of([(100 + 100j + turn * tail, 100 + 100j + turn * complex(*end)) for tail, end in zip(tails, ends, strict=False)])
    (x, y), by = ends[0], Provenance("text", "plan/0", "1", 0)
    label = Label(100 + 100j + turn * complex(x, y) * (0.2 if alone > 0.5 else 0.35), "x", 3.5, by=by)
    here = owners.Surroundings(ink_index.InkIndex(canvas.marks), label, 60.0)
    assert here.unsure
    assert ((here.places_along()[-1] - 100 - 100j) / turn / complex(x, y)).real == pytest.approx(alone, abs=0.02)


@pytest.mark.parametrize("others", [0, 1, 2])
def test_a_name_stands_where_its_vector_is_alone_and_what_stood_there_makes_room(others):
    """Two vectors are one for half the way; on the other half, where the longer one is alone, points have their letters."""
    canvas = fan_of([(100 + 100j, 140 + 100j), (118 + 100.1j, 140 + 100j)])
    for x in (103, 110)[:others]:
        canvas.label(complex(x, 100), "123", 1j, 3.5)
        canvas.label(complex(x, 100), "456", -1j, 3.5)
    canvas.tracing("text", "plan/0", "1", 0).label(130 + 100j, "F", 1j)
    placed = labels.PlacedLabels(ink_index.InkIndex(canvas.marks, Box(0, 0, 300, 200)), canvas.labels)
    placed.place_all()
    for around in (labels.USUAL, labels.CLOSER):
        for k in range(len(canvas.labels)):
            placed.improve(k, around)
    assert placed.count_faults(*range(len(canvas.labels))) == 0
    assert placed.at[-1].label.anchor.real < 118


def test_a_label_keeps_to_the_place_of_its_view():
    """Beside the end of an axis stands the next column: the letter goes over or under it."""
    canvas = Canvas()
    canvas.begin(Box(0, 0, 110, 200))
    canvas.label(106 + 100j, "abc", 1, 3.5)
    assert place(canvas, Box(0, 0, 300, 200)) == []
    (text,) = (mark for mark in canvas.marks if isinstance(mark, Text))
    assert text_box(text).real.max() <= 110


def test_a_window_parts_no_label_from_what_it_names():
    """In a circle between the point and its letter: an enlarged detail's is looked through, any other is a line."""
    for draw, free in ((Canvas.window, True), (Canvas.circle, False)):
        canvas = Canvas()
        draw(canvas.tracing("vector", "plan/a", "1", 0), 100 + 100j, 1.5)
        marks = [m for n, m in enumerate(canvas.marks) if n not in canvas.windows]
        assert (not marks) is free


@pytest.mark.parametrize(("shelf", "end", "ill"), [
    (2.0, 80 + 60j, 1),  # through the shelf, under the letters
    (0.0, 80 + 60j, 0),  # letters without one
    (2.0, 80 + 56j, 0),  # under both
    (2.0, 80 + 66j, 1),  # through the letters
])  # fmt: skip
def test_the_shelf_of_a_name_is_part_of_it(shelf, end, ill):
    detail = Label(65 + 80j, "II", 5.0, shelf=shelf), Box(60.0, 60.0 - labels.SHELF * bool(shelf), 70.0, 65.0), True
    number = Label(50 + 58j, "3, 4", 2.5), Box(end.real, end.imag, end.real + 5, end.imag + 2.5), True
    placed = placing(Box(0.0, 0.0, 100.0, 100.0), [], detail, number)
    assert min(placed.count_faults(1), 1) == ill
    assert (0 in placed.in_conflict(1)) is bool(ill)


@pytest.mark.parametrize(("angles", "anchor"), [
    ((0.0,), 4 + 0j),                      # alone
    ((0.0, 3.0), 4 + 0j),                  # two that can hardly be told apart where the name stands
    ((0.0, 3.0, -3.0), 4 + 0j),            # between two
    ((0.0, 0.0, 3.0), 4 + 0j),             # one on the other
    ((0.0, 3.0, 6.0, 9.0, 12.0), 3 + 0j),  # a fan, at its tail
    ((0.0, 40.0), 9 + 0j),                 # far enough apart
])  # fmt: skip
@pytest.mark.parametrize("crowd", [False, True])
def test_no_place_that_was_not_judged_is_better(angles, anchor, crowd):
    """What bounds leave out, judged all the same: cheapest of all, or the cheapest with nothing wrong but the spot itself."""
    fan = [Line(0j, 10 * np.exp(1j * np.radians(a)), "vector", by=Provenance("vector", f"plan/{k}", "1", 0))
           for k, a in enumerate(angles)]
    wall = [Line(-30 + y * 1j, 40 + y * 1j, "main") for y in range(-21, 22, 6)] if crowd else []
    label = Label(anchor, "F_{21}", 3.5, by=fan[0].by)
    placed = labels.PlacedLabels(ink_index.InkIndex([*fan, *wall], Box(-60, -60, 60, 60)), [label])
    places = labels.Places(placed, label, *labels.candidate_places(placed, [label]))
    here = labels.surroundings(placed.ink, label)
    k, fault = places.choose(here)
    every = dict(zip(places.free.tolist(), places.faults(here, places.free.tolist()), strict=True))
    led = labels.CROSSING * owners.LED if here.head is None else labels.IN_HEAD
    spot = {n: here.unsure * (led if places.led[n] else labels.VAGUE * owners.SPOT) for n in every}
    assert (here.unsure > 0) == (len(angles) >= 2 and max(angles) < 40)
    assert all(every[n] >= spot[n] - 1e-9 for n in every)
    assert fault == every[k]
    sound = [n for n in every if every[n] <= spot[n]]
    if fault <= spot[k]:
        assert all(places.cost[k] <= places.cost[n] or places.cost[n] + spot[n] >= places.cost[k] + fault for n in sound)
    elif here.unsure:
        assert places.cost[k] + fault <= min(places.cost[n] + every[n] for n in every) + 1e-9
