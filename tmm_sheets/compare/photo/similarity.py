"""Elements of a sheet moved, turned and scaled as whoever draws a view elsewhere does it: symbols and lettering keep their size."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Points, Polyline, Text

SAME = 0.02
"""A view whose size is off by less than this share is drawn to our scale."""
HINGE, SYMBOL = 2.6, 15.0
"""Circles up to this radius, and other elements up to this extent, are symbols, mm."""
FIGURE = {"vector", "construction", "centre"}
"""Styles of lines that belong to no symbol, however short."""


class Similarity(NamedTuple):
    """The map ``turn * z + shift`` of the plane; ``turn`` includes the scale."""

    turn: complex = 1 + 0j
    shift: complex = 0j

    def __call__(self, z: Any) -> Any:
        """The image of a point or of many."""
        return self.turn * z + self.shift

    @property
    def scaled(self) -> bool:
        """Whether it changes sizes noticeably."""
        return abs(abs(self.turn) - 1) > SAME


def moved(e: Element, by: Similarity) -> Element:
    """An element under a similarity; symbols, arrow heads and lettering keep their size.

    A symbol of a view in another scale (the block of a slider, a support) becomes a hatching: it is drawn as large as ever, but
    which of its points stays in place is up to whoever draws it, so it is not measured.
    """
    size, angle = abs(by.turn), float(np.angle(by.turn))
    if by.scaled and (e.kind == "text" or (e.kind == "circle" and e.radius <= HINGE)):
        by, size = _unscaled(by, complex(e.points.mean()) if e.kind == "text" else e.centre), 1.0
    elif by.scaled and symbol(e):
        by, size = _unscaled(by, e.middle), 1.0
        e = replace(e, kind="hatch", pieces=e.pieces or (e.points,))
    return replace(
        e, points=by(e.points), centre=complex(by(e.centre)), radius=e.radius * size, start=e.start + angle, end=e.end + angle,
        height=e.height * size, angle=e.angle + angle, fills=tuple(_head(f, by) for f in e.fills),
        pieces=tuple(by(p) for p in e.pieces), marks=tuple(_moved_mark(mark, by) for mark in e.marks),
    )  # fmt: skip


def symbol(e: Element) -> bool:
    """Whether an element is part of a symbol, the same in every scale, or a dimension line, which may stand anywhere."""
    extent = abs(complex(np.ptp(e.points.real), np.ptp(e.points.imag)))
    dimension = len(e.fills) > 1 and e.style == "thin"
    short = e.kind in ("arc", "curve", "line") and extent < SYMBOL and e.style not in FIGURE
    return dimension or short or e.kind in ("hatch", "fill")


def _unscaled(by: Similarity, fixed: complex) -> Similarity:
    """The rotation that takes ``fixed`` where the similarity does."""
    turn = by.turn / abs(by.turn)
    return Similarity(turn, complex(by(fixed)) - turn * fixed)


def _head(points: Points, by: Similarity) -> Points:
    """A filled area keeps its size and goes with its first point, the tip of an arrow."""
    return np.asarray(_unscaled(by, complex(points[0]))(points))


def _moved_mark(mark: Mark, by: Similarity) -> Mark:
    size, angle = abs(by.turn), float(np.angle(by.turn))
    if isinstance(mark, Line):
        return mark._replace(a=by(mark.a), b=by(mark.b))
    if isinstance(mark, Arc):
        return mark._replace(centre=by(mark.centre), radius=mark.radius * size, start=mark.start + angle, end=mark.end + angle)
    if isinstance(mark, Text):
        return mark._replace(at=by(mark.at), height=mark.height * size, angle=mark.angle + angle)
    assert isinstance(mark, Polyline | Fill)
    points = np.asarray(mark.points)
    return mark._replace(points=_head(points, by) if isinstance(mark, Fill) else by(points))
