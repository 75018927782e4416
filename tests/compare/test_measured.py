"""Drawings with a planted mistake: it is found where it was made, what follows is not accused, a good drawing is left alone."""

import csv
import json
import re
from dataclasses import replace
from html import unescape

import numpy as np
import pytest

from tests.compare.form import faults
from tests.compare.manual_tables import opened
from tests.compare.students import PENCIL, READING, Hand, Plant, opened as measurables_of
from tests.few import seldom
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.measured_file import FilledTable, MeasuredLine, read
from tmm_sheets.compare.measured.measured_lengths import NAME
from tmm_sheets.compare.measured.mistake_search import covariance
from tmm_sheets.construction.step import value_at
from tmm_sheets.project import Project

FEW = ("positions", "velocities", "accelerations", "force-5", "force-2", "lever")


@pytest.fixture(scope="module")
def shaper():
    return opened("lugansk/shaper")


@pytest.fixture(scope="module")
def some(shaper):
    """What is measured at position 2, and the velocities of its neighbours."""
    return {e.id: e for e in shaper.entries.values()
            if (e.plan in (*FEW, "results", "arms") and e.label == "2") or (e.plan == "velocities" and e.label in "134")}


def drawn(found, some, *plants, seed=1, sigma=0.3):
    hand = Hand(found, np.random.default_rng(seed), plants, sigma)
    return hand.filled(some)


def judged(found, filled):
    return judge(filled, found, PENCIL, READING)


def changed(filled, **numbers):
    """The file with some numbers written differently, by id with slashes as double underscores."""
    new = {name.replace("__", "/"): value for name, value in numbers.items()}
    filled.lines = [replace(line, value=new.get(line.entry.id, line.value)) for line in filled.lines]
    return filled


def starts(of):
    return [j for j in of if j.starts]


def test_per_cents_are_told_of_sizes_only(shaper, some):
    """Those of an angle depend on the axis it is counted from."""
    of = judged(shaper, drawn(shaper, some))
    told = {j.percent is None for j in of if j.entry.kind in ("angle", "sense")}
    assert told == {True}
    assert all(j.percent == 100 * j.deviation / abs(j.exact) for j in of if j.entry.kind == "length" and j.exact > 1e-9)


@pytest.mark.parametrize("seed", [1, seldom(2)])
def test_a_good_drawing(shaper, some, seed):
    of = judged(shaper, drawn(shaper, some, seed=seed, sigma=0.5))
    assert len(of) > 100
    assert not starts(of)
    assert sum(j.verdict == "amber" for j in of) < 0.12 * len(of)


def test_exact_numbers_are_green(shaper):
    """Everything on the sheets, lengths to half a millimetre, results to four digits; no id twice, all in ASCII."""
    def written(e):
        return float(f"{e.value:.4g}") if e.kind == "result" else round(2 * e.value) / 2

    lines = [MeasuredLine(e, written(e), 0.0, 1) for e in shaper.entries.values()]
    of = judged(shaper, FilledTable(lines))
    assert len(of) > 600
    assert {j.verdict for j in of} == {"green"}
    assert all(name.isascii() and name == e.id for name, e in shaper.entries.items())
    # Three points of the profile that lie nearly on a line: its least radius cannot be measured so.
    assert [j.entry.id for j in of if not np.isfinite(j.tolerance)] == ["cam-profile/rho_min"]


def test_pencil_and_reading(shaper, some):
    """Errors twice as large are twice as large tolerances where nothing is computed."""
    filled = drawn(shaper, some)
    one, two = judge(filled, shaper, PENCIL, READING), judge(filled, shaper, 2 * PENCIL, 2 * READING)
    plans = ("positions", "velocities")
    lengths = [(a, b) for a, b in zip(one, two, strict=True) if a.entry.kind == "length" and a.entry.plan in plans]
    assert len(lengths) > 20
    for a, b in lengths:
        assert b.tolerance == pytest.approx(2 * a.tolerance, rel=0.05), a.entry.id


@pytest.mark.parametrize(("plan", "step", "shift", "followers"), [
    seldom("velocities", "d", 3j, 1), ("velocities", "b3", -3, 12), seldom("positions", "D", 4j, 6),
    seldom("accelerations", "b3", 20, 3), ("force-5", "1", 4 + 3j, 1),
])
def test_a_misplaced_point(shaper, some, plan, step, shift, followers):
    """Its name, its displacement within a quarter, and at least so many numbers that follow from it."""
    of = judged(shaper, drawn(shaper, some, Plant(plan, "2", step, complex(shift))))
    begun = starts(of)
    assert len(begun) == 1
    mistake = begun[0].mistake
    assert mistake is not None
    assert mistake.step.name == step
    assert abs(complex(*mistake.moved) / mistake.mu) == pytest.approx(abs(shift), rel=0.25)
    assert sum(j.follows is begun[0] for j in of) >= followers
    assert all(j.entry.label == "2" for j in of if j.follows is not None)


def test_a_wrong_angular_velocity(shaper, some):
    """Half as large again: accelerations and inertia forces follow."""
    of = judged(shaper, drawn(shaper, some, Plant("velocities", "2", "ω3", times=1.5)))
    begun = starts(of)
    assert [j.entry.id for j in begun] == ["results/2/omega3"]
    assert {"accelerations/2/bk", "results/2/Fi5"} <= {j.entry.id for j in of if j.follows is begun[0]}


def test_a_wrong_scale_factor(shaper, some):
    """One mistake, not twenty, and the factor is told; stated in the file it is none."""
    filled = drawn(shaper, some)
    for i, line in enumerate(filled.lines):
        if line.entry.plan == "velocities" and line.entry.kind == "length":
            filled.lines[i] = replace(line, value=1.25 * line.value)
    begun = starts(judged(shaper, filled))
    assert len(begun) == 1
    assert float(re.search(r"([\d.]+) times", begun[0].wrong[0].said())[1]) == pytest.approx(1.25, abs=0.02)
    filled.factors["velocities"] = 0.016
    of = judged(shaper, filled)
    assert not [j for j in of if j.entry.plan == "velocities" and j.verdict == "red"]


def test_a_number_read_wrong(shaper, some):
    """What was drawn from the point is right: nothing follows, and a factor of ten is recognised."""
    of = judged(shaper, changed(drawn(shaper, some), positions__2__CB=1312.0))
    begun = starts(of)
    assert [j.entry.id for j in begun] == ["positions/2/CB"]
    assert begun[0].mistake is None
    assert begun[0].remark == "10 times the exact value"
    assert not [j for j in of if j.follows is not None]


def test_a_result_computed_wrong(shaper, some):
    """It does not follow from the student's own length, though a pencil could have made it."""
    filled = drawn(shaper, some)
    exact = shaper.entries["results/2/V_D"].value
    mine = next(line.value for line in filled.lines if line.entry.id == "velocities/2/pd") * 0.02
    of = judged(shaper, changed(filled, results__2__V_D=mine + 0.014 * (1 if mine > exact else -1)))
    found = next(j for j in of if j.entry.id == "results/2/V_D")
    assert found.verdict == "amber"
    assert "does not follow from your own |pd|" in found.remark


@pytest.mark.parametrize(("computed", "plotted", "said"), [(5.39, 215.5, "green"), (5.50, 220.0, "green"), (5.39, 218.6, "red"),
                                                         (5.50, 215.5, "red")])
def test_an_ordinate_is_plotted_as_it_was_computed(shaper, computed, plotted, said):
    """A pencil may make 7 mm of it in the velocity plan; from a number that is written down it makes none."""
    names = ("velocities/8/pd", "velocities/8/pb3", "results/8/J_red", "reduced-inertia/8/y_J")
    filled = Hand(shaper, np.random.default_rng(1), sigma=0.0).filled({name: shaper.entries[name] for name in names})
    changed(filled, **{"results__8__J_red": computed, "reduced-inertia__8__y_J": plotted})
    of = {j.entry.id: j for j in judged(shaper, filled)}
    ordinate = of["reduced-inertia/8/y_J"]
    assert ordinate.tolerance == pytest.approx(6.9, abs=0.1)
    assert of["results/8/J_red"].verdict == "green"
    assert ordinate.verdict == said
    assert ordinate.starts == (said == "red")
    assert ("does not follow from your own J_пр" in ordinate.remark) == (said == "red")


@pytest.mark.parametrize(("off", "said"), [(0.0, "green"), (1.8, "green"), (7.0, "red"), (-7.0, "red")])
def test_a_sum_is_plotted_from_its_parts(shaper, off, said):
    """y_dE is 10/4 of the sum of what was measured on the diagrams of work: half a millimetre of reading is 1.3 there, a pencil
    may be 2.3 mm off. The line of the driving work is straight from 0 at position 0 to y_K at position 10.
    """
    work, total = shaper.entries["work/y_A(5)"], shaper.entries["total-work/5/y_dE"]
    driving = shaper.entries["driving-moment/y_K"]
    own = {work.id: work.value - 0.7, driving.id: driving.value}
    own[total.id] = 10 / 4 * (own[work.id] + 0.5 * own[driving.id]) + off
    lines = [MeasuredLine(shaper.entries[name], value, 0.05, i) for i, (name, value) in enumerate(own.items())]
    found = {j.entry.id: j for j in judged(shaper, FilledTable(lines))}[total.id]
    assert found.tolerance == pytest.approx(2.25, abs=0.1)
    assert found.verdict == said
    assert found.starts == (said == "red")
    assert ("does not follow from your own y_A(5)" in found.remark) == (said == "red")


@pytest.mark.parametrize(("times", "said"), [(1.0, False), (1.02, True), (0.98, True)])
def test_a_reaction_from_own_arms(shaper, some, times, said):
    """F21 across the rocker is the sum of own forces times own arms over the own distance |CB|, worked out here by hand."""
    filled = drawn(shaper, some)
    own = {line.entry.id: line.value for line in filled.lines}
    mu = shaper.scales["positions"].mu
    # At position 2 all of them turn the rocker the same way about C.
    forces = {"F34": own["results/2/F43"], "G3": 55.52, "G2": 27.47, **{x: own[f"results/2/{x}"] for x in ("Fi2", "Fi3")}}
    arms = {force: own[f"arms/2/h_{force}(C)"] * shaper.mu(f"arms/2/h_{force}(C)") for force in forces}
    moment = sum(arms[force] * size for force, size in forces.items()) + own["results/2/Mi3"]
    value = moment / (own["positions/2/CB"] * mu)
    of = judged(shaper, changed(filled, results__2__F21t=float(f"{times * value:.4g}")))
    found = next(j for j in of if j.entry.id == "results/2/F21t")
    assert found.inconsistent == said


@pytest.mark.parametrize("off", [6, seldom(-6)])
def test_two_mistakes_in_one_plan(off):
    """Points a3 and b5 of a velocity plan both 6 mm too far out: what is drawn from a3 follows from a3, the rest from b5."""
    found = measurables_of("sixbar/6:3")
    plan = next(plan for plan, _ in found.plans if plan.name == "velocities")
    k = plan.labels.index("4")

    def outwards(tail, head):
        away = complex(value_at(plan[head], k) - value_at(plan[tail], k))
        return off * away / abs(away)

    some = {e.id: e for e in found.entries.values()
            if e.plan in ("positions", "velocities") or (e.label == "4" and e.title == "Velocities")}
    plants = (Plant("velocities", "4", "a3", outwards("p", "a3")), Plant("velocities", "4", "b5", outwards("b", "b5")))
    of = {j.entry.id: j for j in judged(found, drawn(found, some, *plants, sigma=0.5))}
    assert [j.entry.quantity for j in starts(of.values())] == ["|pa3|", "|bb5|"]
    assert [of[f"velocities/4/{name}"].follows.entry.quantity for name in ("pb", "ps3", "pb5")] == ["|pa3|"] * 3
    assert of["results/4/V_B5B"].follows.entry.quantity == "|bb5|"


def test_a_very_sensitive_number_tells_of_one_direction_only():
    """The inverse of 1 + n n' is 1 - n n'/(1 + n'n) (Sherman and Morrison): across n all stays as unknown as it was."""
    n = np.array([3e9, 4e9])
    truth = np.array([[16, -12], [-12, 9]]) / 25
    np.testing.assert_allclose(covariance(n[None, :], np.eye(2)), truth, atol=1e-6)


def test_a_module_is_no_mass(shaper):
    assert shaper.entries["results/m"].unit == "kg"
    assert shaper.entries["results/gear-m"].value == 3.5


def test_a_wrong_sign(shaper):
    name = "work/y_A(5)"
    filled = Hand(shaper, np.random.default_rng(1), sigma=0.0).filled({name: shaper.entries[name]})
    found = judged(shaper, changed(filled, **{"work__y_A(5)": 91.0}))[0]
    assert found.verdict == "red"
    assert found.remark == "the sign is wrong"


def test_own_scale_changes_the_tolerance(shaper):
    """A plan of half the size is off by the same millimetres: by twice as many metres per second."""
    entries = {name: shaper.entries[name] for name in ("velocities/2/pd", "results/2/V_D")}
    filled = Hand(shaper, np.random.default_rng(1), sigma=0.0).filled(entries)
    small = changed(Hand(shaper, np.random.default_rng(1), sigma=0.0).filled(entries), velocities__2__pd=23.0)
    small.factors["velocities"] = 0.04
    length, speed = judged(shaper, filled)
    half, same = judged(shaper, small)
    assert half.exact == pytest.approx(length.exact / 2)
    assert same.exact == speed.exact
    assert half.tolerance == pytest.approx(length.tolerance, rel=0.3)
    assert same.tolerance == pytest.approx(2 * speed.tolerance, rel=0.2)


# --- commands ---------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def cam(tmp_path_factory):
    """A template of a project with a cam only."""
    folder = tmp_path_factory.mktemp("cam")
    assert run(["compare", "lugansk/cam_flat", "--template", "-o", str(folder)]) == 0
    return folder / NAME


def rows(path):
    lines = [line for line in path.read_text(encoding="utf-8-sig").splitlines() if not line.startswith(('#', '"#'))]
    return list(csv.DictReader(lines))


def test_template_has_no_answers(cam):
    """Nothing but scale factors stands in the column to be filled in."""
    table = rows(cam)
    assert len(table) > 50
    assert all(bool(r["measured"]) == r["id"].startswith("mu/") for r in table)
    assert all(r["unit"] or r["plan"] == "" for r in table)
    assert len({r["id"] for r in table}) == len(table)


def test_a_filled_file_is_not_overwritten(cam, tmp_path, capsys):
    """One that nobody has changed is as good as new."""
    file = tmp_path / "measured.csv"
    file.write_bytes(before := cam.read_bytes())
    assert run(["compare", "lugansk/cam_flat", "--template", "-o", str(tmp_path)]) == 0
    assert file.read_bytes() == before
    file.write_bytes(before := before + b"5\n")
    assert run(["compare", "lugansk/cam_flat", "--template", "-o", str(tmp_path)]) == 2
    assert "may be filled in; nothing was written" in capsys.readouterr().err
    assert file.read_bytes() == before


def test_measured(cam, tmp_path, capsys):
    """Table, summary, notes and JSON."""
    path, target, page = tmp_path / "m.csv", tmp_path / "m.json", tmp_path / "m.html"
    path.write_text("id\tизмерено\nresults/r0\t99999\nresults/rho_min\t5 cm\n", encoding="utf-8")
    assert run(["compare", "lugansk/cam_flat", "--measured", str(path), "--json", str(target), "--report", str(page)]) == 0
    out = capsys.readouterr()
    assert re.search(r"^! +r0 .*red, START", out.out, re.MULTILINE)
    assert "2 numbers: " in out.out
    assert "columns separated by tabs" in out.err
    tree = json.loads(target.read_text(encoding="utf-8"))
    assert [*faults(tree)] == []
    assert {f["row"] for f in tree["findings"]} == {"results/r0", "results/rho_min"}
    assert tree["summary"]["red"] >= 1
    start = next(f for f in tree["findings"] if f["id"] == tree["start"][0])
    assert "off_mm" not in start
    assert tree["findings"][0]["expected"] > 0
    # What is told on the terminal is told on the page, each number in a row of a table.
    told = unescape(page.read_text(encoding="utf-8"))
    assert start["said"] in told
    assert all(f"<td>{f['quantity']}</td>" in told for f in tree["findings"])


@pytest.mark.parametrize(("text", "message"), [
    ("id;измерено\nresults/ro;5\n", "did you mean"), ("id;измерено\n", "nothing is filled in"), ("", "empty"),
    ("# проект: press\nid;измерено\nresults/r0;5\n", "not of lugansk/cam_flat"),
])
def test_bad_files(tmp_path, capsys, text, message):
    path = tmp_path / "m.csv"
    path.write_text(text, encoding="utf-8")
    assert run(["compare", "lugansk/cam_flat", "--measured", str(path)]) == 2
    err = capsys.readouterr().err
    assert message in err
    assert "Traceback" not in err


def test_one_thing_at_a_time(capsys):
    assert run(["compare", "lugansk/cam_flat"]) == 2
    assert run(["compare", "lugansk/cam_flat", "--template", "--measured", "x.csv"]) == 2
    assert "give one of" in capsys.readouterr().err


def test_a_number_computed_from_one_read_wrong(shaper):
    """What is plotted from it follows from it, too; and nobody says the crank turns at another speed."""
    names = ("velocities/2/pd5", "results/2/V_D5", "results/2/M_F5", "results/2/M_red", "reduced-moment/2/y_M")
    filled = Hand(shaper, np.random.default_rng(1), sigma=0.0).filled({name: shaper.entries[name] for name in names})
    changed(filled, velocities__2__pd5=41.0, results__2__V_D5=0.82, results__2__M_F5=-304.5, results__2__M_red=-304.5,
            **{"reduced-moment__2__y_M": -60.9})
    of = judged(shaper, filled)
    begun = starts(of)
    assert [j.entry.id for j in begun] == ["velocities/2/pd5"]
    assert all(j.follows is begun[0] for j in of if j is not begun[0])
    assert begun[0].mistake is None or begun[0].mistake.step.name != "ω1"


def test_nothing_written_is_no_tolerance(tmp_path, shaper):
    """A speed of 0 m/s is as exact as the drawing, not half a metre per second uncertain."""
    path = tmp_path / "m.csv"
    path.write_text("id;измерено\nresults/2/V_D;0\n", encoding="utf-8")
    found = judged(shaper, read(path, Project(catalogue.read("lugansk/shaper")), shaper))[0]
    assert found.tolerance < 0.05
    assert found.verdict == "red"


def test_results_of_a_cam_are_as_exact_as_they_are_drawn(shaper):
    """0.25 mm at 0.0002 m/mm is 0.05 mm: r_0 is the distance of two points, off by more than half a per cent of 8.9 mm."""
    entries = [shaper.entries[f"results/{name}"] for name in ("r0", "s0")]
    lines = [MeasuredLine(e, e.value, 0.0, 1) for e in entries]
    for j in judged(shaper, FilledTable(lines)):
        assert 0.1 < j.tolerance < 0.25


@pytest.fixture(scope="module")
def screen():
    return measurables_of("screen")


@pytest.mark.trial
def test_a_good_drawing_of_class_three(screen):
    """No length is asked for from a point that lies on no paper, and the graph of dE is measured at the scale it is drawn to."""
    of = judged(screen, drawn(screen, screen.entries))
    assert {"|AF|", "|AW3|"} <= {e.quantity for e in screen.entries.values() if e.plan == "positions"}
    assert not [j.entry.id for j in of if j.starts]
    energy = {e.label: e for e in screen.entries.values() if e.plan == "total-work"}
    found = [energy[label].value * screen.scales[energy[label].scale].mu for label in energy]
    (plan,) = (plan for plan, _ in screen.plans if plan.name == "total-work")
    exact = plan["E"].value[:-1]
    assert np.ptp([e.value for e in energy.values()]) > 40  # 0.51 J at 0.01 J/mm, not at the 0.5 J/mm of the energy-mass diagram
    assert found == pytest.approx(exact, rel=1e-12)
    ordinates = {j.entry.label: j.tolerance for j in of if j.entry.plan == "total-work"}
    assert max(ordinates.values()) < 15
