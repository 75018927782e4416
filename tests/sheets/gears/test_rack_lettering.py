"""Lettering of the generating engagement: nothing is drawn over the names of its lines and sizes."""

import pytest

from tests import project_files as files
from tests.few import seldom
from tmm_sheets.box import Box
from tmm_sheets.drawing.ink import polyline_inside
from tmm_sheets.drawing.marks import Text, flat
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.words import on_paper

NAMES = ("reference", "pitch line", "прямая рейки", "ρ_f =", "xm =", "p =", "α = ")


def struck(sheet):
    """Names of the view over which something is drawn."""
    marks = sheet.drawing.marks
    for group in sheet.groups:
        if group.text.startswith(NAMES) or group.text.endswith("прямая рейки"):
            for text in (mark for mark in marks[group.first:group.end] if isinstance(mark, Text)):
                z = text_box(text)
                box = Box(z.real.min(), z.imag.min(), z.real.max(), z.imag.max()).inset(0.3)
                if any(polyline_inside(box, flat(mark, 1.0)) for mark in marks if not isinstance(mark, Text)):
                    yield group.text


@pytest.mark.parametrize("language", ["en", seldom("ru")])
@pytest.mark.parametrize(("teeth", "module", "shift"), [
    ([13, 38], "5 mm", "rule"),  # "reference line of the rack" and the fillet's radius on the axis, the shift on the frame
    ([20, 22], "3 mm", "rule"),  # reference and pitch line are one; the angle's sign on its arc
    ([18, 21], "2.5 mm", [0.3, 0.25]),
])
def test_nothing_is_drawn_over_names_and_sizes_of_the_rack(language, teeth, module, shift):
    own = files.project({**files.GEAR, "project.sheets": ["gear"], "gear.teeth": teeth, "gear.module": module, "gear.shift": shift})
    with on_paper(language):
        assert list(struck(composed(own, 1))) == []
