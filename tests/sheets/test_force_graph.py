"""The graph of the force over the path of the output, above or below the position plans."""

import numpy as np
import pytest

from tests import project_files as files
from tmm_sheets.drawing.marks import Line, Polyline
from tmm_sheets.sheets.sheet import composed

STROKE = files.merged(files.HEAD, files.SLIDER, files.WORKING, files.FORCE, files.MASS, files.MOMENT,
                      {"project": {"sheets": ["kinematics_forces"]}})


def graph(project):
    """Its curve, the frame it lies in, ordinates and projection lines, lettering of the sheet, scale factor of the plans."""
    found = composed(project, 1)
    mine = [m for m in found.drawing.marks if m.by and m.by.step and m.by.step.startswith("loads/")]
    curve = next(m for m in mine if isinstance(m, Polyline))
    thin = [m for m in mine if isinstance(m, Line) and m.style == "thin"]
    carried = [m for m in found.drawing.marks if isinstance(m, Line) and m.by and m.by.role == "construction"
               and abs(m.a.real - m.b.real) < 1e-9 and m.by.step == "positions/B"]
    return curve, found.frames[curve.by.frame], thin, carried, [g.text for g in found.groups], found.scales["positions"].mu


@pytest.mark.parametrize(("crank", "times"), [("0.1 m", 1), ("0.008 m", 5)])
def test_a_short_stroke_has_an_abscissa_that_can_be_read(crank, times):
    """A stroke of 16 mm on a mechanism of 0.4 m: 7 to 11 mm on the plans."""
    project = files.project(STROKE, {"crank.length": crank})
    curve, frame, ordinates, carried, texts, mu = graph(project)
    strokes = project.cycle.strokes
    assert np.ptp(curve.points.real) == pytest.approx(strokes.length / frame.mu[0], rel=0.02)
    assert np.ptp(curve.points.real) >= 39.0
    assert frame.mu[0] * times == pytest.approx(mu)
    assert any(text.startswith("μ_S") for text in texts) == (times > 1)
    # Nothing is carried over from marks that lie elsewhere.
    assert bool(carried) == (times == 1)
    assert bool(ordinates) == (times > 1)
