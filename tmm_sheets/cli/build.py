"""``build``, ``watch``, ``roster``, ``note``, ``page``, ``serve``, ``optimise``: what is made of one project or of many."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmm_sheets import catalogue, encodings, files, quoting, words
from tmm_sheets.cli import again, argument, option
from tmm_sheets.cli.options import (
    CORRECTED,
    DASK,
    JOBS,
    NO_CACHE,
    PROJECT,
    REMAKE,
    SHEETS,
    TITLE,
    among,
    entered,
    finish,
    folder_of,
    formats_of,
    give,
    on_paper,
    open_project,
    plotter,
    put,
    read_variant,
    refuse,
    repeatable,
    tell_all,
    title_names,
    titled,
)
from tmm_sheets.errors import BadInput, CannotBuild, Problem, reason_of
from tmm_sheets.files import MOST_POSITIONS
from tmm_sheets.output import build_store
from tmm_sheets.output.building import Order, build
from tmm_sheets.terminal import Bar, Progress, Stopwatch
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.plotters import Plotter
    from tmm_sheets.output.batch import Outcome
    from tmm_sheets.project import Project


# --- sheets, once or each time their file is saved ---------------------------------------------------------------------------

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
@option("--plotter", metavar="NAME", callback=plotter,
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
    projects: tuple[str, ...], families: tuple[str, ...], lists: tuple[str, ...], dpi: float, plotter: Plotter | None, text: str,
    **asked: Any,
) -> None:
    order = Order(**asked, settings={"png": {"dpi": dpi}, "hpgl": {"machine": plotter}, "dxf": {"text": text},
                                     "pdf": {"date": files.source_date()}})  # fmt: skip
    single = len(projects) == 1 and not families and not lists
    refuse(
        (not (projects or families or lists), marked("Missing argument 'PROJECT'; or give --all FAMILY, or --list FILE.")),
        (order.one_file and "pdf" not in order.formats, marked("--one-file is for PDF: add pdf to --format")),
        (single and (order.jobs is not None or order.scheduler is not None), marked("--jobs and --dask are for several projects")),
        (single and order.with_note and order.archive, marked("--with-note writes into a folder: leave --zip out")),
        (single and order.views and order.archive, marked("--views writes into a folder: leave --zip out")),
        (not single and (order.views or order.show_files), marked("--views and --open are for one project")),
        (not single and order.with_note, marked("--with-note is for one project")),
        (not single and order.explain, marked("--explain is for one project")),
    )
    order = order if order.output is None else replace(order, output=build_store.place(order.output))
    if single:
        build_one(projects[0], order)
    else:
        _build_many(projects, families, lists, replace(order, names=title_names()))


def _build_many(projects: tuple[str, ...], families: tuple[str, ...], lists: tuple[str, ...], order: Order) -> None:
    from time import monotonic

    from tmm_sheets.output import batch

    names = batch.chosen(projects, families, [_listed(file) for file in lists])
    if not names:
        raise BadInput(tell("no projects to build"), hint=tell("the list is empty"))
    build_store.outlet(order.parent).check()
    start = monotonic()
    done, ended = come_of(batch.on(batch.tasks(names), order), len(names))
    for outcome in sorted(done, key=lambda o: o.project):
        for warning in outcome.warnings:
            click.echo(f"{outcome.project}: {warning}", err=True)
    click.echo(batch.summary(done, order.parent, monotonic() - start))
    failures = [outcome for outcome in done if outcome.problem]
    ended(batch.table(failures, len(names)) if failures else "")


def _listed(file: str) -> list[str]:
    """Lines of a list of projects, of standard input for -."""
    import sys


    hint = marked("a list names a project in each line, in UTF-8")
    try:
        data = sys.stdin.buffer.read() if file == "-" else files.content(Path(file))
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=reason_of(e)), file, hint=tell(hint))) from None
    return encodings.cleaned(encodings.decoded(data, file, hint).text).splitlines()


def build_one(project: str, order: Order) -> None:
    """Build the sheets of one project and what goes with them, and tell the files and what is to be said of them."""
    from contextlib import nullcontext

    question = again.question(project, asked := {**vars(order), "output": None, TITLE: entered()})
    if (known := again.found(question)) is not None:
        called, folder, doubts, warnings, *afresh = known
        outlet = order.outlet(order.output or order.parent / folder)
        if (made := build_store.put_again(outlet, *afresh)) is not None:
            tell_all(called, doubts)
            finish(called, map(outlet.path, afresh[0]), warnings if made else _unchanged(len(afresh[0]), 0))
            return
    watch = Stopwatch()
    with watch.phase(tell("read")):
        variant = read_variant(project, order.corrected)
    folder = folder_of(variant, order.output)
    outlet = order.outlet(folder)
    if order.explain:
        from tmm_sheets.explain import listening
    paths, warnings = tuple[Path, ...](), tuple[str, ...]()
    try:
        with Progress() as progress, listening() if order.explain else nullcontext() as askers:
            if order.with_note:
                from tmm_sheets.note import note as writing

                words.set_paper(words.of_project(variant.project.language))
                with watch.phase(tell("pages of the note")):
                    variant = writing.run_on(variant, progress.doing)
            built = build(variant, order, outlet, watch, progress.doing)
            paths, warnings = built.paths, built.warnings
            if order.with_note:
                with watch.phase(tell("note")):
                    written = writing.write(built.opened, ("pdf",), progress.doing)
                    noted, kept = put(folder, written.files, order.force)
                paths += noted
                warnings += (*kept, *(tell("left out: {problem}").format(problem=problem) for problem in written.problems))
            if order.views:
                pictured, kept = put(folder / "views", _pictures(built.opened, order), order.force)
                paths += pictured
                warnings += tuple(kept)
    finally:  # what is there is told, whatever became of the rest
        for path in paths:
            click.echo(path)
    if order.show_files and paths:
        shown = paths[0] if len(paths) == 1 else paths[0].parent
        if click.launch(str(shown)):
            warnings += (tell("{path} cannot be opened here: open it yourself").format(path=shown),)
    if built.afresh:
        again.keep(question, project, asked, (variant.called, folder_of(variant, None).name, [*map(str, variant.warnings)],
                                              [*map(str, warnings)], *built.afresh))
    tell_all(variant.called, (*warnings, *_unchanged(len(built.paths), len(built.sizes))))
    if askers is not None:
        from tmm_sheets import explain as report

        click.echo(report.text(built.opened, built.drawings, watch, askers))
    finish(variant.called, (), (), built.refused)


def _unchanged(count: int, made: int) -> list[str]:
    """How many of so many files are as they were, if any."""
    return [tell("{n} of {m} files unchanged (--force makes them again)").format(n=count - made, m=count)] if count > made else []


def _pictures(opened: Project, order: Order) -> dict[str, bytes]:
    """Pictures of the views of the sheets that were asked for and can be drawn."""
    from tmm_sheets.output import view_pictures
    from tmm_sheets.sheets import sheet

    formats = [form for form in order.formats if form in view_pictures.FORMATS] or ["svg"]
    drawn = sheet.attempt(opened, opened.variant.chosen(order.sheets)).drawn
    dpi = order.settings["png"]["dpi"]
    return {name: data for n, composed in drawn.items() for name, data in view_pictures.of_sheet(n, composed, formats, dpi)}


@PROJECT
@CORRECTED
@titled
@SHEETS
@formats_of("pdf")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the sheets.  [default: out/<project>]")
def run_watch(project: str, **asked: Any) -> None:
    from tmm_sheets.task import title_entries

    if catalogue.is_shipped(project):
        raise click.UsageError(tell("{project} is a shipped project, which nobody changes: {command}").format(
            project=project, command=quoting.command("new", "my", "--from", project)))
    path = catalogue.located(project)
    click.echo(tell("watching {file}, Ctrl-C ends it").format(file=path), err=True)

    def draw(file: str | Path) -> None:
        build_one(str(file), Order(**asked))

    for _ in files.saved((path, path.parent / title_entries.FILE)):
        try:
            draw(project)
        except BrokenPipeError:
            raise  # nobody listens
        except Exception as e:
            from tmm_sheets import defects

            click.echo(defects.told(e, ("watch", project), path, draw), err=True)


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
def run_roster(table: Path, task: str, output: Path, **asked: Any) -> None:
    from tmm_sheets.output import batch, roster as rosters

    students = rosters.read(table, task)
    output = build_store.place(output)
    build_store.outlet(output).check()
    order = Order(**asked, output=output, settings={"pdf": {"date": files.source_date()}}, names=title_names())
    works = [batch.Task(s.project, s.folder, s.student, s.group) for s in students]
    came, ended = come_of(batch.on(works, order), len(works))
    done = {outcome.folder: outcome for outcome in came}
    written, hand = put(output, rosters.lists(students, done, output), order.force)
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



# --- what is made of a project besides its sheets ----------------------------------------------------------------------------

NOTE_FORMATS = ("pdf", "docx")
"""Formats of the explanatory note."""
RED = (0.8, 0.0, 0.0)
"""Colour of what is laid over a sheet, shares of red, green and blue."""


@PROJECT
@CORRECTED
@SHEETS
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the overlays.  [default: out/<project>]")
@option("--force", is_flag=True, help="Overwrite what was changed by hand.")
@NO_CACHE
def run_defence(project: str, corrected: bool, sheets: tuple[int, ...], output: Path | None, force: bool) -> None:
    from tmm_sheets.backends.pdf import render_coloured
    from tmm_sheets.record.defence import defended

    opened = open_project(project, corrected)
    folder = folder_of(opened.variant, output)
    files.check_folder(folder)
    found, problem = defended(opened, opened.variant.chosen(sheets))
    paths, kept = put(folder, {f"overlay{n}.pdf": render_coloured([(of.overlay, RED)]) for n, of in found.items()}, force)
    for n, of in found.items():
        click.echo("\n".join(of.said(n)))
    finish(opened.variant.called, paths, kept, problem)


@PROJECT
@CORRECTED
@titled
@option("--format", "formats", default="pdf", show_default=True, callback=among(NOTE_FORMATS), metavar="F,F",
        help=f"Formats: {', '.join(NOTE_FORMATS)}.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the note.  [default: out/<project>]")
@option("--force", is_flag=True, help="Overwrite what was changed by hand.")
@NO_CACHE
def run_note(project: str, corrected: bool, formats: tuple[str, ...], output: Path | None, force: bool) -> None:
    from tmm_sheets.note import note as writing

    writing.check(formats)
    opened = open_project(project, corrected)
    folder = folder_of(opened.variant, output)
    files.check_folder(folder)
    with Progress() as progress:
        written = writing.write(opened, formats, progress.doing)
        paths, kept = put(folder, written.files, force)
    left_out = (tell("left out: {problem}").format(problem=problem) for problem in written.problems)
    finish(opened.variant.called, paths, (*kept, *left_out, *(opened.dead_positions if opened.variant.crank is not None else ())))


@PROJECT
@CORRECTED
@SHEETS
@option("--plan", "plan", default="", metavar="NAME", help="Open with this plan.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE",
        help="File of the page.  [default: out/<project>/page.html]")
@NO_CACHE
@repeatable
def run_page(project: str, corrected: bool, sheets: tuple[int, ...], plan: str, output: Path | None) -> None:
    from tmm_sheets.living.page import page as living_page
    opened = open_project(project, corrected)
    found, problem = living_page(opened, opened.variant.chosen(sheets), plan)
    path = output if output is not None else folder_of(opened.variant, None) / "page.html"
    give({path: found.encode()})
    finish(opened.variant.called, [path], (), problem)


@argument("project", required=False)
@CORRECTED
@option("--watch", "followed", type=click.Path(path_type=Path), metavar="FILE",
        help="Show this project file, anew each time it is saved.")
@option("--host", default="127.0.0.1", show_default=True, help="Address to listen at: another one lets other machines in.")
@option("--port", type=click.IntRange(1, 65535), metavar="N", help="Port to listen at.  [default: 8731, or a free one]")
@option("--no-browser", is_flag=True, help="Tell the address only.")
@NO_CACHE
def run_serve(project: str | None, corrected: bool, followed: Path | None, host: str, port: int | None, no_browser: bool) -> None:
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
    finish(opened.project.variant.called, made)
