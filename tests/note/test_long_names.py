"""Names as long as a title block takes them are wrapped in any cell, in both formats."""

import io
import zipfile

import pytest

from tmm_sheets import catalogue
from tmm_sheets.__main__ import run

pytest.importorskip("typst")
pytest.importorskip("docx")
LONG = "Ж" * 200


def test_names_of_two_hundred_letters(tmp_path, capsys):
    text = catalogue.read("lugansk/cam_flat").text
    changed = text.replace('student = ""', f'student = "{LONG}"').replace('"Кулачок с плоским толкателем"', f'"{LONG}"')
    assert changed.count(LONG) == 2
    file = tmp_path / "my.toml"
    file.write_text(changed, encoding="utf-8")
    assert run(["note", str(file), "--format", "pdf,docx", "-o", str(tmp_path)]) == 0, capsys.readouterr().err
    with zipfile.ZipFile(io.BytesIO((tmp_path / "note.docx").read_bytes())) as document:
        assert document.read("word/document.xml").decode().count(LONG) >= 2
        assert LONG in document.read("docProps/core.xml").decode()
