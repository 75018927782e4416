"""Reduced quantities at angles that are only tried: steps done again tell what plans made for these angles tell."""

import numpy as np
import pytest

from tmm_sheets import catalogue
from tmm_sheets.methods.flywheel.reduced import TRIED, Reduced, Reduction
from tmm_sheets.project import Project

ANGLES = (np.linspace(0.0, 6.0, 7), np.array([1.0]), np.empty(0), np.linspace(0.1, 3.0, 6).reshape(2, 3), 0.4)
"""As many as before, one, none, in another shape, a bare number."""


@pytest.mark.parametrize("name", ["lugansk/shaper", "lugansk/engine", "press", "sixbar/8:3", "tests/projects/pump.toml"])
def test_done_again_is_made_anew(name):
    reduced = Project(catalogue.read(name)).reduced
    breaks = np.array(reduced.breaks[:4])
    for phi in (np.linspace(0.2, 5.0, 4), *ANGLES, breaks):
        for side in (-1, 0, 1):  # loads jump at the breaks
            np.testing.assert_array_equal(reduced.moment(phi, side), Reduction(reduced, TRIED, phi).moment(side).value)
        np.testing.assert_array_equal(reduced.inertia(phi), Reduction(reduced, TRIED, phi).inertia.value)


def test_no_load_is_none_in_the_shape_that_is_asked():
    project = Project(catalogue.read("lugansk/shaper"))
    reduced = Reduced(project.mechanism, project.cycle, ())
    for phi in (np.linspace(0.2, 5.0, 4), *ANGLES):
        assert np.shape(reduced.moment(phi)) == np.shape(phi)
        assert not np.any(reduced.moment(phi))
