"""Notes find free places by themselves: words beside a view, set when everything else is drawn, that cover nothing at all."""

from __future__ import annotations

from itertools import product

import numpy as np

from tmm_sheets.drawing.canvas import Canvas, PlacedNote
from tmm_sheets.drawing.crowded import Crowded
from tmm_sheets.drawing.headings import wrapped
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box

HEIGHTS = (3.5, 2.5)
"""Heights of lettering, mm, the second where the first finds no place in the view, or on the whole sheet (GOST 2.304)."""
LEADING = 1.6
"""Distance of the lines of a note, in heights of its capitals."""
LINES = (1, 2, 3, 4, 5)
"""Numbers of lines a note may have, the most welcome first."""
CLEAR, APART = 1.5, 6.0
"""Margins kept above and below a note, and at its sides, where other lettering would be read on as one line, mm."""
STEP = 1.0
"""Distance of the places tried, mm."""
OUTSIDE = 4.0
"""What a millimetre of distance from the view's ink costs, in millimetres from its lower edge."""
FAR = 250.0
"""Cost from which on a place is too far from the view to keep clear of its pictures."""
TITLE, BESIDE_TITLE = 17.0, 40.0
"""Height of a title with its scale factor, mm, and what it costs to stand beside it: that would be read as part of it."""


def set_notes(canvas: Canvas, ink: InkIndex) -> list[Crowded]:
    """Set every note of a canvas on its ``ink``, to which they come; returns those that found no free place, which are left out."""
    crowded, area = [], ink.area
    for note in canvas.notes:
        pictures, own = _takes(canvas, ink, note)
        # Best between no picture of the view and its caption, if that is not far from the view.
        for apart, region, height in product((pictures, []), (note.box, area), HEIGHTS):
            found = [choice for n in LINES if (choice := _choice(ink, region, own, note, height, n, apart)) is not None
                     and (choice[0] < FAR or apart is not pictures)]
            if found:
                _, corner, lines = min(found, key=lambda choice: choice[0])
                first = len(canvas.marks)
                _set(canvas, note, corner, lines, height)
                ink.add(canvas.marks[first:])
                break
        else:
            crowded.append(Crowded(note.said, note.box.centre))
    canvas.notes.clear()
    return crowded


def _takes(canvas: Canvas, ink: InkIndex, note: PlacedNote) -> tuple[list[Box], Box]:
    """Rectangles round the pictures that the view of a note has several of, each with its caption; round all that it has drawn.

    No pictures, and its place, where there is nothing, or nobody said what belongs to it.
    """
    own_place = note.box.inset(-0.1)
    parts = [k for k, part in enumerate(canvas.parts) if note.part >= 0 and all(map(own_place.contains, part.box.corners))]
    pictures = (ink.bounds(canvas.span(k)) for k in parts if canvas.parts[k].title and canvas.parts[k].box != note.box)
    own = ink.bounds(*(canvas.span(k) for k in parts if canvas.parts[k].draw == canvas.parts[note.part].draw))
    return [box for box in pictures if box is not None], note.box if own is None else own


def _choice(ink: InkIndex, region: Box, own: Box, note: PlacedNote, height: float, count: int,
            apart: list[Box]) -> tuple[float, complex, list[str]] | None:
    """The best free place in ``region``, ``apart`` from some boxes, for a note of so many lines: cost, corner, lines.

    Best is near the lower edge of the ``own`` ink of its view: a view may leave most of its place to others.
    """
    lines = wrapped(note.said, height, count)
    laid = [letter(line, height) for line in lines]
    w = max(line.width for line in laid) + 0.15 * height
    h = (len(laid) - 1) * LEADING * height + laid[0].ascent + laid[-1].descent
    box = note.box
    left = np.arange(region.x0 + CLEAR, region.x1 - w - CLEAR, STEP)
    below = np.arange(region.y0 + CLEAR, region.y1 - h - CLEAR, STEP)
    if not left.size or not below.size:
        return None
    size = w + 2 * APART, h + 2 * CLEAR
    heavy, light = (cells.count_lattice(left - APART, below - CLEAR, *size) for cells in (ink.heavy, ink.light))
    covered = heavy + light > 0
    for b in apart:
        covered |= ((left < b.x1) & (left + w > b.x0))[:, None] & ((below < b.y1) & (below + h > b.y0))
    i, j = np.nonzero(~covered)
    if not len(j):
        return None
    x, y = left[i], below[j]
    outside = np.maximum.reduce([own.x0 - (x + w), own.y0 - (y + h), x - own.x1, y - own.y1, np.zeros(x.size)])
    cost = OUTSIDE * outside + np.abs(y - own.y0) + 0.2 * np.abs(x + w / 2 - own.centre.real)
    cost += BESIDE_TITLE * (y + h > box.y1 - TITLE)
    cost += height * LINES.index(count)
    best = int(np.argmin(cost))
    return float(cost[best]), complex(x[best], y[best]), lines


def _set(canvas: Canvas, note: PlacedNote, corner: complex, lines: list[str], height: float) -> None:
    canvas.of = note.of
    baseline = corner + 1j * letter(lines[-1], height).descent
    for k, line in enumerate(lines, 1):
        canvas.put(letter(line, height), baseline + 1j * (len(lines) - k) * LEADING * height, 0.0, line)
        canvas.groups[-1] = canvas.groups[-1]._replace(part=note.part)
