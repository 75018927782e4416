"""Plot files are read back by a reader of the tests' own: plain HPGL has six commands."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.backends.geometry import area, beyond, drawn, polygon, shape
from tmm_sheets.backends import hpgl
from tmm_sheets.drawing.marks import Box, Drawing, Fill, Line, Text
from tmm_sheets.drawing.pen_paths import plan
from tmm_sheets.drawing.plotters import Pen, plotter

UNIT = 0.025
STEP_OFF = UNIT / np.sqrt(2) + 1e-9  # a place is at most half a step off in x and in y


def commands(data):
    text = data.decode("ascii").replace("\n", "")
    assert re.fullmatch(r"(?:[A-Z]{2}[-\d.,]*;)+", text)
    for name, numbers in re.findall(r"([A-Z]{2})([-\d.,]*);", text):
        yield name, [float(v) for v in numbers.split(",") if v]


def pen_paths(data):
    """(pen, points in mm) of every stretch drawn, from the file's text."""
    pen, down = None, []
    for name, v in commands(data):
        assert name in ("IN", "SP", "VS", "PU", "PD")
        if name in ("PU", "PD"):
            assert all(n == int(n) for n in v)
        places = [UNIT * complex(x, y) for x, y in zip(v[::2], v[1::2], strict=True)] if name in ("PU", "PD") else []
        if name == "PD":
            down += places
        else:
            if len(down) > 1:
                yield pen, np.array(down)
            down = places or down[-1:]
        if name == "SP":
            pen = int(v[0])


@pytest.fixture(scope="module")
def data(drawing):
    return hpgl.render(drawing)


def test_plain_hpgl_says_nothing_an_old_plotter_does_not_know(data):
    names = [name for name, _ in commands(data)]
    assert names[0] == "IN"
    assert set(names) == {"IN", "SP", "VS", "PU", "PD"}
    assert names[-2:] == ["PU", "SP"]
    assert max(len(line) for line in data.splitlines()) < 400
    pens = [int(v[0]) for name, v in commands(data) if name == "SP"]
    assert pens == [1, 2, 3, 4, 5, 6, 7, 0]  # each taken once, thin ones first, put back at the end


def test_ink_is_that_of_the_drawing_within_a_twentieth_of_a_millimetre(data, wanted):
    widths = {p.number: p.width for p in plotter("a1").pens}
    got = area((shape(path), widths[pen]) for pen, path in pen_paths(data))
    assert beyond(got, wanted, 0.1) == 0  # at the tip of an arrow the finest pen, of 0.2 mm, is that much too round
    assert beyond(wanted, got, 0.05) == 0


def test_lines_and_letters_keep_to_half_a_step(drawing):
    bare = replace(drawing, marks=tuple(m for m in drawing.marks if not isinstance(m, Fill)))
    widths = {p.number: p.width for p in plotter("a1").pens}
    got = area((shape(path), widths[pen]) for pen, path in pen_paths(hpgl.render(bare)))
    want = area(drawn(bare))
    off = STEP_OFF + 0.005 + 0.002  # step, chords of arcs, chords of the truth
    assert beyond(got, want, off) == 0
    assert beyond(want, got, off) == 0


def test_one_hundred_millimetres_are_four_thousand_steps():
    sheet = Drawing(841, 594, "", (Line(20 + 30j, 120 + 30j, "thin"),))
    assert b"PU800,1200;\nPD4800,1200;\n" in hpgl.render(sheet)


def test_origin_in_the_centre(drawing):
    corner = np.concatenate([p for _, p in pen_paths(hpgl.render(drawing, plotter("a1")))])
    centre = np.concatenate([p for _, p in pen_paths(hpgl.render(drawing, plotter("a1_centre")))])
    assert centre.real.min() + 420.5 == pytest.approx(corner.real.min(), abs=1e-9)
    assert centre.imag.max() + 297 == pytest.approx(corner.imag.max(), abs=1e-9)


def test_thick_lines_by_passes_of_a_thin_pen(drawing):
    """One pen of 0.3 mm makes every width there is, within 0.05 mm, and leaves no white inside."""
    machine = replace(plotter("a3"), reach=Box(0, 0, 841, 594))
    sheet = replace(drawing, marks=tuple(m for m in drawing.marks if not isinstance(m, Fill | Text)))
    got = area((shape(path), 0.3) for _, path in pen_paths(hpgl.render(sheet, machine)))
    thick = replace(sheet, marks=tuple(m for m in sheet.marks if m.style in ("main", "curve", "axis", "hidden", "vector")))
    want = area(drawn(thick))
    assert beyond(want, got, 0.03) == 0
    assert beyond(got, area([(s, max(w, 0.3)) for s, w in drawn(sheet)]), 0.03) == 0


def test_lines_beyond_the_reach_are_cut_off_and_told(drawing):
    machine = replace(plotter("a1"), reach=Box(100, 100, 300, 300))
    drawing = replace(drawing, marks=tuple(m for m in drawing.marks if not isinstance(m, Fill)))
    made = plan(drawing, machine)
    places = UNIT * np.array([p for layer in made.layers for path in layer.paths for p in path])
    assert places.min() >= 100 - 1e-9
    assert places.max() <= 300 + 1e-9
    whole = plan(drawing, plotter("a1"))
    assert whole.lost == 0
    assert made.lost + made.drawn + made.doubled == pytest.approx(whole.drawn + whole.doubled, rel=2e-3)


def test_a_window_comes_to_the_corner_of_the_paper():
    sheet = Drawing(841, 594, "", (Line(400 + 300j, 500 + 300j, "thin"), Line(0j, 10 + 10j, "thin")))
    made = plan(sheet, plotter("a3"), Box(390, 290, 450, 350))
    assert [layer.paths for layer in made.layers] == [(((400, 400), (2400, 400)),)]
    assert (made.lost, made.width, made.height) == (0, 60, 60)


def test_windows_side_by_side_draw_all_of_the_sheet(drawing, wanted):
    machine = replace(plotter("a1"), reach=Box(0, 0, 400, 276))
    parts = []
    for x in (0, 300, 600):
        for y in (0, 250, 500):
            for layer in plan(drawing, machine, Box(x, y, min(x + 300, 841), min(y + 250, 594))).layers:
                parts += [(shape(UNIT * (np.array(p) @ [1, 1j]) + complex(x, y)), layer.pen.width) for p in layer.paths]
    assert beyond(wanted, area(parts), 0.05) == 0


# --- HPGL/2 ---------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def printed(drawing):
    return hpgl.render(drawing, plotter("printer")).decode("ascii")


def test_printer_file_is_wrapped_in_pjl(printed):
    head, _, rest = printed.partition("\x1b%0B")
    body, _, tail = rest.partition("\x1b%0A")
    assert head == '\x1b%-12345X@PJL JOB NAME="____ 1. ___________ ______"\r\n@PJL ENTER LANGUAGE=HPGL2\r\n'
    assert tail == "\x1b%-12345X@PJL EOJ\r\n\x1b%-12345X"
    assert body.startswith("BP;IN;PS33640,23760;\nLA1,4,2,4;\nSP1;\n")
    assert body.endswith("PU0,0;\nSP0;\nPG;")


def test_printer_makes_every_width_and_fills_by_itself(printed, drawing, wanted):
    body = printed.partition("\x1b%0B")[2].partition("\x1b%0A")[0].replace("\n", "")
    strokes, width, path, inside = [], None, [], False
    for name, numbers in re.findall(r"([A-Z]{2})([-\d.,]*);", body):
        v = [float(n) for n in numbers.split(",") if n]
        if name == "PW":
            width = v[0]
        elif name == "PU":
            path = [UNIT * complex(*v)]
        elif name == "PD":
            places = [UNIT * complex(x, y) for x, y in zip(v[::2], v[1::2], strict=True)]
            if not inside:
                strokes.append((shape(np.array([path[-1], *places])), width))
            path += places
        elif name == "PM":
            inside = v[0] == 0
        elif name == "FP":
            strokes.append((polygon(np.array(path)), 0.0))
    got = area(strokes)
    assert sum(w == 0 for _, w in strokes) == sum(isinstance(m, Fill) for m in drawing.marks)
    assert beyond(got, wanted, STEP_OFF + 0.007) == 0
    assert beyond(wanted, got, STEP_OFF + 0.007) == 0


# --- what the plan says of itself, and reading back -----------------------------------------------------------------


def test_reported_lengths_are_those_of_the_file(data, drawing):
    made = plan(drawing, plotter("a1"))
    paths = [p for _, p in pen_paths(data)]
    starts, ends = [p[0] for p in paths], [0j, *(p[-1] for p in paths)]
    assert sum(np.abs(np.diff(p)).sum() for p in paths) == pytest.approx(made.drawn, abs=0.01)
    assert sum(abs(a - b) for a, b in zip(starts, ends, strict=False)) == pytest.approx(made.travel, abs=0.01)
    assert made.travel < 0.5 * made.travel_before
    assert made.paths == len(paths)


@pytest.mark.parametrize("name", ["a1", "a1_centre", "printer"])
def test_preview_reads_what_was_written(drawing, name):
    machine = plotter(name)
    made = plan(drawing, machine)
    got = hpgl.read(hpgl.encode(made, drawing.title), machine)
    lines = [s for s in got.strokes if not s.filled]
    want = [(layer.pen.width, UNIT * (np.array(path if len(path) > 1 else path * 2) @ [1, 1j]))
            for layer in made.layers for path in layer.paths]  # fmt: skip
    assert len(lines) == len(want)
    for stroke, (width, points) in zip(lines, want, strict=True):
        assert stroke.width == width
        assert stroke.points == pytest.approx(points, abs=1e-9)
    assert sum(s.filled for s in got.strokes) == sum(len(layer.areas) for layer in made.layers)
    assert got.size == ((841, 594) if name == "printer" else None)
    assert got.pens == ([1] if name == "printer" else [p.number for p in machine.pens])


@pytest.mark.parametrize(
    ("text", "said"),
    [("IN;SP1;PA10,10;", "'PA10,10;' at character 7"), ("IN;PU1;", "'PU1;' at character 3: a number"),
     ("%PDF-1.4", "at character 0"), ("IN;PW;", "a number is missing")],
)  # fmt: skip
def test_what_is_not_ours_is_not_guessed_at(text, said):
    with pytest.raises(ValueError, match=re.escape(said)):
        hpgl.read(text.encode(), plotter("a1"))


def test_missing_letter_and_lost_places_are_named(drawing):
    with pytest.raises(ValueError, match=r"'漢' \(U\+6F22\)"):
        hpgl.render(replace(drawing, marks=(Text(0j, "план 漢", 5.0),)))
    for mark in (Line(0j, complex("nan"), "thin", "velocity plan"), Fill(np.array([0, 1, np.inf]), "thin", "velocity plan")):
        with pytest.raises(ValueError, match="'velocity plan' has no finite place"):
            hpgl.render(replace(drawing, marks=(mark,)))


def test_a_dot_is_drawn():
    machine = replace(plotter("a1"), pens=(Pen(3, 0.8),))
    data = hpgl.render(Drawing(841, 594, "", (Line(100 + 100j, 100 + 100j, "main"),)), machine)
    assert b"PU4000,4000;\nPD4000,4000;\n" in data


def test_nothing_is_drawn_twice(data):
    pieces = [(pen, *sorted((p[i : i + 2] / UNIT).round().tolist(), key=lambda z: (z.real, z.imag)))
              for pen, p in pen_paths(data) for i in range(len(p) - 1)]  # fmt: skip
    assert len(pieces) == len(set(pieces))
