"""What of a view is shown where all of it is too large for a page: what belongs to its drawing, or what a window cuts out of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.clipping import arcs_inside, polyline_inside, segment_inside
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Polyline, Text, flat

if TYPE_CHECKING:
    from tmm_sheets.drawing.marks import Points

BESIDE = 12.0
"""How far from a drawing its lettering stands at most, mm on the sheet; what is farther off is a title or a remark."""


def points_of(marks: Iterable[Mark]) -> Iterator[Points]:
    """Points that some marks reach, those of the strokes of their lettering too."""
    for m in marks:
        for p in letters(m) if isinstance(m, Text) else (flat(m, 3.0),):
            if len(p):
                yield p


def bare(marks: Sequence[Mark]) -> list[Mark]:
    """Marks without tables, titles and remarks beside the drawing: the caption and the text of a note say what stands there."""
    tables = [m for m in marks if m.by is not None and m.by.role == "table"]
    rest = [m for m in marks if m.by is None or m.by.role != "table"]
    if tables:
        place = Box.around(np.concatenate(list(points_of(tables))), 1.0)
        rest = [m for m in rest if not (isinstance(m, Text) and place.contains(m.at))]
    lines = [m for m in rest if not isinstance(m, Text)]
    if not lines:
        return rest
    near = Box.around(np.concatenate(list(points_of(lines))), BESIDE)
    return [m for m in rest if not isinstance(m, Text) or _within(near, m)]


def windowed(marks: Iterable[Mark], box: Box, edge: str = "") -> list[Mark]:
    """What of some marks a window shows: lines end at its edge, letters and filled areas are in it or not.

    ``edge``: style in which the window itself is drawn, so that nobody takes the ends of lines for those of the drawing.
    """
    made = [part for m in marks for part in _inside(box, m)]
    return [*made, Polyline(box.corners, edge, True)] if edge else made


def _within(box: Box, m: Mark) -> bool:
    return all(box.contains(complex(z)) for p in points_of([m]) for z in p)


def _inside(box: Box, m: Mark) -> Iterator[Mark]:
    """Parts of a mark in a box."""
    if _within(box, m):
        yield m
    elif isinstance(m, Line):
        if (part := segment_inside(box, m.a, m.b)) is not None:
            yield m._replace(a=part[0], b=part[1])
    elif isinstance(m, Arc):
        for start, end in arcs_inside(box, m.centre, m.radius):
            for turn in (-4 * pi, -2 * pi, 0.0, 2 * pi):
                low, high = max(start + turn, m.start), min(end + turn, m.end)
                if high > low:
                    yield m._replace(start=low, end=high)
    elif not isinstance(m, Text | Fill):
        points = np.append(m.points, m.points[:1]) if m.closed else m.points
        for stretch in polyline_inside(box, points):
            yield m._replace(points=stretch, closed=False)
