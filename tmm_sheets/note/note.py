"""The files of a note: composed once, set as PDF for the page numbers, written in the formats asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING

from tmm_sheets import quoting
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import both, tell

if TYPE_CHECKING:
    from tmm_sheets.note.document import Note
    from tmm_sheets.project import Project
    from tmm_sheets.task.variant import Variant

PACKAGES = {"pdf": ("typst",), "docx": ("typst", "docx")}
"""What each format is made with; pages of the contents are counted in the PDF for both."""


def check(formats: Iterable[str]) -> None:
    """Tell at once that a package is missing.

    Raises
    ------
    CannotBuild
        which one, for which format, and how to install it.
    """
    for form in formats:
        missing = [name for name in PACKAGES[form] if find_spec(name) is None]
        if missing:
            names = both([{"docx": "python-docx"}.get(name, name) for name in missing])
            raise CannotBuild(tell("the note as {form} needs {names}").format(form=form.upper(), names=names),
                              quoting.install("note"))


def run_on(variant: Variant, say: Callable[[str], None] = lambda _: None) -> Variant:
    """The project with the numbers of its sheets running on after the pages of its note: the appendices are the sheets.

    Raises
    ------
    CannotBuild
        as :func:`write`.
    """
    check(("pdf",))
    from tmm_sheets.note.document import Sheet
    from tmm_sheets.project import Project

    note, _, places = _typeset(Project(variant), say)
    first = int(places["pages"]) - sum(isinstance(b, Sheet) for b in note.body) + 1
    return variant.model_copy(update={"title_block": variant.title_block.model_copy(update={"first_sheet": first})})


def _typeset(project: Project, say: Callable[[str], None]) -> tuple[Note, bytes, dict[str, int]]:
    """The note of a project, its PDF, and the pages there by number of the headings."""
    from tmm_sheets.note import composing, typst_writer

    note = composing.compose(project, say)
    say("pages")
    note, data, places = typst_writer.render(note)
    return composing.counted(note, int(places["pages"])), data, places


@dataclass(frozen=True)
class Written:
    """The files of a note by their names, how many pages it has, and what could not be told in it."""

    files: dict[str, bytes]
    pages: int
    problems: tuple[str, ...]


def write(project: Project, formats: Iterable[str] = ("pdf",), say: Callable[[str], None] = lambda _: None) -> Written:
    """The files note.pdf and note.docx of a project.

    Raises
    ------
    CannotBuild
        when a package is missing, there are no templates of the language, or nothing of the project can be drawn.
    """
    formats = tuple(formats)
    check(formats)
    note, data, places = _typeset(project, say)
    made: dict[str, bytes] = {}
    for form in formats:
        if form == "pdf":
            made["note.pdf"] = data
        else:
            from tmm_sheets.note import docx_writer

            say("docx")
            made["note.docx"] = docx_writer.render(note, places)
    return Written(made, int(places["pages"]), note.problems)
