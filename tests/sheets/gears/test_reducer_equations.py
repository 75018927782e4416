"""The equations on the sheet of a reducer: what stands left and right of each equals sign is equal, for every scheme."""

import re
from math import gcd, radians, sin
from pathlib import Path

import pytest

from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.sheets.gears.train import equation_lines
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task import variant

WINDER = Path(__file__).parents[2] / "projects" / "winder.toml"
UNIT = " об/мин"


def counted(text):
    """Value of an expression in numbers, or None of one with letters."""
    for old, new in (("−", "-"), (",", "."), ("·", "*"), ("°", "")):
        text = text.replace(old, new)
    text = re.sub(r"НОД\((\d+); (\d+)\)", lambda m: str(gcd(int(m[1]), int(m[2]))), text)
    text = re.sub(r"sin\((\d+)/(\d+)\)", lambda m: repr(sin(radians(int(m[1]) / int(m[2])))), text).replace("^{2}", "**2")
    return None if re.search(r"[^\d.+\-*/() e]", text) else eval(text)


def driven(tmp_path, driver):
    path, text = tmp_path / "winder.toml", WINDER.read_text(encoding="utf-8")
    text = text.replace('simple = "none"', f'simple = "none"\ndriver = "{driver}"')
    path.write_text(text.replace('"250 rpm"', '"1100 rpm"') if driver == "ring" else text, encoding="utf-8")
    return Project(variant.read(path))


def check(project):
    """How many equations in numbers alone the sheet has; each is right to the places that are written."""
    equal = 0
    for line in equation_lines(project.reducer):
        for statement in re.split(" > |: |; (?!\\d+\\))", line.removesuffix(UNIT)):
            known = [value for value in map(counted, statement.split(" = ")) if value is not None]
            equal += max(len(known) - 1, 0)
            assert known == pytest.approx(known[:1] * len(known), rel=2e-3), line
    return equal


@pytest.mark.parametrize("name", ["transport/diesel@01-Т-27", "transport/press@05-ЭПС-123", "transport/compressor@09-В-5",
                                  "transport/crusher@12-СДМ-1908"])
def test_schemes_of_the_manual(name):
    assert check(Project(catalogue.read(name))) >= 7


@pytest.mark.parametrize("driver", ["sun", "ring"])
def test_a_row_alone(tmp_path, driver):
    project = driven(tmp_path, driver)
    assert check(project) >= 7
    lines = list(equation_lines(project.reducer))
    entry = {"sun": "1", "ring": "3"}[driver]
    assert lines[1].startswith(f"u_{{{entry}H}} = ")
    assert f"n_{{{entry}}}/u" in lines[-3]


def test_a_sheet_with_room_has_them():
    drawing = composed(Project(catalogue.read(str(WINDER))), 1).drawing
    assert {"Расчёт редуктора", "Частоты вращения по плану"} <= {view.name for view in drawing.views}
