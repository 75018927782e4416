"""The note for Word: styles, fields, equations as OMML, the frame in the header, stamps in the footer."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from functools import singledispatchmethod
from itertools import accumulate, count, pairwise
from time import localtime, time
from typing import Any
from xml.sax.saxutils import escape

import docx
from docx.enum.section import WD_SECTION
from docx.enum.table import WD_CELL_VERTICAL_ALIGNMENT, WD_TABLE_ALIGNMENT
from docx.enum.text import WD_ALIGN_PARAGRAPH, WD_TAB_ALIGNMENT, WD_TAB_LEADER
from docx.opc.packuri import PackURI
from docx.opc.part import Part
from docx.oxml import parse_xml
from docx.oxml.ns import qn
from docx.shared import Mm, Pt, RGBColor

from tmm_sheets import files
from tmm_sheets.construction.formula import Node
from tmm_sheets.errors import CannotBuild
from tmm_sheets.note.alphabets import characters, equation
from tmm_sheets.note.arranging import sticky
from tmm_sheets.note.document import (
    Block,
    Contents,
    Figure,
    Formula,
    Heading,
    NewPage,
    Note,
    NumberedTable,
    Paragraph,
    Reference,
    Sheet,
    Symbol,
    Text,
    Where,
    plain_text,
)
from tmm_sheets.note.typst_writer import rasters
from tmm_sheets.words import tell

DPI = 220
"""Resolution of the pictures beside their vectors, for programs that do not show these."""
TEXT = 175.0
"""Width of the text, mm; what is wider stands out of it on both sides."""
WIDE, LEADING = 0.2, 0.42
"""About how wide a letter is and how high a line, mm for each point of its size."""
PROPERTY = 255
"""Signs that a property of a document may have; the pages say the whole."""
FIRST = datetime(1980, 1, 1)
FONT = "Times New Roman"
SIZES = {"Normal": 11, "Heading 1": 14, "Heading 2": 13, "Caption": 11, "TOC Heading": 15}
"""Styles of the document, and the sizes of their letters, pt."""
CENTRE, RIGHT, JUSTIFIED = WD_ALIGN_PARAGRAPH.CENTER, WD_ALIGN_PARAGRAPH.RIGHT, WD_ALIGN_PARAGRAPH.JUSTIFY
LOOKS: dict[str, dict[str, Any]] = {
    "Normal": {"space_after": Pt(0), "line_spacing": 0.88},
    "Heading 1": {"page_break_before": True, "alignment": CENTRE, "space_after": Pt(10), "keep_with_next": True},
    "Heading 2": {"first_line_indent": Mm(10), "space_before": Pt(11), "space_after": Pt(5), "keep_with_next": True},
    "plain": {"alignment": JUSTIFIED, "first_line_indent": Mm(10)},
    "item": {"alignment": JUSTIFIED, "left_indent": Mm(10)},
    "centre": {"alignment": CENTRE},
    "right": {"alignment": RIGHT},
    "person": {"left_indent": Mm(85)},
    # A spacing of anything less cuts the foot of a fraction and the top of a picture off.
    "formula": {"line_spacing": 1.0, "space_before": Pt(2), "space_after": Pt(2)},
    "picture": {"alignment": CENTRE, "keep_with_next": True, "line_spacing": 1.0},
    "where": {"left_indent": Mm(25), "first_line_indent": Mm(-25)},
    "table": {"alignment": RIGHT, "keep_with_next": True, "space_before": Pt(8)},
    "title": {"alignment": CENTRE, "keep_with_next": True},
    "continued": {"alignment": RIGHT, "page_break_before": True, "keep_with_next": True},
    "contents": {},
    "after": {"line_spacing": Pt(6)},
    "figure": {"alignment": CENTRE, "space_after": Pt(8)},
}
"""Styles and kinds of paragraphs: properties of their format."""
HEADS = ("izm", "list", "doc", "sign", "date")
STAMPS: dict[str, tuple[tuple[int, ...], tuple[tuple[str, ...], ...], tuple[tuple[int, int, int, int], ...]]] = {
    "2a": (
        (7, 10, 23, 15, 10, 110, 10),
        (("", "", "", "", "", "designation", "list"), ("", "", "", "", "", "", "PAGE"), (*HEADS, "", "")),
        ((0, 5, 2, 5), (1, 6, 2, 6)),
    ),
    "2": (
        (7, 10, 23, 15, 10, 70, 15, 15, 20),
        (
            ("", "", "", "", "", "designation", "", "", ""),
            ("", "", "", "", "", "", "", "", ""),
            (*HEADS, "", "", "", ""),
            ("developed", "", "student", "", "", "subject", "letter-head", "list", "lists"),
            ("checked", "", "checker", "", "", "", "letter", "PAGE", "pages"),
            ("head", "", "supervisor", "", "", "", "owner", "", ""),
            ("norm", "", "", "", "", "", "", "", ""),
            ("approved", "", "", "", "", "", "", "", ""),
        ),
        ((0, 5, 2, 8), (3, 5, 7, 5), (5, 6, 7, 8), *((i, 0, i, 1) for i in range(3, 8))),
    ),
}
"""Forms 2a and 2 (GOST 2.104): widths of the columns, mm, what stands in rows of 5 mm, cells that are one from corner to corner."""
ROW = 5
_NAMESPACES = {
    "w": "http://schemas.openxmlformats.org/wordprocessingml/2006/main",
    "mc": "http://schemas.openxmlformats.org/markup-compatibility/2006",
    "wp": "http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing",
    "a": "http://schemas.openxmlformats.org/drawingml/2006/main",
    "wps": "http://schemas.microsoft.com/office/word/2010/wordprocessingShape",
    "r": "http://schemas.openxmlformats.org/officeDocument/2006/relationships",
}
_SVG, _SVG_URI = "http://schemas.microsoft.com/office/drawing/2016/SVG/main", "{96DAC541-7B7A-43D3-8B79-37D633B846F1}"
_TABLE_PROPERTIES = ("tblStyle", "tblpPr", "tblOverlap", "bidiVisual", "tblStyleRowBandSize", "tblStyleColBandSize", "tblW", "jc",
                     "tblCellSpacing", "tblInd", "tblBorders", "shd", "tblLayout", "tblCellMar", "tblLook")  # fmt: skip
"""Properties of a table in the order of the schema."""


def render(note: Note, places: dict[str, Any]) -> bytes:
    """The DOCX file, its contents with the pages of the PDF; the same note gives the same bytes."""
    if localtime(time()).tm_year < FIRST.year:
        said = tell("the clock of this machine stands before {year}: a DOCX file cannot be made")
        raise CannotBuild(said.format(year=FIRST.year), tell("set it right, or write the note as PDF"))
    made = _Writer(note, places).document()
    raw = io.BytesIO()
    made.save(raw)
    return _with_fixed_dates(raw.getvalue())


def _with_fixed_dates(data: bytes) -> bytes:
    """The same archive with fixed dates; "[Content_Types].xml", which has to be the first, is the first of the sorted names."""
    with zipfile.ZipFile(io.BytesIO(data)) as old:
        return files.zipped({name: old.read(name) for name in sorted(old.namelist())})


class _Writer:
    """Writes the blocks one after another into a document of python-docx."""

    def __init__(self, note: Note, places: dict[str, Any]) -> None:
        self.note, self.places = note, places
        self.made = docx.Document()
        self.ids = count(1)
        titles = ((b.level, b.said) if isinstance(b, Heading) else (1, f"{note.title_page['appendix']} {b.number}. {b.title}")
                  for b in note.blocks() if isinstance(b, Heading | Sheet))
        self.headings = [(level, said, f"_Toc{i:04}") for i, (level, said) in enumerate(titles)]
        owner = f"{note.frame.fields.get('institution', '')} {note.frame.fields.get('group', '')}".strip()
        self.words = note.frame.words | note.frame.fields | {"pages": str(places["pages"]), "owner": owner}
        self.pictures = rasters(note.blocks(), DPI)
        self.seen = 0
        self.last: Any = None
        """the last paragraph of the block that is written, where it may have to stay with the next"""
        self._styles()
        props = self.made.core_properties
        props.title, props.author, props.last_modified_by, props.comments = (
            note.title[:PROPERTY], note.author[:PROPERTY], note.author[:PROPERTY], "")
        props.created = props.modified = FIRST
        props.language = note.language

    def _styles(self) -> None:
        for style in (style for style in self.made.styles if style.name in SIZES):
            style.font.name, style.font.size = FONT, Pt(SIZES[style.name])
            fonts = style.element.get_or_add_rPr().get_or_add_rFonts()
            for key in ("w:asciiTheme", "w:hAnsiTheme", "w:eastAsiaTheme", "w:cstheme"):
                fonts.attrib.pop(qn(key), None)
            for key in ("w:cs", "w:ascii", "w:hAnsi"):
                fonts.set(qn(key), FONT)
            style.font.bold = style.name.startswith(("Heading", "TOC"))
            style.font.italic = False
            style.font.color.rgb = RGBColor(0, 0, 0)
            _formatted(style, **LOOKS.get(style.name, {}))

    def paragraph(self, look: str, text: str = "", style: str | None = None, tabs: Sequence[Sequence[Any]] = (),
                  **more: Any) -> Any:
        """A paragraph of a look, tabs with their places and what they need more, and with some properties of its own."""
        p = self.made.add_paragraph(text, style)
        _formatted(p, **LOOKS[look], **more)
        for tab in tabs:
            p.paragraph_format.tab_stops.add_tab_stop(*tab)
        return p

    def document(self) -> Any:
        """The whole document."""
        note = self.note
        self._page(self.made.sections[0])
        self._title_page()
        if not isinstance(note.front[0], Contents):
            self._section("2a", first=True)
        blocks = list(note.blocks())
        for b, after in zip(blocks, [*blocks[1:], None], strict=True):
            if isinstance(b, Contents):
                self._section("2")
                self.block(b)
                self._section("2a", first=True)
                continue
            self._framed(b)
            self.last = None
            self.block(b)
            if self.last is not None and after is not None and sticky(b, after):
                self.last.paragraph_format.keep_with_next = True
        return self.made

    # --- pages

    def _page(self, section: Any, bottom: float = 23) -> None:
        section.page_width, section.page_height = Mm(210), Mm(297)
        section.left_margin, section.right_margin = Mm(25), Mm(10)
        section.top_margin, section.bottom_margin = Mm(11), Mm(bottom)
        section.header_distance, section.footer_distance = Mm(5), Mm(5)

    def _framed(self, b: Block) -> None:
        """Begin a section where what begins a page has a frame and what was before had none, or the other way round."""
        if not (isinstance(b, Sheet) or (isinstance(b, Heading) and b.level == 1)):
            return
        pages, last = self.places["headings"], int(self.places["pages"])
        after = (page for (level, *_), page in zip(self.headings[self.seen + 1:], pages[self.seen + 1:], strict=True) if level == 1)
        wanted = self.note.frame.on(pages[self.seen], next(after, last + 1) - 1, last)
        if wanted != bool(self.form):
            self._section("2a" if wanted else "", first=True)

    def _section(self, form: str, first: bool = False) -> None:
        """A new section with the frame in its header and a stamp in its footer, or without both where there is no ``form``.

        ``first``: its first heading begins no page of its own.
        """
        section = self.made.add_section(WD_SECTION.NEW_PAGE)
        self._page(section, 48 if form == "2" else 23)
        section.header.is_linked_to_previous = section.footer.is_linked_to_previous = False
        if form:
            self._frame(section.header.paragraphs[0])
            self._stamp(section.footer, form)
        self.form = form
        self.fresh = first

    def _frame(self, paragraph: Any) -> None:
        """The frame: a rectangle 185 x 287 mm, 20 mm from the left edge and 5 mm from the others, behind the text."""
        emu = 36000
        width, height = 185 * emu, 287 * emu
        paragraph._p.append(_parsed(
            '<w:r><mc:AlternateContent><mc:Choice Requires="wps"><w:drawing>'
            '<wp:anchor distT="0" distB="0" distL="0" distR="0" simplePos="0" relativeHeight="1" behindDoc="1" locked="1" '
            'layoutInCell="0" allowOverlap="1"><wp:simplePos x="0" y="0"/>'
            f'<wp:positionH relativeFrom="page"><wp:posOffset>{20 * emu}</wp:posOffset></wp:positionH>'
            f'<wp:positionV relativeFrom="page"><wp:posOffset>{5 * emu}</wp:posOffset></wp:positionV>'
            f'<wp:extent cx="{width}" cy="{height}"/><wp:effectExtent l="0" t="0" r="0" b="0"/><wp:wrapNone/>'
            f'<wp:docPr id="{900 + next(self.ids)}" name="frame"/><wp:cNvGraphicFramePr/>'
            f'<a:graphic><a:graphicData uri="{_NAMESPACES["wps"]}"><wps:wsp>'
            f'<wps:cNvSpPr/><wps:spPr><a:xfrm><a:off x="0" y="0"/><a:ext cx="{width}" cy="{height}"/></a:xfrm>'
            '<a:prstGeom prst="rect"><a:avLst/></a:prstGeom><a:noFill/><a:ln w="17780"><a:solidFill><a:srgbClr val="000000"/>'
            "</a:solidFill></a:ln></wps:spPr><wps:bodyPr/></wps:wsp></a:graphicData></a:graphic></wp:anchor></w:drawing></mc:Choice>"
            "</mc:AlternateContent></w:r>"
        ))  # fmt: skip

    def _stamp(self, footer: Any, form: str) -> None:
        """Form 2a or 2 as a table at the foot of the page."""
        widths, names, merges = STAMPS[form]
        table = footer.add_table(len(names), len(widths), Mm(185))
        table.autofit = False
        sides = (("top", 12), ("left", 12), ("bottom", 12), ("right", 12), ("insideH", 4), ("insideV", 8))
        borders = "".join(f'<w:{s} w:val="single" w:sz="{size}" w:space="0" w:color="000000"/>' for s, size in sides)
        _set_properties(
            table, '<w:tblInd w:w="-283" w:type="dxa"/>', f"<w:tblBorders>{borders}</w:tblBorders>",
            '<w:tblCellMar><w:left w:w="20" w:type="dxa"/><w:right w:w="20" w:type="dxa"/></w:tblCellMar>')  # fmt: skip
        for column, width in zip(table.columns, widths, strict=True):
            column.width = Mm(width)
        for row, cells in zip(table.rows, names, strict=True):
            row._tr.get_or_add_trPr().append(_parsed(f'<w:trHeight w:val="{round(ROW * 56.693)}" w:hRule="exact"/>'))
            for cell, name, width in zip(row.cells, cells, widths, strict=True):
                self._cell(cell, name, 7, width)
        for r0, c0, r1, c1 in merges:
            name = next(names[r][c] for r in range(r0, r1 + 1) for c in range(c0, c1 + 1) if names[r][c])
            merged = table.cell(r0, c0).merge(table.cell(r1, c1))
            for p in merged.paragraphs[1:]:
                p._p.getparent().remove(p._p)
            merged.paragraphs[0].clear()
            self._cell(merged, name, 14 if name == "designation" else 8, sum(widths[c0:c1 + 1]), ROW * (r1 + 1 - r0))
        empty = footer.paragraphs[0]
        empty._p.getparent().remove(empty._p)
        footer.add_paragraph().paragraph_format.line_spacing = Pt(1)

    def _cell(self, cell: Any, name: str, size: float, width: float, height: float = ROW) -> None:
        """Lettering of a stamp, set narrower where it is too long for its cell, mm."""
        cell.vertical_alignment = WD_CELL_VERTICAL_ALIGNMENT.CENTER
        p, text = cell.paragraphs[0], self.words.get(name, "")
        p.alignment = CENTRE
        if name == "PAGE":
            _field(p, "PAGE", "1").font.size = Pt(size + 2)
        elif text:
            run = p.add_run(text)
            run.font.size = Pt(size)
            lines, longest = max(1, int(height / (LEADING * size))), max(map(len, text.split()))
            widest = max(longest, len(text) / lines + (longest / 2 if lines > 1 else 0))
            share = (width - 1.0) / (WIDE * size * widest)
            if share < 1:
                run._r.get_or_add_rPr().append(_parsed(f'<w:w w:val="{max(10, int(100 * share))}"/>'))

    def _title_page(self) -> None:
        t = self.note.title_page
        for name, size, before in (("ministry", 14, 0), ("institution", 14, 0), ("kind", 18, 150), ("course", 14, 12),
                                   ("theme", 14, 8), ("designation", 14, 16)):  # fmt: skip
            self._title_line(t[name], size, before, name == "kind")
        for i, (role, name) in enumerate(zip(t["people"], t["names"], strict=True)):
            self.paragraph("person", f"{role}  {name or '____________________'}", space_before=Pt(8 if i else 110))
        self._title_line(t["place"], 14, 100)

    def _title_line(self, text: str, size: float, before: float, bold: bool = False) -> None:
        run = self.paragraph("centre", space_before=Pt(before)).add_run(text)
        run.font.size, run.font.bold = Pt(size), bold

    # --- blocks

    @singledispatchmethod
    def block(self, b: Block) -> None:
        """One block, of whatever kind."""
        raise TypeError(f"no block of a note: {b!r}")

    @contextmanager
    def _bookmark(self, p: Any, name: str) -> Iterator[None]:
        """What is written meanwhile lies between the ends of a bookmark."""
        number = next(self.ids)
        p._p.append(_parsed(f'<w:bookmarkStart w:id="{number}" w:name="{name}"/>'))
        yield
        p._p.append(_parsed(f'<w:bookmarkEnd w:id="{number}"/>'))

    def _begun(self, level: int, text: str) -> Any:
        """A heading that the contents lead to."""
        p = self.made.add_heading("", level)
        if self.fresh and level == 1:
            p.paragraph_format.page_break_before = False
        self.fresh = False
        with self._bookmark(p, self.headings[self.seen][2]):
            p.add_run(text)
        self.seen += 1
        return p

    @block.register
    def _heading(self, b: Heading) -> None:
        self._begun(b.level, b.said)

    @block.register
    def _paragraph(self, b: Paragraph) -> None:
        self.last = self.paragraph(b.look)
        self._text(self.last, b.text)

    def _text(self, p: Any, text: Text) -> None:
        for x in text:
            if isinstance(x, Symbol):
                _math(p, x.node)
            elif isinstance(x, Reference) and x.target:
                _field(p, f"REF {mark_of(x.target)} \\h", x.text)
            else:
                p.add_run(str(x))

    @block.register
    def _formula(self, b: Formula) -> None:
        tabs = (Mm(84), WD_TAB_ALIGNMENT.CENTER), (Mm(175), WD_TAB_ALIGNMENT.RIGHT)
        for i, node in enumerate(b.lines, 1):
            self.last = p = self.paragraph("formula", tabs=tabs, keep_with_next=i < len(b.lines))
            p.add_run("\t")
            _math(p, node)
            if b.number and i == len(b.lines):
                p.add_run("\t")
                with self._bookmark(p, mark_of(f"formula:{b.number.strip('()')}")):
                    p.add_run(b.number)

    @block.register
    def _where(self, b: Where) -> None:
        for i, row in enumerate(b.rows):
            p = self.paragraph("where", tabs=((Mm(10),),))
            p.add_run((b.word if not i else "") + "\t")
            _math(p, row.symbol)
            end = "." if i == len(b.rows) - 1 else ";"
            self._text(p, (" – ", *row.meaning, f", {row.unit}{end}" if row.unit else end))

    @block.register
    def _table(self, b: NumberedTable) -> None:
        self._numbered(self.paragraph("table", style="Caption"), self.note.title_page["table"], b.number, "table")
        self.paragraph("title", b.title)
        for start, end in pairwise(accumulate(b.parts or (len(b.rows) - 1,), initial=1)):
            if start > 1:
                self.paragraph("continued", self.note.title_page["continued"].format(n=b.number))
            self._grid(b, [b.rows[0], *b.rows[start:end]])
        self.paragraph("after")

    def _grid(self, b: NumberedTable, rows: Sequence[Sequence[Text]]) -> None:
        """Rows of a table, which stay on one page, in cells as wide as all its rows want them."""
        widths = widths_of(b)
        table = self.made.add_table(len(rows), len(widths), style="Table Grid")
        table.alignment = WD_TABLE_ALIGNMENT.CENTER
        size = Pt(9 if len(widths) > 8 else 10 if len(widths) > 6 else 11)
        table.autofit = False
        for column, width in zip(table.columns, widths, strict=True):
            column.width = Mm(width)
        for i, (row, cells) in enumerate(zip(table.rows, rows, strict=True)):
            for j, (cell, text) in enumerate(zip(row.cells, cells, strict=True)):
                q = cell.paragraphs[0]
                aligned = WD_ALIGN_PARAGRAPH.LEFT if b.worded and i and not j else CENTRE
                _formatted(q, alignment=aligned, keep_with_next=i < len(rows) - 1)
                self._text(q, text)
                for run in q.runs:
                    run.font.size = size
        table.rows[0]._tr.get_or_add_trPr().append(_parsed("<w:tblHeader/>"))  # it stands on each of its pages

    def _numbered(self, p: Any, word: str, number: str, kind: str) -> None:
        """A caption: word, number of the section, and a counting field; the number is what references point to."""
        p.add_run(f"{word}\u00a0")
        section, _, nth = number.rpartition(".")
        with self._bookmark(p, mark_of(f"{kind}:{number}")):
            if section:
                p.add_run(f"{section}.")
            _field(p, f"SEQ {kind}{section or 0} \\* ARABIC", nth)

    @block.register
    def _figure(self, b: Figure) -> None:
        self._picture(b)
        p, word = self.paragraph("figure", style="Caption"), self.note.title_page["figure"]
        if b.further:
            p.add_run(f"{word}\u00a0{b.number}{self.note.title_page['part'].format(n=b.part)}")
        else:
            self._numbered(p, word, b.number, "figure")
            p.add_run(f". {b.title}")

    def _picture(self, b: Figure | Sheet) -> None:
        """The picture, and unless it is turned the drawing itself beside it, for programs that show SVG."""
        width, height = reversed(b.on_page) if b.turned else b.on_page
        p = self.paragraph("picture")
        if width > TEXT:
            p.paragraph_format.left_indent = p.paragraph_format.right_indent = Mm((TEXT - width) / 2)
        shape = p.add_run().add_picture(io.BytesIO(self.pictures[b.file]), width=Mm(width), height=Mm(height))
        if b.turned:
            return
        part = Part(PackURI(f"/word/media/{b.file}.svg"), "image/svg+xml", b.svg, self.made.part.package)
        relation = self.made.part.relate_to(part, f"{_NAMESPACES['r']}/image")
        blip = shape._inline.graphic.graphicData.pic.blipFill.find(qn("a:blip"))
        blip.append(_parsed(f'<a:extLst><a:ext uri="{_SVG_URI}">'
                            f'<asvg:svgBlip xmlns:asvg="{_SVG}" r:embed="{relation}"/></a:ext></a:extLst>'))  # fmt: skip

    @block.register
    def _sheet(self, b: Sheet) -> None:
        self._begun(1, f"{self.note.title_page['appendix']} {b.number}".upper()).paragraph_format.space_after = Pt(2)
        self.paragraph("centre", b.title)
        self._picture(b)

    @block.register
    def _newpage(self, b: NewPage) -> None:
        self.made.add_paragraph().paragraph_format.page_break_before = True

    @block.register
    def _contents(self, b: Contents) -> None:
        run = self.paragraph("centre").add_run(b.title)
        run.font.bold, run.font.size = True, Pt(15)
        dots, size = (Mm(174), WD_TAB_ALIGNMENT.RIGHT, WD_TAB_LEADER.DOTS), '<w:rPr><w:sz w:val="23"/></w:rPr>'
        p = None
        for (level, text, mark), page in zip(self.headings, self.places["headings"], strict=True):
            begun = "" if p is not None else _begun_field('TOC \\o "1-2" \\h \\z')
            page_of = _begun_field(f"PAGEREF {mark} \\h")
            p = self.paragraph("contents", tabs=(dots,), left_indent=Mm(6 * (level - 1)))
            _append(p, f'{begun}<w:hyperlink w:anchor="{mark}" w:history="1">'
                       f'<w:r>{size}<w:t xml:space="preserve">{escape(text)}</w:t></w:r><w:r><w:tab/></w:r>'
                       f"{page_of}<w:r>{size}<w:t>{page}</w:t></w:r>{_END}</w:hyperlink>")  # fmt: skip
        if p is not None:
            _append(p, _END)


def widths_of(b: NumberedTable) -> list[float]:
    """Widths of the columns of a table, mm, by what stands in them; together at most that of the text."""
    def size(text: Text) -> float:
        return len(plain_text(text)) + sum(characters(x.node) for x in text if isinstance(x, Symbol))

    columns = max(map(len, b.rows))
    wanted = [6.0 + 2.1 * min(max(size(row[i]) for row in b.rows if i < len(row)), 40) for i in range(columns)]
    return [w * min(1.0, 174.0 / sum(wanted)) for w in wanted]


def mark_of(target: str) -> str:
    """Name of the bookmark of a figure, table or formula by its number."""
    return "n_" + target.replace(":", "_").replace(".", "_")


def _parsed(xml: str) -> Any:
    """An element, with the namespaces of the prefixes in it."""
    used = (f'xmlns:{prefix}="{uri}"' for prefix, uri in _NAMESPACES.items() if re.search(rf"[</ ]{prefix}:", xml))
    return parse_xml(re.sub(r"^<[\w:]+", lambda m: " ".join((m[0], *used)), xml))


def _append(p: Any, xml: str) -> None:
    """Put elements at the end of a paragraph."""
    for element in list(_parsed(f"<w:p>{xml}</w:p>")):
        p._p.append(element)


def _formatted(of: Any, **properties: Any) -> None:
    """Set properties of the format of a paragraph or of a style."""
    for name, value in properties.items():
        setattr(of.paragraph_format, name, value)


def _math(p: Any, node: Node) -> None:
    p._p.append(parse_xml(equation(node)))


_END = '<w:r><w:fldChar w:fldCharType="end"/></w:r>'
"""End of a field."""


def _begun_field(instruction: str) -> str:
    """What stands before the text of a field."""
    return ('<w:r><w:fldChar w:fldCharType="begin"/></w:r>'
            f'<w:r><w:instrText xml:space="preserve"> {escape(instruction)} </w:instrText></w:r>'
            '<w:r><w:fldChar w:fldCharType="separate"/></w:r>')  # fmt: skip


def _field(p: Any, instruction: str, text: str) -> Any:
    """A field; what it shows until it is updated."""
    _append(p, _begun_field(instruction))
    run = p.add_run(text)
    _append(p, _END)
    return run


def _set_properties(table: Any, *made: str) -> None:
    """Properties of a table, in the order of the schema."""
    properties = table._tbl.tblPr
    for new in map(_parsed, made):
        for old in properties.findall(new.tag):
            properties.remove(old)
        properties.append(new)
    properties[:] = sorted(properties, key=lambda e: _TABLE_PROPERTIES.index(e.tag.partition("}")[2]))
