"""Questions at the sheets: each at its place, with an answer that the results bear out; what is laid over a sheet measures it."""

import re

import numpy as np
import pytest

from tmm_sheets import catalogue, results
from tmm_sheets.__main__ import run
from tmm_sheets.drawing.marks import Text
from tmm_sheets.drawing.paper import A1
from tmm_sheets.project import Project
from tmm_sheets.record.defence import ASKED, defended


@pytest.fixture(scope="module")
def shaper():
    project = Project(catalogue.read("lugansk/shaper"))
    found, problem = defended(project, (1,))  # composed anew, with its steps
    assert problem is None
    return project, found


def test_ten_questions_a_sheet_each_at_its_view(shaper):
    _, found = shaper
    for of in found.values():
        assert len(of.questions) == ASKED
        for question in of.questions:
            assert question.view
            assert A1.frame.contains(question.at)
            assert question.answer


def test_no_question_twice_on_a_view(shaper):
    for of in shaper[1].values():
        asked = [(q.view, q.at) for q in of.questions]
        assert len({*asked}) == len(asked) or len({(q.view, q.text) for q in of.questions}) == len(asked)


def test_the_longest_vector_of_the_acceleration_plan_is_that_of_the_results(shaper):
    """|a_B| = w^2 l_AB by the formula, without any plan."""
    _, found = shaper
    said = next(q.answer[0] for q in found[1].questions if q.text.startswith("Откуда μa"))
    speed = 2 * np.pi * 72 / 60
    mm, value = (float(x.replace(",", ".")) for x in re.findall(r"\d+,\d+", said)[:2])
    assert value == pytest.approx(speed**2 * 0.08, rel=1e-3)
    assert mm == pytest.approx(value / 0.02, abs=0.06)


def test_lengths_laid_over_are_those_of_the_results(shaper):
    project, found = shaper
    point = np.array(results.assemble(project, ["velocities"])["velocities"]["points"]["D"][2])
    laid = "".join(mark.text for mark in found[1].overlay.marks if isinstance(mark, Text))
    assert f"{np.hypot(*point) / 0.02:.1f} мм".replace(".", ",") in laid


def test_forces_on_a_scheme_have_no_length_to_measure(shaper):
    """They are drawn to no scale: 2800 N over 21.5 mm stand nowhere."""
    laid = "".join(mark.text for mark in shaper[1][1].overlay.marks if isinstance(mark, Text))
    assert "26,0 мм" not in laid


def test_command(tmp_path, capsys):
    assert run(["defence", "lugansk/cam_flat", "-o", str(tmp_path), "--lang", "en"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("Sheet 1. ")
    assert "10. " in said
    assert said.rstrip().endswith("overlay1.pdf")
    assert (tmp_path / "overlay1.pdf").read_bytes().startswith(b"%PDF")


def test_a_sheet_that_is_not_there(tmp_path, capsys):
    assert run(["defence", "lugansk/cam_flat", "--sheet", "9", "-o", str(tmp_path)]) == 2
    assert "9" in capsys.readouterr().err
    assert not [*tmp_path.iterdir()]
