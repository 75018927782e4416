"""Marks of the gear and reducer sheets know their steps, and lie where these say: each is compared with the step itself."""

import numpy as np
import pytest

from tests.sheets.unlettered import unlettered
from tmm_sheets.catalogue import read
from tmm_sheets.construction.step import value_at
from tmm_sheets.drawing.marks import Arc, Fill, Line, Text
from tmm_sheets.project import Project

SHEETS = [("lugansk/shaper", 3), ("press", 3), ("transport/press@07-ЭПС-718", 3), ("transport/crusher@12-СДМ-1908", 3)]
VIEWS = ("gear.engagement", "gear.mesh", "gear-involute-1", "gear-involute-2", "gear-sliding", "gear-rack", "reducer-velocities",
         "reducer-speeds")
OTHER = {"symbol", "table", "dimension", "hatch", "text", "frame"}


@pytest.fixture(scope="module", params=SHEETS, ids=lambda s: s[0])
def drawn(request):
    name, n = request.param
    project = Project(read(name))
    sheet = unlettered(project, n)
    steps = {}
    for plans in project.plans.values():
        for plan in (plans or {}).values():
            steps |= {f"{plan.name}/{s.name}": (plan, s) for s in plan}
    return sheet, steps, [m for m in sheet.marks if m.of in VIEWS and not isinstance(m, Text)]


def test_every_mark_has_a_role(drawn):
    _, _, marks = drawn
    assert len(marks) > 200
    assert all(m.by is not None for m in marks)


def test_marks_know_step_and_frame(drawn):
    sheet, steps, marks = drawn
    asked = [m for m in marks if m.by.role not in OTHER]
    assert len(asked) > 100
    known = [m for m in asked if m.by.step in steps and m.by.frame >= 0]
    assert len(known) >= 0.95 * len(asked)
    for m in known:
        assert sheet.frames[m.by.frame].plan == m.by.step.split("/")[0]


def test_marks_lie_where_their_steps_say(drawn):
    """Points on the step's point, helper lines and circles on those of its rule, vectors end in it: 0.001 mm."""
    sheet, steps, marks = drawn
    checked = dict.fromkeys(("point", "construction", "vector"), 0)
    for m in marks:
        if m.by.role not in checked or m.by.frame < 0 or (m.by.role == "vector" and isinstance(m, Fill)):
            continue
        plan, step = steps[m.by.step]
        k = plan.labels.index(m.by.position) if m.by.position else 0
        frame, value = sheet.frames[m.by.frame], step.at(k)
        if m.by.role == "point":
            middle = (m.a + m.b) / 2 if isinstance(m, Line) else complex(np.mean(m.points))
            off = abs(middle - complex(frame(value)))
        elif m.by.role == "vector":
            off = abs(np.imag((m.b - m.a) * np.conj(complex(frame(value)) - m.a))) / abs(complex(frame(value)) - m.a)
        else:
            (helper,) = step.rule.helpers(tuple(value_at(a, k) for a in step.args), value)
            a = complex(frame(helper.a))
            if isinstance(m, Arc):
                off = max(abs(m.centre - a), abs(m.radius - abs(complex(frame(helper.a + helper.radius)) - a)))
            else:
                off = max(abs(m.a - a), abs(m.b - complex(frame(helper.b))))
        assert off < 1e-3, m
        checked[m.by.role] += 1
    assert min(checked["point"], checked["construction"]) > 10
    assert checked["vector"] or "reducer" not in "".join(steps)
