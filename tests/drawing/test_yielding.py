"""Thin lines are interrupted behind lettering, and are whole lines all the same."""

from math import nan, pi

import numpy as np
import pytest

from tests.labels import crossings
from tmm_sheets import catalogue
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink import interrupted, strokes
from tmm_sheets.drawing.marks import Arc, Drawing, Line, Polyline, Provenance, Text
from tmm_sheets.drawing.placing import interrupt
from tmm_sheets.drawing.text_layout import CLEAR
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

WORD = Text(100 + 50j, "H", 5.0)
"""Its ink reaches from x = 100 to 104 or so, y from 50 to 55."""


def yielded(*marks):
    canvas = Canvas(marks=[*marks])
    interrupt(canvas)
    return canvas.marks


def test_a_line_through_a_letter_has_a_gap_there():
    line = Line(50 + 52j, 150 + 52j, "thin", "view", Provenance("link", "a/b"))
    found, _ = yielded(line, WORD)
    assert found._replace(gaps=()) == line
    left, right = interrupted(found)
    assert (left.a, right.b, left.by, right.style) == (line.a, line.b, line.by, "thin")
    assert left.b.real < 100 + 1 < 103 < right.a.real
    assert right.a.real - left.b.real < 5 + 2 + 2 * CLEAR


@pytest.mark.parametrize("mark", [
    Line(50 + 52j, 150 + 52j, "main"),  # contours stay, labels keep off them
    Line(50 + 52j, 150 + 52j, "thin", "", Provenance("table")),
    Line(50 + 52j, 150 + 52j, "thin", "", Provenance("text")),  # a leader, a bar
    Line(50 + 60j, 150 + 60j, "thin"),
    Line(101 + 52j, 103 + 52j, "thin"),  # nothing would be left
    Line(100 + 52j, 105.5 + 52j, "thin"),  # too little would be
    Text(90 + 52j, "long lettering", 5.0),
    Polyline(np.array([50 + 60j, 150 + 60j]), "thin"),
    Line(101 + 52j, 101 + 52j, "thin"),  # of no length
    Polyline(np.array([101 + 52j, 101 + 52j, 101 + 52j]), "thin"),
    Arc(101 + 52j, 0.0, 0.0, 2 * pi, "thin"),
    Arc(101 + 52j, nan, 0.0, 2 * pi, "thin"),
    Line(complex(nan, 52), 150 + 52j, "thin"),
], ids=repr)  # fmt: skip
def test_what_stays(mark):
    assert yielded(mark, WORD)[0] is mark


def test_circles_and_curves_are_interrupted_too():
    circle = Arc(100 + 20j, 32.0, 0.0, 2 * pi, "centre")
    curve = Polyline(np.array([80 + 52j, 101 + 52j, 102 + 52.5j, 130 + 53j]), "thin")
    ring = Polyline(np.array([80 + 30j, 130 + 30j, 130 + 52j, 80 + 52j]), "thin", closed=True)
    for mark in yielded(circle, curve, ring, WORD)[:3]:
        (gap,) = mark.gaps
        assert 0 < gap[0] < gap[1] < 1
        pieces = interrupted(mark)
        assert len(pieces) == 2
        assert not any(piece.gaps for piece in pieces)
        assert not crossings(Drawing(200, 100, "", (mark, WORD)))


def test_a_turned_letter_hides_what_lies_under_it_alone():
    turned = WORD._replace(angle=pi / 2)
    over, beside = Line(50 + 52j, 150 + 52j, "thin"), Line(102 + 10j, 102 + 90j, "thin")
    a, b, _ = yielded(over, beside, turned)
    assert a.gaps
    assert a.gaps[0][1] * 100 + 50 <= 100 + CLEAR + 0.01
    assert not b.gaps


def test_nothing_to_yield_and_nothing_to_yield_to():
    assert yielded() == []
    line = Line(50 + 52j, 150 + 52j, "thin")
    assert yielded(line) == [line]
    assert yielded(WORD) == [WORD]
    assert yielded(line, WORD._replace(text=" ")) == [line, WORD._replace(text=" ")]


def test_a_line_that_a_curve_crosses_twice_has_two_gaps():
    bent = Polyline(np.array([50 + 52j, 150 + 52j, 150 + 54j, 50 + 54j]), "thin")
    mark, _ = yielded(bent, WORD)
    assert len(mark.gaps) == 2
    assert len(interrupted(mark)) == 3


def test_letters_at_both_ends_leave_the_middle():
    line, *_ = yielded(Line(100 + 52j, 154 + 52j, "thin"), WORD, WORD._replace(at=150 + 50j))
    assert line.gaps[0][0] == 0
    assert line.gaps[-1][1] == 1
    (middle,) = interrupted(line)
    assert 103 < middle.a.real < middle.b.real < 150


def test_letters_that_stand_close_make_one_gap():
    (line, *_) = yielded(Line(50 + 52j, 150 + 52j, "hatch"), WORD, WORD._replace(at=105 + 50j))
    assert len(line.gaps) == 1


def test_a_dashed_line_has_strokes_on_both_sides():
    line, _ = yielded(Line(20 + 52j, 180 + 52j, "centre"), WORD)
    found = list(strokes([line]))
    assert all(not 100 < z.real < 103 for stroke in found for z in (stroke.a, stroke.b))
    assert min(s.a.real for s in found) == 20
    assert max(s.b.real for s in found) == 180


@pytest.mark.parametrize(("name", "n"), [("sixbar/5:5", 1), ("lugansk/shaper", 3)])
def test_no_letter_of_a_sheet_is_crossed(name, n):
    drawing = composed(Project(catalogue.read(name)), n).drawing
    assert sum(bool(getattr(mark, "gaps", ())) for mark in drawing.marks) > 10
    assert [c for c in crossings(drawing) if c[1] != "main"] == []
