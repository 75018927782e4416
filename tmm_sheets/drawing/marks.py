"""The display list: marks in millimetres of the sheet, x right, y up, origin in the lower left corner of the paper.

All a backend knows of looks is the name of a line type (``templates/linetypes.toml``). Points are complex numbers.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box as Box

Points = npt.NDArray[np.complex128]


Role = Literal["vector", "construction", "point", "curve", "axis", "link", "symbol", "dimension", "hatch", "text", "table", "frame"]
"""What a mark is on the sheet."""


class Provenance(NamedTuple):
    """Where a mark comes from.

    ``step`` is "plan/name" of the construction step that left it, ``position`` the label of the position, ``frame`` the number of
    the :class:`PlacedFrame` it was drawn in (-1: none). ``name`` is what it is called where the step's own name does not say it: a
    vector by its ends, a link by its points.
    """

    role: Role
    step: str = ""
    position: str = ""
    frame: int = -1
    name: str = ""


class PlacedFrame(NamedTuple):
    """Place of a plan on the sheet: a point z of the plan lies at origin + turned(mirrored(z/mu)), mm.

    ``mu`` along both axes, unit of the plan per mm; ``turn`` counter-clockwise, rad; ``mirror``: the plan's y axis is turned over
    first.
    """

    view: int
    plan: str
    position: str
    origin: complex
    mu: tuple[float, float]
    turn: float = 0.0
    mirror: bool = False

    def __call__(self, z: Any) -> Any:
        """Point of the sheet of a point of the plan, mm."""
        w = np.real(z) / self.mu[0] + 1j * np.imag(z) / self.mu[1]
        return self.origin + complex(np.exp(1j * self.turn)) * (np.conj(w) if self.mirror else w)


class Line(NamedTuple):
    """A straight stroke; ``gaps`` are the shares of its length, from where to where, at which lettering interrupts it."""

    a: complex
    b: complex
    style: str
    of: str = ""
    by: Provenance | None = None
    gaps: tuple[tuple[float, float], ...] = ()


class Arc(NamedTuple):
    """A circular arc from angle ``start`` counter-clockwise to ``end`` (rad); a full circle when they differ by 2 pi.

    ``gaps`` as those of a line.
    """

    centre: complex
    radius: float
    start: float
    end: float
    style: str
    of: str = ""
    by: Provenance | None = None
    gaps: tuple[tuple[float, float], ...] = ()


class Polyline(NamedTuple):
    """A curve through many points."""

    points: Points
    style: str
    closed: bool = False
    of: str = ""
    by: Provenance | None = None
    gaps: tuple[tuple[float, float], ...] = ()


class Text(NamedTuple):
    """One run of plain text; ``at`` is the left end of the baseline, ``height`` that of a capital letter, mm.

    Letters are ``wide`` times as wide as usual.
    """

    at: complex
    text: str
    height: float
    angle: float = 0.0
    of: str = ""
    by: Provenance | None = None
    wide: float = 1.0


class Fill(NamedTuple):
    """A filled simple polygon (arrow heads, filled quadrants)."""

    points: Points
    style: str
    of: str = ""
    by: Provenance | None = None


Mark = Line | Arc | Polyline | Text | Fill


class View(NamedTuple):
    """A view of a sheet under its ``name``: the marks of the ``spans`` (first, end), drawn in ``box`` or near it."""

    name: str
    box: Box
    spans: tuple[tuple[int, int], ...]


class Dimension(NamedTuple):
    """Marks ``first`` .. ``end`` - 1 are a dimension of ``a`` .. ``b``, of a radius from the centre ``a`` to the circle at ``b``.

    Of an angle with its ``vertex``, ``a`` and ``b`` are the ends of the arc. ``line`` is a point of the dimension line, ``text``
    the markup of its lettering, ``middle`` the middle of it; ``factor`` is what it measures per mm of the sheet. ``label`` are the
    marks of lettering that looked for its place, from where to where.
    """

    kind: Literal["linear", "radius", "angle"]
    first: int
    end: int
    a: complex
    b: complex
    line: complex
    text: str
    middle: complex
    factor: float = 1.0
    vertex: complex = 0j
    label: tuple[int, int] = (0, 0)


class FormField(NamedTuple):
    """A line to be filled in: marks ``first`` .. ``end`` - 1 are what stands there, none where it is empty.

    ``name`` is the same in every language, ``at`` the middle of the baseline.
    """

    name: str
    first: int
    end: int
    at: complex
    height: float
    angle: float = 0.0


class Form(NamedTuple):
    """Marks ``first`` .. ``end`` - 1 are a printed form with its fields, such as the title block."""

    name: str
    first: int
    end: int
    fields: tuple[FormField, ...]


@dataclass(frozen=True)
class Drawing:
    """A finished sheet: marks on paper of ``width`` x ``height`` mm, and which of them are views, dimensions, forms."""

    width: float
    height: float
    title: str
    marks: tuple[Mark, ...] = field(repr=False)
    author: str = ""
    subject: str = ""
    keywords: str = ""
    views: tuple[View, ...] = field(default=(), repr=False)
    dimensions: tuple[Dimension, ...] = field(default=(), repr=False)
    forms: tuple[Form, ...] = field(default=(), repr=False)


def moved(mark: Mark, by: complex) -> Mark:
    """A mark moved over the paper."""
    if isinstance(mark, Line):
        return mark._replace(a=mark.a + by, b=mark.b + by)
    if isinstance(mark, Arc):
        return mark._replace(centre=mark.centre + by)
    if isinstance(mark, Text):
        return mark._replace(at=mark.at + by)
    return mark._replace(points=mark.points + by)


def flat(mark: Mark, step: float = 0.5) -> Points:
    """A mark's line as points: ends of lines, vertices of polylines, arcs cut into chords of at most ``step`` mm."""
    if isinstance(mark, Line):
        return np.array([mark.a, mark.b])
    if isinstance(mark, Arc):
        n = max(int(np.ceil(abs(mark.end - mark.start) * mark.radius / step)), 8)
        t = np.linspace(mark.start, mark.end, n + 1)
        return np.asarray(mark.centre + mark.radius * (np.cos(t) + 1j * np.sin(t)))
    if isinstance(mark, Text):
        return np.array([mark.at])
    points = np.asarray(mark.points)
    closed = isinstance(mark, Fill) or mark.closed
    return np.append(points, points[:1]) if closed else points


def bounds(marks: Iterable[Mark]) -> Box:
    """Smallest rectangle round the lines of the marks (texts count with their start point only)."""
    points = np.concatenate([flat(m) for m in marks])
    return Box(points.real.min(), points.imag.min(), points.real.max(), points.imag.max())
