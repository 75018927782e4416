"""Sheets of the engine: indicator diagrams over the piston paths, views of the synthesis, nothing crowded."""

import re

import numpy as np
import pytest

from tmm_sheets import catalogue
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Line, Polyline, Text, flat
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.errors import CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.resources import variants
from tmm_sheets.sheets.linkage import diagrams, kinematics, synthesis
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task import variant

PRINTED = {"0": 4.2, "1′": 6.0, "1": 2.25, "2": 0.75, "3": 0.3, "10": 0.15, "11": 0.75, "14": 0.15, "15": 0.75}
"""Pressures in cylinder 3 (0 to 3, 14, 15) and in cylinder 5 (10, 11) at the positions, MPa: table 5.3."""


@pytest.fixture(scope="module")
def project():
    return Project(catalogue.read("lugansk/engine"))


@pytest.mark.parametrize("sheet", [1, 2, 3, 4])
def test_nothing_is_crowded(project, sheet):
    assert not composed(project, sheet).crowded


def test_indicator_diagrams_carry_the_pressures_over_the_marks_of_the_path(project):
    canvas = Canvas()
    kinematics.position_plans(project, canvas, Box(25, 228, 243, 573), {})
    mu_l, mu_p = canvas.scales["positions"].mu, canvas.scales["indicator"].mu
    shown = {one.force.name: one for one in diagrams.indicators(project)}
    assert shown["F3"].side == -shown["F5"].side
    cycle, points = project.cycle, project.study.positions.points
    for label, pressure in PRINTED.items():
        name, point = ("F5", "E") if label in ("10", "11") else ("F3", "C")
        marks = [m for m in canvas.marks if m.of == f"indicator {name}"]
        lines = [m for m in marks if isinstance(m, Line) and m.style == "thin"]
        height = points[point].value[cycle.index(label)].imag / mu_l
        lowest = min(m.a.imag for m in lines)
        bottom = points[point].value.imag.min() / mu_l
        here = [m for m in lines if abs(m.a.imag - lowest - (height - bottom)) < 1e-6]
        (curve,) = (m for m in marks if isinstance(m, Polyline))
        side = shown[name].side
        base = min(((p - here[0].a) * np.conj(side)).real for p in curve.points)
        ends = [((p - here[0].a) * np.conj(side)).real - base for p in curve.points if abs(p.imag - here[0].a.imag) < 1e-6]
        assert min(abs(end * mu_p - pressure) for end in ends) < 1e-9
        # The ordinate reaches to the higher of the two branches of this place.
        assert abs(here[0].b - here[0].a) - base == pytest.approx(max(ends), abs=1e-6)


@pytest.mark.parametrize(("mu", "refused"), [(0.1, False), (0.05, True)])
def test_a_scale_of_pressures_that_is_asked_for_is_drawn_or_refused(mu, refused):
    """6 MPa are 60 mm, or 120 mm, more than any place beside a path has; the ordinates keep inside the place of the view."""
    text = (variants() / "lugansk/engine.toml").read_text(encoding="utf-8")
    p = Project(variant.parse(f"{text}\n[scales]\nindicator = {mu}\n", "a.toml"))
    canvas, box = Canvas(), Box(25, 228, 343, 573)
    if refused:
        with pytest.raises(CannotBuild, match=r"indicator = 0\.05.* 0\.06 or more"):
            kinematics.position_plans(p, canvas, box, {})
        return
    kinematics.position_plans(p, canvas, box, {})
    assert canvas.scales["indicator"].mu == mu
    ends = [z for m in canvas.marks if m.of.startswith("indicator") and isinstance(m, Polyline) for z in m.points]
    assert max(z.real for z in ends) < box.x1
    assert min(z.real for z in ends) > box.x0


def test_no_pressure_at_all_is_drawn_at_the_scale_asked_for():
    text = re.sub(r'"[\d.]+ MPa"', '"0 MPa"', (variants() / "lugansk/engine.toml").read_text(encoding="utf-8"))
    p = Project(variant.parse(f"{text}\n[scales]\nindicator = 0.1\n", "a.toml"))
    canvas = Canvas()
    kinematics.position_plans(p, canvas, Box(25, 228, 343, 573), {})
    assert canvas.scales["indicator"].mu == 0.1
    assert diagrams.indicator_height(p, diagrams.indicators(p)) == 0.0


def quick_return():
    text = (variants() / "lugansk/shaper.toml").read_text(encoding="utf-8")
    return Project(variant.parse(re.sub(r"(?m)^#(?=[\[a-z])", "", text), "a.toml"))


@pytest.mark.parametrize("box", [Box(30, 30, 230, 90), Box(30, 30, 330, 130)])
@pytest.mark.parametrize("kind", ["engine", "quick return"])
def test_synthesis_keeps_to_its_place(project, kind, box):
    p = project if kind == "engine" else quick_return()
    canvas = Canvas()
    synthesis.sizes(p, canvas, box, {})
    assert not place(canvas, Box(0, 0, 400, 300))
    for mark in canvas.marks:
        points = text_box(mark) if isinstance(mark, Text) else flat(mark)
        assert box.x0 - 1 < points.real.min()
        assert points.real.max() < box.x1 + 1
        assert box.y0 - 1 < points.imag.min()
        assert points.imag.max() < box.y1 + 1


def test_synthesis_of_given_lengths_is_left_out():
    canvas = Canvas()
    synthesis.sizes(Project(catalogue.read("lugansk/shaper")), canvas, Box(0, 0, 200, 60), {})
    assert not canvas.marks
