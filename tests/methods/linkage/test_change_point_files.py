"""Project files of mechanisms with change points: what the commands tell, and say."""

import json
from math import pi

import numpy as np
import pytest

from tmm_sheets import __main__

FILE = """schema = 1

[project]
name = "own/pg"
title = "t"
sheets = ["kinematics_forces"]

[crank]
link = "1"
pivot = "A"
pin = "B"
length = "60 mm"
speed = "60 rpm"
sense = "SENSE"

[points]
A = ["0 mm", "0 mm"]
D = ["120 mm", "0 mm"]

[[group]]
kind = 1
links = ["2", "3"]
outer = ["B", "D"]
inner = "C"
lengths = ["120 mm", "60 mm"]
side = 1

[[link]]
name = "2"
mass = "2 kg"
centre = "B"
inertia = "0.01 kg m2"

[[link]]
name = "3"
mass = "3 kg"
centre = "C"
inertia = "0.01 kg m2"

[cycle]
start = "0 deg"
positions = 8

[balancing]
kind = "moment"
name = "Mb"
""".replace("SENSE", "counter-clockwise")
FOLLOW = ("side = 1\n", 'side = 1\nbranch = "follow"\n')
LOADED = ("positions = 8\n", 'positions = 8\nforce_position = "4"\n')
W = 2 * pi


@pytest.fixture
def solved(tmp_path, monkeypatch, capsys):
    """Numbers of a file after some changes, with what was said."""
    monkeypatch.chdir(tmp_path)

    def solve(*changes, options=()):
        text = FILE
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "my.toml").write_text(text, encoding="utf-8")
        status = __main__.run(["--lang", "en", "solve", "my.toml", "--json", "-", *options])
        out, err = capsys.readouterr()
        return (json.loads(out) if out else None), err, status

    return solve


def test_the_parallelogram_at_180_degrees(solved):
    found, err, status = solved(LOADED)
    assert status == 0
    assert found["velocities"]["omega"]["3"][:5] == pytest.approx([W] * 5)
    assert [abs(x) < 1e-12 for x in found["accelerations"]["epsilon"]["3"][:5]] == [True] * 5
    assert found["accelerations"]["points"]["C"][4] == pytest.approx([0.06 * W**2, 0.0], abs=1e-14)
    for way in ("kinetostatics", "lever"):
        assert found["forces"]["balancing"][way] == pytest.approx([-2.943], rel=1e-10)
    assert found["forces"]["reactions"]["F21"] == [[None, None]]
    assert found["condition"]["velocities"][4] is None
    assert "position 4: reactions grow beyond all bounds" in err
    # Behind it the coupler goes on crossed: that is said.
    assert found["velocities"]["omega"]["3"][5] == pytest.approx(-2.40783, abs=1e-5)
    assert "stretched or folded at crank angles 0.0, 180.0 deg" in err
    assert 'write branch = "follow" in the group' in err


def test_follow_goes_round(solved):
    found, err, _ = solved(FOLLOW)
    assert found["velocities"]["omega"]["3"] == pytest.approx([W] * 8)
    assert found["forces"]["label"] == ["1"]  # the first that is in no change point
    assert err == ""
    one, *_ = solved(FOLLOW, options=["--phi", "225"])
    assert one["velocities"]["points"]["C"][0] == pytest.approx(found["velocities"]["points"]["C"][5], abs=1e-15)


def test_clockwise_the_side_behind_position_0_is_meant(solved):
    """With the crank turning the other way side 1 is that of the antiparallelogram just behind position 0."""
    found, *_ = solved(FOLLOW, ("counter-clockwise", "clockwise"))
    assert found["velocities"]["omega"]["3"][0] == pytest.approx(3 * W)
    turned, *_ = solved(FOLLOW, ("counter-clockwise", "clockwise"), ("side = 1\n", "side = -1\n"))
    assert turned["velocities"]["omega"]["3"] == pytest.approx([-W] * 8)


@pytest.mark.parametrize("count", [1000, 5000])
def test_many_positions_hold_no_rounding(solved, count):
    found, *_ = solved(FOLLOW, options=["--positions", str(count), "--part", "accelerations"])
    assert max(map(abs, found["accelerations"]["epsilon"]["3"])) < 1e-12 * W**2


def test_what_the_file_may_say(solved):
    _, err, status = solved(("side = 1\n", 'side = 1\nat = "10 deg"\n'))
    assert status == 2
    assert 'write branch = "follow", or leave it out' in err
    _, err, status = solved(("kind = 1\n", "kind = 3\n"), ("side = 1\n", 'branch = "follow"\n'), ('inner = "C"\n', ""),
                            ('lengths = ["120 mm", "60 mm"]\n', ""))
    assert status == 2
    assert "a group of kind 3 has none" in err


@pytest.mark.parametrize("options", [(), ("--phi", "280.7"), ("--positions", "5000")])
def test_a_group_that_comes_back_to_the_other_side_is_refused_at_any_angle(solved, options):
    found, err, status = solved(FOLLOW, ('["120 mm", "60 mm"]', '["100 mm", "80 mm"]'), options=options)
    assert status == 1
    assert found is None
    assert "after a turn of the crank it stands on the other side" in err


def test_build_says_it_and_draws_no_force_without_bounds(solved, tmp_path, capsys):
    solved()
    assert __main__.run(["--lang", "en", "build", "my.toml", "--format", "svg", "-o", "out"]) == 0
    assert "its links turn back at once" in capsys.readouterr().err
    solved(LOADED)
    assert __main__.run(["--lang", "en", "build", "my.toml", "--format", "svg", "-o", "out2"]) == 1
    assert 'for example force_position = "1"' in capsys.readouterr().err


def test_a_sheet_holds_no_rounding(solved, tmp_path):
    """Epsilon of a parallelogram is nothing beside the normal accelerations, and is written so."""
    solved(FOLLOW)
    assert __main__.run(["build", "my.toml", "--format", "svg", "--text", "live", "-o", "out"]) == 0
    assert "0,00000" not in (tmp_path / "out/sheet1.svg").read_text(encoding="utf-8")


SHOWN = ('positions = 8\n', 'positions = 8\ndiagrams = ["3"]\n')
ALONE = ('sheets = ["kinematics_forces"]', 'sheets = ["kinematics"]')


def test_graphs_of_a_rocker_that_turns_as_the_crank_does(solved, tmp_path, capsys):
    """Omega is level and has no size to be read, epsilon is zero and said so; both are drawn, and rounding is not."""
    solved(FOLLOW, SHOWN, ALONE)
    assert __main__.run(["--lang", "en", "build", "my.toml", "--format", "svg", "-o", "out"]) == 0
    assert "graph of" not in capsys.readouterr().err
    assert __main__.run(["--lang", "en", "record", "my.toml", "--json", "r.json"]) == 0
    (sheet,) = json.loads((tmp_path / "r.json").read_text("utf-8"))["sheets"]
    assert not any("0,0000" in mark["geometry"]["text"]["string"] for mark in sheet["marks"] if "text" in mark["geometry"])
    high = {mark["view"]: np.ptp([y for _, y in mark["geometry"]["polyline"]])
            for mark in sheet["marks"] if mark["role"] == "curve"}
    assert high["Graph of ω3"] == pytest.approx(0, abs=1e-9)
    assert high["Graph of ε3"] == pytest.approx(0, abs=1e-9)
    assert high["Graph of ψ3"] > 60
