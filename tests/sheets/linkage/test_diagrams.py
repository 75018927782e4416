"""Kinematic diagrams and balancing moment: what is drawn against formulas, and both sheets of six-bar tasks without crowding."""

from contextlib import nullcontext

import numpy as np
import pytest

from tests import project_files
from tests.few import few
from tests.project_files import EVEN, SLIDER, from_file, project
from tests.sheets.unlettered import unlettered
from tmm_sheets.box import Box
from tmm_sheets.catalogue import read
from tmm_sheets.construction.scale import handy
from tmm_sheets.drawing import placing
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.marks import Line, Polyline, Text
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.components import graphs
from tmm_sheets.sheets.linkage import diagrams
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import ViewPlace

BOX = Box(20.0, 10.0, 330.0, 240.0)


def curves(canvas, key):
    """Drawn curves of a graph with their axes as origin: angle axis and scale taken back, so (phi, value)."""
    scale = canvas.scales[key].mu
    axis = next(m for m in canvas.marks if isinstance(m, Line) and m.of == key and m.style == "axis" and m.a.imag == m.b.imag)
    found = [m.points - axis.a for m in canvas.marks if isinstance(m, Polyline) and m.of == key]
    length = found[0][-1].real
    return [(2 * np.pi * p.real / length, scale * p.imag) for p in found]


def drawn(project, view=diagrams.motion, **options):
    canvas = Canvas()
    view(project, canvas, BOX, options)
    return canvas


def test_sine_rocker_against_its_formulas():
    """Task 6: S = l3 sin psi with tan psi = r sin phi/(a + r cos phi), and its derivatives by a fine difference."""
    r, a, l3, w = 0.107, 0.054, 0.2, 20.9
    canvas = drawn(Project(read("sixbar/6:1")))

    def s(phi):
        return l3 * np.sin(np.arctan2(r * np.sin(phi), a + r * np.cos(phi)))

    h = 1e-4
    derivatives = {
        "graph-S": s,
        "graph-V": lambda x: w * (s(x + h) - s(x - h)) / (2 * h),
        "graph-a": lambda x: w * w * (s(x + h) - 2 * s(x) + s(x - h)) / h**2,
    }
    for key, f in derivatives.items():
        ((phi, value),) = curves(canvas, key)
        assert np.max(np.abs(value - f(phi))) < 1e-6 * np.max(np.abs(value))


def test_positive_is_the_way_the_motion_begins():
    """Task 10 begins downwards, task 5 to the left: both diagrams begin upwards."""
    for name in ("sixbar/10:1", "sixbar/5:1"):
        ((_, value),) = curves(drawn(Project(read(name))), "graph-S")
        assert value[0] == 0
        assert value[5] > 0


def test_rocker_has_its_angle():
    ((phi, value),) = curves(drawn(Project(read("sixbar/8:1"))), "graph-psi")
    r, l2, a = 0.129, 0.516, 0.4
    s = r * np.sin(phi) + np.sqrt(l2**2 - (r * np.cos(phi)) ** 2) - np.sqrt(l2**2 - r**2)
    assert np.max(np.abs(value + np.arctan(s / a))) < 1e-12  # a slider to the right under the pivot: clockwise


def test_a_link_turns_in_the_same_sense_in_every_table():
    """The screen's rocker begins clockwise: its angle goes below the axis, as its angular velocity does in the other tables."""
    project = Project(read("screen"))
    ((phi, value),) = curves(drawn(project, of=["3"]), "graph-psi")
    u = np.asarray(project.study.positions.directions["3"].value)
    assert value[5] < 0
    assert np.max(np.abs(np.exp(1j * np.interp(project.cycle.turned, phi, value)) - u / u[0])) < 1e-9
    study = project.study
    _, omega, epsilon = project.motion.link("3").at_positions
    assert np.array_equal(omega.value, study.velocities.omega["3"].value)
    assert np.array_equal(epsilon.value, study.accelerations.epsilon["3"].value)


def test_two_outputs_share_the_graphs():
    canvas = drawn(Project(read("sixbar/7:1")))
    (_, first), (_, second) = curves(canvas, "graph-S")
    assert first.max() == pytest.approx(0.1 + 0.4 - np.sqrt(0.4**2 - 0.1**2))
    assert second.max() == pytest.approx(0.2)
    assert {label.text for label in canvas.labels} >= {"S_{B}", "S_{C}", "V_{B}", "a_{C}"}


@pytest.mark.parametrize(("box", "columns"), [
    (Box(0, 0, 110, 260), 1), (Box(0, 0, 210, 170), 2), (Box(0, 0, 310, 110), 3)], ids=["upright", "square", "level"])  # fmt: skip
def test_graphs_stand_beside_each_other_where_only_so_they_reach_their_floors(box, columns):
    p = project(SLIDER, EVEN, {"cycle.diagrams": ["B"]})
    graphs_of = diagrams.motion_graphs(p, {})
    places = graphs.placed(p, graphs_of, box)
    assert len({place.box.x0 for place in places}) == columns
    for q, place, mu in places:
        assert mu == handy(mu)
        assert q.extent / mu >= q.floor == (60 if q.key == "graph-S" else 40)
        assert q.span / mu <= place.height - graphs.ABOVE - graphs.BELOW + 1e-6
    need = graphs.need(p, graphs_of)
    assert need.below(box.width + 1, box.height + 1) == 0.0
    assert need.below(box.width, 60.0) > 0.0


def test_a_graph_that_is_offered_is_as_high_as_its_floor_asks():
    p = Project(read("screen"))
    column = diagrams.balancing_graph(p)
    offered = graphs.CycleView(lambda p: "", lambda p, options: [column], wanted=((170.0, 20.0),))
    ((width, height),) = offered.sizes(p, Canvas(), {})
    ((q, _, mu),) = graphs.placed(p, [column], Box(0, 0, width, height))
    assert q.extent / mu >= 40.0


def test_option_names_others():
    canvas = drawn(Project(read("sixbar/7:1")), of=["5", "2", "C"])
    assert {"graph-S", "graph-psi"} <= set(canvas.scales)


def test_a_curved_path_is_refused():
    with pytest.raises(CannotBuild, match="point A does not move along a straight line"):
        drawn(Project(read("sixbar/1:1")), of=["A"])


def test_what_the_last_group_drives_is_drawn_unless_told():
    p = project(from_file("sixbar/1:1"), {"cycle.diagrams": None, "cycle.output": None, "cycle.working_sense": None,
                                        "force[1].sense": "+x"})
    assert p.diagrams == ("C",)
    assert drawn(p).scales == drawn(Project(read("sixbar/1:1"))).scales


def test_unknown_name_of_a_diagram():
    with pytest.raises(BadInput, match=r"cycle\.diagrams\[1\]: unknown point or link"):
        project(from_file("sixbar/1:1"), {"cycle.diagrams[1]": "K"})


def test_table_has_every_position():
    canvas = drawn(Project(read("sixbar/7:1")), diagrams.motion_table)
    texts = [m.text for m in canvas.marks if isinstance(m, Text)]
    assert {str(i) for i in range(24)} <= set(texts)
    assert len([t for t in texts if t.strip("−").replace(",", "").isdigit()]) == 24 * 7 + 2  # the squares of two units


@pytest.mark.parametrize(("of", "angle"), [("B", "θ"), ("2", "ψ")])
def test_the_angle_of_a_rod_has_one_name(of, angle):
    """Its inclination to the guide in the table, unless its diagram counts it from position 0."""
    own = project(project_files.merged(project_files.SLIDER, project_files.EVEN), {"cycle.diagrams": [of]})
    texts = [m.text for m in drawn(own, diagrams.motion_table, links=True).marks if isinstance(m, Text)]
    assert [text for text in texts if text in ("ψ", "θ")] == [angle]


def test_balancing_moment_has_two_ends_where_the_load_is_switched():
    """Task 8: just before the rocker's turning point M5 acts, just behind it does not; its power is zero there, M_ur joins."""
    project = Project(read("sixbar/8:1"))
    canvas = drawn(project, diagrams.balancing)
    ((phi, value),) = curves(canvas, "graph-M")
    at = np.interp(project.cycle.turned, phi, value)
    moments = -np.asarray(project.study.forces.balancing.value)
    assert np.max(np.abs(at - moments)) < 1e-6 * np.max(np.abs(moments))


def test_balancing_moment_needs_a_moment():
    with pytest.raises(CannotBuild, match="driven by a moment"):
        drawn(Project(read("lugansk/shaper")), diagrams.balancing)


def test_couple_of_a_guide_without_a_force_is_shown():
    """Task 10: nothing pushes slider 5 across its guide, a couple keeps it from turning."""
    canvas = Canvas()
    from tmm_sheets.sheets.linkage import kinetics

    kinetics.group(Project(read("sixbar/10:1")), canvas, Box(450.0, 300.0, 830.0, 580.0), {"group": 1})
    labels = [label.text for label in canvas.labels]
    assert "M_{50}" in labels
    assert "F̅_{50}" not in labels


@pytest.mark.parametrize("name", few((*(f"sixbar/{task}:{1 + task % 5}" for task in range(1, 11)), "sixbar/8:3"), "sixbar/8:3"))
def test_both_sheets_have_room(name):
    project = Project(read(name))
    for n in (1, 2):
        assert composed(project, n).crowded == ()


@pytest.mark.parametrize(("values", "said"), [
    ([-4.308, -4.258], ["−4,308", "−4,258"]), ([-991.1, -975.3], ["−991,1", "−975,3"]),
    ([-4865.8, -4800.0], ["−4865,8", "−4800,0"]),
    ([0.0, 0.0], ["0", "0"]), ([1e-3, -2e-3], ["0,001000", "−0,002000"])])  # fmt: skip
def test_two_numbers_said_to_differ_can_be_told_apart(values, said):
    assert graphs.column(values, 4, least=1) == said


@pytest.mark.parametrize("curves", [
    [], [np.array([0j, 100 + 0j])], [np.array([38 - 20j, 42 + 20j])],
    [np.array([30 - 20j, 50 + 20j]), np.array([58 - 20j, 62 + 20j])],
    [np.array([-5 - 9j, 105 + 9j])]], ids=["none", "along the axis", "one", "two", "flat"])  # fmt: skip
def test_numbers_of_positions_keep_off_the_curves_and_each_other(curves):
    canvas, x = Canvas(), np.array([0.0, 10.0, 20.0, 36.0, 40.0, 52.0, 60.0, 100.0])
    graphs.numbers(canvas, graphs.Graph(0j), x, [str(k + 9) for k in range(len(x))], np.where(x < 50, 1.0, -1.0))
    for curve in curves:
        canvas.polyline(curve)
    placing.set_numbers(canvas, InkIndex(canvas.marks))
    texts = [m for m in canvas.marks if isinstance(m, Text)]
    assert len(texts) == len(x)
    boxes = [Box.around(text_box(m)) for m in texts]
    for k, box in enumerate(boxes):
        assert not any(box.x0 < b.x1 and b.x0 < box.x1 and box.y0 < b.y1 and b.y0 < box.y1 for b in boxes[k + 1:])
    inner = [Box(b.x0 + 0.2, b.y0 + 0.2, b.x1 - 0.6, b.y1 - 0.2) for b in boxes[1:]]
    if len(curves) and np.ptp(curves[0].imag) != 18:  # a flat one that runs through all places is in the way of some
        points = np.concatenate([graphs.dense(curve) for curve in curves])
        assert not any((box.x0 < p.real < box.x1) and (box.y0 < p.imag < box.y1) for box in inner for p in points)


@pytest.mark.parametrize("sense", ["-x", "+x"])
def test_the_way_of_the_output_grows_with_its_axis(sense):
    """Both axes of the force over the path begin where the stroke begins, whichever way it goes."""
    own = project(project_files.SLIDER, project_files.WORKING, project_files.MASS, project_files.MOMENT, project_files.FORCE,
                  {"project.sheets": ["kinematics_forces"], "cycle.working_sense": sense, "force[1].sense": sense})
    marks = unlettered(own).marks
    up, along = (m for m in marks if isinstance(m, Line) and m.by and (m.by.role, m.by.step) == ("axis", "loads/F3"))
    (curve,) = (m for m in marks if isinstance(m, Polyline) and m.by and (m.by.role, m.by.step) == ("curve", "loads/F3"))
    begin, *_, end = np.real(curve.points)
    assert along.a == up.a
    assert up.a.real == pytest.approx(begin, abs=0.01)
    assert (along.b - along.a).real * (end - begin) > 0


@pytest.mark.parametrize(("name", "straight"), [("B", True), ("A", False), ("1", True), ("2", True), ("3", True)])
def test_check_refuses_the_diagram_of_a_point_that_goes_round(name, straight):
    asked = project(project_files.merged(project_files.SLIDER, project_files.EVEN), {"cycle.diagrams": [name]})
    with nullcontext() if straight else pytest.raises(CannotBuild, match="straight line"):
        asked.check()


@pytest.mark.parametrize("asked", [0.001, 3e-5])
def test_a_scale_factor_that_is_asked_for_is_refused_with_one_that_fits(asked):
    p = project(SLIDER, EVEN, {"cycle.diagrams": ["B"], "scales": {"graph-S": asked}})
    with pytest.raises(CannotBuild) as refused:
        diagrams.motion(p, Canvas(), Box(0, 0, 200, 230), {})
    fits = float(refused.value.hint.partition("scales.graph-S = ")[2].partition(",")[0])
    p = project(SLIDER, EVEN, {"cycle.diagrams": ["B"], "scales": {"graph-S": fits}})
    canvas = Canvas()
    diagrams.motion(p, canvas, Box(0, 0, 200, 230), {})
    assert canvas.scales["graph-S"].mu == fits


def test_an_output_that_does_not_move_is_refused_by_its_name_and_told_by_check():
    """The coupler of a parallelogram does not turn: psi, omega and epsilon of it are nothing but zero."""
    fixed = project(project_files.CRANK, EVEN, {
        "points": {"D": ["0.3 m", "0 m"]}, "cycle.diagrams": ["2"],
        "group": [{"kind": 1, "links": ["2", "3"], "outer": ["A", "D"], "inner": "C", "lengths": ["0.3 m", "0.1 m"],
                   "branch": "follow", "at": "90 deg"}]})  # fmt: skip
    with pytest.raises(CannotBuild, match=r"cycle\.diagrams: 2 does not turn or move .*\n.*name a point or link that moves"):
        drawn(fixed)
    (said,) = diagrams.motion_low(fixed, 1, ViewPlace("diagrams.motion", BOX, {}))
    assert str(said).startswith("2 does not turn or move")


@pytest.mark.parametrize("name", ["boom.toml"])
def test_behind_an_input_graphs_are_plotted_over_its_way(name):
    """The positions divide the stroke evenly; over the angle of the crank the boom itself would be a straight line."""
    own = project_files.known(name)
    places = own.abscissae(own.cycle.turned)
    start, end = own.mechanism.drive.place
    assert places == pytest.approx(np.linspace(0.0, abs(end - start), len(places)), abs=1e-9)


def test_behind_a_slider_too():
    drive = {"input": {"link": "3", "start": "0.46 m", "end": "0.34 m", "speed": "0.2 m/s", "side": 1}}
    own = project(project_files.HEAD, {k: v for k, v in SLIDER.items() if k != "crank"}, {
        "crank": {"link": "1", "pivot": "O", "pin": "A", "length": "0.1 m"}}, drive, {"cycle": {"start": "input", "positions": 6}})
    assert own.abscissae(own.cycle.turned) == pytest.approx(np.linspace(0.0, 0.12, 7), abs=1e-9)


def test_over_the_angle_of_a_crank_that_turns():
    own = project(SLIDER, EVEN)
    assert own.abscissae(own.cycle.turned) is own.cycle.turned
