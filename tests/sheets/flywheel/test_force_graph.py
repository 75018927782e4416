"""The graph of the force over the path of the output, above or below the position plans."""

import numpy as np
import pytest

from tests import project_files as files
from tests.sheets.unlettered import unlettered, words
from tmm_sheets.drawing.marks import Line, Polyline
from tmm_sheets.sheets.sheet import composed

STROKE = files.merged(files.HEAD, files.SLIDER, files.WORKING, files.FORCE, files.MASS, files.MOMENT,
                      {"project": {"sheets": ["kinematics_forces"]}})


def graph(project):
    """Its curve, the frame it lies in, ordinates and projection lines, lettering of the sheet, scale factor of the plans."""
    found = unlettered(project)
    mine = [m for m in found.marks if m.by and m.by.step and m.by.step.startswith("loads/")]
    curve = next(m for m in mine if isinstance(m, Polyline))
    thin = [m for m in mine if isinstance(m, Line) and m.style == "thin"]
    carried = [m for m in found.marks if isinstance(m, Line) and m.by and m.by.role == "construction"
               and abs(m.a.real - m.b.real) < 1e-9 and m.by.step == "positions/B"]
    return curve, found.frames[curve.by.frame], thin, carried, words(found), found.scales["positions"].mu


@pytest.mark.parametrize(("crank", "times"), [("0.1 m", 1), ("0.008 m", 4)])
def test_a_short_stroke_has_an_abscissa_that_can_be_read(crank, times):
    """A stroke of 16 mm on a mechanism of 0.4 m: as much on the plans."""
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


def curves(project):
    """Curves of the force over the path: distances along it, m, and ordinates, N; numbers of the graph."""
    found = unlettered(project)
    mine = [m for m in found.marks if m.by and m.by.step and m.by.step.startswith("loads/")]
    read = []
    for curve in (m for m in mine if isinstance(m, Polyline)):
        frame = found.frames[curve.by.frame]
        off = curve.points - frame.origin
        read.append((np.abs(off.real) * frame.mu[0], off.imag * frame.mu[1]))
    return read


def test_a_force_that_turns_over_crosses_the_axis():
    """It was drawn by its size, a V that stood on the axis."""
    table = {"force[0].value": None, "force[0].table": [[0, "400 N"], [0.5, "1500 N"], [1, "-800 N"]]}
    project = files.project(STROKE, table)
    (way, force), = curves(project)
    assert force.max() == pytest.approx(1500, rel=1e-3)
    assert force.min() == pytest.approx(-800, rel=1e-3)
    inside = slice(1, -1)  # between the lines that come down to the axis
    share = way[inside] / project.cycle.strokes.length
    assert force[inside] == pytest.approx(np.interp(share, [0, 0.5, 1], [400, 1500, -800]), abs=1.0)
    # Against the motion: a resistance is positive in the graph over the angle as well, whichever way its point goes.
    load, = project.applied
    begin, end = project.cycle.strokes.begin, project.cycle.strokes.end
    turned = np.linspace(begin, end, 50)[1:-1]
    assert np.sign(load.shown(turned)) == pytest.approx(-np.sign(load.law(turned, 0) * project.cycle.strokes.length))
    assert load.shown(begin + 1e-4) == pytest.approx(400, rel=1e-2)


def test_each_diagram_of_a_force_over_the_path_is_drawn():
    """Of a cycle of two turns only the first was, with the numbers of both."""
    tables = [[[0, "0 N"], [1, "1500 N"]], [], [[0.3, "900 N"], [0.6, "900 N"]], [[0, "0 N"], [1, "0 N"]]]
    project = files.project(STROKE, {"cycle.turns": 2, "force[0].value": None, "force[0].stroke": None, "force[0].tables": tables})
    first, second = curves(project)
    assert first[1].max() == pytest.approx(1500, rel=1e-3)
    assert second[1].max() == pytest.approx(900)
    assert second[1].min() == 0
    labels = project.cycle.labels
    assert {f"{labels[1]}…{labels[5]}", f"{labels[13]}…{labels[17]}"} <= {*words(unlettered(project))}


def test_every_position_of_the_graph_has_its_number_beside_lines():
    table = {"force[0].value": None, "force[0].table": [[0, "-800 N"], [0.5, "900 N"], [1, "-800 N"]]}
    project = files.project(STROKE, table)
    found = composed(project, 1)
    mine = [m for m in found.drawing.marks if m.by and m.by.step and m.by.step.startswith("loads/")]
    outline = next(m for m in mine if isinstance(m, Polyline)).points
    axis = found.frames[next(m for m in mine if isinstance(m, Polyline)).by.frame].origin.imag
    numbers = [m for m in found.drawing.marks if type(m).__name__ == "Text" and m.height == 2.5 and abs(m.at.imag - axis) < 5
               and outline.real.min() - 6 < m.at.real < outline.real.max() + 6]
    assert {m.text for m in numbers} >= {"1", "2", "3", "4", "5"}
    for m in numbers:
        off = outline - m.at
        assert not ((off.real > 0) & (off.real < 1.6) & (off.imag > 0) & (off.imag < 2.5)).any()


def test_diagrams_that_are_alike_are_one_curve():
    table = [[0, "0 N"], [1, "1500 N"]]
    changes = {"cycle.turns": 2, "force[0].value": None, "force[0].stroke": None, "force[0].tables": [table, [], table, []]}
    project = files.project(STROKE, changes)
    (_, force), = curves(project)
    assert force.max() == pytest.approx(1500, rel=1e-3)
    changes["force[0].tables"] = [table, [], table, [[0, "300 N"], [1, "300 N"]]]
    project = files.project(STROKE, changes)
    assert len(curves(project)) == 2
    labels = project.cycle.labels
    # Both strokes of the first curve are named at it.
    assert f"{labels[1]}…{labels[5]}, {labels[13]}…{labels[17]}" in words(unlettered(project))


def test_a_force_on_the_way_back_alone_is_drawn_over_it():
    (way, force), = curves(files.project(STROKE, {"force[0].stroke": "idle"}))
    assert force.max() == pytest.approx(100)
    assert np.ptp(way) == pytest.approx(files.project(STROKE).cycle.strokes.length, rel=0.02)
