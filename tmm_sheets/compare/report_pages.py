"""A report as one self-contained page for a browser (no script, no other file), or as a PDF of A4 pages set by reportlab."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from io import BytesIO
from itertools import zip_longest
from typing import Any
from urllib.parse import quote

from reportlab.graphics import renderSVG
from reportlab.graphics.shapes import Circle, Drawing, Image, Path, PolyLine, String
from reportlab.lib import colors
from reportlab.lib.pagesizes import A4
from reportlab.lib.styles import ParagraphStyle
from reportlab.lib.units import mm
from reportlab.pdfbase import pdfmetrics
from reportlab.pdfbase.ttfonts import TTFont
from reportlab.platypus import KeepTogether, LongTable, Paragraph, SimpleDocTemplate, Spacer, TableStyle

from tmm_sheets.backends.pdf import CREATOR, FONT
from tmm_sheets.compare.findings import Report, Story, StoryPicture, StoryTable, ToldMistake, clipped
from tmm_sheets.compare.overlays import numbered
from tmm_sheets.drawing.marks import Points
from tmm_sheets.resources import template
from tmm_sheets.words import reader, tell

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.45 system-ui, sans-serif; color: #1c1c1c; max-width: 1100px; margin: 1.5rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin: 0 0 .4rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .6rem; border-bottom: 1px solid #bbb; }
p, li { margin: .2rem 0; } .about { color: #444; }
article { display: flex; flex-wrap: wrap; gap: 1rem; border-left: 5px solid #c00; background: #fafafa; }
article { margin: .8rem 0; padding: .6rem 1rem; }
article.amber { border-color: #e58a00; } article div { flex: 1 1 22rem; } article h3 { font-size: 1rem; margin: 0; }
article .where { color: #555; } svg { background: #fff; border: 1px solid #ddd; flex: 0 1 auto; max-width: 100%; height: auto; }
svg text { font: 11px system-ui, sans-serif !important; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; margin: .4rem 0; font-size: .88rem; }
th, td { border: 1px solid #ccc; padding: .15rem .5rem; text-align: left; vertical-align: top; } th { background: #eee; }
tr.red td { background: #fde4e4; } tr.amber td { background: #fff3dc; }
.key span { display: inline-block; width: 1.6em; height: 0; border-top: 3px solid; vertical-align: middle; margin: 0 .3em 0 1em; }
@media print { article { break-inside: avoid; } }
"""
OURS, THEIRS, WRONG = "#0072b2", "#737373", "#d00000"
"""Colours of the exact lines, the drawn ones, and what is wrong."""


def html(story: Story, folder: str = ".") -> bytes:
    """The page, UTF-8; ``folder`` is where from it the pages are that its tables lead to."""
    body = "\n".join(_parts(story, folder))
    return (f'<!DOCTYPE html>\n<html lang="{reader()}">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{escape(story.title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n").encode()


def _parts(story: Story, folder: str) -> Iterator[str]:
    yield f"<h1>{escape(story.title)}</h1>"
    yield from (f'<p class="about">{escape(line)}</p>' for line in story.about)
    if story.mistakes:
        yield f"<h2>{escape(tell('What is wrong'))}</h2>"
        if any(m.picture is not None for m in story.mistakes):
            key = ((OURS, tell("exact")), (THEIRS, tell("drawn")), (WRONG, tell("wrong")))
            yield '<p class="key">' + "".join(f'<span style="border-color:{c}"></span>{escape(said)}' for c, said in key) + "</p>"
        yield from map(_html_mistake, story.mistakes)
    yield from (_html_table(table, folder) for table in story.tables)
    if story.unjudged:
        yield f"<h2>{escape(tell('What could not be judged, and why'))}</h2>\n<ul>"
        yield from (f"<li>{escape(line)}</li>" for line in story.unjudged)
        yield "</ul>"


def _html_mistake(m: ToldMistake) -> str:
    details = "".join(f"<li>{escape(line)}</li>" for line in m.details)
    said = (f'<div><p class="where">{escape(m.where)}</p><h3>{escape(m.again or m.what)}</h3>'
            + (f"<ul>{details}</ul>" if details else "") + "</div>")
    return f'<article class="{m.verdict}">{said}{_html_picture(m.picture) if m.picture is not None else ""}</article>'


def _html_table(table: StoryTable, folder: str) -> str:
    head = "".join(f"<th>{escape(c)}</th>" for c in table.head)
    rows = "\n".join((f'<tr class="{verdict}">' if verdict else "<tr>") + "".join(
        f'<td><a href="{escape(quote(f"{folder}/{page}"))}">{escape(c)}</a></td>' if page and k == 1 else f"<td>{escape(c)}</td>"
        for k, c in enumerate(row)) + "</tr>" for row, verdict, page in zip_longest(table.rows, table.verdicts, table.pages))
    return (f"<h2>{escape(table.title)}</h2>\n<div class=\"scroll\"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n"
            "</tbody></table></div>")


def _html_picture(p: StoryPicture) -> str:
    svg = renderSVG.drawToString(_picture(p))
    return str(svg[svg.index("<svg"):])


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
    yield Paragraph(_printable(story.title), TITLE)
    yield from (Paragraph(_printable(line), TEXT) for line in story.about)
    if story.mistakes:
        yield Paragraph(_printable(tell("What is wrong")), HEAD)
        if any(m.picture is not None for m in story.mistakes):
            key = ((OURS, tell("exact")), (THEIRS, tell("drawn")), (WRONG, tell("wrong")))
            yield Paragraph(" &nbsp; ".join(f'<font color="{c}">— {_printable(said)}</font>' for c, said in key), SMALL)
        yield from map(_mistake, story.mistakes)
    for table in story.tables:
        yield Paragraph(_printable(table.title), HEAD)
        yield _table(table)
    if story.unjudged:
        yield Paragraph(_printable(tell("What could not be judged, and why")), HEAD)
        yield from (Paragraph("– " + _printable(line), TEXT) for line in story.unjudged)


def _printable(text: str) -> str:
    """A text with the letters the font has; others become a question mark rather than nothing."""
    face = pdfmetrics.getFont(FONT).face
    return escape("".join(c if ord(c) in face.charToGlyph or c == "\n" else _LIKE.get(c, "?") for c in text), quote=False)


_LIKE = {"\u0305": "", "\u0304": "", "\u202f": " ", "\xa0": " ", "…": "...", "‑": "-", "−": "-", "“": '"', "”": '"', "„": '"'}


def _mistake(m: ToldMistake) -> Any:
    what = _printable(m.again or m.what)
    parts: list[Any] = [Spacer(0, 5), Paragraph(_printable(m.where), WHERE),
                        Paragraph(f'<font color="{SIDES[m.verdict].hexval().replace("0x", "#")}">■</font> {what}'
                                  if ord("■") in pdfmetrics.getFont(FONT).face.charToGlyph else what, TEXT)]
    parts += [Paragraph("– " + _printable(line), SMALL) for line in m.details]
    if m.picture is not None:
        parts += [Spacer(0, 3), _picture(m.picture)]
    return KeepTogether(parts)


def _table(table: StoryTable) -> Any:
    cells = [[Paragraph(_printable(c), SMALL) for c in row] for row in (table.head, *table.rows)]
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
        path = Path(strokeColor=colors.HexColor(colour), strokeWidth=width, fillColor=None)
        for first, *others in (z.tolist() for z in clipped(lines, box)):
            path.moveTo(*at(first))
            for point in others:
                path.lineTo(*at(point))
        drawing.add(path)

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


SUFFIXES = (".html", ".pdf")


def page(report: Report, suffix: str, title: str, folder: str = ".") -> bytes:
    """The report as a file of one of :data:`SUFFIXES`; ``title`` stands over one that has only a text.

    ``folder`` is where, seen from the file, the report's other files are.
    """
    told = report.story or Story(title, tuple(report.text.splitlines()))
    return pdf(told) if suffix == ".pdf" else html(told, folder)
