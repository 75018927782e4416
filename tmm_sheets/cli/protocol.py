"""``protocol``: the steps as sentences."""

from __future__ import annotations

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, PROJECT
from tmm_sheets.localized_cli import command, option


@command("protocol")
@PROJECT
@CORRECTED
@option("--plan", "name", metavar="PLAN", help="Only this plan.")
@option("--all", "everything", is_flag=True, help="Also plans that nobody draws: of searches, and between the positions.")
def run(project: str, corrected: bool, name: str | None, everything: bool) -> None:
    """Say the construction steps of PROJECT as sentences, in the language of its sheets, with their millimetres."""
    from tmm_sheets import protocols

    for line in protocols.lines(opening.open_project(project, corrected, drawn=False), name, everything):
        click.echo(line)
