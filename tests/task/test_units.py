"""Numbers with units: truth by exact decimal arithmetic and by hand."""

import math
from decimal import Decimal, localcontext

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmm_sheets.task import units
from tmm_sheets.task.units import parse


@pytest.mark.parametrize(
    ("text", "quantity", "si"),
    [
        ("0.26 m", units.LENGTH, 0.26),
        ("260 mm", units.LENGTH, 0.26),
        ("260мм", units.LENGTH, 0.26),
        ("0,26 м", units.LENGTH, 0.26),
        ("-0.26 m", units.LENGTH, -0.26),
        ("−0,26 м", units.LENGTH, -0.26),
        ("2.6e-1 m", units.LENGTH, 0.26),
        ("26 cm", units.LENGTH, 0.26),
        ("3.5 mm", units.LENGTH, 0.0035),
        ("1.2 1/s", units.ANGULAR_VELOCITY, 2.4 * math.pi),
        ("72 rpm", units.ANGULAR_VELOCITY, 2.4 * math.pi),
        ("72 об/мин", units.ANGULAR_VELOCITY, 2.4 * math.pi),
        ("7.54 rad/s", units.ANGULAR_VELOCITY, 7.54),
        ("30 deg", units.ANGLE, math.pi / 6),
        ("90°", units.ANGLE, math.pi / 2),
        ("0.5 rad", units.ANGLE, 0.5),
        ("1.7 rad/s^2", units.ANGULAR_ACCELERATION, 1.7),
        ("9.81 m/s²", units.ACCELERATION, 9.81),
        ("0.15110 kg m2", units.INERTIA, 0.1511),
        ("0.15110 kg*m^2", units.INERTIA, 0.1511),
        ("0,1511 кг·м²", units.INERTIA, 0.1511),
        ("700 g", units.MASS, 0.7),
        ("2.8 kN", units.FORCE, 2800.0),
        ("612 N m", units.MOMENT, 612.0),
        ("612 N·m", units.MOMENT, 612.0),
        ("612 N mm", units.MOMENT, 0.612),
        ("6 MPa", units.PRESSURE, 6e6),
        ("7.3 g/cm3", units.DENSITY, 7300.0),
        ("12 N/mm", units.STIFFNESS, 12000.0),
        ("0,025", units.NUMBER, 0.025),
        ("2.5 %", units.NUMBER, 0.025),
        (0.025, units.NUMBER, 0.025),
        (3, units.NUMBER, 3.0),
    ],
)
def test_si(text, quantity, si):
    assert parse(text, quantity) == si


@pytest.mark.parametrize(
    ("value", "quantity", "said"),
    [
        ("0.26", units.LENGTH, "the unit is missing"),
        (0.26, units.LENGTH, "with its unit, not the bare number 0.26"),
        ("0.26 kg", units.LENGTH, "'kg' is a unit of mass"),
        ("0.26 mmm", units.LENGTH, "did you mean 'mm'"),
        ("0.26 xyz", units.LENGTH, "known are m, mm, cm"),
        ("nan m", units.LENGTH, "expected a length"),
        ("inf m", units.LENGTH, "expected a length"),
        ("1e400 m", units.LENGTH, "must be finite"),
        ("1e4000000000 m", units.LENGTH, "unknown unit"),
        ("9" * 100 + " m", units.LENGTH, "expected a length"),
        (float("nan"), units.NUMBER, "must be finite"),
        (float("inf"), units.NUMBER, "must be finite"),
        (True, units.NUMBER, "true or false"),
        ([1], units.LENGTH, "a list"),
        ({"m": 1}, units.LENGTH, "a table"),
        ("", units.LENGTH, "expected a length"),
        ("m", units.LENGTH, "expected a length"),
        ("1.000.5 m", units.LENGTH, "unknown unit"),
        ("3 m", units.NUMBER, "a pure number has no unit"),
        ("30", units.ANGLE, 'write for example "30 deg"'),
    ],
)
def test_refused(value, quantity, said):
    with pytest.raises(ValueError, match=r".") as e:
        parse(value, quantity)
    assert said in str(e.value)
    assert str(e.value).startswith("expected a")


@given(st.decimals(allow_nan=False, allow_infinity=False, places=9, min_value=-(10**9), max_value=10**9))
def test_conversion_rounds_once(number):
    with localcontext() as context:
        context.prec = 60
        exact = number / Decimal(1000)
    assert parse(f"{number:f} mm", units.LENGTH) == float(exact)
    assert parse(f"{number:f} mm".replace(".", ","), units.LENGTH) == float(exact)
