"""Whether a plan is drawn where its points come to lie: its vectors have ink from end to end, and none beyond."""

from types import SimpleNamespace

import numpy as np
import pytest

from tests.compare.test_view_search import ALONG, OPPOSITE, STAR, TWO, view
from tmm_sheets.compare.cad import cad_built
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.diagnosis.built_plan import StudentDrawing, _share
from tmm_sheets.compare.placing import Placing

pytestmark = pytest.mark.judging


def share(vectors, ink, move):
    """Share of a plan of these vectors that is drawn in some lines, both of our sheet; the drawing is placed by ``move``."""
    theirs = lines(move(np.array(ends)) for ends in ink)
    drawing = StudentDrawing(lambda line: cad_built._inked(theirs, move, line), lambda z: z, [], move.scale,
                      lambda line: cad_built._goes_on(theirs, move, line))
    return _share(SimpleNamespace(vectors=view(0, vectors)[1]), drawing, ())


@pytest.mark.parametrize("move", [Placing(), Placing(2 + 0j, 30 + 7j), Placing(0.4 + 0j)])
@pytest.mark.parametrize("vectors", [STAR, OPPOSITE, ALONG, TWO, ALONG[:1] * 2], ids=["star", "opposite", "along", "two", "same"])
def test_a_longer_line_is_not_the_vector(vectors, move):
    larger = [(1.2 * a, 1.2 * b) for a, b in vectors]
    smaller = [(0.8 * a, 0.8 * b) for a, b in vectors]
    assert share(vectors, vectors, move) == 1
    within = 0.5 if vectors == ALONG else 0  # what ends within a longer vector is drawn
    assert share(vectors, larger, move) <= within
    assert share(vectors, smaller, move) <= within


def test_what_crosses_an_end_is_nothing_beyond_it():
    a, b = TWO[0]
    across = (b - 30j, b + 30j)
    assert share(TWO, [*TWO, across], Placing()) == 1
    assert share(TWO, [*TWO, (a, 1.5 * b)], Placing()) == pytest.approx(0.5)


def test_a_plan_without_length_is_nowhere():
    assert share([(0j, 0.5 + 0j)], [(0j, 9 + 0j)], Placing()) == 0
