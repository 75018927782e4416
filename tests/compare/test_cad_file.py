"""Reading DXF files of all kinds, and what is said of those that are none."""

from io import BytesIO, StringIO
from math import pi

import ezdxf
import numpy as np
import pytest
from ezdxf.enums import TextEntityAlignment

from tmm_sheets.compare.cad import cad_file
from tmm_sheets.compare.cad.cad_ink import normal
from tmm_sheets.errors import BadInput, CannotBuild


def saved(doc, path, binary=False):
    if binary:
        data = BytesIO()
        doc.write(data, fmt="bin")
        path.write_bytes(data.getvalue())
    else:
        text = StringIO()
        doc.write(text)
        path.write_text(text.getvalue(), encoding="utf-8")
    return path


def drawing(unit=4):
    doc = ezdxf.new("R2010")
    doc.header["$INSUNITS"] = unit
    return doc, doc.modelspace()


def length(space):
    return sum(float(np.abs(np.diff(s.points)).sum()) for s in space.strokes)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "drawing.dxf"


@pytest.mark.parametrize("binary", [False, True])
def test_every_entity_with_lines(path, binary):
    doc, msp = drawing()
    msp.add_line((0, 0), (30, 40))
    msp.add_circle((0, 0), 10)
    msp.add_arc((0, 0), 10, 350, 80)
    msp.add_ellipse((0, 0), (20, 0), 0.999999999)
    msp.add_lwpolyline([(0, 0, 0, 0, 1), (20, 0, 0, 0, 0), (20, 7)], format="xyseb")
    msp.add_polyline2d([(0, 0), (3, 4), (3, 14)])
    msp.add_polyline3d([(0, 0, 1), (3, 4, 1)])
    msp.add_spline([(0, 0), (10, 0), (20, 0), (30, 0)])
    ink = cad_file.read(saved(doc, path, binary))
    assert ink.unit == 1.0
    kinds = {}
    for s in ink.spaces[0].strokes:
        kind = ink.spaces[0].entities[s.entity].kind
        kinds[kind] = kinds.get(kind, 0) + float(np.abs(np.diff(s.points)).sum())
    want = {"LINE": 50, "CIRCLE": 20 * pi, "ARC": 10 * pi / 2, "ELLIPSE": 40 * pi, "LWPOLYLINE": 10 * pi + 7, "SPLINE": 30,
            "POLYLINE": 20}
    assert kinds == pytest.approx(want, rel=1e-3)
    assert ink.notes == ("some of the drawing has heights (z): it is seen from above",)


def test_blocks_in_blocks_turned_and_scaled(path):
    doc, msp = drawing()
    inner = doc.blocks.new("inner")
    inner.add_line((0, 0), (1, 0), dxfattribs={"layer": "0"})
    outer = doc.blocks.new("outer")
    outer.add_blockref("inner", (5, 0), dxfattribs={"xscale": 2, "yscale": 2, "layer": "deep"})
    ref = msp.add_blockref("outer", (100, 0), dxfattribs={"rotation": 90, "layer": "top"})
    space = cad_file.read(saved(doc, path)).spaces[0]
    (stroke,) = space.strokes
    assert stroke.points == pytest.approx(np.array([100 + 5j, 100 + 7j]))
    entity = space.entities[stroke.entity]
    assert (entity.kind, entity.handle) == ("INSERT", ref.dxf.handle)


def test_text_with_its_middle(path):
    doc, msp = drawing()
    msp.add_text("AB", height=10).set_placement((50, 50), align=TextEntityAlignment.MIDDLE_CENTER)
    msp.add_text("CD", height=10, rotation=90).set_placement((0, 0), align=TextEntityAlignment.BOTTOM_LEFT)
    msp.add_mtext("one\\P{\\fArial|b0;two}", dxfattribs={"char_height": 3, "insert": (0, 100), "attachment_point": 1})
    msp.add_line((0, 0), (1, 1))
    space = cad_file.read(saved(doc, path)).spaces[0]
    ab, cd, one, two = space.writings
    assert (ab.text, ab.at) == ("AB", pytest.approx(50 + 50j))
    assert cd.at.real < 0 < cd.at.imag  # it reads upwards, its letters stand to the left
    assert (one.text, two.text) == ("one", "two")
    assert 90 < two.at.imag < one.at.imag < 100


def test_dimensions_hatches_and_solids(path):
    doc, msp = drawing()
    msp.add_linear_dim(base=(0, 10), p1=(0, 0), p2=(50, 0)).render()
    msp.add_hatch(color=1).paths.add_polyline_path([(0, 0), (10, 0), (10, 10), (0, 10)], is_closed=True)
    lined = msp.add_hatch()
    lined.set_pattern_fill("ANSI31", scale=1)
    lined.paths.add_polyline_path([(100, 0), (120, 0), (120, 20), (100, 20)], is_closed=True)
    msp.add_solid([(0, 0), (1, 0), (0, 1)])
    space = cad_file.read(saved(doc, path)).spaces[0]
    assert [w.text for w in space.writings] == ["50"]
    assert len([s for s in space.strokes if space.entities[s.entity].kind == "DIMENSION"]) >= 3
    assert [a.solid for a in space.areas if space.entities[a.entity].kind == "HATCH"] == [True, False]
    slanting = [s for s in space.strokes if space.entities[s.entity].kind == "HATCH"]
    assert len(slanting) > 4
    assert all(abs((s.points[-1] - s.points[0]).real - (s.points[-1] - s.points[0]).imag) < 1e-6 for s in slanting)


def test_paper_space_with_what_its_viewport_shows(path):
    doc, msp = drawing(6)
    msp.add_line((0, 0), (1, 0))  # a metre, of which the viewport shows the first half
    layout = doc.layout("Layout1")
    layout.add_line((0, 0), (841, 0))
    layout.add_viewport(center=(200, 100), size=(100, 100), view_center_point=(0, 0), view_height=1.0)
    spaces = cad_file.read(saved(doc, path)).spaces
    assert [(s.name, s.paper) for s in spaces] == [("model space", False), ('layout "Layout1"', True)]
    shown = spaces[1].strokes[1].points
    assert shown == pytest.approx(np.array([200 + 100j, 250 + 100j]))


@pytest.mark.parametrize(("twist", "centre", "target"), [(0, (1, 0), (0, 0, 0)), (90, (0, 1), (0, 0, 0)), (0, (0, 0), (1, 0, 0))])
def test_a_viewport_whose_view_is_turned_or_has_a_target(path, twist, centre, target):
    """Its centre is told as it is seen, from the target and turned."""
    doc, msp = drawing(6)
    msp.add_line((0.9, 0), (1.1, 0))
    layout = doc.layout("Layout1")
    port = layout.add_viewport(center=(200, 100), size=(100, 100), view_center_point=centre, view_height=1.0)
    port.dxf.view_twist_angle, port.dxf.view_target_point = twist, target
    (shown,) = cad_file.read(saved(doc, path)).spaces[1].strokes
    along = 10 * np.exp(1j * np.radians(twist))
    assert shown.points == pytest.approx(np.array([200 + 100j - along, 200 + 100j + along]))


def test_hidden_layers_do_not_count(path):
    doc, msp = drawing()
    doc.layers.add("off").off()
    doc.layers.add("frozen").freeze()
    msp.add_line((0, 0), (1, 0))
    for layer in ("off", "frozen", "Defpoints"):
        msp.add_line((0, 0), (9, 9), dxfattribs={"layer": layer})
    msp.add_line((0, 0), (9, 9), dxfattribs={"invisible": 1})
    ink = cad_file.read(saved(doc, path))
    assert length(ink.spaces[0]) == 1
    assert ink.notes == ("left out, on layers that are off or frozen: 3 entities",)


@pytest.mark.parametrize(("sizes", "said"), [
    ((), None), ([(1, 1), (-2, 2), (0.5, -0.5)], None), ([(1, 1.5)], "B0 (1 : 1.5)"), ([(2, -1), (1, 1)], "B0 (1 : 0.5)"),
    ([(1, 2)] * 5, "B0 (1 : 2), B1 (1 : 2), B2 (1 : 2), …")])
def test_blocks_of_unequal_scales_are_told(path, sizes, said):
    """They may be why nothing fits; mirrored ones are not."""
    doc, msp = drawing()
    msp.add_line((0, 0), (1, 0))
    for i, (x, y) in enumerate(sizes):
        doc.blocks.new(f"B{i}").add_line((0, 0), (1, 1))
        msp.add_blockref(f"B{i}", (0, 0), dxfattribs={"xscale": x, "yscale": y})
    notes = [note for note in cad_file.read(saved(doc, path)).notes if "proportion" in note]
    assert notes == ([f"blocks drawn out of proportion, width : height: {said}"] if said else [])


def test_damaged_files_are_read_as_far_as_they_go(path):
    doc, msp = drawing()
    msp.add_line((0, 0), (30, 40))
    saved(doc, path)
    text = path.read_text()
    broken = text.replace("ENDSEC\n  0\nSECTION\n  2\nOBJECTS", "ENDSEC\n  0\nSECTION\n  2\nOBJECTZ").replace("AcDbLine\n", "\n")
    path.write_text(broken.replace("  0\nEOF\n", ""))
    assert length(cad_file.read(path).spaces[0]) == pytest.approx(50)


@pytest.mark.parametrize(("data", "said"), [
    (b"", "the file is empty"),
    (b"AC1032\0\0\0", "this is a DWG file, only DXF can be read"),
    (b"%PDF-1.4", "this is a PDF file, not DXF"),
    (b"\x89PNG\r\n", "this is a PNG file, not DXF"),
    (b"hello\nworld\n", "this is not a DXF file"),
    (b"\0\1\2\3" * 100, "this is not a DXF file"),
    (b"0\nSECTION\n1\n2\n3\n" * 9, "this is not a DXF file or it is damaged beyond repair"),
])  # fmt: skip
def test_what_is_no_dxf(path, data, said):
    path.write_bytes(data)
    with pytest.raises(BadInput) as e:
        cad_file.read(path)
    assert said in str(e.value)
    assert str(path) in str(e.value)
    assert "DXF" in e.value.problems[0].hint


def test_no_such_file_and_nothing_drawn(path):
    with pytest.raises(BadInput, match="cannot be read: No such file"):
        cad_file.read(path)
    doc, msp = drawing()
    doc.layers.add("off").off()
    msp.add_line((0, 0), (1, 1), dxfattribs={"layer": "off"})
    with pytest.raises(BadInput, match=r"nothing is drawn in it \(left out, on layers that are off or frozen: 1 entities"):
        cad_file.read(saved(doc, path))


@pytest.mark.parametrize(("a", "b"), [
    ("μ_l = 0,0025 м/мм", "μl=0.0025 м/мм"), ("F_{21}", "F₂₁"), ("В", "B"), ("a′", "a'"), ("−5", "-5"), ("Н·м", "Н*м"),
    ("m²", "m2"),
])  # fmt: skip
def test_writing_that_means_the_same(a, b):
    assert normal(a) == normal(b)


@pytest.mark.parametrize(("a", "b"), [("A", "B"), ("10", "1,0"), ("a", "A"), ("b3", "b2")])
def test_writing_that_does_not(a, b):
    assert normal(a) != normal(b)


def test_line_types_and_weights_of_layers_and_blocks(path):
    doc = ezdxf.new("R2010", setup=True)
    doc.layers.add("axes", linetype="CENTER", lineweight=20)
    inner, outer = doc.blocks.new("inner"), doc.blocks.new("outer")
    inner.add_line((0, 0), (1, 0))  # as its layer, 0: that of the reference
    inner.add_line((0, 0), (1, 1), dxfattribs={"linetype": "BYBLOCK", "lineweight": -2})
    outer.add_blockref("inner", (0, 0), dxfattribs={"layer": "axes", "linetype": "BYBLOCK", "lineweight": -2})
    msp = doc.modelspace()
    msp.add_blockref("outer", (0, 0), dxfattribs={"linetype": "PHANTOM", "lineweight": 80})
    msp.add_line((0, 0), (2, 0), dxfattribs={"linetype": "DASHED", "lineweight": 50, "layer": "axes"})
    msp.add_line((0, 0), (3, 0))
    msp.add_lwpolyline([(0, 0), (4, 0)], dxfattribs={"const_width": 0.8})
    space = cad_file.read(saved(doc, path)).spaces[0]
    assert [(e.pattern, e.weight, e.width) for e in space.entities] == [
        ("dash-dot", 0.2, 0.2), ("dash-two-dots", 0.8, 0.8), ("dashed", 0.5, 0.5), ("continuous", None, None),
        ("continuous", None, 0.8)]  # fmt: skip


def test_a_file_that_was_cut_off_is_read_to_its_last_whole_entity(path):
    doc, msp = drawing()
    for k in range(9):
        msp.add_line((0, 0), (100 + k, 0))
    data = saved(doc, path).read_bytes()
    path.write_bytes(data[: data.rindex(b"104.0") + 2])
    ink = cad_file.read(path)
    assert length(ink.spaces[0]) == 100 + 101 + 102 + 103
    assert ink.notes == ("the file ends in the middle: what there is of it was compared",)


def test_places_that_are_no_numbers_are_counted(path):
    doc, msp = drawing()
    msp.add_line((0, 0), (30, 40))
    msp.add_line((0, 0), (77, 0))
    path.write_text(saved(doc, path).read_text().replace("77.0", "nan"))
    ink = cad_file.read(path)
    assert length(ink.spaces[0]) == 50
    assert ink.notes == ("left out, with coordinates that are no numbers: 1 entities",)


@pytest.mark.parametrize("encoding", ["utf-8", "cp1251"])
def test_russian_in_a_file_that_declares_another_code_page(path, encoding):
    doc = ezdxf.new("R2000")
    doc.modelspace().add_line((0, 0), (1, 0))
    doc.modelspace().add_text("Text", height=1, dxfattribs={"layer": "Layer"})
    text = StringIO()
    doc.write(text)
    assert "ANSI_1252" in text.getvalue()
    path.write_bytes(text.getvalue().replace("Text", "План сил").replace("Layer", "Рамка").encode(encoding))
    space = cad_file.read(path).spaces[0]
    assert [w.text for w in space.writings] == ["План сил"]
    assert [e.layer for e in space.entities] == ["0", "Рамка"]


def test_the_sign_of_a_diameter_is_no_russian_letter():
    assert cad_file.words("Ø142", "cp1252") == "Ø142"
    assert cad_file.words("ÏÎÐØÅÍÜ", "cp1252") == "ПОРШЕНЬ"


def test_letters_that_the_code_page_lacks(path):
    """AutoCAD writes them as codes; in a text of several lines, too."""
    doc = ezdxf.new("R2000")
    msp = doc.modelspace()
    msp.add_line((0, 0), (1, 0))
    msp.add_text("План сил", height=1, dxfattribs={"layer": "Layer"})
    msp.add_mtext("{\\H3;Звено} é", dxfattribs={"char_height": 3})
    text = StringIO()
    doc.write(text)
    assert "ANSI_1252" in text.getvalue()
    path.write_bytes(text.getvalue().encode("cp1252", "dxfreplace"))
    assert [w.text for w in cad_file.read(path).spaces[0].writings] == ["План сил", "Звено é"]


@pytest.mark.parametrize(("text", "height"), [
    ("a", 2), ("{\\H5;a}", 5), ("{\\fArial|b0|i0|c204;\\H1.5x;a}", 3), ("a{\\H0.7x;\\S^1;}", 2), ("\\H0;a", 2), ("\\H3;\\H2x;a", 6),
    ("\\A1;\\C7;{\\L\\H.5x;a}", 1), ("", None)])
def test_the_height_told_within_a_text(path, text, height):
    """Unless it is that of an index."""
    doc, msp = drawing()
    msp.add_line((0, 0), (1, 1))
    msp.add_mtext(text, dxfattribs={"char_height": 2})
    assert [w.height for w in cad_file.read(saved(doc, path)).spaces[0].writings] == ([pytest.approx(height)] if height else [])


def test_a_block_that_the_file_lacks(path):
    doc, msp = drawing()
    msp.add_line((0, 0), (1, 1))
    msp.add_blockref("no such", (0, 0))
    ink = cad_file.read(saved(doc, path))
    assert len(ink.spaces[0].strokes) == 1
    assert "INSERT" in ink.notes[0]


def nested(depth, each):
    """Blocks of blocks: ``each`` to the power of ``depth`` lines."""
    doc, space = drawing()
    name = "line"
    doc.blocks.new(name).add_line((0, 0), (1, 1))
    for k in range(depth):
        outer = doc.blocks.new(f"block{k}")
        for i in range(each):
            outer.add_blockref(name, (i, k))
        name = f"block{k}"
    space.add_blockref(name, (0, 0))
    return doc


def arrayed(n):
    doc, space = drawing()
    doc.blocks.new("line").add_line((0, 0), (1, 1))
    space.add_blockref("line", (0, 0), {"row_count": n, "column_count": n, "row_spacing": 1, "column_spacing": 1})
    return doc


@pytest.mark.parametrize("doc", [nested(6, 10), nested(15, 3), arrayed(3000)], ids=["six times ten", "three and three", "array"])
def test_blocks_that_come_to_millions_are_refused_as_soon_as_they_are_too_many(doc, path, monkeypatch):
    monkeypatch.setattr(cad_file, "MOST_PARTS", 2000)
    with pytest.raises(CannotBuild, match=r"more than 2000 entities\n.*arrays"):
        cad_file.read(saved(doc, path))


def test_what_blocks_come_to_is_counted_right(path):
    assert len(cad_file.read(saved(nested(3, 4), path)).spaces[0].strokes) == 4**3
    assert len(cad_file.read(saved(arrayed(30), path)).spaces[0].strokes) == 900


def test_blocks_that_hold_one_another(path):
    doc, space = drawing()
    a, b = doc.blocks.new("A"), doc.blocks.new("B")
    for block, other in ((a, "B"), (b, "A"), (b, "B")):
        block.add_line((0, 0), (100, 100))
        block.add_blockref(other, (1, 1))
        block.add_blockref(other, (2, 1))
    space.add_blockref("A", (0, 0))
    space.add_line((0, 0), (841, 594))
    ink = cad_file.read(saved(doc, path))
    assert len(ink.spaces[0].strokes) == 1 + 1 + 2 * 2  # its own, that of A, two of B in each of two
    assert "INSERT" in ink.notes[0]


def test_curves_vast_beside_the_drawing(path):
    """A circle of 10^13 mm needs 10^8 chords to be within 0.005 mm."""
    doc, space = drawing()
    space.add_line((0, 0), (841, 594))
    space.add_line((0, 0), (841, 0))
    space.add_circle((0, 0), 1e13)
    space.add_arc((0, 0), 1e13, 0, 180)
    space.add_ellipse((0, 0), (1e13, 0), 0.5)
    space.add_spline([(0, 0), (1e12, 1e12), (2e12, 0), (3e12, 1e12)])
    strokes = cad_file.read(saved(doc, path)).spaces[0].strokes
    assert len(strokes) == 6
    assert all(len(s.points) < 50_000 for s in strokes)
    assert np.abs(strokes[2].points) == pytest.approx(1e13, rel=1e-6)


def test_hatchings_that_come_to_millions_of_lines(path, monkeypatch):
    monkeypatch.setattr(cad_file, "MOST_PARTS", 5000)
    doc, space = drawing()
    space.add_line((0, 0), (841, 594))
    for _ in range(4):
        hatch = space.add_hatch()
        hatch.paths.add_polyline_path([(0, 0), (800, 0), (800, 500), (0, 500)], is_closed=True)
        hatch.set_pattern_fill("ANSI31", scale=0.2)
    with pytest.raises(CannotBuild, match=r"more than 5000 entities\n.*dense hatchings"):
        cad_file.read(saved(doc, path))


def test_a_vast_file(path):
    with path.open("wb") as file:
        file.write(b"  0\nSECTION\n")
        file.truncate(70_000_000)  # sparse
    with pytest.raises(CannotBuild, match=r"70 MB are more .*64"):
        cad_file.read(path)
