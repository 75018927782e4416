"""What a command told and wrote, kept for whoever asks the same of the same texts: nothing is read, computed or drawn anew.

A project is read from its file, or those of a family, and from the settings beside it, in the working folder and of the user. These
texts, the program, what was asked, the languages and the date that files shall tell are all that an outcome depends on; another
one of them is another question. What is in the way of its files is looked at each time.
"""

from __future__ import annotations

import marshal
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Any

import click

from tmm_sheets import catalogue, files, kept, resources, words
from tmm_sheets.output.build_store import Folder
from tmm_sheets.program import fingerprint, maker
from tmm_sheets.task import families, title_entries

TITLE, GIVEN = "tmm_sheets.title", "tmm_sheets.given"
"""Keys under which the context of a command keeps what its options fill title blocks in with, and what it has told and written."""
ELSEWHERE = frozenset({"measured", "image", "dxf", "group", "marks", "printer", "preview", "archive", "with_note", "views",
                       "show_files", "explain", "force"})  # fmt: skip
"""Options of commands with which more is read, made or begun than that."""


def entered() -> dict[str, str]:
    """What title blocks are filled in with by the options of the command that runs."""
    return dict(click.get_current_context().meta.get(TITLE, {}))


def question(project: str, asked: Mapping[str, Any]) -> str:
    """Name of what options ask of a project by the command that runs; empty where nothing is kept, as of families of the user."""
    folder, file, ours = families.folder_of(project), Path(project), resources.variants()
    if files.confined() or any(map(asked.get, ELSEWHERE)) or not (folder or ours).is_relative_to(ours):
        return ""
    named = (catalogue.shipped_path(project), file, *(folder.iterdir() if folder else ()), title_entries.user_file(),
             Path(title_entries.FILE), file.parent / title_entries.FILE)
    read = {str(path): Folder(Path()).read(str(path)) for path in named if path}
    if any(data is None and os.path.lexists(path) for path, data in read.items()):
        return ""  # the command says why
    about = (click.get_current_context().info_name, project, sorted(asked.items()), entered(), words.reader(), words.asked(),
             os.environ.get("SOURCE_DATE_EPOCH"), [(path, data and fingerprint(data)) for path, data in read.items()])
    return fingerprint("again", maker(), repr(about))


def found(question: str) -> Any:
    """What is kept of an outcome; None for nothing."""
    with suppress(EOFError, ValueError, TypeError):
        return marshal.loads(kept.read(question) or b"")
    return None


def keep(answered: str, project: str, asked: Mapping[str, Any], told: Any) -> None:
    """Keep an outcome, texts and contents, if it still is one of the same question: somebody may have saved a file meanwhile."""
    if answered and answered == question(project, asked):
        kept.write(answered, marshal.dumps(told))


def give(said: object, err: bool = False) -> None:
    """Tell a line, or write files, all or none: whatever a command gives that is :func:`repeatable`."""
    files.write_all({Path(path): data for path, data in said.items()}) if isinstance(said, dict) else click.echo(said, err=err)
    told = {str(path): data for path, data in said.items()} if isinstance(said, dict) else str(said)
    click.get_current_context().meta.setdefault(GIVEN, []).append((told, err))


def repeatable(command: Callable[..., None]) -> Callable[..., None]:
    """Decorator of a command: what it gave is given again. A file that is there and says something else is left to the command."""
    @wraps(command)
    def run(project: str, **asked: Any) -> None:
        name, here = question(project, asked), Folder(Path())
        known = found(name) or ()
        made = (file for said, _ in known if isinstance(said, dict) for file in said.items())
        if known and all(here.read(path) in (None, data) for path, data in made):
            for said, err in known:
                give(said, err)
        else:
            command(project=project, **asked)
            keep(name, project, asked, click.get_current_context().meta.get(GIVEN))

    return run
