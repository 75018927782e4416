"""DXF R2010: model space in sheet millimetres, a layer for each line type, lettering as strokes.

ezdxf makes the header, tables, objects and the layout; the entities are written here and spliced in, ten times quicker than
one object each. Lettering goes out as polylines, one pen width wide: the same picture in every program, with or without fonts.
Dashes are separate strokes (see ``drawing/dashes.py``), so entities are continuous; their layers keep the line type of that
name for whoever draws on.
"""

from __future__ import annotations

import re
import struct
import zlib
from collections import OrderedDict
from collections.abc import Iterable, Iterator
from functools import cache
from io import StringIO
from itertools import count
from math import degrees, pi
from pathlib import Path
from typing import NamedTuple

import numpy as np
from ezdxf._options import options
from ezdxf.document import Drawing as Document
from ezdxf.filemanagement import new
from ezdxf.lldxf.const import VALID_DXF_LINEWEIGHTS
from ezdxf.units import MM

from tmm_sheets.drawing.dashes import strokes
from tmm_sheets.drawing.lettering import PEN, glyph
from tmm_sheets.drawing.marks import Arc, Drawing, Line, Mark, Points, Polyline, Text
from tmm_sheets.drawing.styles import line_type, line_types
from tmm_sheets.files import put

VIEWPORT_LAYER = "VIEWPORT"


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing as DXF R2010.

    Raises
    ------
    ValueError
        When a mark has coordinates that are not finite or a letter is missing from the font.
    OSError
        When the file cannot be written; nothing is left behind.
    """
    put({path: render(drawing)})


def render(drawing: Drawing) -> bytes:
    """The bytes of the DXF file.

    Raises
    ------
    ValueError
        when a mark has no finite place.
    """
    frame = _frame(drawing.width, drawing.height)
    handles = count(frame.first_handle)
    body = "".join(_entities(drawing.marks, frame.owner, handles))
    if "nan" in body or "inf" in body:
        bad = next(m for m in drawing.marks if any(w in t for t in _entities([m], "0", count()) for w in ("nan", "inf")))
        raise ValueError(f"a mark of '{bad.of}' has no finite place: {bad}")
    head = frame.head
    for sign, word in ((TITLE, drawing.title), (AUTHOR, drawing.author), (HANDSEED, f"{next(handles):X}")):
        head = head.replace(sign, " ".join(word.splitlines()))
    return (head + body + frame.tail).encode("utf-8")


TITLE, AUTHOR, HANDSEED = "{title}", "{author}", "{first free handle}"
"""What stands in a frame for what differs from sheet to sheet."""


class DxfFrame(NamedTuple):
    """Everything round the entities, the same for all sheets of a size: text before and after, owner and first free handle."""

    head: str
    tail: str
    owner: str
    first_handle: int


@cache
def _frame(width: float, height: float) -> DxfFrame:
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True  # no dates and random identifiers: the same bytes every time
    try:
        return _written(_document(width, height))
    finally:
        options.write_fixed_meta_data_for_testing = before


def _written(doc: Document) -> DxfFrame:
    # The library keeps the names of required classes in a set: without sorting their order changes from run to run.
    doc.classes.add_required_classes(doc.dxfversion)
    doc.classes.classes = OrderedDict(sorted(doc.classes.classes.items()))
    text = StringIO()
    doc.write(text)
    start, entities, tail = text.getvalue().partition("  2\nENTITIES\n")
    first = str(doc.entitydb.handles)
    head = re.sub(r"(?<=\$HANDSEED\n  5\n)[0-9A-F]+", HANDSEED, start + entities, count=1)
    return DxfFrame(head, tail, doc.modelspace().layout_key, int(first, 16))


def _document(width: float, height: float) -> Document:
    """Everything but the entities: header, layers, line types, the layout with its viewport."""
    doc = new("R2010", units=MM)
    doc.header["$MEASUREMENT"] = 1
    doc.header["$LWDISPLAY"] = 1
    doc.header["$LTSCALE"] = 1.0
    doc.header["$EXTMIN"], doc.header["$EXTMAX"] = (0, 0, 0), (width, height, 0)
    doc.header["$LIMMIN"], doc.header["$LIMMAX"] = (0, 0), (width, height)
    doc.header.custom_vars.append("Title", TITLE)
    doc.header.custom_vars.append("Author", AUTHOR)
    for style in line_types().values():
        if style.linetype not in doc.linetypes:
            total = sum(map(abs, style.pattern))
            doc.linetypes.add(style.linetype, [total, *style.pattern], description=style.name)
        if style.layer not in doc.layers:
            doc.layers.add(style.layer, color=style.colour, linetype=style.linetype, lineweight=weight(style.width))
    doc.layers.add(VIEWPORT_LAYER, plot=False)
    size = (width, height)
    middle = (width / 2, height / 2)
    layout = doc.layout("Layout1")
    layout.page_setup(size=size, margins=(0, 0, 0, 0), units="mm")  # type: ignore[attr-defined]
    layout.add_viewport(  # type: ignore[attr-defined]
        center=middle, size=size, view_center_point=middle, view_height=height, dxfattribs={"layer": VIEWPORT_LAYER}
    )
    doc.set_modelspace_vport(height=height, center=middle)
    return doc


@cache
def weight(width: float) -> int:
    """The lineweight legal in DXF that is nearest to a width in mm."""
    return min(VALID_DXF_LINEWEIGHTS, key=lambda legal: abs(legal - 100 * width))


@cache
def _vertices(n: int) -> str:
    return "10\n%.4f\n20\n%.4f\n" * n


def _entities(marks: Iterable[Mark], owner: str, handles: Iterator[int]) -> Iterator[str]:
    """DXF text of every mark, the lettering last."""
    heads: dict[tuple[str, str], str] = {}

    def head(kind: str, style: str) -> str:
        if (kind, style) not in heads:
            look = line_type(style)
            solid = "6\nContinuous\n" if look.pattern else ""
            # Some programs draw the outline of a filled area too, and with the width of the layer it would grow.
            thin = "370\n0\n" if kind in ("AcDbTrace", "AcDbHatch") else ""
            heads[kind, style] = f"330\n{owner}\n100\nAcDbEntity\n8\n{look.layer}\n{solid}{thin}100\n{kind}\n"
        return heads[kind, style]

    texts = []
    for mark in strokes(marks):
        if isinstance(mark, Line):
            (a, b, style, *_), h = mark, next(handles)
            yield (
                f"0\nLINE\n5\n{h:X}\n{head('AcDbLine', style)}10\n{a.real:.4f}\n20\n{a.imag:.4f}\n30\n0\n"
                f"11\n{b.real:.4f}\n21\n{b.imag:.4f}\n31\n0\n"
            )
        elif isinstance(mark, Arc):
            whole = mark.end - mark.start > 2 * pi - 1e-9
            yield (
                f"0\n{'CIRCLE' if whole else 'ARC'}\n5\n{next(handles):X}\n{head('AcDbCircle', mark.style)}"
                f"10\n{mark.centre.real:.4f}\n20\n{mark.centre.imag:.4f}\n30\n0\n40\n{mark.radius:.4f}\n"
            )
            if not whole:
                yield f"100\nAcDbArc\n50\n{degrees(mark.start) % 360:.6f}\n51\n{degrees(mark.end) % 360:.6f}\n"
        elif isinstance(mark, Polyline):
            n = len(mark.points)
            yield f"0\nLWPOLYLINE\n5\n{next(handles):X}\n{head('AcDbPolyline', mark.style)}90\n{n}\n70\n{int(mark.closed)}\n"
            yield _vertices(n) % _xy(mark.points)
        elif isinstance(mark, Text):
            texts.append(mark)
        elif len(mark.points) in (3, 4):
            # The corners of a SOLID run as in the letter Z.
            xy = _xy(mark.points[[0, 1, -1, 2]])
            yield f"0\nSOLID\n5\n{next(handles):X}\n{head('AcDbTrace', mark.style)}"
            yield "".join(f"1{i}\n{xy[2 * i]:.4f}\n2{i}\n{xy[2 * i + 1]:.4f}\n3{i}\n0\n" for i in range(4))
        else:
            n = len(mark.points)
            yield (
                f"0\nHATCH\n5\n{next(handles):X}\n{head('AcDbHatch', mark.style)}10\n0\n20\n0\n30\n0\n210\n0\n220\n0\n230\n1\n"
                f"2\nSOLID\n70\n1\n71\n0\n91\n1\n92\n3\n72\n0\n73\n1\n93\n{n}\n"
            )
            yield _vertices(n) % _xy(mark.points) + "97\n0\n75\n0\n76\n1\n98\n0\n"
    yield from _lettering(texts, owner, handles)


def _xy(points: Points) -> tuple[float, ...]:
    return tuple(np.column_stack((points.real, points.imag)).ravel().tolist())


def _lettering(texts: list[Text], owner: str, handles: Iterator[int]) -> Iterator[str]:
    """Strokes of all letters: placed together as arrays, then written one polyline each."""
    parts: list[Points] = []
    factors: list[complex] = []
    origins: list[complex] = []
    heads: list[str] = []
    layer = line_type("text").layer
    for mark in texts:
        u = mark.height * complex(np.cos(mark.angle), np.sin(mark.angle))
        at = mark.at
        head = f"330\n{owner}\n100\nAcDbEntity\n8\n{layer}\n370\n{weight(PEN * mark.height)}\n100\nAcDbPolyline\n90\n"
        for char in mark.text:
            letter = glyph(char)
            for stroke in letter.strokes:
                parts.append(stroke)
                factors.append(u)
                origins.append(at)
                heads.append(head)
            at += u * letter.advance
    if not parts:
        return
    counts = [len(p) for p in parts]
    points = np.concatenate(parts) * np.repeat(factors, counts) + np.repeat(origins, counts)
    form = [f"0\nLWPOLYLINE\n5\n{handle:X}\n{head}{n}\n70\n0\n{_vertices(n)}"
            for head, n, handle in zip(heads, counts, handles, strict=False)]
    # One formatting of all numbers: three times quicker than one of each stroke.
    yield "".join(form) % _xy(points)


def plot_styles() -> bytes:
    """A colour-dependent plot style table (CTB): every colour prints black, widths are those of the objects."""
    from ezdxf.addons import acadctb

    table = acadctb.new_ctb()
    table.description = "tmm-sheets: all colours black, lineweights of the drawing"
    for colour in range(1, 256):
        style = table[colour]
        style.color = (0, 0, 0)
        style.set_lineweight(0.0)  # as the object has it
    text = StringIO()
    table.write_content(text)
    content = text.getvalue().encode("ascii") + b"\0"
    packed = zlib.compress(content)
    # The library's own writer takes the machine's long integers here: eight bytes on Linux, which nobody can read.
    sizes = struct.pack("<LLL", zlib.adler32(packed), len(content), len(packed))
    return b"PIAFILEVERSION_2.0,CTBVER1,compress\r\npmzlibcodec" + sizes + packed
