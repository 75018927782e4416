"""What a flash or the edge of a shadow takes away is hidden, and nothing else is."""

from types import SimpleNamespace

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo.lost_ink import mask_washed_out, taken, uneven_places
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Text
from tmm_sheets.drawing.text_layout import text_box

pytestmark = pytest.mark.judging

VIEW = ElementView(0, "view", Box(0, 0, 841, 594))
FLAT = SimpleNamespace(to_picture=lambda z: 2 * (z.real + 1j * (PAPER.y1 - z.imag)))


def picture(light, x0, x1):
    grey = np.full((2 * 594, 2 * 841), 200, np.uint8)
    grey[:, 2 * x0 : 2 * x1] = light
    return grey


def lettering(status, x):
    mark = Text(complex(x, 300), "F10", 5.0)
    return InkTrace(Element(1, VIEW, "F10", "text", text_box(mark), "text", text="F10", height=5.0, marks=(mark,)), status)


def line(status, x, pieces=False):
    return InkTrace(Element(2, VIEW, "", "line", np.array([x + 200j, x + 240j]), "thin"), status, pieces=pieces)


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
    (after,) = mask_washed_out([trace], places)
    assert (after.status == "hidden") == hidden
    assert taken([trace], [after]) == ([trace.element.middle] if hidden else [])
    assert mask_washed_out([], places) == []
    assert taken([], []) == []


@pytest.mark.parametrize(("ends", "shown"), [
    ((-3.0, 0.0), (np.nan, 0.0)), ((0.0, -3.0), (0.0, -3.0)),  # its end is in even light
    ((-0.8, 0.0), (-0.8, 0.0)), ((3.0, 0.0), (3.0, 0.0)), ((np.nan, -3.0), (np.nan, -3.0)), ((-3.0, -3.0), (np.nan, -3.0)),
])
def test_an_end_that_the_light_took_is_unknown_and_told_by_its_place(ends, shown):
    uneven = uneven_places(picture(255, 380, 420), FLAT)
    e = Element(2, VIEW, "", "line", np.array([410 + 200j, 450 + 200j]), "thin")
    before = [InkTrace(e, "measured", ends=ends)]
    after = mask_washed_out(before, uneven)
    assert after[0].ends == pytest.approx(shown, nan_ok=True)
    assert taken(before, after) == ([] if after[0] is before[0] else [410 + 200j])
