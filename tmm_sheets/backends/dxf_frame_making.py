"""Frame of a DXF file as ezdxf writes it, with placeholders for the parts of a sheet.

Run for ``templates/dxf_frame.json`` (``python -m tests.backends.frame_file`` writes it), and if that is for other paper or other
line types.
"""

from __future__ import annotations

import re
from collections import OrderedDict
from io import StringIO

from ezdxf._options import options
from ezdxf.document import Drawing as Document
from ezdxf.filemanagement import new
from ezdxf.units import MM

from tmm_sheets.backends.dxf_frame import (
    AUTHOR,
    BLOCKS,
    BODY,
    DIMENSION_STYLE,
    EXTENTS,
    FONT_FILE,
    GROUPED,
    GROUPS,
    HANDSEED,
    LAYERS,
    LETTERS,
    RECORDS,
    STYLE,
    TITLE,
    VIEWS,
    DxfFrame,
)
from tmm_sheets.drawing.styles import line_types

VIEWPORT_LAYER = "VIEWPORT"
PATTERN = "{name}"
"""Name of the layer whose entry all others are made from."""


def made(width: float, height: float) -> DxfFrame:
    """Make the frame for paper of a size, mm."""
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
    stream = StringIO()
    doc.write(stream)
    groups = str(doc.rootdict["ACAD_GROUP"].dxf.handle)
    text, entry = _without_layer(stream.getvalue())
    text = re.sub(r"(?<=\$HANDSEED\n  5\n)[0-9A-F]+", HANDSEED, text, count=1)
    text = re.sub(r"  9\n\$EXTMIN\n.*?(?=  9\n\$LIMMIN\n)", EXTENTS, text, count=1, flags=re.S)
    for table, sign in (("VIEW", VIEWS), ("BLOCK_RECORD", RECORDS)):
        text = _with_placeholder(text, f"  0\nTABLE\n  2\n{table}\n", "  0\nENDTAB\n", sign)
    text = _with_placeholder(text, "  2\nBLOCKS\n", "  0\nENDSEC\n", BLOCKS)
    text = _with_placeholder(text, "  2\nENTITIES\n", "  0\nENDSEC\n", BODY)
    text = _with_placeholder(text, f"  0\nDICTIONARY\n  5\n{groups}\n", "  0\n", GROUPED, skip=1)
    text = _with_placeholder(text, "  2\nOBJECTS\n", "  0\nENDSEC\n", GROUPS)
    return DxfFrame(text, entry, doc.modelspace().layout_key, str(doc.views.head.dxf.handle),
                    str(doc.block_records.head.dxf.handle), groups, int(str(doc.entitydb.handles), 16))


def _with_placeholder(text: str, start: str, end: str, sign: str, skip: int = 0) -> str:
    """The text with a placeholder before the first ``end`` after ``start`` (and ``skip`` characters)."""
    at = text.index(end, text.index(start) + skip)
    return f"{text[:at]}{sign}{text[at:]}"


def _without_layer(text: str) -> tuple[str, str]:
    """The text with a placeholder for the entry of our layer, and that entry as a template for all layers."""
    name = text.index(f"AcDbLayerTableRecord\n  2\n{PATTERN}\n")
    start, end = text.rindex("  0\nLAYER\n", 0, name), text.index("  0\n", name)
    entry = text[start:end]
    for code, place in (("  5", "handle"), (" 62", "colour"), ("  6", "linetype"), ("370", "weight")):
        entry = re.sub(rf"^{code}\n.*$", f"{code}\n{{{place}}}", entry, count=1, flags=re.M)
    return text[:start] + LAYERS + text[end:], entry


def _document(width: float, height: float) -> Document:
    """Document of ezdxf without the parts of a sheet."""
    doc = new("R2010", units=MM)
    doc.header["$MEASUREMENT"] = 1
    doc.header["$LWDISPLAY"] = 1
    doc.header["$LTSCALE"] = 1.0
    doc.header["$LIMMIN"], doc.header["$LIMMAX"] = (0, 0), (width, height)
    doc.header.custom_vars.append("Title", TITLE)
    doc.header.custom_vars.append("Author", AUTHOR)
    for style in line_types().values():
        if style.linetype not in doc.linetypes:
            doc.linetypes.add(style.linetype, [sum(map(abs, style.pattern)), *style.pattern], description=style.name)
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
    """Add the text style and the dimension style; the header names them too, for programs that look only there."""
    doc.styles.add(STYLE, font=FONT_FILE).set_extended_font_data("TMM Sheets B", italic=True)
    doc.header["$TEXTSTYLE"], doc.header["$TEXTSIZE"] = STYLE, LETTERS
    look = {"dimtxt": LETTERS, "dimasz": 3.5, "dimtsz": 0.0, "dimexo": 0.0, "dimexe": 2.0, "dimgap": 0.7, "dimscale": 1.0,
            "dimlfac": 1.0, "dimdec": 2, "dimdsep": ord(","), "dimtad": 1, "dimtih": 0, "dimtoh": 0, "dimzin": 8}  # fmt: skip
    doc.dimstyles.new(DIMENSION_STYLE, dxfattribs={**look, "dimtxsty": STYLE})
    for name, value in look.items():
        doc.header[f"${name.upper()}"] = value
    doc.header["$DIMTXSTY"], doc.header["$DIMSTYLE"] = STYLE, DIMENSION_STYLE
