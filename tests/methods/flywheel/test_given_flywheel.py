"""A flywheel that there is, and the coefficient of non-uniformity it leaves; cycles of three turns; power; a crank that alone
has inertia. Truth: closed forms of a crank and slider, and its motion from the law of energy by dense sums.
"""

from math import pi
from pathlib import Path

import numpy as np
import pytest

from tests import project_files as files
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.methods.flywheel.energy_mass import STOPS, Tangents, residual_fluctuation

PUMP = Path(__file__).parents[2] / "projects" / "pump.toml"
R, ROD, C, OMEGA = 0.08, 0.32, 0.11, 4 * pi
PHI = np.linspace(0, 6 * pi, 240001)


def pump(*parts, **flywheel):
    """The pump, with changes; values of ``flywheel`` that are None are left out."""
    return files.project(files.from_file(str(PUMP)), *parts, {f"flywheel.{key}": value for key, value in flywheel.items()})


def closed(crank=0.05):
    """Change of energy and reduced moment of inertia of the pump over its three turns."""
    sin, cos = np.sin(PHI), np.cos(PHI)
    root = np.sqrt(ROD**2 - (R * sin) ** 2)
    x, rate = R * cos + root, -R * sin - R**2 * sin * cos / root
    turn = -R * cos / root  # of the rod
    u = (root - 1j * R * sin) / ROD
    centre = 1j * R * np.exp(1j * PHI) + C * 1j * turn * u
    mass = crank + 0.06 * turn**2 + 5 * np.abs(centre) ** 2 + 8 * rate**2
    way = (R + ROD - x) / (2 * R)
    nth = np.floor(PHI / (2 * pi) - 1e-12)
    force = np.where(nth < 1, 1500 + 2000 * way, np.where(nth < 2, 500 + 2000 * way, 0))
    moment = np.where(rate < 0, force * rate, 0.0)
    work = np.concatenate(([0], np.cumsum((moment[1:] + moment[:-1]) / 2 * np.diff(PHI))))
    return work - work[-1] * PHI / PHI[-1], mass, -work[-1]


def speeds(excess, mass, first):
    """Angular velocity at PHI in the steady running whose extremes have the mean OMEGA."""
    low, high = -excess.min(), 100 * (first + mass.max()) * OMEGA**2
    for _ in range(60):
        level = (low + high) / 2
        speed = np.sqrt(np.maximum(2 * (level + excess) / (first + mass), 0))
        low, high = (level, high) if speed.max() + speed.min() < 2 * OMEGA else (low, level)
    return speed


def running(excess, mass, first):
    """Non-uniformity of that running."""
    return np.ptp(speeds(excess, mass, first)) / OMEGA


@pytest.fixture(scope="module")
def truth():
    return closed()


@pytest.mark.parametrize("inertia", [40.0, 1.6])
def test_delta_of_a_given_flywheel(truth, inertia):
    """From an even running to one that nearly stops."""
    f = pump(inertia=f"{inertia} kg m2").flywheel
    exact = running(truth[0], truth[1], inertia)
    assert float(f.limit_plan["δ∞"].value) == pytest.approx(exact, rel=1e-6)
    assert f.running(f.J_first).delta == pytest.approx(exact, rel=1e-6)
    assert f.unevenness == pytest.approx(exact, rel=0.1)
    assert f.J_first == pytest.approx(inertia + 0.05, rel=1e-15)
    # The tangents that were drawn lead back to themselves, and meet over the flywheel's moment of inertia.
    assert f.unevenness == pytest.approx(f.drawn_delta.value, rel=1e-9)
    slopes = np.tan(f.psi)
    meet = -f.ab_mm / (slopes[0] - slopes[1]) * f.scales.inertia.mu
    assert meet == pytest.approx(-inertia, rel=1e-7)


def test_the_way_back_is_the_way_there():
    """The flywheel that is found for a delta leaves that delta, by both methods, drawn and in the limit."""
    sizes = {"density": "7300 kg/m3", "width_ratio": 0.2, "thickness_ratio": 0.1}
    for method in ("wittenbauer", "mertsalov"):
        there = pump(method=method, inertia=None, delta=0.04, **sizes).flywheel
        drawn = pump(method=method, inertia=f"{there.J_flywheel!r} kg m2").flywheel
        limit = pump(method=method, inertia=f"{there.J_flywheel_converged!r} kg m2").flywheel
        assert drawn.unevenness == pytest.approx(0.04, rel=1e-9)
        assert float(limit.limit_plan["δ∞"].value) == pytest.approx(0.04, rel=1e-11)
        assert drawn.wheel is None
    sized = pump(method=method, inertia=f"{there.J_flywheel!r} kg m2", **sizes).flywheel
    assert sized.wheel.diameter == pytest.approx(there.wheel.diameter, rel=1e-12)


def test_delta_by_mertsalov(truth):
    excess, mass, _ = truth
    f = pump(method="mertsalov").flywheel
    first = excess - (mass - 0.05) * OMEGA**2 / 2
    assert float(f.limit_plan["δ∞"].value) == pytest.approx(np.ptp(first) / (40.05 * OMEGA**2), rel=1e-7)
    assert f.extremes == pytest.approx([OMEGA * (1 + s * f.unevenness / 2) for s in (1, -1)])
    (c,) = f.compared
    assert c.running.delta == pytest.approx(running(excess, mass, 40.05 - 0.05), rel=1e-6)


def test_a_rotor_turns_with_a_given_flywheel(truth):
    motor = {"name": "M", "power": "2 kW", "synchronous": "1000 rpm", "rated": "960 rpm", "efficiency": 0.85,
             "rotor_inertia": "0.25 kg m2", "ratio": 8.0}
    f = pump(inertia="24 kg m2", efficiency=None, motor=motor).flywheel
    assert float(f.limit_plan["δ∞"].value) == pytest.approx(running(truth[0], truth[1], 40.0), rel=1e-6)
    assert f.J_first == pytest.approx(40.05)
    assert set(f.plans) >= {"rotor", "flywheel-given", "motor-check"}


@pytest.mark.parametrize("method", ["wittenbauer", "mertsalov"])
def test_too_light_a_flywheel(method):
    with pytest.raises(CannotBuild, match="the crank would stop"):
        _ = pump(method=method, inertia="0.2 kg m2").flywheel.results()


@pytest.mark.parametrize("method", ["wittenbauer", "mertsalov"])
def test_an_even_running(method):
    """A constant moment on a crank that alone has inertia: nothing varies, and there is nothing to draw."""
    even = {"moment": [{"name": "M1", "link": "1", "direction": "clockwise", "value": "50 N m"}],
            "link": [{"name": "1", "inertia": "0.5 kg m2"}]}
    with pytest.raises(CannotBuild, match="runs evenly"):
        _ = pump({"force": None, "link": None}, even, method=method).flywheel.results()


def test_limits_of_the_search():
    """Nothing varies: no unevenness; just enough to come round, and just not."""
    still = Tangents(0.0, 0.0, 0.0, 0.0)
    assert residual_fluctuation(1.0, lambda delta: still, 1.0, 0.02)[0] == 0.0
    for excess, comes in ((1.999, True), (2.001, False)):
        def of(delta, excess=excess):
            return Tangents(excess, 0.0, 0.0, 0.0)
        if comes:
            assert residual_fluctuation(1.0, of, 1.0, 0.02)[0] == pytest.approx(excess)
        else:
            with pytest.raises(CannotBuild):
                residual_fluctuation(1.0, of, 1.0, 0.02)
    assert STOPS == 2


def test_three_turns_and_power(truth):
    p = pump()
    assert p.cycle.labels == tuple(map(str, range(18)))
    f = p.flywheel
    assert f.work_converged[-1] == pytest.approx(-640, rel=1e-12)  # 2500 N and 1500 N over 0.16 m
    assert float(f.power_plan["P"].value) == pytest.approx(f.M_constant * OMEGA)
    assert float(f.results()["M_constant_converged"].value) * OMEGA == pytest.approx(640 / 1.5)  # W, three turns in 1.5 s
    assert f.results()["motor_power"].value == pytest.approx(f.M_constant * OMEGA / 0.85)
    assert any("кВт" in s or "Вт" in s for s in sentences(f.power_plan, 0, float))
    assert truth[2] == pytest.approx(640, rel=1e-7)
    named = pump({"cycle": {"zero": "6"}}).flywheel
    assert len(set(named.labels[:-1])) == 18
    assert named.labels[0] == named.labels[-1] or named.labels[-1] not in named.labels[:-1]
    assert len(set(named.borders)) == len(named.edges)


@pytest.mark.parametrize("offset", [0.0, 0.03])
def test_a_crank_that_alone_has_inertia(truth, offset):
    """Its reduced moment of inertia is constant: both methods are the excess of energy over delta omega^2, the crank's part off."""
    links = [{"name": "1", "inertia": "0.5 kg m2", "mass": "4 kg", "centre": "S1"}]
    point = [{"name": "S1", "link": "1", "from": "A", "towards": "B", "distance": f"{offset} m"}]
    sizes = {"density": "7300 kg/m3", "width_ratio": 0.2, "thickness_ratio": 0.1}
    own = 0.5 + 4 * offset**2
    expected = np.ptp(truth[0]) / (0.05 * OMEGA**2) - own
    for method in ("wittenbauer", "mertsalov"):
        f = pump({"link": None, "point": None}, {"link": links, "point": point}, method=method, inertia=None, delta=0.05,
                 **sizes).flywheel
        assert f.J_flywheel_converged == pytest.approx(expected, rel=1e-7)
        assert f.J_flywheel == pytest.approx(expected, rel=0.05)
        np.testing.assert_allclose(f.J_reduced, 0.0 if method == "mertsalov" else own, rtol=1e-14)
        assert not f.position_acceleration["dJ/dφ"].value.any()


@pytest.mark.parametrize(("flywheel", "said"), [
    ({"delta": 0.05}, "either delta"), ({"inertia": None}, "either delta"), ({"inertia": "0 kg m2"}, "greater than zero"),
    ({"density": "7300 kg/m3"}, "need width_ratio and thickness_ratio"), ({"inertia": None, "delta": 0.05}, "need density"),
    ({"motor": {"name": "M", "power": "2 kW", "synchronous": "1000 rpm", "rated": "960 rpm", "efficiency": 0.85}}, "of its own"),
])
def test_what_cannot_be_asked(flywheel, said):
    with pytest.raises(BadInput, match=said):
        pump(**flywheel)


def test_turns_are_whole():
    with pytest.raises(BadInput, match="turns"):
        pump({"cycle": {"turns": 0}})


@pytest.mark.parametrize("inertia", [None, "400 kg m2", "40 kg m2", "4 kg m2", "1.6 kg m2"])
def test_angular_velocity_by_the_energy_mass_diagram(truth, inertia):
    """The diagram tells the running of a machine with the flywheel found or given: by the law of energy, to the drawing's error."""
    f = pump(inertia=inertia, **{} if inertia else {"delta": 0.05, "density": "7300 kg/m3", "width_ratio": 0.2,
                                                  "thickness_ratio": 0.1}).flywheel
    plan = f.speed_plan
    fast, slow = (float(plan[f"ω_{name}"].value) for name in ("max", "min"))
    added = float((f.added if f.given else f.first_plan["J_доб"]).value)
    exact = speeds(truth[0], truth[1], added)
    assert (fast, slow) == pytest.approx((exact.max(), exact.min()), rel=0.05 * np.ptp(exact) / OMEGA)
    found = plan["ω1"].value
    assert np.abs(found - np.interp(f.reduced.phi, PHI, exact)).max() < 0.1 * np.ptp(exact)
    assert np.ptp(found) > 0.8 * np.ptp(exact)
    # Nothing lies beyond the tangents.
    along = f.speed_curve(f.samples)
    assert (along.max(), along.min()) == pytest.approx((fast, slow), rel=1e-4 * np.ptp(exact) / OMEGA)
