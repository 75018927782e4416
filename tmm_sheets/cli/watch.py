"""``watch``: the sheets, each time their file is saved."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets import kept, quoting, words
from tmm_sheets.cli import opening
from tmm_sheets.cli.build import build_one
from tmm_sheets.cli.options import CORRECTED, PROJECT, SHEETS, formats_of, titled
from tmm_sheets.errors import told_of
from tmm_sheets.localized_cli import command, option
from tmm_sheets.words import tell


@command("watch")
@PROJECT
@CORRECTED
@titled
@SHEETS
@formats_of("pdf")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the sheets.  [default: out/<project>]")
def run(project: str, corrected: bool, sheets: tuple[int, ...], formats: tuple[str, ...], output: Path | None) -> None:
    """Draw the sheets of a project file each time it is saved, until Ctrl-C."""
    from tmm_sheets import catalogue
    from tmm_sheets.output import watching
    from tmm_sheets.output.building import Order
    from tmm_sheets.task import title_entries

    if catalogue.is_shipped(project):
        raise click.UsageError(tell("{project} is a shipped project, which nobody changes: {command}").format(
            project=project, command=quoting.command("new", "my", "--from", project)))
    path = catalogue.located(project)
    click.echo(tell("watching {file}, Ctrl-C ends it").format(file=path), err=True)
    for _ in watching.saved((path, path.parent / title_entries.FILE)):
        try:
            order = Order(sheets, formats, {}, corrected, language=words.asked(), reader=words.reader(), kept=kept.used(),
                          names=opening.names())
            build_one(project, order, output)
        except BrokenPipeError:
            raise  # nobody listens
        except Exception as e:
            click.echo(told_of(e), err=True)
