"""The equations on the sheet of a gear pair: what stands left and right of each equals sign is equal, inside and outside."""

import re
from pathlib import Path

import pytest

from tests.note.printed_formulas import equalities
from tests.sheets.equations import read
from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.sheets.gears.gear import OF_PAIR, OF_WHEEL, equations
from tmm_sheets.task import variant

RING = Path(__file__).parents[2] / "projects" / "ring.toml"


@pytest.mark.parametrize("name", ["press", "lugansk/shaper", "transport/press@07-ЭПС-718", "ring"])
def test_both_sides_are_equal(name):
    geometry = Project(variant.read(RING) if name == "ring" else catalogue.read(name)).gear.geometry
    wheels = [f"{of}{i}" for of in OF_WHEEL for i in (1, 2)]
    lines = [*equations(geometry, OF_PAIR, True), *equations(geometry, wheels, False)]
    compared = [e for line in lines for part in read(line) for e in equalities(part)[0]]
    assert len(compared) >= 20
    assert [e for e in compared if not e.holds] == []
    assert not any(re.search(r"[а-я]{4}", line) for line in lines)


def test_angle_follows_from_the_distance_where_that_is_given():
    geometry = Project(variant.read(RING)).gear.geometry
    said = next(line for line in equations(geometry, OF_PAIR, True) if "arccos" in line)
    assert said == "α_w = arccos(a·cos α/a_{w}) = arccos(64,00·cos 20°/65,00) = 22°18′"
