"""The cam sheet: every view stays in its place, fills it, and shows what the constructions hold."""

from functools import cache
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest

from tests.few import all_hold, few
from tests.methods.cams.cam_cases import cam_data, flat_data, rocker_data
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink_index import dense
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Arc, Box, Line, Polyline, Text, flat
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.methods.cams.cam_profile import DIAGRAMS, cam
from tmm_sheets.sheets.cams.cam import HEADS
from tmm_sheets.sheets.composition import is_meant
from tmm_sheets.sheets.views import arrangement, function

TITLE_BLOCK = Box(651, 5, 836, 60)
FRAME = Box(20, 5, 836, 589)


def project(_data=cam_data, **changes):
    return SimpleNamespace(cam=cam(_data(**changes)))


PROJECTS = {
    "manual 000": project(),
    "both limits": project(sense="counter-clockwise", limit="both", roller=None, stroke=25, rise=60, upper_dwell=0, fall=70,
                           pressure_angle=35),
    "cosine, no lower dwell": project(law="cosine", rise=180, upper_dwell=60, fall=120, roller=None, stroke=55),
    "constant": project(law="constant", rise=60, upper_dwell=10, fall=150, roller=None, stroke=20, limit="both", pressure_angle=25),
    "no offset": project(rise=120, upper_dwell=0, fall=120, roller=None, stroke=4, limit="both", pressure_angle=45),
    "steep fall": project(rise=150, fall=40, roller=None, stroke=15),
    "given offset, spring": project(law="constant", rise=60, upper_dwell=0, fall=60, eccentricity=6, pressure_angle=25, speed=200,
                                    follower_mass=0.5, roller=None),
    "two discs": project(law="trapezoid", rise=80, upper_dwell=20, fall=80, eccentricity=6, pressure_angle=25, limit="both",
                         closure="geometric", roller=None),
    "diagram, 12 parts": project(law="table", table=[[0, 0], [0.15, 1], [0.3, 0], [0.65, -0.43], [1, 0]], fall_law="cosine",
                                 stroke=20, roller=None, parts=12, speed=400, follower_mass=0.8),
    "rocker of manual 000": project(rocker_data),
    "press": project(rocker_data, rise=60, upper_dwell=30, fall=60, swing=20, arm=100, pressure_angle=30, limit="both", parts=6,
                     roller=None, speed=150, follower_inertia=0.06),
    "opposite rocker": project(rocker_data, rise=70, upper_dwell=10, fall=70, swing=15, arm=70, pressure_angle=40, roller=None,
                               rotation="opposite", sense="counter-clockwise", speed=300, follower_inertia=4e-4),
    "rocker, two discs": project(rocker_data, law="linearly decreasing", rise=70, upper_dwell=30, fall=70, swing=20, arm=110,
                                 pressure_angle=40, limit="both", closure="geometric", roller=None),
    "flat of manual 000": project(flat_data),
    "flat, spring": project(flat_data, law="sine", rise=90, fall=90, stroke=20, base_radius=None, speed=500, follower_mass=0.3),
}


def places(data):
    """Views drawn for a cam, by name, with their places."""
    return {v.draw: v.box for v in arrangement("cam").views if is_meant(data, v)}


@cache
def drawn_once(name, project):
    return drawn(name, PROJECTS[project])


def drawn(name, data):
    canvas = Canvas()
    function(name)(data, canvas, places(data)[name], {})
    return canvas


def whole(data):
    canvas = Canvas()
    for v in arrangement("cam").views:
        if is_meant(data, v):
            function(v.draw)(data, canvas, v.box, v.options)
    return canvas


def ink(marks):
    return np.concatenate([text_box(m) if isinstance(m, Text) else flat(m) for m in marks])


def texts(canvas):
    """What is written: fixed lettering run by run, labels as they are asked for."""
    return [m.text for m in canvas.marks if isinstance(m, Text)] + [label.text for label in canvas.labels]


VIEWS = [(name, view_name) for name, data in PROJECTS.items() for view_name in places(data)]


@pytest.mark.parametrize("data", PROJECTS.values(), ids=PROJECTS.keys())
def test_places_do_not_overlap(data):
    boxes = [*places(data).values(), TITLE_BLOCK]
    for a, b in combinations(boxes, 2):
        assert min(a.x1, b.x1) <= max(a.x0, b.x0) or min(a.y1, b.y1) <= max(a.y0, b.y0)
    assert all(FRAME.contains(complex(b.x0, b.y0)) and FRAME.contains(complex(b.x1, b.y1)) for b in boxes)


def test_kinds_have_their_views():
    def named(name):
        return {v.split(".")[1] for v in places(PROJECTS[name])}

    assert named("manual 000") == {"motion", "of_tappet", "roller", "pressure", "profile", "table"}
    assert named("rocker of manual 000") == {"motion", "of_rocker", "roller", "pressure", "profile", "table"}
    assert named("press") == named("rocker of manual 000") | {"spring"}
    assert named("flat, spring") == {"motion", "sum_graph", "plate", "profile", "table", "spring"}


def test_views_stay_in_their_places_and_fill_them():
    all_hold(fills_its_place, VIEWS)


def fills_its_place(name, view_name):
    box = places(PROJECTS[name])[view_name]
    canvas = drawn_once(view_name, name)
    points = ink(canvas.marks)
    assert np.isfinite(points).all()
    assert points.real.min() >= box.x0 - 1e-6
    assert points.real.max() <= box.x1 + 1e-6
    assert points.imag.min() >= box.y0 - 1e-6
    assert points.imag.max() <= box.y1 + 1e-6
    assert all(box.contains(label.anchor, 1e-6) for label in canvas.labels)
    assert np.ptp(points.real) >= 0.6 * box.width
    if view_name in ("cam_profile.roller", "cam_zone.of_tappet"):
        # Title, figure and formulas stand together at the top, no 30 mm of bare paper between them; the foot is left to others.
        heights = np.sort(dense(canvas.marks, 2.0).imag)
        assert heights[-1] >= box.y1 - 8.0
        assert np.diff(heights).max() <= 30.0
    else:
        # A graph of the pressure angle is no higher than wide, what it leaves of a high place is in one piece under it.
        high = min(box.height, box.width) if view_name == "cam.pressure" else box.height
        assert points.imag.max() >= box.y1 - 8.0 or view_name != "cam.pressure"
        assert np.ptp(points.imag) >= 0.6 * high


@pytest.mark.parametrize("name", few(PROJECTS, *[*PROJECTS][::2]))
def test_every_label_finds_its_place_and_no_lettering_lies_on_other_lettering(name):
    canvas = whole(PROJECTS[name])
    assert place(canvas, FRAME) == []
    runs = [m for m in canvas.marks if isinstance(m, Text)]
    x0, y0, x1, y1 = np.array([(c.real.min(), c.imag.min(), c.real.max(), c.imag.max()) for c in map(text_box, runs)]).T
    y1 -= [0.0 if m.angle else m.height - letter(m.text, m.height).ascent for m in runs]  # φ is no capital
    wide = np.minimum(x1[:, None], x1) - np.maximum(x0[:, None], x0)
    high = np.minimum(y1[:, None], y1) - np.maximum(y0[:, None], y0)
    pairs = [(runs[i], runs[j], j - i) for i, j in np.argwhere(np.triu((wide > 0.8) & (high > 0.8), 1))]
    # The boxes of slanted letters overhang their neighbours by up to 0.7 mm, that of an index its own letter by more.
    assert [(p.text, q.text) for p, q, apart in pairs if not (apart == 1 and q.height < p.height)] == []


def test_protocol_has_the_scale_factors_of_the_sheet():
    data = PROJECTS["manual 000"]
    canvas = whole(data)
    assert {name: scale.mu for name, scale in canvas.scales.items()} == {"cam-motion": 1.0, "cam-zone": 2e-4, "cam-profile": 1e-4}
    assert {s.mu for s in (data.cam.motion.scales.dds, data.cam.motion.scales.ds, data.cam.motion.scales.s)} == {1e-3, 2.5e-4, 6e-5}
    assert "μ" in texts(drawn("cam.motion", data))


@pytest.mark.parametrize("data", PROJECTS.values(), ids=PROJECTS.keys())
def test_diagrams_on_the_sheet_are_those_of_the_protocol(data):
    box = places(data)["cam.motion"]
    assert DIAGRAMS[data.cam.kind] == pytest.approx((box.width, box.height - 8 - HEADS), abs=2e-12)
    motion = data.cam.motion
    ink = np.concatenate([np.ravel(m.points) for m in drawn("cam.motion", data).marks if isinstance(m, Polyline)])
    assert np.ptp(ink.real) == pytest.approx(motion.scales.phi.mm(motion.law.fall.end), abs=1e-6)


def test_profile_on_paper_is_the_profile():
    data = PROJECTS["manual 000"]
    canvas = drawn("cam_profile.profile", data)
    (working,) = (m.points for m in canvas.marks if isinstance(m, Polyline) and m.style == "curve")
    (centres,) = (m.points for m in canvas.marks if isinstance(m, Polyline) and m.style == "centre")
    cam = data.cam
    axis = centres[0] - cam.dense.centres.value[0] / 1e-4
    np.testing.assert_allclose(working, axis + cam.dense.plan["F"].value[:-1] / 1e-4, atol=1e-9)
    rollers = [m for m in canvas.marks if isinstance(m, Arc) and m.radius == pytest.approx(35)]
    # 18 positions; 16 and 0 are one only when there is no lower dwell.
    assert len(rollers) == 18
    np.testing.assert_allclose([m.centre for m in rollers], axis + cam.inversion.centres.value / 1e-4, atol=1e-9)
    radii = [m.radius for m in canvas.marks if isinstance(m, Arc) and abs(m.centre - axis) < 1e-6]
    for radius in (cam.zone.r0, cam.zone.e):
        assert np.abs(np.array(radii) - radius / 1e-4).min() < 1e-9


def test_follower_lines_are_tangents_on_paper():
    data = PROJECTS["manual 000"]
    canvas = drawn("cam_profile.profile", data)
    axis = next(m.centre for m in canvas.marks if isinstance(m, Arc))
    e = data.cam.zone.e / 1e-4
    tangents = [m for m in canvas.marks if isinstance(m, Line) and m.style == "construction"
                and abs(abs(m.a - axis) - e) < 1e-6]
    assert len(tangents) == 18
    for m in tangents:
        assert abs(((m.a - axis).conjugate() * (m.b - m.a)).real) < 1e-6


def test_motion_shows_rays_chords_and_numbers():
    data = PROJECTS["manual 000"]
    canvas = drawn("cam.motion", data)
    asked = [*(label.text for label in canvas.labels), *(m.text for m in canvas.marks if isinstance(m, Text))]
    for number in data.cam.law.labels:
        # Numbers stand at each of the three diagrams.
        assert asked.count(number) >= 3
    assert {"P_1", "P_2"} <= set(asked)
    curves = [m.points for m in canvas.marks if isinstance(m, Polyline) and m.style == "curve"]
    assert [np.ptp(c.real) for c in curves] == pytest.approx([205.0] * 3)
    assert np.ptp(curves[2].imag) == pytest.approx(0.01 / 6e-5)


def test_allowed_zone_lies_between_the_tangents():
    data = PROJECTS["manual 000"]
    canvas = drawn("cam_zone.of_tappet", data)
    anchors = {label.text: label.anchor for label in canvas.labels}
    apex, start = anchors["O"], anchors["B"]
    assert (apex - start) * 2e-4 == pytest.approx(complex(0.00443232, -0.00767701), abs=1e-8)
    hatch = [m for m in canvas.marks if isinstance(m, Line) and m.style == "hatch"]
    assert len(hatch) > 5
    for m in hatch:
        for p in (m.a, m.b):
            assert apex.imag - p.imag >= abs(p.real - apex.real) / np.tan(np.pi / 6) - 1e-6


def test_pressure_graph_shows_the_permitted_angle():
    canvas = drawn("cam.pressure", PROJECTS["manual 000"])
    asked = [label.text for label in canvas.labels]
    assert "[α] = 30°" in asked
    levels = [m for m in canvas.marks if isinstance(m, Line) and m.style == "hidden"]
    (curve,) = (m.points for m in canvas.marks if isinstance(m, Polyline) and m.style == "curve")
    top = max(m.a.imag for m in levels)
    assert curve.imag.max() <= top + 1e-9
    assert curve.imag.max() == pytest.approx(top, abs=0.01)


def test_nothing_but_the_cam_is_asked_for():
    data = SimpleNamespace(cam=PROJECTS["manual 000"].cam)
    for name in places(data):
        assert drawn(name, data).marks


def rows_of_table(data):
    canvas = drawn("cam.table", data)
    texts = [g.text for g in canvas.groups if g.kind == "lettering"]
    width = 2 * data.cam.law.parts + 3
    return {row[0]: row[1:] for row in (texts[k : k + width] for k in range(0, len(texts), width))}


def test_the_table_has_both_limits_where_the_acceleration_jumps():
    """Manual 000, section 7, example 3: S'' = +-4 h/phi^2; the least of the table decides r_min, as the graph does."""
    data = PROJECTS["flat of manual 000"]
    rows = rows_of_table(data)
    up, down = 4 * 55 / np.radians(140) ** 2, 4 * 55 / np.radians(120) ** 2
    read = {name: [float(c.replace(",", ".").replace("−", "-")) for c in cells] for name, cells in rows.items()
            if name != "Положение"}
    dds = [read[f"S'' (φ{side}0)·10^3, м"] for side in "−+"]
    for k, before, after in ((0, 0, up), (4, up, -up), (8, -up, 0), (9, 0, -down), (13, -down, down), (17, down, 0)):
        assert (dds[0][k], dds[1][k]) == pytest.approx((before, after), abs=0.005)
    sums = [read[f"(S + S'') (φ{side}0)·10^3, м"] for side in "−+"]
    assert -min(map(min, sums)) == pytest.approx(data.cam.plate.r_min * 1e3, abs=0.005)
    assert -min(map(min, sums)) == pytest.approx(down - 27.5, abs=0.005)
    canvas = drawn("cam_zone.sum_graph", data)
    heights = [canvas.marks[g.first].points.mean().imag for g in canvas.groups if g.kind == "dot"]
    assert (max(heights) - min(heights)) * canvas.scales["cam-plate"].mu == pytest.approx(2e-3 * down, rel=1e-6)


def test_a_table_without_jumps_has_one_row_of_each():
    rows = rows_of_table(PROJECTS["flat, spring"])
    assert not [name for name in rows if "φ−0" in name]
    assert "S''·10^3, м" in rows


# --- marks know their steps

EXEMPT = ("symbol", "dimension", "hatch", "text", "table", "frame")


def test_marks_know_step_and_frame():
    """Every line, arc and curve besides symbols, dimensions, hatching and tables comes from a step that is there."""
    all_hold(knows_step_and_frame, VIEWS)


def knows_step_and_frame(name, view_name):
    data = PROJECTS[name]
    canvas = drawn_once(view_name, name)
    counted = [m.by for m in canvas.marks if not isinstance(m, Text) and (m.by is None or m.by.role not in EXEMPT)]
    assert all(by is not None and by.step and by.frame >= 0 for by in counted)
    plans = data.cam.plans
    for by in counted:
        plan, _, step = by.step.partition("/")
        assert step in plans[plan]
        assert by.position in ("", *plans[plan].labels)


@pytest.mark.parametrize("name", few(PROJECTS, *[*PROJECTS][::2]))
def test_points_lie_where_their_steps_are(name):
    """Dots of the profile and of the zone, from the frame and the value of the step alone."""
    data = PROJECTS[name]
    canvas = whole(data)
    plans, checked = data.cam.plans, 0
    for group in canvas.groups:
        mark = canvas.marks[group.first]
        if group.kind != "dot" or mark.by is None or mark.by.role != "point":
            continue
        frame, (plan, _, step) = canvas.frames[mark.by.frame], mark.by.step.partition("/")
        if plan not in ("cam-zone", "cam-profile") or frame.plan != plan:
            continue
        value = np.atleast_1d(plans[plan][step].value)
        k = plans[plan].labels.index(mark.by.position) if mark.by.position else 0
        assert mark.points.mean() == pytest.approx(complex(frame(value[min(k, len(value) - 1)])), abs=1e-9)
        checked += 1
    assert checked > 15


@pytest.mark.parametrize("data", [cam_data(upper_dwell=0), flat_data(law="sine", upper_dwell=0)])
def test_without_upper_dwell_positions_8_and_8_prime_are_one_in_the_tables(data):
    own = project(lambda **_: data)
    assert "8'" in own.cam.law.labels
    for name in ("cam.table", "cam_profile.radii"):
        canvas = Canvas()
        function(name)(own, canvas, Box(0, 0, 300, 160), {})
        assert "8" in texts(canvas)
        assert "8'" not in texts(canvas)


def test_nothing_is_drawn_over_what_follows_from_the_radius_of_curvature():
    """The perpendiculars went on beyond M into the lines under the figure."""
    canvas = drawn("cam_profile.roller", project(rise=180, upper_dwell=0, fall=180, stroke=40, limit="both", roller=None))
    said = [text_box(mark) for mark in canvas.marks if isinstance(mark, Text)]
    foot = max(z.imag.max() for z in said if z.imag.max() < min(mark.a.imag for mark in canvas.marks if isinstance(mark, Line)) + 9)
    assert min(flat(mark, 1.0).imag.min() for mark in canvas.marks if isinstance(mark, Line)) > foot


@pytest.mark.parametrize("parts", few([4, 6, 8, 10, 12], 12))
@pytest.mark.parametrize("data", [cam_data, rocker_data, flat_data])
def test_no_text_of_the_table_leaves_its_cell(monkeypatch, data, parts):
    made = []
    monkeypatch.setattr(Canvas, "table", lambda self, corner, widths, rows, *rest: made.append((widths, rows)))
    found = project(data, parts=parts)
    drawn("cam.table", found)
    for widths, rows in made:
        assert sum(widths) <= places(found)["cam.table"].width + 1e-9
        for cells in rows:
            assert all(letter(cell, 2.5).width <= w - 1.0 + 1e-9 for cell, w in zip(cells, widths, strict=True))
    labels = [cell for _, rows in made for cell in rows[0][1:]]
    assert labels[-1] == found.cam.motion.law.labels[-1]
