"""``check``: a project read and assembled."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, PROJECT
from tmm_sheets.localized_cli import command, option
from tmm_sheets.words import tell


@command("check")
@PROJECT
@CORRECTED
@option("--scheme", type=click.Path(path_type=Path), metavar="FILE", help="Draw how the mechanism is understood, SVG.")
def run(project: str, corrected: bool, scheme: Path | None) -> None:
    """Read and assemble PROJECT, tell what no pencil can draw; write nothing but a scheme asked for."""
    if scheme is not None and scheme.suffix.lower() != ".svg":
        raise click.UsageError(tell("--scheme {file}: expected a name that ends in .svg").format(file=scheme))
    from tmm_sheets.api import Opened

    opened = Opened(opening.read_variant(project, corrected))
    called = opened.project.variant.called
    for told in opened.check():
        click.echo(f"{called}: {told}", err=True)
    if scheme is not None:
        from tmm_sheets import files

        files.write_all({scheme: opened.scheme.svg.encode()})
    click.echo(tell("{project}: OK").format(project=called))
