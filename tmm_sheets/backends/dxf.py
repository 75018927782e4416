"""DXF R2010: model space in sheet millimetres, a layer for each role and line type.

Live by default: lettering is TEXT fitted to its length, the title block has attributes, dimensions are dimensions, a line is whole
and its line type draws the dashes, a view is a group. With ``text="strokes"`` lettering and dashes go out as separate strokes: the
same picture in every program, with or without fonts. With ``text="librecad"`` the text style is that of our own font for LibreCAD.

Header, tables, objects and the layout are as ezdxf writes them (``dxf_frame.py``); the entities are written here and spliced in.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator
from io import StringIO
from itertools import count
from pathlib import Path
from typing import Literal

from tmm_sheets.backends.dxf_entities import entity, extents, letter_strokes, short
from tmm_sheets.backends.dxf_frame import COMMON, FONT_FILE, OWN, DxfFrame, SheetParts
from tmm_sheets.backends.dxf_frame import weight as weight
from tmm_sheets.backends.dxf_frame_file import frame
from tmm_sheets.backends.dxf_live import LiveSheet, clean
from tmm_sheets.drawing.dashes import strokes
from tmm_sheets.drawing.ink import check
from tmm_sheets.drawing.layers import layer
from tmm_sheets.drawing.marks import Drawing, Mark, Text, View
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.files import put
from tmm_sheets.resources import template

Lettering = Literal["live", "librecad", "strokes"]


def write(drawing: Drawing, path: Path, text: Lettering = "live") -> None:
    """Write a drawing as DXF R2010.

    Raises
    ------
    ValueError
        When a mark has coordinates that are not finite or a letter is missing from the font.
    OSError
        When the file cannot be written; nothing is left behind.
    """
    put({path: render(drawing, text)})


def render(drawing: Drawing, text: Lettering = "live") -> bytes:
    """The bytes of the DXF file.

    Raises
    ------
    ValueError
        when a mark has no finite place or a letter is missing from the font.
    """
    around = frame(drawing.width, drawing.height)
    handles = count(around.first_handle)
    style = OWN if text == "librecad" else COMMON
    parts = _stroked(drawing.marks, around, handles) if text == "strokes" else LiveSheet(drawing, around, style, handles).parts
    if any("nan" in tags or "inf" in tags for tags in (*parts.entities, *parts.blocks)):
        for mark in drawing.marks:
            check(mark)
    parts.views += (_named_view(view, around, handles) for view in drawing.views)
    return around.filled(parts, drawing.title, drawing.author, style, extents(drawing.marks), handles).encode("utf-8")


def companions(text: Lettering = "live") -> dict[str, bytes]:
    """Files that lie beside live drawings, by name: the font, for LibreCAD in its own form too, and its licence."""
    names = {"live": (FONT_FILE, "OFL.txt"), "librecad": (FONT_FILE, f"{OWN}.lff", "OFL.txt"), "strokes": ()}
    return {name: template(f"fonts/{name}").read_bytes() for name in names[text]}


def _stroked(marks: Iterable[Mark], around: DxfFrame, handles: Iterator[int]) -> SheetParts:
    """Every mark as strokes, the lettering last."""
    parts, texts = SheetParts(), list[Text]()
    for mark in strokes(marks):
        on = layer(mark).name
        parts.layers.add(on)
        if isinstance(mark, Text):
            texts.append(mark)
        else:
            solid = bool(line_type(mark.style).pattern)
            parts.entities.append(entity(mark, next(handles), around.owner, on, solid=solid))
    parts.entities.append(letter_strokes(texts, around.owner, "TEXT", handles))
    return parts


def _named_view(view: View, around: DxfFrame, handles: Iterator[int]) -> str:
    """Entry of the table of named views."""
    box = view.box
    return (f"0\nVIEW\n5\n{next(handles):X}\n330\n{around.views}\n100\nAcDbSymbolTableRecord\n100\nAcDbViewTableRecord\n"
            f"2\n{clean(view.name)}\n70\n0\n40\n{short(box.height)}\n41\n{short(box.width)}\n10\n{short(box.centre.real)}\n20\n"
            f"{short(box.centre.imag)}\n"
            "11\n0\n21\n0\n31\n1\n12\n0\n22\n0\n32\n0\n42\n50\n43\n0\n44\n0\n50\n0\n71\n0\n281\n0\n72\n0\n")


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
