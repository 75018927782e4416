"""``build``, ``watch``, ``roster``: the sheets of one project or of many, once or each time their file is saved."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmm_sheets import catalogue, encodings, files, quoting, words
from tmm_sheets.cli.options import (
    CORRECTED,
    DASK,
    JOBS,
    NO_CACHE,
    PROJECT,
    REMAKE,
    SHEETS,
    folder_of,
    formats_of,
    on_paper,
    plotter,
    put,
    read_variant,
    refuse,
    title_names,
    titled,
)
from tmm_sheets.errors import BadInput, CannotBuild, Problem, reason_of
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.progress import Bar, Progress
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.plotters import Plotter
    from tmm_sheets.output.batch import Outcome
    from tmm_sheets.output.building import Order
    from tmm_sheets.project import Project


@command("build")
@argument("projects", metavar="PROJECT...", nargs=-1)
@option("--all", "families", multiple=True, metavar="FAMILY",
              help="All shipped projects of a family, such as sixbar, or of all.")
@option("--list", "lists", multiple=True, metavar="FILE",
              help="Projects named in a file, one a line; - for standard input.")
@CORRECTED
@titled
@on_paper
@SHEETS
@formats_of("dxf,pdf")
@option("--dpi", type=click.FloatRange(10, 1200), default=150, show_default=True, help="Dots per inch of PNG.")
@option("--plotter", "machine", metavar="NAME", callback=plotter,
              help="Plotter for HPGL: a shipped one or a file.  [default: a1]")
@option("--text", type=click.Choice(["live", "librecad", "strokes"]), default="live", show_default=True,
              help="Lettering and dashes of DXF: to be worked with, the same with our font for LibreCAD, or drawn exactly.")
@option("--one-file", is_flag=True, help="Put all sheets into one PDF, sheets.pdf.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR",
              help="Folder of the sheets, of several projects the folder with one for each.  [default: out/<project>]")
@option("--zip", "archive", is_flag=True, help="Put each project into a zip file instead of a folder.")
@REMAKE
@JOBS
@DASK
@NO_CACHE
@option("--with-note", is_flag=True, help="Also the explanatory note, note.pdf; the numbers of the sheets run on after its pages.")
@option("--views", is_flag=True, help="Also each view as a picture of its own, in the folder views: those of the formats that are "
              "svg, png or pdf.")
@option("--open", "show_files", is_flag=True, help="Open what was made: one file, or its folder.")
@option("--explain", is_flag=True, help="Also tell what was built and evaluated, and how long it took.")  # fmt: skip
def run_build(
    projects: tuple[str, ...], families: tuple[str, ...], lists: tuple[str, ...], corrected: bool, sheets: tuple[int, ...],
    formats: tuple[str, ...], dpi: float, machine: Plotter | None, text: str, one_file: bool, output: Path | None,
    archive: bool, force: bool, jobs: int | None, scheduler: str | None, with_note: bool, views: bool,
    show_files: bool, explain: bool,
) -> None:
    """Draw the sheets of one PROJECT or of several; what has not changed since the last time is not made again."""
    single = len(projects) == 1 and not families and not lists
    refuse(
        (not (projects or families or lists), marked("Missing argument 'PROJECT'; or give --all FAMILY, or --list FILE.")),
        (one_file and "pdf" not in formats, marked("--one-file is for PDF: add pdf to --format")),
        (single and (jobs is not None or scheduler is not None), marked("--jobs and --dask are for several projects")),
        (single and with_note and archive, marked("--with-note writes into a folder: leave --zip out")),
        (single and views and archive, marked("--views writes into a folder: leave --zip out")),
        (not single and (views or show_files), marked("--views and --open are for one project")),
        (not single and with_note, marked("--with-note is for one project")),
        (not single and explain, marked("--explain is for one project")),
    )
    from tmm_sheets.output.build_store import place
    from tmm_sheets.output.building import Order

    output = None if output is None else place(output)
    settings: dict[str, dict[str, Any]] = {"png": {"dpi": dpi}, "hpgl": {"machine": machine}, "dxf": {"text": text},
                                           "pdf": {"date": files.source_date()}}  # fmt: skip
    order = Order(sheets, formats, settings, corrected, force, archive, one_file, names=title_names())
    if single:
        build_one(projects[0], order, output, explain, with_note, views, show_files)
    else:
        _build_many(projects, families, lists, order, output or Path("out"), jobs, scheduler)


def _build_many(
    projects: tuple[str, ...], families: tuple[str, ...], lists: tuple[str, ...], order: Order, parent: Path,
    jobs: int | None, scheduler: str | None,
) -> None:
    from time import monotonic

    from tmm_sheets.output import batch, build_store

    names = batch.chosen(projects, families, [_listed(file) for file in lists])
    if not names:
        raise BadInput(tell("no projects to build"), hint=tell("the list is empty"))
    build_store.check(parent)
    start = monotonic()
    done, ended = come_of(batch.on(batch.tasks(names), order, parent, jobs, scheduler), len(names))
    for outcome in sorted(done, key=lambda o: o.project):
        for warning in outcome.warnings:
            click.echo(f"{outcome.project}: {warning}", err=True)
    click.echo(batch.summary(done, parent, monotonic() - start))
    failures = [outcome for outcome in done if outcome.problem]
    ended(batch.table(failures, len(names)) if failures else "")


def _listed(file: str) -> list[str]:
    """Lines of a list of projects, of standard input for -."""
    import sys


    hint = tell("a list names a project in each line, in UTF-8")
    try:
        data = sys.stdin.buffer.read() if file == "-" else files.content(Path(file))
        return encodings.cleaned(encodings.decoded(data).text).splitlines()
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=reason_of(e)), file, hint=hint)) from None
    except encodings.NotText as e:
        raise BadInput(Problem(str(e), file, e.line, hint=hint)) from None


def build_one(project: str, order: Order, output: Path | None, explain: bool = False, with_note: bool = False,
               views: bool = False, show_files: bool = False) -> None:
    """Build the sheets of one project and what goes with them, and tell the files and what is to be said of them."""
    from contextlib import nullcontext

    from tmm_sheets.output.building import build as build_project
    from tmm_sheets.progress import Stopwatch

    watch = Stopwatch()
    with watch.phase(tell("read")):
        variant = read_variant(project, order.corrected)
    folder = folder_of(variant, output)
    outlet = order.outlet(folder)
    if explain:
        from tmm_sheets.explain import listening
    paths, warnings = tuple[Path, ...](), tuple[str, ...]()
    try:
        with Progress() as progress, listening() if explain else nullcontext() as askers:
            if with_note:
                from tmm_sheets.note import note as writing

                words.set_paper(words.of_project(variant.project.language))
                with watch.phase(tell("pages of the note")):
                    variant = writing.run_on(variant, progress.doing)
            built = build_project(variant, order, outlet, watch, progress.doing)
            paths, warnings = built.paths, built.warnings
            if with_note:
                with watch.phase(tell("note")):
                    written = writing.write(built.opened, ("pdf",), progress.doing)
                    noted, kept = put(folder, written.files, order.force)
                paths += noted
                warnings += (*kept, *(tell("left out: {problem}").format(problem=problem) for problem in written.problems))
            if views:
                pictured, kept = put(folder / "views", _pictures(built.opened, order), order.force)
                paths += pictured
                warnings += tuple(kept)
    finally:  # what is there is told, whatever became of the rest
        for path in paths:
            click.echo(path)
    if show_files and paths:
        shown = paths[0] if len(paths) == 1 else paths[0].parent
        if click.launch(str(shown)):
            warnings += (tell("{path} cannot be opened here: open it yourself").format(path=shown),)
    for warning in warnings:
        click.echo(f"{variant.called}: {warning}", err=True)
    unchanged = len(built.paths) - len(built.sizes)
    if unchanged:
        told = tell("{n} of {m} files unchanged (--force makes them again)").format(n=unchanged, m=len(built.paths))
        click.echo(f"{variant.called}: {told}", err=True)
    if askers is not None:
        from tmm_sheets import explain as report

        click.echo(report.text(built.opened, built.drawings, watch, askers))
    if built.refused is not None:
        raise built.refused


def _pictures(opened: Project, order: Order) -> dict[str, bytes]:
    """Pictures of the views of the sheets that were asked for and can be drawn."""
    from tmm_sheets.output import view_pictures
    from tmm_sheets.sheets import sheet

    formats = [form for form in order.formats if form in view_pictures.FORMATS] or ["svg"]
    drawn = sheet.attempt(opened, opened.variant.chosen(order.sheets)).drawn
    dpi = order.settings["png"]["dpi"]
    return {name: data for n, composed in drawn.items() for name, data in view_pictures.of_sheet(n, composed, formats, dpi)}


@command("watch")
@PROJECT
@CORRECTED
@titled
@SHEETS
@formats_of("pdf")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the sheets.  [default: out/<project>]")
def run_watch(project: str, corrected: bool, sheets: tuple[int, ...], formats: tuple[str, ...], output: Path | None) -> None:
    """Draw the sheets of a project file each time it is saved, until Ctrl-C."""
    from tmm_sheets.output.building import Order
    from tmm_sheets.task import title_entries

    if catalogue.is_shipped(project):
        raise click.UsageError(tell("{project} is a shipped project, which nobody changes: {command}").format(
            project=project, command=quoting.command("new", "my", "--from", project)))
    path = catalogue.located(project)
    click.echo(tell("watching {file}, Ctrl-C ends it").format(file=path), err=True)

    def draw(file: str | Path) -> None:
        build_one(str(file), Order(sheets, formats, {}, corrected, names=title_names()), output)

    for _ in files.saved((path, path.parent / title_entries.FILE)):
        try:
            draw(project)
        except BrokenPipeError:
            raise  # nobody listens
        except Exception as e:
            from tmm_sheets import defects

            click.echo(defects.told(e, ("watch", project), path, draw), err=True)


@command("roster")
@argument("table", metavar="FILE", type=click.Path(path_type=Path))
@option("--task", default="", metavar="PROJECT", help="Task of those for whom the table names none, or a machine for its ciphers.")
@CORRECTED
@titled
@formats_of("dxf,pdf")
@option("-o", "--output", type=click.Path(path_type=Path), default=Path("out"), show_default=True, metavar="DIR",
        help="Folder with one for each student.")
@REMAKE
@JOBS
@DASK
@NO_CACHE
def run_roster(table: Path, task: str, corrected: bool, formats: tuple[str, ...], output: Path, force: bool, jobs: int | None,
               scheduler: str | None) -> None:
    """Make the work of a whole group: for each student of a CSV FILE sheets, note, living page, a table to fill in."""
    from tmm_sheets.output import batch, build_store
    from tmm_sheets.output import roster as rosters
    from tmm_sheets.output.build_store import place
    from tmm_sheets.output.building import Order

    students = rosters.read(table, task)
    output = place(output)
    build_store.check(output)
    settings: dict[str, dict[str, Any]] = {"pdf": {"date": files.source_date()}}
    order = Order((), formats, settings, corrected, force, names=title_names())
    works = [batch.Task(s.project, s.folder, s.student, s.group) for s in students]
    came, ended = come_of(batch.on(works, order, output, jobs, scheduler), len(works))
    done = {outcome.folder: outcome for outcome in came}
    written, hand = put(output, rosters.lists(students, done, output), force)
    for s in students:
        if s.renamed:
            click.echo(s.renamed, err=True)
        for warning in done[s.folder].warnings if s.folder in done else ():
            click.echo(f"{s.student}: {warning}", err=True)
    for line in hand:
        click.echo(line, err=True)
    click.echo(rosters.told(students, done))
    for path in written:
        click.echo(path)
    ended("\n".join(f"{s.student}: {done[s.folder].problem}" for s in students if s.folder in done and done[s.folder].problem))


def come_of(running: Iterable[Outcome], total: int) -> tuple[list[Outcome], Callable[[str], None]]:
    """Outcomes of a batch as they come, with a bar; and how the command ends when these are told, by what is said of failures."""
    done: list[Outcome] = []
    stopped: list[KeyboardInterrupt] = []
    try:
        with Bar(total) as bar:
            for outcome in running:
                done.append(outcome)
                bar.step(bool(outcome.problem))
    except KeyboardInterrupt as e:
        stopped.append(e)

    def ended(failures: str) -> None:
        if not stopped and failures:
            raise CannotBuild(failures)
        for e in stopped:
            click.echo("\n".join(filter(None, (failures, tell(
                "stopped, {n} of {total} projects left; the same command goes on from there").format(
                n=total - len(done), total=total)))), err=True)
            raise e

    return done, ended
