"""A crank that only swings: positions over its swing, and where it ends. Truth: the law of cosines, mpmath."""

from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

from tmm_sheets import summary
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.task import variant

VISOR = Path(__file__).parents[2] / "projects" / "visor.toml"
TEXT = VISOR.read_text(encoding="utf-8")
D = 0.2 + 0.02j


def opened(tmp_path, *changes):
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "visor.toml"
    path.write_text(text, encoding="utf-8")
    return Project(variant.read(path))


@pytest.fixture(scope="module")
def visor():
    return Project(variant.read(VISOR))


def test_positions_divide_the_swing(visor):
    assert visor.cycle.labels == tuple("0123456")
    assert np.degrees(visor.study.positions.phi) == pytest.approx([50, 60, 70, 80, 90, 100, 110], rel=1e-14)


def meet(p, r, q, s, side):
    """Third corner of a triangle on p q by the law of cosines, left of it for side 1."""
    d = abs(q - p)
    return p + (q - p) / d * r * mp.expjpi(side * mp.acos((d * d + r * r - s * s) / (2 * d * r)) / mp.pi)


def watt(phi):
    """Hinge G of the second dyad."""
    b, d = mp.mpf("0.12") * mp.expjpi(phi / mp.pi), mp.mpc("0.2", "0.02")
    c = meet(b, mp.mpf("0.15"), d, mp.mpf("0.11"), 1)
    e = b + mp.mpf("0.09") * (c - b) / abs(c - b) * mp.expjpi(mp.mpf(50) / 180)
    f = d + mp.mpf("0.17") * (c - d) / abs(c - d)
    return meet(e, mp.mpf("0.11"), f, mp.mpf("0.09"), 1)


def test_motion_is_the_exact_one(visor):
    study, w = visor.study, visor.mechanism.crank.omega
    with mp.workdps(30):
        for k in (0, 3, 5):
            phi = mp.mpf(float(study.positions.phi[k]))
            z, v, a = (complex(mp.diff(watt, phi, n)) * w**n for n in range(3))
            assert abs(study.positions.points["G"].at(k) - z) < 1e-14
            assert abs(study.velocities.points["G"].at(k) - v) < 1e-12
            assert abs(study.accelerations.points["G"].at(k) - a) < 1e-11


def test_where_the_swing_ends_and_why(visor):
    """Coupler and rocker in line: |BD| = 0.26 m, on both sides of the line A D."""
    limits = visor.swing_limits
    ahead = np.degrees(np.arccos((0.12**2 + abs(D) ** 2 - 0.26**2) / (2 * 0.12 * abs(D))))
    middle = np.degrees(np.angle(D))
    assert limits.angles == pytest.approx((middle - ahead, middle + ahead), abs=1e-9)
    assert limits.groups == ("2-3", "2-3")
    lack = abs(D - 0.12 * np.exp(1j * np.radians(middle + ahead + 1))) - 0.26
    said = list(summary.swing(visor))
    assert len(said) == 2
    assert f"the crank can swing to {middle + ahead:.2f} deg; 1 deg beyond it group 2-3 does not assemble" in said[1]
    assert f"{1000 * lack:.3f} mm too short" in said[1]


def test_a_swing_beyond_its_end_is_refused(tmp_path):
    lack = abs(D - 0.12 * np.exp(1j * np.radians(120))) - 0.26
    with pytest.raises(CannotBuild, match=rf"group 2-3 does not assemble at position 6: .* {1000 * lack:.2f} mm too short"):
        opened(tmp_path, ('end = "110 deg"', 'end = "120 deg"')).check()


def test_a_swing_against_the_clock(tmp_path):
    project = opened(tmp_path, ('start = "50 deg"', 'start = "20 deg"'), ('end = "110 deg"', 'end = "-60 deg"'),
                     ('sense = "counter-clockwise"', 'sense = "clockwise"'))
    assert np.degrees(project.study.positions.phi)[[0, -1]] == pytest.approx([20, -60])
    assert project.swing_limits.angles[0] > 110 > -99 > project.swing_limits.angles[1]


def test_stephenson_within_its_limits(tmp_path):
    """The second dyad between a coupler point and the frame (Stephenson III)."""
    project = opened(tmp_path, ('outer = ["E", "F"]', 'outer = ["E", "H"]'), ('D = ["200 mm", "20 mm"]',
                     'D = ["200 mm", "20 mm"]\nH = ["60 mm", "330 mm"]'), ('"110 mm", "90 mm"', '"110 mm", "120 mm"'))
    with mp.workdps(30):
        phi = mp.mpf(float(project.study.positions.phi[2]))
        b = mp.mpf("0.12") * mp.expjpi(phi / mp.pi)
        c = meet(b, mp.mpf("0.15"), mp.mpc("0.2", "0.02"), mp.mpf("0.11"), 1)
        e = b + mp.mpf("0.09") * (c - b) / abs(c - b) * mp.expjpi(mp.mpf(50) / 180)
        g = complex(meet(e, mp.mpf("0.11"), mp.mpc("0.06", "0.33"), mp.mpf("0.12"), 1))
    assert abs(project.study.positions.points["G"].at(2) - g) < 1e-14


def test_tables_over_the_angle_do_not_repeat(tmp_path):
    project = opened(tmp_path, ("value = \"15 N\"", 'over = "angle"\ntable = [["0 deg", "10 N"], ["30 deg", "40 N"]]'))
    assert project.study.loads[2]["Fв"].value == pytest.approx([-10, -20, -30, -40, -40, -40, -40])


@pytest.mark.parametrize(("old", "new", "error", "said"), [
    ('direction = "180 deg"', 'direction = "against motion"', CannotBuild, "Fв: the crank only swings, there are no strokes"),
    ('end = "110 deg"', 'end = "50 deg"', CannotBuild, "swings from one angle to the same"),
    ("positions = 6", 'positions = 6\noutput = "G"\nworking_sense = "+y"', BadInput, "leave output, working_sense and turns out"),
    ("positions = 6", 'positions = 6\nextra = { "a" = "70 deg" }', CannotBuild, "position a lies outside of the swing of 60 deg"),
])
def test_refusals(tmp_path, old, new, error, said):
    with pytest.raises(error, match=said):
        _ = opened(tmp_path, (old, new)).study.loads


def test_no_flywheel(tmp_path):
    project = opened(tmp_path, ("[balancing]", '[flywheel]\nmethod = "wittenbauer"\ndelta = 0.04\nform = "disc"\ndensity = '
                                               '"7300 kg/m3"\nwidth_ratio = 0.15\nthickness_ratio = 0.1\n\n[balancing]'))
    with pytest.raises(CannotBuild, match="only swings has no flywheel"):
        _ = project.flywheel
