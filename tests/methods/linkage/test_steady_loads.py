"""Loads that ask nothing of the motion: constants of fixed direction, moments of changing sign in one table.

Truth: the power of all forces from velocities and accelerations of a four-bar in closed form, its loads as the file has them.
"""

from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

from tests import project_files
from tmm_sheets.project import Project
from tmm_sheets.task import variant

STIRRER = Path(__file__).parents[2] / "projects" / "stirrer.toml"


@pytest.fixture(scope="module")
def stirrer():
    return Project(variant.read(STIRRER))


def closed(phi):
    """B, C, S2 and S3 of the stirrer by the law of cosines, m."""
    b, d = mp.mpf("0.06") * mp.expjpi(phi / mp.pi), mp.mpc("0.195", "-0.04")
    r = d - b
    at_b = mp.acos((abs(r) ** 2 + mp.mpf("0.19") ** 2 - mp.mpf("0.14") ** 2) / (2 * abs(r) * mp.mpf("0.19")))
    u = r / abs(r) * mp.expjpi(at_b / mp.pi)
    c = b + mp.mpf("0.19") * u
    return b, c, b + mp.mpf("0.095") * u, d + mp.mpf("0.05") * (c - d) / mp.mpf("0.14")


def test_balancing_moment_makes_up_for_them(stirrer):
    study, w = stirrer.study, stirrer.mechanism.crank.omega
    table = ((0, 10.0), (90, -20.0), (200, 5.0), (360, 10.0))  # clockwise, closed: it begins again
    for k, turned in enumerate(study.turned):
        with mp.workdps(30):
            phi = mp.mpf(float(study.positions.phi[k]))

            def rates(i, phi=phi):
                return tuple(complex(mp.diff(lambda x: closed(x)[i], phi, n)) * w**n for n in (1, 2))

            v2, a2 = rates(2)
            v3, a3 = rates(3)
            turn = {name: tuple(complex(mp.diff(lambda x, i=i, j=j: mp.log(closed(x)[i] - (closed(x)[j] if j is not None else
                                                mp.mpc("0.195", "-0.04"))), phi, n)).imag * w**n for n in (1, 2))
                    for name, i, j in (("11", 1, 0), ("10", 1, None))}
        weight = 9.81j
        power = (-2 * (a2 + weight) * np.conj(v2) - 3 * (a3 + weight) * np.conj(v3)).real
        power -= 0.008 * turn["11"][0] * turn["11"][1] + 0.02 * turn["10"][0] * turn["10"][1]
        power += (40 * np.exp(-1j * np.pi / 6) * np.conj(v2)).real
        power -= 2 * w
        power -= np.interp(np.degrees(turned), *zip(*table, strict=True)) * turn["10"][0]
        assert study.forces.balancing.at(k) * w == pytest.approx(-power, rel=1e-9, abs=1e-9)
        assert study.lever.balancing.at(k) == pytest.approx(study.forces.balancing.at(k), rel=1e-9, abs=1e-9)


def test_constants_have_no_strokes_and_no_jumps(stirrer):
    rope, brake, both = stirrer.applied
    assert (rope.motion, rope.jumps, brake.motion, brake.jumps) == (None, (), None, ())
    assert both.changes_sign
    assert not rope.changes_sign
    # A graph shows both signs as they act, counter-clockwise positive.
    assert both.shown(np.array([0.0, np.pi / 2])) == pytest.approx([-10, 20])
    assert both.magnitude(np.array([0.0, np.pi / 2])) == pytest.approx([10, 20])


def test_a_constant_over_the_angle(tmp_path):
    """It was an internal error; it is the same all the time."""
    text = STIRRER.read_text(encoding="utf-8").replace('direction = "-30 deg"\n', 'direction = "-30 deg"\nover = "angle"\n')
    path = tmp_path / "rope.toml"
    path.write_text(text, encoding="utf-8")
    project = Project(variant.read(path))
    assert project.study.loads[2]["Fc"].value == pytest.approx(40 * np.exp(-1j * np.pi / 6))


@pytest.mark.parametrize(("direction", "sign"), [("clockwise", -1), ("counter-clockwise", 1), ("against motion", 1)])
def test_signs_of_a_moment_that_turns_over_in_graphs(direction, sign):
    """Of a fixed direction counter-clockwise is positive; against the motion it is as its table has it."""
    moment = {"name": "M3", "link": "3", "direction": direction, "sense": "clockwise", "stroke": "working",
              "table": [[0, "-10 N m"], [1, "30 N m"]]}
    swing = {"moment": [moment], "cycle": {"start": "0 deg", "positions": 12}}
    load, = project_files.project(project_files.FOUR_BAR, swing).applied
    run = next(r for r in load.motion.runs if r.working)
    turned = np.linspace(run.begin, run.end, 9)[1:-1]
    assert load.shown(turned) == pytest.approx(sign * (-10 + 40 * load.motion.fraction(turned)))
