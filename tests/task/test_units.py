"""Numbers with units: truth by exact decimal arithmetic and by hand."""

import math
from decimal import Decimal, localcontext

import pytest
from hypothesis import given, strategies as st

from tests.project_files import EVEN, SLIDER, read
from tmm_sheets.errors import BadInput
from tmm_sheets.task import units, values
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


COSINE = 6.123233995736766e-17
"""What a program has for the cosine of a right angle, less than half a unit of the last digit of 1 from zero."""


@pytest.mark.parametrize(
    ("text", "quantity"),
    [
        ("-4.4e-16 rad", units.ANGLE),
        (f"{40 * COSINE!r} mm", units.LENGTH),
        ("3e-15 mm", units.LENGTH),
        ("2e-13 N m", units.MOMENT),
        (f"{40 * COSINE!r} kN", units.FORCE),
        ("1e-13 kg", units.MASS),
        ("-1e-13 t", units.MASS),
        ("-1e-13 MPa", units.PRESSURE),
        (-COSINE, units.NUMBER),
        ("0 mm", units.LENGTH),
    ],
)
def test_what_rounding_leaves_of_zero_is_zero(text, quantity):
    assert str(values.parsed(text, quantity)) == "0.0"


@pytest.mark.parametrize(("text", "quantity", "si"), [("1e-9 mm", units.LENGTH, 1e-12), ("1.1e-12 kN", units.FORCE, 1.1e-9),
                                                      ("-1e-12 rad", units.ANGLE, -1e-12)])
def test_what_is_small_and_no_rounding_stays(text, quantity, si):
    assert values.parsed(text, quantity) == pytest.approx(si, rel=1e-15, abs=0)


def test_a_file_of_a_program_is_the_file_of_a_person():
    """Coordinates, angles, masses, loads and shares with rounding in them: the same numbers as without."""
    by_hand = {"guide[1].direction": "0 deg", "points": {"O": ["0 mm", "0 mm"]}, "forces": {"gravity": "0 m/s2"},
               "link": [{"name": "2", "mass": "0 kg"}, {"name": "3", "mass": "5 kg", "centre": "B", "inertia": "0 kg m2"}],
               "moment": [{"name": "M1", "link": "1", "direction": "clockwise", "over": "angle",
                           "table": [["0 deg", "0 N m"], ["180 deg", "90 N m"], ["180 deg", "20 N m"], ["360 deg", "0 N m"]]}],
               "force": [{"name": "F3", "link": "3", "point": "B", "direction": "against motion", "sense": "-x",
                          "from": 0, "to": 1, "table": [[0, "0 N"], [0.3, "10 N"], [0.3, "50 N"], [1, "0 N"]]}]}
    by_program = {"guide[1].direction": "-4.4e-16 rad", "points": {"O": ["3e-15 mm", f"{40 * COSINE!r} mm"]},
                  "forces": {"gravity": "-1e-16 m/s2"},
                  "link": [{"name": "2", "mass": "-1e-13 kg"},
                           {"name": "3", "mass": "5 kg", "centre": "B", "inertia": "1e-13 kg m2"}],
                  "moment": [{"name": "M1", "link": "1", "direction": "clockwise", "over": "angle",
                              "table": [["1e-15 deg", "2e-13 N m"], ["180 deg", "90 N m"], ["179.99999999999997 deg", "20 N m"],
                                        ["360 deg", "-2e-14 N m"]]}],
                  "force": [{"name": "F3", "link": "3", "point": "B", "direction": "against motion", "sense": "-x",
                             "from": -1e-17, "to": 1.0000000000000002,
                             "table": [[-COSINE, "1e-14 kN"], [0.3, "10 N"], [0.30000000000000004, "50 N"], [1, "0 N"]]}]}
    hand, program = (read(SLIDER, EVEN, part) for part in (by_hand, by_program))
    assert program.model_dump(exclude={"force", "moment"}) == hand.model_dump(exclude={"force", "moment"})
    for a, b in zip((*hand.force, *hand.moment), (*program.force, *program.moment), strict=True):
        assert b.diagrams() == a.diagrams()


def test_a_cam_of_a_program_is_the_cam_of_a_person():
    by_hand = {"cam": {"follower": "translating roller", "pressure_angle": "30 deg", "displacements": [
        ["0 deg", "0 mm"], ["60 deg", "4 mm"], ["100 deg", "9 mm"], ["120 deg", "9 mm"], ["200 deg", "0 mm"], ["360 deg", "0 mm"]]}}
    by_program = {"cam": {"follower": "translating roller", "pressure_angle": "30 deg", "displacements": [
        ["-1e-15 deg", "2e-16 mm"], ["60 deg", "4 mm"], ["100 deg", "9 mm"], ["120 deg", "8.999999999999998 mm"],
        ["200 deg", "-1e-15 mm"], ["360.00000000000006 deg", "3e-15 mm"]]}}
    hand, program = (read(part).cam for part in (by_hand, by_program))
    assert program.model_dump(exclude={"displacements"}) == hand.model_dump(exclude={"displacements"})
    table = {"cam": {"follower": "translating roller", "law": "table", "rise": "100 deg", "fall": "70 deg", "stroke": "10 mm",
                     "pressure_angle": "30 deg", "table": [[0, 1], [0.5, 1], [0.5, -1], [1, -1]]}}
    rounded = [[1e-17, 1], [0.5, 1], [0.49999999999999994, -1], [0.9999999999999999, -1]]
    assert read(table | {"cam": table["cam"] | {"table": rounded}}).cam.diagram("table") == read(table).cam.diagram("table")


@pytest.mark.parametrize(("key", "value", "said"), [
    ("crank.length", "1e-13 m", "of 1e-12 to 1e+12 in SI units, not '1e-13 m'; is the unit right?"),
    ("crank.length", "-1e-13 m", "greater than zero"),
    ("crank.length", "0 m", "greater than zero"),
    ("crank.speed", "1e13 rpm", "is the unit right?"),
])
def test_where_nothing_is_no_answer(key, value, said):
    with pytest.raises(BadInput) as e:
        read(SLIDER, EVEN, {key: value})
    assert said in str(e.value)


@pytest.mark.parametrize(("text", "value"), [("1/20", 0.05), ("-3/4", -0.75), ("+1/8", 0.125), (" 1/3 ", 1 / 3)])
def test_a_pure_number_may_be_a_fraction(text, value):
    assert units.parse(text, units.NUMBER) == value


@pytest.mark.parametrize("text", ["1/0", "1/20/2", "1/2 %", "1/"])
def test_what_is_no_fraction(text):
    with pytest.raises(units.Refused):
        units.parse(text, units.NUMBER)
