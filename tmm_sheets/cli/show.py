"""``show``: what a project says."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, PROJECT
from tmm_sheets.localized_cli import command, option
from tmm_sheets.words import tell


@command("show")
@PROJECT
@CORRECTED
@option("--file", "as_file", is_flag=True, help="The project file itself, to be changed and used as one's own.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="With --file: write it there.")
@option("--force", is_flag=True, help="With -o: overwrite a file that says something else.")
def run(project: str, corrected: bool, as_file: bool, output: Path | None, force: bool) -> None:
    """Show inputs with units and source, links, pairs, mobility W, Assur groups, formula of structure."""
    if output is not None and not as_file:
        raise click.UsageError(tell("-o goes with --file"))
    variant = opening.read_variant(project, corrected, drawn=False)
    if output is not None:
        from tmm_sheets import files

        files.refuse_other(output, variant.text.encode(), force)
        files.write_all({output: variant.text.encode()})
        click.echo(output)
    elif as_file:
        click.echo(variant.text, nl=False)
    else:
        from tmm_sheets import summary

        click.echo(summary.text(variant, opening.names()))
