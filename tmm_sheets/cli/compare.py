"""``compare``: a hand drawing beside the exact one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmm_sheets import files
from tmm_sheets.cli.options import CORRECTED, NO_CACHE, PROJECT, folder_of, open_project, refuse
from tmm_sheets.errors import CannotBuild
from tmm_sheets.localized_cli import command, option
from tmm_sheets.progress import Progress
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.compare.findings import Kind, Report
    from tmm_sheets.project import Project


@command("compare")
@PROJECT
@CORRECTED
@option("--template", is_flag=True, help="Write a CSV file with a line for each main number of the sheets, to be filled in.")
@option("--all", "everything", is_flag=True, help="With --template: a line for everything that can be measured.")
@option("--measured", type=click.Path(path_type=Path), metavar="FILE", help="Compare the numbers of such a file.")
@option("--sheet", "sheet", type=int, metavar="N", help="Number of the sheet in the image or the drawing.")
@option("--image", type=click.Path(path_type=Path), metavar="FILE", help="Compare a photograph or scan: jpg, png, pdf.")
@option("--read-numbers", is_flag=True, help="With --image: also read the numbers of tables and positions (extra ocr).")
@option("--views", type=click.Path(path_type=Path), metavar="FILE",
              help="Where the views stand in the image or the drawing, when its layout is its own.")
@option("--dxf", type=click.Path(path_type=Path), metavar="FILE", help="Compare a CAD drawing.")
@option("--group", type=click.Path(path_type=Path), metavar="FOLDER",
              help="Compare the work of a whole group: a folder in it for each student.")
@option("--marks", type=click.Path(path_type=Path), metavar="FILE", help="What each fault costs, for marks.")
@option("--pencil", type=click.FloatRange(0.01, 5), default=0.25, show_default=True, metavar="MM",
              help="Error of a point drawn by hand.")
@option("--reading", type=click.FloatRange(0.01, 5), default=0.5, show_default=True, metavar="MM",
              help="Error of a length read off a ruler.")
@option("--json", "target", metavar="FILE", help="Also write the outcome as JSON, to standard output for -.")
@option("--report", "pages", type=click.Path(path_type=Path), multiple=True, metavar="FILE",
              help="Also write the report with pictures: .html (one self-contained page) or .pdf; may be given twice.")
@NO_CACHE
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR",
              help="Folder of the template and the overlays.  [default: out/<project>]")  # fmt: skip
def run_compare(
    project: str, corrected: bool, template: bool, everything: bool, measured: Path | None, sheet: int | None,
    image: Path | None, read_numbers: bool, views: Path | None, dxf: Path | None, group: Path | None, marks: Path | None,
    pencil: float, reading: float, target: str | None, pages: tuple[Path, ...], output: Path | None,
) -> None:
    """Compare a hand drawing of PROJECT with the exact one: measured lengths, a photograph or a CAD drawing."""
    refuse(
        (sum((template, measured is not None, image is not None, dxf is not None, group is not None)) != 1,
         marked("give one of --template, --measured FILE, --image FILE, --dxf FILE and --group FOLDER")),
        (marks is not None and template, marked("--marks goes with what is compared")),
        (everything and not template, marked("--all goes with --template")),
        (read_numbers and image is None, marked("--read-numbers goes with --image FILE")),
    )
    for path in pages:
        if path.suffix.lower() not in (".html", ".pdf"):
            raise click.UsageError(tell("--report {file}: expected a name that ends in .html or .pdf").format(file=path))

    from tmm_sheets.api import compared
    from tmm_sheets.compare import group as whole

    scheme = None if marks is None else whole.read_scheme(marks)
    opened = open_project(project, corrected)
    folder = folder_of(opened.variant, output)
    with Progress() as progress:
        if template:
            from tmm_sheets.compare.measured import measured_lengths as by_ruler

            report = by_ruler.template(opened, folder, everything, progress.doing)
        elif group is not None:
            def judged(kind: Kind, project: Project, sheet: int | None, path: Path) -> Report:
                return compared(project, kind, path, sheet, None, pencil, reading)

            name = opened.variant.called
            report = whole.compare(group, name, lambda other: opened if other == name else open_project(other, corrected), judged,
                                   scheme, progress.doing)
        else:
            kinds: dict[Kind, Path | None] = {"measured": measured, "image": image, "dxf": dxf}
            ((kind, drawing),) = [(kind, file) for kind, file in kinds.items() if file is not None]
            try:
                report = compared(opened, kind, drawing, sheet, views, pencil, reading, read_numbers, progress.doing)
            except CannotBuild as e:
                files.write_all({folder / name: data for name, data in e.files.items()})
                for name in e.files:
                    click.echo(folder / name, err=True)
                raise
            if scheme is not None:
                report = whole.with_mark(report, scheme)
    made = {folder / name: data for name, data in report.files.items()}
    if target is not None and target != "-":
        made[Path(target)] = (report.as_json() + "\n").encode()
    if pages:
        from tmm_sheets.compare.report_pages import page

        name = opened.variant.project.name
        made |= {path: page(report, path.suffix.lower(), name, files.seen_from(path, folder)) for path in pages}
    files.write_all(made)
    for note in report.notes:
        click.echo(f"{opened.variant.called}: {note}", err=True)
    click.echo(report.text, err=target == "-")
    if target == "-":
        click.echo(report.as_json())
    for path in made:
        click.echo(path, err=target == "-")
