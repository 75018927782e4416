"""Mertsalov's procedure: against closed forms, the exact running, Wittenbauer's flywheel, and the tables of manual 002."""

from __future__ import annotations

import csv
from math import acos, cos, degrees, pi, radians
from pathlib import Path
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from tests.methods.cams.cam_cases import told
from tests.methods.flywheel import press_truth as truth
from tests.methods.flywheel.running import speed_of
from tests.methods.linkage import shaper_truth as shaper
from tests.methods.linkage.shaper_truth import Shaper
from tests.project_files import from_file, project
from tmm_sheets import catalogue
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.construction.scale import Scale
from tmm_sheets.methods.flywheel.diagram_scales import FlywheelScales
from tmm_sheets.methods.flywheel.energy_mass import Energy, steady
from tmm_sheets.methods.flywheel.flywheel import Flywheel
from tmm_sheets.methods.flywheel.reduced import TRIED, Reduction
from tmm_sheets.methods.flywheel.wheel import motor_check, wheel
from tmm_sheets.methods.flywheel.wheel_methods import FOUR_GRAPHS, Mertsalov, Wittenbauer, flywheel
from tmm_sheets.project import Project

MANUALS = Path(__file__).parents[2] / "manuals"


def data(delta=0.04, motor=None, inertia=None, efficiency=None):
    return SimpleNamespace(method="mertsalov", delta=delta, form="rim", density=7800.0, width_ratio=0.2, thickness_ratio=0.12,
                           rim_share=1.0, motor=motor, inertia=inertia, efficiency=efficiency)


@pytest.fixture(scope="module")
def press():
    return Project(catalogue.read("press"))


@pytest.fixture(scope="module")
def fw(press):
    return press.flywheel


def changed(*parts):
    return project(from_file("press"), *parts)


# --- truth: reduced quantities, moment of inertia, running ----------------------------------------------------------------


def test_reduced_quantities_against_closed_forms(fw):
    t = np.linspace(0.01, 6.27, 60)
    r = fw.reduced
    np.testing.assert_allclose(r.moment(t), [truth.moment(x) for x in t], rtol=1e-11, atol=1e-9)
    np.testing.assert_allclose(fw.inertia(t), truth.inertia(t), rtol=1e-12)
    slope = [float(mpmath.diff(lambda u: truth.inertia(u, mpmath), x)) for x in t]
    at = Reduction(r, TRIED, t)
    np.testing.assert_allclose(at.slope.value, slope, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(sum(r.parts(at).values()), truth.inertia(t), rtol=1e-12)


def test_moment_of_inertia_for_vanishing_intervals(fw):
    assert fw.J_first_converged == pytest.approx(truth.mertsalov(), rel=1e-12)
    j, fast, slow = truth.exact()
    assert fw.limit.inertia == pytest.approx(j, rel=1e-12)
    assert fw.limit.phi_max == pytest.approx(fast, abs=1e-7)
    assert fw.limit.phi_min == pytest.approx(slow, abs=1e-7)


def test_reference_values(fw, press):
    """Figures of an independent solver (worked example of the manual), to the digits it gives."""
    assert fw.J_first_converged == pytest.approx(295.2, abs=0.05)
    assert fw.limit.inertia == pytest.approx(294.5, abs=0.05)
    assert truth.total() / (2 * pi) == pytest.approx(763.94, abs=0.005)
    mu_a = 32.42983 * 2 * pi / 180 * 50
    assert fw.J_first_converged * 0.04 * truth.OMEGA**2 / mu_a == pytest.approx(51.49, abs=0.05)
    assert truth.total() / (2 * pi) + truth.moment(7 * pi / 6) == pytest.approx(608.7, abs=0.05)
    assert fw.position_acceleration["ε1"].value[press.force_index] == pytest.approx(1.7, abs=0.05)
    assert press.study.accelerations.epsilon["2"].at(press.force_index) > 0  # counter-clockwise, as printed


def test_drawn_construction_tends_to_the_limit_as_the_square_of_the_interval():
    drawn = np.array([changed({"cycle.positions": n, "cycle.zero": "0"}).flywheel.J_first for n in (24, 48, 96)])
    goal = truth.mertsalov()
    errors = np.abs(drawn - goal)
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([2, 2], abs=0.05)
    assert (4 * drawn[2] - drawn[1]) / 3 == pytest.approx(goal, rel=1e-6)


def test_excess_over_the_exact_flywheel_is_the_mean_inertia_at_the_extremes():
    """J_M - J exact = (J_II(fast) + J_II(slow))/2 + O(delta): the rest shrinks with delta."""
    rest = []
    for delta in (0.04, 0.004, 0.0004):
        j, fast, slow = truth.exact(delta)
        rest.append(abs(truth.mertsalov(delta) - j - (truth.inertia(fast) + truth.inertia(slow)) / 2))
    assert rest[0] < 0.01
    assert rest[0] / rest[1] == pytest.approx(10, rel=0.1)
    assert rest[1] / rest[2] == pytest.approx(10, rel=0.1)


def test_both_methods_agree_in_the_limit(fw):
    assert fw.J_first_converged / fw.limit.inertia - 1 == pytest.approx(0.00258, abs=1e-5)
    steadier = Mertsalov(fw.reduced, data(delta=1e-5), FOUR_GRAPHS)
    assert steadier.J_first_converged / steadier.limit.inertia == pytest.approx(1, abs=1e-6)
    assert fw.excess == pytest.approx(fw.J_first_converged - fw.limit.inertia, rel=0.01)


def test_exact_running_by_runge_kutta(fw):
    """The drawn flywheel on the machine: the equation of motion over the turn, smooth stretch by smooth stretch."""
    first, running = fw.J_first, fw.running(fw.J_first)
    drive = truth.total() / (2 * pi)

    def rate(t, w):
        h = 1e-5
        slope = (truth.inertia(t + h) - truth.inertia(t - h)) / (2 * h)
        return (truth.moment(t) + drive - slope * w * w / 2) / ((first + truth.inertia(t)) * w)

    w = running.fastest * np.sqrt((first + truth.inertia(running.phi_fastest)) / (first + truth.inertia(0.0)) - 2 * (
        drive * running.phi_fastest + truth.work(running.phi_fastest)) / ((first + truth.inertia(0.0)) * running.fastest**2))
    start, speeds, h = w, [w], 2 * pi / 4000
    for i in range(4000):
        t = i * h
        k1 = rate(t, w)
        k2 = rate(t + h / 2, w + h / 2 * k1)
        k3 = rate(t + h / 2, w + h / 2 * k2)
        k4 = rate(t + h, w + h * k3)
        w += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        speeds.append(w)
    assert w == pytest.approx(start, rel=1e-8)
    assert max(speeds) == pytest.approx(running.fastest, rel=1e-7)
    assert min(speeds) == pytest.approx(running.slowest, rel=1e-7)
    assert running.mean == pytest.approx(truth.OMEGA, rel=1e-14)


def test_exact_running_with_the_exact_flywheel_has_the_given_delta(fw):
    running = fw.running(fw.limit.inertia)
    assert running.delta == pytest.approx(0.04, rel=1e-11)
    assert running.fastest == pytest.approx(truth.OMEGA * 1.02, rel=1e-13)
    assert running.slowest == pytest.approx(truth.OMEGA * 0.98, rel=1e-13)


@settings(max_examples=15)
@given(st.floats(30, 1e4))
def test_running_is_the_energy_integral(first):
    """Brute force on another machine: 20,000 angles, the work of its constant force in closed form."""
    r = Shaper()
    running = steady(Energy(r.moment, r.inertia, np.unique(np.append(r.phi, r.breaks))), first, r.omega1)
    begin, end = r.breaks

    def energy(t):
        way = shaper.CD * shaper.rocker(np.clip(t, begin, end) + shaper.START)[0]
        start = shaper.CD * shaper.rocker(begin + shaper.START)[0]
        return shaper.F5 * (shaper.ram_stroke() * t / (2 * pi) - (way - start))

    t = np.append(np.linspace(0, 2 * pi, 20001), r.breaks)
    at = running.phi_fastest
    level = running.fastest**2 / 2 * (first + r.inertia(at)) - energy(at)
    speeds = np.sqrt(2 * (level + energy(t)) / (first + r.inertia(t)))
    assert running.mean == pytest.approx(r.omega1, rel=1e-12)
    assert speeds.max() == pytest.approx(running.fastest, rel=1e-7)
    assert speeds.min() == pytest.approx(running.slowest, rel=1e-5)
    assert speeds.max() <= running.fastest * (1 + 1e-12)
    assert speeds.min() >= running.slowest * (1 - 1e-12)


def test_a_crank_too_light_to_be_carried_round():
    r = Shaper()
    running = steady(Energy(r.moment, r.inertia, np.unique(np.append(r.phi, r.breaks))), 1e-3, r.omega1)
    assert np.isnan(running.delta)


def test_comparison_on_the_sheet(fw):
    drawn, other, ours, exact = fw.compared
    assert [c.first for c in fw.compared] == [fw.J_first, other.first, fw.J_first_converged,
                                              pytest.approx(fw.limit.inertia, rel=1e-14)]
    assert other.first == pytest.approx(Wittenbauer(fw.reduced, data()).J_first, rel=1e-15)
    assert exact.running.delta == pytest.approx(0.04, rel=1e-11)
    assert ours.running.delta == pytest.approx(0.0399, abs=5e-6)
    assert drawn.running.delta == pytest.approx(0.03910, abs=5e-6)
    for c in fw.compared:
        assert c.running.delta * c.first == pytest.approx(exact.running.delta * exact.first, rel=0.001)


# --- the construction ------------------------------------------------------------------------------------------------------


def test_first_energy_is_what_is_left(fw):
    second = np.asarray(fw.J_reduced) * truth.OMEGA**2 / 2
    np.testing.assert_allclose(fw.T_second, second, rtol=1e-12)
    np.testing.assert_allclose(fw.T_first, fw.delta_E - second, atol=1e-9)


def test_segment_is_the_difference_of_the_extremes(fw):
    """By brute force along the drawn curve."""
    curve = fw.first_curve(np.append(np.linspace(0, 2 * pi, 200001), fw.edges)).imag
    assert fw.ab_mm == pytest.approx(np.ptp(curve), rel=1e-9)
    assert fw.energy_plan["a"].value.imag == pytest.approx(curve.max(), rel=1e-9)
    assert fw.J_first == pytest.approx(fw.ab_mm * fw.scales.energy.mu / (0.04 * truth.OMEGA**2), rel=1e-15)


def test_angular_velocity_from_its_axis(fw):
    """The axis halves ab, so the extremes are omega (1 +- delta/2); the ordinates count with their signs."""
    fast, slow = fw.extremes
    assert fast == pytest.approx(truth.OMEGA * 1.02, rel=1e-12)
    assert slow == pytest.approx(truth.OMEGA * 0.98, rel=1e-12)
    assert fw.omega.max() <= fast
    assert fw.omega.min() >= slow
    assert (fw.omega < truth.OMEGA).any()
    assert (fw.omega > truth.OMEGA).any()
    exact = fw.running(fw.J_first)
    real = speed_of(Wittenbauer(fw.reduced, data()), fw.reduced.phi, fw.J_first)
    np.testing.assert_allclose(fw.omega - fw.omega.mean(), real - real.mean(), atol=0.1 * 0.04 * exact.mean)


def test_acceleration_from_the_equation_of_motion(fw):
    t = np.linspace(0.1, 6.2, 9)
    slope = np.array([float(mpmath.diff(lambda u: truth.inertia(u, mpmath), x)) for x in t])
    forces = np.array([truth.moment(x) for x in t]) + fw.M_constant
    expected = (forces - truth.OMEGA**2 / 2 * slope) / (fw.J_first + truth.inertia(t))
    np.testing.assert_allclose(fw.acceleration_plan(t)["ε1"].value, expected, rtol=1e-9)
    np.testing.assert_allclose(fw.position_acceleration["ε1"].value, fw.acceleration_plan(fw.reduced.phi)["ε1"].value, rtol=1e-12)


def test_tangent_on_paper_has_the_slope_of_the_graph(fw):
    h = 1e-6
    s = fw.scales
    for k in (1, 4, 7):
        t = fw.reduced.phi[k] + np.array([-h, h])
        paper = np.diff(s.inertia.mm(truth.inertia(t)))[0] / np.diff(s.angle.mm(t))[0]
        assert np.tan(fw.position_acceleration["ψ"].value[k]) == pytest.approx(paper, rel=1e-6)


def test_kinetostatics_with_this_acceleration_gives_the_driving_moment(press):
    """The crank carries all its inertia, so the balancing moment is the constant driving moment in every position."""
    study = press.study
    np.testing.assert_allclose(np.abs(study.forces.balancing.value), press.flywheel.M_constant, rtol=1e-12)
    np.testing.assert_allclose(study.lever.balancing.value, study.forces.balancing.value, rtol=1e-12)
    assert np.sign(study.forces.balancing.value[0]) == press.mechanism.crank.sense


def test_results_do_not_depend_on_the_scales(fw):
    scales = FlywheelScales(Scale("", 0.05, ""), Scale("", 1.0, ""), Scale("", 30.0, ""), Scale("", 30.0 * 0.05 * 50, ""),
                    Scale("", 7.0, ""), Scale("", 0.003, ""), 50.0)
    other = Mertsalov(fw.reduced, data(), FOUR_GRAPHS, scales)
    assert other.J_first == pytest.approx(fw.J_first, rel=1e-12)
    np.testing.assert_allclose(other.omega, fw.omega, rtol=1e-12)
    np.testing.assert_allclose(other.position_acceleration["ε1"].value, fw.position_acceleration["ε1"].value, rtol=1e-10)


def test_inertia_of_the_crank_and_the_rotor_is_taken_off():
    heavy = changed({"link[1]": {"mass": "20 kg", "centre": "A", "inertia": "1.5 kg m2"},
                     "flywheel.motor.rotor_inertia": "0.2 kg m2"}).flywheel
    light = changed().flywheel
    assert heavy.reduced.crank_inertia == pytest.approx(1.5 + 20 * 0.12**2, rel=1e-14)
    assert heavy.J_rotor == pytest.approx(0.2 * 6.5**2, rel=1e-12)
    np.testing.assert_allclose(heavy.J_reduced, light.J_reduced, rtol=1e-12)
    there, here = (r.parts(Reduction(r, TRIED, np.array([0.1]))) for r in (heavy.reduced, light.reduced))
    assert set(there) == set(here)
    # The crank's weight changes the moments: without it the first group would be the same.
    weightless = changed({"link[1].inertia": "1.788 kg m2"}).flywheel
    assert weightless.J_first == pytest.approx(light.J_first, rel=1e-12)
    assert weightless.J_flywheel == pytest.approx(light.J_first - 1.788, rel=1e-12)
    assert weightless.J_flywheel_converged == pytest.approx(light.J_first_converged - 1.788, rel=1e-12)


def test_no_flywheel_is_needed():
    p = changed({"link[1].inertia": "400 kg m2"})
    assert p.flywheel.wheel is None
    assert p.flywheel.remarks == ("no flywheel is needed: 400 kg m2 turn with the crank, 301.3 are enough "
                                  "(295.2 in the limit of many positions)",)


def test_rim_share_of_manual_001():
    """D = (4.8 J/(gamma pi k^2))^(1/5) with a = 0.75 b and nine tenths of J in the rim."""
    j, k = 3.7, 0.3
    w = wheel(j, 1.0, "rim", 7800, k, 0.75 * k, 0.9)
    assert w.diameter == pytest.approx((4.8 * j / (7800 * pi * k**2)) ** 0.2, rel=1e-14)
    assert w.mass * w.diameter**2 / 4 == pytest.approx(0.9 * j, rel=1e-14)


def test_every_plan_speaks_and_can_be_built(fw):
    own = [name for name in fw.plans if "@" not in name]
    assert own[-9:] == ["first-energy", "drive-power", "flywheel-inertia", "flywheel-limit", "crank-speed", "comparison",
                        "flywheel-wheel", "motor-check", "crank-acceleration"]
    for plan in fw.plans.values():
        assert plan.check() is None
        for k in range(0, len(plan.labels), 7):
            assert all(s.endswith(".") and "nan" not in s for s in sentences(plan, k, lambda mm: mm))


def test_method_by_name(fw):
    assert isinstance(flywheel(fw.reduced, data()), Mertsalov)
    with pytest.raises(TypeError, match="abstract"):
        Flywheel(fw.reduced, data())


def test_nothing_is_computed_before_it_is_read():
    class Silent:
        def __getattr__(self, name):
            raise AssertionError(f"{name} was read")

    assert isinstance(flywheel(Silent(), data()), Mertsalov)


def test_positions_do_not_ask_for_the_flywheel():
    p = Project(catalogue.read("press"))
    _ = p.study.velocities.plan["b"].value
    assert "flywheel" not in vars(p)
    _ = p.study.accelerations
    assert "flywheel" in vars(p)


# --- manual 002 --------------------------------------------------------------------------------------------------------------


def table():
    with (MANUALS / "press_positions.csv").open(encoding="utf-8") as f:
        rows = list(csv.DictReader(f))
    assert len(rows) == 13
    return [(7 if row["position"] == "k" else int(row["position"]), row) for row in rows]


def printed():
    """Printed values without the errata."""
    with (MANUALS / "press_scalars.csv").open(encoding="utf-8") as f:
        rows = list(csv.DictReader(f))
    return {row["id"].removeprefix("pr."): (float(row["value"]), float(row["implied_precision_abs"])) for row in rows
            if not row["errata"]}


READ = 0.25  # mm: three times the scatter of a drawing measured in a CAD program
PA = 70.0


def test_printed_segments_of_the_velocity_plans(press):
    vel, scale = press.study.velocities, truth.OMEGA * truth.R / PA
    for k, row in table():
        a, b, s2 = (complex(vel.points[name].value[k % 12]) / scale for name in ("A", "B", "S2"))
        assert abs(b) == pytest.approx(float(row["pb_mm"]), abs=READ)
        assert abs(s2) == pytest.approx(float(row["ps2_mm"]), abs=READ)
        assert abs(a - b) == pytest.approx(float(row["ab_mm"]), abs=READ)
        if "angle_G2_deg" not in row["errata"].split():
            angle = degrees(acos(-s2.imag / abs(s2)))
            assert angle == pytest.approx(float(row["angle_G2_deg"]), abs=0.5)


def test_angles_of_two_positions_are_interchanged(press):
    vel = press.study.velocities
    rows = dict(table())
    for k, other in ((6, 12), (12, 6)):
        down = -complex(vel.points["S2"].value[k % 12]).imag
        assert np.sign(down) == np.sign(cos(radians(float(rows[other]["angle_G2_deg"]))))


def test_printed_forces_and_moments(press):
    """The way was read to a quarter of a millimetre at 0.0034 m/mm: 142 N; the segment as above."""
    force = press.applied[0]
    for k, row in table():
        value, moment = float(row["F_N"]), float(row["M_F_N_m"])
        assert float(force.magnitude(press.reduced.phi[k], -1)) == pytest.approx(value, abs=READ * 0.0034 / 0.24 * 40000)
        ours = truth.moment(press.reduced.phi[k]) - truth.M2 * truth.G * truth.R / 2 * np.cos(press.reduced.phi[k])
        assert ours == pytest.approx(moment, abs=142 * 0.12 * float(row["pb_mm"]) / PA + value * 0.12 * READ / PA + 1e-9)


def test_moment_of_the_weight_is_printed_times_the_crank(press):
    """Errata of table 1.5: multiplied by l_OA twice; the sign of 6 and 12; angles of 4, 5, 7, 8 read a degree off."""
    for k, row in table():
        read = 96 * float(row["ps2_mm"]) / PA * cos(radians(float(row["angle_G2_deg"])))
        assert float(row["M_G2_N_m"]) / 0.12 == pytest.approx(read, rel=3e-4, abs=0.1)
        ours = truth.M2 * truth.G * truth.R / 2 * np.cos(press.reduced.phi[k])
        if "angle_G2_deg" not in row["errata"].split():
            assert read == pytest.approx(ours, abs=96 * READ / PA + 96 * radians(0.5))
        elif k not in (6, 12):
            assert read == pytest.approx(ours, abs=96 * READ / PA + 96 * radians(1.2))


def test_printed_moments_of_inertia(press):
    """Terms of the masses as printed; that of the rod's turning has the cube of ab/pa instead of its square: an erratum."""
    parts = press.reduced.parts(Reduction(press.reduced, TRIED, press.reduced.phi))
    moving, turning, slider = parts.values()
    for k, row in table():
        assert moving[k] == pytest.approx(float(row["I2_transl_kg_m2"]), abs=2 * READ / PA * 1.17551)
        assert slider[k] == pytest.approx(float(row["I3_kg_m2"]), abs=2 * READ / PA * 0.440816)
        ab = float(row["ab_mm"])
        corrected = float(row["I2_rot_kg_m2"]) * (PA / ab if ab else 1)
        assert turning[k] == pytest.approx(corrected, abs=2 * READ / PA * 0.1246)
        whole = float(row["I_II_kg_m2"]) - float(row["I2_rot_kg_m2"]) + corrected
        assert press.flywheel.J_reduced[k] == pytest.approx(whole, abs=2 * READ / PA * 1.74)
        assert float(row["T_II_J"]) == pytest.approx(float(row["I_II_kg_m2"]) * truth.OMEGA**2 / 2, rel=1e-4)


def test_printed_scalars(fw):
    p = printed()
    assert fw.reduced.omega1 == pytest.approx(p["w1"][0], abs=2 * p["w1"][1])
    assert fw.reduced.omega1 * 0.12 == pytest.approx(p["VA"][0], abs=2 * p["VA"][1])
    assert fw.J_reduced.max() == pytest.approx(p["I2max"][0], rel=1e-9)
    mu_m = 3242.983 / p["ymax"][0]
    assert mu_m * p["mu_phi"][0] * p["Hp"][0] == pytest.approx(p["mu_A"][0], abs=2 * p["mu_A"][1])
    assert 2 * pi / 180 == pytest.approx(p["mu_phi"][0], abs=p["mu_phi"][1])
    assert fw.data.delta == p["delta"][0]
    assert fw.data.motor.power == 1000 * p["motor_P"][0]


def test_segment_of_the_manual_belongs_to_a_constant_force(fw):
    """Errata: the printed ab = 47.11 mm is that of 20 kN all along the way, not of the linear law of table 1.4."""
    p = printed()
    constant = changed({"force[1].table": None, "force[1].value": "20 kN"}).flywheel

    def segment(f):
        return f.J_first_converged * 0.04 * truth.OMEGA**2 / p["mu_A"][0]

    assert segment(constant) == pytest.approx(47.11, abs=0.25)
    assert segment(fw) == pytest.approx(51.49, abs=0.05)


def test_condition_of_the_motor(fw):
    """The printed 0.352941 is 2 (2000 - 1700)/1700; 0.352941 <= 0.04 is false: the motor stays a motor."""
    p = printed()
    manual = motor_check(1200.0, 10.0, 1.0, 2000.0, 1700.0, 15000.0, 0.04)
    assert manual.permitted == pytest.approx(p["delta_perm"][0], abs=p["delta_perm"][1])
    assert manual.steady
    ours = fw.motor
    assert ours.permitted == pytest.approx(2 * 25 / 975, rel=1e-12)
    assert ours.power == pytest.approx(fw.M_constant * truth.OMEGA / 0.85, rel=1e-14)
    assert ours.strong
    assert ours.steady
    weak = motor_check(1600.0, 10.0, 1.0, 1015.0, 1000.0, 15000.0, 0.04)
    assert (weak.power, weak.permitted) == (16000.0, 0.03)
    assert not weak.strong
    assert not weak.steady


def test_printed_gear_pair(press):
    """Radii as printed; those that follow from alpha_w = 27.2 instead of 27.1931 within what that rounding does."""
    p, g = printed(), told(press.gear)
    for name, key in (("rb1", "rb1"), ("rb2", "rb2"), ("rf1", "rf1"), ("rf2", "rf2"), ("p", "p")):
        assert g[name] == pytest.approx(p[f"ge.{key}"][0], abs=2 * p[f"ge.{key}"][1])
    with (MANUALS / "press_scalars.csv").open(encoding="utf-8") as f:
        rounded = {row["id"].removeprefix("pr.ge."): float(row["value"]) for row in csv.DictReader(f) if "a_w" in row["errata"]}
    a_w = 150 * cos(radians(20)) / cos(radians(27.2))
    assert a_w == pytest.approx(158.479, abs=0.001)
    for name in ("rw1", "rw2", "ra1", "ra2"):
        assert g[name] == pytest.approx(rounded[name], abs=a_w - g["a_w"] + 0.001)
    assert g["eps_alpha"] == pytest.approx(1.147, abs=0.0005)


def test_rocker_cam(press):
    """Apex of the allowed zone by an independent solver: r0 = 79.2 mm, centre distance 137.0 mm."""
    c = told(press.cam)
    assert 1000 * c["r0"] == pytest.approx(79.2, abs=0.05)
    assert 1000 * c["l0"] == pytest.approx(137.0, abs=0.05)
