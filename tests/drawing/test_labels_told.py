"""What ``tests.labels`` tells of runs of letters, on drawings made for it: it is the measure, so it is measured."""

import pytest

from tests.labels import BEYOND, OVER, crossings, strayed
from tmm_sheets.drawing.ink_index import FIELD
from tmm_sheets.drawing.marks import Drawing, Line, Provenance, Text

WORD = Text(100 + 50j, "H", 5.0)


def told(*marks):
    return [(text, what) for text, _, what in strayed(Drawing(841, 594, "", marks))]


@pytest.mark.parametrize(("mark", "what"), [
    (Text(102 + 50j, "H", 5.0), [("H H", OVER)]),
    (Text(110 + 50j, "H", 5.0), []),
    (Text(100 + 57j, "H", 5.0), []),
    (Text(complex(FIELD.x1 - 1, 50), "H", 5.0), [("H", BEYOND)]),
    (Text(complex(FIELD.x1 - 8, 50), "H", 5.0), []),
    (Text(complex(50, FIELD.y0 - 1), "H", 5.0), [("H", BEYOND)]),
    (Text(103 + 50j, " ", 5.0), []),
])  # fmt: skip
def test_letters_over_letters_and_beyond_the_frame(mark, what):
    assert told(WORD, mark) == what
    assert told(mark) == [each for each in what if each[1] == BEYOND]


def test_a_rule_of_a_table_through_a_letter_is_told_and_a_fraction_bar_is_not():
    rule, bar = (Line(90 + 52j, 110 + 52j, "thin", "", Provenance(role)) for role in ("table", "text"))
    assert [(text, role) for text, _, _, role in crossings(Drawing(841, 594, "", (WORD, rule)))] == [("H", "table")]
    assert not crossings(Drawing(841, 594, "", (WORD, bar)))
