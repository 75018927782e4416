"""The stress run itself: bounds hold, cases repeat, and a wrong formula breaks the invariant it must break."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.methods.linkage import truth as fifty_digits
from tests.methods.linkage.mechanisms import mechanism
from tmm_sheets.__main__ import run
from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.mechanism.model import Crank, Guide, StructuralGroup
from tmm_sheets.methods.linkage import accelerations, forces, positions, velocities, zhukovsky
from tmm_sheets.stress import report, truth
from tmm_sheets.stress.cases import BOUNDS, SCENES, memory, run_case

CASES = 10 * len(SCENES)


@pytest.fixture(scope="module")
def worst():
    return report.run(CASES, 11, million=False)


def test_every_bound_holds(worst):
    assert report.exceeded(worst) == []


def test_every_invariant_is_told_of(worst):
    assert set(worst) == set(BOUNDS) - {report.MEMORY}
    assert all(w.cases > 5 for w in worst.values())


def test_rounding_is_all_there_is(worst):
    """Lengths, closures and equilibrium to a few units in the last place, not just within their bounds."""
    for name in ("link lengths", "closure on guides", "equilibrium of every link", "polygon closure"):
        assert 0 < worst[name].value < 2e-15


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32), st.integers(0, 10**6))
def test_any_seed(seed, case):
    _, values = run_case(seed, case)
    assert {name: value for name, value in values if not value <= BOUNDS[name][0]} == {}


def test_a_case_repeats(worst):
    for name in ("link lengths", "lever = kinetostatics", "velocity at a dead position"):
        w = worst[name]
        scene, values = run_case(11, w.case)
        assert scene == w.scene
        assert dict(values)[name] == w.value
        assert report.run_one(11, w.case)[name].value == w.value


def test_memory_is_that_of_a_chunk():
    """Ten times as many positions take no more."""
    few, many = memory(40_000), memory(200_000)
    assert many < 1.2 * few < 64


@pytest.mark.parametrize("kind", [1, 2])
def test_decimal_truth_against_differentiation(kind):
    if kind == 1:
        m = mechanism(StructuralGroup(1, ("2", "3"), ("B", "D"), "C", (0.35, 0.25), (), -1), fixed={"D": 0.4 - 0.1j})
    else:
        m = mechanism(StructuralGroup(2, ("2", "3"), ("B",), "C", (0.35,), ("x",), -1), guides=[Guide("x", "0", 0.1 + 0.05j, 0.3)])
    m = replace(m, crank=replace(m.crank, acceleration=50.0))
    for phi in (0.3, -2.0, 100.0):
        found, true = truth.motion(m, phi), fifty_digits.motion(m, phi, epsilon=50.0)
        for x, y in ((found.z, true.z), (found.v, true.v), (found.a, true.a)):
            assert abs(x - y["C"]) < 4e-16 * abs(y["C"])


def test_decimal_truth_knows_what_does_not_assemble():
    crank = Crank("1", "A", "B", 0.1, 10.0, 1)
    m = mechanism(StructuralGroup(2, ("2", "3"), ("B",), "C", (0.05,), ("x",)), guides=[Guide("x", "0", 0j, 0.0)], crank=crank)
    with mpmath.workdps(40):
        limit = mpmath.asin(mpmath.mpf(0.05) / mpmath.mpf(0.1))
        assert truth.motion(m, float(limit - mpmath.mpf("1e-15"))) is not None
        assert truth.motion(m, float(limit + mpmath.mpf("1e-15"))) is None


# --- wrong formulas --------------------------------------------------------------------------------------------------


def arcsine(p, q):
    """Direction by the arcsine of its slope: right and left are one, and near the vertical half of the digits are lost."""
    e = q - p
    sine = np.arcsin(np.clip(e.imag / np.abs(e), -1, 1))
    return np.cos(sine) + 1j * np.sin(sine)


def arcsine_on_the_right_side(p, q):
    """The same with the sides told apart: wrong only where half of the digits are lost."""
    u = arcsine(p, q)
    return np.where((q - p).real < 0, -u.conj(), u)


def nearest(c1, r1, c2, r2, side, *known):
    """The assembly side by where the point would be higher, instead of what the group says."""
    left, right = (ar.arc_arc(c1, r1, c2, r2, s, *known) for s in (1, -1))
    return np.where(np.imag(left) > np.imag(right), left, right)


def mutated(rule, compute):
    return replace(rule, compute=compute)


TURNED = "derivative of velocity = acceleration"
SPOILT = {
    "half of the Coriolis acceleration": (accelerations, "CORIOLIS", lambda a, w, v, u: a + 1j * w * (u - v), TURNED),
    "half of it, seen by the forces": (
        accelerations, "CORIOLIS", lambda a, w, v, u: a + 1j * w * (u - v), "power = change of energy"),
    "half of it, seen over the turn": (accelerations, "CORIOLIS", lambda a, w, v, u: a + 1j * w * (u - v), "energy over the turn"),
    "Coriolis acceleration the other way": (accelerations, "CORIOLIS", lambda a, w, v, u: a - 2j * w * (u - v), TURNED),
    "normal acceleration from the centre": (accelerations, "NORMAL", lambda a, w, q, b: a + w * w * (b - q), TURNED),
    "arcsine instead of atan2": (rules, "RAY", arcsine, "velocity closure"),
    "arcsine on the right side": (rules, "RAY", arcsine_on_the_right_side, "closure on guides"),
    "side by the picture": (rules, "ARC_ARC", nearest, "assembly side"),
    "angular velocity turned round": (
        velocities, "ANGULAR_VELOCITY", lambda *z: -velocities._angular(*z), "velocity closure"),
    "inertia couple along epsilon": (forces, "COUPLE", lambda j, e: j * e, "power = change of energy"),
    "weight upwards": (forces, "WEIGHT", lambda m, g: 1j * m * g, "power = change of energy"),
    "arm of a couple on the lever": (zhukovsky, "COUPLE_FORCE", lambda m, x, y: 1j * m * ar.ray(x, y), "lever = kinetostatics"),
    "tangential part towards the other side": (
        forces, "TANGENTIAL", lambda *z: -forces._tangential(*z), "moments on every link"),
    "half-chord from the rounded pin": (positions, "crossing", None, "velocity at a dead position"),
}
"""Where a rule is spoilt, how, and the invariant that must tell."""


@pytest.mark.parametrize("what", SPOILT)
def test_a_wrong_formula_is_caught(monkeypatch, what):
    module, name, compute, invariant = SPOILT[what]
    monkeypatch.setattr(module, name, (lambda *a: None) if compute is None else mutated(getattr(module, name), compute))
    assert any(not dict(run_case(11, case)[1]).get(invariant, 0.0) <= BOUNDS[invariant][0] for case in range(CASES))


# --- the command -----------------------------------------------------------------------------------------------------


def test_command(capsys, monkeypatch):
    monkeypatch.setattr(report, "memory", lambda: 1.0)
    assert run(["stress", "--cases", "12", "--seed", "3"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    lines = out.splitlines()
    assert lines[0].split() == ["invariant", "cases", "worst", "bound", "case", "scene", "share"]
    assert lines[-1] == "one case again: tmm-sheets stress --seed 3 --case N"
    number = next(line for line in lines if line.startswith("link lengths")).split()[5]
    worst = next(line for line in lines if line.startswith("link lengths")).split()[3]
    assert run(["stress", "--seed", "3", "--case", number]) == 0
    assert next(line for line in capsys.readouterr().out.splitlines() if line.startswith("link lengths")).split()[3] == worst


def test_command_tells_what_is_exceeded(capsys, monkeypatch):
    monkeypatch.setattr(accelerations, "CORIOLIS", mutated(accelerations.CORIOLIS, lambda a, w, v, u: a + 1j * w * (u - v)))
    monkeypatch.setattr(report, "memory", lambda: 1.0)
    assert run(["stress", "--cases", "36"]) == 1
    out, err = capsys.readouterr()
    assert "EXCEEDED" in out
    assert err.startswith("bound exceeded: ")
    assert "derivative of velocity = acceleration" in err
    assert "Traceback" not in err


def test_no_number_exceeds_every_bound():
    w = report.Worst()
    w.take(1e-20, 0, "chain")
    w.take(float("nan"), 1, "chain")
    w.take(1e-18, 2, "chain")
    assert report.exceeded({"link lengths": w}) == ["link lengths"]
    assert w.case == 1
