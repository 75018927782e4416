"""``optimise``: the best numbers."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, MOST_POSITIONS, PROJECT
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.localized_cli import command, option
from tmm_sheets.words import tell


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
def run(project: str, corrected: bool, vary: tuple[str, ...], least: str, most: str, bounds: tuple[str, ...], positions: int,
        tries: int, output: Path | None, force: bool) -> None:
    """Look for numbers of PROJECT that make a result least or greatest; write the project file with them."""
    from tmm_sheets import files
    from tmm_sheets.api import Opened
    from tmm_sheets.progress import Progress

    opened = Opened(opening.read_variant(project, corrected, drawn=False))
    path = output if output is not None else opening.folder_of(opened.project.variant, None) / "optimised.toml"
    if path.suffix != ".toml":
        raise click.UsageError(tell("-o {file}: expected a name that ends in .toml").format(file=path))
    if output is not None and path.exists() and not force:
        raise BadInput(Problem(tell("is there already; nothing was written"), str(path),
                               hint=tell("choose another name, or overwrite it with --force")))
    files.check_folder(path.parent)
    with Progress() as progress:
        found = opened.optimise(vary, least, most=most, subject_to=bounds, positions=positions, tries=tries,
                                say=lambda n: progress.say(tell("try {n} of {most} ...").format(n=n, most=tries)))
    click.echo(found)
    made = {path: found.opened.text.encode(), path.with_suffix(".svg"): found.svg.encode()}
    files.write_all(made)
    for at in made:
        click.echo(at)
