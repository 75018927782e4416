"""Views as pictures, the scheme of a mechanism, files that are watched."""

from itertools import islice

import pytest

from tests.project_files import EVEN, SLIDER, write
from tmm_sheets import files
from tmm_sheets.__main__ import run
from tmm_sheets.cli import build as build_commands
from tmm_sheets.errors import BadInput


def test_scheme_and_views(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    file = write(tmp_path, SLIDER, EVEN)
    assert run(["check", file, "--scheme", "scheme.svg"]) == 0
    scheme = (tmp_path / "scheme.svg").read_text("utf-8")
    assert all(f'aria-label="{letter}' in scheme for letter in "OAB")
    assert run(["build", file, "--format", "svg", "--views", "--lang", "en"]) == 0
    views = {path.name: path.read_text("utf-8") for path in (tmp_path / "out/own/views").glob("*.svg")}
    assert len(views) > 3
    assert all("Frame" not in name and 'width="841mm"' not in text for name, text in views.items())
    assert run(["build", file, "--format", "svg", "--views"]) == 0
    capsys.readouterr()


@pytest.mark.parametrize(("arguments", "status"), [
    (["check", "lugansk/cam_flat", "--scheme", "s.svg"], 1), (["check", "press", "--scheme", "s.png"], 2),
    (["build", "press", "--views", "--zip"], 2), (["build", "press", "screen", "--open"], 2), (["watch", "press"], 2),
])
def test_what_cannot_be_asked(arguments, status, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == status
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("error", [OverflowError("int too large to convert"), OSError(28, "No space left on device"), MemoryError(),
                                   RecursionError("too deep"), BadInput("wrong")], ids=lambda e: type(e).__name__)
def test_a_watch_outlives_any_error(error, tmp_path, monkeypatch, capsys):
    """What one state of the file shows is told, and the next one is drawn."""
    built, states = [], iter([error, None])

    def build(project, order):
        if (wrong := next(states)) is not None:
            raise wrong
        built.append(project)

    file = write(tmp_path, SLIDER, EVEN)
    monkeypatch.setattr(files, "saved", lambda paths: iter((None, None)))
    monkeypatch.setattr(build_commands, "build_one", build)
    assert run(["watch", file, "--lang", "en"]) == 0
    assert built == [file]
    told = [line for line in capsys.readouterr().err.splitlines() if "what led to it is kept" not in line]
    assert len(told) == 2


def test_each_time_a_file_is_saved(tmp_path):
    file, waits = tmp_path / "own.toml", iter(["first", "second"])
    file.write_text("")
    seen = files.saved([file, tmp_path / "none"], lambda seconds: file.write_text(next(waits) * 3))
    assert len([*islice(seen, 3)]) == 3
