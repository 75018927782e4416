"""Families of tasks: one module each, which writes the project file of any variant from the manual's tables.

A module ``families/<family>.py`` answers for all project names ``<family>/...`` and has

- ``names() -> tuple[str, ...]``: what ``list`` shows, each a name that can be read;
- ``heading(name) -> dict``: the table ``[project]`` of one of these, filled in without the rest of the file;
- ``read(name, corrected=False) -> Variant``: the project; with ``corrected`` the suggested values instead of suspected misprints.

Its tables are ``variants/<family>/*.toml`` (no project files), its project files ``templates/schemes/<family>_*.toml``.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Any, Protocol, cast

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
    family = project.partition("/")[0]
    return cast("Family", import_module(f"{__name__}.{family}")) if "/" in project and family in known() else None


def names() -> Iterator[str]:
    """Names of all families' projects."""
    for family in known():
        yield from cast("Family", import_module(f"{__name__}.{family}")).names()
