"""PDF: true line widths, embedded lettering that can be searched and copied, black only, the same bytes every time.

reportlab makes the page, the font and the file; the content stream is written here, in millimetres. Each role (see
``drawing/styles.py``) is a layer that a viewer can hide; the sheets and their views are bookmarks.
"""

from __future__ import annotations

import zlib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from hashlib import md5
from io import BytesIO
from math import ceil, cos, isfinite, pi, sin, tan
from time import gmtime, strftime
from typing import Any, NamedTuple, cast

from reportlab.lib.utils import TimeStamp
from reportlab.pdfbase import pdfdoc, pdfmetrics
from reportlab.pdfbase.ttfonts import TTFont
from reportlab.pdfgen.canvas import Canvas

from tmm_sheets.backends.svg import escaped
from tmm_sheets.drawing.ink import strokes
from tmm_sheets.drawing.marks import Arc, Box, Drawing, Fill, Line, Polyline, Text, coordinates
from tmm_sheets.drawing.styles import layer, line_type, roles
from tmm_sheets.files import source_date
from tmm_sheets.resources import template
from tmm_sheets.words import paper, tr

MM = 72 / 25.4
SET_UP = f"{MM:.9f} 0 0 {MM:.9f} 0 0 cm 0 g 0 G 1 J 1 j"  # millimetres, black, round ends and corners
FONT = "TMMSheetsB"
CREATOR = "tmm-sheets"
CAP = 0.7  # height of a capital letter of the font, em
ESCAPES = {code: f"\\{code:03o}" for code in (*range(32), *range(127, 256))} | {ord(sign): f"\\{sign}" for sign in "\\()"}
BEZIER = pi / 4  # an arc is cut into cubic curves of at most this angle: 4e-6 of the radius off the circle


Stroke = Line | Arc | Polyline | Fill


class _FastFlate(pdfdoc.PDFStreamFilterZCompress):  # type: ignore[misc]
    """Flate filter at zlib's fastest level: a tenth larger, seven times quicker."""

    def encode(self, text: str | bytes) -> bytes:
        return zlib.compress(text.encode("latin-1") if isinstance(text, str) else text, 1)


def render(drawing: Drawing, date: int | None = None) -> bytes:
    """PDF file of a drawing, bytes; ``date``: its date, seconds since 1970 (default: SOURCE_DATE_EPOCH).

    Raises
    ------
    ValueError
        when a mark has no finite place or a letter is missing from the font.
    """
    return render_all([drawing], date)


def render_all(drawings: Sequence[Drawing], date: int | None = None) -> bytes:
    """The bytes of a PDF file with a page for each drawing.

    Raises
    ------
    ValueError
        when a mark has no finite place or a letter is missing from the font.
    """
    buffer = BytesIO()
    page = _document(drawings[0], buffer, date)
    names = _layers(page)
    for n, drawing in enumerate(drawings, 1):
        page.setPageSize((drawing.width * MM, drawing.height * MM))
        page._code += [SET_UP, _geometry(drawing, names), f"/OC /{names['text']} BDC", _lettering(drawing, page), "EMC"]
        _bookmarks(page, drawing, n)
        page.showPage()
        made = page._doc.Pages.pages[-1]
        made.Contents = pdfdoc.PDFStream(content=made.stream, filters=[_FastFlate()])
        made.Resources = resources = pdfdoc.PDFResourceDictionary()
        resources.basicFonts()
        resources.Properties = {name: pdfdoc.PDFObjectReference(name) for name in names.values()}
    page.save()
    return buffer.getvalue()


def _layers(page: Canvas) -> dict[str, str]:
    """Make the document's layers, one for each role; returns the name by which a page calls each."""
    names = {role: f"L{n}" for n, role in enumerate(roles())}
    references = []
    for role, name in names.items():
        said = pdfdoc.PDFString(tr(roles()[role]["description"]))
        references.append(page._doc.Reference(pdfdoc.PDFDictionary({"Type": pdfdoc.PDFName("OCG"), "Name": said}), name))
    catalog = page._doc._catalog
    shown = pdfdoc.PDFDictionary({"Order": pdfdoc.PDFArray(references), "ON": pdfdoc.PDFArray(references)})
    catalog.__NoDefault__ = [*catalog.__NoDefault__, "OCProperties"]
    catalog.OCProperties = pdfdoc.PDFDictionary({"OCGs": pdfdoc.PDFArray(references), "D": shown})
    return names


def _bookmarks(page: Canvas, drawing: Drawing, n: int) -> None:
    """Add a bookmark for the sheet, and below it one for each view."""
    page.bookmarkPage(f"sheet{n}")
    page.addOutlineEntry(drawing.title, f"sheet{n}", 0)
    for k, view in enumerate(drawing.views, 1):
        key = f"sheet{n}-{k}"
        left, bottom, right, top = [float(edge) * MM for edge in view.box]  # reportlab gives NumPy's numbers all their digits
        page.bookmarkPage(key, "FitR", left=left, bottom=bottom, right=right, top=top)
        page.addOutlineEntry(view.name, key, 1)


def render_coloured(layers: Sequence[tuple[Drawing, tuple[float, float, float]]]) -> bytes:
    """One-page PDF, bytes, of several drawings over each other, each in a colour (red, green, blue, 0 .. 1).

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


class PdfPage(NamedTuple):
    """A page that shows ``part`` of a sheet, moved by ``shift``, and a drawing of its own that sets its size, mm."""

    part: Box
    shift: complex
    own: Drawing


def render_pages(drawing: Drawing, pages: Iterable[PdfPage]) -> bytes:
    """PDF, bytes, of parts of one drawing, 1:1; the file has the drawing once for all pages.

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


def _document(drawing: Drawing, buffer: BytesIO, date: int | None = None) -> Canvas:
    if FONT not in pdfmetrics.getRegisteredFontNames():
        pdfmetrics.registerFont(TTFont(FONT, str(template("fonts/TMMSheetsB.ttf")), asciiReadable=False))
    told = source_date()  # before the library looks at it, which says nothing sensible of a wrong one
    size = (drawing.width * MM, drawing.height * MM)
    page = Canvas(buffer, pagesize=size, invariant=1, initialFontName=FONT, pageCompression=1, pdfVersion=(1, 7))
    page._doc._timeStamp = stamp = TimeStamp(1)
    if (seconds := told if date is None else date) is not None:
        stamp.t, stamp.lt = seconds, gmtime(seconds)
        stamp.YMDhms = tuple(stamp.lt)[:6]
    page._doc.signature = md5(str(int(stamp.t)).encode(), usedforsecurity=False)  # the file's identifier begins with its date
    page.setTitle(drawing.title)
    page.setAuthor(drawing.author)
    page.setSubject(drawing.subject)
    page.setKeywords(drawing.keywords)
    page.setCreator(CREATOR)
    page.setProducer("reportlab")
    page.setViewerPreference("PrintScaling", "None")
    page.setViewerPreference("DisplayDocTitle", "true")
    page._doc._catalog.Lang = pdfdoc.PDFString(paper())
    page._doc._catalog.Metadata = pdfdoc.PDFStream(
        pdfdoc.PDFDictionary({"Type": pdfdoc.PDFName("Metadata"), "Subtype": pdfdoc.PDFName("XML")}),
        _metadata(drawing, strftime("%Y-%m-%dT%H:%M:%SZ", gmtime(stamp.t))))
    return page


def _metadata(drawing: Drawing, date: str) -> bytes:
    """Metadata of the file as an XMP packet."""
    words = "".join(f"<rdf:li>{escaped(word)}</rdf:li>" for word in drawing.keywords.split(", ") if word)
    return (
        '<?xpacket begin="\ufeff" id="W5M0MpCehiHzreSzNTczkc9d"?>\n'
        '<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">\n'
        '<rdf:Description rdf:about="" xmlns:dc="http://purl.org/dc/elements/1.1/" xmlns:pdf="http://ns.adobe.com/pdf/1.3/" '
        'xmlns:xmp="http://ns.adobe.com/xap/1.0/">\n'
        "<dc:format>application/pdf</dc:format>\n"
        f'<dc:title><rdf:Alt><rdf:li xml:lang="x-default">{escaped(drawing.title)}</rdf:li></rdf:Alt></dc:title>\n'
        f"<dc:creator><rdf:Seq><rdf:li>{escaped(drawing.author)}</rdf:li></rdf:Seq></dc:creator>\n"
        f'<dc:description><rdf:Alt><rdf:li xml:lang="x-default">{escaped(drawing.subject)}</rdf:li></rdf:Alt></dc:description>\n'
        f"<dc:subject><rdf:Bag>{words}</rdf:Bag></dc:subject>\n"
        f"<dc:language><rdf:Bag><rdf:li>{paper()}</rdf:li></rdf:Bag></dc:language>\n"
        f"<pdf:Keywords>{escaped(drawing.keywords)}</pdf:Keywords><pdf:Producer>reportlab</pdf:Producer>\n"
        f"<xmp:CreatorTool>{CREATOR}</xmp:CreatorTool>"
        f"<xmp:CreateDate>{date}</xmp:CreateDate><xmp:ModifyDate>{date}</xmp:ModifyDate>\n"
        '</rdf:Description></rdf:RDF></x:xmpmeta>\n<?xpacket end="r"?>').encode()


def _geometry(drawing: Drawing, names: Mapping[str, str] | None = None) -> str:
    """Path operators of all marks but lettering, by role, in its layer, and by line type."""
    by_look = defaultdict[tuple[str, str], list[str]](list)
    drawn = [mark for mark in drawing.marks if type(mark) is not Text]
    for mark in cast("Iterator[Stroke]", strokes(drawn)):
        by_look[names[layer(mark).role] if names else "", mark.style] += [_path(mark)]
    # Thin lines first, so that thick ones lie over their ends.
    looks = sorted(by_look, key=lambda look: (look[0], line_type(look[1]).width, look[1]))
    parts = []
    for look in looks:
        path = f"{line_type(look[1]).width:.3f} w\n" + "\n".join(by_look[look])
        parts.append(f"/OC /{look[0]} BDC\n{path}\nEMC" if look[0] else path)
    body = "\n".join(parts)
    if "n" in body.replace("\n", " "):  # path operators used here contain no n; nan and inf do
        bad = next(m for m in cast("Iterator[Stroke]", strokes(drawn)) if "n" in _path(m))
        raise ValueError(f"a mark of '{bad.of}' has no finite place: {bad}")
    return body


def _path(mark: Stroke) -> str:
    match mark:
        case Line():
            return f"{mark.a.real:.3f} {mark.a.imag:.3f} m {mark.b.real:.3f} {mark.b.imag:.3f} l S"
        case Arc():
            return _arc(mark)
        case Fill():
            end = "f"
        case _:
            end = "s" if mark.closed else "S"
    xy = coordinates(mark.points)
    return ("%.3f %.3f m" + " %.3f %.3f l" * (len(xy) // 2 - 1)) % tuple(xy) + " " + end


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


@lru_cache(maxsize=4096)
def _turned(angle: float) -> str:
    c, s = cos(angle), sin(angle)
    return f"{c:.5f} {s:.5f} {-s:.5f} {c:.5f}"


def _lettering(drawing: Drawing, page: Any) -> str:
    """Text operators of the runs of letters, in the order of the drawing."""
    font, doc = pdfmetrics.getFont(FONT), page._doc
    out, now, wide, known = ["BT"], "", 1.0, {*map(chr, font.face.charToGlyph)}
    coded = dict[str, list[tuple[str, str]]]()  # by its text each run's subsets of the font with its codes there
    for mark in drawing.marks:
        if type(mark) is not Text:
            continue
        if mark.text not in coded:
            if not known.issuperset(mark.text):
                missing = [c for c in mark.text if c not in known]
                raise ValueError(f"the drawing font has no character '{missing[0]}' (U+{ord(missing[0]):04X}) in '{mark.text}'")
            coded[mark.text] = [(font.getSubsetInternalName(subset, doc), code.decode("latin-1").translate(ESCAPES))
                                for subset, code in font.splitString(mark.text, doc)]
        place = f"{_turned(mark.angle)} {mark.at.real:.3f} {mark.at.imag:.3f} Tm"
        if "n" in place:
            raise ValueError(f"lettering '{mark.text}' of '{mark.of}' has no finite place: {mark}")
        out.append(place)
        if mark.wide != wide:
            out.append(f"{100 * mark.wide:g} Tz")
            wide = mark.wide
        for subset, code in coded[mark.text]:
            look = f"{subset} {mark.height / CAP:.4f} Tf"
            out.append(f"({code}) Tj" if look == now else f"{look} ({code}) Tj")
            now = look
    return "\n".join([*out, "ET"])
