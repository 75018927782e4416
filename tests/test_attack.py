"""Odd values in project files: named ones that once made a defect, and a seeded sample of :mod:`tests.attack`."""

import json
import random
import re
import tomllib

import pytest

from tests.attack import DOORS, FAULTS, SHARES, entered
from tests.few import few
from tests.odd_projects import SMALL, SOURCES, case, fallen
from tests.project_files import EVEN, FLYWHEEL, FORCE, GEAR, MASS, MOMENT, SLIDER, WORKING, from_file, project, read
from tests.sheets.unlettered import unlettered, words
from tmm_sheets import protocols, results
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.sheets.sheet import composed

CONVEYOR = tomllib.loads(SOURCES["conveyor"])
LOADED = (SLIDER, EVEN, FORCE)


@pytest.mark.parametrize("n", few(range(40), 0, 1, 5))
def test_nothing_falls_over(n):
    what, text = case(SMALL, random.Random(n))
    assert fallen(text) == [], f"{what}\n{text}"


@pytest.mark.parametrize("door", DOORS)
def test_no_door_falls_in(door, tmp_path, monkeypatch):
    """Some of the cases of ``python -m tests.attack``; those with a process of their own take long."""
    monkeypatch.chdir(tmp_path)
    assert {entered(door, n) for n in range(1 if door in FAULTS else 2 if door in SHARES else 20)} <= {"done", "refused"}


@pytest.mark.parametrize(
    ("parts", "field", "said"),
    [
        ((CONVEYOR, {"cycle.output": "C"}), "cycle.output", "C is a fixed point"),
        ((SLIDER, EVEN, {"cycle.diagrams": ["O"]}), "cycle.diagrams[1]", "O is a fixed point"),
        *(((SLIDER, {"crank.pin": pin, "group[1].outer": [pin]}), "crank.pin",
           f'"{pin}" is no name of a point: expected a letter, then letters and digits') for pin in ("A_", "A B", "B′", "2")),
        ((SLIDER, {"points": {"O^2": ["0 m", "0 m"]}}), "points.O^2", "is no name of a point"),
        ((SLIDER, {"group[1].links[2]": "3,0"}), "group[1].links[2]", "is no name of a link"),
        ((SLIDER, {"crank.link": "0"}), "crank.link", "is the frame"),
        ((SLIDER, {"guide[1].name": "x_{1}", "group[1].guide": "x_{1}"}), "guide[1].name", "is no name of a guide"),
        ((*LOADED, {"force[1].name": "F_3"}), "force[1].name", "is no name of a force"),
        ((*LOADED, {"force[1].name": "F30"}), "force[1].name", "the force on link 3 from link 0"),
        ((*LOADED, MASS, {"force[1].name": "G3"}), "force[1].name", "the weight of link 3"),
        ((*LOADED, MOMENT, {"balancing.name": "F3"}), "balancing.name", "there already"),
        ((SLIDER, EVEN, {"cycle.extra": {"a_b": "10 deg"}}), "cycle.extra.a_b", "is no name of a position"),
        ((SLIDER, EVEN, {"cycle.positions": None, "cycle.working": 12}), "cycle", "a crank angle as start needs positions"),
        ((SLIDER, {"crank.length": "1e13 m"}), "crank.length", "is the unit right?"),
        ((SLIDER, {"crank.speed": "1e-13 rpm"}), "crank.speed", "is the unit right?"),
        ((SLIDER, EVEN, {"cycle.positions": 1000000}), "cycle.positions", "720 parts or fewer"),
        ((GEAR, {"gear.teeth[2]": 10000000}), "gear.teeth[2]", "a whole number of 100000 or less"),
        (({"project.title": "Механизм 🙂"}, GEAR), "project.title", 'the drawing font has no "🙂" (U+1F642'),
    ],
)  # fmt: skip
def test_it_is_said_what_is_wrong_and_where(parts, field, said):
    with pytest.raises(BadInput) as e:
        read(*parts)
    (problem,) = [p for p in e.value.problems if p.field == field]
    assert said in str(problem)
    assert problem.line


def longer(data, factor):
    """A part with every length in metres times a factor."""
    return json.loads(re.sub(r'"(-?[\d.]+) m"', lambda m: f'"{float(m[1]) * factor!r} m"', json.dumps(data)))


@pytest.mark.parametrize("factor", few([1e6, 1e-6], 1e-6))
def test_a_mechanism_of_any_size(factor):
    """Similar mechanisms: same angles, all velocities times the factor; its sheet is drawn."""
    plain, other = (project(longer(SLIDER, f)) for f in (1.0, factor))
    found, real = (results.assemble(p, None) for p in (other, plain))
    for a, b in zip(found["velocities"]["points"]["B"], real["velocities"]["points"]["B"], strict=True):
        assert a == pytest.approx([factor * x for x in b], rel=1e-12, abs=1e-12 * factor)
    assert found["velocities"]["omega"]["2"] == pytest.approx(real["velocities"]["omega"]["2"], rel=1e-12, abs=1e-12)
    assert unlettered(other).scales["positions"].mu == pytest.approx(factor * unlettered(plain).scales["positions"].mu)


def test_a_flywheel_too_large_for_any_scale():
    p = project(longer(from_file("lugansk/shaper"), 1e6))
    unlettered(p)
    with pytest.raises(CannotBuild, match=r"do not fit in 157 mm of the sheet at any scale of GOST 2\.302[^\n]*\n.*units you mean"):
        composed(p, 2)


def test_more_positions_than_a_sheet_can_show():
    """Numbers and protocol have them all, the sheet says why it cannot."""
    p = project(SLIDER, EVEN, {"cycle.positions": 720})
    assert len(results.assemble(p, None)["velocities"]["points"]["B"]) == 720
    lines: list[str] = []
    with pytest.raises(CannotBuild, match=r"own\.toml:\d+: cycle\.positions: 720 positions .* 72 at most"):
        lines.extend(protocols.lines(p, None))
    assert any("(velocities), положение 2" in line for line in lines)
    assert {f"Положение {n}" for n in range(72)} <= {*words(unlettered(project(SLIDER, EVEN, {"cycle.positions": 72})))}


@pytest.mark.parametrize("method", ["wittenbauer", "mertsalov"])
def test_more_positions_than_a_flywheel_sheet_can_show(method):
    p = project(SLIDER, WORKING, FORCE, MASS, FLYWHEEL, {"cycle.working": 600, "flywheel.method": method})
    with pytest.raises(CannotBuild, match="606 positions of one turn"):
        composed(p, 2)


def test_a_rocker_about_the_crank_pivot():
    """Rod and rocker turn with the crank as one triangle: the slider on the coupler point is a crank-slider."""
    p = project(CONVEYOR, {"points.C": ["0 m", "0 m"], "group[1].lengths[1]": "0.2 m", "point[1].distance": "0.1 m",
                           "group[2].length": "0.9 m"})
    p.check()
    arm = abs(p.study.positions.points["D"].value)
    assert arm == pytest.approx([arm[0]] * len(arm))
    assert p.study.velocities.omega["3"].value == pytest.approx([p.mechanism.crank.omega] * len(arm))
    assert p.cycle.strokes.length > 0
