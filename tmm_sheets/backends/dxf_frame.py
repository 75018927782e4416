"""Frame of a DXF file, everything but the entities: ezdxf has written it, the parts of a sheet are spliced in.

Header, layers, line types, the text style, the dimension style, the layout with its viewport are ezdxf's; entries of tables,
blocks and groups of one sheet are texts that are put in place (see :class:`SheetParts`). Marks become such texts, too: ten times
quicker than one object of a library each.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from math import degrees, pi
from typing import NamedTuple

import numpy as np

from tmm_sheets.drawing.lettering import PEN, glyph, widened
from tmm_sheets.drawing.marks import Arc, Box, Fill, Line, Mark, Points, Polyline, Text, coordinates
from tmm_sheets.drawing.styles import layers, line_type, roles

COMMON, OWN = "lc_opengost-br", "tmm_sheets_b"
"""Names of the text style. LibreCAD takes it for that of a font, where others look at the font file: the first it brings along,
upright and without some of our letters; the second is ours, and it shows empty signs where that is not in its folder of fonts."""
FONT_FILE = "TMMSheetsB.ttf"
DIMENSION_STYLE = "TMM"
LETTERS = 3.5
"""Height of dimension figures, mm."""

TITLE, AUTHOR, STYLE, HANDSEED, EXTENTS, LAYERS, VIEWS, RECORDS, BLOCKS, BODY, GROUPED, GROUPS = (f"{{{word}}}" for word in (
    "title", "author", "text style", "first free handle", "extents", "layers", "views", "block records", "blocks", "entities",
    "group names", "groups"))  # fmt: skip
"""Placeholders in a frame for the parts that differ from sheet to sheet."""


@dataclass
class SheetParts:
    """Parts of a sheet: entities, entries of the tables, blocks, groups; ``layers``: names of those in use."""

    entities: list[str] = field(default_factory=list)
    views: list[str] = field(default_factory=list)
    records: list[str] = field(default_factory=list)
    blocks: list[str] = field(default_factory=list)
    grouped: list[str] = field(default_factory=list)
    groups: list[str] = field(default_factory=list)
    layers: set[str] = field(default_factory=set)


class DxfFrame(NamedTuple):
    """Frame of all sheets of a size.

    ``text``: with the placeholders above; ``layer``: template of the entry of a layer. The rest are handles: of model space, the
    tables of views and of blocks, the dictionary of groups, and the first free one.
    """

    text: str
    layer: str
    owner: str
    views: str
    records: str
    groups: str
    first_handle: int

    def filled(self, parts: SheetParts, title: str, author: str, style: str, extents: tuple[float, float, float, float],
               handles: Iterator[int]) -> str:
        """The file; ``style`` is the name of its text style, ``extents`` are least and greatest x and y."""
        x0, y0, x1, y1 = extents
        box = (f"  9\n$EXTMIN\n 10\n{x0:.4f}\n 20\n{y0:.4f}\n 30\n0.0\n"
               f"  9\n$EXTMAX\n 10\n{x1:.4f}\n 20\n{y1:.4f}\n 30\n0.0\n")
        always = {role.upper() for role in roles()}
        used = [self.layer.format(handle=f"{next(handles):X}", name=on.name, description=on.description, colour=look.colour,
                                  linetype=look.linetype, weight=weight(look.width))
                for on in layers().values() if on.name in parts.layers or on.name in always for look in (line_type(on.style),)]
        told = {TITLE: " ".join(title.splitlines()), AUTHOR: " ".join(author.splitlines()), STYLE: style,
                HANDSEED: f"{next(handles):X}", EXTENTS: box, LAYERS: "".join(used), VIEWS: "".join(parts.views),
                RECORDS: "".join(parts.records),
                BLOCKS: "".join(parts.blocks), BODY: "".join(parts.entities), GROUPED: "".join(parts.grouped),
                GROUPS: "".join(parts.groups)}  # fmt: skip
        pieces = re.split(f"({'|'.join(map(re.escape, told))})", self.text)
        return "".join([told.get(piece, piece) for piece in pieces])


WEIGHTS = (0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211)
"""The lineweights of DXF, 0.01 mm."""


@cache
def weight(width: float) -> int:
    """Lineweight of DXF, 0.01 mm, nearest to a width in mm."""
    return min(WEIGHTS, key=lambda legal: abs(legal - 100 * width))


# --- marks as entities -------------------------------------------------------------------------------------------------


ALONG = 128
"""Flag of a polyline whose line type continues through its corners."""


def head(kind: str, owner: str, layer: str, more: str = "") -> str:
    """Tags of an entity from its owner to its class marker."""
    return f"330\n{owner}\n100\nAcDbEntity\n8\n{layer}\n{more}100\n{kind}\n"


def flat(code: int, z: complex) -> str:
    """Tags of a point without its z = 0, which is implied: lettering has thousands of them."""
    # As by short: a function for each number would be called more often than all others.
    return f"{code}\n{round(z.real, 4):.12g}\n{code + 10}\n{round(z.imag, 4):.12g}\n"


def place(code: int, z: complex) -> str:
    """Tags of a point."""
    return f"{flat(code, z)}{code + 20}\n0\n"


def short(value: float, digits: int = 4) -> str:
    """A number with at most ``digits`` decimals, without trailing zeros."""
    return f"{value:.{digits}f}".rstrip("0").rstrip(".")


def entity(mark: Line | Arc | Polyline | Fill, handle: int, owner: str, layer: str, dashed: bool = False,
           solid: bool = False) -> str:
    """A mark as an entity; ``dashed``: of a line type with a pattern; ``solid``: continuous on any layer."""
    plain = "6\nContinuous\n" if solid else ""
    match mark:
        case Line():
            return f"0\nLINE\n5\n{handle:X}\n{head('AcDbLine', owner, layer, plain)}{flat(10, mark.a)}{flat(11, mark.b)}"
        case Arc():
            whole = mark.end - mark.start > 2 * pi - 1e-9
            text = (f"0\n{'CIRCLE' if whole else 'ARC'}\n5\n{handle:X}\n{head('AcDbCircle', owner, layer, plain)}"
                    f"{place(10, mark.centre)}40\n{short(mark.radius)}\n")
            if not whole:
                text += f"100\nAcDbArc\n50\n{short(degrees(mark.start) % 360, 6)}\n51\n{short(degrees(mark.end) % 360, 6)}\n"
            return text
        case Polyline():
            n, flags = len(mark.points), int(mark.closed) + (ALONG if dashed else 0)
            return (f"0\nLWPOLYLINE\n5\n{handle:X}\n{head('AcDbPolyline', owner, layer, plain)}90\n{n}\n70\n{flags}\n"
                    f"{_vertices(n) % tuple(coordinates(mark.points))}")
    n = len(mark.points)
    # Some programs draw the outline of a filled area too, and with the width of the layer it would grow.
    thin = f"{plain}370\n0\n"
    if n in (3, 4):
        corners = mark.points[[0, 1, -1, 2]].tolist()  # those of a SOLID run as in the letter Z
        return (f"0\nSOLID\n5\n{handle:X}\n{head('AcDbTrace', owner, layer, thin)}"
                f"{''.join([place(10 + i, z) for i, z in enumerate(corners)])}")
    return (f"0\nHATCH\n5\n{handle:X}\n{head('AcDbHatch', owner, layer, thin)}10\n0\n20\n0\n30\n0\n210\n0\n220\n0\n230\n1\n"
            f"2\nSOLID\n70\n1\n71\n0\n91\n1\n92\n3\n72\n0\n73\n1\n93\n{n}\n"
            f"{_vertices(n) % tuple(coordinates(mark.points))}97\n0\n75\n0\n76\n1\n98\n0\n")


@cache
def _vertices(n: int) -> str:
    return "10\n%.4f\n20\n%.4f\n" * n


def letter_strokes(texts: Iterable[Text], owner: str, layer: str, handles: Iterator[int]) -> str:
    """Strokes of all letters as polylines; they are placed together, as arrays.

    Raises
    ------
    ValueError
        When a letter is missing from the font.
    """
    parts: list[Points] = []
    factors: list[complex] = []
    origins: list[complex] = []
    heads: list[str] = []
    for mark in texts:
        u = mark.height * complex(np.cos(mark.angle), np.sin(mark.angle))
        at = mark.at
        start = head("AcDbPolyline", owner, layer, f"370\n{weight(PEN * mark.height)}\n")
        for char in mark.text:
            letter = glyph(char)
            for stroke in letter.strokes:
                parts.append(stroke if mark.wide == 1.0 else widened(stroke, mark.wide))
                factors.append(u)
                origins.append(at)
                heads.append(start)
            at += u * letter.advance * mark.wide
    if not parts:
        return ""
    counts = [len(p) for p in parts]
    points = np.concatenate(parts) * np.repeat(factors, counts) + np.repeat(origins, counts)
    form = [f"0\nLWPOLYLINE\n5\n{handle:X}\n{start}90\n{n}\n70\n0\n{_vertices(n)}"
            for start, n, handle in zip(heads, counts, handles, strict=False)]
    # One formatting of all numbers: three times quicker than one of each stroke.
    return "".join(form) % tuple(coordinates(points))


def extents(marks: Iterable[Mark]) -> tuple[float, float, float, float]:
    """Bounding box x0, y0, x1, y1 of the lines of the marks, mm; zeros if there are none."""
    found: list[complex] = []
    for mark in marks:
        match mark:
            case Line():
                found += mark.a, mark.b
            case Arc():
                found += _reach(mark)
            case Polyline() | Fill() if len(mark.points):
                x0, y0, x1, y1 = Box.around(mark.points)
                found += complex(x0, y0), complex(x1, y1)
    if not found:
        return (0.0, 0.0, 0.0, 0.0)
    x, y = [z.real for z in found], [z.imag for z in found]
    return min(x), min(y), max(x), max(y)


def _reach(arc: Arc) -> list[complex]:
    """Ends of an arc, and its points on the axes of its circle."""
    turns = [arc.start, arc.end]
    quarter = pi / 2
    k = np.ceil(arc.start / quarter) if np.isfinite(arc.start) else 0.0
    while np.isfinite(arc.end) and k * quarter < arc.end and len(turns) < 7:
        turns.append(float(k * quarter))
        k += 1
    return [arc.centre + arc.radius * complex(np.cos(t), np.sin(t)) for t in turns]
