"""Sheets on other paper than A1: every mark once, as large as it is, nothing over anything."""

from itertools import combinations

import numpy as np
import pytest

from tmm_sheets import __main__, catalogue
from tmm_sheets.cli.options import PAPERS
from tmm_sheets.drawing.marks import Line, Polyline, Text, flat
from tmm_sheets.drawing.paper import A1, SIDES, Paper, block, paper
from tmm_sheets.project import Project
from tmm_sheets.sheets import pages
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task.schema import PaperTable


def opened(name, **told):
    variant = catalogue.read(name)
    return Project(variant.model_copy(update={"paper": PaperTable(**told)}))


def test_formats_are_those_of_the_standard():
    assert A1 == paper("A1") == Paper("A1", 841.0, 594.0)
    assert paper("A2", True)[1:] == (420.0, 594.0)
    assert paper("A2x3")[1:] == (1261.0, 594.0)
    assert set(PaperTable.model_fields["format"].annotation.__args__) == set(PAPERS) == set(SIDES)
    for name, sides in SIDES.items():
        main, _, times = name.partition("x")
        assert not times or sides == pytest.approx((SIDES[main][1], SIDES[main][0] * int(times)), abs=2.5)


@pytest.mark.parametrize(("told", "n"), [({"format": "A2"}, 1), ({"format": "A3"}, 4), ({"orientation": "portrait"}, 3),
                                         ({"format": "A2x3"}, 1)])
def test_every_mark_is_on_one_page_as_large_as_on_the_sheet(told, n):
    project = opened("lugansk/shaper", **told)
    sheet = composed(project, n)
    drawings, said = pages.on_paper(project, n, sheet)
    wanted = paper(told.get("format", "A1"), told.get("orientation") == "portrait")
    larger = [d for d in drawings if {d.width, d.height} != set(wanted[1:])]
    assert len(said) == len(larger)
    of_sheet = [m for m in sheet.drawing.marks if m.of != "title block"]
    of_pages = [m for d in drawings for m in d.marks if m.of != "title block"]
    assert sorted(m.text for m in of_pages if isinstance(m, Text)) == sorted(m.text for m in of_sheet if isinstance(m, Text))
    curves = [sorted(round(float(np.abs(np.diff(m.points)).sum()), 6) for m in marks if isinstance(m, Polyline))
              for marks in (of_sheet, of_pages)]
    assert curves[0] == curves[1]
    assert sum(len(d.dimensions) for d in drawings) == len(sheet.drawing.dimensions)
    for k, d in enumerate(drawings):
        own = Paper("", d.width, d.height)
        whole = [view for view in d.views if view.spans and view.box != own.outline]
        assert {i for view in whole for a, b in view.spans for i in range(a, b)} == {
            i for i, m in enumerate(d.marks) if m.of != "title block"}
        z = np.concatenate([flat(m) for m in d.marks if m.of != "title block"])
        assert all(own.frame.contains(p) for p in z.tolist())
        closed = block("1" if k == 0 else "2a", own)._asdict(), own.designation._asdict()
        for box in closed:
            inside = (z.real > box["x0"]) & (z.real < box["x1"]) & (z.imag > box["y0"]) & (z.imag < box["y1"])
            assert not inside.any()
        for dimension in d.dimensions:
            assert any(isinstance(m, Line) and min(abs(m.a - dimension.a), abs(m.b - dimension.a)) < 40
                       for m in d.marks[dimension.first:dimension.end]) or dimension.kind == "angle"


def test_what_does_not_touch_does_not_meet():
    project = opened("lugansk/shaper", format="A2")
    page = pages.pages_of(list(pages.pieces_of(composed(project, 1))), paper("A2"), "1")[0]
    for (a, by), (b, other) in combinations(page.placed, 2):
        assert not pages.near(a.ink.moved(by), b.ink.moved(other), pages.APART - 1e-3)


def test_pages_are_even_and_begin_as_the_sheet_does():
    project = opened("lugansk/shaper", orientation="portrait")
    upright = paper("A1", True)
    made = pages.pages_of(list(pages.pieces_of(composed(project, 1))), upright, "1")
    assert [page.paper for page in made] == [upright, upright]
    assert all(page.area > upright.width * upright.height / 3 for page in made)
    first = min(made[0].placed, key=lambda placed: placed[0].begin)
    assert all(first[0].begin < piece.begin for page in made for piece, _ in page.placed if piece is not first[0])
    corners = [piece.ink.moved(by) for piece, by in made[0].placed]
    top_left = first[0].ink.moved(first[1])
    assert top_left.x0 == min(box.x0 for box in corners)
    assert top_left.y1 == max(box.y1 for box in corners)


def test_what_stands_in_a_gap_of_another_is_on_its_page():
    project = opened("lugansk/shaper", orientation="portrait")
    made = pages.pages_of(list(pages.pieces_of(composed(project, 2))), paper("A1", True), "1")
    pieces = [(k, piece) for k, page in enumerate(made) for piece, _ in page.placed]
    among = [(a, b) for (a, one), (b, other) in combinations(pieces, 2)
             if one.ink.contains(other.ink.centre) or other.ink.contains(one.ink.centre)]
    assert among
    assert all(a == b for a, b in among)


def test_pages_are_numbered_and_told(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tmm-sheets.toml").write_text('[paper]\nformat = "A3"\n', encoding="utf-8")
    assert __main__.run(["build", "press", "--sheet", "4", "--format", "svg", "--lang", "en"]) == 0
    said = capsys.readouterr()
    made = said.out.split()
    assert [name.rpartition("/")[2] for name in made] == [f"sheet4-{k}.svg" for k in range(1, len(made) + 1)]
    assert 'view "Construction of the cam profile" is on A2: A3 has no room for its' in said.err
    first, second = ((tmp_path / name).read_text(encoding="utf-8") for name in made[:2])
    assert 'width="420mm" height="297mm"' in first or 'width="297mm" height="420mm"' in first
    assert "Developed" in first or "Drawn" in first
    assert "Drawn" not in second
    assert __main__.run(["build", "press", "--sheet", "4", "--format", "svg", "--paper", "A1"]) == 0
    assert capsys.readouterr().out.split() == ["out/press/sheet4.svg"]
    assert __main__.run(["build", "press", "--paper", "A9"]) == 2
