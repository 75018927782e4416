"""Arcs of angles: their arrowheads between the sides, outside where there is no room."""

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Arc, Fill

VERTEX, RADIUS = 100.0 + 100.0j, 40.0


@pytest.mark.parametrize(("angle", "outside"), [(1.0, False), (0.21, False), (0.19, True), (0.01, True), (0.0, True)])
def test_heads_point_at_the_sides_of_the_angle(angle, outside):
    canvas = Canvas()
    canvas.begin(Box(0.0, 0.0, 300.0, 300.0), "", "angles")
    canvas.angle_mark(VERTEX, 0.0, angle, RADIUS, "ψ")
    (arc,) = (m for m in canvas.marks if isinstance(m, Arc))
    heads = [np.asarray(m.points) - VERTEX for m in canvas.marks if isinstance(m, Fill)]
    for head, side, inward in zip(heads, (0.0, angle), (1, -1), strict=True):
        tip, body = np.angle(head[0]), np.angle(head[1:].mean())
        assert abs(head[0]) == pytest.approx(RADIUS)
        assert tip == pytest.approx(side, abs=1e-9)
        assert np.sign(body - side) == (-inward if outside else inward)
        assert arc.start - 1e-9 <= body <= arc.end + 1e-9, "the head stands on the arc"
