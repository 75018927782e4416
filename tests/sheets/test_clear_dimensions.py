"""Dimensions that had lines through their lettering: S0 of a tappet's zone, the teeth of a pinion in a ring."""

from cmath import phase
from itertools import product

import numpy as np
import pytest

from tests.few import few, seldom
from tests.project_files import project
from tmm_sheets.drawing.ink import interrupted
from tmm_sheets.drawing.ink_index import InkIndex, enters
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box, Text
from tmm_sheets.sheets.sheet import composed

TAPPET = {"follower": "translating roller", "law": "sine", "rise": "100 deg", "upper_dwell": "30 deg", "fall": "80 deg",
          "stroke": "30 mm", "pressure_angle": "30 deg"}


def through(drawing, view, text):
    """Lines of a view through the lettering of one of its dimensions."""
    (found,) = [d for d in drawing.dimensions if d.text.startswith(text)]
    first = next(m for m in drawing.marks[found.first:found.end] if isinstance(m, Text))
    lines = (part for m in drawing.marks if m.of == view and not isinstance(m, Text) and m.style != "text"
             for part in interrupted(m))
    ink, back = InkIndex(lines), np.exp(-1j * first.angle)
    laid = letter(found.text, 3.5)
    box = Box(0.3, -laid.descent + 0.3, laid.width - 0.3, laid.ascent - 0.3)
    return int(enters((ink.a - first.at) * back, (ink.b - ink.a) * back, *box).sum())


OTHERS = ({}, {"sense": "counter-clockwise"}, {"stroke": "12 mm", "pressure_angle": "25 deg"})
ECCENTRICITIES = (None, "0 mm", "10 mm", "-10 mm")


@pytest.mark.parametrize(("changes", "eccentricity"), few(
    product(OTHERS, ECCENTRICITIES), *zip(OTHERS[:2], ECCENTRICITIES[::3], strict=True)))
def test_first_distance_of_a_tappet(eccentricity, changes):
    own = project({"cam": TAPPET | changes | ({"eccentricity": eccentricity} if eccentricity else {})})
    assert through(composed(own, 1).drawing, "cam_zone.of_tappet", "S_0") == 0


@pytest.mark.parametrize(("teeth", "module", "shift"), [((30, 80), "3 mm", "rule"), seldom((25, 100), "2 mm", [0.3, 0.3]),
                                                        seldom((20, 40), "8 mm", [0, 0.3])])
def test_pitch_of_a_pinion_in_a_ring(teeth, module, shift):
    own = project({"gear": {"teeth": list(teeth), "module": module, "shift": shift, "mesh": "internal",
                            "pressure_angle": "20 deg"}})
    assert through(composed(own, 1).drawing, "gear.engagement", "p̅_1") == 0


def test_lettering_wider_than_its_dimension_stands_over_the_extension_lines():
    from tmm_sheets.drawing.canvas import PAST, lettered

    at, along = lettered(0j, 6.0 + 0j, 10.0, "p = 12,34")
    assert phase(along) == 0
    assert at.imag >= 10.0 + PAST
    assert lettered(0j, 40.0 + 0j, 10.0, "p = 12,34")[0].imag < 10.0 + PAST
