"""What was told and written is given again only for the same question, and where nothing is in its way."""

import shutil
from pathlib import Path

import pytest

from tmm_sheets import catalogue, kept
from tmm_sheets.__main__ import run
from tmm_sheets.task import title_entries

BUILD = ("build", "my.toml", "--format", "pdf,svg")


def copy():
    """A project of somebody's own in this folder."""
    Path("my.toml").write_bytes(catalogue.shipped_path("lugansk/cam_flat").read_bytes())


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """What a build of it keeps."""
    folder = tmp_path_factory.mktemp("built")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setenv(kept.FOLDER, str(folder / "kept"))
        copy()
        assert run([*BUILD, "-o", "a"]) == 0
    return folder / "kept"


@pytest.fixture
def asked(tmp_path, monkeypatch, capsys):
    """Carry a command out on a copy of a project: exit status, what was told, and whether anything was kept that was not before."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(kept.FOLDER, str(tmp_path / "kept"))
    copy()

    def ask(*arguments):
        before = {*Path("kept").glob("*")}
        status = run([*arguments])
        return status, *capsys.readouterr(), {*Path("kept").glob("*")} != before

    return ask


def content(folder):
    return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def test_another_folder_has_the_same(asked):
    status, out, err, new = asked(*BUILD, "-o", "a")
    assert (status, new) == (0, True)
    assert asked(*BUILD, "-o", "b") == (0, out.replace("a/", "b/"), err, False)
    assert content("a") == content("b")
    for folder in "ab":
        status, told, err, new = asked(*BUILD, "-o", folder)
        assert (status, told, new) == (0, out.replace("a/", f"{folder}/"), False)
        assert "2 of 2 files unchanged" in err
    assert asked(*BUILD, "-o", "c", "--no-cache")[3] is False
    assert content("a") == content("c")


def test_another_file_has_the_same(asked):
    """A record, whatever its file is called; to standard output it is another question."""
    assert asked("record", "my.toml", "--json", "a.json") == (0, "", "", True)
    assert asked("record", "my.toml", "--json", "b.json") == (0, "", "", False)
    assert Path("a.json").read_bytes() == Path("b.json").read_bytes()
    assert asked("record", "my.toml", "--json", "-")[1:] == (Path("a.json").read_text(encoding="utf-8"), "", True)


def test_what_was_changed_by_hand_stays(asked):
    for folder in "ab":
        asked(*BUILD, "-o", folder)
    Path("b/sheet1.svg").write_text("mine")
    assert "sheet1.svg was changed by hand" in asked(*BUILD, "-o", "b")[2]
    assert Path("b/sheet1.svg").read_text() == "mine"
    assert Path("b/sheet1.new.svg").read_bytes() == Path("a/sheet1.svg").read_bytes()
    Path("a/sheet1.pdf").unlink()
    assert "1 of 2 files unchanged" in asked(*BUILD, "-o", "a")[2]
    assert Path("a/sheet1.pdf").read_bytes() == Path("b/sheet1.pdf").read_bytes()


def change(name, old, new):
    path = Path(name)
    path.parent.mkdir(exist_ok=True)
    path.write_text(path.read_text(encoding="utf-8").replace(old, new) if old else new, encoding="utf-8")


def users(patch):
    change(f"config/{title_entries.FILE}", "", NAMES)
    patch.setenv("TMM_SHEETS_CONFIG", "config")


NAMES = '[title_block]\nstudent = "Петренко О.В."\n'
OTHERS = {
    "the project": lambda _: change("my.toml", "schema = 1", "schema = 1  # other"),
    "settings beside it": lambda _: change(title_entries.FILE, "", NAMES),
    "settings of the user": users,
    "the date": lambda patch: patch.setenv("SOURCE_DATE_EPOCH", "1700000000"),
    "the reader": lambda patch: patch.setenv("LANGUAGE", "uk"),
    "a title block": ("--student", "Петренко О.В."),
    "a language": ("--lang", "en"),
    "a resolution": ("--dpi", "100"),
    "the paper": ("--portrait",),
    "a sheet": ("--sheet", "1"),
}


@pytest.mark.parametrize("what", OTHERS)
def test_another_question(asked, built, monkeypatch, what):
    shutil.copytree(built, "kept")
    assert asked(*BUILD, "-o", "a")[3] is False
    other, more = OTHERS[what], ()
    if callable(other):
        other(monkeypatch)
    else:
        more = other
    assert asked(*BUILD, *more, "-o", "b")[3] is True
    made = content("b")
    asked(*BUILD, *more, "-o", "c", "--no-cache")
    assert content("c") == made


@pytest.mark.parametrize("command", [
    ("record", "my.toml", "--sheet", "1", "--json", "-"), ("record", "my.toml", "--json", "r.json"),
    ("plot", "my.toml", "--plotter", "a1", "-o", "p"), ("compare", "my.toml", "--template", "-o", "t", "--json", "-"),
    ("page", "my.toml", "-o", "p/page.html"),
])  # fmt: skip
def test_the_same_is_given_again(asked, command):
    first = asked(*command)
    assert (first[0], first[3]) == (0, True)
    made = {path: path.read_bytes() for folder in ("p", "t") for path in Path(folder).glob("*")}
    assert asked(*command) == (*first[:3], False)
    for path in made:
        path.unlink()
    assert asked(*command) == (*first[:3], False)
    assert all(path.read_bytes() == data for path, data in made.items())


def test_a_table_that_is_filled_in_stays(asked):
    command = ("compare", "my.toml", "--template", "-o", "t")
    asked(*command)
    path = Path("t/measured.csv")
    path.write_bytes(path.read_bytes() + b"\n")
    assert asked(*command)[0] == 2
