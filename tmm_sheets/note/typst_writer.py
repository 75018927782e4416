"""The note as PDF: a Typst source from the document tree, set by the package typst."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tmm_sheets.construction.formula import spelt
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.note.alphabets import TYPST, characters, string
from tmm_sheets.note.arranging import Measured, arranged, sticky
from tmm_sheets.note.document import (
    FRAMED,
    Block,
    Contents,
    Figure,
    Formula,
    Heading,
    NewPage,
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

BLANK, NOTHING = "blank.svg", b'<svg xmlns="http://www.w3.org/2000/svg" width="1mm" height="1mm"/>'
"""A picture that stands for the others where only their size is asked for."""


def render(note: Note) -> tuple[bytes, dict[str, int]]:
    """The PDF, and the pages by number of the headings ("toc-0" ...) and of all ("pages").

    Raises
    ------
    BadInput
        when the preamble, which a department may change, cannot be set or names a font that is not there.
    """
    import json

    pictures = {f"{b.file}.svg": b.svg for b in note.blocks() if isinstance(b, Figure | Sheet)}
    with _compiler(source(note), pictures) as compiler:
        made, warnings = compiler.compile_with_warnings(format="pdf", timestamp=0, pdf_tags=False)
        for warning in warnings:
            if "font" in warning.message:
                raise BadInput(Problem(warning.message, str(_preamble())), hint=tell("fonts are read from {folders}").format(
                    folders=both(_fonts())))
        found = json.loads(compiler.query("<places>", field="value", one=True))
    assert isinstance(made, bytes)
    return made, found


def placed(note: Note) -> Note:
    """The note with its figures and tables where they stand best, see :mod:`~tmm_sheets.note.arranging`.

    Raises
    ------
    BadInput
        as :func:`render`.
    """
    import json

    blocks = list(note.blocks())
    order = sorted(range(len(blocks)), key=lambda k: isinstance(blocks[k], Figure | NumberedTable))
    running = sum(not isinstance(b, Figure | NumberedTable) for b in blocks)
    with _compiler(_measuring(note, [blocks[k] for k in order], running), {BLANK: NOTHING}) as compiler:
        found = json.loads(compiler.query("<heights>", field="value", one=True))
    heights = found["heights"]
    del heights[running]  # where the running text ends
    of_block = dict(zip(order, heights, strict=True))

    def part(some: range) -> tuple[Block, ...]:
        measured = Measured(tuple(of_block[k] for k in some), {kind: tuple(room) for kind, room in found["room"].items()})
        return tuple(arranged([blocks[k] for k in some], measured))

    n = len(note.front)
    return replace(note, front=part(range(n)), body=part(range(n, len(blocks))))


def _preamble() -> Path:
    return template("note/preamble.typ")


def _fonts() -> list[str]:
    return [str(template("note/fonts")), str(template("fonts"))]


@contextmanager
def _compiler(source: str, files: Mapping[str, bytes]) -> Iterator[Any]:
    """Typst with a source and the files it names."""
    import typst  # note.check() has told it where it is missing

    with TemporaryDirectory(prefix="tmm-note-") as folder:
        root = Path(folder)
        for name, data in files.items():
            (root / name).write_bytes(data)
        (root / "preamble.typ").write_bytes(_preamble().read_bytes())
        (root / "note.typ").write_text(source, encoding="utf-8")
        try:
            yield typst.Compiler(str(root / "note.typ"), root=str(root), font_paths=_fonts(), ignore_system_fonts=True)
        except (typst.TypstError, RuntimeError) as e:
            raise BadInput(Problem(str(e), str(_preamble()))) from None


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


def source(note: Note) -> str:
    """The Typst source of a note."""
    fields = ", ".join(f"{string(k)}: {string(v)}" for k, v in (note.frame.fields | note.frame.words).items())
    framed = ", ".join(map(str, FRAMED)) if note.frame.short else ""
    return (
        '#import "preamble.typ": *\n'
        f"#show: note.with(lang: {string(note.language)}, title: {string(note.title)}, author: {string(note.author)}, "
        f"first: {note.first_page}, framed: ({framed}), words: ({fields or ':'}))\n"
        f"#title-page({_titles(note)})\n{_written(note.front)}\n{_written(note.body)}\n#last-page()\n#places()\n"
        + (f"#reminders[{_written(note.reminders)}]\n" if note.reminders else "")
    )


def _measuring(note: Note, blocks: Sequence[Block], running: int) -> str:
    """The source that tells how high blocks are, so many of them one after another; what has a page of its own has no height."""
    written = [
        "" if isinstance(b, Contents | NewPage | Sheet) else _block(b, after, BLANK) for b, after in pairwise([*blocks, None])
    ]
    parts = (f"({' '.join(f'[{x}],' for x in some)})" for some in (written[:running], written[running:]))
    return f'#import "preamble.typ": *\n#heights({string(note.language)}, {_titles(note)}, {", ".join(parts)})\n'


def _titles(note: Note) -> str:
    values = ((k, f"({', '.join(map(string, v))},)" if isinstance(v, list) else string(v)) for k, v in note.title_page.items())
    return "(" + ", ".join(f"{string(k)}: {value}" for k, value in values) + ")"


def _written(blocks: Sequence[Block]) -> str:
    """Blocks one after another."""
    return "\n".join(_block(b, after) for b, after in pairwise([*blocks, None]) if b is not None)


FITTING = 50
"""Width of a formula, in characters, up to which it is sure to have room in a line."""
LOOKS = {"item": "item", "centre": "middle", "right": "aside"}
"""Functions of the preamble for paragraphs that are not plain."""


def _block(b: Block | None, after: Block | None, file: str = "") -> str:
    """One block; ``after`` comes next, which may have to stand on the same page; ``file`` is that of a figure if not its own."""
    held = "true" if b is not None and after is not None and sticky(b, after) else "false"
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
            return f"#picture({string(b.number)}, {string(b.title)}, {string(file or b.file + '.svg')}, {size})"
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
