"""Marks of a sheet put together to what a drawer sees."""

import re

import numpy as np
import pytest

from tests.few import few
from tmm_sheets.box import Box
from tmm_sheets.catalogue import read
from tmm_sheets.compare.elements import dashed, elements, interruptions, known_sheet, said, sampled, views
from tmm_sheets.drawing.canvas import Canvas, hatch_polygon
from tmm_sheets.drawing.ink import strokes
from tmm_sheets.drawing.marks import Drawing, Fill, Text
from tmm_sheets.drawing.placing import place
from tmm_sheets.project import Project
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.composing import views_of
from tmm_sheets.sheets.sheet import composed

PAPER = Box(0, 0, 200, 100)


def sheet_of(canvas):
    canvas.begin(PAPER, "", "labels")
    place(canvas, PAPER)
    drawing = Drawing(200, 100, "t", tuple(canvas.marks), views=views_of(canvas))
    return Composed(drawing, canvas.scales, (), tuple(canvas.parts), tuple(canvas.groups),
                    frames=tuple(canvas.frames))


def canvas_of(draw="plans"):
    canvas = Canvas(of=draw)
    canvas.begin(PAPER, "", draw)
    return canvas


def only(canvas):
    found = elements(sheet_of(canvas))
    assert len(found) == 1
    return found[0]


def test_an_arrow_is_one_line_to_its_tip():
    canvas = canvas_of()
    canvas.arrow(10 + 10j, 40 + 50j, "vector")
    arrow = only(canvas)
    assert (arrow.kind, arrow.style, arrow.number, arrow.arrow) == ("line", "vector", 1, True)
    assert arrow.points == pytest.approx(np.array([10 + 10j, 40 + 50j]))
    assert arrow.length == pytest.approx(50.0)
    assert arrow.middle == pytest.approx(25 + 30j)


@pytest.mark.parametrize("length", [30.0, 6.0])
def test_a_dimension_is_its_line_two_extension_lines_and_a_number(length):
    canvas = canvas_of()
    canvas.dimension(20 + 20j, 20 + length + 20j, 10.0, "30")
    assert [e.kind for e in elements(sheet_of(canvas))] == ["line", "line", "line", "text"]
    line = elements(sheet_of(canvas))[2]
    outside = 7.0 if length < 10 else 0.0  # short ones have their heads outside, with a stroke of two heads' length
    assert sorted(line.points.real) == pytest.approx([20 - outside, 20 + length + outside])
    assert set(line.points.imag) == {30.0}


def test_a_dashed_line_is_one_element_and_its_ink_the_strokes():
    canvas = canvas_of()
    canvas.line(10 + 10j, 110 + 10j, "hidden")
    line = only(canvas)
    assert line.points == pytest.approx(np.array([10 + 10j, 110 + 10j]))
    assert len(dashed(line)) == len(list(strokes(line.marks))) > 10
    ink = sum(abs(p[-1] - p[0]) for p in dashed(line))
    assert 0.6 * line.length < ink < 0.85 * line.length  # 4 mm dash, 1.5 mm gap


def test_a_path_on_a_straight_line_is_a_line():
    canvas = canvas_of()
    canvas.polyline(50 + 50j + np.exp(0.3j) * 20 * np.sin(np.linspace(0, 2 * np.pi, 181)))
    line = only(canvas)
    assert line.kind == "line"
    assert line.length == pytest.approx(40.0)


@pytest.mark.parametrize(("gaps", "there"), [((), []), (((0.125, 0.25),), [(0.75, 1.0)]),
                                             (((0.0, 0.05), (0.7, 0.75)), [(0.5, 0.6), (0.0, 0.1)])])
def test_gaps_of_a_path_there_and_back_are_told_by_their_places(gaps, there):
    """From the middle to the right end, to the left one and back: a share of the path is none of the line."""
    canvas = canvas_of()
    canvas.polyline(np.array([50, 70, 30, 50]) + 50j)
    canvas.marks[-1] = canvas.marks[-1]._replace(gaps=gaps)
    line = only(canvas)
    assert [pair for gap in interruptions(line) for pair in gap] == pytest.approx([x for gap in there for x in gap])


def test_curve_circle_arc_dot_hatch():
    canvas = canvas_of()
    canvas.polyline([10, 20 + 5j, 30, 40 + 5j], "curve")
    canvas.polyline([10, 20, 20 + 5j, 10 + 5j], "main", closed=True)
    canvas.circle(50 + 50j, 5.0)
    canvas.arc(50 + 50j, 7.0, 0.0, 1.0)
    canvas.dot(60 + 60j)
    canvas.hatch(10 + 10j, 40 + 10j)
    hatch_polygon(canvas, np.array([100, 130, 130 + 20j, 100 + 20j]) + 50j)
    found = elements(sheet_of(canvas))
    assert [e.kind for e in found] == ["curve", "curve", "circle", "arc", "circle", "hatch", "hatch"]
    assert found[1].points[0] == found[1].points[-1]
    assert (found[2].centre, found[2].radius) == (50 + 50j, 5.0)
    assert found[2].length == pytest.approx(10 * np.pi, rel=1e-3)
    assert found[3].points[[0, -1]] == pytest.approx(50 + 50j + 7 * np.exp([0, 1j]))
    assert found[4].centre == pytest.approx(60 + 60j)
    assert found[4].radius == pytest.approx(0.7)
    assert len(found[5].pieces) == 12
    z = found[6].points
    assert (z.real.min(), z.real.max(), z.imag.min(), z.imag.max()) == pytest.approx((100, 130, 50, 70), abs=3.0)


def test_lettering_with_its_indices_bars_and_leader_is_one_text():
    canvas = canvas_of()
    canvas.text(20 + 20j, "F̅_{21}^τ = 5", 5.0)
    canvas.fill([60 + 60j, 100 + 60j, 100 + 90j, 60 + 90j])
    canvas.label(80 + 75j, "S_3", leader=True)
    text, _, label = elements(sheet_of(canvas))
    assert (text.kind, text.text, text.name, text.height) == ("text", "F21τ = 5", "F21τ = 5", 5.0)
    assert text.points[0].real == pytest.approx(20.0)
    assert text.points[0].imag < 20.0 < 25.0 < text.points[2].imag  # index below, bar above
    assert (label.text, len(label.pieces)) == ("S3", 1)  # nothing free near: a leader line


def test_steps_name_lines_and_circles():
    canvas = canvas_of()
    plans, plan = canvas.placed("positions", "", 0j, 1.0), canvas.placed("velocities", "3", 0j, 1.0)
    canvas.tracing("link", "positions/AB", "3", plans, "A–B").line(10 + 10j, 50 + 10j)
    canvas.tracing("symbol", "positions/S3", "3", plans).circle(90 + 40j, 1.6)
    pen = canvas.tracing("vector", "velocities/b", "3", plan, "p–b")
    pen.arrow(10 + 80j, 90 + 80j)
    pen.label(50 + 80j, "V̅_B")  # lettering names nothing
    canvas.tracing("construction", "lever/h F̅_{43}").line(10 + 85j, 90 + 85j)
    canvas.line(10 + 90j, 90 + 90j)
    assert [e.name for e in elements(sheet_of(canvas)) if e.kind != "text"] == ["A–B(3)", "S3(3)", "p–b", "h F43", ""]


def test_views_have_their_titles_and_their_labels():
    canvas = canvas_of("one.view")
    canvas.line(1 + 1j, 9 + 9j)
    canvas.title(PAPER, "График J^пр(φ_1)")
    canvas.label(9 + 9j, "A")
    canvas.begin(PAPER, "", "unused.view")
    canvas.begin(PAPER, "", "other.view")
    canvas.title(PAPER, "График J^пр(φ_1)")
    canvas.begin(PAPER, "", "third.view")
    canvas.line(30 + 1j, 39 + 9j)
    sheet = sheet_of(canvas)
    assert [v.name for v in views(sheet)] == ["График Jпр(φ1)", "График Jпр(φ1), 2", "third.view"]
    by_view = [(e.view.n, e.kind) for e in elements(sheet)]
    assert by_view == [(0, "line"), (0, "text"), (1, "text"), (2, "line"), (0, "text")]


def test_sampled_has_normals_to_the_left():
    z, n = sampled(np.array([0, 3, 3, 3 + 4j]), 0.5)
    assert np.abs(np.diff(z)).max() <= 0.5 + 1e-12
    assert abs(np.diff(z)).sum() == pytest.approx(7.0, abs=0.6)  # corners are cut by less than a step
    assert n[0] == 1j
    assert n[-1] == -1


def test_said():
    assert said("M_{пр}^Д\\_1") == "MпрД_1"


@pytest.mark.parametrize(("project", "n"), [("lugansk/shaper", 1), ("lugansk/shaper", 3), ("press", 4)])
def test_every_mark_once(project, n):
    sheet = composed(Project(read(project)), n)
    found = elements(sheet)
    assert [e.number for e in found] == list(range(1, len(found) + 1))
    who = {id(m) for form in sheet.drawing.forms for own in form.fields for m in sheet.drawing.marks[own.first:own.end]
           if re.match("designation|developed|checked|supervisor|institution|group", own.name)}
    compared = [m for m in sheet.drawing.marks if id(m) not in who]  # everybody's own texts are no elements
    assert len(who) > 3
    assert sorted(id(m) for e in found for m in e.marks) == sorted(map(id, compared))
    assert all(np.isfinite(e.points).all() for e in found)
    texts = "".join(m.text for m in compared if isinstance(m, Text))
    assert sum(len(e.text) for e in found) == len(texts)
    assert sum(len(e.fills) for e in found) == sum(isinstance(m, Fill) for m in sheet.drawing.marks)
    for view in views(sheet):
        mine = [e for e in found if e.view == view]
        assert mine
        if view.n:
            # Leader lines and letters may reach a little beyond; the two graphs of sliding share lines.
            draw = {p.draw for p in sheet.parts if p.box == view.box}
            boxes = [p.box.inset(-12) for p in sheet.parts if p.draw in draw]
            inside = [any(b.contains(e.middle) for b in boxes) for e in mine]
            assert np.mean(inside) > 0.95, view


def test_views_of_the_shaper():
    names = [v.name for v in views(composed(Project(read("lugansk/shaper")), 1))]
    assert names[:5] == ["Рамка и основная надпись", "Планы положений механизма", "План ускорений (положение 2)",
                         "Структура механизма", "Планы скоростей"]  # fmt: skip
    assert "План скоростей, положение 7" in names
    assert len(set(names)) == len(names)


def test_the_last_part_of_a_view_keeps_its_title_when_the_same_is_drawn_again():
    names = [v.name for v in views(composed(Project(read("sixbar/3:1")), 1))]
    first = names.index("Группа Ассура 4–5 (4-й вид)")
    assert names[first:first + 7] == ["Группа Ассура 4–5 (4-й вид)", "Уравнения моментов", "План сил группы 4–5",
                                      "Группа Ассура 2–3 (3-й вид)", "Уравнения моментов, 2", "План сил звена 2",
                                      "План сил звена 3"]


@pytest.mark.parametrize("name", few(("lugansk/shaper", "press", "transport/diesel@01-Т-27"), "lugansk/shaper"))
def test_no_view_is_told_by_the_name_of_what_draws_it(name):
    """Views without a title on the sheet have one for the reader, never "kinematics.velocity_tables"."""
    project = Project(read(name))
    for n in range(1, len(project.variant.sheets) + 1):
        assert [v.name for v in views(composed(project, n)) if "." in v.name] == []


def test_the_scale_factor_of_a_view_is_that_of_the_plans_in_it():
    """Not a number that stands under its title: of a roller's radius 6,93 mm, of the ordinates of a graph."""
    shaper = Project(read("lugansk/shaper"))
    mu = {v.name: v.mu for n in (1, 2, 3, 4) for v in views(composed(shaper, n))}
    assert mu["План ускорений (положение 2)"] == 0.02
    assert mu["План скоростей, положение 7"] == 0.02  # printed once, over all ten of them
    assert mu["План сил звена 4"] == 25.0
    assert mu["Выбор радиуса ролика"] == 0.0001
    assert mu["Картина зацепления"] == 0.00025
    assert mu["Графики работ"] is None  # 10 J/mm upwards only
    assert mu["Структура механизма"] is None


def test_elements_are_called_by_the_letters_of_their_steps():
    names = {e.name for e in known_sheet(Project(read("lugansk/shaper")), 3).elements if e.kind != "text"}
    assert {"φα1", "θ1", "ρf"} <= names  # steps phi1, theta1, rho
    assert not names & {"phi1", "theta1", "rho"}
