"""The exact sheet over a CAD drawing: a DXF to open in the CAD program, a PDF to look at; numbers and legend of any overlay."""

from __future__ import annotations

from cmath import rect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from math import pi

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import LETTER_WIDTH, DrawingSpace, Writing
from tmm_sheets.compare.elements import point_along
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.lettering import advance, plain
from tmm_sheets.drawing.marks import Drawing, Line, Mark, Points, Polyline, Text
from tmm_sheets.words import tell

HIGH = 3.5
"""Height of the numbers, mm."""
LAYERS = {"DRAWN": (8, (0.45, 0.45, 0.45)), "SHEET": (3, (0.0, 0.45, 0.7)), "LOOKS": (30, (0.95, 0.55, 0.0)),
          "FOUND": (1, (0.85, 0.0, 0.0))}
"""Layers of the overlay, their AutoCAD colours and those on paper: the student's drawing, the exact sheet, lines of a wrong type or
width, findings.
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
    from tmm_sheets.backends import pdf  # a photograph needs the numbers alone

    marks: dict[str, list[Mark]] = {"DRAWN": theirs(space), "SHEET": [Polyline(z, "thin") for z in exact],
                                    "LOOKS": _wrong_looks(looks), "FOUND": _marked(found)}
    entries = [("line", tell("drawn")), ("line", tell("exact")), ("line", tell("of another type or width")), ("red", tell("wrong")),
               ("amber", tell("worth a look"))]
    said: list[list[Mark]] = [[Polyline(z, "axis") for z in strokes] for strokes in legend(entries)]
    pages = [(Drawing(sheet.width, sheet.height, sheet.title, (*marks[layer], *words)), colour)
             for (layer, (_, colour)), words in zip(LAYERS.items(), (*said[:3], said[3] + said[4]), strict=True)]
    return {f"sheet{n}-dxf.pdf": pdf.render_coloured(pages), f"sheet{n}-overlay.dxf": _dxf(marks)}


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
        z = places[0]
        canvas.text(point_along(z, float(np.abs(np.diff(z)).sum()) / 2) + 1.5 * (1 + 1j), number, HIGH)  # beside its middle
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


def _write(canvas: Canvas, w: Writing) -> None:
    """Their text in our lettering, if that has all of its letters."""
    try:
        size = advance(w.text, w.height)
    except (KeyError, ValueError):
        return
    canvas.text(w.at - rect(0.5 * size, w.angle) - 1j * rect(0.5 * w.height, w.angle), plain(w.text), w.height, "left", w.angle)


def _dxf(marks: Mapping[str, Sequence[Mark]]) -> bytes:
    """The layers as a DXF file (R12, which every program reads); of the drawing only its lines."""
    from ezdxf.addons.r12writer import r12writer

    text = StringIO()
    with r12writer(text) as dxf:
        for layer, (colour, _) in LAYERS.items():
            for mark in marks[layer]:
                if isinstance(mark, Text) and layer != "DRAWN":
                    dxf.add_text(mark.text, (mark.at.real, mark.at.imag), height=mark.height, layer=layer, color=colour)
                elif isinstance(mark, Line | Polyline):
                    z = mark.points if isinstance(mark, Polyline) else np.array([mark.a, mark.b])
                    dxf.add_polyline_2d(np.column_stack((z.real, z.imag)).tolist(), layer=layer, color=colour)
    return text.getvalue().encode("ascii")


# --- numbers beside findings, the legend --------------------------------------------------------------------------------------

HEIGHT = 4.0
"""Height of the words, mm."""
START, SAMPLE = 12.0 + 30.0j, 12.0
"""Where the first entry begins, and the length of the sample of a line, mm; after each as much is free."""


def around(verdict: str, at: complex, radius: float) -> Points:
    """The mark round a place, closed."""
    corners = np.linspace(0, 2 * np.pi, 5 if verdict == "amber" else 49)
    return np.asarray(at + radius * np.exp(1j * corners))


def legend(entries: Sequence[tuple[str, str]]) -> list[list[Points]]:
    """Strokes of each entry, mm of the sheet: its sample, a "line" or the mark of a verdict, and its words."""
    along, out = 0.0, []
    for form, words in entries:
        middle = along + SAMPLE / 2 + 0.5j * HEIGHT
        sample = np.array([along, along + SAMPLE]) + 0.5j * HEIGHT if form == "line" else around(form, middle, 0.8 * HEIGHT)
        at = along + SAMPLE + 0.5 * HEIGHT
        out.append([START + 1j * z for z in (sample, *letters(Text(complex(at), words, HEIGHT)))])
        along = at + advance(words, HEIGHT) + SAMPLE
    return out


WAYS = np.exp(1j * pi * np.array([1, 3, -1, -3, 0, 2, 4, -2, 0.5, 1.5, 2.5, 3.5, -0.5, -1.5, -2.5, -3.5]) / 4)
"""Directions in which a number may stand from its place, those first that are tried first."""
RINGS = 24
"""How many distances are tried."""


@dataclass(frozen=True)
class Numbered:
    """A number with the lower left corner of its box; ``leader`` is the line to its place, None where it stands at it."""

    text: str
    at: complex
    leader: tuple[complex, complex] | None = None


def numbered(places: Sequence[tuple[complex, float, str]], height: float, within: Box | None = None) -> list[Numbered]:
    """Where numbers stand.

    Parameters
    ----------
    places : centre, radius of the circle round it, and number
    height : of the digits, in the unit of the places
    within : where numbers must lie, anywhere unless told
    """
    taken: list[Box] = []
    out: list[Numbered] = []
    for centre, radius, text in places:
        size = complex(LETTER_WIDTH * height * len(text), height)
        box, ring = _free(centre, radius, size, taken, within)
        taken.append(box)
        near = box.nearest(centre)
        away = near - centre
        far = ring > 0 and abs(away) > radius + 0.5 * height
        leader = (centre + away / abs(away) * radius, near) if far else None
        out.append(Numbered(text, complex(box.x0, box.y0), leader))
    return out


def _free(centre: complex, radius: float, size: complex, taken: Sequence[Box], within: Box | None) -> tuple[Box, int]:
    """The nearest box that touches no other, and how far out it is."""
    first: Box | None = None
    for ring in range(RINGS):
        for way in WAYS:
            # The box touches the circle from outside in that direction.
            at = centre + (radius + 0.3 * size.imag + 0.8 * ring * size.imag) * complex(way)
            corner = complex(at.real - (size.real if way.real < -0.1 else 0.5 * size.real if abs(way.real) <= 0.1 else 0.0),
                             at.imag - (size.imag if way.imag < -0.1 else 0.5 * size.imag if abs(way.imag) <= 0.1 else 0.0))
            box = Box(corner.real, corner.imag, corner.real + size.real, corner.imag + size.imag)
            first = first or box
            inside = within is None or (within.contains(complex(box.x0, box.y0)) and within.contains(complex(box.x1, box.y1)))
            gap = 0.15 * size.imag
            if inside and all(box.x0 >= b.x1 + gap or b.x0 >= box.x1 + gap or box.y0 >= b.y1 + gap or b.y0 >= box.y1 + gap
                              for b in taken):
                return box, ring
    assert first is not None
    return first, RINGS
