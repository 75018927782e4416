"""Views for the room that is left: where they stand, and that what they say is true."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.few import few
from tests.sheets.moment_lines import every_line
from tests.sheets.unlettered import unlettered, words
from tmm_sheets.box import Box
from tmm_sheets.catalogue import read
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink_index import sum_area
from tmm_sheets.drawing.lettering import broken
from tmm_sheets.drawing.marks import Polyline
from tmm_sheets.numbers import number
from tmm_sheets.project import Project
from tmm_sheets.sheets import composing, composition, optional_views
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.composing import sheet_code
from tmm_sheets.sheets.gears import train, train_scheme
from tmm_sheets.sheets.linkage import diagrams, given_position, kinematics, kinetics, link_marks, moments
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.words import tr

FIELD = Box(20.0, 5.0, 836.0, 589.0)


def canvas_with(*lines):
    canvas = Canvas()
    canvas.begin(FIELD, "", "view")
    for a, b in lines:
        canvas.line(a, b, "main")
    return canvas


def cells(canvas):
    return optional_views.part_cells(canvas, 0, FIELD)


@pytest.mark.parametrize(("lines", "found"), [
    ([], True),
    ([(30 + 300j, 826 + 300j)], True),  # 285 mm over and under a line
    ([(30 + 10j, 30 + 580j), (826 + 10j, 826 + 580j), (30 + 10j, 826 + 10j), (30 + 580j, 826 + 580j)], False),  # within a picture
    ([(30 + 10j, 30 + 580j), (826 + 10j, 826 + 580j), (30 + 580j, 826 + 580j)], True),  # in a wide bay that is open below
    ([(x + 10j, x + 580j) for x in (30, 115, 200, 285, 370, 455, 540, 625, 710, 795)], False),  # narrow bays are the view's own
    ([(30 + 10j, 826 + 580j)], True),  # beside a diagonal
], ids=["nothing", "line", "inside", "bay", "narrow", "diagonal"])  # fmt: skip
def test_a_place_is_clear_of_all_ink_and_outside_pictures(lines, found):
    box = optional_views.place_farthest(cells(canvas_with(*lines)), [(200.0, 120.0)], FIELD)
    assert (box is not None) is found
    if box is not None:
        assert FIELD.x0 <= box.x0 < box.x1 <= FIELD.x1
        assert FIELD.y0 <= box.y0 < box.y1 <= FIELD.y1
        for a, b in lines:
            z = a + np.linspace(0, 1, 2000) * (b - a)
            assert not ((z.real > box.x0 - 5) & (z.real < box.x1 + 5) & (z.imag > box.y0 - 5) & (z.imag < box.y1 + 5)).any()


@pytest.mark.parametrize(("draw", "free"), [("view", True), ("train.scheme", False)])
def test_nothing_stands_between_the_edges_of_a_wheel(draw, free):
    canvas = Canvas()
    canvas.begin(FIELD, "", draw)
    for y in (30.0, 560.0):
        canvas.line(complex(20, y), complex(836, y), "main")
    assert (optional_views.place_farthest(cells(canvas), [(200.0, 120.0)], FIELD) is not None) is free


@pytest.mark.parametrize("name", ["hoist", "ferguson"])
def test_every_wheel_of_a_train_has_its_diameter_once(name):
    project = Project(read(f"tests/projects/{name}.toml"))
    lines = train.dimensions(project)
    said = [line.split(" = ")[0] for line in lines if line.startswith("d_")]
    meshed = {w for mesh in project.train.meshes for w in (mesh.central, mesh.planet)}
    # On a carrier with meshes of other sums of teeth a wheel rolls on another circle in each of them: d_{w2–3} is no d_2.
    assert {sign[3:-1].removeprefix("w").split("–")[0] for sign in said} == meshed
    assert len(said) == len(set(said))
    for line in lines:
        if "m·z" in line and line.startswith("d_"):
            module, teeth = (float(v.replace(",", ".")) for v in line.split(" = ")[2].split("·"))
            assert module * teeth == pytest.approx(float(line.split(" = ")[3].removesuffix(" мм").replace(",", ".")), rel=1e-3)


def test_the_next_smaller_size_is_taken_and_none_that_does_not_fit():
    canvas = canvas_with((20 + 5j, 700 + 5j), (20 + 588j, 700 + 588j), (20 + 5j, 20 + 588j), (700 + 5j, 700 + 588j))
    left = cells(canvas)
    box = optional_views.place_farthest(left, [(200.0, 120.0), (100.0, 60.0)], FIELD)
    assert (box.width, box.height) == (100.0, 60.0)
    assert optional_views.place_farthest(left, [(200.0, 120.0)], FIELD) is None
    assert optional_views.place_farthest(
        left | optional_views.cells_closed(FIELD, [Box(690.0, 0.0, 836.0, 594.0)]),
        [(100.0, 60.0)], FIELD) is None


def test_what_belongs_to_a_plan_stands_beside_it_and_not_beside_another():
    taken = optional_views.cells_closed(FIELD, [])
    own, other, below = Box(100.0, 300.0, 200.0, 400.0), Box(100.0, 410.0, 200.0, 500.0), Box(100.0, 200.0, 200.0, 290.0)
    spot, size = 150 + 395j, [(60.0, 80.0)]
    assert abs(optional_views.place_nearest(taken, size, FIELD, spot, [own]).centre - spot) < 3.0
    taken |= optional_views.cells_closed(FIELD, [own])
    assert optional_views.place_nearest(taken, size, FIELD, spot, [own]).y0 > own.y1  # that is nearest
    beside = optional_views.place_nearest(taken, size, FIELD, spot, [own, other])
    assert beside.x1 < own.x0 or beside.x0 > own.x1
    assert beside.centre.imag < (own.y1 + other.y0) / 2
    walls = taken | optional_views.cells_closed(FIELD, [Box(20.0, 5.0, 99.0, 589.0), Box(201.0, 5.0, 836.0, 589.0)])
    assert optional_views.place_nearest(walls, size, FIELD, spot, [own, other, below]) is None
    far = optional_views.cells_closed(FIELD, [Box(20.0, 5.0, 600.0, 589.0)])
    assert optional_views.place_nearest(far, size, FIELD, spot, [own]) is None


@pytest.mark.parametrize(("lines", "count"), [
    ([], 408 * 292),  # all is empty
    ([(20 + 297j, 836 + 297j), (428 + 5j, 428 + 589j)], None),  # four gaps
    ([(x + 5j, x + 589j) for x in range(30, 836, 118)], 0),  # 116 mm are no gap
    ([(x + 5j, x + 589j) for x in (136, 230, 320, 410, 500, 590, 680, 770)], None),  # one of 116 mm, all others narrower
    ([(x + 5j, x + 589j) for x in (142, 230, 320, 410, 500, 590, 680, 770)], 60 * 292),
], ids=["nothing", "four", "narrow", "just not", "just"])  # fmt: skip
def test_gaps_are_where_an_empty_rectangle_of_160_by_120_is(lines, count):
    canvas = canvas_with(*lines, (20 + 5j, 20 + 5j))
    gaps = optional_views.empty_cells(canvas, FIELD, [], (160.0, 120.0))
    inked = optional_views.inked_cells(canvas, range(1), FIELD)
    assert not (gaps & inked).any()
    nx, ny = 80, 60
    by_hand = np.zeros_like(gaps)
    for w, h in ((nx, ny), (ny, nx)):
        for i, j in np.argwhere(optional_views.window_counts(sum_area(inked), w, h) == 0):
            by_hand[i:i + w, j:j + h] = True
    assert (gaps == by_hand).all()
    if count is not None:
        assert abs(int(gaps.sum()) - count) <= 408  # but for the cell of a line


def test_nothing_parts_a_scheme_from_its_force_plans():
    """Views drawn one after the other: what stands between the ink of one of them is its own, beyond it there is room."""
    canvas = Canvas()
    for draw, y in (("kinetics.group", 500j), ("kinetics.group", 300j), ("kinematics.positions", 100j)):
        canvas.begin(FIELD, "", draw)
        for title, x in (("scheme", 100.0), ("plan", 500.0)):
            canvas.begin(FIELD, title)
            canvas.line(x + y - 20j, x + y + 20j, "main")
    whole = optional_views.cells_between(canvas, FIELD)
    at = {z: whole[int((z.real - FIELD.x0) / optional_views.CELL), int((z.imag - FIELD.y0) / optional_views.CELL)] for z in
          (300 + 500j, 300 + 300j, 300 + 100j, 300 + 400j, 600 + 500j)}
    assert list(at.values()) == [True, True, False, False, False]


@pytest.mark.parametrize("name", few(
    ["press", "lugansk/engine", "sixbar/3:2", "loom", "screen", "tests/projects/sieve.toml"],
    "lugansk/engine", "sixbar/3:2", "screen"))
def test_equations_of_moments_hold_in_the_numbers_written(name):
    """Each line with numbers is worked out as a pupil would: the sum over the arm is the force printed, to their digits."""
    assert sum(worked_out(line) is not None for line in every_line(Project(read(name)))) >= 2


def worked_out(line):
    """The value a line ends with, once its numbers have been worked out; None for one in letters."""
    found = re.search(r"(?:\|(.*)\|/([\d,]+)|^M[^=]* = ([^=]+)) = −?([\d,]+)", line)
    if found is None:
        return None
    part, arm, whole, value = found.groups()
    total = part or whole
    value, arm = float(value.replace(",", ".")), float((arm or "1").replace(",", "."))
    terms = [part.replace(" ", "") for part in re.split(r"(?=[+−])", total) if part.strip()]
    signs = [-1 if t[0] == "−" else 1 for t in terms]
    factors = [[float(x.replace(",", ".")) for x in t.strip("+−").split("·")] for t in terms]
    numbers = [sign * np.prod(each) for sign, each in zip(signs, factors, strict=True)]
    # Four digits of every factor: half a unit of the last of each.
    assert abs(abs(sum(numbers)) / arm - value) < 1e-3 * max(map(abs, numbers)) / arm + 1e-9, line
    return value


@pytest.mark.parametrize("name", ["screen", "transport/crusher@12-СДМ-1908"])
def test_tables_over_positions_hold_what_equilibrium_and_kinematics_demand(name):
    """A pair stands in the table once; the accelerations are the second differences of the points' positions."""
    p = Project(read(name))
    heads = [head for head, _ in given_position.of_pairs(p)]
    assert len(heads) == len({frozenset(re.findall(r"\d", head)) for head in heads}) == len(p.mechanism.pairs)
    h = 1e-4 / abs(p.mechanism.crank.speed)
    turned = np.asarray(p.cycle.turned)
    for head, values in given_position.of_points_and_links(p):
        if head.startswith("a_"):
            at = [np.asarray(p.study_at(turned + step * 1e-4, p.cycle.labels).positions.points[head[3:-1]].value)
                  for step in (-1, 0, 1)]
            assert np.abs(at[0] - 2 * at[1] + at[2]) / h**2 == pytest.approx(values, rel=1e-4, abs=1e-3 * values.max())


@pytest.mark.parametrize("name", ["sixbar/8:3", "lugansk/shaper", "transport/crusher@12-СДМ-1908"])
def test_equation_of_the_lever_holds_in_the_numbers_written(name):
    """Forces in N and arms in mm about the pole give what drives the crank by kinetostatics, to the digits that are written."""
    p = Project(read(name))
    canvas = Canvas()
    kinetics.lever(p, canvas, Box(25.0, 9.0, 280.0, 290.0), {})
    lines = moments.lever_lines(p, canvas.scales["lever"])
    total, arm, value = re.search(r"\((.*)\)/([\d,]+) = ([−\d,]+) Н", lines[1]).groups()
    value, arm = (float(x.replace(",", ".").replace("−", "-")) for x in (value, arm))
    terms = [part.replace(" ", "") for part in re.split(r"(?=[+−])", total) if part.strip()]
    factors = [[float(x.replace(",", ".")) for x in t.strip("+−").split("·")] for t in terms]
    found = sum((-1 if t[0] == "−" else 1) * np.prod(each) for t, each in zip(terms, factors, strict=True)) / arm
    rounded = sum(force * (0.06 + 5e-4 * length) for force, length in factors) / arm + 0.06 / arm * abs(value)
    assert abs(found - value) < rounded
    k = p.force_index
    if p.driver is None:
        # As it is drawn, as it acts: in the sense of rotation or against it, which is said here and in the equation of the crank.
        by_statics = float(p.study.forces.balancing.at(k)) * p.mechanism.crank.sense
        assert value * p.mechanism.crank.length == pytest.approx(abs(by_statics), rel=1e-3)
        for said in (lines[2], list(every_line(p))[-1]):
            told, sense = re.search(r" = ([\d,]+) Н·м \((по|против) ω_1\)", said).groups()
            last = 10.0 ** -len(told.partition(",")[2])
            assert float(told.replace(",", ".")) == pytest.approx(abs(by_statics), abs=0.51 * last)
            assert sense == ("по" if by_statics > 0 else "против")
    else:
        assert value == pytest.approx(abs(complex(p.study.forces.balancing.at(k))), rel=1e-3)


@pytest.mark.parametrize("name", ["sixbar/3:2", "loom"])
def test_every_vertex_of_the_lever_has_its_letters(name):
    p = Project(read(name))
    canvas = Canvas()
    kinetics.lever(p, canvas, Box(25.0, 9.0, 280.0, 290.0), {})
    said = {text for label in canvas.labels for text in label.text.split(", ") if text.endswith("′") and "F" not in text}
    plan = p.study.velocities.plan
    ends = {step.name for seg in plan.segments for step in (seg.tail, seg.head)} - {plan.pole}
    assert said >= {f"{link_marks.indexed(end)}′" for end in ends}


@pytest.mark.parametrize(("name", "codes"), [("lugansk/shaper", "1234"), ("screen", "123"), ("lugansk/cam_flat", "1")])
def test_designations_of_a_project_rise(name, codes):
    """The codes of the arrangements where these rise, else the sheets' numbers.

    The screen's two kinds of sheet 2 are no two D2, and the only sheet of a project is D1.
    """
    p = Project(read(name))
    assert [sheet_code(p, n) for n in range(1, len(p.sheets) + 1)] == [f"Д{code}" for code in codes]


def test_what_is_offered_is_drawn_where_there_is_room():
    sheet = composed(Project(read("press")), 2)
    drawn = [part.draw for part in sheet.parts]
    assert "diagrams.motion_table" in drawn
    assert sum(part.title == tr(moments.TITLES["moments"]) for part in sheet.parts) == 2
    assert sheet.leaving == ()
    assert sheet.crowded == ()


@pytest.mark.parametrize(("name", "apart"), [("tests/projects/planer.toml", True), ("sixbar/9:2", True), ("lugansk/shaper", False)])
def test_equations_without_room_under_their_figures_stand_apart(name, apart):
    """But not among the kinematics, where nobody would look for them."""
    canvas = unlettered(Project(read(name)))
    stand = [part.box.centre for part in canvas.parts if part.draw == "kinetics.moments"]
    assert bool(stand) == apart
    figures = [part.box.centre for part in canvas.parts if part.draw in ("kinetics.group", "kinetics.groups", "kinetics.crank")]
    assert all(min(abs(at - z) for z in figures) < 200 for at in stand)
    assert not any("в записке" in text for text in words(canvas))


def test_where_equations_have_no_room_and_no_view_it_is_said_where_they_are_read(monkeypatch):
    """In an arrangement of one's own, say: they were left out without a word."""
    planned = composition.arranged
    monkeypatch.setattr(composition, "arranged", lambda project, n: replace(planned(project, n), offers=()))
    for name, times in (("tests/projects/planer.toml", 1), ("sixbar/8:3", 0)):
        _, canvas, _ = composing.viewed(Project(read(name)), 1)
        assert [note.text for note in canvas.notes].count("Уравнения моментов: в записке") == times
        assert bool(canvas.owed) == bool(times)


def test_a_point_k_has_its_letter_beside_the_end_of_a_coriolis_segment():
    plan = Project(read("tests/projects/sieve.toml")).study.accelerations.plan
    assert (plan["k"].symbol, plan["k′"].symbol) == ("k1", "k")


def test_points_of_a_train_run_as_the_wheel_they_are_on_turns():
    """Omega r of the wheels with axes that stand, and of the carrier: 2, 3, H and 5 of the hoist in turn; 5 by Willis, by hand."""
    p = Project(read("tests/projects/hoist.toml"))
    canvas = Canvas()
    canvas.scales[p.train.velocities.name] = Scale("μ_V", 0.06, "(m/s)/mm")
    _, *rows = train_scheme.rows_of_points(p.train, canvas)
    carrier = -960 * 18 / 54
    ring = carrier + (-400 - carrier) * (-24 / 84)
    for (_, distance, measured, speed), turns in zip(rows, (carrier, -400, carrier, ring), strict=True):
        expected = turns * np.pi / 30 * float(distance.replace(",", ".")) * 1e-3
        assert float(speed.replace("−", "-").replace(",", ".")) == pytest.approx(expected, rel=2e-4)
        assert float(measured.split("= ")[1].replace(",", ".")) == pytest.approx(abs(expected) / 0.06, abs=0.051)


def test_the_curve_of_the_power_of_friction_meets_the_numbers_of_the_positions():
    """Where nothing jumps; and friction takes power everywhere."""
    p = Project(read("tests/projects/pump.toml"))
    every = p.course.turned
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
    _, step, course = diagrams.frame_reaction(p)
    size = np.abs(course).max()
    crank = p.mechanism.crank
    others = sum(load.vector.value for load in p.study.forces.loads[crank.link] if load.vector is not step)
    assert np.abs(np.broadcast_to(step.value + others, (len(p.cycle.labels),))).max() < 1e-9 * size
    assert abs(course[0] - course[-1]) < 1e-3 * size


def test_a_hodograph_numbers_the_positions_of_every_turn_where_their_force_ends():
    """In the second turn of a four-stroke engine the force is another one."""
    p = Project(read(str(Path(__file__).parents[1] / "projects" / "pump.toml")))
    canvas = canvas_with()
    diagrams.bearing(p, canvas, Box(100.0, 100.0, 260.0, 260.0), {})
    _, step, _ = diagrams.frame_reaction(p)
    frame = canvas.frames[-1]
    there = {label: frame.origin + complex(z) / frame.mu[0] for label, z in zip(p.cycle.labels, step.value, strict=True)}
    said = {}
    for label in canvas.labels:
        if label.height == 2.5:
            for part in label.text.split(", "):
                first, _, last = part.partition("–")
                run = p.cycle.labels[p.cycle.labels.index(first):p.cycle.labels.index(last or first) + 1]
                said |= dict.fromkeys(run, label.anchor)
    assert p.cycle.period > 7
    assert sorted(said) == sorted(p.cycle.labels)
    assert all(abs(at - there[label]) < 1.0 for label, at in said.items())


@pytest.mark.parametrize("swings", [False, True])
def test_a_load_that_jumps_where_the_cycle_begins_leaves_no_gap_in_the_hodograph(swings):
    """The press ends its stroke under the full force and begins the next without one; a swing does not come back."""
    p = Project(read("press"))
    _, _, course = diagrams.frame_reaction(p)
    p.__dict__["cycle"] = replace(p.cycle, swings=swings)
    canvas = canvas_with()
    diagrams.bearing(p, canvas, Box(100.0, 100.0, 260.0, 260.0), {})
    (curve,) = (m.points for m in canvas.marks if isinstance(m, Polyline) and m.style == "curve")
    assert abs(course[0] - course[-1]) > 0.9 * np.abs(course).max()
    assert (curve[0] == curve[-1]) is not swings
    assert len(curve) == len(course) + (not swings)


def test_nothing_stands_between_a_title_and_the_plans_of_several_positions():
    """The plans are parts of their own, with captions; a plan that is lower than its neighbours leaves no room to others."""
    canvas = Canvas()
    canvas.begin(FIELD, "", "plans")
    canvas.title(Box(100.0, 100.0, 500.0, 300.0), "Plans")
    for x, top in ((120.0, 270.0), (400.0, 240.0)):
        canvas.begin(Box(x, 100.0, x + 80.0, 280.0), "Plan of a position")
        canvas.line(complex(x, 110.0), complex(x + 80.0, top), "vector")
    canvas.begin(FIELD, "", "other view")
    taken = optional_views.part_cells(canvas, 1, FIELD)
    assert taken[int((440 - FIELD.x0) / 2), int((265 - FIELD.y0) / 2)]
    assert taken[int((300 - FIELD.x0) / 2), int((265 - FIELD.y0) / 2)]
    assert not taken[int((600 - FIELD.x0) / 2), int((265 - FIELD.y0) / 2)]


@pytest.mark.parametrize("width", [40.0, 60.0, 80.0, 100.0, 1e6])
def test_a_force_is_not_parted_from_its_value(width):
    text = "ΣM_p = F_1·56,38 + 68,67·19,52 − 15,65·1,029 = 0; F_1\u00a0= 278,51 Н"
    lines = broken(text, width, 3.5)
    assert " ".join(lines) == text.replace("\u00a0", " ")
    assert sum("F_1 = 278,51 Н" in line for line in lines) == 1


@pytest.mark.parametrize(("name", "lengths"), [
    ("transport/press@07-ЭПС-718", {"l_{AB}", "l_{BC}"}), ("loom", set()), ("lugansk/shaper", {"l_{AB}"}),
    ("tests/projects/visor.toml", {"l_{AB}", "l_{BC}", "l_{DF}"})])  # fmt: skip
def test_the_table_of_given_sizes_holds_what_the_task_gives(name, lengths):
    """Every number but zero, once, as it is in the mechanism; one that a synthesis has found has its letters too."""
    project = Project(read(name))
    rows = list(given_position.given_quantities(project))
    signs = [sign.split(", ")[0] for sign, _ in rows]
    assert lengths <= set(signs)
    assert len(rows) == len(set(rows))
    m = project.mechanism
    masses = [sign for sign in signs if re.match("[mG]_", sign)]  # or weights, as the task gives them
    assert bool(masses) == any(link.mass for link in m.links.values())
    assert not {"0", "−0"} & {value for _, value in rows}
    assert number(float(m.crank.length)) in {value for sign, value in rows if sign.endswith(", м")}
    for folds in given_position.links.folds:
        cells = listed.folded([["", ""], *map(list, rows)], folds)
        assert sum(cell != "" for line in cells for cell in line) == 2 * len(rows)


@pytest.mark.parametrize(("name", "least"), [("lugansk/shaper", 60.0), ("screen", 140.0), ("tests/projects/sieve.toml", None)])
def test_a_second_acceleration_plan_is_offered_where_its_letters_can_be_read(name, least):
    """Of a group of class III only large, of one with most points beside the pole not at all."""
    sizes = kinematics.second_accelerations_sizes(Project(read(name)), Canvas(), {})
    assert (min(high for _, high in sizes) > least) if least else not sizes
