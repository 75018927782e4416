"""The sheet of gears with a reducer: views keep to their places, and what they show is to scale."""

import tomllib
from functools import cache
from itertools import combinations
from math import radians
from types import SimpleNamespace

import numpy as np
import pytest

from tests.few import few
from tests.methods.gears import reducer_cases as cases
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Arc, Box, Line, Polyline, Text, flat
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.methods.gears.gear_pair import gear_pair, settled
from tmm_sheets.methods.gears.reducer import reducer
from tmm_sheets.resources import template
from tmm_sheets.sheets.views import function
from tmm_sheets.task.schema import GearTable

TITLE_BLOCK = Box(651, 5, 836, 60)
DESIGNATION = Box(20, 575, 90, 589)
FRAME = Box(20, 5, 836, 589)


@cache
def project(name):
    machine, c, *over = PROJECTS[name]
    found = reducer(cases.column(machine, c, **(over[0] if over else {})))
    section = GearTable(teeth="reducer", shift="rule", pressure_angle="20 deg", profile="rack")
    variant = SimpleNamespace(train=None, gear=section)
    return SimpleNamespace(reducer=found, gear=gear_pair(settled(section, found)), variant=variant)


PROJECTS = {
    "diesel 0": ("diesel", 0), "diesel 4": ("diesel", 4), "diesel 5": ("diesel", 5),
    "press 1": ("press", 1), "press 7, rings": ("press", 7, {"scheme": "two internal"}),
    "compressor 2": ("compressor", 2), "compressor 4, rings driven": ("compressor", 4, {"driver": "ring"}),
    "compressor 6": ("compressor", 6), "crusher 4": ("crusher", 4), "crusher 9": ("crusher", 9),
}
each = pytest.mark.parametrize("name", few(PROJECTS, "diesel 0", "press 7, rings", "compressor 4, rings driven", "crusher 9"))


def arrangement():
    found = tomllib.loads(template("sheets/gear_reducer.toml").read_text("utf-8"))["view"]
    return [(v["draw"], Box(*v["box"])) for v in found]


def draw(canvas, name, box, data):
    function(name)(data, canvas, box, {})


@cache
def sheet(name):
    """Canvas of the whole sheet, and its marks view by view."""
    canvas, parts = Canvas(), {}
    for view, box in arrangement():
        before = len(canvas.marks), len(canvas.labels)
        draw(canvas, view, box, project(name))
        parts[view] = canvas.marks[before[0]:], canvas.labels[before[1]:], box
    return canvas, parts


def test_places_do_not_overlap():
    boxes = [box for _, box in arrangement()] + [TITLE_BLOCK, DESIGNATION]
    for a, b in combinations(boxes, 2):
        assert min(a.x1, b.x1) <= max(a.x0, b.x0) or min(a.y1, b.y1) <= max(a.y0, b.y0)
    for box in boxes:
        assert FRAME.contains(complex(box.x0, box.y0))
        assert FRAME.contains(complex(box.x1, box.y1))


@each
def test_views_stay_in_their_places(name):
    _, parts = sheet(name)
    for name, (marks, labels, box) in parts.items():
        points = np.concatenate([text_box(m) if isinstance(m, Text) else flat(m) for m in marks])
        assert np.isfinite(points).all(), name
        assert points.real.min() >= box.x0 - 1e-6, name
        assert points.real.max() <= box.x1 + 1e-6, name
        assert points.imag.min() >= box.y0 - 1e-6, name
        assert points.imag.max() <= box.y1 + 1e-6, name
        assert all(box.contains(label.anchor, 1e-6) for label in labels), name
        if name != "reducer.choice":  # as tall as it has runners-up
            assert np.ptp(points.imag) >= 0.6 * box.height, name
        # handy scale factors are up to a factor of two apart
        assert np.ptp(points.real) >= (0.5 if name == "reducer.speeds" else 0.75) * box.width, name


@each
def test_every_label_finds_its_place(name):
    canvas, _ = sheet(name)
    assert place(canvas, FRAME) == []


@each
def test_front_view_shows_all_pitch_circles_to_scale(name):
    canvas, parts = sheet(name)
    mm = canvas.scales["reducer-scheme"].mm
    radii = [m.radius for m in parts["reducer.scheme"][0] if isinstance(m, Arc)]
    train, count = project(name).reducer, project(name).reducer.table.satellites
    for mesh in train.meshes:
        for wheel in (mesh.central, mesh.planet):
            same = sum(abs(r - mm(train.radius(wheel, mesh))) < 1e-9 for r in radii)
            assert same >= (count if mesh.carrier and wheel == mesh.planet else 1)
    arm = mm(train.distance(next(m for m in train.meshes if m.carrier)))
    spokes = [m for m in parts["reducer.scheme"][0] if isinstance(m, Line) and abs(abs(m.b - m.a) - arm) < 1e-9]
    directions = {round(float(np.angle(m.b - m.a)) % (2 * np.pi), 6) for m in spokes if m.style == "main"}
    assert len(directions) >= count


@each
def test_rays_are_parallel_to_the_lines_of_the_picture(name):
    """On paper: each link's line and its ray have one direction, and the ray's end reads the link's speed."""
    canvas, parts = sheet(name)
    height, speed = canvas.scales["reducer-scheme"], canvas.scales["reducer-velocities"]
    titles = [m.text for m in parts["reducer.speeds"][0] if isinstance(m, Text)]
    factor = next(t for t in titles if "об/мин" in t and "=" in t)
    mu = float(factor.split("=")[1].split()[0].replace(",", "."))
    rays = [m for m in parts["reducer.speeds"][0] if isinstance(m, Line) and m.style == "main"]
    pole, plan = rays[0].a, project(name).reducer.velocities
    lines = [s for s in plan if s.rule.gives == "direction"]
    assert len(rays) == len(lines)
    origin = pole.real
    for line in lines:
        u = complex(line.value)
        drawn = complex(speed.mm(u.real), height.mm(u.imag))
        assert min(abs(((m.b - m.a) * drawn.conjugate()).imag) / abs(m.b - m.a) / abs(drawn) for m in rays) < 1e-9
    read = sorted((m.b.real - origin) * mu for m in rays)
    links = project(name).reducer.kinematics
    assert read == pytest.approx(sorted(links[f"n{s.name}"].value for s in lines), rel=1e-4, abs=1e-3)


@each
def test_generating_engagement_shows_positions_and_teeth(name):
    canvas, parts = sheet(name)
    marks = parts["rack.generating"][0]
    thin = [m for m in marks if isinstance(m, Polyline) and m.style == "thin" and not m.closed]
    assert len(thin) >= len(project(name).gear.generating.labels)
    teeth = [m for m in marks if isinstance(m, Polyline) and m.style == "main"]
    assert sum(len(m.points) for m in teeth) > 100
    anchors = {label.text: label.anchor for label in parts["rack.generating"][1]}
    pole, mm = anchors["P_0"], canvas.scales["gear-rack"].mm
    rack_ = project(name).gear.pinion.rack
    # both lie on the line of generation; where the shift follows the rule, in one point
    n = np.exp(-1j * rack_.alpha)
    if "N" in anchors and "B_l" in anchors:
        assert anchors["N"] - pole == pytest.approx(mm(rack_.r * np.sin(rack_.alpha)) * n, abs=1e-9)
        assert abs(anchors["N"] - anchors["B_l"]) == pytest.approx(mm(rack_.rho_limit), abs=1e-9)


def test_tables_tell_the_choice_and_the_conditions():
    _, parts = sheet("crusher 9")
    texts = [m.text for m in parts["reducer.choice"][0] if isinstance(m, Text)]
    for value in ("15", "25", "18", "58", "12", "19", "10,086", "0,86"):
        assert value in texts
    found = "".join(m.text for m in parts["reducer.conditions"][0] if isinstance(m, Text))
    assert "10,086; 0,86 %" in found
    assert "40 = 40" in found


def test_undercut_is_named_on_the_view():
    undercut = SimpleNamespace(gear=gear_pair(SimpleNamespace(
        teeth=(9, 9), shift=(0.2, 0.4), module=0.01, pressure_angle=radians(20), addendum=1.0, clearance=0.25, driver=1,
        sense="clockwise", profile="rack", mesh="external", centre_distance=None)))
    canvas = Canvas()
    function("rack.generating")(undercut, canvas, dict(arrangement())["rack.generating"], {})
    assert "подрез" in [label.text for label in canvas.labels]
    assert place(canvas, FRAME) == []
