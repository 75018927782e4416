"""Steps become marks where their frame says."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from tmm_sheets.construction import rules
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Plan
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Arc, Fill, Line
from tmm_sheets.sheets.player import PlanFrame, play, stage

MM = Scale("μ", 0.5, "м/мм")


def plan():
    p = Plan("positions", "", "m", ("0", "1"))
    a = p.add("A", rules.GIVEN, 1 + 0j)
    b = p.add("B", rules.LAY_OFF, a, 2.0, np.array([0.0, pi / 2]))
    p.add("C", rules.ARC_ARC, a, 3.0, b, 3.0, 1.0)
    p.vector("AB", a, b)
    return p


FRAMES = {
    "plain": (PlanFrame(MM, 100 + 50j), lambda x, y: complex(100 + 2 * x, 50 + 2 * y)),
    "turned": (PlanFrame(MM, 100 + 50j, turn=pi / 2), lambda x, y: complex(100 - 2 * y, 50 + 2 * x)),
    "mirrored": (PlanFrame(MM, 100 + 50j, turn=pi, mirror=True), lambda x, y: complex(100 - 2 * x, 50 + 2 * y)),
    "two scales": (PlanFrame(MM, 100 + 50j, along=Scale("μ", 0.1, "")), lambda x, y: complex(100 + 10 * x, 50 + 2 * y)),
}


@pytest.mark.parametrize("name", FRAMES)
def test_the_frame_noted_on_the_canvas_is_that_of_the_stage(name):
    frame, truth = FRAMES[name]
    canvas = Canvas()
    s = stage(canvas, plan(), 1, frame)
    assert s.at("B") == pytest.approx(truth(1, 2))
    assert canvas.frames[s.number](1 + 2j) == pytest.approx(truth(1, 2))
    assert (canvas.frames[s.number].plan, canvas.frames[s.number].position) == ("positions", "1")


def test_helper_lines_are_played_in_order_with_their_steps():
    canvas = Canvas()
    play(stage(canvas, plan(), 1, FRAMES["plain"][0]), over=4.0, cut=1.0)
    circle, line, first, second = canvas.marks
    assert isinstance(circle, Arc)
    assert (circle.centre, circle.radius) == (pytest.approx(102 + 50j), pytest.approx(4.0))
    assert isinstance(line, Line)
    assert (line.a, line.b) == (pytest.approx(102 + 50j), pytest.approx(102 + 58j))  # 4 mm and 4 mm beyond
    assert [m.radius for m in (first, second)] == pytest.approx([6.0, 6.0])
    assert first.end - first.start == pytest.approx(2 * 1.0 / 6.0)
    assert [m.by[:4] for m in canvas.marks] == [("construction", f"positions/{step}", "1", 0) for step in "BBCC"]
    assert [m.by.name for m in canvas.marks] == ["A–B", "A–B", "A–C", "B–C"]


def test_a_plan_of_all_positions_has_one_frame_and_each_mark_its_position():
    canvas = Canvas()
    every = stage(canvas, plan(), None, FRAMES["plain"][0])
    play(every, ["B"], only="circle")
    for k in (0, 1):
        every.position(k).vector("A", "B")
        every.position(k).dot("B")
    assert len(canvas.frames) == 1
    assert [(type(m), m.by.role, m.by.position) for m in canvas.marks] == [
        (Arc, "construction", ""), (Line, "vector", "0"), (Fill, "vector", "0"), (Fill, "point", "0"),
        (Line, "vector", "1"), (Fill, "vector", "1"), (Fill, "point", "1")]  # fmt: skip
    assert {m.by.name for m in canvas.marks if m.by.role == "vector"} == {"A–B"}


def test_what_cannot_be_built_leaves_no_lines_and_letters_know_their_step():
    p = plan()
    p.add("D", rules.ARC_ARC, p["A"], 0.1, p["B"], 0.1, 1.0)
    canvas = Canvas()
    s = stage(canvas, p, 0, FRAMES["plain"][0])
    play(s, ["D"])
    s.letters("B", "B_0", gap=2.0)
    assert not canvas.marks
    (label,) = canvas.labels
    assert (label.anchor, label.text, label.gap, label.by.step) == (pytest.approx(106 + 50j), "B_0", 2.0, "positions/B")
