"""Sheets as CAD programs work with them, read by ezdxf; how long lettering is says the TrueType font itself (fontTools)."""

import re
from collections import Counter
from functools import cache
from io import StringIO
from math import cos, degrees, pi, sin

import ezdxf
import numpy as np
import pytest
from ezdxf import bbox
from fontTools.ttLib import TTFont

from tmm_sheets import catalogue
from tmm_sheets.backends import dxf
from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink import interrupted, letters
from tmm_sheets.drawing.lettering import glyph
from tmm_sheets.drawing.marks import Arc, Drawing, Form, FormField, Line, Polyline, Text, View
from tmm_sheets.drawing.paper import draw_frame
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.project import Project
from tmm_sheets.resources import template
from tmm_sheets.sheets.sheet import composed

SHAPER = Project(catalogue.read("lugansk/shaper"))


@cache
def drawing_of(n):
    return composed(SHAPER, n).drawing


def opened(data):
    return ezdxf.read(StringIO(data.decode("utf-8")))


@pytest.fixture(scope="module", params=[1, 2, 3, 4])
def sheet(request):
    return drawing_of(request.param), opened(dxf.render(drawing_of(request.param)))


def everywhere(doc):
    """Entities of model space and of the blocks of dimensions and forms."""
    yield from doc.modelspace()
    for block in doc.blocks:
        if not block.is_any_layout:
            yield from block


def z(point):
    return complex(point[0], point[1])


def test_audit_finds_nothing(sheet):
    audit = sheet[1].audit()
    assert (audit.errors, audit.fixes) == ([], [])


def test_handles_are_unique_and_below_the_next_free_one():
    lines = dxf.render(drawing_of(3)).decode("utf-8").splitlines()
    tags = [(code.strip(), value) for code, value in zip(lines[::2], lines[1::2], strict=True)]
    seed = int(tags[tags.index(("9", "$HANDSEED")) + 1][1], 16)
    start = tags.index(("2", "CLASSES"))
    handles = [int(v, 16) for code, v in tags[start:] if code in ("5", "105")]
    assert max(Counter(handles).values()) == 1
    assert max(handles) < seed
    known = set(handles) | {0}
    assert {int(v, 16) for code, v in tags[start:] if code == "330"} <= known


def test_first_sheet_is_small():
    """By what is drawn on it: a detail more is 40 marks more."""
    drawing = drawing_of(1)
    assert len(dxf.render(drawing)) <= 225 * len(drawing.marks)


def test_all_lettering_can_be_found(sheet):
    drawing, doc = sheet
    found = Counter(e.dxf.text for e in everywhere(doc) if e.dxftype() == "TEXT" and not e.dxf.invisible)
    found += Counter(a.dxf.text for insert in doc.modelspace().query("INSERT") for a in insert.attribs if a.dxf.text)
    words = (word.strip() for m in drawing.marks if isinstance(m, Text) for word in m.text.split("→"))
    assert found == Counter(filter(None, words))


def test_lettering_is_as_long_as_in_the_font(sheet):
    drawing, doc = sheet
    font = TTFont(template("fonts/TMMSheetsB.ttf"))
    widths, names = font["hmtx"], font.getBestCmap()
    em = font["head"].unitsPerEm
    style = doc.styles.get("lc_opengost-br")
    assert style.dxf.font == "TMMSheetsB.ttf"
    assert style.get_extended_font_data() == (font["name"].getDebugName(1), True, False)
    fitted = [e for e in everywhere(doc) if e.dxftype() == "TEXT" and len(e.dxf.text) > 1 and not e.dxf.invisible]
    assert len(fitted) > 100
    wide = {m.text.strip(): m.wide for m in drawing.marks if isinstance(m, Text)}  # condensed where there is little room
    for e in fitted:
        kind, first, last = e.get_placement()
        assert kind.name == "FIT"
        size = e.dxf.height / 0.7  # capitals are 0.7 em high
        letters = sum(widths[names[ord(c)]][0] for c in e.dxf.text) / em * size
        ink = glyph(e.dxf.text[0])
        gap = widths[names[ord(e.dxf.text[0])]][0] / em * size - (ink.right - ink.left - 0.1) * e.dxf.height
        length = (letters - gap) * wide.get(e.dxf.text, 1.0)  # without the gap round one letter
        assert abs(z(last) - z(first)) == pytest.approx(length, abs=3e-4)
        assert degrees(np.angle(z(last) - z(first))) % 360 == pytest.approx(e.dxf.rotation % 360, abs=0.01)
    forms = {k for form in drawing.forms for f in form.fields for k in range(f.first, f.end)}
    starts = np.array([m.at for k, m in enumerate(drawing.marks) if isinstance(m, Text) and k not in forms and m.text[0] != " "
                       and "→" not in m.text and m.text.strip()])
    placed = np.array([z(e.dxf.insert) for e in everywhere(doc) if e.dxftype() == "TEXT" and not e.dxf.invisible])
    assert np.abs(starts[:, None] - placed[None, :]).min(axis=1).max() < 1e-3


def test_circles_and_axes_are_whole_and_of_their_line_types():
    drawing, doc = drawing_of(3), opened(dxf.render(drawing_of(3)))
    whole = [m for m in drawing.marks if isinstance(m, Line | Arc | Polyline) and line_type(m.style).pattern]
    assert sum(isinstance(m, Arc) for m in whole) >= 4
    dashed = [piece for m in whole for piece in interrupted(m)]
    assert len(dashed) <= len(whole) + 10
    own = [e for e in everywhere(doc) if doc.layers.get(e.dxf.layer).dxf.linetype != "Continuous"]
    assert len(own) == len(dashed)
    assert {e.dxf.linetype for e in own} == {"BYLAYER"}
    radii = sorted(m.radius for m in dashed if isinstance(m, Arc))
    assert sorted(e.dxf.radius for e in own if e.dxftype() in ("ARC", "CIRCLE")) == pytest.approx(radii, abs=1e-4)


def test_dimensions_measure_what_they_say():
    gear = SHAPER.gear
    doc = opened(dxf.render(drawing_of(3)))
    said = {}
    for d in doc.modelspace().query("DIMENSION"):
        name, _, number = d.dxf.text.partition(" = ")
        assert name.strip()
        assert len(doc.blocks.get(d.dxf.geometry)) > 2
        if d.dimtype == 2:
            assert not number or _degrees(number) == pytest.approx(d.get_measurement(), abs=0.009)
        elif number:
            factor = d.override().get("dimlfac")
            said[name] = float(number.replace(",", ".")), d.get_measurement() * factor, d.dimtype
            assert d.dxf.actual_measurement == pytest.approx(d.get_measurement() * factor, abs=1e-3)
    one, two = gear.wheels
    real = {r"a\S^ w;": gear.a_w, r"c\S*^ ;m": gear.clearance * gear.m, "ym": gear.ym,
            r"h\S^ a;\S*^ ;m": SHAPER.variant.gear.addendum * gear.m, "p": np.pi * gear.m}  # the last two of the rack
    real |= {f"{name}{index}{i};": getattr(w, key) for i, w in ((1, one), (2, two)) for name, index, key in (
        ("r", r"\S^ a", "ra"), ("r", r"\S^ w", "rw"), ("r", r"\S^ ", "r"), ("r", r"\S^ b", "rb"), ("r", r"\S^ f", "rf"),
        ("s", r"\S^ ", "s_chord"), ("p", r"\S^ ", "p_chord"), ("ρ", r"\S^ f", "fillet"))}
    shift, measured, _ = said.pop("xm")  # of the rack
    assert shift == pytest.approx(measured, abs=0.0051)
    assert said.keys() <= real.keys()
    assert len(said) >= 15
    for name, (number, measured, kind) in said.items():
        assert number == pytest.approx(1e3 * real[name], abs=0.0051)
        assert measured == pytest.approx(1e3 * real[name], abs=0.01 if name[0] in "sρ" else 1e-4)
        assert kind == (4 if name[0] in "rρ" else 1)


def _degrees(text):
    """Degrees of "21°14′" or "38,10°"."""
    whole, _, minutes = text.replace(",", ".").strip("°′").partition("°")
    return float(whole) + float(minutes or 0) / 60


def test_no_dimension_says_nothing():
    for name, n in (("lugansk/shaper", 2), ("lugansk/shaper", 4), ("press", 1)):
        doc = opened(dxf.render(composed(Project(catalogue.read(name)), n).drawing))
        texts = [d.dxf.text for d in doc.modelspace().query("DIMENSION")]
        assert texts
        assert all(text.strip() for text in texts)


def test_angles_are_dimensions_with_their_lettering_in_them():
    canvas = Canvas()
    canvas.begin(Box(0, 0, 841, 594), "", "view")
    canvas.angle_mark(100 + 100j, 0.2, 1.2, 40.0, "α_w = 57°")
    canvas.angle_mark(300 + 100j, 0.2, 4.2, 40.0, "φ")
    place(canvas, Box(0, 0, 841, 594))
    doc = opened(dxf.render(Drawing(841, 594, "", tuple(canvas.marks), dimensions=tuple(canvas.dimensions))))
    (d,) = doc.modelspace().query("DIMENSION")  # two lines have no angle of more than half a turn
    assert d.get_measurement() == pytest.approx(degrees(1.0), abs=1e-3)
    assert d.dxf.text == r"α\S^ w; = 57°"
    assert [e.dxf.text for e in doc.blocks.get(d.dxf.geometry).query("TEXT")] == ["α", "w", "= 57°"]
    assert [e.dxf.text for e in doc.modelspace().query("TEXT")] == ["φ"]
    assert not doc.audit().has_issues


def test_a_dimension_drawn_by_hand_has_its_places():
    canvas = Canvas()
    canvas.dimension(100 + 100j, 160 + 180j, 12.0, "l_{AB} = 100")
    doc = opened(dxf.render(Drawing(841, 594, "", tuple(canvas.marks), dimensions=tuple(canvas.dimensions))))
    (d,) = doc.modelspace()
    assert d.get_measurement() == pytest.approx(100, abs=1e-4)
    assert (z(d.dxf.defpoint2), z(d.dxf.defpoint3)) == (100 + 100j, 160 + 180j)
    n = 1j * (0.6 + 0.8j)
    assert z(d.dxf.defpoint) == pytest.approx(160 + 180j + 12 * n, abs=1e-4)
    assert d.dxf.text == r"l\S^ AB; = 100"
    drawn = bbox.extents(doc.blocks.get(d.dxf.geometry))
    assert drawn.extmin.x >= 100 + (14 * n).real - 1
    assert [e.dxf.text for e in doc.blocks.get(d.dxf.geometry).query("TEXT")] == ["l", "AB", "= 100"]


def test_title_block_is_filled_in_and_read_again(tmp_path):
    path = tmp_path / "sheet.dxf"
    path.write_bytes(dxf.render(drawing_of(1)))
    doc = ezdxf.readfile(path)
    (block,) = doc.modelspace().query("INSERT[name=='TITLE_BLOCK']")
    (turned,) = doc.modelspace().query("INSERT[name=='DESIGNATION']")
    assert block.get_attrib_text("DESIGNATION") == turned.get_attrib_text("DESIGNATION") == "ТММ.КП.01.00.000 Д1"
    assert [block.get_attrib_text(tag) for tag in ("SHEET", "SHEETS", "MASS")] == ["1", "4", "–"]
    names = {f"{role}{end}" for role in ("DEVELOPED", "CHECKED", "SUPERVISOR", "NORM_CONTROL", "APPROVED") for end in ("", "_DATE")}
    tags = {a.dxf.tag for a in block.attribs}
    assert names | {"GROUP", "INSTITUTION"} <= tags
    assert tags == {e.dxf.tag for e in doc.blocks.get("TITLE_BLOCK").query("ATTDEF")}
    block.get_attrib("DEVELOPED").dxf.text = "Петренко А. И."
    number = next(e for e in doc.modelspace().query("TEXT") if "5131,4" in e.dxf.text)
    number.dxf.text = number.dxf.text.replace("5131,4", "5132,0")
    doc.saveas(path)
    again = ezdxf.readfile(path)
    assert not again.audit().has_issues
    (block,) = again.modelspace().query("INSERT[name=='TITLE_BLOCK']")
    assert block.get_attrib_text("DEVELOPED") == "Петренко А. И."
    assert any("5132,0" in e.dxf.text for e in again.modelspace().query("TEXT"))


def test_what_programs_without_attributes_show_says_the_same(sheet):
    _, doc = sheet
    attributes = {(a.dxf.text, a.dxf.height): z(a.dxf.align_point)
                  for insert in doc.modelspace().query("INSERT") for a in insert.attribs if a.dxf.text}
    hidden = [e for e in doc.modelspace().query("TEXT") if e.dxf.invisible]
    assert {(e.dxf.text, e.dxf.height) for e in hidden} == set(attributes)
    for e in hidden:
        kind, first, last = e.get_placement()
        if kind.name == "FIT" and e.dxf.text.count("ТММ") == 0:  # the designation stands in two places
            assert (z(first) + z(last)) / 2 == pytest.approx(attributes[e.dxf.text, e.dxf.height], abs=1e-3)
    shown = {e.dxf.text for e in everywhere(doc) if e.dxftype() == "TEXT" and not e.dxf.invisible}
    assert not any(text.startswith("ТММ.КП") for text in shown)


@pytest.mark.parametrize("fields", [{}, {"group": "Гр. 5"}, {"institution": "Кафедра"}, {"developed": "Щербакова"}])
def test_every_line_of_the_form_has_a_place_in_its_cell(fields):
    canvas = Canvas()
    draw_frame(canvas, fields, "1", 1, 1)
    doc = opened(dxf.render(Drawing(841, 594, "", tuple(canvas.marks), forms=tuple(canvas.forms))))
    (block,) = doc.modelspace().query("INSERT[name=='TITLE_BLOCK']")
    at = {a.dxf.tag: z(a.dxf.align_point) - complex(651, 5) for a in block.attribs}  # from the corner of the title block
    for tag, (x0, y0, x1, y1) in {"DEVELOPED": (17, 25, 40, 30), "DEVELOPED_DATE": (55, 25, 65, 30), "GROUP": (135, 0, 185, 15),
                                  "INSTITUTION": (135, 0, 185, 15), "TITLE": (65, 15, 135, 40)}.items():  # GOST 2.104, form 1
        assert x0 < at[tag].real < x1
        assert y0 <= at[tag].imag < y1
    assert at["INSTITUTION"].imag != at["GROUP"].imag
    assert {a.dxf.tag.lower(): a.dxf.text for a in block.attribs if a.dxf.text and a.dxf.tag.lower() in fields} == fields


def test_a_long_name_has_narrower_letters_in_every_format():
    canvas = Canvas()
    draw_frame(canvas, {"developed": "Щербакова Ё. А.", "checked": "Ли И. И."}, "1", 1, 1)
    texts = {m.text: m for m in canvas.marks if isinstance(m, Text)}
    mark = texts["Щербакова Ё. А."]
    assert 0.7 <= mark.wide < texts["Ли И. И."].wide == 1.0
    assert not canvas.shortened
    ends = [max(z.real.max() for z in letters(m)) - mark.at.real for m in (mark, mark._replace(wide=1.0))]
    assert ends[0] == pytest.approx(mark.wide * ends[1])
    drawing = Drawing(841, 594, "", tuple(canvas.marks), forms=tuple(canvas.forms))
    doc = opened(dxf.render(drawing))
    assert not doc.audit().has_issues
    entries = [a for insert in doc.modelspace().query("INSERT") for a in insert.attribs if a.dxf.text == mark.text]
    entries += [t for t in doc.modelspace().query("TEXT") if t.dxf.text == mark.text]
    assert [e.dxf.width for e in entries] == [mark.wide] * 2
    strokes = [np.array(e.get_points("xy")) for e in opened(dxf.render(drawing, "strokes")).modelspace().query("LWPOLYLINE")]
    ours = np.concatenate(list(letters(mark)))
    there = np.concatenate(strokes) @ (1, 1j)
    assert max(np.abs(there - z).min() for z in ours) < 1e-3


def test_every_entity_is_in_the_group_of_its_view(sheet):
    drawing, doc = sheet
    members = Counter(e.dxf.handle for _, group in doc.groups for e in group)
    assert members == Counter(e.dxf.handle for e in doc.modelspace())
    names = [view.name for view in drawing.views]
    assert len(set(names)) == len(names)
    assert {name for name, _ in doc.groups} == {view.dxf.name for view in doc.views}
    for mine, theirs in zip(drawing.views, doc.views, strict=True):
        box = mine.box
        assert (theirs.dxf.height, theirs.dxf.width) == pytest.approx((box.height, box.width), abs=1e-3)
        assert z(theirs.dxf.center) == pytest.approx(box.centre, abs=1e-3)


def test_names_of_views_that_tables_do_not_take():
    mark = Line(10 + 10j, 20 + 20j, "main")
    view = View('a/b: <c>, "d"=1|2', drawing_of(1).views[0].box, ((0, 1),))
    doc = opened(dxf.render(Drawing(841, 594, "", (mark,), views=(view,))))
    assert not doc.audit().has_issues
    ((name, _),) = doc.groups
    assert not set(name) & set('<>/\\":;?*|,=`')


def test_extents_are_those_of_the_lines(sheet):
    _, doc = sheet
    real = bbox.extents(e for e in doc.modelspace() if e.dxftype() not in ("TEXT", "INSERT", "DIMENSION"))
    assert np.array(doc.header["$EXTMIN"])[:2] == pytest.approx([real.extmin.x, real.extmin.y], abs=1e-3)
    assert np.array(doc.header["$EXTMAX"])[:2] == pytest.approx([real.extmax.x, real.extmax.y], abs=1e-3)


@pytest.mark.parametrize(("start", "end", "box"), [
    (0.0, 2 * pi, (-2, -2, 2, 2)), (0.25 * pi, 0.75 * pi, (-2**0.5, 2**0.5, 2**0.5, 2)), (-0.1, 0.1, (2 * cos(0.1), -2 * sin(0.1),
     2, 2 * sin(0.1))), (pi, 1.5 * pi, (-2, -2, 0, 0))])  # fmt: skip
def test_extents_of_an_arc(start, end, box):
    doc = opened(dxf.render(Drawing(841, 594, "", (Arc(100 + 50j, 2.0, start, end, "main"),))))
    found = [*doc.header["$EXTMIN"][:2], *doc.header["$EXTMAX"][:2]]
    assert found == pytest.approx([100 + box[0], 50 + box[1], 100 + box[2], 50 + box[3]], abs=1e-3)


def test_layers_are_told_in_words_and_no_rule_of_a_table_is_an_axis(sheet):
    drawing, doc = sheet
    for e in everywhere(doc):
        assert doc.layers.has_entry(e.dxf.layer)
        assert doc.layers.get(e.dxf.layer).description or e.dxf.layer == "0"
    rules = [m for m in drawing.marks if isinstance(m, Line) and m.by and m.by.role == "table"]
    assert rules
    lines = doc.modelspace().query("LINE")
    ends = np.array([(e.dxf.start.x, e.dxf.start.y, e.dxf.end.x, e.dxf.end.y) for e in lines])
    for m in rules:
        off = np.abs(ends - (m.a.real, m.a.imag, m.b.real, m.b.imag)).max(axis=1)
        assert off.min() < 1e-3
        assert lines[int(off.argmin())].dxf.layer.startswith("TABLE")


def test_signs_that_programs_take_for_codes_and_letters_their_fonts_lack():
    marks = (Text(10 + 10j, "100 %%d ^A", 5.0), Text(10 + 30j, "a → b", 5.0), Text(10 + 50j, "→", 5.0, pi / 2))
    own, doc = (opened(dxf.render(Drawing(841, 594, "", marks), text)) for text in ("librecad", "live"))
    assert [t.dxf.text for t in own.modelspace().query("TEXT")][1:] == ["a → b", "→"]
    assert {t.dxf.style for t in own.modelspace().query("TEXT")} == {"tmm_sheets_b"} <= {s.dxf.name for s in own.styles}
    assert not doc.audit().has_issues
    texts = list(doc.modelspace().query("TEXT"))
    assert texts[0].plain_text().replace("%%%", "%").startswith("100 %")
    assert "^ A" in texts[0].dxf.text
    assert [t.dxf.text for t in texts[1:]] == ["a", "b"]
    font = template("fonts/lc_opengost-br.lff").read_text("utf-8")
    known = {chr(int(code, 16)) for code in re.findall(r"^\[(\w+)\]", font, re.M)}
    assert known.issuperset("".join(t.dxf.text for t in texts).replace(" ", ""))
    arrows = list(doc.modelspace().query("LWPOLYLINE"))
    assert len(arrows) == 2 * len(glyph("→").strokes)
    assert bbox.extents(arrows).has_data


def test_a_form_without_anything_filled_in():
    form = Form("title_block", 0, 1, (FormField("group", 1, 1, 30 + 20j, 3.5),))
    doc = opened(dxf.render(Drawing(841, 594, "", (Line(0j, 50j, "main"),), forms=(form,))))
    (insert,) = doc.modelspace()
    assert [(a.dxf.tag, a.dxf.text) for a in insert.attribs] == [("GROUP", "")]


@pytest.mark.parametrize("text", ["live", "librecad"])
def test_dimensions_that_librecad_letters_elsewhere_are_none_in_drawings_made_for_it(text):
    """It turns the level letters of an upright dimension along its line, and puts those of an angle on the arc."""
    canvas = Canvas()
    canvas.begin(Box(0, 0, 841, 594), "", "view")
    canvas.dimension(100 + 100j, 160 + 100j, 8.0, "a", apart=(130 + 120j, 1j))
    canvas.dimension(100 + 200j, 100 + 260j, 8.0, "b", apart=(80 + 230j, -1))
    canvas.dimension(200 + 200j, 200 + 260j, 8.0, "c")
    canvas.angle_mark(300 + 300j, 0.0, 1.0, 40.0, "d")
    place(canvas, Box(20, 5, 836, 589))
    doc = opened(dxf.render(Drawing(841, 594, "", tuple(canvas.marks), dimensions=tuple(canvas.dimensions)), text))
    kinds = [d.dimtype for d in doc.modelspace().query("DIMENSION")]
    assert len(kinds) == {"live": 4, "librecad": 2}[text]
