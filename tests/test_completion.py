"""What the Tab key offers: asked with the variables that click documents, and by the shells themselves."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tmm_sheets import catalogue, protocols
from tmm_sheets.__main__ import run
from tmm_sheets.cli import NAMES
from tmm_sheets.cli.options import PARTS
from tmm_sheets.project import PARTS as ALL_PARTS, Project
from tmm_sheets.record.step_index import leaves
from tmm_sheets.results import told

ROOT = Path(__file__).parents[1]


@pytest.fixture
def offered(monkeypatch, capsys):
    """What stands behind "plain," in the answer to a line that ends where the cursor is."""

    def ask(line, kind="plain"):
        monkeypatch.setenv("_TMM_SHEETS_COMPLETE", "bash_complete")
        monkeypatch.setenv("COMP_WORDS", line)
        monkeypatch.setenv("COMP_CWORD", str(len(line.split(" ")) - 1))
        assert run([]) == 0
        told = capsys.readouterr()
        assert told.err == ""
        return [one.removeprefix(f"{kind},") for one in told.out.splitlines() if one.startswith(f"{kind},")]

    return ask


def test_commands_and_options(offered):
    assert offered("tmm-sheets ") == [*NAMES]
    assert offered("tmm-sheets bu") == ["build"]
    assert offered("tmm-sheets build lugansk/shaper --one") == ["--one-file"]


def test_projects(offered, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("mine.toml", "Моя работа.toml", "notes.txt"):
        (tmp_path / name).touch()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "other.toml").touch()
    every = set(catalogue.shipped())
    for command in ("build", "check", "show", "solve", "note", "protocol", "record", "why", "plot", "compare"):
        assert set(offered(f"tmm-sheets {command} ")) == every | {"mine.toml", "Моя работа.toml", "sub/"}
    assert offered("tmm-sheets build sixbar/3:") == [f"sixbar/3:{n}" for n in range(1, 6)]
    assert offered("tmm-sheets build lugansk/shaper pre") == ["press"]
    assert offered("tmm-sheets check sub/") == ["sub/other.toml"]
    assert offered("tmm-sheets check ./m") == ["./mine.toml"]
    (tmp_path / "sheet1.plt").touch()
    assert "sheet1.plt" in offered("tmm-sheets plot ")


def test_words_of_options(offered):
    assert PARTS == ALL_PARTS
    assert offered("tmm-sheets solve lugansk/shaper --part ") == list(Project(catalogue.read("lugansk/shaper")).parts)
    assert offered("tmm-sheets solve lugansk/shaper --part positions,v") == ["positions,velocities"]
    assert offered("tmm-sheets solve no/such --part ") == list(PARTS)
    assert offered("tmm-sheets build press --sheet ") == ["1", "2", "3", "4"]
    assert offered("tmm-sheets build press --format pdf,") == ["pdf,dxf", "pdf,svg", "pdf,png", "pdf,hpgl"]
    assert offered("tmm-sheets note press --format ") == ["pdf", "docx"]
    assert offered("tmm-sheets build --all ") == ["loom", "lugansk", "press", "screen", "sixbar", "transport", "all"]
    assert offered("tmm-sheets plot press --plotter a1") == ["a1", "a1_centre"]
    assert offered("tmm-sheets plot press --tile a") == ["a4", "a3"]
    assert offered("tmm-sheets check press --lang ") == ["ru", "uk", "en"]
    assert offered("tmm-sheets build press -o ", "dir") == [""]
    assert offered("tmm-sheets solve press --json ", "file") == [""]


def test_plans_and_results_are_those_that_the_commands_take(offered, monkeypatch, capsys):
    project = Project(catalogue.read("lugansk/cam_rocker"))
    plans = offered("tmm-sheets protocol lugansk/cam_rocker --plan ")
    found, shown, _ = protocols.drawn_plans(project)
    assert plans == [name for of_sheet in shown.values() for name in of_sheet]
    assert not [name for name in plans if "@" in name or name.endswith("-between")]
    every = offered("tmm-sheets protocol lugansk/cam_rocker --all --plan ")
    assert every == list(found)
    assert len(every) > len(plans) > 1
    monkeypatch.delenv("_TMM_SHEETS_COMPLETE")
    for name in (plans[0], every[-1]):
        assert run(["protocol", "lugansk/cam_rocker", "--plan", name]) == 0
    capsys.readouterr()
    assert offered("tmm-sheets why lugansk/cam_rocker ") == ["cam."]
    results = offered("tmm-sheets why lugansk/cam_rocker cam.r")
    assert "cam.r0" in results
    assert set(results) == {name for name, _ in leaves(told(project, ["cam"])) if name.startswith("cam.r")}


def test_what_is_varied_and_wished(offered):
    line = "tmm-sheets optimise lugansk/cam_rocker --vary "
    assert {"cam.arm=", "cam.swing="} <= {*offered(f"{line}cam.")}
    assert offered(f"{line}cam.arm=") == []
    assert not any(name.startswith("schema") for name in offered(line))
    assert "max(cam.r0" in offered("tmm-sheets optimise lugansk/cam_rocker --least max(cam.r")


def test_it_is_said_in_the_readers_language(monkeypatch, capsys):
    for variable, value in (("_TMM_SHEETS_COMPLETE", "zsh_complete"), ("COMP_WORDS", "tmm-sheets lis"), ("COMP_CWORD", "1")):
        monkeypatch.setenv(variable, value)
    monkeypatch.setenv("LANGUAGE", "ru")
    assert run([]) == 0
    kind, word, said = capsys.readouterr().out.splitlines()
    assert (kind, word) == ("plain", "list")
    assert said.startswith("Перечислить")


@pytest.mark.parametrize("asked", ["bash_nonsense", "ksh_complete", "bash"])
def test_another_instruction(asked, monkeypatch, capsys):
    monkeypatch.setenv("_TMM_SHEETS_COMPLETE", asked)
    assert run([]) == 1
    assert capsys.readouterr().out == ""


# --- the shells --------------------------------------------------------------------------------------------------------------


@pytest.fixture
def shell(tmp_path, monkeypatch):
    """Runs a script of a shell that finds the program by its name, in a folder with a project file with a space in its name."""
    program = tmp_path / "bin" / "tmm-sheets"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m tmm_sheets "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    work = tmp_path / "work"
    work.mkdir()
    (work / "my own.toml").touch()
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"

    def start(name, script):
        if shutil.which(name) is None:
            pytest.skip(f"{name} is not installed")
        options = {"bash": ["--norc", "--noprofile"], "zsh": ["-f"], "fish": ["--no-config"]}[name]
        done = subprocess.run([name, *options, "-c", script], cwd=work, capture_output=True, text=True, timeout=120,
                              env={**os.environ, "PATH": path, "LANG": "C.UTF-8", "LC_ALL": "C.UTF-8", "LANGUAGE": "en"})
        assert done.stderr == ""
        return done.stdout.splitlines()

    return start


LINES = [
    ("tmm-sheets bui", ["build"]),
    ("tmm-sheets build sixbar/3:", [f"sixbar/3:{n}" for n in range(1, 6)]),
    ("tmm-sheets build transport/die", ["transport/diesel@01-Т-27"]),
    ("tmm-sheets solve press --part positions,vel", ["positions,velocities"]),
    ("tmm-sheets check my", ["my own.toml"]),
    ("tmm-sheets build press --format=pd", ["--format=pdf"]),
]


def test_bash(shell):
    """The function that the script defines, called as bash calls it; bash itself puts back what stands before its last sign."""
    script = 'eval "$(_TMM_SHEETS_COMPLETE=bash_source tmm-sheets)"\ncompopt() { :; }\n'
    for line, _ in LINES:
        script += f"COMP_LINE='{line}'; COMP_POINT=${{#COMP_LINE}}; _tmm_sheets_completion tmm-sheets\n"
        script += 'printf "%s\\n" "${COMPREPLY[@]}"; echo END\n'
    answers = "\n".join(shell("bash", script)).split("END\n")
    for (line, words), answer in zip(LINES, answers, strict=False):
        head = line.rpartition(" ")[2]
        head = head[: max(head.rfind(sign) for sign in ":@=") + 1]
        assert [head + one.replace("\\ ", " ") for one in answer.removesuffix("END").splitlines()] == words


def test_zsh(shell):
    """The same; what zsh is told to offer is printed instead."""
    script = ('compdef() { :; }\n_describe() { local -a d; d=("${(@P)3}"); print -rl -- "${(@)d%%:*}"; }\n'
              'compadd() { print -rl -- "${(@P)@[-1]}"; }\n'
              'eval "$(_TMM_SHEETS_COMPLETE=zsh_source tmm-sheets)"\n')
    for line, _ in LINES:
        script += f"words=({line}); CURRENT=${{#words}}; _tmm_sheets_completion; echo END\n"
    answers = "\n".join(shell("zsh", script)).split("END\n")
    assert [answer.removesuffix("END").splitlines() for answer in answers] == [words for _, words in LINES]


def test_fish(shell):
    script = "_TMM_SHEETS_COMPLETE=fish_source tmm-sheets | source\n"
    script += "".join(f"complete -C '{line}'; echo END\n" for line, _ in LINES)
    answers = "\n".join(shell("fish", script)).split("END\n")
    found = [[one.partition("\t")[0] for one in answer.removesuffix("END").splitlines()] for answer in answers]
    assert found == [words for _, words in LINES]
