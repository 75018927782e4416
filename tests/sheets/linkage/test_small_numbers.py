"""Numbers of a very small or very even machine: digits are left of what is drawn."""

import re

import numpy as np
import pytest

from tests import project_files as files
from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.numbers import enough
from tmm_sheets.sheets.flywheel import enlarged, flywheel


@pytest.mark.parametrize(("x", "least", "kind", "text"), [
    (12.345, 1, 0.0, "12,3"),
    (0.00140123, 1, 0.0, "0,00140"),
    (-0.00140123, 1, 0.0, "−0,00140"),
    (0.0, 2, 0.0, "0,00"),
    (1e-19, 1, 1.0, "0,0"),  # rounding beside its kind has no digits
    (2.93e-8, 2, 2.93e-8, "0,0000000293"),
])  # fmt: skip
def test_three_digits_are_left(x, least, kind, text):
    assert enough(x, least, kind) == text


@pytest.mark.parametrize(("uneven", "digits"), [([0.05], 4), ([0.0001], 6), ([0.05, 0.0001], 4), ([0.0], 4), ([], 4)])
def test_the_greatest_speed_differs_from_the_least(uneven, digits):
    assert flywheel.omega_digits(2.094, uneven) == digits


def test_an_even_machine_does_not_have_one_speed(monkeypatch):
    said = []
    original = Canvas.text

    def keeping(canvas, at, markup, *rest, **options):
        said.append(markup)
        return original(canvas, at, markup, *rest, **options)

    monkeypatch.setattr(Canvas, "text", keeping)
    project = files.project(files.SLIDER, files.WORKING, files.FORCE, files.MASS, files.MOMENT, files.FLYWHEEL,
                            {"flywheel.delta": 0.0001, "project.sheets": ["flywheel"]})
    enlarged.graph(project, Canvas(), Box(20.0, 5.0, 420.0, 200.0), {})
    found = dict(re.match(r"ω_\{(\w+)\} = ([\d,]+)$", s).groups() for s in said if re.match(r"ω_\{m(?:ax|in)\} = ", s))
    assert set(found) == {"max", "min"}
    assert found["max"] != found["min"]


@pytest.mark.parametrize("peaks", [(), (0.78,), (0.78, 0.72), (0.78, 0.6, 0.4), (0.2,)])
def test_the_sign_of_the_constant_moment_stands_clear_of_the_curve(peaks):
    t = np.linspace(0, 300, 3001)
    curve = t + 1j * (-60.0 + sum((60.0 * np.exp(-(((t - 300 * p) / 4) ** 2)) for p in peaks), np.zeros(t.size)))
    at = flywheel.place_of_sign(curve, 0.0, 300.0)
    assert at.imag == 0.0
    assert np.abs(curve - at).min() > 10.0
    assert at.real == pytest.approx(300 * 0.78) or 0.78 in peaks  # at its usual place, unless the curve comes there


def test_a_curve_that_is_near_everywhere_leaves_the_sign_where_it_is_least_near():
    t = np.linspace(0, 300, 3001)
    at = flywheel.place_of_sign(t - 1j * (1 + t / 100), 0.0, 300.0)
    assert at.real == pytest.approx(300 * 0.78)
