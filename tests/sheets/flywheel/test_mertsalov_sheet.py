"""Sheets 1 and 2 of the press: every label has its place, curves are where their plans say, numbers are those of the method."""

from __future__ import annotations

from contextlib import nullcontext
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from tests.few import seldom
from tests.methods.flywheel.press_truth import OMEGA, inertia
from tests.methods.linkage.shaper_truth import Shaper
from tmm_sheets import catalogue
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Line, Polyline, Text, flat
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.flywheel.wheel_methods import flywheel
from tmm_sheets.project import Project
from tmm_sheets.resources import template
from tmm_sheets.sheets import composition, views as kinds
from tmm_sheets.sheets.flywheel import mertsalov
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import arrangement, function

AXIS = 382.0
COLUMN = Box(324, 8, 647, 586)


@pytest.fixture(scope="module")
def press():
    return Project(catalogue.read("press"))


@pytest.fixture(scope="module")
def sheets(press):
    return {n: composed(press, n) for n in (1, 2)}


def draw(press, view, box, **options):
    canvas = Canvas()
    getattr(mertsalov, view)(press, canvas, box, {"axis": AXIS, **options})
    return canvas


def curves(canvas):
    return [m.points for m in canvas.marks if isinstance(m, Polyline)]


@pytest.mark.parametrize("n", [1, 2])
def test_every_label_finds_a_place_and_nothing_leaves_the_frame(sheets, n):
    assert sheets[n].crowded == ()
    points = np.concatenate([text_box(m) if isinstance(m, Text) else flat(m) for m in sheets[n].drawing.marks])
    assert not np.isnan(points).any()
    assert points.real.min() >= 0
    assert points.real.max() <= 841
    assert points.imag.min() >= 0
    assert points.imag.max() <= 594


@pytest.mark.parametrize("view", [v.draw for v in arrangement("press_1").views if v.draw.startswith(("mertsalov", "flywheel"))])
def test_a_view_keeps_to_its_place(press, view):
    found = next(v for v in arrangement("press_1").views if v.draw == view)
    canvas = Canvas()
    function(view)(press, canvas, found.box, found.options)
    points = np.concatenate([text_box(m) if isinstance(m, Text) else flat(m) for m in canvas.marks])
    assert [p for p in points if not found.box.contains(p, 1.0)] == []


def test_curve_of_the_first_energy_is_the_other_less_the_second(press):
    fw = press.flywheel
    total, own = curves(draw(press, "energies", Box(324, 100, 647, 400)))
    x = (total.real - AXIS) * fw.scales.angle.mu
    below = (total - own).imag * fw.scales.energy.mu
    np.testing.assert_allclose(below, inertia(x) * OMEGA**2 / 2, rtol=1e-9)


def test_segment_and_axis_on_paper(press):
    """The mean axis halves ab; both tangents touch the curve from outside."""
    fw = press.flywheel
    canvas = draw(press, "energies", Box(324, 100, 647, 400))
    _, own = curves(canvas)
    (axis,) = [m for m in canvas.marks if isinstance(m, Line) and m.style == "centre"]
    low, high = own.imag.min(), own.imag.max()
    assert axis.a.imag == pytest.approx((low + high) / 2, abs=0.005)
    assert high - low == pytest.approx(fw.ab_mm, abs=0.005)  # the polyline cuts the corner
    said = "".join(m.text for m in canvas.marks if isinstance(m, Text))
    assert f"{fw.ab_mm:.2f}".replace(".", ",") in said


def test_tangent_touches_the_graph_of_inertia(press):
    fw, k = press.flywheel, press.force_index
    canvas = draw(press, "inertia", Box(324, 10, 647, 260))
    at = complex(AXIS, 18.0) + complex(fw.inertia_plan["points"].value[k])
    (tangent,) = [m for m in canvas.marks if isinstance(m, Line) and m.style == "axis" and abs((m.a + m.b) / 2 - at) < 1e-6]
    assert np.angle(tangent.b - tangent.a) == pytest.approx(float(fw.position_acceleration["ψ"].value[k]), rel=1e-12)
    whole = curves(canvas)[0]
    parts = curves(canvas)[1:]
    assert len(parts) == 3
    np.testing.assert_allclose(sum(p.imag - 18.0 for p in parts), whole.imag - 18.0, atol=1e-9)


def test_signs_of_manual_001(press):
    canvas = draw(press, "energies", Box(324, 100, 647, 400), energies=["ΔE", "E_{зв}", "E_М"])
    assert {"ΔE", "E_{зв}", "E_М, ω_1"} <= {label.text for label in canvas.labels}


def test_graphs_of_the_column_stand_one_under_another(press):
    fw = press.flywheel
    canvas = draw(press, "column", COLUMN)
    period = fw.scales.angle.mm(2 * np.pi)
    for curve in curves(canvas):
        assert curve.real.min() == pytest.approx(AXIS, abs=1e-6)
        assert curve.real.max() == pytest.approx(AXIS + period, abs=1e-6)
    points = np.concatenate([text_box(m) if isinstance(m, Text) else flat(m) for m in canvas.marks])
    assert points.imag.min() >= COLUMN.y0
    assert points.imag.max() <= COLUMN.y1
    assert np.ptp(points.imag) > 0.95 * COLUMN.height


def test_a_place_too_low_is_refused(press):
    with pytest.raises(CannotBuild, match=r"view mertsalov\.column needs \d+ mm more height"):
        draw(press, "column", Box(324, 100, 647, 586))


def test_table_says_the_results(press):
    said = [m.text for m in draw(press, "position_table", Box(600, 400, 832, 586)).marks if isinstance(m, Text)]
    fw = press.flywheel
    for value in (*(f"{w:.3f}" for w in fw.omega), *(f"{e:.3f}" for e in fw.position_acceleration["ε1"].value)):
        assert value.replace(".", ",").replace("-", "−") in said


def test_results_say_what_is_taken(press):
    said = "".join(m.text for m in draw(press, "results", Box(655, 300, 832, 444)).marks if isinstance(m, Text))
    assert "принято" in said
    assert "301,3" in said
    assert "генераторногорежиманет" in said.replace(" ", "")


def test_comparison_has_a_row_for_each_flywheel(press):
    said = [m.text for m in draw(press, "comparison", Box(654, 258, 832, 326)).marks if isinstance(m, Text)]
    for c in press.flywheel.compared:
        assert f"{c.first:.2f}".replace(".", ",") in said
        assert f"{c.running.delta:.5f}".replace(".", ",") in said


def test_views_of_the_other_method_are_refused():
    data = SimpleNamespace(method="wittenbauer", delta=0.03, form="rim", density=7300.0, width_ratio=0.2, thickness_ratio=0.12,
                           rim_share=1.0, motor=None, inertia=None, efficiency=None, weights=False)
    project = SimpleNamespace(flywheel=flywheel(Shaper(), data))
    with pytest.raises(CannotBuild, match=r'belongs to flywheel\.method = "mertsalov"'):
        draw(project, "energies", Box(324, 100, 647, 400))


VIEWS = sorted({view.draw for path in template("sheets/press_1.toml").parent.glob("*.toml") for view in arrangement(path.stem).views
                if view.draw.partition(".")[0] in ("flywheel", "crank_speed")} | {"crank_speed.graph"})


@pytest.mark.parametrize("view", VIEWS)
def test_check_knows_the_views_that_another_method_cannot_draw(view):
    project = SimpleNamespace(flywheel=SimpleNamespace(method="mertsalov"))
    try:
        function(view)(project, Canvas(), Box(0, 0, 400, 300), {})
        refused = False
    except CannotBuild as e:
        refused = "belongs to flywheel.method" in str(e)
    except (AttributeError, KeyError):
        refused = False  # it asks the flywheel for what every method has
    assert refused == (kinds.VIEWS[view].after == "flywheel.with_tangents")


@pytest.mark.parametrize(("sheets", "refused"), [(["flywheel"], True), (["press_1"], False), (["press_1", "flywheel"], True)])
def test_check_refuses_a_sheet_of_the_other_method(press, sheets, refused):
    project = SimpleNamespace(sheets=sheets, parts=press.parts, flywheel=press.flywheel)
    with pytest.raises(CannotBuild, match="belongs to") if refused else nullcontext():
        composition.check(project)


@pytest.mark.parametrize(("name", "least"), [
    seldom("press", 80), ("lugansk/shaper", 80), seldom("lugansk/engine", 80), seldom("loom", 52), ("screen", 52)])
def test_the_graphs_of_the_moments_read_well(name, least):
    """M_c and M_d together are at least 80 mm high, over a pole distance that a ruler lays off (H = mu_A/(mu_M mu_phi)).

    Where dE is shown enlarged there is less room for them.
    """
    fw = Project(catalogue.read(name)).flywheel
    s = fw.scales
    values = np.concatenate(([0.0, fw.M_constant], *(fw.at_samples.moment(side).value for side in (1, -1))))
    assert np.ptp(values) / s.moment.mu >= least
    pole = s.work.mu / (s.moment.mu * s.angle.mu)
    assert pole == pytest.approx(s.pole)
    assert 2 * pole == pytest.approx(round(2 * pole), abs=1e-6)


@pytest.mark.parametrize(("name", "n"), [("sixbar/3:2", 2), ("press", 1)])
def test_a_sheet_has_one_letter_for_inertia_and_one_for_energy(name, n):
    """J and E, as in the note and in the protocol, though manual 002 writes I and T: signs, scale factors, terms, formulas."""
    foreign = {"I", "T"}
    runs = [mark for mark in composed(Project(catalogue.read(name)), n).drawing.marks if isinstance(mark, Text)]
    indexed = [(mark.text, after.text) for mark, after in pairwise(runs) if after.height < mark.height]
    assert not {index for sign, index in indexed if sign.endswith("μ")} & foreign
    signs = {sign for sign, _ in indexed}
    assert not {sign for sign in signs if sign.split("·")[-1].strip("( ;+d") in foreign}
