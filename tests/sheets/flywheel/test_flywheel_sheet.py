"""Sheet 2 as marks: everything in its place, projected points where both graphs say."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from tests import project_files
from tests.methods.linkage.shaper_truth import Shaper
from tests.sheets.unlettered import unlettered, words
from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Line, Polyline, Text, flat
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.flywheel.wheel_methods import flywheel
from tmm_sheets.project import Project
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.flywheel.flywheel import apart, constant_moment, force_graph
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import arrangement, function
from tmm_sheets.task import variant

VIEWS = tomllib.loads((Path(__file__).parents[3] / "templates/sheets/flywheel.toml").read_text(encoding="utf-8"))["view"]
FRAME = Box(20, 5, 836, 589)
TITLE_BLOCK = Box(651, 5, 836, 60)
DESIGNATION = Box(20, 575, 90, 589)


@dataclass(frozen=True)
class Cutting(Shaper):
    breaks: tuple[float, ...] = (0.31, 3.44)


@dataclass(frozen=True)
class Engine(Shaper):
    resisting: bool = False
    omega1: float = 40.0

    def moment(self, phi, side=1):
        return -super().moment(phi, side)


def project(reduced, form="rim"):
    data = SimpleNamespace(
        method="wittenbauer", delta=0.025, form=form, density=7300.0, width_ratio=0.2, thickness_ratio=0.12,
        rim_share=1.0, motor=None, inertia=None, efficiency=None, weights=False)
    return SimpleNamespace(flywheel=flywheel(reduced, data), reduced=reduced, variant=SimpleNamespace(friction=None))


COLUMN = ("force_graph", "moments", "works")


def views(p):
    return apart(p, arrangement("flywheel")).views


def draw(p, only=None):
    canvas = Canvas()
    wanted = "column" if only in COLUMN else only
    for view in views(p):
        if wanted in (None, view.draw.partition(".")[2]):
            function(view.draw)(p, canvas, view.box, view.options)
    if only in COLUMN:
        k = next(k for k, part in enumerate(canvas.parts) if part.draw == f"flywheel.{only}")
        end = canvas.parts[k + 1].first if k + 1 < len(canvas.parts) else len(canvas.marks)
        canvas.marks[:] = canvas.marks[canvas.parts[k].first:end]
    return canvas


def option(name, key):
    wanted = f"flywheel.{'column' if name in COLUMN else name}"
    view = next(view for view in views(project(Shaper())) if view.draw == wanted)
    return view.box if key == "box" else view.options[key]


def reach(marks):
    return np.concatenate([text_box(m) if isinstance(m, Text) else flat(m) for m in marks])


@pytest.mark.parametrize(("reduced", "form"), [
    (Shaper(), "rim"), (Shaper(8), "disc"), (Shaper(12), "rim"), (Cutting(12), "rim"), (Engine(16), "disc")])
def test_every_label_finds_a_place_and_nothing_leaves_the_frame(reduced, form):
    canvas = draw(project(reduced, form))
    assert place(canvas, FRAME) == []
    points = reach(canvas.marks)
    assert not np.isnan(points).any()
    assert points.real.min() > FRAME.x0
    assert points.real.max() < FRAME.x1
    assert points.imag.min() > FRAME.y0
    assert points.imag.max() < FRAME.y1
    assert not any(TITLE_BLOCK.contains(p) or DESIGNATION.contains(p) for p in points)


@pytest.mark.parametrize("name", [v["draw"].split(".")[1] for v in VIEWS])
def test_a_view_keeps_to_its_place(name):
    canvas = draw(project(Shaper()), only=name)
    box = Box(*option(name, "box"))
    if name == "energy_mass":  # its projection lines start in the graphs of dE and J
        box = Box(option("total_work", "box")[0], box.y0, box.x1, option("inertia", "box")[3])
    outside = [p for p in reach(canvas.marks) if not box.contains(p, 1e-6)]
    assert outside == []


def test_positions_stand_one_under_another():
    p = project(Shaper())
    x = option("moments", "axis") + p.flywheel.scales.angle.mm(p.reduced.phi)
    for name in ("force_graph", "moments", "works", "total_work"):
        marks = draw(p, only=name).marks
        ticks = sorted(m.a.real for m in marks if isinstance(m, Line) and m.style == "axis" and abs(m.b - m.a) < 2)
        np.testing.assert_allclose(ticks, x, atol=1e-9)


def test_every_point_of_the_energy_mass_curve_is_projected_from_both_graphs():
    p = project(Shaper())
    f = p.flywheel
    marks = draw(p, only="energy_mass").marks
    lines = [m for m in marks if isinstance(m, Line) and m.style == "construction"]
    curves = {name: [m.points for m in draw(p, only=name).marks if isinstance(m, Polyline)]
              for name in ("total_work", "inertia", "energy_mass")}
    assert [len(c) for c in curves.values()] == [1, 1, 1]
    assert len(lines) == 2 * 10
    for k in range(10):
        across, down = lines[2 * k], lines[2 * k + 1]
        assert across.b == down.b
        assert across.a.imag == pytest.approx(across.b.imag, abs=1e-9)
        assert down.a.real == pytest.approx(down.b.real, abs=1e-9)
        for point, (curve,) in ((across.a, curves["total_work"]), (down.a, curves["inertia"]), (across.b, curves["energy_mass"])):
            assert np.abs(curve - point).min() < 1e-9
        assert (across.b.real - option("energy_mass", "axis")) * f.scales.inertia.mu == pytest.approx(f.J_reduced[k], rel=1e-9)


def test_rays_and_chords_are_parallel_on_the_sheet():
    p = project(Shaper())
    f = p.flywheel
    slopes = [(m.b - m.a).imag / (m.b - m.a).real for m in draw(p, only="moments").marks
              if isinstance(m, Line) and m.style == "construction" and m.a == f.scales.pole * -1 + draw_origin(p)]
    assert len(slopes) == 4  # three different ordinates and the ray to K'
    chords = [m for m in draw(p, only="works").marks if isinstance(m, Line) and m.style == "construction"]
    tilted = [c for c in chords if abs((c.b - c.a).imag) > 1e-9]
    assert len(tilted) == 6
    for c in tilted:
        slope = (c.b - c.a).imag / (c.b - c.a).real
        assert min(abs(slope - s) for s in slopes) < 1e-12
    assert max(slopes) == pytest.approx(-f.driving_plan["K"].value.imag / -f.scales.angle.mm(2 * np.pi), rel=1e-12)


def draw_origin(p):
    """Origin of the moment graph: where its angle axis begins."""
    axis = next(m for m in draw(p, only="moments").marks if isinstance(m, Line) and m.style == "axis" and m.a.imag == m.b.imag)
    return axis.a


def test_curves_are_thick_and_axes_are_axes():
    styles = {m.style for m in draw(project(Shaper())).marks if isinstance(m, Polyline)}
    assert styles == {"curve", "main"}


def test_the_sheet_is_evenly_filled():
    canvas = draw(project(Shaper()))
    place(canvas, FRAME)
    points = reach(canvas.marks)
    cells = {(int((p.real - 20) // 60), int((p.imag - 5) // 60)) for m in canvas.marks for p in
             (text_box(m) if isinstance(m, Text) else dense(flat(m)))}
    block = {(i, 0) for i in range(10, 14)}
    assert len(points) > 1000
    assert len(cells | block) >= 0.8 * 14 * 10


def dense(points):
    parts = [points[:1]]
    for a, b in pairwise(points):
        parts.append(np.linspace(a, b, int(abs(b - a) // 10) + 2))
    return np.concatenate(parts)


def test_an_axis_longer_than_its_place_is_refused():
    p = project(Shaper())
    view = next(view for view in views(p) if view.draw == "flywheel.column")
    x0, y0, x1, y1 = view.box
    with pytest.raises(CannotBuild, match=r"view flywheel\.column needs \d+ mm more width"):
        function("flywheel.column")(p, Canvas(), Box(x0, y0, x1 - 40, y1), view.options)


@pytest.mark.parametrize("name", ["column", "total_work", "inertia"])
def test_a_place_that_is_too_small_is_refused(name):
    view = next(v for v in VIEWS if v["draw"] == f"flywheel.{name}")
    x0, y0, x1, _ = view["box"]
    with pytest.raises(CannotBuild, match=rf"view flywheel\.{name} needs \d+ mm more height"):
        function(f"flywheel.{name}")(
            project(Shaper()), Canvas(), Box(x0, y0, x1, y0 + 25), view)


def test_the_graph_of_excess_energy_is_never_a_line():
    """Where the links' inertia decides (the screen's dE is 0.5 J beside 88 J), its own scale factor is printed."""
    screen = Project(variant.read(Path(__file__).parents[3] / "variants" / "screen.toml"))
    marks = unlettered(screen, 3).marks
    fw, path = screen.flywheel, screen.flywheel.total_plan["points"].path
    curve = [m for m in marks if m.by and m.by.role == "curve" and m.by.step == path]
    height = max(float(np.ptp(flat(m).imag)) for m in curve)
    assert height > 60 > np.ptp(fw.energy_curve(fw.samples))
    at_positions = 125 * (fw.delta_E.max() - fw.delta_E.min())  # mm at 0.008 J/mm; the curve between rises a little above them
    assert at_positions <= height < 1.15 * at_positions
    assert any(isinstance(m, Text) and "0,008 Дж/мм" in m.text for m in marks)
    texts = [m for m in marks if isinstance(m, Text) and not m.text.endswith("увеличено")]
    # What its ordinates are against those of the other graph is said right under either title.
    for title, said in (("График суммарной работы", "Ординаты ΔE увеличены"), ("Диаграмма энергомасс", "уменьшены в 75 раз")):
        (above,), (beneath,) = ([m.at for m in texts if words in m.text] for words in (title, said))
        assert 0 < (above - beneath).imag < 30


def test_the_first_view_says_that_the_sheet_is_of_another_method():
    """Not that its moments lack room: nobody could make use of that."""
    other = SimpleNamespace(flywheel=SimpleNamespace(method="mertsalov"))
    with pytest.raises(CannotBuild, match="wittenbauer"):
        force_graph(other, Canvas(), Box(0, 0, 100, 100), {"axis": 20})


@pytest.mark.parametrize(("name", "said"), [("tests/projects/stirrer.toml", True),  # a force and two moments
                                            ("tests/projects/planer.toml", False),  # a moment alone: it has the graph
                                            ("tests/projects/feeder.toml", False)])  # a force alone
def test_moments_beside_the_graph_of_forces_are_told(name, said):
    said_there = " ".join(words(unlettered(Project(read(name)), 2)))
    assert ("учтено также" in said_there) is said


@pytest.mark.parametrize("table", [[[0, "4000 N"], [0.1, "0 N"], [1, "0 N"]], [[0, "0 N"], [0.95, "0 N"], [1, "4000 N"]]])
@pytest.mark.parametrize(("method", "sheet"), [("wittenbauer", "flywheel"), ("mertsalov", "sixbar_2")])
def test_works_by_ordinates_far_from_the_area_have_room(method, sheet, table):
    """A peak in the middle of an interval counts for all of it: the works are drawn much higher than they are."""
    own = project_files.read(
        project_files.SLIDER, project_files.WORKING, project_files.MASS, project_files.MOMENT, project_files.FORCE,
        project_files.FLYWHEEL, {"project.sheets": [sheet], "force[1].value": None, "force[1].table": table,
                                 "flywheel.method": method, "flywheel.form": "rim"})
    assert not composed(Project(own), 1).crowded


@pytest.mark.parametrize(("constant", "varying", "said"), [
    (774.41, 3000.0, "774,4"), (-0.0000213, 0.001, "−0,0000213"), (3e-14, 50.0, "0,0"), (-3e-14, 50.0, "0,0"), (0.0, 50.0, "0,0"),
    (0.0, 0.0, "0,0")])
def test_a_constant_moment_is_written_with_three_digits_unless_it_is_nothing(constant, varying, said):
    moment = SimpleNamespace(value=np.array([0.0, -varying]))
    assert constant_moment(SimpleNamespace(M_constant=constant, at_samples=SimpleNamespace(moment=lambda: moment))) == said


@pytest.mark.parametrize("second", [3900, 4000, 200])
def test_forces_of_both_signs_have_room(second):
    """Their graphs stand on one axis: what counts is the extent of all of them."""
    load = {key: value for key, value in project_files.FORCE["force"][0].items() if key != "value"}
    loads = [load | {"table": [[0, "0 N"], [0.5, "4000 N"], [1, "0 N"]]},
             load | {"name": "F4", "direction": "along motion", "stroke": "both",
                     "table": [[0, f"{-second} N"], [1, f"{-second} N"]]}]
    own = project_files.read(
        project_files.SLIDER, project_files.WORKING, project_files.MASS, project_files.MOMENT, project_files.FLYWHEEL,
        {"project.sheets": ["flywheel"], "flywheel.form": "rim", "force": loads})
    assert not composed(Project(own), 1).crowded


@pytest.mark.parametrize(("density", "iron"), [("7300 kg/m3", True), ("7599 kg/m3", True), ("7800 kg/m3", False)])
def test_a_fast_wheel_is_no_cast_iron(density, iron):
    """At 30 m/s and more the sizes found with the density of cast iron are none to be proud of: it is said."""
    own = Project(project_files.read(
        project_files.SLIDER, project_files.WORKING, project_files.MASS, project_files.MOMENT, project_files.FORCE,
        project_files.FLYWHEEL, {"crank.speed": "9000 rpm", "flywheel.form": "disc",
                                 "flywheel.density": density, "project.sheets": ["flywheel"]}))
    assert own.flywheel.wheel.speed > 30
    lettering = words(unlettered(own))
    assert any("чугуна" in text for text in lettering) == iron
    assert any("маховик стальной" in text for text in lettering) != iron


def test_nothing_is_no_share_of_a_work_that_is_nothing():
    """A constant force of fixed direction does no work over the cycle: what the ordinates find is no per cent of it."""
    own = Project(project_files.read(
        project_files.SLIDER, project_files.WORKING, project_files.MASS, project_files.MOMENT, project_files.FLYWHEEL,
        {"project.sheets": ["flywheel"], "flywheel.form": "rim",
         "force": [{"name": "F3", "link": "3", "point": "B", "direction": "180 deg", "value": "500 N"}]}))
    lettering = " ".join(words(unlettered(own)))
    assert "%)" not in lettering.partition("по ординатам")[2].partition("График")[0]
    assert "по площади графика 0 Дж" in lettering or "по ординатам" not in lettering


@pytest.mark.parametrize(("columns", "parts"), [(12, 1), (25, 2)])
def test_a_table_of_many_positions_has_two_rows_of_them(columns, parts):
    """Numbers that have no room beside one another go on below, under the numbers of their positions."""
    canvas = Canvas()
    rows = [["No.", *map(str, range(columns))], ["A", *(f"−{1000 + k}" for k in range(columns))]]
    listed.table(canvas, Box(0, 0, 190, 30), rows)
    said = [mark for mark in canvas.marks if isinstance(mark, Text)]
    assert sum(mark.text == "No." for mark in said) == parts
    assert len({round(mark.at.imag, 3) for mark in said if mark.text.startswith("−1")}) == parts
    assert max(mark.at.real for mark in said) < 190


def test_what_the_work_is_off_by_is_said_outside_a_graph_that_is_full():
    """It was left out where the error was the worst."""
    canvas = draw(project(Shaper()), "works")
    said = next(m for m in canvas.marks if isinstance(m, Text) and "середин" in m.text)
    assert "по площади" in "".join(m.text for m in canvas.marks if isinstance(m, Text) and m.at.imag == said.at.imag)
    drawn = np.concatenate([flat(m) for m in canvas.marks if isinstance(m, Polyline)])
    assert text_box(said).imag.min() > drawn.imag.max() + 1.0
