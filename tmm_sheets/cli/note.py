"""``note``: the explanatory note."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, NO_CACHE, PROJECT, among, titled
from tmm_sheets.localized_cli import command, option
from tmm_sheets.words import tell

NOTE_FORMATS = ("pdf", "docx")
"""Formats of the explanatory note."""


@command("note")
@PROJECT
@CORRECTED
@titled
@option("--format", "formats", default="pdf", show_default=True, callback=among(NOTE_FORMATS), metavar="F,F",
        help=f"Formats: {', '.join(NOTE_FORMATS)}.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the note.  [default: out/<project>]")
@option("--force", is_flag=True, help="Overwrite what was changed by hand.")
@NO_CACHE
def run(project: str, corrected: bool, formats: tuple[str, ...], output: Path | None, force: bool) -> None:
    """Write the explanatory note of PROJECT: text, formulas, tables and figures from the record, ready to be printed."""
    from tmm_sheets import files
    from tmm_sheets.note import note as writing
    from tmm_sheets.progress import Progress

    writing.check(formats)
    opened = opening.open_project(project, corrected)
    folder = opening.folder_of(opened.variant, output)
    files.check_folder(folder)
    with Progress() as progress:
        written = writing.write(opened, formats, lambda what: progress.say(f"{what} ..."))
        paths, kept = opening.put(folder, written.files, force)
    for path in paths:
        click.echo(path)
    for line in kept:
        click.echo(f"{opened.variant.called}: {line}", err=True)
    for problem in written.problems:
        click.echo(f"{opened.variant.called}: {tell('left out: {problem}').format(problem=problem)}", err=True)
    for dead in opened.dead_positions if opened.variant.crank is not None else ():
        click.echo(f"{opened.variant.called}: {dead}", err=True)
