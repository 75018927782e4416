"""Sheets of a reducer or a train alone: filled evenly, wheels drawn at both sides of the axis, numbers as they are measured."""

from functools import cache

import pytest

from tests.evenness import gap
from tests.few import few, seldom
from tests.project_files import project
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink_index import empty_cells
from tmm_sheets.drawing.marks import Arc, Box, Line, Text
from tmm_sheets.sheets.gears import train
from tmm_sheets.sheets.gears.train_scheme import TrainScheme, columns_of
from tmm_sheets.sheets.sheet import composed

REDUCER = {"simple": "none", "input_speed": "1450 rpm", "module": "3 mm", "satellites": 3}
MESHES = [{"sun": "1", "planet": "2", "carrier": "H"}, {"ring": "3", "planet": "2", "carrier": "H"}]
PROJECTS = {
    "sun drives": {"reducer": REDUCER | {"scheme": "single row", "output_speed": "250 rpm"}},
    "ring drives": {"reducer": REDUCER | {"scheme": "single row", "driver": "ring", "output_speed": "1000 rpm"}},
    "two suns": {"reducer": REDUCER | {"scheme": "two external", "ratio": 60, "satellites": 2}},
    "two rings": {"reducer": REDUCER | {"scheme": "two internal", "output_speed": "40 rpm", "satellites": 2}},
    "blocks": {"reducer": REDUCER | {"scheme": "external-internal", "output_speed": "120 rpm"}},
    "two stages": {"reducer": REDUCER | {"scheme": "single row", "stages": 2, "output_speed": "70 rpm"}},
    "pair before": {"reducer": REDUCER | {"scheme": "single row", "simple": "before", "output_speed": "100 rpm",
                                          "simple_module": "4 mm", "teeth": {"z1": 14}}},
    "planetary train": {"train": {"module": "4 mm", "teeth": {"1": 20, "2": 40, "3": 100}, "mesh": MESHES,
                                  "speeds": {"1": "960 rpm", "3": "0 rpm"}}},
    "shafts": {"train": {"module": "4 mm", "teeth": {"1": 20, "2": 40, "3": 25, "4": 35}, "speeds": {"1": "960 rpm"},
                         "shafts": [["2", "3"]], "mesh": [{"sun": "1", "planet": "2"}, {"sun": "4", "planet": "3"}]}},
    "one ring": {"train": {"module": "4 mm", "teeth": {"1": 20, "2": 60}, "speeds": {"1": "960 rpm"},
                           "mesh": [{"ring": "2", "planet": "1"}]}},
}


@cache
def drawn(name):
    own = project(PROJECTS[name])
    return own, composed(own, 1)


@pytest.mark.parametrize("name", [
    name if name in ("two rings", "planetary train") else seldom(name) for name in PROJECTS if name not in ("shafts", "one ring")])
def test_a_sheet_of_gears_alone_is_filled(name):
    _, sheet = drawn(name)
    assert empty_cells(sheet.drawing) <= 0.18
    empty = gap(sheet.drawing)
    assert min(empty.width, empty.height) < 100.0


@pytest.mark.parametrize("name", few(PROJECTS, "shafts", "two rings", "planetary train"))
def test_views_keep_their_places(name):
    _, sheet = drawn(name)
    assert [str(left) for left in sheet.leaving] == []
    assert [str(label) for label in sheet.crowded] == []


@pytest.mark.parametrize("name", ["sun drives", "two rings", "planetary train"])
def test_a_standing_ring_is_held_at_both_sides_of_the_axis_and_meshes_there(name):
    own, _ = drawn(name)
    canvas = Canvas()
    train = own.train if "train" in PROJECTS[name] else own.reducer
    views = TrainScheme(train)
    views.place(canvas, Box(24, 178, 642, 572), "scheme", "")
    views.axial()
    level = {round(m.a.imag - views.axis, 6) for m in canvas.marks if isinstance(m, Line) and abs((m.b - m.a).imag) < 1e-9}
    held = next(m for m in train.meshes if m.sign < 0 and train.stands(m.central))
    ring = train.radius(held.central, held)
    assert {round(views.mu.mm(side * ring), 6) for side in (1, -1)} <= level  # rims of the ring and of the satellites
    assert {round(views.mu.mm(side * ring) + 6 * side, 6) for side in (1, -1)} <= level  # where it is held


@pytest.mark.parametrize(("name", "columns"), [
    ("sun drives", "1-2 3-2, H"), ("ring drives", "3-2 1-2, H"), ("blocks", "1-2, 4-3, H"), ("two suns", "H, 4-3, 1-2"),
    ("two stages", "1-2 3-2, H1, 4-5 6-5, H2"), ("pair before", "2-1, 3-4 5-4, H"), ("shafts", "1-2, 4-3"),
])
def test_columns_follow_the_power(name, columns):
    """No shaft passes through a wheel: the carrier stands where its shaft leads to, what is held in the frame beside it."""
    own = project(PROJECTS[name])
    found, _ = columns_of(own.train if "train" in PROJECTS[name] else own.reducer)
    assert ", ".join(edge.carrier or " ".join(f"{m.central}-{m.planet}" for m in edge.meshes) for edge in found) == columns


def test_a_planet_alone_on_its_carrier_is_drawn_once():
    own = project({"train": {"module": "2 mm", "teeth": {"1": 100, "2": 20, "3": 101}, "speeds": {"1": "0 rpm", "H": "60 rpm"},
                             "mesh": [{"sun": "1", "planet": "2", "carrier": "H"}, {"sun": "3", "planet": "2", "carrier": "H"}]}})
    assert TrainScheme(own.train).sides("2") == (1,)


def test_wheels_as_wide_as_the_end_view_needs():
    """A wheel beside the main axis that is the largest stood out of the view's place, over the tables."""
    own, _ = drawn("shafts")
    assert TrainScheme(own.train).side == pytest.approx(0.08)


def test_sizes_of_wheels_without_shift():
    own, _ = drawn("sun drives")
    sun, planet, ring = own.reducer.data.teeth.values()
    assert train.rows(own.reducer)[1:] == [
        [name, str(z), *(f"{3 * (z + over):g}".replace(".", ",") for over in (0, tip, root))]
        for name, z, tip, root in (("1", sun, 2, -2.5), ("2", planet, 2, -2.5), ("3", ring, -2, 2.5))]


def test_ratios_of_pairs_and_of_their_chain():
    own, _ = drawn("shafts")
    assert list(train.meshing_pairs(own.train)) == [
        "i_{12} = n_{1}/n_{2} = 960/(−480) = −2;  −z_{2}/z_{1} = −40/20 = −2",
        "i_{34} = n_{3}/n_{4} = −480/342,9 = −1,4;  −z_{4}/z_{3} = −35/25 = −1,4", "i_{14} = i_{12}·i_{34} = 40·35/(20·25) = 2,8"]


def test_a_measured_ratio_is_that_of_the_lengths_it_is_written_with():
    _, sheet = drawn("shafts")
    texts = "".join(m.text for m in sheet.drawing.marks if isinstance(m, Text) and m.of == "plan_checks.of_train")
    assert "384,0/137,1 = 2,801" in texts


def stages(*teeth):
    """Planetary stages one after another, the ring of each held: sun, planet and ring by their teeth."""
    names = [[f"{3 * k + n}" for n in (1, 2, 3)] for k in range(len(teeth))]
    meshes = [{part: wheel, "planet": planet, "carrier": f"H{k}"} for k, (sun, planet, ring) in enumerate(names, 1)
              for part, wheel in (("sun", sun), ("ring", ring))]
    return project({"train": {
        "module": "2 mm", "teeth": {name: z for own, of in zip(names, teeth, strict=True) for name, z in zip(own, of, strict=True)},
        "speeds": {"1": "1440 rpm"} | {ring: "0 rpm" for *_, ring in names}, "mesh": meshes,
        "shafts": [[f"H{k}", f"{3 * k + 1}"] for k in range(1, len(teeth))]}})  # fmt: skip


def rings(own):
    """Middles and radii of the circles drawn with a thick line: the rings, which stand."""
    marks = composed(own, 1).drawing.marks
    return sorted({(round(m.centre.real, 3), round(m.centre.imag, 3), round(m.radius, 3)) for m in marks
                   if isinstance(m, Arc) and m.style == "main" and m.by.role == "symbol" and m.radius > 20.0})


def test_end_views_of_unlike_stages_stand_side_by_side_to_one_scale():
    found = rings(stages((24, 30, 84), (18, 27, 72), (20, 25, 70)))
    assert [radius for *_, radius in sorted(found, key=lambda ring: -ring[2])] == pytest.approx([84.0, 72.0, 70.0])
    for i, (x, y, radius) in enumerate(found):
        for other_x, other_y, other in found[:i]:
            assert abs(complex(x - other_x, y - other_y)) > radius + other


def test_stages_alike_have_one_end_view():
    assert len(rings(stages((24, 30, 84), (24, 30, 84)))) == 1


@pytest.mark.parametrize(("own", "signs"), [
    (lambda: stages((24, 30, 84), (18, 27, 72)), [("1", -1, "n_{вх}"), ("H2", 1, "n_{вых}")]),
    (lambda: project(PROJECTS["shafts"]), [("1", -1, "n_{вх}"), ("4", 1, "n_{вых}")]),
    (lambda: project({"train": PROJECTS["planetary train"]["train"] | {"speeds": {"1": "960 rpm", "3": "20 rpm"}}}),
     [("1", -1, "n_{1}"), ("H", 1, "n_{вых}")]),
    (lambda: project(PROJECTS["sun drives"]), [("1", -1, "n_{вх}"), ("H", 1, "n_{вых}")]),
])
def test_shafts_that_lead_in_and_out_are_marked(own, signs):
    opened = own()
    assert [*TrainScheme(opened.train if "train" in opened.parts else opened.reducer).leading()] == signs


def test_a_reducer_beside_a_train_has_its_own_plan_and_tables():
    """Its sheet asked for the plan of the train's speeds, which stands on another sheet."""
    own = project({**PROJECTS["sun drives"], **PROJECTS["shafts"], "project.sheets": ["train", "reducer"]})
    alone = project(PROJECTS["sun drives"])
    texts = [{m.text for m in composed(one, n).drawing.marks if isinstance(m, Text) and m.of != "title block"}
             for one, n in ((own, 2), (alone, 1))]
    assert texts[0] == texts[1]
