"""Digits of formulas: what is printed, worked out by another reader (``printed_formulas``), must give what is printed."""

import random
from math import cos, pi, radians, sin, tan

import numpy as np
import pytest

from tests.few import few
from tests.note.printed_formulas import equalities, line_of
from tmm_sheets.construction import expression as e
from tmm_sheets.construction.equation import read, shown
from tmm_sheets.note.alphabets import equation
from tmm_sheets.note.reader import NoteQuantity, Reader
from tmm_sheets.numbers import degrees_and_minutes, rounded_angle

A, B, C, D = (e.Argument(i) for i in range(4))


def printed(tree, values, units=(), unit="", result=None):
    """The line of numbers of a formula."""
    quantities = [NoteQuantity("abcd"[i], v, units[i] if units else "", step=f"plan/{i}") for i, v in enumerate(values)]
    gives = float(np.real(e.evaluate(tree, values))) if result is None else result
    said = Reader(None, "ru", None, {}).written("y", tree, quantities, NoteQuantity("", gives, unit, step="plan/y"))
    return line_of(equation(said.numbers))


def judged(line):
    found, unread = equalities(line)
    assert found, line
    assert not unread, line
    return found


SHAPES = {
    "product": A * B, "quotient": A / B, "sum": A + B - C, "moments": (A * B - C * D) / C, "square": A * B * B / C,
    "root": np.sqrt((A - B) * (A + B)), "diagonal": np.hypot(A, B), "power": (A / B) ** e.Constant(0.2), "share": A / B - 1,
    "greatest": np.maximum(A * B - C, 0.0),
    "constant": pi * A / 30, "own number": 9.81 * A - 2.5 * B,
}  # fmt: skip


@pytest.mark.parametrize("shape", few(SHAPES, *[*SHAPES][::3]))
def test_what_stands_there_gives_what_stands_there(shape):
    drawn = random.Random(shape)
    for _ in range(300):
        values = [drawn.choice([1, 1, -1]) * 10 ** drawn.uniform(-3, 5) for _ in range(4)]
        if shape in ("root", "power"):
            values = sorted(map(abs, values), reverse=True)
        line = printed(SHAPES[shape], values)
        assert all(x.holds for x in judged(line)), line


def test_angles_get_seconds_where_the_result_needs_them():
    drawn = random.Random(3)
    for _ in range(300):
        a, m = radians(drawn.uniform(1, 80)), drawn.uniform(1, 90)
        assert all(x.holds for x in judged(printed(np.tan(A) - A, [a], ["rad"])))
        assert all(x.holds for x in judged(printed(B * np.sin((A - C) / 2) / np.cos(A), [a, m, radians(20)], ["rad", "", "rad"])))


def test_a_result_in_degrees_is_that_of_its_radians():
    drawn = random.Random(4)
    for _ in range(300):
        found = judged(printed(np.arctan(A / B), [10 ** drawn.uniform(-2, 2), 1.0], unit="rad"))
        assert len(found) == 2
        assert all(x.holds for x in found)


def test_the_result_keeps_its_digits_and_operands_get_few():
    """Delta y of the shaper's gears: 0.1765 + 0 - 0.1713 is 0.0052, and not 0.005132."""
    values = [3 / 17, 0.0, 3 / 17 - 0.005132]
    assert printed(A + B - C, values) == "0,176471+0−0,171339=0,005132"
    assert printed(A * B, [2.0, 3.0]) == "2·3=6"
    assert printed(A * B, [80.0, 2.2705]) == "80·2,2705=181,6"
    assert printed(A * B, [132.79125, 800.0]) == "132,791·800=106233"


def test_a_result_beside_the_middle_of_two_roundings_is_rounded_elsewhere():
    """The record has 1.2345 where its formula gives a billionth less: no digit of an operand turns 1.234 into 1.235."""
    assert printed(A * B, [1.0, 1.2345 - 1e-9], result=1.2345 + 1e-9) == "1·1,2345=1,2345"


@pytest.mark.parametrize(("angle", "places", "text"), [
    (radians(20), 1, "20°"), (radians(20 + 12 / 60), 2, "20°12′"), (radians(21 + 14 / 60 + 14.46 / 3600), 2, "21°14′14,5″"),
    (radians(-0.001), 1, "−0°00′04″"), (radians(59.9999), 1, "60°"), (radians(59.9999), 2, "59°59′59,6″"), (0.0, 3, "0°"),
    (radians(7.5), 0, "7°30′"), (radians(1 / 3600), 0, "0°"), (radians(10.05 / 3600), 3, "0°00′10,05″"),
])  # fmt: skip
def test_angles_with_seconds(angle, places, text):
    assert degrees_and_minutes(angle, places) == text
    assert rounded_angle(angle, places) == pytest.approx(angle, abs=radians(0.51 / 60 / (60 * 10 ** (places - 1) if places else 1)))


@pytest.mark.parametrize(("value", "digits", "text", "half"), [
    (2.2705, 4, "2,271", 5e-4), (0.0, 4, "0", 0.5), (9.99996e6, 4, "1·10⁷", 5e6), (1.5e-6, 4, "1,5·10⁻⁶", 5e-8),
    (-106233.2, 4, "−106233", 0.5),
])  # fmt: skip
def test_numbers_as_they_are_read(value, digits, text, half):
    assert shown(value, digits) == text
    said, of = read(value, digits)
    assert said == pytest.approx(float(text.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻−,", "0123456789--.")).replace("·10", "e")))
    assert of == pytest.approx(half)


def test_the_reader_of_printed_formulas_finds_faults():
    """It is the judge of all notes: what does not hold must be seen, also in functions, powers and angles."""
    def holds(line):
        return all(x.holds for x in judged(line))

    assert not holds("x=0,1765+0−0,1713=0,005132")
    assert holds("x=((4·318,28)/(1,1826^(2)))=910,3⟦кг⟧")
    assert not holds("x=((4·318,3)/(1,183^(2)))=910,3⟦кг⟧")
    assert holds(f"x=2·sin 30°15′·tg(45°)={2 * sin(radians(30.25)):.4f}".replace(".", ","))
    assert holds("x=arctg(((0,0015)/(2·0,6))·(25,133·(1+((0,04)/(2))))^(2))=0,6877⟦рад⟧=39°24′")
    assert not holds("x=0,6877⟦рад⟧=39°25′")
    assert holds("x=max(−(−1,3224)·0,049383;0)=0,0653")
    assert holds("x=−√(2)·abs(−3)=−4,24")
    assert not holds("x=−√(2)·abs(−3)=4,24")
    assert holds(f"x=((2)/(cos 60°))={2 / cos(radians(60)):.0f}")
    assert holds(f"y=tg 20°−0,349066={tan(radians(20)) - 0.349066:.6f}".replace(".", ","))
    assert equalities("x=a·b")[0] == []
    assert [x.value for x in judged("x=0,3r_{0}=0,3·2=0,6")] == [pytest.approx(0.6)]
    assert equalities("x=2·=6")[1]
