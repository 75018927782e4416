"""What a message tells to run, runs: every command that any output quotes is started, and is about the project that was typed."""

import importlib.util
import re
import shlex
import shutil
import sys
from pathlib import Path

import pytest

from tests.few import seldom
from tests.project_files import EVEN, SLIDER, write
from tmm_sheets import catalogue, quoting
from tmm_sheets.__main__ import run


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A folder with a student's files, one with a space in its name: copies of a task that keep its name, with other numbers."""
    monkeypatch.chdir(tmp_path)
    text = catalogue.read("sixbar/3:2").text.replace('"sixbar_1", "sixbar_2"', '"sixbar_1"')
    for name in ("b.toml", "my own.toml"):
        Path(name).write_text(text.replace('student = ""', 'student = "Коваль"'), encoding="utf-8")
    shutil.copy("b.toml", "c.toml")
    write(tmp_path, SLIDER, EVEN, {"cycle.positions": 90})
    return tmp_path


@pytest.fixture
def quoted(capsys):
    """Runs a command; the commands that its output quotes. None stands there that was not put together by ``quoting``."""
    with pytest.MonkeyPatch.context() as patch:  # a plain one: what is noted changes no sheet, kept ones serve
        yield noting(patch, capsys)


def noting(patch, capsys):
    made = []
    for name in ("command", "install"):
        before = getattr(quoting, name)

        def noted(*arguments, before=before):
            made.append(before(*arguments))
            return made[-1]

        patch.setattr(quoting, name, noted)

    def start(*arguments, status=2):
        made.clear()
        assert run(list(arguments)) == status
        told = capsys.readouterr()
        said = told.out + told.err
        assert "Traceback" not in said
        known = [*made, *re.findall(r"'(tmm-sheets [^']*)'", said)]  # the latter are click's
        for at in re.finditer(r"\b(?:tmm-sheets|pip install) (?!\[OPTIONS\]|COMMAND)(?=\w)", said):
            assert any(said[at.start():].startswith(one) for one in known) or "Usage:" in said[:at.start()].splitlines()[-1], said
        return [one for one in known if one in said], said

    return start


def started(command, status=0):
    words = shlex.split(command)
    if words[:2] == ["pip", "install"]:
        packages = {re.split(r"[>=<]", word)[0] for word in words[2:]}
        assert packages
        assert all(re.fullmatch(r"[a-z][\w-]*", package) for package in packages), packages
        return
    assert words[0] == "tmm-sheets"
    assert run(words[1:]) == status, command


@pytest.mark.parametrize("arguments", [
    ["check", "nothing/like/it"], ["check", "no/such.toml"], ["why", "b.toml", "structure.W"],
    ["why", "my own.toml", "structure.W"],
    seldom(["protocol", "b.toml", "--plan", "quite another"]),
    ["protocol", "my own.toml", "--plan", "quite another", "--lang", "uk"],
    ["draw"], ["build", "--shet"], ["compare", "b.toml"], ["--nonsense"], ["solve", "b.toml", "--part", "x"],
])  # fmt: skip
def test_it_runs(arguments, desk, quoted, capsys):
    found, _ = quoted(*arguments)
    assert found
    for command in found:
        started(command)


@pytest.mark.parametrize("name", [seldom("b.toml"), "my own.toml"])
def test_measured_numbers(name, desk, quoted, capsys):
    """The template of a copy is not passed off as the task's: what is told to be typed judges it against the copy."""
    found, _ = quoted("compare", name, "--template", status=0)
    (command,) = found
    folder = f"out/{Path(name).stem.replace(' ', '-')}"
    file = f"{folder}/measured.csv"
    assert shlex.split(command) == ["tmm-sheets", "compare", name, "--measured", file]
    text = Path(file).read_text(encoding="utf-8-sig")
    assert name in text.splitlines()[0]
    line = next(line for line in text.splitlines() if line.startswith("positions/") and line.rstrip().endswith(("mm,", "мм;")))
    Path(file).write_text(text.replace(line, f"{line}30"), encoding="utf-8-sig")
    started(command)
    capsys.readouterr()
    for other in ("sixbar/3:2", "c.toml"):
        found, said = quoted("compare", other, "--measured", file)
        assert f"of the project {name}, not of {other}" in said
        assert found == [command]
    Path(name).rename("renamed.toml")
    found, said = quoted("compare", "renamed.toml", "--measured", file)
    assert found == []  # it would not run
    heading = re.search(r'write "(.*)" there', said)[1]
    text = Path(file).read_text(encoding="utf-8-sig")
    Path(file).write_text("\n".join([heading, *text.splitlines()[1:]]), encoding="utf-8-sig")
    assert run(["compare", "renamed.toml", "--measured", file]) == 0


def test_numbers_that_are_not_there(desk, quoted):
    found, _ = quoted("compare", "my own.toml", "--measured", "none.csv")
    assert found == ["tmm-sheets compare 'my own.toml' --template"]
    started(found[0])


def test_what_was_asked_of_the_project_is_asked_again(desk, quoted):
    """With the suggested values, in another language: so are the commands that go on from there."""
    name = "sixbar/1:2"
    assert any(m for m in catalogue.read(name).misprints)
    found, _ = quoted("compare", name, "--corrected", "--template", "--lang", "uk", "-o", "x", status=0)
    assert found == [f"tmm-sheets compare {name} --measured x/measured.csv --corrected --lang uk"]


def test_too_many_positions(desk, quoted):
    (name,) = (p.name for p in desk.glob("*.toml") if p.name not in ("b.toml", "c.toml", "my own.toml"))
    (command, *_), _ = quoted("build", name, "--sheet", "1", status=1)
    assert command == f"tmm-sheets solve {name} --positions 90"
    started(command)


def test_passes_of_a_small_plotter(desk, capsys):
    """The last window that is proposed, a narrower one, is such as the plotter takes."""
    assert run(["plot", "lugansk/cam_flat", "--plotter", "a3", "--dry-run"]) == 0
    windows = re.findall(r"--window (\S+)", capsys.readouterr().out)
    assert len(windows) > 1
    assert run(["plot", "lugansk/cam_flat", "--plotter", "a3", "--dry-run", "--window", windows[-1]]) == 0


def test_case_of_a_stress_run(quoted, capsys):
    (command,), _ = quoted("stress", "--cases", "2", "--seed", "5", status=0)
    assert re.fullmatch(r"tmm-sheets stress --seed 5 --case [01]", command)
    started(command)


@pytest.mark.parametrize("extra", ["compare", "note", "bench", "cluster", "peers", "ocr", "page"])
def test_extras(extra):
    """What pip is told to install are packages, those of the extra: the program's own name may be somebody else's there."""
    words = shlex.split(quoting.install(extra))
    assert words[:2] == ["pip", "install"]
    assert not any("tmm" in word or "[" in word for word in words)
    started(quoting.install(extra))


@pytest.mark.parametrize(("arguments", "module", "extra"), [
    (["note", "press"], "typst", "note"), (["compare", "press", "--sheet", "1", "--image", "x.png"], "cv2", "compare"),
    (["bench", "--quick"], "mpmath", "bench"),
])  # fmt: skip
def test_a_package_that_is_missing(arguments, module, extra, desk, quoted, monkeypatch):
    Path("x.png").touch()
    find = importlib.util.find_spec
    for name, of in list(sys.modules.items()):
        if name.startswith("tmm_sheets") and getattr(of, "find_spec", None) is find:
            monkeypatch.setattr(of, "find_spec", lambda name, *rest: None if name == module else find(name, *rest))
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *rest: None if name == module else find(name, *rest))
    monkeypatch.setitem(sys.modules, module, None)
    found, _ = quoted(*arguments, status=1 if module == "typst" else 2)
    assert found == [quoting.install(extra)]


def test_words_of_a_shell():
    assert quoting.quoted(["a/b:1", "x@01-Т-27", "my own.toml", "$x", ""]) == "a/b:1 x@01-Т-27 'my own.toml' '$x' ''"
    for words in (["a b"], ["'"], ['"'], ["*"], ["it's"], ["проект 1.toml"]):
        assert shlex.split(quoting.quoted(words)) == words
