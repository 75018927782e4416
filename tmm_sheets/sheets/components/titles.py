"""Titles close to what they stand over: a view that does not fill the height of its place has its title lower."""

from __future__ import annotations

import numpy as np

from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.evenness import dense
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Line, Text

FAR = 40.0
"""Distance of a title from its view from which on it comes lower, mm."""
NEAR = 9.0
"""Distance it then has, mm."""


def lower(canvas: Canvas) -> None:
    """Bring every title of a canvas down to its view, labels that are not set yet included."""
    parts = canvas.parts
    for k, part in enumerate(parts):
        if not part.headed:
            continue
        # What belongs to it: also parts of the same view that have no title of their own.
        last = next((n for n in range(k + 1, len(parts)) if parts[n].headed or parts[n].draw != part.draw), len(parts))
        end = parts[last].first if last < len(parts) else len(canvas.marks)
        drawn = dense(canvas.marks[part.headed:end], 2.0)
        if not len(drawn):
            continue
        top = max(float(drawn.imag.max()), *(_top(label) for label in canvas.labels if k <= label.part < last), -np.inf)
        gap = float(dense(canvas.marks[part.first:part.headed], 2.0).imag.min()) - top
        if gap > FAR:
            for n in range(part.first, part.headed):
                mark, by = canvas.marks[n], 1j * (gap - NEAR)
                if isinstance(mark, Text):
                    canvas.marks[n] = mark._replace(at=mark.at - by)
                elif isinstance(mark, Line):  # a bar over a letter
                    canvas.marks[n] = mark._replace(a=mark.a - by, b=mark.b - by)


def _top(label: Label) -> float:
    """Level up to which a label that goes upwards may reach."""
    if label.away and label.away.imag <= 0:
        return label.anchor.imag
    laid = letter(label.text, label.height)
    return label.anchor.imag + label.gap + laid.ascent + laid.descent
