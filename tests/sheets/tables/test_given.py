"""The table of given data has the numbers of the manual's tables, as they are printed there."""

import csv
from pathlib import Path

import pytest

from tmm_sheets import summary
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import given_position
from tmm_sheets.task import variant

ROOT = Path(__file__).parents[3]


def title(project):
    """What stands over the table."""
    canvas = Canvas()
    ((width, height), *_) = given_position.links.sizes(project, canvas, {})
    given_position.links(project, canvas, Box(0.0, 0.0, width, height), {})
    return canvas.parts[-1].title


def test_the_diesel_has_weights_angle_and_unevenness_as_table_2_1_prints_them():
    """Cipher 1271271: digits а = 1, б = 2, д = 2 choose the columns."""
    with (ROOT / "variants/transport/diesel.csv").open(encoding="utf-8") as file:
        rows = {row[1]: row[5:] for row in csv.reader((x for x in file if not x.startswith("#")), delimiter=";")}
    project = Project(read("transport/diesel@01-Т-27"))
    assert title(project) == "Исходные данные"
    shown = dict(given_position.given_quantities(project))
    for letters, key, column in (("n_{1}, об/мин", "n1", 1), ("l_{BD}, м", "l_BD", 2), ("θ, °", "theta", 2), ("G_{2}, Н", "G2", 2),
                                 ("δ", "delta", 2), ("J_{S4}, кг·м²", "J_S4", 2)):
        assert shown[letters] == rows[key][column].replace(".", ","), letters
    assert not [letters for letters in shown if letters.startswith("m_")]


def project(name, **changes):
    text = read(name).text
    for old, new in changes.values():
        assert text.count(old) >= 1
        text = text.replace(old, new, 1)
    return Project(variant.parse(text, "own.toml"))


@pytest.mark.parametrize(("name", "old", "new", "told"), [
    ("sixbar/1:1", 'length = "0.09 m"', 'length = "0.1 m"', "given.r"),
    ("transport/diesel@01-Т-27", 'l_BD = "0.3 m"', 'l_BD = "0.31 m"', "given.l_BD"),
    ("transport/diesel@01-Т-27", 'G2 = "90 N"', 'G2 = "91 N"', "given.G2"),
])
def test_a_number_that_was_changed_in_one_place_only_is_told(name, old, new, told):
    assert not [*summary.given(project(name))]
    (said,) = summary.given(project(name, change=(old, new)))
    assert said.startswith(f"{told}:")


@pytest.mark.parametrize("value", ['"3 apples"', '"1/0"', '"G"', "true", "[1]"])
def test_what_is_no_number_with_a_unit_is_refused(value):
    text = read("press").text.replace('G2 = "800 N"', f"G2 = {value}")
    with pytest.raises(BadInput, match=r"own\.toml:\d+: given\.G2: expected a number with its unit"):
        variant.parse(text, "own.toml")


def test_without_given_data_the_file_tells_and_masses_are_named_where_there_are_some():
    text = read("loom").text
    assert title(Project(variant.parse(text, "own.toml"))) == "Заданные размеры и массы"
    bare = "\n".join(line for line in text.splitlines() if not line.startswith("mass"))
    assert title(Project(variant.parse(bare, "own.toml"))) == "Заданные размеры"
