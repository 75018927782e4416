"""What a command told and wrote, kept for whoever asks the same of the same texts: nothing is read, computed or drawn anew.

A project is read from its file, or those of a family, and from the settings beside it, in the working folder and of the user. These
texts, the program, what was asked, the languages and the date that files shall tell are all that an outcome depends on; another
one of them is another question. What is in the way of its files is looked at each time.
"""

from __future__ import annotations

import marshal
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import click

from tmm_sheets import catalogue, files, kept, resources, words
from tmm_sheets.kept import fingerprint, maker
from tmm_sheets.output.build_store import Folder
from tmm_sheets.task import families, title_entries

ELSEWHERE = frozenset({"measured", "image", "dxf", "group", "marks", "printer", "preview", "archive", "with_note", "views",
                       "show_files", "explain", "force"})  # fmt: skip
"""Options of commands with which more is read, made or begun than that."""


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
    return fingerprint("again", maker(), repr((
        click.get_current_context().info_name, project, sorted(asked.items()), words.reader(), words.asked(),
        os.environ.get("SOURCE_DATE_EPOCH"), [(path, data and fingerprint(data)) for path, data in read.items()])))


def found(question: str) -> Any:
    """What is kept of an outcome; None for nothing."""
    with suppress(EOFError, ValueError, TypeError):
        return marshal.loads(kept.read(question) or b"")
    return None


def keep(answered: str, project: str, asked: Mapping[str, Any], told: Any) -> None:
    """Keep an outcome, texts and contents, if it still is one of the same question: somebody may have saved a file meanwhile."""
    if answered and answered == question(project, asked):
        kept.write(answered, marshal.dumps(told))
