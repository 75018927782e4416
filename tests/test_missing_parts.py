"""A file that leaves tables out: what is there is read, solved, told and drawn; nothing empty stands on a sheet."""

import json
from math import cos, sin, sqrt

import pytest

from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task import variant

HEAD = 'schema = 1\n[project]\nname = "own"\ntitle = "Механизм"\n'
SLIDER = """
[crank]
link = "1"
pivot = "O"
pin = "A"
length = "0.1 m"
speed = "60 rpm"
sense = "counter-clockwise"
[points]
O = ["0 m", "0 m"]
[[guide]]
name = "x"
through = "O"
[[group]]
kind = 2
links = ["2", "3"]
outer = ["A"]
inner = "B"
length = "0.4 m"
guide = "x"
"""
BARE_CRANK = SLIDER.partition("[[guide]]")[0]
CYCLE = '[cycle]\nstart = "dead"\noutput = "B"\nworking_sense = "-x"\nworking = 6\nidle = 6\nforce_position = "{}"\n'
FORCE = """
[[force]]
name = "F3"
link = "3"
point = "B"
direction = "against motion"
stroke = "working"
value = "100 N"
sense = "-x"
"""
MASS = '[[link]]\nname = "3"\nmass = "5 kg"\ncentre = "B"\n'
FLYWHEEL = '[flywheel]\nmethod = "{}"\ndelta = 0.05\ndensity = "7300 kg/m3"\nwidth_ratio = 0.2\nthickness_ratio = 0.1\n'
GEAR = '[gear]\nteeth = [14, 28]\nmodule = "3.5 mm"\nshift = "rule"\npressure_angle = "20 deg"\n'
REDUCER = """
[reducer]
scheme = "external-internal"
simple = "after"
input_speed = "3000 rpm"
output_speed = "200 rpm"
teeth = { z5 = 12 }
module = "6 mm"
simple_module = "12 mm"
satellites = 3
"""
CAM = ('[cam]\nfollower = "translating roller"\nlaw = "sine"\nrise = "100 deg"\nfall = "70 deg"\nstroke = "10 mm"\n'
       'pressure_angle = "30 deg"\n')
IDLE, WORKING = CYCLE.format(9), CYCLE.format(3)

FILES = {
    "linkage": (SLIDER, ["kinematics"], {"positions", "velocities", "accelerations"}),
    "bare crank": (BARE_CRANK, ["kinematics"], {"positions", "velocities", "accelerations"}),
    "masses": (SLIDER + MASS, ["kinematics_forces_wide"], {"positions", "forces"}),
    "force": (SLIDER + WORKING + FORCE, ["kinematics_forces_wide"], {"forces"}),
    "force on the other stroke": (SLIDER + IDLE + FORCE, ["kinematics_forces_wide"], {"forces"}),
    "flywheel": (SLIDER + WORKING + FORCE + MASS + FLYWHEEL.format("wittenbauer"), ["kinematics_forces_wide", "flywheel"],
                 {"forces", "flywheel"}),
    "mertsalov": (SLIDER + WORKING + FORCE + MASS + FLYWHEEL.format("mertsalov"), ["kinematics_forces_wide", "sixbar_2"],
                  {"forces", "flywheel"}),
    "gear": (GEAR, ["gear"], {"gear"}),
    "reducer": (REDUCER, ["reducer"], {"reducer"}),
    "gear and reducer": (GEAR + REDUCER, ["gear_reducer"], {"gear", "reducer"}),
    "cam": (CAM, ["cam"], {"cam"}),
    "all": (SLIDER + CAM + REDUCER + GEAR, ["kinematics", "gear_reducer", "cam"], {"positions", "gear", "reducer", "cam"}),
}
LINKAGE_PARTS = {"positions", "velocities", "accelerations", "forces"}


@pytest.mark.parametrize("name", FILES)
def test_every_command_on_it(name, tmp_path, capsys):
    text, sheets, parts = FILES[name]
    file = tmp_path / "own.toml"
    file.write_text(HEAD + text, encoding="utf-8")
    assert Project(variant.read(file)).sheets == tuple(sheets)
    out = tmp_path / "out"
    for words in (["check"], ["show"], ["protocol"], ["compare", "--template", "-o", str(out)],
                  ["build", "--format", "svg", "-o", str(out)]):
        status = run([words[0], str(file), *words[1:]])
        captured = capsys.readouterr()
        assert (status, captured.err) == (0, ""), words
        assert captured.out
    assert {p.name for p in out.glob("*.svg")} == {f"sheet{n}.svg" for n in range(1, len(sheets) + 1)}
    assert run(["solve", str(file), "--json", "-"]) == 0
    tree = json.loads(capsys.readouterr().out)
    assert parts <= tree.keys()
    assert "forces" not in tree or "forces" in parts


@pytest.mark.parametrize("name", [n for n, (text, _, _) in FILES.items() if "[crank]" in text])
def test_nothing_empty_and_nothing_crowded_on_its_sheet(name):
    project = Project(variant.parse(HEAD + FILES[name][0], "own.toml"))
    done = composed(project, 1)
    assert not done.crowded
    titles = {part.title for part in done.parts}
    if "forces" in FILES[name][2]:
        assert {"Группа Ассура 2–3 (2-й вид)", "План сил группы 2–3"} <= titles
    else:
        assert not any("сил" in title or "Группа" in title for title in titles)
    # A view is more than its title and its scale factor.
    firsts = [part.first for part in done.parts] + [len(done.drawing.marks)]
    for part, first, end in zip(done.parts, firsts, firsts[1:], strict=False):
        said = [group.text for group in done.groups if first <= group.first < end]
        assert not part.title or end - first > 2 or "В этом положении сил нет" in said, part.title


def test_where_nothing_acts_it_is_said():
    project = Project(variant.parse(HEAD + FILES["force on the other stroke"][0], "own.toml"))
    assert [group.text for group in composed(project, 1).groups].count("В этом положении сил нет") == 2
    assert abs(project.study.forces.balancing.at(project.force_index)) == 0


def test_the_default_cycle_and_the_numbers():
    """Twelve positions from the x axis on; the slider by the cosine rule."""
    project = Project(variant.parse(HEAD + SLIDER, "own.toml"))
    assert project.cycle.labels == tuple(map(str, range(12)))
    assert project.diagrams == ("B",)
    for k, phi in enumerate(project.cycle.phi):
        assert phi == pytest.approx(k * 3.141592653589793 / 6)
        x = 0.1 * cos(phi) + sqrt(0.16 - 0.01 * sin(phi) ** 2)
        assert complex(project.study.positions.points["B"].at(k)) == pytest.approx(x, abs=1e-15)


def test_without_balancing_a_moment_drives_the_crank(capsys, tmp_path):
    """A piston's 100 N at the working position against the virtual power of the slider."""
    project = Project(variant.parse(HEAD + SLIDER + WORKING + FORCE, "own.toml"))
    assert project.balancing == "Mур"
    k = project.force_index
    v = complex(project.study.velocities.points["B"].at(k)).real
    assert v < 0
    assert float(project.study.forces.balancing.at(k)) == pytest.approx(-100.0 * v / project.mechanism.crank.omega, rel=1e-12)


def test_a_flywheel_without_what_it_needs_costs_nothing_else(tmp_path, capsys):
    file = tmp_path / "own.toml"
    for extra, said in (("", "needs a technological force"), (WORKING + FORCE, "needs links with masses")):
        file.write_text(HEAD + SLIDER + extra + FLYWHEEL.format("wittenbauer"), encoding="utf-8")
        assert run(["build", str(file), "--format", "svg", "-o", str(tmp_path / "out")]) == 1
        captured = capsys.readouterr()
        assert captured.out.endswith("sheet1.svg\n")
        assert captured.err.startswith("sheet 2 (flywheel) cannot be drawn: a flywheel ")
        assert said in captured.err


@pytest.mark.parametrize(("asked", "instead"), [
    ("kinematics_forces", "Планы скоростей"), ("engine_1", "Планы скоростей"), ("gear_reducer", "Основные параметры передачи"),
])  # fmt: skip
def test_arrangements_named_in_the_file_leave_out_what_is_missing(asked, instead):
    body = SLIDER if "gear" not in asked else GEAR
    project = Project(variant.parse(HEAD + f'sheets = ["{asked}"]\n' + body, "own.toml"))
    titles = {part.title for part in composed(project, 1).parts}
    assert any(instead in title for title in titles), titles
    assert not any("сил" in title or "едуктор" in title for title in titles)


def test_nothing_at_all():
    with pytest.raises(BadInput, match="there is nothing to draw"):
        variant.parse(HEAD, "own.toml")


def test_sheets_that_have_nothing_to_show(tmp_path, capsys):
    file = tmp_path / "own.toml"
    for sheet, said in (("cam", "the file has nothing of what these sheets show"), ("sixbar_2", "the project has no ")):
        file.write_text(HEAD + f'sheets = ["{sheet}"]\n' + GEAR, encoding="utf-8")
        assert run(["build", str(file), "-o", str(tmp_path / "out")]) == 1
        assert said in capsys.readouterr().err
        assert run(["solve", str(file)]) == 0
        assert "eps_alpha" in capsys.readouterr().out
    assert not (tmp_path / "out").exists()
