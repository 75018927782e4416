"""Families of tasks: one module each, which writes the project file of any variant from the manual's tables.

A module ``families/<family>.py`` answers for all project names ``<family>/...`` and has

- ``names() -> tuple[str, ...]``: what ``list`` shows, each a name that can be read;
- ``heading(name) -> dict``: the table ``[project]`` of one of these, filled in without the rest of the file;
- ``read(name, corrected=False) -> Variant``: the project; with ``corrected`` the suggested values instead of suspected misprints.

Its tables are ``variants/<family>/*.toml`` (no project files), its project files ``templates/schemes/<family>_*.toml``.

Other families are folders (:mod:`~tmm_sheets.task.family_folder`): in the working folder, in ``families`` of the user's folder of
configuration, in a folder that TMM_SHEETS_PATH names, or where a package says by an entry point of the group
``tmm_sheets.families``. Those of the program go first, then these in this order.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Any, Protocol, cast

from tmm_sheets import resources
from tmm_sheets.errors import BadInput
from tmm_sheets.task import user_folder

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant


class Family(Protocol):
    """What a module of this package offers."""

    def names(self) -> tuple[str, ...]:
        """Names to list."""

    def heading(self, name: str) -> dict[str, Any]:
        """Table ``[project]`` of one of these names."""

    def read(self, name: str, corrected: bool = False) -> Variant:
        """Project of a name of this family."""


def known() -> tuple[str, ...]:
    """Names of the families, sorted."""
    return tuple(sorted(module.name for module in iter_modules(__path__)))


def of(project: str) -> Family | None:
    """The family that a project name belongs to."""
    family, sign, _ = project.partition("/")
    if not sign:
        return None
    if family in known():
        return cast("Family", import_module(f"{__name__}.{family}"))
    if not re.fullmatch(r"[\w-]+", family) or (resources.variants() / family).is_dir():
        return None
    folder = _folder(family)
    return _read(folder) if folder is not None else None


def names() -> Iterator[str]:
    """Names of all families' projects; none of a folder that cannot be read."""
    for family in known():
        yield from cast("Family", import_module(f"{__name__}.{family}")).names()
    for folder in folders().values():
        with suppress(BadInput):
            yield from _read(folder).names()


FILE, PATH, GROUP = "family.toml", "TMM_SHEETS_PATH", "tmm_sheets.families"
"""File of a folder that is a family, environment variable and entry points that tell where there are some."""


def folders() -> dict[str, Path]:
    """Folders that are families, by their names."""
    found: dict[str, Path] = {}
    for place in _places():
        for file in sorted(place.glob(f"*/{FILE}")) if place.is_dir() else ():
            found.setdefault(file.parent.resolve().name, file.parent)
    for name, folder in _installed():
        found.setdefault(name, folder)
    return {name: folder for name, folder in found.items() if name not in known()}


def _folder(name: str) -> Path | None:
    """The folder of a family."""
    for place in _places():
        if (place / name / FILE).is_file():
            return place / name
    return dict(_installed()).get(name)


def _places() -> Iterator[Path]:
    """Folders that may have families in them."""
    yield Path()
    user = user_folder.folder()
    if user is not None:
        yield user / "families"
    yield from (Path(place) for place in os.environ.get(PATH, "").split(os.pathsep) if place)


@cache
def _installed() -> tuple[tuple[str, Path], ...]:
    """Families of other packages: an entry point is a path, or a package whose folder it is."""
    from importlib.metadata import entry_points

    told = ((entry.name, entry.load()) for entry in entry_points(group=GROUP))
    found = ((name, Path(there.__path__[0]) if hasattr(there, "__path__") else Path(there)) for name, there in told)
    return tuple((name, folder) for name, folder in found if (folder / FILE).is_file())


def _read(folder: Path) -> Family:
    from tmm_sheets.task.family_folder import FolderFamily

    return FolderFamily(folder)
