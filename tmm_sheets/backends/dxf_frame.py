"""What stands round the entities of a DXF file: ezdxf has written it, what a sheet adds is put in.

Header, layers, line types, the text style, the dimension style, the layout with its viewport are ezdxf's; entries of tables,
blocks and groups of one sheet are texts that go to their places (see :class:`SheetParts`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

from tmm_sheets.drawing.layers import LayerStyle, layers, roles
from tmm_sheets.drawing.styles import line_type

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

    def filled(self, parts: SheetParts, title: str, author: str, style: str, extents: tuple[float, float, float, float],
               handles: Iterator[int]) -> str:
        """The file; ``style`` is the name of its text style, ``extents`` are least and greatest x and y."""
        x0, y0, x1, y1 = extents
        box = (f"  9\n$EXTMIN\n 10\n{x0:.4f}\n 20\n{y0:.4f}\n 30\n0.0\n"
               f"  9\n$EXTMAX\n 10\n{x1:.4f}\n 20\n{y1:.4f}\n 30\n0.0\n")
        always = {role.upper() for role in roles()}
        used = [self._layer(on, f"{next(handles):X}") for on in layers().values() if on.name in parts.layers or on.name in always]
        told = {TITLE: " ".join(title.splitlines()), AUTHOR: " ".join(author.splitlines()), STYLE: style,
                HANDSEED: f"{next(handles):X}", EXTENTS: box, LAYERS: _joined(used), VIEWS: _joined(parts.views),
                RECORDS: _joined(parts.records),
                BLOCKS: _joined(parts.blocks), BODY: _joined(parts.entities), GROUPED: _joined(parts.grouped),
                GROUPS: _joined(parts.groups)}  # fmt: skip
        pieces = re.split(f"({'|'.join(map(re.escape, told))})", self.text)
        return "".join(told.get(piece, piece) for piece in pieces)

    def _layer(self, layer: LayerStyle, handle: str) -> str:
        look = line_type(layer.style)
        return self.layer.format(handle=handle, name=layer.name, description=layer.description, colour=look.colour,
                                 linetype=look.linetype, weight=weight(look.width))


def _joined(texts: Iterable[str]) -> str:
    return "".join(texts)


WEIGHTS = (0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211)
"""The lineweights of DXF, 0.01 mm."""


@cache
def weight(width: float) -> int:
    """The lineweight legal in DXF that is nearest to a width in mm."""
    return min(WEIGHTS, key=lambda legal: abs(legal - 100 * width))
