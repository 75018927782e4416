"""Letters and numbers of quantities as a task prints them."""

import pytest

from tmm_sheets.task import units


@pytest.mark.parametrize(("name", "letters"), [
    ("l_OA", "l_{OA}"), ("G2", "G_{2}"), ("theta", "θ"), ("omega1", "ω_{1}"), ("n_k", "n_{k}"), ("J_S2", "J_{S2}"), ("r", "r"),
    ("m_{2} = m_{4}", "m_{2} = m_{4}"), ("speed", "speed"), ("z_1′", "z_{1}′"), ("h_a*", "h_a*"), ("λ", "λ"),
])
def test_letters(name, letters):
    assert units.symbol(name) == letters


@pytest.mark.parametrize(("text", "number", "unit"), [
    ("1/80", "1/80", ""), ("0,5 кН", "0.5", "кН"), ("0.20 m", "0.20", "m"), ("12", "12", ""), ("-3 deg", "-3", "deg"),
    ("1/0", "", ""), ("3 apples", "", ""), ("", "", ""),
])
def test_numbers(text, number, unit):
    assert units.split_printed(text) == (number, unit)


def test_values():
    weight, delta = units.printed({"G2": "0,5 kN", "delta": "1/80"})
    assert (weight.value, weight.unit) == (500.0, "kN")
    assert delta.value == 1 / 80
