"""Types and widths of lines in CAD drawings: right ones pass however they are made, wrong ones are told by views."""

import random
import re
from dataclasses import replace

import numpy as np
import pytest

from tests.compare.cad_plants import Way, covered, draw
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_drawing, cad_file, cad_report
from tmm_sheets.compare.cad.cad_ink import of_dashes, of_strokes
from tmm_sheets.compare.elements import dashed, elements
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

PROJECT = Project(read("lugansk/cam_flat"))


def setup_module():
    """Composed when the first of these tests runs: every worker imports this file."""
    global EXACT, MAIN, THIN, CENTRE, SPOILED
    EXACT = elements(composed(PROJECT, 1))
    MAIN, THIN, CENTRE = some("main", "line", 15)[:2], some("thin", "line", 20)[:2], some("centre", "line", 70)[:2]
    SPOILED = {  # style they are drawn in, and what is said of it
        MAIN[0]: ("thin", "drawn thin, 0.25 mm, where main lines are 0.7 mm"),
        MAIN[1]: ("thin", "drawn thin, 0.25 mm, where main lines are 0.7 mm"),
        THIN[0]: ("main", "drawn thick, 0.7 mm, where 0.23 to 0.35 mm would be thin"),
        THIN[1]: ("hidden", "drawn dashed instead of continuous"),
        CENTRE[0]: ("thin", "drawn continuous instead of dash-dot"),
        CENTRE[1]: ("twodot", "drawn dash-two-dots instead of dash-dot"),
    }


def compared(found, tmp_path, looks=True, **way):
    path = tmp_path / "student.dxf"
    path.write_bytes(draw(list(found), Way(looks=looks, **way), random.Random(1)))
    return cad_drawing.examine(PROJECT, range(1, 2), cad_file.read(path))


def some(style, kind, length):
    """Elements under no others: what lies there can have been drawn for nothing else."""
    return [e for e in EXACT if e.view.n and e.style == style and e.kind == kind and e.length > length and not e.fills
            and covered(e.points, e.number, EXACT) < 0.2]


@pytest.mark.trial
def test_right_types_and_widths(tmp_path):
    found = compared(EXACT, tmp_path, turn=0.002j, unit=6, block=True)
    assert found.outcome.looks == ()
    assert found.outcome.notes == ()


def test_dashes_drawn_one_by_one(tmp_path):
    patterned = [e for e in EXACT if line_type(e.style).pattern]
    parts = [replace(e, number=-1, points=p, kind="curve", style="thin") for e in patterned for p in dashed(e)]
    found = compared([e for e in EXACT if e not in patterned] + parts, tmp_path)
    assert found.outcome.looks == ()
    assert {f.verdict for f in found.outcome.findings} == {"green"}


def test_what_is_wrong_is_told_in_a_row_for_each_view_and_kind(tmp_path):
    found = compared([replace(e, style=SPOILED[e][0]) if e in SPOILED else e for e in EXACT], tmp_path)
    looks = found.outcome.looks
    assert {(n, look.view.name, look.what) for look in looks for n in look.elements} == {
        (e.number, e.view.name, said) for e, (_, said) in SPOILED.items()}
    assert len(looks) == len({(e.view, said) for e, (_, said) in SPOILED.items()})
    assert {f.verdict for f in found.outcome.findings} == {"green"}
    report = cad_report.report("cam", tmp_path / "student.dxf", found)
    text, tree = report.text, report.tree
    assert all(said in text for _, said in SPOILED.values())
    assert "; 6 of another type or width of line" in text
    rows = [f for f in tree["findings"] if f["code"] in ("line-style", "line-width")]
    assert len(rows) == len(looks)
    row = next(row for row in rows if row["numbers"] == [CENTRE[1].number])
    assert row["code"] == "line-style"
    (named,) = row["entities"]
    (space,) = cad_file.read(tmp_path / "student.dxf").spaces
    assert [e.pattern for e in space.entities if e.handle == named["handle"]] == ["dash-two-dots"]


@pytest.mark.trial
def test_a_wrong_line_that_is_out_of_place_too(tmp_path):
    line = THIN[0]
    found = compared([replace(e, points=e.points + 2j * np.exp(1j * np.angle(np.diff(e.points)[0])), style="main")
                      if e.number == line.number else e for e in EXACT], tmp_path)
    assert [f.element.number for f in found.outcome.findings if f.verdict == "red"] == [line.number]
    assert [look.elements for look in found.outcome.looks] == [(line.number,)]


def test_a_drawing_without_types_and_widths_gets_one_remark_of_each(tmp_path):
    found = compared(EXACT, tmp_path, looks=False)
    (look,) = found.outcome.looks
    assert (look.view, look.what) == (None, "drawn continuous, as everything in the drawing")
    assert {e.number for e in CENTRE} <= set(look.elements)
    assert [n for n in found.notes if "no line has a width of its own" in n] == list(found.outcome.notes)


def test_a_scale_of_line_types_that_was_not_set_gets_a_remark(tmp_path):
    path = tmp_path / "student.dxf"
    data = draw(list(EXACT), Way(looks=True), random.Random(1))
    path.write_bytes(re.sub(rb"(\$LTSCALE\s+40\s+)4\.0", rb"\g<1>0.2", data))
    found = cad_drawing.examine(PROJECT, range(1, 2), cad_file.read(path))
    assert found.outcome.looks == ()
    (note,) = found.notes
    assert note == "dash-dot lines have strokes of 0.635 mm: GOST 2.303 asks for 5 to 30 mm (scale of line types, LTSCALE)"


@pytest.mark.trial
def test_main_lines_that_are_not_wider_get_one_remark(tmp_path):
    found = compared([replace(e, style="thin") if e.style in ("main", "curve", "vector") else e for e in EXACT], tmp_path)
    assert found.outcome.looks == ()
    assert "main lines (0.25 mm) are not wider than thin ones (0.25 mm)" in found.outcome.notes[0]


@pytest.mark.parametrize(("dashes", "pattern"), [
    ([], "continuous"), ([5], "continuous"), ([4, -1.5], "dashed"), ([16, -2, 1, -2], "dash-dot"), ([-2, 1, -2, 16], "dash-dot"),
    ([0.5, -0.25, 0, -0.25], "dash-dot"), ([17, -1.4, 0.9, -1.4, 0.9, -1.4], "dash-two-dots"), ([0, -1], "other"),
    ([12, -3, 12, -3, 0, -3], "dash-dot"), ([10, -1, 1, -1, 1, -1, 1, -1], "other"),
])  # fmt: skip
def test_classes_of_patterns(dashes, pattern):
    assert of_dashes(dashes) == pattern


@pytest.mark.parametrize(("strokes", "pattern"), [
    ([(0, 100)], "continuous"), ([(0, 10), (50, 100)], None), ([(0, 4), (6, 10), (12, 16), (18, 22), (24, 100)], "dashed"),
    ([(0, 16), (18, 19), (21, 37), (39, 40), (42, 58), (60, 61), (63, 100)], "dash-dot"),
    ([(0, 16), (18, 19), (21, 22), (24, 40), (42, 43), (45, 46), (48, 100)], "dash-two-dots"),
])  # fmt: skip
def test_classes_of_strokes(strokes, pattern):
    assert of_strokes(strokes, 100) == pattern
