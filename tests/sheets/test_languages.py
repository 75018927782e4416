"""Sheets of linkages and flywheels in English and Ukrainian: the language's own words, readable sizes, every view in its place."""

import re
from functools import cache

import pytest

from tests import project_files
from tests.few import few
from tmm_sheets import words
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.lettering import SIZES, index_size
from tmm_sheets.drawing.marks import Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

KINDS = {
    "kinematics_forces": ("lugansk/shaper", 1), "flywheel": ("lugansk/shaper", 2),
    "engine_1": ("lugansk/engine", 1), "engine_2": ("lugansk/engine", 2), "press_1": ("press", 1), "press_2": ("press", 2),
    "sixbar_1": ("sixbar/1:1", 1), "sixbar_2": ("sixbar/1:1", 2), "transport_1": ("transport/diesel@01-Т-27", 1),
    "transport_1_press": ("transport/press@05-ЭПС-123", 1), "transport_1_crusher": ("transport/crusher@12-СДМ-1908", 1),
    "kinematics_forces_wide": ("tests/projects/conveyor.toml", 1),
    "forces": ("tests/sheets/chain.toml", 2), "kinematics": ("tests/projects/planer.toml", 1),
}  # fmt: skip
"""A project and a sheet of it for each kind of sheet; the last is drawn in another arrangement than its file says."""
STANDARD = {*SIZES, *(index_size(size) for size in SIZES), *(index_size(index_size(size)) for size in SIZES)}
DRAWN = [(kind, language) for kind in KINDS for language in ("en", "uk")]
SOME = ("flywheel", "en"), ("flywheel", "uk"), ("kinematics_forces", "en")
"""Of ``make test``: graphs in both, plans in the language that shows every letter that was left, as an English note has them."""
drawings = pytest.mark.parametrize(("kind", "language"), few(DRAWN, *SOME))


def kinds(language):
    return pytest.mark.parametrize("kind", few(KINDS, *(kind for kind, other in SOME if other == language)))




@cache
def project(name, language):
    return Project(read(name))


@cache
def drawn(kind, language):
    name, n = KINDS[kind]
    with words.on_paper(language):
        one = project(name, language)
        if kind == "kinematics":
            one = project_files.project(project_files.from_file(name), {"project.sheets": ["kinematics"]})
        assert one.sheets[n - 1] == kind
        return one, composed(one, n)


def lettering(kind, language):
    """Lettering outside of the title block, which has names of people and of the institution."""
    return [m for m in drawn(kind, language)[1].drawing.marks if isinstance(m, Text) and m.of != "title block"]


def names(one):
    """Names that somebody gave in the project file, which are no words."""
    v = one.variant
    motor = v.flywheel.motor.name if v.flywheel is not None and v.flywheel.motor is not None else ""
    own = "" if v.balancing is None or v.balancing.name == "Mур" else v.balancing.name
    return {*one.mechanism.links, *one.study.positions.points, *(load.name for load in (*v.force, *v.moment)), motor, own}


@kinds("en")
def test_an_english_sheet_has_no_cyrillic_but_names(kind):
    given = names(drawn(kind, "en")[0])
    said = {run for m in lettering(kind, "en") for run in re.findall("[\u0400-\u04ff№]+", m.text)}
    assert [run for run in said if not any(run in name for name in given)] == []


@kinds("uk")
def test_a_ukrainian_sheet_has_no_russian_letters(kind):
    assert [m.text for m in lettering(kind, "uk") if re.search("[ыэёъЫЭЁЪ]", m.text)] == []


@drawings
def test_letters_have_sizes_of_the_standard(kind, language):
    heights = {round(m.height, 6) for m in lettering(kind, language)}
    assert sorted(h for h in heights if not any(abs(h - size) < 1e-6 for size in STANDARD)) == []


@drawings
def test_every_view_keeps_its_place_and_every_label_finds_one(kind, language):
    sheet = drawn(kind, language)[1]
    assert [*map(str, sheet.leaving), *map(str, sheet.crowded)] == []


@pytest.mark.parametrize(("language", "sign", "other"), [("en", "[.]", ","), ("uk", ",", "[.]")])
def test_numbers_have_the_sign_of_the_language(language, sign, other):
    said = [m.text for m in lettering("flywheel", language)]
    assert any(re.search(rf"\d{sign}\d", text) for text in said)
    assert [text for text in said if re.search(rf"\d{other}\d", text)] == []
