"""DXF R2010: model space in sheet millimetres, a layer for each role and line type.

Live by default: lettering is TEXT fitted to its length, the title block has attributes, dimensions are DIMENSION, a line is whole
and its line type draws the dashes, a view is a group. With ``text="strokes"`` lettering and dashes are separate strokes: the
same picture in every program, with or without fonts. With ``text="librecad"`` the text style is that of our own font for LibreCAD.

Header, tables, objects and the layout are as ezdxf writes them (``dxf_frame.py``); the entities are written here and spliced in.
"""

from __future__ import annotations

import json
import re
import struct
import zlib
from cmath import phase
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cache, lru_cache
from io import StringIO
from itertools import count, islice
from math import cos, degrees, pi, sin
from typing import Any, Literal

from tmm_sheets.backends.dxf_frame import (
    COMMON,
    DIMENSION_STYLE,
    FONT_FILE,
    LETTERS,
    OWN,
    DxfFrame,
    SheetParts,
    entity,
    extents,
    flat,
    head,
    letter_strokes,
    place,
    short,
    weight as weight,
)
from tmm_sheets.drawing.ink import check, interrupted, strokes
from tmm_sheets.drawing.lettering import BAR, PEN, advance, glyph, lacking, letter
from tmm_sheets.drawing.marks import Dimension, Drawing, Form, FormField, Mark, Text
from tmm_sheets.drawing.styles import layer, line_type, line_types
from tmm_sheets.resources import template

TEXT_LAYER = "TEXT"
WHOLE = re.compile(r"\S(?:.*\S)?")
"""Pattern of a text without spaces at its ends."""
HIDDEN = "60\n1\n"
"""Tags of an invisible entity."""
OWN_BLOCK = 32
"""Flag of a dimension whose block is its own."""
LEVEL = 1e-6
"""Height difference of the ends of a dimension, mm, up to which its lettering is horizontal."""
FACTOR = 144
"""Number of the variable DIMLFAC: measured size per unit of the drawing."""


class LiveSheet:
    """Builder of the entities, blocks and groups of a drawing with live text; takes handles from ``handles``."""

    def __init__(self, drawing: Drawing, frame: DxfFrame, style: str, handles: Iterator[int]) -> None:
        self.marks, self.frame, self.style, self.handles = drawing.marks, frame, style, handles
        self.parts = SheetParts()
        self.found = defaultdict[int, list[int]](list)  # handles in model space by the first mark they stand for
        self.entities: dict[int, str] = {}  # by their handles
        # Two lines make no angle of more than half a turn, and LibreCAD knows no other dimensions of angles.
        dimensions = [d for d in drawing.dimensions if (d.kind != "angle" or _turned(d) < pi) and (style == COMMON or _is_kept(d))]
        wholes: dict[int, Form | Dimension] = {d.first: d for d in dimensions} | {form.first: form for form in drawing.forms}
        lettered = {k for d in dimensions for k in range(*d.label)}
        i = 0
        while i < len(self.marks):
            whole = wholes.get(i)
            if whole is None:
                if i not in lettered:
                    self._add(i, self._marks((self.marks[i],), frame.owner))
                i += 1
                continue
            if isinstance(whole, Form):
                self._form(whole)
            else:
                self._dimension(whole)
            i = max(whole.end, i + 1)
        for view in drawing.views:
            self._group(view.name, [h for a, b in view.spans for k in range(a, b) if k in self.found for h in self.found[k]])
        self.parts.entities += self.entities.values()

    def _add(self, mark: int, made: list[tuple[int, str]]) -> None:
        """Add entities with their handles to model space."""
        self.found[mark] += [handle for handle, _ in made]
        self.entities.update(made)

    def _marks(self, marks: tuple[Mark, ...], owner: str) -> list[tuple[int, str]]:
        """Entities of some marks."""
        made: list[tuple[int, str]] = []
        for mark in marks:
            on = layer(mark)
            self.parts.layers.add(on.name)
            if isinstance(mark, Text):
                made += self._text(mark, owner, on.name)
            else:
                for piece in interrupted(mark):
                    assert not isinstance(piece, Text)
                    handle = next(self.handles)
                    made.append((handle, entity(piece, handle, owner, on.name, dashed=bool(line_type(mark.style).pattern))))
        return made

    def _text(self, mark: Text, owner: str, on: str, more: str = "") -> Iterator[tuple[int, str]]:
        """A run of letters as TEXT; letters missing from the font of the style are drawn."""
        for part in (_missing_from_common_font(mark.text) if self.style == COMMON else WHOLE).finditer(mark.text):
            run = mark if part[0] == mark.text else mark._replace(
                at=mark.at + _direction(mark.angle) * advance(mark.text[: part.start()], mark.height) * mark.wide, text=part[0])
            handle = next(self.handles)
            if part.lastgroup != "drawn":
                yield handle, _text(handle, owner, on, run, self.style, more)
            else:
                taken = [handle, *islice(self.handles, len(glyph(run.text).strokes) - 1)]
                drawn = letter_strokes([run], owner, on, iter(taken)).split("0\nLWPOLYLINE\n")[1:]
                yield from zip(taken, (f"0\nLWPOLYLINE\n{stroke}" for stroke in drawn), strict=True)

    def _block(self, name: str, flags: int) -> str:
        """Begin a block; returns the handle of its record."""
        record = f"{next(self.handles):X}"
        self.parts.records.append(f"0\nBLOCK_RECORD\n5\n{record}\n330\n{self.frame.records}\n100\nAcDbSymbolTableRecord\n"
                                  f"100\nAcDbBlockTableRecord\n2\n{name}\n340\n0\n70\n0\n280\n1\n281\n0\n")
        self.parts.blocks.append(f"0\nBLOCK\n5\n{next(self.handles):X}\n{head('AcDbBlockBegin', record, '0')}"
                                 f"2\n{name}\n70\n{flags}\n{place(10, 0j)}3\n{name}\n1\n\n")
        return record

    def _end_block(self, record: str) -> None:
        self.parts.blocks.append(f"0\nENDBLK\n5\n{next(self.handles):X}\n{head('AcDbBlockEnd', record, '0')}")

    def _dimension(self, d: Dimension) -> None:
        """A DIMENSION with its drawn picture, which programs show until the dimension is changed."""
        name = f"*D{len(self.parts.records) + 1}"
        record = self._block(name, 1)
        marks = (*self.marks[d.first : d.end], *self.marks[slice(*d.label)])
        self.parts.blocks += (text for _, text in self._marks(marks, record))
        self._end_block(record)
        handle = next(self.handles)
        kind, at, measured, points = _measuring(d)
        self._add(d.first, [(handle, (
            f"0\nDIMENSION\n5\n{handle:X}\n{head('AcDbDimension', self.frame.owner, 'DIMENSION')}280\n0\n2\n{name}\n"
            f"3\n{DIMENSION_STYLE}\n{place(10, at)}{place(11, d.middle)}70\n{kind + OWN_BLOCK}\n71\n5\n42\n{short(measured)}\n"
            f"1\n{_stacked(d.text)}\n{points}{_factor(d.factor)}"))])

    def _form(self, form: Form) -> None:
        """A form as a block with attributes.

        LibreCAD ignores attributes and shows invisible entities: for it the texts are there as invisible TEXT, too.
        """
        name = form.name.upper()
        record = self._block(name, 2)
        filled = {k for f in form.fields for k in range(f.first, f.end)}
        rest = tuple([self.marks[k] for k in range(form.first, form.end) if k not in filled])
        self.parts.blocks += (text for _, text in self._marks(rest, record))
        for f in form.fields:
            self.parts.blocks.append(self._attribute("ATTDEF", f, record))
        self._end_block(record)
        insert = next(self.handles)
        owner = self.frame.owner
        text = (f"0\nINSERT\n5\n{insert:X}\n{head('AcDbBlockReference', owner, 'FRAME')}66\n1\n2\n{name}\n{place(10, 0j)}"
                + "".join([self._attribute("ATTRIB", f, f"{insert:X}") for f in form.fields])
                + f"0\nSEQEND\n5\n{next(self.handles):X}\n330\n{insert:X}\n100\nAcDbEntity\n8\nFRAME\n")
        self._add(form.first, [(insert, text)])
        for f in form.fields:
            value, wide, left = self._written(f)
            if value:
                run = Text(left, value, f.height, f.angle, wide=wide)
                self._add(form.first, list(self._text(run, owner, TEXT_LAYER, HIDDEN)))

    def _written(self, f: FormField) -> tuple[str, float, complex]:
        """What stands in a field, how wide its letters are, and the left end of its baseline."""
        texts = [mark for mark in self.marks[f.first:f.end] if isinstance(mark, Text)]
        value, wide = "".join([mark.text for mark in texts]), texts[0].wide if texts else 1.0
        return value, wide, f.at - _direction(f.angle) * _length(value, f.height) * wide / 2

    def _attribute(self, kind: str, f: FormField, owner: str) -> str:
        tag, (value, wide, left) = f.name.upper(), self._written(f)
        prompt = f"3\n{f.name.replace('_', ' ')}\n" if kind == "ATTDEF" else ""
        # About the middle of its baseline; the left end is told too, as a matter of form.
        angle = f"50\n{short(degrees(f.angle) % 360)}\n" if f.angle else ""
        letters = (f"{place(10, left)}40\n{f.height:g}\n1\n{_escaped(value)}\n{angle}{_width(wide)}7\n{self.style}\n72\n1\n"
                   f"{place(11, f.at)}")
        return (f"0\n{kind}\n5\n{next(self.handles):X}\n{head('AcDbText', owner, TEXT_LAYER)}{letters}"
                f"100\nAcDb{'AttributeDefinition' if prompt else 'Attribute'}\n280\n0\n{prompt}2\n{tag}\n70\n0\n74\n0\n280\n1\n")

    def _group(self, name: str, handles: list[int]) -> None:
        if not handles:
            return
        group = f"{next(self.handles):X}"
        name = clean(name)
        self.parts.grouped.append(f"3\n{name}\n350\n{group}\n")
        members = "".join([f"340\n{handle:X}\n" for handle in handles])
        for handle in handles:
            own = f"5\n{handle:X}\n"
            told = f"{own}102\n{{ACAD_REACTORS\n330\n{group}\n102\n}}\n"
            self.entities[handle] = self.entities[handle].replace(own, told, 1)
        # Not selectable: a click takes one line, not the view; by its name the group takes all of it.
        self.parts.groups.append(f"0\nGROUP\n5\n{group}\n330\n{self.frame.groups}\n100\nAcDbGroup\n300\n{name}\n70\n0\n71\n0\n{members}")


@cache
def letters_in_common() -> frozenset[str]:
    """Letters of the common font, and what is left out of a text for it."""
    text = template(f"fonts/{COMMON}.lff").read_text(encoding="utf-8")
    return frozenset([BAR, *[chr(int(code, 16)) for code in re.findall(r"^\[#?([0-9a-fA-F]+)\]", text, re.M)]])


def _missing_from_common_font(text: str) -> re.Pattern[str]:
    """Pattern of the runs of a text; each letter missing from the common font is a run "drawn"."""
    lacking = "".join([re.escape(c) for c in {*text} - letters_in_common() if not c.isspace()])
    return re.compile(rf"(?P<drawn>[{lacking}])|[^\s{lacking}](?:[^{lacking}]*[^\s{lacking}])?") if lacking else WHOLE


def clean(name: str) -> str:
    """A name fit for the tables of a DXF file."""
    return " ".join(re.sub(r'[<>/\\":;?*|,=`]', " ", name).split()) or "_"


def _direction(angle: float) -> complex:
    return complex(cos(angle), sin(angle))


def _is_kept(d: Dimension) -> bool:
    """True if LibreCAD, which redraws dimensions, leaves the lettering in place: it sets it along the line or on the arc.

    In a drawing for LibreCAD the other dimensions are lines and letters.
    """
    return d.label[0] == d.label[1] or (d.kind == "linear" and abs((d.b - d.a).imag) < LEVEL)


def _turned(d: Dimension) -> float:
    """Angle of a dimension, rad."""
    return phase((d.b - d.vertex) / (d.a - d.vertex)) % (2 * pi)


def _measuring(d: Dimension) -> tuple[int, complex, float, str]:
    """Kind of a dimension, its definition point, its measured size (mm, rad), and the tags of its class with its points."""
    if d.kind == "angle":
        sides = f"{place(13, d.vertex)}{place(14, d.a)}{place(15, d.vertex)}{place(16, d.line)}"
        return 2, d.b, _turned(d), f"100\nAcDb2LineAngularDimension\n{sides}"
    length = abs(d.b - d.a) * d.factor
    if d.kind == "radius":
        return 4, d.a, length, f"100\nAcDbRadialDimension\n{place(15, d.b)}40\n0\n"
    return 1, d.line + (d.b - d.a), length, f"100\nAcDbAlignedDimension\n{place(13, d.a)}{place(14, d.b)}"


def _factor(value: float) -> str:
    """Tags of a dimension whose measuring factor differs from that of its style."""
    return "" if value == 1.0 else f"1001\nACAD\n1000\nDSTYLE\n1002\n{{\n1070\n{FACTOR}\n1040\n{value:.9g}\n1002\n}}\n"


def _stacked(markup: str) -> str:
    """Lettering as MTEXT; an index is the lower or upper half of a fraction without a line."""
    said = ""
    for run in letter(markup, LETTERS).runs:
        text = re.sub(r"([\\{}])", r"\\\1", run.text.replace(BAR, "").replace("\u00a0", " "))
        if not run.at.imag:
            said += text.replace("^", "^ ")
        else:
            upper, lower = (text, "") if run.at.imag > 0 else ("", text)
            said += rf"\S{upper}^ {lower};"
    return said


def _escaped(text: str) -> str:
    """Text as it is: a caret and two per cent signs mean something to programs, LibreCAD has no letter for a no-break space."""
    return text.replace("%%", "%%%%%%").replace("^", "^ ").replace(BAR, "").replace("\u00a0", " ")


def _text(handle: int, owner: str, on: str, mark: Text, style: str, more: str = "") -> str:
    """A run as TEXT from its left end; two letters and more are fitted to their length, whatever the font."""
    look, said, run = _form(mark.text, mark.height, mark.angle, mark.wide)
    fit = f"72\n5\n{flat(11, mark.at + run)}" if len(mark.text) > 1 else ""
    return (f"0\nTEXT\n5\n{handle:X}\n{head('AcDbText', owner, on, more + look)}{flat(10, mark.at)}"
            f"{said}7\n{style}\n{fit}100\nAcDbText\n")


@lru_cache(maxsize=4096)
def _form(text: str, height: float, angle: float, wide: float) -> tuple[str, str, complex]:
    """What a run has wherever it stands: tags of its pen, tags of its letters, the way from its beginning to its end, mm."""
    if missing := lacking(text):
        raise ValueError(f"the drawing font has no character '{missing[0]}' (U+{ord(missing[0]):04X})")
    pen = weight(PEN * height)
    look = "" if pen == weight(line_type("text").width) else f"370\n{pen}\n"
    turned = f"50\n{short(degrees(angle) % 360)}\n" if angle else ""
    return (look, f"40\n{height:g}\n1\n{_escaped(text)}\n{turned}{_width(wide)}",
            _direction(angle) * _length(text, height) * wide)


def _length(text: str, height: float) -> float:
    """Length of a run, mm: to LibreCAD, which has no advances, a letter ends one pen before the next (``fonts/build.py``)."""
    if not text:
        return 0.0
    first = glyph(text[0])
    return height * (first.right - first.left - PEN) + advance(text[1:], height)


def _width(wide: float) -> str:
    return "" if wide == 1.0 else f"41\n{short(wide)}\n"


def made_of(width: float, height: float) -> dict[str, Any]:
    """Inputs of a frame besides the program: the paper's size, mm, and the line types."""
    return {"size": [width, height],
            "line types": [f"{style.linetype} {style.name} {list(style.pattern)}" for style in line_types().values()]}


@cache
def frame(width: float, height: float) -> DxfFrame:
    """Frame for paper of a size, mm."""
    kept = json.loads(template("dxf_frame.json").read_text(encoding="utf-8"))
    if kept["made of"] == made_of(width, height):
        return DxfFrame(**kept["frame"])
    from tmm_sheets.backends import dxf_frame_making

    return dxf_frame_making.made(width, height)


Lettering = Literal["live", "librecad", "strokes"]


def render(drawing: Drawing, text: Lettering = "live") -> bytes:
    """DXF file of a drawing, bytes.

    Raises
    ------
    ValueError
        when a mark has no finite place or a letter is missing from the font.
    """
    around = frame(drawing.width, drawing.height)
    handles = count(around.first_handle)
    style = OWN if text == "librecad" else COMMON
    parts = _stroked(drawing.marks, around, handles) if text == "strokes" else LiveSheet(drawing, around, style, handles).parts
    tags = "".join((*parts.entities, *parts.blocks))
    if "nan" in tags or "inf" in tags:
        for mark in drawing.marks:
            check(mark)
    parts.views += (
        f"0\nVIEW\n5\n{next(handles):X}\n330\n{around.views}\n100\nAcDbSymbolTableRecord\n100\nAcDbViewTableRecord\n"
        f"2\n{clean(view.name)}\n70\n0\n40\n{short(view.box.height)}\n41\n{short(view.box.width)}\n"
        f"10\n{short(view.box.centre.real)}\n20\n{short(view.box.centre.imag)}\n"
        "11\n0\n21\n0\n31\n1\n12\n0\n22\n0\n32\n0\n42\n50\n43\n0\n44\n0\n50\n0\n71\n0\n281\n0\n72\n0\n"
        for view in drawing.views)
    return around.filled(parts, drawing.title, drawing.author, style, extents(drawing.marks), handles).encode("utf-8")


def companions(text: Lettering = "live") -> dict[str, bytes]:
    """Files to be put beside live drawings, by name: the font, for LibreCAD also as LFF, and its licence."""
    names = {"live": (FONT_FILE, "OFL.txt"), "librecad": (FONT_FILE, f"{OWN}.lff", "OFL.txt"), "strokes": ()}
    return {name: template(f"fonts/{name}").read_bytes() for name in names[text]}


def _stroked(marks: Iterable[Mark], around: DxfFrame, handles: Iterator[int]) -> SheetParts:
    """All marks as strokes, lettering last."""
    parts, texts = SheetParts(), list[Text]()
    for mark in strokes(marks):
        on = layer(mark).name
        parts.layers.add(on)
        if isinstance(mark, Text):
            texts.append(mark)
        else:
            parts.entities.append(entity(mark, next(handles), around.owner, on, solid=bool(line_type(mark.style).pattern)))
    parts.entities.append(letter_strokes(texts, around.owner, "TEXT", handles))
    return parts


def plot_styles() -> bytes:
    """Colour-dependent plot style table (CTB): every colour prints black, in the width of the object."""
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
