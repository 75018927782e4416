"""The note for Word: styles, fields, equations as OMML, the frame in the header, stamps in the footer."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from datetime import datetime
from functools import singledispatchmethod
from itertools import accumulate, count, pairwise
from typing import Any
from xml.sax.saxutils import escape

from tmm_sheets.construction.formula import Node
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
)
from tmm_sheets.note.typst_writer import rasters

DPI = 220
"""Resolution of the pictures beside their vectors, for programs that do not show these."""
TEXT = 175.0
"""Width of the text, mm; what is wider stands out of it on both sides."""
WIDE, LEADING = 0.2, 0.42
"""About how wide a letter is and how high a line, mm for each point of its size."""
PROPERTY = 255
"""Signs that a property of a document may have; the pages say the whole."""
FIRST = datetime(1980, 1, 1)
_W = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
_SVG = "http://schemas.microsoft.com/office/drawing/2016/SVG/main"
_SVG_URI = "{96DAC541-7B7A-43D3-8B79-37D633B846F1}"


def render(note: Note, places: dict[str, Any]) -> bytes:
    """The DOCX file, its contents with the pages of the PDF; the same note gives the same bytes."""
    made = _Writer(note, places).document()
    raw = io.BytesIO()
    made.save(raw)
    return _settled(raw.getvalue())


def _settled(data: bytes) -> bytes:
    """The same archive with fixed dates."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
        for name in sorted(old.namelist(), key=lambda n: (n != "[Content_Types].xml", n)):
            info = zipfile.ZipInfo(name, FIRST.timetuple()[:6])
            info.compress_type = zipfile.ZIP_DEFLATED
            new.writestr(info, old.read(name))
    return out.getvalue()


class _Writer:
    """Writes the blocks one after another into a document of python-docx."""

    def __init__(self, note: Note, places: dict[str, Any]) -> None:
        import docx
        from docx.shared import Mm, Pt

        self.note, self.places = note, places
        self.mm, self.pt = Mm, Pt
        self.made = docx.Document()
        self.ids = count(1)
        self.headings: list[tuple[int, str, str]] = []
        self.words = note.frame.words | note.frame.fields
        self.pictures = rasters(note.blocks(), DPI)
        self.seen = 0
        self.last: Any = None
        """the last paragraph of the block that is written, where it may have to stay with the next"""
        self._styles()
        props = self.made.core_properties
        title, author = note.title[:PROPERTY], note.author[:PROPERTY]
        props.title, props.author, props.last_modified_by, props.comments = title, author, author, ""
        props.created = props.modified = FIRST
        props.language = note.language

    def _styles(self) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH
        from docx.oxml.ns import qn

        for name, size in (("Normal", 11), ("Heading 1", 14), ("Heading 2", 13), ("Caption", 11), ("TOC Heading", 15)):
            if name not in [s.name for s in self.made.styles]:
                continue
            style: Any = self.made.styles[name]
            style.font.name, style.font.size = "Times New Roman", self.pt(size)
            style.element.get_or_add_rPr().get_or_add_rFonts().set(qn("w:cs"), "Times New Roman")
            fonts = style.element.rPr.rFonts
            for key in ("w:asciiTheme", "w:hAnsiTheme", "w:eastAsiaTheme", "w:cstheme"):
                if fonts.get(qn(key)) is not None:
                    del fonts.attrib[qn(key)]
            fonts.set(qn("w:ascii"), "Times New Roman")
            fonts.set(qn("w:hAnsi"), "Times New Roman")
            style.font.bold = name.startswith(("Heading", "TOC"))
            style.font.italic = False
            style.font.color.rgb = None
            from docx.shared import RGBColor

            style.font.color.rgb = RGBColor(0, 0, 0)
        normal: Any = self.made.styles["Normal"]
        normal.paragraph_format.space_after = self.pt(0)
        normal.paragraph_format.line_spacing = 0.88
        first: Any = self.made.styles["Heading 1"]
        first.paragraph_format.page_break_before = True
        first.paragraph_format.alignment = WD_ALIGN_PARAGRAPH.CENTER
        first.paragraph_format.space_after = self.pt(10)
        second: Any = self.made.styles["Heading 2"]
        second.paragraph_format.first_line_indent = self.mm(10)
        second.paragraph_format.space_before, second.paragraph_format.space_after = self.pt(11), self.pt(5)
        for style in (first, second):
            style.paragraph_format.keep_with_next = True

    def document(self) -> Any:
        """The whole document."""
        from docx.enum.section import WD_SECTION

        note = self.note
        for b in note.blocks():
            if isinstance(b, Heading):
                self.headings.append((b.level, f"{b.number}  {b.text}".strip(), f"_Toc{len(self.headings):04}"))
            elif isinstance(b, Sheet):
                self.headings.append((1, f"{note.title_page['appendix']} {b.number}. {b.title}", f"_Toc{len(self.headings):04}"))
        section = self.made.sections[0]
        self._page(section)
        self._title_page()
        if not isinstance(note.front[0], Contents):
            self._section(WD_SECTION.NEW_PAGE, "2a", first=True)
        blocks = list(note.blocks())
        for b, after in zip(blocks, [*blocks[1:], None], strict=True):
            if isinstance(b, Contents):
                self._section(WD_SECTION.NEW_PAGE, "2")
                self.block(b)
                self._section(WD_SECTION.NEW_PAGE, "2a", first=True)
                continue
            self._framed(b)
            self.last = None
            self.block(b)
            if self.last is not None and after is not None and sticky(b, after):
                self.last.paragraph_format.keep_with_next = True
        return self.made

    # --- pages

    def _page(self, section: Any) -> None:
        section.page_width, section.page_height = self.mm(210), self.mm(297)
        section.left_margin, section.right_margin = self.mm(25), self.mm(10)
        section.top_margin, section.bottom_margin = self.mm(11), self.mm(23)
        section.header_distance, section.footer_distance = self.mm(5), self.mm(5)

    def _framed(self, b: Block) -> None:
        """Begin a section where what begins a page has a frame and what was before had none, or the other way round."""
        from docx.enum.section import WD_SECTION

        if not (isinstance(b, Sheet) or (isinstance(b, Heading) and b.level == 1)):
            return
        pages, last = self.places["headings"], int(self.places["pages"])
        after = (page for (level, *_), page in zip(self.headings[self.seen + 1:], pages[self.seen + 1:], strict=True) if level == 1)
        wanted = self.note.frame.on(pages[self.seen], next(after, last + 1) - 1, last)
        if wanted != bool(self.form):
            self._section(WD_SECTION.NEW_PAGE, "2a" if wanted else "", first=True)

    def _section(self, kind: Any, form: str, first: bool = False) -> None:
        """A new section with the frame in its header and a stamp in its footer, or without both where there is no ``form``.

        ``first``: its first heading begins no page of its own.
        """
        section = self.made.add_section(kind)
        self._page(section)
        section.header.is_linked_to_previous = section.footer.is_linked_to_previous = False
        if form == "2":
            section.bottom_margin = self.mm(48)
        if form:
            self._frame(section.header.paragraphs[0])
            self._stamp(section.footer, form)
        self.form = form
        self.fresh = first

    def _frame(self, paragraph: Any) -> None:
        """The frame: a rectangle 185 x 287 mm, 20 mm from the left edge and 5 mm from the others, behind the text."""
        emu = 36000
        width, height = 185 * emu, 287 * emu
        xml = (
            f'<w:r xmlns:w="{_W}" xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006" '
            'xmlns:wp="http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing" '
            'xmlns:a="http://schemas.openxmlformats.org/drawingml/2006/main" '
            'xmlns:wps="http://schemas.microsoft.com/office/word/2010/wordprocessingShape">'
            '<mc:AlternateContent><mc:Choice Requires="wps"><w:drawing>'
            '<wp:anchor distT="0" distB="0" distL="0" distR="0" simplePos="0" relativeHeight="1" behindDoc="1" locked="1" '
            'layoutInCell="0" allowOverlap="1"><wp:simplePos x="0" y="0"/>'
            f'<wp:positionH relativeFrom="page"><wp:posOffset>{20 * emu}</wp:posOffset></wp:positionH>'
            f'<wp:positionV relativeFrom="page"><wp:posOffset>{5 * emu}</wp:posOffset></wp:positionV>'
            f'<wp:extent cx="{width}" cy="{height}"/><wp:effectExtent l="0" t="0" r="0" b="0"/><wp:wrapNone/>'
            f'<wp:docPr id="{900 + next(self.ids)}" name="frame"/><wp:cNvGraphicFramePr/>'
            '<a:graphic><a:graphicData uri="http://schemas.microsoft.com/office/word/2010/wordprocessingShape"><wps:wsp>'
            f'<wps:cNvSpPr/><wps:spPr><a:xfrm><a:off x="0" y="0"/><a:ext cx="{width}" cy="{height}"/></a:xfrm>'
            '<a:prstGeom prst="rect"><a:avLst/></a:prstGeom><a:noFill/><a:ln w="17780"><a:solidFill><a:srgbClr val="000000"/>'
            "</a:solidFill></a:ln></wps:spPr><wps:bodyPr/></wps:wsp></a:graphicData></a:graphic></wp:anchor></w:drawing></mc:Choice>"
            "</mc:AlternateContent></w:r>"
        )
        paragraph._p.append(_parsed(xml))

    def _stamp(self, footer: Any, form: str) -> None:
        """Form 2a or 2 as a table at the foot of the page."""
        w = self.words
        heads = [w.get(k, "") for k in ("izm", "list", "doc", "sign", "date")]
        if form == "2a":
            rows = [["", "", "", "", "", w.get("designation", ""), w.get("list", "")], [""] * 7, [*heads, "", "PAGE"]]
            widths, heights = [7, 10, 23, 15, 10, 110, 10], [5, 5, 5]
            merges = [(0, 5, 2, 5), (1, 6, 2, 6)]
            rows[1][6], rows[2][6] = "PAGE", ""
        else:
            left = [["", "", "", "", ""], ["", "", "", "", ""], heads]
            roles = [("developed", "student"), ("checked", "checker"), ("head", "supervisor"), ("norm", ""), ("approved", "")]
            left += [[w.get(role, ""), "", w.get(name, ""), "", ""] for role, name in roles]
            right = [
                [w.get("designation", ""), "", "", ""],
                ["", "", "", ""],
                ["", "", "", ""],
                [w.get("subject", ""), w.get("letter-head", ""), w.get("list", ""), w.get("lists", "")],
                ["", w.get("letter", ""), "PAGE", str(self.places["pages"])],
                ["", f"{w.get('institution', '')} {w.get('group', '')}".strip(), "", ""],
                ["", "", "", ""],
                ["", "", "", ""],
            ]
            rows = [a + b for a, b in zip(left, right, strict=True)]
            widths, heights = [7, 10, 23, 15, 10, 70, 15, 15, 20], [5] * 8
            merges = [(0, 5, 2, 8), (3, 5, 7, 5), (5, 6, 7, 8), *((i, 0, i, 1) for i in range(3, 8))]
        table = footer.add_table(len(rows), len(widths), self.mm(185))
        table.autofit = False
        _indent(table, -283)
        _borders(table)
        for column, width in zip(table.columns, widths, strict=True):
            column.width = self.mm(width)
        for row, cells, height in zip(table.rows, rows, heights, strict=True):
            _height(row, height)
            for cell, text, width in zip(row.cells, cells, widths, strict=True):
                self._cell(cell, text, 7, width)
        for r0, c0, r1, c1 in merges:
            text = next((rows[r][c] for r in range(r0, r1 + 1) for c in range(c0, c1 + 1) if rows[r][c]), "")
            merged = table.cell(r0, c0).merge(table.cell(r1, c1))
            for p in merged.paragraphs[1:]:
                p._p.getparent().remove(p._p)
            merged.paragraphs[0].clear()
            size = 14 if text and text == w.get("designation") else 8
            self._cell(merged, text, size, sum(widths[c0:c1 + 1]), sum(heights[r0:r1 + 1]))
        empty = footer.paragraphs[0]
        empty._p.getparent().remove(empty._p)
        last = footer.add_paragraph()
        last.paragraph_format.line_spacing = self.pt(1)

    def _cell(self, cell: Any, text: str, size: float, width: float, height: float = 5.0) -> None:
        """Lettering of a stamp, set narrower where it is too long for its cell, mm."""
        from docx.enum.table import WD_CELL_VERTICAL_ALIGNMENT
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        cell.vertical_alignment = WD_CELL_VERTICAL_ALIGNMENT.CENTER
        p = cell.paragraphs[0]
        p.alignment = WD_ALIGN_PARAGRAPH.CENTER
        if text == "PAGE":
            _field(p, "PAGE", "1", size)
        elif text:
            run = p.add_run(text)
            run.font.size = self.pt(size)
            lines = max(1, int(height / (LEADING * size)))
            words = [max(map(len, text.split())), len(text) / lines + (max(map(len, text.split())) / 2 if lines > 1 else 0)]
            share = (width - 1.0) / (WIDE * size * max(words))
            if share < 1:
                run._r.get_or_add_rPr().append(_parsed(f'<w:w xmlns:w="{_W}" w:val="{max(10, int(100 * share))}"/>'))

    def _title_page(self) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        t = self.note.title_page

        def line(text: str, size: float, before: float = 0.0, bold: bool = False) -> None:
            p = self.made.add_paragraph()
            p.alignment = WD_ALIGN_PARAGRAPH.CENTER
            p.paragraph_format.space_before = self.pt(before)
            run = p.add_run(text)
            run.font.size, run.font.bold = self.pt(size), bold

        line(t["ministry"], 14)
        line(t["institution"], 14)
        line(t["kind"], 18, 150, True)
        line(t["course"], 14, 12)
        line(t["theme"], 14, 8)
        line(t["designation"], 14, 16)
        for i, (role, name) in enumerate(zip(t["people"], t["names"], strict=True)):
            p = self.made.add_paragraph()
            p.paragraph_format.left_indent = self.mm(85)
            p.paragraph_format.space_before = self.pt(110 if not i else 8)
            p.add_run(f"{role}  {name or '____________________'}")
        line(t["place"], 14, 100)

    # --- blocks

    @singledispatchmethod
    def block(self, b: Block) -> None:
        """One block, of whatever kind."""
        raise TypeError(f"no block of a note: {b!r}")

    @block.register
    def _heading(self, b: Heading) -> None:
        _, text, mark = self.headings[self.seen]
        self.seen += 1
        p = self.made.add_heading("", b.level)
        if self.fresh and b.level == 1:
            p.paragraph_format.page_break_before = False
        self.fresh = False
        _bookmark(p, mark, next(self.ids), lambda: p.add_run(text))

    @block.register
    def _paragraph(self, b: Paragraph) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        self.last = p = self.made.add_paragraph()
        p.alignment = {"centre": WD_ALIGN_PARAGRAPH.CENTER, "right": WD_ALIGN_PARAGRAPH.RIGHT}.get(
            b.look, WD_ALIGN_PARAGRAPH.JUSTIFY
        )
        if b.look == "plain":
            p.paragraph_format.first_line_indent = self.mm(10)
        elif b.look == "item":
            p.paragraph_format.left_indent = self.mm(10)
        self._text(p, b.text)

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
        from docx.enum.text import WD_TAB_ALIGNMENT

        for i, node in enumerate(b.lines):
            self.last = p = self.made.add_paragraph()
            p.paragraph_format.keep_with_next = i < len(b.lines) - 1
            p.paragraph_format.line_spacing = 1.0  # anything less cuts the foot of a fraction off
            p.paragraph_format.tab_stops.add_tab_stop(self.mm(84), WD_TAB_ALIGNMENT.CENTER)
            p.paragraph_format.tab_stops.add_tab_stop(self.mm(175), WD_TAB_ALIGNMENT.RIGHT)
            p.paragraph_format.space_before = p.paragraph_format.space_after = self.pt(2)
            p.add_run("\t")
            _math(p, node)
            if b.number and i == len(b.lines) - 1:
                p.add_run("\t")
                _bookmark(p, mark_of(f"formula:{b.number.strip('()')}"), next(self.ids), lambda p=p: p.add_run(b.number))

    @block.register
    def _where(self, b: Where) -> None:
        for i, row in enumerate(b.rows):
            p = self.made.add_paragraph()
            p.paragraph_format.left_indent = self.mm(25)
            p.paragraph_format.first_line_indent = self.mm(-25)
            p.paragraph_format.tab_stops.add_tab_stop(self.mm(10))
            p.add_run((b.word if not i else "") + "\t")
            _math(p, row.symbol)
            end = "." if i == len(b.rows) - 1 else ";"
            self._text(p, (" – ", *row.meaning, f", {row.unit}{end}" if row.unit else end))

    @block.register
    def _table(self, b: NumberedTable) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        p = self.made.add_paragraph(style="Caption")
        p.alignment = WD_ALIGN_PARAGRAPH.RIGHT
        p.paragraph_format.keep_with_next = True
        p.paragraph_format.space_before = self.pt(8)
        self._numbered(p, self.note.title_page["table"], b.number, "table")
        title = self.made.add_paragraph(b.title)
        title.alignment = WD_ALIGN_PARAGRAPH.CENTER
        title.paragraph_format.keep_with_next = True
        ends = list(accumulate(b.parts or (len(b.rows) - 1,), initial=1))
        for start, end in pairwise(ends):
            if start > 1:
                p = self.made.add_paragraph(self.note.title_page["continued"].format(n=b.number))
                p.alignment = WD_ALIGN_PARAGRAPH.RIGHT
                p.paragraph_format.page_break_before = p.paragraph_format.keep_with_next = True
            self._grid(b, [b.rows[0], *b.rows[start:end]])
        after = self.made.add_paragraph()
        after.paragraph_format.line_spacing = self.pt(6)

    def _grid(self, b: NumberedTable, rows: Sequence[Sequence[Text]]) -> None:
        """Rows of a table, which stay on one page, in cells as wide as all its rows want them."""
        from docx.enum.table import WD_TABLE_ALIGNMENT
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        widths = widths_of(b)
        table = self.made.add_table(len(rows), len(widths), style="Table Grid")
        table.alignment = WD_TABLE_ALIGNMENT.CENTER
        size = self.pt(9 if len(widths) > 8 else 10 if len(widths) > 6 else 11)
        table.autofit = False
        for column, width in zip(table.columns, widths, strict=True):
            column.width = self.mm(width)
        for i, (row, cells) in enumerate(zip(table.rows, rows, strict=True)):
            for j, (cell, text) in enumerate(zip(row.cells, cells, strict=True)):
                q = cell.paragraphs[0]
                q.alignment = WD_ALIGN_PARAGRAPH.LEFT if b.worded and i and not j else WD_ALIGN_PARAGRAPH.CENTER
                q.paragraph_format.keep_with_next = i < len(rows) - 1
                self._text(q, text)
                for run in q.runs:
                    run.font.size = size
        _repeat(table.rows[0])

    def _numbered(self, p: Any, word: str, number: str, kind: str, title: str = "") -> None:
        """A caption: word, number of the section, and a counting field; the number is what references point to."""
        p.add_run(f"{word}\u00a0")
        section, _, nth = number.rpartition(".")

        def put() -> None:
            if section:
                p.add_run(f"{section}.")
            _field(p, f"SEQ {kind}{section or 0} \\* ARABIC", nth)

        _bookmark(p, mark_of(f"{kind}:{number}"), next(self.ids), put)
        if title:
            p.add_run(f". {title}")

    @block.register
    def _figure(self, b: Figure) -> None:
        self._picture(b, b.width, b.height, b.turned)
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        p = self.made.add_paragraph(style="Caption")
        p.alignment = WD_ALIGN_PARAGRAPH.CENTER
        p.paragraph_format.space_after = self.pt(8)
        if b.further:
            p.add_run(f"{self.note.title_page['figure']}\u00a0{b.number}{self.note.title_page['part'].format(n=b.part)}")
        else:
            self._numbered(p, self.note.title_page["figure"], b.number, "figure", b.title)

    def _picture(self, b: Figure | Sheet, width: float, height: float, turned: bool) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        p = self.made.add_paragraph()
        p.alignment = WD_ALIGN_PARAGRAPH.CENTER
        p.paragraph_format.keep_with_next = True
        p.paragraph_format.line_spacing = 1.0  # anything less cuts the top of a picture off
        if turned:
            width, height = height, width
        if width > TEXT:
            p.paragraph_format.left_indent = p.paragraph_format.right_indent = self.mm((TEXT - width) / 2)
        shape = p.add_run().add_picture(io.BytesIO(self.pictures[_name(b)]), width=self.mm(width), height=self.mm(height))
        self._vector(shape, b, turned)

    def _vector(self, shape: Any, b: Figure | Sheet, turned: bool) -> None:
        """The drawing itself beside its picture, for programs that show SVG; turned ones are left as pictures."""
        if turned:
            return
        from docx.opc.packuri import PackURI
        from docx.opc.part import Part

        name = PackURI(f"/word/media/{_name(b)}.svg")
        part = Part(name, "image/svg+xml", b.svg, self.made.part.package)
        relation = self.made.part.relate_to(part, "http://schemas.openxmlformats.org/officeDocument/2006/relationships/image")
        blip = shape._inline.graphic.graphicData.pic.blipFill.find("{http://schemas.openxmlformats.org/drawingml/2006/main}blip")
        blip.append(
            _parsed(
                '<a:extLst xmlns:a="http://schemas.openxmlformats.org/drawingml/2006/main"><a:ext uri="' + _SVG_URI + '">'
                f'<asvg:svgBlip xmlns:asvg="{_SVG}" xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships" '
                f'r:embed="{relation}"/></a:ext></a:extLst>'
            )
        )

    @block.register
    def _sheet(self, b: Sheet) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        _, _, mark = self.headings[self.seen]
        self.seen += 1
        p = self.made.add_heading("", 1)
        if self.fresh:
            p.paragraph_format.page_break_before = False
        self.fresh = False
        _bookmark(p, mark, next(self.ids), lambda: p.add_run(f"{self.note.title_page['appendix']} {b.number}".upper()))
        p.paragraph_format.space_after = self.pt(2)
        title = self.made.add_paragraph(b.title)
        title.alignment = WD_ALIGN_PARAGRAPH.CENTER
        self._picture(b, 224.0, 224.0 * b.height / b.width, True)

    @block.register
    def _newpage(self, b: NewPage) -> None:
        self.made.add_paragraph().paragraph_format.page_break_before = True

    @block.register
    def _contents(self, b: Contents) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH, WD_TAB_ALIGNMENT, WD_TAB_LEADER

        p = self.made.add_paragraph()
        p.alignment = WD_ALIGN_PARAGRAPH.CENTER
        run = p.add_run(b.title)
        run.font.bold, run.font.size = True, self.pt(15)
        pages = self.places["headings"]
        for i, ((level, text, mark), page) in enumerate(zip(self.headings, pages, strict=True)):
            p = self.made.add_paragraph()
            p.paragraph_format.left_indent = self.mm(6 * (level - 1))
            p.paragraph_format.tab_stops.add_tab_stop(self.mm(174), WD_TAB_ALIGNMENT.RIGHT, WD_TAB_LEADER.DOTS)
            if not i:
                _begin(p, 'TOC \\o "1-2" \\h \\z')
            link = _parsed(f'<w:hyperlink xmlns:w="{_W}" w:anchor="{mark}" w:history="1"/>')
            p._p.append(link)
            size = '<w:rPr><w:sz w:val="23"/></w:rPr>'
            for xml in (
                f'<w:r xmlns:w="{_W}">{size}<w:t xml:space="preserve">{escape(text)}</w:t></w:r>',
                f'<w:r xmlns:w="{_W}"><w:tab/></w:r>',
                f'<w:r xmlns:w="{_W}"><w:fldChar w:fldCharType="begin"/></w:r>',
                f'<w:r xmlns:w="{_W}"><w:instrText xml:space="preserve"> PAGEREF {mark} \\h </w:instrText></w:r>',
                f'<w:r xmlns:w="{_W}"><w:fldChar w:fldCharType="separate"/></w:r>',
                f'<w:r xmlns:w="{_W}">{size}<w:t>{page}</w:t></w:r>',
                f'<w:r xmlns:w="{_W}"><w:fldChar w:fldCharType="end"/></w:r>',
            ):
                link.append(_parsed(xml))
        if self.headings:
            p._p.append(_parsed(f'<w:r xmlns:w="{_W}"><w:fldChar w:fldCharType="end"/></w:r>'))


def widths_of(b: NumberedTable) -> list[float]:
    """Widths of the columns of a table, mm, by what stands in them; together at most that of the text."""
    from tmm_sheets.note.phrases import plain_text

    def size(text: Text) -> float:
        return len(plain_text(text)) + sum(characters(x.node) for x in text if isinstance(x, Symbol))

    columns = max(map(len, b.rows))
    wanted = [6.0 + 2.1 * min(max(size(row[i]) for row in b.rows if i < len(row)), 40) for i in range(columns)]
    return [w * min(1.0, 174.0 / sum(wanted)) for w in wanted]


def mark_of(target: str) -> str:
    """Name of the bookmark of a figure, table or formula by its number."""
    return "n_" + target.replace(":", "_").replace(".", "_")


def _name(b: Figure | Sheet) -> str:
    from tmm_sheets.note.typst_writer import file_name

    return file_name(b)


def _parsed(xml: str) -> Any:
    from docx.oxml import parse_xml

    return parse_xml(xml)


def _math(p: Any, node: Node) -> None:
    p._p.append(_parsed(equation(node)))


def _begin(p: Any, instruction: str) -> None:
    for xml in (
        f'<w:r xmlns:w="{_W}"><w:fldChar w:fldCharType="begin"/></w:r>',
        f'<w:r xmlns:w="{_W}"><w:instrText xml:space="preserve"> {escape(instruction)} </w:instrText></w:r>',
        f'<w:r xmlns:w="{_W}"><w:fldChar w:fldCharType="separate"/></w:r>',
    ):
        p._p.append(_parsed(xml))


def _field(p: Any, instruction: str, text: str, size: float = 0.0) -> None:
    """A field with the text it shows until it is updated."""
    from docx.shared import Pt

    _begin(p, instruction)
    run = p.add_run(text)
    if size:
        run.font.size = Pt(size + 2)
    p._p.append(_parsed(f'<w:r xmlns:w="{_W}"><w:fldChar w:fldCharType="end"/></w:r>'))


def _bookmark(p: Any, name: str, number: int, put: Any) -> None:
    """What ``put`` writes lies between the ends of a bookmark."""
    p._p.append(_parsed(f'<w:bookmarkStart xmlns:w="{_W}" w:id="{number}" w:name="{name}"/>'))
    put()
    p._p.append(_parsed(f'<w:bookmarkEnd xmlns:w="{_W}" w:id="{number}"/>'))


def _properties(table: Any, made: Sequence[tuple[str, str]]) -> None:
    """Properties of a table in the order of the schema."""
    order = [
        "tblStyle",
        "tblpPr",
        "tblOverlap",
        "bidiVisual",
        "tblStyleRowBandSize",
        "tblStyleColBandSize",
        "tblW",
        "jc",
        "tblCellSpacing",
        "tblInd",
        "tblBorders",
        "shd",
        "tblLayout",
        "tblCellMar",
        "tblLook",
    ]
    properties = table._tbl.tblPr
    for name, xml in made:
        for old in properties.findall(f"{{{_W}}}{name}"):
            properties.remove(old)
        properties.append(_parsed(xml))
    children = sorted(properties, key=lambda e: order.index(e.tag.partition("}")[2]) if e.tag.partition("}")[2] in order else 99)
    for child in children:
        properties.remove(child)
        properties.append(child)


def _indent(table: Any, twips: int) -> None:
    _properties(
        table,
        [
            ("tblInd", f'<w:tblInd xmlns:w="{_W}" w:w="{twips}" w:type="dxa"/>'),
            (
                "tblCellMar",
                f'<w:tblCellMar xmlns:w="{_W}"><w:left w:w="20" w:type="dxa"/><w:right w:w="20" w:type="dxa"/></w:tblCellMar>',
            ),
        ],
    )


def _borders(table: Any) -> None:
    sides = "".join(
        f'<w:{s} w:val="single" w:sz="{size}" w:space="0" w:color="000000"/>'
        for s, size in (("top", 12), ("left", 12), ("bottom", 12), ("right", 12), ("insideH", 4), ("insideV", 8))
    )
    _properties(table, [("tblBorders", f'<w:tblBorders xmlns:w="{_W}">{sides}</w:tblBorders>')])


def _height(row: Any, mm: float) -> None:
    properties = row._tr.get_or_add_trPr()
    properties.append(_parsed(f'<w:trHeight xmlns:w="{_W}" w:val="{round(mm * 56.693)}" w:hRule="exact"/>'))


def _repeat(row: Any) -> None:
    """The head of a table stands on each of its pages."""
    row._tr.get_or_add_trPr().append(_parsed(f'<w:tblHeader xmlns:w="{_W}"/>'))
