"""A story as a PDF of A4 pages, set by reportlab in the project's own font."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from io import BytesIO
from typing import Any

from reportlab.graphics.shapes import Circle, Drawing, Image, PolyLine, String
from reportlab.lib import colors
from reportlab.lib.pagesizes import A4
from reportlab.lib.styles import ParagraphStyle
from reportlab.lib.units import mm
from reportlab.pdfbase import pdfmetrics
from reportlab.pdfbase.ttfonts import TTFont
from reportlab.platypus import KeepTogether, LongTable, Paragraph, SimpleDocTemplate, Spacer, TableStyle

from tmm_sheets.backends.pdf import CREATOR, FONT
from tmm_sheets.compare.numbering import numbered
from tmm_sheets.compare.story import Story, StoryPicture, StoryTable, ToldMistake, clipped
from tmm_sheets.compare.story_html import OURS, THEIRS, WRONG
from tmm_sheets.drawing.marks import Points
from tmm_sheets.resources import template
from tmm_sheets.words import tell

TEXT = ParagraphStyle("text", fontName=FONT, fontSize=10, leading=13)
SMALL = ParagraphStyle("small", parent=TEXT, fontSize=8.5, leading=10.5)
HEAD = ParagraphStyle("head", parent=TEXT, fontSize=13, leading=17, spaceBefore=10, spaceAfter=4)
TITLE = ParagraphStyle("title", parent=TEXT, fontSize=16, leading=20, spaceAfter=4)
WHERE = ParagraphStyle("where", parent=TEXT, textColor=colors.HexColor("#555555"))
MARGIN = 15 * mm
WIDE, HIGH = A4[0] - 2 * MARGIN, 95 * mm
"""Largest size of a picture."""
TINTS = {"red": colors.HexColor("#fde4e4"), "amber": colors.HexColor("#fff3dc")}
"""Backgrounds of rows."""
SIDES = {"red": colors.HexColor(WRONG), "amber": colors.HexColor("#e58a00"), "green": colors.HexColor("#009933")}


def pdf(story: Story) -> bytes:
    """The document."""
    if FONT not in pdfmetrics.getRegisteredFontNames():
        pdfmetrics.registerFont(TTFont(FONT, str(template("fonts/TMMSheetsB.ttf"))))
    buffer = BytesIO()
    document = SimpleDocTemplate(buffer, pagesize=A4, leftMargin=MARGIN, rightMargin=MARGIN, topMargin=MARGIN, bottomMargin=MARGIN,
                                 title=story.title, creator=CREATOR, invariant=1)
    document.build(list(_flow(story)), onFirstPage=_page, onLaterPages=_page)
    return buffer.getvalue()


def _page(canvas: Any, document: Any) -> None:
    canvas.setFont(FONT, 9)
    canvas.drawRightString(A4[0] - MARGIN, 8 * mm, str(document.page))


def _flow(story: Story) -> Iterator[Any]:
    yield Paragraph(_said(story.title), TITLE)
    yield from (Paragraph(_said(line), TEXT) for line in story.about)
    if story.mistakes:
        yield Paragraph(_said(tell("What is wrong")), HEAD)
        if any(m.picture is not None for m in story.mistakes):
            key = ((OURS, tell("exact")), (THEIRS, tell("drawn")), (WRONG, tell("wrong")))
            yield Paragraph(" &nbsp; ".join(f'<font color="{c}">— {_said(said)}</font>' for c, said in key), SMALL)
        yield from map(_mistake, story.mistakes)
    for table in story.tables:
        yield Paragraph(_said(table.title), HEAD)
        yield _table(table)
    if story.unjudged:
        yield Paragraph(_said(tell("What could not be judged, and why")), HEAD)
        yield from (Paragraph("– " + _said(line), TEXT) for line in story.unjudged)


def _said(text: str) -> str:
    """A text with the letters the font has; others become a question mark rather than nothing."""
    face = pdfmetrics.getFont(FONT).face
    return escape("".join(c if ord(c) in face.charToGlyph or c == "\n" else _LIKE.get(c, "?") for c in text), quote=False)


_LIKE = {"\u0305": "", "\u0304": "", "\u202f": " ", "\xa0": " ", "…": "...", "‑": "-", "−": "-", "“": '"', "”": '"', "„": '"'}


def _mistake(m: ToldMistake) -> Any:
    what = _said(m.again or m.what)
    parts: list[Any] = [Spacer(0, 5), Paragraph(_said(m.where), WHERE),
                        Paragraph(f'<font color="{SIDES[m.verdict].hexval().replace("0x", "#")}">■</font> {what}'
                                  if _has("■") else what, TEXT)]
    parts += [Paragraph("– " + _said(line), SMALL) for line in m.details]
    if m.picture is not None:
        parts += [Spacer(0, 3), _picture(m.picture)]
    return KeepTogether(parts)


def _has(letter: str) -> bool:
    return ord(letter) in pdfmetrics.getFont(FONT).face.charToGlyph


def _table(table: StoryTable) -> Any:
    cells = [[Paragraph(_said(c), SMALL) for c in row] for row in (table.head, *table.rows)]
    longest = [min(max(len(row[k]) for row in (table.head, *table.rows)), 40) + 2 for k in range(len(table.head))]
    # No column narrower than its longest word.
    words = [max((pdfmetrics.stringWidth(w, FONT, SMALL.fontSize) for row in (table.head, *table.rows) for w in row[k].split()),
                 default=0.0) + 9 for k in range(len(table.head))]
    spare = max(WIDE - sum(words), 0.0)
    widths = [w + spare * n / sum(longest) for w, n in zip(words, longest, strict=True)]
    tinted = [("BACKGROUND", (0, k), (-1, k), TINTS[verdict]) for k, verdict in enumerate(table.verdicts, 1) if verdict in TINTS]
    return LongTable(cells, colWidths=widths, repeatRows=1, style=TableStyle([
        *tinted,
        ("GRID", (0, 0), (-1, -1), 0.3, colors.grey), ("BACKGROUND", (0, 0), (-1, 0), colors.whitesmoke),
        ("VALIGN", (0, 0), (-1, -1), "TOP"), ("LEFTPADDING", (0, 0), (-1, -1), 3), ("RIGHTPADDING", (0, 0), (-1, -1), 3),
        ("TOPPADDING", (0, 0), (-1, -1), 1.5), ("BOTTOMPADDING", (0, 0), (-1, -1), 2.5)]))


def _picture(p: StoryPicture) -> Drawing:
    box = p.box
    scale = min(WIDE / max(box.width, 1.0), HIGH / max(box.height, 1.0), 1.6 * mm)
    drawing = Drawing(box.width * scale, box.height * scale)

    def at(z: complex) -> tuple[float, float]:
        # What lies beyond the picture ends at its edge.
        return (min(max(z.real, box.x0), box.x1) - box.x0) * scale, (min(max(z.imag, box.y0), box.y1) - box.y0) * scale

    def draw(lines: tuple[Points, ...], colour: str, width: float) -> None:
        for z in clipped(lines, box):
            flat = [c for point in z.tolist() for c in at(point)]
            if len(flat) >= 4:
                drawing.add(PolyLine(flat, strokeColor=colors.HexColor(colour), strokeWidth=width))

    if p.photo is not None:
        from PIL import Image as Pixels

        b = p.photo.box
        drawing.add(Image(*at(complex(b.x0, b.y0)), b.width * scale, b.height * scale, Pixels.open(BytesIO(p.photo.png))))
    draw(p.theirs, THEIRS, 1.1)
    draw(p.ours, OURS, 0.6)
    draw(p.wrong, WRONG, 1.4)
    for centre, radius, _ in p.places:
        drawing.add(Circle(*at(centre), radius * scale, fillColor=None, strokeColor=colors.HexColor(WRONG), strokeWidth=0.4))
    for one in numbered(p.places, 8 / scale, box):
        if one.leader is not None:
            drawing.add(PolyLine([*at(one.leader[0]), *at(one.leader[1])], strokeColor=colors.HexColor(WRONG), strokeWidth=0.3))
        drawing.add(String(*at(one.at), one.text, fontName=FONT, fontSize=9, fillColor=colors.HexColor(WRONG)))
    return drawing
