"""Odd values in project files: named ones that once made a defect, and a seeded sample of :mod:`tests.attack`."""

import random
import re

import pytest

from tests.attack import SMALL, SOURCES, case, fallen
from tests.test_missing_parts import FLYWHEEL, FORCE, GEAR, HEAD, MASS, SLIDER, WORKING
from tmm_sheets import protocols, results
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task import variant

CONVEYOR = SOURCES["conveyor"]
SHAPER = SOURCES["shaper"]
RUN = '[cycle]\nstart = "0 deg"\npositions = 12\n'


@pytest.mark.parametrize("n", range(40))
def test_nothing_falls_over(n):
    what, text = case(SMALL, random.Random(n))
    assert list(fallen(text)) == [], f"{what}\n{text}"


@pytest.mark.parametrize(
    ("text", "field", "said"),
    [
        (CONVEYOR.replace('output = "E"', 'output = "C"'), "cycle.output", "C is a fixed point"),
        (SLIDER + RUN + 'diagrams = ["O"]\n', "cycle.diagrams[1]", "O is a fixed point"),
        (SLIDER.replace('"A"', '"A_"'), "crank.pin", '"A_" is no name of a point: expected a letter, then letters and digits'),
        (SLIDER.replace('"A"', '"A B"'), "crank.pin", "is no name of a point"),
        (SLIDER.replace('"A"', '"B′"'), "crank.pin", "is no name of a point"),
        (SLIDER.replace('"A"', '"2"'), "crank.pin", "is no name of a point"),
        (SLIDER.replace('O = [', '"O^2" = [').replace('"O"', '"O^2"'), "points.O^2", "is no name of a point"),
        (SLIDER.replace('["2", "3"]', '["2", "3,0"]'), "group[1].links[2]", "is no name of a link"),
        (SLIDER.replace('link = "1"', 'link = "0"'), "crank.link", "is the frame"),
        (SLIDER.replace('"x"', '"x_{1}"'), "guide[1].name", "is no name of a guide"),
        (SLIDER + RUN + FORCE.replace("F3", "F_3"), "force[1].name", "is no name of a force"),
        (SLIDER + RUN + FORCE.replace("F3", "F30"), "force[1].name", "the force on link 3 from link 0"),
        (SLIDER + RUN + MASS + FORCE.replace("F3", "G3"), "force[1].name", "the weight of link 3"),
        (SLIDER + RUN + FORCE + '[balancing]\nkind = "moment"\nname = "F3"\n', "balancing.name", "there already"),
        (SLIDER + RUN + 'extra = { "a_b" = "10 deg" }\n', "cycle.extra.a_b", "is no name of a position"),
        (SLIDER + RUN.replace("positions", "working"), "cycle", "a crank angle as start needs positions"),
        (SLIDER.replace('"0.1 m"', '"1e13 m"'), "crank.length", "is the unit right?"),
        (SLIDER.replace('"60 rpm"', '"1e-13 rpm"'), "crank.speed", "is the unit right?"),
        (SLIDER + RUN.replace("12", "1000000"), "cycle.positions", "a whole number of 100000 or less"),
        (GEAR.replace("28", "10000000"), "gear.teeth[2]", "a whole number of 100000 or less"),
        (HEAD.replace("Механизм", "Механизм 🙂") + GEAR, "project.title", 'the drawing font has no "🙂" (U+1F642'),
    ],
)  # fmt: skip
def test_it_is_said_what_is_wrong_and_where(text, field, said):
    text = text if "schema" in text else HEAD + text
    with pytest.raises(BadInput) as e:
        variant.parse(text, "my.toml")
    (problem,) = [p for p in e.value.problems if p.field == field]
    assert said in str(problem)
    assert problem.line


def longer(text, factor):
    """The file with every length in metres times a factor."""
    return re.sub(r'"(-?[\d.]+) m"', lambda m: f'"{float(m[1]) * factor!r} m"', text)


@pytest.mark.parametrize("factor", [1e6, 1e-6])
def test_a_mechanism_of_any_size(factor):
    """Similar mechanisms: same angles, all velocities times the factor; its sheet is drawn."""
    plain, other = (Project(variant.parse(longer(HEAD + SLIDER, f), "my.toml")) for f in (1.0, factor))
    found, real = (results.assemble(p, None) for p in (other, plain))
    for a, b in zip(found["velocities"]["points"]["B"], real["velocities"]["points"]["B"], strict=True):
        assert a == pytest.approx([factor * x for x in b], rel=1e-12, abs=1e-12 * factor)
    assert found["velocities"]["omega"]["2"] == pytest.approx(real["velocities"]["omega"]["2"], rel=1e-12, abs=1e-12)
    assert composed(other, 1).scales["positions"].mu == pytest.approx(factor * composed(plain, 1).scales["positions"].mu)


def test_a_flywheel_too_large_for_any_scale():
    project = Project(variant.parse(longer(SHAPER, 1e6), "my.toml"))
    composed(project, 1)
    with pytest.raises(CannotBuild, match=r"do not fit in 160 mm of the sheet at any scale of GOST 2\.302[^\n]*\n.*units you mean"):
        composed(project, 2)


def test_more_positions_than_a_sheet_can_show():
    """Numbers and protocol have them all, the sheet says why it cannot."""
    project = Project(variant.parse(HEAD + SLIDER + RUN.replace("12", "1000"), "my.toml"))
    assert len(results.assemble(project, None)["velocities"]["points"]["B"]) == 1000
    lines: list[str] = []
    with pytest.raises(CannotBuild, match=r"my\.toml:\d+: cycle\.positions: 1000 positions .* 72 at most"):
        lines.extend(protocols.lines(project, None))
    assert any("(velocities), положение 2" in line for line in lines)
    done = composed(Project(variant.parse(HEAD + SLIDER + RUN.replace("12", "72"), "my.toml")), 1)
    assert {f"Положение {n}" for n in range(72)} <= {group.text for group in done.groups}


@pytest.mark.parametrize("method", ["wittenbauer", "mertsalov"])
def test_more_positions_than_a_flywheel_sheet_can_show(method):
    cycle = WORKING.replace("working = 6", "working = 600")
    text = HEAD + SLIDER + cycle + FORCE + MASS + FLYWHEEL.format(method)
    with pytest.raises(CannotBuild, match="606 positions of one turn"):
        composed(Project(variant.parse(text, "my.toml")), 2)


def test_a_rocker_about_the_crank_pivot():
    """Rod and rocker turn with the crank as one triangle: the slider on the coupler point is a crank-slider."""
    text = CONVEYOR.replace('C = ["0.42 m", "0.12 m"]', 'C = ["0 m", "0 m"]').replace('["0.4 m", "0.25 m"]', '["0.2 m", "0.25 m"]')
    text = text.replace('"0.3 m"\nangle', '"0.1 m"\nangle').replace('"0.55 m"', '"0.9 m"')
    project = Project(variant.parse(text, "my.toml"))
    project.check()
    arm = abs(project.study.positions.points["D"].value)
    assert arm == pytest.approx([arm[0]] * len(arm))
    assert project.study.velocities.omega["3"].value == pytest.approx([project.mechanism.crank.omega] * len(arm))
    assert project.cycle.strokes.length > 0
