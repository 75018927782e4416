"""Project files of mechanisms that stand in no manual: everything a shipped project can, from the file alone."""

from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest

from tests.few import few, seldom
from tests.project_files import EVEN, MASS, MOMENT, SLIDER, read
from tmm_sheets import summary
from tmm_sheets.__main__ import run
from tmm_sheets.drawing.marks import Arc, Text, flat
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets import composing
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task import variant
from tmm_sheets.task.title_entries import Names

FILES = [path for path in sorted((Path(__file__).parents[1] / "projects").glob("*.toml"))
         if "[crank]" in path.read_text(encoding="utf-8")]


EVERY_KIND = [path for path in FILES if path.stem in ("feeder", "planer", "sieve")]
"""Projects with groups of all six kinds, and guides on moving links."""
FEEDER = next(path for path in FILES if path.stem == "feeder")
"""Drawn by other tests as well: its sheets are composed once for all."""
NAME = attrgetter("stem")


@pytest.fixture(scope="module", params=few(FILES, *EVERY_KIND), ids=NAME)
def project(request):
    return Project(variant.read(request.param))


def test_all_kinds_are_there():
    kinds = {g.kind.number for path in EVERY_KIND for g in Project(variant.read(path)).mechanism.groups}
    assert kinds == {1, 2, 3, 4, 5, 6}
    assert any(g.link != "0" for path in EVERY_KIND for g in Project(variant.read(path)).mechanism.guides.values())


def test_it_is_shown_and_checked(project):
    project.check()
    told = summary.text(project.variant, Names())
    assert "Mobility W = 3n - 2 p5 - p4" in told
    assert told.count("class 2, order 2") + told.count("class 3, order 3") == len(project.mechanism.groups)
    assert project.mechanism.mobility == 1


def test_lever_agrees_with_kinetostatics_at_every_position(project):
    forces, lever = project.study.forces, project.study.lever
    kinetic = forces.balancing.value
    if lever.direction is not None:
        kinetic = (kinetic * np.conj(lever.direction)).real
    np.testing.assert_allclose(kinetic, lever.balancing.value, atol=1e-9 * np.abs(lever.balancing.value).max())


@pytest.mark.parametrize("project", few(FILES, FEEDER), indirect=True, ids=NAME)
@pytest.mark.parametrize("sheet", [1, 2])
def test_sheets_are_clean(project, sheet):
    done = composed(project, sheet)
    assert not done.crowded
    for mark in done.drawing.marks:
        if mark.of == "title block":
            continue
        p = text_box(mark) if isinstance(mark, Text) else flat(mark)
        assert np.isfinite(p).all()
        assert p.real.min() > 20
        assert p.real.max() < 836
        assert p.imag.min() > 5
        assert p.imag.max() < 589
        if not isinstance(mark, Arc):
            assert not ((p.real > 651) & (p.imag < 60)).any(), "in the title block"


@pytest.mark.parametrize("project", few(FILES, FEEDER), indirect=True, ids=NAME)
def test_other_positions_can_be_the_analysed_one(project):
    for label in project.cycle.labels[1::12]:
        cycle = project.variant.cycle.model_copy(update={"force_position": label})
        other = Project(project.variant.model_copy(update={"cycle": cycle}))
        other.study = project.study
        assert not composed(other, 1).crowded


@pytest.mark.trial
def test_command_line(tmp_path):
    assert run(["build", str(FILES[0]), "-o", str(tmp_path)]) == 0
    sheets = sorted(p.name for p in tmp_path.iterdir() if not p.name.startswith("."))
    fonts = ["OFL.txt", "TMMSheetsB.ttf"]
    assert sheets == sorted([*fonts, "sheet1.dxf", "sheet1.pdf", "sheet2.dxf", "sheet2.pdf"])


MASSLESS = (SLIDER, EVEN, {"project.sheets": ["kinematics_forces"]})


def test_a_mechanism_without_forces_gets_its_kinematics():
    """The same arrangement without what needs forces: no view of force plans, no heading over nothing."""
    sheet = composed(Project(read(*MASSLESS)), 1)
    views = {part.draw for part in sheet.parts}
    assert "kinematics.acceleration_plan" in views
    assert not [name for name in views if name.startswith("kinetics")]
    assert not sheet.crowded
    assert not sheet.leaving


def test_one_group_alone():
    assert not composed(Project(read(*MASSLESS, MASS, MOMENT)), 1).crowded


@pytest.mark.parametrize(("sheets", "codes"), [seldom(["kinematics_forces", "friction", "engine_2"], ["Д1", "Д2", "Д3"]),
                                               (["kinematics_forces", "engine_2", "friction"], ["Д1", "Д2", "Д5"])])
def test_no_two_sheets_of_a_project_have_one_designation(sheets, codes):
    given = variant.read(Path(__file__).parents[1] / "projects" / "pump.toml")
    block = given.title_block.model_copy(update={"designation": "ТММ.01"})
    asked = given.project.model_copy(update={"sheets": sheets})
    project = Project(given.model_copy(update={"project": asked, "title_block": block}))
    assert [composing.entries(project, n)["designation"] for n in (1, 2, 3)] == [f"ТММ.01 {code}" for code in codes]
