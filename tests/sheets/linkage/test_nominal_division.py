"""A sheet whose strokes are divided by K says so once, with the angle that its ends are beside the dead positions."""

from math import acos, degrees

import pytest

from tests.project_files import NOMINAL, from_file, known, project
from tests.sheets.unlettered import unlettered, words


@pytest.mark.parametrize("nominal", [False, True], ids=["exact", "nominal"])
def test_it_is_told_once(nominal):
    text = " ".join(words(unlettered(project(from_file("lugansk/shaper"), NOMINAL) if nominal else known("lugansk/shaper"))))
    assert text.count("отстоят") == nominal
    beside = (216 - (360 - 2 * degrees(acos(0.08 / 0.26)))) / 2
    assert (f"на {beside:.2f}°".replace(".", ",") in text) is nominal
