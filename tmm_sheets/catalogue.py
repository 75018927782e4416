"""Projects by name: the shipped ones in variants/, and users' own files by path."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_sheets import resources
from tmm_sheets.errors import BadInput
from tmm_sheets.task import families
from tmm_sheets.words import either, tell

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

SUFFIX = ".toml"


@dataclass(frozen=True)
class Entry:
    """A shipped project as ``list`` shows it."""

    name: str
    title: str
    variant: str
    sheets: tuple[str, ...]


def shipped() -> tuple[str, ...]:
    """Names of the shipped projects: the families' variants, and paths below variants/ without suffix."""
    folder = resources.variants()
    paths = (p.relative_to(folder) for p in folder.rglob(f"*{SUFFIX}"))
    files = sorted(p.with_suffix("").as_posix() for p in paths if p.parts[0] not in families.known())
    return (*files, *families.names())


def entries() -> tuple[Entry, ...]:
    """Every shipped project with its title, variant and sheets; only the heading of each file is looked at."""
    found = []
    for name in shipped():
        family = families.of(name)
        if family is not None:
            variant = family.read(name)
            found.append(Entry(name, variant.project.title, variant.project.variant, variant.sheets))
            continue
        heading = tomllib.loads(_path(name).read_text(encoding="utf-8"))["project"]
        found.append(Entry(name, heading["title"], heading.get("variant", ""), tuple(heading["sheets"])))
    return tuple(found)


def read(project: str, corrected: bool = False) -> Variant:
    """Variant of a shipped name or of a project file; ``corrected``: without the suspected misprints of the manuals' tables.

    A name goes first, so that a file of the same name in the working folder changes nothing; write ``./name`` for it.
    """
    from tmm_sheets.task import variant

    family = families.of(project)
    if family is not None and not project.endswith(SUFFIX):
        return family.read(project, corrected)
    return variant.read(locate(project))


def locate(project: str) -> Path:
    """Project file of a shipped name or path.

    Raises
    ------
    BadInput
        when it is neither, with the nearest shipped names.
    """
    names = shipped()
    if project in names:
        return _path(project)
    path = Path(project)
    if path.exists() or project.endswith(SUFFIX):
        return path
    near = get_close_matches(project, names, n=3)
    raise BadInput(
        tell('unknown project "{project}": neither a shipped name nor a file').format(project=project),
        hint=tell("did you mean {near}?").format(near=either(near)) if near else tell("tmm-sheets list shows the shipped projects"),
    )


def _path(name: str) -> Path:
    return resources.variants() / f"{name}{SUFFIX}"
