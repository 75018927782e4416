"""``serve``: the page in the browser."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli.options import CORRECTED, NO_CACHE
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.words import tell


@command("serve")
@argument("project", required=False)
@CORRECTED
@option("--watch", "followed", type=click.Path(path_type=Path), metavar="FILE",
        help="Show this project file, anew each time it is saved.")
@option("--host", default="127.0.0.1", show_default=True, help="Address to listen at: another one lets other machines in.")
@option("--port", type=click.IntRange(1, 65535), metavar="N", help="Port to listen at.  [default: 8731, or a free one]")
@option("--no-browser", is_flag=True, help="Tell the address only.")
@NO_CACHE
def run(project: str | None, corrected: bool, followed: Path | None, host: str, port: int | None, no_browser: bool) -> None:
    """Serve a page in the browser, until Ctrl-C: choose a task, change it, take what is made of it, check drawings."""
    from tmm_sheets.page import serving

    serving.check_packages()
    if project is not None and followed is not None:
        raise click.UsageError(tell("give either PROJECT or --watch FILE, not both"))
    from tmm_sheets.page import shown

    opens = (shown.following(followed) if followed is not None else shown.of(project, corrected) if project is not None
             else shown.Shown())

    def tell_address(address: str) -> None:
        click.echo(address)
        click.echo(tell("Ctrl-C ends it"), err=True)
        if not no_browser and click.launch(address):
            click.echo(tell("no browser can be opened here: open the address yourself"), err=True)

    serving.serve(opens, host, port, tell_address)
