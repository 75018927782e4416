"""The contents of a CAD drawing, whatever entities it was made of: strokes, filled areas and writing, in drawing units."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare.cad.cad_patterns import Pattern
from tmm_sheets.compare.cad.line_fit import KnownLines, lines
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell


class Entity(NamedTuple):
    """Where something comes from, in the terms by which it is found again in the CAD program.

    Attributes
    ----------
    kind, handle : those of the outermost entity (a block reference, a dimension)
    layer : that of the innermost
    pattern : class of its line type
    weight : line weight, mm, None for the program's default
    broad : width of a broad polyline, drawing units
    dash : length of the long strokes of its line type, drawing units

    What layers and blocks determine is resolved.
    """

    kind: str
    layer: str
    handle: str
    pattern: Pattern = "continuous"
    weight: float | None = None
    broad: float = 0.0
    dash: float = 0.0

    @property
    def width(self) -> float | None:
        """Width of its lines, mm, provided that drawing units are; None if nothing determines it."""
        return max(self.weight or 0.0, self.broad) if self.broad else self.weight

    @property
    def tree(self) -> dict[str, str]:
        """It as JSON has it."""
        return {"type": self.kind, "layer": self.layer, "handle": self.handle}

    def __str__(self) -> str:
        return tell('{kind} {handle} on layer "{layer}"').format(kind=self.kind, handle=self.handle, layer=self.layer)


class DrawnStroke(NamedTuple):
    """A line through ``points``; ``entity`` is the number of the entity it belongs to."""

    points: Points
    entity: int


class Area(NamedTuple):
    """A filled or hatched area by its outline, not closed; a hatched one is not ``solid``."""

    points: Points
    entity: int
    solid: bool = True


class Writing(NamedTuple):
    """A text: ``at`` is roughly its middle, ``width`` is estimated; ``angle`` rad."""

    text: str
    at: complex
    height: float
    width: float
    angle: float
    entity: int


@dataclass(frozen=True)
class DrawingSpace:
    """Model space, or a sheet of ``paper`` space together with what its viewports show."""

    name: str
    strokes: tuple[DrawnStroke, ...]
    areas: tuple[Area, ...]
    writings: tuple[Writing, ...]
    entities: tuple[Entity, ...]
    paper: bool = False

    @property
    def empty(self) -> bool:
        """Whether there is nothing to compare."""
        return not self.strokes

    @cached_property
    def lines(self) -> KnownLines:
        """Straight pieces of the strokes, each with the number of its stroke."""
        return lines(s.points for s in self.strokes)

    def placed(self, placing: Placing) -> DrawingSpace:
        """The space turned, scaled and shifted; broad polylines and dashes grow with the scale, line weights do not."""
        size, angle = placing.scale, float(np.angle(placing.turn))
        sign = -1.0 if placing.mirrored else 1.0
        return replace(
            self,
            strokes=tuple(s._replace(points=placing(s.points)) for s in self.strokes),
            areas=tuple(a._replace(points=placing(a.points)) for a in self.areas),
            writings=tuple(w._replace(at=complex(placing(w.at)), height=w.height * size, width=w.width * size,
                                      angle=sign * w.angle + angle) for w in self.writings),
            entities=tuple(e._replace(broad=size * e.broad, dash=size * e.dash) if e.broad or e.dash else e for e in self.entities),
        )


@dataclass(frozen=True)
class CadInk:
    """The contents of a CAD file.

    Attributes
    ----------
    spaces : those that are not empty, model space first
    unit : the unit the file declares, mm, or None
    notes : what was mended, left out or looks odd
    """

    spaces: tuple[DrawingSpace, ...]
    unit: float | None
    notes: tuple[str, ...]


_LATIN = str.maketrans("АВЕКМНОРСТХаеорсухЅѕІі", "ABEKMHOPCTXaeopcyxSsIi")
_PLAIN = str.maketrans({
    "−": "-", "–": "-", "—": "-", "’": "'", "′": "'", "`": "'", '"': "''", "″": "''", ",": ".", "×": "x", "х": "x",
    "⋅": "", "·": "", "*": "", "_": "", "^": "", "{": "", "}": "", "~": "", "\u0305": "", "\u0304": "",
})  # fmt: skip


def normal(text: str) -> str:
    """Text without what each draughtsman writes in his own way: spaces, marks of indices, look-alike letters, dashes."""
    text = unicodedata.normalize("NFKC", text.translate(_PLAIN)).translate(_PLAIN).translate(_LATIN)
    return "".join(text.split())
