"""The files: what their readers find in them, the same bytes twice, and what is told when something is missing."""

import io
import re
import subprocess
import sys
import zipfile
from dataclasses import replace

import pytest

from tests.note.opened import composed, opened
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.note import composing, note as writing
from tmm_sheets.note.document import Contents, Heading, Sheet
from tmm_sheets.project import Project
from tmm_sheets.task import variant

pypdfium2 = pytest.importorskip("pypdfium2")


@pytest.fixture(scope="module")
def cam():
    """Both files of a small project."""
    pytest.importorskip("typst")
    pytest.importorskip("docx")
    return writing.write(opened("lugansk/cam_rocker"), ("pdf", "docx"))


def pages(data):
    pdf = pypdfium2.PdfDocument(data)
    return [pdf[i].get_textpage().get_text_range() for i in range(len(pdf))]


def test_the_same_bytes_twice(cam):
    again = writing.write(opened("lugansk/cam_rocker"), ("pdf", "docx"))
    assert again.files == cam.files


def test_contents_and_abstract_tell_the_true_pages(cam):
    found = pages(cam.files["note.pdf"])
    assert len(found) == cam.pages + 1  # the last one is no part of the note
    assert f"Записка, {cam.pages}" in found[1].replace("\xa0", " ").replace("\r\n", " ")
    contents = next(t for t in found if "Содержание" in t)
    for title in ("Заключение", "Список использованной литературы"):
        page = int(re.search(rf"{title}[ .\u2060\xad]*(\d+)", contents.replace("\r\n", " "))[1])
        assert title in found[page - 1]


def test_shaper_is_as_long_as_the_manuals_want(note, printed):
    _, data, places = printed
    assert 30 <= places["pages"] <= 48
    # Each has its page in the contents, of Word's file too: also the remarks on the manual, which have no number.
    assert len(places["headings"]) == sum(isinstance(b, Heading | Sheet) for b in note.blocks())
    assert data.startswith(b"%PDF")


def test_the_word_file_has_fields_equations_and_headings(cam):
    archive = zipfile.ZipFile(io.BytesIO(cam.files["note.docx"]))
    text = archive.read("word/document.xml").decode()
    assert len(re.findall("<m:oMath ", text)) > 40 or len(re.findall("<m:oMath>", text)) > 40
    for field in ("TOC ", "PAGEREF ", "SEQ figure", "SEQ table", "REF "):
        assert field in text
    marks = set(re.findall(r'w:bookmarkStart [^>]*w:name="([^"]+)"', text))
    assert set(re.findall(r"(?:REF|PAGEREF) (\w+)", text)) <= marks
    assert 'w:val="Heading1"' in text
    footers = [archive.read(n).decode() for n in archive.namelist() if "footer" in n]
    assert any(" PAGE " in f for f in footers)
    assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_the_short_way_of_frames_has_three_pages_and_two(cam):
    """Manual 003; in Word they are those of whole sections, without an empty page before."""
    import docx

    from tmm_sheets.note import docx_writer, typst_writer

    note = composed(opened("lugansk/cam_rocker"))
    front = sorted(note.front, key=lambda b: not isinstance(b, Contents))  # as 003 has it
    note = replace(note, front=tuple(front), frame=replace(note.frame, short=True))
    note, data, places = typst_writer.render(note)
    assert [n for n, text in enumerate(pages(data), 1) if note.frame.words["doc"] in text] == [2, 3, 4, cam.pages - 1, cam.pages]
    word = docx.Document(io.BytesIO(docx_writer.render(composing.counted(note, places["pages"]), places)))
    assert [len(s.footer.tables) for s in word.sections] == [0, 1, 1, 0, 1]
    assert word.sections[1].bottom_margin.mm == pytest.approx(48, abs=0.1)  # form 2: the contents are page 2


@pytest.mark.parametrize(("key", "first"), [('manual = "003"', "contents"), ('manual = "002"', "task"), ("", "abstract")])
def test_the_order_is_that_of_the_manual_named_and_not_of_the_name(key, first):
    text = catalogue.read("transport/press@05-ЭПС-123").text
    text = text.replace('manual = "003"', key).replace('name = "transport/press@05-ЭПС-123"', 'name = "own"', 1)
    front, sections = composing.order_of(Project(variant.parse(text, "own.toml")))
    assert front[0] == first
    names = [s["template"] for s in sections]
    assert (names.index("flywheel") < names.index("forces")) is (first == "task")


def test_an_unknown_manual_is_told():
    text = catalogue.read("transport/press@05-ЭПС-123").text.replace('manual = "003"', 'manual = "03"')
    with pytest.raises(BadInput, match=r'own\.toml:\d+: note\.manual: unknown manual, .*: "03"; did you mean "003"'):
        variant.parse(text, "own.toml")


def test_with_note_the_numbers_of_the_sheets_run_on(tmp_path, capsys):
    pytest.importorskip("typst")
    assert run(["build", "lugansk/cam_rocker", "--with-note", "--format", "pdf", "-o", str(tmp_path)]) == 0
    note = pages((tmp_path / "note.pdf").read_bytes())
    sheet = next(i for i, t in enumerate(note, 1) if "ПРИЛОЖЕНИЕ 1" in t)
    drawn = pages((tmp_path / "sheet1.pdf").read_bytes())[0].replace("\r\n", " ").split()
    assert str(sheet) in drawn


def test_a_missing_package_is_told_and_nothing_written(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(writing, "find_spec", lambda name: None)
    assert run(["note", "lugansk/cam_flat", "-o", str(tmp_path / "x")]) == 1
    told = capsys.readouterr().err
    assert "typst" in told
    assert "pip install" in told
    assert not (tmp_path / "x").exists()


@pytest.mark.parametrize(("arguments", "told"), [
    (["--format", "odt"], "'odt' is not one of pdf, docx"),
    (["-o", "/dev/null/x"], "/dev/null"),
])  # fmt: skip
def test_wrong_usage_is_told(arguments, told, capsys):
    pytest.importorskip("typst")
    assert run(["note", "lugansk/cam_flat", *arguments]) == 2
    assert told in capsys.readouterr().err


def test_a_language_without_templates_is_told():
    from tmm_sheets.note import phrases

    with pytest.raises(CannotBuild, match="there are no templates of the note in the language") as told:
        phrases.folder("eo")
    assert "en, ru, uk" in str(told.value)


def test_a_wrong_template_is_told_with_its_line(monkeypatch):
    from tmm_sheets.note import phrases

    real = phrases.text_of
    wrong = {"cam": "\n{nonsense}\n"}
    monkeypatch.setattr(phrases, "text_of", lambda language, name: real(language, name) + wrong.get(name, ""))
    with pytest.raises(BadInput, match=r'cam\.txt:\d+: there is no field "nonsense"'):
        composed(opened("lugansk/cam_flat"))


def test_the_command_waits_for_neither_package():
    code = "import sys, tmm_sheets.cli; sys.exit(any(m in sys.modules for m in ('typst', 'docx', 'numpy')))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize(("right", "wrong", "told"), [
    ('"STIX Two Text"', '"Nosuch"', "unknown font family: nosuch"),
    ("#let middle(b) =", "#let middle(b =", "failed to compile document: unclosed delimiter"),
])  # fmt: skip
def test_a_wrong_preamble_is_told(note, tmp_path, monkeypatch, right, wrong, told):
    pytest.importorskip("typst")
    from tmm_sheets.note import typst_writer

    real = typst_writer.template
    changed = tmp_path / "preamble.typ"
    changed.write_text(real("note/preamble.typ").read_text(encoding="utf-8").replace(right, wrong), encoding="utf-8")
    monkeypatch.setattr(typst_writer, "template", lambda name: changed if name == "note/preamble.typ" else real(name))
    with pytest.raises(BadInput, match=rf"preamble\.typ: {told}"):
        typst_writer.render(note)
