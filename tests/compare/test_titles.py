"""Titles in drawings: what they name, in whosever words, and whose ink stands under them."""

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, DrawnStroke, Writing
from tmm_sheets.compare.cad.titles import DrawnTitle, Titles, in_common, likeness, namesakes
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.drawing.marks import Provenance

NAMES = ("Планы положений механизма", "План скоростей, положение 2", "План скоростей, положение 12", "План ускорений (положение 2)",
         "План сил группы 2–3", "План сил звена 1", "План скоростей, положение 1′, 9")
VIEWS = tuple(ElementView(n, name, Box(0, 0, 1, 1)) for n, name in enumerate(NAMES, 1))


def drawing(lines, writings=()):
    """A drawing of lines and texts (text, left end of its base line)."""
    strokes = tuple(DrawnStroke(np.array(z), k) for k, z in enumerate(lines))
    width = 3.1
    return DrawingSpace("", strokes, (), tuple(
        Writing(text, at + complex(width * len(text) / 2, 2.5), 5.0, width * len(text), 0.0, 0) for text, at in writings), ())


def titles(lines=(), writings=()):
    """Of a sheet whose first view shows positions 2 and 5."""
    links = [Element(k, VIEWS[0], "", "line", np.array([0j, 1 + 0j]), "main", by=Provenance("link", position=p))
             for k, p in enumerate("25")]
    return Titles(links, VIEWS, drawing(lines, writings))


def named(text):
    return {NAMES.index(v.name) for t in titles(writings=[(text, 0j)]).titles for v in t.names}


@pytest.mark.parametrize(("text", "views"), [
    ("План скоростей, положение 2", {1}), ("ПЛАН СКОРОСТЕЙ ПОЛ. 2", {1}), ("План скоростей для положения № 12", {2}),
    ("План скоростей (пол.12)", {2}), ("План скоростей", {1, 2, 6}), ("План скоростей 9", {6}), ("План скоростей 1'", {6}),
    ("План скоростей, положение 7", set()), ("План ускорений", {3}), ("план уск. пол. 2", {3}),
    ("План ускорений, положение 3", set()), ("План положений механизма", {0}), ("Планы положений", {0}),
    ("План механизма, положение 5", {0}), ("План положений, положение 2", {0}),
    ("План положений, положение 3", set()), ("План сил группы 2-3", {4}), ("План сил звена 1", {5}), ("План сил звена 4", set()),
    ("Положение 12", {2}), ("Положение 2", {0, 1, 3}), ("Масштаб 1:2", set()), ("Курсовой проект", set()), ("Лист 2", set())])
def test_what_a_title_names(text, views):
    assert named(text) == views


def test_a_position_is_no_word_beside_its_number():
    assert DrawnTitle.of("План скоростей, положение 2") == DrawnTitle(frozenset({"план", "скор"}), frozenset({"2"}), True)
    assert DrawnTitle.of("Планы положений механизма").words == {"план", "поло", "меха"}
    assert DrawnTitle.of("position 3").numbers == {"3"}
    assert DrawnTitle.of("") == DrawnTitle(frozenset(), frozenset())
    assert likeness(DrawnTitle.of("План сил"), DrawnTitle.of("")) == 0


def test_namesakes_differ_in_their_numbers_only():
    own = DrawnTitle.of("План скоростей, положение 2")
    assert namesakes(own, DrawnTitle.of("План скоростей, положение 3"))
    assert namesakes(own, DrawnTitle.of("Положение 3"))
    assert not namesakes(own, DrawnTitle.of("Положение 2"))
    assert not namesakes(own, DrawnTitle.of("План сил звена"))
    assert in_common(own, DrawnTitle.of("Положение 3")) == 1


LEFT, RIGHT = [[0, 40 + 10j], [40 + 10j, 20 + 30j]], [[100, 140 + 5j], [120 + 2.5j, 120 + 60j]]


def under(made):
    """For each stroke, the numbers of the views its title names; None where it has none."""
    return [{NAMES.index(v.name) for t in made.over[f] for v in t.names} if f in made.over else None for f in made.figures.tolist()]


@pytest.mark.parametrize(("writings", "said"), [
    ([("План ускорений", 2 + 35j)], [{3}, {3}, None, None]),
    ([("План ускорений", 2 - 20j)], [{3}, {3}, None, None]),  # below
    ([("План ускорений", 100 + 66j), ("План положений", 40j)], [{0}, {0}, {3}, {3}]),
    ([("План ускорений", 100 + 66j), ("Положение 2", 98 + 78j)], [None, None, {0, 1, 3}, {0, 1, 3}]),
    ([("План ускорений", 500 + 500j)], [None] * 4), ([], [None] * 4),
    ([("План ускорений", 48 + 25j)], [None] * 4)])  # between both
def test_a_title_belongs_to_the_figure_it_is_over(writings, said):
    made = titles(LEFT + RIGHT, writings)
    assert under(made) == said
    of = made.of(VIEWS[3])
    assert (of is None) == all(x is None or 3 not in x for x in said)
    may = made.may_be(VIEWS[1], {})
    assert [may is None or bool(m) for m in (range(4) if may is None else may)] == [x is None or 1 in x for x in said]


def test_a_title_of_a_view_that_was_found_is_that_of_its_figure():
    """The title of the figure below is nearer to this one, which has none."""
    made = titles(LEFT + RIGHT, [("План ускорений", 2 + 35j)])
    assert made.may_be(VIEWS[1], {}).tolist() == [False, False, True, True]
    assert made.may_be(VIEWS[1], {VIEWS[3]: made.at(np.array([100 + 0j]), 0.3)}) is None
    assert made.may_be(VIEWS[1], {VIEWS[3]: made.at(np.array([0j]), 0.3)}).tolist() == [False, False, True, True]
    assert made.at(np.array([500j]), 0.3) == frozenset()


def test_a_frame_is_no_figure_and_has_no_title():
    corners = [-60 - 60j, 300 - 60j, 300 + 200j, -60 + 200j]
    frame = [[a, b] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    made = titles(frame + LEFT, [("План ускорений", 2 + 35j)])
    assert made.figures.tolist() == [-1, -1, -1, -1, 4, 4]
    assert under(made)[4:] == [{3}, {3}]
    assert made.share == 1
    assert titles(frame, [("План ускорений", 2 + 35j)]).share == 0


def test_lines_that_come_near_are_one_figure():
    assert titles([[0, 10], [12, 20], [30, 40], [10 + 1j, 10 + 9j]]).figures.tolist() == [0, 0, 2, 0]
    assert titles().figures.tolist() == []
