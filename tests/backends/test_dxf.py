from collections import Counter
from dataclasses import replace
from io import StringIO
from math import cos, degrees, pi, sin

import ezdxf
import numpy as np
import pytest
from ezdxf.lldxf.const import VALID_DXF_LINEWEIGHTS

from tmm_sheets.backends import dxf
from tmm_sheets.drawing.ink import strokes
from tmm_sheets.drawing.lettering import strokes as letter_strokes
from tmm_sheets.drawing.marks import Arc, Drawing, Fill, Line, Polyline, Text
from tmm_sheets.drawing.styles import layer, line_types


@pytest.fixture(scope="module")
def data(drawing):
    return dxf.render(drawing, "strokes").decode("utf-8")


@pytest.fixture(scope="module")
def doc(data):
    return ezdxf.read(StringIO(data))


def test_audit_finds_nothing(doc):
    audit = doc.audit()
    assert (audit.errors, audit.fixes) == ([], [])


def test_handles_are_unique_and_below_the_next_free_one(data, doc):
    lines = data.splitlines()
    tags = list(zip(lines[::2], lines[1::2], strict=True))
    seed = int(tags[tags.index(("  9", "$HANDSEED")) + 1][1], 16)
    handles = [int(v, 16) for code, v in tags[tags.index(("  2", "CLASSES")) :] if code.strip() in ("5", "105")]
    assert max(Counter(handles).values()) == 1
    assert len(handles) > len(doc.modelspace())
    assert max(handles) < seed


def test_units_version_and_the_layout_one_to_one(doc):
    assert doc.dxfversion == "AC1024"
    assert [doc.header[k] for k in ("$INSUNITS", "$MEASUREMENT", "$LWDISPLAY")] == [4, 1, 1]
    layout = doc.layout("Layout1")
    assert (layout.dxf.paper_width, layout.dxf.paper_height) == (841, 594)
    assert {layout.dxf.get(f"{side}_margin") for side in ("left", "right", "top", "bottom")} == {0}
    views = [v for v in layout.query("VIEWPORT") if v.dxf.id != 1]
    assert len(views) == 1
    assert views[0].dxf.view_height == views[0].dxf.height == 594
    assert views[0].dxf.view_center_point.vec2 == views[0].dxf.center.vec2 == (420.5, 297)
    assert not doc.layers.get(views[0].dxf.layer).dxf.plot


def test_layers_carry_the_line_types(doc, drawing):
    for mark in drawing.marks:
        if isinstance(mark, Text):
            continue
        style, on = line_types()[mark.style], doc.layers.get(layer(mark).name)
        assert (on.dxf.lineweight, on.color, on.dxf.linetype) == (round(100 * style.width), style.colour, style.linetype)
        if style.pattern:
            tags = [t.value for t in doc.linetypes.get(style.linetype).pattern_tags.tags if t.code == 49]
            assert tags == list(style.pattern)


def test_every_mark_is_there(doc, drawing):
    kinds = Counter(e.dxftype() for e in doc.modelspace())
    want = list(strokes(drawing.marks))
    fills = [len(m.points) for m in want if isinstance(m, Fill)]
    circles = [m for m in want if isinstance(m, Arc) and m.end - m.start == 2 * pi]
    letters = sum(len(letter_strokes(m.text, m.height)) for m in want if isinstance(m, Text))
    assert kinds == {
        "LINE": sum(isinstance(m, Line) for m in want), "CIRCLE": len(circles),
        "ARC": sum(isinstance(m, Arc) for m in want) - len(circles), "SOLID": sum(n <= 4 for n in fills),
        "HATCH": sum(n > 4 for n in fills), "LWPOLYLINE": sum(isinstance(m, Polyline) for m in want) + letters,
    }  # fmt: skip


def test_places_to_a_tenth_of_a_micrometre(doc, drawing):
    want = list(strokes(drawing.marks))
    space = doc.modelspace()
    lines = [(complex(*e.dxf.start.vec2), complex(*e.dxf.end.vec2)) for e in space.query("LINE")]
    assert np.array(lines) == pytest.approx(np.array([(m.a, m.b) for m in want if isinstance(m, Line)]), abs=7.2e-5)
    arcs = [(complex(*e.dxf.center.vec2), e.dxf.radius, e.dxf.start_angle, e.dxf.end_angle) for e in space.query("ARC")]
    expected = [(m.centre, m.radius, degrees(m.start) % 360, degrees(m.end) % 360) for m in want
                if isinstance(m, Arc) and m.end - m.start < 2 * pi]  # fmt: skip
    assert np.array(arcs) == pytest.approx(np.array(expected), abs=7.2e-5)
    curves = [e for e in space.query("LWPOLYLINE") if not e.dxf.hasattr("lineweight")]
    wanted = [m for m in want if isinstance(m, Polyline)]
    for entity, mark in zip(curves, wanted, strict=True):
        assert entity.closed == mark.closed
        assert np.array([complex(x, y) for x, y in entity.get_points("xy")]) == pytest.approx(mark.points, abs=7.2e-5)


def test_dashes_are_strokes_so_entities_are_continuous(doc):
    for entity in doc.modelspace():
        if doc.layers.get(entity.dxf.layer).dxf.linetype != "Continuous":
            assert entity.dxf.linetype == "Continuous"
        else:
            assert entity.dxf.linetype == "BYLAYER"


def test_filled_areas_have_no_outline_of_their_own(doc):
    assert {e.dxf.lineweight for e in doc.modelspace().query("SOLID HATCH")} == {0}


def test_solids_fill_what_was_asked(doc, drawing):
    solids = [[complex(*v.vec2) for v in e.wcs_vertices()] for e in doc.modelspace().query("SOLID")]
    marks = [m.points for m in drawing.marks if isinstance(m, Fill) and len(m.points) <= 4]
    for got, want in zip(solids, marks, strict=True):
        assert set(np.round(got, 3)) == set(np.round(want, 3))
        ring, area = np.array(got), lambda p: 0.5 * float(np.sum((p.conj() * np.roll(p, -1)).imag))
        assert abs(area(ring)) == pytest.approx(abs(area(np.asarray(want))), abs=1e-2)
    (hatch,) = doc.modelspace().query("HATCH")
    assert hatch.dxf.solid_fill == 1
    assert len(hatch.paths.paths[0].vertices) == 12


def test_lettering_is_the_strokes_of_the_letters_in_their_pen(doc, drawing):
    entities = [e for e in doc.modelspace().query("LWPOLYLINE[layer=='TEXT']") if e.dxf.hasattr("lineweight")]
    want = [(m, s) for m in drawing.marks if isinstance(m, Text) for s in letter_strokes(m.text, m.height)]
    for entity, (mark, stroke) in zip(entities, want, strict=True):
        placed = mark.at + complex(cos(mark.angle), sin(mark.angle)) * stroke
        assert np.array([complex(x, y) for x, y in entity.get_points("xy")]) == pytest.approx(placed, abs=7.2e-5)
        assert entity.dxf.lineweight in VALID_DXF_LINEWEIGHTS
        assert entity.dxf.lineweight == pytest.approx(10 * mark.height, abs=0.1)
    assert not doc.modelspace().query("TEXT MTEXT")


def test_title_and_author(doc):
    assert list(doc.header.custom_vars) == [("Title", "Лист 1. Строгальный станок"), ("Author", "Иванов И. И.")]


@pytest.mark.parametrize("text", ["live", "strokes"])
def test_missing_letter_and_lost_places_are_named(drawing, text):
    with pytest.raises(ValueError, match=r"'漢' \(U\+6F22\)"):
        dxf.render(replace(drawing, marks=(Text(0j, "план 漢", 5.0),)), text)
    for mark in (
        Line(0j, complex("nan"), "thin", "velocity plan"), Arc(0j, float("nan"), 0.0, 1.0, "centre", "velocity plan"),
        Fill(np.array([0, 1, np.inf]), "thin", "velocity plan"), Text(complex("nan+1j"), "а", 5.0, 0.0, "velocity plan"),
        Line(0j, complex("inf"), "centre", "velocity plan"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match="'velocity plan' has no finite place"):
            dxf.render(replace(drawing, marks=(Line(0j, 1j, "main", "frame"), mark)), text)


@pytest.mark.parametrize("text", ["live", "strokes"])
def test_words_do_not_look_like_a_lost_place(text):
    assert dxf.render(Drawing(841, 594, "nan inf", (Text(0j, "inf nan", 5.0, 0.0, "nan"),)), text)
