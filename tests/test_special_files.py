"""Links, pipes, devices where files are expected, and files that a person changed: nothing hangs, nothing of theirs is lost."""

import os
import shutil
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

from tests.few import few
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.note import note as writing
from tmm_sheets.note.note import PACKAGES
from tmm_sheets.output.build_store import RECORD

CAM = "lugansk/cam_flat"
BUILD = ["build", CAM, "--format", "svg", "-o", "out"]
pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in folders here")


@pytest.fixture(autouse=True)
def desk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("out").mkdir()


def loop(path):
    """A link that leads round."""
    Path(path).with_name("round").symlink_to(Path(path).name)
    Path(path).symlink_to("round")


@pytest.mark.parametrize("name", [RECORD, "sheet1.svg"])
def test_a_link_in_the_output_folder(name, capsys):
    """What it leads to keeps its bytes; a sheet that is one counts as changed by hand until --force."""
    Path("precious").write_text("mine", encoding="utf-8")
    Path("out", name).symlink_to("../precious")
    assert run(BUILD) == 0
    assert run([*BUILD, "--force"]) == 0
    assert Path("precious").read_text(encoding="utf-8") == "mine"
    assert not Path("out", name).is_symlink()
    assert Path("out/sheet1.svg").read_bytes().endswith(b"</svg>\n")


@pytest.mark.parametrize("make", [os.mkfifo, loop])
@pytest.mark.parametrize(("name", "form"), [(RECORD, "svg"), ("sheet1.svg", "svg"), ("TMMSheetsB.ttf", "dxf")])
def test_what_is_no_file_in_the_output_folder(name, form, make, capsys):
    make(Path("out", name))
    before = sorted(os.listdir("out"))
    assert run(["build", CAM, "--format", form, "-o", "out"]) == 2
    assert f"out/{name}: cannot be written" in capsys.readouterr().err
    assert sorted(os.listdir("out")) == before


INPUTS = [
    ["check", "x"], ["compare", CAM, "--measured", "x"], ["compare", CAM, "--dxf", "x"],
    ["compare", CAM, "--sheet", "1", "--image", "x"],
    ["compare", CAM, "--dxf", "y", "--sheet", "1", "--views", "x"], ["plot", "x.plt"], ["build", "--list", "x"],
    ["plot", CAM, "--plotter", "x"], ["solve", CAM, "--json", "x"], ["show", CAM, "--file", "-o", "x"],
]  # fmt: skip


@pytest.mark.parametrize(("arguments", "make"), few(
    product(INPUTS, (os.mkfifo, loop)), *zip(INPUTS, 5 * (os.mkfifo, loop), strict=True)))
def test_what_is_no_file_is_told_by_name(arguments, make, capsys):
    name = "x.plt" if "x.plt" in arguments else "x"
    make(Path(name))
    if "y" in arguments:
        assert run(["build", CAM, "--format", "dxf", "-o", "out"]) == 0
        Path("out/sheet1.dxf").rename("y")
    assert run(arguments) == 2
    said = capsys.readouterr().err
    assert name in said
    assert "internal error" not in said
    assert not Path(name).is_file()


def test_a_device_without_end(capsys):
    assert run(["check", "/dev/zero"]) == 2
    assert "/dev/zero: cannot be read: expected a file, this is a device" in capsys.readouterr().err


@pytest.mark.parametrize("place", ["loop", "broken"])
def test_a_folder_that_is_a_link_to_nothing(place, capsys):
    if place == "loop":
        loop("away")
    else:
        Path("away").symlink_to("nowhere")
    assert run(["build", CAM, "--format", "svg", "-o", "away"]) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_what_a_shell_holds_open():
    """Standard output by its name and a process substitution are no pipes in folders."""
    if shutil.which("bash") is None:
        pytest.skip("no bash here")
    program = f"'{sys.executable}' -m tmm_sheets"
    script = (f"{program} solve {CAM} --json /dev/stdout | head -c 14; {program} solve {CAM} --json /dev/stdout > kept; "
              f"{program} check <({program} show {CAM} --file); {program} solve {CAM} --json >(cat > other); sleep 1")
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, timeout=120, check=False,
                          env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])})
    assert done.stdout.startswith('{\n "schema": 1')
    assert ": OK" in done.stdout
    assert Path("kept").read_text(encoding="utf-8") == Path("other").read_text(encoding="utf-8")
    assert Path("/dev/stdout").is_symlink()


# --- changed by a person ----------------------------------------------------------------------------------------------------


def test_show_file_does_not_write_over_another_file(capsys):
    arguments = ["show", "lugansk/shaper", "--file", "-o", "my.toml"]
    assert run(arguments) == 0
    assert run(arguments) == 0  # it says the same
    own = catalogue.read("lugansk/shaper").text.replace('student = ""', 'student = "Коваль"')
    Path("my.toml").write_text(own, encoding="utf-8")
    capsys.readouterr()
    assert run(arguments) == 2
    assert "my.toml: is there already" in capsys.readouterr().err
    assert Path("my.toml").read_text(encoding="utf-8") == own
    assert run([*arguments, "--force"]) == 0
    assert Path("my.toml").read_text(encoding="utf-8") == catalogue.read("lugansk/shaper").text


def test_note_does_not_write_over_a_changed_one(monkeypatch, capsys):
    """What the program wrote itself is replaced; what a person made of it stays, and the new one goes beside it."""
    made = [b"first"]
    monkeypatch.setattr(writing, "check", lambda formats: None)
    def write(project, formats, say):
        return writing.Written({f"note.{form}": made[0] for form in formats}, 1, ())

    monkeypatch.setattr(writing, "write", write)
    arguments = ["note", CAM, "--format", ",".join(PACKAGES), "-o", "out"]
    assert run(arguments) == 0
    made[0] = b"second"
    assert run(arguments) == 0
    assert Path("out/note.docx").read_bytes() == b"second"
    Path("out/note.docx").write_bytes(b"mine")
    made[0] = b"third"
    capsys.readouterr()
    assert run(arguments) == 0
    told = capsys.readouterr()
    assert "note.docx was changed by hand and stays; the new one is note.new.docx" in told.err
    assert "out/note.new.docx" in told.out
    found = {p.name: p.read_bytes() for p in Path("out").iterdir() if p.name != RECORD}
    assert found == {"note.pdf": b"third", "note.docx": b"mine", "note.new.docx": b"third"}
    assert run([*arguments, "--force"]) == 0
    assert Path("out/note.docx").read_bytes() == b"third"
