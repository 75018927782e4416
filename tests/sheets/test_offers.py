"""Views for the room that is left: where they stand, and that what they say is true."""

import re

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.catalogue import read
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.project import Project
from tmm_sheets.sheets import diagrams, hodograph, moments, offers, position_tables, reducer
from tmm_sheets.sheets.sheet import composed

FIELD = Box(20.0, 5.0, 836.0, 589.0)


def canvas_with(*lines):
    canvas = Canvas()
    canvas.begin(FIELD, "", "view")
    for a, b in lines:
        canvas.line(a, b, "main")
    return canvas


def cells(canvas):
    return offers._of_part(canvas, 0, FIELD, offers._closed(FIELD, []).shape)


@pytest.mark.parametrize(("lines", "found"), [
    ([], True),
    ([(30 + 300j, 826 + 300j)], True),  # 285 mm over and under a line
    ([(30 + 10j, 30 + 580j), (826 + 10j, 826 + 580j)], False),  # between the ink of one view nothing may stand
    ([(30 + 10j, 826 + 580j)], True),  # beside a diagonal
], ids=["nothing", "line", "inside", "diagonal"])  # fmt: skip
def test_a_place_is_clear_of_all_ink_and_outside_pictures(lines, found):
    box = offers._place(cells(canvas_with(*lines)), [(200.0, 120.0)], FIELD)
    assert (box is not None) is found
    if box is not None:
        assert FIELD.x0 <= box.x0 < box.x1 <= FIELD.x1
        assert FIELD.y0 <= box.y0 < box.y1 <= FIELD.y1
        for a, b in lines:
            z = a + np.linspace(0, 1, 2000) * (b - a)
            assert not ((z.real > box.x0 - 5) & (z.real < box.x1 + 5) & (z.imag > box.y0 - 5) & (z.imag < box.y1 + 5)).any()


def test_the_next_smaller_size_is_taken_and_none_that_does_not_fit():
    canvas = canvas_with((20 + 5j, 700 + 5j), (20 + 589j, 700 + 589j), (20 + 5j, 20 + 589j), (700 + 5j, 700 + 589j))
    left = cells(canvas)
    box = offers._place(left, [(200.0, 120.0), (100.0, 60.0)], FIELD)
    assert (box.width, box.height) == (100.0, 60.0)
    assert offers._place(left, [(200.0, 120.0)], FIELD) is None
    assert offers._place(left | offers._closed(FIELD, [Box(690.0, 0.0, 836.0, 594.0)]), [(100.0, 60.0)], FIELD) is None


@pytest.mark.parametrize("name", ["press", "lugansk/engine", "sixbar/3:2"])
def test_equations_of_moments_hold_in_the_numbers_written(name):
    """Each line with numbers is worked out as a pupil would: the sum over the arm is the force printed, to their digits."""
    assert sum(worked_out(line) is not None for line in moments._lines(Project(read(name)))) >= 2


def worked_out(line):
    """The value a line ends with, once its numbers have been worked out; None for one in letters."""
    found = re.search(r"\|(.*)\|(?:/([\d,]+))? = ([\d,]+)", line)
    if found is None:
        return None
    total, arm, value = found.groups()
    value, arm = float(value.replace(",", ".")), float((arm or "1").replace(",", "."))
    terms = [part.replace(" ", "") for part in re.split(r"(?=[+−])", total) if part.strip()]
    signs = [-1 if t[0] == "−" else 1 for t in terms]
    factors = [[float(x.replace(",", ".")) for x in t.strip("+−").split("·")] for t in terms]
    numbers = [sign * np.prod(each) for sign, each in zip(signs, factors, strict=True)]
    # Four digits of every factor: half a unit of the last of each.
    assert abs(abs(sum(numbers)) / arm - value) < 1e-3 * max(map(abs, numbers)) / arm + 1e-9, line
    return value


@pytest.mark.parametrize("name", ["press", "lugansk/engine", "lugansk/shaper", "loom", "sixbar/7:5"])
def test_the_lever_s_equation_gives_the_balancing_force_of_the_force_analysis(name):
    """Its numbers, worked out, give the force that the reactions give without it, through another sum."""
    p = Project(read(name))
    canvas = Canvas()
    canvas.scales["lever"] = Scale("μ_V", 0.01, "(m/s)/mm")
    value = worked_out(" ".join(moments._of_lever(p, canvas, 120.0, 3.5)))
    arm = 1.0 if p.driver is not None else p.mechanism.crank.length
    assert value * arm == pytest.approx(abs(complex(p.study.forces.balancing.at(p.force_index))), rel=2e-4)


@pytest.mark.parametrize("name", ["screen", "transport/crusher@12-СДМ-1908"])
def test_tables_over_positions_hold_what_equilibrium_and_kinematics_demand(name):
    """A pair stands in the table once; the accelerations are the second differences of the points' positions."""
    p = Project(read(name))
    heads = [head for head, _ in position_tables._reactions(p)[1]]
    assert len(heads) == len({frozenset(re.findall(r"\d", head)) for head in heads}) == len(p.mechanism.pairs)
    h = 1e-4 / abs(p.mechanism.crank.speed)
    _, columns = position_tables._accelerations(p)
    turned = np.asarray(p.cycle.turned)
    for head, values in columns:
        if head.startswith("a_"):
            at = [np.asarray(p.study_at(turned + step * 1e-4, p.cycle.labels).positions.points[head[3:-1]].value)
                  for step in (-1, 0, 1)]
            assert np.abs(at[0] - 2 * at[1] + at[2]) / h**2 == pytest.approx(values, rel=1e-4, abs=1e-3 * values.max())


def test_what_is_offered_is_drawn_where_there_is_room():
    sheet = composed(Project(read("press")), 2)
    drawn = [part.draw for part in sheet.parts]
    assert "diagrams.motion_table" in drawn
    assert "moments.equations" in drawn
    assert sheet.leaving == ()
    assert sheet.crowded == ()


def test_points_of_a_train_run_as_the_wheel_they_are_on_turns():
    """Omega r of the wheels with axes that stand, and of the carrier: 2, 3, H and 5 of the hoist in turn; 5 by Willis, by hand."""
    p = Project(read("tests/projects/hoist.toml"))
    canvas = Canvas()
    canvas.scales[p.train.velocities.name] = Scale("μ_V", 0.06, "(m/s)/mm")
    _, *rows = reducer.rows_of_points(p.train, canvas)
    carrier = -960 * 18 / 54
    ring = carrier + (-400 - carrier) * (-24 / 84)
    for (_, distance, measured, speed), turns in zip(rows, (carrier, -400, carrier, ring), strict=True):
        expected = turns * np.pi / 30 * float(distance.replace(",", ".")) * 1e-3
        assert float(speed.replace("−", "-").replace(",", ".")) == pytest.approx(expected, rel=2e-4)
        assert float(measured.split("= ")[1].replace(",", ".")) == pytest.approx(abs(expected) / 0.06, abs=0.051)


def test_the_curve_of_the_power_of_friction_meets_the_numbers_of_the_positions():
    """Where nothing jumps; and friction takes power everywhere."""
    p = Project(read("tests/projects/pump.toml"))
    every = diagrams.over_cycle(p)
    assert np.all(np.diff(every) > 0)
    course = p.study_at(every, tuple("" for _ in every)).forces.friction.total.value
    smooth = [i for i, t in enumerate(p.cycle.turned) if t > 0 and min(abs(t - b) for b in p.reduced.breaks) > 1e-3]
    at = p.study.forces.friction.total.value[smooth]
    assert np.interp(np.asarray(p.cycle.turned)[smooth], every, course) == pytest.approx(at, rel=2e-2)
    assert course.max() < 0


@pytest.mark.parametrize("name", ["loom", "transport/press@07-ЭПС-718"])
def test_a_hodograph_is_closed_and_balances_the_crank(name):
    """At each position the reaction of the frame is opposite to all else on the crank; over a cycle it comes back."""
    p = Project(read(name))
    _, step, course = hodograph._reaction(p)
    size = np.abs(course).max()
    crank = p.mechanism.crank
    others = sum(load.vector.value for load in p.study.forces.loads[crank.link] if load.vector is not step)
    assert np.abs(np.broadcast_to(step.value + others, (len(p.cycle.labels),))).max() < 1e-9 * size
    assert abs(course[0] - course[-1]) < 1e-3 * size
