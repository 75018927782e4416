"""Evenness of a sheet: share of empty cells, and how much of their boxes the views fill."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.ink_index import sample
from tmm_sheets.drawing.marks import Drawing, Line, Mark, Points, Text, flat
from tmm_sheets.drawing.text_boxes import text_box, text_boxes

FIELD = Box(20.0, 5.0, 836.0, 589.0)
"""Inside of the frame of an A1 sheet, mm."""
TAKEN = Box(651.0, 5.0, 836.0, 60.0), Box(20.0, 575.0, 90.0, 589.0)
"""Title block and turned designation."""
CELL = 50.0
"""Approximate side of a cell, mm."""
FRAME = "title block"


def empty_cells(drawing: Drawing) -> float:
    """Share of the cells of the field without ink, 0 .. 1."""
    nx, ny = round(FIELD.width / CELL), round(FIELD.height / CELL)
    inked = np.zeros((nx, ny), bool)
    z = np.concatenate((dense((mark for mark in drawing.marks if mark.of != FRAME), 4.0), *map(covering, TAKEN)))
    i = ((z.real - FIELD.x0) / FIELD.width * nx).astype(int)
    j = ((z.imag - FIELD.y0) / FIELD.height * ny).astype(int)
    there = (i >= 0) & (i < nx) & (j >= 0) & (j < ny)
    inked[i[there], j[there]] = True
    return float(1.0 - inked.mean())


def fills(drawing: Drawing) -> Iterator[tuple[str, float]]:
    """Name of each view and the share of its box that the bounding box of its ink takes, 0 .. 1.

    Ink beyond the box, such as projection lines to another graph, does not count. The circle of an enlarged detail is not a view.
    """
    for view in {view.box: view for view in reversed(drawing.views)}.values():
        marks = [mark for a, b in view.spans for mark in drawing.marks[a:b] if mark.of != FRAME]
        z = [_outline(mark) for mark in marks]
        if any(not isinstance(mark, Text) for mark in marks) and view.box.width * view.box.height > 0:
            ink, place = Box.around(np.concatenate(z)), view.box
            wide, high = min(ink.x1, place.x1) - max(ink.x0, place.x0), min(ink.y1, place.y1) - max(ink.y0, place.y0)
            yield view.name, max(wide, 0.0) * max(high, 0.0) / (place.width * place.height)


def _outline(mark: Mark) -> Points:
    return text_box(mark) if isinstance(mark, Text) else flat(mark, 2.0)


def dense(marks: Iterable[Mark], step: float) -> Points:
    """Points along marks, or round their lettering, complex (n,), at most ``step`` mm apart."""
    straight, texts, others = list[tuple[complex, complex]](), list[Text](), list[Points]()
    for mark in marks:  # most are lines and lettering: quicker without an array for each
        if isinstance(mark, Line):
            straight.append((mark.a, mark.b))
        elif isinstance(mark, Text):
            texts.append(mark)
        else:
            others.append(flat(mark, 2.0))
    a, b = np.array(straight, complex).reshape(-1, 2).T
    corners = text_boxes(texts)
    return sample(np.concatenate((a, corners[:, :-1].ravel(), *(z[:-1] for z in others))),
                  np.concatenate((b, corners[:, 1:].ravel(), *(z[1:] for z in others))), step)


def covering(box: Box) -> Points:
    """Grid of points in a box, complex (n,), 4 mm apart: it counts as filled."""
    x, y = np.meshgrid(np.arange(box.x0, box.x1, 4.0), np.arange(box.y0, box.y1, 4.0))
    return np.asarray((x + 1j * y).ravel())
