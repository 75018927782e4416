"""Which texts of a drawing make the labels of a sheet: letters and indices of two that stand close are not mixed up."""

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import Writing
from tmm_sheets.compare.cad.cad_lettering import read
from tmm_sheets.compare.elements import Element, ElementView

VIEW = ElementView(1, "", Box(0, 0, 100, 100))


def label(number, text, x0, y0, x1, y1):
    return Element(number, VIEW, text, "text", np.array([x0 + 1j * y0, x1 + 1j * y0, x1 + 1j * y1, x0 + 1j * y1]), "text",
                   text=text, height=3.5)


ABOVE, BELOW = label(1, "k′", 0.0, 3.1, 3.45, 7.65), label(2, "w4, n6", 0.1, 0.0, 12.2, 4.55)
TEXTS = [Writing("w", 1.2 + 2.8j, 3.5, 2.2, 0.0, 0), Writing("4", 3.8 + 1.25j, 2.5, 1.4, 0.0, 1),
         Writing(", n", 7.5 + 1.05j, 3.5, 4.0, 0.0, 2), Writing("6", 10.9 + 1.25j, 2.5, 1.4, 0.0, 3),
         Writing("k", 1.1 + 5.9j, 3.5, 2.0, 0.0, 4), Writing("′", 3.0 + 4.35j, 2.5, 0.9, 0.0, 5)]


def test_labels_whose_boxes_overlap_keep_their_parts():
    for wanted in ([ABOVE, BELOW], [BELOW, ABOVE]):
        found = {wanted[n].text: f for n, f in read(wanted, TEXTS).items()}
        assert all(f.says is None for f in found.values())
        assert sorted(found["k′"].writings) == [4, 5]
        assert sorted(found["w4, n6"].writings) == [0, 1, 2, 3]


def test_a_wrong_index_beside_another_label_is_still_told():
    wrong = [TEXTS[0], TEXTS[1]._replace(text="5"), *TEXTS[2:]]
    found = {[ABOVE, BELOW][n].text: f for n, f in read([ABOVE, BELOW], wrong).items()}
    assert found["k′"].says is None
    assert found["w4, n6"].says == "w5, n6"


def test_a_foreign_title_or_label_in_the_box_is_not_ours():
    """Nor is the label of another, unless the two were exchanged; what is none of ours is ours, misread."""
    b, d = label(1, "b", 0, 0, 3, 4), label(2, "d", 50, 0, 53, 4)
    def says(*texts):
        writings = [Writing(text, at, 3.5, 2.0, 0.0, k) for k, (text, at) in enumerate(texts)]
        return {[b, d][n].text: f.says for n, f in read([b, d], writings).items()}

    assert says(("План сил", 2 + 2j)) == {}
    assert says(("d", 2 + 2j)) == {}
    assert says(("c", 2 + 2j)) == {"b": "c"}
    assert says(("d", 2 + 2j), ("b", 52 + 2j)) == {"b": "d", "d": "b"}
    assert says(("d", 2 + 2j), ("d", 52 + 2j)) == {"b": "d", "d": None}


def test_the_title_of_another_view_is_no_part_of_a_title():
    """Two plans stand close together: the one's title reaches into the box of the other's, which is in other words."""
    first, second = label(1, "Position 1", 0, 0, 30, 5), label(2, "Position 4", 10, 1, 40, 6)
    texts = [Writing("POSITION 4", 25 + 3.5j, 3.5, 28.0, 0.0, 0), Writing("Position 1", 15 + 2.5j, 3.5, 28.0, 0.0, 1)]
    found = read([first, second], texts)
    assert (found[0].says, found[1].says) == (None, "POSITION 4")
    there = read([second, first], [*texts, texts[1]._replace(at=18 + 3j)])
    assert there[0].says == "POSITION 4"
