"""A load that jumps at the position of the force analysis says so beside the links it acts on, with the value that is taken."""

import pytest

from tests.project_files import FORCE, MASS, MOMENT, SLIDER, WORKING, project
from tests.sheets.unlettered import unlettered, words
from tmm_sheets.sheets.linkage import kinetics


@pytest.mark.parametrize(("position", "said"), [
    ("3", []),  # in the middle of the working stroke
    ("0", ["В положении 0 F_{3} меняется скачком от 0 Н до 100 Н; взято 0 Н"]),
    ("6", ["В положении 6 F_{3} меняется скачком от 100 Н до 0 Н; взято 0 Н"]),
])
def test_what_is_said_of_a_jump(position, said):
    own = project(SLIDER, WORKING, FORCE, MASS, MOMENT, {"cycle.force_position": position})
    assert [line.replace("\N{NO-BREAK SPACE}", " ") for line in kinetics.jumps(own, {"2", "3"})] == said
    assert list(kinetics.jumps(own, {"1"})) == []


def test_it_stands_on_the_sheet_once():
    own = project(SLIDER, WORKING, FORCE, MASS, MOMENT, {"cycle.force_position": "6", "project.sheets": ["kinematics_forces"]})
    assert " ".join(words(unlettered(own))).count("скачком") == 1
