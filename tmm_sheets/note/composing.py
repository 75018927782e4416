"""A note from a project: the sections that it has something for, in the order of ``templates/note/order.toml``."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from tmm_sheets import words as catalogues
from tmm_sheets.construction.formula import letters_of, reworded
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.note import phrases
from tmm_sheets.note.document import (
    Block,
    Explained,
    Figure,
    Formula,
    Frame,
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
from tmm_sheets.note.phrases import Numbering, Scope, Writer
from tmm_sheets.note.pictures import Pictures
from tmm_sheets.note.reader import Reader
from tmm_sheets.note.sections import errata, task
from tmm_sheets.resources import template

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from tmm_sheets.project import Project


@cache
def _order() -> dict[str, Any]:
    path = template("note/order.toml")
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as e:
        raise BadInput(Problem(str(e), str(path))) from None


def _order_of(project: Project) -> tuple[list[str], list[dict[str, Any]]]:
    """Names of the parts before the sections, and the sections, in the order of the manual that the project names."""
    order = _order()
    own: dict[str, Any] = order["manuals"].get(project.variant.note.manual, {})
    sections = order["section"]
    if "sections" in own:
        sections = sorted(sections, key=lambda s: own["sections"].index(s["template"]) if s["template"] in own["sections"] else -1)
    return own.get("front", order["front"]), sections


@cache
def literature() -> dict[str, str]:
    """Entries of the literature by their keys, each in the language of the source."""
    found: dict[str, str] = tomllib.loads(template("note/literature.toml").read_text(encoding="utf-8"))
    return found


def reader_of(project: Project, say: Callable[[str], None] = lambda _: None) -> Reader:
    """What the sections of a note read: the project with its sheets drawn; those that cannot be are told among the problems."""
    from tmm_sheets.sheets import sheet

    attempt = sheet.every(project, say, steps=True)
    scales: dict[str, Any] = {}
    for composed in attempt.drawn.values():
        scales |= composed.scales
    reader = Reader(project, catalogues.paper(), Pictures(attempt.drawn), scales)
    reader.problems += [f"{name}: {e}" for name, e in attempt.refused.items()]
    return reader


def compose(project: Project, say: Callable[[str], None] = lambda _: None) -> Note:
    """The note of a project, in the language of the paper.

    Raises
    ------
    CannotBuild
        when there are no templates of that language, or nothing of the project can be drawn.
    """
    language = catalogues.paper()
    said = phrases.words(language)
    reader = reader_of(project, say)
    say("note")
    numbering = Numbering(literature())
    writer = Writer(language, numbering)
    parts = _parts(project)
    front_order, sections = _order_of(project)
    scopes: dict[str, Scope] = {}
    base = general(reader)
    before: dict[str, list[Block]] = {}
    for name in front_order:
        if name != "abstract":  # which tells of all the others
            before[name] = writer.blocks(name, _with(task.scope(reader), base) if name == "task" else base)
    body: list[Block] = []
    for section in sections:
        if section["needs"] not in parts:
            continue
        name = section["template"]
        try:
            found = import_module(f"tmm_sheets.note.sections.{section['module']}").scope(reader)
        except CannotBuild as e:
            reader.problems.append(str(e))
            continue
        if found is None:
            continue
        scopes[name] = found
        body += writer.blocks(name, _with(found, base))
    summary = dict(base.fields)
    for name, found in scopes.items():
        summary[name] = {**dict.fromkeys(found.formulas, True), **found.fields, "is": True}
    body += writer.blocks("conclusion", Scope(summary))
    if project.variant.misprints or errata.of(project):
        body += writer.blocks("errata", errata.scope(reader))
    body += _sources(language, numbering)
    sheets = reader.pictures.pages()
    body += _appendices(sheets)
    told = [*(b for blocks in before.values() for b in blocks), *body]
    counts = {
        "figures": sum(isinstance(b, Figure) and not b.further for b in told),
        "tables": sum(isinstance(b, NumberedTable) for b in told),
        "sources": len(numbering.cited),
        "sheets": len(sheets),
        "formulas": numbering.total.get("formula", 0),
    }
    before["abstract"] = writer.blocks(
        "abstract", Scope(summary | {k: NumberInText(str(v), f"note.{k}", v) for k, v in counts.items()} | {"pages": PAGES})
    )
    front = [b for name in front_order for b in before[name]]
    reminders = writer.blocks("reminders", base)
    block = project.variant.title_block
    front, body, reminders = (list(_reworded(blocks, said["indices"])) for blocks in (front, body, reminders))
    return Note(
        language,
        f"{catalogues.of_file(project.variant.project.title)}. {said['title']}",
        block.student or "tmm_sheets",
        tuple(front),
        _title_page(reader),
        tuple(body),
        _frame(reader),
        tuple(reminders),
        1,
        tuple(dict.fromkeys(reader.problems)),
    )


def _reworded(blocks: Iterable[Block], table: dict[str, str]) -> Iterator[Block]:
    """Blocks with the indices of letters in the language of the note."""

    def text(parts: Text) -> Text:
        return tuple(Symbol(reworded(x.node, table)) if isinstance(x, Symbol) else x for x in parts)

    for b in blocks:
        if isinstance(b, Paragraph):
            yield replace(b, text=text(b.text))
        elif isinstance(b, Formula):
            yield replace(b, lines=tuple(reworded(x, table) for x in b.lines))
        elif isinstance(b, Where):
            yield replace(b, rows=tuple(Explained(reworded(r.symbol, table), text(r.meaning), r.unit) for r in b.rows))
        elif isinstance(b, NumberedTable):
            yield replace(b, rows=tuple(tuple(map(text, row)) for row in b.rows))
        else:
            yield b


PAGES = NumberInText("\u0001", "note.pages", 0)
"""Stands for the number of pages until they are counted."""


def counted(note: Note, pages: int) -> Note:
    """The note with the number of its pages where the abstract tells it."""

    def settled(text: Text) -> Text:
        return tuple(
            replace(x, text=str(pages), value=pages) if isinstance(x, NumberInText) and x.text == PAGES.text else x for x in text
        )

    front = tuple(replace(b, text=settled(b.text)) if isinstance(b, Paragraph) else b for b in note.front)
    return replace(note, front=front)


def _with(found: Scope, base: Scope) -> Scope:
    return Scope(base.fields | found.fields, found.formulas, found.tables, found.figures, base.letters | found.letters)


def _parts(project: Project) -> set[str]:
    """What sections may need: parts of the results, and sections of the project file."""
    found = set(project.parts)
    if project.variant.cycle is None:
        found -= {"positions", "velocities", "accelerations", "forces"}
    return found


def general(r: Reader) -> Scope:
    """Fields that every template may use."""
    parts = _parts(r.project)
    v = r.project.variant
    fields: dict[str, Any] = {
        "name": catalogues.of_file(v.project.title),
        "sheets": len(r.pictures.sheets),
        f"manual_{v.note.manual or '000'}": True,
        "institution": catalogues.of_file(v.title_block.institution or ""),
        **{f"has_{p}": True for p in parts},
    }
    said = phrases.words(r.language)
    fields |= {f"keys_{p}": said["keys"][p] if p in parts else "" for p in said["keys"]}
    fields["objects"] = phrases.listed([text for p, text in said["objects"].items() if p in parts], said["phrases"]["and"])
    fields["aims"] = phrases.listed([text for p, text in said["aims"].items() if p in parts], said["phrases"]["and"])
    variant = catalogues.of_file(v.project.variant or "")
    fields["variant_text"] = said["phrases"]["variant"].format(variant=variant) if variant else ""
    fields["and_forces"] = said["phrases"]["and_forces"] if "forces" in parts else ""
    fields["checked_text"] = said["phrases"]["checked"] if {"forces", "flywheel"} & parts else ""
    fields["way_text"] = said["phrases"]["way_forces" if "forces" in parts else "way_positions"] if "positions" in parts else ""
    moment = v.balancing is None or v.balancing.kind == "moment"
    fields |= said["balancing"]["moment" if moment else "force"]
    fields["driven"] = v.input is not None
    if v.crank is not None:
        fields |= {"crank": v.crank.link, "given": v.crank.link}
    if v.input is not None:
        drive = r.project.mechanism.drive
        by = "input_by_place" if drive is not None and drive.slides else "input_by_length"
        fields |= {"input": v.input.link, "given": v.input.link, "by": said["phrases"][by]}
    if "positions" in parts:
        fields["label"] = r.label
    return Scope(fields, letters=_letters(r))


def _letters(r: Reader) -> dict[str, str]:
    """What the letters mean that the project chose itself: forces, moments, what balances them."""
    said = phrases.words(r.language)
    v = r.project.variant
    found = {phrases.bare(letters_of(f.name)): said["loads"]["force"].format(link=f.link) for f in v.force}
    found |= {phrases.bare(letters_of(m.name)): said["loads"]["moment"].format(link=m.link) for m in v.moment}
    if v.balancing is not None:
        kind = "moment" if v.balancing.kind == "moment" else "force"
        found[phrases.bare(letters_of(v.balancing.name))] = said["balancing"][kind]["balancing_nom"]
    return found


def _sources(language: str, numbering: Numbering) -> list[Block]:
    """The literature in order of citation."""
    entries: list[Block] = [Heading(1, "", phrases.words(language)["literature"])]
    for i, key in enumerate(numbering.cited, 1):
        entries.append(Paragraph((f"{i}. {numbering.literature[key]}",), "item"))
    return entries


def _appendices(sheets: list[Sheet]) -> list[Block]:
    return [replace(s, number=str(i), title=s.title.split(". ", 1)[-1]) for i, s in enumerate(sheets, 1)]


def _title_page(r: Reader) -> dict[str, Any]:
    said = phrases.words(r.language)
    block = r.project.variant.title_block
    page = said["title_page"]
    return {
        "ministry": page["ministry"],
        "institution": catalogues.of_file(block.institution or "") or page["institution"],
        "kind": page["kind"],
        "course": page["course"],
        "theme": page["theme"].format(name=catalogues.of_file(r.project.variant.project.title)),
        "designation": block.designated(page["code"]),
        "people": [page["student"], page["supervisor"], page["checker"]],
        "names": [block.student or "", block.supervisor or "", block.checker or ""],
        "place": page["place"],
        "figure": said["figure"],
        "table": said["table"],
        "continued": said["continued"],
        "part": said["part"],
        "appendix": said["appendix"],
    }


def _frame(r: Reader) -> Frame:
    said = phrases.words(r.language)
    block = r.project.variant.title_block
    fields = {
        "designation": block.designated(said["title_page"]["code"]),
        "student": block.student or "",
        "checker": block.checker or "",
        "supervisor": block.supervisor or "",
        "letter": block.letter or "",
        "institution": catalogues.of_file(block.institution or ""),
        "group": catalogues.of_file(block.group or ""),
        "subject": said["stamp_subject"],
    }
    return Frame(fields, dict(said["stamp"]), r.project.variant.note.frames == "short")
