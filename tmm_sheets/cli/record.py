"""``record``: the record of a project."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, NO_CACHE, PROJECT, SHEETS
from tmm_sheets.localized_cli import command, option


@command("record")
@PROJECT
@CORRECTED
@SHEETS
@option("--json", "target", required=True, metavar="FILE", help="Write to FILE, or to standard output for -.")
@NO_CACHE
def run(project: str, corrected: bool, sheets: tuple[int, ...], target: str) -> None:
    """Write the record of PROJECT as JSON: every number with its step, every mark with what it shows."""
    from tmm_sheets.output.building import chosen
    from tmm_sheets.record import recording

    opened = opening.open_project(project, corrected)
    found, problem = recording.record(opened, chosen(opened.variant, sheets))
    text = recording.as_json(found)
    if target == "-":
        click.echo(text)
    else:
        from tmm_sheets import files

        files.write_all({Path(target): (text + "\n").encode()})
    if problem is not None:
        raise problem
