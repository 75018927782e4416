"""``why``: from the given numbers to a result."""

from __future__ import annotations

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, PROJECT
from tmm_sheets.localized_cli import argument, command


@command("why")
@PROJECT
@argument("result")
@CORRECTED
def run(project: str, result: str, corrected: bool) -> None:
    """Tell the steps from the given numbers of PROJECT to a RESULT, a path of solve --json such as flywheel.J_flywheel."""
    from tmm_sheets.record import why as reasons

    for line in reasons.lines(opening.open_project(project, corrected, drawn=False), result):
        click.echo(line)
