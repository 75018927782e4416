"""A label reads as what stands nearest: the judge on drawings of known answers, the placing on sheets."""

import pytest

from tests import labels as trial
from tmm_sheets import catalogue
from tmm_sheets.drawing import labels, owners
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.marks import Box, Line, Text, Trace
from tmm_sheets.project import Project

A, B = Trace("vector", "plan/a", "1", 0), Trace("vector", "plan/b", "1", 0)
"""Two vectors: 10 mm apart, level."""
LINES = [Line(0j, 60 + 0j, "vector", by=A), Line(10j, 60 + 10j, "vector", by=B)]


def reads(box, marks=LINES, anchor=30 + 0j, by=A):
    label = Label(anchor, "x", 3.5, by=by)
    return owners.Round(owners.Ink(marks), label, 60.0).reads(Box(*box))


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
    here = owners.Round(owners.Ink(canvas.marks), label, 60.0)
    assert here.reads(Box(2.2, -3, 6, 2)) == ""
    assert here.reads(Box(-2, 4, 2, 8)) == "crossed"


def test_the_leader_of_another_label_from_the_same_point_is_foreign():
    """A second letter beside the leader of the first is read as its letter, not the point's."""
    ink, label = owners.Ink([Line(0j, 40 + 0j, "main")]), Label(0j, "D", 5.0)
    beside = Box(-9.0, -9.0, -5.5, -5.0)
    assert owners.Round(ink, label, 60.0).reads(beside) == ""
    ink.add([Line(0j, -10 - 10j, "thin")])
    assert owners.Round(ink, label, 60.0).reads(beside) == "nearer"


def test_vectors_on_one_line_are_named_together():
    both = [Line(0j, 60 + 0j, "vector", by=A), Line(50 + 0.1j, 10 + 0.1j, "vector", by=B)]
    assert reads((28, 1, 32, 4), both) == ""
    assert reads((28, -4, 32, -1), both) == ""


def test_no_lines_at_all_and_a_leader_that_is_added():
    assert reads((28, 1, 32, 4), []) == ""
    ink = owners.Ink(LINES)
    ink.add([Line(30 + 5j, 30 + 1.2j, "thin")])
    here = owners.Round(ink, Label(40 + 0j, "x", 3.5, by=A), 60.0)
    assert here.reads(Box(31, 1.3, 35, 4.3)) == "nearer"


def test_a_leader_runs_along_no_line_and_crosses_no_strong_one():
    here = owners.Round(owners.Ink(LINES), Label(30 + 0j, "x", 3.5, by=A), 60.0)
    assert here.leads(30 + 0j, 34 - 8j)
    assert not here.leads(30 + 0j, 40 + 0.5j)
    assert not here.leads(30 + 0j, 32 + 12j)


def test_the_letter_moves_along_its_vector_before_it_gets_a_leader():
    canvas = Canvas()
    with canvas.traced("vector", "plan/a", "1", 0):
        canvas.line(100 + 100j, 180 + 100j, "vector")
    for k in range(9):  # a comb of lines about its middle
        canvas.line(complex(132 + 2 * k, 80), complex(132 + 2 * k, 99.5))
        canvas.line(complex(132 + 2 * k, 100.5), complex(132 + 2 * k, 120))
    with canvas.traced("text", "plan/a", "1", 0):
        canvas.label(140 + 100j, "a", 1j)
    first = len(canvas.marks)
    assert labels.place(canvas, Box(0, 0, 300, 200)) == []
    (text,) = canvas.marks[first:]
    assert isinstance(text, Text)
    assert abs(text.at.imag - 100) < 8
    assert not 128 < text.at.real < 152


@pytest.mark.parametrize("name", ["lugansk/shaper", "sixbar/6:3", "transport/press@07-ЭПС-7"])
def test_labels_of_sheets_read_rightly(name):
    project = Project(catalogue.read(name))
    for n in range(1, len(project.sheets) + 1):
        faults, count, _ = trial.judged(project, n)
        assert count > 10
        assert not faults
