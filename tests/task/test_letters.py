"""Names in letters of other alphabets: lettered, or told with line and field."""

import unicodedata

import numpy as np
import pytest
import shapely

from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import glyph, letter, plain
from tmm_sheets.drawing.marks import Text
from tmm_sheets.drawing.paper import block, draw_frame
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant

CAM = catalogue.read("lugansk/cam_flat").text
KAZAKH = "ӘәҒғҚқҢңӨөҰұҮүҺһІі"
SLAVONIC = "ЎўІіЇїЄєҐґЁёЂђЃѓЅѕЈјЉљЊњЋћЌќЏџ"
LATIN = [chr(c) for c in (*range(0xC0, 0x180), 0x218, 0x219, 0x21A, 0x21B) if chr(c).isalpha()]
TWINS = "ĐÐ ĸк ŢȚ ţț ЅS ѕs ЈJ јj һh ҮY ІI іi ЇÏ їï ЁË ёë"
MARKED = [c for c in LATIN if unicodedata.combining(unicodedata.normalize("NFD", c)[-1]) == 230
          and c not in "ďĽľťģ"]  # these have a comma beside or above


def project(old, new):
    assert old in CAM, old
    return variant.parse(CAM.replace(old, new, 1), "my.toml")


def test_letters_are_there_and_keep_to_their_lines():
    for char in [*KAZAKH, *SLAVONIC, *LATIN]:
        g = glyph(char)
        assert g.strokes, char
        assert g.top <= 1.35, char  # an accent over a capital is lower than the foot of the line above, 1.7 higher and 0.3 deep
        assert g.bottom >= -0.31, char
        assert 0 < g.advance < 1.3, char


def test_letters_differ():
    """A letter is not its neighbour's or its base's drawing by mistake; few are drawn alike by rights."""
    alike = {frozenset(pair) for pair in TWINS.split()}
    seen = {}
    for char in dict.fromkeys([*KAZAKH, *SLAVONIC, *LATIN, *"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyzк"]):
        seen.setdefault(b"".join(np.round(s, 6).tobytes() for s in glyph(char).strokes), []).append(char)
    twins = {frozenset(chars) for chars in seen.values() if len(chars) > 1}
    assert twins <= alike


def test_accents_do_not_touch_their_letters():
    """Between the pens' edges there is air: the strokes fall into parts at least 0.4 of a stroke apart, the accent on top."""
    for char in MARKED:
        lines = [shapely.LineString(np.column_stack((s.real, s.imag))) for s in glyph(char).strokes]
        parts = sorted(shapely.unary_union(shapely.buffer(lines, 0.05)).geoms, key=lambda p: p.bounds[1])
        letter_top = parts[0].bounds[3]
        above = [p for p in parts[1:] if p.bounds[1] > letter_top - 1e-6]
        assert above, char
        assert all(p.distance(parts[0]) >= 0.04 for p in above), char
        # over the middle of the letter, seen along the slope
        middle = np.mean([p.centroid.x - glyph_slant() * p.centroid.y for p in above])
        left, right = (f(np.concatenate([s.real - glyph_slant() * s.imag for s in glyph(char).strokes])) for f in (np.min, np.max))
        assert left - 0.01 <= middle <= right + 0.01, char


def glyph_slant():
    from tmm_sheets.drawing.lettering import slant

    return slant()


@pytest.mark.parametrize(("old", "new", "field", "said"), [
    ('title = "Кулачок', 'title = "漢 Кулачок', "project.title", 'no "漢" (U+6F22 CJK'),
    ('[title_block]\n', '[title_block]\nstudent = "Ким 😀"\n', "title_block.student", "U+1F600 GRINNING FACE"),
    ('[title_block]\n', '[title_block]\nstudent = "\\u0007Ким"\n', "title_block.student", "no (U+0007)"),
    ('[title_block]\n', '[title_block]\nstudent = "\\u0305Ким"\n', "title_block.student", "COMBINING OVERLINE"),
    ('[title_block]\n', '[title_block]\nstudent = "Ы\u0303"\n', "title_block.student", "COMBINING TILDE"),
    ('designation = "', 'designation = "ش', "title_block.designation", "ARABIC LETTER SHEEN"),
])  # fmt: skip
def test_lacking_letter_is_told(old, new, field, said, tmp_path, capsys):
    text = CAM.replace("student", "# student", 1) if "student" in new else CAM
    assert old in text
    file = tmp_path / "my.toml"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(BadInput) as e:
        variant.read(file)
    (problem,) = e.value.problems
    assert problem.field == field
    assert said in problem.message
    assert problem.line == next(i for i, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1)
                                if line.startswith(field.rpartition(".")[2]))  # fmt: skip
    for command in ("check", "build", "show"):
        assert run([command, str(file), *(["-o", str(tmp_path / "out")] if command == "build" else [])]) == 2
        assert "internal error" not in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_what_only_lists_show_may_be_anything():
    assert project('variant = "', 'variant = "漢').project.variant.startswith("漢")


@pytest.mark.parametrize("written", ["Йо\u00adсип\u200b\u00a0Ко", "И\u0306осип Ко", "Йосип\\u200b\\u00a0Ко",
                                     "\ufeffЙосип\u2009Ко\u2060", "Йосип\\nКо", "Йосип\\tКо"])  # fmt: skip
def test_invisible_signs_leave_the_name(written):
    found = project('title = "Кулачок', f'title = "{written} Кулачок')
    assert found.project.title.startswith("Йосип Ко Кулачок")
    assert found.data["project"]["title"] == found.project.title


def test_title_block_in_other_alphabets(tmp_path, capsys):
    names = {"student": "Łukasz Žižka", "checker": "Ёжи Ўладзімір", "supervisor": "Ångström", "institution": "Қазақ ұлттық"}
    text = CAM
    for key, name in names.items():
        text = "\n".join(line for line in text.split("\n") if not line.startswith(f"{key} ="))
        text = text.replace("[title_block]\n", f'[title_block]\n{key} = "{name}"\n')
    file = tmp_path / "my.toml"
    file.write_text(unicodedata.normalize("NFD", text), encoding="utf-8")
    assert run(["build", str(file), "--format", "dxf,pdf,svg,hpgl", "-o", str(tmp_path / "out")]) == 0, capsys.readouterr().err
    assert "Žižka" in (tmp_path / "out" / "sheet1.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["Öztürk", "Йосипов", "Ёлкин", "Žižka", "Ångström"])
def test_marks_over_capitals_stay_in_their_cell(name):
    """Rows of names are 5 mm high: the ink stays off the lines above and below."""
    canvas = Canvas()
    draw_frame(canvas, {"developed": name, "designation": name, "project": name, "institution": name}, "1", 1, 1)
    place = block("1")
    set_ = [m for m in canvas.marks if isinstance(m, Text) and m.text == name and m.angle == 0]
    assert len(set_) == 4
    row = Box(place.x0 + 17, place.y0 + 25, place.x0 + 40, place.y0 + 30)
    (mark,) = [m for m in set_ if row.x0 < m.at.real < row.x1]
    laid = letter(plain(name), mark.height)
    assert mark.at.imag + laid.ascent < row.y1 - 0.15
    assert mark.height == 2.5
