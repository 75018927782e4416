"""What a CAD drawing has on its sheet, whatever entities it was made of: strokes, filled areas, writing; in drawing units."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare.cad.cad_patterns import Pattern
from tmm_sheets.drawing.marks import Points


class Entity(NamedTuple):
    """Where something comes from, in words by which it is found again in the CAD program: the outermost entity (a block, a
    dimension) and its handle; the layer is that of the innermost.

    ``pattern`` is the class of its line type, ``weight`` its line weight, mm, None when it is the program's default; ``broad``
    the width of a broad polyline and ``dash`` the length of the long strokes of its line type, drawing units. Those of layers and
    blocks are resolved.
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
        """How wide its lines are, mm, when the drawing units are; None when nothing says so."""
        return max(self.weight or 0.0, self.broad) if self.broad else self.weight

    def __str__(self) -> str:
        return f'{self.kind} {self.handle} on layer "{self.layer}"'


class Stroke(NamedTuple):
    """A line through ``points``; ``entity`` is the number of the entity it belongs to."""

    points: Points
    entity: int


class Area(NamedTuple):
    """A filled or hatched area by its outline, not closed; ``solid`` where nothing of it is left white."""

    points: Points
    entity: int
    solid: bool = True


class Writing(NamedTuple):
    """Text as text: ``at`` is about its middle, ``width`` estimated."""

    text: str
    at: complex
    height: float
    width: float
    angle: float
    entity: int


@dataclass(frozen=True)
class Space:
    """Model space or a sheet of paper space (with what its viewports show).

    ``size`` is what the outline of the paper measures, None in model space.
    """

    name: str
    strokes: tuple[Stroke, ...]
    areas: tuple[Area, ...]
    writings: tuple[Writing, ...]
    entities: tuple[Entity, ...]

    @property
    def empty(self) -> bool:
        """Whether there is nothing to compare."""
        return not self.strokes


@dataclass(frozen=True)
class CadInk:
    """A CAD drawing as read: its spaces that are not empty, model space first; ``unit`` is what the file declares, mm, or None.

    ``notes`` tell what was mended, left out or looks odd.
    """

    spaces: tuple[Space, ...]
    unit: float | None
    notes: tuple[str, ...]


_LATIN = str.maketrans("АВЕКМНОРСТХаеорсухЅѕІі", "ABEKMHOPCTXaeopcyxSsIi")
_PLAIN = str.maketrans({
    "−": "-", "–": "-", "—": "-", "’": "'", "′": "'", "`": "'", '"': "''", "″": "''", ",": ".", "×": "x", "х": "x",
    "⋅": "", "·": "", "*": "", "_": "", "^": "", "{": "", "}": "", "~": "", "\u0305": "", "\u0304": "",
})  # fmt: skip


def resized(entities: tuple[Entity, ...], by: float) -> tuple[Entity, ...]:
    """The entities of a drawing that is scaled: broad polylines and dashes grow with it, line weights do not."""
    return tuple(e._replace(broad=by * e.broad, dash=by * e.dash) if e.broad or e.dash else e for e in entities)


def normal(text: str) -> str:
    """Text without what two draughtsmen write in two ways: spaces, marks of indices, look-alike letters, dashes."""
    text = unicodedata.normalize("NFKC", text.translate(_PLAIN)).translate(_PLAIN).translate(_LATIN)
    return "".join(text.split())


def extent(space: Space) -> tuple[complex, complex]:
    """Lower left and upper right corner of the strokes, drawing units."""
    z = np.concatenate([s.points for s in space.strokes])
    return complex(z.real.min(), z.imag.min()), complex(z.real.max(), z.imag.max())
