"""A whole group from a table: who has which task, what each student gets, what of it is handed in."""

import csv
import re
import shutil
import sys
import zipfile
from datetime import time
from pathlib import Path

import openpyxl
import pytest

from tmm_sheets import catalogue, csv_tables
from tmm_sheets.__main__ import run
from tmm_sheets.compare import group
from tmm_sheets.compare.measured import measured_lengths
from tmm_sheets.errors import BadInput, Stopped
from tmm_sheets.output import batch, roster
from tmm_sheets.task import title_entries


def read(folder, text, task=""):
    path = folder / "group.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return roster.read(path, task)


@pytest.mark.parametrize("text", [
    "student,group,task,variant\nA,G,3,2\n", "\ufeffВариант;ФИО;№;Группа;Задание\r\n2;A;1;G;3\r\n;;;;\r\n",
    "Прізвище\tГрупа\tЗавдання\nA\tG\tsixbar/3:2\n", "\n\nПІБ;група;варіант\n A ;G;3:2\n", "student,group,task\nA,G,3:2\n",
    "студент;группа;задание\nA;G;sixbar/3:2".encode("cp1251"), "ПІБ студента;Номер группы;№ завдання;№ варіанта\nA;G;3;2\n",
    "Студент;Группа студента;Задание;Вариант\nA;G;sixbar/3;2\n", "cтyдeнт;group;task;variant\nA;G;sixbar;3:2\n",
    "student;group;task;variant\nA;G;sixbar/3:1;2\n",
])
def test_tables_as_people_write_them(text, tmp_path):
    assert read(tmp_path, text) == [roster.Enrolled("A", "G", "sixbar/3:2", "A")]


def test_ciphers_and_files(tmp_path):
    (tmp_path / "own.toml").write_text("", encoding="utf-8")
    (one,) = read(tmp_path, "student;шифр\nЮ/Я;01-Т-27", "transport/diesel")
    assert (one.project, one.folder) == ("transport/diesel@01-Т-27", "Ю-Я")
    for machine in ("diesel", "дизель", "Дизель", "transport/diesel"):
        assert read(tmp_path, f"student;задание;вариант\nЮ/Я;{machine};01-Т-27") == [one]
    assert one.renamed == "Ю/Я: the folder is called Ю-Я"
    with pytest.raises(BadInput, match=r"task: lugansk/shaper has no variants"):
        read(tmp_path, "student;task;variant\nA;lugansk/shaper;2")
    with pytest.raises(BadInput, match=r'"куліса" may be several\n +sixbar/1, .* or sixbar/10'):
        read(tmp_path, "student;task\nA;куліса")
    with pytest.raises(BadInput, match=r"group.csv:2: task: .*own.toml:1"):
        read(tmp_path, "student;task\nA;own.toml")


def test_every_problem_is_told(tmp_path):
    with pytest.raises(BadInput) as e:
        read(tmp_path, "student;task;cipher\nA;press;\na;press;\nB;;\n/;press;\nC;presss;\nD;;01-Т-27\n")
    found = [(p.line, p.field) for p in e.value.problems]
    assert found == [(3, "student"), (4, "task"), (5, "student"), (6, "task"), (7, "cipher")]


@pytest.mark.parametrize(("text", "said"), [
    ("", "expected a header"), ("student;task\n", "has no students"), ("a;b\nA;press\n", "column student"),
    ("student\nA", "--task"), ("student;task;project\nA;press;press", "two columns"), (b"\x00\x01\xff" * 50, "not a text file"),
])
def test_tables_that_are_none(text, said, tmp_path):
    with pytest.raises(BadInput, match=said):
        read(tmp_path, text)


def test_a_group_is_made_and_handed_in(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    table = tmp_path / "group.csv"
    table.write_text("student;group;task\nШевченко;ТМ-21;lugansk/cam_flat\n", encoding="utf-8")
    assert run(["roster", str(table), "-o", "works", "--format", "dxf,svg", "--jobs", "1"]) == 0
    assert ["Шевченко", "ТМ-21", "lugansk/cam_flat", "2", "+", "+", "+"] in [
        line.split() for line in capsys.readouterr().out.splitlines()]
    folder = tmp_path / "works" / "Шевченко"
    assert {"sheet1.svg", "OFL.txt", "note.pdf", "measured.csv", "page.html"} <= {path.name for path in folder.iterdir()}
    with pytest.raises(BadInput, match="nothing to compare"):
        group.works_by_student(tmp_path / "works")  # nobody has filled anything in
    measured = folder / measured_lengths.NAME
    lines = measured.read_text("utf-8-sig").splitlines()
    at = next(k for k, line in enumerate(lines) if line.endswith(","))
    lines[at] += "10"
    measured.write_text("\n".join(lines), encoding="utf-8")
    assert group.works_by_student(tmp_path / "works")["Шевченко"].handed_in == [measured]
    assert run(["roster", str(table), "-o", "works", "--format", "svg", "--jobs", "1"]) == 0
    assert measured.read_text("utf-8") == "\n".join(lines)
    assert run(["compare", "press", "--group", "works", "-o", "reports"]) == 0
    told = capsys.readouterr().out
    assert "1 of " in told
    assert "not compared" not in told  # fonts, sheets and settings are no work of a student
    monkeypatch.chdir(folder)
    shutil.copy("sheet1.dxf", tmp_path / "drawn.dxf")
    entries = title_entries.given({}).entries(catalogue.read("lugansk/cam_flat"))
    assert [(entries[key].text, entries[key].where) for key in ("student", "group")] == [
        ("Шевченко", "tmm-sheets.toml:5"), ("ТМ-21", "tmm-sheets.toml:4")]
    monkeypatch.chdir(tmp_path)
    assert run(["compare", "lugansk/cam_flat", "--dxf", "drawn.dxf", "-o", "own"]) == 0
    assert ", 0 amber, 0 red; 0 extra" in capsys.readouterr().out  # whose sheet it is has no part in it


def test_who_is_told_to_stop_says_how_to_go_on(tmp_path, monkeypatch, capsys):
    """What was made is whole and listed; the rest is made by the same command."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own").mkdir()
    (tmp_path / "own/my.toml").write_text(catalogue.read("lugansk/cam_flat").text, encoding="utf-8")
    (tmp_path / "group.csv").write_text("student;task\nA;lugansk/cam_flat\nB;own/my.toml\n", encoding="utf-8")
    whole = batch.carry_out

    def stopped(works, *rest):
        yield from whole(works[:1], *rest)
        raise Stopped(2)

    monkeypatch.setattr(batch, "carry_out", stopped)
    command = ["roster", "group.csv", "-o", "works", "--format", "svg", "--jobs", "1", "--lang", "en"]
    assert run(command) == 130
    said = capsys.readouterr()
    assert said.err.splitlines()[-1] == "stopped, 1 of 2 projects left; the same command goes on from there"
    made = {path.relative_to(tmp_path / "works").as_posix() for path in (tmp_path / "works").rglob("*") if path.is_file()}
    assert {"made.csv", "projects.toml", "A/note.pdf", "A/sheet1.svg"} <= made
    assert not any(name.startswith("B/") or name.endswith((".part", ".tmp")) for name in made)
    assert 'B" = "../own/my.toml"' in (tmp_path / "works/projects.toml").read_text("utf-8")


def test_families_of_a_department(tmp_path, monkeypatch):
    """A machine for all with a cipher for each, in whichever column, as its family writes it."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(Path(__file__).parents[2] / "docs/examples/department", tmp_path / "department")
    for text in ("student;cipher\nA;27", "student;variant\nA;27", "student;cipher\nA;department/pump@27"):
        assert read(tmp_path, text, "department/pump")[0].project == "department/pump@27"
    family = tmp_path / "department/family.toml"
    family.write_text(f'separator = ":"\n{family.read_text("utf-8")}', encoding="utf-8")
    assert read(tmp_path, "student;variant\nA;27", "department/pump")[0].project == "department/pump:27"


def test_namesakes_and_names_that_windows_keeps(tmp_path):
    found = read(tmp_path, "student;group;task\nA;G1;press\na;G2;press\nCON;G1;press\ncom1.x;G1;press\nConrad I.;G1;press\n")
    assert [s.folder for s in found] == ["A (G1)", "a (G2)", "CON_", "com1_.x", "Conrad I"]
    assert [s.renamed for s in found if s.renamed] == [f"{name}: the folder is called {folder}" for name, folder in (
        ("CON", "CON_"), ("com1.x", "com1_.x"))]


def test_a_spreadsheet_computes_nothing_of_what_is_written():
    """DDE, sums and numbers of names: an apostrophe makes them texts; dashes and words stay."""
    cells = ["=cmd|' /C calc'!A0", "+1", "@SUM(1)", "-2", " =1", "\t=1", "＝1", "–", "+", "-", "", "ТМ-21", "A+1"]
    (row,) = csv.reader(csv_tables.written([cells]).decode("utf-8-sig").splitlines(), delimiter=";")
    assert row == [*(f"'{cell}" for cell in cells[:7]), *cells[7:]]


def test_a_workbook_is_read_as_the_table_that_it_shows(tmp_path, monkeypatch):
    """Spreadsheets take 3:2 for a time of the day and 3 for 3.0."""
    book = openpyxl.Workbook()
    for row in (["ПІБ студента", "Група", "Завдання", "Варіант"], [], ["A", "G", 3.0, 2], ["B", None, time(3, 2), None]):
        book.active.append(row)
    path = tmp_path / "group.xlsx"
    book.save(path)
    assert [(s.student, s.group, s.project) for s in roster.read(path)] == [("A", "G", "sixbar/3:2"), ("B", "", "sixbar/3:2")]
    # As programs write that have no styles.
    with zipfile.ZipFile(path) as whole, zipfile.ZipFile(tmp_path / "bare.xlsx", "w") as bare:
        for name in whole.namelist():
            bare.writestr(name, re.sub(rb"<cellStyles.*?</cellStyles>", b"", whole.read(name)))
    assert roster.read(tmp_path / "bare.xlsx") == roster.read(path)
    path.write_bytes(path.read_bytes()[:300])
    with pytest.raises(BadInput, match=r"group.xlsx: cannot be read as a workbook"):
        roster.read(path)
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(BadInput, match=r"(?s)openpyxl, which is not installed.*pip.* install "):
        roster.read(path)
