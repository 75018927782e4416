"""PDF: true line widths, embedded lettering that can be searched and copied, black only, the same bytes every time.

reportlab makes the page, the font and the file; the content stream is written here, in millimetres.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Sequence
from io import BytesIO
from math import ceil, cos, isfinite, pi, sin, tan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from reportlab.pdfbase import pdfdoc, pdfmetrics
from reportlab.pdfbase.ttfonts import TTFont
from reportlab.pdfgen.canvas import Canvas

from tmm_sheets.drawing.dashes import strokes
from tmm_sheets.drawing.marks import Arc, Box, Drawing, Fill, Line, Mark, Text
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.files import put
from tmm_sheets.resources import template

MM = 72 / 25.4
SET_UP = f"{MM:.9f} 0 0 {MM:.9f} 0 0 cm 0 g 0 G 1 J 1 j"  # millimetres, black, round ends and corners
FONT = "TMMSheetsB"
CAP = 0.7  # height of a capital letter of the font, em
BEZIER = pi / 4  # an arc is cut into cubic curves of at most this angle: 4e-6 of the radius off the circle


class _FastFlate(pdfdoc.PDFStreamFilterZCompress):  # type: ignore[misc]
    """Compression at zlib's fastest level: a tenth larger, seven times quicker."""

    def encode(self, text: str | bytes) -> bytes:
        return zlib.compress(text.encode("latin-1") if isinstance(text, str) else text, 1)


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing as a one-page PDF of its paper size, 1:1.

    Raises
    ------
    ValueError
        When a mark has coordinates that are not finite or a letter is missing from the font.
    OSError
        When the file cannot be written; nothing is left behind.
    """
    put({path: render(drawing)})


def render(drawing: Drawing) -> bytes:
    """The bytes of the PDF file.

    Raises
    ------
    ValueError
        when a mark has no finite place or a letter is missing from the font.
    """
    buffer = BytesIO()
    page = _document(drawing, buffer)
    page._code += [SET_UP, _geometry(drawing), _lettering(drawing, page)]
    page.showPage()
    stream = pdfdoc.PDFStream(content=page._doc.Pages.pages[-1].stream, filters=[_FastFlate()])
    page._doc.Pages.pages[-1].Contents = stream
    page.save()
    return buffer.getvalue()


def render_coloured(layers: Sequence[tuple[Drawing, tuple[float, float, float]]]) -> bytes:
    """The bytes of a one-page PDF with several drawings over each other, each in a colour of its own (red, green, blue, 0 .. 1).

    Raises
    ------
    ValueError
        when a mark has no finite place or a letter is missing from the font.
    """
    buffer = BytesIO()
    page = _document(layers[0][0], buffer)
    for drawing, (r, g, b) in layers:
        colour = f"{r:.3f} {g:.3f} {b:.3f}"
        page._code += ["q", SET_UP, f"{colour} RG {colour} rg", _geometry(drawing), _lettering(drawing, page), "Q"]
    page.showPage()
    page.save()
    return buffer.getvalue()


class Page(NamedTuple):
    """A page that shows a ``part`` of a sheet, moved there by ``shift``, and marks of its own (its size is theirs), mm."""

    part: Box
    shift: complex
    own: Drawing


def render_pages(drawing: Drawing, pages: Iterable[Page]) -> bytes:
    """The bytes of a PDF with parts of one drawing, 1:1; the drawing is in the file once, whatever the number of pages.

    Raises
    ------
    ValueError
        when a mark has no finite place or a letter is missing from the font.
    """
    buffer = BytesIO()
    page = _document(drawing, buffer)
    page.beginForm("sheet", 0, 0, drawing.width * MM, drawing.height * MM)
    page._code += [SET_UP, _geometry(drawing), _lettering(drawing, page)]
    page.endForm()
    for part, shift, own in pages:
        page.setPageSize((own.width * MM, own.height * MM))
        page._code += ["q", SET_UP, _geometry(own), _lettering(own, page), "Q", "q"]
        x, y = (part.x0 + shift.real) * MM, (part.y0 + shift.imag) * MM
        page._code.append(f"{x:.6f} {y:.6f} {part.width * MM:.6f} {part.height * MM:.6f} re W n")
        page._code.append(f"1 0 0 1 {shift.real * MM:.6f} {shift.imag * MM:.6f} cm")
        page.doForm("sheet")
        page._code.append("Q")
        page.showPage()
    page.save()
    return buffer.getvalue()


def _document(drawing: Drawing, buffer: BytesIO) -> Canvas:
    if FONT not in pdfmetrics.getRegisteredFontNames():
        pdfmetrics.registerFont(TTFont(FONT, str(template("fonts/TMMSheetsB.ttf")), asciiReadable=False))
    size = (drawing.width * MM, drawing.height * MM)
    page = Canvas(buffer, pagesize=size, invariant=1, initialFontName=FONT, pageCompression=1)
    page.setTitle(drawing.title)
    page.setAuthor(drawing.author)
    page.setCreator("tmm-sheets")
    page.setViewerPreference("PrintScaling", "None")
    return page


def _geometry(drawing: Drawing) -> str:
    """Path operators of everything but the lettering, line type by line type."""
    by_style: dict[str, list[str]] = {}
    for mark in strokes(drawing.marks):
        if not isinstance(mark, Text):
            by_style.setdefault(mark.style, []).append(_path(mark))
    # Thin lines first, so that thick ones lie over their ends.
    styles = sorted(by_style, key=lambda name: (line_type(name).width, name))
    body = "\n".join(f"{line_type(s).width:.3f} w\n" + "\n".join(by_style[s]) for s in styles)
    if "n" in body.replace("\n", " "):  # path operators used here contain no n; nan and inf do
        bad = next(m for m in strokes(drawing.marks) if not isinstance(m, Text) and "n" in _path(m))
        raise ValueError(f"a mark of '{bad.of}' has no finite place: {bad}")
    return body


def _path(mark: Mark) -> str:
    if isinstance(mark, Line):
        return f"{mark.a.real:.3f} {mark.a.imag:.3f} m {mark.b.real:.3f} {mark.b.imag:.3f} l S"
    if isinstance(mark, Arc):
        return _arc(mark)
    assert not isinstance(mark, Text)
    points = mark.points
    xy = np.column_stack((points.real, points.imag)).ravel().tolist()
    end = "f" if isinstance(mark, Fill) else "s" if mark.closed else "S"
    return ("%.3f %.3f m" + " %.3f %.3f l" * (len(points) - 1)) % tuple(xy) + " " + end


def _arc(mark: Arc) -> str:
    turn = mark.end - mark.start
    n = max(ceil(turn / BEZIER), 1) if isfinite(turn) else 1
    d = turn / n
    k = 4 / 3 * tan(d / 4) * mark.radius
    x0, y0, r = mark.centre.real, mark.centre.imag, mark.radius
    c, s = cos(mark.start), sin(mark.start)
    x, y = x0 + r * c, y0 + r * s
    out = [f"{x:.3f} {y:.3f} m"]
    for i in range(1, n + 1):
        a, b = x - k * s, y + k * c
        c, s = cos(mark.start + i * d), sin(mark.start + i * d)
        x, y = x0 + r * c, y0 + r * s
        out.append(f"{a:.3f} {b:.3f} {x + k * s:.3f} {y - k * c:.3f} {x:.3f} {y:.3f} c")
    out.append("s" if turn > 2 * pi - 1e-9 else "S")
    return " ".join(out)


def _lettering(drawing: Drawing, page: Any) -> str:
    """Text operators, run by run in the order of the drawing."""
    font, doc, escape = pdfmetrics.getFont(FONT), page._doc, page._escape
    out, now = ["BT"], ""
    for mark in drawing.marks:
        if not isinstance(mark, Text):
            continue
        if missing := [c for c in mark.text if ord(c) not in font.face.charToGlyph]:
            raise ValueError(f"the drawing font has no character '{missing[0]}' (U+{ord(missing[0]):04X}) in '{mark.text}'")
        c, s = cos(mark.angle), sin(mark.angle)
        place = f"{c:.5f} {s:.5f} {-s:.5f} {c:.5f} {mark.at.real:.3f} {mark.at.imag:.3f} Tm"
        if "n" in place:
            raise ValueError(f"lettering '{mark.text}' of '{mark.of}' has no finite place: {mark}")
        out.append(place)
        for subset, code in font.splitString(mark.text, doc):
            look = f"{font.getSubsetInternalName(subset, doc)} {mark.height / CAP:.4f} Tf"
            out.append(f"({escape(code)}) Tj" if look == now else f"{look} ({escape(code)}) Tj")
            now = look
    return "\n".join([*out, "ET"])
