"""What stands round the entities of a DXF file: ezdxf writes it once for a size of paper, what a sheet adds is put in.

Header, layers, line types, the text style, the dimension style, the layout with its viewport are ezdxf's; entries of tables,
blocks and groups of one sheet are texts that go to their places (see :class:`SheetParts`).
"""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from io import StringIO
from typing import NamedTuple

from ezdxf._options import options
from ezdxf.document import Drawing as Document
from ezdxf.filemanagement import new
from ezdxf.lldxf.const import VALID_DXF_LINEWEIGHTS
from ezdxf.units import MM

from tmm_sheets.drawing.layers import Layer, layers, roles
from tmm_sheets.drawing.styles import line_type, line_types

VIEWPORT_LAYER = "VIEWPORT"
PATTERN = "{name}"
"""Name of the layer whose entry all others are made from."""
STYLE = "lc_opengost-br"
"""Name of the text style: LibreCAD takes it for that of a font, and it has this one; everybody else looks at the font file."""
FONT_FILE = "TMMSheetsB.ttf"
DIMENSION_STYLE = "TMM"
LETTERS = 3.5
"""Height of dimension figures, mm."""

TITLE, AUTHOR, HANDSEED, EXTENTS, LAYERS, VIEWS, RECORDS, BLOCKS, BODY, GROUPED, GROUPS = (f"{{{word}}}" for word in (
    "title", "author", "first free handle", "extents", "layers", "views", "block records", "blocks", "entities", "group names",
    "groups"))  # fmt: skip
"""What stands in a frame for what differs from sheet to sheet."""


@dataclass
class SheetParts:
    """What a sheet adds: entities, entries of the tables, blocks, groups; ``layers`` are the names of those in use."""

    entities: list[str] = field(default_factory=list)
    views: list[str] = field(default_factory=list)
    records: list[str] = field(default_factory=list)
    blocks: list[str] = field(default_factory=list)
    grouped: list[str] = field(default_factory=list)
    groups: list[str] = field(default_factory=list)
    layers: set[str] = field(default_factory=set)


class DxfFrame(NamedTuple):
    """Everything round the entities, the same for all sheets of a size.

    ``text`` has the signs above in it; ``layer`` is the entry of a layer to be filled in. The rest are handles: of model space, the
    tables of views and of blocks, the dictionary of groups, and the first one that is free.
    """

    text: str
    layer: str
    owner: str
    views: str
    records: str
    groups: str
    first_handle: int

    def filled(self, parts: SheetParts, title: str, author: str, extents: tuple[float, float, float, float],
               handles: Iterator[int]) -> str:
        """The file; ``extents`` are least and greatest x and y."""
        x0, y0, x1, y1 = extents
        box = (f"  9\n$EXTMIN\n 10\n{x0:.4f}\n 20\n{y0:.4f}\n 30\n0.0\n"
               f"  9\n$EXTMAX\n 10\n{x1:.4f}\n 20\n{y1:.4f}\n 30\n0.0\n")
        always = {role.upper() for role in roles()}
        used = [self._layer(on, f"{next(handles):X}") for on in layers().values() if on.name in parts.layers or on.name in always]
        told = {TITLE: " ".join(title.splitlines()), AUTHOR: " ".join(author.splitlines()), HANDSEED: f"{next(handles):X}",
                EXTENTS: box, LAYERS: _joined(used), VIEWS: _joined(parts.views), RECORDS: _joined(parts.records),
                BLOCKS: _joined(parts.blocks), BODY: _joined(parts.entities), GROUPED: _joined(parts.grouped),
                GROUPS: _joined(parts.groups)}  # fmt: skip
        pieces = re.split(f"({'|'.join(map(re.escape, told))})", self.text)
        return "".join(told.get(piece, piece) for piece in pieces)

    def _layer(self, layer: Layer, handle: str) -> str:
        look = line_type(layer.style)
        return self.layer.format(handle=handle, name=layer.name, description=layer.description, colour=look.colour,
                                 linetype=look.linetype, weight=weight(look.width))


def _joined(texts: Iterable[str]) -> str:
    return "".join(texts)


@cache
def frame(width: float, height: float) -> DxfFrame:
    """The frame for paper of that size, mm."""
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True  # no dates and random identifiers: the same bytes every time
    try:
        return _written(_document(width, height))
    finally:
        options.write_fixed_meta_data_for_testing = before


@cache
def weight(width: float) -> int:
    """The lineweight legal in DXF that is nearest to a width in mm."""
    return min(VALID_DXF_LINEWEIGHTS, key=lambda legal: abs(legal - 100 * width))


def _written(doc: Document) -> DxfFrame:
    # The library keeps the names of required classes in a set: without sorting their order changes from run to run.
    doc.classes.add_required_classes(doc.dxfversion)
    doc.classes.classes = OrderedDict(sorted(doc.classes.classes.items()))
    stream = StringIO()
    doc.write(stream)
    groups = str(doc.rootdict["ACAD_GROUP"].dxf.handle)
    text, entry = _without_layer(stream.getvalue())
    text = re.sub(r"(?<=\$HANDSEED\n  5\n)[0-9A-F]+", HANDSEED, text, count=1)
    text = re.sub(r"  9\n\$EXTMIN\n.*?(?=  9\n\$LIMMIN\n)", EXTENTS, text, count=1, flags=re.S)
    for table, sign in (("VIEW", VIEWS), ("BLOCK_RECORD", RECORDS)):
        text = _before(text, f"  0\nTABLE\n  2\n{table}\n", "  0\nENDTAB\n", sign)
    text = _before(text, "  2\nBLOCKS\n", "  0\nENDSEC\n", BLOCKS)
    text = _before(text, "  2\nENTITIES\n", "  0\nENDSEC\n", BODY)
    text = _before(text, f"  0\nDICTIONARY\n  5\n{groups}\n", "  0\n", GROUPED, skip=1)
    text = _before(text, "  2\nOBJECTS\n", "  0\nENDSEC\n", GROUPS)
    return DxfFrame(text, entry, doc.modelspace().layout_key, str(doc.views.head.dxf.handle),
                    str(doc.block_records.head.dxf.handle), groups, int(str(doc.entitydb.handles), 16))


def _before(text: str, start: str, end: str, sign: str, skip: int = 0) -> str:
    """The text with a sign before the first ``end`` after ``start`` (and ``skip`` characters)."""
    at = text.index(end, text.index(start) + skip)
    return f"{text[:at]}{sign}{text[at:]}"


def _without_layer(text: str) -> tuple[str, str]:
    """The text with a sign for the entry of our layer, and this with places for what differs from layer to layer."""
    name = text.index(f"AcDbLayerTableRecord\n  2\n{PATTERN}\n")
    start, end = text.rindex("  0\nLAYER\n", 0, name), text.index("  0\n", name)
    entry = text[start:end]
    for code, place in (("  5", "handle"), (" 62", "colour"), ("  6", "linetype"), ("370", "weight")):
        entry = re.sub(rf"^{code}\n.*$", f"{code}\n{{{place}}}", entry, count=1, flags=re.M)
    return text[:start] + LAYERS + text[end:], entry


def _document(width: float, height: float) -> Document:
    """Everything but what a sheet adds."""
    doc = new("R2010", units=MM)
    doc.header["$MEASUREMENT"] = 1
    doc.header["$LWDISPLAY"] = 1
    doc.header["$LTSCALE"] = 1.0
    doc.header["$LIMMIN"], doc.header["$LIMMAX"] = (0, 0), (width, height)
    doc.header.custom_vars.append("Title", TITLE)
    doc.header.custom_vars.append("Author", AUTHOR)
    for style in line_types().values():
        if style.linetype not in doc.linetypes:
            total = sum(map(abs, style.pattern))
            doc.linetypes.add(style.linetype, [total, *style.pattern], description=style.name)
    doc.layers.add(PATTERN, color=1, linetype="Continuous", lineweight=0).description = "{description}"
    doc.layers.add(VIEWPORT_LAYER, plot=False)
    _lettering(doc)
    size = (width, height)
    middle = (width / 2, height / 2)
    layout = doc.layout("Layout1")
    layout.page_setup(size=size, margins=(0, 0, 0, 0), units="mm")  # type: ignore[attr-defined]
    layout.add_viewport(  # type: ignore[attr-defined]
        center=middle, size=size, view_center_point=middle, view_height=height, dxfattribs={"layer": VIEWPORT_LAYER}
    )
    doc.set_modelspace_vport(height=height, center=middle)
    doc.modelspace().reset_extents((0, 0, 0), (width, height, 0))
    return doc


def _lettering(doc: Document) -> None:
    """The text style and the dimension style; the header names them too, for programs that look there only."""
    style = doc.styles.add(STYLE, font=FONT_FILE)
    style.set_extended_font_data("TMM Sheets B", italic=True)
    doc.header["$TEXTSTYLE"], doc.header["$TEXTSIZE"] = STYLE, LETTERS
    look = {"dimtxt": LETTERS, "dimasz": 3.5, "dimtsz": 0.0, "dimexo": 0.0, "dimexe": 2.0, "dimgap": 0.7, "dimscale": 1.0,
            "dimlfac": 1.0, "dimdec": 2, "dimdsep": ord(","), "dimtad": 1, "dimtih": 0, "dimtoh": 0, "dimzin": 8}  # fmt: skip
    doc.dimstyles.new(DIMENSION_STYLE, dxfattribs={**look, "dimtxsty": STYLE})
    for name, value in look.items():
        doc.header[f"${name.upper()}"] = value
    doc.header["$DIMTXSTY"], doc.header["$DIMSTYLE"] = STYLE, DIMENSION_STYLE
