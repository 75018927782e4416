"""All lettering that looks for its place: numbers at axes first, then labels, notes in what is left; thin lines yield to it."""

from __future__ import annotations

from tmm_sheets.drawing import axis_heights, axis_numbers, labels, yielding
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.crowded import Crowded
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.marks import Box


def place(canvas: Canvas, area: Box) -> list[Crowded]:
    """Set all that a canvas asks for inside ``area``, as a part of its own; returns what found no free place."""
    ink = InkIndex(canvas.marks, area, canvas.windows)
    numbers = list(canvas.numbers)
    axis_numbers.set_numbers(canvas, ink)
    axis_heights.even(canvas, numbers)
    canvas.begin(area, "", "labels")
    crowded = labels.set_labels(canvas, ink)
    if canvas.notes:
        from tmm_sheets.drawing import notes

        crowded += notes.set_notes(canvas, ink)
    yielding.interrupt(canvas)
    return crowded
