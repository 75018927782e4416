"""Projects by name: the shipped ones in variants/, and users' own files by path."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_sheets import files, quoting, resources
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import families
from tmm_sheets.words import either, every, tell

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

SUFFIX = ".toml"


@dataclass(frozen=True)
class ShippedProject:
    """A shipped project as ``list`` shows it."""

    name: str
    title: str
    variant: str
    sheets: tuple[str, ...]


def shipped() -> tuple[str, ...]:
    """Names of the shipped projects: the families' variants, and paths below variants/ without suffix."""
    return _shipped(families.state())


@lru_cache(4)
def _shipped(_: object) -> tuple[str, ...]:
    return (*_files(), *families.names())


@cache
def _files() -> tuple[str, ...]:
    folder = resources.variants()
    paths = (p.relative_to(folder) for p in folder.rglob(f"*{SUFFIX}"))
    return tuple(sorted(p.with_suffix("").as_posix() for p in paths if p.parts[0] not in families.known()))


def entries() -> tuple[ShippedProject, ...]:
    """Every shipped project with its title, variant and sheets; only the heading of each file is looked at."""
    return _entries(families.state())


@lru_cache(4)
def _entries(_: object) -> tuple[ShippedProject, ...]:
    found = []
    for name in shipped():
        with suppress(BadInput, OSError, ValueError, LookupError, TypeError, AttributeError):  # a family is not finished yet
            folder = families.folder_of(name)
            table = families.heading(folder, name) if folder is not None else families.table_of_heading(shipped_path(name))
            found.append(ShippedProject(name, table["title"], table.get("variant", ""), tuple(table.get("sheets", ()))))
    return tuple(found)


def found(word: str) -> tuple[ShippedProject, ...]:
    """Shipped projects that have a word, or part of one, in their names, titles or variants, in any language."""
    wanted = word.casefold()
    return tuple(e for e in entries() if any(wanted in text.casefold() for text in (e.name, *every(e.title), *every(e.variant))))


def read(project: str, corrected: bool = False, guessed: bool = True) -> Variant:
    """Variant of a shipped name or of a project file; ``corrected``: without the suspected misprints of the manuals' tables.

    ``guessed``: what may be meant by a name is told where there is none; that costs a look at all names.
    A name goes first, so that a file of the same name in the working folder changes nothing; write ``./name`` for it.
    """
    from tmm_sheets.task import variant

    family = families.of(project)
    if family is not None and not project.endswith(SUFFIX):
        found = family.read(project, corrected)
        return found.shipped_as(found.project.name)
    if project in _files():
        return variant.read(shipped_path(project)).shipped_as(project)
    return variant.read(located(project, guessed))


def is_shipped(project: str) -> bool:
    """Whether a project is meant by a shipped name, not by a path."""
    return (not project.endswith(SUFFIX) and families.folder_of(project) is not None) or project in _files()


def located(project: str, guessed: bool = True) -> Path:
    """The project file at a path.

    Raises
    ------
    BadInput
        when there is none, with the nearest shipped names and project files; when this process is confined to another folder.
    """
    path = files.named(project)
    if os.path.lexists(path):
        return path
    hint = _meant(project, path) if guessed else ""
    if project.endswith(SUFFIX):
        raise BadInput(Problem(tell("no such file"), project, hint=hint))
    raise BadInput(tell('unknown project "{project}": neither a shipped name nor a file').format(project=project), hint=hint)


def _meant(project: str, path: Path) -> str:
    """What may be meant by a name of which there is no project."""
    from tmm_sheets import spelling

    beside: list[Path] = []
    with suppress(OSError):
        beside = sorted(path.parent.glob(f"*{SUFFIX}"))
    if hint := spelling.hint(project, (*map(str, beside), *shipped()), 3):
        return hint
    near = [e.name for e in found(project)[:3]]
    return (tell("did you mean {near}?").format(near=either(near)) if near else
            tell("{command} shows the shipped projects").format(command=quoting.command("list")))


def shipped_path(name: str) -> Path:
    """File of a shipped project."""
    return resources.variants() / f"{name}{SUFFIX}"
