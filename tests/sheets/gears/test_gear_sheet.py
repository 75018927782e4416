"""The gear sheet: every view stays in its place, fills it, and shows what the plans hold."""

import tomllib
from cmath import rect
from itertools import combinations
from math import radians
from types import SimpleNamespace

import numpy as np
import pytest

from tmm_sheets.catalogue import read
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Polyline, Text, flat
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.methods.gears.gear_pair import gear_pair
from tmm_sheets.numbers import fixed
from tmm_sheets.project import Project
from tmm_sheets.resources import template
from tmm_sheets.sheets.gears import gear_marks, gear_picture
from tmm_sheets.sheets.views import function

TITLE_BLOCK = Box(651, 5, 836, 60)
DESIGNATION = Box(20, 575, 90, 589)
FRAME = Box(20, 5, 836, 589)


def project(teeth=(14, 28), shift=(3 / 17, 0.0), module=0.0035, driver=1, sense="clockwise", profile="fillet"):
    angle = radians(20)
    return SimpleNamespace(gear=gear_pair(SimpleNamespace(
        teeth=teeth, shift=shift, module=module, pressure_angle=angle, addendum=1.0, clearance=0.25, driver=driver, sense=sense,
        profile=profile, mesh="external", centre_distance=None)))


PROJECTS = {
    "manual 000": project(),
    "manual 002": project((10, 20), (0.5, 0.5), 0.01, sense="counter-clockwise"),
    "great ratio": project((10, 60), (0.5, 0.0), 0.002, driver=2),
    "small wheel below": project((45, 17), (0.1, 0.3), 0.005),
    "alike": project((30, 30), (0.0, 0.0), 0.008),
    "coarse": project((12, 13), (0.4, 0.4), 0.02, driver=2, sense="counter-clockwise"),
}


def arrangement():
    found = tomllib.loads(template("sheets/gear.toml").read_text("utf-8"))["view"]
    return [(v["draw"], Box(*v["box"])) for v in found]


def drawn(name, box, data):
    canvas = Canvas()
    draw(name, data, canvas, box)
    return canvas


def draw(name, data, canvas, box):
    function(name)(data, canvas, box, {})


def ink(marks):
    return np.concatenate([text_box(m) if isinstance(m, Text) else flat(m) for m in marks])


def test_places_do_not_overlap():
    boxes = [box for _, box in arrangement()] + [TITLE_BLOCK, DESIGNATION]
    for a, b in combinations(boxes, 2):
        assert min(a.x1, b.x1) <= max(a.x0, b.x0) or min(a.y1, b.y1) <= max(a.y0, b.y0)
    for box in boxes:
        assert FRAME.contains(complex(box.x0, box.y0))
        assert FRAME.contains(complex(box.x1, box.y1))


@pytest.mark.parametrize("data", PROJECTS.values(), ids=PROJECTS.keys())
@pytest.mark.parametrize(("name", "box"), arrangement(), ids=[name for name, _ in arrangement()])
def test_view_stays_in_its_place_and_fills_it(name, box, data):
    canvas = drawn(name, box, data)
    points = ink(canvas.marks)
    assert np.isfinite(points).all()
    assert points.real.min() >= box.x0 - 1e-6
    assert points.real.max() <= box.x1 + 1e-6
    assert points.imag.min() >= box.y0 - 1e-6
    assert points.imag.max() <= box.y1 + 1e-6
    assert all(box.contains(label.anchor, 1e-6) for label in canvas.labels)
    # the title stands at the top and the drawing reaches well down
    assert np.ptp(points.imag) >= 0.75 * box.height
    # standard scales are up to a factor of two apart, and the line of action keeps 34 mm for its letters
    assert np.ptp(points.real) >= (0.5 if name == "gear.sliding" else 0.75) * box.width


@pytest.mark.parametrize("data", PROJECTS.values(), ids=PROJECTS.keys())
def test_every_label_finds_its_place(data):
    canvas = Canvas()
    for name, box in arrangement():
        draw(name, data, canvas, box)
    assert place(canvas, FRAME) == []


def test_an_undercut_of_hundredths_is_not_named():
    """The rule of seventeen teeth gives 3/17; the exact limit is 1 - 14 sin^2(20 deg)/2 = 0.1812, 16 um of the rack farther."""
    data = PROJECTS["manual 000"]
    assert 0.0 < (1 - 7 * np.sin(radians(20)) ** 2 - 3 / 17) * 3.5 < 0.02
    assert data.gear.pinion.rack.undercut
    canvas = drawn("rack.generating", dict(arrangement())["rack.generating"], data)
    assert "подрез" not in [label.text for label in canvas.labels]


def test_scale_of_the_manual():
    canvas = drawn("gear.engagement", dict(arrangement())["gear.engagement"], PROJECTS["manual 000"])
    assert "М 4:1" in [m.text for m in canvas.marks if isinstance(m, Text)]
    assert canvas.scales["gear-engagement"].mu == 0.00025


@pytest.mark.parametrize("data", PROJECTS.values(), ids=PROJECTS.keys())
def test_both_centres_stand_on_the_picture_and_teeth_are_thick(data):
    box = dict(arrangement())["gear.engagement"]
    canvas = drawn("gear.engagement", box, data)
    anchors = {label.text: label.anchor for label in canvas.labels}
    assert box.contains(anchors["O_1"], -10)
    assert box.contains(anchors["O_2"], -10)
    gear = data.gear
    mm = 1 / canvas.scales["gear-engagement"].mu
    for w in gear.wheels:
        outline = (gear.shape(w).outline() - gear.engagement["A"].value) * mm + anchors["A"]
        thick = [m for m in canvas.marks if isinstance(m, Polyline) and m.style == "main"]
        assert any(abs(m.points[0] - outline[0]) < 1e-9 and abs(m.points[-1] - outline[-1]) < 1e-9 for m in thick)


def test_sliding_curves_show_the_table():
    """The drawn curves pass through the values of the divisions, taken back through the scale factor."""
    data = PROJECTS["manual 000"]
    canvas = drawn("gear.sliding", dict(arrangement())["gear.sliding"], data)
    curves = [m.points for m in canvas.marks if isinstance(m, Polyline) and m.style == "curve"]
    factor = next(m.text for m in canvas.marks if isinstance(m, Text) and "1/мм" in m.text)
    mu = float(factor.split("=")[1].split()[0].replace(",", "."))
    anchors = {label.text: label.anchor for label in canvas.labels}
    plan = data.gear.sliding
    for i, points in enumerate(curves, 1):
        for k in (1, 2, 4, 5):
            at = anchors[plan.labels[k]]
            order = np.argsort(points.real)  # N1 may stand at the right, as in the picture
            value = float(np.interp(at.real, points.real[order], points.imag[order])) - at.imag
            assert value * mu == pytest.approx(plan[f"theta{i}"].value[k], abs=0.02)


@pytest.mark.parametrize("profile", ["fillet", "rack"])
def test_the_tips_are_held_against_what_is_pointed(profile):
    """As much of the module as both lengths of the table of the pair say, with either way to make the teeth."""
    data = project(profile=profile)
    said = [m.text for m in drawn("gear.results", Box(500, 60, 834, 330), data).marks if isinstance(m, Text)]
    shares = [w.sa / 0.0035 for w in data.gear.wheels]
    assert "; ".join(fixed(share, 2) for share in shares) in said
    assert all(share > 0.2 for share in shares)


def test_nothing_but_the_gear_is_asked_for():
    """A view of this sheet reads the gear pair alone: any other attribute of the project would fail here."""
    for name, box in arrangement():
        drawn(name, box, SimpleNamespace(gear=PROJECTS["manual 000"].gear))


@pytest.mark.parametrize(("teeth", "shift", "module"), [((11, 60), (0.36, 0.0), 0.005), ((11, 90), (0.4, 0.0), 0.004)])
def test_nothing_of_a_broken_wheel_is_drawn_beyond_its_break(teeth, shift, module):
    """Radii that are lettered beside the mesh begin at the break, not at the far centre."""
    data, box = project(teeth, shift, module, 1), dict(arrangement())["gear.engagement"]
    points = ink(drawn("gear.engagement", box, data).marks)
    assert gear_picture.picture(data.gear, box.width, box.height)[1]
    assert box.contains(points.real.min() + 1j * points.imag.min(), 1e-6)
    assert box.contains(points.real.max() + 1j * points.imag.max(), 1e-6)


@pytest.mark.parametrize(("teeth", "shift", "driver", "broken"), [
    ((14, 120), (0.2, 0.1), 1, True), ((11, 60), (0.5, 0.5), 1, True), ((12, 48), (0.4, -0.4), 2, True),  # N2 at either side
    ((60, 11), (0.5, 0.5), 1, True),  # wheel 2 is the small one
    ((14, 28), (3 / 17, 0.0), 1, False),  # the picture is as it was
])
def test_a_far_greater_wheel_is_broken_so_that_the_mesh_can_be_read(teeth, shift, driver, broken):
    data, box = project(teeth, shift, 0.004, driver), dict(arrangement())["gear.engagement"]
    gear, canvas = data.gear, drawn("gear.engagement", box, data)
    assert bool(gear_picture.picture(gear, box.width, box.height)[1]) is broken
    whole = gear.picture_scale(gear_picture.picture_room(gear, box.width, box.height)).mu
    mu = canvas.scales["gear-engagement"].mu
    anchors = {label.text: label.anchor for label in canvas.labels}
    apart = abs(anchors["O_1"] - anchors["O_2"])
    points = ink(canvas.marks)
    assert box.contains(points.real.min() + 1j * points.imag.min(), 1e-6)
    assert box.contains(points.real.max() + 1j * points.imag.max(), 1e-6)
    assert all(box.contains(anchors[name]) for name in ("O_1", "O_2", "N_1", "N_2", "A", "B"))
    assert any(d.text == f"a_w = {fixed(gear.a_w * 1e3, 2)}" and abs(abs(d.a - d.b) - apart) < 1e-9 for d in canvas.dimensions)
    if broken:
        assert mu <= whole / 2
        assert apart < 0.8 * gear.a_w / mu
    else:
        assert mu == whole
        assert apart == pytest.approx(gear.a_w / mu)


@pytest.mark.parametrize("size", [(393, 565), (213, 428), (150, 428), (120, 300)], ids=["wide", "narrow", "narrower", "small"])
def test_radii_stand_apart_where_they_are_named_and_end_inside_the_picture(size):
    gear = Project(read("lugansk/shaper")).gear
    picture = gear_picture.GearPicture(gear, Canvas(), Box(20, 20, 20 + size[0], 20 + size[1]))
    for wheel in gear.wheels:
        found = [(key, a) for key, (a, begin) in gear_marks.Radii(picture, wheel).directions().items() if begin == 2.0]
        apart = [abs(a - b) * 0.7 * picture.mm(wheel.rf) for (_, a), (_, b) in combinations(found, 2)]
        assert all(by >= gear_marks.RADII_APART_MM - 1e-9 for by in apart)
        tips = [picture.of(f"O{wheel.number}") + rect(picture.mm(getattr(wheel, key)), a) for key, a in found]
        assert all(picture.box.contains(z) for z in tips)
