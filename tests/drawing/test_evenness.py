"""What a view uses of its place: never more than all of it."""

import numpy as np
import pytest

from tests.evenness import gap
from tmm_sheets.box import Box
from tmm_sheets.drawing import ink_index
from tmm_sheets.drawing.marks import Arc, Drawing, Line, View

PLACE = Box(100.0, 100.0, 200.0, 200.0)


@pytest.mark.parametrize(("a", "b", "share"), [
    (100 + 100j, 200 + 200j, 1.0), (100 + 100j, 150 + 200j, 0.5), (150 + 150j, 150 + 150j, 0.0),
    (0j, 400 + 400j, 1.0), (150 + 150j, 400 + 400j, 0.25), (300 + 300j, 400 + 400j, 0.0),
], ids=["whole", "half", "point", "beyond", "over a corner", "elsewhere"])  # fmt: skip
def test_fill_of_a_place(a, b, share):
    drawing = Drawing(841.0, 594.0, "", (Line(a, b, "main"),), views=(View("view", PLACE, ((0, 1),)),))
    assert dict(ink_index.fills(drawing)) == {"view": pytest.approx(share)}


def test_the_circle_of_a_detail_has_no_place_of_its_own():
    marks = Line(100 + 100j, 200 + 200j, "main"), Arc(150 + 150j, 2.0, 0.0, 6.28, "thin")
    drawing = Drawing(841.0, 594.0, "", marks, views=(View("plan", PLACE, ((0, 1),)), View("mark", PLACE, ((1, 2),))))
    assert [name for name, _ in ink_index.fills(drawing)] == ["plan"]


@pytest.mark.parametrize(("pitch", "high"), [(110.0, 110.0), (130.0, 130.0), (400.0, 345.0)])
def test_the_gap_is_the_largest_empty_rectangle(pitch, high):
    """Level lines so far apart over the whole field leave that between them, or what is over the title block."""
    lines = [Line(20.0 + 1j * y, 836.0 + 1j * y, "thin") for y in np.arange(5.0, 590.0, pitch)]
    found = gap(Drawing(841.0, 594.0, "", tuple(lines)))
    assert found.height == pytest.approx(high, abs=4.0)
    assert found.width == pytest.approx(816.0, abs=4.0)
