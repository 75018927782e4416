"""Numbers printed on the sheets are values of steps, and formulas give what stands behind their sign of equality."""

import pytest

from tests.few import few
from tests.sheets.printed import OWN, PROJECTS, check
from tmm_sheets.catalogue import read
from tmm_sheets.project import Project

SHIPPED = [name for name in PROJECTS if name not in OWN]
VISOR = next(name for name in OWN if "visor" in name)


@pytest.mark.parametrize("name", few([*SHIPPED, VISOR], "lugansk/shaper", VISOR))
def test_every_printed_number_is_that_of_a_step_and_every_formula_comes_out(name):
    total, lost, false, wrong = check(Project(read(name)))
    assert total > 200
    assert false < 0.8  # most of the false ones are small numbers with few digits
    assert lost == []
    assert wrong == []
