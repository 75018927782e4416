"""Text in and out whatever the code page: output that is read by programs is UTF-8, files of Windows are told apart."""

import json
import os
import subprocess
import sys
import tomllib
from itertools import product
from pathlib import Path

import pytest

from tests.few import few
from tmm_sheets import catalogue, encodings, resources
from tmm_sheets.__main__ import run
from tmm_sheets.compare import placing
from tmm_sheets.drawing import plotters
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant

ROOT = Path(__file__).parents[1]
PRESS, CAM = (catalogue.read(name).text for name in ("press", "lugansk/cam_flat"))
RUSSIAN = "Привод пресса, №3: «μ» нет\nтитул – да\n".replace("μ", "m")

CONSOLES = {
    "utf-8": {"PYTHONIOENCODING": "utf-8"},
    "cp1251": {"PYTHONIOENCODING": "cp1251"},
    "cp866": {"PYTHONIOENCODING": "cp866"},
    "ascii": {"PYTHONIOENCODING": "ascii"},
    "C": {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
}


def command(*arguments, console, **options):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error", **CONSOLES[console]}
    options = {"capture_output": True, "timeout": 120, "env": environment} | options
    return subprocess.run([sys.executable, "-m", "tmm_sheets", *map(str, arguments)], **options)


OTHERS = sorted(CONSOLES.keys() - {"utf-8"})


@pytest.mark.parametrize(("line", "console"), few(
    product(("show sixbar/6:3", "protocol lugansk/cam_flat"), OTHERS), ("show sixbar/6:3", "C")))
def test_redirected_output_is_utf_8(line, console, capsys):
    """Greek and subscripts stand in all of these; the expected text is what the command says in this process."""
    done = command(*line.split(), console=console)
    assert (done.returncode, done.stderr) == (0, b"")
    assert run(line.split()) == 0
    assert done.stdout.decode("utf-8") == capsys.readouterr().out
    assert max(done.stdout.decode("utf-8")) > "\u0370"


@pytest.mark.parametrize("console", few(OTHERS, "C"))
def test_results_and_tables_are_utf_8(console, tmp_path):
    done = command("solve", "lugansk/cam_flat", "--json", "-", console=console)
    assert json.loads(done.stdout.decode("utf-8"))["project"] == "lugansk/cam_flat"
    done = command("compare", "lugansk/cam_flat", "--template", "-o", tmp_path, console=console)
    assert done.returncode == 0
    assert "# project: lugansk/cam_flat" in (tmp_path / "measured.csv").read_text(encoding="utf-8-sig")
    assert done.stdout.decode("utf-8")


@pytest.mark.parametrize("console", few(CONSOLES, "cp1251", "C"))
def test_a_message_in_a_pipe_is_utf_8(console, tmp_path):
    file = tmp_path / "my.toml"
    file.write_text("schema = 1\n[project]\ntitle = Ωж\n", encoding="utf-8")
    done = command("check", file, console=console)
    assert done.returncode == 2
    assert "project.title: not valid TOML: Ωж" in done.stderr.decode("utf-8")


@pytest.mark.parametrize("console", few(CONSOLES, "cp1251"))
def test_the_documented_start(console, tmp_path):
    """``show --file > my.toml``, and the same with -o: the file itself, which passes."""
    mine, other = tmp_path / "my.toml", tmp_path / "folder" / "other.toml"
    with mine.open("wb") as file:
        assert command("show", "lugansk/cam_flat", "--file", console=console, stdout=file, capture_output=False).returncode == 0
    assert command("show", "lugansk/cam_flat", "--file", "-o", other, console=console).returncode == 0
    assert mine.read_bytes() == other.read_bytes() == CAM.encode()
    assert command("check", mine, console=console).stdout.decode() == f"{mine}: OK\n"


def test_where_a_project_file_may_go(tmp_path, capsys):
    assert run(["show", "press", "-o", str(tmp_path / "x.toml")]) == 2
    assert "-o goes with --file" in capsys.readouterr().err
    assert run(["show", "press", "--file", "-o", str(tmp_path)]) == 2
    assert "expected a file, this is a folder" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals")
@pytest.mark.parametrize("encoding", few(["cp866", "ascii"], "cp866"))
def test_a_terminal_without_the_letter_shows_another(encoding):
    import pty

    ours, theirs = pty.openpty()
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": encoding}
    with subprocess.Popen([sys.executable, "-m", "tmm_sheets", "show", "sixbar/6:3"], stdout=theirs, stderr=theirs,
                          env=environment) as running:
        os.close(theirs)
        said = b""
        try:
            while piece := os.read(ours, 65536):
                said += piece
        except OSError:  # the other end is closed
            pass
        os.close(ours)
    assert running.returncode == 0
    text = said.decode(encoding, "strict" if encoding == "cp866" else "replace")  # of ascii click believes nothing: UTF-8
    assert "Assur" in text
    assert "internal error" not in text
    assert "?" in text or encoding == "ascii"


# --- reading -----------------------------------------------------------------------------------------------------------

SAVED = {
    "utf-8": RUSSIAN.encode(),
    "utf-8 with mark": RUSSIAN.encode("utf-8-sig"),
    "notepad, ANSI": RUSSIAN.encode("cp1251"),
    "console": RUSSIAN.replace("«", '"').replace("»", '"').replace("–", "-").encode("cp866"),
    "notepad, Unicode": RUSSIAN.encode("utf-16"),
    "big endian": "\ufeff".encode("utf-16-be") + RUSSIAN.encode("utf-16-be"),
    "no mark": RUSSIAN.encode("utf-16-le"),
    "no mark, big endian": RUSSIAN.encode("utf-16-be"),
    "PowerShell 5 >": RUSSIAN.encode().decode("cp866").encode("utf-16"),
    "PowerShell 7 >": RUSSIAN.encode().decode("cp866").encode("utf-8"),
}


@pytest.mark.parametrize("how", SAVED)
def test_encodings_are_told_apart(how):
    text, note = encodings.decoded(SAVED[how], "x", "")
    expected = RUSSIAN if how != "console" else SAVED[how].decode("cp866")
    assert text == expected
    assert bool(note) == (not how.startswith("utf-8"))


@pytest.mark.parametrize("data", [b"", b"a", b"ab = 1\n", b"\xef\xbb\xbf", "т".encode(), "раб".encode(), "╨".encode()])
def test_short_texts_stay_what_they_are(data):
    assert encodings.decoded(data, "x", "") == (data.decode("utf-8-sig"), "")


@pytest.mark.parametrize(
    ("data", "line", "said"),
    [
        (b"a\n\0\1\2", 2, "not a text file"),
        (b"a = 1\n\x89PNG\r\n\x1a\n\xff\xfe", 2, "not a text file"),
        ("план\nплан ".encode() + b"\xff\xfe\n" + "план планов".encode(), 2, "not UTF-8 text here"),
        (b"a = 1\n" + bytes(range(0x80, 0xC0)), 2, "neither UTF-8 nor"),
        (b"\xff\xfea\0b", None, "in the middle of a character"),
    ],
)
def test_what_is_no_text(data, line, said):
    with pytest.raises(BadInput, match=said) as e:
        encodings.decoded(data, "x.toml", "save it")
    assert [(p.file, p.line, p.hint) for p in e.value.problems] == [("x.toml", line, "save it")]


def test_signs_that_nobody_sees():
    assert encodings.cleaned("\ufeffа\u00adб\u200b\u200d\ufe0f\u00a0в\u2009г") == "аб в г"
    assert encodings.cleaned("И\u0306 е\u0308 U\u0308 F\u0305") == "Й ё Ü F\u0305"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1251", "utf-16"])
def test_every_file_a_user_writes(encoding, tmp_path, capsys):
    file = tmp_path / "my.toml"
    text = "".join(c for c in PRESS if c in "\n" or c.encode("cp1251", "ignore"))
    file.write_bytes(text.encode(encoding))
    assert variant.read(file).project.title == tomllib.loads(text)["project"]["title"]
    assert bool(variant.read(file).warnings) == (not encoding.startswith("utf-8"))
    listed = tmp_path / "list.txt"
    listed.write_bytes("# список\ntransport/diesel@02-Т-27\n".encode(encoding))
    assert run(["build", "--list", str(listed), "--sheet", "9", "-o", str(tmp_path / "out")]) == 1
    assert "transport/diesel@02-Т-27  no sheet 9" in capsys.readouterr().err
    machine = tmp_path / "machine.toml"
    shipped = (resources.template("plotters/a1.toml")).read_text(encoding="utf-8")
    machine.write_bytes((shipped + "# перья\n").encode("utf-8").decode("utf-8").encode(encoding, "ignore"))
    assert plotters.plotter(str(machine)).pens == plotters.plotter("a1").pens
    views = tmp_path / "views.toml"
    views.write_bytes('[[view]]\nname = "План"\nours = [[0, 0], [9, 0]]\ntheirs = [[0, 0], [9, 0]]\n'.encode(encoding))
    with pytest.raises(BadInput, match='no view "План"'):
        placing.read_places(views, ())
