"""``check``, ``show``, ``solve``, ``why``, ``protocol``, ``record``: what is read off a project; no sheet is kept."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets import files
from tmm_sheets.cli.options import (
    CORRECTED,
    NO_CACHE,
    PARTS,
    PROJECT,
    SHEETS,
    among,
    open_project,
    read_variant,
    refuse,
    title_names,
)
from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.files import MOST_POSITIONS
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.words import marked, tell


@command("check")
@PROJECT
@CORRECTED
@option("--scheme", type=click.Path(path_type=Path), metavar="FILE", help="Draw how the mechanism is understood, SVG.")
def run_check(project: str, corrected: bool, scheme: Path | None) -> None:
    """Read and assemble PROJECT, tell what no pencil can draw; write nothing but a scheme asked for."""
    if scheme is not None and scheme.suffix.lower() != ".svg":
        raise click.UsageError(tell("--scheme {file}: expected a name that ends in .svg").format(file=scheme))
    from tmm_sheets.api import Opened

    opened = Opened(read_variant(project, corrected))
    called = opened.project.variant.called
    for told in opened.check():
        click.echo(f"{called}: {told}", err=True)
    if scheme is not None:

        files.write_all({scheme: opened.scheme.svg.encode()})
    click.echo(tell("{project}: OK").format(project=called))


@command("show")
@PROJECT
@CORRECTED
@option("--file", "as_file", is_flag=True, help="The project file itself, to be changed and used as one's own.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="With --file: write it there.")
@option("--force", is_flag=True, help="With -o: overwrite a file that says something else.")
def run_show(project: str, corrected: bool, as_file: bool, output: Path | None, force: bool) -> None:
    """Show inputs with units and source, links, pairs, mobility W, Assur groups, formula of structure."""
    refuse((output is not None and not as_file, marked("-o goes with --file")))
    variant = read_variant(project, corrected, drawn=False)
    if output is not None:

        files.refuse_other(output, variant.text.encode(), force)
        files.write_all({output: variant.text.encode()})
        click.echo(output)
    elif as_file:
        click.echo(variant.text, nl=False)
    else:
        from tmm_sheets import summary

        click.echo(summary.text(variant, title_names()))


def _degrees(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[float, ...] | None:
    if value is None:
        return None
    from tmm_sheets.task import units

    try:
        return tuple(units.parse(f"{part.strip()} deg", units.ANGLE) for part in value.split(","))
    except ValueError:
        raise click.BadParameter(
            tell("expected angles in degrees with commas between, such as 0,30.5,60, not '{value}'").format(value=value)
        ) from None


@command("solve")
@PROJECT
@CORRECTED
@option("--json", "target", metavar="FILE", help="Write JSON to FILE, or to standard output for -.")
@option("--npz", "arrays", metavar="FILE", type=click.Path(path_type=Path), help="Write arrays to FILE, for numpy.load.")
@option("--csv", "table", metavar="FILE", type=click.Path(path_type=Path), help="Write a table to FILE, a row for each position.")
@option("--phi", callback=_degrees, metavar="DEG,DEG", help="Crank angles, counter-clockwise from the x axis.")
@option("--positions", type=click.IntRange(1, MOST_POSITIONS), metavar="N",
              help="N equal parts of the turn from position 0 on, in the sense of rotation.")
@option("--part", "parts", callback=among((*PARTS, "scales")), metavar="P,P",
        help=f"Only these parts: {', '.join(PARTS)}, scales.")  # fmt: skip
def run_solve(
    project: str, corrected: bool, target: str | None, arrays: Path | None, table: Path | None, phi: tuple[float, ...] | None,
    positions: int | None, parts: tuple[str, ...] | None,
) -> None:
    """Compute the numbers of PROJECT; nothing is drawn."""
    refuse((phi is not None and positions is not None, marked("give either --phi or --positions, not both")))
    from tmm_sheets import result_files, results

    opened, refused = open_project(project, corrected, drawn=False), dict[str, CannotBuild]()
    found = results.told(opened, parts, phi=phi, positions=positions, refused=refused)
    for line in results.remarks(opened, found):
        click.echo(f"{opened.variant.called}: {line}", err=True)
    if target is None and arrays is None and table is None:
        click.echo(results.listing(result_files.plain_numbers(found)))
    else:
        from functools import partial


        if target == "-":
            for piece in result_files.json_pieces(found):
                click.echo(piece, nl=False)
            click.echo()
        writers = ((Path(target) if target not in (None, "-") else None, result_files.write_json), (arrays, result_files.write_npz),
                   (table, result_files.write_csv))
        files.write_all({path: partial(write, found) for path, write in writers if path is not None})
    if refused:
        raise together(refused, "computed", others=True)


@command("why")
@PROJECT
@argument("result")
@CORRECTED
def run_why(project: str, result: str, corrected: bool) -> None:
    """Tell the steps from the given numbers of PROJECT to a RESULT, a path of solve --json such as flywheel.J_flywheel."""
    from tmm_sheets.record import why as reasons

    for line in reasons.lines(open_project(project, corrected, drawn=False), result):
        click.echo(line)


@command("protocol")
@PROJECT
@CORRECTED
@option("--plan", "name", metavar="PLAN", help="Only this plan.")
@option("--all", "everything", is_flag=True, help="Also plans that nobody draws: of searches, and between the positions.")
def run_protocol(project: str, corrected: bool, name: str | None, everything: bool) -> None:
    """Say the construction steps of PROJECT as sentences, in the language of its sheets, with their millimetres."""
    from tmm_sheets import protocols

    for line in protocols.lines(open_project(project, corrected, drawn=False), name, everything):
        click.echo(line)


@command("record")
@PROJECT
@CORRECTED
@SHEETS
@option("--json", "target", required=True, metavar="FILE", help="Write to FILE, or to standard output for -.")
@NO_CACHE
def run_record(project: str, corrected: bool, sheets: tuple[int, ...], target: str) -> None:
    """Write the record of PROJECT as JSON: every number with its step, every mark with what it shows."""
    from tmm_sheets.record import recording

    opened = open_project(project, corrected)
    found, problem = recording.record(opened, opened.variant.chosen(sheets))
    text = recording.as_json(found)
    if target == "-":
        click.echo(text)
    else:

        files.write_all({Path(target): (text + "\n").encode()})
    if problem is not None:
        raise problem
