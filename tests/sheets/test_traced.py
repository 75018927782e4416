"""Every line, arc and curve of a view knows the step that left it, and lies where that step says."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from tests.few import few
from tests.sheets import traced
from tmm_sheets.catalogue import read
from tmm_sheets.construction.rules import GIVEN
from tmm_sheets.construction.step import Plan
from tmm_sheets.drawing.marks import Arc, Fill, Line, PlacedFrame, Polyline, Text
from tmm_sheets.project import Project


@pytest.mark.parametrize("name", few(traced.PROJECTS, "lugansk/shaper", "transport/press@07-ЭПС-718"))
def test_marks_know_their_steps_and_lie_where_these_say(name):
    project = Project(read(name))
    sheets = traced.drawn(project, traced.DONE)
    total = sum(traced.count(sheets.values(), traced.DONE).values(), Counter())
    assert total["known"] >= 0.95 * total.total() > 200
    checked, wrong = traced.untrue(project, sheets)
    assert not wrong
    assert min(checked[role] for role in ("point", "vector", "construction", "link")) > 20
    assert checked["curve"] >= 9
    assert checked["detail"] >= (20 if name.startswith("transport") else 0)


@pytest.fixture(scope="module")
def shaper():
    project = Project(read("lugansk/shaper"))
    return project, traced.drawn(project, ("flywheel", "gears", "cams"))


@pytest.mark.parametrize(("role", "step", "other"), [
    ("curve", "total-work/points", "work/A(φ)"), ("curve", "gear-sliding-between/theta1", "gear-sliding-between/theta2"),
    ("curve", "gear-tooth-1/flank", "gear-tooth-2/flank"), ("point", "cam-profile/B", "cam-profile/N"),
    ("construction", "gear-engagement/rb1", "gear-engagement/rb2"), ("curve", "cam-profile-between/α", "cam-profile-between/OA")])
def test_a_mark_of_a_graph_that_tells_a_wrong_step_is_found(shaper, role, step, other):
    project, sheets = shaper
    n, sheet = next((n, sheet) for n, sheet in sheets.items() if any(m.by and m.by.step == step for m in sheet.drawing.marks))
    marks = list(sheet.drawing.marks)
    mine = [i for i, m in enumerate(marks) if m.by and m.by[:2] == (role, step) and not isinstance(m, Text)]
    i = mine[len(mine) // 2]  # all points of a profile lie on the circle r0 where the cam dwells
    marks[i] = marks[i]._replace(by=marks[i].by._replace(step=other))
    changed = replace(sheet, drawing=replace(sheet.drawing, marks=tuple(marks)))
    assert len(traced.untrue(project, {n: changed})[1]) == 1


@pytest.fixture(scope="module")
def press():
    project = Project(read("press"))
    return project, traced.drawn(project, ("linkage",))


@pytest.mark.parametrize("role", ["point", "vector", "construction"])
def test_a_mark_that_tells_a_wrong_step_is_found(press, role):
    project, sheets = press
    n, sheet = next(iter(sheets.items()))
    marks = list(sheet.drawing.marks)
    mine = [i for i, m in enumerate(marks) if m.by and m.by.role == role and m.by.frame >= 0 and not isinstance(m, Text)
            and m.by.step.startswith("velocities/") and (role == "point") == isinstance(m, Fill)]
    i = mine[-1]  # the pole's dot is the first
    other = next(marks[k].by.step for k in mine if marks[k].by.step != marks[i].by.step)
    marks[i] = marks[i]._replace(by=marks[i].by._replace(step=other))
    changed = replace(sheet, drawing=replace(sheet.drawing, marks=tuple(marks)))
    assert len(traced.untrue(project, {n: changed})[1]) == 1


@pytest.mark.parametrize(("mark", "off"), [
    (Line(90 + 60j, 110 + 60j, "vector"), 0.0), (Line(90 + 61j, 110 + 61j, "vector"), 1.0),
    (Arc(100 + 60j, 2.0, 0.0, 1.0, "thin"), 0.0), (Arc(103 + 60j, 2.0, 0.0, 1.0, "thin"), 3.0),
    (Polyline(np.array([100 + 60j, 101 + 60j]), "thin"), np.inf),
    (Fill(np.array([100 + 61j, 100 + 59j, 101 + 60j, 99 + 60j]), "vector"), 0.0),
    (Fill(np.array([103 + 60j, 104 + 60j, 104 + 61j, 103 + 61j]), "thin"), 3.0),
    (Fill(np.array([104 + 60j, 104 + 62j, 106 + 62j, 106 + 60j]), "vector"), 4.0)])
def test_what_a_detail_shows_lies_where_its_step_says(mark, off):
    plan = Plan("plan", "", "mm")
    step = plan.add("b", GIVEN, 20 + 10j)
    assert traced.enlarged(mark, step, 0, PlacedFrame(0, "plan", "", 0j, (0.2, 1 / 6)), {}) == pytest.approx(off)
