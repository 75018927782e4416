"""Numbers at the marks of a follower's path: all of them, in their order, coincident ones together, clear of each other."""

from itertools import combinations, pairwise

import pytest

from tests.few import few
from tests.project_files import project
from tests.sheets.unlettered import unlettered
from tmm_sheets.drawing.marks import Text
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.sheets.components import clear_dimensions as cam_scale

LAW = {"law": "sine", "rise": "100 deg", "upper_dwell": "30 deg", "fall": "80 deg"}
TAPPET = LAW | {"follower": "translating roller", "stroke": "30 mm", "pressure_angle": "30 deg"}
CAMS = {
    "tappet": TAPPET, "to the left": TAPPET | {"sense": "counter-clockwise"}, "small": TAPPET | {"stroke": "8 mm"},
    "flat": LAW | {"follower": "flat", "stroke": "15 mm"}, "another fall": TAPPET | {"fall_law": "cosine"},
    "rocker": LAW | {"follower": "oscillating roller", "arm": "80 mm", "swing": "24 deg", "pressure_angle": "40 deg"},
}


def test_coincident_marks_are_one_with_their_numbers_in_order():
    found = cam_scale.at_marks([0.0, 4.0, 9.0, 9.0, 4.01, 0.0], ["0", "1", "2", "2′", "3", "4"])
    assert [(k, text) for k, _, text in found] == [(0, "0, 4"), (1, "1, 3"), (2, "2, 2′")]


@pytest.mark.parametrize("name", few(CAMS, *list(CAMS)[::2]))
def test_numbers_stand_in_their_order(name):
    own = project({"cam": CAMS[name]})
    inversion = own.cam.inversion
    found = [m for m in unlettered(own).marks if isinstance(m, Text) and m.by is not None and m.by.role == "text"
             and m.height == 2.5 and m.by.step.startswith("cam-profile/")]
    numbers = [n for m in found for n in m.text.split(", ")]
    assert sorted(numbers) == sorted(inversion.plan.labels)
    if own.cam.kind != "rocker":
        first = [int(m.text.split(",")[0].rstrip("′")) for m in found]
        assert all(a.at.imag < b.at.imag for a, b in pairwise(found))
        if name != "another fall":
            assert first == sorted(first)
    for a, b in combinations(map(text_box, found), 2):  # descenders of commas and the slope of the letters may overlap
        assert min(a.real.max(), b.real.max()) <= max(a.real.min(), b.real.min()) + 0.8 or \
            min(a.imag.max(), b.imag.max()) <= max(a.imag.min(), b.imag.min()) + 0.8
