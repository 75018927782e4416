"""Views keep their places: shipped projects, mechanisms of a user's own of several shapes, and what is said where one cannot."""

from dataclasses import replace

import numpy as np
import pytest

from tests.few import few, seldom
from tests.project_files import EVEN, FOUR_BAR, MOMENT, SLIDER, merged, project, write
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.marks import Arc, Fill, Line, Polyline, Text, flat
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets import composing as sheets
from tmm_sheets.sheets.composing import BESIDE, INSIDE, TITLE_BLOCK, TOUCH, leaving
from tmm_sheets.sheets.composition import arranged
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import arrangement


def masses(distance, angle):
    """Masses of the links, that of the coupler in a point M of its own."""
    point = {"name": "M", "link": "2", "from": "A", "towards": "B", "distance": f"{distance} m", "angle": f"{angle} deg"}
    return {"point": [point],
            "link": [{"name": "1", "mass": "4 kg", "centre": "O", "inertia": "0.05 kg m2"},
                     {"name": "2", "mass": "9 kg", "centre": "M", "inertia": "0.14 kg m2"},
                     {"name": "3", "mass": "5 kg", "centre": "B"}]}


def slider(height, turn, rod):
    guide = {"through": ["0 m", f"{height} m"], "direction": f"{turn} deg"}
    return merged(SLIDER, {"guide[1]": guide, "group[1].length": f"{rod} m"})


SHAPES = {
    "coupler point near": (FOUR_BAR, 0.3, 25),
    "coupler point far outside": (FOUR_BAR, 0.9, 70),
    "coupler point behind": (FOUR_BAR, 0.7, -150),
    "long and thin": (slider(height=0.02, turn=0, rod=1.5), 0.7, 0),
    "tall": (slider(height=0.0, turn=90, rod=0.9), 0.4, 5),
    "slider far away": (slider(height=-0.3, turn=-20, rod=4.0), 2.0, 5),
}


@pytest.mark.parametrize("shape", few(SHAPES, "coupler point behind", "tall"))
def test_mechanisms_of_every_shape_keep_their_places(shape):
    mechanism, *place = SHAPES[shape]
    for position in (0, 6):
        opened = project(mechanism, EVEN, MOMENT, masses(*place), {"cycle.force_position": str(position)})
        done = composed(opened, 1)
        assert not done.leaving
        assert not done.crowded
        view = next(v for v in arranged(opened, 1).views if v.draw == "kinetics.lever")
        lever = next(i for i, part in enumerate(done.parts) if part.title.startswith("Рычаг"))
        end = done.parts[lever + 1].first
        ink = np.concatenate([flat(mark) for mark in done.drawing.marks[done.parts[lever].first:end] if not isinstance(mark, Text)])
        assert view.box.x0 < ink.real.min()
        assert ink.real.max() < view.box.x1
        assert view.box.y0 < ink.imag.min()
        # Under the heading of two lines.
        assert ink.imag.max() < view.box.y1 - 13.0


@pytest.mark.parametrize(("name", "n"), [
    ("lugansk/engine", 1), ("lugansk/engine", 2), ("lugansk/shaper", 1), ("lugansk/shaper", 2), ("press", 1),
    seldom("sixbar/5:1", 1)])
def test_shipped_sheets_keep_their_places(name, n):
    done = composed(Project(catalogue.read(name)), n)
    assert not done.leaving
    assert not done.crowded


def at_position(name, position):
    task = catalogue.read(name)
    return Project(task.model_copy(update={"cycle": task.cycle.model_copy(update={"force_position": position})}))


def test_a_steep_tangent_stays_within_its_graph():
    """The graph of inertia of task 4:1 at position 8, near its zero: 59 degrees, 26 mm to both sides would cross the frame."""
    done = composed(at_position("sixbar/4:1", "8"), 2)
    assert not done.leaving
    inked = [mark for mark in done.drawing.marks if mark.of != "title block" and not isinstance(mark, Text)]
    assert min(float(flat(mark).imag.min()) for mark in inked) > INSIDE.y0


# --- what is said ------------------------------------------------------------------------------------------------------

VIEW = Box(100.0, 100.0, 200.0, 200.0)


def drawn(draw, beside=None):
    """What is said of a view that has drawn something."""
    canvas = Canvas()
    canvas.begin(VIEW, "", "module.view")
    canvas.scales["plan"] = Scale("μ_l", 0.004, "м/мм")
    canvas.chosen.add("plan")
    canvas.title(VIEW._replace(x1=150.0) if beside else VIEW, "План_{1}")
    draw(canvas)
    if beside:
        canvas.title(VIEW._replace(x0=150.0), beside)
    canvas.begin(INSIDE, "", "labels")
    place(canvas, INSIDE)
    return leaving(canvas, INSIDE, TITLE_BLOCK)


def test_what_keeps_its_place_is_not_told():
    assert not drawn(lambda canvas: canvas.line(101 + 150j, 199 + 150j))
    assert not drawn(lambda canvas: canvas.line(VIEW.x0 - TOUCH + 0.01 + 150j, 199 + 150j))


@pytest.mark.parametrize(("b", "by", "side"), [
    (217.5 + 150j, 17.5, "at the right"), (90 + 150j, 10.0, "at the left"), (150 + 203j, 3.0, "at the top"),
    (150 + 60j, 40.0, "at the bottom")])
def test_a_line_out_of_its_box(b, by, side):
    (told,) = drawn(lambda canvas: canvas.line(150 + 150j, b))
    assert told.by == pytest.approx(by)
    assert told.side == side
    assert told.title == "План1"
    assert f'view "План1" leaves its place by {by:.1f} mm {side}' in str(told)
    assert "scales.plan = 0.005" in str(told)


def test_arcs_and_lettering_count_as_they_lie():
    (told,) = drawn(lambda canvas: canvas.circle(150 + 150j, 60.0))
    assert told.by == pytest.approx(10.0, abs=1e-3)
    (told,) = drawn(lambda canvas: canvas.text(190 + 150j, "длинное слово", 5.0))
    assert told.by > 20


def test_projection_lines_may_go_from_view_to_view_but_not_over_the_frame():
    assert not drawn(lambda canvas: canvas.line(150 + 150j, 400 + 150j, "construction"))
    (told,) = drawn(lambda canvas: canvas.line(150 + 150j, 150 + 1.8j, "construction"))
    assert told.by == pytest.approx(3.2)
    assert told.over == ", over the frame"


def test_the_title_block_is_nobodys():
    (told,) = drawn(lambda canvas: canvas.line(150 + 150j, 700 + 40j, "construction"))
    assert told.over == ", into the title block"


def test_into_the_part_beside_it():
    assert not drawn(lambda canvas: canvas.line(110 + 150j, 151 + 150j), beside="План 2")
    (told,) = drawn(lambda canvas: canvas.line(110 + 150j, 172 + 150j), beside="План 2")
    assert told.by == pytest.approx(22.0)
    assert told.over == ", into the one beside it"


def test_labels_have_the_distance_between_views():
    near = Label(195 + 150j, "abc", 3.5, 1 + 0j, 3.0)
    far = near._replace(gap=120.0)  # with room in the view it would stand there
    for label, count in ((near, 0), (far, 1)):
        assert len(drawn(lambda canvas, label=label: canvas.label(label.anchor, label.text, label.away, 3.5, label.gap))) == count
    assert BESIDE > TOUCH


def test_build_says_so_and_is_done(tmp_path, capsys, monkeypatch):
    """A lever in a place of 25 mm: the sheet is made, and what is wrong with it told."""
    path = write(tmp_path, FOUR_BAR, EVEN, MOMENT, masses(0.9, 70), {"cycle.force_position": "3"})
    plan = arrangement("kinematics_forces_wide")
    small = tuple(replace(v, box=Box(v.box.x0, v.box.y1 - 46, v.box.x0 + 25, v.box.y1)) if v.draw == "kinetics.lever" else v
                  for v in plan.views)
    monkeypatch.setattr(sheets.composition, "arranged", lambda opened, n: replace(plan, views=small))
    assert run(["build", path, "-o", str(tmp_path / "out"), "--format", "dxf"]) == 0
    told = [line for line in capsys.readouterr().err.splitlines() if "leaves its place" in line]
    assert len(told) == 1
    assert told[0].startswith(f'{path}: sheet 1: view "Рычаг Жуковского (положение 3)" leaves its place by ')
    assert "scales.lever = " in told[0]
    assert (tmp_path / "out" / "sheet1.dxf").exists()


def test_a_note_that_has_no_room_in_its_view_stands_on_free_paper_and_is_no_fault():
    canvas, box = Canvas(), Box(200.0, 200.0, 230.0, 220.0)
    canvas.begin(box, "", "kinematics.velocity_plans")
    canvas.begin(box, "Plan")
    for y in range(202, 219, 2):
        canvas.line(complex(202.0, y), complex(228.0, y))
    canvas.note(box, "point e cannot be found better than to 2.6 mm")
    canvas.begin(INSIDE, "", "labels")
    assert not place(canvas, INSIDE)
    assert any(isinstance(mark, Text) and not box.contains(mark.at) for mark in canvas.marks)
    assert leaving(canvas, INSIDE, TITLE_BLOCK) == []


def test_marks_lie_in_their_rectangles():
    """Those of lines, lettering and curves are no larger than they have to be; an arc's is that of its circle. None have none."""
    curve = np.array([1 + 2j, 5 - 3j, 4 + 9j])
    marks = [Line(3 + 4j, -1 + 8j, "main"), Text(10 + 5j, "h_1", 3.5), Text(10 + 5j, "Ag", 5.0, 1.2), Polyline(curve, "thin"),
             Fill(curve, "thin"), Arc(2 + 2j, 5.0, 0.3, 1.1, "main")]
    found = sheets.rectangles_of(marks)
    for mark, own in zip(marks[:-1], found, strict=False):
        assert own == pytest.approx(Box.around(text_box(mark) if isinstance(mark, Text) else flat(mark, 2.0)))
    assert found[-1] == pytest.approx((-3.0, -3.0, 7.0, 7.0))
    assert sheets.rectangles_of([]).shape == (0, 4)
