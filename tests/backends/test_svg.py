import re
from dataclasses import replace
from math import pi
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.backends.geometry import area, beyond, drawn, polygon, shape
from tmm_sheets.backends import svg
from tmm_sheets.drawing.ink import strokes
from tmm_sheets.drawing.marks import Arc, Box, Drawing, Fill, Line, Polyline, Text, View
from tmm_sheets.drawing.styles import line_types

NAME = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def root(drawing):
    return ElementTree.fromstring(svg.render(drawing))


def arc(start, r, large, sweep, end, step=0.05):
    """Points of an elliptical arc command with equal radii, by the formulas of the SVG standard (appendix F.6.5)."""
    half, middle = (start - end) / 2, (start + end) / 2
    r = max(r, abs(half))
    root = np.sqrt(max(r * r - abs(half) ** 2, 0.0)) / abs(half)
    centre = middle + (-1 if large == sweep else 1) * root * complex(half.imag, -half.real)
    a, b = np.angle(start - centre), np.angle(end - centre)
    turn = (b - a) % (2 * pi) if sweep else -((a - b) % (2 * pi))
    return centre + r * np.exp(1j * (a + turn * np.linspace(0, 1, int(abs(turn) * r / step) + 2)))


def points(data):
    """Parts of path data as arrays of points; only the commands M, L, A and z with absolute numbers are understood."""
    assert re.fullmatch(r"[MLAz\d. -]+", data)
    parts = []
    for name, numbers in re.findall(r"([MLAz])([^MLAz]*)", data):
        v = [float(n) for n in numbers.split()]
        if name == "M":
            parts.append([complex(*v)])
        elif name == "L":
            parts[-1].append(complex(*v))
        elif name == "A":
            assert v[0] == v[1]
            parts[-1] += arc(parts[-1][-1], v[0], v[3], v[4], complex(v[5], v[6])).tolist()
        else:
            parts[-1].append(parts[-1][0])
    return [np.array(p) for p in parts]


def test_page_is_the_sheet_in_millimetres(root):
    assert root.tag == f"{NAME}svg"
    assert (root.get("width"), root.get("height"), root.get("viewBox")) == ("841mm", "594mm", "0 0 841 594")
    assert root.find(f"{NAME}g").get("transform") == "matrix(1 0 0 -1 0 594)"
    assert root.findtext(f"{NAME}title") == "Лист 1. Строгальный станок"
    assert root.findtext(f"{NAME}desc") == "Иванов И. И."


def test_a_group_for_each_line_type_and_for_each_height_of_letters(root):
    widths = {g.get("id"): g.get("stroke-width") for g in root.find(f"{NAME}g")}
    heights = {"text-1.8": "0.18", "text-2.5": "0.25", "text-3.5": "0.35", "text-5": "0.5", "text-7": "0.7"}
    used = {k: v for k, v in heights.items() if k in widths}
    assert {"text-2.5", "text-3.5", "text-5", "text-7"} <= set(used)
    assert widths == {s.name: f"{s.width:g}" for s in line_types().values()} | {"fills": None} | used


def test_a_titled_group_for_each_view(drawing):
    views = (View("План <1>", Box(0, 0, 1, 1), ((0, 3), (10, 12))), View("Пусто", Box(0, 0, 1, 1), ()))
    root = ElementTree.fromstring(svg.render(replace(drawing, views=views)))
    whole = ElementTree.fromstring(svg.render(drawing))
    (group,) = [g for g in root.find(f"{NAME}g") if g.get("id", "").startswith("view")]
    assert group[0].tag == f"{NAME}title"
    assert group[0].text == "План <1>"
    own = [p.get("d") for p in group.iter(f"{NAME}path")]
    assert len(own) == len(list(strokes(drawing.marks[:3]))) + len(list(strokes(drawing.marks[10:12])))
    assert sorted(p.get("d") for p in root.iter(f"{NAME}path")) == sorted(p.get("d") for p in whole.iter(f"{NAME}path"))
    names = [g.get("id") for g in root.iter() if g.get("id")]
    assert len(set(names)) == len(names)


def test_every_mark_has_its_path_in_its_place(root, drawing):
    paths = {g.get("id"): [points(p.get("d")) for p in g] for g in root.find(f"{NAME}g")}
    for mark in strokes(drawing.marks):
        if isinstance(mark, Fill):
            (got,) = paths["fills"].pop(0)
            assert got[:-1] == pytest.approx(mark.points, abs=7.1e-4)
            assert got[-1] == got[0]
        elif not isinstance(mark, Text):
            (got,) = paths[mark.style].pop(0)
            if isinstance(mark, Line):
                assert got == pytest.approx(np.array([mark.a, mark.b]), abs=7.1e-4)
            elif isinstance(mark, Polyline):
                assert got[: len(mark.points)] == pytest.approx(mark.points, abs=7.1e-4)
                assert (len(got) > len(mark.points)) == mark.closed
            else:
                turned = np.unwrap(np.angle(got - mark.centre))
                assert np.abs(np.abs(got - mark.centre) - mark.radius).max() < 2e-3
                assert np.diff(turned).min() > -1e-3 / mark.radius
                assert turned[-1] - turned[0] == pytest.approx(mark.end - mark.start, abs=3e-3 / mark.radius)
                assert got[0] == pytest.approx(mark.centre + mark.radius * np.exp(1j * mark.start), abs=7.1e-4)
    assert not any(rest for name, rest in paths.items() if not name.startswith("text-"))


@pytest.mark.parametrize(("start", "end"), [(0.0, 2 * pi), (0.3, 0.3 + pi), (0.0, pi - 1e-6), (-1.0, 0.2), (2.0, 2.001)])
def test_arcs_keep_to_their_circle(start, end):
    mark = Arc(400 + 300j, 250.0, start, end, "thin")
    root = ElementTree.fromstring(svg.render(Drawing(841, 594, "", (mark,))))
    (got,) = points(next(root.iter(f"{NAME}path")).get("d"))
    assert np.abs(np.abs(got - mark.centre) - 250).max() < 2e-3
    assert got[0] == pytest.approx(mark.centre + 250 * np.exp(1j * start), abs=7.1e-4)
    assert got[-1] == pytest.approx(mark.centre + 250 * np.exp(1j * end), abs=7.1e-4)
    assert np.abs(np.diff(got)).sum() == pytest.approx(250 * (end - start), abs=5e-3)


def test_the_ink_is_that_of_the_drawing_within_five_micrometres(root, drawing):
    ink = []
    for group in root.find(f"{NAME}g"):
        for path in group:
            for part in points(path.get("d")):
                ink.append((polygon(part), 0.0) if group.get("id") == "fills" else (shape(part), float(group.get("stroke-width"))))
    got, want = area(ink), area(drawn(drawing))
    assert beyond(got, want, 0.005) == 0
    assert beyond(want, got, 0.005) == 0


def test_lettering_says_what_it_is(root, drawing):
    labels = sorted(p.get("aria-label") for p in root.iter(f"{NAME}path") if p.get("aria-label") is not None)
    assert labels == sorted(m.text for m in drawing.marks if isinstance(m, Text))


def test_no_colours_but_black_and_no_text_elements(root):
    colours = {e.get(k) for e in root.iter() for k in ("stroke", "fill") if e.get(k)}
    assert colours == {"#000", "none"}
    assert {e.tag.removeprefix(NAME) for e in root.iter()} == {"svg", "title", "desc", "g", "path"}


def test_signs_that_xml_keeps_for_itself(drawing):
    title = 'A < B & "C" > D\x07'
    root = ElementTree.fromstring(svg.render(replace(drawing, title=title, author="", marks=(Text(0j, "a < b & \"c\"", 5.0),))))
    assert root.findtext(f"{NAME}title") == title.replace("\x07", "\ufffd")
    assert root.find(f"{NAME}desc") is None
    assert next(root.iter(f"{NAME}path")).get("aria-label") == 'a < b & "c"'
