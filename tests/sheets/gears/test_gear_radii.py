"""Names of the wheels' circles and the letter of the pole on the engagement picture: nothing is drawn over them."""

import re

import numpy as np
import pytest

from tests import labels
from tmm_sheets import catalogue
from tmm_sheets.drawing.ink_index import InkIndex, enters
from tmm_sheets.drawing.marks import Text
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

NAMES = re.compile(r"r_\{?[awbf]?\d\}? = .*|P_w")


@pytest.mark.parametrize("name", ["transport/press@09-ЭПС-695", "transport/press@24-ЭПС-651", "transport/diesel@08-Т-938", "press"])
def test_names_of_circles_stand_clear_of_all_lines(name):
    """Wheels cut at the sides had names on the arcs that were seen, over other circles; P_w stood over flanks."""
    sheet = composed(Project(catalogue.read(name)), 3)
    picture = next(n for n, part in enumerate(sheet.parts) if part.draw == "gear.engagement" and part.headed)
    marks, box = sheet.drawing.marks, sheet.parts[picture].box
    ink = InkIndex(marks)
    found = set()
    for group in sheet.groups:
        runs = [m for m in marks[group.first:group.end] if isinstance(m, Text)]
        if group.kind != "lettering" or not NAMES.fullmatch(group.text) or not box.contains(runs[0].at):
            continue
        found.add(group.text)
        for run in runs:
            back = np.exp(-1j * run.angle)
            corners = (text_box(run) - run.at) * back
            # From the baseline on: the radius runs under it, and only a comma reaches down there.
            over = enters((ink.a - run.at) * back, (ink.b - ink.a) * back, 0.3, 0.0, corners.real.max() - 0.6, run.height)
            assert not over.any(), (group.text, run.text, [ink.marks[k] for k in ink.of[over]][:2])
    assert len(found) == 11


@pytest.mark.parametrize("name", ["transport/press@05-ЭПС-101", "transport/diesel@03-Т-693"])
def test_no_line_runs_over_letters(name):
    """An arrow head lay on the name on its own shelf; the centre distance was lettered over a tooth and a circle."""
    drawing = composed(Project(catalogue.read(name)), 3).drawing
    assert sum(isinstance(mark, Text) for mark in drawing.marks) > 100
    assert [found for found in labels.crossings(drawing) if found[3] != "table"] == []
