"""``plot``: the sheets on paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmm_sheets import files
from tmm_sheets.box import Box
from tmm_sheets.cli.options import CORRECTED, NO_CACHE, SHEETS, TITLE, folder_of, on_paper, open_project, plotter, refuse, titled
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.progress import Progress
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.plotters import Plotter


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


@command("plot")
@argument("project", metavar="PROJECT|FILE")
@CORRECTED
@titled
@on_paper
@SHEETS
@option("--plotter", "machine", metavar="NAME", callback=plotter,
              help="Make plot files (HPGL) for a shipped plotter or that of a file; without it PDF.")
@option("--printer", metavar="NAME", help="Send to this printer of CUPS.")
@option("--tile", type=click.Choice(["a4", "a3"], case_sensitive=False), help="Cut the PDF into pages to glue together.")
@option("--overlap", type=float, default=10.0, show_default=True, metavar="MM", help="Overlap of tiles.")
@option("--bar", is_flag=True, help="Add a control bar of 100 mm, to be measured on paper.")
@option("--outline", type=click.Choice(["on", "off"]), default="on", show_default=True, help="Line round the paper.")
@option("--window", callback=_window, metavar="X0,Y0,X1,Y1", help="Only this part of the sheet, mm from its corner.")
@option("--preview", is_flag=True, help="Also a picture of each plot, made from the plot file itself.")
@option("--dpi", type=click.FloatRange(10, 1200), default=100, show_default=True, help="Dots per inch of the picture.")
@option("--ctb", is_flag=True, help="Also a plot style table for AutoCAD that prints every colour black.")
@option("--dry-run", is_flag=True, help="Tell what would be written and sent; do neither.")
@NO_CACHE
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR",
              help="Folder of the files.  [default: out/<project>]")  # fmt: skip
def run_plot(
    project: str, corrected: bool, sheets: tuple[int, ...], machine: Plotter | None, printer: str | None, tile: str | None,
    overlap: float, bar: bool, outline: str, window: Box | None, preview: bool, dpi: float, ctb: bool, dry_run: bool,
    output: Path | None,
) -> None:
    """Put the sheets of PROJECT on paper, 1:1, or send a FILE made before (.plt, .pdf)."""
    refuse((machine is not None and tile is not None, marked("--tile cuts a PDF; a plotter takes a sheet in parts with --window")))
    import shlex

    from tmm_sheets.drawing import plotters
    from tmm_sheets.output import plot as plotting

    finished = project.lower().endswith(plotting.FILES)
    if finished and any((sheets, tile, bar, window, outline == "off", click.get_current_context().meta.get(TITLE))):
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
            look = plotting.PlotLook(machine, tile, overlap, bar, outline == "on", window)
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
            made |= {folder / name: data for name, data in plotting.preview(job, machine or plotters.plotter(), dpi).items()}
        if ctb:
            from tmm_sheets.backends import dxf

            made[folder / "black.ctb"] = dxf.plot_styles()
        if not dry_run:
            files.write_all(made)
    for path in dict.fromkeys((*jobs, *made)):
        click.echo(path)
        for note in jobs[path].notes if path in jobs else ():
            click.echo(f"    {note}")
    if printer is not None:
        for path, job in jobs.items():
            sent = shlex.join(plotting.command(job, path, printer))
            click.echo(tell("would send: {command}").format(command=sent) if dry_run else plotting.send(job, path, printer))
    if problem is not None:
        raise problem
