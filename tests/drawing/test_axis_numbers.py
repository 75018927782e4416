"""Numbers at axes make way for lines that are drawn after them."""

import numpy as np
import pytest

from tmm_sheets.drawing import placing
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink_index import InkIndex, enters
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.sheets.components import graphs

PITCH = 12.0


def graph(*lines, labels="0123456", height=3.5):
    """A level axis with its numbers under it, and what is drawn after them."""
    canvas = Canvas()
    canvas.line(0j, 90 + 0j, "axis")
    canvas.line(-40j, 40j, "axis")
    for k, name in enumerate(labels):
        at = complex(PITCH * k)
        canvas.line(at - 0.8j, at + 0.8j, "axis")
        canvas.number(at, at + (complex(-4.5, -5) if k == 0 else complex(-1.2, -5)), name, height, PITCH, first=k == 0)
    for a, b, *style in lines:
        canvas.line(a, b, *style)
    return canvas


def texts(canvas):
    return {m.text: m for m in canvas.marks if isinstance(m, Text)}


def struck(canvas):
    ink, found = InkIndex(canvas.marks), []
    for name, mark in texts(canvas).items():
        z = text_box(mark)
        if enters(ink.a, ink.b - ink.a, z.real.min(), mark.at.imag, z.real.max(), z.imag.max()).any():
            found.append(name)
    return found


def test_what_stands_clear_stays():
    canvas = graph((-20j, 90 - 20j))
    before = list(canvas.marks)
    placing.set_numbers(canvas, InkIndex(canvas.marks))
    assert canvas.marks == before


@pytest.mark.parametrize("lines", [
    [(-3j, 90 - 3j)],                                             # a projecting line under the axis
    [(-3j, 90 - 3j), (3j, 90 + 3j)],                              # one on either side
    [(-3j, 90 - 3j), (4j, 90 + 4j, "axis"), (0j, 90 - 30j, "curve")],
    [(PITCH * k + 30j, PITCH * k - 30j) for k in range(7)],       # ordinates to both sides
    [(-1j * y, 90 - 1j * y) for y in (2, 4, 6, 8)] + [(-3j + 60, 3j + 84, "curve")],
])  # fmt: skip
def test_numbers_make_way_for_lines(lines):
    canvas = graph(*lines)
    assert struck(canvas)
    placing.set_numbers(canvas, InkIndex(canvas.marks))
    assert not struck(canvas)


def test_numbers_of_one_axis_stay_on_one_level():
    canvas = graph((-3j, 90 - 3j))
    placing.set_numbers(canvas, InkIndex(canvas.marks))
    levels = {m.at.imag for name, m in texts(canvas).items() if name != "0"}
    assert len(levels) == 1


def test_a_number_stays_nearest_to_its_own_position():
    canvas = graph(*[(PITCH * k + 30j, PITCH * k - 30j) for k in range(7)])
    placing.set_numbers(canvas, InkIndex(canvas.marks))
    for name, mark in texts(canvas).items():
        z = text_box(mark)
        middle = (z.real.min() + z.real.max()) / 2
        assert int(np.argmin(np.abs(PITCH * np.arange(7) - middle))) == int(name)


def test_numbers_keep_clear_of_other_lettering():
    canvas = graph((-3j, 90 - 3j))
    canvas.text(30 + 1.5j, "H = 40", 3.5)
    placing.set_numbers(canvas, InkIndex(canvas.marks))
    boxes = [text_box(m) for m in canvas.marks if isinstance(m, Text)]
    for i, a in enumerate(boxes):
        for b in boxes[:i]:
            assert a.real.max() < b.real.min() or b.real.max() < a.real.min() or a.imag.max() < b.imag.min() \
                or b.imag.max() < a.imag.min()


def test_a_number_of_the_ordinate_axis_stands_right_at_its_lines():
    """The line it names passes within a millimetre, others keep farther; of two lines close together neither is told apart."""
    canvas = Canvas()
    canvas.line(-40j, 40j, "axis")
    for y in (5.0, 12.0, 12.6, 30.0):
        canvas.line(1j * y, 50 + 1j * y)
    plain = placing.PointNumbers(canvas)
    assert plain.place(canvas, [5j], "1′")
    assert plain.place(canvas, [30j], "4′")
    mark = texts(canvas)["1′"]
    assert 5 < mark.at.imag < 6
    assert not plain.place(canvas, [12j], "2′") or texts(canvas)["2′"].at.imag < 12
    assert not struck(canvas)
    crowd = Canvas()
    crowd.line(-40j, 40j, "axis")
    for y in np.arange(0.0, 12.0, 1.5):
        crowd.line(1j * y - 50, 50 + 1j * y)
    assert not placing.PointNumbers(crowd).place(crowd, [6j], "5′")


def test_a_number_of_points_close_together_stands_over_the_highest_or_under_the_lowest():
    canvas = Canvas()
    for y in (12.0, 12.6, 13.4):
        canvas.line(1j * y, 50 + 1j * y)
    numbers = placing.PointNumbers(canvas)
    assert numbers.place(canvas, [12j, 12.6j, 13.4j], "2′–4′")
    assert 13.4 < texts(canvas)["2′–4′"].at.imag < 14.4
    assert not struck(canvas)


def test_numbers_of_one_axis_are_of_one_height():
    """One between lines that leave it no more room than 2.5 mm letters take: the others of its axis are no higher."""
    canvas, x = Canvas(), np.array([0.0, 20.0, 40.0, 60.0])
    graphs.numbers(canvas, graphs.Graph(0j), x, ["0", "1", "2", "3"], np.ones(4))
    graphs.numbers(canvas, graphs.Graph(-100j), x, ["0", "1", "2", "3"], np.ones(4))
    for mark in (n.mark for n in canvas.numbers[1:2]):
        canvas.marks[mark] = canvas.marks[mark]._replace(height=2.5)
    before = [m for m in canvas.marks if isinstance(m, Text)]
    placing.even(canvas, canvas.numbers)
    after = [m for m in canvas.marks if isinstance(m, Text)]
    assert [m.height for m in after] == [2.5] * 4 + [3.5] * 4
    for old, new in zip(before, after, strict=True):
        assert Box.around(text_box(old), 0.01).contains(Box.around(text_box(new)).centre)
        assert Box.around(text_box(new)).y1 == pytest.approx(Box.around(text_box(old)).y1, abs=0.01)  # as near to the axis
