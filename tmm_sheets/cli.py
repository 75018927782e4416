"""The commands: arguments in, files and messages out; no mechanics. Everything heavy is imported where it is used."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmm_sheets import kept, quoting, spelling, words
from tmm_sheets.box import Box
from tmm_sheets.errors import BadInput, CannotBuild, Problem, reason_of, together
from tmm_sheets.localized_cli import Group, Option, argument, option
from tmm_sheets.version import __version__
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.compare.report import Kind, Report
    from tmm_sheets.drawing.plotters import Plotter
    from tmm_sheets.output.batch import Outcome
    from tmm_sheets.output.building import Order
    from tmm_sheets.output.plot import Job, PlotLook
    from tmm_sheets.progress import Progress
    from tmm_sheets.project import Project
    from tmm_sheets.task.title_entries import Names
    from tmm_sheets.task.variant import Variant

FORMATS = ("dxf", "pdf", "svg", "png", "hpgl")
"""Formats of drawings."""

NOTE_FORMATS = ("pdf", "docx")
"""Formats of the explanatory note."""

PARTS = ("positions", "velocities", "accelerations", "forces", "flywheel", "gear", "reducer", "train", "cam")
"""Parts of the results."""

MOST_POSITIONS = 1_000_000


def _among(known: tuple[str, ...]) -> Callable[[click.Context, click.Parameter, str | None], tuple[str, ...] | None]:
    """Reader of an option that holds several known words with commas between."""

    def split(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[str, ...] | None:
        if value is None:
            return None
        parts = tuple(dict.fromkeys(part.strip().lower() for part in value.split(",")))
        for part in parts:
            if part not in known:
                said = tell("'{part}' is not one of {known}").format(part=part, known=', '.join(known))
                near = spelling.near(part, known)
                raise click.BadParameter(f"{said}; " + tell("did you mean {near}?").format(near=near[0]) if near else said)
        return parts

    return split


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


def _plotter(context: click.Context, parameter: click.Parameter, value: str | None) -> Plotter | None:
    if value is None:
        return None
    from tmm_sheets.drawing import plotters

    try:
        return plotters.plotter(value)
    except ValueError as e:
        raise click.BadParameter(str(e)) from None


def _forgo(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        kept.forgo()


TITLE = "tmm_sheets.title"
"""Key under which a command's context keeps what its options fill title blocks in with."""


def _entered(context: click.Context, parameter: click.Parameter, value: str | None) -> None:
    if value is not None:
        if any(not (sign.isprintable() or sign.isspace()) for sign in value):
            raise click.BadParameter(tell("expected a text for the title block, without control characters"))
        context.meta.setdefault(TITLE, {})[parameter.name] = value


def titled(command: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: options for what stands in the title blocks."""
    for name, said in (
        ("designation", "Designation in the title blocks, without the code of the sheet."),
        ("institution", "Institution or department in the title blocks."),
        ("supervisor", "Head of the project in the title blocks."),
        ("group", "Group of students in the title blocks."),
        ("student", "Name of the student in the title blocks."),
    ):
        command = option(f"--{name}", metavar="TEXT", expose_value=False, callback=_entered, help=said)(command)
    return command


PROJECT = argument("project")
NO_CACHE = option("--no-cache", is_flag=True, expose_value=False, callback=_forgo,
                  help="Draw every sheet anew, without the drawings kept of earlier times.")  # fmt: skip
CORRECTED = option("--corrected", is_flag=True, help="With the suggested values instead of suspected misprints.")


@click.group(cls=Group, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(
    __version__, prog_name="tmm-sheets", message="%(prog)s %(version)s", cls=Option, help="Show the version and exit."
)
def commands() -> None:
    """Sheets of a course project in the theory of mechanisms and machines, drawn by compass and ruler.

    PROJECT is a shipped name, such as lugansk/shaper, or the path of a project file.
    """


@commands.command("list")
@argument("word", required=False)
@option("--json", "as_json", is_flag=True, help="As JSON.")
def list_projects(word: str | None, as_json: bool) -> None:
    """List the shipped projects; with a WORD those that have it in their names or titles."""
    from tmm_sheets import catalogue

    entries = catalogue.found(word) if word else catalogue.entries()
    if not entries:
        raise CannotBuild(tell('no shipped project has "{word}" in its name or title').format(word=word),
                          tell("{command} shows the shipped projects").format(command=quoting.command("list")))
    if as_json:
        import json
        from dataclasses import asdict

        click.echo(json.dumps([asdict(e) for e in entries], ensure_ascii=False, indent=1))
        return
    width = max((len(e.name) for e in entries), default=0)
    for e in entries:
        called = ", ".join(words.of_file(text, tell) for text in (e.title, e.variant) if text)
        click.echo(
            tell("{project}  {title}; sheets: {sheets}").format(
                project=f"{e.name:{width}}", title=called, sheets=", ".join(e.sheets)
            )
        )


@commands.command()
@PROJECT
@CORRECTED
@option("--file", "as_file", is_flag=True, help="The project file itself, to be changed and used as one's own.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="With --file: write it there.")
@option("--force", is_flag=True, help="With -o: overwrite a file that says something else.")
def show(project: str, corrected: bool, as_file: bool, output: Path | None, force: bool) -> None:
    """Show inputs with units and source, links, pairs, mobility W, Assur groups, formula of structure."""
    if output is not None and not as_file:
        raise click.UsageError(tell("-o goes with --file"))
    variant = _read(project, corrected, drawn=False)
    if output is not None:
        from tmm_sheets import files

        files.refuse_other(output, variant.text.encode(), force)
        files.write_all({output: variant.text.encode()})
        click.echo(output)
    elif as_file:
        click.echo(variant.text, nl=False)
    else:
        from tmm_sheets import summary

        click.echo(summary.text(variant, _names()))


def _asked(question: str) -> str:
    """What a person answers; nothing where nobody does."""
    import sys

    try:
        return " ".join(str(click.prompt(question, default="", show_default=False, err=True)).split())
    except (click.Abort, OSError):
        if sys.stdin is not None and sys.stdin.isatty():
            raise
        click.echo(err=True)
        return ""


@commands.command()
@argument("name")
@option("--from", "source", metavar="PROJECT", help="A copy of this project.")
@option("--groups", metavar="K,K", help="A crank with Assur groups of these kinds, 1 to 5, one on another.")
@option("--parts", metavar="P,P", help="Parts that stand alone: gear, reducer, cam.")
@CORRECTED
@titled
@option("--force", is_flag=True, help="Overwrite a file that says something else.")
def new(name: str, source: str | None, groups: str | None, parts: str | None, corrected: bool, force: bool) -> None:
    """Write a project file NAME.toml to begin with; what is not told (task, student, group) is asked."""
    if source is not None and (groups is not None or parts is not None):
        raise click.UsageError(tell("--from takes the whole of a project: leave --groups and --parts out"))
    from tmm_sheets import catalogue, files
    from tmm_sheets.task import new_file, title_entries, variant

    path = Path(name if name.endswith(catalogue.SUFFIX) else f"{name}{catalogue.SUFFIX}")
    files.check_folder(path.parent)
    if path.exists() and not force:
        raise BadInput(Problem(tell("is there already; nothing was written"), str(path),
                               hint=tell("choose another name, or overwrite it with --force")))
    if source is None and groups is None and parts is None:
        source = _asked(tell("Task: a shipped project, such as lugansk/shaper, or a project file"))
        if not source:
            raise click.UsageError(tell("give a task: --from PROJECT, --groups K,K or --parts P,P"))
    tables, read = "", None
    if source is not None:
        read = _read(source, corrected, drawn=False)
    else:
        tables = new_file.of_groups(_kinds(groups)) if groups is not None else ""
        tables += "\n" * bool(tables and parts) + new_file.of_parts(_words(parts)) if parts is not None else ""
    entries = dict(_names().options)
    known = {*title_entries.of_file(path.parent / title_entries.FILE), *_names().user}
    for key, question in (("student", tell("Student")), ("group", tell("Group"))):
        if key not in entries and key not in known and (answer := _asked(question)):
            entries[key] = answer
    text = (new_file.copied(read.text, path.stem, entries) if read is not None else
            new_file.whole(path.stem, path.stem, tables, entries))
    variant.parse(text, str(path))
    files.write_all({path: text.encode()})
    click.echo(path)


def _words(value: str) -> list[str]:
    return [part.strip().lower() for part in value.split(",") if part.strip()]


def _kinds(value: str) -> list[int]:
    try:
        return [int(part) for part in _words(value)]
    except ValueError:
        raise click.BadParameter(tell("expected kinds of groups from 1 to 5 with commas between, not {kinds}").format(kinds=value),
                                 param_hint="--groups") from None


@commands.command()
@PROJECT
@CORRECTED
@option("--scheme", type=click.Path(path_type=Path), metavar="FILE", help="Draw how the mechanism is understood, SVG.")
def check(project: str, corrected: bool, scheme: Path | None) -> None:
    """Read and assemble PROJECT, tell what no pencil can draw; write nothing but a scheme asked for."""
    if scheme is not None and scheme.suffix.lower() != ".svg":
        raise click.UsageError(tell("--scheme {file}: expected a name that ends in .svg").format(file=scheme))
    from tmm_sheets.api import Opened

    opened = Opened(_read(project, corrected))
    called = opened.project.variant.called
    for told in opened.check():
        click.echo(f"{called}: {told}", err=True)
    if scheme is not None:
        from tmm_sheets import files

        files.write_all({scheme: opened.scheme.svg.encode()})
    click.echo(tell("{project}: OK").format(project=called))


@commands.command()
@argument("projects", metavar="PROJECT...", nargs=-1)
@option("--all", "families", multiple=True, metavar="FAMILY",
              help="All shipped projects of a family, such as sixbar, or of all.")
@option("--list", "lists", multiple=True, metavar="FILE",
              help="Projects named in a file, one a line; - for standard input.")
@CORRECTED
@titled
@option("--sheet", "sheets", type=int, multiple=True, metavar="N", help="Only this sheet; may be repeated.")
@option("--format", "formats", default="dxf,pdf", show_default=True, callback=_among(FORMATS),
              metavar="F,F", help=f"Formats: {', '.join(FORMATS)}.")
@option("--dpi", type=click.FloatRange(10, 1200), default=150, show_default=True, help="Dots per inch of PNG.")
@option("--plotter", "machine", metavar="NAME", callback=_plotter,
              help="Plotter for HPGL: a shipped one or a file.  [default: a1]")
@option("--text", type=click.Choice(["live", "librecad", "strokes"]), default="live", show_default=True,
              help="Lettering and dashes of DXF: to be worked with, the same with our font for LibreCAD, or drawn exactly.")
@option("--one-file", is_flag=True, help="Put all sheets into one PDF, sheets.pdf.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR",
              help="Folder of the sheets, of several projects the folder with one for each.  [default: out/<project>]")
@option("--zip", "archive", is_flag=True, help="Put each project into a zip file instead of a folder.")
@option("--force", is_flag=True, help="Make again also what has not changed, and overwrite what was changed by hand.")
@option("--jobs", type=click.IntRange(1), metavar="N", help="Processes for several projects.  [default: all processors]")
@option("--dask", "scheduler", metavar="ADDRESS", help="Build several projects on a dask cluster.")
@NO_CACHE
@option("--with-note", is_flag=True, help="Also the explanatory note, note.pdf; the numbers of the sheets run on after its pages.")
@option("--views", is_flag=True, help="Also each view as a picture of its own, in the folder views: those of the formats that are "
              "svg, png or pdf.")
@option("--open", "show_files", is_flag=True, help="Open what was made: one file, or its folder.")
@option("--explain", is_flag=True, help="Also tell what was built and evaluated, and how long it took.")  # fmt: skip
def build(
    projects: tuple[str, ...], families: tuple[str, ...], lists: tuple[str, ...], corrected: bool, sheets: tuple[int, ...],
    formats: tuple[str, ...], dpi: float, machine: Plotter | None, text: str, one_file: bool, output: Path | None,
    archive: bool, force: bool, jobs: int | None, scheduler: str | None, with_note: bool, views: bool,
    show_files: bool, explain: bool,
) -> None:
    """Draw the sheets of one PROJECT or of several; what has not changed since the last time is not made again."""
    if not projects and not families and not lists:
        raise click.UsageError(tell("Missing argument 'PROJECT'; or give --all FAMILY, or --list FILE."))
    if one_file and "pdf" not in formats:
        raise click.UsageError(tell("--one-file is for PDF: add pdf to --format"))
    from tmm_sheets import files
    from tmm_sheets.output.building import Order

    settings: dict[str, dict[str, Any]] = {"png": {"dpi": dpi}, "hpgl": {"machine": machine}, "dxf": {"text": text},
                                           "pdf": {"date": files.source_date()}}  # fmt: skip
    order = Order(sheets, formats, settings, corrected, force, archive, one_file, words.asked(), words.reader(), kept.used(),
                  _names())
    if len(projects) == 1 and not families and not lists:
        if jobs is not None or scheduler is not None:
            raise click.UsageError(tell("--jobs and --dask are for several projects"))
        if with_note and archive:
            raise click.UsageError(tell("--with-note writes into a folder: leave --zip out"))
        if views and archive:
            raise click.UsageError(tell("--views writes into a folder: leave --zip out"))
        _build_one(projects[0], order, output, explain, with_note, views, show_files)
        return
    if views or show_files:
        raise click.UsageError(tell("--views and --open are for one project"))
    if with_note:
        raise click.UsageError(tell("--with-note is for one project"))
    if explain:
        raise click.UsageError(tell("--explain is for one project"))
    _build_many(projects, families, lists, order, output or Path("out"), jobs, scheduler)


def _listed(file: str) -> list[str]:
    """Lines of a list of projects, of standard input for -."""
    import sys

    from tmm_sheets import encodings, files

    hint = tell("a list names a project in each line, in UTF-8")
    try:
        data = sys.stdin.buffer.read() if file == "-" else files.content(Path(file))
        return encodings.cleaned(encodings.decoded(data).text).splitlines()
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=reason_of(e)), file, hint=hint)) from None
    except encodings.NotText as e:
        raise BadInput(Problem(str(e), file, e.line, hint=hint)) from None


def _build_one(project: str, order: Order, output: Path | None, explain: bool = False, with_note: bool = False,
               views: bool = False, show_files: bool = False) -> None:
    from contextlib import nullcontext

    from tmm_sheets.explain import Stopwatch
    from tmm_sheets.output.building import build as build_project
    from tmm_sheets.progress import Progress

    watch = Stopwatch()
    with watch.phase(tell("read")):
        variant = _read(project, order.corrected)
    folder = _folder(variant, output)
    outlet = order.outlet(folder)
    if explain:
        from tmm_sheets.askers import listening
    with Progress() as progress, listening() if explain else nullcontext() as askers:
        if with_note:
            from tmm_sheets.note import note as writing

            words.set_paper(words.of_project(variant.project.language))
            with watch.phase(tell("pages of the note")):
                variant = writing.run_on(variant, lambda what: progress.say(f"{what} ..."))
        built = build_project(variant, order, outlet, watch, lambda what: progress.say(f"{what} ..."))
        paths, warnings = built.paths, built.warnings
        if with_note:

            with watch.phase(tell("note")):
                written = writing.write(built.opened, ("pdf",), lambda what: progress.say(f"{what} ..."))
                noted, kept = _put(folder, written.files, order.force)
            paths += noted
            warnings += (*kept, *(tell("left out: {problem}").format(problem=problem) for problem in written.problems))
        if views:
            pictured, kept = _put(folder / "views", _pictures(built.opened, order), order.force)
            paths += pictured
            warnings += tuple(kept)
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
    from tmm_sheets.output.building import chosen
    from tmm_sheets.sheets import sheet

    formats = [form for form in order.formats if form in view_pictures.FORMATS] or ["svg"]
    drawn = sheet.attempt(opened, chosen(opened.variant, order.sheets)).drawn
    dpi = order.settings["png"]["dpi"]
    return {name: data for n, composed in drawn.items() for name, data in view_pictures.of_sheet(n, composed, formats, dpi)}


@commands.command()
@PROJECT
@CORRECTED
@titled
@option("--sheet", "sheets", type=int, multiple=True, metavar="N", help="Only this sheet; may be repeated.")
@option("--format", "formats", default="pdf", show_default=True, callback=_among(FORMATS),
        metavar="F,F", help=f"Formats: {', '.join(FORMATS)}.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the sheets.  [default: out/<project>]")
def watch(project: str, corrected: bool, sheets: tuple[int, ...], formats: tuple[str, ...], output: Path | None) -> None:
    """Draw the sheets of a project file each time it is saved, until Ctrl-C."""
    from tmm_sheets import catalogue
    from tmm_sheets.output import watching
    from tmm_sheets.output.building import Order
    from tmm_sheets.task import title_entries

    if catalogue.is_shipped(project):
        raise click.UsageError(tell("{project} is a shipped project, which nobody changes: {command}").format(
            project=project, command=quoting.command("new", "my", "--from", project)))
    path = catalogue.located(project)
    click.echo(tell("watching {file}, Ctrl-C ends it").format(file=path), err=True)
    for _ in watching.saved((path, path.parent / title_entries.FILE)):
        try:
            order = Order(sheets, formats, {}, corrected, language=words.asked(), reader=words.reader(), kept=kept.used(),
                          names=_names())
            _build_one(project, order, output)
        except (BadInput, CannotBuild) as e:
            click.echo(e, err=True)


def _put(folder: Path, made: Mapping[str, bytes], force: bool) -> tuple[tuple[Path, ...], list[str]]:
    """Write files that are made whole each time; where they are, and what is to be said of those that were changed by hand."""
    from tmm_sheets.output.build_store import Folder, put

    written, kept = put(Folder(folder), made, force)
    return tuple(folder / name for name in written), kept


def _build_many(
    projects: tuple[str, ...], families: tuple[str, ...], lists: tuple[str, ...], order: Order, parent: Path,
    jobs: int | None, scheduler: str | None,
) -> None:
    from time import monotonic

    from tmm_sheets import files
    from tmm_sheets.output import batch

    names = batch.chosen(projects, families, [_listed(file) for file in lists])
    if not names:
        raise BadInput(tell("no projects to build"), hint=tell("the list is empty"))
    files.check_folder(parent)
    start = monotonic()
    running = (batch.run(names, order, parent, jobs or batch.processors()) if scheduler is None
               else batch.run_on_dask(names, order, parent, scheduler))  # fmt: skip
    done, stopped = _come_of(running, len(names))
    for outcome in sorted(done, key=lambda o: o.project):
        for warning in outcome.warnings:
            click.echo(f"{outcome.project}: {warning}", err=True)
    click.echo(batch.summary(done, parent, monotonic() - start))
    failures = [outcome for outcome in done if outcome.problem]
    if stopped is not None:
        if failures:
            click.echo(batch.table(failures, len(names)), err=True)
        _say_stopped(len(names) - len(done), len(names))
        raise stopped
    if failures:
        raise CannotBuild(batch.table(failures, len(names)))


def _come_of(running: Iterable[Outcome], total: int) -> tuple[list[Outcome], KeyboardInterrupt | None]:
    """Outcomes of a batch as they come, with a bar; and what told it to end before."""
    from tmm_sheets.progress import Bar

    done: list[Outcome] = []
    try:
        with Bar(total) as bar:
            for outcome in running:
                done.append(outcome)
                bar.step(bool(outcome.problem))
    except KeyboardInterrupt as e:
        return done, e
    return done, None


def _say_stopped(left: int, total: int) -> None:
    said = tell("stopped, {n} of {total} projects left; the same command goes on from there")
    click.echo(said.format(n=left, total=total), err=True)


@commands.command()
@argument("table", metavar="FILE", type=click.Path(path_type=Path))
@option("--task", default="", metavar="PROJECT", help="Task of those for whom the table names none, or a machine for its ciphers.")
@CORRECTED
@titled
@option("--format", "formats", default="dxf,pdf", show_default=True, callback=_among(FORMATS),
        metavar="F,F", help=f"Formats: {', '.join(FORMATS)}.")
@option("-o", "--output", type=click.Path(path_type=Path), default=Path("out"), show_default=True, metavar="DIR",
        help="Folder with one for each student.")
@option("--force", is_flag=True, help="Make again also what has not changed, and overwrite what was changed by hand.")
@option("--jobs", type=click.IntRange(1), metavar="N", help="Processes for several projects.  [default: all processors]")
@NO_CACHE
def roster(table: Path, task: str, corrected: bool, formats: tuple[str, ...], output: Path, force: bool, jobs: int | None) -> None:
    """Make the work of a whole group: for each student of a CSV FILE sheets, note, living page, a table to fill in."""
    from tmm_sheets import files
    from tmm_sheets.output import batch
    from tmm_sheets.output import roster as rosters
    from tmm_sheets.output.building import Order

    students = rosters.read(table, task)
    files.check_folder(output)
    settings: dict[str, dict[str, Any]] = {"pdf": {"date": files.source_date()}}
    order = Order((), formats, settings, corrected, force, False, False, words.asked(), words.reader(), kept.used(), _names())
    works = [batch.Task(s.project, s.folder, s.student, s.group) for s in students]
    came, stopped = _come_of(batch.carry_out(works, order, output, jobs or batch.processors()), len(works))
    done = {outcome.folder: outcome for outcome in came}
    written, hand = _put(output, rosters.lists(students, done, output), force)
    for s in students:
        for warning in done[s.folder].warnings if s.folder in done else ():
            click.echo(f"{s.student}: {warning}", err=True)
    for line in hand:
        click.echo(line, err=True)
    click.echo(rosters.told(students, done))
    for path in written:
        click.echo(path)
    if stopped is not None:
        _say_stopped(len(students) - len(done), len(students))
        raise stopped
    failed = [s for s in students if done[s.folder].problem]
    if failed:
        raise CannotBuild("\n".join(f"{s.student}: {done[s.folder].problem}" for s in failed))


@commands.command()
@argument("action", type=click.Choice(["check"]), metavar="check")
@argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@option("--quick", is_flag=True, help="Read the project files only; assemble nothing.")
def family(action: str, folder: Path, quick: bool) -> None:
    """Try a family of tasks, a folder with family.toml: read and assemble every cipher of every machine."""
    from tmm_sheets.output import family_check
    from tmm_sheets.progress import Progress

    with Progress() as progress:
        found = [*family_check.tried(folder, quick, lambda what: progress.say(f"{what} ..."))]
    told = family_check.table(found)
    if any(t.problem for t in found):
        raise CannotBuild(told)
    click.echo(told)


@commands.command()
@PROJECT
@CORRECTED
@option("--json", "target", metavar="FILE", help="Write JSON to FILE, or to standard output for -.")
@option("--npz", "arrays", metavar="FILE", type=click.Path(path_type=Path), help="Write arrays to FILE, for numpy.load.")
@option("--csv", "table", metavar="FILE", type=click.Path(path_type=Path), help="Write a table to FILE, a row for each position.")
@option("--phi", callback=_degrees, metavar="DEG,DEG", help="Crank angles, counter-clockwise from the x axis.")
@option("--positions", type=click.IntRange(1, MOST_POSITIONS), metavar="N",
              help="N equal parts of the turn from position 0 on, in the sense of rotation.")
@option("--part", "parts", callback=_among(PARTS), metavar="P,P", help=f"Only these parts: {', '.join(PARTS)}.")  # fmt: skip
def solve(
    project: str, corrected: bool, target: str | None, arrays: Path | None, table: Path | None, phi: tuple[float, ...] | None,
    positions: int | None, parts: tuple[str, ...] | None,
) -> None:
    """Compute the numbers of PROJECT; nothing is drawn."""
    if phi is not None and positions is not None:
        raise click.UsageError(tell("give either --phi or --positions, not both"))
    from tmm_sheets import result_files, results

    opened, refused = _open(project, corrected, drawn=False), dict[str, CannotBuild]()
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


@commands.command()
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
def optimise(project: str, corrected: bool, vary: tuple[str, ...], least: str, most: str, bounds: tuple[str, ...], positions: int,
             tries: int, output: Path | None, force: bool) -> None:
    """Look for numbers of PROJECT that make a result least or greatest; write the project file with them."""
    from tmm_sheets import files
    from tmm_sheets.api import Opened
    from tmm_sheets.progress import Progress

    opened = Opened(_read(project, corrected, drawn=False))
    path = output if output is not None else _folder(opened.project.variant, None) / "optimised.toml"
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


@commands.command()
@PROJECT
@CORRECTED
@option("--plan", "name", metavar="PLAN", help="Only this plan.")
@option("--all", "everything", is_flag=True, help="Also plans that nobody draws: of searches, and between the positions.")
def protocol(project: str, corrected: bool, name: str | None, everything: bool) -> None:
    """Say the construction steps of PROJECT as sentences, in the language of its sheets, with their millimetres."""
    from tmm_sheets import protocols

    for line in protocols.lines(_open(project, corrected, drawn=False), name, everything):
        click.echo(line)


@commands.command()
@PROJECT
@CORRECTED
@option("--sheet", "sheets", type=int, multiple=True, metavar="N", help="Only this sheet; may be repeated.")
@option("--json", "target", required=True, metavar="FILE", help="Write to FILE, or to standard output for -.")
@NO_CACHE
def record(project: str, corrected: bool, sheets: tuple[int, ...], target: str) -> None:
    """Write the record of PROJECT as JSON: every number with its step, every mark with what it shows."""
    from tmm_sheets.output.building import chosen
    from tmm_sheets.record import recording

    opened = _open(project, corrected)
    found, problem = recording.record(opened, chosen(opened.variant, sheets))
    text = recording.as_json(found)
    if target == "-":
        click.echo(text)
    else:
        from tmm_sheets import files

        files.write_all({Path(target): (text + "\n").encode()})
    if problem is not None:
        raise problem


@commands.command()
@PROJECT
@CORRECTED
@option("--sheet", "sheets", type=int, multiple=True, metavar="N", help="Only this sheet; may be repeated.")
@option("--plan", "plan", default="", metavar="NAME", help="Open with this plan.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE",
        help="File of the page.  [default: out/<project>/page.html]")
@NO_CACHE
def page(project: str, corrected: bool, sheets: tuple[int, ...], plan: str, output: Path | None) -> None:
    """Write the living sheet of PROJECT: one page without network, in which its plans are drawn, turned, changed and asked."""
    from tmm_sheets import files
    from tmm_sheets.living.page import page as living_page
    from tmm_sheets.output.building import chosen

    opened = _open(project, corrected)
    found, problem = living_page(opened, chosen(opened.variant, sheets), plan)
    path = output if output is not None else _folder(opened.variant, None) / "page.html"
    files.write_all({path: found.encode()})
    click.echo(path)
    if problem is not None:
        raise problem


@commands.command()
@argument("project", required=False)
@CORRECTED
@option("--watch", "followed", type=click.Path(path_type=Path), metavar="FILE",
        help="Show this project file, anew each time it is saved.")
@option("--host", default="127.0.0.1", show_default=True, help="Address to listen at: another one lets other machines in.")
@option("--port", type=click.IntRange(1, 65535), metavar="N", help="Port to listen at.  [default: 8731, or a free one]")
@option("--no-browser", is_flag=True, help="Tell the address only.")
@NO_CACHE
def serve(project: str | None, corrected: bool, followed: Path | None, host: str, port: int | None, no_browser: bool) -> None:
    """Serve a page in the browser, until Ctrl-C: choose a task, change it, take what is made of it, check drawings."""
    from tmm_sheets.page import serving

    serving.check_packages()
    if project is not None and followed is not None:
        raise click.UsageError(tell("give either PROJECT or --watch FILE, not both"))
    from tmm_sheets.page import shown

    opens = (shown.following(followed) if followed is not None else shown.of(project, corrected) if project is not None
             else shown.Shown())

    def tell_address(address: str) -> None:
        click.echo(address)
        click.echo(tell("Ctrl-C ends it"), err=True)
        if not no_browser and click.launch(address):
            click.echo(tell("no browser can be opened here: open the address yourself"), err=True)

    serving.serve(opens, host, port, tell_address)


@commands.command()
@PROJECT
@argument("result")
@CORRECTED
def why(project: str, result: str, corrected: bool) -> None:
    """Tell the steps from the given numbers of PROJECT to a RESULT, a path of solve --json such as flywheel.J_flywheel."""
    from tmm_sheets.record import why as reasons

    for line in reasons.lines(_open(project, corrected, drawn=False), result):
        click.echo(line)


@commands.command()
@PROJECT
@CORRECTED
@titled
@option("--format", "formats", default="pdf", show_default=True, callback=_among(NOTE_FORMATS), metavar="F,F",
        help=f"Formats: {', '.join(NOTE_FORMATS)}.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the note.  [default: out/<project>]")
@option("--force", is_flag=True, help="Overwrite what was changed by hand.")
@NO_CACHE
def note(project: str, corrected: bool, formats: tuple[str, ...], output: Path | None, force: bool) -> None:
    """Write the explanatory note of PROJECT: text, formulas, tables and figures from the record, ready to be printed."""
    from tmm_sheets import files
    from tmm_sheets.note import note as writing
    from tmm_sheets.progress import Progress

    writing.check(formats)
    opened = _open(project, corrected)
    folder = _folder(opened.variant, output)
    files.check_folder(folder)
    with Progress() as progress:
        written = writing.write(opened, formats, lambda what: progress.say(f"{what} ..."))
        paths, kept = _put(folder, written.files, force)
    for path in paths:
        click.echo(path)
    for line in kept:
        click.echo(f"{opened.variant.called}: {line}", err=True)
    for problem in written.problems:
        click.echo(f"{opened.variant.called}: {tell('left out: {problem}').format(problem=problem)}", err=True)
    for dead in opened.dead_positions if opened.variant.crank is not None else ():
        click.echo(f"{opened.variant.called}: {dead}", err=True)


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


@commands.command()
@argument("project", metavar="PROJECT|FILE")
@CORRECTED
@titled
@option("--sheet", "sheets", type=int, multiple=True, metavar="N", help="Only this sheet; may be repeated.")
@option("--plotter", "machine", metavar="NAME", callback=_plotter,
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
def plot(
    project: str, corrected: bool, sheets: tuple[int, ...], machine: Plotter | None, printer: str | None, tile: str | None,
    overlap: float, bar: bool, outline: str, window: Box | None, preview: bool, dpi: float, ctb: bool, dry_run: bool,
    output: Path | None,
) -> None:
    """Put the sheets of PROJECT on paper, 1:1, or send a FILE made before (.plt, .pdf)."""
    if machine is not None and tile is not None:
        raise click.UsageError(tell("--tile cuts a PDF; a plotter takes a sheet in parts with --window"))
    from tmm_sheets import files
    from tmm_sheets.output import plot as plotting
    from tmm_sheets.progress import Progress

    finished = project.lower().endswith(plotting.FILES)
    if finished and any((sheets, tile, bar, window, outline == "off", click.get_current_context().meta.get(TITLE))):
        raise click.UsageError(tell("{project} is finished: it can be sent or shown, not changed").format(project=project))
    problem = None
    with Progress() as progress:
        if finished:
            folder = output if output is not None else Path(project).parent
            jobs = {Path(project): plotting.ready(Path(project))}
            made: dict[Path, bytes] = {}
        else:
            opened = _open(project, corrected)
            folder = _folder(opened.variant, output)
            if not dry_run:
                files.check_folder(folder)
            look = plotting.PlotLook(machine, tile, overlap, bar, outline == "on", window)
            jobs, problem = _plots(opened, sheets, look, folder, progress)
            made = {path: job.data for path, job in jobs.items()}
        if preview:
            made |= _previews(jobs, machine, dpi, folder, progress)
        if ctb:
            from tmm_sheets.backends import dxf

            made[folder / "black.ctb"] = dxf.plot_styles()
        if not dry_run:
            files.write_all(made)
    _tell(jobs, made)
    if printer is not None:
        _send(jobs, printer, dry_run)
    if problem is not None:
        raise problem


def _tell(jobs: Mapping[Path, Job], made: Mapping[Path, bytes]) -> None:
    """Names of the plots and of what goes with them, with what is to be said of each plot."""
    for path in dict.fromkeys((*jobs, *made)):
        click.echo(path)
        for note in jobs[path].notes if path in jobs else ():
            click.echo(f"    {note}")


def _plots(opened: Project, sheets: tuple[int, ...], look: PlotLook, folder: Path, progress: Progress) -> tuple[
        dict[Path, Job], CannotBuild | None]:
    """Plots of the sheets asked for by their files, and what is to be said of those that cannot be drawn."""
    from tmm_sheets.output import plot as plotting
    from tmm_sheets.output.building import chosen
    from tmm_sheets.sheets import sheet

    attempt = sheet.every(opened, lambda what: progress.say(f"{what} ..."), chosen(opened.variant, sheets))
    problem = attempt.problem()
    jobs = [plotting.job(composed.drawing, f"sheet{n}", look) for n, composed in attempt.drawn.items()]
    return {folder / job.name: job for job in jobs}, problem


def _previews(jobs: Mapping[Path, Job], machine: Plotter | None, dpi: float, folder: Path, progress: Progress) -> dict[
        Path, bytes]:
    """Pictures of the plots, made from the plots themselves."""
    from tmm_sheets.drawing.plotters import plotter
    from tmm_sheets.output import plot as plotting

    made: dict[Path, bytes] = {}
    for path, job in jobs.items():
        progress.say(tell("preview of {path} ...").format(path=path))
        made |= {folder / name: data for name, data in plotting.preview(job, machine or plotter(), dpi).items()}
    return made


def _send(jobs: Mapping[Path, Job], printer: str, dry_run: bool) -> None:
    """Send the plots to a printer of CUPS, or tell the commands that would."""
    import shlex

    from tmm_sheets.output import plot as plotting

    for path, job in jobs.items():
        if dry_run:
            click.echo(tell("would send: {command}").format(command=shlex.join(plotting.command(job, path, printer))))
        else:
            click.echo(plotting.send(job, path, printer))


def _of_group(group: Path, opened: Project, corrected: bool, marks: Path | None, pencil: float, reading: float,
              say: Callable[[str], None]) -> Report:
    """The report on the work of a whole group."""
    from tmm_sheets.api import compared
    from tmm_sheets.compare import group as whole
    from tmm_sheets.compare import marking

    scheme = marking.read(marks) if marks is not None else None

    def judged(kind: Kind, project: Project, sheet: int | None, path: Path) -> Report:
        return compared(project, kind, path, sheet, None, pencil, reading)

    name = opened.variant.called
    return whole.compare(group, name, lambda other: opened if other == name else _open(other, corrected), judged, scheme, say)


def _check_pages(pages: tuple[Path, ...]) -> None:
    """Refuse reports of another kind than can be written."""
    for path in pages:
        if path.suffix.lower() not in (".html", ".pdf"):
            raise click.UsageError(tell("--report {file}: expected a name that ends in .html or .pdf").format(file=path))


@commands.command()
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
@option("--marks", type=click.Path(path_type=Path), metavar="FILE", help="With --group: what each fault costs, for marks.")
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
def compare(
    project: str, corrected: bool, template: bool, everything: bool, measured: Path | None, sheet: int | None,
    image: Path | None, read_numbers: bool, views: Path | None, dxf: Path | None, group: Path | None, marks: Path | None,
    pencil: float, reading: float, target: str | None, pages: tuple[Path, ...], output: Path | None,
) -> None:
    """Compare a hand drawing of PROJECT with the exact one: measured lengths, a photograph or a CAD drawing."""
    if sum((template, measured is not None, image is not None, dxf is not None, group is not None)) != 1:
        raise click.UsageError(tell("give one of --template, --measured FILE, --image FILE, --dxf FILE and --group FOLDER"))
    if marks is not None and group is None:
        raise click.UsageError(tell("--marks goes with --group FOLDER"))
    if everything and not template:
        raise click.UsageError(tell("--all goes with --template"))
    if read_numbers and image is None:
        raise click.UsageError(tell("--read-numbers goes with --image FILE"))
    if sheet is None and image is not None:
        raise click.UsageError(tell("--image needs --sheet N: which sheet it shows"))
    _check_pages(pages)
    from tmm_sheets import files
    from tmm_sheets.progress import Progress

    opened = _open(project, corrected)
    folder = _folder(opened.variant, output)
    with Progress() as progress:
        def say(what: str) -> None:
            progress.say(f"{what} ...")

        if template:
            from tmm_sheets.compare.measured import measured_lengths as by_ruler

            report = by_ruler.template(opened, folder, everything, say)
        elif group is not None:
            report = _of_group(group, opened, corrected, marks, pencil, reading, say)
        else:
            from tmm_sheets.api import compared

            kinds: dict[Kind, Path | None] = {"measured": measured, "image": image, "dxf": dxf}
            ((kind, path),) = [(kind, path) for kind, path in kinds.items() if path is not None]
            try:
                report = compared(opened, kind, path, sheet, views, pencil, reading, read_numbers, say)
            except CannotBuild as e:
                files.write_all({folder / name: data for name, data in e.files.items()})
                for name in e.files:
                    click.echo(folder / name, err=True)
                raise
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


@commands.command()
@option("--json", "target", metavar="FILE", help="Also write the table as JSON, to standard output for -.")
@option("--plot", "folder", type=click.Path(path_type=Path), metavar="DIR", help="Also draw log-log diagrams, SVG.")
@option("--quick", is_flag=True, help="A few small runs only: tries the benchmark out.")
@option("--summary", is_flag=True, help="The first and the last run of each method only, in Markdown.")
@option("--peers", is_flag=True, help="Instead: the same linkages by other programs, those of the extra [peers].")
@option("--cost", metavar="PROJECT", help="Instead: what one sheet or one number of PROJECT costs against the whole.")
@option("--whole", metavar="PROJECT", help="Instead: all sheets of PROJECT against plain calls of the libraries.")
def bench(target: str | None, folder: Path | None, quick: bool, summary: bool, peers: bool, cost: str | None,
          whole: str | None) -> None:
    """Measure every method: error against a truth of 30 digits or more, and time."""
    if cost is not None or whole is not None:
        if any((target, folder, quick, summary, peers, cost and whole)):
            raise click.UsageError(tell("--cost and --whole go alone"))
        click.echo(_prices(cost, whole))
        return
    from tmm_sheets import files
    from tmm_sheets.lab.bench import records
    from tmm_sheets.lab.bench import run as benchmark
    from tmm_sheets.progress import Progress

    if folder is not None:
        files.check_folder(folder)
    with Progress() as progress:
        measure = benchmark.compare if peers else benchmark.run
        found = measure(quick, lambda what: progress.say(f"{what} ..."))
    if peers:
        from tmm_sheets.lab.bench import peers as by_others

        text = (by_others.summary if summary else by_others.table)(found)
    else:
        text = (records.summary if summary else records.table)(found)
    click.echo(text, err=target == "-")
    made: dict[Path, bytes] = {}
    if target == "-":
        click.echo(records.as_json(found))
    elif target is not None:
        made[Path(target)] = (records.as_json(found) + "\n").encode()
    if folder is not None:
        from tmm_sheets.lab.bench import plots

        made |= {folder / name: data for name, data in plots.diagrams(found).items()}
    files.write_all(made)


def _prices(cost: str | None, whole: str | None) -> str:
    """What parts of a project cost against the whole, or the whole against plain calls of the libraries."""
    from tmm_sheets.progress import Progress

    with Progress() as progress:
        def say(what: str) -> None:
            progress.say(f"{what} ...")

        if cost is not None:
            from tmm_sheets.lab.bench import costs

            return costs.table(cost, say)
        from tmm_sheets.lab.bench import whole as sheets

        return sheets.table(sheets.measure(str(whole), say))


@commands.command()
@option("--cases", type=click.IntRange(1), default=900, show_default=True, metavar="N", help="How many random mechanisms.")
@option("--seed", type=click.IntRange(0), default=0, show_default=True, metavar="S", help="Seed of the random numbers.")
@option("--case", "single", type=click.IntRange(0), metavar="N", help="Only this case of the seed, again.")
def stress(cases: int, seed: int, single: int | None) -> None:
    """Try hard random mechanisms: the worst of every invariant against its bound."""
    from tmm_sheets.lab.stress import report
    from tmm_sheets.progress import Progress

    if single is not None:
        worst = report.run_one(seed, single)
    else:
        with Progress() as progress:
            worst = report.run(
                cases, seed, lambda case: progress.say(tell("case {case} of {cases} ...").format(case=case, cases=cases))
            )
    click.echo(report.table(worst, seed))
    failed = report.exceeded(worst)
    if failed:
        raise CannotBuild(
            tell("bound exceeded: {invariants}").format(invariants=", ".join(failed)), tell("the table names a case that shows it")
        )


def _folder(variant: Variant, output: Path | None) -> Path:
    """Folder of a project's files: the one asked for, or one of its own."""
    from tmm_sheets.output.building import folder_name

    return output if output is not None else Path("out") / folder_name(variant.stem)


def _names() -> Names:
    """What title blocks are filled in with, by the options of the command that runs and the user's settings."""
    from tmm_sheets.task import title_entries

    return title_entries.given(click.get_current_context().meta.get(TITLE, {}))


def _open(project: str, corrected: bool, drawn: bool = True) -> Project:
    """The project; where it is not ``drawn``, nobody asks for the title blocks."""
    variant = _read(project, corrected, drawn)
    from tmm_sheets.project import Project

    words.set_paper(words.of_project(variant.project.language))
    return Project(variant)


def _read(project: str, corrected: bool, drawn: bool = True) -> Variant:
    """The project's numbers, and names in its title blocks; what is doubtful in them goes to standard error."""
    from tmm_sheets import catalogue

    variant = catalogue.read(project, corrected)
    for warning in variant.warnings:
        click.echo(f"{variant.called}: {warning}", err=True)
    return _names().filled(variant) if drawn else variant
