"""The hodograph of the bearing: too flat to be read it is left out, and that is told; where there is none nothing is."""

import pytest

from tests import project_files as files
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.sheets.linkage import diagrams
from tmm_sheets.sheets.sheet import composed

LOADED = files.HEAD, files.SLIDER, files.WORKING, files.MASS, files.MOMENT


def test_one_that_is_too_flat_is_told():
    """A light rod: across the guide the reaction is r/l = 0.1/0.4 of that along it at the most, and there less than a tenth."""
    own = files.project(*LOADED, files.FORCE)
    assert diagrams.bearing_sizes(own, Canvas(), {}) == []
    (told,) = diagrams.too_flat(own)
    assert "F10" in str(told)
    assert "25 mm" in str(told)


def test_one_that_can_be_read_is_offered():
    own = files.known("sixbar/8:3")
    assert diagrams.bearing_sizes(own, Canvas(), {})
    assert not [*diagrams.too_flat(own)]


@pytest.mark.parametrize("parts", [(files.HEAD, files.SLIDER, files.EVEN), (*LOADED, {"link[1].mass": "0 kg"})])
def test_none_without_forces(parts):
    own = files.project(*parts)
    assert not [*diagrams.too_flat(own)]


def test_the_sheet_tells_it():
    assert any("F10" in str(remark) for remark in composed(files.known("press"), 2).left_out)
