"""Pages put together again give the sheet."""

import numpy as np
import pytest

from tmm_sheets.drawing.marks import Box, Drawing, Line, Polyline, Text, bounds
from tmm_sheets.drawing.paper import BAR, MARGIN, PAPERS, tiles, with_bar, without_outline

SHEET = Drawing(841, 594, "Лист_1 ^", ())


@pytest.mark.parametrize(("paper", "overlap", "grid"), [("a4", 10, (3, 5)), ("a3", 10, (2, 4)), ("a4", 0, (3, 5))])
def test_number_of_pages(paper, overlap, grid):
    rows, columns = grid
    made = tiles(SHEET, paper, overlap)
    assert [(t.row, t.column) for t in made] == [(r, c) for r in range(1, rows + 1) for c in range(1, columns + 1)]
    assert {(t.page.width, t.page.height) for t in made} == {PAPERS[paper]}


@pytest.mark.parametrize("paper", ["a4", "a3"])
@pytest.mark.parametrize("overlap", [0, 10, 33.3])
def test_every_place_of_the_sheet_is_on_a_page_within_its_margins(paper, overlap):
    made = tiles(SHEET, paper, overlap)
    rng = np.random.default_rng(2)
    for p in rng.uniform(0, 841, 400) + 1j * rng.uniform(0, 594, 400):
        seen = [t for t in made if t.part.contains(p)]
        assert seen
        for t in seen:
            assert Box(0, 0, *PAPERS[paper]).inset(MARGIN).contains(p + t.shift, 1e-9)


def test_neighbours_share_the_overlap_and_its_line_lies_on_the_edge_of_the_next():
    made = {(t.row, t.column): t for t in tiles(SHEET, "a4", 12)}
    a, right, below = made[1, 1], made[1, 2], made[2, 1]
    assert a.part.x1 - right.part.x0 == pytest.approx(12)
    assert below.part.y1 - a.part.y0 == pytest.approx(12)
    lines = [m for m in a.page.marks if isinstance(m, Line) and m.style == "twodot"]
    assert sorted((m.a - a.shift).real for m in lines if m.a.real == m.b.real) == pytest.approx([right.part.x0])
    assert sorted((m.a - a.shift).imag for m in lines if m.a.imag == m.b.imag) == pytest.approx([below.part.y1])
    last = made[3, 5]
    assert not [m for m in last.page.marks if isinstance(m, Line) and m.style == "twodot"]


def test_crop_marks_point_at_the_corners_from_outside():
    area = Box(0, 0, 210, 297).inset(MARGIN)
    marks = [m for m in tiles(SHEET, "a4")[0].page.marks if isinstance(m, Line) and m.style == "thin"]
    assert len(marks) == 8
    for m in marks:
        assert not any(area.contains(p) for p in (m.a, m.b))
        assert min(abs(m.a - complex(x, y)) for x in (area.x0, area.x1) for y in (area.y0, area.y1)) == pytest.approx(1)


def test_pages_tell_row_and_column():
    words = ["".join(m.text for m in t.page.marks if isinstance(m, Text)) for t in tiles(SHEET, "a3")]
    assert words[4] == "Ряд 2 из 2, столбец 1 из 4. Лист_1 ^"
    long = Drawing(841, 594, "Слово " * 50, ())
    assert all(m.at.real + 1.6 * len(m.text) < 200 for t in tiles(long, "a4") for m in t.page.marks if isinstance(m, Text))


def test_the_control_bar_is_a_hundred_millimetres_on_sheet_and_page():
    for marks in (with_bar(SHEET).marks, set(tiles(SHEET, "a4", bar=True)[0].page.marks) - set(tiles(SHEET, "a4")[0].page.marks)):
        lines = [m for m in marks if isinstance(m, Line)]
        bar = max(lines, key=lambda m: abs(m.b - m.a))
        assert abs(bar.b - bar.a) == pytest.approx(BAR, abs=1e-12)
        ticks = sorted(abs((m.a + m.b) / 2 - bar.a) for m in lines if m is not bar)
        assert ticks == pytest.approx(list(range(0, 101, 10)))
    assert bounds(with_bar(SHEET).marks).x1 < 20  # outside the frame
    assert bounds(with_bar(SHEET).marks).x0 > 5


def test_outline_is_the_line_round_the_paper_and_nothing_else():
    def rectangle(inset):
        box = Box(0, 0, 841, 594).inset(*inset)
        return Polyline(np.array([complex(x, y) for x in (box.x0, box.x1) for y in (box.y0, box.y1)]), "thin", True)

    frame, line = rectangle((20, 5, 5, 5)), Line(0j, 841 + 0j, "thin")
    sheet = Drawing(841, 594, "", (rectangle((0.1,)), frame, line))
    assert without_outline(sheet).marks == (frame, line)


def test_overlap_must_leave_something():
    for overlap in (-1, 96, float("nan")):
        with pytest.raises(ValueError, match="expected an overlap from 0 to 95 mm for A4"):
            tiles(SHEET, "a4", overlap)
