"""The note as PDF: a Typst source from the document tree, set by the package typst."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tmm_sheets import typed
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.note.alphabets import TYPST, spelt, string
from tmm_sheets.note.document import (
    FRAMED,
    Block,
    Contents,
    Figure,
    Formula,
    Heading,
    NewPage,
    Note,
    Number,
    Paragraph,
    Sheet,
    Symbol,
    Table,
    Text,
    Where,
)
from tmm_sheets.note.heights import PAGE, height
from tmm_sheets.resources import template
from tmm_sheets.words import both, tell


def render(note: Note) -> tuple[bytes, dict[str, int]]:
    """The PDF, and the pages by number of the headings ("toc-0" ...) and of all ("pages").

    Raises
    ------
    CannotBuild
        when the package typst is missing.
    BadInput
        when the preamble, which a department may change, cannot be set or names a font that is not there.
    """
    try:
        import typst
    except ImportError:
        raise CannotBuild(tell("the note as PDF needs the package typst"), typed.install("note")) from None
    import json

    preamble = template("note/preamble.typ")
    with TemporaryDirectory(prefix="tmm-note-") as folder:
        root = Path(folder)
        for name, data in pictures(note.blocks()).items():
            (root / name).write_bytes(data)
        (root / "preamble.typ").write_bytes(preamble.read_bytes())
        (root / "note.typ").write_text(source(note), encoding="utf-8")
        fonts = [str(template("note/fonts")), str(template("fonts"))]
        compiler = typst.Compiler(str(root / "note.typ"), root=str(root), font_paths=fonts, ignore_system_fonts=True)
        try:
            made, warnings = compiler.compile_with_warnings(format="pdf", timestamp=0, pdf_tags=False)
        except typst.TypstError as e:
            raise BadInput(Problem(str(e), str(preamble))) from None
        for warning in warnings:
            if "font" in warning.message:
                raise BadInput(Problem(warning.message, str(preamble)), hint=tell("fonts are read from {folders}").format(
                    folders=both(fonts)))
        found = json.loads(compiler.query("<places>", field="value", one=True))
    assert isinstance(made, bytes)
    return made, found


def pictures(blocks: Iterable[Block]) -> dict[str, bytes]:
    """SVG files of the figures and sheets by their names."""
    return {f"{file_name(b)}.svg": b.svg for b in blocks if isinstance(b, Figure | Sheet)}


def rasters(blocks: Iterable[Block], dpi: float) -> dict[str, bytes]:
    """Pictures of the figures and sheets as PNG by their names, turned as they stand on the page."""
    import typst

    drawn = [b for b in blocks if isinstance(b, Figure | Sheet)]
    with TemporaryDirectory(prefix="tmm-note-") as folder:
        root = Path(folder)
        pages = []
        for b in drawn:
            name = file_name(b)
            (root / f"{name}.svg").write_bytes(b.svg)
            width = b.width if isinstance(b, Figure) else 224.0
            image = f'image("{name}.svg", width: {width:.2f}mm)'
            turned = isinstance(b, Sheet) or b.turned
            pages.append(f"rotate(-90deg, reflow: true, {image})" if turned else image)
        source = "#set page(width: auto, height: auto, margin: 0mm)\n" + "\n#pagebreak()\n".join(f"#{p}" for p in pages)
        (root / "pictures.typ").write_text(source, encoding="utf-8")
        made: Any = typst.compile(str(root / "pictures.typ"), format="png", ppi=dpi) if drawn else []
    found: list[bytes] = [made] if isinstance(made, bytes) else list(made or [])
    return {file_name(b): data for b, data in zip(drawn, found, strict=True)}


def file_name(block: Figure | Sheet) -> str:
    """Name of the file of a picture."""
    return f"sheet-{block.number}" if isinstance(block, Sheet) else f"fig-{block.number.replace('.', '-')}"


def source(note: Note) -> str:
    """The Typst source of a note."""
    w = _Writer()
    body = "\n".join(map(w.block, note.body))
    front = "\n".join(map(w.block, note.front))
    reminders = "\n".join(map(w.block, note.reminders))
    fields = ", ".join(f"{string(k)}: {string(v)}" for k, v in (note.frame.fields | note.frame.words).items())
    framed = ", ".join(map(str, FRAMED)) if note.frame.short else ""
    title = ", ".join(f"{string(k)}: {_value(v)}" for k, v in note.title_page.items())
    return (
        '#import "preamble.typ": *\n'
        f"#show: note.with(lang: {string(note.language)}, title: {string(note.title)}, author: {string(note.author)}, "
        f"first: {note.first_page}, framed: ({framed}), words: ({fields or ':'}))\n"
        f"#title-page(({title}))\n{front}\n{body}\n#last-page()\n#places()\n" + (f"#reminders[{reminders}]\n" if reminders else "")
    )


def _value(value: Any) -> str:
    return f"({', '.join(string(x) for x in value)},)" if isinstance(value, list | tuple) else string(str(value))


class _Writer:
    """Blocks as Typst, with the headings counted for the contents."""

    def __init__(self) -> None:
        self.headings = 0
        self.height = 0.0
        """About how far down it is from the beginning of the section, mm: no figure may stand above its heading."""

    def block(self, b: Block) -> str:
        """One block."""
        self.height = 20.0 if isinstance(b, Heading) and b.level == 1 else self.height + height(b)
        made: str = getattr(self, f"_{type(b).__name__.lower()}")(b)
        return made

    def _heading(self, b: Heading) -> str:
        text = f"{b.number}  {b.text}" if b.number else b.text
        self.headings += 1
        return f"#title({b.level}, {string(text)})"

    def _paragraph(self, b: Paragraph) -> str:
        function = {"plain": "para", "item": "item", "centre": "middle", "right": "aside"}[b.look]
        return f"#{function}[{text(b.text)}]\n"

    def _formula(self, b: Formula) -> str:
        lines = " ".join(f"${spelt(x, TYPST)}$," for x in b.lines)
        return f"#formula(({lines}), {string(b.number)})"

    def _where(self, b: Where) -> str:
        rows = " ".join(f"([${spelt(r.symbol, TYPST)}$], [{text((*r.meaning, f', {r.unit}' if r.unit else ''))}])," for r in b.rows)
        return f"#where({string(b.word)}, ({rows}))"

    def _table(self, b: Table) -> str:
        columns = max(map(len, b.rows))
        rows = ", ".join("(" + ", ".join(f"[{text(c)}]" for c in row) + ",)" for row in b.rows)
        return f"#grid-table({string(b.number)}, {string(b.title)}, {columns}, ({rows},), {'true' if b.worded else 'false'})"

    def _figure(self, b: Figure) -> str:
        turned = "true" if b.turned else "false"
        place = "auto" if self.height > PAGE else "bottom"
        size = f"{b.width:.2f}mm, {b.height:.2f}mm"
        return f"#picture({string(b.number)}, {string(b.title)}, {string(file_name(b) + '.svg')}, {size}, {turned}, {place})"

    def _sheet(self, b: Sheet) -> str:
        return f"#sheet({string(b.number)}, {string(b.title)}, {string(file_name(b) + '.svg')})"

    def _contents(self, b: Contents) -> str:
        return f"#contents({string(b.title)})"

    def _newpage(self, b: NewPage) -> str:
        return "#pagebreak(weak: true)"


def text(parts: Text) -> str:
    """Running text."""
    return "".join(
        f"${spelt(x.node, TYPST)}$"
        if isinstance(x, Symbol)
        else "#pages-of-all;"
        if getattr(x, "step", "") == "note.pages"
        else f"#box({string(str(x))});"  # no unit is parted behind its slash
        if isinstance(x, Number) and "/" in x.unit
        else f"#{string(str(x))};"
        for x in parts
    )
