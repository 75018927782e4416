"""The path of a slider whose numbers crowd on the position plans is shown enlarged, every mark with its number."""

import pytest

from tmm_sheets.catalogue import read
from tmm_sheets.drawing.marks import Text
from tmm_sheets.project import Project
from tmm_sheets.sheets import composing
from tmm_sheets.sheets.linkage import kinematics
from tmm_sheets.sheets.sheet import composed

VIEW = "path_marks.enlarged"


@pytest.fixture(scope="module")
def sheet():
    return composed(Project(read("sixbar/5:5")), 1)


def numbers(sheet, inside):
    """Numbers of positions of the slider's point C in a box, apart and together."""
    step = next(m.by.step for m in sheet.drawing.marks if isinstance(m, Text) and m.by and m.text.startswith("C") and "(" in m.text)
    return [m.text for m in sheet.drawing.marks if isinstance(m, Text) and m.by and m.by.step == step and m.text[0].isdigit()
            and inside.contains(m.at)]


def test_all_24_numbers_can_be_read_on_the_enlarged_path(sheet):
    (part,) = (part for part in sheet.parts if part.draw == VIEW and part.title)
    labels = {str(n) for n in range(24)}
    found = [text.split(", ") for text in numbers(sheet, part.box)]
    assert sorted(label for text in found for label in text) == sorted(labels)
    assert sum(len(text) > 1 for text in found) <= 2  # next to the dead position
    assert max(map(len, found)) == 2
    assert not sheet.leaving


def test_the_plans_keep_the_numbers_at_the_ends_of_the_path(sheet):
    (part,) = (part for part in sheet.parts if part.draw == kinematics.PLANS and part.title)
    (enlarged,) = (part for part in sheet.parts if part.draw == VIEW and part.title)
    there = numbers(sheet, part.box)
    if part.box.contains(enlarged.box.centre):  # it may stand in the corner of the plans
        for text in numbers(sheet, enlarged.box):
            there.remove(text)
    assert 1 <= len(there) <= 2


@pytest.mark.parametrize(("z", "together"), [
    ([0, 10, 20], [[0], [1], [2]]),
    ([0, 2, 4, 20], [[0, 1, 2], [3]]),
    ([0, 2.9, 5.8], [[0], [1], [2]]),
    ([], []),
])  # fmt: skip
def test_marks_too_close_share_a_number(z, together):
    assert kinematics.crowds(list(range(len(z))), z) == together


def test_few_marks_ask_for_no_view():
    _, canvas, _ = composing.viewed(Project(read("sixbar/1:1")), 1)
    assert VIEW not in {part.draw for part in canvas.parts}
