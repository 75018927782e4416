"""``compare``, ``plot``, ``bench``, ``stress``: a hand drawing beside the exact one, sheets on paper, the methods themselves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmm_sheets import files
from tmm_sheets.box import Box
from tmm_sheets.cli import argument, option
from tmm_sheets.cli.options import (
    CORRECTED,
    NO_CACHE,
    PROJECT,
    SHEETS,
    entered,
    folder_of,
    give,
    on_paper,
    open_project,
    plotter,
    refuse,
    repeatable,
    tell_all,
    titled,
)
from tmm_sheets.errors import CannotBuild
from tmm_sheets.terminal import Progress
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.compare.findings import Kind, Report
    from tmm_sheets.project import Project


# --- a hand drawing ----------------------------------------------------------------------------------------------------------

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
@repeatable
def run_compare(
    project: str, corrected: bool, template: bool, everything: bool, measured: Path | None, sheet: int | None,
    image: Path | None, read_numbers: bool, views: Path | None, dxf: Path | None, group: Path | None, marks: Path | None,
    pencil: float, reading: float, target: str | None, pages: tuple[Path, ...], output: Path | None,
) -> None:
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

    scheme = None
    if marks is not None or group is not None:
        from tmm_sheets.compare import group as whole

        scheme = None if marks is None else whole.read_scheme(marks)
    opened = open_project(project, corrected)
    folder = folder_of(opened.variant, output)
    with Progress() as progress:
        if template:
            from tmm_sheets.compare.measured import measured_lengths as by_ruler

            report = by_ruler.template(opened, folder, everything)
        elif group is not None:
            from tmm_sheets.api import compared

            def judged(kind: Kind, project: Project, sheet: int | None, path: Path) -> Report:
                return compared(project, kind, path, sheet, None, pencil, reading)

            name = opened.variant.called
            report = whole.compare(group, name, lambda other: opened if other == name else open_project(other, corrected), judged,
                                   scheme, progress.doing)
        else:
            from tmm_sheets.api import compared

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
    give(made)
    tell_all(opened.variant.called, report.notes)
    give(report.text, err=target == "-")
    if target == "-":
        give(report.as_json())
    for path in made:
        give(path, err=target == "-")



# --- sheets on paper ---------------------------------------------------------------------------------------------------------

def _window(context: click.Context, parameter: click.Parameter, value: str | None) -> Box | None:
    if value is None:
        return None
    try:
        x0, y0, x1, y1 = (float(part) for part in value.split(","))
    except ValueError:
        raise click.BadParameter(
            tell("expected x0,y0,x1,y1 in mm, such as 0,0,400,276, not '{value}'").format(value=value)
        ) from None
    return Box(x0, y0, x1, y1)


@argument("project", metavar="PROJECT|FILE")
@CORRECTED
@titled
@on_paper
@SHEETS
@option("--plotter", metavar="NAME", callback=plotter,
              help="Make plot files (HPGL) for a shipped plotter or that of a file; without it PDF.")
@option("--printer", metavar="NAME", help="Send to this printer of CUPS.")
@option("--tile", type=click.Choice(["a4", "a3"], case_sensitive=False), help="Cut the PDF into pages to glue together.")
@option("--overlap", type=float, default=10.0, show_default=True, metavar="MM", help="Overlap of tiles.")
@option("--bar", is_flag=True, help="Add a control bar of 100 mm, to be measured on paper.")
@option("--outline", type=click.Choice(["on", "off"]), default="on", show_default=True, callback=lambda *told: told[-1] == "on",
        help="Line round the paper.")
@option("--window", callback=_window, metavar="X0,Y0,X1,Y1", help="Only this part of the sheet, mm from its corner.")
@option("--preview", is_flag=True, help="Also a picture of each plot, made from the plot file itself.")
@option("--dpi", type=click.FloatRange(10, 1200), default=100, show_default=True, help="Dots per inch of the picture.")
@option("--ctb", is_flag=True, help="Also a plot style table for AutoCAD that prints every colour black.")
@option("--dry-run", is_flag=True, help="Tell what would be written and sent; do neither.")
@NO_CACHE
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR",
              help="Folder of the files.  [default: out/<project>]")  # fmt: skip
@repeatable
def run_plot(project: str, corrected: bool, sheets: tuple[int, ...], printer: str | None, preview: bool, dpi: float, ctb: bool,
             dry_run: bool, output: Path | None, **asked: Any) -> None:
    import shlex

    from tmm_sheets.drawing import plotters
    from tmm_sheets.output import plot as plotting

    look = plotting.PlotLook(**asked)
    refuse((look.plotter is not None and look.tile is not None,
            marked("--tile cuts a PDF; a plotter takes a sheet in parts with --window")))
    finished = project.lower().endswith(plotting.FILES)
    as_it_is = plotting.PlotLook(look.plotter, overlap=look.overlap)
    if finished and (sheets or look != as_it_is or entered()):
        raise click.UsageError(tell("{project} is finished: it can be sent or shown, not changed").format(project=project))
    problem, jobs = None, dict[Path, plotting.Job]()
    with Progress() as progress:
        if finished:
            folder = output if output is not None else Path(project).parent
            jobs = {Path(project): plotting.ready(Path(project))}
            made: dict[Path, bytes] = {}
        else:
            from tmm_sheets.sheets import pages, sheet

            opened = open_project(project, corrected)
            folder = folder_of(opened.variant, output)
            if not dry_run:
                files.check_folder(folder)
            attempt = sheet.every(opened, progress.doing, opened.variant.chosen(sheets))
            problem = attempt.problem()
            for n, composed in attempt.drawn.items():
                drawings, _ = pages.on_paper(opened, n, composed)
                for k, drawing in enumerate(drawings, 1):
                    job = plotting.job(drawing, f"sheet{n}-{k}" if len(drawings) > 1 else f"sheet{n}", look)
                    jobs[folder / job.name] = job
            made = {path: job.data for path, job in jobs.items()}
        for path, job in jobs.items() if preview else ():
            progress.say(tell("preview of {path} ...").format(path=path))
            made |= {folder / name: data for name, data in plotting.preview(job, look.plotter or plotters.plotter(), dpi).items()}
        if ctb:
            from tmm_sheets.backends import dxf

            made[folder / "black.ctb"] = dxf.plot_styles()
        if not dry_run:
            give(made)
    for path in dict.fromkeys((*jobs, *made)):
        give(path)
        for note in jobs[path].notes if path in jobs else ():
            give(f"    {note}")
    if printer is not None:
        for path, job in jobs.items():
            sent = shlex.join(plotting.command(job, path, printer))
            click.echo(tell("would send: {command}").format(command=sent) if dry_run else plotting.send(job, path, printer))
    if problem is not None:
        raise problem



# --- error and time of the methods, hard random mechanisms -------------------------------------------------------------------

@option("--json", "target", metavar="FILE", help="Also write the table as JSON, to standard output for -.")
@option("--plot", "folder", type=click.Path(path_type=Path), metavar="DIR", help="Also draw log-log diagrams, SVG.")
@option("--quick", is_flag=True, help="A few small runs only: tries the benchmark out.")
@option("--summary", is_flag=True, help="The first and the last run of each method only, in Markdown.")
def run_bench(target: str | None, folder: Path | None, quick: bool, summary: bool) -> None:
    from tmm_sheets.lab.bench import records

    if folder is not None:
        files.check_folder(folder)
    with Progress() as progress:
        found = records.run(quick, progress.doing)
    click.echo((records.summary if summary else records.table)(found), err=target == "-")
    made: dict[Path, bytes] = {}
    if target == "-":
        click.echo(records.as_json(found))
    elif target is not None:
        made[Path(target)] = (records.as_json(found) + "\n").encode()
    if folder is not None:
        made |= {folder / name: data for name, data in records.diagrams(found).items()}
    files.write_all(made)


@option("--cases", type=click.IntRange(1), default=900, show_default=True, metavar="N", help="How many random mechanisms.")
@option("--seed", type=click.IntRange(0), default=0, show_default=True, metavar="S", help="Seed of the random numbers.")
@option("--case", "single", type=click.IntRange(0), metavar="N", help="Only this case of the seed, again.")
def run_stress(cases: int, seed: int, single: int | None) -> None:
    from tmm_sheets.lab.stress import cases as stressed

    if single is not None:
        worst = stressed.run(1, seed, first=single, million=False)
    else:
        with Progress() as progress:
            worst = stressed.run(
                cases, seed, lambda case: progress.say(tell("case {case} of {cases} ...").format(case=case, cases=cases))
            )
    click.echo(stressed.table(worst, seed))
    failed = stressed.exceeded(worst)
    if failed:
        raise CannotBuild(
            tell("bound exceeded: {invariants}").format(invariants=", ".join(failed)), tell("the table names a case that shows it")
        )
