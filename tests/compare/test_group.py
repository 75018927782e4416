"""A group's folder: who made which mistakes, what could not be judged, and marks that follow from the teacher's scheme."""

import re
from pathlib import Path
from urllib.parse import unquote

import pytest

from tmm_sheets.compare import codes, group
from tmm_sheets.compare.codes import Number, Remark
from tmm_sheets.compare.findings import FindingRecord, Report
from tmm_sheets.compare.report_pages import page
from tmm_sheets.errors import BadInput
from tmm_sheets.files import seen_from

SCHEME = """full = 100
[costs]
mistake = 10
red = 2
amber = 0.5
missing_view = 8
missing_table = 3
[at_most]
amber = 1
[[grade]]
from = 60
name = "3"
[[grade]]
from = 90
name = "5"
[[grade]]
from = 0
name = "2"
"""


SIMPLE = group.MarkingScheme(full=100, costs={"unfilled": 0.5, "missing_sheet": 20}, grade=[{"from": 50, "name": "3"}])


def scheme(tmp_path, text=SCHEME):
    path = tmp_path / "marks.toml"
    path.write_text(text, encoding="utf-8")
    return group.read_scheme(path)


def drawing(project, sheet, path):
    """Two red elements of which one is explained, three amber ones; none in a drawing called sound."""
    if "sound" in path.name:
        return Report("", {})
    off = Number("12.5" if "two" in path.name else "3.1")
    start = [FindingRecord(codes.POINT_MOVED(point="b3", distance=off), "red", "a", step="velocities/b3", whole=True),
             FindingRecord(codes.VIEW_MISSING(view="gone"), "red", "gone", whole=True),
             FindingRecord(codes.TABLE_MISSING(views="table"), "amber", "table", whole=True)]
    lost = [FindingRecord(codes.MISSING(), "red", r.view, follows=r) for r in start[1:]]
    verdicts = [("a", "red"), ("b", "red"), *[("b", "amber")] * 3]
    return Report("", {}, findings=[*start, *lost, *(FindingRecord(codes.MISSING(), x, v) for v, x in verdicts)], start=start)


@pytest.fixture
def folder(tmp_path):
    for name in ("g/One/sheet 1.dxf", "g/Two/two.dxf", "g/Three.dxf", "g/Four/picture.gif", "g/Five/sound.dxf"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"")
    (tmp_path / "g/projects.toml").write_text('"Two" = "other"\n', encoding="utf-8")
    return tmp_path / "g"


def by(**kinds):
    """Compares a file by its kind."""
    return lambda kind, *of: kinds[kind](*of)


def compared(folder, tmp_path, opened=lambda name: type("P", (), {"variant": type("V", (), {"sheets": [1, 2]})()})()):
    return group.compare(folder, "own", opened, by(dxf=drawing), scheme(tmp_path), lambda what: None)


def test_table_and_marks(folder, tmp_path):
    report = compared(folder, tmp_path)
    found = {s["student"]: s for s in report.tree["students"]}
    assert list(found) == ["Five", "Four", "One", "Three", "Two"]
    assert [found[n]["project"] for n in ("One", "Two")] == ["own", "other"]
    # 100 - 10 for the mistake, 2 for a red one besides, at most 1 for three amber ones, 8 for the view, 3 for the table.
    assert [(s["mark"], s["grade"]) for s in found.values()] == [(100, "5"), (None, None), (76, "3"), (76, "3"), (76, "3")]
    assert found["One"]["costs"] == {"mistake": 10, "red": 2, "amber": 1, "missing_view": 8, "missing_table": 3, "unjudged": 0,
                                     "unfilled": 0, "missing_sheet": 0}
    marks = next(t for t in report.story.tables if t.title == "How the marks came about")
    assert marks.rows[1] == ("One", "100", "−10", "−2", "−1 (at most, not 3 × 0.5)", "−8", "−3", "76")
    assert [row[0] for row in marks.rows] == ["Five", "One", "Three", "Two"]  # nothing of Four's could be judged
    assert "not compared" in found["Four"]["files"][0]["refused"]
    assert report.tree["most_made"] == [{"mistake": "point b3 lies … mm off", "students": 3}]
    assert "Four, picture.gif" in report.text
    assert set(report.files) == {"Five/sound.dxf.html", "One/sheet 1.dxf.html", "Three/Three.dxf.html", "Two/two.dxf.html"}
    led = re.findall(r'href="([^"]*)"', page(report, ".html", "", seen_from(Path("a/group.html"), Path("out/g"))).decode())
    assert [unquote(to) for to in led] == [f"../out/g/{name}" for name in sorted(report.files)]


def test_marks_go_by_what_was_handed_in(folder, tmp_path):
    """21 of 340 numbers, all of them right, are no good work; nor is one sheet of two. Numbers are of all sheets."""
    (folder / "Two/numbers.csv").write_bytes(b"")

    def numbers(project, sheet, path):
        return Report("", {"source": "measured", "findings": [{"measured": 1.0}] * 21, "summary": {"empty": 319}})

    def drawing(project, sheet, path):
        return Report("", {"source": "cad", "sheet": sheet or 1, "findings": []})

    opened = type("P", (), {"variant": type("V", (), {"sheets": [1, 2]})()})()
    marks = scheme(tmp_path, "full = 100\n[costs]\nunfilled = 0.5\nmissing_sheet = 20\n")
    report = group.compare(folder, "own", lambda name: opened, by(dxf=drawing, measured=numbers), marks, lambda what: None)
    found = {s["student"]: s for s in report.tree["students"]}
    assert (found["Two"]["mark"], found["Two"]["handed_in"]) == (53, "sheets 1; 21 of 340 numbers")
    assert (found["One"]["mark"], found["One"]["faults"]["missing_sheet"]) == (80, 1)
    assert found["Four"]["mark"] is None
    assert "−47 (94 × 0.5)" in report.text
    # A file alone: of the sheets that it does not show nobody knows.
    alone = [group.with_mark(of(None, 1, None), SIMPLE)
             for of in (numbers, drawing)]
    assert [(a.tree["mark"], a.tree["grade"], a.text.strip()) for a in alone] == [
        (53, "3", "mark 53 (3); without faults 100; numbers left empty, % −47 (94 × 0.5)"),
        (100, "3", "mark 100 (3); without faults 100")]


def test_a_project_file_is_seen_from_the_folder(folder, tmp_path):
    (tmp_path / "own.toml").touch()
    (folder / "projects.toml").write_text('"Two" = "../own.toml"\n"One" = "elsewhere.toml"\n', encoding="utf-8")
    asked = []
    compared(folder, tmp_path, lambda name: asked.append(name) or type("P", (), {"variant": type("V", (), {"sheets": [1]})()})())
    assert set(asked) == {"own", "elsewhere.toml", str(folder / "../own.toml")}


def test_files_of_all_kinds(folder, tmp_path):
    """Files of one name are told apart; nobody who handed in something else, or nothing, is lost."""
    for name in ("One/sheet 1.csv", "One/again/sheet 1.dxf", "Шесть и семь/план.cdw", ".git/x.dxf", "notes.txt"):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"")
    (folder / "Empty").mkdir()

    def numbers(project, sheet, path):
        start = [FindingRecord(codes.INSTEAD(measured="5", exact="4"), "red", where=Remark("", "(2) b")),
                 FindingRecord(Remark("sense", "the other way"), "red")]
        return Report("", {}, findings=start, start=start)

    opened = type("P", (), {"variant": type("V", (), {"sheets": [1, 2]})()})()
    report = group.compare(folder, "own", lambda name: opened, by(dxf=drawing, measured=numbers), scheme(tmp_path),
                           lambda what: None)
    found = {s["student"]: s for s in report.tree["students"]}
    assert found.keys() == {"Empty", "Five", "Four", "One", "Three", "Two", "Шесть и семь"}
    assert [f["file"] for f in found["One"]["files"]] == ["again/sheet 1.dxf", "sheet 1.csv", "sheet 1.dxf"]
    assert {f"One/{f['file']}.html" for f in found["One"]["files"]} < report.files.keys()
    assert found["One"]["mistakes"][1:3] == ["(2) b: 5 instead of 4", "the other way"]
    assert (found["Empty"]["mark"], found["Empty"]["files"]) == (None, [])
    assert "Empty: no file" in report.text
    assert "Шесть и семь, план.cdw: such a file is not compared" in report.text


@pytest.mark.parametrize(("error", "said"), [
    (KeyError("layer"), "internal error: KeyError"), (RecursionError("too deep"), "internal error: RecursionError"),
    (OSError("no such device"), "no such device"), (MemoryError(), "not enough memory")])
def test_a_file_that_breaks_the_program_spoils_no_table(folder, tmp_path, monkeypatch, error, said):
    """It is told among what was not judged; who looks for the defect sees where it happened."""
    def broken(project, sheet, path):
        if "two" in path.name:
            raise error
        return drawing(project, sheet, path)

    def report():
        opened = type("P", (), {"variant": type("V", (), {"sheets": [1, 2]})()})()
        return group.compare(folder, "own", lambda name: opened, by(dxf=broken), scheme(tmp_path), lambda what: None)

    found = {s["student"]: s for s in report().tree["students"]}
    assert [found[n]["mark"] for n in ("Five", "One", "Two")] == [100, 76, None]
    assert said in found["Two"]["files"][0]["refused"]
    if "internal" in said:
        monkeypatch.setenv("TMM_SHEETS_TRACEBACK", "1")
        with pytest.raises(type(error)):
            report()


def test_the_wrong_student(folder, tmp_path):
    (folder / "projects.toml").write_text('"One" = "x"\n"Nobody" = "x"\n', encoding="utf-8")
    with pytest.raises(BadInput, match=r"projects.toml:2: Nobody: there is no such student"):
        compared(folder, tmp_path)


def test_an_empty_folder(tmp_path):
    with pytest.raises(BadInput, match="nothing to compare"):
        compared(tmp_path, tmp_path)
    with pytest.raises(BadInput, match="is no folder"):
        compared(tmp_path / "none", tmp_path)


@pytest.mark.parametrize(("was", "now", "said"), [
    ("red = 2", "red = -2", r"marks.toml:4: costs.red: expected a number not below 0, not -2"),
    ("red = 2", "rad = 2", r'marks.toml:4: costs.rad: expected "mistake", .* not "rad"\n *did you mean "red"'),
    ("full = 100", "", r"full: missing; expected the mark of a work without faults"),
    ("full = 100", "full = true", r"marks.toml:1: full: expected a number"),
    ("from = 90", "from = nan", r"marks.toml:14: grade\[2\].from: expected a number"),
    ('name = "3"', "name = 3", r"marks.toml:12: grade\[1\].name: expected a text"),
    ("[costs]", "[cost]", r"costs: missing; expected a table of what each fault costs"),
    ("full = 100", "full", r"marks.toml:1: not valid TOML, column \d+: expected"),
])  # fmt: skip
def test_a_bad_scheme(tmp_path, was, now, said):
    with pytest.raises(BadInput, match=said):
        scheme(tmp_path, SCHEME.replace(was, now))


def test_students_stand_in_the_order_of_a_register(tmp_path):
    """Ukrainian and Russian letters are not in the order of their codes, capitals count as others."""
    names = ["Андрієнко", "бойко", "Гнатюк", "Ґудзь", "Ежов", "Ёлкин", "Єременко", "Жук", "Ильин", "Іваненко", "Їжак", "Яценко"]
    for name in reversed(names):
        (tmp_path / name).mkdir()
        (tmp_path / name / "sheet 1.dxf").write_bytes(b"")
    assert list(group.works_by_student(tmp_path)) == names
