"""What a student gets beside the sheets: the note, an empty table for what is measured, the living page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_sheets import words
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.output.build_store import current, outlet, put, record_of
from tmm_sheets.program import fingerprint, program
from tmm_sheets.task import title_entries
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

KINDS = ("note", "measured", "page")
"""What there is beside the sheets."""


def write(project: Project, folder: Path, force: bool, names: Mapping[str, str]) -> tuple[dict[str, bool], tuple[str, ...]]:
    """Write into the student's folder what can be made; which kinds are there now, and what is to be said of the others.

    ``names`` are those of the title blocks: as settings in the folder they are there for whatever is made in it later.
    """
    made, place = dict[str, bool](), outlet(folder)
    said, table = list[str](), title_entries.table(names)
    if force or not current(place, record_of(place), title_entries.FILE, fingerprint(table)):
        said += put(place, {title_entries.FILE: table.encode()}, force, fingerprint(table))[1]
    for kind in KINDS:
        name, make = _MAKERS[kind]
        made_from = fingerprint(program(), words.paper(), words.reader(), project.variant.content, kind)
        # What somebody may have filled in stays whatever it was made from.
        if place.read(name) is not None if kind == "measured" else not force and current(place, record_of(place), name, made_from):
            made[kind] = True
            continue
        try:
            data = make(project)
        except (BadInput, CannotBuild) as e:
            made[kind] = False
            said.append(tell("{what}: {why}").format(what=kind, why=e))
            continue
        said += put(place, {name: data}, force, made_from)[1]
        made[kind] = True
    return made, tuple(said)


def _note(project: Project) -> bytes:
    from tmm_sheets.note import note

    return note.write(project, ("pdf",)).files["note.pdf"]


def _measured(project: Project) -> bytes:
    from tmm_sheets.compare.measured import measured_lengths

    return measured_lengths.table(project)


def _page(project: Project) -> bytes:
    from tmm_sheets.living.page import page

    text, problem = page(project)
    if problem is not None and not text:
        raise problem
    return text.encode()


_MAKERS: dict[str, tuple[str, Callable[[Project], bytes]]] = {
    "note": ("note.pdf", _note), "measured": ("measured.csv", _measured), "page": ("page.html", _page)}
"""The name of each, and what makes it."""
