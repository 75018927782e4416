"""The equations on the sheet of a gear pair: what stands left and right of each equals sign is equal, inside and outside."""

import re
from math import cos, pi, radians, sin, tan
from pathlib import Path

import pytest

from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.sheets.gears.gear_equations import OF_PAIR, OF_WHEEL, equations
from tmm_sheets.task import variant

RING = Path(__file__).parents[2] / "projects" / "ring.toml"
FUNCTIONS = {"tg": tan, "cos": cos, "sin": sin}


def counted(text):
    """Value of an expression in numbers, or None of one with letters and of an angle alone."""
    text = re.sub(r"(\d+)°(?:(\d+)′)?", lambda m: repr(radians(int(m[1]) + int(m[2] or 0) / 60)), text.replace(",", "."))
    text = re.sub(r"(tg|cos|sin) ([\d.]+)", lambda m: repr(FUNCTIONS[m[1]](float(m[2]))), text)
    text = text.removesuffix(" мм").replace("−", "-").replace("·", "*").replace("π", repr(pi))
    return None if re.search(r"[^\d.+\-*/() e]", text) else eval(text)


@pytest.mark.parametrize("name", ["press", "lugansk/shaper", "transport/press@07-ЭПС-718", "ring"])
def test_both_sides_are_equal(name):
    geometry = Project(variant.read(RING) if name == "ring" else catalogue.read(name)).gear.geometry
    wheels = [f"{of}{i}" for of in OF_WHEEL for i in (1, 2)]
    lines = [*equations(geometry, OF_PAIR, True), *equations(geometry, wheels, False)]
    compared = [line for line in lines if None not in map(counted, line.split(" = ")[-2:]) and "arccos" not in line]
    for line in compared:
        left, right = map(counted, line.split(" = ")[-2:])
        # An angle is written to the minute, and y is a small difference of its cosine.
        assert left == pytest.approx(right, rel=2e-3, abs=1.5e-3 if line.startswith("y") else 2e-4), line
    assert len(compared) >= 20
    assert not any(re.search(r"[а-я]{4}", line) for line in lines)


def test_an_angle_is_told_by_its_cosine_where_the_distance_is_given():
    geometry = Project(variant.read(RING)).gear.geometry
    said = next(line for line in equations(geometry, OF_PAIR, True) if "arccos" in line)
    assert said == "cos α_{w} = a·cos α/a_{w}; α_{w} = arccos(64,00·cos 20°/65,00) = 22°18′"
