"""Crossings too flat to be drawn: condition numbers against trigonometry and Monte Carlo, and the warning on the sheet."""

import json
import re
from dataclasses import replace
from math import acos, pi, sin
from pathlib import Path

import numpy as np
import pytest
from shapely import LineString, Polygon, box, union_all

from tests import project_files as files
from tests.sheets.unlettered import unlettered, words
from tmm_sheets import catalogue
from tmm_sheets.__main__ import run
from tmm_sheets.construction import condition, rules
from tmm_sheets.construction.step import Plan, value_of
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Fill, Text, flat
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.project import Project
from tmm_sheets.sheets import composition, sheet
from tmm_sheets.sheets.components import flat_crossings

NEAR = str(Path(__file__).parent / "near.toml")
CRANK, COUPLER, ROCKER, FRAME = 0.1, 0.33, 0.173, 0.4
PENCIL = 0.25


def near(*parts):
    return files.project(files.from_file(NEAR), *parts)


@pytest.fixture(scope="module")
def project():
    return near()


@pytest.fixture(scope="module")
def composed(project):
    return sheet.composed(project, 1)


# --- condition numbers ------------------------------------------------------------------------------------------------


def test_condition_of_arcs_by_the_law_of_cosines(project):
    study = project.study
    for k, phi in enumerate(study.positions.phi):
        d = abs(FRAME - CRANK * np.exp(1j * phi))
        expected = 1 / sin(acos((COUPLER**2 + ROCKER**2 - d**2) / (2 * COUPLER * ROCKER)))
        for plan, point in ((study.positions.plan, "C"), (study.velocities.plan, "c"), (study.accelerations.plan, "c")):
            assert condition.crossings(plan)[point][k] == pytest.approx(expected, rel=1e-12)


def test_condition_of_arc_and_line(project):
    """The rod of 0.4 m against the guide 0.18 m above: at right angles to the rod the arc runs."""
    pos = project.study.positions
    c = pos.points["C"].value
    expected = 1 / np.sqrt(1 - ((0.18 - c.imag) / 0.4) ** 2)
    assert condition.crossings(pos.plan)["E"] == pytest.approx(expected, rel=1e-12)


def test_condition_by_monte_carlo():
    """Two lines moved at random across themselves: the spread of their crossing."""
    rng = np.random.default_rng(1)
    for degrees in (90.0, 40.0, 12.0, 2.0):
        u, v = 1 + 0j, np.exp(1j * np.radians(degrees))
        plan = Plan("lines", "", "mm")
        x = plan.add("x", rules.LINE_LINE, 3 + 0j, u, 5 + 2j, v)
        shifts = rng.normal(size=(2, 20_000))
        a = np.array([[u.imag, -u.real], [v.imag, -v.real]])
        moved = np.linalg.solve(a, shifts)  # the normals of both lines times the displacement are the shifts
        spread = np.sqrt(np.mean(np.sum(moved**2, axis=0)) / 2)
        assert condition.condition(x)[0] == pytest.approx(spread, rel=0.02)


@pytest.mark.parametrize("name", ["lugansk/shaper", "lugansk/engine", "sixbar/9:3", "near"])
def test_condition_is_that_of_the_replay(name):
    """Moving the lines across themselves, one after the other, moves their crossing so much."""
    p = near() if name == "near" else Project(catalogue.read(name))
    study = p.study
    seen, d = 0, 1e-7
    for plan in (study.positions.plan, study.velocities.plan, study.accelerations.plan):
        for point, found in condition.crossings(plan).items():
            rule, args = plan[point].rule, [value_of(a) for a in plan[point].args]
            size = d * np.abs(plan[point].value).max()
            if rule is rules.ARC_ARC:
                p1, r1, p2, r2, side = args[:5]
                moved = [(p1, r1 + size, p2, r2, side), (p1, r1, p2, r2 + size, side)]
            elif rule is rules.ARC_LINE:
                p1, r1, q, u, side = args[:5]
                moved = [(p1, r1 + size, q, u, side), (p1, r1, q + size * 1j * u / np.abs(u), u, side)]
            else:
                p1, u, q, v = args[:4]
                moved = [(p1 + size * 1j * u / np.abs(u), u, q, v), (p1, u, q + size * 1j * v / np.abs(v), v)]
            start = args[: len(moved[0])]
            shifts = [np.abs(rule.compute(*m) - rule.compute(*start)) / size for m in moved]
            assert found == pytest.approx(np.sqrt((shifts[0] ** 2 + shifts[1] ** 2) / 2), rel=1e-3)
            seen += 1
    assert seen >= 4


def test_what_is_no_crossing_and_what_touches():
    plan = Plan("arcs", "", "mm")
    p, q = plan.add("P", rules.GIVEN, 0j), plan.add("Q", rules.GIVEN, 5 + 0j)
    assert condition.condition(p) is None
    assert condition.condition(plan.add("T", rules.ARC_ARC, p, 2.0, q, 3.0, 1.0))[0] > 1e7
    assert np.isnan(condition.condition(plan.add("N", rules.ARC_ARC, p, 1.0, q, 3.0, 1.0)))
    assert condition.condition(plan.add("R", rules.ARC_ARC, p, 3.0, q, 4.0, 1.0)) == pytest.approx(1.0)
    assert condition.of_plans([Plan("empty", "", "mm")], 3).tolist() == [1, 1, 1]


def test_the_worst_of_what_was_computed_already():
    plan = Plan("arcs", "", "mm")
    p, q = plan.add("P", rules.GIVEN, 0j), plan.add("Q", rules.GIVEN, 5 + 0j)
    steep, flatter = (plan.add(name, rules.ARC_ARC, p, r, q, 4.0, 1.0) for name, r in (("R", 3.0), ("F", 1.2)))
    assert condition.worst(plan) is None
    assert not steep.evaluated
    _ = steep.value
    assert condition.worst(plan) == (pytest.approx(1.0), "R")
    assert not flatter.evaluated
    _ = flatter.value
    number, name = condition.worst(plan)
    assert (number > 1.5, name) == (True, "F")


def test_explain_has_the_worst(tmp_path, capsys):
    assert run(["build", NEAR, "--explain", "--format", "svg", "-o", str(tmp_path)]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("  positions "))
    assert row.endswith("4.38 in C")


# --- what is found ----------------------------------------------------------------------------------------------------


def drawn_by_hand(phi, mu, rng, n=40_000):
    """Point C drawn with the pencil many times, mm, and where it is: arcs from B and D with openings and points that are off."""

    def off():
        return PENCIL * (rng.normal(size=n) + 1j * rng.normal(size=n))

    a, d = off(), FRAME / mu + off()
    b = a + CRANK / mu * np.exp(1j * phi) + off()
    r1, r2 = (length / mu + PENCIL * rng.normal(size=n) for length in (COUPLER, ROCKER))
    away = np.abs(d - b)
    along = (away**2 + r1**2 - r2**2) / (2 * away)
    with np.errstate(invalid="ignore"):
        return b + (d - b) / away * (along + 1j * np.sqrt(r1**2 - along**2))


def test_errors_by_monte_carlo(project):
    """What the warning says and what it recommends, against compasses of our own; near tangency it is on the safe side."""
    rng = np.random.default_rng(2)
    scale, _ = composition.scales(project, {"positions"})["mu_l"]
    (found,) = flat_crossings.find(project, project.study.positions.plan, range(12), {"positions": scale})
    assert (found.step.name, found.positions, found.worst, found.better) == ("C", (5, 6, 7), 6, 4)
    assert found.angle == pytest.approx(pi - acos((COUPLER**2 + ROCKER**2 - 0.25) / (2 * COUPLER * ROCKER)), rel=1e-9)
    spread = {}
    for k in (4, 6):
        z = drawn_by_hand(project.study.positions.phi[k], scale.mu, rng)
        z = z[~np.isnan(z)]
        spread[k] = np.sqrt(np.linalg.eigvalsh(np.cov(z.real, z.imag))[-1])
    assert found.better_mm == pytest.approx(spread[4], rel=0.03)
    assert spread[6] > 0.45 * found.mm
    assert spread[6] < 1.05 * found.mm


@pytest.mark.parametrize("name", ["lugansk/shaper", "lugansk/engine", "press", "sixbar/5:1", "sixbar/9:3"])
def test_well_conditioned_projects_have_none_and_nothing_is_replayed(name, monkeypatch):
    def refuse(*_):
        raise AssertionError("the error analysis was asked for")

    monkeypatch.setattr(flat_crossings, "_errors", refuse)
    p = Project(catalogue.read(name))
    study = p.study
    forces = [f.plan for f in study.forces.plans.values()]
    for plan in (study.positions.plan, study.velocities.plan, study.accelerations.plan, *forces):
        assert flat_crossings.find(p, plan, range(len(study.labels)), {}) == []


def test_the_analysed_position_may_be_in_the_second_turn():
    """Engines have cycles of two turns; the plans of the second repeat those of the first."""
    p = near({"cycle.turns": 2, "cycle.force_position": "18"})
    told = " ".join(words(unlettered(p)))
    assert "В положениях 5–7 засечку точки C нельзя провести точнее 2,5 мм" in told
    assert "линии сходятся под углом 13°; для силового расчёта возьмите положение 4, 16 (0,6 мм)" in told
    assert "так же на плане ускорений точка c" in told


def test_the_better_position_is_on_the_same_stroke():
    p = near({"cycle.output": "E", "cycle.working_sense": "+x"})
    scale, _ = composition.scales(p, {"positions"})["mu_l"]
    (found,) = flat_crossings.find(p, p.study.positions.plan, [5], {"positions": scale})
    working = p.cycle.strokes.working(p.cycle.turned, 1)
    assert working[found.worst] == working[found.better]
    assert not all(working)
    assert working.any()


# --- in words and on paper --------------------------------------------------------------------------------------------


def test_the_warning_in_words(project, composed):
    (found,) = flat_crossings.find(project, project.study.positions.plan, range(12), composed.scales)
    assert flat_crossings.said(project, found) == (
        "В положениях 5–7 засечку точки C нельзя провести точнее 2,5 мм: в положении 6 линии сходятся под углом 13°; "
        "для силового расчёта возьмите положение 4 (0,6 мм)")
    other = replace(found, positions=(1, 5), worst=5, mm=None, angle=0.05, better=None)
    assert flat_crossings.said(project, other) == (
        "В положениях 1, 5 засечку точки C нельзя провести: в положении 5 линии сходятся под углом 2,9°; "
        "на этом ходе нет положения лучше")
    velocity = replace(found, plan=project.study.velocities.plan, positions=(5,), worst=5, mm=1.55)
    assert flat_crossings.said(project, velocity) == (
        "На плане скоростей в положении 5 точку C нельзя найти точнее 1,6 мм: линии сходятся под углом 13°; "
        "точнее в положении 4 (0,6 мм)")


def lettering_of(composed, start):
    """Lines of lettering with a remark, as groups of the sheet."""
    groups = [g for g in composed.groups if g.kind == "lettering"]
    first = next(i for i, g in enumerate(groups) if g.text.startswith(start))
    last = next(i for i, g in enumerate(groups) if i >= first and g.text.endswith(("мм)", "(никак)")))
    return groups[first:last + 1]


def test_what_two_links_give_in_all_plans_is_said_once(composed):
    """One angle of coupler and rocker: the remark to the positions names the other plans, each with its own error."""
    told = " ".join(g.text for g in lettering_of(composed, "В положениях 5–7 засечку"))
    assert told.count("13°") == sum(g.text.count("13°") for g in composed.groups if g.kind == "lettering") == 1
    for where in ("на плане ускорений точка c (18,8 мм)", "на плане скоростей точка c (2,2 мм)",
                  "на плане сил группы 2–3 вершина 1 (72,9 мм)"):  # fmt: skip
        assert told.count(f"так же {where}") == 1


def test_other_lines_have_a_remark_of_their_own_and_the_same_are_told_at_their_worst_position(project, composed, monkeypatch):
    """Of one plan they may be worst in another position than of the next: that is one flat angle all the same."""
    plan = project.study.positions.plan
    (found,) = flat_crossings.find(project, plan, range(12), composed.scales)
    others = [found, replace(found, sines=found.sines + 0.01), replace(found, worst=5, mm=2.6), found]
    monkeypatch.setattr(flat_crossings, "find", lambda *_: others)
    canvas = Canvas()
    flat_crossings.warn(project, canvas, Box(0, 0, 100, 100), plan)
    assert [note.text.count("так же") for note in canvas.notes] == [2, 0]
    assert [note.text.count("(положение 5: 2,6 мм)") for note in canvas.notes] == [1, 0]


def test_the_warning_stands_free_in_its_view(composed):
    start, view = "В положениях 5–7 засечку", "kinematics.position_plans"
    assert composed.crowded == ()
    marks = composed.drawing.marks
    lines = lettering_of(composed, start)
    mine = {i for g in lines for i in range(g.first, g.end)}
    assert all(isinstance(marks[i], Text) and marks[i].height >= 2.5 for i in mine)
    part = composed.parts[lines[0].part]
    assert part.draw == view
    words = union_all([Polygon(np.column_stack((c.real, c.imag))) for c in (text_box(marks[i]) for i in sorted(mine))])
    assert box(*part.box).contains(words)
    for i, mark in enumerate(marks):
        if i in mine:
            continue
        points = text_box(mark) if isinstance(mark, Text) else flat(mark)
        shape = np.column_stack((points.real, points.imag))
        other = Polygon(shape) if isinstance(mark, Text | Fill) else LineString(shape)
        assert words.distance(other) > 0.5, mark


@pytest.mark.trial
def test_a_press_of_the_family_gets_two():
    """Knee press by cipher: coupler and rocker, then rocker and rod come near to one line on the idle stroke."""
    name = "transport/press@04-ЭПС-882"
    shown = sheet.composed(Project(catalogue.read(name)), 1)
    told = " ".join(g.text for g in shown.groups if g.kind == "lettering")
    assert "В положениях 9, 10 засечку точки B нельзя провести точнее 1,4 мм: в положении 10 линии сходятся под углом 23°" in told
    assert "В положениях 8–10 засечку точки C нельзя провести точнее 2,7 мм: в положении 9 линии сходятся под углом 15°" in told
    assert shown.crowded == ()


def test_the_shaper_gets_no_warning():
    shown = sheet.composed(Project(catalogue.read("lugansk/shaper")), 1)
    assert not any("нельзя" in g.text for g in shown.groups)


def test_notes_go_beside_a_full_view_and_are_told_when_nothing_is_free():
    canvas, view = Canvas(), Box(10, 10, 60, 40)
    for y in range(10, 41):
        canvas.line(complex(10, y), complex(60, y))
    canvas.note(view, "нельзя провести точнее 2,3 мм")
    assert place(canvas, Box(0, 0, 200, 60)) == []
    letters = [m for m in canvas.marks if isinstance(m, Text)]
    assert letters
    assert all(m.at.real > 60 or m.at.imag > 40 or m.at.imag < 10 for m in letters)
    count = len(canvas.marks)
    canvas.note(view, "нельзя провести точнее 2,3 мм")
    (crowded,) = place(canvas, Box(10, 10, 60, 40))
    assert crowded.text == "нельзя провести точнее 2,3 мм"
    assert len(canvas.marks) == count
    assert not canvas.notes


# --- on the command line ----------------------------------------------------------------------------------------------


def test_check_tells(capsys):
    assert run(["check", NEAR]) == 0
    told = capsys.readouterr()
    assert told.out == f"{NEAR}: OK\n"
    assert told.err == (
        f"{NEAR}: At positions 5–7 the arcs at point C cannot be drawn better than to 2.5 mm: at position 6 the lines meet at 13°; "
        "for the force analysis take position 4 (0.6 mm)\n"
    )  # fmt: skip
    assert run(["check", "lugansk/shaper"]) == 0
    assert capsys.readouterr().err == ""


def test_condition_in_the_results(capsys):
    assert run(["solve", NEAR, "--json", "-"]) == 0
    tree = json.loads(capsys.readouterr().out)
    assert list(tree["condition"]) == ["positions", "velocities", "accelerations", "forces"]
    angle = acos((COUPLER**2 + ROCKER**2 - (FRAME + CRANK) ** 2) / (2 * COUPLER * ROCKER))
    assert tree["condition"]["positions"][6] == pytest.approx(1 / sin(angle), rel=1e-12)
    assert tree["condition"]["forces"] == pytest.approx([tree["condition"]["velocities"][6]], rel=1e-9)
    assert run(["solve", NEAR, "--json", "-", "--part", "velocities", "--positions", "7"]) == 0
    tree = json.loads(capsys.readouterr().out)
    assert [(k, len(v)) for k, v in tree["condition"].items()] == [("velocities", 7)]


@pytest.mark.trial
def test_the_position_advised_is_better():
    """The loom's point d: 2.6 mm at the nearest steep position, 1.9 where it is warned of."""
    told = " ".join(g.text for g in sheet.composed(Project(catalogue.read("loom")), 1).groups if g.kind == "lettering")
    assert told.count("нельзя") == 1
    said = r"точку (\w) нельзя найти точнее ([\d,]+) мм: .*?; точнее в положении \d+ \(([\d,]+) мм\)"
    point, *errors = re.search(said, told).groups()
    warned, advised = (float(error.replace(",", ".")) for error in errors)
    assert point == "d"
    assert advised < warned
