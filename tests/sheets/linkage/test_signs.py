"""One quantity, one sign: the crank of the press turns clockwise and is uneven, and two of its sheets tell how."""

import pytest

from tmm_sheets import catalogue
from tmm_sheets.drawing.marks import Text
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

RULE = "ω, ε: «+» — против часовой стрелки"


def texts(project, n):
    return [mark.text for mark in composed(project, n).drawing.marks if isinstance(mark, Text)]


@pytest.fixture(scope="module")
def press():
    return Project(catalogue.read("press"))


@pytest.mark.parametrize("n", [1, 2])
def test_the_rule_stands_once_on_each_sheet(press, n):
    assert texts(press, n).count(f"{RULE}, звена 1 — по его вращению") == 1


def test_the_crank_has_the_signs_of_its_running(press):
    """Sheet 1: position 7 with ε1 = 1.716, gaining speed; sheet 2 tells ω1 and ε1 of that position in a table of all links."""
    assert "1,716" in texts(press, 1)
    assert {"15,71", "1,716"} <= set(texts(press, 2))
    assert {"−15,71", "−1,716"}.isdisjoint(texts(press, 2))


def test_a_crank_that_turns_counter_clockwise_needs_no_words():
    boom = Project(catalogue.read("tests/projects/boom.toml"))
    assert [text for text in texts(boom, 1) if text.startswith("ω, ε")] == [RULE]
