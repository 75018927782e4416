"""The contents of a CAD drawing, whatever entities it was made of: strokes, filled areas and writing, in drawing units.

Lines have a class of pattern, from the dashes of a line type or from the strokes they were drawn with.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from tmm_sheets.compare.cad.line_fit import Interval, KnownLines, lines
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell

Pattern = Literal["continuous", "dashed", "dash-dot", "dash-two-dots", "other"]
"""``other`` is none of the patterns of the sheets: dotted, with three dots, with text or zigzags."""

DOT = 0.45
"""Share of the longest stroke up to which strokes count as dots."""
WHOLE = 0.95
"""Share of a line that must have ink for it to be continuous."""


def of_dashes(dashes: Sequence[float]) -> Pattern:
    """The class of a line type, from one period of its strokes (positive, 0 for a point) and gaps (negative) in any unit."""
    strokes = [x for x in dashes if x >= 0]
    if len(strokes) == len(dashes):
        return "continuous"
    longest = max(strokes, default=0.0)
    if not longest > 0:
        return "other"
    long = [k for k, x in enumerate(strokes) if x > DOT * longest]
    # Dots between each long stroke and the next, across the end of the period too.
    between = [(b - a - 1) % len(strokes) for a, b in zip(long, [*long[1:], long[0] + len(strokes)], strict=True)]
    return _of_dots(max(between))


def of_strokes(strokes: Sequence[Interval], whole: float) -> Pattern | None:
    """The class of a line of length ``whole`` from the stretches that have ink; None if there are too few to tell.

    The first and the last stroke may be cut, and ink of other lines may fill a gap.
    """
    sizes = [b - a for a, b in strokes]
    if sum(sizes) > WHOLE * whole:
        return "continuous"
    if len(sizes) < 3:
        return None
    longest = sorted(sizes)[-2]  # two strokes may have run into one
    long = [k for k, x in enumerate(sizes) if x > DOT * longest]
    between = sorted(b - a - 1 for a, b in pairwise(long))
    return _of_dots(between[len(between) // 2])


def _of_dots(dots: int) -> Pattern:
    names: tuple[Pattern, ...] = ("dashed", "dash-dot", "dash-two-dots", "other")
    return names[min(dots, 3)]


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


POINTED = 1.3
"""How many times as far from the middle as the other corners a tip is: a dot has none."""


def pointed(z: Points) -> complex | None:
    """The way from the middle of an area to its tip; None where it has none: it is a dot, not a head."""
    from_middle = z - z.mean()
    far = complex(from_middle[np.abs(from_middle).argmax()])
    return far if abs(far) > POINTED * np.median(np.abs(from_middle)) else None


LETTER_WIDTH = 0.62
"""Average width of a letter with the space after it, in letter heights; the font is not known."""


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
