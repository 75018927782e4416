"""Letters of what belongs together have one height."""

import pytest

from tests.few import seldom
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Line, Text
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import kinetics
from tmm_sheets.sheets.sheet import composed


def lettering(name, n):
    """Texts of a sheet and the heights of their capitals."""
    sheet = composed(Project(read(name)), n)
    runs = [[m for m in sheet.drawing.marks[g.first:g.end] if isinstance(m, Text)] for g in sheet.groups if g.kind == "lettering"]
    return [("".join(m.text for m in of), max(m.height for m in of), of[0].of) for of in runs if of]


@pytest.mark.parametrize(("name", "n"), [seldom("transport/compressor@09-В-5", 1), ("lugansk/shaper", 1), seldom("screen", 2)])
def test_the_equation_of_a_force_plan_and_its_values_are_of_one_height(name, n):
    found = {}
    for text, height, of in lettering(name, n):
        if of.startswith("force-") and (text.endswith(" = 0") or (text.startswith("F") and text.endswith(" Н"))):
            found.setdefault(of, set()).add(height)
    assert len(found) > 1
    assert all(len(heights) == 1 for heights in found.values()), found


def test_the_captions_of_the_velocity_plans_are_of_one_height():
    """Two of the pump's plans are upright lines, their places narrow."""
    heights = {height for text, height, _ in lettering("tests/projects/pump.toml", 1) if text.startswith("Положение ")}
    assert len(heights) == 1


@pytest.mark.parametrize("width", [200.0, 50.0, 36.0, 20.0])
def test_a_scale_factor_is_no_larger_than_its_title(width):
    canvas = Canvas()
    canvas.title(Box(0.0, 0.0, width, 100.0), "Acceleration polygon (position 8)", "μ_a = 2 mm")
    title, *_, factor = (m for m in canvas.marks if isinstance(m, Text) and m.height >= 2.5)
    assert factor.height <= title.height


@pytest.mark.parametrize(("name", "n"), [
    seldom("loom", 3), seldom("screen", 3), ("lugansk/shaper", 2), seldom("tests/projects/planer.toml", 2)])
def test_the_title_of_the_energy_mass_diagram_is_as_large_as_the_others_and_no_line_runs_through_it(name, n):
    drawing = composed(Project(read(name)), n).drawing
    first, *enlarged = (m for m in drawing.marks if isinstance(m, Text) and m.text.startswith("Диаграмма энергомасс"))
    upright = [(m.a.real, *sorted((m.a.imag, m.b.imag))) for m in drawing.marks if isinstance(m, Line) and m.style != "text"]
    for title in (first, *enlarged):
        assert title.height == 5.0
        box = Box.around(text_box(title))
        assert not [x for x, low, high in upright if box.x0 < x < box.x1 and low < box.y0 and high > box.y1]


@pytest.mark.parametrize(("force", "said"), [(0.0, "0"), (6.7966, "6,797"), (9.99999, "10"), (10.0, "10,0"), (9999.94, "9999,9"),
                                             (10000.0, "10000"), (106232.4, "106232")])
def test_forces_have_no_more_figures_than_can_be_believed(force, said):
    assert kinetics.newtons(force) == said


def test_a_force_plan_comes_out_smaller_rather_than_with_small_letters_in_its_equation():
    """The polygon of the press is all but a line as high as its place, the equation of eight forces has four lines."""
    project, canvas = Project(read("transport/press@07-ЭПС-743")), Canvas()
    fp, box = project.study.forces.plans["4–5"], Box(0.0, 0.0, 103.0, 169.0)
    canvas.begin(box, "", "kinetics.group")
    kinetics.force_plan_drawn(project, canvas, box, fp, project.force_index)
    lowest = min(complex(canvas.frames[-1](complex(step.at(project.force_index)))).imag
                 for step in fp.plan.steps.values() if step.rule.gives == "point")
    under = [m for m in canvas.marks if isinstance(m, Text) and m.at.imag < lowest]
    assert len({round(m.at.imag, 3) for m in under if m.height == 3.5}) == 4
    assert not [m for m in under if "=" in m.text and m.height != 3.5]


@pytest.mark.parametrize(("terms", "values", "width", "most", "lines", "height"), [
    (1, 1, 200.0, 3, 2, 3.5), (8, 4, 400.0, 3, 2, 3.5), (8, 1, 90.0, 3, 3, 3.5), (8, 4, 90.0, 4, 4, 3.5), (8, 1, 130.0, 2, 2, 2.5),
    (8, 0, 400.0, 3, 1, 3.5), (12, 4, 30.0, 3, 3, 2.5),
], ids=["one", "wide", "two lines", "room for four", "no room for three", "no value", "narrow"])  # fmt: skip
def test_an_equation_takes_more_lines_rather_than_smaller_letters(terms, values, width, most, lines, height):
    signs = [f"F̅_{{{k}0}}({k}–{k + 1})" for k in range(1, terms + 1)]
    found, size = kinetics.equation(signs, ["F_{10} = 12345,6 Н"] * values, width, most)
    assert (len(found), size) == (lines, height)
    whole = " ".join(found)
    assert whole.startswith(" + ".join(signs) + " = 0")
    assert whole.count("= 12345,6 Н") == values
    assert not any(line.startswith(("+", "=", "Н")) for line in found)
