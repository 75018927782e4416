"""A cylinder and a slider as input: the law of cosines, and the power of all forces, are the truth."""

import json
from pathlib import Path

import numpy as np
import pytest

from tmm_sheets import results
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.result_files import json_pieces
from tmm_sheets.task.variant import parse

ROOT = Path(__file__).parents[3]
BOOM = (ROOT / "tests" / "projects" / "boom.toml").read_text(encoding="utf-8")
PUSHED = """
schema = 1
[project]
name = "pushed"
title = "Slider that drives a crank"
[crank]
link = "1"
pivot = "A"
pin = "B"
length = "100 mm"
[input]
link = "3"
start = "260 mm"
end = "340 mm"
speed = "0.4 m/s"
acceleration = "1 m/s2"
[points]
A = ["0 mm", "0 mm"]
O = ["-10 mm", "20 mm"]
[[guide]]
name = "x"
through = "O"
[[group]]
kind = 2
links = ["2", "3"]
outer = ["B"]
inner = "C"
length = "250 mm"
guide = "x"
[[point]]
name = "S2"
link = "2"
from = "B"
towards = "C"
distance = "100 mm"
[[link]]
name = "2"
mass = "2 kg"
centre = "S2"
inertia = "0.02 kg m2"
[[link]]
name = "3"
mass = "4 kg"
centre = "C"
[[moment]]
name = "M1"
link = "1"
direction = "clockwise"
value = "50 N m"
[cycle]
start = "input"
positions = 8
"""
G = 9.81


def opened(text, *swaps):
    for old, new in swaps:
        assert old in text
        text = text.replace(old, new)
    return Project(parse(text, "own.toml"))


def rates(f, s, v, a):
    """Value, first and second derivative in time of ``f`` of the place s that moves with v and a, by central differences."""
    h = 2e-3 * np.max(np.abs(s))
    k = np.arange(-4, 5)
    y = np.array([f(s + n * h) for n in k])
    fit = np.linalg.solve(np.vander(k * 1.0, increasing=True), y)
    first, second = fit[1] / h, 2 * fit[2] / h**2
    return y[4], first * v, second * v * v + first * a


def boom_angle(s, side=1.0):
    """Angle of the boom by the law of cosines in the triangle A, C, D."""
    pivot, length = 0.5 - 0.6j, 1.2
    apart = abs(pivot)
    return np.angle(pivot) + side * np.arccos((apart**2 + length**2 - s * s) / (2 * apart * length))


def pushed_angle(s):
    """Angle of the crank under the line from its pivot to the slider's hinge."""
    c = s - 0.01 + 0.02j
    return np.angle(c) - np.arccos((abs(c) ** 2 + 0.1**2 - 0.25**2) / (2 * abs(c) * 0.1))


@pytest.mark.parametrize("swaps", [
    (), (('"1.05 m"', '"1.65 m"'), ('end = "1.65 m"', 'end = "1.1 m"')), (("speed", 'acceleration = "-0.02 m/s2"\nspeed'),)],
    ids=["extends", "retracts", "slows down"])  # fmt: skip
def test_boom_moves_by_the_law_of_cosines(swaps):
    project = opened(BOOM, *swaps)
    drive, study = project.mechanism.drive, project.study
    s = np.linspace(*drive.place, 7)
    angle, omega, epsilon = rates(boom_angle, s, drive.sense * drive.speed, drive.sense * drive.acceleration)
    assert study.positions.phi == pytest.approx(angle, rel=1e-14)
    assert study.velocities.omega["1"].value == pytest.approx(omega, rel=1e-9)
    assert study.accelerations.epsilon["1"].value == pytest.approx(epsilon, rel=1e-6, abs=1e-9)
    c = 1.2 * np.exp(1j * angle)
    assert study.positions.points["C"].value == pytest.approx(c, rel=1e-14)
    assert np.sign(omega) == pytest.approx(project.mechanism.crank.sense)
    body = rates(lambda s: np.angle(1.2 * np.exp(1j * boom_angle(s)) - (0.5 - 0.6j)), s, drive.sense * drive.speed,
                 drive.sense * drive.acceleration)
    assert study.velocities.omega["3"].value == pytest.approx(body[1], rel=1e-9)
    assert study.accelerations.epsilon["3"].value == pytest.approx(body[2], rel=1e-6, abs=1e-8)


def test_crank_behind_a_slider_moves_by_the_law_of_cosines():
    project = opened(PUSHED)
    study, s = project.study, np.linspace(0.26, 0.34, 9)
    angle, omega, epsilon = rates(pushed_angle, s, 0.4, 1.0)
    assert study.positions.phi == pytest.approx(angle, rel=1e-13)
    assert study.velocities.omega["1"].value == pytest.approx(omega, rel=1e-7)
    assert study.accelerations.epsilon["1"].value == pytest.approx(epsilon, rel=1e-4)
    assert study.positions.points["C"].value == pytest.approx(s - 0.01 + 0.02j, rel=1e-14)


def test_force_of_the_cylinder_by_power():
    """F·v is the growth of kinetic energy and of height, less the power of the load: nothing of plans or levers in it."""
    project = opened(BOOM)
    s, v = np.linspace(1.05, 1.65, 7), 0.1

    def height_and_energy(s):
        angle = boom_angle(s)
        c, low = 1.2 * np.exp(1j * angle), 0.5 - 0.6j
        e, s1 = (r * np.exp(1j * (angle - np.radians(5))) for r in (2.0, 0.9))
        s3 = low + 0.5 * (c - low) / abs(c - low)
        return (120 * s1.imag + 6 * c.imag + 15 * s3.imag) * G + 2500 * e.imag

    def speeds(s):
        angle, low = boom_angle, 0.5 - 0.6j
        w1 = rates(angle, s, v, 0.0)[1]
        w3 = rates(lambda x: np.angle(1.2 * np.exp(1j * angle(x)) - low), s, v, 0.0)[1]
        return 0.5 * ((40 + 120 * 0.9**2 + 6 * 1.2**2) * w1**2 + (0.8 + 15 * 0.5**2) * w3**2)

    power = rates(height_and_energy, s, v, 0.0)[1] + rates(speeds, s, v, 0.0)[1]
    study = project.study
    assert study.lever.balancing.value == pytest.approx(power / v, rel=1e-8)
    assert study.balance["along"].value == pytest.approx(power / v, rel=1e-8)
    assert np.max(study.balance["Δ"].value) < 1e-10


def test_force_on_the_slider_by_power():
    project = opened(PUSHED)
    s, v, a = np.linspace(0.26, 0.34, 9), 0.4, 1.0

    def centre(x):
        b, c = 0.1 * np.exp(1j * pushed_angle(x)), x - 0.01 + 0.02j
        return b + 0.4 * (c - b)

    def rod(x):
        return np.angle(x - 0.01 + 0.02j - 0.1 * np.exp(1j * pushed_angle(x)))

    _, v2, a2 = rates(centre, s, v, a)
    _, w2, e2 = rates(rod, s, v, a)
    w1 = rates(pushed_angle, s, v, a)[1]
    power = 2 * (a2 * v2.conj()).real + 0.02 * e2 * w2 + 4 * a * v + 2 * G * v2.imag + 50 * w1
    study = project.study
    assert study.balance["along"].value == pytest.approx(power / v, rel=1e-4)
    assert study.lever.balancing.value == pytest.approx(study.balance["along"].value, rel=1e-12)
    # All forces on the slider: its weight, inertia and what drives it stand against rod and guide.
    reactions = study.forces.reactions
    total = reactions["F32"].value + reactions["F30"].value - 4 * (a + 1j * G) + study.balance["along"].value
    assert np.max(np.abs(total)) < 1e-9


def test_solve_tells_the_input():
    told = json.loads("".join(json_pieces(results.assemble(opened(BOOM), None, positions=4))))
    assert told["cycle"]["input"] == pytest.approx([1.05, 1.25, 1.45, 1.65], rel=1e-14)
    assert told["cycle"]["phi"] == pytest.approx(boom_angle(np.array([1.05, 1.25, 1.45, 1.65])))
    assert told["forces"]["balancing"]["kind"] == "force"


@pytest.mark.parametrize(("swap", "field"), [
    (('link = "3"\nstart', 'link = "1"\nstart'), "input.link"),
    (('end = "1.65 m"', 'end = "1.05 m"'), "input.end"),
    (('length = "1.2 m"', 'length = "1.2 m"\nspeed = "10 rpm"'), "crank.speed"),
    (('start = "input"', 'start = "10 deg"'), "cycle"),
    (('start = "input"', 'start = "input"\noutput = "E"\nworking_sense = "+y"'), "cycle"),
    (('kind = "input force"', 'kind = "moment"'), "balancing.kind"),
    (('outer = ["C", "D"]', 'outer = ["C", "D"]\noffset = "10 mm"'), "input.link"),
    (('[balancing]', '[friction]\nsliding = 0.1\n\n[balancing]'), "friction"),
    (('speed = "0.1 m/s"', 'speed = "0 m/s"'), "input.speed"),
])  # fmt: skip
def test_what_no_input_can_be_is_named(swap, field):
    with pytest.raises(BadInput) as refused:
        opened(BOOM, swap)
    assert [p.field for p in refused.value.problems] == [field]


def test_without_an_input_a_crank_needs_its_turning():
    begin, end = BOOM.index("[input]"), BOOM.index("[points]")
    with pytest.raises(BadInput) as refused:
        parse(BOOM[:begin] + BOOM[end:].replace('kind = "input force"', 'kind = "moment"'), "own.toml")
    assert {p.field for p in refused.value.problems} == {"crank.speed", "crank.sense", "cycle.start"}


@pytest.mark.parametrize(("text", "swap", "said"), [
    (BOOM, ('"1.65 m"', '"2 m"'), "from 419 mm to 1981 mm"),
    (PUSHED, ('"340 mm"', '"370 mm"'), "to 359.4 mm"),
    (PUSHED, ("[input]", "[input]\nside = -1"), None),
    (PUSHED.replace('length = "100 mm"', 'length = "300 mm"').replace("260 mm", "60 mm"), ('"340 mm"', '"350 mm"'), "square"),
    (PUSHED, ('guide = "x"', 'guide = "x"\nside = -1'), "put together the other way")])  # fmt: skip
def test_how_far_an_input_can_go(text, swap, said):
    project = opened(text, swap)
    if said is None:
        assert np.all(project.study.positions.points["B"].value.imag > 0)
        return
    with pytest.raises(CannotBuild, match=said):
        _ = project.cycle
