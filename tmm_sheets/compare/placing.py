"""Where a drawing, or a view of it, lies; what of the sheet keeps its size there, and what leads to other views."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Points, Polyline, Role, Text

BEYOND = 15.0
"""How far such a line must reach beyond everything else in its view, mm."""
LEADING: frozenset[Role] = frozenset({"construction", "axis"})
"""Roles of lines that may do so."""


def links(elements: Sequence[Element]) -> frozenset[int]:
    """Numbers of the elements that lead out of their views."""
    places: dict[ElementView, list[Element]] = {}
    for e in elements:
        if e.view.n and e.role not in LEADING:
            places.setdefault(e.view, []).append(e)
    boxes = {view: Box.around(np.concatenate([e.points for e in found])) for view, found in places.items()}
    return frozenset(e.number for e in elements if e.kind == "line" and e.role in LEADING and e.view in boxes
                     and not all(boxes[e.view].contains(complex(z), BEYOND) for z in e.points))


SAME = 0.02
"""A view whose size is off by less than this share is drawn to our scale."""
HINGE, SYMBOL = 2.6, 15.0
"""Circles up to this radius, and other elements up to this extent, are drawn as large in every scale, mm."""
BESIDE = 8.0
"""Ink this near to a symbol of a view in another scale may be the symbol, mm."""
SIGNS: frozenset[Role] = frozenset({"symbol", "point", "axis", "table"})
"""Roles of what is: bodies of sliders, marks of points, ticks, cells. A short vector, link or helper line is not."""


class Placing(NamedTuple):
    """Takes a point ``z``, first reflected in the x axis if ``mirrored``, to ``turn * z + shift``.

    It takes a drawing to the sheet, or a view of the sheet to where somebody has drawn it.
    """

    turn: complex = 1 + 0j
    shift: complex = 0j
    mirrored: bool = False

    def __call__(self, z: Any) -> Any:
        """The point on the sheet, mm, of a point of the drawing."""
        return self.turn * (np.conj(z) if self.mirrored else z) + self.shift

    def back(self, z: Any) -> Any:
        """The point of the drawing of a point on the sheet."""
        z = (z - self.shift) / self.turn
        return np.conj(z) if self.mirrored else z

    def inverse(self) -> Placing:
        """The placing that takes the sheet to the drawing."""
        turn = np.conj(1 / self.turn) if self.mirrored else 1 / self.turn
        shift = np.conj(self.shift) if self.mirrored else self.shift
        return Placing(complex(turn), complex(-turn * shift), self.mirrored)

    @property
    def scale(self) -> float:
        """Millimetres of the sheet per unit of the drawing."""
        return abs(self.turn)

    @property
    def degrees(self) -> float:
        """Angle by which the drawing has to be turned, -180 .. 180."""
        return float(np.degrees(np.angle(self.turn)))

    @property
    def scaled(self) -> bool:
        """Whether it changes sizes noticeably."""
        return abs(self.scale - 1) > SAME

    def unscaled(self, fixed: complex) -> Placing:
        """The turn that takes ``fixed`` where this placing does."""
        turn = self.turn / self.scale
        return Placing(turn, complex(self(fixed)) - turn * fixed)

    def after(self, first: Placing) -> Placing:
        """The placing that does ``first`` and then this one."""
        turn = np.conj(first.turn) if self.mirrored else first.turn
        shift = np.conj(first.shift) if self.mirrored else first.shift
        return Placing(complex(self.turn * turn), complex(self.turn * shift + self.shift), self.mirrored != first.mirrored)


def moved(e: Element, by: Placing) -> Element:
    """An element where a placing, without mirror, has it; symbols, arrow heads and lettering keep their size.

    A symbol of a view in another scale (the block of a slider, a support) becomes a hatching: it is drawn as large as ever, but
    which of its points stays in place is up to whoever draws it, so it is not measured. A dimension is not either, as it may stand
    anywhere, but it grows with what it tells the size of.
    """
    size, angle = by.scale, float(np.angle(by.turn))
    if by.scaled and (e.kind == "text" or (e.kind == "circle" and e.radius <= HINGE)):
        by, size = by.unscaled(complex(e.points.mean()) if e.kind == "text" else e.centre), 1.0
    elif by.scaled and symbol(e):
        if e.role != "dimension":
            by, size = by.unscaled(e.middle), 1.0
        e = replace(e, kind="hatch", pieces=e.pieces or (e.points,))
    marks = tuple(_moved_mark(mark, by) for mark in e.marks)
    if by.scaled and e.arrow and e.kind == "line":
        marks = shafts(e.marks, marks, e.points, by(e.points))
    return replace(
        e, points=by(e.points), centre=complex(by(e.centre)), radius=e.radius * size, start=e.start + angle, end=e.end + angle,
        height=e.height * size, angle=e.angle + angle, fills=tuple(_head(f, by) for f in e.fills),
        pieces=tuple(by(p) for p in e.pieces), marks=marks,
    )  # fmt: skip


def shafts(marks: Iterable[Mark], moved: Iterable[Mark], was: Points, now: Points) -> tuple[Mark, ...]:
    """The moved marks of a line between two points, its shafts as far short of the ends as they were: heads keep their size."""
    along = now[-1] - now[0]
    turn = along / (was[-1] - was[0]) * abs(was[-1] - was[0]) / abs(along)

    def end(z: complex, k: int) -> complex:
        return complex(now[k] + (z - was[k]) * turn)

    def shaft(m: Line) -> Line:
        # In a short arrow the shaft may end nearer to the tail than to the tip.
        first = 0 if ((m.b - m.a) * np.conj(was[-1] - was[0])).real > 0 else -1
        a, b = end(m.a, first), end(m.b, -1 - first)
        backwards = ((b - a) * np.conj((m.b - m.a) * turn)).real <= 0  # there is no room for the head
        return m._replace(a=complex(now[0]), b=complex(now[-1])) if backwards else m._replace(a=a, b=b)

    return tuple(shaft(m) if isinstance(m, Line) else other for m, other in zip(marks, moved, strict=True))


def symbol(e: Element) -> bool:
    """Whether an element is part of a symbol, the same in every scale, or of a dimension, which may stand anywhere."""
    z = e.points
    small = abs(complex(np.ptp(z.real), np.ptp(z.imag))) < SYMBOL
    return e.kind in ("hatch", "fill") or e.role == "dimension" or (small and e.role in SIGNS and e.kind != "circle")


def _head(points: Points, by: Placing) -> Points:
    """A filled area keeps its size and goes with its first point, the tip of an arrow."""
    return np.asarray(by.unscaled(complex(points[0]))(points))


def _moved_mark(mark: Mark, by: Placing) -> Mark:
    size, angle = by.scale, float(np.angle(by.turn))
    if isinstance(mark, Line):
        return mark._replace(a=by(mark.a), b=by(mark.b))
    if isinstance(mark, Arc):
        return mark._replace(centre=by(mark.centre), radius=mark.radius * size, start=mark.start + angle, end=mark.end + angle)
    if isinstance(mark, Text):
        return mark._replace(at=by(mark.at), height=mark.height * size, angle=mark.angle + angle)
    assert isinstance(mark, Polyline | Fill)
    points = np.asarray(mark.points)
    return mark._replace(points=_head(points, by) if isinstance(mark, Fill) else by(points))
