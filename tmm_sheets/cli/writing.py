"""``note``, ``page``, ``serve``, ``optimise``: what is made of a project besides its sheets."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets import files
from tmm_sheets.cli.options import (
    CORRECTED,
    NO_CACHE,
    PROJECT,
    SHEETS,
    among,
    folder_of,
    open_project,
    put,
    read_variant,
    refuse,
    titled,
)
from tmm_sheets.files import MOST_POSITIONS
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.progress import Progress
from tmm_sheets.words import marked, tell

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
def run_note(project: str, corrected: bool, formats: tuple[str, ...], output: Path | None, force: bool) -> None:
    """Write the explanatory note of PROJECT: text, formulas, tables and figures from the record, ready to be printed."""
    from tmm_sheets.note import note as writing

    writing.check(formats)
    opened = open_project(project, corrected)
    folder = folder_of(opened.variant, output)
    files.check_folder(folder)
    with Progress() as progress:
        written = writing.write(opened, formats, progress.doing)
        paths, kept = put(folder, written.files, force)
    for path in paths:
        click.echo(path)
    for line in kept:
        click.echo(f"{opened.variant.called}: {line}", err=True)
    for problem in written.problems:
        click.echo(f"{opened.variant.called}: {tell('left out: {problem}').format(problem=problem)}", err=True)
    for dead in opened.dead_positions if opened.variant.crank is not None else ():
        click.echo(f"{opened.variant.called}: {dead}", err=True)


@command("page")
@PROJECT
@CORRECTED
@SHEETS
@option("--plan", "plan", default="", metavar="NAME", help="Open with this plan.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE",
        help="File of the page.  [default: out/<project>/page.html]")
@NO_CACHE
def run_page(project: str, corrected: bool, sheets: tuple[int, ...], plan: str, output: Path | None) -> None:
    """Write the living sheet of PROJECT: one page without network, in which its plans are drawn, turned, changed and asked."""
    from tmm_sheets.living.page import page as living_page
    opened = open_project(project, corrected)
    found, problem = living_page(opened, opened.variant.chosen(sheets), plan)
    path = output if output is not None else folder_of(opened.variant, None) / "page.html"
    files.write_all({path: found.encode()})
    click.echo(path)
    if problem is not None:
        raise problem


@command("serve")
@argument("project", required=False)
@CORRECTED
@option("--watch", "followed", type=click.Path(path_type=Path), metavar="FILE",
        help="Show this project file, anew each time it is saved.")
@option("--host", default="127.0.0.1", show_default=True, help="Address to listen at: another one lets other machines in.")
@option("--port", type=click.IntRange(1, 65535), metavar="N", help="Port to listen at.  [default: 8731, or a free one]")
@option("--no-browser", is_flag=True, help="Tell the address only.")
@NO_CACHE
def run_serve(project: str | None, corrected: bool, followed: Path | None, host: str, port: int | None, no_browser: bool) -> None:
    """Serve a page in the browser, until Ctrl-C: choose a task, change it, take what is made of it, check drawings."""
    from tmm_sheets.page import serving

    serving.check_packages()
    refuse((project is not None and followed is not None, marked("give either PROJECT or --watch FILE, not both")))
    from tmm_sheets.page import doors

    opens = (doors.followed_file(followed) if followed is not None else
             doors.shown_project(project, corrected) if project is not None else doors.Shown())

    def tell_address(address: str) -> None:
        click.echo(address)
        click.echo(tell("Ctrl-C ends it"), err=True)
        if not no_browser and click.launch(address):
            click.echo(tell("no browser can be opened here: open the address yourself"), err=True)

    serving.serve(opens, host, port, tell_address)


@command("optimise")
@PROJECT
@CORRECTED
@option("--vary", multiple=True, metavar="NAME=A..B",
        help="A number of the project file and its range, such as crank.length=70..90 mm; may be repeated.")
@option("--least", default="", metavar="WISH", help="What is to be least, such as max |cam.pressure_angle|.")
@option("--most", default="", metavar="WISH", help="What is to be greatest.")
@option("--subject-to", "bounds", multiple=True, metavar="BOUND",
        help="What has to hold, such as gear.eps_alpha >= 1.2; may be repeated.")
@option("--positions", type=click.IntRange(2, MOST_POSITIONS), default=120, show_default=True, metavar="N",
        help="Crank angles of a turn at which results are looked at.")
@option("--tries", type=click.IntRange(1), default=400, show_default=True, metavar="N", help="How many numbers are tried at most.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE",
        help="The project file with the best numbers; the search as a picture beside it.  [default: out/<project>/optimised.toml]")
@option("--force", is_flag=True, help="Overwrite a file that says something else.")
def run_optimise(project: str, corrected: bool, vary: tuple[str, ...], least: str, most: str, bounds: tuple[str, ...],
                 positions: int, tries: int, output: Path | None, force: bool) -> None:
    """Look for numbers of PROJECT that make a result least or greatest; write the project file with them."""
    from tmm_sheets.api import Opened

    opened = Opened(read_variant(project, corrected, drawn=False))
    path = output if output is not None else folder_of(opened.project.variant, None) / "optimised.toml"
    if path.suffix != ".toml":
        raise click.UsageError(tell("-o {file}: expected a name that ends in .toml").format(file=path))
    if output is not None:
        files.refuse_present(path, force)
    files.check_folder(path.parent)
    with Progress() as progress:
        found = opened.optimise(vary, least, most=most, subject_to=bounds, positions=positions, tries=tries,
                                say=lambda n: progress.say(tell("try {n} of {most} ...").format(n=n, most=tries)))
    click.echo(found)
    made = {path: found.opened.text.encode(), path.with_suffix(".svg"): found.svg.encode()}
    files.write_all(made)
    for at in made:
        click.echo(at)
