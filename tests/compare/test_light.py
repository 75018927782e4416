"""What a flash or the edge of a shadow takes away is hidden, and nothing else is."""

from types import SimpleNamespace

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo.light import taken, uneven_places, without_taken
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import Trace
from tmm_sheets.drawing.labels import text_box
from tmm_sheets.drawing.marks import Text

VIEW = ElementView(0, "view", Box(0, 0, 841, 594))
FLAT = SimpleNamespace(to_picture=lambda z: 2 * (z.real + 1j * (PAPER.y1 - z.imag)))


def picture(light, x0, x1):
    grey = np.full((2 * 594, 2 * 841), 200, np.uint8)
    grey[:, 2 * x0 : 2 * x1] = light
    return grey


def lettering(status, x):
    mark = Text(complex(x, 300), "F10", 5.0)
    return Trace(Element(1, VIEW, "F10", "text", text_box(mark), "text", text="F10", height=5.0, marks=(mark,)), status)


def line(status, x, pieces=False):
    return Trace(Element(2, VIEW, "", "line", np.array([x + 200j, x + 240j]), "thin"), status, pieces=pieces)


@pytest.mark.parametrize(("light", "at", "uneven"), [
    (200, 400, False), (255, 400, True), (255, 100, False),  # a flash
    (140, 400, False), (140, 300, True),  # within a shadow all is seen, at its edge not
    (190, 300, False),  # a faint shadow
])
def test_light_takes_letters_where_it_is_too_bright_and_at_edges_of_shadows(light, at, uneven):
    places = uneven_places(picture(light, 300, 500), FLAT)
    assert places[300, at] == uneven


@pytest.mark.parametrize(("trace", "hidden"), [
    (lettering("absent lettering", 400), True), (lettering("part of lettering", 400), True), (lettering("lettering", 400), False),
    (lettering("absent lettering", 200), False), (lettering("absent lettering", 290), False),  # most of it is in even light
    (line("missing", 400, pieces=True), True), (line("missing", 400), False), (line("measured", 400), False),
])
def test_what_is_not_seen_there_is_hidden(trace, hidden):
    places = np.zeros((594, 841), bool)
    places[:, 300:500] = True
    (after,) = without_taken([trace], places)
    assert (after.status == "hidden") == hidden
    assert taken([trace], [after]) == ([trace.element.middle] if hidden else [])
    assert without_taken([], places) == []
    assert taken([], []) == []
