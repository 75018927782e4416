"""What commands share: a project by its name, the names in its title blocks, the folder of its files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmm_sheets import words
from tmm_sheets.cli.options import TITLE

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.task.title_entries import Names
    from tmm_sheets.task.variant import Variant


def read_variant(project: str, corrected: bool, drawn: bool = True) -> Variant:
    """The project's numbers, and names in its title blocks; what is doubtful in them goes to standard error."""
    from tmm_sheets import catalogue
    from tmm_sheets.output.building import with_room

    variant = with_room(catalogue.read(project, corrected))
    for warning in variant.warnings:
        click.echo(f"{variant.called}: {warning}", err=True)
    return names().filled(variant) if drawn else variant


def open_project(project: str, corrected: bool, drawn: bool = True) -> Project:
    """The project; where it is not ``drawn``, nobody asks for the title blocks."""
    from tmm_sheets.project import Project

    variant = read_variant(project, corrected, drawn)
    words.set_paper(words.of_project(variant.project.language))
    return Project(variant)


def names() -> Names:
    """What title blocks are filled in with, by the options of the command that runs and the user's settings."""
    from tmm_sheets.task import title_entries

    return title_entries.given(click.get_current_context().meta.get(TITLE, {}))


def folder_of(variant: Variant, output: Path | None) -> Path:
    """Folder of a project's files: the one asked for, or one of its own."""
    from tmm_sheets.output.building import folder_name

    return output if output is not None else Path("out") / folder_name(variant.stem)


def put(folder: Path, made: Mapping[str, bytes], force: bool) -> tuple[tuple[Path, ...], list[str]]:
    """Write files that are made whole each time; where they are, and what is to be said of those that were changed by hand."""
    from tmm_sheets.output import build_store

    written, kept = build_store.put(build_store.outlet(folder), made, force)
    return tuple(folder / name for name in written), kept
