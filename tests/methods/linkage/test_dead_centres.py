"""Velocities and accelerations up to the dead positions of a limited crank, against 120 digits."""

from dataclasses import replace
from math import pi

import mpmath
import numpy as np
import pytest

from tests.methods.linkage import truth
from tests.methods.linkage.mechanisms import mechanism, value
from tmm_sheets.mechanism.groups import RPR, RRP, RRR
from tmm_sheets.mechanism.model import Crank, Guide, LinkPoint, StructuralGroup
from tmm_sheets.methods.linkage.motion import acceleration_plan, velocity_plan
from tmm_sheets.methods.linkage.positions import position_plan

GAPS = [10.0**-n for n in (1, 3, 6, 9, 12, 15)]


@pytest.fixture(autouse=True)
def many_digits(monkeypatch):
    monkeypatch.setattr(truth, "DIGITS", 120)
    monkeypatch.setattr(truth, "STEP", mpmath.mpf(10) ** -40)
    with mpmath.workdps(120):
        yield


def four_bar(rng, *, swapped=False, on_pin=True):
    """A four-bar whose crank cannot turn round, and the crank angle of its limit."""
    while True:
        l1, l2, l3 = rng.uniform(0.5, 2, 3)
        pivot = complex(rng.uniform(0.3, 5) * np.exp(1j * rng.uniform(-pi, pi)))
        r = mpmath.mpf(l1)
        cos = (r**2 + abs(mpmath.mpmathify(pivot)) ** 2 - (mpmath.mpf(l2) + l3) ** 2) / (2 * r * abs(mpmath.mpmathify(pivot)))
        if abs(cos) < 0.98:
            break
    ahead = 0.0 if on_pin else 0.7
    end = "B" if on_pin else "E"
    side = int(rng.choice((1, -1)))
    group = (StructuralGroup(RRR, ("2", "3"), ("D", end), "C", (l3, l2), (), side) if swapped
             else StructuralGroup(RRR, ("2", "3"), (end, "D"), "C", (l2, l3), (), side))
    points = () if on_pin else (LinkPoint("E", "1", "A", "B", l1, ahead),)
    m = mechanism(group, fixed={"D": pivot}, points=points, crank=Crank("1", "A", "B", l1 if on_pin else 0.3, 10.0, 1))
    return m, mpmath.arg(mpmath.mpmathify(pivot)) + mpmath.acos(cos) - mpmath.mpf(ahead)


def slider_crank(rng, direction=None):
    """A slider-crank with a rod too short to go round, and the crank angle of its limit."""
    l1 = rng.uniform(0.5, 2)
    l2, e = l1 * rng.uniform(0.4, 0.85), l1 * rng.uniform(-0.1, 0.1)
    psi = rng.uniform(-pi, pi) if direction is None else direction
    through = complex(-1j * np.exp(1j * psi) * e + np.exp(1j * psi) * rng.uniform(-1, 1))
    m = mechanism(StructuralGroup(RRP, ("2", "3"), ("B",), "C", (l2,), ("x",), int(rng.choice((1, -1)))),
                  guides=[Guide("x", "0", through, psi)], crank=Crank("1", "A", "B", l1, 10.0, 1))
    at = mpmath.mpf(psi) if direction is None else mpmath.pi / 2 * round(direction / (pi / 2))
    reach = (mpmath.conj(mpmath.expj(at)) * -mpmath.mpmathify(through)).imag
    return m, at + mpmath.asin((mpmath.mpf(l2) - reach) / mpmath.mpf(l1))


def as_meant(m):
    """Guides along the axes lie there exactly, not beside them by the rounding of pi."""
    guides = {n: replace(g, direction=mpmath.pi / 2 * round(g.direction / (pi / 2))) if g.direction in (pi / 2, pi) else g
              for n, g in m.guides.items()}
    return replace(m, guides=guides)


def checked(m, limit, sense):
    """Largest relative errors of velocities and accelerations at all gaps on one side of the limit."""
    for gap in GAPS:
        phi = float(limit + sense * mpmath.mpf(gap))
        true = truth.motion(as_meant(m), phi)
        vel = velocity_plan(position_plan(m, np.array([phi])))
        acc = acceleration_plan(vel)
        assert abs(value(vel.positions.points["C"]) - true.z["C"]) < 4e-15
        for found, exact in ((vel.points["C"], true.v["C"]), (vel.omega["2"], true.omega["2"]), (vel.omega["3"], true.omega["3"]),
                             (acc.points["C"], true.a["C"]), (acc.epsilon["2"], true.epsilon["2"])):
            # Where a link stands still by chance the digits are those of the other link.
            size = max(abs(exact), 0.2 * abs(true.omega["2"]) if exact in (true.omega["2"], true.omega["3"]) else 0.0)
            assert abs(value(found) - exact) < 2e-14 * size, (gap, found.name)


@pytest.mark.parametrize("seed", range(6))
def test_limited_four_bar(seed):
    m, limit = four_bar(np.random.default_rng(seed), swapped=seed % 2 == 1, on_pin=seed % 3 != 2)
    checked(m, limit, -1)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("direction", [None, pi / 2, pi])
def test_limited_slider_crank(seed, direction):
    checked(*slider_crank(np.random.default_rng(seed), direction), -1)


def test_beyond_the_limit_nothing_is_built():
    for m, limit in (four_bar(np.random.default_rng(3)), slider_crank(np.random.default_rng(3))):
        phi = np.array([float(limit + s * mpmath.mpf(g)) for g in GAPS for s in (-1, 1)])
        built = ~np.isnan(position_plan(m, phi).points["C"].value)
        np.testing.assert_array_equal(built, [True, False] * len(GAPS))


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(("rod", "rocker", "frame"), [(0.5, 0.125, 0.5), (0.125, 0.5, 0.5), (0.25, 0.375, 0.5)])
def test_the_side_is_kept_at_change_points(side, rod, rocker, frame):
    """Crank 0.125: parallelogram, kite and a four-bar that folds flat; left or right of the line from pin to pivot all round."""
    m = mechanism(StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (rod, rocker), (), side), fixed={"D": frame + 0j},
                  crank=Crank("1", "A", "B", 0.125, 10.0, 1))
    turn = np.concatenate([k * pi + np.array([-1e-3, -1e-9, -1e-12, 0, 1e-12, 1e-9, 1e-3]) for k in (0, 1, 2, 7)])
    p = {name: np.broadcast_to(step.value, turn.shape) for name, step in position_plan(m, turn).points.items()}
    away = np.abs(p["D"] - p["B"]) > 1e-6
    left = (np.conj(p["D"] - p["B"]) * (p["C"] - p["B"])).imag
    assert (left[away] * side > -1e-17).all()
    assert not np.isnan(p["C"][away]).any()


def test_what_is_not_between_crank_and_frame_has_no_such_form():
    """A second dyad on the rocker, a guide on the crank: built from the points as before."""
    m = mechanism(
        StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (0.35, 0.25)),
        StructuralGroup(RRR, ("4", "5"), ("C", "E"), "F", (0.3, 0.3)),
        fixed={"D": 0.4 + 0j, "E": 0.7 + 0j},
    )
    pos = position_plan(m, np.array([0.7]))
    assert set(pos.sines) == {"2"}
    assert len(pos.plan["F"].args) == 5
    assert abs(value(pos.points["F"]) - complex(truth.state(m, mpmath.mpf(0.7)).points["F"])) < 1e-15


@pytest.mark.parametrize("seed", range(6))
def test_slot_that_can_no_longer_pass_its_pivot_at_the_offset(seed):
    """A rocker with an offset: at the limit the pin lies on the circle of the offset and the slot across the line of the pivots."""
    rng = np.random.default_rng(seed)
    l1 = rng.uniform(0.5, 2)
    pivot = complex(l1 * rng.uniform(1.2, 2) * np.exp(1j * rng.uniform(-pi, pi)))
    offset = abs(pivot) - l1 + rng.uniform(0.1, 0.8) * 2 * l1
    m = mechanism(StructuralGroup(RPR, ("2", "3"), ("B", "C"), None, (), (), int(rng.choice((1, -1))), offset), fixed={"C": pivot},
                  points=(LinkPoint("S", "3", "C", "B", 0.3, 0.4),), crank=Crank("1", "A", "B", l1, 10.0, 1))
    far = abs(mpmath.mpmathify(pivot))
    cos = (mpmath.mpf(l1) ** 2 + far**2 - mpmath.mpf(offset) ** 2) / (2 * mpmath.mpf(l1) * far)
    limit = mpmath.arg(mpmath.mpmathify(pivot)) + mpmath.acos(cos)
    for gap in GAPS:
        phi = float(limit + mpmath.mpf(gap))
        true = truth.motion(m, phi)
        vel = velocity_plan(position_plan(m, np.array([phi])))
        acc = acceleration_plan(vel)
        assert abs(value(vel.positions.points["S"]) - true.z["S"]) < 4e-15
        assert abs(value(vel.omega["3"]) - true.omega["3"]) < 2e-14 * max(abs(true.omega["3"]), 1.0)
        assert abs(value(acc.epsilon["3"]) - true.epsilon["3"]) < 2e-14 * max(abs(true.epsilon["3"]), 10.0)
    assert np.isnan(value(position_plan(m, np.array([float(limit - mpmath.mpf("1e-15"))])).points["S"]))
