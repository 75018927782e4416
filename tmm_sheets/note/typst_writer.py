"""The note as PDF: a Typst source from the document tree, set by the package typst."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tmm_sheets.construction.formula import spelt
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.note.alphabets import TYPST, characters, string
from tmm_sheets.note.arranging import Measured, arranged, kind, sticky
from tmm_sheets.note.document import (
    FRAMED,
    Block,
    Contents,
    Figure,
    Formula,
    Heading,
    Note,
    NumberedTable,
    NumberInText,
    Paragraph,
    Sheet,
    Symbol,
    Text,
    Where,
)
from tmm_sheets.resources import template
from tmm_sheets.words import both, tell


def render(note: Note) -> tuple[Note, bytes, dict[str, int]]:
    """The note with its figures and tables where they stand best (see :mod:`~tmm_sheets.note.arranging`), its PDF, and the pages
    there by number of the headings ("headings") and of all ("pages").

    It is set twice: as it comes, which tells how high its blocks are, and arranged. What it reads from the same file and sets in
    the same way, Typst sets only once: therefore the blocks have a file of their own.

    Raises
    ------
    BadInput
        when the preamble, which a department may change, cannot be set or names a font that is not there.
    """
    import json

    import typst  # note.check() has told it where it is missing

    blocks = [*note.blocks()]
    parts = [*map(_block, blocks, (*blocks[1:], None))]
    known = {part: f"#blocks.at({k})" for k, part in enumerate(parts)}
    files = {f"{b.file}.svg": b.svg for b in blocks if isinstance(b, Figure | Sheet)}
    files |= {"preamble.typ": _preamble().read_bytes(),
              "blocks.typ": "\n".join(('#import "preamble.typ": *\n#let blocks = (', *(f"[{x}]," for x in parts), ")")).encode()}
    with TemporaryDirectory(prefix="tmm-note-") as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)

        def compiler(source: str) -> Any:
            path = Path(folder) / "note.typ"
            path.write_text(source, encoding="utf-8")
            return typst.Compiler(str(path), root=folder, font_paths=_fonts(), ignore_system_fonts=True)

        try:
            note = _arranged(note, json.loads(compiler(source(note, known, True)).query("<heights>", field="value", one=True)))
            final = compiler(source(note, known))
            made, warnings = final.compile_with_warnings(format="pdf", timestamp=0, pdf_tags=False)
            found = json.loads(final.query("<places>", field="value", one=True))
        except (typst.TypstError, RuntimeError) as e:
            raise BadInput(Problem(str(e), str(_preamble()))) from None
    for warning in warnings:
        if "font" in warning.message:
            raise BadInput(Problem(warning.message, str(_preamble())), hint=tell("fonts are read from {folders}").format(
                folders=both(_fonts())))
    assert isinstance(made, bytes)
    return note, made, found


def _arranged(note: Note, found: dict[str, Any]) -> Note:
    """The note with its figures and tables where they stand best, by the heights that were found."""
    heights = iter(found["heights"])

    def part(some: Sequence[Block]) -> tuple[Block, ...]:
        return tuple(arranged(some, Measured(tuple(islice(heights, len(some))), found["room"])))

    return replace(note, front=part(note.front), body=part(note.body))


def _preamble() -> Path:
    return template("note/preamble.typ")


def _fonts() -> list[str]:
    return [str(template("note/fonts")), str(template("fonts"))]


def rasters(blocks: Iterable[Block], dpi: float) -> dict[str, bytes]:
    """Pictures of the figures and sheets as PNG by their names, turned as they stand on the page."""
    import typst

    drawn = [b for b in blocks if isinstance(b, Figure | Sheet)]
    with TemporaryDirectory(prefix="tmm-note-") as folder:
        root = Path(folder)
        pages = []
        for b in drawn:
            (root / f"{b.file}.svg").write_bytes(b.svg)
            image = f'image("{b.file}.svg", width: {b.on_page[0]:.2f}mm)'
            pages.append(f"rotate(-90deg, reflow: true, {image})" if b.turned else image)
        source = "#set page(width: auto, height: auto, margin: 0mm)\n" + "\n#pagebreak()\n".join(f"#{p}" for p in pages)
        (root / "pictures.typ").write_text(source, encoding="utf-8")
        made: Any = typst.compile(str(root / "pictures.typ"), format="png", ppi=dpi) if drawn else []
    found: list[bytes] = [made] if isinstance(made, bytes) else list(made or [])
    return {b.file: data for b, data in zip(drawn, found, strict=True)}


def source(note: Note, known: Mapping[str, str], measured: bool = False) -> str:
    """The Typst source of a note; ``known``: what stands for a block by its own source; ``measured``: it tells how high all are."""
    def written(blocks: Sequence[Block], measured: bool = False) -> str:
        begins = (f"#begins({string(kind(b))})\n" if measured else "" for b in blocks)
        parts = map(_block, blocks, (*blocks[1:], None))
        return "\n".join(begin + known.get(part, part) for begin, part in zip(begins, parts, strict=True))

    fields = ", ".join(f"{string(k)}: {string(v)}" for k, v in (note.frame.fields | note.frame.words).items())
    framed = ", ".join(map(str, FRAMED)) if note.frame.short else ""
    return (
        '#import "preamble.typ": *\n#import "blocks.typ": blocks\n'
        f"#show: note.with(lang: {string(note.language)}, title: {string(note.title)}, author: {string(note.author)}, "
        f"first: {note.first_page}, framed: ({framed}), words: ({fields or ':'}))\n"
        f"#title-page({_titles(note)})\n{written(note.front, measured)}\n{written(note.body, measured)}\n#last-page()\n#places()\n"
        + (f"#reminders[{written(note.reminders)}]\n" if note.reminders else "")
        + ("#heights(blocks)\n" if measured else "")
    )


def _titles(note: Note) -> str:
    values = ((k, f"({', '.join(map(string, v))},)" if isinstance(v, list) else string(v)) for k, v in note.title_page.items())
    return "(" + ", ".join(f"{string(k)}: {value}" for k, value in values) + ")"


FITTING = 50
"""Width of a formula, in characters, up to which it is sure to have room in a line."""
LOOKS = {"item": "item", "centre": "middle", "right": "aside"}
"""Functions of the preamble for paragraphs that are not plain."""


def _block(b: Block, after: Block | None) -> str:
    """One block; ``after`` comes next, which may have to stand on the same page."""
    held = "true" if after is not None and sticky(b, after) else "false"
    match b:
        case Heading():
            return f"#title({b.level}, {string(b.said)})"
        case Paragraph(look="plain"):
            return f"#para(held: {held})[{text(b.text)}]\n"
        case Paragraph():
            return f"#{LOOKS[b.look]}[{text(b.text)}]\n"
        case Formula():
            lines = " ".join(f"${spelt(x, TYPST)}$," for x in b.lines)
            wide = "true" if any(characters(x) > FITTING for x in b.lines) else "false"
            return f"#formula(({lines}), {string(b.number)}, held: {held}, wide: {wide})"
        case Where():
            rows = (f"([${spelt(r.symbol, TYPST)}$], [{text((*r.meaning, f', {r.unit}' if r.unit else ''))}])," for r in b.rows)
            return f"#where({string(b.word)}, ({' '.join(rows)}))"
        case NumberedTable():
            rows = ("(" + ", ".join(f"[{text(c)}]" for c in row) + ",)," for row in b.rows)
            looks = f"{'true' if b.worded else 'false'}, {'true' if b.parts else 'false'}"
            return f"#grid-table({string(b.number)}, {string(b.title)}, {max(map(len, b.rows))}, ({' '.join(rows)}), {looks})"
        case Figure():
            size = f"{b.width:.2f}mm, {b.height:.2f}mm, {'true' if b.turned else 'false'}, {b.part if b.further else 'none'}"
            return f"#picture({string(b.number)}, {string(b.title)}, {string(b.file + '.svg')}, {size})"
        case Sheet():
            return f"#sheet({string(b.number)}, {string(b.title)}, {string(b.file + '.svg')})"
        case Contents():
            return f"#contents({string(b.title)})"
        case _:
            return "#pagebreak(weak: true)"


def text(parts: Text) -> str:
    """Running text."""
    return "".join(
        f"${spelt(x.node, TYPST)}$"
        if isinstance(x, Symbol)
        else "#pages-of-all;"
        if getattr(x, "step", "") == "note.pages"
        else f"#box({string(str(x))});"  # no unit is parted behind its slash
        if isinstance(x, NumberInText) and "/" in x.unit
        else f"#{string(str(x))};"
        for x in parts
    )
