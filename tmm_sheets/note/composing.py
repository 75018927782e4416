"""A note from a project: the sections that it has something for, in the order of ``templates/note/order.toml``."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING, Any

from tmm_sheets import results, words as catalogues
from tmm_sheets.construction.formula import Node, letters_of, reworded
from tmm_sheets.errors import CannotBuild
from tmm_sheets.meanings import bare, tables_of, words
from tmm_sheets.note.document import Block, Figure, Frame, Heading, Note, NumberedTable, NumberInText, Paragraph, changed
from tmm_sheets.note.phrases import Numbering, Scope, Writer
from tmm_sheets.note.pictures import Pictures
from tmm_sheets.note.reader import Reader, listed
from tmm_sheets.note.sections import task
from tmm_sheets.resources import template

if TYPE_CHECKING:
    from collections.abc import Callable

    from tmm_sheets.project import Project


def order_of(project: Project) -> tuple[list[str], list[dict[str, Any]]]:
    """Names of the parts before the sections, and the sections, in the order of the manual that the project names."""
    order = tables_of(template("note/order.toml"))
    own: dict[str, Any] = order["manuals"].get(project.variant.note.manual, {})
    sections = order["section"]
    if "sections" in own:
        sections = sorted(sections, key=lambda s: own["sections"].index(s["template"]) if s["template"] in own["sections"] else -1)
    return own.get("front", order["front"]), sections


def literature() -> dict[str, str]:
    """Entries of the literature by their keys, each in the language of the source."""
    return tables_of(template("note/literature.toml"))


def reader_of(project: Project, say: Callable[[str], None] = lambda _: None) -> Reader:
    """What the sections of a note read: the project with all its results, its sheets; what cannot be made is among the problems."""
    from tmm_sheets.sheets import sheet

    attempt = sheet.every(project, say)
    scales: dict[str, Any] = {}
    for composed in attempt.drawn.values():
        scales |= composed.scales
    reader = Reader(project, catalogues.paper(), Pictures(attempt.drawn), scales)
    reader.problems += [f"{name}: {e}" for name, e in attempt.refused.items()]
    try:
        results.told(project, project.parts, refused={})
    except CannotBuild as e:
        reader.problems.append(str(e))
    return reader


def compose(project: Project, say: Callable[[str], None] = lambda _: None) -> Note:
    """The note of a project, in the language of the paper.

    Raises
    ------
    CannotBuild
        when there are no templates of that language, or nothing of the project can be drawn.
    """
    language = catalogues.paper()
    said = words(language)
    reader = reader_of(project, say)
    say("note")
    numbering = Numbering(literature())
    writer = Writer(language, numbering)
    parts = _parts(project)
    front_order, sections = order_of(project)
    base = general(reader)
    summary = base
    before: dict[str, list[Block]] = {}
    for name in front_order:
        if name != "abstract":  # which tells of all the others
            before[name] = writer.blocks(name, base.within(task.task_fields(reader)) if name == "task" else base)
    body: list[Block] = []
    for section in sections:
        if section["needs"] not in parts:
            continue
        name = section["template"]
        try:
            found = getattr(import_module(f"tmm_sheets.note.sections.{section['module']}"), f"{name}_fields")(reader)
        except CannotBuild as e:
            reader.problems.append(str(e))
            continue
        if found is None:
            continue
        summary = summary.within({name: found})
        body += writer.blocks(name, base.within(found))
    body += writer.blocks("conclusion", summary)
    if project.variant.misprints or task.errata_of(project):
        body += writer.blocks("errata", base.within(task.errata_fields(reader)))
    body += [Heading(1, "", said["literature"])]
    body += [Paragraph((f"{i}. {numbering.literature[key]}",), "item") for i, key in enumerate(numbering.cited, 1)]
    sheets = reader.pictures.pages()
    body += [replace(s, number=str(i), title=s.title.split(". ", 1)[-1]) for i, s in enumerate(sheets, 1)]
    told = [*(b for blocks in before.values() for b in blocks), *body]
    counts = {
        "figures": sum(isinstance(b, Figure) and not b.further for b in told),
        "tables": sum(isinstance(b, NumberedTable) for b in told),
        "sources": len(numbering.cited),
        "sheets": len(sheets),
    }
    told_counts = {k: NumberInText(str(v), f"note.{k}", v) for k, v in counts.items()}
    before["abstract"] = writer.blocks("abstract", summary.within({**told_counts, "pages": PAGES}))
    front = [b for name in front_order for b in before[name]]
    reminders = writer.blocks("reminders", base)
    block = project.variant.title_block


    def in_language(blocks: list[Block]) -> tuple[Block, ...]:
        return tuple(changed(b, lambda x: reworded(x, said["indices"]) if isinstance(x, Node) else x) for b in blocks)

    return Note(
        language,
        f"{catalogues.of_file(project.variant.project.title)}. {said['title']}",
        block.student or "tmm_sheets",
        in_language(front),
        _title_page(reader),
        in_language(body),
        _frame(reader),
        in_language(reminders),
        1,
        tuple(dict.fromkeys(reader.problems)),
    )


PAGES = NumberInText("\u0001", "note.pages", 0)
"""Stands for the number of pages until they are counted."""


def counted(note: Note, pages: int) -> Note:
    """The note with the number of its pages where the abstract tells it."""
    return replace(note, front=changed(note.front, lambda x: replace(PAGES, text=str(pages), value=pages) if x == PAGES else x))


def _parts(project: Project) -> set[str]:
    """What sections may need: parts of the results, and sections of the project file."""
    found = set(project.parts)
    if project.variant.cycle is None:
        found -= {"positions", "velocities", "accelerations", "forces"}
    return found


def general(r: Reader) -> Scope:
    """Fields that every template may use."""
    parts, v, said = _parts(r.project), r.project.variant, r.words
    told = said["phrases"]
    variant = catalogues.of_file(v.project.variant or "")
    moment = v.balancing is None or v.balancing.kind == "moment"
    fields: dict[str, Any] = {
        "name": catalogues.of_file(v.project.title),
        "sheets": len(r.pictures.sheets),
        f"manual_{v.note.manual or '000'}": True,
        "institution": catalogues.of_file(v.title_block.institution or ""),
        **{f"has_{p}": True for p in parts},
        **{f"keys_{p}": text if p in parts else "" for p, text in said["keys"].items()},
        **{name: listed([text for p, text in said[name].items() if p in parts], told["and"]) for name in ("objects", "aims")},
        "variant_text": told["variant"].format(variant=variant) if variant else "",
        "and_forces": told["and_forces"] if "forces" in parts else "",
        "checked_text": told["checked"] if {"forces", "flywheel"} & parts else "",
        "way_text": told["way_forces" if "forces" in parts else "way_positions"] if "positions" in parts else "",
        **said["balancing"]["moment" if moment else "force"],
        "driven": v.input is not None,
        "letters": _letters(r),
    }
    if v.crank is not None:
        fields |= {"crank": v.crank.link, "given": v.crank.link}
    if v.input is not None:
        drive = r.project.mechanism.drive
        by = "input_by_place" if drive is not None and drive.slides else "input_by_length"
        fields |= {"input": v.input.link, "given": v.input.link, "by": told[by]}
    if "positions" in parts:
        fields["label"] = r.label
    return Scope(fields, r)


def _letters(r: Reader) -> dict[str, str]:
    """What the letters mean that the project chose itself: forces, moments, what balances them."""
    said, v = r.words, r.project.variant
    found = [(f.name, said["loads"]["force"].format(link=f.link)) for f in v.force]
    found += [(m.name, said["loads"]["moment"].format(link=m.link)) for m in v.moment]
    if v.balancing is not None:
        found.append((v.balancing.name, said["balancing"]["moment" if v.balancing.kind == "moment" else "force"]["balancing_nom"]))
    return {bare(letters_of(name)): meaning for name, meaning in found}


def _title_page(r: Reader) -> dict[str, Any]:
    said, block = r.words, r.project.variant.title_block
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
    said, block = r.words, r.project.variant.title_block
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
