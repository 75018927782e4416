"""How evenly a sheet is filled: cells of the field without ink, and what views use of their places."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.labels import text_box
from tmm_sheets.drawing.marks import Drawing, Mark, Points, Text, flat

FIELD = Box(20.0, 5.0, 836.0, 589.0)
"""Inside of the frame of an A1 sheet, mm."""
TAKEN = Box(651.0, 5.0, 836.0, 60.0), Box(20.0, 575.0, 90.0, 589.0)
"""Title block and turned designation."""
CELL = 50.0
"""About the side of a cell, mm."""
FRAME = "title block"


def empty_cells(drawing: Drawing) -> float:
    """Share of the cells of the field in which nothing is drawn, 0 .. 1."""
    nx, ny = round(FIELD.width / CELL), round(FIELD.height / CELL)
    inked = np.zeros((nx, ny), bool)
    for z in (*(dense(mark, 4.0) for mark in drawing.marks if mark.of != FRAME), *(_over(box) for box in TAKEN)):
        i = ((z.real - FIELD.x0) / FIELD.width * nx).astype(int)
        j = ((z.imag - FIELD.y0) / FIELD.height * ny).astype(int)
        there = (i >= 0) & (i < nx) & (j >= 0) & (j < ny)
        inked[i[there], j[there]] = True
    return float(1.0 - inked.mean())


def fills(drawing: Drawing) -> Iterator[tuple[str, float]]:
    """Name of each view of a sheet and the share of its place that the rectangle round its ink takes, 0 .. 1."""
    for view in drawing.views:
        marks = [mark for a, b in view.spans for mark in drawing.marks[a:b] if mark.of != FRAME]
        z = [_outline(mark) for mark in marks]
        if any(not isinstance(mark, Text) for mark in marks) and view.box.width * view.box.height > 0:
            ink = Box.around(np.concatenate(z))
            yield view.name, ink.width * ink.height / (view.box.width * view.box.height)


def _outline(mark: Mark) -> Points:
    return text_box(mark) if isinstance(mark, Text) else flat(mark, 2.0)


def dense(mark: Mark, step: float) -> Points:
    """Points along a mark, or round its lettering, no more than ``step`` mm apart."""
    z = _outline(mark)
    if len(z) < 2:
        return z
    a, b = z[:-1], z[1:]
    counts = 2 + (np.abs(b - a) / step).astype(int)
    which = np.repeat(np.arange(len(a)), counts)
    place = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.asarray(a[which] + (b - a)[which] * (place / (counts[which] - 1)))


def _over(box: Box) -> Points:
    x, y = np.meshgrid(np.arange(box.x0, box.x1, 4.0), np.arange(box.y0, box.y1, 4.0))
    return np.asarray((x + 1j * y).ravel())
