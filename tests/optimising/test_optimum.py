"""The examples of docs/optimise.md against grids; wishes; what cannot be asked."""

import itertools
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import tmm_sheets
from tests.few import few
from tests.test_docs import parsed
from tmm_sheets.__main__ import run
from tmm_sheets.optimising import optimum, wishes

DOC = (Path(__file__).parents[2] / "docs" / "optimise.md").read_text("utf-8")
EXAMPLES = re.findall(r"^```sh\n(.*?)\n```\n\n```text\n(.*?)^```$", DOC, re.MULTILINE | re.DOTALL)
KNOWN = ("positions.points.D", "positions.angles.3", "cam.pressure_angle", "gear.sa1", "gear.a_w", "reducer.a_w",
         "forces.arms.h50′")
VALUES = {"positions.points.D": np.array([3 + 4j, 0j, 6 + 8j]), "positions.angles.3": np.array([0.5, -1, 0.2]), "gear.sa1": 1.5,
          "cam.pressure_angle": np.array([-0.6, 0.1]), "gear.a_w": 70.0, "forces.arms.h50′": np.array([2.0])}


@pytest.fixture(scope="module")
def p():
    return tmm_sheets.open("lugansk/shaper")


@pytest.mark.parametrize(("command", "said"), few(EXAMPLES, EXAMPLES[0]))
def test_examples_are_no_worse_than_a_grid(p, command, said, tmp_path):
    with parsed(shlex.split(command)[1:]) as context:
        asked = context.params
    found = p.optimise(asked["vary"], asked["least"], subject_to=asked["bounds"])
    assert str(found).splitlines() == said.splitlines()
    s = found.search
    known = optimum.Known(p.project, optimum.POSITIONS)
    names = tuple(dict.fromkeys(name for w in (s.wish, *(w for b in s.bounds for w in (b.left, b.right))) for name in w.names))
    way = (optimum.Quick if s.by_function else optimum.Whole)(
        known, s.varied, lambda c: p.with_(c).project, names)
    grid = optimum.Asked(s.varied, s.wish, s.bounds, s.most, way, 0, lambda n: None)
    along = 41 if s.by_function else 11
    for shares in itertools.product(np.linspace(0, 1, along), repeat=len(s.varied)):
        grid.trial(tuple(v.at(x) for v, x in zip(s.varied, shares, strict=True)))
    assert len(grid.made) == along ** len(s.varied)
    assert any(t.key[0] == 0 for t in grid.made.values())
    assert all(s.best.key <= t.key for t in grid.made.values())
    # The file gives the numbers that are told.
    again = tmm_sheets.open(found.opened.save(tmp_path / "best.toml"))
    assert s.wish(way.of(again.project)) == pytest.approx(s.best.value, rel=1e-11)
    assert s.svg().startswith(b"<?xml")


def test_there_are_three():
    assert len(EXAMPLES) == 3


@pytest.mark.parametrize(("text", "value"), [
    ("max |pressure angle|", 0.6), ("max cam.pressure_angle", 0.1), ("min pressure_angle + 1", 0.4),
    ("range(positions.angles.3)", 1.5), ("max |positions.points.D|", 10),
    ("mean positions.points.D.x", 3), ("max(positions.points.D.y) / 2 - 1,5", 2.5),
    ("-(2 - 3) * 4", 4), ("max(gear.sa1, 1 mm, 0.3)", 1.5), ("gear.sa1 - 1.4 mm", 0.1), ("max |positions.points.D| - 100 mm", 9.9),
    ("180 deg", np.pi), ("max(|gear.sa1 - 3|, 1)", 1.5), ("max h50′", 2), ("min(gear.sa1, gear.a_w) − 1", 0.5), ("abs(-2)", 2),
])
def test_wishes_are_read(text, value):
    assert wishes.wish(text, KNOWN)(VALUES) == pytest.approx(value)


@pytest.mark.parametrize(("text", "said"), [
    ("a_w", "may be gear.a_w or reducer.a_w"), ("gear.sa2", "did you mean gear.sa1"), ("max(", "expected a name"),
    ("|gear.sa1", "is missing"), ("gear.sa1 )", "no meaning"), ("gear.sa1 #", "no meaning"), ("2 furlongs", "unknown unit"),
    ("mean(1, 2)", "takes one"), ("", "expected a name"),
])
def test_what_cannot_be_wished(text, said):
    with pytest.raises(tmm_sheets.BadInput, match=re.escape(said)):
        wishes.wish(text, KNOWN)


@pytest.mark.parametrize("text", ["positions.angles.3", "positions.points.D", "max positions.points.D - positions.points.D"])
def test_a_wish_is_one_real_number(text):
    with pytest.raises(tmm_sheets.BadInput, match="single real number"):
        wishes.wish(text, KNOWN)(VALUES)


@pytest.mark.parametrize(("text", "missed"), [
    ("gear.sa1 <= 2", 0), ("gear.sa1 >= 2 mm", 0.25), ("2 < gear.sa1", 0.25),
    ("max |pressure angle| ≤ 30 deg", 1 - np.radians(30) / 0.6),
])
def test_bounds(text, missed):
    assert wishes.bound(text, KNOWN).missed(VALUES) == pytest.approx(missed)
    with pytest.raises(tmm_sheets.BadInput, match="expected <="):
        wishes.bound("gear.sa1 + 2", KNOWN)


@pytest.mark.parametrize(("text", "value", "unit"), [
    ("crank.length=70..90 mm", "80 mm", "mm"), ("gear.teeth[0] = 12..20", 16, ""), ("x = -0,5..0.5", 0.0, ""),
    ("group[0].at=10 deg..20 deg", "15 deg", "deg"),
])
def test_ranges(text, value, unit):
    v = optimum.varied(text, {"gear": {"teeth": [14, 28]}})
    assert (v.value(v.at(0.5)), v.unit) == (value, unit)
    assert v.at(0) == v.low
    assert v.at(1) == v.high


@pytest.mark.parametrize("text", ["crank.length", "crank.length=70 mm", "crank.length=90..70 mm", "=1..2", "x=1 m..2 mm", "x=a..b"])
def test_what_is_no_range(text):
    with pytest.raises(tmm_sheets.BadInput):
        optimum.varied(text, {})


@pytest.mark.parametrize(("vary", "wish", "most", "said"), [
    (["crank.length=70..90 mm"], "gear.eps_alpha", "x", "either"), ([], "gear.eps_alpha", "", "nothing is varied"),
    (["crank.length=70..90 mm", "crank.length=1..2 m"], "gear.eps_alpha", "", "crank.length is varied twice"),
    (["crank.lenght=70..90 mm"], "gear.eps_alpha", "", "did you mean"),
    (["gear.module=70..90 kg"], "gear.eps_alpha", "", "such as that of 3.5 mm"),
    (["crank.length=70..90"], "gear.eps_alpha", "", "such as that of 0.08 m"),
])
def test_what_cannot_be_asked(p, vary, wish, most, said):
    with pytest.raises((tmm_sheets.BadInput, tmm_sheets.CannotBuild), match=said):
        p.optimise(vary, wish, most=most)


def test_bounds_that_nothing_keeps(p):
    with pytest.raises(tmm_sheets.CannotBuild, match=r"keeps the bounds\n    nearest come gear\.shift"):
        p.optimise({"gear.shift[0]": "0.1..0.3"}, "gear.a_w", subject_to=["gear.eps_alpha >= 3"], tries=20)


def test_whole_numbers_and_the_greatest(p):
    found = p.optimise({"gear__teeth__0": "12..20"}, most="gear.eps_alpha", tries=40)
    assert found.opened.project.variant.gear.teeth == (20, 28)
    assert found.search.best.value == pytest.approx(-found.opened.numbers("gear")["gear.eps_alpha"])
    assert found.search.now.numbers == (14,)


def test_the_function_is_not_relied_on_where_a_search_matters(p):
    """How the working stroke lies depends on the crank; the same by a project made anew."""
    way = optimum.Quick(optimum.Known(p.project, 24), [optimum.varied("crank.length=70..90 mm", p.project.variant.data)],
                         lambda c: p.with_(c).project, ["flywheel.J_flywheel"])
    assert not way.ready


def test_the_search_of_hard_functions():
    def least(of, dimensions):
        made = []

        def ask(x):
            made.append(of(x))
            return made[-1]

        optimum.search(ask, dimensions, 400)
        return min(made)

    assert least(lambda x: (0.0, 16 * (x[1] - x[0] ** 2) ** 2 + (1 - 1.3 * x[0]) ** 2), 2)[1] < 1e-5  # a bent valley
    assert least(lambda x: (max(0.0, 1 - x[0] - 2 * x[1]), x[0] + x[1]), 2) == (0, pytest.approx(0.5, abs=1e-3))
    assert least(lambda x: (0.0, abs(x[0] - 0.3) + abs(x[1] - 0.7) + 3 * abs(x[0] - x[1] + 0.4)), 2)[1] < 5e-3  # creases
    assert least(lambda x: (0.0, float(np.sum((x - 0.3) ** 2))), 4)[1] < 1e-4


def test_the_command(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    command = ["optimise", "lugansk/shaper", "--vary", "gear.shift[0]=0.1..0.5", "--least", "|theta1_greatest|", "--tries", "30"]
    assert run([*command, "--lang", "en"]) == 0
    assert "gear.shift[0]" in capsys.readouterr().out
    assert {p.name for p in (tmp_path / "out/lugansk-shaper").iterdir()} == {"optimised.toml", "optimised.svg"}
    assert run([*command, "-o", "out/lugansk-shaper/optimised.toml"]) == 2
    assert run([*command, "-o", "a.txt"]) == 2
    assert run([*command, "--most", "gear.a_w"]) == 2
    assert run(["check", "out/lugansk-shaper/optimised.toml"]) == 0
