"""Remarks stand near what is drawn of their view, not anywhere in its place."""

import pytest

from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.drawing.placing import place

FIELD = Box(0.0, 0.0, 400.0, 300.0)


def placed(canvas):
    first = len(canvas.marks)
    crowded = place(canvas, FIELD)
    return crowded, next(mark.at for mark in canvas.marks[first:] if isinstance(mark, Text))


@pytest.mark.parametrize("low", [240.0, 150.0, 30.0])
def test_a_view_that_leaves_most_of_its_place_free_has_its_remark_near_its_ink(low):
    canvas, box = Canvas(), Box(50.0, 10.0, 250.0, 290.0)
    canvas.begin(box, "", "force plan")
    canvas.line(complex(60, low), complex(240, low + 20), "vector")
    canvas.note(box, "Less than 1 mm")
    crowded, at = placed(canvas)
    assert crowded == []
    assert low - 20 < at.imag < low + 30


def test_the_parts_of_a_view_count_together_those_of_its_neighbours_do_not():
    canvas, box = Canvas(), Box(50.0, 10.0, 250.0, 290.0)
    canvas.begin(box, "", "velocity plans")
    canvas.note(box, "Less than 1 mm")
    for y in (250.0, 120.0):
        canvas.begin(Box(60.0, y - 20, 240.0, y + 20), "", "velocity plans")
        canvas.line(complex(70, y), complex(230, y), "vector")
    canvas.begin(Box(260.0, 10.0, 390.0, 290.0), "", "velocity plans")
    canvas.line(270 + 20j, 380 + 20j, "vector")
    _, at = placed(canvas)
    assert 100 < at.imag < 140


def test_a_view_without_ink_has_its_remark_in_its_place():
    canvas = Canvas()
    canvas.begin(Box(50.0, 200.0, 250.0, 290.0), "", "empty")
    canvas.note(canvas.parts[-1].box, "Less than 1 mm")
    crowded, at = placed(canvas)
    assert crowded == []
    assert 200 < at.imag < 290


def test_a_remark_of_no_view_has_its_place():
    canvas = Canvas()
    canvas.line(60 + 20j, 240 + 20j, "vector")
    canvas.note(Box(50.0, 200.0, 250.0, 290.0), "Less than 1 mm")
    _, at = placed(canvas)
    assert 200 < at.imag < 290


@pytest.mark.parametrize("low", [60.0, 12.0], ids=["room below", "no room below"])
def test_a_remark_stands_between_no_plan_and_its_caption_where_there_is_another_place(low):
    canvas, box = Canvas(), Box(10.0, 8.0, 390.0, 200.0)
    canvas.begin(box, "", "velocity plans")
    canvas.note(box, "Less than 1 mm")
    for x in (10.0, 137.0, 264.0):
        canvas.begin(Box(x, low, x + 126.0, low + 100.0), "Velocity plan", "velocity plans")
        canvas.line(complex(x + 5, low + 60), complex(x + 121, low + 90), "vector")
        canvas.text(complex(x + 60, low + 2), "Position 1", 3.5, "centre")
    _, at = placed(canvas)
    assert at.imag < low or at.imag > low + 60


@pytest.mark.parametrize("open_above", [True, False], ids=["room above", "no other room"])
def test_a_remark_is_a_column_between_two_plans_only_where_there_is_no_room_for_lines(open_above):
    canvas, box = Canvas(), Box(10.0, 8.0, 390.0, 200.0)
    canvas.begin(box, "", "velocity plans")
    canvas.note(box, "Less than 1 mm, about nothing: five vectors (positions 3, 6)")
    for x in (10.0, 226.0):
        canvas.begin(Box(x, 8.0, x + 164.0, 150.0), "Velocity plan", "velocity plans")
        for y in range(10, 150, 4):
            canvas.line(complex(x, y), complex(x + 164, y), "vector")
    if not open_above:
        canvas.begin(Box(0.0, 152.0, 400.0, 300.0), "", "others")
        for y in range(152, 300, 4):
            canvas.line(complex(0, y), complex(400, y), "vector")
    crowded, at = placed(canvas)
    assert crowded == []
    assert (at.imag > 146) is open_above
