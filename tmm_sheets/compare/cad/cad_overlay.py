"""The exact sheet over a CAD drawing: a DXF to open in the CAD program, a PDF to look at."""

from __future__ import annotations

from cmath import rect
from collections.abc import Sequence
from io import StringIO

import numpy as np

from tmm_sheets.backends import pdf
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, Writing
from tmm_sheets.compare.numbering import around, legend, numbered
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Drawing, Mark, Points, Polyline
from tmm_sheets.words import tell

HIGH = 3.5
"""Height of the numbers, mm."""
COLOURS = {"exact": (0.0, 0.45, 0.7), "drawn": (0.45, 0.45, 0.45), "found": (0.85, 0.0, 0.0), "looks": (0.95, 0.55, 0.0)}
"""Those of the exact sheet, the drawing, findings, lines of a wrong type or width."""
LAYERS = {"SHEET": 3, "DRAWN": 8, "FOUND": 1, "LOOKS": 30}
"""Layers of the overlay and their AutoCAD colours: the exact sheet green, the student's drawing grey, findings red, lines of a
wrong type or width orange.
"""


def files(n: int, sheet: Drawing, exact: Sequence[Points], space: DrawingSpace,
          found: Sequence[tuple[complex, float, str, str]], looks: Sequence[tuple[Sequence[Points], str]] = ()) -> dict[str, bytes]:
    """The overlays by file name.

    Parameters
    ----------
    n, sheet : number of the sheet, and the sheet itself
    exact : its lines where the drawing has them, mm
    space : the drawing, mm
    found : centre and radius, mm, number and verdict of each finding
    looks : lines of a wrong type or width, mm, with their number, which stands at the first of them
    """
    drawn = [s.points for s in space.strokes]
    ours: list[Mark] = [Polyline(z, "thin") for z in exact]
    entries = [("line", tell("drawn")), ("line", tell("exact")), ("line", tell("of another type or width")), ("red", tell("wrong")),
               ("amber", tell("worth a look"))]
    said: list[list[Mark]] = [[Polyline(z, "axis") for z in strokes] for strokes in legend(entries)]
    layers = ((theirs(space) + said[0], COLOURS["drawn"]), (ours + said[1], COLOURS["exact"]),
              (_wrong_looks(looks) + said[2], COLOURS["looks"]), (_marked(found) + said[3] + said[4], COLOURS["found"]))
    pages = [(Drawing(sheet.width, sheet.height, sheet.title, tuple(marks)), colour) for marks, colour in layers]
    numbered = [(z, number if k == 0 else "") for places, number in looks for k, z in enumerate(places)]
    circled = [(at, reach, number) for at, reach, number, _ in found]
    return {f"sheet{n}-dxf.pdf": pdf.render_coloured(pages),
            f"sheet{n}-overlay.dxf": _dxf(exact, drawn, circled, numbered)}


def theirs(space: DrawingSpace) -> list[Mark]:
    """What a drawing shows, as marks of our own."""
    canvas = Canvas()
    for s in space.strokes:
        canvas.polyline(s.points, "axis")
    for a in space.areas:
        if a.solid:
            canvas.fill(a.points, "axis")
    for w in space.writings:
        _write(canvas, w)
    return canvas.marks


def _wrong_looks(looks: Sequence[tuple[Sequence[Points], str]]) -> list[Mark]:
    canvas = Canvas()
    for places, number in looks:
        for z in places:
            canvas.polyline(z, "vector")
        canvas.text(_beside(places[0]), number, 3.5)
    return canvas.marks


def _marked(found: Sequence[tuple[complex, float, str, str]]) -> list[Mark]:
    canvas = Canvas()
    for centre, radius, _, verdict in found:
        canvas.polyline(around(verdict, centre, radius), "axis")
    for one in numbered([(centre, radius, number) for centre, radius, number, _ in found], HIGH):
        if one.leader is not None:
            canvas.line(*one.leader, "axis")
        canvas.text(one.at, one.text, HIGH, "left")
    return canvas.marks


def _beside(z: Points) -> complex:
    """A place beside the middle of a line."""
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
    k = min(int(np.searchsorted(run, run[-1] / 2, "right")), len(z) - 1)
    t = (run[-1] / 2 - run[k - 1]) / max(run[k] - run[k - 1], 1e-9)
    return complex(z[k - 1] + t * (z[k] - z[k - 1])) + 1.5 * (1 + 1j)


def _write(canvas: Canvas, w: Writing) -> None:
    """Their text in our lettering, if that has all of its letters."""
    from tmm_sheets.drawing.lettering import advance, plain

    try:
        size = advance(w.text, w.height)
    except (KeyError, ValueError):
        return
    canvas.text(w.at - rect(0.5 * size, w.angle) - 1j * rect(0.5 * w.height, w.angle), plain(w.text), w.height, "left", w.angle)


def _dxf(exact: Sequence[Points], drawn: Sequence[Points], found: Sequence[tuple[complex, float, str]],
            looks: Sequence[tuple[Points, str]] = ()) -> bytes:
    """A DXF file (R12, which every program reads) of the exact sheet over the drawing, with findings circled and numbered.

    Parameters
    ----------
    exact, drawn : lines of the sheet and of the drawing, mm
    found : centre and radius, mm, and number of each finding
    looks : lines of a wrong type or width, mm, with a number or an empty text
    """
    from ezdxf.addons.r12writer import r12writer

    text = StringIO()
    with r12writer(text) as dxf:
        for layer, lines in (("DRAWN", drawn), ("SHEET", exact)):
            for z in lines:
                dxf.add_polyline_2d(np.column_stack((z.real, z.imag)).tolist(), layer=layer, color=LAYERS[layer])
        for z, number in looks:
            dxf.add_polyline_2d(np.column_stack((z.real, z.imag)).tolist(), layer="LOOKS", color=LAYERS["LOOKS"])
            if number:
                at = z[len(z) // 2] if len(z) > 2 else z.mean()
                dxf.add_text(number, (at.real + 1.5, at.imag + 1.5), height=3.5, layer="LOOKS", color=LAYERS["LOOKS"])
        for centre, radius, _ in found:
            dxf.add_circle((centre.real, centre.imag), radius, layer="FOUND", color=LAYERS["FOUND"])
        for one in numbered(found, 3.5):
            if one.leader is not None:
                a, b = one.leader
                dxf.add_line((a.real, a.imag), (b.real, b.imag), layer="FOUND", color=LAYERS["FOUND"])
            dxf.add_text(one.text, (one.at.real, one.at.imag), height=3.5, layer="FOUND", color=LAYERS["FOUND"])
    return text.getvalue().encode("ascii")
