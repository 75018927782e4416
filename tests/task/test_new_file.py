"""A project file to begin with: what is written assembles."""

import io
from itertools import product

import pytest

from tests.few import seldom
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project
from tmm_sheets.task import new_file, variant

PAIRS = [k for k in product(new_file.KINDS, repeat=2) if k[0] != 4 and k not in ((2, 4), (5, 4))]


@pytest.mark.parametrize("kinds", [k if i % 4 == 0 else seldom(k) for i, k in enumerate(PAIRS)])
def test_mechanism_of_groups_assembles(kinds):
    text = new_file.whole("my", "Механизм", new_file.of_groups((*kinds, 2)), {"student": 'A "B"'})
    read = variant.parse(text, "my.toml")
    assert [g.kind for g in read.group] == [*kinds, 2]
    assert read.title_block.student == 'A "B"'
    Project(read).check()


@pytest.mark.parametrize("kinds", [(), (6,), (2, 4), (2,) * 30])
def test_groups_that_cannot_be(kinds):
    with pytest.raises(BadInput):
        new_file.of_groups(kinds)


def test_parts_stand_alone():
    read = variant.parse(new_file.whole("my", "my", new_file.of_parts(new_file.PARTS), {}), "my.toml")
    assert read.sheets == ("gear_reducer", "cam")


@pytest.mark.parametrize("name", ["lugansk/engine", "press", "screen", "sixbar/10:5", "transport/diesel@01-Т-27"])
def test_copy_has_its_numbers_and_comments(name):
    old = catalogue.read(name)
    read = variant.parse(new_file.copied(old.text, "my", {"student": "X"}), "my.toml")
    assert (read.project.name, read.title_block.student, read.title_block.group) == ("my", "X", "")
    assert [*read.data] == [*old.data]
    assert all(read.data[key] == old.data[key] for key in read.data if key not in ("project", "title_block"))
    assert read.source("crank", "length") == old.source("crank", "length")


def test_what_is_not_told_is_asked(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.stdin", io.StringIO("press\nШевченко\n\n"))
    assert run(["new", "my"]) == 0
    made = catalogue.read("my.toml")
    assert (made.title_block.student, made.title_block.group, made.crank.length) == ("Шевченко", "", 0.12)
    before = (tmp_path / "my.toml").read_bytes()
    assert run(["new", "my", "--from", "screen"]) == 2
    assert "is there already" in capsys.readouterr().err
    assert (tmp_path / "my.toml").read_bytes() == before


@pytest.mark.parametrize(("arguments", "said"), [
    (["--groups", "1,a"], "expected kinds of groups"), (["--groups", "9"], "expected kinds of groups"),
    (["--parts", "gaer"], "no part"),
    (["--from", "presss"], "did you mean press"), (["--from", "press", "--parts", "cam"], "leave --groups and --parts out"),
    ([], "give a task"),
])
def test_wrong_beginnings(arguments, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    assert run(["new", "my", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert not [*tmp_path.iterdir()]


def test_list_finds_a_word_of_any_language(capsys):
    assert run(["list", "дизель"]) == 0
    assert capsys.readouterr().out.startswith("transport/diesel@")
    assert run(["list", "zzz"]) == 1
