"""What may be meant by a word: what begins so, before what is only spelt alike."""

import pytest

from tests.few import seldom
from tests.project_files import SLIDER, write
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.spelling import near
from tmm_sheets.task import variant

RESULTS = ["flywheel.v", "flywheel.m", "flywheel.H", "flywheel.J_reduced", "flywheel.J_flywheel", "gear.z1"]


@pytest.mark.parametrize(("word", "known", "found"), [
    ("flywheel.J", RESULTS, ["flywheel.J_reduced", "flywheel.J_flywheel"]),
    ("FLYWHEEL.h", RESULTS, ["flywheel.H"]),
    ("J_fly", RESULTS, ["flywheel.J_flywheel"]),
    ("flywhel.v", RESULTS, ["flywheel.v", "flywheel.m", "flywheel.H"]),
    ("shaper", ["lugansk/shaper", "press"], ["lugansk/shaper"]),
    ("01-", ["transport/diesel@01-Т-27"], ["transport/diesel@01-Т-27"]),
    ("", RESULTS, []),
    ("quite another", RESULTS, []),
    ("vel", ["levels", "velocities"], ["velocities"]),
])  # fmt: skip
def test_near(word, known, found):
    assert near(word, known, 3) == found


@pytest.mark.parametrize(("old", "new", "said"), [
    ('pivot = "A"', 'pivot = "А"', 'crank.pivot: unknown fixed point "А"\n    did you mean "A"? A: Latin there, Cyrillic here'),
    ("[crank]", "[сrank]", ":23: not valid TOML, column 2: invalid initial character for a key part\n    write crank (c: "),
    ('"0.08 m"', '"80 мm"', "unknown unit 'мm', did you mean 'мм'?"),
    ('"1.2 1/s"', '"7.5 рад/c"', "did you mean 'рад/с'? с: Cyrillic there, Latin here"),
    ('"clockwise"', '"сlockwise"', 'did you mean "clockwise"? c: Latin there, Cyrillic here'),
    ('A = ["0', 'А = ["0', "write A (A: Latin there, Cyrillic here)"),
])
def test_letters_that_look_the_same(old, new, said):
    """What cannot be seen is told by the alphabets."""
    text = catalogue.read("lugansk/shaper").text
    assert old in text
    with pytest.raises(BadInput) as e:
        variant.parse(text.replace(old, new, 1), "my.toml")
    assert said in str(e.value)


@pytest.mark.parametrize(("arguments", "hint"), [
    (["why", "lugansk/shaper", "flywheel.J"], "flywheel.J_flywheel"),
    (["why", "lugansk/shaper", "J_flywheel"], "did you mean flywheel.J_flywheel"),
    (["solve", "lugansk/shaper", "--part", "flywheell"], "; did you mean flywheel?"),
    (["build", "lugansk/shaper", "--format", "pdff"], "; did you mean pdf?"),
    (["note", "lugansk/shaper", "--format", "doc"], "; did you mean docx?"),
    seldom(["protocol", "lugansk/shaper", "--plan", "xyz"], "sheet 2: reduction"),
    (["protocol", "lugansk/shaper", "--plan", "vel"], "did you mean velocities?"),
    seldom(["protocol", "lugansk/shaper", "--plan", "accelerations@"], "did you mean accelerations@even?"),
    (["build", "my.tml"], "did you mean my.toml?"),
    (["build", "mi.toml"], "did you mean my.toml?"),
    (["check", "my"], "did you mean my.toml?"),
    (["check", "sub/other"], "did you mean sub/other-one.toml?"),
    (["check", "lugansk"], "did you mean lugansk/cam_flat"),
    (["build", "--all", "six"], 'did you mean "sixbar"?'),
    (["plot", "press", "--plotter", "a1_center"], "did you mean a1_centre?"),
])  # fmt: skip
def test_suggestions(arguments, hint, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "other-one.toml").touch()
    write(tmp_path, SLIDER)
    (tmp_path / "own.toml").rename(tmp_path / "my.toml")
    assert run(arguments) == 2
    assert hint in capsys.readouterr().err


def test_plans_are_listed_by_what_is_drawn(capsys):
    """Those that only serve a search are told when they are asked for, and not among the others."""
    assert run(["protocol", "lugansk/shaper", "--plan", "xyz"]) == 2
    said = capsys.readouterr().err
    assert [line.partition(": ")[0].strip() for line in said.splitlines()[1:5]] == [f"sheet {n}" for n in range(1, 5)]
    assert "@" not in said
    assert "-between" not in said
    assert run(["protocol", "lugansk/shaper", "--plan", "xyz", "--all"]) == 2
    every = capsys.readouterr().err
    assert "positions@limit" in every
    assert "gear-sliding-between" in every
    name = catalogue.shipped()[1]
    assert run(["protocol", name]) == 0
    short = capsys.readouterr().out
    assert run(["protocol", name, "--all"]) == 0
    assert len(capsys.readouterr().out) > len(short)
