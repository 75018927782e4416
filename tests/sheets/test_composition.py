"""Places of views: what lies gets a wide place, what stands a high one; what is left out gives its room away; always the same."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests import project_files as files
from tests.sheets.unlettered import unlettered, words
from tmm_sheets import catalogue, kept
from tmm_sheets.box import Box
from tmm_sheets.construction.scale import HANDY, handy
from tmm_sheets.drawing.marks import Arc
from tmm_sheets.project import Project
from tmm_sheets.sheets import composition
from tmm_sheets.sheets.border_solver import (
    SHOWN,
    BorderNode,
    Figure,
    FigureNode,
    Form,
    Need,
    cut,
    joined,
    rounded_down,
    rounded_up,
    solve,
)
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.composing import INSIDE
from tmm_sheets.sheets.composition import TITLE_BLOCK, arranged
from tmm_sheets.sheets.linkage import diagrams, friction, kinematic_frames, kinetic_frames, link_marks
from tmm_sheets.sheets.linkage.kinetics import OF_FORCE
from tmm_sheets.sheets.player import once
from tmm_sheets.sheets.views import arrangement
from tmm_sheets.words import on_paper, paper

ROOM = Box(0.0, 0.0, 400.0, 300.0)


def leaves(*needs):
    return [BorderNode(need, area=60000.0) for need in needs]


def drawn(need, box):
    """Size on paper at the factor of the series that fits."""
    mu = handy(max(s / (room - a) for s, room, a in zip(need.span, (box.width, box.height), need.around, strict=True)))
    return [s / mu + a for s, a in zip(need.span, need.around, strict=True)]


@pytest.mark.parametrize("power", [-50, -16, 0, 15, 50])
@pytest.mark.parametrize("least", [1.01, 0.0999, 1.0, 1.5000000001, 7.99, 8.01, 123.0])
def test_the_quick_series_is_the_series(least, power):
    mu = least * 10.0 ** power
    assert rounded_up(mu) == pytest.approx(handy(mu), rel=1e-12)
    assert rounded_down(mu) <= mu * (1 + 1e-9)
    assert rounded_up(rounded_down(mu)) == rounded_down(mu)
    assert mu < 1.5 * rounded_down(mu)


def test_no_two_factors_are_far_apart():
    series = np.array([*HANDY, 10.0])
    assert (series[1:] / series[:-1]).max() <= 1.5


def test_what_lies_gets_a_wide_place_and_what_stands_a_high_one():
    """Two views in equal columns or rows; of the common side the one needs little, the other much."""
    for axis in (0, 1):
        flat, square = ((1.0, 6.0), (3.0, 3.0)) if axis == 0 else ((6.0, 1.0), (3.0, 3.0))
        tree = joined(axis, leaves(Need(flat, (20.0, 20.0)), Need(square, (20.0, 20.0))), [1.0, 1.0])
        found = solve(tree, ROOM)
        sizes = [box.height if axis else box.width for box in (found[0], found[1])]
        assert sizes[1] > 1.5 * sizes[0]


def test_places_do_not_overlap_and_fill_the_room():
    column = joined(1, leaves(Need((2.0, 1.0)), Need((1.0, 2.0))), [1, 1])
    tree = joined(0, [column, BorderNode(Need(), area=40000.0)], [1, 1])
    boxes = solve(tree, ROOM)
    assert len(boxes) == 3
    for i, a in enumerate(boxes):
        assert INSIDE.width > a.width > 0 < a.height
        assert all(a.x1 <= b.x0 or b.x1 <= a.x0 or a.y1 <= b.y0 or b.y1 <= a.y0 for b in boxes[i + 1:])
    assert (min(b.x0 for b in boxes), max(b.x1 for b in boxes)) == (ROOM.x0, ROOM.x1)
    assert (min(b.y0 for b in boxes), max(b.y1 for b in boxes)) == (ROOM.y0, ROOM.y1)


def test_least_sizes_are_kept():
    tree = joined(0, leaves(Need((5.0, 1.0), least=(60.0, 40.0)), Need(least=(150.0, 40.0))), [1.0, 1.0])
    assert solve(tree, ROOM)[1].width >= 150.0


def test_what_has_nothing_to_draw_gives_its_room_away():
    """A force plan of no length: only its heading is left."""
    tree = joined(1, leaves(Need((0.0, 0.0), (24.0, 43.0), (80.0, 43.0)), Need((3.0, 4.0), (20.0, 20.0))), [1.0, 1.0])
    found = solve(tree, ROOM)
    assert 43.0 <= found[0].height < 60.0


def test_what_lies_over_a_place_is_not_its_own():
    """Under the designation, 40 mm high, a view has what it would have in a place as much lower."""
    free, covered = Need((4.0, 3.0), (20.0, 20.0)), Need((4.0, 3.0), (20.0, 20.0), covered=40.0)
    assert covered.ink(300.0, 240.0) == free.ink(300.0, 200.0) < free.ink(300.0, 240.0)
    assert covered.short(300.0, 79.0) > 0 == covered.short(300.0, 80.0)


@pytest.mark.parametrize("name", ["sixbar/6:1", "sixbar/10:1", "lugansk/shaper", "lugansk/engine", "transport/press@07-ЭПС-718"])
def test_the_position_plans_fill_their_place(name):
    """They stand in the corner of the turned designation: the solver knows what that leaves."""
    project = Project(catalogue.read(name))
    view = next(v for v in arranged(project, 1).views if v.draw == "kinematics.position_plans")
    frame = kinematic_frames.positions(project, SimpleNamespace(scales={}, chosen=set()), view.box, view.options)
    z, d = kinematic_frames.positions_reach(project)
    left, below, right, above = kinematic_frames.positions_figure(project, view.options).inset
    on_paper = z / frame.scale.mu + d
    drawn = (np.ptp(on_paper.real) + left + right) * (np.ptp(on_paper.imag) + below + above)
    assert drawn > 0.6 * view.box.width * view.box.height


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (2, 2), (4, 2), (7, 3)])
def test_pairs_with_friction_stand_where_their_journals_are_largest(count, columns):
    """In a place about as high as wide; where none fits the least room is said."""
    assert friction.grid(count, 400.0, 418.0)[0] == columns
    assert friction.grid(count, 40.0, 60.0) == (1, friction.LEAST)


FIGURE = Need((2.0, 1.0), (10.0, 10.0), least=(40.0, 30.0))
WIDE, LOW, NARROW = Form(300.0, 20.0), Form(100.0, 20.0), Form(50.0, 40.0, 1.2)


@pytest.mark.parametrize(("forms", "room", "under"), [
    ((), (200.0, 150.0), 0.0),
    ((LOW,), (200.0, 150.0), 20.0),
    ((WIDE,), (200.0, 150.0), 0.0),  # wider than the place
    ((WIDE, LOW), (200.0, 150.0), 20.0),
    ((LOW, NARROW), (200.0, 150.0), 20.0),  # both have room: the cheaper
    ((LOW, NARROW), (60.0, 150.0), 40.0),
    ((LOW,), (100.0, 150.0), 0.0),  # no wider than the place is too narrow, one more is room
    ((LOW,), (101.0, 150.0), 20.0),
    ((LOW,), (200.0, 40.0), 0.0),  # the figure would be smaller than it is read
    ((LOW,), (30.0, 20.0), 0.0),  # it is, all the same
])
def test_what_is_read_with_a_figure_takes_room_under_it(forms, room, under):
    """In the form that makes the figure cost least; left out where none leaves the figure the size at which it is read."""
    whole, text = leaves(FIGURE, Need(least=(0.0, 0.0)))
    node, place = FigureNode(children=[whole, text], forms=forms), Box(0.0, 0.0, *room)
    figure, below = node.places(place)[0], node.places(place)[1]
    assert figure.y0 - below.y1 >= 3.0
    assert (below.height >= under) if under else (below.height < 3.0)
    left_out = FigureNode(children=leaves(FIGURE, Need(least=(0.0, 0.0))))
    assert (node.cost(*room) < left_out.cost(*room)) is bool(under)


@pytest.mark.parametrize(("width", "beside"), [(200.0, True), (90.0, False), (56.0, False)])
def test_what_stands_beside_a_figure_takes_width_alone(width, beside):
    node = FigureNode(children=leaves(FIGURE), forms=(Form(55.0, 100.0, beside=True),), without=5.0)
    figure = node.places(Box(0.0, 0.0, width, 150.0))[0]
    assert figure.height == 150.0
    assert figure.width == (width - 56.0 if beside else width)


def test_one_view_has_the_whole_room():
    assert solve(leaves(Need((1.0, 1.0)))[0], ROOM) == [ROOM]


def test_boxes_are_cut_into_rows_and_columns():
    boxes = [Box(0, 0, 10, 30), Box(14, 16, 30, 30), Box(14, 0, 30, 12)]
    parts = leaves(Need(), Need(), Need())
    tree = cut(boxes, parts)
    assert (tree.axis, len(tree.children), tree.children[1].axis, tree.gap) == (0, 2, 1, 4.0)
    assert tree.children[0] is parts[0]
    assert all(a is b for a, b in zip(tree.children[1].children, parts[1:], strict=True))


def test_a_whirl_of_boxes_is_left_as_it_is():
    whirl = [Box(0, 0, 20, 10), Box(20, 0, 30, 20), Box(10, 20, 30, 30), Box(0, 10, 10, 30), Box(10, 10, 20, 20)]
    assert cut(whirl, leaves(*[Need()] * 5)) is None


def test_a_lying_mechanism_has_a_wide_place_and_a_standing_one_a_high_one():
    """Task 8:3 lies, 1.6 times as wide as high; the rocker of 4:3 stands."""
    for name, wide in (("sixbar/8:3", True), ("sixbar/4:3", False)):
        box = next(v.box for v in arranged(Project(catalogue.read(name)), 1).views if v.draw == "kinematics.position_plans")
        assert (box.width > 1.3 * box.height) == wide


@pytest.mark.parametrize("name", ["sixbar/8:3", "sixbar/1:1", "lugansk/shaper", "transport/press@05-ЭПС-123", "press"])
def test_the_next_larger_scale_would_not_fit(name):
    """The position plans at the next smaller factor of the series come out of their place."""
    project = Project(catalogue.read(name))
    view = next(v for v in arranged(project, 1).views if v.draw == "kinematics.position_plans")
    frame = kinematic_frames.positions(project, SimpleNamespace(scales={}, chosen=set()), view.box, view.options)
    before = max(float(f"{m}e{k}") for m in HANDY for k in range(-6, 1) if float(f"{m}e{k}") < frame.scale.mu * (1 - 1e-9))
    z, d = kinematic_frames.positions_reach(project)
    left, below, right, above = kinematic_frames.positions_figure(project, view.options).inset
    for mu, fits in ((frame.scale.mu, True), (before, False)):
        on_paper = z / mu + d
        inside = np.ptp(on_paper.real) <= view.box.width - left - right + 1e-9 and \
            np.ptp(on_paper.imag) <= view.box.height - below - above + 1e-9
        assert inside == fits


@pytest.mark.parametrize("name", ["sixbar/8:3", "sixbar/10:5", "lugansk/shaper", "transport/crusher@12-СДМ-1908", "press"])
def test_places_stay_inside_the_frame_apart_and_off_the_title_block(name):
    project = Project(catalogue.read(name))
    for n in range(1, len(project.sheets) + 1):
        views = arranged(project, n).views
        parts = [box for v in views for box in v.options.get("places", [v.box])]
        for i, box in enumerate(parts):
            assert INSIDE.x0 <= box.x0 < box.x1 <= INSIDE.x1
            assert INSIDE.y0 <= box.y0 < box.y1 <= INSIDE.y1
            if views[0].draw.startswith("kinematics") and "axis" not in str([v.options for v in views]):
                for other in [*parts[i + 1:], TITLE_BLOCK]:
                    assert box.x1 <= other.x0 or other.x1 <= box.x0 or box.y1 <= other.y0 or other.y1 <= box.y0


@pytest.mark.parametrize(("name", "upright"), [("sixbar/4:1", True), ("sixbar/8:3", False)])
def test_of_several_ways_that_is_taken_in_which_the_views_fill_most(name, upright):
    """The two-armed rocker of task 4 is 2.7 times as high as wide: it stands from top to bottom; task 8 lies."""
    project = Project(catalogue.read(name))
    taken = arranged(project, 1)
    assert all({v.draw for v in taken.views} == {v.draw for v in way.views} for way in arrangement("sixbar_1").ways())
    box = next(v.box for v in taken.views if v.draw == "kinematics.position_plans")
    assert (box.height > 500.0) == upright


def test_what_a_view_does_not_name_stays_in_another_way():
    """Groups side by side, the plans above all else of the kinematics, or both."""
    first, *others = arrangement("transport_1").ways()
    moved = [{a.draw for a, b in zip(first.views, other.views, strict=True) if a.box != b.box} for other in others]
    wide = {"kinematics.position_plans", "diagrams.motion", "kinematics.velocity_plans", "kinematics.acceleration_plan",
            "kinetics.lever"}
    assert sorted(moved, key=len) == [{"kinetics.group"}, wide, wide, wide | {"kinetics.group"}, wide | {"kinetics.group"}]
    assert all([a.options for a in first.views] == [b.options for b in other.views] for other in others)


@pytest.mark.parametrize(("name", "mu"), [("transport/press@03-ЭПС-256", 0.003), ("transport/diesel@01-Т-27", 0.0025),
                                          ("transport/compressor@11-В-145", 0.002), ("sixbar/8:5", 0.006)])
def test_diagrams_take_nothing_from_the_plans(name, mu):
    """Mechanisms that lie, as large as on sheets without diagrams of motion; velocity plans with vectors of 30 to 100 mm, the
    lever, on which all forces hang, not smaller."""
    project, kept = Project(catalogue.read(name)), SimpleNamespace(scales={}, chosen=set())
    views = {v.draw: v for v in arranged(project, 1).views}
    kinematic_frames.positions(project, kept, views["kinematics.position_plans"].box, views["kinematics.position_plans"].options)
    assert kept.scales["positions"].mu <= mu * (1 + 1e-9)
    plans = views["kinematics.velocity_plans"]
    kinematic_frames.velocities(project, kept, plans.box, plans.options)
    velocities, i = project.study.velocities.plan, project.force_index
    vectors = [abs(complex(s.head.at(i)) - complex(s.tail.at(i))) / kept.scales["velocities"].mu for s in velocities.segments]
    assert 30.0 <= max(vectors) <= 100.0
    assert all(found.size >= max(80.0, *vectors) for found in composition.lever(project, 1, views["kinetics.lever"]))


def test_an_output_that_turns_has_the_diagrams_of_its_link():
    """Point C of the crusher's jaw goes along an arc about E: the angle of link 5 is drawn, not a way."""
    project = Project(catalogue.read("transport/crusher@12-СДМ-1908"))
    assert project.variant.cycle.output == "C"
    assert project.diagrams == ("5",)
    points = project.study.positions.points
    assert np.ptp(np.abs(points["C"].value - points["E"].value)) < 1e-9
    assert Project(catalogue.read("transport/press@05-ЭПС-123")).diagrams == ("C",)


def test_an_output_between_two_guides_has_the_diagrams_of_its_point():
    """The feeder's slider goes up and down a fixed column, driven through a slot: its angle never changes."""
    project = Project(catalogue.read("tests/projects/feeder.toml"))
    assert project.diagrams == ("E",)
    assert np.ptp(project.study.positions.points["E"].value.real) < 1e-12


def test_what_a_group_of_class_three_drives():
    """The last of its legs that is held in the frame, not the rod on the crank; of one that slides in the frame the point."""
    project = Project(catalogue.read("loom"))
    project.__dict__["_section"] = lambda name: SimpleNamespace(diagrams=(), output=None)
    assert project.diagrams == ("7",)
    triad = project.mechanism.groups[0]
    rod, slider, rocker = triad.legs
    alone = {("3", "2", "4", "5"): (rod, slider, rocker), ("3", "2", "5", "4"): (rod, rocker, slider)}
    for (links, legs), driven in zip(alone.items(), ("5", "D"), strict=True):
        project.__dict__["mechanism"] = replace(project.mechanism, groups=(replace(triad, links=links, legs=legs),))
        assert project.diagrams == (driven,)


@pytest.mark.parametrize("name", ["sixbar/7:2", "sixbar/8:3"])  # of thirteen columns and of seven
def test_a_table_of_motion_has_room_for_its_numbers(name):
    project = Project(catalogue.read(name))
    view = next(view for view in arranged(project, 1).views if view.draw == "diagrams.motion_table")
    assert sum(listed.needs(diagrams.motion_table.of(project, view.options)[1], 2.5)) <= view.box.width


def test_the_same_project_has_the_same_places(tmp_path, monkeypatch):
    """Found, and read where the first one kept it."""
    monkeypatch.setenv(kept.FOLDER, str(tmp_path))
    one, other = (arranged(Project(catalogue.read("lugansk/shaper")), 1).views for _ in range(2))
    assert one == other
    assert list(tmp_path.iterdir())


def test_a_view_left_out_gives_its_room_to_its_neighbours():
    """A project of lengths alone has no forces and no synthesis: what stands instead of them fills the sheet all the same."""
    project = files.project(files.FOUR_BAR, files.EVEN)
    plan = arranged(project, 1)
    assert not any(v.draw.startswith(("kinetics", "synthesis")) for v in plan.views)
    area = sum(v.box.width * v.box.height for v in plan.views)
    assert area > 0.9 * ((832.0 - 25.0) * (586.0 - 8.0) - TITLE_BLOCK.width * TITLE_BLOCK.height)


def test_a_crank_that_swings_has_the_arc_it_goes_through():
    """No full circle stands on its sheets, and the room of one is not kept: the plans come out larger."""
    project = Project(catalogue.read("tests/projects/visor.toml"))
    found = unlettered(project, 2)
    way = [m for m in found.marks if isinstance(m, Arc) and m.by and m.by[:2] == ("construction", "positions/B")]
    assert len(way) == 1
    radius = 0.12 / found.scales["positions"].mu
    assert way[0].radius == pytest.approx(radius)
    assert np.degrees(way[0].end - way[0].start) == pytest.approx(60 + 2 * np.degrees(5 / radius))
    assert found.scales["positions"].mu == pytest.approx(0.0008)
    assert np.degrees(way[0].start + way[0].end) / 2 == pytest.approx(80)


def test_a_traced_point_is_drawn_as_a_point_of_its_link():
    """A coupler point that nothing hangs on: lines of its link lead to it, its mark is no hinge."""
    point = {"point": [{"name": "E", "link": "2", "from": "A", "towards": "B", "distance": "0.15 m", "angle": "40 deg"}]}
    project = files.project(files.FOUR_BAR, point, files.EVEN)
    positions = project.study.positions
    shape = next(s for s in link_marks.shapes(positions) if s.link == "2")
    assert set(shape.bar) == {"A", "B", "E"}
    assert link_marks.traced(project.mechanism, "2") == ["E"]
    marks = unlettered(project).marks
    circles = {m.by.step for m in marks if isinstance(m, Arc) and m.style == "main" and m.by and m.by.role == "symbol"}
    assert "positions/B" in circles
    assert "positions/E" not in circles


def test_a_fixed_point_that_carries_nothing_is_no_part_of_the_mechanism():
    """It has no letter and takes no room: the plans are as large as without it."""
    far = {"points": {"O": ["0 m", "0 m"], "C": ["0.42 m", "0.05 m"], "P": ["3 m", "-2 m"]}}
    one, other = (unlettered(files.project(files.FOUR_BAR, *more, files.EVEN)) for more in ([], [far]))
    assert one.scales["positions"].mu == other.scales["positions"].mu
    assert "P" not in words(other)


def test_letters_that_take_the_place_ask_for_more_of_it():
    """A link of 0.3 m with 54 mm of arrows and letters about it in 56 mm: 2 mm of it would be drawn."""
    ends, offsets = np.array([0j, 0.3j]), np.array([-27j, 27j])
    figure = Figure("", "", "", ends, offsets, (0.0, 20.0, 0.0, 20.0))
    tight, roomy = (figure.need(Box(0.0, 0.0, 200.0, high), (60.0, 40.0)) for high in (96.0, 200.0))
    assert tight.least[1] == pytest.approx(40.0 + 54.0 + SHOWN)
    assert roomy.least[1] == pytest.approx(tight.least[1])
    assert tight.least[0] == roomy.least[0] == 60.0


def test_a_scheme_has_room_for_its_forces_along_its_links():
    """The two-armed rocker of 0.39 m with five forces, its upper arm that of a force alone: it stood 26 mm long on the sheet."""
    project = Project(catalogue.read("sixbar/4:5"))
    place = next(v.options["places"][0] for v in arranged(project, 1).views if v.options.get("group") == 2)
    scheme = kinetic_frames.scheme(project, project.mechanism.groups[0], project.force_index)
    frame = scheme.frame(project, SimpleNamespace(scales={}, chosen=set()), place)
    assert scheme.forces == 5
    assert frame.scale.mm(scheme.size) > scheme.forces * OF_FORCE


@pytest.mark.parametrize(("name", "count"), [("pump", 1), ("feeder", 2), ("planer", 3)])
@pytest.mark.parametrize("sheet", ["press_2", "sixbar_1", "engine_1", "transport_1"])  # made for one group, the others for two
def test_every_group_is_drawn_whatever_number_the_sheet_is_made_for(sheet, name, count):
    shown = arranged(files.project(files.from_file(f"tests/projects/{name}.toml"), {"project.sheets": [sheet]}), 1).views
    assert sorted(view.options["group"] for view in shown if view.draw == "kinetics.group") == [*range(1, count + 1)]


@pytest.mark.parametrize("room", [(200.0, 150.0), (60.0, 150.0), (30.0, 20.0)])
def test_a_figure_that_costs_too_much_whole_is_not_tried_with_its_texts(room):
    """Up to a limit it costs the same; from there on it is told to cost that at least."""
    def node():
        return FigureNode(children=leaves(FIGURE, Need(least=(0.0, 0.0))), forms=(LOW, NARROW))

    cost = node().cost(*room)
    assert node().cost(*room, 2 * cost) == cost
    dear = node()
    assert dear.cost(*room, 0.0) >= 0.0
    assert not dear.tried
    assert dear.cost(*room) == cost


def test_ways_of_a_sheet_share_what_places_cost_and_move_their_own_borders():
    tree = joined(0, leaves(Need((5.0, 1.0)), Need((1.0, 5.0))), [1.0, 1.0])
    other = tree.again()
    places = solve(tree, ROOM)
    assert [node.tried is own.tried for node, own in zip(other.every(), tree.every(), strict=True)] == [False, True, True]
    assert other.shares == [0.5, 0.5] != tree.shares
    assert solve(other, ROOM) == places


def test_what_a_project_has_found_is_found_once_in_each_language():
    asked = []

    @once
    def double(of, number, more=0):
        asked.append(paper())
        return 2 * number + more

    project = SimpleNamespace()
    assert [double(project, 2), double(project, 2), double(project, 3), double(project, 3, more=1)] == [4, 4, 6, 7]
    with on_paper("uk" if paper() != "uk" else "ru"):
        assert double(project, 2) == 4
    assert double(SimpleNamespace(), 2) == 4
    assert len(asked) == 5
