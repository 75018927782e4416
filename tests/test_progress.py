"""Progress on a terminal: after a second, also when the work tells only once what it does."""

import sys
from time import sleep

import pytest

from tmm_sheets import progress


@pytest.fixture
def terminal(monkeypatch, capsys):  # capsys first: it puts another stderr in place
    del capsys
    monkeypatch.setattr(progress, "PATIENCE", 0.01)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)


@pytest.mark.usefixtures("terminal")
def test_one_long_step_is_told(capsys):
    with progress.Progress() as told:
        told.say("looking for the frame ...")
        sleep(0.2)
        assert capsys.readouterr().err == "\r\033[Klooking for the frame ..."
    assert capsys.readouterr().err == "\r\033[K"


@pytest.mark.usefixtures("terminal")
def test_short_work_is_silent(capsys, monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE", 60.0)
    with progress.Progress() as told:
        told.say("reading ...")
        told.say("writing ...")
    assert capsys.readouterr().err == ""


def test_nothing_is_told_to_a_file(capsys, monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with progress.Progress() as told:
        told.say("reading ...")
        sleep(0.05)
    assert capsys.readouterr().err == ""
