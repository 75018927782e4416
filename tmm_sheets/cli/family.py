"""``family``: a family of tasks, tried."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.errors import CannotBuild
from tmm_sheets.localized_cli import argument, command, option


@command("family")
@argument("action", type=click.Choice(["check"]), metavar="check")
@argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@option("--quick", is_flag=True, help="Read the project files only; assemble nothing.")
def run(action: str, folder: Path, quick: bool) -> None:
    """Try a family of tasks, a folder with family.toml: read and assemble every cipher of every machine."""
    from tmm_sheets.output import family_check
    from tmm_sheets.progress import Progress

    with Progress() as progress:
        found = [*family_check.tried(folder, quick, lambda what: progress.say(f"{what} ..."))]
    told = family_check.table(found)
    if any(t.problem for t in found):
        raise CannotBuild(told)
    click.echo(told)
