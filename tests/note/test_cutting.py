"""What of a view is shown: whole where it can be read, else a window whose edge is drawn; no line ends outside."""

from math import pi

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.drawing.marks import Arc, Line, Polyline, Provenance, Text, flat
from tmm_sheets.note.pictures import LETTERS, READABLE, SMALLEST, bare, scale, windowed

BOX = Box(0, 0, 100, 50)


@pytest.mark.parametrize("mark", [
    Line(-50 + 10j, 150 + 40j, "main"),
    Arc(50 + 25j, 40, 0.0, 2 * pi, "thin"),
    Arc(0j, 30, -1.0, 4.0, "thin"),
    Polyline(np.array([-10 + 5j, 50 + 60j, 110 + 5j]), "main", True),
])  # fmt: skip
def test_lines_end_at_the_window_and_stay_where_they_were(mark):
    parts = windowed([mark], BOX)
    assert parts
    whole = flat(mark, 0.01)
    for part in parts:
        points, a, d = flat(part, 0.5), whole[:-1], np.diff(whole)
        assert all(BOX.contains(complex(z), 1e-9) for z in points)
        for z in points[[0, -1]]:  # they lie on the mark
            t = np.clip(((z - a) * d.conj()).real / np.abs(d) ** 2, 0, 1)
            assert np.abs(z - a - t * d).min() < 1e-3


def test_as_long_as_what_was_inside():
    """Of the circle of radius 40 about the middle of 100 x 50 two arcs are in the window: 4 asin(25/40) of a turn of 2 pi."""
    parts = windowed([Arc(50 + 25j, 40, 0.3, 0.3 + 2 * pi, "thin")], BOX)
    assert sum(p.end - p.start for p in parts) == pytest.approx(4 * np.arcsin(25 / 40))


def test_letters_are_in_the_window_or_not_shown():
    inside, across = Text(20 + 20j, "AB", 3.5), Text(97 + 20j, "AB", 3.5)
    assert windowed([inside, across], BOX) == [inside]


def test_tables_titles_and_remarks_are_not_part_of_a_drawing():
    drawing = [Line(0j, 100 + 50j, "main"), Text(50 + 52j, "1", 3.5)]
    table = [Line(200 + 0j, 250 + 0j, "main", by=Provenance("table")), Line(200 + 30j, 250 + 30j, "main", by=Provenance("table"))]
    cell, title = Text(210 + 10j, "12", 3.5), Text(20 + 90j, "Title", 5.0)
    assert bare([*drawing, *table, cell, title]) == drawing
    assert bare([title]) == [title]


@pytest.mark.parametrize(("width", "height", "turned", "least"), [
    (200, 200, False, READABLE), (400, 200, True, READABLE), (320, 430, False, READABLE), (345, 448, False, SMALLEST),
])  # fmt: skip
def test_a_page_is_filled_before_a_view_is_cut(width, height, turned, least):
    factor, is_turned = scale(Box(0, 0, width, height))
    assert is_turned is turned
    assert factor * LETTERS >= least
