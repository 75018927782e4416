import re
import zlib
from dataclasses import replace
from math import cos, pi, sin
from xml.etree import ElementTree

import numpy as np
import pytest

from tmm_sheets.backends import pdf
from tmm_sheets.drawing.ink import strokes
from tmm_sheets.drawing.lettering import advance
from tmm_sheets.drawing.marks import Arc, Box, Drawing, Fill, Line, Polyline, Text, View
from tmm_sheets.drawing.styles import line_types, roles
from tmm_sheets.words import tr

MM = 72 / 25.4


@pytest.fixture(scope="module")
def data(drawing):
    return pdf.render(drawing)


def streams(data):
    for m in re.finditer(rb"<<[^<>]*?/Length (\d+)[^<>]*?>>\s*stream\r?\n", data):
        yield zlib.decompress(data[m.end() : m.end() + int(m[1])])


ESCAPES = {"n": "\n", "r": "\r", "t": "\t", "b": "\b", "f": "\f"}


def strings(pattern, text):
    """Contents of PDF strings in brackets, escapes undone, where ``pattern`` holds %s for the string."""
    def literal(escape):
        return chr(int(escape[1], 8)) if escape[1].isdigit() else ESCAPES.get(escape[1], escape[1])

    for m in re.finditer(pattern.replace("%s", r"\(((?:\\.|[^\\])*?)\)"), text, re.S):
        yield re.sub(r"\\([0-7]{3}|.)", literal, m[1], flags=re.S)


@pytest.fixture(scope="module")
def page(data):
    return next(s.decode("latin-1") for s in streams(data) if b" cm 0 g" in s)


@pytest.fixture(scope="module")
def unicode_map(data):
    """Code of the embedded font -> character, from the file's own ToUnicode table."""
    cmap = next(s.decode("latin-1") for s in streams(data) if b"begincmap" in s)
    return {int(code, 16): chr(int(u, 16)) for code, u in re.findall(r"^<(\w\w)> <(\w{4})>$", cmap, re.M)}


def shown(page, unicode_map):
    for code in strings(r"%s Tj\n", page):
        yield "".join(unicode_map[ord(c)] for c in code)


def test_page_is_the_sheet_and_viewers_must_not_shrink_it(data):
    box = re.search(rb"/MediaBox \[ ([\d. ]+) \]", data)[1].split()
    assert [float(v) / MM for v in box] == pytest.approx([0, 0, 841, 594], abs=1e-3)
    assert data.count(b"/Type /Page\n") + data.count(b"/Type /Page ") == 1
    assert b"/PrintScaling /None" in data
    assert b"%.9f 0 0 %.9f 0 0 cm" % (MM, MM) in next(s for s in streams(data) if b" cm 0 g" in s)


def test_the_only_font_is_ours_embedded(data):
    assert set(re.findall(rb"/BaseFont /(\S+)", data)) == {b"AAAAAA+TMMSheetsB-Italic"}
    assert data.count(b"/FontFile2") == 1


def test_title_and_author(data):
    text = data.decode("latin-1")
    for key, want in (("Title", "Лист 1. Строгальный станок"), ("Author", "Иванов И. И.")):
        (got,) = strings(f"/{key} %s /", text)
        assert got.encode("latin-1").decode("utf-16") == want


def test_version_language_and_metadata(monkeypatch):
    told = Drawing(841, 594, "Лист & <1>", (Line(0j, 1j, "main"),), "Иванов", "ТММ.КП", "ТММ, чертёж")
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    data = pdf.render(told, 1700000000)
    assert data.startswith(b"%PDF-1.7")
    assert data.count(b"20231114221320") == 2  # CreationDate, ModDate: 2023-11-14 22:13:20 UTC
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert pdf.render(told) == data
    assert b"/Lang (ru)" in data
    text = data.decode("latin-1")
    for key, want in (("Subject", "ТММ.КП"), ("Keywords", "ТММ, чертёж")):
        (got,) = strings(f"/{key} %s /", text)
        assert got.encode("latin-1").decode("utf-16") == want
    packet = ElementTree.fromstring(re.search(rb"<x:xmpmeta.*</x:xmpmeta>", data, re.S)[0])
    words = {e.tag.rpartition("}")[2]: "".join(e.itertext()).strip() for e in packet.iter()}
    assert words["title"] == "Лист & <1>"
    assert (words["creator"], words["description"], words["subject"]) == ("Иванов", "ТММ.КП", "ТММчертёж")
    assert words["CreateDate"] == words["ModifyDate"] == "2023-11-14T22:13:20Z"


def test_layers_are_the_roles(data, page):
    names = [got.encode("latin-1").decode("utf-16") for got in strings(r"/Name %s /Type /OCG", data.decode("latin-1"))]
    assert sorted(names) == sorted(tr(row["description"]) for row in roles().values())
    order = list(roles())
    opened = re.findall(r"^/OC /L(\d+) BDC$", page, re.M)
    assert page.count("EMC") == len(opened)
    assert {order[int(n)] for n in opened} == {"symbol", "curve", "axis", "construction", "link", "hatch", "text", "vector"}
    assert page.index("BT\n") > page.rindex(f"/OC /L{order.index('text')} BDC")


def test_one_file_with_bookmarks(drawing):
    views = (View("План скоростей", Box(20, 100, 220, 300), ((0, 3),)), View("План (2)", Box(300, 5, 400, 105), ((3, 9),)))
    sheets = [replace(drawing, views=views), Drawing(420, 297, "Лист 2", (Line(0j, 1j, "main"),))]
    data = pdf.render_all(sheets)
    assert data == pdf.render_all(sheets)
    text = data.decode("latin-1")
    boxes = [[float(v) / MM for v in m.split()] for m in re.findall(r"/MediaBox \[ ([\d. ]+) \]", text)]
    assert np.array(boxes) == pytest.approx(np.array([[0, 0, 841, 594], [0, 0, 420, 297]]), abs=1e-3)
    titles = [t.encode("latin-1").decode("utf-16") for t in strings(r"/Title %s", text.partition("/Outlines")[0] + text)
              if t.startswith("\xfe\xff")]
    assert set(titles) == {drawing.title, "План скоростей", "План (2)", "Лист 2"}
    fits = [[float(v) / MM for v in m.split()] for m in re.findall(r"/FitR ([\d. ]+) \]", text)]
    assert np.array(fits) == pytest.approx(np.array([[20, 100, 220, 300], [300, 5, 400, 105]]), abs=1e-3)


def test_black_only(page):
    assert re.findall(r"\b(?:rg|RG|k|K|sc|SC|scn|SCN|cs|CS|gs)\b", re.sub(r"\((?:\\.|[^\\)])*\) Tj", "", page)) == []
    assert "0 g 0 G" in page.splitlines()[1]


def test_lettering_can_be_extracted_in_the_order_of_the_drawing(page, unicode_map, drawing):
    assert list(shown(page, unicode_map)) == [m.text for m in drawing.marks if isinstance(m, Text)]


def test_lettering_is_placed_turned_and_sized_as_drawn(page, drawing):
    places = np.array([list(map(float, m.split())) for m in re.findall(r"^((?:[-\d.]+ ){6})Tm", page, re.M)])
    sizes = [float(s) for s in re.findall(r"([\d.]+) Tf", page)]
    texts = [m for m in drawing.marks if isinstance(m, Text)]
    want = [(cos(m.angle), sin(m.angle), -sin(m.angle), cos(m.angle), m.at.real, m.at.imag) for m in texts]
    assert places == pytest.approx(np.array(want), abs=5.1e-4)
    changes = [m.height for i, m in enumerate(texts) if i == 0 or m.height != texts[i - 1].height]
    assert sizes == pytest.approx([h / 0.7 for h in changes], abs=1e-4)


def test_embedded_widths_are_those_of_the_lettering(data, unicode_map):
    widths = list(map(float, re.search(rb"/Widths \[([\d.\s]+)\]", data)[1].split()))
    for code, char in unicode_map.items():
        if char not in "\0" and code != 32:
            assert widths[code] / 1000 / 0.7 == pytest.approx(advance(char, 1.0), abs=1e-9)


def points_of(page):
    """Every path as (line width, operator, numbers)."""
    width = None
    for line in page.split("BT\n")[0].splitlines():
        if m := re.fullmatch(r"([\d.]+) w", line):
            width = float(m[1])
        elif line.split() and line.split()[-1] in "SsfB" and " m " in line:
            yield width, line.split()[-1], [float(v) for v in re.findall(r"-?\d+\.\d+", line)]


def test_every_stroke_has_its_place_and_true_width(page, drawing):
    drawn = list(points_of(page))
    want = [m for m in strokes(drawing.marks) if not isinstance(m, Text)]
    assert len(drawn) == len(want)
    for style in line_types().values():
        assert any(w == style.width for w, _, _ in drawn)
    lines = sorted((w, *xy) for w, op, xy in drawn if op == "S" and len(xy) == 4)
    expected = sorted((line_types()[m.style].width, m.a.real, m.a.imag, m.b.real, m.b.imag) for m in want if isinstance(m, Line))
    expected += [(line_types()[m.style].width, *np.column_stack((m.points.real, m.points.imag)).ravel()) for m in want
                 if isinstance(m, Polyline) and len(m.points) == 2]  # fmt: skip
    assert np.array(lines) == pytest.approx(np.array(sorted(expected)), abs=5.1e-4)
    assert sum(op == "f" for _, op, _ in drawn) == sum(isinstance(m, Fill) for m in want)


@pytest.mark.parametrize(("start", "end"), [(0.0, 2 * pi), (0.3, 4.0), (-1.0, 0.2), (2.0, 2.001)])
def test_arcs_keep_to_their_circle(start, end):
    arc = Arc(400 + 300j, 250.0, start, end, "thin")
    page = next(s.decode("latin-1") for s in streams(pdf.render(Drawing(841, 594, "", (arc,)))) if b" cm 0 g" in s)
    ((_, _, xy),) = points_of(page)
    p = np.array(xy).reshape(-1, 2) @ [1, 1j]
    assert p[0] == pytest.approx(arc.centre + 250 * np.exp(1j * start), abs=1e-3)
    assert p[-1] == pytest.approx(arc.centre + 250 * np.exp(1j * end), abs=1e-3)
    t = np.linspace(0, 1, 33)[:, None]
    for k in range(0, len(p) - 1, 3):
        curve = ((1 - t) ** 3 * p[k] + 3 * t * (1 - t) ** 2 * p[k + 1] + 3 * t**2 * (1 - t) * p[k + 2] + t**3 * p[k + 3])
        assert np.abs(np.abs(curve - arc.centre) - 250).max() < 2e-3


def test_missing_letter_and_lost_places_are_named(drawing):
    with pytest.raises(ValueError, match=r"'漢' \(U\+6F22\) in 'план 漢'"):
        pdf.render(replace(drawing, marks=(Text(0j, "план 漢", 5.0),)))
    for mark in (
        Line(0j, complex("nan"), "thin", "velocity plan"), Arc(0j, float("nan"), 0.0, 1.0, "centre", "velocity plan"),
        Fill(np.array([0, 1, np.inf]), "thin", "velocity plan"), Text(complex("nan+1j"), "а", 5.0, 0.0, "velocity plan"),
        Line(0j, complex("inf"), "centre", "velocity plan"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match="'velocity plan' has no finite place"):
            pdf.render(replace(drawing, marks=(Line(0j, 1j, "main", "frame"), mark)))
