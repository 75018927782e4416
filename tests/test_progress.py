"""Progress on a terminal: after a second, also when the work tells only once what it does."""

import sys
from time import sleep

import pytest

from tmm_sheets import terminal


@pytest.fixture
def watched(monkeypatch):
    """Makes of what stands for standard error in a test a terminal, and patience short."""
    def watch(patience):
        monkeypatch.setattr(terminal, "PATIENCE", patience)
        monkeypatch.setattr(sys.stderr, "isatty", lambda: True)

    return watch


def test_one_long_step_is_told(watched, capsys):
    watched(0.05)
    with terminal.Progress() as told:
        told.say("looking for the frame ...")
        told.late.join()
        assert capsys.readouterr().err == "\r\033[Klooking for the frame ..."
    assert capsys.readouterr().err == "\r\033[K"


def test_short_work_is_silent(watched, capsys):
    watched(60.0)
    with terminal.Progress() as told:
        told.say("reading ...")
        told.say("writing ...")
    assert capsys.readouterr().err == ""
    assert not told.late.is_alive()


def test_nothing_is_told_to_a_file(capsys, monkeypatch):
    monkeypatch.setattr(terminal, "PATIENCE", 0.0)
    with terminal.Progress() as told:
        told.say("reading ...")
        sleep(0.01)
        told.say("writing ...")
    assert capsys.readouterr().err == ""
