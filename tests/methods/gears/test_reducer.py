"""Reducers: the picture of velocities and the plan of speeds against exact fractions, conditions, results, protocol."""

from fractions import Fraction
from functools import cache
from math import pi

import numpy as np
import pytest

from tests.few import all_hold
from tests.methods.gears import reducer_cases as cases
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.methods.gears.reducer import reducer


def rpm(speed):
    return speed * 30 / pi


def numbers(told):
    """A results tree as numbers."""
    if isinstance(told, dict):
        return {key: numbers(v) for key, v in told.items()}
    return [numbers(v) for v in told] if isinstance(told, list) else told.value


COLUMNS = [(machine, c, {}) for machine in cases.MACHINES for c in range(10) if (machine, c) != ("compressor", 9)]
COLUMNS += [("press", c, {"scheme": "two internal"}) for c in range(10)]
COLUMNS += [("compressor", c, {"driver": "ring"}) for c in range(10)]


def exact(r):
    """Speeds of all links as fractions of the input's, by Willis's formula; wheels by number, carriers by name."""
    d, speeds = r.table, {}
    z = {name: Fraction(teeth) for name, teeth in r.data.teeth.items()}
    numbers = iter(sorted(z, key=int))
    speed = Fraction(1)

    def simple():
        nonlocal speed
        one, two = next(numbers), next(numbers)
        speeds[one], speeds[two] = speed, -speed * z[one] / z[two]
        speed = speeds[two]

    if d.simple == "before":
        simple()
    for k in range(d.stages):
        name = "H" if d.stages == 1 else f"H{k + 1}"
        if r.scheme.single:
            sun, satellite, ring = next(numbers), next(numbers), next(numbers)
            if r.driver == "sun":
                h = speed / (1 + z[ring] / z[sun])
                speeds |= {sun: speed, ring: Fraction(0)}
            else:
                h = speed / (1 + z[sun] / z[ring])
                speeds |= {sun: Fraction(0), ring: speed}
            speeds[satellite] = h - (speeds[sun] - h) * z[sun] / z[satellite]
            speeds[name] = speed = h
            continue
        one, two, three, four = (next(numbers) for _ in range(4))
        sign = -1 if d.scheme == "external-internal" else 1
        ratio = 1 - sign * z[two] * z[four] / (z[one] * z[three])
        inside = d.scheme == "two internal"
        h = speed if r.driver == "carrier" else speed / ratio
        speeds |= {name: h, one: h * ratio, four: Fraction(0)}
        speeds[two] = speeds[three] = h + (speeds[one] - h) * z[one] / z[two] * (1 if inside else -1)
        speed = speeds[one] if r.driver == "carrier" else h
    if d.simple == "after":
        simple()
    return speeds


@cache
def found(case):
    machine, c, over = COLUMNS[case]
    return reducer(cases.column(machine, c, **over))


def test_speeds_of_the_graphs_are_exact():
    all_hold(has_exact_speeds, range(len(COLUMNS)))


def has_exact_speeds(case):
    r = found(case)
    truth, n = exact(r), rpm(r.table.input_speed)
    assert set(r.names) == set(truth)
    for link, speed in truth.items():
        assert r.kinematics[f"n{link}"].value == pytest.approx(float(speed) * n, rel=1e-12, abs=1e-9)
    for distance in (0.02, 0.05):
        plan = r.speeds(distance)
        read = {name[1:]: float(step.value) for name, step in plan.steps.items() if name.startswith("n")}
        # every turning link, links in one piece once
        assert {float(truth[name]) for name in read} == {float(v) for v in truth.values() if v}
        for name, value in read.items():
            assert value == pytest.approx(float(truth[name]) * n, rel=1e-11)
    assert n / abs(r.kinematics[f"n{r.exit}"].value) == pytest.approx(r.chosen.ratio, rel=1e-13)
    assert abs(r.told("u_planetary")) * r.told("u_simple") == pytest.approx(r.chosen.ratio, rel=1e-13)
    # the ratio of the planetary part is that of its shafts' speeds, with their sign
    one, *_, four = r.stage_wheels[0]
    first, *_, last = (m.carrier for m in r.meshes if m.carrier)
    enters, leaves = {"sun": (one, last), "ring": (four, last), "carrier": (first, one)}[r.driver]
    assert r.told("u_planetary") == pytest.approx(float(truth[enters] / truth[leaves]), rel=1e-13)


@pytest.mark.parametrize("simple", ["after", "none"])
def test_the_sign_of_a_planetary_part_that_reverses(simple):
    """Two internal pairs, z2 z4 > z1 z3: central wheel and carrier turn against each other; the whole has no sign."""
    over = {"scheme": "two internal", "simple": simple, "satellites": 3, "input_speed": 1450 * pi / 30}
    with_pair = {"ratio": 90.01, "pinion": ("z5", 18), "module": 0.003, "simple_module": 0.004}
    alone = {"ratio": 59.71, "pinion": ("z1", 76), "module": 0.003, "simple_module": None}
    got = numbers(reducer(cases.data(**(over | (with_pair if simple == "after" else alone)))).results())
    z = [Fraction(got["teeth"][f"z{n}"]) for n in range(1, 5)]
    ratio = 1 / (1 - z[1] * z[3] / (z[0] * z[2]))
    assert ratio < 0
    assert got["ratio_planetary"] == pytest.approx(float(ratio), rel=1e-11)
    assert got["ratio_planetary"] == pytest.approx(got["speeds_rpm"]["nH"] / got["speeds_rpm"]["n1"], rel=1e-12)
    assert got["ratio"] == pytest.approx(-float(ratio) * got.get("ratio_simple", 1.0), rel=1e-11)
    assert got["deviation"] == pytest.approx(got["ratio"] / got["ratio_asked"] - 1, abs=1e-12)


def test_conditions_and_results():
    all_hold(meets_the_conditions, range(len(COLUMNS)))


def meets_the_conditions(case):
    r = found(case)
    got = numbers(r.results())
    assert set(got) >= {"ratio", "ratio_planetary", "ratio_simple", "teeth", "q", "efficiency", "diameters_w", "speeds_rpm",
                        "conditions"}
    assert got["conditions"]["coaxiality"] == 0
    assert got["conditions"]["assembly"] == int(got["conditions"]["assembly"])
    assert got["conditions"]["neighbourhood"] > 0
    assert got["efficiency"] == pytest.approx(got["efficiency_planetary"] * 0.98, rel=1e-14)
    assert abs(got["deviation"]) <= 0.05
    assert list(got["teeth"]) == [f"z{i + 1}" for i in range(len(got["teeth"]))]
    m, plain = r.table.module, r.table.simple_module
    pair = [name for mesh in r.meshes if not mesh.carrier for name in (mesh.central, mesh.planet)]
    for name, teeth in r.data.teeth.items():
        assert got["diameters_w"][f"d{name}"] == pytest.approx(teeth * 1e3 * (plain if name in pair else m), rel=1e-14)
    for runner in got["runners_up"]:
        assert set(runner["teeth"]) <= set(got["teeth"])
        assert abs(runner["deviation"]) <= 0.05


def test_velocities_belong_to_the_links():
    """Ends of the velocities lie on the links' lines, lengths are omega r: the crusher's column 0, in SI by hand."""
    r = reducer(cases.column("crusher", 0))
    plan = r.velocities
    w1 = 3000 * pi / 30
    # z = 15, 30, 15, 60 of 6 mm: r1 = 45, the satellites' axis at 135, the ring at 180; 12, 20 of 12 mm: r5 = 72, r6 = 120
    points = {"A": 0.045j, "B": 0.18j, "C": 0.135j, "D": -0.072j, "O6": -0.192j}
    for name, value in points.items():
        assert plan[name].value == pytest.approx(value, abs=1e-15)
    assert plan["a"].value == pytest.approx(0.045j + w1 * 0.045, abs=1e-12)
    assert plan["c"].value == pytest.approx(0.135j + w1 / 9 * 0.135, abs=1e-12)
    assert plan["d"].value == pytest.approx(-0.072j - w1 / 9 * 0.072, abs=1e-12)


def test_nothing_is_computed_before_it_is_read():
    r = reducer(cases.column("compressor", 0))
    plan = r.speeds(0.05)
    assert not any(step.evaluated for step in plan)
    assert np.isfinite(plan["n1"].value)
    # the first sun's speed needs nothing of the second stage
    assert plan["1"].evaluated
    assert not plan["5"].evaluated
    assert not r.velocities["f"].evaluated


def test_warnings_name_interference_and_slow_simple_stages():
    texts = reducer(cases.column("crusher", 0)).warnings
    assert texts == ("интерференция в паре 3–4: без смещения её не устраняет никакое число зубьев венца",)
    texts = reducer(cases.column("diesel", 3)).warnings
    assert texts[0] == "передаточное отношение простой ступени меньше 1,2"
    assert reducer(cases.column("press", 0)).warnings == ()
    strict = cases.data(ratio=4.5, simple="before", pinion=("z1", 12), strict_internal=True)
    assert reducer(strict).warnings == ()


@pytest.mark.parametrize("case", range(0, len(COLUMNS), 5))
def test_protocol_says_every_step(case):
    r = found(case)
    for plan in (r.velocities, r.speeds(0.05)):
        said = list(sentences(plan, 0, lambda v: v * 10))
        assert len(said) == len(plan.steps)
        assert all("{" not in text and text.endswith(".") for text in said)
        assert plan.check() is None
    assert any("об/мин" in text for text in said)
