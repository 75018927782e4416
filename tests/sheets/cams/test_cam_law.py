"""The formulas of the law on a cam's sheet are those that it is drawn by, on the rise and on the way back."""

import re
from itertools import combinations
from math import pi

import numpy as np
import pytest
import shapely

from tests import labels
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Text
from tmm_sheets.methods.cams.cam_laws import LAWS, PositionFunction
from tmm_sheets.sheets.cams.cam_law import formula_layouts, phases_of, written

FORMS = [name for name, law in LAWS.items() if written(law)]

TOKEN = re.compile(r"S_\{max\}|φ_\w+|φ|sin|cos|π|x|\d+|[-+*/()]|\^")


def value(text, **letters):
    """What a formula gives, as it is written: what stands side by side is multiplied."""
    known = {"S_{max}": "S", "φ_у": "rise", "φ_дс": "dwell", "φ_с": "fall", "φ": "phi", "π": "pi", "^": "**"}
    found = ""
    text = re.sub(r"sin\^2(\([^()]*\))", r"(sin\1)^2", re.sub(r"\^\{(\d)\}", r"^\1", text))
    for token in TOKEN.findall(text.replace("−", "-").replace("·", "*").replace("[", "(").replace("]", ")")):
        side_by_side = found and (found[-1].isalnum() or found[-1] == ")") and (token[0].isalnum() or token[0] == "(")
        found += ("*" if side_by_side and not found.endswith(("sin", "cos")) else "") + known.get(token, token)
    return eval(found, {"pi": pi, "sin": np.sin, "cos": np.cos, "S": 0.03, "rise": 1.2, "fall": 1.7, **letters})


@pytest.mark.parametrize("dwell", [0.0, 0.5])
@pytest.mark.parametrize("name", FORMS)
def test_formulas_are_those_of_the_law(name, dwell):
    law = PositionFunction.of(1.2, dwell, 1.7, 0.03, LAWS[name])
    for phase, lines in zip((law.rise, law.fall), phases_of(law), strict=True):
        for x in (0.2, 0.8):
            head = lines[0].partition("x = ")[2]
            assert value(head, dwell=dwell, phi=float(phase.phi(x))) == pytest.approx(x)
            assert ("φ_дс" in head) == (dwell > 0 and phase is law.fall)
            first = lines.index("x > 0,5:" if x > 0.5 else "x < 0,5:") + 1 if "x > 0,5:" in lines else 1
            for line, exact in zip(lines[first:first + 3], (phase.s, phase.ds, phase.dds), strict=True):
                assert value(line.partition(" = ")[2], x=x) == pytest.approx(float(exact(x)), abs=1e-12), line
        assert lines[-1].endswith(" м")


def test_all_but_diagrams_are_formulas():
    assert FORMS == ["sine", "cosine", "constant", "linearly decreasing"]


def test_a_law_that_is_a_diagram_tells_its_greatest_value_only():
    for lines in phases_of(PositionFunction.of(1.2, 0.5, 1.7, 0.3, LAWS["trapezoid"], symbol="ψ")):
        word, value = lines
        assert word in ("Удаление:", "Возвращение:")
        assert value.startswith("|ψ")
        assert value[-1].isdigit()  # no unit


@pytest.mark.parametrize("name", [*FORMS, "trapezoid"])
def test_every_form_says_all_of_it(name):
    """Wide or narrow, on one column or two: the same words in the same order, the narrowest the last."""
    law = PositionFunction.of(1.2, 0.5, 1.7, 0.03, LAWS[name])
    whole = " ".join(line for lines in phases_of(law) for line in lines)
    forms = list(formula_layouts(law))
    for form in forms:
        columns, height, *_ = form
        assert " ".join(line.strip() for lines in columns for line in lines).split() == whole.split()
        assert form.size[1] == pytest.approx(12.0 + form.pitch * max(map(len, columns)))
        assert form.pitch >= 1.6 * height
    assert min(form.size[0] for form in forms[-4:]) == min(form.size[0] for form in forms)


@pytest.mark.parametrize("name", [*FORMS, "trapezoid"])
def test_no_exponent_stands_in_the_index_of_the_line_above(name):
    """The strokes of the letters decide, not their boxes."""
    law = PositionFunction.of(1.39626, 0.5, 1.39626, 0.02, LAWS[name])
    for form in formula_layouts(law):
        for column in form.columns:
            canvas, at = Canvas(), 500.0
            canvas.lines(complex(0.0, at), column, form.pitch, form.height)
            texts = [mark for mark in canvas.marks if isinstance(mark, Text)]
            strokes = {k: shapely.MultiLineString([[(z.real, z.imag) for z in line] for line in labels.inked(text)])
                       for k, text in enumerate(texts) if labels.inked(text)}
            for (k, one), (n, other) in combinations(strokes.items(), 2):
                assert texts[k].at.imag == texts[n].at.imag or one.distance(other) > labels.PEN, (texts[k].text, texts[n].text)
