"""Families as data: docs/examples/department with its hundred ciphers, where families are found, what is wrong in one."""

import re
import shutil
from pathlib import Path

import pytest

from tests.few import few
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.output import roster
from tmm_sheets.project import Project
from tmm_sheets.task import families, family_folder, family_tables

EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "department"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The example in a working folder, to be spoiled."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(EXAMPLE, tmp_path / "department")
    return tmp_path / "department"


@pytest.mark.parametrize("quick", few((True, False), True))
def test_all_ciphers_of_both_machines_can_be_built(quick):
    """Their project files can be read; where each digit stands in either place once, and in trials of all, they assemble."""
    found = [*roster.tried(EXAMPLE, quick)]
    assert len(found) == 200
    assert [t for t in found if t.problem] == []
    assert {t.project for t in found if t.warnings} == {f"department/feeder@4{b}" for b in range(10)}
    family = family_folder.FolderFamily(EXAMPLE)
    for t in found[::11] if quick else ():
        Project(family.read(t.project)).check()


def test_the_cipher_chooses(folder):
    """Digit a and b by columns, both together by rows; the rest follows, and every number says where it is from."""
    task = catalogue.read("department/feeder@27")
    assert (task.crank.length, task.group[0].lengths) == (0.07, (0.49, 0.24))
    assert task.guide[0].through == pytest.approx((0, 0.8 * 0.24))
    assert task.source("crank", "length") == "КП-25, table.csv: l_OA, a = 2"
    assert task.source("guide", 0, "through") == "y_D = 0.8 * l_CB"
    assert (task.called, task.shipped, task.title_block.designation) == ("department/feeder@27", True, "КП.ТММ.27")
    pump = catalogue.read("department/pump@27")
    assert pump.link[0].inertia == pytest.approx(3.4 * 0.49**2 / 12, rel=1e-5)


def test_misprints(folder):
    printed, corrected = catalogue.read("department/feeder@45"), catalogue.read("department/feeder@45", corrected=True)
    assert [t.group[0].lengths[1] for t in (printed, corrected)] == [0.206, 0.26]
    assert "206 mm is probably a misprint of 260 mm" in printed.warnings[0]
    assert "printed 206, suspected misprint" in corrected.source("group", 0, "lengths")


def test_mistakes_are_told_of_the_scheme(folder, capsys):
    """Each with the line of the file that is to be mended, not of the project file that was made of them."""
    for name, before, after in (("head.toml", '"counter-clockwise"', '"left"'), ("pump.toml", 'output = "B"', 'output = "3"')):
        file = folder / name
        file.write_text(file.read_text("utf-8").replace(before, after), encoding="utf-8")
    lines = {name: (folder / name).read_text("utf-8").splitlines().index(said) + 1
             for name, said in (("head.toml", 'sense = "left"'), ("pump.toml", 'output = "3"'))}
    assert run(["check", "department/pump@27"]) == 2
    told = capsys.readouterr().err
    assert f"department/head.toml:{lines['head.toml']}: crank.sense: " in told
    assert f"department/pump.toml:{lines['pump.toml']}: cycle.output: " in told
    assert run(["family", "check", "department", "--quick"]) == 1
    assert capsys.readouterr().err.count("100 ciphers, such as department/pump@00: department/") == 2


def test_commands_take_it(folder, capsys):
    assert run(["list", "питатель"]) == 0
    assert "department/feeder@27" in capsys.readouterr().out
    assert run(["build", "department/pump@27", "--format", "svg", "--sheet", "1"]) == 0
    assert (folder.parent / "out/department-pump@27/sheet1.svg").is_file()
    assert run(["family", "check", "department", "--quick", "--lang", "en"]) == 0
    assert "department/pump: 100 ciphers, 100 can be built" in capsys.readouterr().out
    assert run(["family", "check", "nowhere"]) == 2
    assert run(["check", "department/mill@27"]) == 2
    assert "department has no machine" in capsys.readouterr().err


def test_where_families_are_found(folder, tmp_path, monkeypatch):
    monkeypatch.setenv(families.CONFIG_FOLDER, str(tmp_path / "user"))
    monkeypatch.setenv(families.PATH, str(tmp_path / "share"))
    families.installed_families.cache_clear()
    package = type("P", (), {"__path__": [str(shutil.copytree(folder, tmp_path / "package/gift"))]})
    entry = type("E", (), {"name": "gift", "load": lambda self: package})()
    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: [entry] if group == families.GROUP else [])
    for place in ("user/families/own", "share/common", "share/department"):
        shutil.copytree(folder, tmp_path / place)
    assert {*families.folders()} == {"department", "own", "common", "gift"}
    assert families.folders()["department"] == Path("department")  # the nearest
    for name in ("own", "common", "gift"):
        assert catalogue.read(f"{name}/pump@27").project.name == f"{name}/pump@27"
        assert catalogue.is_shipped(f"{name}/pump@00")
    families.installed_families.cache_clear()


def test_a_family_that_is_not_finished_costs_no_other(folder, capsys):
    (folder / "family.toml").write_text("cipher = 1\n", encoding="utf-8")
    assert "press" in {e.name for e in catalogue.entries()}
    assert run(["check", "lugansk/cam_flat"]) == 0
    assert run(["show", "department/pump@27"]) == 2
    assert "department/family.toml:1: example: missing" in capsys.readouterr().err.replace("\\", "/")


@pytest.mark.parametrize(("file", "old", "new", "said"), [
    ("pump.toml", "$l_AB", "$l_ABB", r"pump\.toml:13: nothing is called \$l_ABB\n    did you mean l_AB"),
    ("table.csv", "l_AB;mm;b;420", "l_AB;mm;c;420", r"table\.csv:4: l_AB: the cipher has no digit c"),
    ("table.csv", "440;450;460", "440;;460", None), ("table.csv", "460;470;480;490", "460;470;480;", r"l_AB: nothing for b = 7"),
    ("family.toml", '"0.35 * l_AB"', '"0.35 * l_BA"', r"derived\.l_AS2: 0\.35 \* l_BA cannot be computed: l_BA"),
    ("family.toml", '"table.csv"]\n\n[machine.pump', '"tables.csv"]\n\n[machine.pump', r"tables\.csv: no such file"),
    ("family.toml", 'scheme = ["head.toml", "pump.toml"]', 'scheme = ["pump.toml", "dead.toml"]', r"dead\.toml: no such file"),
    ("family.toml", 'scheme = ["head.toml", "pump.toml"]', 'scheme = ["../x.toml"]', r"x\.toml: expected .* below the folder"),
    ("family.toml", '"table.csv"]\n\n[machine.pump', '"/etc/passwd"]\n\n[machine.pump', r"passwd: expected .* below the folder"),
    ("family.toml", "[machine.pump]", "[machine.pump]\nsheme = 1", r"family\.toml:\d+: machine\.pump\.sheme: unknown key"),
    ("family.toml", "tables", "tables = ", "not valid TOML"), ("table.csv", None, "", "the table is empty"),
    ("pump.toml", 'inner = "B"', 'inner = "B$"', r"pump\.toml:12: a \$ before no name"),
])
def test_what_is_wrong_is_told(folder, file, old, new, said):
    path = folder / file
    text = path.read_text("utf-8")
    path.write_text(text.replace(old, new, 1) if old else new, encoding="utf-8")
    assert path.read_text("utf-8") != text
    if said is None:
        assert catalogue.read("department/pump@27")
        return
    with pytest.raises(BadInput, match=said):
        catalogue.read("department/pump@27")


@pytest.mark.parametrize("cipher", ["7", "277", "2a", "", "٢٧"])
def test_no_ciphers(folder, cipher):
    with pytest.raises(BadInput, match=r"not a cipher"):
        catalogue.read(f"department/pump@{cipher}")


def test_ciphers_with_more_than_digits(folder):
    path = folder / "family.toml"
    path.write_text(path.read_text("utf-8").replace('cipher = "ab"', 'cipher = "yy-Т-ab"'), encoding="utf-8")
    family = family_folder.FolderFamily(folder)
    both = [family.form.read(text) for text in ("25-Т-27", "25-T-27")]  # Cyrillic, Latin
    assert [(c.text, c.digits) for c in both] == [("25-Т-27", {"a": "2", "b": "7"})] * 2
    assert next(family.every("pump")) == "department/pump@00-Т-00"
    with pytest.raises(BadInput, match="needs a cipher"):
        family.read("department/pump")


def test_a_table_in_toml(tmp_path):
    path = tmp_path / "t.toml"
    path.write_text('digit = "a"\n[unit]\nl = "mm"\n[values]\nl = [80, "85", 90.5]\nz = [17, 18, 19]\n', encoding="utf-8")
    length, teeth = family_tables.read(path, "a")
    assert (length.cell({"a": "2"}), length.written("90.5"), teeth.cell({"a": "0"})) == (("2", "90.5"), "90.5 mm", ("0", "17"))
    with pytest.raises(BadInput, match="nothing for a = 3"):
        length.cell({"a": "3"})


@pytest.mark.parametrize(("text", "value"), [
    ("(b - a) / 2", 1), ("-a^2 + 10", 6), ("sqrt(b) * sin(30)", 1), ("acos(0.5)", 60), ("round(7.4) * pi", 21.991148575),
    ("a < b", 1), ("a > b / 2", 0),
])
def test_formulas(text, value):
    assert family_tables.formula_value(text, {"a": 2, "b": 4}) == pytest.approx(value)


@pytest.mark.parametrize("text", ["c + 1", "a / 0", "open('x')", "a.b", "a if b else 1", "'x'", "a b", "sqrt(0-1)", "True",
                                  "a == b", "a < b < 9", "__import__('os')"])
def test_what_is_no_formula(text):
    with pytest.raises(ValueError, match=r"."):
        family_tables.formula_value(text, {"a": 2, "b": 4})


def test_the_doc_shows_the_example():
    doc = (EXAMPLE.parents[1] / "families.md").read_text("utf-8")
    shown = re.search(r"key;unit;digit.*\n.*\n.*", doc)[0]
    assert shown.splitlines() == (EXAMPLE / "table.csv").read_text("utf-8").splitlines()[1:4]


def test_what_a_family_tells(folder):
    """A remark where a comparison holds, a part of the cipher that belongs to another machine, a value without a digit."""
    family = (folder / "family.toml").read_text("utf-8").replace('cipher = "ab"', (
        'cipher = { form = "(?P<group>[^-]+)-(?P<number>[0-9]+)", digits = [["number", 2]], letters = "ab", '
        'written = "$group-$number", padding = "1", spelling = { M = "М" } }')).replace('"КП-25"', '"КП, $file, $symbol: $column"')
    family = family.replace("[machine.pump.derived]", 'parts = { group = "М" }\nremark = [{ when = "l_OA > 70", say = "long" }]\n'
                            "[machine.pump.derived]")
    (folder / "family.toml").write_text(family, encoding="utf-8")
    table = (folder / "table.csv").read_text("utf-8").replace("key;", "note;key;").replace("\nl_OA", "\n(measured);l_OA")
    (folder / "table.csv").write_text("\n".join(
        line if line.startswith(("note", "#", "(")) else f";{line}" for line in table.splitlines()), encoding="utf-8")
    task = catalogue.read("department/pump@m-27")
    assert (task.called, task.warnings) == ("department/pump@М-27", ())
    assert task.source("crank", "length") == "КП, table.csv, l_OA: 2 (measured)"
    assert catalogue.read("department/pump@K-3").crank.length == catalogue.read("department/pump@K-31").crank.length
    assert catalogue.read("department/pump@К-37").warnings == ("department/pump is for ciphers with М, not with К", "long")
    assert sum(1 for _ in families.of("department/pump@M-1").every("pump")) == 100


def test_ciphers_of_many_digits_are_tried_in_all_their_figures(folder, monkeypatch):
    """A sample, always the same; ciphers whose digits choose the same numbers are assembled once."""
    monkeypatch.setattr(family_tables, "MOST_CIPHERS", 200)
    family = (folder / "family.toml").read_text("utf-8").replace('cipher = "ab"', 'cipher = "abcdefghijklmnopqrstuvwxyz"')
    (folder / "family.toml").write_text(family.replace('"27"', f'"{"27" * 13}"'), encoding="utf-8")
    names = [*family_folder.FolderFamily(folder).every("pump")]
    assert names == [*family_folder.FolderFamily(folder).every("pump")]
    assert len(names) == 200
    assert {len({*figures}) for figures in zip(*(name.partition("@")[2] for name in names), strict=True)} == {10}
    checked = []
    monkeypatch.setattr(Project, "check", lambda project: checked.append(project))
    found = [*roster.tried(folder)]
    assert len(found) == 400
    assert 0 < len(checked) < 300


@pytest.mark.parametrize(("head", "figure", "holds"), [
    ("2", "2", True), ("2", "02", True), ("2", "3", False), ("0..4", "4", True), ("0 .. 4", "5", False), ("3..", "3", False),
    ("..3", "3", False), ("²", "2", False), ("9" * 5000, "9", False), (f"0..{'9' * 5000}", "9", False), ("a", "a", True),
    ("", "1", False)])
def test_which_figures_a_column_is_for(head, figure, holds):
    assert family_tables.holds_figure(head, figure) == holds
