"""Letters and expressions as formula trees, and what both writers make of them."""

import xml.etree.ElementTree as ET

import pytest

from tmm_sheets.construction import expression as e
from tmm_sheets.construction.formula import (
    Fenced,
    Figures,
    FormulaRow,
    Fraction,
    Letters,
    Operand,
    Scripts,
    Sign,
    Underlined,
    Words,
    letters,
    letters_of,
    of_tree,
    spelt,
)
from tmm_sheets.note.alphabets import TYPST, equation, string


@pytest.mark.parametrize(("name", "markup"), [
    ("F21τ", "F_{21}^{τ}"), ("Fи3", "F_{и3}"), ("ω3", "ω_{3}"), ("h50", "h_{50}"), ("pb", "pb"), ("FМи3", "F_{Ми3}"),
    ("J_м", "J_м"), ("S5", "S_{5}"), ("B", "B"), ("b3", "b_{3}"),
])  # fmt: skip
def test_names_of_steps_as_letters(name, markup):
    assert letters_of(name) == markup


def test_indices_of_several_letters_hang_together():
    assert letters("ψ_max") == Scripts(Letters("ψ"), Words("max"))
    assert letters("J_доб") == Scripts(Letters("J"), Words("доб"))
    assert letters("M_{с}^{пр}") == Scripts(Letters("M"), Words("с"), Words("пр"))
    assert letters("N_1N_2") == FormulaRow((Scripts(Letters("N"), Figures("1")), Scripts(Letters("N"), Figures("2"))))
    assert letters("S''").above == Sign("″")


A, B, C = (e.Argument(i) for i in range(3))


def shown(tree, *texts):
    return spelt(of_tree(tree, [Operand(letters(t), None, t.startswith("−")) for t in texts]), TYPST)


def test_a_negative_factor_stands_in_brackets():
    assert shown(A * B, "a", "−2") == 'a dot.op lr(\\( − "2" \\))'
    assert shown(A - B, "a", "−2") == 'a − lr(\\( − "2" \\))'


def test_sums_with_zero_and_squares_are_written_as_people_do():
    assert shown(e.Operation("+", (e.Constant(0.0), A)), "a") == "a"
    assert shown(A * A, "a") == 'attach(a, t: "2")'
    assert shown(2 * A, "a") == '"2" a'
    assert shown((A / B) ** e.Constant(0.2), "a", "b") == 'attach(lr(\\( frac(a, b) \\)), t: "1" slash "5")'
    assert shown((A + B) * C, "a", "b", "c") == "lr(\\( a + b \\)) dot.op c"


def test_signs_stand_in_front_and_ones_are_left_out():
    one, minus = e.Constant(1.0), e.Constant(-1.0)
    assert shown(one * A, "a") == "a"
    assert shown(minus * A * B / C, "a", "b", "c") == "− frac(a dot.op b, c)"
    assert shown(A + minus * B, "a", "b") == "a − b"


def test_an_angle_is_in_degrees_inside_a_function_only():
    import numpy as np

    tree = np.tan(A) - A
    node = of_tree(tree, [Operand(Figures("0,3491"), Figures("20°"))])
    assert spelt(node, TYPST) == '"tg " "20°" − "0,3491"'


def test_every_node_is_well_formed_omml():
    node = FormulaRow((Fraction(letters("a_1"), letters("b^2")), Sign("="), Fenced("(", Underlined(letters("V̅_B"), 2), ")"),
                Words("кг & м"), of_tree(e.Operation("sqrt", (A,)), [Operand(letters("x"))]), letters("F_{21}^{τ}")))  # fmt: skip
    tree = ET.fromstring(equation(node))
    tags = {x.tag.rpartition("}")[2] for x in tree.iter()}
    assert {"f", "num", "den", "sSub", "sSup", "sSubSup", "d", "bar", "rad"} <= tags
    assert "кг & м" in "".join(tree.itertext())


def test_strings_of_typst_are_escaped():
    assert string('a"b\\c') == '"a\\"b\\\\c"'
