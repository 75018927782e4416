"""``solve``: the numbers."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, MOST_POSITIONS, PARTS, PROJECT, among
from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.localized_cli import command, option
from tmm_sheets.words import tell


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
def run(
    project: str, corrected: bool, target: str | None, arrays: Path | None, table: Path | None, phi: tuple[float, ...] | None,
    positions: int | None, parts: tuple[str, ...] | None,
) -> None:
    """Compute the numbers of PROJECT; nothing is drawn."""
    if phi is not None and positions is not None:
        raise click.UsageError(tell("give either --phi or --positions, not both"))
    from tmm_sheets import result_files, results

    opened, refused = opening.open_project(project, corrected, drawn=False), dict[str, CannotBuild]()
    found = results.told(opened, parts, phi=phi, positions=positions, refused=refused)
    for line in results.remarks(opened, found):
        click.echo(f"{opened.variant.called}: {line}", err=True)
    if target is None and arrays is None and table is None:
        click.echo(results.listing(result_files.plain_numbers(found)))
    else:
        from functools import partial

        from tmm_sheets import files

        if target == "-":
            for piece in result_files.json_pieces(found):
                click.echo(piece, nl=False)
            click.echo()
        writers = ((Path(target) if target not in (None, "-") else None, result_files.write_json), (arrays, result_files.write_npz),
                   (table, result_files.write_csv))
        files.write_all({path: partial(write, found) for path, write in writers if path is not None})
    if refused:
        raise together(refused, "computed", others=True)
