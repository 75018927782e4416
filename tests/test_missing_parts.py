"""A file that leaves tables out: what is there is read, solved, told and drawn; nothing empty stands on a sheet."""

import json
import re
from math import cos, sin, sqrt

import pytest

from tests.few import few
from tests.project_files import CAM, CRANK, FLYWHEEL, FORCE, GEAR, MASS, REDUCER, SLIDER, WORKING, project, write
from tests.sheets.unlettered import unlettered
from tmm_sheets import output
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task import variant

PRESSED = (SLIDER, WORKING, FORCE)
IDLE = {"cycle.force_position": "9"}
MERTSALOV = {"flywheel.method": "mertsalov"}
FILES = {
    "linkage": ((SLIDER,), ["kinematics"], {"positions", "velocities", "accelerations"}),
    "bare crank": ((CRANK,), ["kinematics"], {"positions", "velocities", "accelerations"}),
    "masses": ((SLIDER, MASS), ["kinematics_forces_wide"], {"positions", "forces"}),
    "force": (PRESSED, ["kinematics_forces_wide"], {"forces"}),
    "force on the other stroke": ((*PRESSED, IDLE), ["kinematics_forces_wide"], {"forces"}),
    "flywheel": ((*PRESSED, MASS, FLYWHEEL), ["kinematics_forces_wide", "flywheel"], {"forces", "flywheel"}),
    "mertsalov": ((*PRESSED, MASS, FLYWHEEL, MERTSALOV), ["kinematics_forces_wide", "sixbar_2"], {"forces", "flywheel"}),
    "gear": ((GEAR,), ["gear"], {"gear"}),
    "reducer": ((REDUCER,), ["reducer"], {"reducer"}),
    "gear and reducer": ((GEAR, REDUCER), ["gear_reducer"], {"gear", "reducer"}),
    "cam": ((CAM,), ["cam"], {"cam"}),
    "all": ((SLIDER, CAM, REDUCER, GEAR), ["kinematics", "gear_reducer", "cam"], {"positions", "gear", "reducer", "cam"}),
}
LINKAGE_PARTS = {"positions", "velocities", "accelerations", "forces"}


@pytest.mark.parametrize("name", few(FILES, "linkage", "mertsalov"))
def test_every_command_on_it(name, tmp_path, capsys):
    made_of, sheets, parts = FILES[name]
    file = write(tmp_path, *made_of)
    assert Project(variant.read(file)).sheets == tuple(sheets)
    out = tmp_path / "out"
    for words in (["check"], ["show"], ["protocol"], ["compare", "--template", "-o", str(out)],
                  ["build", "--format", "svg", "-o", str(out)]):
        status = run([words[0], file, *words[1:]])
        captured = capsys.readouterr()
        # What a sheet leaves out is told; there is nothing else to be told of these.
        left = [line for line in captured.err.splitlines() if not re.search("hodograph .* is left out|годограф .* не", line)]
        assert (status, left) == (0, []), words
        assert captured.out
    drawn = output.with_room(variant.read(file)).sheets  # kinematics and forces get a sheet each where one is too small
    assert drawn in (tuple(sheets), ("kinematics", "forces", *sheets[1:]))
    assert {p.name for p in out.glob("*.svg")} == {f"sheet{n}.svg" for n in range(1, len(drawn) + 1)}
    assert run(["solve", file, "--json", "-"]) == 0
    tree = json.loads(capsys.readouterr().out)
    assert parts <= tree.keys()
    assert "forces" not in tree or "forces" in parts


@pytest.mark.parametrize("name", few(
    [n for n, (made_of, _, _) in FILES.items() if CRANK.keys() <= made_of[0].keys()], "bare crank", "masses", "force"))
def test_nothing_empty_and_nothing_crowded_on_its_sheet(name):
    done = composed(project(*FILES[name][0]), 1)
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


def test_where_nothing_acts_there_is_no_force_plan():
    p = project(*PRESSED, IDLE)
    titles = [part.title for part in unlettered(p).parts]
    assert "Группа Ассура 2–3 (2-й вид)" in titles
    assert not any(title.startswith("План сил") for title in titles)
    assert abs(p.study.forces.balancing.at(p.force_index)) == 0


def test_the_default_cycle_and_the_numbers():
    """Twelve positions from the x axis on; the slider by the cosine rule."""
    p = project(SLIDER)
    assert p.cycle.labels == tuple(map(str, range(12)))
    assert p.diagrams == ("B",)
    for k, phi in enumerate(p.cycle.phi):
        assert phi == pytest.approx(k * 3.141592653589793 / 6)
        x = 0.1 * cos(phi) + sqrt(0.16 - 0.01 * sin(phi) ** 2)
        assert complex(p.study.positions.points["B"].at(k)) == pytest.approx(x, abs=1e-15)


def test_without_balancing_a_moment_drives_the_crank(capsys, tmp_path):
    """A piston's 100 N at the working position against the virtual power of the slider."""
    p = project(*PRESSED)
    assert p.balancing == "Mур"
    k = p.force_index
    v = complex(p.study.velocities.points["B"].at(k)).real
    assert v < 0
    assert float(p.study.forces.balancing.at(k)) == pytest.approx(-100.0 * v / p.mechanism.crank.omega, rel=1e-12)


def test_a_flywheel_without_what_it_needs_costs_nothing_else(tmp_path, capsys):
    for made_of, said in (((SLIDER,), "needs a technological force"), (PRESSED, "needs links with masses")):
        assert run(["build", write(tmp_path, *made_of, FLYWHEEL), "--format", "svg", "-o", str(tmp_path / "out")]) == 1
        captured = capsys.readouterr()
        n = int(re.match(r"sheet (\d) \(flywheel\) cannot be drawn: a flywheel ", captured.err)[1])
        assert captured.out.endswith(f"sheet{n - 1}.svg\n")
        assert said in captured.err


@pytest.mark.parametrize(("asked", "instead"), [
    ("kinematics_forces", "Планы скоростей"), ("engine_1", "Планы скоростей"), ("gear_reducer", "Основные параметры передачи"),
])  # fmt: skip
def test_arrangements_named_in_the_file_leave_out_what_is_missing(asked, instead):
    p = project({"project.sheets": [asked]}, SLIDER if "gear" not in asked else GEAR)
    titles = {part.title for part in unlettered(p).parts}
    assert any(instead in title for title in titles), titles
    assert not any("сил" in title or "едуктор" in title for title in titles)


def test_nothing_at_all():
    with pytest.raises(BadInput, match="there is nothing to draw"):
        project()


def test_sheets_that_have_nothing_to_show(tmp_path, capsys):
    for sheet, said in (("cam", "the file has nothing of what these sheets show"), ("sixbar_2", "the project has no ")):
        file = write(tmp_path, {"project.sheets": [sheet]}, GEAR)
        assert run(["build", file, "-o", str(tmp_path / "out")]) == 1
        assert said in capsys.readouterr().err
        assert run(["solve", file]) == 0
        assert "eps_alpha" in capsys.readouterr().out
    assert not (tmp_path / "out").exists()
