"""Numbers in sentences have the decimal comma where the language has it; what stands in files or is to be typed keeps its point."""

import re
from decimal import Decimal
from itertools import product

import numpy as np
import pytest

from tests import catalogues
from tests.few import few
from tests.project_files import EVEN, SLIDER, write
from tmm_sheets import words
from tmm_sheets.__main__ import run
from tmm_sheets.numbers import in_a_row, listed

TYPED = re.compile(r"""
    "[^"]*" | '[^']*' | «[^»]*»                         # quoted
    | \{[^}]*\}                                         # a field
    | \b(?:ГОСТ|GOST)\s*[\d.]+ | \b[\w]+://\S+          # names with numbers in them
    | (?<![\w.])--?[a-z]\S*(?:[ ]\S*\d\S*)?             # an option
    | (?:наприклад|например)\b.*                        # what may be typed
    | \b[\w.]+\s=\s[\d.]+ (?=[,\s`]|$)                        # a key with its value
""", re.VERBOSE)  # fmt: skip


@pytest.fixture(params=["ru", "uk"])
def language(request):
    before = words.reader()
    words.set_reader(request.param)
    yield request.param
    words.set_reader(before)


def test_one_rule(language):
    text = words.tell("sheet {n}: {what}")
    assert text.format(n=1.5, what="x.y") == text.format(n="1,5", what="x.y")
    assert text.format(n=Decimal("0.25"), what=np.float64(2.5)).endswith("0,25: 2,5")
    assert text.format(n=3, what="3.5") == text.format(n="3", what="3.5")
    said = words.tell("the crank can swing to {angle:.2f} deg; 1 deg beyond it group {group} does not assemble: {why}")
    assert "217,60" in said.format(angle=217.6, group="2–3", why="0.5")
    assert "0.5" in said.format(angle=217.6, group="2–3", why="0.5")
    assert listed(-1.25) == "-1,25"
    assert in_a_row(map(listed, (1.5, 2.0))) == "1,5; 2"


def test_a_language_with_a_point():
    words.set_reader("en")
    assert words.tell("sheet {n}: {what}").format(n=1.5, what=0.25) == "sheet 1.5: 0.25"
    assert in_a_row(map(listed, (1.5, 2.0))) == "1.5, 2"


def test_the_paper_has_its_own_sign():
    words.set_reader("en")
    with words.on_paper("uk"):
        assert words.tr("sheet {n}: {what}").format(n=1.5, what="") != words.tell("sheet {n}: {what}").format(n=1.5, what="")
        assert "1,5" in words.tr("sheet {n}: {what}").format(n=1.5, what="")


def test_translations(language):
    """No sentence of a catalogue has a number with a point, but those that show what to type."""
    found = []
    for message in catalogues.read(language):
        said = message.string if isinstance(message.string, list | tuple) else (message.string,)
        found += [text for text in said if message.id and text and re.search(r"\d\.\d", TYPED.sub("", text))]
    assert [text for text in found if not re.search(r"\[[\d.\[]", text)] == []


def points(said):
    """Lines with a number that has a decimal point, outside what is quoted, typed, or a name."""
    return [line for line in said.splitlines() if re.search(r"(?<![\w./])\d+\.\d+(?![\w.]*\.[a-z]{3})", TYPED.sub("", line))]


def test_points_are_found():
    assert points("1.1 мм\nsheet1.dxf v0.1.x\nугол 217.6°\n--window 220.5,0\nдлина \"0.08 m\"\n") == ["1.1 мм", "угол 217.6°"]


COMMANDS = [
    ["check", "sixbar/4:2"], ["check", "transport/crusher@04-СДМ-358"], ["solve", "lugansk/shaper"], ["solve", "lugansk/cam_flat"],
    ["protocol", "lugansk/cam_rocker"], ["plot", "lugansk/cam_flat", "--dry-run", "--tile", "a4"],
    ["plot", "lugansk/cam_flat", "--dry-run", "--plotter", "a1"], ["build", "lugansk/cam_flat", "--format", "svg", "--explain"],
    ["stress", "--cases", "1"],
]  # fmt: skip


@pytest.mark.parametrize(("arguments", "spoken"), few(
    product(COMMANDS, ("ru", "uk")), *zip(COMMANDS, (*4 * ("ru", "uk"), "ru"), strict=True)))
def test_commands(arguments, spoken, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    run([*arguments, "--lang", spoken])
    told = capsys.readouterr()
    assert told.out
    assert points(told.out + told.err) == []


@pytest.mark.parametrize("changes", [
    {"guide[1].through": ["0 m", "-0.24 m"], "group[1].length": "0.3 m"},  # does not assemble at some positions
    {"scales": {"positions": 0.0001}},  # does not fit
    {"guide[1].through": ["0 m", "-0.1 m"], "group[1].length": "0.11 m"},
])  # fmt: skip
@pytest.mark.parametrize("spoken", ["ru", "uk"])
def test_refusals(changes, spoken, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    file = write(tmp_path, SLIDER, EVEN, changes)
    assert run(["build", file, "--lang", spoken, "-o", "out"]) == 1
    said = capsys.readouterr().err
    assert re.search(r"\d,\d", said) or "scales" in said
    assert points(said) == []


def test_what_is_to_be_written_into_a_file_has_its_point(tmp_path, capsys):
    """The factor that is proposed is one that the file is read with."""
    file = write(tmp_path, SLIDER, EVEN, {"scales": {"positions": 0.0001}})
    assert run(["build", file, "--lang", "ru", "-o", str(tmp_path / "out")]) == 1
    handy = re.search(r"scales.positions = ([\d.]+)", capsys.readouterr().err)[1]
    file = write(tmp_path, SLIDER, EVEN, {"scales": {"positions": float(handy)}})
    assert run(["build", file, "-o", str(tmp_path / "out")]) == 0


def test_json_has_points(capsys):
    assert run(["solve", "lugansk/cam_flat", "--json", "-", "--lang", "ru"]) == 0
    out = capsys.readouterr().out
    assert not re.search(r"\d,\d", out)
    assert re.search(r"\d\.\d", out)
