"""Letters of arms on one line, names of points with a prime, the sign of the moment in the table with friction."""

import pytest

from tmm_sheets.catalogue import read
from tmm_sheets.project import Project
from tmm_sheets.sheets import kinetics, linkage
from tmm_sheets.sheets.sheet import composed


@pytest.mark.parametrize(("arm", "others", "part"), [
    (40 + 0j, [], 0.0),                      # alone
    (40 + 0j, [40 + 0j], 0.0),               # itself
    (40 + 0j, [10 + 0j], 0.25),              # over a shorter one
    (40 + 0j, [10 + 0j, 30 + 0j], 0.75),     # over two
    (40 + 0j, [-30 + 0j], 0.0),              # to the other side
    (40 + 0j, [10 + 5j], 0.0),               # on another line
    (40 + 0j, [38 + 0j, 10 + 0j], 0.25),     # nothing is left of it for a letter beyond the one almost as long
    (30j, [10j, 80j], 1 / 3),                # the longer one does not count
])  # fmt: skip
def test_the_part_of_an_arm_that_shorter_ones_take(arm, others, part):
    assert kinetics._covered(arm, others) == pytest.approx(part)


@pytest.mark.parametrize(("name", "text"), [("A", "A"), ("A3", "A_{3}"), ("k′", "k′"), ("A3′", "A_{3}′"), ("S₂", "S_{2}")])
def test_a_prime_is_no_index(name, text):
    assert linkage.indexed(name) == text


def test_the_moment_with_friction_has_its_sign(monkeypatch):
    project = Project(read("tests/projects/pump.toml"))
    shown = {}
    original = kinetics.Canvas.table

    def keeping(canvas, corner, widths, rows, *rest, **options):
        shown.update({head: [row[n] for row in rows[1:]] for n, head in enumerate(rows[0])})
        return original(canvas, corner, widths, rows, *rest, **options)

    monkeypatch.setattr(kinetics.Canvas, "table", keeping)
    composed(project, 2)
    (column,) = (cells for head, cells in shown.items() if head.startswith(("M_{д}", "Mд", "M_д")) and head.endswith("Н·м"))
    moments = project.study.balance["M"].value
    assert min(moments) < 0 < max(moments)
    assert [cell.startswith("−") for cell in column] == [bool(m < 0) for m in moments]
