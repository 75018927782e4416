"""Each step that a build evaluates is drawn, printed or made into one that is; the exceptions are few, and have reasons."""

import pytest

from tests.few import seldom
from tmm_sheets import catalogue, kept
from tmm_sheets.__main__ import run
from tmm_sheets.construction.step import Step
from tmm_sheets.explain import listening
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import every

EXCEPTIONS = {
    "mechanism.groups.dead_centres": "where the crank of a stroke begins",
    "methods.linkage.numbering": "the angles between dead positions, which are divided",
    "methods.flywheel.reduced": "steps of a graph are halved where the curve between two positions says so",
    "methods.flywheel.intervals": "borders of the graphs",
    "methods.flywheel.works": "chords of the graphs",
    "methods.flywheel.diagram_scales": "scale factors that the graphs fit their room with",
    "methods.flywheel.flywheel": "the limit for many positions, numbers that views print of it",
    "methods.flywheel.wheel_methods": "first energies and the speeds between them, numbers that views print of it",
    "methods.flywheel.energy_mass": "tangents of the diagram and where they touch",
    "methods.flywheel.wheel": "sizes of the wheel and the motor's slip, numbers that views print of it",
    "methods.gears.gear_geometry": "whether the pair is possible: tips beyond base circles, a distance that its teeth allow",
    "methods.gears.gear_pair": "whether a rack cuts into the flank, where the fillet begins; the greatest sliding",
    "methods.cams.cam_motion": "second derivatives, which the curvature is made of",
    "methods.cams.cam_profile": "the least radius of each part of the turn: the greatest of them is drawn",
    "methods.cams.cam_inversion": "the angle at which the spring is needed most",
}
"""Modules that decide by a step, or tell it on as a plain number."""


@pytest.mark.parametrize("name", ["lugansk/shaper", seldom("press"), seldom("sixbar/5:5")])
def test_what_is_evaluated_is_shown(name, monkeypatch):
    monkeypatch.setenv(kept.FOLDER, "")  # a sheet that is kept evaluates nothing
    project = Project(catalogue.read(name))
    with listening() as found:
        drawn = every(project).drawn
    steps = [s for plans in project.plans.values() for plan in (plans or {}).values() for s in (*plan, *plan.auxiliaries.values())]
    told = found.told(steps, {n: composed.drawing for n, composed in drawn.items()})
    assert {step for step in steps if step.evaluated and isinstance(step.seconds, list)} <= told.keys()
    assert all(asker.said for asker in told.values())
    deciding = {found.readers[step].module for step, asker in told.items() if not asker.shown and step in found.readers}
    assert deciding <= EXCEPTIONS.keys()
    assert sum(asker.shown for asker in told.values()) > 0.6 * len(told)
    pin = project.study.positions.points["B" if name != "press" else "A"]
    assert told[pin].shown
    assert told[pin].said.startswith("drawn on sheet 1: ")


def test_listening_changes_nothing_and_ends():
    usual = vars(Step)["value"]
    with listening() as found:
        heard = Project(catalogue.read("lugansk/shaper")).study.positions.points["B"].value
    assert vars(Step)["value"] is usual
    n = len(found.readers)
    assert n
    assert (Project(catalogue.read("lugansk/shaper")).study.positions.points["B"].value == heard).all()
    assert len(found.readers) == n


def test_askers_are_told(tmp_path, capsys):
    assert run(["build", "lugansk/shaper", "--sheet", "3", "--explain", "--no-cache", "--format", "svg", "-o", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.split("asked for\n")[1].splitlines()
    assert len(lines) > 100
    for said in ("drawn on sheet 3: ", "read by sheets.gears.gear for sheet 3, gear.", "for gear-"):
        assert any(f" {said}" in line for line in lines)
