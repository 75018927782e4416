"""Whose sheets they are: options, project files, settings beside them and of the user."""

import pytest

from tests.project_files import EVEN, SLIDER, write
from tmm_sheets import api, catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.output import roster
from tmm_sheets.task import families, title_entries
from tmm_sheets.task.title_entries import Names, TitleEntry, given


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(families.CONFIG_FOLDER, str(tmp_path / "of user"))
    (tmp_path / "of user").mkdir()
    return tmp_path


def settings(folder, text):
    (folder / title_entries.FILE).write_bytes(text.encode())


def of(variant, options=()):
    return {name: entry.text for name, entry in given(dict(options)).entries(variant).items()}


def test_nearest_goes_first(folder):
    settings(folder / "of user", "[title_block]\nstudent = 'U'\ngroup = 'U'\nsupervisor = 'U'\nchecker = 'U'\n")
    settings(folder, "\ufeff[title_block]\r\nstudent = 'B'\r\ngroup = 'B'\r\nsupervisor = 'B'\r\n")
    own = {"title_block": {"student": "P", "group": "P", "institution": "Кафедра ТММ"}}
    variant = catalogue.read(write(folder, SLIDER, EVEN, own))
    found = of(variant, {"student": " O \n"})
    assert [found[name] for name in ("student", "group", "supervisor", "checker")] == ["O", "P", "B", "U"]
    assert found["institution"] == "Кафедра ТММ"  # nobody says another one


def test_what_only_keeps_a_place_goes_last(folder):
    settings(folder, "[title_block]\ngroup = 'ТМ-21'\ninstitution = 'ЛНУ'\n")
    shipped = catalogue.read("lugansk/shaper")
    (folder / "my.toml").write_text(shipped.text, encoding="utf-8")
    for variant in (shipped, catalogue.read("my.toml")):
        assert of(variant)["group"] == "ТМ-21"
        assert of(variant)["institution"] == "ЛНУ"


def test_without_names_the_project_stays_itself(folder):
    shipped = catalogue.read("press")
    assert given({}).filled(shipped) is shipped
    named = Names({"student": "X"}, {"group": TitleEntry("G")}).filled(shipped)
    assert (named.title_block.student, named.title_block.group) == ("X", "G")
    assert named.content != shipped.content  # what is kept of it is another sheet


@pytest.mark.parametrize(("text", "said"), [
    ("student = 'A'", "tmm-sheets.toml:1: student: stands outside its table"),
    ("[title_block]\nstudent = 3", "tmm-sheets.toml:2: title_block.student: expected a text in quotes"),
    ("format = 'A2'", "tmm-sheets.toml:1: format: stands outside its table"),
    ("[paper]\nformat = 'A9'", "tmm-sheets.toml:2: paper.format: expected"),
    ("[paper]\nsize = 'A2'", "tmm-sheets.toml:2: paper.size: unknown key"),
    ("[title_block]\n\nform = '2a'", "tmm-sheets.toml:3: title_block.form: only project files have it"),
    ("[title_block]\nstudnt = 'A'", 'did you mean "student"'),
    ("[title_block\n", "tmm-sheets.toml:1: not valid TOML"),
    ("[title_block]\nstudent = 'Ким 😀'", "tmm-sheets.toml:2: title_block.student: the drawing font has no"),
])
def test_bad_settings(folder, text, said):
    settings(folder, text)
    with pytest.raises(BadInput) as e:
        of(catalogue.read("press"))
    assert said in str(e.value)


def test_show_tells_whose_word_goes(folder, capsys):
    settings(folder, "[title_block]\nstudent = 'Шевченко'\n")
    assert run(["show", "lugansk/cam_flat"]) == 0
    assert ["student", "Шевченко", "tmm-sheets.toml:2"] in [line.split() for line in capsys.readouterr().out.splitlines()]


def test_option_fills_the_title_block(folder, capsys):
    assert run(["build", "lugansk/cam_flat", "--format", "svg", "--student", "Шевченко Т. Г."]) == 0
    named = (folder / "out/lugansk-cam_flat/sheet1.svg").read_text("utf-8")
    assert run(["build", "lugansk/cam_flat", "--format", "svg"]) == 0
    assert (folder / "out/lugansk-cam_flat/sheet1.svg").read_text("utf-8") != named
    capsys.readouterr()
    for told, said in (("\x1b", "--student: the drawing font has no (U+001B)"), ("Я" * 8000, "200 characters at most, not of")):
        assert run(["build", "lugansk/cam_flat", "--student", told]) == 2
        assert said in capsys.readouterr().err


@pytest.mark.parametrize("door", ["option", "settings", "project", "roster", "python"])
def test_every_door_composes_the_letters_of_a_name(folder, door):
    """``Йванов``, И with a breve, as a Mac writes it; nothing of what cannot be seen is left."""
    written, right = "И\u0306ванов\u200b\u00a0 И.", "Йванов И."
    if door == "roster":
        (folder / "group.csv").write_text(f"student;task\n{written};lugansk/cam_flat\n", encoding="utf-8")
        assert roster.read(folder / "group.csv")[0].student == right
        return
    if door == "settings":
        settings(folder, f"[title_block]\nstudent = '{written}'\n")
    own = write(folder, SLIDER, EVEN, {"title_block": {"student": written}})
    variant = catalogue.read(own if door == "project" else "lugansk/cam_flat")
    options = {"student": written} if door in ("option", "python") else {}
    found = api.open("lugansk/cam_flat", **options).project.variant.title_block.student if door == "python" else of(
        variant, options)["student"]
    assert found == right
