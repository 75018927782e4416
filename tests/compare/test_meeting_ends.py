"""Ends at joints and where lines meet are judged by no more than a pencil may do there."""

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.line_ends import ignore_junction_ends
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Provenance as By

pytestmark = pytest.mark.judging

VIEW = ElementView(1, "plan", Box(0, 0, 841, 594))
LINE = Element(1, VIEW, "A–B", "line", np.array([100 + 300j, 150 + 300j]), "main")
ALONG = Element(2, VIEW, "A–C", "line", np.array([100 + 300j, 120 + 300j]), "thin")
ACROSS = Element(3, VIEW, "A–D", "line", np.array([130 + 330j, 100.3 + 300j]), "main")
TURN = np.exp(2j * np.pi * np.arange(24) / 24)


def ring(radius, centre=100 + 300j, fills=()):
    return Element(9, VIEW, "A", "circle", centre + radius * TURN, "main", centre=centre, radius=radius, fills=fills,
                   by=By("symbol", "positions/A", ""))


JOINT, AWAY, WHEEL, DOT = ring(1.6), ring(1.6, 104 + 300j), ring(20.0), ring(0.5, fills=(100 + 300j + 0.5 * TURN,))


@pytest.mark.parametrize(("others", "by", "right"), [
    ([], 1.0, False), ([], -1.3, False),
    ([JOINT], -1.3, True), ([JOINT], 1.3, True), ([JOINT], -2.6, False), ([AWAY], -1.3, False), ([WHEEL], -1.3, False),
    ([ACROSS], 1.0, True), ([ACROSS], 1.6, False), ([ACROSS], -1.0, False), ([ALONG], 1.0, False),  # its own helper
    ([DOT], 1.0, True), ([DOT], -1.0, False), ([ALONG, ACROSS, JOINT], -2.0, True),
    ([JOINT], np.nan, False),
])
def test_an_end_that_meets_others_may_be_off_as_a_pencil_makes_it(others, by, right):
    for t, ends in ((InkTrace(LINE, "measured", ends=(by, 1.2), at=LINE.points), (0.0 if right else by, 1.2)),
                    (InkTrace(LINE, "measured", ends=(np.nan, by), at=LINE.points), (np.nan, by))):  # nothing is at B
        found, = ignore_junction_ends([t], [LINE, *others])
        assert found.ends == pytest.approx(ends, nan_ok=True)


@pytest.mark.parametrize(("style", "by", "verdict"), [
    ("thin", -2.4, "green"), ("thin", -2.7, "amber"), ("hidden", -7.9, "green"), ("hidden", -8.1, "amber"),
    ("hidden", 2.7, "amber"), ("centre", -20.0, "green"), ("main", -1.0, "amber"),
])
def test_a_dashed_line_may_lack_its_last_dash(style, by, verdict):
    e = Element(1, VIEW, "", "line", LINE.points, style, by=By("link", "", ""))
    assert judge(InkTrace(e, "measured", ends=(0.0, by), at=e.points), 0.25, 0.15).verdict == verdict
