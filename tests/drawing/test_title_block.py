import json
from math import pi

import numpy as np
import pytest

from tmm_sheets import catalogue, words
from tmm_sheets.__main__ import run
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter, plain
from tmm_sheets.drawing.marks import Line, Polyline, Text
from tmm_sheets.drawing.paper import A1, FIELDS, block, draw_frame
from tmm_sheets.project import Project
from tmm_sheets.resources import template
from tmm_sheets.sheets import composing

FORMS = json.loads(template("title_blocks.json").read_text(encoding="utf-8"))
FILLED = {
    "designation": "ТММ.КП.01.00.000 Д1", "title": "Кинематическое и силовое исследование", "project": "Строгальный станок",
    "letter": "У", "developed": "Иванов", "checked": "Петров", "supervisor": "Сидоров", "norm_control": "Ким", "approved": "Ли",
    "institution": "Кафедра ТММ", "group": "Гр. ___",
}  # fmt: skip


def drawn(form="1", number=1, count=4, **changes):
    canvas = Canvas()
    draw_frame(canvas, FILLED | changes, form, number, count)
    return canvas.marks


def texts(marks):
    return {m.text: m for m in marks if isinstance(m, Text)}


@pytest.mark.parametrize("form", ["1", "2a"])
def test_cells_tile_the_block(form):
    w, h = FORMS[form]["size"]
    covered = np.zeros((h, w), dtype=int)
    for *_, x0, y0, x1, y1 in FORMS[form]["cells"]:
        covered[y0:y1, x0:x1] += 1
    assert (covered == 1).all()


@pytest.mark.parametrize("form", ["1", "2a"])
def test_lines_are_the_edges_of_the_cells_each_once(form):
    edges, lines = set(), []
    for *_, x0, y0, x1, y1 in FORMS[form]["cells"]:
        edges |= {(x, y, x + 1, y) for x in range(x0, x1) for y in (y0, y1)}
        edges |= {(x, y, x, y + 1) for y in range(y0, y1) for x in (x0, x1)}
    for x0, y0, x1, y1 in FORMS[form]["thick"] + FORMS[form]["thin"]:
        lines += [(x, y0, x + 1, y0) for x in range(x0, x1)] + [(x0, y, x0, y + 1) for y in range(y0, y1)]
    assert sorted(lines) == sorted(edges)


def test_frame_leaves_20_and_5_5_5():
    outline, frame = (m for m in drawn() if isinstance(m, Polyline) and len(m.points) == 4 and abs(m.points[0]) < 30)
    assert outline.style == "thin"
    assert outline.closed
    assert outline.points == pytest.approx(np.array([0, 841, 841 + 594j, 594j]), abs=0.15)
    assert all(A1.outline.contains(p, -0.1) for p in outline.points)  # all of the thin line lies on the paper
    assert frame.style == "main"
    assert (frame.points[0], frame.points[2]) == (20 + 5j, (841 - 5) + (594 - 5) * 1j)
    assert (block("1").x1, block("1").y0, block("1").width, block("1").height) == (836, 5, 185, 55)
    assert (A1.designation.x0, A1.designation.y1, A1.designation.width, A1.designation.height) == (20, 589, 70, 14)


def test_thick_and_thin_lines_of_form_1():
    lines = {(m.a - (651 + 5j), m.b - (651 + 5j)): m.style for m in drawn() if isinstance(m, Line)}
    assert lines[65 + 40j, 185 + 40j] == "main"
    assert lines[17 + 0j, 17 + 55j] == "main"
    assert lines[135 + 20j, 185 + 20j] == "main"
    assert lines[0 + 5j, 65 + 5j] == "thin"
    assert lines[140 + 20j, 140 + 35j] == "thin"
    assert sum(s == "thin" for s in lines.values()) == 10


@pytest.mark.parametrize(("form", "number"), [("1", 1), ("2a", 3)])
def test_lettering_stays_within_the_cells(form, number):
    marks = drawn(form, number, title="Синтез зубчатого зацепления и планетарного редуктора поперечно-строгального станка " * 2,
                  checked="Петров-Водкин Константин Сергеевич", designation="ТММ.КП.2024.МС-31.00.00.000.000.000.000 Д1",
                  institution="Луганский национальный университет имени Владимира Даля, кафедра ТММ")  # fmt: skip
    place = block(form)
    cells = [(place.x0 + a, place.y0 + b, place.x0 + c, place.y0 + d) for *_, a, b, c, d in FORMS[form]["cells"]]
    inside = [m for m in marks if isinstance(m, Text) and m.angle == 0 and m.at.imag > A1.frame.y0]
    assert len(inside) > 5
    for m in inside:
        laid = letter(plain(m.text), m.height)
        x0, x1, y0, y1 = m.at.real, m.at.real + m.wide * laid.width, m.at.imag, m.at.imag + m.height
        assert any(a < x0 and x1 < c and b < y0 and y1 < d for a, b, c, d in cells), m
    for a in inside:
        for b in inside:
            if a is not b and abs(a.at.imag - b.at.imag) < 1.2 * min(a.height, b.height):
                wide = a.wide * letter(plain(a.text), a.height).width
                assert not a.at.real <= b.at.real < a.at.real + wide


def test_fields_stand_where_the_standard_wants_them():
    marks = drawn(number=2)
    found = texts(marks)
    x, y = 651, 5
    assert found["Иванов"].at.imag - y == pytest.approx(27.5, abs=2)  # Разраб.: the upper row
    assert found["Сидоров"].at.imag - y == pytest.approx(12.5, abs=2)  # the free row, with its role
    assert found["Рук."].at.imag - y == pytest.approx(12.5, abs=2)
    assert found["Ли"].at.imag - y == pytest.approx(2.5, abs=2)
    assert 135 < found["У"].at.real - x < 140  # the left one of three
    assert found["Строгальный станок"].height >= 3.5
    assert 155 < found["2"].at.real + 0 - x + 20 < 175  # field 7
    assert 165 < found["4"].at.real - x < 185  # field 8
    assert found["Гр. ___"].at.imag < found["Кафедра ТММ"].at.imag
    assert sum(m.text == "–" for m in marks if isinstance(m, Text)) == 2  # mass and scale
    assert found["Копировал"].at.imag < 5
    assert found["Формат А1"].at.imag > 0


def test_designation_is_repeated_upside_down():
    upright, turned = sorted((m for m in drawn() if isinstance(m, Text) and m.text == FILLED["designation"]), key=lambda m: m.angle)
    assert (upright.height, upright.angle) == (7.0, 0.0)
    assert turned.angle == pi
    laid = letter(plain(turned.text), turned.height)
    assert A1.designation.contains(turned.at, -0.5)
    assert A1.designation.contains(turned.at - complex(laid.width, turned.height), -0.5)


def test_single_sheet_has_no_number():
    assert "1" in texts(drawn(number=1, count=2))
    assert [m.text for m in drawn(number=1, count=1) if isinstance(m, Text) and m.text == "1"] == ["1"]  # Листов 1 only


def test_unknown_form_and_field_are_named():
    with pytest.raises(ValueError, match=r"'3' is not in .*1, 2a"):
        drawn("3")
    with pytest.raises(ValueError, match=r"unknown: colour; known are .*designation"):
        drawn(colour="red")
    assert set(FILLED) <= FIELDS
    assert (A1.width, A1.height) == (841, 594)


LONG = {"title": "Синтез зубчатого зацепления и планетарного редуктора поперечно-строгального станка " * 3,
        "checked": "Петров-Водкин-Константинопольский", "project": "Сверхдлинноеназваниебезпробелов" * 4}  # fmt: skip


@pytest.mark.parametrize("language", ["ru", "uk", "en"])
@pytest.mark.parametrize("changes", [{}, LONG], ids=["usual", "long"])
@pytest.mark.parametrize("form", ["1", "2a"])
def test_only_letter_heights_of_the_standard_and_none_unreadable(form, changes, language):
    """GOST 2.304, 2: 2.5, 3.5, 5, 7 ...; a text that does not fit in 2.5 mm ends in dots and is told."""
    canvas = Canvas()
    with words.on_paper(language):
        draw_frame(canvas, FILLED | changes, form, 1, 4)
    assert {m.height for m in canvas.marks if isinstance(m, Text)} <= {2.5, 3.5, 5.0, 7.0}
    assert set(canvas.shortened) == (set(LONG.values()) if changes and form == "1" else set())  # 2a has the designation only


@pytest.mark.parametrize(("name", "short"), [
    ("Иванов И. И.", "Иванов И. И."), ("Петренко А. И.", "Петренко А.И."), ("А. Б. Щербак", "А. Б. Щербак"),
    ("Иванов Иван Иванович", "Иванов И.И."),
    ("Mykhailo Kovalenko", "M. Kovalenko"), ("Гончаренко В. О.", "Гончаренко В. О."), ("", ""),
    ("Гончаренко Валентин Олегович", "Гончаренко В.О."), ('Гончаренко Валентин "Валя" (О.)', "Гончаренко В.В.О."),
    ("Преображенская А. В.", "Преображенская А. В."), ("Константинопольский-Задунайский В. О.", "Константинопольский... В.О."),
])
def test_a_long_name_keeps_its_initials_and_tells_what_its_surname_lacks(name, short):
    canvas = Canvas()
    draw_frame(canvas, FILLED | {"developed": name}, "1", 1, 4)
    written = {m.text for m in canvas.marks if isinstance(m, Text)}
    assert (short in written) == bool(short)
    assert canvas.shortened == ({name: short} if "..." in short else {})
    (mark,) = [m for m in canvas.marks if isinstance(m, Text) and m.text == short] or [None]
    width = letter(plain(short), 2.5).width
    assert not name or 0.5 <= mark.wide <= min(1.0, 21.6 / width + 1e-9)
    assert not name or mark.wide > min(1.0, 21.6 / width) - 0.05  # no narrower than it has to be


def test_check_tells_what_the_title_block_leaves_out(tmp_path, capsys):
    file = tmp_path / "own.toml"
    file.write_text('''schema = 1
[project]
name = "own"
title = "Own"
[title_block]
student = "Преображенский-Задунайский Ж. Щ."
supervisor = "Ли И. И."
[gear]
teeth = [14, 28]
module = "5 mm"
pressure_angle = "20 deg"
shift = "rule"
''', encoding="utf-8")
    assert run(["--lang", "en", "check", str(file)]) == 0
    assert capsys.readouterr().err == (
        f'{file}: the title block has no room for all of "Преображенский-Задунайский Ж. Щ.": '
        '"Преображенский-Зад... Ж.Щ." stands there\n')


def test_a_designation_is_whole_or_not_there_and_the_letter_is_as_written():
    """Д1 alone is no designation; У in Ukrainian is no Н."""
    whole, none = catalogue.read("lugansk/shaper"), catalogue.read("tests/projects/pump.toml")
    with words.on_paper("uk"):
        assert composing.entries(Project(whole), 1) | {"designation": "ТММ.КП.01.00.000 Д1", "letter": "У"} == composing.entries(
            Project(whole), 1)
        assert composing.entries(Project(none), 1)["designation"] == ""
