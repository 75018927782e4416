"""The exact sheet and a CAD drawing over each other: a DXF to open in the CAD program, a PDF to look at."""

from __future__ import annotations

from collections.abc import Sequence

from tmm_sheets.backends import pdf
from tmm_sheets.compare import cad_file
from tmm_sheets.compare.cad_ink import Space
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Drawing, Points, Polyline

GREEN, GREY, RED = (0.0, 0.6, 0.2), (0.45, 0.45, 0.45), (0.85, 0.0, 0.0)
"""The exact sheet, the drawing, findings."""


def files(n: int, sheet: Drawing, exact: Sequence[Points], space: Space,
          found: Sequence[tuple[complex, float, str]]) -> dict[str, bytes]:
    """Files by name: sheet ``n`` in green over the drawing in grey, findings (centre, radius, number) circled red; all in mm."""
    drawn = [s.points for s in space.strokes]
    areas = [a.points for a in space.areas if a.solid]
    ours = Drawing(sheet.width, sheet.height, sheet.title, tuple(Polyline(z, "thin") for z in exact), sheet.author)
    theirs, marked = Canvas(), Canvas()
    for z in drawn:
        theirs.polyline(z, "axis")
    for z in areas:
        theirs.fill(z, "axis")
    for w in space.writings:
        _write(theirs, w.text, w.at, w.height, w.width, w.angle)
    for centre, radius, number in found:
        marked.circle(centre, radius, "axis")
        marked.text(centre + 0.75 * radius * (1 + 1j), number, 3.5)
    layers = [(Drawing(sheet.width, sheet.height, sheet.title, tuple(theirs.marks)), GREY), (ours, GREEN),
              (Drawing(sheet.width, sheet.height, sheet.title, tuple(marked.marks)), RED)]
    return {f"sheet{n}-dxf.pdf": pdf.render_coloured(layers),
            f"sheet{n}-overlay.dxf": cad_file.overlay(exact, drawn, found)}


def _write(canvas: Canvas, text: str, at: complex, height: float, width: float, angle: float) -> None:
    """Their text in our letters, where those have them."""
    from cmath import rect

    from tmm_sheets.drawing.lettering import advance, plain

    try:
        size = advance(text, height)
    except (KeyError, ValueError):
        return
    canvas.text(at - rect(0.5 * size, angle) - 1j * rect(0.5 * height, angle), plain(text), height, "left", angle)
