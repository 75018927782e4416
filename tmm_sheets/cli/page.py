"""``page``: the living sheet."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, NO_CACHE, PROJECT, SHEETS
from tmm_sheets.localized_cli import command, option


@command("page")
@PROJECT
@CORRECTED
@SHEETS
@option("--plan", "plan", default="", metavar="NAME", help="Open with this plan.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE",
        help="File of the page.  [default: out/<project>/page.html]")
@NO_CACHE
def run(project: str, corrected: bool, sheets: tuple[int, ...], plan: str, output: Path | None) -> None:
    """Write the living sheet of PROJECT: one page without network, in which its plans are drawn, turned, changed and asked."""
    from tmm_sheets import files
    from tmm_sheets.living.page import page as living_page
    from tmm_sheets.output.building import chosen

    opened = opening.open_project(project, corrected)
    found, problem = living_page(opened, chosen(opened.variant, sheets), plan)
    path = output if output is not None else opening.folder_of(opened.variant, None) / "page.html"
    files.write_all({path: found.encode()})
    click.echo(path)
    if problem is not None:
        raise problem
