"""Machines whose crank is heavy enough: the segment ab has a sign, and nowhere is a wheel that nobody needs.

What is needed in all does not depend on how much of it the crank has already, so the flywheel's moment of inertia falls by what the
crank gains, through zero and on. Whether one is needed is decided by the running without it: dense sums of the closed
forms of the shaper, and of the reduced moment and inertia of the press.
"""

import json
import re
from math import pi

import numpy as np
import pytest

from tests import project_files as files
from tests.few import few, seldom
from tests.methods.linkage import shaper_truth
from tmm_sheets import catalogue, protocols, results
from tmm_sheets.__main__ import run
from tmm_sheets.construction.protocol import sentences
from tmm_sheets.drawing.marks import Arc, Line, Polyline, Text, flat
from tmm_sheets.methods.flywheel.diagram_scales import lettered
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import arrangement

SHEET = {"lugansk/shaper": 2, "press": 1}
BOTH = pytest.mark.parametrize("name", SHEET)
ONE = pytest.mark.parametrize("name", few(SHEET, "lugansk/shaper"))


def with_crank(name, inertia):
    """The project with a moment of inertia of the crank, kg m2, as parts."""
    machine = files.from_file(name)
    return machine, {"link[1]": {"centre": machine["crank"]["pivot"], "inertia": f"{inertia!r} kg m2"}}


def project(name, inertia):
    return files.project(*with_crank(name, inertia))


def running(name, p, first):
    """Non-uniformity with ``first`` kg m2 on the crank: E = E0 + work, the level E0 such that the extremes have the mean omega."""
    phi = np.linspace(0, 2 * pi, 40001)
    r, omega = p.reduced, p.reduced.omega1
    if name == "lugansk/shaper":
        begin = p.cycle.strokes.begin
        truth = shaper_truth.Shaper(breaks=(begin, p.cycle.strokes.end))
        moment, inertia = truth.moment(phi), truth.inertia(phi)
    else:
        moment, inertia = r.moment(phi, side=1), r.inertia(phi) - r.crank_inertia
    work = np.concatenate(([0], np.cumsum((moment[1:] + moment[:-1]) / 2 * np.diff(phi))))
    excess = work - work[-1] * phi / (2 * pi)
    low, high = 0.0, 10 * (first + inertia.max()) * omega**2 - excess.min()
    for _ in range(100):
        middle = (low + high) / 2
        speed = np.sqrt(np.maximum(2 * (middle + excess) / (first + inertia), 0))
        low, high = (middle, high) if speed.max() + speed.min() < 2 * omega else (low, middle)
    return np.ptp(speed) / omega


@ONE
def test_the_flywheel_falls_by_what_the_crank_gains(name):
    bare = project(name, 0.0).flywheel
    for inertia in (100.0, 290.0, 300.0, 310.0, 320.0, 600.0, 2000.0):
        f = project(name, inertia).flywheel
        assert f.J_flywheel == pytest.approx(bare.J_flywheel - inertia, abs=1e-8)
        assert f.J_flywheel_converged == pytest.approx(bare.J_flywheel_converged - inertia, abs=1e-8)
        assert f.needed == (inertia < bare.J_flywheel)
        assert f.J_running == pytest.approx(max(inertia, bare.J_first), rel=1e-9)


@ONE
@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("step", [1e-6, seldom(0.1), seldom(20.0)])
def test_just_above_and_below_zero(name, side, step):
    """By the drawn construction, and in the limit: each with the sign of what is missing there, and said where they differ."""
    bare = project(name, 0.0).flywheel
    for goal in (bare.J_flywheel, bare.J_flywheel_converged):
        f = project(name, goal + side * step).flywheel
        drawn, limit = (j - goal - side * step for j in (bare.J_flywheel, bare.J_flywheel_converged))
        assert f.J_flywheel == pytest.approx(drawn, abs=2e-8)
        assert f.J_flywheel_converged == pytest.approx(limit, abs=2e-8)
        assert f.needed == (drawn > 0)
        assert (f.wheel is None) == (drawn < 0)
        assert ("construction" in "".join(f.remarks)) == (drawn * limit < 0)
        assert bool(f.remarks) == (drawn < 0 or limit < 0)


def test_needed_in_the_limit_means_too_uneven_without():
    """Wittenbauer's limit is exact: with what it calls just enough the machine runs with delta."""
    bare = project("lugansk/shaper", 0.0)
    just = bare.flywheel.J_first_converged
    assert running("lugansk/shaper", bare, just) == pytest.approx(0.025, rel=1e-6)
    for inertia in (just - 2, just + 2, 600.0):
        p = project("lugansk/shaper", inertia)
        delta = running("lugansk/shaper", p, inertia)
        assert (delta > 0.025) == (p.flywheel.J_flywheel_converged > 0)
        assert p.flywheel.running(inertia).delta == pytest.approx(delta, rel=1e-6)


@BOTH
def test_the_sheet_says_it_in_words_and_draws_no_wheel(name):
    p = project(name, 600.0)
    p.check()
    sheet = composed(p, SHEET[name])
    assert sheet.crowded == ()
    words = [m.text.replace(" ", "").replace("\u00a0", "") for m in sheet.drawing.marks if isinstance(m, Text)]
    assert "Маховикнетребуется" in words
    assert not any(w.startswith(("D=", "B=", "H=1")) or "Эскизмаховика" in w or "πρκ" in w for w in words)
    delta = running(name, p, 600.0)
    said = next(w for w in words if w.startswith("Безмаховика"))
    assert float(said.split("=")[1].split("≤")[0].replace(",", ".")) == pytest.approx(delta, rel=1e-3)
    # Its view has nothing but words; what room it leaves is for others.
    box = next(v.box for v in arrangement(p.sheets[SHEET[name] - 1]).views if v.draw == "flywheel.wheel")
    assert not any(box.contains(z) for m in sheet.drawing.marks if m.of == "flywheel.wheel" and isinstance(m, Arc | Line | Polyline)
                   for z in flat(m))
    # The rest is still there.
    assert any("|ab|" in w or "ab=" in w for w in words)


@ONE
def test_results_check_protocol_and_compare(name, tmp_path, capsys):
    file = files.write(tmp_path, *with_crank(name, 600.0))
    assert run(["solve", file, "--json", "-", "--part", "flywheel"]) == 0
    found = json.loads(capsys.readouterr().out)["flywheel"]
    assert found["needed"] is False
    assert found["J_flywheel"] < 0
    assert found["J_flywheel_converged"] < 0
    assert (found["ab_mm"] < 0) == (name == "lugansk/shaper")
    assert [found[key] for key in ("form", "D", "B", "H", "m", "v")] == [None] * 6
    assert run(["solve", file, "--part", "flywheel"]) == 0
    assert "needed = False" in capsys.readouterr().out
    assert run(["check", file]) == 0
    assert "no flywheel is needed: 600 kg m2 turn with the crank" in capsys.readouterr().err
    assert run(["protocol", file]) == 0
    assert "|ab|" not in capsys.readouterr().err
    assert run(["compare", file, "--template", "-o", str(tmp_path)]) == 0
    capsys.readouterr()
    assert "J_flywheel" in (tmp_path / "measured.csv").read_text(encoding="utf-8")


def test_nothing_is_said_where_a_flywheel_is_needed(capsys):
    assert run(["check", "lugansk/shaper"]) == 0
    assert "flywheel" not in capsys.readouterr().err
    tree = results.assemble(Project(catalogue.read("lugansk/shaper")), ["flywheel"])
    assert tree["flywheel"]["needed"] is True
    assert tree["flywheel"]["D"] > 1


def test_the_segment_is_said_with_its_sign():
    f = project("lugansk/shaper", 600.0).flywheel
    assert list(sentences(f.energy_mass_plan, 0, float))[-1].endswith("ab = −2,7 мм.")
    f = project("lugansk/shaper", 0.0).flywheel
    assert list(sentences(f.energy_mass_plan, 0, float))[-1].endswith("ab = 113,1 мм.")


# --- many points of a diagram ----------------------------------------------------------------------------------------


def digitised(points):
    """The shaper with a force given point by point over the angle."""
    table = [[f"{a!r} deg", f"{1500 + 1300 * np.sin(np.radians(a)):.1f} N"] for a in np.linspace(0, 360, points).tolist()]
    force = {"name": "F5", "link": "5", "point": "S5", "direction": "180 deg", "over": "angle", "table": table}
    return files.project(files.from_file("lugansk/shaper"), {"force": None}, {"force": [force], "cycle.division": "nominal"})


def test_letters_of_points_between_two_numbers():
    assert [lettered(n) for n in (0, 1, 8, 9, 26, 27, 52, 53, 702, 703)] == ["", "a", "h", "i", "z", "aa", "az", "ba", "zz", "aaa"]
    assert len({lettered(n) for n in range(20000)}) == 20000


@pytest.mark.parametrize("points", [seldom(41), 101, seldom(721)])
def test_any_number_of_diagram_points(points):
    p = digitised(points)
    f = p.flywheel
    assert len(f.edges) >= points - 1
    for names in (f.borders, f.intervals):
        assert len(set(names)) == len(names)
    # The work of the force by the trapezoidal rule on a fine grid of the ram's own motion.
    turned = np.linspace(0, 2 * pi, 100001)
    study = p.study_at(turned, ("",) * len(turned))
    x = study.positions.points["S5"].value.real
    given = np.linspace(0, 2 * pi, points)
    force = np.interp(turned, given, 1500 + 1300 * np.sin(given))
    work = -np.sum((force[1:] + force[:-1]) / 2 * np.diff(x))
    assert f.work_converged[-1] == pytest.approx(work, rel=1e-4)
    assert f.J_flywheel == pytest.approx(f.J_flywheel_converged, rel=2e-2)
    sheet = composed(p, 2)
    assert sheet.crowded == ()
    assert any("показаны" in m.text for m in sheet.drawing.marks if isinstance(m, Text)) == (points > 50)
    assert next(protocols.lines(p, "work"))


# --- drawn and exact work --------------------------------------------------------------------------------------------


def test_the_work_by_mid_ordinates_stands_beside_the_area():
    """The shaper's force is constant over the stroke: its work is force times stroke, which the chords miss by 1.6 %."""
    p = files.project(files.from_file("lugansk/shaper"), {"cycle.division": "nominal"})  # divided as the manual does
    tree = results.assemble(p, ["flywheel"])["flywheel"]
    exact = -2800 * 2 * 0.566 * 0.08 / 0.26
    assert tree["work_converged"][-1] == pytest.approx(exact, rel=1e-9)
    assert tree["M_constant_converged"] == pytest.approx(-exact / (2 * pi), rel=1e-9)
    assert tree["work"][-1] == pytest.approx(-991.14, abs=0.01)  # the manual's method as it was
    words = " ".join(m.text for m in composed(p, 2).drawing.marks if isinstance(m, Text))
    assert re.search(r"−991,1 Дж\s+по\s+ординатам\s+середин", words)
    assert re.search(r"−975,3\s+Дж\s+\(\+1,63\s+%\)", words)
    said = list(sentences(p.flywheel.work_plan, 0, float))[-2:]
    assert "−97,5" in said[0]
    assert "−1,6" in said[1]


def test_the_work_of_the_press_is_half_of_force_times_stroke():
    f = Project(catalogue.read("press")).flywheel
    assert f.work_converged[-1] == pytest.approx(-4800, rel=1e-9)
    assert f.work[-1] == pytest.approx(-4866, abs=0.5)
