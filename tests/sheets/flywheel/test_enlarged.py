"""The energy-mass diagram is shown once more where inertia hardly varies, as it is where energy does; nowhere else."""

import numpy as np
import pytest

from tests import project_files as files
from tmm_sheets.construction.scale import MAIN
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Polyline
from tmm_sheets.sheets.flywheel import enlarged


def machine(inertia):
    """A slider of 5 kg on a crank of 0.1 m: of the reduced inertia up to 0.05 kg m2 vary, beside what always turns."""
    of_crank = {"link": [{"name": "1", "centre": "O", "inertia": f"{inertia} kg m2"}]}
    return files.project(files.HEAD, files.SLIDER, files.WORKING, files.FORCE, files.MASS, of_crank, files.MOMENT, files.FLYWHEEL)


def drawn(project, box=None):
    canvas = Canvas()
    wide, high = enlarged.energy_mass_sizes(project, canvas, {})[0]
    enlarged.energy_mass(project, canvas, box or Box(0.0, 0.0, wide, high), {})
    return canvas, next(mark.points for mark in canvas.marks if isinstance(mark, Polyline) and mark.style == "curve")


def test_none_where_inertia_varies_enough():
    assert enlarged.energy_mass_sizes(machine(0.0), Canvas(), {}) == ()


def test_none_where_it_does_not_vary_at_all():
    """What is left of 2 kg m2 beside a slider of a nanogram is rounding."""
    light = {"link[1].mass": "1e-12 kg"}
    whole = files.project(files.HEAD, files.SLIDER, files.WORKING, files.FORCE, files.MASS, light, files.MOMENT, files.FLYWHEEL,
                          {"link": [{"name": "1", "centre": "O", "inertia": "2 kg m2"}]})
    assert enlarged.larger(whole.flywheel)[0] == whole.flywheel.scales.inertia


@pytest.mark.parametrize("inertia", [0.3, 1.0])
def test_as_wide_as_a_main_result(inertia):
    """The reduced inertia by the closed form: m (dx/dphi)^2 over the turn."""
    phi = np.linspace(0, 2 * np.pi, 20001)
    x = 0.1 * np.cos(phi) + np.sqrt(0.4**2 - (0.1 * np.sin(phi)) ** 2)
    spread = np.ptp(5 * np.gradient(x, phi) ** 2)
    _, curve = drawn(machine(inertia))
    mu = enlarged.larger(machine(inertia).flywheel)[0].mu
    assert np.ptp(curve.real) == pytest.approx(spread / mu, rel=2e-3)
    assert MAIN <= np.ptp(curve.real) < 2 * MAIN


def test_axis_begins_at_a_number_left_of_the_curve():
    project = machine(1.0)
    first = enlarged.larger(project.flywheel)[2]
    canvas, curve = drawn(project)
    assert 0.9 < first <= 1.0
    assert enlarged.LEFT <= curve.real.min() < enlarged.LEFT + 10.0
    assert any(label.text == f"{first:.4g}".replace(".", ",") for label in canvas.labels)


def test_in_a_narrow_place_it_is_narrower():
    wide, high = enlarged.energy_mass_sizes(machine(1.0), Canvas(), {})[-1]
    _, curve = drawn(machine(1.0), Box(0.0, 0.0, wide, high))
    assert curve.real.max() <= wide - enlarged.RIGHT + 1e-6
