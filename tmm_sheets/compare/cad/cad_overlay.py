"""The exact sheet and a CAD drawing over each other: a DXF to open in the CAD program, a PDF to look at."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_sheets.backends import pdf
from tmm_sheets.compare.cad import cad_file
from tmm_sheets.compare.cad.cad_ink import Space
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Drawing, Points, Polyline

GREEN, GREY, RED, ORANGE = (0.0, 0.6, 0.2), (0.45, 0.45, 0.45), (0.85, 0.0, 0.0), (0.95, 0.55, 0.0)
"""The exact sheet, the drawing, findings, lines of another type or width."""


def files(n: int, sheet: Drawing, exact: Sequence[Points], space: Space,
          found: Sequence[tuple[complex, float, str]], looks: Sequence[tuple[Sequence[Points], str]] = ()) -> dict[str, bytes]:
    """Files by name: sheet ``n`` in green over the drawing in grey, findings (centre, radius, number) circled red; all in mm.

    ``looks`` are lines of another type or width, orange, the first of them with its number.
    """
    drawn = [s.points for s in space.strokes]
    areas = [a.points for a in space.areas if a.solid]
    ours = Drawing(sheet.width, sheet.height, sheet.title, tuple(Polyline(z, "thin") for z in exact), sheet.author)
    theirs, marked, unlike = Canvas(), Canvas(), Canvas()
    for z in drawn:
        theirs.polyline(z, "axis")
    for z in areas:
        theirs.fill(z, "axis")
    for w in space.writings:
        _write(theirs, w.text, w.at, w.height, w.width, w.angle)
    for centre, radius, number in found:
        marked.circle(centre, radius, "axis")
        marked.text(centre + 0.75 * radius * (1 + 1j), number, 3.5)
    for places, number in looks:
        for z in places:
            unlike.polyline(z, "vector")
        unlike.text(_beside(places[0]), number, 3.5)
    layers = [(Drawing(sheet.width, sheet.height, sheet.title, tuple(theirs.marks)), GREY), (ours, GREEN),
              (Drawing(sheet.width, sheet.height, sheet.title, tuple(unlike.marks)), ORANGE),
              (Drawing(sheet.width, sheet.height, sheet.title, tuple(marked.marks)), RED)]
    unlike_lines = [(z, number if k == 0 else "") for places, number in looks for k, z in enumerate(places)]
    return {f"sheet{n}-dxf.pdf": pdf.render_coloured(layers),
            f"sheet{n}-overlay.dxf": cad_file.overlay(exact, drawn, found, unlike_lines)}


def _beside(z: Points) -> complex:
    """A place near the middle of a line."""
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
    k = min(int(np.searchsorted(run, run[-1] / 2, "right")), len(z) - 1)
    t = (run[-1] / 2 - run[k - 1]) / max(run[k] - run[k - 1], 1e-9)
    return complex(z[k - 1] + t * (z[k] - z[k - 1])) + 1.5 * (1 + 1j)


def _write(canvas: Canvas, text: str, at: complex, height: float, width: float, angle: float) -> None:
    """Their text in our letters, where those have them."""
    from cmath import rect

    from tmm_sheets.drawing.lettering import advance, plain

    try:
        size = advance(text, height)
    except (KeyError, ValueError):
        return
    canvas.text(at - rect(0.5 * size, angle) - 1j * rect(0.5 * height, angle), plain(text), height, "left", angle)
