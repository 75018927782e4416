"""What a student gets beside the sheets: the note, an empty table for what is measured, the living page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.output.build_store import Folder, put
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

KINDS = ("note", "measured", "page")
"""What there is beside the sheets."""


def write(project: Project, folder: Path, force: bool) -> tuple[dict[str, bool], tuple[str, ...]]:
    """Write into the student's folder what can be made; which kinds are there now, and what is to be said of the others."""
    made, said = dict[str, bool](), list[str]()
    for kind in KINDS:
        try:
            files = _MAKERS[kind](project, folder)
        except (BadInput, CannotBuild) as e:
            made[kind] = False
            said.append(tell("{what}: {why}").format(what=kind, why=e))
            continue
        said += put(Folder(folder), files, force)[1]
        made[kind] = True
    return made, tuple(said)


def _note(project: Project, folder: Path) -> Mapping[str, bytes]:
    from tmm_sheets.note import note

    return note.write(project, ("pdf",)).files


def _measured(project: Project, folder: Path) -> Mapping[str, bytes]:
    """The table; nothing where one lies that may be filled in."""
    from tmm_sheets.compare.measured import measured_lengths

    if (folder / measured_lengths.NAME).exists():
        return {}
    return measured_lengths.template(project, folder, False, lambda what: None).files


def _page(project: Project, folder: Path) -> Mapping[str, bytes]:
    from tmm_sheets.living.page import page

    text, problem = page(project)
    if problem is not None and not text:
        raise problem
    return {"page.html": text.encode()}


_MAKERS: dict[str, Callable[[Project, Path], Mapping[str, bytes]]] = {"note": _note, "measured": _measured, "page": _page}
