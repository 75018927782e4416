"""The display list: marks in millimetres of the sheet, x right, y up, origin in the lower left corner of the paper.

The look of a mark is the name of a line type (``templates/linetypes.toml``). Points are complex numbers.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box as Box

Points = npt.NDArray[np.complex128]


Role = Literal["vector", "construction", "point", "curve", "axis", "link", "symbol", "dimension", "hatch", "text", "table", "frame"]
"""Roles of marks on the sheet."""


class Provenance(NamedTuple):
    """Origin of a mark.

    ``step``: "plan/name" of the construction step; ``position``: label of the position; ``frame``: number of the
    :class:`PlacedFrame` it was drawn in (-1: none). ``name``: its own name if that of the step does not fit: of a vector its ends,
    of a link its points. ``on``: the steps it hangs on, points, and a direction or force behind them that it lies along; without
    them it hangs on the point of its step.
    """

    role: Role
    step: str = ""
    position: str = ""
    frame: int = -1
    name: str = ""
    on: tuple[str, ...] = ()


class PlacedFrame(NamedTuple):
    """Placement of a plan on the sheet: a point z of the plan lies at origin + turned(mirrored(z/mu)), mm.

    ``mu``: along both axes, unit of the plan per mm; ``turn``: counter-clockwise, rad; ``mirror``: the plan's y axis is flipped
    before the turn.
    """

    view: int
    plan: str
    position: str
    origin: complex
    mu: tuple[float, float]
    turn: float = 0.0
    mirror: bool = False

    def __call__(self, z: Any) -> Any:
        """Points of the sheet, complex mm, of points of the plan, any shape."""
        w = z.real / self.mu[0] + 1j * z.imag / self.mu[1]
        return self.origin + complex(np.exp(1j * self.turn)) * (np.conj(w) if self.mirror else w)


class Line(NamedTuple):
    """A straight stroke; ``gaps``: stretches (start, end) at which lettering interrupts it, as shares of its length."""

    a: complex
    b: complex
    style: str
    of: str = ""
    by: Provenance | None = None
    gaps: tuple[tuple[float, float], ...] = ()


class Arc(NamedTuple):
    """A circular arc from angle ``start`` counter-clockwise to ``end``, rad; a full circle if they differ by 2 pi.

    ``gaps``: as of a line.
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
    """One run of plain text; ``at``: left end of the baseline; ``height``: of a capital letter, mm; ``wide``: stretch along it."""

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
    """A named view of a sheet: the marks of the ``spans`` (first, end), drawn in or near ``box``."""

    name: str
    box: Box
    spans: tuple[tuple[int, int], ...]


class Dimension(NamedTuple):
    """A dimension, marks ``first`` .. ``end`` - 1: of ``a`` .. ``b``, or of a radius from the centre ``a`` to the circle at ``b``.

    Of an angle with its ``vertex``, ``a`` and ``b`` are the ends of the arc. ``line``: a point of the dimension line; ``text``:
    markup of its lettering; ``middle``: the middle of that; ``factor``: measured size per mm of the sheet; ``label``: marks (first,
    end) of lettering that was placed by search.
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
    """A line of a form to be filled in; its content are the marks ``first`` .. ``end`` - 1, no marks if it is empty.

    ``name``: the same in every language; ``at``: middle of the baseline.
    """

    name: str
    first: int
    end: int
    at: complex
    height: float
    angle: float = 0.0


class Form(NamedTuple):
    """A printed form with its fields, such as the title block: marks ``first`` .. ``end`` - 1."""

    name: str
    first: int
    end: int
    fields: tuple[FormField, ...]


@dataclass(frozen=True)
class Drawing:
    """A finished sheet of ``width`` x ``height`` mm: its marks, and which of them are views, dimensions and forms."""

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


def moved(mark: Mark, by: complex, turn: complex = 1 + 0j) -> Mark:
    """The mark turned and grown by ``turn`` about the origin, then translated by ``by``, complex mm."""
    size, angle = abs(turn), phase(turn)
    match mark:
        case Line():
            return mark._replace(a=turn * mark.a + by, b=turn * mark.b + by)
        case Arc():
            return mark._replace(centre=turn * mark.centre + by, radius=mark.radius * size, start=mark.start + angle,
                                 end=mark.end + angle)
        case Text():
            return mark._replace(at=turn * mark.at + by, height=mark.height * size, angle=mark.angle + angle)
        case _:
            return mark._replace(points=turn * mark.points + by)


def flat(mark: Mark, step: float = 0.5) -> Points:
    """Line of a mark as a polyline, complex (n,) mm; arcs in chords of at most ``step`` mm, of a text its start only."""
    match mark:
        case Line():
            return np.array([mark.a, mark.b])
        case Arc():
            n = max(int(np.ceil(abs(mark.end - mark.start) * mark.radius / step)), 8)
            t = np.linspace(mark.start, mark.end, n + 1)
            return np.asarray(mark.centre + mark.radius * (np.cos(t) + 1j * np.sin(t)))
        case Text():
            return np.array([mark.at])
        case Polyline(closed=False):
            return mark.points
        case _:
            return np.concatenate((mark.points, mark.points[:1]))


def coordinates(points: Points) -> list[float]:
    """Both coordinates of each of the points, complex (n,), in turn."""
    found: list[float] = np.ascontiguousarray(points, dtype=complex).view(float).tolist()
    return found


def run(points: Points) -> npt.NDArray[np.float64]:
    """Length of a polyline, complex (n,), from its beginning to each of its points, mm."""
    return np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points)))))


def bounds(marks: Iterable[Mark]) -> Box:
    """Bounding box of the lines of the marks; texts count with their start only."""
    points = np.concatenate([flat(m) for m in marks])
    return Box(points.real.min(), points.imag.min(), points.real.max(), points.imag.max())
